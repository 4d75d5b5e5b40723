//! Layers that hold a level of a value that changes by no more than lengths do.
//!
//! ```text
//!         ____---____        About a point above the level there is a ball that is above, as large as the
//!       /      +      \      value is higher there, and about one below a ball that is below. The level of a
//!     --(------p------)--    distance is touched by both, at p: between them it is in a layer, in a zone that
//!       \      −      /      is small beside them, whose thickness goes with the square of the zone's size.
//!         ----___----
//! ```

use glam::DVec3;
use rvachev_num::Dual;

use crate::{AnyField, Layer, Zone};

/// What values may be off by rounding, as a part of the coordinates.
const ROUNDING: f64 = 1e-13;

/// How far the first balls' middles are from the level, in radii of the zone, and how many times as
/// far the next ones are, if those before do better than the ones before them.
const FIRST: f64 = 3.0;
const NEXT: f64 = 4.0;

/// There are so many of them on a side at most.
const BALLS: usize = 4;

/// What of a zone a value depends on, and along what it rises, where that is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Across {
    /// 0 along the axes that it does not depend on, 1 along the others.
    pub(crate) axes: DVec3,
    /// A unit vector.
    pub(crate) along: Option<DVec3>,
}

/// Layers that hold all points of a zone at which a value is `level`: one, or none if there is no
/// such point. The value changes by no more than 1 per length unit all over space, and is the
/// distance from a surface on the side that the level is on. Nothing is told where it has no slope.
///
/// ```
/// use rvachev_field::{Sphere, Zone, level_layers};
/// use rvachev_num::Bounds;
/// use glam::DVec3;
///
/// let ball = Sphere { radius: 1.0 };
/// let zone = Zone::of_bounds(&Bounds::from_center(DVec3::X, DVec3::splat(0.01)));
/// let layers = level_layers(&ball, &zone, 0.0).expect("it has a slope there");
/// assert!(layers[0].normal.x < -0.999 && layers[0].high - layers[0].low < 1e-3);
/// ```
#[must_use]
pub fn level_layers(field: &dyn AnyField, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
    layers_across(field, zone, level, Across { axes: DVec3::ONE, along: None })
}

/// The same where more is known.
pub(crate) fn layers_across(field: &dyn AnyField, zone: &Zone, level: f64, across: Across) -> Option<Vec<Layer>> {
    if !zone.is_finite() {
        return None;
    }
    let radius = zone.radius();
    let sloped = |p: DVec3| {
        let found = field.dual(Dual::point(p.to_array()));
        (found.value() - level, DVec3::from_array(found.gradient()))
    };
    let (height, slope) = sloped(zone.centre);
    let rounding = ROUNDING * (zone.reach() + radius + height.abs() + level.abs());
    if height.abs() > radius + rounding {
        return Some(Vec::new());
    }
    // A step towards the level, and one from there.
    let first = across.along.or(slope.try_normalize())?;
    let (left, slope) = sloped(zone.centre - height * first);
    let normal = across.along.or(slope.try_normalize())?;
    let foot = zone.centre - height * first - left * normal;
    let (mut aside, mut most) = (0.0f64, 0.0f64);
    for n in 0..8 {
        let along = |k: usize| if n >> k & 1 == 0 { -zone.axes.col(k) } else { zone.axes.col(k) };
        let way = (zone.centre + along(0) + along(1) + along(2) - foot) * across.axes;
        let rise = normal.dot(way);
        (aside, most) = (aside.max((way - rise * normal).length()), most.max(rise.abs()));
    }
    let slack = zone.slack.length();
    let (aside, most) = (aside + slack, most + slack);
    // Beyond the zone a leaf that was narrowed may tell another sign.
    let value = |p: DVec3| {
        let found = field.value(p.to_array());
        if level == 0.0 { found } else { found.abs().copysign(level) }
    };
    // How far from the foot the level may be on a side, and the balls that tell it: how far their
    // middles are, and how large they are.
    let reach = |sign: f64| {
        // Beyond where the distance is 0 there is nothing that is nearer.
        let farthest = if sign * level < 0.0 { level.abs() } else { f64::INFINITY };
        let (mut least, mut by) = (most, (FIRST * radius).min(farthest));
        let mut balls = Vec::with_capacity(BALLS);
        for _ in 0..BALLS {
            let centre = foot + sign * by * normal;
            let ball = sign * (value(centre) - level) - rounding - ROUNDING * by;
            if ball <= aside {
                break;
            }
            let flat = (ball * ball - aside * aside).sqrt();
            let gap = by - flat;
            if by + flat < most || gap >= least {
                break;
            }
            balls.push([by, ball]);
            least = gap;
            if by >= farthest {
                break;
            }
            by = (NEXT * by).min(farthest);
        }
        (least + rounding, balls)
    };
    let (at, [(below, falling), (over, rising)]) = (normal.dot(foot), [-1.0, 1.0].map(reach));
    let balls = if level > 0.0 { rising } else { falling };
    let cosines = balls.into_iter().map(|ball| least_cosine(level.abs(), ball, [below.max(over), aside]));
    let least_cosine = cosines.fold(-1.0, f64::max);
    Some(vec![Layer { normal, low: at - below, high: at + over, least_cosine }])
}

