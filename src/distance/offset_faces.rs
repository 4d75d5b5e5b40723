//! Offset faces: patches moved along their normals, with canals about their edges and parts of
//! balls about their corners, trimmed to where they are at their distance.
//!
//! ```text
//!     _________________           The wall is as thick as a ball is wide: what is left for the ball's centre is a
//!     . . . . . . . . . |         sheet that no cell shows. Moved faces lie in it, whatever cells are. What of them
//!     _______________   |         is nearer to another face than they were moved by is trimmed off.
//! ```
//!
//! All that is at a distance from a surface is there: a foot is on a face, on an edge or in a
//! corner, and what it is the foot of is along a normal, between two, or among several.
//!
//! Source: W. Tiller and E. Hanson, *Offsets of Two-Dimensional Profiles* (1984), for offsets that
//! are moved first and trimmed then.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::quilt::{BETWEEN, PROBES};
use super::trim::Partial;
use crate::mesh::{Slope, Slopes};
use crate::{Bounds, Cancelled, Run};
use rvachev_field::{Patch, Patches};

/// What is smaller than this part of what they are moved by may be missed.
const SPACING: f64 = 1.0 / 3.0;

/// A piece is looked at in so many places along a side at most, else it is divided first.
const ALONG: f64 = 24.0;

/// What is off the level by less than this part of the tolerance is at it.
const ON: f64 = 0.5;

/// What rises by less than this part of its size is along the level.
const SLANT: f64 = 0.02;

/// So many steps lead from a place to what is narrower than places are apart, and no farther than
/// so many times that.
const STEPS: usize = 3;
const REACH: f64 = 1.5;

/// Pieces of so many tolerances are divided no more.
pub(super) const SMALL: f64 = 2.0;

/// What is halved so often is as small as numbers tell apart, but where a chart has a jump: between
/// normals that point away from each other.
pub(super) const DEEPEST: usize = 32;

/// So many pieces are looked at, or so many for each at first, no more, so many at a time.
const MOST: usize = 1 << 19;
const OF_EACH: usize = 4;
const AT_ONCE: usize = 1 << 12;

/// What is moved, and where to.
pub(super) struct Offset<'a> {
    pub(super) patches: &'a Patches,
    /// What the patches are the surface of.
    pub(super) of: &'a Slopes<'a>,
    /// Outwards.
    pub(super) by: f64,
    /// What is 0 on the faces.
    pub(super) level: &'a Slopes<'a>,
    /// The part that is asked for.
    pub(super) near: &'a Bounds,
    pub(super) tolerance: f64,
    /// Values may be off by so much.
    pub(super) grain: f64,
    /// Patches are off by so much.
    pub(super) slack: f64,
    /// Pieces are no larger where faces end.
    pub(super) cell: f64,
}

/// A triangle of a chart.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) chart: u32,
    pub(super) corners: [DVec2; 3],
    /// Whether it was trimmed to what is at the level.
    pub(super) is_trimmed: bool,
}

impl Piece {
    fn at(&self, [a, b, c]: [f64; 3]) -> DVec2 {
        a * self.corners[0] + b * self.corners[1] + c * self.corners[2]
    }

    pub(super) fn quarters(&self) -> [Piece; 4] {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        parts.map(|corners| Piece { corners, is_trimmed: false, ..*self })
    }
}

/// So many sides are between places along a side, of so many places in rows and the middle.
fn sides_of(count: usize) -> usize {
    ((f64::sqrt(8.0 * count as f64 - 7.0) - 3.0) / 2.0).round() as usize
}

/// What is found, and what is left for later.
#[derive(Default)]
pub(super) struct Found {
    /// Each with how far it is off.
    pub(super) patches: Vec<(Patch, f64)>,
    /// What is too narrow for places to show, or beside the level.
    narrow: Vec<Piece>,
    /// What was found before it was looked for.
    known: Option<Patches>,
}

/// A piece that is all at the level, as its places tell.
struct Whole {
    piece: Piece,
    size: f64,
    /// How much more its patch may be off.
    slack: f64,
    patch: Patch,
}

/// A piece that is at the level in none of its places, and which these are.
struct Beside {
    piece: Piece,
    size: f64,
    places: Range<usize>,
}

/// A way along a piece from one of its places to where it may be at the level.
struct Lead {
    /// Of the piece.
    number: usize,
    normal: DVec3,
    /// It is no longer than this.
    reach: f64,
    from: DVec3,
    at: DVec3,
    slope: Slope,
}

