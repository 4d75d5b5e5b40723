//! The distance to a surface without end, measured tile by tile where it is asked for.
//!
//! A tile's surface is found when a point of it is first asked about, and kept, unless so much is
//! asked about later that all would take too much memory. It is found as far
//! around the tile as lengths reach, so distances beyond that are no more than bounds. No lock is
//! held while a tile is made: two threads may make the same one, and the first is kept. Of a
//! surface that repeats, as lattices do, the tiles of one cell are made.

use std::collections::{HashMap, VecDeque};
use std::fmt;
use std::sync::{Arc, PoisonError, RwLock};

use glam::{DAffine3, DMat3, DVec3};

use super::accuracy::Accuracy;
use super::apart::sign;
use super::compile::Compiled;
use super::composite::points64;
use super::source::{DistanceSource, Wanted};
use super::tiling::{Key, Representative, Tiling};
use crate::{Bounds, Dual, Interval, ParamError, Run, Solid};
use rvachev_field::kernel::{distinct, repeat};
use rvachev_field::{AnyField, Chunk, Patches, Placement, SurfaceDistance, VALUE_LIMIT, Zone, steep_slopes};
use rvachev_num::symbol::Symbol;

/// How long a tile's side is, in lengths.
const SIDE: f64 = 8.0;

/// Ranges over more tiles than this are not told.
const MANY: usize = 8;

/// So many bytes of tiles are kept.
const KEPT: usize = 1 << 30;

/// The surfaces of tiles, the earliest first.
#[derive(Default)]
struct Made {
    surfaces: HashMap<Key, Arc<SurfaceDistance>>,
    order: VecDeque<Key>,
    bytes: usize,
}

impl Made {
    /// The surface of a tile, which is kept, if none is known; the earliest are left out where all
    /// take more than so many bytes.
    fn keep(&mut self, key: Key, surface: SurfaceDistance, most: usize) -> Arc<SurfaceDistance> {
        if let Some(known) = self.surfaces.get(&key) {
            return known.clone();
        }
        let surface = Arc::new(surface);
        self.bytes += surface.patches().bytes();
        self.surfaces.insert(key, surface.clone());
        while self.bytes > most
            && let Some(earliest) = self.order.pop_front()
        {
            self.bytes -= self.surfaces.remove(&earliest).map_or(0, |left| left.patches().bytes());
        }
        self.order.push_back(key);
        surface
    }
}

/// A tile's surface, and how far it is moved to where it is asked for.
#[derive(Clone)]
struct Tile {
    surface: Arc<SurfaceDistance>,
    by: DVec3,
}

impl Tile {
    /// A point where the surface was found.
    fn local(&self, p: [f64; 3]) -> [f64; 3] {
        (DVec3::from_array(p) - self.by).to_array()
    }

    /// A placement, for points where the surface was found.
    fn placement(&self, placement: &Placement) -> Placement {
        if self.by == DVec3::ZERO {
            return *placement;
        }
        Placement::new(&(DAffine3::from_translation(-self.by) * placement.map()), placement.scale, placement.shift)
    }

    fn zone(&self, zone: &Zone) -> Zone {
        match self.by == DVec3::ZERO {
            true => *zone,
            false => zone.mapped(&DAffine3::from_translation(-self.by)),
        }
    }
}

/// The distance to the surface of a solid without end.
pub(super) struct Tiles {
    pub(super) solid: Solid,
    pub(super) sign: Arc<dyn AnyField>,
    pub(super) bounds: Bounds,
    pub(super) length: f64,
    asked: f64,
    tolerance: Option<f64>,
    pub(super) source: &'static dyn DistanceSource,
    period: Option<DMat3>,
    tiling: Tiling,
    made: RwLock<Made>,
}

impl fmt::Debug for Tiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tiles").field("sign", &self.sign).field("length", &self.length).finish_non_exhaustive()
    }
}

impl Tiles {
    pub(super) fn new(
        solid: Solid,
        programs: &Compiled,
        wanted: &Wanted<'_>,
        source: &'static dyn DistanceSource,
    ) -> Tiles {
        let Wanted { length, asked, tolerance, .. } = *wanted;
        let (sign, bounds) = (sign(programs), programs.bounds());
        let period = programs.surface.period();
        let tiling = Tiling::new(SIDE * length, period);
        Tiles { solid, sign, bounds, length, asked, tolerance, source, period, tiling, made: RwLock::default() }
    }

