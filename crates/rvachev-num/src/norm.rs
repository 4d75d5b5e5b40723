//! p-norms of a pair, their kind decided once: when a shape is built ([`Norm`]) or when a loop is
//! compiled ([`NormKind`]).

use super::lanes::{LogSpace, norms};

/// A p-norm of a pair of numbers, `(|a|^p + |b|^p)^(1/p)`, with its special cases told apart
/// when a shape is built rather than at every point.
///
/// For p < 1 it is no norm in the strict sense (its balls are not convex), but the formula
/// and everything that is built on it hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Norm {
    /// p = 1: `|a| + |b|`.
    Sum,
    /// p = 2: `√(a² + b²)`.
    Euclid,
    /// p = ∞: `max(|a|, |b|)`.
    Max,
    /// Any other p > 1.
    P {
        /// The exponent.
        p: f64,
        /// `1 / p`.
        inv: f64,
    },
    /// 0 < p < 1: slopes are unbounded where a coordinate is 0.
    Steep {
        /// The exponent.
        p: f64,
        /// `1 / p`.
        inv: f64,
    },
}

impl Norm {
    /// The norm with exponent `p` (0 < p ≤ ∞).
    #[must_use]
    pub fn new(p: f64) -> Norm {
        if p == 1.0 {
            Norm::Sum
        } else if p == 2.0 {
            Norm::Euclid
        } else if p == f64::INFINITY {
            Norm::Max
        } else if p < 1.0 {
            Norm::Steep { p, inv: 1.0 / p }
        } else {
            Norm::P { p, inv: 1.0 / p }
        }
    }

    /// The same norm by powers, without the special cases of 1 and 2: fewer kinds to compile
    /// a loop for.
    #[must_use]
    pub fn by_powers(self) -> Norm {
        match self {
            Norm::Sum => Norm::P { p: 1.0, inv: 1.0 },
            Norm::Euclid => Norm::P { p: 2.0, inv: 0.5 },
            other => other,
        }
    }

    /// The same norm as the steep kind, whose lanes serve every exponent: one loop to compile
    /// where a little speed may go.
    #[must_use]
    pub fn as_steep(self) -> Norm {
        let p = self.p();
        Norm::Steep { p, inv: 1.0 / p }
    }

    /// The norm of a superquadric's exponent ("squareness") `e`: p = 2/e.
    #[must_use]
    pub fn of_exponent(e: f64) -> Norm {
        Norm::new(2.0 / e)
    }

    /// The exponent p.
    #[must_use]
    pub fn p(self) -> f64 {
        match self {
            Norm::Sum => 1.0,
            Norm::Euclid => 2.0,
            Norm::Max => f64::INFINITY,
            Norm::P { p, .. } | Norm::Steep { p, .. } => p,
        }
    }
}

/// A norm whose kind is a type. A formula by [`Norm`] is compiled with all kinds in it, one by a
/// type with one: on lanes that are several times less.
pub trait NormKind: Copy {
    /// The same as a value.
    fn norm(self) -> Norm;

    /// The norm of a pair of lanes.
    fn of_pair<T: LogSpace>(self, a: T, b: T) -> T;

    /// And its derivatives.
    fn parts_of_pair<T: LogSpace>(self, a: T, b: T) -> (T, T, T);

    /// `‖(‖(x, y)‖_inner, z)‖_outer` of lanes; `self` is the inner norm.
    fn of_triple<T: LogSpace>(self, outer: Self, p: [T; 3]) -> T;

    /// And its derivatives.
    fn parts_of_triple<T: LogSpace>(self, outer: Self, p: [T; 3]) -> (T, [T; 3]);
}

/// p = 2.
#[derive(Clone, Copy, Debug)]
pub struct Euclid;

/// Any p ≥ 1, or with `STEEP` any p > 0.
#[derive(Clone, Copy, Debug)]
pub struct Powers<const STEEP: bool> {
    /// The exponent.
    pub p: f64,
    /// `1 / p`.
    pub inv: f64,
}

impl Powers<true> {
    /// A norm of any kind by powers.
    #[must_use]
    pub fn steep(norm: Norm) -> Self {
        let p = norm.p();
        Powers { p, inv: 1.0 / p }
    }
}

impl NormKind for Euclid {
    #[inline(always)]
    fn norm(self) -> Norm {
        Norm::Euclid
    }

    #[inline(always)]
    fn of_pair<T: LogSpace>(self, a: T, b: T) -> T {
        norms::euclid(a.abs(), b.abs())
    }

    #[inline(always)]
    fn parts_of_pair<T: LogSpace>(self, a: T, b: T) -> (T, T, T) {
        norms::euclid_pair_parts(a, b)
    }

    #[inline(always)]
    fn of_triple<T: LogSpace>(self, _: Euclid, [x, y, z]: [T; 3]) -> T {
        norms::euclid3([x.abs(), y.abs(), z.abs()])
    }

    #[inline(always)]
    fn parts_of_triple<T: LogSpace>(self, _: Euclid, p: [T; 3]) -> (T, [T; 3]) {
        norms::euclid_triple_parts(p)
    }
}

impl<const STEEP: bool> NormKind for Powers<STEEP> {
    #[inline(always)]
    fn norm(self) -> Norm {
        let Powers { p, inv } = self;
        if STEEP { Norm::Steep { p, inv } } else { Norm::P { p, inv } }
    }

    #[inline(always)]
    fn of_pair<T: LogSpace>(self, a: T, b: T) -> T {
        norms::pair::<T, STEEP>(a.abs(), b.abs(), self.p, self.inv)
    }

    #[inline(always)]
    fn parts_of_pair<T: LogSpace>(self, a: T, b: T) -> (T, T, T) {
        norms::pair_parts::<T, STEEP>(a, b, self.p, self.inv)
    }

    #[inline(always)]
    fn of_triple<T: LogSpace>(self, outer: Self, p: [T; 3]) -> T {
        norms::triple::<T, STEEP>(p, [self.p, self.inv, outer.p, outer.inv])
    }

    #[inline(always)]
    fn parts_of_triple<T: LogSpace>(self, outer: Self, p: [T; 3]) -> (T, [T; 3]) {
        norms::triple_parts::<T, STEEP>(p, [self.p, self.inv, outer.p, outer.inv])
    }
}

/// The kind is told apart each time.
impl NormKind for Norm {
    #[inline(always)]
    fn norm(self) -> Norm {
        self
    }

    #[inline(always)]
    fn of_pair<T: LogSpace>(self, a: T, b: T) -> T {
        norms::norm(a, b, self)
    }

    #[inline(always)]
    fn parts_of_pair<T: LogSpace>(self, a: T, b: T) -> (T, T, T) {
        norms::norm_parts(a, b, self)
    }

    #[inline(always)]
    fn of_triple<T: LogSpace>(self, outer: Self, [x, y, z]: [T; 3]) -> T {
        norms::nested(x, y, z, self, outer)
    }

    #[inline(always)]
    fn parts_of_triple<T: LogSpace>(self, outer: Self, [x, y, z]: [T; 3]) -> (T, [T; 3]) {
        norms::nested_parts(x, y, z, self, outer)
    }
}
