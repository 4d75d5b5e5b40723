//! Gielis curves: the radius of a supershape's sections.
//!
//! ```text
//!     r(θ) = ( |cos(mθ/4)/a|^n₂ + |sin(mθ/4)/b|^n₃ )^(−1/n₁)            standard
//!     r(θ) = 2^(−1/n₁)·( 2/(n₁W) + 1 − 1/n₁ ),  W = g_n₂(U) + g_n₃(V)    rational
//!     U = |cos(mθ/4)|, V = |sin(mθ/4)|,  g_p(t) = t / (p + (1 − p)t)
//! ```
//!
//! For m = P/Q that is not whole the curve runs several times about the origin before it closes
//! (after Q turns if P is even or the curve is symmetric, n₂ = n₃ and a = b; else after 2Q) and
//! crosses itself. Its turns make a region in two ways, both by R-functions of what the turns
//! bound one by one:
//!
//! ```text
//!     outer envelope   r(θ) = max over k of r(θ + 2πk)      disjunction
//!     inner core       r(θ) = min over k of r(θ + 2πk)      conjunction
//! ```
//!
//! The third way, and the only one where m is irrational, is the first turn alone, θ in [−π, π].
//!
//! Creases: r is even in θ, so the first turn always meets itself at θ = π, but with a corner
//! unless m is even, or odd with n₂ = n₃ and a = b. Envelopes have corners where turns cross.
//! At the zeros of the cosine an exponent n₂ of 1 makes a corner and one below 1 a cusp; alike
//! for n₃ and the sine.
//!
//! The rational radius (Blanc–Schlick replacement of the powers) is within some ten per cent
//! of the standard one, and creased at every zero of U and V whatever the exponents: it is
//! for previews and for the first stage of fitting.
//!
//! Sources: J. Gielis, *A generic geometric transformation* (2003); Y. D. Fougerolle et al.,
//! *Rational supershapes for surface reconstruction*; the constants of the rational radius
//! are corrected, see the crate's tests. Envelopes: Y. D. Fougerolle, F. Truchetet, J. Gielis,
//! *Potential fields of self-intersecting Gielis curves* (2009).

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{ParamError, check};
use crate::{Angle, Dual, OfOne, Real};

/// Envelopes are taken of curves that close within this many turns.
const MOST_TURNS: u32 = 16;

/// Which formula gives the radius of a [`Gielis`] curve.
///
#[doc = picture!(
    "supershape" = "docs/gallery/supershape.png",
    "supershape_rational_radius" = "docs/gallery/supershape_rational_radius.png",
)]
///
/// ```text
/// standard   r = (U^n₂ + V^n₃)^(−1/n₁)                  U = |cos(mθ/4)/a|, V = |sin(mθ/4)/b|
/// rational   r = 2^(−1/n₁)·(2/(n₁W) + 1 − 1/n₁)         W = g_n₂(U) + g_n₃(V)
///            g_p(t) = t/(p + (1 − p)t)                  for a = b = 1
/// ```
///
/// The rational one is within some ten per cent of the standard one and creased at every zero
/// of U and V: for previews and for the first stage of fitting.
///
/// Source of the rational radius: Y. D. Fougerolle et al., *Rational supershapes for surface
/// reconstruction*, with its constants put right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Radius {
    /// Real powers.
    #[default]
    Standard,
    /// Rational functions in place of powers; `a` and `b` must be 1.
    Rational,
}

/// Which turns of a curve about the origin count. Curves whose m is whole and even, or whole
/// with n2 = n3 and a = b, have one turn only.
///
#[doc = picture!(
    "supershape_outer" = "docs/gallery/supershape_outer.png",
    "supershape_inner" = "docs/gallery/supershape_inner.png",
)]
///
/// ```text
/// Principal   r(θ) for θ in [−π, π]
/// Outer       max over k of r(θ + 2πk)
/// Inner       min over k of r(θ + 2πk)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Turns {
    /// The first one, angles in [−π, π]: for any m.
    #[default]
    Principal,
    /// All of them, and what any of them encloses is inside (the outer envelope): m must be a
    /// fraction whose curve closes within 16 turns.
    Outer,
    /// All of them, and what all of them enclose is inside (the inner core): m as for `Outer`.
    Inner,
}

