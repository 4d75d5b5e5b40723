//! All blocks after the first pass, seen as one lattice of cells with vertices on their edges.

use std::ops::Range;

use glam::{Vec3, Vec3A};

use super::parts::Parts;
use crate::mesh::feature::Crease;
use crate::mesh::lattice::Lattice;
use crate::mesh::signs::BLOCK;
use crate::mesh::table::{EDGE_CORNERS, edge_axis};
use rvachev_num::Bounds;

/// What the first pass has found, by cell.
pub(super) struct Samples<'a> {
    pub(super) parts: &'a Parts<'a>,
    pub(super) lattice: &'a Lattice,
    /// Which normals are those of a crease.
    pub(super) crease: Crease,
    /// The box of the surface, as vertices have it.
    limits: [Vec3; 2],
    positions: &'a [Vec3],
    normals: &'a [Vec3],
    /// Whether a block, by its first cell, is to have the triangles of the case table.
    plain: &'a (dyn Fn([u32; 3]) -> bool + Sync),
}

/// The block of a cell, by its first cell, and where the cell is in it.
#[inline(always)]
pub(super) fn split_cell(cell: [u32; 3]) -> ([u32; 3], [usize; 3]) {
    let [x, y, z] = cell;
    let side = BLOCK as u32;
    let within = [x % side, y % side, z % side];
    ([x - within[0], y - within[1], z - within[2]], [within[0] as usize, within[1] as usize, within[2] as usize])
}

/// The number of a cell in its block: x fastest, then y, then z.
#[inline(always)]
pub(super) fn cell_number([i, j, k]: [usize; 3]) -> u16 {
    (i + BLOCK * (j + BLOCK * k)) as u16
}

/// The cell of a block, given by its first cell, that has a number.
pub(super) fn cell_of(block: [u32; 3], number: u16) -> [u32; 3] {
    let n = u32::from(number);
    let side = BLOCK as u32;
    [block[0] + n % side, block[1] + n / side % side, block[2] + n / (side * side)]
}

impl<'a> Samples<'a> {
    pub(super) fn new(
        parts: &'a Parts<'a>,
        lattice: &'a Lattice,
        (limits, crease): (Bounds, Crease),
        [positions, normals]: [&'a [Vec3]; 2],
        plain: &'a (dyn Fn([u32; 3]) -> bool + Sync),
    ) -> Samples<'a> {
        let limits = [limits.min.as_vec3(), limits.max.as_vec3()];
        Samples { parts, lattice, crease, limits, positions, normals, plain }
    }

    /// Whether a block, by its first cell, is to have the triangles of the case table, whatever is
    /// in it.
    pub(super) fn is_plain(&self, block: [u32; 3]) -> bool {
        (self.plain)(block)
    }

    pub(super) fn blocks(&self) -> &[[u32; 3]] {
        self.parts.blocks
    }

    /// The number of the block with a first cell, quickly if it is next to block `near`.
    #[inline]
    pub(super) fn find_near(&self, near: usize, block: [u32; 3]) -> Option<usize> {
        if self.blocks()[near] == block { Some(near) } else { self.find_beside(near, block) }
    }

    /// The same of another block.
    fn find_beside(&self, near: usize, block: [u32; 3]) -> Option<usize> {
        let first = self.blocks()[near];
        for axis in 0..3 {
            let (others, side) = ([(axis + 1) % 3, (axis + 2) % 3], BLOCK as u32);
            if others.iter().all(|&n| first[n] == block[n]) {
                if block[axis] == first[axis] + side {
                    return self.parts.neighbours.upper(near, 1 << axis);
                }
                if block[axis] + side == first[axis] {
                    return self.parts.neighbours.lower(near, axis);
                }
            }
        }
        self.parts.neighbours.find(block)
    }

    /// The case of a cell of the lattice, quickly if it is in block `near` or next to it; 0 where
    /// no block is.
    pub(super) fn case_near(&self, near: usize, cell: [u32; 3]) -> u8 {
        let (block, within) = split_cell(cell);
        self.find_near(near, block).map_or(0, |block| self.parts.part(block).signs.case(within))
    }

