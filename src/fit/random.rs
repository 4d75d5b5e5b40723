//! Random numbers that depend on the seed alone.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::DQuat;

/// Choices of a smaller share than one of these keep no list of all.
const FEW: usize = 16;

/// splitmix64. Source: G. Steele, D. Lea, C. Flood, *Fast splittable pseudorandom number
/// generators* (2014).
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.bits() % count.max(1) as u64) as usize
    }

    /// From 0 to below 1, in steps of 2⁻⁵³.
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A rotation, uniform over all.
    ///
    /// Source: K. Shoemake, *Uniform random rotations* (1992).
    pub(super) fn rotation(&mut self) -> DQuat {
        let (share, first, second) = (self.unit(), TAU * self.unit(), TAU * self.unit());
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        DQuat::from_xyzw(a * first.sin(), a * first.cos(), b * second.sin(), b * second.cos()).normalize()
    }

    /// `count` of the numbers below `of`, in random order; all if there are not more.
    pub(super) fn chosen(&mut self, of: usize, count: usize) -> Vec<usize> {
        if count < of / FEW {
            return self.few_chosen(of, count);
        }
        let mut all: Vec<usize> = (0..of).collect();
        let count = count.min(of);
        for i in 0..count {
            let j = i + self.below(of - i);
            all.swap(i, j);
        }
        all.truncate(count);
        all
    }

    /// The same choice without a list of all: what was swapped is kept.
    fn few_chosen(&mut self, of: usize, count: usize) -> Vec<usize> {
        let mut swapped = HashMap::with_capacity(2 * count);
        (0..count)
            .map(|i| {
                let j = i + self.below(of - i);
                let first = swapped.get(&i).copied().unwrap_or(i);
                let chosen = swapped.get(&j).copied().unwrap_or(j);
                swapped.insert(j, first);
                chosen
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_are_chosen_as_of_a_list_of_all() {
        for (of, count) in [(1, 1), (5, 5), (100, 40), (1000, 1000)] {
            let listed = Random::new(9).chosen(of, count);
            assert_eq!(Random::new(9).few_chosen(of, count), listed);
        }
    }
}
