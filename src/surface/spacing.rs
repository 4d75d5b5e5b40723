//! Where a curve is sampled: by equal angles, by equal lengths, by the height of the chords.

use glam::DVec2;

use super::curve::{By, Curve};

/// A sample of one of the two curves of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) point: DVec2,
    pub(super) normal: DVec2,
    /// The normals before and after it, which differ at a corner.
    pub(super) sides: [DVec2; 2],
    /// How far along the curve, from 0 to 1.
    pub(super) texture: f64,
}

/// A part of a curve of unit size, and the scale it is seen at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) curve: Curve,
    pub(super) by: By,
    pub(super) range: [f64; 2],
    pub(super) scale: DVec2,
}

impl Arc {
    /// The sample at a parameter.
    pub(super) fn sample(&self, t: f64, texture: f64) -> Sample {
        let local = self.curve.at(t, self.by);
        Sample { point: local.point, normal: local.normal, sides: self.curve.normals_about(t, self.by), texture }
    }

    /// The point at a parameter, to scale.
    pub(super) fn point(&self, t: f64) -> DVec2 {
        self.curve.at(t, self.by).point * self.scale
    }

    /// `count` intervals of equal parameter: both ends are among the samples.
    pub(super) fn uniform(&self, count: u32) -> Vec<Sample> {
        (0..=count).map(|i| self.sample(self.share(i, count), f64::from(i) / f64::from(count))).collect()
    }

    /// The parameter that is i/count of the way: exactly in the middle and at quarters of it.
    fn share(&self, i: u32, count: u32) -> f64 {
        let [first, last] = self.range;
        let share = f64::from(i) / f64::from(count);
        if share == 1.0 { last } else { first + (last - first) * share }
    }
}
