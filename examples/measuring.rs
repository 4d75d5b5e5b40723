//! The pictures of the page on measuring: what is made of a solid, thickness, clearance.
//!
//! ```sh
//! cargo run --example measuring           # into target/examples/measuring
//! cargo run --example measuring docs      # into docs/measuring, as committed
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rvachev::{
    Background, Camera, CellSize, Image, MeshSettings, MeshSolid, RFunction, RenderSettings, Run, Solid, deg,
};

const GREY: [u8; 3] = [178, 178, 176];
const BLUE: [u8; 3] = [112, 150, 186];
const GREEN: [u8; 3] = [104, 160, 116];
const RED: [u8; 3] = [206, 70, 60];

const BACKGROUND: [u8; 3] = [248, 248, 248];

/// Towards the eye.
const DIRECTION: DVec3 = DVec3::new(0.3, -1.0, 0.6);

/// Without the quarter that is nearest to the viewer.
fn cut_open(solid: &Solid) -> Solid {
    solid - Solid::cuboid([80.0; 3]).translate([40.0, -40.0, 0.0])
}

/// A rounded block with a bore.
pub(crate) fn block() -> Solid {
    Solid::superellipsoid([8.0, 6.0, 5.0], 0.3, 0.6) - Solid::cylinder(2.5, 20.0).rotate_x(deg(90.0))
}

/// A solid, three meshes of it, and what is made of the finest.
fn made() -> Result<Solid, Box<dyn Error>> {
    let block = block();
    let mesh = |cell| block.mesh(&MeshSettings { cell, ..MeshSettings::default() });
    let read = |cell| -> Result<Solid, Box<dyn Error>> { Ok(Solid::from_mesh(&mesh(cell)?, MeshSolid::default())) };
    let [coarse, middle, fine] = [CellSize::Length(1.6), CellSize::Length(1.0), CellSize::Tolerance(0.01)];
    let hollow = cut_open(&read(fine)?.shell(0.7));
    let row = [
        block.paint(GREY),
        read(coarse)?.paint(BLUE),
        read(middle)?.paint(BLUE),
        read(fine)?.paint(BLUE),
        hollow.paint(GREEN),
    ];
    let row = row.into_iter().enumerate().map(|(n, solid)| solid.translate([18.0 * n as f64, 0.0, 0.0]));
    Ok(Solid::union_all(row, RFunction::MIN_MAX))
}

/// A tray with a rib that is drafted by 3° on both sides, and a boss with a hole.
pub(crate) fn tray() -> Solid {
    let tray = Solid::cuboid([60.0, 40.0, 14.0]) - Solid::cuboid([56.0, 37.0, 14.0]).translate([0.0, 0.0, 2.5]);
    let side = |sign: f64| Solid::half_space([sign * 0.9986, 0.0, 0.0523], 1.0);
    let rib = (Solid::cuboid([6.0, 38.0, 11.0]) & side(1.0) & side(-1.0)).translate([-12.0, 0.0, 0.0]);
    let boss = Solid::cylinder(5.0, 9.0).translate([14.0, 4.0, -1.5]);
    (tray | rib | boss) - Solid::cylinder(3.4, 9.0).translate([14.0, 4.0, 0.0])
}

/// A pin in a bore: as it is meant to be, and too far to one side.
fn pins() -> Solid {
    let bore = Solid::cuboid([12.0, 12.0, 8.0]) - Solid::cylinder(3.4, 10.0);
    let pin = Solid::cylinder(3.0, 14.0);
    let at = |aside: f64, place: f64| {
        // A little larger than the pin, so that it is seen.
        let overlap = (Solid::cylinder(3.03, 14.0).translate([aside, 0.0, 0.0]) & &bore).paint(RED);
        let both = cut_open(&bore).paint(GREY) | pin.translate([aside, 0.0, 0.0]).paint(BLUE) | overlap;
        both.translate([place, 0.0, 0.0])
    };
    at(0.0, 0.0) | at(0.7, 18.0)
}

fn picture(solid: &Solid, [width, height]: [u32; 2], samples: u32) -> Result<Image, Box<dyn Error>> {
    let (camera, settings) = view(solid, [width, height], samples)?;
    Ok(solid.render(&camera, &settings)?)
}

fn view(solid: &Solid, [width, height]: [u32; 2], samples: u32) -> Result<(Camera, RenderSettings), Box<dyn Error>> {
    let bounds = solid.bounds()?;
    let camera = Camera::framing_orthographic(&bounds);
    let camera = Camera { eye: camera.target + bounds.size().length() * DIRECTION, ..camera };
    let camera = camera.fitted(&bounds, f64::from(width) / f64::from(height));
    let background = Background::Plain(BACKGROUND);
    let settings = RenderSettings { width, height, samples, ground: false, background, ..RenderSettings::default() };
    Ok((camera, settings))
}

fn thickness(samples: u32) -> Result<Image, Box<dyn Error>> {
    let tray = tray();
    let settings = MeshSettings { cell: CellSize::Length(0.5), ..MeshSettings::default() };
    let report = tray.thickness(&settings, &Run::default())?;
    println!("{report}");
    let (camera, mut settings) = view(&tray, [640, 400], samples)?;
    settings.background = Background::Plain([40, 42, 46]);
    // With room for the legend.
    let bounds = tray.bounds()?;
    let camera = camera.fitted(&bounds.inflate(0.1 * bounds.longest_side()), 640.0 / 400.0);
    Ok(report.picture([0.5, 4.0], &camera, &settings, &Run::default())?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = std::env::args().nth(1).is_some_and(|argument| argument == "docs");
    let folder = PathBuf::from(if docs { "docs/measuring" } else { "target/examples/measuring" });
    std::fs::create_dir_all(&folder)?;
    let samples = if docs { 3 } else { 1 };
    let save = |name: &str, image: Image| -> Result<(), Box<dyn Error>> {
        let path: &Path = &folder.join(name);
        image.save(path)?;
        println!("{}", path.display());
        Ok(())
    };
    save("made.png", picture(&made()?, [920, 170], samples)?)?;
    save("thickness.png", thickness(samples)?)?;
    save("clearance.png", picture(&pins(), [560, 340], samples)?)
}
