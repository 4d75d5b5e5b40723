//! Cells that may hide a feature thinner than they are.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};
use rvachev::{
    Blend, Bounds, CancelToken, Cancelled, CellSize, Features, Helix, MeshSettings, MeshSolid, MinimalSurface, Polygon,
    Profile, Run, SheetLattice, Solid, ThinFeatures, ThinReport, deg, error::MeshingError, rad,
};

use super::models;
use crate::support::Random;

fn unresolved(solid: &Solid, cell: CellSize, bounds: Option<Bounds>) -> usize {
    let settings = MeshSettings { cell, bounds, ..MeshSettings::default() };
    solid.thin_features(&settings, &Run::default()).unwrap().cells
}

fn lost(solid: &Solid, cell: CellSize, bounds: Option<Bounds>) -> usize {
    solid.mesh(&MeshSettings { cell, bounds, ..MeshSettings::default() }).unwrap().possibly_lost()
}

#[test]
fn thin_walls_are_counted_and_refined() {
    const CELL: f64 = 0.125;
    // A wall of a third of a cell, between the nodes.
    let wall = Solid::cuboid((1.0, 1.0, 0.04)).translate(DVec3::Z * 0.1);
    let settings = |thin| MeshSettings { cell: CellSize::Length(CELL), thin, ..MeshSettings::default() };
    let mesh = |thin| wall.mesh(&settings(thin)).unwrap();
    let ignored = mesh(ThinFeatures::Ignore);
    assert!(ignored.thin_features().is_none() && ignored.possibly_lost() > 0 && ignored.warnings().len() == 1);
    let counted = mesh(ThinFeatures::Count);
    let thin = counted.thin_features().expect("they were searched for");
    assert_eq!(thin, &wall.thin_features(&settings(ThinFeatures::Ignore), &Run::default()).unwrap());
    assert!(thin.cells > 0 && thin.count == 1 && counted.warnings().len() == 2);
    assert!((thin.places[0].thickness.unwrap() - 0.04).abs() < 1e-6, "{thin}");
    let fine = mesh(ThinFeatures::Refine { halvings: 4 });
    assert!(fine.possibly_lost() == 0 && fine.warnings().is_empty());
    let fine = fine.check();
    assert_eq!(fine.shells, 1);
    assert!((fine.volume / 0.04 - 1.0).abs() < 0.02, "{}", fine.volume);
}

/// Smaller cells are where they are needed, and the mesh is whole across the seam.
#[test]
fn cells_are_halved_where_they_are_unresolved() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let fin = Solid::cuboid((0.03, 0.8, 0.8)).translate(DVec3::Z * 1.3);
    let whole = (Solid::cuboid(DVec3::splat(2.0)) | fin).rotate(turn);
    let volume = 8.0 + 0.03 * 0.8 * 0.7;
    for features in [Features::Smooth, Features::Sharp] {
        let mesh = |cells: u32, thin| {
            let cell = CellSize::LongestSide(cells);
            whole.mesh(&MeshSettings { cell, features, thin, ..MeshSettings::default() }).unwrap()
        };
        let [coarse, fine] = [48, 192].map(|cells| mesh(cells, ThinFeatures::Ignore).triangles().len());
        let refined = mesh(48, ThinFeatures::Refine { halvings: 2 });
        let report = refined.check();
        assert!(report.is_sound() && report.shells == 1, "{report}");
        let count = refined.triangles().len();
        assert!(coarse < count && 4 * count < fine, "{features:?}: {coarse}, {count}, {fine}");
        let slack = if features == Features::Sharp { 2e-5 } else { 2e-3 };
        assert!((report.volume / volume - 1.0).abs() < slack, "{features:?}: {}", report.volume);
        // What has no thin parts is as it is.
        let plain = Solid::cuboid(DVec3::splat(2.0)).rotate(turn);
        let settings =
            |thin| MeshSettings { cell: CellSize::LongestSide(48), features, thin, ..MeshSettings::default() };
        let [plain, halved] =
            [ThinFeatures::Ignore, ThinFeatures::Refine { halvings: 2 }].map(|thin| plain.mesh(&settings(thin)));
        assert!(plain.unwrap() == halved.unwrap());
    }
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
        ("a slit in a bent body", (&block - &slit).bend(0.3, deg(0.0))),
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
        assert!(lost(&solid, cell, None) > 0, "{name}");
    }
}

