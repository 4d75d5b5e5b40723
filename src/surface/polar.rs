//! Barr's two sheets along x, in polar form about their apices.
//!
//! ```text
//!     x/a₁ = ξ = sec^e₁ η · sec^e₂ ω     at a row all points have the same ξ, so that the last row
//!                                        is the rim of the clipped end
//!     ln ξ = ln ξ_end · row²             divided between the two secants by the squared cosine
//!                                        and sine of the column's angle
//! ```
//!
//! Rows at equal lengths are those of the meridian that reaches farthest, columns those of the rim:
//! the rings between are as even as the shapes of their sections are alike.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::curve::Curve;
use super::parametric::ParametricSurface;
use super::patch::PatchError;
use super::spacing::{Chain, equal_steps};
use super::stitch::Knot;
use crate::{Run, rad};

/// How the logarithm of ξ is divided between the two secants, η's first: the logarithms of their
/// shares, and the sides of the axes that the column is on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    shares: [f64; 2],
    sides: [f64; 2],
    /// How far around, from 0 to 1.
    texture: f64,
}

impl Column {
    /// By the angle, anticlockwise about the apex seen from outside.
    fn at_angle(around: f64) -> Column {
        let (sin, cos) = rad((2.0 * around - 1.0) * PI).sin_cos();
        Column { shares: [sin, cos].map(|c| 2.0 * c.abs().ln()), sides: [sin, cos], texture: around }
    }

    /// By the logarithm t of the ratio of the shares, which runs from −∞ to ∞ in a quarter: the
    /// sections of squarish bowls leave their axes within 10⁻³⁰⁰ of the angle.
    fn at_ratio(around: f64) -> Column {
        const WIDEST: f64 = 3000.0;
        let quarter = (4.0 * around).floor().min(3.0);
        let way = 4.0 * around - quarter;
        // From −x to −y to x to y, as angles from −π do.
        let sides = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]][quarter as usize];
        let t = WIDEST * (2.0 * way - 1.0);
        // ln(1/(1 + e^−t)), all or nothing at the ends.
        let share = |t: f64| match t {
            t if t <= -WIDEST => f64::NEG_INFINITY,
            t => t.min(0.0) - (-t.abs()).exp().ln_1p(),
        };
        let (rising, falling) = (share(t), share(-t));
        let shares = if quarter % 2.0 == 0.0 { [rising, falling] } else { [falling, rising] };
        Column { shares, sides, texture: around }
    }
}

/// Shares of the rows, and the columns.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    rows: Vec<f64>,
    columns: Vec<Column>,
}

impl Lines {
    /// How many rows and columns of faces there are.
    pub(super) fn counts(&self) -> [u32; 2] {
        [self.rows.len() as u32 - 1, self.columns.len() as u32 - 1]
    }
}

impl ParametricSurface {
    /// The vertex at a row, from 0 to 1, and a column; `[end, e1, e2]` are those of the bowl.
    fn polar_knot(&self, [end, e1, e2]: [f64; 3], row: f64, column: &Column) -> Knot {
        let ln_log = end.ln().ln() + 2.0 * row.ln();
        let Column { shares, sides, texture } = *column;
        let curve = |e: f64, k: usize| Curve::at_secant(e, ln_log + shares[k], sides[k]);
        let (m, n) = (curve(e1, 0), curve(e2, 1));
        let mut point = self.point_of(m.point, n.point);
        if row == 1.0 {
            // On the clipping plane, which the product of the two secants leaves by some rounding.
            point.x = (end * self.semi_axes().x).copysign(point.x);
        }
        let normal = self.normal_of(m.normal, n.normal, n.point);
        Knot::smooth(point, normal, DVec2::new(texture, row))
    }

    /// The vertex at a row and a column of some lines.
    pub(super) fn polar_vertex(&self, bowl: [f64; 3], lines: &Lines, [row, column]: [u32; 2]) -> Knot {
        self.polar_knot(bowl, lines.rows[row as usize], &lines.columns[column as usize])
    }

    /// Lines at equal steps of the polar form.
    pub(super) fn polar_uniform([rows, columns]: [u32; 2]) -> Lines {
        let shares = |count: u32| (0..=count).map(move |i| f64::from(i) / f64::from(count));
        Lines { rows: shares(rows).collect(), columns: shares(columns).map(Column::at_angle).collect() }
    }

    /// Lines at equal lengths along the rim and along the meridian that reaches farthest.
    pub(super) fn polar_equal(&self, bowl: [f64; 3], [rows, columns]: [u32; 2]) -> Lines {
        let rim = |around: f64| self.polar_knot(bowl, 1.0, &Column::at_ratio(around)).point;
        // Columns are as far around as they are along the rim.
        let columns: Vec<Column> = equal_steps([0.0, 1.0], columns, &rim)
            .into_iter()
            .enumerate()
            .map(|(i, around)| Column { texture: i as f64 / f64::from(columns), ..Column::at_ratio(around) })
            .collect();
        let reach = |column: &Column| self.polar_knot(bowl, 1.0, column).point.with_x(0.0).length();
        let farthest = columns.iter().copied().max_by(|a, b| reach(a).total_cmp(&reach(b)));
        let farthest = farthest.unwrap_or(Column::at_angle(0.0));
        let meridian = |row: f64| self.polar_knot(bowl, row, &farthest).point;
        Lines { rows: equal_steps([0.0, 1.0], rows, &meridian), columns }
    }

