//! What a march knows of its cell, and the rays in it; `g` is the value turned, as in `march`.

use glam::{DVec3, Vec3};

use super::cells::{Cell, Cells};
use super::slopes::{Known, Slopes};
use crate::Bounds;
use crate::eval::{Bend, Tape};

/// A ray under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// Where it enters the box of all cells, or its own origin in there.
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    pub(super) inverse: DVec3,
    /// How far `origin` is from the ray's own.
    pub(super) base: f64,
    /// Whether it starts inside the solid.
    pub(super) inside: bool,
}

/// The part of a ray in the cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) ray: u32,
    pub(super) near: f64,
    pub(super) far: f64,
}

/// A ray in the cell, in single precision relative to the tape's origin, distances from the
/// span's near end.
#[derive(Clone, Copy)]
pub(super) struct Lane {
    /// The number of its span.
    pub(super) span: u32,
    pub(super) start: [f32; 3],
    pub(super) direction: [f32; 3],
    /// Turns the value into g.
    pub(super) turn: f32,
    /// Nothing is crossed before `left`; `right` is the far end or, if g is positive there,
    /// beyond a crossing.
    pub(super) left: f32,
    pub(super) right: f32,
    /// g and its slope at `left` and `right`, where they are known.
    pub(super) g_left: f32,
    pub(super) s_left: f32,
    pub(super) g_right: f32,
    pub(super) s_right: f32,
    /// Where it is evaluated next.
    pub(super) at: f32,
    /// Whether that is a probe beyond `left`.
    pub(super) probe: bool,
}

/// What the field is like where a lane is.
#[derive(Clone, Copy)]
pub(super) struct Local {
    /// The value, turned, and its slope along the ray.
    pub(super) g: f32,
    pub(super) s: f32,
    /// The gradient of the value.
    pub(super) gradient: Vec3,
}

/// Steps of a single ray in double precision.
const ROUNDS: usize = 48;

/// A Newton step below this part of the cell's side is the last one in single precision.
const LAST_STEP: f32 = 3e-4;

/// Depths this exact, in proportion to the solid, need no step in double precision.
const FINE: f64 = 6e-6;

/// A step in double precision below this is the last one, in proportion to the solid.
const SETTLED: f64 = 1e-5;

/// Crossings nearer to each other than this, in proportion to the solid, are one; so are those
/// within a few lengths of the doubt where that is larger, as it is of fillets and chamfers.
const CLOSE: f64 = 8e-5;
const DOUBTS: f64 = 16.0;

/// What the tangents tell.
pub(super) enum Outcome {
    Miss,
    /// A crossing, and no other, between these distances.
    Between(f64, f64),
    Open,
}

impl Lane {
    /// Goes to `next`, or, if that is not in the bracket, to its left end or, if that is known, to
    /// its middle.
    #[inline(always)]
    pub(super) fn aim(&mut self, next: f32) {
        let within = next > self.left && next < self.right;
        let middle = 0.5 * (self.left + self.right);
        let other = if self.g_left.is_nan() { self.left } else { middle };
        self.at = if within { next } else { other };
    }
}

/// What a march knows of its cell.
pub(super) struct Job<'a> {
    pub(super) cell: &'a Cell,
    pub(super) rays: &'a [Ray],
    pub(super) spans: &'a [Span],
    pub(super) tape: &'a Tape,
    pub(super) center: DVec3,
    pub(super) reach: Bounds,
    pub(super) bend: Option<Bend>,
    pub(super) owner: Option<u32>,
    /// Slopes of the value along the rays, and bounds of them with rounding allowed for.
    known: Slopes,
    least: f32,
    most: f32,
    /// Values this small may have the wrong sign.
    pub(super) doubt: f32,
    pub(super) last_step: f32,
    pub(super) close: f32,
    pub(super) fine: f32,
    pub(super) far_off: f64,
    pub(super) settled: f64,
    pub(super) size: f64,
}