/// Blocks in which something is seen are looked at as well, where they are away from it.
#[test]
fn what_hides_beside_what_is_seen_is_counted() {
    const CELL: f64 = 1.0 / 16.0;
    let settings = MeshSettings { cell: CellSize::Length(CELL), ..MeshSettings::default() };
    let plate = Solid::cuboid(DVec3::new(1.0, 1.0, 0.5)) | Solid::cuboid(DVec3::new(0.2, 0.2, 1.5));
    assert_eq!(plate.mesh(&settings).unwrap().possibly_lost(), 0);
    let ball = |x: f64| Solid::sphere(1.2 * CELL).translate(DVec3::X * x * CELL);
    let lens = ball(1.0) & ball(-1.0);
    let (mut hidden, mut told) = (0, 0);
    for n in 0..64 {
        // Some cells above the plate, anywhere between the nodes.
        let part = DVec3::new(f64::from(n % 4), f64::from(n / 4 % 4), f64::from(n / 16)) / 4.0;
        let place = (DVec3::splat(5.0) + part) * CELL + DVec3::Z * 0.25;
        let mesh = (&plate | lens.translate(place)).mesh(&settings).unwrap();
        if mesh.check().shells == 1 {
            hidden += 1;
            told += usize::from(mesh.possibly_lost() > 0);
        }
    }
    assert!(hidden > 10 && told == hidden, "{told} of {hidden}");
}

/// Rods like stars pass between nodes, some of them a cell and a half from others that are seen: their
/// values rise steeply near their arms alone, whose sides are far from opposite.
#[test]
fn rods_beside_others_that_are_seen_are_counted() {
    let rod = Solid::superellipsoid([0.458_549, 0.617_185, 3.0], 0.582_691, 2.979_119);
    let rods = rod.translate([-1.0, 0.25, -0.25]).repeat([4, 4, 4], [1.25, 4.0, 5.0]);
    for (cells, shells, is_told) in [(12, 1, true), (16, 6, true), (20, 7, true), (24, 7, true), (64, 16, false)] {
        let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
        let mesh = rods.mesh(&settings).unwrap();
        assert_eq!(mesh.check().shells, shells, "at {cells} cells");
        assert_eq!(mesh.possibly_lost() > 0, is_told, "at {cells} cells");
    }
}

/// A fin with a draft is thicker below than above: along it the solid is entered once, and it
/// passes between the nodes.
#[test]
fn fins_and_slots_with_a_draft_are_counted() {
    let drafted = |angle: f64| {
        let top = DVec3::Z * 0.4;
        let side = |x: f64| {
            let normal = DVec3::new(x * angle.cos(), 0.0, angle.sin());
            Solid::half_space(normal, normal.dot(top + DVec3::X * x * 0.01))
        };
        Solid::cuboid((2.0, 2.0, 0.8)) & side(1.0) & side(-1.0)
    };
    let plate = Solid::cuboid((2.0, 2.0, 0.5)).translate(DVec3::Z * -0.25);
    for degrees in [0.0_f64, 0.1, 0.5, 1.0] {
        let fin = (drafted(degrees.to_radians()) & Solid::cuboid((2.0, 1.4, 2.0))).translate(DVec3::X * 0.003);
        for (name, solid) in [("fin", &plate | &fin), ("slot", &plate - fin.rotate_x(deg(180.0)))] {
            let count = unresolved(&solid, CellSize::Length(1.0 / 16.0), None);
            assert!(count > 100, "a {name} of {degrees} degrees: {count}");
        }
    }
    // Nothing but bounds.
    let beyond = Bounds::new(DVec3::splat(5.0), DVec3::splat(6.0));
    assert_eq!(unresolved(&plate, CellSize::LongestSide(8), Some(beyond)), 0);
}

