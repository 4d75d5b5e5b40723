//! Where points meet a surface: the ends of Newton steps along the gradient.

use glam::DVec3;

use crate::eval::Program;
use crate::mesh::{Slope, Slopes};
use crate::{Cancelled, Run};

/// Newton steps from a point to the surface.
const STEPS: usize = 4;

/// Where a point meets the surface.
pub(super) struct Foot {
    pub(super) point: DVec3,
    /// Outwards.
    pub(super) normal: DVec3,
    /// How far the point is from there: positive outside of the solid.
    pub(super) off: f64,
}

/// The feet of points: exact for what is near the surface compared with its curvature.
pub(super) fn feet(program: &Program, points: &[DVec3], run: &Run) -> Result<Vec<Foot>, Cancelled> {
    let slopes = Slopes { program, precision: 0.0 };
    let mut feet = points.to_vec();
    let mut first: Vec<Slope> = Vec::new();
    let mut last: Vec<Slope> = Vec::new();
    for step in 0..STEPS {
        let from = step as f64 / (STEPS + 1) as f64;
        let found = slopes.at(&feet, &run.stage(from, from + 1.0 / (STEPS + 1) as f64))?;
        for (foot, slope) in feet.iter_mut().zip(&found) {
            *foot += slope.newton();
        }
        run.report(from + 1.0 / (STEPS + 1) as f64);
        if step == 0 {
            first = found;
        } else {
            last = found;
        }
    }
    let made = |i: usize| {
        let away = feet[i].distance(points[i]);
        // No −0 of a point on the surface.
        let off = if first[i].value < 0.0 { away } else { 0.0 - away };
        Foot { point: feet[i], normal: last[i].normal(), off }
    };
    Ok((0..points.len()).map(made).collect())
}
