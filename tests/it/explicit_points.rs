//! Franklin and Barr's points: series, tables, products, reflection, even spacing.

use std::collections::HashSet;
use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};
use rvachev::{
    GeneralisedSuperquadric, Superellipse, Superellipsoid,
    points::{
        BinomialSeries, CurveSpread, ExactExplicit, LogTable, PointMethod, PointSettings, PowerTables, ProductTables,
        RawParametric, SeriesExplicit, Symmetry, reflect,
    },
    rad,
};

/// The wedge 0 ≤ x ≤ y ≤ z on nodes i/size, with exact heights.
fn wedge_nodes(n: f64, size: u32) -> Vec<[f64; 3]> {
    let mut nodes = vec![];
    for i in 0..=size {
        for j in i..=size {
            let [x, y] = [i, j].map(|i| f64::from(i) / f64::from(size));
            let rest = 1.0 - x.powf(n) - y.powf(n);
            if rest > 0.0 && rest.powf(1.0 / n) >= y {
                nodes.push([x, y, rest.powf(1.0 / n)]);
            }
        }
    }
    nodes
}

#[test]
fn coefficients_of_the_series() {
    let series = BinomialSeries::new(5.0, 5).unwrap();
    for (c, exact) in series.coefficients().iter().zip([0.2, 0.08, 0.048, 0.0336, 0.025_536]) {
        assert!((c - exact).abs() < 1e-15);
    }
    let error = |terms: u32| BinomialSeries::new(5.0, terms).unwrap().value(0.5) - 0.870_550_563_296;
    assert!((series.value(0.5) - 0.871_102).abs() < 1e-12);
    assert!((error(5) - 5.514e-4).abs() < 1e-7 && (error(4) - 1.349e-3).abs() < 1e-6);
    let explicit = ExactExplicit::new(5.0).unwrap();
    assert!((explicit.height(0.5, 0.0) - 0.993_670_377_332_229).abs() < 1e-15);
    let u = 0.5f64.powi(5);
    for (k, term) in [0.006_25, 7.8125e-5, 1.464_843_75e-6].into_iter().enumerate() {
        assert!((series.coefficients()[k] * u.powi(k as i32 + 1) - term).abs() < 1e-17, "{k}");
    }
    for (k, term) in [0.1, 0.02, 0.006, 0.0021, 0.000_798].into_iter().enumerate() {
        assert!((series.coefficients()[k] * 0.5f64.powi(k as i32 + 1) - term).abs() < 1e-15, "{k}");
    }
    // Nothing is promised where the series does not converge.
    assert_eq!((series.error_bound(1.0), series.error_bound(f64::NAN)), (f64::INFINITY, f64::INFINITY));
}

#[test]
fn whole_exponents_are_products() {
    let xs: Vec<f64> = (0..=512).map(|i| f64::from(i) / 512.0).collect();
    let ys: Vec<f64> = xs.iter().rev().map(|y| -0.7 * y).collect();
    let single = |v: &[f64]| v.iter().map(|&c| c as f32).collect::<Vec<f32>>();
    for n in [1.0, 2.0, 3.0, 4.0, 7.0, 63.0, 64.0, 10_000.0, 2.5] {
        let explicit = ExactExplicit::new(n).unwrap();
        let (mut z, mut z32) = (vec![0.0; xs.len()], vec![0.0f32; xs.len()]);
        explicit.heights(&xs, &ys, &mut z);
        explicit.heights_single(&single(&xs), &single(&ys), &mut z32);
        for i in 0..xs.len() {
            let exact = explicit.height(xs[i], ys[i]);
            if exact >= xs[i].max(-ys[i]) {
                assert!((z[i] - exact).abs() < 1e-14, "n = {n} at {}: {} {exact}", xs[i], z[i]);
                assert!((f64::from(z32[i]) - exact).abs() < 1e-6, "n = {n} at {}: {} {exact}", xs[i], z32[i]);
            } else {
                assert!(z[i] >= 0.0 && z32[i] >= 0.0);
            }
        }
    }
}

