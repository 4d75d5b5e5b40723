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

/// An edge of the lattice that the surface crosses: from a node upwards along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeRef {
    /// The lower end, as a node of the lattice.
    pub node: [u32; 3],
    /// The number of the block that owns it.
    pub block: u32,
    /// The axis, 0 to 2.
    pub axis: u8,
    /// Whether the lower end is the inside one.
    pub leaves: bool,
    /// The values at the lower and the upper end.
    pub values: [f32; 2],
}

/// The signs of the nodes of a block: bit i of row `SIDE · k + j` is set if node (i, j, k) is
/// inside.
pub(super) struct Signs([u16; SIDE * SIDE]);

/// Eight bytes of 0 or 1 as the bits of one, the first lowest.
///
/// A product does it: its term 2^(56 − 7 i) moves byte i to bit 56 + i, and no two terms meet.
#[inline(always)]
pub(super) fn gathered(bytes: [u8; 8]) -> u8 {
    const GATHER: u64 = 0x0102_0408_1020_4080;
    (u64::from_le_bytes(bytes).wrapping_mul(GATHER) >> 56) as u8
}

impl Signs {
    pub(super) fn new(values: &[f32; NODES]) -> Signs {
        let (rows, _) = values.as_chunks::<SIDE>();
        let mut signs = Signs([0; SIDE * SIDE]);
        for (bits, row) in signs.0.iter_mut().zip(rows) {
            for (n, &value) in row.iter().enumerate() {
                *bits |= u16::from(value > 0.0) << n;
            }
        }
        signs
    }

    /// The signs of a row of nodes.
    #[inline(always)]
    pub(super) fn row(&self, j: usize, k: usize) -> u16 {
        self.0[SIDE * k + j]
    }

    /// The case of a cell.
    #[inline]
    pub(super) fn case(&self, [i, j, k]: [usize; 3]) -> u8 {
        case(self.rows(j, k), i)
    }

    /// The rows of nodes around a row of cells.
    #[inline(always)]
    fn rows(&self, j: usize, k: usize) -> [u16; 4] {
        [self.row(j, k), self.row(j + 1, k), self.row(j, k + 1), self.row(j + 1, k + 1)]
    }

    /// The cells of a row that the surface crosses, as bits.
    #[inline(always)]
    pub(super) fn crossed_cells(&self, j: usize, k: usize) -> u16 {
        crossed_cells(self.rows(j, k))
    }

    /// Whether nodes of both signs are among them.
    pub(super) fn is_mixed(&self) -> bool {
        const ALL: u16 = (1 << SIDE) - 1;
        let (any, all) = self.0.iter().fold((0, ALL), |(any, all), &row| (any | row, all & row));
        any != 0 && all != ALL
    }

    /// How many nodes whose upward edges the block owns are outside and inside.
    pub(super) fn counts(&self) -> [u32; 2] {
        let rows = (0..BLOCK).flat_map(|k| (0..BLOCK).map(move |j| self.row(j, k) & OWNED_BITS));
        let inside = rows.map(u16::count_ones).sum();
        [(BLOCK * BLOCK * BLOCK) as u32 - inside, inside]
    }

    /// The nodes of a row that differ in sign from both their neighbours along x, y and z, as bits:
    /// of those whose two edges there the block owns.
    #[inline(always)]
    pub(super) fn single(&self, j: usize, k: usize) -> [u16; 3] {
        let row = self.row(j, k);
        let x = (row ^ row << 1) & (row ^ row >> 1) & (OWNED_BITS - 1);
        let along =
            |below: Option<u16>, above: u16| below.map_or(0, |below| (row ^ below) & (row ^ above) & OWNED_BITS);
        let y = along((j > 0).then(|| self.row(j - 1, k)), self.row(j + 1, k));
        let z = along((k > 0).then(|| self.row(j, k - 1)), self.row(j, k + 1));
        [x, y, z]
    }

    /// The signs in the lower or upper face of an axis, nine rows of nine.
    pub(super) fn face(&self, axis: usize, upper: bool) -> [u16; SIDE] {
        let at = if upper { BLOCK } else { 0 };
        let mut face = [0; SIDE];
        for (n, bits) in face.iter_mut().enumerate() {
            match axis {
                0 => {
                    for j in 0..SIDE {
                        *bits |= (self.row(j, n) >> at & 1) << j;
                    }
                }
                1 => *bits = self.row(at, n),
                _ => *bits = self.row(n, at),
            }
        }
        face
    }
}

