//! What cells of a size show: how many there are, and whether smaller ones would show more.
//!
//! Cells whose nodes are on one side, though the surface may be in them, are asked at the nodes of
//! a finer lattice. Flush faces and acute edges are among them, and have nothing to show.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;

use super::blocks::Blocks;
use super::error::MeshingError;
use super::extract::Sampler;
use super::lattice::{CellSize, Lattice};
use super::resolve::{Among, Unresolved, unresolved_cells};
use super::sampler::{Scratch, SolidSampler};
use super::signs::{BLOCK, NODES, SIDE, Signs};
use super::subject::Subject;
use crate::eval::Program;
use crate::geom::Mesh;
use crate::{Bounds, Cancelled, Run};
use rvachev_num::{jobs, order};

/// Cells of a block that the surface is in, as a rule.
const OF_BLOCK: usize = 110;

/// What is deeper than this, in cells, or has no other side near, is no bend or edge of a surface
/// that the cells show.
const DEEP: f64 = 0.3;

/// Nearer to the surface than this part of the size, points may be on either side by rounding
/// errors.
const ROUNDING: f64 = 1e-9;

/// So many times as small are the cells that would show what is hidden.
const SMALLER: u32 = 4;

/// Cells along the thinnest leaf, at least.
const ALONG_LEAF: f64 = 2.0;

/// A cell with all its nodes on one side that may have the surface in it, and whether it surely
/// has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hidden {
    pub(crate) cell: Bounds,
    pub(crate) is_sure: bool,
}

/// Where the surface is found of which a cell is told that it is in it.
pub(crate) fn reached(cell: &Bounds) -> Bounds {
    cell.inflate(0.01 * cell.longest_side())
}

/// How far an eighth of a cell reaches from its own node, and from those that are one, two and three
/// edges from that, in cells, with room for rounding.
const FAR: [f64; 4] = [0.867, 1.225, 1.501, 1.733];

/// What may be beside cells that are looked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Beside {
    /// Nodes of the same side.
    Nothing,
    /// All that there is.
    All,
}

