//! Triangles that lie in one plane, as few.
//!
//! ```text
//!     +--+--+--+        +--------+       Triangles that share a side are of one face if they are in the
//!     |\ |\ |\ |        |'.      |       face's plane, to within rounding. The border of a face, without
//!     | \| \| \|  --->  |  '.    |       corners that are on straight lines, is filled anew.
//!     +--+--+--+        |    '.  |
//!     |\ |\ |\ |        |      '.|
//!     +--+--+--+        +--------+
//! ```

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use rvachev_field::Polygon;
use rvachev_num::order;

use crate::{Cancelled, Run};

/// Faces are filled anew if that takes so small a part of the triangles, and all are flat: next to
/// bumps what fills them is long and thin, which searches are slower at, one by one.
const GAIN: usize = 16;

/// How far areas may be apart by rounding, in lengths of the border times how far off things are.
const ROUNDING: f64 = 8.0;

/// The surface that triangles are, with none of it farther off than `off`, from much fewer
/// triangles, if it is flat enough. Their corners may be on sides of others.
pub(super) fn merged(all: &[[DVec3; 3]], off: f64, run: &Run) -> Result<Vec<[DVec3; 3]>, Cancelled> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let mut number = |p: &DVec3| {
        let next = numbers.len() as u32;
        *numbers.entry((*p + 0.0).to_array().map(f64::to_bits)).or_insert(next)
    };
    let corners: Vec<[u32; 3]> = all.iter().map(|triangle| triangle.each_ref().map(&mut number)).collect();
    let sides = |n: usize| [0, 1, 2].map(|k| [corners[n][k], corners[n][(k + 1) % 3]]);
    let by_side: HashMap<[u32; 2], usize> = (0..all.len()).flat_map(|n| sides(n).map(|side| (side, n))).collect();
    run.check()?;
    let planes: Vec<Plane> = all.iter().map(Plane::of).collect();
    let beside = |n: usize| sides(n).map(|[from, to]| by_side.get(&[to, from]).copied());
    // Faces one by one, from their largest triangle on.
    let mut order: Vec<usize> = (0..all.len()).collect();
    order::falling(&mut order, |n| planes[*n].area);
    let mut faces = vec![usize::MAX; all.len()];
    let mut found = Vec::new();
    for first in order {
        if faces[first] != usize::MAX {
            continue;
        }
        run.check()?;
        faces[first] = first;
        let mut face = vec![first];
        let mut fit = Fit::of(&all[first]);
        let mut at = 0;
        while let Some(&n) = face.get(at) {
            at += 1;
            for next in beside(n).into_iter().flatten() {
                if faces[next] == usize::MAX && fit.has(&all[next], &planes[next], off) {
                    faces[next] = first;
                    face.push(next);
                    fit.add(&all[next]);
                }
            }
        }
        let is_border = |[from, to]: &[u32; 2]| by_side.get(&[*to, *from]).is_none_or(|n| faces[*n] != first);
        let border = |n: &usize| {
            let ends = sides(*n).into_iter().zip(all[*n]);
            ends.filter(|(side, _)| is_border(side)).collect::<Vec<_>>()
        };
        let border: Vec<([u32; 2], DVec3)> = face.iter().flat_map(border).collect();
        let own: Vec<[DVec3; 3]> = face.iter().map(|n| all[*n]).collect();
        let Some(fewer) = filled(&own, border, off, run)? else { return Ok(all.to_vec()) };
        found.extend(fewer);
    }
    Ok(if GAIN * found.len() <= all.len() { found } else { all.to_vec() })
}

/// A triangle's plane.
struct Plane {
    normal: DVec3,
    area: f64,
}

impl Plane {
    fn of([a, b, c]: &[DVec3; 3]) -> Plane {
        let area = (*b - *a).cross(*c - *a);
        Plane { normal: area.normalize_or_zero(), area: area.length() }
    }
}

/// The plane of a face as far as it is known: the more of it is, the less rounding turns it.
struct Fit {
    /// Twice the sum of the areas as vectors, and of their products with the middles.
    normal: DVec3,
    middle: DVec3,
    area: f64,
}

