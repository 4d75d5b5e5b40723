//! Solids of whose surface nothing was found: empty ones, and those that are too thin.

use glam::DVec3;

use crate::eval::Program;
use crate::{Bounds, Cancelled, Run};

/// So many boxes are looked at.
const MOST: usize = 1 << 12;

/// A point inside, if one is found: in the boxes whose middles are deepest first.
pub(super) fn inner_point(program: &Program, bounds: &Bounds, run: &Run) -> Result<Option<DVec3>, Cancelled> {
    let mut open = vec![*bounds];
    for _ in 0..MOST {
        run.check()?;
        let Some(part) = open.pop() else { break };
        let middle = part.center();
        if program.value(middle) > 0.0 {
            return Ok(Some(middle));
        }
        // Halved until it is as long as it is wide: needles have long boxes.
        let mut parts: Vec<(f64, Bounds)> = halves(&part)
            .into_iter()
            .filter(|half| program.range(half).hi() > 0.0)
            .map(|half| (program.value(half.center()), half))
            .collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        open.extend(parts.into_iter().map(|(_, half)| half));
    }
    Ok(None)
}

/// Both halves along the longest side.
fn halves(bounds: &Bounds) -> [Bounds; 2] {
    let size = bounds.size();
    let axis = size.max_position();
    let (mut low, mut high) = (*bounds, *bounds);
    low.max[axis] = bounds.center()[axis];
    high.min[axis] = low.max[axis];
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::compiled;
    use crate::{Solid, rad};

    #[test]
    fn what_is_thin_is_found_and_what_is_empty_is_not() {
        let found = |solid: &Solid| {
            let programs = compiled(solid).unwrap();
            inner_point(&programs.surface, &programs.bounds, &Run::default()).unwrap()
        };
        let needle = Solid::cuboid([1e-6, 1e-6, 10.0]).translate([3.0, 0.0, 0.0]).twist(rad(0.3));
        let dust = Solid::sphere(1e-6).translate([1.3, 2.1, 0.4]) | Solid::sphere(1e-6).translate([-7.0, 1.0, 1.0]);
        for solid in [needle, dust, Solid::cuboid([1e-8, 10.0, 10.0]).rotate_x(rad(0.3)).rotate_y(rad(1.0))] {
            assert!(solid.contains(found(&solid).expect("there is something")).unwrap(), "{solid}");
        }
        let block = Solid::cuboid([1.0; 3]).twist(rad(0.5));
        for solid in [&block - &block, Solid::torus(2.0, 0.3) & Solid::sphere(1.0)] {
            assert_eq!(found(&solid), None, "{solid}");
        }
    }
}
