//! A block of cells with facets in those that the surface crosses, or creases (see `facet_crease`).
//!
//! ```text
//!      +--+--+--+--+ - - - top      What is beyond a facet, in its cell, is not above `top` along
//!      |  |  |  |  |                `up`. Rays that are above meet nothing here: those that leave
//!      |--+--+__+--+                the surface, and most that pass by.
//!      |\ |_/|//\__|
//!      +-\+//+//+//+
//! ```

use glam::{Vec3, Vec3A, Vec4};

use super::facet_crease::{Corner, CreasedCell, Meeting, meet_plane};

/// Cells along a block.
pub(super) const SIDE: usize = 8;
/// Samples along a block.
pub(super) const NODES: usize = SIDE + 1;

/// A surface does not hide from itself what is nearer than this, in cells.
pub(super) const BIAS: f32 = 2.0;

/// Tops are this much higher, in cells, than they need to be without rounding.
const SLACK: f32 = 1e-3;

/// Where the values at a cell's corners are off a plane by more than this, in cells, a crease may
/// pass, or the surface curves.
const FLAT: f32 = 0.03;

/// Planes that are off by more than this, in cells, say little of where the surface is: in cells
/// that a blade thinner than they are passes, or where the value jumps. They hide nothing that is
/// nearer than [`BIAS`].
pub(super) const VAGUE: f32 = 0.25;

/// The surface is in no cell all of whose corners are farther from it than this, in cells.
const NEAR: f32 = 0.87;

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
    /// order; where there is a crease, NaN and its number.
    facets: Vec<Vec4>,
    creases: Vec<CreasedCell>,
}

/// The cells of a block, as their corners' values tell them.
#[derive(Default)]
pub(super) struct Sketch {
    /// By cell: whether it has corners inside and outside, and its plane.
    planes: Vec<(bool, Vec4)>,
    /// The cells that are not flat, and by how much.
    rough: Vec<(usize, f32)>,
}

impl Sketch {
    /// From the values at the nodes, x fastest, in cells.
    pub(super) fn fill(&mut self, values: &[f32]) {
        self.planes.clear();
        self.rough.clear();
        for cell in 0..SIDE * SIDE * SIDE {
            let corner = corners(cell);
            let (mut slopes, mut value, mut inside) = (Vec3::ZERO, 0.0, 0);
            let mut most = f32::NEG_INFINITY;
            for (n, node) in corner.into_iter().enumerate() {
                let side = |axis: usize| if n >> axis & 1 == 1 { 0.25 } else { -0.25 };
                slopes += values[node] * Vec3::new(side(0), side(1), side(2));
                value += 0.125 * values[node];
                inside += usize::from(values[node] > 0.0);
                most = most.max(values[node]);
            }
            let is_crossed = inside != 0 && inside != 8;
            self.planes.push((is_crossed, slopes.extend(value - slopes.dot(middle(place(cell))))));
            if is_crossed || inside == 0 && most > -NEAR {
                let off = |(n, node): (usize, usize)| {
                    let side = |axis: usize| if n >> axis & 1 == 1 { 0.5 } else { -0.5 };
                    (value + slopes.dot(Vec3::new(side(0), side(1), side(2))) - values[node]).abs()
                };
                let off = corner.into_iter().enumerate().map(off).fold(0.0, f32::max);
                if off > FLAT {
                    self.rough.push((cell, off));
                }
            }
        }
    }

    /// The nodes that slopes are wanted at.
    pub(super) fn nodes(&self, is_wanted: &mut [bool; NODES * NODES * NODES]) {
        for (cell, _) in &self.rough {
            for node in corners(*cell) {
                is_wanted[node] = true;
            }
        }
    }
}

/// The place of a cell along each axis.
fn place(cell: usize) -> [usize; 3] {
    [cell % SIDE, cell / SIDE % SIDE, cell / (SIDE * SIDE)]
}

/// The nodes at a cell's corners.
fn corners(cell: usize) -> [usize; 8] {
    let [x, y, z] = place(cell);
    let first = (z * NODES + y) * NODES + x;
    [0, 1, 2, 3, 4, 5, 6, 7].map(|n| first + (n & 1) + (n >> 1 & 1) * NODES + (n >> 2) * NODES * NODES)
}

