//! Subdivision curves and surfaces: conics and quadrics exactly, and everything near them.
//!
//! The scheme of Morin, Warren and Weimer turns a control polygon into a smooth curve by
//! averaging; with the right tension a square becomes a circle. Surfaces are tensor products:
//! a profile revolved along a path, or a grid of control points.
//!
//! | | |
//! |---|---|
//! | [`Tension`] | the mask and the limit stencil |
//! | [`ControlPolygon`] | closed and open polygons; ellipses, hyperbolas, parabolas, graphs |
//! | [`SubdivisionRevolution`] | ellipsoids, hyperboloids, tori, cylinders, any profile and path |
//! | [`ControlGrid`] | rows and columns of control points, open or closed each way |
//!
//! Sources: G. Morin, J. Warren, H. Weimer, *A subdivision scheme for surfaces of revolution*
//! (2001); G. Wei, J. Feng, F. Chen on quadrics by that scheme, with corrections.

mod conic;
mod grid;
mod polygon;
mod quadric;
mod refine;
mod revolution;
mod tension;

pub use conic::hyperbola_of_ellipse;
pub use grid::ControlGrid;
pub use polygon::{ControlPoint, ControlPolygon};
pub use revolution::{ProfileEnd, SubdivisionRevolution};
pub use tension::Tension;

/// Why control points cannot be subdivided.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SubdivisionError {
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] crate::Cancelled),
    /// Too few control points.
    #[error("{points} control points in {of}, allowed: {least} or more")]
    TooFewPoints {
        /// What they are the points of.
        of: &'static str,
        /// How many there are.
        points: usize,
        /// The least number allowed.
        least: usize,
    },
    /// A control point that is NaN, infinite or beyond 10¹².
    #[error("control point {index} has the coordinate {value}, allowed: −10¹² to 10¹²")]
    Coordinate {
        /// Which one, counted from 0.
        index: usize,
        /// The coordinate.
        value: f64,
    },
    /// A tension that does not exist.
    #[error("{parameter} of a tension is {value}, allowed: {allowed}")]
    Tension {
        /// Which parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A length or another number out of its range.
    #[error("{parameter} is {value}, allowed: {allowed}")]
    Parameter {
        /// Which parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A grid whose number of points is not rows × columns.
    #[error("{points} control points for a grid of {rows} rows and {columns} columns")]
    Grid {
        /// How many there are.
        points: usize,
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// So many levels that the result would not fit into memory.
    #[error("{levels} levels make more than {most} points of {points}; allowed: at most {allowed} levels")]
    Levels {
        /// The levels asked for.
        levels: u32,
        /// Points before.
        points: usize,
        /// The largest number of points after.
        most: usize,
        /// The largest number of levels that stays below it.
        allowed: u32,
    },
}

/// The most points of a curve: 2²⁶, up to 1.6 GB, and twice that on the way.
const MOST_ON_CURVE: usize = 1 << 26;

/// The most vertices of a mesh: 2²⁴, some 4 GB with faces, normals and texture coordinates.
const MOST_IN_MESH: usize = 1 << 24;

/// Coordinates are at most this.
const LARGEST: f64 = 1e12;

/// Whether `points` may be doubled `levels` times in `directions` directions.
fn check_levels(points: usize, levels: u32, directions: u32, most: usize) -> Result<(), SubdivisionError> {
    let allowed = (most / points.max(1)).max(1).ilog2() / directions;
    if levels <= allowed { Ok(()) } else { Err(SubdivisionError::Levels { levels, points, most, allowed }) }
}

/// Whether all coordinates are finite and of a usual size.
fn check_coordinates<const N: usize>(points: impl Iterator<Item = [f64; N]>) -> Result<(), SubdivisionError> {
    let bad = |p: [f64; N]| p.into_iter().find(|c| c.is_nan() || c.abs() > LARGEST);
    match points.enumerate().find_map(|(index, p)| bad(p).map(|value| (index, value))) {
        Some((index, value)) => Err(SubdivisionError::Coordinate { index, value }),
        None => Ok(()),
    }
}
