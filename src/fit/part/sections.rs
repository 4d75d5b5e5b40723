//! Sections of a mesh by planes.

use std::collections::HashMap;

use glam::{DMat3, DVec2};

use super::corners::Facets;

/// A closed line in a plane: what is enclosed is on its left.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    pub(super) points: Vec<DVec2>,
    /// Negative around holes.
    pub(super) area: f64,
}

/// The area that a polygon encloses, positive if it is counter-clockwise.
pub(super) fn area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

impl Facets {
    /// The rings in which a plane across the z axis of a frame meets the mesh, in the frame's x and
    /// y. Lines that do not close are left out.
    pub(super) fn rings(&self, frame: &DMat3, height: f64) -> Vec<Ring> {
        let to = frame.transpose();
        let side = |i: u32| frame.z_axis.dot(self.at(i)) - height;
        let mut segments = Segments::default();
        for (facet, t) in self.triangles().iter().enumerate() {
            let sides = t.map(side);
            let above = sides.map(|s| s >= 0.0);
            let Some(odd) = (0..3).find(|k| above[*k] != above[(k + 1) % 3] && above[*k] != above[(k + 2) % 3]) else {
                continue;
            };
            let ends = [1, 2].map(|k| {
                let (i, j) = (t[odd], t[(odd + k) % 3]);
                let (a, b) = (sides[odd], sides[(odd + k) % 3]);
                let p = self.at(i) + (self.at(j) - self.at(i)) * (a / (a - b));
                (u64::from(i.min(j)) << 32 | u64::from(i.max(j)), (to * p).truncate())
            });
            let along = frame.z_axis.cross(self.normals[facet]);
            let local = (to * along).truncate();
            let [from, end] = if (ends[1].1 - ends[0].1).dot(local) >= 0.0 { ends } else { [ends[1], ends[0]] };
            segments.add(from.0, end.0, from.1);
        }
        segments.rings()
    }
}

/// Segments from edge to edge, each known by where it begins.
#[derive(Default)]
pub(super) struct Segments {
    /// From the edge where a segment begins to the one where it ends, and the point at its
    /// beginning.
    next: HashMap<u64, (u64, DVec2)>,
    order: Vec<u64>,
}

impl Segments {
    pub(super) fn add(&mut self, from: u64, to: u64, point: DVec2) {
        if self.next.insert(from, (to, point)).is_none() {
            self.order.push(from);
        }
    }

    /// The rings that they close to.
    pub(super) fn rings(mut self) -> Vec<Ring> {
        let mut rings = Vec::new();
        for start in self.order {
            let (mut points, mut at) = (Vec::new(), start);
            while let Some((next, point)) = self.next.remove(&at) {
                points.push(point);
                at = next;
            }
            if at == start && points.len() >= 3 {
                let area = area(&points);
                rings.push(Ring { points, area });
            }
        }
        rings
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Run;

    #[test]
    fn a_tilted_box_has_one_ring() {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64 * 0.7, (i >> 2) as f64 * 0.2);
        let faces: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let frame = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        let facets = Facets::of((0..8).map(|i| frame * corner(i)).collect(), &triangles, &Run::default()).unwrap();
        let rings = facets.rings(&frame, 0.1);
        assert_eq!(rings.len(), 1);
        assert!((rings[0].area - 0.7).abs() < 1e-12);
        let inside_out: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        let facets = Facets::of((0..8).map(|i| frame * corner(i)).collect(), &inside_out, &Run::default()).unwrap();
        assert!((facets.rings(&frame, 0.1)[0].area + 0.7).abs() < 1e-12);
        assert!(facets.rings(&frame, 0.3).is_empty());
    }
}
