//! A bolt: from a solid to a picture and a mesh.
//!
//! ```text
//!        .-""-.      head     supershape with six corners, chamfered by a cone, with a
//!       |______|              hexagonal socket
//!         |__|       collar   cylinder
//!         |  |       shank    cylinder
//!         |//|
//!         |//|       thread   a cylinder beside the axis, twisted, between a core that fills
//!         |//|                its grooves and a cylinder that cuts its crests
//!         '--'       tip      chamfered by a cone
//! ```
//!
//! A cone is a superellipsoid with e1 = 2. Lengths are millimetres; the bolt is about an
//! M10 × 1.5.

use std::error::Error;
use std::time::Instant;

use glam::DVec3;
use rvachev::{Camera, CellSize, Gielis, MeshSettings, RenderSettings, Solid, Supershape, turns};

/// Height of the head, and its width across flats.
const HEAD: f64 = 6.4;
const FLATS: f64 = 16.0;

/// Lengths under the head.
const SHANK: f64 = 7.0;
const SHAFT: f64 = 27.0;

/// Radius of the shank, radii of the thread's crests and grooves, and the thread's pitch.
const RADIUS: f64 = 5.0;
const CREST: f64 = 4.95;
const CORE: f64 = 4.12;
const PITCH: f64 = 1.5;

/// A prism about the z axis with six sides: `flats` from side to side, from z = 0 to `height`.
fn hexagon(flats: f64, height: f64) -> Solid {
    let scale = 0.5 * DVec3::new(flats, flats, height);
    let prism = Supershape::new(Gielis::polygon(6, 150.0), Gielis::polygon(4, 400.0)).scaled(scale);
    Solid::from(prism).translate(DVec3::Z * scale.z)
}

/// A cone that narrows along z in both senses, by `slope` per length unit of z, from its
/// widest section at `z`, to be `radius` wide at `tip`.
fn cone(z: f64, slope: f64, radius: f64, tip: f64) -> Solid {
    let widest = radius + slope * (tip - z).abs();
    Solid::superellipsoid(DVec3::new(widest, widest, widest / slope), 2.0, 1.0).translate(DVec3::Z * z)
}

/// A cylinder about the z axis from `low` to `high`.
fn rod(radius: f64, low: f64, high: f64) -> Solid {
    Solid::cylinder(radius, high - low).translate(DVec3::Z * (0.5 * (low + high)))
}

pub(crate) fn bolt() -> Solid {
    let head = hexagon(FLATS, HEAD) & cone(0.0, 1.0 / 30f64.to_radians().tan(), 0.475 * FLATS, HEAD);
    let collar = rod(0.46 * FLATS, -0.6, 0.1);
    let socket = hexagon(7.0, 4.0).translate(DVec3::Z * (HEAD - 3.2));

    // The surface of a rod that stands off the axis and is twisted winds round the axis once
    // in a pitch, and rises and falls by the offset.
    let (low, high) = (-SHAFT - 1.0, -SHANK + 0.8);
    let offset = 0.52;
    let helix = rod(0.5 * (CREST + CORE), low, high).translate(DVec3::X * offset).twist(turns(1.0 / PITCH));
    let thread = helix & rod(CREST, low, high) | rod(CORE, low, high);
    let shank = rod(RADIUS, -SHANK, 0.1) & cone(0.1, 1.0, CORE, -SHANK);
    let shaft = (thread | shank) & cone(0.1, 1.0, CORE - 0.3, -SHAFT) & rod(2.0 * RADIUS, -SHAFT, 0.1);

    (head | collar | shaft) - socket
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("A bolt, about M10 x 1.5: head, shank, thread and socket joined by R-functions.");
    let bolt = bolt();
    let bounds = bolt.bounds()?;
    println!("  {:.1} x {:.1} x {:.1} mm", bounds.size().x, bounds.size().y, bounds.size().z);
    std::fs::create_dir_all("out")?;

    let start = Instant::now();
    let settings = RenderSettings { width: 800, height: 600, samples: 2, ..RenderSettings::default() };
    let camera = Camera::framing(&bounds).fitted(&bounds, f64::from(settings.width) / f64::from(settings.height));
    bolt.render(&camera, &settings)?.save("out/bolt.png")?;
    println!("out/bolt.png: {} x {} pixels, {:.1} s", settings.width, settings.height, start.elapsed().as_secs_f64());

    let start = Instant::now();
    let cells = 200;
    let mesh = bolt.mesh(&MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    mesh.save("out/bolt.stl")?;
    println!("out/bolt.stl: {cells} cells along the longest side, {:.1} s", start.elapsed().as_secs_f64());

    let report = mesh.check();
    println!(
        "{} triangles, {}, {}, volume {:.1} mm3",
        report.triangles,
        if report.is_closed() { "closed" } else { "NOT CLOSED" },
        if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
        report.volume
    );
    Ok(())
}
