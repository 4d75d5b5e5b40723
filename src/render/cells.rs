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
//! Once along each axis a cell is halved even where that is not its longest side, which parts the
//! front of a plate from its back. Where a leaf is long, a cell is halved four times in one go,
//! along the axes that the leaf depends on: it is narrowed to all of the sixteen boxes together. A
//! cell is no larger than what its leaves' boxes leave of it. In a small union of convex leaves
//! rays look for each leaf by itself, in the part of the cell that the leaf may reach, and the
//! nearest crossing counts: nothing is divided further to part the leaves. What else is united with
//! them, as the material of a fillet is, and takes long is looked for last, up to that crossing.
//!
//! Where a solid has fillets or cavities that are searched for, most rays go through a tree without
//! them (`fillets`).
//!
//! All programs of a solid agree on the sign of any point, and the parts of a ray in the boxes
//! abut to the bit, as the crossings with a plane are computed alike on both sides of it: a
//! crossing of the surface at the border of two cells belongs to one of them and is never lost.
//!
//! What is divided when does not change what a part of the tree is, so results do not depend
//! on the order in which rays ask.

use std::sync::{Mutex, OnceLock, PoisonError};

use glam::DVec3;

use super::fillets::Apart;
use super::slopes::Known;
use super::still::Still;
use crate::eval::{BOXES_AT_ONCE, Bend, Program, Region, Tape};
use crate::{Bounds, Rays};

/// The tree.
pub(super) struct Cells {
    root: Part,
    bounds: Bounds,
    /// Boxes are narrowed with this much room on each side, for the rounding of points.
    margin: f64,
    program: Program,
    /// The tree in parts, for parallel rays along which a long leaf does not change.
    still: OnceLock<Option<Box<Still>>>,
    /// The tree without what is searched for, and that.
    apart: OnceLock<Option<Box<Apart>>>,
}

/// A box of the tree.
pub(super) enum Part {
    Inside,
    Outside,
    Cell(Box<Cell>),
    /// A box without a program of its own: its cell was divided more than once in one go.
    Halves(Box<Halves>),
}

/// A box that the surface may cross.
pub(super) struct Cell {
    pub(super) bounds: Bounds,
    pub(super) program: Program,
    /// How the program's value bends along rays, where that is known.
    pub(super) bend: Option<Bend>,
    /// How steep the value is at most, if it tells balls in which nothing is.
    pub(super) rolled: Option<f64>,
    /// Its length along its longest side, in proportion to that of the solid.
    pub(super) share: f64,
    /// How many leaves the program has.
    pub(super) leaves: usize,
    /// What a value takes, in those of ordinary leaves.
    pub(super) cost: usize,
    around: Around,
    slopes: Mutex<Option<([DVec3; 2], Known)>>,
    halves: OnceLock<Halves>,
    united: OnceLock<Option<Vec<Cell>>>,
    tape: OnceLock<Tape>,
}

/// The two parts of a cell, below and above a plane.
pub(super) struct Halves {
    pub(super) axis: usize,
    pub(super) plane: f64,
    pub(super) parts: [Part; 2],
}

impl Halves {
    fn part_of(&self, p: DVec3) -> &Part {
        &self.parts[usize::from(p[self.axis] >= self.plane)]
    }

    /// Calls `visit` with the cells of both parts, the farthest first; `is_above` tells of an axis
    /// and a plane across it whether the part above is the farther one.
    pub(super) fn far_first<'a>(&'a self, is_above: &impl Fn(usize, f64) -> bool, visit: &mut impl FnMut(&'a Cell)) {
        let [below, above] = &self.parts;
        let order = if is_above(self.axis, self.plane) { [above, below] } else { [below, above] };
        for part in order {
            match part {
                Part::Inside | Part::Outside => {}
                Part::Cell(cell) => visit(cell),
                Part::Halves(halves) => halves.far_first(is_above, visit),
            }
        }
    }
}

impl Cells {
    /// The tree of `program`, whose solid lies within `bounds` (finite, of some size).
    pub(super) fn new(program: &Program, bounds: &Bounds) -> Cells {
        let longest = bounds.longest_side();
        // Room around the solid, so that rays start outside of it.
        let bounds = bounds.inflate(0.05 * longest);
        let rounding = 64.0 * f64::EPSILON * (bounds.center().abs().max_element() + bounds.size().length());
        let margin = 1e-9 * longest + rounding;
        Cells::within(program, bounds, margin, [true; 3])
    }

    /// The tree of `program` in a box that is as large as it has to be, halved once along each of
    /// `axes` at first.
    pub(super) fn within(program: &Program, bounds: Bounds, margin: f64, axes: [bool; 3]) -> Cells {
        let around = Around { whole: bounds.longest_side(), margin, cost: usize::MAX, stale: 0, undivided: axes };
        Cells {
            root: part(program, bounds, around),
            bounds,
            margin,
            program: program.clone(),
            still: OnceLock::new(),
            apart: OnceLock::new(),
        }
    }

