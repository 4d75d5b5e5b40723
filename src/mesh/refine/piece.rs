//! The part of a mesh in some blocks, open where the others begin.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::side::Side;
use crate::geom::{Findings, Mesh, MeshError};
use crate::{Cancelled, Run};

/// Triangles that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 1 << 14;

/// A part of a mesh.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The normals at the corners of the triangles, if they are not those of their vertices.
    corners: Option<Vec<[Vec3; 3]>>,
    clamped: usize,
    /// The side of a cell of the first part.
    cell: f64,
    /// The middles of blocks that may have lost something.
    lost_at: Vec<DVec3>,
}

/// An edge of a single triangle, at the border of a part.
#[derive(Clone, Copy)]
pub(super) struct Rim {
    pub(super) triangle: u32,
    /// The corner that the edge starts from.
    pub(super) corner: u8,
    pub(super) from: u32,
    pub(super) to: u32,
    /// Whether what was cut off there is around the part, and not within it.
    pub(super) is_outer: bool,
}

impl Rim {
    /// The same where the part follows `triangles` others and its vertices are numbered anew.
    pub(super) fn moved(self, triangles: u32, numbers: &[u32]) -> Rim {
        let [from, to] = [self.from, self.to].map(|vertex| numbers[vertex as usize]);
        Rim { triangle: self.triangle + triangles, from, to, ..self }
    }
}

impl Piece {
    /// What is left of a mesh without the triangles on other sides, told by their middles.
    pub(super) fn cut(mesh: &Mesh, side: impl Fn(DVec3) -> Side, run: &Run) -> Result<(Piece, Vec<Rim>), Cancelled> {
        let mut sides = Vec::with_capacity(mesh.triangles().len());
        for triangles in mesh.triangles().chunks(AT_ONCE) {
            run.check()?;
            sides.extend(triangles.iter().map(|&t| side(mesh.corners(t).into_iter().sum::<DVec3>() / 3.0)));
        }
        let directed = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        let mut gone: HashMap<[u32; 2], bool> = HashMap::new();
        for (&triangle, &side) in mesh.triangles().iter().zip(&sides) {
            if side != Side::Own {
                gone.extend(directed(triangle).map(|edge| (edge, side == Side::Around)));
            }
        }
        let mut numbers = vec![u32::MAX; mesh.positions().len()];
        let (mut piece, mut rims) = (Piece::default(), Vec::new());
        piece.clamped = mesh.clamped_vertices().unwrap_or(0);
        piece.cell = mesh.findings().cell;
        piece.lost_at = mesh.findings().lost_at.iter().copied().filter(|p| side(*p) == Side::Own).collect();
        let given = mesh.corner_normals();
        let normals = mesh.normals().unwrap_or_default();
        let mut corners = Vec::new();
        for (n, &triangle) in mesh.triangles().iter().enumerate() {
            if n % AT_ONCE == 0 {
                run.check()?;
            }
            if sides[n] != Side::Own {
                continue;
            }
            let new = triangle.map(|vertex| {
                let number = &mut numbers[vertex as usize];
                if *number == u32::MAX {
                    *number = piece.positions.len() as u32;
                    piece.positions.push(mesh.positions()[vertex as usize]);
                    piece.normals.push(normals[vertex as usize]);
                }
                *number
            });
            for (corner, [a, b]) in (0..).zip(directed(triangle)) {
                if let Some(&is_outer) = gone.get(&[b, a]) {
                    let [from, to] = [a, b].map(|vertex| numbers[vertex as usize]);
                    rims.push(Rim { triangle: piece.triangles.len() as u32, corner, from, to, is_outer });
                }
            }
            piece.triangles.push(new);
            corners.extend(given.map(|given| given[n]));
        }
        piece.corners = given.map(|_| corners);
        Ok((piece, rims))
    }

