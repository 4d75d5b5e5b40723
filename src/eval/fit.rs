//! Whether rounded and chamfered edges of end faces fit: some of the section must be further inside
//! than they are wide.

use super::apart::{measured, sign};
use super::compile::kept;
use super::depth::deepest;
use crate::solid::Node;
use crate::{Cancelled, ParamError, Run, Solid};

/// What is wrong with the edges of a swept profile's end faces. The profile has been compiled, and
/// what they leave of it has been measured where its values are no distances.
///
/// # Errors
/// That the run was cancelled.
pub(super) fn fit(solid: &Solid, run: &Run) -> Result<Result<(), ParamError>, Cancelled> {
    let Node::Swept { profile, sweep, ball: Some(ball), .. } = solid.node() else { return Ok(Ok(())) };
    let (name, caps, smallest) = sweep.rim();
    let (Some(size), Some(programs)) = (caps.size(), kept(&profile.0)) else { return Ok(Ok(())) };
    let mut section = programs.bounds();
    (section.min.z, section.max.z) = (0.0, 0.0);
    // A section without end has no largest circle, one that is empty no edge.
    if !section.is_finite() || section.is_empty() {
        return Ok(Ok(()));
    }
    let distance = measured(ball).map_or_else(|| sign(&programs), |measured| measured.field);
    let most = smallest * deepest(&*distance, &section, size / smallest, run)?;
    Ok(if most > size { Ok(()) } else { Err(caps.too_large(name, most)) })
}
