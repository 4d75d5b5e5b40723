//! Roots on the edges of a union or an intersection, leaf by leaf.
//!
//! ```text
//!        leaf A          leaf B
//!     -----------\   /-----------      Of all the leaves near a block, one decides where the surface
//!       |    |    \_/    |    |         crosses an edge. Which one it is, a value of each on the chord
//!     --o----o----o-o----o----o--       tells; the steps to the root then ask that leaf alone.
//! ```
//!
//! What a value on the chord says is a guess: the root of the one leaf is taken only if there, in
//! single precision and beyond its rounding, every other leaf leaves it the decision: it is
//! outside, for a union, or inside, for an intersection. The values on the chord show that of most
//! edges, as the way from there to the root is short; leaves whose values may change by more than
//! the way are asked again. Edges where another does not are given to all leaves together. A leaf
//! without a root on an edge seems to jump there: only those that are asked together tell jumps.
//!
//! The root of one leaf is one of all leaves then: near it the value is that leaf's.

use std::ops::Range;

use super::extract::Root;
use super::lattice::Lattice;
use super::roots::{RootFinder, beside, on_chord};
use super::sampler::BESIDE;
use super::signs::EdgeRef;
use crate::eval::{Evaluator, Op, Program, Tape};

/// A group of edges, and memory for them.
#[derive(Default)]
pub(super) struct Deciders {
    finder: RootFinder,
    /// The tapes of the leaves, and memory for those of others.
    rivals: Vec<Tape>,
    /// Where each edge is looked at, along it.
    t: Vec<f64>,
    /// Points, relative to the tape's origin, and values there.
    points: [Vec<f32>; 3],
    value: Vec<f32>,
    /// By edge, the point on the chord, the value that decides there, the next to it, and the leaf
    /// that does.
    seen: Vec<f64>,
    best: Vec<f32>,
    second: Vec<f32>,
    leaf: Vec<u32>,
    /// Places that a leaf is asked for there, and the largest value of others than the one that
    /// decides.
    asked: Vec<u32>,
    others: Vec<f32>,
    /// By leaf, where its edges end among the places.
    ends: Vec<u32>,
    /// Edges for searches: their places in the group, themselves, where to begin, their roots.
    places: Vec<u32>,
    edges: Vec<EdgeRef>,
    starts: Vec<f64>,
    roots: Vec<Root>,
}

impl Deciders {
    /// The roots on `edges`, into `out`; `tape` is that of `program` for a region that holds them.
    pub(super) fn find(
        &mut self,
        evaluator: &mut Evaluator,
        (program, tape): (&Program, &Tape),
        lattice: &Lattice,
        edges: &[EdgeRef],
        out: &mut [Root],
    ) {
        let mut memory = std::mem::take(&mut self.rivals);
        let Some((op, rivals)) = tape.rivals_into(&mut memory) else {
            self.rivals = memory;
            return self.finder.find(evaluator, (Some(program), tape), lattice, edges, |_, edge| on_chord(edge), out);
        };
        // The largest of all values decides a union, of all negatives an intersection.
        let sign = if op == Op::Or { 1.0 } else { -1.0 };
        self.guess(evaluator, (tape, rivals, sign), lattice, edges);
        self.sort(rivals.len());
        let mut first = 0;
        for (leaf, rival) in rivals.iter().enumerate() {
            let end = self.ends[leaf] as usize;
            self.search(evaluator, (None, rival), lattice, edges, first..end, out);
            first = end;
        }
        self.doubt(evaluator, (tape, rivals, sign), lattice, edges, out);
        // From where the guess has led.
        self.t.clear();
        self.t.extend(out.iter().map(|root| root.t));
        self.search(evaluator, (Some(program), tape), lattice, edges, 0..self.places.len(), out);
        self.rivals = memory;
    }

    /// The leaf that decides on the chord of each edge, and by its value where to begin the search.
    fn guess(
        &mut self,
        evaluator: &mut Evaluator,
        (tape, rivals, sign): (&Tape, &[Tape], f32),
        lattice: &Lattice,
        edges: &[EdgeRef],
    ) {
        self.seen.clear();
        self.seen.extend(edges.iter().map(on_chord));
        place(tape, lattice, edges.iter().zip(self.seen.iter().copied()), &mut self.points);
        for list in [&mut self.best, &mut self.second] {
            list.clear();
            list.resize(edges.len(), f32::NEG_INFINITY);
        }
        self.leaf.clear();
        self.leaf.resize(edges.len(), 0);
        for (number, rival) in (0..).zip(rivals) {
            evaluate(evaluator, rival, BESIDE * lattice.step(), &self.points, &mut self.value);
            let known = self.best.iter_mut().zip(&mut self.second).zip(&mut self.leaf);
            for (((best, second), leaf), &value) in known.zip(&self.value) {
                let value = sign * value;
                *leaf = if value > *best { number } else { *leaf };
                *second = second.max(best.min(value));
                *best = best.max(value);
            }
        }
        let known = self.seen.iter().zip(&self.best).zip(edges);
        self.t.clear();
        self.t.extend(known.map(|((&t, &best), edge)| beside(edge, t, f64::from(sign * best))));
    }

