//! The laws that are built in, as one type.
//!
//! A taper or a twist by any of them is one deformation, whose kernels are compiled once, and
//! can be read and rebuilt by whoever knows no law's type.

use std::any::Any;
use std::fmt;

use super::{Law, LawTable, LinearLaw, SineWave, SmoothStep};
use crate::{ParamError, Real};

/// A [`Law`] that is built in: what a [`Form`](../form/enum.Form.html) tells of a taper or a twist.
///
/// ```
/// use rvachev::law::{BuiltInLaw, Law, LinearLaw};
/// use rvachev::{Solid, rad};
///
/// let line = LinearLaw { at_zero: 1.0, slope: -0.25 };
/// let law = BuiltInLaw::Linear(line);
/// assert_eq!(law.at(2.0), 0.5);
/// let rod = Solid::cylinder(1.0, 2.0);
/// assert_eq!(rod.twist_by(rad(1.0), law), rod.twist_by(rad(1.0), line));
/// ```
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum BuiltInLaw {
    /// The same value at every height.
    Constant(f64),
    /// A straight line.
    Linear(LinearLaw),
    /// A smooth step.
    SmoothStep(SmoothStep),
    /// A sine wave.
    Wave(SineWave),
    /// Straight lines between points.
    Table(LawTable),
}

impl BuiltInLaw {
    /// A law, if it is one of these.
    #[doc(hidden)]
    #[must_use]
    pub fn of(law: &dyn Any) -> Option<BuiltInLaw> {
        if let Some(law) = law.downcast_ref::<BuiltInLaw>() {
            return Some(law.clone());
        }
        let constant = law.downcast_ref().copied().map(BuiltInLaw::Constant);
        constant
            .or_else(|| law.downcast_ref().copied().map(BuiltInLaw::Linear))
            .or_else(|| law.downcast_ref().copied().map(BuiltInLaw::SmoothStep))
            .or_else(|| law.downcast_ref().copied().map(BuiltInLaw::Wave))
            .or_else(|| law.downcast_ref().cloned().map(BuiltInLaw::Table))
    }
}

impl fmt::Debug for BuiltInLaw {
    /// As the law itself.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuiltInLaw::Constant(value) => value.fmt(f),
            BuiltInLaw::Linear(law) => law.fmt(f),
            BuiltInLaw::SmoothStep(law) => law.fmt(f),
            BuiltInLaw::Wave(law) => law.fmt(f),
            BuiltInLaw::Table(law) => law.fmt(f),
        }
    }
}

impl Law for BuiltInLaw {
    const CONTINUOUS: bool = true;

    #[inline(always)]
    fn at<R: Real>(&self, z: R) -> R {
        match self {
            BuiltInLaw::Constant(value) => value.at(z),
            BuiltInLaw::Linear(law) => law.at(z),
            BuiltInLaw::SmoothStep(law) => law.at(z),
            BuiltInLaw::Wave(law) => law.at(z),
            BuiltInLaw::Table(law) => law.at(z),
        }
    }

    fn check(&self) -> Result<(), ParamError> {
        match self {
            BuiltInLaw::Constant(value) => Law::check(value),
            BuiltInLaw::Linear(law) => law.check(),
            BuiltInLaw::SmoothStep(law) => law.check(),
            BuiltInLaw::Wave(law) => law.check(),
            BuiltInLaw::Table(law) => law.check(),
        }
    }
}
