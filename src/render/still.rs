//! A long leaf that does not change along parallel rays: of a plate that is seen from above, its
//! outline.
//!
//! ```text
//!      | | | | | | |       Rays along z, and a formula of x and y: which of them are inside of it is a
//!     -+-+-+-+-+-+-+-      picture in the plane, which takes one value per pixel where it is not told
//!          #####   #       by ranges. What the rest of the solid is like along a ray that is inside
//!          #####   #       from end to end, and along one that is outside, are two solids without the
//!     -+-+-+-+-+-+-+-      formula (`eval::partial`).
//! ```
//!
//! So the formula is divided along the axes that it depends on, by itself, and never marched
//! through.

use std::ops::Range;

use glam::DVec3;

use super::cells::{Cell, Cells, Halves, Part};
use super::gbuffer::Window;
use super::pixels::{Pixels, Rectangle, TILE};
use super::tile::View;
use crate::Bounds;
use crate::eval::{Evaluator, Partial, Region};
use rvachev_num::signs::{STRIP, signs};

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

/// Values at all the pixels that see a cell, within the picture and beyond, cost less than dividing
/// it if they are as much as up to so many of ordinary leaves.
const FEW: f64 = 6e4;

impl Still {
    /// `None` where inside of the leaf, or outside, nothing else would end the solid.
    pub(super) fn new(partial: Partial, bounds: Bounds, margin: f64) -> Option<Still> {
        let Partial { axes, leaf, sides } = partial;
        let side = |region: Region| match region {
            Region::Inside => None,
            Region::Outside => Some(None),
            Region::Surface(program) => Some(Some(Cells::within(&program, bounds, margin, [true; 3]))),
        };
        let [outside, inside] = sides.map(side);
        let leaf = Cells::within(&leaf, bounds, margin, axes);
        Some(Still { axes, leaf, sides: [outside?, inside?] })
    }

    /// The trees.
    pub(super) fn parts(&self) -> impl Iterator<Item = &Cells> {
        std::iter::once(&self.leaf).chain(self.sides.iter().flatten())
    }

    /// Whether the leaf does not change along rays with this direction.
    pub(super) fn is_along(&self, direction: DVec3) -> bool {
        (0..3).all(|axis| !self.axes[axis] || direction[axis].abs() <= LEVEL)
    }

    /// The pixels of a tile whose rays are inside of the leaf.
    pub(super) fn inside(&self, mask: &mut Mask, view: &View<'_>, tile: &Window) -> Pixels {
        let mut found = Pixels::NONE;
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

    /// The columns among `columns` whose pixels in a row are in the half open box along an axis.
    fn within(&self, bounds: &Bounds, axis: usize, row: usize, columns: u64) -> u64 {
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        let start = self.point(0, row)[axis];
        let step = self.across[axis];
        if step == 0.0 {
            return if start >= min && start < max { columns } else { 0 };
        }
        let mut within = 0;
        for column in columns.trailing_zeros()..u64::BITS - columns.leading_zeros() {
            let at = start + step * f64::from(column);
            within |= u64::from((at >= min) & (at < max)) << column;
        }
        within & columns
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

    /// The columns among `columns` that are in a box along the axes that matter, as far as that is
    /// the same for all rows of the tile.
    fn columns(&self, bounds: &Bounds, columns: u64) -> u64 {
        let fixed = (0..3).filter(|&axis| self.axes[axis] && self.grid.down[axis] == 0.0);
        fixed.fold(columns, |columns, axis| columns & self.grid.within(bounds, axis, 0, columns))
    }

    /// Those of them whose pixels in a row are in the box.
    fn row(&self, bounds: &Bounds, columns: u64, row: usize) -> u64 {
        let changing = (0..3).filter(|&axis| self.axes[axis] && self.grid.down[axis] != 0.0);
        changing.fold(columns, |columns, axis| columns & self.grid.within(bounds, axis, row, columns))
    }

    /// The pixels of a part of the tree with these bounds. They are half open: a pixel is in one
    /// part.
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
        let columns = self.columns(bounds, columns);
        for row in top..bottom {
            self.found.0[row] |= self.row(bounds, columns, row);
        }
    }

    fn cell(&mut self, cell: &Cell) {
        let Some(Rectangle { top, bottom, columns }) = self.view.rectangle(&cell.bounds, self.tile) else { return };
        let (rows, width) = (bottom - top, columns.count_ones() as usize);
        let count = rows * width;
        if self.view.covers(&cell.bounds) * cell.cost as f64 > FEW && !cell.is_stale() {
            self.halves(cell.halves(), &cell.bounds);
            return;
        }
        let tape = cell.tape();
        let grid = self.grid.beside(tape.origin());
        let left = columns.trailing_zeros();
        self.mask.place(&grid, tape.origin(), (top..bottom, left, width));
        let Mask { evaluator, points: [x, y, z], values } = &mut *self.mask;
        values.resize(count + STRIP, 0.0);
        evaluator.shortest_values(tape, [&x[..count], &y[..count], &z[..count]], &mut values[..count]);
        let columns = self.columns(&cell.bounds, columns);
        let doubt = tape.roundoff() as f32;
        for (number, row) in (top..bottom).enumerate() {
            let here = self.row(&cell.bounds, columns, row);
            let [mut inside, mut doubtful] =
                signs(&self.mask.values[number * width..], width, doubt).map(|bits| bits << left & here);
            while doubtful != 0 {
                let column = doubtful.trailing_zeros();
                doubtful &= doubtful - 1;
                inside |= u64::from(cell.program.value(grid.point(column, row)) > 0.0) << column;
            }
            self.found.0[row] |= inside;
        }
    }
}

impl Mask {
    /// Fills in the points of some rows, so many pixels from column `left` each, relative to
    /// `origin`. Rows are written in whole strips; what is too much is overwritten by the next one.
    fn place(&mut self, grid: &Grid, origin: DVec3, (rows, left, width): (Range<usize>, u32, usize)) {
        for (axis, (list, step)) in self.points.iter_mut().zip(grid.across.as_vec3().to_array()).enumerate() {
            let mut ahead = [0.0; TILE as usize];
            for (i, ahead) in (0u8..).zip(&mut ahead) {
                *ahead = f32::from(i) * step;
            }
            list.resize(rows.len() * width + STRIP, 0.0);
            for (number, row) in rows.clone().enumerate() {
                let start = (grid.point(left, row) - origin)[axis] as f32;
                let mut strip = 0;
                while strip < width {
                    let to = &mut list[number * width + strip..][..STRIP];
                    let ahead = &ahead[strip..][..STRIP];
                    for i in 0..STRIP {
                        to[i] = start + ahead[i];
                    }
                    strip += STRIP;
                }
            }
        }
    }
}
