//! R-functions: set operations on fields, positive inside.
//!
//! ```text
//!     R_α    x∧y = (x + y − D)/(1 + α),      D² = x² + y² − 2αxy
//!     R_0^m  x∧y = (x + y − √(x²+y²))·(x²+y²)^(m/2)
//!     R_p    x∧y = x + y − (|x|^p + |y|^p)^(1/p)
//!     N_p    x∧y = (x^−p + y^−p)^(−1/p) where both > 0,
//!                  else −(max(−x,0)^p + max(−y,0)^p)^(1/p)
//!     D      x∧y = min(x, y) where both > 0, else −√(max(−x,0)² + max(−y,0)²)
//! ```
//!
//! and `x∨y = −(−x ∧ −y)` for each. They are evaluated in forms that keep the sign exact and
//! lose no digits: R_α as `2 min(s,0)/(1+α) + 2xy/(|s| + D)` with `s = x + y`, R_p as
//! `min(x,y) + min(0,s) − q` with `q = ‖(x,y)‖_p − max(|x|,|y|)`.
//!
//! The rims of extrusions are joined by two rules that move the surface: with u = x − s and v = y −
//! s, x and y the distances to the two faces and s the size,
//!
//! ```text
//!     rounded      u∧v = s + D(u, v)
//!     chamfered    u∧v = min(x, y, (x + y − s)/√2)
//! ```
//!
//! The sign, and so the solid, is that of min and max for every rule of the table. All but R_0^m
//! rise with both arguments.
//!
//! Sources: V. L. Rvachev (1982); V. Shapiro, *Semi-analytic geometry with R-functions*
//! (2007); Y. D. Fougerolle et al.

use std::f64::consts::FRAC_1_SQRT_2;

use super::blend::{self, RicciSide};
use super::excess::{ExcessKind, TINY};
use super::{ParamError, VALUE_LIMIT};
use crate::{Euclid, Interval, Joined, Monotone, Monotone3, Norm, NormKind, Op, Real};

/// How set operations combine values. All rules give the same solid; they differ in the
/// field around and inside it.
///
#[doc = picture!(
    "rule_min_max" = "docs/gallery/rule_min_max.png",
    "rule_alpha" = "docs/gallery/rule_alpha.png",
    "rule_zero" = "docs/gallery/rule_zero.png",
    "rule_p" = "docs/gallery/rule_p.png",
    "rule_associative" = "docs/gallery/rule_associative.png",
    "rule_distance" = "docs/gallery/rule_distance.png",
)]
///
/// ```text
/// Alpha(α)         x∧y = (x + y − √(x² + y² − 2αxy))/(1 + α)
/// Zero { m }       x∧y = (x + y − √(x² + y²))·(x² + y²)^(m/2)
/// P(p)             x∧y = x + y − (|x|^p + |y|^p)^(1/p)
/// Associative(p)   x∧y = (x^−p + y^−p)^(−1/p) where both are positive,
///                        else −(max(−x, 0)^p + max(−y, 0)^p)^(1/p)
/// Distance         x∧y = min(x, y) where both are positive,
///                        else −√(max(−x, 0)² + max(−y, 0)²)
///
/// x∨y = −(−x ∧ −y)
/// ```
///
/// | rule | field away from the surface | associative |
/// |---|---|---|
/// | `Alpha(1.0)` | min and max: 1-Lipschitz, creased where operands are equal | yes |
/// | `Alpha(α)`, −1 < α < 1 | analytic but at corners, slope up to 3.41 a level (α = 0) | no |
/// | `Zero { m }` | C^m even at corners; not of unit slope at the surface | no |
/// | `P(p)`, p ≥ 1.001 | unit slope at the surface to order p − 1 | no |
/// | `Associative(p)`, p ≥ 1.001 | unit slope to order p, the order of operands does not matter | yes |
/// | `Distance` | the true distance if operands have it and meet at right angles throughout | yes |
///
/// The operators `|`, `&`, `-`, `^`, `!` use `P(2.0)`. Meshing and rendering see the solid
/// only and cost the same for every rule.
///
/// Sources: V. L. Rvachev, *Theory of R-functions and some of its applications* (1982);
/// V. Shapiro, *Semi-analytic geometry with R-functions* (2007); Y. D. Fougerolle et al.
///
/// ```
/// use rvachev::{RFunction, Solid};
///
/// let (block, hole) = (Solid::cuboid([4.0, 4.0, 2.0]), Solid::cylinder(1.0, 3.0));
/// let rules = [RFunction::MIN_MAX, RFunction::Alpha(0.0), RFunction::P(4.0), RFunction::Associative(2.0)];
/// for rule in rules {
///     let plate = block.difference(&hole, rule);
///     assert!(plate.contains([1.5, 0.0, 0.5])? && !plate.contains([0.5, 0.0, 0.5])?);
/// }
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RFunction {
    /// R_α with −1 < α ≤ 1.
    Alpha(f64),
    /// R_0^m, m from 0 to 8.
    Zero {
        /// The order of smoothness.
        m: u32,
    },
    /// R_p with 1.001 ≤ p ≤ 1000.
    P(f64),
    /// N_p with 1.001 ≤ p ≤ 1000.
    Associative(f64),
    /// Min where both are inside, the Euclidean norm where they are outside.
    Distance,
}

