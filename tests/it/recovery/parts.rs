//! Whole parts from meshes.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rvachev::fit::{FitError, PartFit, PartKinds, PartLeaf, PartSettings, part, part_with};
use rvachev::{
    CancelToken, CellSize, Gielis, Mesh, MeshSettings, MeshSolid, Profile, Progress, RFunction, Run, Solid, Supershape,
};

fn meshed(solid: &Solid, cells: u32) -> Mesh {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    solid.mesh(&settings).unwrap()
}

fn recovered(solid: &Solid) -> PartFit {
    part(&meshed(solid, 96), &PartSettings::default()).unwrap()
}

fn names(fit: &PartFit) -> Vec<&str> {
    fit.leaves().iter().map(|leaf| leaf.name()).collect()
}

/// Whether a part is right in the large.
fn assert_right(fit: &PartFit, least: f64) {
    assert!(fit.iou() >= least, "IoU {}: {:?}", fit.iou(), names(fit));
    assert_eq!(fit.topology(), fit.topology_of_input(), "{:?}", names(fit));
}

#[test]
fn a_tube_is_a_cylinder_and_a_bore() {
    let fit = recovered(&(Solid::cylinder(10.0, 30.0) - Solid::cylinder(8.0, 40.0)));
    assert_eq!(names(&fit), ["cylinder 1", "cut cylinder 1"]);
    assert_right(&fit, 0.99);
    assert_eq!(fit.parameters(), 14);
    assert!(fit.unexplained().is_empty(), "{:?}", fit.unexplained());
}

#[test]
fn a_boss_keeps_the_hole_through_it() {
    let boss = Solid::cylinder(7.0, 20.0).translate([8.0, 0.0, 10.0]);
    let hole = Solid::cylinder(4.0, 60.0).translate([8.0, 0.0, 0.0]);
    let fit = recovered(&((Solid::cuboid([50.0, 30.0, 6.0]) | boss) - hole));
    assert_eq!(fit.leaves().len(), 3, "{:?}", names(&fit));
    assert_right(&fit, 0.99);
}

#[test]
fn a_counterbored_plate_turned_anyhow() {
    let bore = |x: f64| {
        let wide = Solid::cylinder(5.0, 6.0).translate([x, 0.0, 5.0]);
        (Solid::cylinder(3.0, 40.0).translate([x, 0.0, 0.0]), wide)
    };
    let [(a, b), (c, d)] = [bore(-12.0), bore(12.0)];
    let plate = Solid::cuboid([50.0, 24.0, 10.0]) - a - b - c - d;
    let turned =
        plate.rotate_about(DVec3::new(1.0, 2.0, 0.5).normalize(), rvachev::deg(40.0)).translate([100.0, -7.0, 3.0]);
    let fit = recovered(&turned);
    assert_right(&fit, 0.985);
    assert!(fit.leaves().len() <= 6, "{:?}", names(&fit));
    assert_eq!(fit.leaves().iter().filter(|leaf| leaf.is_cut() && leaf.kind() == "cylinder").count(), 4);
}

/// Less than directions are settled by while planes and cylinders are looked for.
#[test]
fn axes_are_as_vertices_tell_them() {
    let plate = Solid::cuboid([60.0, 40.0, 8.0]) - Solid::cylinder(6.0, 20.0).translate([12.0, 4.0, 0.0]);
    let about = DVec3::new(2.0, -1.0, 1.0).normalize();
    let turned = |degrees: f64| plate.rotate_about(about, rvachev::deg(degrees));
    // Of small facets, and of large ones.
    for (degrees, cell, near) in [(0.3, CellSize::LongestSide(96), 0.02), (0.006, CellSize::Tolerance(0.02), 1e-3)] {
        let mesh = turned(degrees).mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap();
        let settings = PartSettings { snap: false, ..PartSettings::default() };
        let [fit, free] = [PartSettings::default(), settings].map(|settings| part(&mesh, &settings).unwrap());
        assert_eq!(names(&fit), ["box 1", "cut cylinder 1"]);
        assert!(fit.snaps().iter().all(|snap| snap.measure != "turn"), "{degrees}: {:?}", fit.snaps());
        // Of facets that are chords only vertices tell the radius of the bore.
        for (fit, near) in [(fit, near), (free, 0.02)] {
            let corner = turned(degrees).contains([29.99, 19.99, 3.99]).unwrap();
            assert!(corner == fit.solid().contains([29.99, 19.99, 3.99]).unwrap(), "{degrees}");
            let off =
                mesh.positions().iter().map(|p| fit.solid().closest_surface_point(p.as_dvec3()).unwrap().unwrap());
            let off = off.zip(mesh.positions()).map(|(q, p)| q.distance(p.as_dvec3())).fold(0.0, f64::max);
            assert!(off < near, "{degrees}: {off}, {:?}", fit.snaps());
        }
    }
}