#[test]
fn bodies_without_thin_parts_have_no_unresolved_cells() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let cube = Solid::cuboid(DVec3::splat(2.0));
    let bored = &cube - Solid::cylinder(0.5, 3.0);
    let (m2, m6) = (models::m2(), models::m6());
    let boss = cube.union_with(Solid::cylinder(0.6, 4.0), Blend::Fillet { radius: 0.2 });
    let chamfered = cube.union_with(Solid::cylinder(0.6, 4.0), Blend::Chamfer { leg: 0.14 });
    let thread = Profile::circle(0.08).sweep_helix(&Helix::new(0.3, 0.25, 2.5)) | Solid::cylinder(0.25, 1.4);
    let star = (0..10).map(|n| DVec2::from_angle(f64::from(n) * 0.2 * PI + 0.1) * if n % 2 == 0 { 1.0 } else { 0.5 });
    let room = thread.finite_bounds().unwrap();
    let bodies = [
        ("ball", Solid::sphere(1.0), 48, None),
        ("cube", cube.clone(), 48, None),
        ("turned cube", cube.rotate(turn), 48, None),
        ("bored cube", bored.clone(), 48, None),
        ("turned bored cube", bored.rotate(turn), 48, None),
        ("thick shell", cube.rotate(turn).shell(0.15), 64, None),
        ("star", Profile::from(Polygon::new([star])).extrude(0.5), 64, None),
    ];
    for (name, solid, cells, bounds) in bodies {
        let count = unresolved(&solid, CellSize::LongestSide(cells), bounds);
        assert_eq!(count, 0, "{name}");
        assert_eq!(lost(&solid, CellSize::LongestSide(cells), bounds), 0, "{name}");
    }
    assert_eq!([&boss, &chamfered].map(|solid| lost(solid, CellSize::LongestSide(64), None)), [0; 2]);
    // Where edges are sharp, radii are of few cells, or faces are told by distances to others, some
    // cells count that hide nothing.
    for (name, solid, cells, bounds) in [
        ("M2", m2.solid.clone(), 64, m2.cube()),
        ("M6", m6.solid.clone(), 64, m6.cube()),
        ("thread", thread, 128, room),
        ("boss", boss.clone(), 64, boss.finite_bounds().unwrap()),
        ("chamfered boss", chamfered.clone(), 64, chamfered.finite_bounds().unwrap()),
    ] {
        let settings =
            MeshSettings { cell: CellSize::LongestSide(cells), bounds: Some(bounds), ..MeshSettings::default() };
        let mesh = solid.mesh(&settings).unwrap();
        let count = solid.thin_features(&settings, &Run::default()).unwrap().cells;
        assert!(60 * count < mesh.triangles().len(), "{name}: {count} of {} triangles", mesh.triangles().len());
    }
}

/// Edges of imported parts hide nothing, and what is thin about them is found as that of others is.
#[test]
fn imported_parts_have_thin_places_where_others_have() {
    let block = Solid::cuboid([10.0, 8.0, 6.0]);
    let bored = &block - Solid::cylinder(2.0, 10.0);
    let fin = &block | Solid::cuboid([0.1, 6.0, 4.0]).translate([0.03, 0.0, 4.0]);
    let slot = &block - Solid::cuboid([0.1, 12.0, 4.0]).translate([0.03, 0.0, 2.0]);
    for (name, solid, is_thin) in [
        ("block", block.clone(), false),
        ("turned block", block.rotate_x(deg(20.0)).rotate_z(deg(33.0)), false),
        ("bored block", bored, false),
        ("fin", fin.clone(), true),
        ("turned fin", fin.rotate_x(deg(20.0)).rotate_z(deg(33.0)), true),
        ("slot", slot, true),
    ] {
        let fine = MeshSettings { cell: CellSize::Tolerance(0.01), ..MeshSettings::default() };
        let import = Solid::from_mesh(&solid.mesh(&fine).unwrap(), MeshSolid::default());
        let settings = MeshSettings { cell: CellSize::LongestSide(20), ..MeshSettings::default() };
        let report = import.thin_features(&settings, &Run::default()).unwrap();
        assert_eq!(report.count > 0, is_thin, "{name}: {report:?}");
        let thickness = report.places.iter().filter_map(|place| place.thickness).reduce(f64::min);
        assert!(!is_thin || (thickness.unwrap() - 0.1).abs() < 1e-3, "{name}: {report:?}");
    }
}

