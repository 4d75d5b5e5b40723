//! Grids of control points: tensor products of the scheme with itself.

use glam::{DVec2, DVec3};

use super::refine::{refine, refined_len, stencil};
use super::{MOST_IN_MESH, SubdivisionError, Tension, check_coordinates, check_levels};
use crate::geom::QuadMesh;
use crate::surface::stitch::{End, Knot, Knots, Layout, stitch};
use crate::{Cancelled, Run};
use rvachev_num::Meter;

/// A grid of control points, rows × columns, open or closed each way.
///
/// An open direction behaves like an open [`ControlPolygon`](crate::subdivision::ControlPolygon):
/// its surface runs from the limit of the second row to that of the last but one.
///
/// The outside is where the direction along a row (column by column) turns anticlockwise into
/// the direction from row to row.
///
/// ```
/// use glam::DVec3;
/// use rvachev::subdivision::{ControlGrid, Tension};
///
/// // A wavy sheet of 5 × 6 points, open both ways.
/// let at = |i: i32, j: i32| DVec3::new(f64::from(j), f64::from(i), f64::from((i * j) % 2));
/// let points: Vec<DVec3> = (0..5).flat_map(|i| (0..6).map(move |j| at(i, j))).collect();
/// let sheet = ControlGrid::new(&points, [5, 6], [false, false], [Tension::CUBIC; 2])?;
/// let mesh = sheet.limit_mesh(3)?;
/// assert_eq!(mesh.quads().len(), (2 * 8) * (3 * 8));
/// # Ok::<(), rvachev::subdivision::SubdivisionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ControlGrid {
    points: Vec<[f64; 3]>,
    rows: usize,
    columns: usize,
    /// From row to row, from column to column.
    closed: [bool; 2],
    tension: [Tension; 2],
}

impl ControlGrid {
    /// A grid of `[rows, columns]` points, row by row; `closed` and `tension` are those from row
    /// to row and from column to column. A closed direction has 3 points or more, an open one 4.
    ///
    /// # Errors
    /// Too few points, not rows × columns of them, or a coordinate that is not finite or beyond
    /// 10¹².
    pub fn new(
        points: &[DVec3],
        [rows, columns]: [usize; 2],
        closed: [bool; 2],
        tension: [Tension; 2],
    ) -> Result<ControlGrid, SubdivisionError> {
        for (of, count, closed) in
            [("a column of the grid", rows, closed[0]), ("a row of the grid", columns, closed[1])]
        {
            let least = if closed { 3 } else { 4 };
            if count < least {
                return Err(SubdivisionError::TooFewPoints { of, points: count, least });
            }
        }
        if rows.checked_mul(columns) != Some(points.len()) {
            return Err(SubdivisionError::Grid { points: points.len(), rows, columns });
        }
        check_coordinates(points.iter().map(DVec3::to_array))?;
        let points = points.iter().map(DVec3::to_array).collect();
        Ok(ControlGrid { points, rows, columns, closed, tension })
    }

    /// The points, row by row.
    #[must_use]
    pub fn points(&self) -> Vec<DVec3> {
        self.points.iter().map(|&p| p.into()).collect()
    }

    /// `[rows, columns]`.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }

    /// The grid after some levels both ways, with the tensions that go on from there.
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁴ points.
    pub fn subdivided(&self, levels: u32) -> Result<ControlGrid, SubdivisionError> {
        self.subdivided_with(levels, &Run::default())
    }

