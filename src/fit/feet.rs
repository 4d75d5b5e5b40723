//! Where points meet a surface: the ends of Newton steps along the gradient.

use glam::DVec3;

use crate::eval::Program;
use crate::mesh::{Slope, Slopes};
use crate::{Bounds, Cancelled, Run};

/// What is farther off than this part of the points' box is told to be that far or farther.
const FAR: f64 = 0.1;

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

/// The feet of points: exact for what is near the surface compared with its curvature, and wherever
/// the value is the true distance, which the first step then goes.
pub(super) fn feet(program: &Program, points: &[DVec3], run: &Run) -> Result<Vec<Foot>, Cancelled> {
    let reach = FAR * Bounds::from_points(points.iter().copied()).longest_side();
    let slopes = Slopes { program, precision: 0.0, reach };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::compiled_with;
    use crate::{Solid, deg};

    /// Where the solid's value is its distance, feet are the nearest points of the surface, at
    /// edges and far away as well.
    #[test]
    fn feet_are_the_nearest_points_where_values_are_distances() {
        let pin = Solid::cylinder(0.4, 2.0).rotate_x(deg(40.0)).translate([0.3, 0.1, 0.8]);
        let part = Solid::cuboid([3.0, 2.0, 1.0]) | pin;
        let programs = compiled_with(&part, &Run::default()).unwrap();
        let at = |i: u32| {
            let t = f64::from(i);
            3.0 * DVec3::new((1.3 * t).sin(), (2.1 * t).cos(), (0.7 * t).sin())
        };
        let points: Vec<DVec3> = (0..300).map(at).collect();
        let found = feet(&programs.surface, &points, &Run::default()).unwrap();
        let mut exact = 0;
        for (p, foot) in points.iter().zip(&found) {
            let Some(nearest) = programs.foot(*p) else { continue };
            exact += 1;
            assert!(foot.point.distance(nearest) < 1e-9, "{p}: {} {nearest}", foot.point);
            assert!((foot.off - p.distance(nearest)).abs() < 1e-9, "{p}: {}", foot.off);
        }
        assert!(exact > 200, "{exact} of {}", points.len());
    }
}
