//! Triply periodic minimal surfaces, by their trigonometric approximations, and what grades
//! the lattices made of them.
//!
//! With (X, Y, Z) = 2π·p/cell, s and c their sines and cosines:
//!
//! ```text
//! gyroid     g = s_x·c_y + s_y·c_z + s_z·c_x
//! Schwarz P  g = c_x + c_y + c_z
//! Schwarz D  g = s_x·s_y·s_z + s_x·c_y·c_z + c_x·s_y·c_z + c_x·c_y·s_z
//! ```
//!
//! Neither g nor g/max|∇g| is a length: |∇g| on the surface is 1.41 to 1.73 for the gyroid
//! and D and 1 to 1.73 for P. The leaves divide by
//!
//! ```text
//! N = √(|∇g|² + w·g²)
//! ```
//!
//! g/N is the distance to the first order. Along a normal the slope of g falls like a cosine
//! of the distance, which makes g/|∇g| too large; the term w·g² makes up for it (for a plane
//! wave, w = 2/3 is right to the third order) and keeps N away from 0 where ∇g vanishes. The
//! w below are the best ones for walls up to a fifth of the cell.
//!
//! Source: A. H. Schoen, *Infinite Periodic Minimal Surfaces without Self-Intersections*,
//! NASA TN D-5541 (1970); the leading Fourier terms are common property. N, w and the tables
//! of the lattices are derived here and measured in the tests.

use std::f64::consts::TAU;
use std::fmt::Debug;

use glam::DVec3;

use crate::{Interval, Real};

/// A surface that repeats in three directions and divides space into two networks, by its
/// trigonometric approximation g = 0.
///
#[doc = picture!(
    "gyroid_sheet" = "docs/gallery/gyroid_sheet.png",
    "schwarz_p_sheet" = "docs/gallery/schwarz_p_sheet.png",
    "schwarz_d_sheet" = "docs/gallery/schwarz_d_sheet.png",
)]
///
/// With (X, Y, Z) = 2π·p/cell, s and c their sines and cosines:
///
/// ```text
/// gyroid     g = s_x·c_y + s_y·c_z + s_z·c_x
/// Schwarz P  g = c_x + c_y + c_z
/// Schwarz D  g = s_x·s_y·s_z + s_x·c_y·c_z + c_x·s_y·c_z + c_x·c_y·s_z
/// N = √(|∇g|² + w·(2π/cell)²·g²)
/// ```
///
/// The lattices made of them divide by N: g/N is nearly the distance to the surface. For walls w
/// is 0.7, 0.3 and 1, for networks 0.7, 1 and 1.
///
/// Source: A. H. Schoen, *Infinite Periodic Minimal Surfaces without Self-Intersections*, NASA
/// TN D-5541 (1970); N and w are derived here.
///
/// ```
/// use rvachev::{MinimalSurface, SheetLattice, Solid};
///
/// // The gyroid passes through the origin, Schwarz P does not.
/// let wall = |surface| Solid::from(SheetLattice { surface, cell: 8.0, thickness: 0.5 });
/// assert!(wall(MinimalSurface::Gyroid).contains([0.0, 0.0, 0.0])?);
/// assert!(!wall(MinimalSurface::SchwarzP).contains([0.0, 0.0, 0.0])?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MinimalSurface {
    /// Schoen's gyroid: no straight lines, no mirrors; two networks of opposite hand.
    Gyroid,
    /// Schwarz's P ("primitive"): wide pores along the cubic axes.
    SchwarzP,
    /// Schwarz's D ("diamond"): both networks are bonded like diamond; the densest of these
    /// (its cell holds the repeating unit eight times, half a cell apart).
    SchwarzD,
}

impl MinimalSurface {
    /// For walls: w, and a little less than the least N².
    #[inline(always)]
    pub(super) fn wall_weight(self) -> [f64; 2] {
        match self {
            MinimalSurface::Gyroid => [0.7, 1.399],
            MinimalSurface::SchwarzP => [0.3, 0.2999],
            MinimalSurface::SchwarzD => [1.0, 0.999],
        }
    }

