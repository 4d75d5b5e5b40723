//! Rays within faces that operands share.
//!
//! ```text
//!     +-------+      On the way through the joint the value is 0, and a crossing cannot be told from a touch. Rays
//!     |   a   |      a little beside see each operand: where all of them are inside, so is the ray.
//!     +=======+-->
//!     |   b   |
//!     +-------+
//! ```

use super::ray::{Hit, Ray};

/// Where rays are about the one that is asked for, as angles: such that some are on either side of
/// any face that it is in.
const AROUND: [f64; 4] = [0.4, 2.0, 3.6, 5.1];

/// So many crossings of the rays about it are looked at.
const MANY: usize = 64;

/// Values of less than this part of those about them are 0 but for rounding.
const LEVEL: f64 = 0.01;

/// Whether a ray leaves the solid by a hit into a face that operands share; at the end of that face
/// the normal may be across the ray.
pub(super) fn runs_on(ray: &Ray<'_>, hit: &Hit) -> bool {
    let small = ray.small();
    hit.normal.dot(ray.direction) >= 0.0 && ray.value(hit.distance + 4.0 * small) > -LEVEL * small
}

/// The first crossing, given that which does not know of joints.
pub(super) fn beside(ray: &Ray<'_>, near: f64, hit: Option<Hit>) -> Option<Hit> {
    let small = ray.small();
    let (a, b) = ray.direction.any_orthonormal_pair();
    let rays = AROUND.map(|turn| ray.from(ray.origin + small * (turn.cos() * a + turn.sin() * b)));
    // From a corner of a pocket they are inside for so long.
    let near = near + 8.0 * small;
    let mut inside = rays.each_ref().map(|ray| ray.value(near) > 0.0);
    let mut ahead = rays.each_ref().map(|ray| ray.next(near));
    let all = |inside: [bool; 4]| inside.into_iter().all(|inside| inside);
    let began = all(inside);
    for _ in 0..MANY {
        let distance = |which: usize| ahead[which].map_or(f64::INFINITY, |hit| hit.distance);
        let which = (0..4).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        let Some(found) = ahead[which] else { return hit };
        inside[which] = !inside[which];
        if all(inside) == began {
            ahead[which] = rays[which].next(found.distance + 2.0 * small);
            continue;
        }
        // All are inside for a while between spheres that touch, and for less long than the ray
        // where it leaves at a small angle: then the value on the ray itself is not 0.
        let at = found.distance + if began { -4.0 * small } else { 4.0 * small };
        let most = rays.iter().map(|ray| ray.value(at)).fold(0.0, f64::max);
        let is_level = ray.value(at).abs() <= LEVEL * most;
        let is_earlier = |hit: Hit| found.distance < hit.distance - 8.0 * small;
        let is_later = |hit: Hit| found.distance > hit.distance + 8.0 * small;
        let moved = Hit { point: ray.origin + found.distance * ray.direction, ..found };
        let counts = is_level && hit.is_none_or(is_earlier) || began && hit.is_some_and(is_later);
        return if counts { Some(moved) } else { hit };
    }
    hit
}
