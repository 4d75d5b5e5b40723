//! Laws: against brute force on parts and on random meshes; what comes back from meshing.

use glam::{DVec3, Vec3};
use rvachev::{CellSize, Mesh, MeshSettings, Solid, rad};

use super::{block, brute, mesh, meshed, solid};

/// A generator of numbers in [0, 1).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, most: usize) -> usize {
        (self.next() * most as f64) as usize
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

/// Distance and sign of a solid against brute force, at points of a box and near triangles.
fn check(name: &str, mesh: &Mesh, count: usize, random: &mut Random) {
    let triangles = brute::corners(mesh);
    let solid = solid(mesh);
    let bounds = mesh.bounds();
    let size = bounds.longest_side();
    let is_closed = mesh.open_edges().is_closed();
    let program = solid.field_program().unwrap_or_else(|error| panic!("{name}: {error}"));
    let box_ = bounds.inflate(0.2 * size);
    for i in 0..count {
        let p = if i % 2 == 0 {
            box_.min + random.point() * box_.size()
        } else {
            let [a, b, c] = triangles[random.below(triangles.len())];
            let (s, t) = (random.next(), random.next());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            a + s * (b - a) + t * (c - a) + (random.point() - 0.5) * 0.02 * size
        };
        let (distance, winding) = (brute::distance(&triangles, p), brute::winding(&triangles, p));
        let value = program.value(p);
        let rounding = 4e-6 * size;
        if is_closed {
            assert!((value.abs() - distance).abs() < rounding, "{name}: {value} for {distance} at {p}");
        } else {
            assert!(value.abs() < distance + rounding, "{name}: {value} for {distance} at {p}");
        }
        if distance > rounding && (winding - 0.5).abs() > 2e-3 {
            assert_eq!(value > 0.0, winding > 0.5, "{name}: {value} for {winding} at {p}");
        }
    }
    // Ranges hold, and f32 is as near as it says.
    for _ in 0..count / 8 {
        let centre = box_.min + random.point() * box_.size();
        let zone = rvachev::Bounds::from_center(centre, random.point() * 0.1 * size);
        let range = program.range(&zone);
        for _ in 0..8 {
            let p = zone.min + random.point() * zone.size();
            let value = program.value(p);
            assert!(range.contains(value), "{name}: {value} is not in {range:?} at {p}");
        }
    }
}

#[cfg(feature = "import")]
#[test]
fn parts_are_as_brute_force_says() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no {}", folder.display());
        return;
    };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "ply") {
            check(&path.display().to_string(), &Mesh::load(&path).unwrap(), 120, &mut Random(3));
        }
    }
}

/// A solid's mesh with triangles left out, turned over, given twice, and slivers.
fn spoilt(random: &mut Random) -> Mesh {
    let twist = rad(0.5 * random.next());
    let own = match random.below(3) {
        0 => Solid::sphere(1.0) - Solid::cylinder(0.2 + 0.3 * random.next(), 3.0),
        1 => Solid::cuboid([1.0, 1.0 + random.next(), 1.5]).twist(twist),
        _ => Solid::torus(1.0, 0.2 + 0.3 * random.next()) | Solid::sphere(0.7),
    };
    let whole = meshed(&own, 8 + random.below(8) as u32);
    let mut positions = whole.positions().to_vec();
    let mut triangles = whole.triangles().to_vec();
    let kind = random.below(6);
    let many = triangles.len();
    if kind == 1 || kind == 5 {
        // Open, in one place and scattered.
        let centre = positions[random.below(positions.len())];
        let reach = 0.6 * random.next() as f32;
        triangles.retain(|t| positions[t[0] as usize].distance(centre) > reach);
        triangles.retain(|_| random.next() > 0.01);
    }
    if kind == 2 || kind == 5 {
        for _ in 0..1 + many / 50 {
            let at = random.below(triangles.len());
            triangles[at].swap(0, 1);
        }
    }
    if kind == 3 || kind == 5 {
        for _ in 0..1 + many / 20 {
            triangles.push(triangles[random.below(triangles.len())]);
        }
    }
    if kind == 4 || kind == 5 {
        // Triangles cut into slivers: a vertex on a side, almost.
        for _ in 0..1 + many / 20 {
            let at = random.below(triangles.len());
            let [a, b, c] = triangles[at];
            let [p, q] = [a, b].map(|v| positions[v as usize]);
            let v = positions.len() as u32;
            positions.push(p.lerp(q, 0.5) + 1e-6 * Vec3::splat(random.next() as f32));
            triangles[at] = [a, v, c];
            triangles.push([v, b, c]);
            triangles.push([a, b, v]);
        }
    }
    mesh(positions, triangles)
}

