//! Whole parts from meshes and scans.

mod regions;
mod samples;
