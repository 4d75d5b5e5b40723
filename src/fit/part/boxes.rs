//! Boxes between planes of a frame: the best of all of them, by sums over a grid.
//!
//! ```text
//!     offsets x₀ … x₁₅ of planes        for each range of x and of y: the columns' sums along z,
//!     cells between them, their sums    and the run of them with the greatest sum (Kadane)
//! ```

use std::collections::HashSet;

use glam::{DMat3, DVec3};

use super::bits::{Stakes, WORD};
use super::candidates::BEYOND;
use super::leaf::Leaf;
use super::pool::Pool;
use super::queries::Queries;

/// Offsets along an axis.
pub(super) const MOST: usize = 15;

/// Boxes proposed at once.
const BEST: usize = 3;

/// Planes of a frame and the cells that samples are in.
pub(super) struct Grid {
    frame: DMat3,
    offsets: [Vec<f64>; 3],
    /// By sample: the cell, or `OUT`.
    cells: Vec<u16>,
    seen: HashSet<([[u8; 2]; 3], bool)>,
}

const OUT: u16 = u16::MAX;

impl Grid {
    /// `offsets` along each axis from the least up, at least 2 of them and at most [`MOST`].
    pub(super) fn new(frame: DMat3, offsets: [Vec<f64>; 3], queries: &Queries) -> Grid {
        let cell = |p: &DVec3| {
            let local = frame.transpose() * *p;
            let mut cell = 0;
            for axis in 0..3 {
                let at = offsets[axis].partition_point(|x| *x <= local[axis]);
                if at == 0 || at == offsets[axis].len() {
                    return OUT;
                }
                cell = cell * (offsets[axis].len() - 1) + at - 1;
            }
            cell as u16
        };
        let cells = queries.points.iter().map(cell).collect();
        Grid { frame, offsets, cells, seen: HashSet::new() }
    }

    /// Puts the best boxes for stakes among the candidates.
    pub(super) fn propose(&mut self, stakes: &Stakes, adds: bool, dear: f64, queries: &Queries, pool: &mut Pool) {
        let price = 9.0 * pool.per_parameter;
        for box_ in self.best(stakes, dear, queries, price) {
            if !self.seen.insert((box_, adds)) {
                continue;
            }
            let leaf = Leaf::cuboid(self.frame, [0, 1].map(|end| self.corner(box_, end, adds)));
            pool.add(leaf, queries, [adds, !adds], None);
        }
    }

    /// The lower corner of a box, or the upper one. What is cut up to the end of the part is cut
    /// beyond.
    fn corner(&self, box_: [[u8; 2]; 3], end: usize, adds: bool) -> DVec3 {
        let along = |k: usize| {
            let offsets = &self.offsets[k];
            match usize::from(box_[k][end]) {
                at if adds => offsets[at],
                0 => offsets[0] - BEYOND,
                at if at + 1 == offsets.len() => offsets[at] + BEYOND,
                at => offsets[at],
            }
        };
        DVec3::from_array([0, 1, 2].map(along))
    }

    /// The boxes that gain most, and more than the price, by numbers of offsets.
    fn best(&self, stakes: &Stakes, dear: f64, queries: &Queries, price: f64) -> Vec<[[u8; 2]; 3]> {
        let [nx, ny, nz] = [0, 1, 2].map(|k| self.offsets[k].len() - 1);
        let mut sums = vec![0.0; nx * ny * nz];
        let mut all = 0.0;
        for at in stakes.gain.each().filter(|at| self.cells[*at] != OUT) {
            sums[usize::from(self.cells[at])] += queries.weights[at / WORD];
            all += queries.weights[at / WORD];
        }
        // Late in the search there is little to gain, and nothing here.
        if all <= price {
            return Vec::new();
        }
        for at in stakes.loss.each().filter(|at| self.cells[*at] != OUT) {
            sums[usize::from(self.cells[at])] -= dear * queries.weights[at / WORD];
        }
        let mut best: Vec<(f64, [[u8; 2]; 3])> = Vec::new();
        // Sums along y from its first offset on, of the layers from x₀ to x₁; and what is positive
        // of them, by which most ranges are out before their columns are looked at.
        let mut along = vec![0.0; (ny + 1) * nz];
        let mut positive = vec![0.0; ny + 1];
        for x0 in 0..nx {
            along.fill(0.0);
            positive.fill(0.0);
            for x1 in x0..nx {
                let layer = &sums[x1 * ny * nz..(x1 + 1) * ny * nz];
                for z in 0..nz {
                    let mut sum = 0.0;
                    for y in 0..ny {
                        sum += layer[y * nz + z];
                        along[(y + 1) * nz + z] += sum;
                    }
                }
                let mut sum = 0.0;
                for (total, row) in positive[1..].iter_mut().zip(layer.chunks_exact(nz)) {
                    sum += row.iter().map(|x| x.max(0.0)).sum::<f64>();
                    *total += sum;
                }
                for y0 in 0..ny {
                    let least = if best.len() < BEST { price } else { best[BEST - 1].0 };
                    if positive[ny] - positive[y0] <= least {
                        break;
                    }
                    for y1 in y0 + 1..=ny {
                        let least = if best.len() < BEST { price } else { best[BEST - 1].0 };
                        if positive[y1] - positive[y0] <= least {
                            continue;
                        }
                        let (low, high) = (&along[y0 * nz..(y0 + 1) * nz], &along[y1 * nz..(y1 + 1) * nz]);
                        let (gain, z) = run(low, high);
                        if gain > least {
                            let found = [[x0, x1 + 1], [y0, y1], z].map(|range| range.map(|i| i as u8));
                            let place = best.partition_point(|other| other.0 >= gain);
                            best.insert(place, (gain, found));
                            best.truncate(BEST);
                        }
                    }
                }
            }
        }
        best.into_iter().map(|(_, found)| found).collect()
    }
}

/// The run of differences with the greatest sum.
fn run(low: &[f64], high: &[f64]) -> (f64, [usize; 2]) {
    let (mut best, mut range) = (f64::NEG_INFINITY, [0, 1]);
    let (mut sum, mut from) = (0.0, 0);
    for (z, (low, high)) in low.iter().zip(high).enumerate() {
        if sum <= 0.0 {
            (sum, from) = (0.0, z);
        }
        sum += high - low;
        if sum > best {
            (best, range) = (sum, [from, z + 1]);
        }
    }
    (best, range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::part::bits::Bits;

    #[test]
    fn the_box_is_found_among_all() {
        let (low, high) = (DVec3::new(-0.3, -0.2, -0.1), DVec3::new(0.1, 0.2, 0.3));
        let truth = Leaf::cuboid(DMat3::IDENTITY, [low, high]);
        let whole = [DVec3::splat(-0.4), DVec3::splat(0.4)];
        let queries =
            Queries::new(whole, [&[], &[]], &[], 1, |points| Ok(Bits::of(points, |p| truth.contains(p)))).unwrap();
        let offsets = [0, 1, 2].map(|_| (-4..=4).map(|i| f64::from(i) / 10.0).collect());
        let mut grid = Grid::new(DMat3::IDENTITY, offsets, &queries);
        let inside = queries.inside.clone();
        let outside = inside.with(&inside, |a, _| !a);
        let mut pool = Pool::new(0.0);
        grid.propose(&Stakes { gain: inside, loss: outside }, true, 1.0, &queries, &mut pool);
        let found = &pool.candidates[0];
        assert_eq!(found.bits, queries.inside);
        assert!(found.leaf.centre.distance(truth.centre) < 1e-12);
    }
}
