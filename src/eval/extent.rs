//! The box of a solid that its parts do not tell: found by narrowing.
//!
//! From a box of all that can be evaluated, half by half, what holds no surface is left out. The
//! sides of what is left are then [moved in](super::moved_in).

use glam::DVec3;

use super::Program;
use super::moved_in::{Part, halves, moved_in, narrowed, toll};
use crate::{Bounds, Cancelled, Run};

/// Boxes are halved until they are this small, in proportion to what is found.
const FINEST: f64 = 1.0 / 64.0;

/// With more boxes than this, what is known by then is near enough: a flat side takes many.
const PATIENCE: usize = 3000;

/// About as many ordinary leaves are asked about boxes once the hull hardly becomes smaller: what
/// takes long to ask is known less well.
const EFFORT: usize = 100_000;

/// A round after which the hull is so much smaller, by its volume, was worth it: it does not count.
const SHRINKS: f64 = 0.9;

/// More boxes than this before the hull is off the limit say that the solid does not end; one
/// that ends is in the eight boxes about the origin until then.
const IMPATIENCE: usize = 200;

/// Solids larger than this count as unbounded.
const LARGEST: f64 = 1e9;

/// About so many rounds take a side from the limit to 1, halved along each axis in turn.
const ROUNDS: f64 = 90.0;

/// A box that holds the inside of `program`, its sides moved in where they are told by values;
/// `known` is one along the axes where it is finite.
pub(super) fn extent(program: &Program, known: &Bounds, run: &Run) -> Result<Bounds, Cancelled> {
    let limit = DVec3::splat(LARGEST);
    let start = if known.is_finite() { *known } else { known.intersection(&Bounds::new(-limit, limit)) };
    // All boxes that may hold some of it, of different sizes: only those that the hull rests on
    // are halved.
    let mut boxes: Vec<Part> = narrowed(start, program).into_iter().collect();
    if known.is_finite() {
        return moved_in(program, boxes, run);
    }
    let [looking, halving, moving] = run.stages([1.0; 3]);
    let most = EFFORT / toll(program);
    let (mut rounds, mut asked, mut volume) = (0.0, 0, f64::INFINITY);
    loop {
        run.check()?;
        let hull = boxes.iter().fold(Bounds::EMPTY, |hull, part| hull.union(&part.bounds));
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
        let count = boxes.iter().filter(|part| halved(&part.bounds)).count();
        let is_near = hull.size().element_product() > SHRINKS * volume;
        volume = hull.size().element_product();
        let enough = if ends { boxes.len() > PATIENCE || asked > most } else { boxes.len() > IMPATIENCE };
        if count == 0 || enough {
            return if ends { Ok(moved_in(program, boxes, &moving)?.intersection(known)) } else { Ok(*known) };
        }
        if ends && is_near {
            asked += 2 * count;
            halving.report(asked as f64 / most as f64);
        } else {
            rounds += 1.0;
            looking.report(rounds / ROUNDS);
        }
        let mut next = Vec::with_capacity(boxes.len() + count);
        for part in boxes {
            run.check()?;
            if halved(&part.bounds) {
                next.extend(
                    halves(&part.bounds, part.bounds.size().max_position())
                        .into_iter()
                        .filter_map(|half| narrowed(half, &part.program)),
                );
            } else {
                next.push(part);
            }
        }
        boxes = next;
    }
}

/// Whether a side of the hull is one of the box.
fn rests(hull: &Bounds, bounds: &Bounds) -> bool {
    bounds.min.cmple(hull.min).any() || bounds.max.cmpge(hull.max).any()
}
