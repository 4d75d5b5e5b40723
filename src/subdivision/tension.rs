//! The tension of the scheme: its mask and limit stencil, level by level.
//!
//! ```text
//!     α_k = cos(β/2^k)    trigonometric, 0 < β ≤ π         α_0 = cos β
//!     α_k = 1             cubic B-spline
//!     α_k = cosh(β/2^k)   hyperbolic
//!
//!     p'_2i     = ( p_(i−1) + (2 + 4α)·p_i + p_(i+1) ) / (4 + 4α)      α = α_k of the new level
//!     p'_(2i+1) = ( p_i + p_(i+1) ) / 2
//!
//!     limit     = p_i + w·(p_(i−1) − 2p_i + p_(i+1)),  w = (b − sin b) / (2b(1 − cos b)),  b = β/2^k
//!     tangent   = (p_(i+1) − p_(i−1)) / (2b)           per radian
//! ```
//!
//! The mask of a level has that level's α, not the one of the level before: with the latter the
//! square does not become a circle (its radius varies from 0.500 to 0.579).
//!
//! Source: G. Morin, J. Warren, H. Weimer, *A subdivision scheme for surfaces of revolution*
//! (2001); the limit stencil is derived here.

use super::SubdivisionError;
use crate::{Angle, deg, rad};

/// The tension of a control polygon: which functions its limit curve reproduces besides lines.
///
/// | tension | α₀ | reproduces |
/// |---|---|---|
/// | trigonometric, step β | cos β, in [−1, 1) | cos and sin: circles, ellipses, their graphs |
/// | cubic | 1 | parabolas: it is the uniform cubic B-spline |
/// | hyperbolic, step β | cosh β > 1 | cosh and sinh: hyperbolas |
///
/// ```
/// use std::f64::consts::PI;
/// use rvachev::subdivision::Tension;
/// use rvachev::deg;
///
/// // A square stands for steps of a right angle.
/// let square = Tension::trigonometric(deg(90.0))?;
/// assert!(square.alpha(0).abs() < 1e-15);
/// let [neighbour, own] = square.limit_weights(0);
/// assert!((neighbour - (0.5 - 1.0 / PI)).abs() < 1e-15 && (own - 2.0 / PI).abs() < 1e-15);
/// assert!(Tension::new(-1.5).is_err());
/// # Ok::<(), rvachev::subdivision::SubdivisionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tension {
    kind: Kind,
    /// The step β of level 0, in radians (of hyperbolic angle); 0 for the cubic one.
    step: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Trigonometric,
    Cubic,
    Hyperbolic,
}

/// The largest hyperbolic step: cosh 30 is 5·10¹².
const LARGEST_STEP: f64 = 30.0;

/// The smallest hyperbolic step: its cosh has long been 1 in double precision.
const SMALLEST_STEP: f64 = 1e-10;

/// The level whose step is that of all above it.
const DEEPEST: u32 = 900;

impl Tension {
    /// The cubic B-spline.
    pub const CUBIC: Tension = Tension { kind: Kind::Cubic, step: 0.0 };

    /// The tension for points at steps of `step` about a centre, 10⁻⁸ to 180 degrees: a whole
    /// turn over m for a polygon of m sides.
    ///
    /// # Errors
    /// [`SubdivisionError::Tension`] for another step.
    pub fn trigonometric(step: impl Into<Angle>) -> Result<Tension, SubdivisionError> {
        let step = step.into();
        let allowed = "10⁻⁸ to 180 degrees";
        if (deg(1e-8)..=Angle::HALF_TURN).contains(&step) {
            Ok(Tension { kind: Kind::Trigonometric, step: step.radians() })
        } else {
            Err(SubdivisionError::Tension { parameter: "step", value: step.degrees(), allowed })
        }
    }

    /// The tension for points at steps of `step` along a hyperbola, 10⁻¹⁰ to 30.
    ///
    /// # Errors
    /// [`SubdivisionError::Tension`] for another step.
    pub fn hyperbolic(step: f64) -> Result<Tension, SubdivisionError> {
        let allowed = "10⁻¹⁰ to 30";
        if (SMALLEST_STEP..=LARGEST_STEP).contains(&step) {
            Ok(Tension { kind: Kind::Hyperbolic, step })
        } else {
            Err(SubdivisionError::Tension { parameter: "step", value: step, allowed })
        }
    }

    /// The tension by its number α₀: −1 to 1 trigonometric, 1 cubic, above 1 hyperbolic.
    ///
    /// # Errors
    /// [`SubdivisionError::Tension`] for a number below −1, above cosh 30, or NaN.
    pub fn new(alpha: f64) -> Result<Tension, SubdivisionError> {
        if alpha == 1.0 {
            Ok(Tension::CUBIC)
        } else if (-1.0..1.0).contains(&alpha) {
            Tension::trigonometric(rad(alpha.acos()))
        } else if alpha > 1.0 && alpha <= LARGEST_STEP.cosh() {
            Tension::hyperbolic(alpha.acosh())
        } else {
            Err(SubdivisionError::Tension { parameter: "alpha", value: alpha, allowed: "−1 to 5·10¹²" })
        }
    }

    /// The step at a level, in radians or as a hyperbolic angle; 0 for the cubic one. Levels above
    /// 900 count as 900 here and below: steps are still above 0 there.
    #[must_use]
    pub fn step(&self, level: u32) -> f64 {
        self.step * 0.5f64.powi(level.min(DEEPEST) as i32)
    }

    /// α at a level: cos, 1 or cosh of its step.
    #[must_use]
    pub fn alpha(&self, level: u32) -> f64 {
        match self.kind {
            Kind::Trigonometric => self.step(level).cos(),
            Kind::Cubic => 1.0,
            Kind::Hyperbolic => self.step(level).cosh(),
        }
    }

    /// The weights of the mask that makes level `level` (1 or more) from the one before:
    /// `[1, 2 + 4α] / (4 + 4α)`, of each neighbour and of the point itself. (No mask makes level
    /// 0; asked for, it is that of level 1.)
    #[must_use]
    pub fn mask(&self, level: u32) -> [f64; 2] {
        let alpha = self.alpha(level.max(1));
        let neighbour = 0.25 / (1.0 + alpha);
        [neighbour, 1.0 - 2.0 * neighbour]
    }

    /// The weights of the limit stencil on points of a level: of each neighbour and of the point
    /// itself.
    #[must_use]
    pub fn limit_weights(&self, level: u32) -> [f64; 2] {
        let b = self.step(level);
        let square = if self.kind == Kind::Hyperbolic { -b * b } else { b * b };
        let neighbour = if b < 0.05 {
            // Here both forms have lost five digits to cancellation; the series has none to lose.
            1.0 / 6.0 + square * (1.0 / 180.0 + square / 5040.0)
        } else if self.kind == Kind::Hyperbolic {
            (b.sinh() - b) / (2.0 * b * (b.cosh() - 1.0))
        } else {
            (b - b.sin()) / (2.0 * b * (1.0 - b.cos()))
        };
        [neighbour, 1.0 - 2.0 * neighbour]
    }

    /// What the difference of both neighbours is multiplied by to give the limit tangent per
    /// radian; per control interval of that level for the cubic one.
    #[must_use]
    pub fn tangent_weight(&self, level: u32) -> f64 {
        if self.kind == Kind::Cubic { 0.5 } else { 0.5 / self.step(level) }
    }

    /// The tension of the polygon of a level, as that of a level 0.
    #[must_use]
    pub fn at_level(&self, level: u32) -> Tension {
        Tension { step: self.step(level), ..*self }
    }
}
