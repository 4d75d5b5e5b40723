//! What may take long tells how far it is, and is cancelled before it begins and on the way.

use std::fmt::Display;
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use glam::{DAffine3, DVec2, DVec3, Vec3};
use rvachev::{
    Camera, CancelToken, CellSize, Image, Mesh, MeshSettings, PointCloud, Polyline, Progress, Run, SaveSettings,
    Superellipsoid, deg,
    error::SaveError,
    fit::Segments,
    range_image::{Coordinates, Noise},
    raster::{Buffers, ClosedMesh, Facing, RasterView},
    subdivision::{ControlGrid, SubdivisionRevolution, Tension},
    surface::{ParametricSurface, PatchSettings, Spacing},
};

use crate::progress::{flows, part, recorded};

/// Cancels the work once it has told so much, and what it tells.
fn stopped(at: f64) -> (Run, Arc<Mutex<Vec<f64>>>) {
    let (cancel, seen) = (CancelToken::new(), Arc::new(Mutex::new(Vec::new())));
    let (token, sink) = (cancel.clone(), seen.clone());
    let progress = Progress::new(move |fraction| {
        sink.lock().unwrap().push(fraction);
        if fraction >= at {
            token.cancel();
        }
    });
    (Run { threads: 2, cancel, progress: Some(progress) }, seen)
}

/// The work tells how far it is, in `least` steps of at most `widest`, which are counts of what is
/// done; it ends with nothing done if it was cancelled before, and soon after it is on the way.
pub fn heeds<T, E: Display>(what: &str, least: usize, widest: f64, work: impl Fn(&Run) -> Result<T, E>) {
    let (run, seen) = recorded();
    assert!(work(&run).is_ok(), "{what}");
    flows(what, &seen, least, widest);
    let ended = |run: &Run, when: &str| match work(run) {
        Ok(_) => panic!("{what}, cancelled {when}, went on to its end"),
        Err(error) => assert_eq!(error.to_string(), "cancelled", "{what}, cancelled {when}"),
    };
    for at in [0.2, 0.6] {
        let (run, seen) = stopped(at);
        ended(&run, &format!("at {at}"));
        let last = *seen.lock().unwrap().last().unwrap();
        assert!(last < at + 1.5 * widest, "{what}: cancelled at {at}, went on to {last}");
    }
    let (run, seen) = recorded();
    run.cancel.cancel();
    ended(&run, "before");
    assert!(seen.lock().unwrap().iter().all(|told| *told == 0.0), "{what}: {:?}", seen.lock().unwrap());
}

#[test]
fn surfaces_heed_a_run() {
    let leaf = Superellipsoid::new([1.0, 1.5, 0.7], 0.4, 0.8);
    let surface = ParametricSurface::of(&leaf).unwrap();
    let grid = PatchSettings { rows: 300, columns: 300, ..PatchSettings::default() };
    heeds("patch", 200, 0.1, |run| surface.mesh_with(&grid, run));
    heeds("quadrilaterals", 200, 0.05, |run| surface.quad_mesh_with(&grid, run));
    let even = PatchSettings { spacing: Spacing::Chord(1e-3), ..grid };
    heeds("patch within a tolerance", 50, 0.3, |run| surface.mesh_with(&even, run));
    heeds("points of a surface", 20, 0.06, |run| surface.sample_with(100_000, 7, run));
    let ball = SubdivisionRevolution::ellipsoid([1.0, 2.0, 3.0]).unwrap();
    heeds("revolution", 100, 0.05, |run| ball.limit_mesh_with([6, 6], run));
    heeds("bare revolution", 100, 0.05, |run| ball.subdivided_mesh_with([6, 6], run));
    let points: Vec<DVec3> = (0..25).map(|i| [i % 5, i / 5, i % 3].map(f64::from).into()).collect();
    let sheet = ControlGrid::new(&points, [5, 5], [false; 2], [Tension::CUBIC; 2]).unwrap();
    heeds("sheet", 200, 0.05, |run| sheet.limit_mesh_with(6, run));
    heeds("grid", 200, 0.05, |run| sheet.subdivided_with(6, run));
    let quads = surface.quad_mesh(&PatchSettings { rows: 700, ..grid }).unwrap();
    heeds("quadrilaterals as triangles", 200, 0.2, |run| quads.to_mesh_with(run));
}

