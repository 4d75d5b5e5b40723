//! The search for the nearest surface point: at a point in `f64`, and over chunks in `f32`.

use glam::DVec3;

use super::chain::{Column, Placed, columns, columns_mut};
use super::step::{Back, Cut, Plane, Shift, Slide, Start, StartBent};
use super::{Distance, Shape, rows};
use crate::field::Placement;
use crate::num::kernel::{CHUNK, Formula, run};

/// Evaluations of the leaf after that at the point itself.
const STEPS: usize = 12;

/// Starts inside, of [`STEPS`]` / STARTS` steps each.
const STARTS: usize = 3;

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Distance {
    /// How many starts there are inside.
    fn starts(&self) -> usize {
        match self.shape {
            _ if self.planes.is_empty() => 1,
            Shape::Convex => STARTS,
            // The steps count in full where only the last one is a measure.
            _ => 2,
        }
    }

    /// Height and normal of the plane of the nearest point found.
    pub(super) fn search(&self, x: DVec3, value: f64) -> (f64, DVec3) {
        self.search_by(x, value, self.starts(), STEPS / self.starts())
    }

    /// The same, with more steps: what is left of the error is in the choice of starts.
    pub(super) fn centre(&self, x: DVec3) -> (f64, DVec3) {
        let value = self.chain.value(x.to_array());
        let starts = self.starts();
        let steps = if self.shape == Shape::Bent { 2 * STEPS / starts } else { STEPS / starts };
        let (height, normal) = self.search_by(x, value, starts, steps);
        (self.settled(value, height), -normal)
    }

    fn search_by(&self, x: DVec3, value: f64, starts: usize, steps: usize) -> (f64, DVec3) {
        let seen = self.chain.at(x);
        let [gx, gy, gz] = seen.gradient.to_array();
        let start = |taken: [[f64; 3]; 2]| {
            let [[a, b, c], [d, e, f]] = taken;
            if self.shape == Shape::Bent {
                let [l, m, n] = seen.local;
                let inputs = [
                    l.v, m.v, n.v, l.d[0], l.d[1], l.d[2], m.d[0], m.d[1], m.d[2], n.d[0], n.d[1], n.d[2], gx, gy, gz,
                    seen.value, a, b, c, d, e, f,
                ];
                StartBent { planes: &self.planes, back: IDENTITY }.run(inputs)
            } else {
                let inputs = [x.x, x.y, x.z, gx, gy, gz, seen.value, a, b, c, d, e, f];
                Start { planes: &self.planes }.run(inputs)
            }
        };
        let at = |u: [f64; 3]| {
            let seen = self.chain.at(x + DVec3::from_array(u));
            let g = seen.gradient;
            [u[0], u[1], u[2], seen.value, g.x, g.y, g.z]
        };
        let mut taken = [[0.0; 3]; 2];
        if value < 0.0 && self.shape != Shape::Free {
            let plane = start(taken);
            let [n0, n1, n2, h] = plane;
            let mut u = [n0 * h, n1 * h, n2 * h];
            let mut planes = [n0, n1, n2, h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            for _ in 0..starts * steps {
                let [a, b, c, rest @ ..] = Cut.run(joined(at(u), planes));
                (u, planes) = ([a, b, c], rest);
            }
            return (planes[3], DVec3::new(planes[0], planes[1], planes[2]));
        }
        let slide = Slide { least: self.shape == Shape::Convex };
        let mut best = (f64::INFINITY, DVec3::ZERO);
        let mut least = f64::INFINITY;
        for turn in 0..starts {
            let [n0, n1, n2, h] = start(taken);
            if let Some(taken) = taken.get_mut(turn) {
                *taken = [n0, n1, n2];
            }
            let mut u = [n0 * h, n1 * h, n2 * h];
            let nothing = if slide.least { h } else { -1.0 };
            let mut rest = [u[0], u[1], u[2], n0, n1, n2, n0, n1, n2, nothing];
            for _ in 0..steps {
                let [a, b, c, n0, n1, n2, best @ ..] = slide.run(joined(at(u), rest));
                rest = [u[0], u[1], u[2], n0, n1, n2, best[0], best[1], best[2], best[3]];
                u = [a, b, c];
            }
            let [.., n0, n1, n2, h] = rest;
            let score = score(h, slide.least);
            if score < least {
                least = score;
                let h = if slide.least { h } else { h.abs().copysign(value) };
                best = (h, DVec3::new(n0, n1, n2));
            }
        }
        best
    }

    /// The search made ready for points that `placement` brings to this leaf's frame.
    pub(super) fn prepared(&self, placement: &Placement) -> Prepared<'_> {
        let map = placement.map();
        let back = map.matrix3.inverse();
        // Planes behind a deformation stay as they are; others follow the points.
        let rebased = |&([a, b, c, o], normal): &(Plane, [f64; 3])| {
            let n = map.matrix3.transpose() * DVec3::new(a, b, c);
            ([n.x, n.y, n.z, o - DVec3::new(a, b, c).dot(map.translation)], normal)
        };
        let planes = match self.shape {
            Shape::Bent => self.planes.clone(),
            _ => self.planes.iter().map(rebased).collect(),
        };
        let placed = self.chain.placed(placement);
        Prepared {
            distance: self,
            placed,
            planes,
            map: rows(&map.matrix3),
            back: rows(&back),
            scale: placement.scale,
            shift: placement.shift,
        }
    }
}

