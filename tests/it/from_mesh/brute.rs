//! Distance and winding number by all triangles, one by one.

use glam::DVec3;
use rvachev::Mesh;

/// Corners of all triangles.
pub fn corners(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize].as_dvec3())).collect()
}

/// How far the nearest of some triangles is.
pub fn distance(triangles: &[[DVec3; 3]], p: DVec3) -> f64 {
    triangles.iter().map(|corners| from_triangle(corners, p)).fold(f64::INFINITY, f64::min)
}

fn from_segment(a: DVec3, b: DVec3, p: DVec3) -> f64 {
    let along = b - a;
    let square = along.length_squared();
    let part = if square > 0.0 { ((p - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (a + part * along).distance(p)
}

fn from_triangle(&[a, b, c]: &[DVec3; 3], p: DVec3) -> f64 {
    let sides = from_segment(a, b, p).min(from_segment(b, c, p)).min(from_segment(c, a, p));
    let normal = (b - a).cross(c - a);
    let is_left = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) > 0.0;
    let above = is_left(a, b) && is_left(b, c) && is_left(c, a);
    if above { sides.min(((p - a).dot(normal) / normal.length()).abs()) } else { sides }
}

/// The winding number, of solid angles.
pub fn winding(triangles: &[[DVec3; 3]], p: DVec3) -> f64 {
    let angle = |corners: &[DVec3; 3]| {
        let [a, b, c] = corners.map(|corner| corner - p);
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        let under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(under)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
