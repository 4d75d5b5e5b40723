//! Angles, with their unit in the type.

use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// An angle: [`deg`]`(30.0)`, [`rad`]`(0.5)`, [`turns`]`(0.25)`.
///
/// Whatever takes an angle takes `impl Into<Angle>`, which a bare number is not. Positive angles
/// turn from x towards y, from y towards z, from z towards x. A rate of twist is an angle too: by
/// how much a unit of length is turned.
///
/// | operation | gives |
/// |---|---|
/// | `a + b`, `a - b`, `-a`, `a * 2.0`, `2.0 * a`, `a / 3.0`, a sum | an angle |
/// | `a / b` | a number: how many times `b` |
/// | `a == b`, `a < b` | by the radians, exactly |
/// | `{a}` | degrees to nine digits: `30°` |
/// | `{a:?}` | radians in full: `0.5 rad` |
///
/// Held in radians. Any number is allowed; what takes an angle says which range it accepts, in
/// degrees.
///
/// ```
/// use rvachev::{deg, rad, turns, Solid};
///
/// let bar = Solid::cuboid([8.0, 1.0, 1.0]);
/// assert!(bar.rotate_z(deg(90.0)).contains([0.0, 3.9, 0.0])?);
/// assert!(bar.rotate_z(turns(0.25)).contains([0.0, 3.9, 0.0])?);
/// assert_eq!((2.0 * deg(45.0)).sin_cos(), (1.0, 0.0));
/// assert_eq!(format!("{} {}", deg(30.0) + deg(7.5), rad(0.5)), "37.5° 28.6478898°");
/// # Ok::<(), rvachev::SolidError>(())
/// ```
///
/// ```compile_fail
/// // In which unit?
/// let bar = rvachev::Solid::cuboid([8.0, 1.0, 1.0]).rotate_z(90.0);
/// ```
#[derive(Clone, Copy, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Angle {
    radians: f64,
}

/// An angle in degrees, 360 to a turn.
///
/// ```
/// use rvachev::deg;
///
/// assert_eq!(deg(180.0).radians(), std::f64::consts::PI);
/// ```
#[must_use]
pub const fn deg(degrees: f64) -> Angle {
    Angle { radians: degrees.to_radians() }
}

/// An angle in radians, 2π to a turn.
///
/// ```
/// use rvachev::rad;
///
/// assert_eq!(rad(std::f64::consts::PI).degrees(), 180.0);
/// ```
#[must_use]
pub const fn rad(radians: f64) -> Angle {
    Angle { radians }
}

/// An angle in whole turns.
///
/// ```
/// use rvachev::{deg, turns};
///
/// assert_eq!(turns(0.5), deg(180.0));
/// ```
#[must_use]
pub const fn turns(turns: f64) -> Angle {
    Angle { radians: turns * std::f64::consts::TAU }
}

impl Angle {
    /// No angle at all.
    pub const ZERO: Angle = rad(0.0);

    /// A right angle.
    pub const QUARTER_TURN: Angle = turns(0.25);

    /// A straight angle.
    pub const HALF_TURN: Angle = turns(0.5);

    /// All the way round.
    pub const FULL_TURN: Angle = turns(1.0);

    /// The angle in radians.
    #[must_use]
    #[inline(always)]
    pub const fn radians(self) -> f64 {
        self.radians
    }

    /// The angle in degrees.
    #[must_use]
    pub const fn degrees(self) -> f64 {
        self.radians.to_degrees()
    }

    /// The angle in turns.
    #[must_use]
    pub const fn turns(self) -> f64 {
        self.radians / std::f64::consts::TAU
    }

    /// The size of the angle.
    #[must_use]
    pub const fn abs(self) -> Angle {
        rad(self.radians.abs())
    }

    /// Whether the angle is neither infinite nor NaN.
    #[must_use]
    pub const fn is_finite(self) -> bool {
        self.radians.is_finite()
    }

    /// Sine and cosine, exactly 0 and ±1 at quarter turns; NaN of what is not finite.
    ///
    /// In double precision `cos(π/2)` is 6·10⁻¹⁷. So an angle within four units in the last place
    /// of a quarter turn counts as that quarter turn.
    ///
    /// ```
    /// use rvachev::deg;
    ///
    /// assert_eq!(deg(-270.0).sin_cos(), (1.0, 0.0));
    /// assert!((deg(30.0).sin_cos().0 - 0.5).abs() < 1e-15);
    /// ```
    #[must_use]
    #[inline]
    pub fn sin_cos(self) -> (f64, f64) {
        use std::f64::consts::FRAC_PI_2;
        let quarters = (self.radians / FRAC_PI_2).round();
        let off = (self.radians - quarters * FRAC_PI_2).abs();
        // A comparison that does not hold of NaN.
        let is_quarter = off <= 4.0 * f64::EPSILON * self.radians.abs();
        if !is_quarter {
            return self.radians.sin_cos();
        }
        match quarters.rem_euclid(4.0) {
            0.0 => (0.0, 1.0),
            1.0 => (1.0, 0.0),
            2.0 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        }
    }
}

