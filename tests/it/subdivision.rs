//! Morin–Warren subdivision: the scheme, its limits, conics and quadrics.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use rvachev::{
    Supertoroid, deg, rad,
    subdivision::{
        ControlGrid, ControlPolygon, ProfileEnd, SubdivisionError, SubdivisionRevolution, Tension, hyperbola_of_ellipse,
    },
    surface::QuadMesh,
};

fn square(size: f64) -> Vec<DVec2> {
    [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| DVec2::new(x, y) * size).into()
}

fn right_angle() -> Tension {
    Tension::trigonometric(deg(90.0)).unwrap()
}

#[test]
fn a_square_becomes_a_circle() {
    let polygon = ControlPolygon::closed(&square(FRAC_PI_2), right_angle()).unwrap();
    let radii =
        [FRAC_PI_2, 1.110_720_734_540, 1.026_172_152_977, 1.006_454_542_800, 1.001_608_189_084, 1.000_401_708_155];
    for (level, radius) in radii.into_iter().enumerate() {
        let points = polygon.subdivided(level as u32).unwrap().points();
        let (least, most) =
            points.iter().fold((f64::INFINITY, 0f64), |(a, b), p| (a.min(p.length()), b.max(p.length())));
        assert!((least - radius).abs() < 1e-12 && most - least < 1e-15, "level {level}: {least} to {most}");
        for p in polygon.limit(level as u32).unwrap() {
            assert!((p.length() - 1.0).abs() < 1e-15, "level {level}: {}", p.length());
        }
    }
    let error = |level: u32| polygon.subdivided(level).unwrap().points()[1].length() - 1.0;
    assert!((error(7) / error(8) - 4.0).abs() < 1e-3);
}

#[test]
fn polygons_of_any_length() {
    // Longer than the blocks that a level is made by, and not: against the mask, point by point.
    for count in [3usize, 4, 127, 128, 129, 130, 131, 255, 256, 257, 258, 259, 1000] {
        let points: Vec<DVec2> = (0..count).map(|i| DVec2::new((i * i % 17) as f64, (7 * i % 23) as f64)).collect();
        let tension = Tension::hyperbolic(0.7).unwrap();
        let [neighbour, own] = tension.mask(1);
        let even = |i: usize| (points[(i + count - 1) % count] + points[(i + 1) % count]) * neighbour + points[i] * own;
        let odd = |i: usize| 0.5 * (points[i] + points[(i + 1) % count]);
        let closed: Vec<DVec2> = (0..count).flat_map(|i| [even(i), odd(i)]).collect();
        assert_eq!(ControlPolygon::closed(&points, tension).unwrap().subdivided(1).unwrap().points(), closed);
        if count > 3 {
            let open = ControlPolygon::open(&points, tension).unwrap();
            assert_eq!(open.subdivided(1).unwrap().points(), closed[1..2 * count - 2]);
            // Into whatever was there before.
            let mut fine = ControlPolygon::closed(&closed, Tension::CUBIC).unwrap();
            open.subdivide_into(3, &mut fine).unwrap();
            assert_eq!(fine, open.subdivided(3).unwrap());
            assert!(open.subdivide_into(60, &mut fine).is_err());
            assert_eq!(fine, open.subdivided(3).unwrap());
        }
    }
}

#[test]
fn a_quadrilateral() {
    let points = [(1.0, 0.3), (0.2, 1.4), (-0.9, 0.1), (-0.3, -1.2)].map(|(x, y)| DVec2::new(x, y));
    let polygon = ControlPolygon::closed(&points, right_angle()).unwrap();
    let once = polygon.subdivided(1).unwrap().points();
    assert!((once[0] - DVec2::new(0.692_462_120_246, 0.241_421_356_237)).length() < 1e-12);
    assert!((once[1] - DVec2::new(0.6, 0.85)).length() < 1e-12);
    let limit = polygon.limit_points()[0];
    assert!((limit - DVec2::new(0.618_450_760_986, 0.227_323_954_474)).length() < 1e-12);
    let tangent = polygon.limit_tangents()[0];
    assert!((tangent - DVec2::new(0.159_154_943, 0.827_605_704)).length() < 1e-8);
    // The same by brute force.
    let deep = polygon.subdivided(18).unwrap().points();
    assert!((deep[0] - limit).length() < 1e-10);
    let step = FRAC_PI_2 / f64::from(1 << 18);
    let slope = (deep[1] - deep[deep.len() - 1]) / (2.0 * step);
    assert!((slope - tangent).length() < 1e-6);
    // A subdivided polygon has the same limit.
    assert!((polygon.subdivided(3).unwrap().limit_points()[0] - limit).length() < 1e-14);
}