fn joined<const N: usize, const M: usize>(head: [f64; 7], tail: [f64; N]) -> [f64; M] {
    std::array::from_fn(|i| if i < 7 { head[i] } else { tail[i - 7] })
}

/// A search over chunks, made ready for a placement.
pub(super) struct Prepared<'a> {
    distance: &'a Distance,
    placed: Placed<'a>,
    planes: Vec<(Plane, [f64; 3])>,
    /// From the points to the frame of lengths, and back.
    map: [[f64; 3]; 3],
    back: [[f64; 3]; 3],
    scale: f64,
    shift: f64,
}

const NONE: Column = [0.0; CHUNK];

impl Prepared<'_> {
    /// Distance and gradient, scaled, with respect to the points.
    pub(super) fn search(&self, points: [&[f32]; 3]) -> [Column; 4] {
        let mut value = NONE;
        self.placed.values(points, &mut value);
        let mut local = [NONE; 12];
        let mut seen = [NONE; 4];
        self.gradients(points, &mut local, &mut seen);
        let free = self.distance.shape == Shape::Free;
        let inside = free || value.iter().any(|&v| v >= 0.0);
        let outside = !free && value.iter().any(|&v| v < 0.0);
        // Height and normal.
        let mut found = [NONE; 4];
        let mut first = [NONE; 4];
        self.start(points, &local, &seen, [&NONE; 6], &mut first);
        if outside {
            self.cut(points, &first, &mut found);
        }
        if inside {
            let mut slid = [NONE; 4];
            self.slide(points, &local, &seen, &first, &mut slid);
            for i in 0..CHUNK {
                if free || value[i] >= 0.0 {
                    for (to, from) in found.iter_mut().zip(&slid) {
                        to[i] = from[i];
                    }
                }
            }
        }
        let mut out = [NONE; 4];
        let [height, normal @ ..] = &found;
        let [distance, slopes @ ..] = &mut out;
        let scale = -self.scale;
        let map = self.map.map(|row| row.map(|m| m * scale));
        run(&Back { map }, columns(normal), columns_mut(slopes));
        for i in 0..CHUNK {
            let settled = self.distance.settled(f64::from(value[i]), f64::from(height[i])) * self.scale + self.shift;
            distance[i] = settled as f32;
        }
        for column in slopes {
            for slope in column {
                *slope = if slope.is_finite() { *slope } else { 0.0 };
            }
        }
        out
    }

    /// Value and gradient, the gradient in lengths.
    fn gradients(&self, points: [&[f32]; 3], local: &mut [Column; 12], out: &mut [Column; 4]) {
        let mut own = [NONE; 4];
        self.placed.gradients(points, local, &mut own);
        let [value, slopes @ ..] = &own;
        let [to, lengths @ ..] = out;
        *to = *value;
        run(&Back { map: self.back }, columns(slopes), columns_mut(lengths));
    }

    fn start(
        &self,
        points: [&[f32]; 3],
        local: &[Column; 12],
        seen: &[Column; 4],
        taken: [&Column; 6],
        out: &mut [Column; 4],
    ) {
        let [value, gx, gy, gz] = columns(seen);
        let [a, b, c, d, e, f] = taken.map(|column| &column[..]);
        if self.distance.shape == Shape::Bent {
            let [x, y, z, j, k, l, m, n, o, p, q, r] = columns(local);
            let inputs = [x, y, z, j, k, l, m, n, o, p, q, r, gx, gy, gz, value, a, b, c, d, e, f];
            run(&StartBent { planes: &self.planes, back: self.back }, inputs, columns_mut(out));
        } else {
            let [x, y, z] = points;
            let inputs = [x, y, z, gx, gy, gz, value, a, b, c, d, e, f];
            run(&Start { planes: &self.planes }, inputs, columns_mut(out));
        }
    }

    /// Value and gradient at the points displaced by u.
    fn displaced(&self, points: [&[f32]; 3], u: [&Column; 3], out: &mut [Column; 4]) {
        let mut moved = [NONE; 3];
        let ([x, y, z], [u, v, w]) = (points, u.map(|column| &column[..]));
        run(&Shift { back: self.back }, [x, y, z, u, v, w], columns_mut(&mut moved));
        self.gradients(columns(&moved), &mut [NONE; 12], out);
    }

    fn cut(&self, points: [&[f32]; 3], first: &[Column; 4], found: &mut [Column; 4]) {
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
                0..3 => &before[i][..],
                3..7 => &seen[i - 3][..],
                _ => &before[i - 4][..],
            });
            run::<f32, 19, 15>(&Cut, inputs, columns_mut(&mut state));
        }
        let [_, _, _, n0, n1, n2, h, ..] = state;
        *found = [h, n0, n1, n2];
    }

    fn slide(
        &self,
        points: [&[f32]; 3],
        local: &[Column; 12],
        seen: &[Column; 4],
        first: &[Column; 4],
        found: &mut [Column; 4],
    ) {
        let starts = self.distance.starts();
        let slide = Slide { least: self.distance.shape == Shape::Convex };
        let mut taken = [NONE; 6];
        let seen_at = &seen[0];
        found[0] = [f32::INFINITY; CHUNK];
        let mut least = found[0];
        let mut start = *first;
        for turn in 0..starts {
            if turn > 0 {
                for (to, from) in taken[3 * turn - 3..].iter_mut().zip(&start[..3]) {
                    *to = *from;
                }
                self.start(points, local, seen, taken.each_ref(), &mut start);
            }
            // u; then u and normal before, best plane.
            let mut u = [NONE; 15];
            step_to(&start, &mut u);
            let [u0, u1, u2, ..] = u;
            let [n0, n1, n2, h] = start;
            let nothing = if slide.least { h } else { [-1.0; CHUNK] };
            let mut state = [u0, u1, u2, u0, u1, u2, n0, n1, n2, n0, n1, n2, nothing];
            let mut seen = [NONE; 4];
            for _ in 0..STEPS / starts {
                self.displaced(points, [&state[0], &state[1], &state[2]], &mut seen);
                let before = state;
                let inputs = std::array::from_fn(|i| match i {
                    0..3 => &before[i][..],
                    3..7 => &seen[i - 3][..],
                    _ => &before[i - 4][..],
                });
                let mut next = [NONE; 10];
                run::<f32, 17, 10>(&slide, inputs, columns_mut(&mut next));
                let [a, b, c, n0, n1, n2, b0, b1, b2, h] = next;
                let [x, y, z, ..] = before;
                state = [a, b, c, x, y, z, n0, n1, n2, b0, b1, b2, h];
            }
            let [.., n0, n1, n2, h] = &state;
            for i in 0..CHUNK {
                let score = score(f64::from(h[i]), slide.least) as f32;
                if score < least[i] {
                    least[i] = score;
                    let h = if slide.least { h[i] } else { h[i].abs().copysign(seen_at[i]) };
                    (found[0][i], found[1][i], found[2][i], found[3][i]) = (h, n0[i], n1[i], n2[i]);
                }
            }
        }
    }
}

/// What a start's result counts as: a way that did not end on the surface is the last resort.
fn score(height: f64, least: bool) -> f64 {
    if least || height >= 0.0 { height } else { 1e6 * height.abs() }
}

/// The displacement to a plane: normal times height.
fn step_to<const N: usize>(plane: &[Column; 4], u: &mut [Column; N]) {
    let [normal @ .., height] = plane;
    for (to, n) in u.iter_mut().zip(normal) {
        for i in 0..CHUNK {
            to[i] = n[i] * height[i];
        }
    }
}
