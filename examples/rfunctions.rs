//! The fields of R-functions: max, R_0^m and R_p of the coordinates x and y over [−1, 1]².
//!
//! ```text
//! cargo run --release --example rfunctions -- out
//! ```
//!
//! writes `rfunctions.png`: six slices side by side. All six are positive in the same region,
//! wherever x or y is; what differs is the field around it. Max has a crease along the diagonal
//! x = y; R_0 is smooth but in the corner, its slope falling to 0 there with m; R_p is smooth and
//! keeps a slope of 1 on the border.

use std::error::Error;
use std::path::PathBuf;

use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};
use rvachev::{Plane, PlaneBounds, RFunction, SliceSettings, Solid, layers::Isolines};

#[path = "gallery/font.rs"]
#[allow(dead_code, reason = "only the sheet of the gallery needs all of it")]
mod font;

/// Side of a slice, and the space around it, in pixels.
const SIDE: u32 = 300;
const GAP: u32 = 18;
const TITLE: u32 = 26;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;
    let rules = [
        ("max", RFunction::MIN_MAX),
        ("r-zero", RFunction::Zero { m: 0 }),
        ("r-zero m 2", RFunction::Zero { m: 2 }),
        ("r-p 2", RFunction::P(2.0)),
        ("r-p 4", RFunction::P(4.0)),
        ("r-p 10", RFunction::P(10.0)),
    ];
    // Half-spaces whose values are x and y.
    let (x, y) = (Solid::half_space(-DVec3::X, 0.0), Solid::half_space(-DVec3::Y, 0.0));
    let region = PlaneBounds { min: DVec2::NEG_ONE, max: DVec2::ONE };
    let settings = SliceSettings { width: SIDE, isolines: Isolines::Every(0.1), ..SliceSettings::default() };
    let (width, height) = (3 * SIDE + 4 * GAP, 2 * (SIDE + TITLE) + 3 * GAP);
    let mut sheet = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    for (i, (name, rule)) in (0u32..).zip(rules) {
        let (left, top) = (GAP + i % 3 * (SIDE + GAP), GAP + i / 3 * (SIDE + TITLE + GAP));
        let slice = x.union(&y, rule).slice_within(&Plane::xy(0.0), region)?;
        let picture = slice.picture(&settings)?;
        font::write(&mut sheet, name, (left, top + 4), 2, [48, 52, 58]);
        for (y, row) in (top + TITLE..).zip(picture.pixels().chunks(SIDE as usize)) {
            for (x, [red, green, blue, _]) in (left..).zip(row) {
                sheet.put_pixel(x, y, Rgb([*red, *green, *blue]));
            }
        }
    }
    let path = folder.join("rfunctions.png");
    sheet.save(&path)?;
    println!("wrote {}", path.display());
    Ok(())
}
