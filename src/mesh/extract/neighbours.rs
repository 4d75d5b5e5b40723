//! Which block is next to which.
//!
//! Blocks in the order of their coordinates, z first: what is a given step further along the
//! axes comes in the same order, so one sweep along the list finds it for every block.

use super::ExtractError;
use crate::mesh::signs::BLOCK;

/// Marks a neighbour that is not in the list.
const NONE: u32 = u32::MAX;

/// The steps to the neighbours that hold vertices of a block's cells, by the axes along which
/// they are further, as bits 0 to 2; the last comes before the seventh, the diagonal one.
const STEPS: usize = 6;

/// The neighbours of every block.
pub(super) struct Neighbours {
    upper: Vec<[u32; STEPS]>,
    lower: Vec<[u32; 3]>,
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
        // In the order of z, y, x.
        let key = |[x, y, z]: [u32; 3]| [z, y, x];
        let mut sorted: Vec<([u32; 3], u32)> = blocks.iter().map(|&b| key(b)).zip(0..).collect();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return error(key(pair[0].0), "it is listed twice");
        }
        let mut upper = vec![[NONE; STEPS]; blocks.len()];
        let mut lower = vec![[NONE; 3]; blocks.len()];
        for bits in 1..=STEPS {
            let by = |axis: usize| (bits >> axis & 1) as u32 * BLOCK as u32;
            let mut ahead = sorted.iter().peekable();
            for &([z, y, x], number) in &sorted {
                let step = || Some([z.checked_add(by(2))?, y.checked_add(by(1))?, x.checked_add(by(0))?]);
                let Some(wanted) = step() else { continue };
                while ahead.next_if(|(key, _)| *key < wanted).is_some() {}
                if let Some(&&(_, other)) = ahead.peek().filter(|(key, _)| *key == wanted) {
                    upper[number as usize][bits - 1] = other;
                    if bits.is_power_of_two() {
                        lower[other as usize][bits.trailing_zeros() as usize] = number;
                    }
                }
            }
        }
        Ok(Neighbours { upper, lower })
    }

    /// The neighbour of block `n` that is one block further along the axes in `bits`, 1 to 6.
    pub(super) fn upper(&self, n: usize, bits: usize) -> Option<usize> {
        Some(self.upper[n][bits - 1]).filter(|&other| other != NONE).map(|other| other as usize)
    }

    /// The neighbour of block `n` below it along an axis.
    pub(super) fn lower(&self, n: usize, axis: usize) -> Option<usize> {
        Some(self.lower[n][axis]).filter(|&other| other != NONE).map(|other| other as usize)
    }
}