#[test]
fn spoilt_meshes_are_as_brute_force_says() {
    for seed in 0..5 {
        let mut random = Random(seed);
        check(&format!("seed {seed}"), &spoilt(&mut random), 40, &mut random);
    }
}

/// Two hundred of them.
#[test]
#[ignore = "takes minutes"]
fn many_spoilt_meshes_are_as_brute_force_says() {
    for seed in 100..300 {
        let mut random = Random(seed);
        check(&format!("seed {seed}"), &spoilt(&mut random), 1000, &mut random);
    }
}

/// Volume and corners of an imported part with sharp edges.
#[test]
fn sharp_parts_come_back_sharp() {
    let part = block([-1.03, -0.71, -0.52], [0.97, 0.83, 0.61]);
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.8);
    let turned = mesh(part.positions().iter().map(|p| turn * *p).collect(), part.triangles().to_vec());
    let cell = 0.08;
    let settings = MeshSettings { cell: CellSize::Length(cell), ..MeshSettings::default() };
    let again = solid(&turned).mesh(&settings).unwrap();
    let report = again.check();
    assert!(report.is_sound() && (report.volume / turned.volume() - 1.0).abs() < 1e-3, "{report}");
    // Every corner has a vertex, and so has every edge all along.
    let near = |p: DVec3| {
        let from = |q: &Vec3| q.as_dvec3().distance(p);
        again.positions().iter().map(from).fold(f64::INFINITY, f64::min)
    };
    for corner in turned.positions() {
        assert!(near(corner.as_dvec3()) < 0.05 * cell, "{} cells", near(corner.as_dvec3()) / cell);
    }
    let triangles = brute::corners(&again);
    for side in [[0, 1], [0, 2], [3, 7], [5, 7]] {
        let [a, b] = side.map(|v: usize| turned.positions()[v].as_dvec3());
        for k in 1..40 {
            let off = brute::distance(&triangles, a.lerp(b, f64::from(k) / 40.0));
            assert!(off < 0.05 * cell, "{} cells", off / cell);
        }
    }
}

/// How far the corners of an imported mesh, and points between, are from its mesh within a
/// tolerance.
fn off(mesh: &Mesh, again: &Mesh) -> f64 {
    let triangles = brute::corners(again);
    let middle = |t: &[DVec3; 3]| t.iter().sum::<DVec3>() / 3.0;
    let own = brute::corners(mesh);
    let points = own.iter().flat_map(|t| [t[0], t[1], t[2], 0.5 * (t[0] + t[1]), middle(t)]);
    points.map(|p| brute::distance(&triangles, p)).fold(0.0, f64::max)
}

/// Blunt creases of a part with flat faces are creases: cells are as large as faces, not as the
/// creases are blunt.
#[test]
fn facets_are_no_curvature() {
    // A drum of 36 sides, turned: its creases are of 10°.
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.8);
    let at = |n: u32, z: f32| {
        let (sin, cos) = (std::f32::consts::TAU * n as f32 / 36.0).sin_cos();
        turn * Vec3::new(20.0 * cos, 20.0 * sin, z)
    };
    let positions = (0..72).map(|v| at(v % 36, if v < 36 { 0.0 } else { 15.0 })).collect();
    let sides = (0..36).flat_map(|n| [[n, (n + 1) % 36, 36 + (n + 1) % 36], [n, 36 + (n + 1) % 36, 36 + n]]);
    let ends = (1..35).flat_map(|n| [[0, n + 1, n], [36, 36 + n, 37 + n]]);
    let drum = mesh(positions, sides.chain(ends).collect());
    let tolerance = 0.1;
    let settings = MeshSettings { cell: CellSize::Tolerance(tolerance), ..MeshSettings::default() };
    let again = solid(&drum).mesh(&settings).unwrap();
    assert!(again.check().is_sound() && again.warnings().is_empty(), "{:?}", again.warnings());
    assert!(off(&drum, &again) < tolerance, "{} off", off(&drum, &again));
    assert!(again.triangles().len() < 4 * drum.triangles().len(), "{} triangles", again.triangles().len());
}