#[test]
fn buffers_heed_a_run() {
    let settings = MeshSettings { cell: CellSize::LongestSide(100), ..MeshSettings::default() };
    let mesh = part().mesh(&settings).unwrap();
    let closed = ClosedMesh::new(&mesh).unwrap();
    let camera = Camera::framing(&part().bounds().unwrap());
    let view = RasterView::new(&camera, 900, 700).unwrap();
    heeds("layers", 100, 0.06, |run| view.layers_with(closed, run));
    heeds("open layers", 100, 0.06, |run| view.surface_with(&mesh, run));
    let layers = view.layers(closed);
    let buffers = || Buffers::new(&view);
    heeds("drawing", 200, 0.05, |run| buffers().draw_with(&layers, 0, Facing::Front, run));
    heeds("classifying", 200, 0.05, |run| buffers().classify_with(&layers, run));
    let mut drawn = buffers();
    drawn.draw(&layers, 0, Facing::Front).unwrap();
    heeds("picture of buffers", 200, 0.05, |run| drawn.picture_with(&[&layers], &[[200; 3]], run));
    heeds("picture of depths", 200, 0.05, |run| drawn.depth_picture_with(run));
    heeds("range image of buffers", 200, 0.05, |run| drawn.range_image_with(run));
    let range = drawn.range_image().unwrap();
    let noise = Noise { deviation: 0.01, missing: 0.1, seed: 7 };
    heeds("noise", 200, 0.05, |run| range.with_noise_on(&noise, run));
    heeds("points of a range image", 200, 0.15, |run| range.points_with(Coordinates::World, run));
}

#[test]
fn what_rays_see_heeds_a_run() {
    let scene = part().scene().unwrap();
    let camera = Camera::framing(&scene.bounds());
    let layers = scene.layers(&camera, 320, 240, &Run::default()).unwrap();
    heeds("range image", 200, 0.05, |run| layers.range_image_with(run));
    let rays: Vec<(DVec3, DVec3)> = (0..300_000)
        .map(|i| (DVec3::new(f64::from(i % 1000) / 200.0 - 2.5, f64::from(i / 1000) / 60.0 - 2.5, 9.0), -DVec3::Z))
        .collect();
    heeds("first hits", 20, 0.06, |run| scene.first_hits_with(&rays, run));
    let light = Image::new(300, 200, vec![[0.5_f32, 0.25, 0.1, 0.5]; 60_000]).unwrap();
    heeds("light in 16 bits", 100, 0.05, |run| light.to_16bit_with(run));
}

#[test]
fn segments_heed_a_run() {
    let mesh = part().mesh(&MeshSettings { cell: CellSize::LongestSide(48), ..MeshSettings::default() }).unwrap();
    heeds("segments", 200, 0.15, |run| Segments::of_mesh_by_creases_with(&mesh, deg(40.0), run));
    let labels: Vec<u32> = (0..mesh.triangles().len() as u32).map(|t| t % 40).collect();
    heeds("labelled segments", 30, 0.05, |run| Segments::of_mesh_with(&mesh, &labels, run));
}

/// A mesh with everything that it can carry.
pub fn laden() -> Mesh {
    let leaf = Superellipsoid::new([1.0, 1.0, 2.0], 0.4, 0.8);
    let settings = PatchSettings { rows: 200, columns: 200, ..PatchSettings::default() };
    let mesh = ParametricSurface::of(&leaf).unwrap().mesh(&settings).unwrap();
    let normals = mesh.normals().unwrap().to_vec();
    let corners = mesh.triangles().iter().map(|t| t.map(|v| normals[v as usize])).collect();
    let colors = (0..mesh.triangles().len()).map(|t| [[(t % 251) as u8, 2, 3, 255]; 3]).collect();
    mesh.with_corner_normals(corners).unwrap().with_corner_colors(colors).unwrap()
}

#[test]
fn parts_and_openings_of_meshes_heed_a_run() {
    let settings = MeshSettings { cell: CellSize::LongestSide(150), ..MeshSettings::default() };
    let mesh = part().mesh(&settings).unwrap();
    heeds("components", 100, 0.4, |run| mesh.components_with(run));
    heeds("kept components", 100, 0.15, |run| mesh.keep_components_with(|_| true, run));
    let parts = mesh.components();
    heeds("mesh of a component", 100, 0.15, |run| parts[0].mesh_with(run));
    heeds("open edges", 5, 0.55, |run| mesh.open_edges_with(run));
}

#[test]
fn moved_meshes_heed_a_run() {
    let mesh = laden();
    heeds("affine", 30, 0.15, |run| mesh.affine_with(DAffine3::from_scale(DVec3::new(-1.0, 2.0, 3.0)), run));
    heeds("taper", 30, 0.15, |run| mesh.taper_with(0.2, 0.1, 4.0, run));
    heeds("twist", 30, 0.15, |run| mesh.twist_with(deg(20.0), run));
    heeds("bend", 30, 0.15, |run| mesh.bend_with(0.1, deg(20.0), run));
    let one = Run { threads: 1, ..Run::default() };
    assert_eq!(mesh.twist_with(deg(20.0), &one).unwrap(), mesh.twist(deg(20.0)).unwrap());
}

