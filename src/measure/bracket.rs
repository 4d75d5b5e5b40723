//! How much of a cell is inside a solid: at least, at most, and more or less.
//!
//! ```text
//!    \  inside, for certain  /        Through a point of the surface goes a plane. The surface is
//!      \                   /          turned from it by an angle at most, so that it stays between
//!  -------\------q------/-------      the plane turned one way and the other: cones about q, whose
//!           \       /                 volume within the cell is known.
//!      outside, for certain
//! ```
//!
//! * The value of a convex leaf, and of intersections of them, is concave: nowhere above its
//!   tangents, nowhere below what is linear between the corners of a tetrahedron. Both are known
//!   after nine values. Of complements it is the other way round.
//! * Of other formulas the ranges of the value's slopes over the cell tell the plane and the angle
//!   (the mean-value form). The cones are linear functions in each of the eight boxes about q.
//! * Where there may be creases, the cell is [cut](super::cuts) by the planes of all that meet
//!   there.
//! * What is searched for, folded or deformed, tells the directions along which it is entered, and
//!   not left: from a point inside all that lies along them is inside.

use glam::DVec3;

use super::clip::{self, Linear};
use super::cuts;
use super::moments::Moments;
use super::polytope::Plane;
use crate::Bounds;
use crate::eval::Bend;
use crate::program::Program;
use rvachev_field::{Way, Zone};

/// Values are off by rounding, as parts of the coordinates: less than this.
pub(super) const ROUNDING: f64 = 1e-13;

/// Angles that the surface may be turned by, as their tangents. Each takes four directions, so that
/// two are asked about at a time.
const ANGLES: [f64; 14] = [1e-5, 1e-3, 3e-3, 7e-3, 0.013, 0.022, 0.035, 0.055, 0.085, 0.13, 0.2, 0.32, 0.5, 1.0];

/// Where more than these parts of a cell are open, other ways of telling are tried: planes of all
/// parts of the program, and directions.
const SOME: f64 = 0.05;
const MUCH: f64 = 0.5;

/// How near to each other points inside and outside are found, as a part of the cell's diagonal.
const NEAR: f64 = 1e-6;

/// Steps that this takes at most.
const STEPS: usize = 60;

/// What a cell has of a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    /// The volume inside is at least and at most this.
    pub(super) least: f64,
    pub(super) most: f64,
    /// Of a part of the cell that holds the first and is held by the second.
    pub(super) moments: Moments,
}

impl Held {
    /// A cell that is all inside.
    pub(super) fn whole(cell: &Bounds) -> Held {
        let moments = Moments::cuboid(cell.center(), cell.size());
        Held { least: moments.volume, most: moments.volume, moments }
    }

    /// What is not certain of the volume.
    pub(super) fn open(&self) -> f64 {
        self.most - self.least
    }
}

/// A cone about a point: where `value + slope·(x − at) − Σ spread |x − at|` is positive.
struct Cone {
    at: DVec3,
    value: f64,
    slope: DVec3,
    spread: DVec3,
}

/// What is certain of a cell.
struct Bracket {
    inside: Option<Cone>,
    outside: Option<Cone>,
    /// Between them.
    plane: Linear,
}

/// What a cell, which the surface of the program may cross, has of the solid.
pub(super) fn held(program: &Program, cell: &Bounds) -> Held {
    let whole = cell.size().element_product();
    let is_smooth = program.is_steady() && !program.jumps();
    let first = by_concavity(program, cell).or_else(|| is_smooth.then(|| by_slopes(program, cell).held(cell)));
    let less = |best: Option<Held>, other: Held| best.filter(|best| best.open() <= other.open()).unwrap_or(other);
    let leaves = |best: Option<Held>, part: f64| best.is_none_or(|best| best.open() >= part * whole);
    let mut best = first;
    if leaves(best, SOME)
        && let Some(cut) = cuts::held(program, cell)
    {
        best = Some(less(best, cut));
    }
    match best {
        Some(best) if best.open() < MUCH * whole => best,
        _ => less(best, by_directions(program, cell).held(cell)),
    }
}

