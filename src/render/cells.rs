//! The space around a solid, divided where rays look.
//!
//! ```text
//!     +-------------+------+      A binary tree of boxes. Each is inside, outside, or a cell
//!     |             |  ..-'|      that the surface may cross, with the program narrowed to
//!     |   outside   +--*---+      it. A cell is halved along its longest side when rays ask
//!     |             | /in- |      for it, and keeps its halves: what no ray reaches is
//!     |             |/side |      never divided, and the next picture finds the work done.
//!     +-------------+------+
//! ```
//!
//! All programs of a solid agree on the sign of any point, and the parts of a ray in the boxes
//! abut to the bit, as the crossings with a plane are computed alike on both sides of it: a
//! crossing of the surface at the border of two cells belongs to one of them and is never lost.
//!
//! What is divided when does not change what a part of the tree is, so results do not depend
//! on the order in which rays ask.

use std::sync::OnceLock;

use glam::DVec3;

use crate::eval::{Bend, Program, Region, Tape};
use crate::{Bounds, Dual, Interval};

/// The tree.
pub(super) struct Cells {
    root: Part,
    bounds: Bounds,
    /// Boxes are narrowed with this much room on each side, for the rounding of points.
    margin: f64,
}

/// A box of the tree.
pub(super) enum Part {
    Inside,
    Outside,
    Cell(Box<Cell>),
}

/// A box that the surface may cross.
pub(super) struct Cell {
    pub(super) bounds: Bounds,
    pub(super) program: Program,
    /// How the program's value bends along rays, where that is known.
    pub(super) bend: Option<Bend>,
    /// Its length along its longest side, in proportion to that of the solid.
    pub(super) share: f64,
    /// How many leaves the program has.
    pub(super) leaves: usize,
    /// How many halvings ago it had a third more.
    pub(super) stale: u32,
    /// How many it had then.
    before: usize,
    margin: f64,
    halves: OnceLock<Halves>,
    tape: OnceLock<Tape>,
}

/// The two parts of a cell, below and above a plane.
pub(super) struct Halves {
    pub(super) axis: usize,
    pub(super) plane: f64,
    pub(super) parts: [Part; 2],
}

impl Cells {
    /// The tree of `program`, whose solid lies within `bounds` (finite, of some size).
    pub(super) fn new(program: &Program, bounds: &Bounds) -> Cells {
        let longest = bounds.longest_side();
        // Room around the solid, so that rays start outside of it; more on one side than on the
        // other, so that planes of symmetry are not planes of the tree.
        let bounds = Bounds::new(bounds.min - 0.0537 * longest, bounds.max + 0.0411 * longest);
        let rounding = 64.0 * f64::EPSILON * (bounds.center().abs().max_element() + bounds.size().length());
        let margin = 1e-9 * longest + rounding;
        Cells { root: part(program, bounds, 1.0, margin, (usize::MAX, 0)), bounds, margin }
    }

    pub(super) fn root(&self) -> &Part {
        &self.root
    }

    /// The box of all cells: larger than that of the solid.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Holds every point of a ray's part in a cell.
    pub(super) fn reach(&self) -> Bounds {
        self.bounds.inflate(2.0 * self.margin)
    }

    /// Whether a point is inside the solid.
    pub(super) fn contains(&self, p: DVec3) -> bool {
        if !self.bounds.contains(p) {
            return false;
        }
        let mut part = &self.root;
        loop {
            match part {
                Part::Inside => return true,
                Part::Outside => return false,
                Part::Cell(cell) => {
                    if cell.leaves <= FEW || cell.stale >= STALE {
                        return cell.program.value(p) > 0.0;
                    }
                    let halves = cell.halves();
                    part = &halves.parts[usize::from(p[halves.axis] >= halves.plane)];
                }
            }
        }
    }
}

/// Programs of at most this many leaves are evaluated at a point rather than narrowed.
const FEW: usize = 4;

/// Where as many halvings have left the leaves what they were, more of them are of no use.
pub(super) const STALE: u32 = 6;

/// What a box holds; `before` are leaves of a box around it, and how many halvings ago.
fn part(program: &Program, bounds: Bounds, share: f64, margin: f64, before: (usize, u32)) -> Part {
    match program.narrow(&bounds.inflate(margin)) {
        Region::Inside => Part::Inside,
        Region::Outside => Part::Outside,
        Region::Surface(program) => {
            let (bend, leaves) = (program.bend(), program.leaf_count());
            let (before, stale) = if leaves <= before.0 / 4 * 3 { (leaves, 0) } else { before };
            let (halves, tape) = (OnceLock::new(), OnceLock::new());
            Part::Cell(Box::new(Cell { bounds, program, bend, share, leaves, stale, before, margin, halves, tape }))
        }
    }
}

impl Cell {
    /// Its length along its longest side.
    pub(super) fn side(&self) -> f64 {
        self.bounds.longest_side()
    }

    /// Its halves, made when they are first asked for.
    pub(super) fn halves(&self) -> &Halves {
        self.halves.get_or_init(|| {
            let size = self.bounds.size();
            let axis = (0..3).rev().max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
            let plane = 0.5 * (self.bounds.min[axis] + self.bounds.max[axis]);
            let (mut below, mut above) = (self.bounds, self.bounds);
            below.max[axis] = plane;
            above.min[axis] = plane;
            let share = self.share * below.longest_side() / self.side();
            let before = (self.before, self.stale + 1);
            let parts = [below, above].map(|bounds| part(&self.program, bounds, share, self.margin, before));
            Halves { axis, plane, parts }
        })
    }

    /// The slopes of the value along rays in the cell with directions from `low` to `high`.
    pub(super) fn slope(&self, low: DVec3, high: DVec3) -> Interval {
        let Bounds { min, max } = self.bounds.inflate(self.margin);
        let zero = Interval::point(0.0);
        let side = |axis: usize| {
            let along = Interval::new(low[axis], high[axis]);
            Dual::new(Interval::new(min[axis], max[axis]), [along, zero, zero])
        };
        self.program.evaluate([side(0), side(1), side(2)], &mut Vec::new()).gradient()[0]
    }

    /// The program for bulk evaluation.
    pub(super) fn tape(&self) -> &Tape {
        self.tape.get_or_init(|| Tape::new(&self.program, &self.bounds.inflate(self.margin)))
    }
}
