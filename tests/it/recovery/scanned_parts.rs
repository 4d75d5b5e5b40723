//! Whole parts from points.

use glam::{DVec3, Vec3};
use rvachev::fit::{FitError, PartFit, PartSettings, part_of_points, part_of_points_with};
use rvachev::surface::ParametricSurface;
use rvachev::{CancelToken, CellSize, Mesh, MeshSettings, PointCloud, Run, Solid};

/// splitmix64.
struct Numbers(u64);

impl Numbers {
    /// From 0 to below 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of mean 0 and variance 1.
    fn bell(&mut self) -> f64 {
        ((0..12).map(|_| self.unit()).sum::<f64>()) - 6.0
    }
}

fn meshed(solid: &Solid) -> Mesh {
    solid.mesh(&MeshSettings { cell: CellSize::LongestSide(80), ..MeshSettings::default() }).unwrap()
}

/// Points by area of a mesh with noise in all directions, and the normals of its triangles.
fn scanned(mesh: &Mesh, count: usize, noise: f64) -> (Vec<DVec3>, Vec<Vec3>) {
    let mut numbers = Numbers(7);
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions()[i as usize].as_dvec3());
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        (b - a).cross(c - a)
    };
    let areas: Vec<f64> = mesh.triangles().iter().map(|t| normal(t).length()).collect();
    let step = areas.iter().sum::<f64>() / count as f64;
    let (mut passed, mut next) = (0.0, 0.5 * step);
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    for (t, area) in mesh.triangles().iter().zip(&areas) {
        passed += area;
        while next < passed {
            next += step;
            let [a, b, c] = corners(t);
            let (u, v) = (numbers.unit(), numbers.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let off = noise * DVec3::new(numbers.bell(), numbers.bell(), numbers.bell());
            points.push(a + u * (b - a) + v * (c - a) + off);
            normals.push(normal(t).normalize().as_vec3());
        }
    }
    (points, normals)
}

fn bracket() -> Solid {
    let plate = Solid::cuboid([50.0, 30.0, 10.0]);
    let boss = Solid::cylinder(9.0, 20.0).translate([10.0, 0.0, 10.0]);
    (plate | boss) - Solid::cylinder(5.0, 60.0).translate([10.0, 0.0, 0.0])
}

fn kinds(fit: &PartFit) -> Vec<String> {
    fit.leaves().iter().map(|leaf| leaf.name().to_owned()).collect()
}

/// The volume in common with the truth, over that of either.
fn iou(fit: &PartFit, truth: &Solid) -> f64 {
    let (found, bounds) = (fit.solid(), truth.bounds().unwrap());
    let mut numbers = Numbers(1);
    let points: Vec<DVec3> = (0..20_000)
        .map(|_| bounds.min + bounds.size() * DVec3::new(numbers.unit(), numbers.unit(), numbers.unit()))
        .collect();
    let (mut both, mut either) = (0, 0);
    for p in points {
        let (a, b) = (found.contains(p).unwrap(), truth.contains(p).unwrap());
        both += i32::from(a && b);
        either += i32::from(a || b);
    }
    f64::from(both) / f64::from(either)
}

#[test]
fn a_scanned_bracket_is_three_leaves() {
    let truth = bracket();
    let mesh = meshed(&truth);
    for (noise, least) in [(0.0, 0.98), (0.12, 0.97)] {
        let (points, normals) = scanned(&mesh, 4000, noise);
        let cloud = PointCloud::new(points).unwrap();
        let bare = part_of_points(&cloud, &PartSettings::default()).unwrap();
        assert!(iou(&bare, &truth) > least - 0.01, "without normals {}: {:?}", iou(&bare, &truth), kinds(&bare));
        let cloud = cloud.with_normals(normals).unwrap();
        let fit = part_of_points(&cloud, &PartSettings::default()).unwrap();
        assert_eq!(fit.leaves().len(), 3, "{:?}", kinds(&fit));
        assert!(iou(&fit, &truth) > least, "{}: {:?}", iou(&fit, &truth), kinds(&fit));
        assert!((fit.iou() - iou(&fit, &truth)).abs() < 0.03, "{} {}", fit.iou(), iou(&fit, &truth));
        assert_eq!(fit.topology().genus, Some(1));
        assert_eq!(fit.topology_of_input().genus, None);
    }
}

#[test]
fn points_that_are_no_part_are_told() {
    let few = PointCloud::new(vec![DVec3::ZERO; 20]).unwrap();
    let error = part_of_points(&few, &PartSettings::default()).unwrap_err();
    assert!(matches!(error, FitError::TooFew { points: 20, needed: 200, .. }), "{error}");
    let one = PointCloud::new(vec![DVec3::ONE; 300]).unwrap();
    assert!(matches!(part_of_points(&one, &PartSettings::default()), Err(FitError::Extent { .. })));
    let flat = (0..300).map(|i| DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0)).collect();
    let flat = PointCloud::new(flat).unwrap();
    assert!(matches!(part_of_points(&flat, &PartSettings::default()), Err(FitError::Flat { .. })));
    let ball = ParametricSurface::of(&rvachev::Superellipsoid::new([1.0; 3], 1.0, 1.0)).unwrap();
    let samples = ball.sample(600, 1).unwrap();
    let inwards = samples.iter().map(|s| -s.normal.as_vec3()).collect();
    let inwards = PointCloud::new(samples.iter().map(|s| s.point).collect()).unwrap().with_normals(inwards).unwrap();
    let error = part_of_points(&inwards, &PartSettings::default()).unwrap_err();
    assert!(error.to_string().contains("turn them round"), "{error}");

    let cancel = CancelToken::default();
    cancel.cancel();
    let run = Run { cancel, ..Run::default() };
    let error = part_of_points_with(&inwards, &PartSettings::default(), &run).unwrap_err();
    assert!(matches!(error, FitError::Cancelled(_)));
}
