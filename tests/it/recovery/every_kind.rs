//! What holds for every kind of fit: the same bits on any number of threads, quick cancelling,
//! valid solids.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use glam::{DMat3, DVec2, DVec3};
use rvachev::fit::{
    Fit, FitError, FitSettings, Shape, Symmetry, deformed_with, superellipsoid_with, supershape, supershape_with,
};
use rvachev::{CancelToken, PointCloud, Progress, Run};

use super::bent::Bent;
use super::clouds::{CONDITIONS, Quadric, cloud};
use super::shapes::Shaped;
use crate::support::Random;

type With = fn(&PointCloud, &FitSettings, &Run) -> Result<Fit, FitError>;

const KINDS: [With; 3] = [superellipsoid_with, supershape_with, deformed_with];

/// A cloud of each kind, some of it strewn.
fn clouds() -> [PointCloud; 3] {
    let base = Quadric {
        e: [0.4, 0.6],
        semi_axes: DVec3::new(1.2, 0.8, 2.0),
        rotation: DMat3::from_rotation_x(0.3),
        center: DVec3::Y,
    };
    let bent = Bent { base, taper: [0.4, 0.1], twist: 0.0, bend: DVec2::new(0.3, 0.1) };
    let mut random = Random::new(5);
    let points = [
        cloud(&base, CONDITIONS[3], 6000, &mut random),
        Shaped::star().cloud(CONDITIONS[2], 500, &mut random),
        bent.cloud(CONDITIONS[1], 500, &mut random),
    ];
    points.map(|points| PointCloud::new(points).unwrap())
}

#[test]
fn threads_do_not_change_a_bit_and_seeds_do() {
    for (with, points) in KINDS.into_iter().zip(clouds()) {
        let fits = [1, 2, 8].map(|threads| {
            let run = Run { threads, ..Run::default() };
            with(&points, &FitSettings::default(), &run).unwrap()
        });
        for other in &fits[1..] {
            assert_eq!(fits[0].to_json(), other.to_json());
            assert_eq!(fits[0].weights(), other.weights());
            assert_eq!(fits[0].covariance(), other.covariance());
            assert_eq!(fits[0].criterion(), other.criterion());
        }
        let settings = FitSettings { seed: 5, ..FitSettings::default() };
        let other = with(&points, &settings, &Run::default()).unwrap();
        assert_ne!(fits[0].translation(), other.translation());
    }
}

/// How long a fit goes on once it is cancelled at a part of its way.
fn late(with: With, points: &PointCloud, at: f64) -> Duration {
    let cancel = CancelToken::new();
    let (token, since) = (cancel.clone(), Arc::new(Mutex::new(None)));
    let sink = since.clone();
    let progress = Progress::new(move |fraction| {
        let mut since = sink.lock().unwrap();
        if fraction >= at && since.is_none() {
            *since = Some(Instant::now());
            token.cancel();
        }
    });
    let run = Run { threads: 1, cancel, progress: Some(progress) };
    let error = with(points, &FitSettings::default(), &run).unwrap_err();
    assert!(matches!(error, FitError::Cancelled(_)), "{error}");
    let since = since.lock().unwrap();
    since.unwrap().elapsed()
}

#[test]
fn cancelling_takes_no_longer_than_50_ms() {
    let [first, second, third] = clouds();
    // Many points: 200 000 of a ball.
    let mut random = Random::new(2);
    let many = PointCloud::new((0..200_000).map(|_| random.direction()).collect()).unwrap();
    for (with, points) in [(KINDS[0], first), (KINDS[1], second), (KINDS[2], third), (KINDS[0], many)] {
        for at in [0.0, 0.3] {
            // Others work on this machine, too.
            let least = (0..3).map(|_| late(with, &points, at)).min().unwrap();
            assert!(least < Duration::from_millis(50), "{least:?} after {at}");
        }
    }
}

/// As published: maxima are counted in sections. Where they tell nothing, m = M = 4, and it is
/// told.
#[test]
fn symmetry_numbers_by_sections_are_an_option() {
    let settings = FitSettings { symmetry: Symmetry::Sections, ..FitSettings::default() };
    let flower = Shaped { m: 6, n: [3.0, 5.0, 5.0], ..Shaped::star() };
    for truth in [Shaped::star(), flower] {
        let points = PointCloud::new(truth.cloud(CONDITIONS[0], 1500, &mut Random::new(4))).unwrap();
        let fit = supershape(&points, &settings).unwrap();
        let Shape::Supershape(leaf) = fit.shape() else { panic!("{:?}", fit.shape()) };
        assert!(leaf.equator().m == f64::from(truth.m) && !fit.search().symmetry_unclear, "{leaf:?}");
        assert!(fit.deviation().rms < 0.02, "{:?}", fit.deviation());
    }
    let mut random = Random::new(6);
    let ball = PointCloud::new((0..600).map(|_| random.direction()).collect()).unwrap();
    let fit = supershape(&ball, &settings).unwrap();
    assert!(fit.search().symmetry_unclear);
    let numbers = match fit.shape() {
        Shape::Supershape(leaf) => (leaf.equator().m, leaf.meridian().m),
        _ => (4.0, 4.0),
    };
    assert_eq!(numbers, (4.0, 4.0));
}

/// Clouds of any size that solids may have give solids; others are told to be scaled.
#[test]
fn sizes_beyond_those_of_solids_are_told() {
    for (with, points) in KINDS.into_iter().zip(clouds()) {
        let some: Vec<DVec3> = points.positions().iter().take(900).copied().collect();
        let scaled = |scale: f64| {
            let cloud = PointCloud::new(some.iter().map(|p| *p * scale).collect()).unwrap();
            with(&cloud, &FitSettings::default(), &Run::default())
        };
        let noise = scaled(1.0).unwrap().noise();
        for scale in [2e-5, 2e6] {
            let fit = scaled(scale).unwrap();
            assert!((fit.noise() / scale / noise - 1.0).abs() < 0.01, "{scale}: {} {noise}", fit.noise());
            assert!(fit.solid().bounds().unwrap().contains(fit.translation()));
        }
        for scale in [1e-9, 1e9] {
            let error = scaled(scale).unwrap_err();
            assert!(matches!(error, FitError::Extent { .. }), "{scale}: {error}");
            assert!(error.to_string().contains("scale or move it first"), "{error}");
        }
    }
}
