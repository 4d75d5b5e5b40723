//! Many rays through one cell, in bulk.
//!
//! Every ray comes with the sign that the value has where the ray enters: it has not crossed the
//! surface before. With `g` the value turned so that it is negative there,
//!
//! ```text
//!      g                    .--   a crossing for certain if g > 0 at the far end; the only one
//!      |                 .-'      if g rises all along the ray, or bends one way only
//!    --+---------------.'------   a miss for certain if g < 0 there and g rises or falls all
//!      | near      .--'    far    along, or bends upwards, or tangents from both ends meet
//!      |  ___...--'               below 0, or the bounds on the slope do
//! ```
//!
//! Where g bends downwards, Newton's method from the near end never passes a crossing, and what
//! takes it long is bounded by the tangents from both ends. Where g may turn, its far end is not
//! asked. What is open is looked at from the near end in steps as long as the bounds on the slope
//! allow, or in steps that the bounds from both of their ends cover. A bracketed Newton iteration
//! in single precision and steps in double precision (`exact`) find the crossing. Signs of values
//! within the rounding error of single precision are looked up in double precision; a ray that
//! takes too many steps, or of whose slopes nothing is known, is divided by intervals
//! (`eval::first_hit`). Bounds on the slope are those of its range in the cell, or of the leaves.

use glam::{DVec3, Vec3};

use super::beside::{Crossing, Walk};
use super::cells::{Cell, Cells};
use super::exact::Owners;
use super::gbuffer::Surface;
use super::job::{Job, Lane, Local, Outcome, Ray, Span};
use super::roll::Ball;
use super::slopes::{Known, Slopes};
use crate::eval::{Bend, Care, Evaluator, Gradients, first_hit};

/// A crossing found in single precision.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) lane: Lane,
    pub(super) slope: f32,
    pub(super) gradient: Vec3,
    /// How far double precision has led beyond the lane's `at`.
    pub(super) ahead: f64,
}

/// Steps of the searches, after which rays are divided by intervals.
pub(super) const TANGENTS: usize = 8;
const NEWTON: usize = 16;

/// Of programs that cost more, in ordinary leaves, gradients are not for every ray.
const DEAR: usize = 8;

/// Slopes in single precision are trusted to this part.
pub(super) const SLOPE_ERROR: f32 = 1e-3;

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Marcher {
    pub(super) evaluator: Evaluator,
    pub(super) single: [Vec<f32>; 7],
    pub(super) double: [Vec<f64>; 4],
    near: Vec<Lane>,
    far: Vec<Lane>,
    pub(super) search: Vec<Lane>,
    unique: Vec<Lane>,
    pub(super) found: Vec<Found>,
    pub(super) doubtful: Vec<Found>,
    pub(super) open: Vec<Span>,
    /// Hits whose owners are still sought, relative to the tape's origin, and the values that
    /// decide there.
    pub(super) unowned: Vec<(u32, DVec3)>,
    pub(super) walks: Vec<Walk>,
    pub(super) crossed: Vec<Walk>,
    pub(super) crossings: Vec<Crossing>,
    pub(super) owners: Owners,
    /// Balls that rays have met.
    pub(super) known: Vec<Ball>,
    /// The rays that have hit something.
    pub(super) hits: Vec<u32>,
}

impl Marcher {
    /// Marches the spans' rays through `cell`, where slopes along them are `known`; what they hit
    /// goes to `surfaces`, by ray, and the numbers of those rays to `hits`.
    pub(super) fn march(
        &mut self,
        cells: &Cells,
        cell: &Cell,
        known: &Known,
        rays: &[Ray],
        spans: &[Span],
        surfaces: &mut [Surface],
    ) {
        self.open.clear();
        self.found.clear();
        let job = Job::new(cells, cell, known, rays, spans);
        match &known.sides {
            Some(sides) => self.walk(&job, sides, surfaces),
            None => self.search(&job, surfaces),
        }
        for &Span { ray, near, far } in &self.open {
            let Ray { origin, direction, base, .. } = rays[ray as usize];
            let first =
                |near, far| first_hit(&cell.program, &job.reach, (origin, direction), [near, far], Care::Picture);
            let hit = match job.tangents(ray, near, far) {
                Outcome::Miss => continue,
                Outcome::Between(before, after) => first(before, after).or_else(|| first(near, far)),
                Outcome::Open => first(near, far),
            };
            if let Some(hit) = hit {
                surfaces[ray as usize] =
                    Surface { distance: base + hit.distance, normal: hit.normal.as_vec3(), owner: hit.owner };
                self.hits.push(ray);
            }
        }
    }