/// By slopes, a plane about the middle of a cell, and the volume between what it says is inside and
/// what is; nothing of what need not change as its slopes say.
pub(super) fn by_plane(program: &Program, cell: &Bounds) -> Option<(Plane, f64)> {
    if !program.is_steady() || program.jumps() {
        return None;
    }
    let bracket = by_slopes(program, cell);
    let Linear { at, value, slope } = bracket.plane;
    let plane = Plane::of(at - cell.center(), value, slope)?;
    Some((plane, bracket.held(cell).open()))
}

impl Bracket {
    fn held(self, cell: &Bounds) -> Held {
        let whole = cell.size().element_product();
        let volume = |cone: Option<Cone>| cone.map_or(0.0, |cone| cone.volume_in(cell));
        let moments = self.plane.moments_in(cell);
        Held { least: volume(self.inside), most: whole - volume(self.outside), moments }
    }
}

/// Of a concave or convex value: between the tangent at the point that is nearest to the surface,
/// and what is linear between the corners.
fn by_concavity(program: &Program, cell: &Bounds) -> Option<Held> {
    let is_complement = program.bend_over(&Zone::of_bounds(cell))? == Bend::Convex;
    let sign = if is_complement { -1.0 } else { 1.0 };
    let at = nearest_to_surface(cell, program.gradient(cell.center()));
    let (value, slope) = program.gradient(at);
    let tangent = Linear { at, value: sign * value, slope: sign * slope };
    let corners = cell.corners().map(|corner| sign * program.value(corner));
    let rounding = ROUNDING * (value.abs() + reach(cell) * slope.abs().max_element());
    let outer = Linear { value: tangent.value + rounding, ..tangent };
    let (inner, outer) = (clip::between(cell, corners.map(|value| value - rounding)), outer.moments_in(cell));
    // Rounding may turn their order.
    let (least, most) = (inner.volume.min(outer.volume), outer.volume.max(inner.volume));
    let mut moments = inner;
    moments.add(&outer);
    let moments = moments.times(0.5);
    let whole = Held::whole(cell);
    Some(if is_complement {
        Held { least: whole.least - most, most: whole.most - least, moments: whole.moments.less(&moments) }
    } else {
        Held { least, most, moments }
    })
}

/// The point of a cell that is nearest to where a linear function, by its value and slope at the
/// middle, is 0.
fn nearest_to_surface(cell: &Bounds, (value, slope): (f64, DVec3)) -> DVec3 {
    let step = value / slope.length_squared() * slope;
    if step.is_finite() { (cell.center() - step).clamp(cell.min, cell.max) } else { cell.center() }
}

/// The largest coordinate in absolute value.
fn reach(cell: &Bounds) -> f64 {
    cell.min.abs().max(cell.max.abs()).max_element()
}

impl Cone {
    fn volume_in(&self, cell: &Bounds) -> f64 {
        let mut volume = 0.0;
        for octant in 0..8 {
            let is_upper = |axis: usize| octant >> axis & 1 == 1;
            let (mut part, mut slope) = (*cell, self.slope);
            for axis in 0..3 {
                if is_upper(axis) {
                    part.min[axis] = self.at[axis];
                    slope[axis] -= self.spread[axis];
                } else {
                    part.max[axis] = self.at[axis];
                    slope[axis] += self.spread[axis];
                }
            }
            if part.size().min_element() > 0.0 {
                volume += Linear { at: self.at, value: self.value, slope }.volume_in(&part);
            }
        }
        volume
    }
}

/// By the ranges of the slopes, and the value at the point of the cell that is nearest to the
/// surface by the slope at its middle.
fn by_slopes(program: &Program, cell: &Bounds) -> Bracket {
    let ranges = program.slopes(cell);
    let vector = |of: [f64; 3]| DVec3::from_array(of);
    let slope = vector(ranges.map(|range| range.mid()));
    let spread = vector(ranges.map(|range| 0.5 * range.width())) + ROUNDING * slope.abs();
    let at = nearest_to_surface(cell, (program.value(cell.center()), slope));
    let value = program.value(at);
    let plane = Linear { at, value, slope: if slope.is_finite() { slope } else { DVec3::ZERO } };
    if !(slope.is_finite() && spread.is_finite()) {
        return Bracket { inside: None, outside: None, plane };
    }
    let rounding = ROUNDING * (value.abs() + reach(cell) * (slope.abs() + spread).max_element());
    Bracket {
        inside: Some(Cone { at, value: value - rounding, slope, spread }),
        outside: Some(Cone { at, value: -value - rounding, slope: -slope, spread }),
        plane,
    }
}

