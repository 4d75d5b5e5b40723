//! The sides of a box moved in as far as values tell, one after the other.
//!
//! ```text
//!     +-------+-+ .   of the boxes that may hold some of the inside, the one that reaches farthest is
//!     |     __+-|-.   halved, and what is found empty left out, until the side is no farther out than
//!     +----/--+-+     a point that is inside
//!     |   (   | |
//! ```
//!
//! This is branch and bound, for the largest coordinate of the inside along each axis and against
//! it.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::program::{Kind, Node};
use super::{Program, Region};
use crate::{Bounds, Cancelled, Dual, Interval, Run};
use rvachev_field::Rule;

/// A side is near enough to the solid at this part of the width.
const NEAR: f64 = 1.0 / 1024.0;

/// About as many ordinary leaves are asked about boxes for a side, and at most so many boxes.
const EFFORT: usize = 10_000;
const MOST: usize = 1200;

/// Boxes are this part of the square of their width high: ranges over wider ones tell too little.
const FLAT: f64 = 8.0;

/// A leaf whose values are searched for counts as so many.
const SEARCHED: usize = 50;

/// A box that may hold some of the inside, and the program narrowed to it.
pub(super) struct Part {
    pub(super) bounds: Bounds,
    pub(super) program: Program,
    /// Whether it holds nothing else.
    is_inside: bool,
}

/// The box with the program narrowed to it, if it may hold some of the inside.
pub(super) fn narrowed(bounds: Bounds, program: &Program) -> Option<Part> {
    match program.narrow(&bounds) {
        Region::Outside => None,
        Region::Inside => Some(Part { bounds, program: program.clone(), is_inside: true }),
        Region::Surface(program) => {
            let bounds = clipped(&bounds, &program);
            (!bounds.is_empty()).then_some(Part { bounds, program, is_inside: false })
        }
    }
}

/// The part of a box beyond which the value in the middle and the slopes of the whole show that
/// nothing is inside: behind deformations that tells more than the ranges of the leaves.
///
/// ```text
///     f(x) ≤ f(c) + Σ max sᵢ (xᵢ − cᵢ)    of slopes s within the box, about its middle c
/// ```
fn clipped(bounds: &Bounds, program: &Program) -> Bounds {
    /// More than rounding, in proportion.
    const MARGIN: f64 = 1e-12;
    let is_smooth = |node: &Node| node.valued_by().is_none_or(|leaf| program.instance(leaf).field.is_formula());
    if program.frames.is_empty() || !bounds.is_finite() || program.jumps() || !program.nodes.iter().all(is_smooth) {
        return *bounds;
    }
    let hull = [0, 1, 2].map(|axis| Interval::new(bounds.min[axis], bounds.max[axis]));
    let slopes = program.evaluate(Dual::point(hull), &mut Vec::new()).gradient();
    let (middle, half) = (bounds.center(), 0.5 * bounds.size());
    let rises = DVec3::from_array([0, 1, 2].map(|axis| slopes[axis].magnitude() * half[axis]));
    let rise = rises.element_sum();
    let size = bounds.min.abs().max(bounds.max.abs()).max_element();
    let most = program.value(middle) + MARGIN * (rise + size);
    if most + rise < 0.0 {
        return Bounds::EMPTY;
    }
    let mut left = *bounds;
    for axis in 0..3 {
        let beside = most + (rise - rises[axis]);
        let [up, down] = [slopes[axis], -slopes[axis]].map(|slope| reach(beside, slope) + MARGIN * size);
        if up < half[axis] {
            left.max[axis] = middle[axis] + up;
        }
        if down < half[axis] {
            left.min[axis] = middle[axis] - down;
        }
    }
    left
}

/// The largest t up to which a value of `most` at 0 may be positive, at these slopes.
fn reach(most: f64, slope: Interval) -> f64 {
    if slope.hi() >= 0.0 {
        f64::INFINITY
    } else if most >= 0.0 {
        most / -slope.hi()
    } else {
        most / -slope.lo()
    }
}

/// Whether the box of a solid that its parts tell may be too large: where it is deformed, or edges
/// of end faces are rounded off. Copies are bounded as one of them is, and sweeps by what their
/// profiles reach.
pub(super) fn is_loose(program: &Program) -> bool {
    let frames = || program.frames.iter().filter_map(|&frame| program.scene.frame(frame));
    // Some values are searched for, which is no quick answer.
    let is_formula = |node: &Node| node.valued_by().is_none_or(|leaf| program.instance(leaf).field.is_formula());
    let is_rim = |node: &Node| matches!(node.kind, Kind::Join { rule: Rule::Rounded(_) | Rule::Chamfered(_), .. });
    (frames().any(|frame| !frame.warp.sweeps()) || program.nodes.iter().any(is_rim))
        && !frames().any(|frame| frame.warp.folds())
        && program.nodes.iter().all(is_formula)
}

