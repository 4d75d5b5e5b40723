//! The distance to a surface without end, measured tile by tile where it is asked for.
//!
//! A tile's surface is found when a point of it is first asked about, and kept. It is found as far
//! around the tile as lengths reach, so distances beyond that are no more than bounds. No lock is
//! held while a tile is made: two threads may make the same one, and the first is kept.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, PoisonError, RwLock};

use glam::{DAffine3, DVec3};

use super::accuracy::Accuracy;
use super::apart::sign;
use super::compile::Compiled;
use super::composite::points64;
use super::source::{DistanceSource, Wanted};
use crate::{Bounds, Dual, Interval, ParamError, Run, Solid};
use rvachev_field::{AnyField, Chunk, Patches, SurfaceDistance, VALUE_LIMIT, Zone, steep_slopes};
#[cfg(feature = "formula")]
use rvachev_num::symbol::Symbol;

/// How long a tile's side is, in lengths.
const SIDE: f64 = 8.0;

/// Ranges over more tiles than this are not told.
const MANY: usize = 8;

type Tile = Arc<SurfaceDistance>;

/// The distance to the surface of a solid without end.
pub(super) struct Tiles {
    pub(super) solid: Solid,
    pub(super) sign: Arc<dyn AnyField>,
    pub(super) bounds: Bounds,
    pub(super) length: f64,
    tolerance: Option<f64>,
    pub(super) source: &'static dyn DistanceSource,
    made: RwLock<HashMap<[i64; 3], Tile>>,
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
        let Wanted { length, tolerance, .. } = *wanted;
        let (sign, bounds) = (sign(programs), programs.bounds);
        Tiles { solid, sign, bounds, length, tolerance, source, made: RwLock::default() }
    }

    /// How far the surface of any tile may be off. No tile has been looked at, and no error found.
    pub(super) fn accuracy(&self, programs: &Compiled) -> Accuracy {
        let region = self.region([0; 3]);
        let tolerance = self.source.tolerance(programs, &self.wanted(&region));
        Accuracy { tolerance, error: 0.0 }
    }

    fn wanted<'a>(&self, region: &'a Bounds) -> Wanted<'a> {
        Wanted { length: self.length, tolerance: self.tolerance, region }
    }

    fn side(&self) -> f64 {
        SIDE * self.length
    }

    fn key(&self, p: DVec3) -> [i64; 3] {
        (p / self.side()).round().to_array().map(|c| c as i64)
    }

    /// The box of a tile; that of the first is about the origin.
    fn region(&self, key: [i64; 3]) -> Bounds {
        Bounds::from_center(DVec3::from_array(key.map(|c| c as f64)) * self.side(), DVec3::splat(0.5 * self.side()))
    }

    /// The tile with a number.
    fn tile(&self, key: [i64; 3]) -> Tile {
        if let Some(tile) = self.made.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return tile.clone();
        }
        let region = self.region(key);
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
        let tile = Arc::new(SurfaceDistance::new(patches, self.sign.clone(), error, None, self.bounds));
        let mut made = self.made.write().unwrap_or_else(PoisonError::into_inner);
        made.entry(key).or_insert(tile).clone()
    }

    fn at(&self, p: DVec3) -> Tile {
        self.tile(self.key(p))
    }

    /// The tiles that a zone meets, with the part of it in each, if they are not many.
    fn parts(&self, zone: &Zone) -> Option<Vec<(Tile, Zone)>> {
        let hull = zone.hull();
        if !zone.is_finite() {
            return None;
        }
        let [low, high] = [hull.map(Interval::lo), hull.map(Interval::hi)].map(DVec3::from_array);
        let (from, to) = (self.key(low), self.key(high));
        if from == to {
            return Some(vec![(self.tile(from), *zone)]);
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
                    let tile = self.region([x, y, z]);
                    let part = Bounds::new(tile.min.max(low), tile.max.min(high));
                    parts.push((self.tile([x, y, z]), Zone::of_bounds(&part)));
                }
            }
        }
        Some(parts)
    }

    /// The tile that all points of a chunk are in, if there is one.
    fn only(&self, mut points: impl Iterator<Item = [f64; 3]>) -> Option<Tile> {
        let key = self.key(DVec3::from_array(points.next()?));
        points.all(|p| self.key(DVec3::from_array(p)) == key).then(|| self.tile(key))
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
        5e-7 * (reach + 2.0 * self.side())
    }

    fn value(&self, p: [f64; 3]) -> f64 {
        self.at(DVec3::from_array(p)).value(p)
    }

    fn dual(&self, p: [Dual<f64>; 3]) -> Dual<f64> {
        self.at(DVec3::from_array(p.map(Dual::value))).dual(p)
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
        parts.iter().map(|(tile, part)| tile.range(part)).reduce(Interval::hull).unwrap_or(everything)
    }

    fn narrowed(&self, zone: &Zone) -> Option<Arc<dyn AnyField>> {
        match &self.parts(zone)?[..] {
            [(tile, part)] => Some(tile.narrowed(part).unwrap_or_else(|| tile.clone())),
            _ => None,
        }
    }

    #[cfg(feature = "formula")]
    fn symbol<'a>(&self, [x, _, _]: [Symbol<'a>; 3]) -> Symbol<'a> {
        // Programs with measured distances are not lowered.
        rvachev_num::Real::lift(x, -VALUE_LIMIT)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 1>) {
        let Chunk { points, placement, out: [out] } = chunk;
        let local = |i: usize| placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i])));
        if let Some(tile) = self.only((0..out.len()).map(local)) {
            return tile.lanes32(Chunk { points, placement, out: [out] });
        }
        for (i, out) in out.iter_mut().enumerate() {
            *out = placement.finish(self.value(local(i))) as f32;
        }
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 1>) {
        points64(self, chunk);
    }

    fn gradients(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out } = chunk;
        let local = |i: usize| placement.apply([0, 1, 2].map(|axis| f64::from(points[axis][i])));
        if let Some(tile) = self.only((0..points[0].len()).map(local)) {
            return tile.gradients(Chunk { points, placement, out });
        }
        for (i, p) in (0..points[0].len()).map(local).enumerate() {
            let dual = self.dual(Dual::point(p));
            let slope = placement.pull(dual.gradient().map(|part| part * placement.scale));
            out[0][i] = placement.finish(dual.value()) as f32;
            for axis in 0..3 {
                out[axis + 1][i] = slope[axis] as f32;
            }
        }
    }
}
