//! Parameter patches: points, frames, closed meshes.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3Swizzles};
use rvachev::{
    Angle, Gielis, Mesh, Radius, Superellipse, Superellipsoid, Superhyperboloid, Supershape, Supertoroid, deg,
    field::Field,
    rad,
    surface::{ParametricCurve, ParametricSurface, PatchError, PatchSettings, Spacing},
};

/// A surface with the field whose zero set it is, and the number of handles of each shell.
struct Case {
    name: String,
    surface: ParametricSurface,
    /// Relative to the size, 0 on the surface.
    residual: Box<dyn Fn(DVec3) -> f64>,
    gradient: Box<dyn Fn(DVec3) -> DVec3>,
    shells: usize,
    genus: i64,
}

fn case<F: Field>(field: F, surface: ParametricSurface, shells: usize, genus: i64) -> Case {
    let name = format!("{field:?}");
    let field = std::sync::Arc::new(field);
    let other = field.clone();
    let size = field.bounds().half_extents().length();
    let value = move |p: DVec3| field.eval(p.to_array()) / size;
    let gradient = move |p: DVec3| -DVec3::from(other.eval(rvachev::field::Dual::point(p.to_array())).gradient());
    Case { name, surface, residual: Box::new(value), gradient: Box::new(gradient), shells, genus }
}

fn cases() -> Vec<Case> {
    let mut cases = vec![];
    for e in [[1.0, 1.0], [0.04, 0.04], [0.3, 1.5], [2.0, 2.0], [2.0, 0.1], [1.5, 2.5], [3.0, 0.5], [0.01, 1.0]] {
        let shape = Superellipsoid::new([1.0, 2.0, 3.0], e[0], e[1]);
        cases.push(case(shape, ParametricSurface::of(&shape).unwrap(), 1, 0));
    }
    for (ring, e1, e2) in [(1.5, 0.3, 0.7), (3.0, 1.0, 1.0), (2.0, 2.0, 0.1)] {
        let shape = Supertoroid::new([1.2, 0.8, 0.6], ring, e1, e2);
        cases.push(case(shape, ParametricSurface::of(&shape).unwrap(), 1, 1));
    }
    for e in [[0.4, 1.3], [1.0, 1.0], [0.05, 0.05], [2.0, 1.8]] {
        let a = [1.2, 0.8, 0.6];
        for shape in [
            Superhyperboloid::one_sheet(a, e[0], e[1], 3.0),
            Superhyperboloid::one_sheet_x(a, e[0], e[1], 3.0),
            Superhyperboloid::two_sheets(a, e[0], e[1], 3.0),
            Superhyperboloid::two_sheets_x(a, e[0], e[1], 6.0),
        ] {
            let shells = if shape.has_two_sheets() { 2 } else { 1 };
            cases.push(case(shape, ParametricSurface::of(&shape).unwrap(), shells, 0));
        }
    }
    let (five, six) = (Gielis::new(5.0, 3.0, 2.0, 8.0), Gielis::new(6.0, 2.0, 7.0, 7.0));
    let star = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
    for (equator, meridian) in
        [(six, Gielis::new(4.0, 10.0, 10.0, 10.0)), (five, Gielis::new(3.0, 4.0, 4.0, 4.0)), (star, Gielis::circle())]
    {
        let shape = Supershape::with(equator, meridian, [1.0, 1.5, 0.8], Radius::Standard);
        cases.push(case(shape.clone(), ParametricSurface::of(&shape).unwrap(), 1, 0));
    }
    let rational = Supershape::with(six, Gielis::new(4.0, 4.0, 4.0, 4.0), [1.0, 1.5, 0.8], Radius::Rational);
    cases.push(case(rational.clone(), ParametricSurface::of(&rational).unwrap(), 1, 0));
    cases
}

fn sheets(surface: &ParametricSurface) -> Vec<ParametricSurface> {
    std::iter::once(*surface).chain(surface.other_sheet()).collect()
}

