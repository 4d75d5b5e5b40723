//! Around which axis, and how many times, a surface repeats.
//!
//! The logarithm of the distance from an axis is the sum of a profile, a shift and a tilt of the
//! axis, an ellipse, and three harmonics of the repetition (exactly so where a₁ = a₂):
//!
//! ```text
//!     ln ρ = P₄(z) + (1, z)×(cos θ, sin θ) + (cos 2θ, sin 2θ) + Σ_h (cos hkθ, sin hkθ)
//! ```

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::linear::{circle, quantile, solved};
use super::waves::{WAVES, column, sums};

/// Terms of a surface about its middle: a profile, a tilt of the axis, an ellipse.
pub(super) const STILL: usize = 9;
/// Where those begin that change about the axis.
pub(super) const TURNING: usize = 5;

/// With a shift, and with a repetition.
const BASE: usize = STILL + 2;
const ALL: usize = BASE + WAVES;

/// Repetitions that are tried.
pub(super) const FEWEST: u32 = 3;
pub(super) const MOST: u32 = 16;

/// Sections that are longer than wide by this ratio may be stretched.
const LONG: f64 = 1.04;

/// Of repetitions that explain nearly as much as the best one, the largest is taken: its divisors
/// do as well.
const NEARLY: f64 = 0.02;

/// Hollows are equally deep if they differ by less than this share of the range.
const ALIKE: f64 = 0.35;

/// Centres are apart that are so many radii from each other.
const APART: f64 = 0.05;

/// A surface about an axis.
pub(super) struct Around {
    /// The axis is z.
    pub(super) frame: DMat3,
    pub(super) center: DVec3,
    /// Repetitions, from the most likely on.
    pub(super) repeats: Vec<Repeat>,
    /// Repetitions once the section is stretched to one that is as wide as long, if it is not;
    /// angles are counted from the first principal direction.
    pub(super) stretched: Vec<Repeat>,
    /// Half the height.
    pub(super) height: f64,
    /// How much longer the section is than wide, and the angle of the direction that it is longest
    /// in.
    pub(super) long: f64,
    pub(super) first: f64,
}

/// A repetition.
#[derive(Clone, Copy)]
pub(super) struct Repeat {
    pub(super) count: u32,
    /// The share of the squares that it explains.
    pub(super) explained: f64,
    /// Where the radius is least and greatest.
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// The radii there, at the middle height.
    pub(super) radii: [f64; 2],
    /// There are two hollows in it, equally deep: twice as many lobes that lean to either side.
    pub(super) is_double: bool,
}

impl Around {
    /// The share of the squares that the best repetition explains.
    pub(super) fn explained(&self) -> f64 {
        let firsts = [self.repeats.first(), self.stretched.first()];
        firsts.into_iter().flatten().map(|r| r.explained).fold(0.0, f64::max)
    }

    /// The frame turned about the axis so that x is the direction that the section is longest in.
    pub(super) fn square_frame(&self) -> DMat3 {
        self.frame * DMat3::from_rotation_z(self.first)
    }

    /// Of points about an axis through a centre.
    pub(super) fn axis(points: &[DVec3], axis: DVec3, center: DVec3) -> Around {
        let x = axis.any_orthonormal_vector();
        let frame = DMat3::from_cols(x, axis.cross(x), axis);
        let local: Vec<DVec3> = points.iter().map(|p| frame.transpose() * (*p - center)).collect();
        let height = quantile(&mut local.iter().map(|p| p.z.abs()).collect::<Vec<_>>(), 0.98);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for p in &local {
            (xx, xy, yy) = (xx + p.x * p.x, xy + p.x * p.y, yy + p.y * p.y);
        }
        let first = 0.5 * f64::atan2(2.0 * xy, xx - yy);
        let half = 0.5 * f64::hypot(xx - yy, 2.0 * xy);
        let [most, least] = [half, -half].map(|half| (0.5 * (xx + yy) + half).max(0.0).sqrt());
        let long = most / least.max(1e-6 * most).max(f64::MIN_POSITIVE);
        let mut stretched = Vec::new();
        if long > LONG {
            let (sin, cos) = first.sin_cos();
            let (a, b) = (long.sqrt().recip(), long.sqrt());
            let across = |p: &DVec3| DVec3::new(a * (cos * p.x + sin * p.y), b * (cos * p.y - sin * p.x), p.z);
            stretched = repeats(&local.iter().map(across).collect::<Vec<_>>(), height);
        }
        Around { frame, center, repeats: repeats(&local, height), stretched, height, long, first }
    }
}

