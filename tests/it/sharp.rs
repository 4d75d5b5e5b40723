//! Creases and corners: how far the mesh is from the true edges and from the true surface.

use std::collections::HashMap;

use glam::{DQuat, DVec3, IVec3};
use rvachev::{
    AtBounds, Bounds, CellSize, Features, Mesh, MeshSettings, ParamError, RFunction, Solid,
    error::MeshingError,
    field::{Field, Real},
    rad,
};

use crate::models;
use crate::support::Random;

/// A point's distance to a mesh, for points that are close to it.
struct Nearness<'a> {
    mesh: &'a Mesh,
    cell: f64,
    buckets: HashMap<[i32; 3], Vec<u32>>,
}

impl<'a> Nearness<'a> {
    fn new(mesh: &'a Mesh, cell: f64) -> Self {
        let mut buckets: HashMap<[i32; 3], Vec<u32>> = HashMap::new();
        for (n, t) in mesh.triangles().iter().enumerate() {
            let p = t.map(|i| mesh.positions()[i as usize].as_dvec3());
            let low = (p[0].min(p[1]).min(p[2]) / cell).floor().as_ivec3();
            let high = (p[0].max(p[1]).max(p[2]) / cell).floor().as_ivec3();
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    for z in low.z..=high.z {
                        buckets.entry([x, y, z]).or_default().push(n as u32);
                    }
                }
            }
        }
        Nearness { mesh, cell, buckets }
    }

    /// In cells; anything beyond a cell is a cell.
    fn distance(&self, p: DVec3) -> f64 {
        let at = (p / self.cell).floor();
        let mut best = self.cell * self.cell;
        // The middle one first: what is found there rules out most of those around it.
        for n in (13..27).chain(0..13) {
            let bucket = at + DVec3::from_array([n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1].map(f64::from));
            let low = bucket * self.cell;
            if (p - p.clamp(low, low + self.cell)).length_squared() > best {
                continue;
            }
            for &t in self.buckets.get(&bucket.as_ivec3().to_array()).into_iter().flatten() {
                let corners = self.mesh.triangles()[t as usize].map(|i| self.mesh.positions()[i as usize].as_dvec3());
                best = best.min((nearest_on(corners, p) - p).length_squared());
            }
        }
        best.sqrt() / self.cell
    }
}

/// The point of a triangle that is nearest to p.
fn nearest_on([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let within = |u: DVec3, v: DVec3| (v - u).cross(p - u).dot(normal) >= 0.0;
    if within(a, b) && within(b, c) && within(c, a) {
        return p - normal * ((p - a).dot(normal) / normal.length_squared());
    }
    let on = |u: DVec3, v: DVec3| u + (v - u) * ((p - u).dot(v - u) / (v - u).length_squared()).clamp(0.0, 1.0);
    let sides = [on(a, b), on(b, c), on(c, a)];
    sides.into_iter().min_by(|u, v| (*u - p).length_squared().total_cmp(&(*v - p).length_squared())).unwrap()
}

/// What is said of a list of errors, in cells.
#[derive(Clone, Copy, Debug)]
struct Statistics {
    median: f64,
    part90: f64,
    rms: f64,
    max: f64,
}

fn statistics(mut errors: Vec<f64>) -> Statistics {
    errors.sort_by(f64::total_cmp);
    let count = errors.len();
    Statistics {
        median: errors[count / 2],
        part90: errors[count * 9 / 10],
        rms: (errors.iter().map(|e| e * e).sum::<f64>() / count as f64).sqrt(),
        max: errors[count - 1],
    }
}

impl std::fmt::Display for Statistics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Statistics { median, part90, rms, max } = self;
        write!(f, "median {median:.4}, 90 % {part90:.4}, rms {rms:.4}, max {max:.3}")
    }
}

fn mesh(solid: &Solid, cell: f64, features: Features) -> Mesh {
    let mesh = solid.mesh(&MeshSettings { cell: CellSize::Length(cell), features, ..MeshSettings::default() }).unwrap();
    let report = mesh.check();
    assert!(report.is_sound(), "{report:?}");
    mesh
}

/// The distances of the centroids of triangles from the zero set of a field, to first order.
fn surface_errors(mesh: &Mesh, solid: &Solid, cell: f64) -> Vec<f64> {
    let program = solid.surface_program().unwrap();
    let error = |t: &[u32; 3]| {
        let centroid = t.iter().map(|&i| mesh.positions()[i as usize].as_dvec3()).sum::<DVec3>() / 3.0;
        let (value, gradient) = program.gradient(centroid);
        value.abs() / gradient.length() / cell
    };
    mesh.triangles().iter().map(error).collect()
}

