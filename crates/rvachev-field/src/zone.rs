//! The region over which a leaf's range is asked for.
//!
//! A box of the world is, in the frame of a rotated or deformed leaf, no box. A [`Zone`]
//! keeps its shape: centre, three half-axes and a remainder,
//!
//! ```text
//!     { c + A·u + s∘v :  |u|∞ ≤ 1, |v|∞ ≤ 1 }  ∩  hull
//! ```
//!
//! Affine maps carry it exactly; a deformation carries it by the mean-value form, the
//! remainder `s` being the spread of the Jacobian over the zone times the zone's extent, so
//! it shrinks with the square of the zone's size. A segment of a ray is a zone with one
//! half-axis.

use glam::{DAffine3, DMat3, DVec3};

use super::AnyWarp;
use crate::{Bounds, Dual, Interval};

/// Relative rounding error of a handful of operations in `f64`.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A parallelepiped with a remainder, cut by an axis-aligned hull.
#[derive(Clone, Copy, Debug)]
pub struct Zone {
    /// The middle of the parallelepiped.
    pub centre: DVec3,
    /// The half-axes, as columns.
    pub axes: DMat3,
    /// How far off it points may be, along each axis.
    pub slack: DVec3,
    hull: [Interval; 3],
}

impl Zone {
    /// The box `bounds`, which must be finite.
    pub fn of_bounds(bounds: &Bounds) -> Zone {
        Zone::new(bounds.center(), DMat3::from_diagonal(bounds.half_extents()), DVec3::ZERO)
    }

    /// The box with these sides.
    pub fn of_sides(sides: [Interval; 3]) -> Zone {
        let centre = DVec3::from_array(sides.map(Interval::mid));
        let half = DVec3::from_array(sides.map(|side| 0.5 * side.width()));
        let mut zone = Zone::new(centre, DMat3::from_diagonal(half), DVec3::ZERO);
        zone.hull = sides;
        zone
    }

    /// The zone grown by `by` along every axis.
    pub fn inflated(&self, by: f64) -> Zone {
        let mut grown = Zone::new(self.centre, self.axes, self.slack + by);
        for (side, own) in grown.hull.iter_mut().zip(self.hull) {
            *side = side.narrowed_by(own.inflate(by));
        }
        grown
    }

    /// The segment from `a` to `b`.
    pub fn of_segment(a: DVec3, b: DVec3) -> Zone {
        Zone::new(0.5 * (a + b), DMat3::from_cols(0.5 * (b - a), DVec3::ZERO, DVec3::ZERO), DVec3::ZERO)
    }

    /// The parallelepiped about `centre` with these half-axes, as columns.
    pub fn of_frame(centre: DVec3, axes: DMat3) -> Zone {
        Zone::new(centre, axes, DVec3::ZERO)
    }

    fn new(centre: DVec3, axes: DMat3, slack: DVec3) -> Zone {
        let radius = Zone::extent_of(&axes, slack) + ROUNDING * centre.abs();
        let hull = [0, 1, 2].map(|i| Interval::around(centre[i], radius[i]));
        Zone { centre, axes, slack, hull }
    }

    fn extent_of(axes: &DMat3, slack: DVec3) -> DVec3 {
        axes.x_axis.abs() + axes.y_axis.abs() + axes.z_axis.abs() + slack
    }

    /// Half the size along each axis.
    pub fn extent(&self) -> DVec3 {
        Zone::extent_of(&self.axes, self.slack)
    }

    /// No point is farther from the centre than this.
    pub fn radius(&self) -> f64 {
        let [a, b, c] = [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis];
        // The longest of the four diagonals.
        let longest = [a + b + c, a + b - c, a - b + c, b + c - a].map(DVec3::length).into_iter().fold(0.0, f64::max);
        longest + self.slack.length()
    }

    /// An axis-aligned box that holds the zone.
    pub fn hull(&self) -> [Interval; 3] {
        self.hull
    }

    /// The largest coordinate in absolute value.
    pub fn reach(&self) -> f64 {
        self.hull.iter().fold(0.0, |reach, side| reach.max(side.magnitude()))
    }

    /// Whether it is no more than a rectangle.
    pub fn is_flat(&self) -> bool {
        [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis].contains(&DVec3::ZERO)
    }

    /// Whether it fills its hull, as a box (or a rectangle, or a segment) along the axes does.
    pub fn is_aligned(&self) -> bool {
        let size = self.axes.x_axis.abs().max(self.axes.y_axis.abs()).max(self.axes.z_axis.abs()).max_element();
        let along_one = |axis: DVec3| axis.abs().element_sum() - axis.abs().max_element() <= 1e-9 * size;
        along_one(self.axes.x_axis) && along_one(self.axes.y_axis) && along_one(self.axes.z_axis)
    }

