//! Fine cells, and many parts.

use glam::{DAffine3, DQuat, DVec3};
use rvachev::{CellSize, Features, MeshSettings, MinimalSurface, RFunction, Run, SheetLattice, Solid};

use crate::measure::{Cost, measured};

/// Meshes and prints a row; gives the cost and the number of vertices.
fn row(name: &str, solid: &Solid, cells: u32, threads: usize) -> (Cost, usize) {
    let settings =
        MeshSettings { cell: CellSize::LongestSide(cells), features: Features::Smooth, ..MeshSettings::default() };
    let run = Run { threads, ..Run::default() };
    let (cost, mesh) = measured(threads, || solid.mesh_with(&settings, &run).expect("a mesh"));
    let (vertices, triangles) = (mesh.positions().len(), mesh.triangles().len());
    let rate = triangles as f64 / cost.seconds * 1e-6;
    println!(
        "{name} {cells}³ {threads} {:9.4} s {triangles:9} {rate:7.2} Mtri/s {:7.1} MB",
        cost.seconds, cost.megabytes
    );
    (cost, vertices)
}

/// Random superellipsoids, of a size such that their number fills a like part of the box.
fn crowd(count: usize) -> Solid {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let size = 0.5 * (1.0 / count as f64).cbrt();
    let part = |_| {
        let axes = DVec3::new(next(), next(), next()) * size + 0.5 * size;
        let (e1, e2) = (0.2 + 1.6 * next(), 0.2 + 1.6 * next());
        let turn = DQuat::from_euler(glam::EulerRot::ZYX, 6.3 * next(), 6.3 * next(), 6.3 * next());
        let at = DVec3::new(next(), next(), next());
        Solid::superellipsoid(axes, e1, e2).affine(DAffine3::from_rotation_translation(turn, at))
    };
    Solid::union_all((0..count).map(part), RFunction::MIN_MAX)
}

/// Prints the rows.
pub fn rows(threads: usize) {
    let sphere = Solid::sphere(1.0);
    let (fine, _) = row("sphere", &sphere, 1024, threads);
    let (finer, _) = row("sphere", &sphere, 2048, threads);
    println!(
        "       2048³ over 1024³: {:.2} times the time, {:.2} times the memory",
        finer.seconds / fine.seconds,
        finer.megabytes / fine.megabytes
    );
    let gyroid = Solid::new(SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.25, thickness: 0.03 })
        .intersection(Solid::sphere(1.0), RFunction::MIN_MAX);
    row("gyroid ball", &gyroid, 512, threads);
    let per_vertex = |(cost, vertices): (Cost, usize)| cost.seconds / vertices as f64;
    let few = per_vertex(row("union of 100", &crowd(100), 256, threads));
    let many = per_vertex(row("union of 10000", &crowd(10_000), 256, threads));
    println!("       10000 over 100: {:.2} times the time a vertex", many / few);
}
