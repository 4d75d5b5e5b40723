//! The clearance of two solids: how far apart their surfaces are, and where.
//!
//! ```text
//!        a               Over a flat triangle with corners a, b, c, the squared distance from a set, less the
//!       / \              squared distance from any point, is concave: at a point p of it
//!      / p \                  d²(p) ≥ Σ λᵢ d²(corner i) − Σ λᵢ |corner i − p|²
//!     b-----c            and the last sum is at most a third of the longest side squared.
//!  ~~~~~~~~~~~~~ set
//! ```
//!
//! The patches of one surface are divided, those that may be nearest first left, until none can be
//! nearer than the best point by more than a tolerance. The bound is off by the square of the size:
//! of a gap that is even, it takes few divisions.

use glam::DVec3;
use rayon::prelude::*;

use super::nearest::nearest;
use super::prepare::PrepareError;
use crate::distance::{compiled_with, surface_with};
use crate::eval::{Program, Surface};
use crate::{Run, Solid};
use rvachev_field::Patches;

/// How near the least distance is found, as a part of it.
const RELATIVE: f64 = 1e-3;

/// After so many points the work ends, with what tolerance there is.
const MOST: usize = 1 << 21;

/// So many patches are tried first.
const FIRST: usize = 512;

/// How far inside a solid a point of it is looked for, in accuracies of the surfaces.
const INSIDE: f64 = 4.0;

/// Steps from one surface to the other and back that end the search.
const STEPS: usize = 30;

/// Pieces that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 256;

/// How far two solids are apart: see [`Solid::clearance`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Clearance {
    /// The least distance of the two surfaces in length units; 0 if the solids overlap.
    pub distance: f64,
    /// No two points of them are nearer than `distance` by more than this, in length units.
    pub tolerance: f64,
    /// The two points that are nearest, one of each surface; a common point of both solids, twice,
    /// if they overlap.
    pub points: [DVec3; 2],
    /// Whether the solids overlap: whether they have a point in common that is deeper in both than
    /// `tolerance`.
    pub overlaps: bool,
}

impl Solid {
    /// How far this solid is from another one: the least distance of their surfaces, and where.
    /// Nothing if one of them is empty.
    ///
    /// A solid in a cavity of another has its clearance from the wall; one that is within the
    /// material of another overlaps it, and so do two whose surfaces cross. Solids that only touch
    /// have a distance of 0, to within the tolerance, and do not overlap.
    ///
    /// ```
    /// use rvachev::{Run, Solid};
    ///
    /// let plate = Solid::cuboid([30.0, 30.0, 5.0]) - Solid::cylinder(5.1, 10.0);
    /// let peg = Solid::cylinder(5.0, 20.0);
    /// let gap = peg.clearance(&plate, &Run::default())?.expect("neither is empty");
    /// assert!((gap.distance - 0.1).abs() < 0.002 && !gap.overlaps);
    /// let loose = peg.translate([0.2, 0.0, 0.0]).clearance(&plate, &Run::default())?.unwrap();
    /// assert!(loose.overlaps && loose.distance == 0.0);
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Details
    /// The surfaces are those that [`closest_surface_point`](Solid::closest_surface_point) measures
    /// from, found on first use and kept with the solids; the points that are nearest on these are
    /// led to the surfaces themselves. The tolerance is a thousandth of the distance and how exact
    /// the surfaces are: some 10⁻⁴ of the sizes of the solids, several times that where creases
    /// meet. It is more where both surfaces are alike over large parts and close: then it says how
    /// much.
    ///
    /// # Errors
    /// What is wrong with a solid, that it has no finite box, or that the work was cancelled.
    pub fn clearance(&self, other: &Solid, run: &Run) -> Result<Option<Clearance>, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let found = run.install(|| self.clearance_on(other, &run))?;
        run.report(1.0);
        Ok(found)
    }

    fn clearance_on(&self, other: &Solid, run: &Run) -> Result<Option<Clearance>, PrepareError> {
        let [to_own, to_other, to_search] = run.stages([0.35, 0.35, 0.3]);
        let (own_box, other_box) = (self.finite_bounds()?, other.finite_bounds()?);
        if own_box.is_empty() || other_box.is_empty() {
            return Ok(None);
        }
        let quiet = Run { progress: None, ..run.clone() };
        let programs = [compiled_with(self, &quiet)?, compiled_with(other, &quiet)?];
        let surfaces = [surface_with(self, &to_own)?, surface_with(other, &to_other)?];
        let sides = [0, 1].map(|n| Side { program: &programs[n].surface, surface: &surfaces[n] });
        if sides.iter().any(|side| side.surface.patches.is_empty()) {
            return Ok(None);
        }
        // The one with fewer patches is divided.
        let is_turned = sides[1].surface.patches.len() < sides[0].surface.patches.len();
        let [from, to] = if is_turned { [&sides[1], &sides[0]] } else { [&sides[0], &sides[1]] };
        let slack = sides.iter().map(Side::exactness).sum::<f64>();
        if own_box.intersects(&other_box)
            && let Some(point) = match from.common(to, slack, &to_search)? {
                None => to.common(from, slack, &to_search)?,
                found => found,
            }
        {
            return Ok(Some(Clearance { distance: 0.0, tolerance: slack, points: [point; 2], overlaps: true }));
        }
        let Found { mut points, least } = from.search(to, slack, &to_search)?;
        // On the patches first, then on the fields, each from where the other is.
        let patches_apart = points[0].distance(points[1]);
        for _ in 0..STEPS {
            let Some(there) = nearest(to.program, &to.surface.patches, points[0]) else { break };
            let Some(here) = nearest(from.program, &from.surface.patches, there) else { break };
            let gain = points[0].distance(points[1]) - here.distance(there);
            points = [here, there];
            if gain.abs() < 1e-12 * patches_apart {
                break;
            }
        }
        let distance = points[0].distance(points[1]);
        if is_turned {
            points.reverse();
        }
        let tolerance = (distance - least).max(0.0) + slack;
        Ok(Some(Clearance { distance, tolerance, points, overlaps: false }))
    }
}