    /// Whether every number in it is finite.
    pub fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.axes.is_finite() && self.slack.is_finite()
    }

    /// The zone after an affine map.
    pub fn mapped(&self, map: &DAffine3) -> Zone {
        let m = &map.matrix3;
        if *m == DMat3::IDENTITY {
            if map.translation == DVec3::ZERO {
                return *self;
            }
            // The same as below of what is only moved.
            let rounding = ROUNDING * (self.centre.abs() + self.extent() + map.translation.abs());
            return Zone::new(self.centre + map.translation, self.axes, self.slack + rounding);
        }
        let abs = m.abs();
        let rounding = ROUNDING * (abs * (self.centre.abs() + self.extent()) + map.translation.abs());
        Zone::new(map.transform_point3(self.centre), *m * self.axes, abs * self.slack + rounding)
    }

    /// The zone after a deformation.
    pub fn warped(&self, warp: &dyn AnyWarp) -> Zone {
        self.image(warp).0
    }

    /// The same, and whether the deformation's slopes have bounds in the zone.
    fn image(&self, warp: &dyn AnyWarp) -> (Zone, bool) {
        let image = warp.dual_ranges(Dual::point(self.hull));
        let direct = image.map(Dual::value);
        let centre = DVec3::from_array(warp.point(self.centre.to_array()));
        let mut mid = [[0.0; 3]; 3];
        let mut spread = [[0.0; 3]; 3];
        let mut bounded = centre.is_finite();
        for (row, side) in image.iter().enumerate() {
            for (column, slope) in side.gradient().into_iter().enumerate() {
                mid[row][column] = slope.mid();
                spread[row][column] = 0.5 * slope.width();
                bounded &= slope.magnitude() < 1e6;
            }
        }
        if !bounded {
            // The Jacobian says nothing here (the zone meets a pole of the map): only the
            // direct image is left.
            let box_centre = DVec3::from_array(direct.map(Interval::mid));
            let slack = DVec3::from_array(direct.map(|s| 0.5 * s.width()));
            let mut zone = Zone::new(box_centre, DMat3::ZERO, slack);
            zone.hull = direct;
            return (zone, false);
        }
        let mid = DMat3::from_cols_array_2d(&mid).transpose();
        let spread = DMat3::from_cols_array_2d(&spread).transpose();
        let rounding = ROUNDING * (mid.abs() * (self.centre.abs() + self.extent()) + centre.abs());
        let slack = mid.abs() * self.slack + spread * self.extent() + rounding;
        let mut zone = Zone::new(centre, mid * self.axes, slack);
        for (side, direct) in zone.hull.iter_mut().zip(direct) {
            *side = side.narrowed_by(direct);
        }
        (zone, true)
    }
}

/// A zone, or two of which a point is in one: what a fold makes of a zone that lies across
/// one of its edges.
#[derive(Clone, Copy, Debug)]
pub struct Pieces {
    first: Zone,
    second: Option<Zone>,
}

impl Pieces {
    /// One piece.
    pub fn one(zone: Zone) -> Pieces {
        Pieces { first: zone, second: None }
    }

    /// The pieces after an affine map and a deformation.
    pub fn through(&self, to_local: &DAffine3, warp: &dyn AnyWarp) -> Pieces {
        let first = self.first.mapped(to_local);
        match (self.second, warp.branches(first.hull())) {
            (None, Some((map, other))) => {
                Pieces { first: first.mapped(&map), second: other.map(|other| first.mapped(&other)) }
            }
            (None, None) => {
                let (whole, bounded) = first.image(warp);
                // Where it jumps its slopes have no bound.
                match if bounded { None } else { warp.sheets(first.hull()) } {
                    Some([one, other]) => Pieces { first: first.warped(&*one), second: Some(first.warped(&*other)) },
                    None => Pieces::one(whole),
                }
            }
            (Some(second), _) => {
                let whole = |zone: Zone| match warp.branches(zone.hull()) {
                    Some((map, None)) => zone.mapped(&map),
                    _ => zone.warped(warp),
                };
                Pieces { first: whole(first), second: Some(whole(second.mapped(to_local))) }
            }
        }
    }

    /// The hull of what `range` says of each piece after an affine map.
    pub fn range(&self, to_local: &DAffine3, range: impl Fn(&Zone) -> Interval) -> Interval {
        let first = range(&self.first.mapped(to_local));
        match self.second {
            Some(second) => first.hull(range(&second.mapped(to_local))),
            None => first,
        }
    }

