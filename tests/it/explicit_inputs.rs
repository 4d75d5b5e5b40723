//! Explicit surfaces and depth buffers with any input: an error or finite numbers, never a panic.

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use rvachev::{
    Camera, GeneralisedSuperquadric, Gielis, Mesh, Radius, Superellipse, Superellipsoid, Superhyperboloid, Supershape,
    Supertoroid, deg,
    points::{
        BinomialSeries, CurveSpread, ExactExplicit, LogTable, PointMethod, PointSettings, PowerTables, ProductTables,
        RawParametric, SeriesExplicit,
    },
    rad,
    raster::{Buffers, ClosedMesh, Csg, CsgMethod, Facing, LayerSource, RasterView},
    subdivision::{ControlGrid, ControlPolygon, SubdivisionRevolution, Tension, hyperbola_of_ellipse},
    surface::{ParametricCurve, ParametricSurface, PatchSettings, QuadMesh, Spacing},
};

/// Numbers that break things.
const EVIL: [f64; 18] = [
    0.0,
    -0.0,
    5e-324,
    1e-300,
    1e-12,
    1e-9,
    1e6,
    1e9,
    1e12,
    1e60,
    1e300,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    -1.0,
    -1e300,
    -1e-9,
];

/// Numbers that are mostly right.
const GOOD: [f64; 8] = [0.01, 0.3, 0.7, 1.0, 1.5, 2.0, 3.0, 10.0];

pub(super) struct Chance(pub(super) u64);

impl Chance {
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }

    /// Good three times of four.
    pub(super) fn number(&mut self) -> f64 {
        if self.below(4) > 0 { GOOD[self.below(GOOD.len())] } else { EVIL[self.below(EVIL.len())] }
    }

    pub(super) fn numbers<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.number())
    }

    /// Counts that stay small where they are allowed.
    fn count(&mut self) -> u32 {
        [0, 1, 2, 3, 4, 7, 9, u32::MAX - 1, u32::MAX][self.below(9)]
    }
}

/// Any finite angle, however large.
fn angles() -> impl Iterator<Item = f64> {
    EVIL.into_iter().chain(GOOD).filter(|angle| angle.is_finite())
}

fn finite(what: &str, points: impl IntoIterator<Item = DVec3>) {
    for p in points {
        assert!(p.is_finite(), "{what}: {p}");
    }
}

fn sound(what: &str, mesh: &QuadMesh) {
    finite(what, mesh.positions().iter().copied());
    finite(what, mesh.normals().iter().copied());
    for corner in mesh.quad_corners().iter().flatten().chain(mesh.triangle_corners().iter().flatten()) {
        assert!(corner.normal.is_finite() && corner.texture.is_finite(), "{what}: {corner:?}");
    }
}

fn try_surface(what: &str, surface: &ParametricSurface, chance: &mut Chance) {
    // Never a point that is none, and looks like one.
    assert!(
        surface.point(rad(0.3), rad(f64::NAN)).is_nan() && surface.point(rad(f64::NAN), rad(0.3)).is_nan(),
        "{what}"
    );
    for eta in angles() {
        let omega = GOOD[chance.below(GOOD.len())];
        for frame in [surface.frame(rad(eta), rad(omega)), surface.frame(rad(omega), rad(eta))] {
            finite(what, [frame.point, frame.normal, frame.along_eta, frame.along_omega]);
        }
    }
    for eta in surface.eta_range().into_iter().chain(surface.omega_range()) {
        assert!(eta.is_finite(), "{what}");
    }
    let size = surface.point(rad(0.1), rad(0.1)).abs().max_element();
    let tolerance = [f64::NAN, -1.0, 0.0, 0.02 * size, 0.2 * size, 1e300][chance.below(6)];
    for spacing in [Spacing::UniformAngle, Spacing::EqualArc, Spacing::Chord(tolerance)] {
        let settings = PatchSettings { rows: chance.count(), columns: chance.count(), spacing };
        if let Ok(mesh) = surface.quad_mesh(&settings) {
            sound(what, &mesh);
        }
    }
    if let Ok(points) = surface.sample(3, 1) {
        finite(what, points.iter().flat_map(|s| [s.point, s.normal]));
    }
}

