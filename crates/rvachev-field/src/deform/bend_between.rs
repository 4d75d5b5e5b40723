//! Bend between two heights, with straight ends.
//!
//! ```text
//!        z = to                        .-'/ end, moved
//!        |                          .-'  /  rigidly
//!        | L, arc                  (  Γ /
//!        |                    →    |
//!        z = from                  |
//!        |  end, left alone        |  left alone
//! ```
//!
//! With κ = Γ/L the arc's centre is at r = 1/κ, where r is the coordinate towards it. About the
//! middle of the arc the map is the same to both sides. There, with r and z counted from the
//! middle,
//!
//! ```text
//!     a = clamp(atan2(κZ, 1 − κR)/κ, ±L/2)        how far along the arc
//!     r = R cos κa − Z sin κa + 2κ s²,  s = sin(κa/2)/κ
//!     z = a + (R sin κa + Z cos κa − sin κa/κ)    the last term is 0 on the arc
//! ```
//!
//! and the middle stands turned by Γ/2 about the centre from where the lower end is left alone.
//! The cut of `atan2` is opposite to the middle, between the two ends.
//!
//! Source: A. H. Barr, *Global and local deformations of solid primitives* (1984).

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::{Bend, Warp, meets_cut};
use crate::{Angle, Bounds, Dual, Interval, Real};
use crate::{ParamError, check};
use rvachev_num::{figures, rad};

/// Bend of what is between two heights to an arc; what is below stays, what is above is moved
/// rigidly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendBetween {
    /// Where the arc begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// By how much the upper end is turned.
    pub turn: Angle,
    /// Direction towards the centre of curvature, from the x axis towards y; away from it for
    /// negative turns.
    pub angle: Angle,
}

impl BendBetween {
    /// Below this curvature a bend moves nothing that could be seen.
    const FLAT: f64 = 1e-30;

    #[inline(always)]
    fn length(&self) -> f64 {
        self.to - self.from
    }

    /// The curvature, without its sign.
    #[inline(always)]
    fn curvature(&self) -> f64 {
        self.turn.radians().abs() / self.length()
    }

    /// The direction towards the centre of curvature.
    #[inline(always)]
    fn inward(&self) -> DVec2 {
        self.turn.radians().signum() * DVec2::from_angle(self.angle.radians())
    }

    /// Across and along, about the middle of the arc, of a point in place.
    #[inline(always)]
    fn about_the_middle<R: Real>(&self, across: R, z: R) -> [R; 2] {
        let k = self.curvature();
        let (sin, cos) = (0.5 * k * self.length()).sin_cos();
        let up = z - z.lift(self.from);
        // (1 − cos)/κ, without a difference.
        let bow = 2.0 * k * ((0.25 * k * self.length()).sin() / k).powi(2);
        [across.scale_add(cos, up * -sin) + up.lift(bow), across.scale_add(sin, up * cos) - up.lift(sin / k)]
    }

    /// How far along the arc the point is, beyond its ends too.
    #[inline(always)]
    fn along<R: Real>(&self, [across, up]: [R; 2]) -> R {
        let k = self.curvature();
        (up * k).atan2(across.scale_add(-k, up.lift(1.0))) * (1.0 / k)
    }

    /// The pre-image, across and along, of a point about the middle of the arc, at a part of it.
    #[inline(always)]
    fn straightened<R: Real>(&self, [across, up]: [R; 2], along: R) -> [R; 2] {
        let k = self.curvature();
        let ((sin, cos), (half, _)) = ((along * k).sin_cos(), (along * (0.5 * k)).sin_cos());
        let left = across * cos - up * sin + half.square() * (2.0 / k);
        let beyond = across * sin + up * cos - sin * (1.0 / k);
        [left, along + beyond + along.lift(0.5 * (self.from + self.to))]
    }

    /// How far a box reaches towards the centre, and beyond the heights.
    fn reach(&self, b: &Bounds) -> [f64; 2] {
        let inward = self.inward().extend(0.0);
        let reach = b.corners().into_iter().map(|c| c.dot(inward)).fold(f64::NEG_INFINITY, f64::max);
        [if reach.is_nan() { f64::INFINITY } else { reach }, (self.from - b.min.z).max(b.max.z - self.to).max(0.0)]
    }

    /// Whether a solid that reaches so far towards the centre, and so far beyond the heights, can
    /// be turned by so much: it stays on this side of the centre, and its ends on either side of
    /// the cut.
    fn fits(&self, turn: f64, [reach, end]: [f64; 2]) -> bool {
        let k = turn / self.length();
        let left = 1.0 - k * reach;
        k < Self::FLAT || (left > 0.0 && 0.5 * turn + (k * end).atan2(left) < PI)
    }
}

impl Warp for BendBetween {
    const NAME: &'static str = "bend_between";

