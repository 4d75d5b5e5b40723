//! What openings add to winding numbers, at most.
//!
//! ```text
//!       o---o          The rim falls into loops, and triangles from a loop's middle to its edges close it. With all of
//!      / \ / \         these the winding number is whole, and 0 outside of the box. So what it is there is what the
//!     o---+---o        closing triangles have, with the other sign: of area A, and d away, at most A / 4π d² each.
//!      \ / \ /
//!       o---o
//! ```
//!
//! From several sizes away that is much less than the rim's length tells: small openings add as
//! little as they let out, however many there are.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::DVec3;
use rvachev_num::{Cancelled, Run};

use super::super::face::double;
use super::super::hierarchy::PARENT;
use super::super::{Patch, Patches};
use super::rim::OpenEdge;

/// From as many sizes away a box of triangles counts as one.
const FAR: f64 = 2.0;

/// Triangles that close openings.
pub(super) struct Gaps {
    triangles: Patches,
    /// The area in each box, and of each triangle, in the frame of the triangles.
    boxes: Vec<f64>,
    areas: Vec<f64>,
}

impl Gaps {
    pub(super) fn new(open: &[OpenEdge], run: &Run) -> Result<Gaps, Cancelled> {
        let mut flat = Vec::new();
        for ring in rings(open) {
            run.check()?;
            let middle = ring.iter().sum::<DVec3>() / ring.len() as f64;
            flat.extend((0..ring.len()).map(|n| Patch::flat([middle, ring[n], ring[(n + 1) % ring.len()]])));
        }
        let triangles = Patches::new(&flat, run)?;
        let area = |at: usize| {
            let sides = &triangles.sides[at];
            0.5 * double(sides.e).cross(double(sides.f)).length()
        };
        let areas: Vec<f64> = (0..triangles.len()).map(area).collect();
        let mut boxes = vec![0.0; triangles.nodes.len()];
        // Children come after their parents.
        for (at, node) in triangles.nodes.iter().enumerate().rev() {
            let first = node.first as usize;
            boxes[at] = if node.count >= PARENT {
                boxes[first] + boxes[first + 1]
            } else {
                areas[first..first + node.count as usize].iter().sum()
            };
        }
        Ok(Gaps { triangles, boxes, areas })
    }

    /// How far from 0 the winding number is at most in a box that is outside of the box of all
    /// triangles.
    pub(super) fn most(&self, centre: DVec3, half: DVec3) -> f64 {
        let frame = &self.triangles.frame;
        let (low, high) = (frame.into_local(centre - half), frame.into_local(centre + half));
        let square = |from: DVec3, to: DVec3| (low - to).max(from - high).max(DVec3::ZERO).length_squared();
        let mut sum = 0.0;
        let mut open = Vec::new();
        open.extend((!self.boxes.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let node = &self.triangles.nodes[at];
            let (from, to) = (double(node.low), double(node.high));
            let away = square(from, to);
            let first = node.first as usize;
            if away > (FAR * FAR) * (to - from).length_squared() {
                sum += self.boxes[at] / away;
            } else if node.count >= PARENT {
                open.extend([first, first + 1]);
            } else {
                for at in first..first + node.count as usize {
                    let (face, sides) = (&self.triangles.faces[at], &self.triangles.sides[at]);
                    let [a, e, f] = [face.a, sides.e, sides.f].map(double);
                    let (b, c) = (a + e, a + f);
                    sum += self.areas[at] / square(a.min(b).min(c), a.max(b).max(c));
                }
            }
            // More tells nothing, and neither does NaN.
            if sum.is_nan() || sum > 4.0 * PI {
                return f64::INFINITY;
            }
        }
        sum / (4.0 * PI)
    }
}

/// The closed ways along open edges, each as often as triangles are missing.
fn rings(open: &[OpenEdge]) -> Vec<Vec<DVec3>> {
    let mut from: HashMap<u32, Vec<usize>> = HashMap::new();
    for (n, edge) in open.iter().enumerate() {
        from.entry(edge.vertices[0]).or_default().push(n);
    }
    let mut left: Vec<u32> = open.iter().map(|edge| edge.missing).collect();
    let mut found = Vec::new();
    for start in 0..open.len() {
        while left[start] > 0 {
            // As many edges end at a vertex as start there: a way that goes on comes back to where
            // it has been.
            let mut way = vec![start];
            let mut places = HashMap::from([(open[start].vertices[0], 0)]);
            left[start] -= 1;
            while let Some(&last) = way.last() {
                let at = open[last].vertices[1];
                if let Some(&place) = places.get(&at) {
                    let ring: Vec<usize> = way.split_off(place);
                    ring.iter().for_each(|n| _ = places.remove(&open[*n].vertices[0]));
                    found.push(ring.into_iter().map(|n| open[n].ends[0]).collect());
                }
                if way.is_empty() {
                    break;
                }
                let next = from.get(&at).and_then(|edges| edges.iter().copied().find(|n| left[*n] > 0));
                let Some(next) = next else { break };
                places.insert(at, way.len());
                way.push(next);
                left[next] -= 1;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::rim::open_edges;
    use super::*;

    /// A sheet of n × n squares in the plane z = 0, but for those that are left out.
    fn sheet(n: u32, has: impl Fn(u32, u32) -> bool) -> Vec<OpenEdge> {
        let at = |v: u32| Vec3::new((v % (n + 1)) as f32, (v / (n + 1)) as f32, 0.0);
        let positions: Vec<Vec3> = (0..(n + 1) * (n + 1)).map(at).collect();
        let squares = (0..n * n).map(|k| (k % n, k / n)).filter(|(i, j)| has(*i, *j));
        let triangles: Vec<[u32; 3]> = squares
            .flat_map(|(i, j)| {
                let a = i + j * (n + 1);
                [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
            })
            .collect();
        open_edges(&positions, &triangles, &Run::default()).unwrap()
    }

    #[test]
    fn the_rim_falls_into_loops() {
        // The outer one and two squares of four edges each, which meet in a corner.
        let open = sheet(6, |i, j| !matches!((i, j), (2, 2) | (3, 3)));
        let mut lengths: Vec<usize> = rings(&open).iter().map(Vec::len).collect();
        lengths.sort_unstable();
        assert!(lengths == [4, 4, 24] || lengths == [8, 24], "{lengths:?}");
        assert!(rings(&[]).is_empty());
    }

    #[test]
    fn no_winding_number_is_larger() {
        let gaps = Gaps::new(&sheet(4, |_, _| true), &Run::default()).unwrap();
        // Above the middle of a square of side 4 the solid angle is 4 asin(a² / (a² + h²)), a half
        // of the side.
        for height in [1.0_f64, 3.0, 10.0, 40.0] {
            let exact = 4.0 * (4.0 / (4.0 + height * height)).asin() / (4.0 * PI);
            let most = gaps.most(DVec3::new(2.0, 2.0, height), DVec3::ZERO);
            assert!(most >= exact, "{most} for {exact}");
            assert!(height < 10.0 || most < 1.3 * exact, "{most} for {exact}");
        }
        assert_eq!(gaps.most(DVec3::new(2.0, 2.0, 0.5), DVec3::ONE), f64::INFINITY);
    }
}
