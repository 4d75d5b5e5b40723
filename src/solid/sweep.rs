//! Solids of profiles: extruded, revolved, swept along a helix.

use std::any::Any;
use std::f64::consts::TAU;

use glam::DVec3;

use super::composed::Sweep;
use super::{Node, Profile, Solid};
use crate::{Angle, ParamError, Polygon, RFunction};
use rvachev_field::{Caps, HelixWarp, Opening, Revolution, Span, Turn, check};

/// A column cut off by a slab.
fn cut(column: &Solid, slab: &Solid) -> Solid {
    // The slab first: it says what is wrong with the parameters.
    slab.intersection(column, RFunction::Distance)
}

/// The same, the edges not sharp; `ball` is the column moved in by their size.
fn rimmed(caps: Caps, ball: &Solid, slab: &Solid) -> Solid {
    let size = caps.size().unwrap_or_default();
    Solid::from_node(Node::Rim { caps, operands: vec![slab.offset(-size), ball.clone()] })
}

/// What a profile is extruded to.
///
#[doc = picture!(
    "extrude" = "docs/gallery/extrude.png",
    "extrude_twisted" = "docs/gallery/extrude_twisted.png",
    "extrude_scaled" = "docs/gallery/extrude_scaled.png",
)]
///
/// The section at the lower end is the profile as it is; towards the upper end it is turned
/// and scaled about the z axis, both in proportion to the height.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `height` | length | 10⁻⁹ to 10⁹: from z = −height/2 to height/2 |
/// | `twist` | [`Angle`] | ±10⁷ degrees: by how much the upper end is turned, from x towards y |
/// | `scale` | none | 0.001 to 1000: the upper end's size relative to the lower |
/// | `caps` | length | how the edges of both end faces are: see [`Caps`]; what does not fit is refused |
///
/// ```
/// use rvachev::{Extrusion, Profile};
///
/// let bit = Profile::regular_polygon(6, 3.0).extrude_with(&Extrusion { scale: 0.5, ..Extrusion::new(20.0) });
/// assert!(bit.contains(glam::DVec3::new(2.5, 0.0, -9.9))?);
/// assert!(!bit.contains(glam::DVec3::new(2.5, 0.0, 9.9))?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Extrusion {
    /// Length along z.
    pub height: f64,
    /// By how much the upper end is turned.
    pub twist: Angle,
    /// The size of the upper end relative to the lower.
    pub scale: f64,
    /// How the edges of the end faces are.
    pub caps: Caps,
}

impl Extrusion {
    /// Straight up, the edges sharp.
    #[must_use]
    pub fn new(height: f64) -> Extrusion {
        Extrusion { height, twist: Angle::ZERO, scale: 1.0, caps: Caps::Flat }
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("height", self.height)?;
        check::angle("twist", self.twist, -1e7, 1e7)?;
        check::within("scale", self.scale, 1e-3, 1e3)?;
        self.caps.check("caps", 0.5 * self.height, "height")
    }
}

/// A helix about the z axis, its middle on the x axis at z = 0.
///
#[doc = picture!(
    "sweep_helix" = "docs/gallery/sweep_helix.png",
    "sweep_helix_left_handed" = "docs/gallery/sweep_helix_left_handed.png",
)]
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `radius` | length | 10⁻⁹ to 10⁹, and more than the profile reaches towards the axis |
/// | `pitch` | length | 10⁻⁹ to 10⁹: rise in a turn; at least half the profile's height |
/// | `turns` | none | 10⁻⁶ to 10⁶: from z = −pitch·turns/2 to pitch·turns/2 |
/// | `ends` | length | how the edges of the two end faces are: see [`Caps`]; what does not fit is refused |
///
/// See [`Profile::sweep_helix`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Helix {
    /// Distance of the profile's origin from the axis.
    pub radius: f64,
    /// Rise in a turn.
    pub pitch: f64,
    /// The number of turns.
    pub turns: f64,
    /// Whether it winds to the left; a common screw's thread winds to the right.
    pub left_handed: bool,
    /// How the edges of the two end faces are.
    pub ends: Caps,
}

impl Helix {
    /// Right-handed, the ends cut flat.
    #[must_use]
    pub fn new(radius: f64, pitch: f64, turns: f64) -> Helix {
        Helix { radius, pitch, turns, left_handed: false, ends: Caps::Flat }
    }

    /// How much longer the helix is than it is high.
    fn stretch(&self) -> f64 {
        (TAU * self.radius / self.pitch).hypot(1.0)
    }

    /// The length of the helix.
    fn length(&self) -> f64 {
        self.pitch * self.turns * self.stretch()
    }

    fn check(&self) -> Result<(), ParamError> {
        check::length("radius", self.radius)?;
        check::length("pitch", self.pitch)?;
        check::within("turns", self.turns, 1e-6, 1e6)?;
        self.ends.check("ends", 0.5 * self.length(), "length of the helix")
    }
}

