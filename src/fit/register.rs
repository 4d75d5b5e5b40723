//! The pose of a scan of a known solid.
//!
//! ```text
//!     scan point = s·R·(model point) + t        residual d at q = Rᵀ(p − t)/s, n its gradient there
//!     by a turn ω about the model's axes  −n·(ω × q)     a shift  −n     ln s  −n·q
//! ```
//!
//! d is f/|∇f|, for the last steps the distance to where Newton steps lead, or the field of
//! equation 15. From 24 rotations of the principal axes, Gauss–Newton steps with weights 1/(1 +
//! (d/σ)²)² whose σ falls from .6 of the size: at first all points pull, at last those that fit. If
//! that leaves more noise than neighbourhoods have, a coarse search over all other rotations and
//! places follows.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::align::{Align, CLOSE, PARAMETERS, Pose, Residual};
use super::check::{check_depth, check_extent};
use super::cost::Cost;
use super::covariance::Covariance;
use super::density::dense;
use super::error::FitError;
use super::linear::{Principal, median};
use super::local::local;
use super::random::Random;
use super::weighted::Weighted;
use crate::distance::compiled_with;
use crate::eval::Program;
use crate::geom::PointCloud;
use crate::{Cancelled, CellSize, MeshSettings, Run, Solid};
use rvachev_num::{jobs, order};

const NAMES: [&str; PARAMETERS] = ["turn x", "turn y", "turn z", "shift x", "shift y", "shift z", "ln scale"];

/// Points of the search, so few that they are one task, and of the last steps.
const FEW: usize = 250;
const MORE: usize = 1500;

/// Poses of a coarse search, how far from the scan's middle they are, in sizes of the model, how
/// many such searches there are at most, and their points.
const COARSE: usize = 96;
const ASIDE: f64 = 0.5;
const SEARCHES: usize = 4;
const FEWER: usize = 120;

/// A pose is as good as the noise where its deviation is below this times that of local planes.
const GOOD: f64 = 1.1;

/// Planes are told from each other down to this part of the size.
const ROUGHNESS: f64 = 1e-8;

/// How many of all starts are taken further, and of these again.
const KEPT: [usize; 2] = [12, 4];

/// σ of the first step, in sizes of the model, and what it falls by from step to step.
const WIDE: f64 = 0.6;
const FALL: f64 = 0.7;

/// How a scan is registered. `..RegisterSettings::default()` keeps what is not named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct RegisterSettings {
    /// What random choices are made from. Default: 0.
    pub seed: u64,
    /// Whether the scan may be larger or smaller than the solid. Default: no.
    pub scale: bool,
    /// What is minimised: [`Cost::Normal`], the distance, which is the default (to first order in
    /// the search, to the foot of each point in the last steps); or [`Cost::Eq15`], the published
    /// field, for comparisons. Its parts are the operands of unions, weighted by the semi-axes of
    /// their leaves: of a superellipsoid or supershape its own, of others half the sides of their
    /// boxes. It is not the distance, and a worse judge of poses; points far from the surface count
    /// less and less with either.
    pub cost: Cost,
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
    /// The standard deviation of the points that fit, in length units of the scan. By
    /// [`Cost::Eq15`] it is that of the field over its steepness, which cannot be compared with
    /// `roughness`.
    pub noise: f64,
    /// The standard deviation of the scan's dense points from planes through their neighbours, in
    /// length units of the scan: it has the noise in it, and some curvature. Where `noise` is well
    /// above it, the pose is wrong.
    pub roughness: f64,
    /// The mean of d²/(d² + σ²) over the points, σ being 2 % of the solid's size: near 0 where all
    /// fit closely.
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
/// The part of the scan that is of the solid should be 60 % or more. It may show one side of it
/// only, if that side tells it: how often it does is [in a table](super#registration). A solid that
/// looks the same from several sides is found in any of these poses. A failure is told by
/// [`Registration::noise`], which then is above 1.1 times [`Registration::roughness`].
///
/// # Errors
///
/// [`FitError::Solid`] if the solid is not valid or unbounded, [`FitError::TooFew`],
/// [`FitError::Flat`] and [`FitError::Extent`] of the points, and [`FitError::Setting`].
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
    if !matches!(settings.cost, Cost::Normal | Cost::Eq15) {
        let (setting, value) = ("cost", format!("{:?}", settings.cost));
        return Err(FitError::Setting { setting, value, allowed: "Normal, Eq15" });
    }
    let needed = 2 * PARAMETERS + 2;
    if cloud.len() < needed {
        let kind = "pose";
        return Err(FitError::TooFew { kind, points: cloud.len(), parameters: PARAMETERS, needed });
    }
    check_extent(cloud)?;
    check_depth(cloud.positions())?;
    let quiet = Run { progress: None, ..run.clone() };
    let programs = compiled_with(solid, &quiet)?;
    let weighted = if settings.cost == Cost::Eq15 { Some(Weighted::of(solid, &quiet)?) } else { None };
    let model = Model::of(&programs.surface, weighted, solid, settings.scale, &run)?;
    run.install(|| model.register(cloud, settings, &run))
}

