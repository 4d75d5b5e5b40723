//! What is in common to a lattice and its inset in halved cells.
//!
//! ```text
//!     o-----.-----x     A face of a larger cell, and how it is divided. The surface crosses it from a to b: so the
//!     |     |     |     smaller faces have a–c–b. The node in the middle is on the side that the segment leaves it;
//!     a--c--.-----.     so is that in the middle of an edge. Smaller faces are crossed as a larger one is: where all
//!     |    `b     |     corners alternate, inside corners are separated.
//!     x-----.-----x
//! ```

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use glam::{DVec2, DVec3, Vec3};

use super::Job;
use super::inset::Inset;
use super::level::Level;
use super::piece::{Piece, Rim};
use crate::mesh::extract::Sampler;
use crate::mesh::lattice::Lattice;
use crate::mesh::sampler::SolidSampler;
use crate::mesh::signs::{BLOCK, NODES, SIDE};

/// An edge of a lattice: its lower node, and its axis.
type Edge = ([u32; 3], u8);

/// A face of a cell: its axis, and its lowest node.
type Face = (u8, [u32; 3]);

pub(super) struct Seam {
    pub(super) inset: Inset,
    /// The blocks of halved cells on both sides that the surface crosses here, and those beyond that have a cap.
    pub(super) blocks: BTreeSet<[u32; 3]>,
    /// The nodes of the halved lattice in the seam that are inside.
    inside: HashSet<[u32; 3]>,
    /// Where its edges in the seam are crossed, from 0 to 1.
    crossings: HashMap<Edge, f64>,
    /// The vertices of the larger cells in the seam.
    vertices: HashMap<Edge, u32>,
    /// Their segments, face by face.
    segments: BTreeMap<Face, Vec<Rim>>,
}

