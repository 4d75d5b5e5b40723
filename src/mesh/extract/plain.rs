//! What cells without fans have.

use glam::Vec3;

use crate::mesh::bulk::Bulk;
use crate::mesh::feature::Segment;

/// The triangles of cells without fans.
#[derive(Default)]
pub(super) struct Plain {
    pub(super) triangles: Bulk<[u32; 3]>,
    /// Positions and normals of vertices in the middle of smooth cells. They follow those on edges.
    pub(super) tops: [Bulk<Vec3>; 2],
    /// The first triangle around each of them that is to be numbered anew if others come before it,
    /// and how many.
    pub(super) around: Vec<(u32, u32)>,
}

impl Plain {
    /// Makes room for what cells have, given how many triangles the table has for them: vertices in
    /// the middle of cells make it more, and fans are to follow. It is seldom more than three
    /// quarters more; then the lists grow as they must.
    pub(super) fn make_room(&mut self, in_table: usize) {
        self.triangles.reserve_exact(in_table / 4 * 7);
        self.tops.iter_mut().for_each(|tops| tops.reserve_exact(in_table / 4));
    }

    /// The memory, with nothing in it.
    pub(super) fn cleared(mut self) -> Plain {
        self.triangles.clear();
        self.tops.iter_mut().for_each(|tops| tops.clear());
        self.around.clear();
        self
    }

    /// Adds a vertex in the middle of a cell, and triangles from it to the loop of the cell; there
    /// are so many vertices on edges.
    #[inline(always)]
    pub(super) fn add_top<const N: usize>(&mut self, at: Vec3, normal: Vec3, vertices: [u32; N], on_edges: u32) {
        let top = on_edges.wrapping_add(self.tops[0].len() as u32);
        self.tops[0].push(at);
        self.tops[1].push(normal);
        self.around.push((self.triangles.len() as u32, N as u32));
        let triangles: [_; N] = std::array::from_fn(|n| [top, vertices[n], vertices[(n + 1) % N]]);
        self.triangles.extend_from_slice(&triangles);
    }

    /// The same, given the segments of the loop, of three to seven.
    #[inline(always)]
    pub(super) fn add_top_of(&mut self, at: Vec3, normal: Vec3, ring: &[Segment], on_edges: u32) {
        let from = |segment: &Segment| segment.from;
        match ring {
            [a, b, c] => self.add_top(at, normal, [a, b, c].map(from), on_edges),
            [a, b, c, d] => self.add_top(at, normal, [a, b, c, d].map(from), on_edges),
            [a, b, c, d, e] => self.add_top(at, normal, [a, b, c, d, e].map(from), on_edges),
            [a, b, c, d, e, f] => self.add_top(at, normal, [a, b, c, d, e, f].map(from), on_edges),
            [a, b, c, d, e, f, g, ..] => self.add_top(at, normal, [a, b, c, d, e, f, g].map(from), on_edges),
            _ => {}
        }
    }
}