impl Profile {
    /// Extruded straight along z, from z = −height/2 to height/2, the edges sharp. The value is
    /// the true distance where the profile's is.
    ///
    #[doc = picture!("extrude" = "docs/gallery/extrude.png")]
    ///
    /// ```
    /// use rvachev::Profile;
    /// use glam::{DVec2, DVec3};
    ///
    /// let beam = Profile::rectangle(DVec2::new(4.0, 2.0)).extrude(10.0);
    /// assert_eq!(beam.value(DVec3::new(5.0, 0.0, 9.0))?, -5.0);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn extrude(&self, height: f64) -> Solid {
        self.extrude_with(&Extrusion::new(height))
    }

    /// Extruded along z, twisted, scaled, the edges of the end faces chamfered or rounded. The
    /// parameters and their ranges: [`Extrusion`].
    ///
    #[doc = picture!(
        "extrude_twisted" = "docs/gallery/extrude_twisted.png",
        "extrude_scaled" = "docs/gallery/extrude_scaled.png",
    )]
    ///
    /// Twisted and scaled ones have the profile's value at the pre-image, not rescaled: no
    /// Lipschitz constant is promised. What chamfers and roundings are there: see [`Caps`].
    ///
    /// ```
    /// use rvachev::{deg, Caps, Extrusion, Profile};
    ///
    /// let column = Profile::regular_polygon(6, 3.0).extrude_with(&Extrusion {
    ///     twist: deg(60.0),
    ///     caps: Caps::Rounded(0.3),
    ///     ..Extrusion::new(20.0)
    /// });
    /// assert!(column.contains([2.5, 0.0, 0.0])? && !column.contains([0.0, 0.0, 10.1])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn extrude_with(&self, extrusion: &Extrusion) -> Solid {
        let Extrusion { height, twist, scale, caps } = *extrusion;
        let half_height = 0.5 * height;
        let error = extrusion.check().err();
        let caps = if error.is_some() { Caps::Flat } else { caps };
        let slab = Solid::leaf(Span { verb: "extrude", half_height, error });
        // A taper is 1 in the middle; the lower end is to be the profile.
        let middle = 0.5 * (1.0 + scale);
        let section = if scale == 1.0 { self.clone() } else { self.scale(middle) };
        let shaped = |straight: Solid| {
            let k = (scale - 1.0) / (scale + 1.0);
            let tapered = if scale == 1.0 { straight } else { straight.taper(k, k, height) };
            if twist == Angle::ZERO { tapered } else { tapered.rotate_z(0.5 * twist).twist(twist / height) }
        };
        let sweep = Sweep::Extrude(*extrusion);
        let Some(size) = caps.size() else {
            return sweep.of(self, cut(&shaped(section.0), &slab), None);
        };
        // In the smallest section there is the least room.
        let ball = self.0.offset(-size / scale.min(1.0));
        if scale == 1.0 {
            let built = shaped(rimmed(caps, &ball, &slab));
            return sweep.of(self, built, Some(ball));
        }
        // Each end is cut off where lengths are as many times what they are as the section is at
        // that end.
        let ends = [(-DVec3::Z, 1.0), (DVec3::Z, scale)].map(|(up, end)| {
            let times = middle / end;
            let caps = caps.times(times);
            let ball = section.0.offset(-size * times);
            rimmed(caps, &ball, &Solid::half_space(up, half_height * times)).scale_axes([1.0, 1.0, 1.0 / times])
        });
        sweep.of(self, shaped(Solid::intersection_all(ends, RFunction::MIN_MAX)), Some(ball))
    }

    /// Revolved about the z axis: the profile's x is the distance from the axis and its y
    /// becomes z. The part with x below 0 is left out. Distances stay what they are:
    /// `f(x, y, z) = profile(√(x² + y²), z)`.
    ///
    #[doc = picture!("revolve" = "docs/gallery/revolve.png")]
    ///
    /// A section that is to be solid on the axis is drawn across it, best with its mirror image:
    /// a border on the axis is a border, and leaves a hole without width there.
    ///
    /// Edges of a [`Polygon`] on the axis are no border of the solid; a border of any other
    /// profile on the axis is one, so let those reach across it.
    ///
    /// ```
    /// use rvachev::Profile;
    /// use glam::{DVec2, DVec3};
    ///
    /// let ring = Profile::circle(1.0).translate(DVec2::new(3.0, 0.0)).revolve();
    /// assert_eq!(ring.value(DVec3::new(0.0, 3.0, 0.25))?, 0.75);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn revolve(&self) -> Solid {
        Sweep::Revolve(Angle::FULL_TURN).of(self, self.revolved(), None)
    }

    /// All the way round.
    fn revolved(&self) -> Solid {
        let across = match self.0.node() {
            Node::Leaf(field) => {
                let any: &dyn Any = &**field;
                any.downcast_ref::<Polygon>().and_then(Polygon::across_axis)
            }
            _ => None,
        };
        match across {
            Some(polygon) => Profile::from(polygon).0.warp(Revolution),
            None => self.0.warp(Revolution),
        }
    }

    /// Revolved about the z axis by a part of a turn, from the x axis towards y: the minimum of
    /// the [revolved](Profile::revolve) profile's value and the distance to the faces that cut
    /// it off, 1-Lipschitz if the profile is.
    ///
    #[doc = picture!("revolve_by" = "docs/gallery/revolve_by.png")]
    ///
    /// | parameter | unit | range |
    /// |---|---|---|
    /// | `angle` | [`Angle`] | 10⁻⁴ to 360 degrees |
    ///
    /// ```
    /// use rvachev::{deg, Profile};
    ///
    /// let quarter = Profile::rectangle([2.0, 2.0]).translate([3.0, 0.0]).revolve_by(deg(90.0));
    /// assert!(quarter.contains([2.0, 2.0, 0.0])?);
    /// assert!(!quarter.contains([-2.0, 2.0, 0.0])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn revolve_by(&self, angle: impl Into<Angle>) -> Solid {
        let angle = angle.into();
        if angle == Angle::FULL_TURN {
            return self.revolve();
        }
        let part = Solid::leaf(Opening { angle }).intersection(self.revolved(), RFunction::MIN_MAX);
        Sweep::Revolve(angle).of(self, part, None)
    }

    /// Swept along a helix about the z axis: a thread, a spring.
    ///
    #[doc = picture!(
        "sweep_helix" = "docs/gallery/sweep_helix.png",
        "sweep_helix_left_handed" = "docs/gallery/sweep_helix_left_handed.png",
    )]
    ///
    /// The profile stands in the plane of the axis, as threads are drawn: its x points away
    /// from the axis and is 0 at the helix's radius, its y is along z. The ends are in planes
    /// through the axis. The volume is exactly that of the profile revolved, times the number
    /// of turns, as long as turns do not meet.
    ///
    /// The profile may be higher than the pitch, so that turns run into one another, up to
    /// twice the pitch. Up to half the pitch only the nearest turn is evaluated; beyond, the
    /// turns above and below it as well. The profile is compiled to know its height:
    /// [prepare](Profile::prepare) it first where that takes long.
    ///
    /// The parameters and their ranges: [`Helix`].
    ///
    /// The value is the profile's at the pre-image, not rescaled: it over-estimates distances
    /// by up to `√(1 + (pitch/2πr)²)` at the distance r from the axis.
    ///
    /// ```
    /// use rvachev::{Helix, Profile};
    /// use glam::DVec3;
    ///
    /// let spring = Profile::circle(0.5).sweep_helix(&Helix::new(5.0, 2.0, 4.0));
    /// assert!(spring.contains(DVec3::new(5.0, 0.0, 0.0))?);
    /// assert!(spring.contains(DVec3::new(0.0, 5.0, 0.5))?);
    /// assert!(!spring.contains(DVec3::new(5.0, 0.0, 1.0))?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn sweep_helix(&self, helix: &Helix) -> Solid {
        let Helix { radius, pitch, turns, left_handed, ends } = *helix;
        // Sizes of rounded and chamfered ends are measured along the helix.
        let stretch = if ends == Caps::Flat { 1.0 } else { helix.stretch() };
        let half_height = 0.5 * pitch * turns * stretch;
        let error = helix.check().err();
        let ends = if error.is_some() { Caps::Flat } else { ends };
        let slab = Solid::leaf(Span { verb: "sweep_helix", half_height, error });
        let ball = ends.size().map(|size| self.0.offset(-size));
        let straight = match &ball {
            Some(ball) => rimmed(ends, ball, &slab),
            None => cut(&self.0, &slab),
        };
        // What is wrong with the profile is said when the solid is used.
        let (middle, height) = match self.bounds() {
            Ok(bounds) if bounds.min.is_finite() && bounds.max.is_finite() => {
                (0.5 * (bounds.min.y + bounds.max.y), bounds.max.y - bounds.min.y)
            }
            _ => (0.0, 0.0),
        };
        let seen_from = |turn| straight.warp(HelixWarp::new(radius, pitch, left_handed, middle, stretch, turn));
        let swept = if height <= 0.5 * pitch {
            seen_from(Turn::Nearest)
        } else {
            Solid::union_all([Turn::Nearest, Turn::Above, Turn::Below].map(seen_from), RFunction::MIN_MAX)
        };
        Sweep::Helix(*helix).of(self, swept, ball)
    }
}