    /// The piece, if it is one.
    pub fn only(&self) -> Option<&Zone> {
        if self.second.is_none() { Some(&self.first) } else { None }
    }

    /// Whether `holds` is true of any piece.
    pub fn any(&self, holds: impl Fn(&Zone) -> bool) -> bool {
        holds(&self.first) || self.second.is_some_and(|second| holds(&second))
    }

    /// Calls `visit` with each piece.
    pub fn each(&self, mut visit: impl FnMut(&Zone)) {
        visit(&self.first);
        if let Some(second) = &self.second {
            visit(second);
        }
    }
}

/// Directions, of any length: all within a ball.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// The middle direction.
    pub middle: DVec3,
    /// How far directions are from the middle one.
    pub sway: f64,
}

impl Way {
    /// What becomes of them by a linear map.
    pub fn mapped(self, map: &DMat3) -> Way {
        let sway = self.sway * largest_stretch(map);
        let middle = *map * self.middle;
        Way { middle, sway: sway + ROUNDING * middle.length() }
    }

    /// The same by a matrix within ranges, given row by row.
    pub fn seen_through(self, rows: [[Interval; 3]; 3]) -> Way {
        let images = rows.map(|[x, y, z]| x * self.middle.x + y * self.middle.y + z * self.middle.z);
        let spread = DVec3::from_array(images.map(|image| 0.5 * image.width())).length();
        let middle = DMat3::from_cols_array_2d(&rows.map(|row| row.map(Interval::mid))).transpose();
        let rest = rows.as_flattened().iter().map(|slope| (0.5 * slope.width()).powi(2)).sum::<f64>().sqrt();
        let steepest = largest_stretch(&middle) + rest;
        Way {
            middle: DVec3::from_array(images.map(Interval::mid)),
            sway: (spread + self.sway * steepest) * (1.0 + 1e-12),
        }
    }

    /// Those of both.
    pub fn hull(self, other: Way) -> Way {
        let middle = 0.5 * (self.middle + other.middle);
        Way { middle, sway: (0.5 * (self.middle - other.middle).length() + self.sway.max(other.sway)) * (1.0 + 1e-12) }
    }

    /// The opposite direction, if `flip`.
    pub fn flip_if(self, flip: bool) -> Way {
        if flip { Way { middle: -self.middle, ..self } } else { self }
    }

    /// Whether a value of these slopes rises along all of them.
    pub fn is_rise(self, slopes: [Interval; 3]) -> bool {
        let [x, y, z] = [0, 1, 2].map(|axis| slopes[axis] * self.middle[axis]);
        (x + y + z).lo() > self.sway * steepest(slopes)
    }
}

/// The directions that something is true of, of up to eight, by their numbers as bits.
pub fn bits(ways: &[Way], is_true: impl Fn(Way) -> bool) -> u8 {
    (0..8).zip(ways).fold(0, |bits, (n, way)| bits | u8::from(is_true(*way)) << n)
}

/// The length of the longest vector within ranges.
pub fn steepest(slopes: [Interval; 3]) -> f64 {
    slopes.map(|slope| slope.magnitude().powi(2)).iter().sum::<f64>().sqrt() * (1.0 + 1e-12)
}

/// A bound of how much a map stretches.
pub fn largest_stretch(map: &DMat3) -> f64 {
    let squares = map.transpose() * *map;
    let rows = [squares.x_axis, squares.y_axis, squares.z_axis].map(|row| row.abs().element_sum());
    rows.into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-12)
}

