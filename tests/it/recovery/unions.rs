//! Unions of truncated supershapes from segmented surfaces: the paper's pipeline.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use rvachev::fit::{FitError, FitSettings, Segments, UnionFit, UnionSettings, supershape_union, supershape_union_with};
use rvachev::{CellSize, Gielis, Mesh, MeshSettings, PointCloud, RFunction, Radius, Run, Solid, Supershape, deg};

use super::clouds::normals;
use crate::support::Random;

fn mesh(solid: &Solid) -> Mesh {
    solid.mesh(&MeshSettings { cell: CellSize::LongestSide(48), ..MeshSettings::default() }).unwrap()
}

fn fitted(segments: &Segments) -> UnionFit {
    supershape_union(segments, &UnionSettings::default()).unwrap()
}

/// The volume of what is in both over that of what is in either.
fn overlap(truth: &Solid, found: &Solid) -> f64 {
    let bounds = truth.bounds().unwrap();
    let mut random = Random::new(1);
    let (middle, reach) = (bounds.center(), 0.55 * bounds.size());
    let points: Vec<DVec3> = (0..20_000).map(|_| middle + reach * random.vector(-1.0, 1.0)).collect();
    let (a, b) = (truth.contains_all(&points).unwrap(), found.contains_all(&points).unwrap());
    let count = |of: fn(bool, bool) -> bool| a.iter().zip(&b).filter(|(a, b)| of(**a, **b)).count();
    count(|a, b| a && b) as f64 / count(|a, b| a || b) as f64
}

/// How many points each label has.
fn sizes(segments: &Segments) -> Vec<usize> {
    let mut sizes = BTreeMap::new();
    segments.labels().iter().for_each(|label| *sizes.entry(*label).or_insert(0) += 1);
    sizes.into_values().collect()
}

fn pin_on_plate() -> Solid {
    let pin = Solid::cylinder(0.5, 2.0).translate([0.3, 0.2, 1.0]);
    (Solid::cuboid([3.0, 2.0, 1.0]) | pin).rotate_x(deg(20.0)).rotate_z(deg(33.0)).translate([1.0, 2.0, 3.0])
}

/// Check F5 of the reference: a box less a cylinder, both superellipsoids, joined by R_p with p =
/// 2.
#[test]
fn a_box_less_a_cylinder_has_the_signs_of_the_reference() {
    let part = Solid::superellipsoid([1.0, 1.0, 0.6], 0.01, 0.01)
        .difference(Solid::superellipsoid([0.4, 0.4, 1.0], 0.01, 1.0), RFunction::P(2.0));
    let at = |i: usize| -1.5 + 3.0 * i as f64 / 31.0;
    let points: Vec<DVec3> = (0..32 * 32 * 32).map(|i| DVec3::new(at(i % 32), at(i / 32 % 32), at(i / 1024))).collect();
    let (mut inside, mut wrong) = (0, 0);
    for (p, value) in points.iter().zip(part.values(&points).unwrap()) {
        let is_inside = p.x.abs() < 1.0 && p.y.abs() < 1.0 && p.z.abs() < 0.6 && p.truncate().length() > 0.4;
        inside += usize::from(value > 0.0);
        wrong += usize::from(value.abs() >= 0.02 && is_inside != (value > 0.0));
    }
    assert_eq!((wrong, inside), (0, 4176));
}

#[test]
fn a_box_with_a_hole_is_a_body_and_a_hole() {
    let part = Solid::cuboid([2.0, 2.0, 1.2]) - Solid::cylinder(0.4, 3.0);
    let part = part.rotate_y(deg(40.0)).translate([0.0, 5.0, 0.0]);
    let segments = Segments::of_mesh_by_creases(&mesh(&part), deg(40.0)).unwrap();
    assert_eq!(segments.count(), 1);
    let fit = fitted(&segments);
    assert_eq!((fit.parts().len(), fit.holes()), (1, 1));
    let error = fit.error();
    assert!(error.holes < 0.1 * error.bodies && error.refined <= error.holes, "{error:?}");
    let found = fit.solid();
    assert!(overlap(&part, &found) > 0.97, "{}", overlap(&part, &found));
    // The hole goes through, along its axis.
    let axis = DVec3::new(deg(40.0).sin_cos().0, 0.0, deg(40.0).sin_cos().1);
    let through = (-10..=10).map(|k| DVec3::new(0.0, 5.0, 0.0) + axis * 0.08 * f64::from(k));
    assert!(through.into_iter().all(|p| !found.contains(p).unwrap()));
    let owner = found.owner(DVec3::new(0.0, 5.4, 0.0)).unwrap();
    assert!(format!("{owner:?}").contains("hole 0.1"), "{owner:?}");
    let without = UnionSettings { holes: false, ..UnionSettings::default() };
    assert_eq!(supershape_union(&segments, &without).unwrap().holes(), 0);
}

