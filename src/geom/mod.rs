//! Plain data that other modules make and use: meshes, points, polylines, planes, images, cameras.
//!
//! Nothing here evaluates, renders or reads files. A type has private fields where they must
//! agree with one another ([`Mesh`], [`Image`]) and public ones where any combination can at
//! least be written down ([`Camera`], checked by [`Camera::check`]).

mod camera;
mod contours;
mod each;
pub(crate) mod figures;
mod image;
mod legend;
mod mesh;
mod plane;
mod point_cloud;
mod polyline;
mod quad_mesh;
mod range_image;
mod thin_report;
mod transfer;
mod unit;
mod view;

pub use camera::{Camera, CameraError, Projection, Rays};
pub use contours::{Contours, Outline};
pub(crate) use each::each;
pub use image::{Image, ImageError};
pub(crate) use image::{grey, to_8bit};
pub(crate) use legend::{label, legend};
pub(crate) use mesh::Findings;
pub use mesh::{Mesh, MeshError};
pub use plane::Plane;
pub use point_cloud::{PointCloud, PointCloudError};
pub use polyline::Polyline;
pub use quad_mesh::{Corner, QuadMesh};
pub use range_image::{Coordinates, Noise, RangeImage, RangeImageError};
pub use thin_report::{ThinPlace, ThinReport};
pub(crate) use transfer::{to_byte, to_linear};
pub(crate) use unit::unit;
pub use view::{Intrinsics, View};
