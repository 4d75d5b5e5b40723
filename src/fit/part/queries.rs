//! Where a model is asked whether it is right: points in space and pairs about the surface.
//!
//! ```text
//!     |  .   .  :|:  .    |        .  6000 of Sobol's points in the box and 1.5 % about it, by volume
//!     |    .    :|:   .   |       :|: pairs p ± d·n beside the surface, by share of area: small holes must
//!     |  .    . :|: .     |           count, so no region has less than a part of the weight
//! ```

use glam::DVec3;
use rvachev_num::order;

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

/// Winding numbers of points that are by so much off a half tell nothing, and by so much more all:
/// where there are no points of the surface, space is neither inside nor outside.
const UNKNOWN: f64 = 0.12;
const KNOWN: f64 = 0.25;

/// Winding numbers on the wrong side of a half by so much more than this contradict a normal.
const AGAINST: f64 = 0.2;

/// What tells which points are inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Told {
    /// Winding numbers of a closed surface.
    ByWinding,
    /// Winding numbers of points with normals, which are right away from the surface, and the
    /// normals beside it.
    ByPoints,
}

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
    told: Told,
}

/// A point with its side, and how sure that is, 0 to 1.
#[derive(Clone, Copy)]
struct Asked {
    point: DVec3,
    inside: bool,
    sure: f64,
}

impl Queries {
    /// Of a part in a box; `winding` gives the winding numbers of points.
    pub(super) fn new(
        [low, high]: [DVec3; 2],
        surface: [&[DVec3]; 2],
        strips: &[Strip<'_>],
        seed: u64,
        told: Told,
        winding: impl FnOnce(&[DVec3]) -> Result<Vec<f64>, Cancelled>,
    ) -> Result<Queries, Cancelled> {
        let margin = MARGIN * (high - low);
        let (from, size) = (low - margin, high - low + 2.0 * margin);
        let mut points: Vec<DVec3> = Sobol::new().take(SPREAD * WORD).map(|p| from + size * p).collect();
        let [places, normals] = surface;
        let total: f64 = strips.iter().map(|strip| strip.share).sum();
        let mut random = Random::new(seed);
        // Where the pairs of each strip end, and what one of its points weighs.
        let mut ends = Vec::new();
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
            ends.push((points.len(), weight));
        }
        let numbers = winding(&points)?;
        let space: Vec<Asked> =
            points.iter().zip(&numbers).take(SPREAD * WORD).map(|(p, w)| told.space(*p, *w)).collect();
        let filled = space.iter().filter(|asked| asked.inside).count().max(1);
        let mut queries =
            Queries { points: Vec::with_capacity(points.len()), inside: Bits::none(0), weights: Vec::new(), told };
        let mut words = Vec::new();
        queries.push(space, 1.0 / filled as f64, &mut words);
        let mut from = SPREAD * WORD;
        for (end, weight) in ends {
            let beside = (from..end).map(|i| told.beside(points[i], numbers[i], (i - from) % 2 == 1)).collect();
            queries.push(beside, weight, &mut words);
            from = end;
        }
        queries.inside = Bits::of_words(words);
        Ok(queries)
    }

    /// Adds points of one weight, those together that are about as sure; the last word is filled up
    /// by points that it has.
    fn push(&mut self, mut asked: Vec<Asked>, weight: f64, words: &mut Vec<u64>) {
        asked.retain(|a| a.sure > 0.0);
        order::falling(&mut asked, |a| a.sure);
        for some in asked.chunks(WORD) {
            let sure: f64 = some.iter().map(|a| a.sure).sum();
            self.weights.push(weight * sure / WORD as f64);
            let all = || some.iter().cycle().take(WORD);
            self.points.extend(all().map(|a| a.point));
            words.push(all().enumerate().fold(0, |word, (i, a)| word | u64::from(a.inside) << i));
        }
    }

    /// Whether points in space are inside: the first of Sobol's; none where they are in another
    /// order.
    pub(super) fn spread(&self) -> &[u64] {
        match self.told {
            Told::ByWinding => &self.inside.words()[..SPREAD],
            Told::ByPoints => &[],
        }
    }

    pub(super) fn words(&self) -> usize {
        self.weights.len()
    }
}

impl Told {
    /// A point in space.
    fn space(self, point: DVec3, winding: f64) -> Asked {
        let off = ((winding - 0.5).abs() - UNKNOWN) / KNOWN;
        let sure = if self == Told::ByWinding { 1.0 } else { off.clamp(0.0, 1.0) };
        Asked { point, inside: winding > 0.5, sure }
    }

    /// A point beside the surface, on the side that is meant to be inside or not.
    fn beside(self, point: DVec3, winding: f64, inside: bool) -> Asked {
        if self == Told::ByWinding {
            return self.space(point, winding);
        }
        let against = if inside { 0.5 - winding } else { winding - 0.5 };
        Asked { point, inside, sure: (1.0 - (against - AGAINST) / KNOWN).clamp(0.0, 1.0) }
    }
}
