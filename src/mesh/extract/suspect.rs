//! Blocks that are looked at again, for features thinner than a cell.

use std::array;

use crate::mesh::signs::{BLOCK, NODES, SIDE, Signs};

/// The farthest that the tip of what is seen goes beyond the cells that the surface crosses, in
/// cells.
pub(super) const TIP: usize = 3;

/// Cells of a block, a bit each: bit `8 j + i` of layer `k`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CellBits([u64; BLOCK]);

/// The first cells of all rows of a layer.
const FIRST: u64 = 0x0101_0101_0101_0101;
/// All of a row.
const ROW: u64 = 0xff;

impl CellBits {
    /// Given the bits of row `j` of layer `k`, of which the first eight count.
    fn of_rows(row: impl Fn(usize, usize) -> u16) -> CellBits {
        let layer = |k| (0..BLOCK).fold(0, |bits, j| bits | u64::from(row(j, k) as u8) << (BLOCK * j));
        CellBits(array::from_fn(layer))
    }

    /// Whether any of a cube of cells is among them.
    pub(in crate::mesh) fn has_any(&self, [i, j, k]: [usize; 3], size: usize) -> bool {
        let row = (ROW >> (BLOCK - size)) << i;
        let square = (j..j + size).fold(0, |bits, j| bits | row << (BLOCK * j));
        self.0[k..k + size].iter().any(|layer| layer & square != 0)
    }

    /// Some cells.
    pub(super) fn of(cells: impl IntoIterator<Item = [usize; 3]>) -> CellBits {
        let mut all = CellBits([0; BLOCK]);
        for [i, j, k] in cells {
            all.0[k] |= 1 << (i + BLOCK * j);
        }
        all
    }

    pub(super) fn count(&self) -> usize {
        self.0.iter().map(|layer| layer.count_ones() as usize).sum()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0 == [0; BLOCK]
    }

    /// Those with a node whose value is at most `least`, either way; `None` if there are none.
    pub(super) fn near(values: &[f32; NODES], least: f32) -> Option<CellBits> {
        if values.iter().fold(f32::INFINITY, |all, value| all.min(value.abs())) > least {
            return None;
        }
        let (rows, _) = values.as_chunks::<SIDE>();
        let mut nodes = [0u16; SIDE * SIDE];
        for (bits, row) in nodes.iter_mut().zip(rows) {
            for (n, value) in row.iter().enumerate() {
                *bits |= u16::from(value.abs() <= least) << n;
            }
        }
        Some(CellBits::of_rows(|j, k| {
            let at = SIDE * k + j;
            let any = nodes[at] | nodes[at + 1] | nodes[at + SIDE] | nodes[at + SIDE + 1];
            any | any >> 1
        }))
    }

    /// Those that the surface crosses.
    fn crossed(signs: &Signs) -> CellBits {
        CellBits::of_rows(|j, k| signs.crossed_cells(j, k))
    }

    /// Takes away the tips of what is seen in the block: cells that one comes to from those that
    /// the surface crosses, from one of these to the next, in [`TIP`] steps.
    pub(super) fn without_tips(&self, signs: &Signs) -> CellBits {
        let about = |cells: CellBits| (0..3).fold(cells, |cells, axis| cells.either(axis, [-1, 1]));
        let tips = (0..TIP).fold(CellBits::crossed(signs), |tips, _| about(tips).both(self));
        self.but(&tips)
    }

    /// Takes away those that are at most so many cells from what the surface crosses in the block
    /// itself, or in its neighbour in a direction, -1, 0 or 1 along each axis.
    pub(super) fn far_from(&self, signs: &Signs, direction: [i32; 3], reach: usize) -> CellBits {
        let near = (0..3).fold(CellBits::crossed(signs), |cells, axis| match direction[axis] {
            0 => (0..reach).fold(cells, |cells, _| cells.either(axis, [-1, 1])),
            // Its last cells are before the first of these.
            step => {
                let entered = cells.moved(axis, step * (BLOCK - reach) as i32);
                (1..reach).fold(entered, |cells, _| cells.either(axis, [step, 0]))
            }
        });
        self.but(&near)
    }

    /// Each moved along an axis, but for what leaves the block.
    fn moved(&self, axis: usize, by: i32) -> CellBits {
        let shifted = |bits: u64, by: i32| if by < 0 { bits >> -by } else { bits << by };
        let row = FIRST * (shifted(ROW, by) & ROW);
        CellBits(array::from_fn(|k| match axis {
            0 => shifted(self.0[k], by) & row,
            1 => shifted(self.0[k], BLOCK as i32 * by),
            _ => k.checked_add_signed(-by as isize).and_then(|k| self.0.get(k)).copied().unwrap_or(0),
        }))
    }

