//! Superhyperboloids of one and of two sheets, clipped.
//!
//! ```text
//!     one sheet, z      h = ‖(1, z/a₃)‖₁ − ‖(x/a₁, y/a₂)‖₂            ╲   ╱       ╲    ╱
//!     one sheet, x      h = ‖(1, x/a₁)‖₁ − ‖(y/a₂, z/a₃)‖₂             │ │         ╲__╱
//!     two sheets, z     h = |z/a₃| − ‖(1, ‖(x/a₁, y/a₂)‖₂)‖₁          ╱   ╲         __
//!     two sheets, x     h = |x/a₁| − ‖(y/a₂, ‖(1, z/a₃)‖₁)‖₂        one sheet      ╱  ╲
//!                                                                                two sheets
//!     f = min( s·h, length/2 − |z| )          |x| in the forms along x
//! ```
//!
//! with `‖·‖_i` the norm of exponent 2/e_i. The algebraic forms (`ρ^p − |z|^p = 1`) have the
//! same zero set but cancel; these differences of norms have bounded slopes, and `s` is one
//! over the largest of them.
//!
//! h moves one way with each of |x|, |y| and |z|, and so does the slab: ranges are two
//! evaluations. Along the axis the two pull against each other; where the sign is open, a
//! search for where they cross closes the gap.
//!
//! Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981), whose form
//! of two sheets is the one along x.

use glam::DVec3;

use super::outlined::Outlined;
use super::superellipsoid::{slope_norm, support_norm};
use super::{Case, Field, Kernel, ParamError, check};
use crate::{Bounds, Interval, Norm, Powers, Real};

/// The solid is at most this many times as long as its semi-axis.
const LONGEST: f64 = 2000.0;

/// What the boxes are widened by, for rounding.
const ROUNDING: f64 = 1e-13;

/// How the sheets lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sheets {
    One,
    Two,
}

/// A superhyperboloid about an axis through the origin, clipped at `±length/2` along it,
/// valued `f = min(s·h, length/2 − |z|)` in length units (|x| in the forms along x), where
/// `1/s` is the largest slope of h.
///
#[doc = picture!(
    "superhyperboloid_one_sheet" = "docs/gallery/superhyperboloid_one_sheet.png",
    "superhyperboloid_one_sheet_x" = "docs/gallery/superhyperboloid_one_sheet_x.png",
    "superhyperboloid_two_sheets" = "docs/gallery/superhyperboloid_two_sheets.png",
    "superhyperboloid_two_sheets_x" = "docs/gallery/superhyperboloid_two_sheets_x.png",
)]
///
/// ```text
/// one sheet, z      h = ‖(1, z/a₃)‖₁ − ‖(x/a₁, y/a₂)‖₂
/// one sheet, x      h = ‖(1, x/a₁)‖₁ − ‖(y/a₂, z/a₃)‖₂
/// two sheets, z     h = |z/a₃| − ‖(1, ‖(x/a₁, y/a₂)‖₂)‖₁
/// two sheets, x     h = |x/a₁| − ‖(y/a₂, ‖(1, z/a₃)‖₁)‖₂
///
/// ‖(u, v)‖ᵢ = (|u|^(2/eᵢ) + |v|^(2/eᵢ))^(eᵢ/2)
/// ```
///
/// 1-Lipschitz where both exponents are at most 2, and so never more than the distance;
/// beyond, no Lipschitz constant exists. It is not convex.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each |
/// | `e1` | none | 0.01 to 10: shapes the profile along the axis (0 straight, then a cone; 1 hyperbola; 2 two cones) |
/// | `e2` | none | 0.01 to 10: shapes the sections across it (0 square, 1 round, 2 bevelled) |
/// | `length` | length | 10⁻⁹ to 10⁹, from end to end along the axis, at most 2000 times the semi-axis along it; for two sheets above twice that semi-axis |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)` of the true value for exponents
/// of 0.05 to 2.5, `size` being the largest half-extent of the solid.
///
/// Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981), whose form
/// of two sheets is the one along x.
///
/// ```
/// use rvachev::{Solid, Superhyperboloid};
/// use glam::DVec3;
///
/// let tower = Superhyperboloid::one_sheet(DVec3::new(2.0, 2.0, 3.0), 1.0, 1.0, 8.0);
/// // At the waist its radius is 2, at the top 2·√(1 + (4/3)²).
/// let bounds = Solid::from(tower).bounds()?;
/// assert!((bounds.max - DVec3::new(10.0 / 3.0, 10.0 / 3.0, 4.0)).length() < 1e-9);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superhyperboloid {
    semi_axes: DVec3,
    e1: f64,
    e2: f64,
    length: f64,
    sheets: Sheets,
    along_x: bool,
    inverse: DVec3,
    across: Norm,
    profile: Norm,
    scale: f64,
}

