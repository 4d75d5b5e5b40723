//! Where two surfaces are nearest to each other.
//!
//! What is in a box of the one is compared with a few boxes of the other, the larger ones opened
//! each time, until it is known to be no nearer than what was found. Patches that are curved are
//! divided; of flat ones the triangles are asked.

use glam::DVec3;
use rvachev_num::{Cancelled, Run};

use super::Patches;
use super::hull::{Item, What, is_opened};
use super::subpatch::Subpatch;
use super::triangles;

/// After so many comparisons nothing more is opened, and what is known then is what is told.
const MOST: usize = 1 << 26;

/// How near two surfaces are to each other.
#[derive(Clone, Copy, Debug)]
pub struct Between {
    /// No points of them are nearer to each other, in length units.
    pub least: f64,
    /// A point of the first that is as near to the other as that, or nearer; nothing if none was
    /// found that is nearer than what was known.
    pub nearest: Option<(f64, DVec3)>,
}

/// What nobody needs to know.
#[derive(Clone, Copy, Debug)]
pub struct Loss {
    /// What is not nearer than what is known by this part of it is not looked at.
    pub part: f64,
    /// Nor what is not nearer by this length.
    pub length: f64,
    /// Patches that are off their triangles by no more are not divided.
    pub fine: f64,
}

/// A part of the other surface that may be near, by its number. The square of its distance is no
/// less than what is known.
#[derive(Clone, Copy)]
struct Near {
    item: usize,
    least: f64,
}

impl Patches {
    /// Where these are nearest to others, given the distance of two points of both surfaces.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn between(&self, other: &Patches, known: f64, loss: Loss, run: &Run) -> Result<Between, Cancelled> {
        let items = if other.is_empty() { Vec::new() } else { vec![other.node(0)] };
        let mut search =
            Search { sides: [self, other], known, loss, least: known, nearest: None, items, looked: 0, run };
        if !self.is_empty() && !other.is_empty() {
            search.visit(&self.node(0), vec![Near { item: 0, least: 0.0 }], [0.0, 1.0])?;
        }
        Ok(Between { least: search.least, nearest: search.nearest.map(|p| (search.known, p)) })
    }
}

struct Search<'a> {
    sides: [&'a Patches; 2],
    /// The distance of the nearest points that are known.
    known: f64,
    loss: Loss,
    least: f64,
    nearest: Option<DVec3>,
    /// Those of the other surface that are in use.
    items: Vec<Item>,
    looked: usize,
    run: &'a Run,
}

