//! Gielis curves: the radius of a supershape's sections.
//!
//! ```text
//!     r(θ) = ( |cos(mθ/4)/a|^n₂ + |sin(mθ/4)/b|^n₃ )^(−1/n₁)            standard
//!     r(θ) = 2^(−1/n₁)·( 2/(n₁W) + 1 − 1/n₁ ),  W = g_n₂(U) + g_n₃(V)    rational
//!     U = |cos(mθ/4)|, V = |sin(mθ/4)|,  g_p(t) = t / (p + (1 − p)t)
//! ```
//!
//! The rational radius (Blanc–Schlick replacement of the powers) is within some ten per cent
//! of the standard one, and creased at every zero of U and V whatever the exponents: it is
//! for previews and for the first stage of fitting.
//!
//! Sources: J. Gielis, *A generic geometric transformation* (2003); Y. D. Fougerolle et al.,
//! *Rational supershapes for surface reconstruction*; the constants of the rational radius
//! are corrected, see the crate's tests.

use super::{ParamError, check};
use crate::{Dual, Interval, Real};

/// Which formula gives the radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Radius {
    /// Real powers.
    #[default]
    Standard,
    /// Rational functions in place of powers; `a` and `b` must be 1.
    Rational,
}

/// A Gielis curve, in polar form about the origin.
///
/// | parameter | range | meaning |
/// |---|---|---|
/// | `m` | whole number, 0 to 64 | rotational symmetry: number of corners |
/// | `n1` | 0.05 to 1000 | sharpness: large n1 with n2 = n3 nearby gives polygons |
/// | `n2`, `n3` | 0.1 to 1000 | shape of the lobes |
/// | `a`, `b` | 0.01 to 100 | scale of the cosine and the sine; 1 for the rational radius |
///
/// The ratio max(n2, n3)/n1 is at most 100 (beyond, radii run over astronomic ranges).
///
/// ```
/// use rvachev::{Gielis, Radius};
///
/// let curve = Gielis::new(5.0, 3.0, 2.0, 8.0);
/// assert!((curve.radius(0.3, Radius::Standard) - 1.0490573465444).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gielis {
    /// Rotational symmetry, a whole number.
    pub m: f64,
    /// Outer exponent.
    pub n1: f64,
    /// Exponent of the cosine.
    pub n2: f64,
    /// Exponent of the sine.
    pub n3: f64,
    /// Scale of the cosine.
    pub a: f64,
    /// Scale of the sine.
    pub b: f64,
}

impl Gielis {
    /// The curve with `a = b = 1`.
    #[must_use]
    pub fn new(m: f64, n1: f64, n2: f64, n3: f64) -> Gielis {
        Gielis { m, n1, n2, n3, a: 1.0, b: 1.0 }
    }

    /// The unit circle.
    #[must_use]
    pub fn circle() -> Gielis {
        Gielis::new(0.0, 1.0, 1.0, 1.0)
    }

    /// Nearly a regular polygon with `sides` sides, their middles at radius 1 (one at the
    /// angle 0) and the corners at `1/cos(π/sides)`. Sides are straight to about 0.3 % of the
    /// radius for five sides and more (2.3 % for three), and exactly for four. Corners are
    /// rounded off at a radius of about `1/sharpness`; `sharpness` is n1, 20 to 1000.
    #[must_use]
    pub fn polygon(sides: u32, sharpness: f64) -> Gielis {
        let sides = f64::from(sides.max(3));
        let kappa = -2.0 * (std::f64::consts::PI / sides).cos().log2();
        Gielis::new(sides, sharpness, kappa * sharpness, kappa * sharpness)
    }

    /// The radius at the angle `theta` (radians).
    #[must_use]
    pub fn radius(&self, theta: f64, radius: Radius) -> f64 {
        self.radius_at(theta, radius)
    }

    /// The radius and its derivative with respect to the angle.
    #[must_use]
    pub fn radius_slope(&self, theta: f64, radius: Radius) -> (f64, f64) {
        let r = self.radius_at(Dual::variable(theta, 0), radius);
        (r.value(), r.gradient()[0])
    }

