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
//! What is left open by the far end is looked at from the near end, in steps that cannot pass a
//! crossing: up to where the tangents from both ends meet if g bends downwards (its value there
//! bounds it), else as far as the bounds on the slope allow. A bracketed Newton iteration in
//! single precision and one step in double precision find the crossing. Signs of values within
//! the rounding error of single precision are looked up in double precision; a ray that takes too
//! many steps is divided by intervals (`eval::first_hit`).

use glam::{DVec3, Vec3};

use super::cells::{Cell, Cells};
use super::gbuffer::Surface;
use crate::Hit;
use crate::eval::{Bend, Evaluator, Gradients, first_hit};

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
struct Lane {
    span: Span,
    start: [f32; 3],
    direction: [f32; 3],
    /// Turns the value into g.
    turn: f32,
    /// Nothing is crossed before `left`; `right` is the far end or, if g is positive there,
    /// beyond a crossing.
    left: f32,
    right: f32,
    /// g and its slope at `left` and `right`, where they are known.
    g_left: f32,
    s_left: f32,
    g_right: f32,
    s_right: f32,
    /// Where it is evaluated next.
    at: f32,
    /// Whether that is a probe beyond `left`.
    probe: bool,
}

/// A crossing found in single precision.
#[derive(Clone, Copy)]
struct Found {
    lane: Lane,
    slope: f32,
    normal: Vec3,
}

/// Steps of the searches, after which rays are divided by intervals.
const SEARCH: usize = 24;
const NEWTON: usize = 16;

/// A Newton step below this part of the cell's side is the last one in single precision.
const LAST_STEP: f32 = 3e-4;

/// Slopes in single precision are trusted to this part.
const SLOPE_ERROR: f32 = 1e-3;

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Marcher {
    evaluator: Evaluator,
    single: [Vec<f32>; 7],
    double: [Vec<f64>; 4],
    lanes: Vec<Lane>,
    search: Vec<Lane>,
    unique: Vec<Lane>,
    found: Vec<Found>,
    open: Vec<Span>,
    /// The rays that hit something in the last march.
    pub(super) hits: Vec<u32>,
}

impl Marcher {
    /// Marches the spans' rays through `cell`; what they hit goes to `surfaces`, by ray.
    pub(super) fn march(&mut self, cells: &Cells, cell: &Cell, rays: &[Ray], spans: &[Span], surfaces: &mut [Surface]) {
        self.hits.clear();
        self.open.clear();
        self.found.clear();
        self.search.clear();
        self.unique.clear();
        let job = Job::new(cells, cell, rays);
        self.load(&job, spans);
        self.far_ends(&job);
        if !self.search.is_empty() {
            match cell.bend {
                Some(_) => self.search_bent(&job),
                None => self.search_steep(&job),
            }
        }
        self.newton(&job);
        self.polish(&job, surfaces);
        for at in 0..self.open.len() {
            let Span { ray, near, far } = self.open[at];
            let Ray { origin, direction, .. } = rays[ray as usize];
            if let Some(hit) = first_hit(&cell.program, &job.reach, origin, direction, near, far) {
                self.settle(&job, ray, hit, surfaces);
            }
        }
    }

    fn settle(&mut self, job: &Job<'_>, ray: u32, hit: Hit, surfaces: &mut [Surface]) {
        let Ray { base, .. } = job.rays[ray as usize];
        surfaces[ray as usize] =
            Surface { distance: base + hit.distance, normal: hit.normal.as_vec3(), owner: hit.owner };
        self.hits.push(ray);
    }

    /// The lanes of the spans.
    fn load(&mut self, job: &Job<'_>, spans: &[Span]) {
        self.lanes.clear();
        self.lanes.extend(spans.iter().map(|&span| {
            let ray = &job.rays[span.ray as usize];
            let start = ray.origin + span.near * ray.direction - job.center;
            let len = (span.far - span.near) as f32;
            Lane {
                span,
                start: start.as_vec3().to_array(),
                direction: ray.direction.as_vec3().to_array(),
                turn: if ray.inside { -1.0 } else { 1.0 },
                left: 0.0,
                right: len,
                g_left: f32::NAN,
                s_left: 0.0,
                g_right: 0.0,
                s_right: 0.0,
                at: len,
                probe: false,
            }
        }));
    }

