//! How far a ray may leap through a grid of blocks, some of them full.
//!
//! ```text
//!    +---+---+---+---+      From every empty block, in each of the eight ways that the signs of a
//!    | 3→|   |   |///|      direction tell apart, there is a largest cube of empty blocks, with this
//!    +-↓-+---+---+---+      one in its corner. A ray leaves it by the far sides, and its side is one
//!    |   |   |   |   |      more than the least of those of the seven cubes a step further on.
//!    +---+---+---+---+
//!    |   |   |   |   |
//!    +---+---+---+---+
//! ```
//!
//! A ray that leaves a surface has half of the space before it, most often empty, and is gone in
//! one leap or two.
//!
//! Source: R. Cohen and Z. Sheffer, *Proximity clouds* (1994), for empty space in grids.

use glam::IVec3;

/// By direction and block, x first: the side of the largest cube, 0 for full blocks.
pub(super) struct EmptySpace {
    count: usize,
    sides: Vec<u8>,
}

impl EmptySpace {
    /// Those of a grid of so many blocks along each axis; there is nothing beyond it.
    pub(super) fn new(blocks: IVec3, full: &[bool]) -> EmptySpace {
        let count = full.len();
        let size = blocks.to_array().map(|len| len as usize);
        let stride = [1, size[0], size[0] * size[1]];
        let mut sides = vec![u8::MAX; 8 * count];
        for (way, sides) in sides.chunks_exact_mut(count.max(1)).enumerate() {
            let ups = [0, 1, 2].map(|axis| way >> axis & 1 == 1);
            // Blocks in the order in which those further on come first.
            let along = |axis: usize, i: usize| if ups[axis] { size[axis] - 1 - i } else { i };
            for k in 0..size[2] {
                for j in 0..size[1] {
                    for i in 0..size[0] {
                        let step = [i, j, k];
                        let at = (0..3).map(|axis| along(axis, step[axis]) * stride[axis]).sum::<usize>();
                        let further = |neighbour: usize| {
                            let mut next = at;
                            for axis in (0..3).filter(|axis| neighbour >> axis & 1 == 1) {
                                if step[axis] == 0 {
                                    return u8::MAX;
                                }
                                next = if ups[axis] { next + stride[axis] } else { next - stride[axis] };
                            }
                            sides[next]
                        };
                        let least = (1..8).map(further).min().unwrap_or(0);
                        sides[at] = if full[at] { 0 } else { least.saturating_add(1) };
                    }
                }
            }
        }
        EmptySpace { count, sides }
    }

    /// How many blocks there are.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The side of the cube of a block, in the way of a direction, whose bit `axis` is set if it
    /// goes up that axis: that at `way · count + place`.
    #[inline]
    pub(super) fn side(&self, at: usize) -> u8 {
        self.sides[at]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_are_empty_and_the_largest() {
        let blocks = IVec3::new(9, 7, 8);
        let place = |at: IVec3| ((at.z * blocks.y + at.y) * blocks.x + at.x) as usize;
        let all = |low: IVec3, high: IVec3| {
            let range = move |axis: usize| low[axis]..high[axis];
            range(2).flat_map(move |z| range(1).flat_map(move |y| range(0).map(move |x| IVec3::new(x, y, z))))
        };
        let full: Vec<bool> =
            (0..blocks.element_product() as u32).map(|n| n.wrapping_mul(2_654_435_761) >> 16 & 63 == 7).collect();
        assert!(full.iter().filter(|full| **full).count() > 5);
        let skips = EmptySpace::new(blocks, &full);
        for w in 0..8 {
            let ups = [0, 1, 2].map(|axis| w >> axis & 1 == 1);
            for at in all(IVec3::ZERO, blocks) {
                let side = i32::from(skips.side(w * skips.count() + place(at)));
                let is_empty = |side: i32| {
                    let step = IVec3::from_array(ups.map(|up| if up { side - 1 } else { 1 - side }));
                    let (low, high) = (at.min(at + step).max(IVec3::ZERO), at.max(at + step).min(blocks - 1));
                    all(low, high + 1).all(|at| !full[place(at)])
                };
                assert!(side == 0 || is_empty(side.min(20)), "{at} {ups:?}: {side}");
                assert!(side > 20 || !is_empty(side + 1), "{at} {ups:?}: {side}");
            }
        }
    }
}
