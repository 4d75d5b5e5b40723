//! Leaves laid through the vertices.
//!
//! ```text
//!        .-o-.         Of a round side that is made of facets only the vertices are on the surface: samples of its
//!      o'     'o       area are inside of it, and by the volume the true radius is worse than a smaller one. So
//!                      what a length is meant to be is asked of the vertices, and of nothing else.
//! ```

use glam::DVec3;

use super::freedom::Axes;
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
/// then; their axes stay.
pub(super) fn snapped(leaves: &[(bool, Leaf)], vertices: &[DVec3], run: &Run) -> Result<Vec<(bool, Leaf)>, Cancelled> {
    let mut laid = through(leaves, Axes::Kept, vertices, run)?;
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

/// The leaves that were laid through the vertices, turned as well, where most vertices are met, and
/// not fewer for it; none where vertices do not tell.
pub(super) fn turned(laid: &[(bool, Leaf)], vertices: &[DVec3], run: &Run) -> Result<Vec<Option<Leaf>>, Cancelled> {
    let free = through(laid, Axes::Free, vertices, run)?;
    let was_met = met(laid, vertices);
    let is_met = met(&free, vertices);
    let told = |(i, (_, leaf)): (usize, (bool, Leaf))| {
        let [meant, now] = is_met[i];
        let is_told = leaf.turns() > 0 && 2 * now > meant && now >= was_met[i][1];
        (is_told && leaf.centre.distance(laid[i].1.centre) <= FARTHEST).then_some(leaf)
    };
    Ok(free.into_iter().enumerate().map(told).collect())
}

fn through(leaves: &[(bool, Leaf)], axes: Axes, vertices: &[DVec3], run: &Run) -> Result<Vec<(bool, Leaf)>, Cancelled> {
    let mut laid = leaves.to_vec();
    for width in WIDTHS {
        run.check()?;
        let near = 3.0 * width;
        let of_surface: Vec<DVec3> = vertices.iter().copied().filter(|p| owner(&laid, *p).1.abs() < near).collect();
        for (_, leaf) in &mut laid {
            run.check()?;
            let own: Vec<_> = on_faces(leaf, &of_surface, near).map(|on| (on, 1.0)).collect();
            // Of all that is free, so many tell too little.
            if own.len() > if axes == Axes::Free { leaf.freedom(axes) } else { 1 } {
                // Vertices at a rim are on both faces: by the distance alone they would be met by
                // all that is wider, too.
                *leaf = fitted(leaf, axes, &own, width, |leaf, (p, face): (DVec3, usize)| leaf.faces(p)[face]);
            }
        }
    }
    Ok(laid)
}

/// Vertices near a leaf, with the faces that they are near.
fn on_faces<'a>(leaf: &'a Leaf, vertices: &'a [DVec3], near: f64) -> impl Iterator<Item = (DVec3, usize)> + 'a {
    let beside = vertices.iter().filter(move |p| leaf.distance(**p).abs() < near);
    beside.flat_map(move |p| {
        let faces = leaf.faces(*p).into_iter().enumerate();
        faces.filter(move |(_, off)| off.abs() < near).map(|(face, _)| (*p, face)).collect::<Vec<_>>()
    })
}

/// By leaf, how many times vertices are near a face, and how many times they are on it.
fn met(leaves: &[(bool, Leaf)], vertices: &[DVec3]) -> Vec<[usize; 2]> {
    let count = |(_, leaf): &(bool, Leaf)| [MEANT, MET].map(|near| on_faces(leaf, vertices, near).count());
    leaves.iter().map(count).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A disc of 36 facets, found too wide: its rims are on the ends all the same.
    #[test]
    fn rims_tell_radii_from_both_sides() {
        let at = |k: i32| TAU * f64::from(k) / 36.0;
        let rim = |z: f64| (0..36).map(move |k| DVec3::new(0.2 * at(k).cos(), 0.2 * at(k).sin(), z));
        let vertices: Vec<DVec3> = rim(-0.05).chain(rim(0.05)).collect();
        for radius in [0.1985, 0.2015] {
            let found = Leaf::cylinder(DVec3::Z, DVec3::new(2e-4, 0.0, 0.0), radius, [-0.0502, 0.0499]);
            let laid = snapped(&[(true, found)], &vertices, &Run::default()).unwrap();
            let sizes = laid[0].1.sizes();
            assert!((sizes[0] - 0.2).abs() < 1e-6 && (sizes[1] - 0.1).abs() < 1e-6, "{radius}: {sizes:?}");
        }
    }
}
