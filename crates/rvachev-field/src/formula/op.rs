//! The operations that formulas are lists of.

use fidget::context::{BinaryOpcode, UnaryOpcode};

/// An operation; operands are named by their position in the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Axis(u8),
    Const(f64),
    Unary(UnaryOpcode, u32),
    Binary(BinaryOpcode, u32, u32),
}
