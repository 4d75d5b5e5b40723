//! From a file of points to a solid: one JSON object on one line, for scripts.
//!
//! ```text
//!     scan.ply  →  fit::superellipsoid, supershape or deformed  →  {"kind": "superellipsoid", …}
//! ```
//!
//! `cargo run --release --example fit_cloud -- FILE [--kind
//! superellipsoid|supershape|deformed|auto] [--seed N]` reads PLY, XYZ or CSV, or the vertices of a
//! mesh; without a file, a cloud of its own. The default kind is `auto`: what explains the points
//! best. What the keys mean: [`Fit::to_json`](rvachev::fit::Fit::to_json); `ms` is how long the fit
//! took. World point = rotation · local point + translation. Errors are told on the error stream,
//! with exit code 1.

mod task;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use rvachev::surface::ParametricSurface;
use rvachev::{PointCloud, Superellipsoid};

/// A cloud to try it with.
fn pebble() -> Result<PointCloud, Box<dyn Error>> {
    let sampled = ParametricSurface::of(&Superellipsoid::new([1.2, 0.8, 2.0], 0.4, 1.3))?.sample(1000, 1)?;
    Ok(PointCloud::new(sampled.iter().map(|sample| sample.point).collect())?)
}

fn run() -> Result<String, Box<dyn Error>> {
    let arguments = task::Arguments::read(std::env::args().skip(1))?;
    let cloud = match &arguments.file {
        Some(file) => PointCloud::load(file)?,
        None => pebble()?,
    };
    let start = Instant::now();
    let fit = task::fitted(&cloud, arguments.kind, arguments.seed)?;
    Ok(task::line(&fit, start.elapsed().as_secs_f64() * 1e3))
}

fn main() -> ExitCode {
    match run() {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("fit_cloud: {error}");
            ExitCode::FAILURE
        }
    }
}
