//! Levels, offsets and shells.

use super::{Length, Node, Solid};

impl Solid {
    fn moved(&self, length: Length) -> Solid {
        Solid::from_node(Node::Length { operand: self.clone(), length })
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

    /// The solid with its surface moved outwards by `distance` (inwards if negative).
    ///
    #[doc = picture!("offset" = "docs/gallery/offset.png", "offset_inwards" = "docs/gallery/offset_inwards.png")]
    ///
    /// Leaves below count by true distance: their own where they have it, else the distance
    /// to the nearest surface point found, within 2 % for convex leaves. Of others, and behind
    /// deformations, it is searched from points known beforehand on a net of 30 cells along the
    /// leaf's box: parts that slip through between its nodes are not seen. Joins
    /// below act as min and max, so an offset edge stays sharp inside and is round outside
    /// of each leaf, and values are distances near the surface.
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `distance` | length | ±10⁹; positive grows the solid |
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

    /// The wall of this solid, `thickness` deep, measured inwards from the surface:
    /// `f = min(d, thickness − d)`, d being the distances of [`offset`](Solid::offset).
    ///
    #[doc = picture!("shell" = "docs/gallery/shell.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `thickness` | length | 10⁻⁹ to 10⁹ |
    ///
    /// The thickness is within 2 % of what is asked for on convex leaves, for walls up to a
    /// tenth of the smallest half-size.
    ///
    /// ```
    /// use rvachev::Solid;
    /// use glam::DVec3;
    ///
    /// let hollow = Solid::sphere(1.0).shell(0.1);
    /// assert!(hollow.contains(DVec3::X * 0.95)?);
    /// assert!(!hollow.contains(DVec3::X * 0.85)?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn shell(&self, thickness: f64) -> Solid {
        self.moved(Length::Shell(thickness))
    }
}
