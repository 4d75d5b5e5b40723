//! Placing by boxes: onto the ground, about the origin, face to face.
//!
//! The box is that of [`Solid::bounds`], asked for when the verb is called. What is wrong with the
//! solid, or that it has no finite box, is said when the result is first used, as everything is.

use glam::{DAffine3, DVec3};

use crate::{Angle, Bounds, Profile, Solid};

/// A face of a box, for [`Solid::aligned`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Face {
    /// Where x is least.
    Left,
    /// Where x is largest.
    Right,
    /// Where y is least.
    Front,
    /// Where y is largest.
    Back,
    /// Where z is least.
    Bottom,
    /// Where z is largest.
    Top,
}

impl Face {
    /// The axis that it is across.
    fn axis(self) -> usize {
        match self {
            Face::Left | Face::Right => 0,
            Face::Front | Face::Back => 1,
            Face::Bottom | Face::Top => 2,
        }
    }

    /// Where it is along that axis.
    fn of(self, bounds: &Bounds) -> f64 {
        match self {
            Face::Left | Face::Front | Face::Bottom => bounds.min[self.axis()],
            Face::Right | Face::Back | Face::Top => bounds.max[self.axis()],
        }
    }
}

impl Solid {
    /// Moved along z so that its box stands on the plane z = 0.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let ball = Solid::sphere(2.0).on_ground();
    /// assert!(ball.contains([0.0, 0.0, 3.9])? && !ball.contains([0.0, 0.0, -0.1])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    ///
    /// # Details
    /// An empty solid stays where it is. One without a lowest point is refused when it is first
    /// used, and so is the result where the solid itself is at fault. The box is
    /// [`bounds`](Solid::bounds): where that is larger than the solid, as behind deformations, the
    /// solid hovers.
    ///
    /// The solid is compiled for its box, which takes long where it is large or has much to
    /// measure. [Prepare](Solid::prepare) it first to do that on a [`Run`](crate::Run) that tells
    /// how far it is and may be cancelled: what is prepared has its box, and moving it takes no
    /// time.
    ///
    /// ```
    /// use rvachev::{Run, Solid, rad};
    ///
    /// let shell = Solid::cuboid([2.0, 2.0, 4.0]).twist(rad(0.25)).shell(0.25);
    /// shell.prepare(&Run { threads: 2, ..Run::default() })?;
    /// assert!(shell.on_ground().bounds()?.min.z.abs() < 1e-9);
    /// # Ok::<(), rvachev::error::PrepareError>(())
    /// ```
    #[must_use]
    pub fn on_ground(&self) -> Solid {
        self.placed("on_ground", |bounds| DVec3::new(0.0, 0.0, -bounds.min.z))
    }

    /// Moved so that the middle of its box is the origin. What is refused, and how long it takes:
    /// see [`on_ground`](Solid::on_ground).
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let brick = Solid::cuboid([4.0, 2.0, 1.0]).translate([7.0, 8.0, 9.0]).centered();
    /// assert!((brick.bounds()?.max.x - 2.0).abs() < 1e-9);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn centered(&self) -> Solid {
        self.placed("centered", |bounds| -bounds.center())
    }

    /// Moved along an axis so that a face of its box lies in the plane of a face of another solid's
    /// box. Both faces are across the same axis: two that are not are refused when the result is
    /// first used, as solids [without a box](Solid::on_ground) are. What is wrong with the other
    /// solid is told as a box that it has not; an empty solid stays empty, whatever it is aligned
    /// with. Both solids are compiled for their boxes: see [`on_ground`](Solid::on_ground).
    ///
    /// ```
    /// use rvachev::{Face, Solid};
    ///
    /// let plate = Solid::cuboid([20.0, 20.0, 4.0]);
    /// // On top of the plate, flush with its right side.
    /// let post = Solid::cylinder(2.0, 10.0).aligned(Face::Bottom, &plate, Face::Top);
    /// let post = post.aligned(Face::Right, &plate, Face::Right);
    /// assert!(post.contains([8.0, 0.0, 11.9])? && !post.contains([8.0, 0.0, 1.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn aligned(&self, face: Face, other: &Solid, other_face: Face) -> Solid {
        let there = match other.bounds() {
            Ok(bounds) if face.axis() == other_face.axis() && !bounds.is_empty() => other_face.of(&bounds),
            _ => f64::NAN,
        };
        self.placed("aligned", |bounds| {
            let mut by = DVec3::ZERO;
            by[face.axis()] = there - face.of(bounds);
            by
        })
    }

    /// Turned by `angle` about the line through `point` along `axis`, which may be of any length
    /// but 0; anticlockwise seen from where it points. About the origin:
    /// [`rotate_about`](Solid::rotate_about).
    ///
    /// ```
    /// use rvachev::{deg, Solid};
    ///
    /// // A flap, opened about its hinge at x = −2.
    /// let flap = Solid::cuboid([4.0, 3.0, 0.2]).rotate_around([-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], deg(-90.0));
    /// assert!(flap.contains([-2.0, 0.0, 3.9])? && !flap.contains([1.0, 0.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_around(&self, point: impl Into<DVec3>, axis: impl Into<DVec3>, angle: impl Into<Angle>) -> Solid {
        let point = point.into();
        self.translate(-point).rotate_about(axis, angle).translate(point)
    }

    /// A grid of copies as [`repeat`](Solid::repeat) makes it, moved so that the solid's own place
    /// is the middle of the grid.
    ///
    /// ```
    /// use rvachev::Solid;
    ///
    /// let holes = Solid::cylinder(1.0, 10.0).repeat_centered([4, 2, 1], [10.0, 20.0, 0.0]);
    /// let plate = Solid::cuboid([50.0, 40.0, 4.0]) - holes;
    /// assert!(!plate.contains([-15.0, -10.0, 0.0])? && !plate.contains([15.0, 10.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat_centered(&self, counts: [u32; 3], spacing: impl Into<DVec3>) -> Solid {
        let spacing = spacing.into();
        // A count of 0 is told by the grid; along an axis of one copy the spacing may be anything.
        let half = counts.map(|count| 0.5 * f64::from(count.saturating_sub(1)));
        let back = [0, 1, 2].map(|axis| if half[axis] == 0.0 { 0.0 } else { -half[axis] * spacing[axis] });
        self.repeat(counts, spacing).affine_as("repeat_centered", DAffine3::from_translation(back.into()))
    }

    /// Moved by what its box tells.
    fn placed(&self, verb: &'static str, by: impl Fn(&Bounds) -> DVec3) -> Solid {
        let by = match self.bounds() {
            // What is wrong with the solid is told when it is compiled; what is empty is anywhere.
            Err(_) => DVec3::ZERO,
            Ok(bounds) if bounds.is_empty() => DVec3::ZERO,
            Ok(bounds) => by(&bounds),
        };
        self.affine_as(verb, DAffine3::from_translation(by))
    }
}

