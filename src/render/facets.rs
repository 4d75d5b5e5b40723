//! The surface as a small plane in every cell that it crosses: what hides light.
//!
//! ```text
//!      +---+---+-------+      A block is a cube of 8³ cells. Blocks that the surface may cross
//!      | 1 |///| \     |      know which of their cells it crosses, and a plane in each; the
//!      +---+---+  \    |      others know how many blocks away the nearest of these is, and
//!      | 1 | 1 |   \   |      a ray leaps over all that is nearer.
//!      +---+---+-------+
//! ```
//!
//! The plane of a cell is the one nearest to the field's values at its corners. A ray meets a
//! facet where it passes the plane inwards, or enters the cell beyond it. Light that is gathered
//! over many rays asks for no more, and a ray costs some tens of nanoseconds; what is thinner
//! than a cell may cast no shadow. The first hits of a picture's own rays are certain, see
//! [`Scene`](super::Scene).
//!
//! Source: J. Amanatides and A. Woo, *A fast voxel traversal algorithm for ray tracing* (1987),
//! for the way through the cells.

use glam::{DVec3, IVec3, Vec3, Vec4};
use rayon::prelude::*;

use crate::eval::{Evaluator, Program, Tape};
use crate::space::{Grid, surface_blocks};
use crate::{Bounds, Cancelled, Run};

/// Cells along a block.
const SIDE: usize = 8;
/// Samples along a block.
const NODES: usize = SIDE + 1;

/// A surface does not hide from itself what is nearer than this, in cells.
const BIAS: f32 = 2.0;

/// Rays step this far over a border, in cells.
const NUDGE: f32 = 1e-3;

/// Blocks that are made by a thread at once.
const TOGETHER: usize = 64;

/// The facets of a solid.
pub(super) struct Facets {
    /// Of the grid's low corner.
    origin: DVec3,
    /// The side of a cell in length units.
    cell: f64,
    /// Blocks along each axis.
    blocks: IVec3,
    /// By block, x first: [`BLOCK`] and the number of the one with facets, or how many blocks
    /// away the nearest of these is.
    map: Vec<u32>,
    surface: Vec<Block>,
}

/// Marks the numbers of blocks with facets.
const BLOCK: u32 = 1 << 31;

/// A block that the surface may cross.
struct Block {
    /// The cells with facets: a word a layer, a byte a row.
    cells: [u64; SIDE],
    /// How many facets the layers before have.
    before: [u16; SIDE],
    /// The value at the cell's middle and its slopes a cell, in the cells' order.
    facets: Vec<Vec4>,
    /// A unit vector out of the solid, and how far along it from the block's corner, in cells, there is
    /// something beyond a facet: rays that stay above meet none. Infinitely far where the facets face
    /// all ways.
    up: Vec3,
    top: f32,
}

/// What a thread keeps from block to block.
#[derive(Default)]
struct Maker {
    evaluator: Evaluator,
    tape: Option<(Program, Tape)>,
    values: Vec<f32>,
}

impl Facets {
    /// Those of `program` within `bounds`, finite and of some size, at about so many cells along
    /// the longest side.
    pub(super) fn new(program: &Program, bounds: &Bounds, cells: u32, run: &Run) -> Result<Facets, Cancelled> {
        let cell = bounds.longest_side() / f64::from(cells.max(1));
        let side = cell * SIDE as f64;
        // A little off round coordinates, where faces tend to be.
        let origin = bounds.min - 0.37 * cell;
        let blocks = ((bounds.max - origin) / side).floor().as_uvec3() + 1;
        let grid = Grid { origin, side, blocks: blocks.to_array() };
        let found = surface_blocks(program, &grid, 0.0, run)?;
        let node = |along: usize| (along as f64 - 0.5 * SIDE as f64) * cell;
        let place = |n: usize| [n % NODES, n / NODES % NODES, n / (NODES * NODES)].map(|along| node(along) as f32);
        let nodes = [0, 1, 2].map(|axis| (0..NODES * NODES * NODES).map(|n| place(n)[axis]).collect::<Vec<f32>>());
        let make = |maker: &mut Maker, at: usize| {
            let (program, index) = (&found[at].program, found[at].index);
            let next = [0, 1, 2].map(|axis| index[axis] + 1);
            maker.block(program, &grid.bounds(index, next), &nodes)
        };
        let made = found.par_chunks(TOGETHER).enumerate().map(|(chunk, blocks)| {
            run.check()?;
            let mut maker = Maker::default();
            Ok((0..blocks.len()).map(|at| make(&mut maker, chunk * TOGETHER + at)).collect())
        });
        let made: Result<Vec<Vec<Block>>, Cancelled> = made.collect();
        let surface: Vec<Block> = made?.into_iter().flatten().collect();
        let blocks = blocks.as_ivec3();
        let mut facets = Facets { origin, cell, blocks, map: Vec::new(), surface };
        facets.map = vec![BLOCK - 1; blocks.element_product() as usize];
        for (number, block) in (0..).zip(&found) {
            let place = facets.place(IVec3::from_array(block.index.map(|i| i as i32)));
            facets.map[place] = BLOCK | number;
        }
        facets.spread();
        Ok(facets)
    }

