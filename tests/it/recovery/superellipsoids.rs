//! Superellipsoids from clouds.

use std::sync::{Arc, Mutex};

use glam::{DMat3, DVec3, Vec3};
use rvachev::fit::{Cost, Fit, FitError, FitSettings, Shape, superellipsoid, superellipsoid_with};
use rvachev::{PointCloud, Progress, Run};

use super::clouds::{CONDITIONS, Condition, Quadric, cloud, mean_distance};
use crate::support::Random;

/// Shares of clouds that must come out within 2 %, in per cent, over 200 clouds; by condition.
const GATES: [f64; 8] = [99.0, 99.0, 99.0, 99.0, 99.0, 92.0, 92.0, 97.0];

/// The fitted superellipsoid in space.
fn found(fit: &Fit) -> Quadric {
    let Shape::Superellipsoid(leaf) = fit.shape() else { panic!("a superellipsoid") };
    let rotation = DMat3::from_quat(fit.rotation());
    Quadric { e: leaf.exponents(), semi_axes: leaf.semi_axes(), rotation, center: fit.translation() }
}

struct Row {
    distances: Vec<f64>,
    evaluations: Vec<f64>,
}

fn row(condition: Condition, clouds: u64, seed: u64, samples: usize, settings: &FitSettings) -> Row {
    let mut row = Row { distances: Vec::new(), evaluations: Vec::new() };
    for i in 0..clouds {
        let truth = Quadric::random(&mut Random::new(seed + i));
        let mut random = Random::new((seed + i) << 8 | u64::from(condition.name.len() as u32));
        let points = PointCloud::new(cloud(&truth, condition, 1000, &mut random)).unwrap();
        let Ok(fit) = superellipsoid(&points, settings) else {
            row.distances.push(f64::INFINITY);
            row.evaluations.push(0.0);
            continue;
        };
        row.distances.push(mean_distance(&truth, &found(&fit), samples, &mut random));
        row.evaluations.push(fit.search().evaluations as f64);
    }
    row.distances.sort_by(f64::total_cmp);
    row.evaluations.sort_by(f64::total_cmp);
    row
}

fn within(row: &Row, limit: f64) -> f64 {
    100.0 * row.distances.iter().filter(|d| **d <= limit).count() as f64 / row.distances.len() as f64
}

#[test]
fn random_clouds_are_recovered() {
    for (condition, gate) in CONDITIONS.into_iter().zip(GATES) {
        let clouds = 20;
        let row = row(condition, clouds, 20_260_101, 60, &FitSettings::default());
        // One of a few may be among those that are lost.
        let least = gate - 100.0 / clouds as f64;
        assert!(within(&row, 0.02) >= least, "{}: {:?}", condition.name, row.distances);
    }
}

