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
use super::chain::{Column, columns_mut};
use super::feet::Foot;
use super::solve::{NONE, Prepared, joined, step_to};
use super::step::{BEHIND, CutNear, Follow, Start};
use crate::num::kernel::{CHUNK, Formula, run};

/// Steps along the surface from each start, at most.
const SLIDES: usize = 6;

/// Cuts outside, where slides come to no rest.
const CUTS: usize = 6;

/// How far behind a point found the sign must have changed, as a part of its distance.
pub(super) const SURE: f64 = 0.005;

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
        Follow { curvature: if size.is_normal() { 1.0 / size } else { 0.0 } }
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
            if second[6] - feet.spacing() < best[6] {
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
            let behind = (SURE * foot.length() + feet.slack).copysign(value);
            let changed = (self.chain.value((x + foot + normal * behind).to_array()) > 0.0) != (value > 0.0);
            if !changed || foot.length() > first[6] {
                (normal, foot) = (DVec3::new(first[0], first[1], first[2]), DVec3::new(first[3], first[4], first[5]));
            }
        } else if best[6] >= BEHIND {
            return (value, normal);
        }
        (foot.length().copysign(value), normal)
    }

    /// The best point on the way from `start`, or `best`; and whether there was no end.
    fn slides(&self, x: DVec3, start: Best, best: Best) -> (Best, bool) {
        let follow = self.following();
        let [n0, n1, n2, u0, u1, u2, _] = start;
        let mut u = [u0, u1, u2];
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
        for _ in 0..CUTS {
            let [a, b, c, after @ ..] = CutNear.run(joined(self.seen_from(x, u), rest));
            (u, rest) = ([a, b, c], after);
        }
        let [.., n0, n1, n2, a, b, c, way] = rest;
        [n0, n1, n2, a, b, c, way]
    }
}

/// The search of a chunk under way: u, u and normal before, best (7).
type Way = [Column; 16];

/// The columns of the best point.
const BEST: usize = 9;

