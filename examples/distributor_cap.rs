//! A distributor cap: supershapes joined by R-functions.
//!
//! ```text
//!                 ___
//!         ___    |   |    ___        towers, one for the coil in the middle and six round it,
//!        |   |   |___|   |   |       with sockets for the leads and contacts in them
//!        |___|__/     \__|___|
//!         \_|             |_/        dome, hollow, ribbed
//!          |_______________|
//!     (o)_/_________________\_(o)    flange with lugs for two screws
//! ```
//!
//! A supershape is the product of two Gielis curves, one for its sections across z and one for
//! its meridians: a tower is a curve of m = 6 times a square, the rim one of m = 24, the dome a
//! circle times a rounded square. They are joined by R-functions, as in the papers on supershapes
//! that draw mechanical parts so (Y. D. Fougerolle et al.). Lengths are millimetres.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{Camera, CellSize, Gielis, MeshSettings, Paint, RenderSettings, Solid, Supershape, deg};

/// The ring of towers: how many, and its radius.
const LEADS: u32 = 6;
const RING: f64 = 24.0;

/// A square with corners that are rounded the more the smaller `sharpness` is, 1 from the middle
/// to a side.
fn square(sharpness: f64) -> Gielis {
    Gielis::new(4.0, sharpness, sharpness, sharpness)
}

/// A supershape about the z axis with sections like `curve`, from `low` to `high`.
fn column(curve: Gielis, sharpness: f64, radius: f64, low: f64, high: f64) -> Solid {
    let half = 0.5 * (high - low);
    let shape = Supershape::new(curve, square(sharpness)).scaled([radius, radius, half]);
    Solid::from(shape).translate([0.0, 0.0, low + half])
}

/// A tower for a lead, upright on z = 0: a column with six soft lobes that is narrower at the
/// top, between a round foot and a collar.
fn tower(radius: f64, height: f64) -> Solid {
    let lobes = Gielis::new(6.0, 10.0, 3.0, 3.0);
    let shaft = column(lobes, 30.0, 0.9 * radius, -8.0, height).taper(-0.08, -0.08, 2.0 * height);
    let collar = column(Gielis::circle(), 10.0, radius, 0.52 * height, 0.66 * height);
    shaft | collar
}

/// What is taken out of a tower: a socket with a chamfered mouth.
fn socket(radius: f64, height: f64, depth: f64) -> Solid {
    let mouth = Solid::from(Supershape::new(Gielis::circle(), Gielis::new(4.0, 1.0, 1.0, 1.0)).scaled([
        radius + 1.6,
        radius + 1.6,
        radius + 1.6,
    ]));
    column(Gielis::circle(), 60.0, radius, height - depth, height + 4.0) | mouth.translate([0.0, 0.0, height])
}

/// A contact: a pin that reaches from the socket through the dome.
fn contact(low: f64, high: f64) -> Solid {
    column(Gielis::circle(), 20.0, 1.7, low, high)
}

pub(crate) fn cap() -> Solid {
    // The shell: the lower half of a rounded cylinder would close it, so it is cut at z = 0.
    let above = Solid::half_space([0.0, 0.0, -1.0], 0.0);
    let dome = column(Gielis::circle(), 3.2, 35.0, -30.0, 30.0);
    let hollow = column(Gielis::circle(), 3.2, 31.0, -26.0, 26.0);
    let ribs = column(Gielis::new(24.0, 9.0, 3.0, 3.0), 20.0, 35.2, -14.0, 14.0);
    let flange = column(Gielis::circle(), 30.0, 39.0, -5.0, 5.0);

    // Two lugs: rounded triangles that point outwards, each with a screw's hole and its seat.
    let lug = Solid::from(Supershape::new(Gielis::new(3.0, 5.0, 8.0, 8.0), square(30.0)).scaled([9.5, 9.5, 3.5]));
    let lug = lug.rotate_z(deg(180.0)).translate([37.0, 0.0, 3.5]);
    let screw = column(Gielis::circle(), 60.0, 2.4, -10.0, 20.0) | column(Gielis::circle(), 60.0, 4.6, 5.6, 20.0);
    let screw = screw.translate([43.0, 0.0, 0.0]);

    // Towers: the coil's in the middle, and a ring of leads.
    let coil = tower(9.0, 21.0).translate([0.0, 0.0, 29.0]).named("coil tower");
    let lead = tower(7.6, 19.0).translate([RING, 0.0, 25.0]).repeat_polar(LEADS).named("lead towers");
    let sockets = socket(4.6, 21.0, 15.0).translate([0.0, 0.0, 29.0])
        | socket(3.9, 19.0, 13.0).translate([RING, 0.0, 25.0]).repeat_polar(LEADS);
    let contacts = contact(18.0, 40.0) | contact(14.0, 36.0).translate([RING, 0.0, 0.0]).repeat_polar(LEADS);

    let outside = dome | ribs | flange | lug.mirrored_x() | lead | coil;
    // Into the hollow: to its wall only, it would leave a film between the two.
    let key =
        Solid::from(Supershape::new(square(60.0), square(60.0)).scaled([3.0, 7.0, 3.0])).translate([0.0, -37.0, 0.0]);
    let moulded = (outside & above) - hollow.named("hollow") - sockets.named("sockets") - screw.mirrored_x() - key;
    moulded | contacts.named("contacts")
}

fn wrote(path: &Path, start: Instant, facts: &str) -> Result<(), Box<dyn Error>> {
    let kilobytes = fs::metadata(path)?.len() / 1000;
    println!("{}: {kilobytes} kB, {:.2} s, {facts}", path.display(), start.elapsed().as_secs_f64());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("target/examples"), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let cap = cap();
    println!("A distributor cap for {LEADS} leads, of {} leaves.", cap.surface_program()?.leaf_count());

    let start = Instant::now();
    let mesh = cap.mesh(&MeshSettings { cell: CellSize::Length(1.0), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join("distributor_cap.stl");
    mesh.save(&path)?;
    let report = mesh.check();
    let sound = if report.is_closed() && report.is_manifold() { "closed, manifold" } else { "NOT SOUND" };
    let (triangles, volume, size) = (report.triangles, report.volume / 1000.0, report.bounds.size());
    let facts =
        format!("{triangles} triangles, {sound}, {volume:.1} cm3, {:.1} x {:.1} x {:.1} mm", size.x, size.y, size.z);
    wrote(&path, start, &facts)?;

    let start = Instant::now();
    let scene = cap.rotate_z(deg(20.0));
    let settings = RenderSettings {
        width: 420,
        height: 315,
        samples: 1,
        paint: Paint { color: [158, 74, 48], roughness: 0.4 },
        ..RenderSettings::default()
    };
    let view = Camera::perspective([40.0, -260.0, 190.0], DVec3::ZERO, DVec3::Z, deg(24.0));
    let camera = view.fitted(&scene.bounds()?.inflate(-9.0), f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("distributor_cap.png");
    scene.render(&camera, &settings)?.save(&path)?;
    wrote(&path, start, &format!("{} x {} pixels", settings.width, settings.height))
}
