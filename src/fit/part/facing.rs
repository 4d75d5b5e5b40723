//! Which way a surface faces: as winding numbers of its points are to fall there.
//!
//! ```text
//!     w(x) = Σ μ·(p − x)/|p − x|³ / 4π         is 1 inside, 0 outside, and ½ on the surface
//!
//!     a step down Σ (w − ½)²; then each μ is turned to where w falls fastest     again and again
//! ```
//!
//! The vectors μ are the normals that are looked for, as long as the areas that the points stand
//! for. Nothing is asked of neighbours, so walls that are near each other and sharp edges do no
//! harm. Lengths below a width count as this one, which falls from step to step.
//!
//! Source: S. Lin, Z. Shi, Y. Liu, *Fast and globally consistent normal orientation based on the
//! winding number normal consistency* (2024).

use std::f64::consts::TAU;

use fearless_simd::Simd;
use glam::DVec3;
use rvachev_num::Real;
use rvachev_num::lanes::{F32, Lanes};

use crate::fit::random::Random;
use crate::{Cancelled, Run};
use rvachev_num::jobs;

/// Points that it is found by.
const MOST: usize = 2200;

/// Rounds, and the widths of the first and of the last one, in distances of points.
const ROUNDS: usize = 14;
const WIDTHS: [f64; 2] = [2.5, 0.5];

/// Whole vectors of any SIMD level.
const WIDTH: usize = 16;

/// Points that one thread asks for at a time.
const CHUNK: usize = 64;

/// A vector a point, by coordinates; 0 beyond the last point up to whole lanes.
type Columns = [Vec<f32>; 3];

fn columns(vectors: impl ExactSizeIterator<Item = DVec3>) -> Columns {
    let mut columns: Columns = std::array::from_fn(|_| Vec::with_capacity(vectors.len().next_multiple_of(WIDTH)));
    for v in vectors {
        for (column, x) in columns.iter_mut().zip(v.to_array()) {
            column.push(x as f32);
        }
    }
    for column in &mut columns {
        column.resize(column.len().next_multiple_of(WIDTH), 0.0);
    }
    columns
}

/// Unit vectors outwards at points that stand for areas; 0 where nothing is told.
pub(super) fn outward(
    points: &[DVec3],
    areas: &[f64],
    random: &mut Random,
    run: &Run,
) -> Result<Vec<DVec3>, Cancelled> {
    let chosen = random.chosen(points.len(), MOST);
    let count = chosen.len();
    let apart = (areas.iter().sum::<f64>() / count.max(1) as f64).sqrt().max(1e-6);
    let places: Vec<DVec3> = chosen.iter().map(|i| points[*i]).collect();
    let sources = columns(places.iter().copied());
    let mut moments = vec![DVec3::ZERO; count];
    let mut square = 0.0;
    for round in 0..ROUNDS {
        run.report(round as f64 / ROUNDS as f64);
        let t = round as f64 / (ROUNDS - 1) as f64;
        square = (apart * (WIDTHS[0] + t * (WIDTHS[1] - WIDTHS[0]))).powi(2);
        let ask = |at: &[DVec3], what: What, moments: &[DVec3]| {
            sums(at, &sources, &columns(moments.iter().copied()), what, square, run)
        };
        let numbers = |moments: &[DVec3]| ask(&places, What::Number, moments);
        let off: Vec<DVec3> = numbers(&moments)?.iter().map(|w| DVec3::X * (TAU - w.x)).collect();
        let down = ask(&places, What::Pull, &off)?;
        let along = numbers(&down)?;
        let [length, growth] = [&down, &along].map(|all| all.iter().map(|v| v.length_squared()).sum::<f64>());
        let step = length / growth.max(f64::MIN_POSITIVE);
        moments.iter_mut().zip(&down).for_each(|(moment, down)| *moment += step * *down);
        let falls = ask(&places, What::Fall, &moments)?;
        for (moment, fall) in moments.iter_mut().zip(falls) {
            *moment = moment.length() * fall.normalize_or_zero();
        }
    }
    let falls = sums(points, &sources, &columns(moments.iter().copied()), What::Fall, square, run)?;
    Ok(falls.into_iter().map(DVec3::normalize_or_zero).collect())
}

/// What is summed over the sources, of d from a place to a source and r its length, at the least a
/// width.
#[derive(Clone, Copy)]
enum What {
    /// μ·d/r³, as the first coordinate: 4π times the winding number.
    Number,
    /// The first coordinate of μ times −d/r³: how numbers at the sources change by a moment here.
    Pull,
    /// μ/r³ − 3 (μ·d) d/r⁵: where the winding number falls.
    Fall,
}

