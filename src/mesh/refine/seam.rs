//! What is in common to a lattice and its inset in halved cells.
//!
//! Each [face of a larger cell in it is divided](super::divided) into four. The smaller cells take
//! over the signs of their nodes in it and the places of their vertices.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use super::Job;
use super::divided::Bend;
use super::inset::Inset;
use super::level::Level;
use super::piece::{Between, Piece, Rim};
use super::place::{Edge, Face, edge_of, face_of, is_fan};
use crate::mesh::extract::Sampler;
use crate::mesh::lattice::Lattice;
use crate::mesh::sampler::{BESIDE, Scratch, SolidSampler};
use crate::mesh::signs::{BLOCK, NODES, SIDE};

pub(super) struct Seam {
    pub(super) inset: Inset,
    /// The blocks of halved cells on both sides that the surface crosses here, and those beyond
    /// that have a cap.
    pub(super) blocks: BTreeSet<[u32; 3]>,
    /// The nodes of the halved lattice in the seam that are inside.
    pub(super) inside: HashSet<[u32; 3]>,
    /// Where its edges in the seam are crossed, from 0 to 1.
    pub(super) crossings: HashMap<Edge, f64>,
    /// The vertices of the larger cells in the seam.
    pub(super) vertices: HashMap<Edge, u32>,
    /// Their segments, face by face.
    pub(super) segments: BTreeMap<Face, Vec<Rim>>,
    /// Those of them that have a point of a crease.
    pub(super) bends: HashMap<Face, Bend>,
}

impl Seam {
    /// The seam around the inset of a level, given the border there and the positions of its
    /// vertices; nothing if they do not fit.
    pub(super) fn new(job: Job<'_>, level: &Level, rims: impl Iterator<Item = Rim>, all: &Piece) -> Option<Seam> {
        let mut seam = Seam {
            inset: level.inset.clone(),
            blocks: BTreeSet::new(),
            inside: HashSet::new(),
            crossings: HashMap::new(),
            vertices: HashMap::new(),
            segments: BTreeMap::new(),
            bends: HashMap::new(),
        };
        for rim in rims {
            let ends = [rim.from, rim.to];
            let [from, to] = ends.map(|vertex| edge_of(&level.lattice, all.positions[vertex as usize]));
            let edges = [from?, to?];
            seam.vertices.extend(edges.into_iter().zip(ends));
            seam.segments.entry(face_of(edges)?).or_default().push(rim);
        }
        let mut signs = NodeSigns::new(job, level);
        for block in level.inset.blocks() {
            for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
                let beside = level.inset.beside(block, axis, up).filter(|&other| !level.inset.has(other));
                let Some(beside) = beside else { continue };
                let is_inside = signs.in_face([block, beside], axis, up);
                let mut first = block.map(|at| at * BLOCK as u32);
                first[axis] += if up { BLOCK as u32 } else { 0 };
                for (i, j) in (0..BLOCK).flat_map(|i| (0..BLOCK).map(move |j| (i, j))) {
                    let mut face = first;
                    face[(axis + 1) % 3] += i as u32;
                    face[(axis + 2) % 3] += j as u32;
                    let corners = [is_inside(i, j), is_inside(i + 1, j), is_inside(i, j + 1), is_inside(i + 1, j + 1)];
                    seam.divide((&level.lattice, job), (axis as u8, face), corners, all)?;
                }
            }
        }
        Some(seam)
    }

    /// Whether a block of halved cells in the inset may have nodes in the seam.
    pub(super) fn is_near(&self, block: [u32; 3]) -> bool {
        self.inset.ends_at(block.map(|at| at / 2))
    }

    pub(super) fn is_inside(&self, node: [u32; 3]) -> bool {
        self.inside.contains(&node)
    }

    /// Where an edge in the seam is crossed.
    pub(super) fn crossing(&self, node: [u32; 3], axis: u8) -> Option<f64> {
        self.crossings.get(&(node, axis)).copied()
    }

    /// Adds what is in the inset to what is around it, given the border of the former: the numbers
    /// of its vertices there; nothing if they do not fit.
    pub(super) fn stitch(
        &self,
        all: &mut Piece,
        (lattice, piece): (&Lattice, Piece),
        rims: &[Rim],
    ) -> Option<Vec<u32>> {
        // The segments of each face of a larger cell, and the vertices that are those of larger
        // cells.
        let (mut paths, mut same) = (BTreeMap::<Face, Vec<(Face, Rim)>>::new(), BTreeMap::new());
        for rim in rims.iter().filter(|rim| rim.is_outer) {
            let ends = [rim.from, rim.to];
            let [from, to] = ends.map(|vertex| edge_of(lattice, piece.positions[vertex as usize]));
            let edges = [from?, to?];
            for (vertex, (node, axis)) in ends.into_iter().zip(edges) {
                if (0..3).all(|n| n == usize::from(axis) || node[n] % 2 == 0) {
                    same.insert(vertex, *self.vertices.get(&(node.map(|at| at / 2), axis))?);
                }
            }
            let half = face_of(edges)?;
            paths.entry((half.0, half.1.map(|at| at / 2))).or_default().push((half, *rim));
        }
        let same: Vec<(u32, u32)> = same.into_iter().collect();
        let start = all.triangles.len() as u32;
        let numbers = all.append(piece, &same)?;
        let mut cuts: BTreeMap<u32, [Vec<Between>; 3]> = BTreeMap::new();
        for (face, segments) in &self.segments {
            let path = paths.remove(face).unwrap_or_default();
            let path: Vec<(Face, Rim)> =
                path.into_iter().map(|(half, rim)| (half, rim.moved(start, &numbers))).collect();
            let mut next: HashMap<u32, u32> = path.iter().map(|(_, rim)| (rim.from, rim.to)).collect();
            // The smaller segment that the bend is in, if that may be bent too.
            let bend = self.bends.get(face).and_then(|bend| {
                let mut there = path.iter().filter(|(half, _)| *half == bend.half);
                let (_, rim) = there.next().filter(|_| there.next().is_none())?;
                is_fan(lattice, all, rim.triangle, rim.corner).then_some((bend, *rim))
            });
            let bend = match bend {
                Some((bend, rim)) => Some((all.add(bend.at, bend.normals)?, rim)),
                None => None,
            };
            for rim in segments {
                // The other way round.
                let (mut between, mut at) = (Vec::new(), rim.to);
                while at != rim.from {
                    let from = at;
                    at = next.remove(&from)?;
                    between.extend(bend.filter(|(_, half)| half.from == from).map(|(bend, _)| bend));
                    between.extend((at != rim.from).then(|| all.between(at)));
                }
                between.reverse();
                cuts.entry(rim.triangle).or_default()[usize::from(rim.corner)] = between;
            }
            if let Some((Between { vertex, before, after }, rim)) = bend {
                let other = Between { vertex, before: after, after: before };
                cuts.entry(rim.triangle).or_default()[usize::from(rim.corner)] = vec![other];
            }
            if !next.is_empty() {
                return None;
            }
        }
        cuts.into_iter().for_each(|(triangle, edges)| all.split(triangle, edges));
        paths.is_empty().then_some(numbers)
    }
}

