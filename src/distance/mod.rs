//! True distance to the surface of any solid.
//!
//! ```text
//!     program --mesh--> triangles --polish--> vertices on the surface, in double precision
//!                                 --measure-> curved patches, split where they are off the surface
//!             cells that hide something --lines-> sheets thinner than cells
//!                                             |x − y|, y the nearest point of the patches, with the
//!                                             program's sign: a leaf like any other
//! ```
//!
//! What is at a distance from a surface and too thin for cells, as that is where the centre of a
//! ball may be within a wall as thick as the ball, is put together from that surface's patches,
//! moved along their normals and trimmed.
//!
//! In the plane, what polygons are joined of and where it is at a distance is lines and arcs, which
//! are put together without a mesh.
//!
//! A length that its operand's own value does not tell, an offset, the inner face of a shell, the
//! ball of a fillet, is measured from the operand's surface. The surface is found once, when the
//! solid is compiled, and kept for all solids that are equal to the operand.

mod by_faces;
mod chart;
mod column;
mod crease;
mod facets;
mod mend;
mod moved;
mod offset_faces;
mod outline;
mod panes;
mod piece;
mod plots;
mod quilt;
mod seam;
mod sheets;
mod strips;
mod surface;
mod trim;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use self::surface::FromMeshes;
use crate::error::{MeshingError, RenderError};
use crate::eval::{CompileError, Compiled, Surface, Wanted, compile, compile_and_bound, surface};
use crate::{Bounds, Run, Solid, SolidError};

/// The programs of a solid, compiled on first use and kept with it; its box is found when asked
/// for.
pub(crate) fn compiled(solid: &Solid) -> Result<Arc<Compiled>, SolidError> {
    match compile(solid, &FromMeshes, &Run::default()) {
        Ok(programs) => Ok(programs),
        Err(CompileError::Solid(error)) => Err(error),
        Err(CompileError::Cancelled(_)) => unreachable!("nobody has the token"),
    }
}

/// The same and the box on the threads of a run, which may be cancelled.
pub(crate) fn compiled_with(solid: &Solid, run: &Run) -> Result<Arc<Compiled>, CompileError> {
    compile_and_bound(solid, &FromMeshes, run)
}

/// The surface of a bounded solid as patches, found on first use and kept with it.
pub(crate) fn surface_of(solid: &Solid) -> Result<Arc<Surface>, SolidError> {
    match surface_with(solid, &Run::default()) {
        Ok(surface) => Ok(surface),
        Err(CompileError::Solid(error)) => Err(error),
        Err(CompileError::Cancelled(_)) => unreachable!("nobody has the token"),
    }
}

/// The same on the threads of a run, which may be cancelled.
pub(crate) fn surface_with(solid: &Solid, run: &Run) -> Result<Arc<Surface>, CompileError> {
    let [to_compile, run] = &run.stages([0.1, 0.9]);
    let programs = compiled_with(solid, to_compile)?;
    if let Some(surface) = moved::moved(solid, run)? {
        return Ok(surface);
    }
    // Feet are refined on the field itself: a ten thousandth of the solid does.
    let length = 1e-1 * programs.bounds().longest_side();
    let wanted = Wanted { by_patches: true, ..Wanted::of(length, None, &Bounds::ALL) };
    surface(solid, &programs, &wanted, &FromMeshes, run)
}

impl From<CompileError> for MeshingError {
    fn from(error: CompileError) -> MeshingError {
        match error {
            CompileError::Solid(error) => error.into(),
            CompileError::Cancelled(cancelled) => cancelled.into(),
        }
    }
}

impl From<CompileError> for RenderError {
    fn from(error: CompileError) -> RenderError {
        match error {
            CompileError::Solid(error) => error.into(),
            CompileError::Cancelled(cancelled) => cancelled.into(),
        }
    }
}
