//! Boxes of the hierarchy, and parts of patches, as they are compared with those of others.
//!
//! ```text
//!      ____________        Along a surface a box is thick where that is oblique, and a disc is not: discs of
//!     (____________) P     two surfaces are as far apart as these are to the second order of their size. So of
//!       ____________       a gap that is even all over little is left when boxes are as small as patches.
//!      (____________) Q
//! ```
//!
//! Source: S. Gottschalk, M. C. Lin, D. Manocha, *OBBTree: A Hierarchical Structure for Rapid
//! Interference Detection* (1996), for boxes along the surface.

use glam::DVec3;

use super::Patches;
use super::disc::Cylinder;
use super::face::double;
use super::hierarchy::{Node, PARENT};
use super::subpatch::Subpatch;
use super::triangles;

/// A box with its disc, or a ball where there is none, in length units.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    low: DVec3,
    high: DVec3,
    centre: DVec3,
    /// A unit vector along the axis of the disc, or 0 of a ball.
    pub(super) normal: DVec3,
    half: f64,
    pub(super) radius: f64,
    /// The radius of a ball about it.
    pub(super) size: f64,
}

impl Hull {
    /// One that holds all that is no farther from it than this.
    pub(super) fn inflated(&self, by: f64) -> Hull {
        let (half, radius) = (self.half + by, self.radius + by);
        Hull { low: self.low - by, high: self.high + by, half, radius, size: self.size + by, ..*self }
    }

    /// The square of how far a box is from its own.
    fn box_gap(&self, [low, high]: [DVec3; 2]) -> f64 {
        (self.low - high).max(low - self.high).max(DVec3::ZERO).length_squared()
    }

    /// The square of how far another one is at least; what is more than is asked for may be told as
    /// less.
    pub(super) fn gap(&self, other: &Hull, enough: f64) -> f64 {
        let by_box = self.box_gap([other.low, other.high]);
        if by_box >= enough {
            return by_box;
        }
        let away = self.centre - other.centre;
        let (square, size) = (away.length_squared(), self.size + other.size);
        let cosine = self.normal.dot(other.normal);
        let (own, others) = (away.dot(self.normal), away.dot(other.normal));
        // How far they are along a way and across it, given how far their centres are, and how far
        // both reach, along it.
        let along = |height: f64, reach: f64| {
            let above = (height.abs() - reach).max(0.0);
            let aside = square - height * height - size * size;
            let aside = if aside > 0.0 { (square - height * height).sqrt() - size } else { 0.0 };
            above * above + aside * aside
        };
        // Midway between both axes each is as far from it.
        let both = (2.0 + 2.0 * cosine.abs()).sqrt();
        let (near, far) = (0.5 * both, (0.5 - 0.5 * cosine.abs()).max(0.0).sqrt());
        let reach = near * (self.half + other.half) + far * (self.radius + other.radius);
        let mut gap = by_box.max(along((own + cosine.signum() * others) / both, reach));
        if gap < enough {
            let (along_other, across) = (cosine.abs(), (1.0 - cosine * cosine).max(0.0).sqrt());
            gap = gap.max(along(own, self.half + along_other * other.half + across * other.radius));
            gap = gap.max(along(others, other.half + along_other * self.half + across * self.radius));
        }
        gap
    }
}

/// A box of the hierarchy, or a part of a patch.
#[derive(Clone, Copy)]
pub(super) struct Item {
    pub(super) hull: Hull,
    pub(super) what: What,
}

#[derive(Clone, Copy)]
pub(super) enum What {
    Node(u32),
    Part(Subpatch),
}

impl Subpatch {
    pub(super) fn item(self) -> Item {
        let [a, b, c] = self.points;
        let centre = (a + b + c) / 3.0;
        let reach = self.points.iter().fold(0.0, |most, p| centre.distance_squared(*p).max(most)).sqrt();
        let (low, high) = (a.min(b).min(c) - self.sag, a.max(b).max(c) + self.sag);
        let radius = reach + self.sag;
        let hull = match (b - a).cross(c - a).try_normalize() {
            Some(normal) => {
                // A quadratic patch is off by four times the sum of the products of two of its
                // coordinates, at most 1/3 together, and these vectors.
                let heights = self.bends.map(|by| 4.0 / 3.0 * by.dot(normal));
                let [from, to] =
                    [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| heights.into_iter().fold(0.0, pick));
                let (centre, half) = (centre + 0.5 * (from + to) * normal, 0.5 * (to - from));
                Hull { low, high, centre, normal, half, radius, size: (radius * radius + half * half).sqrt() }
            }
            None => Hull { low, high, centre, normal: DVec3::ZERO, half: 0.0, radius, size: radius },
        };
        Item { hull, what: What::Part(self) }
    }
}