    /// The case of a cell of the lattice; 0 where no block is.
    pub(super) fn case(&self, cell: [u32; 3]) -> u8 {
        let (block, within) = split_cell(cell);
        self.parts.neighbours.find(block).map_or(0, |block| self.parts.part(block).signs.case(within))
    }

    /// The vertex on an edge, which is crossed, of a cell of the lattice; found quickly if it is in
    /// block `near` or next to it.
    pub(super) fn vertex(&self, near: usize, cell: [u32; 3], edge: u8) -> Option<u32> {
        let corner = EDGE_CORNERS[usize::from(edge)][0];
        let node = std::array::from_fn(|axis| cell[axis] + u32::from(corner >> axis & 1));
        let (block, [i, j, k]) = split_cell(node);
        let part = self.parts.part(self.find_near(near, block)?);
        let crossed = part.signs.crossed(j, k);
        let axis = usize::from(edge_axis(edge));
        let before: u32 = crossed[..axis].iter().map(|bits| bits.count_ones()).sum();
        let in_row = (crossed[axis] & ((1 << i) - 1)).count_ones();
        (crossed[axis] >> i & 1 == 1).then(|| part.first + part.rows.start(j, k) + before + in_row)
    }

    /// How many vertices there are.
    pub(super) fn vertices(&self) -> u32 {
        self.positions.len() as u32
    }

    /// Position and normal of a vertex.
    #[inline(always)]
    pub(super) fn get(&self, vertex: u32) -> (Vec3, Vec3) {
        (self.positions[vertex as usize], self.normals[vertex as usize])
    }

    #[inline(always)]
    pub(super) fn position(&self, vertex: u32) -> Vec3 {
        self.positions[vertex as usize]
    }

    #[inline(always)]
    pub(super) fn normal(&self, vertex: u32) -> Vec3 {
        self.normals[vertex as usize]
    }

    /// The vertices that block `n` owns.
    pub(super) fn own(&self, n: usize) -> Range<usize> {
        let first = |n: usize| match n < self.blocks().len() {
            true => self.parts.part(n).first as usize,
            false => self.normals.len(),
        };
        first(n)..first(n + 1)
    }

    /// Positions and normals of consecutive vertices.
    pub(super) fn of(&self, vertices: Range<usize>) -> (&[Vec3], &[Vec3]) {
        (&self.positions[vertices.clone()], &self.normals[vertices])
    }

    /// Places, in cells from a node of the lattice, and normals of the vertices that block `n`
    /// owns.
    pub(super) fn vertices_of(&self, n: usize, from: [u32; 3]) -> impl ExactSizeIterator<Item = (Vec3A, Vec3A)> {
        let low: Vec3A = self.node(from).into();
        let share = 1.0 / self.lattice.step() as f32;
        let (positions, normals) = self.of(self.own(n));
        let place = move |&position: &Vec3| share * (Vec3A::from(position) - low);
        positions.iter().map(place).zip(normals.iter().map(|&normal| normal.into()))
    }

    /// A node as vertices have it, rounded to f32.
    pub(super) fn node(&self, [i, j, k]: [u32; 3]) -> Vec3 {
        self.lattice.node(i, j, k).as_vec3()
    }

    /// The point of the box of the surface that is nearest.
    pub(super) fn limited(&self, p: Vec3) -> Vec3 {
        let [low, high] = self.limits;
        p.clamp(low, high)
    }

    /// The position of a point, strictly inside of the box of cells from `low` up to `high`,
    /// exclusive. It is given in cells from the first node of the box.
    #[inline]
    pub(super) fn inside(&self, at: Vec3A, low: [u32; 3], high: [u32; 3]) -> Vec3 {
        self.held(at, [self.node(low), self.node(high)])
    }

    /// The same, given the first and the last node.
    #[inline(always)]
    pub(super) fn held(&self, at: Vec3A, [low, high]: [Vec3; 2]) -> Vec3 {
        let at = self.limited(low + Vec3::from(self.lattice.step() as f32 * at));
        if at.cmpgt(low).all() && at.cmplt(high).all() {
            return at;
        }
        let low = Vec3::new(low.x.next_up(), low.y.next_up(), low.z.next_up());
        let high = Vec3::new(high.x.next_down(), high.y.next_down(), high.z.next_down());
        at.clamp(low, high)
    }
}
