//! Descents from a pose: Gauss–Newton steps on a solid's residuals, with weights that fall off.

use glam::{DMat3, DQuat, DVec3};

use super::feet::feet;
use super::linear::{median, solved};
use super::solve::NORMAL;
use super::weighted::Weighted;
use crate::eval::Program;
use crate::mesh::{Slope, Slopes};
use crate::{Cancelled, Run};

/// Parameters: a turn, a shift, and the logarithm of the scale.
pub(super) const PARAMETERS: usize = 7;

/// Residuals that are told apart in the end, in sizes of the model.
pub(super) const CLOSE: f64 = 0.02;

/// scan point = scale · rotation · (model point) + translation.
#[derive(Clone, Copy)]
pub(super) struct Pose {
    pub(super) rotation: DMat3,
    pub(super) translation: DVec3,
    pub(super) scale: f64,
}

impl Pose {
    fn to_model(self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * (p - self.translation) / self.scale
    }
}

/// What residuals are, in length units of the solid or near them.
#[derive(Clone, Copy)]
pub(super) enum Residual<'a> {
    /// Distances to first order, as far as single precision tells.
    Slope(&'a Program),
    /// Distances to where Newton steps lead.
    Foot(&'a Program),
    /// Equation 15, over how steep it is at the surface.
    Weighted(&'a Weighted, f64),
}

/// A residual, its gradient and where it was asked, in coordinates of the solid.
type Term = (f64, DVec3, DVec3);

/// Normal equations of a step, and what they would make smaller.
pub(super) struct Normal {
    pub(super) matrix: [[f64; PARAMETERS]; PARAMETERS],
    right: [f64; PARAMETERS],
    cost: f64,
}

/// A scan's points against a solid.
#[derive(Clone, Copy)]
pub(super) struct Align<'a> {
    pub(super) residual: Residual<'a>,
    pub(super) points: &'a [DVec3],
    /// The size of the solid.
    pub(super) size: f64,
    /// Whether the scale is free.
    pub(super) scale: bool,
}

impl Align<'_> {
    fn terms(&self, pose: Pose, run: &Run) -> Result<Vec<Term>, Cancelled> {
        let quiet = Run { progress: None, ..run.clone() };
        let at: Vec<DVec3> = self.points.iter().map(|p| pose.to_model(*p)).collect();
        let far = 10.0 * self.size;
        match self.residual {
            Residual::Slope(program) => {
                let slopes =
                    Slopes { program, precision: 1e-4 * self.size, reach: CLOSE * self.size }.at(&at, &quiet)?;
                let of = |(q, slope): (&DVec3, &Slope)| {
                    let length = slope.gradient.length();
                    let d = if length > 1e-9 { slope.value / length } else { slope.value };
                    (d.clamp(-far, far), slope.gradient.normalize_or_zero(), *q)
                };
                Ok(at.iter().zip(&slopes).map(of).collect())
            }
            Residual::Foot(program) => {
                let feet = feet(program, &at, &quiet)?;
                Ok(at.iter().zip(&feet).map(|(q, foot)| (0.0 - foot.off.clamp(-far, far), -foot.normal, *q)).collect())
            }
            Residual::Weighted(field, steepness) => {
                let slopes = field.at(&at, &quiet)?;
                let of = |(q, slope): (&DVec3, &Slope)| {
                    ((slope.value / steepness).clamp(-far, far), slope.gradient / steepness, *q)
                };
                Ok(at.iter().zip(&slopes).map(of).collect())
            }
        }
    }

    pub(super) fn normal(&self, pose: Pose, width: f64, run: &Run) -> Result<Normal, Cancelled> {
        let mut normal = Normal { matrix: [[0.0; PARAMETERS]; PARAMETERS], right: [0.0; PARAMETERS], cost: 0.0 };
        for (d, n, q) in self.terms(pose, run)? {
            let square = (d / width.max(1e-12 * self.size)).powi(2);
            let weight = (1.0 + square).powi(-2);
            normal.cost += square / (1.0 + square);
            let turn = -q.cross(n);
            let row = [turn.x, turn.y, turn.z, -n.x, -n.y, -n.z, -n.dot(q)];
            for i in 0..PARAMETERS {
                normal.right[i] -= weight * row[i] * d;
                for j in 0..=i {
                    normal.matrix[i][j] += weight * row[i] * row[j];
                }
            }
        }
        Ok(normal)
    }

    /// A step for each width; those that make the cost of their width larger are shortened.
    pub(super) fn descend(
        &self,
        mut pose: Pose,
        widths: impl Iterator<Item = f64>,
        run: &Run,
    ) -> Result<Pose, Cancelled> {
        let free = std::array::from_fn(|i| i < 6 || self.scale);
        for width in widths {
            run.check()?;
            let normal = self.normal(pose, width, run)?;
            let mut damping = 1e-4;
            for _ in 0..3 {
                let mut matrix = normal.matrix;
                let largest = (0..PARAMETERS).map(|i| matrix[i][i]).fold(0.0, f64::max);
                for (i, row) in matrix.iter_mut().enumerate() {
                    row[i] += damping * row[i] + 1e-9 * largest + f64::MIN_POSITIVE;
                }
                let Some(step) = solved(&matrix, &normal.right, &free) else { break };
                let next = self.moved(pose, &step);
                if self.normal(next, width, run)?.cost <= normal.cost {
                    pose = next;
                    break;
                }
                damping = (100.0 * damping).max(0.1);
            }
        }
        Ok(pose)
    }

    fn moved(&self, pose: Pose, step: &[f64; PARAMETERS]) -> Pose {
        let turn = DVec3::from_slice(&step[..3]).clamp_length_max(0.8);
        let shift = DVec3::from_slice(&step[3..6]).clamp_length_max(self.size);
        let scale = pose.scale * step[6].clamp(-0.3, 0.3).exp();
        let translation = pose.translation + pose.rotation * shift * pose.scale;
        let rotation = DQuat::from_mat3(&pose.rotation) * DQuat::from_scaled_axis(turn);
        Pose { rotation: DMat3::from_quat(rotation.normalize()), translation, scale }
    }

    /// The mean of d²/(d² + σ²), σ being what is told apart in the end.
    pub(super) fn cost(&self, pose: Pose, run: &Run) -> Result<f64, Cancelled> {
        Ok(self.normal(pose, CLOSE * self.size, run)?.cost / self.points.len() as f64)
    }

    /// By the median: right while less than half of the points are outliers.
    pub(super) fn noise(&self, pose: Pose, run: &Run) -> Result<f64, Cancelled> {
        let mut sizes: Vec<f64> = self.terms(pose, run)?.iter().map(|r| r.0.abs()).collect();
        Ok((NORMAL * median(&mut sizes)).max(1e-9 * self.size))
    }
}
