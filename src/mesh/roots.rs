//! Roots on lattice edges, many at a time.
//!
//! ```text
//!    value
//!      |*                        a, b   known from the nodes
//!      | \                       1      on the chord of a and b
//!      |   \                     2      a Newton step from 1, by the gradient there
//!     -+-----*-2-*------+--> t   3      another one, from the value in double precision, and
//!      |         1 ` -  *               a last one from the value at 3, if 3 may be off
//! ```
//!
//! The gradient in single precision at the chord's point gives the slope for all three steps, and
//! the normal. How far a step goes wrong is told by the step after it, so most edges are settled at
//! 3 without another value, and most others by the last step; the few that are not, because a
//! crease or a strong bend lies between, are closed in on by false position with halved weights
//! (Illinois), and halving. Where the root is away from where the gradient was taken, the normal is
//! taken anew.

use glam::DVec3;

use super::extract::Root;
use super::lattice::Lattice;
use super::signs::EdgeRef;
use crate::eval::{Evaluator, Gradients, Program, Tape};

/// A root is settled when the next step is shorter than this part of an edge; that step is
/// taken as well.
const SETTLED: f64 = 2.5e-7;

/// At most this many steps of false position; from `HALVING` on they halve.
const STEPS: usize = 40;
const HALVING: usize = 12;

/// Where the value is more than this part of what it changes by over the length of an edge, in the
/// direction in which it changes most, and has the other sign right beside, it may jump. Along the
/// edge it may not change at all where the gradient was taken, and does beyond a crease.
const JUMP: f64 = 1e-3;

/// It does if so many halvings more do not bring it down to a half.
const CLOSER: usize = 20;

/// Normals are taken anew where a root moves by more than this after its gradient was.
const MOVED: f64 = 1.0 / 256.0;

/// Memory for the edges at hand, one number an edge in each list.
#[derive(Default)]
pub(super) struct RootFinder {
    /// The coordinate of the lower end along the edge, relative to the tape's origin.
    lower: Vec<f64>,
    t: Vec<f64>,
    slope: Vec<f64>,
    /// Where the gradient was taken.
    seen: Vec<f64>,
    /// The point before, and the value there.
    before: Vec<[f64; 2]>,
    single: [Vec<f32>; 3],
    double: [Vec<f64>; 3],
    gathered: [Vec<f64>; 3],
    exact: Vec<f64>,
    gradient: [Vec<f32>; 4],
    open: Vec<u32>,
    brackets: Vec<Bracket>,
}

impl RootFinder {
    /// The roots on `edges`, into `out`; `tape` is that of `program` for a region that holds them.
    /// `start` tells where on an edge, given by its place in the list, to begin. Without the
    /// program, what may be a jump counts as one.
    pub(super) fn find(
        &mut self,
        evaluator: &mut Evaluator,
        (program, tape): (Option<&Program>, &Tape),
        lattice: &Lattice,
        edges: &[EdgeRef],
        start: impl Fn(usize, &EdgeRef) -> f64,
        out: &mut [Root],
    ) {
        let step = lattice.step();
        self.start(tape, lattice, edges, start);
        self.approach(evaluator, tape, edges, step, out);
        out.iter_mut().for_each(|root| root.is_off = false);
        self.settle(evaluator, (program, tape), edges, step, out);
        self.normals(evaluator, tape, edges, step, out);
        for (root, &t) in out.iter_mut().zip(&self.t) {
            root.t = t;
        }
    }

    /// The lower ends, and the points to begin with.
    fn start(&mut self, tape: &Tape, lattice: &Lattice, edges: &[EdgeRef], start: impl Fn(usize, &EdgeRef) -> f64) {
        let (origin, step) = (tape.origin(), lattice.step());
        let count = edges.len();
        self.lower.resize(count, 0.0);
        self.t.resize(count, 0.0);
        self.single.iter_mut().for_each(|list| list.resize(count, 0.0));
        self.double.iter_mut().for_each(|list| list.resize(count, 0.0));
        let (lower, ts) = (&mut self.lower[..count], &mut self.t[..count]);
        let [x, y, z] = &mut self.double;
        let (x, y, z) = (&mut x[..count], &mut y[..count], &mut z[..count]);
        let [single_x, single_y, single_z] = &mut self.single;
        let (single_x, single_y, single_z) = (&mut single_x[..count], &mut single_y[..count], &mut single_z[..count]);
        for (n, edge) in edges.iter().enumerate() {
            let p = lattice.node(edge.node[0], edge.node[1], edge.node[2]) - origin;
            let t = start(n, edge);
            (x[n], y[n], z[n]) = (p.x, p.y, p.z);
            (single_x[n], single_y[n], single_z[n]) = (p.x as f32, p.y as f32, p.z as f32);
            let (low, along) = match edge.axis {
                0 => (p.x, &mut single_x[n]),
                1 => (p.y, &mut single_y[n]),
                _ => (p.z, &mut single_z[n]),
            };
            *along = (low + t * step) as f32;
            lower[n] = low;
            ts[n] = t;
        }
    }

