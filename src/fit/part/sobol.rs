//! Sobol's points in the unit cube: evenly spread however many are taken.
//!
//! Source: S. Joe, F. Kuo, *Constructing Sobol sequences with better two-dimensional projections*
//! (2008), the first three dimensions.

use glam::DVec3;

const BITS: usize = 32;

/// The points, one after the other; the first, which is the origin, is left out.
pub(super) struct Sobol {
    directions: [[u32; BITS]; 3],
    state: [u32; 3],
    count: u32,
}

impl Sobol {
    pub(super) fn new() -> Sobol {
        let mut directions = [[0; BITS]; 3];
        for i in 0..BITS {
            let at = |bits: u32| bits << (BITS - 1 - i);
            directions[0][i] = at(1);
            // Polynomials x + 1 from 1, and x² + x + 1 from 1, 3.
            directions[1][i] = if i == 0 { at(1) } else { directions[1][i - 1] ^ directions[1][i - 1] >> 1 };
            directions[2][i] = match i {
                0 => at(1),
                1 => at(3),
                _ => directions[2][i - 1] ^ directions[2][i - 2] ^ directions[2][i - 2] >> 2,
            };
        }
        Sobol { directions, state: [0; 3], count: 0 }
    }
}

impl Iterator for Sobol {
    type Item = DVec3;

    fn next(&mut self) -> Option<DVec3> {
        let turn = (self.count.trailing_ones() as usize).min(BITS - 1);
        self.count = self.count.wrapping_add(1);
        for (state, directions) in self.state.iter_mut().zip(&self.directions) {
            *state ^= directions[turn];
        }
        Some(DVec3::from_array(self.state.map(|state| f64::from(state) / 4_294_967_296.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slab_of_every_axis_has_its_share() {
        let points: Vec<DVec3> = std::iter::once(DVec3::ZERO).chain(Sobol::new()).take(256).collect();
        for axis in 0..3 {
            let mut slabs = [0; 256];
            for p in &points {
                slabs[(p[axis] * 256.0) as usize] += 1;
            }
            assert_eq!(slabs, [1; 256]);
        }
        let mut cells = [0; 64];
        for p in &points {
            let cell = (*p * 4.0).floor();
            cells[(cell.x + 4.0 * cell.y + 16.0 * cell.z) as usize] += 1;
        }
        assert_eq!(cells, [4; 64]);
    }
}
