//! The nearest points of two surfaces.
//!
//! ```text
//!        a               Over a flat triangle with corners a, b, c, the squared distance from a set, less the
//!       / \              squared distance from any point, is concave: at a point p of it
//!      / p \                  d²(p) ≥ Σ λᵢ d²(corner i) − Σ λᵢ |corner i − p|²
//!     b-----c            and the last sum is at most a third of the longest side squared.
//!  ~~~~~~~~~~~~~ set
//! ```
//!
//! Boxes of the patches of one surface are divided, those that are farther from the other surface
//! than the nearest points that are known left out, and then the patches that are left, until none
//! can be nearer by more than a tolerance. The bound is off by the square of the size: of a gap
//! that is even, it takes few divisions. Where the other solid's value changes by 1 per length unit
//! at most, a range of it is a bound as well, and of the other solid itself, however its patches
//! are.

use glam::DVec3;
use rvachev_field::{Approach, Patches, Zone};
use rvachev_num::jobs;

use super::levels::Levels;
use super::piece::Piece;
use super::{AT_ONCE, Side, common, distance};
use crate::eval::Block;
use crate::query::nearest;
use crate::{Bounds, Cancelled, Run};

/// How near the least distance is found, as a part of it, and of the sizes of the solids.
const RELATIVE: f64 = 1e-3;
const OF_SIZES: f64 = 1e-5;

/// What is divided gains more than this part of how exact the surfaces are.
const GAIN: f64 = 0.25;

/// After so many points the work ends, with what tolerance there is.
const MOST: usize = 1 << 21;

/// A sum that is more than its parts by this is so after rounding.
const ABOVE: f64 = 1.0 + 1e-12;

/// Steps from one surface to the other and back that end the search.
const STEPS: usize = 30;

/// What was found of two surfaces.
pub(super) struct Found {
    /// The nearest points that were found, on the surfaces themselves.
    pub(super) points: [DVec3; 2],
    /// No point of the one surface, but where that is in doubt, is nearer to the other solid.
    pub(super) least: f64,
    /// Whether that holds of the patches of the other surface only, to within what these are exact.
    pub(super) leans: bool,
    /// What that may be less by than the distance of the points, or more.
    pub(super) loss: f64,
    /// A point of both solids, if a part of the one surface was seen to be within the other solid.
    pub(super) common: Option<DVec3>,
}

/// How something is from the other surface.
enum Place {
    /// No nearer than that, and whether that leans on the patches.
    Apart(f64, bool),
    /// The same within the other solid.
    Within,
    /// It may be as near as that.
    Open(f64),
}

/// How near a point of a piece is that is nearest of those that were asked, and that point.
type End = Option<(f64, DVec3)>;

/// Two surfaces, of which the first is divided.
struct Search<'a> {
    from: &'a Side<'a>,
    to: &'a Side<'a>,
    slack: f64,
    is_gentle: bool,
    /// The nearest points of the surfaces that are known.
    points: [DVec3; 2],
    /// The point of the patches that is nearest to those of the other surface, with the distance.
    nearest: (f64, DVec3),
    least: f64,
    leans: bool,
    within: Option<DVec3>,
}

/// The nearest points of both surfaces; of the first those near its patches.
pub(super) fn search(from: &Side<'_>, to: &Side<'_>, run: &Run) -> Result<Found, Cancelled> {
    let mut search = Search::new(from, to);
    let [to_open, to_divide] = run.stages([0.4, 0.6]);
    if search.touch() {
        (search.least, search.leans) = (0.0, true);
    } else {
        let near = search.near(&to_open)?;
        search.divide(near, &to_divide)?;
        search.learn(0.0);
    }
    let (distance, loss) = (search.known(), search.loss());
    let Search { points, least, leans, within, slack, .. } = search;
    let common = within.and_then(|p| common(from, to, slack, p));
    // A sheet within the other has no point below its surface by what counts.
    let least = if within.is_some() { 0.0 } else { least.min(distance).max(0.0) };
    Ok(Found { points, least, leans, loss, common })
}

