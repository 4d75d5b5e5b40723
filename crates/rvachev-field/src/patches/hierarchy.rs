//! Boxes within boxes over patches (a bounding volume hierarchy), split where the boxes' surface
//! times their contents is least: the chance that a search looks into a box goes with its surface.

use rvachev_num::{Cancelled, Run};

/// A box: low and high corner.
pub(super) type Box3 = [[f32; 3]; 2];

const EMPTY: Box3 = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];

/// How many patches a box without children holds at most: to look at a patch takes little more than
/// to look at a box, and can be done without waiting for what the last one gave.
pub(super) const LEAF: usize = 8;

/// So few patches are not worth the slices: they are halved.
const FEW: usize = 32;

/// Into how many slices a box is cut to find the best split.
const BINS: usize = 16;

/// From this depth on boxes are split in halves, which ends after 32 more levels.
const SKEWED: u32 = 48;

/// How many boxes a search may have to come back to, and one more.
pub(super) const DEEPEST: usize = SKEWED as usize + 34;

/// A box with two children, or with patches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// The first of its patches, or the first of its children, which stand side by side.
    pub(super) first: u32,
    /// How many patches it holds; if it has children, [`PARENT`] and the axis along which the first
    /// of them is below the other.
    pub(super) count: u32,
}

/// The count of a box with children, less the axis.
pub(super) const PARENT: u32 = 256;

/// The hierarchy, and the order in which its boxes hold the patches.
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) order: Vec<u32>,
}

/// A box whose patches are still to be split.
struct Task {
    node: usize,
    from: usize,
    to: usize,
    depth: u32,
}

impl Tree {
    pub(super) fn new(boxes: &[Box3], run: &Run) -> Result<Tree, Cancelled> {
        let mut items: Vec<(u32, Box3)> = (0..).zip(boxes.iter().copied()).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        let mut tasks = Vec::new();
        if !items.is_empty() {
            nodes.push(Node { low: [0.0; 3], high: [0.0; 3], first: 0, count: 0 });
            tasks.push(Task { node: 0, from: 0, to: items.len(), depth: 0 });
        }
        while let Some(Task { node, from, to, depth }) = tasks.pop() {
            if to - from > 1024 {
                run.check()?;
                // What is beyond is done.
                run.report(1.0 - to as f64 / items.len() as f64);
            }
            let part = &mut items[from..to];
            let whole = part.iter().fold(EMPTY, |all, (_, own)| union(all, *own));
            let [low, high] = whole;
            if part.len() <= LEAF {
                nodes[node] = Node { low, high, first: from as u32, count: (to - from) as u32 };
                continue;
            }
            let (axis, middle) = if depth < SKEWED { split(part) } else { (0, part.len() / 2) };
            let first = nodes.len();
            nodes[node] = Node { low, high, first: first as u32, count: PARENT + axis as u32 };
            nodes.extend([nodes[node]; 2]);
            tasks.push(Task { node: first, from, to: from + middle, depth: depth + 1 });
            tasks.push(Task { node: first + 1, from: from + middle, to, depth: depth + 1 });
        }
        Ok(Tree { nodes, order: items.into_iter().map(|(patch, _)| patch).collect() })
    }
}

fn union([a, b]: Box3, [c, d]: Box3) -> Box3 {
    let mut all = [a, b];
    for i in 0..3 {
        // One instruction each, as these are numbers.
        all[0][i] = if c[i] < a[i] { c[i] } else { a[i] };
        all[1][i] = if d[i] > b[i] { d[i] } else { b[i] };
    }
    all
}

/// Half the surface of a box; 0 of the empty one.
fn surface([low, high]: Box3) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|i| (high[i] - low[i]).max(0.0));
    x * y + y * z + z * x
}

/// Twice the middle of a box.
fn middle([low, high]: Box3) -> [f32; 3] {
    [low[0] + high[0], low[1] + high[1], low[2] + high[2]]
}

/// Sorts patches into two parts, and says along which axis and where the second starts.
fn split(items: &mut [(u32, Box3)]) -> (usize, usize) {
    let span = items.iter().fold(EMPTY, |span, (_, own)| union(span, [middle(*own); 2]));
    if items.len() <= FEW {
        return halve(items, span);
    }
    let bins = Bins::new(span);
    let Some((axis, cut)) = bins.filled(items).best() else {
        return (0, items.len() / 2);
    };
    let mut count = 0;
    for i in 0..items.len() {
        if bins.of(axis, middle(items[i].1)[axis]) < cut {
            items.swap(i, count);
            count += 1;
        }
    }
    (axis, count)
}

/// Sorts patches into two halves along the longest side of the box of their middles.
fn halve(items: &mut [(u32, Box3)], [low, high]: Box3) -> (usize, usize) {
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let longest = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |(_, a), (_, b)| middle(*a)[longest].total_cmp(&middle(*b)[longest]));
    (longest, half)
}

/// Slices of a box along the three axes: how many patches have their middles there, and their box.
struct Bins {
    low: [f32; 3],
    per_width: [f32; 3],
    bins: [[(u32, Box3); BINS]; 3],
}

impl Bins {
    fn new([low, high]: Box3) -> Bins {
        let per_width = [0, 1, 2].map(|i| {
            let width = high[i] - low[i];
            if width > 0.0 { BINS as f32 * (1.0 - f32::EPSILON) / width } else { 0.0 }
        });
        Bins { low, per_width, bins: [[(0, EMPTY); BINS]; 3] }
    }

    /// The slice that a middle is in.
    fn of(&self, axis: usize, middle: f32) -> usize {
        (((middle - self.low[axis]) * self.per_width[axis]) as usize).min(BINS - 1)
    }

    fn filled(&self, items: &[(u32, Box3)]) -> Bins {
        let mut filled = Bins { bins: self.bins, ..*self };
        for (_, own) in items {
            let middle = middle(*own);
            for (axis, middle) in middle.into_iter().enumerate() {
                let (count, all) = &mut filled.bins[axis][self.of(axis, middle)];
                *count += 1;
                *all = union(*all, *own);
            }
        }
        filled
    }

    /// The axis and the first slice beyond the best cut; none if all middles are at one place.
    fn best(&self) -> Option<(usize, usize)> {
        let mut best = (f32::INFINITY, None);
        for (axis, bins) in self.bins.iter().enumerate() {
            let mut below = [0.0; BINS];
            let mut sum = (0, EMPTY);
            for (cut, bin) in bins.iter().enumerate() {
                below[cut] = if sum.0 > 0 { sum.0 as f32 * surface(sum.1) } else { f32::INFINITY };
                sum = (sum.0 + bin.0, union(sum.1, bin.1));
            }
            let mut sum = (0, EMPTY);
            for cut in (1..BINS).rev() {
                sum = (sum.0 + bins[cut].0, union(sum.1, bins[cut].1));
                let cost = below[cut] + sum.0 as f32 * surface(sum.1);
                if sum.0 > 0 && cost < best.0 {
                    best = (cost, Some((axis, cut)));
                }
            }
        }
        best.1
    }
}
