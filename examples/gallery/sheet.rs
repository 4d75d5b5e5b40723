//! The contact sheet: rows of families with headings, a label under every picture.

use image::{Rgb, RgbImage, imageops};

use crate::BACKGROUND;
use crate::catalogue::FAMILIES;
use crate::font;

const COLUMNS: usize = 8;
const GAP: u32 = 8;
const HEADING: u32 = 36;
const LABEL: u32 = 2 * font::LINE + 8;

const INK: [u8; 3] = [48, 52, 58];

/// The pictures of all families in the order of the catalogue, all of one size, on one sheet.
pub fn sheet(pictures: &[RgbImage], (across, down): (u32, u32)) -> RgbImage {
    let rows = FAMILIES.iter().map(|family| family.entries.len().div_ceil(COLUMNS) as u32);
    let height = rows.map(|rows| HEADING + rows * (down + LABEL)).sum::<u32>() + GAP;
    let width = COLUMNS as u32 * (across + GAP) + GAP;
    let mut sheet = RgbImage::from_pixel(width, height, Rgb(BACKGROUND));

    let mut pictures = pictures.iter();
    let mut top = 0;
    for family in FAMILIES {
        font::write(&mut sheet, family.title, (GAP, top + 12), 2, INK);
        let after = 2 * font::width(family.title) + 2 * GAP;
        for x in after..width - GAP {
            sheet.put_pixel(x, top + 22, Rgb(family.color));
        }
        top += HEADING;
        for row in family.entries.chunks(COLUMNS) {
            let places = (0..).map(|column| GAP + column * (across + GAP));
            for ((left, (name, _)), picture) in places.zip(row).zip(&mut pictures) {
                imageops::replace(&mut sheet, picture, i64::from(left), i64::from(top));
                let mut line_top = top + down + 2;
                for line in font::lines(&name.replace('_', " "), across) {
                    let indent = across.saturating_sub(font::width(&line)) / 2;
                    font::write(&mut sheet, &line, (left + indent, line_top), 1, INK);
                    line_top += font::LINE;
                }
            }
            top += down + LABEL;
        }
    }
    sheet
}
