//! How exactly lengths and blends are measured.

use super::{Length, Node, Solid, blend, length};
use crate::{Blend, ParamError};
use rvachev_field::check::{LARGEST_LENGTH, SMALLEST_LENGTH};

impl Solid {
    /// The same solid, its surface measured to `tolerance`: right behind [`offset`](Solid::offset),
    /// [`shell`](Solid::shell), [`rounded`](Solid::rounded), [`filleted`](Solid::filleted), or a
    /// blend by [`Blend::Fillet`] or [`Blend::Chamfer`].
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `tolerance` | length | 10⁻⁹ to 10⁹ |
    ///
    /// The surface of such a solid is measured when the solid is compiled, unless a closed form is
    /// exact. Without this method the tolerance is the power of two at or below a thousandth
    /// of the length, or a millionth of the solid's size where that is more: lengths of about one
    /// size share one surface. A finer tolerance costs more
    /// time and memory, a coarser one less. Where nothing is measured the tolerance has no effect.
    ///
    /// The tolerance is that of one operation: of the offset, not of what it is an offset of. It is
    /// in the units of the solid as it is here: if the solid is scaled afterwards, so is the
    /// tolerance. Of a chamfer, the ball is measured that says where its face ends, without this
    /// method to a thousandth of four legs; the face itself is not.
    ///
    /// # Limits
    ///
    /// Nothing is measured more finely than to 2·10⁻⁷ of the size of the operand, or of how far it
    /// reaches from the origin, nor more finely than the operand itself was.
    /// [`accuracy`](Solid::accuracy) tells what was reached.
    ///
    /// # Errors
    ///
    /// When the solid is first used: [`SolidError::Parameter`](crate::SolidError::Parameter) if the
    /// tolerance is out of its range, or if this method is called on anything else: on a leaf, a
    /// level, a join by an R-function, a blend of another kind, a map, a name or a paint. Call it
    /// first, then move, name or paint the solid.
    ///
    /// ```
    /// use rvachev::{Solid, rad};
    ///
    /// let bar = Solid::cuboid([2.0, 2.0, 4.0]).twist(rad(0.25));
    /// let coarse = bar.offset(0.5).with_tolerance(1e-2);
    /// let fine = bar.offset(0.5).with_tolerance(1e-4);
    /// assert!(coarse.accuracy()?.tolerance <= 1e-2 && fine.accuracy()?.tolerance <= 1e-4);
    ///
    /// let error = bar.with_tolerance(1e-4).bounds().unwrap_err().to_string();
    /// assert!(error.contains("right behind offset, shell, rounded, filleted"), "{error}");
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn with_tolerance(&self, tolerance: f64) -> Solid {
        Solid::from_node(node(self, tolerance))
    }
}

/// A solid measured to a tolerance.
pub(super) fn node(operand: &Solid, tolerance: f64) -> Node {
    let built = match operand.node() {
        // What is wrong is said of the tolerance itself.
        _ if check(operand, tolerance).is_err() => operand.clone(),
        Node::Length { operand: moved, length, .. } => Solid::from_node(length::node(moved, *length, Some(tolerance))),
        Node::Blend { operation, blend, operands, .. } => {
            Solid::from_node(blend::node(*operation, operands.clone(), *blend, Some(tolerance)))
        }
        _ => operand.clone(),
    };
    Node::Toleranced { operand: operand.clone(), tolerance, built }
}

/// Whether an operand can be measured to a tolerance.
pub(crate) fn check(operand: &Solid, tolerance: f64) -> Result<(), ParamError> {
    let is_measured = match operand.node() {
        Node::Length { length, .. } => !matches!(length, Length::Level(_)),
        Node::Blend { blend, .. } => matches!(blend, Blend::Fillet { .. } | Blend::Chamfer { .. }),
        _ => false,
    };
    if is_measured && (SMALLEST_LENGTH..=LARGEST_LENGTH).contains(&tolerance) {
        return Ok(());
    }
    let place = "put it right behind offset, shell, rounded, filleted or a blend by fillet or chamfer";
    let remedy = if is_measured { String::new() } else { format!(", of a length or a blend; {place}") };
    Err(ParamError::new("tolerance", tolerance, format_args!("{SMALLEST_LENGTH:e} to {LARGEST_LENGTH:e}{remedy}")))
}
