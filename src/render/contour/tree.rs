//! The squares of a plane that the surface crosses, as large as they can be.
//!
//! ```text
//!     +-------+---+---+      A square is left alone where ranges show one sign. It is small enough where the solid
//!     |       |  _|.-'|      is entered, and not left, all along one direction: the contour is a graph over the
//!     |       +-'-+---+      other one. At corners of a contour, and where two come close, squares are halved until
//!     |     .'|   |   |      they are as small as the tolerance.
//!     +-------+---+---+
//! ```
//!
//! No contour is missed between squares that are small enough. One that crosses no side so that it
//! shows at a corner would be in two squares that share a side; its normals are within 60° of one
//! direction in the one and of another in the other, but those of a closed curve are all there are.

use std::collections::HashMap;
use std::ops::Range;

use rvachev_num::{Meter, jobs};

use super::section::{Entry, Filling, Section};
use super::spread::Spread;
use super::square::{Node, Root, Square};
use crate::eval::Program;
use crate::{Cancelled, Run};

/// So many squares of a plane are divided in a task at most: with slopes that do not tell, contours
/// of a fine tolerance would have no end.
const MOST: usize = 1 << 16;

/// So many squares are looked at by one thread after the other, before all go on with what is left.
const TASKS: usize = 256;

/// A square that the surface may cross.
pub(super) struct Leaf {
    pub(super) square: Square,
    pub(super) filling: Filling,
    /// Where the solid is entered, and not left, all over it, if there is such a direction.
    pub(super) way: Option<Entry>,
}

/// What is found of one plane.
#[derive(Default)]
pub(super) struct Found {
    pub(super) leaves: Vec<Leaf>,
    /// Which corners are inside, by their keys: what was told last, where rounding differs.
    inside: HashMap<u64, bool, Spread>,
    /// How many squares were divided.
    divided: usize,
}

impl Found {
    /// Whether a corner is inside; `None` of what is no corner.
    pub(super) fn is_inside(&self, node: Node) -> Option<bool> {
        self.inside.get(&key(node)).copied()
    }
}

/// A corner as one number.
pub(super) fn key([x, y]: Node) -> u64 {
    u64::from(x) << 32 | u64::from(y)
}

/// The planes, from the lowest, and what is asked of them.
pub(super) struct Tree<'a> {
    pub(super) sections: &'a [Section],
    /// Their heights above the first.
    pub(super) heights: &'a [f64],
    pub(super) root: Root,
    /// Squares are not halved below this side.
    pub(super) finest: f64,
    pub(super) run: &'a Run,
}

/// A square of some of the planes.
struct Task {
    square: Square,
    planes: Range<usize>,
    filling: Filling,
}

/// What comes of looking at a task.
enum Next {
    Nothing,
    Leaf(Leaf),
    Tasks(Vec<Task>),
}

type Part = HashMap<usize, Found, Spread>;

impl Tree<'_> {
    /// What is found of each plane.
    pub(super) fn found(&self, program: &Program) -> Result<Vec<Found>, Cancelled> {
        let planes = 0..self.sections.len();
        let (mut first, square) = (Part::default(), self.root.square());
        let filling = Filling::Program(program.clone());
        for plane in planes.clone() {
            self.note(&mut first, plane, &filling, square.corners());
        }
        let mut tasks = vec![Task { square, planes, filling }];
        while !tasks.is_empty() && tasks.len() < TASKS {
            let mut after = Vec::new();
            for task in tasks {
                self.run.check()?;
                let planes = task.planes.clone();
                match self.look(task, &mut first) {
                    Next::Nothing => {}
                    Next::Leaf(leaf) => first.entry(planes.start).or_default().leaves.push(leaf),
                    Next::Tasks(tasks) => after.extend(tasks),
                }
            }
            tasks = after;
        }
        let meter = Meter::new(self.run, tasks.len());
        let all_of = |task| {
            let part = self.all_of(task)?;
            meter.add(1);
            Ok(part)
        };
        let parts: Vec<Part> = jobs::try_taking(tasks, all_of)?;
        let mut found: Vec<Found> = Vec::new();
        found.resize_with(self.sections.len(), Found::default);
        for part in std::iter::once(first).chain(parts) {
            for (plane, own) in part {
                found[plane].leaves.extend(own.leaves);
                found[plane].inside.extend(own.inside);
            }
        }
        Ok(found)
    }

    /// All that comes of a task.
    fn all_of(&self, task: Task) -> Result<Part, Cancelled> {
        let mut part = Part::default();
        let mut pending = vec![task];
        while let Some(task) = pending.pop() {
            self.run.check()?;
            let plane = task.planes.start;
            match self.look(task, &mut part) {
                Next::Nothing => {}
                Next::Leaf(leaf) => part.entry(plane).or_default().leaves.push(leaf),
                Next::Tasks(tasks) => pending.extend(tasks.into_iter().rev()),
            }
        }
        Ok(part)
    }

    fn look(&self, task: Task, part: &mut Part) -> Next {
        let Task { square, planes, filling } = task;
        let section = &self.sections[planes.start];
        let height = self.heights[planes.end - 1] - self.heights[planes.start];
        let Some(filling) = section.filling(&filling, &square, [0.0, height]) else { return Next::Nothing };
        // Planes that are far from each other part before squares do, and those whose squares are
        // small enough.
        if planes.len() > 1 && (height > 0.5 * square.side || section.way_in(&filling, &square).is_some()) {
            let middle = planes.start + planes.len() / 2;
            let halves = [planes.start..middle, middle..planes.end];
            let task = |planes| Task { square, planes, filling: filling.clone() };
            return Next::Tasks(halves.map(task).into());
        }
        let mut filling = filling;
        if planes.len() == 1 {
            let way = section.way_in(&filling, &square);
            if way.is_none()
                && let Some(inside) = section.flush(&filling, &square)
            {
                if !inside || section.holds(&square) {
                    return Next::Nothing;
                }
                filling = Filling::Solid;
            }
            let is_last = square.side <= self.finest || square.size <= 1;
            let divided = part.get(&planes.start).map_or(0, |found| found.divided);
            if way.is_some() || is_last || divided >= MOST {
                return Next::Leaf(Leaf { square, filling, way });
            }
        }
        for plane in planes.clone() {
            part.entry(plane).or_default().divided += 1;
            self.note(part, plane, &filling, square.added());
        }
        let task = |square| Task { square, planes: planes.clone(), filling: filling.clone() };
        Next::Tasks(square.quarters(&self.root).map(task).into())
    }

    /// Notes which corners are inside on a plane.
    fn note<const N: usize>(&self, part: &mut Part, plane: usize, filling: &Filling, nodes: [Node; N]) {
        let is_inside = |node| (key(node), self.sections[plane].is_inside(filling, self.root.point(node)));
        part.entry(plane).or_default().inside.extend(nodes.map(is_inside));
    }
}
