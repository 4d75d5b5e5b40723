//! Laws: functions of z that a taper or a twist follows.
//!
//! ```text
//!     LINEAR  v₀ + k z                          WAVE   m + a sin(2π z/λ + φ)
//!     SMOOTH STEP  v₀ + (v₁ − v₀) t²(3 − 2t),   t = clamp((z − z₀)/(z₁ − z₀), 0, 1)
//!     TABLE   straight between points, held beyond the first and the last
//! ```

use std::fmt::Debug;

use crate::{Angle, Bounds, Interval, Real};
use crate::{COORDINATE_LIMIT, ParamError, check};

/// A function of z, written once over [`Real`], that
/// [`Solid::taper_by`](../struct.Solid.html#method.taper_by) and
/// [`Solid::twist_by`](../struct.Solid.html#method.twist_by) follow: the factor that a section is
/// scaled by, the number that an angle is multiplied by. An `f64` is the constant law;
/// [`LinearLaw`], [`SmoothStep`], [`SineWave`] and [`LawTable`] are ready made.
///
/// Mark `at` and every helper in it `#[inline(always)]`.
///
/// ```
/// use rvachev::field::Real;
/// use rvachev::law::Law;
/// use rvachev::Solid;
/// use glam::DVec3;
///
/// /// A waist: 1 far away, `waist` at z = 0.
/// #[derive(Clone, Debug)]
/// struct Waist {
///     waist: f64,
/// }
///
/// impl Law for Waist {
///     #[inline(always)]
///     fn at<R: Real>(&self, z: R) -> R {
///         -(z.lift(1.0 - self.waist) / (z.square() + 1.0)) + 1.0
///     }
/// }
///
/// let vase = Solid::cylinder(1.0, 6.0).taper_by(Waist { waist: 0.5 }, Waist { waist: 0.5 });
/// assert!(!vase.contains(DVec3::new(0.6, 0.0, 0.0))?);
/// assert!(vase.contains(DVec3::new(0.9, 0.0, 2.9))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
pub trait Law: Debug + Clone + Send + Sync + 'static {
    /// Whether its values are known to change as its derivatives say, without jumps: what is
    /// deformed by it then has tighter bounds. The laws that are ready made do not jump.
    const CONTINUOUS: bool = false;

    /// The value at height z.
    fn at<R: Real>(&self, z: R) -> R;

    /// Whether every parameter is in its range. The default finds nothing wrong.
    ///
    /// # Errors
    /// The first parameter that is not.
    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

/// The constant law.
impl Law for f64 {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        z.lift(*self)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::finite("law", *self)
    }
}

/// A straight line: `at_zero + slope · z`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `at_zero` | that of the value | ±10⁹ |
/// | `slope` | value per length | ±10⁹ |
///
/// ```
/// use rvachev::law::{Law, LinearLaw};
///
/// assert_eq!(LinearLaw { at_zero: 1.0, slope: -0.25 }.at(2.0), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearLaw {
    /// Value at z = 0.
    pub at_zero: f64,
    /// Change of the value per length unit of z.
    pub slope: f64,
}

impl Law for LinearLaw {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        z.scale_add(self.slope, z.lift(self.at_zero))
    }

    fn check(&self) -> Result<(), ParamError> {
        check::finite("law.at_zero", self.at_zero)?;
        check::finite("law.slope", self.slope)
    }
}

/// A smooth step from one value to another, level before and after:
/// `t²(3 − 2t)` of the way, `t = clamp((z − z₀)/(z₁ − z₀), 0, 1)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `from`, `to` | (z, value): length, that of the value | z of `to` above that of `from` by 10⁻⁹ or more; ±10⁹ |
///
/// ```
/// use rvachev::law::{Law, SmoothStep};
///
/// let step = SmoothStep { from: (-1.0, 1.0), to: (1.0, 3.0) };
/// assert_eq!([step.at(-5.0), step.at(0.0), step.at(1.0)], [1.0, 2.0, 3.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothStep {
    /// Where it begins: z and value.
    pub from: (f64, f64),
    /// Where it ends: z and value.
    pub to: (f64, f64),
}

