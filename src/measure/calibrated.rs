//! The area of a solid, within bounds that are certain.
//!
//! ```text
//!      N₁  |  N₂        Through the surface S in a cell flows as much of a constant field N as goes in
//!     ↗    |   ↑        by the parts of the cell's sides that are inside the solid. If no normal of S is
//!    ______|_____       turned from N, a unit vector, by more than θ, that is between cos θ and 1 of its
//!          | S          area. Of a side between two cells counts the difference of their fields, which
//!    inside|            is as small as the cells are: so that both bounds are off by the square of that.
//! ```
//!
//! With `A` the area of a side that is inside, `e` across it from one cell to the next, and w the
//! reciprocal of the cosine, the area of the surface is
//!
//! ```text
//!     at least  Σ A (N₂ − N₁)·e       at most  Σ A (w₂ N₂ − w₁ N₁)·e
//! ```
//!
//! over all sides. Sides beside what is all inside or outside are known, of others it is known
//! [what they have inside](super::section) at least and at most. N may be any unit vector for the
//! lower bound, as in a calibration (Harvey and Lawson, *Calibrated geometries*, 1982). At creases,
//! where normals are turned much, each piece of the surface is
//! [looked at by itself](super::section); the field is 0 there.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::integral::unfolded;
use super::pieces::{Facing, pieces};
use super::section::{area_inside, area_shown};
use crate::eval::Narrowed;
use crate::program::Program;
use crate::space::{Block, Grid, surface_blocks};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::{jobs, order};

/// Cells along the longest side at first, and how many there may be: more take seconds.
const FIRST: f64 = 12.0;
const MOST: usize = 1 << 14;

/// Cells that nothing is known of are divided so often at most, and no further where of what was
/// not known, by the areas of their sides, more than this part is not known after it either: what
/// is not known of then is not told by smaller ones.
const DEEPEST: u8 = 8;
const VAIN: f64 = 0.9;

/// Cells begin so much before the box, as a part of their side, that hardly ever a face is in a
/// side of one.
const ASIDE: f64 = 0.061_803_4;

/// Where what normals are turned leaves open is less than this part of the area, flows tell it.
const FLAT: f64 = 0.02;

/// Of what may be left open this much is left to cells that are not divided.
const LEFT: f64 = 0.5;

/// The place of a cell, counted in cells of its size, and how often it was halved.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Place {
    halvings: u8,
    at: [i64; 3],
}

impl Place {
    fn beside(self, axis: usize, by: i64) -> Place {
        let mut place = self;
        place.at[axis] += by;
        place
    }

    fn above(self) -> Option<Place> {
        Some(Place { halvings: self.halvings.checked_sub(1)?, at: self.at.map(|at| at.div_euclid(2)) })
    }

    fn octants(self) -> impl Iterator<Item = Place> {
        let low = self.at.map(|at| 2 * at);
        (0..8).map(move |n| Place {
            halvings: self.halvings + 1,
            at: [low[0] + (n & 1), low[1] + (n >> 1 & 1), low[2] + (n >> 2 & 1)],
        })
    }

    fn bounds(self, grid: &Grid) -> Bounds {
        let side = grid.side * 0.5f64.powi(i32::from(self.halvings));
        let corner = |by: i64| grid.origin + side * DVec3::from_array(self.at.map(|at| (at + by) as f64));
        Bounds::new(corner(0), corner(1))
    }

    /// The side towards higher coordinates of an axis.
    fn side(self, axis: usize, grid: &Grid) -> Bounds {
        let mut bounds = self.bounds(grid);
        bounds.min[axis] = bounds.max[axis];
        bounds
    }
}

/// A cell that the surface may cross.
struct Cell {
    place: Place,
    program: Program,
    /// What flows through the surface tells its area, if this is known.
    facing: Option<Facing>,
    /// Else it is at least and at most this.
    area: [f64; 2],
}

impl Cell {
    fn new(place: Place, program: Program, grid: &Grid) -> Cell {
        let bounds = place.bounds(grid);
        let program = unfolded(program, &bounds);
        let Some(pieces) = pieces(&program, &bounds) else {
            return Cell { place, program, facing: None, area: [0.0, f64::INFINITY] };
        };
        let facing = Facing::of(&pieces);
        // What little of it is turned does not pay.
        let side = bounds.size().max_element();
        let by_flow = facing.map_or(f64::INFINITY, |Facing { cosine, .. }| (1.0 / cosine - 1.0) * side * side);
        if by_flow <= FLAT * side * side {
            return Cell { place, program, facing, area: [0.0; 2] };
        }
        let area = area_shown(&program, &pieces, &bounds);
        if facing.is_none() || area[1] - area[0] < by_flow {
            Cell { place, program, facing: None, area }
        } else {
            Cell { place, program, facing, area: [0.0; 2] }
        }
    }

