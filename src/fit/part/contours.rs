//! Where a field in a plane passes a half: marching squares.
//!
//! Source: W. Lorensen, H. Cline, *Marching cubes* (1987), in the plane.

use glam::DVec2;

use super::sections::{Ring, Segments};

/// Squares of a side from a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Squares {
    pub(super) low: DVec2,
    pub(super) side: f64,
    /// Along x and y.
    pub(super) counts: [usize; 2],
}

impl Squares {
    /// The squares that a rectangle is within.
    pub(super) fn over([low, high]: [DVec2; 2], side: f64) -> Squares {
        let counts = ((high - low) / side).ceil().to_array().map(|count| (count as usize).max(1));
        Squares { low, side, counts }
    }

    /// Rings about what is above a half.
    pub(super) fn rings(&self, value: impl Fn(DVec2) -> f64) -> Vec<Ring> {
        let [nx, ny] = self.counts;
        let at = |i: usize, j: usize| self.low + self.side * DVec2::new(i as f64, j as f64);
        let index = |i: usize, j: usize| j * (nx + 1) + i;
        let mut values = Vec::with_capacity((nx + 1) * (ny + 1));
        for j in 0..=ny {
            for i in 0..=nx {
                // The border is outside, so that all rings close.
                let is_border = i == 0 || j == 0 || i == nx || j == ny;
                values.push(if is_border { -0.5 } else { value(at(i, j)) - 0.5 });
            }
        }
        let mut segments = Segments::default();
        for j in 0..ny {
            for i in 0..nx {
                // Corners, and the edge from each to the next: its number, doubled, and one more if
                // it is upright.
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let edges = [2 * index(i, j), 2 * index(i + 1, j) + 1, 2 * index(i, j + 1), 2 * index(i, j) + 1]
                    .map(|e| e as u64);
                let value = corners.map(|(i, j)| values[index(i, j)]);
                let inside = value.map(|v| v >= 0.0);
                for k in 0..4 {
                    let next = (k + 1) % 4;
                    if !inside[k] || inside[next] {
                        continue;
                    }
                    // Counter-clockwise from where the inside is left to where it is entered again.
                    let Some(end) = (1..4).map(|s| (k + s) % 4).find(|e| !inside[*e] && inside[(e + 1) % 4]) else {
                        continue;
                    };
                    let (a, b) = (at(corners[k].0, corners[k].1), at(corners[next].0, corners[next].1));
                    segments.add(edges[k], edges[end], a.lerp(b, value[k] / (value[k] - value[next])));
                }
            }
        }
        segments.rings()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_washer_has_two_rings() {
        let squares = Squares::over([DVec2::splat(-0.5), DVec2::splat(0.5)], 0.02);
        let washer = |p: DVec2| 0.5 + (0.4 - p.length()).min(p.length() - 0.1);
        let mut areas: Vec<f64> = squares.rings(washer).iter().map(|ring| ring.area).collect();
        areas.sort_by(f64::total_cmp);
        let truth = [-0.01, 0.16].map(|square| std::f64::consts::PI * square);
        assert!(areas.len() == 2 && areas.iter().zip(truth).all(|(a, t)| (a / t - 1.0).abs() < 0.01), "{areas:?}");
    }
}
