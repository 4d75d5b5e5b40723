//! Solids of whose surface nothing was found: empty ones, and those that are too thin.

use glam::DVec3;
use rvachev_num::order;

use crate::eval::{Narrowed, Program};
use crate::{Bounds, Cancelled, Run};

/// So many boxes are looked at.
const MOST: usize = 1 << 12;

/// What is known of the inside of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Inside {
    /// It is there.
    At(DVec3),
    /// There is none.
    Nothing,
    /// None was found; if there is any, some of it may be here.
    Unknown(DVec3),
}

/// Looks for a point inside: in the boxes whose middles are deepest first.
pub(super) fn inside(program: &Program, bounds: &Bounds, run: &Run) -> Result<Inside, Cancelled> {
    let mut open = vec![(*bounds, program.clone())];
    let mut looked = 0;
    while let Some((part, program)) = open.pop() {
        run.check()?;
        let middle = part.center();
        if program.value(middle) > 0.0 {
            return Ok(Inside::At(middle));
        }
        looked += 1;
        if looked > MOST {
            return Ok(Inside::Unknown(middle));
        }
        // Halved until it is as long as it is wide: needles have long boxes.
        let within = |half: Bounds| match program.narrowed(&half) {
            Narrowed::Outside => None,
            Narrowed::Inside | Narrowed::Same => Some((half, program.clone())),
            Narrowed::Simpler(simpler) => Some((half, simpler)),
        };
        let mut parts: Vec<(f64, (Bounds, Program))> = halves(&part)
            .into_iter()
            .filter_map(within)
            .filter(|(half, own)| own.range(half).hi() > 0.0 && !own.is_contrary())
            .map(|(half, own)| (own.value(half.center()), (half, own)))
            .collect();
        order::rising(&mut parts, |a| a.0);
        open.extend(parts.into_iter().map(|(_, part)| part));
    }
    Ok(Inside::Nothing)
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

    fn found(solid: &Solid) -> Inside {
        let programs = compiled(solid).unwrap();
        inside(&programs.surface, &programs.bounds(), &Run::default()).unwrap()
    }

    #[test]
    fn what_is_thin_is_found_and_what_is_empty_is_not() {
        let needle = Solid::cuboid([1e-6, 1e-6, 10.0]).translate([3.0, 0.0, 0.0]).twist(rad(0.3));
        let dust = Solid::sphere(1e-6).translate([1.3, 2.1, 0.4]) | Solid::sphere(1e-6).translate([-7.0, 1.0, 1.0]);
        for solid in [needle, dust, Solid::cuboid([1e-8, 10.0, 10.0]).rotate_x(rad(0.3)).rotate_y(rad(1.0))] {
            assert!(matches!(found(&solid), Inside::At(p) if solid.contains(p).unwrap()), "{solid}");
        }
        let block = Solid::cuboid([1.0; 3]).twist(rad(0.5));
        for solid in [&block - &block, Solid::torus(2.0, 0.3) & Solid::sphere(1.0)] {
            assert_eq!(found(&solid), Inside::Nothing, "{solid}");
        }
    }

    #[test]
    fn faces_that_are_all_but_inside_hide_nothing() {
        let block = Solid::cuboid([1.0; 3]).twist(rad(0.5));
        let speck = Solid::sphere(1e-5).translate([1.3, 2.1, 0.4]);
        // The block without itself has no point, which is known, so that the speck is found.
        let beside = (&block - &block) | &speck;
        assert!(matches!(found(&beside), Inside::At(p) if speck.contains(p).unwrap()), "{beside}");
        assert!(matches!(found(&!(!beside)), Inside::At(_)));
        // Of a block without one that is the same, but by another way, that is not known.
        let same = Solid::cuboid([2.0; 3]).scale(0.5).twist(rad(0.5));
        for solid in [&block - &same, (&block - &same) | &speck] {
            match found(&solid) {
                Inside::At(p) => assert!(solid.contains(p).unwrap()),
                told => assert!(matches!(told, Inside::Unknown(_)), "{told:?}"),
            }
        }
    }
}