impl Superhyperboloid {
    /// One sheet about the z axis: `h = ‖(1, z/a₃)‖ − ‖(x/a₁, y/a₂)‖`, a waist with semi-axes
    /// a₁ and a₂. Parameters are checked when the solid is compiled.
    #[must_use]
    pub fn one_sheet(semi_axes: impl Into<DVec3>, e1: f64, e2: f64, length: f64) -> Superhyperboloid {
        Superhyperboloid::new(semi_axes.into(), [e1, e2], length, Sheets::One, false)
    }

    /// One sheet about the x axis: `h = ‖(1, x/a₁)‖ − ‖(y/a₂, z/a₃)‖`.
    #[must_use]
    pub fn one_sheet_x(semi_axes: impl Into<DVec3>, e1: f64, e2: f64, length: f64) -> Superhyperboloid {
        Superhyperboloid::new(semi_axes.into(), [e1, e2], length, Sheets::One, true)
    }

    /// Two sheets about the z axis: `h = |z/a₃| − ‖(1, ‖(x/a₁, y/a₂)‖)‖`, two bowls whose
    /// bottoms are at z = ±a₃.
    #[must_use]
    pub fn two_sheets(semi_axes: impl Into<DVec3>, e1: f64, e2: f64, length: f64) -> Superhyperboloid {
        Superhyperboloid::new(semi_axes.into(), [e1, e2], length, Sheets::Two, false)
    }

    /// Two sheets about the x axis in Barr's form: `h = |x/a₁| − ‖(y/a₂, ‖(1, z/a₃)‖)‖`, where
    /// e1 shapes the profile in the x–z plane and e2 that in the x–y plane.
    #[must_use]
    pub fn two_sheets_x(semi_axes: impl Into<DVec3>, e1: f64, e2: f64, length: f64) -> Superhyperboloid {
        Superhyperboloid::new(semi_axes.into(), [e1, e2], length, Sheets::Two, true)
    }

    fn new(semi_axes: DVec3, [e1, e2]: [f64; 2], length: f64, sheets: Sheets, along_x: bool) -> Superhyperboloid {
        let inverse = semi_axes.recip();
        let [a, b, along] = if along_x { [inverse.y, inverse.z, inverse.x] } else { inverse.to_array() };
        Superhyperboloid {
            semi_axes,
            e1,
            e2,
            length,
            sheets,
            along_x,
            inverse,
            across: Norm::of_exponent(e2),
            profile: Norm::of_exponent(e1),
            // The slope along the axis and that across it come close to their largest values
            // together, far out on the cone that the sheets approach.
            scale: 1.0 / a.norm(b, slope_norm(e2)).hypot(along),
        }
    }

    /// The semi-axes.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// The exponents `[e1, e2]`.
    #[must_use]
    pub fn exponents(&self) -> [f64; 2] {
        [self.e1, self.e2]
    }

    /// The length along the axis, from end to end.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    #[inline(always)]
    fn half_length(&self) -> f64 {
        0.5 * self.length
    }

    /// Whether there are two sheets.
    #[must_use]
    pub fn has_two_sheets(&self) -> bool {
        self.sheets == Sheets::Two
    }

    /// Whether the axis is that of x.
    #[must_use]
    pub fn is_along_x(&self) -> bool {
        self.along_x
    }

    /// The function h of the whole, unclipped hyperboloid: positive inside, no unit.
    #[must_use]
    pub fn unclipped(&self, p: DVec3) -> f64 {
        self.sheets_of(p.to_array())
    }

