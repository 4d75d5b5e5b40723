//! Blends: joins that read values, not signs alone.
//!
//! ```text
//!     smooth        x∧y = min(x, y) − max(k − |x − y|, 0)²/(4k)
//!     displacement  R(x, y) + a₀/(1 + (x/a₁)² + (y/a₂)²)
//!     Ricci         G = ‖(G₁, G₂)‖_p for the intersection, 1/‖(1/G₁, 1/G₂)‖_p for the union
//!     fillet        a ball of the given radius rolls along the edge
//!     chamfer       a plane across the edge
//! ```
//!
//! A smooth blend is the join of its operands wherever their values differ by more than k,
//! so beside it the solid prunes as ever; a fillet and a chamfer, which read distances, are made
//! where solids are compiled. A displacement reaches everywhere, if weakly; a Ricci blend too.
//!
//! Sources: A. A. Pasko and V. V. Savchenko, *Blending operations for the functionally based
//! constructive geometry* (1994); A. Ricci, *A constructive geometry for computer graphics*
//! (1973). The smooth blend is the parabola that meets both operands with their slopes; it
//! rises with both operands and keeps their Lipschitz constant.

use super::rfunction::{PAnd, saturate};
use super::{ParamError, check};
use crate::{Euclid, NormKind, Real};

/// How operands are joined with the transition between them shaped.
///
/// ```text
/// Fillet         what a ball of this radius does not reach between the operands
/// Chamfer        max(x, y, (x + y)/√(2 + 2c) + leg·√((1 − c)/2)), c the cosine between the
///                operands' gradients: a plane that meets both surfaces at the leg from the edge
/// Smooth         x∧y = min(x, y) − max(radius − |x − y|, 0)²/(4·radius)
/// Displacement   x∧y = x + y − √(x² + y²) + height/(1 + (x/falloff₀)² + (y/falloff₁)²)
/// Ricci          G = (G₁^p + G₂^p)^(1/p) for the intersection, (G₁^−p + G₂^−p)^(−1/p) for
///                the union; the value is r·(1 − G)
///
/// x∨y = −(−x ∧ −y), but for the displacement, which is added to either
/// ```
///
/// Fillets and chamfers are lengths: they are of that size whatever the operands are, and never
/// rise above flush faces, between which there is no edge. The other blends read the operands'
/// values as they are, which may be no distances. The page `lengths` of `rvachev` explains them
/// with pictures.
///
/// A fillet of a union is between the plain union and its closing by the ball, and is the closing
/// where the operands are convex. An operand's own concave edges stay as they are away from the
/// joint. What the ball does not fit into is filled. Those of intersections and differences are the
/// same of complements: convex edges are rounded, and what is thinner than the ball is gone.
///
/// A chamfer reads values over their slopes, and stays within the closing by a ball of 16 legs. Its
/// legs are exact on planes, and wherever the angle between the operands stays the same away from
/// the edge, as on caps; elsewhere on round operands they are right to 2 % up to a twelfth of the
/// radius and to 7 % up to a quarter. Where an operand has an edge of its own across the joined
/// one, it goes round it in a mitre: the parts of unions, intersections and differences by min and
/// max have a face each, and so have the sides of boxes, cylinders, prisms, pyramids and wedges,
/// joined as they are, up to 64 pairs of them near the joint. Fillets and chamfers of operands have
/// none. Operands with a gap narrower than 0.28 of the leg are bridged.
///
/// A smooth blend adds wherever the operands' values differ by less than its radius. On flush faces
/// both values are the same, so that a union rises above them, by up to a quarter of the radius,
/// and an intersection or a difference sinks below.
///
/// | blend | parameters | reach |
/// |---|---|---|
/// | `Smooth` | `radius`, length, 10⁻⁹ to 10⁹ | where the operands' values differ by less than `radius`, flush faces included |
/// | `Fillet` | `radius`, length, 10⁻⁹ to 10⁹ | between the operands, where a ball of that radius does not reach |
/// | `Chamfer` | `leg`, length, 10⁻⁹ to 10⁹ | a flat face that begins that far from the edge on either operand; at a right angle it is `leg·√2` wide |
/// | `Displacement` | `height`, length (adds material if positive); `falloff`, lengths, 10⁻⁹ to 10⁹ | everywhere, falling with the square of the values |
/// | `Ricci` | `p`, 1.001 to 1000: larger is sharper | everywhere; operands must be gauges |
///
/// A smooth blend keeps the Lipschitz constant of its operands. What a fillet adds has one of 1
/// between convex operands, of at most 1.5 elsewhere. A chamfer has that of the operands where they
/// are planes; where they bend it is a little steeper, and it jumps where the gradient of one of
/// their parts does. A displacement and Ricci's blend promise none.
///
/// Sources: A. A. Pasko and V. V. Savchenko, *Blending operations for the functionally based
/// constructive geometry* (1994); A. Ricci, *A constructive geometry for computer graphics*
/// (1973); J. R. Rossignac and A. A. G. Requicha, *Constant-radius blending in solid modelling*
/// (1984).
///
/// ```
/// use rvachev::{Blend, Solid};
/// use glam::DVec3;
///
/// let plate = Solid::cuboid(DVec3::new(6.0, 6.0, 1.0));
/// let pin = Solid::cylinder(1.0, 4.0);
/// let part = plate.union_with(&pin, Blend::Fillet { radius: 0.5 });
/// // The ball of the fillet touches the plate at a distance of 0.5 from the pin.
/// assert!(part.contains(DVec3::new(1.1, 0.0, 0.6))?);
/// assert!(!part.contains(DVec3::new(1.5, 0.0, 0.6))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Blend {
    /// A smooth transition of compact support.
    ///
    #[doc = picture!(
        "smooth_union" = "docs/gallery/smooth_union.png",
        "smooth_intersection" = "docs/gallery/smooth_intersection.png",
        "smooth_difference" = "docs/gallery/smooth_difference.png",
    )]
    Smooth {
        /// Values that differ by less than this are blended; a union of equal values gains a
        /// quarter of it, as where faces of the operands are flush.
        radius: f64,
    },
    /// A rounding of constant radius along the edge where the operands meet, as a rolling ball
    /// leaves it.
    ///
    #[doc = picture!("fillet_union" = "docs/gallery/fillet_union.png")]
    Fillet {
        /// Radius of the ball.
        radius: f64,
    },
    /// A flat face along the edge where the operands meet.
    ///
    #[doc = picture!("chamfer_union" = "docs/gallery/chamfer_union.png")]
    Chamfer {
        /// How far from the edge the face begins, along the surface of either operand: what a
        /// drawing calls a 2 × 45° chamfer at a right angle is one of leg 2.
        leg: f64,
    },
    /// Pasko and Savchenko's displacement of the R-function with p = 2.
    ///
    #[doc = picture!(
        "displacement_union" = "docs/gallery/displacement_union.png",
        "displacement_intersection" = "docs/gallery/displacement_intersection.png",
        "displacement_difference" = "docs/gallery/displacement_difference.png",
    )]
    Displacement {
        /// a₀: how far values are moved where both operands are 0.
        height: f64,
        /// a₁ and a₂: the operands' values at which the displacement has fallen to half.
        falloff: [f64; 2],
    },
    /// Ricci's blend of gauges: spheres, superellipsoids, generalised superquadrics, supershapes,
    /// superpolygons and Ricci blends of these, moved, stretched and deformed. (An
    /// [`Ellipsoid`](crate::Ellipsoid) is a bound; a stretched sphere is a gauge.)
    ///
    #[doc = picture!(
        "ricci_union" = "docs/gallery/ricci_union.png",
        "ricci_intersection" = "docs/gallery/ricci_intersection.png",
        "ricci_difference" = "docs/gallery/ricci_difference.png",
    )]
    Ricci {
        /// The exponent.
        p: f64,
    },
}

