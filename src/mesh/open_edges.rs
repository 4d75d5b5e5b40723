//! How far from closed a mesh is.

use rvachev_field as field;

use crate::geom::Mesh;

/// How far from closed a mesh is: [`Mesh::open_edges`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OpenEdges {
    /// Edges that have more triangles on one side than on the other; none of a closed mesh.
    pub edges: usize,
    /// How long these edges are together, in length units, each as often as triangles are missing.
    pub length: f64,
}

impl OpenEdges {
    /// Whether the triangles leave no opening, so that every winding number is whole.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.edges == 0
    }
}

impl Mesh {
    /// How far from closed the mesh is, as the solid of its triangles sees it: vertices at one
    /// position are one vertex, and triangles may overlap. See [`check`](Mesh::check) for what is
    /// wrong in detail.
    ///
    /// ```
    /// use glam::Vec3;
    /// use rvachev::Mesh;
    ///
    /// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
    /// let open_edges = mesh.open_edges();
    /// assert_eq!(open_edges.edges, 3);
    /// assert!((open_edges.length - (2.0 + 2.0_f64.sqrt())).abs() < 1e-6);
    /// # Ok::<(), rvachev::error::MeshError>(())
    /// ```
    #[must_use]
    pub fn open_edges(&self) -> OpenEdges {
        let field::OpenEdges { edges, length } = field::OpenEdges::of(self.positions(), self.triangles());
        OpenEdges { edges, length }
    }
}