#[test]
fn numbers_of_terms_that_the_bound_asks_for() {
    let exponents = [2.0, 5.0, 20.0, 50.0, 100.0, 346.0];
    let plane = [(1e-3, [5, 5, 4, 3, 2, 1]), (1e-6, [13, 13, 12, 11, 10, 9]), (1e-15, [40, 41, 40, 39, 38, 37])];
    let space = [(1e-3, [8, 8, 7, 5, 4, 2]), (1e-6, [22, 23, 21, 19, 18, 15]), (1e-15, [69, 70, 69, 67, 66, 63])];
    for (largest, rows) in [(0.5, plane), (2.0 / 3.0, space)] {
        for (tolerance, counts) in rows {
            for (n, count) in exponents.into_iter().zip(counts) {
                let series = BinomialSeries::for_tolerance(n, largest, tolerance).unwrap();
                assert_eq!(series.terms(), count, "n = {n}, u ≤ {largest}, {tolerance}");
                let exact = (1.0f64 - largest).powf(1.0 / n);
                let error = series.value(largest) - exact;
                assert!(error > -4e-16 && error < tolerance + 4e-16, "n = {n}: {error}");
            }
        }
    }
}

#[test]
fn methods_keep_their_bounds_in_the_wedge() {
    for n in [2.0, 5.0, 20.0, 50.0] {
        let nodes = wedge_nodes(n, 200);
        let explicit = ExactExplicit::new(n).unwrap();
        let series = SeriesExplicit::new(n, 1e-4).unwrap();
        let logs = LogTable::new(n, 1000, 1e-4).unwrap();
        let tables = PowerTables::new(n, 1000).unwrap();
        let [xs, ys] = [0, 1].map(|k| nodes.iter().map(|p| p[k]).collect::<Vec<f64>>());
        let single = |v: &[f64]| v.iter().map(|&c| c as f32).collect::<Vec<f32>>();
        let (xs32, ys32) = (single(&xs), single(&ys));
        let mut z = vec![0.0; xs.len()];
        explicit.heights(&xs, &ys, &mut z);
        let mut z32 = [(); 4].map(|()| vec![0.0f32; xs.len()]);
        explicit.heights_single(&xs32, &ys32, &mut z32[0]);
        series.heights_single(&xs32, &ys32, &mut z32[1]);
        logs.heights(&xs32, &ys32, &mut z32[2]);
        tables.heights(&xs32, &ys32, &mut z32[3]);
        let bounds = [1e-6, series.error_bound() + 1e-6, logs.error_bound(), tables.error_bound()];
        for (i, &[x, y, exact]) in nodes.iter().enumerate() {
            assert!((explicit.height(x, y) - exact).abs() < 1e-15 && (z[i] - exact).abs() < 1e-14);
            let over = series.height(x, y) - exact;
            assert!(over > -1e-15 && over < series.error_bound(), "n = {n}: {over}");
            for (method, (z, bound)) in z32.iter().zip(bounds).enumerate() {
                let off = (f64::from(z[i]) - exact).abs();
                assert!(off <= bound, "method {method} at ({x}, {y}), n = {n}: {off} above {bound}");
            }
            assert!((logs.height(x, y) - exact).abs() <= bounds[2]);
        }
    }
}

#[test]
fn look_up_fails_outside_the_wedge() {
    let tables = PowerTables::new(5.0, 1000).unwrap();
    let worst =
        |points: &[[f64; 3]]| points.iter().map(|&[x, y, z]| (tables.height(x, y) - z).abs()).fold(0.0, f64::max);
    let inside = worst(&wedge_nodes(5.0, 1000));
    assert!((inside / 2.334e-4 - 1.0).abs() < 0.01, "{inside}");
    let mut all = vec![];
    for i in 0..=1000 {
        for j in 0..=i {
            let [x, y] = [i, j].map(|i: u32| f64::from(i) / 1000.0);
            let rest = 1.0 - x.powi(5) - y.powi(5);
            if rest >= 0.0 {
                all.push([x, y, rest.powf(0.2)]);
            }
        }
    }
    let outside = worst(&all);
    assert!((outside / 0.2180 - 1.0).abs() < 0.01, "{outside}");
}