    /// How far the surface of any tile may be off. No tile has been looked at, and no error found.
    pub(super) fn accuracy(&self, programs: &Compiled) -> Accuracy {
        let region = self.tiling.region([0; 3]);
        let tolerance = self.source.tolerance(programs, &self.wanted(&region));
        Accuracy::of_surface(tolerance, 0.0)
    }

    fn wanted<'a>(&self, region: &'a Bounds) -> Wanted<'a> {
        Wanted { asked: self.asked, ..Wanted::of(self.length, self.tolerance, region) }
    }

    /// The tile with a number.
    fn tile(&self, key: Key) -> Tile {
        let Representative { of, by } = self.tiling.copy(key);
        if let Some(surface) = self.made.read().unwrap_or_else(PoisonError::into_inner).surfaces.get(&of) {
            return Tile { surface: surface.clone(), by };
        }
        let region = self.tiling.region(of);
        let found = super::compile::kept(&self.solid).and_then(|programs| {
            self.source.surface(&self.solid, &programs, &self.wanted(&region), &Run::default()).ok()
        });
        let (patches, error) = match found {
            Some(surface) => (surface.patches, surface.accuracy.error),
            None => match Patches::new(&[], &Run::default()) {
                Ok(none) => (Arc::new(none), 0.0),
                Err(_) => unreachable!("nobody has the token"),
            },
        };
        let surface = SurfaceDistance::new(patches, self.sign.clone(), error, None, self.bounds);
        let mut made = self.made.write().unwrap_or_else(PoisonError::into_inner);
        Tile { surface: made.keep(of, surface, KEPT), by }
    }

    fn at(&self, p: DVec3) -> Tile {
        self.tile(self.tiling.key(p))
    }

    /// The tiles that a zone meets, with the part of it in each where its surface was found, if
    /// they are not many.
    fn parts(&self, zone: &Zone) -> Option<Vec<(Tile, Zone)>> {
        let hull = zone.hull();
        if !zone.is_finite() {
            return None;
        }
        let [low, high] = [hull.map(Interval::lo), hull.map(Interval::hi)].map(DVec3::from_array);
        let [from, to] = self.tiling.keys(&Bounds::new(low, high));
        if from == to {
            let tile = self.tile(from);
            let part = tile.zone(zone);
            return Some(vec![(tile, part)]);
        }
        let count =
            (0..3).map(|axis| to[axis].saturating_sub(from[axis]).saturating_add(1)).try_fold(1i64, i64::checked_mul);
        if count.is_none_or(|count| count > MANY as i64) {
            return None;
        }
        let mut parts = Vec::new();
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for z in from[2]..=to[2] {
                    let region = self.tiling.region([x, y, z]);
                    let part = Bounds::new(region.min.max(low), region.max.min(high));
                    if !part.is_empty() {
                        let tile = self.tile([x, y, z]);
                        let part = tile.zone(&Zone::of_bounds(&part));
                        parts.push((tile, part));
                    }
                }
            }
        }
        Some(parts)
    }

    /// The tile that all points of a chunk are in, if there is one.
    fn only(&self, mut points: impl Iterator<Item = [f64; 3]>) -> Option<Tile> {
        let key = self.tiling.key(DVec3::from_array(points.next()?));
        points.all(|p| self.tiling.key(DVec3::from_array(p)) == key).then(|| self.tile(key))
    }
}

