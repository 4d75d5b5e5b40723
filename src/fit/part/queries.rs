//! Where a model is asked whether it is right: points in space and pairs about the surface.
//!
//! ```text
//!     |  .   .  :|:  .    |        .  6000 of Sobol's points in the box and 1.5 % about it, by volume
//!     |    .    :|:   .   |       :|: pairs p ± d·n beside the surface, by share of area: small holes must
//!     |  .    . :|: .     |           count, so no region has less than a part of the weight
//! ```

use glam::DVec3;

use super::bits::{Bits, WORD};
use super::sobol::Sobol;
use crate::Cancelled;
use crate::fit::random::Random;

/// Words of points in space.
const SPREAD: usize = 94;

/// Words of pairs, about.
const PAIRS: f64 = 38.0;

/// What pairs weigh by share of the surface; a wrong volume as large as the part weighs 1.
const BETA: f64 = 0.35;

/// How far the box of the points reaches beyond that of the part, in sizes of that.
pub(super) const MARGIN: f64 = 0.015;

/// A part of the surface that pairs are made of.
pub(super) struct Strip<'a> {
    /// The numbers of its samples.
    pub(super) samples: &'a [u32],
    /// Its part of the surface, or what it counts as.
    pub(super) share: f64,
    /// How far its pairs are from the surface on either side.
    pub(super) apart: f64,
}

/// Points, whether they are inside, and what they weigh.
pub(super) struct Queries {
    pub(super) points: Vec<DVec3>,
    pub(super) inside: Bits,
    /// By word.
    pub(super) weights: Vec<f64>,
}

impl Queries {
    /// Of a part in a box; `label` tells which points are inside.
    pub(super) fn new(
        [low, high]: [DVec3; 2],
        surface: [&[DVec3]; 2],
        strips: &[Strip<'_>],
        seed: u64,
        label: impl FnOnce(&[DVec3]) -> Result<Bits, Cancelled>,
    ) -> Result<Queries, Cancelled> {
        let margin = MARGIN * (high - low);
        let (from, size) = (low - margin, high - low + 2.0 * margin);
        let mut points: Vec<DVec3> = Sobol::new().take(SPREAD * WORD).map(|p| from + size * p).collect();
        let mut weights = vec![0.0; SPREAD];
        let [places, normals] = surface;
        let total: f64 = strips.iter().map(|strip| strip.share).sum();
        let mut random = Random::new(seed);
        for strip in strips.iter().filter(|strip| !strip.samples.is_empty() && strip.share > 0.0) {
            let words = (PAIRS * strip.share / total).round().max(1.0);
            let weight = BETA * strip.share / (words * WORD as f64);
            let pairs = words as usize * WORD / 2;
            let apart = strip.apart;
            let mut order: Vec<usize> = random.chosen(strip.samples.len(), pairs);
            while order.len() < pairs {
                order.push(random.below(strip.samples.len()));
            }
            for (round, at) in order.into_iter().enumerate() {
                let at = strip.samples[at] as usize;
                // Where there are fewer samples than pairs, the same sample is asked at other
                // distances.
                let step = if round < strip.samples.len() { apart } else { apart * (0.5 + (round % 7) as f64 / 7.0) };
                points.push(places[at] + step * normals[at]);
                points.push(places[at] - step * normals[at]);
            }
            weights.resize(points.len() / WORD, weight);
        }
        let inside = label(&points)?;
        let filled: u32 = inside.words()[..SPREAD].iter().map(|word| word.count_ones()).sum();
        weights[..SPREAD].fill(1.0 / f64::from(filled.max(1)));
        Ok(Queries { points, inside, weights })
    }

    /// Whether points in space are inside: the first of Sobol's.
    pub(super) fn spread(&self) -> &[u64] {
        &self.inside.words()[..SPREAD]
    }

    pub(super) fn words(&self) -> usize {
        self.weights.len()
    }
}
