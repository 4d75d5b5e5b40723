//! Whether one solid's surface goes into another solid.
//!
//! ```text
//!     -----.           .-----
//!           \  piece  /         A piece of the surface, moved inwards by what does not count, is
//!       -----\-------/------    outside of the other solid where a range of the other's value
//!             '-----'  deep     over it says so. Pieces of which neither that is known, nor a
//!        other                  point inside, are divided.
//! ```

use std::iter;
use std::ops::{ControlFlow, Range};

use glam::DVec3;
use rvachev_field::Zone;

use super::apart::ball;
use super::levels::Levels;
use super::piece::Piece;
use super::{AT_ONCE, Side, distance};
use crate::eval::Block;
use crate::{Bounds, Cancelled, Run};
use rvachev_num::jobs;

/// How far inside a solid points of it are looked for, in accuracies of the surfaces: of thin
/// sheets only those that are close to the surface are inside, or on a sheet midway between the
/// faces.
const INSIDE: [f64; 5] = [4.0, 1.0, 0.25, 0.06, 0.0];

/// Pieces of which it is not known whether they go into the other solid are not divided any further
/// if they are no larger than so many accuracies.
const SMALL: f64 = 4.0;

/// A path from one piece to another is asked about if it is no longer than so many of their sides.
const BESIDE: f64 = 4.0;

/// After so many pieces the work ends, with what is known then.
const MOST: usize = 1 << 17;

/// More of them are not compared at once.
const TOGETHER: usize = 512;

/// What is found of one surface and another solid.
pub(super) enum Entry {
    /// A point of both solids, just below the surface.
    At(DVec3),
    /// The surface is nowhere deeper in the other solid than this.
    AtMost(f64),
}

/// A point of both solids just below a point of the surface of `from`, below that of the other by
/// more than does not count: nearer to it, they may as well touch.
pub(super) fn common(from: &Side<'_>, to: &Side<'_>, slack: f64, p: DVec3) -> Option<DVec3> {
    let others = &to.surface.patches;
    let normal = from.program.gradient(p).1.normalize_or_zero();
    let inner = INSIDE.map(|by| p + by * slack * normal);
    let is_deep = |p: DVec3| distance(others, p) > slack;
    let is_within = |p: DVec3| to.program.value(p) > 0.0;
    let is_common = |p: &DVec3| {
        // On the very triangles of a mesh its value takes long, and else the distance does.
        let is_below = (to.is_known || is_within(*p)) && is_deep(*p) && (!to.is_known || is_within(*p));
        is_below && from.program.value(*p) > 0.0
    };
    inner.into_iter().find(is_common)
}

/// Whether a piece of `from` that is moved along its normal by this is outside of the other solid:
/// then no point of it is deeper in that.
pub(super) fn is_outside(piece: &Piece, from: &Side<'_>, to: &Side<'_>, by: f64) -> bool {
    is_outside_beside(piece, from, to, by, &mut None)
}

/// The same, given a point that is outside, if one is known. Takes the piece's middle where it was
/// moved to in its place.
pub(super) fn is_outside_beside(
    piece: &Piece,
    from: &Side<'_>,
    to: &Side<'_>,
    by: f64,
    outside: &mut Option<DVec3>,
) -> bool {
    let (patches, others) = (&from.surface.patches, &to.surface.patches);
    let moved = piece.moved(by);
    let rounding = piece.off(patches) + from.fineness() + to.fineness();
    // What meets no triangle is on one side of them, as is what a path leads to that meets none.
    if to.is_known && others.is_beyond(moved, rounding) == Some(true) {
        let middle = moved.iter().sum::<DVec3>() / 3.0;
        let beside = outside.filter(|p| p.distance(middle) <= BESIDE * piece.longest_side());
        let is_beside = beside.is_some_and(|p| others.is_beyond([p, middle, moved[0]], rounding) == Some(true));
        if !is_beside && to.program.value(middle) > 0.0 {
            return false;
        }
        *outside = Some(middle);
        return true;
    }
    let zone = piece.zone(patches, by * piece.normal());
    let [x, y, z] = zone.hull();
    let hull = Bounds::new(DVec3::new(x.lo(), y.lo(), z.lo()), DVec3::new(x.hi(), y.hi(), z.hi()));
    !hull.intersects(&others.bounds().inflate(by.abs())) || to.program.range_zone(&zone).hi() <= 0.0
}

