//! Surface points known beforehand, and which of them is nearest where.
//!
//! ```text
//!     +---+---+---+---+     Each edge of a net of boxes whose ends differ in sign is halved
//!     |   | . |   |   |     down to a surface point y. Of each cell the point nearest to its
//!     +---+-*-+---+---+     centre is kept, and the nearest one on another side.
//!     |   *   * . |   |
//!     +---+-*-+---+---+         |d(x)| ≤ |x − y|    for every y,
//!     |   | . |   |   |
//!     +---+---+---+---+     whatever the leaf is: its right side has a known range.
//! ```
//!
//! Points beyond the net belong to the cell that is nearest to them. Parts that slip through
//! between the nodes are not seen; distances are then too large, not wrong in sign.
//!
//! Source of the spreading of nearest points by sweeps: P.-E. Danielsson, *Euclidean distance
//! mapping* (1980).

use glam::DVec3;

use super::chain::{Chain, Column};
use crate::Placement;
use crate::kernel::CHUNK;
use crate::{Bounds, Interval};

/// Cells along the longest side of the leaf's box, and along the shortest at least.
const CELLS: f64 = 30.0;
const LEAST_CELLS: f64 = 6.0;

/// Halvings of an edge: what is left of it is in the order of rounding errors.
const HALVINGS: u32 = 16;

/// A normal within this cosine of another belongs to the same side.
const SAME_SIDE: f64 = 0.8;

/// How often nearest points are spread to and fro.
const SWEEPS: usize = 2;

/// A range is looked up in no more cells than this.
const LOOKED_UP: usize = 4096;

/// No point.
const NONE: u32 = u32::MAX;

/// A surface point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) point: DVec3,
    /// Outward, of length 1.
    pub(super) normal: DVec3,
}

/// A net of cells, each with the surface points nearest to it.
#[derive(Debug)]
pub(super) struct Feet {
    low: DVec3,
    cell: DVec3,
    inverse: DVec3,
    counts: [usize; 3],
    feet: Vec<Foot>,
    near: Vec<[u32; 2]>,
    /// How far from the surface a point may be.
    pub(super) slack: f64,
}

impl Feet {
    /// The net of a leaf within `bounds`, whose points may be `slack` from the surface; none if that is infinite or no surface is found.
    pub(super) fn new(chain: &Chain, bounds: &Bounds, slack: f64) -> Option<Feet> {
        let size = bounds.size();
        let longest = size.max_element();
        if !bounds.is_finite() || bounds.is_empty() || longest <= 0.0 {
            return None;
        }
        let across = (size / longest * CELLS).ceil().clamp(DVec3::splat(LEAST_CELLS), DVec3::splat(CELLS));
        let cell = size.max(DVec3::splat(1e-5 * longest)) / across;
        // A layer about the box, and off its planes of symmetry, where surfaces like to be.
        let low = bounds.min - cell * DVec3::new(0.97, 0.96, 0.95);
        let counts = (across + 2.0).to_array().map(|count| count as usize);
        let slack = cell.max_element() * 2.0 / f64::from(1u32 << HALVINGS) + slack;
        let mut net = Feet { low, cell, inverse: cell.recip(), counts, feet: Vec::new(), near: Vec::new(), slack };
        net.feet = feet(chain, &net.crossed(chain));
        if net.feet.is_empty() || !slack.is_finite() {
            return None;
        }
        net.spread();
        Some(net)
    }

    /// Points inside and outside at the ends of the edges with a change of sign.
    fn crossed(&self, chain: &Chain) -> Vec<[DVec3; 2]> {
        let [nx, ny, nz] = self.counts.map(|count| count + 1);
        let node = |i: usize| {
            let at = DVec3::new((i % nx) as f64, (i / nx % ny) as f64, (i / (nx * ny)) as f64);
            self.low + at * self.cell
        };
        let nodes: Vec<DVec3> = (0..nx * ny * nz).map(node).collect();
        let values = values(chain, &nodes);
        let mut crossed = Vec::new();
        for i in 0..nodes.len() {
            let at = [i % nx, i / nx % ny, i / (nx * ny)];
            for (axis, step) in [1, nx, nx * ny].into_iter().enumerate() {
                if at[axis] == self.counts[axis] {
                    continue;
                }
                let (a, b) = (values[i], values[i + step]);
                if a > 0.0 && b <= 0.0 {
                    crossed.push([nodes[i], nodes[i + step]]);
                } else if a <= 0.0 && b > 0.0 {
                    crossed.push([nodes[i + step], nodes[i]]);
                }
            }
        }
        crossed
    }

