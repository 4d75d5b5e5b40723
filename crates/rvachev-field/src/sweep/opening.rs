//! Opening about the z axis: what cuts a revolved solid off.
//!
//! ```text
//!     turned so that its middle is the x axis, and mirrored to y ≥ 0:
//!     t = x cos β + |y| sin β,  s = x sin β − |y| cos β        β half the angle
//!     f = s where t ≥ 0, else ∓√(s² + t²): the axis is nearest
//! ```

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;

use super::super::outlined::Outlined;
use super::super::{Field, ParamError, check};
use crate::{Angle, Bounds, Euclid, Interval, Real};

/// The points whose angle about z, counted from the x axis, is between 0 and `angle`; by true
/// distance.
#[derive(Clone, Debug)]
pub struct Opening {
    /// How far it is open.
    pub angle: Angle,
}

impl Field for Opening {
    fn name(&self) -> &'static str {
        "revolve_by"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let half = 0.5 * self.angle.radians();
        let (sin, cos) = half.sin_cos();
        let (x, y) = (x.scale_add(cos, y * sin), x.scale_add(-sin, y * cos).abs());
        let s = x.scale_add(sin, y * -cos);
        let t = x.scale_add(cos, y * sin);
        let beyond = t.min(x.lift(0.0));
        let distance = s.norm_as(beyond, Euclid);
        t.select(s, if half <= FRAC_PI_2 { -distance } else { distance })
    }

    fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::ALL;
        if self.angle <= Angle::HALF_TURN {
            bounds.min.y = 0.0;
        }
        if self.angle <= Angle::QUARTER_TURN {
            bounds.min.x = 0.0;
        }
        bounds
    }

    fn check(&self) -> Result<(), ParamError> {
        check::angle("angle", self.angle, 1e-4, 360.0)
    }

    fn convex(&self) -> bool {
        self.angle <= Angle::HALF_TURN
    }

    fn exact(&self) -> bool {
        true
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        // Slope at most 1: from the middle of the box, and by the formula itself.
        let [x, y, _] = region;
        let radius = DVec2::new(0.5 * x.width(), 0.5 * y.width()).length();
        let reach = x.magnitude() + y.magnitude();
        let direct = self.over(region);
        if !radius.is_finite() {
            return direct;
        }
        let middle = self.at([x.mid(), y.mid(), 0.0]);
        direct.narrowed_by(Interval::around(middle, radius + 1e-14 * reach))
    }

    fn roundoff(&self, reach: f64) -> f64 {
        2e-6 * reach
    }
}