/// The product of two vectors within ranges.
pub fn dot(a: [Interval; 3], b: [Interval; 3]) -> Interval {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// Range of a function over a zone by the mean-value form: the value at the centre and ranges
/// of the derivatives over the hull, along the zone's own axes.
pub fn mean_value_range(zone: &Zone, centre: Interval, slopes: [Interval; 3], known: Interval) -> Interval {
    let along = |axis: DVec3| {
        let terms = [0, 1, 2].map(|i| slopes[i] * axis[i]);
        (terms[0] + terms[1] + terms[2]).magnitude()
    };
    let axes = along(zone.axes.x_axis) + along(zone.axes.y_axis) + along(zone.axes.z_axis);
    let remainder: f64 = [0, 1, 2].iter().map(|i| slopes[*i].magnitude() * zone.slack[*i]).sum();
    let spread = (axes + remainder) * (1.0 + 1e-14);
    // NaN where a slope is unbounded and its extent 0.
    if spread.is_finite() { known.narrowed_by(centre.inflate(spread)) } else { known }
}

/// Range of a concave function with slope at most 1 over a zone: tangent above, corners below.
///
/// `value` and `gradient` are those at the centre. The least value of a concave function
/// over a parallelepiped is at one of its corners; they are looked at only while the answer
/// is open.
pub(super) fn concave_range(
    zone: &Zone,
    value: f64,
    gradient: DVec3,
    known: Interval,
    mut at: impl FnMut(DVec3) -> f64,
) -> Interval {
    let along = zone.axes.transpose() * gradient;
    let rise = along.abs().element_sum() + gradient.abs().dot(zone.slack);
    let extent = zone.extent();
    let rounding = 1e-14 * ((zone.centre.abs() + extent).element_sum() + value.abs()) + 1e-12 * rise;
    let hi = value + rise + rounding;
    if !hi.is_finite() {
        return known;
    }
    let mut range = known.narrowed_by(Interval::new(value - extent.length() - rounding, hi));
    if range.hi() < 0.0 || value <= 0.0 || range.lo() > 0.0 {
        return range;
    }
    let slip = zone.slack.length() + rounding;
    // First the corner down the slope: where it is outside, nothing more can be learnt.
    let down = DVec3::from_array(along.to_array().map(|a| if a > 0.0 { -1.0 } else { 1.0 }));
    let mut lowest = at(zone.centre + zone.axes * down);
    if lowest - slip <= 0.0 {
        return range;
    }
    for corner in 0..8u32 {
        let sign = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let u = DVec3::new(sign(0), sign(1), sign(2));
        if u != down {
            lowest = lowest.min(at(zone.centre + zone.axes * u));
        }
    }
    range = range.narrowed_by(Interval::new(lowest - slip, f64::INFINITY));
    range
}

/// Whether a concave function with slope at most 1 rises throughout a zone along all these
/// directions.
///
/// ```text
///       .-------.        Along w a concave function rises at x if it is larger at any point beyond: first far
///      (   x · · ·       beyond, where it may be larger than anywhere in the zone; then near, where it is least
///     --+--x----'        above the tangent at one of the corners.
/// ```
pub(super) fn concave_rise(
    zone: &Zone,
    Way { middle, sway }: Way,
    at: impl Fn(DVec3) -> f64,
    tangent: impl Fn([f64; 3]) -> Dual<f64>,
) -> bool {
    let scale = 1.0 / middle.length();
    let (way, sway, radius) = (scale * middle, scale * sway, zone.radius());
    let here = at(zone.centre);
    let slack = 1e-12 * (zone.reach() + 16.0 * radius + here.abs());
    let rises_beyond = |by: f64| at(zone.centre + by * way) > here + 2.0 * radius + by * sway + slack;
    if [2.5, 4.0, 8.0, 16.0].iter().any(|by| rises_beyond(by * radius)) {
        return true;
    }
    let gradient = DVec3::from_array(tangent(zone.centre.to_array()).d);
    let rises_near = |by: f64| {
        let least = here + 2.0 * zone.slack.length() + by * sway + slack;
        (0..8u32).all(|corner| {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let from = zone.axes * DVec3::new(sign(0), sign(1), sign(2));
            at(zone.centre + from + by * way) > least + gradient.dot(from)
        })
    };
    rises_near(radius) || rises_near(3.0 * radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_moved_keeps_its_shape() {
        let sides = DMat3::from_cols(DVec3::new(0.1, 0.2, 0.0), DVec3::new(-0.05, 0.3, 0.1), DVec3::Z * 0.2);
        let zone = Zone::of_frame(DVec3::new(0.3, -1.2, 2.0), sides).inflated(0.01);
        let by = DVec3::new(1.7, -0.3, 1e3);
        let moved = zone.mapped(&DAffine3::from_translation(by));
        assert_eq!((moved.centre, moved.axes), (zone.centre + by, zone.axes));
        let grown = moved.slack - zone.slack;
        assert!(grown.cmpge(4e-16 * by.abs()).all() && grown.max_element() < 1e-11, "{grown}");
        for (axis, (moved, own)) in moved.hull().into_iter().zip(zone.hull()).enumerate() {
            assert!(moved.lo() <= own.lo() + by[axis] && moved.hi() >= own.hi() + by[axis]);
            assert!(moved.width() < own.width() + 1e-11);
        }
        assert_eq!(zone.mapped(&DAffine3::IDENTITY).hull(), zone.hull());
    }
}
