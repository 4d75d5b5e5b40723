//! Normals of points that have none, outwards.
//!
//! ```text
//!     sheets     neighbours whose planes are nearly the same hang together
//!     tree       neighbours vote on whether their sheets face the same way: m = nₐ·n_b − 2 (nₐ·e)(n_b·e),
//!                e from a to b, is positive if they do, also about an edge and about the rim of a thin
//!                wall; sheets hang together where the votes, Σ m³, are clearest
//!     signs      on a surface the winding number is ½ throughout: sheets are turned, alone or with all
//!                that hangs on them in the tree, where Σ w / √(N Σ w²) grows by that
//! ```
//!
//! Sources: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, *Surface reconstruction from
//! unorganized points* (1992), for the tree; S. König, S. Gumhold, *Consistent propagation of
//! normal orientations in point clouds* (2009), for m; G. Barill, N. Dickson, R. Schmidt, D. Levin,
//! A. Jacobson, *Fast winding numbers for soups and clouds* (2018).

use std::collections::BTreeMap;

use glam::DVec3;

use super::planes::Planes;
use crate::fit::random::Random;

/// Neighbours that orientation goes on to.
const NEAR: usize = 10;

/// Planes that are nearly the same, as a cosine: 12°.
const ALIKE: f64 = 0.978;

/// Sheets of fewer points are turned with others only.
const LEAST: usize = 10;

/// Points that winding numbers are asked at, and the least distance that counts, in parts of the
/// distance of neighbours.
const ASKED: usize = 800;
const APART: f64 = 1.5;

/// The square of a distance that is none, in diagonals.
const LITTLE: f64 = 1e-12;

/// Turns at most, and what one must be worth: what is worth less is as likely to be wrong.
const TURNS: usize = 60;
const WORTH: f64 = 0.003;

/// Unit normals that point outwards.
pub(super) fn normals(points: &[DVec3], random: &mut Random) -> Vec<DVec3> {
    let Planes { mut normals, neighbours, areas } = Planes::of(points);
    let mut links: Vec<Link> = Vec::new();
    for (i, near) in (0_u32..).zip(&neighbours) {
        links.extend(near.iter().take(NEAR).filter(|k| **k != i).map(|k| Link::of(points, &normals, [i, *k])));
    }
    // Sheets, each of one side.
    let mut joined = Joined::new(points.len());
    for link in links.iter().filter(|link| link.is_smooth) {
        joined.join(link.ends, link.agreement < 0.0);
    }
    let roots: Vec<(u32, bool)> = (0..points.len() as u32).map(|i| joined.root(i)).collect();
    let mut numbers = vec![u32::MAX; points.len()];
    let mut sizes: Vec<usize> = Vec::new();
    let mut sheets = Vec::with_capacity(points.len());
    for (normal, (root, is_turned)) in normals.iter_mut().zip(&roots) {
        let number = &mut numbers[*root as usize];
        if *number == u32::MAX {
            *number = sizes.len() as u32;
            sizes.push(0);
        }
        sizes[*number as usize] += 1;
        sheets.push(*number);
        if *is_turned {
            *normal = -*normal;
        }
    }
    // The tree of the sheets.
    let mut votes: BTreeMap<[u32; 2], f64> = BTreeMap::new();
    for link in &links {
        let [a, b] = link.ends.map(|i| sheets[i as usize]);
        let [p, q] = link.ends.map(|i| roots[i as usize].1);
        let vote = if p == q { link.agreement.powi(3) } else { -link.agreement.powi(3) };
        if a != b {
            *votes.entry([a.min(b), a.max(b)]).or_default() += vote;
        }
    }
    let mut votes: Vec<([u32; 2], f64)> = votes.into_iter().collect();
    votes.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let mut joined = Joined::new(sizes.len());
    let mut steps: Vec<Vec<(u32, bool)>> = vec![Vec::new(); sizes.len()];
    for ([a, b], vote) in votes {
        let differs = vote < 0.0;
        if joined.join([a, b], differs) {
            steps[a as usize].push((b, differs));
            steps[b as usize].push((a, differs));
        }
    }
    let mut tree = Tree::from(&steps, &sizes);
    tree.turn(&Winding::on(points, &normals, &areas, &sheets, sizes.len(), random));
    for (normal, sheet) in normals.iter_mut().zip(&sheets) {
        *normal *= tree.signs[*sheet as usize];
    }
    normals
}

