//! Arcs among the sides of a polygon that a ring is.
//!
//! ```text
//!     .___.            .___.
//!    /     \          (     )        three sides and more whose points are on one circle are an
//!   |       |    →    |     |        arc, or two if that goes around for long
//!   '-------'         '-----'
//! ```

use std::f64::consts::TAU;

use glam::DVec2;
use rvachev_num::order;

use super::outline::Outline;
use super::straighten::homes;
use crate::fit::linear;

/// Sides that are an arc, at the least.
const FEWEST: usize = 3;

/// Where facets are exact their sides turn by less than this in an arc, in radians: prisms of 12
/// sides are none.
const TURN: f64 = 0.497;

/// Points of exact facets are on an arc to this part of the tolerance.
const FINE: f64 = 0.05;

/// Sides that turn by more than this, in radians, are of no arc, and arcs that turn by less are
/// none.
const MOST: f64 = 6.0;
const LEAST: f64 = 0.2;

/// Arcs that turn by more, in radians, are cut in two: the nearer to half a turn, the farther the
/// middle of an arc is off if its radius is, between the same ends; here it is twice as far.
const LONG: f64 = 2.5;

/// Sides that are one arc.
struct Found {
    from: usize,
    sides: usize,
    circle: Circle,
}

/// A circle, of a radius above 0 where the way along it turns to the left.
#[derive(Clone, Copy)]
struct Circle {
    centre: DVec2,
    radius: f64,
}

/// The outline with arcs that a ring is, counter-clockwise as its polygon; none if no sides are
/// arcs. Where facets `are_exact` the ring has a point for each.
pub(super) fn arched(ring: &[DVec2], polygon: &[DVec2], tolerance: f64, are_exact: bool) -> Option<Outline> {
    let count = polygon.len();
    if count <= FEWEST {
        return None;
    }
    let homes = homes(ring, polygon);
    let mut found: Vec<Found> = (0..count)
        .filter_map(|from| {
            let longest = (FEWEST..count).take_while(|sides| turned(polygon, from, *sides) < MOST).last()?;
            (FEWEST..=longest).rev().find_map(|sides| {
                let points = between(ring, homes[from], homes[(from + sides) % count]);
                let circle = circle(&points, tolerance, are_exact)?;
                Some(Found { from, sides, circle })
            })
        })
        .collect();
    // The longest ones first; what is of one is of no other.
    order::falling(&mut found, |arc| arc.sides as f64);
    let mut arc_of = vec![None; count];
    let mut corners = polygon.to_vec();
    for (number, arc) in found.iter().enumerate() {
        let own = || (0..arc.sides).map(|k| (arc.from + k) % count);
        if own().all(|side| arc_of[side].is_none()) {
            own().for_each(|side| arc_of[side] = Some(number));
            let to = (arc.from + arc.sides) % count;
            if are_exact {
                // Corners of few are off where a straight side touches the arc.
                let begins = [(arc.from + count - 1) % count, (to + 1) % count].map(|k| homes[k]);
                let ends = reached(ring, [homes[arc.from], homes[to]], begins, arc.circle, FINE * tolerance);
                (corners[arc.from], corners[to]) = (ring[ends[0]], ring[ends[1]]);
            }
        }
    }
    let mut outline = Outline { corners: Vec::new(), radii: Vec::new() };
    for (corner, number) in corners.iter().zip(0..) {
        let own = arc_of[number].map(|arc| &found[arc]);
        if own.is_none_or(|arc| arc.from == number) {
            outline.corners.push(*corner);
            outline.radii.push(own.map_or(0.0, |arc| arc.circle.radius));
            if let Some(arc) = own {
                let Circle { centre, radius } = arc.circle;
                let ends = [number, (number + arc.sides) % count].map(|k| (corners[k] - centre).to_angle());
                let turn = ((ends[1] - ends[0]) * radius.signum()).rem_euclid(TAU) * radius.signum();
                if turn.abs() > LONG {
                    outline.corners.push(centre + radius.abs() * DVec2::from_angle(ends[0] + 0.5 * turn));
                    outline.radii.push(radius);
                }
            }
        }
    }
    (outline.arc_count() > 0 && outline.corners.len() >= 3).then_some(outline)
}

