//! Patches of several cells, glued to one.

use std::ops::Range;

use glam::Vec3A;

use super::samples::Samples;
use super::span::{Span, offset};
use crate::mesh::feature::{Segment, tangents};
use crate::mesh::loops::CellLoop;
use crate::mesh::qef::Planes;

/// The weight of a cell's planes is 1 over the square of its distance, in cells, and this.
const NEAR: f32 = 0.1;

/// The patches of several cells of a box, which meet in the faces between these.
#[derive(Default)]
pub(super) struct Patches<'a> {
    all: Vec<Patch<'a>>,
    /// The segments of those that are not known yet.
    own: Vec<Segment>,
    /// Memory for where the vertices of one are in its cell.
    places: Vec<Vec3A>,
    /// And for [`glued`](Patches::glued): the segments in the sides of the box, with their ends;
    /// the vertices within, each four times; and what tells whether all hangs together.
    outer: Vec<(Segment, u32)>,
    within: Vec<u32>,
    vertices: Vec<(u32, u32)>,
    reached: Vec<bool>,
}

/// The patch of a loop of a cell.
struct Patch<'a> {
    cell: [u32; 3],
    planes: Planes,
    ring: Ring<'a>,
}

/// The segments of a loop.
enum Ring<'a> {
    Known(&'a [Segment]),
    /// Where they are among the patches' own.
    Own(Range<usize>),
}

/// A disc of several patches.
pub(super) struct Disc {
    /// Its boundary.
    pub(super) ring: Vec<Segment>,
    /// The vertices that are not on it, ascending.
    pub(super) within: Vec<u32>,
}

impl<'a> Patches<'a> {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.own.clear();
    }

    /// Adds a patch of a cell whose segments and planes are known.
    pub(super) fn add(&mut self, cell: [u32; 3], ring: &'a [Segment], planes: Planes) {
        self.all.push(Patch { cell, planes, ring: Ring::Known(ring) });
    }

    /// Adds the patch of a loop of a cell, given the vertices on it.
    pub(super) fn add_loop(&mut self, samples: &Samples<'_>, cell: [u32; 3], outline: &CellLoop, vertices: &[u32]) {
        let start = self.own.len();
        self.places.clear();
        let (low, share) = (samples.node(cell), 1.0 / samples.lattice.step() as f32);
        for (n, &from) in vertices.iter().enumerate() {
            let (position, normal) = samples.get(from);
            self.own.push(Segment::new(from, normal, outline.face(n)));
            self.places.push(share * Vec3A::from(position - low));
        }
        let (planes, _) = tangents(&mut self.own[start..], &self.places, samples.crease, |_| ());
        self.all.push(Patch { cell, planes, ring: Ring::Own(start..self.own.len()) });
    }

    /// All planes, from the first node of cell `low`; those of cells close to a point tell the
    /// most.
    pub(super) fn planes(&self, low: [u32; 3], point: Vec3A) -> Planes {
        let mut all = Planes::NONE;
        for Patch { cell, planes, .. } in &self.all {
            let shift = offset(*cell, low);
            all.append(planes, shift, (NEAR + (shift + 0.5 - point).length_squared()).recip());
        }
        all
    }

    /// All as one, if they make a disc, given the box that they are in.
    ///
    /// A segment in a face between two cells of the box is that of both, one in a side of the box
    /// that of one. A vertex is where a loop goes from a face to the next: it is within the box if
    /// neither face is in a side; all four cells around its edge are in the box then, and each has
    /// it once.
    pub(super) fn glued(&mut self, span: &Span) -> Option<Disc> {
        let Patches { all, own, outer, within, vertices, reached, .. } = self;
        let segments = |patch: &Patch<'a>| match &patch.ring {
            Ring::Known(ring) => *ring,
            Ring::Own(range) => &own[range.clone()],
        };
        outer.clear();
        within.clear();
        let mut shared = 0;
        for patch in &*all {
            let ring = segments(patch);
            let is_outer = |segment: &Segment| span.is_side(patch.cell, segment.face);
            let mut comes_within = ring.last().is_some_and(|last| !is_outer(last));
            for (n, segment) in ring.iter().enumerate() {
                let is_within = !is_outer(segment);
                if is_within {
                    shared += 1;
                    within.extend(comes_within.then_some(segment.from));
                } else {
                    let next = ring.get(n + 1).unwrap_or(&ring[0]);
                    outer.push((segment.placed(patch.cell, span.low), next.from));
                }
                comes_within = is_within;
            }
        }
        // Vertices − edges + patches is 1 for a disc. On its boundary there are as many of the one
        // as of the other.
        let is_shared_alike = within.len() % 4 == 0 && shared % 2 == 0;
        if !is_shared_alike || within.len() / 4 + all.len() != shared / 2 + 1 {
            return None;
        }
        let mut ring: Vec<Segment> = Vec::with_capacity(outer.len());
        let first = outer.first()?.0.from;
        let mut at = first;
        while ring.len() < outer.len() {
            let &(segment, to) = outer.iter().find(|(segment, _)| segment.from == at)?;
            ring.push(segment);
            at = to;
            if at == first {
                break;
            }
        }
        if ring.len() != outer.len() || at != first {
            return None;
        }
        // As there is a single boundary, what does not hang together with the rest is closed. There
        // is a node in it, and it is crossed on all six ways along the axes from that: it has six
        // vertices within, or more.
        if within.len() / 4 >= 6 {
            vertices.clear();
            for (patch, number) in all.iter().zip(0..) {
                vertices.extend(segments(patch).iter().map(|segment| (segment.from, number)));
            }
            vertices.sort_unstable();
            reached.clear();
            reached.resize(all.len(), false);
            if !hangs_together(vertices, reached) {
                return None;
            }
        }
        within.sort_unstable();
        within.dedup();
        Some(Disc { ring, within: within.clone() })
    }
}

