//! The plane shapes that profiles are made of.

use glam::DVec2;

use super::Range;
use super::built_in::built_in;
use crate::{AnyField, Circle, Gielis, Polygon, Rectangle, RegularPolygon, Superellipse, Superpolygon};

built_in!(
    ($) dyn AnyField, PLANE_LEAVES, plane_leaves;

    /// A disc about the origin.
    circle: Circle as leaf {
        /// Distance of the border from the centre.
        radius: f64 = leaf.radius, Length, Range::LENGTH, example 1.0;
    } => Circle { radius };

    /// A rectangle about the origin, its corners sharp or rounded.
    rectangle: Rectangle as leaf {
        /// Lengths of the sides along x and y.
        size: DVec2 = leaf.size, Length, Range::LENGTH, example DVec2::new(4.0, 2.0);
        /// Radius of the corners: at most half the shorter side.
        radius: f64 = leaf.radius, Length, Range::new(0.0, 1e9),
            given Range::new(0.0, 0.5 * leaf.size.min_element()), example 0.5;
    } => Rectangle { size, radius };

    /// A regular polygon about the origin, the middle of a side on the positive x axis.
    regular_polygon: RegularPolygon as leaf {
        /// Number of sides.
        sides: u32 = leaf.sides(), None, Range::new(3.0, 1024.0), example 6;
        /// Distance of the corners from the centre.
        radius: f64 = leaf.radius(), Length, Range::LENGTH, example 2.0;
    } => RegularPolygon::new(sides, radius);

    /// A polygon with holes and islands, by its contours.
    polygon: Polygon as leaf {
        /// Lists of points, each closed by itself; edges do not cross.
        contours: Vec<Vec<DVec2>> = leaf.contours().to_vec(), Length, Range::FINITE, example vec![
            vec![DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(4.0, 3.0), DVec2::new(0.0, 3.0)],
            vec![DVec2::ONE, DVec2::new(3.0, 1.0), DVec2::new(2.0, 2.0)],
        ];
    } => Polygon::new(contours);

    /// A superellipse about the origin.
    superellipse: Superellipse as leaf {
        /// Half the lengths along x and y.
        semi_axes: DVec2 = leaf.semi_axes(), Length, Range::LENGTH, example DVec2::new(2.0, 1.0);
        /// 0 square, 1 round, 2 bevelled.
        exponent: f64 = leaf.exponent(), None, Range::new(0.01, 10.0), example 0.5;
    } => Superellipse::new(semi_axes, exponent);

    /// What is within a Gielis curve.
    superpolygon: Superpolygon as leaf {
        /// The curve, by its standard radius.
        curve: Gielis = leaf.curve(), None, Range::ANY, example Gielis::new(5.0, 2.0, 2.0, 2.0);
        /// What the curve's radius of 1 becomes.
        radius: f64 = leaf.radius(), Length, Range::LENGTH, example 3.0;
    } => Superpolygon::new(curve, radius);
);