/// A Gielis curve, in polar form about the origin.
///
/// ```text
/// r(θ) = (|cos(mθ/4)/a|^n₂ + |sin(mθ/4)/b|^n₃)^(−1/n₁)
/// ```
///
/// For m = P/Q that is not whole the curve runs several times about the origin before it
/// closes; [`Turns`] says which of its turns count.
///
/// Creases: the first turn meets itself at θ = π with a corner unless m is even, or odd with
/// n2 = n3 and a = b; envelopes have corners where turns cross; at the zeros of the cosine an
/// n2 of 1 makes a corner and one below 1 a cusp, alike for n3 and the sine.
///
/// | parameter | range | meaning |
/// |---|---|---|
/// | `m` | any number, 0 to 64 | rotational symmetry: number of corners |
/// | `n1` | 0.05 to 1000 | sharpness: large n1 with n2 = n3 nearby gives polygons |
/// | `n2`, `n3` | 0.1 to 1000 | shape of the lobes |
/// | `a`, `b` | 0.01 to 100 | scale of the cosine and the sine; 1 for the rational radius |
/// | `turns` | [`Turns`] | what counts of a curve that runs about the origin several times |
///
/// The ratio max(n2, n3)/n1 is at most 100 (beyond, radii run over astronomic ranges).
///
/// Sources: J. Gielis, *A generic geometric transformation that unifies a wide range of natural
/// and abstract shapes* (2003); envelopes: Y. D. Fougerolle, F. Truchetet, J. Gielis,
/// *Potential fields of self-intersecting Gielis curves* (2009).
///
/// ```
/// use rvachev::{rad, Gielis, Radius, Turns};
///
/// let curve = Gielis::new(5.0, 3.0, 2.0, 8.0);
/// assert!((curve.radius(rad(0.3), Radius::Standard) - 1.0490573465444).abs() < 1e-12);
///
/// // m = 5/2 closes after two turns: a star whose arms cross, and the pentagon in its middle.
/// let star = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
/// assert_eq!(star.closing_turns(), Some(2));
/// assert!((star.radius(rad(0.4), Radius::Standard) - 1.4095026).abs() < 1e-7);
/// let core = star.with_turns(Turns::Inner);
/// assert!((core.radius(rad(0.4), Radius::Standard) - 1.0764467).abs() < 1e-7);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gielis {
    /// Rotational symmetry.
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
    /// The turns that count.
    pub turns: Turns,
}

impl Gielis {
    /// The first turn of the curve with `a = b = 1`.
    #[must_use]
    pub fn new(m: f64, n1: f64, n2: f64, n3: f64) -> Gielis {
        Gielis { m, n1, n2, n3, a: 1.0, b: 1.0, turns: Turns::Principal }
    }

    /// The outer envelope of the curve with m = `p`/`q` and `a = b = 1`.
    #[must_use]
    pub fn rational(p: u32, q: u32, n1: f64, n2: f64, n3: f64) -> Gielis {
        Gielis::new(f64::from(p) / f64::from(q), n1, n2, n3).with_turns(Turns::Outer)
    }

    /// The curve with other turns.
    #[must_use]
    pub fn with_turns(self, turns: Turns) -> Gielis {
        Gielis { turns, ..self }
    }

    /// After how many turns the curve closes; `None` if it takes more than 16, as it does for
    /// an irrational m.
    #[must_use]
    pub fn closing_turns(&self) -> Option<u32> {
        self.fraction().map(|(_, _, turns)| turns)
    }

    /// `m = P/Q` in lowest terms, and the turns to close.
    fn fraction(&self) -> Option<(f64, f64, u32)> {
        let symmetric = self.n2 == self.n3 && self.a == self.b;
        for q in 1..=MOST_TURNS {
            let multiple = self.m * f64::from(q);
            let p = multiple.round();
            // Fractions with such denominators are much farther apart.
            if (multiple - p).abs() <= 1e-9 {
                let turns = if symmetric || p % 2.0 == 0.0 { q } else { 2 * q };
                return (turns <= MOST_TURNS).then_some((p, f64::from(q), turns));
            }
        }
        None
    }