/// The cosine, at least, between the normal of a layer and the ways from the surface to points that
/// are `distance` from it and no farther from the layer's foot than `most` along the normal and
/// `aside` across it. About a point that is farther from the surface by `by` there is a ball of the
/// radius `distance + ball` that the surface does not reach into.
///
/// ```text
///     c                  With u the way from the foot y to x, and a that from x to c, no point of the
///     |\ a               surface is nearer to c than D, so that
///     | x
///     | | d u                |a + d u|² = a² + d² + 2 d a·u ≥ D²,   a·u ≥ (D² − d² − a²)/(2d)
///     | y
/// ```
fn least_cosine(distance: f64, [by, ball]: [f64; 2], [most, aside]: [f64; 2]) -> f64 {
    if distance <= 0.0 {
        return -1.0;
    }
    let farthest = by + most;
    let along = ball * (2.0 * distance + ball) - farthest * farthest - aside * aside;
    // a·u is at most farthest·cos φ + aside·sin φ.
    let cosine = 0.5 * along / distance / farthest.hypot(aside);
    if cosine <= 0.0 {
        return -1.0;
    }
    (cosine.min(1.0).acos() + aside.atan2(farthest)).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cuboid, Sphere, Torus};
    use glam::DMat3;
    use rvachev_num::Interval;

    /// No point with the level is beyond the layers, and these are thin.
    #[test]
    fn levels_are_in_their_layers() {
        let fields: [&dyn AnyField; 3] =
            [&Sphere { radius: 1.0 }, &Torus { radius: 1.0, tube: 0.4 }, &Cuboid { size: DVec3::new(1.5, 1.0, 0.7) }];
        let random = |n: u32| {
            let mixed = u64::from(n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            ((mixed ^ mixed >> 31) >> 11) as f64 / 2f64.powi(53)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0;
        for (number, field) in fields.into_iter().enumerate() {
            let (mut told, mut thin, mut turned) = (0, 0, 0);
            for n in 0..20_000u32 {
                let size = 0.005 * f64::powi(2.0, (n % 6) as i32);
                let axes = DMat3::from_cols(vector(90 * n), vector(90 * n + 1), vector(90 * n + 2)) * size;
                let level = [0.0, 0.1, -0.2][(n % 3) as usize];
                let zone = Zone::of_frame(1.4 * vector(90 * n + 3), axes);
                let Some(layers) = level_layers(field, &zone, level) else { continue };
                let value = |p: DVec3| field.value(p.to_array()) - level;
                for k in 4..40 {
                    let p = zone.centre + zone.axes * vector(90 * n + k);
                    // Beyond a layer the side is that of what is farther.
                    match &layers[..] {
                        [] => assert!(value(p) * value(zone.centre) > 0.0, "{number} {n}"),
                        [Layer { normal, low, high, least_cosine }] => {
                            let at = normal.dot(p);
                            assert!(at <= *high || value(p) > -1e-12, "{number} {n}: {} above", value(p));
                            assert!(at >= *low || value(p) < 1e-12, "{number} {n}: {} below", value(p));
                            let rise = DVec3::from_array(field.dual(Dual::point(p.to_array())).gradient());
                            // Where the level is near enough, its direction is that of the value's
                            // rise there.
                            if value(p).abs() < 0.02 * size {
                                assert!(rise.dot(*normal) > least_cosine - 1e-2, "{number} {n}: {least_cosine}");
                                turned += usize::from(*least_cosine > 0.9);
                            }
                        }
                        _ => unreachable!("there is one at most"),
                    }
                }
                // In a zone that is small beside what curves, and beside how far the level is.
                let is_small = zone.radius() < 0.2 * if level == 0.0 { 0.4 } else { level.abs() };
                if let [Layer { low, high, .. }] = layers[..]
                    && is_small
                {
                    told += 1;
                    thin += usize::from(high - low < 0.5 * zone.radius());
                }
            }
            assert!(told > 50 && 2 * thin > told && turned > 20, "{number}: {thin} of {told}, {turned}");
        }
        let everywhere = Zone::of_sides([Interval::ALL; 3]);
        assert!(level_layers(fields[0], &everywhere, 0.0).is_none());
    }
}
