//! Rows of signs as bits, and the cells between four of them.
//!
//! What is here runs once a word, or once a crossed cell: plain loops, always inlined.

use crate::mesh::signs::gathered;

/// A row of cells at hand: the rows of nodes at its corners, in the order of the corners.
pub(super) struct CellRow<'a>(pub(super) [&'a [u64]; 4]);

/// 64 cells of a row: the signs of the nodes at their lower and at their upper ends along x.
#[derive(Clone, Copy)]
pub(super) struct Word {
    pub(super) row: [u64; 4],
    pub(super) next: [u64; 4],
}

impl CellRow<'_> {
    #[inline(always)]
    pub(super) fn word(&self, w: usize) -> Word {
        let [a, b, c, d] = self.0;
        let row = [a[w], b[w], c[w], d[w]];
        let after = if w + 1 < a.len() { [a[w + 1], b[w + 1], c[w + 1], d[w + 1]] } else { [0; 4] };
        let shifted = |n: usize| row[n] >> 1 | after[n] << 63;
        Word { row, next: [shifted(0), shifted(1), shifted(2), shifted(3)] }
    }
}

impl Word {
    /// The cells that have nodes of both signs.
    #[inline(always)]
    pub(super) fn mixed(&self) -> u64 {
        let Word { row: [a, b, c, d], next: [e, f, g, h] } = *self;
        (a | b | c | d | e | f | g | h) & !(a & b & c & d & e & f & g & h)
    }

    /// The case of cell `bit`.
    #[inline(always)]
    pub(super) fn case(&self, bit: u32) -> usize {
        let Word { row: [a, b, c, d], next: [e, f, g, h] } = *self;
        let lower = a >> bit & 1 | (b >> bit & 1) << 2 | (c >> bit & 1) << 4 | (d >> bit & 1) << 6;
        let upper = e >> bit & 1 | (f >> bit & 1) << 2 | (g >> bit & 1) << 4 | (h >> bit & 1) << 6;
        (lower | upper << 1) as usize
    }
}

/// Packs whether samples are above a level.
#[inline]
pub(super) fn pack(samples: &[f32], level: f32, out: &mut [u64]) {
    // Node 0 is that of the layer around: the first sample is bit 1.
    let mut carry = 0;
    let (chunks, rest) = samples.as_chunks::<64>();
    let (whole, last) = out.split_at_mut(chunks.len());
    for (out, chunk) in whole.iter_mut().zip(chunks) {
        let mut bits = 0;
        for n in 0..8 {
            let mut bytes = [0; 8];
            for m in 0..8 {
                bytes[m] = u8::from(chunk[8 * n + m] > level);
            }
            bits |= u64::from(gathered(bytes)) << (8 * n);
        }
        *out = bits << 1 | carry;
        carry = bits >> 63;
    }
    let mut bits = 0;
    for (n, &value) in rest.iter().enumerate() {
        bits |= u64::from(value > level) << n;
    }
    for (n, out) in last.iter_mut().enumerate() {
        *out = if n == 0 { bits << 1 | carry } else { bits >> 63 };
    }
}
