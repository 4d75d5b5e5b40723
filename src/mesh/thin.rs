//! Thin features of a solid: places and sizes.
//!
//! ```text
//!     +---+---+---+---+     The cells that a wall may be torn or lost in are found first. Those that touch
//!     |   | x | x |   |     are a place. From the middles of some of them Newton steps lead to the surface; along
//!   ==|===|===|===|===|==   its normal the nearest change of sign tells the thickness.
//!     +---+---+---+---+
//! ```
//!
//! Limits: those of ranges, which are wider than what they hold. A place without a thickness may
//! be nothing.

use std::collections::HashMap;

use glam::DVec3;

use super::blocks::Blocks;
use super::error::MeshingError;
use super::lattice::{CellSize, Lattice};
use super::resolve::{Among, Unresolved, unresolved_cells};
use crate::eval::Program;
use crate::geom::{ThinPlace, ThinReport};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::{jobs, order};

/// Cells of a place that its thickness is sought in.
const ASKED: usize = 8;
/// Newton steps to the surface, and how far, in cells, they may lead.
const STEPS: usize = 8;
const FARTHEST: f64 = 2.0;
/// The other side is sought at this part of the farthest distance and at its powers, so many of
/// them.
const NEARER: f64 = 0.8;
const POWERS: i32 = 72;
/// What is narrower is rounding, in cells.
const ROUNDING: f64 = 1e-6;
/// The cosine from which on the normals of two sides are opposite.
const OPPOSITE: f64 = -0.7;
/// Halvings that find a change of sign.
const HALVINGS: usize = 40;
/// Cells that are looked at before it is asked whether to go on.
const AT_ONCE: usize = 1 << 12;

/// The features of a program that are thinner than cells of a size show.
pub(crate) fn thin_features_of(
    program: &Program,
    bounds: Bounds,
    cell: CellSize,
    run: &Run,
) -> Result<ThinReport, MeshingError> {
    let [to_find, to_search] = run.stages([0.1, 1.0]);
    let lattice = Lattice::new(&bounds, cell)?;
    let blocks = Blocks::find(program, &lattice, &to_find)?;
    Ok(thin_report(&blocks, (&lattice, bounds), &to_search)?)
}

/// A cell of the lattice that the surface may turn round in.
struct Thin<'a> {
    cell: [u32; 3],
    /// Whether its nodes are on both sides.
    is_mixed: bool,
    program: &'a Program,
}

/// The places in the blocks.
pub(super) fn thin_report(
    blocks: &Blocks,
    (lattice, limits): (&Lattice, Bounds),
    run: &Run,
) -> Result<ThinReport, Cancelled> {
    let [to_search, to_measure] = run.stages([0.9, 0.1]);
    let one_sided = unresolved_cells(blocks, (lattice, limits), Among::OneSided, &to_search.stage(0.0, 0.5))?;
    let all = unresolved_cells(blocks, (lattice, limits), Among::All, &to_search.stage(0.5, 1.0))?;
    let programs: HashMap<[u32; 3], &Program> =
        blocks.cells.iter().enumerate().map(|(n, &block)| (block, blocks.programs.of(n))).collect();
    let hidden: HashMap<[u32; 3], &[[usize; 3]]> =
        one_sided.iter().map(|found| (found.block, &found.cells[..])).collect();
    let of_block = |found: &Unresolved| {
        run.check()?;
        let Some(&program) = programs.get(&found.block) else { return Ok(Vec::new()) };
        let hidden = hidden.get(&found.block).copied().unwrap_or_default();
        let thin = |within: &[usize; 3]| {
            let cell = std::array::from_fn(|axis| found.block[axis] + within[axis] as u32);
            let is_mixed = !hidden.contains(within);
            let is_enough = !is_mixed && !program.is_gentle();
            let counts = is_enough || gap(program, &lattice.region(cell, 1), lattice.step()).is_some();
            counts.then_some(Thin { cell, is_mixed, program })
        };
        Ok(found.cells.iter().filter_map(thin).collect::<Vec<_>>())
    };
    let cells: Result<Vec<Vec<Thin<'_>>>, Cancelled> = jobs::try_in_order(all.len(), |n| of_block(&all[n]));
    let cells: Vec<Thin<'_>> = cells?.into_iter().flatten().collect();
    let mut places = grouped(&cells, run)?;
    // The surface turns round in the cell of a sharp corner, too.
    places.retain(|place| place.len() > 1 || !cells[place[0]].is_mixed);
    let count = places.iter().map(Vec::len).sum();
    // The largest first; of as many cells, that which is found first.
    order::falling(&mut places, |place| place.len() as f64);
    let listed = &places[..places.len().min(ThinReport::LISTED)];
    let measured = |place: &Vec<usize>| {
        to_measure.check()?;
        Ok(measured(place.iter().map(|&n| &cells[n]).collect(), lattice))
    };
    let listed: Result<Vec<ThinPlace>, Cancelled> = jobs::try_in_order(listed.len(), |n| measured(&listed[n]));
    run.report(1.0);
    Ok(ThinReport { cell: lattice.step(), cells: count, count: places.len(), places: listed? })
}