    /// In single precision: near the root, with slope and normal.
    fn approach(&mut self, evaluator: &mut Evaluator, tape: &Tape, edges: &[EdgeRef], step: f64, out: &mut [Root]) {
        let [x, y, z] = &self.single;
        let count = edges.len();
        for list in &mut self.gradient {
            list.resize(count, 0.0);
        }
        let [value, dx, dy, dz] = &mut self.gradient;
        evaluator.shortest_gradients(tape, [x, y, z], Gradients { value, dx, dy, dz });
        self.slope.resize(count, 0.0);
        self.seen.clone_from(&self.t);
        let (value, dx, dy, dz) = (&value[..count], &dx[..count], &dy[..count], &dz[..count]);
        let (slopes, ts, out) = (&mut self.slope[..count], &mut self.t[..count], &mut out[..count]);
        for (n, edge) in edges.iter().enumerate() {
            let gradient = [dx[n], dy[n], dz[n]];
            let along = match edge.axis {
                0 => gradient[0],
                1 => gradient[1],
                _ => gradient[2],
            };
            let slope = f64::from(along) * step;
            ts[n] = newton(ts[n], f64::from(value[n]), slope);
            slopes[n] = slope;
            out[n].normal = outward(gradient);
        }
    }

    /// In double precision, to the end.
    fn settle(
        &mut self,
        evaluator: &mut Evaluator,
        (program, tape): (Option<&Program>, &Tape),
        edges: &[EdgeRef],
        step: f64,
        out: &mut [Root],
    ) {
        let count = edges.len();
        self.evaluate_all(evaluator, tape, edges, step);
        self.before.resize(count, [0.0; 2]);
        self.open.clear();
        self.brackets.clear();
        // Of an edge: what rounding leaves in doubt of the value, and of a vertex.
        let (doubt, coarse) = (tape.roundoff(), coarseness(tape, step));
        for (n, edge) in edges.iter().enumerate() {
            let (t, value, slope) = (self.t[n], self.exact[n], self.slope[n]);
            self.before[n] = [t, value];
            let by = value / slope;
            self.t[n] = newton(t, value, slope);
            // A step goes wrong by what the slope changes on the way from where it was taken: by
            // twice the part that the step before it went wrong by, as far as this can be told.
            let wrong = 4.0 * by.abs().max(doubt / slope.abs()) / (t - self.seen[n]).abs();
            if self.t[n] == t - by && (by.abs() * wrong.min(1.0) <= SETTLED || by.abs() <= coarse) {
                continue;
            }
            let mut bracket = Bracket::new(edge);
            bracket.next = self.t[n];
            self.open.push(n as u32);
            self.brackets.push(bracket);
        }
        self.evaluate_open(evaluator, tape, edges, step);
        let mut kept = 0;
        for at in 0..self.open.len() {
            let n = self.open[at] as usize;
            let (t, value, slope, [before, first]) = (self.t[n], self.exact[at], self.slope[n], self.before[n]);
            let by = value / slope;
            // By both slopes, that of the gradient and that of the last step, unless it went
            // nowhere. NaN stays open.
            let steep = ((value - first) / (t - before)).abs();
            if by.abs() <= SETTLED && (value.abs() <= SETTLED * steep || (t - before).abs() <= SETTLED) {
                self.t[n] = t - by;
                continue;
            }
            let mut bracket = self.brackets[at];
            for (t, value) in [(before, first), (t, value)] {
                if bracket.holds(t) {
                    bracket.learn(t, value);
                }
            }
            bracket.next = bracket.secant();
            self.open[kept] = n as u32;
            self.brackets[kept] = bracket;
            kept += 1;
        }
        self.open.truncate(kept);
        self.brackets.truncate(kept);
        for round in 0..STEPS {
            if self.open.is_empty() {
                break;
            }
            self.evaluate_open(evaluator, tape, edges, step);
            let mut kept = 0;
            for at in 0..self.open.len() {
                let n = self.open[at] as usize;
                let mut bracket = self.brackets[at];
                let (t, value) = (bracket.next, self.exact[at]);
                // From the last point to this one.
                let by = value * (t - bracket.t) / (value - bracket.value);
                bracket.learn(t, value);
                if by.abs() <= SETTLED && value.abs() <= SETTLED * self.slope[n].abs() || bracket.width() <= SETTLED {
                    self.t[n] = bracket.nearest(t - by);
                    let is_large = value.abs() > JUMP * self.steepness(n) * step;
                    let jumps = |program| self.jumps((program, tape), &edges[n], n, bracket, step);
                    out[n].is_off = is_large && program.is_none_or(jumps);
                    continue;
                }
                bracket.next = if round < HALVING { bracket.secant() } else { bracket.middle() };
                self.open[kept] = n as u32;
                self.brackets[kept] = bracket;
                kept += 1;
            }
            self.open.truncate(kept);
            self.brackets.truncate(kept);
        }
        for (&n, bracket) in self.open.iter().zip(&self.brackets) {
            self.t[n as usize] = bracket.middle();
            out[n as usize].is_off = true;
        }
    }