impl Search<'_> {
    /// The square of what is no nearer than what counts.
    fn enough(&self) -> f64 {
        ((1.0 - self.loss.part) * self.known - self.loss.length).max(0.0).powi(2)
    }

    /// What is known to be no nearer than this square.
    fn pass(&mut self, square: f64) {
        self.least = self.least.min(square.sqrt());
    }

    /// Compares an item of the first surface with all of the other that may be near; the work is
    /// told from a number to another one.
    fn visit(&mut self, own: &Item, mut near: Vec<Near>, [from, to]: [f64; 2]) -> Result<(), Cancelled> {
        let in_use = self.items.len();
        let mut at = 0;
        while at < near.len() {
            let Near { item, least } = near[at];
            if least >= self.enough() || self.looked > MOST {
                self.pass(least);
                near.swap_remove(at);
            } else if is_opened(&self.items[item], own, self.loss.fine) {
                near.swap_remove(at);
                let first = self.items.len();
                let item = self.items[item];
                self.sides[1].opened(&item, &mut self.items);
                near.extend((first..self.items.len()).filter_map(|item| self.near(own, Near { item, least })));
            } else {
                at += 1;
            }
        }
        if let What::Part(part) = own.what
            && part.sag <= self.loss.fine
        {
            near.iter().for_each(|near| self.compare(&part, near.item));
        } else if !near.is_empty() {
            self.run.check()?;
            self.run.report(from);
            let mut parts = Vec::new();
            self.sides[0].opened(own, &mut parts);
            let step = (to - from) / parts.len() as f64;
            let of = |part: &Item| near.iter().filter_map(|near| self.near(part, *near)).collect::<Vec<Near>>();
            let mut all: Vec<Vec<Near>> = parts.iter().map(of).collect();
            let nearest = |near: &[Near]| near.iter().map(|near| near.least).fold(f64::INFINITY, f64::min);
            let mut order: Vec<usize> = (0..parts.len()).collect();
            // The nearest is looked at first.
            order.sort_by(|a, b| nearest(&all[*a]).total_cmp(&nearest(&all[*b])));
            for (nth, which) in order.into_iter().enumerate() {
                let work = [nth, nth + 1].map(|nth| from + nth as f64 * step);
                self.visit(&parts[which], std::mem::take(&mut all[which]), work)?;
            }
        }
        self.items.truncate(in_use);
        Ok(())
    }

    /// Whether something of the other surface is near to an item, given what is known of it.
    fn near(&mut self, own: &Item, known: Near) -> Option<Near> {
        self.looked += 1;
        let enough = self.enough();
        let least = own.hull.gap(&self.items[known.item].hull, enough).max(known.least);
        if least >= enough {
            self.pass(least);
        }
        (least < enough).then_some(Near { least, ..known })
    }

    /// Compares triangles.
    fn compare(&mut self, own: &Subpatch, item: usize) {
        let What::Part(other) = &self.items[item].what else { return };
        let (square, point) = triangles::nearest(own.points, other.points);
        let (between, sag) = (square.sqrt(), own.sag + other.sag);
        self.least = self.least.min((between - sag).max(0.0));
        if between + sag < self.known {
            (self.known, self.nearest) = (between + sag, Some(point));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Patch;
    use super::*;

    /// How much the bowls bend.
    const BEND: f64 = 0.4;
    const STEPS: usize = 12;

    fn on_bowl(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, BEND * (x * x + y * y))
    }

    /// A bowl over a square, moved: of triangles, or as it is.
    fn bowl(by: DVec3, is_flat: bool) -> Vec<Patch> {
        let at = |i: usize, j: usize| {
            let [x, y] = [i, j].map(|k| k as f64 / STEPS as f64 - 0.5);
            on_bowl(x, y)
        };
        let patch = |corners: [DVec3; 3]| {
            let down = |a: DVec3, b: DVec3| {
                let by = 0.25 * BEND * (a.truncate() - b.truncate()).length_squared();
                if is_flat { DVec3::ZERO } else { -by * DVec3::Z }
            };
            let [a, b, c] = corners;
            Patch { displacements: [down(a, b), down(b, c), down(c, a)], ..Patch::flat(corners.map(|p| p + by)) }
        };
        let two = |k: usize| {
            let (i, j) = (k % STEPS, k / STEPS);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [patch([a, b, c]), patch([a, c, d])]
        };
        (0..STEPS * STEPS).flat_map(two).collect()
    }

    fn between(one: &[Patch], other: &[Patch], known: f64, length: f64) -> Between {
        let [one, other] = [one, other].map(|all| Patches::new(all, &Run::default()).unwrap());
        one.between(&other, known, Loss { part: 0.0, length, fine: 0.1 * length }, &Run::default()).unwrap()
    }

    #[test]
    fn of_triangles_the_nearest_are_found() {
        for up in [0.3, 0.05, 0.003] {
            let by = DVec3::new(0.031, -0.017, up);
            let (one, other) = (bowl(DVec3::ZERO, true), bowl(by, true));
            let pairs = one.iter().flat_map(|a| other.iter().map(move |b| (a.corners, b.corners)));
            let brute = pairs.map(|(a, b)| triangles::nearest(a, b).0).fold(f64::INFINITY, f64::min).sqrt();
            for known in [10.0, 1.001 * brute] {
                let Between { least, nearest } = between(&one, &other, known, 1e-4);
                assert!(least <= brute + 1e-6 && least >= brute - 1.1e-4, "{least} {brute}");
                assert!(nearest.is_none_or(|(far, _)| (far - brute).abs() < 1e-4), "{nearest:?} {brute}");
            }
            // What is known to be nearer is not looked for.
            let Between { least, nearest } = between(&one, &other, 0.5 * brute, 0.0);
            assert!(nearest.is_none() && least == 0.5 * brute, "{least} {brute}");
        }
    }

    #[test]
    fn of_curved_patches_it_is_told_to_within_what_is_asked() {
        for up in [0.3, 0.02] {
            let (one, other) = (bowl(DVec3::ZERO, false), bowl(up * DVec3::Z, false));
            let above = Patches::new(&other, &Run::default()).unwrap();
            let points = (0..1681).map(|k| [k % 41, k / 41].map(|k| k as f64 / 40.0 - 0.5));
            let far = points.map(|[x, y]| above.nearest(on_bowl(x, y)).unwrap().distance);
            let brute = far.fold(f64::INFINITY, f64::min);
            for length in [1e-2, 1e-3] {
                let Between { least, nearest } = between(&one, &other, up, length);
                assert!(least >= brute - 1.3 * length && least <= brute + 1e-6, "{least} {brute}");
                // At the rim it is nearer than in the middle.
                assert!(nearest.is_some() || brute > up - length, "{brute}");
                let (far, p) = nearest.unwrap_or((brute, DVec3::ZERO));
                assert!(
                    (p.z - BEND * p.truncate().length_squared()).abs() < 0.01 && far <= brute + length,
                    "{p} {far}"
                );
            }
        }
    }

    #[test]
    fn parts_of_a_patch_are_on_it() {
        let all = bowl(DVec3::ZERO, false);
        let patches = Patches::new(&all, &Run::default()).unwrap();
        let mut open = vec![patches.node(0)];
        let mut parts = 0;
        while let Some(item) = open.pop() {
            if let What::Part(part) = item.what {
                for p in part.points {
                    assert!((p.z - BEND * p.truncate().length_squared()).abs() < 1e-6, "{p}");
                }
                // Two divisions below the whole ones.
                if part.sag < 0.05 * f64::from(patches.faces[0].sag) {
                    parts += 1;
                    continue;
                }
            }
            patches.opened(&item, &mut open);
        }
        assert!(parts >= 16 * all.len(), "{parts}");
    }
}
