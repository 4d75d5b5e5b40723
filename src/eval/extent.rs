//! The box of a solid that its parts do not tell: found by narrowing.
//!
//! From a box of all that can be evaluated, half by half, what holds no surface is left out.

use glam::DVec3;

use super::{Program, Region};
use crate::{Bounds, Cancelled, Run};

/// Boxes are halved until they are this small, in proportion to what is found.
const FINEST: f64 = 1.0 / 64.0;

/// With more boxes than this, what is known by then is near enough: a flat side takes many.
const PATIENCE: usize = 3000;

/// More boxes than this before the hull is off the limit say that the solid does not end; one
/// that ends is in the eight boxes about the origin until then.
const IMPATIENCE: usize = 200;

/// Solids larger than this count as unbounded.
const LARGEST: f64 = 1e9;

/// A box that holds the inside of `program`; `known` is one along the axes where it is finite.
pub(super) fn extent(program: &Program, known: &Bounds, run: &Run) -> Result<Bounds, Cancelled> {
    let limit = DVec3::splat(LARGEST);
    let start = known.intersection(&Bounds::new(-limit, limit));
    // All boxes that may hold some of it, of different sizes: only those that the hull rests on
    // are halved.
    let mut boxes: Vec<(Bounds, Program)> = narrowed(start, program).into_iter().collect();
    loop {
        run.check()?;
        let hull = boxes.iter().fold(Bounds::EMPTY, |hull, (bounds, _)| hull.union(bounds));
        if hull.is_empty() {
            return Ok(Bounds::EMPTY);
        }
        // What reaches the limit does not end.
        let ends = (0..3).all(|axis| {
            let ends = |side: f64, known: f64| known.is_finite() || side.abs() < 0.5 * LARGEST;
            ends(hull.min[axis], known.min[axis]) && ends(hull.max[axis], known.max[axis])
        });
        let finest = if ends { FINEST * hull.longest_side() } else { 1e-3 * LARGEST };
        let halved = |bounds: &Bounds| rests(&hull, bounds) && bounds.longest_side() > finest;
        let count = boxes.iter().filter(|(bounds, _)| halved(bounds)).count();
        if count == 0 || boxes.len() > if ends { PATIENCE } else { IMPATIENCE } {
            return Ok(if ends { hull.intersection(known) } else { *known });
        }
        let mut next = Vec::with_capacity(boxes.len() + count);
        for (bounds, program) in boxes {
            if halved(&bounds) {
                next.extend(halves(&bounds).into_iter().filter_map(|half| narrowed(half, &program)));
            } else {
                next.push((bounds, program));
            }
        }
        boxes = next;
    }
}

/// The box with the program narrowed to it, if it may hold some of the inside.
fn narrowed(bounds: Bounds, program: &Program) -> Option<(Bounds, Program)> {
    match program.narrow(&bounds) {
        Region::Outside => None,
        Region::Inside => Some((bounds, program.clone())),
        Region::Surface(narrowed) => Some((bounds, narrowed)),
    }
}

/// Whether a side of the hull is one of the box.
fn rests(hull: &Bounds, bounds: &Bounds) -> bool {
    bounds.min.cmple(hull.min).any() || bounds.max.cmpge(hull.max).any()
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