#[test]
fn weights() {
    let [neighbour, own] = right_angle().limit_weights(0);
    assert!((neighbour - 0.181_690_113_816_21).abs() < 1e-14 && (own - FRAC_2_PI).abs() < 1e-15);
    for tension in [right_angle(), Tension::hyperbolic(1.3).unwrap()] {
        // The series takes over where the closed form loses digits, without a jump.
        for level in 4..7 {
            let [a, _] = tension.limit_weights(level);
            assert!((a - 1.0 / 6.0).abs() < 2e-4, "{level}: {a}");
        }
        assert!((tension.alpha(3) - ((1.0 + tension.alpha(2)) / 2.0).sqrt()).abs() < 1e-15);
    }
    let [neighbour, own] = Tension::CUBIC.limit_weights(0);
    assert!((neighbour - 1.0 / 6.0).abs() + (own - 2.0 / 3.0).abs() < 1e-15);
    assert_eq!(Tension::CUBIC.mask(1), [0.125, 0.75]);
    for alpha in [-1.0, -0.5, 0.0, 0.9, 1.0, 3.0] {
        assert!((Tension::new(alpha).unwrap().alpha(0) - alpha).abs() < 1e-14);
    }
}

#[test]
fn the_index_of_the_mask_matters() {
    // The same scheme with the α of the level before: no circle.
    let mut points = square(FRAC_PI_2);
    let mut alpha = 0.0f64;
    for _ in 0..10 {
        let n = points.len();
        let neighbour = 0.25 / (1.0 + alpha);
        points = (0..n)
            .flat_map(|i| {
                let (a, p, b) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
                [(a + b) * neighbour + p * (1.0 - 2.0 * neighbour), 0.5 * (p + b)]
            })
            .collect();
        alpha = ((1.0 + alpha) / 2.0).sqrt();
    }
    let radii: Vec<f64> = points.iter().map(|p| p.length() / FRAC_PI_2).collect();
    let (least, most) = radii.iter().fold((f64::INFINITY, 0f64), |(a, b), &r| (a.min(r), b.max(r)));
    assert!((least - 0.5).abs() < 1e-4 && (most - 0.5786).abs() < 1e-4, "{least} {most}");
}

#[test]
fn conics() {
    let size = 3.0;
    for sides in [3, 4, 5, 6, 17] {
        let ellipse = ControlPolygon::ellipse_of(sides, [3.0, 1.5]).unwrap();
        for p in ellipse.limit(5).unwrap() {
            let residual = (p.x / 3.0).powi(2) + (p.y / 1.5).powi(2) - 1.0;
            assert!(residual.abs() < 1e-14 * size, "{sides}: {residual}");
        }
    }
    let ellipse = ControlPolygon::ellipse([3.0, 1.5]).unwrap();
    let points = ellipse.limit(5).unwrap();
    assert!(points.iter().all(|p| ((p.x / 3.0).powi(2) + (p.y / 1.5).powi(2) - 1.0).abs() < 1e-14));
    let extent = points.iter().fold(DVec2::ZERO, |e, p| e.max(p.abs()));
    assert!((extent - DVec2::new(3.0, 1.5)).length() < 1e-15);

    let residual = |p: &DVec2| ((p.x / 2.0).powi(2) - p.y.powi(2) - 1.0).abs() / (p.x / 2.0).powi(2);
    let worst = |points: &[DVec2]| points.iter().map(residual).fold(0.0, f64::max);
    let ellipse = ControlPolygon::ellipse([2.0, 1.0]).unwrap();
    let moved = hyperbola_of_ellipse(&ellipse.limit(5).unwrap(), 2.0).unwrap();
    assert_eq!(moved.len(), 63);
    assert!(moved.windows(2).all(|w| w[0].y < w[1].y));
    assert!(worst(&moved) < 1e-13, "{}", worst(&moved));
    let raw = hyperbola_of_ellipse(&ellipse.subdivided(5).unwrap().points(), 2.0).unwrap();
    let off = raw.iter().map(|p| ((p.x / 2.0).powi(2) - p.y.powi(2) - 1.0).abs()).fold(0.0, f64::max);
    assert!(off > 1e-2, "{off}");

    for segments in [1, 2, 7] {
        let direct = ControlPolygon::hyperbola([2.0, 1.0], 3.0, segments).unwrap().limit(5).unwrap();
        assert!(worst(&direct) < 1e-14, "{}", worst(&direct));
        assert!((direct[0].y + 3.0).abs() < 1e-13 && (direct[direct.len() - 1].y - 3.0).abs() < 1e-13);
        let parabola = ControlPolygon::parabola(0.5, 3.0, segments).unwrap().limit(4).unwrap();
        for p in &parabola {
            assert!((p.y - p.x * p.x / 2.0).abs() < 1e-13, "{p}");
        }
        assert!((parabola[0].x + 3.0).abs() < 1e-13);
    }
}

