//! The loops in which a cell's surface meets the cell's faces, by the signs of its corners.
//!
//! ```text
//!        +-------+         A patch of triangles is bounded by a loop of segments, each of them
//!       /|  a   /|         in a face of the cell and each from a crossed edge to the next. Here
//!      +-*-----+ |         one corner is inside: the loop a, b, c.
//!      |/ \    | |
//!     b*---*c--|-+         A face with inside and outside corners diagonally opposite is
//!      |/      |/          ambiguous: it has two segments. All other crossed faces have one.
//!      o-------+
//! ```
//!
//! The loops are read off the triangles of the [case table](super::table), so that a patch can
//! be replaced by another one with the same boundary. Most cells have a single loop: of the 254
//! cases that are crossed, 162 (the tests count them).

use std::sync::LazyLock;

use super::table::{CaseTable, common_face};

/// The most segments that a loop has.
pub(super) const LONGEST: usize = 7;

/// A loop; the surface is on its left, seen from outside of the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellLoop {
    edges: [u8; LONGEST],
    /// The face that each segment, from its edge to the next, lies in: twice the axis, and 1
    /// more for the upper face.
    faces: [u8; LONGEST],
    len: u8,
    /// The ambiguous faces, as bits.
    ambiguous: u8,
}

impl CellLoop {
    /// The loop of a case, if it has one and no more.
    pub(super) fn single(case: u8) -> Option<&'static CellLoop> {
        static LOOPS: LazyLock<Vec<Option<CellLoop>>> =
            LazyLock::new(|| (0..=255).map(CellLoop::derive).collect());
        LOOPS[usize::from(case)].as_ref()
    }

    /// The edges of the cell that the loop passes, in order.
    pub(super) fn edges(&self) -> &[u8] {
        &self.edges[..usize::from(self.len)]
    }

    /// The number of segments, which is that of edges.
    pub(super) fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// The face of the segment from edge `n` to the next: axis, and whether it is the upper one.
    pub(super) fn face(&self, n: usize) -> (usize, bool) {
        (usize::from(self.faces[n] / 2), self.faces[n] % 2 == 1)
    }

    /// Whether the segment from edge `n` to the next is the only one in its face.
    pub(super) fn is_alone(&self, n: usize) -> bool {
        self.ambiguous >> self.faces[n] & 1 == 0
    }

    fn derive(case: u8) -> Option<CellLoop> {
        let all = loops(case);
        let [edges] = &all[..] else { return None };
        let mut out =
            CellLoop { edges: [0; LONGEST], faces: [0; LONGEST], len: edges.len() as u8, ambiguous: 0 };
        let mut seen = 0u8;
        for (n, &edge) in edges.iter().enumerate() {
            let next = edges[(n + 1) % edges.len()];
            let (axis, upper) = common_face(edge, next)?;
            let face = 2 * axis as u8 + u8::from(upper);
            out.edges[n] = edge;
            out.faces[n] = face;
            out.ambiguous |= seen & 1 << face;
            seen |= 1 << face;
        }
        Some(out)
    }
}

/// All loops of a case, as edges in order.
fn loops(case: u8) -> Vec<Vec<u8>> {
    let triangles = CaseTable::get().triangles(case);
    let sides: Vec<[u8; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let mut open: Vec<[u8; 2]> = sides.iter().copied().filter(|&[a, b]| !sides.contains(&[b, a])).collect();
    let mut loops = Vec::new();
    while let Some([start, mut at]) = open.pop() {
        let mut edges = vec![start];
        while at != start {
            edges.push(at);
            let Some(next) = open.iter().position(|&[a, _]| a == at) else { break };
            at = open.swap_remove(next)[1];
        }
        loops.push(edges);
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn every_crossed_edge_is_in_one_loop_once() {
        for case in 0..=255 {
            let crossed: BTreeSet<u8> = CaseTable::get().triangles(case).iter().flatten().copied().collect();
            let in_loops: Vec<u8> = loops(case).concat();
            assert_eq!(in_loops.len(), crossed.len(), "case {case}");
            assert_eq!(in_loops.into_iter().collect::<BTreeSet<u8>>(), crossed, "case {case}");
        }
    }

    #[test]
    fn single_loops_by_length() {
        let mut lengths = BTreeMap::new();
        for loops in (0..=255).filter_map(CellLoop::single) {
            *lengths.entry(loops.len()).or_insert(0) += 1;
        }
        assert_eq!(lengths.into_iter().collect::<Vec<_>>(), [(3, 16), (4, 30), (5, 48), (6, 44), (7, 24)]);
    }

    #[test]
    fn a_loop_meets_a_face_in_two_segments_only_where_it_is_ambiguous() {
        for case in 0..=255u8 {
            let Some(one) = CellLoop::single(case) else { continue };
            for n in 0..one.len() {
                let (axis, upper) = one.face(n);
                let corners = (0..8u8).filter(|c| (c >> axis & 1 == 1) == upper);
                let inside: Vec<bool> = corners.map(|c| case >> c & 1 == 1).collect();
                let opposite = inside[0] == inside[3] && inside[1] == inside[2];
                assert_eq!(one.is_alone(n), !opposite, "case {case}, segment {n}");
            }
        }
    }
}
