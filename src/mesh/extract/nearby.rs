//! The vertices of one block's cells.

use glam::{Vec3, Vec3A};

use super::ExtractError;
use super::block_vertices::Corners;
use super::samples::Samples;
use crate::mesh::signs::SIDE;

/// The vertices on the edges of a block's cells, by their numbers, and where these cells are.
pub(super) struct Nearby {
    corners: Corners,
    /// The nodes on the diagonal: the coordinates of all.
    nodes: [Vec3; SIDE],
    /// What takes lengths to cells.
    share: f32,
}

impl Nearby {
    pub(super) fn new() -> Nearby {
        Nearby { corners: Corners::new(), nodes: [Vec3::ZERO; SIDE], share: 1.0 }
    }

    /// Becomes that of block `n`; an error if the owner of a vertex is not there.
    pub(super) fn load(&mut self, samples: &Samples<'_>, n: usize) -> Result<(), ExtractError> {
        let block = samples.blocks()[n];
        self.nodes = std::array::from_fn(|n| samples.node(block.map(|first| first + n as u32)));
        self.share = 1.0 / samples.lattice.step() as f32;
        samples.parts.number(n, |place, vertex| self.corners.note(place, vertex))
    }

    /// The position of a point, strictly inside of a cell. It is given in cells from the cell's
    /// first node.
    #[inline(always)]
    pub(super) fn inside(&self, samples: &Samples<'_>, cell: [usize; 3], at: Vec3A) -> Vec3 {
        let nodes = &self.nodes;
        let corner = |[x, y, z]: [usize; 3]| Vec3::new(nodes[x].x, nodes[y].y, nodes[z].z);
        samples.held(at, [corner(cell), corner(cell.map(|n| n + 1))])
    }

    /// The vertices on some edges of a cell.
    #[inline(always)]
    pub(super) fn around<const N: usize>(&self, cell: [usize; 3], edges: &[u8; N]) -> [u32; N] {
        self.corners.of_edges(cell, edges)
    }

    /// Those on all edges of a cell, and four numbers without meaning.
    #[inline(always)]
    pub(super) fn all_around(&self, cell: [usize; 3]) -> [u32; 16] {
        self.corners.of_cell(cell)
    }

    /// Where a vertex is, in cells from the block's first node.
    #[inline(always)]
    pub(super) fn place(&self, samples: &Samples<'_>, vertex: u32) -> Vec3A {
        self.share * Vec3A::from(samples.position(vertex) - self.nodes[0])
    }
}
