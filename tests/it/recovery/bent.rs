//! Random tapered, twisted and bent superellipsoids, and clouds of them.

use glam::{DVec2, DVec3};

use super::clouds::{Condition, Quadric, normals, strew};
use crate::support::Random;

/// A deformed superellipsoid: tapered, twisted, bent, then placed.
#[derive(Clone, Copy, Debug)]
pub struct Bent {
    pub base: Quadric,
    pub taper: [f64; 2],
    pub twist: f64,
    pub bend: DVec2,
}

impl Bent {
    /// Tapers up to 0.7, bends up to one radian between the middle and an end, and twists up to
    /// `twist`.
    pub fn random(twist: f64, random: &mut Random) -> Bent {
        loop {
            let mut base = Quadric::random(random);
            base.semi_axes = random.vector(0.5, 1.5);
            base.semi_axes.z = random.range(1.0, 3.0);
            let taper = [random.range(-0.7, 0.7), random.range(-0.7, 0.7)];
            let height = base.semi_axes.z;
            let bend = DVec2::from_angle(random.range(0.0, 6.3)) * random.range(0.0, 1.0) / height;
            let reach = DVec2::new(1.0 + taper[0].abs(), 1.0 + taper[1].abs()) * base.semi_axes.truncate();
            // What is valid as a solid: the box of the twisted solid keeps clear of the centre of
            // curvature.
            if (bend.x.abs() + bend.y.abs()) * reach.length() < 0.9 {
                return Bent { base, taper, twist: random.range(-twist, twist.max(1e-12)) / height, bend };
            }
        }
    }

    pub fn forward(&self, q: DVec3) -> DVec3 {
        let t = (q.z / self.base.semi_axes.z).clamp(-1.0, 1.0);
        let p = DVec2::new(q.x * (1.0 + self.taper[0] * t), q.y * (1.0 + self.taper[1] * t));
        let p = DVec2::from_angle(self.twist * q.z).rotate(p);
        let k = self.bend.length().max(1e-9);
        let u = self.bend / k;
        let r = p.dot(u);
        let gamma = k * q.z;
        let along = u * ((1.0 - (1.0 - k * r) * gamma.cos()) / k - r);
        self.base.placed((p + along).extend((1.0 - k * r) * gamma.sin() / k))
    }

    pub fn contains(&self, p: DVec3) -> bool {
        let q = self.base.rotation.transpose() * (p - self.base.center);
        let k = self.bend.length().max(1e-9);
        let u = self.bend / k;
        let big = q.truncate().dot(u);
        let r = (1.0 - (1.0 - k * big).hypot(k * q.z)) / k;
        let z = (k * q.z).atan2(1.0 - k * big) / k;
        let p = DVec2::from_angle(-self.twist * z).rotate(q.truncate() + u * (r - big));
        let t = (z / self.base.semi_axes.z).clamp(-1.0, 1.0);
        let back = DVec3::new(p.x / (1.0 + self.taper[0] * t), p.y / (1.0 + self.taper[1] * t), z);
        self.base.local_gauge(back) <= 1.0
    }

    pub fn cloud(&self, condition: Condition, count: usize, random: &mut Random) -> Vec<DVec3> {
        let surface = self.base.mesh_by(16, |v| self.forward(v));
        let noise = condition.noise * self.base.size();
        let mut points: Vec<DVec3> = (0..count).map(|_| surface.sample(random).0 + noise * normals(random)).collect();
        strew(&mut points, condition, noise, random);
        points
    }

    /// The volume of what is in both over that of what is in either.
    pub fn overlap(&self, inside: impl Fn(DVec3) -> bool, random: &mut Random) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for v in self.base.mesh(8).vertices {
            let p = self.forward(v);
            (low, high) = (low.min(p), high.max(p));
        }
        let (center, half) = (0.5 * (low + high), 0.6 * (high - low));
        let (mut both, mut either) = (0u32, 0u32);
        for _ in 0..6000 {
            let p = center + half * random.vector(-1.0, 1.0);
            let (a, b) = (self.contains(p), inside(p));
            both += u32::from(a && b);
            either += u32::from(a || b);
        }
        f64::from(both) / f64::from(either.max(1))
    }
}
