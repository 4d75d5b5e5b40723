//! Rays against programs: the first crossing, with certainty.
//!
//! A piece of the ray is a region like any other. Where the program narrowed to it has one
//! sign, there is no crossing. Where the slope along the ray has one sign, there is one
//! crossing if the ends differ in sign and none if they agree; bracketing finds it. Else what
//! the values at the ends and the slopes leave of the piece is halved, the nearer half first.
//!
//! Rays of pictures are less certain: where ranges stay wide they are marched, in steps that the
//! leaves' slopes allow, and what is thinner than the shortest of these may be missed.

use glam::DVec3;
use rvachev_num::order;

use super::bracket::Bracket;
use super::crossing::distance;
use super::joint::{beside, runs_on};
use super::{Program, Region};
use crate::{Bounds, Interval};
use rvachev_field::{Along, Segment, Zone};

/// Where a ray meets the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, in length units.
    pub distance: f64,
    /// The point.
    pub point: DVec3,
    /// Unit normal, out of the solid.
    pub normal: DVec3,
    /// The number of the leaf whose surface it is: [`Owner::index`](crate::Owner::index) without
    /// the owners of imported meshes, which [`Solid::owner`](crate::Solid::owner) tells at `point`.
    pub owner: u32,
}

/// How much is done for a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Care {
    /// A crossing and back within 10⁻¹⁰ of the size is a touch. Slopes of distances that are
    /// searched for are not trusted.
    Full,
    /// Within 10⁻⁶; of three crossings within 5·10⁻⁵ any will do. Slopes are trusted.
    Picture,
}

impl Care {
    fn trusts(self, program: &Program) -> bool {
        self == Care::Picture || program.is_steady()
    }

    /// Pieces shorter than this times the solid's size are not halved further.
    fn shortest(self) -> f64 {
        match self {
            Care::Full => 1e-10,
            Care::Picture => 1e-6,
        }
    }

    /// Crossings that are closer to each other than this times the solid's size are one.
    fn closest(self) -> f64 {
        match self {
            Care::Full => 1e-10,
            Care::Picture => 5e-5,
        }
    }

    /// Crossings are found to this times the solid's size.
    fn precision(self) -> f64 {
        match self {
            Care::Full => 0.0,
            Care::Picture => 1e-9,
        }
    }
}

/// A ray from farther away is taken to miss: lengths along it would be beyond what numbers hold.
const FARTHEST_ORIGIN: f64 = 1e100;

/// A piece is narrowed when it is shorter than this part of the one narrowed before: halves that
/// differ little from the whole tell little more.
const ASK: f64 = 0.2;

/// After every so many pieces twice as long ones count as short: where ranges stay wide, or an
/// unbounded deformed solid winds about the ray without end, the ray comes to an end all the same.
const PATIENCE: usize = 1 << 12;

/// In pictures the rest of a ray is [marched](march) after so many pieces, where values that are
/// searched for have wide ranges, and it is known how steep they are.
const ENOUGH: usize = 8;

/// A marched ray makes no shorter steps than so many of the closest crossings told apart.
const STRIDE: f64 = 4.0;

/// Values nearer to 0, in proportion to the solid's size or to the values about it, may be 0.
const ROUNDING: f64 = 1e-15;

/// What is small, in proportion to lengths about the solid.
const SMALL: f64 = 1e-10;

/// A slope that goes beyond 0 by no more than this, of values on the scale of lengths, is rounding:
/// a flat piece may be on the way, a crossing and back may not.
const LEVEL: f64 = 1e-13;

/// The slope is asked for only of programs with at most this many leaves.
const FEW: usize = 24;

/// A piece of a ray.
struct Piece {
    program: Program,
    ends: [f64; 2],
    values: [f64; 2],
    /// Which of its ends are inside; close to the surface rounding may tell otherwise.
    inside: [bool; 2],
    /// Bounds of the value's slope along it.
    slopes: Interval,
    /// The length of the piece that these and the program were made for.
    known: f64,
}

impl Piece {
    /// The piece between two distances, with the values there.
    fn new(program: &Program, start: (f64, f64), end: (f64, f64), is_inside: impl Fn(f64) -> bool) -> Piece {
        let (ends, values) = ([start.0, end.0], [start.1, end.1]);
        let (inside, program) = (values.map(is_inside), program.clone());
        Piece { program, ends, values, inside, slopes: Interval::ALL, known: f64::INFINITY }
    }
}

