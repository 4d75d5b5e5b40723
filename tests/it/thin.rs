//! Cells that may hide a feature thinner than they are.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};
use rvachev::{
    Blend, Bounds, CellSize, Helix, MeshSettings, MinimalSurface, Polygon, Profile, SheetLattice, Solid, ThinFeatures,
};

use super::models;

fn unresolved(solid: &Solid, cell: CellSize, bounds: Option<Bounds>) -> usize {
    let settings = MeshSettings { cell, bounds, thin: ThinFeatures::Count, ..MeshSettings::default() };
    let count = solid.mesh(&settings).unwrap().check().unresolved_cells;
    count.expect("they were asked for")
}

#[test]
fn thin_walls_are_counted_and_refined() {
    const CELL: f64 = 0.125;
    // A wall of a third of a cell, between the nodes.
    let wall = Solid::cuboid((1.0, 1.0, 0.04)).translate(DVec3::Z * 0.1);
    let settings = |thin| MeshSettings { cell: CellSize::Length(CELL), thin, ..MeshSettings::default() };
    let report = |thin| wall.mesh(&settings(thin)).unwrap().check();
    assert_eq!(report(ThinFeatures::Ignore).unresolved_cells, None);
    assert!(report(ThinFeatures::Count).unresolved_cells.unwrap() > 0);
    let fine = report(ThinFeatures::Refine { halvings: 4 });
    assert_eq!((fine.unresolved_cells, fine.shells), (Some(0), 1));
    assert!((fine.volume / 0.04 - 1.0).abs() < 0.02, "{}", fine.volume);
}

#[test]
fn whatever_hides_between_nodes_is_counted() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let block = Solid::cuboid(DVec3::splat(2.0)).rotate(turn);
    let slit = Solid::cuboid((0.01, 3.0, 1.0)).rotate(turn);
    let cell = CellSize::Length(1.0 / 32.0);
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.01 };
    let thin = [
        ("a shell", block.shell(0.01)),
        ("a slit", &block - &slit),
        ("a slit in a bent body", (&block - &slit).bend(0.3, 0.0)),
        ("a needle", Solid::cone(0.01, 0.005, 1.0).rotate(turn)),
        ("a lattice", Solid::from(gyroid) & Solid::cuboid(DVec3::ONE)),
        ("a wire", Profile::circle(0.01).sweep_helix(&Helix::new(0.5, 0.3, 2.0))),
        (
            "a film between holes",
            &block - (Solid::sphere(0.5).translate(DVec3::X * 0.505) | Solid::sphere(0.5).translate(DVec3::X * -0.505)),
        ),
    ];
    for (name, solid) in thin {
        let count = unresolved(&solid, cell, None);
        assert!(count > 0, "{name}: {count}");
    }
}

#[test]
fn bodies_without_thin_parts_have_no_unresolved_cells() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let cube = Solid::cuboid(DVec3::splat(2.0));
    let bored = &cube - Solid::cylinder(0.5, 3.0);
    let (m2, m6) = (models::m2(), models::m6());
    let boss = cube.union_with(Solid::cylinder(0.6, 4.0), Blend::Fillet { radius: 0.2 });
    let thread = Profile::circle(0.08).sweep_helix(&Helix::new(0.3, 0.25, 2.5)) | Solid::cylinder(0.25, 1.4);
    let star = (0..10).map(|n| DVec2::from_angle(f64::from(n) * 0.2 * PI + 0.1) * if n % 2 == 0 { 1.0 } else { 0.5 });
    let bodies = [
        ("ball", Solid::sphere(1.0), 48, None),
        ("cube", cube.clone(), 48, None),
        ("turned cube", cube.rotate(turn), 48, None),
        ("bored cube", bored.clone(), 48, None),
        ("turned bored cube", bored.rotate(turn), 48, None),
        ("thick shell", cube.rotate(turn).shell(0.15), 64, None),
        ("M2", m2.solid.clone(), 64, Some(m2.cube())),
        ("M6", m6.solid.clone(), 64, Some(m6.cube())),
        ("boss", boss, 64, None),
        ("thread", thread, 128, None),
        ("star", Profile::from(Polygon::new([star])).extrude(0.5), 64, None),
    ];
    for (name, solid, cells, bounds) in bodies {
        let count = unresolved(&solid, CellSize::LongestSide(cells), bounds);
        assert_eq!(count, 0, "{name}");
    }
}
