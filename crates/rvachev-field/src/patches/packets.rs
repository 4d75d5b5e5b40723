//! Packets of points: into the surface's frame, through the search, and back as values and
//! gradients.

use glam::{DAffine3, DMat3, DVec3};
use rvachev_num::Real;

use super::packet::Packet;
use super::plane::Plane;
use super::search::Range;

use super::{Foot, Patches, SurfaceDistance};
use crate::kernel::Element;
use crate::{Chunk, Placement, VALUE_LIMIT};

/// Points farther out than this, in units of the surface's frame, are moved there: no square
/// overflows single precision.
const FARTHEST: f64 = 1e15;

/// How near, in units of the surface's frame, single precision leaves too little of the direction
/// to the foot.
const CLOSE: f64 = 1e-4;

/// What is nearer to the patches is on the surface, as far as stored numbers tell.
const ON_SURFACE: f64 = 4.0 * f32::EPSILON as f64;

/// Distances that are so near to the level that rounding may turn their signs are told apart, in
/// units of the frame.
const LEAST: f64 = 1e-5;

/// Patches that were nearest to the packet before, none of them twice.
#[derive(Default)]
pub(super) struct Seeds {
    patches: [u32; 4],
    count: usize,
}

impl Seeds {
    #[inline(always)]
    pub(super) fn known(&self) -> &[u32] {
        &self.patches[..self.count]
    }

    #[inline(always)]
    pub(super) fn start(&mut self, patch: u32) {
        (self.patches[0], self.count) = (patch, 1);
    }

    #[inline(always)]
    pub(super) fn take<R: Packet>(&mut self, which: R) {
        let (all, count) = which.all();
        self.count = 0;
        let mut i = 0;
        while i < count && self.count < self.patches.len() {
            let patch = all[i] as u32;
            if !self.known().contains(&patch) {
                self.patches[self.count] = patch;
                self.count += 1;
            }
            i += 1;
        }
    }
}

/// A point that is close to the surface: the patch that is nearest to it, and its sign.
pub(super) struct Close {
    pub(super) p: [f32; 3],
    pub(super) patch: u32,
    pub(super) sign: f32,
}

/// A chunk's way into the surface's frame and back.
pub(super) struct Packets<'a> {
    leaf: &'a SurfaceDistance,
    pub(super) patches: &'a Patches,
    placement: &'a Placement,
    /// Into the surface's frame; a value there is scaled and shifted to one outside.
    local: Placement,
    farthest: f64,
    /// The distance on the positive side where values are 0, and how far from it distances are told
    /// apart.
    level: f64,
    band: f64,
    /// The square of the distance from which on it makes a difference on which side a point is.
    sided: f64,
    /// The square of how near double precision is needed, or the side of the patch.
    close: f64,
}

impl SurfaceDistance {
    /// The way of a chunk.
    pub(super) fn packets<'a>(&'a self, placement: &'a Placement, band: f64) -> Packets<'a> {
        let frame = &self.patches.frame;
        let mut across = DVec3::ONE;
        if let Some(axis) = self.flat {
            across[axis] = 0.0;
        }
        let flattened = DAffine3::from_mat3(DMat3::from_diagonal(across)) * placement.map();
        let mut map = DAffine3::from_mat3(flattened.matrix3 * (1.0 / frame.unit));
        map.translation = frame.into_local(flattened.translation);
        let local = Placement::new(&map, placement.scale * frame.unit, placement.shift);
        let level = -placement.shift / local.scale;
        let farthest = VALUE_LIMIT / frame.unit;
        let band = (band / local.scale.abs()).max(LEAST);
        // Nearer than the band to the level is neither side; what is as near as stored numbers tell
        // is on the surface.
        let sided = if band == f64::INFINITY { 0.0 } else { level.abs() - band };
        Packets {
            leaf: self,
            patches: &self.patches,
            placement,
            local,
            farthest,
            level,
            band,
            sided: sided.max(ON_SURFACE).powi(2),
            close: CLOSE.max(self.error() / frame.unit).powi(2),
        }
    }
}

