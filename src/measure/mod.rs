//! What is measured of solids.

mod area;
mod bracket;
mod calibrated;
mod clearance;
mod clip;
mod closed;
mod columns;
mod cuts;
mod enclosed;
mod exact;
mod facets;
mod fine;
mod flat;
mod gamma;
mod integral;
mod merged;
mod meshed;
mod moments;
mod pieces;
mod polytope;
mod report;
mod section;
mod solid;
mod thickness;
mod thickness_report;

pub use clearance::Clearance;
pub use report::MeasureReport;
pub use thickness_report::{ThicknessBin, ThicknessReport};
