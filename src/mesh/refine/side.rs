//! Where a block of a level is.

/// Whose a block is: that of a level, one beyond its seam, or one of its inset.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Own,
    Around,
    Within,
}