/// Where a ray is cut: a little before and behind the planes at which slopes have no bound. Between
/// them they have one, and at those planes most often signs that differ from side to side.
fn cuts(program: &Program, (origin, direction): (DVec3, DVec3), [near, far]: [f64; 2], gap: f64) -> Vec<f64> {
    let ends = [near, far].map(|t| origin + t * direction);
    let creases = program.creases(&Bounds::new(ends[0].min(ends[1]), ends[0].max(ends[1])));
    let distances = creases.iter().map(|crease| distance(crease, origin, direction));
    let mut crossed: Vec<f64> = distances.filter(|t| t.is_finite()).collect();
    order::numbers(&mut crossed);
    let mut cuts: Vec<f64> = Vec::with_capacity(2 * crossed.len());
    for end in crossed.into_iter().flat_map(|t| [t - gap, t + gap]) {
        if end > cuts.last().copied().unwrap_or(near) && end < far {
            cuts.push(end);
        }
    }
    cuts
}

/// The first crossing on `origin + t·direction` (a unit vector) with `near ≤ t ≤ far`.
pub(crate) fn first_hit(
    program: &Program,
    bounds: &Bounds,
    (origin, direction): (DVec3, DVec3),
    span: [f64; 2],
    care: Care,
) -> Option<Hit> {
    let ray = Ray { program, bounds, origin, direction, far: span[1], care };
    let mut grazes = care == Care::Full && span[0] > 0.0;
    let hit = crossing(&ray, span[0], &mut grazes);
    if grazes || hit.as_ref().is_some_and(|hit| runs_on(&ray, hit)) { beside(&ray, span[0], hit) } else { hit }
}

/// A ray, and up to where crossings count.
pub(super) struct Ray<'a> {
    pub(super) program: &'a Program,
    bounds: &'a Bounds,
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    far: f64,
    care: Care,
}

impl Ray<'_> {
    pub(super) fn value(&self, t: f64) -> f64 {
        self.program.value(self.origin + t * self.direction)
    }

    /// A length that is small for the solid, and large for the rounding of its points.
    pub(super) fn small(&self) -> f64 {
        let size = if self.bounds.is_finite() { self.bounds.longest_side() } else { 1.0 };
        SMALL * (size + self.origin.abs().max_element())
    }

    /// The same ray from another origin.
    pub(super) fn from(&self, origin: DVec3) -> Self {
        Ray { origin, ..*self }
    }

    /// The first crossing from a distance on, with faces that operands share as outside.
    pub(super) fn next(&self, near: f64) -> Option<Hit> {
        crossing(self, near, &mut false)
    }
}

