//! A bottle: a supershape deformed by laws of z, hollowed by `shell`, its neck threaded.
//!
//! ```text
//!        |=|      neck      cylinder, with a thread swept along a helix and a ring below it
//!       .' '.     shoulder  the body runs into the neck by a smooth union
//!      |  /  |    body      supershape with five lobes, twisted and tapered by laws of z
//!      | / / |
//!      '-.^.-'    punt      an ellipsoid presses the bottom in
//! ```
//!
//! The wall is what `shell` leaves of the deformed body: the same length everywhere along the
//! surface's normals, as rays measure it. Lengths are millimetres.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{
    Bounds, Camera, CellSize, Gielis, Helix, MeshSettings, Paint, Plane, Profile, RenderSettings, Solid, Supershape,
    law::SineWave, rad, turns,
};

const WALL: f64 = 1.8;

/// Radius of the body between two lobes, half its height, and the height of the mouth above its
/// middle.
const RADIUS: f64 = 31.0;
const HALF: f64 = 55.0;
const TOP: f64 = 92.0;

/// Radius of the neck.
const NECK: f64 = 13.0;

/// What the glass is blown to.
fn shape() -> Solid {
    // Five soft lobes; meridians of a rounded box.
    let lobes = Gielis::new(5.0, 14.0, 6.0, 6.0);
    let rounded_box = Gielis::new(4.0, 6.0, 6.0, 6.0);
    let body = Supershape::new(lobes, rounded_box).scaled(DVec3::new(RADIUS, RADIUS, HALF));
    // A waist where the hand holds it.
    let law = SineWave { mean: 0.9, amplitude: 0.09, wavelength: 110.0, phase: rad(-1.9) };
    // A fifth of a turn from bottom to top.
    let body = Solid::from(body).taper_by(law, law).twist(turns(0.2) / (2.0 * HALF)).named("body");

    let neck = Solid::cylinder(NECK, TOP).translate([0.0, 0.0, 0.5 * TOP]).named("neck");
    let punt = Solid::ellipsoid(DVec3::new(20.0, 20.0, 9.0)).translate([0.0, 0.0, -HALF]).named("punt");
    body.smooth_union(neck, 9.0).smooth_difference(punt, 4.0)
}

/// The bottle's wall, opened at the top.
pub(crate) fn wall() -> Solid {
    let mouth = Solid::cylinder(NECK - WALL, 20.0).translate([0.0, 0.0, TOP]).named("mouth");
    shape().shell(WALL) - mouth
}

/// Two turns of a thread, and the ring below it.
pub(crate) fn thread() -> Solid {
    let ridge = Profile::polygon([[-0.8, -1.3], [1.4, -0.5], [1.4, 0.5], [-0.8, 1.3]]);
    let helix = ridge.sweep_helix(&Helix::new(NECK, 4.0, 2.0)).translate([0.0, 0.0, TOP - 8.0]).named("thread");
    let ring = Solid::torus(NECK, 1.6).translate([0.0, 0.0, TOP - 17.0]).named("ring");
    helix | ring
}

/// Least and largest thickness: rays from all sides meet the outer surface, and from there
/// rays along its normals meet the inner one.
fn measured(bottle: &Solid) -> Result<(f64, f64), Box<dyn Error>> {
    let scene = bottle.scene()?;
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for i in 0..6 {
        let z = -0.8 * HALF + 0.28 * HALF * f64::from(i);
        for j in 0..12 {
            let (sin, cos) = (TAU * f64::from(j) / 12.0).sin_cos();
            let direction = DVec3::new(cos, sin, 0.0);
            let Some(outer) = scene.first_hit(DVec3::Z * z + 60.0 * direction, -direction) else { continue };
            let Some(inner) = scene.first_hit(outer.point - 1e-3 * outer.normal, -outer.normal) else { continue };
            least = least.min(inner.distance + 1e-3);
            most = most.max(inner.distance + 1e-3);
        }
    }
    Ok((least, most))
}

fn picture(
    solid: &Solid,
    frame: &Bounds,
    (fine, cut): (bool, Option<Plane>),
    path: &Path,
) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let settings = RenderSettings {
        width: if fine { 160 } else { 110 },
        height: if fine { 290 } else { 200 },
        samples: if fine { 2 } else { 1 },
        paint: Paint { color: [112, 150, 124], roughness: 0.3 },
        cut,
        ..RenderSettings::default()
    };
    let camera = Camera::framing(frame).fitted(frame, f64::from(settings.width) / f64::from(settings.height));
    solid.render(&camera, &settings)?.save(path)?;
    written(path, start)
}

fn written(path: &Path, start: Instant) -> Result<(), Box<dyn Error>> {
    let (bytes, seconds) = (std::fs::metadata(path)?.len(), start.elapsed().as_secs_f64());
    println!("{}: {} kB, {seconds:.1} s", path.display(), bytes.div_ceil(1000));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    // Pictures for the docs are finer than those of a try.
    let fine = folder.ends_with("docs");
    std::fs::create_dir_all(&folder)?;

    println!("A bottle: the shell of a twisted supershape, with a threaded neck.");
    let begun = Instant::now();
    let bottle = wall() | thread();
    let start = Instant::now();
    let (least, most) = measured(&wall())?;
    let seconds = start.elapsed().as_secs_f64();
    println!("  wall asked for {WALL} mm, measured {least:.3} to {most:.3} mm, {seconds:.1} s");

    let start = Instant::now();
    let mesh = bottle.mesh(&MeshSettings { cell: CellSize::LongestSide(160), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join("bottle.stl");
    mesh.save(&path)?;
    written(&path, start)?;
    let report = mesh.check();
    let size = report.bounds.size();
    println!(
        "  {} triangles, {}, {}, {:.1} x {:.1} x {:.1} mm, {} holes through the wall, volume {:.0} mm3",
        report.triangles,
        if report.is_closed() { "closed" } else { "NOT CLOSED" },
        if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
        size.x,
        size.y,
        size.z,
        report.genus.unwrap_or(-1),
        report.volume
    );
    // The mesh's box is the tightest one to frame. From without nothing is seen of the cavity but
    // the bore of the neck, so the picture is of a full bottle, which takes half the time.
    let bore = Solid::cylinder(NECK - WALL, 2.0 * (TOP - HALF)).translate([0.0, 0.0, TOP]).named("bore");
    picture(&((shape() - bore) | thread()), &report.bounds, (fine, None), &folder.join("bottle.png"))?;
    // Without its front half.
    picture(&bottle, &report.bounds, (fine, Some(Plane::xz(0.0))), &folder.join("bottle_cut.png"))?;
    println!("{:.1} s in all", begun.elapsed().as_secs_f64());
    Ok(())
}