/// The same of a part with holes of many facets.
#[cfg(feature = "import")]
#[test]
fn facets_of_a_part_are_no_curvature() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts/holder.ply");
    let Ok(part) = Mesh::load(&path) else {
        println!("skipped: no {}", path.display());
        return;
    };
    let tolerance = 0.05;
    let settings = MeshSettings { cell: CellSize::Tolerance(tolerance), ..MeshSettings::default() };
    let again = solid(&part).mesh(&settings).unwrap();
    assert!(again.check().is_sound() && again.warnings().is_empty(), "{:?}", again.warnings());
    assert!(off(&part, &again) < tolerance, "{} off", off(&part, &again));
    assert!(again.triangles().len() < 2 * part.triangles().len(), "{} triangles", again.triangles().len());
}

/// The edges of a mesh between triangles that are turned by more degrees than this.
fn creases(mesh: &Mesh, degrees: f64) -> Vec<[DVec3; 2]> {
    let mut sides = std::collections::HashMap::<[[u32; 3]; 2], Vec<DVec3>>::new();
    for (t, corners) in mesh.triangles().iter().zip(brute::corners(mesh)) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        for k in 0..3 {
            let mut ends = [t[k], t[(k + 1) % 3]].map(|v| mesh.positions()[v as usize].to_array().map(f32::to_bits));
            ends.sort_unstable();
            sides.entry(ends).or_default().push(normal);
        }
    }
    let is_sharp = |normals: &[DVec3]| matches!(normals, [a, b] if a.dot(*b) < degrees.to_radians().cos());
    let sharp = sides.into_iter().filter(|(_, normals)| is_sharp(normals));
    let mut ends: Vec<_> = sharp.map(|(ends, _)| ends).collect();
    ends.sort_unstable();
    ends.into_iter().map(|ends| ends.map(|bits| Vec3::from_array(bits.map(f32::from_bits)).as_dvec3())).collect()
}

/// How far a point is from the nearest of some segments.
fn from_segments(segments: &[[DVec3; 2]], p: DVec3) -> f64 {
    let to = |[a, b]: &[DVec3; 2]| {
        let along = *b - *a;
        let t = ((p - *a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (*a + t * along).distance_squared(p)
    };
    segments.iter().map(to).fold(f64::INFINITY, f64::min).sqrt()
}

/// Whether a part, meshed anew within a tolerance, a twentieth of a cell, has its volume to a
/// thousandth, and its creases as edges that are creases too.
fn check_sharp(name: &str, part: &Mesh, share: f64) {
    let tolerance = part.bounds().longest_side() / share;
    let settings = MeshSettings { cell: CellSize::Tolerance(tolerance), ..MeshSettings::default() };
    let again = solid(part).mesh(&settings).unwrap();
    let report = again.check();
    let off = report.volume / part.volume() - 1.0;
    assert!(report.is_closed() && off.abs() < 1e-3, "{name}: volume off by {off}");
    let sharp = creases(&again, 15.0);
    let mut far = 0.0_f64;
    for [a, b] in creases(part, 30.0) {
        for k in 0..=4 {
            far = far.max(from_segments(&sharp, a.lerp(b, f64::from(k) / 4.0)));
        }
    }
    println!(
        "{name}: volume {off:.1e}, creases {:.3} cells off, {} triangles",
        0.05 * far / tolerance,
        again.triangles().len()
    );
    assert!(far < tolerance, "{name}: creases {far} off, {tolerance} asked");
}

#[cfg(feature = "import")]
fn check_sharp_part(name: &str, share: f64) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts").join(name);
    match Mesh::load(&path) {
        Ok(part) => check_sharp(name, &part, share),
        Err(_) => println!("skipped: no {}", path.display()),
    }
}

#[cfg(feature = "import")]
#[test]
fn sharp_parts_keep_volume_and_creases() {
    ["unit_cube.ply", "bushing_roller.ply"].iter().for_each(|name| check_sharp_part(name, 500.0));
}

/// A star with a notch in the middle, and a step: creases of all angles, outwards and inwards.
#[test]
fn creases_of_made_parts_are_kept() {
    let rim = |n: usize| {
        let (sin, cos) = (std::f32::consts::TAU * n as f32 / 10.0).sin_cos();
        let far = if n.is_multiple_of(2) { 10.0 } else { 6.0 };
        Vec3::new(far * cos, far * sin, 0.0)
    };
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.8);
    let mut positions: Vec<Vec3> = [0.0, 4.0].iter().flat_map(|z| (0..10).map(move |n| rim(n) + z * Vec3::Z)).collect();
    positions.extend([Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0)]);
    let sides = (0..10).flat_map(|n| {
        let next = (n + 1) % 10;
        [[n, next, 10 + next], [n, 10 + next, 10 + n], [20, next, n], [21, 10 + n, 10 + next]]
    });
    let star = mesh(positions.iter().map(|p| turn * *p).collect(), sides.collect());
    check_sharp("star", &star, 500.0);
}