#[test]
#[ignore = "minutes: the table of the documentation"]
fn two_hundred_clouds_a_condition() {
    println!("| condition | ≤ 2 % | ≤ 1 % | median distance | evaluations, median | p90 |");
    let mut missed = Vec::new();
    for (condition, gate) in CONDITIONS.into_iter().zip(GATES) {
        let row = row(condition, 200, 7_000_000, 200, &FitSettings::default());
        let (name, median) = (condition.name, row.distances[100]);
        let [middle, high] = [100, 180].map(|i| row.evaluations[i] / 1e3);
        let [two, one] = [0.02, 0.01].map(|limit| within(&row, limit));
        println!("| {name} | {two:.1} | {one:.1} | {:.3} % | {middle:.1} k | {high:.1} k |", 100.0 * median);
        if two < gate {
            missed.push(name);
        }
        let most = match name {
            "clean" => (0.0007, 17.0),
            "1 % noise" => (0.0013, 17.0),
            "+ 60 % outliers" => (f64::INFINITY, 28.0),
            "one-sided view" | "view + 20 % outliers" => (f64::INFINITY, 56.0),
            _ => continue,
        };
        if median > most.0 || middle > most.1 {
            missed.push(name);
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

#[test]
#[ignore = "minutes: the table of the published costs"]
fn a_hundred_clouds_a_cost() {
    println!("| cost | clean | 1 % noise | + 20 % outliers | one-sided view |");
    for cost in [Cost::Normal, Cost::Radial, Cost::Gauge, Cost::SolinaBajcsy] {
        let settings = FitSettings { cost, ..FitSettings::default() };
        let shares = [0, 1, 2, 5].map(|at| within(&row(CONDITIONS[at], 100, 7_000_000, 200, &settings), 0.02));
        println!("| `{cost:?}` | {} |", shares.map(|share| share.to_string()).join(" | "));
        let gates = match cost {
            Cost::Normal => [99.0, 99.0, 99.0, 94.0],
            Cost::Radial => [99.0, 99.0, 99.0, 88.0],
            _ => [0.0; 4],
        };
        assert!(shares.iter().zip(gates).all(|(share, least)| *share >= least), "{cost:?}: {shares:?}");
    }
}

fn an_example(condition: usize, count: usize) -> (Quadric, PointCloud) {
    let truth = Quadric::random(&mut Random::new(11));
    let points = cloud(&truth, CONDITIONS[condition], count, &mut Random::new(5));
    (truth, PointCloud::new(points).unwrap())
}

#[test]
fn weights_tell_the_surface_from_what_is_strewn() {
    let (truth, points) = an_example(4, 1000);
    let fit = superellipsoid(&points, &FitSettings::default()).unwrap();
    assert_eq!(fit.weights().len(), points.len());
    assert!((fit.inliers() - 0.4).abs() < 0.03, "{}", fit.inliers());
    assert!((fit.noise() / truth.size() - 0.01).abs() < 0.0015, "{}", fit.noise() / truth.size());
    let near = |p: &DVec3| (truth.gauge(*p) - 1.0).abs() * p.distance(truth.center) < 0.03 * truth.size();
    let agree = points.positions().iter().zip(fit.weights()).filter(|(p, w)| near(p) == (**w > 0.5)).count();
    assert!(agree * 100 >= points.len() * 95, "{agree} of {}", points.len());
    let deviation = fit.deviation();
    assert!(deviation.median < deviation.rms && deviation.rms < deviation.percentile_95);
    assert!(deviation.percentile_95 <= deviation.largest && deviation.largest < 0.06 * truth.size());
    assert!(deviation.points > 950 && deviation.points < 1100);
}

/// Moved, turned and scaled clouds give moved, turned and scaled solids.
#[test]
fn fits_follow_their_clouds() {
    let (truth, points) = an_example(1, 600);
    for (scale, shift) in [(1e-4, 0.0), (1.0, 1e3), (1e5, 1e6)] {
        let shift = DVec3::new(shift, -0.5 * shift, 0.1 * shift);
        let moved: Vec<DVec3> = points.positions().iter().map(|p| *p * scale + shift).collect();
        let fit = superellipsoid(&PointCloud::new(moved).unwrap(), &FitSettings::default()).unwrap();
        let same = Quadric { semi_axes: truth.semi_axes * scale, center: truth.center * scale + shift, ..truth };
        let off = mean_distance(&same, &found(&fit), 200, &mut Random::new(1));
        assert!(off < 0.005, "{scale}: {off}");
        assert!((fit.noise() / same.size() - 0.01).abs() < 0.001);
        let center = fit.translation();
        assert!(fit.solid().contains(center).unwrap());
    }
}

#[test]
fn small_and_large_clouds() {
    for (count, limit) in [(100, 0.02), (300, 0.01), (60_000, 0.002)] {
        let (truth, points) = an_example(1, count);
        let fit = superellipsoid(&points, &FitSettings::default()).unwrap();
        let off = mean_distance(&truth, &found(&fit), 200, &mut Random::new(1));
        assert!(off < limit, "{count}: {off}");
    }
}

#[test]
fn every_published_cost_recovers_a_clean_cloud() {
    let (truth, points) = an_example(0, 600);
    for cost in [Cost::Normal, Cost::Radial, Cost::SolinaBajcsy, Cost::Gauge, Cost::Eq15] {
        let fit = superellipsoid(&points, &FitSettings { cost, ..FitSettings::default() }).unwrap();
        let off = mean_distance(&truth, &found(&fit), 200, &mut Random::new(1));
        assert!(off < 0.002, "{cost:?}: {off}");
    }
}

/// Errors of the sizes are what the covariance says, over many clouds of one solid.
#[test]
fn covariance_is_that_of_repeated_scans() {
    let truth =
        Quadric { e: [0.6, 0.9], semi_axes: DVec3::new(1.0, 1.6, 2.5), rotation: DMat3::IDENTITY, center: DVec3::ZERO };
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 0..24 {
        let points = cloud(&truth, CONDITIONS[1], 500, &mut Random::new(seed));
        let fit = superellipsoid(&PointCloud::new(points).unwrap(), &FitSettings::default()).unwrap();
        let found = found(&fit);
        if found.rotation.z_axis.z.abs() < 0.9 {
            continue;
        }
        let deviation = |name: &str| fit.covariance().deviation(name).unwrap();
        squares += ((found.semi_axes.z / 2.5).ln() / deviation("ln a3")).powi(2);
        squares += ((found.e[0] - 0.6) / deviation("e1")).powi(2);
        count += 2.0;
    }
    let ratio = f64::sqrt(squares / count);
    assert!(count > 30.0 && (0.6..1.6).contains(&ratio), "{count} {ratio}");
}

/// Of an object seen along its axis the depth is nearly free, and the covariance says so.
#[test]
fn a_free_depth_is_told() {
    let truth =
        Quadric { e: [0.3, 0.8], semi_axes: DVec3::new(1.0, 1.4, 0.8), rotation: DMat3::IDENTITY, center: DVec3::ZERO };
    let whole = cloud(&truth, CONDITIONS[1], 1000, &mut Random::new(4));
    let above = cloud(&truth, CONDITIONS[1], 3000, &mut Random::new(4));
    let seen = above.into_iter().filter(|p| p.z > 0.4 && p.x.abs() < 0.95).collect();
    let fits = [whole, seen].map(|points| superellipsoid(&PointCloud::new(points).unwrap(), &FitSettings::default()));
    let [whole, seen] = fits.map(Result::unwrap);
    assert!(seen.search().one_sided && !whole.search().one_sided);
    let largest = |fit: &Fit| {
        let sizes = ["ln a1", "ln a2", "ln a3"];
        sizes.map(|name| fit.covariance().deviation(name).unwrap()).into_iter().fold(0.0, f64::max)
    };
    assert!(largest(&seen) > 10.0 * largest(&whole), "{} {}", largest(&seen), largest(&whole));
}

#[test]
fn what_is_missing_is_told() {
    let settings = FitSettings::default();
    let fit = |points: Vec<DVec3>| superellipsoid(&PointCloud::new(points).unwrap(), &settings).unwrap_err();
    let mut random = Random::new(1);
    let mut some = |scale: DVec3| (0..200).map(|_| scale * random.vector(-1.0, 1.0)).collect::<Vec<_>>();
    let few = fit(some(DVec3::ONE)[..10].to_vec());
    let text = "10 points are too few: a superellipsoid has 11 parameters and wants 24 points or more";
    assert_eq!(few.to_string(), text);
    let flat = |points, extent| assert!(matches!(fit(points), FitError::Flat { extent: e, .. } if e == extent));
    flat(some(DVec3::new(1.0, 2.0, 0.0)), "all in one plane");
    flat(some(DVec3::new(0.0, 2.0, 0.0)), "all on one line");
    flat(vec![DVec3::ONE; 50], "all in one place");
    let tilted = some(DVec3::new(1.0, 2.0, 0.0)).iter().map(|p| DVec3::new(p.x, p.y, 0.3 * p.x + 4.0)).collect();
    flat(tilted, "all in one plane");
    assert!(matches!(fit(some(DVec3::splat(1e12))), FitError::Extent { .. }));
    assert!(matches!(fit(some(DVec3::splat(1e-9))), FitError::Extent { .. }));
    assert!(matches!(fit(vec![DVec3::splat(f64::MAX); 60]), FitError::Extent { .. }));
    let (_, points) = an_example(0, 300);
    let wrong = FitSettings { search_points: 7, ..settings };
    let error = superellipsoid(&points, &wrong).unwrap_err();
    assert_eq!(error.to_string(), "search_points is 7; allowed: 100 to 100000");
}

#[test]
fn fits_can_be_watched_and_cancelled() {
    let (_, points) = an_example(2, 500);
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = seen.clone();
    let run = Run { progress: Some(Progress::new(move |f| sink.lock().unwrap().push(f))), ..Run::default() };
    superellipsoid_with(&points, &FitSettings::default(), &run).unwrap();
    let reports = seen.lock().unwrap().clone();
    assert_eq!((reports[0], reports[reports.len() - 1]), (0.0, 1.0));
    assert!(reports.len() > 4);
    run.cancel.cancel();
    let error = superellipsoid_with(&points, &FitSettings::default(), &run).unwrap_err();
    assert!(matches!(error, FitError::Cancelled(_)));
}

/// Whatever the points are, a fit is a valid solid or an error.
#[test]
fn anything_gives_a_valid_solid_or_an_error() {
    let mut random = Random::new(9);
    for round in 0..40 {
        let count = 24 + random.below(400);
        let scale = DVec3::new(1.0, 10f64.powf(random.range(-6.0, 0.0)), 10f64.powf(random.range(-6.0, 0.0)));
        let copies = random.below(4) == 0;
        let mut points: Vec<DVec3> = (0..count).map(|_| scale * random.vector(-1.0, 1.0)).collect();
        if copies {
            let first = points[0];
            points[..count / 2].fill(first);
        }
        let mut cloud = PointCloud::new(points).unwrap();
        if round % 3 == 0 {
            let normals = (0..count).map(|_| random.direction().as_vec3() * (round % 2) as f32);
            cloud = cloud.with_normals(normals.collect::<Vec<Vec3>>()).unwrap();
        }
        if let Ok(fit) = superellipsoid(&cloud, &FitSettings::default()) {
            assert!(fit.solid().bounds().is_ok(), "{round}: {:?}", fit.shape());
            assert!(fit.weights().iter().all(|w| (0.0..=1.0).contains(w)), "{round}");
            assert!(fit.noise().is_finite() && fit.translation().is_finite());
            assert!(fit.covariance().names().iter().all(|n| fit.covariance().deviation(n).unwrap().is_finite()));
        }
    }
}

/// The sample clouds that are published with EMS, beside the median distances of its own fits.
#[test]
fn published_clouds_are_fitted_as_closely_as_by_ems() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/ems");
    if !folder.is_dir() {
        println!("no published clouds beside the checkout: skipped");
        return;
    }
    let ems = [
        ("noisy_pointCloud_example_1", 0.01437),
        ("noisy_pointCloud_example_2", 0.0892),
        ("noisy_pointCloud_example_3", 0.0317),
        ("partial_pointCloud_example_1", 1e-5),
        ("partial_pointCloud_example_2", 2e-5),
        ("partial_pointCloud_example_3", 4e-5),
    ];
    for (name, median) in ems {
        let text = std::fs::read_to_string(folder.join(name).with_extension("ply")).unwrap();
        let rows = text.lines().skip_while(|line| *line != "end_header").skip(1);
        let point = |line: &str| {
            let numbers: Vec<f64> = line.split_whitespace().map(|x| x.parse().unwrap()).collect();
            DVec3::from_slice(&numbers)
        };
        let points: Vec<DVec3> = rows.map(point).collect();
        let fit = superellipsoid(&PointCloud::new(points.clone()).unwrap(), &FitSettings::default()).unwrap();
        let quadric = found(&fit);
        let mut radial: Vec<f64> =
            points.iter().map(|p| p.distance(quadric.center) * (1.0 - 1.0 / quadric.gauge(*p)).abs()).collect();
        radial.sort_by(f64::total_cmp);
        let here = radial[radial.len() / 2];
        println!("{name}: {here:.6} (EMS {median}) {quadric:.4?}");
        assert!(here < 1.1 * median + 1e-4, "{name}: {here}");
    }
}

#[test]
fn a_few_strays_far_away_change_nothing() {
    let truth = Quadric::random(&mut Random::new(7));
    let mut random = Random::new(8);
    let mut points = cloud(&truth, CONDITIONS[1], 800, &mut random);
    points.extend([DVec3::splat(1e8), DVec3::new(0.0, -9e8, 3.0), DVec3::X * 1e4]);
    let fit = superellipsoid(&PointCloud::new(points.clone()).unwrap(), &FitSettings::default()).unwrap();
    let off = mean_distance(&truth, &found(&fit), 200, &mut random);
    assert!(off < 0.02, "{off}");
    assert_eq!(fit.weights().len(), points.len());
    assert!(fit.weights()[800..].iter().all(|weight| *weight < 0.01), "{:?}", &fit.weights()[800..]);
}
