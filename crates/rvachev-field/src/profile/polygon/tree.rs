//! A hierarchy of boxes over the edges of a polygon.
//!
//! ```text
//!         / / / /       One box lies along its edges: about the teeth of a comb and the rays of a
//!        / / / /        fan, whichever way they lead, there is little room in it. Another one lies
//!       /_/ /_/         along the axes: it ends where rays begin. Edges are parted where their
//!                       middles are spread most, which is from tooth to tooth.
//! ```

use glam::DVec2;

use super::Edge;

/// Edges in a box that is not divided further.
const FEW: usize = 4;

/// What a box is smaller than its edges, in proportion, and how much farther it is taken to be than
/// it is found to be: as much as rounding. Of edges that meet in a corner that is nearest one is
/// enough.
const SMALLER: f64 = 2.0 * f64::EPSILON;
const FARTHER: f64 = 1.0 + 8.0 * f64::EPSILON;

/// Boxes over edges, two about the same: each pair holds either edges or two other boxes.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec2,
    max: DVec2,
    centre: DVec2,
    /// A direction of the other box.
    along: DVec2,
    half: DVec2,
    /// The first edge, or the first of the two boxes.
    first: u32,
    /// The number of edges; 0 if there are boxes.
    count: u32,
}

impl Node {
    /// The box about edges, without what it holds.
    fn about<T>(items: &[T], of: impl Fn(&T) -> &Edge) -> Node {
        let edges = || items.iter().map(&of);
        let origin = edges().next().map_or(DVec2::ZERO, |edge| edge.start);
        // Directions have no sense: twice the angle tells them.
        let twice = edges()
            .fold(DVec2::ZERO, |sum, edge| sum + (edge.end - edge.start).length() * edge.along.rotate(edge.along));
        let along = DVec2::from_angle(0.5 * twice.to_angle());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in edges().flat_map(|edge| [edge.start, edge.end]) {
            (min, max) = (min.min(p), max.max(p));
            let p = seen(along, p - origin);
            (low, high) = (low.min(p), high.max(p));
        }
        let centre = origin + along.rotate(0.5 * (low + high));
        let half = 0.5 * (high - low);
        let half = (half - SMALLER * (half.max_element() + (centre - origin).length())).max(DVec2::ZERO);
        Node { min, max, centre, along, half, first: 0, count: 0 }
    }

    fn distance_squared(&self, p: DVec2) -> f64 {
        let by_axes = (self.min - p).max(p - self.max).max(DVec2::ZERO).length_squared();
        let along = (seen(self.along, p - self.centre).abs() - self.half).max(DVec2::ZERO).length_squared();
        by_axes.max(FARTHER * along)
    }

    /// The direction in which the middles of the edges are spread most.
    fn spread<'e>(&self, edges: impl Iterator<Item = &'e Edge>) -> DVec2 {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for edge in edges {
            let middle = seen(self.along, edge.middle() - self.centre);
            (low, high) = (low.min(middle), high.max(middle));
        }
        let spread = high - low;
        if spread.x > spread.y { self.along } else { self.along.perp() }
    }
}

/// A vector by its parts along a direction and across it.
fn seen(along: DVec2, v: DVec2) -> DVec2 {
    DVec2::new(along.dot(v), along.perp_dot(v))
}

/// Boxes that wait: the tree is balanced and so at most 32 deep, and each box leaves one.
const WAITING: usize = 40;

impl Tree {
    /// The tree over edges, `of` items, which are put into its order.
    pub(super) fn build<T>(edges: &mut [T], of: impl Fn(&T) -> &Edge) -> Tree {
        let mut nodes = Vec::new();
        let mut open = Vec::new();
        if !edges.is_empty() {
            nodes.push(Node::about(edges, &of));
            open.push((0, 0..edges.len()));
        }
        while let Some((at, range)) = open.pop() {
            let part = &mut edges[range.clone()];
            if part.len() <= FEW {
                (nodes[at].first, nodes[at].count) = (range.start as u32, part.len() as u32);
                continue;
            }
            let (middle, way) = (part.len() / 2, nodes[at].spread(part.iter().map(&of)));
            let key = |item: &T| way.dot(of(item).middle());
            part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
            let first = nodes.len();
            nodes[at].first = first as u32;
            let (before, after) = part.split_at(middle);
            nodes.extend([before, after].map(|part| Node::about(part, &of)));
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
            if distance >= best.1 * best.1 {
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
        let mut stack = [0u32; WAITING];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let node = self.nodes[stack[height] as usize];
            if node.distance_squared(p) > radius * radius {
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