fn edge_errors(mesh: &Mesh, points: &[DVec3], cell: f64) -> Vec<f64> {
    let nearness = Nearness::new(mesh, cell);
    points.iter().map(|&p| nearness.distance(p)).collect()
}

/// Points every hundredth of a cell on the edges of a cube of side 2.
fn cube_edges(cell: f64) -> Vec<DVec3> {
    let count = (2.0 / (0.01 * cell)) as usize;
    let mut points = Vec::new();
    for edge in 0..12 {
        let (axis, u, v) = (edge % 3, (edge + 1) % 3, (edge + 2) % 3);
        for n in 0..=count {
            let mut p = DVec3::ZERO;
            p[axis] = 2.0 * n as f64 / count as f64 - 1.0;
            p[u] = if edge / 3 % 2 == 0 { -1.0 } else { 1.0 };
            p[v] = if edge / 6 == 0 { -1.0 } else { 1.0 };
            points.push(p);
        }
    }
    points
}

#[test]
fn edges_of_a_turned_cube() {
    let cell = 2.0 * 3f64.sqrt() / 64.0;
    let edges = cube_edges(cell);
    let mut random = Random::new(12);
    let (mut sharp, mut smooth, mut surface, mut faces) = (Vec::new(), Vec::new(), Vec::new(), [0, 0]);
    for n in 0..12 {
        let turn = if n == 0 { DQuat::IDENTITY } else { random.rotation() };
        let shift = random.vector(-0.1, 0.1);
        let solid = Solid::cuboid(DVec3::splat(2.0)).rotate(turn).translate(shift);
        let points: Vec<DVec3> = edges.iter().map(|p| turn * *p + shift).collect();
        for (features, errors) in [(Features::Sharp, &mut sharp), (Features::Smooth, &mut smooth)] {
            let mesh = mesh(&solid, cell, features);
            faces[(features == Features::Smooth) as usize] += mesh.triangles().len();
            errors.extend(edge_errors(&mesh, &points, cell));
            if features == Features::Sharp {
                let errors = surface_errors(&mesh, &solid, cell);
                println!("  turn {n}: surface {}", statistics(errors.clone()));
                surface.extend(errors);
            }
        }
        let count = points.len();
        println!("cube {n}: {}", statistics(sharp[sharp.len() - count..].to_vec()));
    }
    let (sharp, smooth, surface) = (statistics(sharp), statistics(smooth), statistics(surface));
    println!("cubes, edges, sharp:  {sharp}");
    println!("cubes, edges, smooth: {smooth}");
    println!("cubes, surface, sharp: {surface}; triangles {faces:?}");
    assert!(sharp.median <= 0.005 && sharp.part90 <= 0.05, "{sharp}");
    assert!(sharp.median < smooth.median && sharp.part90 < smooth.part90, "{sharp}, {smooth}");
    assert!(sharp.rms < 0.01 * smooth.rms && sharp.max < 0.1, "{sharp}, {smooth}");
    assert!(surface.rms <= 0.006, "{surface}");
}

/// Points on the true edges of M2: where two of its parts have the value 0, found by Newton steps
/// from around the vertices of a mesh.
fn body_edges(near: &Mesh, cell: f64) -> Vec<DVec3> {
    let parts: Vec<_> = models::set("M2")
        .unwrap()
        .solids
        .iter()
        .map(|part| {
            let solid = Solid::superellipsoid(part.semi_axes, part.exponents[0], part.exponents[1]);
            solid.affine(part.pose).surface_program().unwrap()
        })
        .collect();
    let body = models::m2().solid.surface_program().unwrap();
    let mut random = Random::new(5);
    let mut points = Vec::new();
    for vertex in near.positions() {
        let vertex = vertex.as_dvec3();
        let close: Vec<usize> = (0..parts.len())
            .filter(|&n| {
                let (value, gradient) = parts[n].gradient(vertex);
                value.abs() < 0.7 * cell * gradient.length()
            })
            .collect();
        for (n, &a) in close.iter().enumerate() {
            for &b in &close[..n] {
                for _ in 0..40 {
                    let mut p = vertex + random.vector(-0.5, 0.5) * cell;
                    for _ in 0..8 {
                        let ((f, u), (g, v)) = (parts[a].gradient(p), parts[b].gradient(p));
                        // The smallest step that takes both to 0 to first order.
                        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
                        let determinant = uu * vv - uv * uv;
                        p -= (u * (f * vv - g * uv) + v * (g * uu - f * uv)) / determinant;
                    }
                    let on_both = parts[a].value(p).abs().max(parts[b].value(p).abs()) < 1e-9;
                    if on_both && body.value(p).abs() < 1e-8 && (p - vertex).length() < 1.5 * cell {
                        points.push(p);
                    }
                }
            }
        }
    }
    points
}