    fn place(&self, block: IVec3) -> usize {
        ((block.z * self.blocks.y + block.y) * self.blocks.x + block.x) as usize
    }

    /// Tells every empty block how far the nearest of the others is, by steps to any of its 26
    /// neighbours: along rows, then columns, then piles, as the largest of three distances is.
    fn spread(&mut self) {
        let mut near: Vec<u32> = self.map.iter().map(|&at| if at >= BLOCK { 0 } else { BLOCK - 1 }).collect();
        // The least over a line of max(|i − j|, d(j)).
        let mut line = Vec::new();
        for axis in 0..3 {
            let len = self.blocks[axis] as usize;
            let stride = [1, self.blocks.x, self.blocks.x * self.blocks.y][axis] as usize;
            for start in (0..near.len()).filter(|at| (at / stride).is_multiple_of(len)) {
                line.clear();
                line.extend((0..len).map(|i| near[start + i * stride]));
                for i in 0..len {
                    let mut least = line[i];
                    let mut away = 1;
                    while away < least && (away as usize) < len {
                        let step = away as usize;
                        let one = i.checked_sub(step).map_or(u32::MAX, |j| line[j]);
                        let other = line.get(i + step).copied().unwrap_or(u32::MAX);
                        least = least.min(one.min(other).max(away));
                        away += 1;
                    }
                    near[start + i * stride] = least;
                }
            }
        }
        for (at, near) in self.map.iter_mut().zip(near) {
            if *at < BLOCK {
                *at = near;
            }
        }
    }

    /// How far along the ray its first facet is, in length units; `direction` is a unit vector.
    /// What is within two cells of the origin counts only if the ray passes its plane there.
    pub(super) fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        if !(origin.is_finite() && direction.is_finite()) {
            return None;
        }
        let top = (self.blocks * SIDE as i32).as_dvec3();
        let from = (origin - self.origin) / self.cell;
        let inverse = direction.recip();
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            if direction[axis] == 0.0 {
                if !(from[axis] >= 0.0 && from[axis] < top[axis]) {
                    return None;
                }
                continue;
            }
            let (a, b) = (-from[axis] * inverse[axis], (top[axis] - from[axis]) * inverse[axis]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        if near >= far {
            return None;
        }
        let ray = Walk {
            origin: (from + near * direction).as_vec3(),
            direction: direction.as_vec3(),
            // A ray along a plane never reaches the next one.
            inverse: inverse.as_vec3().clamp(Vec3::splat(-1e30), Vec3::splat(1e30)),
            // What is met at the grid's border is as far from the ray's start as that.
            bias: BIAS - near as f32,
        };
        self.walk(&ray, (far - near) as f32).map(|t| (near + f64::from(t)) * self.cell)
    }

    fn walk(&self, ray: &Walk, far: f32) -> Option<f32> {
        let mut t = 0.0f32;
        while t < far {
            let p = ray.at(t);
            let block = (p * (1.0 / SIDE as f32)).as_ivec3().clamp(IVec3::ZERO, self.blocks - 1);
            let kind = self.map[self.place(block)];
            let reach = if kind >= BLOCK { 0 } else { kind as i32 - 1 };
            let corner = |block: IVec3| (block * SIDE as i32).as_vec3();
            let end = ray.leaves(corner(block - reach), corner(block + reach + 1));
            if kind >= BLOCK
                && let Some(hit) = self.surface[(kind - BLOCK) as usize].walk(ray, corner(block), t, end)
            {
                return Some(hit);
            }
            t = end.max(t) + NUDGE;
        }
        None
    }
}

/// A ray in cells from the grid's corner.
struct Walk {
    origin: Vec3,
    direction: Vec3,
    inverse: Vec3,
    bias: f32,
}

