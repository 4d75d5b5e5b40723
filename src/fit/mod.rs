//! From points to solids: fits of superellipsoids, supershapes and deformed superellipsoids to scans.
//!
//! ```text
//!      .  .:.:'':.  .             e = (0.4, 1.3)   a = (1.2, 0.8, 2)   pose
//!     .:'.    .   ':    .    →    noise 0.011, inliers 80 %, weights, covariance
//!       ':..:.:.:'  .
//! ```
//!
//! [`superellipsoid`] takes a [`PointCloud`](crate::PointCloud) and gives a [`Fit`]: the solid with
//! its leaf and pose, a weight for each point, the noise, the covariance of the parameters.
//!
//! # Method
//!
//! Dense points are told from strewn ones by counting neighbours; a plane that most of the rest is
//! on one side of is tried as a table. Six starts along the principal axes (twelve about the centre
//! of the rim, if the points are of one side) are descended from by Levenberg–Marquardt with
//! robust weights, on few points first; the best are taken to other encodings of the same solid.
//! Last come steps of expectation and maximisation for the noise and the share of strewn points,
//! in double precision. All derivatives are analytic. A term for the surface's area takes the
//! smaller of two solids that fit.
//!
//! Sources: F. Solina, R. Bajcsy, *Recovery of parametric models from range images: the case for
//! superquadrics with global deformations* (1990); W. Liu, Y. Wu, S. Ruan, G. Chirikjian, *Robust
//! and accurate superquadric recovery: a probabilistic approach* (2022).

mod check;
mod cloud;
mod cost;
mod covariance;
mod deform_recover;
mod deformable;
mod deformations;
mod deformed;
mod density;
mod deviations;
mod error;
mod finish;
mod gielis;
mod grid;
mod harmonics;
mod inspect;
mod kernel;
#[cfg(test)]
mod kernel_tests;
mod linear;
mod local;
mod mixture;
mod plane;
mod pose;
mod random;
mod recover;
mod result;
mod samples;
mod search;
mod settings;
mod shape_recover;
mod solve;
mod starts;
mod superellipsoid;
mod superquadric;
mod supershape;
mod supershapes;

pub use cost::Cost;
pub use covariance::Covariance;
pub use deformed::{DeformedSuperellipsoid, deformed, deformed_with};
pub use deviations::Deviation;
pub use error::FitError;
pub use inspect::{Deviations, LeafDeviation, inspect, inspect_with};
pub use result::{Fit, SearchReport, Shape};
pub use settings::{FitSettings, Start};
pub use superellipsoid::{superellipsoid, superellipsoid_with};
pub use supershape::{supershape, supershape_with};
