//! Long work tells how far it has come as it goes on, not stage by stage.

use std::sync::{Arc, Mutex};

use rvachev::{
    Camera, CellSize, ContourSettings, Mesh, MeshSettings, MeshSolid, Plane, Progress, Quality, RenderSettings, Run,
    Solid, Style, deg,
};

/// A run, and what it reports.
pub fn recorded() -> (Run, Arc<Mutex<Vec<f64>>>) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = seen.clone();
    let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
    (Run { threads: 2, progress, ..Run::default() }, seen)
}

/// Checks that the reports rise from about 0 to 1 in many small steps.
pub fn flows(what: &str, seen: &Mutex<Vec<f64>>, least: usize, widest: f64) {
    let seen = seen.lock().unwrap();
    assert!(seen.windows(2).all(|pair| pair[0] < pair[1]), "{what}: {seen:?}");
    assert_eq!(seen.last(), Some(&1.0), "{what}");
    let gap = [0.0].iter().chain(&seen[..]).zip(&seen[..]).map(|(a, b)| b - a).fold(0.0, f64::max);
    assert!(seen.len() >= least && gap <= widest, "{what}: {} reports, {gap:.3} at once", seen.len());
}

pub fn part() -> Solid {
    let holes = Solid::cylinder(0.3, 4.0).translate([1.5, 0.0, 0.0]).repeat_polar(6);
    (Solid::superellipsoid([2.5, 2.5, 0.7], 0.4, 1.0) | Solid::torus(1.8, 0.4)) - holes
}

#[test]
fn pictures_tell_how_far_they_are() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let base = RenderSettings { width: 240, height: 180, ..RenderSettings::default() };
    let looks = [
        base.clone(),
        RenderSettings { softness: deg(0.0), ..base.clone() },
        RenderSettings { shadows: false, occlusion: false, samples: 1, ..base.clone() },
        RenderSettings { style: Style::Technical, ..base.clone() },
        RenderSettings { cut: Some(Plane::xz(0.0)), ..base.clone() },
    ];
    for (number, settings) in looks.iter().enumerate() {
        // What the pixels saw before is kept.
        let scene = part().scene().unwrap();
        let (run, seen) = recorded();
        scene.render_with(&camera, settings, &run).unwrap();
        flows(&format!("picture {number}"), &seen, 40, 0.3);
    }
    let (run, seen) = recorded();
    part().render_with(&camera, &base, &run).unwrap();
    flows("picture of a solid", &seen, 40, 0.3);
    // A draft is drawn in no time, once it has its mesh.
    let (run, seen) = recorded();
    scene.render_with(&camera, &RenderSettings { quality: Quality::Draft, ..base }, &run).unwrap();
    flows("first draft", &seen, 40, 0.6);
}

#[test]
fn meshes_tell_how_far_they_are() {
    let (run, seen) = recorded();
    part().mesh_with(&MeshSettings { cell: CellSize::LongestSide(96), ..MeshSettings::default() }, &run).unwrap();
    flows("mesh", &seen, 60, 0.12);
    let (run, seen) = recorded();
    part().mesh_with(&MeshSettings { cell: CellSize::Tolerance(0.01), ..MeshSettings::default() }, &run).unwrap();
    flows("mesh within a tolerance", &seen, 60, 0.18);
    let (run, seen) = recorded();
    let settings = ContourSettings::default();
    part().slices(&[-0.3, -0.1, 0.0, 0.1, 0.3, 0.4], &settings, &run).unwrap();
    flows("slices", &seen, 20, 0.25);
}

#[test]
fn turntables_tell_how_far_they_are() {
    const FRAMES: u32 = 8;
    let (whole, seen) = recorded();
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let settings = RenderSettings { width: 120, height: 90, ..RenderSettings::default() };
    for frame in 0..FRAMES {
        let part = |frame: u32| f64::from(frame) / f64::from(FRAMES);
        let run = whole.stage(part(frame), part(frame + 1));
        scene.render_with(&camera.orbit(deg(360.0 * part(frame)), deg(0.0)), &settings, &run).unwrap();
    }
    flows("turntable", &seen, 150, 0.03);
}

#[test]
fn clearances_and_imports_tell_how_far_they_are() {
    // An even gap, an overlap, and what crosses.
    let bore = Solid::cuboid([12.0, 12.0, 8.0]) - Solid::cylinder(3.1, 10.0);
    for (name, by) in [("gap", 0.0), ("overlap", 0.4)] {
        let (run, seen) = recorded();
        Solid::cylinder(3.0, 9.0).translate([by, 0.0, 0.0]).clearance(&bore, &run).unwrap();
        flows(name, &seen, 40, 0.25);
    }
    // A sphere with a hole, whose rim is closed; one run for two jobs.
    let mesh = Solid::sphere(1.0).mesh(&MeshSettings { cell: CellSize::Length(0.02), ..MeshSettings::default() });
    let mesh = mesh.unwrap();
    let open = mesh.triangles().iter().copied().filter(|t| mesh.positions()[t[0] as usize].z < 0.7).collect();
    let open = Mesh::new(mesh.positions().to_vec(), open).unwrap();
    let (run, seen) = recorded();
    for _ in 0..2 {
        seen.lock().unwrap().clear();
        Solid::from_mesh_with(&open, MeshSolid::default(), &run).unwrap();
        flows("import", &seen, 20, 0.25);
    }
}
