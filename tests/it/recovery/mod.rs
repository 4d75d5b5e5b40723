//! Solids from points: gates on random clouds, and what every fit must keep.

mod clouds;
mod superellipsoids;