/// A cylinder as programs write it: of so many facets, with its corners on the circle.
fn faceted(radius: f32, height: f32, facets: u32) -> Mesh {
    let corner = |i: u32, z: f32| {
        let angle = i as f32 * std::f32::consts::TAU / facets as f32;
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    let mut positions: Vec<Vec3> = (0..facets).flat_map(|i| [corner(i, 0.0), corner(i, height)]).collect();
    positions.extend([Vec3::ZERO, height * Vec3::Z]);
    let mut triangles = Vec::new();
    for i in 0..facets {
        let ([a, b], [c, d]) = ([2 * i, 2 * i + 1], [2 * ((i + 1) % facets), 2 * ((i + 1) % facets) + 1]);
        triangles.extend([[a, c, d], [a, d, b], [2 * facets, c, a], [2 * facets + 1, b, d]]);
    }
    Mesh::new(positions, triangles).unwrap()
}

#[test]
fn radii_are_those_of_corners_unless_it_is_refused() {
    let mesh = faceted(10.0, 25.0, 24);
    let laid = part(&mesh, &PartSettings::default()).unwrap();
    assert_eq!(names(&laid), ["cylinder 1"]);
    assert!((radii(&laid)[0] - 10.0).abs() < 1e-3, "{:?}", radii(&laid));
    let free = part(&mesh, &PartSettings { snap: false, ..PartSettings::default() }).unwrap();
    // A circle with the area of the facets.
    assert!((radii(&free)[0] - 9.94).abs() < 0.04, "{:?}", radii(&free));
    assert!(free.iou() > laid.iou());
}

#[test]
fn numbers_are_round_holes_go_through_and_patterns_are_one_leaf() {
    let disc = Solid::cylinder(30.0, 8.0);
    let pipe = Solid::cylinder(12.0, 30.0).translate([0.0, 0.0, 15.0]);
    let holes = Solid::cylinder(3.5, 20.0).translate([22.0, 0.0, 0.0]).repeat_polar(6);
    let flange = (disc | pipe) - Solid::cylinder(8.0, 80.0) - holes;
    let mesh = flange.mesh(&MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() }).unwrap();
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    assert_right(&fit, 0.99);
    let code = fit.solid().to_rust("flange");
    for words in ["repeat_polar(6)", "22.0", "3.5", "30.0", "8.0"] {
        assert!(code.contains(words), "{words}: {code}");
    }
    assert!(code.lines().count() < 32, "{code}");
    // Not a skin is left: looked through along each hole, there is nothing.
    for k in 0..6 {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 6.0).sin_cos();
        let from = DVec3::new(22.0 * cos, 22.0 * sin, 50.0);
        assert_eq!(fit.solid().raycast(from, -DVec3::Z).unwrap(), None, "{k}: {code}");
    }
    // What was changed can be taken back.
    let snap = fit.snaps().iter().position(|snap| snap.measure == "diameter").expect("one was not round");
    let (found, meant) = (fit.snaps()[snap].found, fit.snaps()[snap].meant);
    assert!((found - meant).abs() < 0.01, "{found} for {meant}");
    let kept = fit.without_snaps(&[snap]);
    assert_ne!(kept.solid(), fit.solid());
    assert_eq!(kept.snaps().len() + 1, fit.snaps().len());
}

/// The code of the holder, as it is written: a part of the tests. `BLESS=1` writes it anew.
#[rustfmt::skip]
mod holder;

