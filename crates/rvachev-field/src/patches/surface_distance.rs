//! Signed distance to a surface as a leaf.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::{Foot, Patches};
use crate::{AnyField, Bounds, Chunk, Dual, Interval, Layer, ParamError, VALUE_LIMIT, Way, Zone, steep_slopes};
use rvachev_num::symbol::Symbol;

/// Nearer than this part of the surface's size, the direction to the foot is rounding, and the
/// gradient is the normal there.
const AT_SURFACE: f64 = 1e-7;

/// The cosine from which on a direction is that of a patch's normal, and its foot is on no crease.
const UPRIGHT: f64 = 0.99;

/// Signed distance to a surface: its size by [`Patches`], its sign by another field.
///
/// ```text
///     value(x) = sign f(x) · |x − y|,     y the nearest point of the patches
/// ```
///
/// Patches and field describe one surface to within an error, so the value jumps by up to twice
/// the error where the field's sign changes, and has slope 1 elsewhere. The gradient is that of the
/// distance that the value stands for: where patches and field do not agree on the side, it is
/// along the patch's normal to the side where the field rises, and not the derivative of the value.
#[derive(Clone, Debug)]
pub struct SurfaceDistance {
    pub(super) patches: Arc<Patches>,
    pub(super) sign: Arc<dyn AnyField>,
    /// The same before it was narrowed.
    pub(super) whole_sign: Arc<dyn AnyField>,
    pub(super) error: f64,
    pub(super) flat: Option<usize>,
    bounds: Bounds,
    /// Where the patches are all of the surface.
    region: Bounds,
    /// The sign, where it is the same all over a zone.
    pub(super) side: Option<f64>,
}

impl SurfaceDistance {
    /// The distance to `patches`, positive where `sign`, a field of the same frame, is.
    ///
    /// `error` says how far the patches may be off the surface; ranges are grown by it. If `flat`
    /// is an axis, the surface is a cylinder along it, the patches are those where its coordinate
    /// is 0, and points are moved there. `bounds` holds the points with a positive sign.
    pub fn new(
        patches: Arc<Patches>,
        sign: Arc<dyn AnyField>,
        error: f64,
        flat: Option<usize>,
        bounds: Bounds,
    ) -> SurfaceDistance {
        let (whole_sign, flat) = (sign.clone(), flat.filter(|axis| *axis < 3));
        SurfaceDistance { patches, sign, whole_sign, error, flat, bounds, region: Bounds::ALL, side: None }
    }