impl AnyField for Tiles {
    fn name(&self) -> &'static str {
        "distance"
    }

    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        self.bounds.transformed(map)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn roundoff(&self, reach: f64) -> f64 {
        5e-7 * (reach + 2.0 * self.tiling.region([0; 3]).longest_side())
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        let tile = self.at(DVec3::from_array(p));
        tile.surface.value(tile.local(p))
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        let tile = self.at(DVec3::from_array(p.map(Dual::value)));
        let [x, y, z] = p;
        tile.surface.dual([x - tile.by.x, y - tile.by.y, z - tile.by.z])
    }

    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        Dual::new(self.range(&Zone::of_sides(p.map(Dual::value))), steep_slopes(1.0, p))
    }

    fn exact(&self) -> bool {
        true
    }

    fn growth(&self) -> DVec3 {
        DVec3::ONE
    }

    fn period(&self) -> Option<DMat3> {
        self.period
    }

    fn convex(&self) -> bool {
        false
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn is_formula(&self) -> bool {
        false
    }

    fn range(&self, zone: &Zone) -> Interval {
        let everything = Interval::new(-VALUE_LIMIT, VALUE_LIMIT);
        let Some(parts) = self.parts(zone) else { return everything };
        parts.iter().map(|(tile, part)| tile.surface.range(part)).reduce(Interval::hull).unwrap_or(everything)
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        match &self.parts(zone)?[..] {
            [(tile, part)] if tile.by == DVec3::ZERO => {
                Some(tile.surface.narrowed(part).unwrap_or_else(|| tile.surface.clone()))
            }
            // A copy is not a leaf of its own.
            _ => None,
        }
    }

    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with measured distances are not lowered.
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let local = |i: usize| placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i])));
        let own = distinct(points);
        if let Some(tile) = self.only((0..own).map(local)) {
            let placement = &tile.placement(placement);
            return tile.surface.lanes32(Chunk { points, placement, out: [out] });
        }
        for (i, out) in out[..own].iter_mut().enumerate() {
            *out = placement.finish(self.value(local(i))) as f32;
        }
        repeat(out, own);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        points64(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out } = chunk;
        let local = |i: usize| placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i])));
        let own = distinct(points);
        if let Some(tile) = self.only((0..own).map(local)) {
            let placement = &tile.placement(placement);
            return tile.surface.gradients(Chunk { points, placement, out });
        }
        for (i, p) in (0..own).map(local).enumerate() {
            let dual = self.dual(Dual::point(p));
            let slope = placement.pull(dual.gradient().map(|part| part * placement.scale));
            out[0][i] = placement.finish(dual.value()) as f32;
            for axis in 0..3 {
                out[axis + 1][i] = slope[axis] as f32;
            }
        }
        out.into_iter().for_each(|list| repeat(list, own));
    }
}

#[cfg(test)]
mod tests {
    use std::any::Any;

    use super::*;
    use crate::eval::apart::measured;
    use crate::{MinimalSurface, NetworkLattice, rad};

    /// A lattice a little out of place, eroded.
    fn eroded() -> Solid {
        let lattice = NetworkLattice { surface: MinimalSurface::Gyroid, cell: 4.0, fraction: 0.6 };
        Solid::from(lattice).rotate_z(rad(0.3)).translate(DVec3::new(0.3, -0.2, 0.7)).offset(-0.25)
    }

    #[test]
    fn of_a_lattice_one_cell_is_measured() {
        let solid = eroded();
        let period = DMat3::from_rotation_z(0.3) * DMat3::from_diagonal(DVec3::splat(4.0));
        for i in 0..40 {
            let p = DVec3::new(0.37, 0.11, 0.23) * f64::from(i);
            let steps = DVec3::new(f64::from(i % 7) - 3.0, f64::from(i % 5) - 1.0, f64::from(3 * i));
            let [here, there] = [p, p + period * steps].map(|p| solid.value(p).unwrap());
            assert!((here - there).abs() < 1e-9, "{here} and {there} at {p}");
        }
        let measured = measured(&solid).unwrap();
        let tiles = (&*measured.field as &dyn Any).downcast_ref::<Tiles>().unwrap();
        assert!(tiles.made.read().unwrap().surfaces.len() <= 8);
    }

    #[test]
    fn of_tiles_that_take_much_the_earliest_are_left_out() {
        let sign: Arc<dyn AnyField> = Arc::new(crate::Sphere { radius: 1.0 });
        let surface = || {
            let patches = [rvachev_field::Patch::flat([DVec3::X, DVec3::Y, DVec3::Z])];
            let patches = Arc::new(Patches::new(&patches, &Run::default()).unwrap());
            SurfaceDistance::new(patches, sign.clone(), 0.0, None, Bounds::ALL)
        };
        let (mut made, one) = (Made::default(), surface().patches().bytes());
        for key in 0..5 {
            let first = made.keep([key; 3], surface(), 3 * one);
            assert!(Arc::ptr_eq(&first, &made.keep([key; 3], surface(), 3 * one)));
        }
        assert_eq!((made.bytes, made.order.len()), (3 * one, 3));
        assert!((0..5).all(|key| made.surfaces.contains_key(&[key; 3]) == (key >= 2)));
        // The one that is asked for is never too much.
        made.keep([7; 3], surface(), 0);
        assert_eq!((made.bytes, made.surfaces.len()), (one, 1));
    }
}
