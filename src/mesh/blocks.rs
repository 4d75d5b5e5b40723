//! The blocks of a lattice that the surface of a solid may cross, and what is done where that was
//! wrong.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use rayon::prelude::*;

use super::extract::Mismatch;
use super::lattice::Lattice;
use super::paint::each_triangle;
use super::signs::{BLOCK, NODES, SIDE, Signs, is_mixed};
use crate::eval::{Narrowed, Program};
use crate::geom::Mesh;
use crate::space::{Grid, surface_blocks};
use crate::{Bounds, Cancelled, Run};

/// The blocks that the surface may cross.
#[derive(Clone)]
pub(super) struct Blocks {
    /// Their first cells.
    pub(super) cells: Vec<[u32; 3]>,
    pub(super) programs: Programs,
    /// Those sampled by the whole program in double precision, if there are any.
    pub(super) exact: Vec<bool>,
}

/// The programs of blocks: of each its number, and all.
#[derive(Clone)]
pub(super) struct Programs {
    numbers: Vec<u32>,
    all: Vec<Program>,
}

impl Programs {
    /// One of them, if there is any.
    pub(super) fn first(&self) -> Option<&Program> {
        self.all.first()
    }

    pub(super) fn of(&self, block: usize) -> &Program {
        &self.all[self.numbers[block] as usize]
    }

    /// Whether two blocks have the same.
    pub(super) fn is_same(&self, one: usize, other: usize) -> bool {
        self.numbers[one] == self.numbers[other] || self.of(one).is_same(self.of(other))
    }
}

impl Blocks {
    pub(super) fn find(program: &Program, lattice: &Lattice, run: &Run) -> Result<Blocks, Cancelled> {
        let grid = Grid {
            origin: lattice.origin(),
            side: lattice.step() * BLOCK as f64,
            blocks: lattice.cells().map(|cells| cells.div_ceil(BLOCK as u32)),
        };
        // Nodes are asked for with what is close about them.
        let found = surface_blocks(program, &grid, lattice.close(), run)?;
        let cells = found.blocks.iter().map(|block| block.index.map(|i| i * BLOCK as u32)).collect();
        let numbers = found.blocks.iter().map(|block| block.program).collect();
        Ok(Blocks { cells, programs: Programs { numbers, all: found.programs }, exact: Vec::new() })
    }

    /// Those whose numbers are chosen.
    pub(super) fn chosen(&self, is_chosen: impl Fn(usize) -> bool) -> Blocks {
        let numbers = || (0..self.cells.len()).filter(|number| is_chosen(*number));
        let programs = Programs {
            numbers: numbers().map(|number| self.programs.numbers[number]).collect(),
            all: self.programs.all.clone(),
        };
        let exact = if self.exact.is_empty() { Vec::new() } else { numbers().map(|n| self.exact[n]).collect() };
        Blocks { cells: numbers().map(|number| self.cells[number]).collect(), programs, exact }
    }

    /// Those of the halved lattice, given with it, in the blocks whose numbers along the axes are
    /// chosen.
    pub(super) fn halves(&self, lattice: &Lattice, is_chosen: impl Fn([u32; 3]) -> bool) -> Blocks {
        let side = BLOCK as u32;
        let (mut cells, mut numbers, mut all) = (Vec::new(), Vec::new(), Vec::new());
        for (n, block) in self.cells.iter().enumerate().filter(|(_, block)| is_chosen(block.map(|at| at / side))) {
            let whole = self.programs.of(n);
            let mut shared = None;
            for part in 0..8 {
                let first = std::array::from_fn(|axis| 2 * block[axis] + (part >> axis & 1) * side);
                let number = match whole.narrowed(&lattice.about(first, BLOCK)) {
                    Narrowed::Inside | Narrowed::Outside => continue,
                    Narrowed::Same => *shared.get_or_insert_with(|| push(&mut all, whole.clone())),
                    Narrowed::Simpler(program) => push(&mut all, program),
                };
                cells.push(first);
                numbers.push(number);
            }
        }
        Blocks { cells, programs: Programs { numbers, all }, exact: Vec::new() }
    }

    /// Adds those that are not there yet, by their first cells; `whole` is the program of the
    /// solid.
    pub(super) fn add(&mut self, blocks: impl Iterator<Item = [u32; 3]>, whole: &Program) {
        let known: HashSet<[u32; 3]> = self.cells.iter().copied().collect();
        let number = push(&mut self.programs.all, whole.clone());
        self.cells.extend(blocks.filter(|block| !known.contains(block)));
        self.programs.numbers.resize(self.cells.len(), number);
    }

