//! Whole parts: from a closed mesh to an ordered tree of added and subtracted leaves.

mod leaf;
mod outline;
