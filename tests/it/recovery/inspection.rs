//! Scans compared with models.

use glam::DVec3;
use rvachev::fit::{FitError, RegisterSettings, inspect, register};
use rvachev::{Camera, CellSize, MeshSettings, PointCloud, RFunction, Solid};

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
    // Its top tells by how much, though most of its points are of its wall.
    assert!((boss.shift - DVec3::Z * 0.08).length() < 0.008 && boss.growth.abs() < 0.004, "{boss:?}");
    let plate = leaf("plate");
    assert!(!plate.is_off() && plate.sizes.rms < 0.01, "{} {:?}", plate.significance, plate.sizes);
    let points: usize = report.leaves().iter().map(|leaf| leaf.sizes.points).sum();
    assert_eq!(points, report.signed().len());
    assert_eq!(report.histogram(0.1, 8).unwrap().iter().sum::<usize>(), points);
    assert!(report.share_within(0.02).unwrap() > 0.8 && report.share_within(1.0).unwrap() == 1.0);
    let text = report.share_within(f64::NAN).unwrap_err().to_string();
    assert!(text.starts_with("tolerance is NaN"), "{text}");
    for reach in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let texts = [report.histogram(reach, 8).unwrap_err().to_string(), {
            let cloud = PointCloud::new(vec![DVec3::ZERO; points]).unwrap();
            report.colored(&cloud, reach).unwrap_err().to_string()
        }];
        assert!(texts.iter().all(|text| text.starts_with(&format!("reach is {reach}"))), "{texts:?}");
    }
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

#[test]
fn points_beyond_all_solids_are_refused() {
    for far in [1e10, 1e160, -1e300] {
        let points = PointCloud::new(vec![DVec3::X, DVec3::new(0.0, far, 0.0)]).unwrap();
        let error = inspect(&Solid::sphere(1.0), &points).unwrap_err();
        assert!(matches!(error, FitError::Extent { .. }) && error.to_string().contains("leave out"), "{error}");
        let many = (0..40).map(|i| DVec3::new(f64::from(i), far, f64::from(i * i % 7)));
        let many = PointCloud::new(many.collect()).unwrap();
        let error = register(&Solid::cuboid([1.0, 2.0, 3.0]), &many, &RegisterSettings::default()).unwrap_err();
        assert!(matches!(error, FitError::Extent { .. }), "{error}");
    }
}

#[test]
fn reports_are_json_without_minus_zero() {
    let points = vec![DVec3::X * 2.0, DVec3::Y * 2.0, DVec3::Z * -2.0];
    let report = inspect(&Solid::sphere(2.0).named("a \"b\"\\"), &PointCloud::new(points).unwrap()).unwrap();
    assert!(report.signed().iter().all(|d| d.is_sign_positive()), "{:?}", report.signed());
    let text = report.to_json();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    assert!(!text.contains("-0.0") && !text.contains('\n'), "{text}");
    assert_eq!(json["points"], 3);
    assert_eq!(json["leaves"][0]["path"], "a \"b\"\\: sphere");
    assert_eq!(json["leaves"][0]["shift"].as_array().map(Vec::len), Some(3));
    let report = inspect(&plate(0.0, 0.0), &scan(&plate(0.06, 0.08), 0.005)).unwrap();
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    let off = json["leaves"].as_array().unwrap().iter().filter(|leaf| leaf["is_off"] == true);
    let names: Vec<&str> = off.filter_map(|leaf| leaf["path"].as_str()).collect();
    assert!(names.len() == 2 && names.iter().all(|path| path.contains("boss") || path.contains("hole")), "{names:?}");
}

#[test]
fn deviations_are_drawn_beside_their_colours() {
    let cloud = scan(&plate(0.06, 0.08), 0.005);
    let report = inspect(&plate(0.0, 0.0), &cloud).unwrap();
    let camera = Camera::framing(&plate(0.0, 0.0).bounds().unwrap());
    let picture = report.picture(&cloud, 0.08, &camera, 480, 320).unwrap();
    let is_red = |[r, g, b, _]: &[u8; 4]| *r == 255 && *g == *b && *g < 100;
    // The boss is red, and so is the upper end of the bar.
    assert!(picture.pixels().iter().filter(|pixel| is_red(pixel)).count() > 200);
    let bar = (0..320).filter_map(|y| picture.pixel(437, y)).filter(|[r, g, b, _]| *r == 255 || *b == 255 && r == g);
    assert!(bar.count() > 250);
    let refused = |reach, width| report.picture(&cloud, reach, &camera, width, 10).unwrap_err().to_string();
    assert!(refused(0.0, 10).contains("reach") && refused(f64::NAN, 10).contains("reach"));
    assert!(refused(1.0, 0).contains("width") && report.picture(&cloud, 1.0, &camera, 1, 1).is_ok());
    let other = PointCloud::new(vec![DVec3::ZERO]).unwrap();
    assert!(matches!(report.picture(&other, 1.0, &camera, 9, 9), Err(FitError::Points(_))));
}