#[test]
fn a_holder_is_code_in_binary_fractions_of_an_inch() {
    let Some(mesh) = shared("holder") else { return };
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    let code = fit.to_rust("holder");
    if std::env::var_os("BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/recovery/parts/holder.rs");
        std::fs::write(path, &code).unwrap();
    }
    assert!(code.lines().count() <= 40, "{code}");
    let plain: Vec<&str> = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let words = plain.iter().flat_map(|line| line.split(|c: char| !(c.is_ascii_digit() || c == '.')));
    let numbers = words.filter(|word| word.contains('.') && !word.starts_with('.') && !word.ends_with('.'));
    let mut seen = Vec::new();
    for number in numbers.map(|word| word.parse::<f64>().unwrap()) {
        let parts = number / 25.4 * 64.0;
        assert!((parts - parts.round()).abs() < 1e-9, "{number}: {code}");
        assert!(!seen.contains(&number) || number == 0.0, "{number} twice: {code}");
        seen.push(number);
    }
    assert_eq!(code, include_str!("parts/holder.rs"), "written anew by BLESS=1");
    assert_eq!(holder::holder(), fit.solid());
}

#[test]
fn what_is_round_in_no_simple_way_is_a_superellipsoid() {
    let blob = Solid::superellipsoid([9.0, 6.0, 7.0], 0.6, 1.3).translate([0.0, 0.0, 6.0]);
    let fit = recovered(&(Solid::cuboid([40.0, 24.0, 4.0]) | blob));
    assert_right(&fit, 0.98);
    assert!(fit.leaves().iter().any(|leaf| leaf.kind() == "superellipsoid"), "{:?}", names(&fit));
}

#[test]
fn round_sides_of_outlines_are_arcs() {
    // Two discs in a belt.
    let cosine = 0.375_f64;
    let sine = (1.0 - cosine * cosine).sqrt();
    let touch = |x: f64, r: f64, side: f64| [x + r * cosine, side * r * sine];
    let belt = [touch(0.0, 10.0, -1.0), touch(16.0, 4.0, -1.0), touch(16.0, 4.0, 1.0), touch(0.0, 10.0, 1.0)];
    let discs = [Profile::circle(10.0), Profile::circle(4.0).translate([16.0, 0.0])];
    let cam = Profile::union_all([Profile::polygon(belt)].into_iter().chain(discs), RFunction::MIN_MAX).extrude(6.0);
    let mesh = cam.mesh(&MeshSettings { cell: CellSize::Tolerance(0.02), ..MeshSettings::default() }).unwrap();
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    assert_eq!(names(&fit), ["profile 1"], "{}", fit.solid());
    assert_right(&fit, 0.995);
    assert!(fit.parameters() <= 24 && fit.leaves()[0].text().contains("arcs"), "{}", fit.leaves()[0].text());
}

#[test]
fn what_is_round_with_arms_is_a_supershape() {
    let star = Supershape::new(Gielis::new(5.0, 2.0, 4.0, 4.0), Gielis::circle()).scaled([12.0; 3]);
    let mesh = meshed(&star.into(), 48);
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    assert_eq!(names(&fit), ["solid supershape 1"]);
    assert_right(&fit, 0.98);
    let kinds = PartKinds { supershapes: false, ..PartKinds::default() };
    let without = part(&mesh, &PartSettings { kinds, ..PartSettings::default() }).unwrap();
    assert!(without.iou() < fit.iou(), "{}", without.iou());
}

#[test]
fn kinds_that_are_not_allowed_are_not_used() {
    let ball = Solid::sphere(10.0) | Solid::cuboid([30.0, 8.0, 8.0]);
    let mesh = meshed(&ball, 64);
    let with = part(&mesh, &PartSettings::default()).unwrap();
    assert!(with.leaves().iter().any(|leaf| leaf.kind() == "sphere"), "{:?}", names(&with));
    let kinds = PartKinds { spheres: false, superellipsoids: false, supershapes: false, ..PartKinds::default() };
    let without = part(&mesh, &PartSettings { kinds, ..PartSettings::default() }).unwrap();
    let refused = ["sphere", "superellipsoid", "solid supershape"];
    assert!(without.leaves().iter().all(|leaf| !refused.contains(&leaf.kind())), "{:?}", names(&without));
    assert!(without.iou() < with.iou());
    assert!(!without.unexplained().is_empty());
}

