//! How far from closed a mesh is.

use rvachev_field as field;

use crate::geom::Mesh;
use crate::{Cancelled, Run};

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
        // A run that nobody else holds is not cancelled.
        self.open_edges_with(&Run::default()).unwrap_or_else(|Cancelled| OpenEdges::default())
    }

    /// [`open_edges`](Mesh::open_edges) with a cancel token and a progress sink; on one thread.
    ///
    /// ```
    /// use rvachev::{MeshSettings, Run, Solid};
    ///
    /// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
    /// let run = Run::default();
    /// assert!(mesh.open_edges_with(&run)?.is_closed());
    /// run.cancel.cancel();
    /// assert!(mesh.open_edges_with(&run).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Cancelled`] if the token was.
    pub fn open_edges_with(&self, run: &Run) -> Result<OpenEdges, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let found = field::OpenEdges::of(self.positions(), self.triangles(), &run)?;
        run.report(1.0);
        Ok(OpenEdges { edges: found.edges, length: found.length })
    }
}
