//! probe
#[path = "../tests/it/models.rs"]
mod models;
use rvachev::*;
fn show(name: &str, solid: &Solid, cell: CellSize, bounds: Option<Bounds>) {
    let t = std::time::Instant::now();
    let m = solid.mesh(&MeshSettings { cell, bounds, ..Default::default() }).unwrap();
    println!(
        "{name} {cell:?}: lost {} tris {} {:.4} s",
        m.possibly_lost(),
        m.triangles().len(),
        t.elapsed().as_secs_f64()
    );
}
fn main() {
    for cells in [40, 64, 100, 128, 256] {
        for m in models::all() {
            show(m.name, &m.solid, CellSize::Length(2.0 * m.half / f64::from(cells)), Some(m.cube()));
        }
    }
    let plate = Solid::cuboid([2.0, 2.0, 0.5]).translate([0.0, 0.0, -0.25]);
    let fin = Solid::cuboid([0.02, 1.4, 0.8]).translate([0.003, 0.0, 0.0]);
    show("fin", &(&plate | &fin), CellSize::Length(1.0 / 16.0), None);
    show("slot", &(&plate - &fin), CellSize::Length(1.0 / 16.0), None);
    let block = Solid::cuboid([2.0; 3]);
    show(
        "film",
        &(&block
            - (Solid::sphere(0.5).translate([0.505, 0.0, 0.0]) | Solid::sphere(0.5).translate([-0.505, 0.0, 0.0]))),
        CellSize::Length(1.0 / 32.0),
        None,
    );
    show("slit bent", &(&block - Solid::cuboid([0.01, 3.0, 1.0])).bend(0.3, 0.0), CellSize::Length(1.0 / 32.0), None);
    show("thick", &Solid::cuboid([32.0, 32.0, 8.0]), CellSize::Length(2.0), None);
    for t in [0.1, 0.3, 0.6] {
        show("wall", &(Solid::sphere(1.0) - Solid::sphere(1.0 - t / 32.0)), CellSize::Length(1.0 / 32.0), None);
    }
    let holes = Solid::cuboid([320.0, 320.0, 8.0])
        - Solid::cylinder(2.5, 50.0).repeat([20, 20, 1], [15.0, 15.0, 1.0]).translate([-142.5, -142.5, 0.0]);
    show("D4", &holes, CellSize::Length(7.8), None);
    show("D4 fine", &holes, CellSize::Length(1.0), None);
    show("needle", &Solid::cone(0.5, 0.0, 100.0), CellSize::LongestSide(128), None);
    show("sheet", &Solid::cuboid([1.0, 1.0, 0.0025]), CellSize::LongestSide(128), None);
    let b = Solid::cuboid([2.0; 3]);
    show(
        "boss",
        &b.union_with(Solid::cylinder(0.6, 4.0), Blend::Fillet { radius: 0.2 }),
        CellSize::LongestSide(64),
        None,
    );
    show("shell", &b.rotate_x(0.3).shell(0.15), CellSize::LongestSide(64), None);
}
