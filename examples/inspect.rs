//! A scan of a part that is slightly wrong, compared with its model: which feature is off?
//!
//! ```text
//!          __                 boss       made 2 % too high
//!     ____|  |__________
//!    |          | |     |     plate
//!    |__________|_|_____|     hole       drilled 0.3 beside its place
//! ```
//!
//! The scan lies anywhere: it is registered first. Lengths are millimetres.
//!
//! `cargo run --release --example inspect -- folder` writes there the scan, coloured by its
//! deviations, a picture of it with a legend, and the report as JSON.

use std::error::Error;

use glam::DVec3;
use rvachev::fit::{RegisterSettings, inspect, register};
use rvachev::{Camera, CellSize, MeshSettings, PointCloud, Solid, deg};

/// The part, its hole moved and its boss raised.
pub(crate) fn bracket(moved: f64, raised: f64) -> Solid {
    let plate = Solid::cuboid([60.0, 40.0, 8.0]).named("plate");
    let boss = Solid::cylinder(7.0, 20.0 + raised).translate([-16.0, 5.0, 0.5 * (20.0 + raised)]).named("boss");
    let hole = Solid::cylinder(5.0, 30.0).translate([15.0 + moved, -4.0, 0.0]).named("hole");
    let slot = Solid::cuboid([14.0, 5.0, 30.0]).translate([15.0, 12.0, 0.0]).named("slot");
    (plate | boss) - hole - slot
}

/// A hash of two numbers, for noise that is the same on every run: from −1 to 1.
fn noise(i: usize, k: u64) -> f64 {
    let z = (i as u64 * 3 + k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((z ^ z >> 27) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// To three digits, and never −0.
fn rounded(v: f64) -> f64 {
    (1000.0 * v).round() / 1000.0 + 0.0
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "target/examples".into());
    std::fs::create_dir_all(&folder)?;
    let made = bracket(0.3, 0.4).rotate_x(deg(130.0)).rotate_z(deg(40.0)).translate([100.0, 20.0, 0.0]);
    let mesh = made.mesh(&MeshSettings { cell: CellSize::Length(0.8), ..MeshSettings::default() })?;
    let points = mesh.triangles().iter().enumerate().map(|(i, triangle)| {
        let middle = triangle.iter().map(|v| mesh.positions()[*v as usize].as_dvec3()).sum::<DVec3>() / 3.0;
        middle + 0.05 * DVec3::new(noise(i, 0), noise(i, 1), noise(i, 2))
    });
    let scan = PointCloud::new(points.collect())?;

    let model = bracket(0.0, 0.0);
    let found = register(&model, &scan, &RegisterSettings::default())?;
    println!("registered: cost {:.3}, noise {:.3}", found.cost, found.noise);
    let report = inspect(&found.place(&model), &scan)?;
    println!("{:8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8}", "", "points", "median", "spread", "95 %", "shift", "growth");
    for leaf in report.leaves() {
        let name = ["plate", "boss", "hole", "slot"].into_iter().find(|name| leaf.owner.path.contains(name));
        println!(
            "{:8} {:7} {:8.3} {:8.3} {:8.3} {:8.3} {:8.3}{}",
            name.unwrap_or(&leaf.owner.path),
            leaf.sizes.points,
            rounded(leaf.median),
            leaf.spread,
            leaf.sizes.percentile_95,
            leaf.shift.length(),
            rounded(leaf.growth),
            if leaf.is_off() { "  off" } else { "" }
        );
    }
    println!("within 0.1: {:.1} %", 100.0 * report.share_within(0.1)?);
    let folder = std::path::Path::new(&folder);
    report.colored(&scan, 0.4)?.save(folder.join("inspect.ply"))?;
    let camera = Camera::framing(&found.place(&model).bounds()?);
    report.picture(&scan, 0.4, &camera, 960, 720)?.save(folder.join("inspect.png"))?;
    std::fs::write(folder.join("inspect.json"), report.to_json())?;
    println!("{}", folder.display());
    Ok(())
}
