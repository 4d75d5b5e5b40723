//! Rows of signs as bits, and the cells between four of them.

use crate::mesh::signs::gathered;

/// A row of cells at hand: the rows of nodes at its corners, in the order of the corners.
pub(super) struct CellRow<'a>(pub(super) [&'a [u64]; 4]);

impl CellRow<'_> {
    pub(super) fn words(&self, w: usize) -> [u64; 4] {
        self.0.map(|row| row[w])
    }

    /// The same, shifted by one node.
    pub(super) fn next(&self, w: usize) -> [u64; 4] {
        self.0.map(|row| row[w] >> 1 | row.get(w + 1).map_or(0, |next| next << 63))
    }
}

/// The cells that have nodes of both signs.
pub(super) fn mixed(row: [u64; 4], next: [u64; 4]) -> u64 {
    let any = row.iter().chain(&next).fold(0, |all, bits| all | bits);
    let all = row.iter().chain(&next).fold(u64::MAX, |all, bits| all & bits);
    any & !all
}

/// The case of cell `bit`.
pub(super) fn case(row: [u64; 4], next: [u64; 4], bit: u32) -> usize {
    let pair = |n: usize| (row[n] >> bit & 1 | (next[n] >> bit & 1) << 1) << (2 * n);
    (pair(0) | pair(1) | pair(2) | pair(3)) as usize
}

/// Calls `visit` with the number of every bit that is set.
pub(super) fn each_bit(mut bits: u64, mut visit: impl FnMut(u32)) {
    while bits != 0 {
        visit(bits.trailing_zeros());
        bits &= bits - 1;
    }
}

/// Packs whether samples are above a level.
pub(super) fn pack(samples: &[f32], level: f32, out: &mut [u64]) {
    // Node 0 is that of the layer around: the first sample is bit 1.
    let mut carry = 0;
    let words = samples.chunks(64).map(|chunk| word(chunk, level));
    for (out, word) in out.iter_mut().zip(words.chain(std::iter::once(0))) {
        *out = word << 1 | carry;
        carry = word >> 63;
    }
}

/// 64 samples, or fewer, as bits.
fn word(samples: &[f32], level: f32) -> u64 {
    let (eights, rest) = samples.as_chunks::<8>();
    let mut bits = 0;
    for (n, eight) in eights.iter().enumerate() {
        bits |= u64::from(gathered(eight.map(|value| u8::from(value > level)))) << (8 * n);
    }
    for (n, &value) in rest.iter().enumerate() {
        bits |= u64::from(value > level) << (8 * eights.len() + n);
    }
    bits
}
