//! A grid over points: who is near whom.

use glam::{DVec3, IVec3};

/// Points sorted by cubic cells.
pub(super) struct Grid<'a> {
    points: &'a [DVec3],
    low: DVec3,
    cell: f64,
    /// Cells a length unit.
    inverse: f64,
    size: IVec3,
    /// Where the points of a cell begin in `order`.
    starts: Vec<u32>,
    order: Vec<u32>,
    /// The points in that order.
    sorted: Vec<DVec3>,
}

/// A cell: where its points are in the order of the cells, and those of the 27 about it, by rows.
pub(super) struct Block {
    pub(super) own: [usize; 2],
    pub(super) rows: [[usize; 2]; 9],
}

/// Cells along an axis at most.
const MOST: f64 = 256.0;

impl Grid<'_> {
    /// A grid of cells of this size over points in a box, larger ones where it would be too fine.
    pub(super) fn new(points: &[DVec3], [low, high]: [DVec3; 2], cell: f64) -> Grid<'_> {
        let extent = high - low;
        let cell = cell.max(extent.max_element() / MOST).max(f64::MIN_POSITIVE);
        let inverse = 1.0 / cell;
        let size = (extent * inverse).floor().as_ivec3() + 1;
        let (starts, order, sorted) = (Vec::new(), Vec::new(), Vec::new());
        let mut grid = Grid { points, low, cell, inverse, size, starts, order, sorted };
        let cells = (size.x * size.y * size.z) as usize;
        // While points are put in place, the second entry from a cell on is where its next one
        // goes: in the end that is where the cell after it begins.
        grid.starts = vec![0; cells + 2];
        let homes: Vec<u32> = points.iter().map(|p| grid.index(grid.cell_of(*p)) as u32).collect();
        for &home in &homes {
            grid.starts[home as usize + 2] += 1;
        }
        for i in 2..cells + 2 {
            grid.starts[i] += grid.starts[i - 1];
        }
        grid.order = vec![0; points.len()];
        grid.sorted = vec![DVec3::ZERO; points.len()];
        for ((i, &home), point) in (0u32..).zip(&homes).zip(points) {
            let next = &mut grid.starts[home as usize + 1];
            (grid.order[*next as usize], grid.sorted[*next as usize]) = (i, *point);
            *next += 1;
        }
        grid
    }

    fn cell_of(&self, p: DVec3) -> IVec3 {
        // What is below the box by rounding comes to 0 as well.
        ((p - self.low) * self.inverse).as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// The side of a cell.
    pub(super) fn cell(&self) -> f64 {
        self.cell
    }

    /// The points in the order of their cells, and their numbers.
    pub(super) fn sorted(&self) -> (&[DVec3], &[u32]) {
        (&self.sorted, &self.order)
    }

    /// The cells that have points.
    pub(super) fn blocks(&self) -> Vec<Block> {
        let mut blocks = Vec::with_capacity(self.sorted.len());
        let mut from = 0;
        while from < self.sorted.len() {
            let at = self.cell_of(self.sorted[from]);
            let to = self.starts[self.index(at) + 1] as usize;
            let (low, high) = ((at - 1).max(IVec3::ZERO), (at + 1).min(self.size - 1));
            let mut block = Block { own: [from, to], rows: [[0; 2]; 9] };
            let mut row = 0;
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    let first = self.index(IVec3::new(low.x, y, z));
                    let last = first + (high.x - low.x) as usize;
                    block.rows[row] = [self.starts[first] as usize, self.starts[last + 1] as usize];
                    row += 1;
                }
            }
            blocks.push(block);
            from = to;
        }
        blocks
    }

    /// How many points are in the 27 cells about each point, itself among them.
    pub(super) fn crowds(&self) -> Vec<u32> {
        let mut crowds = vec![0; self.points.len()];
        for Block { own: [from, to], rows } in self.blocks() {
            let crowd = rows.iter().map(|[from, to]| (to - from) as u32).sum();
            for &i in &self.order[from..to] {
                crowds[i as usize] = crowd;
            }
        }
        crowds
    }

    /// The nearest points, the point itself among them, from the nearest on, with squared
    /// distances.
    pub(super) fn nearest(&self, p: DVec3, count: usize, found: &mut Vec<(f64, u32)>) {
        let at = self.cell_of(p);
        found.clear();
        let own = self.index(at);
        self.take([own, own], p, count, found);
        for reach in 1i32.. {
            // The cells that far from its own, rows from the nearest on.
            for away in 0..=2 * reach {
                for y in -away.min(reach)..=away.min(reach) {
                    let z = away - y.abs();
                    if z > reach {
                        continue;
                    }
                    self.row(p, at, [y, z], reach, count, found);
                    if z != 0 {
                        self.row(p, at, [y, -z], reach, count, found);
                    }
                }
            }
            let (low, high) = ((at - reach).max(IVec3::ZERO), (at + reach).min(self.size - 1));
            let is_all = low == IVec3::ZERO && high == self.size - 1;
            // What is not in the block is farther away than its sides, where there is more beyond.
            let (from, to) = (self.low + low.as_dvec3() * self.cell, self.low + (high + 1).as_dvec3() * self.cell);
            let safe = self.room(p, [from, to], [low, high]);
            if is_all || (found.len() == count && found[count - 1].0 <= safe * safe) {
                break;
            }
        }
    }

    /// Offers the cells of a row along x that are exactly `reach` from a point's own.
    fn row(&self, p: DVec3, at: IVec3, [y, z]: [i32; 2], reach: i32, count: usize, found: &mut Vec<(f64, u32)>) {
        let row = at + IVec3::new(0, y, z);
        if row.y < 0 || row.y >= self.size.y || row.z < 0 || row.z >= self.size.z {
            return;
        }
        // How far the row is.
        let off = |axis: usize| {
            let from = self.low[axis] + f64::from(row[axis]) * self.cell;
            (from - p[axis]).max(p[axis] - from - self.cell).max(0.0)
        };
        let (y_off, z_off) = (off(1), off(2));
        if found.len() == count && y_off * y_off + z_off * z_off >= found[count - 1].0 {
            return;
        }
        let (low, high) = (at.x - reach, at.x + reach);
        let index = |x: i32| self.index(IVec3::new(x, row.y, row.z));
        if y.abs() == reach || z.abs() == reach {
            self.take([index(low.max(0)), index(high.min(self.size.x - 1))], p, count, found);
            return;
        }
        for x in [low, high] {
            if x >= 0 && x < self.size.x {
                self.take([index(x); 2], p, count, found);
            }
        }
    }

    /// How far a point is from the sides of a block that there are cells beyond.
    fn room(&self, p: DVec3, [from, to]: [DVec3; 2], [low, high]: [IVec3; 2]) -> f64 {
        let mut room = f64::INFINITY;
        for axis in 0..3 {
            if low[axis] > 0 {
                room = room.min(p[axis] - from[axis]);
            }
            if high[axis] < self.size[axis] - 1 {
                room = room.min(to[axis] - p[axis]);
            }
        }
        room.max(0.0)
    }

    /// Offers the points of cells that follow each other.
    fn take(&self, [from, to]: [usize; 2], p: DVec3, count: usize, found: &mut Vec<(f64, u32)>) {
        let (first, last) = (self.starts[from] as usize, self.starts[to + 1] as usize);
        let mut worst = if found.len() == count { found[count - 1].0 } else { f64::INFINITY };
        for (q, &i) in self.sorted[first..last].iter().zip(&self.order[first..last]) {
            let away = q.distance_squared(p);
            if away >= worst {
                continue;
            }
            if found.len() < count {
                found.push((away, i));
            }
            let mut at = found.len() - 1;
            while at > 0 && found[at - 1].0 > away {
                found[at] = found[at - 1];
                at -= 1;
            }
            found[at] = (away, i);
            if found.len() == count {
                worst = found[count - 1].0;
            }
        }
    }
}

/// The box of points.
pub(super) fn extent(points: &[DVec3]) -> [DVec3; 2] {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    [low, high]
}

/// The volume of a box, as of one that is a thousandth of its longest side thick at least.
pub(super) fn volume([low, high]: [DVec3; 2]) -> f64 {
    let size = high - low;
    size.max(DVec3::splat(1e-3 * size.max_element())).element_product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    #[test]
    fn nearest_points_are_those_of_a_full_search() {
        let mut random = Random::new(3);
        let mut unit = || random.below(1 << 20) as f64 / (1 << 20) as f64;
        let points: Vec<DVec3> = (0..400).map(|_| DVec3::new(unit(), 0.2 * unit(), unit().powi(3))).collect();
        let grid = Grid::new(&points, extent(&points), 0.07);
        let mut found = Vec::new();
        for p in &points {
            grid.nearest(*p, 9, &mut found);
            let mut all: Vec<f64> = points.iter().map(|q| q.distance_squared(*p)).collect();
            all.sort_by(f64::total_cmp);
            assert!(found.iter().zip(&all).all(|(f, a)| f.0 == *a) && found.len() == 9);
        }
    }
}