/// By how much sides turn to one side, in radians; infinite if they turn both ways.
fn turned(polygon: &[DVec2], from: usize, sides: usize) -> f64 {
    let count = polygon.len();
    let side = |k: usize| polygon[(from + k + 1) % count] - polygon[(from + k) % count];
    let turns = || (1..sides).map(|k| side(k - 1).angle_to(side(k)));
    let all: f64 = turns().sum();
    let sum = if turns().all(|turn| turn * all > 0.0) { all.abs() } else { f64::INFINITY };
    // Of the first and the last side half is beyond the middle of its own arc.
    sum * sides as f64 / (sides as f64 - 1.0)
}

/// The points of a ring from one to another.
fn between(ring: &[DVec2], from: usize, to: usize) -> Vec<DVec2> {
    let count = ring.len();
    (0..=(to + count - from) % count).map(|k| ring[(from + k) % count]).collect()
}

/// Where an arc of a ring begins and ends, if it goes on to points before and after that are on its
/// circle, up to the corners there.
fn reached(ring: &[DVec2], ends: [usize; 2], limits: [usize; 2], circle: Circle, near: f64) -> [usize; 2] {
    let count = ring.len();
    let is_on = |i: usize| (ring[i].distance(circle.centre) - circle.radius.abs()).abs() < near;
    let steps = [count - 1, 1];
    [0, 1].map(|k| {
        let next = |i: usize| (i + steps[k]) % count;
        let mut end = ends[k];
        while end != limits[k] && next(end) != limits[k] && is_on(next(end)) {
            end = next(end);
        }
        end
    })
}

/// The circle that points are on.
fn circle(points: &[DVec2], tolerance: f64, are_exact: bool) -> Option<Circle> {
    if are_exact {
        let turn = |w: &[DVec2]| (w[1] - w[0]).angle_to(w[2] - w[1]).abs();
        if points.windows(3).any(|w| turn(w) > TURN) {
            return None;
        }
    }
    let first = *points.first()?;
    let (from_first, radius) = linear::circle(points.iter().map(|p| *p - first))?;
    let centre = first + from_first;
    let turn: f64 = points.windows(2).map(|w| (w[0] - centre).angle_to(w[1] - centre)).sum();
    let is_on = |p: &DVec2| (p.distance(centre) - radius).abs() < tolerance;
    // A nearly straight one is none.
    let is_round = turn.abs() > LEAST && radius > 2.0 * tolerance;
    (is_round && points.iter().all(is_on)).then(|| Circle { centre, radius: radius * turn.signum() })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::fit::part::straighten::corners;

    /// A plate with a round end, two round corners and a bite, of facets.
    #[test]
    fn arcs_of_facets_are_found_and_octagons_are_none() {
        let arc = |x: f64, y: f64, r: f64, from: f64, to: f64| {
            (0..=12).map(move |k| {
                let angle = from + (to - from) * f64::from(k) / 12.0;
                DVec2::new(x, y) + r * DVec2::from_angle(angle)
            })
        };
        let ring: Vec<DVec2> = arc(0.3, 0.0, 0.1, -0.5 * PI, 0.5 * PI)
            .chain(arc(0.1, 0.1, 0.05, 0.0, -PI))
            .chain(arc(-0.2, 0.05, 0.05, 0.5 * PI, PI))
            .chain([DVec2::new(-0.25, -0.1)])
            .collect();
        let polygon = corners(&ring, 0.0018);
        let outline = arched(&ring, &polygon, 0.0018, true).expect("there are arcs");
        let mut radii: Vec<f64> = outline.radii.iter().copied().filter(|r| *r != 0.0).collect();
        order::numbers(&mut radii);
        assert_eq!(outline.corners.len(), 9, "{outline:?}");
        for (found, true_radius) in radii.iter().zip([-0.05, -0.05, 0.05, 0.1, 0.1]) {
            assert!((found - true_radius).abs() < 1e-9, "{radii:?}");
        }
        assert!(outline.contains(DVec2::new(0.39, 0.0)) && !outline.contains(DVec2::new(0.1, 0.06)));
        let octagon: Vec<DVec2> = (0..8).map(|k| DVec2::from_angle(PI / 4.0 * f64::from(k))).collect();
        assert!(arched(&octagon, &octagon, 0.0018, true).is_none());
    }
}
