//! The marching-cubes case table: which triangles a cell holds, by the signs of its corners.
//!
//! ```text
//!          6-------[3]-------7          Corner c is at (c & 1, c >> 1 & 1, c >> 2).
//!         /|                /|
//!       [6]|              [7]|          Edges, in brackets, are numbered by axis, and within
//!       / [10]            / [11]        an axis in the order of their lower ends, the base
//!      4-------[2]-------5   |          corners:
//!      |   |             |   |
//!      |   2-------[1]---|---3            along x   [0] 0–1   [1] 2–3   [2] 4–5   [3] 6–7
//!     [8] /             [9] /             along y   [4] 0–2   [5] 1–3   [6] 4–6   [7] 5–7
//!      |[4]              |[5]             along z   [8] 0–4   [9] 1–5  [10] 2–6  [11] 3–7
//!      |/                |/
//!      0-------[0]-------1              z
//!                                       | y      A case is a byte: bit c is set if corner c
//!                                       |/       is inside (value > 0).
//!                                       +-- x
//! ```
//!
//! The triangles come from the `isosurface` crate: its extractor is run on a single cell with
//! ±1 in the corners, where every vertex is the middle of an edge and names it. Only the
//! connectivity is taken over. Each patch (triangles that hang together by edges) is turned
//! here such that its normals point from inside to outside, as follows: along a boundary
//! segment of the patch, in a face with outward normal m, the surface goes on in the direction
//! −m, so a triangle that runs along the segment with direction d has a normal on the side of
//! m × d, and that must be the side of the outside corners.
//!
//! What the tests below show for all 256 cases, and with them for every mesh that is put
//! together from them on one lattice with the same signs:
//!
//! * within the cell, edges of triangles pair up, in opposite directions, and none of them lies
//!   in a face of the cell;
//! * on a face, the segments depend on the four signs of the face alone, and the cells on its
//!   two sides run along them in opposite directions: the mesh is closed and consistently
//!   oriented;
//! * the triangles of a cell do not cross, wherever on the edges the vertices are: the mesh is free
//!   of self-intersection, as no triangle lies in a face and cells have no more than faces in
//!   common;
//! * the triangles of a cell at one vertex form a single path between the two faces that meet
//!   there: the four cells around a lattice edge close it to one ring, so that vertices are
//!   manifold.
//!
//! Limits: the table resolves ambiguous faces by the signs alone, always in the same way, so the
//! topology may differ from that of the trilinear interpolant; it is a valid one all the same.
//!
//! Source: W. E. Lorensen and H. E. Cline, Marching cubes (1987), with the consistent table of
//! P. Bourke, Polygonising a scalar field (1994), as carried by `isosurface`.

use std::sync::LazyLock;

use isosurface::MarchingCubes;
use isosurface::distance::Signed;
use isosurface::extractor::Extractor;
use isosurface::math::Vec3 as Point;
use isosurface::sampler::Sample;

/// The two corners of every edge, the base corner first.
pub(crate) const EDGE_CORNERS: [[u8; 2]; 12] = edge_corners();

const fn edge_corners() -> [[u8; 2]; 12] {
    let mut out = [[0; 2]; 12];
    let mut edge = 0;
    while edge < 12 {
        let (axis, nth) = (edge as u8 / 4, edge as u8 % 4);
        let (low, high) = (nth & 1, nth >> 1);
        // The bits of the base corner along the two other axes.
        let base = match axis {
            0 => low << 1 | high << 2,
            1 => low | high << 2,
            _ => low | high << 1,
        };
        out[edge] = [base, base | 1 << axis];
        edge += 1;
    }
    out
}

/// The axis along which an edge runs.
pub(crate) const fn edge_axis(edge: u8) -> u8 {
    edge / 4
}

/// The triangles of all 256 cases, as triples of edges.
pub(crate) struct CaseTable {
    /// Case c has the triangles from `starts[c]` to `starts[c + 1]`.
    starts: [u16; 257],
    triangles: Vec<[u8; 3]>,
}

