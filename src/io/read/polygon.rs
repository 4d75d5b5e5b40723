//! Polygons of files as triangles.
//!
//! ```text
//!     d------c          Of a convex one a fan from its first corner. Of others ears are cut off: corners
//!      \  e   \         that turn as the polygon does, with no other corner in their triangle. So
//!      /    '  \        triangles are within it, and none lies over another.
//!     a---------b
//! ```

use glam::{DVec2, DVec3};

/// After so many looks from a corner at another what is left becomes a fan.
const MOST: usize = 1 << 24;

/// Calls back with the triangles of a polygon of so many corners, by their places: two fewer than
/// these, whatever it is.
pub(super) fn triangles(count: usize, corner: impl Fn(usize) -> DVec3, mut found: impl FnMut([usize; 3])) {
    if count > 3 {
        filled(&(0..count).map(corner).collect::<Vec<DVec3>>()).into_iter().for_each(found);
    } else if count == 3 {
        found([0, 1, 2]);
    }
}

fn filled(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let count = corners.len();
    let flat = flattened(corners);
    let turn = |[a, b, c]: [usize; 3]| (flat[b] - flat[a]).perp_dot(flat[c] - flat[b]);
    let reflex = (0..count).filter(|&b| turn([(b + count - 1) % count, b, (b + 1) % count]) < 0.0).count();
    let mut left: Vec<usize> = (0..count).collect();
    let mut found = Vec::with_capacity(count - 2);
    let (mut at, mut tried, mut looked) = (0, 0, 0);
    while reflex > 0 && left.len() > 3 && looked < MOST {
        let n = left.len();
        looked += n;
        let ear = [left[(at + n - 1) % n], left[at % n], left[(at + 1) % n]];
        // Where none is an ear, as of one that crosses itself, any will do.
        if tried >= n || is_ear(ear, &left, &flat, turn) {
            found.push(ear);
            left.remove(at % n);
            // On from the next corner: what is left stays as round as it was.
            at %= left.len();
            tried = 0;
        } else {
            at = (at + 1) % n;
            tried += 1;
        }
    }
    found.extend(left[1..].windows(2).map(|side| [left[0], side[0], side[1]]));
    found
}

/// Whether a triangle turns as the polygon does, and has no other corner within or on its sides.
fn is_ear(ear: [usize; 3], left: &[usize], flat: &[DVec2], turn: impl Fn([usize; 3]) -> f64) -> bool {
    if turn(ear).partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
        return false;
    }
    let [a, b, c] = ear.map(|n| flat[n]);
    let side = |from: DVec2, to: DVec2, p: DVec2| (to - from).perp_dot(p - from) >= 0.0;
    let is_within = |p: DVec2| side(a, b, p) && side(b, c, p) && side(c, a, p);
    // Corners at one place are where contours are joined to one.
    let is_other = |p: DVec2| p != a && p != b && p != c;
    !left.iter().any(|n| !ear.contains(n) && is_other(flat[*n]) && is_within(flat[*n]))
}

/// Corners seen from where the polygon turns counter-clockwise.
fn flattened(corners: &[DVec3]) -> Vec<DVec2> {
    let first = corners.first().copied().unwrap_or_default();
    // Twice the area vector.
    let area: DVec3 = corners.windows(2).map(|side| (side[0] - first).cross(side[1] - first)).sum();
    let normal = area.try_normalize().unwrap_or(DVec3::Z);
    let (u, v) = normal.any_orthonormal_pair();
    corners.iter().map(|p| DVec2::new((*p - first).dot(u), (*p - first).dot(v))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec3], triangles: &[[usize; 3]]) -> [f64; 2] {
        let vectors = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|n| corners[n]);
            0.5 * (b - a).cross(c - a)
        });
        let vectors: Vec<DVec3> = vectors.collect();
        [vectors.iter().map(|v| v.length()).sum(), vectors.iter().sum::<DVec3>().length()]
    }

    #[test]
    fn triangles_of_polygons_do_not_lie_over_each_other() {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, 2.0);
        let spread = |count: u32, inner: f64| -> Vec<DVec3> {
            let at = |k: u32| {
                let (angle, r) =
                    (0.3 + std::f64::consts::TAU * f64::from(k) / f64::from(count), [3.0, inner][k as usize % 2]);
                turn * DVec3::new(r * angle.cos(), r * angle.sin(), 0.0) + DVec3::new(7.0, -2.0, 1.0)
            };
            (0..count).map(at).collect()
        };
        for (count, inner) in [(4, 0.5), (4, 3.0), (5, 3.0), (10, 1.0), (40, 0.3), (400, 2.0)] {
            for first in 0..count.min(10) {
                let mut corners = spread(count, inner);
                corners.rotate_left(first as usize);
                let found = filled(&corners);
                assert_eq!(found.len(), corners.len() - 2);
                let [sum, whole] = area(&corners, &found);
                assert!((sum - whole).abs() < 1e-9 * whole, "{count} {inner} from {first}: {sum} {whole}");
            }
        }
        // A frame as one contour, with a seam.
        let frame = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0], [1.0, 1.0], [1.0, 3.0], [3.0, 3.0]];
        let frame = frame.into_iter().chain([[3.0, 1.0], [1.0, 1.0]]).map(|[x, y]| DVec3::new(x, y, 0.0));
        let frame: Vec<DVec3> = frame.collect();
        let [sum, whole] = area(&frame, &filled(&frame));
        assert!((sum - 12.0).abs() < 1e-9 && (whole - 12.0).abs() < 1e-9, "{sum} {whole}");
    }

    #[test]
    fn whatever_a_polygon_is_it_has_its_number_of_triangles() {
        let bad = [
            vec![DVec3::ZERO; 7],
            vec![DVec3::NAN; 5],
            [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.5, 3.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
            (0..9).map(|k| DVec3::X * f64::from(k % 4)).collect(),
            // So many that it is given up.
            (0..9000).map(|k| DVec3::new(f64::from(k), 1e-3 * f64::from(k * k % 7919), 0.0)).collect(),
        ];
        for corners in bad {
            assert_eq!(filled(&corners).len(), corners.len() - 2, "{corners:?}");
        }
    }
}
