//! The two nearest of some operands.

/// The distances to the two nearest operands, held at the farthest, and which these are.
#[derive(Clone, Copy)]
pub(super) struct Two {
    pub(super) distances: [f64; 2],
    pub(super) sides: [usize; 2],
}

impl Two {
    pub(super) fn new(farthest: f64) -> Two {
        Two { distances: [farthest; 2], sides: [usize::MAX; 2] }
    }

    pub(super) fn add(&mut self, side: usize, distance: f64) {
        if distance < self.distances[0] {
            self.distances = [distance, self.distances[0]];
            self.sides = [side, self.sides[0]];
        } else if distance < self.distances[1] {
            self.distances[1] = distance;
            self.sides[1] = side;
        }
    }
}