impl Subject<'_> {
    /// The size of cells that show all leaves, `most` at most, as far as these are not more than
    /// enough; `size` is how large the surface is.
    pub(crate) fn first_cell(&self, size: f64, most: f64, enough: f64, run: &Run) -> Result<f64, MeshingError> {
        let thinnest = self.program.thinnest_leaf();
        let wanted = thinnest / ALONG_LEAF;
        if wanted >= most {
            return Ok(most);
        }
        // Of what has no end, as much as is large.
        let bounds = self.bounds.intersection(&Bounds::from_center(self.bounds.center(), DVec3::splat(size)));
        let wanted = wanted.max(most / enough.sqrt());
        let cells = Subject { bounds, ..*self }.cells(CellSize::Length(wanted), run)? as f64;
        let shown = wanted * (cells / enough).sqrt().max(1.0);
        // Where all of it passes between them, larger ones do as well.
        let is_sheet = shown > thinnest && self.bounds.size().min_element() <= thinnest;
        Ok(if is_sheet { most } else { shown.min(most) })
    }

    /// About how many cells of a size the surface is in.
    pub(crate) fn cells(&self, cell: CellSize, run: &Run) -> Result<usize, MeshingError> {
        let lattice = Lattice::new(&self.bounds, cell)?;
        Ok(OF_BLOCK * Blocks::find(self.program, &lattice, run)?.cells.len())
    }

    /// The cells of a mesh of this that have all their nodes on one side, and may have the surface
    /// in them.
    pub(crate) fn hidden(&self, mesh: &Mesh, run: &Run) -> Result<Vec<Hidden>, MeshingError> {
        let cell = mesh.findings().cell;
        if cell == 0.0 {
            return Ok(Vec::new());
        }
        let lattice = Lattice::new(&self.bounds, CellSize::Length(cell))?;
        let [to_find, to_search] = run.stages([0.2, 0.8]);
        let blocks = Blocks::find(self.program, &lattice, &to_find)?;
        let is_gentle = |number: usize| blocks.programs.of(number).has_gentle_leaves();
        let [gentle, other] = [true, false].map(|wanted| blocks.chosen(|number| is_gentle(number) == wanted));
        let part = gentle.cells.len() as f64 / blocks.cells.len().max(1) as f64;
        let [to_lead, to_halve] = to_search.stages([part, 1.0 - part]);
        // What cells beside others hide as well is of no matter where nothing is hidden by itself.
        let mut found = self.crossed(&gentle, &lattice, Beside::Nothing, &to_lead)?;
        if !found.is_empty() {
            found = self.crossed(&gentle, &lattice, Beside::All, &to_lead)?;
        }
        // What a mesh says that it may have lost is not all: in blocks with a crossing it looks for
        // little.
        let suspects = unresolved_cells(&other, (&lattice, self.bounds), Among::OneSided, &to_halve)?;
        let of_block = |Unresolved { block, cells }: Unresolved| {
            let at = move |within: &[usize; 3]| [0, 1, 2].map(|axis| block[axis] + within[axis] as u32);
            let cells: Vec<[u32; 3]> = cells.iter().map(at).collect();
            cells.into_iter().map(|cell| Hidden { cell: lattice.region(cell, 1), is_sure: false })
        };
        found.extend(suspects.into_iter().flat_map(of_block));
        Ok(found)
    }

    /// The cells with all nodes on one side that have the surface in them: of values of which it is
    /// known how much they change as points move, those at the nodes tell where to look, and lead
    /// there.
    fn crossed(&self, blocks: &Blocks, lattice: &Lattice, beside: Beside, run: &Run) -> Result<Vec<Hidden>, Cancelled> {
        let slope_of =
            |number: usize| blocks.programs.of(number).slope_within(&lattice.region(blocks.cells[number], BLOCK));
        let steepest = (0..blocks.cells.len()).map(slope_of).fold(1.0, f64::max);
        let sampler = SolidSampler::new(lattice, blocks, self.bounds, FAR[2] * steepest);
        // One that is alone is enough to know that there are some.
        let is_enough = AtomicBool::new(false);
        let of_block = |scratch: &mut Scratch, number: usize| {
            let block = blocks.cells[number];
            run.check()?;
            if is_enough.load(Ordering::Relaxed) {
                return Ok(Vec::new());
            }
            let most = slope_of(number) * lattice.step();
            let mut values = [0.0; NODES];
            scratch.forget();
            sampler.nodes(scratch, number, block, &mut values);
            let signs = Signs::new(&values);
            let mut found = Vec::new();
            for [x, y, z] in (0..BLOCK.pow(3)).map(|n| [n % BLOCK, n / BLOCK % BLOCK, n / (BLOCK * BLOCK)]) {
                let node = |n: usize| (x + (n & 1)) + SIDE * (y + (n >> 1 & 1)) + SIDE * SIDE * (z + (n >> 2));
                let is_clear = || is_clear(std::array::from_fn(|n| f64::from(values[node(n)].abs()) / most));
                let is_mixed = || match beside {
                    Beside::Nothing => is_mixed_about(&signs, [x, y, z]),
                    Beside::All => !matches!(signs.case([x, y, z]), 0 | 255),
                };
                if is_mixed() || is_clear() {
                    continue;
                }
                let cell = [0, 1, 2].map(|axis| block[axis] + [x, y, z][axis] as u32);
                let region = lattice.region(cell, 1);
                let is_alone = || beside == Beside::All || self.is_alone(&region);
                if self.is_crossed(&region) && is_alone() {
                    found.push(Hidden { cell: region, is_sure: true });
                    if beside == Beside::Nothing {
                        is_enough.store(true, Ordering::Relaxed);
                        break;
                    }
                }
            }
            Ok(found)
        };
        Ok(jobs::try_in_order_with(blocks.cells.len(), || sampler.scratch(), of_block)?.concat())
    }

    /// Whether all nodes of a cell and of those about it are on one side.
    fn is_alone(&self, cell: &Bounds) -> bool {
        let is_inside = self.program.value(cell.min) > 0.0;
        nodes(&cell.inflate(cell.longest_side()), 3).all(|p| (self.program.value(p) > 0.0) == is_inside)
    }

    /// Whether steps along the gradient lead from the middle of a cell to the surface in it.
    fn is_crossed(&self, cell: &Bounds) -> bool {
        let step = cell.longest_side();
        self.foot(cell.center(), step).is_some_and(|foot| reached(cell).contains(foot))
    }

    /// The point of the surface that steps along the gradient lead to, if they do, and beyond it to
    /// the other side within a tenth of `step`: where parts meet face to face values are 0, and
    /// inside on both sides.
    pub(super) fn foot(&self, from: DVec3, step: f64) -> Option<DVec3> {
        const STEPS: usize = 8;
        let size = self.bounds.longest_side();
        let is_inside = self.program.value(from) > 0.0;
        let mut p = from;
        let mut last = DVec3::ZERO;
        for _ in 0..STEPS {
            let (value, slope) = self.program.gradient(p);
            last = if is_inside { -slope } else { slope };
            if value.abs() <= ROUNDING * size {
                break;
            }
            let on = value / slope.length_squared() * slope;
            if !on.is_finite() {
                return None;
            }
            p -= on;
        }
        // All steps together lead beyond an edge as well, where the last one goes along a face.
        let way = (p - from).try_normalize().unwrap_or(last.normalize_or_zero());
        let is_beyond = |part: f64| {
            let value = self.program.value(p + part * step * way);
            value.abs() > ROUNDING * size && (value > 0.0) != is_inside
        };
        // One of the tenths of tenths is within what is thicker than rounding errors.
        let mut parts = (2..).map(|tenths| 0.1_f64.powi(tenths)).take_while(|part| part * step > ROUNDING * size);
        (self.program.value(p).abs() < 0.01 * step && parts.any(is_beyond)).then_some(p)
    }

    /// About how thick what is hidden in cells is, to within twice: half of it is thinner.
    pub(crate) fn thickness(&self, hidden: &[Hidden]) -> Option<f64> {
        const SOME: usize = 32;
        let least = ROUNDING * self.bounds.longest_side();
        let of_cell = |Hidden { cell, .. }: &Hidden| {
            let (from, step) = (cell.center(), cell.longest_side());
            let foot = self.foot(from, step)?;
            let way = (foot - from).normalize_or_zero();
            let is_inside = self.program.value(from) > 0.0;
            let is_beyond = |by: &f64| {
                let value = self.program.value(foot + *by * way);
                value.abs() > least && (value > 0.0) != is_inside
            };
            (0..).map(|halvings| 0.5f64.powi(halvings) * step).take_while(|by| *by > least).find(is_beyond)
        };
        let some = hidden.iter().step_by(hidden.len().div_ceil(SOME).max(1));
        let mut all: Vec<f64> = some.filter_map(of_cell).collect();
        order::rising(&mut all, |thickness| *thickness);
        all.get(all.len() / 2).copied()
    }

    /// Whether a cell with all its nodes on one side has something of the other.
    pub(crate) fn has_inner(&self, cell: &Bounds, program: &Program) -> bool {
        let step = cell.longest_side();
        let is_inside = program.value(cell.min) > 0.0;
        // How far points are on the other side.
        let depth = |p: &DVec3| {
            let (value, slope) = program.gradient(*p);
            if (value > 0.0) == is_inside { 0.0 } else { value.abs() / slope.length().max(f64::MIN_POSITIVE) }
        };
        let most = nodes(cell, SMALLER).map(|p| depth(&p)).fold(0.0, f64::max);
        most > ROUNDING * self.bounds.longest_side() && (most > DEEP * step || self.is_alone(cell))
    }
}