    fn is_unknown(&self) -> bool {
        self.area[1].is_infinite()
    }

    /// The fields of the lower bound and of the upper one.
    fn fields(&self) -> [DVec3; 2] {
        self.facing.map_or([DVec3::ZERO; 2], |Facing { normal, cosine }| [normal, normal / cosine])
    }
}

/// The sides between cells, and what they have inside.
type Sides = HashMap<(Place, usize), [f64; 2]>;

/// What is known so far.
struct Sums {
    least: f64,
    most: f64,
    /// What each cell leaves open.
    open: Vec<f64>,
}

/// Bounds of the area of a program's surface, which is nowhere but in a box, as near to each other
/// as is asked; nothing if that takes too many cells, as far as the last round tells.
pub(super) fn area(
    program: &Program,
    bounds: &Bounds,
    tolerance: f64,
    run: &Run,
) -> Result<Option<[f64; 2]>, Cancelled> {
    let [to_find, to_divide] = run.stages([0.1, 0.9]);
    let side = bounds.longest_side() / FIRST;
    let margin = DVec3::splat(ASIDE * side);
    let blocks = ((bounds.size() + margin) / side).to_array().map(|count| (count.ceil() as u32).max(1));
    let grid = Grid { origin: bounds.min - margin, side, blocks };
    let found = surface_blocks(program, &grid, 0.0, &to_find)?;
    let cell = |block: &Block| {
        let place = Place { halvings: 0, at: block.index.map(i64::from) };
        Ok(Cell::new(place, found.programs[block.program as usize].clone(), &grid))
    };
    let mut cells = jobs::try_in_order(found.blocks.len(), |n| cell(&found.blocks[n]))?;
    let (mut divided, mut sides) = (HashSet::new(), Sides::new());
    let (mut begun, mut unknown) = (f64::NAN, f64::INFINITY);
    let mut last = (0.0, f64::INFINITY);
    loop {
        run.check()?;
        let sums = sums(&cells, &divided, &mut sides, &grid);
        let (open, enough) = (sums.most - sums.least, tolerance * (sums.most + sums.least));
        if begun.is_nan() && open.is_finite() {
            begun = open;
        }
        to_divide.report((begun / open).ln().max(0.0) / (begun / enough).ln().max(1.0));
        let of_side = |cell: &Cell| 0.25f64.powi(i32::from(cell.place.halvings));
        let before = std::mem::replace(&mut unknown, cells.iter().filter(|cell| cell.is_unknown()).map(of_side).sum());
        let is_vain =
            unknown > VAIN * before || cells.iter().any(|cell| cell.is_unknown() && cell.place.halvings >= DEEPEST);
        if open.is_finite() && open <= enough {
            return Ok(Some([sums.least, sums.most]));
        }
        if is_vain || cells_needed([last, (cells.len() as f64, open)], enough) > MOST as f64 {
            return Ok(None);
        }
        last = (cells.len() as f64, open);
        // While some are unknown, these are divided, and no others.
        let chosen = chosen(&sums.open, (LEFT * enough).min(f64::MAX));
        let eighths = |n: usize| {
            run.check()?;
            let Cell { place, program, .. } = &cells[chosen[n]];
            let parts = place.octants().filter_map(|part| match program.narrowed(&part.bounds(&grid)) {
                Narrowed::Inside | Narrowed::Outside => None,
                Narrowed::Same => Some(Cell::new(part, program.clone(), &grid)),
                Narrowed::Simpler(simpler) => Some(Cell::new(part, simpler, &grid)),
            });
            Ok(parts.collect::<Vec<Cell>>())
        };
        let parts: Vec<Vec<Cell>> = jobs::try_in_order(chosen.len(), eighths)?;
        let is_divided: HashSet<usize> = chosen.iter().copied().collect();
        divided.extend(chosen.iter().map(|at| cells[*at].place));
        let mut at = 0;
        cells.retain(|_| {
            at += 1;
            !is_divided.contains(&(at - 1))
        });
        cells.extend(parts.into_iter().flatten());
    }
}

/// How many cells leave no more than enough open, if that falls with a power of their number as it
/// did in the last round.
fn cells_needed([(cells_before, before), (cells, open)]: [(f64, f64); 2], enough: f64) -> f64 {
    if before.is_infinite() {
        return cells;
    }
    let power = (before / open).ln() / (cells / cells_before).ln();
    if power > 0.0 { cells * (open / enough).powf(1.0 / power) } else { f64::INFINITY }
}

/// The cells that leave most open, until what the others leave is at most `left`.
fn chosen(open: &[f64], left: f64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..open.len()).collect();
    order::rising(&mut order, |n| open[*n]);
    let mut sum = 0.0;
    let kept = order.iter().take_while(|at| {
        sum += open[**at];
        sum <= left
    });
    order.split_off(kept.count())
}

