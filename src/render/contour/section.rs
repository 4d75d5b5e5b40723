//! A plane as programs see it: values, and where they rise.
//!
//! The plane is taken a hair to one side of where it is asked for. A face that lies in it is then not on the
//! plane: what is on that side counts, as it does for a layer that is printed on a plate.

use glam::{DMat3, DVec2};

use super::square::Square;
use crate::eval::{Program, Region};
use crate::{Interval, Plane, PlaneBounds};
use rvachev_field::{Way, Zone};

/// How far aside, in proportion to the size: rounding is less, and the plane that is meant is as near.
const HAIR: f64 = 1.0 / (1u64 << 37) as f64;

/// Which side of a plane counts where a face lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// The side that the plane's normal points to: of a plate with a post on it, cut where they meet, the post.
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

/// A plane, and the rectangle that what goes on beyond it is cut to.
#[derive(Clone, Copy)]
pub(super) struct Section {
    plane: Plane,
    border: PlaneBounds,
    /// How far aside of where it is asked for the plane is.
    hair: f64,
}

/// Into the border, from each of its sides.
const INWARDS: [DVec2; 4] = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y];

impl Section {
    pub(super) fn new(plane: &Plane, side: Side, border: PlaneBounds) -> Section {
        let size = (border.max - border.min).max_element();
        let hair = HAIR * (size + plane.origin().abs().max_element());
        let aside = match side {
            Side::Above => hair,
            Side::Below => -hair,
        };
        Section { plane: plane.moved_by(aside), border, hair }
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

    /// What decides about a square of the program's solid, from a height above the plane to another; `None` if the
    /// surface is not there.
    pub(super) fn filling(&self, filling: &Filling, square: &Square, heights: [f64; 2]) -> Option<Filling> {
        let (low, high) = (square.low, square.low + square.side);
        if high.cmple(self.border.min).any() || low.cmpge(self.border.max).any() {
            return None;
        }
        let border = || (self.crossed(low, high).next().is_some()).then_some(Filling::Solid);
        let Filling::Program(program) = filling else { return border() };
        let zone = self.zone(low, high, heights);
        match program.narrow_zone(&zone) {
            Region::Surface(program) => {
                let flush =
                    if heights[0] == heights[1] { program.flush(&zone, self.plane.axes(), self.hair) } else { None };
                match flush {
                    None => Some(Filling::Program(program)),
                    Some(true) => border(),
                    Some(false) => None,
                }
            }
            Region::Inside => border(),
            Region::Outside => None,
        }
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

    /// A direction along which the solid is entered, and not left, throughout a square, if each side of the square
    /// is crossed once or not at all: then the signs at its corners tell all.
    pub(super) fn way_in(&self, filling: &Filling, square: &Square) -> Option<DVec2> {
        let (low, high) = (square.low, square.low + square.side);
        let axes = self.plane.axes();
        let zone = self.zone(low, high, [0.0; 2]);
        let way = match filling {
            Filling::Solid => self.crossed(low, high).sum::<DVec2>().try_normalize()?,
            Filling::Program(program) => {
                let way = program.way_in_plane(&zone, axes)?;
                DVec2::new(way.dot(axes[0]), way.dot(axes[1]))
            }
        };
        if self.crossed(low, high).any(|inward| inward.dot(way) < 0.1) {
            return None;
        }
        // Along the sides: to the right or to the left, up or down.
        let along = [axes[0], -axes[0], axes[1], -axes[1]];
        let program_rises = match filling {
            Filling::Solid => u8::MAX,
            Filling::Program(program) => program.enters(&zone, &along.map(|middle| Way { middle, sway: 0.0 })),
        };
        let one_way = |axis: usize| {
            (2 * axis..2 * axis + 2).any(|way| {
                program_rises >> way & 1 == 1 && self.crossed(low, high).all(|inward| inward.dot(INWARDS[way]) >= 0.0)
            })
        };
        let (right, left) = (DVec2::new(high.x, low.y), DVec2::new(low.x, high.y));
        let told = |axis: usize, ends: [[DVec2; 2]; 2]| {
            one_way(axis) || ends.into_iter().all(|[from, to]| self.misses(filling, from, to))
        };
        (told(0, [[low, right], [left, high]]) && told(1, [[low, left], [right, high]])).then_some(way)
    }

    /// Whether the surface is found to miss a side of a square.
    fn misses(&self, filling: &Filling, from: DVec2, to: DVec2) -> bool {
        let own = match filling {
            Filling::Solid => Interval::new(f64::MAX, f64::MAX),
            Filling::Program(program) => {
                program.range_zone(&Zone::of_segment(self.plane.point(from), self.plane.point(to)))
            }
        };
        let (near, far) = (self.depths(from), self.depths(to));
        let low = (0..4).map(|side| near[side].min(far[side])).fold(own.lo(), f64::min);
        let high = (0..4).map(|side| near[side].max(far[side])).fold(own.hi(), f64::min);
        low > 0.0 || high < 0.0
    }
}
