//! Sets of cells of a block.

use crate::mesh::signs::BLOCK;

/// Words of bits for the cells of a block.
const WORDS: usize = BLOCK * BLOCK * BLOCK / 64;

/// Some cells of a block, by their numbers there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellSet([u64; WORDS]);

impl CellSet {
    #[inline(always)]
    pub(super) fn insert(&mut self, number: u16) {
        self.0[usize::from(number) / 64] |= 1 << (number % 64);
    }

    #[inline(always)]
    pub(super) fn has(&self, number: u16) -> bool {
        self.0[usize::from(number) / 64] >> (number % 64) & 1 == 1
    }
}

impl FromIterator<u16> for CellSet {
    fn from_iter<T: IntoIterator<Item = u16>>(numbers: T) -> CellSet {
        let mut set = CellSet::default();
        numbers.into_iter().for_each(|number| set.insert(number));
        set
    }
}

/// The places of some cells of a block in a list of them, which is in the order of their numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellOrder {
    cells: CellSet,
    /// How many come before those of each word.
    before: [u16; WORDS],
}

impl CellOrder {
    pub(super) fn new(cells: CellSet) -> CellOrder {
        let mut before = [0; WORDS];
        for n in 1..WORDS {
            before[n] = before[n - 1] + cells.0[n - 1].count_ones() as u16;
        }
        CellOrder { cells, before }
    }

    /// The place of a cell, if it is in the list.
    #[inline(always)]
    pub(super) fn place(&self, number: u16) -> Option<usize> {
        let word = usize::from(number) / 64;
        let lower = self.cells.0[word] & ((1 << (number % 64)) - 1);
        self.cells.has(number).then(|| usize::from(self.before[word]) + lower.count_ones() as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_in_a_sorted_list() {
        let mut numbers: Vec<u16> = (0..40).map(|n| n * n * 7 % 512).chain([0, 63, 64, 511]).collect();
        numbers.sort_unstable();
        numbers.dedup();
        let order = CellOrder::new(numbers.iter().rev().copied().collect());
        for number in 0..512 {
            assert_eq!(order.place(number), numbers.binary_search(&number).ok(), "{number}");
        }
    }
}
