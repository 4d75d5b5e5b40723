//! Less of a solid that is wrong in the same way.

use std::time::{Duration, Instant};

use glam::{DAffine3, DMat3, DVec2, DVec3};
use rvachev::{
    Bounds, Solid,
    catalogue::{Call, Operands, Part, Value},
    rad,
};

use super::text::written;

/// A solid of as short a program as is found, of which `is_wrong` still holds. Looks for no longer
/// than `patience`.
pub fn shrunk(solid: &Solid, patience: Duration, is_wrong: impl Fn(&Solid) -> bool) -> Solid {
    let start = Instant::now();
    let mut least = solid.clone();
    let mut length = written(&least.clone().into()).len();
    'again: loop {
        for part in simpler(&(&least).into()) {
            let shorter = written(&part).len();
            let Some(candidate) = part.into_solid().filter(|_| shorter < length) else { continue };
            if start.elapsed() > patience {
                return least;
            }
            if is_wrong(&candidate) {
                (least, length) = (candidate, shorter);
                continue 'again;
            }
        }
        return least;
    }
}

/// Parts with something left out or rounded, those that lack most first.
fn simpler(part: &Part) -> Vec<Part> {
    let Some(call) = Call::of(part) else { return Vec::new() };
    let is_alike = |other: &&Part| std::mem::discriminant(*other) == std::mem::discriminant(part);
    let mut found: Vec<Part> = call.operands.iter().filter(is_alike).cloned().collect();
    let mut add = |change: &dyn Fn(&mut Call)| {
        let mut call = call.clone();
        change(&mut call);
        found.extend(call.make());
    };
    if let Part::Solid(_) = part {
        let plain = [Solid::sphere(1.0), Solid::cuboid([1.0; 3])].map(|plain| Call::of(&plain.into()));
        for plain in plain.into_iter().flatten() {
            add(&|call| *call = plain.clone());
        }
    }
    if call.entry.operands() == Operands::Many && call.operands.len() > 1 {
        for i in 0..call.operands.len() {
            add(&|call| drop(call.operands.remove(i)));
        }
    }
    for (i, operand) in call.operands.iter().enumerate() {
        for less in simpler(operand) {
            add(&|call| call.operands[i] = less.clone());
        }
    }
    for (i, value) in call.values.iter().enumerate() {
        for less in simpler_values(value) {
            add(&|call| call.values[i] = less.clone());
        }
    }
    found
}

fn simpler_numbers(v: f64) -> Vec<f64> {
    let to_digits = |digits: i32| {
        let unit = 10f64.powi(v.abs().log10().floor() as i32 + 1 - digits);
        let rounded = format!("{:.*e}", (digits - 1).max(0) as usize, (v / unit).round() * unit);
        rounded.parse().unwrap_or(v)
    };
    let mut found = vec![0.0, 1.0, v.round()];
    if v.is_finite() && v != 0.0 {
        found.extend([1, 2, 3].map(to_digits));
        found.push(v.abs());
    }
    found.retain(|less| *less != v);
    found
}

/// The values with one of its numbers made simpler.
fn each<const N: usize>(numbers: [f64; N]) -> impl Iterator<Item = [f64; N]> {
    (0..N).flat_map(move |i| {
        simpler_numbers(numbers[i]).into_iter().map(move |less| {
            let mut changed = numbers;
            changed[i] = less;
            changed
        })
    })
}

fn simpler_points(points: &[DVec2]) -> Vec<Vec<DVec2>> {
    let without = |i: usize| [&points[..i], &points[i + 1..]].concat();
    let mut found: Vec<Vec<DVec2>> = (0..points.len()).map(without).collect();
    for (i, point) in points.iter().enumerate() {
        found.extend(each(point.to_array()).map(|less| {
            let mut changed = points.to_vec();
            changed[i] = less.into();
            changed
        }));
    }
    found
}

fn simpler_values(value: &Value) -> Vec<Value> {
    match value {
        Value::Number(v) => simpler_numbers(*v).into_iter().map(Value::Number).collect(),
        Value::Angle(angle) => simpler_numbers(angle.radians()).into_iter().map(|v| Value::Angle(rad(v))).collect(),
        Value::Count(n) => [1, 2, 3, n / 2].map(Value::Count).to_vec(),
        Value::Vector(v) => each(v.to_array()).map(|v| Value::Vector(DVec3::from_array(v))).collect(),
        Value::PlaneVector(v) => each(v.to_array()).map(|v| Value::PlaneVector(v.into())).collect(),
        Value::Counts(c) => each(c.map(f64::from)).map(|c| Value::Counts(c.map(|n| n.max(1.0) as u32))).collect(),
        Value::Bounds(b) => {
            let corners = [b.min, b.max].map(|p| p.to_array());
            let min = each(corners[0]).map(|min| Bounds::new(DVec3::from(min), b.max));
            let max = each(corners[1]).map(|max| Bounds::new(b.min, DVec3::from(max)));
            min.chain(max).map(Value::Bounds).collect()
        }
        Value::Map(map) => {
            let bare = [DAffine3::from_translation(map.translation), DAffine3::from_mat3(map.matrix3)];
            let rounded = each(map.to_cols_array()).map(|m| DAffine3::from_cols_array(&m));
            let flat = DAffine3::from_mat3(DMat3::from_diagonal(map.matrix3.diagonal()));
            bare.into_iter().chain([flat]).chain(rounded).map(Value::Map).collect()
        }
        Value::Contours(contours) => {
            let without = (0..contours.len()).map(|i| [&contours[..i], &contours[i + 1..]].concat());
            let changed = contours.iter().enumerate().flat_map(|(i, contour)| {
                simpler_points(contour).into_iter().map(move |less| {
                    let mut changed = contours.clone();
                    changed[i] = less;
                    changed
                })
            });
            without.chain(changed).map(Value::Contours).collect()
        }
        Value::Points(points) => simpler_points(points).into_iter().map(Value::Points).collect(),
        Value::Text(_) | Value::Switch(_) | Value::Choice(_) | Value::Color(_) => Vec::new(),
        other => simpler(&Part::Value(other.clone())).into_iter().filter_map(Part::into_value).collect(),
    }
}

#[test]
fn what_is_not_needed_goes() {
    let solid =
        Solid::cuboid([2.123, 1.4, 1.0]).rotate_x(rad(0.3)) | Solid::torus(0.8123, 0.2).translate([0.3, 0.1, 2.0]);
    let least = shrunk(&solid, Duration::from_secs(60), |solid| format!("{solid}").contains("torus"));
    let text = written(&least.into());
    assert!(text.starts_with("torus(") && text.len() < 18, "{text}");
}
