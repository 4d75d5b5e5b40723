//! A bracket: all inner edges filleted, all outer ones rounded, from a solid to a picture and a
//! mesh.
//!
//! ```text
//!      |\         wall     with two counterbored holes
//!      | \
//!      |  \       rib      a wedge between the wall and the plate
//!      |___\___
//!      |_______|  plate    with two counterbored holes
//! ```
//!
//! The parts are joined and cut as they are, with sharp edges. Then one verb fills the inner edges,
//! as a ball that rolls along them from outside leaves them (closing), and one rounds the outer
//! edges, as a ball that fits inside leaves them (opening). Lengths are millimetres.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use rvachev::{Camera, CellSize, MeshReport, MeshSettings, Paint, RFunction, RenderSettings, Solid, deg};

/// Sizes along x, y and z: of the plate, and of the wall above it.
const PLATE: [f64; 3] = [60.0, 44.0, 8.0];
const WALL: [f64; 3] = [8.0, 44.0, 46.0];

/// Size of the rib.
const RIB: [f64; 3] = [32.0, 6.0, 30.0];

/// Radii of a hole and of its counterbore, and how deep that is.
const HOLE: f64 = 3.3;
const COUNTERBORE: f64 = 6.0;
const DEPTH: f64 = 3.5;

/// Radii of inner and of outer edges. A hole is wider than the ball that fills inner edges.
const INNER: f64 = 2.0;
const OUTER: f64 = 1.0;

/// A hole along z, counterbored from z = 0 upwards.
fn hole() -> Solid {
    let bore = Solid::cylinder(HOLE, 30.0);
    let counterbore = Solid::cylinder(COUNTERBORE, 10.0).translate([0.0, 0.0, 5.0 - DEPTH]);
    bore | counterbore
}

/// The bracket with sharp edges. The lower outer edge of the wall is at x = 0 and z = 0.
pub(crate) fn sharp() -> Solid {
    let plate = Solid::cuboid(PLATE).translate([0.5 * PLATE[0], 0.0, 0.5 * PLATE[2]]).named("plate");
    let wall = Solid::cuboid(WALL).translate([0.5 * WALL[0], 0.0, 0.5 * WALL[2]]).named("wall");
    let rib = Solid::wedge(RIB).translate([WALL[0] + 0.5 * RIB[0], 0.0, PLATE[2] + 0.5 * RIB[2]]).named("rib");
    let down = |y: f64| hole().translate([46.0, y, PLATE[2]]);
    let across = |y: f64| hole().rotate_y(deg(90.0)).translate([WALL[0], y, 32.0]);
    let holes = [down(-13.0), down(13.0), across(-13.0), across(13.0)];
    (plate | wall | rib).difference_all(holes, RFunction::MIN_MAX)
}

pub(crate) fn bracket() -> Solid {
    sharp().filleted(INNER).rounded(OUTER)
}

fn describe(report: &MeshReport) -> String {
    format!(
        "{} triangles, {}, {}, {} holes, volume {:.1} mm3",
        report.triangles,
        if report.is_closed() { "closed" } else { "NOT CLOSED" },
        if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
        report.genus.unwrap_or(-1),
        report.volume
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("A bracket: plate, wall, rib and counterbored holes, inner edges filleted, outer edges rounded.");
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;
    let bracket = bracket();
    let bounds = bracket.bounds()?;
    println!("  {:.1} x {:.1} x {:.1} mm", bounds.size().x, bounds.size().y, bounds.size().z);

    let start = Instant::now();
    // The picture for the docs is finer.
    let (width, height, samples) = if folder.ends_with("docs") { (720, 540, 3) } else { (480, 360, 2) };
    let paint = Paint { color: [128, 156, 184], roughness: 0.4 };
    let settings = RenderSettings { width, height, samples, paint, ..RenderSettings::default() };
    // From the side of the rib, so that the wall is in the light.
    let camera = Camera::framing(&bounds)
        .orbit(deg(16.0), deg(0.0))
        .fitted(&bounds, f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("bracket.png");
    bracket.render(&camera, &settings)?.save(&path)?;
    let seconds = start.elapsed().as_secs_f64();
    println!("{}: {} x {} pixels, {seconds:.1} s", path.display(), settings.width, settings.height);

    let start = Instant::now();
    let cells = 160;
    let mesh = bracket.mesh(&MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join("bracket.stl");
    mesh.save(&path)?;
    let seconds = start.elapsed().as_secs_f64();
    println!("{}: {cells} cells along the longest side, {seconds:.1} s", path.display());

    println!("  {}", describe(&mesh.check()));
    println!("  {:.1} mm3 with sharp edges", sharp().mesh(&MeshSettings::default())?.volume());
    Ok(())
}
