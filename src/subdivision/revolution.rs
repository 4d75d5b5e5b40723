//! A profile revolved along a path, both of them control polygons.
//!
//! ```text
//!     profile (r, h)(s)          path (p, q)(t), closed
//!
//!     point   ( r·p, r·q, h )    the limit surface is the product of the limit curves, and the
//!     normal  ( n_p·m_r, n_q·m_r, κ·m_h )    control points that of the control points
//! ```
//!
//! With the unit circle as its path this is a surface of revolution; with an ellipse a quadric;
//! any closed polygon will do.

use glam::{DVec2, DVec3};

use super::quadric::ProfileMap;
use super::{ControlPolygon, MOST_IN_MESH, SubdivisionError, check_levels};
use crate::geom::QuadMesh;
use crate::surface::stitch::{End, Knot, Knots, Layout, stitch};
use crate::{Cancelled, Run};

/// How an end of an open profile is closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProfileEnd {
    /// The profile ends on the axis: the radius there is 0.
    Pole,
    /// A flat face across.
    Flat,
    /// Not at all.
    Open,
}

/// The limit surface of a profile polygon that is revolved along a closed path polygon.
///
/// The profile has radius and height as x and y. It runs with the outside on its right: from
/// below to above, a closed one anticlockwise; the path runs anticlockwise seen from above. (Closed
/// polygons that run the other way are taken for what they bound.)
///
/// ```
/// use rvachev::subdivision::SubdivisionRevolution;
///
/// // The ellipsoid that touches the six sides of a box of 4 × 2 × 1.4.
/// let ellipsoid = SubdivisionRevolution::ellipsoid([2.0, 1.0, 0.7])?;
/// let mesh = ellipsoid.limit_mesh([4, 4])?;
/// for p in mesh.positions() {
///     assert!(((p.x / 2.0).powi(2) + p.y.powi(2) + (p.z / 0.7).powi(2) - 1.0).abs() < 1e-13);
/// }
/// assert!(mesh.to_mesh()?.check().is_closed());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SubdivisionRevolution {
    profile: ControlPolygon<DVec2>,
    path: ControlPolygon<DVec2>,
    /// Of an open profile.
    ends: Option<[ProfileEnd; 2]>,
    /// What profile points are moved by, after the limit stencil.
    map: ProfileMap,
    /// Whether the mirror image below belongs to it.
    both_sides: bool,
}

/// Points and normals of a curve.
struct Line {
    points: Vec<DVec2>,
    normals: Vec<DVec2>,
}

impl SubdivisionRevolution {
    /// Any profile along any closed path. The ends of an open profile are left open, unless
    /// [`with_ends`](Self::with_ends) closes them.
    ///
    /// # Errors
    /// [`SubdivisionError::Parameter`] if the path is not closed.
    pub fn new(
        profile: ControlPolygon<DVec2>,
        path: ControlPolygon<DVec2>,
    ) -> Result<SubdivisionRevolution, SubdivisionError> {
        if !path.is_closed() {
            let allowed = "a closed one";
            return Err(SubdivisionError::Parameter { parameter: "ends of the path", value: 2.0, allowed });
        }
        let ends = (!profile.is_closed()).then_some([ProfileEnd::Open; 2]);
        Ok(SubdivisionRevolution { profile, path, ends, map: ProfileMap::None, both_sides: false })
    }

    /// The same with the ends of an open profile, first and last, closed as given. Without
    /// effect on a closed one.
    #[must_use]
    pub fn with_ends(self, first: ProfileEnd, last: ProfileEnd) -> SubdivisionRevolution {
        let ends = self.ends.map(|_| [first, last]);
        SubdivisionRevolution { ends, ..self }
    }

    pub(super) fn mapped(self, map: ProfileMap, both_sides: bool) -> SubdivisionRevolution {
        SubdivisionRevolution { map, both_sides, ..self }
    }

    /// The profile.
    #[must_use]
    pub fn profile(&self) -> &ControlPolygon<DVec2> {
        &self.profile
    }

    /// The path.
    #[must_use]
    pub fn path(&self) -> &ControlPolygon<DVec2> {
        &self.path
    }

    /// The control points as a mesh without normals: the cage. (Points that only steer the ends
    /// of an open profile are left out; of a hyperboloid by its map, the moved control points.)
    #[must_use]
    pub fn control_cage(&self) -> QuadMesh {
        let mut points = self.profile.points();
        if !self.profile.is_closed() {
            points = points[1..points.len() - 1].to_vec();
        }
        self.map.apply(&mut points, None);
        // Nobody cancels it.
        self.bare(points, self.path.points(), &Run::default()).unwrap_or_default()
    }

    /// The points of the polygons after some levels along profile and path, without the limit
    /// stencil: they are off the limit surface by an error that falls by 4 a level.
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁴ points.
    pub fn subdivided_mesh(&self, levels: [u32; 2]) -> Result<QuadMesh, SubdivisionError> {
        self.subdivided_mesh_with(levels, &Run::default())
    }

    /// [`subdivided_mesh`](SubdivisionRevolution::subdivided_mesh) with a cancel token and a
    /// progress sink; on one thread.
    ///
    /// # Errors
    /// Those of [`subdivided_mesh`](SubdivisionRevolution::subdivided_mesh), and
    /// [`SubdivisionError::Cancelled`].
    pub fn subdivided_mesh_with(&self, levels: [u32; 2], run: &Run) -> Result<QuadMesh, SubdivisionError> {
        self.check(levels)?;
        run.check()?;
        let mut points = self.profile.subdivided(levels[0])?.points();
        if !self.profile.is_closed() {
            // One point at each end, at whatever level, lies beyond and steers.
            points = points[1..points.len() - 1].to_vec();
        }
        self.map.apply(&mut points, None);
        Ok(self.bare(points, self.path.subdivided(levels[1])?.points(), run)?)
    }

