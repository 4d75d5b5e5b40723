//! Symmetry numbers as they were published: by counting maxima of the radius over sections.
//!
//! ```text
//!     across the axis   ρ(θ)      m maxima a turn           the sections vote
//!     along the axis    λ(φ)      M maxima                  the box is made a cube before
//!
//!        .-'-.   .-'-.   ?????   an interval without points: what is in it is not known;
//!     --'     '-'     '--?????-  the period is that of maxima in one known interval
//! ```
//!
//! Radii are averaged over 15 of 720 parts of a turn, or three points where these are farther
//! apart. It is right for clean points all around; noise makes maxima of its own.
//!
//! Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec2, DVec3};
use rvachev_num::order;

use super::linear::{median, quantile, solved};

/// Parts of a turn.
const PARTS: usize = 720;

/// Parts that radii are averaged over.
const AVERAGED: usize = 15;

/// Points of a section, and how many sections there are.
const WANTED: usize = 120;
const MOST: usize = 24;

/// An interval is missing if it is longer than so many of the usual ones, and than this angle.
const MISSING: f64 = 8.0;
const NARROW: f64 = TAU / 36.0;

/// Sections whose radii differ by less are round: they tell nothing.
const ROUND: f64 = 0.01;

/// Terms of the profile's polynomial.
const TERMS: usize = 7;

/// Symmetry numbers that a section may tell.
const LARGEST: u32 = 16;

/// What the sections about an axis say.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    /// The symmetry number of the equator, if most sections agree.
    pub(super) equator: Option<u32>,
    pub(super) meridian: Option<u32>,
    /// The share of the sections across the axis that agree.
    pub(super) agreed: f64,
}

/// Sweeps a plane along an axis, the z of a frame, and one about it.
pub(super) fn sweep(points: &[DVec3], frame: DMat3, center: DVec3) -> Sweep {
    let local: Vec<DVec3> = points.iter().map(|p| frame.transpose() * (*p - center)).collect();
    // The box is made a cube, as wide as it is high.
    let reach = |i: usize| quantile(&mut local.iter().map(|p| p[i].abs()).collect::<Vec<_>>(), 0.98).max(1e-6);
    let reach = DVec3::from_array([0, 1, 2].map(reach));
    let local: Vec<DVec3> = local.into_iter().map(|p| p / reach).collect();
    let count = (local.len() / WANTED).clamp(1, MOST);
    let profile = profile(&local);
    let rings: Vec<Vec<DVec2>> = (0..count).map(|k| across(&local, &profile, k, count)).collect();
    let (equator, agreed) = vote(rings.iter().map(|ring| maxima(&smooth(ring.clone())?)));
    // One section for all heights: what sections along the axis are freed of.
    let all = smooth(rings.into_iter().flatten().collect());
    let along = |k: usize| maxima(&smooth(along(&local, all.as_deref()?, k, count))?);
    let (meridian, _) = vote((0..count).map(along));
    Sweep { equator, meridian, agreed }
}

