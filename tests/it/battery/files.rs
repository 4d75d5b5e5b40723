//! Meshes of one solid, written and read back.

use std::path::PathBuf;

use glam::Vec3;
use rvachev::{Mesh, Run, Solid};

use super::make::bounded;
use super::shapes::meshed;
use super::short;
use super::{Fault, fault};

fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize])).collect()
}

pub fn check(solid: &Solid) -> Result<(), Fault> {
    let Some(solid) = &bounded(solid) else { return Ok(()) };
    let Some(mesh) = meshed(solid, 12, &Run { threads: 1, ..short() })? else { return Ok(()) };
    if mesh.triangles().is_empty() {
        return Ok(());
    }
    let mesh = mesh
        .painted(solid, [250, 250, 240].into())
        .map_err(|error| Fault { check: "mesh", text: error.to_string() })?;
    let report = mesh.check();
    let formats = ["stl", "obj", "ply", "glb", "3mf"];
    for format in &formats[..if cfg!(feature = "threemf") { 5 } else { 4 }] {
        let path: PathBuf = std::env::temp_dir().join(format!("rvachev-battery-{}.{format}", std::process::id()));
        let wrong = |text: String| Fault { check: "file", text: format!("{format}: {text}") };
        mesh.save(&path).map_err(|error| wrong(error.to_string()))?;
        let found = Mesh::load(&path);
        std::fs::remove_file(&path).map_err(|error| wrong(error.to_string()))?;
        let found = found.map_err(|error| wrong(error.to_string()))?;
        let again = found.check();
        fault("file", corners(&found) == corners(&mesh), || {
            format!("{format}: other triangles, {report} became {again}")
        })?;
        fault("file", again.is_sound() == report.is_sound(), || format!("{format}: {report} became {again}"))?;
    }
    Ok(())
}
