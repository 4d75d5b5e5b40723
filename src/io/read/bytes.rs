//! Bytes of a binary file, one after the other.

use super::ReadError;
use super::error::FilePlace;

/// What is left of some bytes.
pub(super) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(data: &'a [u8], at: usize) -> Bytes<'a> {
        Bytes { data, at }
    }

    pub(super) fn place(&self) -> FilePlace {
        FilePlace::Byte(self.at as u64)
    }

    pub(super) fn left(&self) -> &'a [u8] {
        self.data.get(self.at..).unwrap_or_default()
    }

    /// The next bytes.
    pub(super) fn take(&mut self, count: usize, expected: &str) -> Result<&'a [u8], ReadError> {
        let left = self.left();
        let Some(taken) = left.get(..count) else {
            let found = format!("the end of the file after {} bytes", left.len());
            return Err(ReadError::content(self.place(), format!("{count} bytes of {expected}"), found));
        };
        self.at += count;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self, expected: &str) -> Result<[u8; N], ReadError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, expected)?);
        Ok(array)
    }

    pub(super) fn u32(&mut self, expected: &str) -> Result<u32, ReadError> {
        self.array(expected).map(u32::from_le_bytes)
    }
}