/// A solid, and what is measured from.
struct Side<'a> {
    program: &'a Program,
    surface: &'a Surface,
}

/// The nearest points that were found, and what none is nearer than.
struct Found {
    points: [DVec3; 2],
    least: f64,
}

/// A part of a patch: its corners in the patch's coordinates, where they are, and how far from the
/// other surface.
#[derive(Clone, Copy)]
struct Piece {
    patch: u32,
    corners: [[f64; 2]; 3],
    points: [DVec3; 3],
    distances: [f64; 3],
}

impl Side<'_> {
    /// How far the patches may be off.
    fn exactness(&self) -> f64 {
        self.surface.accuracy.tolerance.max(self.surface.accuracy.error)
    }

    /// A point inside both solids, just below the surface of this one, if there is any below a
    /// corner or the middle of a patch.
    fn common(&self, other: &Side<'_>, slack: f64, run: &Run) -> Result<Option<DVec3>, PrepareError> {
        let patches = &self.surface.patches;
        let bounds = other.surface.patches.bounds().inflate(slack);
        let below_at = |n: usize, at: [f64; 2]| {
            let p = patches.point(n, at);
            if !bounds.contains(p) {
                return None;
            }
            let normal = self.program.gradient(p).1.normalize_or_zero();
            let inner = p + INSIDE * slack * normal;
            let is_common = self.program.value(inner) > 0.0 && other.program.value(inner) > 0.0;
            // Nearer to the other surface than that, they may as well touch.
            is_common.then_some(inner).filter(|p| distance(&other.surface.patches, *p) > slack)
        };
        let places = [[1.0 / 3.0; 2], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let below = |n: usize| places.into_iter().find_map(|at| below_at(n, at));
        for chunk in chunks(patches.len()) {
            run.check()?;
            if let Some(found) = chunk.into_par_iter().find_map_first(below) {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// The nearest points of the patches of both.
    fn search(&self, other: &Side<'_>, slack: f64, run: &Run) -> Result<Found, PrepareError> {
        let (patches, others) = (&self.surface.patches, &other.surface.patches);
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let mut best = (f64::INFINITY, DVec3::ZERO);
        for n in (0..patches.len()).step_by(patches.len().div_ceil(FIRST)) {
            let p = patches.point(n, corners[0]);
            best = nearer(best, (distance(others, p), p));
        }
        let box_of_others = others.bounds();
        let first = |n: usize| {
            let points = corners.map(|at| patches.point(n, at));
            let longest = longest_side(&points);
            // What is beyond the box of the other is no nearer than that.
            let to_box = points.iter().map(|p| box_of_others.distance_squared(*p).sqrt()).fold(f64::INFINITY, f64::min);
            (to_box - 2.0 * longest < best.0).then(|| {
                let distances = points.map(|p| distance(others, p));
                Piece { patch: n as u32, corners, points, distances }
            })
        };
        let mut pieces: Vec<Piece> = Vec::new();
        for chunk in chunks(patches.len()) {
            run.check()?;
            pieces.par_extend(chunk.into_par_iter().filter_map(first));
        }
        let (mut asked, mut least) = (3 * pieces.len(), f64::INFINITY);
        loop {
            for piece in &pieces {
                let ends = piece.distances.into_iter().zip(piece.points);
                best = ends.fold(best, nearer);
            }
            let enough = best.0 - slack.max(RELATIVE * best.0);
            let bounds: Vec<f64> = pieces.par_iter().map(|piece| piece.least(patches)).collect();
            // Those that are left as they are, or left at all.
            let is_done = asked > MOST || best.0 <= slack;
            let left = bounds.iter().copied().filter(|bound| is_done || *bound >= enough);
            least = left.fold(least, f64::min);
            if is_done || bounds.iter().all(|bound| *bound >= enough) {
                break;
            }
            let open: Vec<Piece> =
                pieces.iter().zip(&bounds).filter(|(_, bound)| **bound < enough).map(|(piece, _)| *piece).collect();
            asked += 3 * open.len();
            let mut next = Vec::with_capacity(4 * open.len());
            for chunk in open.chunks(16 * AT_ONCE) {
                run.check()?;
                next.par_extend(chunk.par_iter().flat_map_iter(|piece| piece.divided(patches, others)));
            }
            pieces = next;
        }
        let there = others.nearest(best.1).map_or(best.1, |foot| foot.point);
        Ok(Found { points: [best.1, there], least: least.min(best.0) })
    }
}

impl Piece {
    fn middles(&self, patches: &Patches) -> [([f64; 2], DVec3); 3] {
        [0, 1, 2].map(|k| {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % 3]);
            let at = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            (at, patches.point(self.patch as usize, at))
        })
    }

    /// What no point of the piece is nearer to the other surface than.
    fn least(&self, patches: &Patches) -> f64 {
        let corner = self.distances.iter().copied().fold(f64::INFINITY, f64::min);
        let longest = longest_side(&self.points);
        // A patch is quadratic: it is off its triangle by four thirds of how far it is in the
        // middle of a side, at most.
        let middles = self.middles(patches);
        let off = |k: usize| middles[k].1.distance(0.5 * (self.points[k] + self.points[(k + 1) % 3]));
        let off = 4.0 / 3.0 * (0..3).map(off).fold(0.0, f64::max);
        (corner * corner - longest * longest / 3.0).max(0.0).sqrt() - off
    }

    /// Its four parts.
    fn divided(&self, patches: &Patches, others: &Patches) -> [Piece; 4] {
        let middles = self.middles(patches).map(|(at, point)| (at, point, distance(others, point)));
        let ends = [0, 1, 2].map(|k| (self.corners[k], self.points[k], self.distances[k]));
        let part = |of: [([f64; 2], DVec3, f64); 3]| Piece {
            patch: self.patch,
            corners: of.map(|at| at.0),
            points: of.map(|at| at.1),
            distances: of.map(|at| at.2),
        };
        let corner = |k: usize| part([ends[k], middles[k], middles[(k + 2) % 3]]);
        [corner(0), corner(1), corner(2), part(middles)]
    }
}

fn longest_side(points: &[DVec3; 3]) -> f64 {
    (0..3).map(|k| points[k].distance(points[(k + 1) % 3])).fold(0.0, f64::max)
}

fn distance(patches: &Patches, p: DVec3) -> f64 {
    patches.nearest(p).map_or(f64::INFINITY, |foot| foot.distance)
}

fn nearer(a: (f64, DVec3), b: (f64, DVec3)) -> (f64, DVec3) {
    if b.0 < a.0 { b } else { a }
}

/// The numbers below one, some at a time.
fn chunks(count: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    const SOME: usize = 16 * AT_ONCE;
    (0..count.div_ceil(SOME)).map(move |n| n * SOME..count.min((n + 1) * SOME))
}