    /// With patches that are all of the surface in a region, and may lack some beyond it: there the
    /// sign may change where no patch is near.
    #[must_use]
    pub fn within(mut self, region: Bounds) -> SurfaceDistance {
        self.region = region;
        if let Some(axis) = self.flat {
            (self.region.min[axis], self.region.max[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        self
    }

    /// The surface.
    pub fn patches(&self) -> &Arc<Patches> {
        &self.patches
    }

    /// How far the patches may be off the surface.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// The nearest point of the surface; of a cylinder, its point where the coordinate along the
    /// axis is that of p.
    pub fn nearest(&self, p: DVec3) -> Option<Foot> {
        let mut foot = self.patches.nearest(self.flattened(p))?;
        if let Some(axis) = self.flat {
            foot.point[axis] = p[axis];
        }
        Some(foot)
    }

    /// The point moved to 0 along the axis of a cylinder.
    pub(super) fn flattened(&self, mut p: DVec3) -> DVec3 {
        if let Some(axis) = self.flat {
            p[axis] = 0.0;
        }
        p
    }

    /// The value at a point with a sign.
    pub(super) fn signed(&self, p: [f64; 3], sign: f64) -> f64 {
        let p = self.flattened(DVec3::from_array(p));
        with_sign(self.patches.distance(p).unwrap_or(VALUE_LIMIT), sign)
    }

    /// The same and the derivatives.
    pub(super) fn signed_with_slope(&self, p: [f64; 3], sign: f64) -> (f64, [f64; 3]) {
        let p = self.flattened(DVec3::from_array(p));
        self.towards(p, self.patches.nearest(p), sign, |away| self.falls(p, away))
    }

    /// The same of a flattened point by its foot, where there is one, and by whether the sign's
    /// field falls in a direction from there, where that is asked for.
    pub(super) fn towards(
        &self,
        p: DVec3,
        foot: Option<Foot>,
        sign: f64,
        falls: impl FnOnce(DVec3) -> bool,
    ) -> (f64, [f64; 3]) {
        let Some(foot) = foot else {
            return (with_sign(VALUE_LIMIT, sign), [0.0; 3]);
        };
        let mut slope = if self.is_at(foot) {
            -foot.normal
        } else {
            let away = (p - foot.point) / foot.distance;
            let is_outside = if self.is_between(away, foot) {
                falls(away)
            } else if sign == 0.0 {
                away.dot(foot.normal) > 0.0
            } else {
                sign < 0.0
            };
            // Positive inside: it rises away from the surface there, and towards it outside.
            if is_outside { -away } else { away }
        };
        if let Some(axis) = self.flat {
            slope[axis] = 0.0;
        }
        (with_sign(foot.distance, sign), slope.to_array())
    }

    /// Whether a point is at its foot: the direction from there is rounding.
    fn is_at(&self, foot: Foot) -> bool {
        foot.distance < AT_SURFACE * self.patches.unit()
    }

    /// The directions from their feet of those flattened points of which it is asked whether the
    /// sign's field falls there, and their numbers.
    pub(super) fn doubtful(&self, points: &[(DVec3, Option<Foot>)]) -> Vec<(usize, DVec3)> {
        let away = |(number, (p, foot)): (usize, &(DVec3, Option<Foot>))| {
            let foot = foot.filter(|foot| !self.is_at(*foot))?;
            let away = (*p - foot.point) / foot.distance;
            self.is_between(away, foot).then_some((number, away))
        };
        points.iter().enumerate().filter_map(away).collect()
    }

    /// Whether a point in this direction from its foot may be between the patches and where the
    /// sign changes. There the value falls on the way to the surface, and what it stands for does
    /// not.
    fn is_between(&self, away: DVec3, foot: Foot) -> bool {
        foot.distance < self.error && away.dot(foot.normal).abs() > UPRIGHT
    }

    /// Whether the sign's field falls in a direction.
    fn falls(&self, p: DVec3, direction: DVec3) -> bool {
        let slope = DVec3::from_array(self.sign.dual(Dual::point(p.to_array())).d);
        slope.dot(direction) < 0.0
    }

    /// The sign at a point, as a number that has it.
    pub(super) fn sign(&self, p: [f64; 3]) -> f64 {
        let sign = self.side.unwrap_or_else(|| self.sign.value(p));
        if sign == 0.0 { self.sign_by_normal(p) } else { sign }
    }

    /// The sign by the normal at the foot. Fields are 0 where parts of a solid meet face to face,
    /// though the surface is elsewhere.
    pub(super) fn sign_by_normal(&self, p: [f64; 3]) -> f64 {
        match self.nearest(DVec3::from_array(p)) {
            Some(foot) if foot.distance > AT_SURFACE * self.patches.unit() => {
                (foot.point - DVec3::from_array(p)).dot(foot.normal)
            }
            _ => 0.0,
        }
    }

    /// How far a range over a zone may be off, given the distance from its centre: rounding, where
    /// no point is as near to the patches as the sign may change.
    pub(super) fn slack(&self, zone: &Zone, distance: f64) -> f64 {
        let rounding = self.rounding(zone, distance);
        let is_apart = distance - self.radius(zone) > self.error + rounding;
        if is_apart { rounding } else { rounding + 2.0 * self.error }
    }

    fn rounding(&self, zone: &Zone, distance: f64) -> f64 {
        2.0 * self.patches.rounding() + 1e-12 * (zone.reach() + distance)
    }

    /// How far points of a zone are from the surface on its centre's side, at least and at most,
    /// where both may be off by a little more than they are; less than nothing on the other side.
    /// Nothing if there is no surface.
    pub(super) fn distances(&self, zone: &Zone, more: f64) -> Option<[f64; 2]> {
        let (bounds, radius) = (self.patches.bounds(), self.radius(zone));
        let size = bounds.size().length();
        // A zone that is larger than the surface is told as much by its box, and from far away all
        // patches are as near as each other.
        if radius > size && !self.patches.is_empty() {
            let (own, farthest) = (self.across(zone).hull(), self.farthest(zone, bounds.center()) + size);
            let gap = |axis: usize| (own[axis].lo() - bounds.max[axis]).max(bounds.min[axis] - own[axis].hi()).max(0.0);
            let slack = self.rounding(zone, farthest) + 2.0 * self.error + more;
            let (apart, far) = (DVec3::new(gap(0), gap(1), gap(2)).length() - slack, farthest + slack);
            return Some([if apart > 0.0 { apart } else { -far }, far]);
        }
        let foot = self.patches.nearest(self.flattened(zone.centre))?;
        let slack = self.slack(zone, foot.distance) + more;
        let within_ball = foot.distance - radius - slack;
        // No point is farther from the surface than from that one point of it.
        let mut far = (foot.distance + radius).min(self.farthest(zone, foot.point));
        let is_flat = zone.is_flat();
        if is_flat {
            far = far.min(self.patches.beside(&self.across(zone)).unwrap_or(far));
        }
        if let Some([low, high]) = self.over_rectangle(zone, foot) {
            return Some([within_ball.max(low - slack), far.min(high) + slack]);
        }
        let is_asked = is_flat || within_ball <= 0.0 && self.side.is_none();
        let apart = if is_asked { self.apart(zone, slack) } else { 0.0 };
        Some([if apart > 0.0 { apart.max(within_ball) } else { within_ball }, far + slack])
    }

    /// How far a point of the surface is from points of a zone at most.
    fn farthest(&self, zone: &Zone, point: DVec3) -> f64 {
        let way = |axis: usize| {
            let side = zone.hull()[axis];
            if self.flat == Some(axis) { 0.0 } else { (side.hi() - point[axis]).max(point[axis] - side.lo()) }
        };
        DVec3::new(way(0), way(1), way(2)).length()
    }

    /// Whether the sign of a zone's points changes at patches only.
    pub(super) fn is_whole(&self, zone: &Zone) -> bool {
        let [low, high] = [Interval::lo, Interval::hi].map(|end| DVec3::from_array(zone.hull().map(end)));
        self.side.is_some() || self.region.contains_bounds(&Bounds::new(low, high).intersection(&self.bounds))
    }

    /// What is certain of the sign over a zone.
    pub(super) fn side(&self, zone: &Zone) -> Interval {
        if let Some(side) = self.side {
            return with_side(side);
        }
        let sign = self.sign.range(zone);
        if sign.lo() >= 0.0 {
            with_side(1.0)
        } else if sign.hi() <= 0.0 {
            with_side(-1.0)
        } else {
            Interval::ALL
        }
    }

    /// How far points of a zone are from its centre, across the axis of a cylinder.
    pub(super) fn radius(&self, zone: &Zone) -> f64 {
        self.across(zone).radius()
    }

    /// A zone moved to 0 along the axis of a cylinder.
    pub(super) fn across(&self, zone: &Zone) -> Zone {
        let Some(axis) = self.flat else { return *zone };
        let mut across = DVec3::ONE;
        across[axis] = 0.0;
        zone.mapped(&DAffine3::from_mat3(DMat3::from_diagonal(across)))
    }

    /// What is left of the distance of a zone from the patches when it may be off by `slack`; 0 if
    /// that is all of it.
    pub(super) fn apart(&self, zone: &Zone, slack: f64) -> f64 {
        self.patches.apart(&self.across(zone), slack).map_or(0.0, |apart| apart - slack)
    }
}

/// All numbers of a sign.
fn with_side(side: f64) -> Interval {
    if side > 0.0 { Interval::new(0.0, f64::INFINITY) } else { Interval::new(f64::NEG_INFINITY, 0.0) }
}

/// A distance on the side that a field's value says; 0 where that is 0.
fn with_sign(distance: f64, sign: f64) -> f64 {
    let distance = distance.min(VALUE_LIMIT);
    if sign > 0.0 {
        distance
    } else if sign < 0.0 {
        -distance
    } else {
        0.0
    }
}

impl AnyField for SurfaceDistance {
    fn name(&self) -> &'static str {
        "distance"
    }

    fn signature(&self) -> String {
        let (count, hash) = (self.patches.len(), self.patches.hash);
        let (sign, side) = (self.sign.signature(), self.side);
        format!(
            "SurfaceDistance({count}, {hash:016x}, {:?}, {:?}, {:?}, {sign}, {side:?})",
            self.error, self.flat, self.region
        )
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        // The surface that is measured from may be off the solid's own.
        self.bounds.inflate(self.error + self.patches.rounding()).transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        self.sign.check()
    }

    /// By single precision: of the coordinates, which the map and the move into the surface's
    /// frame round three times each, and of the way from a patch to the point, some six roundings
    /// of numbers of the size of a patch and of the distance, both at most the reach and twice the
    /// surface's size. The sign's own error is no part of it: it counts where the distance is near
    /// 0 only, and there no more than the distance itself.
    fn roundoff(&self, reach: f64) -> f64 {
        5e-7 * (reach + self.patches.unit())
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.signed(p, self.sign(p))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let at = p.map(Dual::value);
        let (value, slope) = self.signed_with_slope(at, self.sign(at));
        let along = |axis: usize| (0..3).map(|i| slope[i] * p[i].d[axis]).sum();
        Dual::new(value, [along(0), along(1), along(2)])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        let zone = Zone::of_sides(p.map(Dual::value));
        let mut across = p;
        if let Some(axis) = self.flat {
            across[axis].d = [Interval::point(0.0); 3];
        }
        Dual::new(self.range(&zone), steep_slopes(1.0, across))
    }

    fn exact(&self) -> bool {
        true
    }

    fn convex(&self) -> bool {
        false
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn growth(&self) -> DVec3 {
        DVec3::ONE
    }

    /// The value at the centre and the farthest that a point may be from there, on the side that
    /// the sign field is certain of.
    fn range(&self, zone: &Zone) -> Interval {
        if !zone.is_finite() {
            return self.side(zone);
        }
        let at = zone.centre.to_array();
        let Some([near, far]) = self.distances(zone, 0.0) else { return Interval::point(self.value(at)) };
        let (range, sign) = (Interval::new(near, far.max(near)), self.sign(at));
        if !self.is_whole(zone) {
            let side = self.side(zone);
            return match [side.lo() >= 0.0, side.hi() <= 0.0] {
                [true, _] if near > 0.0 => range,
                [_, true] if near > 0.0 => -range,
                _ => range.hull(-range).narrowed_by(side),
            };
        }
        let range = if sign < 0.0 { -range } else { range };
        // Where the surface is out of reach, so is a change of the sign.
        if range.lo() > 0.0 || range.hi() < 0.0 { range } else { range.narrowed_by(self.side(zone)) }
    }

    fn rises(&self, zone: &Zone, ways: &[Way]) -> u8 {
        self.rising(zone, ways, None)
    }

    fn enters(&self, zone: &Zone, ways: &[Way], level: f64) -> u8 {
        self.rising(zone, ways, Some(level))
    }

    fn inward(&self, zone: &Zone) -> Option<DVec3> {
        self.inward_over(zone)
    }

    fn layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        self.level_layers(zone, level)
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        self.narrowed_to(zone).map(|leaf| Arc::new(leaf) as Arc<dyn AnyField>)
    }

    fn axes(&self) -> [bool; 3] {
        let sign = self.sign.axes();
        [0, 1, 2].map(|axis| self.flat != Some(axis) || sign[axis])
    }

    /// To first order: the sign field's value by the length of its gradient. The search does not
    /// fit an expression tree.
    fn symbol<'a>(&self, p: [Symbol<'a>; 3]) -> Symbol<'a> {
        Symbol::over_slope(p, |p| self.sign.symbol(p))
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        self.values32(chunk, f64::INFINITY);
    }

    fn lanes32_within(&self, chunk: Chunk<'_, f32, 1>, band: f64) {
        self.values32(chunk, band);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        self.values64(chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        self.slopes(chunk);
    }

    fn cost(&self) -> usize {
        4
    }
}
