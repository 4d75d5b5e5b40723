//! Rays against programs: the first crossing, with certainty.
//!
//! A piece of the ray is a region like any other. Where the program narrowed to it has one
//! sign, there is no crossing. Where the slope along the ray has one sign, there is one
//! crossing if the ends differ in sign and none if they agree; bracketing finds it. Else the
//! piece is halved, the nearer half first.

use glam::DVec3;

use super::{Program, Region};
use crate::field::Zone;
use crate::{Bounds, Dual, Interval};

/// Where a ray meets the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin, in length units.
    pub distance: f64,
    /// The point.
    pub point: DVec3,
    /// Unit normal, out of the solid.
    pub normal: DVec3,
    /// The number of the leaf whose surface it is ([`Owner::index`](crate::Owner::index)).
    pub owner: u32,
}

/// Pieces shorter than this times the solid's size are not halved further: what crosses
/// within them and back touches rather than crosses.
const SHORTEST: f64 = 1e-11;

/// After as many pieces a ray is given up as a miss. A solid of finite size never comes near;
/// an unbounded deformed one may wind about the ray without end.
const PIECES: usize = 1 << 18;

/// The slope is asked for only of programs with at most this many leaves.
const FEW: usize = 6;

/// The first crossing on `origin + t·direction` (a unit vector) with `near ≤ t ≤ far`.
pub(crate) fn first_hit(
    program: &Program,
    bounds: &Bounds,
    origin: DVec3,
    direction: DVec3,
    near: f64,
    far: f64,
) -> Option<Hit> {
    let (enter, leave) = clip(bounds, origin, direction)?;
    let (near, far) = (near.max(enter), far.min(leave));
    if near > far {
        return None;
    }
    let size = if bounds.is_finite() { bounds.size().length() } else { 1.0 };
    let shortest = SHORTEST * (size + origin.abs().max_element().min(1e6) + near);
    let at = |t: f64| origin + t * direction;
    let mut pieces = vec![(program.clone(), near, far)];
    for _ in 0..PIECES {
        let Some((program, t0, t1)) = pieces.pop() else { break };
        let Region::Surface(program) = program.narrow_zone(&Zone::of_segment(at(t0), at(t1))) else { continue };
        let (inside0, inside1) = (program.value(at(t0)) > 0.0, program.value(at(t1)) > 0.0);
        let certain =
            t1 - t0 <= shortest || (program.leaf_count() <= FEW && one_way(&program, origin, direction, t0, t1));
        if certain {
            if inside0 == inside1 {
                continue;
            }
            return Some(hit_between(&program, &at, t0, t1));
        }
        let middle = 0.5 * (t0 + t1);
        pieces.push((program.clone(), middle, t1));
        pieces.push((program, t0, middle));
    }
    None
}

/// The hit between two distances whose values differ in sign.
fn hit_between(program: &Program, at: &impl Fn(f64) -> DVec3, t0: f64, t1: f64) -> Hit {
    let t = bracket(program, at, t0, t1);
    let point = at(t);
    let normal = -program.gradient(point).1.normalize_or_zero();
    Hit { distance: t, point, normal, owner: program.deciding_leaf(point) }
}

/// Whether the value only rises or only falls from `t0` to `t1`.
fn one_way(program: &Program, origin: DVec3, direction: DVec3, t0: f64, t1: f64) -> bool {
    let t = Dual::variable(Interval::new(t0, t1), 0);
    let along = |o: f64, d: f64| t * Dual::constant(Interval::point(d)) + Dual::constant(Interval::point(o));
    let p = [along(origin.x, direction.x), along(origin.y, direction.y), along(origin.z, direction.z)];
    let slope = program.evaluate(p, &mut Vec::new()).gradient()[0];
    one_signed(slope)
}

/// Whether a value with this slope only rises or only falls, but for rounding: a flat piece
/// may be on the way, a crossing and back may not.
fn one_signed(slope: Interval) -> bool {
    const ROUNDING: f64 = 1e-13;
    slope.lo() > -ROUNDING || slope.hi() < ROUNDING
}

/// The crossing between `t0` and `t1`, whose values differ in sign: the false position
/// method with halving (Illinois), which never leaves the bracket.
fn bracket(program: &Program, at: &impl Fn(f64) -> DVec3, mut t0: f64, mut t1: f64) -> f64 {
    let (mut f0, mut f1) = (program.value(at(t0)), program.value(at(t1)));
    let inside0 = f0 > 0.0;
    let mut kept = 0i32;
    for _ in 0..80 {
        let width = t1 - t0;
        if width <= 4.0 * f64::EPSILON * t1.abs().max(f64::MIN_POSITIVE) {
            break;
        }
        let secant = t0 + width * (f0 / (f0 - f1));
        // Three sides in a row mean slow progress: halve.
        let stuck = kept.abs() >= 3 || !(secant > t0 && secant < t1);
        let t = if stuck { 0.5 * (t0 + t1) } else { secant };
        let f = program.value(at(t));
        if f == 0.0 {
            return t;
        }
        if (f > 0.0) == inside0 {
            (t0, f0) = (t, f);
            if kept > 0 {
                f1 *= 0.5;
            }
            kept = kept.max(0) + 1;
        } else {
            (t1, f1) = (t, f);
            if kept < 0 {
                f0 *= 0.5;
            }
            kept = kept.min(0) - 1;
        }
        if stuck {
            kept = 0;
        }
    }
    0.5 * (t0 + t1)
}

/// Rays end here along every axis: beyond the coordinate limit points are held at it, and a
/// ray through held points is no straight line.
const FARTHEST: f64 = 0.5 * crate::COORDINATE_LIMIT;

/// The part of a ray in a box, a hair beyond its faces.
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
