//! The signs of the nodes of a block of cells, as bits, and what follows from them: the edges
//! and the cells that the surface crosses, found a row at a time.
//!
//! ```text
//!     8 o---o---o- ... -o     a block: 8³ cells, 9³ nodes
//!       |   |   |       |
//!       :   :   :       :     * node whose upward edges the block owns: below 8 along every
//!     1 *---*---* ... --o       axis
//!       |   |   |       |     o node of an upper neighbour
//!     0 *---*---* ... --o
//!       0   1   2       8
//! ```

/// Cells along the side of a block.
pub(crate) const BLOCK: usize = 8;
/// Nodes along the side of a block.
pub(super) const SIDE: usize = BLOCK + 1;
/// Nodes of a block.
pub(crate) const NODES: usize = SIDE * SIDE * SIDE;
/// Edges that a block owns.
pub(super) const OWNED: usize = 3 * BLOCK * BLOCK * BLOCK;

/// An edge of the lattice within a block: from a node upwards along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct EdgeRef {
    /// The lower end, as a node within the block: 0 to 7 along every axis.
    pub node: [u8; 3],
    /// The axis, 0 to 2.
    pub axis: u8,
    /// Whether the lower end is the inside one.
    pub leaves: bool,
}

/// The signs of the nodes of a block: bit i of row `SIDE · k + j` is set if node (i, j, k) is
/// inside.
pub(super) struct Signs([u16; SIDE * SIDE]);

impl Signs {
    pub(super) fn new(values: &[f32; NODES]) -> Signs {
        let (rows, _) = values.as_chunks::<SIDE>();
        let mut signs = Signs([0; SIDE * SIDE]);
        for (bits, row) in signs.0.iter_mut().zip(rows) {
            for (i, &value) in row.iter().enumerate() {
                *bits |= u16::from(value > 0.0) << i;
            }
        }
        signs
    }

    fn row(&self, j: usize, k: usize) -> u16 {
        self.0[SIDE * k + j]
    }

    /// The case of a cell.
    pub(super) fn case(&self, [i, j, k]: [usize; 3]) -> u8 {
        let rows = [self.row(j, k), self.row(j + 1, k), self.row(j, k + 1), self.row(j + 1, k + 1)];
        rows.iter().enumerate().fold(0, |case, (n, row)| case | (row >> i & 3) << (2 * n)) as u8
    }

    /// The signs in the lower or upper face of an axis, nine rows of nine.
    pub(super) fn face(&self, axis: usize, upper: bool) -> [u16; SIDE] {
        let at = if upper { BLOCK } else { 0 };
        std::array::from_fn(|n| match axis {
            0 => (0..SIDE).fold(0, |bits, j| bits | (self.row(j, n) >> at & 1) << j),
            1 => self.row(at, n),
            _ => self.row(n, at),
        })
    }
}

/// Whether a face has nodes of both signs.
pub(super) fn is_mixed(face: &[u16; SIDE]) -> bool {
    const ALL: u16 = (1 << SIDE) - 1;
    !(face.iter().all(|&row| row == 0) || face.iter().all(|&row| row == ALL))
}

/// Positions within a row, as bits, that hold an owned node.
const OWNED_BITS: u16 = (1 << BLOCK) - 1;

/// The number of an owned edge within its block.
pub(super) fn edge_number(node: [usize; 3], axis: usize) -> u16 {
    let [i, j, k] = node;
    (3 * (BLOCK * (BLOCK * k + j) + i) + axis) as u16
}

/// The owned edges that cross the surface, in the order of their numbers.
pub(super) fn list_edges(signs: &Signs, edges: &mut Vec<EdgeRef>, numbers: &mut Vec<u16>) {
    edges.clear();
    numbers.clear();
    for k in 0..BLOCK {
        for j in 0..BLOCK {
            let row = signs.row(j, k);
            let crossed = [row ^ row >> 1, row ^ signs.row(j + 1, k), row ^ signs.row(j, k + 1)];
            let mut any = (crossed[0] | crossed[1] | crossed[2]) & OWNED_BITS;
            while any != 0 {
                let i = any.trailing_zeros() as usize;
                any &= any - 1;
                for (axis, crossed) in crossed.into_iter().enumerate() {
                    if crossed >> i & 1 == 1 {
                        edges.push(EdgeRef {
                            node: [i as u8, j as u8, k as u8],
                            axis: axis as u8,
                            leaves: row >> i & 1 == 1,
                        });
                        numbers.push(edge_number([i, j, k], axis));
                    }
                }
            }
        }
    }
}

/// Calls `visit` for every cell that the surface crosses, with its coordinates in the block
/// and its case.
pub(super) fn for_each_cell(signs: &Signs, mut visit: impl FnMut([usize; 3], u8)) {
    for k in 0..BLOCK {
        for j in 0..BLOCK {
            let rows = [signs.row(j, k), signs.row(j + 1, k), signs.row(j, k + 1), signs.row(j + 1, k + 1)];
            let any = rows.iter().fold(0, |bits, row| bits | row);
            let all = rows.iter().fold(u16::MAX, |bits, row| bits & row);
            // A cell is crossed if one of its nodes is inside and not all are.
            let mut crossed = (any | any >> 1) & !(all & all >> 1) & OWNED_BITS;
            while crossed != 0 {
                let i = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                let case = rows.iter().enumerate().fold(0, |case, (n, row)| case | (row >> i & 3) << (2 * n));
                visit([i, j, k], case as u8);
            }
        }
    }
}
