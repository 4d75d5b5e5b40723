//! The clearance of two solids: how far apart their surfaces are, and where, or how much they
//! overlap.
//!
//! Their [nearest points](apart) are searched for first. If the surfaces come as near to each other
//! as they are exact, it is asked whether they [go into the other solid](overlap), and if they do,
//! how deep, and the volume of what the solids have in common.

mod apart;
mod depth;
mod doubts;
mod levels;
mod missed;
mod overlap;
mod piece;

use glam::DVec3;
use rvachev_field::Patches;

use self::apart::{Found, search};
use self::depth::depth;
use self::doubts::Known;
use self::missed::{Inside, inside};
use self::overlap::{Entry, common, entry, moved, within};
use super::enclosed::Enclosed;
use super::exact;
use super::integral::{Effort, integral};
use crate::distance::{compiled_with, surface_with};
use crate::error::PrepareError;
use crate::eval::{Compiled, Program, Surface};
use crate::geom::figures::point;
use crate::{Run, Solid, SolidError};
use rvachev_num::figures;

/// Pieces that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 256;

/// How the volume of an overlap is found: in cells that are large at first, as most of them have
/// one of the surfaces only.
const VOLUME: Effort = Effort { tolerance: 0.02, first: 4.0, most: 1 << 18 };

/// How far two solids are apart, or how much they overlap: see [`Solid::clearance`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Clearance {
    /// The least distance of the two surfaces in length units; 0 if the solids overlap.
    pub distance: f64,
    /// No two points of the surfaces are nearer than `distance` by more than this, in length units;
    /// if `distance` is at most this the solids may touch. If the solids do not overlap, no point
    /// of a surface is deeper in the other solid than this.
    pub tolerance: f64,
    /// The two points that are nearest, one of each surface; a common point of both solids, twice,
    /// if they overlap.
    pub points: [DVec3; 2],
    /// Whether the solids overlap: whether the surface of one goes deeper into the other than the
    /// surfaces are exact.
    pub overlaps: bool,
    /// How deep a point of the surface of one is below the surface of the other: the deepest that
    /// was found, in length units; 0 if they do not overlap.
    pub depth: f64,
    /// How much deeper there may be one: a hundredth of the depth and the `tolerance`, or more
    /// where it is as deep all over.
    pub depth_error: f64,
    /// The volume that both have in common, in cubic length units; 0 if they do not overlap.
    pub volume: f64,
    /// How far that may be off: a fiftieth of it, or more where it is thin all over.
    pub volume_error: f64,
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
    /// // The peg is a tenth too far to one side.
    /// assert!((loose.depth - 0.1).abs() < 0.005 && loose.volume > 1.0);
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    ///
    /// # Details
    /// The surfaces are those that [`closest_surface_point`](Solid::closest_surface_point) measures
    /// from, found on first use and kept with the solids; the points that are nearest on these are
    /// led to the surfaces themselves. The tolerance is a thousandth of the distance and a few
    /// times how exact the surfaces are, some 10⁻⁴ of the sizes of the solids. It is more where
    /// both surfaces are alike over large parts and close, or where one of them was not found that
    /// exactly: then it says how much.
    ///
    /// Closed meshes whose triangles do not cross, and polygons that are extruded straight,
    /// wherever they were moved to, are their triangles: nothing is measured of them, and the
    /// tolerance is a thousandth of the distance and what single precision leaves open, some 10⁻⁶
    /// of the sizes. Where they touch or overlap it is 2·10⁻⁴ of the sizes: what goes no deeper
    /// than half of that touches.
    ///
    /// That no points are nearer is told of both surfaces as they were measured. In places where a
    /// surface is in doubt the solids are looked at themselves.
    ///
    /// That solids do not overlap is shown to the tolerance: all of each surface as it was measured
    /// is far from the other one and outside, or as near to it as does not count, or outside when it
    /// is moved inwards by that. What [may be missed](crate::lengths#accuracy) where lengths are
    /// measured may be missed here too.
    ///
    /// Each surface takes as long as a mesh, once: solids that are moved or turned have that of the
    /// solid at rest, so that parts of an assembly are not measured anew in each position. After
    /// that a clearance takes milliseconds where one place is nearest, and some hundredths of a
    /// second where a gap is even all over: some tenths between threads, between fine round meshes,
    /// where surfaces touch all over, and where solids overlap. It takes seconds where fine round
    /// meshes all but fall together. Triangles of a mesh that lie in one plane are taken together,
    /// if nearly all do. The volume of an overlap is found as by [`measure`](Solid::measure); of one
    /// that is thin all over, as of threads that are too thick, to a tenth or so, in some seconds.
    ///
    /// # Errors
    /// What is wrong with a solid, that it has no finite box, that it is so thin that nothing of
    /// its surface is found, or that it is not known whether it is empty (both
    /// [`SolidError::Surface`]), or that the work was cancelled.
    pub fn clearance(&self, other: &Solid, run: &Run) -> Result<Option<Clearance>, PrepareError> {
        let run = run.stage(0.0, 1.0);
        let found = run.install(|| self.clearance_on(other, &run))?;
        run.report(1.0);
        Ok(found)
    }

    fn clearance_on(&self, other: &Solid, run: &Run) -> Result<Option<Clearance>, PrepareError> {
        let [to_compile, to_compile_other, to_own, to_other, to_search] = run.stages([0.1, 0.1, 0.25, 0.25, 0.3]);
        let programs = [compiled_with(self, &to_compile)?, compiled_with(other, &to_compile_other)?];
        let (own_box, other_box) = (self.finite_bounds()?, other.finite_bounds()?);
        if own_box.is_empty() || other_box.is_empty() {
            return Ok(None);
        }
        let exact = [exact::surface(self, &to_own)?, exact::surface(other, &to_other)?];
        let are_exact = exact.each_ref().map(Option::is_some);
        let [own, others] = exact;
        let own = if let Some(own) = own { own } else { surface_with(self, &to_own)? };
        let others = if let Some(others) = others { others } else { surface_with(other, &to_other)? };
        let surfaces = [own, others];
        let sides = [0, 1].map(|n| Side::new(&programs[n], &surfaces[n], are_exact[n]));
        let mut missed = None;
        for (side, bounds) in sides.iter().zip([own_box, other_box]) {
            if side.surface.patches.is_empty() {
                match inside(side.program, &bounds, run)? {
                    Inside::Nothing => return Ok(None),
                    Inside::At(p) => missed = missed.or(Some(side.missed(p))),
                    Inside::Unknown(p) => missed = missed.or(Some(side.unknown(p))),
                }
            }
        }
        if let Some(reason) = missed {
            return Err(SolidError::Surface { reason }.into());
        }
        let slack = sides.iter().map(Side::exactness).sum::<f64>();
        let [from, to] = [&sides[0], &sides[1]];
        let [to_find, to_doubt, first, second, third, to_overlap] = to_search.stages([0.35, 0.1, 0.1, 0.1, 0.05, 0.3]);
        let apart = |points: [DVec3; 2], tolerance: f64| {
            let [depth, depth_error, volume, volume_error] = [0.0; 4];
            let (overlaps, distance) = (false, points[0].distance(points[1]));
            Clearance { distance, tolerance, points, overlaps, depth, depth_error, volume, volume_error }
        };
        let overlap = |point: DVec3| {
            let common = Clearance { overlaps: true, ..apart([point; 2], slack) };
            self.overlap(other, common, [from, to], &to_overlap)
        };
        let Found { points, mut least, loss, common } = search(from, to, &to_find)?;
        let distance = points[0].distance(points[1]);
        if let Some(point) = common {
            return Ok(Some(overlap(point)?));
        }
        let do_share = own_box.intersects(&other_box);
        let fine = 2.0 * (from.fineness() + to.fineness());
        if least > 0.0 {
            least = doubts::least([from, to], &Known { least, loss }, &to_doubt)?;
        }
        if !do_share {
            return Ok(Some(apart(points, distance - least)));
        }
        // Surfaces that are apart do not cross, but one may be within the other solid. Others are
        // moved.
        let is_apart = least > fine;
        let mut deepest = if is_apart { 0.0 } else { slack + moved(from, to, slack) };
        for part in 0..3 {
            let found = match part {
                0 if is_apart => within(to, from, slack, &first)?,
                1 if is_apart => within(from, to, slack, &second)?,
                0 => entry(from, to, slack, &first)?,
                1 => entry(to, from, slack, &second)?,
                _ => doubts::entry([from, to], slack, [deepest, moved(from, to, slack)], &third)?,
            };
            match found {
                Entry::At(point) => return Ok(Some(overlap(point)?)),
                Entry::AtMost(at_most) => deepest = f64::max(deepest, at_most),
            }
        }
        Ok(Some(apart(points, deepest.max(distance - least))))
    }

    /// With the depth and the volume of what both have in common.
    fn overlap(
        &self,
        other: &Solid,
        common: Clearance,
        [from, to]: [&Side<'_>; 2],
        run: &Run,
    ) -> Result<Clearance, PrepareError> {
        let slack = common.tolerance;
        let [first, second, to_compile, to_integrate] = run.stages([0.2, 0.2, 0.1, 0.5]);
        let depths = [depth(from, to, slack, &first)?, depth(to, from, slack, &second)?];
        let deepest = depths.iter().fold(slack, |most, [depth, _]| most.max(*depth));
        let at_most = depths.iter().fold(slack, |most, [depth, more]| most.max(depth + more));
        let both = self & other;
        let programs = compiled_with(&both, &to_compile)?;
        let known = [exact::leaf(self, &to_compile)?, exact::leaf(other, &to_compile)?];
        let enclosed = Enclosed::known(&programs.surface, known.iter().flatten());
        let bounds = both.finite_bounds()?;
        let found = integral((&programs.surface, enclosed), &bounds, VOLUME, &to_integrate)?;
        Ok(Clearance {
            depth: deepest,
            depth_error: at_most - deepest + slack,
            volume: found.moments.volume,
            volume_error: found.volume_error,
            ..common
        })
    }
}

