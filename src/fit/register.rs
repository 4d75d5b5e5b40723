//! The pose of a scan of a known solid.
//!
//! ```text
//!     scan point = s·R·(model point) + t        residual f/|∇f| at Rᵀ(p − t)/s, n = ∇f/|∇f| there
//!     by a turn ω about the model's axes  −n·(ω × q)     a shift  −n     ln s  −n·q
//! ```
//!
//! From 24 rotations of the principal axes, Gauss–Newton steps with weights 1/(1 + (d/σ)²)² whose σ
//! falls from .6 of the size: at first all points pull, at last those that fit.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::check::{check_depth, check_extent};
use super::covariance::Covariance;
use super::density::dense;
use super::error::FitError;
use super::linear::{Principal, median, solved};
use super::random::Random;
use super::solve::NORMAL;
use crate::distance::compiled;
use crate::eval::Program;
use crate::geom::PointCloud;
use crate::mesh::Slopes;
use crate::{Cancelled, CellSize, MeshSettings, Run, Solid};

/// Parameters: a turn, a shift, and the logarithm of the scale.
const PARAMETERS: usize = 7;

const NAMES: [&str; PARAMETERS] = ["turn x", "turn y", "turn z", "shift x", "shift y", "shift z", "ln scale"];

/// Points of the search, so few that they are one task, and of the last steps.
const FEW: usize = 250;
const MORE: usize = 1500;

/// σ of the first step, in sizes of the model, and what it falls by from step to step.
const WIDE: f64 = 0.6;
const FALL: f64 = 0.7;

/// Residuals that are told apart in the end, in sizes of the model.
const CLOSE: f64 = 0.02;

/// How a scan is registered. `..RegisterSettings::default()` keeps what is not named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct RegisterSettings {
    /// What random choices are made from. Default: 0.
    pub seed: u64,
    /// Whether the scan may be larger or smaller than the solid. Default: no.
    pub scale: bool,
}

/// Where a solid is in a scan: scan point = scale · rotation · (point of the solid) + translation.
#[derive(Clone, Debug)]
pub struct Registration {
    /// The rotation.
    pub rotation: DQuat,
    /// The translation, in length units of the scan.
    pub translation: DVec3,
    /// Lengths of the scan over those of the solid; 1 unless it was asked for.
    pub scale: f64,
    /// The standard deviation of the points that fit, in length units of the scan.
    pub noise: f64,
    /// The mean of d²/(d² + σ²) over the points, σ being 2 % of the solid's size: near 0 where all
    /// fit, about the share of the outliers where the pose is right.
    pub cost: f64,
    /// The covariance of a turn about the solid's axes (radians), a shift along them (length units
    /// of the solid), and the logarithm of the scale: large along directions that the points leave
    /// free.
    pub covariance: Covariance,
}

impl Registration {
    /// The solid in the scan's place.
    #[must_use]
    pub fn place(&self, solid: &Solid) -> Solid {
        let pose = DAffine3::from_scale_rotation_translation(DVec3::splat(self.scale), self.rotation, self.translation);
        solid.affine(pose)
    }
}

/// Finds the pose of a solid in a scan of it, from any rotation.
///
/// The part of the scan that is of the solid should be 60 % or more, and show most of it: of views
/// from one side fewer come out right. A solid that looks the same from several sides is found in
/// any of these poses. A failure is told by [`Registration::cost`], which then is well above the
/// share of the outliers.
///
/// # Errors
///
/// [`FitError::Solid`] if the solid is not valid or unbounded, [`FitError::TooFew`],
/// [`FitError::Flat`] and [`FitError::Extent`] of the points.
///
/// ```
/// use glam::DVec3;
/// use rvachev::fit::{RegisterSettings, register};
/// use rvachev::{CellSize, MeshSettings, PointCloud, Solid, deg};
///
/// let part = Solid::cuboid([4.0, 3.0, 1.0]) | Solid::cylinder(0.6, 3.0).translate([1.0, 0.5, 1.0]);
/// let placed = part.rotate_x(deg(70.0)).rotate_z(deg(200.0)).translate([5.0, -2.0, 1.0]);
/// let mesh = placed.mesh(&MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() })?;
/// let scan = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect())?;
/// let found = register(&part, &scan, &RegisterSettings::default())?;
/// assert!(found.cost < 0.02);
/// assert!((found.translation - DVec3::new(5.0, -2.0, 1.0)).length() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn register(solid: &Solid, cloud: &PointCloud, settings: &RegisterSettings) -> Result<Registration, FitError> {
    register_with(solid, cloud, settings, &Run::default())
}

