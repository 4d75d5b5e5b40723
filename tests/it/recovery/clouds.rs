//! Random superellipsoids and clouds of their surfaces: clean, noisy, among strewn points, seen
//! from one side, on a table.

use std::f64::consts::{FRAC_PI_4, TAU};

use glam::{DMat3, DQuat, DVec3};

use crate::support::Random;

/// A superellipsoid in space: world point = rotation · local point + centre.
#[derive(Clone, Copy, Debug)]
pub struct Quadric {
    pub e: [f64; 2],
    pub semi_axes: DVec3,
    pub rotation: DMat3,
    pub center: DVec3,
}

/// How a cloud is spoilt.
#[derive(Clone, Copy, Debug, Default)]
pub struct Condition {
    pub name: &'static str,
    /// Standard deviation, in proportion to (a₁a₂a₃)^⅓.
    pub noise: f64,
    /// Share of the whole cloud that is strewn over the box of twice the size.
    pub strewn: f64,
    /// Seen from one side, noise along the ray.
    pub view: bool,
    /// What is strewn is on a table below.
    pub table: bool,
}

pub const CONDITIONS: [Condition; 8] = [
    Condition { name: "clean", noise: 0.0, strewn: 0.0, view: false, table: false },
    Condition { name: "1 % noise", noise: 0.01, strewn: 0.0, view: false, table: false },
    Condition { name: "+ 20 % outliers", noise: 0.01, strewn: 0.2, view: false, table: false },
    Condition { name: "+ 40 % outliers", noise: 0.01, strewn: 0.4, view: false, table: false },
    Condition { name: "+ 60 % outliers", noise: 0.01, strewn: 0.6, view: false, table: false },
    Condition { name: "one-sided view", noise: 0.01, strewn: 0.0, view: true, table: false },
    Condition { name: "view + 20 % outliers", noise: 0.01, strewn: 0.2, view: true, table: false },
    Condition { name: "on a table (40 %)", noise: 0.01, strewn: 0.4, view: false, table: true },
];

pub fn normal(random: &mut Random) -> f64 {
    let radius = (-2.0 * (1.0 - random.unit()).ln()).sqrt();
    radius * (TAU * random.unit()).cos()
}

pub fn normals(random: &mut Random) -> DVec3 {
    DVec3::new(normal(random), normal(random), normal(random))
}

/// A rotation, uniform over all.
pub fn rotation(random: &mut Random) -> DMat3 {
    let q = DQuat::from_xyzw(normal(random), normal(random), normal(random), normal(random));
    DMat3::from_quat(q.normalize())
}

impl Quadric {
    pub fn random(random: &mut Random) -> Quadric {
        let e = [random.range(0.1, 1.9), random.range(0.1, 1.9)];
        let semi_axes = random.vector(0.5, 3.0);
        Quadric { e, semi_axes, rotation: rotation(random), center: random.vector(-1.0, 1.0) }
    }

    /// The size that lengths are compared with.
    pub fn size(&self) -> f64 {
        self.semi_axes.element_product().cbrt()
    }

    pub fn local_gauge(&self, q: DVec3) -> f64 {
        let u = (q.abs() / self.semi_axes).max(DVec3::splat(1e-12));
        let norm = |a: f64, b: f64, e: f64| {
            let (hi, lo) = (a.max(b), a.min(b));
            hi * (1.0 + (lo / hi).powf(2.0 / e)).powf(0.5 * e)
        };
        norm(norm(u.x, u.y, self.e[1]), u.z, self.e[0])
    }

    pub fn gauge(&self, p: DVec3) -> f64 {
        self.local_gauge(self.rotation.transpose() * (p - self.center))
    }

    pub fn placed(&self, q: DVec3) -> DVec3 {
        self.rotation * q + self.center
    }

    /// Triangles in local coordinates, rows evenly spaced by arc length.
    pub fn mesh(&self, n: usize) -> Surface {
        self.mesh_by(n, |v| v)
    }

