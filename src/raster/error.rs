//! What is wrong with a view, with operands or with a tree.

use glam::DVec3;

use crate::{CameraError, Cancelled, ImageError, MeshError, ParamError, RangeImageError};

/// Why there is no depth buffer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    /// The camera cannot take a picture.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A setting is out of its range.
    #[error("{setting} is {value}; allowed: {allowed}")]
    Setting {
        /// The setting.
        setting: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A mesh does not enclose a solid: it has a boundary, or triangles that face both ways.
    #[error("the mesh is open: {edges} edges are not used once in each direction, one of them at {at}")]
    Open {
        /// Number of edges that are not used as often in one direction as in the other.
        edges: usize,
        /// An end of the first of them.
        at: DVec3,
    },
    /// A closed mesh faces inward.
    #[error("the mesh is inside out: its volume is {volume}, and must not be below 0; Mesh::flipped turns it")]
    InsideOut {
        /// The enclosed volume, in cubic length units.
        volume: f64,
    },
    /// An operand's surface is not known to be closed.
    #[error("operand {operand} is an open surface; it can be drawn, but not be joined with others")]
    Surface {
        /// The operand, counted from 0.
        operand: usize,
    },
    /// The tree names an operand that was not given.
    #[error("the tree names operand {operand}, but there are {operands} operands, counted from 0")]
    Operand {
        /// The operand that it names.
        operand: usize,
        /// Number of operands given.
        operands: usize,
    },
    /// Layers were made for a picture of another size.
    #[error("layers of a picture of {} × {} cannot go into one of {} × {}", .layers[0], .layers[1], .picture[0], .picture[1])]
    Size {
        /// Width and height that the layers were made for.
        layers: [u32; 2],
        /// Width and height of the picture.
        picture: [u32; 2],
    },
    /// The tree holds what is far away, such as the complement of an operand.
    #[error("the tree is unbounded: it holds points outside of all operands")]
    Unbounded,
    /// The method cannot do this tree.
    #[error("the stencil passes join operands by union, or two by intersection or difference; not {tree}")]
    Tree {
        /// The tree, in words.
        tree: String,
    },
    /// The tree is too large a union of products.
    #[error("the tree is a union of more than {most} products; the method of intervals takes it as it is")]
    Products {
        /// The most products that are rendered.
        most: usize,
    },
    /// The method wants the eye outside of the operands, and the near plane cuts one.
    #[error("the near plane cuts operand {operand}; of the methods only that of intervals allows it")]
    Cut {
        /// The operand, counted from 0.
        operand: usize,
    },
    /// A mesh cannot be deformed so.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A deformed mesh is beyond single precision.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The camera's numbers do not make a range image.
    #[error(transparent)]
    Range(#[from] RangeImageError),
    /// The pixels do not make a picture: a defect of this crate.
    #[error("internal error, please report it: {0}")]
    Image(#[from] ImageError),
}
