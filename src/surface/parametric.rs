//! Parametric surfaces: spherical products of two plane curves.
//!
//! ```text
//!     meridian (u, v)(η), normal (m_u, m_v)        z ↑   . (u, v)
//!     equator  (p, q)(ω), normal (n_p, n_q)          │  /
//!                                                    │ / η            up to permuted axes
//!     point    (a₁·u·p, a₂·u·q, a₃·v)                └────→ ω about z
//!     normal   (n_p·m_u/a₁, n_q·m_u/a₂, κ·m_v/a₃),  κ = (p, q)·(n_p, n_q)
//! ```
//!
//! The normal is exact: no difference, no derivative of a power, which would be unbounded at
//! the poles and seams of squarish shapes. Both tangents are turned normals of the curves.
//!
//! Source: A. H. Barr, *Superquadrics and angle-preserving transformations* (1981).

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::curve::{By, Curve, Local, height_of};
use crate::{Angle, Field, ParamError, Superellipsoid, Superhyperboloid, Supershape, Supertoroid, rad};

/// A surface by two parameters: η along its meridians, ω about its axis.
///
/// | of | η | ω | of the leaf |
/// |---|---|---|---|
/// | superellipsoid, supershape | −π/2 to π/2, pole to pole | −π to π | [`Superellipsoid`], [`Supershape`] |
/// | supertoroid | −π to π around the tube | −π to π | [`Supertoroid`] |
/// | hyperboloid of one sheet | between the clipped ends | −π to π | [`Superhyperboloid`] |
/// | of two sheets, z | 0 (apex) to the clipped end | −π to π | the same, one sheet at a time |
/// | of two sheets, x | `x = ±a₁·sec^e₁ η·sec^e₂ ω`, within the clipped end | | the same |
///
/// Angles within some units in the last place of a quarter turn count as that quarter turn: poles
/// and seams are exact, whatever the exponents. Any finite angles give a finite frame; beyond the
/// ranges they go on around the surface, or stay at a clipped end. Of angles that are not finite
/// the coordinates are NaN.
///
/// ```
/// use glam::DVec3;
/// use rvachev::surface::ParametricSurface;
/// use rvachev::{Superellipsoid, deg, rad};
///
/// let surface = ParametricSurface::of(&Superellipsoid::new([3.0, 2.0, 1.0], 0.1, 0.1))?;
/// assert_eq!(surface.point(deg(90.0), rad(0.3)), DVec3::Z);
/// assert_eq!(surface.point(deg(0.0), deg(180.0)), DVec3::new(-3.0, 0.0, 0.0));
/// let frame = surface.frame(rad(0.7), rad(0.2));
/// assert!(frame.normal.dot(frame.along_eta).abs() < 1e-15);
/// # Ok::<(), rvachev::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParametricSurface {
    pub(super) meridian: Curve,
    pub(super) equator: Curve,
    pub(super) shape: Shape,
    /// Semi-axes along u·p, u·q and v.
    scale: DVec3,
    along_x: bool,
    /// Of two sheets, the one at the negative end.
    lower: bool,
}

/// How a surface closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// From pole to pole.
    Ball,
    /// Around the tube.
    Ring,
    /// Around a tube that touches the axis, from there to there.
    Horn,
    /// Clipped at both ends.
    Tube,
    /// From an apex to a clipped end.
    Bowl,
    /// The same of Barr's two sheets along x, clipped at `x/a₁` = `end`.
    BarrBowl { end: f64, e1: f64, e2: f64 },
}

/// A point of a surface with its tangents and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The point, in length units.
    pub point: DVec3,
    /// The unit tangent of the meridian, in the direction of rising η.
    pub along_eta: DVec3,
    /// The unit tangent across, in the direction of rising ω; at a pole its limit along the
    /// meridian. In general not at a right angle to the other.
    pub along_omega: DVec3,
    /// The outward unit normal. On an edge, in a tip and at a cusp that of the symmetric
    /// bisector.
    pub normal: DVec3,
}

impl ParametricSurface {
    fn new(meridian: Curve, equator: Curve, shape: Shape, scale: DVec3) -> ParametricSurface {
        ParametricSurface { meridian, equator, shape, scale, along_x: false, lower: false }
    }

