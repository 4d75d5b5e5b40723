//! Meshes as solids.

use std::sync::Arc;

use rvachev_field::{AnyField, MeshLeaf};

use super::{Node, Solid};
use crate::{Cancelled, Mesh, Run};

/// How a mesh becomes a solid: [`Solid::from_mesh`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct MeshSolid {
    /// Whether the solid has the colours of the mesh, where that has some: those at the nearest
    /// point of its triangles, in meshes and pictures, unless it is [painted](Solid::paint).
    /// Default: yes.
    pub colors: bool,
    /// Whether the solid is told apart by the owners of the mesh, where that has some: the
    /// [owner](Solid::owner) of a point is then that of the nearest triangle, as `mesh[7]` for the
    /// one with number 7. Default: yes.
    pub owners: bool,
}

impl Default for MeshSolid {
    fn default() -> MeshSolid {
        MeshSolid { colors: true, owners: true }
    }
}

impl Solid {
    /// The solid that a mesh encloses, as a leaf: joined, moved, deformed, offset, shelled, meshed
    /// and pictured like any other.
    ///
    /// The value is the distance to the nearest triangle, positive where the generalised winding
    /// number is above one half. So a mesh need not be clean:
    ///
    /// * Triangles may overlap, or be there twice; what they enclose counts as united. Those inside
    ///   are no surface, though the distance is measured from them too, and so offsets inwards and
    ///   shells follow them.
    /// * Where it is open, the surface goes on across the opening, roughly like a film on it, and
    ///   the value is a bound of the distance there. [`Mesh::open_edges`] says how open a mesh is.
    /// * A mesh that is inside out encloses nothing: no winding number is above one half. Using its
    ///   solid is an error that says so; [`Mesh::flipped`] turns it.
    ///
    /// Solids from meshes with the same triangles in the same order, and the same colours and
    /// owners, are equal.
    ///
    /// ```
    /// use rvachev::{MeshSettings, MeshSolid, Solid};
    ///
    /// let mesh = Solid::cuboid([4.0, 2.0, 2.0]).mesh(&MeshSettings::default())?;
    /// let block = Solid::from_mesh(&mesh, MeshSolid::default());
    /// assert!((block.value([0.0, 0.0, 0.5])? - 0.5).abs() < 1e-3);
    /// let tube = block - Solid::cylinder(0.5, 3.0);
    /// assert!(!tube.contains([0.0, 0.0, 0.5])? && tube.contains([1.5, 0.0, 0.5])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Details
    ///
    /// Distances are found in a hierarchy of boxes, winding numbers by Barill et al., *Fast Winding
    /// Numbers for Soups and Clouds* (2018). Positions are kept in single precision relative to the
    /// mesh's middle; those of a [`Mesh`] are in single precision from the origin, some seven
    /// digits, so that at coordinates of 4·10⁶ they are rounded to a quarter: parts far from the
    /// origin keep their shape if they are moved there before they are written. A mesh takes some
    /// 130 bytes a triangle, 9 more with colours and 4 with owners, and about a second a million
    /// triangles to be made. Openings cost: values near them are found point by point.
    ///
    /// # Errors
    ///
    /// None here. Using the solid of a mesh without triangles, of one that is inside out, or of one
    /// with coordinates beyond ±10¹² is a [`SolidError`](crate::SolidError).
    #[must_use]
    pub fn from_mesh(mesh: &Mesh, settings: MeshSolid) -> Solid {
        match Solid::from_mesh_with(mesh, settings, &Run::default()) {
            Ok(solid) => solid,
            Err(Cancelled) => unreachable!("nobody has the token"),
        }
    }

    /// [`from_mesh`](Solid::from_mesh) with progress, and a token to cancel by.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn from_mesh_with(mesh: &Mesh, settings: MeshSolid, run: &Run) -> Result<Solid, Cancelled> {
        let colors = mesh.corner_colors().filter(|_| settings.colors);
        let opaque = |corners: &[[u8; 4]; 3]| corners.map(|[r, g, b, _]| [r, g, b]);
        let colors = colors.map(|colors| colors.iter().map(opaque).collect());
        let owners = mesh.owners().filter(|_| settings.owners);
        let run = run.stage(0.0, 1.0);
        let leaf = MeshLeaf::new(mesh.positions(), mesh.triangles(), colors, owners, &run)?;
        let leaf: Arc<dyn AnyField> = Arc::new(leaf);
        Ok(Solid::from_node(Node::Leaf(leaf)))
    }
}
