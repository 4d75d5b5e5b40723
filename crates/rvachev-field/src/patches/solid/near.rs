//! The triangles about some points, gathered once for all of them.

use super::super::face::{Face, Sides};
use super::super::hierarchy::Box3;
use super::super::packet::WIDEST;
use super::between::CORNERS;
use crate::kernel::Element;

/// So many triangles are looked at together, less the widest vector.
const MOST: usize = 512;

/// A box of the frame.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
}

impl Hull {
    pub(super) const NONE: Hull = Hull { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    #[inline(always)]
    pub(super) fn of(p: [f64; 3]) -> Hull {
        let p = single(p);
        Hull { low: p, high: p }
    }

    #[inline(always)]
    pub(super) fn with(&mut self, p: [f64; 3]) {
        for (axis, x) in single(p).into_iter().enumerate() {
            self.low[axis] = if x < self.low[axis] { x } else { self.low[axis] };
            self.high[axis] = if x > self.high[axis] { x } else { self.high[axis] };
        }
    }

    #[inline(always)]
    pub(super) fn meets(&self, low: [f32; 3], high: [f32; 3]) -> bool {
        let beyond = |axis: usize| low[axis] > self.high[axis] || high[axis] < self.low[axis];
        !(beyond(0) | beyond(1) | beyond(2))
    }

    pub(super) fn holds(&self, other: &Hull) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.low[axis] && other.high[axis] <= self.high[axis])
    }

    pub(super) fn diagonal(&self) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(self.high[axis] - self.low[axis]));
        (x * x + y * y + z * z).sqrt()
    }
}

#[inline(always)]
fn single([x, y, z]: [f64; 3]) -> [f32; 3] {
    [x as f32, y as f32, z as f32]
}

/// The triangles about some points, with their boxes.
pub(super) struct Near<E> {
    /// They are those that meet it.
    pub(super) hull: Hull,
    pub(super) low: [[E; MOST]; 3],
    pub(super) high: [[E; MOST]; 3],
    pub(super) which: [u32; MOST],
    pub(super) count: usize,
}

impl<E: Element> Near<E> {
    #[inline(always)]
    pub(super) fn new() -> Near<E> {
        Near {
            hull: Hull::NONE,
            low: [[E::default(); MOST]; 3],
            high: [[E::default(); MOST]; 3],
            which: [0; MOST],
            count: 0,
        }
    }

    /// Adds a triangle, if it meets the hull, and says whether there was room.
    #[inline(always)]
    pub(super) fn push(&mut self, at: u32, [low, high]: Box3) -> bool {
        if !self.hull.meets(low, high) {
            return true;
        }
        if self.count + WIDEST >= MOST {
            return false;
        }
        for axis in 0..3 {
            self.low[axis][self.count] = E::from_f64(f64::from(low[axis]));
            self.high[axis][self.count] = E::from_f64(f64::from(high[axis]));
        }
        self.which[self.count] = at;
        self.count += 1;
        true
    }

    /// Fills the last vector with boxes that nothing meets.
    #[inline(always)]
    pub(super) fn end(&mut self, width: usize) {
        while !self.count.is_multiple_of(width) {
            for axis in 0..3 {
                self.low[axis][self.count] = E::from_f64(f64::from(f32::MAX));
                self.high[axis][self.count] = E::from_f64(f64::from(f32::MAX));
            }
            self.count += 1;
        }
    }
}

/// The box about a triangle, wider by what rounding may do.
#[inline(always)]
pub(super) fn box_of(face: &Face, sides: &Sides) -> Box3 {
    const WIDER: f32 = 2.0 * CORNERS as f32;
    let [mut low, mut high] = [face.a; 2];
    for axis in 0..3 {
        low[axis] += sides.e[axis].min(sides.f[axis]).min(0.0) - WIDER;
        high[axis] += sides.e[axis].max(sides.f[axis]).max(0.0) + WIDER;
    }
    [low, high]
}
