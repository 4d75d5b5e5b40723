//! A bounding-volume hierarchy over the operands of a long join.
//!
//! Operands are ordered in space by median splits; the hierarchy is a list of boxes in depth-first
//! order, each with the place to go on at when the box is missed. Of operands whose values are
//! read, the boxes grow with how far below 0 a value still matters.

use glam::DVec3;

use crate::Bounds;

/// Joins of fewer operands are scanned.
const SCANNED: usize = 8;

/// Operands in a leaf of the hierarchy.
const BUCKET: usize = 4;

/// Where an operand matters: its value is above −c within `bounds`, grown by `growth · c`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) bounds: Bounds,
    pub(crate) growth: DVec3,
}

impl Reach {
    /// Of an operand that matters in a box, whatever is asked.
    pub(crate) fn fixed(bounds: Bounds) -> Reach {
        Reach { bounds, growth: DVec3::ZERO }
    }

    /// One that holds both: where one is nowhere, at least the other.
    #[inline(always)]
    fn union(&self, other: &Reach) -> Reach {
        let (a, b) = (&self.bounds, &other.bounds);
        Reach { bounds: Bounds::new(a.min.min(b.min), a.max.max(b.max)), growth: self.growth.max(other.growth) }
    }

    /// Whether the operand may matter in a box, which holds a point, down to −c.
    #[inline(always)]
    fn meets(&self, region: &Bounds, c: f64) -> bool {
        let by = if c > 0.0 { c * self.growth } else { DVec3::ZERO };
        // Of nowhere the least corner is beyond everything.
        self.bounds.min.cmple(region.max + by).all() && self.bounds.max.cmpge(region.min - by).all()
    }
}

pub(crate) struct Hierarchy {
    boxes: Vec<Item>,
    /// In the order of the boxes.
    operands: Vec<Reach>,
    /// The numbers of the operands in their join, if they are in another order there.
    numbers: Vec<u32>,
}

struct Item {
    reach: Reach,
    /// Where to go on if the box is missed.
    skip: u32,
    /// The operands of a bucket; empty for inner boxes.
    operands: std::ops::Range<u32>,
}

impl Hierarchy {
    /// Sorts `operands` in space.
    pub(crate) fn sort<T: Copy>(operands: &mut [(T, Reach)]) {
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
            for (_, reach) in slice.iter() {
                let c = centre(reach);
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
        if self.numbers.is_empty() {
            return Hierarchy::new(operands.iter().map(|&i| self.operands[i as usize]).collect(), Vec::new());
        }
        let kept = self.numbers.iter().zip(&self.operands);
        let kept = kept.filter_map(|(number, reach)| Some((operands.binary_search(number).ok()? as u32, *reach)));
        let (numbers, reaches): (Vec<u32>, Vec<Reach>) = kept.unzip();
        Hierarchy::new(reaches, numbers)
    }

    /// The hierarchy over operands that [`sort`](Hierarchy::sort) has ordered; none for few.
    pub(crate) fn new(operands: Vec<Reach>, numbers: Vec<u32>) -> Option<Hierarchy> {
        if operands.len() < SCANNED {
            return None;
        }
        enum Task {
            Open(usize, usize),
            Close(usize),
        }
        let mut boxes: Vec<Item> = Vec::with_capacity(4 * operands.len().div_ceil(BUCKET));
        let mut tasks = vec![Task::Open(0, operands.len())];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Open(from, to) => {
                    let nowhere = Reach::fixed(Bounds::EMPTY);
                    let reach = operands[from..to].iter().fold(nowhere, |all, own| all.union(own));
                    let at = boxes.len();
                    let bucket = to - from <= BUCKET;
                    let operands = if bucket { from as u32..to as u32 } else { 0..0 };
                    boxes.push(Item { reach, skip: 0, operands });
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
        Some(Hierarchy { boxes, operands, numbers })
    }

    /// The bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        let Hierarchy { boxes, operands, numbers } = self;
        size_of_val(&**boxes) + size_of_val(&**operands) + size_of_val(&**numbers)
    }

    /// Calls `visit` with every operand whose bucket may matter in `region` down to −c.
    pub(crate) fn visit(&self, region: &Bounds, c: f64, mut visit: impl FnMut(usize)) {
        let mut at = 0;
        while at < self.boxes.len() {
            let item = &self.boxes[at];
            if item.reach.meets(region, c) {
                item.operands.clone().for_each(|operand| visit(operand as usize));
                at += 1;
            } else {
                at = item.skip as usize;
            }
        }
    }

    /// The operands that may matter in `region` down to −c, in the order of their join.
    pub(crate) fn near(&self, region: &Bounds, c: f64) -> Vec<u32> {
        let mut near = Vec::new();
        self.visit(region, c, |operand| {
            if self.operands[operand].meets(region, c) {
                near.push(self.numbers.get(operand).copied().unwrap_or(operand as u32));
            }
        });
        near.sort_unstable();
        near
    }
}

fn centre(reach: &Reach) -> DVec3 {
    if reach.bounds.is_finite() { reach.bounds.center() } else { DVec3::ZERO }
}