/// The same of patches that follow each other, of which there are not too many, or whether they are
/// inside: where these are flat, one look tells of all. Nothing if it does not.
fn span_outside(span: Range<usize>, from: &Side<'_>, to: &Side<'_>, by: f64) -> Option<bool> {
    if span.len() > TOGETHER || !to.is_known {
        return None;
    }
    if span.len() == 1 {
        return is_outside(&Piece::whole(&from.surface.patches, span.start), from, to, by).then_some(true);
    }
    let zone = Piece::span_moved(&from.surface.patches, span, by);
    to.surface.patches.apart(&zone, from.fineness() + to.fineness())?;
    Some(to.program.value(zone.centre) <= 0.0)
}

/// The patches of `from` that may be in the other solid or at its surface, or a point of both;
/// without those that are outside when they are moved along their normals by this.
fn near(
    from: &Side<'_>,
    to: &Side<'_>,
    slack: f64,
    by: Option<f64>,
    run: &Run,
) -> Result<Result<Vec<usize>, DVec3>, Cancelled> {
    let (runs, patches, others) = (from.surface.runs(), &from.surface.patches, &to.surface.patches);
    let bounds = others.bounds().inflate(slack);
    let mut blocks: Vec<Block> = runs.all().into_iter().collect();
    let mut near = Vec::new();
    let mut levels = Levels::new(run);
    while !blocks.is_empty() {
        // All of it is on one side of the other's surface, or that is near.
        let look = |block: &Block| {
            let (centre, radius) = ball(runs.bounds(*block));
            if !runs.bounds(*block).inflate(slack).intersects(&bounds) {
                return ControlFlow::Continue(None);
            }
            let own = patches.point(runs.patches(*block).start, [0.0; 2]);
            // Of large blocks a point may tell at once.
            if runs.patches(*block).len() > TOGETHER
                && let Some(found) = common(from, to, slack, own)
            {
                return ControlFlow::Break(found);
            }
            let is_far = || others.apart(&Zone::of_bounds(runs.bounds(*block)), 2.0 * slack).is_some();
            if distance(others, centre) <= radius + 2.0 * slack && !is_far() {
                match by.and_then(|by| span_outside(runs.patches(*block), from, to, by)) {
                    Some(true) => return ControlFlow::Continue(None),
                    Some(false) => {}
                    None => return ControlFlow::Continue(Some(*block)),
                }
            } else if to.program.value(centre) <= 0.0 {
                return ControlFlow::Continue(None);
            }
            // Of a sheet it may not be found here: then each patch is looked at.
            common(from, to, slack, own).map_or(ControlFlow::Continue(Some(*block)), ControlFlow::Break)
        };
        let mut open = Vec::new();
        for some in levels.chunks(&blocks, 16 * AT_ONCE) {
            let some = some?;
            for found in jobs::in_order(some.len(), |n| look(&some[n])) {
                match found {
                    ControlFlow::Break(point) => return Ok(Err(point)),
                    ControlFlow::Continue(block) => open.extend(block),
                }
            }
        }
        let patches;
        (blocks, patches) = runs.opened(&open);
        near.extend(patches);
        levels.down()?;
    }
    Ok(Ok(near))
}