/// Extraction tells by itself that something may be lost, and keeps quiet where nothing is.
#[test]
fn extraction_tells_what_it_may_have_lost() {
    // A plate of little more than a cell, whose bores are smaller than one: most of them are lost.
    let bores = Solid::cylinder(2.5, 50.0).repeat([20, 20, 1], [15.0, 15.0, 1.0]).translate([-142.5, -142.5, 0.0]);
    let plate = Solid::cuboid([320.0, 320.0, 8.0]) - bores;
    let mesh = plate.mesh(&MeshSettings { cell: CellSize::Length(7.8), ..MeshSettings::default() }).unwrap();
    assert!(mesh.check().genus.unwrap_or(0) < 400);
    assert!(mesh.possibly_lost() > 0);
    assert!(mesh.warnings()[0].contains("features thinner than a cell (7.8"), "{:?}", mesh.warnings());
    // A plate of several cells hides none, if only its bores are thin.
    let thick = Solid::cuboid([32.0, 32.0, 8.0]);
    let bored = &thick - Solid::cylinder(0.2, 50.0).translate([0.3, 0.4, 0.0]);
    for cell in [0.5, 1.0, 2.0] {
        assert_eq!(lost(&thick, CellSize::Length(cell), None), 0, "{cell}");
        assert!(lost(&bored, CellSize::Length(cell), None) > 0, "{cell}");
    }
    assert_eq!(lost(&bored, CellSize::Length(0.1), None), 0);
    // A needle that is cut off, and a sheet that is not there at all.
    let needle = Solid::cone(0.5, 0.0, 100.0);
    let sheet = Solid::cuboid([1.0, 1.0, 0.0025]);
    for (solid, has_mesh) in [(&needle, true), (&sheet, false)] {
        let mesh = solid.mesh(&MeshSettings::default()).unwrap();
        assert_eq!(!mesh.triangles().is_empty(), has_mesh);
        assert!(mesh.possibly_lost() > 0);
        assert_eq!(mesh.warnings()[0].starts_with("the mesh is empty"), !has_mesh);
    }
    // Walls that are torn to pieces have crossings in all blocks.
    for thickness in [0.1, 0.3, 0.6] {
        let wall = Solid::sphere(1.0) - Solid::sphere(1.0 - thickness / 32.0);
        assert!(lost(&wall, CellSize::Length(1.0 / 32.0), None) > 0, "{thickness}");
        let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.5, thickness: thickness / 32.0 };
        let block = Solid::from(gyroid) & Solid::cuboid(DVec3::ONE);
        assert!(lost(&block, CellSize::Length(1.0 / 32.0), None) > 0, "{thickness}");
    }
}

#[test]
fn well_resolved_models_have_lost_nothing() {
    for model in models::all() {
        for cells in [40, 64, 100] {
            let cell = CellSize::Length(2.0 * model.half / f64::from(cells));
            assert_eq!(lost(&model.solid, cell, Some(model.cube())), 0, "{} at {cells}", model.name);
        }
    }
}

#[test]
fn thin_places_are_told_with_their_sizes() {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let block = Solid::cuboid(DVec3::splat(2.0));
    let slit = Solid::cuboid((0.01, 3.0, 1.0));
    let pin = Solid::cylinder(0.008, 0.5).translate([0.5, 0.5, 1.2]);
    let solid = ((block - slit) | pin).rotate(turn);
    let settings = MeshSettings { cell: CellSize::Length(1.0 / 32.0), ..MeshSettings::default() };
    let report = solid.thin_features(&settings, &Run::default()).unwrap();
    assert_eq!((report.count, report.places.len()), (2, 2), "{report}");
    assert_eq!(report.cells, report.places.iter().map(|place| place.cells).sum::<usize>());
    for (place, thickness, at) in [(&report.places[0], 0.01, 0.0), (&report.places[1], 0.016, 0.5)] {
        let found = place.thickness.unwrap();
        assert!((0.5 * thickness..1.01 * thickness).contains(&found), "{report}");
        assert!(((turn.inverse() * place.position).x - at).abs() < 0.02, "{report}");
    }
    // The same for any number of threads; it can be cancelled.
    let run = Run { threads: 1, ..Run::default() };
    assert_eq!(solid.thin_features(&settings, &run).unwrap(), report);
    let cancel = CancelToken::new();
    cancel.cancel();
    let cancelled = solid.thin_features(&settings, &Run { cancel, ..Run::default() });
    assert_eq!(cancelled, Err(MeshingError::Cancelled(Cancelled)));
    // Nothing within the bounds.
    let bounds = Some(Bounds::new(DVec3::splat(50.0), DVec3::splat(60.0)));
    let none = solid.thin_features(&MeshSettings { bounds, ..settings }, &Run::default()).unwrap();
    assert!(none.is_empty() && none == ThinReport::default());
}

