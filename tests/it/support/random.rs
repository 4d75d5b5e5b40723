//! A random source, and what it makes without the library's solids.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rvachev::Bounds;

/// A random source (splitmix64) whose numbers depend on the seed alone.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed ^ extra_seed().wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 up to 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Evenly spread in the logarithm.
    pub fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub fn pick<T: Copy>(&mut self, choice: &[T]) -> T {
        choice[self.below(choice.len())]
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    pub fn vector(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.range(low, high), self.range(low, high), self.range(low, high))
    }

    pub fn point_in(&mut self, bounds: &Bounds) -> DVec3 {
        bounds.min + self.vector(0.0, 1.0) * bounds.size()
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(-1.0, 1.0);
            if (0.01..=1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }

    pub fn rotation(&mut self) -> DQuat {
        let axis = self.direction();
        DQuat::from_axis_angle(axis, self.range(-3.0, 3.0))
    }

    pub fn affine(&mut self) -> DAffine3 {
        let turn = DMat3::from_quat(self.rotation());
        let stretch = DMat3::from_diagonal(self.vector(0.5, 1.6));
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(self.range(-0.4, 0.4), 1.0, 0.0), DVec3::Z);
        DAffine3::from_mat3_translation(turn * shear * stretch, self.vector(-0.5, 0.5))
    }
}

/// `RANDOM_SEED` in the environment, for a search with other numbers than those of every run.
pub fn extra_seed() -> u64 {
    std::env::var("RANDOM_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(0)
}
