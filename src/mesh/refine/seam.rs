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
use super::piece::{Between, Piece, Rim};
use crate::mesh::extract::Sampler;
use crate::mesh::lattice::Lattice;
use crate::mesh::sampler::SolidSampler;
use crate::mesh::settings::Features;
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
    /// Those of them that have a point of a crease.
    bends: HashMap<Face, Bend>,
}

/// A point in which a segment is bent, as a crease passes the face there.
struct Bend {
    at: Vec3,
    /// The face of a smaller cell that it is in.
    half: Face,
    /// The normals at the two ends of the segment.
    normals: [Vec3; 2],
}

/// Normals that are farther apart are those of two sides of a crease: the cosine of 26°.
const CREASE: f32 = 0.9;

/// How far, in larger cells, a bend is from the sides of the smaller face that it is in.
const INSET: f64 = 0.01;

impl Seam {
    /// The seam around the inset of a level, given the border there and the positions of its vertices; nothing if they do
    /// not fit.
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
                    seam.divide((&level.lattice, job), (axis as u8, face), corners, all)?;
                }
            }
        }
        Some(seam)
    }

    /// Divides a face, given whether its corners are inside.
    fn divide(
        &mut self,
        (lattice, job): (&Lattice, Job<'_>),
        (axis, first): Face,
        [a, b, c, d]: [bool; 4],
        all: &Piece,
    ) -> Option<()> {
        let [u, v] = [1, 2].map(|n| (usize::from(axis) + n) % 3);
        let node = |i: u32, j: u32| {
            let mut node = first.map(|at| 2 * at);
            node[u] += i;
            node[v] += j;
            node
        };
        let place = |vertex: u32| (all.positions[vertex as usize].as_dvec3() - lattice.origin()) / lattice.step();
        let flat = |vertex: u32| {
            let p = place(vertex);
            DVec2::new(p[u] - f64::from(first[u]), p[v] - f64::from(first[v]))
        };
        let rims = self.segments.get(&(axis, first)).map(Vec::as_slice).unwrap_or_default();
        let mut segments: Vec<[DVec2; 2]> = rims.iter().map(|rim| [flat(rim.from), flat(rim.to)]).collect();
        let mut bend = None;
        if let ([rim], Features::Sharp) = (rims, job.features)
            && let Some((x, normals)) = bent(lattice, rim, ([u, v], [flat(rim.from), flat(rim.to)]), all)
        {
            let mut at = first.map(f64::from);
            (at[u], at[v]) = (at[u] + x.x, at[v] + x.y);
            let at = (lattice.origin() + DVec3::from_array(at) * lattice.step()).as_vec3();
            let at = at.clamp(job.limits.min.as_vec3(), job.limits.max.as_vec3());
            let half = (axis, node((2.0 * x.x) as u32, (2.0 * x.y) as u32));
            bend = Some(Bend { at, half, normals });
            segments = vec![[segments[0][0], x], [x, segments[0][1]]];
        }
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
            // Whether a segment parts the first corner from the middle. One that ends on the line between the two counts
            // with one of those that meet there.
            let is_left = |[from, to]: [DVec2; 2], p: DVec2| (to - from).perp_dot(p - from) >= 0.0;
            let diagonal = [DVec2::ZERO, DVec2::splat(0.5)];
            let parts = |segment: &&[DVec2; 2]| {
                is_left(diagonal, segment[0]) != is_left(diagonal, segment[1])
                    && is_left(**segment, diagonal[0]) != is_left(**segment, diagonal[1])
            };
            signs[1][1] = a ^ (segments.iter().filter(parts).count() % 2 == 1);
            // A crease that is all there is between the middle and the sides is left out.
            let beside = [signs[1][0], signs[1][2], signs[0][1], signs[2][1]];
            if bend.is_some() && beside == [!signs[1][1]; 4] {
                signs[1][1] = !signs[1][1];
                bend = None;
            }
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
            self.bends.extend(bend.map(|bend| ((axis, first), bend)));
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

/// The point in which a crease meets the face that a segment lies in, if it does, in cells from the first node of the face
/// along two axes; and the normals at the ends of the segment. Its triangle has to be of a fan: then the segment may take
/// any way in the face.
fn bent(
    lattice: &Lattice,
    rim: &Rim,
    ([u, v], [from, to]): ([usize; 2], [DVec2; 2]),
    all: &Piece,
) -> Option<(DVec2, [Vec3; 2])> {
    let normals = [rim.from, rim.to].map(|vertex| all.normals[vertex as usize]);
    if normals[0].dot(normals[1]) > CREASE || !is_fan(lattice, all, rim.triangle, rim.corner) {
        return None;
    }
    let [a, b] = normals.map(|normal| DVec2::new(normal[u].into(), normal[v].into()));
    let (at_a, at_b) = (a.dot(from), b.dot(to));
    let x = DVec2::new(at_a * b.y - at_b * a.y, a.x * at_b - b.x * at_a) / a.perp_dot(b);
    let is_within = |x: f64| x > INSET && x < 1.0 - INSET && (x - 0.5).abs() > INSET;
    (is_within(x.x) && is_within(x.y)).then_some((x, normals))
}

/// Whether the corner opposite of an edge of a triangle is within a cell.
fn is_fan(lattice: &Lattice, all: &Piece, triangle: u32, corner: u8) -> bool {
    let apex = all.triangles[triangle as usize][usize::from(corner + 2) % 3];
    edge_of(lattice, all.positions[apex as usize]).is_none()
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