    /// How fast the gradient of g/N, for walls, turns at most where |g/N| is at most `level`, both
    /// per radian of the period: its second derivative along any direction. A hundredth above the
    /// largest that search has found.
    pub(super) fn sharpest(self, level: f64) -> f64 {
        let ([a, b, c], most) = match self {
            MinimalSurface::Gyroid => ([0.94, 0.46, 1.13], 3.08),
            MinimalSurface::SchwarzP => ([1.1, 0.51, 1.27], 6.15),
            MinimalSurface::SchwarzD => ([1.16, 0.21, 2.75], 4.05),
        };
        (a + (b + c * level) * level).min(most)
    }

    /// For networks, which need no thickness: P is less steep with a larger w.
    #[inline(always)]
    pub(super) fn network_weight(self) -> [f64; 2] {
        match self {
            MinimalSurface::SchwarzP => [1.0, 0.999],
            other => other.wall_weight(),
        }
    }

    /// The largest slope of g/N per length unit.
    pub(super) fn steepest(self) -> f64 {
        match self {
            MinimalSurface::Gyroid => 1.08,
            MinimalSurface::SchwarzP => 1.63,
            MinimalSurface::SchwarzD => 1.11,
        }
    }

    /// The two coefficients of the level of g above which a given part of the volume lies:
    /// `(a + b·d²)·d` with d = ½ − part.
    #[inline(always)]
    pub(super) fn level(self) -> [f64; 2] {
        match self {
            MinimalSurface::Gyroid => [3.110_96, -0.727_29],
            MinimalSurface::SchwarzP => [3.504_65, -0.197_86],
            MinimalSurface::SchwarzD => [2.444_73, -0.339_36],
        }
    }

    /// g, and N per length unit: `2π/cell` times N. The two numbers of the weight are w and a
    /// bound below N².
    #[inline(always)]
    pub(super) fn parts<R: Real>(self, [weight, least]: [f64; 2], cell: f64, p: [R; 3]) -> [R; 2] {
        let turn = TAU / cell;
        let (sx, cx) = (p[0] * turn).sin_cos();
        let (sy, cy) = (p[1] * turn).sin_cos();
        let (sz, cz) = (p[2] * turn).sin_cos();
        let (g, slope) = match self {
            MinimalSurface::Gyroid => {
                let g = sx.mul_add(cy, sy.mul_add(cz, sz * cx));
                let dx = cx.mul_add(cy, -(sz * sx));
                let dy = cy.mul_add(cz, -(sx * sy));
                let dz = cz.mul_add(cx, -(sy * sz));
                (g, dx.square() + dy.square() + dz.square())
            }
            MinimalSurface::SchwarzP => (cx + cy + cz, sx.square() + sy.square() + sz.square()),
            MinimalSurface::SchwarzD => {
                // Sines and cosines of Y + Z and Y − Z: two products fewer for each.
                let plus = [sy.mul_add(cz, cy * sz), cy.mul_add(cz, -(sy * sz))];
                let minus = [sy.mul_add(cz, -(cy * sz)), cy.mul_add(cz, sy * sz)];
                let g = sx.mul_add(minus[1], cx * plus[0]);
                let dx = cx.mul_add(minus[1], -(sx * plus[0]));
                let rest = (sx * minus[0]).square() + (cx * plus[1]).square();
                (g, rest.scale_add(2.0, dx.square()))
            }
        };
        let squared = g.square().scale_add(weight, slope).max(g.lift(least));
        [g, squared.sqrt() * turn]
    }
}

/// A number that varies in space: the thickness of a [`SheetLattice`](crate::SheetLattice) or
/// the share of a [`NetworkLattice`](crate::NetworkLattice).
///
#[doc = picture!(
    "graded_sheet" = "docs/gallery/graded_sheet.png",
    "graded_network" = "docs/gallery/graded_network.png",
)]
///
/// A plain `f64` is the same everywhere. A grading of your own is compiled into the lattice's
/// kernels; the solid is then made by [`Solid::new`](struct.Solid.html#method.new). Mark `at` and
/// its helpers `#[inline(always)]`. (The value of a [`Field`](crate::Field) can be called for it.)
///
/// ```
/// use glam::DVec3;
/// use rvachev::field::Real;
/// use rvachev::{Grading, Interval, MinimalSurface, SheetLattice, Solid};
///
/// /// Thicker towards the bottom: 0.6 at z = 0, 0.2 from z = 10 up.
/// #[derive(Debug)]
/// struct Downwards;
///
/// impl Grading for Downwards {
///     #[inline(always)]
///     fn at<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
///         z * -0.04 + 0.6
///     }
///     fn limits(&self) -> Interval {
///         Interval::new(0.2, 0.6)
///     }
/// }
///
/// let foam = SheetLattice { surface: MinimalSurface::Gyroid, cell: 5.0, thickness: Downwards };
/// let part = Solid::cuboid(DVec3::splat(20.0)) & Solid::new(foam);
/// assert!(part.contains(DVec3::new(0.0, 0.0, 0.1))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
pub trait Grading: Debug + Send + Sync + 'static {
    /// The number at a point of the lattice's own frame.
    fn at<R: Real>(&self, p: [R; 3]) -> R;

    /// The least and the largest number; what [`at`](Grading::at) gives beyond them is cut.
    fn limits(&self) -> Interval;
}

