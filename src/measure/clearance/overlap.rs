//! Whether one solid's surface goes into another solid.
//!
//! ```text
//!     -----.           .-----
//!           \  part   /         A part of the surface, moved inwards by what does not count, is on one
//!       -----\-------/------    side of the other surface if it does not meet that: a point tells which.
//!             '-----'  deep
//!        other
//! ```

use glam::DVec3;
use rvachev_field::{MovedApart, Moves, Patch, Patches, Place};

use super::piece::Piece;
use super::{Side, distance};
use crate::{Bounds, Cancelled, Run};

/// How far inside a solid points of it are looked for, in accuracies of the surfaces: of thin
/// sheets only those that are close to the surface are inside, or on a sheet midway between the
/// faces.
const INSIDE: [f64; 5] = [4.0, 1.0, 0.25, 0.06, 0.0];

/// Parts of which it is not known whether they go into the other solid are not divided any further
/// if they are no larger than so many accuracies.
const SMALL: f64 = 4.0;

/// A path from one piece to another is asked about if it is no longer than so many of their sides.
const BESIDE: f64 = 4.0;

/// So many points of a surface are asked for, before all of it, whether one is in the other solid.
const SAMPLES: usize = 1 << 10;

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
/// then no point of it is deeper in that. Given a point that is outside, if one is known; takes the
/// piece's middle where it was moved to in its place.
pub(super) fn is_outside_beside(
    piece: &Piece,
    from: &Side<'_>,
    to: &Side<'_>,
    by: f64,
    outside: &mut Option<DVec3>,
) -> bool {
    let others = &to.surface.patches;
    let moved = piece.moved(by);
    let rounding = piece.part.sag + from.fineness() + to.fineness();
    // What meets no triangle is on one side of them, as is what a path leads to that meets none. From
    // a surface beside its own a piece gets no farther than it is moved.
    if rounding < by.abs() && others.is_beyond(moved, rounding) {
        let middle = moved.iter().sum::<DVec3>() / 3.0;
        let beside = outside.filter(|p| p.distance(middle) <= BESIDE * piece.part.longest_side());
        let is_beside = beside.is_some_and(|p| others.is_beyond([p, middle, moved[0]], rounding));
        if !is_beside && to.program.value(middle) > 0.0 {
            return false;
        }
        *outside = Some(middle);
        return true;
    }
    let zone = piece.zone(by * piece.normal());
    let [x, y, z] = zone.hull();
    let hull = Bounds::new(DVec3::new(x.lo(), y.lo(), z.lo()), DVec3::new(x.hi(), y.hi(), z.hi()));
    !hull.intersects(&others.bounds().inflate(by.abs())) || to.program.range_zone(&zone).hi() <= 0.0
}

/// What points of a surface tell: one of both solids, just below one that is in the other, or else
/// those that are in the other.
fn told(places: &[Place], from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Told, Cancelled> {
    let values = to.program.sampled(places.len(), |n| places[n].moved, run)?;
    let mut within = Vec::new();
    for (place, _) in places.iter().zip(values).filter(|(_, value)| *value > 0.0) {
        if let Some(found) = common(from, to, slack, place.point) {
            return Ok(Err(found));
        }
        within.push(*place);
    }
    Ok(Ok(within))
}

/// A point of both solids, or parts of a surface of which there may be one.
type Told = Result<Vec<Place>, DVec3>;

/// How deep a part may be of which no point was found below its surface: of a sheet, or of what is
/// hardly within.
fn deep(place: &Place, to: &Side<'_>, slack: f64) -> f64 {
    let others = &to.surface.patches;
    let Some(corners) = place.corners else { return distance(others, place.moved) + place.reach + slack };
    let inside = to.program.value(place.point) > 0.0;
    let foot = if inside { others.nearest_with(place.point, &corners) } else { None };
    foot.map_or(place.reach, |(foot, far)| far.max(foot.distance) + place.sag) + slack
}

/// A point of each patch of a surface, of so many evenly chosen ones, if it is in the other's box.
fn samples(from: &Side<'_>, to: &Side<'_>, most: usize) -> Vec<Place> {
    let (own, bounds) = (&from.surface.patches, to.surface.patches.bounds());
    let step = own.len().div_ceil(most).max(1);
    let place = |n: usize| {
        let point = own.point(n, [1.0 / 3.0; 2]);
        bounds.contains(point).then(|| Place {
            point,
            moved: point,
            reach: Piece::whole(own, n).reach(),
            corners: None,
            sag: 0.0,
        })
    };
    (0..own.len()).step_by(step).filter_map(place).collect()
}

/// Whether a part of one surface is within the other solid, given that they do not cross each
/// other: of each patch the middle tells.
pub(super) fn within(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Entry, Cancelled> {
    Ok(match told(&samples(from, to, usize::MAX), from, to, slack, run)? {
        Err(point) => Entry::At(point),
        Ok(within) => Entry::AtMost(within.iter().map(|place| deep(place, to, slack)).fold(0.0, f64::max)),
    })
}

/// Looks for a point of both solids just below the surface of `from`, deeper in the other than by
/// what does not count.
pub(super) fn entry(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<Entry, Cancelled> {
    let [to_sample, to_divide, to_tell, to_turn] = run.stages([0.1, 0.6, 0.2, 0.1]);
    if let Err(point) = told(&samples(from, to, SAMPLES), from, to, slack, &to_sample)? {
        return Ok(Entry::At(point));
    }
    let moves = Moves { by: moved(from, to, slack), least: from.fineness() + to.fineness(), small: SMALL * slack };
    let others = &to.surface.patches;
    let MovedApart { apart, mut left } = from.surface.patches.moved_apart(others, moves, &to_divide)?;
    let within = match told(&apart, from, to, slack, &to_tell)? {
        Err(point) => return Ok(Entry::At(point)),
        Ok(within) => within,
    };
    // Along edges patches may be folded over: these were moved upwards.
    let (folded, within): (Vec<Place>, Vec<Place>) = within.into_iter().partition(|place| place.corners.is_some());
    let turned: Vec<Patch> =
        folded.iter().filter_map(|place| place.corners).map(|[a, b, c]| Patch::flat([a, c, b])).collect();
    let sag = folded.iter().map(|place| place.sag).fold(0.0, f64::max);
    let moves = Moves { least: moves.least + sag, ..moves };
    let turned = Patches::new(&turned, &to_turn)?.moved_apart(others, moves, &to_turn)?;
    left.extend(within);
    left.extend(turned.left);
    match told(&turned.apart, from, to, slack, &to_turn)? {
        Err(point) => return Ok(Entry::At(point)),
        Ok(within) => left.extend(within),
    }
    let mut deepest = 0.0;
    for place in left {
        if let Some(found) = common(from, to, slack, place.point) {
            return Ok(Entry::At(found));
        }
        deepest = f64::max(deepest, deep(&place, to, slack));
    }
    Ok(Entry::AtMost(deepest))
}

/// How far parts of surfaces that may touch are moved: by what does not count, and far enough to be
/// seen apart.
pub(super) fn moved(from: &Side<'_>, to: &Side<'_>, slack: f64) -> f64 {
    slack + 2.0 * (from.fineness() + to.fineness())
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
