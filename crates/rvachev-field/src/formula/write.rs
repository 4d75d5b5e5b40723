//! The operations of a formula as the text of a `.vm` file.

use std::fmt::Write;

use fidget::context::{BinaryOpcode, UnaryOpcode};

use super::Formula;
use super::op::Op;

impl Formula {
    /// The formula as the text of a `.vm` file, negative inside; numbers are exact.
    /// [`from_vm`](Formula::from_vm) makes the same formula of it.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::{Bounds, Formula};
    ///
    /// let bounds = Bounds::new(-DVec3::ONE, DVec3::ONE);
    /// let bowl = Formula::from_vm("x var-x\nxx square x\nhalf const 0.5\nout sub xx half", bounds)?;
    /// assert_eq!(bowl.to_vm(), "_0 var-x\n_1 square _0\n_2 const 0.5\n_3 sub _1 _2\n");
    /// # Ok::<(), rvachev::error::FormulaError>(())
    /// ```
    #[must_use]
    pub fn to_vm(&self) -> String {
        let mut text = String::new();
        for (at, op) in self.0.code.ops().iter().enumerate() {
            // Writing to a string does not fail.
            let _ = match *op {
                Op::Axis(axis) => writeln!(text, "_{at} var-{}", ["x", "y", "z"][usize::from(axis)]),
                Op::Const(c) => writeln!(text, "_{at} const {c:?}"),
                Op::Unary(op, a) => writeln!(text, "_{at} {} _{a}", unary(op)),
                Op::Binary(op, a, b) => writeln!(text, "_{at} {} _{a} _{b}", binary(op)),
            };
        }
        text
    }
}

fn unary(op: UnaryOpcode) -> &'static str {
    use UnaryOpcode as U;
    match op {
        U::Abs => "abs",
        U::Acos => "acos",
        U::Asin => "asin",
        U::Atan => "atan",
        U::Ceil => "ceil",
        U::Cos => "cos",
        U::Exp => "exp",
        U::Floor => "floor",
        U::Ln => "ln",
        U::Neg => "neg",
        U::Not => "not",
        U::Rand => "rand",
        U::Recip => "recip",
        U::Round => "round",
        U::Sin => "sin",
        U::Sqrt => "sqrt",
        U::Square => "square",
        U::Tan => "tan",
    }
}

fn binary(op: BinaryOpcode) -> &'static str {
    use BinaryOpcode as B;
    match op {
        B::Add => "add",
        B::And => "and",
        B::Atan => "atan2",
        B::Compare => "compare",
        B::Div => "div",
        B::Max => "max",
        B::Min => "min",
        B::Mix => "mix",
        B::Mod => "mod",
        B::Mul => "mul",
        B::Or => "or",
        B::Sub => "sub",
    }
}
