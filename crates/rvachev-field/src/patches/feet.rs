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
use super::{Foot, Patches, SurfaceDistance};
use crate::{Way, Zone, dot};

/// More patches than this turn too much to be asked.
const MANY: usize = 96;

/// So often the ball of feet is made smaller.
const ROUNDS: usize = 4;

/// Rectangles reach less far than this part of their radius towards the surface there.
const ALONG: f64 = 0.5;

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
    /// Where the feet of a zone's points may be, given that of its centre, and on which patches;
    /// only of those that are no farther from their feet than a level, if there is one.
    pub(super) fn feet<'a>(
        &self,
        zone: &Zone,
        foot: Foot,
        ways: &'a [Way],
        level: Option<f64>,
    ) -> Option<(Feet<'a>, Vec<Part>)> {
        if !zone.is_finite() {
            return None;
        }
        let centre = self.flattened(zone.centre);
        let (radius, slack) = (self.radius(zone), self.slack(zone, foot.distance));
        // Only on one side of the surface is it known which way the foot is.
        let side = if foot.distance > radius + slack { self.sign(zone.centre.to_array()).signum() } else { 0.0 };
        let level = level.filter(|level| level * side > 0.0).map_or(f64::INFINITY, |level| level.abs() + slack);
        let reach = (foot.distance + 2.0 * radius + slack).min(level + radius);
        let mut feet = Feet { centre, zone: self.across(zone), reach, ways, side, flat: self.flat };
        let seen = self.patches.seen(&feet.zone);
        let beneath = self.patches.beneath(&feet)?.into_iter();
        let near = beneath.filter(|patch| self.patches.patch_apart(&seen, *patch) * self.patches.unit() < level);
        let mut patches: Vec<Part> = near.map(|patch| self.patches.part(patch, WHOLE, 0, centre)).collect();
        let (least, own) = (foot.distance + slack, foot.point - centre);
        for _ in 0..ROUNDS {
            let far = patches.iter().filter_map(|part| feet.spread(part, own)).fold(0.0, f64::max);
            let nearer = (least * least + 2.0 * radius * (far + slack)).sqrt();
            if nearer >= feet.reach {
                break;
            }
            feet.reach = nearer;
        }
        patches.retain(|part| feet.cut(part).is_some());
        Some((feet, patches))
    }

    /// How near, at least, and how far points of a rectangle along the surface are, by where feet
    /// are, by the planes of patches and by their normals. Of one that may meet the surface it is
    /// not told how near.
    pub(super) fn over_rectangle(&self, zone: &Zone, foot: Foot) -> Option<[f64; 2]> {
        let Zone { axes, slack, .. } = self.across(zone);
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
        if axes.iter().filter(|axis| **axis == DVec3::ZERO).count() != 1 {
            return None;
        }
        // Of others the ball about it tells about as much.
        let away = (self.flattened(zone.centre) - foot.point).try_normalize().unwrap_or(foot.normal);
        let across = axes.into_iter().map(|axis| axis.dot(away).abs()).sum::<f64>();
        if across > ALONG * self.radius(zone) {
            return None;
        }
        let (feet, patches) = self.feet(zone, foot, &[], None)?;
        let (distance, seen) = (foot.distance, self.patches.seen(&feet.zone));
        let mut near = f64::INFINITY;
        let mut slopes: Option<[Interval; 3]> = None;
        for part in &patches {
            let Some(cut) = feet.cut(part) else { continue };
            // |x − f|² ≥ |g − c|² − 2 (x − c)·(f − c)
            let most = |axis: DVec3| cut.farthest(axis).max(cut.farthest(-axis)) + part.off * axis.length();
            let most = axes.into_iter().map(most).sum::<f64>() + slack.length() * feet.reach;
            let by_place = (distance * distance - 2.0 * most).max(0.0).sqrt();
            near = near.min(by_place.max(self.patches.patch_apart(&seen, part.patch) * self.patches.unit()));
            let own = self.patches.slopes_of(part, self.flat);
            slopes = Some(slopes.map_or(own, |all| [0, 1, 2].map(|axis| all[axis].hull(own[axis]))));
        }
        // Between unit normals others are shorter, and slopes are not.
        let slopes = slopes?;
        let least = DVec3::from_array(slopes.map(|slope| slope.lo().max(-slope.hi()).max(0.0))).length();
        let along = |axis: DVec3| dot(slopes, axis.to_array().map(Interval::point)).magnitude();
        let by_normals = (axes.into_iter().map(along).sum::<f64>() + slack.length()) / least;
        Some([if near > 0.0 { near } else { f64::NEG_INFINITY }, distance + by_normals])
    }
}

impl Feet<'_> {
    /// A part of a patch as far as it is as near as feet are; nothing if none of it is.
    pub(super) fn cut(&self, part: &Part) -> Option<Cut> {
        let cut = Cut::new(part.places, self.reach + part.off);
        (!cut.is_empty()).then_some(cut)
    }

    /// How far feet on a part of a patch are from a point at most.
    fn spread(&self, part: &Part, point: DVec3) -> Option<f64> {
        Some(self.cut(part)?.farthest_from(point) + part.off)
    }

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

    /// A part of a patch, of these corners, seen from a point.
    pub(super) fn part(&self, patch: usize, corners: [[f64; 2]; 3], depth: u32, centre: DVec3) -> Part {
        let place = |[s, t]: [f64; 2]| self.frame.outward(self.point_and_normal(patch, s, t).0) - centre;
        let sag = f64::from(self.faces[patch].sag) / f64::from(1 << (2 * depth));
        Part { patch, corners, depth, places: corners.map(place), off: (sag + SLACK) * self.frame.unit }
    }
}

/// A part of a patch: halved so often along its sides.
pub(super) struct Part {
    pub(super) patch: usize,
    /// By the patch's coordinates.
    pub(super) corners: [[f64; 2]; 3],
    pub(super) depth: u32,
    /// The corners, from the zone's centre.
    places: [DVec3; 3],
    /// How far it is off the triangle of its corners.
    pub(super) off: f64,
}

/// All of a patch.
const WHOLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

impl Part {
    /// The corners of its quarters.
    pub(super) fn quarters(&self) -> [[[f64; 2]; 3]; 4] {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
    }
}

pub(super) fn middle([s, t]: [f64; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    [0.5 * (s + u), 0.5 * (t + v)]
}