    /// The number of the cell of a point, axis by axis.
    #[inline(always)]
    fn cell_at(&self, p: DVec3) -> [usize; 3] {
        let at = (p - self.low) * self.inverse;
        let [i, j, k] = self.counts;
        // A cast of what is negative or NaN is 0.
        [(at.x as usize).min(i - 1), (at.y as usize).min(j - 1), (at.z as usize).min(k - 1)]
    }

    #[inline(always)]
    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.counts[1] + j) * self.counts[0] + i
    }

    /// The point nearest to the centre of the cell of `p`, and the nearest on another side;
    /// twice the same if there is only one side.
    #[inline(always)]
    pub(super) fn at(&self, p: DVec3) -> [Foot; 2] {
        let [first, second] = self.near[self.index(self.cell_at(p))];
        [self.feet[first as usize], self.feet[second as usize]]
    }

    /// How far apart points are: so much farther away, another may still lead to a nearer one.
    pub(super) fn spacing(&self) -> f64 {
        self.cell.length()
    }

    /// The most that `|x − y|` is over a box, y the first point of the cell of x.
    pub(super) fn farthest(&self, hull: [Interval; 3]) -> f64 {
        let low = DVec3::from_array(hull.map(Interval::lo));
        let high = DVec3::from_array(hull.map(Interval::hi));
        let (from, to) = (self.cell_at(low), self.cell_at(high));
        let count: usize = (0..3).map(|axis| to[axis] - from[axis] + 1).product();
        if count > LOOKED_UP {
            return f64::INFINITY;
        }
        let mut farthest = 0.0f64;
        // The sides of a cell, as far as the box reaches; cells at the rim reach on for ever.
        let side = |axis: usize, at: usize| {
            let edge = self.low[axis] + at as f64 * self.cell[axis];
            let slip = 1e-9 * self.cell[axis] + 1e-14 * edge.abs();
            let lo = if at == 0 { low[axis] } else { low[axis].max(edge - slip) };
            let beyond = edge + self.cell[axis] + slip;
            let hi = if at + 1 == self.counts[axis] { high[axis] } else { high[axis].min(beyond) };
            (lo, hi)
        };
        for k in from[2]..=to[2] {
            let (z0, z1) = side(2, k);
            for j in from[1]..=to[1] {
                let (y0, y1) = side(1, j);
                for i in from[0]..=to[0] {
                    let (x0, x1) = side(0, i);
                    let foot = self.feet[self.near[self.index([i, j, k])][0] as usize].point;
                    let (a, b) = (foot - DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1) - foot);
                    farthest = farthest.max(a.abs().max(b.abs()).length_squared());
                }
            }
        }
        farthest.sqrt()
    }

    fn centre(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        self.low + self.cell * (DVec3::new(i as f64, j as f64, k as f64) + 0.5)
    }

    fn spread(&mut self) {
        let [nx, ny, nz] = self.counts;
        let mut near = vec![[NONE; 2]; nx * ny * nz];
        for number in 0..self.feet.len() {
            let at = self.cell_at(self.feet[number].point);
            self.offer(&mut near[self.index(at)], self.centre(at), number as u32);
        }
        for sweep in 0..2 * SWEEPS {
            let forth = sweep % 2 == 0;
            let turned = |count: usize, at: usize| if forth { at } else { count - 1 - at };
            for k in (0..nz).map(|k| turned(nz, k)) {
                for j in (0..ny).map(|j| turned(ny, j)) {
                    for i in (0..nx).map(|i| turned(nx, i)) {
                        self.learn(&mut near, [i, j, k], forth);
                    }
                }
            }
        }
        for [first, second] in &mut near {
            *second = if *second == NONE { *first } else { *second };
        }
        self.near = near;
    }

    /// Offers a cell what its neighbours know that were visited before.
    fn learn(&self, near: &mut [[u32; 2]], at: [usize; 3], forth: bool) {
        let centre = self.centre(at);
        let mut own = near[self.index(at)];
        for axis in 0..3 {
            let mut other = at;
            if forth {
                if at[axis] == 0 {
                    continue;
                }
                other[axis] -= 1;
            } else {
                other[axis] += 1;
                if other[axis] == self.counts[axis] {
                    continue;
                }
            }
            for number in near[self.index(other)] {
                self.offer(&mut own, centre, number);
            }
        }
        near[self.index(at)] = own;
    }

    fn offer(&self, own: &mut [u32; 2], centre: DVec3, number: u32) {
        let [first, second] = *own;
        if number == NONE || number == first || number == second {
            return;
        }
        let foot = |number: u32| &self.feet[number as usize];
        let way =
            |number: u32| if number == NONE { f64::INFINITY } else { foot(number).point.distance_squared(centre) };
        let apart = |a: u32, b: u32| a != NONE && b != NONE && foot(a).normal.dot(foot(b).normal) < SAME_SIDE;
        if way(number) < way(first) {
            let other = if apart(number, first) {
                first
            } else if apart(number, second) {
                second
            } else {
                NONE
            };
            *own = [number, other];
        } else if apart(number, first) && way(number) < way(second) {
            own[1] = number;
        }
    }
}