/// Whether a part of one surface is within the other solid, given that they do not cross each
/// other: of each patch the middle tells.
pub(super) fn within(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Entry, Cancelled> {
    let [to_open, to_look] = run.stages([0.5, 0.5]);
    let patches = match near(from, to, slack, None, &to_open)? {
        Ok(near) => near,
        Err(point) => return Ok(Entry::At(point)),
    };
    let (own, others) = (&from.surface.patches, &to.surface.patches);
    // Of a sheet, or of what is hardly within, no point may be found below its surface.
    let look = |n: &usize| {
        let p = own.point(*n, [1.0 / 3.0; 2]);
        if to.program.value(p) <= 0.0 {
            return Entry::AtMost(0.0);
        }
        let piece = Piece::whole(own, *n);
        let deep = || distance(others, piece.middle()) + piece.reach(own) + slack;
        common(from, to, slack, p).map_or_else(|| Entry::AtMost(deep()), Entry::At)
    };
    let mut deepest = 0.0;
    for some in Levels::new(&to_look).chunks(&patches, 16 * AT_ONCE) {
        let some = some?;
        for found in jobs::in_order(some.len(), |n| look(&some[n])) {
            match found {
                Entry::At(_) => return Ok(found),
                Entry::AtMost(at_most) => deepest = f64::max(deepest, at_most),
            }
        }
    }
    Ok(Entry::AtMost(deepest))
}

/// Looks for a point of both solids just below the surface of `from`.
pub(super) fn entry(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Entry, Cancelled> {
    let (patches, others) = (&from.surface.patches, &to.surface.patches);
    let bounds = others.bounds().inflate(slack);
    // Beyond the other's box, farther from its surface than it is large, below its surface,
    // undecided.
    let look = |piece: &Piece, is_whole: bool| {
        let middle = piece.middle();
        let most = piece.longest_side() + piece.off(patches) + 2.0 * slack;
        if bounds.distance_squared(middle).sqrt() > most {
            return ControlFlow::Continue(None);
        }
        if distance(others, middle) > most && to.program.value(middle) <= 0.0 {
            return ControlFlow::Continue(None);
        }
        if is_outside(piece, from, to, -slack) {
            return ControlFlow::Continue(None);
        }
        // Corners of parts are those of wholes, or close to the middles of smaller parts.
        let corners = piece.points.into_iter().filter(|_| is_whole);
        match iter::once(middle).chain(corners).find_map(|p| common(from, to, slack, p)) {
            Some(found) => ControlFlow::Break(found),
            None => ControlFlow::Continue(Some(*piece)),
        }
    };
    let [to_open, to_divide] = run.stages([0.4, 0.6]);
    let near = match near(from, to, slack, Some(-slack), &to_open)? {
        Ok(near) => near,
        Err(point) => return Ok(Entry::At(point)),
    };
    let mut left = 0.0;
    let mut asked = near.len();
    let mut pieces: Vec<Piece> = near.into_iter().map(|n| Piece::whole(patches, n)).collect();
    let mut levels = Levels::new(&to_divide);
    let mut are_whole = true;
    while !pieces.is_empty() {
        let mut open = Vec::new();
        for chunk in levels.chunks(&pieces, AT_ONCE) {
            let chunk = chunk?;
            let found: Vec<ControlFlow<DVec3, Option<Piece>>> =
                jobs::in_order(chunk.len(), |n| look(&chunk[n], are_whole));
            for found in found {
                match found {
                    ControlFlow::Break(point) => return Ok(Entry::At(point)),
                    ControlFlow::Continue(piece) => open.extend(piece),
                }
            }
        }
        asked += 4 * open.len();
        let is_small = |piece: &Piece| piece.longest_side() <= SMALL * slack || asked > MOST;
        // How deep the middle is, and how far anything is from there.
        let reach = |piece: &Piece| {
            let middle = piece.middle();
            let deep = if to.program.value(middle) > 0.0 { distance(others, middle) } else { 0.0 };
            deep + piece.reach(patches) + slack
        };
        left = open.iter().filter(|piece| is_small(piece)).map(reach).fold(left, f64::max);
        open.retain(|piece| !is_small(piece));
        levels.down()?;
        pieces = open.iter().flat_map(|piece| piece.divided(patches, |_| f64::NAN)).collect();
        are_whole = false;
    }
    Ok(Entry::AtMost(left))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::{compiled, surface_of};

    #[test]
    fn of_a_sheet_within_another_solid_it_is_told_how_deep_it_may_be() {
        // Moved by what does not count all points are through the sheet, and those that are not
        // moved are at its surface.
        let solids = [Solid::cuboid([1.0, 1.0, 2f64.powi(-7)]), Solid::sphere(10.0)];
        let programs = solids.each_ref().map(|solid| compiled(solid).unwrap());
        let surfaces = solids.each_ref().map(|solid| surface_of(solid).unwrap());
        let [sheet, ball] = [0, 1].map(|n| Side::new(&programs[n], &surfaces[n], false));
        match within(&sheet, &ball, 1.0, &Run::default()).unwrap() {
            Entry::At(p) => assert!(sheet.program.value(p) > 0.0 && p.length() < 9.0, "{p}"),
            Entry::AtMost(deep) => assert!(deep >= 10.0, "{deep}"),
        }
        // One that is beyond it is not.
        let beyond = Solid::sphere(1.0).translate([20.0, 0.0, 0.0]);
        let (program, surface) = (compiled(&beyond).unwrap(), surface_of(&beyond).unwrap());
        let found = within(&Side::new(&program, &surface, false), &ball, 1.0, &Run::default()).unwrap();
        assert!(matches!(found, Entry::AtMost(deep) if deep == 0.0));
    }
}