    /// [`subdivided`](ControlGrid::subdivided) with a cancel token and a progress sink; on one
    /// thread.
    ///
    /// # Errors
    /// Those of [`subdivided`](ControlGrid::subdivided), and [`SubdivisionError::Cancelled`].
    pub fn subdivided_with(&self, levels: u32, run: &Run) -> Result<ControlGrid, SubdivisionError> {
        check_levels(self.points.len(), levels, 2, MOST_IN_MESH)?;
        let run = run.stage(0.0, 1.0);
        let longer = |count: [usize; 2]| [0, 1].map(|k| refined_len(count[k], self.closed[k]));
        let sizes = std::iter::successors(Some(self.size()), |size| Some(longer(*size)));
        let passes = sizes.take(levels as usize).map(|size| pass_points(size, longer(size)));
        let meter = Meter::new(&run, passes.sum::<usize>());
        let mut grid = self.clone();
        for level in 1..=levels {
            let masks = self.tension.map(|tension| tension.mask(level));
            let level = |mask: [f64; 2]| {
                move |row: &[[f64; 3]], closed: bool, to: &mut Vec<[f64; 3]>| {
                    to.clear();
                    to.extend_from_slice(row);
                    to.resize(refined_len(row.len(), closed), [0.0; 3]);
                    refine(to, row.len(), closed, mask);
                }
            };
            grid = grid.both_ways(level(masks[0]), level(masks[1]), &meter)?;
        }
        run.report(1.0);
        Ok(ControlGrid { tension: self.tension.map(|tension| tension.at_level(levels)), ..grid })
    }

    /// The control points as a mesh without normals: the cage.
    #[must_use]
    pub fn control_cage(&self) -> QuadMesh {
        let mut mesh = QuadMesh::default();
        let sheet = Sheet { grid: self, along: None };
        // Nobody cancels it.
        let _ = stitch(&sheet, sheet.layout(), &mut mesh, &Run::default());
        QuadMesh { normals: vec![], quad_corners: vec![], triangle_corners: vec![], ..mesh }
    }

    /// Points of the limit surface after some levels, as quadrilaterals with its normals (zero
    /// where the surface is degenerate).
    ///
    /// # Errors
    /// [`SubdivisionError::Levels`] for more than 2²⁴ points.
    pub fn limit_mesh(&self, levels: u32) -> Result<QuadMesh, SubdivisionError> {
        self.limit_mesh_with(levels, &Run::default())
    }

    /// [`limit_mesh`](ControlGrid::limit_mesh) with a cancel token and a progress sink; on one
    /// thread.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rvachev::subdivision::{ControlGrid, SubdivisionError, Tension};
    /// use rvachev::Run;
    ///
    /// let points: Vec<DVec3> = (0..16).map(|i| [i % 4, i / 4, i % 3].map(f64::from).into()).collect();
    /// let sheet = ControlGrid::new(&points, [4, 4], [false; 2], [Tension::CUBIC; 2])?;
    /// let run = Run::default();
    /// run.cancel.cancel();
    /// assert!(matches!(sheet.limit_mesh_with(8, &run), Err(SubdivisionError::Cancelled(_))));
    /// # Ok::<(), SubdivisionError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`limit_mesh`](ControlGrid::limit_mesh), and [`SubdivisionError::Cancelled`].
    pub fn limit_mesh_with(&self, levels: u32, run: &Run) -> Result<QuadMesh, SubdivisionError> {
        let run = run.stage(0.0, 1.0);
        let [refining, smoothing, stitching] = run.stages([3.0, 2.0, 5.0]);
        let grid = self.subdivided_with(levels, &refining)?;
        let point = grid.tension.map(|tension| {
            let [neighbour, own] = tension.limit_weights(0);
            [neighbour, own, neighbour]
        });
        let slope = grid.tension.map(|tension| {
            let weight = tension.tangent_weight(0);
            [-weight, 0.0, weight]
        });
        let made = [0, 1].map(|k| grid.size()[k] - if grid.closed[k] { 0 } else { 2 });
        let meter = Meter::new(&smoothing, 3 * pass_points(grid.size(), made));
        let limit = grid.stencilled(point[0], point[1], &meter)?;
        let along = [grid.stencilled(slope[0], point[1], &meter)?, grid.stencilled(point[0], slope[1], &meter)?];
        let mut mesh = QuadMesh::default();
        let sheet = Sheet { grid: &limit, along: Some(along) };
        stitch(&sheet, sheet.layout(), &mut mesh, &stitching)?;
        run.report(1.0);
        Ok(mesh)
    }