    /// Adds another part, some of whose vertices are some of this: pairs of their number there and
    /// here. The numbers that its vertices have here; nothing if there are too many.
    pub(super) fn append(&mut self, other: Piece, same: &[(u32, u32)]) -> Option<Vec<u32>> {
        let mut numbers = vec![u32::MAX; other.positions.len()];
        same.iter().for_each(|&(there, here)| numbers[there as usize] = here);
        for (n, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number == u32::MAX) {
            *number = u32::try_from(self.positions.len()).ok().filter(|&number| number < u32::MAX)?;
            self.positions.push(other.positions[n]);
            self.normals.push(other.normals[n]);
        }
        if self.corners.is_some() || other.corners.is_some() {
            let corners = other.corners.unwrap_or_else(|| of_vertices(&other.triangles, &other.normals));
            self.corners.get_or_insert_with(|| of_vertices(&self.triangles, &self.normals)).extend(corners);
        }
        self.triangles.extend(other.triangles.into_iter().map(|t| t.map(|vertex| numbers[vertex as usize])));
        self.clamped += other.clamped;
        self.lost_at.extend(other.lost_at);
        // Parts come from larger cells to smaller ones.
        self.cell = self.cell.max(other.cell);
        Some(numbers)
    }

    /// Adds a vertex of a crease on an edge, with the normals on its two sides; nothing if there
    /// are too many.
    pub(super) fn add(&mut self, at: Vec3, [before, after]: [Vec3; 2]) -> Option<Between> {
        let vertex = u32::try_from(self.positions.len()).ok().filter(|&vertex| vertex < u32::MAX)?;
        self.positions.push(at);
        self.normals.push((before + after).normalize_or(before));
        Some(Between { vertex, before, after })
    }

    /// A vertex on an edge that has the same normal on both sides.
    pub(super) fn between(&self, vertex: u32) -> Between {
        let normal = self.normals[vertex as usize];
        Between { vertex, before: normal, after: normal }
    }

    /// Cuts a triangle so that its edges have these vertices, in the order of its corners.
    pub(super) fn split(&mut self, triangle: u32, edges: [Vec<Between>; 3]) {
        let own = self.corners.as_ref().map(|corners| corners[triangle as usize]);
        let corner = |n: usize| {
            let vertex = self.triangles[triangle as usize][n];
            (vertex, own.map_or(self.normals[vertex as usize], |own| own[n]))
        };
        let mut parts = Vec::new();
        fill([corner(0), corner(1), corner(2)], edges, &mut parts);
        for (n, part) in parts.into_iter().enumerate() {
            let at = if n == 0 { triangle as usize } else { self.triangles.len() };
            put(&mut self.triangles, at, part.map(|(vertex, _)| vertex));
            if let Some(corners) = &mut self.corners {
                put(corners, at, part.map(|(_, normal)| normal));
            }
        }
    }

    pub(super) fn into_mesh(self) -> Result<Mesh, MeshError> {
        let mesh = Mesh::new(self.positions, self.triangles)?.with_normals(self.normals)?;
        let (clamped_vertices, possibly_lost) = (Some(self.clamped), self.lost_at.len());
        let found =
            Findings { cell: self.cell, clamped_vertices, possibly_lost, lost_at: self.lost_at, ..Findings::default() };
        let mesh = mesh.with_findings(found);
        match self.corners {
            Some(corners) => mesh.with_corner_normals(corners),
            None => Ok(mesh),
        }
    }
}

/// Puts an item in place of one, or at the end.
fn put<T>(list: &mut Vec<T>, at: usize, item: T) {
    match list.get_mut(at) {
        Some(old) => *old = item,
        None => list.push(item),
    }
}

/// A vertex with its normal.
type Corner = (u32, Vec3);

/// A vertex on an edge, and its normals on the two sides of it in the direction of the edge.
#[derive(Clone, Copy)]
pub(super) struct Between {
    pub(super) vertex: u32,
    pub(super) before: Vec3,
    pub(super) after: Vec3,
}

/// The triangles of one whose edges have more vertices.
fn fill([a, b, c]: [Corner; 3], [ab, bc, ca]: [Vec<Between>; 3], out: &mut Vec<[Corner; 3]>) {
    match (ab.first(), ab.last()) {
        (Some(first), Some(last)) => {
            fill([a, (first.vertex, first.before), c], [Vec::new(), Vec::new(), ca], out);
            out.extend(
                ab.windows(2).map(|pair| [(pair[0].vertex, pair[0].after), (pair[1].vertex, pair[1].before), c]),
            );
            fill([(last.vertex, last.after), b, c], [Vec::new(), bc, Vec::new()], out);
        }
        _ if bc.is_empty() && ca.is_empty() => out.push([a, b, c]),
        _ => fill([b, c, a], [bc, ca, ab], out),
    }
}

/// The normals of vertices at the corners of triangles.
fn of_vertices(triangles: &[[u32; 3]], normals: &[Vec3]) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|t| t.map(|vertex| normals[vertex as usize])).collect()
}
