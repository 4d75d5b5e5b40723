//! Points on surfaces, uniform by area.

use glam::DVec3;
use rvachev::{Gielis, Superellipsoid, Superhyperboloid, Supershape, Supertoroid, surface::ParametricSurface};

/// χ² of counts against what is expected of them.
fn chi_square(counts: &[f64], expected: &[f64]) -> f64 {
    counts.iter().zip(expected).map(|(c, e)| (c - e) * (c - e) / e).sum()
}

#[test]
fn a_sphere_is_uniform_by_archimedes() {
    let ball = ParametricSurface::of(&Superellipsoid::new(DVec3::splat(2.0), 1.0, 1.0)).unwrap();
    let n = 40_000;
    let cloud = ball.sample(n, 1).unwrap();
    let (bands, sectors) = (16, 16);
    let mut counts = vec![0.0; bands * sectors];
    for s in &cloud {
        assert!((s.point.length() - 2.0).abs() < 1e-12 && (s.normal - s.point / 2.0).length() < 1e-12);
        let band = ((s.point.z / 4.0 + 0.5) * bands as f64).min(bands as f64 - 1.0) as usize;
        let turn = s.point.y.atan2(s.point.x) / std::f64::consts::TAU + 0.5;
        counts[band * sectors + ((turn * sectors as f64) as usize).min(sectors - 1)] += 1.0;
    }
    let expected = vec![n as f64 / counts.len() as f64; counts.len()];
    // 255 degrees of freedom: mean 255, deviation 22.6; four of them.
    let chi = chi_square(&counts, &expected);
    assert!((165.0..345.0).contains(&chi), "{chi}");
}

#[test]
fn octants_and_faces_get_their_area() {
    // Nearly a box of 2 × 4 × 6: each face by its area.
    let shape = Superellipsoid::new([1.0, 2.0, 3.0], 0.02, 0.02);
    let n = 30_000;
    let mut counts = [0.0; 6];
    for s in ParametricSurface::of(&shape).unwrap().sample(n, 2).unwrap() {
        assert!((shape.gauge(s.point) - 1.0).abs() < 1e-12);
        let axis = s.normal.abs().max_position();
        counts[2 * axis + usize::from(s.normal[axis] > 0.0)] += 1.0;
    }
    let areas = [24.0, 24.0, 12.0, 12.0, 8.0, 8.0];
    let expected = areas.map(|a| a / 88.0 * n as f64);
    let chi = chi_square(&counts, &expected);
    // 5 degrees of freedom; edges are rounded by some per cent.
    assert!(chi < 40.0, "{chi}: {counts:?} {expected:?}");
}

#[test]
fn a_torus_gets_more_outside() {
    let ring = ParametricSurface::of(&Supertoroid::new(DVec3::ONE, 2.0, 1.0, 1.0)).unwrap();
    let n = 40_000;
    let mut counts = vec![0.0; 32];
    for s in ring.sample(n, 3).unwrap() {
        let across = s.point.truncate().length() - 2.0;
        let turn = s.point.z.atan2(across) / std::f64::consts::TAU + 0.5;
        counts[((turn * 32.0) as usize).min(31)] += 1.0;
    }
    // The area of a band of the tube is (2π/32)·2 + ∫cos.
    let expected: Vec<f64> = (0..32)
        .map(|i| {
            let [a, b] = [i, i + 1].map(|i| (f64::from(i) / 32.0 - 0.5) * std::f64::consts::TAU);
            n as f64 * (2.0 * (b - a) + b.sin() - a.sin()) / (4.0 * std::f64::consts::PI)
        })
        .collect();
    let chi = chi_square(&counts, &expected);
    assert!((8.0..65.0).contains(&chi), "{chi}");
}

#[test]
fn samples_repeat_and_lie_on_the_surface() {
    let star = Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0));
    let surface = ParametricSurface::of(&star).unwrap();
    let cloud = surface.sample(500, 9).unwrap();
    assert_eq!(cloud, surface.sample(500, 9).unwrap());
    assert_ne!(cloud, surface.sample(500, 10).unwrap());
    assert!(cloud.iter().all(|s| (star.gauge(s.point) - 1.0).abs() < 1e-12));
    assert!(cloud.iter().all(|s| (s.normal.length() - 1.0).abs() < 1e-12));
    let bowls = ParametricSurface::of(&Superhyperboloid::two_sheets_x([1.2, 0.8, 0.6], 0.4, 1.3, 6.0)).unwrap();
    for s in bowls.sample(500, 4).unwrap() {
        assert!(s.point.x >= 1.2 && s.point.x <= 3.0, "{}", s.point);
    }
    assert!(surface.sample(usize::MAX, 0).is_err());
}
