//! Whether the surface has a crease in a block: a solid without any has the triangles of the case table.

use super::bulge::is_crease;
use super::join::Corners;
use super::samples::Samples;
use crate::mesh::loops::CellLoop;
use crate::mesh::signs::for_each_cell;

/// Whether two normals on the loop of a cell of block `n` differ as those of a crease do.
pub(super) fn is_creased(samples: &Samples<'_>, n: usize, corners: &Corners) -> bool {
    let loops = CellLoop::table();
    let mut found = false;
    for_each_cell(&samples.parts.part(n).signs, |cell, case| {
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
    is_crease(&corners.of_edges(cell, edges).map(|vertex| samples.normal(vertex).into()))
}
