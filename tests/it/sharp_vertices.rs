//! Vertices of meshes with sharp features are on the surface, and narrow sides between two creases
//! are there.

use glam::{DQuat, DVec3, Vec3};
use rvachev::{CellSize, Helix, Mesh, MeshSettings, Profile, Run, Solid, rad};

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

/// Ridges with a flat crest narrower than a cell, on a core.
const RIDGE: [[f64; 2]; 4] = [[8.0, -1.6], [10.0, -0.1], [10.0, 0.1], [8.0, 1.6]];
const CREST: f64 = 10.0;

fn rings() -> Solid {
    let profile = Profile::polygon(RIDGE);
    let rings = (0..4).map(|n| profile.revolve().translate(DVec3::Z * (4.0 * f64::from(n) - 6.0)));
    rings.fold(Solid::cylinder(8.5, 16.0), |all, ring| all | ring)
}

fn thread(left_handed: bool) -> Solid {
    let profile = Profile::polygon(RIDGE.map(|[x, y]| [x - 8.0, y]));
    let helix = Helix { left_handed, ..Helix::new(8.0, 4.0, 3.0) };
    profile.sweep_helix(&helix) | Solid::cylinder(8.5, 16.0)
}

#[test]
fn crests_of_rings_and_threads_do_not_stick_out() {
    for (name, upright) in [("rings", rings()), ("thread", thread(false)), ("left-handed thread", thread(true))] {
        let solid = upright.rotate_x(rad(0.3));
        let mesh = mesh(&solid, 0.5);
        let (worst, count) = worst(&mesh, &solid, 0.5);
        let from_axis = |p: &Vec3| radius(DQuat::from_rotation_x(-0.3) * p.as_dvec3());
        let farthest = mesh.positions().iter().map(from_axis).fold(0.0, f64::max);
        println!("{name}: worst {worst:.3}, {count} off of {}, up to {farthest:.3}", mesh.positions().len());
        assert!(count == 0, "{name}: {count} vertices are off by up to {worst} cells");
        assert!((farthest - CREST).abs() < 0.5 * OFF, "{name}: {farthest} from the axis");
    }
}

/// How far a point is from the axis z.
fn radius(p: DVec3) -> f64 {
    p.truncate().length()
}