/// Two neighbours.
struct Link {
    /// Positive if their normals point to the same side, and the more so the surer that is.
    agreement: f64,
    is_smooth: bool,
    ends: [u32; 2],
}

impl Link {
    fn of(points: &[DVec3], normals: &[DVec3], ends: [u32; 2]) -> Link {
        let [i, j] = ends.map(|i| i as usize);
        let (a, b) = (normals[i], normals[j]);
        let along = (points[j] - points[i]).normalize_or_zero();
        let agreement = a.dot(b) - 2.0 * a.dot(along) * b.dot(along);
        let is_smooth = a.dot(b).abs() > ALIKE && agreement.abs() > ALIKE;
        Link { agreement, is_smooth, ends }
    }
}

/// What hangs together, and on which side of each other it is.
struct Joined {
    above: Vec<u32>,
    is_turned: Vec<bool>,
    sizes: Vec<u32>,
}

impl Joined {
    fn new(count: usize) -> Joined {
        Joined { above: (0..count as u32).collect(), is_turned: vec![false; count], sizes: vec![1; count] }
    }

    /// What something hangs on, and whether it is turned against that. The smaller set hangs on the
    /// larger one, so ways are short.
    fn root(&self, mut at: u32) -> (u32, bool) {
        let mut is_turned = false;
        while self.above[at as usize] != at {
            is_turned ^= self.is_turned[at as usize];
            at = self.above[at as usize];
        }
        (at, is_turned)
    }

    /// Whether the two were apart.
    fn join(&mut self, ends: [u32; 2], differs: bool) -> bool {
        let [(a, p), (b, q)] = ends.map(|i| self.root(i));
        if a == b {
            return false;
        }
        let (small, large) = if self.sizes[a as usize] < self.sizes[b as usize] { (a, b) } else { (b, a) };
        self.above[small as usize] = large;
        self.is_turned[small as usize] = p ^ q ^ differs;
        self.sizes[large as usize] += self.sizes[small as usize];
        true
    }
}

/// Sheets that hang on each other, those that others hang on first.
struct Tree {
    order: Vec<usize>,
    /// By sheet; none of the first one of what hangs together.
    above: Vec<Option<usize>>,
    /// How many points a sheet has, and those that hang on it besides.
    sizes: Vec<usize>,
    with_branches: Vec<usize>,
    signs: Vec<f64>,
}

impl Tree {
    fn from(steps: &[Vec<(u32, bool)>], sizes: &[usize]) -> Tree {
        let count = sizes.len();
        let mut by_size: Vec<usize> = (0..count).collect();
        by_size.sort_by_key(|i| (usize::MAX - sizes[*i], *i));
        let mut tree = Tree {
            order: Vec::with_capacity(count),
            above: vec![None; count],
            sizes: sizes.to_vec(),
            with_branches: sizes.to_vec(),
            signs: vec![0.0; count],
        };
        for first in by_size {
            if tree.signs[first] != 0.0 {
                continue;
            }
            tree.signs[first] = 1.0;
            let mut next = tree.order.len();
            tree.order.push(first);
            while let Some(&at) = tree.order.get(next) {
                next += 1;
                for &(to, differs) in &steps[at] {
                    let to = to as usize;
                    if tree.signs[to] == 0.0 {
                        tree.signs[to] = if differs { -tree.signs[at] } else { tree.signs[at] };
                        tree.above[to] = Some(at);
                        tree.order.push(to);
                    }
                }
            }
        }
        for &at in tree.order.iter().rev() {
            if let Some(above) = tree.above[at] {
                tree.with_branches[above] += tree.with_branches[at];
            }
        }
        tree
    }

