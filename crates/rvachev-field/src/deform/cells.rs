//! Rows and grids of copies along the axes, by folding space.
//!
//! Copies stand at `i·s`, i = 0 … n − 1, along an axis. The copies with `i = r + N·b` are one
//! class; the fold of class r moves a point to the nearest of its copies:
//!
//! ```text
//!     b = clamp(⌊(x − c − r s)/(N s) + ½⌋, 0, last),      x ↦ x − (r + N b)·s
//!
//!          c + 0     c + s     c + 2s    c + 3s    c + 4s        N = 2
//!     ───────o─────────x─────────o─────────x─────────o──────
//!     class 0     ^edge 0,2 →    |     edge 2,4 →    |
//! ```
//!
//! The repeated solid is the union over the N classes, whatever n is. With c the centre of the
//! operand's box and `2h` its width in spacings, `N ≥ 2h + 1` makes this exact: the classes
//! together know all copies within N/2 of a point, every point of every copy is within h of
//! its centre, so a copy that is left out is nowhere nearer than one that is not, and no point
//! lies in it. The edges of a class's fold are N/2 from its copies' centres, half a spacing
//! outside of them, where nothing of that class is near the surface: a region across an edge
//! is told to be outside of the class as other regions are (see [`Pieces`](crate::Pieces)).

use glam::{DAffine3, DVec3};

use super::{Branches, Warp};
use crate::{Bounds, Dual, Interval, Real};
use crate::{ParamError, check};

/// The fold of one class along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comb {
    /// Where the class's first copy is: `r·s`.
    pub offset: f64,
    /// From copy to copy of the class: `N·s`.
    pub pitch: f64,
    /// The number of its last copy, from 0.
    pub last: f64,
    /// The centre of the operand's box.
    pub centre: f64,
}

impl Comb {
    /// No copies but the solid itself.
    pub const ONE: Comb = Comb { offset: 0.0, pitch: 1.0, last: 0.0, centre: 0.0 };

    /// The number of the copy that is nearest to `x`.
    #[inline(always)]
    fn number<R: Real>(&self, x: R) -> R {
        let zero = x.lift(0.0);
        let cells = ((x - (self.centre + self.offset)) * (1.0 / self.pitch) + 0.5).floor();
        cells.max(zero).min(x.lift(self.last))
    }

    #[inline(always)]
    fn folded<R: Real>(&self, x: R) -> R {
        if self.last == 0.0 {
            return x - self.offset;
        }
        self.number(x).scale_add(-self.pitch, x - self.offset)
    }

    /// The numbers at the ends of an interval.
    fn numbers(&self, x: Interval) -> (f64, f64) {
        if self.last == 0.0 { (0.0, 0.0) } else { (self.number(x.lo()), self.number(x.hi())) }
    }

    /// How far a point of copy `number` is moved.
    fn shift(&self, number: f64) -> f64 {
        -(self.offset + number * self.pitch)
    }

    /// The image of an interval: whole cells where it spans more than one.
    fn image(&self, x: Interval) -> Interval {
        let (first, last) = self.numbers(x);
        let (low, high) = (x.lo() + self.shift(first), x.hi() + self.shift(last));
        let rounding = 1e-15 * (x.magnitude() + self.shift(first).abs() + self.shift(last).abs());
        let exact = if first == last {
            Interval::new(low, high)
        } else {
            let (left, right) = (self.centre - 0.5 * self.pitch, self.centre + 0.5 * self.pitch);
            Interval::new(low.min(left), high.max(right))
        };
        exact.inflate(rounding + 1e-15 * exact.magnitude())
    }
}

/// The fold of one class of copies.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    /// How each axis is folded.
    pub axes: [Comb; 3],
    /// Copies along each axis.
    pub counts: [u32; 3],
    /// From copy to copy, in length units.
    pub spacing: DVec3,
    /// Whether the copies are too many to be made one by one, and have to.
    pub crowded: Option<f64>,
}

/// The most copies along an axis.
const MOST: f64 = 1e6;

impl Warp for Cells {
    const NAME: &'static str = "repeat";
    const FOLDS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        [self.axes[0].folded(x), self.axes[1].folded(y), self.axes[2].folded(z)]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        p - DVec3::from_array(self.axes.map(|axis| axis.shift(0.0)))
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let first = DVec3::from_array(self.axes.map(|axis| -axis.shift(0.0)));
        let last = DVec3::from_array(self.axes.map(|axis| -axis.shift(axis.last)));
        Bounds::new(b.min + first, b.max + last)
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        let first = DVec3::from_array(self.axes.map(|axis| -axis.shift(0.0)));
        let last = DVec3::from_array(self.axes.map(|axis| -axis.shift(axis.last)));
        own(direction) + (direction * first).max(direction * last).element_sum()
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let count = f64::from(self.counts[axis]);
            check::within(&format!("counts.{name}"), count, 1.0, MOST)?;
            if count > 1.0 {
                check::length(&format!("spacing.{name}"), self.spacing[axis])?;
                check::length(&format!("spacing.{name} times counts.{name}"), self.spacing[axis] * count)?;
            }
        }
        match self.crowded {
            None => Ok(()),
            Some(copies) => Err(ParamError::new(
                "copies to be made one by one",
                copies,
                "at most 4096 (the solid is unbounded, or spans many spacings)",
            )),
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        5e-7 * reach
    }

    fn slopes(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        let values = p.map(Dual::value);
        [0, 1, 2].map(|axis| {
            let comb = &self.axes[axis];
            let (first, last) = comb.numbers(values[axis]);
            let slopes = if first == last { p[axis].gradient() } else { [Interval::ALL; 3] };
            Dual::new(comb.image(values[axis]), slopes)
        })
    }

    fn stretch(&self, _: [Interval; 3]) -> f64 {
        1.0
    }

    fn branches(&self, hull: [Interval; 3]) -> Option<Branches> {
        let mut first = DVec3::ZERO;
        let mut second = DVec3::ZERO;
        let mut count = 1.0;
        for axis in 0..3 {
            let comb = &self.axes[axis];
            let (low, high) = comb.numbers(hull[axis]);
            count *= high - low + 1.0;
            (first[axis], second[axis]) = (comb.shift(low), comb.shift(high));
        }
        let other = (count > 1.0).then(|| DAffine3::from_translation(second));
        (count <= 2.0).then(|| (DAffine3::from_translation(first), other))
    }
}
