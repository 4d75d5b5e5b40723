//! The surface of a solid as patches.

use std::sync::Arc;

use glam::DVec3;

use super::compiled_with;
use super::facets::Facets;
use super::quilt::Quilt;
use super::slopes::Slopes;
use crate::error::MeshingError;
use crate::eval::{CompileError, Compiled, DistanceSource, Program, Surface};
use crate::mesh::Subject;
use crate::{Bounds, CellSize, Features, Mesh, MeshSettings, RFunction, Run, Solid, SolidError, ThinFeatures};
use rvachev_field::Patches;

/// The surfaces of solids by their meshes.
pub(super) struct FromMeshes;

/// Patches are off the surface by this part of the length at most, as far as they can be.
const TOLERANCE: f64 = 1e-3;

/// Cells along the longest side: at least, and at most where the length is short.
const COARSEST: f64 = 24.0;
const FINEST: f64 = 256.0;

/// Meshes whose surfaces are closer than this on average, in cells, are the same.
const SAME: f64 = 0.02;

/// Distances are asked up to so many lengths from a region.
const REACH: f64 = 2.0;

/// How often cells are halved where features are thinner.
const HALVINGS: u32 = 2;

impl DistanceSource for FromMeshes {
    fn surface(
        &self,
        solid: &Solid,
        programs: &Compiled,
        (length, region): (f64, &Bounds),
        run: &Run,
    ) -> Result<Surface, CompileError> {
        let whole = programs.bounds;
        let bounds = whole.intersection(&region.inflate(REACH * length));
        let flat = programs.flat_axis();
        let size = (0..3).filter(|axis| Some(*axis) != flat).map(|axis| bounds.size()[axis]).fold(0.0, f64::max);
        if bounds.is_empty() || size == 0.0 {
            let patches = Arc::new(Patches::new(&[], run)?);
            return Ok(Surface { patches, error: 0.0, flat });
        }
        if !size.is_finite() {
            return Err(SolidError::Unbounded { path: programs.unbounded.clone() }.into());
        }
        let cell = (size / COARSEST).min(length).max(size / FINEST);
        let tolerance = (TOLERANCE * length).max(1e-6 * size);
        let [to_mesh, to_sew] = run.stages([0.7, 0.3]);
        let facets = match flat {
            None if bounds.contains_bounds(&whole) => {
                Facets::new(&mesh(&programs.surface, bounds, cell, &to_mesh)?, |_| true)
            }
            None => part(solid, bounds, whole, cell, &to_mesh)?,
            Some(axis) => {
                let mut wall = bounds;
                (wall.min[axis], wall.max[axis]) = (-1.5 * cell, 1.5 * cell);
                part(solid, wall, whole, cell, &to_mesh)?
            }
        };
        let slopes = Slopes { program: &programs.surface, precision: tolerance };
        let quilt = Quilt::new(facets, &slopes, tolerance, &to_sew)?;
        let patches = Arc::new(Patches::new(&quilt.patches, &to_sew)?);
        Ok(Surface { patches, error: quilt.error, flat })
    }
}

/// The mesh of a program, its creases sharp, in smaller cells where that shows more.
fn mesh(program: &Program, bounds: Bounds, cell: f64, run: &Run) -> Result<Mesh, CompileError> {
    let mesh = mesh_in(program, bounds, cell, ThinFeatures::Ignore, run)?;
    if mesh.possibly_lost() == 0 {
        return Ok(mesh);
    }
    // Most often nothing is: flush faces and acute edges are suspect as well.
    let finer = mesh_in(program, bounds, cell, ThinFeatures::Refine { halvings: HALVINGS }, run)?;
    let [known, found] = [&mesh, &finer].map(Mesh::check);
    let is_same = (known.shells, known.euler_characteristic) == (found.shells, found.euler_characteristic)
        && (mesh.volume() - finer.volume()).abs() <= SAME * cell * mesh.area();
    Ok(if is_same { mesh } else { finer })
}

fn mesh_in(program: &Program, bounds: Bounds, cell: f64, thin: ThinFeatures, run: &Run) -> Result<Mesh, CompileError> {
    let settings =
        MeshSettings { cell: CellSize::Length(cell), features: Features::Sharp, thin, ..MeshSettings::default() };
    let subject = Subject { program, bounds, palette: None, whole: None };
    match run.install(|| subject.mesh(&settings, run)) {
        Ok(mesh) => Ok(mesh),
        Err(MeshingError::Solid(error)) => Err(error.into()),
        Err(MeshingError::Cancelled(cancelled)) => Err(cancelled.into()),
        Err(other) => Err(SolidError::Surface { reason: other.to_string() }.into()),
    }
}

/// The surface of a solid within a box, without the faces of the box.
fn part(solid: &Solid, clip: Bounds, whole: Bounds, cell: f64, run: &Run) -> Result<Facets, CompileError> {
    let knife = Solid::cuboid(clip.size()).translate(clip.center());
    let part = solid.intersection(knife, RFunction::MIN_MAX);
    let programs = compiled_with(&part, run)?;
    let bounds = programs.bounds.intersection(&clip);
    let mesh = if bounds.is_empty() { Mesh::default() } else { mesh(&programs.surface, bounds, cell, run)? };
    let is_cap = |corners: &[DVec3; 3]| {
        let on = |axis: usize, side: f64| corners.iter().all(|p| (p[axis] - side).abs() < 1e-3 * cell);
        (0..3).any(|axis| {
            clip.min[axis] > whole.min[axis] && on(axis, clip.min[axis])
                || clip.max[axis] < whole.max[axis] && on(axis, clip.max[axis])
        })
    };
    Ok(Facets::new(&mesh, |corners| !is_cap(corners)))
}
