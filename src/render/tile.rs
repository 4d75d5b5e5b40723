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
use super::job::{Ray, Span};
use super::march::Marcher;
use crate::{Bounds, Interval, Rays};

/// Pixels along a tile's side: the bits of a word.
pub(super) const TILE: u32 = 64;

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Tracer {
    marcher: Marcher,
    rays: Vec<Ray>,
    spans: Vec<Span>,
    /// Of those, what is nearer than what they have met.
    nearer: Vec<Span>,
}

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
struct Sheaf {
    /// The least and the greatest of their directions' components.
    low: DVec3,
    high: DVec3,
    /// Whether any of them starts inside the solid.
    inside: bool,
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
        let mut sheaf = Sheaf::EMPTY;
        let seen = view.rectangle(bounds, &tile);
        for y in 0..tile.height {
            for x in 0..tile.width {
                if !seen.is_some_and(|seen| seen.contains(x, y)) {
                    self.rays.push(Ray::NONE);
                    continue;
                }
                let (origin, direction) = tile.ray(view.rays, x, y);
                let (ray, enters) = entering(cells, bounds, origin, direction, view.inside);
                self.rays.push(ray);
                if enters {
                    alive.0[y as usize] |= 1 << x;
                    sheaf.add(&ray);
                }
            }
        }
        let Part::Cell(root) = cells.root() else { return surfaces };
        let tie = TIE * bounds.longest_side();
        let mut pending: Vec<&Cell> = vec![root];
        while let Some(cell) = pending.pop() {
            let Some(rectangle) = view.rectangle(&cell.bounds, &tile) else { continue };
            let count = alive.count(rectangle);
            if count == 0 {
                continue;
            }
            let united = sheaf.united(cell);
            let slope = if united.is_some() { Interval::ALL } else { sheaf.slope(cell) };
            if !sheaf.inside && slope.hi() <= 0.0 {
                // Seen from behind.
                continue;
            }
            if united.is_none() && divides(cell, count, slope) {
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
            self.marcher.hits.clear();
            for part in united.unwrap_or(std::slice::from_ref(cell)) {
                let Some(rectangle) = view.rectangle(&part.bounds, &tile) else { continue };
                self.spans.clear();
                for y in rectangle.top..rectangle.bottom {
                    let mut bits = alive.0[y] & rectangle.columns;
                    while bits != 0 {
                        let ray = y as u32 * tile.width + bits.trailing_zeros();
                        bits &= bits - 1;
                        self.spans.extend(nearer(part, ray, &self.rays, &surfaces, tie));
                    }
                }
                if !self.spans.is_empty() {
                    self.marcher.march(cells, part, slope, &self.rays, &self.spans, &mut surfaces);
                }
            }
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
        let tie = TIE * bounds.longest_side();
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
                let mut sheaf = Sheaf::EMPTY;
                self.spans.iter().for_each(|span| sheaf.add(&self.rays[span.ray as usize]));
                let united = sheaf.united(cell);
                let slope = if united.is_some() { Interval::ALL } else { sheaf.slope(cell) };
                if !sheaf.inside && slope.hi() <= 0.0 {
                    continue;
                }
                if united.is_none() && divides(cell, self.spans.len(), slope) {
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
                self.marcher.hits.clear();
                for part in united.unwrap_or(std::slice::from_ref(cell)) {
                    let rays = self.spans.iter().map(|span| span.ray);
                    self.nearer.clear();
                    self.nearer.extend(rays.filter_map(|ray| nearer(part, ray, &self.rays, surfaces, tie)));
                    if !self.nearer.is_empty() {
                        self.marcher.march(cells, part, slope, &self.rays, &self.nearer, surfaces);
                    }
                }
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
        let outline = self.rays.outline(bounds)?;
        // A pixel counts if its ray is within the box's outline, give or take rounding.
        let clip = |axis: usize, first: u32, count: u32, within: f64| {
            let [low, high] = outline[axis];
            let low = (low - within - 1e-3 - f64::from(first)).ceil().clamp(0.0, f64::from(count));
            let high = (high - within + 1e-3 - f64::from(first)).floor() + 1.0;
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

impl Rectangle {
    fn contains(&self, x: u32, y: u32) -> bool {
        (self.top..self.bottom).contains(&(y as usize)) && self.columns >> x & 1 == 1
    }
}

impl Sheaf {
    const EMPTY: Sheaf = Sheaf { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, inside: false };

    fn add(&mut self, ray: &Ray) {
        self.low = self.low.min(ray.direction);
        self.high = self.high.max(ray.direction);
        self.inside |= ray.inside;
    }

    /// What a cell unites that the rays look for one by one, from outside.
    fn united<'a>(&self, cell: &'a Cell) -> Option<&'a [Cell]> {
        if self.inside || cell.bend.is_some() || cell.share > COARSE { None } else { cell.united() }
    }

    /// The slopes of the value that the rays may find in a cell; all, of a cell whose slopes are
    /// not worth knowing.
    fn slope(&self, cell: &Cell) -> Interval {
        if cell.bend.is_some() || cell.leaves > MANY || cell.share > COARSE {
            return Interval::ALL;
        }
        cell.slope(self.low, self.high)
    }
}

impl Ray {
    /// Of a pixel that sees nothing.
    const NONE: Ray =
        Ray { origin: DVec3::ZERO, direction: DVec3::ZERO, inverse: DVec3::ZERO, base: 0.0, inside: false };
}

/// A ray made ready, and whether it meets the box of all cells.
fn entering(cells: &Cells, bounds: &Bounds, origin: DVec3, direction: DVec3, inside: Option<bool>) -> (Ray, bool) {
    if !(origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO) {
        return (Ray::NONE, false);
    }
    // A number instead of infinity, so that planes at a distance of 0 stay there.
    let inverse = direction.recip().clamp(DVec3::splat(-STEEPEST), DVec3::splat(STEEPEST));
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
#[inline(always)]
fn span(bounds: &Bounds, ray: &Ray) -> Option<(f64, f64)> {
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (o, inverse) = (ray.origin[axis], ray.inverse[axis]);
        let (a, b) = ((bounds.min[axis] - o) * inverse, (bounds.max[axis] - o) * inverse);
        let (a, b) = if a < b { (a, b) } else { (b, a) };
        near = if a > near { a } else { near };
        far = if b < far { b } else { far };
    }
    (near < far).then_some((near, far))
}

/// The part of a ray in a cell that is nearer by `tie` than what the ray has met.
#[inline(always)]
fn nearer(cell: &Cell, ray: u32, rays: &[Ray], surfaces: &[Surface], tie: f64) -> Option<Span> {
    let at = &rays[ray as usize];
    let (near, far) = span(&cell.bounds, at)?;
    let far = far.min(surfaces[ray as usize].distance - at.base - tie);
    (near < far).then_some(Span { ray, near, far })
}

/// The inverse of a direction's component is at most this: a ray along a plane then passes the
/// box on one side of it from end to end, and that on the other not at all.
const STEEPEST: f64 = 1e200;

/// Cells of one leaf whose value bends one way are divided down to this part of the whole.
const PLAIN: f64 = 0.5;

/// The slopes of larger cells are hardly ever of one sign.
const COARSE: f64 = 0.2;

/// Nor are those of cells with more leaves.
const MANY: usize = 8;

/// A crossing of a united operand must be nearer by this part of the whole than one of those before
/// it.
const TIE: f64 = 1e-7;

/// No cell is divided below this part of the whole.
const FINEST: f64 = 1.0 / 4096.0;

/// Whether `count` rays are better off in the halves of a cell, where `slope` is what they may
/// find.
fn divides(cell: &Cell, count: usize, slope: Interval) -> bool {
    let Cell { share, leaves, bend, .. } = *cell;
    let bent = bend.is_some();
    if bent && leaves == 1 {
        return share > PLAIN;
    }
    if share > COARSE {
        return true;
    }
    if leaves > MANY && !cell.is_stale() {
        return share > FINEST;
    }
    let one_way = bent || slope.lo() >= 0.0 || slope.hi() <= 0.0;
    let cost = count * leaves;
    share > FINEST && if one_way { cost > 2048 && leaves > 1 } else { cost > 64 }
}