#[test]
fn what_is_cut_off_or_empty_is_told_with_the_remedy() {
    let needle = Solid::superellipsoid([0.5, 0.5, 50.0], 1.0, 1.0);
    let mesh = needle.mesh(&MeshSettings::default()).unwrap();
    assert!(mesh.bounds().max.z < 45.0);
    let warnings = mesh.warnings();
    let told = |warnings: &[String]| {
        let first = warnings.first().map_or("", |text| text);
        first.contains("thinner than a cell (0.") && first.contains("or `ThinFeatures::Refine`")
    };
    assert!(told(&warnings), "{warnings:?}");
    let mesh = Solid::cuboid([10.0, 10.0, 0.0025]).mesh(&MeshSettings::default()).unwrap();
    let warnings = mesh.warnings();
    assert!(mesh.triangles().is_empty() && told(&warnings), "{warnings:?}");
    assert!(warnings[0].starts_with("the mesh is empty"), "{warnings:?}");
    // A report of what is lost names the size of the cells.
    let settings = MeshSettings { thin: ThinFeatures::Count, ..MeshSettings::default() };
    let warnings = Solid::cuboid([10.0, 10.0, 0.05]).mesh(&settings).unwrap().warnings();
    assert!(warnings.iter().any(|text| text.contains("cells of half the thickness, as `CellSize::")), "{warnings:?}");
}

/// A ball far from the axis of a twist is a thin lens, whose value changes by ten per length unit:
/// that nodes are far from the surface by their values says little of the cells about them.
#[test]
fn what_deformations_make_thin_is_told() {
    let mut random = Random::new(3);
    for _ in 0..40 {
        let at = [random.range(8.0, 12.0), random.range(-0.2, 0.2), random.range(-0.2, 0.2)];
        let lens = Solid::sphere(random.range(0.04, 0.08)).translate(at).twist(rad(1.0));
        let lens = lens.translate(random.vector(-0.5, 0.5));
        let mesh = (lens | Solid::sphere(1.0)).mesh(&settings(0.6)).unwrap();
        assert!(mesh.possibly_lost() > 0 || mesh.components().len() > 1, "{at:?}");
    }
}

/// Parts that meet in a face: it is within the mesh, wherever it lies between the nodes, and
/// nothing may be lost there.
#[test]
fn joints_are_within_the_mesh() {
    let block = Solid::cuboid([40.0, 40.0, 16.0]);
    let disc = Solid::cylinder(18.0, 16.0);
    let beam = Solid::cuboid([20.0, 40.0, 16.0]);
    let up = |solid: &Solid| solid.translate([0.0, 0.0, 16.0]);
    let plug = Solid::cylinder(8.0, 16.0);
    let (of_block, of_disc) = (40.0 * 40.0 * 16.0, PI * 18.0 * 18.0 * 16.0);
    let halves = up(&beam).translate([-10.0, 0.0, 0.0]) | up(&beam).translate([10.0, 0.0, 0.0]);
    let cut = Solid::cuboid([50.0, 50.0, 16.0]).translate([0.0, 0.0, 16.0]);
    let towers = [
        ("blocks", &block | up(&block), 2.0 * of_block),
        ("block and disc", &block | up(&disc), of_block + of_disc),
        ("discs", &disc | up(&disc), 2.0 * of_disc),
        ("three", &block | halves, 2.0 * of_block),
        ("plug", (&block - &plug) | &plug, of_block),
        ("flush cut", (&block | up(&block)) - cut, of_block),
    ];
    for (name, tower, volume) in &towers {
        // Upon a plane of nodes at 11/32 of a cell, and elsewhere.
        for off in [0.34375, 0.0, 0.3, 0.77] {
            let right = tower.translate([0.34375, 0.34375, off - 8.0]);
            let turned = tower.rotate_x(rad(0.3)).rotate_z(rad(0.5)).translate([0.0, 0.0, off]);
            for solid in [&right, &turned, &right.scale(1.0 / 16.0)] {
                let cell = if solid.bounds().unwrap().longest_side() < 10.0 { 1.0 / 16.0 } else { 1.0 };
                let mesh = solid.mesh(&settings(cell)).unwrap();
                let text = format!("{name}, {off}, cells of {cell}: {} lost", mesh.possibly_lost());
                assert!(mesh.check().is_sound() && mesh.components().len() == 1, "{text}");
                assert_eq!(mesh.possibly_lost(), 0, "{text}");
                assert!((mesh.volume() / (cell * cell * cell * volume) - 1.0).abs() < 5e-3, "{text}");
            }
        }
    }
}

