//! Scans compared with models.

use glam::DVec3;
use rvachev::fit::{FitError, inspect};
use rvachev::{CellSize, MeshSettings, PointCloud, RFunction, Solid};

use super::clouds::normals;
use crate::support::Random;

/// A plate with a hole and a boss, the hole moved and the boss raised by these lengths.
fn plate(moved: f64, raised: f64) -> Solid {
    let plate = Solid::cuboid([20.0, 12.0, 2.0]).named("plate");
    let boss = Solid::cylinder(2.0, 4.0 + raised).translate([-5.0, 0.0, 2.0 + 0.5 * raised]).named("boss");
    let hole = Solid::cylinder(1.5, 8.0).translate([5.0 + moved, 0.0, 0.0]).named("hole");
    plate.union(&boss, RFunction::MIN_MAX).difference(&hole, RFunction::MIN_MAX)
}

/// Points of the surface with noise.
fn scan(solid: &Solid, noise: f64) -> PointCloud {
    let settings = MeshSettings { cell: CellSize::Length(0.25), ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let mut random = Random::new(6);
    // Vertices are on the surface; the middles of triangles are not where it is curved.
    let points = mesh.positions().iter().map(|p| p.as_dvec3() + noise * normals(&mut random));
    PointCloud::new(points.collect()).unwrap()
}

#[test]
fn a_moved_hole_and_a_high_boss_are_found() {
    let report = inspect(&plate(0.0, 0.0), &scan(&plate(0.06, 0.08), 0.005)).unwrap();
    let leaf = |name: &str| report.leaves().iter().find(|leaf| leaf.owner.path.contains(name)).unwrap();
    let hole = leaf("hole");
    assert!(hole.is_off() && (hole.shift - DVec3::X * 0.06).length() < 0.006, "{:?}", hole.shift);
    assert!(hole.median.abs() < 0.01 && hole.growth.abs() < 0.004, "{} {}", hole.median, hole.growth);
    let boss = leaf("boss");
    assert!(boss.is_off() && (boss.greatest.0 - 0.08).abs() < 0.03 && boss.greatest.1.z > 3.9, "{boss:?}");
    let plate = leaf("plate");
    assert!(!plate.is_off() && plate.sizes.rms < 0.01, "{} {:?}", plate.significance, plate.sizes);
    let points: usize = report.leaves().iter().map(|leaf| leaf.sizes.points).sum();
    assert_eq!(points, report.signed().len());
    assert_eq!(report.histogram(0.1, 8).iter().sum::<usize>(), points);
    assert!(report.share_within(0.02) > 0.8 && report.share_within(1.0) == 1.0);
}

#[test]
fn a_right_part_is_not_blamed() {
    let scan = scan(&plate(0.0, 0.0), 0.005);
    let report = inspect(&plate(0.0, 0.0), &scan).unwrap();
    assert!(report.leaves().iter().all(|leaf| !leaf.is_off()), "{:?}", report.leaves());
    assert!((report.sizes().rms - 0.005).abs() < 0.001, "{:?}", report.sizes());
    let colored = report.colored(&scan, 0.02).unwrap();
    assert_eq!(colored.colors().unwrap().len(), scan.len());
    assert!(report.colored(&PointCloud::new(vec![DVec3::ZERO]).unwrap(), 0.02).is_err());
}

#[test]
fn signs_are_positive_outside() {
    let points = PointCloud::new(vec![DVec3::X * 2.5, DVec3::Y * 1.75, DVec3::Z * -2.0]).unwrap();
    let report = inspect(&Solid::sphere(2.0), &points).unwrap();
    for (d, wanted) in report.signed().iter().zip([0.5, -0.25, 0.0]) {
        assert!((d - wanted).abs() < 1e-9, "{d}");
    }
    let error = inspect(&Solid::sphere(-2.0), &points).unwrap_err();
    assert!(matches!(error, FitError::Solid(_)), "{error}");
    assert!(inspect(&Solid::sphere(1.0), &PointCloud::new(Vec::new()).unwrap()).is_err());
}
