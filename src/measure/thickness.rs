//! The thickness of a solid: the largest ball that touches the surface from inside.
//!
//! ```text
//!        n
//!        ↑
//!   -----p----------         The ball about c = p − r n touches at p. It begins too large, and
//!       /   \                shrinks to touch the points q that are found in it, until there
//!      |  c  |               are none.
//!       \   /
//!   -----q----------
//! ```
//!
//! Only what faces p counts, with a normal that is turned from n by 120° or more. Beside a convex
//! edge the largest ball is as small as the edge is near, and what meets there is no wall.
//!
//! Source: J. Ma et al., *3D Medial Axis Point Approximation Using Nearest Neighbors and the Normal
//! Field* (2012), section 3.

use glam::{DVec3, Vec3};
use rvachev_num::jobs;

use super::ThicknessReport;
use super::exact::{Triangles, facets};
use super::fine::Fine;
use crate::error::MeshingError;
use crate::mesh::{Slopes, each_triangle};
use crate::program::Program;
use crate::volume::Lattice;
use crate::{Bounds, Cancelled, Mesh, MeshSettings, Run, Solid};
use rvachev_field::{Patch, Walls};

/// The cosine between normals that face each other is less.
const FACING: f64 = -0.5;

/// What reaches into a ball by less than this part of its radius is not in it: all of a round
/// surface, seen from its middle, is at one distance but for its facets.
const SLACK: f64 = 2e-3;

/// A facet stands for the surface if the cosine between their normals is at least this.
const ALIKE: f64 = 0.95;

/// Triangles that are no wider than so many roundings have no normal.
const SLIVER: f64 = 64.0;

/// So many places are looked at between two looks at whether the run is cancelled.
const AT_ONCE: usize = 1 << 12;

/// Values that tell the surface's normal may be off by this part of the solid's size.
const PRECISION: f64 = 1e-5;

impl Solid {
    /// How thick the solid is, all over its surface: at each triangle of its mesh the diameter of
    /// the largest ball that touches the surface there from inside and holds nothing that faces it.
    /// `settings` are those of the mesh.
    ///
    /// ```
    /// use rvachev::{MeshSettings, Run, Solid};
    ///
    /// let pot = Solid::cylinder(10.0, 20.0) - Solid::cylinder(9.2, 20.0).translate([0.0, 0.0, 2.0]);
    /// let report = pot.thickness(&MeshSettings::default(), &Run::default())?;
    /// assert!((report.least - 0.8).abs() < 0.02 && report.at.z > -8.0);
    /// // Most of the surface is the wall's.
    /// assert!(report.share_below(1.0)? > 0.6 && report.share_below(0.5)? == 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Details
    ///
    /// Two normals face each other if they are 120° or more apart. Facets that are turned from the
    /// surface by more than 18°, as those that cut off corners where cells are too large, have no
    /// thickness. Balls are found to 0.2 %. The mesh's facets are off the surface by about h²/8R, h
    /// the side of a cell and R the radius of curvature, and so is each thickness. Features that
    /// the mesh has lost are not seen: see [`thin_features`](Solid::thin_features).
    ///
    /// [Meshes](Solid::from_mesh) that are closed and do not cross themselves are measured
    /// themselves, wherever they were moved to: the report's mesh is made of their triangles,
    /// divided to the size of a cell, and nothing is lost, however thin. Of an open mesh the film
    /// across the opening counts as surface.
    ///
    /// # Errors
    /// As for [`mesh`](Solid::mesh): what is wrong with the solid or the settings, or that the work
    /// was cancelled.
    pub fn thickness(&self, settings: &MeshSettings, run: &Run) -> Result<ThicknessReport, MeshingError> {
        let run = run.stage(0.0, 1.0);
        let [to_mesh, to_measure] = run.stages([0.4, 0.6]);
        let is_whole = settings.bounds.is_none() && !settings.owners;
        let facets = if is_whole { facets(self, &Run { progress: None, ..to_mesh.clone() })? } else { None };
        if let Some(facets) = facets {
            let step = Lattice::new(&self.finite_bounds()?, settings.cell)?.step();
            let fine = Fine::new(&facets.all, step, &to_mesh)?;
            let found = run.install(|| of_facets(&facets, &fine, &to_measure))?;
            run.report(1.0);
            return Ok(ThicknessReport::new(fine.mesh(), found));
        }
        let mesh = self.mesh_with(settings, &to_mesh)?;
        let program = self.surface_program()?;
        let found = run.install(|| thicknesses(&mesh, &program, &to_measure))?;
        run.report(1.0);
        Ok(ThicknessReport::new(mesh, found))
    }
}

