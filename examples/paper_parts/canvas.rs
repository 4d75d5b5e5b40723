//! A picture to draw on: lines, dots, other pictures, titles.

use glam::DVec2;
use image::{Rgb, RgbImage};
use rvachev::Image;

#[path = "../gallery/font.rs"]
#[allow(dead_code, reason = "only the sheet of the gallery needs all of it")]
mod font;

/// Height of a title, and the space around panels, in pixels.
pub const TITLE: u32 = 26;
pub const GAP: u32 = 16;

pub const INK: [u8; 3] = [48, 52, 58];
pub const RED: [u8; 3] = [200, 60, 40];
pub const BLUE: [u8; 3] = [40, 90, 190];

/// Panels of one size in rows, each with a title.
pub struct Sheet {
    image: RgbImage,
    panel: [u32; 2],
    columns: u32,
    next: u32,
}

impl Sheet {
    pub fn new(columns: u32, rows: u32, panel: [u32; 2]) -> Sheet {
        let [width, height] = [panel[0] + GAP, panel[1] + TITLE + GAP];
        let image = RgbImage::from_pixel(columns * width + GAP, rows * height + GAP, Rgb([255; 3]));
        Sheet { image, panel, columns, next: 0 }
    }

    /// The next panel, from left to right and down.
    pub fn panel(&mut self, title: &str) -> Panel<'_> {
        let (column, row) = (self.next % self.columns, self.next / self.columns);
        self.next += 1;
        let (left, top) = (GAP + column * (self.panel[0] + GAP), GAP + row * (self.panel[1] + TITLE + GAP));
        font::write(&mut self.image, title, (left, top + 4), 2, INK);
        Panel { image: &mut self.image, corner: [left, top + TITLE], size: self.panel, scale: 1.0 }
    }

    pub fn save(&self, path: &std::path::Path) -> Result<(), image::ImageError> {
        self.image.save(path)?;
        println!("wrote {}", path.display());
        Ok(())
    }
}

/// A panel; its middle is the origin, and `scale` pixels are a length unit.
pub struct Panel<'a> {
    image: &'a mut RgbImage,
    corner: [u32; 2],
    size: [u32; 2],
    pub scale: f64,
}

impl Panel<'_> {
    /// Where a place in length units is, in pixels of the panel.
    pub fn pixel(&self, p: DVec2) -> DVec2 {
        0.5 * DVec2::new(f64::from(self.size[0]), f64::from(self.size[1])) + self.scale * DVec2::new(p.x, -p.y)
    }

    fn blend(&mut self, x: i64, y: i64, color: [u8; 3], share: f64) {
        let within = |x: i64, size: u32| (0..i64::from(size)).contains(&x);
        if share <= 0.0 || !within(x, self.size[0]) || !within(y, self.size[1]) {
            return;
        }
        let pixel = self.image.get_pixel_mut(self.corner[0] + x as u32, self.corner[1] + y as u32);
        for (to, from) in pixel.0.iter_mut().zip(color) {
            let mixed = f64::from(*to) + (f64::from(from) - f64::from(*to)) * share.min(1.0);
            *to = mixed.round() as u8;
        }
    }

    /// A disc about a pixel.
    pub fn dot(&mut self, at: DVec2, radius: f64, color: [u8; 3]) {
        let reach = radius.ceil() as i64 + 1;
        let (cx, cy) = (at.x.round() as i64, at.y.round() as i64);
        for y in cy - reach..=cy + reach {
            for x in cx - reach..=cx + reach {
                let away = at.distance(DVec2::new(x as f64, y as f64));
                self.blend(x, y, color, radius + 0.5 - away);
            }
        }
    }

    /// A closed line through places in length units, two pixels wide.
    pub fn curve(&mut self, points: &[DVec2], color: [u8; 3]) {
        for (i, p) in points.iter().enumerate() {
            let (from, to) = (self.pixel(*p), self.pixel(points[(i + 1) % points.len()]));
            let steps = (2.0 * from.distance(to)).ceil().max(1.0);
            for k in 0..steps as u32 {
                self.dot(from.lerp(to, f64::from(k) / steps), 0.6, color);
            }
        }
    }

    /// A picture of the panel's size.
    pub fn picture(&mut self, picture: &Image) {
        for (y, row) in (0..).zip(picture.pixels().chunks(picture.width() as usize)) {
            for (x, [red, green, blue, _]) in (0..).zip(row) {
                self.blend(x, y, [*red, *green, *blue], 1.0);
            }
        }
    }
}
