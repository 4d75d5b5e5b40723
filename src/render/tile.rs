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
use rvachev_num::jobs;

use super::cells::{Cell, Cells, Part};
use super::fillets::Apart;
use super::gbuffer::{Surface, Window};
use super::job::{Ray, Span};
use super::march::Marcher;
use super::pixels::{Pixels, Rectangle, columns};
use super::slopes::Known;
use super::still::Mask;
use crate::{Bounds, Rays};

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct Tracer {
    mask: Mask,
    /// What the pixels of a tile see; nothing but while it is traced.
    surfaces: Vec<Surface>,
    /// Those that see anything.
    hit: Pixels,
    pub(super) marcher: Marcher,
    pub(super) rays: Vec<Ray>,
    pub(super) spans: Vec<Span>,
    /// Of those, what is nearer than what they have met.
    pub(super) nearer: Vec<Span>,
}

/// Divides what of the tree every tile would begin with, on all threads: none waits for another
/// then.
pub(super) fn divide_top(cells: &Cells, view: &View<'_>, window: &Window) {
    fn divide(part: &Part, sees: &(impl Fn(&Bounds) -> bool + Sync)) {
        let cell = match part {
            Part::Inside | Part::Outside => return,
            Part::Cell(cell) => cell,
            Part::Halves(halves) => {
                let [below, above] = &halves.parts;
                jobs::both(&mut || divide(below, sees), &mut || divide(above, sees));
                return;
            }
        };
        let is_plain = cell.bend.is_some() && cell.leaves == 1;
        if cell.share > COARSE && !is_plain && sees(&cell.bounds) {
            let [below, above] = &cell.halves().parts;
            jobs::both(&mut || divide(below, sees), &mut || divide(above, sees));
        }
    }
    let sees = |bounds: &Bounds| view.sees(bounds, window);
    match cells.still(view.rays) {
        Some(still) => {
            divide(still.leaf.root(), &sees);
            still.sides.iter().flatten().for_each(|side| divide_top(side, view, window));
        }
        None => {
            divide(cells.apart().filter(|_| view.inside != Some(true)).map_or(cells, |apart| &apart.rest).root(), &sees)
        }
    }
}

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
pub(super) struct Packet {
    /// The least and the greatest of their directions' components.
    low: DVec3,
    high: DVec3,
    /// Whether any of them starts inside the solid.
    pub(super) inside: bool,
    /// Where all of them come from, if that is one point.
    eye: Option<DVec3>,
}

impl Tracer {
    /// Puts what the pixels of `tile` see to its `rows`, in which there is nothing yet.
    pub(super) fn tile(&mut self, cells: &Cells, view: &View<'_>, tile: Window, rows: &mut [&mut [Surface]]) {
        let mut surfaces = std::mem::take(&mut self.surfaces);
        // Those of other pixels are never asked for.
        surfaces.resize(tile.count().max(surfaces.len()), Surface::NONE);
        self.rays.resize(tile.count().max(self.rays.len()), Ray::NONE);
        self.hit = Pixels::NONE;
        self.trace(cells, view, &tile, Pixels::ALL, &mut surfaces);
        for (y, row) in rows.iter_mut().enumerate() {
            let mut bits = self.hit.0[y];
            while bits != 0 {
                let x = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                row[x] = std::mem::replace(&mut surfaces[y * tile.width as usize + x], Surface::NONE);
            }
        }
        self.surfaces = surfaces;
    }

