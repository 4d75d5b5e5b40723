//! Meshes of arrays of samples: scans, simulations, any function on a grid.

pub use crate::mesh::{Lattice, LatticeError, Volume, VolumeError, VolumeSettings};
