//! Tangent planes of a convex leaf, found once when it is compiled.

use glam::{DAffine3, DVec3};

use super::step::Plane;
use crate::AnyField;
use crate::{Bounds, Dual};

/// The leaf's tangent planes where rays from its centre meet the surface: towards the faces,
/// edges and corners of its box; an infinite one is cut. They are given in the frame that `to_leaf` maps from.
pub(super) fn planes(leaf: &dyn AnyField, to_leaf: &DAffine3) -> Vec<Plane> {
    let Some(bounds) = finite(&leaf.bounds_under(&DAffine3::IDENTITY)) else { return Vec::new() };
    let (centre, half) = (bounds.center(), bounds.half_extents());
    let mut planes = Vec::new();
    for i in 0..27u32 {
        let step = |k: u32| f64::from(i / k % 3) - 1.0;
        if i == 13 {
            continue;
        }
        // A little off the planes of symmetry, where fields have kinks.
        let off = |k: f64| 0.03 * (k * f64::from(i)).sin();
        let ray = half * DVec3::new(step(1) + off(7.0), step(3) + off(8.0), step(9) + off(9.0));
        let Some(point) = crossing(leaf, centre, ray) else { continue };
        let seen = leaf.dual(Dual::point(point.to_array()));
        let normal = -(to_leaf.matrix3.transpose() * DVec3::from_array(seen.d));
        let length = normal.length();
        // The point lies on the surface up to rounding; its value says how far from it.
        let o = -DVec3::from_array(seen.d).dot(point) + seen.v;
        let o = o + DVec3::from_array(seen.d).dot(to_leaf.translation);
        let plane = [normal.x / length, normal.y / length, normal.z / length, o / length];
        if plane.iter().all(|c| c.is_finite()) {
            planes.push(plane);
        }
    }
    planes
}

/// The box, as long along the axes where it is infinite as it is along the others.
fn finite(bounds: &Bounds) -> Option<Bounds> {
    let sides = bounds.min.abs().max(bounds.max.abs());
    let longest = sides.to_array().into_iter().filter(|side| side.is_finite()).fold(0.0, f64::max);
    let long = DVec3::splat(longest);
    if bounds.is_empty() || longest == 0.0 {
        None
    } else {
        Some(Bounds::new(bounds.min.max(-long), bounds.max.min(long)))
    }
}

/// Where the ray from `centre`, inside, leaves the leaf.
fn crossing(leaf: &dyn AnyField, centre: DVec3, ray: DVec3) -> Option<DVec3> {
    let value = |t: f64| leaf.value((centre + ray * t).to_array());
    let (mut inside, mut outside) = (0.0, 2.0);
    if value(inside) <= 0.0 || value(outside) > 0.0 {
        return None;
    }
    for _ in 0..50 {
        let middle = 0.5 * (inside + outside);
        if value(middle) > 0.0 { inside = middle } else { outside = middle }
    }
    Some(centre + ray * inside)
}
