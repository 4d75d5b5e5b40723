//! Meshes of solids: closed, manifold, outward, of the right volume and topology.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;
use std::path::PathBuf;

use glam::{DQuat, DVec3, Vec3};
use rvachev::{
    Blend, Bounds, CellSize, Features, Helix, Mesh, MeshReport, MeshSettings, Profile, Progress, RFunction, Run, Solid,
    error::MeshingError, io::write_stl, rad,
};

use crate::models;
use crate::support::near;

fn cells(count: u32) -> MeshSettings {
    MeshSettings { cell: CellSize::LongestSide(count), ..MeshSettings::default() }
}

#[track_caller]
fn mesh(solid: &Solid, settings: &MeshSettings) -> (Mesh, MeshReport) {
    let mesh = solid.mesh(settings).expect("the solid is bounded");
    let report = mesh.check();
    assert!(report.is_closed() && report.is_manifold(), "{solid:?}: {report:?}");
    assert_eq!((report.duplicate_vertices, report.unused_vertices), (0, 0), "{solid:?}");
    (mesh, report)
}

/// The part of triangles whose vertices' normals are on their own side.
fn outward(mesh: &Mesh) -> f64 {
    let normals = mesh.normals().expect("meshes of solids have normals");
    let at = |i: u32| mesh.positions()[i as usize];
    let agrees = |&&[a, b, c]: &&[u32; 3]| {
        let face = (at(b) - at(a)).cross(at(c) - at(a));
        let mean: Vec3 = [a, b, c].iter().map(|&i| normals[i as usize]).sum();
        face.dot(mean) > 0.0
    };
    mesh.triangles().iter().filter(agrees).count() as f64 / mesh.triangles().len() as f64
}

#[test]
fn the_models_are_closed_manifold_and_outward() {
    for (model, across) in models::all().iter().flat_map(|model| [(model, 64.0), (model, 128.0)]) {
        let settings = MeshSettings {
            cell: CellSize::Length(2.0 * model.half / across),
            bounds: Some(model.cube()),
            ..MeshSettings::default()
        };
        let (mesh, report) = mesh(&model.solid, &settings);
        assert!(report.volume > 0.0, "{}", model.name);
        assert!(outward(&mesh) > 0.98, "{}: {}", model.name, outward(&mesh));
        let bounds = model.solid.bounds().unwrap().inflate(1e-6);
        assert!(bounds.contains_bounds(&report.bounds), "{}", model.name);
        for normal in mesh.normals().expect("meshes of solids have normals") {
            assert!((normal.length() - 1.0).abs() < 1e-4, "{}: {normal}", model.name);
        }
    }
}

#[test]
fn vertices_are_on_the_surface() {
    for model in [models::m1(), models::m2(), models::m6()] {
        let settings = MeshSettings { features: Features::Smooth, ..cells(32) };
        let (mesh, _) = mesh(&model.solid, &settings);
        let program = model.solid.surface_program().unwrap();
        for p in mesh.positions() {
            let v = program.value(p.as_dvec3());
            // Positions are f32, and vertices keep a thousandth of a cell from nodes.
            assert!(v.abs() < 2e-4, "{}: {v:e} at {p}", model.name);
        }
    }
}

/// Where many leaves are near, one decides at each vertex, and its root is that of all.
#[test]
fn vertices_among_many_leaves_are_on_the_surface() {
    let mut state = 7u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let part = |_| {
        let axes = DVec3::new(0.1 + 0.1 * next(), 0.1 + 0.1 * next(), 0.1 + 0.1 * next());
        let turn = DQuat::from_scaled_axis(6.0 * DVec3::new(next(), next(), next()));
        let at = DVec3::new(next(), next(), next());
        Solid::superellipsoid(axes, 0.2 + 1.6 * next(), 0.2 + 1.6 * next()).rotate(turn).translate(at)
    };
    let crowd = Solid::union_all((0..100).map(part), RFunction::MIN_MAX);
    let block = Solid::cuboid(DVec3::ONE).translate(DVec3::splat(0.5));
    for solid in [block.difference(crowd.clone(), RFunction::MIN_MAX), crowd] {
        let settings = MeshSettings { cell: CellSize::Length(1.0 / 64.0), features: Features::Smooth, ..cells(1) };
        let mesh = solid.mesh(&settings).unwrap();
        let program = solid.surface_program().unwrap();
        // A millionth of a cell, and the rounding of the position.
        let off = |p: &&Vec3| program.value(p.as_dvec3()).abs() > 1e-6 / 64.0 + 1.2e-7;
        let count = mesh.positions().iter().filter(off).count();
        assert!(Some(count) <= mesh.clamped_vertices(), "{count} of {}", mesh.positions().len());
    }
}

