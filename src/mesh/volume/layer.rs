//! The vertices and the triangles of a layer of cells.

use glam::{DVec3, Vec3};

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
                    let mut crossed = self.crossed([j, k], w, &cells.word(w))[axis];
                    while crossed != 0 {
                        let i = 64 * w + crossed.trailing_zeros() as usize;
                        crossed &= crossed - 1;
                        let vertex = self.vertex(axis, [i, j, k], ends);
                        positions[n] = self.position(axis, [i, j, k], &vertex);
                        if let Some(normal) = normals.get_mut(n) {
                            *normal = self.normal(axis, [i, j, k], &vertex);
                        }
                        n += 1;
                    }
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

    /// The vertex on the edge that leaves a node along an axis; `ends` are the rows of samples at
    /// the two ends of an edge across, or twice its own.
    #[inline(always)]
    fn vertex(&self, axis: usize, node: [usize; 3], ends: [Option<&[f32]>; 2]) -> OnEdge {
        // Node i is sample i − 1; wrapped, the one before the first is beyond the last.
        let first = node[0].wrapping_sub(1);
        let second = if axis == 0 { node[0] } else { first };
        let a = ends[0].and_then(|row| row.get(first));
        let b = ends[1].and_then(|row| row.get(second));
        let clearance = self.volume.clearance;
        match (a, b) {
            (Some(a), Some(b)) => {
                let t = f64::from((self.settings.level - a) / (b - a));
                OnEdge { t: if t.is_nan() { 0.5 } else { t.clamp(clearance, 1.0 - clearance) }, cap: 0.0 }
            }
            (Some(_), None) => OnEdge { t: clearance, cap: 1.0 },
            _ => OnEdge { t: 1.0 - clearance, cap: -1.0 },
        }
    }

    #[inline(always)]
    fn position(&self, axis: usize, [i, j, k]: [usize; 3], vertex: &OnEdge) -> Vec3 {
        let mut at = DVec3::new(i as f64, j as f64, k as f64) - 1.0;
        at[axis] += vertex.t;
        (self.volume.origin + at * self.volume.spacing).as_vec3()
    }

    #[inline(always)]
    fn normal(&self, axis: usize, node: [usize; 3], vertex: &OnEdge) -> Vec3 {
        if vertex.cap != 0.0 {
            return (vertex.cap * DVec3::AXES[axis]).as_vec3();
        }
        let mut upper = node;
        upper[axis] += 1;
        let inward = self.volume.rises(node).lerp(self.volume.rises(upper), vertex.t) / self.volume.spacing;
        (-inward.normalize_or_zero()).as_vec3()
    }

    /// The triangles of a layer of cells; `starts` are those of its rows and the next layer's.
    pub(super) fn triangles(&self, k: usize, starts: &[Start], out: &mut [[u32; 3]]) {
        if out.is_empty() {
            return;
        }
        let table = self.table.table;
        let mut n = 0;
        for j in 0..=self.volume.size[1] {
            if !self.has_cells(j, k) {
                continue;
            }
            let cells = self.cells(j, k);
            let (low, low_next) = (starts[j], starts[self.across + j]);
            let (high, high_next) = (starts[j + 1], starts[self.across + j + 1]);
            let mut counters = Counters {
                x: [low[0], high[0], low_next[0], high_next[0]],
                y: [low[1], low_next[1]],
                z: [low[2], high[2]],
            };
            for w in 0..self.words {
                let word = cells.word(w);
                let mut crossed = word.mixed() & self.allowed[w];
                while crossed != 0 {
                    let case = word.case(crossed.trailing_zeros());
                    crossed &= crossed - 1;
                    let edges = counters.pass(self.table.crossed[case]);
                    let edge = |edge: u8| edges[usize::from(edge & 15)];
                    for &[a, b, c] in table.triangles(case as u8) {
                        out[n] = [edge(a), edge(b), edge(c)];
                        n += 1;
                    }
                }
            }
        }
    }
}

/// A vertex on an edge of the grid.
struct OnEdge {
    /// 0 at the lower end, 1 at the upper.
    t: f64,
    /// 0 between two samples; the direction of the normal along the edge, where one end is in the
    /// layer around.
    cap: f64,
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
    /// next. Four numbers without meaning follow: an index of 4 bits is in range.
    #[inline(always)]
    fn pass(&mut self, crossed: u16) -> [u32; 16] {
        let crossed = u32::from(crossed);
        let has = |edge: u32| crossed >> edge & 1;
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
            0,
            0,
            0,
            0,
        ];
        *x = [x[0] + has(0), x[1] + has(1), x[2] + has(2), x[3] + has(3)];
        *y = [edges[5], edges[7]];
        *z = [edges[9], edges[11]];
        edges
    }
}
