//! The bar beside a picture whose colours stand for numbers.

/// Characters of 5 × 7 dots, a row in the five lowest bits.
const GLYPHS: [(char, [u8; 7]); 14] = [
    ('0', [0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e]),
    ('1', [0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e]),
    ('2', [0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f]),
    ('3', [0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e]),
    ('4', [0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02]),
    ('5', [0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e]),
    ('6', [0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e]),
    ('7', [0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08]),
    ('8', [0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e]),
    ('9', [0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c]),
    ('.', [0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c]),
    ('+', [0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00]),
    ('-', [0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00]),
    ('e', [0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e]),
];

const WHITE: [u8; 4] = [255; 4];
const BLACK: [u8; 4] = [0, 0, 0, 255];

/// How wide a character is, with the gap behind it, and how high, in dots.
const WIDE: usize = 6;
const HIGH: usize = 7;

/// Draws the bar at the right of a picture that is `width` wide: labels from its upper to its lower
/// end, and colours by how high they are on it, from 0 to 1.
pub(crate) fn legend(pixels: &mut [[u8; 4]], width: usize, labels: &[String; 5], color: impl Fn(f64) -> [u8; 3]) {
    let height = pixels.len() / width.max(1);
    let dot = (height / 240).max(1);
    let longest = labels.iter().map(String::len).max().unwrap_or_default();
    let (bar, text) = (8 * dot, longest * WIDE * dot);
    let margin = 4 * dot;
    let (top, bottom) = (margin + HIGH * dot, height.saturating_sub(margin + HIGH * dot));
    // There is no room for it in a small picture.
    if width < 2 * (bar + text + 3 * margin) || bottom < top + 10 * HIGH * dot {
        return;
    }
    let left = width - margin - text - margin - bar;
    let middles = [0, 1, 2, 3, 4].map(|i| top + i * (bottom - top - 1) / 4);
    // Dark on what is light.
    let inks = middles.map(|y| {
        let [r, g, b, a] = pixels[y * width + left + bar + margin];
        if a > 127 && u32::from(r) + u32::from(g) + u32::from(b) > 382 { BLACK } else { WHITE }
    });
    let mut put = |x: usize, y: usize, color: [u8; 4]| pixels[y * width + x] = color;
    for y in top..bottom {
        let [r, g, b] = color(1.0 - (y - top) as f64 / (bottom - top - 1) as f64);
        (left..left + bar).for_each(|x| put(x, y, [r, g, b, 255]));
    }
    for ((label, middle), ink) in labels.iter().zip(middles).zip(inks) {
        for (k, c) in label.chars().enumerate() {
            let Some((_, rows)) = GLYPHS.iter().find(|(own, _)| *own == c) else { continue };
            for (row, bits) in rows.iter().enumerate() {
                for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                    let x = left + bar + margin + (k * WIDE + column) * dot;
                    let y = middle + row * dot - HIGH * dot / 2;
                    (0..dot * dot).for_each(|at| put(x + at % dot, y + at / dot, ink));
                }
            }
        }
    }
}

/// A number to three digits or so of the largest one on the bar, with its sign if that is asked
/// for.
pub(crate) fn label(value: f64, largest: f64, is_signed: bool) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    let sign = if is_signed && value > 0.0 { "+" } else { "" };
    if !(1e-4..1e5).contains(&largest) {
        return format!("{sign}{value:.1e}");
    }
    let decimals = (2.0 - largest.log10().floor()).clamp(0.0, 7.0) as usize;
    let text = format!("{sign}{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_seen_on_any_background() {
        let (width, height) = (320, 240);
        for background in [[0, 0, 0, 255], [40, 42, 46, 255], [250, 250, 250, 255], [0; 4]] {
            let mut pixels = vec![background; width * height];
            legend(&mut pixels, width, &["1", "2", "3", "4", "5"].map(str::to_string), |_| [255, 0, 0]);
            // Right of the bar.
            let ink = |i: &usize| i % width > width - 12 && pixels[*i] != background;
            let inks: Vec<usize> = (0..width * height).filter(ink).collect();
            assert!(inks.len() > 40, "{background:?}");
            assert!(inks.iter().all(|i| pixels[*i][0].abs_diff(background[0]) > 100), "{background:?}");
        }
    }

    #[test]
    fn labels_are_short() {
        let all = |reach: f64, is_signed| [1.0, 0.5, 0.0, -0.5].map(|t| label(t * reach, reach, is_signed));
        assert_eq!(all(0.4, true), ["+0.4", "+0.2", "0", "-0.2"]);
        assert_eq!(all(25.0, true), ["+25", "+12.5", "0", "-12.5"]);
        assert_eq!(all(3e-6, true), ["+3.0e-6", "+1.5e-6", "0", "-1.5e-6"]);
        assert_eq!(all(2.5, false), ["2.5", "1.25", "0", "-1.25"]);
    }
}