fn sums(
    at: &[DVec3],
    sources: &Columns,
    moments: &Columns,
    what: What,
    square: f64,
    run: &Run,
) -> Result<Vec<DVec3>, Cancelled> {
    let chunk = |at: &[DVec3]| {
        run.check()?;
        Ok(rvachev_num::on_level!(simd => sums_on(simd, at, sources, moments, what, square)))
    };
    let chunks: Vec<Vec<DVec3>> = jobs::try_chunks(at, CHUNK, |_, points| chunk(points))?;
    Ok(chunks.concat())
}

#[inline(always)]
fn sums_on<S: Simd>(
    simd: S,
    at: &[DVec3],
    sources: &Columns,
    moments: &Columns,
    what: What,
    square: f64,
) -> Vec<DVec3> {
    at.iter()
        .map(|p| match what {
            What::Number => sum_on(simd, *p, sources, moments, square, |d, mu, _, cube| {
                let zero = d[0] * 0.0;
                [dot(d, mu) * cube, zero, zero]
            }),
            What::Pull => sum_on(simd, *p, sources, moments, square, |d, mu, _, cube| {
                let by = -(mu[0] * cube);
                [d[0] * by, d[1] * by, d[2] * by]
            }),
            What::Fall => sum_on(simd, *p, sources, moments, square, |d, mu, squares, cube| {
                let [r2, beyond] = squares;
                let along = dot(d, mu) * cube * 3.0 / r2;
                let along = beyond.select(along, along * 0.0);
                [mu[0] * cube - d[0] * along, mu[1] * cube - d[1] * along, mu[2] * cube - d[2] * along]
            }),
        })
        .collect()
}

#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// The sum over the sources of terms of d, μ, r² with how far it is above the least one, and 1/r³.
#[inline(always)]
fn sum_on<S: Simd>(
    simd: S,
    p: DVec3,
    sources: &Columns,
    moments: &Columns,
    square: f64,
    term: impl Fn([F32<S>; 3], [F32<S>; 3], [F32<S>; 2], F32<S>) -> [F32<S>; 3],
) -> DVec3 {
    let width = <F32<S> as Lanes>::WIDTH;
    let splat = |x: f64| <F32<S> as Lanes>::splat(simd, x);
    let place = [splat(p.x), splat(p.y), splat(p.z)];
    let (least, one) = (splat(square), splat(1.0));
    let mut sums = [splat(0.0); 3];
    for start in (0..sources[0].len()).step_by(width) {
        let at = start..start + width;
        let load = |from: &[f32]| <F32<S> as Lanes>::load(simd, &from[at.clone()]);
        let d = [load(&sources[0]) - place[0], load(&sources[1]) - place[1], load(&sources[2]) - place[2]];
        let mu = [load(&moments[0]), load(&moments[1]), load(&moments[2])];
        let away = dot(d, d);
        let r2 = away.max(least);
        let found = term(d, mu, [r2, away - least], one / (r2 * r2.sqrt()));
        for k in 0..3 {
            sums[k] = sums[k] + found[k];
        }
    }
    let mut buffer = [0.0_f32; WIDTH];
    let mut sum = |v: F32<S>| -> f64 {
        v.store(&mut buffer[..width]);
        buffer[..width].iter().map(|x| f64::from(*x)).sum()
    };
    DVec3::new(sum(sums[0]), sum(sums[1]), sum(sums[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two spheres, one about the other, the outer one faces out and the inner one in.
    #[test]
    fn a_hollow_ball_faces_out_and_in() {
        let point = |i: usize| {
            let (z, turn) = (((i as f64 + 0.5) * 0.618_033_988_75).fract() * 2.0 - 1.0, i as f64 * 2.399_963_229_7);
            DVec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
        };
        let radius = |i: usize| if i.is_multiple_of(5) { 0.2 } else { 0.4 };
        let points: Vec<DVec3> = (0..1000).map(|i| radius(i) * point(i)).collect();
        let areas: Vec<f64> = vec![2.0 * TAU * 0.2 / 1000.0; 1000];
        let found = outward(&points, &areas, &mut Random::new(1), &Run::default()).unwrap();
        let wrong = (0..1000).filter(|i| (radius(*i) > 0.3) != (found[*i].dot(points[*i]) > 0.0)).count();
        assert!(wrong < 5, "{wrong}");
    }
}
