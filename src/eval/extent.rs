//! The box of a solid that its parts do not tell: found by narrowing.
//!
//! From a box of all that can be evaluated, half by half, what holds no surface is left out.

use glam::DVec3;

use super::{Program, Region};
use crate::Bounds;

/// Boxes are halved until they are this small, in proportion to what is found.
const FINEST: f64 = 1.0 / 64.0;

/// More boxes than this at one size say that the solid does not end.
const PATIENCE: usize = 3000;

/// Solids larger than this count as unbounded.
const LARGEST: f64 = 1e9;

/// A box that holds the inside of `program`; `known` is one along the axes where it is finite.
pub(super) fn extent(program: &Program, known: &Bounds) -> Bounds {
    let limit = DVec3::splat(LARGEST);
    let start = known.intersection(&Bounds::new(-limit, limit));
    let mut boxes = vec![(start, program.clone())];
    loop {
        let mut next = Vec::new();
        let mut hull = Bounds::EMPTY;
        for (bounds, program) in boxes {
            let narrowed = match program.narrow(&bounds) {
                Region::Outside => continue,
                Region::Inside => program,
                Region::Surface(narrowed) => narrowed,
            };
            hull = hull.union(&bounds);
            next.push((bounds, narrowed));
        }
        if hull.is_empty() {
            return Bounds::EMPTY;
        }
        // What reaches the limit does not end.
        let largest = next.iter().map(|(bounds, _)| bounds.longest_side()).fold(0.0, f64::max);
        let ends = (0..3).all(|axis| {
            let ends = |side: f64, known: f64| known.is_finite() || side.abs() < 0.5 * LARGEST;
            ends(hull.min[axis], known.min[axis]) && ends(hull.max[axis], known.max[axis])
        });
        if ends && largest <= FINEST * hull.longest_side() {
            return hull.intersection(known);
        }
        if !ends && (next.len() > PATIENCE || largest < 1e-3 * LARGEST) {
            return *known;
        }
        if next.len() > PATIENCE {
            // A flat side takes many small boxes: what is known by now is near enough.
            return hull.intersection(known);
        }
        // Only boxes at the hull matter: what is well inside cannot move it.
        boxes = next
            .into_iter()
            .filter(|(bounds, _)| !inside(bounds, &hull, largest))
            .flat_map(|(bounds, program)| halves(&bounds).map(|half| (half, program.clone())))
            .collect();
    }
}

/// Whether a box is farther than `margin` from every side of the hull.
fn inside(bounds: &Bounds, hull: &Bounds, margin: f64) -> bool {
    let margin = DVec3::splat(margin);
    (bounds.min - hull.min).cmpgt(margin).all() && (hull.max - bounds.max).cmpgt(margin).all()
}

fn halves(bounds: &Bounds) -> [Bounds; 2] {
    let size = bounds.size();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let middle = bounds.center()[axis];
    let (mut low, mut high) = (*bounds, *bounds);
    low.max[axis] = middle;
    high.min[axis] = middle;
    [low, high]
}
