//! A leaf's formula on single numbers, compiled once for each kind of number.
//!
//! A formula is inlined wherever it is asked for a value, and intervals are long to compile. What
//! asks for single values, ranges and slopes asks here; what is done with the answers takes the
//! leaf behind a pointer and is compiled once for all leaves. The methods are a trait's so that the
//! compiler puts each leaf's into the part of the crate that the leaf is in.

use glam::DVec3;

use super::zone::{concave_range, concave_rise, mean_value_range};
use super::{Field, Way, Zone, bits};
use crate::{Dual, Interval, Jet};

/// A leaf by its formula, behind a pointer.
pub trait Outlined {
    /// The formula at a point.
    fn at(&self, p: [f64; 3]) -> f64;
    /// With its derivatives.
    fn dual_at(&self, p: [Dual<f64>; 3]) -> Dual<f64>;
    /// The formula on intervals.
    fn over(&self, p: [Interval; 3]) -> Interval;
    /// With its derivatives.
    fn dual_over(&self, p: [Dual<Interval>; 3]) -> Dual<Interval>;
    /// And with theirs.
    fn jet_over(&self, p: [Jet; 3]) -> Jet;
    /// What the leaf says of its derivatives over a box of its frame.
    fn box_slopes(&self, region: [Interval; 3]) -> [Interval; 3];
    /// Whether it is concave, with slope at most 1.
    fn is_concave(&self) -> bool;
}

impl<F: Field + ?Sized> Outlined for F {
    #[inline(never)]
    fn at(&self, p: [f64; 3]) -> f64 {
        self.eval(p)
    }

    #[inline(never)]
    fn dual_at(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.eval(p)
    }

    #[inline(never)]
    fn over(&self, p: [Interval; 3]) -> Interval {
        self.eval(p)
    }

    #[inline(never)]
    fn dual_over(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        self.eval(p)
    }

    #[inline(never)]
    fn jet_over(&self, p: [Jet; 3]) -> Jet {
        self.eval(p)
    }

    fn box_slopes(&self, region: [Interval; 3]) -> [Interval; 3] {
        Field::slopes(self, region)
    }

    fn is_concave(&self) -> bool {
        Field::convex(self)
    }
}

/// A sound range over a zone, where that of its hull is `coarse`.
pub(super) fn zone_range(leaf: &dyn Outlined, zone: &Zone, coarse: Interval) -> Interval {
    if !leaf.is_concave() {
        // The leaf has said all about a box of its own frame; the hull of a zone at an
        // angle to it holds much else.
        if zone.is_aligned() {
            return coarse;
        }
        let centre = leaf.over(zone.centre.to_array().map(Interval::point));
        return mean_value_range(zone, centre, leaf.box_slopes(zone.hull()), coarse);
    }
    let tangent = leaf.dual_at(Dual::point(zone.centre.to_array()));
    concave_range(zone, tangent.v, DVec3::from_array(tangent.d), coarse, |p| leaf.at(p.to_array()))
}

/// The directions along which the value is found to rise, or to stay, throughout a zone, as bits.
pub(super) fn zone_rises(leaf: &dyn Outlined, zone: &Zone, ways: &[Way]) -> u8 {
    let along = |p: [f64; 3]| leaf.dual_at(Dual::point(p));
    let concave = leaf.is_concave();
    let found = if concave { bits(ways, |way| concave_rise(zone, way, |p| leaf.at(p.to_array()), along)) } else { 0 };
    // Of boxes, seen through no deformation, that says all.
    if found != 0 || concave && zone.slack.length() <= 1e-9 * zone.radius() {
        return found;
    }
    let slopes = leaf.box_slopes(zone.hull());
    bits(ways, |way| way.is_rise(slopes))
}
