//! How far all patches are from a zone.
//!
//! ```text
//!     .-----------------.   zone      The ball about a flat zone reaches the surface long before the zone
//!     '-----------------'             does. So zones are compared with the boxes of the hierarchy, and with
//!     -------------------   patches   the planes of the patches in those that they meet.
//! ```

use glam::{DMat3, DVec3};

use super::Patches;
use super::face::{SLACK, double};
use super::hierarchy::{Node, PARENT};
use crate::Zone;

/// After so many boxes and patches it is given up: what is that close has smaller zones to be told
/// by.
const PATIENCE: usize = 512;

/// More patches than this are not listed.
const MANY: usize = 96;

/// A zone in the frame of the patches.
pub(super) struct Seen {
    low: DVec3,
    high: DVec3,
    centre: DVec3,
    axes: DMat3,
    slack: DVec3,
    /// The unit normals of its sides, of zones that are not along the axes.
    normals: [DVec3; 3],
}

impl Seen {
    /// How far a box is, at least.
    pub(super) fn box_gap(&self, low: DVec3, high: DVec3) -> f64 {
        (low - self.high).max(self.low - high).max(DVec3::ZERO).length()
    }

    /// How far a triangle is beyond one of the sides.
    fn side_gap(&self, corners: [DVec3; 3]) -> f64 {
        let gap = |normal: DVec3| {
            let heights = corners.map(|p| normal.dot(p - self.centre));
            let [low, high] = [f64::min, f64::max].map(|pick| pick(pick(heights[0], heights[1]), heights[2]));
            low.max(-high) - self.reach(normal)
        };
        self.normals.into_iter().map(gap).fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far it reaches from its centre along a direction.
    fn reach(&self, normal: DVec3) -> f64 {
        (self.axes.transpose() * normal).abs().element_sum() + normal.abs().dot(self.slack)
    }

    /// How far the plane through a point is, given its unit normal.
    fn plane_gap(&self, point: DVec3, normal: DVec3) -> f64 {
        (normal.dot(point - self.centre)).abs() - self.reach(normal)
    }
}

impl Patches {
    pub(super) fn seen(&self, zone: &Zone) -> Seen {
        let unit = self.frame.unit;
        let [x, y, z] = zone.hull();
        let [a, b, c] = [zone.axes.x_axis, zone.axes.y_axis, zone.axes.z_axis];
        // Of a flat zone one is left, of others none is needed.
        let normals = if zone.is_aligned() { [DVec3::ZERO; 3] } else { [b.cross(c), c.cross(a), a.cross(b)] };
        Seen {
            low: self.frame.into_local(DVec3::new(x.lo(), y.lo(), z.lo())),
            high: self.frame.into_local(DVec3::new(x.hi(), y.hi(), z.hi())),
            centre: self.frame.into_local(zone.centre),
            axes: zone.axes * (1.0 / unit),
            slack: zone.slack / unit,
            normals: normals.map(DVec3::normalize_or_zero),
        }
    }

    /// The unit normals of all patches that may be within `least` of a zone, and are flat; nothing
    /// where they are many.
    pub(super) fn normals_within(&self, zone: &Zone, least: f64) -> Option<Vec<DVec3>> {
        let (seen, least) = (self.seen(zone), least / self.frame.unit);
        let (mut found, mut looked) = (Vec::new(), 0);
        let mut open: Vec<&Node> = Vec::with_capacity(64);
        open.extend(self.nodes.first());
        while let Some(node) = open.pop() {
            if seen.box_gap(double(node.low), double(node.high)) > least {
                continue;
            }
            if node.count >= PARENT {
                open.extend([0, 1].map(|n| &self.nodes[node.first as usize + n]));
                continue;
            }
            for at in (node.first..node.first + node.count).map(|at| at as usize) {
                looked += 1;
                if self.patch_apart(&seen, at) <= least {
                    found.push(self.point_and_normal(at, 0.0, 0.0).1);
                }
            }
            if found.len() > MANY || looked > PATIENCE {
                return None;
            }
        }
        Some(found)
    }

    /// A distance above `least` that all points of a zone are from all patches; nothing where there
    /// is none, or it is not found soon.
    pub fn apart(&self, zone: &Zone, least: f64) -> Option<f64> {
        let (seen, unit) = (self.seen(zone), self.frame.unit);
        let least = least / unit;
        let mut nearest = f64::INFINITY;
        let mut looked = 0;
        let gap = |node: &Node| seen.box_gap(double(node.low), double(node.high));
        let mut open: Vec<&Node> = Vec::with_capacity(64);
        open.extend(self.nodes.first());
        while let Some(node) = open.pop() {
            if gap(node) >= nearest {
                continue;
            }
            looked += 1;
            if looked > PATIENCE {
                return None;
            }
            if node.count >= PARENT {
                let [a, b] = [0, 1].map(|n| &self.nodes[node.first as usize + n]);
                // What is near the middle tells soonest that there is no such distance.
                let away =
                    |node: &Node| seen.centre.distance_squared(seen.centre.clamp(double(node.low), double(node.high)));
                open.extend(if away(a) <= away(b) { [b, a] } else { [a, b] });
                continue;
            }
            for at in node.first..node.first + node.count {
                looked += 1;
                let mut gap = self.patch_apart(&seen, at as usize);
                // Of a rectangle, what a curved patch does not tell by its plane it does by a point.
                if gap < nearest && zone.is_flat() && !self.faces[at as usize].is_flat() {
                    let foot = self.closest(at as usize, seen.centre.to_array());
                    gap = gap.max(foot.square.sqrt() - zone.radius() / unit - SLACK);
                }
                nearest = nearest.min(gap);
                if nearest <= least {
                    return None;
                }
            }
        }
        Some(nearest * unit).filter(|nearest| nearest.is_finite())
    }

    /// How far points of a zone are from the patches at most, as the patch that is nearest to its
    /// middle tells, if all are above it.
    pub(super) fn beside(&self, zone: &Zone) -> Option<f64> {
        let seen = self.seen(zone);
        let at = self.search_one(seen.centre.to_array()).which as usize;
        let (face, sides) = self.at(at)?;
        let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
        let normal = e.cross(f).try_normalize()?;
        let is_within = |(from, along): (DVec3, DVec3)| {
            let inwards = normal.cross(along);
            inwards.dot(seen.centre - from) >= seen.reach(inwards)
        };
        let is_above = [(a, e), (a + e, f - e), (a + f, -f)].into_iter().all(is_within);
        let most = normal.dot(a - seen.centre).abs() + seen.reach(normal) + f64::from(face.sag);
        is_above.then_some(most * self.frame.unit)
    }

    /// How far a patch is, at least.
    pub(super) fn patch_apart(&self, seen: &Seen, at: usize) -> f64 {
        let Some((face, sides)) = self.at(at) else { return 0.0 };
        let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
        let (b, c) = (a + e, a + f);
        let normal = e.cross(f).try_normalize();
        let beside = normal.map_or(0.0, |normal| seen.plane_gap(a, normal));
        let gap = beside.max(seen.box_gap(a.min(b).min(c), a.max(b).max(c)));
        gap.max(seen.side_gap([a, b, c])) - f64::from(face.sag)
    }
}