#[test]
fn edges_of_a_body() {
    let model = models::m2();
    let cell = 2.0 * model.half / 128.0;
    let smooth = mesh(&model.solid, cell, Features::Smooth);
    let sharp = mesh(&model.solid, cell, Features::Sharp);
    let points = body_edges(&smooth, cell);
    let edges = [&sharp, &smooth].map(|mesh| statistics(edge_errors(mesh, &points, cell)));
    let surface = [&sharp, &smooth].map(|mesh| statistics(surface_errors(mesh, &model.solid, cell)));
    println!("M2, {} points on edges, sharp:  {}", points.len(), edges[0]);
    println!("M2, edges, smooth: {}", edges[1]);
    println!("M2, surface, sharp:  {}; {} triangles", surface[0], sharp.triangles().len());
    println!("M2, surface, smooth: {}; {} triangles", surface[1], smooth.triangles().len());
    assert!(edges[0].median <= 0.005 && edges[0].part90 <= 0.05, "{}", edges[0]);
    assert!(edges[0].median < edges[1].median && edges[0].part90 < edges[1].part90);
    assert!(edges[0].rms < 0.03 * edges[1].rms && edges[0].max < 0.15 * edges[1].max);
    // Where no edge is near, what the rounded parts of the body leave to triangles on lattice edges
    // alone is more.
    let bucket = |p: DVec3| (p / (2.0 * cell)).floor().as_ivec3();
    let mut buckets: HashMap<IVec3, Vec<DVec3>> = HashMap::new();
    for p in &points {
        buckets.entry(bucket(*p)).or_default().push(*p);
    }
    let is_far = |p: DVec3| {
        (0..27).all(|n| {
            let around = bucket(p) + IVec3::new(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            buckets.get(&around).into_iter().flatten().all(|q| (*q - p).length_squared() > 4.0 * cell * cell)
        })
    };
    let normals = smooth.normals().expect("a mesh of a solid has them");
    let far: Vec<f64> = surface_errors(&smooth, &model.solid, cell)
        .into_iter()
        .zip(smooth.triangles())
        .filter(|(_, t)| {
            let [a, b, c] = t.map(|i| normals[i as usize]);
            let centroid = t.iter().map(|&i| smooth.positions()[i as usize].as_dvec3()).sum::<DVec3>() / 3.0;
            a.dot(b).min(b.dot(c)).min(c.dot(a)) > 0.9 && is_far(centroid)
        })
        .map(|(error, _)| error)
        .collect();
    let (share, far) = (far.len() as f64 / smooth.triangles().len() as f64, statistics(far));
    println!("M2, surface, {:.0} % of the triangles, 2 cells and more from edges and not sharp: {far}", 100.0 * share);
    assert!(surface[0].rms <= 0.006 && surface[0].rms < 0.3 * surface[1].rms, "{}", surface[0]);
    assert!(surface[0].rms < 0.8 * far.rms, "{}, {far}", surface[0]);
    // Where an edge passes cells without a change of sign, too.
    assert!(edges[0].max < 0.1, "{}", edges[0]);
}

#[test]
fn a_smooth_solid_is_the_same_in_both_modes() {
    for (solid, cell) in [
        (Solid::sphere(1.0), 0.01),
        (Solid::sphere(1.0), 0.2),
        (Solid::torus(1.0, 0.4), 0.01),
        (Solid::torus(1.0, 0.4), 0.1),
        // Radii of two cells and a little.
        (Solid::torus(1.0, 0.4), 0.18),
        (Solid::sphere(0.5).rotate_x(rad(0.3)), 0.23),
        (Solid::superellipsoid(DVec3::ONE, 1.0, 0.8), 0.05),
        (Solid::ellipsoid(DVec3::new(1.0, 0.7, 0.4)), 0.05),
        (Solid::cuboid(DVec3::ONE).offset(0.3), 0.06),
    ] {
        let [sharp, smooth] = [Features::Sharp, Features::Smooth].map(|features| mesh(&solid, cell, features));
        assert!(sharp == smooth, "{solid} at {cell}");
    }
}

/// Few cells for a curved surface of a solid that has creases elsewhere: vertices in the middle of
/// cells take the mesh to it, without creases.
#[test]
fn strongly_curved_cells_bulge() {
    let crumb = Solid::cuboid(DVec3::splat(0.3)).translate(DVec3::X * 2.0);
    for solid in [Solid::sphere(1.0), Solid::torus(1.0, 0.4), Solid::superellipsoid(DVec3::ONE, 0.5, 0.8)] {
        let both = &solid | &crumb;
        let [sharp, smooth] = [Features::Sharp, Features::Smooth].map(|features| mesh(&both, 0.1, features));
        let [fine, plain] = [&sharp, &smooth].map(|mesh| statistics(surface_errors(mesh, &both, 0.1)));
        println!("sharp {fine}, {} triangles; smooth {plain}, {}", sharp.triangles().len(), smooth.triangles().len());
        assert!(fine.rms < 0.6 * plain.rms && fine.part90 < 0.6 * plain.part90, "{fine}, {plain}");
    }
    let ball = mesh(&(Solid::sphere(1.0) | &crumb), 0.1, Features::Sharp);
    let volume = 4.0 / 3.0 * std::f64::consts::PI + 0.3_f64.powi(3);
    assert!((ball.volume() / volume - 1.0).abs() < 3e-3, "{}", ball.volume());
}

/// Normals that differ as those of a crease do are those of a ball all the same, if it has a radius
/// of few cells.
#[test]
fn round_cells_have_no_creases() {
    let cube = Solid::cuboid(DVec3::splat(1.5)).translate(DVec3::X * 2.5);
    for cells in [1.5, 1.8, 2.1] {
        let cell = 1.0 / cells;
        let mesh = mesh(&(Solid::sphere(1.0) | &cube), cell * 0.999, Features::Sharp);
        let (normals, corners) = (mesh.normals().unwrap(), mesh.corner_normals().expect("the cube has creases"));
        let (mut count, mut creased) = (0, 0);
        for (triangle, corners) in mesh.triangles().iter().zip(corners) {
            if triangle.iter().all(|&n| mesh.positions()[n as usize].x < 1.2) {
                let own = triangle.map(|n| normals[n as usize]);
                count += 1;
                creased += usize::from(own.iter().zip(corners).any(|(own, corner)| own.dot(*corner) < 0.99));
            }
        }
        println!("a radius of {cells} cells: {creased} of {count} triangles have creases");
        assert!(count > 60 && creased == 0, "{cells}: {creased} of {count}");
    }
}

#[test]
fn apexes_are_kept() {
    // However blunt: the normals of cones and pyramids are so many degrees from the axis. From 13°
    // on those of opposite sides differ as at a crease, while those of neighbours in a cell need
    // not.
    for degrees in [14.0f64, 16.0, 18.0, 22.0, 30.0] {
        let height = degrees.to_radians().tan();
        let pyramid = |sides: u32| Solid::pyramid(sides, 1.0 / (std::f64::consts::PI / f64::from(sides)).cos(), height);
        let solids =
            [("cone", Solid::cone(1.0, 0.0, height)), ("pyramid of 4", pyramid(4)), ("pyramid of 5", pyramid(5))];
        for (name, solid) in solids {
            let mut random = Random::new(7);
            let mut off = Vec::new();
            for _ in 0..25 {
                let (turn, shift, cell) = (random.rotation(), random.vector(-0.1, 0.1), 0.1);
                let mesh = mesh(&solid.clone().rotate(turn).translate(shift), cell, Features::Sharp);
                off.push(Nearness::new(&mesh, cell).distance(turn * (DVec3::Z * 0.5 * height) + shift));
            }
            let off = statistics(off);
            println!("{name}, {degrees}°: {off:?}");
            assert!(off.median < 0.01 && off.part90 < 0.03, "{name}, {degrees}°: {off:?}");
        }
    }
}

#[test]
fn normals_at_creases_are_those_of_the_faces() {
    let mesh = mesh(&Solid::cuboid(DVec3::splat(2.0)).rotate_x(rad(0.3)).rotate_z(rad(0.5)), 0.11, Features::Sharp);
    let corners = mesh.corner_normals().expect("a cube has creases");
    let mut astray = 0;
    for (triangle, normals) in mesh.triangles().iter().zip(corners) {
        let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize].as_dvec3());
        let face = (b - a).cross(c - a).normalize();
        astray += usize::from(normals.iter().any(|normal| normal.as_dvec3().dot(face) < 0.999));
    }
    println!("corner normals: {astray} of {} triangles are not flat", corners.len());
    assert!(astray * 50 < corners.len(), "{astray} of {}", corners.len());
    // A smooth solid has a normal for each vertex and no more.
    let ball = Solid::sphere(1.0).mesh(&MeshSettings::default()).unwrap();
    assert!(ball.corner_normals().is_none() && ball.normals().is_some());
}

