//! Implicit-function (F-rep) solid modelling.

mod bounds;
mod eval;
mod field;
mod geom;
mod io;
mod mesh;
mod num;
mod run;
mod solid;
mod space;

pub use bounds::Bounds;
pub use eval::{Evaluator, Gradients, Hit, Owner, Program, Region, Tape};
pub use field::{
    COORDINATE_LIMIT, Cuboid, Cylinder, Field, Gielis, HalfSpace, Kernel, ParamError, RFunction, Radius, Sphere,
    Superellipsoid, Supershape, VALUE_LIMIT,
};
pub use geom::{Camera, CameraError, Image, ImageError, Mesh, MeshError, Projection, Rays};
pub use io::{SaveError, write_png, write_stl};
pub use mesh::{CellSize, Lattice, LatticeError, MeshReport, MeshSettings, MeshingError};
pub use num::{Dual, Interval, Monotone, Norm, Real};
pub use run::{CancelToken, Cancelled, Progress, Run};
pub use solid::{Solid, SolidError};
