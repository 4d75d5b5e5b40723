//! Values along segments: a ray knows more than the box about it.
//!
//! ```text
//!     +---------.      The polar angles that a segment has, seen from the origin, are those between
//!     |      .-'|      its ends. A box about it has more.
//!     |   .-'   |
//!     '--------+|
//! ```

use crate::{Dual, Interval, Placement};

/// A segment of a leaf's frame that is passed at a steady pace: coordinates are in length units.
///
/// ```
/// use rvachev::Sphere;
/// use rvachev::field::{Field, Segment};
///
/// // From 2 outside of a ball to 1 outside, at a length unit per unit of the way.
/// let ball = Sphere { radius: 1.0 };
/// let along = ball.along(&Segment::new([[3.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [-1.0, 0.0, 0.0], 1.0));
/// assert!(along.value.lo() <= -2.0 && along.value.hi() >= -1.0 && along.value.hi() < 0.0);
/// assert!(along.slope.lo() > 0.9 && along.slope.hi() < 1.1);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Its ends, give or take rounding.
    pub ends: [[Interval; 3]; 2],
    /// How fast the coordinates change on the way.
    pub slopes: [Interval; 3],
    /// How long the way is.
    pub length: f64,
}

impl Segment {
    /// The segment from one point to another, at the pace `slopes`.
    #[must_use]
    pub fn new(ends: [[f64; 3]; 2], slopes: [f64; 3], length: f64) -> Segment {
        Segment { ends: ends.map(|end| end.map(Interval::point)), slopes: slopes.map(Interval::point), length }
    }

    /// The same in a leaf's own coordinates.
    #[must_use]
    pub fn placed(&self, placement: &Placement) -> Segment {
        let zero = Interval::point(0.0);
        let slopes = [0, 1, 2].map(|axis| Dual::new(zero, [self.slopes[axis], zero, zero]));
        Segment {
            ends: self.ends.map(|end| placement.apply(end)),
            slopes: placement.apply(slopes).map(|side| side.gradient()[0]),
            length: self.length,
        }
    }

    /// The box about it, whose sides change as the coordinates do on the way.
    #[must_use]
    pub fn sides(&self) -> [Dual<Interval>; 3] {
        let ([from, to], zero) = (self.ends, Interval::point(0.0));
        [0, 1, 2].map(|axis| Dual::new(from[axis].hull(to[axis]), [self.slopes[axis], zero, zero]))
    }
}

/// What is known of a value along a segment.
#[derive(Clone, Copy, Debug)]
pub struct Along {
    /// Its range.
    pub value: Interval,
    /// The range of its slope on the way.
    pub slope: Interval,
}

impl Along {
    /// Nothing is known.
    pub const ANY: Along = Along { value: Interval::ALL, slope: Interval::ALL };

    /// A value that changes as its slopes along the first variable say.
    #[must_use]
    pub fn of(range: Dual<Interval>) -> Along {
        Along { value: range.value(), slope: range.gradient()[0] }
    }

    /// The same outside of a leaf's coordinates.
    #[must_use]
    pub fn placed(self, placement: &Placement) -> Along {
        let zero = Interval::point(0.0);
        Along::of(placement.finish(Dual::new(self.value, [self.slope, zero, zero])))
    }

    /// That of the negated value.
    #[must_use]
    pub fn turned(self) -> Along {
        Along { value: -self.value, slope: -self.slope }
    }
}
