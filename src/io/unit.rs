//! Units of length, for the formats that have them.

/// What a length of 1 means, in a file that says so: 3MF names the unit, GLB is in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum LengthUnit {
    /// A thousandth of a millimetre.
    Micron,
    /// A millimetre: the default, as in most programs for printing.
    #[default]
    Millimeter,
    /// Ten millimetres.
    Centimeter,
    /// 25.4 millimetres.
    Inch,
    /// Twelve inches.
    Foot,
    /// A thousand millimetres.
    Meter,
}

impl LengthUnit {
    /// The unit in metres.
    #[must_use]
    pub fn meters(self) -> f64 {
        match self {
            LengthUnit::Micron => 1e-6,
            LengthUnit::Millimeter => 1e-3,
            LengthUnit::Centimeter => 1e-2,
            LengthUnit::Inch => 0.0254,
            LengthUnit::Foot => 0.3048,
            LengthUnit::Meter => 1.0,
        }
    }

    /// All of them.
    #[cfg(feature = "import")]
    pub(super) const ALL: [LengthUnit; 6] = [
        LengthUnit::Micron,
        LengthUnit::Millimeter,
        LengthUnit::Centimeter,
        LengthUnit::Inch,
        LengthUnit::Foot,
        LengthUnit::Meter,
    ];

    #[cfg(any(feature = "threemf", feature = "import"))]
    /// The name that 3MF has for it.
    pub(super) fn name(self) -> &'static str {
        match self {
            LengthUnit::Micron => "micron",
            LengthUnit::Millimeter => "millimeter",
            LengthUnit::Centimeter => "centimeter",
            LengthUnit::Inch => "inch",
            LengthUnit::Foot => "foot",
            LengthUnit::Meter => "meter",
        }
    }
}
