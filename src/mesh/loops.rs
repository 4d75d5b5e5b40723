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
//!
//!      o---+---.           An ambiguous face       o---+---.
//!      |  /    |           in the table: the       |    \  |
//!      + /     +           inside corners o        +     \ +
//!      |     / |           are separate. Joined:   |\      |
//!      .---+---o           the outside ones are.   .-+-----o
//! ```
//!
//! The loops are read off the triangles of the [case table](super::table), so that a patch can be
//! replaced by another one with the same boundary; where a face joins its inside corners, its two
//! segments exchange their ends. Of the 254 cases that are crossed, 162 have a single loop in the
//! table (the tests count them).

use std::sync::LazyLock;

use super::table::{CaseTable, common_face};

/// The most segments that a loop has: it passes an edge once.
pub(super) const LONGEST: usize = 12;

/// The most segments that the loop of a case has that has a single one in the table.
pub(super) const MOST: usize = 7;

/// A loop; the surface is on its left, seen from outside of the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellLoop {
    edges: [u8; LONGEST],
    /// The face that each segment, from its edge to the next, lies in: twice the axis, and 1
    /// more for the upper face.
    faces: [u8; LONGEST],
    len: u8,
    /// Of a case that has a single loop in the table, its triangles, their corners by the places of
    /// their edges in the loop.
    triangles: [[u8; 3]; MOST - 2],
}

impl CellLoop {
    /// The loop of a case, if it has one and no more. `joined` has a bit for each ambiguous face
    /// whose inside corners are joined.
    #[inline]
    pub(super) fn single(case: u8, joined: u8) -> Option<CellLoop> {
        if joined == 0 { CellLoop::table()[usize::from(case)] } else { CellLoop::derive(case, joined) }
    }

    /// The loops that cases have in the table, if they have one and no more.
    #[inline]
    pub(super) fn table() -> &'static [Option<CellLoop>; 256] {
        static LOOPS: LazyLock<[Option<CellLoop>; 256]> =
            LazyLock::new(|| std::array::from_fn(|case| CellLoop::listed(case as u8)));
        &LOOPS
    }

    /// The loop of a case that has one in the table, with its triangles there.
    fn listed(case: u8) -> Option<CellLoop> {
        let mut outline = CellLoop::derive(case, 0)?;
        let place = |edge: u8| outline.edges().iter().position(|&other| other == edge).map_or(0, |place| place as u8);
        let triangles = CaseTable::get().triangles(case);
        let triangles = std::array::from_fn(|n| triangles.get(n).map_or([0; 3], |triangle| triangle.map(place)));
        outline.triangles = triangles;
        Some(outline)
    }

    /// All loops of a case.
    pub(super) fn all(case: u8, joined: u8) -> impl Iterator<Item = CellLoop> {
        loops(case, joined).into_iter().map(|segments| CellLoop::new(&segments))
    }

    /// The edges of the cell that the loop passes, in order.
    #[inline]
    pub(super) fn edges(&self) -> &[u8] {
        &self.edges[..usize::from(self.len)]
    }

    /// The number of segments, which is that of edges.
    #[inline]
    pub(super) fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// The face of the segment from edge `n` to the next: twice its axis, and 1 more for the upper
    /// one.
    #[inline]
    pub(super) fn face(&self, n: usize) -> u8 {
        self.faces[n]
    }

    /// The triangles of a [listed](CellLoop::table) loop of `N`, their corners by places in the
    /// loop.
    #[inline(always)]
    pub(super) fn triangles<const N: usize>(&self) -> &[[u8; 3]] {
        &self.triangles[..N - 2]
    }

    fn derive(case: u8, joined: u8) -> Option<CellLoop> {
        let all = loops(case, joined);
        let [segments] = &all[..] else { return None };
        Some(CellLoop::new(segments))
    }

    fn new(segments: &[Segment]) -> CellLoop {
        let (edges, faces, triangles) = ([0; LONGEST], [0; LONGEST], [[0; 3]; MOST - 2]);
        let mut out = CellLoop { edges, faces, len: segments.len() as u8, triangles };
        for (n, segment) in segments.iter().enumerate() {
            out.edges[n] = segment.from;
            out.faces[n] = segment.face;
        }
        out
    }
}

/// The ambiguous faces of all cases, as bits.
#[inline]
pub(super) fn ambiguous_faces() -> &'static [u8; 256] {
    static FACES: LazyLock<[u8; 256]> = LazyLock::new(|| {
        let is_ambiguous = |case: u8, face: u8| {
            let corners = (0..8u8).filter(|c| c >> (face / 2) & 1 == face % 2);
            let inside: Vec<bool> = corners.map(|c| case >> c & 1 == 1).collect();
            inside[0] == inside[3] && inside[1] == inside[2] && inside[0] != inside[1]
        };
        let faces = |case| (0..6).fold(0, |bits, face| bits | u8::from(is_ambiguous(case, face)) << face);
        std::array::from_fn(|case| faces(case as u8))
    });
    &FACES
}