/// A file that is saved on a run: told of in `least` steps, and left as it was when cancelled.
fn stays(path: &Path, least: usize, save: impl Fn(&Path, &Run) -> Result<(), SaveError>) {
    let name = path.file_name().unwrap().to_string_lossy();
    let (run, seen) = recorded();
    save(path, &run).unwrap();
    flows(&name, &seen, least, 0.8);
    let before = fs::read(path).unwrap();
    assert!(before.len() > 100, "{name}");
    fs::write(path, "what was there").unwrap();
    // Before it begins, and on the way.
    for at in [f64::NEG_INFINITY, 0.2] {
        let (run, seen) = stopped(at);
        if at < 0.0 {
            run.cancel.cancel();
        }
        let saved = save(path, &run);
        assert!(matches!(saved, Err(SaveError::Cancelled(_))), "{name} at {at}: {saved:?}");
        assert_eq!(fs::read(path).unwrap(), b"what was there", "{name} at {at}");
        let told = seen.lock().unwrap().last().copied().unwrap_or(0.0);
        assert!(told < 1.0 && (at > 0.0 || told == 0.0), "{name} at {at}: {told}");
    }
    save(path, &Run { threads: 1, ..Run::default() }).unwrap();
    assert!(fs::read(path).unwrap() == before, "{name}: the run changes the file");
}

#[test]
fn files_heed_a_run_and_stay_as_they_are() {
    let folder = std::env::temp_dir().join(format!("rvachev-runs-of-files-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let at = |name: &str| folder.join(name);

    let mesh = laden();
    let whole = SaveSettings { crease_normals: true, ..SaveSettings::default() };
    let text = SaveSettings { ascii: true, ..SaveSettings::default() };
    stays(&at("text.stl"), 20, |path, run| mesh.save_on(path, &text, run));
    let mut formats = vec!["stl", "obj", "ply", "glb"];
    formats.extend(cfg!(feature = "threemf").then_some("3mf"));
    for extension in &formats {
        stays(&at(&format!("mesh.{extension}")), 20, |path, run| mesh.save_on(path, &whole, run));
    }
    let cloud = PointCloud::new(mesh.positions().iter().map(|p| p.as_dvec3()).collect()).unwrap();
    stays(&at("cloud.ply"), 5, |path, run| cloud.save_on(path, run));

    let numbers = |y: u32, x: u32| f64::from((x * 7919 + y * 104_729) % 1009);
    let depth = Image::new(300, 400, (0..120_000).map(|i| numbers(i / 300, i % 300)).collect()).unwrap();
    let picture = depth.map(|d| [*d as u8, (*d / 4.0) as u8, 7, 255]);
    let normal = depth.map(|d| Vec3::new((*d / 1009.0) as f32, 0.0, 0.0));
    stays(&at("picture.png"), 50, |path, run| picture.save_on(path, run));
    stays(&at("depth.png"), 50, |path, run| depth.save_on(path, run));
    stays(&at("normal.png"), 50, |path, run| normal.save_on(path, run));
    let pictures: Vec<Image> = (0..30).map(|i| Image::new(8, 8, vec![[i, 2 * i, 9, 255]; 64]).unwrap()).collect();
    let pause = Duration::from_millis(40);
    stays(&at("moving.gif"), 20, |path, run| Image::save_animation_on(&pictures, pause, path, run));
    let mut others = 8;
    if cfg!(feature = "exr") {
        stays(&at("depth.exr"), 10, |path, run| depth.save_on(path, run));
        stays(&at("normal.exr"), 10, |path, run| normal.save_on(path, run));
        others += 2;
    }

    let circle = |i: u32| Polyline::closed((0..400).map(|k| DVec2::from_angle(0.01 * f64::from(k + i))).collect());
    let lines: Vec<Polyline> = (0..40).map(circle).collect();
    stays(&at("lines.svg"), 50, |path, run| Polyline::save_all_on(&lines, path, run));
    stays(&at("lines.dxf"), 50, |path, run| Polyline::save_all_on(&lines, path, run));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), formats.len() + others, "nothing else is left");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn threads_do_not_change_pictures_of_numbers() {
    let scene = part().scene().unwrap();
    let layers = scene.layers(&Camera::framing(&scene.bounds()), 97, 61, &Run::default()).unwrap();
    let range = layers.range_image();
    assert_eq!(range.depth(), &layers.depth());
    for (x, y) in [(48, 30), (3, 2), (96, 60)] {
        let seen = layers.mask().pixel(x, y).unwrap();
        assert_eq!(layers.depth().pixel(x, y).unwrap().is_finite(), seen);
        assert_eq!(layers.owner().pixel(x, y).unwrap().is_some(), seen);
        assert_eq!(layers.normal().pixel(x, y).unwrap() != Vec3::ZERO, seen);
    }
    let noise = Noise { deviation: 0.01, missing: 0.1, seed: 7 };
    let noisy = [1, 2, 3].map(|threads| range.with_noise_on(&noise, &Run { threads, ..Run::default() }).unwrap());
    assert!(noisy[0] == noisy[1] && noisy[1] == noisy[2]);
    assert!(noisy[0].points(Coordinates::Camera).unwrap().normals().is_some());
}
