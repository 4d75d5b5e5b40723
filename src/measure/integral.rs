//! The volume and the moments of a solid, within bounds that are certain.
//!
//! The solid's box is divided as for its mesh. Blocks inside count as they are. Those that the
//! surface may cross are [told to rounding](super::flat) if all its faces are flat. Else it is
//! known how much they hold [at least and at most](super::bracket), to the fourth power of their
//! size but where many faces meet. Those that leave most open are halved along all axes, with
//! programs narrowed to the halves, until what is open of all is little enough.

use glam::{DMat3, DVec3};

use super::bracket::{Held, held};
use super::enclosed::Enclosed;
use super::flat::flat;
use super::moments::Moments;
use crate::eval::Narrowed;
use crate::program::Program;
use crate::space::{Block, Grid, surface_blocks};
use crate::{Bounds, Cancelled, Run};
use rvachev_field::Zone;
use rvachev_num::{jobs, order};

/// Cells begin so much before the box, as a part of their side, that hardly ever a face is in a
/// side of one.
const ASIDE: f64 = 0.061_803_4;

/// What an integral may take, and what it is to tell.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// The volume is told to this part of it.
    pub(super) tolerance: f64,
    /// Cells along the longest side at first.
    pub(super) first: f64,
    /// After so many cells the work ends, with what is certain then.
    pub(super) most: usize,
}

/// A solid's volume is not told more finely than this part of its box.
const FINEST: f64 = 1e-6;

/// Of what may be left open this much is left to cells that are not divided.
const LEFT: f64 = 0.5;

/// Sums are off by rounding, as a part of the volume: of a million numbers, less than this.
pub(super) const ROUNDING: f64 = 2e-10;

/// Moments of a solid, and how far they may be off.
pub(super) struct Integral {
    /// About the origin.
    pub(super) moments: Moments,
    /// The volume is off by at most this.
    pub(super) volume_error: f64,
    /// Each coordinate of the centroid is; infinite where it may be anywhere.
    pub(super) centroid_error: f64,
    /// Each entry of the inertia about the centroid is.
    pub(super) inertia_error: f64,
    /// The area, if all faces are flat.
    pub(super) area: Option<f64>,
}

/// A cell that the surface may cross.
struct Cell {
    bounds: Bounds,
    program: Program,
    held: Held,
}

/// What is known so far.
struct Sums {
    inside: Moments,
    cells: Vec<Cell>,
    enclosed: Enclosed,
    bounds: Bounds,
}

impl Sums {
    fn moments(&self) -> Moments {
        let mut all = self.inside;
        self.cells.iter().for_each(|cell| all.add(&cell.held.moments));
        all
    }

    /// How far the volume may be off.
    fn error(&self) -> f64 {
        let [less, more] = self.cells.iter().fold([0.0; 2], |[less, more], Cell { held, .. }| {
            [less + held.moments.volume - held.least, more + held.most - held.moments.volume]
        });
        f64::max(less, more)
    }

    fn integral(&self) -> Integral {
        let moments = self.moments();
        let centre = moments.centroid().unwrap_or(self.cells.first().map_or(DVec3::ZERO, |cell| cell.bounds.center()));
        // What is open may be inside or outside, at the place of the cell that is farthest.
        let [mut open, mut first, mut second] = [ROUNDING * moments.volume, 0.0, 0.0];
        for Cell { bounds, held, .. } in &self.cells {
            let reach = (bounds.center() - centre).abs() + bounds.half_extents();
            open += held.open();
            first += held.open() * reach.max_element();
            second += held.open() * reach.length_squared();
        }
        let (rounded, reach) = (self.enclosed.volume_error(), (self.bounds.center() - centre).abs());
        let reach = reach + self.bounds.half_extents();
        open += rounded;
        first += rounded * reach.max_element();
        second += rounded * reach.length_squared();
        let spread = moments.moved(-centre).inertia();
        let size = spread.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        first += ROUNDING * (moments.volume * centre.abs().max_element() + (moments.volume * size).sqrt());
        let least = moments.volume - open;
        let centroid_error = if least > 0.0 { first / least } else { f64::INFINITY };
        let shifted = 3.0 * (moments.volume + open) * centroid_error * centroid_error;
        let rounding = ROUNDING * (size + moments.volume * centre.length_squared());
        Integral {
            moments,
            volume_error: self.error() + ROUNDING * moments.volume + rounded,
            centroid_error,
            inertia_error: second + rounding + if shifted.is_nan() { f64::INFINITY } else { shifted },
            area: None,
        }
    }
}

