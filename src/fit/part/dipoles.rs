//! Winding numbers of points with normals.
//!
//! ```text
//!     w(q) = Σ aᵢ nᵢ·(pᵢ − q) / 4π|pᵢ − q|³         aᵢ: the area that a point stands for
//! ```
//!
//! Nearer than points are to each other the sum is not that of a surface: distances are not taken
//! less. The areas are those of discs to the neighbours, all times what makes the jump across the
//! surface 1.
//!
//! Source: G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson, *Fast winding numbers for
//! soups and clouds* (2018).

use std::f64::consts::{PI, TAU};

use fearless_simd::Simd;
use glam::DVec3;
use rvachev_num::Real;
use rvachev_num::lanes::{F32, Lanes};

use crate::fit::grid::{Grid, extent};
use crate::fit::linear::median;

/// Neighbours that tell a point's area.
const NEIGHBOURS: usize = 9;

/// Points that the jump is asked at, and how far from the surface, in distances of neighbours.
const ASKED: usize = 200;
const APART: f64 = 2.0;

/// The square of a distance that is none, in diagonals: of points given several times.
const LITTLE: f64 = 1e-12;

/// Whole vectors of any SIMD level.
const WIDTH: usize = 16;

/// Points with normals and areas, in columns.
pub(super) struct Dipoles {
    /// Position, and normal times area.
    columns: [Vec<f32>; 6],
    /// Squares of distances are at least this.
    least: f64,
    scale: f64,
}

impl Dipoles {
    /// Of points with unit normals that point outwards.
    pub(super) fn of(points: &[DVec3], normals: &[DVec3]) -> Dipoles {
        let padded = points.len().next_multiple_of(WIDTH);
        let mut columns = [(); 6].map(|()| vec![0.0_f32; padded]);
        let grid = Grid::new(points, extent(points), (3.0 / points.len().max(1) as f64).sqrt());
        let mut found = Vec::new();
        let mut reaches = Vec::with_capacity(points.len());
        for (k, (p, n)) in points.iter().zip(normals).enumerate() {
            grid.nearest(*p, NEIGHBOURS, &mut found);
            let square = found.last().map_or(0.0, |f| f.0);
            reaches.push((square / NEIGHBOURS as f64).sqrt());
            let area = PI * square / NEIGHBOURS as f64;
            for axis in 0..3 {
                columns[axis][k] = p[axis] as f32;
                columns[3 + axis][k] = (area * n[axis]) as f32;
            }
        }
        let spacing = median(&mut reaches);
        let mut dipoles = Dipoles { columns, least: f64::max(spacing * spacing, LITTLE), scale: 0.5 / TAU };
        let step = points.len().div_ceil(ASKED).max(1);
        let jump = |(p, n): (&DVec3, &DVec3)| {
            let by = APART * spacing * *n;
            dipoles.winding_number(*p - by) - dipoles.winding_number(*p + by)
        };
        let mut jumps: Vec<f64> = points.iter().zip(normals).step_by(step).map(jump).collect();
        let jump = median(&mut jumps);
        if jump > 0.1 {
            dipoles.scale /= jump;
        }
        dipoles
    }

    /// Whether the points enclose a volume, and do not face it.
    pub(super) fn enclose(&self) -> bool {
        let c = &self.columns;
        let part = |k: usize| (0..3).map(|axis| f64::from(c[axis][k]) * f64::from(c[3 + axis][k])).sum::<f64>();
        (0..c[0].len()).map(part).sum::<f64>() > 0.0
    }

    /// About 1 inside and 0 outside.
    pub(super) fn winding_number(&self, p: DVec3) -> f64 {
        self.scale * rvachev_num::on_level!(simd => self.sum(simd, p))
    }

    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, q: DVec3) -> f64 {
        let width = <F32<S> as Lanes>::WIDTH;
        let splat = |x: f64| <F32<S> as Lanes>::splat(simd, x);
        let (mut sum, least) = (splat(0.0), splat(self.least));
        let c = &self.columns;
        for start in (0..c[0].len()).step_by(width) {
            let at = start..start + width;
            let load = |from: &[f32]| <F32<S> as Lanes>::load(simd, &from[at.clone()]);
            let [x, y, z] = [load(&c[0]) - q.x, load(&c[1]) - q.y, load(&c[2]) - q.z];
            let square = (x.square() + y.square() + z.square()).max(least);
            let along = x * load(&c[3]) + y * load(&c[4]) + z * load(&c[5]);
            sum = sum + along / (square * square.sqrt());
        }
        let mut buffer = [0.0_f32; 64];
        sum.store(&mut buffer[..width]);
        buffer[..width].iter().map(|x| f64::from(*x)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    #[test]
    fn a_ball_of_points_is_inside_of_itself() {
        let mut random = Random::new(5);
        let normals: Vec<DVec3> = (0..3000)
            .map(|_| {
                let z = 2.0 * random.unit() - 1.0;
                let (sin, cos) = (TAU * random.unit()).sin_cos();
                DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
            })
            .collect();
        let centre = DVec3::new(0.1, -0.05, 0.0);
        let points: Vec<DVec3> = normals.iter().map(|n| centre + 0.25 * *n).collect();
        let dipoles = Dipoles::of(&points, &normals);
        for (r, inside) in [(0.0, 1.0), (0.15, 1.0), (0.22, 1.0), (0.28, 0.0), (0.4, 0.0)] {
            for n in normals.iter().step_by(50) {
                let w = dipoles.winding_number(centre + r * *n);
                assert!((w - inside).abs() < 0.25, "{w} at {r}");
            }
        }
        let inwards: Vec<DVec3> = normals.iter().map(|n| -*n).collect();
        assert!(dipoles.enclose() && !Dipoles::of(&points, &inwards).enclose());
    }
}
