//! Blocks that may have lost a feature thinner than a cell.
//!
//! ```text
//!     o   o   o   o       o   o   o   o       *   *   *   *       Dots are nodes outside, stars
//!     ===========         \ o_* / o \ */      * _ * _ * _ *       nodes inside.
//!     o   o   o   o       o   o   o   o       *|_|*|_|*|_|*
//!     hidden: no node     torn: some nodes    bored: a hole or a gap
//!     is in the wall      are in the wall     between nodes
//! ```
//!
//! Extraction itself sees one sign at a time. Three tests cost next to nothing beside it:
//!
//! 1. *Hidden*: cells without a crossing, of blocks whose interval contained 0 when the octree was
//!    divided. The Lipschitz bound of the value clears most of them by their samples alone (sphere
//!    tracing's argument), and those that lead from one to the next to a crossing are tips of what
//!    is seen. What is left is divided and narrowed by intervals until it has no surface, or until
//!    it is a cell: that one is lost, unless it is entered once along a cone of directions, as a
//!    blunt tip is.
//! 2. *Torn*: a block with many nodes that have a root on either side along an axis, with opposite
//!    normals, less than [`WALL`] cells apart; or one in and about which most nodes of their sign
//!    are of this kind. The edge of an acute wedge has such nodes in a line before its others, a
//!    torn wall, however small, has no others.
//! 3. *Bored*: a block with a crossing that holds a convex leaf thinner than [`BORE`] cells, or
//!    whose surface is passed there and back [between nodes](super::skipped), by sides that are
//!    opposite or far from all that is seen.
//!
//! Intervals are budgeted: a block that is not decided in its share of them is counted. So hidden
//! features are counted if ranges do not tell, and few intervals are taken; the count is the same
//! for any number of threads.
//!
//! Limits: what is within [`TIP`](super::suspect::TIP) cells of a crossing may be taken for a tip of
//! what is seen there.

use glam::Vec3;

use super::parts::Parts;
use super::skipped::{Asked, Passed, Skips};
use super::suspect::{CellBits, Suspect, TIP};
use super::{Part, Sampler};
use crate::mesh::lattice::Lattice;
use crate::mesh::signs::{BLOCK, NODES, SIDE, Signs};
use rvachev_num::{Meter, jobs};

use crate::{Cancelled, Run};

/// No point of a cell is farther from the nearest of its nodes, in cells, with room for rounding:
/// half of the diagonal.
const REACH: f64 = 0.867;
/// Where no Lipschitz bound is known, the value is taken to be steeper than between any two nodes
/// of the block, by this factor.
const STEEPER: f64 = 1.5;
/// Two sides that are closer together, in cells, are those of a wall that may be torn.
const WALL: f32 = 1.1;
/// The cosine from which on normals are opposite.
const OPPOSITE: f32 = -0.8;
/// So many nodes between opposite sides tell of a torn wall in a block.
const TORN: u32 = 32;
/// A convex leaf that is thinner may pass between nodes, in cells.
pub(in crate::mesh) const BORE: f64 = 1.0;
/// What is found between nodes so near to a crossing, in cells, may be a tip of what is seen there.
const NEAR: usize = 1;
/// So many cells are about three edges at least.
const ABOUT_EDGES: usize = 9;
/// For how many blocks there is one narrowing, and how many more there are: intervals are to take
/// no more than 3 % of the time.
const BLOCKS_PER_INTERVAL: usize = 12;
const INTERVALS: usize = 256;
/// What a block has at least.
const LEAST: usize = 640;

/// Which cells of a block may have a surface by its samples, if any, but for what is seen in it and
/// for tips of that; and whether it is bored. Whether it is torn is seen later.
pub(super) fn suspected<S: Sampler>(
    (sampler, lattice): (&S, &Lattice),
    (scratch, skips): (&mut S::Scratch, &mut Skips),
    (number, block): (usize, [u32; 3]),
    (signs, values): (&Signs, &[f32; NODES]),
) -> Suspect {
    let slope = |by_samples: f64| {
        let bound = sampler.lipschitz_bound(number, block);
        if bound.is_finite() { bound * lattice.step() } else { by_samples }
    };
    let near = |slope: f64| CellBits::near(values, (REACH * slope) as f32);
    let none = Suspect { number, hidden: None, passed: None, torn: [0; 2], is_bored: false };
    if !signs.is_mixed() {
        let hidden = near(slope(STEEPER * steepest(values))).map(Box::new);
        return Suspect { hidden, ..none };
    }
    if !sampler.may_skip(number, block) {
        return Suspect { is_bored: sampler.is_bored(number, block), ..none };
    }
    // How steep it is where the surface is seen is seen as well.
    let steepest = steepest(values);
    let cells = near(STEEPER * steepest).map(|cells| cells.without_tips(signs)).filter(|cells| !cells.is_empty());
    let hidden = cells.map(Box::new);
    if sampler.is_bored(number, block) {
        return Suspect { hidden, is_bored: true, ..none };
    }
    // Of gaps that are steeper than all else some are found.
    let [most, step] = [slope(steepest), lattice.step()].map(|length| length as f32);
    let Passed { is_thin, cells } = skips.passed((sampler, scratch), Asked { number, most, step }, (signs, values));
    let cells = cells.map(|cells| cells.far_from(signs, [0; 3], NEAR)).filter(|cells| !cells.is_empty());
    Suspect { hidden, passed: cells.map(Box::new), is_bored: is_thin, ..none }
}