impl Law for SmoothStep {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        let ((z0, v0), (z1, v1)) = (self.from, self.to);
        let half = 0.5 * (z1 - z0);
        // With u = 2t − 1 in [−1, 1] it is ½ + u(3 − u²)/4: odd in u, and an interval keeps
        // more of it.
        let u = ((z - (z0 + half)) * (1.0 / half)).max(z.lift(-1.0)).min(z.lift(1.0));
        (u * (-u.square() + 3.0)).scale_add(0.25 * (v1 - v0), z.lift(0.5 * (v0 + v1)))
    }

    fn check(&self) -> Result<(), ParamError> {
        for (name, (z, value)) in [("from", self.from), ("to", self.to)] {
            check::finite(&format!("law.{name} (z)"), z)?;
            check::finite(&format!("law.{name} (value)"), value)?;
        }
        check::length("law.to (z above that of from)", self.to.0 - self.from.0)
    }
}

/// A sine wave: `mean + amplitude · sin(2π z / wavelength + phase)`.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `mean`, `amplitude` | that of the value | ±10⁹ |
/// | `wavelength` | length | 10⁻⁹ to 10⁹ |
/// | `phase` | [`Angle`] | ±10⁹ degrees |
///
/// ```
/// use rvachev::law::SineWave;
/// use rvachev::{Solid, deg};
/// use glam::DVec3;
///
/// let wave = SineWave { mean: 1.0, amplitude: 0.2, wavelength: 2.0, phase: deg(0.0) };
/// let bellows = Solid::cylinder(1.0, 8.0).taper_by(wave, wave);
/// assert!(bellows.contains(DVec3::new(1.15, 0.0, 0.5))?);
/// assert!(!bellows.contains(DVec3::new(0.85, 0.0, 1.5))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SineWave {
    /// The value about which it swings.
    pub mean: f64,
    /// How far it swings to either side.
    pub amplitude: f64,
    /// Length of a period along z, in length units.
    pub wavelength: f64,
    /// Phase at z = 0.
    pub phase: Angle,
}

impl Law for SineWave {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        let angle = z.scale_add(std::f64::consts::TAU / self.wavelength, z.lift(self.phase.radians()));
        angle.sin_cos().0.scale_add(self.amplitude, z.lift(self.mean))
    }

    fn check(&self) -> Result<(), ParamError> {
        check::finite("law.mean", self.mean)?;
        check::finite("law.amplitude", self.amplitude)?;
        check::length("law.wavelength", self.wavelength)?;
        check::angle("law.phase", self.phase, -1e9, 1e9)
    }
}

/// Straight lines between points, level before the first and after the last. Its cost is in
/// proportion to the number of points.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `points` | (z, value): length, that of the value | 1 to 1000 points, z rising by 10⁻⁹ or more; ±10⁹ |
///
/// ```
/// use rvachev::law::{Law, LawTable};
///
/// let table = LawTable::new([(0.0, 1.0), (2.0, 2.0), (3.0, 0.5)]);
/// assert_eq!([table.at(-1.0), table.at(1.0), table.at(2.5), table.at(9.0)], [1.0, 1.5, 1.25, 0.5]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LawTable {
    points: Vec<(f64, f64)>,
    /// Between neighbours: the middle, half the length, and half the slope.
    pieces: Vec<[f64; 3]>,
    /// Mean of the first and the last value.
    mean: f64,
}

impl LawTable {
    /// The law through `points`, each z and value, in rising order of z.
    #[must_use]
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> LawTable {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let piece = |pair: &[(f64, f64)]| {
            let ((z0, v0), (z1, v1)) = (pair[0], pair[1]);
            [0.5 * z0 + 0.5 * z1, 0.5 * (z1 - z0), (v1 - v0) / (z1 - z0)]
        };
        let value = |point: Option<&(f64, f64)>| point.map_or(0.0, |point| point.1);
        let mean = 0.5 * (value(points.first()) + value(points.last()));
        LawTable { pieces: points.windows(2).map(piece).collect(), mean, points }
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }
}