/// The same, with faces that operands share as outside; and whether the ray is in one for a while.
fn crossing(ray: &Ray<'_>, start: f64, grazes: &mut bool) -> Option<Hit> {
    let Ray { program, bounds, origin, direction, far, care } = *ray;
    if origin.abs().max_element() > FARTHEST_ORIGIN {
        return None;
    }
    let (enter, leave) = clip(bounds, origin, direction)?;
    let (near, far) = (start.max(enter), far.min(leave));
    if near > far {
        return None;
    }
    let size = if bounds.is_finite() { bounds.size().length() } else { 1.0 };
    let mut shortest = care.shortest() * (size + origin.abs().max_element().min(1e6) + near);
    let closest = care.closest() * size;
    let at = |t: f64| origin + t * direction;
    let values = [near, far].map(|t| program.value(at(t)));
    // In a face that two operands share, rounding has either sign: it counts as outside. Values of
    // a formula may be on another scale than lengths.
    let between = program.value(at(0.5 * (near + far)));
    let scale = 16.0 * values[0].abs().max(values[1].abs()).max(between.abs());
    let doubt = ROUNDING * (size + origin.abs().max_element()).min(scale);
    let level = LEVEL * (scale / size).min(1.0);
    let one_signed = |slope: Interval| slope.lo() > -level || slope.hi() < level;
    let is_inside = |value: f64| value > doubt;
    // But for where it starts.
    let is_level = |piece: &Piece| (0..2).any(|end| piece.values[end].abs() <= doubt && piece.ends[end] > near);
    let inside = values.map(is_inside);
    let mut pieces = Vec::new();
    let mut start = (near, values[0]);
    for end in cuts(program, (origin, direction), [near, far], 0.25 * shortest) {
        let end = (end, program.value(at(end)));
        pieces.push(Piece::new(program, start, end, is_inside));
        start = end;
    }
    pieces.push(Piece::new(program, start, (far, values[1]), is_inside));
    pieces.reverse();
    let is_marched = care == Care::Picture && !program.is_steady();
    let steepest = if is_marched { program.steepest_leaf() } else { None };
    let mut count = 0;
    while let Some(mut piece) = pieces.pop() {
        count += 1;
        if count % PATIENCE == 0 {
            shortest *= 2.0;
        }
        let [t0, t1] = piece.ends;
        if let (true, Some(slope)) = (count == ENOUGH, steepest) {
            let steps = [STRIDE * closest, 1.0 / (slope * direction.length())];
            let [from, to] = march(&|t| program.value(at(t)), [t0, far], steps, is_inside)?;
            return Some(hit_between(program, &at, [from, to], doubt, care.precision() * size));
        }
        let [from, to] = within_reach(&piece);
        let short = if piece.inside[0] == piece.inside[1] { shortest } else { shortest.max(closest) };
        let is_settled = one_signed(piece.slopes);
        if to - from <= short || is_settled {
            if piece.inside[0] == piece.inside[1] {
                *grazes |= is_level(&piece);
                continue;
            }
            let [from, to] = if is_settled { piece.ends } else { [from.min(to), from.max(to)] };
            return Some(hit_between(&piece.program, &at, [from, to], doubt, care.precision() * size));
        }
        if to - from <= 0.5 * (t1 - t0) {
            piece.ends = [from, to];
            piece.values = piece.ends.map(|t| piece.program.value(at(t)));
            pieces.push(piece);
            continue;
        }
        if t1 - t0 < ASK * piece.known {
            let along = |program: &Program| match program.leaf_count() <= FEW && care.trusts(program) {
                true => along(program, origin, direction, t0, t1),
                false => Along::ANY,
            };
            let zone = || Zone::of_segment(at(t0), at(t1));
            // Narrowing one leaf leaves one.
            let single = piece.program.leaf_count() == 1;
            let Along { value, slope: mut found } = if single { along(&piece.program) } else { Along::ANY };
            if !one_signed(found) {
                let region = match piece.program.cost() {
                    // What a leaf has told of the way to it need not be asked for again; and of one
                    // that is asked for little, its slopes and the values at the ends say all.
                    _ if single && value.lo() > 0.0 => Region::Inside,
                    _ if single && value.hi() < 0.0 => Region::Outside,
                    1 if single && found != Interval::ALL => piece.program.simplified(&zone()),
                    _ => piece.program.narrow_zone(&zone()),
                };
                let narrowed = match region {
                    Region::Surface(narrowed) => narrowed,
                    // Between the pieces before and this one, by no more than rounding.
                    Region::Inside if !inside[0] => return Some(hit_at(&piece.program, at(t0), t0)),
                    Region::Outside if inside[0] => return Some(hit_at(&piece.program, at(t0), t0)),
                    Region::Inside | Region::Outside => {
                        *grazes |= is_level(&piece);
                        continue;
                    }
                };
                // Of the same sign everywhere in the piece, not of the same value: so an end in a
                // face, which counts as outside, may be well inside what is left of the program.
                piece.values = piece.ends.map(|t| narrowed.value(at(t)));
                piece.program = narrowed;
                let is_other = |end: usize| {
                    let value = piece.values[end];
                    if piece.inside[end] { value < -doubt } else { is_inside(value) }
                };
                if is_other(0) {
                    return Some(hit_at(&piece.program, at(t0), t0));
                }
                if piece.inside[0] == piece.inside[1] && is_other(1) {
                    piece.inside[1] = !piece.inside[1];
                }
                if !single {
                    found = along(&piece.program).slope;
                }
            }
            let better = found.width() < 0.5 * piece.slopes.width();
            (piece.slopes, piece.known) = (found, t1 - t0);
            if better {
                pieces.push(piece);
                continue;
            }
        }
        let middle = 0.5 * (t0 + t1);
        let value = piece.program.value(at(middle));
        let after = Piece {
            program: piece.program.clone(),
            ends: [middle, t1],
            values: [value, piece.values[1]],
            inside: [is_inside(value), piece.inside[1]],
            ..piece
        };
        pieces.push(after);
        pieces.push(Piece {
            ends: [t0, middle],
            values: [piece.values[0], value],
            inside: [piece.inside[0], is_inside(value)],
            ..piece
        });
    }
    None
}

