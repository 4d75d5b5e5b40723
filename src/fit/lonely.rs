//! Which points are far from their neighbours, compared with how far those are from theirs.
//!
//! A point's reach is its distance to the eighth nearest point, itself being the first. It is
//! lonely if that is much more than the mean of those eight. The points of a cell are asked at
//! once, on SIMD lanes: each candidate of the cells about it sinks into a sorted list of the
//! nearest, without a branch.

use fearless_simd::Simd;
use rvachev_num::Real;
use rvachev_num::lanes::{F32, Lanes};

use super::grid::{Block, Grid};

/// Neighbours that distances are taken to, the point itself among them.
const NEIGHBOURS: usize = 8;

/// A point is lonely whose reach is more than this times the mean.
const LONELY: f32 = 1.3;

/// No vector is wider.
const WIDTH: usize = 16;

/// Of each point of a grid whether it is lonely.
pub(super) fn lonely(grid: &Grid) -> Vec<bool> {
    let (sorted, order) = grid.sorted();
    let origin = sorted.first().copied().unwrap_or_default();
    // A vector that begins at the last point has to end somewhere.
    let columns = [0, 1, 2].map(|axis| {
        let along = sorted.iter().map(|p| (p[axis] - origin[axis]) as f32);
        along.chain([0.0; WIDTH]).collect::<Vec<f32>>()
    });
    let blocks = grid.blocks();
    let mut reaches = rvachev_num::on_level!(simd => reaches_on(simd, grid.cell(), &blocks, &columns));
    // What is farther away than a cell's side may be outside of the block: the grid is asked.
    let cell = grid.cell() as f32;
    let far: Vec<usize> = (0..order.len()).filter(|i| reaches[*i] > cell).collect();
    let mut found = Vec::with_capacity(NEIGHBOURS);
    let mut near = Vec::with_capacity(far.len());
    for &i in &far {
        grid.nearest(sorted[i], NEIGHBOURS, &mut found);
        reaches[i] = found.last().map_or(0.0, |last| last.0.sqrt() as f32);
        near.push(found.iter().map(|neighbour| neighbour.1).collect::<Vec<u32>>());
    }
    let sums = rvachev_num::on_level!(simd => sums_on(simd, &blocks, &columns, &reaches));
    let mut by_number = vec![0.0; order.len()];
    let mut lonely = vec![false; order.len()];
    for ((number, reach), sum) in order.iter().zip(&reaches).zip(sums) {
        by_number[*number as usize] = *reach;
        lonely[*number as usize] = NEIGHBOURS as f32 * reach > LONELY * sum;
    }
    for (i, near) in far.iter().zip(near) {
        let sum: f32 = near.iter().map(|neighbour| by_number[*neighbour as usize]).sum();
        lonely[order[*i] as usize] = near.len() as f32 * reaches[*i] > LONELY * sum;
    }
    lonely
}

/// The reaches of the points within the blocks, in the order of the cells.
#[inline(always)]
fn reaches_on<S: Simd>(simd: S, cell: f64, blocks: &[Block], columns: &[Vec<f32>; 3]) -> Vec<f32> {
    let width = <F32<S> as Lanes>::WIDTH;
    let [xs, ys, zs] = columns;
    // No point of a block is farther from another.
    let far = 12.0 * cell.powi(2);
    let mut reaches = vec![0.0; xs.len()];
    let mut buffer = [0.0; WIDTH];
    for block in blocks {
        for from in (block.own[0]..block.own[1]).step_by(width) {
            let to = block.own[1].min(from + width);
            let p = [load(simd, xs, from), load(simd, ys, from), load(simd, zs, from)];
            let mut nearest = [<F32<S> as Lanes>::splat(simd, far); NEIGHBOURS];
            for [first, last] in block.rows {
                for k in first..last {
                    let mut square = apart(p, [xs[k], ys[k], zs[k]]);
                    for near in &mut nearest {
                        let farther = near.max(square);
                        *near = near.min(square);
                        square = farther;
                    }
                }
            }
            nearest[NEIGHBOURS - 1].sqrt().store(&mut buffer[..width]);
            reaches[from..to].copy_from_slice(&buffer[..to - from]);
        }
    }
    reaches
}

/// The sum of the reaches of what is within a point's own, of each point.
#[inline(always)]
fn sums_on<S: Simd>(simd: S, blocks: &[Block], columns: &[Vec<f32>; 3], reaches: &[f32]) -> Vec<f32> {
    let width = <F32<S> as Lanes>::WIDTH;
    let [xs, ys, zs] = columns;
    let zero = <F32<S> as Lanes>::splat(simd, 0.0);
    let mut sums = vec![0.0; xs.len() - WIDTH];
    let mut buffer = [0.0; WIDTH];
    for block in blocks {
        for from in (block.own[0]..block.own[1]).step_by(width) {
            let to = block.own[1].min(from + width);
            let p = [load(simd, xs, from), load(simd, ys, from), load(simd, zs, from)];
            // A little more, for the last one is at the very reach.
            let square = load(simd, reaches, from).square() * (1.0 + 1e-6);
            let mut sum = zero;
            for [first, last] in block.rows {
                for k in first..last {
                    let within = square - apart(p, [xs[k], ys[k], zs[k]]);
                    sum = sum + within.select(zero + f64::from(reaches[k]), zero);
                }
            }
            sum.store(&mut buffer[..width]);
            sums[from..to].copy_from_slice(&buffer[..to - from]);
        }
    }
    sums
}

#[inline(always)]
fn load<S: Simd>(simd: S, column: &[f32], at: usize) -> F32<S> {
    <F32<S> as Lanes>::load(simd, &column[at..at + <F32<S> as Lanes>::WIDTH])
}

/// The squares of the distances to a point.
#[inline(always)]
fn apart<S: Simd>(p: [F32<S>; 3], q: [f32; 3]) -> F32<S> {
    let [x, y, z] = [p[0] - f64::from(q[0]), p[1] - f64::from(q[1]), p[2] - f64::from(q[2])];
    x.mul_add(x, y.mul_add(y, z.square()))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::fit::grid::extent;
    use crate::fit::random::Random;

    /// Strewn points among those of a plane are lonely, and those of the plane are not, whatever
    /// their density.
    #[test]
    fn points_beside_a_plane_are_lonely() {
        let mut random = Random::new(6);
        let mut points: Vec<DVec3> =
            (0..900).map(|_| DVec3::new(random.unit().powi(2), random.unit(), 0.004 * random.unit())).collect();
        points.extend((0..60).map(|i| DVec3::new(random.unit(), random.unit(), if i % 2 == 0 { 0.12 } else { -0.15 })));
        let found = lonely(&Grid::new(&points, extent(&points), 0.2));
        let count = |found: &[bool]| found.iter().filter(|lonely| **lonely).count();
        let (on, beside) = found.split_at(900);
        assert!(count(on) < 45 && count(beside) > 50, "{} {}", count(on), count(beside));
    }
}
