//! Blades, ribs and gaps thinner than the cells of a mesh: followed over one side of each cell.
//!
//! ```text
//!      |   |   |   |      Lines across a cell find what is thinner than any distance between nodes, both faces of
//!     _|___|___|   |      it, or one where these are as good as one. Between four lines there are triangles where all
//!      |   |   | . |      find as much; where some find nothing there is a rim, which is sought on the way
//!      |   |   |   |      from one to the next. Squares in which triangles are off are divided into four.
//! ```

use glam::DVec3;

use super::column::{Crossings, Line};
use super::quilt::{KNOWN, Quilt};
use crate::eval::Region;
use crate::mesh::{Hidden, Slopes, Subject, reached};
use crate::{Bounds, Cancelled, Run};
use rvachev_field::{Patch, Patches};
use rvachev_num::{jobs, order};

/// Nearer to the surface than this part of the size, points may be on either side by rounding
/// errors.
const ROUNDING: f64 = 1e-9;

/// Lines go on beyond a cell by this part of it: sheets are not always straight across.
const BEYOND: f64 = 0.75;

/// How often a side of a cell is halved.
const DEEPEST: u32 = 7;

/// And where something is known to be and is not found.
const SURELY: u32 = 2;

/// Lines through a cell, more or less.
const LINES: u32 = 5000;

/// Crossings are found to this part of the tolerance, and the ends of sheets to this one.
const PRECISE: f64 = 0.02;
const RIM: f64 = 0.2;

/// What is nearer together than this part of the tolerance is one sheet.
const ONE: f64 = 0.5;

/// A triangle and how far it is off.
type Found = (Patch, f64);

/// Adds to a quilt what is hidden in cells, as far as it is `near`: of what is beyond, patches are
/// not known. Values may be off by `grain`. Gives the cells that have some left.
pub(super) fn cover(
    quilt: &mut Quilt,
    (subject, near): (&Subject<'_>, &Bounds),
    hidden: &[Hidden],
    slopes: &Slopes<'_>,
    [tolerance, grain]: [f64; 2],
    run: &Run,
) -> Result<Vec<Bounds>, Cancelled> {
    if hidden.is_empty() {
        return Ok(Vec::new());
    }
    let alone = Run { progress: None, ..run.clone() };
    let known = Patches::new(&quilt.patches, &alone)?;
    let rounding = ROUNDING * subject.bounds.longest_side();
    let of_cell = |Hidden { cell, is_sure }: &Hidden| {
        run.check()?;
        let reach = cell.inflate(BEYOND * cell.longest_side());
        let Region::Surface(program) = slopes.program.narrow(&reach) else {
            return Ok((Vec::new(), None));
        };
        let crossings = Crossings { program: &program, rounding, precision: PRECISE * tolerance, grain };
        let is_sure = *is_sure || subject.has_inner(cell, &program);
        let lines = LINES.into();
        let bounds = cell.intersection(near);
        let own = Cell { crossings, tolerance, bounds, near, is_sure: is_sure.into(), known: &known, lines, run };
        let found = own.sheets();
        run.check()?;
        // What is beyond may be all that is hidden.
        let is_missed = own.is_sure.get() && found.is_empty() && near.contains_bounds(cell);
        Ok((found, is_missed.then_some(*cell)))
    };
    let found = jobs::try_in_order(hidden.len(), |n| of_cell(&hidden[n]))?;
    let (found, missed): (Vec<Vec<Found>>, Vec<Option<Bounds>>) = found.into_iter().unzip();
    let sheets: Vec<Patch> = found.iter().flatten().map(|(patch, _)| *patch).collect();
    quilt.add_all(found.into_iter().flatten());
    // What ends beside a sheet, or beside what the cells show, is part of that.
    let sheets = Patches::new(&sheets, &alone)?;
    let is_left =
        |cell: &Bounds| ![&known, &sheets].iter().any(|near| near.is_within(cell.center(), cell.longest_side()));
    Ok(missed.into_iter().flatten().filter(is_left).collect())
}

/// A cell that hides something.
struct Cell<'a> {
    crossings: Crossings<'a>,
    tolerance: f64,
    bounds: Bounds,
    /// Where patches are known.
    near: &'a Bounds,
    /// Whether there is something in it that is not known: what is known may be all that there is.
    is_sure: std::cell::Cell<bool>,
    known: &'a Patches,
    /// How many more lines are to be looked at.
    lines: std::cell::Cell<u32>,
    /// When it is cancelled nothing more is found.
    run: &'a Run,
}

