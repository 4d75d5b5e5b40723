//! Union, and intersection and difference of two convex operands, by passes over a stencil.
//!
//! ```text
//! UNION          z := F(A), F(B), …, the nearest
//! CLASSIFY(z; B) the stencil counts B's front less its back faces up to z: not 0 inside of B
//! INTERSECTION   z := F(A), CLASSIFY(B), keep inside;    z := F(B), CLASSIFY(A), keep inside
//! DIFFERENCE     z := F(A), CLASSIFY(B), keep outside;   z := Bk(B), CLASSIFY(A), keep inside
//! ```
//!
//! F are the nearest front, Bk the nearest back faces; the nearer of the two passes is kept.
//! The paper prints the second pass of the difference as a test for the outside, and leaves
//! out that classifying writes no depth.
//!
//! Exact for two convex operands, with the eye outside. Of a non-convex operand only the first
//! layer is ever kept: what appears behind it is missed. A solid holds the points of its front
//! faces and not those of its back faces.
//!
//! Source: H. S. Kim et al. on superquadrics and the depth buffer; J. Goldfeather, J. P. M.
//! Hultquist and H. Fuchs, *Fast constructive solid geometry display in the pixel-powers
//! graphics system* (1986).

use super::error::RasterError;
use super::expression::{Csg, Op};
use super::layers::{Facing, LayerSource, Tile};
use super::target::Target;

/// What the passes can do.
#[derive(Debug)]
pub(super) enum Passes {
    Union(Vec<u32>),
    Intersection(u32, u32),
    Difference(u32, u32),
}

impl Passes {
    /// The passes for a tree.
    ///
    /// # Errors
    ///
    /// [`RasterError::Tree`] if there are none.
    pub(super) fn new(tree: &Csg) -> Result<Passes, RasterError> {
        match *tree.postfix() {
            [Op::Operand(a), Op::Operand(b), Op::Intersection] => return Ok(Passes::Intersection(a, b)),
            [Op::Operand(a), Op::Operand(b), Op::Difference] => return Ok(Passes::Difference(a, b)),
            _ => {}
        }
        let operands = tree.postfix().iter().filter(|op| **op != Op::Union).map(|op| match op {
            Op::Operand(i) => Some(*i),
            _ => None,
        });
        match operands.collect() {
            Some(all) => Ok(Passes::Union(all)),
            // Long trees would make long messages.
            None if tree.postfix().len() > 20 => {
                Err(RasterError::Tree { tree: format!("a tree of {} operations", tree.postfix().len()) })
            }
            None => Err(RasterError::Tree { tree: tree.to_string() }),
        }
    }

    pub(super) fn tile(&self, operands: &[&dyn LayerSource], tile: &Tile) -> Target {
        let mut target = Target::new();
        // Draws one side of an operand and keeps what is inside of the other, or outside of it.
        let pass = |target: &mut Target, a: u32, facing: Facing, b: u32, inside: bool| {
            target.draw(operands[a as usize], a, Some(facing), tile);
            target.classify(operands[b as usize], tile);
            target.keep(|count| (count != 0) == inside);
        };
        let (a, b, facing, first_inside) = match self {
            Passes::Union(all) => {
                for &a in all {
                    target.draw(operands[a as usize], a, Some(Facing::Front), tile);
                }
                return target;
            }
            Passes::Intersection(a, b) => (*a, *b, Facing::Front, true),
            Passes::Difference(a, b) => (*a, *b, Facing::Back, false),
        };
        pass(&mut target, a, Facing::Front, b, first_inside);
        let mut second = Target::new();
        pass(&mut second, b, facing, a, true);
        target.merge(&second);
        target.stencil = second.stencil;
        target
    }
}
