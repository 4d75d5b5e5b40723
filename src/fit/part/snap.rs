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

/// The leaves laid through the vertices that they make the surface at, where most of these are met then.
pub(super) fn snapped(leaves: &[(bool, Leaf)], vertices: &[DVec3], run: &Run) -> Result<Vec<(bool, Leaf)>, Cancelled> {
    let mut laid = leaves.to_vec();
    for width in WIDTHS {
        run.check()?;
        let near = 3.0 * width;
        let of_surface: Vec<DVec3> = vertices.iter().copied().filter(|p| owner(&laid, *p).1.abs() < near).collect();
        for (_, leaf) in &mut laid {
            let own =
                of_surface.iter().filter(|p| leaf.distance(**p).abs() < near).map(|p| (*p, 1.0)).collect::<Vec<_>>();
            if own.len() > 1 {
                *leaf = fitted(leaf, &own, width);
            }
        }
    }
    let mut meant = vec![[0_usize; 2]; leaves.len()];
    for p in vertices {
        for ((_, leaf), [meant, met]) in laid.iter().zip(&mut meant) {
            let distance = leaf.distance(*p).abs();
            *meant += usize::from(distance < MEANT);
            *met += usize::from(distance < MET);
        }
    }
    let is_meant = |(((_, leaf), (_, was)), [meant, met]): &((&(bool, Leaf), &(bool, Leaf)), &[usize; 2])| {
        2 * met > *meant && leaf.centre.distance(was.centre) < FARTHEST
    };
    Ok(laid
        .iter()
        .zip(leaves)
        .zip(&meant)
        .map(|all| if is_meant(&all) { all.0.0.clone() } else { all.0.1.clone() })
        .collect())
}
