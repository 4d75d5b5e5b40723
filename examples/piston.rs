//! A piston of supershapes, and a look inside.
//!
//! ```text
//!       ,-----^-------^-----.     crown, with a bowl and pockets for four valves
//!       |===================|     two grooves for compression rings and one for the oil ring,
//!       |===================|     with holes that drain it
//!       |=o===o===o===o===o=|
//!       |      .---.        |     skirt, cut away beside the pin bosses
//!       |     (  o  )       |     pin bosses: bores with grooves for circlips
//!        \     '---'       /
//! ```
//!
//! Every part is a supershape, the product of two Gielis curves: a disc is a circle times a
//! square, a box a square times a square, a bowl a circle times an ellipse. They are joined by
//! R-functions, as in the papers on supershapes that draw pistons so (Y. D. Fougerolle et al.).
//! Lengths are millimetres; the bore is 80.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{Camera, CellSize, Gielis, MeshSettings, Paint, RenderSettings, Solid, Supershape, deg};

/// Radius of the piston, and the height of its crown above the skirt's lower edge.
const RADIUS: f64 = 40.0;
const HEIGHT: f64 = 66.0;

/// Height of the pin's axis, and radii of the pin and of its bosses.
const PIN_HEIGHT: f64 = 26.0;
const PIN: f64 = 9.0;
const BOSS: f64 = 15.0;

/// A square with corners that are rounded the more the smaller `sharpness` is, 1 from the middle
/// to a side.
fn square(sharpness: f64) -> Gielis {
    Gielis::new(4.0, sharpness, sharpness, sharpness)
}

/// A supershape of these half-sizes about `centre`.
fn part(equator: Gielis, meridian: Gielis, half_sizes: [f64; 3], centre: [f64; 3]) -> Solid {
    Solid::from(Supershape::new(equator, meridian).scaled(half_sizes)).translate(centre)
}

/// A disc about the z axis.
fn disc(radius: f64, low: f64, high: f64) -> Solid {
    let half = 0.5 * (high - low);
    part(Gielis::circle(), square(80.0), [radius, radius, half], [0.0, 0.0, low + half])
}

/// A rod along y through the pin's axis.
fn pin(radius: f64, length: f64) -> Solid {
    disc(radius, -0.5 * length, 0.5 * length).rotate_x(deg(90.0)).translate([0.0, 0.0, PIN_HEIGHT])
}

/// What a ring takes off: all that is farther than `depth` below the surface at its height.
fn groove(high: f64, width: f64, depth: f64) -> Solid {
    disc(RADIUS + 4.0, high - width, high) - disc(RADIUS - depth, high - 2.0 * width, high + width)
}