impl<'a> Search<'a> {
    fn new(from: &'a Side<'a>, to: &'a Side<'a>) -> Search<'a> {
        let points = refined(from, to, greedy(from, to));
        Search {
            from,
            to,
            slack: from.fineness() + to.fineness(),
            is_gentle: to.is_gentle,
            points,
            nearest: (f64::INFINITY, points[0]),
            least: f64::INFINITY,
            leans: false,
            within: None,
        }
    }

    fn known(&self) -> f64 {
        self.points[0].distance(self.points[1])
    }

    /// Whether they touch, or cross each other, at the points that are known.
    fn touch(&self) -> bool {
        self.known() <= self.slack
    }

    /// How much nearer others may be without being looked for.
    fn loss(&self) -> f64 {
        let sizes: f64 = [self.from, self.to].iter().map(|side| side.surface.patches.bounds().longest_side()).sum();
        // Where it is in doubt a surface may be nearer by that much in any case.
        let doubt = |side: &Side<'_>| if side.is_known { 0.0 } else { side.exactness() };
        let of = |side: &Side<'_>| [3.0 * side.fineness(), doubt(side)];
        let [fine, coarse] = of(self.from);
        let [fine_other, coarse_other] = if self.is_gentle { [0.0; 2] } else { of(self.to) };
        RELATIVE * self.known() + (fine + fine_other).max(coarse + coarse_other) + OF_SIZES * sizes
    }

    /// What is no nearer need not be looked at.
    fn enough(&self) -> f64 {
        self.known() - self.loss()
    }

    /// Goes to the surfaces from the nearest point of the patches, if that is nearer than what is
    /// known by more than this.
    fn learn(&mut self, by: f64) {
        let (number, p) = self.nearest;
        if number < self.known() - by {
            let points = refined(self.from, self.to, p);
            if points[0].distance(points[1]) < self.known() {
                self.points = points;
            }
        }
    }

    /// Whether parts of a piece would tell more than how exact the surfaces are leaves open: bounds
    /// are off by s² / 6d at a distance d. Patches that are off have no parts that are not.
    fn gains(&self, piece: &Piece) -> bool {
        piece.longest_side().powi(2) > 6.0 * self.known().max(self.slack) * GAIN * self.slack
    }

    /// No point of the surface at a piece is nearer to the other solid, as its value tells.
    fn by_value(&self, piece: &Piece, enough: f64) -> f64 {
        let (patches, by) = (&self.from.surface.patches, self.from.fineness());
        let middle = piece.middle();
        let at_once = -self.to.program.value(middle) - piece.reach(patches) - by;
        if at_once >= enough { at_once } else { -self.to.program.close_range(&piece.slab(patches, by)).hi() }
    }

    /// A place by a bound of the other's value and one of the distance from its patches.
    fn place(&self, enough: f64, middle: DVec3, by_value: f64, by_patches: impl FnOnce() -> f64) -> Place {
        if by_value >= enough && by_value > 0.0 {
            return Place::Apart(by_value, false);
        }
        let by_patches = by_patches() - self.slack;
        if by_patches < enough || by_patches <= 0.0 {
            return Place::Open(by_patches.max(by_value));
        }
        if self.to.program.value(middle) > 0.0 { Place::Within } else { Place::Apart(by_patches, true) }
    }

    /// What is left when those are left out that are apart, or within the other.
    fn sift<T: Copy>(&mut self, all: &[T], places: &[Place], point: impl Fn(&T) -> DVec3) -> Vec<T> {
        let mut open = Vec::new();
        for (own, place) in all.iter().zip(places) {
            match place {
                Place::Apart(bound, leans) => {
                    self.least = self.least.min(*bound);
                    self.leans |= *leans;
                }
                Place::Within => self.within = self.within.or_else(|| Some(point(own))),
                Place::Open(_) => open.push(*own),
            }
        }
        open
    }

    /// The patches in boxes that are not known to be farther than the nearest points.
    fn near(&mut self, run: &Run) -> Result<Vec<usize>, Cancelled> {
        let (runs, patches, others) = (self.from.surface.runs(), &self.from.surface.patches, &self.to.surface.patches);
        let mut blocks: Vec<Block> = runs.all().into_iter().collect();
        let mut near = Vec::new();
        let mut levels = Levels::new(run);
        while !blocks.is_empty() {
            let enough = self.enough();
            let place = |block: &Block| {
                let (centre, radius) = ball(runs.bounds(*block));
                let by_value = || -self.to.program.value(centre) - radius - self.from.fineness();
                let by_value = if self.is_gentle { by_value() } else { f64::NEG_INFINITY };
                self.place(enough, centre, by_value, || {
                    let by_ball = distance(others, centre) - radius;
                    let is_enough = by_ball - self.slack >= enough;
                    let zone = || Zone::of_bounds(runs.bounds(*block));
                    let by_box = if is_enough { None } else { others.apart(&zone(), enough + self.slack) };
                    by_box.unwrap_or(by_ball)
                })
            };
            let mut places: Vec<Place> = Vec::with_capacity(blocks.len());
            for some in levels.chunks(&blocks, 16 * AT_ONCE) {
                let some = some?;
                places.extend(jobs::in_order(some.len(), |n| place(&some[n])));
            }
            let open = self.sift(&blocks, &places, |block| patches.point(runs.patches(*block).start, [0.0; 2]));
            let patches;
            (blocks, patches) = runs.opened(&open);
            near.extend(patches);
            levels.down()?;
        }
        Ok(near)
    }

    /// Divides patches until what is left is not nearer than what is known, or there is too much.
    /// Tells how many points were asked.
    fn divide(&mut self, near: Vec<usize>, run: &Run) -> Result<usize, Cancelled> {
        let (patches, others) = (&self.from.surface.patches, &self.to.surface.patches);
        let mut pieces: Vec<Piece> = near.iter().map(|n| Piece::whole(patches, *n)).collect();
        let mut asked = 0;
        let mut levels = Levels::new(run);
        while !pieces.is_empty() {
            asked += 3 * pieces.len();
            let mut next = Vec::new();
            for some in levels.chunks(&pieces, 16 * AT_ONCE) {
                let some = some?;
                let enough = self.enough();
                let look = |piece: &Piece| {
                    let mut own = *piece;
                    let by_value = if self.is_gentle { self.by_value(piece, enough) } else { f64::NEG_INFINITY };
                    // Of flat patches the triangle is asked at once.
                    let mut nearest = None;
                    let is_flat = piece.off(patches) <= self.from.fineness();
                    let place = self.place(enough, piece.middle(), by_value, || {
                        if is_flat && others.is_flat() {
                            // What is farther than what counts need not be known of it.
                            let off = piece.off(patches);
                            let most = if enough > 0.0 { (enough + self.slack + off) * ABOVE } else { f64::INFINITY };
                            nearest = others.approach_within(piece.points, most);
                            return nearest.map_or(most, |Approach { distance, .. }| distance) - off;
                        }
                        own = own.numbered(|p| distance(others, p));
                        least_of(&own, patches)
                    });
                    let corners = own.numbers.into_iter().zip(own.points);
                    let nearest = nearest.map(|found| (found.distance, found.point));
                    let best = nearest.or_else(|| corners.min_by(|a, b| a.0.total_cmp(&b.0)));
                    (own, (place, best))
                };
                let found = jobs::in_order(some.len(), |n| look(&some[n]));
                let (found, told): (Vec<Piece>, Vec<(Place, End)>) = found.into_iter().unzip();
                let (places, ends): (Vec<Place>, Vec<End>) = told.into_iter().unzip();
                let open = ends.iter().zip(&places).filter(|(_, place)| matches!(place, Place::Open(_)));
                let ends = open.filter_map(|(end, _)| *end);
                if let Some(best) = ends.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0 < self.nearest.0) {
                    self.nearest = best;
                    self.learn(self.slack);
                }
                let open = self.sift(&found, &places, Piece::middle);
                if asked <= MOST {
                    next.extend(open.into_iter().filter(|piece| self.gains(piece)));
                }
                for (piece, place) in found.iter().zip(&places) {
                    if let Place::Open(bound) = place
                        && !(asked <= MOST && self.gains(piece))
                    {
                        (self.least, self.leans) = (self.least.min(*bound), true);
                    }
                }
            }
            if self.touch() {
                (self.least, self.leans) = (0.0, true);
                break;
            }
            levels.down()?;
            pieces = Vec::with_capacity(4 * next.len());
            for some in next.chunks(16 * AT_ONCE) {
                run.check()?;
                let divided = |n: usize| {
                    // What is told of some parts by the other's value, or as a triangle, needs no
                    // numbers.
                    let is_asked = !self.is_gentle && !some[n].numbers[0].is_nan();
                    some[n].divided(patches, |p| if is_asked { distance(others, p) } else { f64::NAN })
                };
                pieces.extend(jobs::in_order(some.len(), divided).into_iter().flatten());
            }
        }
        Ok(asked)
    }
}

