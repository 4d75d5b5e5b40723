//! The lengths of slices that hold the coordinates and values of the same points.

/// Slices that ought to hold as many numbers as there are points, and do not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} holds {found} numbers, but x {expected}: one for each point is allowed")]
#[non_exhaustive]
pub struct UnequalSlices {
    /// The first slice that is of another length than x.
    pub name: &'static str,
    /// Its length.
    pub found: usize,
    /// The length of x.
    pub expected: usize,
}

impl UnequalSlices {
    pub(super) fn check<const N: usize>(expected: usize, slices: [(&'static str, usize); N]) -> Result<(), Self> {
        match slices.into_iter().find(|&(_, found)| found != expected) {
            Some((name, found)) => Err(UnequalSlices { name, found, expected }),
            None => Ok(()),
        }
    }
}
