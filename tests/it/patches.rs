//! Parameter patches: points, frames, closed meshes.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use rvachev::{
    Field, Gielis, Mesh, ParametricSurface, PatchSettings, Radius, Spacing, Superellipsoid, Superhyperboloid,
    Supershape, Supertoroid,
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
    let gradient = move |p: DVec3| -DVec3::from(other.eval(rvachev::Dual::point(p.to_array())).gradient());
    Case { name, surface, residual: Box::new(value), gradient: Box::new(gradient), shells, genus }
}

fn cases() -> Vec<Case> {
    let mut cases = vec![];
    for e in [[1.0, 1.0], [0.04, 0.04], [0.3, 1.5], [2.0, 2.0], [2.0, 0.1], [1.5, 2.5], [3.0, 0.5], [0.01, 1.0]] {
        let shape = Superellipsoid::new([1.0, 2.0, 3.0], e[0], e[1]);
        cases.push(case(shape, shape.surface().unwrap(), 1, 0));
    }
    for (ring, e1, e2) in [(1.5, 0.3, 0.7), (3.0, 1.0, 1.0), (2.0, 2.0, 0.1)] {
        let shape = Supertoroid::new([1.2, 0.8, 0.6], ring, e1, e2);
        cases.push(case(shape, shape.surface().unwrap(), 1, 1));
    }
    for e in [[0.4, 1.3], [1.0, 1.0], [0.05, 0.05], [2.0, 1.8]] {
        let a = [1.2, 0.8, 0.6];
        for shape in [
            Superhyperboloid::one_sheet(a, e[0], e[1], 1.5),
            Superhyperboloid::one_sheet_x(a, e[0], e[1], 1.5),
            Superhyperboloid::two_sheets(a, e[0], e[1], 1.5),
            Superhyperboloid::two_sheets_x(a, e[0], e[1], 3.0),
        ] {
            let shells = if shape.has_two_sheets() { 2 } else { 1 };
            cases.push(case(shape, shape.surface().unwrap(), shells, 0));
        }
    }
    let (five, six) = (Gielis::new(5.0, 3.0, 2.0, 8.0), Gielis::new(6.0, 2.0, 7.0, 7.0));
    let star = Gielis::rational(5, 2, 3.0, 7.0, 7.0);
    for (equator, meridian) in
        [(six, Gielis::new(4.0, 10.0, 10.0, 10.0)), (five, Gielis::new(3.0, 4.0, 4.0, 4.0)), (star, Gielis::circle())]
    {
        let shape = Supershape::with(equator, meridian, [1.0, 1.5, 0.8], Radius::Standard);
        cases.push(case(shape.clone(), shape.surface().unwrap(), 1, 0));
    }
    let rational = Supershape::with(six, Gielis::new(4.0, 4.0, 4.0, 4.0), [1.0, 1.5, 0.8], Radius::Rational);
    cases.push(case(rational.clone(), rational.surface().unwrap(), 1, 0));
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
            for eta in parameters(surface.eta_range()) {
                for omega in parameters(surface.omega_range()) {
                    let frame = surface.frame(eta, omega);
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
        let surface = Superellipsoid::new([3.0, 2.0, 1.0], e, e).surface().unwrap();
        for omega in [0.1, PI, -2.0] {
            assert_eq!(surface.point(FRAC_PI_2, omega), DVec3::Z);
            assert_eq!(surface.point(-FRAC_PI_2, omega), DVec3::NEG_Z);
            assert_eq!(surface.normal(FRAC_PI_2, omega), DVec3::Z);
        }
        assert_eq!(surface.point(0.0, PI), DVec3::new(-3.0, 0.0, 0.0));
        assert_eq!(surface.point(0.0, -PI), surface.point(0.0, PI));
        assert_eq!(surface.point(0.0, FRAC_PI_2), DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(surface.normal(0.0, FRAC_PI_2), DVec3::Y);
    }
    let ring = Supertoroid::new([1.2, 0.8, 0.6], 1.5, 0.01, 0.01).surface().unwrap();
    assert_eq!(ring.point(PI, FRAC_PI_2), DVec3::new(0.0, 0.4, 0.0));
    let shape = Supershape::new(Gielis::new(6.0, 2.0, 0.5, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
    assert_eq!(shape.surface().unwrap().point(0.0, PI).y, 0.0);
    assert_eq!(shape.surface().unwrap().point(FRAC_PI_2, 1.0), DVec3::Z);
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
        assert!(report.is_closed() && report.is_manifold(), "{}: {report:?}", case.name);
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
fn a_horn_is_closed_where_it_touches_the_axis() {
    let horn = Supertoroid::new([1.0, 1.0, 1.0], 1.0, 1.0, 1.0).surface().unwrap();
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
        (ellipsoid.surface().unwrap(), 25.132_741_228_718),
        (cushion.surface().unwrap(), 38.359_362_386_288),
        (ring.surface().unwrap(), 23.439_946_622_042),
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
fn what_is_wrong_is_named() {
    let shape = Superellipsoid::new([1.0, -2.0, 3.0], 1.0, 1.0);
    assert!(shape.surface().unwrap_err().to_string().starts_with("semi_axes.y is -2"));
    let ball = Superellipsoid::new([1.0, 2.0, 3.0], 1.0, 1.0).surface().unwrap();
    let settings = PatchSettings { columns: 2, ..PatchSettings::default() };
    assert_eq!(ball.mesh(&settings).unwrap_err().to_string(), "columns is 2, allowed: 3 to 100000");
    let settings = PatchSettings { rows: 100_000, columns: 100_000, spacing: Spacing::UniformAngle };
    assert!(ball.mesh(&settings).unwrap_err().to_string().starts_with("rows · columns is 10000000000"));
}