#[test]
fn two_supershapes_joined_are_recovered_and_refined() {
    let star = Supershape::with(
        Gielis::new(5.0, 1.3, 1.1, 1.1),
        Gielis::new(4.0, 10.0, 10.0, 10.0),
        [1.6, 1.6, 0.5],
        Radius::Standard,
    );
    let part = Solid::from(star) | Solid::sphere(0.7).translate([0.0, 0.0, 0.6]);
    let segments = Segments::of_mesh_by_creases(&mesh(&part), deg(40.0)).unwrap();
    assert_eq!(segments.count(), 2);
    let fit = fitted(&segments);
    assert_eq!((fit.parts().len(), fit.holes()), (2, 0));
    assert!(fit.parts().iter().any(|part| part.body.leaf.equator().m == 5.0));
    assert!(overlap(&part, &fit.solid()) > 0.95, "{}", overlap(&part, &fit.solid()));
    let error = fit.error();
    assert!(error.refined < error.bodies && fit.refinement_steps() > 0, "{error:?}");
    // Eq. 15 of the same points is what was reported.
    let again = fit.error_of(segments.cloud(), &Run::default()).unwrap();
    assert!((again - error.refined).abs() < 1e-9 * (1.0 + error.refined));
}

/// Segments of which each was fitted alone fit better together.
#[test]
fn the_joint_refinement_lowers_the_error() {
    let segments = Segments::of_mesh_by_creases(&mesh(&pin_on_plate()), deg(40.0)).unwrap();
    let before = supershape_union(&segments, &UnionSettings { refinement: 0, ..UnionSettings::default() }).unwrap();
    let fit = fitted(&segments);
    assert_eq!((before.refinement_steps(), before.error().refined), (0, before.error().holes));
    assert!(fit.error().refined < 0.8 * before.error().refined, "{:?}", fit.error());
    assert!(fit.deviation().rms < 1.03 * before.deviation().rms);
    assert!(overlap(&pin_on_plate(), &fit.solid()) > 0.99);
}

/// Creases need not go around a segment, and a plane at the ground of a hole is none.
#[test]
fn creases_part_leaves() {
    let angle = Solid::cuboid([4.0, 2.0, 0.8]) | Solid::cuboid([0.8, 2.0, 3.0]).translate([-1.6, 0.0, 1.1]);
    let blind = Solid::cuboid([2.0, 2.0, 1.2]) - Solid::cylinder(0.5, 1.0).translate([0.1, 0.2, 0.5]);
    for (solid, count) in [(pin_on_plate(), 2), (angle, 2), (blind, 1), (Solid::cuboid([1.0, 2.0, 3.0]), 1)] {
        let segments = Segments::of_mesh_by_creases(&mesh(&solid), deg(40.0)).unwrap();
        assert_eq!(segments.count(), count, "{:?}", sizes(&segments));
        assert_eq!(segments.labels().len(), segments.cloud().len());
    }
}

/// Labels of a scan without normals, the wall of a hole among them.
#[test]
fn labelled_clouds_with_noise_and_a_labelled_hole() {
    let mut random = Random::new(4);
    let (mut points, mut labels) = (Vec::new(), Vec::new());
    while points.len() < 2400 {
        let mut p = random.vector(-1.0, 1.0);
        let k = random.below(3);
        p[k] = p[k].signum();
        if p.truncate().length() > 0.4 || k < 2 {
            points.push(p * DVec3::new(1.0, 1.0, 0.6));
            labels.push(7);
        }
    }
    for _ in 0..800 {
        let (sin, cos) = (std::f64::consts::TAU * random.unit()).sin_cos();
        points.push(DVec3::new(0.4 * cos, 0.4 * sin, random.range(-0.6, 0.6)));
        labels.push(9);
    }
    points.iter_mut().for_each(|p| *p += 0.004 * normals(&mut random));
    let cloud = PointCloud::new(points).unwrap();
    let fit = fitted(&Segments::of_cloud(&cloud, &labels).unwrap());
    assert_eq!((fit.parts().len(), fit.holes(), fit.parts()[0].label), (1, 1, 7));
    let truth = Solid::cuboid([2.0, 2.0, 1.2]) - Solid::cylinder(0.4, 3.0);
    assert!(overlap(&truth, &fit.solid()) > 0.95, "{}", overlap(&truth, &fit.solid()));
}

