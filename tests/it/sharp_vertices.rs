//! Vertices of meshes with sharp features are on the surface, and narrow sides between two creases
//! are there.

use glam::DVec3;
use rvachev::{CellSize, Mesh, MeshSettings, Profile, Run, Solid, rad};

/// How far a vertex may be off the surface, in cells.
const OFF: f64 = 0.1;

fn mesh(solid: &Solid, cell: f64) -> Mesh {
    let settings = MeshSettings { cell: CellSize::Length(cell), ..MeshSettings::default() };
    let mesh = solid.mesh_with(&settings, &Run { threads: 1, ..Run::default() }).unwrap();
    let report = mesh.check();
    assert!(report.is_sound(), "{report:?}\n{solid}");
    mesh
}

/// The farthest that a vertex is off the surface by the field's value and slope, in cells, and how
/// many are off by more than [`OFF`].
fn worst(mesh: &Mesh, solid: &Solid, cell: f64) -> (f64, usize) {
    let program = solid.surface_program().unwrap();
    let (mut worst, mut count) = (0.0f64, 0);
    for position in mesh.positions() {
        let (value, gradient) = program.gradient(position.as_dvec3());
        let off = value.abs() / (cell * gradient.length());
        if off > OFF {
            count += 1;
        }
        worst = worst.max(off);
    }
    (worst, count)
}

/// A bar of ten whose cross-section is a trapezium with a side of `2 c` between two that lean by
/// 30°.
fn narrow_bar(c: f64) -> (Solid, f64) {
    let t = 30f64.to_radians().tan();
    let profile = Profile::polygon([[-1.5, -c - 1.5 * t], [0.0, -c], [0.0, c], [-1.5, c + 1.5 * t]]);
    let area = 1.5 * (2.0 * c + 1.5 * t);
    (profile.extrude(10.0).rotate_z(rad(0.3)).rotate_x(rad(0.2)).rotate_y(rad(0.4)), 10.0 * area)
}

#[test]
fn a_side_narrower_than_a_cell_is_there() {
    for c in [0.15625, 0.05, 0.1, 0.2, 0.24] {
        let (bar, volume) = narrow_bar(c);
        let mesh = mesh(&bar, 0.5);
        let (worst, count) = worst(&mesh, &bar, 0.5);
        let found = mesh.volume();
        println!("{c}: worst {worst:.3}, {count} off, volume {found:.4} for {volume:.4}");
        assert!(count == 0, "{c}: {count} vertices are off by up to {worst} cells");
        assert!((found / volume - 1.0).abs() < 5e-3, "{c}: {found}, not {volume}");
    }
}

/// A thread: a helical ridge with a flat crest narrower than a cell, on a core.
fn thread(cell: f64) -> (Solid, f64) {
    let profile = Profile::polygon([[8.0, -1.6], [10.0, -0.1], [10.0, 0.1], [8.0, 1.6]]);
    let rings = (0..4).map(|n| profile.revolve().translate(DVec3::Z * (4.0 * f64::from(n) - 6.0)));
    (rings.fold(Solid::cylinder(8.5, 16.0), |all, ring| all | ring).rotate_x(rad(0.3)), cell)
}

#[test]
fn crests_of_rings_do_not_stick_out() {
    let (solid, cell) = thread(0.5);
    let mesh = mesh(&solid, cell);
    let (worst, count) = worst(&mesh, &solid, cell);
    println!("worst {worst:.3}, {count} off of {}", mesh.positions().len());
    assert!(count == 0, "{count} vertices are off by up to {worst} cells");
}