impl fmt::Display for Angle {
    /// In degrees, to nine digits or with the decimals asked for: `{:.1}`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(decimals) = f.precision() {
            return write!(f, "{:.decimals$}°", self.degrees());
        }
        let degrees: f64 = format!("{:.8e}", self.degrees()).parse().unwrap_or(f64::NAN);
        // No negative zero.
        write!(f, "{}°", degrees + 0.0)
    }
}

impl fmt::Debug for Angle {
    /// In radians, with all digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} rad", self.radians)
    }
}

impl Neg for Angle {
    type Output = Angle;

    fn neg(self) -> Angle {
        rad(-self.radians)
    }
}

impl Add for Angle {
    type Output = Angle;

    fn add(self, other: Angle) -> Angle {
        rad(self.radians + other.radians)
    }
}

impl Sub for Angle {
    type Output = Angle;

    fn sub(self, other: Angle) -> Angle {
        rad(self.radians - other.radians)
    }
}

impl AddAssign for Angle {
    fn add_assign(&mut self, other: Angle) {
        *self = *self + other;
    }
}

impl SubAssign for Angle {
    fn sub_assign(&mut self, other: Angle) {
        *self = *self - other;
    }
}

impl Mul<f64> for Angle {
    type Output = Angle;

    fn mul(self, times: f64) -> Angle {
        rad(self.radians * times)
    }
}

impl Mul<Angle> for f64 {
    type Output = Angle;

    fn mul(self, angle: Angle) -> Angle {
        angle * self
    }
}

impl Div<f64> for Angle {
    type Output = Angle;

    fn div(self, parts: f64) -> Angle {
        rad(self.radians / parts)
    }
}

impl Div for Angle {
    type Output = f64;

    fn div(self, other: Angle) -> f64 {
        self.radians / other.radians
    }
}

impl Sum for Angle {
    fn sum<I: Iterator<Item = Angle>>(angles: I) -> Angle {
        angles.fold(Angle::ZERO, Add::add)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::*;

    #[test]
    fn units_agree() {
        for quarter in -9i32..=9 {
            let n = f64::from(quarter);
            assert_eq!(deg(90.0 * n).radians(), n * FRAC_PI_2, "{quarter}");
            assert_eq!(turns(0.25 * n).radians(), n * FRAC_PI_2, "{quarter}");
            assert_eq!(deg(90.0 * n).degrees(), 90.0 * n, "{quarter}");
        }
        assert_eq!([Angle::QUARTER_TURN, Angle::HALF_TURN, Angle::FULL_TURN], [90.0, 180.0, 360.0].map(deg));
        assert_eq!(Angle::FULL_TURN.radians(), TAU);
        assert_eq!((rad(PI).turns(), rad(-1.0).abs(), Angle::default()), (0.5, rad(1.0), Angle::ZERO));
    }

    #[test]
    fn quarter_turns_are_exact() {
        for quarter in -9i32..=9 {
            let want = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarter.rem_euclid(4) as usize];
            assert_eq!(deg(90.0 * f64::from(quarter)).sin_cos(), want, "{quarter}");
            assert_eq!(rad(f64::from(quarter) * FRAC_PI_2).sin_cos(), want, "{quarter}");
        }
        assert_eq!(rad(1e-300).sin_cos(), (1e-300, 1.0));
        assert_eq!(rad(1.0).sin_cos(), 1f64.sin_cos());
        for i in -1000..1000 {
            let degrees = 0.731 * f64::from(i);
            let (sin, cos) = deg(degrees).sin_cos();
            let (s, c) = degrees.to_radians().sin_cos();
            assert!((sin - s).abs() < 1e-14 && (cos - c).abs() < 1e-14, "{degrees}");
        }
        for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (sin, cos) = rad(angle).sin_cos();
            assert!(sin.is_nan() && cos.is_nan(), "{angle}");
            assert!(!deg(angle).is_finite());
        }
    }

    #[test]
    fn arithmetic_and_order() {
        let (a, b) = (rad(1.5), rad(0.25));
        assert_eq!([a + b, a - b, -a, a * 2.0, 2.0 * a, a / 2.0], [1.75, 1.25, -1.5, 3.0, 3.0, 0.75].map(rad));
        assert_eq!(a / b, 6.0);
        assert!(b < a && deg(60.0) > rad(1.0));
        let mut sum = a;
        sum += b;
        sum -= a;
        assert_eq!(sum, b);
        assert_eq!([a, b, b].into_iter().sum::<Angle>(), rad(2.0));
    }

    #[test]
    fn texts_tell_the_unit() {
        assert_eq!(deg(30.0).to_string(), "30°");
        assert_eq!(deg(-0.0).to_string(), "0°");
        assert_eq!(format!("{:.1}", rad(1.0)), "57.3°");
        assert_eq!(format!("{:?}", rad(0.1)), "0.1 rad");
        assert_eq!(deg(f64::NAN).to_string(), "NaN°");
    }
}