    /// Turns what makes the winding numbers more alike, the best first.
    fn turn(&mut self, winding: &Winding) {
        for _ in 0..TURNS {
            let own: Vec<Vec<f64>> = (0..self.signs.len()).map(|i| winding.of(i, self.signs[i])).collect();
            let mut branches = own.clone();
            let mut all = vec![0.0; winding.count];
            for &at in self.order.iter().rev() {
                let branch = std::mem::take(&mut branches[at]);
                let sum = match self.above[at] {
                    Some(above) => &mut branches[above],
                    None => &mut all,
                };
                sum.iter_mut().zip(&branch).for_each(|(sum, w)| *sum += w);
                branches[at] = branch;
            }
            let now = merit(all.iter().copied());
            let turned = |part: &[f64]| merit(all.iter().zip(part).map(|(w, part)| w - 2.0 * part));
            // What is turned: a sheet, or with all that hangs on it.
            let mut best = (now + WORTH, None);
            for i in 0..self.signs.len() {
                if self.with_branches[i] < LEAST {
                    continue;
                }
                let with = turned(&branches[i]);
                if with > best.0 {
                    best = (with, Some((i, true)));
                }
                if self.sizes[i] >= LEAST {
                    let alone = turned(&own[i]);
                    if alone > best.0 {
                        best = (alone, Some((i, false)));
                    }
                }
            }
            match best.1 {
                None => break,
                Some((i, false)) => self.signs[i] = -self.signs[i],
                Some((i, true)) => {
                    let mut is_on = vec![false; self.signs.len()];
                    for &at in &self.order {
                        if at == i || self.above[at].is_some_and(|above| is_on[above]) {
                            is_on[at] = true;
                            self.signs[at] = -self.signs[at];
                        }
                    }
                }
            }
        }
    }
}

/// How much winding numbers are the same, positive ones: 1 if they are.
fn merit(numbers: impl Iterator<Item = f64>) -> f64 {
    let (count, sum, squares) = numbers.fold((0.0, 0.0, 0.0), |(n, s, q), w| (n + 1.0, s + w, q + w * w));
    sum / f64::max(count * squares, f64::MIN_POSITIVE).sqrt()
}

/// What each sheet has in the winding numbers of points on the surface.
struct Winding {
    count: usize,
    /// By sheet, then by point.
    parts: Vec<f32>,
}

impl Winding {
    fn on(
        points: &[DVec3],
        normals: &[DVec3],
        areas: &[f64],
        sheets: &[u32],
        count: usize,
        random: &mut Random,
    ) -> Winding {
        let asked = random.chosen(points.len(), ASKED);
        let mut parts = vec![0.0_f32; count * asked.len()];
        for (k, &i) in asked.iter().enumerate() {
            let least = f64::max(APART * APART * areas[i], LITTLE);
            for (((p, n), area), sheet) in points.iter().zip(normals).zip(areas).zip(sheets) {
                let away = *p - points[i];
                let square = away.length_squared().max(least);
                let part = area * n.dot(away) / (square * square.sqrt());
                parts[*sheet as usize * asked.len() + k] += part as f32;
            }
        }
        Winding { count: asked.len(), parts }
    }

    fn of(&self, sheet: usize, sign: f64) -> Vec<f64> {
        let from = sheet * self.count;
        self.parts[from..from + self.count].iter().map(|w| sign * f64::from(*w)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a box of a size about a place, and the normals there.
    fn strewn(size: DVec3, centre: DVec3, count: usize, random: &mut Random) -> Vec<(DVec3, DVec3)> {
        let areas = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        let total = areas.element_sum();
        (0..count)
            .map(|_| {
                let at = random.unit() * total;
                let axis = if at < areas.x { 0 } else { 1 + usize::from(at > areas.x + areas.y) };
                let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
                let mut p = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
                p[axis] = 0.5 * side;
                (centre + p * size, side * DVec3::AXES[axis])
            })
            .collect()
    }

    fn right(truth: &[(DVec3, DVec3)], seed: u64) -> [usize; 2] {
        let points: Vec<DVec3> = truth.iter().map(|t| t.0).collect();
        let found = normals(&points, &mut Random::new(seed));
        let count = |is: fn(f64) -> bool| found.iter().zip(truth).filter(|(f, t)| is(f.dot(t.1))).count();
        [count(|d| d > 0.95), count(|d| d < -0.2)]
    }

    #[test]
    fn normals_of_a_box_point_out_and_most_are_sharp() {
        let truth = strewn(DVec3::new(0.6, 0.4, 0.2), DVec3::ZERO, 3000, &mut Random::new(9));
        let [right, wrong] = right(&truth, 1);
        assert!(right > 2840 && wrong < 15, "{right} {wrong}");
    }

    #[test]
    fn a_narrow_cavity_faces_inwards() {
        let mut random = Random::new(3);
        let mut truth = strewn(DVec3::new(0.7, 0.5, 0.3), DVec3::ZERO, 3200, &mut random);
        let cavity = strewn(DVec3::new(0.4, 0.12, 0.1), DVec3::new(0.05, 0.1, 0.06), 600, &mut random);
        truth.extend(cavity.into_iter().map(|(p, n)| (p, -n)));
        let [right, wrong] = right(&truth, 1);
        assert!(right > 3560 && wrong < 40, "{right} {wrong}");
    }
}
