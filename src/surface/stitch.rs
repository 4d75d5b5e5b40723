//! Faces between rows and columns of vertices.
//!
//! ```text
//!    ●───────────────●   pole: one vertex, a ring of triangles about it
//!    │ ╲ │ ╱ │ ╲ │ ╱ │
//!    ├───┼───┼───┼───┤   row: as many vertices as columns; where columns join, the first comes
//!    │   │   │   │   │   after the last again, there is no seam
//!    ├───┼───┼───┼───┤
//!    │ ╲ │ ╱ │ ╲ │ ╱ │   flat end: a fan from the last row to a vertex in its middle
//!    ○───────────────○
//! ```

use glam::{DVec2, DVec3};

use crate::geom::{Corner, QuadMesh};
use crate::{Cancelled, Run};
use rvachev_num::Meter;

/// A vertex of a grid with the normals of its four sides.
#[derive(Clone, Copy)]
pub(crate) struct Knot {
    pub(crate) point: DVec3,
    pub(crate) normal: DVec3,
    /// `[before, after]` along the rows' direction, of `[before, after]` along the columns'.
    pub(crate) sides: [[DVec3; 2]; 2],
    pub(crate) texture: DVec2,
}

impl Knot {
    /// A vertex of a smooth surface.
    pub(crate) fn smooth(point: DVec3, normal: DVec3, texture: DVec2) -> Knot {
        Knot { point, normal, sides: [[normal; 2]; 2], texture }
    }
}

/// How the first or last row closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The row is one point.
    Pole,
    /// A flat fan.
    Flat,
    /// Not at all.
    Open,
}

/// Rows and columns of faces, `columns` along the first parameter, `rows` along the second;
/// the cross product of their directions points outwards.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) rows: u32,
    pub(crate) columns: u32,
    /// Of the first and last row; nothing where they join.
    pub(crate) ends: Option<[End; 2]>,
    pub(crate) columns_join: bool,
    /// Whether faces are the other way round.
    pub(crate) mirrored: bool,
    /// The outward normal of a flat end behind the last row.
    pub(crate) axis: DVec3,
}

/// Where vertices come from: rows 0 to `rows`, columns 0 to `columns`, both included; the last
/// of joined ones differs from the first in texture and sides only.
pub(crate) trait Knots {
    fn knot(&self, row: u32, column: u32) -> Knot;
}

/// Appends the faces of a grid to a mesh.
pub(crate) fn stitch(knots: &impl Knots, layout: Layout, mesh: &mut QuadMesh, run: &Run) -> Result<(), Cancelled> {
    let open = |end: usize| layout.ends.is_some_and(|ends| ends[end] != End::Pole);
    let (first, last) = match layout.ends {
        None => (0, layout.rows - 1),
        Some(_) => (u32::from(!open(0)), layout.rows - u32::from(!open(1))),
    };
    let rings = last - first + 1;
    let width = layout.columns + u32::from(!layout.columns_join);
    let base = mesh.positions.len() as u32;
    Stitcher { knots, layout, mesh, base, first, rings, width }.stitch(run)
}

struct Stitcher<'a, K> {
    knots: &'a K,
    layout: Layout,
    mesh: &'a mut QuadMesh,
    /// The first vertex of the rings.
    base: u32,
    /// The row of the first ring: that of a pole is no ring.
    first: u32,
    rings: u32,
    /// Vertices of a ring.
    width: u32,
}

