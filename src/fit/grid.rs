//! A grid over points: who is near whom.

use glam::{DVec3, IVec3};

/// Points sorted by cubic cells.
pub(super) struct Grid<'a> {
    points: &'a [DVec3],
    low: DVec3,
    cell: f64,
    size: IVec3,
    /// Where the points of a cell begin in `order`.
    starts: Vec<u32>,
    order: Vec<u32>,
    /// The points in that order.
    sorted: Vec<DVec3>,
}

/// Cells along an axis at most.
const MOST: f64 = 256.0;

impl Grid<'_> {
    /// A grid of cells of this size over points in a box, larger ones where it would be too fine.
    pub(super) fn new(points: &[DVec3], [low, high]: [DVec3; 2], cell: f64) -> Grid<'_> {
        let extent = high - low;
        let cell = cell.max(extent.max_element() / MOST).max(f64::MIN_POSITIVE);
        let size = (extent / cell).floor().as_ivec3() + 1;
        let mut grid = Grid { points, low, cell, size, starts: Vec::new(), order: Vec::new(), sorted: Vec::new() };
        let cells = (size.x * size.y * size.z) as usize;
        grid.starts = vec![0; cells + 1];
        let homes: Vec<usize> = points.iter().map(|p| grid.index(grid.cell_of(*p))).collect();
        for &home in &homes {
            grid.starts[home + 1] += 1;
        }
        for i in 0..cells {
            grid.starts[i + 1] += grid.starts[i];
        }
        let mut next = grid.starts.clone();
        grid.order = vec![0; points.len()];
        for (i, &home) in (0u32..).zip(&homes) {
            grid.order[next[home] as usize] = i;
            next[home] += 1;
        }
        grid.sorted = grid.order.iter().map(|i| points[*i as usize]).collect();
        grid
    }

    fn cell_of(&self, p: DVec3) -> IVec3 {
        // What is below the box by rounding comes to 0 as well.
        ((p - self.low) / self.cell).as_ivec3().clamp(IVec3::ZERO, self.size - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.size.y + cell.y) * self.size.x + cell.x) as usize
    }

    /// How many points are in the 27 cells about each point, itself among them.
    pub(super) fn crowds(&self) -> Vec<u32> {
        self.points
            .iter()
            .map(|p| {
                let at = self.cell_of(*p);
                let (low, high) = ((at - 1).max(IVec3::ZERO), (at + 1).min(self.size - 1));
                let mut count = 0;
                for z in low.z..=high.z {
                    for y in low.y..=high.y {
                        let (from, to) = (self.index(IVec3::new(low.x, y, z)), self.index(IVec3::new(high.x, y, z)));
                        count += self.starts[to + 1] - self.starts[from];
                    }
                }
                count
            })
            .collect()
    }

    /// The nearest points, the point itself among them, from the nearest on, with squared
    /// distances.
    pub(super) fn nearest(&self, p: DVec3, count: usize, found: &mut Vec<(f64, u32)>) {
        let at = self.cell_of(p);
        for reach in 1.. {
            found.clear();
            let (low, high) = ((at - reach).max(IVec3::ZERO), (at + reach).min(self.size - 1));
            for z in low.z..=high.z {
                for y in low.y..=high.y {
                    self.take(IVec3::new(low.x, y, z), high.x, p, count, found);
                }
            }
            let is_all = low == IVec3::ZERO && high == self.size - 1;
            // What is not in the block is farther away than its sides, where there is more beyond.
            let (from, to) = (self.low + low.as_dvec3() * self.cell, self.low + (high + 1).as_dvec3() * self.cell);
            let safe = self.room(p, [from, to], [low, high]);
            if is_all || (found.len() == count && found[count - 1].0 <= safe * safe) {
                break;
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

    /// Offers the points of a row of cells.
    fn take(&self, from: IVec3, to: i32, p: DVec3, count: usize, found: &mut Vec<(f64, u32)>) {
        let first = self.starts[self.index(from)] as usize;
        let last = self.starts[self.index(IVec3::new(to, from.y, from.z)) + 1] as usize;
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
