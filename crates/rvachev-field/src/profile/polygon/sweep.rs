//! What the even-odd rule makes of edges that touch: pieces that meet at their ends alone, each
//! with its inside on one side.
//!
//! ```text
//!         above \       / inside           One walk over all corners from left to right. What
//!                \     /                   crosses the line x = const is kept in its order from
//!     ------------\   /------ piece        below; as long as no two pieces cross, an insertion
//!                  \ /                     decides it. Only neighbours in that order can be the
//!     --------------*--------              next to cross, so only they are tested. Above a piece
//!      a corner on an edge parts it        it is inside if it is outside below it.
//! ```
//!
//! An edge that a corner lies on is parted there, which takes no rounding. Of pieces that lie on
//! one another an even number is nothing, and an odd number one. All decisions are by exact
//! arithmetic: J. R. Shewchuk's adaptive orientation test (1997).
//!
//! Source: M. I. Shamos and D. Hoey, *Geometric intersection problems* (1976).

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeSet, BinaryHeap};

use glam::DVec2;
use rvachev_num::{Cancelled, Run};

/// Corners between two questions whether to go on.
const OFTEN: usize = 1024;

/// A part of an edge, its ends by the number of their corner from left to right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Piece {
    pub(super) left: u32,
    pub(super) right: u32,
    /// The edge, by its number among all.
    pub(super) edge: u32,
}

/// What edges are parted into.
#[derive(Debug)]
pub(super) enum Swept {
    /// Pieces, each with whether its inside is above it (to the left of the way to the right).
    Pieces(Vec<(Piece, bool)>),
    /// Two edges that cross between their ends.
    Cross([u32; 2]),
}

/// A piece that the line of the sweep crosses, or a corner as a piece without length.
#[derive(Clone, Copy)]
struct Active {
    left: DVec2,
    right: DVec2,
    /// The number of the piece; the largest for a corner.
    number: u32,
    piece: Piece,
}

/// The sign of the turn at `b`: positive to the left. Exact.
pub(super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// The order that a turn stands for: what is to the left is greater.
pub(super) fn order(turn: f64) -> Ordering {
    turn.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// The order of corners: from left to right, from below where they are above each other.
pub(super) fn from_left(a: &DVec2, b: &DVec2) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

impl Active {
    /// Where `self` is, seen from `other`, which begins no later.
    fn side_of(&self, other: &Active) -> Ordering {
        let side = |p| order(turn(other.left, other.right, p));
        // Of two that begin together, the way that they go tells.
        side(self.left).then_with(|| side(self.right))
    }

    /// Whether the corner `p` is on the piece, which the sweep has not left.
    fn holds(&self, p: DVec2) -> bool {
        turn(self.left, self.right, p) == 0.0
    }

    /// Whether two pieces cross between their ends.
    fn crosses(&self, other: &Active) -> bool {
        let apart = |of: &Active, from: &Active| {
            let [a, b] = [from.left, from.right].map(|p| turn(of.left, of.right, p));
            a < 0.0 && b > 0.0 || a > 0.0 && b < 0.0
        };
        apart(self, other) && apart(other, self)
    }
}

impl PartialEq for Active {
    fn eq(&self, other: &Active) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Active {}

impl PartialOrd for Active {
    fn partial_cmp(&self, other: &Active) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Active {
    fn cmp(&self, other: &Active) -> Ordering {
        if self.number == other.number {
            return Ordering::Equal;
        }
        let by_place = match from_left(&self.left, &other.left) {
            Ordering::Less => other.side_of(self).reverse(),
            _ => self.side_of(other),
        };
        // A corner is below all that it is on.
        by_place.then(other.number.cmp(&self.number))
    }
}

/// Parts `pieces`, whose ends are numbers of `corners`; these are all different and in their order.
pub(super) fn sweep(corners: &[DVec2], pieces: Vec<Piece>, run: &Run) -> Result<Swept, Cancelled> {
    let mut waiting: BinaryHeap<Reverse<Piece>> = pieces.into_iter().map(Reverse).collect();
    let mut status: BTreeSet<Active> = BTreeSet::new();
    let mut is_inside_above: Vec<bool> = Vec::new();
    let mut found = Vec::new();
    let (mut on, mut from_here) = (Vec::new(), Vec::new());
    for (at, &corner) in (0u32..).zip(corners) {
        if (at as usize).is_multiple_of(OFTEN) {
            run.check()?;
            run.report(f64::from(at) / corners.len() as f64);
        }
        let place =
            Active { left: corner, right: corner, number: u32::MAX, piece: Piece { left: at, right: at, edge: 0 } };
        // What ends here, and what goes on.
        on.clear();
        on.extend(status.range(place..).take_while(|active| active.holds(corner)));
        for active in &on {
            status.remove(active);
            let Piece { right, edge, .. } = active.piece;
            found.push((Piece { right: at, ..active.piece }, is_inside_above[active.number as usize]));
            if right != at {
                waiting.push(Reverse(Piece { left: at, right, edge }));
            }
        }
        from_here.clear();
        while let Some(Reverse(piece)) = waiting.peek().copied().filter(|Reverse(piece)| piece.left == at) {
            waiting.pop();
            from_here.push(piece);
        }
        let end = |piece: &Piece| corners[piece.right as usize];
        // From below; of those that lie on one another the shortest first.
        from_here.sort_by(|a, b| order(turn(corner, end(b), end(a))).then(a.cmp(b)));
        let [below, above] = [status.range(..place).next_back().copied(), status.range(place..).next().copied()];
        let mut is_inside = below.is_some_and(|below| is_inside_above[below.number as usize]);
        let mut lowest_and_highest = None;
        for along in from_here.chunk_by(|a, b| turn(corner, end(a), end(b)) == 0.0) {
            let shortest = along[0];
            let right = shortest.right;
            waiting.extend(
                along
                    .iter()
                    .filter(|piece| piece.right != right)
                    .map(|longer| Reverse(Piece { left: right, ..*longer })),
            );
            if along.len() % 2 == 0 {
                continue;
            }
            is_inside = !is_inside;
            let number = is_inside_above.len() as u32;
            is_inside_above.push(is_inside);
            let active = Active { left: corner, right: end(&shortest), number, piece: shortest };
            status.insert(active);
            lowest_and_highest = Some((lowest_and_highest.map_or(active, |(lowest, _)| lowest), active));
        }
        let pairs = match lowest_and_highest {
            Some((lowest, highest)) => [(below, Some(lowest)), (Some(highest), above)],
            None => [(below, above), (None, None)],
        };
        for pair in pairs {
            if let (Some(a), Some(b)) = pair
                && a.crosses(&b)
            {
                return Ok(Swept::Cross([a.piece.edge.min(b.piece.edge), a.piece.edge.max(b.piece.edge)]));
            }
        }
    }
    Ok(Swept::Pieces(found))
}
