//! Blended joins.

use super::{Node, Operation, Solid};
use crate::{Blend, RFunction};

impl Solid {
    /// Joined one after the other, or at once: fillets join any number, and a chain of them is one.
    fn blended_all(operation: Operation, operands: impl IntoIterator<Item = Solid>, blend: Blend) -> Solid {
        let mut operands = operands.into_iter();
        let Some(first) = operands.next() else {
            return Solid::from_node(Node::Join { operation, rule: RFunction::MIN_MAX, operands: Vec::new() });
        };
        if !matches!(blend, Blend::Fillet { .. }) {
            return operands.fold(first, |all, next| Solid::from_node(node(operation, vec![all, next], blend, None)));
        }
        let mut all = match first.node() {
            Node::Blend { operation: own, blend: of, operands, .. } if (*own, *of) == (operation, blend) => {
                operands.clone()
            }
            _ => vec![first],
        };
        all.extend(operands);
        Solid::from_node(node(operation, all, blend, None))
    }

    fn blended(&self, operation: Operation, other: impl Into<Solid>, blend: Blend) -> Solid {
        Solid::blended_all(operation, [self.clone(), other.into()], blend)
    }

    /// What is in any of many solids, and what `blend` adds between them: fillets between any two
    /// that are close; other blends join one after the other. No operand at all is an error when
    /// the solid is compiled.
    ///
    #[doc = picture!("fillet_union_all" = "docs/gallery/fillet_union_all.png")]
    ///
    /// ```
    /// use rvachev::{Blend, Solid};
    ///
    /// let plate = Solid::cuboid([60.0, 12.0, 4.0]);
    /// let pins = (0..5).map(|n| Solid::cylinder(2.0, 12.0).translate([f64::from(n) * 12.0 - 24.0, 0.0, 4.0]));
    /// let comb = Solid::union_all_with([plate].into_iter().chain(pins), Blend::Fillet { radius: 1.5 });
    /// assert!(comb.contains([2.2, 0.0, 2.2])? && !comb.contains([3.2, 0.0, 3.2])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union_all_with<T: Into<Solid>>(solids: impl IntoIterator<Item = T>, blend: Blend) -> Solid {
        Solid::blended_all(Operation::Union, solids.into_iter().map(Into::into), blend)
    }

    /// What is in all of many solids, less what `blend` takes off, as
    /// [`union_all_with`](Solid::union_all_with).
    #[must_use]
    pub fn intersection_all_with<T: Into<Solid>>(solids: impl IntoIterator<Item = T>, blend: Blend) -> Solid {
        Solid::blended_all(Operation::Intersection, solids.into_iter().map(Into::into), blend)
    }

    /// This solid without all of `solids`, less what `blend` takes off, as
    /// [`union_all_with`](Solid::union_all_with).
    ///
    #[doc = picture!("fillet_difference_all" = "docs/gallery/fillet_difference_all.png")]
    ///
    /// ```
    /// use rvachev::{Blend, Solid};
    ///
    /// let holes = [-15.0, 0.0, 15.0].map(|x| Solid::cylinder(4.0, 10.0).translate([x, 0.0, 0.0]));
    /// let plate = Solid::cuboid([50.0, 20.0, 6.0]).difference_all_with(holes, Blend::Fillet { radius: 1.0 });
    /// // The rims are round.
    /// assert!(!plate.contains([4.2, 0.0, 2.9])? && plate.contains([4.2, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn difference_all_with<T: Into<Solid>>(&self, solids: impl IntoIterator<Item = T>, blend: Blend) -> Solid {
        let all = [self.clone()].into_iter().chain(solids.into_iter().map(Into::into));
        Solid::blended_all(Operation::Difference, all, blend)
    }

    /// What is in either solid, and what `blend` adds between them. The parameters and their
    /// ranges: [`Blend`]; what fillets and chamfers are:
    /// [`lengths`](crate::lengths#fillets-between-operands).
    ///
    /// ```
    /// use rvachev::{Blend, Solid};
    ///
    /// let plate = Solid::cuboid([20.0, 20.0, 2.0]);
    /// let post = plate.union_with(Solid::cylinder(3.0, 12.0), Blend::Chamfer { leg: 1.0 });
    /// assert!(post.contains([3.2, 0.0, 1.2])? && !post.contains([3.6, 0.0, 1.6])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union_with(&self, other: impl Into<Solid>, blend: Blend) -> Solid {
        self.blended(Operation::Union, other, blend)
    }

    /// What is in both solids, less what `blend` takes off.
    #[must_use]
    pub fn intersection_with(&self, other: impl Into<Solid>, blend: Blend) -> Solid {
        self.blended(Operation::Intersection, other, blend)
    }

    /// What is in this solid and not in `other`, less what `blend` takes off.
    #[must_use]
    pub fn difference_with(&self, other: impl Into<Solid>, blend: Blend) -> Solid {
        self.blended(Operation::Difference, other, blend)
    }

    /// Union with a smooth transition where the operands' values differ by less than `radius`:
    /// [`Blend::Smooth`]. Where faces of the operands are flush it rises above them, by up to a
    /// quarter of the radius; a [`Blend::Fillet`] does not.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let (a, b) = (Solid::sphere(1.0), Solid::sphere(1.0).translate(DVec3::X * 2.2));
    /// let pair = a.smooth_union(&b, 0.5);
    /// // A bridge of material between the two.
    /// assert!(pair.contains(DVec3::X * 1.1)?);
    /// // Far from the other one each is what it was.
    /// assert_eq!(pair.value(DVec3::X * -1.0)?, 0.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn smooth_union(&self, other: impl Into<Solid>, radius: f64) -> Solid {
        self.union_with(other, Blend::Smooth { radius })
    }

    /// Intersection with a smooth transition: [`Blend::Smooth`].
    #[must_use]
    pub fn smooth_intersection(&self, other: impl Into<Solid>, radius: f64) -> Solid {
        self.intersection_with(other, Blend::Smooth { radius })
    }

    /// Difference with a smooth transition: [`Blend::Smooth`].
    #[must_use]
    pub fn smooth_difference(&self, other: impl Into<Solid>, radius: f64) -> Solid {
        self.difference_with(other, Blend::Smooth { radius })
    }
}

