//! Where a line crosses the surface, however close together.
//!
//! ```text
//!     |-----------#-----------|     Both ends are on one side. The range of the value over the line, and over halves of
//!     |     |-----#-----|     |     halves of it, tells where the other side may be, down to the last bits: what
//!           |   |-#-|   |           is thinner than any cell is found as well. Where the value rises to the other side from
//!                                   both ends, its slope leads there sooner.
//! ```

use glam::DVec3;

use crate::Bounds;
use crate::eval::Program;

/// So many ranges are looked at along a line.
const RANGES: usize = 400;

/// After so many the slope is no longer asked where to look.
const CLIMBS: usize = 8;

/// Shorter parts of a line, relative to where it is, are not halved.
const SHORTEST: f64 = 1e-15;

/// Nor are those that are shorter than this part of what values may be off.
const OF_GRAIN: f64 = 0.1;

/// A line along an axis.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) from: DVec3,
    pub(super) axis: usize,
    pub(super) length: f64,
}

/// What finds crossings.
#[derive(Clone, Copy)]
pub(super) struct Crossings<'a> {
    pub(super) program: &'a Program,
    /// Values nearer to 0 are of neither side.
    pub(super) rounding: f64,
    /// How far crossings may be off.
    pub(super) precision: f64,
    /// How far values may be off; ranges tell nothing of much shorter parts.
    pub(super) grain: f64,
}

/// A part of a line, and whether its ends are inside.
#[derive(Clone, Copy)]
struct Part {
    ends: [f64; 2],
    inside: [bool; 2],
}

impl Line {
    pub(super) fn at(&self, by: f64) -> DVec3 {
        let mut p = self.from;
        p[self.axis] += by;
        p
    }
}

impl Crossings<'_> {
    /// How far along a line it crosses the surface, in ascending order.
    pub(super) fn of(&self, line: Line) -> Vec<f64> {
        let first = self.program.value(line.at(0.0)) > 0.0;
        let last = self.is_inside(&line, line.length, first);
        let shortest = (SHORTEST * (line.from.abs().max_element() + line.length)).max(OF_GRAIN * self.grain);
        let mut open = vec![Part { ends: [0.0, line.length], inside: [first, last] }];
        let (mut found, mut asked) = (Vec::new(), 0);
        // The lower half is looked at first.
        while let Some(part) = open.pop() {
            let Part { ends: [a, b], inside } = part;
            if inside[0] != inside[1] {
                found.push(self.between(&line, part));
                continue;
            }
            if b - a < shortest || asked == RANGES {
                continue;
            }
            asked += 1;
            let range = self.program.range(&Bounds::new(line.at(a), line.at(b)));
            let is_clear = if inside[0] { range.lo() > -self.rounding } else { range.hi() < self.rounding };
            if is_clear {
                continue;
            }
            let crest = if asked <= CLIMBS { self.crest(&line, part, shortest) } else { None };
            let middle = crest.unwrap_or(0.5 * (a + b));
            let there = self.is_inside(&line, middle, inside[0]);
            open.push(Part { ends: [middle, b], inside: [there, inside[1]] });
            open.push(Part { ends: [a, middle], inside: [inside[0], there] });
        }
        found
    }

    /// A point on the other side, if the slope leads to one.
    fn crest(&self, line: &Line, Part { ends: [mut a, mut b], inside }: Part, shortest: f64) -> Option<f64> {
        // Whether the other side is farther along, as far as the slope tells.
        let is_ahead = |by: f64| {
            let (value, slope) = self.program.gradient(line.at(by));
            (value, (slope[line.axis] > 0.0) != inside[0])
        };
        if !is_ahead(a).1 || is_ahead(b).1 {
            return None;
        }
        while b - a > shortest {
            let middle = 0.5 * (a + b);
            let (value, ahead) = is_ahead(middle);
            if value.abs() > self.rounding && (value > 0.0) != inside[0] {
                return Some(middle);
            }
            if ahead { a = middle } else { b = middle }
        }
        None
    }

    /// Whether a point is inside; near 0, as one beside it is.
    fn is_inside(&self, line: &Line, by: f64, beside: bool) -> bool {
        let value = self.program.value(line.at(by));
        if value.abs() > self.rounding { value > 0.0 } else { beside }
    }

    /// A crossing between ends on two sides.
    fn between(&self, line: &Line, Part { ends: [mut a, mut b], inside }: Part) -> f64 {
        while b - a > self.precision {
            let middle = 0.5 * (a + b);
            if middle <= a || middle >= b {
                break;
            }
            if self.is_inside(line, middle, inside[0]) == inside[0] { a = middle } else { b = middle }
        }
        0.5 * (a + b)
    }
}
