//! Whether a feature thinner than a cell may hide in cells of one sign.

use super::extract::CellBits;
use super::lattice::Lattice;
use super::signs::BLOCK;
use crate::Bounds;
use crate::eval::{Narrowed, Program};

/// Whether a feature may hide in some cells of a block, all of whose nodes have one sign: whether
/// one of them has a surface by its range, which may be left where it is entered. So many ranges
/// may be taken; it may if they do not suffice.
pub(super) fn may_hide(
    program: &Program,
    (lattice, block): (&Lattice, [u32; 3]),
    cells: &CellBits,
    mut ranges: usize,
) -> bool {
    /// What finding out whether a cell is entered once takes, in ranges, with those of its eight
    /// parts.
    const ONCE: usize = 16;
    let mut open = vec![([0; 3], BLOCK, program.clone())];
    while let Some((first, size, program)) = open.pop() {
        let half = size / 2;
        let mut shared = None;
        for n in 0..8 {
            let first: [usize; 3] = std::array::from_fn(|axis| first[axis] + (n >> axis & 1) * half);
            if !cells.has_any(first, half) {
                continue;
            }
            let region = lattice.about(std::array::from_fn(|axis| block[axis] + first[axis] as u32), half);
            if ranges == 0 {
                return true;
            }
            ranges -= 1;
            let simpler = match program.narrowed(&region) {
                Narrowed::Inside | Narrowed::Outside => continue,
                Narrowed::Same => shared.get_or_insert_with(|| program.clone()).clone(),
                Narrowed::Simpler(simpler) => simpler,
            };
            if simpler.is_seamless(&region) {
                continue;
            }
            if half > 1 {
                open.push((first, half, simpler));
                continue;
            }
            let is_open = |part: &Bounds| !matches!(simpler.narrowed(part), Narrowed::Inside | Narrowed::Outside);
            let parts = region.octants();
            if parts.iter().any(is_open) && !simpler.is_entered_once(&[region]) && !simpler.is_entered_once(&parts) {
                return true;
            }
            ranges = ranges.saturating_sub(ONCE);
        }
    }
    false
}