#[test]
fn the_volume_converges_with_the_square_of_the_cell() {
    const VOLUME: f64 = 3.1731914305231785;
    let model = models::m1();
    let [coarse, fine] = [64.0, 128.0].map(|across| {
        let settings = MeshSettings {
            cell: CellSize::Length(2.0 * model.half / across),
            bounds: Some(model.cube()),
            features: Features::Smooth,
            ..MeshSettings::default()
        };
        let (_, report) = mesh(&model.solid, &settings);
        report.volume / VOLUME - 1.0
    });
    println!("volume error of M1: {:.5} % at 64³, {:.5} % at 128³", 100.0 * coarse, 100.0 * fine);
    assert!(fine.abs() <= 0.00025, "{fine}");
    near(coarse / fine, 4.0, 0.3);
}

#[test]
fn shells_and_handles_are_counted_right() {
    let torus_like = Solid::cylinder(1.0, 0.6) - Solid::cylinder(0.5, 1.0);
    let cases = [
        (Solid::sphere(1.0), 1, 0, 4.0 / 3.0 * PI),
        (torus_like, 1, 1, 0.75 * PI * 0.6),
        // A hollow ball has an inner shell.
        (Solid::sphere(1.0) - Solid::sphere(0.5), 2, 0, 4.0 / 3.0 * PI * 0.875),
        (Solid::sphere(0.5) | Solid::sphere(0.5).translate(DVec3::X * 2.0), 2, 0, PI / 3.0),
    ];
    for (solid, shells, genus, volume) in cases {
        let (_, report) = mesh(&solid, &cells(48));
        assert_eq!((report.shells, report.genus), (shells, Some(genus)), "{solid:?}");
        near(report.volume, volume, 0.01 * volume);
    }
}

/// Cuts and unions whose faces lie on one another: a name, the solid, shells, handles, volume.
fn flush(size: f64) -> Vec<(&'static str, Solid, usize, i64, f64)> {
    let block = || Solid::cuboid(DVec3::splat(2.0 * size));
    let at = |solid: Solid, x: f64, y: f64, z: f64| solid.translate(size * DVec3::new(x, y, z));
    let volume = size.powi(3);
    let cuboid = |x: f64, y: f64, z: f64| Solid::cuboid(size * DVec3::new(x, y, z));
    vec![
        ("a slab off the top", block() - at(cuboid(2.0, 2.0, 1.0), 0.0, 0.0, 0.5), 1, 0, 4.0 * volume),
        ("a notch in an edge", block() - at(cuboid(1.0, 2.0, 1.0), 0.5, 0.0, 0.5), 1, 0, 6.0 * volume),
        ("a pocket in the top", block() - at(cuboid(1.0, 1.0, 1.0), 0.0, 0.0, 0.5), 1, 0, 7.0 * volume),
        ("a slot through", block() - at(cuboid(0.5, 2.0, 1.0), 0.0, 0.0, 0.0), 1, 1, 7.0 * volume),
        ("a bore through", block() - Solid::cylinder(0.5 * size, 2.0 * size), 1, 1, (8.0 - 0.5 * PI) * volume),
        ("two blocks side by side", block() | at(block(), 2.0, 0.0, 0.0), 1, 0, 16.0 * volume),
        ("a block on a larger one", block() | at(cuboid(1.0, 1.0, 1.0), 0.0, 0.0, 1.5), 1, 0, 9.0 * volume),
        (
            "a boss on a block",
            block() | at(Solid::cylinder(0.5 * size, size), 0.0, 0.0, 1.5),
            1,
            0,
            (8.0 + 0.25 * PI) * volume,
        ),
        (
            "a block in its pocket",
            (block() - at(cuboid(1.0, 1.0, 1.0), 0.0, 0.0, 0.5)) | at(cuboid(1.0, 1.0, 1.0), 0.0, 0.0, 0.5),
            1,
            0,
            8.0 * volume,
        ),
        ("a cut apart", block() - at(cuboid(1.0, 2.0, 2.0), 0.0, 0.0, 0.0), 2, 0, 4.0 * volume),
    ]
}

