//! Blocks that are looked at again, for features thinner than a cell.

use crate::mesh::signs::{BLOCK, NODES, SIDE};

/// The farthest that the tip of what is seen goes into a block without a crossing, in cells.
pub(super) const TIP: usize = 3;

/// Cells of a block, a bit each: bit `i` of row `8 k + j`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CellRows([u8; BLOCK * BLOCK]);

impl CellRows {
    /// Whether any of a cube of cells is among them.
    pub(in crate::mesh) fn has_any(&self, [i, j, k]: [usize; 3], size: usize) -> bool {
        let bits = ((1u16 << size) - 1) << i;
        (k..k + size).any(|k| (j..j + size).any(|j| u16::from(self.0[BLOCK * k + j]) & bits != 0))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.iter().all(|&row| row == 0)
    }

    /// Those with a node whose value is at most `least`, either way; `None` if there are none.
    pub(super) fn near(values: &[f32; NODES], least: f32) -> Option<CellRows> {
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
        let mut cells = CellRows([0; BLOCK * BLOCK]);
        for (n, row) in cells.0.iter_mut().enumerate() {
            let at = SIDE * (n / BLOCK) + n % BLOCK;
            let any = nodes[at] | nodes[at + 1] | nodes[at + SIDE] | nodes[at + SIDE + 1];
            *row = (any | any >> 1) as u8;
        }
        Some(cells)
    }

    /// Takes away those that are close to the neighbour in a direction, -1, 0 or 1 along each axis.
    pub(super) fn clear_near(&mut self, step: [i32; 3]) {
        let is_close = |axis: usize, at: usize| match step[axis] {
            -1 => at < TIP,
            1 => at >= BLOCK - TIP,
            _ => true,
        };
        let bits = (0..BLOCK).filter(|&i| is_close(0, i)).fold(0u8, |bits, i| bits | 1 << i);
        for (n, row) in self.0.iter_mut().enumerate() {
            if is_close(1, n % BLOCK) && is_close(2, n / BLOCK) {
                *row &= !bits;
            }
        }
    }
}

/// Why a block is looked at again.
#[derive(Clone, Debug)]
pub(super) enum Suspicion {
    /// It has no crossing; these cells may have a surface by their samples.
    Hidden(Box<CellRows>),
    /// So many nodes are between opposite sides, of a gap and of a wall.
    Torn([u32; 2]),
    Bored,
}

/// A block that is looked at again.
#[derive(Clone, Debug)]
pub(super) struct Suspect {
    pub(super) number: usize,
    pub(super) why: Suspicion,
}