/// [`register`] with a [`Run`].
///
/// # Errors
///
/// Those of [`register`], and [`FitError::Cancelled`].
pub fn register_with(
    solid: &Solid,
    cloud: &PointCloud,
    settings: &RegisterSettings,
    run: &Run,
) -> Result<Registration, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    let needed = 2 * PARAMETERS + 2;
    if cloud.len() < needed {
        let kind = "pose";
        return Err(FitError::TooFew { kind, points: cloud.len(), parameters: PARAMETERS, needed });
    }
    check_extent(cloud)?;
    check_depth(cloud.positions())?;
    let programs = compiled(solid)?;
    let model = Model::of(&programs.surface, solid, settings.scale, &run)?;
    run.install(|| model.register(cloud, settings, &run))
}

/// The solid with the frame of its surface.
struct Model<'a> {
    program: &'a Program,
    frame: Principal,
    size: f64,
    scale: bool,
}

#[derive(Clone, Copy)]
struct Pose {
    rotation: DMat3,
    translation: DVec3,
    scale: f64,
}

impl Pose {
    fn to_model(self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * (p - self.translation) / self.scale
    }
}

impl Model<'_> {
    fn of<'a>(program: &'a Program, solid: &Solid, scale: bool, run: &Run) -> Result<Model<'a>, FitError> {
        let settings = MeshSettings { cell: CellSize::LongestSide(32), ..MeshSettings::default() };
        let quiet = Run { progress: None, ..run.clone() };
        let mesh = solid.mesh_with(&settings, &quiet).map_err(|error| match error {
            crate::error::MeshingError::Solid(error) => FitError::Solid(error),
            crate::error::MeshingError::Cancelled(cancelled) => FitError::Cancelled(cancelled),
            other => FitError::Meshing { what: other.to_string() },
        })?;
        // Cells have triangles by their area, more or less.
        let middles: Vec<DVec3> = mesh
            .triangles()
            .iter()
            .map(|t| t.iter().map(|v| mesh.positions()[*v as usize].as_dvec3()).sum::<DVec3>() / 3.0)
            .collect();
        let frame = Principal::of(middles.iter().copied());
        let size = frame.variances.iter().sum::<f64>().sqrt();
        Ok(Model { program, frame, size, scale })
    }

    fn register(&self, cloud: &PointCloud, settings: &RegisterSettings, run: &Run) -> Result<Registration, FitError> {
        let mut random = Random::new(settings.seed);
        let all = cloud.positions();
        let chosen = |count: usize, random: &mut Random| -> Vec<DVec3> {
            random.chosen(all.len(), count).into_iter().map(|i| all[i]).collect()
        };
        let (few, more) = (chosen(FEW, &mut random), chosen(MORE, &mut random));
        let starts = self.starts(&more);
        let widths = |from: f64, steps: i32| (0..steps).map(move |i| from * FALL.powi(i) * self.size);
        let mut found = starts
            .par_iter()
            .map(|start| {
                let pose = self.descend(*start, &few, widths(WIDE, 8), run)?;
                Ok((self.cost(pose, &few, run)?, pose))
            })
            .collect::<Result<Vec<(f64, Pose)>, Cancelled>>()?;
        run.report(0.5);
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(4);
        let mut best = found
            .par_iter()
            .map(|(_, pose)| {
                let pose = self.descend(*pose, &few, widths(WIDE * FALL.powi(5), 8), run)?;
                Ok((self.cost(pose, &few, run)?, pose))
            })
            .collect::<Result<Vec<(f64, Pose)>, Cancelled>>()?;
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut pose = best[0].1;
        run.report(0.7);
        // From as wide as the residuals that are told apart down to the noise.
        pose = self.descend(pose, &more, widths(2.0 * CLOSE, 3), run)?;
        for _ in 0..4 {
            let width = 3.0 * self.noise(pose, &more, run)?;
            pose = self.descend(pose, &more, std::iter::once(width), run)?;
        }
        let noise = self.noise(pose, &more, run)?;
        let cost = self.cost(pose, &more, run)?;
        let normal = self.normal(pose, &more, 3.0 * noise, run)?;
        let units = std::array::from_fn(|_| 1.0);
        let share = all.len() as f64 / more.len() as f64;
        let covariance = Covariance::from_normal(NAMES, &normal.matrix, noise, share, units);
        run.report(1.0);
        Ok(Registration {
            rotation: DQuat::from_mat3(&pose.rotation).normalize(),
            translation: pose.translation,
            scale: pose.scale,
            noise: noise * pose.scale,
            cost,
            covariance,
        })
    }

    /// The 24 rotations of the principal axes of points to those of the solid.
    fn starts(&self, points: &[DVec3]) -> Vec<Pose> {
        // Strewn points would turn the axes, and make the scan seem larger.
        let frame = Principal::of(dense(points).kept.iter().map(|i| points[*i]));
        let scale = if self.scale { frame.variances.iter().sum::<f64>().sqrt() / self.size } else { 1.0 };
        let mut starts = Vec::new();
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            for signs in 0..4 {
                let sign = |bit: i32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let (x, y) = (frame.axes.col(i) * sign(0), frame.axes.col(j) * sign(1));
                let z = x.cross(y);
                debug_assert!(z.dot(frame.axes.col(k)).abs() > 0.9);
                let rotation = DMat3::from_cols(x, y, z) * self.frame.axes.transpose();
                starts.push(Pose { rotation, translation: frame.mean - rotation * self.frame.mean * scale, scale });
            }
        }
        starts
    }

    /// Distances to first order, with the unit gradients, in length units of the solid.
    fn residuals(&self, pose: Pose, points: &[DVec3], run: &Run) -> Result<Vec<(f64, DVec3, DVec3)>, Cancelled> {
        let quiet = Run { progress: None, ..run.clone() };
        let at: Vec<DVec3> = points.iter().map(|p| pose.to_model(*p)).collect();
        let slopes = Slopes { program: self.program, precision: 1e-4 * self.size }.at(&at, &quiet)?;
        let of = |(q, slope): (&DVec3, &crate::mesh::Slope)| {
            let length = slope.gradient.length();
            let d = if length > 1e-9 { slope.value / length } else { slope.value };
            (d.clamp(-10.0 * self.size, 10.0 * self.size), slope.gradient.normalize_or_zero(), *q)
        };
        Ok(at.iter().zip(&slopes).map(of).collect())
    }

    fn normal(&self, pose: Pose, points: &[DVec3], width: f64, run: &Run) -> Result<Normal, Cancelled> {
        let mut normal = Normal { matrix: [[0.0; PARAMETERS]; PARAMETERS], right: [0.0; PARAMETERS], cost: 0.0 };
        for (d, n, q) in self.residuals(pose, points, run)? {
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
    fn descend(
        &self,
        mut pose: Pose,
        points: &[DVec3],
        widths: impl Iterator<Item = f64>,
        run: &Run,
    ) -> Result<Pose, Cancelled> {
        let free = std::array::from_fn(|i| i < 6 || self.scale);
        for width in widths {
            run.check()?;
            let normal = self.normal(pose, points, width, run)?;
            let mut damping = 1e-4;
            for _ in 0..3 {
                let mut matrix = normal.matrix;
                let largest = (0..PARAMETERS).map(|i| matrix[i][i]).fold(0.0, f64::max);
                for (i, row) in matrix.iter_mut().enumerate() {
                    row[i] += damping * row[i] + 1e-9 * largest + f64::MIN_POSITIVE;
                }
                let Some(step) = solved(&matrix, &normal.right, &free) else { break };
                let next = self.moved(pose, &step);
                if self.normal(next, points, width, run)?.cost <= normal.cost {
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

    fn cost(&self, pose: Pose, points: &[DVec3], run: &Run) -> Result<f64, Cancelled> {
        Ok(self.normal(pose, points, CLOSE * self.size, run)?.cost / points.len() as f64)
    }

    /// By the median of the nearer half of the points: outliers are the other one at most.
    fn noise(&self, pose: Pose, points: &[DVec3], run: &Run) -> Result<f64, Cancelled> {
        let mut sizes: Vec<f64> = self.residuals(pose, points, run)?.iter().map(|r| r.0.abs()).collect();
        Ok((NORMAL * median(&mut sizes)).max(1e-9 * self.size))
    }
}

/// Normal equations of a step, and what they would make smaller.
struct Normal {
    matrix: [[f64; PARAMETERS]; PARAMETERS],
    right: [f64; PARAMETERS],
    cost: f64,
}