    /// The crossings of rays along which slopes have bounds.
    fn search(&mut self, job: &Job<'_>, surfaces: &mut [Surface]) {
        self.load(job);
        self.near_ends(job);
        self.far_ends(job);
        if job.bend.is_some() {
            self.search_bent(job);
        } else {
            if job.cell.rolled.is_some() {
                self.roll(job);
            }
            self.search_steep(job);
        }
        self.newton(job);
        self.settle(job);
        self.finish(job, surfaces);
    }

    /// The lanes of the spans: those along which g bends downwards start at the near end.
    pub(super) fn load(&mut self, job: &Job<'_>) {
        self.near.clear();
        self.far.clear();
        self.search.clear();
        self.unique.clear();
        for (number, span) in (0..).zip(job.spans) {
            let ray = &job.rays[span.ray as usize];
            let start = ray.origin + span.near * ray.direction - job.center;
            let len = (span.far - span.near) as f32;
            let mut lane = Lane {
                span: number,
                start: start.as_vec3().to_array(),
                direction: ray.direction.as_vec3().to_array(),
                turn: if ray.inside { -1.0 } else { 1.0 },
                left: 0.0,
                right: len,
                g_left: f32::NAN,
                s_left: 0.0,
                g_right: 0.0,
                s_right: 0.0,
                at: 0.0,
                probe: false,
            };
            let known = job.known(&lane);
            if job.bends(&lane) == Some(Bend::Concave) {
                self.near.push(lane);
            } else if job.bend.is_none() && !known.rises && !known.falls {
                // Whatever its far end tells, it is searched from the near one.
                self.search.push(lane);
            } else {
                lane.at = len;
                self.far.push(lane);
            }
        }
    }

    /// Evaluates lanes at `at`, their values alone or with gradients.
    fn evaluate(&mut self, job: &Job<'_>, lanes: &[Lane], alone: bool) {
        let [x, y, z, value, dx, dy, dz] = points(&mut self.single, lanes);
        if alone {
            self.evaluator.shortest_values(job.tape, [x, y, z], value);
            [dx, dy, dz].into_iter().for_each(|list| list.fill(f32::NAN));
        } else {
            self.evaluator.shortest_gradients(job.tape, [x, y, z], Gradients { value, dx, dy, dz });
        }
    }

    /// Evaluates lanes at `at` and calls `visit` with each; those for which it gives `true` stay,
    /// in their order.
    pub(super) fn sift(
        &mut self,
        job: &Job<'_>,
        lanes: &mut Vec<Lane>,
        visit: impl FnMut(&mut Lists<'_>, &mut Lane, Local) -> bool,
    ) {
        self.evaluate(job, lanes, false);
        self.visit(lanes, visit);
    }

    /// Calls `visit` with each lane and what it was evaluated to.
    fn visit(&mut self, lanes: &mut Vec<Lane>, mut visit: impl FnMut(&mut Lists<'_>, &mut Lane, Local) -> bool) {
        let count = lanes.len();
        let [_, _, _, value, dx, dy, dz] = self.single.each_ref().map(|list| &list[..count]);
        let mut lists = Lists {
            search: &mut self.search,
            unique: &mut self.unique,
            found: &mut self.found,
            doubtful: &mut self.doubtful,
            open: &mut self.open,
        };
        let mut kept = 0;
        for i in 0..count {
            let mut lane = lanes[i];
            let gradient = Vec3::new(dx[i], dy[i], dz[i]);
            let slope = gradient.dot(Vec3::from_array(lane.direction));
            let local = Local { g: lane.turn * value[i], s: lane.turn * slope, gradient };
            if visit(&mut lists, &mut lane, local) {
                lanes[kept] = lane;
                kept += 1;
            }
        }
        lanes.truncate(kept);
    }

    /// Lanes along which g bends downwards, from the near end: a step of Newton's never passes
    /// the first crossing, and where the tangent does not meet 0 there is none.
    fn near_ends(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.near);
        for _ in 0..TANGENTS {
            if lanes.is_empty() {
                break;
            }
            self.sift(job, &mut lanes, |lists, lane, Local { g, s, gradient }| {
                if g > job.doubt {
                    if lane.at > 0.0 {
                        (lane.right, lane.g_right, lane.s_right) = (lane.at, g, s);
                        lane.aim(lane.at - g / s);
                        lists.unique.push(*lane);
                    } else {
                        // The ray has crossed already, at the border to this cell.
                        lists.open.push(job.span(lane));
                    }
                    return false;
                }
                let rise = s + SLOPE_ERROR * s.abs() + 1e-6;
                let ahead = lane.right - lane.at;
                if g + job.doubt + rise * ahead <= 0.0 {
                    return false;
                }
                let step = -g / s;
                if s > 0.0 && step.abs() <= job.last_step {
                    if job.doubt > job.close * s {
                        lists.open.push(job.span(lane));
                        return false;
                    }
                    lane.at += step;
                    lists.found.push(Found { lane: *lane, slope: s, gradient, ahead: 0.0 });
                    return false;
                }
                (lane.left, lane.g_left, lane.s_left) = (lane.at, g, s);
                if !(step > 0.0 && step < ahead) {
                    // Nearly level: the far end tells more.
                    lane.at = lane.right;
                    lists.search.push(*lane);
                    return false;
                }
                lane.at += step;
                true
            });
        }
        for lane in &mut lanes {
            lane.at = lane.right;
        }
        self.search.append(&mut lanes);
        self.near = lanes;
    }

    /// Sorts the other lanes by what their far ends tell.
    fn far_ends(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.far);
        if lanes.is_empty() {
            self.far = lanes;
            return;
        }
        // Most of these rays miss: gradients of long formulas are for those that do not.
        self.evaluate(job, &lanes, job.cell.cost > DEAR && job.bend.is_none());
        self.visit(&mut lanes, |lists, lane, Local { mut g, s, .. }| {
            if g.abs() <= job.doubt {
                let Span { ray, far, .. } = job.span(lane);
                let crossed = (job.value(ray, far) > 0.0) != (lane.turn < 0.0);
                g = if crossed { f32::MIN_POSITIVE } else { -f32::MIN_POSITIVE };
            }
            (lane.g_right, lane.s_right) = (g, s);
            let Slopes { rises, .. } = job.known(lane);
            if g > 0.0 && (rises || job.bend.is_some()) {
                lane.aim(lane.right - g / s);
                lists.unique.push(*lane);
            } else if g > 0.0 {
                lane.at = 0.0;
                lists.search.push(*lane);
            }
            false
        });
        self.far = lanes;
    }

