//! Sets of samples as bits, 64 a word.
//!
//! ```text
//!     Σ w over (c ∧ gain) − Σ w over (c ∧ loss)  =  Σ_words w · (ones(c ∧ gain) − ones(c ∧ loss))
//! ```
//!
//! All samples of a word weigh the same, so what a set weighs is a count of bits a word.

use glam::DVec3;

/// Samples in a word.
pub(super) const WORD: usize = 64;

/// A set of samples.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Bits(Vec<u64>);

impl Bits {
    pub(super) fn none(words: usize) -> Bits {
        Bits(vec![0; words])
    }

    pub(super) fn of_words(words: Vec<u64>) -> Bits {
        Bits(words)
    }

    /// The samples, by number, of which something is true.
    pub(super) fn new(count: usize, mut is: impl FnMut(usize) -> bool) -> Bits {
        let word = |at: usize| {
            let range = at * WORD..count.min((at + 1) * WORD);
            range.rev().fold(0, |word, i| word << 1 | u64::from(is(i)))
        };
        Bits((0..count.div_ceil(WORD)).map(word).collect())
    }

    /// The points of which something is true.
    pub(super) fn of(points: &[DVec3], mut is: impl FnMut(DVec3) -> bool) -> Bits {
        Bits::new(points.len(), |i| is(points[i]))
    }

    pub(super) fn words(&self) -> &[u64] {
        &self.0
    }

    pub(super) fn is_none(&self) -> bool {
        self.0.iter().all(|word| *word == 0)
    }

    pub(super) fn with(&self, other: &Bits, join: impl Fn(u64, u64) -> u64) -> Bits {
        Bits(self.0.iter().zip(&other.0).map(|(a, b)| join(*a, *b)).collect())
    }

    pub(super) fn and(&self, other: &Bits) -> Bits {
        self.with(other, |a, b| a & b)
    }

    pub(super) fn without(&self, other: &Bits) -> Bits {
        self.with(other, |a, b| a & !b)
    }

    pub(super) fn join(&mut self, other: &Bits) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a |= b;
        }
    }

    pub(super) fn remove(&mut self, other: &Bits) {
        for (a, b) in self.0.iter_mut().zip(&other.0) {
            *a &= !b;
        }
    }

    /// The numbers of the samples.
    pub(super) fn each(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().enumerate().flat_map(|(at, word)| {
            let mut rest = *word;
            std::iter::from_fn(move || {
                let bit = (rest != 0).then(|| rest.trailing_zeros() as usize)?;
                rest &= rest - 1;
                Some(at * WORD + bit)
            })
        })
    }
}

/// What is won and what is lost by what is done to a sample.
pub(super) struct Stakes {
    pub(super) gain: Bits,
    pub(super) loss: Bits,
}

impl Stakes {
    /// The words in which there is something to gain, with their numbers.
    pub(super) fn chances(&self) -> Vec<(usize, u64)> {
        self.gain.0.iter().copied().enumerate().filter(|(_, word)| *word != 0).collect()
    }

    /// What doing it to a set gains where losses count nothing.
    #[inline(always)]
    pub(super) fn most(set: &Bits, chances: &[(usize, u64)], weights: &[f64]) -> f64 {
        let mut sum = 0.0;
        for &(at, gain) in chances {
            sum += weights[at] * f64::from((set.0[at] & gain).count_ones());
        }
        sum
    }

    /// What doing it to a set loses.
    #[inline(always)]
    pub(super) fn loss(&self, set: &Bits, weights: &[f64]) -> f64 {
        let mut sum = 0.0;
        for ((c, loss), weight) in set.0.iter().zip(&self.loss.0).zip(weights) {
            let lost = c & loss;
            if lost != 0 {
                sum += weight * f64::from(lost.count_ones());
            }
        }
        sum
    }

    /// What doing it to a set gains.
    pub(super) fn of(&self, set: &Bits, weights: &[f64]) -> f64 {
        Stakes::most(set, &self.chances(), weights) - self.loss(set, weights)
    }
}

/// What a set weighs.
pub(super) fn weight(set: &Bits, weights: &[f64]) -> f64 {
    set.0.iter().zip(weights).map(|(word, weight)| weight * f64::from(word.count_ones())).sum()
}

/// What the samples weigh that are in one of two sets only.
pub(super) fn differing(a: &Bits, b: &Bits, weights: &[f64]) -> f64 {
    let words = a.0.iter().zip(&b.0).zip(weights);
    words.map(|((a, b), weight)| weight * f64::from((a ^ b).count_ones())).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_counted_by_words() {
        let points: Vec<DVec3> = (0..128).map(|i| DVec3::splat(f64::from(i))).collect();
        let even = Bits::of(&points, |p| p.x % 2.0 == 0.0);
        let low = Bits::of(&points, |p| p.x < 70.0);
        assert_eq!(even.and(&low).each().count(), 35);
        assert_eq!(even.without(&low).each().next(), Some(70));
        let weights = [1.0, 10.0];
        assert_eq!(weight(&low, &weights), 64.0 + 60.0);
        assert_eq!(differing(&even, &low, &weights), 32.0 + 3.0 * 10.0 + 29.0 * 10.0);
        let stakes = Stakes { gain: low.clone(), loss: even.without(&low) };
        assert_eq!(Stakes::most(&even, &stakes.chances(), &weights), 32.0 + 30.0);
        assert_eq!(stakes.of(&even, &weights), 32.0 + 30.0 - 290.0);
    }
}
