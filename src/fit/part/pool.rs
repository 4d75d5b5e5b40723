//! Candidates: leaves that may be added or subtracted, with the samples that they hold.

use super::bits::Bits;
use super::leaf::Leaf;
use super::queries::Queries;

/// A leaf that may be taken.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) leaf: Leaf,
    pub(super) bits: Bits,
    /// Whether it may be added, and subtracted.
    pub(super) may: [bool; 2],
    /// Candidates of one surface that differ in their ends only.
    pub(super) family: Option<u32>,
    /// What it costs.
    pub(super) price: f64,
}

/// All candidates.
#[derive(Default)]
pub(super) struct Pool {
    pub(super) candidates: Vec<Candidate>,
    /// What a parameter costs.
    pub(super) per_parameter: f64,
    families: u32,
}

impl Pool {
    pub(super) fn new(per_parameter: f64) -> Pool {
        Pool { candidates: Vec::new(), per_parameter, families: 0 }
    }

    /// A number for candidates that differ in their ends.
    pub(super) fn family(&mut self) -> Option<u32> {
        self.families += 1;
        Some(self.families)
    }

    pub(super) fn push(&mut self, leaf: Leaf, bits: Bits, may: [bool; 2], family: Option<u32>) -> u32 {
        let price = self.per_parameter * leaf.parameters() as f64;
        self.candidates.push(Candidate { leaf, bits, may, family, price });
        (self.candidates.len() - 1) as u32
    }

    /// The same with the samples found out.
    pub(super) fn add(&mut self, leaf: Leaf, queries: &Queries, may: [bool; 2], family: Option<u32>) -> u32 {
        let bits = Bits::of(&queries.points, |p| leaf.contains(p));
        self.push(leaf, bits, may, family)
    }
}