#[test]
fn parametric_surfaces_take_anything() {
    let mut chance = Chance(1);
    for _ in 0..60 {
        let [a, b, c, e1, e2, ring, half] = chance.numbers();
        let axes = [a, b, c];
        let gielis = |chance: &mut Chance| {
            let [m, n1, n2, n3] = chance.numbers();
            Gielis::new(m, n1, n2, n3)
        };
        let radius = if chance.below(2) == 0 { Radius::Standard } else { Radius::Rational };
        let supershape = Supershape::with(gielis(&mut chance), gielis(&mut chance), axes, radius);
        for (what, surface) in [
            ("superellipsoid", ParametricSurface::of(&Superellipsoid::new(axes, e1, e2))),
            ("supertoroid", ParametricSurface::of(&Supertoroid::new(axes, ring, e1, e2))),
            ("one sheet", ParametricSurface::of(&Superhyperboloid::one_sheet(axes, e1, e2, 2.0 * half))),
            ("one sheet x", ParametricSurface::of(&Superhyperboloid::one_sheet_x(axes, e1, e2, 2.0 * half))),
            ("two sheets", ParametricSurface::of(&Superhyperboloid::two_sheets(axes, e1, e2, 2.0 * half))),
            ("two sheets x", ParametricSurface::of(&Superhyperboloid::two_sheets_x(axes, e1, e2, 2.0 * half))),
            ("supershape", ParametricSurface::of(&supershape)),
        ] {
            let what = format!("{what} {axes:?} {e1} {e2} {ring} {half} {supershape:?}");
            match surface {
                Ok(surface) => try_surface(&what, &surface, &mut chance),
                Err(error) => assert!(error.to_string().contains(" is "), "{error}"),
            }
        }
    }
}

#[test]
fn curves_take_anything() {
    let mut chance = Chance(2);
    for _ in 0..400 {
        let [a, b, c, n1, n2, n3] = chance.numbers();
        let gielis = Gielis::new(c, n1, n2, n3);
        for curve in [
            ParametricCurve::of(&Superellipse::new([a, b], c)),
            ParametricCurve::ellipse([a, b]),
            ParametricCurve::hyperbola([a, b], c),
            ParametricCurve::parabola(a, b),
            ParametricCurve::gielis(&gielis, Radius::Standard),
            ParametricCurve::gielis(&gielis, Radius::Rational),
        ] {
            let Ok(curve) = curve else { continue };
            let [first, last] = curve.range();
            for t in [first, 0.5 * (first + last), last].into_iter().chain(angles()) {
                let (p, n, tangent) = (curve.point(t), curve.normal(t), curve.tangent(t));
                assert!(n.is_finite() && tangent.is_finite(), "{curve:?} at {t}: {n}");
                // A parabola goes on for ever.
                assert!(p.is_finite() || !curve.is_closed() && t.abs() > 1e9, "{curve:?} at {t}: {p}");
            }
        }
        let spread = [CurveSpread::UniformAngle, CurveSpread::Explicit, CurveSpread::Radial][chance.below(3)];
        if let Ok(points) = Superellipse::new([a, b], c).points(chance.count(), spread) {
            assert!(points.iter().all(|p| p.is_finite()), "{a} {b} {c} {spread:?}");
        }
    }
}