/// By the directions along which the cell is entered, from points on both sides of the surface.
fn by_directions(program: &Program, cell: &Bounds) -> Bracket {
    let (value, slope) = program.gradient(cell.center());
    let normal = slope.normalize_or(DVec3::Z);
    let unknown = Bracket {
        inside: None,
        outside: None,
        plane: Linear { at: cell.center(), value, slope: if slope.is_finite() { slope } else { DVec3::ZERO } },
    };
    let Some(spread) = turned_at_most(program, cell, normal) else { return unknown };
    // Along the diagonal from the point that is farthest against the normal to the one along it.
    let half = cell.half_extents() * normal.signum();
    let ends = [cell.center() - half, cell.center() + half];
    let values = ends.map(|p| program.value(p));
    let (out, inner) = match values.map(|value| value > 0.0) {
        [false, true] => {
            let [out, inner] = about_surface(program, ends, values);
            (Some(out), Some(inner))
        }
        [true, true] => (None, Some(ends[0])),
        [false, false] => (Some(ends[1]), None),
        // It is left along the normal: what is told of it is not true.
        [true, false] => return unknown,
    };
    let cone = |at: DVec3, slope: DVec3| Cone { at, value: 0.0, slope, spread };
    let at = out.or(inner).unwrap_or(ends[0]);
    Bracket {
        inside: inner.map(|at| cone(at, normal)),
        outside: out.map(|at| cone(at, -normal)),
        plane: Linear { at, value: 0.0, slope: normal },
    }
}

/// Points outside and inside that are near each other, between one outside and one inside, by the
/// values there: just before and just behind where the secant is 0, or the middle.
fn about_surface(program: &Program, [mut out, mut inner]: [DVec3; 2], [mut below, mut above]: [f64; 2]) -> [DVec3; 2] {
    let enough = NEAR * out.distance(inner);
    for step in 0..STEPS {
        let aside = 0.5 * enough / out.distance(inner);
        if aside >= 0.5 {
            break;
        }
        let secant = below / (below - above);
        let t = match step % 3 {
            0 => secant - aside,
            1 => secant + aside,
            _ => 0.5,
        };
        // Values need not be finite.
        let t = if t.is_nan() { 0.5 } else { t.clamp(0.5 * aside, 1.0 - 0.5 * aside) };
        let p = out.lerp(inner, t);
        let value = program.value(p);
        if value > 0.0 {
            (inner, above) = (p, value);
        } else {
            (out, below) = (p, value);
        }
    }
    [out, inner]
}

/// How far the surface in a cell may be turned from a normal, as the spread of a cone.
fn turned_at_most(program: &Program, cell: &Bounds, normal: DVec3) -> Option<DVec3> {
    let zone = Zone::of_bounds(cell);
    let aside = normal.any_orthonormal_vector();
    let across = [aside, normal.cross(aside)];
    let sides = [across[0], -across[0], across[1], -across[1]];
    let ways = |at: usize| sides.map(|side| Way { middle: side + ANGLES[at] * normal, sway: 0.0 });
    // The least of the angles that holds is from `least` on and below `most`.
    let (mut least, mut most) = (0, ANGLES.len());
    while least < most {
        let [low, high] = [least + (most - least) / 3, least + 2 * (most - least) / 3];
        let found = program.enters(&zone, &[ways(low), ways(high)].concat(), 0.0);
        if found & 0xf == 0xf {
            most = low;
        } else if found & 0xf0 == 0xf0 {
            (least, most) = (low + 1, high);
        } else {
            least = high + 1;
        }
    }
    ANGLES.get(least).map(|tangent| *tangent * (across[0].abs() + across[1].abs()))
}
