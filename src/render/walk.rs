//! A ray's way through a grid of blocks.
//!
//! ```text
//!      +-------+-------+-------+
//!      |       |       |   ..--|-->     The crossings with the planes of the grid, nearest
//!      |       |  ..-- *--     |        first, cut the ray into segments, one a block. The
//!      |  ..-- *--     |       |        end of a segment is the start of the next, to the
//!      *--     |       |       |        bit: no point of the ray lies between two.
//!      +-------+-------+-------+
//! ```
//!
//! Crossings are computed from the planes' numbers, not summed up, so errors do not grow on
//! the way. A segment may leave its block by the rounding of one multiplication and addition,
//! which the caller allows for when it narrows the blocks.
//!
//! Source: J. Amanatides, A. Woo, *A fast voxel traversal algorithm for ray tracing* (1987).

use glam::DVec3;

use crate::space::Grid;

/// The part of a ray within one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    pub(super) block: [u32; 3],
    /// Distances from the ray's origin, `near ≤ far`.
    pub(super) near: f64,
    pub(super) far: f64,
}

/// The segments of a ray in a grid, nearest first.
pub(super) struct Walk<'a> {
    grid: &'a Grid,
    origin: DVec3,
    inverse: DVec3,
    /// +1, −1, or 0 where the ray is parallel to the planes of an axis.
    steps: [i64; 3],
    at: [i64; 3],
    /// Where the ray leaves the present block along each axis.
    next: [f64; 3],
    near: f64,
    inside: bool,
}

impl<'a> Walk<'a> {
    /// The walk of the ray from `origin` along `direction`, a unit vector.
    pub(super) fn new(grid: &'a Grid, origin: DVec3, direction: DVec3) -> Walk<'a> {
        let mut walk = Walk {
            grid,
            origin,
            inverse: direction.recip(),
            steps: direction.to_array().map(|d| if d > 0.0 { 1 } else { -i64::from(d < 0.0) }),
            at: [0; 3],
            next: [f64::INFINITY; 3],
            near: 0.0,
            inside: true,
        };
        let mut far = f64::INFINITY;
        for axis in 0..3 {
            let count = i64::from(grid.blocks[axis]);
            let (first, last) = match walk.steps[axis] {
                0 => {
                    let place = (origin[axis] - grid.origin[axis]) / grid.side;
                    walk.inside &= (0.0..=count as f64).contains(&place);
                    continue;
                }
                1 => (0, count),
                _ => (count, 0),
            };
            walk.near = walk.near.max(walk.plane(axis, first));
            far = far.min(walk.plane(axis, last));
        }
        walk.inside &= walk.near < far;
        let entry = (origin + walk.near * direction - grid.origin) / grid.side;
        for axis in 0..3 {
            // Rounding may put a point on a plane into the block before it; then the first
            // segment is empty and the walk goes on.
            walk.at[axis] = (entry[axis].floor() as i64).clamp(0, i64::from(grid.blocks[axis]) - 1);
            walk.aim(axis);
        }
        walk
    }

    /// Where the ray meets a plane of the grid.
    fn plane(&self, axis: usize, number: i64) -> f64 {
        let plane = self.grid.origin[axis] + self.grid.side * number as f64;
        (plane - self.origin[axis]) * self.inverse[axis]
    }

    /// Sets the crossing at which the ray leaves the present block along an axis.
    fn aim(&mut self, axis: usize) {
        match self.steps[axis] {
            0 => {}
            1 => self.next[axis] = self.plane(axis, self.at[axis] + 1),
            _ => self.next[axis] = self.plane(axis, self.at[axis]),
        }
    }
}

impl Iterator for Walk<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        if !self.inside {
            return None;
        }
        let [x, y, z] = self.next;
        let axis = if x <= y && x <= z {
            0
        } else if y <= z {
            1
        } else {
            2
        };
        let segment =
            Segment { block: self.at.map(|i| i as u32), near: self.near, far: self.next[axis].max(self.near) };
        self.near = segment.far;
        self.at[axis] += self.steps[axis];
        // A ray of NaN steps nowhere.
        self.inside = self.steps[axis] != 0 && (0..i64::from(self.grid.blocks[axis])).contains(&self.at[axis]);
        self.aim(axis);
        Some(segment)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid { origin: DVec3::new(-1.0, -2.0, 0.5), side: 0.25, blocks: [8, 16, 5] }
    }

    #[test]
    fn segments_abut_and_lie_in_their_blocks() {
        let grid = grid();
        let mut crossed = 0;
        for i in 0..2000u32 {
            // A low-discrepancy scatter of eyes and targets; every eighth ray is along an axis.
            let at = |k: f64| DVec3::new(0.754_877, 0.569_840, 0.438_579).map(|a| (a * k).fract() * 2.0 - 1.0);
            let origin = 4.0 * at(f64::from(i));
            let target = at(f64::from(i) + 0.37) * DVec3::new(1.0, 2.0, 0.6) + DVec3::Z;
            let direction = if i % 8 == 0 {
                -origin.signum() * DVec3::AXES[i as usize / 8 % 3]
            } else {
                (target - origin).normalize()
            };
            let segments: Vec<Segment> = Walk::new(&grid, origin, direction).collect();
            crossed += usize::from(!segments.is_empty());
            for pair in segments.windows(2) {
                assert_eq!(pair[0].far, pair[1].near);
            }
            for segment in &segments {
                let next = segment.block.map(|k| k + 1);
                let block = grid.bounds(segment.block, next).inflate(1e-14);
                for t in [segment.near, segment.far] {
                    assert!(segment.near == segment.far || block.contains(origin + t * direction));
                }
            }
            let whole = grid.bounds([0; 3], grid.blocks);
            let inside = (0..800).filter(|k| whole.contains(origin + f64::from(*k) * 0.02 * direction)).count();
            let length = segments.last().map_or(0.0, |s| s.far) - segments.first().map_or(0.0, |s| s.near);
            assert!((length - 0.02 * inside as f64).abs() < 0.03, "ray {i}: {length}");
        }
        assert!(crossed > 1000, "{crossed}");
    }

    #[test]
    fn rays_beside_behind_and_of_nan() {
        let grid = grid();
        let count = |o: DVec3, d: DVec3| Walk::new(&grid, o, d).count();
        assert_eq!(count(DVec3::new(5.0, 0.0, 1.0), DVec3::Z), 0);
        assert_eq!(count(DVec3::new(5.0, 0.0, 1.0), DVec3::X), 0);
        assert_eq!(count(DVec3::new(5.0, 0.01, 1.01), -DVec3::X), 8);
        assert_eq!(count(DVec3::new(0.01, 0.01, 1.01), -DVec3::X), 5);
        assert!(count(DVec3::NAN, DVec3::NAN) <= 1);
    }
}