#[test]
fn the_printed_table_of_the_parametric_form() {
    let printed = [(5.0, [0.9998, 0.9070]), (25.0, [0.9961, 0.9661]), (45.0, [0.9862, 0.9862])];
    for (degrees, [cos, sin]) in printed {
        let [x, _, z] = RawParametric::new(0.04, 1.0).unwrap().point(rad(f64::to_radians(degrees)), rad(0.0));
        assert!((x - cos).abs() < 6e-5 && (z - sin).abs() < 6e-5, "{degrees}: {x} {z}");
    }
    let angles: Vec<f32> = (0..300).map(|i| i as f32 * (FRAC_PI_2 as f32 / 299.0)).collect();
    let turned: Vec<f32> = angles.iter().rev().copied().collect();
    let mut out = [vec![0.0; 300], vec![0.0; 300], vec![0.0; 300]];
    let raw = RawParametric::new(0.5, 1.5).unwrap();
    raw.octant_single(&angles, &turned, out.each_mut().map(|v| v.as_mut_slice()));
    for i in 1..299 {
        let exact = raw.point(rad(f64::from(angles[i])), rad(f64::from(turned[i])));
        for (o, e) in out.iter().zip(exact) {
            assert!((f64::from(o[i]) - e).abs() < 3e-6, "{i}: {} {e}", o[i]);
        }
    }
}

/// Positions as keys.
fn distinct(points: &[DVec3]) -> usize {
    points.iter().map(|p| p.to_array().map(|c| (c + 0.0).to_bits())).collect::<HashSet<_>>().len()
}

#[test]
fn images_are_emitted_once() {
    let n = 5.0;
    let inside: Vec<DVec3> =
        wedge_nodes(n, 30).into_iter().filter(|&[x, y, z]| x > 0.0 && x < y && y < z).map(DVec3::from).collect();
    let images = reflect(&inside[..1], Symmetry::Cube);
    assert_eq!((images.len(), distinct(&images)), (48, 48));
    let all = reflect(&inside, Symmetry::Cube);
    assert_eq!((all.len(), distinct(&all)), (48 * inside.len(), 48 * inside.len()));
    for p in &all {
        assert!((p.abs().to_array().iter().map(|c| c.powf(n)).sum::<f64>() - 1.0).abs() < 1e-12);
    }
    for symmetry in [Symmetry::Cuboid, Symmetry::SquarePrism, Symmetry::Cube] {
        let border = [DVec3::Z, DVec3::splat(0.5), DVec3::new(0.0, 0.5, 0.5), DVec3::new(0.2, 0.2, 0.9)];
        let images = reflect(&border, symmetry);
        assert_eq!(images.len(), distinct(&images), "{symmetry:?}");
    }
}