impl<K: Knots> Stitcher<'_, K> {
    fn stitch(mut self, run: &Run) -> Result<(), Cancelled> {
        let strips = if self.layout.ends.is_none() { self.rings } else { self.rings - 1 };
        let meter = Meter::new(run, self.rings + strips);
        for ring in 0..self.rings {
            meter.step()?;
            for column in 0..self.width {
                let knot = self.knots.knot(self.first + ring, column);
                self.vertex(knot.point, knot.normal);
            }
        }
        for strip in 0..strips {
            meter.step()?;
            for column in 0..self.layout.columns {
                self.quad(strip, column);
            }
        }
        let Some(ends) = self.layout.ends else { return Ok(()) };
        for (end, row) in ends.into_iter().zip([0, self.layout.rows]) {
            match end {
                End::Pole => self.pole(row),
                End::Flat => self.cap(row),
                End::Open => {}
            }
        }
        Ok(())
    }

    fn vertex(&mut self, point: DVec3, normal: DVec3) -> u32 {
        self.mesh.positions.push(point);
        self.mesh.normals.push(normal);
        self.mesh.positions.len() as u32 - 1
    }

    fn at(&self, ring: u32, column: u32) -> u32 {
        self.base + (ring % self.rings) * self.width + column % self.width
    }

    /// The corner of a face at a row and column, on the side of it where the face is.
    fn corner(&self, [row, column]: [u32; 2], [after_row, after_column]: [usize; 2]) -> Corner {
        let knot = self.knots.knot(row, column);
        Corner { normal: knot.sides[after_row][after_column], texture: knot.texture }
    }

    fn quad(&mut self, strip: u32, column: u32) {
        let corner = |right: u32, up: u32| {
            let vertex = self.at(strip + up, column + right);
            let sides = [1 - up as usize, 1 - right as usize];
            (vertex, self.corner([self.first + strip + up, column + right], sides))
        };
        let [a, b, c, d] = self.turned([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        self.mesh.quads.push([a.0, b.0, c.0, d.0]);
        self.mesh.quad_corners.push([a.1, b.1, c.1, d.1]);
    }

    fn triangle(&mut self, corners: [(u32, Corner); 3], upwards: bool) {
        let [a, b, c] = self.turned(corners);
        let [a, b, c] = if upwards { [a, b, c] } else { [a, c, b] };
        self.mesh.triangles.push([a.0, b.0, c.0]);
        self.mesh.triangle_corners.push([a.1, b.1, c.1]);
    }

    /// The other way round on a mirror image.
    fn turned<const N: usize>(&self, mut corners: [(u32, Corner); N]) -> [(u32, Corner); N] {
        if self.layout.mirrored {
            corners.reverse();
        }
        corners
    }

    /// A vertex and a fan of triangles in place of the first or last row.
    fn pole(&mut self, row: u32) {
        let last = row == self.layout.rows;
        let columns = self.layout.columns;
        let (ring, beside) = if last { (self.rings - 1, row - 1) } else { (0, 1) };
        let side = usize::from(!last);
        let tips: Vec<Corner> = (0..columns)
            .map(|column| {
                let left = self.corner([row, column], [side, 1]);
                let right = self.corner([row, column + 1], [side, 0]);
                let texture = 0.5 * (left.texture + right.texture);
                Corner { normal: (left.normal + right.normal).normalize_or_zero(), texture }
            })
            .collect();
        // Normals about a tip may cancel, as those about the middle of a horn do.
        let mean = tips.iter().map(|tip| tip.normal).sum::<DVec3>() / f64::from(columns);
        let up = if last { self.layout.axis } else { -self.layout.axis };
        let normal = if mean.length() > 1e-9 { mean.normalize() } else { up };
        let pole = self.vertex(self.knots.knot(row, 0).point, normal);
        for column in 0..columns {
            let base = [0, 1].map(|right: u32| {
                let sides = [1 - side, 1 - right as usize];
                (self.at(ring, column + right), self.corner([beside, column + right], sides))
            });
            self.triangle([base[0], base[1], (pole, tips[column as usize])], last);
        }
    }

    /// A flat fan across an end, about the middle of its row.
    fn cap(&mut self, row: u32) {
        let last = row == self.layout.rows;
        let ring = if last { self.rings - 1 } else { 0 };
        let columns = self.layout.columns;
        let axis = self.layout.axis;
        let normal = if last { axis } else { -axis };
        let rim: Vec<DVec3> = (0..columns).map(|c| self.mesh.positions[self.at(ring, c) as usize]).collect();
        // Where the axis meets the plane of the rim.
        let center = axis * rim[0].dot(axis);
        let size = rim.iter().map(|p| p.distance(center)).fold(f64::MIN_POSITIVE, f64::max);
        let middle = self.vertex(center, normal);
        let corner = |p: DVec3| {
            let p = (p - center) / (2.0 * size);
            let flat = if axis.z == 0.0 { DVec2::new(p.y, p.z) } else { p.truncate() };
            Corner { normal, texture: DVec2::splat(0.5) + flat }
        };
        for column in 0..columns {
            let next = (column + 1) % columns;
            let base = [column, next].map(|c| (self.at(ring, c), corner(rim[c as usize])));
            self.triangle([base[0], base[1], (middle, corner(center))], last);
        }
    }
}
