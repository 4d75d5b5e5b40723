//! Fits to random clouds of 1000 points (and what is strewn about them), one thread.
//!
//! `cargo bench --bench fit` prints for each kind of cloud the median and the 90 % quantile of the
//! milliseconds that a fit takes, and of the thousands of points that were evaluated. Times are CPU
//! times of the thread. Then parts: milliseconds of each stage by the wall clock. Words after `--` choose rows by parts of their names.

use cpu_time::ThreadTime;
use rvachev::fit::{FitSettings, superellipsoid_with};
use rvachev::{PointCloud, Run};

#[path = "../tests/it/recovery/clouds.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod clouds;
#[path = "fit/parts.rs"]
mod parts;
#[path = "../tests/it/support/random.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod support;

use clouds::{CONDITIONS, Condition, Quadric, cloud};
use support::Random;

/// Clouds of which the median is taken.
const CLOUDS: u64 = 40;

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share).round() as usize]
}

fn superellipsoids(condition: Condition, count: usize, clouds: u64) -> Result<(), Box<dyn std::error::Error>> {
    let run = Run { threads: 1, ..Run::default() };
    let (mut times, mut evaluations) = (Vec::new(), Vec::new());
    for seed in 0..clouds {
        let truth = Quadric::random(&mut Random::new(seed));
        let points = PointCloud::new(cloud(&truth, condition, count, &mut Random::new(1000 + seed)))?;
        // The first round warms up.
        let mut time = f64::INFINITY;
        for _ in 0..3 {
            let start = ThreadTime::now();
            let fit = superellipsoid_with(&points, &FitSettings::default(), &run)?;
            time = time.min(start.elapsed().as_secs_f64() * 1e3);
            evaluations.push(fit.search().evaluations as f64 / 1e3);
        }
        times.push(time);
    }
    let [ms, high] = [0.5, 0.9].map(|share| quantile(&mut times, share));
    let [points, most] = [0.5, 0.9].map(|share| quantile(&mut evaluations, share));
    println!("{:24} {count:8} {ms:8.2} {high:8.2} {points:8.1} {most:8.1}", condition.name);
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    println!("{:24} {:>8} {:>8} {:>8} {:>8} {:>8}", "superellipsoids", "points", "ms", "p90", "k eval.", "p90");
    for condition in CONDITIONS.into_iter().filter(|condition| is_asked(condition.name)) {
        superellipsoids(condition, 1000, CLOUDS)?;
    }
    for count in [100, 10_000, 1_000_000] {
        if is_asked("size") {
            superellipsoids(CONDITIONS[1], count, 5)?;
        }
    }
    parts::stages(is_asked)
}