/// A point of the patches of one surface that is near the other, found by going down to the nearer
/// of two boxes.
fn greedy(from: &Side<'_>, to: &Side<'_>) -> DVec3 {
    let (runs, patches, others) = (from.surface.runs(), &from.surface.patches, &to.surface.patches);
    let far = |block: &Block| distance(others, runs.bounds(*block).center());
    let mut at = runs.all();
    let mut last = at;
    while let Some(block) = at {
        last = at;
        at = runs.parts(block).min_by(|a, b| far(a).total_cmp(&far(b)));
    }
    let points = last.into_iter().flat_map(|block| runs.patches(block)).map(|n| patches.point(n, [1.0 / 3.0; 2]));
    points.min_by(|a, b| distance(others, *a).total_cmp(&distance(others, *b))).unwrap_or_default()
}

/// The nearest points of the surfaces about a point: from each where the other is.
fn refined(from: &Side<'_>, to: &Side<'_>, p: DVec3) -> [DVec3; 2] {
    let there = to.surface.patches.nearest(p).map_or(p, |foot| foot.point);
    let mut points = [p, there];
    let mut apart = f64::INFINITY;
    for _ in 0..STEPS {
        let Some(there) = nearest(to.program, &to.surface.patches, points[0]) else { break };
        let Some(here) = nearest(from.program, &from.surface.patches, there) else { break };
        points = [here, there];
        let gain = apart - here.distance(there);
        apart = here.distance(there);
        if gain.abs() <= 1e-12 * apart {
            break;
        }
    }
    points
}

