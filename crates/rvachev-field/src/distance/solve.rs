//! The search for the nearest surface point: at a point in `f64`, and over chunks in `f32`.

use glam::{DAffine3, DVec3};

use super::chain::{Column, Placed, columns, columns_mut};
use super::lanes::{Lanes, NONE};
use super::step::{Back, Cut, Plane, Shift, Slide, Start};
use super::{Distance, Shape, rows};
use crate::Placement;
use crate::kernel::{CHUNK, Formula, run};

/// Evaluations of the leaf after that at the point itself.
const STEPS: usize = 12;

/// Starts inside, of [`STEPS`]` / STARTS` steps each.
const STARTS: usize = 3;

impl Distance {
    /// How many starts there are inside a convex leaf.
    fn starts(&self) -> usize {
        if self.planes.is_empty() { 1 } else { STARTS }
    }

    /// Height and normal of the plane of the nearest point found.
    pub(super) fn search(&self, x: DVec3, value: f64) -> (f64, DVec3) {
        if self.shape == Shape::Free {
            return self.follow(x, value);
        }
        let seen = self.chain.at(x);
        let [gx, gy, gz] = seen.gradient.to_array();
        let start = |taken: [[f64; 3]; 2]| {
            let [[a, b, c], [d, e, f]] = taken;
            let inputs = [x.x, x.y, x.z, gx, gy, gz, seen.value, a, b, c, d, e, f];
            Start { planes: &self.planes }.run(inputs)
        };
        let mut taken = [[0.0; 3]; 2];
        if value < 0.0 {
            let plane = start(taken);
            let [n0, n1, n2, h] = plane;
            let mut u = [n0 * h, n1 * h, n2 * h];
            let mut planes = [n0, n1, n2, h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for _ in 0..STEPS {
                let [a, b, c, rest @ ..] = Cut.run(joined(self.seen_from(x, u), planes));
                (u, planes) = ([a, b, c], rest);
            }
            return (planes[3], DVec3::new(planes[0], planes[1], planes[2]));
        }
        let starts = self.starts();
        let mut best = (f64::INFINITY, DVec3::ZERO);
        for turn in 0..starts {
            let [n0, n1, n2, h] = start(taken);
            if let Some(taken) = taken.get_mut(turn) {
                *taken = [n0, n1, n2];
            }
            let mut u = [n0 * h, n1 * h, n2 * h];
            let mut rest = [u[0], u[1], u[2], n0, n1, n2, n0, n1, n2, h];
            for _ in 0..STEPS / starts {
                let [a, b, c, n0, n1, n2, best @ ..] = Slide.run(joined(self.seen_from(x, u), rest));
                rest = [u[0], u[1], u[2], n0, n1, n2, best[0], best[1], best[2], best[3]];
                u = [a, b, c];
            }
            let [.., n0, n1, n2, h] = rest;
            if h < best.0 {
                best = (h, DVec3::new(n0, n1, n2));
            }
        }
        best
    }

    /// A displacement, and value and gradient there.
    pub(super) fn seen_from(&self, x: DVec3, u: [f64; 3]) -> [f64; 7] {
        let seen = self.chain.at(x + DVec3::from_array(u));
        let g = seen.gradient;
        [u[0], u[1], u[2], seen.value, g.x, g.y, g.z]
    }

    /// The search made ready for points that `placement` brings to this leaf's frame.
    pub(super) fn prepared(&self, placement: &Placement) -> Prepared<'_> {
        let map = placement.map();
        let back = map.matrix3.inverse();
        let rebased = |&([a, b, c, o], normal): &(Plane, [f64; 3])| {
            let n = map.matrix3.transpose() * DVec3::new(a, b, c);
            ([n.x, n.y, n.z, o - DVec3::new(a, b, c).dot(map.translation)], normal)
        };
        let planes = self.planes.iter().map(rebased).collect();
        let placed = self.chain.placed(placement);
        Prepared {
            distance: self,
            placed,
            planes,
            frame: map,
            map: rows(&map.matrix3),
            back: rows(&back),
            scale: placement.scale,
            shift: placement.shift,
        }
    }
}