/// The leaf's values at points, by lanes.
fn values(chain: &Chain, points: &[DVec3]) -> Vec<f32> {
    let placed = chain.placed(&Placement::IDENTITY);
    let mut all = Vec::with_capacity(points.len());
    let mut out = [0.0; CHUNK];
    for part in points.chunks(CHUNK) {
        let [x, y, z] = &columns_of(part);
        placed.values([x, y, z], &mut out);
        all.extend_from_slice(&out[..part.len()]);
    }
    all
}

/// Coordinates, padded by the last point.
fn columns_of(points: &[DVec3]) -> [Column; 3] {
    let mut columns = [[0.0; CHUNK]; 3];
    for at in 0..CHUNK {
        let p = points[at.min(points.len() - 1)].as_vec3();
        (columns[0][at], columns[1][at], columns[2][at]) = (p.x, p.y, p.z);
    }
    columns
}

/// Halves edges from inside to outside.
fn feet(chain: &Chain, edges: &[[DVec3; 2]]) -> Vec<Foot> {
    let placed = chain.placed(&Placement::IDENTITY);
    let mut feet = Vec::with_capacity(edges.len());
    for part in edges.chunks(CHUNK) {
        let mut ends = part.to_vec();
        let mut middles: Vec<DVec3> = Vec::with_capacity(part.len());
        let mut out = [0.0; CHUNK];
        for _ in 0..HALVINGS {
            middles.clear();
            middles.extend(ends.iter().map(|[inside, outside]| 0.5 * (*inside + *outside)));
            let [x, y, z] = &columns_of(&middles);
            placed.values([x, y, z], &mut out);
            for ((ends, middle), value) in ends.iter_mut().zip(&middles).zip(out) {
                ends[usize::from(value <= 0.0)] = *middle;
            }
        }
        let [x, y, z] = &columns_of(&middles);
        let mut seen = [[0.0; CHUNK]; 4];
        placed.gradients([x, y, z], &mut seen);
        for (i, ([inside, outside], [from, to])) in ends.iter().zip(part).enumerate() {
            let slope = -DVec3::new(seen[1][i].into(), seen[2][i].into(), seen[3][i].into());
            let normal = slope.try_normalize().unwrap_or_else(|| (*to - *from).normalize_or_zero());
            feet.push(Foot { point: 0.5 * (*inside + *outside), normal });
        }
    }
    feet
}