    /// How much the value changes with the way where the gradient of an edge was taken.
    fn steepness(&self, n: usize) -> f64 {
        let [_, dx, dy, dz] = &self.gradient;
        DVec3::new(dx[n].into(), dy[n].into(), dz[n].into()).length()
    }

    /// Whether the value of an edge jumps within a bracket, or has no change of sign there.
    fn jumps(&self, (program, tape): (&Program, &Tape), edge: &EdgeRef, n: usize, bracket: Bracket, step: f64) -> bool {
        let along = usize::from(edge.axis);
        let value = |t: f64| {
            let mut p = DVec3::new(self.double[0][n], self.double[1][n], self.double[2][n]);
            p[along] = self.lower[n] + t * step;
            program.value(tape.origin() + p)
        };
        let (mut low, mut high) = (bracket.low, bracket.high);
        let mut ends = [low, high].map(value);
        let least = |ends: [f64; 2]| ends[0].abs().min(ends[1].abs());
        let first = least(ends);
        for _ in 0..CLOSER {
            if (ends[0] > 0.0) == (ends[1] > 0.0) {
                return true;
            }
            let middle = 0.5 * (low + high);
            let at_middle = value(middle);
            if (at_middle > 0.0) == (ends[0] > 0.0) {
                (low, ends[0]) = (middle, at_middle);
            } else {
                (high, ends[1]) = (middle, at_middle);
            }
        }
        least(ends) > 0.5 * first
    }

    /// The values at the points of all edges.
    fn evaluate_all(&mut self, evaluator: &mut Evaluator, tape: &Tape, edges: &[EdgeRef], step: f64) {
        let count = edges.len();
        let [x, y, z] = &mut self.double;
        {
            let (lower, ts) = (&self.lower[..count], &self.t[..count]);
            let (x, y, z) = (&mut x[..count], &mut y[..count], &mut z[..count]);
            for (n, edge) in edges.iter().enumerate() {
                let along = match edge.axis {
                    0 => &mut x[n],
                    1 => &mut y[n],
                    _ => &mut z[n],
                };
                *along = lower[n] + ts[n] * step;
            }
        }
        self.exact.resize(edges.len(), 0.0);
        evaluator.shortest_values_f64(tape, [x, y, z], &mut self.exact);
    }

    /// The values at the next points of the open edges, in their order.
    fn evaluate_open(&mut self, evaluator: &mut Evaluator, tape: &Tape, edges: &[EdgeRef], step: f64) {
        self.gathered.iter_mut().for_each(Vec::clear);
        for (&n, bracket) in self.open.iter().zip(&self.brackets) {
            let n = n as usize;
            let along = usize::from(edges[n].axis);
            for (axis, list) in self.gathered.iter_mut().enumerate() {
                list.push(if axis == along { self.lower[n] + bracket.next * step } else { self.double[axis][n] });
            }
        }
        let [x, y, z] = &self.gathered;
        evaluator.shortest_values_f64(tape, [x, y, z], &mut self.exact[..x.len()]);
    }

