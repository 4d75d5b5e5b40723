//! Blended joins.

use super::{Node, Operation, Solid};
use crate::Blend;

impl Solid {
    fn blended(&self, operation: Operation, other: impl Into<Solid>, blend: Blend) -> Solid {
        Solid::from_node(node(operation, [self.clone(), other.into()], blend))
    }

    /// What is in either solid, and what `blend` adds between them. The parameters and their
    /// ranges: [`Blend`].
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

    /// Union with a smooth transition where the operands' values differ by less than
    /// `radius`: [`Blend::Smooth`].
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

/// A blend of two operands.
pub(super) fn node(operation: Operation, operands: [Solid; 2], blend: Blend) -> Node {
    let lengths = match blend {
        Blend::Fillet { .. } => operands.each_ref().map(|solid| solid.offset(0.0)),
        _ => operands.clone(),
    };
    Node::Blend { operation, blend, operands, lengths }
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
