//! Plane shapes: leaves that depend on x and y only, and so are unbounded along z.
//!
//! They are what a `Profile` is made of. Each is a [`Field`](super::Field)
//! like any other; its formula ignores z.

mod circle;
mod polygon;
mod rectangle;
mod regular_polygon;
mod superellipse;
mod superpolygon;

pub use circle::Circle;
pub use polygon::Polygon;
pub use rectangle::Rectangle;
pub use regular_polygon::RegularPolygon;
pub use superellipse::Superellipse;
pub use superpolygon::Superpolygon;

use glam::DVec2;

use crate::{Bounds, Interval};

/// The box of a plane shape that reaches `half` to both sides of the origin.
fn column(half: DVec2) -> Bounds {
    let half = half.extend(f64::INFINITY);
    Bounds::new(-half, half)
}

/// A region without its extent along z, on which nothing depends.
fn flattened([x, y, _]: [Interval; 3]) -> [Interval; 3] {
    [x, y, Interval::point(0.0)]
}