    #[inline(always)]
    fn sheets_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let i = self.inverse;
        let (x, y, z) = (x * i.x, y * i.y, z * i.z);
        let one = x.lift(1.0);
        let along_x = self.along_x;
        match self.sheets {
            Sheets::One => {
                let (a, b, along) = if along_x { (y, z, x) } else { (x, y, z) };
                one.norm(along, self.profile) - a.norm(b, self.across)
            }
            Sheets::Two => {
                let (a, b, c, along) = if along_x { (one, z, y, x) } else { (x, y, one, z) };
                let (inner, outer) = if along_x { (self.profile, self.across) } else { (self.across, self.profile) };
                along.abs() - a.nested(b, c, inner, outer)
            }
        }
    }

    #[inline(always)]
    fn slab<R: Real>(&self, [x, _, z]: [R; 3]) -> R {
        let along = if self.along_x { x } else { z };
        -along.abs() + self.half_length()
    }

    /// The semi-axis along the axis.
    fn semi_axis(&self) -> f64 {
        if self.along_x { self.semi_axes.x } else { self.semi_axes.z }
    }

    /// The largest section, across the axis, at the clipped ends.
    fn half_extents(&self) -> DVec3 {
        let a = self.semi_axes;
        let end = self.half_length() / self.semi_axis();
        let extents = match (self.sheets, self.along_x) {
            (Sheets::One, false) => {
                let radius = 1.0.norm(end, self.profile);
                DVec3::new(a.x * radius, a.y * radius, self.half_length())
            }
            (Sheets::One, true) => {
                let radius = 1.0.norm(end, self.profile);
                DVec3::new(self.length, a.y * radius, a.z * radius)
            }
            (Sheets::Two, false) => {
                let radius = leg(end, self.profile);
                DVec3::new(a.x * radius, a.y * radius, self.half_length())
            }
            (Sheets::Two, true) => DVec3::new(self.length, a.y * leg(end, self.across), a.z * leg(end, self.profile)),
        };
        extents * (1.0 + ROUNDING)
    }

    /// Support function of the end section of Barr's form, `‖(y, ‖(1, z)‖)‖ ≤ end`: from
    /// above, by steps along its edge.
    fn section_support(&self, y: f64, z: f64) -> f64 {
        const STEPS: u32 = 96;
        let end = self.half_length() / self.semi_axis();
        let mut most = 0.0f64;
        let mut width = leg(end, self.across);
        for step in 1..=STEPS {
            // With w = ‖(1, z)‖ from 1 to `end`, y falls and z rises: between two w they are
            // at most the former's y and the latter's z. Steps are even for a circle.
            let sin = (std::f64::consts::FRAC_PI_2 * f64::from(step) / f64::from(STEPS)).sin();
            let w = if step == STEPS { end } else { (1.0 + (end * end - 1.0) * sin * sin).sqrt() };
            most = most.max(y * width + z * leg(w, self.profile));
            width = if w < end { w * leg(end / w, self.across) } else { 0.0 };
        }
        most
    }
}

/// The other leg of a "right triangle" in a norm: t ≥ 0 with `‖(1, t)‖ = hypotenuse`.
fn leg(hypotenuse: f64, norm: Norm) -> f64 {
    let p = norm.p();
    // (c^p − 1)^(1/p) without overflow; c⁻ᵖ − 1 by its own function, for c is often near 1.
    let rest = -(-p * hypotenuse.ln()).exp_m1();
    if rest > 0.0 { hypotenuse * rest.powf(1.0 / p) } else { 0.0 }
}

/// A superhyperboloid on lanes, whatever its exponents are.
struct ByPowers {
    of: Superhyperboloid,
    across: Powers<true>,
    profile: Powers<true>,
}