#[test]
fn whole_surfaces_by_every_method() {
    let methods = [
        (PointMethod::RawParametric, 1e-14),
        (PointMethod::ExactExplicit, 3e-14),
        (PointMethod::BinomialSeries, 1e-5),
        (PointMethod::LogTable, 1e-5),
        (PointMethod::SphericalProduct, 1e-14),
        (PointMethod::PowerTables, 1e-5),
        (PointMethod::Auto, 1e-14),
    ];
    let shape = Superellipsoid::new([1.0, 2.0, 3.0], 0.4, 0.4);
    for (method, bound) in methods {
        let settings = PointSettings { eighth: 12, method, tolerance: 1e-5 };
        let points = shape.points(&settings).unwrap();
        let worst = points.iter().map(|&p| (shape.gauge(p) - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < bound, "{method:?}: {worst}");
        assert_eq!(points.len(), distinct(&points), "{method:?}");
        // Symmetric under every change of sign, and on all sides.
        let sum: DVec3 = points.iter().copied().sum();
        assert!(sum.length() < 1e-9, "{method:?}: {sum}");
        assert!(points.len() > 2000, "{method:?}: {}", points.len());
    }
    let nested = Superellipsoid::new([1.0, 2.0, 3.0], 0.3, 1.2);
    for method in [PointMethod::RawParametric, PointMethod::SphericalProduct, PointMethod::Auto] {
        let points = nested.points(&PointSettings { method, ..PointSettings::default() }).unwrap();
        assert!(points.iter().all(|&p| (nested.gauge(p) - 1.0).abs() < 1e-6));
        assert_eq!(points.len(), distinct(&points), "{method:?}");
    }
    for exponents in [[5.0, 3.0, 1.5], [4.0, 4.0, 2.0], [3.0, 3.0, 3.0]] {
        let shape = GeneralisedSuperquadric::new([1.0, 2.0, 3.0], exponents);
        let points = shape.points(10).unwrap();
        assert_eq!(points.len(), 6 * 20 * 20 + 2, "the nodes of a cube's surface");
        assert_eq!(points.len(), distinct(&points));
        assert!(points.iter().all(|&p| (shape.gauge(p) - 1.0).abs() < 1e-12));
    }
}

#[test]
fn evenly_spaced_points() {
    // 91 samples a quarter.
    let gap = |spread: CurveSpread| {
        let points = Superellipse::new([1.0, 1.0], 0.04).points(45, spread).unwrap();
        assert_eq!(points.len(), 360);
        let next = |i: usize| points[(i + 1) % points.len()];
        (0..points.len()).map(|i| points[i].distance(next(i))).fold(0.0, f64::max)
    };
    assert!((gap(CurveSpread::UniformAngle) - 0.8505).abs() < 1e-3, "{}", gap(CurveSpread::UniformAngle));
    assert!(gap(CurveSpread::Explicit) < 0.0243, "{}", gap(CurveSpread::Explicit));
    assert!(gap(CurveSpread::Radial) < 0.0318, "{}", gap(CurveSpread::Radial));
    let points = Superellipse::new([3.0, 1.0], 1.0).points(2, CurveSpread::Radial).unwrap();
    assert_eq!(points[0], DVec2::new(3.0, 0.0));
    assert!(points.iter().all(|p| ((p.x / 3.0).powi(2) + p.y.powi(2) - 1.0).abs() < 1e-14));
}

#[test]
fn products_are_those_of_the_tables() {
    let tables = ProductTables::new(0.3, 0.8, 20).unwrap();
    let [rows, columns] = tables.size();
    assert_eq!([rows, columns], [41, 41]);
    let mut out = [(); 3].map(|()| vec![0.0; rows * columns]);
    tables.octant(out.each_mut().map(|v| v.as_mut_slice()));
    let shape = Superellipsoid::new(DVec3::ONE, 0.3, 0.8);
    for ((x, y), z) in out[0].iter().zip(&out[1]).zip(&out[2]) {
        let p = DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z));
        assert!((shape.gauge(p) - 1.0).abs() < 1e-6, "{p}");
    }
    assert_eq!([out[0][0], out[1][0], out[2][0]], [1.0, 0.0, 0.0]);
    let mut out = [(); 3].map(|()| vec![0.0; rows * columns]);
    tables.octant_double(out.each_mut().map(|v| v.as_mut_slice()));
    for ((&x, &y), &z) in out[0].iter().zip(&out[1]).zip(&out[2]) {
        assert!((shape.gauge(DVec3::new(x, y, z)) - 1.0).abs() < 1e-14);
    }
}

#[test]
fn what_is_wrong_is_named() {
    let error = BinomialSeries::new(0.5, 3).unwrap_err();
    assert_eq!(error.to_string(), "n is 0.5, allowed: above 1, up to 10000");
    assert!(BinomialSeries::for_tolerance(5.0, 1.0, 1e-3).is_err());
    assert!(BinomialSeries::for_tolerance(5.0, 0.5, 0.0).is_err());
    assert!(ExactExplicit::new(f64::NAN).is_err() && PowerTables::new(5.0, 3).is_err());
    let shape = Superellipsoid::new([1.0, 2.0, 3.0], 0.4, 0.5);
    let settings = PointSettings { method: PointMethod::PowerTables, ..PointSettings::default() };
    assert_eq!(
        shape.points(&settings).unwrap_err().to_string(),
        "exponents are 0.4 and 0.5, allowed for this method: equal ones"
    );
    let settings = PointSettings { eighth: 0, ..PointSettings::default() };
    assert!(shape.points(&settings).is_err());
    assert!(shape.points(&PointSettings { tolerance: f64::NAN, ..PointSettings::default() }).is_err());
    assert!(Superellipse::new([1.0, -1.0], 1.0).points(4, CurveSpread::Radial).is_err());
}
