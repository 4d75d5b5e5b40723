//! Random supershapes: polygon prisms, stars, flowers, gears, free ones; clouds of them.

use std::f64::consts::{LN_2, PI, TAU};

use glam::{DMat3, DVec3};

use super::clouds::{Condition, Surface, normals, rotation, strew};
use crate::support::Random;

/// A supershape in space: world point = rotation · local point + centre.
#[derive(Clone, Copy, Debug)]
pub struct Shaped {
    pub m: u32,
    pub n: [f64; 3],
    pub m2: u32,
    pub n2: [f64; 3],
    pub semi_axes: DVec3,
    pub rotation: DMat3,
    pub center: DVec3,
}

pub fn radius(angle: f64, m: u32, [n1, n2, n3]: [f64; 3]) -> f64 {
    if m == 0 {
        return 1.0;
    }
    let (sin, cos) = (0.25 * f64::from(m) * angle).sin_cos();
    let (a, b) = (n2 * cos.abs().max(1e-15).ln(), n3 * sin.abs().max(1e-15).ln());
    let sum = a.max(b) + (-(a - b).abs()).exp().ln_1p();
    (-sum / n1).exp()
}

impl Shaped {
    /// A star of five points.
    pub fn star() -> Shaped {
        Shaped {
            m: 5,
            n: [1.3, 1.1, 1.1],
            m2: 4,
            n2: [2.0; 3],
            semi_axes: DVec3::new(1.0, 1.0, 0.6),
            rotation: DMat3::from_rotation_y(0.7),
            center: DVec3::X,
        }
    }

    pub fn random(random: &mut Random) -> Shaped {
        let kind = random.below(5);
        // Exponents such that the radii differ by this ratio.
        let first = |n: f64, ratio: f64| (0.5 * n - 1.0) * LN_2 / ratio.ln();
        let whole = |random: &mut Random, low: usize, high: usize| (low + random.below(high - low)) as u32;
        let (m, n) = match kind {
            0 => {
                let m = random.pick(&[3, 5, 6, 8]);
                let n1 = random.log_range(20.0, 150.0);
                let n = -2.0 * (PI / f64::from(m)).cos().log2() * n1;
                (m, [n1, n, n])
            }
            1 => {
                let (m, n) = (whole(random, 3, 9), random.range(0.8, 1.5));
                (m, [first(n, random.range(0.5, 0.85)), n, n])
            }
            2 => {
                let (m, n) = (whole(random, 2, 9), random.range(3.0, 8.0));
                (m, [first(n, random.range(1.12, 1.6)), n, n])
            }
            3 => {
                let (m, n) = (whole(random, 6, 13), random.range(5.0, 20.0));
                (m, [first(n, random.range(1.1, 1.3)), n, n])
            }
            _ => {
                let (m, n) = (whole(random, 2, 9), random.range(3.0, 10.0));
                let n3 = if random.chance(0.3) { n * random.range(1.2, 1.8) } else { n };
                (m, [first(n, random.range(1.12, 1.6)), n, n3])
            }
        };
        let (m2, n2) = if random.chance(0.85) {
            (4, [random.pick(&[2.0, 4.0, 10.0, 30.0]); 3])
        } else {
            let n = random.range(2.5, 5.0);
            (random.pick(&[2, 3, 5, 6]), [first(n, random.range(1.1, 1.3)), n, n])
        };
        let a = random.range(0.7, 1.5);
        let b = if random.chance(0.7) { a } else { a * random.range(0.75, 1.3) };
        let semi_axes = DVec3::new(a, b, a * random.range(0.35, 1.6));
        Shaped { m, n, m2, n2, semi_axes, rotation: rotation(random), center: random.vector(-1.0, 1.0) }
    }

    pub fn size(&self) -> f64 {
        self.semi_axes.element_product().cbrt()
    }

    fn local_gauge(&self, q: DVec3) -> f64 {
        let q = q / self.semi_axes;
        let u = q.x.hypot(q.y) / radius(q.y.atan2(q.x), self.m, self.n);
        u.hypot(q.z) / radius(q.z.atan2(u), self.m2, self.n2)
    }

    fn mesh(&self) -> Surface {
        const AROUND: u32 = 360;
        const ALONG: u32 = 90;
        let mut vertices = Vec::new();
        for i in 0..=ALONG {
            let phi = PI * (f64::from(i) / f64::from(ALONG) - 0.5);
            let r2 = radius(phi, self.m2, self.n2);
            for j in 0..AROUND {
                let theta = TAU * f64::from(j) / f64::from(AROUND) - PI;
                let r1 = radius(theta, self.m, self.n);
                let across = r2 * phi.cos() * r1;
                vertices.push(DVec3::new(across * theta.cos(), across * theta.sin(), r2 * phi.sin()) * self.semi_axes);
            }
        }
        Surface::of_grid(vertices, ALONG as usize + 1, AROUND as usize)
    }

    pub fn cloud(&self, condition: Condition, count: usize, random: &mut Random) -> Vec<DVec3> {
        let surface = self.mesh();
        let noise = condition.noise * self.size();
        let mut points: Vec<DVec3> = (0..count)
            .map(|_| {
                let p = surface.sample(random).0;
                self.rotation * (p / self.local_gauge(p)) + self.center + noise * normals(random)
            })
            .collect();
        strew(&mut points, condition, noise, random);
        points
    }

    /// Points of what is on one side of a plane, that is 0.15 of the size behind the centre, nearly
    /// along the axis.
    pub fn half(&self, condition: Condition, count: usize, random: &mut Random) -> Vec<DVec3> {
        let mut points = self.cloud(condition, 26 * count / 10, random);
        let view = random.direction();
        let view = self.rotation * DVec3::new(view.x, view.y, 0.3 * view.z).normalize();
        points.retain(|p| (*p - self.center).dot(view) > -0.15 * self.size());
        points.truncate(count);
        points
    }

    /// The volume of what is in both over that of what is in either, by points in a box about this
    /// one.
    pub fn overlap(&self, inside: impl Fn(DVec3) -> bool, random: &mut Random) -> f64 {
        let vertices = self.mesh().vertices;
        let most = vertices.iter().map(|v| v.abs()).fold(DVec3::ZERO, DVec3::max) * 1.2;
        let (mut both, mut either) = (0, 0);
        for _ in 0..8000 {
            let q = most * random.vector(-1.0, 1.0);
            let p = self.rotation * q + self.center;
            let (a, b) = (self.local_gauge(q) <= 1.0, inside(p));
            both += usize::from(a && b);
            either += usize::from(a || b);
        }
        both as f64 / f64::from(either.max(1) as u32)
    }
}
