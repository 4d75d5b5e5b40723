//! The search from surface points known beforehand, for leaves of any shape.
//!
//! From the point kept for the cell of x, and from that of another side where it is near
//! enough to matter, y slides to below x; outside, where it comes to no rest (at edges), cuts
//! go on. What is found counts only if the leaf's sign has changed a little behind it. Then
//!
//! ```text
//!     |d(x)| ≤ (1 + SURE)·|x − y|,     |x − y| ≤ |x − y₀|,     y₀ the point of the cell
//! ```
//!
//! and otherwise y₀ itself is taken: whatever the search does, its result lies between the
//! true distance and one with a known range.

use glam::DVec3;

use super::Distance;
use super::chain::{Column, columns, columns_mut};
use super::feet::Foot;
use super::lanes::Lanes;
use super::lanes::NONE;
use super::solve::{Prepared, joined, step_to};
use super::step::{BEHIND, CutNear, Follow, Start};
use crate::kernel::{CHUNK, Formula, run};

/// Steps along the surface from each start, at most.
const SLIDES: usize = 6;

/// Cuts outside, where slides come to no rest.
const CUTS: usize = 6;

/// A step that is shorter than this part of the length asked for is not made.
const LET_BE: f64 = 5e-3;

/// How far behind a point found the sign must have changed, as a part of its distance.
pub(super) const SURE: f64 = 0.005;

/// What is tried: parts of the distance and of the slack. Beyond the first it counts as way.
const TRIES: [[f64; 2]; 2] = [[SURE, 1.0], [0.1, 20.0]];

/// The best point so far: normal, the way to it from x, and the length of that.
type Best = [f64; 7];

/// The best point before any step.
fn at_first(x: DVec3, foot: &Foot) -> Best {
    let (n, u) = (foot.normal, foot.point - x);
    [n.x, n.y, n.z, u.x, u.y, u.z, u.length()]
}

impl Distance {
    fn following(&self) -> Follow {
        let size = self.bounds.half_extents().max_element();
        let curvature = if size.is_normal() { 1.0 / size } else { 0.0 };
        // Of one without bounds nothing is known of the rounding of places.
        let rounding = if size.is_finite() { 1e-7 * size } else { 0.0 };
        Follow { curvature, let_be: LET_BE * self.asked + rounding }
    }

