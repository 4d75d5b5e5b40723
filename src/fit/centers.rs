//! Symmetry about an axis of a surface that is seen in part: where its middle is depends on how
//! many times it repeats.
//!
//! ```text
//!         .-'-.
//!       /   +   \  +       five of eight lobes are five of five about another middle
//!      '.       .
//! ```
//!
//! For each number the middle and the harmonics are found together, by Gauss–Newton steps: moved by
//! d, a point at the angle θ is at `ln ρ − d·e/ρ` and `θ − d·e⊥/ρ`, e being its direction and e⊥
//! that a quarter turn on. Squares count by ρ², as lengths do.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::harmonics::{Around, FEWEST, MOST, Repeat, STILL, TURNING, extremes, still, turned};
use super::linear::{quantile, solved};
use super::waves::WAVES;
use crate::{Cancelled, Run};

/// Terms: those without a repetition, the harmonics, and a shift.
const SHIFT: usize = STILL + WAVES;
const ALL: usize = SHIFT + 2;

/// Points that are asked at most, and steps.
const ASKED: usize = 260;
const STEPS: usize = 7;

/// Where middles are looked for: so many radii towards the side without points.
const STARTS: [f64; 3] = [0.0, 0.25, 0.5];

/// The longest step, and how far a middle may be from the centre, in radii.
const STEP: f64 = 0.3;
const REACH: f64 = 1.2;

/// A surface about the middle that fits a number of repetitions best.
pub(super) struct Centered {
    pub(super) around: Around,
    pub(super) repeat: Repeat,
    /// The mean square of what is left of the radii.
    pub(super) left: f64,
}

/// What is at the sides of points about an axis, without what is on top and below.
pub(super) struct Belt {
    /// The z axis of the frame is the axis; 0 is in the middle of the height.
    points: Vec<DVec3>,
    /// How far that is above the centre, and half the height.
    rise: f64,
    height: f64,
}

impl Belt {
    pub(super) fn about(points: &[DVec3], frame: &DMat3, center: DVec3) -> Belt {
        let mut local: Vec<DVec3> = points.iter().map(|p| frame.transpose() * (*p - center)).collect();
        let mut heights: Vec<f64> = local.iter().map(|p| p.z).collect();
        let [low, high] = [0.02, 0.98].map(|share| quantile(&mut heights, share));
        let (rise, height) = (0.5 * (low + high), (0.5 * (high - low)).max(1e-6));
        local.iter_mut().for_each(|p| p.z -= rise);
        local.retain(|p| p.z.abs() < 0.75 * height);
        Belt { points: local, rise, height }
    }

    /// The largest angle about the axis that there are no points in, and its middle.
    pub(super) fn gap(&self) -> [f64; 2] {
        let mut angles: Vec<f64> = self.points.iter().map(|p| p.truncate().to_angle()).collect();
        order::numbers(&mut angles);
        let around = angles.first().map_or(TAU, |first| first + TAU);
        let next = angles.iter().copied().skip(1).chain([around]);
        let gaps = angles.iter().zip(next).map(|(a, b)| [b - a, 0.5 * (a + b)]);
        gaps.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([TAU, 0.0])
    }
}

/// For each number of repetitions about an axis near a centre the best middle, from the best number
/// on. It is looked for where the centre is, and towards the side without points.
pub(super) fn centered(points: &[DVec3], axis: DVec3, center: DVec3, run: &Run) -> Result<Vec<Centered>, Cancelled> {
    let x = axis.any_orthonormal_vector();
    let frame = DMat3::from_cols(x, axis.cross(x), axis);
    let belt = Belt::about(points, &frame, center);
    let [_, away] = belt.gap();
    let Belt { points: mut belt, rise, height } = belt;
    belt.truncate(ASKED);
    let mut found: Vec<Centered> = Vec::new();
    if belt.len() < 3 * ALL {
        return Ok(found);
    }
    let radius = (belt.iter().map(|p| p.truncate().length_squared()).sum::<f64>() / belt.len() as f64).sqrt();
    for count in FEWEST..=MOST {
        run.check()?;
        for start in STARTS {
            let begin = start * radius * DVec2::from_angle(away);
            let Some((shift, left, repeat)) = settled(&belt, height, radius, count, begin) else { continue };
            let center = center + frame * shift.extend(rise);
            let (repeats, stretched) = (Vec::new(), Vec::new());
            let around = Around { frame, center, repeats, stretched, height, long: 1.0, first: 0.0 };
            let new = Centered { around, repeat, left };
            match found.last_mut().filter(|old| old.repeat.count == count) {
                Some(old) if old.left <= left => {}
                Some(old) => *old = new,
                None => found.push(new),
            }
        }
    }
    order::rising(&mut found, |a| a.left);
    Ok(found)
}