/// All of them, finely.
#[cfg(feature = "import")]
#[test]
#[ignore = "takes minutes"]
fn all_sharp_parts_keep_volume_and_creases() {
    for name in [
        "7_8ths_cube",
        "angle_block",
        "bushing_roller",
        "camshaft",
        "holder",
        "lasercut_interface",
        "machinist",
        "octagonal_pocket",
        "plate_holes",
        "round",
        "satellite_mount",
        "shaft",
        "unit_cube",
        "xtion_bracket",
    ] {
        check_sharp_part(&format!("{name}.ply"), 1000.0);
    }
}

/// The meshes of the bounded leaves of the catalogue, of finer and finer cells, are these leaves.
#[test]
#[ignore = "takes some seconds"]
fn meshes_of_the_catalogue_give_it_back() {
    use rvachev::catalogue::{Group, Part};
    for entry in rvachev::catalogue().iter().filter(|entry| entry.group() == Group::Leaf) {
        let Part::Solid(own) = entry.example() else { continue };
        if own.finite_bounds().is_err() {
            continue;
        }
        let mesh = meshed(&own, 64);
        let cell = mesh.bounds().longest_side() / 64.0;
        let imported = solid(&mesh);
        let mut random = Random(11);
        let bounds = mesh.bounds().inflate(4.0 * cell);
        let mut far = 0.0_f64;
        for _ in 0..400 {
            let p = bounds.min + random.point() * bounds.size();
            let nearest = own.closest_surface_point(p).unwrap().expect("there is a surface").distance(p);
            let value = imported.value(p).unwrap();
            far = far.max((value.abs() - nearest).abs() / cell);
            let is_sure = nearest > 0.3 * cell;
            assert!(!is_sure || own.contains(p).unwrap() == (value > 0.0), "{}: {value} at {p}", entry.name());
        }
        println!("{}: {far:.3} cells off", entry.name());
        assert!(far < 0.3, "{}: {far} cells off", entry.name());
    }
}

/// The mesh of a solid is the solid, within the error of a cell.
#[test]
fn our_own_meshes_give_the_solid_back() {
    let own = Solid::superellipsoid([1.0, 0.8, 0.6], 0.5, 0.7) - Solid::cylinder(0.3, 3.0);
    let mesh = meshed(&own, 48);
    let cell = mesh.bounds().longest_side() / 48.0;
    let imported = solid(&mesh);
    let mut random = Random(5);
    for _ in 0..400 {
        let p = (random.point() - 0.5) * 2.4;
        let nearest = own.closest_surface_point(p).unwrap().expect("there is a surface").distance(p);
        let value = imported.value(p).unwrap();
        assert!((value.abs() - nearest).abs() < 0.2 * cell, "{value} for {nearest} at {p}");
        assert!(nearest < 0.2 * cell || own.contains(p).unwrap() == (value > 0.0), "{value} at {p}");
    }
}
