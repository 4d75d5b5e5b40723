//! Normals of points that have none: local planes, turned to agree with their neighbours.
//!
//! From the point that is highest, whose normal is up, orientation goes on from point to point,
//! first where normals are most alike.
//!
//! Source: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, *Surface reconstruction from
//! unorganized points* (1992).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::fit::grid::{Grid, extent};
use crate::fit::linear::Principal;

/// Neighbours of a plane, and such that orientation goes on to.
const OF_PLANE: usize = 14;
const OF_ORDER: usize = 10;

/// A step from a point to a neighbour.
struct Step {
    likeness: f64,
    from: u32,
    to: u32,
}

impl PartialEq for Step {
    fn eq(&self, other: &Step) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Step {}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Step) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Step) -> Ordering {
        self.likeness.total_cmp(&other.likeness).then((other.to, other.from).cmp(&(self.to, self.from)))
    }
}

/// Unit normals that point outwards.
pub(super) fn normals(points: &[DVec3]) -> Vec<DVec3> {
    let bounds = extent(points);
    let diagonal = bounds[0].distance(bounds[1]);
    let grid = Grid::new(points, bounds, diagonal * (3.0 / points.len().max(1) as f64).sqrt());
    let mut found = Vec::new();
    let mut near: Vec<[u32; OF_ORDER]> = Vec::with_capacity(points.len());
    let mut normals: Vec<DVec3> = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        grid.nearest(*p, OF_PLANE, &mut found);
        normals.push(Principal::of(found.iter().map(|f| points[f.1 as usize])).axes.x_axis);
        near.push(std::array::from_fn(|k| found.get(k).map_or(i as u32, |f| f.1)));
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*b].z.total_cmp(&points[*a].z));
    let mut done = vec![false; points.len()];
    // Each piece of the surface from its highest point.
    for start in order {
        if done[start] {
            continue;
        }
        let up = 1.0_f64.copysign(normals[start].z);
        normals[start] *= up;
        let mut heap = BinaryHeap::from([Step { likeness: 1.0, from: start as u32, to: start as u32 }]);
        while let Some(Step { from, to, .. }) = heap.pop() {
            let (i, j) = (from as usize, to as usize);
            if done[j] {
                continue;
            }
            if normals[j].dot(normals[i]) < 0.0 {
                normals[j] = -normals[j];
            }
            done[j] = true;
            for &k in &near[j] {
                if !done[k as usize] {
                    heap.push(Step { likeness: normals[j].dot(normals[k as usize]).abs(), from: to, to: k });
                }
            }
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    #[test]
    fn normals_of_a_box_point_out() {
        let mut random = Random::new(9);
        let size = DVec3::new(0.6, 0.4, 0.2);
        let (points, truth): (Vec<DVec3>, Vec<DVec3>) = (0..3000)
            .map(|i| {
                let axis = i % 3;
                let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
                let mut p = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
                p[axis] = 0.5 * side;
                (p * size, side * DVec3::AXES[axis])
            })
            .unzip();
        let found = normals(&points);
        let right = found.iter().zip(&truth).filter(|(f, t)| f.dot(**t) > 0.7).count();
        assert!(right > 2750, "{right}");
        assert!(found.iter().zip(&truth).all(|(f, t)| f.dot(*t) > -0.2));
    }
}
