//! Normals of points that have none, outwards.
//!
//! ```text
//!     planes     about each point, on its side of the edges near it
//!     sheets     neighbours whose planes are nearly the same are of one side: m = nₐ·n_b − 2 (nₐ·e)(n_b·e),
//!                e from a to b, is positive if their normals point to it
//!     signs      a sheet faces where winding numbers fall on it
//! ```
//!
//! Source of m: S. König, S. Gumhold, *Consistent propagation of normal orientations in point
//! clouds* (2009).

use glam::DVec3;

use super::facing::outward;
use super::planes::Planes;
use crate::fit::random::Random;
use crate::{Cancelled, Run};

/// Neighbours that may be of one sheet.
const NEAR: usize = 10;

/// Planes that are nearly the same, as a cosine: 12°.
const ALIKE: f64 = 0.978;

/// Unit normals that point outwards.
pub(super) fn normals(points: &[DVec3], random: &mut Random, run: &Run) -> Result<Vec<DVec3>, Cancelled> {
    let Planes { mut normals, neighbours, areas } = Planes::of(points);
    run.check()?;
    let mut joined = Joined::new(points.len());
    for (i, near) in (0_u32..).zip(&neighbours) {
        for k in near.iter().take(NEAR).filter(|k| **k != i) {
            let agreement = agreement(points, &normals, [i, *k]);
            let [a, b] = [i, *k].map(|i| normals[i as usize]);
            if a.dot(b).abs() > ALIKE && agreement.abs() > ALIKE {
                joined.join([i, *k], agreement < 0.0);
            }
        }
    }
    let roots: Vec<(u32, bool)> = (0..points.len() as u32).map(|i| joined.root(i)).collect();
    let mut votes = vec![0.0; points.len()];
    let falls = outward(points, &areas, random, run)?;
    for (((normal, (root, is_turned)), fall), area) in normals.iter_mut().zip(&roots).zip(falls).zip(areas) {
        if *is_turned {
            *normal = -*normal;
        }
        votes[*root as usize] += area * normal.dot(fall);
    }
    for (normal, (root, _)) in normals.iter_mut().zip(&roots) {
        if votes[*root as usize] < 0.0 {
            *normal = -*normal;
        }
    }
    Ok(normals)
}

/// Positive if the normals of two points are to the same side, and the more so the surer that is.
fn agreement(points: &[DVec3], normals: &[DVec3], ends: [u32; 2]) -> f64 {
    let [i, j] = ends.map(|i| i as usize);
    let (a, b) = (normals[i], normals[j]);
    let along = (points[j] - points[i]).normalize_or_zero();
    a.dot(b) - 2.0 * a.dot(along) * b.dot(along)
}

/// What hangs together, and on which side of each other it is.
struct Joined {
    above: Vec<u32>,
    is_turned: Vec<bool>,
    sizes: Vec<u32>,
}

impl Joined {
    fn new(count: usize) -> Joined {
        Joined { above: (0..count as u32).collect(), is_turned: vec![false; count], sizes: vec![1; count] }
    }

    /// What something hangs on, and whether it is turned against that. The smaller set hangs on the
    /// larger one, so ways are short.
    fn root(&self, mut at: u32) -> (u32, bool) {
        let mut is_turned = false;
        while self.above[at as usize] != at {
            is_turned ^= self.is_turned[at as usize];
            at = self.above[at as usize];
        }
        (at, is_turned)
    }

    fn join(&mut self, ends: [u32; 2], differs: bool) {
        let [(a, p), (b, q)] = ends.map(|i| self.root(i));
        if a == b {
            return;
        }
        let (small, large) = if self.sizes[a as usize] < self.sizes[b as usize] { (a, b) } else { (b, a) };
        self.above[small as usize] = large;
        self.is_turned[small as usize] = p ^ q ^ differs;
        self.sizes[large as usize] += self.sizes[small as usize];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a box of a size about a place, and the normals there.
    fn strewn(size: DVec3, centre: DVec3, count: usize, random: &mut Random) -> Vec<(DVec3, DVec3)> {
        let areas = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        let total = areas.element_sum();
        (0..count)
            .map(|_| {
                let at = random.unit() * total;
                let axis = if at < areas.x { 0 } else { 1 + usize::from(at > areas.x + areas.y) };
                let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
                let mut p = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
                p[axis] = 0.5 * side;
                (centre + p * size, side * DVec3::AXES[axis])
            })
            .collect()
    }

    fn right(truth: &[(DVec3, DVec3)], seed: u64) -> [usize; 2] {
        let points: Vec<DVec3> = truth.iter().map(|t| t.0).collect();
        let found = normals(&points, &mut Random::new(seed), &Run::default()).unwrap();
        let count = |is: fn(f64) -> bool| found.iter().zip(truth).filter(|(f, t)| is(f.dot(t.1))).count();
        [count(|d| d > 0.95), count(|d| d < -0.2)]
    }

    #[test]
    fn normals_of_a_box_point_out_and_most_are_sharp() {
        let truth = strewn(DVec3::new(0.6, 0.4, 0.2), DVec3::ZERO, 3000, &mut Random::new(9));
        let [right, wrong] = right(&truth, 1);
        assert!(right > 2840 && wrong < 15, "{right} {wrong}");
    }

    #[test]
    fn a_narrow_cavity_faces_inwards() {
        let mut random = Random::new(3);
        let mut truth = strewn(DVec3::new(0.7, 0.5, 0.3), DVec3::ZERO, 3200, &mut random);
        let cavity = strewn(DVec3::new(0.4, 0.12, 0.1), DVec3::new(0.05, 0.1, 0.06), 600, &mut random);
        truth.extend(cavity.into_iter().map(|(p, n)| (p, -n)));
        let [right, wrong] = right(&truth, 1);
        assert!(right > 3560 && wrong < 40, "{right} {wrong}");
    }
}
