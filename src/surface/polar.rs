//! Barr's two sheets along x, in polar form about their apices.
//!
//! ```text
//!     x/a₁ = ξ = sec^e₁ η · sec^e₂ ω     at a row all points have the same ξ, so that the last row
//!                                        is the rim of the clipped end
//!     ln ξ = ln ξ_end · row²             divided between the two secants by the squared cosine
//!                                        and sine of the column's angle
//! ```

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::angle::sin_cos;
use super::curve::Curve;
use super::parametric::ParametricSurface;
use super::stitch::Knot;

/// The most rows that are tried for a tolerance.
const MOST_ROWS: u32 = 1024;

impl ParametricSurface {
    /// The vertex at shares of the rows and of the columns, each from 0 to 1; `[end, e1, e2]` are
    /// those of the bowl.
    pub(super) fn polar_knot(&self, [end, e1, e2]: [f64; 3], row: f64, column: f64) -> Knot {
        let (sin, cos) = sin_cos((2.0 * column - 1.0) * PI);
        let log = end.ln() * row * row;
        let curve = |e: f64, share: f64| Curve::at_secant(e, (log * share * share).exp(), share);
        // In this order columns run anticlockwise about the apex, seen from outside.
        let (m, n) = (curve(e1, sin), curve(e2, cos));
        let mut point = self.point_of(m.point, n.point);
        if row == 1.0 {
            // On the clipping plane, which the product of the two secants leaves by some rounding.
            point.x = (end * self.semi_axes().x).copysign(point.x);
        }
        let normal = self.normal_of(m.normal, n.normal, n.point);
        Knot::smooth(point, normal, DVec2::new(column, row))
    }

    /// Rows and columns of a grid that is within `tolerance` of the bowl, in steps of a quarter.
    pub(super) fn polar_counts(&self, bowl: [f64; 3], tolerance: f64) -> [u32; 2] {
        let mut rows = 2;
        while rows < MOST_ROWS && self.polar_deviation(bowl, rows) > tolerance {
            rows += rows.div_ceil(4);
        }
        [rows, 4 * rows]
    }

    /// How far the surface is from the triangles of a grid of so many rows and four times as many
    /// columns: at the middles of their edges and in the middle of each.
    fn polar_deviation(&self, bowl: [f64; 3], rows: u32) -> f64 {
        let columns = 4 * rows;
        let at =
            |[row, column]: [f64; 2]| self.polar_knot(bowl, row / f64::from(rows), column / f64::from(columns)).point;
        let mut worst = 0.0f64;
        for i in 0..rows {
            // All quarters are alike.
            for j in 0..rows {
                let (i, j) = (f64::from(i), f64::from(j));
                let corners = [[i, j], [i, j + 1.0], [i + 1.0, j + 1.0], [i + 1.0, j]];
                let [a, b, c, d] = corners.map(at);
                let halves = if a.distance_squared(c) <= b.distance_squared(d) {
                    [[0, 1, 2], [0, 2, 3]]
                } else {
                    [[0, 1, 3], [1, 2, 3]]
                };
                for half in halves {
                    let places = half.map(|k: usize| corners[k]);
                    let [p, q, r] = places.map(at);
                    let normal: DVec3 = (q - p).cross(r - p).normalize_or_zero();
                    for weights in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1.0 / 3.0; 3]] {
                        let mix = |axis: usize| (0..3).map(|k| places[k][axis] * weights[k]).sum::<f64>();
                        worst = worst.max((at([mix(0), mix(1)]) - p).dot(normal).abs());
                    }
                }
            }
        }
        worst
    }
}
