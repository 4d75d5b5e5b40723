//! Whole parts from meshes and scans.

mod adjust;
mod axes;
mod columns;
mod corners;
mod coverage;
mod detector;
mod directions;
mod guesses;
mod limits;
mod regions;
#[cfg(test)]
mod regions_tests;
mod samples;
mod seeds;
mod settle;
