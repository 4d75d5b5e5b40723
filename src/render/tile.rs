//! A tile of a picture: its rays are taken through the tree of cells together.
//!
//! ```text
//!     eye *---------------+-------+      A box's pixels are a rectangle. Parts of the tree are
//!          \ `--.._   near | far  |      visited from the front to the back, which is the same
//!           \      `--.._  |      |      for all rays of a tile; a ray that has hit something is
//!            \           `-|.._   |      done, and boxes without rays are passed over.
//!             `------------+------`
//! ```

use glam::DVec3;

use super::cells::{Cell, Cells, Part};
use super::gbuffer::{Surface, Window};
use super::march::{Marcher, Ray, Span};
use crate::{Bounds, Rays};

/// Pixels along a tile's side: the bits of a word.
pub(super) const TILE: u32 = 64;

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Tracer {
    marcher: Marcher,
    rays: Vec<Ray>,
    spans: Vec<Span>,
}

/// The rays of a tile that are still under way, a word a row.
struct Alive([u64; TILE as usize]);

/// Rows and columns of a tile, the last exclusive.
#[derive(Clone, Copy)]
struct Rectangle {
    top: usize,
    bottom: usize,
    columns: u64,
}

impl Tracer {
    /// What the pixels of `tile` see, row by row; `inside` tells whether the eye of a perspective
    /// camera is in the solid, which no other has.
    pub(super) fn tile(&mut self, cells: &Cells, view: &View<'_>, tile: Window) -> Vec<Surface> {
        let mut surfaces = vec![Surface::NONE; tile.count()];
        let mut alive = Alive([0; TILE as usize]);
        self.rays.clear();
        let bounds = cells.bounds();
        for y in 0..tile.height {
            for x in 0..tile.width {
                let (origin, direction) = tile.ray(view.rays, x, y);
                let (ray, enters) = entering(cells, bounds, origin, direction, view.inside);
                self.rays.push(ray);
                if enters {
                    alive.0[y as usize] |= 1 << x;
                }
            }
        }
        let Part::Cell(root) = cells.root() else { return surfaces };
        let mut pending: Vec<&Cell> = vec![root];
        while let Some(cell) = pending.pop() {
            let Some(rectangle) = view.rectangle(&cell.bounds, &tile) else { continue };
            let count = alive.count(rectangle);
            if count == 0 {
                continue;
            }
            if divides(cell, count) {
                let halves = cell.halves();
                let above = view.looks_up(halves.axis, halves.plane);
                let [near, far] = if above { [0, 1] } else { [1, 0] };
                for part in [&halves.parts[far], &halves.parts[near]] {
                    if let Part::Cell(cell) = part {
                        pending.push(cell);
                    }
                }
                continue;
            }
            self.spans.clear();
            for y in rectangle.top..rectangle.bottom {
                let mut bits = alive.0[y] & rectangle.columns;
                while bits != 0 {
                    let ray = y as u32 * tile.width + bits.trailing_zeros();
                    bits &= bits - 1;
                    if let Some((near, far)) = span(&cell.bounds, &self.rays[ray as usize]) {
                        self.spans.push(Span { ray, near, far });
                    }
                }
            }
            if self.spans.is_empty() {
                continue;
            }
            self.marcher.march(cells, cell, &self.rays, &self.spans, &mut surfaces);
            for &ray in &self.marcher.hits {
                alive.0[(ray / tile.width) as usize] &= !(1 << (ray % tile.width));
            }
        }
        surfaces
    }

    /// What a list of rays meets, each an origin and a unit direction.
    pub(super) fn list(&mut self, cells: &Cells, rays: &[(DVec3, DVec3)], surfaces: &mut [Surface]) {
        let bounds = cells.bounds();
        self.rays.clear();
        let mut octants: [Vec<u32>; 8] = Default::default();
        for (number, &(origin, direction)) in (0..).zip(rays) {
            let (ray, enters) = entering(cells, bounds, origin, direction, None);
            self.rays.push(ray);
            if enters {
                let octant = (0..3).map(|axis| usize::from(direction[axis] < 0.0) << axis).sum::<usize>();
                octants[octant].push(number);
            }
        }
        let Part::Cell(root) = cells.root() else { return };
        let mut done = vec![false; rays.len()];
        for (octant, list) in octants.into_iter().enumerate() {
            // Cells with the rays that may pass them: the list's tail from `first`.
            let mut lists = list;
            let mut pending: Vec<(&Cell, usize, usize)> = vec![(root, 0, lists.len())];
            while let Some((cell, first, end)) = pending.pop() {
                lists.truncate(end);
                self.spans.clear();
                for &ray in &lists[first..end] {
                    if done[ray as usize] {
                        continue;
                    }
                    if let Some((near, far)) = span(&cell.bounds, &self.rays[ray as usize]) {
                        self.spans.push(Span { ray, near, far });
                    }
                }
                if self.spans.is_empty() {
                    continue;
                }
                if divides(cell, self.spans.len()) {
                    let halves = cell.halves();
                    let [near, far] = if octant >> halves.axis & 1 == 0 { [0, 1] } else { [1, 0] };
                    let first = lists.len();
                    lists.extend(self.spans.iter().map(|span| span.ray));
                    for part in [&halves.parts[far], &halves.parts[near]] {
                        if let Part::Cell(cell) = part {
                            pending.push((cell, first, lists.len()));
                        }
                    }
                    continue;
                }
                self.marcher.march(cells, cell, &self.rays, &self.spans, surfaces);
                for &ray in &self.marcher.hits {
                    done[ray as usize] = true;
                }
            }
        }
    }
}