impl Profile {
    /// Extruded along z from the plane z = 0 up to `height`: [`extrude`](Profile::extrude), whose
    /// middle is at z = 0, moved up by half of the height.
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let post = Profile::circle(2.0).extrude_up(10.0);
    /// assert!(post.contains([0.0, 0.0, 9.9])? && !post.contains([0.0, 0.0, -0.1])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn extrude_up(&self, height: f64) -> Solid {
        let up = DAffine3::from_translation(DVec3::Z * (0.5 * height));
        self.extrude(height).affine_as("extrude_up", up)
    }

    /// Moved so that the middle of its box is the origin: [`Solid::centered`].
    #[must_use]
    pub fn centered(&self) -> Profile {
        Profile(self.0.placed("centered", |bounds| -bounds.center().truncate().extend(0.0)))
    }

    /// Moved along y so that its box stands on the line y = 0: [`Solid::on_ground`].
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let disc = Profile::circle(2.0).on_ground();
    /// assert!(disc.contains([0.0, 3.9])? && !disc.contains([0.0, -0.1])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn on_ground(&self) -> Profile {
        Profile(self.0.placed("on_ground", |bounds| DVec3::new(0.0, -bounds.min.y, 0.0)))
    }

    /// Moved along x or y so that a side of its box lies on the line of a side of another profile's
    /// box: [`Solid::aligned`]. A profile has no [`Bottom`](Face::Bottom) and no
    /// [`Top`](Face::Top): they are refused when the result is first used.
    ///
    /// ```
    /// use rvachev::{Face, Profile};
    ///
    /// let plate = Profile::rectangle([20.0, 4.0]);
    /// let tab = Profile::rectangle([3.0, 2.0]).aligned(Face::Front, &plate, Face::Back);
    /// assert!(tab.contains([0.0, 3.9])? && !tab.contains([0.0, 1.9])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn aligned(&self, face: Face, other: &Profile, other_face: Face) -> Profile {
        Profile(self.0.aligned(face, &other.0, other_face))
    }

    /// Turned by `angle` about `point`, anticlockwise: [`Solid::rotate_around`]. About the origin:
    /// [`rotate`](Profile::rotate).
    ///
    /// ```
    /// use rvachev::{deg, Profile};
    ///
    /// let hand = Profile::rectangle([4.0, 1.0]).rotate_around([-2.0, 0.0], deg(90.0));
    /// assert!(hand.contains([-2.0, 3.9])? && !hand.contains([1.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn rotate_around(&self, point: impl Into<glam::DVec2>, angle: impl Into<Angle>) -> Profile {
        let point = point.into();
        self.translate(-point).rotate(angle).translate(point)
    }

    /// A grid of copies about the profile's own place: [`Solid::repeat_centered`].
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let pair = Profile::circle(1.0).repeat_centered([2, 1], [10.0, 0.0]);
    /// assert!(pair.contains([-5.0, 0.0])? && pair.contains([5.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn repeat_centered(&self, counts: [u32; 2], spacing: impl Into<glam::DVec2>) -> Profile {
        let [x, y] = counts;
        Profile(self.0.repeat_centered([x, y, 1], spacing.into().extend(0.0)))
    }
}