impl Law for LawTable {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        // Each piece adds its rise, from −½ of it before the piece to +½ after.
        let mut sum = z.lift(self.mean);
        for [middle, half, slope] in &self.pieces {
            let within = (z - *middle).max(z.lift(-half)).min(z.lift(*half));
            sum = within.scale_add(*slope, sum);
        }
        sum
    }

    fn check(&self) -> Result<(), ParamError> {
        check::within("law.points (how many)", self.points.len() as f64, 1.0, 1000.0)?;
        for (i, (z, value)) in self.points.iter().enumerate() {
            check::finite(&format!("law.points[{i}] (z)"), *z)?;
            check::finite(&format!("law.points[{i}] (value)"), *value)?;
        }
        for (i, pair) in self.points.windows(2).enumerate() {
            check::length(&format!("law.points[{}] (z above that of the one before)", i + 1), pair[1].0 - pair[0].0)?;
        }
        Ok(())
    }
}

/// Into how many slices of z a box is cut to follow a law.
const SLICES: u32 = 64;

/// The box cut into slices of z; an unbounded one is one slice.
pub(super) fn slices(b: &Bounds) -> Vec<Bounds> {
    let (low, high) = (b.min.z, b.max.z);
    if !(low.is_finite() && high.is_finite()) {
        return vec![*b];
    }
    let at = |i: u32| if i == SLICES { high } else { low + (high - low) * f64::from(i) / f64::from(SLICES) };
    let slice = |i: u32| {
        let mut slice = *b;
        (slice.min.z, slice.max.z) = (at(i), at(i + 1));
        slice
    };
    (0..SLICES).map(slice).collect()
}

/// The range of a law over a slice, from a few parts of it.
pub(super) fn law_range(law: impl Fn(Interval) -> Interval, z: Interval) -> Interval {
    const PARTS: u32 = 4;
    if !z.width().is_finite() {
        return law(z);
    }
    let at = |i: u32| if i == PARTS { z.hi() } else { z.lo() + z.width() * f64::from(i) / f64::from(PARTS) };
    let part = |i: u32| law(Interval::new(at(i), at(i + 1)));
    (1..PARTS).map(part).fold(part(0), Interval::hull)
}

/// Whether a law is from `lo` to `hi` over the heights of a box, by ranges over parts that are
/// halved where they do not tell.
pub(super) fn check_law(name: &str, law: &impl Law, b: &Bounds, lo: f64, hi: f64) -> Result<(), ParamError> {
    if b.is_empty() {
        return Ok(());
    }
    const PATIENCE: usize = 4_000;
    let allowed = |v: f64| v >= lo && v <= hi;
    let fault = |z: f64| {
        let value = law.at(z);
        let over = format_args!("{lo} to {hi} over the solid, z from {} to {}", b.min.z, b.max.z).to_string();
        ParamError::new(format_args!("{name} at z = {z}"), value, over)
    };
    let held = |z: f64| z.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT);
    let mut pending = vec![Interval::new(held(b.min.z), held(b.max.z))];
    for _ in 0..PATIENCE {
        let Some(z) = pending.pop() else { return Ok(()) };
        for end in [z.lo(), z.mid(), z.hi()] {
            if !allowed(law.at(end)) {
                return Err(fault(end));
            }
        }
        let range = law.at(z);
        if allowed(range.lo()) && allowed(range.hi()) {
            continue;
        }
        pending.extend([Interval::new(z.mid(), z.hi()), Interval::new(z.lo(), z.mid())]);
    }
    // It touches a limit, or hides: wherever it was looked at it is in range, and where it is
    // not it is held.
    Ok(())
}