/// A side of a cell, or the part of one that is a side of what is beside it.
struct Side {
    /// The cell of its size that is below it, along an axis.
    lower: Place,
    axis: usize,
    /// The cells below and above; nothing where all is inside, or outside.
    cells: [Option<usize>; 2],
}

/// Cells and what they are halved from, by their places.
struct Tree<'a> {
    numbers: HashMap<Place, usize>,
    divided: &'a HashSet<Place>,
}

impl Tree<'_> {
    /// The cell at a place, or a larger one that holds it.
    fn cell(&self, place: Place) -> Option<usize> {
        let mut larger = Some(place);
        while let Some(own) = larger {
            if let Some(number) = self.numbers.get(&own) {
                return Some(*number);
            }
            larger = own.above();
        }
        None
    }

    /// Adds the sides between a cell and what is at a place beside it, but for those that other
    /// cells add: of two cells that are as large the lower one does, of others the smaller.
    fn add(&self, number: usize, own: Place, beside: Place, (axis, is_high): (usize, bool), all: &mut Vec<Side>) {
        if self.divided.contains(&beside) {
            for part in beside.octants() {
                // Those that touch the cell.
                if (part.at[axis] & 1 == 0) == is_high && !self.numbers.contains_key(&part) {
                    let own = part.beside(axis, if is_high { -1 } else { 1 });
                    self.add(number, own, part, (axis, is_high), all);
                }
            }
            return;
        }
        let other = self.cell(beside);
        let is_own = other.is_none() || is_high || !self.numbers.contains_key(&beside);
        if is_own {
            let (lower, cells) = if is_high { (own, [Some(number), other]) } else { (beside, [other, Some(number)]) };
            all.push(Side { lower, axis, cells });
        }
    }
}

/// The bounds that cells make.
fn sums(cells: &[Cell], divided: &HashSet<Place>, sides: &mut Sides, grid: &Grid) -> Sums {
    let numbers = cells.iter().enumerate().map(|(n, cell)| (cell.place, n)).collect();
    let tree = Tree { numbers, divided };
    let mut all = Vec::with_capacity(4 * cells.len());
    for (number, Cell { place, .. }) in cells.iter().enumerate() {
        for axis in 0..3 {
            tree.add(number, *place, place.beside(axis, 1), (axis, true), &mut all);
            tree.add(number, *place, place.beside(axis, -1), (axis, false), &mut all);
        }
    }
    let unknown: Vec<&Side> = all.iter().filter(|side| !sides.contains_key(&(side.lower, side.axis))).collect();
    let area = |Side { lower, axis, cells: beside }: &Side| {
        let bounds = lower.side(*axis, grid);
        let [below, above] = beside.map(|cell| cell.map(|cell| &cells[cell]));
        match (below, above) {
            (Some(below), Some(above)) => {
                let smaller = if below.place.halvings > above.place.halvings { below } else { above };
                area_inside(&smaller.program, &bounds, *axis)
            }
            (Some(one), None) | (None, Some(one)) => {
                let mut size = bounds.size();
                size[*axis] = 1.0;
                [if one.program.value(bounds.center()) > 0.0 { size.element_product() } else { 0.0 }; 2]
            }
            (None, None) => [0.0; 2],
        }
    };
    let areas = jobs::in_order(unknown.len(), |n| area(unknown[n]));
    for (side, area) in unknown.into_iter().zip(areas) {
        sides.insert((side.lower, side.axis), area);
    }
    let mut sums = Sums { least: 0.0, most: 0.0, open: vec![0.0; cells.len()] };
    let mut through = vec![0.0; cells.len()];
    for Side { lower, axis, cells: beside } in &all {
        let [least, most] = sides[&(*lower, *axis)];
        let [below, above] =
            beside.map(|cell| cell.map_or([0.0; 2], |cell| cells[cell].fields().map(|field| field[*axis])));
        let [low, high] = [above[0] - below[0], above[1] - below[1]];
        sums.least += (low * least).min(low * most);
        sums.most += (high * least).max(high * most);
        let open = 0.5 * (most - least) * (low.abs() + high.abs());
        for (cell, through_it) in beside.iter().zip([-below[0], above[0]]) {
            if let Some(cell) = *cell {
                sums.open[cell] += open;
                through[cell] += least.midpoint(most) * through_it;
            }
        }
    }
    for (n, cell) in cells.iter().enumerate() {
        let [least, most] = cell.area;
        sums.least += least;
        sums.most += most;
        sums.open[n] += match cell.facing {
            Some(Facing { cosine, .. }) => (1.0 / cosine - 1.0) * f64::max(through[n], 0.0),
            None => most - least,
        };
    }
    sums.least = sums.least.clamp(0.0, sums.most);
    sums
}
