//! Ranges of parameters.

use std::fmt;

use crate::check::{LARGEST_LENGTH, SMALLEST_LENGTH};

/// The numbers that a parameter may have; of a vector, each of its coordinates.
///
/// ```
/// use rvachev::catalogue;
///
/// let ball = catalogue().iter().find(|entry| entry.name() == "sphere").expect("a sphere");
/// let radius = ball.parameters()[0].range();
/// assert!(radius.contains(2.0) && !radius.contains(0.0));
/// assert_eq!(radius.to_string(), "0.000000001 to 1000000000");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least number.
    pub least: f64,
    /// The largest number, which is allowed.
    pub most: f64,
    /// Whether the least number itself is not allowed.
    pub is_open: bool,
    /// Whether these are limits of the absolute value.
    pub is_signed: bool,
}

impl Range {
    /// Any finite number.
    pub const ANY: Range = Range::new(-f64::MAX, f64::MAX);
    /// A length: 10⁻⁹ to 10⁹.
    pub const LENGTH: Range = Range::new(SMALLEST_LENGTH, LARGEST_LENGTH);
    /// A coordinate: −10⁹ to 10⁹.
    pub const FINITE: Range = Range::new(-LARGEST_LENGTH, LARGEST_LENGTH);

    /// From `least` to `most`, both allowed.
    #[must_use]
    pub const fn new(least: f64, most: f64) -> Range {
        Range { least, most, is_open: false, is_signed: false }
    }

    /// Above `least`, up to `most`.
    #[must_use]
    pub const fn above(least: f64, most: f64) -> Range {
        Range { is_open: true, ..Range::new(least, most) }
    }

    /// Of either sign, its absolute value from `least` to `most`.
    #[must_use]
    pub const fn signed(least: f64, most: f64) -> Range {
        Range { is_signed: true, ..Range::new(least, most) }
    }

    /// Whether a number is in the range; NaN is in none.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        let value = if self.is_signed { value.abs() } else { value };
        (value > self.least || value == self.least && !self.is_open) && value <= self.most
    }
}

impl fmt::Display for Range {
    /// As errors say it: `0.5 to 2`, `above 0, up to 1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Range { least, most, .. } = self;
        if *self == Range::ANY {
            return f.write_str("any number");
        }
        if self.is_signed {
            f.write_str("of either sign, ")?;
        }
        if self.is_open { write!(f, "above {least}, up to {most}") } else { write!(f, "{least} to {most}") }
    }
}