#[test]
fn graphs_of_cosine_and_sine() {
    for (graph, phase) in
        [(ControlPolygon::cosine_graph(4).unwrap(), 0.0), (ControlPolygon::sine_graph(4).unwrap(), -FRAC_PI_2)]
    {
        let points = graph.limit(6).unwrap();
        assert!(points[0].x.abs() < 1e-14 && (points[points.len() - 1].x - TAU).abs() < 1e-14);
        let worst = points.iter().map(|p| (p.y - (p.x + phase).cos()).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-14, "{worst}");
        let raw = graph.subdivided(10).unwrap().points();
        let worst = raw.iter().map(|p| (p.y - (p.x + phase).cos()).abs()).fold(0.0, f64::max);
        assert!((1e-7..1e-6).contains(&worst), "{worst}");
        for (p, t) in points.iter().zip(graph.subdivided(6).unwrap().limit_tangents()) {
            assert!((t - DVec2::new(1.0, -(p.x + phase).sin())).length() < 1e-12, "{t}");
        }
    }
}

#[test]
fn straight_lines_and_clamped_ends() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 2.0, 3.0)];
    for tension in [right_angle(), Tension::CUBIC, Tension::hyperbolic(1.0).unwrap()] {
        let curve = ControlPolygon::clamped(&points, tension).unwrap().limit(4).unwrap();
        assert_eq!(curve.len(), 3 * 16 + 1);
        assert!((curve[0] - points[0]).length() < 1e-15 && (curve[48] - points[3]).length() < 1e-14);
        let line = ControlPolygon::clamped(&[DVec3::ZERO, DVec3::X], tension).unwrap().limit(3).unwrap();
        for (i, p) in line.iter().enumerate() {
            assert!((*p - DVec3::X * (i as f64 / 8.0)).length() < 1e-15, "{p}");
        }
    }
}

/// The largest residual of a function on the vertices, of those that `counts`.
fn worst(mesh: &QuadMesh, residual: impl Fn(DVec3) -> f64) -> f64 {
    mesh.positions().iter().map(|&p| residual(p).abs()).fold(0.0, f64::max)
}

fn assert_solid(mesh: &QuadMesh, shells: usize, genus: i64) {
    let report = mesh.to_mesh().unwrap().check();
    assert!(report.is_closed() && report.is_manifold(), "{report:?}");
    assert_eq!((report.shells, report.genus), (shells, Some(genus)));
    assert!(report.volume > 0.0);
}

#[test]
fn quadrics() {
    let [a, b, c] = [2.0, 1.0, 0.7f64];
    let squares = |p: DVec3| [(p.x / a).powi(2), (p.y / b).powi(2), (p.z / c).powi(2)];
    let ellipsoid = SubdivisionRevolution::ellipsoid([a, b, c]).unwrap();
    let one = SubdivisionRevolution::one_sheet([a, b, c], 3.0).unwrap();
    let two = SubdivisionRevolution::two_sheets([a, b, c], 4.0).unwrap();
    let on_ellipsoid = |p: DVec3| squares(p).iter().sum::<f64>() - 1.0;
    // The middles of flat ends are not on the surface.
    let on_one = |p: DVec3| {
        let [x, y, z] = squares(p);
        if x + y < 1e-20 { 0.0 } else { (x + y - z - 1.0) / (1.0 + z) }
    };
    let on_two = |p: DVec3| {
        let [x, y, z] = squares(p);
        if x + y < 1e-20 && z > 2.0 { 0.0 } else { (z - x - y - 1.0) / z }
    };
    for levels in [[0, 0], [2, 3], [5, 5]] {
        let mesh = ellipsoid.limit_mesh(levels).unwrap();
        assert!(worst(&mesh, on_ellipsoid) < 1e-14, "{}", worst(&mesh, on_ellipsoid));
        assert_solid(&mesh, 1, 0);
        let mesh = one.limit_mesh(levels).unwrap();
        assert!(worst(&mesh, on_one) < 1e-13, "{}", worst(&mesh, on_one));
        assert_solid(&mesh, 1, 0);
        let mesh = two.limit_mesh(levels).unwrap();
        assert!(worst(&mesh, on_two) < 1e-13, "{}", worst(&mesh, on_two));
        assert_solid(&mesh, 2, 0);
    }
    let mesh = ellipsoid.limit_mesh([4, 4]).unwrap();
    for (p, n) in mesh.positions().iter().zip(mesh.normals()) {
        let gradient = DVec3::new(p.x / (a * a), p.y / (b * b), p.z / (c * c)).normalize();
        assert!((*n - gradient).length() < 1e-12, "{p}: {n} {gradient}");
    }
    // Without the limit stencil the error falls by 4 a level.
    let raw = |level: u32| worst(&ellipsoid.subdivided_mesh([level, level]).unwrap(), on_ellipsoid);
    assert!((raw(5) / raw(6) - 4.0).abs() < 0.05, "{} {}", raw(5), raw(6));
    assert!(raw(5) > 1e-3);
    let raw = |level: u32| worst(&one.subdivided_mesh([level, level]).unwrap(), on_one);
    assert!((raw(5) / raw(6) - 4.0).abs() < 0.05, "{} {}", raw(5), raw(6));
}