impl<'a> Job<'a> {
    pub(super) fn new(cells: &Cells, cell: &'a Cell, known: &Known, rays: &'a [Ray], spans: &'a [Span]) -> Job<'a> {
        let slopes = known.slopes;
        let tape = cell.tape();
        let reach = cells.reach();
        let size = reach.longest_side();
        let outward = |v: f64, by: f64| (v + by * (1e-6 * v.abs() + 1e-12)) as f32;
        // Where the ranges of slopes tell nothing, leaves may.
        let steepest = cell.program.steepest_leaf().map_or(f32::INFINITY, |slope| outward(slope, 1.0));
        Job {
            cell,
            rays,
            spans,
            tape,
            center: tape.origin(),
            reach,
            bend: cell.bend,
            owner: cell.program.only_leaf(),
            known: slopes,
            least: outward(slopes.value.lo(), -1.0).max(-steepest),
            most: outward(slopes.value.hi(), 1.0).min(steepest),
            doubt: tape.roundoff() as f32,
            last_step: LAST_STEP * cell.side() as f32,
            close: (CLOSE * size).max(DOUBTS * tape.roundoff()) as f32,
            fine: (FINE * size) as f32,
            far_off: (1e-3 * cell.side()).min(1e-4 * size),
            settled: SETTLED * size,
            size,
        }
    }

    /// Turns the value along a ray into g.
    pub(super) fn turn(&self, ray: u32) -> f64 {
        if self.rays[ray as usize].inside { -1.0 } else { 1.0 }
    }

    /// The value in double precision.
    pub(super) fn value(&self, ray: u32, t: f64) -> f64 {
        let Ray { origin, direction, .. } = self.rays[ray as usize];
        self.cell.program.value(origin + t * direction)
    }

    /// The point this far beyond where the lane is.
    pub(super) fn point(&self, lane: &Lane, ahead: f64) -> DVec3 {
        let Span { ray, near, .. } = self.spans[lane.span as usize];
        let Ray { origin, direction, .. } = self.rays[ray as usize];
        origin + (near + f64::from(lane.at) + ahead) * direction
    }

    /// What is known of the slopes of g along the ray.
    pub(super) fn known(&self, lane: &Lane) -> Slopes {
        if lane.turn < 0.0 { self.known.turned() } else { self.known }
    }

    /// Bounds of the slope of g along the ray.
    pub(super) fn slopes(&self, lane: &Lane) -> (f32, f32) {
        if lane.turn < 0.0 { (-self.most, -self.least) } else { (self.least, self.most) }
    }

    /// How g bends along the ray.
    pub(super) fn bends(&self, lane: &Lane) -> Option<Bend> {
        self.bend.map(|bend| if lane.turn < 0.0 { bend.turned() } else { bend })
    }

    /// A ray along which g bends downwards, in double precision: by Newton's method from the near
    /// end, which never passes the first crossing.
    pub(super) fn tangents(&self, ray: u32, near: f64, far: f64) -> Outcome {
        let Ray { origin, direction, inside, .. } = self.rays[ray as usize];
        let (turn, wanted) = if inside { (-1.0, Bend::Convex) } else { (1.0, Bend::Concave) };
        if self.bend != Some(wanted) {
            return Outcome::Open;
        }
        let at = |t: f64| {
            let (value, gradient) = self.cell.program.gradient(origin + t * direction);
            (turn * value, turn * gradient.dot(direction))
        };
        let mut t = near;
        for _ in 0..ROUNDS {
            let (g, s) = at(t);
            if g >= 0.0 {
                // Rounding has put it a little beyond.
                let before = (t - 1e-6 * self.size).max(near);
                let after = (t + 1e-8 * self.size).min(far);
                return if at(before).0 < 0.0 { Outcome::Between(before, after) } else { Outcome::Open };
            }
            let next = t - g / s;
            if s <= 0.0 || next > far {
                return Outcome::Miss;
            }
            if next - t <= 1e-9 * self.size {
                let (before, after) = ((t - 1e-8 * self.size).max(near), (next + 1e-8 * self.size).min(far));
                if at(after).0 > 0.0 {
                    return Outcome::Between(before, after);
                }
            }
            if next <= t {
                return Outcome::Open;
            }
            t = next;
        }
        Outcome::Open
    }

    pub(super) fn span(&self, lane: &Lane) -> Span {
        self.spans[lane.span as usize]
    }

    /// What of the lane's span nothing is known of.
    pub(super) fn rest(&self, lane: &Lane) -> Span {
        let span = self.span(lane);
        Span { near: span.near + f64::from(lane.left), ..span }
    }
}
