//! What a parameter's value is, and in which unit.

/// What sort of value a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// A number.
    Number,
    /// An angle; ranges are in degrees.
    Angle,
    /// A whole number, not negative.
    Count,
    /// Yes or no.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Three numbers: along x, y and z.
    Vector,
    /// Three numbers that are not all zero; their length does not matter.
    Direction,
    /// Two numbers: along x and y.
    PlaneVector,
    /// Three whole numbers: along x, y and z.
    Counts,
    /// A [`Gielis`](crate::Gielis) curve.
    Curve,
    /// A law of z.
    Law,
    /// An [`RFunction`](crate::RFunction).
    Function,
    /// A [`Blend`](crate::Blend).
    Blend,
    /// How the edges of end faces are: [`Caps`](crate::Caps).
    Caps,
    /// Closed contours in the plane.
    Contours,
    /// Points in the plane: z and value of a law.
    Points,
    /// Words.
    Text,
    /// A formula, in the text of a `.vm` file.
    Formula,
    /// A box along the axes.
    Bounds,
    /// An affine map.
    Map,
    /// Red, green and blue in sRGB.
    Color,
}

/// The unit that a parameter's numbers are in: what they are multiplied by where a model is
/// told in other units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unit {
    /// None.
    None,
    /// Lengths.
    Length,
    /// Angles.
    Angle,
    /// One over a length: a curvature.
    PerLength,
    /// Angles per length.
    AnglePerLength,
}
