//! Rims of the surface that a mesh cuts off.
//!
//! ```text
//!     -------.__            Where faces meet at an acute angle, no point of a mesh that ends early is far from
//!     -------'  ''-·        either of them: all that is missing is thin. It is seen beyond the mesh's own
//!              |---|         edge, where the solid goes on, or, at the end of a slot, the gap.
//! ```

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::eval::Program;
use crate::geom::Mesh;
use crate::mesh::groups::Groups;
use crate::mesh::slopes::Slopes;
use crate::{Cancelled, Run};

/// Edges of larger angles, by their cosine, have no more missing than the middles of triangles
/// tell.
const ACUTE: f64 = 0.0;

/// Rims are many that are one in so many.
const MANY: usize = 256;

/// So often the way beyond an edge is doubled, and what it ends in halved.
const DOUBLED: usize = 8;
const HALVED: usize = 5;

/// An edge between two triangles that meet at an acute angle.
struct Rim {
    ends: [u32; 2],
    middle: DVec3,
    /// In the middles of the triangles.
    beside: [DVec3; 2],
    /// Whether the solid is between the faces, and not the gap.
    is_convex: bool,
}

/// The same with the way on beyond it.
struct Way {
    ends: [u32; 2],
    from: DVec3,
    way: DVec3,
    is_convex: bool,
}

impl Rim {
    /// Of an edge and the corners across from it on both sides; nothing if the angle is another.
    fn new(ends: [u32; 2], [from, to]: [DVec3; 2], [left, right]: [DVec3; 2]) -> Option<Rim> {
        let along = to - from;
        let [own, other] = [along.cross(left - from), (right - from).cross(along)].map(DVec3::normalize_or_zero);
        let is_acute = own.dot(other) < ACUTE;
        let beside = [left, right].map(|corner| (from + to + corner) / 3.0);
        is_acute.then(|| Rim { ends, middle: from.midpoint(to), beside, is_convex: own.dot(right - from) <= 0.0 })
    }

    /// The way between the faces that the surface's own normals tell: those of slivers tell
    /// nothing.
    fn way(&self, normals: [DVec3; 2]) -> Option<Way> {
        let [own, other] = normals;
        let outwards = (own + other).try_normalize().filter(|_| own.dot(other) < ACUTE)?;
        let way = if self.is_convex { outwards } else { -outwards };
        Some(Way { ends: self.ends, from: self.middle, way, is_convex: self.is_convex })
    }
}

impl Way {
    fn at(&self, by: f64) -> DVec3 {
        self.from + by * self.way
    }

    /// Whether what is between the faces is where there is such a value.
    fn goes_on(&self, value: f64) -> bool {
        if self.is_convex { value > 0.0 } else { value < 0.0 }
    }

    /// How far it goes on, from so far that it is known to.
    fn end(&self, program: &Program, known: f64) -> f64 {
        let goes_on = |by: f64| self.goes_on(program.value(self.at(by)));
        let mut low = known;
        for _ in 0..DOUBLED {
            if !goes_on(2.0 * low) {
                break;
            }
            low *= 2.0;
        }
        let mut high = 2.0 * low;
        for _ in 0..HALVED {
            let middle = low.midpoint(high);
            *(if goes_on(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

/// Where rims go on beyond a mesh, and how far, if that is farther than the tolerance, and all of
/// these rims: in larger cells beside smaller ones they would be cut off again. Where many are, those
/// beside them would be as well: then it is all rims of the surface.
pub(super) fn cut_off(
    mesh: &Mesh,
    (program, tolerance): (&Program, f64),
    run: &Run,
) -> Result<Vec<(DVec3, f64)>, Cancelled> {
    let mut open: HashMap<[u32; 2], DVec3> = HashMap::new();
    let mut rims = Vec::new();
    for (number, &triangle) in mesh.triangles().iter().enumerate() {
        if number.is_multiple_of(4096) {
            run.check()?;
        }
        let corners = mesh.corners(triangle);
        for k in 0..3 {
            let [from, to] = [k, (k + 1) % 3];
            let (ends, across) = ([triangle[from], triangle[to]], corners[(k + 2) % 3]);
            match open.remove(&[ends[1], ends[0]]) {
                Some(other) => rims.extend(Rim::new(ends, [corners[from], corners[to]], [across, other])),
                None => drop(open.insert(ends, across)),
            }
        }
    }
    let slopes = Slopes::within(program, tolerance);
    let beside: Vec<DVec3> = rims.iter().flat_map(|rim| rim.beside).collect();
    let found = slopes.at(&beside, run)?;
    let ways = rims.iter().zip(found.chunks(2)).filter_map(|(rim, own)| rim.way([own[0].normal(), own[1].normal()]));
    let ways: Vec<Way> = ways.collect();
    let beyond: Vec<DVec3> = ways.iter().map(|way| way.at(tolerance)).collect();
    let found = slopes.at(&beyond, run)?;
    let mut rims = Groups::new(mesh.positions().len());
    for way in &ways {
        rims.join(way.ends[0], way.ends[1]);
    }
    let (mut all, mut cut) = (Vec::new(), HashSet::new());
    for (way, _) in ways.iter().zip(found).filter(|(way, slope)| way.goes_on(slope.value)) {
        run.check()?;
        let far = way.end(program, tolerance);
        cut.insert(rims.root(way.ends[0]));
        all.push((way.at(far), far));
    }
    let are_all = MANY * all.len() > ways.len();
    all.extend(ways.iter().filter(|way| are_all || cut.contains(&rims.root(way.ends[0]))).map(|way| (way.from, 0.0)));
    Ok(all)
}