impl Default for RFunction {
    fn default() -> RFunction {
        RFunction::P(2.0)
    }
}

impl RFunction {
    /// Min and max.
    pub const MIN_MAX: RFunction = RFunction::Alpha(1.0);

    /// `x ∧ y`: positive where both are.
    ///
    /// ```
    /// use rvachev::RFunction;
    ///
    /// let and = RFunction::P(2.0).and(0.3, -0.2);
    /// assert!((and - -0.260555127546399).abs() < 1e-14);
    /// ```
    #[must_use]
    pub fn and(self, x: f64, y: f64) -> f64 {
        f64::joined(Rule::from(self), Op::And, x, y)
    }

    /// `x ∨ y`: positive where either is.
    #[must_use]
    pub fn or(self, x: f64, y: f64) -> f64 {
        f64::joined(Rule::from(self), Op::Or, x, y)
    }

    /// Whether the order in which many operands are joined does not matter.
    #[must_use]
    pub fn associates(self) -> bool {
        matches!(Rule::from(self), Rule::MinMax | Rule::Associative(_) | Rule::Distance)
    }

    /// Whether the parameters are in their ranges.
    pub fn check(self) -> Result<(), ParamError> {
        let (parameter, value, lo) = match self {
            RFunction::Alpha(alpha) if alpha > -1.0 && alpha <= 1.0 => return Ok(()),
            RFunction::Alpha(alpha) => return Err(ParamError::new("alpha", alpha, "above -1, up to 1")),
            RFunction::Distance => return Ok(()),
            RFunction::Zero { m } if m <= 8 => return Ok(()),
            RFunction::Zero { m } => return Err(ParamError::new("m", f64::from(m), "0 to 8")),
            RFunction::P(p) | RFunction::Associative(p) => ("p", p, 1.001),
        };
        super::check::within(parameter, value, lo, 1000.0)
    }
}

/// An R-function with its special cases told apart, or a blend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Min and max.
    MinMax,
    /// R_α.
    Alpha(f64),
    /// R_0^m, m at least 1.
    Zero(u32),
    /// R_p.
    P(Norm),
    /// N_p.
    Associative(Norm),
    /// Smooth minimum over this width of values.
    Smooth(f64),
    /// R_p with p = 2 and a term that moves the surface.
    Displacement {
        /// a₀.
        height: f64,
        /// `1/a₁` and `1/a₂`.
        inverse: [f64; 2],
    },
    /// A norm of gauges.
    Ricci {
        /// The exponent of the norm.
        p: f64,
        /// Which set operation it is.
        side: RicciSide,
        /// Values are `radius·(1 − G)`: those of the operands and of the result.
        radii: [f64; 2],
        /// The radius of the result.
        radius: f64,
    },
    /// Min where both are inside, the Euclidean norm where they are outside.
    Distance,
    /// The edge between two faces rounded to this radius; operands are moved in by it.
    Rounded(f64),
    /// The edge between two faces cut at 45°, this leg from it; operands are moved in by it.
    Chamfered(f64),
}

