//! Bays of an outline: what is missing between it and the line around it.
//!
//! ```text
//!      .-----.    .-----.          slots, notches and dovetails are open to the outside: sections
//!      |      \__/      |          show no ring of theirs, but a bay of the outer ring
//!      '----------------'
//! ```
//!
//! Source of the hull: A. Andrew, *Another efficient algorithm for convex hulls in two dimensions*
//! (1979).

use glam::DVec2;

use super::straighten::homes;

/// Corners of a bay at most, without its mouth; arcs have many.
const MOST: usize = 20;

/// The bays of a ring, whose corners those of a polygon are, counter-clockwise each, that reach out
/// of it by a length. They have all points of the ring: some may be arcs.
pub(super) fn bays(ring: &[DVec2], polygon: &[DVec2], beyond: f64) -> Vec<Vec<DVec2>> {
    let hull = hull(polygon);
    let homes = homes(ring, polygon);
    let mut bays = Vec::new();
    for (k, &from) in hull.iter().enumerate() {
        let to = hull[(k + 1) % hull.len()];
        let steps = (to + polygon.len() - from) % polygon.len();
        if !(2..=MOST).contains(&steps) {
            continue;
        }
        let (a, b) = (polygon[from], polygon[to]);
        let out = -(b - a).normalize_or_zero().perp() * beyond;
        let count = (homes[to] + ring.len() - homes[from]) % ring.len();
        let mut bay: Vec<DVec2> = (0..=count).map(|i| ring[(homes[from] + i) % ring.len()]).collect();
        bay.extend([b + out, a + out]);
        bay.reverse();
        bays.push(bay);
    }
    bays
}

/// The numbers of the corners of the convex hull of a counter-clockwise polygon, in its order.
fn hull(polygon: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..polygon.len()).collect();
    let at = |i: usize| polygon[i];
    order.sort_by(|i, j| at(*i).x.total_cmp(&at(*j).x).then(at(*i).y.total_cmp(&at(*j).y)));
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut kept: Vec<usize> = Vec::new();
        for i in order {
            while let [.., a, b] = kept[..]
                && (at(b) - at(a)).perp_dot(at(i) - at(a)) <= 0.0
            {
                kept.pop();
            }
            kept.push(i);
        }
        kept.pop();
        kept
    };
    let mut hull = half(&mut order.iter().copied());
    hull.extend(half(&mut order.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::bases::{Base, Grain, bases};
    use super::super::straighten::corners;
    use super::*;

    #[test]
    fn a_slot_with_a_round_bottom_has_arcs() {
        let fine = Grain { tolerance: 0.0018, short: 0.0 };
        let round = (0..=16).map(|k| DVec2::new(0.3, 0.2) + 0.08 * DVec2::from_angle(-PI * f64::from(k) / 16.0));
        let ring: Vec<DVec2> = [[0.0, 0.0], [0.6, 0.0], [0.6, 0.3], [0.38, 0.3]]
            .map(DVec2::from_array)
            .into_iter()
            .chain(round)
            .chain([[0.22, 0.3], [0.0, 0.3]].map(DVec2::from_array))
            .collect();
        let found = bays(&ring, &corners(&ring, fine.tolerance), 0.02);
        let [bay] = &found[..] else { panic!("{found:?}") };
        let bases = bases(bay, fine);
        let has_arcs = |base: &Base| match base {
            Base::Outline(outline) => {
                let arcs = outline.radii.iter().filter(|radius| **radius != 0.0);
                outline.arc_count() == 2 && arcs.clone().all(|radius| (radius - 0.08).abs() < 1e-9)
            }
            _ => false,
        };
        assert!(bases.iter().any(has_arcs), "{bases:?}");
    }

    #[test]
    fn a_dovetail_is_a_bay() {
        let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 4.0], [6.0, 4.0], [7.0, 2.0], [2.0, 2.0], [3.0, 4.0], [0.0, 4.0]];
        let polygon = corners.map(DVec2::from_array);
        let found = bays(&polygon, &polygon, 0.5);
        let [bay] = &found[..] else { panic!("{found:?}") };
        assert_eq!(bay.len(), 8);
        // From the outer corners of the top, half a unit over it.
        let area = super::super::sections::area(bay);
        assert!((area - (8.0 + 9.0 * 0.5)).abs() < 1e-12, "{area}: {bay:?}");
        assert!(bay.iter().any(|p| p.y == 4.5) && bays(&polygon[..3], &polygon[..3], 0.5).is_empty());
    }
}