    /// Evaluates the first of the lists of lanes at `at`.
    fn evaluate(&mut self, job: &Job<'_>, lanes: &[Lane]) {
        let [x, y, z, v, dx, dy, dz] = &mut self.single;
        let count = lanes.len();
        for list in [&mut *x, &mut *y, &mut *z] {
            list.clear();
        }
        for lane in lanes {
            let [a, b, c] = lane.start;
            let [d, e, f] = lane.direction;
            x.push(a + lane.at * d);
            y.push(b + lane.at * e);
            z.push(c + lane.at * f);
        }
        for list in [&mut *v, &mut *dx, &mut *dy, &mut *dz] {
            if list.len() < count {
                list.resize(count, 0.0);
            }
        }
        let out =
            Gradients { value: &mut v[..count], dx: &mut dx[..count], dy: &mut dy[..count], dz: &mut dz[..count] };
        self.evaluator.gradients(job.tape, x, y, z, out);
    }

    /// g, its slope along the ray and the gradient of the value for lane number `i`.
    fn result(&self, i: usize, lane: &Lane) -> (f32, f32, Vec3) {
        let [_, _, _, v, dx, dy, dz] = &self.single;
        let gradient = Vec3::new(dx[i], dy[i], dz[i]);
        let slope = gradient.dot(Vec3::from_array(lane.direction));
        (lane.turn * v[i], lane.turn * slope, gradient)
    }

