//! The vertices and the triangles of a layer of cells.

use glam::{DVec3, Vec3};

use super::bits::{case, each_bit, mixed};
use super::rows::{Rows, Start};

impl Rows<'_> {
    /// The vertices of a layer of rows, in their order.
    pub(super) fn vertices(&self, k: usize, starts: &[Start], positions: &mut [Vec3], normals: &mut [Vec3]) {
        let mut n = 0;
        for j in 0..=self.volume.size[1] {
            if starts[j][0] == starts[j + 1][0] {
                continue;
            }
            let cells = self.cells(j, k);
            // A row's vertices along x come before those along y, through all its words.
            for axis in 0..3 {
                let mut other = [j, k];
                if axis > 0 {
                    other[axis - 1] += 1;
                }
                let ends = [self.samples(j, k), self.samples(other[0], other[1])];
                for w in 0..self.words {
                    let (row, next) = (cells.words(w), cells.next(w));
                    each_bit(self.crossed([j, k], w, row, next)[axis], |bit| {
                        let i = 64 * w + bit as usize;
                        let (position, normal) = self.vertex(axis, [i, j, k], ends);
                        positions[n] = position;
                        if let Some(place) = normals.get_mut(n) {
                            *place = normal();
                        }
                        n += 1;
                    });
                }
            }
        }
    }

    /// The samples of a row; none in the layer around.
    fn samples(&self, j: usize, k: usize) -> Option<&[f32]> {
        let [nx, ny, nz] = self.volume.size;
        let (j, k) = (j.checked_sub(1).filter(|&j| j < ny)?, k.checked_sub(1).filter(|&k| k < nz)?);
        Some(&self.volume.samples[(k * ny + j) * nx..][..nx])
    }

    /// The vertex on the edge that leaves a node along an axis, and its normal on demand; `ends`
    /// are the rows of samples at the two ends of an edge across, or twice its own.
    fn vertex(&self, axis: usize, node: [usize; 3], ends: [Option<&[f32]>; 2]) -> (Vec3, impl Fn() -> Vec3) {
        let mut upper = node;
        upper[axis] += 1;
        let sample = |end: Option<&[f32]>, i: usize| Some(*end?.get(i.checked_sub(1)?)?);
        let (a, b) = (sample(ends[0], node[0]), sample(ends[1], upper[0]));
        let clearance = self.volume.clearance;
        let t = match (a, b) {
            (Some(a), Some(b)) => {
                let t = f64::from((self.settings.level - a) / (b - a));
                if t.is_nan() { 0.5 } else { t.clamp(clearance, 1.0 - clearance) }
            }
            // A cap.
            (Some(_), None) => clearance,
            _ => 1.0 - clearance,
        };
        let mut at = DVec3::new(node[0] as f64, node[1] as f64, node[2] as f64) - 1.0;
        at[axis] += t;
        let position = (self.volume.origin + at * self.volume.spacing).as_vec3();
        let normal = move || {
            let outward = match (a, b) {
                (Some(_), Some(_)) => -self.volume.gradient(node).lerp(self.volume.gradient(upper), t),
                (Some(_), None) => DVec3::AXES[axis],
                _ => -DVec3::AXES[axis],
            };
            outward.normalize_or_zero().as_vec3()
        };
        (position, normal)
    }

    /// The triangles of a layer of cells; `starts` are those of its rows and the next layer's.
    pub(super) fn triangles(&self, k: usize, starts: &[Start], out: &mut [[u32; 3]]) {
        if out.is_empty() {
            return;
        }
        let mut slots = out.iter_mut();
        for j in 0..=self.volume.size[1] {
            if !self.has_cells(j, k) {
                continue;
            }
            let cells = self.cells(j, k);
            let [low, high] = [j, j + 1].map(|j| [starts[j], starts[self.across + j]]);
            let mut counters = Counters {
                x: [low[0][0], high[0][0], low[1][0], high[1][0]],
                y: [low[0][1], low[1][1]],
                z: [low[0][2], high[0][2]],
            };
            for w in 0..self.words {
                let (row, next) = (cells.words(w), cells.next(w));
                let crossed = mixed(row, next) & self.allowed[w];
                each_bit(crossed, |bit| {
                    let case = case(row, next, bit);
                    let edges = counters.pass(self.table.crossed[case]);
                    for (triangle, slot) in self.table.table.triangles(case as u8).iter().zip(&mut slots) {
                        *slot = triangle.map(|edge| edges[usize::from(edge)]);
                    }
                });
            }
        }
    }
}

/// The vertices that come next on the edges of a row of cells.
struct Counters {
    /// By the row at the corner, as they are numbered.
    x: [u32; 4],
    /// Of the lower and the upper row.
    y: [u32; 2],
    z: [u32; 2],
}

impl Counters {
    /// The vertices on the edges of a cell, of which `crossed` are; the counters go on to the
    /// next.
    fn pass(&mut self, crossed: u16) -> [u32; 12] {
        let has = |edge: u32| u32::from(crossed >> edge & 1);
        let Counters { x, y, z } = self;
        let edges = [
            x[0],
            x[1],
            x[2],
            x[3],
            y[0],
            y[0] + has(4),
            y[1],
            y[1] + has(6),
            z[0],
            z[0] + has(8),
            z[1],
            z[1] + has(10),
        ];
        *x = [x[0] + has(0), x[1] + has(1), x[2] + has(2), x[3] + has(3)];
        *y = [edges[5], edges[7]];
        *z = [edges[9], edges[11]];
        edges
    }
}