    /// Puts the edges in `places` in the order of their leaves.
    fn sort(&mut self, leaves: usize) {
        // Counted first, then each to its place.
        self.ends.clear();
        self.ends.resize(leaves + 1, 0);
        self.leaf.iter().for_each(|&leaf| self.ends[leaf as usize + 1] += 1);
        (0..leaves).for_each(|leaf| self.ends[leaf + 1] += self.ends[leaf]);
        self.places.resize(self.leaf.len(), 0);
        for (n, &leaf) in (0..).zip(&self.leaf) {
            let end = &mut self.ends[leaf as usize];
            self.places[*end as usize] = n;
            *end += 1;
        }
    }

    /// Puts the edges in `places` where a leaf other than the one asked may decide, or its value
    /// may jump.
    fn doubt(
        &mut self,
        evaluator: &mut Evaluator,
        (tape, rivals, sign): (&Tape, &[Tape], f32),
        lattice: &Lattice,
        edges: &[EdgeRef],
        roots: &[Root],
    ) {
        let sure = -tape.roundoff();
        let is_rough: Vec<bool> = rivals.iter().map(|rival| !rival.is_gentle()).collect();
        let rough = is_rough.iter().filter(|is_rough| **is_rough).count();
        let (seen, second, leaf) = (&self.seen, &self.second, &self.leaf);
        // Whether another leaf may decide there whose value changes by no more than the way.
        let is_near = |n: usize| {
            let way = (roots[n].t - seen[n]).abs() * lattice.step();
            let is_sure = f64::from(second[n]) + way < sure;
            !is_sure
        };
        let is_open = |n: usize| is_near(n) || rough > usize::from(is_rough[leaf[n] as usize]);
        self.places.clear();
        self.places.extend((0..edges.len() as u32).filter(|&n| roots[n as usize].is_off || is_open(n as usize)));
        self.others.clear();
        self.others.extend(self.places.iter().map(|&n| if roots[n as usize].is_off { 0.0 } else { f32::NEG_INFINITY }));
        for (number, rival) in (0..).zip(rivals) {
            let is_asked =
                |n: usize| leaf[n] != number && !roots[n].is_off && (is_rough[number as usize] || is_near(n));
            self.asked.clear();
            self.asked.extend((0..).zip(&self.places).filter(|(_, n)| is_asked(**n as usize)).map(|(at, _)| at));
            let there = self.asked.iter().map(|&at| self.places[at as usize] as usize);
            place(tape, lattice, there.map(|n| (&edges[n], roots[n].t)), &mut self.points);
            evaluate(evaluator, rival, BESIDE * lattice.step(), &self.points, &mut self.value);
            for (&at, &value) in self.asked.iter().zip(&self.value) {
                let other = &mut self.others[at as usize];
                *other = other.max(sign * value);
            }
        }
        let mut others = self.others.iter();
        self.places.retain(|_| others.next().is_none_or(|other| f64::from(*other) >= sure));
    }

    /// The roots of some of the edges in `places`.
    fn search(
        &mut self,
        evaluator: &mut Evaluator,
        pair: (Option<&Program>, &Tape),
        lattice: &Lattice,
        edges: &[EdgeRef],
        some: Range<usize>,
        out: &mut [Root],
    ) {
        let places = &self.places[some];
        if places.is_empty() {
            return;
        }
        self.edges.clear();
        self.edges.extend(places.iter().map(|&n| edges[n as usize]));
        self.starts.clear();
        self.starts.extend(places.iter().map(|&n| self.t[n as usize]));
        self.roots.resize(self.edges.len(), Root::default());
        let starts = &self.starts;
        self.finder.find(evaluator, pair, lattice, &self.edges, |n, _| starts[n], &mut self.roots);
        for (&n, root) in places.iter().zip(&self.roots) {
            out[n as usize] = *root;
        }
    }
}

/// The values of a leaf at points, right within the band: who decides is near the surface.
fn evaluate(evaluator: &mut Evaluator, rival: &Tape, band: f64, [x, y, z]: &[Vec<f32>; 3], out: &mut Vec<f32>) {
    out.resize(x.len(), 0.0);
    evaluator.values_within(rival, band, [x, y, z], out);
}

/// Points on edges, relative to the tape's origin.
fn place<'a>(
    tape: &Tape,
    lattice: &Lattice,
    edges: impl Iterator<Item = (&'a EdgeRef, f64)>,
    [x, y, z]: &mut [Vec<f32>; 3],
) {
    x.clear();
    y.clear();
    z.clear();
    for (edge, t) in edges {
        let mut p = lattice.node(edge.node[0], edge.node[1], edge.node[2]) - tape.origin();
        p[usize::from(edge.axis)] += t * lattice.step();
        x.push(p.x as f32);
        y.push(p.y as f32);
        z.push(p.z as f32);
    }
}