/// How the logarithm of the radius changes with the height, as a polynomial.
fn profile(local: &[DVec3]) -> [f64; TERMS] {
    let (mut matrix, mut right) = ([[0.0; TERMS]; TERMS], [0.0; TERMS]);
    for p in local.iter().filter(|p| p.z.abs() < 0.95 && p.truncate().length() > 1e-6) {
        let row = powers(p.z);
        for i in 0..TERMS {
            right[i] += row[i] * p.truncate().length().ln();
            for j in 0..=i {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    solved(&matrix, &right, &[true; TERMS]).unwrap_or_default()
}

fn powers(z: f64) -> [f64; TERMS] {
    std::array::from_fn(|i| z.powi(i as i32))
}

/// The points of a slice across the axis, by angles and radii, freed of how the radius changes with
/// the height.
fn across(local: &[DVec3], profile: &[f64; TERMS], k: usize, count: usize) -> Vec<DVec2> {
    let height = 1.8 / count as f64;
    let middle = -0.9 + height * (k as f64 + 0.5);
    let is_near = |p: &&DVec3| (p.z - middle).abs() <= 0.5 * height && p.truncate().length() > 1e-6;
    let of = |p: &DVec3| {
        let usual: f64 = powers(p.z).iter().zip(profile).map(|(power, by)| power * by).sum();
        DVec2::new(p.y.atan2(p.x), p.truncate().length() / usual.exp())
    };
    local.iter().filter(is_near).map(of).collect()
}

/// The points of a section along the axis, by angles and radii; distances from the axis are divided
/// by those of the section across.
fn along(local: &[DVec3], radii: &[f64], k: usize, count: usize) -> Vec<DVec2> {
    let width = PI / count as f64;
    let middle = -FRAC_PI_2 + width * (k as f64 + 0.5);
    let of = |p: &DVec3| {
        let angle = p.y.atan2(p.x);
        let part = (angle / TAU * PARTS as f64).round() as i64;
        let radius = radii[part.rem_euclid(PARTS as i64) as usize];
        // The half plane on the other side is the other half of the section.
        let (angle, side) = if angle.abs() > FRAC_PI_2 { (angle - PI * angle.signum(), -1.0) } else { (angle, 1.0) };
        ((angle - middle).abs() <= 0.5 * width && radius.is_finite()).then(|| {
            let u = side * p.truncate().length() / radius;
            DVec2::new(p.z.atan2(u), p.z.hypot(u))
        })
    };
    local.iter().filter_map(of).collect()
}

/// The number that most of the sections tell, if more than half of all do, and their share.
fn vote(told: impl Iterator<Item = Option<u32>>) -> (Option<u32>, f64) {
    let (mut votes, mut all) = ([0usize; LARGEST as usize + 1], 0);
    for number in told {
        all += 1;
        if let Some(number) = number {
            votes[number as usize] += 1;
        }
    }
    let best = (1..votes.len()).max_by_key(|m| (votes[*m], std::cmp::Reverse(*m))).unwrap_or(1);
    let share = votes[best] as f64 / f64::max(all as f64, 1.0);
    ((share > 0.5).then_some(best as u32), share)
}

/// The radius of a section by parts of a turn, averaged; NaN where it is not known. None of too few
/// points.
fn smooth(mut ring: Vec<DVec2>) -> Option<Vec<f64>> {
    if ring.len() < 16 {
        return None;
    }
    order::rising(&mut ring, |a| a.x);
    let next = |i: usize| {
        let wrap = if i + 1 == ring.len() { DVec2::new(TAU, 0.0) } else { DVec2::ZERO };
        ring[(i + 1) % ring.len()] + wrap
    };
    let gaps: Vec<f64> = (0..ring.len()).map(|i| next(i).x - ring[i].x).collect();
    let usual = median(&mut gaps.clone());
    let longest = (MISSING * usual).max(NARROW);
    let mut radii = vec![f64::NAN; PARTS];
    for (i, gap) in gaps.iter().enumerate().filter(|(_, gap)| **gap <= longest) {
        let (from, to) = (ring[i], next(i));
        let part = |angle: f64| (angle / TAU * PARTS as f64).ceil() as i64;
        for k in part(from.x)..part(to.x) {
            let t = (k as f64 / PARTS as f64 * TAU - from.x) / gap.max(f64::MIN_POSITIVE);
            radii[k.rem_euclid(PARTS as i64) as usize] = from.y + t * (to.y - from.y);
        }
    }
    let half = AVERAGED.max((3.0 * usual / TAU * PARTS as f64) as usize).min(PARTS / 8) / 2;
    let at = |k: usize, off: usize| radii[(k + PARTS + off - half) % PARTS];
    let mean = |k: usize| (0..=2 * half).map(|off| at(k, off)).sum::<f64>() / (2 * half + 1) as f64;
    Some((0..PARTS).map(mean).collect())
}

/// How many maxima a radius has a turn.
fn maxima(smooth: &[f64]) -> Option<u32> {
    let known = || smooth.iter().copied().filter(|r| r.is_finite());
    let (low, high) = known().fold((f64::INFINITY, 0.0f64), |(low, high), r| (low.min(r), high.max(r)));
    if high - low < ROUND * high || low > high {
        return None;
    }
    let is_peak = |k: usize| smooth[k] > smooth[(k + PARTS - 1) % PARTS] && smooth[k] >= smooth[(k + 1) % PARTS];
    let peaks: Vec<usize> = (0..PARTS).filter(|k| is_peak(*k)).collect();
    let number = if known().count() == PARTS {
        peaks.len() as f64
    } else {
        // Periods between neighbours with nothing missing between them.
        let is_whole = |a: usize, b: usize| (a..=b).all(|k| smooth[k % PARTS].is_finite());
        let pairs = (0..peaks.len()).map(|i| (peaks[i], peaks[(i + 1) % peaks.len()]));
        let pairs = pairs.map(|(a, b)| if b > a { (a, b) } else { (a, b + PARTS) });
        let mut periods: Vec<f64> = pairs.filter(|(a, b)| is_whole(*a, *b)).map(|(a, b)| (b - a) as f64).collect();
        if periods.is_empty() {
            return None;
        }
        PARTS as f64 / median(&mut periods)
    };
    let number = number.round();
    (1.0..=f64::from(LARGEST)).contains(&number).then_some(number as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::random::Random;

    /// A star of m points, a share of the turn missing.
    fn star(m: u32, missing: f64, noise: f64) -> Vec<DVec3> {
        let mut random = Random::new(u64::from(m));
        let mut unit = || random.unit();
        (0..3000)
            .map(|_| {
                let angle = TAU * (1.0 - missing) * unit();
                let radius = (0.3 * (f64::from(m) * angle).cos()).exp() + noise * (unit() + unit() - 1.0);
                DVec3::new(radius * angle.cos(), radius * angle.sin(), 2.0 * unit() - 1.0)
            })
            .collect()
    }

    #[test]
    fn clean_sections_tell_their_maxima_with_a_quarter_missing() {
        for m in 3..=10 {
            for missing in [0.0, 0.25] {
                let sweep = sweep(&star(m, missing, 0.0), DMat3::IDENTITY, DVec3::ZERO);
                assert_eq!(sweep.equator, Some(m), "{missing} missing: {sweep:?}");
            }
        }
    }

    #[test]
    fn what_is_not_told_is_none() {
        // A round column, one whose maxima are all noise, and one that is hardly seen.
        for points in [star(0, 0.0, 0.0), star(4, 0.0, 1.2), star(3, 0.8, 0.0)] {
            let sweep = sweep(&points, DMat3::IDENTITY, DVec3::ZERO);
            assert!(sweep.equator.is_none(), "{sweep:?}");
        }
    }
}
