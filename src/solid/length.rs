//! Levels, offsets and shells.

use glam::DAffine3;

use super::{Length, Node, Solid};
use crate::Blend;

impl Solid {
    fn moved(&self, length: Length) -> Solid {
        Solid::from_node(node(self, length, None))
    }

    /// The solid whose value is this one's plus `value` (in length units): what is inside this
    /// solid's level −`value`. A gauge's levels are scaled copies; for a wall of even
    /// thickness see [`offset`](Solid::offset) and [`shell`](Solid::shell).
    ///
    #[doc = picture!("level" = "docs/gallery/level.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `value` | length | ±10⁹ |
    ///
    /// The Lipschitz constant stays; a distance becomes a bound of the distance where corners
    /// are moved.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let ball = Solid::sphere(1.0).level(0.5);
    /// assert_eq!(ball.value(DVec3::X * 2.0)?, -0.5);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn level(&self, value: f64) -> Solid {
        self.moved(Length::Level(value))
    }

    /// The solid with its surface moved outwards by `distance`, or inwards if it is negative: all
    /// points that are deeper inside than −`distance`, by the true distance to the surface.
    ///
    #[doc = picture!("offset" = "docs/gallery/offset.png", "offset_inwards" = "docs/gallery/offset_inwards.png")]
    ///
    /// Outwards, edges become round; inwards, they stay sharp, and what is thinner than twice the
    /// distance is gone. If nothing is left the solid is empty: its [`bounds`](Solid::bounds) are.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `distance` | length | ±10⁹; positive grows the solid |
    ///
    /// # Accuracy
    ///
    /// Exact where the solid's own value is the distance on that side: leaves by distance, outside
    /// of their unions, inside of their intersections, moved and scaled evenly. Of all else the
    /// surface is [measured](crate::lengths#exact-or-measured) when the solid is compiled, to a
    /// thousandth of the distance or a millionth of the solid's size, or to what
    /// [`with_tolerance`](Solid::with_tolerance) says. [`accuracy`](Solid::accuracy) tells what was
    /// reached.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let pill = Solid::cuboid(DVec3::ONE).offset(0.25);
    /// assert!((pill.value(DVec3::new(0.5, 0.0, 0.0))? - 0.25).abs() < 1e-12);
    /// // Around corners the offset is round.
    /// assert!(!pill.contains(DVec3::new(0.7, 0.7, 0.7))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn offset(&self, distance: f64) -> Solid {
        self.moved(Length::Offset(distance))
    }

    /// The wall of this solid, `thickness` deep, measured inwards from the surface by true
    /// distance. Its outer face is the solid's own, exactly.
    ///
    #[doc = picture!("shell" = "docs/gallery/shell.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `thickness` | length | 10⁻⁹ to 10⁹ |
    ///
    /// Accuracy: that of [`offset`](Solid::offset).
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// // Two blocks side by side are one body: no wall between them.
    /// let block = Solid::cuboid([10.0, 10.0, 10.0]);
    /// let body = block.translate([-5.0, 0.0, 0.0]) | block.translate([5.0, 0.0, 0.0]);
    /// let hollow = body.shell(1.0);
    /// assert!(hollow.contains([9.5, 0.0, 0.0])? && !hollow.contains([0.2, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn shell(&self, thickness: f64) -> Solid {
        self.moved(Length::Shell(thickness))
    }

    /// The solid with its convex edges rounded: what balls of this radius fill that are inside of
    /// it (its opening by the ball). What is thinner than the ball is gone, a wall just as thick is
    /// left: where the rounding is measured, its ball is 1.5 thousandths smaller than asked for, or
    /// three quarters of the [tolerance](Solid::with_tolerance) if that is less.
    ///
    #[doc = picture!("rounded" = "docs/gallery/rounded.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `radius` | length | 10⁻⁹ to 10⁹ |
    ///
    /// Faces that the ball touches stay the solid's own, exactly. Of boxes, cylinders, prisms and
    /// [others](crate::lengths#exact-or-measured) it is exact. Accuracy of all else: that of
    /// [`offset`](Solid::offset).
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let die = Solid::cuboid([10.0, 10.0, 10.0]).rounded(2.0);
    /// assert!(die.contains([4.99, 0.0, 0.0])? && die.contains([4.4, 4.4, 0.0])?);
    /// assert!(!die.contains([4.5, 4.5, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rounded(&self, radius: f64) -> Solid {
        self.moved(Length::Rounded(radius))
    }

    /// The solid with its concave edges filled: all that balls of this radius do not reach from
    /// outside (its closing by the ball). Gaps and holes that the ball does not fit into are
    /// filled, one just as wide is left: the ball is as that of [`rounded`](Solid::rounded).
    ///
    #[doc = picture!("filleted" = "docs/gallery/filleted.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `radius` | length | 10⁻⁹ to 10⁹ |
    ///
    /// Faces that the ball touches stay the solid's own, exactly; of a convex solid all do.
    /// Accuracy of all else: that of [`offset`](Solid::offset).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let corner = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]];
    /// let bracket = Profile::polygon(corner).extrude(5.0).filleted(2.0);
    /// assert!(bracket.contains([4.4, 4.4, 0.0])? && !bracket.contains([4.8, 4.8, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn filleted(&self, radius: f64) -> Solid {
        self.moved(Length::Filleted(radius))
    }
}

/// Surfaces that lengths are measured from are off by this part of them at most, if nobody has said how
/// far they may be.
pub(crate) const DEVIATION: f64 = 1e-3;

/// A length of an operand, measured to a tolerance if one is given.
pub(super) fn node(operand: &Solid, length: Length, tolerance: Option<f64>) -> Node {
    let ball = match length {
        // It is said of the length itself.
        _ if length.check().is_err() => None,
        Length::Rounded(radius) => Some(ball(operand, -rolling(operand, radius, tolerance), tolerance, None)),
        Length::Filleted(radius) => Some(ball(operand, rolling(operand, radius, tolerance), tolerance, None)),
        _ => None,
    };
    Node::Length { operand: operand.clone(), length, tolerance, ball, about: None }
}

/// The radius of the ball that rounds a solid: smaller than asked for by half as much again as the
/// solid's surface may be off. Where a wall or a gap is just as wide as the ball, its centre has a thin
/// sheet to roll on, and neither one without an inside nor a torn one. Profiles have their lines and
/// arcs.
fn rolling(operand: &Solid, radius: f64, tolerance: Option<f64>) -> f64 {
    let off = (DEVIATION * radius).min(0.5 * tolerance.unwrap_or(f64::INFINITY));
    if is_column(operand) { radius } else { radius - 1.5 * off }
}

/// Whether all leaves of a solid go on along z, as those of profiles do.
fn is_column(solid: &Solid) -> bool {
    let mut pending = vec![solid];
    while let Some(solid) = pending.pop() {
        match solid.node() {
            Node::Leaf(field) if field.bounds_under(&DAffine3::IDENTITY).size().z.is_finite() => return false,
            node => pending.extend(node.parts()),
        }
    }
    true
}

/// Where the centre of a ball may be that rolls along a solid. It is measured from in its turn:
/// half of the tolerance is for either. That of a blend is told about its joints alone.
pub(super) fn ball(operand: &Solid, distance: f64, tolerance: Option<f64>, about: Option<Blend>) -> Solid {
    let (operand, length, tolerance) = (operand.clone(), Length::Offset(distance), tolerance.map(|all| 0.5 * all));
    Solid::from_node(Node::Length { operand, length, tolerance, ball: None, about })
}
