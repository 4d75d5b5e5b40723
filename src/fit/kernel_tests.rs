//! Derivatives of all families against differences.

use glam::{DMat3, DVec2, DVec3};

use super::cost::Cost;
use super::deformable::Deformable;
use super::gielis::{Curve, Supershaped, Ties};
use super::kernel::{Model, pass, residuals};
use super::samples::Samples;
use super::superquadric::Superquadric;

fn base() -> Superquadric {
    Superquadric {
        e: [0.4, 1.3],
        semi_axes: DVec3::new(1.2, 0.8, 2.0),
        rotation: DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.8),
        center: DVec3::new(0.1, -0.2, 0.3),
    }
}

/// Of the points' residuals, each point alone: half the gradient over the residual is a row.
fn check<M: Model<N>, const N: usize>(model: &M, costs: &[Cost], skip: &[usize]) {
    for &cost in costs {
        for point in [DVec3::new(0.7, 0.5, 1.2), DVec3::new(-1.1, 0.4, -0.9), DVec3::new(0.3, -1.3, 0.8)] {
            let samples = Samples::<f64>::new([point].into_iter());
            let mut weights = vec![0.0; samples.padded()];
            weights[0] = 1.0;
            let mut out = vec![0.0; samples.padded()];
            let sums = pass::<f64, M, N>(model, &samples, &weights, cost, &mut out);
            let residual = out[0];
            for i in 0..N {
                if skip.contains(&i) {
                    continue;
                }
                let value = |h: f64| {
                    let mut step = [0.0; N];
                    step[i] = h;
                    let mut out = vec![0.0; samples.padded()];
                    residuals::<f64, M, N>(&model.moved(&step), &samples, cost, &mut out);
                    out[0]
                };
                let slope = (value(1e-5) - value(-1e-5)) / 2e-5;
                let row = sums.gradient[i] / residual;
                assert!((row - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{cost:?} {i}: {row} {slope}");
            }
        }
    }
}

/// All costs whose weight is not a constant of the step.
const COSTS: [Cost; 3] = [Cost::Radial, Cost::SolinaBajcsy, Cost::Gauge];

#[test]
fn derivatives_of_superellipsoids() {
    check(&base(), &COSTS, &[]);
}

/// A supershape of any exponents.
fn shaped(rational: bool) -> Supershaped {
    Supershaped {
        equator: Curve { m: 5, n: [3.0, 4.0, 2.5] },
        meridian: Curve { m: 4, n: [5.0, 3.0, 4.0] },
        semi_axes: DVec3::new(1.2, 0.8, 2.0),
        rotation: base().rotation,
        center: base().center,
        ties: Ties::Free,
        rational,
    }
}

#[test]
fn derivatives_of_supershapes() {
    check(&shaped(false), &COSTS, &[]);
    check(&shaped(true), &COSTS, &[]);
}

/// The radial residual is along rays of the solid before its deformation, and its rows leave out
/// how these turn: the gauge's are exact.
#[test]
fn derivatives_of_deformed_superellipsoids() {
    let model = |bend, twist| Deformable { base: base(), taper: [0.3, -0.4], twist, bend };
    let costs = [Cost::SolinaBajcsy, Cost::Gauge];
    check(&model(DVec2::new(0.2, -0.1), 0.3), &costs, &[]);
    check(&model(DVec2::ZERO, 0.0), &costs, &[]);
    check(&model(DVec2::new(-0.15, 0.25), -0.2), &costs, &[]);
}

/// How many points a second a pass with all derivatives takes.
#[test]
#[ignore = "prints speeds: for optimised builds"]
fn points_a_second() {
    fn speed<E: super::kernel::Number, M: Model<N>, const N: usize>(model: &M) -> f64 {
        let points = (0..300).map(|i| {
            let t = f64::from(i);
            DVec3::new((0.37 * t).sin(), (0.61 * t).cos(), 1.5 * (0.23 * t).sin())
        });
        let samples = Samples::<E>::new(points);
        let weights = vec![E::of(1.0); samples.padded()];
        let mut out = vec![E::default(); samples.padded()];
        let mut best = f64::INFINITY;
        for _ in 0..20 {
            let start = cpu_time::ThreadTime::now();
            for _ in 0..100 {
                std::hint::black_box(pass::<E, M, N>(model, &samples, &weights, Cost::Normal, &mut out).square);
            }
            best = best.min(start.elapsed().as_secs_f64());
        }
        100.0 * samples.len() as f64 / best / 1e6
    }
    let shape = shaped(false);
    let bent = Deformable { base: base(), taper: [0.3, -0.4], twist: 0.3, bend: DVec2::new(0.2, -0.1) };
    println!("million points a second           f32      f64");
    println!("superellipsoid               {:8.1} {:8.1}", speed::<f32, _, 11>(&base()), speed::<f64, _, 11>(&base()));
    println!("supershape                   {:8.1} {:8.1}", speed::<f32, _, 15>(&shape), speed::<f64, _, 15>(&shape));
    println!("deformed                     {:8.1} {:8.1}", speed::<f32, _, 16>(&bent), speed::<f64, _, 16>(&bent));
}