impl Patches {
    /// Whether no point of a triangle is within a length of the patches.
    pub fn is_beyond(&self, triangle: [DVec3; 3], length: f64) -> bool {
        let own = Subpatch::flat(triangle);
        let (hull, least) = (own.item().hull, length * length);
        let is_apart = |item: &Item| match &item.what {
            _ if hull.gap(&item.hull, least) >= least => true,
            What::Part(other) => triangles::nearest(own.points, other.points).0.sqrt() - other.sag >= length,
            What::Node(_) => false,
        };
        let mut open = Vec::with_capacity(64);
        open.extend((!self.is_empty()).then_some(0));
        while let Some(at) = open.pop() {
            let Node { first, count, .. } = self.nodes[at as usize];
            // Most are told by their boxes.
            if hull.box_gap(self.bounds_of(at)) >= least || is_apart(&self.node(at)) {
                continue;
            }
            if count >= PARENT {
                open.extend([first, first + 1]);
            } else if !(first..first + count).all(|at| is_apart(&self.whole(at as usize).item())) {
                return false;
            }
        }
        true
    }

    fn bounds_of(&self, at: u32) -> [DVec3; 2] {
        let node = &self.nodes[at as usize];
        [node.low, node.high].map(|p| self.frame.outward(double(p)))
    }

    /// A box.
    pub(super) fn node(&self, at: u32) -> Item {
        let (disc, unit) = (&self.discs[at as usize], self.frame.unit);
        let [low, high] = self.bounds_of(at);
        let hull = match disc.cylinder() {
            Some(Cylinder { centre, normal, half, radius }) => {
                let (centre, half, radius) = (self.frame.outward(centre), unit * half, unit * radius);
                Hull { low, high, centre, normal, half, radius, size: (radius * radius + half * half).sqrt() }
            }
            None => {
                let radius = 0.5 * (high - low).length();
                Hull { low, high, centre: 0.5 * (low + high), normal: DVec3::ZERO, half: 0.0, radius, size: radius }
            }
        };
        Item { hull, what: What::Node(at) }
    }

    /// What an item is made of.
    pub(super) fn opened(&self, item: &Item, into: &mut Vec<Item>) {
        match &item.what {
            What::Node(at) => {
                let Node { first, count, .. } = self.nodes[*at as usize];
                if count >= PARENT {
                    into.extend([first, first + 1].map(|at| self.node(at)));
                } else {
                    into.extend((first..first + count).map(|at| self.whole(at as usize).item()));
                }
            }
            What::Part(part) => into.extend(part.divided().map(Subpatch::item)),
        }
    }

    /// A point of the patches of an item.
    pub(super) fn corner(&self, item: &Item) -> DVec3 {
        match &item.what {
            What::Part(part) => part.points[0],
            What::Node(at) => {
                let mut node = &self.nodes[*at as usize];
                while node.count >= PARENT {
                    node = &self.nodes[node.first as usize];
                }
                self.frame.outward(double(self.faces[node.first as usize].a))
            }
        }
    }
}

/// Whether an item is opened before it is compared with parts of another: boxes if they are larger,
/// or the other is none, and patches if they are off by more and by what counts.
pub(super) fn is_opened(item: &Item, other: &Item, fine: f64) -> bool {
    match (&item.what, &other.what) {
        (What::Node(_), What::Part(_)) => true,
        (What::Node(_), What::Node(_)) => item.hull.radius > other.hull.radius,
        (What::Part(_), What::Node(_)) => false,
        (What::Part(own), What::Part(other)) => own.sag > fine && own.sag > other.sag,
    }
}