/// Where a line crosses sheets, each the mean of faces that are one.
#[derive(Clone, Debug, Default)]
struct Hits {
    points: Vec<DVec3>,
}

/// A side of a cell or a part of it, seen along an axis.
#[derive(Clone, Copy)]
struct Square {
    /// One corner, at the start of lines.
    from: DVec3,
    /// The sides.
    sides: [DVec3; 2],
    axis: usize,
    length: f64,
}

impl Square {
    fn line(&self, [u, v]: [f64; 2]) -> Line {
        Line { from: self.from + u * self.sides[0] + v * self.sides[1], axis: self.axis, length: self.length }
    }

    /// Four of half the size.
    fn quarters(&self) -> [Square; 4] {
        let sides = self.sides.map(|side| 0.5 * side);
        CORNERS.map(|[u, v]| Square { from: self.from + u * sides[0] + v * sides[1], sides, ..*self })
    }

    fn size(&self) -> f64 {
        self.sides[0].length()
    }
}

/// The corners of a square, in their order around it.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

impl Cell<'_> {
    /// The sheets in it.
    fn sheets(&self) -> Vec<Found> {
        let (_, slope) = self.crossings.program.gradient(self.bounds.center());
        let slope = slope.abs();
        let mut axes = [0, 1, 2];
        order::falling(&mut axes, |a| slope[*a]);
        let mut found = Vec::new();
        // Beside a rim the slope leads there, and not across the sheet.
        for (nth, axis) in axes.into_iter().enumerate() {
            if nth > 0 && !self.is_sure.get() {
                break;
            }
            let size = self.bounds.size();
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|side| DVec3::AXES[side] * size[side]);
            let mut from = self.bounds.min;
            from[axis] = (from[axis] - BEYOND * size[axis]).max(self.near.min[axis]);
            let length = (self.bounds.max[axis] + BEYOND * size[axis]).min(self.near.max[axis]) - from[axis];
            self.look(&Square { from, sides: [u, v], axis, length }, 0, &mut found);
            if !found.is_empty() {
                break;
            }
        }
        found
    }

    /// The triangles of a square, and of the squares around its middle if nothing is found there
    /// that is known to be.
    fn look(&self, square: &Square, depth: u32, found: &mut Vec<Found>) {
        let middle = self.hits(square, [0.5, 0.5]);
        let corners = CORNERS.map(|at| self.hits(square, at));
        if corners.iter().chain([&middle]).any(|hits| !hits.points.is_empty()) {
            self.follow(square, (&corners, &middle), depth, found);
        } else if self.is_sure.get() && depth < SURELY {
            square.quarters().iter().for_each(|quarter| self.look(quarter, depth + 1, found));
        }
    }

    fn hits(&self, square: &Square, at: [f64; 2]) -> Hits {
        self.lines.set(self.lines.get().saturating_sub(1));
        let line = square.line(at);
        let found = if self.run.check().is_ok() { self.crossings.of(line) } else { Vec::new() };
        let mut points = Vec::new();
        let mut left = &found[..];
        while let [first, rest @ ..] = left {
            let same = rest.iter().take_while(|by| *by - first < ONE * self.tolerance).count();
            let p = line.at(0.5 * (first + left[same]));
            if !self.known.is_within(p, KNOWN * self.tolerance) {
                points.push(p);
            } else if reached(&self.bounds).contains(p) {
                self.is_sure.set(false);
            }
            left = &left[same + 1..];
        }
        Hits { points }
    }

    /// The triangles of a square, given what is found at its corners and in the middle.
    fn follow(&self, square: &Square, (corners, middle): (&[Hits; 4], &Hits), depth: u32, found: &mut Vec<Found>) {
        let all = || corners.iter().chain([middle]);
        let most = all().map(|hits| hits.points.len()).max().unwrap_or(0);
        let is_deep = depth == DEEPEST || self.lines.get() == 0;
        // Where both faces of a sheet are one elsewhere in the square, they are so here.
        let of = |hits: &Hits, n: usize| hits.points[n.min(hits.points.len() - 1)];
        if all().all(|hits| hits.points.len() == most || hits.points.len() == 1 && most == 2) {
            let sag = |n: usize| (corners.iter().map(|hits| of(hits, n)).sum::<DVec3>() / 4.0).distance(of(middle, n));
            let sag = (0..most).map(sag).fold(0.0, f64::max);
            if sag <= self.tolerance || is_deep {
                for n in 0..most {
                    let rim = [0, 1, 2, 3].map(|corner: usize| of(&corners[corner], n));
                    fan(&rim, (sag > 0.3 * self.tolerance).then_some(of(middle, n)), sag, found);
                }
                return;
            }
        } else if let Some(rims) = self.rim(square, (corners, middle), most) {
            found.extend(rims);
            return;
        } else if is_deep {
            // Where something is, to within the square.
            let tiny = PRECISE * self.tolerance / square.size();
            let spot = |p: &DVec3| {
                let corners = [*p, *p + tiny * square.sides[0], *p + tiny * square.sides[1]];
                (Patch::flat(corners), 1.5 * square.size())
            };
            found.extend(all().flat_map(|hits| &hits.points).map(spot));
            return;
        }
        let [bottom, right, top, left] =
            [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]].map(|at| self.hits(square, at));
        let [a, b, c, d] = corners.clone();
        let parts = [
            [a, bottom.clone(), middle.clone(), left.clone()],
            [bottom, b, right.clone(), middle.clone()],
            [middle.clone(), right, c, top.clone()],
            [left, middle.clone(), top, d],
        ];
        for (quarter, corners) in square.quarters().iter().zip(&parts) {
            let middle = self.hits(quarter, [0.5, 0.5]);
            let is_empty = |hits: &Hits| hits.points.is_empty();
            if !(is_empty(&middle) && corners.iter().all(is_empty)) {
                self.follow(quarter, (corners, &middle), depth + 1, found);
            }
        }
    }

    /// The triangles of a square with so many sheets that end in it, if their rim is straight.
    fn rim(&self, square: &Square, (corners, middle): (&[Hits; 4], &Hits), count: usize) -> Option<Vec<Found>> {
        let has = |hits: &Hits| hits.points.len() == count;
        // Where there are others as well, it is not so simple.
        let is_simple = |hits: &Hits| hits.points.is_empty() || has(hits);
        if !corners.iter().chain([middle]).all(is_simple) {
            return None;
        }
        let is_in = [0, 1, 2, 3].map(|n: usize| has(&corners[n]));
        let changes: Vec<usize> = (0..4).filter(|n| is_in[*n] != is_in[(n + 1) % 4]).collect();
        let [first, second] = changes[..] else { return None };
        let mut polygon: Vec<Hits> = Vec::with_capacity(6);
        let (mut ends, mut rims) = (Vec::with_capacity(2), Vec::with_capacity(2));
        for n in 0..4 {
            let next = (n + 1) % 4;
            if is_in[n] {
                polygon.push(corners[n].clone());
            }
            if n == first || n == second {
                let (inner, outer) = if is_in[n] { (n, next) } else { (next, n) };
                let (at, hits) = self.end(square, (CORNERS[inner], corners[inner].clone()), CORNERS[outer]);
                ends.push(at);
                polygon.push(hits.clone());
                rims.push(hits);
            }
        }
        // Half way along the rim it is not far from the straight line.
        let [[au, av], [bu, bv]] = [ends[0], ends[1]];
        let length = f64::hypot(bu - au, bv - av).max(f64::MIN_POSITIVE);
        let step = 2.0 * self.tolerance / (square.size() * length);
        let beside = |by: f64| {
            let [u, v] = [0.5 * (au + bu) + by * (bv - av), 0.5 * (av + bv) - by * (bu - au)];
            has(&self.hits(square, [u, v]))
        };
        if length * square.size() > 4.0 * self.tolerance && beside(step) == beside(-step) {
            return None;
        }
        let mut found = Vec::new();
        for n in 0..count {
            let rim: Vec<DVec3> = polygon.iter().map(|hits| hits.points[n]).collect();
            let centre = rim.iter().sum::<DVec3>() / rim.len() as f64;
            let away = centre - square.from;
            let there = self.hits(square, square.sides.map(|side| away.dot(side) / side.length_squared()));
            let sag = there.points.iter().map(|p| p.distance(centre)).fold(f64::INFINITY, f64::min);
            if sag > self.tolerance {
                return None;
            }
            fan(&rim, None, sag.max(RIM * self.tolerance), &mut found);
        }
        // What is between the faces of a sheet where it ends.
        for n in (1..count).step_by(2) {
            let [[a, b], [c, d]] = [0, 1].map(|end: usize| [rims[end].points[n - 1], rims[end].points[n]]);
            let middle = 0.25 * (a + b + c + d);
            let (value, slope) = self.crossings.program.gradient(middle);
            let off = (value.abs() / slope.length()).min(a.distance(b));
            fan(&[a, b, d, c], None, off.max(RIM * self.tolerance), &mut found);
        }
        Some(found)
    }

    /// Where sheets end on the way from a line that finds them to one that does not.
    fn end(&self, square: &Square, (mut inner, mut last): ([f64; 2], Hits), mut outer: [f64; 2]) -> ([f64; 2], Hits) {
        let count = last.points.len();
        while f64::hypot(inner[0] - outer[0], inner[1] - outer[1]) * square.size() > RIM * self.tolerance {
            let middle = [0, 1].map(|i| 0.5 * (inner[i] + outer[i]));
            let hits = self.hits(square, middle);
            if hits.points.len() == count { (inner, last) = (middle, hits) } else { outer = middle }
        }
        (inner, last)
    }
}

