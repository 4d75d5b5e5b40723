//! Regular polygon.
//!
//! The plane is folded by reflections into the wedge of half a side; each of them, at the
//! mirror line of the middle of what is left, halves the angle:
//!
//! ```text
//!     0 ≤ θ ≤ kπ/n   →   0 ≤ θ ≤ ⌈k/2⌉π/n          k = n, ⌈n/2⌉, …, 1
//! ```
//!
//! so that any number of sides n takes ⌈log₂ n⌉ of them.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::super::{Field, ParamError, check};
use super::column;
use crate::{Bounds, Euclid, Interval, Real};

/// The largest number of sides, and the reflections that it takes.
const MOST_SIDES: u32 = 1024;
const MOST_FOLDS: usize = 10;

/// A regular polygon about the origin of the plane, by true distance (1-Lipschitz). The middle
/// of a side is on the positive x axis.
///
#[doc = picture!("profile_regular_polygon" = "docs/gallery/profile_regular_polygon.png")]
///
/// The point is folded to half a side, (u along its normal, v along it from its middle):
/// `f = inscribed radius − u` inside, `−|(u − inscribed radius, max(v − side/2, 0))|` outside.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `sides` | none | 3 to 1024 |
/// | `radius` | length | 10⁻⁹ to 10⁹: the distance of the corners from the centre |
///
/// ```
/// use rvachev::{Profile, RegularPolygon};
/// use glam::DVec2;
///
/// // A hexagon two units across its flats.
/// let hexagon = RegularPolygon::across_flats(6, 2.0);
/// assert!((hexagon.radius() - 1.1547005383792517).abs() < 1e-15);
/// let inside = Profile::from(hexagon).value(DVec2::new(0.75, 0.0))?;
/// assert!((inside - 0.25).abs() < 1e-15);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegularPolygon {
    sides: u32,
    radius: f64,
    /// Distance of the sides from the centre, and half their length.
    inscribed: f64,
    half_side: f64,
    /// Normals of the lines of reflection, towards the part that is folded over.
    folds: [DVec2; MOST_FOLDS],
    count: usize,
}

impl RegularPolygon {
    /// The polygon with `sides` sides and its corners at `radius`; both are checked when the
    /// profile is compiled.
    #[must_use]
    pub fn new(sides: u32, radius: f64) -> RegularPolygon {
        let step = PI / f64::from(sides.max(1));
        let mut folds = [DVec2::ZERO; MOST_FOLDS];
        let mut count = 0;
        let mut left = sides;
        while left > 1 && count < MOST_FOLDS {
            left = left.div_ceil(2);
            let (sin, cos) = (f64::from(left) * step).sin_cos();
            folds[count] = DVec2::new(-sin, cos);
            count += 1;
        }
        let (sin, cos) = step.sin_cos();
        RegularPolygon { sides, radius, inscribed: radius * cos, half_side: radius * sin, folds, count }
    }

    /// The polygon whose inscribed circle has the diameter `width`: for an even number of
    /// sides the distance of opposite sides.
    #[must_use]
    pub fn across_flats(sides: u32, width: f64) -> RegularPolygon {
        RegularPolygon::new(sides, 0.5 * width / (PI / f64::from(sides.max(3))).cos())
    }

    /// The number of sides.
    #[must_use]
    pub fn sides(&self) -> u32 {
        self.sides
    }

    /// The distance of the corners from the centre.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The distance of the sides from the centre.
    #[must_use]
    pub fn inscribed_radius(&self) -> f64 {
        self.inscribed
    }
}

impl Field for RegularPolygon {
    fn name(&self) -> &'static str {
        "regular polygon"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, _]: [R; 3]) -> R {
        let zero = x.lift(0.0);
        let (mut x, mut y) = (x, y.abs());
        let mut i = 0;
        while i < self.count {
            let normal = self.folds[i];
            let over = x.scale_add(normal.x, y * normal.y).max(zero);
            x = over.scale_add(-2.0 * normal.x, x);
            y = over.scale_add(-2.0 * normal.y, y);
            i += 1;
        }
        let out = x - self.inscribed;
        let along = (y - self.half_side).max(zero);
        -(out.max(zero).norm_as(along, Euclid) + out.min(zero))
    }

    fn bounds(&self) -> Bounds {
        let side = self.support(DVec3::Y);
        let mut bounds = column(DVec2::new(self.inscribed, side));
        bounds.min.x = -self.support(-DVec3::X);
        bounds
    }

    fn check(&self) -> Result<(), ParamError> {
        check::within("sides", f64::from(self.sides), 3.0, f64::from(MOST_SIDES))?;
        check::length("radius", self.radius)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<RegularPolygon> {
        let left = RegularPolygon::new(self.sides, self.radius * (1.0 - depth / self.inscribed));
        left.check().is_ok().then_some(left)
    }

    fn range(&self, [x, y, _]: [Interval; 3]) -> Interval {
        // Between the inscribed and the circumscribed circle; the tangent does the rest.
        let distance = x.norm_as(y, Euclid);
        Interval::new((-distance + self.inscribed).lo(), (-distance + self.radius).hi().min(self.inscribed))
            .inflate(1e-14 * self.radius)
    }

    fn support(&self, d: DVec3) -> f64 {
        if d.z != 0.0 {
            return f64::INFINITY;
        }
        // The corner nearest to the direction; corners are at the odd multiples of π/n.
        let step = PI / f64::from(self.sides.max(1));
        let turns = d.y.atan2(d.x) / (2.0 * step);
        let corner = (2.0 * turns.floor() + 1.0) * step;
        self.radius * (DVec2::from_angle(corner).dot(d.truncate())) + 1e-14 * self.radius * d.length()
    }

    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * self.radius.min(reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance by going through all sides.
    fn direct(sides: u32, radius: f64, p: DVec2) -> f64 {
        let corner = |i: u32| radius * DVec2::from_angle((2.0 * f64::from(i) + 1.0) * PI / f64::from(sides));
        let (mut least, mut inside) = (f64::INFINITY, true);
        for i in 0..sides {
            let (a, b) = (corner(i), corner(i + 1));
            let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            least = least.min((p - a - along * (b - a)).length());
            inside &= (b - a).perp_dot(p - a) > 0.0;
        }
        if inside { least } else { -least }
    }

    #[test]
    fn folding_gives_the_distance_to_the_nearest_side() {
        for sides in [3, 4, 5, 6, 7, 8, 9, 11, 12, 17, 31, 33, 100, 1023, 1024] {
            let polygon = RegularPolygon::new(sides, 1.3);
            for i in 0..300 {
                let t = |k: f64| 6.0 * ((f64::from(i) * k).fract() - 0.5);
                let p = DVec2::new(t(0.618_034), t(0.414_214));
                let got = polygon.eval([p.x, p.y, 0.0]);
                assert!((got - direct(sides, 1.3, p)).abs() < 1e-14, "{sides} sides at {p}: {got}");
            }
        }
    }
}