    /// Makes blocks exact on both sides of mismatches; and so, wherever the surface goes on from
    /// those in a block that is not among them, that one. Whether there was anything to be done.
    ///
    /// Samples of a field that jumps depend on rounding, and ranges that are told of it, or that
    /// users tell of theirs, may be wrong. There are none but those that it may have, told by their
    /// first cells. All exact blocks have the same value at a node, so in the end all mismatches
    /// are repaired.
    pub(super) fn repair(
        &mut self,
        mismatches: &[Mismatch],
        whole: &Program,
        (lattice, limits): (&Lattice, &Bounds),
        may_have: impl Fn([u32; 3]) -> bool,
        run: &Run,
    ) -> Result<bool, Cancelled> {
        self.exact.resize(self.cells.len(), false);
        let number = push(&mut self.programs.all, whole.clone());
        let mut known: HashMap<[u32; 3], usize> = self.cells.iter().copied().zip(0..).collect();
        let is_there = |block: &[u32; 3]| (0..3).all(|axis| block[axis] < lattice.cells()[axis]) && may_have(*block);
        let mut open: Vec<[u32; 3]> = mismatches
            .iter()
            .flat_map(|mismatch| [Some(mismatch.block), mismatch.beyond.filter(is_there)])
            .flatten()
            .collect();
        let (mut values, mut changed) = ([0.0; NODES], false);
        while let Some(block) = open.pop() {
            run.check()?;
            let n = *known.entry(block).or_insert_with(|| {
                self.cells.push(block);
                self.programs.numbers.push(number);
                self.exact.push(false);
                self.cells.len() - 1
            });
            if self.exact[n] {
                continue;
            }
            (self.exact[n], self.programs.numbers[n], changed) = (true, number, true);
            exact_nodes(whole, (lattice, limits), block, &mut values);
            let signs = Signs::new(&values);
            for (axis, up) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, false), (axis, true)]) {
                let mut beyond = block;
                beyond[axis] = beyond[axis].wrapping_add_signed(if up { BLOCK as i32 } else { -(BLOCK as i32) });
                if is_mixed(&signs.face(axis, up)) && is_there(&beyond) && !known.contains_key(&beyond) {
                    open.push(beyond);
                }
            }
        }
        Ok(changed)
    }

    /// The leaves that decide at the middles of the triangles, by the programs of their blocks;
    /// `whole` is that of the solid.
    pub(super) fn owners(
        &self,
        lattice: &Lattice,
        mesh: &Mesh,
        whole: &Program,
        run: &Run,
    ) -> Result<Vec<u32>, Cancelled> {
        let mut places: Vec<([u32; 3], usize)> = self.cells.iter().copied().zip(0..).collect();
        places.par_sort_unstable();
        each_triangle(mesh, run, |_, triangle| {
            let middle = mesh.corners(triangle).into_iter().sum::<DVec3>() / 3.0;
            let cell = (middle - lattice.origin()) / lattice.step();
            let block = cell.to_array().map(|x| x.max(0.0) as u32 / BLOCK as u32 * BLOCK as u32);
            // A triangle of several blocks may have its middle in one that holds no vertex.
            let nth = places.binary_search_by_key(&block, |&(block, _)| block).ok();
            nth.map_or(whole, |nth| self.programs.of(places[nth].1)).deciding_owner(middle)
        })
    }
}

/// Adds a program to a list: its number.
fn push(all: &mut Vec<Program>, program: Program) -> u32 {
    all.push(program);
    all.len() as u32 - 1
}

/// The values at the nodes of a block in double precision; beyond the limits of the solid they are
/// outside.
pub(super) fn exact_nodes(
    program: &Program,
    (lattice, limits): (&Lattice, &Bounds),
    block: [u32; 3],
    out: &mut [f32; NODES],
) {
    for (n, value) in out.iter_mut().enumerate() {
        let at = |axis: usize, stride: usize| block[axis] + (n / stride % SIDE) as u32;
        let p = lattice.node(at(0, 1), at(1, SIDE), at(2, SIDE * SIDE));
        let exact = if limits.contains(p) { program.value_or_around(p, lattice.scale()) } else { -lattice.step() };
        *value = if exact > 0.0 { (exact as f32).max(f32::MIN_POSITIVE) } else { (exact as f32).min(0.0) };
    }
}