#[test]
fn caps_are_flat_and_sharp_or_an_error() {
    let bounds = Bounds::new(DVec3::new(-2.0, -2.0, -0.313), DVec3::new(2.0, 2.0, 0.427));
    let settings = MeshSettings { cell: CellSize::Length(0.07), bounds: Some(bounds), ..MeshSettings::default() };
    let mesh = Solid::sphere(1.0).mesh(&settings).unwrap();
    assert!(mesh.check().is_sound());
    let exact = std::f64::consts::PI * (0.74 - (0.427f64.powi(3) + 0.313f64.powi(3)) / 3.0);
    assert!((mesh.volume() / exact - 1.0).abs() < 2e-3, "{} {exact}", mesh.volume());
    let rim = |z: f64| DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
    let nearness = Nearness::new(&mesh, 0.07);
    for n in 0..500 {
        let turn = DQuat::from_rotation_z(f64::from(n) / 79.0);
        for z in [-0.313, 0.427] {
            assert!(nearness.distance(turn * rim(z)) < 0.2, "{n}: {}", nearness.distance(turn * rim(z)));
        }
    }
    let refused = MeshSettings { at_bounds: AtBounds::Refuse, ..settings.clone() };
    match Solid::sphere(1.0).mesh(&refused) {
        Err(MeshingError::LeavesBounds { at }) => {
            assert!(at.length() < 1.0 && (at.z + 0.313).abs().min((at.z - 0.427).abs()) < 1e-3, "{at}");
        }
        other => panic!("{other:?}"),
    }
    // Touching the bounds is not leaving them.
    let flush = MeshSettings { bounds: Some(Bounds::from_center(DVec3::ZERO, DVec3::splat(0.5))), ..refused };
    assert!(Solid::cuboid(DVec3::ONE).mesh(&flush).is_ok());
}