impl From<RFunction> for Rule {
    fn from(function: RFunction) -> Rule {
        match function {
            RFunction::Alpha(1.0) => Rule::MinMax,
            RFunction::Alpha(alpha) => Rule::Alpha(alpha),
            RFunction::Zero { m: 0 } => Rule::P(Norm::Euclid),
            RFunction::Zero { m } => Rule::Zero(m),
            RFunction::P(p) => Rule::P(Norm::new(p)),
            RFunction::Associative(p) => Rule::Associative(Norm::new(p)),
            RFunction::Distance => Rule::Distance,
        }
    }
}

impl Rule {
    /// Whether the surface depends on the operands' values and not on their signs alone.
    pub fn reads_values(self) -> bool {
        matches!(
            self,
            Rule::Smooth(_) | Rule::Displacement { .. } | Rule::Ricci { .. } | Rule::Rounded(_) | Rule::Chamfered(_)
        )
    }

    /// Whether the value rises with those of the operands, or stays.
    pub fn rises(self) -> bool {
        !matches!(self, Rule::Zero(_) | Rule::Displacement { .. })
    }

    /// `x ∧ y`.
    #[inline(always)]
    pub fn and<R: Real>(self, x: R, y: R) -> R {
        match self {
            Rule::MinMax => x.min(y),
            Rule::Zero(m) => saturate(zero_and(x, y, m)),
            Rule::Displacement { height, inverse } => saturate(blend::displacement(x, y, height, inverse)),
            Rule::Ricci { p, side, radii, radius } => saturate(blend::ricci(x, y, Norm::new(p), side, radii, radius)),
            Rule::Alpha(alpha) => saturate(x.monotone(y, &AlphaAnd(alpha))),
            Rule::Smooth(width) => saturate(x.monotone(y, &SmoothAnd(width))),
            Rule::Distance => saturate(x.monotone(y, &DistanceAnd)),
            Rule::Rounded(radius) => saturate(x.monotone(y, &RoundedAnd(radius))),
            Rule::Chamfered(leg) => saturate(x.monotone(y, &ChamferedAnd(leg))),
            Rule::P(norm) => saturate(x.monotone(y, &PAnd(norm))),
            Rule::Associative(norm) => saturate(x.monotone(y, &AssociativeAnd(norm))),
        }
    }

    /// `x ∨ y`, by De Morgan.
    #[inline(always)]
    pub fn or<R: Real>(self, x: R, y: R) -> R {
        match self {
            Rule::MinMax => x.max(y),
            rule => -rule.and(-x, -y),
        }
    }
}

/// A value held within ±[`VALUE_LIMIT`].
#[inline(always)]
pub fn saturate<R: Real>(x: R) -> R {
    x.max(x.lift(-VALUE_LIMIT)).min(x.lift(VALUE_LIMIT))
}

/// Conjunction by a rule that rises with both arguments. Each is a type, so that lanes are compiled
/// with one rule each.
#[derive(Clone, Copy)]
pub(super) struct AlphaAnd(pub f64);

/// R_p.
#[derive(Clone, Copy)]
pub(super) struct PAnd<N>(pub N);

/// The associative R-function of exponent p.
#[derive(Clone, Copy)]
pub(super) struct AssociativeAnd<N>(pub N);

/// Smooth minimum.
#[derive(Clone, Copy)]
pub(super) struct SmoothAnd(pub f64);

/// What distances are joined by.
#[derive(Clone, Copy)]
pub(super) struct DistanceAnd;

/// Distances to two faces, each less the radius, to that of both with the edge rounded.
#[derive(Clone, Copy)]
pub(super) struct RoundedAnd(pub f64);

/// The same with the edge cut off, for a leg.
#[derive(Clone, Copy)]
pub(super) struct ChamferedAnd(pub f64);

