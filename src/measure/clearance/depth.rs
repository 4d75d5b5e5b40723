//! How deep one solid's surface goes into another solid.
//!
//! ```text
//!     ---------T-------      T the patch of the other surface that is nearest to the middle of a piece:
//!            |               no point of the piece is deeper than it is far from T, and of a flat T
//!          --p--  piece      that is most at a corner of the piece.
//! ```
//!
//! What may be deepest is looked at first, boxes of patches, then patches, then their parts, until
//! nothing that is left may be deeper than what was found by more than a tolerance. Where surfaces
//! all but fall together, as those of a solid that is laid in itself, all is as deep: patches that
//! are outside of the other solid when they are moved outwards by the tolerance are left out.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::apart::ball;
use super::overlap::is_outside_beside;
use super::piece::Piece;
use super::{AT_ONCE, Side};
use crate::eval::Block;
use crate::{Bounds, Cancelled, Run};

/// So many pieces are divided at most.
const MOST: usize = 1 << 12;

/// How near the depth is found, as a part of it.
const RELATIVE: f64 = 0.01;

/// How deep the surface of `from` goes into the other solid: the deepest point that was found, at
/// least 0, and how much deeper there may be one.
pub(super) fn depth(from: &Side<'_>, to: &Side<'_>, slack: f64, run: &Run) -> Result<[f64; 2], Cancelled> {
    let runs = from.surface.runs();
    let mut search = Search { from, to, slack, best: 0.0, outside: None, open: BinaryHeap::new() };
    if let Some(all) = runs.all() {
        let (centre, _) = ball(runs.bounds(all));
        let far = super::distance(&to.surface.patches, centre);
        search.add_block(all, &About { centre, far }, f64::INFINITY);
    }
    let (mut looked, mut divided) = (0_usize, 0);
    loop {
        let enough = search.enough();
        let at_most = search.open.peek().map_or(enough, |next| next.bound.max(enough));
        let next = if at_most > enough && divided < MOST { search.open.pop() } else { None };
        let Some(Open { bound, node }) = next else { return Ok([search.best, at_most - search.best]) };
        looked += 1;
        if looked.is_multiple_of(AT_ONCE) {
            run.check()?;
            run.report(1.0 - (-(looked as f64) / 4096.0).exp2());
        }
        match node {
            Node::Block(block, about) => {
                runs.parts(block).for_each(|part| search.add_block(part, &about, bound));
                for n in runs.opened(&[block]).1 {
                    let piece = Piece::whole(&from.surface.patches, n);
                    search.add(piece, false, bound);
                }
            }
            Node::Piece(piece, false) => {
                let piece = piece.numbered(|p| search.below(p));
                if search.learn(&piece) {
                    search.add(piece, true, bound);
                }
            }
            Node::Piece(piece, true) => {
                divided += 1;
                for part in piece.divided(|p| search.below(p)) {
                    if search.learn(&part) {
                        search.add(part, true, bound);
                    }
                }
            }
        }
    }
}

/// What may hold points that are deeper than what was found.
struct Open {
    /// None of them is deeper.
    bound: f64,
    node: Node,
}

enum Node {
    Block(Block, About),
    /// With whether its numbers are how deep its corners are.
    Piece(Piece, bool),
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Open) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// The centre of a box, and how far it is from the other surface at most.
struct About {
    centre: DVec3,
    far: f64,
}

struct Search<'a> {
    from: &'a Side<'a>,
    to: &'a Side<'a>,
    slack: f64,
    /// How deep a point is that was found.
    best: f64,
    /// A point outside of the other solid, close to what was looked at last.
    outside: Option<DVec3>,
    open: BinaryHeap<Open>,
}

impl Search<'_> {
    /// What is no deeper need not be looked at.
    fn enough(&self) -> f64 {
        self.best + self.slack.max(RELATIVE * self.best)
    }

    /// How deep a point is; of one that is not inside, by more than does not count, how far it is,
    /// negative.
    fn below(&self, p: DVec3) -> f64 {
        let distance = super::distance(&self.to.surface.patches, p);
        if distance > self.to.fineness() && self.to.program.value(p) > 0.0 { distance } else { -distance }
    }

    /// No point is deeper whose ball, and convex hull, these are, if there may be one that is deep
    /// enough to be looked at; the ball is about the first point. With how far that is from the
    /// other surface.
    fn bound(&self, middle: DVec3, radius: f64, corners: &[DVec3]) -> Option<[f64; 2]> {
        let others = &self.to.surface.patches;
        let (foot, from_patch) = others.nearest_with(middle, corners)?;
        let from_foot = corners.iter().map(|p| p.distance(foot.point)).fold(0.0, f64::max);
        let bound = if others.is_flat() { from_patch.min(from_foot) } else { from_foot };
        let is_all_outside = || foot.distance >= radius && self.to.program.value(middle) <= 0.0;
        (bound > self.enough() && !is_all_outside()).then_some([bound, foot.distance])
    }

    /// Whether no point of a piece is deeper than what need not be looked at, as the piece is
    /// outside when it is moved outwards by that.
    fn is_shallow(&mut self, piece: &Piece) -> bool {
        let by = self.enough();
        is_outside_beside(piece, self.from, self.to, by, &mut self.outside)
    }

    /// The surface is passed on the way out of its box.
    fn out(&self, own: &Bounds) -> f64 {
        let bounds = self.to.surface.patches.bounds();
        (own.max - bounds.min).min(bounds.max - own.min).min_element()
    }

    fn add_block(&mut self, block: Block, whole: &About, above: f64) {
        let own = self.from.surface.runs().bounds(block);
        let (centre, radius) = ball(own);
        let (most, enough) = (above.min(self.out(own)), self.enough());
        if most <= enough {
            return;
        }
        // If the other surface is within the ball, and that is large, no bound leaves it out.
        let far = whole.far + whole.centre.distance(centre);
        let found = if far < radius && radius > enough {
            Some([far + radius, far])
        } else {
            self.bound(centre, radius, &own.corners())
        };
        if let Some([bound, far]) = found {
            self.open.push(Open { bound: most.min(bound), node: Node::Block(block, About { centre, far }) });
        }
    }

    fn add(&mut self, piece: Piece, is_numbered: bool, above: f64) {
        let off = piece.part.sag;
        let own = Bounds::from_points(piece.part.points).inflate(off);
        let (middle, side) = (piece.middle(), piece.part.longest_side() / 3f64.sqrt());
        let mut most = above.min(self.out(&own));
        if is_numbered {
            // Depths change by as much as points are apart at most.
            let corner = piece.numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most = most.min(corner + side + off);
        }
        if most <= self.enough() {
            return;
        }
        if let Some([bound, far]) = self.bound(middle, side + off, &piece.part.points) {
            // Triangles tell this sooner than how deep corners are.
            if self.to.is_known && far <= side + off + self.enough() && self.is_shallow(&piece) {
                return;
            }
            self.open.push(Open { bound: most.min(bound + off), node: Node::Piece(piece, is_numbered) });
        }
    }

    /// Keeps how deep the corners of a piece are. Tells whether its inner points are to be looked
    /// at: what is outside when it is moved outwards by what does not count is no deeper than that;
    /// of faces that fall together it is told so.
    fn learn(&mut self, piece: &Piece) -> bool {
        let deepest = piece.numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        self.best = self.best.max(deepest);
        deepest > self.enough() || self.to.is_known || !self.is_shallow(piece)
    }
}
