//! Volume and moments of what triangles enclose, all of it or within a box.
//!
//! ```text
//!      z₁ ---+-------+---        Of a triangle above a box's lower face: the prism between both, up to
//!            |  .-'\ |           the upper face, counted as the triangle faces: up +, down −. All
//!            |-'    \|           triangles above the lower face together leave what is inside,
//!      z₀ ---+-------+---        without a look at what the sides of the box cut.
//! ```
//!
//! That is the volume of the solid where winding numbers are 0 and 1 only: of closed triangles that
//! cross nowhere, with nothing inside of what is inside. Others are left to the ranges of the
//! value.

use glam::{DAffine3, DVec3};

use super::moments::Moments;
use crate::{Bounds, Cancelled, Mesh, Run};
use rvachev_field::AnyField;

/// How far off a triangle its sides are told: as a part of the root of its area, and in units of
/// what its corners are rounded by, if that is more. Halved so often where something else is about
/// as near, as the values on both sides then differ by less than this part of how far they are
/// apart.
const ASIDE: f64 = 1e-3;
const ROUNDINGS: f64 = 4.0;
const HALVINGS: usize = 30;
const NEAREST: f64 = 0.995;

/// Triangles that leave no opening, and are the surface of what they enclose.
pub(super) struct Facets {
    pub(super) triangles: Vec<[DVec3; 3]>,
    /// How far the surface may be off them.
    rounding: f64,
}

impl Facets {
    /// Those of a leaf after a map, if they tell what it holds.
    pub(super) fn of(field: &dyn AnyField, map: &DAffine3, run: &Run) -> Result<Option<Facets>, Cancelled> {
        let Some(found) = field.facets().filter(|found| found.is_closed) else { return Ok(None) };
        let rvachev_field::Facets { positions, triangles, rounding, .. } = found;
        let bounds = Bounds::from_points(positions.iter().copied());
        // About their middle, so that single precision tells crossings as they are.
        let single = |p: &DVec3| ((*p - bounds.center()) / bounds.longest_side()).as_vec3();
        let Ok(mesh) = Mesh::new(positions.iter().map(single).collect(), triangles) else { return Ok(None) };
        let corners = |triangle: &[u32; 3]| triangle.map(|v| positions[v as usize]);
        let report = mesh.check_with(run)?;
        let is_simple = report.is_closed()
            && report.non_manifold_edges + report.non_manifold_vertices == 0
            && report.self_intersections + report.duplicate_triangles == 0;
        if !is_simple {
            return Ok(None);
        }
        // The winding number is the same on each side of a part: one place tells of all.
        for part in mesh.components_with(run)? {
            let all = part.triangles().iter().map(|n| corners(&mesh.triangles()[*n as usize]));
            let largest = all.max_by(|a, b| area(a).length_squared().total_cmp(&area(b).length_squared()));
            if !largest.is_some_and(|triangle| is_between(field, &triangle, rounding)) {
                return Ok(None);
            }
        }
        let is_turned = map.matrix3.determinant() < 0.0;
        let place = |triangle: &[u32; 3]| {
            let [a, b, c] = corners(triangle).map(|p| map.transform_point3(p));
            if is_turned { [a, c, b] } else { [a, b, c] }
        };
        let stretch = map.matrix3.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        Ok(Some(Facets::new(mesh.triangles().iter().map(place).collect(), rounding * stretch)))
    }

    /// Triangles that are known to tell what they hold.
    pub(super) fn new(triangles: Vec<[DVec3; 3]>, rounding: f64) -> Facets {
        Facets { triangles, rounding }
    }

    /// How far the surface may be off them.
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// All that they enclose.
    pub(super) fn moments(&self) -> Moments {
        let Some(about) = self.triangles.first().map(|triangle| triangle[0]) else { return Moments::default() };
        let mut all = Moments::default();
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|p| p - about);
            all.add(&Moments::tetrahedron(a.dot(b.cross(c)) / 6.0, &[DVec3::ZERO, a, b, c]));
        }
        all.moved(about)
    }

    /// Their area, and how far it may be off, as their corners are rounded.
    pub(super) fn area(&self) -> [f64; 2] {
        let around = |[a, b, c]: &[DVec3; 3]| a.distance(*b) + b.distance(*c) + c.distance(*a);
        let length: f64 = self.triangles.iter().map(around).sum();
        [self.triangles.iter().map(|triangle| area(triangle).length()).sum(), self.rounding * length]
    }

    /// How far the volume may be off for the same reason.
    pub(super) fn volume_error(&self) -> f64 {
        let [area, error] = self.area();
        self.rounding * (area + error)
    }
}

