//! Which parts of a surface are apart from another one when they are moved off it.
//!
//! ```text
//!     own surface  |           A part near an edge of the other surface has to keep off two faces of that,
//!                  |  ,-->     and is to stay below its own: it is moved along its normal, and midway
//!     -------------'-'----     between that and the normals of what is near.
//!        other surface
//! ```
//!
//! A part that is apart from the other surface is on one side of it. So of two solids that touch
//! all over it is told how deep one may be in the other at most, by what is moved as far.

use glam::DVec3;
use rvachev_num::{Cancelled, Run};

use super::Patches;
use super::hull::{Hull, Item, What, is_opened};
use super::subpatch::Subpatch;
use super::triangles;

/// After so many comparisons no part is divided any more.
const MOST: usize = 1 << 26;

/// Normals are alike if the cosine between them is more, and so many others are tried.
const ALIKE: f64 = 0.9;
const OTHERS: usize = 6;

/// What is moved stays below its own surface: its way and the normal have no less a cosine.
const BELOW: f64 = 0.4;

/// How parts are moved, and what is asked of them.
#[derive(Clone, Copy, Debug)]
pub struct Moves {
    /// No point goes farther.
    pub by: f64,
    /// What is farther from the other surface is apart from it.
    pub least: f64,
    /// Parts that are as short are not divided.
    pub small: f64,
}

/// A part of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// A point of it.
    pub point: DVec3,
    /// A point of it where it was moved to.
    pub moved: DVec3,
    /// No point of it is farther from either.
    pub reach: f64,
    /// Its corners, if it is a part of one patch.
    pub corners: Option<[DVec3; 3]>,
    /// It is no farther off the triangle of these.
    pub sag: f64,
}

/// What was found of the parts of a surface.
#[derive(Clone, Debug, Default)]
pub struct MovedApart {
    /// Those that are apart where they were moved to: all of each is on one side of the other
    /// surface there. Of what is as near to the other surface as parts are moved none is told.
    pub apart: Vec<Place>,
    /// Those that may not be.
    pub left: Vec<Place>,
}

impl Patches {
    /// Which parts of these are farther from others than a length when each is moved below its own
    /// surface and off the others.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is stopped.
    pub fn moved_apart(&self, other: &Patches, moves: Moves, run: &Run) -> Result<MovedApart, Cancelled> {
        let mut search =
            Search { sides: [self, other], moves, items: Vec::new(), found: MovedApart::default(), looked: 0, run };
        if !self.is_empty() && !other.is_empty() {
            search.items.push(other.node(0));
            search.visit(&self.node(0), vec![0], [0.0, 1.0])?;
        }
        Ok(search.found)
    }
}

struct Search<'a> {
    sides: [&'a Patches; 2],
    moves: Moves,
    /// Those of the other surface that are in use.
    items: Vec<Item>,
    found: MovedApart,
    looked: usize,
    run: &'a Run,
}

impl Search<'_> {
    /// Looks at an item of the first surface, near which some of the other may be when its parts
    /// are moved.
    fn visit(&mut self, own: &Item, mut near: Vec<usize>, [from, to]: [f64; 2]) -> Result<(), Cancelled> {
        let Moves { by, least, small } = self.moves;
        let in_use = self.items.len();
        let mut at = 0;
        let wide = own.hull.inflated(by);
        while at < near.len() {
            let item = self.items[near[at]];
            if is_opened(&item, own, 0.25 * least) {
                near.swap_remove(at);
                let first = self.items.len();
                self.sides[1].opened(&item, &mut self.items);
                near.extend((first..self.items.len()).filter(|part| self.is_near(&wide, *part)));
            } else {
                at += 1;
            }
        }
        let part = if let What::Part(part) = &own.what { Some(part) } else { None };
        if near.is_empty() {
            let point = self.sides[0].corner(own);
            self.found.apart.push(Place { point, moved: point, reach: 2.0 * own.hull.size, corners: None, sag: 0.0 });
        } else if let Some(moved) = part.and_then(|part| self.moved(part, &near)) {
            self.found.apart.push(moved);
        } else if part.is_some_and(|part| self.is_beside(part, &near)) {
            // It is no deeper than it is far.
        } else if let Some(part) = part.filter(|part| part.longest_side() <= small || self.looked > MOST) {
            self.found.left.push(place(part, part));
        } else {
            self.run.check()?;
            self.run.report(from);
            let mut parts = Vec::new();
            self.sides[0].opened(own, &mut parts);
            let step = (to - from) / parts.len() as f64;
            for (nth, part) in parts.iter().enumerate() {
                let wide = part.hull.inflated(by);
                let near = near.iter().copied().filter(|item| self.is_near(&wide, *item)).collect();
                self.visit(part, near, [nth, nth + 1].map(|nth| from + nth as f64 * step))?;
            }
        }
        self.looked += near.len() + 1;
        self.items.truncate(in_use);
        Ok(())
    }

    fn is_near(&self, hull: &Hull, item: usize) -> bool {
        let least = self.moves.least.powi(2);
        hull.gap(&self.items[item].hull, least) < least
    }

    /// A part, if it is apart from all that is near where it is moved to.
    fn moved(&self, part: &Subpatch, near: &[usize]) -> Option<Place> {
        let Moves { by, least, .. } = self.moves;
        let far = |moved: &Subpatch, other: &Subpatch| {
            triangles::nearest(moved.points, other.points).0.sqrt() - moved.sag - other.sag >= least
        };
        self.ways(-part.item().hull.normal, near).into_iter().find_map(|way| {
            let moved = part.moved(by * way);
            let hull = moved.item().hull;
            let is_apart = |item: &usize| match &self.items[*item].what {
                What::Part(other) => !self.is_near(&hull, *item) || far(&moved, other),
                What::Node(_) => false,
            };
            near.iter().all(is_apart).then(|| place(part, &moved))
        })
    }

    /// Whether all of a part is as near to one of the other patches as parts are moved.
    fn is_beside(&self, part: &Subpatch, near: &[usize]) -> bool {
        near.iter().any(|item| match &self.items[*item].what {
            What::Part(other) => {
                let most = self.moves.by - part.sag - other.sag;
                let far = |p: &DVec3| triangles::from_corner(*p, other.points).0;
                most > 0.0 && part.points.iter().all(|p| far(p) <= most * most)
            }
            What::Node(_) => false,
        })
    }

    /// The ways that a part is moved along, given that below its own surface. Along edges patches
    /// may be folded, so that not all normals of what is near can be trusted.
    fn ways(&self, below: DVec3, near: &[usize]) -> Vec<DVec3> {
        let mut known = vec![below];
        for item in near {
            let normal = self.items[*item].hull.normal;
            if known.len() <= OTHERS && known.iter().all(|other| other.dot(normal) < ALIKE) {
                known.push(normal);
            }
        }
        let between = known[1..].iter().map(|normal| (below + normal).normalize_or_zero());
        let ways = [below].into_iter().chain(between).filter(|way| way.dot(below) >= BELOW);
        // What is between two faces that are close to each other may be apart where it is.
        ways.chain([DVec3::ZERO]).collect()
    }
}

