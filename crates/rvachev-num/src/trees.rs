//! Symbols as expression trees of fidget.

use std::cell::RefCell;

use fidget::context::Tree;
use fidget::var::Var;

use super::symbol::{Arena, GUARD, Step, Symbol};

/// The trees of an arena.
pub(super) type Trees = RefCell<Vec<Tree>>;

impl Arena {
    /// A symbol for `tree`.
    pub fn symbol(&self, tree: Tree) -> Symbol<'_> {
        Symbol { arena: self, index: self.keep(tree) }
    }

    /// Writes down a step.
    pub(super) fn write(&self, step: Step) -> usize {
        self.keep(self.made(step))
    }

    fn keep(&self, tree: Tree) -> usize {
        let mut trees = self.0.borrow_mut();
        trees.push(tree);
        trees.len() - 1
    }

    fn tree(&self, index: usize) -> Tree {
        self.0.borrow()[index].clone()
    }

    /// The tree of a step.
    fn made(&self, step: Step) -> Tree {
        let of = |index| self.tree(index);
        match step {
            #[expect(clippy::cast_possible_truncation, reason = "fidget's constants are f32")]
            Step::Constant(c) => Tree::constant(c as f32),
            Step::Neg(x) => -of(x),
            Step::Square(x) => of(x).square(),
            Step::Abs(x) => of(x).abs(),
            Step::Sqrt(x) => of(x).max(GUARD as f32).sqrt(),
            Step::Exp(x) => of(x).exp(),
            Step::Ln(x) => of(x).max(GUARD as f32).ln(),
            Step::Sin(x) => of(x).sin(),
            Step::Cos(x) => of(x).cos(),
            Step::Floor(x) => of(x).floor(),
            Step::Add(x, y) => of(x) + of(y),
            Step::Sub(x, y) => of(x) - of(y),
            Step::Mul(x, y) => of(x) * of(y),
            Step::Div(x, y) => of(x) / of(y),
            Step::Min(x, y) => of(x).min(of(y)),
            Step::Max(x, y) => of(x).max(of(y)),
            Step::Atan2(y, x) => of(y).atan2(of(x)),
            Step::Select(x, [nonneg, neg]) => {
                // compare gives −1, 0 or 1; `and` and `or` choose by whether their left side is 0.
                let holds = of(x).compare(0.0) + 1.0;
                let fails = holds.not();
                holds.and(of(nonneg)).or(fails.and(of(neg)))
            }
            Step::Axis(axis) => <[Tree; 3]>::from(Tree::axes())[axis].clone(),
            Step::Slope(value, axis) => of(value).deriv([Var::X, Var::Y, Var::Z][axis]),
            Step::At(value, [x, y, z]) => of(value).remap_xyz(of(x), of(y), of(z)),
        }
    }
}

impl Symbol<'_> {
    /// The tree that this symbol stands for.
    pub fn tree(self) -> Tree {
        self.arena.tree(self.index)
    }

    /// A symbol for `tree`, in the same arena.
    pub fn of_tree(self, tree: Tree) -> Self {
        self.arena.symbol(tree)
    }
}