/// A triangle's area vector.
fn area([a, b, c]: &[DVec3; 3]) -> DVec3 {
    0.5 * (*b - *a).cross(*c - *a)
}

/// Whether inside is right behind a triangle, and outside right in front of it: where the value
/// falls by as much as distances can, from one side to the other, the triangle is all that is
/// there.
///
/// Patches are stored one by one, and a corner is that of one of them: the others may be off it by
/// twice the rounding. That shifts both values alike, and not what they differ by.
fn is_between(field: &dyn AnyField, triangle: &[DVec3; 3], rounding: f64) -> bool {
    let (middle, area) = (triangle.iter().sum::<DVec3>() / 3.0, area(triangle));
    let (far, normal) = (ASIDE * area.length().sqrt(), area.normalize_or_zero());
    let mut aside = far.max(ROUNDINGS * rounding);
    for _ in 0..HALVINGS {
        let [before, behind] = [aside, -aside].map(|by| field.value((middle + by * normal).to_array()));
        if (before - behind).abs() > 2.0 * NEAREST * aside {
            return before < 0.0 && behind > 0.0;
        }
        aside *= 0.5;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::{Facets, is_between};
    use crate::solid::Node;
    use crate::{CellSize, Mesh, MeshSettings, MeshSolid, Run, Solid};
    use glam::DAffine3;

    /// Of balls of a radius and a place along x, inside out if the radius is negative: whether they
    /// are known, and how many triangles are not between outside and inside.
    fn told(balls: &[[f64; 2]]) -> (bool, usize) {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for [radius, x] in balls {
            let settings = MeshSettings { cell: CellSize::LongestSide(12), ..MeshSettings::default() };
            let ball = Solid::sphere(radius.abs()).translate([*x, 0.0, 0.0]).mesh(&settings).unwrap();
            let ball = if *radius < 0.0 { ball.flipped() } else { ball };
            let first = positions.len() as u32;
            positions.extend_from_slice(ball.positions());
            triangles.extend(ball.triangles().iter().map(|triangle| triangle.map(|v| first + v)));
        }
        let mesh = Mesh::new(positions, triangles).unwrap();
        let solid = Solid::from_mesh(&mesh, MeshSolid::default());
        let Node::Leaf(field) = solid.node() else { unreachable!("a mesh is a leaf") };
        let found = field.facets().unwrap();
        let is_off = |triangle: &&[u32; 3]| {
            !is_between(&**field, &triangle.map(|v| found.positions[v as usize]), found.rounding)
        };
        let off = found.triangles.iter().filter(is_off).count();
        (Facets::of(&**field, &DAffine3::IDENTITY, &Run::default()).unwrap().is_some(), off)
    }

    #[test]
    fn a_small_body_beside_a_large_one_far_off() {
        for radius in [0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.2] {
            assert_eq!(told(&[[radius, 0.0], [0.6, 33.0]]), (true, 0), "{radius}");
            assert_eq!(told(&[[1.0, 33.0], [-radius, 33.0], [0.6, 0.0]]), (true, 0), "a hollow of {radius}");
        }
        let twelve: Vec<[f64; 2]> = (0..12).map(f64::from).map(|n| [0.05 * (n + 1.0), 3.0 * n]).collect();
        assert_eq!(told(&twelve), (true, 0));
    }

    #[test]
    fn skins_that_face_the_wrong_way_are_not_known() {
        assert_eq!(told(&[[1.0, 0.0], [-0.99, 0.0]]), (true, 0), "a skin of .01");
        for radius in [0.05, 0.5, 0.99] {
            assert!(!told(&[[1.0, 0.0], [radius, 0.0], [0.6, 33.0]]).0, "{radius} in 1");
        }
        assert!(!told(&[[-0.1, 0.0], [0.6, 33.0]]).0);
    }
}