/// The signs of the nodes of a level.
struct NodeSigns<'a> {
    job: Job<'a>,
    level: &'a Level,
    sampler: SolidSampler<'a>,
    /// The numbers of blocks by their first cells.
    numbers: HashMap<[u32; 3], usize>,
    scratch: Scratch,
    values: Box<[f32; NODES]>,
}

impl<'a> NodeSigns<'a> {
    fn new(job: Job<'a>, level: &'a Level) -> NodeSigns<'a> {
        let sampler = SolidSampler::new(&level.lattice, &level.blocks, job.limits, BESIDE);
        let (numbers, scratch) = (level.blocks.cells.iter().copied().zip(0..).collect(), sampler.scratch());
        NodeSigns { job, level, sampler, numbers, scratch, values: Box::new([0.0; NODES]) }
    }

    /// What tells whether nodes are inside, by their places along the two next axes, in the face of
    /// a block across an axis, given with the block beyond.
    fn in_face(&mut self, [block, beside]: [[u32; 3]; 2], axis: usize, up: bool) -> impl Fn(usize, usize) -> bool {
        let listed = [(block, up), (beside, !up)].into_iter().find_map(|(block, up)| {
            let first = block.map(|at| at * BLOCK as u32);
            Some((*self.numbers.get(&first)?, first, if up { BLOCK } else { 0 }))
        });
        let at = match listed {
            Some((number, first, at)) => {
                self.scratch.forget();
                self.sampler.nodes(&mut self.scratch, number, first, &mut self.values);
                at
            }
            None => {
                // All of the block is on one side.
                let [i, j, k] = block.map(|at| at * BLOCK as u32 + BLOCK as u32 / 2);
                let p = self.level.lattice.node(i, j, k);
                let is_inside = self.job.limits.contains(p) && self.job.program.value(p) > 0.0;
                self.values.fill(if is_inside { 1.0 } else { -1.0 });
                0
            }
        };
        let values = &self.values;
        move |i, j| {
            let mut node = [at; 3];
            (node[(axis + 1) % 3], node[(axis + 2) % 3]) = (i, j);
            values[node[0] + SIDE * (node[1] + SIDE * node[2])] > 0.0
        }
    }
}
