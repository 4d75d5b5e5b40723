//! What can be wrong with a file, and where.

use std::fmt;
use std::io;

use crate::Cancelled;
use crate::error::{MeshError, PointCloudError};

/// Where in a file something is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FilePlace {
    /// A line of a text, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// A byte of a part within an archive.
    Part {
        /// The part's name.
        part: String,
        /// The byte of the unpacked part, counted from 0.
        byte: u64,
    },
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePlace::Line(line) => write!(f, "line {line}"),
            FilePlace::Byte(byte) => write!(f, "byte {byte}"),
            FilePlace::Part { part, byte } => write!(f, "byte {byte} of {part}"),
        }
    }
}

/// Why a mesh or a point cloud cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The bytes do not arrive.
    #[error("cannot be read: {0}")]
    Input(#[from] io::Error),
    /// The file is not what its format allows, or ends too early.
    #[error("{place}: expected {expected}, found {found}")]
    Content {
        /// Where it is wrong.
        place: FilePlace,
        /// What the format wants there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file holds more than the [`LoadSettings`](crate::io::LoadSettings) allow.
    #[error("more than {limit} {what}, allowed: at most LoadSettings::{setting}, which can be raised")]
    Limit {
        /// What there is too much of.
        what: &'static str,
        /// How many are allowed.
        limit: u64,
        /// The setting that says so.
        setting: &'static str,
    },
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The parts of the file do not make a mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The parts of the file do not make a point cloud.
    #[error(transparent)]
    Points(#[from] PointCloudError),
}

impl ReadError {
    pub(super) fn content(place: FilePlace, expected: impl Into<String>, found: impl Into<String>) -> ReadError {
        ReadError::Content { place, expected: expected.into(), found: found.into() }
    }
}

/// What was found, as a message shows it: its beginning, in quotes.
pub(super) fn shown(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(SHOWN)]);
    format!("{text:?}{}", if bytes.len() > SHOWN { " …" } else { "" })
}