/// What asking about a box takes, in ordinary leaves.
pub(super) fn toll(program: &Program) -> usize {
    let searched = program.scene.leaves.iter().filter(|leaf| !leaf.field.is_formula()).count();
    program.nodes.len() + program.cost() + 4 * program.frames.len() + SEARCHED * searched
}

/// The box of what is inside in any of the parts.
pub(super) fn moved_in(program: &Program, mut parts: Vec<Part>, run: &Run) -> Result<Bounds, Cancelled> {
    let mut hull = parts.iter().fold(Bounds::EMPTY, |hull, part| hull.union(&part.bounds));
    // Some values are made where they are first asked for, which is no quick answer.
    let leaves = || program.scene.leaves.iter();
    if leaves().any(|leaf| !leaf.field.is_formula() && !leaf.bounds.is_finite() && !leaf.bounds.is_empty()) {
        return Ok(hull);
    }
    let most = (EFFORT / toll(program)).min(MOST);
    for axis in 0..3 {
        for (nth, is_top) in [false, true].into_iter().enumerate() {
            run.report((2 * axis + nth) as f64 / 6.0);
            if hull.is_empty() {
                return Ok(Bounds::EMPTY);
            }
            let direction = if is_top { DVec3::AXES[axis] } else { -DVec3::AXES[axis] };
            let mut side = Side { axis, direction, width: hull.size(), reached: f64::NEG_INFINITY };
            let farthest = side.farthest(&mut parts, most, run)?;
            if is_top {
                hull.max[axis] = hull.max[axis].min(farthest);
            } else {
                hull.min[axis] = hull.min[axis].max(-farthest);
            }
        }
    }
    Ok(hull)
}

/// The search for how far the inside reaches in a direction along an axis.
struct Side {
    axis: usize,
    direction: DVec3,
    /// That of the box.
    width: DVec3,
    /// As far a point is known to be inside.
    reached: f64,
}

impl Side {
    /// No point of the parts that is inside is farther than this.
    fn farthest(&mut self, parts: &mut Vec<Part>, most: usize, run: &Run) -> Result<f64, Cancelled> {
        let mut heap: BinaryHeap<Candidate> = parts.drain(..).map(|part| self.candidate(part)).collect();
        // Nearer to a point that is inside no side is moved.
        let near = NEAR * self.width[self.axis];
        let mut asked = 0;
        let farthest = loop {
            let Some(top) = heap.pop() else { break f64::NEG_INFINITY };
            let reach = top.reach;
            if reach - self.reached <= near || top.part.is_inside || asked >= most {
                heap.push(top);
                break reach;
            }
            asked += 2;
            run.check()?;
            for half in halves(&top.part.bounds, self.across(&top.part.bounds)) {
                if let Some(part) = narrowed(half, &top.part.program) {
                    heap.push(self.candidate(part));
                }
            }
        };
        parts.extend(heap.into_iter().map(|candidate| candidate.part));
        Ok(farthest)
    }

    /// The axis across which a box is halved. A surface that is farthest in a point falls with the
    /// square of the distance from there, so that flat boxes hold it best.
    fn across(&self, bounds: &Bounds) -> usize {
        let part = (bounds.size() / self.width.max(DVec3::splat(f64::MIN_POSITIVE))).to_array();
        let [a, b] = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        let beside = if part[a] >= part[b] { a } else { b };
        if part[self.axis] >= FLAT * part[beside] * part[beside] { self.axis } else { beside }
    }

    fn candidate(&mut self, part: Part) -> Candidate {
        let reach = self.direction.dot(part.bounds.min).max(self.direction.dot(part.bounds.max));
        if reach > self.reached && part.bounds.is_finite() {
            self.look(&part, reach);
        }
        Candidate { reach, size: part.bounds.size().length_squared(), part }
    }

    /// Looks for a point that is inside on the line through the middle of a part.
    fn look(&mut self, part: &Part, reach: f64) {
        const STEPS: usize = 8;
        let middle = part.bounds.center();
        let along = self.direction.dot(middle);
        let is_inside = |by: f64| part.is_inside || part.program.value(middle + self.direction * by) > 0.0;
        let (mut inside, mut beyond) = (0.0, reach - along);
        if !is_inside(inside) {
            return;
        }
        for _ in 0..STEPS {
            if along + beyond <= self.reached {
                return;
            }
            let by = 0.5 * (inside + beyond);
            if is_inside(by) { inside = by } else { beyond = by }
        }
        self.reached = self.reached.max(along + inside);
    }
}

/// A part, in the order of how far it reaches; of those that reach equally far the smallest first.
struct Candidate {
    reach: f64,
    size: f64,
    part: Part,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Candidate) -> Ordering {
        self.reach.total_cmp(&other.reach).then(other.size.total_cmp(&self.size))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Candidate {}

/// A box in two, across an axis.
pub(super) fn halves(bounds: &Bounds, axis: usize) -> [Bounds; 2] {
    let middle = bounds.center()[axis];
    let (mut low, mut high) = (*bounds, *bounds);
    low.max[axis] = middle;
    high.min[axis] = middle;
    [low, high]
}
