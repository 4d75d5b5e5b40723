//! Which way a distance rises over a zone: against the normals of the patches that feet may be on,
//! and away from the feet, or towards them.
//!
//! ```text
//!          zone    q       The gradient at a point p is along p − q, whatever q on the patch is the foot of p. If the
//!           p .----+--     foot is on the inside of the patch, it is also along the normal there; on a crease it is
//!             ' .  |       between the normals of the patches that meet there, all of which are near.
//!                 '|
//! ```
//!
//! So a direction is a rise if it is one by the positions or by the normals of each patch: a foot on
//! a crease of patches none of which is one by its positions is between normals that all are.

use glam::DVec3;
use rvachev_num::Interval;

use super::cut::Cut;
use super::face::{SLACK, double};
use super::hierarchy::PARENT;
use super::{Patches, SurfaceDistance};
use crate::{Way, Zone, bits};

/// More patches than this turn too much to be asked.
const MANY: usize = 96;

/// So often a patch is halved where it turns too much.
const DEEPEST: u32 = 4;

/// Between these places normals turn farther by this part of what they turn among them.
const BETWEEN: f64 = 0.25;

impl SurfaceDistance {
    /// The directions along which the value rises all over a zone.
    pub(super) fn rising(&self, zone: &Zone, ways: &[Way]) -> u8 {
        self.feet(zone, ways).map_or(0, |feet| self.patches.rising_from(&feet))
    }

    /// The middle of those against the normals of all patches that feet may be on.
    pub(super) fn inward_over(&self, zone: &Zone) -> Option<DVec3> {
        let feet = self.feet(zone, &[])?;
        let slopes = |patch| self.patches.slopes_of(&Part::whole(patch), self.flat);
        let all = self.patches.beneath(&feet)?.into_iter().map(slopes);
        all.reduce(|all, own| [0, 1, 2].map(|axis| all[axis].hull(own[axis])))
            .and_then(|slopes| DVec3::from_array(slopes.map(Interval::mid)).try_normalize())
    }

    /// Where the feet of a zone's points may be.
    fn feet<'a>(&self, zone: &Zone, ways: &'a [Way]) -> Option<Feet<'a>> {
        if !zone.is_finite() {
            return None;
        }
        let centre = self.flattened(zone.centre);
        let distance = self.patches.distance(centre)?;
        let (radius, slack) = (self.radius(zone), self.slack(zone, distance));
        // Only on one side of the surface is it known which way the foot is.
        let side = if distance > radius + slack { self.sign(zone.centre.to_array()).signum() } else { 0.0 };
        let reach = distance + 2.0 * radius + slack;
        Some(Feet { centre, zone: self.across(zone), reach, ways, side, flat: self.flat })
    }
}

/// Where points are whose feet are looked for.
#[derive(Clone, Copy)]
struct Feet<'a> {
    centre: DVec3,
    zone: Zone,
    /// No foot is farther from the centre.
    reach: f64,
    ways: &'a [Way],
    /// Below 0 outside, above 0 inside, 0 if both may be.
    side: f64,
    flat: Option<usize>,
}

impl Feet<'_> {
    /// Whether the value rises along directions wherever the foot is, on a triangle or this near to
    /// it.
    fn lead(&self, triangle: &Cut, sag: f64, mut way: Way) -> bool {
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
    /// The directions along which the distance rises, on the feet's side, wherever these are; none
    /// where they may be on many patches.
    fn rising_from(&self, feet: &Feet<'_>) -> u8 {
        let (mut left, mut count) = (bits(feet.ways, |_| true), 0);
        for patch in self.beneath(feet).unwrap_or_default() {
            let Some(found) = self.rising_by(Part::whole(patch), feet, left) else { continue };
            (left, count) = (left & found, count + 1);
            if left == 0 {
                return 0;
            }
        }
        if count > 0 { left } else { 0 }
    }

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

    /// The same by a part of a patch, of some of the ways; nothing if it is not that near.
    fn rising_by(&self, part: Part, feet: &Feet<'_>, asked: u8) -> Option<u8> {
        let sag = f64::from(self.faces[part.patch].sag) / f64::from(1 << (2 * part.depth));
        let corners = part.corners.map(|[s, t]| self.frame.outward(self.point_and_normal(part.patch, s, t).0));
        let off = (sag + SLACK) * self.frame.unit;
        let cut = Cut::new(corners.map(|corner| corner - feet.centre), feet.reach + off);
        if cut.is_empty() {
            return None;
        }
        let by_place = asked & bits(feet.ways, |way| feet.lead(&cut, off, way));
        if by_place == asked {
            return Some(asked);
        }
        let slopes = self.slopes_of(&part, feet.flat);
        let found = by_place | asked & bits(feet.ways, |way| way.is_rise(slopes));
        if found == asked || sag == 0.0 || part.depth == DEEPEST {
            return Some(found);
        }
        let parts = part.quarters().into_iter().filter_map(|quarter| self.rising_by(quarter, feet, asked & !found));
        Some(found | parts.reduce(|all, own| all & own)?)
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

    /// A box of the vectors against the normals of a part of a patch.
    fn slopes_of(&self, part: &Part, flat: Option<usize>) -> [Interval; 3] {
        let [a, b, c] = part.corners;
        let all = [a, b, c, middle(a, b), middle(b, c), middle(c, a)];
        let places = if self.quadratics.is_empty() { &all[..1] } else { &all[..] };
        let normals = places.iter().map(|[s, t]| -self.point_and_normal(part.patch, *s, *t).1);
        let (low, high) =
            normals.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), n| (low.min(n), high.max(n)));
        let more = BETWEEN * (high - low);
        let mut slopes = [0, 1, 2].map(|axis| Interval::new(low[axis] - more[axis], high[axis] + more[axis]));
        if let Some(axis) = flat {
            slopes[axis] = Interval::point(0.0);
        }
        slopes
    }
}

/// A part of a patch: halved so often along its sides.
struct Part {
    patch: usize,
    /// By the patch's coordinates.
    corners: [[f64; 2]; 3],
    depth: u32,
}

impl Part {
    fn whole(patch: usize) -> Part {
        Part { patch, corners: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], depth: 0 }
    }

    fn quarters(&self) -> [Part; 4] {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]].map(|corners| Part {
            patch: self.patch,
            corners,
            depth: self.depth + 1,
        })
    }
}

fn middle([s, t]: [f64; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    [0.5 * (s + u), 0.5 * (t + v)]
}
