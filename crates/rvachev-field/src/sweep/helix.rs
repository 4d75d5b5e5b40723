//! Sweep along a helix about the z axis.
//!
//! ```text
//!     ψ = angle along the helix, its axis point at z = P ψ/2π      P the pitch
//!     (X, Y, Z)  →  x = √(X² + Y²) − R                             R the radius
//!                   y = Z − P ψ/2π,  ψ = atan2(Y, X) + 2πk
//!                   along = c·(Z − y)
//! ```
//!
//! The whole number k is that of the turn whose section has its middle nearest along z. It
//! needs no rounding: turned back by 2πZ/P about the axis, the point has the angle −2πy/P.
//! The map jumps half way between two turns, and next to them lie the turns above and below.
//! On the axis the angle, and so y, is anything; profiles stay clear of it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::super::ParamError;
use super::super::deform::Warp;
use super::super::dot;
use crate::{Bounds, Dual, Euclid, Interval, Real};

/// Which turn of the helix a point is seen from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The one whose middle is nearest.
    Nearest,
    /// The one above it.
    Above,
    /// The one below it.
    Below,
}

/// The map from space to a profile's plane, and along the helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HelixWarp {
    radius: f64,
    pitch: f64,
    /// 1 for a right-handed helix, −1 for a left-handed one.
    hand: f64,
    /// The middle of the profile along y.
    middle: f64,
    /// The factor of the coordinate along the helix.
    stretch: f64,
    turn: Turn,
    /// Which way round the angle to the nearest turn is measured.
    sheet: Sheet,
}

/// How the angle is measured from the middle of the nearest turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sheet {
    /// From −π to π.
    Both,
    /// From 0 to 2π.
    Ahead,
    /// From −2π to 0.
    Behind,
}

impl HelixWarp {
    /// `middle` is that of the profile along y; `stretch` the factor of the third coordinate,
    /// which runs along z otherwise.
    pub fn new(radius: f64, pitch: f64, left_handed: bool, middle: f64, stretch: f64, turn: Turn) -> HelixWarp {
        HelixWarp {
            radius,
            pitch,
            hand: if left_handed { -1.0 } else { 1.0 },
            middle,
            stretch,
            turn,
            sheet: Sheet::Both,
        }
    }

    /// How far the point is along z from the middle of the nearest turn's section.
    #[inline(always)]
    fn fold<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (sin, cos) = ((z - self.middle) * (TAU / self.pitch)).sin_cos();
        let y = y * self.hand;
        let (ahead, across) = (y.mul_add(cos, -(x * sin)), x.mul_add(cos, y * sin));
        let angle = match self.sheet {
            Sheet::Both => ahead.atan2(across),
            // From the opposite side there is no jump there.
            Sheet::Ahead => (-ahead).atan2(-across) + PI,
            Sheet::Behind => (-ahead).atan2(-across) - PI,
        };
        angle * (-self.pitch / TAU)
    }

    /// A point of space, by how far it is from the nearest turn's section.
    #[inline(always)]
    fn unwound<R: Real>(&self, p: [R; 3], fold: R) -> [R; 3] {
        let offset = match self.turn {
            Turn::Nearest => 0.0,
            Turn::Above => -self.pitch,
            Turn::Below => self.pitch,
        };
        let y = fold + (self.middle + offset);
        [p[0].norm_as(p[1], Euclid) - self.radius, y, (p[2] - y) * self.stretch]
    }

    /// Whether the angle, as it is measured, jumps within a box over which `fold` has this range.
    fn jumps(&self, fold: Interval) -> bool {
        let middle = match self.sheet {
            Sheet::Both => 0.0,
            Sheet::Ahead => PI,
            Sheet::Behind => -PI,
        };
        (fold * (-TAU / self.pitch) - middle).magnitude() >= PI * (1.0 - 1e-14)
    }
}

impl Warp for HelixWarp {
    const NAME: &'static str = "sweep_helix";
    const SWEEPS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        self.unwound(p, self.fold(p))
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        let along = p.z / self.stretch;
        let (sin, cos) = (TAU / self.pitch * along).sin_cos();
        let r = self.radius + p.x;
        DVec3::new(r * cos, self.hand * r * sin, along + p.y)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let reach = (self.radius + b.max.x).max(0.0);
        let along = [b.min.z, b.max.z].map(|z| z / self.stretch);
        Bounds::new(DVec3::new(-reach, -reach, along[0] + b.min.y), DVec3::new(reach, reach, along[1] + b.max.y))
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        // The same all round, however little of a turn there is.
        let across = direction.truncate().length();
        across * self.radius + own(DVec3::new(across, direction.z, direction.z / self.stretch))
    }

    fn check(&self, b: &Bounds) -> Result<(), ParamError> {
        if b.is_empty() {
            return Ok(());
        }
        let inward = -b.min.x;
        if self.radius.partial_cmp(&inward) != Some(std::cmp::Ordering::Greater) {
            return Err(ParamError::new(
                "radius",
                self.radius,
                format_args!("above {inward}, which the profile reaches towards the axis"),
            ));
        }
        let height = b.max.y - b.min.y;
        let least = 0.5 * height;
        if self.pitch < least || !height.is_finite() {
            return Err(ParamError::new(
                "pitch",
                self.pitch,
                format_args!("at least {least}, half the height of the profile (no more than three turns may meet)"),
            ));
        }
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        // The turns are counted by an angle that is rounded relative to itself.
        1e-6 * reach * self.stretch.max(1.0)
    }

    /// The angle's slopes are known without the turn that it is measured after:
    ///
    /// ```text
    /// ∂y/∂(X, Y, Z) = (P/2π·Y/r², −P/2π·X/r², 1),   r² = X² + Y²
    /// ```
    fn slopes(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        let hull = p.map(Dual::value);
        let fold = self.fold(hull);
        let [_, y, along] = self.unwound(hull, fold);
        let [y_slopes, along_slopes] = if self.jumps(fold) {
            // Slopes say nothing of the jump.
            [[Interval::ALL; 3]; 2]
        } else {
            let rise = self.hand * self.pitch / TAU;
            let squared = hull[0].square() + hull[1].square();
            let (a, b) = (hull[1] / squared * rise, hull[0] / squared * -rise);
            let level = [1.0, 0.0].map(Interval::point);
            [[a, b, level[0]], [a * -self.stretch, b * -self.stretch, level[1]]]
        };
        let chain = |row: [Interval; 3]| [0, 1, 2].map(|i| dot(row, p.map(|side| side.gradient()[i])));
        let across = p[0].norm_as(p[1], Euclid) - self.radius;
        [across, Dual::new(y, chain(y_slopes)), Dual::new(along, chain(along_slopes))]
    }

    fn sheets(&self, hull: [Interval; 3]) -> Option<[HelixWarp; 2]> {
        let sheets = [Sheet::Ahead, Sheet::Behind].map(|sheet| HelixWarp { sheet, ..*self });
        (self.jumps(self.fold(hull)) && !sheets[0].jumps(sheets[0].fold(hull))).then_some(sheets)
    }
}
