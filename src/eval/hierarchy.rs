//! A bounding-volume hierarchy over the operands of a long join.
//!
//! Operands are ordered in space by median splits; the hierarchy is a list of boxes in
//! depth-first order, each with the place to go on at when the box is missed.

use glam::DVec3;

use crate::Bounds;

/// Joins of fewer operands are scanned.
const SCANNED: usize = 8;

/// Operands in a leaf of the hierarchy.
const BUCKET: usize = 4;

pub(crate) struct Hierarchy {
    boxes: Vec<Item>,
    operands: Vec<Bounds>,
}

struct Item {
    bounds: Bounds,
    /// Where to go on if the box is missed.
    skip: u32,
    /// The operands of a bucket; empty for inner boxes.
    operands: std::ops::Range<u32>,
}

impl Hierarchy {
    /// Sorts `operands`, each with the box in which it decides anything, in space.
    pub(crate) fn sort<T: Copy>(operands: &mut [(T, Bounds)]) {
        if operands.len() < SCANNED {
            return;
        }
        let mut pending = vec![(0, operands.len())];
        while let Some((from, to)) = pending.pop() {
            if to - from <= BUCKET {
                continue;
            }
            let slice = &mut operands[from..to];
            let mut centres = Bounds::EMPTY;
            for (_, bounds) in slice.iter() {
                let c = centre(bounds);
                centres = centres.union(&Bounds::new(c, c));
            }
            let size = centres.size();
            let axis = if size.x >= size.y && size.x >= size.z {
                0
            } else if size.y >= size.z {
                1
            } else {
                2
            };
            let middle = slice.len() / 2;
            slice.select_nth_unstable_by(middle, |a, b| centre(&a.1)[axis].total_cmp(&centre(&b.1)[axis]));
            pending.push((from, from + middle));
            pending.push((from + middle, to));
        }
    }

    /// The hierarchy over some of its operands, named in rising order; none for few.
    pub(crate) fn subset(&self, operands: &[u32]) -> Option<Hierarchy> {
        if operands.len() < SCANNED {
            return None;
        }
        Hierarchy::new(operands.iter().map(|&i| self.operands[i as usize]).collect())
    }

    /// The hierarchy over boxes that [`sort`](Hierarchy::sort) has ordered; none for few.
    pub(crate) fn new(bounds: Vec<Bounds>) -> Option<Hierarchy> {
        if bounds.len() < SCANNED {
            return None;
        }
        enum Task {
            Open(usize, usize),
            Close(usize),
        }
        let mut boxes: Vec<Item> = Vec::with_capacity(4 * bounds.len().div_ceil(BUCKET));
        let mut tasks = vec![Task::Open(0, bounds.len())];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Open(from, to) => {
                    let all = bounds[from..to].iter().fold(Bounds::EMPTY, |all, b| all.union(b));
                    let at = boxes.len();
                    let bucket = to - from <= BUCKET;
                    let operands = if bucket { from as u32..to as u32 } else { 0..0 };
                    boxes.push(Item { bounds: all, skip: 0, operands });
                    tasks.push(Task::Close(at));
                    if !bucket {
                        let middle = from + (to - from) / 2;
                        tasks.push(Task::Open(middle, to));
                        tasks.push(Task::Open(from, middle));
                    }
                }
                Task::Close(at) => boxes[at].skip = boxes.len() as u32,
            }
        }
        Some(Hierarchy { boxes, operands: bounds })
    }

    /// Calls `visit` with every operand whose bucket meets `region`.
    pub(crate) fn visit(&self, region: &Bounds, mut visit: impl FnMut(usize)) {
        let mut at = 0;
        while at < self.boxes.len() {
            let item = &self.boxes[at];
            if item.bounds.intersects(region) {
                item.operands.clone().for_each(|operand| visit(operand as usize));
                at += 1;
            } else {
                at = item.skip as usize;
            }
        }
    }
}

fn centre(bounds: &Bounds) -> DVec3 {
    if bounds.is_finite() { bounds.center() } else { DVec3::ZERO }
}