    fn stencilled(
        &self,
        row_to_row: [f64; 3],
        column_to_column: [f64; 3],
        meter: &Meter<'_>,
    ) -> Result<ControlGrid, Cancelled> {
        let apply = |weights: [f64; 3]| {
            move |row: &[[f64; 3]], closed: bool, to: &mut Vec<[f64; 3]>| *to = stencil(row, closed, weights)
        };
        self.both_ways(apply(row_to_row), apply(column_to_column), meter)
    }

    /// The grid with each row made anew by the second rule, then each column by the first. Counts
    /// [`pass_points`].
    fn both_ways(
        &self,
        row_to_row: impl Fn(&[[f64; 3]], bool, &mut Vec<[f64; 3]>),
        column_to_column: impl Fn(&[[f64; 3]], bool, &mut Vec<[f64; 3]>),
        meter: &Meter<'_>,
    ) -> Result<ControlGrid, Cancelled> {
        self.along_rows(column_to_column, meter)?.along_rows(row_to_row, meter)
    }

    /// The grid with each row made anew, transposed.
    fn along_rows(
        &self,
        make: impl Fn(&[[f64; 3]], bool, &mut Vec<[f64; 3]>),
        meter: &Meter<'_>,
    ) -> Result<ControlGrid, Cancelled> {
        let mut points = Vec::new();
        let mut made = Vec::new();
        for row in self.points.chunks_exact(self.columns) {
            meter.check()?;
            make(row, self.closed[1], &mut made);
            points.extend_from_slice(&made);
            meter.add(made.len() as u64);
        }
        ControlGrid { columns: points.len() / self.rows, points, ..*self }.transposed(meter)
    }

    fn transposed(&self, meter: &Meter<'_>) -> Result<ControlGrid, Cancelled> {
        let (rows, columns) = (self.columns, self.rows);
        let mut points = Vec::with_capacity(self.points.len());
        for row in 0..rows {
            meter.check()?;
            points.extend((0..columns).map(|column| self.points[column * self.columns + row]));
            meter.add(columns as u64);
        }
        let ([a, b], [s, t]) = (self.closed, self.tension);
        Ok(ControlGrid { points, rows, columns, closed: [b, a], tension: [t, s] })
    }

    fn at(&self, row: usize, column: usize) -> DVec3 {
        self.points[(row % self.rows) * self.columns + column % self.columns].into()
    }
}

/// The points that are made and moved when a grid is made longer, or shorter, both ways.
fn pass_points([rows, _]: [usize; 2], [longer_rows, longer_columns]: [usize; 2]) -> usize {
    2 * longer_columns * (rows + longer_rows)
}

/// A grid of points, with the tangents from row to row and from column to column.
struct Sheet<'a> {
    grid: &'a ControlGrid,
    along: Option<[ControlGrid; 2]>,
}

impl Sheet<'_> {
    fn layout(&self) -> Layout {
        let [rows_close, columns_join] = self.grid.closed;
        Layout {
            rows: self.grid.rows as u32 - u32::from(!rows_close),
            columns: self.grid.columns as u32 - u32::from(!columns_join),
            ends: (!rows_close).then_some([End::Open; 2]),
            columns_join,
            mirrored: false,
            axis: DVec3::Z,
        }
    }
}

impl Knots for Sheet<'_> {
    fn knot(&self, row: u32, column: u32) -> Knot {
        let (i, j) = (row as usize, column as usize);
        let normal = self.along.as_ref().map_or(DVec3::ZERO, |[from_row, from_column]| {
            from_column.at(i, j).cross(from_row.at(i, j)).normalize_or_zero()
        });
        let Layout { rows, columns, .. } = self.layout();
        let texture = DVec2::new(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
        Knot::smooth(self.grid.at(i, j), normal, texture)
    }
}