#[test]
fn flush_faces_leave_neither_skin_nor_dust() {
    let turns = [
        DQuat::IDENTITY,
        DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 1.1)),
        DQuat::from_rotation_z(0.5) * DQuat::from_rotation_x(FRAC_PI_2),
    ];
    let mut failures = Vec::new();
    for (turn, size) in turns.into_iter().zip([1.0, 0.3, 12.5]) {
        for (name, solid, shells, genus, volume) in flush(size) {
            let offset = if turn == DQuat::IDENTITY { DVec3::ZERO } else { size * DVec3::new(0.3, 0.7, -0.2) };
            let solid = solid.rotate(turn).translate(offset);
            let mesh = solid.mesh(&cells(32)).unwrap();
            let report = mesh.check();
            let right = report.is_closed() && report.is_manifold();
            let off = report.volume / volume - 1.0;
            if !right || (report.shells, report.genus) != (shells, Some(genus)) || off.abs() > 0.02 {
                failures.push(format!("{name}, size {size}, turned by {turn}: volume off by {off:.4}, {report:?}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_solid_without_itself_is_nothing() {
    for solid in [Solid::cuboid(DVec3::splat(2.0)), Solid::superellipsoid(DVec3::ONE, 0.3, 0.7).rotate_x(rad(0.4))] {
        let mesh = (&solid - &solid).mesh(&cells(24)).unwrap();
        assert_eq!(mesh.triangles().len(), 0, "{solid:?}");
        let twice = (&solid | &solid).mesh(&cells(24)).unwrap();
        assert_eq!(twice, solid.mesh(&cells(24)).unwrap());
    }
    let apart = Solid::sphere(1.0) & Solid::sphere(1.0).translate(DVec3::X * 9.0);
    assert_eq!(apart.mesh(&cells(24)).unwrap(), Mesh::default());
}

#[test]
fn given_bounds_cut_the_solid() {
    let ball = Solid::sphere(1.0);
    let half = Bounds::new(DVec3::new(0.0, -2.0, -2.0), DVec3::splat(2.0));
    let settings = MeshSettings { cell: CellSize::Length(0.05), bounds: Some(half), ..MeshSettings::default() };
    let (_, report) = mesh(&ball, &settings);
    near(report.volume, 2.0 / 3.0 * PI, 0.01);
    // Edges of caps are found as all features are.
    assert!(half.inflate(0.01 * 0.05).contains_bounds(&report.bounds), "{:?}", report.bounds);
    // Off round coordinates, on several sides at once.
    let part = Bounds::new(DVec3::new(-0.31, -0.47, 0.113), DVec3::new(0.217, 0.53, 1.5));
    let (_, report) =
        mesh(&ball, &MeshSettings { cell: CellSize::Length(0.04), bounds: Some(part), ..MeshSettings::default() });
    assert!(part.inflate(0.01 * 0.04).contains_bounds(&report.bounds));
    assert_eq!((report.shells, report.genus), (1, Some(0)));
    // Within the solid it is the box; around it the solid.
    let core = Bounds::from_center(DVec3::ZERO, DVec3::splat(0.5));
    let (_, report) =
        mesh(&ball, &MeshSettings { cell: CellSize::Length(0.05), bounds: Some(core), ..MeshSettings::default() });
    near(report.volume, 1.0, 0.02);
    let around = Some(Bounds::from_center(DVec3::ZERO, DVec3::splat(5.0)));
    let whole =
        ball.mesh(&MeshSettings { cell: CellSize::Length(0.1), bounds: around, ..MeshSettings::default() }).unwrap();
    assert_eq!(whole, ball.mesh(&MeshSettings { cell: CellSize::Length(0.1), ..MeshSettings::default() }).unwrap());
    // Away from it there is nothing.
    let away = Some(Bounds::from_center(DVec3::splat(9.0), DVec3::ONE));
    assert_eq!(
        ball.mesh(&MeshSettings { cell: CellSize::Length(0.1), bounds: away, ..MeshSettings::default() }),
        Ok(Mesh::default())
    );
}

fn bytes(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_stl(mesh, &mut bytes).expect("memory takes it all");
    bytes
}

#[test]
fn threads_do_not_change_a_byte() {
    for model in [models::m2(), models::m4(), models::m6()] {
        let by = |threads: usize| {
            let run = Run { threads, ..Run::default() };
            model.solid.mesh_with(&cells(48), &run).expect("the solid is bounded")
        };
        let one = by(1);
        for threads in [2, 3] {
            let more = by(threads);
            assert_eq!(bytes(&one), bytes(&more), "{} on {threads} threads", model.name);
            assert_eq!(one, more, "{} on {threads} threads", model.name);
        }
    }
}

/// A directory of the test's own, removed with what is in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("rvachev-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("temporary files can be made");
        Folder(path)
    }

    fn files(&self) -> usize {
        fs::read_dir(&self.0).expect("the folder is there").count()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_saved_file_reads_back() {
    let folder = Folder::new("read-back");
    let path = folder.0.join("part.stl");
    let (mesh, report) = mesh(&models::m2().solid, &cells(32));
    mesh.save(&path).unwrap();
    let data = fs::read(&path).unwrap();
    assert_eq!(data, bytes(&mesh));
    assert!(!data.starts_with(b"solid"));
    assert_eq!(data.len(), 84 + 50 * report.triangles);
    assert_eq!(data[80..84], u32::try_from(report.triangles).unwrap().to_le_bytes());
    let mut volume = 0.0;
    for (facet, triangle) in data[84..].chunks(50).zip(mesh.triangles()) {
        let number = |i: usize| f32::from_le_bytes(facet[4 * i..4 * i + 4].try_into().expect("four bytes"));
        let vector = |i: usize| Vec3::new(number(i), number(i + 1), number(i + 2));
        let corners = [vector(3), vector(6), vector(9)];
        assert_eq!(corners, triangle.map(|i| mesh.positions()[i as usize]));
        let [a, b, c] = corners.map(|v| v.as_dvec3());
        volume += a.dot(b.cross(c)) / 6.0;
        assert!(vector(0).as_dvec3().dot((b - a).cross(c - a)) > 0.0);
    }
    near(volume, report.volume, 1e-9);
    assert_eq!(folder.files(), 1);
}

#[test]
fn a_save_that_fails_names_the_file_and_leaves_nothing() {
    let folder = Folder::new("failed");
    let (mesh, _) = mesh(&Solid::sphere(1.0), &cells(8));
    for (file, says) in [("none/part.stl", "no directory"), ("part.xyz", "known: .3mf"), ("part", "no extension")] {
        let text = mesh.save(folder.0.join(file)).unwrap_err().to_string();
        assert!(text.contains(file) && text.contains(says), "{text}");
    }
    // A directory where the file should be.
    fs::create_dir(folder.0.join("taken.stl")).unwrap();
    let text = mesh.save(folder.0.join("taken.stl")).unwrap_err().to_string();
    assert!(text.contains("taken.stl"), "{text}");
    assert_eq!(folder.files(), 1);
}

#[test]
fn cancelling_stops_the_work() {
    let solid = models::m4().solid;
    let run = Run::default();
    run.cancel.cancel();
    let cancelled = Err(MeshingError::Cancelled(rvachev::Cancelled));
    assert_eq!(solid.mesh_with(&cells(256), &run), cancelled);
    // From within, once a part of the work is done.
    for part in [0.0, 0.4] {
        let run = Run::default();
        let token = run.cancel.clone();
        let progress = Progress::new(move |done| {
            if done > part {
                token.cancel();
            }
        });
        let run = Run { progress: Some(progress), ..run };
        assert_eq!(solid.mesh_with(&cells(96), &run), cancelled, "after {part}");
    }
}

#[test]
fn progress_reaches_the_end() {
    let seen = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
    let sink = seen.clone();
    let progress = Progress::new(move |done| sink.lock().expect("no panic while it is held").push(done));
    let run = Run { progress: Some(progress), ..Run::default() };
    models::m2().solid.mesh_with(&cells(48), &run).unwrap();
    let seen = seen.lock().unwrap();
    assert!(seen.windows(2).all(|w| w[0] < w[1]), "{seen:?}");
    assert_eq!(seen.last(), Some(&1.0));
}

#[test]
fn small_solids_far_away_mesh_like_those_at_hand() {
    let part = Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7) - Solid::cylinder(0.3, 3.0);
    let near_by = part.scale(0.125).mesh(&cells(40)).unwrap();
    let (_, far) = mesh(&part.scale(0.125).translate(DVec3::new(256.0, -512.0, 128.0)), &cells(40));
    near(far.volume, near_by.volume(), 3e-3 * near_by.volume());
    assert_eq!((far.shells, far.genus), (1, Some(1)));
}

/// Fields that jump, as fillets along operands with edges of their own do: samples depend on
/// rounding, and ranges of blocks may be wrong.
#[test]
fn surfaces_of_fields_that_jump_are_closed() {
    let thread = Profile::circle(0.08).sweep_helix(&Helix::new(0.3, 0.25, 2.5));
    let fillet = Blend::Fillet { radius: 0.05 };
    let on_core = |solid: &Solid| solid.union_with(Solid::cylinder(0.25, 1.4), fillet);
    let on_cube = |solid: &Solid| solid.union_with(Solid::cuboid(DVec3::splat(0.5)), fillet);
    let ring = |angle: f64| Profile::circle(0.2).revolve_by(rad(angle));
    let on_block = |solid: &Solid| solid.union_with(Solid::cuboid(DVec3::splat(0.3)).translate(DVec3::X * 0.1), fillet);
    let mut solids = vec![(on_core(&thread), 64)];
    solids.extend([4.9, 5.1].map(|angle| (on_block(&ring(angle)), 40)));
    solids.extend(
        (1..2).map(|n| (on_cube(&thread.rotate_x(rad(0.5 * f64::from(n))).rotate_z(rad(0.3 * f64::from(n)))), 24)),
    );
    for (nth, (solid, longest)) in solids.iter().enumerate() {
        for features in [Features::Smooth, Features::Sharp] {
            let mesh = solid.with_tolerance(5e-4).mesh(&MeshSettings { features, ..cells(*longest) });
            let report = mesh.unwrap_or_else(|error| panic!("{nth}, {features:?}: {error}")).check();
            assert!(report.is_sound(), "{nth}, {features:?}: {report:?}");
        }
    }
}

#[test]
fn thin_walls_have_normals() {
    let shell = Solid::cuboid((0.64, 0.53, 0.85)).rotate_x(rad(0.3)).rotate_y(rad(0.5)).shell(0.025);
    for features in [Features::Smooth, Features::Sharp] {
        let mesh =
            shell.mesh(&MeshSettings { cell: CellSize::Length(0.05), features, ..MeshSettings::default() }).unwrap();
        let is_unit = |normal: &&Vec3| (normal.length() - 1.0).abs() < 1e-3;
        let normals = mesh.normals().unwrap();
        assert_eq!(normals.iter().filter(is_unit).count(), normals.len(), "{features:?}");
    }
}
