//! What is known of slopes along rays in a cell.
//!
//! Where a plane at which slopes have no bound passes a cell, as through the edge of a blade, they
//! may have one on either side of it, or at least a sign.
//!
//! ```text
//!     |     ^         The value rises up to the plane, the steeper the nearer, and falls behind
//!     |  .-' '-.      it: a ray crosses the surface once at most before it, and does not go
//!     +-'---+---'-    inside behind it.
//!         plane
//! ```

use std::sync::Arc;

use glam::DVec3;

use crate::eval::{Crease, Program};
use crate::{Bounds, Interval};

/// Slopes of the value along rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes {
    /// Those of the value.
    pub(super) value: Interval,
    /// Whether rays that go inside stay there: they cross the surface once at most.
    pub(super) rises: bool,
    /// Whether rays that go outside stay there.
    pub(super) falls: bool,
}

impl Slopes {
    /// Nothing is known.
    pub(super) const ANY: Slopes = Slopes { value: Interval::ALL, rises: false, falls: false };

    /// Those of the negated value.
    pub(super) fn turned(self) -> Slopes {
        Slopes { value: -self.value, rises: self.falls, falls: self.rises }
    }

    /// Those of a value that changes by `scale` per length unit.
    fn of(value: Interval, scale: f64) -> Slopes {
        let value = level(value, scale);
        Slopes { value, rises: value.lo() >= 0.0, falls: value.hi() <= 0.0 }
    }

    pub(super) fn are_one_way(self) -> bool {
        self.rises || self.falls
    }
}

/// Slopes below this part of the others come of 0 rounded outwards.
const LEVEL: f64 = 1e-13;

/// The slopes without what comes of 0 rounded outwards: on the way through a cell such slopes
/// change a value by far less than the room that the boxes are given.
fn level(slopes: Interval, scale: f64) -> Interval {
    let least = LEVEL * scale.clamp(1e-17, 1.0);
    let level = |v: f64| if v.abs() < least { 0.0 } else { v };
    Interval::new(level(slopes.lo()), level(slopes.hi()))
}

/// Slopes in a cell, and beside the planes in it.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub(super) slopes: Slopes,
    /// Where they have no bound.
    pub(super) sides: Option<Arc<Sides>>,
}

impl Known {
    /// Nothing is known.
    pub(super) const ANY: Known = Known { slopes: Slopes::ANY, sides: None };

    /// The value changes by no more than so much per length unit.
    pub(super) fn steep(most: f64) -> Known {
        let slopes = Slopes { value: Interval::new(-most, most), ..Slopes::ANY };
        Known { slopes, sides: None }
    }

    /// What is known of a program along rays in a box with directions from `low` to `high`.
    pub(super) fn of(program: &Program, room: &Bounds, [low, high]: [DVec3; 2]) -> Known {
        let along = [0, 1, 2].map(|axis| Interval::new(low[axis], high[axis]));
        if let Some(sides) = Sides::of(program, room, along) {
            let jumps = sides.creases.iter().any(|crease| crease.jumps);
            let known = sides.are_all_known() && !jumps;
            let all = |way: fn(&Slopes) -> bool| known && sides.all.iter().all(|(_, slopes)| way(slopes));
            let (rises, falls) = (all(|slopes| slopes.rises), all(|slopes| slopes.falls));
            let sides = (!rises && !falls).then(|| Arc::new(sides));
            return Known { slopes: Slopes { rises, falls, ..Slopes::ANY }, sides };
        }
        let along = program.ray_slopes(room, along);
        let crossing = along.crossing().map(|slopes| Slopes::of(slopes, slopes.magnitude()));
        if let Some(Slopes { rises, falls, .. }) = crossing.filter(|slopes| slopes.are_one_way()) {
            // How steep it is does not matter then.
            return Known { slopes: Slopes { rises, falls, ..Slopes::ANY }, sides: None };
        }
        // Leaves that take long have told their slopes all over the box. Those that are not 0 in it
        // do not count: with ±∞ in their place the value has the same sign and is no nearer to 0.
        if let Some(slopes) = crossing.filter(|_| program.is_dear()) {
            return Known { slopes, sides: None };
        }
        let slopes = along.value();
        let slopes = Slopes::of(slopes, slopes.magnitude());
        Known { slopes, sides: None }
    }

    /// Whether the value rises or falls all along, at least from plane to plane.
    pub(super) fn is_one_way(&self) -> bool {
        self.slopes.are_one_way() || self.sides.as_ref().is_some_and(|sides| sides.are_one_way)
    }
}

/// Cells that more planes pass are divided.
const MOST: usize = 4;

/// The planes that pass a cell, and the slopes on their sides.
#[derive(Debug)]
pub(super) struct Sides {
    pub(super) creases: Vec<Crease>,
    /// By the planes that are below, a bit each.
    all: Vec<(u32, Slopes)>,
    are_one_way: bool,
}

impl Sides {
    fn of(program: &Program, room: &Bounds, along: [Interval; 3]) -> Option<Sides> {
        if program.is_deformed() {
            return None;
        }
        let creases = program.creases(room);
        if creases.is_empty() || creases.len() > MOST {
            return None;
        }
        let mut sides = Sides { creases, all: Vec::new(), are_one_way: true };
        for corner in room.corners() {
            // On a plane it is not on one side.
            if sides.creases.iter().any(|crease| is_on(crease, corner)) {
                continue;
            }
            let side = sides.number(corner);
            if sides.all.iter().all(|(known, _)| *known != side) {
                let steepness = program.gradient(corner).1.length();
                let slopes = Slopes::of(program.slopes_beside(room, along, corner), steepness);
                sides.are_one_way &= slopes.are_one_way();
                sides.all.push((side, slopes));
            }
        }
        sides.are_one_way &= sides.are_all_known();
        Some(sides)
    }

    /// Whether there is no side without a corner, as between parallel planes.
    fn are_all_known(&self) -> bool {
        self.all.len() == 1 << self.creases.len()
    }

    /// The side that a point is on.
    fn number(&self, p: DVec3) -> u32 {
        let is_above = |crease: &Crease| crease.normal.dot(p) > crease.offset;
        let bits = self.creases.iter().enumerate().map(|(n, crease)| u32::from(is_above(crease)) << n);
        bits.sum()
    }

    /// The slopes on the side that a point is on.
    pub(super) fn slopes(&self, p: DVec3) -> Slopes {
        let side = self.number(p);
        self.all.iter().find(|(known, _)| *known == side).map_or(Slopes::ANY, |(_, slopes)| *slopes)
    }
}

/// Whether a point is on a plane, as far as rounding tells.
fn is_on(crease: &Crease, p: DVec3) -> bool {
    let reach = crease.normal.abs().dot(p.abs()) + crease.offset.abs();
    (crease.normal.dot(p) - crease.offset).abs() <= 1e-12 * reach
}
