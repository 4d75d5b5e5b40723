//! Balls that the surface has room for: where a body is thick.
//!
//! ```text
//!        .------.        r = min over q of |q − p|² / (2 n·(p − q)),     centre p − r·n
//!      .'        '.
//!     |     o      p→n   the samples about a ball that face away from it are of one body,
//!      '.        .'      also where its creases are blunt and patches of it leak
//!        '------'
//! ```
//!
//! Source: J. Ma, S. Bae, S. Choi, *3D medial axis point approximation using nearest neighbors and
//! the normal field* (2012).

use glam::DVec3;
use rvachev_num::order;

use super::patches::{FEWEST, Patch};
use super::samples::Samples;
use crate::fit::random::Random;

/// Samples that a ball is laid to.
const ASKED: usize = 240;

/// Balls kept.
const MOST: usize = 14;

/// Balls nearer to a larger one, in its radii, are left out.
const SPACING: f64 = 0.75;

/// How far about a ball its samples are, in its radii.
const REACHES: [f64; 2] = [1.35, 2.2];

/// How much they face away from the centre, as a cosine.
const FACING: f64 = 0.25;

/// Balls of less radius, in diagonals, are not of a body.
const LEAST: f64 = 0.03;

/// Patches about balls within.
pub(super) fn patches(samples: &Samples, random: &mut Random) -> Vec<Patch> {
    let Samples { points, normals, .. } = samples;
    let mut balls: Vec<(f64, DVec3)> = random
        .chosen(points.len(), ASKED)
        .into_iter()
        .map(|i| {
            let (p, n) = (points[i], normals[i]);
            let room = |q: &DVec3| {
                let depth = 2.0 * n.dot(p - *q);
                if depth > 0.0 { q.distance_squared(p) / depth } else { f64::INFINITY }
            };
            let radius = points.iter().map(room).fold(f64::INFINITY, f64::min);
            (radius, p - radius * n)
        })
        .filter(|(radius, _)| *radius > LEAST && radius.is_finite())
        .collect();
    order::falling(&mut balls, |a| a.0);
    let mut kept: Vec<(f64, DVec3)> = Vec::new();
    for (radius, centre) in balls {
        if kept.len() < MOST && kept.iter().all(|(large, other)| other.distance(centre) > SPACING * large) {
            kept.push((radius, centre));
        }
    }
    let about = |radius: f64, centre: DVec3, reach: f64| {
        let is_near = |i: &usize| {
            let away = points[*i] - centre;
            let distance = away.length();
            distance < reach * radius && normals[*i].dot(away) > FACING * distance
        };
        (0..points.len()).filter(is_near).map(|i| i as u32).collect::<Vec<_>>()
    };
    let balls = kept.into_iter().flat_map(|(radius, centre)| REACHES.map(|reach| about(radius, centre, reach)));
    balls.filter(|samples| samples.len() >= FEWEST).map(|samples| Patch { samples, may: [true, false] }).collect()
}
