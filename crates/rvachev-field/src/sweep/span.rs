//! Span across z: what cuts an extrusion off.

use glam::DVec3;

use super::super::outlined::Outlined;
use super::super::{Field, ParamError};
use crate::{Bounds, Interval, Real};

/// `f = half_height − |z|`, the true distance. It stands for the verb that made it: errors of
/// that verb's parameters are its own.
#[derive(Clone, Debug)]
pub struct Span {
    /// What errors call it: the verb that made it.
    pub verb: &'static str,
    /// Half the height, in length units.
    pub half_height: f64,
    /// What is wrong with the verb's parameters.
    pub error: Option<ParamError>,
}

impl Field for Span {
    fn name(&self) -> &'static str {
        self.verb
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [_, _, z]: [R; 3]) -> R {
        -z.abs() + self.half_height
    }

    fn bounds(&self) -> Bounds {
        let half = DVec3::new(f64::INFINITY, f64::INFINITY, self.half_height);
        Bounds::new(-half, half)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.error.clone().map_or(Ok(()), Err)
    }

    fn convex(&self) -> bool {
        true
    }

    fn exact(&self) -> bool {
        true
    }

    fn eroded(&self, depth: f64) -> Option<Span> {
        let half_height = self.half_height - depth;
        (half_height > 0.0).then(|| Span { half_height, ..self.clone() })
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        self.over(region)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        2e-6 * reach
    }
}