/// The case of cell `i` of a row of cells, given the rows of nodes around it.
#[inline(always)]
fn case([a, b, c, d]: [u16; 4], i: usize) -> u8 {
    (a >> i & 3 | (b >> i & 3) << 2 | (c >> i & 3) << 4 | (d >> i & 3) << 6) as u8
}

/// The cells that are crossed, given the rows of nodes around theirs: one of their nodes is inside
/// and not all are.
#[inline(always)]
fn crossed_cells([a, b, c, d]: [u16; 4]) -> u16 {
    let (any, all) = (a | b | c | d, a & b & c & d);
    (any | any >> 1) & !(all & all >> 1) & OWNED_BITS
}

/// Whether a face has nodes of both signs.
pub(super) fn is_mixed(face: &[u16; SIDE]) -> bool {
    const ALL: u16 = (1 << SIDE) - 1;
    !(face.iter().all(|&row| row == 0) || face.iter().all(|&row| row == ALL))
}

/// Positions within a row, as bits, that hold an owned node.
const OWNED_BITS: u16 = (1 << BLOCK) - 1;

/// How many vertices of a block come before those of each row of owned edges, `BLOCK · k + j`.
///
/// Owned edges are numbered row by row; within a row those along x come first, then those
/// along y, then those along z. The number of an edge is then its row's start and the bits
/// before it.
pub(super) struct Rows([u16; BLOCK * BLOCK]);

impl Rows {
    /// Where a row starts.
    #[inline(always)]
    pub(super) fn start(&self, j: usize, k: usize) -> u32 {
        u32::from(self.0[BLOCK * k + j])
    }
}

impl Signs {
    /// The owned edges of a row that cross the surface, as bits, along x, y and z.
    #[inline(always)]
    pub(super) fn crossed(&self, j: usize, k: usize) -> [u16; 3] {
        let row = self.row(j, k);
        let along = |other: u16| (row ^ other) & OWNED_BITS;
        [along(row >> 1), along(self.row(j + 1, k)), along(self.row(j, k + 1))]
    }

    /// Whether an edge along one of the given axes, from one of the first nodes of a row,
    /// crosses the surface.
    pub(super) fn is_crossed(&self, axes: [bool; 3], [j, k]: [usize; 2]) -> bool {
        let row = self.row(j, k);
        let differs = |other: u16| (row ^ other) & OWNED_BITS != 0;
        axes[0] && differs(row >> 1) || axes[1] && differs(self.row(j + 1, k)) || axes[2] && differs(self.row(j, k + 1))
    }
}

/// Adds the owned edges that cross the surface, in the order of their numbers. `number` and
/// `block` are those of the block in the list of blocks, and its first cell.
pub(super) fn list_edges(
    signs: &Signs,
    values: &[f32; NODES],
    number: u32,
    block: [u32; 3],
    edges: &mut Vec<EdgeRef>,
) -> Rows {
    const STRIDES: [usize; 3] = [1, SIDE, SIDE * SIDE];
    let before = edges.len();
    let mut rows = Rows([0; BLOCK * BLOCK]);
    for k in 0..BLOCK {
        for j in 0..BLOCK {
            rows.0[BLOCK * k + j] = (edges.len() - before) as u16;
            let all = signs.crossed(j, k);
            if all[0] | all[1] | all[2] == 0 {
                continue;
            }
            let row = signs.row(j, k);
            for axis in 0..3 {
                let mut crossed = all[axis];
                while crossed != 0 {
                    let i = crossed.trailing_zeros() as usize;
                    crossed &= crossed - 1;
                    let at = i + SIDE * (j + SIDE * k);
                    edges.push(EdgeRef {
                        node: [block[0] + i as u32, block[1] + j as u32, block[2] + k as u32],
                        block: number,
                        axis: axis as u8,
                        leaves: row >> i & 1 == 1,
                        values: [values[at], values[at + STRIDES[axis]]],
                    });
                }
            }
        }
    }
    rows
}

/// Calls `visit` for every cell that the surface crosses, with its coordinates in the block
/// and its case.
#[inline]
pub(super) fn for_each_cell(signs: &Signs, mut visit: impl FnMut([usize; 3], u8)) {
    for k in 0..BLOCK {
        for j in 0..BLOCK {
            let rows = signs.rows(j, k);
            let mut crossed = crossed_cells(rows);
            while crossed != 0 {
                let i = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                visit([i, j, k], case(rows, i));
            }
        }
    }
}
