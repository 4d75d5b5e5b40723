//! Golden pictures: small PNGs in `tests/golden`, compared with a tolerance.
//!
//! `BLESS=1 cargo test` writes them anew. Where one fails, what was made and the difference are
//! left under `target/golden`.

use std::path::PathBuf;

use image::RgbaImage;
use rvachev::Image;

/// A channel may be this much off at any pixel, as SIMD levels round differently.
const SMALL: u8 = 10;

/// The share of the pixels that may be off by more: edges that a rounding tips over.
const SHARE: f64 = 0.01;

fn buffer(image: &Image) -> RgbaImage {
    RgbaImage::from_raw(image.width(), image.height(), image.pixels().as_flattened().to_vec()).unwrap()
}

/// Compares `image` with the picture of this name.
#[track_caller]
pub fn same_as_golden(name: &str, image: &Image) {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let path = root.join(format!("tests/golden/{name}.png"));
    let actual = buffer(image);
    if std::env::var_os("BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        image.save(&path).unwrap();
        return;
    }
    let folder = root.join("target/golden");
    let leave = |what: &str, picture: &RgbaImage| {
        std::fs::create_dir_all(&folder).unwrap();
        picture.save(folder.join(format!("{name}.{what}.png"))).unwrap();
    };
    let Ok(golden) = image::open(&path).map(image::DynamicImage::into_rgba8) else {
        leave("actual", &actual);
        panic!("{}: not there; BLESS=1 writes it", path.display());
    };
    assert_eq!(golden.dimensions(), actual.dimensions(), "{name}");
    let mut difference = golden.clone();
    let mut off = 0;
    for (pixel, (a, b)) in difference.pixels_mut().zip(golden.pixels().zip(actual.pixels())) {
        let channels = [0, 1, 2, 3].map(|c| a.0[c].abs_diff(b.0[c]));
        let worst = *channels.iter().max().unwrap();
        off += usize::from(worst > SMALL);
        pixel.0 = [channels[0].saturating_mul(4), channels[1].saturating_mul(4), channels[2].saturating_mul(4), 255];
    }
    let share = off as f64 / actual.pixels().len() as f64;
    if share > SHARE {
        leave("actual", &actual);
        leave("diff", &difference);
        panic!("{name}: {:.1} % of the pixels differ; see {}", 100.0 * share, folder.display());
    }
}

/// A picture as text: `#` where `mark` says so.
pub fn ascii<P: Copy>(image: &Image<P>, mark: impl Fn(P) -> char) -> String {
    let rows = image.pixels().chunks(image.width() as usize);
    rows.map(|row| row.iter().map(|p| mark(*p)).collect::<String>().trim_end().to_string() + "\n").collect()
}
