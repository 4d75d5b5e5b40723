//! The area of a solid, by meshes of halved cells.

use crate::error::MeshingError;
use crate::{CellSize, MeshSettings, Run, Solid};

/// Cells along the longest side of the first mesh and of the last.
const CELLS: [u32; 2] = [32, 256];

/// The area, and an estimate of how far it may be off; `volume` is the solid's.
///
/// Areas of meshes with sharp features are off by the square of the side of a cell: of a halving
/// three quarters of what the area was off are gone, so that what has changed is more than what is
/// left. Where cells may show a part only, as of walls that are thinner, they are halved as often
/// as they may be; of a solid that they do not show at all nothing is known.
pub(super) fn area(solid: &Solid, volume: f64, tolerance: f64, run: &Run) -> Result<[f64; 2], MeshingError> {
    // Far from the origin single precision does not resolve the cells.
    let solid = &solid.centered();
    let [first, last] = CELLS;
    let mut cells = first;
    let mut before = f64::INFINITY;
    loop {
        let run = Run { progress: None, ..run.clone() };
        let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
        let mesh = solid.mesh_with(&settings, &run)?;
        let area = mesh.area();
        let by_volume = if volume > 0.0 { area * (mesh.volume() / volume - 1.0).abs() } else { 0.0 };
        let error = (area - before).abs().max(by_volume);
        if cells >= last || error <= tolerance * area && mesh.possibly_lost() == 0 {
            let is_shown = area > 0.0 || volume <= 0.0;
            return Ok([area, if is_shown { error } else { f64::INFINITY }]);
        }
        (before, cells) = (area, 2 * cells);
    }
}