/// Where the circle about an axis is centred that points are nearest to, as high as a given centre;
/// none if that is the given one, or nearly so.
pub(super) fn ring_center(points: &[DVec3], axis: DVec3, center: DVec3) -> Option<DVec3> {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let across = points.iter().map(|p| DVec2::new(x.dot(*p - center), y.dot(*p - center)));
    let radius = (across.clone().map(DVec2::length_squared).sum::<f64>() / points.len() as f64).sqrt();
    let (middle, _) = circle(across)?;
    let away = middle.x * x + middle.y * y;
    (away.length() > APART * radius && away.length() < radius).then(|| center + away)
}

/// The terms of a point without a repetition: by its height, and the cosine and sine of its angle.
pub(super) fn still(z: f64, [c, s]: [f64; 2]) -> [f64; STILL] {
    let z2 = z * z;
    [1.0, z, z2, z * z2, z2 * z2, z * c, z * s, c * c - s * s, 2.0 * c * s]
}

/// The cosine and sine of the sum of two angles.
pub(super) fn turned([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c - b * d, a * d + b * c]
}

fn repeats(local: &[DVec3], height: f64) -> Vec<Repeat> {
    let height = height.max(1e-6);
    let belt: Vec<DVec3> =
        local.iter().copied().filter(|p| p.z.abs() < 0.75 * height && p.truncate().length() > 1e-6).collect();
    if belt.len() < 3 * ALL {
        return Vec::new();
    }
    let turns: Vec<[f64; 2]> = belt.iter().map(|p| (p.truncate() / p.truncate().length()).to_array()).collect();
    let logs: Vec<f64> = belt.iter().map(|p| p.truncate().length().ln()).collect();
    let base: Vec<[f64; BASE]> = belt
        .iter()
        .zip(&turns)
        .map(|(p, turn)| {
            let mut row = [0.0; BASE];
            row[..STILL].copy_from_slice(&still(p.z / height, *turn));
            row[STILL..].copy_from_slice(turn);
            row
        })
        .collect();
    let mut matrix = [[0.0; ALL]; ALL];
    let mut right = [0.0; ALL];
    for (row, y) in base.iter().zip(&logs) {
        for i in 0..BASE {
            right[i] += row[i] * y;
            for j in 0..=i {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    for i in 0..ALL {
        matrix[i][i] += 1e-9 * belt.len() as f64;
    }
    let square: f64 = logs.iter().map(|y| y * y).sum();
    let mut free = [true; ALL];
    free[BASE..].fill(false);
    let rest = |matrix: &[[f64; ALL]; ALL], right: &[f64; ALL], free: &[bool; ALL]| {
        let x = solved(matrix, right, free)?;
        Some((square - x.iter().zip(right).map(|(x, r)| x * r).sum::<f64>(), x))
    };
    let Some((alone, _)) = rest(&matrix, &right, &free) else { return Vec::new() };
    free = [true; ALL];
    let mut powers = turns.clone();
    let step = |powers: &mut [[f64; 2]]| {
        for (power, turn) in powers.iter_mut().zip(&turns) {
            *power = turned(*power, *turn);
        }
    };
    step(&mut powers);
    let columns: [Vec<f64>; BASE] = std::array::from_fn(|j| column(base.iter().map(|row| row[j])));
    let values = column(logs.iter().copied());
    let mut found = Vec::new();
    for count in FEWEST..=MOST {
        step(&mut powers);
        let (mut matrix, mut right) = (matrix, right);
        let sums = sums(&columns, &values, &[0, 1].map(|k| column(powers.iter().map(|power| power[k]))));
        for i in 0..WAVES {
            right[BASE + i] += sums.values[i];
            for j in 0..BASE {
                matrix[BASE + i][j] += sums.terms[i][j];
            }
            for j in 0..=i {
                matrix[BASE + i][BASE + j] += sums.waves[i][j];
            }
        }
        let Some((left, x)) = rest(&matrix, &right, &free) else { continue };
        let explained = (1.0 - left / alone.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let waves = std::array::from_fn(|i| x[BASE + i]);
        found.push(Repeat { explained, ..extremes(count, x[0], &waves) });
    }
    let best = found.iter().map(|r| r.explained).fold(0.0, f64::max);
    order::falling(&mut found, |a| a.explained);
    let near = |r: &Repeat| r.explained > best - NEARLY;
    if let Some(at) = (0..found.len()).filter(|i| near(&found[*i])).max_by_key(|i| found[*i].count) {
        let largest = found.remove(at);
        found.insert(0, largest);
    }
    found
}

/// The extremes of the radius over a period, whose logarithm is a mean and waves.
pub(super) fn extremes(count: u32, mean: f64, waves: &[f64; WAVES]) -> Repeat {
    const STEPS: u32 = 64;
    let mut ends = [(f64::INFINITY, 0.0), (f64::NEG_INFINITY, 0.0)];
    let mut logs = [0.0; STEPS as usize];
    for (i, log) in (0..STEPS).zip(&mut logs) {
        let angle = TAU / f64::from(count) * f64::from(i) / f64::from(STEPS);
        for h in 0..3u8 {
            let (sin, cos) = (f64::from(h + 1) * f64::from(count) * angle).sin_cos();
            let at = 2 * usize::from(h);
            *log += waves[at] * cos + waves[at + 1] * sin;
        }
        if *log < ends[0].0 {
            ends[0] = (*log, angle);
        }
        if *log > ends[1].0 {
            ends[1] = (*log, angle);
        }
    }
    let (deep, high) = (ends[0].0, ends[1].0);
    let is_hollow =
        |i: usize| logs[i] <= logs[(i + logs.len() - 1) % logs.len()] && logs[i] < logs[(i + 1) % logs.len()];
    let hollows: Vec<usize> = (0..logs.len()).filter(|i| is_hollow(*i)).collect();
    let is_double = hollows.len() == 2 && hollows.iter().all(|i| logs[*i] < deep + ALIKE * (high - deep));
    let radii = ends.map(|(log, _)| (mean + log).clamp(-10.0, 10.0).exp());
    Repeat { count, explained: 0.0, least: ends[0].1, greatest: ends[1].1, radii, is_double }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    #[test]
    fn rings_with_noise_and_a_gap_tell_their_symmetry() {
        let mut random = Random::new(4);
        let mut unit = || random.below(1 << 24) as f64 / (1 << 24) as f64;
        let mut right = 0;
        for round in 0..70 {
            let m = 3 + round % 10;
            let (phase, gap) = (TAU * unit(), TAU * unit());
            let points: Vec<DVec3> = (0..500)
                .map(|_| {
                    let t = gap + TAU * 0.75 * unit();
                    let wave =
                        0.25 * ((f64::from(m) * (t - phase)).cos() + 0.3 * (2.0 * f64::from(m) * (t - phase)).cos());
                    let noise = 0.06 * (unit() + unit() + unit() - 1.5);
                    let rho = wave.exp() * (1.0 + noise);
                    DVec3::new(rho * t.cos(), rho * t.sin(), 2.0 * unit() - 1.0)
                })
                .collect();
            let around = Around::axis(&points, DVec3::Z, DVec3::ZERO);
            right += usize::from(around.repeats[0].count == m);
        }
        assert!(right >= 67, "{right} of 70");
    }
}
