//! How files are read.

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
}