    /// The surface of a leaf.
    ///
    /// ```text
    /// superellipsoid   (a₁·cos^e₁ η·cos^e₂ ω, a₂·cos^e₁ η·sin^e₂ ω, a₃·sin^e₁ η)        signed powers
    /// supertoroid      (a₁·(ring + cos^e₁ η)·cos^e₂ ω, a₂·(ring + cos^e₁ η)·sin^e₂ ω, a₃·sin^e₁ η)
    /// supershape       (a₁·r₁(ω)·r₂(η)·cos ω·cos η, a₂·r₁·r₂·sin ω·cos η, a₃·r₂·sin η)
    /// superhyperboloid
    ///   one sheet, z   (a₁·sec^e₁ η·cos^e₂ ω, a₂·sec^e₁ η·sin^e₂ ω, a₃·tan^e₁ η)
    ///   one sheet, x   (a₁·tan^e₁ η, a₂·sec^e₁ η·cos^e₂ ω, a₃·sec^e₁ η·sin^e₂ ω)
    ///   two sheets, z  (a₁·tan^e₁ η·cos^e₂ ω, a₂·tan^e₁ η·sin^e₂ ω, ±a₃·sec^e₁ η)
    ///   two sheets, x  (±a₁·sec^e₁ η·sec^e₂ ω, a₂·sec^e₁ η·tan^e₂ ω, a₃·tan^e₁ η)
    /// ```
    ///
    /// Of two sheets it is the one at the positive end of the axis;
    /// [`other_sheet`](ParametricSurface::other_sheet) is the other. A supershape has the radius,
    /// standard or rational, that the leaf has.
    ///
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn of(leaf: &impl Parametric) -> Result<ParametricSurface, ParamError> {
        leaf.surface()
    }

    /// The point at (η, ω), in length units.
    #[must_use]
    pub fn point(&self, eta: impl Into<Angle>, omega: impl Into<Angle>) -> DVec3 {
        let (m, e) = self.curves_at(eta, omega);
        self.point_of(m.point, e.point)
    }

    /// The exact outward unit normal at (η, ω).
    #[must_use]
    pub fn normal(&self, eta: impl Into<Angle>, omega: impl Into<Angle>) -> DVec3 {
        let (m, e) = self.curves_at(eta, omega);
        self.normal_of(m.normal, e.normal, e.point)
    }

    /// Point, tangents and normal at (η, ω).
    #[must_use]
    pub fn frame(&self, eta: impl Into<Angle>, omega: impl Into<Angle>) -> Frame {
        let (m, e) = self.curves_at(eta, omega);
        let scale = self.scale;
        // With the outward normal to the right, a curve runs towards rising parameters.
        let (up, across) = (m.normal.perp(), e.normal.perp());
        let along_eta = DVec3::new(scale.x * up.x * e.point.x, scale.y * up.x * e.point.y, scale.z * up.y);
        let side = if m.point.x < 0.0 { -1.0 } else { 1.0 };
        let along_omega = side * DVec3::new(scale.x * across.x, scale.y * across.y, 0.0);
        Frame {
            point: self.point_of(m.point, e.point),
            along_eta: self.placed(along_eta).normalize_or_zero(),
            along_omega: self.placed(along_omega).normalize_or_zero(),
            normal: self.normal_of(m.normal, e.normal, e.point),
        }
    }

    /// First and last η.
    #[must_use]
    pub fn eta_range(&self) -> [Angle; 2] {
        self.meridian_range(By::Angle).map(rad)
    }

    /// First and last ω; the ends meet where the surface closes about its axis.
    #[must_use]
    pub fn omega_range(&self) -> [Angle; 2] {
        self.equator.range(By::Angle).map(rad)
    }

    /// The range of the meridian in a parameter.
    pub(super) fn meridian_range(&self, by: By) -> [f64; 2] {
        let whole = self.meridian.range(by);
        match self.shape {
            Shape::Ball => [-FRAC_PI_2, FRAC_PI_2],
            Shape::Horn | Shape::Ring | Shape::Tube | Shape::BarrBowl { .. } => whole,
            Shape::Bowl => [0.0, whole[1]],
        }
    }

    /// Of a hyperboloid of two sheets, the other sheet.
    #[must_use]
    pub fn other_sheet(&self) -> Option<ParametricSurface> {
        let two = matches!(self.shape, Shape::Bowl | Shape::BarrBowl { .. });
        two.then_some(ParametricSurface { lower: !self.lower, ..*self })
    }

    fn curves_at(&self, eta: impl Into<Angle>, omega: impl Into<Angle>) -> (Local, Local) {
        let (eta, omega) = (eta.into().radians(), omega.into().radians());
        (self.meridian.at(eta, By::Angle), self.equator.at(omega, By::Angle))
    }

    /// The point of a point of the meridian and one of the equator.
    pub(super) fn point_of(&self, meridian: DVec2, equator: DVec2) -> DVec3 {
        let u = meridian.x;
        self.placed(DVec3::new(u * equator.x, u * equator.y, meridian.y) * self.scale)
    }

    /// The unit normal of a normal of the meridian, and a normal and the point of the equator.
    pub(super) fn normal_of(&self, meridian: DVec2, equator: DVec2, at: DVec2) -> DVec3 {
        let m = meridian.x;
        let normal = DVec3::new(equator.x * m, equator.y * m, equator.dot(at) * meridian.y) / self.scale;
        // Barr's bowl lies on the far side of both of its hyperbolas.
        let side = if matches!(self.shape, Shape::BarrBowl { .. }) { -1.0 } else { 1.0 };
        // Scaled first: components may be of any size.
        let size = normal.abs().max_element();
        if size > 0.0 { side * self.placed(normal / size).normalize() } else { DVec3::ZERO }
    }