impl Monotone for AlphaAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        alpha_and(x, y, self.0).0
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let (value, d) = alpha_and(x, y, self.0);
        let (dx, dy) = (alpha_slope(x, y, d, self.0), alpha_slope(y, x, d, self.0));
        (value, dx, dy)
    }
}

impl<N: ExcessKind> Monotone for PAnd<N> {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        let zero = x.lift(0.0);
        x.min(y) + (x + y).min(zero) - self.0.excess(x, y)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let (_, nx, ny) = x.norm_parts_as(y, self.0);
        (self.value(x, y), self.0.rest(x, y, nx), self.0.rest(y, x, ny))
    }
}

impl<N: NormKind> Monotone for AssociativeAnd<N> {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        let zero = x.lift(0.0);
        let (px, py) = (x.max(zero), y.max(zero));
        let both = px * (py / px.norm_as(py, self.0).max(x.lift(TINY)));
        both - x.min(zero).norm_as(y.min(zero), self.0)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let zero = x.lift(0.0);
        let (px, py) = (x.max(zero), y.max(zero));
        let (n, nx, ny) = px.norm_parts_as(py, self.0);
        let floor = n.max(x.lift(TINY));
        let (rx, ry) = (px / floor, py / floor);
        let (_, mx, my) = x.min(zero).norm_parts_as(y.min(zero), self.0);
        // Where both are positive (v/x)^(p+1) with v/x = y/‖·‖; else the slope of
        // the norm of the negative parts. On either side the other term is 0.
        let both = x.min(y);
        let dx = both.select(ny * ry * ry, -mx);
        let dy = both.select(nx * rx * rx, -my);
        (self.value(x, y), dx, dy)
    }
}

impl Monotone for SmoothAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        blend::smooth(x, y, self.0)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        blend::smooth_parts(x, y, self.0)
    }
}

impl Monotone for DistanceAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        let zero = x.lift(0.0);
        x.min(y).max(zero) - x.min(zero).norm_as(y.min(zero), Euclid)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let (zero, one) = (x.lift(0.0), x.lift(1.0));
        let first = (y - x).select(one, zero);
        let (_, nx, ny) = x.min(zero).norm_parts_as(y.min(zero), Euclid);
        // The slopes of a norm are those of the negative parts, which are negative; at
        // the corner itself the norm has none.
        let least = x.min(y);
        (Monotone::value(self, x, y), least.select(first, -nx), least.select(one - first, -ny))
    }

    fn only(&self, of: [Interval; 2]) -> Option<usize> {
        nearest(of)
    }
}

impl Monotone3 for DistanceAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R, z: R) -> R {
        let zero = x.lift(0.0);
        x.min(y).min(z).max(zero) - x.min(zero).nested_as(y.min(zero), z.min(zero), Euclid, Euclid)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R, z: R) -> (R, [R; 3]) {
        let (zero, one) = (x.lift(0.0), x.lift(1.0));
        let (first, second) = ((y.min(z) - x).select(one, zero), (z - y).select(one, zero));
        let others = one - first;
        let (_, [nx, ny, nz]) = x.min(zero).nested_parts_as(y.min(zero), z.min(zero), Euclid, Euclid);
        let least = x.min(y).min(z);
        let slopes =
            [least.select(first, -nx), least.select(others * second, -ny), least.select(others * (one - second), -nz)];
        (Monotone3::value(self, x, y, z), slopes)
    }

    fn only(&self, of: [Interval; 3]) -> Option<usize> {
        nearest(of)
    }
}

/// Which of some faces is the nearest throughout, where points are inside of all others.
fn nearest<const N: usize>(of: [Interval; N]) -> Option<usize> {
    (0..N).find(|&which| (0..N).all(|other| other == which || of[other].lo() > of[which].hi().max(0.0)))
}

impl Monotone for RoundedAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        Monotone::value(&DistanceAnd, x, y) + self.0
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let (value, dx, dy) = Monotone::parts(&DistanceAnd, x, y);
        (value + self.0, dx, dy)
    }
}

