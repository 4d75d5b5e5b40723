//! Whole parts: from a closed mesh to an ordered tree of added and subtracted leaves.

mod bits;
mod boxes;
mod candidates;
mod leaf;
mod model;
mod offsets;
mod outline;
mod pool;
mod queries;
mod regions;
mod samples;
mod select;
#[cfg(test)]
mod select_tests;
mod sobol;