/// The thickness in the middle of each part of triangles; infinite where nothing faces it, and of
/// slivers, whose normals are those of what was rounded.
fn of_facets(Triangles { all, rounding }: &Triangles, fine: &Fine, run: &Run) -> Result<Vec<f64>, Cancelled> {
    let [to_build, to_search] = run.stages([0.2, 0.8]);
    let normal = |[a, b, c]: &[DVec3; 3]| {
        let (across, side) = ((*b - *a).cross(*c - *a), a.distance(*b).max(b.distance(*c)).max(c.distance(*a)));
        (across.length() > SLIVER * rounding * side).then(|| across.normalize_or_zero())
    };
    let normals: Vec<Option<DVec3>> = all.iter().map(normal).collect();
    let kept = all.iter().zip(&normals).filter_map(|(own, normal)| Some((Patch::flat(*own), (*normal)?)));
    let walls = Walls::new(&kept.collect::<Vec<_>>(), &to_build)?;
    let largest = 0.5 * Bounds::from_points(all.iter().flatten().copied()).size().length();
    let middles = fine.middles();
    let parts: Vec<(DVec3, u32)> = middles.into_iter().zip(fine.parents.iter().copied()).collect();
    let mut found = Vec::with_capacity(parts.len());
    for some in parts.chunks(AT_ONCE) {
        to_search.check()?;
        to_search.report(found.len() as f64 / parts.len() as f64);
        let radius = |(p, parent): &(DVec3, u32)| walls.ball(*p, normals[*parent as usize]?, largest, SLACK, FACING);
        let thickness = |n: usize| radius(&some[n]).map_or(f64::INFINITY, |radius| 2.0 * radius);
        found.extend(jobs::in_order(some.len(), thickness));
    }
    Ok(found)
}

/// The thickness at the middle of each triangle; infinite where nothing faces it, of what has no
/// area, and of what does not stand for the surface.
fn thicknesses(mesh: &Mesh, program: &Program, run: &Run) -> Result<Vec<f64>, Cancelled> {
    let [to_ask, to_build, to_search] = run.stages([0.1, 0.2, 0.7]);
    let normals: Vec<DVec3> = (0..mesh.triangles().len()).map(|t| normal(mesh, t)).collect();
    let middle = |triangle: &[u32; 3]| mesh.corners(*triangle).into_iter().sum::<DVec3>() / 3.0;
    let middles: Vec<DVec3> = mesh.triangles().iter().map(middle).collect();
    let precision = PRECISION * mesh.bounds().size().length();
    let slopes = Slopes { program, precision, reach: precision }.at(&middles, &to_ask)?;
    // Where cells are too large, facets across creases cut off what they stand for: the surface
    // looks another way.
    let cuts: Vec<bool> =
        slopes.iter().zip(&normals).map(|(slope, normal)| slope.normal().dot(*normal) < ALIKE).collect();
    let corners = |t: usize| Patch::flat(mesh.corners(mesh.triangles()[t]));
    let all: Vec<(Patch, DVec3)> = (0..normals.len()).filter(|t| !cuts[*t]).map(|t| (corners(t), normals[t])).collect();
    let walls = Walls::new(&all, &to_build)?;
    let largest = 0.5 * mesh.bounds().size().length();
    each_triangle(mesh, &to_search, |nth, _| {
        let radius = if cuts[nth] { None } else { walls.ball(middles[nth], normals[nth], largest, SLACK, FACING) };
        radius.map_or(f64::INFINITY, |radius| 2.0 * radius)
    })
}

/// The normal at the middle of a triangle: between those of its corners, as slim facets are turned
/// from the surface; the facet's own where there are none.
fn normal(mesh: &Mesh, t: usize) -> DVec3 {
    let triangle = mesh.triangles()[t];
    let [a, b, c] = mesh.corners(triangle);
    let of_corners = match (mesh.corner_normals(), mesh.normals()) {
        (Some(normals), _) => Some(normals[t]),
        (None, Some(normals)) => Some(triangle.map(|v| normals[v as usize])),
        (None, None) => None,
    };
    let sum = of_corners.map(|normals| normals.into_iter().sum::<Vec3>().as_dvec3());
    sum.and_then(DVec3::try_normalize).unwrap_or_else(|| (b - a).cross(c - a).normalize_or_zero())
}