fn place(part: &Subpatch, moved: &Subpatch) -> Place {
    let [point, moved] = [part, moved].map(|own| own.points.iter().sum::<DVec3>() / 3.0);
    let reach = part.item().hull.size + point.distance(moved);
    Place { point, moved, reach, corners: Some(part.points), sag: part.sag }
}

#[cfg(test)]
mod tests {
    use super::super::Patch;
    use super::*;

    /// A square of so many steps, of two triangles each, over two vectors.
    fn square(from: DVec3, [u, v]: [DVec3; 2], steps: usize) -> Vec<Patch> {
        let at = |i: usize, j: usize| {
            let [s, t] = [i, j].map(|k| k as f64 / steps as f64);
            from + s * u + t * v
        };
        let two = |k: usize| {
            let (i, j) = (k % steps, k / steps);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        (0..steps * steps).flat_map(two).map(Patch::flat).collect()
    }

    fn patches(all: &[Patch]) -> Patches {
        Patches::new(all, &Run::default()).unwrap()
    }

    /// A square at a height, whose normal is up.
    fn sheet(height: f64) -> Vec<Patch> {
        square(height * DVec3::Z, [DVec3::X, DVec3::Y], 7)
    }

    /// What is found of a square that looks down.
    fn found(others: &[Patch]) -> MovedApart {
        let down = square(DVec3::ZERO, [DVec3::Y, DVec3::X], 5);
        let moves = Moves { by: 0.02, least: 0.001, small: 0.05 };
        patches(&down).moved_apart(&patches(others), moves, &Run::default()).unwrap()
    }

    #[test]
    fn what_is_no_deeper_than_it_is_moved_is_apart() {
        // It goes up: beyond one that is at most that high.
        for height in [-0.1, 0.0, 0.01] {
            let MovedApart { apart, left } = found(&sheet(height));
            assert!(left.is_empty() && apart.iter().all(|place| place.moved.z > height), "{height}: {left:?}");
        }
        // Farther it does not go: what is told then is that it is below, as it is where it was.
        for height in [0.0195, 0.0205, 0.05] {
            let MovedApart { apart, left } = found(&sheet(height));
            assert!(left.is_empty() && apart.iter().all(|place| place.moved.z < height), "{height}: {left:?}");
            assert!(!apart.is_empty(), "{height}");
        }
        assert!(found(&[]).apart.is_empty());
    }

    #[test]
    fn what_is_beside_one_patch_is_no_deeper() {
        // On a sheet, below another one that is as far as it goes.
        let MovedApart { apart, left } = found(&[sheet(0.0), sheet(0.02)].concat());
        assert!(left.is_empty() && apart.is_empty(), "{left:?} {apart:?}");
    }

    #[test]
    fn along_edges_parts_are_moved_off_both_faces() {
        // A block's edge in a groove, of other triangles.
        let block = |steps: usize| {
            let top = square(DVec3::ZERO, [-DVec3::X, -DVec3::Y], steps);
            [top, square(DVec3::ZERO, [-DVec3::Y, -DVec3::Z], steps)].concat()
        };
        let groove: Vec<Patch> = block(7)
            .iter()
            .map(|patch| {
                let [a, b, c] = patch.corners;
                Patch::flat([a, c, b])
            })
            .collect();
        let moves = Moves { by: 0.02, least: 0.001, small: 0.01 };
        let found = patches(&block(5)).moved_apart(&patches(&groove), moves, &Run::default()).unwrap();
        // None is divided.
        assert_eq!((found.apart.len(), found.left.len()), (100, 0));
        assert!(found.apart.iter().all(|place| place.moved.x < 0.0 && place.moved.z < 0.0));
    }
}