impl Block {
    /// The facets of a block; `slopes` tells value and slopes at a node, by cell.
    pub(super) fn new(sketch: &Sketch, slopes: impl Fn(usize) -> (f32, Vec3)) -> Block {
        let mut block = Block { cells: [0; SIDE], before: [0; SIDE], facets: Vec::new(), creases: Vec::new() };
        let mut rough = sketch.rough.iter().copied().peekable();
        for (cell, &(is_crossed, plane)) in sketch.planes.iter().enumerate() {
            let [x, y, z] = place(cell);
            if x == 0 && y == 0 {
                block.before[z] = block.facets.len() as u16;
            }
            let crease = rough.next_if(|(next, _)| *next == cell).and_then(|(_, off)| {
                let corner = |node: usize| {
                    let at = [node % NODES, node / NODES % NODES, node / (NODES * NODES)].map(|along| along as f32);
                    let (value, slopes) = slopes(node);
                    Corner { at: at.into(), value, slopes }
                };
                let is_vague = is_crossed && off > VAGUE;
                let vague = || is_vague.then(|| CreasedCell::vague(plane));
                CreasedCell::new(&corners(cell).map(corner), off).or_else(vague)
            });
            let facet = match crease {
                Some(crease) if is_crossed || crease.reaches(middle([x, y, z])) => {
                    block.creases.push(crease);
                    Vec4::new(f32::NAN, 0.0, 0.0, (block.creases.len() - 1) as f32)
                }
                _ if is_crossed => plane,
                _ => continue,
            };
            block.cells[z] |= 1 << (x + SIDE * y);
            block.facets.push(facet);
        }
        block
    }

    /// What a facet stands for, if it is a crease.
    #[inline]
    fn crease(&self, facet: Vec4) -> Option<&CreasedCell> {
        if facet.x.is_nan() { self.creases.get(facet.w as usize) } else { None }
    }

    /// The middles of the cells with facets, and these.
    fn facets(&self) -> impl Iterator<Item = (Vec3, Vec4)> {
        let places = (0..SIDE * SIDE * SIDE).filter(|at| self.cells[at / 64] >> (at % 64) & 1 == 1);
        places.map(|at| middle(place(at))).zip(self.facets.iter().copied())
    }

    /// How many cells have more to tell than a plane.
    #[cfg(test)]
    pub(super) fn crease_count(&self) -> usize {
        self.creases.len()
    }

    /// The middle of each cell that is not empty, and where a ray gets inside in it between two
    /// distances.
    #[cfg(test)]
    pub(super) fn meetings(&self) -> impl Iterator<Item = (Vec3, impl Fn(&Ray, Vec3A, f32, f32) -> Meeting)> {
        self.facets().map(move |(middle, facet)| {
            (middle, move |ray: &Ray, corner: Vec3A, t: f32, end: f32| {
                self.meet(facet, (ray.origin - corner).extend(1.0), ray.direction.extend(0.0), t, end)
            })
        })
    }

    #[inline(always)]
    fn meet(&self, facet: Vec4, from: Vec4, direction: Vec4, t: f32, end: f32) -> Meeting {
        match self.crease(facet) {
            None => meet_plane(facet, from, direction, t, end),
            Some(crease) => crease.meet(from, direction, t, end),
        }
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
        let outward = |plane: &Vec4| -plane.truncate().normalize_or_zero();
        let up: Vec3 = self.facets.iter().filter(|facet| !facet.x.is_nan()).map(outward).sum();
        let up = up + self.creases.iter().flat_map(|crease| crease.planes()).map(outward).sum::<Vec3>();
        let up = up.normalize_or_zero();
        if up == Vec3::ZERO {
            return (up, f32::INFINITY);
        }
        let reach = |middle: Vec3, plane: Vec4| {
            let (slopes, value) = (plane.truncate(), plane.dot(middle.extend(1.0)));
            let bound = |share: f32| share * value + 0.5 * (up + share * slopes).abs().element_sum();
            let share = slopes.length_recip();
            if share.is_finite() { bound(share).min(bound(0.0)) } else { bound(0.0) }
        };
        let reach = |(middle, facet): (Vec3, Vec4)| {
            let least = match self.crease(facet) {
                None => reach(middle, facet),
                Some(crease) => crease.bound(|plane| reach(middle, plane)),
            };
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
                match self.meet(self.facets[number], from, direction, t, after) {
                    Meeting::Enters(at) => return Some(at),
                    Meeting::Within if t > BIAS => return Some(t),
                    Meeting::Within | Meeting::None => {}
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