    /// The tree in parts, if a long leaf does not change along parallel rays.
    pub(super) fn still(&self, rays: &Rays) -> Option<&Still> {
        if rays.meeting_point().is_some() {
            return None;
        }
        let still = self.still.get_or_init(|| {
            let partial = self.program.partial(&self.bounds, DEAR)?;
            Still::new(partial, self.bounds, self.margin).map(Box::new)
        });
        still.as_deref().filter(|still| still.is_along(rays.forward()))
    }

    /// The tree in parts, if it was asked for and there is one.
    pub(super) fn known_still(&self) -> Option<&Still> {
        self.still.get()?.as_deref()
    }

    /// The tree without what is searched for, and that, if there is some.
    pub(super) fn apart(&self) -> Option<&Apart> {
        let apart = self.apart.get_or_init(|| {
            let fillets = self.program.fillets(&self.bounds)?;
            Apart::new(fillets, self.bounds, self.margin).map(Box::new)
        });
        apart.as_deref()
    }

    /// The same, if it was asked for.
    pub(super) fn known_apart(&self) -> Option<&Apart> {
        self.apart.get()?.as_deref()
    }

    /// A program as a cell by itself, as far as the box of all reaches, if it does.
    pub(super) fn part(&self, program: Program) -> Option<Cell> {
        let around = Around {
            whole: self.bounds.longest_side(),
            margin: self.margin,
            cost: usize::MAX,
            stale: 0,
            undivided: [false; 3],
        };
        let bounds = around.clipped(&program, &self.bounds);
        (!bounds.is_empty()).then(|| Cell::new(program, bounds, around))
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
                    if !cell.bounds.contains(p) {
                        return false;
                    }
                    if cell.leaves <= FEW || cell.is_stale() {
                        return cell.program.value(p) > 0.0;
                    }
                    part = cell.halves().part_of(p);
                }
                Part::Halves(halves) => part = halves.part_of(p),
            }
        }
    }
}

/// Cells are divided a little off the middle: planes of symmetry are not planes of the tree.
const MIDDLE: f64 = 0.493;

/// Cells thinner than this, in proportion to their longest side, are not halved across.
const THIN: f64 = 1.0 / 64.0;

/// Programs of at most this many leaves are evaluated at a point rather than narrowed.
const FEW: usize = 4;

/// Boxes with more leaves are narrowed by the leaves' boxes alone.
const CROWD: usize = 24;

/// Unions of more leaves are divided in space.
const UNITED: usize = 8;

/// Cells with a leaf that costs more, in ordinary leaves, are halved more than once in one go: to
/// narrow it to many boxes takes little longer than to narrow it to one. So are those of a crowd
/// whose values are blended: of large boxes a long narrowing tells little, as margins add up.
const DEAR: usize = 8;
const AT_ONCE: u32 = BOXES_AT_ONCE.ilog2();
const CROWD_AT_ONCE: u32 = 5;

/// Where as many halvings have left more than three quarters of the cost, more are of no use.
const STALE: u32 = 6;

/// What is known of the boxes around a box.
#[derive(Clone, Copy)]
struct Around {
    /// The longest side of the box of all.
    whole: f64,
    margin: f64,
    /// What a value takes in one of them, and how many halvings ago.
    cost: usize,
    stale: u32,
    /// The axes along which none of them has been halved.
    undivided: [bool; 3],
}

impl Around {
    /// The halves of a box, and what is known around them: once along each axis it is halved at
    /// first, which parts the front of a plate from its back, then along the longest side across
    /// `axes`.
    fn cut(&self, bounds: &Bounds, axes: [bool; 3]) -> (usize, f64, [Bounds; 2], Around) {
        let size = bounds.size();
        let first = |axis: usize| self.undivided[axis] && size[axis] > THIN * size.max_element();
        let order =
            |a: usize, b: usize| first(a).cmp(&first(b)).then(axes[a].cmp(&axes[b])).then(size[a].total_cmp(&size[b]));
        let axis = (0..3).rev().max_by(|&a, &b| order(a, b)).unwrap_or(0);
        let plane = bounds.min[axis] + MIDDLE * size[axis];
        let (mut below, mut above) = (*bounds, *bounds);
        below.max[axis] = plane;
        above.min[axis] = plane;
        let mut around = Around { stale: self.stale + 1, ..*self };
        around.undivided[axis] = false;
        (axis, plane, [below, above], around)
    }

    /// The boxes that a box is halved into, so many times, with their room.
    fn boxes(&self, bounds: &Bounds, axes: [bool; 3], times: u32, all: &mut Vec<Bounds>) {
        if times == 0 {
            all.push(bounds.inflate(self.margin));
            return;
        }
        let (_, _, halves, around) = self.cut(bounds, axes);
        halves.iter().for_each(|half| around.boxes(half, axes, times - 1, all));
    }