impl Fit {
    fn of(triangle: &[DVec3; 3]) -> Fit {
        let mut fit = Fit { normal: DVec3::ZERO, middle: DVec3::ZERO, area: 0.0 };
        fit.add(triangle);
        fit
    }

    fn add(&mut self, [a, b, c]: &[DVec3; 3]) {
        let area = (*b - *a).cross(*c - *a);
        self.normal += area;
        self.middle += area.length() * (*a + *b + *c) / 3.0;
        self.area += area.length();
    }

    fn has(&self, triangle: &[DVec3; 3], plane: &Plane, off: f64) -> bool {
        let (normal, middle) = (self.normal.normalize_or_zero(), self.middle / self.area);
        // One without area has no normal.
        let is_along = plane.normal == DVec3::ZERO || normal.dot(plane.normal) > 0.0;
        self.area > 0.0 && is_along && triangle.iter().all(|p| normal.dot(*p - middle).abs() <= off)
    }
}

/// A face filled anew, by its triangles and the sides that it ends at; nothing if it is not flat,
/// or that takes more of them.
fn filled(
    own: &[[DVec3; 3]],
    border: Vec<([u32; 2], DVec3)>,
    off: f64,
    run: &Run,
) -> Result<Option<Vec<[DVec3; 3]>>, Cancelled> {
    let areas = |all: &[[DVec3; 3]]| all.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a)).sum::<DVec3>();
    let area = areas(own);
    let Some(normal) = area.try_normalize() else { return Ok(None) };
    let count = 3.0 * own.len() as f64;
    let middle = own.iter().flatten().sum::<DVec3>() / count;
    if own.iter().flatten().any(|p| normal.dot(*p - middle).abs() > 2.0 * off) {
        return Ok(None);
    }
    // Along the longest straight line of the border, so that what it is filled with is no splinter
    // there.
    let side = |[a, b]: &[DVec2; 2]| a.distance_squared(*b);
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let contours = contours(border, |p| DVec2::new(u.dot(p - middle), v.dot(p - middle)));
    let contours: Vec<Vec<DVec2>> = contours.iter().map(|contour| straight(contour, off)).collect();
    let all_sides = contours.iter().flat_map(|contour| pairs(contour));
    let Some([from, to]) = all_sides.max_by(|a, b| side(a).total_cmp(&side(b))) else { return Ok(None) };
    let along = (to - from).normalize_or_zero();
    let turned = |p: &DVec2| DVec2::new(along.dot(*p), along.perp_dot(*p));
    let contours = levelled(contours.iter().map(|contour| contour.iter().map(turned).collect()).collect(), off);
    let (u, v) = (along.x * u + along.y * v, along.x * v - along.y * u);
    let around: f64 = contours.iter().flat_map(|contour| pairs(contour)).map(|[a, b]| a.distance(b)).sum();
    let polygon = Polygon::new(contours);
    if polygon.check().is_err() {
        return Ok(None);
    }
    let Some(triangles) = polygon.triangles(own.len(), run)? else { return Ok(None) };
    let back = |p: DVec2| middle + p.x * u + p.y * v;
    let fewer: Vec<[DVec3; 3]> = triangles.into_iter().map(|triangle| triangle.map(back)).collect();
    let is_same = (areas(&fewer) - area).length() <= ROUNDING * off * around;
    Ok(is_same.then_some(fewer))
}

/// Sides put one after the other, by the numbers of their ends.
fn contours(border: Vec<([u32; 2], DVec3)>, flat: impl Fn(DVec3) -> DVec2) -> Vec<Vec<DVec2>> {
    let mut from: HashMap<u32, Vec<(u32, DVec2)>> = HashMap::new();
    let starts: Vec<u32> = border.iter().map(|([start, _], _)| *start).collect();
    for ([start, end], p) in border {
        from.entry(start).or_default().push((end, flat(p)));
    }
    let mut found = Vec::new();
    for start in starts {
        let (mut contour, mut at) = (Vec::new(), start);
        while let Some((end, p)) = from.get_mut(&at).and_then(Vec::pop) {
            contour.push(p);
            at = end;
            if at == start {
                break;
            }
        }
        if contour.len() > 2 {
            found.push(contour);
        }
    }
    found
}