/// Parameters inside the ranges, quarter turns among them.
fn parameters([first, last]: [f64; 2]) -> impl Iterator<Item = f64> + Clone {
    (0..=24).map(move |i| first + (last - first) * f64::from(i) / 24.0)
}

#[test]
fn points_lie_on_the_zero_set_and_normals_along_its_gradient() {
    for case in cases() {
        for surface in sheets(&case.surface) {
            let (mut worst, mut skew) = (0.0f64, 0.0f64);
            for eta in parameters(surface.eta_range().map(Angle::radians)) {
                for omega in parameters(surface.omega_range().map(Angle::radians)) {
                    let frame = surface.frame(rad(eta), rad(omega));
                    // Beyond the clipped ends the field is that of the slab.
                    let inside = frame.point * (1.0 - 1e-9);
                    if case.name.contains("Superhyperboloid") && (case.residual)(inside) < -1e-7 {
                        continue;
                    }
                    worst = worst.max((case.residual)(frame.point).abs());
                    assert!((frame.normal.length() - 1.0).abs() < 1e-12, "{}: {frame:?}", case.name);
                    for tangent in [frame.along_eta, frame.along_omega] {
                        skew = skew.max(tangent.dot(frame.normal).abs());
                    }
                }
            }
            assert!(worst < 1e-13, "{}: residual {worst}", case.name);
            assert!(skew < 1e-12, "{}: skew {skew}", case.name);
        }
    }
}

#[test]
fn normals_are_gradients() {
    for case in cases() {
        let [first, last] = case.surface.eta_range();
        let [from, to] = case.surface.omega_range();
        for i in 0..200 {
            // Off the planes where edges and cusps are.
            let (s, t) = ((0.5 + f64::from(i)) / 200.0, (0.37 + 0.618_034 * f64::from(i)).fract());
            let frame = case.surface.frame(first + (last - first) * s, from + (to - from) * t);
            let gradient = (case.gradient)(frame.point * (1.0 - 1e-12)).normalize();
            if (case.residual)(frame.point * (1.0 - 1e-9)).abs() > 1e-6 {
                continue;
            }
            let off = (frame.normal - gradient).length();
            assert!(off < 2e-6, "{} at {:?}: {} and {gradient}", case.name, frame.point, frame.normal);
        }
    }
}