/// The ball that holds the face of a chamfer off flush faces has so many legs for a radius.
pub(crate) const BALL_OF_LEGS: f64 = 16.0;

/// A blend of operands, measured to a tolerance if one is given.
pub(super) fn node(operation: Operation, operands: Vec<Solid>, blend: Blend, tolerance: Option<f64>) -> Node {
    let radius = match blend {
        Blend::Fillet { radius } => Some(radius),
        Blend::Chamfer { leg } => Some(BALL_OF_LEGS * leg),
        _ => None,
    };
    // What is no radius is said of the blend.
    let ball = radius.filter(|_| blend.check().is_ok()).map(|radius| {
        let join = Node::Join { operation, rule: RFunction::MIN_MAX, operands: operands.clone() };
        let distance = if operation == Operation::Union { radius } else { -radius };
        super::length::ball(&Solid::from_node(join), distance, tolerance, Some(blend))
    });
    Node::Blend { operation, blend, operands, tolerance, ball }
}

/// The blend of operands, as a solid.
pub(crate) fn blended(operation: Operation, operands: Vec<Solid>, blend: Blend, tolerance: Option<f64>) -> Solid {
    Solid::from_node(node(operation, operands, blend, tolerance))
}

/// What errors call a blended operation.
pub(super) fn name(blend: &Blend, operation: Operation) -> &'static str {
    let names = blend.names();
    match operation {
        Operation::Union => names[0],
        Operation::Intersection | Operation::SymmetricDifference => names[1],
        Operation::Difference => names[2],
    }
}
