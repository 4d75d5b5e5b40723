//! How far patches reach in a direction (their support function).

use glam::DVec3;

use super::Patches;
use super::face::{SLACK, double};
use super::hierarchy::{Node, PARENT};

impl Patches {
    /// The largest `direction · p` over the points p of the patches, or a little more; minus
    /// infinity if there are none.
    pub(super) fn support(&self, direction: DVec3) -> f64 {
        let of_box = |node: &Node| {
            let (low, high) = (double(node.low), double(node.high));
            DVec3::select(direction.cmpge(DVec3::ZERO), high, low).dot(direction)
        };
        let mut farthest = f64::NEG_INFINITY;
        let mut open: Vec<&Node> = Vec::with_capacity(64);
        open.extend(self.nodes.first());
        while let Some(node) = open.pop() {
            let most = of_box(node);
            if most <= farthest {
                continue;
            }
            if node.count >= PARENT {
                let [a, b] = [0, 1].map(|n| &self.nodes[node.first as usize + n]);
                open.extend(if of_box(a) <= of_box(b) { [a, b] } else { [b, a] });
            } else if self.is_flat() {
                for at in (node.first..node.first + node.count).map(|at| at as usize) {
                    let corner = |[s, t]: [f64; 2]| self.point_and_normal(at, s, t).0.dot(direction);
                    farthest = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(corner).into_iter().fold(farthest, f64::max);
                }
            } else {
                farthest = most;
            }
        }
        self.frame.unit * (farthest + SLACK * direction.length()) + self.frame.centre.dot(direction)
    }
}
