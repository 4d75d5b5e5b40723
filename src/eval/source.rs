//! What compiling asks of those who measure distances.
//!
//! A length that its operand's values do not tell is measured from the operand's surface. Finding
//! that surface takes a mesh, and meshes stand above programs: so compiling is given a
//! [`DistanceSource`], and who compiles passes one in.

use std::sync::{Arc, OnceLock};

use super::accuracy::Accuracy;
use super::compile::Compiled;
use super::runs::Runs;
use crate::solid::Operation;
use crate::{Bounds, Cancelled, Solid, SolidError};
use rvachev_field::{AnyField, Patches};
use rvachev_num::Run;

/// Finds the surfaces that lengths are measured from.
pub(crate) trait DistanceSource: Send + Sync {
    /// The surface of a solid, which has been compiled.
    ///
    /// # Errors
    /// That the run was cancelled, or that the solid has no end.
    fn surface(
        &self,
        solid: &Solid,
        programs: &Compiled,
        wanted: &Wanted<'_>,
        run: &Run,
    ) -> Result<Surface, CompileError>;

    /// How far that surface may be off, which is known before it is found.
    fn tolerance(&self, programs: &Compiled, wanted: &Wanted<'_>) -> f64;
}

/// What is asked of a surface.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// About how long the lengths are that are measured from it.
    pub(crate) length: f64,
    /// That which is asked for: lengths are right to a thousandth of it.
    pub(crate) asked: f64,
    /// How far they may be off in all, if the user has said so.
    pub(crate) tolerance: Option<f64>,
    /// Where they are asked for.
    pub(crate) region: &'a Bounds,
    /// Whether patches are looked at one by one, and are to be small: else flat faces are few.
    pub(crate) by_patches: bool,
}

/// Distances are asked up to so many lengths from a region.
const REACH: f64 = 2.0;

/// What is cut off beside a surface is cut off at no less than this part of its size from it.
const BESIDE: f64 = 0.05;

/// How far beyond a region a surface is found for lengths that are asked for in it, of a solid of a
/// size.
pub(super) fn reach(length: f64, size: f64) -> f64 {
    let beside = if size.is_finite() { BESIDE * size } else { 0.0 };
    beside.max(REACH * length)
}

impl<'a> Wanted<'a> {
    /// What a length is measured from.
    pub(crate) fn of(length: f64, tolerance: Option<f64>, region: &'a Bounds) -> Wanted<'a> {
        Wanted { length, asked: length, tolerance, region, by_patches: false }
    }

    /// How far beyond the region a surface is found, of a solid of a size. What is cut out of
    /// something large becomes no more than twice as large by it.
    pub(crate) fn reach(&self, size: f64) -> f64 {
        let twice = self.region.longest_side() / (2.0 * BESIDE);
        reach(self.length, if size.is_finite() { size.min(twice) } else { size })
    }

    /// Where the surface is needed.
    pub(crate) fn near(&self) -> Bounds {
        self.region.inflate(REACH * self.length)
    }
}

/// A surface to measure from.
pub(crate) struct Surface {
    pub(crate) patches: Arc<Patches>,
    /// How far the patches may be off the surface.
    pub(crate) accuracy: Accuracy,
    /// What they were to be within: they are off by more where they are in doubt only.
    pub(crate) tolerance: f64,
    /// Where they may be off by more than that, and by how much; infinitely where they miss
    /// something.
    pub(crate) doubts: Vec<(Bounds, f64)>,
    /// The axis along which it is a cylinder, if it is: the patches are those where its coordinate
    /// is 0.
    pub(crate) flat: Option<usize>,
    runs: OnceLock<Runs>,
}

impl Surface {
    /// One that has nothing in doubt.
    pub(crate) fn new(patches: Arc<Patches>, accuracy: Accuracy, flat: Option<usize>) -> Surface {
        let tolerance = accuracy.tolerance;
        Surface { patches, accuracy, tolerance, doubts: Vec::new(), flat, runs: OnceLock::new() }
    }

    /// With what it was to be within, and where it is in doubt.
    pub(crate) fn in_doubt(self, tolerance: f64, doubts: Vec<(Bounds, f64)>) -> Surface {
        Surface { tolerance, doubts, ..self }
    }

    /// The boxes of its patches, found on first use.
    pub(crate) fn runs(&self) -> &Runs {
        self.runs.get_or_init(|| Runs::new(&self.patches))
    }
}

/// A surface that is kept for all equal solids.
struct KeptSurface {
    tolerance: f64,
    near: Bounds,
    by_patches: bool,
    surface: Arc<Surface>,
}

/// The surface of a solid, which has been compiled. It is found once for all solids that are equal,
/// and for all who ask for the same tolerance in the same place.
pub(crate) fn surface(
    solid: &Solid,
    programs: &Compiled,
    wanted: &Wanted<'_>,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<Arc<Surface>, CompileError> {
    let (tolerance, near) = (source.tolerance(programs, wanted), wanted.near());
    // A finer one would do as well; but what is found is not to hang on what was asked before.
    let by_patches = wanted.by_patches;
    let is_same =
        |kept: &KeptSurface| kept.tolerance == tolerance && kept.near == near && kept.by_patches == by_patches;
    if let Some(kept) = solid.shelf().find(is_same) {
        run.report(1.0);
        return Ok(kept.surface.clone());
    }
    let surface = Arc::new(source.surface(solid, programs, wanted, run)?);
    // Somebody else may have found it meanwhile: then it is one for all.
    if let Some(kept) = solid.shelf().find(is_same) {
        return Ok(kept.surface.clone());
    }
    solid.shelf().keep(Arc::new(KeptSurface { tolerance, near, by_patches, surface: surface.clone() }));
    Ok(surface)
}

/// A distance that was measured, kept with its node.
#[derive(Clone)]
pub(crate) struct Measured {
    /// The signed distance to a surface, in the node's own coordinates: that of a length's operand,
    /// or of where a ball's centre may be.
    pub(crate) field: Arc<dyn AnyField>,
    /// The distances that it is a join of, if it is one.
    pub(crate) parts: Option<Parts>,
    /// How far it may be off.
    pub(crate) accuracy: Accuracy,
    /// Whether nothing is left where the length is taken away.
    pub(crate) is_gone: bool,
    /// For a fillet, the distances to its operands, on the side where the ball is.
    pub(crate) sides: Vec<Arc<dyn AnyField>>,
    /// For a blend, the same of what of its operands is near the joint, if that is less.
    pub(crate) local: Option<Solid>,
}

impl Measured {
    /// The operands that it was measured from.
    pub(super) fn operands<'a>(&'a self, node: &'a Solid) -> &'a [Solid] {
        self.local.as_ref().unwrap_or(node).node().operands()
    }
}

/// A join of distances.
#[derive(Clone)]
pub(crate) struct Parts {
    pub(crate) operation: Operation,
    pub(crate) fields: Arc<[Arc<dyn AnyField>]>,
}

/// Why a solid does not compile.
#[derive(Clone, Debug)]
pub(crate) enum CompileError {
    Solid(SolidError),
    Cancelled(Cancelled),
}

impl From<SolidError> for CompileError {
    fn from(error: SolidError) -> CompileError {
        CompileError::Solid(error)
    }
}

impl From<Cancelled> for CompileError {
    fn from(cancelled: Cancelled) -> CompileError {
        CompileError::Cancelled(cancelled)
    }
}