    /// The turns that count, resolved.
    pub(super) fn winding(&self) -> Winding {
        let sign = match self.turns {
            Turns::Principal => return Winding::Once,
            Turns::Outer => -1.0,
            Turns::Inner => 1.0,
        };
        match self.fraction() {
            Some((p, q, turns)) if turns > 1 => {
                // A turn moves mθ/4 by this angle, but for half-turns, which do not count.
                let (sin, cos) = (FRAC_PI_2 * (p % (2.0 * q)) / q).sin_cos();
                Winding::Many { turns, cos, sin, sign }
            }
            _ => Winding::Once,
        }
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

    /// The radius at the polar angle `theta`. Of a curve whose first turn counts, angles beyond
    /// half a turn either way are its further turns.
    #[must_use]
    pub fn radius(&self, theta: impl Into<Angle>, radius: Radius) -> f64 {
        self.radius_at(theta.into().radians(), radius, self.winding())
    }

    /// The radius at the polar angle `theta`, and its derivative per radian.
    #[must_use]
    pub fn radius_slope(&self, theta: impl Into<Angle>, radius: Radius) -> (f64, f64) {
        let r = self.radius_at(Dual::variable(theta.into().radians(), 0), radius, self.winding());
        (r.value(), r.gradient()[0])
    }

    /// Checks the parameters; names are prefixed with `curve`.
    pub(super) fn check(&self, curve: &str, radius: Radius) -> Result<(), ParamError> {
        let name = |field: &str| format!("{curve}.{field}");
        check::within(&name("m"), self.m, 0.0, 64.0)?;
        if self.turns != Turns::Principal && self.fraction().is_none() {
            let allowed = format!("for an envelope, fractions that close within {MOST_TURNS} turns");
            return Err(ParamError::new(name("m"), self.m, allowed));
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

    /// The angles, from 0 to π, at which the radius or its mirror image has a cusp; those of the
    /// first turn.
    pub(super) fn cusps(&self) -> impl Iterator<Item = f64> + use<> {
        let Gielis { m, n2, n3, .. } = *self;
        // The phase mθ/4 is a multiple of a quarter turn: the cosine is 0 at the odd ones.
        let is_cusp = move |k: &u32| if k % 2 == 1 { n2 < 1.0 } else { n3 < 1.0 };
        let last = if m > 0.0 { (0.5 * m).floor() as u32 } else { 0 };
        (0..=last).filter(move |k| m > 0.0 && is_cusp(k)).map(move |k| f64::from(k) * std::f64::consts::TAU / m)
    }

    /// Normals of the lines through the origin that cusps are on, those of the mirrored half too.
    pub(super) fn cusp_normals(&self) -> Vec<DVec3> {
        let mut normals: Vec<DVec3> = Vec::new();
        for angle in self.cusps().flat_map(|angle| [angle, -angle]) {
            let normal = DVec3::new(-angle.sin(), angle.cos(), 0.0);
            if normals.iter().all(|known| known.cross(normal).length() > 1e-9) {
                normals.push(normal);
            }
        }
        normals
    }

    /// Whether the curve of the standard radius is a circle.
    pub(super) fn is_circle(&self) -> bool {
        self.m == 0.0 || (self.n2 == 2.0 && self.n3 == 2.0 && self.a == self.b)
    }

    /// How much the radius magnifies relative errors: `max(n2, n3)/n1`.
    pub(super) fn condition(&self) -> f64 {
        self.n2.max(self.n3) / self.n1
    }

    /// By how much, relative to itself, the radius may be off on lanes of `f32`, whichever of
    /// its turns count. Powers below
    /// 1 have unbounded slopes at the zeros of the sine and cosine, which lanes know to some
    /// 10⁻⁷ per quarter turn.
    pub(super) fn roundoff(&self) -> f64 {
        let smallest = self.n2.min(self.n3);
        let steep = if smallest < 1.0 { 2.0 * self.phase_error().powf(smallest) / self.n1 } else { 0.0 };
        self.steady_roundoff().max(steep)
    }

    /// The same where slopes are not steep.
    pub(super) fn steady_roundoff(&self) -> f64 {
        4e-6 * self.condition().max(1.0) * (1.0 + self.m / 12.0)
    }

    /// How far off the phase mθ/4 may be on lanes of `f32`, in units of the scales of its sine and
    /// cosine.
    pub(super) fn phase_error(&self) -> f64 {
        3e-7 * (1.0 + 0.25 * self.m) / self.a.min(self.b).min(1.0)
    }

    /// The radius of an angle in [−π, π]. Lanes take [`Polar`].
    #[inline(never)]
    pub(super) fn radius_at<R: Real>(&self, theta: R, radius: Radius, winding: Winding) -> R {
        self.polar::<R, false>(theta, radius, winding)
    }

    /// One over the radius, without a division where there need be none.
    #[inline(never)]
    pub(super) fn inverse_radius_at<R: Real>(&self, theta: R, radius: Radius, winding: Winding) -> R {
        self.polar::<R, true>(theta, radius, winding)
    }

    #[inline(always)]
    fn polar<R: Real, const INVERSE: bool>(&self, theta: R, radius: Radius, winding: Winding) -> R {
        let curve = *self;
        match (radius, winding) {
            (Radius::Standard, Winding::Once) => {
                theta.of_one(&Polar::<false, false, INVERSE> { curve, winding, seam: false })
            }
            (Radius::Standard, _) => theta.of_one(&Polar::<false, true, INVERSE> { curve, winding, seam: false }),
            (Radius::Rational, Winding::Once) => {
                theta.of_one(&Polar::<true, false, INVERSE> { curve, winding, seam: false })
            }
            (Radius::Rational, _) => theta.of_one(&Polar::<true, true, INVERSE> { curve, winding, seam: false }),
        }
    }

    /// The radius of one turn, by the sine and cosine of the phase mθ/4.
    pub fn radius_of_phase<R: Real>(&self, sin: R, cos: R, radius: Radius) -> R {
        match radius {
            Radius::Standard => self.radius_of_sum::<R, false>(self.sum::<R, false>(sin, cos)),
            Radius::Rational => self.radius_of_sum::<R, true>(self.sum::<R, true>(sin, cos)),
        }
    }

    /// The radius that belongs to a sum of powers.
    #[inline(always)]
    fn radius_of_sum<R: Real, const RATIONAL: bool>(&self, sum: R) -> R {
        if RATIONAL {
            let scale = (-1.0 / self.n1).exp2();
            let ratio = sum.lift(scale * 2.0 / self.n1) / sum;
            ratio + scale * (1.0 - 1.0 / self.n1)
        } else {
            (sum * (-1.0 / self.n1)).exp2()
        }
    }

    /// What the radius of one turn is a falling function of: the logarithm of the sum of powers, or
    /// W.
    #[inline(always)]
    fn sum<R: Real, const RATIONAL: bool>(&self, sin: R, cos: R) -> R {
        if RATIONAL {
            rational_power(cos.abs(), self.n2) + rational_power(sin.abs(), self.n3)
        } else {
            // In logarithms: no exponent overflows, and |cos| = 0 is no special case.
            let c = (cos.abs() * (1.0 / self.a)).log2() * self.n2;
            let s = (sin.abs() * (1.0 / self.b)).log2() * self.n3;
            c.log2_sum_exp2(s)
        }
    }
}

/// The radius as a function of the angle, or one over it, of a curve whose kind is a type: lanes
/// are compiled with one kind each.
#[derive(Clone, Copy)]
pub(super) struct Polar<const RATIONAL: bool, const MANY: bool, const INVERSE: bool> {
    pub(super) curve: Gielis,
    pub(super) winding: Winding,
    /// Never true. Where the compiler does not know that, the branch on it parts what would be one
    /// block of some two thousand instructions, in which the compiler's scheduler puts the chains
    /// of several vectors one after the other to save registers: 2.4 times slower than side by
    /// side.
    pub(super) seam: bool,
}

impl<const RATIONAL: bool, const MANY: bool, const INVERSE: bool> Polar<RATIONAL, MANY, INVERSE> {
    /// The sum of powers over the turns that count.
    #[inline(always)]
    fn sum<R: Real>(&self, theta: R) -> R {
        let curve = &self.curve;
        let (sin, cos) = (theta * (0.25 * curve.m)).sin_cos();
        let mut sum = curve.sum::<R, RATIONAL>(sin, cos);
        if MANY && let Winding::Many { turns, cos: step_cos, sin: step_sin, sign } = self.winding {
            // The radius falls as the sum rises.
            sum = sum * sign;
            let (mut c, mut s) = (step_cos, step_sin);
            for _ in 1..turns {
                let turned = curve.sum::<R, RATIONAL>(sin.scale_add(c, cos * s), cos.scale_add(c, sin * -s));
                sum = sum.max(turned * sign);
                (c, s) = (c * step_cos - s * step_sin, s * step_cos + c * step_sin);
            }
            sum = sum * sign;
        }
        if self.seam {
            sum = -sum;
        }
        sum
    }
}

impl<const RATIONAL: bool, const MANY: bool, const INVERSE: bool> OfOne for Polar<RATIONAL, MANY, INVERSE> {
    #[inline(always)]
    fn value<R: Real>(&self, theta: R) -> R {
        let sum = self.sum(theta);
        if !INVERSE {
            self.curve.radius_of_sum::<R, RATIONAL>(sum)
        } else if RATIONAL {
            theta.lift(1.0) / self.curve.radius_of_sum::<R, true>(sum)
        } else {
            (sum * (1.0 / self.curve.n1)).exp2()
        }
    }
}

/// The turns that count of a curve, resolved when a shape is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Winding {
    /// One.
    Once,
    /// Several.
    Many {
        /// How many.
        turns: u32,
        /// Cosine and sine of the angle by which a turn moves mθ/4.
        cos: f64,
        /// See `cos`.
        sin: f64,
        /// 1 if the largest sum of powers counts (the inner core), −1 if the least.
        sign: f64,
    },
}

impl Winding {
    /// The same as a number of turns, perhaps one.
    #[inline(always)]
    pub(super) fn by_turns(self) -> Winding {
        match self {
            Winding::Once => Winding::Many { turns: 1, cos: 1.0, sin: 0.0, sign: 1.0 },
            many => many,
        }
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
