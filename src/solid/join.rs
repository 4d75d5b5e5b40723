//! Joins: set operations by R-functions, as operators and as named methods.

use std::ops::{BitAnd, BitOr, BitXor, Not, Sub};

use super::{Node, Operation, Solid};
use crate::RFunction;

impl Solid {
    fn join(operation: Operation, rule: RFunction, operands: Vec<Solid>) -> Solid {
        Solid::from_node(Node::Join { operation, rule, operands })
    }

    /// What is in either solid, joined by `rule`.
    #[must_use]
    pub fn union(&self, other: &Solid, rule: RFunction) -> Solid {
        Solid::join(Operation::Union, rule, vec![self.clone(), other.clone()])
    }

    /// What is in both solids, joined by `rule`.
    #[must_use]
    pub fn intersection(&self, other: &Solid, rule: RFunction) -> Solid {
        Solid::join(Operation::Intersection, rule, vec![self.clone(), other.clone()])
    }

    /// What is in this solid and not in `other`, joined by `rule`.
    #[must_use]
    pub fn difference(&self, other: &Solid, rule: RFunction) -> Solid {
        Solid::join(Operation::Difference, rule, vec![self.clone(), other.clone()])
    }

    /// What is in exactly one of the solids, joined by `rule`.
    #[must_use]
    pub fn symmetric_difference(&self, other: &Solid, rule: RFunction) -> Solid {
        Solid::join(Operation::SymmetricDifference, rule, vec![self.clone(), other.clone()])
    }

    /// Everything outside this solid.
    #[must_use]
    pub fn complement(&self) -> Solid {
        Solid::from_node(Node::Complement(self.clone()))
    }

    /// The union of many solids: a flat node for rules that associate, a balanced tree for
    /// the others. No operand at all is an error when the solid is compiled.
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    /// use glam::DVec3;
    ///
    /// let row = (0..10).map(|i| Solid::sphere(0.4).translate(DVec3::X * f64::from(i)));
    /// let row = Solid::union_all(row, RFunction::MIN_MAX);
    /// assert!(row.contains(DVec3::new(7.2, 0.0, 0.0))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union_all(solids: impl IntoIterator<Item = Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::Union, rule, solids.into_iter().collect())
    }

    /// The intersection of many solids, as [`union_all`](Solid::union_all).
    #[must_use]
    pub fn intersection_all(solids: impl IntoIterator<Item = Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::Intersection, rule, solids.into_iter().collect())
    }

    /// This solid without all of `solids`.
    #[must_use]
    pub fn difference_all(&self, solids: impl IntoIterator<Item = Solid>, rule: RFunction) -> Solid {
        let operands = std::iter::once(self.clone()).chain(solids).collect();
        Solid::join(Operation::Difference, rule, operands)
    }
}

/// Implements an operator for all four combinations of values and references.
macro_rules! operator {
    ($trait:ident, $method:ident, $named:ident, $doc:literal) => {
        operator!(@ $trait, $method, $named, $doc, Solid, Solid);
        operator!(@ $trait, $method, $named, $doc, Solid, &Solid);
        operator!(@ $trait, $method, $named, $doc, &Solid, Solid);
        operator!(@ $trait, $method, $named, $doc, &Solid, &Solid);
    };
    (@ $trait:ident, $method:ident, $named:ident, $doc:literal, $left:ty, $right:ty) => {
        impl $trait<$right> for $left {
            type Output = Solid;

            #[doc = $doc]
            fn $method(self, other: $right) -> Solid {
                self.$named(&other.clone(), RFunction::default())
            }
        }
    };
}

operator!(BitOr, bitor, union, "Union by R_p, p = 2.");
operator!(BitAnd, bitand, intersection, "Intersection by R_p, p = 2.");
operator!(Sub, sub, difference, "Difference by R_p, p = 2.");
operator!(BitXor, bitxor, symmetric_difference, "Symmetric difference by R_p, p = 2.");

impl Not for Solid {
    type Output = Solid;

    /// Everything outside.
    fn not(self) -> Solid {
        self.complement()
    }
}

impl Not for &Solid {
    type Output = Solid;

    /// Everything outside.
    fn not(self) -> Solid {
        self.complement()
    }
}
