//! A plane as programs see it: values, and where they rise.
//!
//! The plane is taken a little to one side of where it is asked for. A face that lies in it is then
//! not on the plane: what is on that side counts, as it does for a layer that is printed on a
//! plate.

use glam::{DMat3, DVec2};

use super::ContourSettings;
use super::square::{DEEPEST, Square};
use crate::eval::{Program, Region};
use crate::{Bounds, Plane, PlaneBounds};
use rvachev_field::Zone;

/// How far aside, in proportion to the size: rounding is less, and the plane that is meant is as
/// near.
const EPSILON: f64 = 1.0 / (1u64 << 37) as f64;

/// The same where lengths are measured, from surfaces in single precision.
const MEASURED: f64 = 1.0 / (1u64 << 18) as f64;

/// How far above a plane, and those up to a height above it, it is to be looked for what counts as
/// above it.
pub(in super::super) fn aside(program: &Program, plane: &Plane, border: PlaneBounds, height: f64) -> f64 {
    let epsilon = if program.is_steady() { EPSILON } else { MEASURED };
    epsilon * ((border.max - border.min).max_element() + plane.origin().abs().max_element() + height)
}

/// Squares that are no larger, in the smallest squares, are looked at by samples where ranges of
/// slopes tell nothing: a 256th of the first where halving them will not mend that, and else when
/// they have been halved some times more.
const SAMPLED: [u32; 2] = [1 << (DEEPEST - 8), 1 << (DEEPEST - 12)];

/// Steeper than this ranges of slopes tell nothing: that of a root is held there where it has none.
const STEEP: f64 = 1e9;

/// Ranges that are wider than so many times what samples differ by do not become narrower soon.
const WIDE: f64 = 4.0;

/// Where, in a square, and the least cosine of the angle between a slope there and their mean.
const SAMPLES: [[f64; 2]; 5] = [[0.5, 0.5], [0.02, 0.03], [0.97, 0.02], [0.98, 0.97], [0.03, 0.98]];
const STRAIGHT: f64 = 0.5;

/// Which side of a plane counts where a face lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// The side that the plane's normal points to: of a plate with a post on it, cut where they
    /// meet, the post.
    #[default]
    Above,
    /// The other one: of the same, the plate.
    Below,
}

/// What decides about the points of a square.
#[derive(Clone)]
pub(super) enum Filling {
    /// All of it is in the solid: the border of the plane decides.
    Solid,
    /// A program does, and the border.
    Program(Program),
}

/// A direction along which a square's solid is entered.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    pub(super) way: DVec2,
    /// Whether some points show it, and no ranges.
    pub(super) by_samples: bool,
}

impl Entry {
    fn told(way: DVec2) -> Entry {
        Entry { way, by_samples: false }
    }
}

/// A plane, and the rectangle that what goes on beyond it is cut to.
#[derive(Clone, Copy)]
pub(super) struct Section {
    plane: Plane,
    border: PlaneBounds,
    /// How far aside of where it is asked for the plane is.
    epsilon: f64,
    /// How far contours may be off.
    tolerance: f64,
}

/// Into the border, from each of its sides.
const INWARDS: [DVec2; 4] = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];

impl Section {
    /// Planes at heights above one.
    pub(super) fn stack(
        program: &Program,
        plane: &Plane,
        heights: &[f64],
        settings: &ContourSettings,
        border: PlaneBounds,
    ) -> Vec<Section> {
        let farthest = heights.iter().fold(0.0, |farthest: f64, height| farthest.max(height.abs()));
        // One for all: the planes of a stack stay as far apart as they are.
        let epsilon = aside(program, plane, border, farthest);
        let aside = match settings.side {
            Side::Above => epsilon,
            Side::Below => -epsilon,
        };
        let tolerance = settings.tolerance;
        let section = |height: &f64| Section { plane: plane.moved_by(height + aside), border, epsilon, tolerance };
        heights.iter().map(section).collect()
    }

    /// The value at a point: positive in the solid and within the border.
    pub(super) fn value(&self, filling: &Filling, p: DVec2) -> f64 {
        let own = match filling {
            Filling::Solid => f64::INFINITY,
            Filling::Program(program) => program.value(self.plane.point(p)),
        };
        self.depths(p).into_iter().fold(own, f64::min)
    }

    /// How far a point is from the sides of the border.
    fn depths(&self, p: DVec2) -> [f64; 4] {
        let (low, high) = (p - self.border.min, self.border.max - p);
        [low.x, high.x, low.y, high.y]
    }

    pub(super) fn is_inside(&self, filling: &Filling, p: DVec2) -> bool {
        self.value(filling, p) > 0.0
    }

    /// The gradient of the value in the plane.
    pub(super) fn gradient(&self, filling: &Filling, p: DVec2) -> DVec2 {
        let own = match filling {
            Filling::Solid => (f64::INFINITY, DVec2::ZERO),
            Filling::Program(program) => {
                let (value, slope) = program.gradient(self.plane.point(p));
                let [u, v] = self.plane.axes();
                (value, DVec2::new(slope.dot(u), slope.dot(v)))
            }
        };
        let sides = self.depths(p).into_iter().zip(INWARDS);
        sides.fold(own, |least, side| if side.0 < least.0 { side } else { least }).1
    }

