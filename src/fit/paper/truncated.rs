//! A supershape and the box that it is truncated by: one member of a union.
//!
//! ```text
//!     w = √(a₁a₂a₃)     w·f = w·F2 ∧ w·B     F2 = 1 − G     x ∧ y = x + y − √(x² + y²)
//! ```
//!
//! R_p is homogeneous of degree 1, so that the weight may be multiplied in before.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DMat3, DVec3};

use super::oriented_box::{self, OrientedBox};
use crate::fit::cost::Cost;
use crate::fit::gielis::{self, Supershaped};
use crate::fit::kernel::{Model, terms};

/// What is refined: the supershape. The box is that of the points.
pub(super) const PARAMETERS: usize = gielis::PARAMETERS;

/// The derivatives of a value by the parameters.
pub(super) type Row = [f64; PARAMETERS];

#[derive(Clone, Copy, Debug)]
pub(super) struct Truncated {
    pub(super) shape: Supershaped,
    pub(super) bounds: OrientedBox,
    /// Along these local axes the shape is longer than its points: no point tells its length.
    pub(super) held: [bool; 3],
}

/// `x ∧ y` of R_p with p = 2, and its slopes by x and y.
pub(in crate::fit) fn both(x: f64, y: f64) -> (f64, [f64; 2]) {
    let norm = x.hypot(y);
    if norm == 0.0 {
        return (0.0, [1.0 - FRAC_1_SQRT_2; 2]);
    }
    let sum = x + y;
    // The difference of nearly equal numbers is left out where both are positive.
    let value = if sum > 0.0 { 2.0 * (x / (sum + norm)) * y } else { sum - norm };
    (value, [1.0 - x / norm, 1.0 - y / norm])
}

/// `x ∨ y`, and its slopes.
pub(in crate::fit) fn either(x: f64, y: f64) -> (f64, [f64; 2]) {
    let (value, slopes) = both(-x, -y);
    (-value, slopes)
}

impl Truncated {
    /// `√(a₁a₂a₃)·f` at a point, and its derivatives.
    pub(super) fn slopes(&self, p: DVec3, row: &mut Row) -> f64 {
        let weight = self.weight();
        let inside = weight * self.bounds.value(p);
        let (value, shape) = self.shape_terms(p, weight);
        let (both, [by_shape, by_box]) = both(value, inside);
        *row = shape.map(|slope| by_shape * slope);
        // The weight grows with the sizes.
        for to in &mut row[self.shape.sizes().0] {
            *to += 0.5 * by_box * inside;
        }
        both
    }

    pub(super) fn value(&self, p: DVec3) -> f64 {
        let weight = self.weight();
        both(self.shape_terms(p, weight).0, weight * self.bounds.value(p)).0
    }

    fn weight(&self) -> f64 {
        self.shape.semi_axes.element_product().sqrt()
    }

    /// `√(a₁a₂a₃)·F2`, and its derivatives.
    fn shape_terms(&self, p: DVec3, weight: f64) -> (f64, Row) {
        let mut rows = [0.0; PARAMETERS];
        // At the centre the gauge has no slope.
        if (p - self.shape.center).abs().max_element() < 1e-9 * self.shape.semi_axes.min_element() {
            rows[self.shape.sizes().0].fill(0.5 * weight);
            return (weight, rows);
        }
        let (residual, slopes) = terms(&self.shape, p.to_array(), Cost::Gauge);
        (-residual, slopes.map(|s| if s.is_finite() { -s } else { 0.0 }))
    }

    /// How deep a point is inside of the surface, to first order, in length units; negative
    /// outside.
    pub(super) fn depth(&self, p: DVec3) -> f64 {
        let (residual, _) = terms(&self.shape, p.to_array(), Cost::Normal);
        (-residual).min(self.bounds.depth(p))
    }

    /// For each parameter the first one of those that move together with it; none of what is held.
    pub(super) fn groups(&self) -> [Option<usize>; PARAMETERS] {
        let groups = self.shape.groups();
        let sizes = self.shape.sizes().0.start;
        let shifts = PARAMETERS - 3;
        let is_held = |i: usize| {
            let of = |from: usize| (from..from + 3).contains(&i) && self.held[i - from];
            of(sizes) || of(shifts)
        };
        // What is tied to something held is held.
        let held: [bool; PARAMETERS] = std::array::from_fn(|g| (0..PARAMETERS).any(|i| groups[i] == g && is_held(i)));
        groups.map(|group| (!held[group]).then_some(group))
    }

    /// How many parameters there are, tied ones counted once, with those of the box.
    pub(super) fn parameters(&self) -> usize {
        let own = self.shape.groups().iter().enumerate().filter(|(i, group)| i == *group).count();
        own + oriented_box::PARAMETERS
    }

    /// Moved by a step, no further than is sane.
    pub(super) fn moved(&self, step: &Row) -> Truncated {
        let limits = self.shape.limits();
        let step = std::array::from_fn(|i| step[i].clamp(limits[i][0].min(0.0), limits[i][1].max(0.0)));
        Truncated { shape: self.shape.moved(&step), ..*self }
    }
}

/// Axes that a box along a shape may have: the shape's, and those turned by half a right angle, as
/// a superellipsoid has its square section either way.
pub(super) fn box_axes(shape: &Supershaped) -> [DMat3; 2] {
    [shape.rotation, shape.rotation * DMat3::from_rotation_z(std::f64::consts::FRAC_PI_4)]
}
