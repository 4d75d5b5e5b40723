//! Whole parts from meshes: how long each stage of their recovery takes.

use std::path::Path;

use rvachev::fit::{PartSettings, part_with};
use rvachev::{Mesh, MeshSettings, Run, Solid};

/// Rounds of which the fastest counts.
const ROUNDS: usize = 3;

/// A part for all, and those of the folder of shared data where it is.
fn meshes() -> Result<Vec<(String, Mesh)>, Box<dyn std::error::Error>> {
    let holes = Solid::cylinder(3.5, 20.0).translate([22.0, 0.0, 0.0]).repeat_polar(6);
    let disc = Solid::cylinder(30.0, 8.0) | Solid::cylinder(12.0, 30.0).translate([0.0, 0.0, 15.0]);
    let flange = disc - Solid::cylinder(8.0, 80.0) - holes;
    let mut meshes = vec![("flange".to_owned(), flange.mesh(&MeshSettings::default())?)];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts");
    meshes.extend(loaded(&folder)?);
    Ok(meshes)
}

#[cfg(feature = "import")]
fn loaded(folder: &Path) -> Result<Vec<(String, Mesh)>, Box<dyn std::error::Error>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut files: Vec<_> = std::fs::read_dir(folder)?.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "ply"));
    files.sort();
    let name = |file: &Path| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    files.iter().map(|file| Ok((name(file), Mesh::load(file)?))).collect()
}

#[cfg(not(feature = "import"))]
fn loaded(_: &Path) -> Result<Vec<(String, Mesh)>, Box<dyn std::error::Error>> {
    Ok(Vec::new())
}

/// A row for each part that is asked for: milliseconds of its stages, and of all.
pub(crate) fn stages(is_asked: impl Fn(&str) -> bool) -> Result<(), Box<dyn std::error::Error>> {
    let run = Run { threads: 1, ..Run::default() };
    let mut heading = true;
    for (name, mesh) in meshes()? {
        if !is_asked("parts") && !is_asked(&name) {
            continue;
        }
        let mut best: Option<[(&str, f64); 9]> = None;
        for _ in 0..ROUNDS {
            let stages = part_with(&mesh, &PartSettings::default(), &run)?.times().stages();
            let sum = |stages: &[(&str, f64); 9]| stages.iter().map(|stage| stage.1).sum::<f64>();
            if best.as_ref().is_none_or(|best| sum(&stages) < sum(best)) {
                best = Some(stages);
            }
        }
        let Some(stages) = best else { continue };
        if std::mem::take(&mut heading) {
            let names: String = stages.iter().map(|(name, _)| format!(" {name:>10}")).collect();
            println!("{:24} {:>8}{names} {:>10}", "parts, ms", "facets", "all");
        }
        let times: String = stages.iter().map(|(_, time)| format!(" {:10.1}", 1e3 * time)).collect();
        let all = 1e3 * stages.iter().map(|(_, time)| time).sum::<f64>();
        println!("{name:24} {:8}{times} {all:10.1}", mesh.triangles().len());
    }
    Ok(())
}
