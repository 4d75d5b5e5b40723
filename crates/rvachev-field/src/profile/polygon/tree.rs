//! A hierarchy of boxes over the edges of a polygon.

use glam::DVec2;

use super::Edge;

/// Edges in a box that is not divided further.
const FEW: usize = 4;

/// Boxes over edges: each holds either edges or two other boxes.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec2,
    max: DVec2,
    /// The first edge, or the first of the two boxes.
    first: u32,
    /// The number of edges; 0 if there are boxes.
    count: u32,
}

impl Node {
    fn distance_squared(&self, p: DVec2) -> f64 {
        (self.min - p).max(p - self.max).max(DVec2::ZERO).length_squared()
    }
}

/// Boxes that wait: the tree is balanced and so at most 32 deep, and each box leaves one.
const WAITING: usize = 40;

impl Tree {
    /// The tree over `items`, which are put into its order; `ends` gives an item's two ends.
    pub(super) fn build<T>(items: &mut [T], ends: impl Fn(&T) -> [DVec2; 2]) -> Tree {
        let mut nodes = Vec::new();
        let mut open = Vec::new();
        if !items.is_empty() {
            nodes.push(Node { min: DVec2::ZERO, max: DVec2::ZERO, first: 0, count: 0 });
            open.push((0, 0..items.len()));
        }
        while let Some((at, range)) = open.pop() {
            let part = &mut items[range.clone()];
            let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for [a, b] in part.iter().map(&ends) {
                min = min.min(a).min(b);
                max = max.max(a).max(b);
            }
            if part.len() <= FEW {
                nodes[at] = Node { min, max, first: range.start as u32, count: part.len() as u32 };
                continue;
            }
            let axis = usize::from(max.y - min.y > max.x - min.x);
            let middle = part.len() / 2;
            let key = |item: &T| {
                let [a, b] = ends(item);
                a[axis] + b[axis]
            };
            part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
            let first = nodes.len();
            nodes[at] = Node { min, max, first: first as u32, count: 0 };
            nodes.extend([nodes[at]; 2]);
            open.push((first, range.start..range.start + middle));
            open.push((first + 1, range.start + middle..range.end));
        }
        Tree { nodes }
    }

    /// The edge nearest to `p` and the distance to it. `guess` is the number of an edge that is
    /// thought to be near.
    pub(super) fn nearest(&self, edges: &[Edge], p: DVec2, guess: usize) -> Option<(usize, f64)> {
        let mut best = (guess, edges.get(guess)?.distances(p.x, p.y).0);
        let mut stack = [(0, 0.0); WAITING];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (at, distance): (u32, f64) = stack[height];
            if distance > best.1 * best.1 {
                continue;
            }
            let node = self.nodes[at as usize];
            if node.count > 0 {
                for i in node.first..node.first + node.count {
                    let (distance, _) = edges[i as usize].distances(p.x, p.y);
                    if distance < best.1 {
                        best = (i as usize, distance);
                    }
                }
                continue;
            }
            let [a, b] = [node.first, node.first + 1].map(|i| (i, self.nodes[i as usize].distance_squared(p)));
            let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
            stack[height] = far;
            stack[height + 1] = near;
            height += 2;
        }
        Some(best)
    }

    /// Calls `visit` with the numbers of all edges whose boxes are within `radius` of `p`, and
    /// perhaps some more, until it returns false.
    pub(super) fn within(&self, p: DVec2, radius: f64, mut visit: impl FnMut(usize) -> bool) {
        self.walk(|node| node.distance_squared(p) <= radius * radius, &mut visit);
    }

    /// The same for all edges whose boxes meet the box from `min` to `max`.
    pub(super) fn meeting(&self, min: DVec2, max: DVec2, mut visit: impl FnMut(usize) -> bool) {
        self.walk(|node| node.min.cmple(max).all() && min.cmple(node.max).all(), &mut visit);
    }

    fn walk(&self, near: impl Fn(&Node) -> bool, visit: &mut dyn FnMut(usize) -> bool) {
        let mut stack = [0u32; WAITING];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let node = self.nodes[stack[height] as usize];
            if !near(&node) {
                continue;
            }
            if node.count == 0 {
                stack[height] = node.first;
                stack[height + 1] = node.first + 1;
                height += 2;
                continue;
            }
            for i in node.first..node.first + node.count {
                if !visit(i as usize) {
                    return;
                }
            }
        }
    }
}
