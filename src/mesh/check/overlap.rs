//! All pairs of triangles that meet where they should not.
//!
//! ```text
//!   level 2   +---------------------------------------+      Triangles are sorted along a
//!   level 1   +---------+---------+---------+---------+      Morton curve; a box of a level
//!   level 0   t t t t   t t t t   t t t t   t t t t          holds four of the level below.
//! ```
//!
//! Each group of four triangles descends from the top to the groups whose boxes overlap its
//! own, at or behind itself. Most of the pairs found that way are neighbours that share a
//! vertex with a flat fan, and done with; most of the others, neighbours or not, are settled by a
//! separating plane in f64; the rest is decided exactly.

use glam::{UVec3, Vec3};

use super::fans::{Fans, repeats};
use super::lists::{mapped, sorted};
use super::meet::{is_degenerate, meet, meet_beyond_edge, meet_beyond_vertex, surely_apart};
use crate::geom::Mesh;
use crate::{Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// How many pairs are listed.
pub(super) const LISTED: usize = 16;

/// Boxes that one of the level above holds.
const GROUP: usize = 4;

/// Groups of triangles that a thread takes at a time.
const CHUNK: usize = 1 << 10;

/// Pairs of triangles that meet where they should not.
#[derive(Default)]
pub(super) struct Overlaps {
    pub count: usize,
    /// The first of them, in order, at most so many.
    pub pairs: Vec<[u32; 2]>,
    most: usize,
    /// Triangles that are left out, as they are degenerate.
    pub degenerate: usize,
}

impl Overlaps {
    pub(super) fn find(mesh: &Mesh, fans: &Fans, most: usize, run: &Run) -> Result<Overlaps, Cancelled> {
        // How long each stage takes, more or less.
        let [to_sort, to_search] = run.stages([0.3, 0.7]);
        let order = along_curve(mesh, &to_sort)?;
        let degenerate = mesh.triangles().len() - order.len();
        let search = Search::new(mesh, fans, order, run)?;
        let groups = search.levels.get(1).map_or(0, Vec::len);
        let meter = Meter::new(&to_search, groups.div_ceil(CHUNK));
        let chunks: Result<Vec<Overlaps>, Cancelled> = jobs::try_in_order(groups.div_ceil(CHUNK), |chunk| {
            meter.step()?;
            let mut found = Overlaps { most, ..Overlaps::default() };
            for group in chunk * CHUNK..groups.min((chunk + 1) * CHUNK) {
                search.group(group, &mut found);
            }
            Ok(found)
        });
        let mut all = Overlaps { degenerate, most, ..Overlaps::default() };
        for found in chunks? {
            all.count += found.count;
            all.pairs.extend(found.pairs);
        }
        all.trim();
        Ok(all)
    }

    fn add(&mut self, a: u32, b: u32) {
        self.count += 1;
        self.pairs.push([a.min(b), a.max(b)]);
        if self.pairs.len() >= 64 * self.most {
            self.trim();
        }
    }

    fn trim(&mut self) {
        self.pairs.sort_unstable();
        self.pairs.truncate(self.most);
    }
}

/// The triangles in the order of a Morton curve through the middles of their boxes; those that
/// are degenerate are left out.
fn along_curve(mesh: &Mesh, run: &Run) -> Result<Vec<u32>, Cancelled> {
    const LEFT_OUT: u128 = u128::MAX;
    // How long each stage takes, more or less.
    let [to_look, to_sort] = run.stages([1.0, 1.0]);
    let bounds = mesh.bounds();
    // 2²¹ steps along the longest side: 63 bits.
    let scale = 2097151.0 / bounds.longest_side().max(f64::MIN_POSITIVE);
    let key = |(i, &t): (usize, &[u32; 3])| {
        if repeats(t) || is_degenerate(mesh.corners(t)) {
            return LEFT_OUT;
        }
        let [a, b, c] = mesh.corners(t);
        let middle = 0.5 * (a.min(b).min(c) + a.max(b).max(c));
        let place = ((middle - bounds.min) * scale).as_uvec3().min(UVec3::splat(2097151));
        let key = spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2;
        u128::from(key) << 32 | i as u128
    };
    let mut keys = vec![0; mesh.triangles().len()];
    let meter = Meter::new(&to_look, keys.len().div_ceil(CHUNK));
    jobs::try_chunks_mut(&mut keys, CHUNK, |chunk, keys| {
        meter.step()?;
        let triangles = mesh.triangles().iter().enumerate().skip(chunk * CHUNK);
        keys.iter_mut().zip(triangles).for_each(|(own, triangle)| *own = key(triangle));
        Ok(())
    })?;
    keys.retain(|&key| key != LEFT_OUT);
    // By the first twelve of the 63 bits, four along each axis.
    let keys = sorted(&keys, |key| (key >> (32 + 51)) as u32, &to_sort)?;
    mapped(&keys, |&key| key as u32, run)
}

/// The bits of a number below 2²¹, each with two zeros before it.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x);
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[derive(Clone, Copy, Default)]
struct Box {
    min: Vec3,
    max: Vec3,
}

impl Box {
    fn union(self, other: Box) -> Box {
        Box { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn overlaps(&self, other: &Box) -> bool {
        // Without branches: which of the six fails is anybody's guess.
        (self.min.x <= other.max.x)
            & (other.min.x <= self.max.x)
            & (self.min.y <= other.max.y)
            & (other.min.y <= self.max.y)
            & (self.min.z <= other.max.z)
            & (other.min.z <= self.max.z)
    }
}

struct Search<'a> {
    mesh: &'a Mesh,
    fans: &'a Fans,
    /// Triangles, in order.
    order: Vec<u32>,
    corners: Vec<[u32; 3]>,
    /// The boxes of the triangles, of groups of them, of groups of those, up to a single one.
    levels: Vec<Vec<Box>>,
}

impl<'a> Search<'a> {
    fn new(mesh: &'a Mesh, fans: &'a Fans, order: Vec<u32>, run: &Run) -> Result<Search<'a>, Cancelled> {
        let corners: Vec<[u32; 3]> = mapped(&order, |&t| mesh.triangles()[t as usize], run)?;
        let positions = mesh.positions();
        let boxes = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| positions[i as usize]);
            Box { min: a.min(b).min(c), max: a.max(b).max(c) }
        };
        let mut levels: Vec<Vec<Box>> = vec![mapped(&corners, boxes, run)?];
        while let Some(below) = levels.last()
            && (below.len() > 1 || levels.len() == 1 && !below.is_empty())
        {
            run.check()?;
            let union = |group: &[Box]| group[1..].iter().fold(group[0], |a, &b| a.union(b));
            levels.push(jobs::in_order(below.len().div_ceil(GROUP), |n| {
                union(&below[n * GROUP..below.len().min((n + 1) * GROUP)])
            }));
        }
        Ok(Search { mesh, fans, order, corners, levels })
    }

    /// Looks at the pairs of a group's triangles with one another and with those of later groups.
    fn group(&self, group: usize, found: &mut Overlaps) {
        let own = self.levels[1][group];
        // (level, place); on every level at most GROUP − 1 wait.
        let mut waiting = [(0u8, 0u32); 64];
        waiting[0] = (self.levels.len() as u8 - 1, 0);
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (level, place) = waiting[count];
            let (level, place) = (usize::from(level), place as usize);
            if level == 1 {
                self.groups(group, place, found);
                continue;
            }
            let below = &self.levels[level - 1];
            // Places below this one hold only earlier groups.
            let first = group >> (2 * (level - 2));
            let children = (GROUP * place).max(first)..below.len().min(GROUP * (place + 1));
            for child in children {
                if below[child].overlaps(&own) {
                    waiting[count] = (level as u8 - 1, child as u32);
                    count += 1;
                }
            }
        }
    }

    fn groups(&self, a: usize, b: usize, found: &mut Overlaps) {
        let boxes = &self.levels[0];
        let range = |group: usize| GROUP * group..boxes.len().min(GROUP * (group + 1));
        for i in range(a) {
            for j in range(b) {
                if i < j && boxes[i].overlaps(&boxes[j]) && self.pair_meets(self.corners[i], self.corners[j]) {
                    found.add(self.order[i], self.order[j]);
                }
            }
        }
    }

    /// Whether two triangles meet in more than the vertices and sides that they share.
    fn pair_meets(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let is_shared = |v: u32| (v == t[0]) | (v == t[1]) | (v == t[2]);
        let shared = s.map(is_shared);
        if shared == [false; 3] {
            let (p, q) = (self.mesh.corners(s), self.mesh.corners(t));
            return !surely_apart(&p, &q) && meet(&p, &q);
        }
        if (0..3).any(|k| shared[k] && self.fans.flat[s[k] as usize]) {
            return false;
        }
        self.neighbours_meet(s, t, shared)
    }

    fn neighbours_meet(&self, s: [u32; 3], t: [u32; 3], shared: [bool; 3]) -> bool {
        let count = shared.iter().filter(|is_shared| **is_shared).count();
        // From the corner that alone is shared, or alone is not.
        let corners = |of: [u32; 3], shared: [bool; 3]| {
            let first = shared.iter().position(|is_shared| *is_shared == (count == 1)).unwrap_or(0);
            let [a, b, c] = self.mesh.corners(of);
            [[a, b, c], [b, c, a], [c, a, b]][first]
        };
        let (own, other) = (corners(s, shared), corners(t, t.map(|v| s.contains(&v))));
        match count {
            1 => meet_beyond_vertex(own[0], [own[1], own[2]], [other[1], other[2]]),
            2 => meet_beyond_edge(own[1], own[2], own[0], other[0]),
            // The same triangle twice.
            _ => true,
        }
    }
}
