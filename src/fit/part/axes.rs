//! Directions that a part's planes face and its cylinders lie along.
//!
//! Each pair of normals votes for the direction across both, which is the axis if both are of one
//! cylinder; each three for the direction across the plane of their tips, which is the axis of a
//! cone; and each normal votes for itself. What most votes are near is taken, then what most of the
//! others are near.

use glam::DVec3;
use rvachev_num::order;

use super::adjust::moments;
use super::seeds::Seeds;
use crate::fit::linear::eigen;
use crate::fit::random::Random;

/// Votes by two normals, by three, and by one.
const PAIRS: usize = 2400;
const TRIPLES: usize = 800;
const SINGLES: usize = 1000;

/// Directions at most, and the least share of the votes that a direction has.
const MOST: usize = 12;
const LEAST: f64 = 0.012;

/// Angles in degrees: between normals that vote; that votes are counted within, averaged within,
/// and cleared within.
const APART: [f64; 2] = [4.0, 84.0];
const COUNTED: f64 = 3.0;
const AVERAGED: [f64; 3] = [2.0, 0.5, 0.1];
const CLEARED: f64 = 4.0;

/// Cells of a face of a cube that directions are counted in, and how many of the fullest are tried.
const CELLS: usize = 45;
const TRIED: usize = 40;

/// Directions, from the one with most votes on.
pub(super) fn axes(seeds: &[&Seeds], random: &mut Random) -> Vec<DVec3> {
    let mut votes = votes(seeds, random);
    let all = votes.len() as f64;
    let mut found = Vec::new();
    while found.len() < MOST {
        let within = |axis: DVec3, angle: f64| {
            let cosine = angle.to_radians().cos();
            votes.iter().filter(move |v| v.dot(axis).abs() >= cosine)
        };
        let count = |axis: &DVec3| within(*axis, COUNTED).count();
        let Some(best) = fullest(&votes).into_iter().max_by_key(count) else { break };
        let held = count(&best);
        if (held as f64) < LEAST * all {
            break;
        }
        let mut axis = best;
        for angle in AVERAGED {
            // What is exact stands out in a narrower cone.
            if 4 * within(axis, angle).count() >= held {
                axis = mean(within(axis, angle));
            }
        }
        let cosine = CLEARED.to_radians().cos();
        votes.retain(|v| v.dot(axis).abs() < cosine && v.dot(best).abs() < cosine);
        found.push(axis);
    }
    found
}

fn votes(seeds: &[&Seeds], random: &mut Random) -> Vec<DVec3> {
    let mut votes = Vec::with_capacity(seeds.len() * (PAIRS + TRIPLES + SINGLES));
    let [near, far] = APART.map(|angle| angle.to_radians().sin());
    for seeds in seeds {
        for _ in 0..PAIRS {
            let Some([a, b]) = seeds.pair(random) else { continue };
            let across = a.normal.cross(b.normal);
            if (near..far).contains(&across.length()) {
                votes.push(across.normalize());
            }
        }
        for _ in 0..TRIPLES {
            let (Some([a, b]), Some([c, d])) = (seeds.pair(random), seeds.pair(random)) else { continue };
            let nearer = if c.point.distance_squared(a.point) < d.point.distance_squared(a.point) { c } else { d };
            if nearer.point.distance_squared(a.point) > 4.0 * a.point.distance_squared(b.point) {
                continue;
            }
            let across = (b.normal - a.normal).cross(nearer.normal - a.normal);
            if across.length() > near * near {
                votes.push(across.normalize());
            }
        }
        if !seeds.exact && !seeds.all.is_empty() {
            votes.extend((0..SINGLES).map(|_| seeds.all[random.below(seeds.all.len())].normal));
        }
    }
    votes
}

/// Mean directions of the cells that hold most votes.
fn fullest(votes: &[DVec3]) -> Vec<DVec3> {
    let mut cells = vec![(0u32, DVec3::ZERO); 3 * CELLS * CELLS];
    for vote in votes {
        let face = vote.abs().max_position();
        let out = *vote * vote[face].signum();
        let [x, y] = [1, 2].map(|k| {
            let along = 0.5 + 0.5 * out[(face + k) % 3] / out[face];
            ((along * CELLS as f64) as usize).min(CELLS - 1)
        });
        let cell = &mut cells[(face * CELLS + x) * CELLS + y];
        cell.0 += 1;
        cell.1 += out;
    }
    let mut order: Vec<usize> = (0..cells.len()).filter(|i| cells[*i].0 > 0).collect();
    order::falling(&mut order, |i| f64::from(cells[*i].0));
    order.truncate(TRIED);
    order.into_iter().map(|i| cells[i].1.normalize_or(DVec3::Z)).collect()
}

/// The direction that is along directions of either sign.
fn mean<'a>(directions: impl Iterator<Item = &'a DVec3>) -> DVec3 {
    eigen(moments(directions.map(|d| (*d, 1.0)))).1.z_axis
}
