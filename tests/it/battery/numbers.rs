//! Values, gradients, ranges, narrowing and bounds of one solid, against each other.

use glam::DVec3;
use rvachev::{
    Bounds, Interval, ParamError, Solid,
    field::{Field, Real},
    program::{Program, Region},
};

use super::{Fault, fault, is_late};
use crate::narrow::contradicted;
use crate::support::{Random, frame_of, lanes32, lanes64, random_box, samples};

/// The gradient by central differences, where those of two lengths and of both sides agree.
fn differences(program: &Program, p: DVec3, size: f64) -> Option<DVec3> {
    let middle = program.value(p);
    let by = |h: f64| {
        let sides = DVec3::AXES.map(|axis| [program.value(p + h * axis), program.value(p - h * axis)]);
        let gradient = DVec3::from_array(sides.map(|[above, below]| (above - below) / (2.0 * h)));
        let kink = sides.iter().map(|[above, below]| ((above + below - 2.0 * middle) / h).abs()).fold(0.0, f64::max);
        (kink < 1e-3 * gradient.length()).then_some(gradient)
    };
    let (fine, coarse) = (by(1e-6 * size)?, by(4e-5 * size)?);
    (fine.length() > 1e-3 && fine.distance(coarse) < 1e-3 * fine.length()).then_some(fine)
}

/// Whether a value is the program's to within rounding: lanes have their own roots and powers, each
/// right to some units in the last place, so that what they tell is the value of a point beside
/// this one. Where it is steep, or jumps, the range about the point holds it.
fn is_rounded(program: &Program, p: DVec3, exact: f64, value: f64, size: f64) -> bool {
    const ROUNDING: f64 = 1e-12;
    let scale = size + p.abs().max_element();
    let off = (value - exact).abs();
    off <= ROUNDING * (value.abs() + scale) || {
        let range = program.range(&Bounds::from_center(p, DVec3::splat(ROUNDING * scale)));
        range.lo() - ROUNDING * (value.abs() + scale) <= value && value <= range.hi() + ROUNDING * (value.abs() + scale)
    }
}

pub fn check(solid: &Solid) -> Result<(), Fault> {
    let (Ok(surface), Ok(field), Ok(bounds)) = (solid.surface_program(), solid.field_program(), solid.bounds()) else {
        return Ok(());
    };
    let mut random = Random::new(17);
    let frame = frame_of(solid);
    let size = frame.longest_side();
    let around = frame.inflate(0.3 * size);
    let points = samples(&mut random, &around, 48);
    for program in [&surface, &field] {
        let many = lanes64(program, &around, &points);
        let (seen, single) = lanes32(program, &around, &points);
        for (i, &p) in points.iter().enumerate() {
            let value = program.value(p);
            fault("value", value.is_finite(), || format!("{value} at {p}"))?;
            fault("lanes of f64", is_rounded(program, p, value, many[i], size), || {
                format!("{:e} for {value:e} at {p}", many[i])
            })?;
            let is_held = value <= 0.0 || bounds.inflate(1e-9 * size).contains(p);
            fault("bounds", is_held, || format!("{value:e} at {p}, outside of {bounds:?}"))?;
            // The point as lanes see it is this one to within rounding: it is asked about in doubt.
            let exact = || program.value(seen[i]);
            let is_same = |value: f64| (value > 0.0) == (single[i] > 0.0);
            let is_right = is_same(value) || is_same(exact()) || exact().abs() <= 1e-3 * size;
            fault("lanes of f32", is_right, || format!("{:e} for {:e} at {}", single[i], exact(), seen[i]))?;
        }
    }
    for &p in points.iter().skip(8).step_by(4) {
        if is_late() {
            return Ok(());
        }
        let Some(expected) = differences(&field, p, size) else { continue };
        let (_, gradient) = field.gradient(p);
        let is_near = gradient.distance(expected) < 0.02 * expected.length();
        fault("gradient", is_near, || format!("{gradient} for {expected} at {p}"))?;
    }
    for _ in 0..4 {
        if is_late() {
            return Ok(());
        }
        let cell = random_box(&mut random, &around);
        let points = samples(&mut random, &cell, 24);
        for program in [&surface, &field] {
            let range = program.range(&cell);
            let values: Vec<(DVec3, f64)> = points.iter().map(|p| (*p, program.value(*p))).collect();
            for (p, value) in &values {
                fault("range", range.contains(*value), || format!("{value:e} at {p} is not in {range:?} of {cell:?}"))?;
            }
            let region = program.narrow(&cell);
            narrowed(&cell, &region, values)?;
            if let Region::Surface(part) = &region {
                let half = cell.half_extents();
                let inner = Bounds::from_center(cell.min + random.vector(0.5, 1.5) * half, 0.5 * half);
                let points = samples(&mut random, &inner, 16);
                narrowed(&inner, &part.narrow(&inner), points.into_iter().map(|p| (p, program.value(p))))?;
            }
        }
    }
    Ok(())
}

fn narrowed(cell: &Bounds, region: &Region, values: impl IntoIterator<Item = (DVec3, f64)>) -> Result<(), Fault> {
    match contradicted(cell, region, values) {
        Some(text) => Err(Fault { check: "narrowing", text }),
        None => Ok(()),
    }
}

/// A ball that says its box is of this half side, and its values up to this.
#[derive(Clone, Debug)]
struct Claimed(f64, f64);

impl Field for Claimed {
    fn name(&self) -> &'static str {
        "claimed"
    }

    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        x.lift(1.0) - (x * x + y * y + z * z).sqrt()
    }

    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::splat(self.0))
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn range(&self, _: [Interval; 3]) -> Interval {
        Interval::new(-1e9, self.1)
    }
}

#[test]
fn false_claims_are_found() {
    let found = |solid: Claimed| check(&Solid::new(solid)).err().map(|fault| fault.check);
    assert_eq!(found(Claimed(1.0, 1.0)), None);
    assert_eq!(found(Claimed(0.7, 1.0)), Some("bounds"));
    assert_eq!(found(Claimed(1.0, -1.0)), Some("range"));
}