    /// What decides about a square of the program's solid, from a height above the plane to
    /// another; `None` if the surface is not there.
    pub(super) fn filling(&self, filling: &Filling, square: &Square, heights: [f64; 2]) -> Option<Filling> {
        let (low, high) = (square.low, square.low + square.side);
        if high.cmple(self.border.min).any() || low.cmpge(self.border.max).any() {
            return None;
        }
        let border = || (!self.holds(square)).then_some(Filling::Solid);
        let Filling::Program(program) = filling else { return border() };
        let zone = self.zone(low, high, heights);
        match program.narrow_zone(&zone) {
            Region::Surface(program) => Some(Filling::Program(program.unfolded(&zone).unwrap_or(program))),
            Region::Inside => border(),
            Region::Outside => None,
        }
    }

    /// Whether a square is all within the border.
    pub(super) fn holds(&self, square: &Square) -> bool {
        self.crossed(square.low, square.low + square.side).next().is_none()
    }

    /// A rectangle of the plane, from a height above it to another.
    fn zone(&self, low: DVec2, high: DVec2, heights: [f64; 2]) -> Zone {
        let [u, v] = self.plane.axes();
        let normal = self.plane.normal();
        let (half, rise) = (0.5 * (high - low), 0.5 * (heights[1] - heights[0]));
        let centre = self.plane.point(0.5 * (low + high)) + (heights[0] + rise) * normal;
        Zone::of_frame(centre, DMat3::from_cols(half.x * u, half.y * v, rise * normal))
    }

    /// Into the border, from those sides of it that a rectangle crosses.
    fn crossed(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = DVec2> + use<> {
        let (near, far) = (self.depths(low), self.depths(high));
        (0..4).filter(move |side| near[*side].min(far[*side]) <= 0.0).map(|side| INWARDS[side])
    }

    /// A direction along which the solid is entered, and not left, throughout a square, and so
    /// along all directions within 30° of it: the contour is the graph of a function there that is
    /// no steeper than 60°.
    pub(super) fn way_in(&self, filling: &Filling, square: &Square) -> Option<Entry> {
        let (low, high) = (square.low, square.low + square.side);
        let entry = match filling {
            Filling::Solid => Entry::told(self.crossed(low, high).sum::<DVec2>().try_normalize()?),
            Filling::Program(program) => match self.told_way(program, square) {
                Some(way) => Entry::told(way),
                None => self.sampled_way(filling, program, square)?,
            },
        };
        self.crossed(low, high).all(|inward| inward.dot(entry.way) > STRAIGHT).then_some(entry)
    }

    /// The same as ranges tell it.
    fn told_way(&self, program: &Program, square: &Square) -> Option<DVec2> {
        let axes = self.plane.axes();
        let way = program.way_in_plane(&self.zone(square.low, square.low + square.side, [0.0; 2]), axes)?;
        Some(DVec2::new(way.dot(axes[0]), way.dot(axes[1])))
    }

    /// Whether ranges of slopes tell something.
    fn is_told(&self, program: &Program, square: &Square) -> bool {
        let [low, high] = [square.low, square.low + square.side].map(|p| self.plane.point(p));
        program.is_steady() && program.steepest(&Bounds::new(low.min(high), low.max(high))) < STEEP
    }

    /// The same as it looks at some points: of some values ranges of slopes tell nothing.
    fn sampled_way(&self, filling: &Filling, program: &Program, square: &Square) -> Option<Entry> {
        let [most, least] = SAMPLED;
        if square.size > most || !self.holds(square) || self.is_told(program, square) {
            return None;
        }
        let samples = SAMPLES.map(|[x, y]| square.low + square.side * DVec2::new(x, y));
        let slopes = samples.map(|p| self.gradient(filling, p).normalize_or_zero());
        let way = slopes.iter().sum::<DVec2>().try_normalize()?;
        let is_way = slopes.iter().all(|slope| slope.dot(way) > STRAIGHT);
        let is_last = || {
            let values = samples.map(|p| self.value(filling, p));
            let [low, high] = [f64::min, f64::max].map(|of| values.into_iter().reduce(of).unwrap_or(0.0));
            let range = program.range_zone(&self.zone(square.low, square.low + square.side, [0.0; 2]));
            range.width() > WIDE * (high - low)
        };
        (is_way && (square.size <= least || is_last())).then_some(Entry { way, by_samples: true })
    }

    /// Whether a square is all inside, or all outside, because what begins there ends there too.
    pub(super) fn flush(&self, filling: &Filling, square: &Square) -> Option<bool> {
        let Filling::Program(program) = filling else { return None };
        let zone = self.zone(square.low, square.low + square.side, [0.0; 2]);
        program.flush(&zone, self.plane.axes(), [self.epsilon, self.tolerance])
    }
}
