//! Triangles divided for samples of the surface that they are.
//!
//! ```text
//!       /\             Sides that are too long are halved, in both triangles that share them, until
//!      /__\            none is: what was closed stays so.
//!     /\  /\
//!    /__\/__\
//! ```

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::{Cancelled, Mesh, Run};

/// Sides are halved so often at most.
const HALVINGS: usize = 32;

/// Triangles and of which of the given ones each is a part.
pub(super) struct Fine {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    pub(super) parents: Vec<u32>,
}

impl Fine {
    /// Parts of triangles, with sides no longer than a length.
    pub(super) fn new(all: &[[DVec3; 3]], longest: f64, run: &Run) -> Result<Fine, Cancelled> {
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
        let mut positions = Vec::new();
        let mut vertex = |p: DVec3| {
            *numbers.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
                positions.push(p);
                positions.len() as u32 - 1
            })
        };
        let triangles: Vec<[u32; 3]> = all.iter().map(|corners| corners.map(&mut vertex)).collect();
        let mut fine = Fine { positions, triangles, parents: (0..all.len() as u32).collect() };
        for _ in 0..HALVINGS {
            run.check()?;
            if !fine.halve(longest) {
                break;
            }
        }
        Ok(fine)
    }

    /// Halves all sides that are longer; whether there were some.
    fn halve(&mut self, longest: f64) -> bool {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let (mut triangles, mut parents) = (Vec::with_capacity(self.triangles.len()), Vec::new());
        for (corners, parent) in self.triangles.iter().zip(&self.parents) {
            let middle = |k: usize| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
                (p.distance(q) > longest).then(|| {
                    *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        self.positions.push(0.5 * (p + q));
                        self.positions.len() as u32 - 1
                    })
                })
            };
            let own = [0, 1, 2].map(middle);
            let before = triangles.len();
            divided(*corners, own, &mut triangles);
            parents.extend((before..triangles.len()).map(|_| *parent));
        }
        (self.triangles, self.parents) = (triangles, parents);
        !middles.is_empty()
    }

    /// As a mesh in single precision.
    pub(super) fn mesh(&self) -> Mesh {
        let positions: Vec<Vec3> = self.positions.iter().map(|p| p.as_vec3()).collect();
        // Indices are in range, and numbers that a lattice spans are finite.
        Mesh::new(positions, self.triangles.clone()).unwrap_or_default()
    }

    /// The middle of each triangle.
    pub(super) fn middles(&self) -> Vec<DVec3> {
        let middle = |corners: &[u32; 3]| corners.map(|v| self.positions[v as usize]).iter().sum::<DVec3>() / 3.0;
        self.triangles.iter().map(middle).collect()
    }
}

/// The parts of a triangle, some of whose sides have a middle: the first from the first corner to
/// the second.
fn divided([a, b, c]: [u32; 3], middles: [Option<u32>; 3], found: &mut Vec<[u32; 3]>) {
    match middles {
        [None, None, None] => found.push([a, b, c]),
        [Some(m), None, None] => found.extend([[a, m, c], [m, b, c]]),
        [Some(m), Some(n), None] => found.extend([[m, b, n], [a, m, n], [a, n, c]]),
        [Some(m), Some(n), Some(o)] => found.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]),
        [x, y, z] => divided([b, c, a], [y, z, x], found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_divided_is_the_same_surface() {
        let corners = [DVec3::ZERO, 7.0 * DVec3::X, 0.3 * DVec3::Y, DVec3::new(0.1, 0.1, 2.0)];
        let all = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t: [usize; 3]| t.map(|n| corners[n]));
        let whole =
            Mesh::new(corners.map(|p| p.as_vec3()).to_vec(), vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
        for longest in [0.1, 1.0, 10.0] {
            let fine = Fine::new(&all, longest, &Run::default()).unwrap();
            let mesh = fine.mesh();
            assert!(mesh.check().is_closed() && mesh.triangles().len() >= 4);
            assert!((mesh.area() - whole.area()).abs() < 1e-5 * whole.area());
            assert!((mesh.volume() - whole.volume()).abs() < 1e-5);
            let long = |t: &[u32; 3]| {
                let [a, b, c] = mesh.corners(*t);
                a.distance(b).max(b.distance(c)).max(c.distance(a))
            };
            assert!(mesh.triangles().iter().all(|t| long(t) <= 1.001 * longest));
            assert_eq!((fine.parents.len(), fine.middles().len()), (mesh.triangles().len(), mesh.triangles().len()));
        }
    }
}