impl CaseTable {
    /// The table, derived when it is first asked for.
    pub(crate) fn get() -> &'static CaseTable {
        static TABLE: LazyLock<CaseTable> = LazyLock::new(CaseTable::derive);
        &TABLE
    }

    /// The triangles of a case; their corners are on the given edges, anticlockwise seen
    /// from outside.
    #[inline]
    pub(crate) fn triangles(&self, case: u8) -> &[[u8; 3]] {
        let case = usize::from(case);
        &self.triangles[usize::from(self.starts[case])..usize::from(self.starts[case + 1])]
    }

    fn derive() -> CaseTable {
        let mut starts = [0; 257];
        let mut triangles = Vec::with_capacity(840);
        for case in 0..=255u8 {
            let mut patch = connectivity(case);
            orient(case, &mut patch);
            triangles.append(&mut patch);
            starts[usize::from(case) + 1] = triangles.len() as u16;
        }
        CaseTable { starts, triangles }
    }
}

/// A cell with ±1 in its corners, for the `isosurface` crate.
struct Cell(u8);

impl Sample<Signed> for Cell {
    fn sample(&self, p: Point) -> Signed {
        // The traversal goes one layer of cells too far, to z = 2. There the top face is
        // repeated, which puts no vertex between z = 1 and z = 2.
        let bit = |x: f32, n: u8| u8::from(x > 0.5) << n;
        let corner = bit(p.x, 0) | bit(p.y, 1) | bit(p.z, 2);
        // Inside is negative there.
        Signed(if self.0 >> corner & 1 == 1 { -1.0 } else { 1.0 })
    }
}

/// What the `isosurface` crate makes of a cell.
#[derive(Default)]
struct Output {
    vertices: Vec<Point>,
    indices: Vec<usize>,
}

impl Extractor for Output {
    fn extract_vertex(&mut self, vertex: Point) {
        self.vertices.push(vertex);
    }

    fn extract_index(&mut self, index: usize) {
        self.indices.push(index);
    }
}

/// The triangles of a case, oriented anyhow.
fn connectivity(case: u8) -> Vec<[u8; 3]> {
    let mut output = Output::default();
    MarchingCubes::<Signed>::new(2).extract(&Cell(case), &mut output);
    let (corners, _) = output.indices.as_chunks::<3>();
    // A vertex above z = 1 is on no edge of the cell, which drops the second layer.
    let edge = |i: usize| output.vertices.get(i).copied().and_then(edge_with_middle);
    corners.iter().filter_map(|&[a, b, c]| Some([edge(a)?, edge(b)?, edge(c)?])).collect()
}

/// The edge that has its middle at a point, if there is one.
fn edge_with_middle(p: Point) -> Option<u8> {
    let twice = [2.0 * p.x, 2.0 * p.y, 2.0 * p.z];
    (0..12).find(|&edge| doubled_middle(edge).map(|x| x as f32) == twice)
}

/// The position of a corner, in cells.
fn corner_position(corner: u8) -> [i32; 3] {
    [0, 1, 2].map(|axis| i32::from(corner >> axis & 1))
}

