//! The area of a solid: within bounds, or as meshes tell it.

use super::{calibrated, meshed};
use crate::error::MeshingError;
use crate::program::Program;
use crate::{Run, Solid};

/// An area, how far it may be off, and whether that is certain.
pub(super) struct Area {
    pub(super) area: f64,
    pub(super) error: f64,
    pub(super) is_certain: bool,
}

/// The area of a solid to a part of it, as far as that can be told; `volume` is the solid's.
pub(super) fn area(
    solid: &Solid,
    program: &Program,
    volume: f64,
    tolerance: f64,
    run: &Run,
) -> Result<Area, MeshingError> {
    let [to_divide, to_mesh] = run.stages([0.5, 0.5]);
    if let Some([least, most]) = calibrated::area(program, &solid.finite_bounds()?, tolerance, &to_divide)? {
        return Ok(Area { area: least.midpoint(most), error: 0.5 * (most - least), is_certain: true });
    }
    let [area, error] = meshed::area(solid, volume, tolerance, &to_mesh)?;
    Ok(Area { area, error, is_certain: false })
}
