//! p-norms of a pair, their kind decided once.

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
