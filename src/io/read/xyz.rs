//! Points as rows of numbers: XYZ and CSV.
//!
//! ```text
//!   x,y,z,nx,ny,nz,red,green,blue       a row of names, if there is one
//!   1.0,2.0,3.0,0,0,1,200,10,10         numbers between blanks, commas, semicolons or tabs
//! ```
//!
//! Without names, 6 columns are points with normals, unless all numbers of the last three are
//! whole, from 0 to 255, and some are beyond 1: colours. 9 are points, normals and colours. Of any
//! other number only the first three are taken, as programs write intensities in front of colours
//! or behind them, and nothing tells which: a row of names does. Left out are lines that begin with
//! `#` or `//`, empty ones, a separator at the end of a line, and a first line that is a count
//! alone.

use glam::{DVec3, Vec3};

use super::ReadError;
use super::error::{FilePlace, shown};
use super::limits::Limits;
use super::shape::Shape;
use super::text::{lines, number};

/// x, y, z, a normal, red, green, blue: the columns where they are.
type Columns = [Option<usize>; 9];

/// So many columns are looked at.
const MOST: usize = 64;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<Shape, ReadError> {
    let mut columns: Option<Columns> = None;
    let mut is_named = false;
    let mut rows: Vec<[f64; 9]> = Vec::new();
    let mut shape = Shape::default();
    let mut is_first = true;
    for (line, text) in lines(data) {
        let text = text.trim_ascii();
        if text.is_empty() || text.starts_with(b"#") || text.starts_with(b"//") {
            continue;
        }
        let words = words(text);
        let was_first = std::mem::take(&mut is_first);
        if was_first && words.iter().any(|word| number(word).is_none()) {
            columns = Some(named(&words, line)?);
            is_named = true;
            continue;
        }
        if was_first && words.len() == 1 {
            continue;
        }
        settings.points(rows.len() + 1)?;
        let columns = columns.get_or_insert_with(|| by_count(words.len()));
        let mut row = [0.0; 9];
        for (to, column) in row.iter_mut().zip(columns.iter()) {
            let Some(column) = *column else { continue };
            let word = words.get(column).copied();
            *to = word.and_then(number).ok_or_else(|| {
                let expected = format!("a number in column {}", column + 1);
                let found = word.map_or_else(|| format!("{} columns", words.len()), shown);
                ReadError::content(FilePlace::Line(line), expected, found)
            })?;
        }
        shape.push([row[0], row[1], row[2]], || FilePlace::Line(line));
        rows.push(row);
    }
    let mut columns = columns.unwrap_or([None; 9]);
    if !is_named && columns[3].is_some() && columns[6].is_none() && are_colors(&rows) {
        for row in &mut rows {
            let [.., nx, ny, nz, _, _, _] = *row;
            row[6..].copy_from_slice(&[nx, ny, nz]);
        }
        columns = [columns[0], columns[1], columns[2], None, None, None, columns[3], columns[4], columns[5]];
    }
    add(&mut shape, &rows, &columns);
    Ok(shape)
}

/// Adds normals and colours, where there are some.
fn add(shape: &mut Shape, rows: &[[f64; 9]], columns: &Columns) {
    let normal = |row: &[f64; 9]| {
        let normal = DVec3::new(row[3], row[4], row[5]).as_vec3();
        if normal.is_finite() { normal } else { Vec3::ZERO }
    };
    let has = |columns: &[Option<usize>]| columns.iter().all(Option::is_some) && !rows.is_empty();
    let color = |row: &[f64; 9]| [row[6] as u8, row[7] as u8, row[8] as u8, 255];
    shape.normals = has(&columns[3..6]).then(|| rows.iter().map(normal).collect());
    shape.colors = has(&columns[6..]).then(|| rows.iter().map(color).collect());
}

/// Whether what may be normals is colours.
fn are_colors(rows: &[[f64; 9]]) -> bool {
    let numbers = || rows.iter().flat_map(|row| &row[3..6]);
    numbers().all(|x| x.fract() == 0.0 && (0.0..=255.0).contains(x)) && numbers().any(|x| *x > 1.0)
}

/// The columns of rows without names.
fn by_count(count: usize) -> Columns {
    let known = if count == 6 || count == 9 { count } else { 3 };
    std::array::from_fn(|i| (i < known).then_some(i))
}

fn named(words: &[&[u8]], line: u64) -> Result<Columns, ReadError> {
    const NAMES: [[&str; 2]; 9] = [
        ["x", "x"],
        ["y", "y"],
        ["z", "z"],
        ["nx", "normal_x"],
        ["ny", "normal_y"],
        ["nz", "normal_z"],
        ["red", "r"],
        ["green", "g"],
        ["blue", "b"],
    ];
    let is = |word: &[u8], name: &str| word.trim_ascii().eq_ignore_ascii_case(name.as_bytes());
    let columns = NAMES.map(|names| words.iter().position(|word| names.iter().any(|name| is(word, name))));
    if columns[..3].iter().all(Option::is_some) {
        return Ok(columns);
    }
    let found = words.first().map_or_else(String::new, |word| shown(word));
    Err(ReadError::content(FilePlace::Line(line), "three coordinates, or columns named x, y and z", found))
}

fn words(text: &[u8]) -> Vec<&[u8]> {
    // Where semicolons part the columns, commas are those of decimals, which are not understood.
    if let Some(mark) = [b';', b','].into_iter().find(|mark| text.contains(mark)) {
        let text = text.strip_suffix(&[mark]).unwrap_or(text);
        return text.split(|byte| *byte == mark).map(<[u8]>::trim_ascii).take(MOST).collect();
    }
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).take(MOST).collect()
}