impl Blend {
    /// What errors call a union, an intersection and a difference by this blend.
    #[doc(hidden)]
    #[must_use]
    pub fn names(&self) -> [&'static str; 3] {
        match self {
            Blend::Smooth { .. } => ["smooth union", "smooth intersection", "smooth difference"],
            Blend::Fillet { .. } => ["filleted union", "filleted intersection", "filleted difference"],
            Blend::Chamfer { .. } => ["chamfered union", "chamfered intersection", "chamfered difference"],
            Blend::Displacement { .. } => ["displaced union", "displaced intersection", "displaced difference"],
            Blend::Ricci { .. } => ["Ricci union", "Ricci intersection", "Ricci difference"],
        }
    }

    #[doc(hidden)]
    pub fn check(&self) -> Result<(), ParamError> {
        match *self {
            Blend::Smooth { radius } | Blend::Fillet { radius } => check::length("radius", radius),
            Blend::Chamfer { leg } => check::length("leg", leg),
            Blend::Displacement { height, falloff } => {
                check::finite("height", height)?;
                check::length("falloff[0]", falloff[0])?;
                check::length("falloff[1]", falloff[1])
            }
            Blend::Ricci { p } => check::within("p", p, 1.001, 1000.0),
        }
    }
}

/// Which set operation a Ricci blend is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RicciSide {
    /// The union.
    Union,
    /// The intersection.
    Intersection,
    /// The difference.
    Difference,
}

/// Smooth minimum.
#[inline(always)]
pub(super) fn smooth<R: Real>(x: R, y: R, width: f64) -> R {
    let overlap = (-(x - y).abs() + width).max(x.lift(0.0));
    x.min(y) - overlap.square() * (0.25 / width)
}

/// Smooth minimum and its slopes.
#[inline(always)]
pub(super) fn smooth_parts<R: Real>(x: R, y: R, width: f64) -> (R, R, R) {
    let one = x.lift(1.0);
    let half = x.lift(0.5);
    // From 1 where x is less by the width, through 1/2, to 0.
    let dx = ((y - x) * (0.5 / width) + half).max(x.lift(0.0)).min(one);
    (smooth(x, y, width), dx, one - dx)
}

/// Conjunction by R_p, p = 2, displaced.
#[inline(always)]
pub(super) fn displacement<R: Real>(x: R, y: R, height: f64, inverse: [f64; 2]) -> R {
    let and = saturate(x.monotone(y, &PAnd(Euclid)));
    let fall = (x * inverse[0]).square() + (y * inverse[1]).square() + 1.0;
    and + x.lift(height) / fall
}

/// A gauge is held above this, so that its inverse is finite.
const LEAST_GAUGE: f64 = 1e-6;

/// Ricci's blend of `x = r₁(1 − G₁)` and `y = r₂(1 − G₂)`.
#[inline(always)]
pub(super) fn ricci<R: Real, N: NormKind>(x: R, y: R, norm: N, side: RicciSide, radii: [f64; 2], radius: f64) -> R {
    let one = x.lift(1.0);
    let g = (x.scale_add(-1.0 / radii[0], one)).max(x.lift(LEAST_GAUGE));
    let h = (y.scale_add(-1.0 / radii[1], one)).max(x.lift(LEAST_GAUGE));
    let gauge = match side {
        RicciSide::Intersection => g.norm_as(h, norm),
        RicciSide::Difference => g.norm_as(one / h, norm),
        RicciSide::Union => one / (one / g).norm_as(one / h, norm),
    };
    gauge.scale_add(-radius, x.lift(radius))
}
