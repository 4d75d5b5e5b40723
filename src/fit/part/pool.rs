//! Candidates: leaves that may be added or subtracted, with the samples that they hold.

use std::collections::HashMap;

use super::bits::Bits;
use super::layouts::EQUAL;
use super::leaf::Leaf;
use super::queries::Queries;

/// Numbers that one more of equal leaves takes at most: those of a line of two.
const ANOTHER: f64 = 4.0;

/// A leaf that may be taken.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) leaf: Leaf,
    pub(super) bits: Bits,
    /// Whether it may be added, and subtracted.
    pub(super) may: [bool; 2],
    /// Candidates of one surface that differ in their ends only.
    pub(super) family: Option<u32>,
    /// What it costs, and what it does where there is an equal leaf.
    pub(super) price: f64,
    pub(super) another: f64,
    /// Equal leaves, wherever they are, have the same number.
    pub(super) class: u32,
}

/// All candidates.
#[derive(Default)]
pub(super) struct Pool {
    pub(super) candidates: Vec<Candidate>,
    /// What a parameter costs.
    pub(super) per_parameter: f64,
    /// What a leaf costs beside its own, in parameters.
    per_leaf: f64,
    families: u32,
    /// By kind and least size: sizes and numbers of classes.
    classes: HashMap<(&'static str, i64), Vec<(Leaf, u32)>>,
    pub(super) class_count: u32,
}

impl Pool {
    pub(super) fn new(per_parameter: f64) -> Pool {
        Pool { per_parameter, ..Pool::default() }
    }

    /// A number for candidates that differ in their ends.
    pub(super) fn family(&mut self) -> Option<u32> {
        self.families += 1;
        Some(self.families)
    }

    pub(super) fn push(&mut self, leaf: Leaf, bits: Bits, may: [bool; 2], family: Option<u32>) -> u32 {
        let price = self.price(&leaf);
        let (another, class) = (price.min(ANOTHER * self.per_parameter), self.class(&leaf));
        self.candidates.push(Candidate { leaf, bits, may, family, price, another, class });
        (self.candidates.len() - 1) as u32
    }

    fn price(&self, leaf: &Leaf) -> f64 {
        self.per_parameter * (leaf.parameters() as f64 + self.per_leaf)
    }

    /// From now on a leaf costs so much beside its parameters, in parameters; one more of equal
    /// ones costs what it did.
    pub(super) fn charge(&mut self, per_leaf: f64) {
        self.per_leaf = per_leaf;
        for i in 0..self.candidates.len() {
            self.candidates[i].price = self.price(&self.candidates[i].leaf);
        }
    }

    fn class(&mut self, leaf: &Leaf) -> u32 {
        let least = leaf.sorted_sizes().into_iter().fold(f64::INFINITY, f64::min).min(1e3);
        let (kind, cell) = (leaf.kind(), (least / EQUAL).floor() as i64);
        let known = [cell, cell - 1, cell + 1].into_iter().find_map(|cell| {
            let all = self.classes.get(&(kind, cell))?;
            all.iter().find(|(other, _)| other.is_equal(leaf, EQUAL)).map(|(_, class)| *class)
        });
        known.unwrap_or_else(|| {
            self.class_count += 1;
            let class = self.class_count - 1;
            self.classes.entry((kind, cell)).or_default().push((leaf.clone(), class));
            class
        })
    }

    /// The same with the samples found out.
    pub(super) fn add(&mut self, leaf: Leaf, queries: &Queries, may: [bool; 2], family: Option<u32>) -> u32 {
        let bits = Bits::of(&queries.points, |p| leaf.contains(p));
        self.push(leaf, bits, may, family)
    }
}
