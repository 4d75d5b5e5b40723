//! Directions of a part that are meant to be one, or square to each other.

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::samples::Kind;

/// Frames at most.
const FRAMES: usize = 3;

/// Degrees within which a direction is an axis of coordinates, two are one, or square: what facets
/// are off by rounding, and what samples may leave open at the most.
const ROUNDING: [f64; 3] = [0.01, 0.02, 0.02];
const OF_VOXELS: [f64; 3] = [0.8, 1.0, 1.0];
const OF_SCANS: [f64; 3] = [1.0, 2.0, 1.0];

/// Directions that were settled, from the first on.
pub(super) struct Directions {
    all: Vec<(DVec3, f64)>,
    /// Sines of these angles.
    least: [f64; 3],
    most: [f64; 3],
}

impl Directions {
    pub(super) fn new(kind: Kind) -> Directions {
        let degrees = match kind {
            Kind::Cad => ROUNDING,
            Kind::Voxels => OF_VOXELS,
            Kind::Scan => OF_SCANS,
        };
        let [least, most] = [ROUNDING, degrees].map(|degrees| degrees.map(|angle: f64| angle.to_radians().sin()));
        Directions { all: Vec::new(), least, most }
    }

    /// What a direction is meant to be, of the same sign, that samples leave open by an angle of
    /// this sine.
    pub(super) fn settled(&self, direction: DVec3, open: f64) -> DVec3 {
        let [snap, one, square] = std::array::from_fn(|i| open.clamp(self.least[i], self.most[i]));
        let near =
            |to: DVec3, sine: f64| (direction.cross(to).length() < sine).then(|| to * direction.dot(to).signum() + 0.0);
        let axis = DVec3::AXES.into_iter().find_map(|axis| near(axis, snap));
        if let Some(known) = axis.or_else(|| self.all.iter().find_map(|(known, _)| near(*known, one))) {
            return known;
        }
        let mut settled = direction;
        let mut fixed: Vec<DVec3> = Vec::new();
        for (known, _) in &self.all {
            // Of those that it is square to, only such count as are square to each other.
            if direction.dot(*known).abs() < square && fixed.iter().all(|f| f.dot(*known).abs() < 1e-9) {
                settled -= settled.dot(*known) * *known;
                fixed.push(*known);
            }
            if fixed.len() == 2 {
                break;
            }
        }
        settled.normalize() + 0.0
    }

    /// Adds a settled direction with the share of the area that it is of.
    pub(super) fn add(&mut self, direction: DVec3, share: f64) {
        match self.all.iter_mut().find(|(known, _)| known.cross(direction).length() < 1e-9) {
            Some((_, sum)) => *sum += share,
            None => self.all.push((direction, share)),
        }
    }

    /// Orthogonal frames of the directions with the largest shares.
    pub(super) fn frames(&self) -> Vec<DMat3> {
        let mut left = self.all.clone();
        order::falling(&mut left, |a| a.1);
        let mut frames: Vec<DMat3> = Vec::new();
        while let (Some(&(first, _)), true) = (left.first(), frames.len() < FRAMES) {
            let across = left.iter().map(|d| d.0).find(|d| d.dot(first).abs() < self.most[2].max(1e-6));
            let least = DVec3::AXES[first.abs().min_position()];
            let second = across.unwrap_or(least);
            let second = (second - second.dot(first) * first).normalize();
            let frame = tidy(first, second);
            left.retain(|(d, _)| (0..3).all(|k| frame.col(k).cross(*d).length() > self.most[1].max(1e-6)));
            frames.push(frame);
        }
        frames
    }
}

/// The right-handed frame of two directions and the one across them, as near to the coordinates' as
/// can be.
fn tidy(first: DVec3, second: DVec3) -> DMat3 {
    let mut left = vec![first, second, first.cross(second)];
    let mut columns = [DVec3::ZERO; 3];
    for axis in [2, 1] {
        let at = (0..left.len()).max_by(|i, j| left[*i][axis].abs().total_cmp(&left[*j][axis].abs()));
        let best = left.swap_remove(at.unwrap_or(0));
        columns[axis] = best * best[axis].signum();
    }
    columns[0] = columns[1].cross(columns[2]);
    DMat3::from_cols(columns[0], columns[1], columns[2])
}

/// The frame with an axis as z, upwards along the axis of coordinates that it is nearest to.
pub(super) fn about(axis: DVec3) -> DMat3 {
    let axis = axis * axis[axis.abs().max_position()].signum() + 0.0;
    let x = DVec3::AXES[axis.abs().min_position()].cross(axis).normalize();
    DMat3::from_cols(x, axis.cross(x), axis)
}