    /// What some of the pixels of a tile see.
    fn trace(&mut self, cells: &Cells, view: &View<'_>, tile: &Window, among: Pixels, surfaces: &mut [Surface]) {
        if let Some(still) = cells.still(view.rays) {
            let mut inside = still.inside(&mut self.mask, view, tile);
            let mut outside = among;
            for ((inside, outside), among) in inside.0.iter_mut().zip(&mut outside.0).zip(among.0) {
                *inside &= among;
                *outside = among & !*inside;
            }
            for (side, among) in still.sides.iter().zip([outside, inside]) {
                if let Some(side) = side {
                    self.trace(side, view, tile, among, surfaces);
                }
            }
            return;
        }
        let mut alive = Pixels::NONE;
        let bounds = cells.bounds();
        let mut packet = Packet::new(view.rays.meeting_point());
        // Parallel rays have a direction in common.
        let beam = view.rays.meeting_point().is_none().then(|| view.rays.forward()).map(inverse);
        if beam.is_some() {
            (packet.low, packet.high) = (view.rays.forward(), view.rays.forward());
        }
        let Some(seen) = view.rectangle(bounds, tile) else { return };
        for y in seen.top..seen.bottom {
            let mut bits = seen.columns & among.0[y];
            while bits != 0 {
                let x = bits.trailing_zeros();
                bits &= bits - 1;
                let (origin, direction) = tile.ray(view.rays, x, y as u32);
                let ray = &mut self.rays[y * tile.width as usize + x as usize];
                if enters(ray, cells, (origin, direction), beam, view.inside) {
                    alive.0[y] |= 1 << x;
                    if beam.is_some() {
                        packet.inside |= ray.inside;
                    } else {
                        packet.add(ray);
                    }
                }
            }
        }
        // Rays that meet in a point start there.
        let starts = if packet.eye.is_some() { 1 } else { usize::MAX };
        let are_outside = |apart: &&Apart| {
            alive.numbers(tile.width, seen).iter().take(starts).all(|ray| self.starts_outside(apart, *ray))
        };
        match cells.apart().filter(|_| !packet.inside).filter(are_outside) {
            None => self.walk(cells, view, tile, packet, alive, surfaces),
            Some(apart) => {
                self.walk(&apart.rest, view, tile, packet, alive, surfaces);
                let near = |bounds: &Bounds| {
                    view.rectangle(bounds, tile).map_or_else(Vec::new, |within| alive.numbers(tile.width, within))
                };
                let open = self.besides(cells, apart, near, surfaces);
                self.note(tile, None);
                let mut again = Pixels::NONE;
                for ray in open {
                    let (row, bit) = ((ray / tile.width) as usize, 1 << (ray % tile.width));
                    again.0[row] |= bit;
                    self.hit.0[row] &= !bit;
                    surfaces[ray as usize] = Surface::NONE;
                }
                self.walk(cells, view, tile, packet, again, surfaces);
            }
        }
    }

    /// Takes the rays of some pixels through the tree.
    fn walk(
        &mut self,
        cells: &Cells,
        view: &View<'_>,
        tile: &Window,
        packet: Packet,
        mut alive: Pixels,
        surfaces: &mut [Surface],
    ) {
        let Part::Cell(root) = cells.root() else { return };
        let tie = TIE * cells.bounds().longest_side();
        let mut pending: Vec<&Cell> = vec![root];
        while let Some(cell) = pending.pop() {
            let Some(rectangle) = view.rectangle(&cell.bounds, tile) else { continue };
            let count = alive.count(rectangle);
            if count == 0 {
                continue;
            }
            let united = packet.united(cell);
            let is_whole = united.is_some_and(are_told);
            let known = if is_whole { Known::ANY } else { packet.slopes(searched(united, cell)) };
            if !packet.inside && united.is_none() && known.slopes.falls {
                // Seen from behind.
                continue;
            }
            if !is_whole && divides(cell, count, &known) {
                cell.halves().far_first(&|axis, plane| view.looks_up(axis, plane), &mut |cell| pending.push(cell));
                continue;
            }
            self.marcher.hits.clear();
            for part in united.unwrap_or(std::slice::from_ref(cell)) {
                let Some(rectangle) = view.rectangle(&part.bounds, tile) else { continue };
                self.spans.clear();
                for y in rectangle.top..rectangle.bottom {
                    let mut bits = alive.0[y] & rectangle.columns;
                    while bits != 0 {
                        let ray = y as u32 * tile.width + bits.trailing_zeros();
                        bits &= bits - 1;
                        if let Some(span) = nearer(part, ray, &self.rays, surfaces, tie) {
                            self.spans.push(span);
                        }
                    }
                }
                if !self.spans.is_empty() {
                    let known = if united.is_some() { packet.slopes(part) } else { known.clone() };
                    self.marcher.march(cells, part, &known, &self.rays, &self.spans, surfaces);
                }
            }
            self.note(tile, Some(&mut alive));
        }
    }

