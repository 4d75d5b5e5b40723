//! What the surface is like in a cell that a crease passes.
//!
//! ```text
//!      +--------+      +--------+      The values and slopes at the corners of the cell are those of
//!      |  ____  |      |#\    /#|      a few planes. Where their least is the value, the solid is
//!      | /####\ |      |##\__/##|      within all of them, as at the edge of a box; where their
//!      +--------+      +--------+      greatest is, within any, as in a groove.
//!        convex          hollow
//! ```
//!
//! A single plane through such a cell would be off the edge by up to half a cell, now to this side
//! and now to that: the teeth of a comb, in the shadow of a straight edge.

use glam::{Vec3, Vec4};

use super::facet_block::{BIAS, VAGUE};

/// Planes of a cell.
const MOST: usize = 4;

/// Corners whose slopes are nearer to each other (cosine of 17°) see one plane.
const SAME: f32 = 0.956;

/// A few planes are of use if the values at the corners differ from theirs by less than this part
/// of what they differ by from a single plane's.
const BETTER: f32 = 0.5;

/// Points along a side at which it is looked whether a cell without inner corners has an inside.
const PROBES: i32 = 5;

/// A corner of a cell.
#[derive(Clone, Copy, Default)]
pub(super) struct Corner {
    /// In cells from the block's corner.
    pub(super) at: Vec3,
    pub(super) value: f32,
    /// By cell.
    pub(super) slopes: Vec3,
}

/// Some planes, each as its slopes and its value at the block's corner.
#[derive(Clone, Debug)]
pub(super) struct CreasedCell {
    planes: [Vec4; MOST],
    count: u8,
    is_convex: bool,
    /// Whether the planes say little of where the surface is.
    is_vague: bool,
}

/// Where a ray gets inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meeting {
    /// It passes a plane there.
    Enters(f32),
    /// It is inside from the beginning.
    Within,
    None,
}

impl CreasedCell {
    /// That of a cell whose values differ from a plane's by `off` at most. `None` if it is none.
    pub(super) fn new(corners: &[Corner; 8], off: f32) -> Option<CreasedCell> {
        let mut crease = CreasedCell { planes: [Vec4::ZERO; MOST], count: 0, is_convex: true, is_vague: false };
        let mut sums = [(Vec4::ZERO, Vec3::ZERO); MOST];
        for corner in corners {
            let direction = corner.slopes.normalize_or_zero();
            let plane = corner.slopes.extend(corner.value - corner.slopes.dot(corner.at));
            let count = usize::from(crease.count);
            let slot = (0..count).find(|&slot| sums[slot].1.dot(direction) > SAME).unwrap_or(count);
            if slot == MOST || direction == Vec3::ZERO || !plane.is_finite() {
                return None;
            }
            if slot == count {
                sums[slot].1 = direction;
                crease.count += 1;
            }
            sums[slot].0 += plane;
            crease.planes[slot].w += 1.0;
        }
        for (plane, sum) in crease.planes.iter_mut().zip(sums).take(usize::from(crease.count)) {
            *plane = sum.0 / plane.w;
        }
        let off_by =
            |crease: &CreasedCell| corners.iter().map(|c| (crease.value(c.at) - c.value).abs()).fold(0.0, f32::max);
        let hollow = CreasedCell { is_convex: false, ..crease.clone() };
        let (as_convex, as_hollow) = (off_by(&crease), off_by(&hollow));
        let mut best = if as_convex <= as_hollow { crease } else { hollow };
        let least = as_convex.min(as_hollow);
        best.is_vague = least > VAGUE;
        (best.count > 1 && least < BETTER * off).then_some(best)
    }

    /// That of a cell of which a single plane says little, and a few do not either.
    pub(super) fn vague(plane: Vec4) -> CreasedCell {
        let mut planes = [Vec4::ZERO; MOST];
        planes[0] = plane;
        CreasedCell { planes, count: 1, is_convex: true, is_vague: true }
    }

    pub(super) fn planes(&self) -> &[Vec4] {
        &self.planes[..usize::from(self.count)]
    }

    /// The value at a point, in cells from the block's corner.
    pub(super) fn value(&self, at: Vec3) -> f32 {
        let values = self.planes().iter().map(|plane| plane.dot(at.extend(1.0)));
        if self.is_convex { values.fold(f32::INFINITY, f32::min) } else { values.fold(f32::NEG_INFINITY, f32::max) }
    }

    /// Whether there is an inside in the cell about `middle`.
    pub(super) fn reaches(&self, middle: Vec3) -> bool {
        let along = |i: i32| (i as f32 + 0.5) / PROBES as f32 - 0.5;
        let at = |i: i32| middle + Vec3::new(along(i % PROBES), along(i / PROBES % PROBES), along(i / PROBES / PROBES));
        (0..PROBES * PROBES * PROBES).any(|i| self.value(at(i)) > 0.0)
    }

    /// The least, or where any will do the greatest, of what a bound of each plane is.
    pub(super) fn bound(&self, bound: impl Fn(Vec4) -> f32) -> f32 {
        let bounds = self.planes().iter().map(|plane| bound(*plane));
        if self.is_convex { bounds.fold(f32::INFINITY, f32::min) } else { bounds.fold(f32::NEG_INFINITY, f32::max) }
    }

