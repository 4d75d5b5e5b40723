//! Ambiguous faces whose inside corners are joined.
//!
//! The case table separates them, in every ambiguous face. Where a convex crease passes such a face
//! that is wrong, and it tears the surface of a cell into two loops. The middle of the face tells:
//! if it is inside, so is, for a convex solid, the diagonal between the two inside corners.
//!
//! A cell copes with joined faces if it has a single loop then, so that it can have a fan; or if
//! all its ambiguous faces are joined, as the table of the complement is the table with inside and
//! outside exchanged: that of the opposite case has the patches. Cells that cope in neither way
//! give up all of their joined faces, until no more do.

use glam::DVec3;

use super::Sampler;
use super::samples::{Samples, cell_number, cell_of, split_cell};
use crate::mesh::lattice::Lattice;
use crate::mesh::loops::{CellLoop, ambiguous_faces};
use crate::mesh::signs::{Signs, for_each_cell};

/// Which faces are joined.
#[derive(Default)]
pub(super) struct Joined {
    /// By block: cells by number, ascending, with a bit for each axis whose upper face is joined.
    upper: Vec<Vec<(u16, u8)>>,
}

/// The upper faces of a cell, as bits.
pub(super) const UPPER: u8 = 0b10_1010;

/// The upper ambiguous faces of a block's cells that would rather be joined. The block is given by
/// its number and its first cell.
pub(super) fn proposals<S: Sampler>(
    sampler: &S,
    scratch: &mut S::Scratch,
    lattice: &Lattice,
    (number, block): (usize, [u32; 3]),
    signs: &Signs,
) -> Vec<(u16, u8)> {
    let all = ambiguous_faces();
    let (mut faces, mut middles, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for_each_cell(signs, |[i, j, k], case| {
        let ambiguous = all[usize::from(case)] & UPPER;
        if ambiguous == 0 {
            return;
        }
        let node = lattice.node(block[0] + i as u32, block[1] + j as u32, block[2] + k as u32);
        for axis in (0..3).filter(|axis| ambiguous >> (2 * axis + 1) & 1 == 1) {
            let mut middle = DVec3::splat(0.5);
            middle[axis] = 1.0;
            faces.push((cell_number([i, j, k]), 1 << axis));
            middles.push(node + lattice.step() * middle);
        }
    });
    if middles.is_empty() || !sampler.insides(scratch, number, block, &middles, &mut found) {
        return Vec::new();
    }
    let mut upper: Vec<(u16, u8)> = Vec::new();
    for ((cell, face), is_inside) in faces.into_iter().zip(found) {
        if is_inside {
            match upper.last_mut().filter(|last| last.0 == cell) {
                Some(last) => last.1 |= face,
                None => upper.push((cell, face)),
            }
        }
    }
    upper
}

impl Joined {
    /// The faces that are joined of those that would rather be.
    pub(super) fn new(samples: &Samples<'_>, upper: Vec<Vec<(u16, u8)>>) -> Joined {
        let mut joined = Joined { upper };
        let mut cells: Vec<[u32; 3]> = Vec::new();
        for (n, list) in joined.upper.iter().enumerate() {
            for &(number, faces) in list {
                let cell = cell_of(samples.blocks()[n], number);
                cells.push(cell);
                for axis in (0..3).filter(|axis| faces >> axis & 1 == 1) {
                    cells.push(stepped(cell, axis));
                }
            }
        }
        while let Some(cell) = cells.pop() {
            let case = samples.case(cell);
            let faces = joined.of(samples, cell, case);
            if faces == 0 || faces == ambiguous_faces()[usize::from(case)] || CellLoop::single(case, faces).is_some() {
                continue;
            }
            for face in (0..6).filter(|face| faces >> face & 1 == 1) {
                let (axis, upper) = (face / 2, face % 2 == 1);
                let mut below = cell;
                if upper {
                    cells.push(stepped(cell, axis));
                } else {
                    below[axis] -= 1;
                    cells.push(below);
                }
                joined.separate(samples, below, axis);
            }
        }
        joined
    }

    /// Whether a block, or one below it, has joined faces; a plain one has none.
    pub(super) fn concerns(&self, samples: &Samples<'_>, n: usize) -> bool {
        let has = |block: usize| !self.upper[block].is_empty();
        let is_below = |axis| samples.parts.neighbours.lower(n, axis).is_some_and(has);
        !samples.is_plain(samples.blocks()[n]) && (has(n) || (0..3).any(is_below))
    }

    /// The joined faces of a cell of the given case, as bits.
    #[inline]
    pub(super) fn of(&self, samples: &Samples<'_>, cell: [u32; 3], case: u8) -> u8 {
        let mut ambiguous = ambiguous_faces()[usize::from(case)];
        let mut bits = 0;
        while ambiguous != 0 {
            let face = ambiguous.trailing_zeros() as usize;
            ambiguous &= ambiguous - 1;
            let mut below = cell;
            below[face / 2] = below[face / 2].wrapping_sub(1 - face as u32 % 2);
            let is_joined =
                self.find(samples, below).is_some_and(|(block, n)| self.upper[block][n].1 >> (face / 2) & 1 == 1);
            bits |= u8::from(is_joined) << face;
        }
        bits
    }

    fn find(&self, samples: &Samples<'_>, cell: [u32; 3]) -> Option<(usize, usize)> {
        let (block, within) = split_cell(cell);
        let block = samples.parts.neighbours.find(block)?;
        let number = cell_number(within);
        Some((block, self.upper[block].binary_search_by_key(&number, |&(cell, _)| cell).ok()?))
    }

    fn separate(&mut self, samples: &Samples<'_>, below: [u32; 3], axis: usize) {
        if let Some((block, n)) = self.find(samples, below) {
            self.upper[block][n].1 &= !(1 << axis);
        }
    }
}

fn stepped(mut cell: [u32; 3], axis: usize) -> [u32; 3] {
    cell[axis] += 1;
    cell
}