/// The most that the value changes by from node to node along an axis.
fn steepest(values: &[f32; NODES]) -> f64 {
    let (rows, _) = values.as_chunks::<SIDE>();
    // By the place in a row, so that lanes take it.
    let (mut along, mut across) = ([0.0f32; BLOCK], [0.0f32; SIDE]);
    for (n, row) in rows.iter().enumerate() {
        for (i, most) in along.iter_mut().enumerate() {
            let rise = (row[i + 1] - row[i]).abs();
            *most = if rise > *most { rise } else { *most };
        }
        // At the end of a layer and in the last one there is none above: itself.
        let next = if n % SIDE == BLOCK { row } else { &rows[n + 1] };
        let above = rows.get(n + SIDE).unwrap_or(row);
        for (i, most) in across.iter_mut().enumerate() {
            let (next, above) = ((next[i] - row[i]).abs(), (above[i] - row[i]).abs());
            let rise = if next > above { next } else { above };
            *most = if rise > *most { rise } else { *most };
        }
    }
    along.into_iter().chain(across).fold(0.0, f32::max).into()
}

/// How many nodes of a block there are between opposite sides, of a gap and of a wall, given the
/// vertices of the batch.
pub(super) fn torn_nodes(part: &Part, [positions, normals]: [&[Vec3]; 2], step: f64) -> [u32; 2] {
    let signs = &part.signs;
    let mut counts = [0; 2];
    for k in 0..BLOCK {
        for j in 0..BLOCK {
            let single = signs.single(j, k);
            let mut bits = single[0] | single[1] | single[2];
            while bits != 0 {
                let i = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let is_thin = |axis: usize| {
                    if single[axis] >> i & 1 == 0 {
                        return false;
                    }
                    let mut below = [i, j, k];
                    below[axis] -= 1;
                    let [a, b] = [below, [i, j, k]].map(|node| part.vertex(node, axis) as usize);
                    let (m, n) = (normals[a], normals[b]);
                    let across = (n - m).normalize_or_zero();
                    m.dot(n) < OPPOSITE && (positions[b] - positions[a]).dot(across).abs() < WALL * step as f32
                };
                counts[usize::from(signs.row(j, k) >> i & 1)] += u32::from((0..3).any(is_thin));
            }
        }
    }
    counts
}

/// All directions, and none.
fn directions() -> impl Iterator<Item = [i32; 3]> {
    (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1])
}

impl Parts<'_> {
    /// The block next to one in a direction.
    fn beside(&self, n: usize, step: [i32; 3]) -> Option<usize> {
        let faces = step.iter().filter(|&&by| by != 0).count();
        match step.iter().position(|&by| by != 0) {
            Some(axis) if faces == 1 && step[axis] < 0 => self.neighbours.lower(n, axis),
            Some(axis) if faces == 1 => self.neighbours.upper(n, 1 << axis),
            _ if faces == 0 => Some(n),
            _ => {
                let mut other = self.blocks[n];
                for axis in 0..3 {
                    other[axis] = other[axis].checked_add_signed(step[axis] * BLOCK as i32)?;
                }
                self.neighbours.find(other)
            }
        }
    }

    /// The numbers of the blocks that may have lost a feature, in ascending order.
    pub(super) fn lost<S: Sampler>(&self, sampler: &S, run: &Run) -> Result<Vec<usize>, Cancelled> {
        let suspects = &self.suspects;
        // Nodes between opposite sides, and all nodes, by their sign.
        let nodes = |n: usize| {
            let at = suspects.binary_search_by_key(&n, |suspect| suspect.number);
            [at.map_or([0; 2], |at| suspects[at].torn), self.part(n).signs.counts()]
        };
        let is_torn = |n: usize, counts: [u32; 2]| {
            let about = || {
                let blocks = directions().filter_map(|step| self.beside(n, step)).map(nodes);
                blocks.fold([[0; 2]; 2], |sum, of| [0, 1].map(|k| [0, 1].map(|sign| sum[k][sign] + of[k][sign])))
            };
            let is_most =
                |[torn, all]: [[u32; 2]; 2]| (0..2).any(|sign| counts[sign] > 0 && 2 * torn[sign] > all[sign]);
            counts[0] + counts[1] >= TORN || is_most(about())
        };
        // The cells of a block that are far from all that is seen in others.
        let far = |n: usize, cells: &CellBits, reach: usize| {
            let mut left = cells.clone();
            for step in directions().filter(|&step| step != [0; 3]) {
                if left.is_empty() {
                    break;
                }
                if let Some(other) = self.beside(n, step) {
                    left = left.far_from(&self.part(other).signs, step, reach);
                }
            }
            left
        };
        let (mut lost, mut open) = (Vec::new(), Vec::new());
        for &Suspect { number, ref hidden, ref passed, torn, is_bored } in suspects {
            let is_passed = || passed.as_ref().is_some_and(|cells| far(number, cells, NEAR).count() >= ABOUT_EDGES);
            if is_bored || torn != [0; 2] && is_torn(number, torn) || is_passed() {
                lost.push(number);
            } else if let Some(cells) = hidden {
                let left = far(number, cells, TIP);
                if !left.is_empty() {
                    open.push((number, left));
                }
            }
        }
        // Each has the same share, whatever the order.
        let share = (self.blocks.len() / BLOCKS_PER_INTERVAL + INTERVALS) / open.len().max(1);
        let share = share.max(LEAST);
        let meter = Meter::new(run, open.len());
        let is_lost = |(number, cells): &(usize, CellBits)| {
            meter.step()?;
            Ok(sampler.may_hide(*number, self.blocks[*number], cells, share).then_some(*number))
        };
        let hidden: Result<Vec<Option<usize>>, Cancelled> = jobs::try_in_order(open.len(), |n| is_lost(&open[n]));
        lost.extend(hidden?.into_iter().flatten());
        lost.sort_unstable();
        Ok(lost)
    }
}