/// The step of a ray in which it crosses the surface first: of steps as long as a value over the
/// steepest slope, and no shorter than the first of `steps`; the other is one over that slope.
fn march(
    value: &impl Fn(f64) -> f64,
    [mut t, far]: [f64; 2],
    [shortest, by_slope]: [f64; 2],
    is_inside: impl Fn(f64) -> bool,
) -> Option<[f64; 2]> {
    let mut here = value(t);
    let was_inside = is_inside(here);
    while t < far {
        let next = (t + (here.abs() * by_slope).max(shortest)).min(far);
        here = value(next);
        if is_inside(here) != was_inside {
            return Some([t, next]);
        }
        t = next;
    }
    None
}

/// What is left of a piece where the value may be 0: from either end it takes the value a while
/// to get there, from a value that is 0 but for rounding none.
fn within_reach(piece: &Piece) -> [f64; 2] {
    let Piece { ends: [t0, t1], values: [v0, v1], inside: [inside0, inside1], slopes, .. } = *piece;
    let way = |value: f64, inside: bool, fall: f64, rise: f64| {
        let steepest = if inside { fall } else { rise };
        let way = value.abs() / (steepest * (1.0 + 1e-9));
        if inside == (value > 0.0) && way.is_finite() { way } else { 0.0 }
    };
    [t0 + way(v0, inside0, -slopes.lo(), slopes.hi()), t1 - way(v1, inside1, slopes.hi(), -slopes.lo())]
}

/// The hit between two distances of which one is inside, where the value is above `doubt`.
fn hit_between(program: &Program, at: &impl Fn(f64) -> DVec3, ends: [f64; 2], doubt: f64, precision: f64) -> Hit {
    let value = |t: f64| program.value(at(t)) - doubt;
    let t = bracket(&value, ends, ends.map(value), precision);
    hit_at(program, at(t), t)
}

fn hit_at(program: &Program, point: DVec3, distance: f64) -> Hit {
    let normal = -program.gradient(point).1.normalize_or_zero();
    Hit { distance, point, normal, owner: program.deciding_leaf(point) }
}

/// The value along the ray from `t0` to `t1`.
fn along(program: &Program, origin: DVec3, direction: DVec3, t0: f64, t1: f64) -> Along {
    let at = |t: f64| {
        [0, 1, 2].map(|axis| Interval::point(t) * Interval::point(direction[axis]) + Interval::point(origin[axis]))
    };
    let slopes = direction.to_array().map(Interval::point);
    program.along(&Segment { ends: [at(t0), at(t1)], slopes, length: t1 - t0 + 4e-16 * t1.abs() })
}

/// The crossing between two ends, from the lower one, with the values there. Where rounding has the
/// same sign at both ends it is at one of them.
pub(crate) fn bracket(value: &impl Fn(f64) -> f64, ends: [f64; 2], values: [f64; 2], precision: f64) -> f64 {
    if (values[0] > 0.0) == (values[1] > 0.0) {
        return if values[0].abs() < values[1].abs() { ends[0] } else { ends[1] };
    }
    let mut bracket = Bracket::new(ends, values);
    for _ in 0..Bracket::MOST {
        let Some(t) = bracket.next(precision) else { break };
        bracket.narrow(t, value(t));
    }
    bracket.middle()
}

/// Rays end here along every axis: beyond the coordinate limit points are held at it, and a
/// ray through held points is no straight line.
const FARTHEST: f64 = 0.5 * crate::COORDINATE_LIMIT;

/// The part of a ray in a box, a little beyond its faces.
pub(crate) fn clip(bounds: &Bounds, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
    if bounds.is_empty() {
        return None;
    }
    let (mut near, mut far) = (0.0f64, 2.0 * crate::COORDINATE_LIMIT);
    for axis in 0..3 {
        let (o, d) = (origin[axis], direction[axis]);
        let (lo, hi) = (bounds.min[axis].max(-FARTHEST), bounds.max[axis].min(FARTHEST));
        if d == 0.0 {
            if o < lo || o > hi {
                return None;
            }
            continue;
        }
        let (a, b) = ((lo - o) / d, (hi - o) / d);
        let margin = |t: f64| 1e-12 * t.abs() + 1e-12 * (o / d).abs();
        let (a, b) = (a.min(b), a.max(b));
        if a.is_finite() {
            near = near.max(a - margin(a));
        }
        if b.is_finite() {
            far = far.min(b + margin(b));
        }
    }
    (near <= far).then_some((near, far))
}
