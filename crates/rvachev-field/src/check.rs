//! Errors of single parameters, and the checks that raise them.

use std::fmt;

use rvachev_num::deg;

use crate::Angle;

/// A parameter out of its range: its name, its value and what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{parameter} is {value}, allowed: {allowed}")]
#[non_exhaustive]
pub struct ParamError {
    /// The parameter's name, as the constructor spells it.
    pub parameter: String,
    /// Its value.
    pub value: f64,
    /// The allowed range, in words.
    pub allowed: String,
}

impl ParamError {
    /// An error of the parameter `parameter`, whose value is `value` and ought to be `allowed`.
    #[must_use]
    pub fn new(parameter: impl fmt::Display, value: f64, allowed: impl fmt::Display) -> ParamError {
        ParamError { parameter: parameter.to_string(), value, allowed: allowed.to_string() }
    }
}

/// Lengths are between these bounds, far inside what the arithmetic can hold.
pub const SMALLEST_LENGTH: f64 = 1e-9;
/// The largest length.
pub const LARGEST_LENGTH: f64 = 1e9;

/// A length: positive, neither NaN nor extreme.
pub fn length(parameter: &str, value: f64) -> Result<(), ParamError> {
    within(parameter, value, SMALLEST_LENGTH, LARGEST_LENGTH)
}

/// Three lengths, named `parameter.x` and so on.
pub fn lengths(parameter: &str, value: glam::DVec3) -> Result<(), ParamError> {
    for (axis, v) in ["x", "y", "z"].into_iter().zip(value.to_array()) {
        length(&format!("{parameter}.{axis}"), v)?;
    }
    Ok(())
}

/// A number in `[lo, hi]`.
pub fn within(parameter: &str, value: f64, lo: f64, hi: f64) -> Result<(), ParamError> {
    if value >= lo && value <= hi {
        Ok(())
    } else {
        Err(ParamError::new(parameter, value, format_args!("{lo} to {hi}")))
    }
}

/// A finite number.
pub fn finite(parameter: &str, value: f64) -> Result<(), ParamError> {
    if value.abs() <= LARGEST_LENGTH {
        Ok(())
    } else {
        Err(ParamError::new(parameter, value, format_args!("{} to {LARGEST_LENGTH}", -LARGEST_LENGTH)))
    }
}

/// An angle from `lo` to `hi` degrees.
pub fn angle(parameter: &str, value: Angle, lo: f64, hi: f64) -> Result<(), ParamError> {
    if value >= deg(lo) && value <= deg(hi) {
        Ok(())
    } else {
        Err(ParamError::new(parameter, value.degrees(), format_args!("{lo} to {hi} degrees")))
    }
}

/// A direction: a vector of finite coordinates other than zero, of any length.
pub fn direction(parameter: &str, value: glam::DVec3) -> Result<(), ParamError> {
    if value.is_finite() && value != glam::DVec3::ZERO {
        Ok(())
    } else {
        Err(ParamError::new(parameter, value.length(), "a finite vector other than zero"))
    }
}

/// A point or vector: all of its coordinates are finite.
pub fn point(parameter: &str, value: glam::DVec3) -> Result<(), ParamError> {
    for (axis, v) in ["x", "y", "z"].into_iter().zip(value.to_array()) {
        number(&format!("{parameter}.{axis}"), v)?;
    }
    Ok(())
}

/// A number that is neither NaN nor infinite.
pub fn number(parameter: &str, value: f64) -> Result<(), ParamError> {
    if value.is_finite() { Ok(()) } else { Err(ParamError::new(parameter, value, "finite")) }
}
