//! Normals at the corners of triangles, where those of the vertices will not do.
//!
//! A vertex on a crease has one normal for each side of it. The corners of a fan's triangles have
//! the normals of their sides; all other corners have those of their vertices.

use glam::Vec3;

/// The cosine of the angle from which on a normal is taken to belong to another side: 45°.
const ASTRAY: f32 = 0.7;

/// Vertices that triangles are between.
#[derive(Clone, Copy)]
pub(super) struct Vertices<'a> {
    pub(super) positions: &'a [Vec3],
    pub(super) normals: &'a [Vec3],
}

impl Vertices<'_> {
    /// The normals of the vertices of a triangle.
    #[inline(always)]
    fn normals_of(&self, [a, b, c]: [u32; 3]) -> [Vec3; 3] {
        [self.normals[a as usize], self.normals[b as usize], self.normals[c as usize]]
    }

    /// The normals at the corners of a triangle whose sides give it others; 0 at a corner that has
    /// that of its vertex. One that is farther from the triangle's own normal than 45° belongs to
    /// another side of a crease: the triangle's own stands in for it.
    pub(super) fn straightened(&self, triangle: [u32; 3], given: [Vec3; 3]) -> [Vec3; 3] {
        let own = self.normals_of(triangle);
        let [p, q, r] = triangle.map(|vertex| self.positions[vertex as usize]);
        let face = (q - p).cross(r - p);
        let least = ASTRAY * face.length();
        std::array::from_fn(|corner| {
            let normal = if given[corner] == Vec3::ZERO { own[corner] } else { given[corner] };
            // NaN is astray as well.
            if normal.dot(face) > least { normal } else { face.normalize_or_zero() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_another_side_are_replaced() {
        let up = Vec3::new(0.0, 0.6, 0.8);
        let vertices = Vertices {
            positions: &[Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            normals: &[up, Vec3::Y, Vec3::Z, Vec3::NEG_X],
        };
        // The vertex of the second has a normal that is astray, and what is given to the last is.
        assert_eq!(vertices.straightened([0, 1, 2], [Vec3::ZERO, up, Vec3::NEG_Z]), [up, up, Vec3::Z]);
        assert_eq!(vertices.straightened([0, 1, 2], [Vec3::NAN, Vec3::ZERO, up]), [Vec3::Z, Vec3::Z, up]);
    }
}
