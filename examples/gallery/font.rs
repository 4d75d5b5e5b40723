//! A bitmap font: lower-case letters and digits, five pixels wide, seven high and two below
//! the line.

use image::{Rgb, RgbImage};

/// Rows of a letter, and from one line of text to the next.
const ROWS: usize = 9;
pub const LINE: u32 = 11;

/// Columns that a letter has in the bands below.
const COLUMNS: usize = 6;

/// The letters of each band, and the bands.
const BANDS: [(&str, [&str; ROWS]); 4] = [
    (
        "abcdefghi",
        [
            "      #              #         ##         #       #  ",
            "      #              #        #           #          ",
            " ###  ####   ###   ####  ###  ####   #### ####   ##  ",
            "    # #   # #     #   # #   #  #    #   # #   #   #  ",
            " #### #   # #     #   # #####  #    #   # #   #   #  ",
            "#   # #   # #     #   # #      #    #   # #   #   #  ",
            " #### ####   ###   ####  ###   #     #### #   #  ### ",
            "                                        #            ",
            "                                     ###             ",
        ],
    ),
    (
        "jklmnopqr",
        [
            "   #  #      ##                                      ",
            "      #       #                                      ",
            "  ##  #  #    #   ## #  ####   ###  ####   #### # ## ",
            "   #  # #     #   # # # #   # #   # #   # #   # ##   ",
            "   #  ##      #   # # # #   # #   # #   # #   # #    ",
            "   #  # #     #   # # # #   # #   # #   # #   # #    ",
            "   #  #  #   ###  # # # #   #  ###  ####   #### #    ",
            "   #                                #         #      ",
            " ##                                 #         #      ",
        ],
    ),
    (
        "stuvwxyz-",
        [
            "       #                                             ",
            "       #                                             ",
            " #### ####  #   # #   # # # # #   # #   # #####      ",
            "#      #    #   # #   # # # #  # #  #   #    #       ",
            " ###   #    #   #  # #  # # #   #   #   #   #   #### ",
            "    #  #    #   #  # #  # # #  # #  #   #  #         ",
            "####    ##   ####   #    # #  #   #  #### #####      ",
            "                                        #            ",
            "                                     ###             ",
        ],
    ),
    (
        "0123456789",
        [
            " ###    #    ###   ###     #  #####  ###  #####  ###   ### ",
            "#   #  ##   #   # #   #   ##  #     #        #  #   # #   #",
            "#  ##   #       #     #  # #  ####  #        #  #   # #   #",
            "# # #   #      #    ##  #  #      # ####    #    ###   ####",
            "##  #   #     #       # #####     # #   #   #   #   #     #",
            "#   #   #    #    #   #    #  #   # #   #  #    #   #     #",
            " ###   ###  #####  ###     #   ###   ###   #     ###   ### ",
            "                                                           ",
            "                                                           ",
        ],
    ),
];

/// The pixels of a letter that are set, (column, row) from its top left corner, and its width.
fn glyph(letter: char) -> (Vec<(u32, u32)>, u32) {
    let mut pixels = Vec::new();
    for (letters, rows) in BANDS {
        let Some(place) = letters.find(letter) else { continue };
        for (y, row) in rows.into_iter().enumerate() {
            let columns = row.bytes().skip(COLUMNS * place).take(COLUMNS).enumerate();
            pixels.extend(columns.filter(|column| column.1 == b'#').map(|(x, _)| (x as u32, y as u32)));
        }
    }
    // Blank columns on the left, as of the i, are left out.
    let left = pixels.iter().map(|pixel| pixel.0).min().unwrap_or(0);
    let right = pixels.iter().map(|pixel| pixel.0).max().unwrap_or(2);
    (pixels.into_iter().map(|(x, y)| (x - left, y)).collect(), right - left + 1)
}

/// How wide a line is, in pixels of the font.
pub fn width(text: &str) -> u32 {
    text.chars().map(|letter| glyph(letter).1 + 1).sum::<u32>().saturating_sub(1)
}

/// Writes a line, its top left corner at (`x`, `y`), each pixel of the font `scale` wide.
pub fn write(picture: &mut RgbImage, text: &str, (mut x, y): (u32, u32), scale: u32, color: [u8; 3]) {
    for letter in text.chars() {
        let (pixels, width) = glyph(letter);
        for (column, row) in pixels {
            for i in 0..scale * scale {
                let at = (x + scale * column + i % scale, y + scale * row + i / scale);
                if let Some(pixel) = picture.get_pixel_mut_checked(at.0, at.1) {
                    *pixel = Rgb(color);
                }
            }
        }
        x += scale * (width + 1);
    }
}

/// A text broken between words into lines that are no wider than `width`.
pub fn lines(text: &str, most: u32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last().map_or("", String::as_str);
        let longer = if line.is_empty() { word.to_string() } else { format!("{line} {word}") };
        if line.is_empty() || width(&longer) <= most {
            lines.pop();
            lines.push(longer);
        } else {
            lines.push(word.to_string());
        }
    }
    lines
}
