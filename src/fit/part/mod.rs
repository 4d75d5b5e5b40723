//! Whole parts: from a closed mesh to an ordered tree of added and subtracted leaves.

mod bits;
mod boxes;
mod leaf;
mod model;
mod outline;
mod pool;
mod queries;
mod select;
#[cfg(test)]
mod select_tests;
mod sobol;
