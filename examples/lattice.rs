//! A light block: a graded gyroid inside a superellipsoid's skin, a window cut into the skin.
//!
//! ```text
//!      .------+ - - +     skin     a superellipsoid, less one whose semi-axes are shorter
//!     / .-----+     :     window   a corner of the skin taken away
//!     | |~~~~~~~~~  :     lattice  a sheet along a gyroid, thick near the skin and
//!     | | ~ ~ ~ ~ ~ |              thin in the middle
//!     \ '----------/
//!      '----------'
//! ```
//!
//! The gyroid divides the hollow into two channels, both of which the window opens: nothing
//! is locked in, as powder-bed printing needs it. Lengths are millimetres.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use rvachev::{
    Camera, CellSize, Grading, Interval, MeshSettings, MinimalSurface, RenderSettings, SheetLattice, Solid, field::Real,
};

const SEMI_AXES: DVec3 = DVec3::new(30.0, 22.0, 20.0);
const SKIN: f64 = 1.6;
const CELL: f64 = 10.0;

/// Thickness of the lattice's sheet: it grows with the square of the distance from the middle,
/// as a share of the block's size.
#[derive(Clone, Copy, Debug)]
struct Outwards {
    inner: f64,
    outer: f64,
}

impl Grading for Outwards {
    #[inline(always)]
    fn at<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let [a, b, c] = SEMI_AXES.to_array().map(f64::recip);
        let share = (x * a).square() + (y * b).square() + (z * c).square();
        share * (self.outer - self.inner) + self.inner
    }

    fn limits(&self) -> Interval {
        Interval::new(self.inner, self.outer)
    }
}

/// The block before anything is taken from it, less `inset` on every side.
fn block(inset: f64) -> Solid {
    Solid::superellipsoid(SEMI_AXES - inset, 0.45, 0.45)
}

/// The block's skin, filled with the lattice, with a window.
pub(crate) fn light_block() -> Solid {
    // The upper corner towards the viewer, its edges rounded.
    let corner = Solid::rounded_cuboid(2.0 * SEMI_AXES, 5.0);
    let window = corner.translate(SEMI_AXES * DVec3::new(0.95, -1.1, 1.05)).named("window");
    let skin = (block(0.0) - block(SKIN)).named("skin");

    let thickness = Outwards { inner: 0.7, outer: 1.7 };
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: CELL, thickness };
    // The lattice reaches into the skin by half of its thickness.
    let lattice = (block(0.5 * SKIN) & Solid::new(gyroid)).named("lattice");
    (skin | lattice) - window
}

fn written(path: &Path, start: Instant) -> Result<(), Box<dyn Error>> {
    let (bytes, seconds) = (std::fs::metadata(path)?.len(), start.elapsed().as_secs_f64());
    println!("{}: {} kB, {seconds:.1} s", path.display(), bytes.div_ceil(1000));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;

    println!("A block of a graded gyroid in a superellipsoid's skin.");
    let (solid, light) = (block(0.0), light_block());
    let bounds = light.bounds()?;
    println!("  {:.1} x {:.1} x {:.1} mm", bounds.size().x, bounds.size().y, bounds.size().z);

    let start = Instant::now();
    let settings =
        RenderSettings { width: 420, height: 340, samples: 2, paint: [126, 158, 176].into(), ..Default::default() };
    let camera = Camera::framing(&bounds).fitted(&bounds, f64::from(settings.width) / f64::from(settings.height));
    let path = folder.join("lattice.png");
    light.render(&camera, &settings)?.save(&path)?;
    written(&path, start)?;

    let start = Instant::now();
    let mesh = light.mesh(&MeshSettings { cell: CellSize::Length(0.5), ..MeshSettings::default() })?;
    for warning in mesh.warnings() {
        println!("warning: {warning}");
    }
    let path = folder.join("lattice.stl");
    mesh.save(&path)?;
    written(&path, start)?;
    let report = mesh.check();
    println!(
        "  {} triangles, {}, {}, {} handles, volume {:.0} mm3",
        report.triangles,
        if report.is_closed() { "closed" } else { "NOT CLOSED" },
        if report.is_manifold() { "manifold" } else { "NOT MANIFOLD" },
        report.genus.unwrap_or(0),
        report.volume
    );

    let full = solid.mesh(&MeshSettings::default())?.volume();
    let share = report.volume / full;
    // Aluminium: 2.70 grams in a cubic centimetre.
    let grams = |volume: f64| 2.70e-3 * volume;
    println!("  volume fraction {:.1} % of the full block's {full:.0} mm3", 100.0 * share);
    println!(
        "  in aluminium {:.1} g in place of {:.1} g: {:.1} g or {:.1} % of the weight saved",
        grams(report.volume),
        grams(full),
        grams(full - report.volume),
        100.0 * (1.0 - share)
    );
    Ok(())
}
