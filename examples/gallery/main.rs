//! The gallery: everything in the catalogue, one small picture each and all on one sheet.
//!
//! ```sh
//! cargo run --example gallery             # into target/examples/gallery
//! cargo run --example gallery FOLDER      # into that folder
//! cargo run --example gallery docs        # docs/gallery and docs/gallery.png, as committed: finer, slower
//! cargo run --example gallery times       # entry by entry on one thread, and how long each takes
//! ```
//!
//! What is shown, and how each is written, is in `catalogue`.

mod catalogue;
mod font;
mod sheet;

use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::Instant;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgb, RgbImage};
use rayon::prelude::*;
use rvachev::{Background, Camera, RenderSettings, Run, Solid, error::RenderError};

use catalogue::{Entry, FAMILIES};

/// Size of a picture, in pixels: for the docs, and for a try.
const DOCS_SIZE: (u32, u32) = (112, 84);
const SIZE: (u32, u32) = (88, 66);

const BACKGROUND: [u8; 3] = [248, 248, 248];

/// Colours are rounded to multiples of this: the files are half as large.
const COLOR_STEP: u8 = 4;

/// How pictures are made.
#[derive(Clone, Copy)]
struct Manner {
    size: (u32, u32),
    /// See [`RenderSettings::samples`].
    samples: u32,
    /// On one thread, and saying how long each takes.
    timed: bool,
}

/// A solid as all are shown: from the same direction, as large as its box allows.
fn picture(solid: &Solid, color: [u8; 3], manner: Manner) -> Result<RgbImage, RenderError> {
    let bounds = solid.bounds()?;
    let (width, height) = manner.size;
    let camera = Camera::framing(&bounds).fitted(&bounds, f64::from(width) / f64::from(height));
    let settings = RenderSettings {
        width,
        height,
        samples: manner.samples,
        paint: color.into(),
        ground: false,
        background: Background::Plain(BACKGROUND),
        ..RenderSettings::default()
    };
    let run = Run { threads: usize::from(manner.timed), ..Run::default() };
    let image = solid.render_with(&camera, &settings, &run)?;
    let round = |channel: u8| channel.min(BACKGROUND[0]).next_multiple_of(COLOR_STEP);
    Ok(RgbImage::from_fn(width, height, |x, y| {
        let [red, green, blue, _] = image.pixel(x, y).unwrap_or_default();
        Rgb([red, green, blue].map(round))
    }))
}

/// The picture of an entry, and the length of its file in `folder`.
fn picture_of((name, make): &Entry, color: [u8; 3], manner: Manner, folder: &Path) -> Result<(RgbImage, u64), String> {
    let start = Instant::now();
    let told = |error: &dyn Error| format!("{name}: {error}");
    let picture = picture(&make(), color, manner).map_err(|error| told(&error))?;
    let length = save(&picture, &place(folder, name)).map_err(|error| told(&*error))?;
    if manner.timed {
        println!("{:7.1} ms  {name}", 1e3 * start.elapsed().as_secs_f64());
    }
    Ok((picture, length))
}

/// Writes a PNG file and returns its length.
/// Where a picture goes: of what the inner crate documents, beside that crate's documentation.
fn place(folder: &Path, name: &str) -> PathBuf {
    let file = format!("{name}.png");
    let inner = Path::new("crates/rvachev-field").join(folder).join(&file);
    if inner.exists() { inner } else { folder.join(&file) }
}

fn save(picture: &RgbImage, path: &Path) -> Result<u64, Box<dyn Error>> {
    let file = BufWriter::new(File::create(path)?);
    picture.write_with_encoder(PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::NoFilter))?;
    Ok(fs::metadata(path)?.len())
}

fn main() -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let mut folder = PathBuf::from("target/examples/gallery");
    let mut sheet_path = folder.join("sheet.png");
    let mut manner = Manner { size: SIZE, samples: 1, timed: false };
    for argument in std::env::args().skip(1) {
        match argument.as_str() {
            "times" => manner.timed = true,
            "docs" => {
                (manner.samples, manner.size) = (3, DOCS_SIZE);
                (folder, sheet_path) = ("docs/gallery".into(), "docs/gallery.png".into());
            }
            other => (folder, sheet_path) = (other.into(), Path::new(other).join("sheet.png")),
        }
    }
    fs::create_dir_all(&folder)?;

    let entries: Vec<(&Entry, [u8; 3])> =
        FAMILIES.iter().flat_map(|family| family.entries.iter().map(|entry| (entry, family.color))).collect();
    let make = |(entry, color): &(&Entry, [u8; 3])| picture_of(entry, *color, manner, &folder);
    let made: Result<Vec<(RgbImage, u64)>, String> =
        if manner.timed { entries.iter().map(make).collect() } else { entries.par_iter().map(make).collect() };
    let (pictures, lengths): (Vec<RgbImage>, Vec<u64>) = made?.into_iter().unzip();
    let bytes: u64 = lengths.iter().sum();
    let (width, height) = manner.size;
    println!("{}: {} pictures of {width} x {height} pixels, {bytes} bytes", folder.display(), pictures.len());

    let sheet = sheet::sheet(&pictures, manner.size);
    let length = save(&sheet, &sheet_path)?;
    println!("{}: {} x {} pixels, {length} bytes", sheet_path.display(), sheet.width(), sheet.height());
    println!("{:.1} s in all", start.elapsed().as_secs_f64());
    Ok(())
}