#[test]
fn poles_and_seams_are_exact() {
    for e in [0.01, 0.1, 1.0, 2.0, 10.0] {
        let surface = ParametricSurface::of(&Superellipsoid::new([3.0, 2.0, 1.0], e, e)).unwrap();
        for omega in [0.1, PI, -2.0] {
            assert_eq!(surface.point(deg(90.0), rad(omega)), DVec3::Z);
            assert_eq!(surface.point(deg(-90.0), rad(omega)), DVec3::NEG_Z);
            assert_eq!(surface.normal(deg(90.0), rad(omega)), DVec3::Z);
        }
        assert_eq!(surface.point(rad(0.0), deg(180.0)), DVec3::new(-3.0, 0.0, 0.0));
        assert_eq!(surface.point(rad(0.0), deg(-180.0)), surface.point(rad(0.0), deg(180.0)));
        assert_eq!(surface.point(rad(0.0), deg(90.0)), DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(surface.normal(rad(0.0), deg(90.0)), DVec3::Y);
    }
    let ring = ParametricSurface::of(&Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.01, 0.01)).unwrap();
    assert_eq!(ring.point(deg(180.0), deg(90.0)), DVec3::new(0.0, 0.4, 0.0));
    let shape = Supershape::new(Gielis::new(6.0, 2.0, 0.5, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
    assert_eq!(ParametricSurface::of(&shape).unwrap().point(rad(0.0), deg(180.0)).y, 0.0);
    assert_eq!(ParametricSurface::of(&shape).unwrap().point(deg(90.0), rad(1.0)), DVec3::Z);
}

fn mesh_of(surface: &ParametricSurface, settings: &PatchSettings) -> Mesh {
    surface.mesh(settings).unwrap()
}

#[test]
fn meshes_are_closed_and_manifold() {
    for case in cases() {
        let settings = PatchSettings { rows: 24, columns: 36, ..PatchSettings::default() };
        let mesh = mesh_of(&case.surface, &settings);
        let report = mesh.check();
        assert!(report.is_sound(), "{}: {report:?}", case.name);
        assert_eq!(report.shells, case.shells, "{}", case.name);
        assert_eq!(report.genus, Some(case.genus), "{}", case.name);
        assert_eq!(report.duplicate_vertices + report.unused_vertices, 0, "{}", case.name);
        assert!(report.volume > 0.0, "{}: {}", case.name, report.volume);
        let quads = case.surface.quad_mesh(&settings).unwrap();
        assert!(quads.quads().len() > 10 * quads.triangles().len() / 2);
        assert_eq!(quads.quads().len() * 2 + quads.triangles().len(), mesh.triangles().len());
        for corner in quads.quad_corners().iter().flatten().chain(quads.triangle_corners().iter().flatten()) {
            assert!((corner.normal.length() - 1.0).abs() < 1e-9, "{}: {corner:?}", case.name);
            assert!(corner.texture.min_element() >= -1e-9 && corner.texture.max_element() <= 1.0 + 1e-9);
        }
    }
}

#[test]
fn meshes_carry_texture_and_normals_of_creases() {
    let settings = PatchSettings { rows: 8, columns: 12, ..PatchSettings::default() };
    let smooth = mesh_of(&ParametricSurface::of(&Superellipsoid::new([1.0, 2.0, 3.0], 0.5, 0.5)).unwrap(), &settings);
    assert!(smooth.corner_normals().is_none());
    assert_eq!(smooth.corner_texture().unwrap().len(), smooth.triangles().len());
    // Both sides of the seam: 0 and 1 along the equator, never across.
    for corners in smooth.corner_texture().unwrap() {
        let us = corners.map(|[u, _]| u);
        assert!(us.iter().copied().fold(0.0, f32::max) - us.iter().copied().fold(1.0, f32::min) < 0.1);
    }
    // An octahedron: every corner has its face's normal.
    for spacing in [Spacing::UniformAngle, Spacing::Chord(0.01)] {
        let surface = ParametricSurface::of(&Superellipsoid::new([1.0, 1.0, 1.0], 2.0, 2.0)).unwrap();
        let mesh = mesh_of(&surface, &PatchSettings { spacing, ..settings });
        for (t, normals) in mesh.triangles().iter().zip(mesh.corner_normals().unwrap()) {
            let [a, b, c] = t.map(|i| mesh.positions()[i as usize]);
            let face = (b - a).cross(c - a).normalize();
            assert!(normals.iter().all(|n| n.distance(face) < 1e-4), "{spacing:?} {face}: {normals:?}");
        }
    }
}

#[test]
fn a_horn_is_closed_where_it_touches_the_axis() {
    let horn = ParametricSurface::of(&Supertoroid::new([1.0, 1.0, 1.0], 1.0, 1.0, 1.0)).unwrap();
    let report = mesh_of(&horn, &PatchSettings { rows: 64, columns: 128, ..PatchSettings::default() }).check();
    assert!(report.is_closed() && report.is_manifold(), "{report:?}");
    assert!((report.volume / (2.0 * PI * PI) - 1.0).abs() < 5e-3);
}

#[test]
fn volumes_converge_at_second_order() {
    let ellipsoid = Superellipsoid::new([1.0, 2.0, 3.0], 1.0, 1.0);
    let cushion = Superellipsoid::new([1.0, 2.0, 3.0], 0.3, 0.8);
    let ring = Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.3, 0.7);
    let cases = [
        (ParametricSurface::of(&ellipsoid).unwrap(), 25.132_741_228_718),
        (ParametricSurface::of(&cushion).unwrap(), 38.359_362_386_288),
        (ParametricSurface::of(&ring).unwrap(), 23.439_946_622_042),
    ];
    for (surface, exact) in cases {
        let error = |n: u32| {
            let settings = PatchSettings { rows: n, columns: 2 * n, ..PatchSettings::default() };
            (mesh_of(&surface, &settings).volume() / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(64), error(128));
        assert!((3.3..4.8).contains(&(coarse / fine)), "{exact}: {coarse} {fine}");
        assert!(fine < 3e-3, "{exact}: {fine}");
    }
}

#[test]
fn volumes_and_moments_are_those_of_the_closed_forms() {
    let even = PatchSettings { rows: 256, columns: 256, spacing: Spacing::EqualArc };
    let solid = |surface: Result<ParametricSurface, rvachev::ParamError>| mesh_of(&surface.unwrap(), &even);
    let box_like = solid(ParametricSurface::of(&Superellipsoid::new([1.0, 2.0, 3.0], 0.1, 0.1)));
    assert!((box_like.volume() / 47.462_883_333_105 - 1.0).abs() < 1e-3, "{}", box_like.volume());
    let octahedron = solid(ParametricSurface::of(&Superellipsoid::new([1.0, 2.0, 3.0], 2.0, 2.0)));
    assert!((octahedron.volume() - 8.0).abs() < 1e-5, "{}", octahedron.volume());
    // Integrals of x², y² and z² from the moments of inertia.
    let squares = |mesh: &Mesh| {
        let inertia = mesh.inertia().unwrap();
        let [x, y, z] = [inertia.x_axis.x, inertia.y_axis.y, inertia.z_axis.z];
        [(y + z - x) / 2.0, (z + x - y) / 2.0, (x + y - z) / 2.0]
    };
    for (surface, moments) in [
        (
            ParametricSurface::of(&Superellipsoid::new([1.0, 2.0, 3.0], 0.3, 0.8)),
            [9.924_580_49, 39.698_321_97, 105.264_587_86],
        ),
        (
            ParametricSurface::of(&Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.3, 0.7)),
            [60.482_274_92, 26.881_011_08, 2.681_779_93],
        ),
    ] {
        for (found, exact) in squares(&solid(surface)).into_iter().zip(moments) {
            assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let shape = Superellipsoid::new([1.0, -2.0, 3.0], 1.0, 1.0);
    assert!(ParametricSurface::of(&shape).unwrap_err().to_string().starts_with("semi_axes.y is -2"));
    let ball = ParametricSurface::of(&Superellipsoid::new([1.0, 2.0, 3.0], 1.0, 1.0)).unwrap();
    let settings = PatchSettings { columns: 2, ..PatchSettings::default() };
    assert_eq!(ball.mesh(&settings).unwrap_err().to_string(), "columns is 2, allowed: 3 to 100000");
    let settings = PatchSettings { rows: 100_000, columns: 100_000, spacing: Spacing::UniformAngle };
    assert!(ball.mesh(&settings).unwrap_err().to_string().starts_with("rows · columns is 10000000000"));
    // A tolerance that Barr's sheets do not reach is an error, with what they reach.
    let bowls = ParametricSurface::of(&Superhyperboloid::two_sheets_x([1.0, 1.0, 1.0], 0.01, 0.01, 6.0)).unwrap();
    let settings = PatchSettings { spacing: Spacing::Chord(4e-6), ..PatchSettings::default() };
    match bowls.quad_mesh(&settings) {
        Err(PatchError::Tolerance { value, least, .. }) => assert!(value == 4e-6 && least > value),
        other => panic!("{:?}", other.map(|mesh| mesh.quads().len())),
    }
}

#[test]
fn areas_converge_at_second_order() {
    let prolate = ParametricSurface::of(&Superellipsoid::new([1.0, 1.0, 2.0], 1.0, 1.0)).unwrap();
    let eccentricity = 0.75f64.sqrt();
    let prolate_area = 2.0 * PI * (1.0 + 2.0 / eccentricity * eccentricity.asin());
    let ring = ParametricSurface::of(&Supertoroid::new([1.0, 1.0, 1.0], 3.0, 1.0, 1.0)).unwrap();
    for (surface, exact) in [(prolate, prolate_area), (ring, 12.0 * PI * PI)] {
        let error = |n: u32| {
            let settings = PatchSettings { rows: n, columns: 2 * n, ..PatchSettings::default() };
            (mesh_of(&surface, &settings).area() / exact - 1.0).abs()
        };
        let ratio = error(32) / error(64);
        assert!((3.8..4.2).contains(&ratio), "{exact}: {ratio}");
        assert!(error(64) < 2e-3);
    }
}

/// The largest ratio of neighbouring points' distances along a line of vertices.
fn gap_ratio(points: &[DVec3]) -> f64 {
    let gaps = points.windows(2).map(|w| w[0].distance(w[1]));
    let (least, most) = gaps.fold((f64::INFINITY, 0f64), |(a, b), d| (a.min(d), b.max(d)));
    most / least
}

#[test]
fn equal_arcs_have_equal_gaps() {
    let (rows, columns) = (46, 60);
    let settings = PatchSettings { rows, columns, spacing: Spacing::EqualArc };
    for case in cases() {
        let quads = case.surface.quad_mesh(&settings).unwrap();
        let report = quads.to_mesh().unwrap().check();
        assert!(report.is_closed() && report.is_manifold(), "{}: {report:?}", case.name);
        let along_x = case.name.contains("along_x: true");
        let across = |p: &DVec3| if along_x { p.yz().length() } else { p.xy().length() };
        // The ring that is farthest out, and the meridian through its farthest vertex.
        let rings: Vec<&[DVec3]> = quads.positions().chunks_exact(columns as usize).take(rows as usize - 1).collect();
        let reach = |ring: &[DVec3]| ring.iter().map(across).fold(0.0, f64::max);
        let widest = rings.iter().copied().max_by(|a, b| reach(a).total_cmp(&reach(b))).unwrap();
        let mut closed = widest.to_vec();
        closed.push(widest[0]);
        assert!(gap_ratio(&closed) <= 1.5, "{}: {}", case.name, gap_ratio(&closed));
        let column = (0..columns as usize).max_by(|&a, &b| across(&widest[a]).total_cmp(&across(&widest[b]))).unwrap();
        let meridian: Vec<DVec3> = rings.iter().map(|ring| ring[column]).collect();
        let ratio = gap_ratio(&meridian);
        assert!(ratio <= 1.5, "{}: {ratio}", case.name);
    }
}

#[test]
fn within_a_chord_tolerance() {
    let tolerance = 5e-3;
    for case in cases() {
        let settings = PatchSettings { spacing: Spacing::Chord(tolerance), ..PatchSettings::default() };
        let mesh = mesh_of(&case.surface, &settings);
        let report = mesh.check();
        assert!(report.is_closed() && report.is_manifold(), "{}: {report:?}", case.name);
        assert_eq!((report.shells, report.genus), (case.shells, Some(case.genus)), "{}", case.name);
        println!("{:6} triangles: {}", report.triangles, case.name);
        assert!(report.triangles < 10_000, "{}: {}", case.name, report.triangles);
        // Where the exponents are at most 2 the field is at most the distance.
        let size = mesh.bounds().half_extents().length();
        let quadric = case.name.starts_with("Superellipsoid") || case.name.starts_with("Superhyperboloid");
        if !quadric || case.name.contains("e2: 2.5") || case.name.contains("e1: 3.0") {
            continue;
        }
        for t in mesh.triangles() {
            let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
            for p in [(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), 0.1 * a + 0.2 * b + 0.7 * c] {
                let off = (case.residual)(p).abs() * size;
                assert!(off < 1.02 * tolerance, "{} at {p}: {off}", case.name);
            }
        }
    }
}

#[test]
fn near_the_fewest_triangles() {
    let tolerance = 1e-3;
    let settings = PatchSettings { spacing: Spacing::Chord(tolerance), ..PatchSettings::default() };
    let ball = ParametricSurface::of(&Superellipsoid::new(DVec3::ONE, 1.0, 1.0)).unwrap();
    let mesh = mesh_of(&ball, &settings);
    // All vertices on the sphere: the farthest point of a triangle is its circumcentre.
    let sag = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
        1.0 - (b - a).cross(c - a).normalize().dot(a)
    };
    let worst = mesh.triangles().iter().map(sag).fold(0.0, f64::max);
    assert!(worst < tolerance * 1.02, "{worst}");
    let fewest = 4.0 * PI / (1.5 * 3f64.sqrt() * tolerance);
    let ratio = mesh.triangles().len() as f64 / fewest;
    println!("{} triangles, {ratio:.2} of the fewest", mesh.triangles().len());
    assert!(ratio < 1.6, "{ratio}");
    // An ellipsoid: √K is h²/(abc), h the distance of the tangent plane from the middle.
    let a = DVec3::new(1.0, 2.0, 3.0);
    let ellipsoid = ParametricSurface::of(&Superellipsoid::new(a, 1.0, 1.0)).unwrap();
    let mesh = mesh_of(&ellipsoid, &settings);
    let cloud = ellipsoid.sample(20_000, 5).unwrap();
    let mean = cloud.iter().map(|s| s.point.dot(s.normal).powi(2)).sum::<f64>() / cloud.len() as f64;
    let fewest = mean * mesh.area() / (a.x * a.y * a.z) / (1.5 * 3f64.sqrt() * tolerance);
    let ratio = mesh.triangles().len() as f64 / fewest;
    println!("{} triangles of an ellipsoid, {ratio:.2} of the fewest", mesh.triangles().len());
    assert!(ratio < 2.0, "{ratio}");
    // A rounded box: far fewer than even rows and columns need.
    let shape = Superellipsoid::new([1.0, 1.5, 0.7], 0.2, 0.2);
    let count = mesh_of(&ParametricSurface::of(&shape).unwrap(), &settings).triangles().len();
    println!("{count} triangles of a rounded box");
    assert!(count < 4000, "{count}");
    let error = ball.mesh(&PatchSettings { spacing: Spacing::Chord(0.0), ..settings }).unwrap_err();
    assert!(error.to_string().starts_with("tolerance is 0, allowed: 0.000001 to 0.3"), "{error}");
    assert!(ball.mesh(&PatchSettings { spacing: Spacing::Chord(f64::NAN), ..settings }).is_err());
}

#[test]
fn curves_have_exact_normals() {
    let five = Gielis::new(5.0, 3.0, 4.0, 8.0);
    let curves = [
        ParametricCurve::of(&Superellipse::new([2.0, 1.0], 0.3)).unwrap(),
        ParametricCurve::of(&Superellipse::new([2.0, 1.0], 1.7)).unwrap(),
        ParametricCurve::gielis(&five, Radius::Standard).unwrap(),
        ParametricCurve::gielis(&five, Radius::Rational).unwrap(),
        ParametricCurve::ellipse([2.0, 1.0]).unwrap(),
        ParametricCurve::hyperbola([2.0, 1.0], 3.0).unwrap(),
        ParametricCurve::parabola(0.5, 3.0).unwrap(),
    ];
    for curve in curves {
        let [first, last] = curve.range();
        for i in 0..50 {
            let t = first + (last - first) * (f64::from(i) + 0.37) / 50.0;
            let h = 1e-6;
            let along = (curve.point(t + h) - curve.point(t - h)).normalize();
            assert!((along - curve.tangent(t)).length() < 1e-5, "{curve:?} at {t}");
        }
        if curve.is_closed() {
            assert!((curve.point(first) - curve.point(last)).length() < 1e-14);
        }
    }
    assert_eq!(ParametricCurve::of(&Superellipse::new([2.0, 1.0], 0.01)).unwrap().point(PI), DVec2::new(-2.0, 0.0));
    assert!(ParametricCurve::parabola(-1.0, 3.0).is_err() && ParametricCurve::hyperbola([1.0, 0.0], 3.0).is_err());
}
