//! Points of superquadrics by the six methods of Franklin and Barr.
//!
//! [`Superellipsoid::points`](crate::Superellipsoid::points) and
//! [`Superellipse::points`](crate::Superellipse::points) choose one ([`PointMethod`]); the methods
//! themselves are here.

#[doc(inline)]
pub use rvachev_field::{
    BinomialSeries, CurveSpread, ExactExplicit, LogTable, PlaneSymmetry, PointError, PointMethod, PointSettings,
    PowerTables, ProductTables, RawParametric, SeriesExplicit, Symmetry, reflect, reflect_plane,
};
