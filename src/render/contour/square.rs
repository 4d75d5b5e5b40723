//! Squares of a plane, halved and halved again (a quadtree), by whole numbers.

use glam::DVec2;

/// So often the first square is halved at most.
pub(super) const DEEPEST: u32 = 30;

/// A corner of squares: its coordinates, in the smallest squares.
pub(super) type Node = [u32; 2];

/// The square that all others are parts of.
#[derive(Clone, Copy)]
pub(super) struct Root {
    pub(super) low: DVec2,
    pub(super) side: f64,
}

impl Root {
    pub(super) fn point(&self, node: Node) -> DVec2 {
        let scale = self.side / f64::from(1u32 << DEEPEST);
        self.low + scale * DVec2::new(f64::from(node[0]), f64::from(node[1]))
    }

    /// The square itself.
    pub(super) fn square(&self) -> Square {
        Square { node: [0; 2], size: 1 << DEEPEST, low: self.low, side: self.side }
    }
}

/// A square: its lowest corner and its side, by whole numbers and in lengths.
#[derive(Clone, Copy)]
pub(super) struct Square {
    pub(super) node: Node,
    pub(super) size: u32,
    pub(super) low: DVec2,
    pub(super) side: f64,
}

impl Square {
    pub(super) fn centre(&self) -> DVec2 {
        self.low + 0.5 * self.side
    }

    /// How far it is from a point to where a line along `way` leaves it; 0 from beyond.
    pub(super) fn exit(&self, p: DVec2, way: DVec2) -> f64 {
        let to = |from: f64, along: f64| {
            let side = if along > 0.0 { self.side - from } else { from };
            if along == 0.0 { f64::INFINITY } else { side / along.abs() }
        };
        let from = p - self.low;
        to(from.x, way.x).min(to(from.y, way.y)).max(0.0)
    }

    /// Its corners, anticlockwise from the lowest.
    pub(super) fn corners(&self) -> [Node; 4] {
        let ([x, y], size) = (self.node, self.size);
        [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]
    }

    /// The corners that its quarters add: in the middle of it, and of its sides.
    pub(super) fn added(&self) -> [Node; 5] {
        let ([x, y], size) = (self.node, self.size);
        let half = size / 2;
        [[x + half, y + half], [x + half, y], [x + size, y + half], [x + half, y + size], [x, y + half]]
    }

    /// Its quarters.
    pub(super) fn quarters(&self, root: &Root) -> [Square; 4] {
        let ([x, y], size) = (self.node, self.size / 2);
        [[x, y], [x + size, y], [x, y + size], [x + size, y + size]].map(|node| Square {
            node,
            size,
            low: root.point(node),
            side: 0.5 * self.side,
        })
    }
}