impl Grading for f64 {
    #[inline(always)]
    fn at<R: Real>(&self, p: [R; 3]) -> R {
        p[0].lift(*self)
    }

    fn limits(&self) -> Interval {
        Interval::point(*self)
    }
}

/// The period of a lattice whose cells are all the same.
pub(super) fn one_period<G: Grading>(cell: f64, grading: &G) -> Option<DVec3> {
    (grading.limits().width() == 0.0).then_some(DVec3::splat(cell))
}

/// The number at a point, within its limits.
#[inline(always)]
pub(super) fn graded<G: Grading, R: Real>(grading: &G, p: [R; 3]) -> R {
    let limits = grading.limits();
    let value = grading.at(p);
    value.max(value.lift(limits.lo())).min(value.lift(limits.hi()))
}

/// Up to this many cells away angles are reduced without loss in single precision.
const MOST_CELLS: f64 = 1500.0;

/// Bound of the single-precision error of a lattice, in length units.
pub(super) fn roundoff(cell: f64, reach: f64) -> f64 {
    if reach > MOST_CELLS * cell {
        // Nothing is known of the value: it is asked for again in double precision.
        return cell;
    }
    4e-6 * cell + 1e-6 * reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    /// Gradients at points beside each other differ by no more than their distance times the bound.
    #[test]
    fn gradients_turn_no_faster_than_is_said() {
        const STEP: f64 = 1e-5;
        for surface in [MinimalSurface::Gyroid, MinimalSurface::SchwarzP, MinimalSurface::SchwarzD] {
            let at = |p: [f64; 3]| {
                let [g, slope] = surface.parts(surface.wall_weight(), TAU, Dual::point(p));
                g / slope
            };
            // The share of the bound that the turn from a point along a direction takes.
            let share = |[x, y, z, turn, tilt]: [f64; 5]| {
                let (p, flat) = ([x, y, z], (1.0 - tilt * tilt).max(0.0).sqrt());
                let way = [flat * turn.cos(), flat * turn.sin(), tilt];
                let (here, beside) = (at(p), at([0, 1, 2].map(|i| p[i] + STEP * way[i])));
                let squared = (0..3).map(|i| (beside.gradient()[i] - here.gradient()[i]).powi(2)).sum::<f64>();
                squared.sqrt() / STEP / surface.sharpest(here.value().abs() + 2.0 * STEP)
            };
            let draw = |n: u32| {
                let along = |k: f64| (f64::from(n) * k).fract();
                let [x, y, z] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(|k| along(k) * TAU);
                [x, y, z, along(0.414_213_562) * TAU, (along(0.732_050_808) * 2.0 - 1.0).clamp(-1.0, 1.0)]
            };
            let mut all: Vec<(f64, [f64; 5])> = (0..100_000).map(|n| (share(draw(n)), draw(n))).collect();
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            // Up from the largest of them.
            let mut closest = 0.0_f64;
            for (mut most, mut from) in all.into_iter().take(200) {
                for n in 0..300 {
                    let by = draw(n).map(|x| x - x.floor() - 0.5);
                    let mut next: [f64; 5] = std::array::from_fn(|i| from[i] + by[i] * 0.985_f64.powi(n as i32));
                    next[4] = next[4].clamp(-1.0, 1.0);
                    let there = share(next);
                    if there > most {
                        (most, from) = (there, next);
                    }
                }
                closest = closest.max(most);
            }
            println!("{surface:?}: {closest}");
            assert!(closest < 1.0 && closest > 0.97, "{surface:?}: {closest}");
        }
    }
}
