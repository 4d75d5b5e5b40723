//! Which block is next to which.
//!
//! Blocks in the order of their coordinates, z first: what is a given step further along the
//! axes comes in the same order, so one sweep along the list finds it for every block.

use rayon::prelude::*;
use rvachev_num::jobs;

use super::ExtractError;
use crate::mesh::signs::BLOCK;

/// Marks a neighbour that is not in the list.
const NONE: u32 = u32::MAX;

/// The steps to the neighbours that hold vertices of a block's cells, by the axes along which
/// they are further, as bits 0 to 2; the last comes before the seventh, the diagonal one.
const STEPS: usize = 6;

/// The first cell of a block: z and y, then x.
type Key = (u64, u32);

fn key([x, y, z]: [u32; 3]) -> Key {
    (u64::from(z) << 32 | u64::from(y), x)
}

fn cell((zy, x): Key) -> [u32; 3] {
    [x, zy as u32, (zy >> 32) as u32]
}

/// The neighbours of every block: for each step, that of each block.
pub(super) struct Neighbours {
    /// The blocks in the order of their coordinates, with their numbers.
    sorted: Vec<(Key, u32)>,
    upper: Vec<Vec<u32>>,
    /// Below along each axis.
    lower: Vec<Vec<u32>>,
}

impl Neighbours {
    /// The neighbours among the given blocks.
    pub(super) fn new(blocks: &[[u32; 3]]) -> Result<Neighbours, ExtractError> {
        let error = |block, what| Err(ExtractError::Blocks { block, what });
        if let Some(&block) = blocks.iter().find(|block| block.iter().any(|&n| n % BLOCK as u32 != 0)) {
            return error(block, "its cell is not a multiple of the block size");
        }
        if blocks.len() >= NONE as usize {
            return error(blocks[NONE as usize], "there are more blocks than 32 bits can number");
        }
        let mut sorted: Vec<(Key, u32)> = blocks.iter().map(|&block| key(block)).zip(0..).collect();
        sorted.par_sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return error(cell(pair[0].0), "it is listed twice");
        }
        let (upper, mut lower): (Vec<_>, Vec<_>) = jobs::in_order(STEPS, |n| sweep(&sorted, n + 1)).into_iter().unzip();
        lower.retain(|list| !list.is_empty());
        Ok(Neighbours { sorted, upper, lower })
    }

    /// The number of the block with a first cell.
    pub(super) fn find(&self, block: [u32; 3]) -> Option<usize> {
        let at = self.sorted.binary_search_by_key(&key(block), |&(key, _)| key).ok()?;
        Some(self.sorted[at].1 as usize)
    }

    /// The neighbour of block `n` that is one block further along the axes in `bits`, 1 to 6.
    pub(super) fn upper(&self, n: usize, bits: usize) -> Option<usize> {
        Some(self.upper[bits - 1][n]).filter(|&other| other != NONE).map(|other| other as usize)
    }

    /// The neighbour of block `n` below it along an axis.
    pub(super) fn lower(&self, n: usize, axis: usize) -> Option<usize> {
        Some(self.lower[axis][n]).filter(|&other| other != NONE).map(|other| other as usize)
    }
}

/// The neighbour of every block that is one block further along the axes in `bits`; and, if that is
/// a single axis, the neighbour below it there. The blocks are given in order, with their numbers.
fn sweep(sorted: &[(Key, u32)], bits: usize) -> (Vec<u32>, Vec<u32>) {
    let by = |axis: usize| (bits >> axis & 1) as u32 * BLOCK as u32;
    let mut upper = vec![NONE; sorted.len()];
    let mut lower = vec![NONE; if bits.is_power_of_two() { sorted.len() } else { 0 }];
    let mut ahead = sorted.iter().peekable();
    for &(first, number) in sorted {
        let [x, y, z] = cell(first);
        let step = || Some(key([x.checked_add(by(0))?, y.checked_add(by(1))?, z.checked_add(by(2))?]));
        let Some(wanted) = step() else { continue };
        while ahead.next_if(|(key, _)| *key < wanted).is_some() {}
        if let Some(&&(_, other)) = ahead.peek().filter(|(key, _)| *key == wanted) {
            upper[number as usize] = other;
            if let Some(below) = lower.get_mut(other as usize) {
                *below = number;
            }
        }
    }
    (upper, lower)
}
