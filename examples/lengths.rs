//! The pictures of the page on lengths: offsets, shells, rounded and filleted solids, balls that do
//! not fit.
//!
//! ```sh
//! cargo run --example lengths             # into target/examples/lengths
//! cargo run --example lengths docs        # into docs/lengths, as committed
//! ```
//!
//! What a verb is given stands on the left, in grey; what it makes of it is beside it, in colour.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use glam::DVec3;
use rvachev::{Blend, Profile, RFunction, Solid, deg};

mod page;

use page::{GREY, picture, save, side_by_side};

const BLUE: [u8; 3] = [112, 150, 186];
const GREEN: [u8; 3] = [104, 160, 116];
const RED: [u8; 3] = [206, 122, 90];

/// Towards the eye.
const DIRECTION: DVec3 = DVec3::new(0.45, -1.0, 0.65);

/// Between two solids, in length units.
const GAP: f64 = 1.5;

/// Without the quarter that is nearest to the viewer.
fn cut_open(solid: Solid) -> Solid {
    solid - Solid::cuboid([40.0; 3]).translate([20.0, -20.0, 0.0])
}

/// A step with a hole: convex edges, a concave one, and a joint of two boxes that lie flush.
fn step() -> Solid {
    let lower = Solid::cuboid([14.0, 9.0, 4.0]).translate([1.0, 0.0, -2.0]);
    let upper = Solid::cuboid([6.0, 9.0, 5.0]).translate([-3.0, 0.0, 2.5]);
    (lower | upper) - Solid::cylinder(1.4, 20.0).translate([4.0, 0.0, 0.0])
}

/// What the step becomes when its surface is moved in and out.
fn offset() -> Vec<Solid> {
    let step = step();
    vec![step.offset(-1.0).paint(GREEN), step.paint(GREY), step.offset(1.0).paint(BLUE)]
}

/// A body of two cylinders, one passage inside.
fn shell() -> Vec<Solid> {
    let body = Solid::cylinder(5.5, 9.0) | Solid::cylinder(2.5, 6.0).translate([0.0, 0.0, 6.0]);
    vec![body.paint(GREY), cut_open(body.shell(0.9)).paint(BLUE)]
}

fn opening() -> Vec<Solid> {
    vec![step().paint(GREY), step().rounded(1.1).paint(BLUE)]
}

fn closing() -> Vec<Solid> {
    vec![step().paint(GREY), step().filleted(1.6).paint(BLUE)]
}

/// A block and a post that are flush at the top, joined sharply, by a fillet, a chamfer and a
/// smooth blend.
pub(crate) fn flush() -> Vec<Solid> {
    let block = Solid::cuboid([10.0, 6.0, 5.0]).translate([-3.0, 3.0, 0.0]);
    let post = Solid::cylinder(4.0, 5.0).translate([2.5, -0.5, 0.0]);
    let with = |blend| block.union_with(&post, blend);
    vec![
        (&block | &post).paint(GREY),
        with(Blend::Fillet { radius: 2.0 }).paint(BLUE),
        with(Blend::Chamfer { leg: 1.5 }).paint(GREEN),
        with(Blend::Smooth { radius: 2.5 }).paint(RED),
    ]
}

/// A comb whose gaps and teeth are of three widths.
fn comb() -> Solid {
    let back = Profile::rectangle([17.5, 3.0]).translate([8.75, 1.5]);
    let teeth = [(0.0, 3.5), (7.0, 2.5), (10.7, 3.0), (16.4, 1.1)];
    let teeth = teeth.map(|(left, width)| Profile::rectangle([width, 8.0]).translate([left + 0.5 * width, 4.0]));
    Profile::union_all([back].into_iter().chain(teeth), RFunction::MIN_MAX).extrude(6.0).rotate_x(deg(90.0))
}

/// A ball of radius 1: what it does not fit into from outside is filled, and what it does not fit
/// into inside is gone.
pub(crate) fn no_fit() -> Vec<Solid> {
    vec![comb().paint(GREY), comb().filleted(1.0).paint(BLUE), comb().rounded(1.0).paint(GREEN)]
}

fn main() -> Result<(), Box<dyn Error>> {
    let docs = std::env::args().nth(1).is_some_and(|argument| argument == "docs");
    let folder = PathBuf::from(if docs { "docs/lengths" } else { "target/examples/lengths" });
    std::fs::create_dir_all(&folder)?;
    type Scene = (&'static str, fn() -> Vec<Solid>, (u32, u32));
    let scenes: [Scene; 6] = [
        ("offset", offset, (640, 320)),
        ("shell", shell, (480, 320)),
        ("opening", opening, (520, 320)),
        ("closing", closing, (520, 320)),
        ("flush", flush, (920, 380)),
        ("no_fit", no_fit, (920, 380)),
    ];
    for (name, make, size) in scenes {
        let start = Instant::now();
        let path = folder.join(format!("{name}.png"));
        let row = side_by_side(&make(), GAP, DIRECTION)?;
        save(&picture(&row, DIRECTION, size, if docs { 3 } else { 1 })?, &path)?;
        println!("    {:.1} s", start.elapsed().as_secs_f64());
    }
    Ok(())
}
