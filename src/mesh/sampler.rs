//! The surface program of a solid, sampled for the extractor.

use std::sync::OnceLock;

use glam::{DVec3, Vec3A};
use rvachev_num::jobs;

use super::blocks::{Blocks, Programs, exact_nodes};
use super::deciders::Deciders;
use super::extract::{BATCH, BORE, CellBits, Root, Sampler};
use super::feature::{Crease, Slope};
use super::hide::may_hide;
use super::lattice::Lattice;
use super::signs::{BLOCK, EdgeRef, NODES, SIDE};
use crate::Bounds;
use crate::eval::{Evaluator, Gradients, Tape};

/// The surface program, block by block.
///
/// The blocks of a batch that have the same program form a group; a group has one tape.
pub(super) struct SolidSampler<'a> {
    lattice: &'a Lattice,
    blocks: &'a [[u32; 3]],
    programs: &'a Programs,
    /// Which of the blocks are sampled in double precision, by their programs.
    exact: &'a [bool],
    /// The number of the first block of each block's group.
    groups: Vec<u32>,
    /// The box that the surface is in.
    limits: Bounds,
    crease: Crease,
    /// The nodes of a block, relative to the first, x fastest.
    pattern: [Vec<f32>; 3],
    /// Which leaves of the solid pass between nodes, if any do.
    thin: Vec<bool>,
    /// Values of nodes count up to this; beyond, their signs do.
    band: f64,
    /// By batch, the tapes of its groups once its roots are found; empty if they are not to be
    /// kept.
    kept: Vec<OnceLock<Vec<(u32, Tape)>>>,
}

/// The ends of edges that the surface crosses are no farther from it than this, in cells, nor are
/// the nearest corners of a cell that it is in.
pub(super) const BESIDE: f64 = 1.0;

/// Roots that are found at once; a multiple of the points that lanes are run on.
const AT_ONCE: usize = 2048;

/// So many layers of a block's nodes are sampled together: a third of them.
const LAYERS: usize = 3;

/// What a thread keeps from block to block.
#[derive(Default)]
pub(super) struct Scratch {
    evaluator: Evaluator,
    /// The tapes of the groups sampled since roots were asked for.
    tapes: Vec<(u32, Tape)>,
    /// That which slopes were asked of last, and the block that it is for.
    copy: Option<(usize, Tape)>,
    finder: Deciders,
    single: [Vec<f32>; 3],
    slopes: [Vec<f32>; 4],
    /// Edges in the order of their groups: their places, themselves, their roots.
    order: Vec<u32>,
    edges: Vec<EdgeRef>,
    roots: Vec<Root>,
}

impl Scratch {
    /// Leaves no more tapes than a search of them is worth.
    pub(super) fn forget(&mut self) {
        if self.tapes.len() > 16 {
            self.tapes.clear();
        }
    }
}