/// A picture's rays.
pub(super) struct View<'a> {
    pub(super) rays: &'a Rays,
    /// Whether the eye is in the solid, if rays meet in it.
    pub(super) inside: Option<bool>,
}

impl<'a> View<'a> {
    pub(super) fn new(cells: &Cells, rays: &'a Rays) -> View<'a> {
        View { rays, inside: rays.meeting_point().map(|eye| cells.contains(eye)) }
    }

    /// The pixels of a tile that may see the box.
    fn rectangle(&self, bounds: &Bounds, tile: &Window) -> Option<Rectangle> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in bounds.corners() {
            let Some(at) = self.rays.project(corner) else {
                return Some(Rectangle { top: 0, bottom: tile.height as usize, columns: columns(0, tile.width) });
            };
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        // A pixel counts if its ray is within the box's outline, give or take rounding.
        let clip = |axis: usize, first: u32, count: u32, within: f64| {
            let low = (low[axis] - within - 1e-3 - f64::from(first)).ceil().clamp(0.0, f64::from(count));
            let high = (high[axis] - within + 1e-3 - f64::from(first)).floor() + 1.0;
            (low as u32, high.clamp(0.0, f64::from(count)) as u32)
        };
        let (left, right) = clip(0, tile.left, tile.width, tile.within.0);
        let (top, bottom) = clip(1, tile.top, tile.height, tile.within.1);
        (left < right && top < bottom).then(|| Rectangle {
            top: top as usize,
            bottom: bottom as usize,
            columns: columns(left, right),
        })
    }

    /// Whether rays cross the plane from below to above, if at all.
    fn looks_up(&self, axis: usize, plane: f64) -> bool {
        match self.rays.meeting_point() {
            Some(eye) => eye[axis] < plane,
            None => self.rays.forward()[axis] >= 0.0,
        }
    }
}

/// The bits from `left` up to `right`, exclusive.
fn columns(left: u32, right: u32) -> u64 {
    let below = |end: u32| if end >= 64 { u64::MAX } else { (1 << end) - 1 };
    below(right) & !below(left)
}

impl Alive {
    fn count(&self, rectangle: Rectangle) -> usize {
        let rows = &self.0[rectangle.top..rectangle.bottom];
        rows.iter().map(|row| (row & rectangle.columns).count_ones() as usize).sum()
    }
}

/// A ray made ready, and whether it meets the box of all cells.
fn entering(cells: &Cells, bounds: &Bounds, origin: DVec3, direction: DVec3, inside: Option<bool>) -> (Ray, bool) {
    let inverse = direction.recip();
    let mut ray = Ray { origin, direction, inverse, base: 0.0, inside: false };
    let Some((near, _)) = span(bounds, &ray) else { return (ray, false) };
    if near > 0.0 {
        // From far away, points have rounding errors: the ray starts anew where it enters.
        ray.base = near;
        ray.origin = origin + near * direction;
    } else {
        ray.inside = inside.unwrap_or_else(|| cells.contains(origin));
    }
    (ray, true)
}

/// The part of a ray in a box. Two boxes that share a face share the distance to its plane, to
/// the bit.
#[inline]
fn span(bounds: &Bounds, ray: &Ray) -> Option<(f64, f64)> {
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (o, inverse) = (ray.origin[axis], ray.inverse[axis]);
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        if inverse.is_infinite() {
            // Along the planes: those below belong to the box.
            if !(low <= o && o < high) {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - o) * inverse, (high - o) * inverse);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near < far).then_some((near, far))
}

/// Cells of one leaf whose value bends one way are divided down to this part of the whole.
const PLAIN: f64 = 1.0 / 8.0;

/// Whether `count` rays are better off in the halves of a cell.
fn divides(cell: &Cell, count: usize) -> bool {
    let share = cell.share;
    let leaves = cell.program.leaf_count();
    if leaves == 1 && cell.bend.is_some() {
        return share > PLAIN;
    }
    if leaves == 1 {
        return share > 1.0 / 16.0 || (count > 512 && share > 1.0 / 256.0);
    }
    share > 1.0 / 512.0 && count.max(32) * leaves > 512
}