    /// Lines of a grid that is within `tolerance` of the bowl: as few as the rim and the meridian
    /// that reaches farthest ask for, or else even ones (edges of squarish bowls run across the
    /// lines, where neither of the two sees them).
    ///
    /// # Errors
    /// A tolerance that is not met with [`MOST_LINES`] rows.
    pub(super) fn polar_chords(&self, bowl: [f64; 3], tolerance: f64, run: &Run) -> Result<Lines, PatchError> {
        if let Some(lines) = self.polar_fitted(bowl, tolerance) {
            return Ok(lines);
        }
        let mut rows = 4;
        loop {
            run.check()?;
            // All quarters are alike.
            let fine = |count: u32, most: f64| {
                let steps = count * PARTS as u32;
                (0..=steps).map(move |i| most * f64::from(i) / f64::from(steps))
            };
            let columns: Vec<Column> = fine(rows, 0.25).map(Column::at_angle).collect();
            let deviation = self.polar_deviation(bowl, &fine(rows, 1.0).collect::<Vec<f64>>(), &columns);
            if deviation <= tolerance {
                return Ok(ParametricSurface::polar_uniform([rows, 4 * rows]));
            }
            if rows == MOST_LINES {
                return Err(PatchError::Tolerance { value: tolerance, least: deviation, most: self.size() });
            }
            rows = (rows + rows.div_ceil(4)).min(MOST_LINES);
        }
    }

    /// Lines by the chords of the rim and of a meridian; `None` if they are not enough.
    fn polar_fitted(&self, bowl: [f64; 3], tolerance: f64) -> Option<Lines> {
        // A quarter of the rim: the others are its mirror images.
        let rim = |around: f64| self.polar_knot(bowl, 1.0, &Column::at_ratio(around)).point;
        let around = Chain::new([0.0, 0.25], 1024, &rim);
        let reach = |around: f64| rim(around).with_x(0.0).length();
        let places = (0..=64).map(|i| around.parameter(around.length() * f64::from(i) / 64.0));
        let farthest = Column::at_ratio(places.max_by(|&a, &b| reach(a).total_cmp(&reach(b))).unwrap_or(0.0));
        let along = Chain::new([0.0, 1.0], 1024, &|row| self.polar_knot(bowl, row, &farthest).point);
        let mut budget = tolerance;
        for _ in 0..ATTEMPTS {
            let rows = along.chords(0.5 * budget, 2);
            let columns = around.chords(0.5 * budget, 1);
            let fine: Vec<Column> = divided(&around, &columns).into_iter().map(Column::at_ratio).collect();
            let deviation = self.polar_deviation(bowl, &divided(&along, &rows), &fine);
            if deviation <= tolerance {
                return Some(Lines { rows, columns: mirrored(&columns) });
            }
            budget *= (0.98 * tolerance / deviation).clamp(0.25, 0.9);
        }
        None
    }

    /// How far the surface is from the triangles of a grid, of which every [`PARTS`]th row and
    /// column is given: the others are where it is measured.
    fn polar_deviation(&self, bowl: [f64; 3], rows: &[f64], columns: &[Column]) -> f64 {
        let line = |row: &f64| columns.iter().map(|column| self.polar_knot(bowl, *row, column).point).collect();
        let points: Vec<Vec<DVec3>> = rows.iter().map(line).collect();
        let mut worst = 0.0f64;
        for i in (0..rows.len() - 1).step_by(PARTS) {
            for j in (0..columns.len() - 1).step_by(PARTS) {
                let at = |[s, t]: [usize; 2]| points[i + s][j + t];
                let [a, b, c, d] = [[0, 0], [0, PARTS], [PARTS, PARTS], [PARTS, 0]].map(at);
                // Faces are cut along their shorter diagonal; at the apex they are triangles.
                let straight = i == 0 || a.distance_squared(c) <= b.distance_squared(d);
                let halves = if straight { [[a, c, d], [a, b, c]] } else { [[a, b, d], [b, c, d]] };
                for (half, [p, q, r]) in halves.into_iter().enumerate() {
                    let normal = (q - p).cross(r - p).normalize_or_zero();
                    for place in (0..=PARTS).flat_map(|s| (0..=PARTS).map(move |t| [s, t])) {
                        let [s, t] = place;
                        let [left, right] = if straight { [t, s] } else { [s + t, PARTS] };
                        if (half == 0 && (left <= right || i == 0)) || (half == 1 && left >= right) {
                            worst = worst.max((at(place) - p).dot(normal).abs());
                        }
                    }
                }
            }
        }
        worst
    }
}

/// Places of an interval between lines where the surface is measured.
const PARTS: usize = 4;

/// The most rows that are tried for a tolerance.
const MOST_LINES: u32 = 1024;

/// Budgets tried for lines by chords.
const ATTEMPTS: usize = 6;

/// Lines with the places between them, at equal lengths.
fn divided(chain: &Chain, lines: &[f64]) -> Vec<f64> {
    let inner = lines.windows(2).flat_map(|pair| {
        (0..PARTS).map(|k| if k == 0 { pair[0] } else { chain.between([pair[0], pair[1]], k as f64 / PARTS as f64) })
    });
    inner.chain(lines.last().copied()).collect()
}

/// The columns of all quarters from those of the first, its ends among them.
fn mirrored(quarter: &[f64]) -> Vec<Column> {
    let count = quarter.len() - 1;
    let all = (0..=4 * count).map(|i| {
        let (turn, k) = (i / count, i % count);
        let around = match turn {
            4 => 1.0,
            0 | 2 => 0.25 * turn as f64 + quarter[k],
            _ => 0.25 * (turn + 1) as f64 - quarter[count - k],
        };
        Column { texture: i as f64 / (4 * count) as f64, ..Column::at_ratio(around) }
    });
    all.collect()
}