impl SolidSampler<'_> {
    /// Values of nodes are right up to so many cells from the surface, by distances; beyond, their
    /// signs are.
    pub(super) fn new<'a>(lattice: &'a Lattice, blocks: &'a Blocks, limits: Bounds, cells: f64) -> SolidSampler<'a> {
        let band = cells * lattice.step();
        let Blocks { cells: blocks, programs, exact } = blocks;
        let mut groups = vec![0; blocks.len()];
        jobs::for_chunks_mut(&mut groups, BATCH, |batch, groups| {
            let mut heads: Vec<u32> = Vec::new();
            for (n, group) in (batch * BATCH..).zip(groups) {
                // The latest first: blocks that follow each other are near each other.
                let head = heads.iter().rev().find(|&&head| programs.is_same(head as usize, n));
                *group = head.copied().unwrap_or(n as u32);
                if *group == n as u32 {
                    heads.push(*group);
                }
            }
        });
        let at = |node: usize, stride: usize| (node / stride % SIDE) as f64 * lattice.step();
        let pattern = [1, SIDE, SIDE * SIDE].map(|stride| (0..NODES).map(|n| at(n, stride) as f32).collect());
        let mut thin = programs.first().map_or(Vec::new(), |program| program.thin_leaves(BORE * lattice.step()));
        if !thin.contains(&true) {
            thin.clear();
        }
        let (crease, kept) = (Crease::USUAL, Vec::new());
        SolidSampler { lattice, blocks, programs, exact, groups, limits, crease, pattern, thin, band, kept }
    }

    /// The tape of a group, made if it is not among those at hand.
    fn tape_of<'t>(&self, tapes: &'t mut Vec<(u32, Tape)>, group: u32) -> &'t mut Tape {
        // The latest first: blocks that follow each other are near each other.
        let made = tapes.iter().rposition(|(other, _)| *other == group);
        let at = made.unwrap_or_else(|| {
            tapes.push((group, self.tape(group)));
            tapes.len() - 1
        });
        &mut tapes[at].1
    }

    /// The tape of a block for slopes, relative to its first node: that which the roots of its
    /// group were found with, if it is kept. Moved from block to block it rounds, so each block
    /// starts from the same.
    fn tape_for_slopes<'t>(&self, copy: &'t mut Option<(usize, Tape)>, number: usize, origin: DVec3) -> &'t Tape {
        let group = self.groups[number];
        let kept = self.kept.get(group as usize / BATCH).and_then(OnceLock::get);
        let kept = kept.and_then(|tapes| tapes.iter().find(|(other, _)| *other == group));
        let made = || {
            let mut tape = kept.map_or_else(|| self.tape(group), |(_, kept)| kept.clone());
            tape.recentre(origin);
            tape
        };
        let (block, tape) = copy.get_or_insert_with(|| (number, made()));
        if *block != number {
            *block = number;
            match kept {
                Some((_, kept)) => tape.become_recentred(kept, origin),
                None => *tape = made(),
            }
        }
        tape
    }

    /// Looks for creases and corners, of which these are the creases.
    pub(super) fn look_for(&mut self, crease: Crease) {
        self.crease = crease;
        // Slopes are asked for after all roots.
        self.kept.resize_with(self.blocks.len().div_ceil(BATCH), OnceLock::new);
    }

    /// Places points of the block that was sampled last, and says which tape at hand is that
    /// block's.
    fn place_at_hand(&self, scratch: &mut Scratch, number: usize, points: &[Vec3A]) -> Option<usize> {
        let step = self.lattice.step() as f32;
        place(points.iter().map(|p| step * *p), &mut scratch.single);
        scratch.tapes.iter().rposition(|(group, _)| *group == self.groups[number])
    }

    /// Ends the use of the tapes of a batch for roots.
    fn put_by(&self, batch: usize, tapes: &mut Vec<(u32, Tape)>) {
        match self.kept.get(batch) {
            // The roots of a batch are asked for once.
            Some(kept) => _ = kept.set(std::mem::take(tapes)),
            None => tapes.clear(),
        }
    }

    /// A tape for the group that starts with a block.
    fn tape(&self, group: u32) -> Tape {
        let first = group as usize;
        let batch = first..(first / BATCH * BATCH + BATCH).min(self.blocks.len());
        let bounds = batch
            .filter(|&n| self.groups[n] == group)
            .fold(Bounds::EMPTY, |all, n| all.union(&self.lattice.region(self.blocks[n], BLOCK)));
        Tape::new(self.programs.of(first), &bounds)
    }
}