    /// Notes that the pixels whose rays have hit something see it, and that these are done.
    fn note(&mut self, tile: &Window, mut alive: Option<&mut Pixels>) {
        for &ray in &self.marcher.hits {
            let (row, bit) = ((ray / tile.width) as usize, 1 << (ray % tile.width));
            self.hit.0[row] |= bit;
            if let Some(alive) = &mut alive {
                alive.0[row] &= !bit;
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
    pub(super) fn rectangle(&self, bounds: &Bounds, tile: &Window) -> Option<Rectangle> {
        let [left, right, top, bottom] = self.sides(bounds, tile)?;
        Some(Rectangle { top: top as usize, bottom: bottom as usize, columns: columns(left, right) })
    }

    /// How many pixels see a box, in a picture that goes on without end.
    pub(super) fn covers(&self, bounds: &Bounds) -> f64 {
        self.rays.outline(bounds).map_or(0.0, |outline| outline.iter().map(|[low, high]| high - low).product())
    }

    /// Whether pixels of a window may see the box.
    fn sees(&self, bounds: &Bounds, window: &Window) -> bool {
        self.sides(bounds, window).is_some()
    }

    /// The pixels of a window that may see the box: columns from left to right, rows from top to
    /// bottom.
    fn sides(&self, bounds: &Bounds, window: &Window) -> Option<[u32; 4]> {
        let outline = self.rays.outline(bounds)?;
        // A pixel counts if its ray is within the box's outline, give or take rounding.
        let clip = |axis: usize, first: u32, count: u32, within: f64| {
            let [low, high] = outline[axis];
            let low = (low - within - 1e-3 - f64::from(first)).ceil().clamp(0.0, f64::from(count));
            let high = (high - within + 1e-3 - f64::from(first)).floor() + 1.0;
            (low as u32, high.clamp(0.0, f64::from(count)) as u32)
        };
        let (left, right) = clip(0, window.left, window.width, window.within.0);
        let (top, bottom) = clip(1, window.top, window.height, window.within.1);
        (left < right && top < bottom).then_some([left, right, top, bottom])
    }

    /// Whether rays cross the plane from below to above, if at all.
    fn looks_up(&self, axis: usize, plane: f64) -> bool {
        match self.rays.meeting_point() {
            Some(eye) => eye[axis] < plane,
            None => self.rays.forward()[axis] >= 0.0,
        }
    }
}

impl Packet {
    pub(super) fn new(eye: Option<DVec3>) -> Packet {
        Packet { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, inside: false, eye }
    }

    pub(super) fn add(&mut self, ray: &Ray) {
        self.low = self.low.min(ray.direction);
        self.high = self.high.max(ray.direction);
        self.inside |= ray.inside;
    }

    /// What a cell unites that the rays look for one by one, from outside.
    pub(super) fn united<'a>(&self, cell: &'a Cell) -> Option<&'a [Cell]> {
        if self.inside || cell.bend.is_some() || cell.share > COARSE { None } else { cell.united() }
    }

    /// The slopes of the value that the rays may find in a cell; all, of a cell whose slopes are
    /// not worth knowing.
    pub(super) fn slopes(&self, cell: &Cell) -> Known {
        if let Some(steepest) = cell.rolled {
            return Known::steep(steepest);
        }
        if cell.bend.is_some() || cell.leaves > MANY || cell.share > COARSE {
            return Known::ANY;
        }
        // Those from the eye to any point of the cell are asked for by other tiles as well.
        let [low, high] = self.eye.and_then(|eye| cone(&cell.bounds, eye)).unwrap_or([self.low, self.high]);
        cell.slopes(low, high)
    }
}

impl Ray {
    /// Of a pixel that sees nothing.
    pub(super) const NONE: Ray =
        Ray { origin: DVec3::ZERO, direction: DVec3::ZERO, inverse: DVec3::ZERO, base: 0.0, inside: false };
}

/// The least and the greatest components of the directions from `eye` to a box, if it is far enough
/// away for these to differ little.
fn cone(bounds: &Bounds, eye: DVec3) -> Option<[DVec3; 2]> {
    let near = (eye.clamp(bounds.min, bounds.max) - eye).length();
    if bounds.longest_side() > NARROW * near {
        return None;
    }
    let far = near + bounds.size().length();
    let (low, high) = (bounds.min - eye, bounds.max - eye);
    let least = DVec3::select(low.cmplt(DVec3::ZERO), low / near, low / far);
    let most = DVec3::select(high.cmpgt(DVec3::ZERO), high / near, high / far);
    Some([least - 1e-9, most + 1e-9])
}

/// The inverse of a direction's components: a number instead of infinity, so that planes at a
/// distance of 0 stay there.
#[inline(always)]
fn inverse(direction: DVec3) -> DVec3 {
    direction.recip().clamp(DVec3::splat(-STEEPEST), DVec3::splat(STEEPEST))
}

/// Makes a ray ready; whether it meets the box of all cells. `known` is the inverse of its
/// direction, if others have the same.
#[inline(always)]
pub(super) fn enters(
    ray: &mut Ray,
    cells: &Cells,
    (origin, direction): (DVec3, DVec3),
    known: Option<DVec3>,
    inside: Option<bool>,
) -> bool {
    if !(origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO) {
        return false;
    }
    ray.inverse = known.unwrap_or_else(|| inverse(direction));
    (ray.origin, ray.direction, ray.base, ray.inside) = (origin, direction, 0.0, false);
    let Some((near, _)) = span(cells.bounds(), ray) else { return false };
    if near > 0.0 {
        // From far away, points have rounding errors: the ray starts anew where it enters.
        ray.base = near;
        ray.origin = origin + near * direction;
    } else {
        ray.inside = inside.unwrap_or_else(|| cells.contains(origin));
    }
    true
}

/// The part of a ray in a box. Two boxes that share a face share the distance to its plane, to
/// the bit.
#[inline(always)]
pub(super) fn span(bounds: &Bounds, ray: &Ray) -> Option<(f64, f64)> {
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
pub(super) fn nearer(cell: &Cell, ray: u32, rays: &[Ray], surfaces: &[Surface], tie: f64) -> Option<Span> {
    let at = &rays[ray as usize];
    let (near, far) = span(&cell.bounds, at)?;
    let far = far.min(surfaces[ray as usize].distance - at.base - tie);
    (near < far).then_some(Span { ray, near, far })
}

/// The inverse of a direction's component is at most this: a ray along a plane then passes the
/// box on one side of it from end to end, and that on the other not at all.
const STEEPEST: f64 = 1e200;

/// What of a cell takes rays longest: where it is united, what does not bend one way, the last.
pub(super) fn searched<'a>(united: Option<&'a [Cell]>, cell: &'a Cell) -> &'a Cell {
    united.and_then(<[Cell]>::last).unwrap_or(cell)
}

/// Whether all parts of a cell bend one way along rays, or tell balls in which nothing is: to
/// divide it would part them no further.
pub(super) fn are_told(parts: &[Cell]) -> bool {
    parts.iter().all(|part| part.bend.is_some() || part.rolled.is_some())
}

/// Cells of one leaf whose value bends one way are divided down to this part of the whole.
const PLAIN: f64 = 0.5;

/// The slopes of larger cells are hardly ever of one sign.
const COARSE: f64 = 0.2;

/// Nor are those of cells with more leaves.
const MANY: usize = 8;

/// Boxes up to this size, in proportion to their distance from the eye, are seen along much the
/// same direction.
const NARROW: f64 = 0.1;

/// A crossing of a united operand must be nearer by this part of the whole than one of those before
/// it.
pub(super) const TIE: f64 = 1e-7;

/// No cell is divided below this part of the whole.
const FINEST: f64 = 1.0 / 4096.0;

/// More rays than this, times leaves, are better off in the halves of a cell: to make one takes as
/// long as some dozens of them do; of leaves that search for their values, which many points
/// together take less of, if the values are no steeper than this: halves would have little else to
/// tell.
const RAYS: usize = 256;
const SEARCHED: usize = 512;
const STEEP: f64 = 4.0;

/// The same where the values are steeper, or the slopes are without bound: many a ray is divided by
/// intervals then.
const BLIND: usize = 16;

/// Whether `count` rays are better off in the halves of a cell, where slopes are `known`.
pub(super) fn divides(cell: &Cell, count: usize, known: &Known) -> bool {
    let Cell { share, leaves, cost, bend, .. } = *cell;
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
    let one_way = bent || known.is_one_way();
    let steepest = known.slopes.value.magnitude();
    let is_searched = cell.program.is_searched();
    let most = match (is_searched, steepest < STEEP) {
        (true, true) => SEARCHED,
        (false, true) => RAYS,
        (_, false) => BLIND,
    };
    let each = if is_searched { leaves } else { cost };
    let much = if one_way { cost > 1 && !cell.is_stale() && count * cost > 8192 } else { count * each > most };
    share > FINEST && much
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_hold_the_directions_to_their_boxes() {
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(9).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0;
        let mut narrow = 0;
        for n in 0..2000 {
            let bounds = Bounds::from_center(0.3 * vector(3 * n), 0.2 * vector(3 * n + 1).abs() + 1e-3);
            let eye = 4.0 * vector(3 * n + 2);
            let Some([low, high]) = cone(&bounds, eye) else { continue };
            narrow += 1;
            assert!((high - low).max_element() < 0.3);
            for m in 0..20 {
                let p = bounds.min + bounds.size() * (vector(20 * n + m) + 1.0) / 2.0;
                let direction = (p - eye).normalize();
                assert!(direction.cmpge(low).all() && direction.cmple(high).all(), "{direction} {low} {high}");
            }
        }
        assert!(narrow > 500, "{narrow}");
    }
}