impl Seam {
    /// The seam around the inset of a level, given the border there and the positions of its vertices; nothing if they do
    /// not fit.
    pub(super) fn new(
        job: Job<'_>,
        level: &Level,
        rims: impl Iterator<Item = Rim>,
        positions: &[Vec3],
    ) -> Option<Seam> {
        let mut seam = Seam {
            inset: level.inset.clone(),
            blocks: BTreeSet::new(),
            inside: HashSet::new(),
            crossings: HashMap::new(),
            vertices: HashMap::new(),
            segments: BTreeMap::new(),
        };
        for rim in rims {
            let ends = [rim.from, rim.to];
            let [from, to] = ends.map(|vertex| edge_of(&level.lattice, positions[vertex as usize]));
            let edges = [from?, to?];
            seam.vertices.extend(edges.into_iter().zip(ends));
            seam.segments.entry(face_of(edges)?).or_default().push(rim);
        }
        let numbers: HashMap<[u32; 3], usize> = level.blocks.cells.iter().copied().zip(0..).collect();
        let sampler = SolidSampler::new(&level.lattice, &level.blocks, job.limits);
        let (mut scratch, mut values) = (sampler.scratch(), [0.0; NODES]);
        for block in level.inset.blocks() {
            for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
                let Some(beside) = level.inset.beside(block, axis, up).filter(|&other| !level.inset.has(other)) else {
                    continue;
                };
                let listed = [(block, up), (beside, !up)].into_iter().find_map(|(block, up)| {
                    let first = block.map(|at| at * BLOCK as u32);
                    Some((*numbers.get(&first)?, first, if up { BLOCK } else { 0 }))
                });
                let at = match listed {
                    Some((number, first, at)) => {
                        scratch.forget();
                        sampler.nodes(&mut scratch, number, first, &mut values);
                        at
                    }
                    None => {
                        // All of the block is on one side.
                        let [i, j, k] = block.map(|at| at * BLOCK as u32 + BLOCK as u32 / 2);
                        let p = level.lattice.node(i, j, k);
                        let is_inside = job.limits.contains(p) && job.program.value(p) > 0.0;
                        values.fill(if is_inside { 1.0 } else { -1.0 });
                        0
                    }
                };
                let is_inside = |i: usize, j: usize| {
                    let mut node = [at; 3];
                    (node[(axis + 1) % 3], node[(axis + 2) % 3]) = (i, j);
                    values[node[0] + SIDE * (node[1] + SIDE * node[2])] > 0.0
                };
                let mut first = block.map(|at| at * BLOCK as u32);
                first[axis] += if up { BLOCK as u32 } else { 0 };
                for (i, j) in (0..BLOCK).flat_map(|i| (0..BLOCK).map(move |j| (i, j))) {
                    let mut face = first;
                    face[(axis + 1) % 3] += i as u32;
                    face[(axis + 2) % 3] += j as u32;
                    let corners = [is_inside(i, j), is_inside(i + 1, j), is_inside(i, j + 1), is_inside(i + 1, j + 1)];
                    seam.divide(&level.lattice, (axis as u8, face), corners, positions)?;
                }
            }
        }
        Some(seam)
    }

    /// Divides a face, given whether its corners are inside.
    fn divide(
        &mut self,
        lattice: &Lattice,
        (axis, first): Face,
        [a, b, c, d]: [bool; 4],
        positions: &[Vec3],
    ) -> Option<()> {
        let [u, v] = [1, 2].map(|n| (usize::from(axis) + n) % 3);
        let node = |i: u32, j: u32| {
            let mut node = first.map(|at| 2 * at);
            node[u] += i;
            node[v] += j;
            node
        };
        let place = |vertex: u32| (positions[vertex as usize].as_dvec3() - lattice.origin()) / lattice.step();
        let flat = |vertex: u32| {
            let p = place(vertex);
            DVec2::new(p[u] - f64::from(first[u]), p[v] - f64::from(first[v]))
        };
        let segments: Vec<[DVec2; 2]> = self
            .segments
            .get(&(axis, first))
            .map(|rims| rims.iter().map(|rim| [flat(rim.from), flat(rim.to)]).collect())
            .unwrap_or_default();
        let is_mixed = [a, b, c, d] != [a; 4];
        if is_mixed == segments.is_empty() {
            return None;
        }
        let mut signs = [[a; 3]; 3];
        if is_mixed {
            (signs[2][0], signs[0][2], signs[2][2]) = (b, c, d);
            signs[1][0] = self.halve((node(0, 0), u), [a, b], place)?;
            signs[1][2] = self.halve((node(0, 2), u), [c, d], place)?;
            signs[0][1] = self.halve((node(0, 0), v), [a, c], place)?;
            signs[2][1] = self.halve((node(2, 0), v), [b, d], place)?;
            let side = |[from, to]: [DVec2; 2], p: DVec2| (to - from).perp_dot(p - from);
            let parts = |&&segment: &&[DVec2; 2]| side(segment, DVec2::ZERO) * side(segment, DVec2::splat(0.5)) < 0.0;
            signs[1][1] = a ^ (segments.iter().filter(parts).count() % 2 == 1);
            for (at, along) in [([0, 1], 0), ([1, 1], 0), ([1, 0], 1), ([1, 1], 1)] {
                let mut end = at;
                end[along] += 1;
                if signs[at[0]][at[1]] != signs[end[0]][end[1]] {
                    let low = 0.5 * at[along] as f64;
                    let meets = |[from, to]: &[DVec2; 2]| {
                        let share = (0.5 - from[1 - along]) / (to[1 - along] - from[1 - along]);
                        let t = 2.0 * (from[along] + share * (to[along] - from[along]) - low);
                        ((0.0..=1.0).contains(&share) && (-1e-6..=1.0 + 1e-6).contains(&t)).then_some(t)
                    };
                    let t = segments.iter().find_map(meets).unwrap_or(0.5);
                    self.crossings.insert((node(at[0] as u32, at[1] as u32), [u, v][along] as u8), t);
                }
            }
        }
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let at = node(i, j);
            let is_inside = signs[i as usize][j as usize];
            if is_inside {
                self.inside.insert(at);
            }
            let around = self.inset.blocks_at(at, BLOCK as u32);
            self.blocks.extend(around.filter(|&block| is_mixed || is_inside && !self.inset.has_half(block)));
        }
        Some(())
    }

    /// Halves an edge of a larger cell, given by its lower node in the halved lattice and its axis, whose ends have these
    /// signs: the sign of its middle. `place` tells where a vertex is, in larger cells.
    fn halve(
        &mut self,
        (mut node, axis): ([u32; 3], usize),
        [low, high]: [bool; 2],
        place: impl Fn(u32) -> DVec3,
    ) -> Option<bool> {
        if low == high {
            return Some(low);
        }
        let lower = node.map(|at| at / 2);
        let t = 2.0 * (place(*self.vertices.get(&(lower, axis as u8))?)[axis] - f64::from(lower[axis]));
        let is_upper = t > 1.0;
        node[axis] += u32::from(is_upper);
        self.crossings.insert((node, axis as u8), if is_upper { t - 1.0 } else { t });
        Some(if is_upper { low } else { high })
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

    /// Adds what is in the inset to what is around it, given the border of the former: the numbers of its vertices there;
    /// nothing if they do not fit.
    pub(super) fn stitch(
        &self,
        all: &mut Piece,
        (lattice, piece): (&Lattice, Piece),
        rims: &[Rim],
    ) -> Option<Vec<u32>> {
        // The segments of each face of a larger cell, and the vertices that are those of larger cells.
        let (mut paths, mut same) = (BTreeMap::<Face, Vec<[u32; 2]>>::new(), BTreeMap::new());
        for rim in rims.iter().filter(|rim| rim.is_outer) {
            let ends = [rim.from, rim.to];
            let [from, to] = ends.map(|vertex| edge_of(lattice, piece.positions[vertex as usize]));
            let edges = [from?, to?];
            for (vertex, (node, axis)) in ends.into_iter().zip(edges) {
                if (0..3).all(|n| n == usize::from(axis) || node[n] % 2 == 0) {
                    same.insert(vertex, *self.vertices.get(&(node.map(|at| at / 2), axis))?);
                }
            }
            let (axis, first) = face_of(edges)?;
            paths.entry((axis, first.map(|at| at / 2))).or_default().push(ends);
        }
        let same: Vec<(u32, u32)> = same.into_iter().collect();
        let numbers = all.append(piece, &same)?;
        let mut cuts: BTreeMap<u32, [Vec<u32>; 3]> = BTreeMap::new();
        for (face, segments) in &self.segments {
            let path = paths.remove(face).unwrap_or_default();
            let mut next: HashMap<u32, u32> = path
                .into_iter()
                .map(|ends| ends.map(|vertex| numbers[vertex as usize]))
                .map(<[u32; 2]>::into)
                .collect();
            for rim in segments {
                // The other way round.
                let (mut between, mut at) = (Vec::new(), rim.to);
                loop {
                    at = next.remove(&at)?;
                    if at == rim.from {
                        break;
                    }
                    between.push(at);
                }
                between.reverse();
                cuts.entry(rim.triangle).or_default()[usize::from(rim.corner)] = between;
            }
            if !next.is_empty() {
                return None;
            }
        }
        cuts.into_iter().for_each(|(triangle, edges)| all.split(triangle, edges));
        paths.is_empty().then_some(numbers)
    }
}

/// The edge of a lattice that a vertex is on.
fn edge_of(lattice: &Lattice, at: Vec3) -> Option<Edge> {
    let place = (at.as_dvec3() - lattice.origin()) / lattice.step();
    let mut along = (0..3).filter(|&axis| (place[axis] - place[axis].round()).abs() > lattice.slack());
    let axis = along.next().filter(|_| along.next().is_none())?;
    let node = std::array::from_fn(|n| if n == axis { place[n].floor() } else { place[n].round() } as u32);
    Some((node, axis as u8))
}

/// The face of a cell that has vertices on these edges.
fn face_of([(a, along_a), (b, along_b)]: [Edge; 2]) -> Option<Face> {
    let is_across = |axis: &u8| *axis != along_a && *axis != along_b && a[usize::from(*axis)] == b[usize::from(*axis)];
    let mut across = (0..3).filter(is_across);
    let axis = across.next().filter(|_| across.next().is_none())?;
    let first = std::array::from_fn(|n| match n {
        _ if n == usize::from(along_a) => a[n],
        _ if n == usize::from(along_b) => b[n],
        _ => a[n].min(b[n]),
    });
    Some((axis, first))
}
