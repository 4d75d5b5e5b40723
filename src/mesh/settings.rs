//! What to mesh, and how finely.

use super::lattice::CellSize;
use crate::Bounds;

/// What to mesh.
///
/// ```
/// use rvachev::{CellSize, MeshSettings, Solid};
///
/// let settings = MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() };
/// let mesh = Solid::sphere(1.0).mesh(&settings)?;
/// assert!(mesh.check().is_closed());
/// # Ok::<(), rvachev::error::MeshingError>(())
/// ```
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct MeshSettings {
    /// The resolution. Default: 128 cells along the longest side of the bounds.
    pub cell: CellSize,
    /// The box to mesh, in length units; where the solid leaves it, the mesh is that of
    /// their intersection. Default (`None`): the box of the solid.
    pub bounds: Option<Bounds>,
    /// What becomes of a solid that leaves the bounds. Default: [`AtBounds::Cap`].
    pub at_bounds: AtBounds,
    /// Whether creases and corners are kept. Default: [`Features::Sharp`].
    pub features: Features,
    /// What becomes of features that may be thinner than a cell. Default: [`ThinFeatures::Ignore`].
    pub thin: ThinFeatures,
    /// Whether the mesh says which leaf each triangle is of: [`Mesh::owners`](crate::Mesh::owners).
    /// The numbers are those of [`Solid::owner`](crate::Solid::owner); that of a cap is one
    /// more than the last. Default: `false`.
    pub owners: bool,
}

/// What becomes of creases and corners.
///
/// Both give meshes that are closed, manifold and free of self-intersection, whatever the solid.
///
#[doc = picture!("sharp" = "docs/sharp.png")]
///
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Features {
    /// They are cut off, by a fraction of a cell: marching cubes.
    Smooth,
    /// They are kept: where the normals in a cell differ by more than 26°, and a value of the
    /// field in its middle does not tell that it is round all the same, the cell has a vertex on
    /// the crease or in the corner, and the mesh has edges along the crease.
    ///
    /// A solid without creases, and with radii of four cells or more, has the mesh of
    /// [`Smooth`](Features::Smooth): there are no such normals in any cell. Of a single
    /// [leaf that tells its least radius](crate::field::Field::least_radius), as spheres,
    /// ellipsoids, tori, capsules and rounded boxes do, two cells are enough. One that has any is
    /// meshed more closely also where it is smooth: where it curves so much, with radii below some
    /// 35 cells, that it is off the triangles in a cell by more than some 0.01 or 0.02 cells in
    /// their middle, two triangles have the diagonal that bends less; and where that is not enough,
    /// the cell has a vertex above the surface, as far as the triangles around it are below.
    ///
    /// Where a crease passes cells that have no surface of their own (all their corners are on the
    /// same side), the cells around, up to four along each axis, share a vertex on it, if their
    /// surface is a disc; else the crease is cut off there by a part of a cell. An edge that is
    /// much sharper than a right angle passes between the nodes of cells: the rim of a flat cone
    /// (15°) is cut off by up to one and a half cells, here more and there less.
    #[default]
    Sharp,
}

/// What becomes of a solid that leaves the bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AtBounds {
    /// It is cut: the mesh has caps in the faces of the bounds, their edges sharp with
    /// [`Features::Sharp`].
    #[default]
    Cap,
    /// It is an error, [`MeshingError::LeavesBounds`](crate::error::MeshingError::LeavesBounds),
    /// which says where, also of parts that are wholly outside. A hundredth of a cell is let pass,
    /// and of corners and thin parts what does not show in cells of the size. It takes up to twice
    /// as long.
    Refuse,
}

/// What becomes of features that may be thinner than a cell.
///
/// Whatever is chosen, the mesh tells whether any may be lost:
/// [`Mesh::possibly_lost`](crate::Mesh::possibly_lost), [`Mesh::warnings`](crate::Mesh::warnings).
///
/// ```
/// use rvachev::{CellSize, MeshSettings, Solid, ThinFeatures};
///
/// let fin = Solid::cuboid([0.03, 0.8, 0.8]).translate([0.0, 0.0, 1.3]);
/// let part = Solid::cuboid([2.0, 2.0, 2.0]) | fin;
/// let settings = MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() };
/// // The fin passes between the nodes, and the mesh says that something may.
/// let mesh = part.mesh(&settings)?;
/// assert!(mesh.possibly_lost() > 0 && mesh.bounds().max.z < 1.01);
/// let settings = MeshSettings { thin: ThinFeatures::Refine { halvings: 2 }, ..settings };
/// let mesh = part.mesh(&settings)?;
/// assert!(mesh.possibly_lost() == 0 && mesh.bounds().max.z > 1.69);
/// # Ok::<(), rvachev::error::MeshingError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ThinFeatures {
    /// They are not searched for.
    #[default]
    Ignore,
    /// They are searched for once the mesh is made:
    /// [`Mesh::thin_features`](crate::Mesh::thin_features) holds what
    /// [`Solid::thin_features`](crate::Solid::thin_features) finds, which also says how long that
    /// takes.
    Count,
    /// Blocks of cells that have any, and those close to them, are meshed in cells of half the
    /// size, and blocks of these again, at most so many times, as far as f32 allows;
    /// [`Mesh::possibly_lost`](crate::Mesh::possibly_lost) counts the blocks that still have some
    /// then.
    ///
    /// The mesh keeps all that is said of meshes; where a crease passes from larger cells to
    /// smaller ones in a cell that has no surface of its own, it is cut off by a fraction of a
    /// cell. Where larger and smaller cells do not fit, as it may be where a field jumps, they are
    /// halved fewer times. [`AtBounds::Refuse`] and [`owners`](MeshSettings::owners) go by the
    /// cells that were asked for.
    Refine {
        /// The most times that the cell size is halved.
        halvings: u32,
    },
}

impl ThinFeatures {
    /// How often the cells may be halved.
    pub(super) fn halvings(self) -> u32 {
        match self {
            ThinFeatures::Ignore | ThinFeatures::Count => 0,
            ThinFeatures::Refine { halvings } => halvings,
        }
    }
}
