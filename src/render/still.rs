//! A long leaf that does not change along parallel rays: of a plate that is seen from above, its outline.
//!
//! ```text
//!      | | | | | | |       Rays along z, and a formula of x and y: which of them are inside of it is a
//!     -+-+-+-+-+-+-+-      picture in the plane, which takes one value per pixel where it is not told
//!          #####   #       by ranges. What the rest of the solid is like along a ray that is inside
//!          #####   #       from end to end, and along one that is outside, are two solids without the
//!     -+-+-+-+-+-+-+-      formula (`eval::parting`).
//! ```
//!
//! So the formula is divided along the axes that it depends on, by itself, and never marched through.

use glam::DVec3;

use super::cells::{Cell, Cells, Halves, Part};
use super::gbuffer::Window;
use super::tile::{Pixels, Rectangle, TILE, View};
use crate::Bounds;
use crate::eval::{Evaluator, Parting, Region};

/// The leaf and the rest.
pub(super) struct Still {
    axes: [bool; 3],
    /// The leaf alone.
    pub(super) leaf: Cells,
    /// What is left of the solid along rays that are outside of the leaf, and along those inside.
    pub(super) sides: [Option<Cells>; 2],
}

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Mask {
    evaluator: Evaluator,
    points: [Vec<f32>; 3],
    values: Vec<f32>,
}

/// A direction along which less than this is moved along an axis does not move along it: on the way
/// through the solid it is far less than the room that boxes are given.
const LEVEL: f64 = 1e-15;

/// Values of all the pixels of a cell cost less than dividing it if they are up to so many, in those of
/// ordinary leaves.
const FEW: usize = 2048;

impl Still {
    /// `None` where inside of the leaf, or outside, nothing else would end the solid.
    pub(super) fn new(parting: Parting, bounds: Bounds, margin: f64) -> Option<Still> {
        let Parting { axes, leaf, sides } = parting;
        let side = |region: Region| match region {
            Region::Inside => None,
            Region::Outside => Some(None),
            Region::Surface(program) => Some(Some(Cells::within(&program, bounds, margin, [true; 3]))),
        };
        let [outside, inside] = sides.map(side);
        let leaf = Cells::within(&leaf, bounds, margin, axes);
        Some(Still { axes, leaf, sides: [outside?, inside?] })
    }

    /// Whether the leaf does not change along rays with this direction.
    pub(super) fn is_along(&self, direction: DVec3) -> bool {
        (0..3).all(|axis| !self.axes[axis] || direction[axis].abs() <= LEVEL)
    }

    /// The pixels of a tile whose rays are inside of the leaf.
    pub(super) fn inside(&self, mask: &mut Mask, view: &View<'_>, tile: &Window) -> Pixels {
        let mut found = Pixels([0; TILE as usize]);
        if let Some([start, across, down]) = view.rays.starts() {
            let (x, y) = (f64::from(tile.left) + tile.within.0, f64::from(tile.top) + tile.within.1);
            let grid = Grid { start: start + across * x + down * y, across, down, forward: view.rays.forward() };
            let pass = Pass { axes: self.axes, mask, view, tile, grid, found: &mut found };
            pass.whole(&self.leaf);
        }
        found
    }
}

/// Where the rays of a tile's pixels start.
#[derive(Clone, Copy)]
struct Grid {
    start: DVec3,
    across: DVec3,
    down: DVec3,
    forward: DVec3,
}

impl Grid {
    /// A point of the ray of a pixel.
    #[inline(always)]
    fn point(&self, column: u32, row: usize) -> DVec3 {
        self.start + self.across * f64::from(column) + self.down * row as f64
    }

    /// The same rays from points as far along them as `p` is.
    fn beside(self, p: DVec3) -> Grid {
        Grid { start: self.start + (p - self.start).dot(self.forward) * self.forward, ..self }
    }
}

/// One tile.
struct Pass<'a> {
    axes: [bool; 3],
    mask: &'a mut Mask,
    view: &'a View<'a>,
    tile: &'a Window,
    grid: Grid,
    found: &'a mut Pixels,
}

