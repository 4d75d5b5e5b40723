//! Solids of profiles, and profiles by a formula.

use super::verb::verbs;
use crate::{Angle, Caps, Extrusion, Helix, Profile, Range, rad};

verbs! {
    /// Extruded straight along z, the edges sharp.
    Sweep extrude {
        /// Length along z, half of it to either side.
        height: f64 = Length, Range::LENGTH, example 4.0;
    } => |profile: Profile| profile.extrude(height);

    /// Extruded along z, twisted and scaled in proportion to the height.
    Sweep extrude_with {
        /// Length along z, half of it to either side.
        height: f64 = Length, Range::LENGTH, example 4.0;
        /// By how much the upper end is turned, from x towards y.
        twist: Angle = Angle, Range::new(-1e7, 1e7), example rad(0.5);
        /// The size of the upper end relative to the lower.
        scale: f64 = None, Range::new(1e-3, 1e3), example 0.75;
        /// How the edges of both end faces are.
        caps: Caps = None, Range::ANY, example Caps::Chamfered(0.125);
    } => |profile: Profile| profile.extrude_with(&Extrusion { height, twist, scale, caps });

    /// Revolved about the z axis, all the way round.
    Sweep revolve {
    } => |profile: Profile| profile.revolve();

    /// Revolved about the z axis by a part of a turn, from the x axis towards y.
    Sweep revolve_by {
        /// By how much.
        angle: Angle = Angle, Range::new(1e-4, 360.0), example rad(2.0);
    } => |profile: Profile| profile.revolve_by(angle);

    /// Swept along a helix about the z axis.
    Sweep sweep_helix {
        /// Distance of the profile's origin from the axis: more than the profile reaches towards it.
        radius: f64 = Length, Range::LENGTH, example 8.0;
        /// Rise in a turn: at least half the profile's height.
        pitch: f64 = Length, Range::LENGTH, example 6.0;
        /// The number of turns.
        turns: f64 = None, Range::new(1e-6, 1e6), example 1.5;
        /// Whether it winds to the left.
        left_handed: bool = None, Range::ANY, example true;
        /// How the edges of the two end faces are.
        ends: Caps = None, Range::ANY, example Caps::Flat;
    } => |profile: Profile| profile.sweep_helix(&Helix { radius, pitch, turns, left_handed, ends });

    /// The unbounded column over a profile.
    Sweep column {
    } => |profile: Profile| profile.column();
}