/// Whether one comes from every patch to every other by vertices that they share; given the
/// vertices in order, each with its patches, and a mark for each patch.
fn hangs_together(vertices: &[(u32, u32)], reached: &mut [bool]) -> bool {
    reached[0] = true;
    let mut is_new = true;
    while is_new {
        is_new = false;
        for around in vertices.chunk_by(|a, b| a.0 == b.0) {
            if around.iter().any(|&(_, patch)| reached[patch as usize]) {
                for &(_, patch) in around {
                    is_new |= !std::mem::replace(&mut reached[patch as usize], true);
                }
            }
        }
    }
    reached.iter().all(|patch| *patch)
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use glam::Vec3;

    use super::*;
    use crate::mesh::table::{EDGE_CORNERS, edge_axis};

    /// The patches of a box of cells, given which nodes are inside: their cells and their segments.
    fn patches_of(span: &Span, is_inside: impl Fn([u32; 3]) -> bool) -> Vec<([u32; 3], Vec<Segment>)> {
        let corner = |cell: [u32; 3], c: u8| std::array::from_fn(|axis| cell[axis] + u32::from(c >> axis & 1));
        let mut all = Vec::new();
        for cell in span.cells() {
            let case = (0..8).fold(0, |case, c| case | u8::from(is_inside(corner(cell, c))) << c);
            let vertex = |edge: u8| {
                let [x, y, z] = corner(cell, EDGE_CORNERS[usize::from(edge)][0]);
                x + 8 * (y + 8 * (z + 8 * u32::from(edge_axis(edge))))
            };
            for outline in CellLoop::all(case, 0) {
                let segment = |(n, &edge): (usize, &u8)| Segment::new(vertex(edge), Vec3::X, outline.face(n));
                all.push((cell, outline.edges().iter().enumerate().map(segment).collect()));
            }
        }
        all
    }

    /// The same from the segments alone: those that no other runs along the other way are the
    /// boundary.
    fn glued_by_pairs(all: &[([u32; 3], Vec<Segment>)]) -> Option<(Vec<u32>, Vec<u32>)> {
        let sides = |(n, (_, ring)): (usize, &([u32; 3], Vec<Segment>))| {
            let next = ring.iter().cycle().skip(1).map(|segment| segment.from);
            ring.iter().zip(next).map(|(segment, to)| (segment.from, to, n)).collect::<Vec<_>>()
        };
        let sides: Vec<(u32, u32, usize)> = all.iter().enumerate().flat_map(sides).collect();
        let pairs: BTreeSet<(u32, u32)> = sides.iter().map(|&(from, to, _)| (from, to)).collect();
        let outer: Vec<(u32, u32)> =
            pairs.iter().filter(|&&(from, to)| !pairs.contains(&(to, from))).copied().collect();
        let next: BTreeMap<u32, u32> = outer.iter().copied().collect();
        let start = sides.iter().find(|&&(from, to, _)| !pairs.contains(&(to, from)))?.0;
        let mut ring = vec![start];
        while let Some(&to) = next.get(ring.last()?).filter(|&&to| to != start) {
            ring.push(to);
        }
        let vertices: BTreeSet<u32> = pairs.iter().map(|&(from, _)| from).collect();
        let edges = outer.len() + (sides.len() - outer.len()) / 2;
        let mut reached = BTreeSet::from([0]);
        while let Some(&(.., patch)) = sides.iter().find(|&&(from, _, patch)| {
            let is_near = |&(other, _, near): &(u32, u32, usize)| other == from && reached.contains(&near);
            !reached.contains(&patch) && sides.iter().any(is_near)
        }) {
            reached.insert(patch);
        }
        let is_disc = vertices.len() + all.len() == edges + 1 && reached.len() == all.len();
        let within = vertices.into_iter().filter(|vertex| !ring.contains(vertex)).collect();
        (ring.len() == outer.len() && is_disc).then_some((ring, within))
    }

    #[test]
    fn faces_tell_what_pairs_of_segments_do() {
        let mut state = 1_u64;
        let mut next = move |below: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32 % below
        };
        let mut discs = 0;
        for _ in 0..4000 {
            let low = [next(3), next(3), next(3)];
            let span = Span { low, high: low.map(|at| at + 1 + next(4)) };
            // A plane, with a few nodes turned to the other side, or all at random.
            let (normal, level, noise) = ([next(5), next(5), next(5)], next(40), [0, 1, 4, 50][next(4) as usize]);
            let turned: Vec<bool> = (0..512).map(|_| next(100) < noise).collect();
            let is_inside = |[x, y, z]: [u32; 3]| {
                let height = normal[0] * x + normal[1] * y + normal[2] * z;
                (height < level) != turned[(x + 8 * (y + 8 * z)) as usize]
            };
            let all = patches_of(&span, is_inside);
            let mut patches = Patches::default();
            all.iter().for_each(|(cell, ring)| patches.add(*cell, ring, Planes::NONE));
            let disc = patches.glued(&span);
            let found = disc.map(|Disc { ring, within }| (ring.iter().map(|s| s.from).collect::<Vec<_>>(), within));
            assert_eq!(found, glued_by_pairs(&all), "{span:?}");
            discs += usize::from(found.is_some());
        }
        assert!(discs > 500, "{discs}");
    }
}