    /// Sorts the lanes by what their far ends tell.
    fn far_ends(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.lanes);
        self.evaluate(job, &lanes);
        for (i, lane) in lanes.iter_mut().enumerate() {
            let (mut g, s, _) = self.result(i, lane);
            if g.abs() <= job.doubt {
                let inside = job.value(lane.span.ray, lane.span.far) > 0.0;
                let crossed = inside != (lane.turn < 0.0);
                g = if crossed { f32::MIN_POSITIVE } else { -f32::MIN_POSITIVE };
            }
            (lane.g_right, lane.s_right) = (g, s);
            let (lo, hi) = job.slopes(lane);
            let rises = lo >= 0.0;
            if g > 0.0 {
                if rises || job.bend.is_some() {
                    let newton = lane.right - g / s;
                    lane.at = if newton > 0.0 && newton < lane.right { newton } else { 0.5 * lane.right };
                    self.unique.push(*lane);
                } else {
                    lane.at = 0.0;
                    self.search.push(*lane);
                }
                continue;
            }
            // What bends upwards lies below the chord of its ends.
            let misses = rises || hi <= 0.0 || job.bends(lane) == Some(Bend::Convex);
            if misses || (job.bends(lane) == Some(Bend::Concave) && s > SLOPE_ERROR) {
                continue;
            }
            lane.at = 0.0;
            self.search.push(*lane);
        }
        self.lanes = lanes;
    }

    /// Lanes along which g bends downwards, with both ends below 0.
    fn search_bent(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.search);
        for _ in 0..SEARCH {
            if lanes.is_empty() {
                break;
            }
            self.evaluate(job, &lanes);
            let mut kept = 0;
            for i in 0..lanes.len() {
                let mut lane = lanes[i];
                let (g, s, _) = self.result(i, &lane);
                if g > job.doubt {
                    // Up once between the left end and here.
                    lane.right = lane.at;
                    (lane.g_right, lane.s_right) = (g, s);
                    lane.at = (lane.at - g / s).max(lane.left);
                    if !(lane.at < lane.right) {
                        lane.at = 0.5 * (lane.left + lane.right);
                    }
                    self.unique.push(lane);
                    continue;
                }
                if g >= -job.doubt {
                    self.open.push(lane.span);
                    continue;
                }
                if s > 0.0 || lane.g_left.is_nan() {
                    (lane.left, lane.g_left, lane.s_left) = (lane.at, g, s);
                } else {
                    (lane.right, lane.g_right, lane.s_right) = (lane.at, g, s);
                }
                let steep = |s: f32| s + SLOPE_ERROR * (s.abs() + 0.01);
                let up = steep(lane.s_left);
                let down = steep(-lane.s_right);
                let width = lane.right - lane.left;
                if up <= 0.0 || down <= 0.0 {
                    continue;
                }
                // Where the tangents meet, and their height there.
                let ahead = ((lane.g_right - lane.g_left + down * width) / (up + down)).clamp(0.0, width);
                if lane.g_left + up * ahead < -job.doubt {
                    continue;
                }
                if !(ahead > 1e-6 * width && ahead < width) {
                    self.open.push(lane.span);
                    continue;
                }
                lane.at = lane.left + ahead;
                lanes[kept] = lane;
                kept += 1;
            }
            lanes.truncate(kept);
        }
        self.open.extend(lanes.iter().map(|lane| lane.span));
        lanes.clear();
        self.search = lanes;
    }

    /// Lanes along which only bounds of the slope are known.
    fn search_steep(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.search);
        for _ in 0..SEARCH {
            if lanes.is_empty() {
                break;
            }
            self.evaluate(job, &lanes);
            let mut kept = 0;
            for i in 0..lanes.len() {
                let mut lane = lanes[i];
                let (g, s, _) = self.result(i, &lane);
                let (lo, hi) = job.slopes(&lane);
                if lane.probe {
                    lane.probe = false;
                    if g > job.doubt {
                        lane.right = lane.at;
                        (lane.g_right, lane.s_right) = (g, s);
                        lane.at = 0.5 * (lane.left + lane.right);
                        self.unique.push(lane);
                        continue;
                    }
                    // Nothing is before `left`: on from there.
                    lane.at = lane.left;
                    lanes[kept] = lane;
                    kept += 1;
                    continue;
                }
                if !(g < -job.doubt && hi.is_finite()) {
                    self.open.push(job.rest(&lane));
                    continue;
                }
                // No crossing is nearer than the value allows.
                let safe = lane.at + (-g - job.doubt) / hi;
                let end = if lane.g_right < 0.0 {
                    lane.right - (-lane.g_right - job.doubt).max(0.0) / -lo
                } else {
                    lane.right
                };
                if safe >= end {
                    if lane.g_right > 0.0 {
                        self.open.push(job.rest(&lane));
                    }
                    continue;
                }
                if safe <= lane.at {
                    self.open.push(job.rest(&lane));
                    continue;
                }
                // A little beyond where the tangent meets 0, if no crossing that is nearer makes
                // a difference.
                let beyond = lane.at + (-1.05 * g + 4.0 * job.doubt) / s;
                lane.left = safe;
                lane.probe = s > 0.0 && beyond < lane.right && beyond - safe <= job.close;
                lane.at = if lane.probe { beyond } else { safe };
                lanes[kept] = lane;
                kept += 1;
            }
            lanes.truncate(kept);
        }
        self.open.extend(lanes.iter().map(|lane| job.rest(lane)));
        lanes.clear();
        self.search = lanes;
    }
}

impl Marcher {
    /// The crossings between `left` and `right`, where g changes its sign: Newton's method,
    /// halving where it leaves the bracket.
    fn newton(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.unique);
        for _ in 0..NEWTON {
            if lanes.is_empty() {
                break;
            }
            self.evaluate(job, &lanes);
            let mut kept = 0;
            for i in 0..lanes.len() {
                let mut lane = lanes[i];
                let (g, s, gradient) = self.result(i, &lane);
                if g < 0.0 {
                    lane.left = lane.left.max(lane.at);
                } else {
                    lane.right = lane.right.min(lane.at);
                }
                let next = lane.at - g / s;
                let step = (next - lane.at).abs();
                if s > 0.0 && step <= job.last_step {
                    lane.at = next;
                    self.found.push(Found { lane, slope: s, normal: gradient });
                    continue;
                }
                if g.abs() <= job.doubt {
                    self.open.push(lane.span);
                    continue;
                }
                lane.at = if s > 0.0 && next > lane.left && next < lane.right {
                    next
                } else {
                    0.5 * (lane.left + lane.right)
                };
                lanes[kept] = lane;
                kept += 1;
            }
            lanes.truncate(kept);
        }
        self.open.extend(lanes.iter().map(|lane| lane.span));
        lanes.clear();
        self.unique = lanes;
    }

    /// One step in double precision, and the surface.
    fn polish(&mut self, job: &Job<'_>, surfaces: &mut [Surface]) {
        let [x, y, z, v] = &mut self.double;
        for list in [&mut *x, &mut *y, &mut *z] {
            list.clear();
        }
        for found in &self.found {
            let p = job.point(&found.lane) - job.center;
            x.push(p.x);
            y.push(p.y);
            z.push(p.z);
        }
        let count = self.found.len();
        if v.len() < count {
            v.resize(count, 0.0);
        }
        self.evaluator.values_f64(job.tape, x, y, z, &mut v[..count]);
        for (found, v) in self.found.iter().zip(&*v) {
            let Found { lane, slope, normal } = *found;
            let Span { ray, near, far } = lane.span;
            let step = -f64::from(lane.turn) * v / f64::from(slope);
            let t = near + f64::from(lane.at) + step;
            let Ray { origin, direction, base, .. } = job.rays[ray as usize];
            let outward = (-normal).normalize_or_zero();
            if !(step.abs() <= job.far_off && outward != Vec3::ZERO) {
                self.open.push(lane.span);
                continue;
            }
            let t = t.clamp(near, far);
            let owner = job.owner.unwrap_or_else(|| job.cell.program.deciding_leaf(origin + t * direction));
            surfaces[ray as usize] = Surface { distance: base + t, normal: outward, owner };
            self.hits.push(ray);
        }
    }
}

