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
//! outside, for a union, or inside, for an intersection. Edges where one does not are given to all
//! leaves together.
//!
//! The root of one leaf is one of all leaves then: near it the value is that leaf's.

use super::extract::Root;
use super::lattice::Lattice;
use super::roots::{RootFinder, beside, on_chord};
use super::signs::EdgeRef;
use crate::eval::{Evaluator, Op, Program, Tape};

/// A group of edges, and memory for them.
#[derive(Default)]
pub(super) struct Deciders {
    finder: RootFinder,
    /// Where each edge is looked at, along it and relative to the tape's origin.
    t: Vec<f64>,
    points: [Vec<f32>; 3],
    value: Vec<f32>,
    /// By edge, the value that decides, or would without the leaf that does, and the leaf.
    best: Vec<f32>,
    leaf: Vec<u32>,
    /// Edges for one search: their places in the group, themselves, where to begin, their roots.
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
        let Some((op, rivals)) = tape.rivals() else {
            return self.finder.find(evaluator, (program, tape), lattice, edges, |_, edge| on_chord(edge), out);
        };
        let rivals: Vec<Tape> = rivals.collect();
        // The largest of all values decides a union, of all negatives an intersection.
        let sign = if op == Op::Or { 1.0 } else { -1.0 };
        self.t.clear();
        self.t.extend(edges.iter().map(on_chord));
        self.place(tape, lattice, edges);
        self.best.clear();
        self.best.resize(edges.len(), f32::NEG_INFINITY);
        self.leaf.clear();
        self.leaf.resize(edges.len(), 0);
        for (number, rival) in (0..).zip(&rivals) {
            self.evaluate(evaluator, rival);
            for ((best, leaf), &value) in self.best.iter_mut().zip(&mut self.leaf).zip(&self.value) {
                let value = sign * value;
                *leaf = if value > *best { number } else { *leaf };
                *best = if value > *best { value } else { *best };
            }
        }
        for ((t, &best), edge) in self.t.iter_mut().zip(&self.best).zip(edges) {
            *t = beside(edge, *t, f64::from(sign * best));
        }
        for (number, rival) in (0..).zip(&rivals) {
            self.places.clear();
            self.places.extend((0..edges.len() as u32).filter(|&n| self.leaf[n as usize] == number));
            self.search(evaluator, (program, rival), lattice, edges, out);
        }
        // Which others might decide there after all.
        self.t.clear();
        self.t.extend(out.iter().map(|root| root.t));
        self.place(tape, lattice, edges);
        self.best.fill(f32::NEG_INFINITY);
        for (number, rival) in (0..).zip(&rivals) {
            self.evaluate(evaluator, rival);
            for ((best, &leaf), &value) in self.best.iter_mut().zip(&self.leaf).zip(&self.value) {
                let value = if leaf == number { f32::NEG_INFINITY } else { sign * value };
                *best = best.max(value);
            }
        }
        let sure = -tape.roundoff() as f32;
        self.places.clear();
        self.places.extend((0..edges.len() as u32).filter(|&n| self.best[n as usize] >= sure));
        self.search(evaluator, (program, tape), lattice, edges, out);
    }

    /// The points of the edges at `t`.
    fn place(&mut self, tape: &Tape, lattice: &Lattice, edges: &[EdgeRef]) {
        self.points.iter_mut().for_each(|list| list.resize(edges.len(), 0.0));
        let [x, y, z] = &mut self.points;
        for (n, (edge, t)) in edges.iter().zip(&self.t).enumerate() {
            let mut p = lattice.node(edge.node[0], edge.node[1], edge.node[2]) - tape.origin();
            p[usize::from(edge.axis)] += t * lattice.step();
            (x[n], y[n], z[n]) = (p.x as f32, p.y as f32, p.z as f32);
        }
    }

    /// The values of a leaf at the points.
    fn evaluate(&mut self, evaluator: &mut Evaluator, rival: &Tape) {
        let [x, y, z] = &self.points;
        self.value.resize(x.len(), 0.0);
        evaluator.values(rival, x, y, z, &mut self.value);
    }

    /// The roots of the edges in `places`.
    fn search(
        &mut self,
        evaluator: &mut Evaluator,
        pair: (&Program, &Tape),
        lattice: &Lattice,
        edges: &[EdgeRef],
        out: &mut [Root],
    ) {
        if self.places.is_empty() {
            return;
        }
        self.edges.clear();
        self.edges.extend(self.places.iter().map(|&n| edges[n as usize]));
        self.starts.clear();
        self.starts.extend(self.places.iter().map(|&n| self.t[n as usize]));
        self.roots.resize(self.edges.len(), Root::default());
        let starts = &self.starts;
        self.finder.find(evaluator, pair, lattice, &self.edges, |n, _| starts[n], &mut self.roots);
        for (&n, root) in self.places.iter().zip(&self.roots) {
            out[n as usize] = *root;
        }
    }
}
