//! How files are read.

use std::io::Read;

use super::ReadError;
use crate::io::LengthUnit;

/// How a mesh or a point cloud is read.
///
/// ```
/// use rvachev::LengthUnit;
/// use rvachev::io::LoadSettings;
///
/// // A drawing in inches, wanted in millimetres.
/// let settings = LoadSettings { file_unit: Some(LengthUnit::Inch), ..LoadSettings::default() };
/// assert_eq!(settings.unit, LengthUnit::Millimeter);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct LoadSettings {
    /// What a length of 1 means in what is read. Default: a millimetre.
    pub unit: LengthUnit,
    /// What a length of 1 means in a file that does not say so: `.stl`, `.obj`, `.ply`, `.xyz`,
    /// `.csv`. Default: `None`, the numbers are taken as they are. `.3mf` and `.glb` have units of
    /// their own.
    pub file_unit: Option<LengthUnit>,
    /// The most triangles that are read. Default: 100 million.
    pub most_triangles: u64,
    /// The most vertices or points that are read. Default: 300 million.
    pub most_points: u64,
    /// The most points that are left out because a coordinate is NaN or infinite, of `.xyz`,
    /// `.csv`, `.ply` and `.obj` without faces; if there are more, the error says how many.
    /// Default: 0.
    pub most_skipped: u64,
    /// The most bytes that are read, those of a file and those that it unpacks to. Default: 8 ·
    /// 10⁹.
    pub most_bytes: u64,
}

impl Default for LoadSettings {
    fn default() -> LoadSettings {
        LoadSettings {
            unit: LengthUnit::default(),
            file_unit: None,
            most_triangles: 100_000_000,
            most_points: 300_000_000,
            most_skipped: 0,
            most_bytes: 8_000_000_000,
        }
    }
}

impl LoadSettings {
    /// By what lengths of a file are multiplied.
    pub(super) fn scale(&self, of_file: Option<LengthUnit>) -> f64 {
        match of_file {
            Some(unit) if unit != self.unit => unit.meters() / self.unit.meters(),
            _ => 1.0,
        }
    }

    /// All bytes, unless these are too many.
    pub(super) fn bytes(&self, input: impl Read) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        // The memory grows with what arrives.
        input.take(self.most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > self.most_bytes {
            return Err(ReadError::Limit { what: "bytes", limit: self.most_bytes, setting: "most_bytes" });
        }
        Ok(bytes)
    }

    /// Whether there may be so many triangles.
    pub(super) fn triangles(&self, count: usize) -> Result<(), ReadError> {
        if count as u64 <= self.most_triangles {
            return Ok(());
        }
        Err(ReadError::Limit { what: "triangles", limit: self.most_triangles, setting: "most_triangles" })
    }

    /// Whether there may be so many vertices; never more than 32 bits count.
    pub(super) fn points(&self, count: usize) -> Result<(), ReadError> {
        let limit = self.most_points.min(u64::from(u32::MAX));
        if count as u64 <= limit {
            return Ok(());
        }
        Err(ReadError::Limit { what: "vertices", limit, setting: "most_points" })
    }
}
