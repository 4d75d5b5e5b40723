//! Vertices of one position as one vertex.

use std::collections::HashMap;

use glam::DVec3;

/// Positions, each of them once.
#[derive(Default)]
pub(super) struct Weld {
    numbers: HashMap<[u64; 3], u32>,
    pub(super) positions: Vec<DVec3>,
}

impl Weld {
    /// The number of the vertex at a position. There are fewer than 2³².
    pub(super) fn vertex(&mut self, p: DVec3) -> u32 {
        // 0 and −0 are one place.
        let key = (p + 0.0).to_array().map(f64::to_bits);
        let next = self.positions.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.positions.push(p);
        }
        number
    }
}