/// A segment, from edge to edge in a face.
#[derive(Clone, Copy)]
struct Segment {
    from: u8,
    to: u8,
    face: u8,
}

/// All loops of a case.
fn loops(case: u8, joined: u8) -> Vec<Vec<Segment>> {
    let triangles = CaseTable::get().triangles(case);
    let sides: Vec<[u8; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let outer = sides.iter().filter(|[a, b]| !sides.contains(&[*b, *a]));
    let mut open: Vec<Segment> = outer
        .filter_map(|&[from, to]| {
            let (axis, upper) = common_face(from, to)?;
            Some(Segment { from, to, face: 2 * axis as u8 + u8::from(upper) })
        })
        .collect();
    for face in (0..6).filter(|face| joined >> face & 1 == 1) {
        let mut both = (0..open.len()).filter(|&n| open[n].face == face);
        if let (Some(a), Some(b)) = (both.next(), both.next()) {
            (open[a].to, open[b].to) = (open[b].to, open[a].to);
        }
    }
    let mut loops = Vec::new();
    while let Some(first) = open.pop() {
        let mut segments = vec![first];
        let mut at = first.to;
        while let Some(next) = open.iter().position(|segment| segment.from == at) {
            let segment = open.swap_remove(next);
            at = segment.to;
            segments.push(segment);
        }
        loops.push(segments);
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn every_crossed_edge_is_in_one_loop_once_however_faces_are_joined() {
        for case in 0..=255 {
            let crossed: BTreeSet<u8> = CaseTable::get().triangles(case).iter().flatten().copied().collect();
            let faces = ambiguous_faces()[usize::from(case)];
            for joined in (0..64).filter(|joined| joined & !faces == 0) {
                let all = loops(case, joined);
                let passed: Vec<u8> = all.concat().iter().map(|segment| segment.from).collect();
                assert_eq!(passed.len(), crossed.len(), "case {case}");
                assert_eq!(passed.into_iter().collect::<BTreeSet<u8>>(), crossed, "case {case}");
                for one in all {
                    assert_eq!(one.last().map(|segment| segment.to), one.first().map(|segment| segment.from));
                }
            }
        }
    }

    #[test]
    fn every_loop_bounds_a_disc() {
        // A disc with n corners has n − 2 triangles, a tube between two loops more.
        for case in 0..=255 {
            let discs: usize = CellLoop::all(case, 0).map(|outline| outline.len() - 2).sum();
            assert_eq!(discs, CaseTable::get().triangles(case).len(), "case {case}");
        }
    }

    #[test]
    fn single_loops_by_length() {
        let mut lengths = BTreeMap::new();
        for one in (0..=255).filter_map(|case| CellLoop::single(case, 0)) {
            *lengths.entry(one.len()).or_insert(0) += 1;
        }
        assert_eq!(lengths.into_iter().collect::<Vec<_>>(), [(3, 16), (4, 30), (5, 48), (6, 44), (7, 24)]);
    }

    #[test]
    fn listed_loops_have_the_triangles_of_the_table() {
        for case in 0..=255 {
            let Some(outline) = &CellLoop::table()[usize::from(case)] else { continue };
            let triangles = match outline.len() {
                3 => outline.triangles::<3>(),
                4 => outline.triangles::<4>(),
                5 => outline.triangles::<5>(),
                6 => outline.triangles::<6>(),
                _ => outline.triangles::<7>(),
            };
            let edges = triangles.iter().map(|triangle| triangle.map(|n| outline.edges()[usize::from(n)]));
            assert_eq!(edges.collect::<Vec<_>>(), CaseTable::get().triangles(case));
        }
    }

    #[test]
    fn a_face_has_two_segments_where_it_is_ambiguous_and_else_one() {
        for case in 0..=255 {
            let faces = ambiguous_faces()[usize::from(case)];
            for joined in [0, faces] {
                let segments = loops(case, joined).concat();
                for face in 0..6 {
                    let count = segments.iter().filter(|segment| segment.face == face).count();
                    assert!(count <= 2 && (count == 2) == (faces >> face & 1 == 1), "case {case}, face {face}");
                }
            }
        }
    }

    #[test]
    fn segments_of_a_face_do_not_cross() {
        // The ends around a face, in turn: two segments cross if their ends alternate.
        for case in 0..=255 {
            let faces = ambiguous_faces()[usize::from(case)];
            for joined in [0, faces] {
                let segments = loops(case, joined).concat();
                for face in (0..6).filter(|face| faces >> face & 1 == 1) {
                    let ends: Vec<[u8; 2]> =
                        segments.iter().filter(|s| s.face == face).map(|s| [s.from, s.to]).collect();
                    // Opposite sides of a face are parallel: a segment that joins two would cross.
                    for [a, b] in ends {
                        assert_ne!(a / 4, b / 4, "case {case}, face {face}");
                    }
                }
            }
        }
    }
}