    /// What these boxes hold.
    fn halves(&self, program: &Program, bounds: &Bounds, axes: [bool; 3], times: u32) -> Halves {
        let (axis, plane, halves, around) = self.cut(bounds, axes);
        let parts = halves.map(|half| {
            if times == 1 {
                return part(program, half, around);
            }
            let halves = around.halves(program, &half, axes, times - 1);
            match halves.parts {
                [Part::Inside, Part::Inside] => Part::Inside,
                [Part::Outside, Part::Outside] => Part::Outside,
                _ => Part::Halves(Box::new(halves)),
            }
        });
        Halves { axis, plane, parts }
    }

    /// What of a box the program may have an inside in.
    fn clipped(&self, program: &Program, bounds: &Bounds) -> Bounds {
        program.reach().inflate(self.margin).intersection(bounds)
    }
}

/// What a box holds.
fn part(program: &Program, bounds: Bounds, around: Around) -> Part {
    let room = bounds.inflate(around.margin);
    let found = if program.leaf_count() > CROWD { program.narrow_by_boxes(&room) } else { program.narrow(&room) };
    match found {
        Region::Inside => Part::Inside,
        Region::Outside => Part::Outside,
        Region::Surface(program) => {
            let bounds = around.clipped(&program, &bounds);
            if bounds.is_empty() {
                return Part::Outside;
            }
            let cost = program.cost();
            let less = cost <= around.cost / 4 * 3;
            let around = if less { Around { cost, stale: 0, ..around } } else { around };
            Part::Cell(Box::new(Cell::new(program, bounds, around)))
        }
    }
}

impl Cell {
    fn new(program: Program, bounds: Bounds, around: Around) -> Cell {
        let (bend, leaves, cost) = (program.bend(), program.leaf_count(), program.cost());
        let share = bounds.longest_side() / around.whole;
        let (slopes, tape) = (Mutex::new(None), OnceLock::new());
        let (halves, united) = (OnceLock::new(), OnceLock::new());
        let rolled = program.rolled();
        Cell { bounds, program, bend, rolled, share, leaves, cost, around, slopes, halves, united, tape }
    }

    /// Its length along its longest side.
    pub(super) fn side(&self) -> f64 {
        self.bounds.longest_side()
    }

    /// Whether as many halvings have left the cost what it was that more are of no use.
    pub(super) fn is_stale(&self) -> bool {
        self.around.stale >= STALE
    }

    /// Its halves, made when they are first asked for.
    pub(super) fn halves(&self) -> &Halves {
        self.halves.get_or_init(|| {
            let crowded = (self.leaves > CROWD && self.program.is_blend()).then_some(([true; 3], CROWD_AT_ONCE));
            let dear = self.program.dear_axes(DEAR).map(|axes| (axes, AT_ONCE));
            let (axes, times) = dear.or(crowded).unwrap_or(([true; 3], 1));
            let mut boxes = Vec::new();
            self.around.boxes(&self.bounds, axes, times, &mut boxes);
            if boxes.len() > 2 {
                self.program.prefetch(&boxes);
            }
            self.around.halves(&self.program, &self.bounds, axes, times)
        })
    }

    /// The operands of a union of a few concave values, and perhaps of an expensive one behind
    /// them, each in its part of the cell; they are made when they are first asked for.
    pub(super) fn united(&self) -> Option<&[Cell]> {
        let parts = self.united.get_or_init(|| {
            if self.leaves > UNITED {
                return None;
            }
            let part = |program: Program| {
                let bounds = self.around.clipped(&program, &self.bounds);
                (!bounds.is_empty()).then(|| Cell::new(program, bounds, self.around))
            };
            Some(self.program.united()?.into_iter().filter_map(part).collect())
        });
        parts.as_deref()
    }

    /// The slopes along rays in the cell with directions from `low` to `high`; those last asked for
    /// are kept, as the tiles of an orthographic picture ask for the same.
    pub(super) fn slopes(&self, low: DVec3, high: DVec3) -> Known {
        let mut kept = self.slopes.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some((directions, known)) if *directions == [low, high] => known.clone(),
            _ => {
                let room = self.bounds.inflate(self.around.margin);
                let known = Known::of(&self.program, &room, [low, high]);
                *kept = Some(([low, high], known.clone()));
                known
            }
        }
    }

    /// The halves, if they were asked for.
    pub(super) fn known_halves(&self) -> Option<&Halves> {
        self.halves.get()
    }

    /// The operands of a union, if they were asked for and there are some.
    pub(super) fn known_united(&self) -> Option<&[Cell]> {
        self.united.get()?.as_deref()
    }

    /// The program for bulk evaluation, if it was asked for.
    pub(super) fn known_tape(&self) -> Option<&Tape> {
        self.tape.get()
    }

    /// The program for bulk evaluation.
    pub(super) fn tape(&self) -> &Tape {
        self.tape.get_or_init(|| Tape::new(&self.program, &self.bounds.inflate(self.around.margin)))
    }
}