    /// Slopes have no bounds where it is cut.
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        if self.curvature() < Self::FLAT {
            return [x, y, z];
        }
        let DVec2 { x: cos, y: sin } = self.inward();
        let across = x.scale_add(cos, y * sin);
        let middle = self.about_the_middle(across, z);
        let half = 0.5 * self.length();
        let along = self.along(middle).max(z.lift(-half)).min(z.lift(half));
        let [left, up] = self.straightened(middle, along);
        let shift = left - across;
        [shift.scale_add(cos, x), shift.scale_add(sin, y), up]
    }

    /// Of a box that is all on the arc, or all of an end, what is known is not computed; only what
    /// [`inverse`](Warp::inverse) is off by rounding is added.
    fn slopes(&self, [x, y, z]: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        if self.curvature() < Self::FLAT {
            return [x, y, z];
        }
        let DVec2 { x: cos, y: sin } = self.inward();
        let across = x.scale_add(cos, y * sin);
        let middle = self.about_the_middle(across, z);
        let along = self.along(middle).value();
        let half = 0.5 * self.length();
        let [left, up] = if along.hi() < -half {
            [across, z]
        } else if along.lo() > half {
            self.straightened(middle, z.lift(half))
        } else if along.lo() > -half && along.hi() < half {
            let bend = Bend { curvature: self.curvature(), angle: rad(0.0) };
            let [left, _, up] = bend.inverse([middle[0], z.lift(0.0), middle[1]]);
            [left, up + z.lift(0.5 * (self.from + self.to))]
        } else {
            let image = self.inverse([x, y, z]);
            let [left, up] = middle.map(Dual::value);
            let k = self.curvature();
            return match meets_cut(up * k, left.scale_add(-k, Interval::point(1.0))) {
                true => image.map(|side| Dual::new(side.value(), [Interval::ALL; 3])),
                false => image,
            };
        };
        let far = across.value().magnitude() + z.value().magnitude() + self.from.abs() + self.to.abs();
        let rounding = Dual::constant(Interval::around(0.0, 16.0 * f64::EPSILON * far));
        let shift = left - across + rounding;
        [shift.scale_add(cos, x), shift.scale_add(sin, y), up + rounding]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let k = self.curvature();
        if k < Self::FLAT {
            return p;
        }
        let u = self.inward();
        let r = p.truncate().dot(u);
        let along = (p.z - self.from).clamp(0.0, self.length());
        let beyond = p.z - self.from - along;
        let (sin, cos) = (k * along).sin_cos();
        let bow = 2.0 / k * (0.5 * k * along).sin().powi(2);
        let across = bow + r * cos + beyond * sin;
        let up = sin / k - r * sin + beyond * cos;
        (p.truncate() + (across - r) * u).extend(self.from + up)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        if !b.is_finite() {
            return Bounds::ALL;
        }
        if self.curvature() < Self::FLAT {
            return *b;
        }
        let part = |low: f64, high: f64| {
            let part = Bounds::new(b.min.with_z(low.max(b.min.z)), b.max.with_z(high.min(b.max.z)));
            (part.min.z <= part.max.z).then_some(part)
        };
        let mut bounds = part(f64::NEG_INFINITY, self.from).unwrap_or(Bounds::EMPTY);
        let bend = Bend { curvature: self.curvature(), angle: rad(self.inward().to_angle()) };
        let raise = DVec3::Z * self.from;
        if let Some(arc) = part(self.from, self.to) {
            let image = bend.bounds(&Bounds::new(arc.min - raise, arc.max - raise));
            bounds = bounds.union(&Bounds::new(image.min + raise, image.max + raise));
        }
        if let Some(end) = part(self.to, f64::INFINITY) {
            let k = self.curvature();
            let ((sin, cos), u) = (self.turn.radians().abs().sin_cos(), self.inward());
            let bow = 2.0 / k * (0.5 * k * self.length()).sin().powi(2);
            for corner in end.corners() {
                let (r, beyond) = (corner.truncate().dot(u), corner.z - self.to);
                let across = bow + r * cos + beyond * sin;
                let image = (corner.truncate() + (across - r) * u).extend(self.from + sin / k - r * sin + beyond * cos);
                bounds = bounds.union(&Bounds::new(image, image));
            }
        }
        bounds.inflate(1e-14 * (b.min.abs().max(b.max.abs()).max_element() + bounds.longest_side()))
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        check::finite("from", self.from)?;
        check::finite("to", self.to)?;
        if self.length() < check::SMALLEST_LENGTH {
            return Err(ParamError::new("to", self.to, format_args!("at least 0.000000001 above from, {}", self.from)));
        }
        check::angle("turn", self.turn, -360.0, 360.0)?;
        check::angle("angle", self.angle, -1e9, 1e9)?;
        let (reach, turn) = (self.reach(b), self.turn.radians().abs());
        if self.fits(turn, reach) {
            return Ok(());
        }
        // What is allowed falls with the turn: halving finds the limit.
        let (mut low, mut high) = (0.0, turn.min(TAU));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.fits(middle, reach) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Err(ParamError::new(
            "turn",
            self.turn.degrees(),
            format_args!(
                "below {} degrees in absolute value: the box of the bent solid reaches {} towards the centre of \
                 curvature (the radius, (to - from)/turn in radians, must be beyond) and {} beyond from and to \
                 (the straight ends must not meet)",
                figures(rad(low).degrees(), 6),
                figures(reach[0], 6),
                figures(reach[1], 6)
            ),
        ))
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let far = reach + self.from.abs().max(self.to.abs());
        1e-6 * far * (1.0 + self.curvature() * far)
    }
}