    /// Semi-axes along u·p, u·q and v.
    pub(super) fn semi_axes(&self) -> DVec3 {
        self.scale
    }

    /// From the axes of the product to those of space.
    pub(super) fn placed(&self, p: DVec3) -> DVec3 {
        let barr = matches!(self.shape, Shape::BarrBowl { .. });
        // The other sheet is the mirror image.
        let sign = if self.lower { -1.0 } else { 1.0 };
        let placed = if barr {
            DVec3::new(sign * p.x, p.y, p.z)
        } else if self.along_x {
            DVec3::new(sign * p.z, p.x, p.y)
        } else {
            DVec3::new(p.x, p.y, sign * p.z)
        };
        // No negative zeros.
        placed + DVec3::ZERO
    }

    /// A direction of space in the axes of the product.
    pub(super) fn unplaced(&self, p: DVec3) -> DVec3 {
        let sign = if self.lower { -1.0 } else { 1.0 };
        if self.along_x { DVec3::new(p.y, p.z, sign * p.x) } else { DVec3::new(p.x, p.y, sign * p.z) }
    }

    /// The largest coordinate of a point of the surface.
    pub(super) fn size(&self) -> f64 {
        let [e0, e1] = self.equator.range(By::Angle);
        let [m0, m1] = self.meridian_range(By::Angle);
        let share = |[a, b]: [f64; 2], i: u32| a + (b - a) * f64::from(i) / 64.0;
        let mut most = 0.0f64;
        for i in 0..=64 {
            for j in 0..=64 {
                most = most.max(self.point(rad(share([m0, m1], i)), rad(share([e0, e1], j))).abs().max_element());
            }
        }
        most
    }

    /// Whether the surface is a mirror image, its triangles the other way round.
    pub(super) fn mirrored(&self) -> bool {
        self.lower
    }
}

/// A leaf whose surface has parameters: [`Superellipsoid`], [`Supertoroid`], [`Superhyperboloid`]
/// and [`Supershape`].
pub trait Parametric: sealed::Sealed {
    #[doc(hidden)]
    fn surface(&self) -> Result<ParametricSurface, ParamError>;
}

mod sealed {
    use crate::{Superellipsoid, Superhyperboloid, Supershape, Supertoroid};

    pub trait Sealed {}

    impl Sealed for Superellipsoid {}
    impl Sealed for Superhyperboloid {}
    impl Sealed for Supershape {}
    impl Sealed for Supertoroid {}
}

impl Parametric for Superellipsoid {
    fn surface(&self) -> Result<ParametricSurface, ParamError> {
        self.check()?;
        let [e1, e2] = self.exponents();
        let curve = |e: f64| Curve::Superellipse { e, ring: 0.0 };
        Ok(ParametricSurface::new(curve(e1), curve(e2), Shape::Ball, self.semi_axes()))
    }
}

impl Parametric for Supertoroid {
    fn surface(&self) -> Result<ParametricSurface, ParamError> {
        self.check()?;
        let [e1, e2] = self.exponents();
        let (tube, ring) = (Curve::Superellipse { e: e1, ring: self.ring() }, Curve::Superellipse { e: e2, ring: 0.0 });
        let shape = if self.ring() > 1.0 { Shape::Ring } else { Shape::Horn };
        Ok(ParametricSurface::new(tube, ring, shape, self.semi_axes()))
    }
}

impl Parametric for Superhyperboloid {
    fn surface(&self) -> Result<ParametricSurface, ParamError> {
        self.check()?;
        let [e1, e2] = self.exponents();
        let a = self.semi_axes();
        let (two, along_x) = (self.has_two_sheets(), self.is_along_x());
        let end = 0.5 * self.length() / if along_x { a.x } else { a.z };
        if two && along_x {
            let [meridian, equator] = [e1, e2].map(|e| Curve::Hyperbola { e, end: height_of(end, e) });
            return Ok(ParametricSurface::new(meridian, equator, Shape::BarrBowl { end, e1, e2 }, a));
        }
        let meridian = if two { Curve::Bowl { e: e1, end } } else { Curve::Hyperbola { e: e1, end } };
        let shape = if two { Shape::Bowl } else { Shape::Tube };
        let scale = if along_x { DVec3::new(a.y, a.z, a.x) } else { a };
        let equator = Curve::Superellipse { e: e2, ring: 0.0 };
        Ok(ParametricSurface { along_x, ..ParametricSurface::new(meridian, equator, shape, scale) })
    }
}

impl Parametric for Supershape {
    fn surface(&self) -> Result<ParametricSurface, ParamError> {
        self.check()?;
        let curve = |of| Curve::gielis(of, self.radius());
        Ok(ParametricSurface::new(curve(self.meridian()), curve(self.equator()), Shape::Ball, self.scale()))
    }
}