#[test]
fn results_depend_on_the_seed_only() {
    let mesh = meshed(&(Solid::cuboid([20.0, 20.0, 10.0]) - Solid::cone(2.0, 6.0, 12.0)), 48);
    let texts: Vec<String> = [1, 2]
        .map(|threads| {
            let run = Run { threads, ..Run::default() };
            let fit = part_with(&mesh, &PartSettings::default(), &run).unwrap();
            format!("{} {:?} {:?}", fit.solid(), fit.iou(), fit.deviation())
        })
        .to_vec();
    assert_eq!(texts[0], texts[1]);
}

#[test]
fn a_run_tells_and_stops() {
    let mesh = meshed(&(Solid::cuboid([20.0, 20.0, 10.0]) - Solid::cylinder(4.0, 12.0)), 48);
    let heard = Arc::new(Mutex::new(Vec::new()));
    let sink = heard.clone();
    let run = Run { progress: Some(Progress::new(move |f| sink.lock().unwrap().push(f))), ..Run::default() };
    part_with(&mesh, &PartSettings::default(), &run).unwrap();
    let told = heard.lock().unwrap().clone();
    assert!(told.len() > 5 && told.is_sorted() && told.last() == Some(&1.0), "{told:?}");

    for stop in [0.0, 0.2, 0.5, 0.8] {
        let cancel = CancelToken::default();
        let token = cancel.clone();
        let progress = Progress::new(move |f| {
            if f >= stop {
                token.cancel()
            }
        });
        let run = Run { cancel, progress: Some(progress), ..Run::default() };
        let result = part_with(&mesh, &PartSettings::default(), &run);
        assert!(matches!(result, Err(FitError::Cancelled(_))), "from {stop}");
    }
}

