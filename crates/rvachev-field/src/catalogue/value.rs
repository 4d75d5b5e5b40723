//! Values of parameters.

use glam::{DAffine3, DVec2, DVec3};

use crate::{Angle, Blend, Bounds, BuiltInLaw, Caps, Gielis, RFunction};

/// The value of a parameter of what the catalogue lists.
///
/// Units are those of the [`Parameter`](super::Parameter): lengths, radians, none.
///
/// ```
/// use rvachev::catalogue::Value;
/// use rvachev::form::Form;
/// use rvachev::Solid;
///
/// let rod = Solid::cylinder(1.0, 10.0);
/// let Form::Leaf(leaf) = rod.form() else { unreachable!("a cylinder is a leaf") };
/// assert_eq!(leaf.values(), Some(vec![Value::Number(1.0), Value::Number(10.0)]));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// A number.
    Number(f64),
    /// An angle.
    Angle(Angle),
    /// A whole number.
    Count(u32),
    /// Yes or no.
    Switch(bool),
    /// One of the words of [`Kind::Choice`](super::Kind::Choice).
    Choice(&'static str),
    /// Three numbers.
    Vector(DVec3),
    /// Two numbers.
    PlaneVector(DVec2),
    /// Three whole numbers.
    Counts([u32; 3]),
    /// A curve.
    Curve(Gielis),
    /// A law of z.
    Law(BuiltInLaw),
    /// An R-function.
    Function(RFunction),
    /// A blend.
    Blend(Blend),
    /// The edges of end faces.
    Caps(Caps),
    /// Closed contours, each a list of points.
    Contours(Vec<Vec<DVec2>>),
    /// Points.
    Points(Vec<DVec2>),
    /// Words, or the text of a `.vm` file.
    Text(String),
    /// A box.
    Bounds(Bounds),
    /// An affine map.
    Map(DAffine3),
    /// A colour.
    Color([u8; 3]),
}
