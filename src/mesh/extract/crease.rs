//! Whether the surface has a crease in a block: a solid without any has the triangles of the case
//! table.
//!
//! ```text
//!     +---+---+---+---+ - - - - +      The normals of a quarter of a block's side, in all three axes an eighth of the
//!     |   | _-|^^-|_  |         .      block, are in a box. Where its diagonal is shorter than the difference of two
//!     +---+/--+---+-\-+         .      normals of a crease, no cell is looked at. Vertices in the planes between
//!     |  /|   |   |   |\        .      eighths are in the boxes of all of them.
//! ```

use glam::Vec3A;

use super::block_vertices::Corners;
use super::curvature::is_strongly_curved;
use super::parts::Watch;
use super::samples::Samples;
use crate::mesh::feature::Crease;
use crate::mesh::loops::CellLoop;
use crate::mesh::signs::{BLOCK, NODES, SIDE, for_each_cell};

/// Cells along an eighth of a block.
const HALF: usize = BLOCK / 2;

/// What normals are rounded by at most, as a part of the square of how far two of a crease are
/// apart.
const ROUNDING: f32 = 5e-3;

/// The eighths, as bits, whose cells have the edge at a place of [`Corners`].
const EIGHTHS: [u8; 3 * NODES] = {
    let mut eighths = [0; 3 * NODES];
    let mut place = 0;
    while place < eighths.len() {
        let (along, node) = (place / NODES, place % NODES);
        let at = [node % SIDE, node / SIDE % SIDE, node / (SIDE * SIDE)];
        let mut eighth = 0;
        while eighth < 8 {
            let (mut axis, mut has) = (0, true);
            while axis < 3 {
                let first = (eighth >> axis & 1) * HALF;
                // An edge along the axis is in one cell, any other in those on both sides.
                let last = if axis == along { first + HALF - 1 } else { first + HALF };
                has &= first <= at[axis] && at[axis] <= last;
                axis += 1;
            }
            eighths[place] |= (has as u8) << eighth;
            eighth += 1;
        }
        place += 1;
    }
    eighths
};

/// Looks for creases.
pub(super) struct Creases<'a> {
    samples: &'a Samples<'a>,
    /// The boxes of the normals of each eighth.
    boxes: [[Vec3A; 2]; 8],
}

impl<'a> Creases<'a> {
    const EMPTY: [Vec3A; 2] = [Vec3A::INFINITY, Vec3A::NEG_INFINITY];

    pub(super) fn new(samples: &'a Samples<'a>) -> Creases<'a> {
        Creases { samples, boxes: [Creases::EMPTY; 8] }
    }
}

impl Watch for Creases<'_> {
    #[inline(always)]
    fn note(&mut self, place: usize, vertex: u32) {
        let normal = self.samples.normal(vertex).into();
        let mut eighths = EIGHTHS[place];
        while eighths != 0 {
            let [low, high] = &mut self.boxes[eighths.trailing_zeros() as usize & 7];
            (*low, *high) = (low.min(normal), high.max(normal));
            eighths &= eighths - 1;
        }
    }

    fn is_open(&mut self, n: usize, corners: &Corners) -> bool {
        let mut unlike = 0;
        for (eighth, normals) in std::mem::replace(&mut self.boxes, [Creases::EMPTY; 8]).iter().enumerate() {
            unlike |= u8::from(!are_alike(normals, self.samples.crease)) << eighth;
        }
        unlike != 0 && !self.samples.is_plain(self.samples.blocks()[n]) && is_creased(self.samples, n, corners, unlike)
    }
}

/// Whether no two normals in a box differ as those of a crease do; 0 stands for one that is not
/// known.
#[inline(always)]
fn are_alike([low, high]: &[Vec3A; 2], crease: Crease) -> bool {
    let across = (high - low).max(Vec3A::ZERO);
    // The square of the diagonal of a box of unit normals that are alike is less than for a crease.
    across.length_squared() < (1.0 - ROUNDING) * (2.0 - 2.0 * crease.smooth)
        && low.abs().max(high.abs()).length_squared() > 0.5
}

/// Whether two normals on the loop of a cell in some eighths of block `n` differ as those of a
/// crease do.
fn is_creased(samples: &Samples<'_>, n: usize, corners: &Corners, eighths: u8) -> bool {
    let loops = CellLoop::table();
    let mut found = false;
    for_each_cell(&samples.parts.part(n).signs, |cell, case| {
        let [i, j, k] = cell.map(|at| at / HALF);
        if eighths >> (i | j << 1 | k << 2) & 1 == 0 {
            return;
        }
        let Some(outline) = &loops[usize::from(case)] else { return };
        let edges = outline.edges();
        found |= match edges.len() {
            3 => differs::<3>(samples, corners, cell, edges),
            4 => differs::<4>(samples, corners, cell, edges),
            5 => differs::<5>(samples, corners, cell, edges),
            6 => differs::<6>(samples, corners, cell, edges),
            _ => differs::<7>(samples, corners, cell, edges),
        };
    });
    found
}

#[inline(always)]
fn differs<const N: usize>(samples: &Samples<'_>, corners: &Corners, cell: [usize; 3], edges: &[u8]) -> bool {
    let Some(edges) = edges.first_chunk::<N>() else { return false };
    is_strongly_curved(&corners.of_edges(cell, edges).map(|vertex| samples.normal(vertex).into()), samples.crease)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eighths_of_an_edge_are_those_of_its_cells() {
        let mut corners = Corners::new();
        (0..3 * NODES).for_each(|place| corners.note(place, place as u32));
        let mut eighths = [0; 3 * NODES];
        for n in 0..BLOCK.pow(3) {
            let cell = [n % BLOCK, n / BLOCK % BLOCK, n / (BLOCK * BLOCK)];
            let [i, j, k] = cell.map(|at| at / HALF);
            corners.of_cell(cell)[..12].iter().for_each(|&place| eighths[place as usize] |= 1 << (i | j << 1 | k << 2));
        }
        assert_eq!(EIGHTHS, eighths);
    }

    #[test]
    fn normals_in_a_small_box_are_alike() {
        let alike = |normals: &[Vec3A]| {
            let hold = |[low, high]: [Vec3A; 2], &normal: &Vec3A| [low.min(normal), high.max(normal)];
            are_alike(&normals.iter().fold(Creases::EMPTY, hold), Crease::USUAL)
        };
        let [x, y] = [Vec3A::X, Vec3A::Y];
        assert!(alike(&[]) && alike(&[x]) && alike(&[x, Vec3A::new(0.91, 0.4146, 0.0)]));
        assert!(!alike(&[x, y]) && !alike(&[x, Vec3A::new(0.9, 0.4359, 0.0)]) && !alike(&[x, -x]));
        assert!(!alike(&[Vec3A::ZERO]) && !alike(&[x, Vec3A::ZERO]), "a normal that is not known");
    }
}