impl Prepared<'_> {
    /// Distance, negative outside, and outward normal.
    pub(super) fn follow(&self, points: [&[f32]; 3], value: &Column) -> [Column; 4] {
        let at: [DVec3; CHUNK] = std::array::from_fn(|i| self.in_frame(points, i));
        let mut first = [NONE; 7];
        let mut second = [NONE; 7];
        match &self.distance.feet {
            Some(feet) => {
                for (i, x) in at.iter().enumerate() {
                    let [near, other] = feet.at(*x);
                    put(&mut first, i, at_first(*x, &near));
                    put(&mut second, i, at_first(*x, &other));
                }
            }
            None => self.from_here(points, &mut first),
        }
        let mut best = first;
        let mut open = [false; CHUNK];
        self.slides(points, &first, &mut best, &[true; CHUNK], &mut open);
        if let Some(feet) = &self.distance.feet {
            let spacing = feet.spacing() as f32;
            let asked = std::array::from_fn(|i| second[6][i] - spacing < best[6][i]);
            self.slides(points, &second, &mut best, &asked, &mut open);
        }
        for i in 0..CHUNK {
            open[i] &= value[i] < 0.0;
        }
        self.cuts(points, &mut best, &open);
        self.sure(points, value, &first, &mut best);
        let [n0, n1, n2, .., way] = best;
        let mut height = way;
        for (height, value) in height.iter_mut().zip(value) {
            *height = if *height < BEHIND as f32 { height.copysign(*value) } else { *value };
        }
        [height, n0, n1, n2]
    }

    /// The starts where no surface point is known: down the gradient.
    fn from_here(&self, points: [&[f32]; 3], first: &mut [Column; 7]) {
        let mut seen = [NONE; 4];
        self.gradients(points, &mut seen);
        let mut plane = [NONE; 4];
        self.start(points, &seen, [&NONE; 6], &mut plane);
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
        asked: &[bool; CHUNK],
        open: &mut [bool; CHUNK],
    ) {
        if !asked.contains(&true) {
            return;
        }
        let follow = self.distance.following();
        let mut way: Way = [NONE; 16];
        for i in 0..3 {
            (way[i], way[3 + i], way[6 + i]) = (start[3 + i], start[3 + i], start[i]);
        }
        for i in 0..CHUNK {
            let from = if start[6][i] < best[6][i] { start } else { &*best };
            for (to, from) in way[BEST..].iter_mut().zip(from) {
                to[i] = from[i];
            }
        }
        let mut left = NONE;
        for _ in 0..SLIDES {
            let mut seen = [NONE; 4];
            self.displaced(points, [&way[0], &way[1], &way[2]], &mut seen);
            let before = way;
            let inputs = std::array::from_fn(|i| match i {
                0..3 => &before[i][..],
                3..7 => &seen[i - 3][..],
                _ => &before[i - 4][..],
            });
            let mut next = [NONE; 14];
            run::<f32, 20, 14>(&follow, inputs, columns_mut(&mut next));
            way[..3].copy_from_slice(&next[..3]);
            way[3..6].copy_from_slice(&before[..3]);
            way[6..].copy_from_slice(&next[3..13]);
            left = next[13];
            if (0..CHUNK).all(|i| !asked[i] || left[i] < 0.0) {
                break;
            }
        }
        for i in 0..CHUNK {
            if asked[i] {
                // NaN is no rest.
                open[i] |= !(left[i] < 0.0);
                for (to, from) in best.iter_mut().zip(&way[BEST..]) {
                    to[i] = from[i];
                }
            }
        }
    }

    fn cuts(&self, points: [&[f32]; 3], best: &mut [Column; 7], asked: &[bool; CHUNK]) {
        if !asked.contains(&true) {
            return;
        }
        let mut state = [NONE; 22];
        let mut plane = [best[0], best[1], best[2], NONE];
        for i in 0..CHUNK {
            plane[3][i] = best[0][i] * best[3][i] + best[1][i] * best[4][i] + best[2][i] * best[5][i];
        }
        step_to(&plane, &mut state);
        state[3..7].copy_from_slice(&plane);
        state[15..].copy_from_slice(&best[..]);
        for _ in 0..CUTS {
            let mut seen = [NONE; 4];
            self.displaced(points, [&state[0], &state[1], &state[2]], &mut seen);
            let before = state;
            let inputs = std::array::from_fn(|i| match i {
                0..3 => &before[i][..],
                3..7 => &seen[i - 3][..],
                _ => &before[i - 4][..],
            });
            run::<f32, 26, 22>(&CutNear, inputs, columns_mut(&mut state));
        }
        for (to, from) in best.iter_mut().zip(&state[15..]) {
            for i in 0..CHUNK {
                to[i] = if asked[i] { from[i] } else { to[i] };
            }
        }
    }

    /// Leaves of `best` what the leaf's sign confirms, and takes the first point elsewhere.
    /// Its way is then the distance between the points.
    fn sure(&self, points: [&[f32]; 3], value: &Column, first: &[Column; 7], best: &mut [Column; 7]) {
        let Some(feet) = &self.distance.feet else { return };
        let (slack, sure) = (feet.slack as f32, SURE as f32);
        let mut behind = [NONE; 3];
        for i in 0..CHUNK {
            let [x, y, z] = [3, 4, 5].map(|k| best[k][i]);
            let way = (x * x + y * y + z * z).sqrt();
            best[6][i] = way;
            let by = (sure * way + slack).copysign(value[i]);
            for k in 0..3 {
                behind[k][i] = best[k][i].mul_add(by, best[3 + k][i]);
            }
        }
        let mut values = NONE;
        self.values_at(points, [&behind[0], &behind[1], &behind[2]], &mut values);
        for i in 0..CHUNK {
            let changed = (values[i] > 0.0) != (value[i] > 0.0);
            // A NaN is not sure.
            if !(changed && best[6][i] <= first[6][i]) {
                for (to, from) in best.iter_mut().zip(first) {
                    to[i] = from[i];
                }
            }
        }
    }
}

fn put(columns: &mut [Column; 7], at: usize, numbers: Best) {
    for (column, number) in columns.iter_mut().zip(numbers) {
        column[at] = number as f32;
    }
}