impl Sampler for SolidSampler<'_> {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn limits(&self) -> Bounds {
        self.limits
    }

    fn watches(&self) -> bool {
        true
    }

    fn crease(&self) -> Crease {
        self.crease
    }

    fn lipschitz_bound(&self, number: usize, block: [u32; 3]) -> f64 {
        self.programs.of(number).slope_within(&self.lattice.region(block, BLOCK))
    }

    fn is_bored(&self, number: usize, block: [u32; 3]) -> bool {
        !self.thin.is_empty() && self.programs.of(number).has_leaf_of(&self.thin, &self.lattice.region(block, BLOCK))
    }

    fn may_skip(&self, number: usize, _block: [u32; 3]) -> bool {
        self.exact.get(number) != Some(&true) && !self.programs.of(number).is_one_convex()
    }

    fn values_at_hand(&self, scratch: &mut Scratch, number: usize, points: &[Vec3A], out: &mut Vec<f32>) -> bool {
        let Some(tape) = self.place_at_hand(scratch, number, points) else { return false };
        let Scratch { evaluator, tapes, single: [x, y, z], .. } = scratch;
        let from = out.len();
        out.resize(from + points.len(), 0.0);
        evaluator.shortest_values(&tapes[tape].1, [x, y, z], &mut out[from..]);
        true
    }

    fn slopes_at_hand(&self, scratch: &mut Scratch, number: usize, points: &[Vec3A], out: &mut Vec<Slope>) -> bool {
        let Some(tape) = self.place_at_hand(scratch, number, points) else { return false };
        let Scratch { evaluator, tapes, single, slopes, .. } = scratch;
        gradients(evaluator, &tapes[tape].1, single, slopes, out);
        true
    }

    fn may_hide(&self, number: usize, block: [u32; 3], cells: &CellBits, intervals: usize) -> bool {
        may_hide(self.programs.of(number), (self.lattice, block), cells, intervals)
    }

    fn nodes(&self, scratch: &mut Scratch, number: usize, block: [u32; 3], out: &mut [f32; NODES]) {
        let group = self.groups[number];
        let tape = self.tape_of(&mut scratch.tapes, group);
        if self.exact.get(number) == Some(&true) {
            return exact_nodes(self.programs.of(number), (self.lattice, &self.limits), block, out);
        }
        tape.recentre(self.lattice.node(block[0], block[1], block[2]));
        // A few layers at a time: not all leaves of the block reach all of them. Nodes beside those
        // inside of a leaf are in its reach.
        for (layers, out) in out.chunks_mut(LAYERS * SIDE * SIDE).enumerate() {
            let first = layers * LAYERS;
            let points = self.pattern.each_ref().map(|axis| &axis[first * SIDE * SIDE..][..out.len()]);
            let [x, y, z] = block;
            let low = self.lattice.node(x, y, z + first as u32);
            let last = first + out.len() / (SIDE * SIDE) - 1;
            let high = self.lattice.node(x + BLOCK as u32, y + BLOCK as u32, z + last as u32);
            let region = Bounds::new(low, high).inflate(1.01 * self.lattice.step());
            scratch.evaluator.values_in((tape, &region), self.band, points, out);
        }
        // A sign that rounding may have turned is settled in double precision.
        let doubt = tape.roundoff() as f32;
        if !out.iter().fold(false, |any, value| any | (value.abs() <= doubt)) {
            return;
        }
        let (program, scale) = (self.programs.of(number), self.lattice.scale());
        for (n, value) in out.iter_mut().enumerate() {
            if value.abs() <= doubt {
                let at = |axis: usize, stride: usize| block[axis] + (n / stride % SIDE) as u32;
                let node = self.lattice.node(at(0, 1), at(1, SIDE), at(2, SIDE * SIDE));
                let exact = program.value_or_around(node, scale);
                *value = if exact > 0.0 { value.abs().max(f32::MIN_POSITIVE) } else { -value.abs() };
            }
        }
    }

    fn insides(
        &self,
        scratch: &mut Scratch,
        number: usize,
        block: [u32; 3],
        points: &[DVec3],
        out: &mut Vec<bool>,
    ) -> bool {
        let group = self.groups[number];
        let Scratch { evaluator, tapes, single, slopes: [values, ..], .. } = scratch;
        let Some((_, tape)) = tapes.iter().rfind(|(other, _)| *other == group) else { return false };
        let origin = self.lattice.node(block[0], block[1], block[2]);
        place(points.iter().map(|p| (*p - origin).as_vec3a()), single);
        values.resize(points.len(), 0.0);
        let [x, y, z] = &*single;
        evaluator.shortest_values(tape, [x, y, z], values);
        out.extend(values.iter().map(|value| *value > 0.0));
        true
    }

    fn roots(&self, scratch: &mut Scratch, edges: &[EdgeRef], out: &mut [Root]) {
        let Scratch { evaluator, tapes, finder, order, edges: sorted, roots, .. } = scratch;
        let group = |edge: &EdgeRef| self.groups[edge.block as usize];
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else { return };
        let start = first.block as usize / BATCH * BATCH;
        let mut find = |edges: &[EdgeRef], roots: &mut [Root]| {
            let group = group(&edges[0]);
            let pair = (self.programs.of(group as usize), &*self.tape_of(tapes, group));
            // As many as the cache holds.
            for (edges, roots) in edges.chunks(AT_ONCE).zip(roots.chunks_mut(AT_ONCE)) {
                finder.find(evaluator, pair, self.lattice, edges, roots);
            }
        };
        let blocks = &self.groups[first.block as usize..=last.block as usize];
        if blocks.iter().all(|other| *other == blocks[0]) {
            find(edges, out);
            self.put_by(start / BATCH, tapes);
            return;
        }
        // Counted first, then each to its place: a group is named by a block of the batch.
        let mut places = [0u32; BATCH + 1];
        edges.iter().for_each(|edge| places[group(edge) as usize - start + 1] += 1);
        (0..BATCH).for_each(|n| places[n + 1] += places[n]);
        order.resize(edges.len(), 0);
        for (n, edge) in (0..).zip(edges) {
            let place = &mut places[group(edge) as usize - start];
            order[*place as usize] = n;
            *place += 1;
        }
        sorted.clear();
        sorted.extend(order.iter().map(|&n| edges[n as usize]));
        roots.resize(edges.len(), Root::default());
        let mut rest = &mut roots[..edges.len()];
        for edges in sorted.chunk_by(|a, b| group(a) == group(b)) {
            find(edges, rest.split_off_mut(..edges.len()).unwrap_or_default());
        }
        for (&n, root) in order.iter().zip(&*roots) {
            out[n as usize] = *root;
        }
        self.put_by(start / BATCH, tapes);
    }

    fn slopes(
        &self,
        scratch: &mut Scratch,
        number: usize,
        block: [u32; 3],
        points: &[Vec3A],
        out: &mut Vec<Slope>,
    ) -> bool {
        let origin = self.lattice.node(block[0], block[1], block[2]);
        let tape = self.tape_for_slopes(&mut scratch.copy, number, origin);
        // The program holds in the block and nowhere else.
        let (high, step) = (Vec3A::splat(BLOCK as f32), self.lattice.step() as f32);
        place(points.iter().map(|p| step * p.clamp(Vec3A::ZERO, high)), &mut scratch.single);
        gradients(&mut scratch.evaluator, tape, &scratch.single, &mut scratch.slopes, out);
        true
    }
}

/// Adds values and gradients at points to `out`.
fn gradients(
    evaluator: &mut Evaluator,
    tape: &Tape,
    [x, y, z]: &[Vec<f32>; 3],
    room: &mut [Vec<f32>; 4],
    out: &mut Vec<Slope>,
) {
    for column in &mut *room {
        column.resize(x.len(), 0.0);
    }
    let [value, dx, dy, dz] = room;
    evaluator.shortest_gradients(tape, [x, y, z], Gradients { value, dx, dy, dz });
    let gradients = dx.iter().zip(dy).zip(dz).map(|((dx, dy), dz)| Vec3A::new(*dx, *dy, *dz));
    out.extend(value.iter().zip(gradients).map(|(&value, gradient)| Slope { value, gradient }));
}

/// The coordinates of points, axis by axis.
fn place(points: impl ExactSizeIterator<Item = Vec3A>, axes: &mut [Vec<f32>; 3]) {
    for axis in &mut *axes {
        axis.resize(points.len(), 0.0);
    }
    let [x, y, z] = axes;
    for (((x, y), z), p) in x.iter_mut().zip(y).zip(z).zip(points) {
        (*x, *y, *z) = (p.x, p.y, p.z);
    }
}