    /// The same with every vertex moved.
    pub fn mesh_by(&self, n: usize, moved: impl Fn(DVec3) -> DVec3) -> Surface {
        let ring = quarter(self.e[1], n);
        let mut around = ring.clone();
        around.pop();
        let mirrored: Vec<[f64; 2]> = ring.iter().rev().map(|[c, s]| [-c, *s]).collect();
        around.extend_from_slice(&mirrored[..mirrored.len() - 1]);
        let half: Vec<[f64; 2]> = around.iter().map(|[c, s]| [-c, -s]).collect();
        around.extend(half);
        let side = quarter(self.e[0], n);
        let mut rows: Vec<[f64; 2]> = side.iter().rev().map(|[c, s]| [*c, -s]).collect();
        rows.pop();
        rows.extend(side);
        let mut vertices = Vec::new();
        for [c, s] in &rows {
            for [x, y] in &around {
                vertices.push(moved(DVec3::new(c * x, c * y, *s) * self.semi_axes));
            }
        }
        Surface::of_grid(vertices, rows.len(), around.len())
    }
}

/// Points of the first quadrant of a superellipse, evenly spaced to either side of its corner at
/// 45°.
fn quarter(e: f64, n: usize) -> Vec<[f64; 2]> {
    let mut out = vec![[1.0, 0.0]];
    for from in [0.0, FRAC_PI_4] {
        let fine: Vec<[f64; 2]> = (0..=2000)
            .map(|i| {
                let angle = from + FRAC_PI_4 * f64::from(i) / 2000.0;
                let (s, c) = angle.sin_cos();
                let m = c.max(s);
                let r = 1.0 / (m * ((c / m).powf(2.0 / e) + (s / m).powf(2.0 / e)).powf(0.5 * e));
                [r * c, r * s]
            })
            .collect();
        let mut lengths = vec![0.0];
        for pair in fine.windows(2) {
            let step = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            lengths.push(lengths[lengths.len() - 1] + step);
        }
        for k in 1..=n {
            let wanted = lengths[2000] * k as f64 / n as f64;
            let at = lengths.partition_point(|l| *l < wanted).clamp(1, 2000);
            let t = (wanted - lengths[at - 1]) / (lengths[at] - lengths[at - 1]).max(1e-300);
            out.push([0, 1].map(|i| fine[at - 1][i] + t.min(1.0) * (fine[at][i] - fine[at - 1][i])));
        }
    }
    let last = out.len() - 1;
    out[last] = [0.0, 1.0];
    out
}

/// Triangles with their areas.
pub struct Surface {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
    /// Sums of the areas.
    pub areas: Vec<f64>,
}

impl Surface {
    /// Rows of closed rings.
    pub fn of_grid(vertices: Vec<DVec3>, rows: usize, columns: usize) -> Surface {
        let mut surface = Surface { vertices, triangles: Vec::new(), areas: Vec::new() };
        let mut sum = 0.0;
        for i in 0..rows - 1 {
            for j in 0..columns {
                let (a, b) = (i * columns + j, i * columns + (j + 1) % columns);
                for t in [[a, b, b + columns], [a, b + columns, a + columns]] {
                    let area = 0.5 * surface.cross(t).length();
                    if area > 1e-14 {
                        sum += area;
                        surface.triangles.push(t);
                        surface.areas.push(sum);
                    }
                }
            }
        }
        surface
    }

    fn cross(&self, [a, b, c]: [usize; 3]) -> DVec3 {
        (self.vertices[b] - self.vertices[a]).cross(self.vertices[c] - self.vertices[a])
    }

    /// A point uniform by area, and the normal there, away from the origin.
    pub fn sample(&self, random: &mut Random) -> (DVec3, DVec3) {
        let wanted = random.unit() * self.areas[self.areas.len() - 1];
        let t = self.triangles[self.areas.partition_point(|a| *a < wanted).min(self.areas.len() - 1)];
        let (r1, r2) = (random.unit().sqrt(), random.unit());
        let [a, b, c] = t.map(|i| self.vertices[i]);
        let point = a * (1.0 - r1) + b * (r1 * (1.0 - r2)) + c * (r1 * r2);
        let normal = self.cross(t).normalize_or_zero();
        (point, if normal.dot(point) < 0.0 { -normal } else { normal })
    }

