//! Corners of a mesh, gathered by vertex and by what they carry.
//!
//! ```text
//!        one vertex, six corners        two normals: two of what the file calls a vertex
//!              \  |  /
//!            up \ | / up                     (v, up)      (v, side)
//!          ------ v ------ crease
//!          side / | \ side
//! ```
//!
//! Corners of different vertices stay apart even if they are at the same place.

use std::io;

use super::too_many;
use crate::Run;
use crate::geom::Mesh;

/// The distinct pairs of a vertex and what its corners carry, in the order of the vertices and
/// then of the corners.
pub(super) struct Split {
    /// For each pair, one of its corners: number 3 t + k for corner k of triangle t.
    pub examples: Vec<usize>,
    /// For each corner, the number of its pair.
    pub pairs: Vec<u32>,
}

/// After so many vertices it is looked whether the run is cancelled.
const CHECKED: usize = 1024;

impl Split {
    /// Gathers the corners by `carried`, which is given the corner's number and its vertex.
    /// There are at most as many pairs as corners, so that 32 bits count them if there are
    /// fewer than 2³² corners; otherwise it is an error, as it is if `run` is cancelled.
    pub(super) fn new<T: Copy + PartialEq>(
        mesh: &Mesh,
        format: &str,
        run: &Run,
        carried: impl Fn(usize, u32) -> T,
    ) -> io::Result<Split> {
        let vertex = mesh.triangles().as_flattened();
        if u32::try_from(vertex.len()).is_err() {
            return Err(too_many(format));
        }
        // The corners of vertex v: by_vertex[starts[v]..starts[v + 1]], in order.
        let mut starts = vec![0usize; mesh.positions().len() + 1];
        for &v in vertex {
            starts[v as usize + 1] += 1;
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut free = starts.clone();
        let mut by_vertex = vec![0u32; vertex.len()];
        for (corner, &v) in vertex.iter().enumerate() {
            by_vertex[free[v as usize]] = corner as u32;
            free[v as usize] += 1;
        }

        let mut examples: Vec<usize> = Vec::with_capacity(mesh.positions().len());
        let mut pairs = vec![0; vertex.len()];
        let mut seen: Vec<T> = Vec::new();
        for (v, range) in starts.windows(2).enumerate() {
            if v.is_multiple_of(CHECKED) {
                run.check().map_err(io::Error::other)?;
            }
            let first = examples.len();
            seen.clear();
            for corner in by_vertex[range[0]..range[1]].iter().map(|&c| c as usize) {
                let value = carried(corner, vertex[corner]);
                let found = seen.iter().position(|&s| s == value).unwrap_or_else(|| {
                    seen.push(value);
                    examples.push(corner);
                    seen.len() - 1
                });
                pairs[corner] = (first + found) as u32;
            }
        }
        Ok(Split { examples, pairs })
    }

    /// Whether some vertex is in several pairs.
    pub(super) fn splits(&self, mesh: &Mesh) -> bool {
        let vertex = mesh.triangles().as_flattened();
        self.examples.windows(2).any(|pair| vertex[pair[0]] == vertex[pair[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn only_what_differs_is_split() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO];
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3], [4, 1, 3]]).unwrap();
        let split = Split::new(&mesh, "", &Run::default(), |_, _| ()).unwrap();
        assert!(!split.splits(&mesh));
        assert_eq!(split.pairs, [0, 1, 2, 0, 2, 3, 4, 1, 3], "each vertex once, the fifth apart from the first");
        let split = Split::new(&mesh, "", &Run::default(), |corner, _| corner == 3).unwrap();
        assert!(split.splits(&mesh) && split.examples.len() == 6);
        assert_eq!(split.pairs, [0, 2, 3, 1, 3, 4, 5, 2, 4]);
    }

    #[test]
    fn nothing_is_gathered_once_it_is_cancelled() {
        let count = 40 * CHECKED as u32;
        let positions = (0..count).map(|i| Vec3::splat(i as f32)).collect();
        let mesh = Mesh::new(positions, (0..count / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()).unwrap();
        let (run, asked) = (Run::default(), std::cell::Cell::new(0));
        let carried = |corner: usize, _| {
            asked.set(corner);
            if corner == 100 {
                run.cancel.cancel();
            }
        };
        assert!(Split::new(&mesh, "", &run, carried).is_err());
        assert!((100..=CHECKED).contains(&asked.get()), "{}", asked.get());
    }
}
