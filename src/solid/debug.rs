//! `Debug` of a solid: short whatever its size.

use std::fmt;

use super::display::label;
use super::{Node, Solid};

/// How many nodes are written out.
const SHOWN: usize = 24;

impl fmt::Debug for Solid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        enum Item<'a> {
            Open(&'a Solid),
            Text(&'static str),
        }
        let mut left = SHOWN;
        let mut stack = vec![Item::Open(self)];
        while let Some(item) = stack.pop() {
            let solid = match item {
                Item::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Item::Open(solid) => solid,
            };
            if left == 0 {
                f.write_str("…")?;
                continue;
            }
            left -= 1;
            if let Node::Leaf(field) = solid.node() {
                write!(f, "{field:?}")?;
                continue;
            }
            match solid.node() {
                Node::Named { name, .. } => write!(f, "named {name:?} ")?,
                Node::Affine { label, .. } => f.write_str(label)?,
                node => f.write_str(&label(node))?,
            }
            f.write_str("(")?;
            stack.push(Item::Text(")"));
            let operands = solid.node().operands();
            // As many operands as there is room for, and how many there are.
            let shown = operands.len().min(left.max(1));
            if shown < operands.len() {
                write!(f, "{} operands: ", operands.len())?;
                stack.push(Item::Text(", …"));
            }
            for (i, operand) in operands[..shown].iter().enumerate().rev() {
                stack.push(Item::Open(operand));
                if i > 0 {
                    stack.push(Item::Text(", "));
                }
            }
        }
        Ok(())
    }
}