impl Walk {
    #[inline(always)]
    fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }

    /// Where it leaves a box that it is in.
    #[inline(always)]
    fn leaves(&self, low: Vec3, high: Vec3) -> f32 {
        let ends = ((low - self.origin) * self.inverse).max((high - self.origin) * self.inverse);
        ends.min_element()
    }
}

impl Block {
    /// The first facet on a ray that is in this block, whose corner is at `corner`, from `t` to `end`.
    fn walk(&self, ray: &Walk, corner: Vec3, mut t: f32, mut end: f32) -> Option<f32> {
        // Where it is not yet, or no longer, above all facets.
        let rises = self.up.dot(ray.direction);
        let over = self.up.dot(ray.origin - corner) - self.top;
        if rises > 0.0 {
            end = end.min(-over / rises);
        } else if rises < 0.0 {
            t = t.max(-over / rises);
        }
        if t > end {
            return None;
        }
        let last = IVec3::splat(SIDE as i32 - 1);
        let mut cell = (ray.at(t) - corner).as_ivec3().clamp(IVec3::ZERO, last);
        let step = ray.direction.signum().as_ivec3();
        let ahead = corner + (cell + step.max(IVec3::ZERO)).as_vec3();
        let mut next = (ahead - ray.origin) * ray.inverse;
        let delta = ray.inverse.abs();
        loop {
            let axis = if next.x < next.y {
                if next.x < next.z { 0 } else { 2 }
            } else if next.y < next.z {
                1
            } else {
                2
            };
            let after = next[axis];
            let bit = cell.x + SIDE as i32 * cell.y;
            let word = self.cells[cell.z as usize];
            if word >> bit & 1 == 1 {
                let number =
                    usize::from(self.before[cell.z as usize]) + (word & ((1 << bit) - 1)).count_ones() as usize;
                let facet = self.facets[number];
                let middle = corner + cell.as_vec3() + 0.5;
                let value = |t: f32| facet.x + Vec3::new(facet.y, facet.z, facet.w).dot(ray.at(t) - middle);
                let (enters, leaves) = (value(t), value(after));
                if enters > 0.0 {
                    if t > ray.bias {
                        return Some(t);
                    }
                } else if leaves > 0.0 {
                    return Some(t + (after - t) * (enters / (enters - leaves)));
                }
            }
            cell[axis] += step[axis];
            if cell[axis] < 0 || cell[axis] > last[axis] {
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

impl Maker {
    fn block(&mut self, program: &Program, bounds: &Bounds, nodes: &[Vec<f32>; 3]) -> Block {
        let tape = match &mut self.tape {
            Some((last, tape)) if last.is_same(program) => {
                tape.recentre(bounds.center());
                tape
            }
            kept => &mut kept.insert((program.clone(), Tape::new(program, bounds))).1,
        };
        self.values.resize(nodes[0].len(), 0.0);
        self.evaluator.values(tape, &nodes[0], &nodes[1], &nodes[2], &mut self.values);
        Block::new(&self.values)
    }
}

impl Block {
    /// The facets of a block from the values at its nodes, x fastest.
    fn new(values: &[f32]) -> Block {
        let mut block =
            Block { cells: [0; SIDE], before: [0; SIDE], facets: Vec::new(), up: Vec3::ZERO, top: f32::INFINITY };
        let mut middles = Vec::new();
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
                    let mut facet = Vec4::ZERO;
                    for n in 0..8 {
                        let side = |axis: usize| if n >> axis & 1 == 1 { 0.25 } else { -0.25 };
                        facet += corner(n) * Vec4::new(0.125, side(0), side(1), side(2));
                    }
                    block.cells[z] |= 1 << (x + SIDE * y);
                    block.facets.push(facet);
                    middles.push(Vec3::new(x as f32, y as f32, z as f32) + 0.5);
                }
            }
        }
        block.top_off(&middles);
        block
    }

    /// Finds what is above all facets.
    ///
    /// What is beyond the facet `v + g·q ≥ 0` of a cell, |qᵢ| ≤ ½ from its middle, is no further along a
    /// unit vector `u` than, for any λ ≥ 0,
    ///
    /// ```text
    ///   u·q ≤ u·q + λ (v + g·q) ≤ λ v + ½ |u + λ g|₁
    /// ```
    ///
    /// which is the plane itself where λ = 1/|g| and g is along −u.
    fn top_off(&mut self, middles: &[Vec3]) {
        let slopes = |facet: &Vec4| Vec3::new(facet.y, facet.z, facet.w);
        let up = -self.facets.iter().map(|facet| slopes(facet).normalize_or_zero()).sum::<Vec3>();
        let up = up.normalize_or_zero();
        if up == Vec3::ZERO {
            return;
        }
        let reach = |(facet, middle): (&Vec4, &Vec3)| {
            let bound = |share: f32| share * facet.x + 0.5 * (up + share * slopes(facet)).abs().element_sum();
            let share = slopes(facet).length_recip();
            let least = if share.is_finite() { bound(share).min(bound(0.0)) } else { bound(0.0) };
            up.dot(*middle) + least
        };
        let top = self.facets.iter().zip(middles).map(reach).fold(f32::NEG_INFINITY, f32::max);
        (self.up, self.top) = (up, top + NUDGE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;

    fn facets(solid: &Solid, cells: u32) -> Facets {
        let program = solid.surface_program().unwrap();
        Facets::new(&program, &solid.bounds().unwrap(), cells, &Run::default()).unwrap()
    }

    #[test]
    fn rays_meet_the_facets_where_they_meet_the_solid() {
        let solid = (Solid::cuboid(DVec3::new(2.0, 1.4, 1.0)).rotate_x(0.4) - Solid::sphere(0.5)) | Solid::sphere(0.3);
        let facets = facets(&solid, 100);
        let mut hits = 0;
        for i in 1..3000 {
            let at = |step: f64| (0.5 + step * f64::from(i)).fract() * 2.0 - 1.0;
            let origin = 3.0 * DVec3::new(at(0.819), at(0.671), at(0.549)).normalize();
            let direction = (DVec3::new(at(0.357), at(0.211), at(0.733)) - origin).normalize();
            let found = facets.hit(origin, direction);
            match solid.raycast(origin, direction).unwrap() {
                None => {
                    // A ray close by may touch a facet.
                    let near = (0..300).map(|k| origin + 0.02 * f64::from(k) * direction);
                    let grazes = near.map(|p| solid.value(p).unwrap()).any(|v| v > -0.04);
                    assert!(found.is_none() || grazes, "{i}: {found:?}");
                }
                Some(hit) => {
                    // A ray may cut an edge within a cell.
                    let deep = solid.value(hit.point + 0.1 * direction).unwrap() > 0.03;
                    if deep && hit.normal.dot(direction).abs() > 0.3 {
                        hits += 1;
                        let found = found.unwrap_or_else(|| panic!("{i}: {hit:?}"));
                        assert!((found - hit.distance).abs() < 0.06, "{i}: {found} for {hit:?}");
                    }
                }
            }
        }
        assert!(hits > 1000, "{hits}");
        assert_eq!(facets.hit(DVec3::ZERO, DVec3::NAN), None);
    }

    #[test]
    fn a_convex_solid_does_not_hide_from_itself() {
        let ball = Solid::sphere(1.0);
        let facets = facets(&ball, 64);
        for i in 1..2000 {
            let at = |step: f64| (0.5 + step * f64::from(i)).fract() * 2.0 - 1.0;
            let normal = DVec3::new(at(0.819), at(0.671), at(0.549)).normalize();
            let (t, _) = normal.any_orthonormal_pair();
            let direction = (0.03 * normal + t).normalize();
            assert!(facets.hit(normal * (1.0 + 1e-7), direction).is_none(), "{normal}");
            assert!(facets.hit(normal * (1.0 + 1e-7), -direction).is_none() || direction.dot(normal) > 0.0);
        }
    }

    #[test]
    fn empty_blocks_know_the_nearest_of_the_others() {
        let solid = Solid::sphere(0.2) | Solid::sphere(0.2).translate(DVec3::new(3.0, 1.0, 0.5));
        let facets = facets(&solid, 128);
        let all: Vec<IVec3> = (0..facets.map.len() as i32)
            .map(|n| {
                IVec3::new(
                    n % facets.blocks.x,
                    n / facets.blocks.x % facets.blocks.y,
                    n / (facets.blocks.x * facets.blocks.y),
                )
            })
            .collect();
        let full: Vec<IVec3> = all.iter().copied().filter(|&at| facets.map[facets.place(at)] >= BLOCK).collect();
        for at in all {
            let near = full.iter().map(|&other| (other - at).abs().max_element()).min().unwrap();
            let known = facets.map[facets.place(at)];
            assert!(if near == 0 { known >= BLOCK } else { known == near as u32 }, "{at}: {known} for {near}");
        }
    }
}
