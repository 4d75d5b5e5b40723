//! Points that hypotheses are made from, two at a time: near each other, or of one smooth part of a
//! mesh.

use glam::DVec3;
use rvachev_num::order;

use super::corners::Corner;
use super::samples::{Kind, Samples};
use crate::fit::random::Random;

/// Sides of the cells that partners are in, in diagonals.
const CELLS: [f64; 3] = [0.03, 0.07, 0.16];

/// Attempts at a partner.
const TRIES: usize = 6;

/// A point with its normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seed {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
    /// The angle between facets there, in radians; 0 of samples.
    pub(super) step: f64,
    part: u32,
}

/// Seeds, and who is near whom.
pub(super) struct Seeds {
    pub(super) all: Vec<Seed>,
    /// Whether they are on the surface and their normals are exact.
    pub(super) exact: bool,
    cells: Vec<Cells>,
    /// Seeds in the order of their parts, and where each seed's part is there.
    by_part: Vec<u32>,
    parts: Vec<[u32; 2]>,
}

impl Seeds {
    /// Those of the curved surfaces of a mesh, without those that are taken.
    pub(super) fn of_corners(samples: &Samples, taken: &[bool]) -> Seeds {
        let of = |c: &Corner| Seed { point: c.point, normal: c.normal, step: c.step, part: c.part };
        let left = samples.corners.iter().zip(taken).filter(|(_, taken)| !**taken);
        Seeds::new(left.map(|(c, _)| of(c)).collect(), samples.kind == Kind::Cad)
    }

    /// Samples, without those that are taken.
    pub(super) fn of_samples(samples: &Samples, taken: &[bool]) -> Seeds {
        let of = |i: usize| Seed { point: samples.points[i], normal: samples.normals[i], step: 0.0, part: 0 };
        Seeds::new((0..samples.len()).filter(|i| !taken[*i]).map(of).collect(), false)
    }

    fn new(all: Vec<Seed>, exact: bool) -> Seeds {
        let cells = CELLS.map(|side| Cells::new(&all, side)).into();
        let mut by_part: Vec<u32> = (0..all.len() as u32).collect();
        order::rising(&mut by_part, |i| f64::from(all[*i as usize].part));
        let mut parts = vec![[0; 2]; all.len()];
        let mut from = 0;
        while from < by_part.len() {
            let part = all[by_part[from] as usize].part;
            let to = from + by_part[from..].iter().take_while(|i| all[**i as usize].part == part).count();
            for &i in &by_part[from..to] {
                parts[i as usize] = [from as u32, to as u32];
            }
            from = to;
        }
        Seeds { all, exact, cells, by_part, parts }
    }

    /// Two seeds, if a partner is found for one chosen at random.
    pub(super) fn pair(&self, random: &mut Random) -> Option<[Seed; 2]> {
        if self.all.len() < 2 {
            return None;
        }
        let i = random.below(self.all.len());
        let j = if self.exact && random.below(2) == 0 {
            let [from, to] = self.parts[i];
            self.by_part[from as usize + random.below((to - from) as usize)] as usize
        } else {
            self.cells[random.below(self.cells.len())].near(self.all[i].point, random)?
        };
        (i != j).then(|| [self.all[i], self.all[j]])
    }
}

/// Points sorted by cubic cells.
struct Cells {
    side: f64,
    count: usize,
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl Cells {
    fn new(seeds: &[Seed], side: f64) -> Cells {
        // Points are within half a diagonal of the centre.
        let count = (1.0 / side).ceil() as usize + 1;
        let mut cells = Cells { side, count, starts: vec![0; count * count * count + 1], order: vec![0; seeds.len()] };
        let homes: Vec<usize> = seeds.iter().map(|s| cells.index(cells.home(s.point))).collect();
        for &home in &homes {
            cells.starts[home + 1] += 1;
        }
        for i in 1..cells.starts.len() {
            cells.starts[i] += cells.starts[i - 1];
        }
        let mut next = cells.starts.clone();
        for (i, &home) in (0u32..).zip(&homes) {
            cells.order[next[home] as usize] = i;
            next[home] += 1;
        }
        cells
    }

    fn home(&self, p: DVec3) -> [usize; 3] {
        ((p + 0.5) / self.side).to_array().map(|x| (x.max(0.0) as usize).min(self.count - 1))
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.count + y) * self.count + x
    }

    /// One of the points in the cells about a point.
    fn near(&self, p: DVec3, random: &mut Random) -> Option<usize> {
        let home = self.home(p);
        (0..TRIES).find_map(|_| {
            let cell = home.map(|x| (x + random.below(3)).clamp(1, self.count) - 1);
            let at = self.index(cell);
            let (from, to) = (self.starts[at] as usize, self.starts[at + 1] as usize);
            (to > from).then(|| self.order[from + random.below(to - from)] as usize)
        })
    }
}