impl Packets<'_> {
    /// A packet in the surface's frame.
    #[inline(always)]
    pub(super) fn local<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        let [x, y, z] = self.local.apply(p);
        [held(x), held(y), held(z)]
    }

    /// The ways from the nearest points of flat patches to those of a packet.
    #[inline(always)]
    pub(super) fn ways<R: Packet>(&self, local: [R; 3], which: R) -> [R; 3] {
        let (all, count) = which.all();
        let mut ways = [which.lift(0.0); 3];
        let mut i = 0;
        while i < count {
            if !all[..i].contains(&all[i])
                && let Some((face, _)) = self.patches.at(all[i] as usize)
            {
                let other = -(which - f64::from(all[i])).abs();
                let [x, y, z] = Plane::single(face).way(local);
                ways = [other.select(x, ways[0]), other.select(y, ways[1]), other.select(z, ways[2])];
            }
            i += 1;
        }
        ways
    }

    /// The squares of the distances to be told apart, given signs.
    #[inline(always)]
    pub(super) fn range<R: Packet>(&self, sign: R) -> Range<R> {
        let zero = sign.lift(0.0);
        if self.band == f64::INFINITY {
            return Range::all(sign);
        }
        let level = sign.select(sign.lift(self.level), sign.lift(-self.level));
        // Of a point that may be on either side, that is asked where it may be near the level.
        let level = (-sign.abs()).select(level.abs(), level);
        let (low, high) = ((level - self.band).max(zero), (level + self.band).max(zero));
        Range { low: low.square(), high: high.square() }
    }

    /// Whether it makes a difference on which side a point is that is so far from the surface.
    pub(super) fn has_side(&self, square: f64) -> bool {
        square >= self.sided
    }

    /// The sign of a point where lanes of the sign field have told none.
    pub(super) fn side(&self, p: [f64; 3]) -> f64 {
        self.leaf.sign(self.placement.apply(p))
    }

    /// The signed distances, as they count outside.
    #[inline(always)]
    pub(super) fn value<R: Real>(&self, square: R, sign: R) -> R {
        let distance = square.sqrt().min(sign.lift(self.farthest));
        let signed = sign.select(distance, -distance);
        self.local.finish((-sign.abs()).select(sign.lift(0.0), signed))
    }

    /// The gradients: away from the feet where the value is positive, else towards them.
    #[inline(always)]
    pub(super) fn slope<R: Real>(&self, from: [R; 3], square: R, sign: R) -> [R; 3] {
        let per_distance = sign.lift(self.placement.scale) / square.sqrt().max(sign.lift(1e-30));
        let k = sign.select(per_distance, -per_distance);
        let mut along = [from[0] * k, from[1] * k, from[2] * k];
        if let Some(axis) = self.leaf.flat {
            along[axis] = sign.lift(0.0);
        }
        self.placement.pull(along)
    }

    /// Whether some of the points need [`close`](Packets::close).
    #[inline(always)]
    pub(super) fn are_close<R: Packet>(&self, square: R) -> bool {
        square.any_below(square.lift(self.close))
    }

    /// Values and gradients of points whose nearest patches are known, in double precision.
    pub(super) fn close(&self, points: &[Close]) -> Vec<[f32; 4]> {
        let foot = |close: &Close| {
            let p = self.leaf.flattened(DVec3::from_array(self.placement.apply(close.p.map(f64::from))));
            (p, self.patches.foot_on(close.patch as usize, p))
        };
        let found: Vec<(DVec3, Option<Foot>)> = points.iter().map(foot).collect();
        let mut falls = vec![false; points.len()];
        self.falls(&found, &mut falls);
        let jet = |((close, (p, foot)), falls): ((&Close, &(DVec3, Option<Foot>)), &bool)| {
            let (value, slope) = self.leaf.towards(*p, *foot, f64::from(close.sign), |_| *falls);
            let [x, y, z] = self.placement.pull(slope.map(|part| part * self.placement.scale));
            [self.placement.finish(value), x, y, z].map(|v| v as f32)
        };
        points.iter().zip(&found).zip(&falls).map(jet).collect()
    }

    /// Whether the sign's field falls on the way from their feet to points, of which it is asked.
    fn falls(&self, found: &[(DVec3, Option<Foot>)], falls: &mut [bool]) {
        let asked = self.leaf.doubtful(found);
        let Some((last, _)) = asked.last() else { return };
        let count = asked.len().next_multiple_of(f32::widest());
        let numbers = asked.iter().map(|(number, _)| number).chain(std::iter::repeat(last)).take(count);
        let points: Vec<[f32; 3]> = numbers.map(|number| found[*number].0.as_vec3().to_array()).collect();
        let [x, y, z] = [0, 1, 2].map(|axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<f32>>());
        let mut out = [(); 4].map(|()| vec![0.0f32; count]);
        let [value, dx, dy, dz] = &mut out;
        let (points, placement) = ([&x[..], &y[..], &z[..]], &Placement::IDENTITY);
        self.leaf.sign.gradients(Chunk { points, placement, out: [value, dx, dy, dz] });
        for (at, (number, away)) in asked.iter().enumerate() {
            falls[*number] = DVec3::new(dx[at].into(), dy[at].into(), dz[at].into()).dot(*away) < 0.0;
        }
    }

    /// Whether a point that far away needs [`close`](Packets::close).
    pub(super) fn is_close(&self, square: f32) -> bool {
        f64::from(square) < self.close
    }
}

/// A coordinate, held where its square does not overflow.
#[inline(always)]
fn held<R: Real>(x: R) -> R {
    x.max(x.lift(-FARTHEST)).min(x.lift(FARTHEST))
}
