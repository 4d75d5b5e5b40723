//! Whole parts from points.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use rvachev::fit::{FitError, PartFit, PartSettings, part_of_points, part_of_points_with};
use rvachev::surface::ParametricSurface;
use rvachev::{CancelToken, CellSize, Mesh, MeshSettings, MeshSolid, PointCloud, Run, Solid};

use super::parts::{loaded, random_parts, sides};

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

/// The corners of a triangle, and its normal, as long as twice its area.
fn triangle(mesh: &Mesh, t: &[u32; 3]) -> ([DVec3; 3], DVec3) {
    let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
    ([a, b, c], (b - a).cross(c - a))
}

/// Points by area of those triangles of a mesh that are seen, as many as all would have `count`,
/// with noise in all directions, and the normals of the triangles.
fn scanned(mesh: &Mesh, count: usize, noise: f64, is_seen: impl Fn(usize) -> bool) -> (Vec<DVec3>, Vec<Vec3>) {
    let mut numbers = Numbers(7);
    let areas: Vec<f64> = mesh.triangles().iter().map(|t| triangle(mesh, t).1.length()).collect();
    let step = areas.iter().sum::<f64>() / count as f64;
    let (mut passed, mut next) = (0.0, 0.5 * step);
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    for (i, (t, area)) in mesh.triangles().iter().zip(&areas).enumerate() {
        passed += area;
        let ([a, b, c], normal) = triangle(mesh, t);
        while next < passed {
            next += step;
            let (u, v) = (numbers.unit(), numbers.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let off = noise * DVec3::new(numbers.bell(), numbers.bell(), numbers.bell());
            if is_seen(i) {
                points.push(a + u * (b - a) + v * (c - a) + off);
                normals.push(normal.normalize().as_vec3());
            }
        }
    }
    (points, normals)
}

/// Which triangles are seen from the sides and from above, as of a part on a table: those whose
/// middles are nearest in one of 25 directions, of all that is in their square of the picture.
fn seen_from_above(mesh: &Mesh) -> Vec<bool> {
    let size = mesh.bounds().size().length();
    let square = 0.012 * size;
    let mut seen = vec![false; mesh.triangles().len()];
    for (elevation, count) in [(5.0_f64, 12), (35.0, 8), (65.0, 4), (90.0, 1)] {
        for k in 0..count {
            let (sin, cos) = (std::f64::consts::TAU * (f64::from(k) + 0.3) / f64::from(count)).sin_cos();
            let (up, flat) = elevation.to_radians().sin_cos();
            let to = DVec3::new(cos * flat, sin * flat, up);
            let x = to.any_orthonormal_vector();
            let y = to.cross(x);
            let at = |p: DVec3| [x, y].map(|axis| (p.dot(axis) / square).floor() as i64);
            let mut nearest: HashMap<[i64; 2], f64> = HashMap::new();
            for t in mesh.triangles() {
                let [a, b, c] = triangle(mesh, t).0;
                for p in [a, b, c, (a + b + c) / 3.0] {
                    let nearest = nearest.entry(at(p)).or_insert(f64::NEG_INFINITY);
                    *nearest = nearest.max(p.dot(to));
                }
            }
            for (seen, t) in seen.iter_mut().zip(mesh.triangles()) {
                let ([a, b, c], normal) = triangle(mesh, t);
                let (middle, cosine) = ((a + b + c) / 3.0, normal.normalize().dot(to));
                // Within a square what is steep is at several depths.
                let depth = 1.5 * square * (1.0 - cosine * cosine).sqrt() / cosine.max(0.05) + 0.003 * size;
                *seen |= cosine > 0.1 && middle.dot(to) > nearest[&at(middle)] - depth;
            }
        }
    }
    seen
}

fn bracket() -> Solid {
    let plate = Solid::cuboid([50.0, 30.0, 10.0]);
    let boss = Solid::cylinder(9.0, 20.0).translate([10.0, 0.0, 10.0]);
    (plate | boss) - Solid::cylinder(5.0, 60.0).translate([10.0, 0.0, 0.0])
}

fn kinds(fit: &PartFit) -> Vec<String> {
    fit.leaves().iter().map(|leaf| leaf.name().to_owned()).collect()
}

/// Evenly spread points in a box and 1.5 % about it: the additive recurrence of the plastic
/// constant's sister in three dimensions (M. Roberts, 2018).
fn spread(solid: &Solid, count: u32) -> Vec<DVec3> {
    let bounds = solid.bounds().unwrap();
    let (low, size) = (bounds.min - 0.015 * bounds.size(), 1.03 * bounds.size());
    let steps = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3);
    (1..=count).map(|i| low + size * (f64::from(i) * steps).fract()).collect()
}

/// The volume in common over that of either, by the sides that points are on.
fn common(a: &[bool], b: &[bool]) -> f64 {
    let pairs = || a.iter().zip(b);
    pairs().filter(|(a, b)| **a && **b).count() as f64 / pairs().filter(|(a, b)| **a || **b).count() as f64
}

fn iou(fit: &PartFit, truth: &Solid) -> f64 {
    let points = spread(truth, 20_000);
    common(&sides(&fit.solid(), &points), &sides(truth, &points))
}

#[test]
fn a_scanned_bracket_is_three_leaves() {
    let truth = bracket();
    let mesh = meshed(&truth);
    // None, and 0.4 % of the diagonal.
    for (noise, least) in [(0.0, 0.98), (0.24, 0.97)] {
        let (points, normals) = scanned(&mesh, 4000, noise, |_| true);
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
        assert!(fit.leaves().iter().all(|leaf| leaf.seen() > 0.9 && !leaf.is_guess()), "{noise}");
    }
}