    /// These, and moved by each of two along an axis.
    fn either(&self, axis: usize, by: [i32; 2]) -> CellBits {
        let (one, other) = (self.moved(axis, by[0]), self.moved(axis, by[1]));
        CellBits(array::from_fn(|k| self.0[k] | one.0[k] | other.0[k]))
    }

    fn both(&self, other: &CellBits) -> CellBits {
        CellBits(array::from_fn(|k| self.0[k] & other.0[k]))
    }

    fn but(&self, other: &CellBits) -> CellBits {
        CellBits(array::from_fn(|k| self.0[k] & !other.0[k]))
    }
}

/// A block that is looked at again, and why.
#[derive(Clone, Debug)]
pub(super) struct Suspect {
    pub(super) number: usize,
    /// Cells without a crossing that may have a surface by their samples.
    pub(super) hidden: Option<Box<CellBits>>,
    /// Cells about edges on which the surface is passed there and back.
    pub(super) passed: Option<Box<CellBits>>,
    /// How many nodes are between opposite sides, of a gap and of a wall.
    pub(super) torn: [u32; 2],
    pub(super) is_bored: bool,
}

impl Suspect {
    /// Whether there is a reason to look at it again.
    pub(super) fn is_one(&self) -> bool {
        self.hidden.is_some() || self.passed.is_some() || self.is_bored || self.torn != [0; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: usize = BLOCK * BLOCK * BLOCK;

    fn at(n: usize) -> [usize; 3] {
        [n % BLOCK, n / BLOCK % BLOCK, n / (BLOCK * BLOCK)]
    }

    /// Some of the cells, more or less of them.
    fn some(seed: u64, of: u64) -> [bool; CELLS] {
        let mut state = seed;
        array::from_fn(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33).is_multiple_of(of)
        })
    }

    fn bits(cells: &[bool; CELLS]) -> CellBits {
        let row = |j, k| (0..BLOCK).fold(0, |bits, i| bits | u16::from(cells[i + BLOCK * (j + BLOCK * k)]) << i);
        CellBits::of_rows(row)
    }

    fn all(bits: &CellBits) -> [bool; CELLS] {
        array::from_fn(|n| bits.has_any(at(n), 1))
    }

    /// The values of a block of which a few nodes are inside.
    fn signs(seed: u64) -> Signs {
        let inside = [some(seed, 90), some(seed + 7, 90)].concat();
        Signs::new(&array::from_fn(|n| if inside[n % inside.len()] { 1.0 } else { -1.0 }))
    }

    fn is_crossed(signs: &Signs, cell: [usize; 3]) -> bool {
        !matches!(signs.case(cell), 0 | 255)
    }

    #[test]
    fn what_is_near_a_crossing_of_a_neighbour_is_taken_away() {
        for (seed, direction) in (0..27).map(|n| (n, [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1])) {
            let (signs, cells) = (signs(seed as u64), some(seed as u64 + 50, 2));
            let left = all(&bits(&cells).far_from(&signs, direction, TIP));
            for n in 0..CELLS {
                let reaches = |m: usize| {
                    let apart = |axis: usize| at(m)[axis] as i32 + BLOCK as i32 * direction[axis] - at(n)[axis] as i32;
                    is_crossed(&signs, at(m)) && (0..3).all(|axis| apart(axis).abs() <= TIP as i32)
                };
                assert_eq!(left[n], cells[n] && !(0..CELLS).any(reaches), "{direction:?}: {:?}", at(n));
            }
        }
    }

    #[test]
    fn tips_are_what_is_joined_to_a_crossing() {
        for seed in 0..8 {
            let (signs, cells) = (signs(seed), some(seed + 50, 9));
            let left = all(&bits(&cells).without_tips(&signs));
            let mut tips: [bool; CELLS] = array::from_fn(|n| is_crossed(&signs, at(n)));
            for _ in 0..TIP {
                let before = tips;
                tips = array::from_fn(|n| {
                    let is_beside = |m: usize| before[m] && (0..3).all(|axis| at(m)[axis].abs_diff(at(n)[axis]) <= 1);
                    cells[n] && (0..CELLS).any(is_beside)
                });
            }
            assert_eq!(left, array::from_fn(|n| cells[n] && !tips[n]));
        }
    }
}