/// The middle for a number of repetitions, as a shift, what is left, and the repetition.
fn settled(belt: &[DVec3], height: f64, radius: f64, count: u32, begin: DVec2) -> Option<(DVec2, f64, Repeat)> {
    let mut best: Option<(DVec2, f64, Repeat)> = None;
    let (mut shift, mut terms) = (begin, [0.0; ALL]);
    for _ in 0..STEPS {
        let (matrix, right, square) = equations(belt, shift, height, count, &terms);
        let mut free = [true; ALL];
        free[SHIFT..].fill(false);
        let alone = solved(&matrix, &right, &free)?;
        let left = square - alone.iter().zip(&right).map(|(x, r)| x * r).sum::<f64>();
        if best.as_ref().is_none_or(|b| left < b.1) {
            let waves = std::array::from_fn(|i| alone[STILL + i]);
            best = Some((shift, left, extremes(count, alone[0], &waves)));
        }
        let step = solved(&matrix, &right, &[true; ALL])?;
        let moved = DVec2::new(step[SHIFT], step[SHIFT + 1]).clamp_length_max(STEP * radius);
        shift = (shift + moved).clamp_length_max(REACH * radius);
        terms = alone;
        if moved.length() < 1e-3 * radius {
            break;
        }
    }
    let (shift, left, repeat) = best?;
    left.is_finite().then_some((shift, left / belt.len() as f64, repeat))
}

/// The normal equations about a shifted middle; the derivatives by the angle are those of `terms`.
fn equations(
    belt: &[DVec3],
    shift: DVec2,
    height: f64,
    count: u32,
    terms: &[f64; ALL],
) -> ([[f64; ALL]; ALL], [f64; ALL], f64) {
    let (mut matrix, mut right, mut square) = ([[0.0; ALL]; ALL], [0.0; ALL], 0.0);
    for p in belt {
        let across = p.truncate() - shift;
        let rho = across.length();
        if rho < 1e-6 {
            continue;
        }
        let [c, s] = (across / rho).to_array();
        let z = p.z / height;
        let mut row = [0.0; ALL];
        row[..STILL].copy_from_slice(&still(z, [c, s]));
        let [c2, s2] = [row[TURNING + 2], row[TURNING + 3]];
        let mut slope = z * (terms[TURNING + 1] * c - terms[TURNING] * s);
        slope += 2.0 * (terms[TURNING + 3] * c2 - terms[TURNING + 2] * s2);
        let (sin, cos) = (f64::from(count) * across.to_angle()).sin_cos();
        let (mut wave, mut times) = ([1.0, 0.0], f64::from(count));
        for at in (STILL..SHIFT).step_by(2) {
            wave = turned(wave, [cos, sin]);
            (row[at], row[at + 1]) = (wave[0], wave[1]);
            slope += times * (terms[at + 1] * wave[0] - terms[at] * wave[1]);
            times += f64::from(count);
        }
        (row[SHIFT], row[SHIFT + 1]) = ((c + slope * s) / rho, (s - slope * c) / rho);
        let (log, weight) = (rho.ln(), rho * rho);
        square += weight * log * log;
        for i in 0..ALL {
            let weighted = weight * row[i];
            right[i] += weighted * log;
            for j in 0..=i {
                matrix[i][j] += weighted * row[j];
            }
        }
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] *= 1.0 + 1e-9;
    }
    (matrix, right, square)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a star with so many arms, seen from the side of +x.
    fn half(arms: u32) -> Vec<DVec3> {
        let at = |n: u32| {
            let (angle, z) = (std::f64::consts::PI * (f64::from(n % 40) / 39.0 - 0.5), f64::from(n / 40) / 5.0 - 0.9);
            let radius = 1.0 + 0.2 * (f64::from(arms) * angle).cos();
            (radius * DVec2::from_angle(angle)).extend(z)
        };
        (0..400).map(at).collect()
    }

    /// From the mean of what is seen the middle is found, and with it the number of arms.
    #[test]
    fn the_middle_of_what_is_seen_in_part_is_found() {
        for arms in [5, 6, 8, 11] {
            let points = half(arms);
            let mean = points.iter().sum::<DVec3>() / points.len() as f64;
            let belt = Belt::about(&points, &DMat3::IDENTITY, mean);
            assert!(belt.gap()[0] > 1.0, "{:?}", belt.gap());
            let found = centered(&points, DVec3::Z, mean, &Run::default()).unwrap();
            let best = &found[0];
            assert_eq!(best.repeat.count, arms);
            assert!(best.around.center.truncate().length() < 0.03, "{arms}: {}", best.around.center);
        }
    }

    #[test]
    fn it_is_cancelled() {
        let run = Run::default();
        run.cancel.cancel();
        assert!(centered(&half(6), DVec3::Z, DVec3::X * 0.5, &run).is_err());
    }
}