/// The places: the numbers of cells that touch, each list in ascending order.
fn grouped(cells: &[Thin<'_>], run: &Run) -> Result<Vec<Vec<usize>>, Cancelled> {
    let numbers: HashMap<[u32; 3], usize> = cells.iter().map(|thin| thin.cell).zip(0..).collect();
    let (mut met, mut places) = (vec![false; cells.len()], Vec::new());
    let mut looked = 0;
    for first in 0..cells.len() {
        if std::mem::replace(&mut met[first], true) {
            continue;
        }
        let (mut place, mut next) = (vec![first], 0);
        while let Some(&n) = place.get(next) {
            (next, looked) = (next + 1, looked + 1);
            if looked % AT_ONCE == 0 {
                run.check()?;
            }
            for step in 0..27 {
                // Below 0 they wrap round, and no cell is there.
                let by = |axis: u32| (step / 3u32.pow(axis) % 3).wrapping_sub(1);
                let other = [0, 1, 2].map(|axis| cells[n].cell[axis as usize].wrapping_add(by(axis)));
                if let Some(&other) = numbers.get(&other)
                    && !std::mem::replace(&mut met[other], true)
                {
                    place.push(other);
                }
            }
        }
        place.sort_unstable();
        places.push(place);
    }
    Ok(places)
}

/// What is said of a place.
fn measured(cells: Vec<&Thin<'_>>, lattice: &Lattice) -> ThinPlace {
    let region = |thin: &Thin<'_>| lattice.region(thin.cell, 1);
    let bounds = cells.iter().fold(Bounds::EMPTY, |all, thin| all.union(&region(thin)));
    let asked = cells.iter().step_by(cells.len().div_ceil(ASKED));
    let gaps = asked.filter_map(|thin| gap(thin.program, &region(thin), lattice.step()));
    let least = gaps.min_by(|a, b| a.1.total_cmp(&b.1));
    // A cell in the middle of the list is somewhere within.
    let position = least.map_or_else(|| region(cells[cells.len() / 2]).center(), |(middle, _)| middle);
    ThinPlace { position, size: bounds.size(), thickness: least.map(|(_, width)| width), cells: cells.len() }
}

/// The middle and the width of the narrowest wall or gap that is found across the surface near the
/// middle of a cell, if it is narrower than the cell's diagonal.
fn gap(program: &Program, cell: &Bounds, step: f64) -> Option<(DVec3, f64)> {
    let start = cell.center();
    let (mut p, mut normal) = (start, DVec3::ZERO);
    for _ in 0..STEPS {
        let (value, slope) = program.gradient(p);
        normal = slope.normalize_or_zero();
        let by = slope * (value / slope.length_squared().max(f64::MIN_POSITIVE));
        p = start + (p - by - start).clamp_length_max(FARTHEST * step);
    }
    if normal == DVec3::ZERO || !normal.is_finite() {
        return None;
    }
    let is_inside = |t: f64| program.value(p + normal * t) > 0.0;
    let powers = (0..POWERS).map(|n| FARTHEST * step * NEARER.powi(n));
    let places: Vec<f64> = powers.clone().map(|t| -t).chain(powers.rev()).collect();
    let sides: Vec<bool> = places.iter().map(|&t| is_inside(t)).collect();
    let mut crossings = Vec::new();
    for (ends, sides) in places.windows(2).zip(sides.windows(2)) {
        if sides[0] != sides[1] {
            let (mut low, mut high) = (ends[0], ends[1]);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if is_inside(middle) == sides[0] {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            crossings.push(0.5 * (low + high));
        }
    }
    // The sides of an edge are not opposite, and where faces meet there is a gap by rounding.
    let is_gap = |two: &&[f64]| {
        let [from, to] = [two[0], two[1]].map(|t| program.gradient(p + normal * t).1.normalize_or_zero());
        (ROUNDING * step..1.74 * step).contains(&(two[1] - two[0])) && from.dot(to) < OPPOSITE
    };
    let gaps = crossings.windows(2).filter(is_gap);
    let gaps = gaps.map(|two| (p + normal * (0.5 * (two[0] + two[1])), two[1] - two[0]));
    gaps.min_by(|a, b| a.1.total_cmp(&b.1))
}