    /// Where a ray gets inside between `t` and `end`; it is at `from` + t·`direction`, in cells
    /// from the block's corner.
    #[inline]
    pub(super) fn meet(&self, from: Vec4, direction: Vec4, t: f32, end: f32) -> Meeting {
        let met = if self.is_convex {
            self.meet_all(from, direction, t, end)
        } else {
            self.meet_any(from, direction, t, end)
        };
        match met {
            // A ray from the surface in it, or beside it, would meet that surface itself.
            Meeting::Enters(at) if self.is_vague && at < BIAS => Meeting::None,
            met => met,
        }
    }

    fn meet_all(&self, from: Vec4, direction: Vec4, t: f32, end: f32) -> Meeting {
        let (mut first, mut last, mut within) = (t, end, true);
        for plane in self.planes() {
            let (value, rate) = (plane.dot(from), plane.dot(direction));
            if value + t * rate <= 0.0 {
                within = false;
                if rate <= 0.0 {
                    return Meeting::None;
                }
                first = first.max(-value / rate);
            } else if rate < 0.0 {
                last = last.min(-value / rate);
            }
        }
        match first < last {
            _ if within => Meeting::Within,
            true => Meeting::Enters(first),
            false => Meeting::None,
        }
    }

    fn meet_any(&self, from: Vec4, direction: Vec4, t: f32, end: f32) -> Meeting {
        let (mut first, mut within) = (f32::INFINITY, false);
        for plane in self.planes() {
            let (value, rate) = (plane.dot(from), plane.dot(direction));
            if value + t * rate > 0.0 {
                within = true;
            } else if value + end * rate > 0.0 {
                first = first.min((-value / rate).max(t));
            }
        }
        // What is inside of one plane by rounding can pass another.
        match first < f32::INFINITY {
            true => Meeting::Enters(first),
            false if within => Meeting::Within,
            false => Meeting::None,
        }
    }
}

/// Where a ray gets inside of a single plane.
#[inline(always)]
pub(super) fn meet_plane(plane: Vec4, from: Vec4, direction: Vec4, t: f32, end: f32) -> Meeting {
    let (value, rate) = (plane.dot(from), plane.dot(direction));
    if value + t * rate > 0.0 {
        Meeting::Within
    } else if value + end * rate > 0.0 {
        Meeting::Enters((-value / rate).max(t))
    } else {
        Meeting::None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the cell from 0 to 1, of the least or greatest of two values.
    fn corners(value: impl Fn(Vec3) -> (f32, Vec3)) -> [Corner; 8] {
        std::array::from_fn(|n| {
            let at = Vec3::new((n & 1) as f32, (n >> 1 & 1) as f32, (n >> 2) as f32);
            let (value, slopes) = value(at);
            Corner { at, value, slopes }
        })
    }

    #[test]
    fn an_edge_is_where_it_is() {
        let planes = [(Vec3::new(-0.6, 0.0, -0.8), 0.75), (Vec3::new(0.8, 0.0, -0.6), -0.1)];
        let at = |p: Vec3, n: usize| (planes[n].0.dot(p) + planes[n].1, planes[n].0);
        let edge = |p: Vec3| if at(p, 0).0 < at(p, 1).0 { at(p, 0) } else { at(p, 1) };
        let crease = CreasedCell::new(&corners(edge), 0.2).unwrap();
        assert!(crease.is_convex && crease.count == 2);
        let groove = |p: Vec3| if at(p, 0).0 > at(p, 1).0 { at(p, 0) } else { at(p, 1) };
        let hollow = CreasedCell::new(&corners(groove), 0.2).unwrap();
        assert!(!hollow.is_convex && hollow.count == 2);
        for i in 0..200 {
            let near = |step: f32| (0.5 + step * i as f32).fract();
            let p = Vec3::new(near(0.819), near(0.671), near(0.549));
            assert!((crease.value(p) - edge(p).0).abs() < 1e-6 && (hollow.value(p) - groove(p).0).abs() < 1e-6);
            // Along a ray the first point inside is the one that small steps find.
            let d = (Vec3::new(near(0.357), near(0.211), near(0.733)) - 0.5).normalize();
            for crease in [&crease, &hollow] {
                let stepped = (0..=2000).map(|k| k as f32 / 2000.0).find(|t| crease.value(p + *t * d) > 0.0);
                match crease.meet(p.extend(1.0), d.extend(0.0), 0.0, 1.0) {
                    Meeting::Within => assert_eq!(stepped, Some(0.0)),
                    Meeting::Enters(t) if crease.value(p) <= 0.0 => {
                        assert!(stepped.is_none_or(|s| (s - t).abs() < 1e-3), "{t} {stepped:?}");
                    }
                    Meeting::Enters(_) => {}
                    Meeting::None => assert_eq!(stepped, None),
                }
            }
        }
        // One plane is none.
        assert!(CreasedCell::new(&corners(|p| at(p, 0)), 0.2).is_none());
        assert!(CreasedCell::new(&corners(|_| (0.0, Vec3::ZERO)), 0.2).is_none());
    }
}
