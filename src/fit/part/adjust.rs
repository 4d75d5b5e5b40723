//! Shapes adjusted to points by least squares: Gauss and Newton's steps.

use glam::DVec3;

use super::columns::Shape;
use crate::fit::linear::{eigen, solved};

/// Points in the frame of a shape, with weights.
pub(super) type Weighted<'a> = &'a [(DVec3, f64)];

/// The shape after steps by points that it explains; `None` where they do not tell it.
pub(super) fn adjusted(shape: &Shape, points: Weighted, steps: usize) -> Option<Shape> {
    match *shape {
        Shape::Plane { normal, .. } => plane(normal, points),
        Shape::Sphere { centre, radius, sign } => {
            let mut x = [centre.x, centre.y, centre.z, radius];
            for _ in 0..steps {
                x = step(x, points, |x, p| {
                    let d = p - DVec3::new(x[0], x[1], x[2]);
                    let away = d.length().max(1e-12);
                    (away - x[3], [-d.x / away, -d.y / away, -d.z / away, -1.0])
                })?;
            }
            (x[3] > 0.0).then(|| Shape::Sphere { centre: DVec3::new(x[0], x[1], x[2]), radius: x[3], sign })
        }
        Shape::Cone { centre, radius, slope: 0.0, sign } => {
            let mut x = [centre[0], centre[1], radius];
            for _ in 0..steps {
                x = step(x, points, |x, p| {
                    let [u, v] = [p.x - x[0], p.y - x[1]];
                    let away = u.hypot(v).max(1e-12);
                    (away - x[2], [-u / away, -v / away, -1.0])
                })?;
            }
            (x[2] > 0.0).then(|| Shape::Cone { centre: [x[0], x[1]], radius: x[2], slope: 0.0, sign })
        }
        Shape::Cone { centre, radius, slope, sign } => {
            let mut x = [centre[0], centre[1], radius, slope];
            for _ in 0..steps {
                x = step(x, points, |x, p| {
                    let [u, v] = [p.x - x[0], p.y - x[1]];
                    let away = u.hypot(v).max(1e-12);
                    (away - x[2] - x[3] * p.z, [-u / away, -v / away, -1.0, -p.z])
                })?;
            }
            Some(Shape::Cone { centre: [x[0], x[1]], radius: x[2], slope: x[3], sign })
        }
        Shape::Torus { centre, major, minor, sign } => {
            let mut x = [centre.x, centre.y, centre.z, major, minor];
            for _ in 0..steps {
                x = step(x, points, |x, p| {
                    let [u, v, h] = [p.x - x[0], p.y - x[1], p.z - x[2]];
                    let away = u.hypot(v).max(1e-12);
                    let out = away - x[3];
                    let tube = out.hypot(h).max(1e-12);
                    let [f, g] = [out / tube, h / tube];
                    (tube - x[4], [-f * u / away, -f * v / away, -g, -f, -1.0])
                })?;
            }
            let [cx, cy, cz, major, minor] = x;
            (major > 0.0 && minor > 0.0).then(|| Shape::Torus { centre: DVec3::new(cx, cy, cz), major, minor, sign })
        }
    }
}

/// A step of Gauss and Newton's, of residuals and their derivatives.
fn step<const N: usize>(
    x: [f64; N],
    points: Weighted,
    residual: impl Fn(&[f64; N], DVec3) -> (f64, [f64; N]),
) -> Option<[f64; N]> {
    let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
    for &(p, weight) in points {
        let (off, row) = residual(&x, p);
        for i in 0..N {
            right[i] -= weight * off * row[i];
            for j in 0..=i {
                matrix[i][j] += weight * row[i] * row[j];
            }
        }
    }
    let largest = (0..N).map(|i| matrix[i][i]).fold(0.0, f64::max);
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += 1e-10 * largest;
    }
    let delta = solved(&matrix, &right, &[true; N])?;
    let mut next = x;
    for (next, delta) in next.iter_mut().zip(delta) {
        *next += delta;
    }
    // A step across the whole part is of points that do not tell.
    delta.iter().all(|d| d.abs() < 0.5).then_some(next)
}

fn plane(normal: DVec3, points: Weighted) -> Option<Shape> {
    let sum: f64 = points.iter().map(|p| p.1).sum();
    let mean = points.iter().map(|(p, w)| *p * *w).sum::<DVec3>() / sum;
    let (values, axes) = eigen(moments(points.iter().map(|(p, w)| (*p - mean, *w))));
    // A narrow strip tells no normal.
    let told = if values[1] > 1e-9 * sum { axes.x_axis } else { normal };
    let normal = if told.dot(normal) < 0.0 { -told } else { told };
    (sum > 0.0).then(|| Shape::Plane { normal, offset: normal.dot(mean) })
}

/// Sums of weighted products of coordinates.
pub(super) fn moments(vectors: impl Iterator<Item = (DVec3, f64)>) -> [[f64; 3]; 3] {
    let mut m = [[0.0; 3]; 3];
    for (v, weight) in vectors {
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += weight * v[i] * v[j];
            }
        }
    }
    m
}