    /// Distance to the surface, negative outside, and outward normal.
    pub(super) fn follow(&self, x: DVec3, value: f64) -> (f64, DVec3) {
        let feet = self.feet.as_ref();
        let first = match feet {
            Some(feet) => at_first(x, &feet.at(x)[0]),
            None => {
                let seen = self.chain.at(x);
                let g = seen.gradient;
                let i = [x.x, x.y, x.z, g.x, g.y, g.z, seen.value, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                let [a, b, c, h] = Start { planes: &[] }.run(i);
                [a, b, c, a * h, b * h, c * h, BEHIND]
            }
        };
        let (mut best, mut open) = self.slides(x, first, first);
        if let Some(feet) = feet {
            let second = at_first(x, &feet.at(x)[1]);
            let [a, b, c, u, v, w, way] = second;
            let height = (a * u + b * v + c * w).abs();
            if may_lead_nearer(way as f32, height as f32, best[6] as f32, feet.spacing() as f32) {
                let still;
                (best, still) = self.slides(x, second, best);
                open |= still;
            }
        }
        if value < 0.0 && open {
            best = self.cuts(x, best);
        }
        let [a, b, c, u, v, w, _] = best;
        let (mut normal, mut foot) = (DVec3::new(a, b, c), DVec3::new(u, v, w));
        if let Some(feet) = feet {
            for [part, slacks] in TRIES {
                let by = part * foot.length() + slacks * feet.slack;
                let behind = x + foot + normal * by.copysign(value);
                let changed = (self.chain.value(behind.to_array()) > 0.0) != (value > 0.0);
                let way = foot.length() + if part > SURE { by } else { 0.0 };
                if changed && way <= first[6] {
                    return (way.copysign(value), normal);
                }
            }
            (normal, foot) = (DVec3::new(first[0], first[1], first[2]), DVec3::new(first[3], first[4], first[5]));
        } else if best[6] >= BEHIND {
            return (value, normal);
        }
        (foot.length().copysign(value), normal)
    }

    /// The best point on the way from `start`, or `best`; and whether there was no end.
    fn slides(&self, x: DVec3, start: Best, best: Best) -> (Best, bool) {
        let follow = self.following();
        let [n0, n1, n2, u0, u1, u2, _] = start;
        // The first step is known: the normal is that of the start.
        let h = n0 * u0 + n1 * u1 + n2 * u2;
        let k = follow.stretch(h);
        let mut u = [u0 + k * (n0 * h - u0), u1 + k * (n1 * h - u1), u2 + k * (n2 * h - u2)];
        let mut rest = [u0, u1, u2, n0, n1, n2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        rest[6..].copy_from_slice(if start[6] < best[6] { &start } else { &best });
        let mut open = true;
        for _ in 0..SLIDES {
            let [a, b, c, m0, m1, m2, best @ ..] = follow.run(joined(self.seen_from(x, u), rest));
            rest[..3].copy_from_slice(&u);
            rest[3..6].copy_from_slice(&[m0, m1, m2]);
            rest[6..].copy_from_slice(&best[..7]);
            u = [a, b, c];
            open = best[7] >= 0.0;
            if !open {
                break;
            }
        }
        let [.., n0, n1, n2, a, b, c, way] = rest;
        ([n0, n1, n2, a, b, c, way], open)
    }

    fn cuts(&self, x: DVec3, best: Best) -> Best {
        let [n0, n1, n2, a, b, c, _] = best;
        let h = n0 * a + n1 * b + n2 * c;
        let mut u = [n0 * h, n1 * h, n2 * h];
        let mut rest = [0.0; 19];
        rest[..4].copy_from_slice(&[n0, n1, n2, h]);
        rest[12..].copy_from_slice(&best);
        let cut = CutNear { let_be: self.following().let_be };
        for _ in 0..CUTS {
            let [a, b, c, after @ ..] = cut.run(joined(self.seen_from(x, u), rest));
            (u, rest) = ([a, b, c], after);
        }
        let [.., n0, n1, n2, a, b, c, way] = rest;
        [n0, n1, n2, a, b, c, way]
    }
}

/// Whether another side's point may lead to one nearer than the best so far: its tangent
/// plane is no farther, nor is it much farther itself.
#[inline(always)]
fn may_lead_nearer(way: f32, height: f32, best: f32, spacing: f32) -> bool {
    way - spacing < best && height < 1.1 * best
}

/// The search of a chunk under way: u, u and normal before, best (7).
type Way = [Column; 16];

/// The columns of the best point.
const BEST: usize = 9;

/// The best point before any step, of a chunk.
#[inline(always)]
fn put([n0, n1, n2, u0, u1, u2, way]: &mut [Column; 7], at: usize, x: DVec3, foot: &Foot) {
    let (n, u) = (foot.normal.as_vec3(), (foot.point - x).as_vec3());
    (n0[at], n1[at], n2[at]) = (n.x, n.y, n.z);
    (u0[at], u1[at], u2[at]) = (u.x, u.y, u.z);
    way[at] = u.length();
}

impl Prepared<'_> {
    /// Distance, negative outside, and outward normal.
    pub(super) fn follow(&self, points: [&[f32]; 3], value: &Column) -> [Column; 4] {
        let count = points[0].len();
        let mut first = [NONE; 7];
        let mut second = [NONE; 7];
        match &self.distance.feet {
            Some(feet) => {
                for i in 0..count {
                    let x = self.in_frame(points, i);
                    let [near, other] = feet.at(x);
                    put(&mut first, i, x, &near);
                    put(&mut second, i, x, &other);
                }
            }
            None => self.down_from(points, &mut first),
        }
        let mut best = first;
        let mut asked = [true; CHUNK];
        let mut open = [false; CHUNK];
        self.slides(points, &first, &mut best, &asked[..count], &mut open);
        if let Some(feet) = &self.distance.feet {
            let spacing = feet.spacing() as f32;
            let [a, b, c, u, v, w, way] = &second;
            for i in 0..count {
                let height = (a[i] * u[i] + b[i] * v[i] + c[i] * w[i]).abs();
                asked[i] = may_lead_nearer(way[i], height, best[6][i], spacing);
            }
            self.slides(points, &second, &mut best, &asked[..count], &mut open);
        }
        for i in 0..count {
            open[i] &= value[i] < 0.0;
        }
        self.cuts(points, &mut best, &open[..count]);
        self.sure(points, value, &first, &mut best);
        let [n0, n1, n2, .., way] = best;
        let mut height = way;
        for (height, value) in height.iter_mut().zip(value) {
            *height = if *height < BEHIND as f32 { height.copysign(*value) } else { *value };
        }
        [height, n0, n1, n2]
    }

    /// The starts where no surface point is known: down the gradient.
    fn down_from(&self, points: [&[f32]; 3], first: &mut [Column; 7]) {
        let mut seen = [NONE; 4];
        self.gradients(points, &mut seen);
        let len = points[0].len();
        let [value, gx, gy, gz] = columns(&seen, len);
        let [x, y, z] = points;
        let none = &NONE[..len];
        let mut plane = [NONE; 4];
        let inputs = [x, y, z, gx, gy, gz, value, none, none, none, none, none, none];
        run(&Start { planes: &[] }, inputs, columns_mut(&mut plane, len));
        let mut u = [NONE; 3];
        step_to(&plane, &mut u);
        let [n0, n1, n2, _] = plane;
        let [u0, u1, u2] = u;
        *first = [n0, n1, n2, u0, u1, u2, [BEHIND as f32; CHUNK]];
    }

    /// Slides the points asked for from `start`; `best` and `open` of others stay as they are.
    fn slides(
        &self,
        points: [&[f32]; 3],
        start: &[Column; 7],
        best: &mut [Column; 7],
        asked: &[bool],
        open: &mut [bool; CHUNK],
    ) {
        let mut lanes: Lanes<16> = Lanes::new(asked, self.placed.takes_short());
        if lanes.count == 0 {
            return;
        }
        for i in 0..asked.len() {
            if asked[i] && start[6][i] < best[6][i] {
                for (to, from) in best.iter_mut().zip(start) {
                    to[i] = from[i];
                }
            }
        }
        let follow = self.distance.following();
        let [n0, n1, n2, u, v, w, _] = start;
        let [b0, b1, b2, b3, b4, b5, b6] = &*best;
        // The first step is known: the normal is that of the start.
        let mut next = [NONE; 3];
        for i in 0..asked.len() {
            let h = n0[i] * u[i] + n1[i] * v[i] + n2[i] * w[i];
            let k = follow.stretch(f64::from(h)) as f32;
            next[0][i] = u[i] + k * (n0[i] * h - u[i]);
            next[1][i] = v[i] + k * (n1[i] * h - v[i]);
            next[2][i] = w[i] + k * (n2[i] * h - w[i]);
        }
        let [x, y, z] = &next;
        lanes.gather(points, [x, y, z, u, v, w, n0, n1, n2, b0, b1, b2, b3, b4, b5, b6]);
        for _ in 0..SLIDES {
            let len = lanes.len();
            let mut seen = [NONE; 4];
            let way: &Way = &lanes.state;
            self.displaced(lanes.points(), [&way[0], &way[1], &way[2]], &mut seen);
            let inputs = std::array::from_fn(|i| match i {
                0..3 => &way[i][..len],
                3..7 => &seen[i - 3][..len],
                _ => &way[i - 4][..len],
            });
            let mut next = [NONE; 14];
            run::<f32, 20, 14>(&follow, inputs, columns_mut(&mut next, len));
            let [u, v, w, rest @ ..] = &mut lanes.state;
            [rest[0], rest[1], rest[2]] = [*u, *v, *w];
            [*u, *v, *w] = [next[0], next[1], next[2]];
            rest[3..].copy_from_slice(&next[3..13]);
            lanes.scatter(BEST, best);
            lanes.keep(&next[13]);
            if lanes.count == 0 {
                return;
            }
        }
        for from in &lanes.from[..lanes.count] {
            open[*from] = true;
        }
    }

    fn cuts(&self, points: [&[f32]; 3], best: &mut [Column; 7], asked: &[bool]) {
        let mut lanes: Lanes<22> = Lanes::new(asked, self.placed.takes_short());
        if lanes.count == 0 {
            return;
        }
        let [n0, n1, n2, u, v, w, way] = &*best;
        let mut h = NONE;
        let mut on = [NONE; 3];
        for i in 0..asked.len() {
            h[i] = n0[i] * u[i] + n1[i] * v[i] + n2[i] * w[i];
            [on[0][i], on[1][i], on[2][i]] = [n0[i] * h[i], n1[i] * h[i], n2[i] * h[i]];
        }
        let none = &NONE;
        let [x, y, z] = &on;
        lanes.gather(
            points,
            [x, y, z, n0, n1, n2, &h, none, none, none, none, none, none, none, none, n0, n1, n2, u, v, w, way],
        );
        let len = lanes.len();
        let cut = CutNear { let_be: self.distance.following().let_be };
        for _ in 0..CUTS {
            let mut seen = [NONE; 4];
            let before = lanes.state;
            self.displaced(lanes.points(), [&before[0], &before[1], &before[2]], &mut seen);
            let inputs = std::array::from_fn(|i| match i {
                0..3 => &before[i][..len],
                3..7 => &seen[i - 3][..len],
                _ => &before[i - 4][..len],
            });
            run::<f32, 26, 22>(&cut, inputs, columns_mut(&mut lanes.state, len));
        }
        lanes.scatter(15, best);
    }

    /// Leaves of `best` what the leaf's sign confirms, and takes the first point elsewhere.
    /// Its way is then the distance between the points, or a bound of that.
    fn sure(&self, points: [&[f32]; 3], value: &Column, first: &[Column; 7], best: &mut [Column; 7]) {
        let Some(feet) = &self.distance.feet else { return };
        let count = points[0].len();
        let mut open = [true; CHUNK];
        for [part, slacks] in TRIES {
            let (part, slack) = (part as f32, (slacks * feet.slack) as f32);
            let mut behind = [NONE; 3];
            let mut ways = NONE;
            for i in 0..count {
                let [x, y, z] = [best[3][i], best[4][i], best[5][i]];
                let way = (x * x + y * y + z * z).sqrt();
                let by = part * way + slack;
                ways[i] = if f64::from(part) > SURE { way + by } else { way };
                let by = by.copysign(value[i]);
                behind[0][i] = best[0][i].mul_add(by, x);
                behind[1][i] = best[1][i].mul_add(by, y);
                behind[2][i] = best[2][i].mul_add(by, z);
            }
            let mut values = NONE;
            self.values_at(points, [&behind[0], &behind[1], &behind[2]], &mut values);
            let mut left = false;
            for i in 0..count {
                let changed = (values[i] > 0.0) != (value[i] > 0.0);
                // A NaN is not sure.
                if open[i] && changed && ways[i] <= first[6][i] {
                    best[6][i] = ways[i];
                    open[i] = false;
                }
                left |= open[i];
            }
            if !left {
                return;
            }
        }
        for i in 0..count {
            if open[i] {
                for (to, from) in best.iter_mut().zip(first) {
                    to[i] = from[i];
                }
            }
        }
    }
}