#[test]
fn points_take_anything() {
    let mut chance = Chance(3);
    let methods = [
        PointMethod::RawParametric,
        PointMethod::ExactExplicit,
        PointMethod::BinomialSeries,
        PointMethod::LogTable,
        PointMethod::SphericalProduct,
        PointMethod::PowerTables,
        PointMethod::Auto,
    ];
    for _ in 0..200 {
        let [a, b, c, n, tolerance, x, y] = chance.numbers();
        let (terms, size) = (chance.count(), chance.count());
        let e2 = if chance.below(2) == 0 { n } else { c };
        let settings = PointSettings {
            eighth: chance.count(),
            method: methods[chance.below(methods.len())],
            tolerance: if chance.below(2) == 0 { 1e-3 } else { tolerance },
        };
        if let Ok(points) = Superellipsoid::new([a, b, c], n, e2).points(&settings) {
            finite(&format!("{settings:?} {a} {b} {c} {n} {e2}"), points);
        }
        if let Ok(points) = GeneralisedSuperquadric::new([a, b, c], [n, x, y]).points(chance.count()) {
            finite("generalised", points);
        }
        let series = [BinomialSeries::new(n, terms), BinomialSeries::for_tolerance(n, x, tolerance)];
        for series in series.into_iter().flatten() {
            assert!(series.coefficients().iter().all(|c| c.is_finite()), "{series:?}");
            for u in EVIL {
                assert!(!series.error_bound(u).is_nan() && series.error_bound(u) >= 0.0, "{series:?} at {u}");
            }
        }
        let mut heights = [1.0f32; EVIL.len()];
        let evil = EVIL.map(|x| x as f32);
        let check = |what: &str, z: f64, x: f64, y: f64| {
            let inside = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
            assert!(z.is_finite() || !inside, "{what} over ({x}, {y}): {z}");
        };
        if let Ok(explicit) = ExactExplicit::new(n) {
            explicit.heights_single(&evil, &evil, &mut heights);
            EVIL.iter().zip(heights).for_each(|(&x, z)| check("explicit", z.into(), x, x));
            check("explicit", explicit.height(x, y), x, y);
        }
        for series in [SeriesExplicit::new(n, tolerance), SeriesExplicit::with_terms(n, terms)].into_iter().flatten() {
            series.heights_single(&evil, &evil, &mut heights);
            EVIL.iter().zip(heights).for_each(|(&x, z)| check("series", z.into(), x, x));
            check("series", series.height(x, y), x, y);
            assert!(series.error_bound().is_finite());
        }
        if let Ok(logs) = LogTable::new(n, size.min(1 << 12), tolerance) {
            logs.heights(&evil, &evil, &mut heights);
            EVIL.iter().zip(heights).for_each(|(&x, z)| check("logarithms", z.into(), x, x));
            check("logarithms", logs.height(x, y), x, y);
        }
        if let Ok(tables) = PowerTables::new(n, size.min(1 << 12)) {
            tables.heights(&evil, &evil, &mut heights);
            assert!(heights.iter().all(|z| z.is_finite()));
            assert!(tables.height(x, y).is_finite() && tables.error_bound().is_finite());
        }
        if let Ok(tables) = ProductTables::new(n, e2, size.min(100)) {
            let [rows, columns] = tables.size();
            let mut out = [(); 3].map(|()| vec![f64::NAN; rows * columns]);
            tables.octant_double(out.each_mut().map(|v| v.as_mut_slice()));
            assert!(out.iter().flatten().all(|c| c.is_finite()));
        }
        if let Ok(raw) = RawParametric::new(n, e2) {
            for angle in angles() {
                finite("raw", [raw.point(rad(angle), rad(0.3)).into(), raw.point(rad(0.3), rad(angle)).into()]);
            }
        }
    }
}

#[test]
fn subdivision_takes_anything() {
    let mut chance = Chance(4);
    let tension = |chance: &mut Chance| {
        let t = chance.number();
        [Tension::new(t), Tension::trigonometric(rad(t)), Tension::hyperbolic(t)][chance.below(3)].clone()
    };
    for _ in 0..300 {
        if let Ok(tension) = tension(&mut chance) {
            for level in [0, 1, 30, 1000, 1 << 31, u32::MAX] {
                let [a, b] = tension.limit_weights(level);
                let [c, d] = tension.mask(level);
                let all = [a, b, c, d, tension.alpha(level), tension.step(level)];
                assert!(all.iter().all(|v| v.is_finite()), "{tension:?} at {level}: {all:?}");
                assert!(tension.step(level) <= tension.step(0), "{tension:?} at {level}");
            }
            let points: Vec<DVec3> = (0..chance.below(7)).map(|_| chance.numbers().into()).collect();
            for polygon in [
                ControlPolygon::closed(&points, tension),
                ControlPolygon::open(&points, tension),
                ControlPolygon::clamped(&points, tension),
            ] {
                let Ok(polygon) = polygon else { continue };
                finite("polygon", polygon.limit(2).unwrap());
                finite("polygon", polygon.subdivided(2).unwrap().limit_tangents());
                assert!(polygon.subdivided(u32::MAX).is_err());
            }
            let size = [chance.below(6), chance.below(6)];
            let closed = [chance.below(2) == 0, chance.below(2) == 0];
            let points: Vec<DVec3> = (0..size[0] * size[1]).map(|_| chance.numbers().into()).collect();
            if let Ok(grid) = ControlGrid::new(&points, size, closed, [tension; 2]) {
                sound("grid", &grid.limit_mesh(1).unwrap());
                assert!(grid.limit_mesh(u32::MAX).is_err());
            }
        }
        let [a, b, c, d] = chance.numbers();
        let (count, sides) = (chance.count(), chance.count());
        for polygon in [
            ControlPolygon::ellipse([a, b]),
            ControlPolygon::ellipse_of(sides, [a, b]),
            ControlPolygon::hyperbola([a, b], c, count),
            ControlPolygon::parabola(a, b, count),
            ControlPolygon::cosine_graph(count),
            ControlPolygon::sine_graph(count),
        ] {
            let Ok(polygon) = polygon else { continue };
            assert!(polygon.limit(1).unwrap().iter().all(|p| p.is_finite()), "{polygon:?}");
            if let Ok(moved) = hyperbola_of_ellipse(&polygon.points(), c) {
                assert!(moved.iter().all(|p| p.is_finite()), "{c} of {polygon:?}");
            }
        }
        for revolution in [
            SubdivisionRevolution::ellipsoid([a, b, c]),
            SubdivisionRevolution::one_sheet([a, b, c], 2.0 * d),
            SubdivisionRevolution::two_sheets([a, b, c], 2.0 * d),
            SubdivisionRevolution::elliptic_torus([a, b], c, d),
            SubdivisionRevolution::elliptic_cylinder([a, b], c),
        ] {
            let Ok(revolution) = revolution else { continue };
            let what = format!("{revolution:?}");
            sound(&what, &revolution.limit_mesh([1, 1]).unwrap());
            sound(&what, &revolution.subdivided_mesh([1, 1]).unwrap());
            sound(&what, &revolution.control_cage());
            assert!(revolution.limit_mesh([u32::MAX, 1]).is_err() && revolution.limit_mesh([1, u32::MAX]).is_err());
        }
    }
    let bad = [DVec2::new(f64::NAN, 1.0), DVec2::new(1.0, f64::NAN)];
    assert!(bad.iter().all(|&p| hyperbola_of_ellipse(&[p], 1.0).is_err()));
    for a in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(hyperbola_of_ellipse(&[DVec2::ONE], a).unwrap_err().to_string().starts_with("a is "));
    }
}