/// The walls of a small body: few nodes are in them, in few blocks.
#[test]
fn torn_walls_of_small_bodies_are_told() {
    let mut random = Random::new(5);
    let bodies = [
        Solid::ellipsoid([5.0, 1.0, 2.0]),
        Solid::wedge([14.5, 1.0, 2.0]),
        Solid::cuboid([3.0, 2.0, 4.0]),
        Solid::torus(2.0, 1.0),
        Solid::cone(1.0, 0.4, 3.0),
        Solid::superellipsoid([2.0, 1.0, 1.5], 0.4, 1.3),
    ];
    for body in &bodies {
        for cells in [10, 16, 24, 40] {
            let turned = body.shell(0.1).rotate(random.rotation()).translate(random.vector(-0.5, 0.5));
            let volume = |cell: CellSize| {
                let mesh = turned.mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap();
                (mesh.check().volume, mesh.possibly_lost())
            };
            let (right, _) = volume(CellSize::Length(0.05));
            let (found, lost) = volume(CellSize::LongestSide(cells));
            assert!(lost > 0 || (found / right - 1.0).abs() < 0.1, "{turned} at {cells}: {found} for {right}");
        }
    }
}

/// Gaps and walls that pass between nodes, in blocks that are crossed elsewhere.
#[test]
fn gaps_between_nodes_are_told() {
    let mut random = Random::new(9);
    let comb = |gap: f64| Solid::cuboid([2.0 - gap, 24.0, 1.5]).repeat([12, 1, 1], [2.0, 1.0, 1.0]);
    let plate = Solid::cuboid([24.0, 24.0, 1.5]);
    let slots = |width: f64| Solid::cuboid([width, 20.0, 3.0]).repeat([11, 1, 1], [2.0, 1.0, 1.0]);
    let notch = |width: f64| {
        let half = 0.5 * width;
        let corners = [
            [-8.0, -6.0],
            [8.0, -6.0],
            [8.0, 6.0],
            [half, 6.0],
            [half, -2.0],
            [-half, -2.0],
            [-half, 6.0],
            [-8.0, 6.0],
        ];
        Profile::polygon(corners).extrude(1.5)
    };
    let ring = |width: f64| {
        let tube = Solid::cylinder(9.0, 3.0) - Solid::cylinder(4.0, 4.0);
        tube - (Solid::cylinder(6.0 + width, 4.0) - Solid::cylinder(6.0, 5.0))
    };
    let mut worst = 0.0f64;
    for width in [0.1, 0.3, 0.7] {
        let of_plate = 24.0 * 24.0 * 1.5;
        let of_ring = (81.0 - 16.0 - (6.0 + width) * (6.0 + width) + 36.0) * 3.0 * PI;
        let bodies = [
            ("comb", comb(width), 12.0 * (2.0 - width) * 24.0 * 1.5),
            ("slots", &plate - slots(width), of_plate - 11.0 * width * 20.0 * 1.5),
            ("fins", slots(width) | plate.translate([0.0, 0.0, -1.5]), of_plate + 11.0 * width * 20.0 * 2.25),
            ("notch", notch(width), (16.0 * 12.0 - 8.0 * width) * 1.5),
            ("rings", ring(width), of_ring),
            (
                "pair",
                Solid::sphere(6.0).translate([-6.0 - 0.5 * width, 0.0, 0.0])
                    | Solid::cuboid([12.0; 3]).translate([6.0 + 0.5 * width, 0.0, 0.0]),
                288.0 * PI + 12.0f64.powi(3),
            ),
        ];
        for (name, body, right) in &bodies {
            for turn in 0..4 {
                let place = random.vector(-0.5, 0.5);
                let solid =
                    if turn == 0 { body.translate(place) } else { body.rotate(random.rotation()).translate(place) };
                let mesh = solid.mesh(&settings(1.0)).unwrap();
                let off = (mesh.volume() / right - 1.0).abs();
                let lost = mesh.possibly_lost();
                println!("{name} {width} {turn}: off {off:.3}, {lost} lost");
                if lost == 0 {
                    worst = worst.max(off);
                }
            }
        }
    }
    assert!(worst < 0.01, "{worst}");
}

fn settings(cell: f64) -> MeshSettings {
    MeshSettings { cell: CellSize::Length(cell), ..MeshSettings::default() }
}