    /// New normals for the roots that have moved.
    fn normals(&mut self, evaluator: &mut Evaluator, tape: &Tape, edges: &[EdgeRef], step: f64, out: &mut [Root]) {
        self.open.clear();
        let moved = |&n: &u32| (self.t[n as usize] - self.seen[n as usize]).abs() > MOVED;
        self.open.extend((0..edges.len() as u32).filter(moved));
        if self.open.is_empty() {
            return;
        }
        for list in &mut self.single {
            list.clear();
        }
        for &n in &self.open {
            let n = n as usize;
            let along = usize::from(edges[n].axis);
            for (axis, list) in self.single.iter_mut().enumerate() {
                let c = if axis == along { self.lower[n] + self.t[n] * step } else { self.double[axis][n] };
                list.push(c as f32);
            }
        }
        let [x, y, z] = &self.single;
        let [value, dx, dy, dz] = &mut self.gradient;
        evaluator.shortest_gradients(tape, [x, y, z], Gradients { value, dx, dy, dz });
        for (at, &n) in self.open.iter().enumerate() {
            out[n as usize].normal = outward([dx[at], dy[at], dz[at]]);
        }
    }
}

/// The outward unit normal of a gradient, which points inward; 0 for none.
#[inline(always)]
fn outward([dx, dy, dz]: [f32; 3]) -> [f32; 3] {
    let inward = DVec3::new(dx.into(), dy.into(), dz.into());
    (-inward.normalize_or_zero()).as_vec3().to_array()
}

/// How far vertices may be off by being in single precision, as a part of an edge.
fn coarseness(tape: &Tape, step: f64) -> f64 {
    0.5 * f64::from(f32::EPSILON) * tape.origin().abs().max_element() / step
}

/// A Newton step from `t`, if it stays on the edge.
#[inline(always)]
fn newton(t: f64, value: f64, slope: f64) -> f64 {
    let next = t - value / slope;
    if (0.0..=1.0).contains(&next) { next } else { t }
}

/// The point of an edge where the chord of the values at its ends is 0.
#[inline(always)]
pub(super) fn on_chord(edge: &EdgeRef) -> f64 {
    let [a, b] = edge.values;
    let chord = f64::from(a / (a - b));
    if (0.0..=1.0).contains(&chord) { chord } else { 0.5 }
}

/// The point of an edge where the chord on one side of `t`, at which the value is known, is 0.
#[inline(always)]
pub(super) fn beside(edge: &EdgeRef, t: f64, value: f64) -> f64 {
    let mut bracket = Bracket::new(edge);
    if bracket.holds(t) {
        bracket.learn(t, value);
    }
    bracket.secant()
}

/// A root on an edge, closed in on.
#[derive(Clone, Copy)]
struct Bracket {
    low: f64,
    high: f64,
    at_low: f64,
    at_high: f64,
    inside_low: bool,
    /// The last point, and the value there.
    t: f64,
    value: f64,
    /// The point to look at next.
    next: f64,
    /// Which end has stayed: −1 low, 1 high.
    stayed: i8,
}

impl Bracket {
    fn new(edge: &EdgeRef) -> Bracket {
        let [at_low, at_high] = edge.values.map(f64::from);
        let inside_low = edge.leaves;
        Bracket { low: 0.0, high: 1.0, at_low, at_high, inside_low, t: 0.0, value: at_low, next: 0.5, stayed: 0 }
    }

    /// The value at a point within.
    fn learn(&mut self, t: f64, value: f64) {
        (self.t, self.value) = (t, value);
        if (value > 0.0) == self.inside_low {
            self.low = t;
            self.at_low = value;
            if self.stayed == 1 {
                self.at_high *= 0.5;
            }
            self.stayed = 1;
        } else {
            self.high = t;
            self.at_high = value;
            if self.stayed == -1 {
                self.at_low *= 0.5;
            }
            self.stayed = -1;
        }
    }

    fn width(&self) -> f64 {
        self.high - self.low
    }

    fn holds(&self, t: f64) -> bool {
        t > self.low && t < self.high
    }

    /// The point of the bracket nearest to `t`; its middle for NaN.
    fn nearest(&self, t: f64) -> f64 {
        if t.is_nan() { self.middle() } else { t.clamp(self.low, self.high) }
    }

    fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// On the chord, a little from the ends: beyond the root, it closes the bracket from the
    /// other side.
    fn secant(&self) -> f64 {
        let secant = self.low + self.width() * (self.at_low / (self.at_low - self.at_high));
        let inset = (0.25 * SETTLED).min(0.25 * self.width());
        if secant.is_finite() { secant.clamp(self.low + inset, self.high - inset) } else { self.middle() }
    }
}
