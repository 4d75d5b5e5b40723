//! The surface as a small plane in every cell that it crosses: what hides light.
//!
//! ```text
//!      +---+---+-------+      A block is a cube of 8³ cells. Blocks that the surface may cross
//!      |   |///| \     |      know which of their cells it crosses, and a plane in each (see
//!      +---+---+  \    |      `facet_block`); what is between them, a ray skips (see
//!      |   |   |   \   |      `empty_space`).
//!      +---+---+-------+
//! ```
//!
//! The plane of a cell is the one nearest to the field's values at its corners; a cell that a
//! crease passes has a plane for each face (see `facet_crease`). A ray meets a facet where it
//! passes the plane inwards, or enters the cell beyond it. Light that is gathered over many rays
//! asks for no more, and a ray costs some tens of nanoseconds; what is thinner than a cell may cast
//! no shadow. The first hits of a picture's own rays are certain, see [`Scene`](super::Scene).
//!
//! Source: J. Amanatides and A. Woo, *A fast voxel traversal algorithm for ray tracing* (1987),
//! for the way through the cells.

use glam::{DVec3, IVec3, Vec3, Vec3A, Vec4};

use super::empty_space::EmptySpace;
use super::facet_block::{Block, NODES, Ray, SIDE, Sketch};
use crate::eval::{Evaluator, Gradients, Program, Tape};
use crate::space::{Grid, SurfaceBlocks, surface_blocks};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// Rays step this far over a border, in cells.
const NUDGE: f32 = 1e-3;

/// Further than this from a ray's origin, in cells, single precision cannot tell a nudge.
const FARTHEST: f32 = 8192.0;

/// Components of directions are at least this, so that their inverses are finite.
const LEAST: f32 = 1e-20;

/// Blocks that are made by a thread at once.
const TOGETHER: usize = 64;

/// The facets of a solid.
pub(super) struct Facets {
    /// Of the grid's low corner.
    origin: DVec3,
    /// The side of a cell in length units.
    cell: f64,
    /// By block, x first: the number of the one with facets.
    numbers: Vec<u32>,
    skips: EmptySpace,
    surface: Vec<Block>,
    tops: Vec<Top>,
    /// The far corner of the grid in cells, the last block, and what makes a block's place of it.
    top: Vec3A,
    last: Vec3A,
    strides: Vec3A,
}

/// What is above all facets of a block, along a unit vector from the grid's corner, in cells.
struct Top {
    up: Vec3A,
    height: f32,
}

/// The corners of a cell that the surface is in are no farther from it than this, in cells.
const BESIDE: f64 = 1.75;

