//! A block of cells with facets in those that the surface crosses.
//!
//! ```text
//!      +--+--+--+--+ - - - top      What is beyond a facet, in its cell, is not above `top` along
//!      |  |  |  |  |                `up`. Rays that are above meet nothing here: those that leave
//!      |--+--+__+--+                the surface, and most that pass by.
//!      |\ |_/|//\__|
//!      +-\+//+//+//+
//! ```

use glam::{Vec3, Vec3A, Vec4};

/// Cells along a block.
pub(super) const SIDE: usize = 8;
/// Samples along a block.
pub(super) const NODES: usize = SIDE + 1;

/// A surface does not hide from itself what is nearer than this, in cells.
const BIAS: f32 = 2.0;

/// Tops are this much higher, in cells, than they need to be without rounding.
const SLACK: f32 = 1e-3;

/// A ray in cells.
pub(super) struct Ray {
    pub(super) origin: Vec3A,
    /// About a unit vector, no component of it 0.
    pub(super) direction: Vec3A,
    pub(super) inverse: Vec3A,
    /// 1 and −1.
    pub(super) signs: Vec3A,
}

impl Ray {
    #[inline(always)]
    pub(super) fn at(&self, t: f32) -> Vec3A {
        self.origin + t * self.direction
    }
}

/// A block that the surface may cross.
pub(super) struct Block {
    /// The cells with facets: a word a layer, a byte a row.
    cells: [u64; SIDE],
    /// How many facets the layers before have.
    before: [u16; SIDE],
    /// The slopes of the value a cell, and the value at the block's low corner, in the cells'
    /// order.
    facets: Vec<Vec4>,
}

impl Block {
    /// The facets of a block from the values at its nodes, x fastest.
    pub(super) fn new(values: &[f32]) -> Block {
        let mut block = Block { cells: [0; SIDE], before: [0; SIDE], facets: Vec::new() };
        for z in 0..SIDE {
            block.before[z] = block.facets.len() as u16;
            for y in 0..SIDE {
                for x in 0..SIDE {
                    let first = (z * NODES + y) * NODES + x;
                    let corner = |n: usize| values[first + (n & 1) + (n >> 1 & 1) * NODES + (n >> 2) * NODES * NODES];
                    let inside = (0..8).filter(|&n| corner(n) > 0.0).count();
                    if inside == 0 || inside == 8 {
                        continue;
                    }
                    let (mut slopes, mut value) = (Vec3::ZERO, 0.0);
                    for n in 0..8 {
                        let side = |axis: usize| if n >> axis & 1 == 1 { 0.25 } else { -0.25 };
                        slopes += corner(n) * Vec3::new(side(0), side(1), side(2));
                        value += 0.125 * corner(n);
                    }
                    block.cells[z] |= 1 << (x + SIDE * y);
                    block.facets.push(slopes.extend(value - slopes.dot(middle([x, y, z]))));
                }
            }
        }
        block
    }

    /// The middles of the cells with facets, and these.
    pub(super) fn facets(&self) -> impl Iterator<Item = (Vec3, Vec4)> {
        let places = (0..SIDE * SIDE * SIDE).filter(|at| self.cells[at / 64] >> (at % 64) & 1 == 1);
        places.map(|at| middle([at % SIDE, at / SIDE % SIDE, at / (SIDE * SIDE)])).zip(self.facets.iter().copied())
    }

    /// A unit vector out of the solid, and how far along it from the block's corner there is
    /// something beyond a facet; infinitely far where the facets face all ways.
    ///
    /// What is beyond the facet `v + g·q ≥ 0` of a cell, |qᵢ| ≤ ½ from its middle, is no further
    /// along a unit vector `u` than, for any λ ≥ 0,
    ///
    /// ```text
    ///   u·q ≤ u·q + λ (v + g·q) ≤ λ v + ½ |u + λ g|₁
    /// ```
    ///
    /// which is the plane itself where λ = 1/|g| and g is along −u.
    pub(super) fn top(&self) -> (Vec3, f32) {
        let up: Vec3 = self.facets.iter().map(|facet| -facet.truncate().normalize_or_zero()).sum();
        let up = up.normalize_or_zero();
        if up == Vec3::ZERO {
            return (up, f32::INFINITY);
        }
        let reach = |(middle, facet): (Vec3, Vec4)| {
            let (slopes, value) = (facet.truncate(), facet.dot(middle.extend(1.0)));
            let bound = |share: f32| share * value + 0.5 * (up + share * slopes).abs().element_sum();
            let share = slopes.length_recip();
            let least = if share.is_finite() { bound(share).min(bound(0.0)) } else { bound(0.0) };
            up.dot(middle) + least
        };
        (up, self.facets().map(reach).fold(f32::NEG_INFINITY, f32::max) + SLACK)
    }

    /// The first facet on a ray that is in this block, whose corner is at `corner`, from `t` to
    /// `end`.
    pub(super) fn walk(&self, ray: &Ray, corner: Vec3A, mut t: f32, end: f32) -> Option<f32> {
        let most = Vec3A::splat(SIDE as f32 - 1.0);
        let low = (ray.at(t) - corner).floor().clamp(Vec3A::ZERO, most);
        let ahead = corner + low + (0.5 + 0.5 * ray.signs);
        let mut next = ((ahead - ray.origin) * ray.inverse).to_array();
        let delta = ray.inverse.abs().to_array();
        let [x, y, z] = low.to_array();
        let mut cell = [x as i32, y as i32, z as i32];
        let [x, y, z] = ray.signs.to_array();
        let step = [x as i32, y as i32, z as i32];
        let from = (ray.origin - corner).extend(1.0);
        let direction = ray.direction.extend(0.0);
        loop {
            let axis = if next[0] < next[1] {
                if next[0] < next[2] { 0 } else { 2 }
            } else if next[1] < next[2] {
                1
            } else {
                2
            };
            let after = next[axis];
            let bit = cell[0] + SIDE as i32 * cell[1];
            let layer = cell[2] as usize;
            let word = self.cells[layer];
            if word >> bit & 1 == 1 {
                let number = usize::from(self.before[layer]) + (word & ((1 << bit) - 1)).count_ones() as usize;
                let facet = self.facets[number];
                let (value, rate) = (facet.dot(from), facet.dot(direction));
                if value + t * rate > 0.0 {
                    if t > BIAS {
                        return Some(t);
                    }
                } else if value + after * rate > 0.0 {
                    return Some((-value / rate).max(t));
                }
            }
            cell[axis] += step[axis];
            if !(0..SIDE as i32).contains(&cell[axis]) {
                return None;
            }
            next[axis] += delta[axis];
            t = t.max(after);
            if t > end {
                return None;
            }
        }
    }
}

/// The middle of a cell from the block's corner.
fn middle(cell: [usize; 3]) -> Vec3 {
    Vec3::from_array(cell.map(|along| along as f32 + 0.5))
}
