//! Sheet lattice: a minimal surface, thickened.

use super::minimal_surface::{graded, roundoff};
use super::slope::{half_diagonal, mean_value_range};
use super::{Field, Grading, MinimalSurface, ParamError, check};
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

impl<G: Grading> SheetLattice<G> {
    #[inline(always)]
    fn parts<R: Real>(&self, p: [R; 3]) -> [R; 2] {
        self.surface.parts(self.surface.wall_weight(), self.cell, p)
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

    fn check(&self) -> Result<(), ParamError> {
        check::length("cell", self.cell)?;
        let limits = self.thickness.limits();
        for thickness in [limits.lo(), limits.hi()] {
            check::within("thickness", thickness, 1e-6 * self.cell, 0.25 * self.cell)?;
        }
        Ok(())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        let middle = region.map(|side| Interval::point(side.mid()));
        let [g_here, slope_here] = self.parts(middle);
        let steepest = self.surface.steepest() * half_diagonal(region);
        let half = graded(&self.thickness, region) * 0.5;
        let coarse = half - (g_here / slope_here).inflate(steepest).abs();
        if !steepest.is_finite() || coarse.lo() > 0.0 || coarse.hi() < 0.0 {
            return coarse.narrowed_by(half - Interval::new(0.0, self.cell));
        }
        // Without the division, and on either side of the surface, slopes are tighter:
        // thickness/2·N − g and thickness/2·N + g have the signs of the value.
        let point = Dual::point(region);
        let [g, slope] = self.parts(point);
        let wall = graded(&self.thickness, point) * 0.5 * slope;
        let wall_here = graded(&self.thickness, middle) * 0.5 * slope_here;
        let above = mean_value_range(wall - g, wall_here - g_here, region);
        let below = mean_value_range(wall + g, wall_here + g_here, region);
        coarse.narrowed_by(above.min(below) / slope.value())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        roundoff(self.cell, reach)
    }
}