    /// The distance of a point, by the triangles whose middles are nearest.
    pub fn distance(&self, centers: &[DVec3], p: DVec3) -> f64 {
        const NEAR: usize = 12;
        let mut near: Vec<(f64, usize)> = Vec::with_capacity(NEAR + 1);
        for (i, center) in centers.iter().enumerate() {
            let d = center.distance_squared(p);
            if near.len() < NEAR || d < near[NEAR - 1].0 {
                let at = near.partition_point(|n| n.0 < d);
                near.insert(at, (d, i));
                near.truncate(NEAR);
            }
        }
        let squared = |i: usize| to_triangle(p, self.triangles[i].map(|v| self.vertices[v]));
        near.into_iter().map(|(_, i)| squared(i)).fold(f64::INFINITY, f64::min).sqrt()
    }

    pub fn centers(&self) -> Vec<DVec3> {
        self.triangles.iter().map(|t| t.iter().map(|v| self.vertices[*v]).sum::<DVec3>() / 3.0).collect()
    }
}

/// The squared distance of a point to a triangle.
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let segment = |a: DVec3, b: DVec3| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        (p - a - (b - a) * t).length_squared()
    };
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(u, v)| normal.dot((*v - *u).cross(p - *u)) >= 0.0);
    if inside {
        let n = normal.normalize_or_zero();
        return (p - a).dot(n).powi(2);
    }
    segment(a, b).min(segment(b, c)).min(segment(c, a))
}

/// A cloud of `count` points of the solid and those strewn about it, in random order.
pub fn cloud(truth: &Quadric, condition: Condition, count: usize, random: &mut Random) -> Vec<DVec3> {
    let surface = truth.mesh(16);
    let noise = condition.noise * truth.size();
    let mut points = Vec::with_capacity(count);
    let view = random.direction();
    let mut tries = 0;
    while points.len() < count && tries < 8 * count {
        tries += usize::from(condition.view);
        let (point, normal) = surface.sample(random);
        let point = truth.placed(point / truth.local_gauge(point));
        if condition.view {
            if random.unit() < (truth.rotation * normal).dot(view) {
                points.push(point + noise * self::normal(random) * view);
            }
        } else {
            points.push(point + noise * normals(random));
        }
    }
    strew(&mut points, condition, noise, random);
    points
}

/// Adds strewn points, and shuffles all.
pub fn strew(points: &mut Vec<DVec3>, condition: Condition, noise: f64, random: &mut Random) {
    let share = condition.strewn;
    let count = (points.len() as f64 * share / (1.0 - share)).round() as usize;
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    for _ in 0..count {
        let mut p = 0.5 * (low + high) + random.vector(-1.0, 1.0) * (high - low);
        if condition.table {
            p.z = low.z + noise * normal(random);
        }
        points.push(p);
    }
    for i in (1..points.len()).rev() {
        points.swap(i, random.below(i + 1));
    }
}

/// The symmetric mean distance of two surfaces, in proportion to the size of the first.
pub fn mean_distance(truth: &Quadric, found: &Quadric, samples: usize, random: &mut Random) -> f64 {
    let surfaces = [truth, found].map(|quadric| {
        let mut surface = quadric.mesh(12);
        for v in &mut surface.vertices {
            *v = quadric.placed(*v);
        }
        let points: Vec<DVec3> = (0..samples)
            .map(|_| {
                let p = surface.sample(random).0;
                quadric.center + (p - quadric.center) / quadric.gauge(p)
            })
            .collect();
        let centers = surface.centers();
        (surface, centers, points)
    });
    let mut sum = 0.0;
    for (from, to) in [(0, 1), (1, 0)] {
        let (surface, centers, _) = &surfaces[to];
        sum += surfaces[from].2.iter().map(|p| surface.distance(centers, *p)).sum::<f64>();
    }
    sum / (2 * samples) as f64 / truth.size()
}
