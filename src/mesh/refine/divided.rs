//! A face of a larger cell in the seam, divided into four.
//!
//! ```text
//!     o-----.-----x     A face of a larger cell, and how it is divided. The surface crosses it from a to b: so the
//!     |     |     |     smaller faces have a–c–b. The node in the middle is on the side that the segment leaves it;
//!     a--c--.-----.     so is that in the middle of an edge. Smaller faces are crossed as a larger one is: where all
//!     |    `b     |     corners alternate, inside corners are separated.
//!     x-----.-----x
//! ```

use glam::{DVec2, DVec3, Vec3};

use super::Job;
use super::piece::{Piece, Rim};
use super::place::{Face, is_fan, place_of};
use super::seam::Seam;
use crate::mesh::lattice::Lattice;
use crate::mesh::settings::Features;
use crate::mesh::signs::BLOCK;

/// How far, in larger cells, a bend is from the sides of the smaller face that it is in.
const INSET: f64 = 0.01;

/// A point in which a segment is bent, as a crease passes the face there.
pub(super) struct Bend {
    pub(super) at: Vec3,
    /// The face of a smaller cell that it is in.
    pub(super) half: Face,
    /// The normals at the two ends of the segment.
    pub(super) normals: [Vec3; 2],
}

impl Seam {
    /// Divides a face, given whether its corners are inside.
    pub(super) fn divide(
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
        let place = |vertex: u32| place_of(lattice, all.positions[vertex as usize]).0;
        let flat = |vertex: u32| {
            let p = place(vertex);
            DVec2::new(p[u] - f64::from(first[u]), p[v] - f64::from(first[v]))
        };
        let rims = self.segments.get(&(axis, first)).map(Vec::as_slice).unwrap_or_default();
        let mut segments: Vec<[DVec2; 2]> = rims.iter().map(|rim| [flat(rim.from), flat(rim.to)]).collect();
        let mut bend = None;
        if let ([rim], Features::Sharp) = (rims, job.features)
            && let Some((x, normals)) = bent((lattice, job), rim, ([u, v], [flat(rim.from), flat(rim.to)]), all)
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
            // Whether a segment parts the first corner from the middle. One that ends on the line
            // between the two counts with one of those that meet there.
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

    /// Halves an edge of a larger cell, given by its lower node in the halved lattice and its axis,
    /// whose ends have these signs: the sign of its middle. `place` tells where a vertex is, in
    /// larger cells.
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
}

/// The point in which a crease meets the face that a segment lies in, if it does, in cells from the
/// first node of the face along two axes; and the normals at the ends of the segment. Its triangle
/// has to be of a fan: then the segment may take any way in the face.
fn bent(
    (lattice, job): (&Lattice, Job<'_>),
    rim: &Rim,
    ([u, v], [from, to]): ([usize; 2], [DVec2; 2]),
    all: &Piece,
) -> Option<(DVec2, [Vec3; 2])> {
    let normals = [rim.from, rim.to].map(|vertex| all.normals[vertex as usize]);
    if normals[0].dot(normals[1]) > job.crease(lattice).smooth || !is_fan(lattice, all, rim.triangle, rim.corner) {
        return None;
    }
    let [a, b] = normals.map(|normal| DVec2::new(normal[u].into(), normal[v].into()));
    let (at_a, at_b) = (a.dot(from), b.dot(to));
    let x = DVec2::new(at_a * b.y - at_b * a.y, a.x * at_b - b.x * at_a) / a.perp_dot(b);
    let is_within = |x: f64| x > INSET && x < 1.0 - INSET && (x - 0.5).abs() > INSET;
    (is_within(x.x) && is_within(x.y)).then_some((x, normals))
}