impl Lead {
    /// One step on, if it does not lead too far.
    fn step(&mut self) -> bool {
        let rise = self.slope.gradient.reject_from_normalized(self.normal);
        self.at -= self.slope.value / rise.length_squared() * rise;
        !self.at.is_nan() && self.at.distance(self.from) <= self.reach
    }
}

impl Offset<'_> {
    /// The faces, and how far each is off; nothing if it takes too many pieces.
    pub(super) fn faces(&self, run: &Run) -> Result<Option<Vec<(Patch, f64)>>, Cancelled> {
        let (charts, mut pieces) = self.charts(run)?;
        let mut all = Found::default();
        let most = MOST.max(OF_EACH * pieces.len());
        let (mut count, mut depth) = (0, 0);
        while !pieces.is_empty() {
            let mut next = Vec::new();
            for part in pieces.chunks(AT_ONCE) {
                count += part.len();
                if count > most {
                    return Ok(None);
                }
                let whole = self.look((&charts, part), (&mut next, &mut all), run)?;
                self.compare(whole, (&mut next, &mut all), run)?;
            }
            depth += 1;
            if depth == DEEPEST {
                next.clear();
            }
            if next.is_empty() && all.known.is_none() {
                // What is narrow is looked for where it is more than the rim of what is wide.
                (next, depth) = (std::mem::take(&mut all.narrow), 0);
                let wide: Vec<Patch> = all.patches.iter().map(|(patch, _)| *patch).collect();
                all.known = Some(Patches::new(&wide, &Run { progress: None, ..run.clone() })?);
            }
            pieces = next;
            run.report(count as f64 / most as f64);
        }
        Ok(Some(all.patches))
    }

    /// What of pieces is at the level: those that are, as a whole; patches of small ones, and
    /// pieces to be looked at again.
    fn look(
        &self,
        (charts, pieces): (&[Chart], &[Piece]),
        (next, found): (&mut Vec<Piece>, &mut Found),
        run: &Run,
    ) -> Result<Vec<Whole>, Cancelled> {
        let chart = |piece: &Piece| &charts[piece.chart as usize];
        let size = |piece: &Piece| {
            let [a, b, c] = piece.corners.map(|at| chart(piece).at(at));
            a.distance(b).max(b.distance(c)).max(c.distance(a))
        };
        let sizes: Vec<f64> = pieces.iter().map(size).collect();
        let spacing = self.cell.min(SPACING * self.by.abs());
        let (mut points, mut ends) = (Vec::new(), Vec::with_capacity(pieces.len()));
        for (piece, size) in pieces.iter().zip(&sizes) {
            let along = (size / spacing).ceil().max(2.0);
            if along <= ALONG && !piece.is_trimmed {
                let n = along as usize;
                let rows = (0..=n).flat_map(|i| (0..=n - i).map(move |j| [i, j, n - i - j]));
                let places = rows.map(|row| row.map(|k| k as f64 / along)).chain([PROBES[0]]);
                points.extend(places.map(|place| chart(piece).at(piece.at(place))));
            }
            ends.push(points.len());
        }
        let slopes = self.level.at(&points, run)?;
        let (mut whole, mut partial, mut beside, mut start) = (Vec::new(), Vec::new(), Vec::new(), 0);
        for ((piece, size), end) in pieces.iter().zip(sizes).zip(ends) {
            let places = start..end;
            start = end;
            let count = places.len();
            let on = slopes[places.clone()].iter().filter(|slope| self.is_on(slope.value)).count();
            let patch = || self.patch(chart(piece), piece);
            if piece.is_trimmed {
                whole.push(Whole { piece: *piece, size, slack: 0.0, patch: patch() });
            } else if count == 0 {
                next.extend(piece.quarters());
            } else if !self.is_near(&points[places.clone()]) {
                // Nobody asks for it.
            } else if on == count {
                whole.push(Whole { piece: *piece, size, slack: 0.0, patch: patch() });
            } else if self.is_level(&slopes[places.clone()], size) {
                // It is part of the surface where nothing else is.
                let near = self.slack + SMALL * self.tolerance;
                match &found.known {
                    None => found.narrow.push(*piece),
                    Some(known) if points[places].iter().all(|p| known.is_within(*p, near)) => {}
                    Some(_) => {
                        whole.push(Whole { piece: *piece, size, slack: BETWEEN * self.slack, patch: patch() });
                    }
                }
            } else if on == 0 {
                beside.push(Beside { piece: *piece, size, places });
            } else if size > self.cell {
                next.extend(piece.quarters());
            } else {
                let slopes = [places.end - 2, places.start + sides_of(count), places.start].map(|at| slopes[at]);
                partial.push(Partial { piece: *piece, size, slopes, mostly: 2 * on > count });
            }
        }
        let near = |p: DVec3| found.known.as_ref().is_none_or(|known| !known.is_within(p, SMALL * self.tolerance));
        let asked: Vec<&Beside> =
            beside.iter().filter(|own| found.known.is_none() || own.size > SMALL * self.tolerance).collect();
        let narrow = self.narrow((charts, &asked), (&points, &slopes), near, run)?;
        for own in asked.iter().zip(narrow).filter(|(_, is_narrow)| *is_narrow).map(|(own, _)| own) {
            match found.known {
                Some(_) => next.extend(own.piece.quarters()),
                None => found.narrow.push(own.piece),
            }
        }
        self.trim((charts, &partial), (next, found), run)?;
        Ok(whole)
    }

    /// Takes the patches of pieces that are within the tolerance; the others are divided.
    fn compare(
        &self,
        whole: Vec<Whole>,
        (next, found): (&mut Vec<Piece>, &mut Found),
        run: &Run,
    ) -> Result<(), Cancelled> {
        let probes: Vec<DVec3> = whole.iter().flat_map(|own| PROBES.map(|place| own.patch.point(place))).collect();
        let slopes = self.level.at(&probes, run)?;
        for (Whole { piece, size, slack, patch }, slopes) in whole.into_iter().zip(slopes.chunks(PROBES.len())) {
            let off = BETWEEN * slopes.iter().map(|slope| slope.distance_of(size)).fold(0.0, f64::max);
            let is_small = size < SMALL * self.tolerance;
            if off <= self.tolerance + self.grain + slack || is_small && off <= size {
                found.patches.push((patch, off));
            } else if !is_small {
                next.extend(piece.quarters());
            }
        }
        Ok(())
    }

    fn is_near(&self, points: &[DVec3]) -> bool {
        points.iter().any(|p| self.near.contains(*p))
    }

    pub(super) fn is_on(&self, value: f64) -> bool {
        value.abs() <= self.slightest()
    }

    /// What is less off than that is at the level.
    pub(super) fn slightest(&self) -> f64 {
        ON * (self.tolerance + self.grain)
    }

    /// Whether a piece is beside the level, as its patch is beside the surface.
    fn is_level(&self, slopes: &[Slope], size: f64) -> bool {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        slopes.iter().for_each(|slope| (least, most) = (least.min(slope.value), most.max(slope.value)));
        let on = self.slightest();
        most - least <= on.min(SLANT * size) && most.max(-least) <= on + self.slack
    }

    /// Whether slopes along pieces lead from their places, none of which is at the level, to one
    /// that is, and is asked for.
    fn narrow(
        &self,
        (charts, pieces): (&[Chart], &[&Beside]),
        (points, slopes): (&[DVec3], &[Slope]),
        is_asked: impl Fn(DVec3) -> bool,
        run: &Run,
    ) -> Result<Vec<bool>, Cancelled> {
        let mut found = vec![false; pieces.len()];
        let mut open = Vec::new();
        for (number, Beside { piece, size, places }) in pieces.iter().enumerate() {
            let [a, b, c] = piece.corners.map(|at| charts[piece.chart as usize].at(at));
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let reach = REACH * size / sides_of(places.len()) as f64;
            let way = |at: usize| Lead { number, normal, reach, from: points[at], at: points[at], slope: slopes[at] };
            open.extend(places.clone().map(way));
        }
        for _ in 0..STEPS {
            open.retain_mut(|lead| !found[lead.number] && lead.step());
            let places: Vec<DVec3> = open.iter().map(|lead| lead.at).collect();
            for (lead, slope) in open.iter_mut().zip(self.level.at(&places, run)?) {
                lead.slope = slope;
                if self.is_on(slope.value) {
                    found[lead.number] |= is_asked(lead.at);
                    // It leads no farther.
                    lead.reach = 0.0;
                }
            }
        }
        Ok(found)
    }

    /// The patch of a piece.
    pub(super) fn patch(&self, chart: &Chart, piece: &Piece) -> Patch {
        let corners = piece.corners.map(|at| chart.at(at));
        let displacements = [0, 1, 2].map(|k| {
            let middle = 0.5 * (piece.corners[k] + piece.corners[(k + 1) % 3]);
            let off = chart.at(middle) - 0.5 * (corners[k] + corners[(k + 1) % 3]);
            if off.length() < 1e-2 * self.tolerance { DVec3::ZERO } else { off }
        });
        Patch { corners, displacements }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::compiled_with;
    use crate::distance::surface::FromMeshes;
    use crate::eval::{Wanted, surface};
    use crate::{Solid, deg};
    use glam::DQuat;

    /// The faces of what is moved, and the program that is 0 on them.
    fn faces(solid: &Solid, by: f64, tolerance: f64) -> Vec<(Patch, f64)> {
        let run = Run::default();
        let programs = compiled_with(solid, &run).unwrap();
        let wanted = Wanted::of(by.abs(), None, &Bounds::ALL);
        let surface = surface(solid, &programs, &wanted, &FromMeshes, &run).unwrap();
        let moved = compiled_with(&solid.offset(by), &run).unwrap();
        let offset = Offset {
            patches: &surface.patches,
            of: &Slopes { program: &programs.surface, precision: 1e-7, reach: by.abs() },
            by,
            level: &Slopes { program: &moved.surface, precision: 1e-7, reach: by.abs() },
            near: &Bounds::ALL,
            tolerance,
            grain: moved.accuracy.grain(),
            slack: 0.0,
            cell: solid.bounds().unwrap().longest_side() / 8.0,
        };
        offset.faces(&run).unwrap().unwrap()
    }

    /// Random numbers from 0 to 1.
    fn units() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn what_is_at_a_distance_is_all_of_them() {
        let plate = Solid::cuboid([6.0, 4.0, 1.0]) | Solid::cuboid([1.0, 4.0, 5.0]).translate([-2.5, 0.0, 2.0]);
        let plate = plate - Solid::cylinder(0.8, 3.0).translate([1.0, 0.3, 0.0]);
        let turned = plate.rotate_x(deg(21.0)).rotate_y(deg(8.0));
        let ball = Solid::superellipsoid([3.0, 2.0, 1.5], 0.5, 0.7) - Solid::sphere(1.0).translate([0.0, 0.0, 1.5]);
        for (solid, by) in [(&turned, -0.3), (&ball, -0.2), (&ball, 0.3)] {
            let tolerance = 2e-3 * f64::abs(by);
            let found = faces(solid, by, tolerance);
            let patches: Vec<Patch> = found.into_iter().map(|(patch, _)| patch).collect();
            let patches = Patches::new(&patches, &Run::default()).unwrap();
            let moved = solid.offset(by);
            let bounds = solid.bounds().unwrap().inflate(by.max(0.0));
            let (mut unit, mut asked) = (units(), 0);
            for _ in 0..20_000 {
                let p = bounds.min + bounds.size() * DVec3::new(unit(), unit(), unit());
                let value = moved.value(p).unwrap();
                // On the side that was moved to, values are how far it is.
                if value * by < 0.0 && value.abs() < by.abs() {
                    let off = (patches.nearest(p).unwrap().distance - value.abs()).abs();
                    assert!(off < 1.5 * tolerance, "by {by}: off by {off} at {p}");
                    asked += 1;
                }
            }
            assert!(asked > 500, "by {by}: {asked} points");
        }
    }

    /// Half-way between the faces of a wall there is a sheet, to its ends.
    #[test]
    fn sheets_within_walls_are_whole() {
        let turn = |p: Solid| p.rotate_x(deg(21.0)).rotate_y(deg(8.0));
        let plate = |size: [f64; 3]| Solid::cuboid(size);
        let wall = plate([6.0, 4.0, 1.0]) | plate([1.0, 4.0, 5.0]).translate([-2.5, 0.0, 2.0]);
        let (by, tolerance) = (-0.5 + 1e-3, 1e-3);
        let found = faces(&turn(wall), by, tolerance);
        assert!(found.iter().all(|(_, off)| *off <= 3.0 * tolerance));
        let patches: Vec<Patch> = found.into_iter().map(|(patch, _)| patch).collect();
        let patches = Patches::new(&patches, &Run::default()).unwrap();
        // Corners of the sheets, and one beyond.
        let at =
            |p: DVec3| DQuat::from_rotation_y(8f64.to_radians()) * (DQuat::from_rotation_x(21f64.to_radians()) * p);
        let off = |x: f64, y: f64, z: f64| patches.nearest(at(DVec3::new(x, y, z))).unwrap().distance;
        for [x, y, z] in [[2.5, 1.5, 0.0], [2.5, -1.5, 0.0], [-2.5, 1.5, 4.0], [-2.5, -1.5, 4.0], [0.0, 0.0, 0.0]] {
            assert!(off(x, y, z) < 2e-3, "{} at {x} {y} {z}", off(x, y, z));
        }
        assert!((off(2.7, 0.0, 0.0) - 0.2).abs() < 2e-3, "{}", off(2.7, 0.0, 0.0));
    }
}
