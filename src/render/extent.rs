//! Where a solid ends, closer than its box says.
//!
//! A solid's box is safe and not tight, and a shadow shows a gap of a hundredth. The lowest
//! point is searched by halving boxes, the lowest first, and leaving out what is all outside.
//! What a camera shall hold is found in the same way, all boxes halved equally often.
//!
//! ```text
//!      +-------+
//!      |   .   |   outside boxes are left out; the search ends at the first box of the
//!      +---+---+   finest size that is not
//!      |out| ? |
//!      +---+---+
//! ```

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::Bounds;
use crate::eval::{Program, Region};

/// Boxes are halved in every direction this many times: the result is exact to a thousandth of
/// the height.
const HALVINGS: u32 = 11;

/// More boxes than this are not looked at: the lowest one left is taken as it is.
const MOST: usize = 6000;

/// A box that may hold the lowest point.
struct Candidate {
    bounds: Bounds,
    program: Program,
    halvings: u32,
}

impl Candidate {
    /// Lower first; of equally low ones the smaller first, so that flat bottoms end the search.
    fn order(&self, other: &Candidate) -> Ordering {
        let lower = other.bounds.min.z.total_cmp(&self.bounds.min.z);
        lower.then(self.halvings.cmp(&other.halvings))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.order(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Candidate) -> Ordering {
        self.order(other)
    }
}

/// The height of the lowest point of a solid within `bounds`, or a little less.
pub(super) fn lowest(program: &Program, bounds: &Bounds) -> f64 {
    let mut heap = BinaryHeap::new();
    heap.push(Candidate { bounds: *bounds, program: program.clone(), halvings: 0 });
    let mut met = 0;
    while let Some(Candidate { bounds, program, halvings }) = heap.pop() {
        met += 1;
        if halvings == HALVINGS || met > MOST {
            return bounds.min.z;
        }
        for bounds in bounds.octants() {
            let program = match program.narrow(&bounds) {
                Region::Outside => continue,
                // Nothing to narrow: all of its halves are inside as well.
                Region::Inside => program.clone(),
                Region::Surface(narrowed) => narrowed,
            };
            heap.push(Candidate { bounds, program, halvings: halvings + 1 });
        }
    }
    bounds.min.z
}

/// The corners of the boxes, 16 along each side of `bounds`, that the surface may cross.
pub(super) fn corners(program: &Program, bounds: &Bounds) -> Vec<DVec3> {
    let mut boxes = vec![(*bounds, program.clone())];
    for _ in 0..4 {
        let halved = boxes.iter().flat_map(|(bounds, program)| bounds.octants().map(|part| (part, program)));
        let kept = halved.filter_map(|(part, program)| match program.narrow(&part) {
            Region::Surface(narrowed) => Some((part, narrowed)),
            // What is all inside lies between boxes that the surface crosses.
            Region::Inside | Region::Outside => None,
        });
        boxes = kept.collect();
    }
    boxes.iter().flat_map(|(bounds, _)| bounds.corners()).collect()
}
