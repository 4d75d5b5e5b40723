//! Points of a surface, cut into segments.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use rvachev_num::Meter;

use super::neighbours::Neighbours;
use super::sampling::spread;
use super::watershed::watershed;
use crate::fit::error::FitError;
use crate::geom::{Mesh, PointCloud};
use crate::{Angle, Run, deg};

/// Points that a mesh is sampled by, and points of a labelled segment at least.
const SAMPLES: usize = 6000;
const LEAST: usize = 300;

/// A cloud of points with a label for each: points of one label are of one leaf of a solid, or
/// of the wall of a hole in it.
///
/// ```
/// use rvachev::fit::Segments;
/// use rvachev::{CellSize, MeshSettings, Solid, deg};
///
/// let pin = Solid::cylinder(0.5, 2.0).translate([0.0, 0.0, 1.0]);
/// let part = Solid::cuboid([3.0, 2.0, 1.0]) | pin;
/// let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() })?;
/// let segments = Segments::of_mesh_by_creases(&mesh, deg(40.0))?;
/// assert_eq!(segments.count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Segments {
    cloud: PointCloud,
    labels: Vec<u32>,
}

impl Segments {
    /// A cloud with a label for each point.
    ///
    /// # Errors
    ///
    /// [`FitError::Labels`] if there are not as many labels as points.
    pub fn of_cloud(cloud: &PointCloud, labels: &[u32]) -> Result<Segments, FitError> {
        if labels.len() != cloud.len() {
            return Err(FitError::Labels { labels: labels.len(), count: cloud.len(), of: "points" });
        }
        Ok(Segments { cloud: cloud.clone(), labels: labels.to_vec() })
    }

    /// A mesh with a label for each triangle. Its surface is sampled by 6000 points, and by 300 of
    /// each label at least.
    ///
    /// # Errors
    ///
    /// [`FitError::Labels`] if there are not as many labels as triangles.
    pub fn of_mesh(mesh: &Mesh, labels: &[u32]) -> Result<Segments, FitError> {
        Segments::of_mesh_with(mesh, labels, &Run::default())
    }

    /// [`of_mesh`](Segments::of_mesh) with a cancel token and a progress sink; on one thread.
    ///
    /// # Errors
    ///
    /// Those of [`of_mesh`](Segments::of_mesh), and [`FitError::Cancelled`].
    pub fn of_mesh_with(mesh: &Mesh, labels: &[u32], run: &Run) -> Result<Segments, FitError> {
        let count = mesh.triangles().len();
        if labels.len() != count {
            return Err(FitError::Labels { labels: labels.len(), count, of: "triangles" });
        }
        let run = run.stage(0.0, 1.0);
        let mut named: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (t, name) in labels.iter().enumerate() {
            named.entry(*name).or_default().push(t);
        }
        let whole = mesh.area();
        let mut sampled = (Vec::new(), Vec::new(), Vec::new());
        let meter = Meter::new(&run, named.len());
        for (name, of) in named {
            meter.step()?;
            let area: f64 = of.iter().map(|t| area(mesh.corners(mesh.triangles()[*t]))).sum();
            let share = if whole > 0.0 { area / whole } else { 0.0 };
            for at in spread(mesh, &of, ((SAMPLES as f64 * share) as usize).max(LEAST)) {
                sampled.0.push(at.point);
                sampled.1.push(at.normal.as_vec3());
                sampled.2.push(name);
            }
        }
        run.report(1.0);
        Ok(Segments { cloud: oriented(sampled.0, sampled.1), labels: sampled.2 })
    }

    /// A mesh, cut where it turns inwards by more than an angle: see
    /// [`cloud_by_creases`](Segments::of_cloud_by_creases). Its surface is sampled by 6000 points.
    ///
    /// # Errors
    ///
    /// [`FitError::Setting`] if the angle is not within 1° to 90°.
    pub fn of_mesh_by_creases(mesh: &Mesh, crease: impl Into<Angle>) -> Result<Segments, FitError> {
        Segments::of_mesh_by_creases_with(mesh, crease, &Run::default())
    }

