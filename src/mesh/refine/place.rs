//! The edges and faces of a lattice that vertices are on.

use glam::{DVec3, Vec3};

use super::piece::Piece;
use crate::mesh::lattice::Lattice;

/// An edge of a lattice: its lower node, and its axis.
pub(super) type Edge = ([u32; 3], u8);

/// A face of a cell: its axis, and its lowest node.
pub(super) type Face = (u8, [u32; 3]);

/// Where a vertex is, in cells, and along which axes it is between planes of the lattice, and not
/// in one.
pub(super) fn place_of(lattice: &Lattice, at: Vec3) -> (DVec3, [bool; 3]) {
    let place = (at.as_dvec3() - lattice.origin()) / lattice.step();
    let is_between = |axis: usize| (place[axis] - place[axis].round()).abs() > lattice.slack();
    let exact = |axis| if is_between(axis) { place[axis] } else { place[axis].round() };
    (DVec3::new(exact(0), exact(1), exact(2)), [0, 1, 2].map(is_between))
}

/// The edge of a lattice that a vertex is on.
pub(super) fn edge_of(lattice: &Lattice, at: Vec3) -> Option<Edge> {
    let (place, is_between) = place_of(lattice, at);
    let mut along = (0..3).filter(|&axis| is_between[axis]);
    let axis = along.next().filter(|_| along.next().is_none())?;
    let node = std::array::from_fn(|n| if n == axis { place[n].floor() } else { place[n] } as u32);
    Some((node, axis as u8))
}

/// The face of a cell that has vertices on these edges.
pub(super) fn face_of([(a, along_a), (b, along_b)]: [Edge; 2]) -> Option<Face> {
    let is_across = |axis: &u8| *axis != along_a && *axis != along_b && a[usize::from(*axis)] == b[usize::from(*axis)];
    let mut across = (0..3).filter(is_across);
    let axis = across.next().filter(|_| across.next().is_none())?;
    let first = std::array::from_fn(|n| match n {
        _ if n == usize::from(along_a) => a[n],
        _ if n == usize::from(along_b) => b[n],
        _ => a[n].min(b[n]),
    });
    Some((axis, first))
}

/// Whether the corner opposite of an edge of a triangle is certainly within a cell.
pub(super) fn is_fan(lattice: &Lattice, all: &Piece, triangle: u32, corner: u8) -> bool {
    let apex = all.triangles[triangle as usize][usize::from(corner + 2) % 3];
    place_of(lattice, all.positions[apex as usize]).1 == [true; 3]
}
