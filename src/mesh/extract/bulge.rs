//! Smooth cells whose triangles would be too far off the surface: a vertex in their middle.
//!
//! ```text
//!        m  ___  n       The normals m, n … at the vertices p, q … of a cell's loop tell how far the surface is
//!        \.' c './       above the middle of the loop. If that is too much, the cell has triangles from
//!         p-----q        there, from c, to the segments of the loop.
//! ```
//!
//! Let the surface be at the height h(x) = −½ xᵀKx. To first order its normal is (Kx, 1). With r the way from the
//! middle of some points of it to each of them, the surface is above the middle by half the mean of rᵀKr, which is
//! half the mean of n·(p − middle) over the points. Where it bends both ways, as a saddle does, the terms have both
//! signs; the mean of their sizes tells how far it may be from triangles.
//!
//! What is of third order is left out. The triangles around c are off by about half as much as those of the table,
//! and no more values of the field are needed for them. That fans are embedded is shown in
//! [`sharp`](super::sharp).

use glam::{Vec3, Vec3A};

use super::samples::Samples;
use crate::mesh::feature::{SMOOTH, differ};
use crate::mesh::loops::LONGEST;

/// The distance of a loop's middle from the surface, in cells, beyond which there is a vertex.
const FAR: f32 = 0.01;

/// If no normals of a cell differ by more than this angle, the cell is nearly flat: the normals of a loop within 0.8
/// cells of its middle make it no farther off than [`FAR`] then.
pub(super) const SPREAD: f32 = 0.05;

/// The vertices on a cell's loop, in order.
pub(super) struct Ring {
    vertices: [u32; LONGEST],
    normals: [Vec3A; LONGEST],
    /// Memory for their places.
    positions: [Vec3A; LONGEST],
    len: usize,
    /// The sum of the normals.
    sum: Vec3A,
    /// The mean of the squares of their distances from their mean: what the square of that lacks of 1.
    variance: f32,
}

impl Ring {
    /// A ring without vertices.
    pub(super) const NONE: Ring = Ring {
        vertices: [0; LONGEST],
        normals: [Vec3A::ZERO; LONGEST],
        positions: [Vec3A::ZERO; LONGEST],
        len: 0,
        sum: Vec3A::ZERO,
        variance: 0.0,
    };

    /// Becomes that of some edges; `ids` are the vertices on all edges of the cell.
    #[inline(always)]
    pub(super) fn take(&mut self, samples: &Samples<'_>, edges: &[u8], ids: &[u32; 16]) {
        let mut sum = Vec3A::ZERO;
        for ((vertex, normal), &edge) in self.vertices.iter_mut().zip(&mut self.normals).zip(edges) {
            *vertex = ids[usize::from(edge & 15)];
            let given = Vec3A::from(samples.normal(*vertex));
            sum += given;
            *normal = given;
        }
        self.len = edges.len();
        let count = edges.len() as f32;
        self.sum = sum;
        self.variance = 1.0 - sum.length_squared() / (count * count);
    }

    pub(super) fn vertices(&self) -> &[u32] {
        &self.vertices[..self.len]
    }

    fn normals(&self) -> &[Vec3A] {
        &self.normals[..self.len]
    }

    /// Whether the cell is nearly flat: a few normals in a circle of that diameter are this far from their mean.
    #[inline(always)]
    pub(super) fn is_flat(&self) -> bool {
        self.variance < 0.25 * SPREAD * SPREAD
    }

    /// Whether no two normals differ as those of a crease do.
    #[inline(always)]
    pub(super) fn is_smooth(&self) -> bool {
        // The square of the distance of two is at most twice the sum of the squares of those from the mean.
        2.0 * self.len as f32 * self.variance < 2.0 - 2.0 * SMOOTH || !differ(self.normals())
    }

    /// The point of the surface above the middle, if the two are far from each other, and the unit normal there. A
    /// single triangle is small, and stays.
    #[inline(always)]
    pub(super) fn top(&mut self, samples: &Samples<'_>) -> Option<(Vec3A, Vec3A)> {
        if self.len == 3 {
            return None;
        }
        let (positions, normals) = (&mut self.positions[..self.len], &self.normals[..self.len]);
        for (at, &vertex) in positions.iter_mut().zip(&self.vertices) {
            *at = samples.position(vertex).into();
        }
        let (height, far, middle) = height(positions, normals);
        (far > FAR * samples.lattice.step() as f32).then(|| {
            let normal = self.sum.normalize_or_zero();
            (middle + height * normal, normal)
        })
    }
}

/// How far the surface is above the middle of points on it, given with the normals there; how far it may be from
/// triangles between them; and the middle.
#[inline(always)]
fn height(positions: &[Vec3A], normals: &[Vec3A]) -> (f32, f32, Vec3A) {
    let share = 1.0 / normals.len() as f32;
    let middle = share * positions.iter().sum::<Vec3A>();
    let (mut height, mut far) = (0.0, 0.0);
    for (at, normal) in positions.iter().zip(normals) {
        let rise = normal.dot(*at - middle);
        height += rise;
        far += rise.abs();
    }
    (0.5 * share * height, 0.5 * share * far, middle)
}

/// A smooth cell with a vertex in its middle.
#[derive(Clone, Copy)]
pub(super) struct Bulge {
    /// The cell, by its number in the block.
    pub(super) cell: u16,
    /// How many segments its loop has; 0 if it is dropped.
    pub(super) sides: u16,
    /// The place of its first triangle among the plain ones.
    pub(super) first: u32,
    pub(super) at: Vec3,
    pub(super) normal: Vec3,
}

impl Bulge {
    /// Whether it is not dropped.
    pub(super) fn is_there(&self) -> bool {
        self.sides > 0
    }

    /// The cell is part of a region.
    pub(super) fn drop_it(&mut self) {
        self.sides = 0;
    }
}

/// The triangles around a vertex, to the segments of a ring.
pub(super) fn around(centre: u32, ring: &[u32]) -> impl ExactSizeIterator<Item = [u32; 3]> {
    let next = |n: usize| ring.get(n + 1).unwrap_or(&ring[0]);
    ring.iter().enumerate().map(move |(n, &from)| [centre, from, *next(n)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_heights_holds() {
        // A ball 16 cells across, and a saddle.
        let ball = |x: f32, y: f32| {
            let normal = Vec3A::new(x, y, 8.0).normalize();
            (8.0 * normal, normal)
        };
        let saddle = |x: f32, y: f32| (Vec3A::new(x, y, (x * x - y * y) / 16.0), Vec3A::new(-x, y, 8.0).normalize());
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let look =
            |corners: [(Vec3A, Vec3A); 4]| height(&corners.map(|corner| corner.0), &corners.map(|corner| corner.1));
        let (above, far, middle) = look(square.map(|(x, y)| ball(x, y)));
        assert!((middle.length() + above - 8.0).abs() < 1e-3 && far > 0.03, "{above}, {far}");
        let (above, far, middle) = look(square.map(|(x, y)| saddle(x - 0.5, y - 0.5)));
        assert!(middle.length() < 1e-6 && above.abs() < 1e-3, "{above}");
        assert!(far < 1e-6, "the vertices are at one height: {far}");
        let diamond = [(0.5, 0.0), (0.0, 0.5), (-0.5, 0.0), (0.0, -0.5)];
        let (above, far, _) = look(diamond.map(|(x, y)| saddle(x, y)));
        assert!(above.abs() < 1e-3 && far > 0.007, "{above}, {far}");
    }
}
