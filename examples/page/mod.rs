//! Pictures of pages of the documentation: solids side by side on a plain ground, cut to what is
//! seen, in small files.

use std::error::Error;
use std::path::Path;

use glam::DVec3;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgb, RgbImage, imageops};
use rvachev::{Background, Camera, RFunction, RenderSettings, Solid};

pub const GREY: [u8; 3] = [178, 178, 176];

const BACKGROUND: [u8; 3] = [248, 248, 248];

/// Around a picture, in pixels.
const BORDER: u32 = 8;

/// Colours are rounded to multiples of this: the files are half as large.
const COLOR_STEP: u8 = 4;

/// Solids in a row for an eye in a direction, with a gap between two of them, in length units.
pub fn side_by_side(solids: &[Solid], gap: f64, direction: DVec3) -> Result<Solid, Box<dyn Error>> {
    let right = DVec3::Z.cross(direction).normalize();
    let mut row = Vec::new();
    let mut left = 0.0;
    for solid in solids {
        let bounds = solid.bounds()?;
        let half = 0.5 * bounds.size().dot(right.abs());
        let middle = 0.5 * (bounds.min + bounds.max).dot(right);
        row.push(solid.translate((left + half - middle) * right));
        left += 2.0 * half + gap;
    }
    Ok(Solid::union_all(row, RFunction::MIN_MAX))
}

/// A solid as an eye in a direction sees it, with so many samples a pixel along each side.
pub fn picture(
    solid: &Solid,
    direction: DVec3,
    (width, height): (u32, u32),
    samples: u32,
) -> Result<RgbImage, Box<dyn Error>> {
    let bounds = solid.bounds()?;
    let camera = Camera::framing_orthographic(&bounds);
    let camera = Camera { eye: camera.target + bounds.size().length() * direction, ..camera };
    let camera = camera.fitted(&bounds, f64::from(width) / f64::from(height));
    let background = Background::Plain(BACKGROUND);
    let settings = RenderSettings { width, height, samples, ground: false, background, ..RenderSettings::default() };
    let image = solid.render(&camera, &settings)?;
    let round = |channel: u8| channel.min(BACKGROUND[0]).next_multiple_of(COLOR_STEP);
    let picture = RgbImage::from_fn(width, height, |x, y| {
        let [red, green, blue, _] = image.pixel(x, y).unwrap_or_default();
        Rgb([red, green, blue].map(round))
    });
    Ok(cropped(&picture))
}

/// Without what of the background is around it.
fn cropped(picture: &RgbImage) -> RgbImage {
    let (mut left, mut top, mut right, mut bottom) = (picture.width(), picture.height(), 0, 0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        if pixel.0 != BACKGROUND {
            (left, top, right, bottom) = (left.min(x), top.min(y), right.max(x), bottom.max(y));
        }
    }
    let (left, top) = (left.saturating_sub(BORDER), top.saturating_sub(BORDER));
    imageops::crop_imm(picture, left, top, right + BORDER - left, bottom + BORDER - top).to_image()
}

/// Writes a picture in a small file, and says how small.
pub fn save(picture: &RgbImage, path: &Path) -> Result<(), Box<dyn Error>> {
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    picture.write_with_encoder(PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive))?;
    println!("{}: {} bytes", path.display(), std::fs::metadata(path)?.len());
    Ok(())
}