/// A solid, and what is measured from.
struct Side<'a> {
    program: &'a Program,
    surface: &'a Surface,
    /// Whether the patches are the surface itself.
    is_known: bool,
}

impl<'a> Side<'a> {
    fn new(compiled: &'a Compiled, surface: &'a Surface, is_known: bool) -> Side<'a> {
        let program = &compiled.surface;
        Side { program, surface, is_known }
    }

    /// What is said of a surface of which nothing was found, though a point is inside.
    fn missed(&self, p: DVec3) -> String {
        let size = self.fineness();
        format!(
            "the solid is at {}, and thinner there than what can be told apart of it ({}); make it \
             thicker, or leave it out of the clearance",
            point(p, size),
            figures(size, 2)
        )
    }

    /// What is said of a surface of which nothing was found, where it is not known whether there is
    /// any.
    fn unknown(&self, p: DVec3) -> String {
        let size = self.fineness();
        format!(
            "it is not known whether anything of the solid is left, at {} for one: surfaces fall together there, or \
             what is between them is thinner than what can be told apart ({}); leave it out of the clearance if it \
             is empty",
            point(p, size),
            figures(size, 2)
        )
    }

    /// How far the patches may be off, but where they are in doubt.
    fn exactness(&self) -> f64 {
        self.surface.accuracy.tolerance
    }

    /// How far they may be off where they are in no doubt.
    fn fineness(&self) -> f64 {
        self.surface.tolerance
    }
}

fn distance(patches: &Patches, p: DVec3) -> f64 {
    patches.nearest(p).map_or(f64::INFINITY, |foot| foot.distance)
}