/// With one height for all points that are about as high.
fn levelled(mut contours: Vec<Vec<DVec2>>, off: f64) -> Vec<Vec<DVec2>> {
    let mut points: Vec<&mut DVec2> = contours.iter_mut().flatten().collect();
    order::rising(&mut points, |a| a.y);
    let mut level = f64::NEG_INFINITY;
    for p in points {
        if p.y - level > 2.0 * off {
            level = p.y;
        }
        p.y = level;
    }
    contours
}

fn pairs(contour: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..contour.len()).map(|n| [contour[n], contour[(n + 1) % contour.len()]])
}

/// A contour without points that are on straight lines between others, to within `off`.
fn straight(contour: &[DVec2], off: f64) -> Vec<DVec2> {
    // The farthest from the middle is a corner.
    let middle = contour.iter().sum::<DVec2>() / contour.len() as f64;
    let far = |n: &usize| contour[*n].distance_squared(middle);
    let first = (0..contour.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or_default();
    let at = |n: usize| contour[(first + n) % contour.len()];
    let mut kept = vec![0];
    for n in 1..contour.len() {
        let (start, end) = (kept[kept.len() - 1], n + 1);
        let along = at(end) - at(start);
        let is_on = |k: usize| {
            let p = at(k) - at(start);
            let t = p.dot(along) / along.length_squared();
            (0.0..=1.0).contains(&t) && p.perp_dot(along).abs() <= off * along.length()
        };
        if !(start + 1..end).all(is_on) {
            kept.push(n);
        }
    }
    kept.into_iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellSize, Mesh, MeshSettings, Solid, deg};

    fn triangles(mesh: &Mesh) -> Vec<[DVec3; 3]> {
        mesh.triangles().iter().map(|corners| mesh.corners(*corners)).collect()
    }

    fn sums(all: &[[DVec3; 3]]) -> [f64; 2] {
        let area = |[a, b, c]: &[DVec3; 3]| 0.5 * (*b - *a).cross(*c - *a).length();
        [all.iter().map(area).sum(), all.iter().map(|[a, b, c]| a.dot(b.cross(*c)) / 6.0).sum()]
    }

    #[test]
    fn flat_faces_come_to_few_triangles_and_round_ones_stay() {
        let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
        let turned = |solid: &Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0)).translate([1.0, 2.0, 3.0]);
        let block = Solid::cuboid([4.0, 3.0, 2.0]);
        let frame = &block - Solid::cuboid([2.0, 1.0, 5.0]);
        let drilled = &block - Solid::cylinder(0.8, 5.0);
        // Corners of pockets and of what is turned are rounded by more.
        for (solid, least) in [(block.clone(), 300), (frame.clone(), 1), (turned(&block), 1), (turned(&frame), 1)] {
            let all = triangles(&solid.mesh(&settings).unwrap());
            let off = 1e-6 * solid.bounds().unwrap().longest_side();
            let fewer = merged(&all, off, &Run::default()).unwrap();
            assert!(least * fewer.len() <= all.len(), "{solid}: {} of {}", fewer.len(), all.len());
            for (own, others) in sums(&all).into_iter().zip(sums(&fewer)) {
                assert!((own - others).abs() < 1e-5 * own, "{solid}: {own} {others}");
            }
        }
        let all = triangles(&drilled.mesh(&settings).unwrap());
        let fewer = merged(&all, 4e-6, &Run::default()).unwrap();
        assert!(fewer.len() <= all.len(), "{} of {}", fewer.len(), all.len());
        for (own, others) in sums(&all).into_iter().zip(sums(&fewer)) {
            assert!((own - others).abs() < 1e-5 * own, "{own} {others}");
        }
        let all = triangles(&Solid::sphere(1.0).mesh(&settings).unwrap());
        assert_eq!(merged(&all, 2e-6, &Run::default()).unwrap().len(), all.len());
    }
}