    /// [`of_mesh_by_creases`](Segments::of_mesh_by_creases) with a cancel token and a progress
    /// sink; on one thread.
    ///
    /// ```
    /// use rvachev::fit::Segments;
    /// use rvachev::{MeshSettings, Progress, Run, Solid, deg};
    ///
    /// let pair = Solid::cuboid([2.0, 2.0, 2.0]) | Solid::cuboid([1.0, 1.0, 3.0]).translate([0.0, 0.0, 1.0]);
    /// let mesh = pair.mesh(&MeshSettings::default())?;
    /// let progress = Some(Progress::new(|part| println!("{:.0} %", 100.0 * part)));
    /// let segments = Segments::of_mesh_by_creases_with(&mesh, deg(30.0), &Run { progress, ..Run::default() })?;
    /// assert_eq!(segments.count(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`of_mesh_by_creases`](Segments::of_mesh_by_creases), and [`FitError::Cancelled`].
    pub fn of_mesh_by_creases_with(mesh: &Mesh, crease: impl Into<Angle>, run: &Run) -> Result<Segments, FitError> {
        run.check()?;
        let all: Vec<usize> = (0..mesh.triangles().len()).collect();
        let sampled = spread(mesh, &all, SAMPLES);
        let points = sampled.iter().map(|s| s.point).collect();
        let normals = sampled.iter().map(|s| s.normal.as_vec3()).collect();
        Segments::of_cloud_by_creases_with(&oriented(points, normals), crease, run)
    }

    /// A cloud with normals, cut where its surface turns inwards by more than an angle from a point
    /// to the next; 40° is a good choice.
    ///
    /// A concave crease parts two convex leaves. It need not go all around: the surface is cut by a
    /// watershed of the distance from the creases, and what is convex together is joined again.
    /// What turns inwards within a few points, such as the wall of a small hole, looks like a
    /// crease. Segments of fewer than 60 points and flat ones join their neighbours.
    ///
    /// # Errors
    ///
    /// [`FitError::NoNormals`], and [`FitError::Setting`] if the angle is not within 1° to 90°.
    pub fn of_cloud_by_creases(cloud: &PointCloud, crease: impl Into<Angle>) -> Result<Segments, FitError> {
        Segments::of_cloud_by_creases_with(cloud, crease, &Run::default())
    }

    /// [`of_cloud_by_creases`](Segments::of_cloud_by_creases) with a cancel token and a progress
    /// sink; on one thread.
    ///
    /// # Errors
    ///
    /// Those of [`of_cloud_by_creases`](Segments::of_cloud_by_creases), and
    /// [`FitError::Cancelled`].
    pub fn of_cloud_by_creases_with(
        cloud: &PointCloud,
        crease: impl Into<Angle>,
        run: &Run,
    ) -> Result<Segments, FitError> {
        let crease = crease.into();
        if !(deg(1.0).radians()..=deg(90.0).radians() + 1e-12).contains(&crease.radians()) {
            let value = format!("{}°", crease.radians().to_degrees());
            return Err(FitError::Setting { setting: "crease", value, allowed: "1° to 90°" });
        }
        let Some(normals) = cloud.normals() else { return Err(FitError::NoNormals { points: cloud.len() }) };
        let normals: Vec<DVec3> = normals.iter().map(|n| n.as_dvec3().normalize_or_zero()).collect();
        let run = run.stage(0.0, 1.0);
        let [searching, flooding] = run.stages([1.0, 2.0]);
        let near = Neighbours::new(cloud.positions(), &searching)?;
        let labels = watershed(cloud.positions(), &normals, &near, crease.radians().cos(), &flooding)?;
        run.report(1.0);
        Ok(Segments { cloud: cloud.clone(), labels })
    }

    /// The points.
    #[must_use]
    pub fn cloud(&self) -> &PointCloud {
        &self.cloud
    }

    /// A label for each point.
    #[must_use]
    pub fn labels(&self) -> &[u32] {
        &self.labels
    }

    /// How many segments there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.names().len()
    }

    /// The labels, each once, from the least on.
    pub(super) fn names(&self) -> Vec<u32> {
        let mut names = self.labels.clone();
        names.sort_unstable();
        names.dedup();
        names
    }
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Points of a mesh and its facets' normals are finite, and as many.
fn oriented(points: Vec<DVec3>, normals: Vec<Vec3>) -> PointCloud {
    PointCloud::new(points).and_then(|cloud| cloud.with_normals(normals)).unwrap_or_default()
}
