//! Poses of parts in scans.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rvachev::fit::{FitError, RegisterSettings, Registration, inspect, register, register_with};
use rvachev::{CellSize, MeshSettings, PointCloud, Run, Solid};

use super::clouds::{Condition, normals, rotation, strew};
use crate::support::Random;

/// A block with three cylinders on it, all of it random: nothing about it repeats.
fn part(random: &mut Random) -> Solid {
    let mut part = Solid::cuboid([random.range(3.0, 5.0), random.range(2.0, 3.0), random.range(0.8, 1.6)]);
    for _ in 0..3 {
        let pin = Solid::cylinder(random.range(0.3, 0.7), random.range(1.5, 4.0));
        let turned = if random.chance(0.5) { pin } else { pin.rotate_y(rvachev::deg(90.0)) };
        part |= turned.translate(random.vector(-1.2, 1.2));
    }
    part
}

/// Points of the surface by area, with noise and strewn ones, moved.
fn scan(solid: &Solid, pose: DAffine3, noise: f64, strewn: f64, random: &mut Random) -> PointCloud {
    let mesh = solid.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() }).unwrap();
    let size = solid.bounds().unwrap().size().length();
    let triangles = mesh.triangles();
    let mut points: Vec<DVec3> = (0..1200)
        .map(|_| {
            let [a, b, c] = triangles[random.below(triangles.len())].map(|v| mesh.positions()[v as usize].as_dvec3());
            let (s, t) = (random.unit().sqrt(), random.unit());
            pose.transform_point3(a * (1.0 - s) + b * (s * (1.0 - t)) + c * (s * t) + noise * size * normals(random))
        })
        .collect();
    let condition = Condition { strewn, ..Condition::default() };
    strew(&mut points, condition, 0.0, random);
    PointCloud::new(points).unwrap()
}

/// How far corners of the box come to lie from where they are, in sizes of the box.
fn off(solid: &Solid, pose: DAffine3, found: &Registration) -> f64 {
    let bounds = solid.bounds().unwrap();
    let place = DAffine3::from_scale_rotation_translation(DVec3::splat(found.scale), found.rotation, found.translation);
    let away = |p: DVec3| place.transform_point3(p).distance(pose.transform_point3(p));
    let scale = pose.matrix3.determinant().cbrt();
    bounds.corners().into_iter().map(away).fold(0.0, f64::max) / (bounds.size().length() * scale)
}

fn pose(random: &mut Random, scale: f64) -> DAffine3 {
    let turn = DQuat::from_mat3(&rotation(random));
    DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, random.vector(-5.0, 5.0))
}

/// How many of random parts come out right, and whether all others say so.
fn right(count: u64, seed: u64, noise: f64, strewn: f64, scaled: bool) -> usize {
    let mut right = 0;
    for i in 0..count {
        let mut random = Random::new(seed + i);
        let part = part(&mut random);
        let scale = if scaled { random.range(0.4, 2.5) } else { 1.0 };
        let pose = pose(&mut random, scale);
        let cloud = scan(&part, pose, noise, strewn, &mut random);
        let settings = RegisterSettings { scale: scaled, ..RegisterSettings::default() };
        let found = register(&part, &cloud, &settings).unwrap();
        let away = off(&part, pose, &found);
        println!("{i}: {away:.4}, cost {:.3}, noise {:.4}", found.cost, found.noise);
        right += usize::from(away < 0.02);
        assert!(away < 0.02 || found.cost > strewn + 0.04, "{i}: {away} at a cost of {}", found.cost);
    }
    right
}

#[test]
fn parts_are_found_from_any_rotation() {
    assert!(right(4, 40, 0.002, 0.0, false) == 4);
    assert!(right(4, 80, 0.01, 0.2, false) >= 3);
    assert!(right(3, 120, 0.005, 0.1, true) >= 2);
}

#[test]
#[ignore = "a minute: the figures of the documentation"]
fn sixty_parts_a_condition() {
    for (name, noise, strewn, scaled) in
        [("clean", 0.0, 0.0, false), ("1 % noise, 20 % outliers", 0.01, 0.2, false), ("scaled", 0.005, 0.2, true)]
    {
        println!("{name}: {} of 60", right(60, 1000, noise, strewn, scaled));
    }
}

#[test]
fn a_registered_scan_can_be_inspected() {
    let mut random = Random::new(3);
    let part = part(&mut random);
    let pose = pose(&mut random, 1.0);
    let cloud = scan(&part, pose, 0.001, 0.0, &mut random);
    let found = register(&part, &cloud, &RegisterSettings::default()).unwrap();
    let report = inspect(&found.place(&part), &cloud).unwrap();
    let size = part.bounds().unwrap().size().length();
    assert!(report.sizes().median < 0.002 * size, "{:?}", report.sizes());
    assert!(found.covariance.deviation("turn x").unwrap() < 0.01);
}

/// A turn of a ball is free, and the covariance says so; a cylinder's is about its axis.
#[test]
fn free_turns_are_told() {
    let cloud = scan(&Solid::cylinder(1.0, 4.0), DAffine3::IDENTITY, 0.002, 0.0, &mut Random::new(5));
    let found = register(&Solid::cylinder(1.0, 4.0), &cloud, &RegisterSettings::default()).unwrap();
    let turn = |name: &str| found.covariance.deviation(name).unwrap();
    assert!(turn("turn z") > 20.0 * turn("turn x"), "{} {}", turn("turn z"), turn("turn x"));
    assert!(DMat3::from_quat(found.rotation).z_axis.z.abs() > 0.999);
}

#[test]
fn threads_and_cancelling() {
    let mut random = Random::new(8);
    let part = part(&mut random);
    let cloud = scan(&part, pose(&mut random, 1.0), 0.005, 0.1, &mut random);
    let settings = RegisterSettings::default();
    let found =
        [1, 2, 8].map(|threads| register_with(&part, &cloud, &settings, &Run { threads, ..Run::default() }).unwrap());
    assert!(found.iter().all(|f| f.rotation == found[0].rotation && f.covariance == found[0].covariance));
    let run = Run::default();
    run.cancel.cancel();
    assert!(matches!(register_with(&part, &cloud, &settings, &run), Err(FitError::Cancelled(_))));
    let few = PointCloud::new(vec![DVec3::X; 5]).unwrap();
    assert!(matches!(register(&part, &few, &settings), Err(FitError::TooFew { .. })));
    let flat = PointCloud::new((0..50).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 7), 0.0)).collect()).unwrap();
    assert!(matches!(register(&part, &flat, &settings), Err(FitError::Flat { .. })));
}