fn block() -> Mesh {
    ParametricSurface::of(&Superellipsoid::new([1.0, 0.8, 0.6], 0.5, 0.5))
        .unwrap()
        .mesh(&PatchSettings::default())
        .unwrap()
}

#[test]
fn depth_buffers_take_anything() {
    let mut chance = Chance(5);
    let mesh = block();
    let size = |chance: &mut Chance| [0, 1, 3, 33, 40, 16385, u32::MAX][chance.below(7)];
    let mut drawn = 0;
    for _ in 0..400 {
        let [a, b, c, d, e, f] = chance.numbers();
        let camera = match chance.below(2) {
            0 => Camera::perspective(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::Z, deg(50.0 * chance.number())),
            _ => Camera::orthographic(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::Z, chance.number()),
        };
        let Ok(view) = RasterView::new(&camera, size(&mut chance), size(&mut chance)) else { continue };
        let near = chance.number();
        let view = view.with_near(near).unwrap_or(view);
        let layers = view.layers(ClosedMesh::new(&mesh).unwrap());
        let other = view.layers(ClosedMesh::new(&mesh).unwrap());
        let operands: [&dyn LayerSource; 2] = [&layers, &other];
        let tree = Csg::operand(0) & Csg::operand(chance.below(3) as u32);
        for method in [CsgMethod::Intervals, CsgMethod::Sequenced, CsgMethod::Stencil] {
            let Ok(buffers) = view.csg(&operands, &tree, method) else { continue };
            drawn += usize::from(buffers.depths().iter().any(|d| d.is_finite()));
            assert!(buffers.depths().iter().all(|d| !d.is_nan()), "{camera:?}");
            let points = (0..view.width()).filter_map(|x| buffers.point(x, x));
            finite("depth", points);
            buffers.picture(&operands, &[[200; 3]]).unwrap();
            buffers.depth_picture().unwrap();
            if let Ok(image) = buffers.range_image() {
                finite(
                    "range image",
                    image.points(rvachev::range_image::Coordinates::World).unwrap().positions().iter().copied(),
                );
            }
        }
        let mut buffers = Buffers::new(&view);
        buffers.draw(&view.surface(&mesh), 7, Facing::Back).unwrap();
        assert!(buffers.picture(&operands, &[[200; 3]]).is_ok() != buffers.depths().iter().any(|d| d.is_finite()));
    }
    assert!(drawn > 10, "{drawn}");
}

#[test]
fn deformations_of_meshes_take_anything() {
    let mut chance = Chance(6);
    let mesh = block();
    for _ in 0..600 {
        let [a, b, c] = chance.numbers();
        let matrix = DMat3::from_cols_array(&chance.numbers());
        let map = DAffine3::from_mat3_translation(matrix, chance.numbers().into());
        for result in [mesh.taper(a, b, c), mesh.twist(rad(a)), mesh.bend(a, rad(b)), mesh.affine(map)] {
            match result {
                Ok(mesh) => {
                    let normals = mesh.normals().unwrap_or(&[]);
                    assert!(
                        mesh.positions().iter().chain(normals).all(|p: &Vec3| p.is_finite()),
                        "{a} {b} {c} {map:?}"
                    );
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}