/// What a thread keeps from block to block.
#[derive(Default)]
struct Maker {
    evaluator: Evaluator,
    tape: Option<(Program, Tape)>,
    values: Vec<f32>,
    sketch: Sketch,
    /// The nodes whose slopes are wanted, where they are, and their values and slopes.
    wanted: Vec<usize>,
    slopes: [Vec<f32>; 7],
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
        let [to_find, to_make] = run.stages([0.3, 0.7]);
        let SurfaceBlocks { blocks: found, programs, .. } = surface_blocks(program, &grid, 0.0, &to_find)?;
        let node = |along: usize| (along as f64 - 0.5 * SIDE as f64) * cell;
        let place = |n: usize| [n % NODES, n / NODES % NODES, n / (NODES * NODES)].map(|along| node(along) as f32);
        let nodes = [0, 1, 2].map(|axis| (0..NODES * NODES * NODES).map(|n| place(n)[axis]).collect::<Vec<f32>>());
        let make = |maker: &mut Maker, at: usize| {
            let (program, index) = (&programs[found[at].program as usize], found[at].index);
            let next = [0, 1, 2].map(|axis| index[axis] + 1);
            maker.block(program, &grid.bounds(index, next), cell, &nodes)
        };
        let meter = Meter::new(&to_make, found.len());
        let made = jobs::try_chunks(&found, TOGETHER, |chunk, blocks| {
            meter.check()?;
            let mut maker = Maker::default();
            let made: Vec<Block> = (0..blocks.len()).map(|at| make(&mut maker, chunk * TOGETHER + at)).collect();
            meter.add(blocks.len() as u64);
            Ok(made)
        });
        let surface: Vec<Block> = made?.into_iter().flatten().collect();
        let blocks = blocks.as_ivec3();
        let tops = jobs::in_order(found.len(), |at| {
            let corner = IVec3::from_array(found[at].index.map(|i| i as i32 * SIDE as i32)).as_vec3();
            let (up, height) = surface[at].top();
            Top { up: up.into(), height: height + up.dot(corner) }
        });
        let mut numbers = vec![u32::MAX; blocks.element_product() as usize];
        for (number, block) in (0..).zip(&found) {
            let [x, y, z] = block.index.map(|i| i as i32);
            numbers[((z * blocks.y + y) * blocks.x + x) as usize] = number;
        }
        let full: Vec<bool> = numbers.iter().map(|number| *number != u32::MAX).collect();
        Ok(Facets {
            origin,
            cell,
            numbers,
            skips: EmptySpace::new(blocks, &full),
            tops,
            surface,
            top: (blocks * SIDE as i32).as_vec3a(),
            last: (blocks - 1).as_vec3a(),
            strides: IVec3::new(1, blocks.x, blocks.x * blocks.y).as_vec3a(),
        })
    }

    /// How far along each of four rays the first facet is, in length units; infinite where there is
    /// none. They start at `origin`; `directions` are the components of unit vectors, a lane a ray,
    /// and `asked` has a bit for each ray that is wanted. What is within two cells of the origin
    /// counts only if the ray passes its plane there.
    pub(super) fn hits(&self, origin: DVec3, directions: &[Vec4; 3], asked: u32) -> [f64; 4] {
        let mut hits = [f64::INFINITY; 4];
        let origin = ((origin - self.origin) / self.cell).as_vec3();
        if asked == 0 || !origin.is_finite() {
            return hits;
        }
        let turned = |d: Vec4| d.abs().max(Vec4::splat(LEAST)).copysign(d);
        let (x, y, z) = (turned(directions[0]), turned(directions[1]), turned(directions[2]));
        let (over_x, over_y, over_z) = (x.recip(), y.recip(), z.recip());
        let (mut near, mut far) = (Vec4::ZERO, Vec4::splat(FARTHEST));
        for (origin, top, inverse) in
            [(origin.x, self.top.x, over_x), (origin.y, self.top.y, over_y), (origin.z, self.top.z, over_z)]
        {
            let (a, b) = (-origin * inverse, (top - origin) * inverse);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        let inverses = [over_x, over_y, over_z];
        let rays = Rays { origin, directions: [x, y, z], inverses };
        self.walk(&rays, near, far, asked, &mut hits);
        hits
    }

    /// Fills in the first facets on those rays, among the ones asked for, that are in the grid
    /// between `near` and `far`.
    fn walk(&self, rays: &Rays, near: Vec4, far: Vec4, asked: u32, hits: &mut [f64; 4]) {
        let Rays { origin, directions: [x, y, z], inverses: [over_x, over_y, over_z], .. } = rays;
        let side = SIDE as f32;
        let part = 1.0 / side;
        let (sign_x, sign_y, sign_z) = (Vec4::ONE.copysign(*x), Vec4::ONE.copysign(*y), Vec4::ONE.copysign(*z));
        // Cubes reach from a block's low corner upwards, or from its high corner downwards.
        let (out_x, out_y, out_z) =
            (0.5 * side * (1.0 - sign_x), 0.5 * side * (1.0 - sign_y), 0.5 * side * (1.0 - sign_z));
        let ways = sign_x.max(Vec4::ZERO) + 2.0 * sign_y.max(Vec4::ZERO) + 4.0 * sign_z.max(Vec4::ZERO);
        let ways = ways * self.skips.count() as f32;
        let mut t = near;
        let mut under_way = near.cmplt(far).bitmask() & asked;
        while under_way != 0 {
            let block_x = whole((origin.x + t * x) * part).clamp(Vec4::ZERO, Vec4::splat(self.last.x));
            let block_y = whole((origin.y + t * y) * part).clamp(Vec4::ZERO, Vec4::splat(self.last.y));
            let block_z = whole((origin.z + t * z) * part).clamp(Vec4::ZERO, Vec4::splat(self.last.z));
            // Exact: there are less than 2²⁰ blocks.
            let place = block_x + block_y * self.strides.y + block_z * self.strides.z;
            // Loops, as calls of closures on arrays are not inlined.
            let (mut empty, mut cubes) = ([false; 4], [0.0; 4]);
            for (lane, at) in (place + ways).to_array().into_iter().enumerate() {
                let leap = self.skips.side(at as i32 as usize);
                empty[lane] = leap > 0;
                cubes[lane] = f32::from(leap.max(1));
            }
            // The sides of the cube of blocks that the ray leaves by.
            let across = side * Vec4::from_array(cubes);
            let end_x = (block_x * side + out_x + across * sign_x - origin.x) * over_x;
            let end_y = (block_y * side + out_y + across * sign_y - origin.y) * over_y;
            let end_z = (block_z * side + out_z + across * sign_z - origin.z) * over_z;
            let end = end_x.min(end_y).min(end_z);
            for lane in 0..4 {
                if !empty[lane] && under_way >> lane & 1 == 1 {
                    let corner = side * Vec3A::new(block_x[lane], block_y[lane], block_z[lane]);
                    let number = self.numbers[place[lane] as i32 as usize] as usize;
                    if let Some(hit) = self.block(number, &rays.ray(lane), corner, t[lane], end[lane]) {
                        hits[lane] = f64::from(hit) * self.cell;
                        under_way &= !(1 << lane);
                    }
                }
            }
            t = end.max(t) + NUDGE;
            under_way &= t.cmplt(far).bitmask();
        }
    }

    /// The first facet of a block on a ray that is in it from `t` to `end`.
    #[inline]
    fn block(&self, number: usize, ray: &Ray, corner: Vec3A, mut t: f32, mut end: f32) -> Option<f32> {
        let Top { up, height } = self.tops[number];
        // How high it is above all facets, and how fast it rises.
        let rises = up.dot(ray.direction);
        let over = up.dot(ray.origin) - height;
        if over + t * rises > 0.0 {
            if rises >= 0.0 {
                return None;
            }
            t = -over / rises;
        } else if rises > 0.0 {
            end = end.min(-over / rises);
        }
        if t <= end { self.surface[number].walk(ray, corner, t, end) } else { None }
    }
}

