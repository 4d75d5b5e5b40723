//! Sheet lattice: a minimal surface, thickened.

use std::f64::consts::TAU;

use glam::DVec3;

use super::minimal_surface::{graded, one_period, roundoff};
use super::slope::half_diagonal;
use super::{Field, Grading, MinimalSurface, ParamError, chained, check};
use crate::{Bounds, Dual, Interval, Real};

/// A wall along a triply periodic minimal surface: `f = thickness/2 − |g|/N`, with g and N
/// as in [`MinimalSurface`], N being such that g/N is nearly the distance to the surface.
///
#[doc = picture!(
    "gyroid_sheet" = "docs/gallery/gyroid_sheet.png",
    "schwarz_p_sheet" = "docs/gallery/schwarz_p_sheet.png",
    "schwarz_d_sheet" = "docs/gallery/schwarz_d_sheet.png",
)]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `surface` | none | gyroid, Schwarz P or D |
/// | `cell` | length | 10⁻⁹ to 10⁹, the period along x, y and z |
/// | `thickness` | length | 10⁻⁶ to 0.25 of the cell, everywhere; a number or a [`Grading`] |
///
/// The thickness of the wall, measured along the surface's normals, differs from the one asked
/// for by at most
///
/// | thickness / cell | gyroid | Schwarz P | Schwarz D |
/// |---|---|---|---|
/// | 0.05 | 0.5 % | 1 % | 0.5 % |
/// | 0.1 | 1 % | 2 % | 2 % |
/// | 0.15 | 2 % | 4 % | 5 % |
/// | 0.2 | 3 % | 7 % | 9 % |
///
/// and the slope of f, 1 near the surface, is nowhere above 1.08 (gyroid), 1.63 (P) and 1.11
/// (D), to which a grading adds half its own.
///
/// A lattice is unbounded: join it with something bounded before meshing. Its pattern is true
/// within 100 000 cells of its origin.
///
/// ```
/// use glam::DVec3;
/// use rvachev::{MinimalSurface, SheetLattice, Solid};
///
/// let foam = SheetLattice { surface: MinimalSurface::Gyroid, cell: 6.0, thickness: 0.5 };
/// let part = Solid::sphere(10.0) & Solid::from(foam);
/// assert_eq!(Solid::from(foam).value(DVec3::ZERO)?, 0.25);
/// assert!(!part.contains(DVec3::new(0.75, 0.75, 0.75))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetLattice<G = f64> {
    /// The surface in the middle of the wall.
    pub surface: MinimalSurface,
    /// Length of the period.
    pub cell: f64,
    /// Thickness of the wall.
    pub thickness: G,
}

/// The distance g/N about the middle of a region.
struct Level {
    gradient: [f64; 3],
    /// Over the region.
    over: Interval,
    /// By how much derivatives differ at most from those in the middle.
    turn: f64,
}

impl<G: Grading> SheetLattice<G> {
    #[inline(always)]
    fn parts<R: Real>(&self, p: [R; 3]) -> [R; 2] {
        self.surface.parts(self.surface.wall_weight(), self.cell, p)
    }

    /// ```text
    /// |∇q(p) − ∇q(m)| ≤ K·ρ,   q(p) = q(m) + ∇q(m)·(p − m) ± K·ρ²/2,   |p − m| ≤ ρ
    /// ```
    fn level(&self, region: [Interval; 3]) -> Level {
        let middle = region.map(Interval::mid);
        let [g, slope] = self.parts(Dual::point(middle));
        let gradient = (g / slope).gradient();
        let [g, slope] = self.parts(middle.map(Interval::point));
        let (here, radius) = (g / slope, half_diagonal(region));
        let by_slope = here.inflate(self.surface.steepest() * radius);
        let angle = TAU / self.cell;
        let turn = self.surface.sharpest(by_slope.magnitude() * angle) * angle * radius;
        let along = gradient.iter().zip(region).map(|(slope, side)| 0.5 * slope.abs() * side.width()).sum::<f64>();
        let spread = (along + 0.5 * turn * radius) * (1.0 + 1e-12) + 1e-13 * self.cell;
        let over = if spread.is_finite() { by_slope.narrowed_by(here.inflate(spread)) } else { by_slope };
        Level { gradient, over, turn }
    }
}

impl<G: Grading> Field for SheetLattice<G> {
    fn name(&self) -> &'static str {
        "sheet lattice"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let [g, slope] = self.parts(p);
        graded(&self.thickness, p).scale_add(0.5, -(g / slope).abs())
    }

    fn bounds(&self) -> Bounds {
        Bounds::ALL
    }

    fn period(&self) -> Option<DVec3> {
        one_period(self.cell, &self.thickness)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("cell", self.cell)?;
        let limits = self.thickness.limits();
        for thickness in [limits.lo(), limits.hi()] {
            check::within("thickness", thickness, 1e-6 * self.cell, 0.25 * self.cell)?;
        }
        Ok(())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        let half = graded(&self.thickness, region) * 0.5;
        (half - self.level(region).over.abs()).narrowed_by(half - Interval::new(0.0, self.cell))
    }

    fn slopes(&self, region: [Interval; 3]) -> [Interval; 3] {
        let Level { gradient, over, turn } = self.level(region);
        let thickness = graded(&self.thickness, Dual::point(region)).gradient();
        let most = self.surface.steepest();
        let side = over.select(Interval::point(-1.0), Interval::point(1.0));
        [0, 1, 2].map(|axis| {
            let along = Interval::around(gradient[axis], turn + 1e-12).narrowed_by(Interval::new(-most, most));
            thickness[axis] * 0.5 + side * along
        })
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let region = p.map(Dual::value);
        chained(Field::range(self, region), Field::slopes(self, region), p)
    }

    fn steepest(&self) -> f64 {
        // Gradings do not say how steep they are.
        if self.thickness.limits().width() == 0.0 { self.surface.steepest() } else { f64::INFINITY }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        roundoff(self.cell, reach)
    }
}