/// The triangles of a convex polygon: about its middle, if that is given, else from its first
/// corner.
fn fan(rim: &[DVec3], middle: Option<DVec3>, off: f64, found: &mut Vec<Found>) {
    let mut push = |corners: [DVec3; 3]| found.push((Patch::flat(corners), off));
    match middle {
        Some(middle) => (0..rim.len()).for_each(|n| push([middle, rim[n], rim[(n + 1) % rim.len()]])),
        None => (2..rim.len()).for_each(|n| push([rim[0], rim[n - 1], rim[n]])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::compiled_with;

    /// Once what is known is met, nothing else is sure to be there.
    #[test]
    fn what_is_known_is_not_looked_for_again() {
        let block = Solid::cuboid([4.0, 4.0, 2.0]);
        let program = compiled_with(&block, &Run::default()).unwrap().surface.clone();
        let top = [[-2.0, -2.0, 1.0], [2.0, -2.0, 1.0], [2.0, 2.0, 1.0]].map(DVec3::from_array);
        let known = Patches::new(&[Patch::flat(top)], &Run::default()).unwrap();
        let run = Run::default();
        let crossings = Crossings { program: &program, rounding: 1e-9, precision: 1e-6, grain: 0.0 };
        // The face is in the cell to within rounding, and no node is outside.
        let bounds = Bounds::new(DVec3::new(0.5, -0.5, 0.9), DVec3::new(0.6, -0.4, 1.0 - 1e-6));
        let is_sure = true.into();
        let near = &Bounds::ALL;
        let known = &known;
        let lines = LINES.into();
        let cell = Cell { crossings, tolerance: 1e-3, bounds, near, is_sure, known, lines, run: &run };
        assert!(cell.sheets().is_empty());
        assert!(!cell.is_sure.get() && cell.lines.get() == LINES - 5, "{:?}", cell.lines);
    }

    #[test]
    fn a_cell_is_left_when_its_run_is_cancelled() {
        let sheet = Solid::cuboid([4.0, 4.0, 0.01]).translate([0.0, 0.0, 0.3]);
        let program = compiled_with(&sheet, &Run::default()).unwrap().surface.clone();
        let known = Patches::new(&[], &Run::default()).unwrap();
        let run = Run::default();
        let crossings = Crossings { program: &program, rounding: 1e-9, precision: 1e-6, grain: 0.0 };
        let bounds = Bounds::new(DVec3::ZERO, DVec3::ONE);
        let cell = Cell {
            crossings,
            tolerance: 1e-3,
            bounds,
            near: &Bounds::ALL,
            is_sure: true.into(),
            known: &known,
            lines: LINES.into(),
            run: &run,
        };
        assert!(!cell.sheets().is_empty());
        run.cancel.cancel();
        cell.lines.set(LINES);
        assert!(cell.sheets().is_empty());
    }
}