impl Case for ByPowers {
    #[inline(always)]
    fn value<R: Real>(&self, p: [R; 3]) -> R {
        let Superhyperboloid { inverse: i, along_x, sheets, scale, .. } = self.of;
        let (x, y, z) = (p[0] * i.x, p[1] * i.y, p[2] * i.z);
        let one = x.lift(1.0);
        let height = match sheets {
            Sheets::One => {
                let (a, b, along) = if along_x { (y, z, x) } else { (x, y, z) };
                one.norm_as(along, self.profile) - a.norm_as(b, self.across)
            }
            Sheets::Two => {
                let (a, b, c, along) = if along_x { (one, z, y, x) } else { (x, y, one, z) };
                let (inner, outer) = if along_x { (self.profile, self.across) } else { (self.across, self.profile) };
                along.abs() - a.nested_as(b, c, inner, outer)
            }
        };
        (height * scale).min(self.of.slab(p))
    }
}

impl Field for Superhyperboloid {
    fn name(&self) -> &'static str {
        "superhyperboloid"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        (self.sheets_of(p) * self.scale).min(self.slab(p))
    }

    fn bounds(&self) -> Bounds {
        let half = self.half_extents();
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("semi_axes", self.semi_axes)?;
        check::within("e1", self.e1, 0.01, 10.0)?;
        check::within("e2", self.e2, 0.01, 10.0)?;
        check::length("length", self.length)?;
        let axis = self.semi_axis();
        let least = if self.sheets == Sheets::Two { 2.0 * axis } else { 0.0 };
        if self.length > least && self.length <= LONGEST * axis {
            return Ok(());
        }
        let allowed = format!("above {least}, up to {LONGEST} times the semi-axis of {axis}");
        Err(ParamError::new("length", self.length, allowed))
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        let direct = self.over(region);
        if direct.lo() > 0.0 || direct.hi() < 0.0 {
            return direct;
        }
        // Along the axis h rises and the slab falls: the least of them is highest where they
        // cross, somewhere between `lo` and `hi`. First the clipped end, so that the sign is exact.
        let axis = if self.along_x { 0 } else { 2 };
        let along = region[axis].abs();
        let (mut lo, mut hi) = (along.lo(), along.hi());
        let mut probe = region;
        let mut at = |along: f64| {
            probe[axis] = Interval::point(along);
            ((self.sheets_of(probe) * self.scale).hi(), self.slab(probe).hi())
        };
        let (mut rising, mut falling) = (at(hi).0, at(lo).1);
        for step in 0..5 {
            let middle = if step == 0 { self.half_length() } else { 0.5 * (lo + hi) };
            if !(lo < middle && middle < hi) {
                continue;
            }
            let (sheets, slab) = at(middle);
            if sheets < slab {
                (lo, falling) = (middle, slab);
            } else {
                (hi, rising) = (middle, sheets);
            }
        }
        direct.narrowed_by(Interval::new(f64::NEG_INFINITY, rising.min(falling)))
    }

    fn support(&self, direction: DVec3) -> f64 {
        // The hull of a hyperboloid is that of its two end sections: none between is larger.
        let d = direction.abs();
        let ends = if self.along_x { d.x } else { d.z } * self.half_length();
        let scaled = d * self.semi_axes;
        let section = match (self.sheets, self.along_x) {
            (Sheets::Two, true) => self.section_support(scaled.y, scaled.z),
            (sheets, along_x) => {
                let end = self.half_length() / self.semi_axis();
                let radius = if sheets == Sheets::One { 1.0.norm(end, self.profile) } else { leg(end, self.profile) };
                let [a, b] = if along_x { [scaled.y, scaled.z] } else { [scaled.x, scaled.y] };
                radius * a.norm(b, support_norm(self.e2))
            }
        };
        (ends + section) * (1.0 + ROUNDING)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        kernel.run_case(&ByPowers {
            of: *self,
            across: Powers::steep(self.across),
            profile: Powers::steep(self.profile),
        });
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let size = self.half_extents().length().min(reach + self.scale);
        let p = self.across.p().min(1.0) * self.profile.p().min(1.0);
        if p == 1.0 {
            return 4e-6 * size;
        }
        // Across a cusp a displacement d of a coordinate moves h by some (d/a)^p / p.
        let displaced = 1e-6 * reach / self.semi_axes.min_element();
        size * (4e-6 + 4.0 / p * displaced.powf(p))
    }
}
