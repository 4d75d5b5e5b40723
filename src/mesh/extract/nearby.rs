//! The vertices of one block's cells, close together in memory.

use glam::{Vec3, Vec3A};

use super::ExtractError;
use super::join::Corners;
use super::samples::Samples;
use crate::mesh::signs::SIDE;

/// The vertices on the edges of a block's cells. Each is used by several cells: they are fetched once.
pub(super) struct Nearby {
    /// By edge, the place of its vertex in the lists.
    corners: Corners,
    vertices: Vec<u32>,
    normals: Vec<Vec3A>,
    /// In cells, from the block's first node.
    positions: Vec<Vec3A>,
    /// By axis, the coordinates of the nodes.
    nodes: [[f32; SIDE]; 3],
}

impl Nearby {
    pub(super) fn new() -> Nearby {
        let (vertices, normals, positions) = (Vec::new(), Vec::new(), Vec::new());
        Nearby { corners: Corners::new(), vertices, normals, positions, nodes: [[0.0; SIDE]; 3] }
    }

    /// Becomes that of block `n`; an error if the owner of a vertex is not there.
    pub(super) fn load(&mut self, samples: &Samples<'_>, n: usize) -> Result<(), ExtractError> {
        let Nearby { corners, vertices, normals, positions, nodes } = self;
        for along in 0..SIDE {
            let node = samples.node(samples.blocks()[n].map(|first| first + along as u32));
            (nodes[0][along], nodes[1][along], nodes[2][along]) = node.into();
        }
        vertices.clear();
        samples.parts.number(n, |place, vertex| {
            corners.note(place, vertices.len() as u32);
            vertices.push(vertex);
        })?;
        // The block's own come first, in their order.
        let own = samples.own(n);
        let others = &vertices[own.len().min(vertices.len())..];
        let (low, share) = (samples.node(samples.blocks()[n]), 1.0 / samples.lattice.step() as f32);
        let local = |position: Vec3| share * Vec3A::from(position - low);
        let (own_positions, own_normals) = samples.of(own);
        normals.clear();
        normals.extend(own_normals.iter().map(|&normal| Vec3A::from(normal)));
        normals.extend(others.iter().map(|&vertex| Vec3A::from(samples.normal(vertex))));
        positions.clear();
        positions.extend(own_positions.iter().map(|&position| local(position)));
        positions.extend(others.iter().map(|&vertex| local(samples.position(vertex))));
        Ok(())
    }

    /// The position of a point, strictly inside of a cell. It is given in cells from the cell's first node.
    #[inline(always)]
    pub(super) fn inside(&self, samples: &Samples<'_>, cell: [usize; 3], at: Vec3A) -> Vec3 {
        let corner = |upper: usize| Vec3::from_array(std::array::from_fn(|axis| self.nodes[axis][cell[axis] + upper]));
        samples.held(at, [corner(0), corner(1)])
    }

    /// The places in the lists of the vertices on some edges of a cell.
    #[inline(always)]
    pub(super) fn places<const N: usize>(&self, cell: [usize; 3], edges: &[u8; N]) -> [u32; N] {
        self.corners.of_edges(cell, edges)
    }

    /// The same of all edges of a cell, and four numbers without meaning.
    #[inline(always)]
    pub(super) fn all_places(&self, cell: [usize; 3]) -> [u32; 16] {
        self.corners.of_cell(cell)
    }

    /// The number of the vertex at a place.
    #[inline(always)]
    pub(super) fn vertex(&self, place: u32) -> u32 {
        self.vertices[place as usize]
    }

    #[inline(always)]
    pub(super) fn normal(&self, place: u32) -> Vec3A {
        self.normals[place as usize]
    }

    #[inline(always)]
    pub(super) fn position(&self, place: u32) -> Vec3A {
        self.positions[place as usize]
    }
}
