//! The few corners of a ring of many points.
//!
//! Source: D. Douglas, T. Peucker, *Algorithms for the reduction of the number of points required
//! to represent a digitized line or its caricature* (1973).

use glam::DVec2;

/// The corners of a ring: no point is farther from the sides than a tolerance.
pub(super) fn corners(ring: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let count = ring.len();
    let middle = ring.iter().sum::<DVec2>() / count as f64;
    // What is farthest out is a corner, and what is farthest from it.
    let farthest = |from: DVec2| {
        let away = |i: &usize| ring[*i].distance_squared(from);
        (0..count).max_by(|i, j| away(i).total_cmp(&away(j))).unwrap_or(0)
    };
    let first = farthest(middle);
    let second = farthest(ring[first]);
    let mut kept = vec![false; count];
    (kept[first], kept[second]) = (true, true);
    let mut open = vec![[first, second], [second, first]];
    while let Some([from, to]) = open.pop() {
        let steps = (to + count - from) % count;
        let (a, b) = (ring[from], ring[to]);
        let off = |k: &usize| distance(ring[(from + k) % count], a, b);
        let Some(most) = (1..steps).max_by(|i, j| off(i).total_cmp(&off(j))) else { continue };
        if off(&most) > tolerance {
            let at = (from + most) % count;
            kept[at] = true;
            open.extend([[from, at], [at, to]]);
        }
    }
    (0..count).map(|k| (first + k) % count).filter(|i| kept[*i]).map(|i| ring[i]).collect()
}

/// The points of a ring that are nearest to the corners of its polygon.
pub(super) fn homes(ring: &[DVec2], polygon: &[DVec2]) -> Vec<usize> {
    let nearest = |corner: &DVec2| {
        let away = |i: &usize| ring[*i].distance_squared(*corner);
        (0..ring.len()).min_by(|i, j| away(i).total_cmp(&away(j))).unwrap_or(0)
    };
    polygon.iter().map(nearest).collect()
}

/// How far a point is from a segment.
pub(super) fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (along, from) = (b - a, p - a);
    let t = (from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from - t * along).length()
}

/// Corners that a mesh of small facets cut off: short sides between two long ones go, and these are
/// lengthened to where they meet.
pub(super) fn uncut(corners: &[DVec2], short: f64) -> Vec<DVec2> {
    let mut corners = corners.to_vec();
    let mut at = 0;
    while at < corners.len() && corners.len() > 3 {
        let count = corners.len();
        let [a, b, c, d] = [count - 1, 0, 1, 2].map(|k| corners[(at + k) % count]);
        let (before, after) = (b - a, d - c);
        let sine = before.normalize_or_zero().perp_dot(after.normalize_or_zero());
        let is_short = b.distance(c) < short && before.length() > short && after.length() > short;
        if is_short && sine.abs() > 0.3 {
            let t = (c - b).perp_dot(after) / before.perp_dot(after);
            let meeting = b + t * before;
            if meeting.distance(b).max(meeting.distance(c)) < short {
                corners[at] = meeting;
                corners.remove((at + 1) % count);
                continue;
            }
        }
        at += 1;
    }
    corners
}

/// Corners where the lines meet that fit the points along each side best, where these lines differ
/// enough.
pub(super) fn fitted(ring: &[DVec2], corners: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let count = corners.len();
    let lines: Vec<(DVec2, DVec2)> = (0..count)
        .map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % count]);
            let along = (b - a).normalize_or(DVec2::X);
            // The ends are rounded or cut.
            let margin = (0.2 * a.distance(b)).min(3.0 * tolerance);
            let is_of = |p: &&DVec2| {
                let s = (**p - a).dot(along);
                s > margin && s < a.distance(b) - margin && (**p - a).perp_dot(along).abs() < 2.0 * tolerance
            };
            let held: Vec<DVec2> = ring.iter().filter(is_of).copied().collect();
            if held.len() < 3 {
                return (a, along);
            }
            let mean = held.iter().sum::<DVec2>() / held.len() as f64;
            let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
            for p in &held {
                let d = *p - mean;
                (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
            }
            let angle = 0.5 * f64::atan2(2.0 * xy, xx - yy);
            (mean, DVec2::from_angle(angle))
        })
        .collect();
    (0..count)
        .map(|k| {
            let ((p, u), (q, v)) = (lines[(k + count - 1) % count], lines[k]);
            let sine = u.perp_dot(v);
            let meeting = p + u * ((q - p).perp_dot(v) / sine);
            let is_near = sine.abs() > 0.15 && meeting.distance(corners[k]) < 5.0 * tolerance;
            if is_near { meeting } else { corners[k] }
        })
        .collect()
}

/// Whether sides of a polygon cross each other, or touch where they are not neighbours.
pub(super) fn crosses(corners: &[DVec2]) -> bool {
    let count = corners.len();
    let side = |k: usize| [corners[k], corners[(k + 1) % count]];
    let parted = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| [(b - a).perp_dot(c - a), (b - a).perp_dot(d - a)];
    let cross = |i: usize, j: usize| {
        let [p, q] = [parted(side(i), side(j)), parted(side(j), side(i))];
        // Sides of one line are beside each other.
        p[0] * p[1] <= 0.0 && q[0] * q[1] <= 0.0 && [p, q].concat().iter().any(|x| *x != 0.0)
    };
    (0..count).any(|i| (i + 2..count).any(|j| (i, j) != (0, count - 1) && cross(i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bow_crosses_itself_and_a_comb_does_not() {
        let of = |points: &[[f64; 2]]| crosses(&points.iter().copied().map(DVec2::from_array).collect::<Vec<_>>());
        assert!(of(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]));
        assert!(of(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.0], [0.0, 1.0]]));
        let comb = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0], [2.0, 0.5], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]];
        assert!(!of(&comb) && !of(&comb[..3]));
    }

    /// Points along a polygon, a corner cut off between two of them.
    fn strewn(corners: &[DVec2], step: f64) -> Vec<DVec2> {
        let mut ring = Vec::new();
        for (k, a) in corners.iter().enumerate() {
            let along = corners[(k + 1) % corners.len()] - *a;
            let count = (along.length() / step) as usize;
            ring.extend((0..count).map(|i| *a + along * ((i as f64 + 0.5) / count as f64)));
        }
        ring
    }

    #[test]
    fn an_l_with_cut_corners_has_six() {
        let truth = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.2], [0.2, 0.25], [0.2, 0.5], [0.0, 0.5]].map(DVec2::from_array);
        let ring = strewn(&truth, 0.01);
        let found = fitted(&ring, &uncut(&corners(&ring, 0.003), 0.015), 0.003);
        assert_eq!(found.len(), 6, "{found:?}");
        assert!(truth.iter().all(|t| found.iter().any(|f| f.distance(*t) < 1e-9)), "{found:?}");
    }

    #[test]
    fn exact_corners_stay() {
        let square = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from_array);
        let found = corners(&square, 0.0018);
        assert_eq!(found.len(), 4);
        assert!(found.iter().all(|f| square.contains(f)));
    }
}
