//! The formulas: leaves, R-functions and deformations, each written once over
//! [`Real`].
//!
//! A leaf is a type that implements [`Field`]; adding one is a file here, a line below and its
//! declaration in the [`catalogue`]. A deformation implements `Warp`. Both are erased (`AnyField`,
//! `AnyWarp`) to the evaluations that the engine runs: point, gradient, range, lanes, expression
//! tree.

#[macro_use]
mod picture;

mod blend;
mod capsule;
pub mod catalogue;
pub mod check;
mod cone;
mod crease;
mod cuboid;
mod cylinder;
mod deform;
mod ellipsoid;
mod erase;
mod erased;
mod erased_warp;
mod excess;
mod fold;
#[cfg(feature = "formula")]
mod formula;
mod generalised;
mod gielis;
mod half_space;
mod kaleidoscope;
pub mod kernel;
mod leaf;
mod level;
mod minimal_surface;
mod network_lattice;
mod number;
mod outline;
mod outlined;
mod patches;
mod placed;
mod placement;
mod points;
pub mod power;
mod prism;
mod profile;
mod pull;
mod pyramid;
mod rfunction;
mod rounded_cuboid;
mod segment;
mod sheet_lattice;
mod slab;
mod slope;
mod sphere;
mod superellipsoid;
mod superhyperboloid;
mod supershape;
mod supertoroid;
mod sweep;
mod tangents;
mod zone;

use rvachev_num::{
    Angle, Bounds, Dual, Euclid, Interval, Jet, Monotone, Monotone3, Norm, NormKind, OfOne, Powers, Real,
};

pub use blend::Blend;
pub use blend::RicciSide;
mod torus;
mod unit;
mod wedge;
pub use capsule::Capsule;
pub use check::ParamError;
pub use cone::Cone;
pub use crease::Crease;
pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use deform::{
    AnyWarp, Bend, BendBetween, BuiltInLaw, Cells, Comb, Elongate, Sectors, Taper, TaperBy, Twist, TwistBy,
};
pub use deform::{Law, LawTable, LinearLaw, SineWave, SmoothStep};
pub use ellipsoid::Ellipsoid;
pub use erase::Erase;
pub use erased::{AnyField, Chunk, EmptyBalls, Facets, Layer, chained, steep_slopes};
pub use fold::{Joinable, Op};
#[cfg(feature = "formula")]
pub use formula::{Formula, FormulaError};
pub use generalised::GeneralisedSuperquadric;
pub use gielis::{Gielis, Radius, Turns};
pub use half_space::HalfSpace;
pub use leaf::{Case, Field, Kernel};
pub use level::level_layers;
pub use minimal_surface::{Grading, MinimalSurface};
pub use network_lattice::NetworkLattice;
pub use number::{Joined, Number};
pub use patches::{
    Between, Foot, Loss, MeshLeaf, MovedApart, Moves, OpenEdges, Patch, Patches, Place, Subpatch, SurfaceDistance,
    Walls,
};
pub use placement::{Placement, smallest_stretch};
pub use points::{
    BinomialSeries, CurveSpread, ExactExplicit, LogTable, PlaneSymmetry, PointError, PointMethod, PointSettings,
    PowerTables, ProductTables, RawParametric, SeriesExplicit, Symmetry, reflect, reflect_plane,
};
pub use prism::Prism;
pub use profile::{Circle, Polygon, Rectangle, RegularPolygon, Superellipse, Superpolygon};
pub use pull::{product, pull};
pub use pyramid::Pyramid;
pub use rfunction::RFunction;
pub use rfunction::{Rule, saturate};
pub use rounded_cuboid::RoundedCuboid;
pub use segment::{Along, Segment};
pub use sheet_lattice::SheetLattice;
pub use slab::Slab;
pub use sphere::Sphere;
pub use superellipsoid::Superellipsoid;
pub use superhyperboloid::Superhyperboloid;
pub use supershape::Supershape;
pub use supertoroid::Supertoroid;
pub use sweep::{Caps, HelixWarp, Opening, Revolution, Span, Turn};
pub use torus::Torus;
pub use unit::unit;
pub use wedge::Wedge;
pub use zone::{Pieces, Way, Zone, bits, dot, largest_stretch, mean_value_range, steepest};

/// Coordinates beyond this many length units are evaluated as if they lay there, so that no
/// intermediate result overflows single precision.
pub const COORDINATE_LIMIT: f64 = 1e12;

/// How many boxes a leaf that answers for many at once is asked about.
pub const BOXES: usize = 16;

/// Values saturate at this many length units, so that no chain of R-functions overflows.
pub const VALUE_LIMIT: f64 = 1e18;