/// The integral over what is inside a program, which is nowhere but in a box. Meshes tell what they
/// hold.
pub(super) fn integral(
    (program, enclosed): (&Program, Enclosed),
    bounds: &Bounds,
    Effort { tolerance, first, most }: Effort,
    run: &Run,
) -> Result<Integral, Cancelled> {
    let [to_find, to_divide] = run.stages([0.1, 0.9]);
    let side = bounds.longest_side() / first;
    let margin = DVec3::splat(ASIDE * side);
    let blocks = ((bounds.size() + margin) / side).to_array().map(|count| (count.ceil() as u32).max(1));
    let grid = Grid { origin: bounds.min - margin, side, blocks };
    let mut found = surface_blocks(program, &grid, 0.0, &to_find)?;
    // Sums do not depend on the number of threads.
    found.inside.sort_unstable();
    let mut inside = Moments::default();
    for [from, to] in &found.inside {
        let part = grid.bounds(*from, *to);
        inside.add(&Moments::cuboid(part.center(), part.size()));
    }
    let place = |block: &Block| {
        let bounds = grid.bounds(block.index, block.index.map(|at| at + 1));
        (bounds, unfolded(found.programs[block.program as usize].clone(), &bounds))
    };
    let places: Vec<(Bounds, Program)> = found.blocks.iter().map(place).collect();
    if let Some((moments, area)) = flat(&places, &to_find)? {
        inside.add(&moments);
        let sums = Sums { inside, cells: Vec::new(), enclosed: Enclosed::default(), bounds: *bounds };
        return Ok(Integral { area: Some(area), ..sums.integral() });
    }
    let first = |(bounds, program): (Bounds, Program)| {
        run.check()?;
        let held = enclosed.held(&program, &bounds).unwrap_or_else(|| held(&program, &bounds));
        Ok(Cell { held, bounds, program })
    };
    let cells = jobs::try_taking(places, first)?;
    let mut asked = cells.len();
    let mut sums = Sums { inside, cells, enclosed, bounds: *bounds };
    let smallest = FINEST * bounds.size().element_product();
    let begun = sums.error();
    loop {
        let (error, enough) = (sums.error(), tolerance * sums.moments().volume.max(smallest));
        to_divide.report((begun / error).ln() / (begun / enough).ln().max(1.0));
        if error <= enough || asked >= most {
            return Ok(sums.integral());
        }
        let chosen = chosen(&sums.cells, 2.0 * LEFT * enough, (most - asked).div_ceil(8));
        asked += 8 * chosen.len();
        sums.divide(chosen, &to_divide)?;
    }
}

/// The program of one copy, in cells that no other copy reaches into.
pub(super) fn unfolded(program: Program, cell: &Bounds) -> Program {
    program.unfolded(&Zone::of_bounds(cell)).unwrap_or(program)
}

/// The cells that leave most open, until what the others leave is at most `left`; not more than so
/// many.
fn chosen(cells: &[Cell], left: f64, most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order::rising(&mut order, |n| cells[*n].held.open());
    let mut open = 0.0;
    let kept = order.iter().take_while(|at| {
        open += cells[**at].held.open();
        open <= left
    });
    let kept = kept.count().max(cells.len().saturating_sub(most));
    order.split_off(kept)
}

impl Sums {
    /// Puts the eighths of some cells in their place.
    fn divide(&mut self, mut chosen: Vec<usize>, run: &Run) -> Result<(), Cancelled> {
        chosen.sort_unstable();
        let eighths = |at: &usize| {
            run.check()?;
            let Cell { bounds, program, .. } = &self.cells[*at];
            let parts = bounds.octants().into_iter().map(|part| {
                let program = match program.narrowed(&part) {
                    Narrowed::Inside => return Some(Err(Held::whole(&part))),
                    Narrowed::Outside => return None,
                    Narrowed::Same => program.clone(),
                    Narrowed::Simpler(simpler) => simpler,
                };
                let program = unfolded(program, &part);
                let held = self.enclosed.held(&program, &part).unwrap_or_else(|| held(&program, &part));
                Some(Ok(Cell { held, bounds: part, program }))
            });
            Ok(parts.flatten().collect::<Vec<Result<Cell, Held>>>())
        };
        let found = jobs::try_in_order(chosen.len(), |n| eighths(&chosen[n]))?;
        let mut next = chosen.into_iter().peekable();
        let mut at = 0;
        self.cells.retain(|_| {
            at += 1;
            next.next_if_eq(&(at - 1)).is_none()
        });
        for part in found.into_iter().flatten() {
            match part {
                Ok(cell) => self.cells.push(cell),
                Err(whole) => self.inside.add(&whole.moments),
            }
        }
        Ok(())
    }
}

/// The inertia about the centroid.
pub(super) fn about_centroid(moments: &Moments) -> Option<DMat3> {
    moments.centroid().map(|centroid| moments.moved(-centroid).inertia())
}
