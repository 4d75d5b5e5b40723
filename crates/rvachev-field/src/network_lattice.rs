//! Network lattice: one side of a minimal surface.

use glam::DVec3;

use super::minimal_surface::{graded, one_period, roundoff};
use super::outlined::Outlined;
use super::slope::{half_diagonal, mean_value_range};
use super::{Field, Grading, MinimalSurface, ParamError, check};
use crate::{Bounds, Dual, Interval, Real};

/// One of the two networks into which a triply periodic minimal surface divides space, that
/// where g is positive, grown or thinned to a given share of the volume:
/// `f = (g − level)/N`, with g and N as in [`MinimalSurface`].
///
#[doc = picture!(
    "gyroid_network" = "docs/gallery/gyroid_network.png",
    "schwarz_p_network" = "docs/gallery/schwarz_p_network.png",
    "schwarz_d_network" = "docs/gallery/schwarz_d_network.png",
)]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `surface` | none | gyroid, Schwarz P or D |
/// | `cell` | length | 10⁻⁹ to 10⁹, the period along x, y and z |
/// | `fraction` | none | 0.1 to 0.9, for Schwarz P 0.25 to 0.75; share of the volume that is solid, a number or a [`Grading`] |
///
/// The level is `(a + b·d²)·d` with d = ½ − fraction; the volume is what was asked for within
/// 0.002 of the whole, and network and void are connected (they fall apart at shares of
/// 0.017, 0.213 and 0.081).
///
/// | surface | a | b | slope of f at most |
/// |---|---|---|---|
/// | gyroid | 3.11096 | −0.72729 | 1.37 |
/// | Schwarz P | 3.50465 | −0.19786 | 1.32 |
/// | Schwarz D | 2.44473 | −0.33936 | 1.54 |
///
/// Near the surface the slope is between 0.6 and 1. A grading adds about twice its own slope
/// times the cell.
///
/// A lattice is unbounded: join it with something bounded before meshing. Its pattern is true
/// within 100 000 cells of its origin.
///
/// ```
/// use glam::DVec3;
/// use rvachev::{MinimalSurface, NetworkLattice, Solid};
///
/// let frame = NetworkLattice { surface: MinimalSurface::SchwarzP, cell: 6.0, fraction: 0.3 };
/// let part = Solid::cuboid(DVec3::splat(18.0)) & Solid::from(frame);
/// assert!(part.contains(DVec3::ZERO)?);
/// assert!(!part.contains(DVec3::splat(3.0))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkLattice<G = f64> {
    /// The surface that bounds the network at a fraction of ½.
    pub surface: MinimalSurface,
    /// Length of the period.
    pub cell: f64,
    /// Share of the volume that is solid.
    pub fraction: G,
}

impl<G: Grading> NetworkLattice<G> {
    /// g less the level, and N.
    #[inline(always)]
    fn parts<R: Real>(&self, p: [R; 3]) -> [R; 2] {
        let [g, slope] = self.surface.parts(self.surface.network_weight(), self.cell, p);
        let [a, b] = self.surface.level();
        // Minus d, so that the level is added.
        let more = graded(&self.fraction, p) - 0.5;
        [g + more.square().scale_add(b, more.lift(a)) * more, slope]
    }

    /// The share of the volume for which the level is fitted and the network connected.
    fn allowed(&self) -> [f64; 2] {
        if self.surface == MinimalSurface::SchwarzP { [0.25, 0.75] } else { [0.1, 0.9] }
    }
}

impl<G: Grading> Field for NetworkLattice<G> {
    fn name(&self) -> &'static str {
        "network lattice"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        let [above, slope] = self.parts(p);
        above / slope
    }

    fn bounds(&self) -> Bounds {
        Bounds::ALL
    }

    fn period(&self) -> Option<DVec3> {
        one_period(self.cell, &self.fraction)
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("cell", self.cell)?;
        let [least, most] = self.allowed();
        let limits = self.fraction.limits();
        for fraction in [limits.lo(), limits.hi()] {
            check::within("fraction", fraction, least, most)?;
        }
        Ok(())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        let diagonal = half_diagonal(region);
        if !diagonal.is_finite() {
            return self.over(region);
        }
        let [here, slope_here] = self.parts(region.map(|side| Interval::point(side.mid())));
        let coarse = (here / slope_here).inflate(self.steepest() * diagonal);
        if coarse.lo() > 0.0 || coarse.hi() < 0.0 {
            return coarse;
        }
        // Without the division, which does not change the sign, slopes are tighter.
        let [above, slope] = self.parts(Dual::point(region));
        coarse.narrowed_by(mean_value_range(above, here, region) / slope.value())
    }

    fn steepest(&self) -> f64 {
        // Gradings do not say how steep they are.
        match self.surface {
            _ if self.fraction.limits().width() != 0.0 => f64::INFINITY,
            MinimalSurface::Gyroid => 1.37,
            MinimalSurface::SchwarzP => 1.32,
            MinimalSurface::SchwarzD => 1.54,
        }
    }

    fn roundoff(&self, reach: f64) -> f64 {
        roundoff(self.cell, reach)
    }
}