/// Of nothing beside it that has a direction.
#[test]
fn a_scanned_ring_alone_is_a_ring() {
    let axis = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    for (tube, noise) in [(6.0, 0.0), (15.0, 0.1)] {
        let truth = Solid::torus(30.0, tube).rotate_about(axis, rvachev::deg(40.0));
        let (points, normals) = scanned(&meshed(&truth), 4000, noise, |_| true);
        let cloud = PointCloud::new(points).unwrap().with_normals(normals).unwrap();
        for seed in [0, 1] {
            let fit = part_of_points(&cloud, &PartSettings { seed, ..PartSettings::default() }).unwrap();
            assert_eq!(kinds(&fit).len(), 1, "{tube} {seed}: {:?}", kinds(&fit));
            assert!(iou(&fit, &truth) > 0.98, "{tube} {seed}: {} {:?}", iou(&fit, &truth), kinds(&fit));
        }
    }
}

#[test]
fn axes_of_a_scan_are_settled_unless_it_is_refused() {
    let truth = bracket().rotate_about(DVec3::new(2.0, -1.0, 1.0).normalize(), rvachev::deg(0.6));
    let (points, normals) = scanned(&meshed(&truth), 4000, 0.06, |_| true);
    let cloud = PointCloud::new(points).unwrap().with_normals(normals).unwrap();
    let fit = part_of_points(&cloud, &PartSettings::default()).unwrap();
    let turns: Vec<usize> = (0..fit.snaps().len()).filter(|n| fit.snaps()[*n].measure == "turn").collect();
    assert!(turns.iter().any(|n| (fit.snaps()[*n].found - 0.55).abs() < 0.1), "{:?}", fit.snaps());
    let refused = fit.without_snaps(&turns);
    let free = part_of_points(&cloud, &PartSettings { snap: false, ..PartSettings::default() }).unwrap();
    let [settled, refused, free] = [&fit, &refused, &free].map(|fit| iou(fit, &truth));
    assert!(refused > settled + 0.001 && free > settled + 0.001, "{settled} {refused} {free}");
}

#[test]
fn a_bracket_on_a_table_is_whole_and_its_underside_not_seen() {
    let truth = bracket();
    let mesh = meshed(&truth);
    let seen = seen_from_above(&mesh);
    let (points, normals) = scanned(&mesh, 4000, 0.06, |i| seen[i]);
    let cloud = PointCloud::new(points).unwrap().with_normals(normals).unwrap();
    let fit = part_of_points(&cloud, &PartSettings::default()).unwrap();
    assert!(iou(&fit, &truth) > 0.95, "{}: {:?}", iou(&fit, &truth), kinds(&fit));
    let plate = &fit.leaves()[0];
    // Its underside is some 0.3 of what it makes.
    assert!((0.5..0.85).contains(&plate.seen()) && !plate.is_guess(), "{} {}", plate.name(), plate.seen());
}

/// Noise in parts of the diagonal, whether there are normals, whether all is seen; parts of IoU .97
/// at least, and the median IoU at least.
type Row = (&'static str, f64, bool, bool, usize, f64);

const ORIENTED: [Row; 4] = [
    ("none", 0.0, true, true, 45, 0.98),
    ("0.2 %", 0.002, true, true, 48, 0.98),
    ("0.4 %", 0.004, true, true, 45, 0.98),
    ("none, from above", 0.0, true, false, 43, 0.97),
];

const BARE: [Row; 2] =
    [("none, no normals", 0.0, false, true, 45, 0.98), ("0.2 %, no normals", 0.002, false, true, 42, 0.98)];

fn judged(rows: &[Row]) {
    let Some(folder) = random_parts() else { return };
    let mut found = vec![Vec::new(); rows.len()];
    for i in 0..50 {
        let Some(mesh) = loaded(&folder.join(format!("{i:03}.ply"))) else { return };
        let truth = Solid::from_mesh(&mesh, MeshSolid::default());
        let points = spread(&truth, 1 << 16);
        let inside = sides(&truth, &points);
        let from_above = seen_from_above(&mesh);
        for ((name, noise, has_normals, is_whole, ..), found) in rows.iter().zip(&mut found) {
            let noise = noise * mesh.bounds().size().length();
            let (cloud, normals) = scanned(&mesh, 4000, noise, |i| *is_whole || from_above[i]);
            let mut cloud = PointCloud::new(cloud).unwrap();
            if *has_normals {
                cloud = cloud.with_normals(normals).unwrap();
            }
            let fit = part_of_points(&cloud, &PartSettings::default()).unwrap();
            let iou = common(&inside, &sides(&fit.solid(), &points));
            println!("{i:03} {name}: IoU {iou:.4}, {} leaves", fit.leaves().len());
            found.push(iou);
        }
    }
    println!("| noise | IoU ≥ .97 | median IoU | least |");
    println!("|---|---|---|---|");
    for ((name, .., least, median), mut found) in rows.iter().zip(found) {
        found.sort_by(f64::total_cmp);
        let right = found.iter().filter(|iou| **iou >= 0.97).count();
        let middle = found[found.len() / 2];
        println!("| {name} | {right} | {middle:.3} | {:.3} |", found[0]);
        assert!(right >= *least && middle >= *median, "{name}");
    }
}

#[test]
#[ignore = "minutes, and wants Python with numpy, scipy, trimesh, numba, matplotlib and scikit-image: random parts"]
fn fifty_scanned_parts() {
    judged(&ORIENTED);
}

#[test]
#[ignore = "minutes, and wants Python with numpy, scipy, trimesh, numba, matplotlib and scikit-image: random parts"]
fn fifty_scanned_parts_without_normals() {
    judged(&BARE);
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
