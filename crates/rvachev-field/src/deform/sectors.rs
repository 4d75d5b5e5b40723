//! Rings of copies about z, by folding space.
//!
//! Copies stand at the angles `i·α`, α = 2π/n. They fall into M blocks, block b beginning at
//! copy `⌊b P⌋`, P = n/M; the copies that are the r-th of their blocks are one class. Its fold
//! turns a point to the copy in the nearest block:
//!
//! ```text
//!     t = (atan2(y, x) − θ)/α − r          θ the middle angle of the operand
//!     b = ⌊t/P + ½⌋                        i = ⌊b P⌋ + r,  turned by −i α
//! ```
//!
//! (With P no integer, t + ½ in place of t.) The repeated solid is the union over the ⌈P⌉
//! classes. As for [rows](super::cells), with an operand within `h·α` of its middle angle,
//! this is exact if P ≥ 2h + 1, or, with P no integer, where blocks are of two lengths,
//! if P ≥ 2h + 2.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};

use super::{Branches, Warp, turned_support};
use crate::{Bounds, Dual, Euclid, Interval, Real};
use crate::{ParamError, check};

/// The fold of one class of a ring.
#[derive(Clone, Copy, Debug)]
pub struct Sectors {
    /// Number of copies around the axis.
    pub count: u32,
    /// M, how many copies the class has.
    pub blocks: u32,
    /// r.
    pub class: u32,
    /// The middle angle of the operand.
    pub middle: f64,
}

/// The most copies about the axis.
const MOST: f64 = 1000.0;

impl Sectors {
    /// The angle between neighbours.
    fn step(&self) -> f64 {
        TAU / f64::from(self.count)
    }

    fn even(&self) -> bool {
        self.count.is_multiple_of(self.blocks)
    }

    /// P, as a number of copies.
    fn period(&self) -> f64 {
        f64::from(self.count) / f64::from(self.blocks)
    }

    /// The number of the block that is nearest to an angle.
    #[inline(always)]
    fn block<R: Real>(&self, angle: R) -> R {
        let period = self.period();
        let late = if self.even() { 0.0 } else { 0.5 };
        let offset = (late - f64::from(self.class) - self.middle / self.step()) / period + 0.5;
        angle.scale_add(1.0 / (self.step() * period), angle.lift(offset)).floor()
    }

    /// The angle by which the class's copy in a block is turned.
    #[inline(always)]
    fn turn<R: Real>(&self, block: R) -> R {
        let copy = if self.even() {
            block * self.period()
        } else {
            // Half of the least fraction keeps rounding from the edge.
            block.scale_add(self.period(), block.lift(0.5 / f64::from(self.blocks))).floor()
        };
        (copy + f64::from(self.class)) * self.step()
    }

    /// The blocks that the angles of a region reach; `None` if it meets the axis.
    fn blocks_of(&self, x: Interval, y: Interval) -> Option<(f64, f64)> {
        if (x.contains(0.0) && y.contains(0.0)) || !(x.width() + y.width()).is_finite() {
            return None;
        }
        // Seen from its centre's direction a box beside the axis lies within half a turn.
        let (cx, cy) = (x.mid(), y.mid());
        let centre = cy.atan2(cx);
        let mut reach = Interval::point(0.0);
        for (x, y) in [(x.lo(), y.lo()), (x.lo(), y.hi()), (x.hi(), y.lo()), (x.hi(), y.hi())] {
            reach = reach.hull(Interval::point((cx * y - cy * x).atan2(cx * x + cy * y)));
        }
        let angles = (reach + centre).inflate(1e-13);
        Some((self.block(angles.lo()), self.block(angles.hi())))
    }

    fn turned(&self, block: f64) -> DAffine3 {
        DAffine3::from_rotation_z(-self.turn(block))
    }
}

impl Warp for Sectors {
    const NAME: &'static str = "repeat_polar";
    const FOLDS: bool = true;

    #[inline(always)]
    fn inverse<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let (sin, cos) = self.turn(self.block(y.atan2(x))).sin_cos();
        [x.mul_add(cos, y * sin), y.mul_add(cos, -(x * sin)), z]
    }

    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3 {
        self.turned(0.0).inverse().transform_point3(p)
    }

    fn bounds(&self, b: &Bounds) -> Bounds {
        let (x, y) = (Interval::new(b.min.x, b.max.x), Interval::new(b.min.y, b.max.y));
        let reach = x.norm_as(y, Euclid).hi();
        let mut out = Bounds::EMPTY;
        for block in 0..self.blocks {
            out = out.union(&b.transformed(&self.turned(f64::from(block)).inverse()));
        }
        let disc = DVec3::new(reach, reach, f64::INFINITY);
        out.intersection(&Bounds::new(-disc, disc))
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        /// More copies than this reach about as far all round.
        const MANY: u32 = 64;
        if self.blocks > MANY {
            return turned_support(own, direction);
        }
        let along = |block: u32| own(self.turned(f64::from(block)).transform_vector3(direction));
        (0..self.blocks).map(along).fold(f64::NEG_INFINITY, f64::max)
    }

    fn check(&self, _: &Bounds) -> Result<(), ParamError> {
        check::within("count", f64::from(self.count), 1.0, MOST)
    }

    fn roundoff(&self, reach: f64) -> f64 {
        2e-6 * reach
    }

    fn slopes(&self, [x, y, z]: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        let (rx, ry) = (x.value(), y.value());
        match self.blocks_of(rx, ry) {
            Some((first, last)) if first == last => {
                let (sin, cos) = self.turn(first).sin_cos();
                let rounding = 4e-15 * (rx.magnitude() + ry.magnitude());
                let wide = |side: Dual<Interval>| {
                    let slopes = side.gradient().map(|slope| slope.inflate(4e-15));
                    Dual::new(side.value().inflate(rounding), slopes)
                };
                [wide(x * cos + y * sin), wide(y * cos - x * sin), z]
            }
            _ => {
                let reach = rx.norm_as(ry, Euclid).hi() * (1.0 + 1e-14);
                let anything = Dual::new(Interval::new(-reach, reach), [Interval::ALL; 3]);
                [anything, anything, z]
            }
        }
    }

    fn stretch(&self, _: [Interval; 3]) -> f64 {
        std::f64::consts::SQRT_2
    }

    fn branches(&self, [x, y, _]: [Interval; 3]) -> Option<Branches> {
        let (first, last) = self.blocks_of(x, y)?;
        let other = (last > first).then(|| self.turned(last));
        (last - first <= 1.0).then(|| (self.turned(first), other))
    }
}