#[test]
fn the_same_bits_by_any_number_of_threads_and_cancelling() {
    let segments = Segments::of_mesh_by_creases(&mesh(&pin_on_plate()), deg(40.0)).unwrap();
    let settings = UnionSettings { refinement: 3, ..UnionSettings::default() };
    let told = |threads| {
        let fit = supershape_union_with(&segments, &settings, &Run { threads, ..Run::default() }).unwrap();
        (format!("{:?}", fit.parts()), fit.error(), fit.evaluations())
    };
    assert!(told(1) == told(3));
    let run = Run::default();
    run.cancel.cancel();
    assert!(matches!(supershape_union_with(&segments, &settings, &run), Err(FitError::Cancelled(_))));
}

#[test]
fn bad_input_is_told() {
    let told = |result: Result<UnionFit, FitError>| result.unwrap_err().to_string();
    let cloud =
        PointCloud::new((0..200).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 17), 0.0)).collect()).unwrap();
    let error = Segments::of_cloud(&cloud, &[1, 2]).unwrap_err();
    assert_eq!(error.to_string(), "2 labels for 200 points; one each is needed");
    let error = Segments::of_mesh(&mesh(&Solid::sphere(1.0)), &[0]).unwrap_err();
    assert!(matches!(error, FitError::Labels { labels: 1, of: "triangles", .. }));
    assert!(matches!(Segments::of_cloud_by_creases(&cloud, deg(40.0)), Err(FitError::NoNormals { points: 200 })));
    let error = Segments::of_mesh_by_creases(&mesh(&Solid::sphere(1.0)), deg(0.0)).unwrap_err();
    assert_eq!(error.to_string(), "crease is 0°; allowed: 1° to 90°");
    let flat = Segments::of_cloud(&cloud, &[3; 200]).unwrap();
    assert!(matches!(supershape_union(&flat, &UnionSettings::default()), Err(FitError::Flat { .. })));
    let none = Segments::of_cloud(&PointCloud::default(), &[]).unwrap();
    assert!(matches!(supershape_union(&none, &UnionSettings::default()), Err(FitError::TooFew { points: 0, .. })));
    let empty = Segments::of_mesh_by_creases(&Mesh::default(), deg(40.0)).unwrap();
    assert_eq!(empty.count(), 0);
    // One segment of two is flat.
    let mut random = Random::new(2);
    let mut points: Vec<DVec3> = (0..400).map(|_| random.direction()).collect();
    points.extend((0..100).map(|_| DVec3::new(random.range(1.0, 2.0), random.range(0.0, 1.0), 0.5)));
    let labels: Vec<u32> = (0..500).map(|i| u32::from(i >= 400)).collect();
    let both = Segments::of_cloud(&PointCloud::new(points).unwrap(), &labels).unwrap();
    let message = told(supershape_union(&both, &UnionSettings::default()));
    assert!(message.starts_with("segment 1: the 100 points that are a surface are all in one plane"), "{message}");
    for (settings, name) in [
        (UnionSettings { depth: f64::NAN, ..UnionSettings::default() }, "depth is NaN; allowed: 1 to 100"),
        (UnionSettings { refinement: 1001, ..UnionSettings::default() }, "refinement is 1001; allowed: 0 to 1000"),
    ] {
        assert_eq!(told(supershape_union(&both, &settings)), name);
    }
}

/// Whatever the points and labels are, there is a valid solid or an error.
#[test]
fn anything_gives_a_valid_union_or_an_error() {
    let mut random = Random::new(31);
    for round in 0..6 {
        let count = 100 + random.below(300);
        let scale = DVec3::new(1.0, 10f64.powf(random.range(-3.0, 0.0)), 10f64.powf(random.range(-3.0, 0.0)));
        let points: Vec<DVec3> = (0..count).map(|_| scale * random.vector(-1.0, 1.0)).collect();
        let normals: Vec<Vec3> = (0..count).map(|_| random.direction().as_vec3()).collect();
        let cloud = PointCloud::new(points).unwrap().with_normals(normals).unwrap();
        let labels: Vec<u32> = (0..count).map(|_| random.below(2) as u32).collect();
        let segments = match round % 2 {
            0 => Segments::of_cloud(&cloud, &labels),
            _ => Segments::of_cloud_by_creases(&cloud, deg(40.0)),
        };
        let settings = UnionSettings {
            refinement: 5,
            fit: FitSettings { search_points: 100, ..FitSettings::default() },
            ..UnionSettings::default()
        };
        match segments.and_then(|segments| supershape_union(&segments, &settings)) {
            Ok(fit) => assert!(fit.solid().bounds().is_ok() && fit.error().refined.is_finite(), "{round}"),
            Err(error) => assert!(!matches!(error, FitError::Solid(_)), "{round}: {error}"),
        }
    }
}
