//! Fits to random clouds of 1000 points (and what is strewn about them), one thread.
//!
//! `cargo bench --bench fit` prints for each kind of cloud the median and the 90 % quantile of the
//! milliseconds that a fit takes, and of the thousands of points that were evaluated. Times are CPU
//! times of the thread. Then parts: milliseconds of each stage by the wall clock. Words after `--`
//! choose rows by parts of their names. What a pass over the points costs alone is printed by
//! `cargo test --release --lib points_a_second -- --ignored --nocapture`.

use std::error::Error;

use cpu_time::ThreadTime;
use rvachev::fit::{Fit, FitError, FitSettings, deformed_with, superellipsoid_with, supershape_with};
use rvachev::{PointCloud, Run};

#[path = "../tests/it/recovery/bent.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod bent;
#[path = "../tests/it/recovery/clouds.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod clouds;
#[path = "fit/parts.rs"]
mod parts;
#[path = "../tests/it/recovery/shapes.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod shapes;
#[path = "../tests/it/support/random.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod support;

use bent::Bent;
use clouds::{CONDITIONS, Quadric, cloud};
use shapes::Shaped;
use support::Random;

/// Clouds of which the median is taken.
const CLOUDS: u64 = 40;

type With = fn(&PointCloud, &FitSettings, &Run) -> Result<Fit, FitError>;

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

/// Fits of clouds that are made by number.
fn row(name: &str, with: With, clouds: u64, points: impl Fn(u64) -> Vec<glam::DVec3>) -> Result<(), Box<dyn Error>> {
    let run = Run { threads: 1, ..Run::default() };
    let (mut times, mut evaluations, mut count) = (Vec::new(), Vec::new(), 0);
    for seed in 0..clouds {
        let points = PointCloud::new(points(seed))?;
        count = points.len();
        // The first round warms up.
        let mut time = f64::INFINITY;
        for _ in 0..3 {
            let start = ThreadTime::now();
            let fit = with(&points, &FitSettings::default(), &run)?;
            time = time.min(start.elapsed().as_secs_f64() * 1e3);
            evaluations.push(fit.search().evaluations as f64 / 1e3);
        }
        times.push(time);
    }
    let [ms, high] = [0.5, 0.9].map(|share| quantile(&mut times, share));
    let [points, most] = [0.5, 0.9].map(|share| quantile(&mut evaluations, share));
    println!("{name:34} {count:8} {ms:8.2} {high:8.2} {points:8.1} {most:8.1}");
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    println!("{:34} {:>8} {:>8} {:>8} {:>8} {:>8}", "", "points", "ms", "p90", "k eval.", "p90");
    let quadric = |seed, condition, count| {
        let truth = Quadric::random(&mut Random::new(seed));
        cloud(&truth, condition, count, &mut Random::new(1000 + seed))
    };
    for condition in CONDITIONS {
        let name = format!("superellipsoid, {}", condition.name);
        if is_asked(&name) {
            row(&name, superellipsoid_with, CLOUDS, |seed| quadric(seed, condition, 1000))?;
        }
    }
    for condition in &CONDITIONS[..2] {
        let name = format!("supershape, {}", condition.name);
        if is_asked(&name) {
            let points =
                |seed| Shaped::random(&mut Random::new(seed)).cloud(*condition, 1000, &mut Random::new(1000 + seed));
            row(&name, supershape_with, CLOUDS, points)?;
        }
    }
    if is_asked("deformed") {
        let points =
            |seed| Bent::random(0.0, &mut Random::new(seed)).cloud(CONDITIONS[1], 1000, &mut Random::new(1000 + seed));
        row("deformed, taper and bend", deformed_with, CLOUDS, points)?;
    }
    for count in [100, 10_000, 1_000_000] {
        let name = format!("superellipsoid, size {count}");
        if is_asked(&name) {
            row(&name, superellipsoid_with, 5, |seed| quadric(seed, CONDITIONS[1], count))?;
        }
    }
    parts::stages(is_asked)
}