#[test]
fn what_is_no_solid_is_told() {
    let block = meshed(&Solid::cuboid([2.0, 2.0, 2.0]), 8);
    let inwards: Vec<[u32; 3]> = block.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let inwards = Mesh::new(block.positions().to_vec(), inwards).unwrap();
    let error = part(&inwards, &PartSettings::default()).unwrap_err();
    assert!(error.to_string().contains("turn them round"), "{error}");

    let flat = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let flat = Mesh::new(flat.to_vec(), vec![[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]).unwrap();
    assert!(matches!(part(&flat, &PartSettings::default()), Err(FitError::Flat { .. })));
    let none = Mesh::new(Vec::new(), Vec::new()).unwrap();
    assert!(matches!(part(&none, &PartSettings::default()), Err(FitError::TooFew { .. })));

    // Its leaves might be smaller than solids may be.
    let tiny = block.positions().iter().map(|p| 1e-6 * *p).collect();
    let tiny = Mesh::new(tiny, block.triangles().to_vec()).unwrap();
    assert!(matches!(part(&tiny, &PartSettings::default()), Err(FitError::Extent { .. })));

    let settings = PartSettings { parameter_cost: f64::NAN, ..PartSettings::default() };
    let error = part(&block, &settings).unwrap_err();
    assert_eq!(error.to_string(), "parameter_cost is NaN; allowed: 0.000001 to 0.1");
}

/// Meshes of parts that are there for all, where the folder is.
fn shared(name: &str) -> Option<Mesh> {
    loaded(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts").join(format!("{name}.ply")))
}

#[cfg(feature = "import")]
pub(super) fn loaded(path: &Path) -> Option<Mesh> {
    if !path.is_file() {
        println!("{} is not there: skipped", path.display());
        return None;
    }
    Some(Mesh::load(path).unwrap())
}

#[cfg(not(feature = "import"))]
pub(super) fn loaded(path: &Path) -> Option<Mesh> {
    println!("{} is not read without the feature import: skipped", path.display());
    None
}

/// What is asked of a part: IoU, leaves at most, genus.
type Gate = (&'static str, f64, usize, i64);

fn judged((name, iou, leaves, genus): Gate) -> Option<PartFit> {
    let mesh = shared(name)?;
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    assert!(fit.iou() >= iou, "{name}: IoU {}", fit.iou());
    assert!(fit.leaf_count() <= leaves, "{name}: {:?}", names(&fit));
    assert_eq!(fit.topology().genus, Some(genus), "{name}");
    assert_eq!(fit.topology(), fit.topology_of_input(), "{name}");
    Some(fit)
}

fn radii(fit: &PartFit) -> Vec<f64> {
    let radius = |solid: Solid| {
        let text = solid.to_string();
        let from = text.find("radius: ").map(|at| at + 8)?;
        text[from..].split([',', ' ']).next()?.parse().ok()
    };
    fit.leaves().iter().filter_map(|leaf| radius(leaf.solid())).collect()
}

/// The volume in common over that of either, on 2²⁰ evenly spread points in the mesh's box and 1.5
/// % about it.
fn iou(mesh: &Mesh, fit: &PartFit) -> f64 {
    let truth = Solid::from_mesh(mesh, MeshSolid::default());
    let (bounds, margin) = (mesh.bounds(), 0.015 * mesh.bounds().size());
    let (low, size) = (bounds.min - margin, bounds.size() + 2.0 * margin);
    // The additive recurrence of the plastic constant's sister in three dimensions (M. Roberts,
    // 2018).
    let steps = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3);
    let points: Vec<DVec3> = (1..=1_u32 << 20).map(|i| low + size * (f64::from(i) * steps).fract()).collect();
    let [there, found] = [truth, fit.solid()].map(|solid| sides(&solid, &points));
    let pairs = || there.iter().zip(&found);
    pairs().filter(|(a, b)| **a && **b).count() as f64 / pairs().filter(|(a, b)| **a || **b).count() as f64
}

/// Whether points are inside.
pub(super) fn sides(solid: &Solid, points: &[DVec3]) -> Vec<bool> {
    points.par_chunks(4096).flat_map_iter(|points| solid.contains_all(points).unwrap()).collect()
}

#[test]
fn parts_of_a_workshop() {
    // A block with planes cut off would do for the wedge of the angle block, but in more leaves.
    let quick = [("7_8ths_cube", 0.9999, 2, 0), ("lasercut_interface", 0.999, 9, 8), ("angle_block", 0.999, 8, 1)];
    for gate in quick {
        judged(gate);
    }
    // A tube: its IoU is with 36 facets, whose sagitta is 3 % of the wall.
    if let Some(fit) = judged(("round", 0.96, 2, 1)) {
        for (found, true_radius) in radii(&fit).into_iter().zip([2.54, 2.2352]) {
            assert!((found - true_radius).abs() < 1e-3, "{found}");
        }
    }
    if let Some(fit) = judged(("holder", 0.99, 10, 5)) {
        for radius in radii(&fit) {
            let diameter = 2.0 * radius / 25.4;
            let meant = [3.0, 1.0, 0.75, 0.5].into_iter().map(|d| f64::abs(d - diameter)).fold(1.0, f64::min);
            assert!(meant < 1e-4, "{diameter} inches");
        }
    }
}

/// How much the radius of a conical hole grows by length, by its text.
fn slope(leaf: &PartLeaf) -> f64 {
    let numbers: Vec<f64> = leaf.text().split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [wide, narrow, length] => 0.5 * f64::abs(wide - narrow) / length,
        // Down to a point.
        [wide, length] => 0.5 * wide / length,
        _ => panic!("{}", leaf.text()),
    }
}

/// All that are there, with what is asked of them.
const ALL: [(Gate, bool); 15] = [
    (("unit_cube", 0.9999, 1, 0), true),
    (("7_8ths_cube", 0.9999, 2, 0), true),
    (("shaft", 0.99, 1, 0), true),
    (("round", 0.955, 2, 1), true),
    (("bushing_roller", 0.99, 2, 1), true),
    (("xtion_bracket", 0.99, 4, 2), true),
    (("camshaft", 0.99, 7, 0), false),
    (("camshaft", 0.99, 7, 0), true),
    (("angle_block", 0.99, 8, 1), true),
    (("satellite_mount", 0.99, 9, 8), true),
    (("lasercut_interface", 0.999, 9, 8), true),
    (("holder", 0.99, 10, 5), true),
    (("plate_holes", 0.98, 10, 5), true),
    (("machinist", 0.99, 8, 36), true),
    (("octagonal_pocket", 0.97, 34, 1), true),
];

#[test]
#[ignore = "a minute: the table of the documentation"]
fn all_parts_of_a_workshop() {
    println!("| mesh | IoU | leaves (parameters) | genus, mesh's | CPU s |");
    println!("|---|---|---|---|---|");
    for ((name, least, leaves, genus), snap) in ALL {
        let Some(mesh) = shared(name) else { return };
        let run = Run { threads: 1, ..Run::default() };
        let settings = PartSettings { snap, ..PartSettings::default() };
        let time = cpu_time::ProcessTime::now();
        let fit = part_with(&mesh, &settings, &run).unwrap();
        let seconds = time.elapsed().as_secs_f64();
        let iou = iou(&mesh, &fit);
        let counts = format!("{} ({})", fit.leaf_count(), fit.parameters());
        let [found, given] = [fit.topology(), fit.topology_of_input()].map(|topology| topology.genus.unwrap_or(-1));
        let how = if snap { "" } else { ", not snapped" };
        println!("| {name}{how} | {iou:.4} | {counts} | {found}, {given} | {seconds:.2} |");
        assert!(iou >= least && fit.leaf_count() <= leaves && found == genus, "{name}");
        assert_eq!(fit.topology(), fit.topology_of_input(), "{name}");
        if name == "plate_holes" {
            let sinks = || fit.leaves().iter().filter(|leaf| leaf.is_cut() && leaf.kind() == "cone");
            assert_eq!(sinks().count(), 4, "countersinks");
            assert!(sinks().all(|sink| (slope(sink) - 0.86).abs() <= 0.03), "{:?}", names(&fit));
        }
    }
}

/// The folder where fifty random parts are that the generator's scripts make as they are now, or
/// were made, if that is possible.
pub(super) fn random_parts() -> Option<PathBuf> {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/tools/generators");
    let mut texts = DefaultHasher::new();
    for script in ["leaf.py", "parts.py", "write.py"] {
        std::fs::read(scripts.join(script)).unwrap_or_default().hash(&mut texts);
    }
    let folder = std::env::temp_dir().join(format!("rvachev_random_parts_{:016x}", texts.finish()));
    if folder.is_dir() {
        return Some(folder);
    }
    // What is half made has another name.
    let begun = folder.with_extension(std::process::id().to_string());
    let script = scripts.join("write.py");
    let made = std::process::Command::new("python3").arg(script).args(["parts", "50", "0"]).arg(&begun).status();
    let is_made = made.is_ok_and(|status| status.success()) && std::fs::rename(&begun, &folder).is_ok();
    if !is_made {
        println!("the generator does not run: skipped");
    }
    is_made.then_some(folder)
}

#[test]
#[ignore = "minutes, and wants Python with numpy, scipy, trimesh, numba, matplotlib and scikit-image: random parts"]
fn fifty_random_parts() {
    let Some(folder) = random_parts() else { return };
    let (mut right, mut same, mut few) = (0, 0, 0);
    for i in 0..50 {
        let Some(mesh) = loaded(&folder.join(format!("{i:03}.ply"))) else { return };
        let fit = part(&mesh, &PartSettings::default()).unwrap();
        let [found, given] = [fit.topology(), fit.topology_of_input()];
        let iou = iou(&mesh, &fit);
        println!("{i:03}: IoU {iou:.4}, {} leaves, genus {:?}, {:?}", fit.leaf_count(), found.genus, given.genus);
        right += usize::from(iou >= 0.97);
        same += usize::from(found.genus == given.genus);
        few += usize::from(fit.leaf_count() <= 12);
    }
    println!("IoU ≥ .97: {right}, genus: {same}, ≤ 12 leaves: {few}");
    assert!(right >= 49 && same >= 47, "{right}, {same}");
}
