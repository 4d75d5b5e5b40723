//! Dividing a grid of blocks until every block is inside, outside, or small.
//!
//! The grid's blocks are cubes of one size. A range of blocks is narrowed as one box; if the
//! surface may cross it, it is halved along its longest side, and the halves start from the
//! program that is narrowed already. Work is proportional to the surface, and to the leaves
//! that matter locally.

use glam::DVec3;

use crate::eval::{Narrowed, Program};
use crate::{Bounds, Cancelled, Run};
use rvachev_num::{Meter, jobs};

/// A regular grid of cubic blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// The low corner of block (0, 0, 0).
    pub(crate) origin: DVec3,
    /// Edge length of a block.
    pub(crate) side: f64,
    /// Blocks along each axis.
    pub(crate) blocks: [u32; 3],
}

impl Grid {
    /// The box of the blocks from `from` up to `to`, exclusive.
    pub(crate) fn bounds(&self, from: [u32; 3], to: [u32; 3]) -> Bounds {
        let corner = |at: [u32; 3]| self.origin + self.side * DVec3::from_array(at.map(f64::from));
        Bounds::new(corner(from), corner(to))
    }
}

/// A block that the surface may cross.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    /// Its place in the grid.
    pub(crate) index: [u32; 3],
    /// The number of its program.
    pub(crate) program: u32,
}

/// Blocks that the surface may cross.
#[derive(Default)]
pub(crate) struct SurfaceBlocks {
    pub(crate) blocks: Vec<Block>,
    /// Their programs; neighbours often share one.
    pub(crate) programs: Vec<Program>,
    /// Ranges of blocks that are all inside, from the first to beyond the last along each axis.
    pub(crate) inside: Vec<[[u32; 3]; 2]>,
}

impl SurfaceBlocks {
    /// Adds others.
    fn append(&mut self, other: SurfaceBlocks) {
        let before = self.programs.len() as u32;
        self.blocks.extend(other.blocks.iter().map(|block| Block { program: before + block.program, ..*block }));
        self.programs.extend(other.programs);
        self.inside.extend(other.inside);
    }

    /// Blocks whose programs are among some, of which only theirs are kept.
    fn of(mut blocks: Vec<Block>, programs: Vec<Program>, inside: Vec<[[u32; 3]; 2]>) -> SurfaceBlocks {
        let mut numbers = vec![None; programs.len()];
        for block in &blocks {
            numbers[block.program as usize] = Some(0);
        }
        (0..).zip(numbers.iter_mut().flatten()).for_each(|(next, number)| *number = next);
        for block in &mut blocks {
            block.program = numbers[block.program as usize].unwrap_or_default();
        }
        let kept = programs.into_iter().zip(&numbers).filter(|(_, number)| number.is_some());
        SurfaceBlocks { blocks, programs: kept.map(|(program, _)| program).collect(), inside }
    }
}

/// A range of blocks.
#[derive(Clone, Copy)]
struct Part {
    from: [u32; 3],
    to: [u32; 3],
}

impl Part {
    fn size(&self) -> [u32; 3] {
        [self.to[0] - self.from[0], self.to[1] - self.from[1], self.to[2] - self.from[2]]
    }

    /// How many blocks it has: fewer than 2⁴⁴ cells' worth.
    fn volume(&self) -> u64 {
        self.size().map(u64::from).iter().product()
    }

    /// The two halves along the longest side; the upper one has the odd block.
    fn halves(self) -> [Part; 2] {
        let size = self.size();
        let axis = (0..3).rev().max_by_key(|&axis| size[axis]).unwrap_or(0);
        let middle = self.from[axis] + size[axis] / 2;
        let (mut below, mut above) = (self.to, self.from);
        below[axis] = middle;
        above[axis] = middle;
        [Part { from: self.from, to: below }, Part { from: above, to: self.to }]
    }

    /// What it holds, given the program of a part that holds it.
    fn narrowed(&self, program: &Program, grid: &Grid, margin: f64) -> Narrowed {
        program.narrowed(&grid.bounds(self.from, self.to).inflate(margin))
    }
}

/// The blocks of `grid` that the surface may cross, in the order of the halvings: blocks that
/// follow each other are near each other, and often have one program. Every block grown by
/// `margin` length units on each side is narrowed as a whole. The order does not depend on the
/// number of threads.
pub(crate) fn surface_blocks(
    program: &Program,
    grid: &Grid,
    margin: f64,
    run: &Run,
) -> Result<SurfaceBlocks, Cancelled> {
    let root = Part { from: [0; 3], to: grid.blocks };
    let meter = Meter::new(run, root.volume());
    // Breadth first until there is work for every thread, then depth first in each part.
    let mut parts = vec![(root, program.clone())];
    let mut inside = Vec::new();
    let wanted = 64 * rayon::current_num_threads().max(1);
    while parts.len() < wanted && parts.iter().any(|(part, _)| part.size() != [1; 3]) {
        let divided = |(part, program): (Part, Program)| {
            run.check()?;
            if part.size() == [1; 3] {
                return Ok((vec![(part, program)], None));
            }
            let program = match part.narrowed(&program, grid, margin) {
                narrowed @ (Narrowed::Inside | Narrowed::Outside) => {
                    meter.add(part.volume());
                    return Ok((Vec::new(), matches!(narrowed, Narrowed::Inside).then_some([part.from, part.to])));
                }
                Narrowed::Same => program,
                Narrowed::Simpler(simpler) => simpler,
            };
            Ok((part.halves().map(|half| (half, program.clone())).into(), None))
        };
        type Divided = (Vec<(Part, Program)>, Option<[[u32; 3]; 2]>);
        let next: Result<Vec<Divided>, Cancelled> = jobs::try_taking(parts, divided);
        parts = Vec::new();
        for (open, whole) in next? {
            parts.extend(open);
            inside.extend(whole);
        }
    }
    let found: Result<Vec<SurfaceBlocks>, Cancelled> =
        jobs::try_taking(parts, |(part, program)| descend(part, program, (grid, margin), &meter));
    run.report(1.0);
    let found = found?;
    let mut all = SurfaceBlocks { inside, ..SurfaceBlocks::default() };
    all.blocks.reserve_exact(found.iter().map(|found| found.blocks.len()).sum());
    found.into_iter().for_each(|found| all.append(found));
    Ok(all)
}

fn descend(
    part: Part,
    program: Program,
    (grid, margin): (&Grid, f64),
    meter: &Meter<'_>,
) -> Result<SurfaceBlocks, Cancelled> {
    let (mut blocks, mut programs, mut inside) = (Vec::new(), vec![program], Vec::new());
    // Each with the number of a program that holds in it.
    let mut pending = vec![(part, 0)];
    while let Some((part, number)) = pending.pop() {
        meter.check()?;
        let program = match part.narrowed(&programs[number as usize], grid, margin) {
            narrowed @ (Narrowed::Inside | Narrowed::Outside) => {
                if matches!(narrowed, Narrowed::Inside) {
                    inside.push([part.from, part.to]);
                }
                meter.add(part.volume());
                continue;
            }
            Narrowed::Same => number,
            Narrowed::Simpler(simpler) => {
                programs.push(simpler);
                programs.len() as u32 - 1
            }
        };
        if part.size() == [1; 3] {
            blocks.push(Block { index: part.from, program });
            meter.add(1);
        } else {
            let [below, above] = part.halves();
            pending.extend([(above, program), (below, program)]);
        }
    }
    Ok(SurfaceBlocks::of(blocks, programs, inside))
}
