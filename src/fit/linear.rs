//! Small dense linear algebra: positive definite systems, principal axes.

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

/// The Cholesky factor of a symmetric positive definite matrix of which the lower triangle is
/// given, and the inverses of its diagonal; only the rows and columns that are `free` count. `None`
/// if it is not positive definite.
fn factor<const N: usize>(matrix: &[[f64; N]; N], free: &[bool; N]) -> Option<([[f64; N]; N], [f64; N])> {
    let (mut low, mut inverse) = ([[0.0; N]; N], [1.0; N]);
    for i in 0..N {
        if !free[i] {
            continue;
        }
        let mut row = [0.0; N];
        for j in 0..=i {
            let mut rest = if free[j] { matrix[i][j] } else { 0.0 };
            let other = if j < i { &low[j] } else { &row };
            for k in 0..j {
                rest -= row[k] * other[k];
            }
            if j < i {
                row[j] = rest * inverse[j];
            } else if rest > 0.0 && rest.is_finite() {
                row[i] = rest.sqrt();
                inverse[i] = 1.0 / row[i];
            } else {
                return None;
            }
        }
        low[i] = row;
    }
    Some((low, inverse))
}

/// The solution of `matrix · x = right`, 0 where it is not free.
pub(super) fn solved<const N: usize>(matrix: &[[f64; N]; N], right: &[f64; N], free: &[bool; N]) -> Option<[f64; N]> {
    let (low, inverse) = factor(matrix, free)?;
    let mut x = [0.0; N];
    for i in 0..N {
        let dot: f64 = (0..i).map(|k| low[i][k] * x[k]).sum();
        x[i] = if free[i] { (right[i] - dot) * inverse[i] } else { 0.0 };
    }
    for i in (0..N).rev() {
        x[i] *= inverse[i];
        for k in 0..i {
            x[k] -= low[i][k] * x[i];
        }
    }
    x.iter().all(|v| v.is_finite()).then_some(x)
}

/// The circle that points are nearest to by squares of squares: its centre and its radius.
///
/// Source: I. Kåsa, *A circle fitting procedure and its error analysis* (1976).
pub(super) fn circle(points: impl Iterator<Item = DVec2>) -> Option<(DVec2, f64)> {
    let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for p in points {
        let (row, square) = ([p.x, p.y, 1.0], p.length_squared());
        for i in 0..3 {
            right[i] += row[i] * square;
            for j in 0..=i {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let [a, b, c] = solved(&matrix, &right, &[true; 3])?;
    let centre = 0.5 * DVec2::new(a, b);
    Some((centre, (c + centre.length_squared()).max(0.0).sqrt()))
}

/// Principal axes of weighted points: variances from the least up, and right-handed unit axes.
pub(super) struct Principal {
    pub(super) mean: DVec3,
    pub(super) variances: [f64; 3],
    pub(super) axes: DMat3,
}

impl Principal {
    pub(super) fn of(points: impl Iterator<Item = DVec3> + Clone) -> Principal {
        let (sum, count) = points.clone().fold((DVec3::ZERO, 0.0), |(sum, count), p| (sum + p, count + 1.0));
        let mean = sum / f64::max(count, 1.0);
        let mut m = [[0.0; 3]; 3];
        for p in points {
            let d = (p - mean).to_array();
            for i in 0..3 {
                for j in 0..3 {
                    m[i][j] += d[i] * d[j];
                }
            }
        }
        let (values, axes) = eigen(m.map(|row| row.map(|x| x / f64::max(count, 1.0))));
        Principal { mean, variances: values, axes }
    }
}

/// Eigenvalues from the least up and right-handed eigenvectors of a symmetric matrix, by Jacobi's
/// rotations.
pub(super) fn eigen(mut m: [[f64; 3]; 3]) -> ([f64; 3], DMat3) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..30 {
        let off = m[0][1].abs() + m[0][2].abs() + m[1][2].abs();
        if off <= 1e-15 * (m[0][0] + m[1][1] + m[2][2]).abs() {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for k in 0..3 {
                (m[k][p], m[k][q]) = (c * m[k][p] - s * m[k][q], s * m[k][p] + c * m[k][q]);
            }
            for k in 0..3 {
                (m[p][k], m[q][k]) = (c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
            }
        }
    }
    let mut order = [0, 1, 2];
    order::rising(&mut order, |i| m[*i][*i]);
    let axis = |k: usize| DVec3::from_array(v[order[k]]).normalize_or(DVec3::AXES[k]);
    let (x, y) = (axis(0), axis(1));
    (order.map(|i| m[i][i].max(0.0)), DMat3::from_cols(x, y, x.cross(y)))
}

/// The value of which as many are below as above; 0 of none.
pub(super) fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that a share of the others is below.
pub(super) fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let at = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved_on_the_free_rows() {
        let m = [[4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [0.5, -1.0, 5.0]];
        let x = solved(&m, &[1.0, 2.0, 3.0], &[true; 3]).unwrap();
        let full = |i: usize, j: usize| if i >= j { m[i][j] } else { m[j][i] };
        for i in 0..3 {
            let row: f64 = (0..3).map(|j| full(i, j) * x[j]).sum();
            assert!((row - [1.0, 2.0, 3.0][i]).abs() < 1e-12);
        }
        let part = solved(&m, &[1.0, 2.0, 3.0], &[true, false, true]).unwrap();
        assert_eq!(part[1], 0.0);
        assert!((4.0 * part[0] + 0.5 * part[2] - 1.0).abs() < 1e-12);
        assert!(solved(&[[1.0, 0.0], [2.0, 1.0]], &[1.0, 1.0], &[true; 2]).is_none());
    }

    #[test]
    fn principal_axes_of_a_box() {
        let axes = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
        let corners: Vec<DVec3> = (0..8)
            .map(|i| axes * DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64 * 2.0, (i >> 2) as f64 * 3.0))
            .collect();
        let found = Principal::of(corners.iter().copied());
        for (k, variance) in [0.25, 1.0, 2.25].into_iter().enumerate() {
            assert!((found.variances[k] - variance).abs() < 1e-12);
            assert!(found.axes.col(k).dot(axes.col(k)).abs() > 1.0 - 1e-12);
        }
        assert!((found.axes.determinant() - 1.0).abs() < 1e-12);
    }
}
