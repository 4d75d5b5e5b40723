//! Leaves laid through the vertices.
//!
//! ```text
//!        .-o-.         Of a round side that is made of facets only the vertices are on the surface: samples of its
//!      o'     'o       area are inside of it, and by the volume the true radius is worse than a smaller one. So
//!                      what a length is meant to be is asked of the vertices, and of nothing else.
//! ```

use glam::DVec3;

use super::leaf::Leaf;
use super::refine::{fitted, owner};
use crate::{Cancelled, Run};

/// Where weights fall off, round by round, in diagonals.
const WIDTHS: [f64; 6] = [1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6];

/// Leaves that would move farther are left where they are.
const FARTHEST: f64 = 0.01;

/// Vertices nearer than this are meant by a leaf, and those nearer than that are met by it.
const MEANT: f64 = 3e-3;
const MET: f64 = 2e-5;

/// The leaves laid through the vertices that they make the surface at, where most of these are met
/// then.
pub(super) fn snapped(leaves: &[(bool, Leaf)], vertices: &[DVec3], run: &Run) -> Result<Vec<(bool, Leaf)>, Cancelled> {
    let mut laid = leaves.to_vec();
    for width in WIDTHS {
        run.check()?;
        let near = 3.0 * width;
        let of_surface: Vec<DVec3> = vertices.iter().copied().filter(|p| owner(&laid, *p).1.abs() < near).collect();
        for (_, leaf) in &mut laid {
            run.check()?;
            let own =
                of_surface.iter().filter(|p| leaf.distance(**p).abs() < near).map(|p| (*p, 1.0)).collect::<Vec<_>>();
            if own.len() > 1 {
                *leaf = fitted(leaf, &own, width);
            }
        }
    }
    let was_met = met(leaves, vertices);
    let is_met = met(&laid, vertices);
    for (i, leaf) in laid.iter_mut().enumerate() {
        let [meant, now] = is_met[i];
        let is_better = 2 * now > meant && now > was_met[i][1];
        if !is_better || leaf.1.centre.distance(leaves[i].1.centre) > FARTHEST {
            *leaf = leaves[i].clone();
        }
    }
    Ok(laid)
}

/// By leaf, how many vertices are near it, and how many are on it.
fn met(leaves: &[(bool, Leaf)], vertices: &[DVec3]) -> Vec<[usize; 2]> {
    let count = |(_, leaf): &(bool, Leaf)| {
        let distances = vertices.iter().map(|p| leaf.distance(*p).abs());
        distances.fold([0, 0], |[meant, met], d| [meant + usize::from(d < MEANT), met + usize::from(d < MET)])
    };
    leaves.iter().map(count).collect()
}
