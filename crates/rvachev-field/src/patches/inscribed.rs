//! The largest ball that touches at a point, and holds nothing of some of the patches.
//!
//! ```text
//!      p---               Balls about p − r n, r being less and less, are within each other. So one
//!     / \  \              walk over the boxes will do: where a patch reaches into the ball, the ball
//!    | c |  |             shrinks to touch it there, by r = |p − q|² / 2 (p − q)·n, and goes on.
//!     \ q  /
//! ```

use glam::DVec3;

use super::Patches;
use super::face::double;
use super::hierarchy::PARENT;

/// A patch is asked so often at most while the ball shrinks.
const PATIENCE: usize = 16;

impl Patches {
    /// The radius of the largest ball that touches at `p`, to one side of `normal`, which is to be of length 1, and
    /// holds nothing of the patches that are chosen by their numbers but what reaches into it by less than the part `slack` of its
    /// radius. Nothing if a ball of radius `most` is free of them.
    pub fn inscribed(
        &self,
        p: DVec3,
        normal: DVec3,
        most: f64,
        slack: f64,
        is_chosen: impl Fn(u32) -> bool,
    ) -> Option<f64> {
        let (p, start) = (self.frame.into_local(p), most / self.frame.unit);
        let mut radius = start;
        let mut open = Vec::with_capacity(64);
        open.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            let (low, high) = (double(node.low), double(node.high));
            let centre = p - radius * normal;
            if centre.distance_squared(centre.clamp(low, high)) >= (radius * (1.0 - slack)).powi(2) {
                continue;
            }
            if node.count >= PARENT {
                // What is near to p makes the ball small soonest.
                let [a, b] = [node.first, node.first + 1];
                let away = |child: u32| {
                    let node = &self.nodes[child as usize];
                    p.distance_squared(p.clamp(double(node.low), double(node.high)))
                };
                open.extend(if away(a) <= away(b) { [b, a] } else { [a, b] });
                continue;
            }
            for at in (node.first..node.first + node.count).map(|at| at as usize) {
                if !is_chosen(self.numbers[at]) {
                    continue;
                }
                for _ in 0..PATIENCE {
                    let centre = p - radius * normal;
                    let closest = self.closest(at, centre.to_array());
                    if closest.square >= (radius * (1.0 - slack)).powi(2) {
                        break;
                    }
                    let way = p - (centre - DVec3::from_array(closest.from));
                    let next = way.length_squared() / (2.0 * way.dot(normal));
                    if next.is_nan() || next >= radius {
                        break;
                    }
                    radius = next.max(0.0);
                }
            }
        }
        (radius < start).then_some(radius * self.frame.unit)
    }
}
