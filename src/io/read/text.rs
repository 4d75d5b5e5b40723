//! Words and numbers of a text.

use glam::DVec3;

use super::ReadError;
use super::error::{FilePlace, shown};

/// The words of a text, whatever lines they are on.
pub(super) struct Words<'a> {
    data: &'a [u8],
    at: usize,
    line: u64,
}

impl<'a> Words<'a> {
    /// The words from a byte on, which is on a line of this number.
    pub(super) fn new(data: &'a [u8], at: usize, line: u64) -> Words<'a> {
        Words { data, at, line }
    }

    pub(super) fn place(&self) -> FilePlace {
        FilePlace::Line(self.line)
    }

    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        while let Some(byte) = self.data.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
            // Some programs end lines by \r alone.
            let is_end = *byte == b'\n' || *byte == b'\r' && self.data.get(self.at) != Some(&b'\n');
            self.line += u64::from(is_end);
        }
        let rest = self.data.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += length;
        Some(&rest[..length])
    }

    pub(super) fn skip_line(&mut self) {
        let rest = self.data.get(self.at..).unwrap_or_default();
        self.at += rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
    }

    /// The next word, which must be there.
    pub(super) fn word(&mut self, expected: &str) -> Result<&'a [u8], ReadError> {
        self.next().ok_or_else(|| ReadError::content(self.place(), expected, "the end of the file"))
    }

    /// The next word, which must be this one, in upper or lower case.
    pub(super) fn keyword(&mut self, keyword: &str) -> Result<(), ReadError> {
        let word = self.word(keyword)?;
        if word.eq_ignore_ascii_case(keyword.as_bytes()) {
            return Ok(());
        }
        Err(ReadError::content(self.place(), keyword, shown(word)))
    }

    pub(super) fn number(&mut self, expected: &str) -> Result<f64, ReadError> {
        let word = self.word(expected)?;
        number(word).ok_or_else(|| ReadError::content(self.place(), expected, shown(word)))
    }
}

/// A number, if a word is one; it may be infinite or NaN.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Lines with their numbers, from 1.
pub(super) fn lines(data: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    (1..).zip(data.split(|byte| *byte == b'\n'))
}

/// A position, whose coordinates must fit single precision.
pub(super) fn position(coordinates: [f64; 3], place: impl FnOnce() -> FilePlace) -> Result<DVec3, ReadError> {
    match coordinates.iter().find(|x| !is_coordinate(**x)) {
        None => Ok(DVec3::from_array(coordinates)),
        Some(x) => Err(ReadError::content(place(), expected_coordinate(), format!("{x:?}"))),
    }
}

/// Whether a number is finite in single precision.
pub(super) fn is_coordinate(x: f64) -> bool {
    x.abs() <= f64::from(f32::MAX)
}

pub(super) fn is_position(coordinates: [f64; 3]) -> bool {
    coordinates.iter().all(|x| is_coordinate(*x))
}

/// What a coordinate must be.
pub(super) fn expected_coordinate() -> String {
    format!("a coordinate from {:e} to {:e}", f32::MIN, f32::MAX)
}
