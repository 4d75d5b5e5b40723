//! Points of a scan brought nearer to the surface.
//!
//! ```text
//!         . j         d = ½ (nᵢ + n_j)·(p_j − pᵢ) is 0 for any two points of a circle, a sphere or a plane:
//!     . i    .        its mean over the neighbours that face about the same way is how far i is off,
//!       .  .          without flattening what is round
//! ```
//!
//! The noise left is that of a mean of so many.

use glam::DVec3;

use crate::fit::grid::{Grid, extent};
use crate::fit::linear::median;

/// Neighbours, and how much they face the same way, as a cosine: 32°.
const NEIGHBOURS: usize = 24;
const FACING: f64 = 0.85;

/// Neighbours that are farther off, in noise, are of another surface, and count less and less.
const WIDTH: f64 = 4.0;

/// Less noise, in diagonals, does no harm.
const LITTLE: f64 = 5e-4;

/// Brings points with unit normals nearer to the surface; gives the noise that is left of what they
/// have.
pub(super) fn smooth(points: &mut [DVec3], normals: &[DVec3], noise: f64) -> f64 {
    if noise < LITTLE {
        return noise;
    }
    let before = points.to_vec();
    let grid = Grid::new(&before, extent(&before), (3.0 / before.len().max(1) as f64).sqrt());
    let mut near = Vec::new();
    let mut left = Vec::with_capacity(points.len());
    for (i, point) in points.iter_mut().enumerate() {
        let (p, n) = (before[i], normals[i]);
        grid.nearest(p, NEIGHBOURS, &mut near);
        let [mut sum, mut squares, mut off] = [0.0; 3];
        for &(_, j) in &near {
            let other = normals[j as usize];
            if other.dot(n) > FACING {
                let d = 0.5 * (n + other).dot(before[j as usize] - p);
                let weight = (1.0 + (d / (WIDTH * noise)).powi(2)).powi(-2);
                (sum, squares, off) = (sum + weight, squares + weight * weight, off + weight * d);
            }
        }
        *point += off / sum.max(1.0) * n;
        left.push(squares.sqrt() / sum.max(1.0));
    }
    noise * median(&mut left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    #[test]
    fn noise_goes_and_a_narrow_rod_stays_as_thick() {
        let (radius, sigma) = (0.06, 0.004);
        let mut random = Random::new(4);
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for _ in 0..1500 {
            let (sin, cos) = (std::f64::consts::TAU * random.unit()).sin_cos();
            let noise = sigma * ((0..12).map(|_| random.unit()).sum::<f64>() - 6.0);
            normals.push(DVec3::new(cos, sin, 0.0));
            points.push(DVec3::new((radius + noise) * cos, (radius + noise) * sin, random.unit() - 0.5));
        }
        let left = smooth(&mut points, &normals, sigma);
        let off: Vec<f64> = points.iter().map(|p| p.truncate().length() - radius).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let spread = (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt();
        assert!(mean.abs() < 0.1 * sigma && spread < 0.4 * sigma && left < 0.4 * sigma, "{mean} {spread} {left}");
    }
}
