//! The vertices on the edges of a block's cells.

use super::Part;
use crate::mesh::signs::{NODES, SIDE};

/// The vertices on the edges of a block's cells, by numbers.
pub(super) struct Corners {
    /// By axis, then by the lower node, x fastest; what lies on edges that are not crossed has
    /// no meaning.
    ids: Box<[u32; 3 * NODES]>,
}

impl Corners {
    pub(super) fn new() -> Corners {
        Corners { ids: Box::new([0; 3 * NODES]) }
    }

    /// Notes what is on an edge, given by its place.
    #[inline(always)]
    pub(super) fn note(&mut self, place: usize, vertex: u32) {
        self.ids[place] = vertex;
    }

    /// The vertices on the edges of a cell, and four numbers without meaning: an index of 4 bits
    /// is in range.
    #[inline(always)]
    pub(super) fn of_cell(&self, cell: [usize; 3]) -> [u32; 16] {
        // Along each axis, from the lower corners of the edges.
        const X: usize = 0;
        const Y: usize = NODES;
        const Z: usize = 2 * NODES;
        const J: usize = SIDE;
        const K: usize = SIDE * SIDE;
        let ids = &self.ids[Corners::place(0, cell)..][..Z + J + 2];
        let [x, y, z] = [
            [ids[X], ids[X + J], ids[X + K], ids[X + J + K]],
            [ids[Y], ids[Y + 1], ids[Y + K], ids[Y + 1 + K]],
            [ids[Z], ids[Z + 1], ids[Z + J], ids[Z + 1 + J]],
        ];
        [x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3], z[0], z[1], z[2], z[3], 0, 0, 0, 0]
    }

    /// The vertices on some edges of a cell.
    #[inline(always)]
    pub(super) fn of_edges<const N: usize>(&self, cell: [usize; 3], edges: &[u8; N]) -> [u32; N] {
        /// How far the vertices on a cell's edges are from that on its first.
        const PLACES: [u16; 16] = {
            const J: usize = SIDE;
            const K: usize = SIDE * SIDE;
            let from = [0, J, K, J + K, 0, 1, K, 1 + K, 0, 1, J, 1 + J];
            let mut places = [0; 16];
            let mut edge = 0;
            while edge < from.len() {
                places[edge] = (edge / 4 * NODES + from[edge]) as u16;
                edge += 1;
            }
            places
        };
        let ids = &self.ids[Corners::place(0, cell)..];
        let mut found = [0; N];
        for (found, edge) in found.iter_mut().zip(edges) {
            *found = ids[usize::from(PLACES[usize::from(edge & 15)])];
        }
        found
    }

    #[inline(always)]
    pub(super) fn place(axis: usize, [i, j, k]: [usize; 3]) -> usize {
        i + SIDE * (j + SIDE * (k + SIDE * axis))
    }
}

/// Tells the vertices of a row `from` of `part`, those along some axes, and their places in row
/// `to`.
pub(super) fn note_row(
    part: &Part,
    axes: [bool; 3],
    from: [usize; 2],
    to: [usize; 2],
    note: &mut impl FnMut(usize, u32),
) {
    let crossed = part.signs.crossed(from[0], from[1]);
    if crossed == [0; 3] {
        return;
    }
    let mut vertex = part.first + part.rows.start(from[0], from[1]);
    for (axis, mut bits) in crossed.into_iter().enumerate() {
        if !axes[axis] {
            vertex += bits.count_ones();
            continue;
        }
        let start = Corners::place(axis, [0, to[0], to[1]]);
        while bits != 0 {
            note(start + bits.trailing_zeros() as usize, vertex);
            vertex += 1;
            bits &= bits - 1;
        }
    }
}