/// What a march knows of its cell.
struct Job<'a> {
    cell: &'a Cell,
    rays: &'a [Ray],
    tape: &'a crate::eval::Tape,
    center: DVec3,
    reach: crate::Bounds,
    bend: Option<Bend>,
    owner: Option<u32>,
    /// Lower and upper bounds of the three derivatives, rounding allowed for.
    least: [f32; 3],
    most: [f32; 3],
    /// Values this small may have the wrong sign.
    doubt: f32,
    last_step: f32,
    /// Crossings nearer to each other than this are one.
    close: f32,
    far_off: f64,
}

impl<'a> Job<'a> {
    fn new(cells: &Cells, cell: &'a Cell, rays: &'a [Ray]) -> Job<'a> {
        let tape = cell.tape();
        let slopes = cell.slopes();
        let reach = cells.reach();
        let size = reach.longest_side();
        let outward = |v: f64, by: f64| (v + by * (1e-6 * v.abs() + 1e-12)) as f32;
        Job {
            cell,
            rays,
            tape,
            center: tape.origin(),
            reach,
            bend: cell.bend,
            owner: cell.program.only_leaf(),
            least: slopes.map(|s| outward(s.lo(), -1.0)),
            most: slopes.map(|s| outward(s.hi(), 1.0)),
            doubt: tape.roundoff() as f32,
            last_step: LAST_STEP * cell.side() as f32,
            close: 4e-6 * size as f32,
            far_off: (1e-3 * cell.side()).min(1e-4 * size),
        }
    }

    /// The value in double precision.
    fn value(&self, ray: u32, t: f64) -> f64 {
        let Ray { origin, direction, .. } = self.rays[ray as usize];
        self.cell.program.value(origin + t * direction)
    }

    /// The point where the lane is.
    fn point(&self, lane: &Lane) -> DVec3 {
        let Ray { origin, direction, .. } = self.rays[lane.span.ray as usize];
        origin + (lane.span.near + f64::from(lane.at)) * direction
    }

    /// Bounds of the slope of g along the ray.
    fn slopes(&self, lane: &Lane) -> (f32, f32) {
        let (mut lo, mut hi) = (0.0, 0.0);
        for axis in 0..3 {
            let d = lane.direction[axis];
            if d != 0.0 {
                let (a, b) = (self.least[axis] * d, self.most[axis] * d);
                lo += a.min(b);
                hi += a.max(b);
            }
        }
        if lane.turn < 0.0 { (-hi, -lo) } else { (lo, hi) }
    }

    /// How g bends along the ray.
    fn bends(&self, lane: &Lane) -> Option<Bend> {
        self.bend.map(|bend| if lane.turn < 0.0 { bend.turned() } else { bend })
    }

    /// What of the lane's span nothing is known of.
    fn rest(&self, lane: &Lane) -> Span {
        Span { near: lane.span.near + f64::from(lane.left), ..lane.span }
    }
}
