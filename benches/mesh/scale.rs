//! Fine cells, and many parts.

use glam::{DAffine3, DQuat, DVec3};
use rvachev::{CellSize, Features, Mesh, MeshSettings, MinimalSurface, RFunction, Run, SheetLattice, Solid};

use crate::measure::{Cost, InTurn, in_turn, measured};
use crate::memory::memory_apart;

/// What the memory of a row is asked for by, beside its name.
pub const SCALE: &str = "scale";

/// What meshes the solid of a row.
pub fn job(name: &str, cells: u32, threads: usize) -> impl FnMut() -> Mesh + Send {
    let solid = match name.strip_prefix("union of ").and_then(|count| count.parse().ok()) {
        Some(count) => crowd(count),
        None if name == "sphere" => Solid::sphere(1.0),
        None => Solid::new(SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.25, thickness: 0.03 })
            .intersection(Solid::sphere(1.0), RFunction::MIN_MAX),
    };
    let settings =
        MeshSettings { cell: CellSize::LongestSide(cells), features: Features::Smooth, ..MeshSettings::default() };
    let run = Run { threads, ..Run::default() };
    move || solid.mesh_with(&settings, &run).expect("a mesh")
}

/// Meshes and prints a row; gives the cost and the number of vertices.
fn row(name: &str, cells: u32, threads: usize) -> (Cost, usize) {
    let (seconds, mesh) = measured(threads, job(name, cells, threads));
    let (vertices, triangles) = (mesh.positions().len(), mesh.triangles().len());
    drop(mesh);
    let megabytes = memory_apart([SCALE, name, &cells.to_string(), &threads.to_string()]);
    let rate = triangles as f64 / seconds * 1e-6;
    println!("{name} {cells}³ {threads} {seconds:9.4} s {triangles:9} {rate:7.2} Mtri/s {megabytes:7.1} MB");
    (Cost { seconds, megabytes }, vertices)
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
    let (fine, _) = row("sphere", 1024, threads);
    let (finer, _) = row("sphere", 2048, threads);
    println!(
        "       2048³ over 1024³: {:.2} times the time, {:.2} times the memory",
        finer.seconds / fine.seconds,
        finer.megabytes / fine.megabytes
    );
    row("gyroid ball", 512, threads);
    let unions = ["union of 100", "union of 10000"];
    let [few, many] = unions.map(|name| row(name, 256, threads).1);
    // In turn, as the machine may be faster at one time than at another.
    let time = in_turn(threads, unions.map(|name| job(name, 256, threads))).ratio;
    println!("       10000 over 100: {:.2} times the time a vertex", time * few as f64 / many as f64);
}

/// Prints how many times faster two threads are than one, both run in turn.
pub fn gains() {
    for (name, cells) in [("sphere", 1024), ("gyroid ball", 512), ("union of 100", 256), ("union of 10000", 256)] {
        let InTurn { seconds: [two, one], ratio, .. } = in_turn(2, [2, 1].map(|threads| job(name, cells, threads)));
        println!("{name} {cells}³ on one thread {one:.4} s, on two {two:.4} s: {ratio:.2} times faster");
    }
}
