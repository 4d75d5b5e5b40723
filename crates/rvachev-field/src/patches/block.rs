//! Blocks of points, sorted so that those of a packet are near each other.
//!
//! ```text
//!     as they come            sorted: cells of the block's box, in the order of a Z curve
//!     0 1 2 3 4 5 6 7         0 1 4 5 ...
//!     8 9 ...                 2 3 6 7
//! ```
//!
//! A packet looks at every patch that is near to any of its points: a row of sixteen points of a
//! grid looks at twice as many as a brick of 4 × 2 × 2.

use super::face::wide;
use crate::kernel::{CHUNK, Element};

/// How many points are sorted at a time.
pub(super) const BLOCK: usize = CHUNK;

/// Along an axis there are 2 to this many cells at most.
const DEEPEST: u32 = 3;

/// Points of the surface's frame.
pub(super) struct Block<E> {
    pub(super) columns: [[E; BLOCK]; 3],
    /// A number of each point: of a search one that has its sign, where that matters.
    pub(super) numbers: [E; BLOCK],
    /// Where the points stood before.
    order: [u16; BLOCK],
    /// The cells that they are in, and where the points of each begin.
    cells: [u16; BLOCK],
    starts: [u16; 1 << (3 * DEEPEST)],
    before: [E; BLOCK],
}

impl<E: Element> Block<E> {
    #[inline(always)]
    pub(super) fn new() -> Block<E> {
        Block {
            columns: [[E::default(); BLOCK]; 3],
            numbers: [E::default(); BLOCK],
            order: [0; BLOCK],
            cells: [0; BLOCK],
            starts: [0; 1 << (3 * DEEPEST)],
            before: [E::default(); BLOCK],
        }
    }

    /// Sorts the points, of which `len` are in use, and their numbers; packets are longest along an
    /// axis.
    #[inline(always)]
    pub(super) fn sort(&mut self, len: usize, along: usize) {
        let [x, y, z] = &mut self.columns;
        let (x, y, z) = (&mut x[..len], &mut y[..len], &mut z[..len]);
        let ((low_x, width_x), (low_y, width_y), (low_z, width_z)) = (span(x), span(y), span(z));
        let width = width_x.max(width_y).max(width_z);
        let per_cell = if width > 0.0 { ((1 << DEEPEST) as f32 * (1.0 - 1e-6)) / width } else { 0.0 };
        // As many cells as points, and up to eight times as many.
        let depth = (len.max(1).ilog2() / 3 + 1).min(DEEPEST);
        let coarser = 3 * (DEEPEST - depth);
        let shifts = [(3 - along) % 3, (4 - along) % 3, (5 - along) % 3];
        let (cells, starts, before) = (&mut self.cells, &mut self.starts, &mut self.before);
        for i in 0..len {
            let x = cell(x[i], low_x, per_cell);
            let y = cell(y[i], low_y, per_cell);
            let z = cell(z[i], low_z, per_cell);
            cells[i] = (x << shifts[0] | y << shifts[1] | z << shifts[2]) >> coarser;
        }
        let starts = &mut starts[..1 << (3 * depth)];
        starts.fill(0);
        for cell in &cells[..len] {
            starts[usize::from(*cell)] += 1;
        }
        let mut sum = 0;
        for start in starts.iter_mut() {
            sum += std::mem::replace(start, sum);
        }
        for (i, cell) in (0..).zip(&cells[..len]) {
            let to = &mut starts[usize::from(*cell)];
            self.order[usize::from(*to) % BLOCK] = i;
            *to += 1;
        }
        for column in [x, y, z, &mut self.numbers[..len]] {
            before[..len].copy_from_slice(column);
            for (to, from) in column.iter_mut().zip(&self.order) {
                *to = before[usize::from(*from) % BLOCK];
            }
        }
    }

    /// The box about the first `len` points.
    #[inline(always)]
    pub(super) fn bounds(&self, len: usize) -> ([f64; 3], [f64; 3]) {
        let [x, y, z] = &self.columns;
        let ((x, width_x), (y, width_y), (z, width_z)) = (span(&x[..len]), span(&y[..len]), span(&z[..len]));
        (wide([x, y, z]), wide([x + width_x, y + width_y, z + width_z]))
    }

    /// One of the points.
    #[inline(always)]
    pub(super) fn point(&self, at: usize) -> [E; 3] {
        let [x, y, z] = &self.columns;
        [x[at % BLOCK], y[at % BLOCK], z[at % BLOCK]]
    }

    /// What is found of the points, in the order of before.
    #[inline(always)]
    pub(super) fn unsorted<T: Copy>(&self, sorted: &[T; BLOCK], out: &mut [T]) {
        for (from, to) in sorted.iter().zip(&self.order[..out.len()]) {
            out[usize::from(*to)] = *from;
        }
    }
}

/// The least of some numbers, and how much larger the largest is.
#[inline(always)]
fn span<E: Element>(column: &[E]) -> (f32, f32) {
    const AT_ONCE: usize = 16;
    let (mut low, mut high) = ([f32::INFINITY; AT_ONCE], [f32::NEG_INFINITY; AT_ONCE]);
    // Each place of a vector by itself, as these are numbers.
    for some in column.chunks(AT_ONCE) {
        for ((v, low), high) in some.iter().zip(&mut low).zip(&mut high) {
            let v = v.to_f64() as f32;
            *low = if v < *low { v } else { *low };
            *high = if v > *high { v } else { *high };
        }
    }
    let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
    for (low, high) in low.iter().zip(&high) {
        least = if *low < least { *low } else { least };
        most = if *high > most { *high } else { most };
    }
    (least, most - least)
}

/// The bits of the cell that a coordinate is in, two bits apart.
#[inline(always)]
fn cell<E: Element>(v: E, low: f32, per_cell: f32) -> u16 {
    let cell = (((v.to_f64() as f32 - low) * per_cell) as u16).min((1 << DEEPEST) - 1);
    cell & 1 | (cell & 2) << 2 | (cell & 4) << 4
}