/// A ball whose values are no lengths.
#[derive(Clone, Debug)]
struct Scaled(f64);

impl Field for Scaled {
    fn name(&self) -> &'static str {
        "scaled"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        (x * x + y * y + z * z + -1.0) * -self.0
    }

    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::ONE)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

#[test]
fn leaving_bounds_is_a_matter_of_lengths() {
    for scale in [1e-4, 1.0, 1e4] {
        let ball = Solid::new(Scaled(scale));
        let refused = |half: f64| {
            let bounds = Some(Bounds::from_center(DVec3::ZERO, DVec3::splat(half)));
            let settings = MeshSettings { cell: CellSize::Length(0.07), bounds, ..MeshSettings::default() };
            let result = ball.mesh(&MeshSettings { at_bounds: AtBounds::Refuse, ..settings });
            matches!(result, Err(MeshingError::LeavesBounds { .. }))
        };
        assert!(refused(0.5) && refused(0.99), "{scale}");
        // By less than a hundredth of a cell.
        assert!(!refused(0.9996) && !refused(1.0), "{scale}");
    }
}

#[test]
fn parts_wholly_outside_of_the_bounds_leave_them() {
    let bounds = Bounds::from_center(DVec3::ZERO, DVec3::splat(1.5));
    let settings = MeshSettings { cell: CellSize::LongestSide(24), bounds: Some(bounds), ..MeshSettings::default() };
    let refused = MeshSettings { at_bounds: AtBounds::Refuse, ..settings.clone() };
    let ball = Solid::sphere(1.0);
    let far = ball.translate(3.0 * DVec3::X);
    for solid in [far.clone(), &ball | &far] {
        match solid.mesh(&refused) {
            Err(MeshingError::LeavesBounds { at }) => assert!((at.distance(3.0 * DVec3::X) - 1.0).abs() < 0.02, "{at}"),
            other => panic!("{other:?}"),
        }
    }
    assert!(far.mesh(&settings).unwrap().triangles().is_empty());
    assert!(ball.mesh(&refused).is_ok());
    // By a part that is so far away that cells of the size would be too many.
    let farther = &ball | Solid::sphere(1e5).translate(1e6 * DVec3::X);
    assert!(matches!(farther.mesh(&refused), Err(MeshingError::LeavesBounds { .. })));
    // A box that tells of more than is there.
    assert!((ball.union(&far, RFunction::MIN_MAX) & Solid::sphere(1.2)).mesh(&refused).is_ok());
}

