//! The vertices of one block's cells, close together in memory.

use glam::{Vec3, Vec3A};

use super::ExtractError;
use super::join::Corners;
use super::samples::Samples;
use crate::mesh::signs::SIDE;

/// A vertex on an edge.
pub(super) struct Vertex {
    /// In cells, from the block's first node.
    pub(super) position: Vec3A,
    pub(super) normal: Vec3A,
    pub(super) number: u32,
}

/// The vertices on the edges of a block's cells. Each is used by several cells: they are fetched once.
pub(super) struct Nearby {
    /// By edge, the place of its vertex in the list.
    corners: Corners,
    vertices: Vec<Vertex>,
    /// Memory for their numbers.
    numbers: Vec<u32>,
    /// The nodes on the diagonal: the coordinates of all.
    nodes: [Vec3; SIDE],
}

impl Nearby {
    pub(super) fn new() -> Nearby {
        let (corners, nodes) = (Corners::new(), [Vec3::ZERO; SIDE]);
        Nearby { corners, vertices: Vec::new(), numbers: Vec::new(), nodes }
    }

    /// Becomes that of block `n`; an error if the owner of a vertex is not there.
    pub(super) fn load(&mut self, samples: &Samples<'_>, n: usize) -> Result<(), ExtractError> {
        let Nearby { corners, vertices, numbers, nodes } = self;
        let block = samples.blocks()[n];
        *nodes = std::array::from_fn(|n| samples.node(block.map(|first| first + n as u32)));
        numbers.clear();
        samples.parts.number(n, |place, vertex| {
            corners.note(place, numbers.len() as u32);
            numbers.push(vertex);
        })?;
        // The block's own come first, in their order.
        let own = samples.own(n);
        let others = &numbers[own.len().min(numbers.len())..];
        let (low, share) = (nodes[0], 1.0 / samples.lattice.step() as f32);
        let vertex = |number: u32, position: Vec3, normal: Vec3| {
            let position = share * Vec3A::from(position - low);
            Vertex { position, normal: normal.into(), number }
        };
        let (positions, normals) = samples.of(own);
        vertices.clear();
        let own = numbers.iter().zip(positions).zip(normals);
        vertices.extend(own.map(|((&number, &position), &normal)| vertex(number, position, normal)));
        vertices.extend(others.iter().map(|&number| vertex(number, samples.position(number), samples.normal(number))));
        Ok(())
    }

    /// The position of a point, strictly inside of a cell. It is given in cells from the cell's first node.
    #[inline(always)]
    pub(super) fn inside(&self, samples: &Samples<'_>, cell: [usize; 3], at: Vec3A) -> Vec3 {
        let nodes = &self.nodes;
        let corner = |[x, y, z]: [usize; 3]| Vec3::new(nodes[x].x, nodes[y].y, nodes[z].z);
        samples.held(at, [corner(cell), corner(cell.map(|n| n + 1))])
    }

    /// The vertices on some edges of a cell.
    #[inline(always)]
    pub(super) fn around<const N: usize>(&self, cell: [usize; 3], edges: &[u8; N]) -> [&Vertex; N] {
        self.corners.of_edges(cell, edges).map(|place| self.vertex(place))
    }

    /// The places of those on all edges of a cell, and four numbers without meaning.
    #[inline(always)]
    pub(super) fn all_places(&self, cell: [usize; 3]) -> [u32; 16] {
        self.corners.of_cell(cell)
    }

    /// The vertex at a place.
    #[inline(always)]
    pub(super) fn vertex(&self, place: u32) -> &Vertex {
        &self.vertices[place as usize]
    }
}