/// Four rays, in cells: a lane each.
struct Rays {
    origin: Vec3,
    directions: [Vec4; 3],
    inverses: [Vec4; 3],
}

impl Rays {
    #[inline]
    fn ray(&self, lane: usize) -> Ray {
        let [x, y, z] = &self.directions;
        let direction = Vec3A::new(x[lane], y[lane], z[lane]);
        let [x, y, z] = &self.inverses;
        let inverse = Vec3A::new(x[lane], y[lane], z[lane]);
        Ray { origin: self.origin.into(), direction, inverse, signs: Vec3A::ONE.copysign(direction) }
    }
}

/// The whole numbers below these, to which rounding to even is close enough where they are whole,
/// and 0 or less of what is below 1.
#[inline(always)]
fn whole(v: Vec4) -> Vec4 {
    // From 2²³ on, single precision has no fractions.
    const WHOLE: f32 = 8_388_608.0;
    (v + (WHOLE - 0.5)) - WHOLE
}

impl Maker {
    fn block(&mut self, program: &Program, bounds: &Bounds, cell: f64, nodes: &[Vec<f32>; 3]) -> Block {
        let tape = match &mut self.tape {
            Some((last, tape)) if last.is_same(program) => {
                tape.recentre(bounds.center());
                tape
            }
            kept => &mut kept.insert((program.clone(), Tape::new(program, bounds))).1,
        };
        self.values.resize(nodes[0].len(), 0.0);
        self.evaluator.values_within(tape, BESIDE * cell, [&nodes[0], &nodes[1], &nodes[2]], &mut self.values);
        let by_cell = 1.0 / cell as f32;
        self.values.iter_mut().for_each(|value| *value *= by_cell);
        self.sketch.fill(&self.values);
        let mut is_wanted = [false; NODES * NODES * NODES];
        self.sketch.nodes(&mut is_wanted);
        self.wanted.clear();
        self.wanted.extend((0..is_wanted.len()).filter(|node| is_wanted[*node]));
        // The wanted nodes, and value and slopes there.
        let count = self.wanted.len();
        let [x, y, z, value, dx, dy, dz] = &mut self.slopes;
        for (axis, list) in [&mut *x, &mut *y, &mut *z].into_iter().enumerate() {
            list.clear();
            list.extend(self.wanted.iter().map(|node| nodes[axis][*node]));
        }
        for list in [&mut *value, &mut *dx, &mut *dy, &mut *dz] {
            list.resize(count, 0.0);
        }
        let out = Gradients { value, dx, dy, dz };
        self.evaluator.shortest_gradients(tape, [&x[..], &y[..], &z[..]], out);
        let [_, _, _, value, dx, dy, dz] = &self.slopes;
        Block::new(&self.sketch, |node| {
            let at = self.wanted.binary_search(&node).unwrap_or_default();
            (value[at] * by_cell, Vec3::new(dx[at], dy[at], dz[at]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::facet_crease::Meeting;
    use super::*;
    use crate::{Solid, rad};

    fn facets(solid: &Solid, cells: u32) -> Facets {
        let program = solid.surface_program().unwrap();
        Facets::new(&program, &solid.bounds().unwrap(), cells, &Run::default()).unwrap()
    }

    /// Infinite if there is none.
    fn hit(facets: &Facets, origin: DVec3, direction: DVec3) -> f64 {
        let lanes = direction.as_vec3().to_array().map(|d| Vec4::new(0.0, d, 1.0, -d));
        facets.hits(origin, &lanes, 2)[1]
    }

    #[test]
    fn rays_meet_the_facets_where_they_meet_the_solid() {
        let solid =
            (Solid::cuboid(DVec3::new(2.0, 1.4, 1.0)).rotate_x(rad(0.4)) - Solid::sphere(0.5)) | Solid::sphere(0.3);
        let facets = facets(&solid, 100);
        let mut hits = 0;
        for i in 1..3000 {
            let at = |step: f64| (0.5 + step * f64::from(i)).fract() * 2.0 - 1.0;
            // All parts are 0 once in a thousand.
            let origin = 3.0 * DVec3::new(at(0.819), at(0.671), at(0.549)).normalize_or(DVec3::X);
            let direction = (DVec3::new(at(0.357), at(0.211), at(0.733)) - origin).normalize_or(DVec3::X);
            let found = hit(&facets, origin, direction);
            match solid.raycast(origin, direction).unwrap() {
                None => {
                    // A ray close by may touch a facet.
                    let near = (0..300).map(|k| origin + 0.02 * f64::from(k) * direction);
                    let grazes = near.map(|p| solid.value(p).unwrap()).any(|v| v > -0.04);
                    assert!(found == f64::INFINITY || grazes, "{i}: {found:?}");
                }
                Some(hit) => {
                    // A ray may cut an edge within a cell.
                    let deep = solid.value(hit.point + 0.1 * direction).unwrap() > 0.03;
                    if deep && hit.normal.dot(direction).abs() > 0.3 {
                        hits += 1;
                        assert!((found - hit.distance).abs() < 0.06, "{i}: {found} for {hit:?}");
                    }
                }
            }
        }
        assert!(hits > 1000, "{hits}");
        assert_eq!(hit(&facets, DVec3::NAN, DVec3::X), f64::INFINITY);
        hit(&facets, DVec3::ZERO, DVec3::NAN);
        hit(&facets, DVec3::splat(3.0), DVec3::ZERO);
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
            assert!(hit(&facets, normal * (1.0 + 1e-7), direction) == f64::INFINITY, "{normal}");
            let inwards = hit(&facets, normal * (1.0 + 1e-7), -direction);
            assert!(inwards == f64::INFINITY || direction.dot(normal) > 0.0);
        }
    }

    /// A ray meets what it meets if every facet of the grid is looked at.
    #[test]
    fn nothing_is_leapt_over() {
        let solid =
            Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7) - Solid::cylinder(0.3, 3.0).rotate_x(rad(0.4));
        let solid = solid | Solid::torus(1.2, 0.08);
        let facets = facets(&solid, 90);
        let cells: Vec<_> = (0..facets.numbers.len())
            .filter(|at| facets.numbers[*at] != u32::MAX)
            .flat_map(|at| {
                let size = facets.last.as_ivec3() + 1;
                let at = IVec3::new(at as i32 % size.x, at as i32 / size.x % size.y, at as i32 / (size.x * size.y));
                let block = &facets.surface[facets.numbers[((at.z * size.y + at.y) * size.x + at.x) as usize] as usize];
                let corner = at * SIDE as i32;
                block.meetings().map(move |(middle, meet)| (corner, middle, meet))
            })
            .collect();
        let first = |origin: DVec3, direction: DVec3| {
            let mut least = f64::INFINITY;
            let (inverse, signs) = (direction.recip().as_vec3a(), direction.signum().as_vec3a());
            let ray = Ray { origin: origin.as_vec3a(), direction: direction.as_vec3a(), inverse, signs };
            for (corner, middle, meet) in &cells {
                let middle = corner.as_dvec3() + middle.as_dvec3();
                let (a, b) = ((middle - 0.5 - origin) / direction, (middle + 0.5 - origin) / direction);
                let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
                if near >= far {
                    continue;
                }
                match meet(&ray, corner.as_vec3a(), near as f32, far as f32) {
                    Meeting::Enters(t) => least = least.min(f64::from(t)),
                    Meeting::Within if near > 2.0 => least = least.min(near),
                    Meeting::Within | Meeting::None => {}
                }
            }
            least
        };
        let (mut met, mut missed, mut off) = (0, 0, 0);
        for i in 1..4000 {
            let at = |step: f64| (0.5 + step * f64::from(i)).fract() * 2.0 - 1.0;
            let direction = DVec3::new(at(0.357), at(0.211), at(0.733)).normalize_or(DVec3::X);
            // From the surface, and from anywhere.
            let start = 1.5 * DVec3::new(at(0.819), at(0.671), at(0.549));
            let origin = match solid.raycast(start, -start.normalize_or(DVec3::X)).unwrap() {
                Some(hit) if i % 2 == 0 => hit.point + 1e-7 * hit.normal,
                _ => start,
            };
            let expected = first((origin - facets.origin) / facets.cell, direction) * facets.cell;
            let found = hit(&facets, origin, direction);
            // Rays through the edges of cells may see either of two facets.
            off += usize::from(found.is_finite() != expected.is_finite() || (found - expected).abs() > 0.02);
            *(if found.is_finite() { &mut met } else { &mut missed }) += 1;
        }
        assert!(met > 500 && missed > 500 && off < 8, "{met} {missed} {off}");
    }

    /// How many points of a solid have a ray that meets something near which is not there, and of
    /// how many.
    fn specks(solid: &Solid, cells: u32) -> (usize, usize) {
        let facets = facets(solid, cells);
        let size = 0.5 * solid.bounds().unwrap().longest_side();
        let (mut wrong, mut count) = (0, 0);
        for i in 1..4000 {
            let at = |step: f64| (0.5 + step * f64::from(i)).fract() * 2.0 - 1.0;
            let start = DVec3::new(at(0.819_173), at(0.671_043), 0.7 * at(0.549_700)).normalize_or(DVec3::X);
            let aim = DVec3::new(at(0.357_403), at(0.211_324), at(0.733_019)) * 0.7;
            let way = (aim - 3.0 * start).normalize_or(DVec3::X);
            let Some(seen) = solid.raycast(3.0 * size * start, way).unwrap() else { continue };
            let normal = seen.normal.normalize_or_zero();
            if normal == DVec3::ZERO {
                continue;
            }
            count += 1;
            let from = seen.point + 2e-7 * size * normal;
            let (t, b) = normal.any_orthonormal_pair();
            let is_wrong = |k: u32| {
                let around = glam::DVec2::from_angle(2.4 * f64::from(k)) * (f64::from(k) / 16.0 + 0.03).sqrt();
                let up = (1.0 - around.length_squared()).max(0.0).sqrt().max(0.02);
                let direction = (around.x * t + around.y * b + up * normal).normalize();
                let found = hit(&facets, from, direction);
                let exact = || solid.raycast(from, direction).unwrap().map_or(f64::INFINITY, |hit| hit.distance);
                found < 2.0 * facets.cell && exact() > found + 4.0 * facets.cell
            };
            wrong += usize::from((0..16).any(is_wrong));
        }
        (wrong, count)
    }

    #[test]
    fn blades_do_not_hide_from_themselves() {
        let g = crate::Gielis::new;
        let blades = Solid::from(crate::Supershape::new(g(5.0, 0.3, 0.3, 0.3), g(4.0, 2.0, 2.0, 2.0)));
        let (wrong, count) = specks(&blades, 200);
        assert!(count > 500 && wrong < count / 400, "{wrong} of {count}");
        // Where a plane tells where the surface is, there is nothing else.
        let ball = facets(&Solid::sphere(1.0), 12);
        assert!(ball.surface.iter().all(|block| block.crease_count() == 0));
    }
}
