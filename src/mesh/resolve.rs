//! Cells that may hide a feature thinner than they are.
//!
//! ```text
//!     o-------o       A wall passes between the nodes: all are outside, and the mesh has nothing.
//!     |  ===  |       The value's range over the cell contains 0 then; and there is no direction such that
//!     o-------o       along it, and all close to it, the solid is entered in the cell and not left.
//! ```
//!
//! Blocks are halved until the ranges show that a part has no surface, or until there is a
//! direction along which it is only entered, or no cell in it is one that is looked for, or until
//! it is a cell.

use super::blocks::Blocks;
use super::extract::Sampler;
use super::lattice::Lattice;
use super::sampler::{Scratch, SolidSampler};
use super::signs::{BLOCK, NODES, SIDE, Signs};
use crate::eval::{Narrowed, Program};
use crate::{Bounds, Cancelled, Interval, Run};
use rvachev_num::{Meter, jobs};

/// The cells of a block that the surface may come into and turn round in.
pub(super) struct Unresolved {
    /// The first cell of the block.
    pub(super) block: [u32; 3],
    /// The cells, relative to it.
    pub(super) cells: Vec<[usize; 3]>,
}

/// Which cells are looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Among {
    /// Those whose nodes are all on one side: what turns round in them is lost.
    OneSided,
    /// All: what turns round in others may be torn.
    All,
}

/// The unresolved cells of blocks that have any.
pub(super) fn unresolved_cells(
    blocks: &Blocks,
    (lattice, limits): (&Lattice, Bounds),
    among: Among,
    run: &Run,
) -> Result<Vec<Unresolved>, Cancelled> {
    let meter = Meter::new(run, blocks.cells.len());
    let sampler = SolidSampler::new(lattice, blocks, limits, f64::INFINITY);
    let of_block = |scratch: &mut Scratch, number: usize| {
        let block = blocks.cells[number];
        meter.step()?;
        let program = blocks.programs.of(number);
        if program.is_entered_once(&[lattice.region(block, BLOCK)]) {
            return Ok(None);
        }
        let mut values = [0.0; NODES];
        scratch.forget();
        sampler.nodes(scratch, number, block, &mut values);
        let whole = lattice.region(block, BLOCK);
        // No point of a cell is farther from its nearest node than half of its diagonal.
        let near = 0.867 * lattice.step() * program.steepest(&whole);
        let signs = Signs::new(&values);
        let mut search =
            Search { lattice, block, among, signs, values, near, tried: [Tries::default(); BLOCK], found: Vec::new() };
        search.parts_of([0; 3], BLOCK, program);
        let cells = search.found;
        Ok(Some(Unresolved { block, cells }).filter(|found| !found.cells.is_empty()))
    };
    let found = jobs::try_in_order_with(blocks.cells.len(), || sampler.scratch(), of_block)?;
    Ok(found.into_iter().flatten().collect())
}

/// A block in which cells are sought.
struct Search<'a> {
    lattice: &'a Lattice,
    block: [u32; 3],
    among: Among,
    signs: Signs,
    values: [f32; NODES],
    /// The surface is in no cell whose nodes have larger values.
    near: f64,
    /// How it went with cubes of so many cells along an axis.
    tried: [Tries; BLOCK],
    /// The unresolved cells so far.
    found: Vec<[usize; 3]>,
}

/// How often a direction was sought, and found.
#[derive(Clone, Copy, Default)]
struct Tries {
    sought: u32,
    found: u32,
}

impl Tries {
    /// Whether it is worth while: what is not found in cubes is sought in their parts all the same.
    fn is_promising(&self) -> bool {
        self.sought < 3 || 4 * self.found > self.sought
    }
}

impl Search<'_> {
    /// Finds the unresolved cells of the eight parts of a cube of cells.
    fn parts_of(&mut self, first: [usize; 3], size: usize, program: &Program) {
        let half = size / 2;
        for n in 0..8 {
            self.of(std::array::from_fn(|axis| first[axis] + (n >> axis & 1) * half), half, program);
        }
    }

    /// Finds those of a cube of cells.
    fn of(&mut self, first: [usize; 3], size: usize, program: &Program) {
        let at = [0, 1, 2].map(|axis| self.block[axis] + first[axis] as u32);
        let region = self.lattice.about(at, size);
        if !self.has_near(first, size, self.near) {
            return;
        }
        let simpler = match program.narrowed(&region) {
            Narrowed::Inside | Narrowed::Outside => return,
            Narrowed::Same => None,
            Narrowed::Simpler(simpler) => Some(simpler),
        };
        let program = simpler.as_ref().unwrap_or(program);
        if program.is_seamless(&region) {
            return;
        }
        if size > 1 {
            let tries = &mut self.tried[size];
            if tries.is_promising() {
                tries.sought += 1;
                if program.is_entered_once(&[region]) {
                    tries.found += 1;
                    return;
                }
            }
            self.parts_of(first, size, program);
        } else if !program.is_entered_once(&[region])
            && (!self.is_one_sided(first) || self.least(first) <= self.overshoot(program, &region))
            && !program.is_entered_once(&region.octants())
        {
            self.found.push(first);
        }
    }

    /// By how much the value may exceed those at the nodes of a cell, either way: along an axis it
    /// rises and falls no faster than its slopes say.
    fn overshoot(&self, program: &Program, cell: &Bounds) -> f64 {
        let along = |slope: Interval| match (slope.hi(), -slope.lo()) {
            (up, down) if up > 0.0 && down > 0.0 => 1.0 / (1.0 / up + 1.0 / down),
            _ => 0.0,
        };
        program.slopes(cell).map(along).iter().sum::<f64>() * self.lattice.step()
    }

    fn is_one_sided(&self, cell: [usize; 3]) -> bool {
        matches!(self.signs.case(cell), 0 | 255)
    }

    /// Whether a cube of cells has one to be looked at: one whose nodes are all on one side has
    /// the least of their values this near to 0.
    fn has_near(&self, [i, j, k]: [usize; 3], size: usize, near: f64) -> bool {
        let is_near = |n: usize| {
            let cell = [i + n % size, j + n / size % size, k + n / (size * size)];
            if self.is_one_sided(cell) { self.least(cell) <= near } else { self.among == Among::All }
        };
        (0..size * size * size).any(is_near)
    }

    /// The least absolute value at the nodes of a cell.
    fn least(&self, [i, j, k]: [usize; 3]) -> f64 {
        let node = |n: usize| (i + (n & 1)) + SIDE * (j + (n >> 1 & 1)) + SIDE * SIDE * (k + (n >> 2));
        (0..8).map(|n| f64::from(self.values[node(n)].abs())).fold(f64::INFINITY, f64::min)
    }
}