impl Pass<'_> {
    fn whole(mut self, leaf: &Cells) {
        self.part(leaf.root(), leaf.bounds());
    }

    /// The pixels of a row that are in a box, along the axes that matter.
    fn row(&self, bounds: &Bounds, row: usize, columns: u64) -> u64 {
        let start = self.grid.point(0, row);
        let mut here = columns;
        for axis in (0..3).filter(|&axis| self.axes[axis]) {
            let (start, step) = (start[axis], self.grid.across[axis]);
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let mut within = 0;
            for column in 0..TILE {
                let at = start + step * f64::from(column);
                within |= u64::from((at >= min) & (at < max)) << column;
            }
            here &= within;
        }
        here
    }

    /// The pixels of a part of the tree with these bounds. They are half open: a pixel is in one part.
    fn part(&mut self, part: &Part, bounds: &Bounds) {
        match part {
            Part::Outside => {}
            Part::Inside => self.fill(bounds),
            Part::Cell(cell) => self.cell(cell),
            Part::Halves(halves) => self.halves(halves, bounds),
        }
    }

    fn halves(&mut self, halves: &Halves, bounds: &Bounds) {
        let (mut below, mut above) = (*bounds, *bounds);
        below.max[halves.axis] = halves.plane;
        above.min[halves.axis] = halves.plane;
        self.part(&halves.parts[0], &below);
        self.part(&halves.parts[1], &above);
    }

    /// All pixels of a box are inside.
    fn fill(&mut self, bounds: &Bounds) {
        let Some(Rectangle { top, bottom, columns }) = self.view.rectangle(bounds, self.tile) else { return };
        for y in top..bottom {
            self.found.0[y] |= self.row(bounds, y, columns);
        }
    }

    fn cell(&mut self, cell: &Cell) {
        let Some(Rectangle { top, bottom, columns }) = self.view.rectangle(&cell.bounds, self.tile) else { return };
        let (rows, width) = (bottom - top, columns.count_ones() as usize);
        let count = rows * width;
        if count > 1 && count * cell.cost > FEW && !cell.is_stale() {
            self.halves(cell.halves(), &cell.bounds);
            return;
        }
        let tape = cell.tape();
        let grid = self.grid.beside(tape.origin());
        let left = columns.trailing_zeros();
        let [x, y, z] = &mut self.mask.points;
        for list in [&mut *x, &mut *y, &mut *z] {
            list.resize(count, 0.0);
        }
        for (number, row) in (top..bottom).enumerate() {
            let (start, step) = ((grid.point(left, row) - tape.origin()).as_vec3(), grid.across.as_vec3());
            let here = number * width..(number + 1) * width;
            for (axis, list) in [&mut *x, &mut *y, &mut *z].into_iter().enumerate() {
                for (i, to) in (0u8..).zip(&mut list[here.clone()]) {
                    *to = start[axis] + f32::from(i) * step[axis];
                }
            }
        }
        self.mask.values.resize(count, 0.0);
        self.mask.evaluator.values(tape, x, y, z, &mut self.mask.values);
        let doubt = tape.roundoff() as f32;
        for (row, values) in (top..bottom).zip(self.mask.values.chunks_exact(width)) {
            let (mut inside, mut doubtful) = (0u64, 0u64);
            for (i, value) in values.iter().enumerate() {
                inside |= u64::from(*value > doubt) << i;
                doubtful |= u64::from(value.abs() <= doubt) << i;
            }
            let here = self.row(&cell.bounds, row, columns);
            let (mut inside, mut doubtful) = (inside << left & here, doubtful << left & here);
            while doubtful != 0 {
                let column = doubtful.trailing_zeros();
                doubtful &= doubtful - 1;
                inside |= u64::from(cell.program.value(grid.point(column, row)) > 0.0) << column;
            }
            self.found.0[row] |= inside;
        }
    }
}
