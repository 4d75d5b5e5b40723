//! [`Real`] on expression trees of fidget: running a formula on them writes it down.
//!
//! fidget has no power and its logarithms and roots give NaN ranges and gradients at 0, so
//! they are guarded: `|x|^p = exp(p·ln max(|x|, 10⁻³⁰))`, `√x = √max(x, 10⁻³⁰)`.

use std::cell::RefCell;
use std::f64::consts::{LN_2, LOG2_E};
use std::ops::{Add, Div, Mul, Neg, Sub};

use fidget::context::Tree;
use fidget::var::Var;

use super::{Norm, Real};

/// Where the trees of symbols live; a [`Symbol`] is a handle into it.
#[derive(Default)]
pub struct Arena(RefCell<Vec<Tree>>);

impl Arena {
    /// A symbol for `tree`.
    pub fn symbol(&self, tree: Tree) -> Symbol<'_> {
        let mut trees = self.0.borrow_mut();
        trees.push(tree);
        Symbol { arena: self, index: trees.len() - 1 }
    }

    /// The constant `c`.
    pub fn constant(&self, c: f64) -> Symbol<'_> {
        #[expect(clippy::cast_possible_truncation, reason = "fidget's constants are f32")]
        self.symbol(Tree::constant(c as f32))
    }
}

/// The least argument of a logarithm or root.
const GUARD: f64 = 1e-30;

/// An expression, written down as a fidget tree.
#[derive(Clone, Copy)]
pub struct Symbol<'a> {
    arena: &'a Arena,
    index: usize,
}

impl Symbol<'_> {
    /// The tree that this symbol stands for.
    pub fn tree(self) -> Tree {
        self.arena.0.borrow()[self.index].clone()
    }

    /// A symbol for `tree`, in the same arena.
    pub fn of_tree(self, tree: Tree) -> Self {
        self.make(tree)
    }

    /// A symbol for `tree` beside this one.
    fn make(self, tree: Tree) -> Self {
        self.arena.symbol(tree)
    }

    /// `field` divided by the length of its gradient, at `p`: the distance to first order.
    pub fn over_slope(p: [Self; 3], field: impl FnOnce([Self; 3]) -> Self) -> Self {
        let [x, y, z] = p;
        let axes: [Tree; 3] = Tree::axes().into();
        let value = field(axes.map(|axis| x.make(axis)));
        let slope = [Var::X, Var::Y, Var::Z].map(|axis| x.make(value.tree().deriv(axis)));
        let length = (slope[0].square() + slope[1].square() + slope[2].square()).sqrt();
        let ratio = value / length.max(x.lift(1e-6));
        x.make(ratio.tree().remap_xyz(x.tree(), y.tree(), z.tree()))
    }

    fn ln(self) -> Self {
        self.make(self.tree().max(GUARD as f32).ln())
    }

    fn exp(self) -> Self {
        self.make(self.tree().exp())
    }
}

impl Neg for Symbol<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.make(-self.tree())
    }
}

impl Add for Symbol<'_> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        self.make(self.tree() + o.tree())
    }
}

impl Sub for Symbol<'_> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self.make(self.tree() - o.tree())
    }
}

impl Mul for Symbol<'_> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        self.make(self.tree() * o.tree())
    }
}

impl Div for Symbol<'_> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        self.make(self.tree() / o.tree())
    }
}

impl Add<f64> for Symbol<'_> {
    type Output = Self;
    fn add(self, k: f64) -> Self {
        if k == 0.0 { self } else { self + self.lift(k) }
    }
}

impl Sub<f64> for Symbol<'_> {
    type Output = Self;
    fn sub(self, k: f64) -> Self {
        if k == 0.0 { self } else { self - self.lift(k) }
    }
}

impl Mul<f64> for Symbol<'_> {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        if k == 1.0 { self } else { self * self.lift(k) }
    }
}

impl Real for Symbol<'_> {
    fn lift(self, c: f64) -> Self {
        self.arena.constant(c)
    }

    fn square(self) -> Self {
        self.make(self.tree().square())
    }

    fn abs(self) -> Self {
        self.make(self.tree().abs())
    }

    fn min(self, o: Self) -> Self {
        self.make(self.tree().min(o.tree()))
    }

    fn max(self, o: Self) -> Self {
        self.make(self.tree().max(o.tree()))
    }

    fn sqrt(self) -> Self {
        self.make(self.tree().max(GUARD as f32).sqrt())
    }

    fn exp2(self) -> Self {
        (self * LN_2).exp()
    }

    fn log2(self) -> Self {
        self.ln() * LOG2_E
    }

    fn pow(self, p: f64) -> Self {
        if p == 1.0 {
            self.abs()
        } else if p == 2.0 {
            self.square()
        } else {
            (self.abs().ln() * p).exp()
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.make(self.tree().sin()), self.make(self.tree().cos()))
    }

    fn atan2(self, x: Self) -> Self {
        self.make(self.tree().atan2(x.tree()))
    }

    fn floor(self) -> Self {
        self.make(self.tree().floor())
    }

    fn select(self, nonneg: Self, neg: Self) -> Self {
        // compare gives −1, 0 or 1; `and` and `or` choose by whether their left side is 0.
        let holds = self.tree().compare(0.0) + 1.0;
        let fails = holds.not();
        self.make(holds.and(nonneg.tree()).or(fails.and(neg.tree())))
    }

    fn norm(self, o: Self, norm: Norm) -> Self {
        let (a, b) = (self.abs(), o.abs());
        match norm {
            Norm::Sum => a + b,
            Norm::Max => a.max(b),
            Norm::Euclid => (self.square() + o.square()).sqrt(),
            Norm::P { p, inv } | Norm::Steep { p, inv } => {
                // hi·(1 + (lo/hi)^p)^(1/p): no overflow for any exponent.
                let hi = a.max(b);
                let ratio = a.min(b) / hi.max(hi.lift(GUARD));
                hi * ((ratio.pow(p) + 1.0).ln() * inv).exp()
            }
        }
    }

    fn norm_parts(self, o: Self, norm: Norm) -> (Self, Self, Self) {
        // fidget differentiates its trees itself; here the weights are spelt out.
        let value = self.norm(o, norm);
        let floor = value.max(value.lift(GUARD));
        let one = self.lift(1.0);
        let (da, db) = match norm {
            Norm::Sum => (one, one),
            Norm::Max => {
                let first = (self.abs() - o.abs()).select(one, self.lift(0.0));
                (first, one - first)
            }
            _ => ((self.abs() / floor).pow(norm.p() - 1.0), (o.abs() / floor).pow(norm.p() - 1.0)),
        };
        (value, self.select(da, -da), o.select(db, -db))
    }
}
