//! Where the feet of a zone's points are, on which patches.
//!
//! ```text
//!     c, x    the zone's centre and a point of it; r the farthest that this may be from the centre
//!     g, f    their feet
//!     |f − x| ≤ |g − x|   so   |f − c|² ≤ |g − c|² + 2 (x − c)·(f − g) ≤ |g − c|² + 2 r |f − g|
//! ```
//!
//! Of what is in the ball that the last line tells only those points are feet that are nearer still,
//! for they are not that far from g: where feet do not leap they move as far as points do.
//!
//! Where it is asked how a level is passed, feet that are farther than that do not count.

use glam::DVec3;
use rvachev_num::Interval;

use super::cut::Cut;
use super::face::{SLACK, double};
use super::hierarchy::PARENT;
use super::normals::Part;
use super::{Patches, SurfaceDistance};
use crate::{Way, Zone, dot};

/// More patches than this turn too much to be asked.
const MANY: usize = 96;

/// So often the ball of feet is made smaller.
const ROUNDS: usize = 4;

/// Where points are whose feet are looked for.
#[derive(Clone, Copy)]
pub(super) struct Feet<'a> {
    pub(super) centre: DVec3,
    zone: Zone,
    /// No foot is farther from the centre.
    pub(super) reach: f64,
    pub(super) ways: &'a [Way],
    /// Below 0 outside, above 0 inside, 0 if both may be.
    side: f64,
    pub(super) flat: Option<usize>,
}

impl SurfaceDistance {
    /// Where the feet of a zone's points may be, and on which patches; only of those that are no
    /// farther from their feet than a level, if there is one.
    pub(super) fn feet<'a>(&self, zone: &Zone, ways: &'a [Way], level: Option<f64>) -> Option<(Feet<'a>, Vec<usize>)> {
        if !zone.is_finite() {
            return None;
        }
        let centre = self.flattened(zone.centre);
        let foot = self.patches.nearest(centre)?;
        let (radius, slack) = (self.radius(zone), self.slack(zone, foot.distance));
        // Only on one side of the surface is it known which way the foot is.
        let side = if foot.distance > radius + slack { self.sign(zone.centre.to_array()).signum() } else { 0.0 };
        let level = level.filter(|level| level * side > 0.0).map_or(f64::INFINITY, |level| level.abs() + slack);
        let reach = (foot.distance + 2.0 * radius + slack).min(level + radius);
        let mut feet = Feet { centre, zone: self.across(zone), reach, ways, side, flat: self.flat };
        let mut patches = self.patches.beneath(&feet)?;
        let seen = self.patches.seen(&feet.zone);
        patches.retain(|patch| self.patches.patch_apart(&seen, *patch) * self.patches.unit() < level);
        for _ in 0..ROUNDS {
            let far = patches.iter().filter_map(|patch| self.patches.spread(*patch, &feet, foot.point));
            let least = foot.distance + slack;
            let nearer = (least * least + 2.0 * radius * (far.fold(0.0, f64::max) + slack)).sqrt();
            if nearer >= feet.reach {
                break;
            }
            feet.reach = nearer;
        }
        patches.retain(|patch| self.patches.spread(*patch, &feet, foot.point).is_some());
        Some((feet, patches))
    }
}

impl SurfaceDistance {
    /// How near, and how far, points of a zone are that are on one side of the surface, by where
    /// feet are and by the normals there. Near, less than nothing is not told.
    pub(super) fn change(&self, zone: &Zone) -> Option<[f64; 2]> {
        let (feet, patches) = self.feet(zone, &[], None)?;
        let distance = self.patches.distance(feet.centre)?;
        let Zone { axes, slack, .. } = feet.zone;
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        // |x − f|² ≥ |g − c|² − 2 (x − c)·(f − c)
        let mut most = [0.0f64; 3];
        let mut slopes: Option<[Interval; 3]> = None;
        for patch in patches {
            let part = Part::whole(patch);
            let Some((cut, off)) = self.patches.cut(&part, &feet) else { continue };
            for (most, axis) in most.iter_mut().zip(axes) {
                *most = most.max(cut.farthest(axis).max(cut.farthest(-axis)) + off * axis.length());
            }
            let own = self.patches.slopes_of(&part, self.flat);
            slopes = Some(slopes.map_or(own, |all| [0, 1, 2].map(|axis| all[axis].hull(own[axis]))));
        }
        let square = distance * distance - 2.0 * (most.iter().sum::<f64>() + slack.length() * feet.reach);
        // Between unit normals others are shorter, and slopes are not.
        let slopes = slopes?;
        let least = DVec3::from_array(slopes.map(|slope| slope.lo().max(-slope.hi()).max(0.0))).length();
        let along = |axis: DVec3| dot(slopes, axis.to_array().map(Interval::point)).magnitude();
        let by_normals = (axes.into_iter().map(along).sum::<f64>() + slack.length()) / least;
        Some([square.max(0.0).sqrt(), distance + by_normals])
    }
}

impl Feet<'_> {
    /// Whether the value rises along directions wherever the foot is, on a triangle or this near to
    /// it.
    pub(super) fn lead(&self, triangle: &Cut, sag: f64, mut way: Way) -> bool {
        if self.side == 0.0 {
            return false;
        }
        if let Some(axis) = self.flat {
            way.middle[axis] = 0.0;
        }
        let Zone { axes, slack, .. } = &self.zone;
        let room = [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.dot(way.middle).abs()).iter().sum::<f64>();
        let room = room + slack.dot(way.middle.abs()) + sag * way.middle.length();
        -triangle.farthest(self.side * way.middle) > room + way.sway * (self.reach + sag)
    }
}

impl Patches {
    /// The patches that feet may be on, as far as their boxes and planes tell; nothing if these are
    /// many.
    fn beneath(&self, feet: &Feet<'_>) -> Option<Vec<usize>> {
        let (local, reach) = (self.frame.into_local(feet.centre), feet.reach / self.frame.unit);
        let (mut near, mut open) = (Vec::new(), vec![0]);
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
            let own = (node.first..node.first + node.count).map(|at| at as usize);
            near.extend(own.filter(|at| !self.is_far(*at, local, reach)));
            if near.len() > MANY {
                return None;
            }
        }
        Some(near)
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

    /// A part of a patch as far as it is as near as feet are, and how far off that may be; nothing
    /// if none of it is.
    pub(super) fn cut(&self, part: &Part, feet: &Feet<'_>) -> Option<(Cut, f64)> {
        let corners = part.corners.map(|[s, t]| self.frame.outward(self.point_and_normal(part.patch, s, t).0));
        let off = (self.sag(part) + SLACK) * self.frame.unit;
        let cut = Cut::new(corners.map(|corner| corner - feet.centre), feet.reach + off);
        (!cut.is_empty()).then_some((cut, off))
    }

    /// How far a part of a patch is off the triangle of its corners, in the surface's frame.
    pub(super) fn sag(&self, part: &Part) -> f64 {
        f64::from(self.faces[part.patch].sag) / f64::from(1 << (2 * part.depth))
    }

    /// How far feet on a patch are from a point at most.
    fn spread(&self, patch: usize, feet: &Feet<'_>, point: DVec3) -> Option<f64> {
        let (cut, off) = self.cut(&Part::whole(patch), feet)?;
        Some(cut.farthest_from(point - feet.centre) + off)
    }
}