    /// The crossings between `left` and `right`, where g changes its sign: Newton's method,
    /// halving where it leaves the bracket.
    fn newton(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.unique);
        for _ in 0..NEWTON {
            if lanes.is_empty() {
                break;
            }
            self.sift(job, &mut lanes, |lists, lane, Local { g, s, gradient }| {
                if g < 0.0 {
                    (lane.left, lane.g_left) = (lane.left.max(lane.at), g);
                } else {
                    lane.right = lane.right.min(lane.at);
                }
                let next = lane.at - g / s;
                // Where rounding in single precision hides the sign, double precision goes on.
                let is_close = g.abs() <= job.doubt && next >= lane.left && next <= lane.right;
                if s > 0.0 && (is_close || (next - lane.at).abs() <= job.last_step) {
                    lane.at = next;
                    lists.found.push(Found { lane: *lane, slope: s, gradient, ahead: 0.0 });
                    return false;
                }
                if g.abs() <= job.doubt {
                    lists.open.push(job.span(lane));
                    return false;
                }
                lane.aim(next);
                true
            });
        }
        self.open.extend(lanes.iter().map(|lane| job.span(lane)));
        lanes.clear();
        self.unique = lanes;
    }
}

/// Where lanes are at `at`, and lists of as many numbers.
pub(super) fn points<'a>(lists: &'a mut [Vec<f32>; 7], lanes: &[Lane]) -> [&'a mut [f32]; 7] {
    let count = lanes.len();
    for list in &mut *lists {
        if list.len() < count {
            list.resize(count, 0.0);
        }
    }
    let mut lists = lists.each_mut().map(|list| &mut list[..count]);
    let [x, y, z, ..] = &mut lists;
    for (((lane, x), y), z) in lanes.iter().zip(&mut **x).zip(&mut **y).zip(&mut **z) {
        *x = lane.start[0] + lane.at * lane.direction[0];
        *y = lane.start[1] + lane.at * lane.direction[1];
        *z = lane.start[2] + lane.at * lane.direction[2];
    }
    lists
}

/// Where lanes go from a step.
pub(super) struct Lists<'a> {
    pub(super) search: &'a mut Vec<Lane>,
    pub(super) unique: &'a mut Vec<Lane>,
    pub(super) found: &'a mut Vec<Found>,
    pub(super) doubtful: &'a mut Vec<Found>,
    pub(super) open: &'a mut Vec<Span>,
}
