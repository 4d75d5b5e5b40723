//! Whole parts from meshes.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use glam::{DVec3, Vec3};
use rvachev::fit::{FitError, PartFit, PartKinds, PartSettings, part, part_with};
use rvachev::{CancelToken, CellSize, Mesh, MeshSettings, Progress, Run, Solid};

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

#[test]
fn kinds_that_are_not_allowed_are_not_used() {
    let ball = Solid::sphere(10.0) | Solid::cuboid([30.0, 8.0, 8.0]);
    let mesh = meshed(&ball, 64);
    let with = part(&mesh, &PartSettings::default()).unwrap();
    assert!(with.leaves().iter().any(|leaf| leaf.kind() == "sphere"), "{:?}", names(&with));
    let kinds = PartKinds { spheres: false, ..PartKinds::default() };
    let without = part(&mesh, &PartSettings { kinds, ..PartSettings::default() }).unwrap();
    assert!(without.leaves().iter().all(|leaf| leaf.kind() != "sphere"), "{:?}", names(&without));
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

    let settings = PartSettings { parameter_cost: f64::NAN, ..PartSettings::default() };
    let error = part(&block, &settings).unwrap_err();
    assert_eq!(error.to_string(), "parameter_cost is NaN; allowed: 0.000001 to 0.1");
}

/// Meshes of parts that are there for all, where the folder is.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts").join(format!("{name}.ply"));
    if !path.is_file() {
        println!("{} is not there: skipped", path.display());
    }
    path.is_file().then_some(path)
}

/// What is asked of a part: IoU, leaves at most, genus.
type Gate = (&'static str, f64, usize, i64);

fn judged((name, iou, leaves, genus): Gate) -> Option<PartFit> {
    let mesh = Mesh::load(shared(name)?).unwrap();
    let fit = part(&mesh, &PartSettings::default()).unwrap();
    assert!(fit.iou() >= iou, "{name}: IoU {}", fit.iou());
    assert!(fit.leaves().len() <= leaves, "{name}: {:?}", names(&fit));
    assert_eq!(fit.topology().genus, Some(genus), "{name}");
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

#[test]
fn parts_of_a_workshop() {
    for gate in [("unit_cube", 0.9999, 1, 0), ("7_8ths_cube", 0.9999, 2, 0), ("shaft", 0.99, 1, 0)] {
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