#[test]
fn elliptic_torus_and_cylinder() {
    let torus = SubdivisionRevolution::elliptic_torus([0.5, 0.4], 2.0, 0.7).unwrap();
    let mesh = torus.limit_mesh([4, 5]).unwrap();
    let same = Supertoroid::new([0.5, 0.7 * 0.5, 0.4], 4.0, 1.0, 1.0);
    let residual = worst(&mesh, |p| same.gauge(p) - 1.0);
    assert!(residual < 1e-13, "{residual}");
    assert_solid(&mesh, 1, 1);

    let cylinder = SubdivisionRevolution::elliptic_cylinder([2.0, 1.0], 3.0).unwrap();
    for levels in [[0, 4], [3, 4]] {
        let mesh = cylinder.limit_mesh(levels).unwrap();
        assert_solid(&mesh, 1, 0);
        let off = worst(&mesh, |p| {
            let [x, y] = [p.x / 2.0, p.y];
            if x == 0.0 && y == 0.0 { p.z.abs() - 1.5 } else { x * x + y * y - 1.0 }
        });
        assert!(off < 1e-14, "{off}");
    }
}

#[test]
fn any_profile_along_any_path() {
    let profile = [(3.0, 0.0), (3.5, 1.0), (2.5, 1.2), (2.0, -0.5)].map(|(x, y)| DVec2::new(x, y));
    let path = square(1.2);
    let reversed = |points: &[DVec2]| points.iter().rev().copied().collect::<Vec<_>>();
    for (profile, path) in [
        (profile.to_vec(), path.clone()),
        (reversed(&profile), path.clone()),
        (profile.to_vec(), reversed(&path)),
        (reversed(&profile), reversed(&path)),
    ] {
        let profile = ControlPolygon::closed(&profile, right_angle()).unwrap();
        let path = ControlPolygon::closed(&path, right_angle()).unwrap();
        let ring = SubdivisionRevolution::new(profile, path).unwrap();
        let mesh = ring.limit_mesh([3, 4]).unwrap();
        assert_solid(&mesh, 1, 1);
        // Normals agree with the faces.
        for (quad, corners) in mesh.quads().iter().zip(mesh.quad_corners()) {
            let [p, q, r, s] = quad.map(|i| mesh.positions()[i as usize]);
            let face = (r - p).cross(s - q).normalize();
            assert!(corners.iter().all(|corner| corner.normal.dot(face) > 0.7));
        }
    }
    let vase = [(0.0, -1.0), (1.0, -1.0), (1.5, 0.0), (0.7, 1.0), (1.0, 2.0)].map(|(x, y)| DVec2::new(x, y));
    let vase = ControlPolygon::clamped(&vase, Tension::CUBIC).unwrap();
    let path = ControlPolygon::ellipse([1.0, 1.0]).unwrap();
    let vase = SubdivisionRevolution::new(vase, path).unwrap();
    assert!(!vase.limit_mesh([3, 3]).unwrap().to_mesh().unwrap().check().is_closed());
    assert_solid(&vase.with_ends(ProfileEnd::Pole, ProfileEnd::Flat).limit_mesh([3, 3]).unwrap(), 1, 0);
}