/// A ball about a box.
pub(super) fn ball(bounds: &Bounds) -> (DVec3, f64) {
    (bounds.center(), bounds.half_extents().length())
}

/// What no point of a piece is nearer to the other surface than.
fn least_of(piece: &Piece, patches: &Patches) -> f64 {
    let corner = piece.numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let longest = piece.longest_side();
    (corner * corner - longest * longest / 3.0).max(0.0).sqrt() - piece.off(patches)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Solid;
    use crate::distance::{compiled, surface_of};

    /// Patches that are off by more than is asked for stay so, however small their parts are.
    #[test]
    fn what_is_off_is_not_divided_further() {
        let plate = Solid::cuboid([30.0, 30.0, 5.0]) - Solid::cylinder(5.1, 10.0);
        let solids = [Solid::cylinder(5.0, 20.0), plate];
        let programs = solids.each_ref().map(|solid| compiled(solid).unwrap());
        let surfaces = solids.each_ref().map(|solid| surface_of(solid).unwrap());
        let [peg, plate] = [0, 1].map(|n| Side::new(&programs[n], &surfaces[n], false));
        for (from, to) in [(&peg, &plate), (&plate, &peg)] {
            let mut search = Search::new(from, to);
            let near = search.near(&Run::default()).unwrap();
            let asked = search.divide(near, &Run::default()).unwrap();
            assert!(asked < MOST / 16, "{asked} points");
            assert!(search.least > 0.08, "{}", search.least);
        }
    }
}