    /// Checks the parameters; names are prefixed with `curve`.
    pub(super) fn check(&self, curve: &str, radius: Radius) -> Result<(), ParamError> {
        let name = |field: &str| format!("{curve}.{field}");
        check::within(&name("m"), self.m, 0.0, 64.0)?;
        if self.m.fract() != 0.0 {
            return Err(ParamError::new(name("m"), self.m, "whole numbers from 0 to 64"));
        }
        check::within(&name("n1"), self.n1, 0.05, 1000.0)?;
        check::within(&name("n2"), self.n2, 0.1, 1000.0)?;
        check::within(&name("n3"), self.n3, 0.1, 1000.0)?;
        let ratio = self.condition();
        if ratio > 100.0 {
            return Err(ParamError::new(name("n2/n1 or n3/n1"), ratio, "at most 100"));
        }
        match radius {
            Radius::Standard => {
                check::within(&name("a"), self.a, 0.01, 100.0)?;
                check::within(&name("b"), self.b, 0.01, 100.0)
            }
            Radius::Rational if self.a != 1.0 => Err(ParamError::new(name("a"), self.a, "1 for the rational radius")),
            Radius::Rational if self.b != 1.0 => Err(ParamError::new(name("b"), self.b, "1 for the rational radius")),
            Radius::Rational => Ok(()),
        }
    }

    /// How much the radius magnifies relative errors: `max(n2, n3)/n1`.
    pub(super) fn condition(&self) -> f64 {
        self.n2.max(self.n3) / self.n1
    }

    /// By how much, relative to itself, the radius may be off on lanes of `f32`. Powers below
    /// 1 have unbounded slopes at the zeros of the sine and cosine, which lanes know to some
    /// 10⁻⁷ per quarter turn.
    pub(super) fn roundoff(&self) -> f64 {
        let smallest = self.n2.min(self.n3);
        let angle = 3e-7 * (1.0 + 0.25 * self.m) / self.a.min(self.b).min(1.0);
        let steep = if smallest < 1.0 { 2.0 * angle.powf(smallest) / self.n1 } else { 0.0 };
        (4e-6 * self.condition().max(1.0) * (1.0 + self.m / 12.0)).max(steep)
    }

    /// The radius of an angle in [−π, π].
    #[inline(always)]
    pub(super) fn radius_at<R: Real>(&self, theta: R, radius: Radius) -> R {
        let (sin, cos) = (theta * (0.25 * self.m)).sin_cos();
        match radius {
            Radius::Standard => {
                // In logarithms: no exponent overflows, and |cos| = 0 is no special case.
                let c = (cos.abs() * (1.0 / self.a)).log2() * self.n2;
                let s = (sin.abs() * (1.0 / self.b)).log2() * self.n3;
                (c.log2_sum_exp2(s) * (-1.0 / self.n1)).exp2()
            }
            Radius::Rational => {
                let w = rational_power(cos.abs(), self.n2) + rational_power(sin.abs(), self.n3);
                let scale = (-1.0 / self.n1).exp2();
                let ratio = w.lift(scale * 2.0 / self.n1) / w;
                ratio + scale * (1.0 - 1.0 / self.n1)
            }
        }
    }

    /// A bound from above on `weight(θ)·r(θ)` over the curve and one from below on r, close
    /// to 10⁻⁴ of the true ones. `weight` is a function of the angle, at most 1.
    pub(super) fn extremes(
        &self,
        radius: Radius,
        domain: Interval,
        weight: fn(Dual<Interval>) -> Dual<Interval>,
    ) -> (f64, f64) {
        const PIECES: usize = 4096;
        let width = domain.width() / PIECES as f64;
        let (mut most, mut least) = (0.0f64, f64::INFINITY);
        for piece in 0..PIECES {
            let lo = domain.lo() + piece as f64 * width;
            let angle = Dual::variable(Interval::new(lo, lo + width).inflate(1e-12), 0);
            let r = self.radius_at(angle, radius);
            let weighted = weight(angle) * r;
            // The mean-value form is closer than the direct one where the curve is smooth.
            let middle = Dual::constant(Interval::point(lo + 0.5 * width));
            let mean = (weight(middle) * self.radius_at(middle, radius)).value();
            let reach = weighted.gradient()[0].magnitude() * 0.5 * (width + 2e-12);
            most = most.max(weighted.value().hi().min(mean.hi() + reach));
            least = least.min(r.value().lo());
        }
        (most, least)
    }
}

/// Blanc and Schlick's stand-in for `t^p` on [0, 1]: `t / (p + (1 − p)t)`.
#[inline(always)]
fn rational_power<R: Real>(t: R, p: f64) -> R {
    t / t.scale_add(1.0 - p, t.lift(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rational_powers_compose() {
        let twice = rational_power(rational_power(0.4, 3.0), 2.0);
        assert!((twice - 0.1).abs() < 1e-15);
        assert!((rational_power(0.4, 6.0) - 0.1).abs() < 1e-15);
    }
}
