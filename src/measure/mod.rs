//! What is measured of solids.

mod thickness;
mod thickness_report;

pub use thickness_report::{ThicknessBin, ThicknessReport};