/// Whether a cell of a block, or one beside it in the block, has nodes on both sides.
fn is_mixed_about(signs: &Signs, cell: [usize; 3]) -> bool {
    let mixed = |n: usize| {
        let at: [usize; 3] = std::array::from_fn(|axis| cell[axis] + n / 3usize.pow(axis as u32) % 3);
        // The one beside it below is one less.
        at.iter().all(|c| (1..=BLOCK).contains(c)) && !matches!(signs.case(at.map(|c| c - 1)), 0 | 255)
    };
    (0..27).any(mixed)
}

/// Whether no point of a cell can be on the surface, given how far its nodes are at least, in cells:
/// each eighth of it is nearer to some node than that.
fn is_clear(nodes: [f64; 8]) -> bool {
    (0..8u32).all(|eighth| (0..8u32).any(|n| nodes[n as usize] > FAR[(eighth ^ n).count_ones() as usize]))
}

/// The nodes of so many cells along each side of a box.
fn nodes(bounds: &Bounds, count: u32) -> impl Iterator<Item = DVec3> {
    let (min, step, side) = (bounds.min, bounds.size() / f64::from(count), count + 1);
    (0..side.pow(3))
        .map(move |n| min + step * DVec3::from_array([n % side, n / side % side, n / (side * side)].map(f64::from)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cell with a point of the surface is never clear, wherever it is and however close.
    #[test]
    fn a_cell_that_the_surface_touches_is_not_clear() {
        let cell = Bounds::new(DVec3::ZERO, DVec3::ONE);
        for p in nodes(&cell, 16) {
            let corner = |n: usize| DVec3::from_array([0, 1, 2].map(|axis| (n >> axis & 1) as f64));
            assert!(!is_clear(std::array::from_fn(|n| corner(n).distance(p))), "{p}");
        }
        // A face right below a cell does not reach it.
        assert!(is_clear(std::array::from_fn(|n| 0.3 + (n >> 2) as f64)));
    }
}