    /// Points of the limit surface after some levels along profile and path, with its normals:
    /// exact for conics whatever the level.
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁴ points.
    pub fn limit_mesh(&self, levels: [u32; 2]) -> Result<QuadMesh, SubdivisionError> {
        self.limit_mesh_with(levels, &Run::default())
    }

    /// [`limit_mesh`](SubdivisionRevolution::limit_mesh) with a cancel token and a progress sink;
    /// on one thread.
    ///
    /// # Errors
    /// Those of [`limit_mesh`](SubdivisionRevolution::limit_mesh), and
    /// [`SubdivisionError::Cancelled`].
    pub fn limit_mesh_with(&self, levels: [u32; 2], run: &Run) -> Result<QuadMesh, SubdivisionError> {
        self.check(levels)?;
        run.check()?;
        let line = |polygon: &ControlPolygon<DVec2>, levels: u32, map: ProfileMap| {
            let polygon = polygon.subdivided(levels)?;
            let (mut points, mut tangents) = (polygon.limit_points(), polygon.limit_tangents());
            map.apply(&mut points, Some(&mut tangents));
            Ok::<_, SubdivisionError>(Line { points, normals: tangents.iter().map(|t| -t.perp()).collect() })
        };
        let profile = line(&self.profile, levels[0], self.map)?;
        let path = line(&self.path, levels[1], ProfileMap::None)?;
        Ok(self.stitched(&profile, &path, self.sign(), run)?)
    }

    fn check(&self, levels: [u32; 2]) -> Result<(), SubdivisionError> {
        check_levels(self.profile.len(), levels[0], 1, MOST_IN_MESH)?;
        check_levels(self.path.len() * (self.profile.len() << levels[0]), levels[1], 1, MOST_IN_MESH)
    }

    /// A mesh of positions and faces.
    fn bare(&self, profile: Vec<DVec2>, path: Vec<DVec2>, run: &Run) -> Result<QuadMesh, Cancelled> {
        let line = |points: Vec<DVec2>| Line { normals: vec![DVec2::ZERO; points.len()], points };
        let (profile, path) = (line(profile), line(path));
        let mesh = self.stitched(&profile, &path, 1.0, run)?;
        Ok(QuadMesh { normals: vec![], quad_corners: vec![], triangle_corners: vec![], ..mesh })
    }

    /// The faces between the points of a profile and of a path, on both sides if there are two.
    fn stitched(&self, profile: &Line, path: &Line, sign: f64, run: &Run) -> Result<QuadMesh, Cancelled> {
        let run = run.stage(0.0, 1.0);
        let mut mesh = QuadMesh::default();
        let upper = if self.both_sides { 0.5 } else { 1.0 };
        for (lower, part) in [(false, run.stage(0.0, upper)), (true, run.stage(upper, 1.0))] {
            if !lower || self.both_sides {
                let product = Product { profile, path, sign, lower };
                stitch(&product, self.layout(profile, path, lower), &mut mesh, &part)?;
            }
        }
        run.report(1.0);
        Ok(mesh)
    }

    /// −1 if the outside is on the left of exactly one of the two polygons.
    fn sign(&self) -> f64 {
        let area = |polygon: &ControlPolygon<DVec2>| -> f64 {
            let points = polygon.points();
            (0..points.len()).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum()
        };
        let left = |polygon: &ControlPolygon<DVec2>| polygon.is_closed() && area(polygon) < 0.0;
        if left(&self.profile) == left(&self.path) { 1.0 } else { -1.0 }
    }

    fn layout(&self, profile: &Line, path: &Line, lower: bool) -> Layout {
        let ends = self.ends.map(|ends| {
            ends.map(|end| match end {
                ProfileEnd::Pole => End::Pole,
                ProfileEnd::Flat => End::Flat,
                ProfileEnd::Open => End::Open,
            })
        });
        let rows = profile.points.len() as u32 - u32::from(ends.is_some());
        let columns = path.points.len() as u32;
        let mirrored = lower != (self.sign() < 0.0);
        let axis = if lower { DVec3::NEG_Z } else { DVec3::Z };
        Layout { rows, columns, ends, columns_join: true, mirrored, axis }
    }
}

/// The product of two curves.
struct Product<'a> {
    profile: &'a Line,
    path: &'a Line,
    sign: f64,
    lower: bool,
}

impl Knots for Product<'_> {
    fn knot(&self, row: u32, column: u32) -> Knot {
        let (i, j) = (row as usize % self.profile.points.len(), column as usize % self.path.points.len());
        let (p, q) = (self.profile.points[i], self.path.points[j]);
        let (m, n) = (self.profile.normals[i], self.path.normals[j]);
        let side = if self.lower { -1.0 } else { 1.0 };
        let point = DVec3::new(p.x * q.x, p.x * q.y, side * p.y);
        let normal = DVec3::new(n.x * m.x, n.y * m.x, side * q.dot(n) * m.y) * self.sign;
        let share = |i: u32, of: usize| f64::from(i) / of as f64;
        let texture = DVec2::new(share(column, self.path.points.len()), share(row, self.profile.points.len()));
        Knot::smooth(point, normal.normalize_or_zero(), texture)
    }
}