pub(crate) fn piston() -> Solid {
    // The blank: a cylinder with a low dome for a crown.
    let dome = part(Gielis::circle(), square(2.0), [120.0, 120.0, 90.0], [0.0, 0.0, HEIGHT - 90.0]);
    let blank = (disc(RADIUS, 0.0, HEIGHT) & dome).named("blank");

    // Inside it is hollow up to the crown; the bosses stand in the hollow, 24 apart, and a rib
    // holds each of them to the crown.
    let hollow = part(Gielis::circle(), square(7.0), [34.0, 34.0, 50.0], [0.0, 0.0, 3.0]);
    let between = part(square(60.0), square(60.0), [60.0, 12.0, 60.0], [0.0, 0.0, 0.0]);
    let rib = part(square(12.0), square(12.0), [6.0, 40.0, 18.0], [0.0, 0.0, PIN_HEIGHT + 16.0]);
    let bosses = ((pin(BOSS, 72.0) | rib) - between).named("pin bosses");

    // Slippers: below the rings the skirt is flattened where the bosses end.
    let flats = |y: f64| part(square(14.0), square(14.0), [60.0, 20.0, 30.0], [0.0, y + 20.0, 6.0]).mirrored_y();
    let window = part(square(6.0), square(6.0), [25.0, 60.0, 13.0], [0.0, 0.0, -6.0]);
    let skirt = (blank - hollow) - (flats(29.0) | window);
    let body = skirt | (bosses & (disc(RADIUS - 1.0, 0.0, HEIGHT - 4.0) - flats(28.0)));

    // Rings.
    let compression = groove(59.5, 2.0, 4.0) | groove(53.5, 2.0, 4.0);
    let drains = disc(1.3, 0.0, 14.0).rotate_y(deg(90.0)).translate([28.0, 0.0, 46.0]).repeat_polar(16);
    let grooves = (compression | groove(47.8, 3.6, 4.0)).named("ring grooves") | drains;

    // The pin's bore, and a groove for a circlip near each of its ends.
    let circlip = disc(PIN + 0.9, 24.2, 25.6).rotate_x(deg(90.0)).translate([0.0, 0.0, PIN_HEIGHT]);
    let bore = (pin(PIN, 100.0) | circlip.mirrored_y()).named("pin bore");

    // Valve pockets, tilted like the valves, two large ones and two small ones; and a bowl.
    let pocket = |radius: f64, x: f64, y: f64| {
        disc(radius, 0.0, 12.0).rotate_y(deg(x.signum() * -12.0)).translate([x, y, HEIGHT - 3.2]).mirrored_y()
    };
    let pockets = (pocket(14.5, 17.5, 16.0) | pocket(12.5, -18.0, 15.0)).named("valve pockets");
    let bowl = part(Gielis::circle(), square(2.0), [13.0, 13.0, 5.0], [0.0, 0.0, HEIGHT + 0.4]).named("bowl");

    body - grooves - bore - pockets - bowl
}

fn wrote(path: &Path, start: Instant, facts: &str) -> Result<(), Box<dyn Error>> {
    let kilobytes = fs::metadata(path)?.len() / 1000;
    println!("{}: {kilobytes} kB, {:.2} s, {facts}", path.display(), start.elapsed().as_secs_f64());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("target/examples"), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let piston = piston();
    println!("A piston of {} supershapes joined by R-functions.", piston.surface_program()?.leaf_count());
    for point in [[0.0, PIN, PIN_HEIGHT], [0.0, 30.0, PIN_HEIGHT + BOSS]] {
        println!("  the surface near {point:?} is of: {}", piston.owner(point)?.path);
    }

    let start = Instant::now();
    let mesh = piston.mesh(&MeshSettings { cell: CellSize::Length(1.0), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join("piston.stl");
    mesh.save(&path)?;
    let report = mesh.check();
    let sound = if report.is_closed() && report.is_manifold() { "closed, manifold" } else { "NOT SOUND" };
    let (triangles, volume, size) = (report.triangles, report.volume / 1000.0, report.bounds.size());
    let facts =
        format!("{triangles} triangles, {sound}, {volume:.1} cm3, {:.1} x {:.1} x {:.1} mm", size.x, size.y, size.z);
    wrote(&path, start, &facts)?;

    // A quarter cut out shows the bosses.
    let start = Instant::now();
    let quarter = Solid::cuboid(DVec3::splat(200.0)).translate([100.0, -100.0, 0.0]);
    let scene = (&piston - quarter).rotate_z(deg(-12.0));
    let settings = RenderSettings {
        width: 420,
        height: 360,
        samples: 2,
        paint: Paint { color: [176, 182, 190], roughness: 0.35 },
        ..RenderSettings::default()
    };
    let view = Camera::perspective([60.0, -260.0, 150.0], DVec3::ZERO, DVec3::Z, deg(24.0));
    let camera = view.fitted(&scene.bounds()?.inflate(-5.0), f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("piston.png");
    scene.render(&camera, &settings)?.save(&path)?;
    wrote(&path, start, &format!("{} x {} pixels", settings.width, settings.height))
}