/// The solid with the frame of its surface.
struct Model<'a> {
    program: &'a Program,
    /// The field of equation 15, if that is asked for, and how steep it is at the surface.
    weighted: Option<(Weighted, f64)>,
    frame: Principal,
    size: f64,
    scale: bool,
}

impl Model<'_> {
    fn of<'a>(
        program: &'a Program,
        weighted: Option<Weighted>,
        solid: &Solid,
        scale: bool,
        run: &Run,
    ) -> Result<Model<'a>, FitError> {
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
        let weighted = match weighted {
            Some(field) => {
                let slopes = field.at(&middles, &quiet)?;
                let mut steep: Vec<f64> = slopes.iter().map(|slope| slope.gradient.length()).collect();
                Some((field, median(&mut steep).max(f64::MIN_POSITIVE)))
            }
            None => None,
        };
        let frame = Principal::of(middles.iter().copied());
        let size = frame.variances.iter().sum::<f64>().sqrt();
        Ok(Model { program, weighted, frame, size, scale })
    }

    /// Points against the solid, as the search sees them, or as the last steps do.
    fn align<'a>(&'a self, points: &'a [DVec3], is_last: bool) -> Align<'a> {
        let residual = match &self.weighted {
            Some((field, steepness)) => Residual::Weighted(field, *steepness),
            None if is_last => Residual::Foot(self.program),
            None => Residual::Slope(self.program),
        };
        Align { residual, points, size: self.size, scale: self.scale }
    }

    fn register(&self, cloud: &PointCloud, settings: &RegisterSettings, run: &Run) -> Result<Registration, FitError> {
        let mut random = Random::new(settings.seed);
        let all = cloud.positions();
        let more: Vec<DVec3> = random.chosen(all.len(), MORE).into_iter().map(|i| all[i]).collect();
        let dense: Vec<DVec3> = dense(&more).kept.iter().map(|i| more[*i]).collect();
        let frame = Principal::of(dense.iter().copied());
        // Exact points of a plane have none, and residuals are not below rounding.
        let least = ROUGHNESS * frame.variances.iter().sum::<f64>().sqrt();
        let roughness = local(&dense, None, &mut random).rough.max(least);
        let (last, on) = (self.align(&more, true), self.align(&dense, true));
        let mut pose = self.search(self.starts(&frame), &more, run)?;
        let mut noise = on.noise(pose, run)?;
        for search in 0..SEARCHES {
            run.report(0.4 + 0.6 * search as f64 / SEARCHES as f64);
            // The published field is no length: it cannot be compared.
            if self.weighted.is_some() || noise * pose.scale <= GOOD * roughness {
                break;
            }
            let other = self.search(self.coarse(&frame, &mut random), &more, run)?;
            if last.cost(other, run)? < last.cost(pose, run)? {
                (pose, noise) = (other, on.noise(other, run)?);
            }
        }
        let cost = last.cost(pose, run)?;
        let normal = last.normal(pose, 3.0 * noise, run)?;
        let units = std::array::from_fn(|_| 1.0);
        let share = all.len() as f64 / more.len() as f64;
        let covariance = Covariance::from_normal(NAMES, &normal.matrix, noise, share, units);
        run.report(1.0);
        Ok(Registration {
            rotation: DQuat::from_mat3(&pose.rotation).normalize(),
            translation: pose.translation,
            scale: pose.scale,
            noise: noise * pose.scale,
            roughness,
            cost,
            covariance,
        })
    }

    /// The best of many starts, taken down to the noise.
    fn search(&self, mut poses: Vec<Pose>, points: &[DVec3], run: &Run) -> Result<Pose, Cancelled> {
        let (few, fewer) = (&points[..points.len().min(FEW)], &points[..points.len().min(FEWER)]);
        let rounds = [(fewer, WIDE, 8), (few, WIDE * FALL.powi(4), 6), (few, WIDE * FALL.powi(5), 8)];
        for (round, (some, width, steps)) in rounds.into_iter().enumerate() {
            let align = self.align(some, false);
            let mut found = jobs::try_in_order(poses.len(), |n| {
                let pose = align.descend(poses[n], self.widths(width, steps), run)?;
                Ok((align.cost(pose, run)?, pose))
            })?;
            order::rising(&mut found, |a| a.0);
            found.truncate(KEPT.get(round).copied().unwrap_or(1));
            poses = found.into_iter().map(|(_, pose)| pose).collect();
        }
        // From as wide as the residuals that are told apart down to the noise.
        let mut pose = self.align(points, false).descend(poses[0], self.widths(2.0 * CLOSE, 3), run)?;
        let last = self.align(points, true);
        for _ in 0..4 {
            let width = 3.0 * last.noise(pose, run)?;
            pose = last.descend(pose, std::iter::once(width), run)?;
        }
        Ok(pose)
    }

    fn widths(&self, from: f64, steps: i32) -> impl Iterator<Item = f64> + '_ {
        (0..steps).map(move |i| from * FALL.powi(i) * self.size)
    }

    /// A pose that brings the solid's middle to that of the scan's dense points, moved from there.
    fn start(&self, frame: &Principal, rotation: DMat3, aside: DVec3) -> Pose {
        let scale = if self.scale { frame.variances.iter().sum::<f64>().sqrt() / self.size } else { 1.0 };
        let translation = frame.mean - rotation * (self.frame.mean + aside * self.size) * scale;
        Pose { rotation, translation, scale }
    }

    /// The 24 rotations of the principal axes of the scan to those of the solid.
    fn starts(&self, frame: &Principal) -> Vec<Pose> {
        let mut starts = Vec::new();
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            for signs in 0..4 {
                let sign = |bit: i32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let (x, y) = (frame.axes.col(i) * sign(0), frame.axes.col(j) * sign(1));
                let z = x.cross(y);
                debug_assert!(z.dot(frame.axes.col(k)).abs() > 0.9);
                let rotation = DMat3::from_cols(x, y, z) * self.frame.axes.transpose();
                starts.push(self.start(frame, rotation, DVec3::ZERO));
            }
        }
        starts
    }

    /// Random poses: what is seen of a part has its middle elsewhere, and other principal axes.
    fn coarse(&self, frame: &Principal, random: &mut Random) -> Vec<Pose> {
        let pose = |_| {
            let rotation = DMat3::from_quat(random.rotation());
            let aside = DMat3::from_quat(random.rotation()) * DVec3::Z * (ASIDE * random.unit());
            self.start(frame, rotation, aside)
        };
        (0..COARSE).map(pose).collect()
    }
}
