//! [`Real`] on symbols: running a formula on them writes it down, step by step.
//!
//! What is written down is kept in an [`Arena`], as the trees that `trees` makes of it; a build
//! without the feature `formula` has no such trees, so no arena and no symbol, and formulas can do
//! without a case for it.
//!
//! fidget has no power and its logarithms and roots give NaN ranges and gradients at 0, so
//! they are guarded: `|x|^p = exp(p·ln max(|x|, 10⁻³⁰))`, `√x = √max(x, 10⁻³⁰)`.

use std::f64::consts::{LN_2, LOG2_E};
use std::ops::{Add, Div, Mul, Neg, Sub};

#[cfg(not(feature = "formula"))]
use std::convert::Infallible;

#[cfg(feature = "formula")]
use super::trees::Trees;
use super::{Norm, Real};

/// What trees there are.
#[cfg(not(feature = "formula"))]
type Trees = Infallible;

/// Where the trees of symbols live; a [`Symbol`] is a handle into it.
#[cfg_attr(feature = "formula", derive(Default))]
pub struct Arena(pub(super) Trees);

/// A step of a formula on what was written down before.
#[derive(Clone, Copy)]
#[cfg_attr(not(feature = "formula"), expect(dead_code, reason = "where nothing is written, nothing is read"))]
pub(super) enum Step {
    Constant(f64),
    Neg(usize),
    Square(usize),
    Abs(usize),
    Sqrt(usize),
    Exp(usize),
    Ln(usize),
    Sin(usize),
    Cos(usize),
    Floor(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Div(usize, usize),
    Min(usize, usize),
    Max(usize, usize),
    Atan2(usize, usize),
    /// What to take where the first is not negative, and where it is.
    Select(usize, [usize; 2]),
    /// A coordinate, as it is before any map.
    Axis(usize),
    /// The derivative of a value by a coordinate.
    Slope(usize, usize),
    /// A value, with other values for the coordinates.
    At(usize, [usize; 3]),
}

impl Arena {
    /// Writes down a step.
    #[cfg(not(feature = "formula"))]
    fn write(&self, _step: Step) -> usize {
        match self.0 {}
    }
}

/// The least argument of a logarithm or root.
pub(super) const GUARD: f64 = 1e-30;

/// An expression, written down.
#[derive(Clone, Copy)]
pub struct Symbol<'a> {
    pub(super) arena: &'a Arena,
    pub(super) index: usize,
}

impl Symbol<'_> {
    /// A symbol for `step`, in the same arena.
    fn write(self, step: Step) -> Self {
        Symbol { index: self.arena.write(step), ..self }
    }

    /// `field` divided by the length of its gradient, at `p`: the distance to first order.
    pub fn over_slope(p: [Self; 3], field: impl FnOnce([Self; 3]) -> Self) -> Self {
        let [x, ..] = p;
        let value = field([0, 1, 2].map(|axis| x.write(Step::Axis(axis))));
        let slope = [0, 1, 2].map(|axis| x.write(Step::Slope(value.index, axis)));
        let length = (slope[0].square() + slope[1].square() + slope[2].square()).sqrt();
        let ratio = value / length.max(x.lift(1e-6));
        x.write(Step::At(ratio.index, p.map(|p| p.index)))
    }

    fn ln(self) -> Self {
        self.write(Step::Ln(self.index))
    }

    fn exp(self) -> Self {
        self.write(Step::Exp(self.index))
    }
}

impl Neg for Symbol<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.write(Step::Neg(self.index))
    }
}

impl Add for Symbol<'_> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.write(Step::Add(self.index, o.index))
    }
}

impl Sub for Symbol<'_> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self.write(Step::Sub(self.index, o.index))
    }
}

impl Mul for Symbol<'_> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        self.write(Step::Mul(self.index, o.index))
    }
}

impl Div for Symbol<'_> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        self.write(Step::Div(self.index, o.index))
    }
}

impl Add<f64> for Symbol<'_> {
    type Output = Self;
    fn add(self, k: f64) -> Self {
        if k == 0.0 { self } else { self + self.lift(k) }
    }
}

impl Sub<f64> for Symbol<'_> {
    type Output = Self;
    fn sub(self, k: f64) -> Self {
        if k == 0.0 { self } else { self - self.lift(k) }
    }
}

impl Mul<f64> for Symbol<'_> {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        if k == 1.0 { self } else { self * self.lift(k) }
    }
}

impl Real for Symbol<'_> {
    fn lift(self, c: f64) -> Self {
        self.write(Step::Constant(c))
    }

    fn square(self) -> Self {
        self.write(Step::Square(self.index))
    }

    fn abs(self) -> Self {
        self.write(Step::Abs(self.index))
    }

    fn min(self, o: Self) -> Self {
        self.write(Step::Min(self.index, o.index))
    }

    fn max(self, o: Self) -> Self {
        self.write(Step::Max(self.index, o.index))
    }

    fn sqrt(self) -> Self {
        self.write(Step::Sqrt(self.index))
    }

    fn exp2(self) -> Self {
        (self * LN_2).exp()
    }

    fn log2(self) -> Self {
        self.ln() * LOG2_E
    }

    fn pow(self, p: f64) -> Self {
        if p == 1.0 {
            self.abs()
        } else if p == 2.0 {
            self.square()
        } else {
            (self.abs().ln() * p).exp()
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.write(Step::Sin(self.index)), self.write(Step::Cos(self.index)))
    }

    fn atan2(self, x: Self) -> Self {
        self.write(Step::Atan2(self.index, x.index))
    }

    fn floor(self) -> Self {
        self.write(Step::Floor(self.index))
    }

    fn select(self, nonneg: Self, neg: Self) -> Self {
        self.write(Step::Select(self.index, [nonneg.index, neg.index]))
    }

    fn norm(self, o: Self, norm: Norm) -> Self {
        let (a, b) = (self.abs(), o.abs());
        match norm {
            Norm::Sum => a + b,
            Norm::Max => a.max(b),
            Norm::Euclid => (self.square() + o.square()).sqrt(),
            Norm::P { p, inv } | Norm::Steep { p, inv } => {
                // hi·(1 + (lo/hi)^p)^(1/p): no overflow for any exponent.
                let hi = a.max(b);
                let ratio = a.min(b) / hi.max(hi.lift(GUARD));
                hi * ((ratio.pow(p) + 1.0).ln() * inv).exp()
            }
        }
    }

    fn norm_parts(self, o: Self, norm: Norm) -> (Self, Self, Self) {
        // Trees are differentiated as such; here the weights are spelt out.
        let value = self.norm(o, norm);
        let floor = value.max(value.lift(GUARD));
        let one = self.lift(1.0);
        let (da, db) = match norm {
            Norm::Sum => (one, one),
            Norm::Max => {
                let first = (self.abs() - o.abs()).select(one, self.lift(0.0));
                (first, one - first)
            }
            _ => ((self.abs() / floor).pow(norm.p() - 1.0), (o.abs() / floor).pow(norm.p() - 1.0)),
        };
        (value, self.select(da, -da), o.select(db, -db))
    }
}
