//! The boxes that a fillet is held to.
//!
//! ```text
//!     +--------+
//!     |  .--.  |     How deep inside of one of them a point is, the material is that high at most:
//!     | / ## \ |     beyond them there is none, and its value falls as lengths do.
//!     +--------+
//! ```

use glam::DVec3;

use crate::{Bounds, Interval, Real};
use rvachev_field::{Way, Zone, bits};

/// Where there may be material of a fillet.
#[derive(Clone, Debug)]
pub(super) struct Room {
    boxes: Vec<Bounds>,
    /// There is none beyond this box.
    hull: Bounds,
    /// The boxes that it is held to: those of joints, a little larger, for there is nothing about
    /// their sides, and the hull as it is.
    held: Vec<Bounds>,
    /// By how much they are larger.
    more: f64,
}

impl Room {
    /// All of space.
    pub(super) fn all() -> Room {
        Room { boxes: Vec::new(), hull: Bounds::ALL, held: vec![Bounds::ALL], more: 0.0 }
    }

    /// Boxes alone, made larger by this, and nothing beyond the hull.
    pub(super) fn within(boxes: Vec<Bounds>, hull: Bounds, more: f64) -> Room {
        let held = boxes.iter().map(|own| own.inflate(more).intersection(&hull)).collect();
        Room { boxes, hull, held, more }
    }

    /// A box about all of them; an empty one of all of space.
    pub(super) fn bounds(&self) -> Bounds {
        self.boxes.iter().fold(Bounds::EMPTY, |all, own| all.union(own))
    }

    /// The boxes that it is held to.
    pub(super) fn held(&self) -> impl Iterator<Item = &Bounds> {
        self.held.iter()
    }

    /// Whether one of the boxes holds all of a zone.
    pub(super) fn holds(&self, zone: &Zone) -> bool {
        let [low, high] = [Interval::lo, Interval::hi].map(|end| DVec3::from_array(zone.hull().map(end)));
        let hull = Bounds::new(low, high);
        self.boxes.iter().any(|own| own.inflate(self.more).contains_bounds(&hull))
    }

    /// The same with those boxes alone that a zone meets, if these are fewer.
    pub(super) fn narrowed(&self, zone: &Zone) -> Option<Room> {
        let near: Vec<Bounds> = self.boxes.iter().filter(|own| meets(zone, &own.inflate(self.more))).copied().collect();
        let is_simpler = near.len() < self.boxes.len() && !near.is_empty();
        is_simpler.then(|| Room::within(near, self.hull, self.more))
    }

    /// How deep inside of the boxes a point is, and along which axis that grows.
    pub(super) fn depth(&self, p: DVec3) -> (f64, DVec3) {
        let mut most = (f64::NEG_INFINITY, DVec3::ZERO);
        for bounds in &self.held {
            let mut least = (f64::INFINITY, DVec3::ZERO);
            for axis in 0..3 {
                let (low, high) = (p[axis] - bounds.min[axis], bounds.max[axis] - p[axis]);
                for (depth, way) in [(low, 1.0), (high, -1.0)] {
                    if depth < least.0 {
                        least = (depth, way * DVec3::AXES[axis]);
                    }
                }
            }
            if least.0 > most.0 {
                most = least;
            }
        }
        most
    }

    /// How deep inside of the boxes points of a zone are.
    pub(super) fn depths(&self, zone: &Zone) -> Interval {
        let point = Interval::point;
        let of_box = |bounds: &Bounds| {
            let sides = zone.hull().into_iter().enumerate();
            sides.fold(point(f64::INFINITY), |own, (axis, side)| {
                own.min(side - point(bounds.min[axis])).min(point(bounds.max[axis]) - side)
            })
        };
        self.held.iter().map(of_box).fold(point(f64::NEG_INFINITY), Interval::max)
    }

    /// The directions that lead away from the sides of the hull, as far as these are near: nearer
    /// than this.
    pub(super) fn off_hull(&self, zone: &Zone, height: f64, ways: &[Way]) -> u8 {
        let mut all = u8::MAX;
        for (axis, side) in zone.hull().into_iter().enumerate() {
            let is_near = [side.lo() - self.hull.min[axis], self.hull.max[axis] - side.hi()];
            for (room, way) in is_near.into_iter().zip([1.0, -1.0]) {
                if room < height {
                    let mut slopes = [Interval::point(0.0); 3];
                    slopes[axis] = Interval::point(way);
                    all &= bits(ways, |way| way.is_rise(slopes));
                }
            }
        }
        all
    }
}

/// Whether a zone meets a box.
pub(super) fn meets(zone: &Zone, bounds: &Bounds) -> bool {
    let hull = zone.hull();
    (0..3).all(|axis| hull[axis].hi() >= bounds.min[axis] && hull[axis].lo() <= bounds.max[axis])
}