pub(super) fn joined<const N: usize, const M: usize>(head: [f64; 7], tail: [f64; N]) -> [f64; M] {
    std::array::from_fn(|i| if i < 7 { head[i] } else { tail[i - 7] })
}

/// A search over chunks, made ready for a placement.
pub(super) struct Prepared<'a> {
    pub(super) distance: &'a Distance,
    pub(super) placed: Placed<'a>,
    planes: Vec<(Plane, [f64; 3])>,
    frame: DAffine3,
    /// From the points to the frame of lengths, and back.
    map: [[f64; 3]; 3],
    back: [[f64; 3]; 3],
    scale: f64,
    shift: f64,
}

impl Prepared<'_> {
    /// Distance and gradient, scaled, with respect to the points.
    pub(super) fn search(&self, points: [&[f32]; 3]) -> [Column; 4] {
        let mut value = NONE;
        self.placed.values(points, &mut value);
        let found = match self.distance.shape {
            Shape::Convex => self.supported(points, &value),
            Shape::Free => self.follow(points, &value),
        };
        let len = points[0].len();
        let mut out = [NONE; 4];
        let [height, normal @ ..] = &found;
        let [distance, slopes @ ..] = &mut out;
        let scale = -self.scale;
        let map = self.map.map(|row| row.map(|m| m * scale));
        run(&Back { map }, columns(normal, len), columns_mut(slopes, len));
        for i in 0..len {
            let x = self.in_frame(points, i);
            let settled = self.distance.settled(x, f64::from(value[i]), f64::from(height[i]));
            distance[i] = (settled * self.scale + self.shift) as f32;
        }
        for column in slopes {
            for slope in column {
                *slope = if slope.is_finite() { *slope } else { 0.0 };
            }
        }
        out
    }

    /// Of a convex leaf: height and normal. What is inside and what is outside are searched
    /// apart from each other.
    fn supported(&self, points: [&[f32]; 3], value: &Column) -> [Column; 4] {
        let count = points[0].len();
        let mut found = [NONE; 4];
        for inside in [true, false] {
            let asked: [bool; CHUNK] = value.map(|value| (value >= 0.0) == inside);
            let mut lanes: Lanes<0> = Lanes::new(&asked[..count], self.placed.takes_short());
            if lanes.count == 0 {
                continue;
            }
            lanes.gather(points, []);
            let points = lanes.points();
            let mut seen = [NONE; 4];
            self.gradients(points, &mut seen);
            let mut first = [NONE; 4];
            self.start(points, &seen, [&NONE; 6], &mut first);
            let mut part = [NONE; 4];
            if inside {
                self.slide(points, &seen, &first, &mut part);
            } else {
                self.cut(points, &first, &mut part);
            }
            for (to, from) in found.iter_mut().zip(&part) {
                for lane in 0..lanes.count {
                    to[lanes.from[lane]] = from[lane];
                }
            }
        }
        found
    }

    /// A point of the chunk in the frame of lengths.
    #[inline(always)]
    pub(super) fn in_frame(&self, [x, y, z]: [&[f32]; 3], i: usize) -> DVec3 {
        self.frame.transform_point3(DVec3::new(x[i].into(), y[i].into(), z[i].into()))
    }

    /// Value and gradient, the gradient in lengths.
    pub(super) fn gradients(&self, points: [&[f32]; 3], out: &mut [Column; 4]) {
        let len = points[0].len();
        let mut own = [NONE; 4];
        self.placed.gradients(points, &mut own);
        let [value, slopes @ ..] = &own;
        let [to, lengths @ ..] = out;
        *to = *value;
        run(&Back { map: self.back }, columns(slopes, len), columns_mut(lengths, len));
    }

    fn start(&self, points: [&[f32]; 3], seen: &[Column; 4], taken: [&Column; 6], out: &mut [Column; 4]) {
        let len = points[0].len();
        let [value, gx, gy, gz] = columns(seen, len);
        let [a, b, c, d, e, f] = taken.map(|column| &column[..len]);
        let [x, y, z] = points;
        let inputs = [x, y, z, gx, gy, gz, value, a, b, c, d, e, f];
        run(&Start { planes: &self.planes }, inputs, columns_mut(out, len));
    }

    /// Value and gradient at the points displaced by u.
    pub(super) fn displaced(&self, points: [&[f32]; 3], u: [&Column; 3], out: &mut [Column; 4]) {
        self.gradients(columns(&self.moved(points, u), points[0].len()), out);
    }

    /// Values at the points displaced by u.
    pub(super) fn values_at(&self, points: [&[f32]; 3], u: [&Column; 3], out: &mut Column) {
        self.placed.values(columns(&self.moved(points, u), points[0].len()), out);
    }

    fn moved(&self, points: [&[f32]; 3], u: [&Column; 3]) -> [Column; 3] {
        let mut moved = [NONE; 3];
        let len = points[0].len();
        let ([x, y, z], [u, v, w]) = (points, u.map(|column| &column[..len]));
        run(&Shift { back: self.back }, [x, y, z, u, v, w], columns_mut(&mut moved, len));
        moved
    }

    fn cut(&self, points: [&[f32]; 3], first: &[Column; 4], found: &mut [Column; 4]) {
        let len = points[0].len();
        let mut state = [NONE; 15];
        step_to(first, &mut state);
        for (to, from) in state[3..7].iter_mut().zip(first) {
            *to = *from;
        }
        let mut seen = [NONE; 4];
        for _ in 0..STEPS {
            self.displaced(points, [&state[0], &state[1], &state[2]], &mut seen);
            let before = state;
            let inputs = std::array::from_fn(|i| match i {
                0..3 => &before[i][..len],
                3..7 => &seen[i - 3][..len],
                _ => &before[i - 4][..len],
            });
            run::<f32, 19, 15>(&Cut, inputs, columns_mut(&mut state, len));
        }
        let [_, _, _, n0, n1, n2, h, ..] = state;
        *found = [h, n0, n1, n2];
    }

    fn slide(&self, points: [&[f32]; 3], seen: &[Column; 4], first: &[Column; 4], found: &mut [Column; 4]) {
        let starts = self.distance.starts();
        let len = points[0].len();
        let mut taken = [NONE; 6];
        found[0] = [f32::INFINITY; CHUNK];
        let mut start = *first;
        for turn in 0..starts {
            if turn > 0 {
                for (to, from) in taken[3 * turn - 3..].iter_mut().zip(&start[..3]) {
                    *to = *from;
                }
                self.start(points, seen, taken.each_ref(), &mut start);
            }
            // u; then u and normal before, best plane.
            let mut u = [NONE; 15];
            step_to(&start, &mut u);
            let [u0, u1, u2, ..] = u;
            let [n0, n1, n2, h] = start;
            let mut state = [u0, u1, u2, u0, u1, u2, n0, n1, n2, n0, n1, n2, h];
            let mut seen = [NONE; 4];
            for _ in 0..STEPS / starts {
                self.displaced(points, [&state[0], &state[1], &state[2]], &mut seen);
                let before = state;
                let inputs = std::array::from_fn(|i| match i {
                    0..3 => &before[i][..len],
                    3..7 => &seen[i - 3][..len],
                    _ => &before[i - 4][..len],
                });
                let mut next = [NONE; 10];
                run::<f32, 17, 10>(&Slide, inputs, columns_mut(&mut next, len));
                let [a, b, c, n0, n1, n2, b0, b1, b2, h] = next;
                let [x, y, z, ..] = before;
                state = [a, b, c, x, y, z, n0, n1, n2, b0, b1, b2, h];
            }
            let [.., n0, n1, n2, h] = &state;
            for i in 0..len {
                if h[i] < found[0][i] {
                    (found[0][i], found[1][i], found[2][i], found[3][i]) = (h[i], n0[i], n1[i], n2[i]);
                }
            }
        }
    }
}

/// The displacement to a plane: normal times height.
pub(super) fn step_to<const N: usize>(plane: &[Column; 4], u: &mut [Column; N]) {
    let [normal @ .., height] = plane;
    for (to, n) in u.iter_mut().zip(normal) {
        for i in 0..CHUNK {
            to[i] = n[i] * height[i];
        }
    }
}