#[test]
fn grids_of_control_points() {
    // The torus as a grid of 4 × 4 points, closed both ways.
    let torus = SubdivisionRevolution::elliptic_torus([0.5, 0.5], 2.0, 1.0).unwrap();
    let (profile, path) = (torus.profile().points(), torus.path().points());
    let points: Vec<DVec3> =
        profile.iter().flat_map(|p| path.iter().map(|q| DVec3::new(p.x * q.x, p.x * q.y, p.y))).collect();
    let grid = ControlGrid::new(&points, [4, 4], [true, true], [right_angle(); 2]).unwrap();
    let mesh = grid.limit_mesh(4).unwrap();
    assert_solid(&mesh, 1, 1);
    let product = torus.limit_mesh([4, 4]).unwrap();
    for ((p, n), (q, m)) in
        mesh.positions().iter().zip(mesh.normals()).zip(product.positions().iter().zip(product.normals()))
    {
        assert!((*p - *q).length() < 1e-13 && (*n - *m).length() < 1e-10, "{p} {q} {n} {m}");
    }
    assert_eq!(grid.control_cage().quads().len(), 16);
    // Open both ways: a bicubic patch of a plane stays one.
    let plane: Vec<DVec3> = (0..30).map(|i| DVec3::new(f64::from(i % 6), f64::from(i / 6), 2.0)).collect();
    let sheet = ControlGrid::new(&plane, [5, 6], [false, false], [Tension::CUBIC; 2]).unwrap();
    let mesh = sheet.limit_mesh(2).unwrap();
    assert_eq!(mesh.quads().len(), 8 * 12);
    assert!(mesh.normals().iter().all(|n| (*n - DVec3::Z).length() < 1e-14));
    let bounds = mesh.to_mesh().unwrap().bounds();
    assert!((bounds.min - DVec3::new(1.0, 1.0, 2.0)).length() < 1e-12);
    assert!((bounds.max - DVec3::new(4.0, 3.0, 2.0)).length() < 1e-12);
    // Closed one way: a tube.
    let tube = ControlGrid::new(&plane, [5, 6], [false, true], [Tension::CUBIC; 2]).unwrap();
    assert_eq!(tube.limit_mesh(1).unwrap().quads().len(), 4 * 12);
}

#[test]
fn what_is_wrong_is_named() {
    let two = [DVec2::X, DVec2::Y];
    let error = ControlPolygon::closed(&two, Tension::CUBIC).unwrap_err();
    assert_eq!(error.to_string(), "2 control points in a closed polygon, allowed: 3 or more");
    assert!(ControlPolygon::open(&square(1.0)[..3], Tension::CUBIC).is_err());
    assert!(ControlPolygon::clamped(&two[..1], Tension::CUBIC).is_err());
    let error = ControlPolygon::closed(&[DVec2::X, DVec2::NAN, DVec2::Y], Tension::CUBIC).unwrap_err();
    assert!(error.to_string().starts_with("control point 1 has the coordinate NaN"), "{error}");
    let polygon = ControlPolygon::closed(&square(1.0), right_angle()).unwrap();
    let error = polygon.subdivided(60).unwrap_err();
    assert!(matches!(error, SubdivisionError::Levels { levels: 60, allowed: 24, .. }), "{error}");
    assert!(polygon.subdivided(u32::MAX).is_err());
    for step in [0.0, -1.0, PI + 1e-9, f64::NAN] {
        assert!(Tension::trigonometric(rad(step)).is_err());
    }
    assert!(Tension::new(f64::NAN).is_err() && Tension::new(-1.1).is_err() && Tension::hyperbolic(1e3).is_err());
    assert!(SubdivisionRevolution::ellipsoid([1.0, 0.0, 1.0]).is_err());
    assert!(SubdivisionRevolution::two_sheets([1.0, 1.0, 1.0], 1.8).is_err());
    assert!(SubdivisionRevolution::elliptic_torus([0.5, 0.4], 0.4, 1.0).is_err());
    let open = ControlPolygon::cosine_graph(3).unwrap();
    assert!(SubdivisionRevolution::new(open.clone(), open).is_err());
    let points = [DVec3::ZERO; 16];
    let error = ControlGrid::new(&points, [4, 5], [true, true], [Tension::CUBIC; 2]).unwrap_err();
    assert_eq!(error.to_string(), "16 control points for a grid of 4 rows and 5 columns");
    assert!(ControlGrid::new(&points[..8], [2, 4], [true, true], [Tension::CUBIC; 2]).is_err());
    let grid = ControlGrid::new(&points, [4, 4], [true, true], [Tension::CUBIC; 2]).unwrap();
    assert!(matches!(grid.subdivided(13).unwrap_err(), SubdivisionError::Levels { allowed: 10, .. }));
    let ellipsoid = SubdivisionRevolution::ellipsoid([1.0, 1.0, 1.0]).unwrap();
    assert!(ellipsoid.limit_mesh([20, 20]).is_err() && ellipsoid.limit_mesh([40, 1]).is_err());
}
