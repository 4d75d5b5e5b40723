//! Which way a distance rises over a zone: against the normals of the patches that feet may be on.
//!
//! The gradient at a point is against the normal at its foot. Where the foot is on a crease it is
//! between those of the patches that meet there, and all of these are near.

use glam::DVec3;
use rvachev_num::Interval;

use super::face::{SLACK, double};
use super::hierarchy::PARENT;
use super::{Patches, SurfaceDistance};
use crate::{Way, Zone, bits};

/// More patches than this turn too much to be asked.
const MANY: usize = 96;

/// Where normals are taken of a patch.
const PLACES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];

/// Between these places normals turn farther by this part of what they turn among them.
const BETWEEN: f64 = 0.25;

impl SurfaceDistance {
    /// The directions along which the value rises all over a zone.
    pub(super) fn rising(&self, zone: &Zone, ways: &[Way]) -> u8 {
        if !zone.is_finite() {
            return 0;
        }
        let centre = self.flattened(zone.centre);
        let Some(distance) = self.patches.distance(centre) else { return 0 };
        let reach = distance + 2.0 * self.radius(zone) + self.slack(zone, distance);
        let Some(mut slopes) = self.patches.slopes_within(centre, reach) else { return 0 };
        if let Some(axis) = self.flat {
            slopes[axis] = Interval::point(0.0);
        }
        bits(ways, |way| way.is_rise(slopes))
    }
}

impl Patches {
    /// The vectors against the normals of all patches that come this near to a point; nothing where
    /// these are many.
    fn slopes_within(&self, p: DVec3, reach: f64) -> Option<[Interval; 3]> {
        let (local, reach) = (self.frame.into_local(p), reach / self.frame.unit);
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut count = 0;
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let node = self.nodes.get(at as usize)?;
            let nearest = local.clamp(double(node.low), double(node.high));
            if nearest.distance(local) > reach {
                continue;
            }
            if node.count >= PARENT {
                open.extend([node.first, node.first + 1]);
                continue;
            }
            for at in node.first..node.first + node.count {
                if self.is_far(at as usize, local, reach) {
                    continue;
                }
                count += 1;
                if count > MANY {
                    return None;
                }
                let (low, high) = self.slopes_of(at as usize);
                (least, most) = (least.min(low), most.max(high));
            }
        }
        (count > 0).then(|| [0, 1, 2].map(|axis| Interval::new(least[axis], most[axis])))
    }

    /// Whether a patch is farther from a point of the surface's frame than this, as far as its box
    /// and its plane tell.
    fn is_far(&self, at: usize, local: DVec3, reach: f64) -> bool {
        let Some((face, sides)) = self.at(at) else { return false };
        let [a, e, f] = [face.a, sides.e, sides.f].map(double);
        let (b, c) = (a + e, a + f);
        let beside = local.distance(local.clamp(a.min(b).min(c), a.max(b).max(c)));
        let above = e.cross(f).normalize_or_zero().dot(local - a).abs();
        beside.max(above) > reach + f64::from(face.sag) + SLACK
    }

    /// A box of the vectors against a patch's normals.
    fn slopes_of(&self, at: usize) -> (DVec3, DVec3) {
        let places = if self.quadratics.is_empty() { &PLACES[..1] } else { &PLACES[..] };
        let normals = places.iter().map(|[s, t]| -self.point_and_normal(at, *s, *t).1);
        let (low, high) =
            normals.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), n| (low.min(n), high.max(n)));
        let more = BETWEEN * (high - low);
        (low - more, high + more)
    }
}
