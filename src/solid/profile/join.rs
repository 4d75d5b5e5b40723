//! Joins and blends of profiles.

use super::Profile;
use crate::{Blend, RFunction, Solid};

impl Profile {
    /// What is in either profile, joined by `rule`: see [`Solid::union`].
    ///
    /// ```
    /// use rvachev::{Circle, Profile, RFunction};
    ///
    /// let bar = Profile::rectangle([6.0, 1.0]);
    /// let key = bar.union(Circle { radius: 1.0 }, RFunction::MIN_MAX);
    /// assert_eq!(key.value([0.0, 2.0])?, -1.0);
    /// assert_eq!(key, bar.union(&Profile::circle(1.0), RFunction::MIN_MAX));
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union(&self, other: impl Into<Profile>, rule: RFunction) -> Profile {
        Profile(self.0.union(other.into().0, rule))
    }

    /// What is in both profiles, joined by `rule`: see [`Solid::intersection`].
    #[must_use]
    pub fn intersection(&self, other: impl Into<Profile>, rule: RFunction) -> Profile {
        Profile(self.0.intersection(other.into().0, rule))
    }

    /// What is in this profile and not in `other`, joined by `rule`: see [`Solid::difference`].
    #[must_use]
    pub fn difference(&self, other: impl Into<Profile>, rule: RFunction) -> Profile {
        Profile(self.0.difference(other.into().0, rule))
    }

    /// What is in exactly one of the profiles, joined by `rule`: see
    /// [`Solid::symmetric_difference`].
    #[must_use]
    pub fn symmetric_difference(&self, other: impl Into<Profile>, rule: RFunction) -> Profile {
        Profile(self.0.symmetric_difference(other.into().0, rule))
    }

    /// Everything outside this profile: the value with the other sign.
    #[must_use]
    pub fn complement(&self) -> Profile {
        Profile(self.0.complement())
    }

    /// The union of many profiles (or references to them, or leaves of one type): see
    /// [`Solid::union_all`].
    #[must_use]
    pub fn union_all<T: Into<Profile>>(profiles: impl IntoIterator<Item = T>, rule: RFunction) -> Profile {
        Profile(Solid::union_all(columns(profiles), rule))
    }

    /// The intersection of many profiles: see [`Solid::intersection_all`].
    #[must_use]
    pub fn intersection_all<T: Into<Profile>>(profiles: impl IntoIterator<Item = T>, rule: RFunction) -> Profile {
        Profile(Solid::intersection_all(columns(profiles), rule))
    }

    /// This profile without all of `profiles`: see [`Solid::difference_all`].
    #[must_use]
    pub fn difference_all<T: Into<Profile>>(&self, profiles: impl IntoIterator<Item = T>, rule: RFunction) -> Profile {
        Profile(self.0.difference_all(columns(profiles), rule))
    }

    /// What is in either profile, and what `blend` adds between them. The parameters and their
    /// ranges: [`Blend`]. Its edges are the corners of the plane.
    ///
    /// ```
    /// use rvachev::{Blend, Profile};
    ///
    /// let bar = Profile::rectangle([1.0, 9.0]);
    /// let tee = bar.union_with(Profile::rectangle([9.0, 1.0]), Blend::Fillet { radius: 1.0 });
    /// // The circle that rounds the corner off touches both bars at a distance of 1 from it.
    /// assert!((tee.value([1.5, 1.5])? + 1.0).abs() < 1e-9);
    /// assert!(tee.contains([0.75, 0.75])? && !tee.contains([0.85, 0.85])?);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn union_with(&self, other: impl Into<Profile>, blend: Blend) -> Profile {
        Profile(self.0.union_with(other.into().0, blend))
    }

    /// What is in both profiles, less what `blend` takes off.
    #[must_use]
    pub fn intersection_with(&self, other: impl Into<Profile>, blend: Blend) -> Profile {
        Profile(self.0.intersection_with(other.into().0, blend))
    }

    /// What is in this profile and not in `other`, less what `blend` takes off.
    #[must_use]
    pub fn difference_with(&self, other: impl Into<Profile>, blend: Blend) -> Profile {
        Profile(self.0.difference_with(other.into().0, blend))
    }

    /// What is in any of many profiles, and what `blend` adds between them: see
    /// [`Solid::union_all_with`](crate::Solid::union_all_with).
    #[must_use]
    pub fn union_all_with<T: Into<Profile>>(profiles: impl IntoIterator<Item = T>, blend: Blend) -> Profile {
        Profile(Solid::union_all_with(columns(profiles), blend))
    }

    /// What is in all of many profiles, less what `blend` takes off: see
    /// [`Solid::union_all_with`](crate::Solid::union_all_with).
    #[must_use]
    pub fn intersection_all_with<T: Into<Profile>>(profiles: impl IntoIterator<Item = T>, blend: Blend) -> Profile {
        Profile(Solid::intersection_all_with(columns(profiles), blend))
    }

    /// This profile without all of `profiles`, less what `blend` takes off: see
    /// [`Solid::union_all_with`](crate::Solid::union_all_with).
    #[must_use]
    pub fn difference_all_with<T: Into<Profile>>(
        &self,
        profiles: impl IntoIterator<Item = T>,
        blend: Blend,
    ) -> Profile {
        Profile(self.0.difference_all_with(columns(profiles), blend))
    }

    /// Union with a smooth transition where the operands' values differ by less than `radius`:
    /// [`Blend::Smooth`].
    ///
    /// ```
    /// use rvachev::Profile;
    ///
    /// let disc = Profile::circle(1.0);
    /// // Equal values gain a quarter of the radius.
    /// let pair = disc.smooth_union(disc.translate([2.2, 0.0]), 0.5);
    /// assert!((pair.value([1.1, 0.0])? - 0.025).abs() < 1e-12);
    /// # Ok::<(), rvachev::SolidError>(())
    /// ```
    #[must_use]
    pub fn smooth_union(&self, other: impl Into<Profile>, radius: f64) -> Profile {
        self.union_with(other, Blend::Smooth { radius })
    }

    /// Intersection with a smooth transition: [`Blend::Smooth`].
    #[must_use]
    pub fn smooth_intersection(&self, other: impl Into<Profile>, radius: f64) -> Profile {
        self.intersection_with(other, Blend::Smooth { radius })
    }

    /// Difference with a smooth transition: [`Blend::Smooth`].
    #[must_use]
    pub fn smooth_difference(&self, other: impl Into<Profile>, radius: f64) -> Profile {
        self.difference_with(other, Blend::Smooth { radius })
    }
}

/// The columns over profiles.
fn columns<T: Into<Profile>>(profiles: impl IntoIterator<Item = T>) -> impl Iterator<Item = Solid> {
    profiles.into_iter().map(|profile| profile.into().0)
}
