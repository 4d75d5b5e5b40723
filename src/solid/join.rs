//! Joins: set operations by R-functions. (The operators are in `operators`.)
//!
//! Whatever becomes a solid may stand where a solid is taken: a solid, a reference to one, a
//! leaf.

use super::{Node, Operation, Solid};
use crate::RFunction;

impl Solid {
    fn join(operation: Operation, rule: RFunction, operands: Vec<Solid>) -> Solid {
        Solid::from_node(Node::Join { operation, rule, operands })
    }

    fn join_all<T: Into<Solid>>(
        operation: Operation,
        rule: RFunction,
        first: Option<&Solid>,
        others: impl IntoIterator<Item = T>,
    ) -> Solid {
        let operands = first.cloned().into_iter().chain(others.into_iter().map(Into::into)).collect();
        Solid::join(operation, rule, operands)
    }

    /// What is in either solid, joined by `rule`.
    ///
    #[doc = picture!("union" = "docs/gallery/union.png")]
    ///
    /// ```
    /// use rvachev::{Cylinder, RFunction, Solid};
    ///
    /// let ball = Solid::sphere(1.0);
    /// let pin = ball.union(Cylinder { radius: 0.2, height: 6.0 }, RFunction::MIN_MAX);
    /// let same = ball.union(&Solid::cylinder(0.2, 6.0), RFunction::MIN_MAX);
    /// assert_eq!(pin, same);
    /// ```
    #[must_use]
    pub fn union(&self, other: impl Into<Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::Union, rule, vec![self.clone(), other.into()])
    }

    /// What is in both solids, joined by `rule`.
    ///
    #[doc = picture!("intersection" = "docs/gallery/intersection.png")]
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    ///
    /// let die = Solid::cuboid([2.0, 2.0, 2.0]).intersection(Solid::sphere(1.35), RFunction::MIN_MAX);
    /// assert!(die.contains([0.9, 0.9, 0.0])? && !die.contains([0.9, 0.9, 0.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn intersection(&self, other: impl Into<Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::Intersection, rule, vec![self.clone(), other.into()])
    }

    /// What is in this solid and not in `other`, joined by `rule`.
    ///
    #[doc = picture!("difference" = "docs/gallery/difference.png")]
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    ///
    /// let tube = Solid::cylinder(3.0, 8.0).difference(Solid::cylinder(2.0, 9.0), RFunction::P(4.0));
    /// assert!(tube.contains([2.5, 0.0, 0.0])? && !tube.contains([0.0, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn difference(&self, other: impl Into<Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::Difference, rule, vec![self.clone(), other.into()])
    }

    /// What is in exactly one of the solids, joined by `rule`.
    ///
    #[doc = picture!("symmetric_difference" = "docs/gallery/symmetric_difference.png")]
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    ///
    /// let (left, right) = (Solid::sphere(2.0), Solid::sphere(2.0).translate([2.0, 0.0, 0.0]));
    /// let moons = left.symmetric_difference(right, RFunction::MIN_MAX);
    /// assert!(moons.contains([-1.0, 0.0, 0.0])? && !moons.contains([1.0, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn symmetric_difference(&self, other: impl Into<Solid>, rule: RFunction) -> Solid {
        Solid::join(Operation::SymmetricDifference, rule, vec![self.clone(), other.into()])
    }

    /// Everything outside this solid: the value with the other sign.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// assert_eq!(Solid::sphere(1.0).complement().value([3.0, 0.0, 0.0])?, 2.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn complement(&self) -> Solid {
        Solid::from_node(Node::Complement(self.clone()))
    }

    /// The union of many solids (or references to them, or leaves of one type): a flat node
    /// for rules that associate, a balanced tree for the others. No operand at all is an
    /// error when the solid is compiled.
    ///
    /// ```
    /// use rvachev::{RFunction, Solid};
    ///
    /// let row = (0..10).map(|i| Solid::sphere(0.4).translate([f64::from(i), 0.0, 0.0]));
    /// let row = Solid::union_all(row, RFunction::MIN_MAX);
    /// assert!(row.contains([7.2, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union_all<T: Into<Solid>>(solids: impl IntoIterator<Item = T>, rule: RFunction) -> Solid {
        Solid::join_all(Operation::Union, rule, None, solids)
    }

    /// The intersection of many solids, as [`union_all`](Solid::union_all).
    #[must_use]
    pub fn intersection_all<T: Into<Solid>>(solids: impl IntoIterator<Item = T>, rule: RFunction) -> Solid {
        Solid::join_all(Operation::Intersection, rule, None, solids)
    }

    /// This solid without all of `solids`.
    #[must_use]
    pub fn difference_all<T: Into<Solid>>(&self, solids: impl IntoIterator<Item = T>, rule: RFunction) -> Solid {
        Solid::join_all(Operation::Difference, rule, Some(self), solids)
    }
}

impl From<&Solid> for Solid {
    /// The same solid; a reference count.
    fn from(solid: &Solid) -> Solid {
        solid.clone()
    }
}
