//! Profiles as values: names, paint, text, simplification.

use std::fmt;

use super::Profile;
use crate::Paint;

impl Profile {
    /// The same profile, called `name` by errors, by [`owner`](Profile::owner), where it is
    /// written out, and in the solids that are made of it: see
    /// [`Solid::named`](crate::Solid::named).
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let slot = Profile::rectangle([-2.0, 9.0]).named("slot");
    /// let error = (Profile::circle(5.0) - slot).extrude(3.0).bounds().unwrap_err().to_string();
    /// assert!(error.starts_with("extrude / difference[1] / slot: rectangle: size.x is -2"));
    /// ```
    #[must_use]
    pub fn named(&self, name: impl AsRef<str>) -> Profile {
        Profile(self.0.named(name))
    }

    /// The same profile, its border painted: the sides of the solids that are made of it. See
    /// [`Solid::paint`](crate::Solid::paint).
    #[must_use]
    pub fn paint(&self, paint: impl Into<Paint>) -> Profile {
        Profile(self.0.paint(paint))
    }

    /// An equal profile, with the same values everywhere but for rounding, made of at most as
    /// many nodes: see [`Solid::simplified`](crate::Solid::simplified).
    #[must_use]
    pub fn simplified(&self) -> Profile {
        Profile(self.0.simplified())
    }

    /// How many nodes the profile is made of: see [`Solid::node_count`](crate::Solid::node_count).
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.0.node_count()
    }
}

/// The column over the profile as an indented tree, as that of a
/// [solid](crate::Solid#impl-Display-for-Solid): vectors have a z.
///
/// ```
/// use rvachev::Profile;
///
/// let lens = Profile::circle(3.0).named("lens").translate([1.0, 0.0]) & Profile::circle(3.0);
/// assert_eq!(lens.to_string(), "\
/// intersection by P(2.0)
///   translate (1, 0, 0)
///     lens: circle { radius: 3.0 }
///   circle { radius: 3.0 }");
/// ```
impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Profile({:?})", self.0)
    }
}