/// Twice the position of the middle of an edge, in cells.
fn doubled_middle(edge: u8) -> [i32; 3] {
    let [a, b] = EDGE_CORNERS[usize::from(edge)].map(corner_position);
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// The face that two edges have in common, as its axis and whether it is the upper one.
/// Edges that are at a right angle have at most one; of parallel edges, those that are
/// diagonally opposite have none.
pub(super) fn common_face(a: u8, b: u8) -> Option<(usize, bool)> {
    let (a, b) = (doubled_middle(a), doubled_middle(b));
    (0..3).find(|&axis| a[axis] == b[axis] && a[axis] != 1).map(|axis| (axis, a[axis] == 2))
}

/// Turns the triangles of a case such that their normals point from inside to outside.
fn orient(case: u8, triangles: &mut [[u8; 3]]) {
    // Triangles that lie along a face know their orientation. It spreads from them.
    let mut done: Vec<bool> = triangles
        .iter_mut()
        .map(|t| match faces_outward(case, *t) {
            Some(outward) => {
                if !outward {
                    t.swap(1, 2);
                }
                true
            }
            None => false,
        })
        .collect();
    // Each pass settles at least one triangle, and there are at most five.
    for _ in 0..triangles.len() {
        for i in 0..triangles.len() {
            if done[i] {
                continue;
            }
            let neighbour =
                (0..triangles.len()).filter(|&j| done[j]).find_map(|j| runs_along(triangles[j], triangles[i]));
            if let Some(same_direction) = neighbour {
                if same_direction {
                    triangles[i].swap(1, 2);
                }
                done[i] = true;
            }
        }
    }
}

/// The three directed sides of a triangle.
fn sides([a, b, c]: [u8; 3]) -> [[u8; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Whether two triangles share a side, and if so, whether they run along it in the same
/// direction.
fn runs_along(t: [u8; 3], u: [u8; 3]) -> Option<bool> {
    for [a, b] in sides(t) {
        for side in sides(u) {
            if side == [a, b] {
                return Some(true);
            }
            if side == [b, a] {
                return Some(false);
            }
        }
    }
    None
}

/// Whether the normal of a triangle points outward, told by a side that lies in a face of the
/// cell; `None` if no side does.
fn faces_outward(case: u8, triangle: [u8; 3]) -> Option<bool> {
    for [a, b] in sides(triangle) {
        let Some((axis, upper)) = common_face(a, b) else {
            continue;
        };
        let (p, q) = (doubled_middle(a), doubled_middle(b));
        let d: [i32; 3] = std::array::from_fn(|i| q[i] - p[i]);
        // m × d for the unit vector m along the axis, then turned for a lower face.
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut normal = [0; 3];
        normal[next] = -d[last];
        normal[last] = d[next];
        if !upper {
            normal = normal.map(|x| -x);
        }
        // From the inside to the outside end of the edge.
        let along = usize::from(edge_axis(a));
        let base_is_inside = case >> EDGE_CORNERS[usize::from(a)][0] & 1 == 1;
        let outward = if base_is_inside { 1 } else { -1 };
        return Some(normal[along] * outward > 0);
    }
    None
}

#[cfg(test)]
mod embedded;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    fn inside(case: u8, corner: u8) -> bool {
        case >> corner & 1 == 1
    }

    fn crossed_edges(case: u8) -> BTreeSet<u8> {
        (0..12)
            .filter(|&e| {
                let [a, b] = EDGE_CORNERS[usize::from(e)];
                inside(case, a) != inside(case, b)
            })
            .collect()
    }

    /// The directed sides of the triangles of a case that no other triangle of it shares.
    fn boundary(case: u8) -> Vec<[u8; 2]> {
        let all: Vec<[u8; 2]> = directed_sides(case);
        let is_single = |&[a, b]: &[u8; 2]| !all.contains(&[b, a]);
        all.iter().copied().filter(is_single).collect()
    }

    fn directed_sides(case: u8) -> Vec<[u8; 2]> {
        let triangles = CaseTable::get().triangles(case);
        triangles.iter().flat_map(|&t| sides(t)).collect()
    }

    /// The directed segments of a case in a face, as edges of the lower face of that axis, so
    /// that upper and lower faces compare.
    fn segments(case: u8, axis: usize, upper: bool) -> BTreeSet<[u8; 2]> {
        let lowered = |e: u8| {
            let mut p = doubled_middle(e);
            p[axis] = 0;
            (0..12).find(|&f| doubled_middle(f) == p).unwrap()
        };
        boundary(case)
            .into_iter()
            .filter(|&[a, b]| common_face(a, b) == Some((axis, upper)))
            .map(|side| side.map(lowered))
            .collect()
    }

    /// The signs of the four corners of a face.
    fn face_signs(case: u8, axis: usize, upper: bool) -> [bool; 4] {
        let mut corners = (0..8u8).filter(|c| (c >> axis & 1 == 1) == upper);
        std::array::from_fn(|_| inside(case, corners.next().unwrap()))
    }

    #[test]
    fn edges_are_numbered_as_drawn() {
        assert_eq!(
            EDGE_CORNERS,
            [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]]
        );
    }

    #[test]
    fn every_crossed_edge_is_used_and_no_other() {
        for case in 0..=255 {
            let used: BTreeSet<u8> = CaseTable::get().triangles(case).iter().flatten().copied().collect();
            assert_eq!(used, crossed_edges(case), "case {case}");
        }
        assert!(CaseTable::get().triangles(0).is_empty());
        assert!(CaseTable::get().triangles(255).is_empty());
    }

    #[test]
    fn patches_are_oriented_surfaces_whose_boundary_is_in_the_faces() {
        for case in 0..=255 {
            let all = directed_sides(case);
            let distinct: BTreeSet<_> = all.iter().copied().collect();
            assert_eq!(distinct.len(), all.len(), "case {case}: a side twice");
            for &[a, b] in &all {
                assert_ne!(a, b, "case {case}");
                // Within the cell: shared, and in no face. On its boundary: the reverse.
                let shared = distinct.contains(&[b, a]);
                assert_eq!(shared, common_face(a, b).is_none(), "case {case}: {a}–{b}");
            }
        }
    }

    #[test]
    fn no_triangle_lies_in_a_face() {
        for case in 0..=255 {
            for &[a, b, c] in CaseTable::get().triangles(case) {
                let [a, b, c] = [a, b, c].map(doubled_middle);
                for axis in 0..3 {
                    let flat = a[axis] == b[axis] && b[axis] == c[axis] && a[axis] != 1;
                    assert!(!flat, "case {case}");
                }
            }
        }
    }

    #[test]
    fn neighbours_close_up_for_every_pair_of_cases() {
        let mut pairs = 0;
        for axis in 0..3 {
            for below in 0..=255 {
                let signs = face_signs(below, axis, true);
                let ours = segments(below, axis, true);
                for above in 0..=255 {
                    if face_signs(above, axis, false) != signs {
                        continue;
                    }
                    let theirs = segments(above, axis, false);
                    let reversed: BTreeSet<_> = theirs.iter().map(|&[a, b]| [b, a]).collect();
                    assert_eq!(ours, reversed, "axis {axis}: {below} and {above}");
                    pairs += 1;
                }
            }
        }
        assert_eq!(pairs, 3 * 16 * 16 * 16);
    }

    #[test]
    fn segments_have_the_inside_on_the_proper_side() {
        // The upper face of axis z seen from above the cell: x to the right, y up. The normal
        // of the surface is on the left of a segment, so the inside is on its right.
        for case in 0..=255u8 {
            for [a, b] in boundary(case) {
                if common_face(a, b) != Some((2, true)) {
                    continue;
                }
                let (p, q) = (doubled_middle(a), doubled_middle(b));
                for e in [a, b] {
                    for corner in EDGE_CORNERS[usize::from(e)] {
                        let c = corner_position(corner).map(|x| 2 * x);
                        let left = (q[0] - p[0]) * (c[1] - p[1]) - (q[1] - p[1]) * (c[0] - p[0]);
                        assert_eq!(left < 0, inside(case, corner), "case {case}");
                    }
                }
            }
        }
    }

    #[test]
    fn normals_point_out_of_a_single_corner_and_a_half_cell() {
        let normal = |t: [u8; 3]| {
            let [a, b, c] = t.map(doubled_middle);
            let u: [i32; 3] = std::array::from_fn(|i| b[i] - a[i]);
            let v: [i32; 3] = std::array::from_fn(|i| c[i] - a[i]);
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        };
        let table = CaseTable::get();
        assert_eq!(normal(table.triangles(1)[0]), [1, 1, 1]);
        assert_eq!(normal(table.triangles(0xfe)[0]), [-1, -1, -1]);
        for &t in table.triangles(0x0f) {
            assert!(normal(t)[2] > 0);
        }
    }

    #[test]
    fn triangles_at_a_vertex_form_one_path_between_two_faces() {
        for case in 0..=255 {
            for edge in crossed_edges(case) {
                // In the triangle [edge, a, b], the fan goes from a to b.
                let mut next = BTreeMap::new();
                for &t in CaseTable::get().triangles(case) {
                    if let Some(i) = t.iter().position(|&e| e == edge) {
                        assert!(next.insert(t[(i + 1) % 3], t[(i + 2) % 3]).is_none());
                    }
                }
                let ends: BTreeSet<u8> = next.values().copied().collect();
                let starts: Vec<u8> = next.keys().copied().filter(|a| !ends.contains(a)).collect();
                assert_eq!(starts.len(), 1, "case {case}, edge {edge}");
                let (mut at, mut steps) = (starts[0], 0);
                while let Some(&to) = next.get(&at) {
                    at = to;
                    steps += 1;
                }
                assert_eq!(steps, next.len(), "case {case}, edge {edge}");
                let (first, last) = (common_face(edge, starts[0]), common_face(edge, at));
                assert!(first.is_some() && last.is_some() && first != last);
            }
        }
    }
}