impl Monotone for ChamferedAnd {
    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R) -> R {
        (x.min(y) + self.0).min((x + y + self.0) * FRAC_1_SQRT_2)
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R) -> (R, R, R) {
        let (zero, one, half) = (x.lift(0.0), x.lift(1.0), x.lift(FRAC_1_SQRT_2));
        let (least, face) = (x.min(y) + self.0, (x + y + self.0) * FRAC_1_SQRT_2);
        let first = (y - x).select(one, zero);
        let above = face - least;
        (least.min(face), above.select(first, half), above.select(one - first, half))
    }
}

/// R_α conjunction, and its D.
#[inline(always)]
fn alpha_and<R: Real>(x: R, y: R, alpha: f64) -> (R, R) {
    let s = x + y;
    let xy = x * y;
    let like = (x - y).square() + xy * (2.0 * (1.0 - alpha));
    let unlike = s.square() - xy * (2.0 * (1.0 + alpha));
    let d = xy.select(like, unlike).sqrt();
    let zero = x.lift(0.0);
    let product = xy * 2.0 / (s.abs() + d).max(x.lift(TINY));
    (s.min(zero) * (2.0 / (1.0 + alpha)) + product, d)
}

/// The slope of R_α by x: `(1 − u/D)/(1 + α)` with u = x − αy, which is a small difference where y
/// is small beside x, and then `y²·(1 − α)/(D·(D + u))`.
#[inline(always)]
fn alpha_slope<R: Real>(x: R, y: R, d: R, alpha: f64) -> R {
    let tiny = x.lift(TINY);
    let (u, floor) = (x - y * alpha, d.max(tiny));
    let direct = (x.lift(1.0) - u / floor) * (1.0 / (1.0 + alpha));
    let small = (y / floor) * (y / (d + u).max(tiny)) * (1.0 - alpha);
    u.select(small.meet(direct), direct)
}

/// R_0^m conjunction: that of R_p with p = 2, times a power of the norm that flattens the
/// corner.
#[inline(always)]
pub(super) fn zero_and<R: Real>(x: R, y: R, m: u32) -> R {
    let and = saturate(x.monotone(y, &PAnd(Euclid)));
    let norm = x.norm_as(y, Euclid);
    let mut power = norm.lift(1.0);
    for _ in 0..m {
        power = saturate(power * norm);
    }
    and * power
}

#[cfg(test)]
mod tests {
    use rvachev_num::Dual;

    use super::*;

    #[test]
    fn slopes_by_a_large_argument_keep_their_digits() {
        let large = 1e6;
        let slope = |rule: Rule| rule.and(Dual::variable(large, 0), Dual::variable(1.0, 1)).gradient()[0];
        for alpha in [-0.9, 0.0, 0.5] {
            let (found, exact) = (slope(Rule::Alpha(alpha)), (1.0 - alpha) / 2.0 * large.powi(-2));
            assert!((found / exact - 1.0).abs() < 1e-5, "alpha {alpha}: {found:e} for {exact:e}");
        }
        for p in [1.5, 2.0, 3.0] {
            let (found, exact) = (slope(Rule::P(Norm::new(p))), (1.0 - 1.0 / p) * large.powf(-p));
            assert!((found / exact - 1.0).abs() < 1e-5, "p {p}: {found:e} for {exact:e}");
        }
    }

    /// The form for small arguments has no bound where they may have any size and sign.
    #[test]
    fn ranges_of_slopes_are_those_of_the_form_that_is_narrower() {
        let around = |place: f64, axis: usize| Dual::variable(Interval::new(place - 1.0, place + 1.0), axis);
        for norm in [1.5, 2.0, 3.0].map(Norm::new) {
            let rule = Rule::P(norm);
            let slope = rule.and(around(0.0, 0), around(0.0, 1)).gradient()[0];
            assert!(slope.lo() > -1e-9 && slope.hi() < 2.0 + 1e-9, "{norm:?}: {slope:?}");
            // Beside a far larger one, both forms hold it, and the small one is the narrower.
            let slope = rule.and(around(1e6, 0), around(0.0, 1)).gradient()[0];
            assert!(slope.lo() >= -1e-9 && slope.hi() < 1e-8, "{norm:?}: {slope:?}");
        }
    }
}