#[test]
fn bounds_that_touch_or_are_far_away_are_bounds() {
    let cube = Solid::cuboid(DVec3::ONE);
    let mesh = |solid: &Solid, bounds: Bounds| {
        solid.mesh(&MeshSettings { cell: CellSize::LongestSide(16), bounds: Some(bounds), ..MeshSettings::default() })
    };
    // In a corner, along an edge, in a face.
    for touched in [DVec3::ONE, DVec3::new(1.0, 1.0, 0.0), DVec3::X] {
        let bounds = Bounds::from_center(touched, DVec3::splat(0.5));
        assert!(mesh(&cube, bounds).unwrap().triangles().is_empty(), "{touched}");
    }
    // Half of it, by bounds that go on far beyond.
    let half = mesh(&cube, Bounds::new(DVec3::new(0.0, -1e10, -1e10), DVec3::splat(1e10))).unwrap();
    assert!((half.volume() - 0.5).abs() < 1e-6);
    // A sheet thinner than what far bounds are rounded by.
    let sheet = Solid::cuboid(DVec3::new(0.02, 0.02, 0.002));
    let half = mesh(&sheet, Bounds::new(DVec3::new(0.0, -1e10, -1e10), DVec3::splat(1e10))).unwrap();
    assert!((half.volume() / 4e-7 - 1.0).abs() < 1e-5, "{}", half.volume());
    let ground = Solid::half_space(DVec3::Z, 0.0);
    let sliver = Bounds::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-12));
    for (solid, bounds) in [(&ground, Bounds::from_center(DVec3::ZERO, DVec3::splat(1e10))), (&cube, sliver)] {
        let error = mesh(solid, bounds).unwrap_err().to_string();
        assert!(error.starts_with("bounds are"), "{error}");
    }
}

#[test]
fn owners_are_the_leaves() {
    let solid = Solid::cuboid(DVec3::splat(2.0)) - Solid::cylinder(0.5, 4.0);
    let settings = MeshSettings { cell: CellSize::Length(0.1), owners: true, ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let owners = mesh.owners().expect("they are asked for");
    let mut right = 0;
    for (triangle, &owner) in mesh.triangles().iter().zip(owners) {
        let middle = triangle.iter().map(|&i| mesh.positions()[i as usize].as_dvec3()).sum::<DVec3>() / 3.0;
        right += usize::from((middle.truncate().length() < 0.5) == (owner == 1));
    }
    assert!(right * 100 > 99 * owners.len(), "{right} of {}", owners.len());
}

#[test]
#[ignore = "a timing"]
fn cost_of_features() {
    let run = rvachev::Run { threads: 1, ..rvachev::Run::default() };
    for (model, across) in models::all().into_iter().flat_map(|model| [(model.clone(), 128.0), (model, 256.0)]) {
        let cell = CellSize::Length(2.0 * model.half / across);
        let time = |features| {
            let settings = MeshSettings { cell, bounds: Some(model.cube()), features, ..MeshSettings::default() };
            let start = std::time::Instant::now();
            let mesh = model.solid.mesh_with(&settings, &run).unwrap();
            (start.elapsed().as_secs_f64(), mesh.triangles().len())
        };
        // Alternating, the least of each: other work on the machine falls on both.
        let (mut least, mut triangles) = ([f64::INFINITY; 2], [0; 2]);
        for _ in 0..7 {
            for (n, features) in [Features::Smooth, Features::Sharp].into_iter().enumerate() {
                let (seconds, count) = time(features);
                least[n] = least[n].min(seconds);
                triangles[n] = count;
            }
        }
        let [smooth, sharp] = least;
        println!(
            "{} at {across}: smooth {:.1} ms, sharp {:.1} ms, ratio {:.2}; triangles {triangles:?}",
            model.name,
            1e3 * smooth,
            1e3 * sharp,
            sharp / smooth
        );
    }
}
