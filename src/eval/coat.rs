//! The coat of a leaf: where the paint of its surface comes from.
//!
//! ```text
//!     leaf of the user's          the outermost paint above it
//!     mesh with colours           those at the nearest point of its triangles, under that
//!     offset, inner wall          the operand's paint at the foot of the point on it
//!     fillet, chamfer             the operands' paints at the feet, mixed by the distances:
//!                                 wᵢ = max(0, 1/dᵢ − 1/R)
//! ```
//!
//! A paint on top of the leaf hides what is below. R is the distance beyond which an operand has
//! nothing to do with the fillet. At the surface of an operand its weight is infinite: its paint
//! is pure there.

use std::sync::Arc;

use glam::DVec3;

use super::apart::{Near, measured, sign};
use super::compile::kept;
use super::fill::FARTHEST;
use super::palette::Palette;
use crate::solid::{Length, Node};
use crate::{Bounds, Dual, Paint, Solid};
use rvachev_field::AnyField;

/// The paint of all that is below a node.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Below {
    Nothing,
    One(Option<Paint>),
    Various,
}

impl Below {
    pub(super) fn with(self, other: Below) -> Below {
        match (self, other) {
            (Below::Nothing, one) | (one, Below::Nothing) => one,
            (a, b) if a == b => a,
            _ => Below::Various,
        }
    }
}

/// Where the paint of a leaf's surface comes from.
#[derive(Clone)]
pub(super) enum Coat {
    /// It is the same all over.
    One(Option<Paint>),
    /// It is that of the operands that the surface was made from.
    Operands(Arc<[Operand]>),
    /// The leaf has colours of its own.
    Own(Arc<dyn AnyField>),
}

/// An operand of a length, a fillet or a chamfer.
pub(super) struct Operand {
    palette: Palette,
    /// How far points are from its surface, more or less.
    distance: Arc<dyn AnyField>,
    /// Beyond this box it has no weight.
    bounds: Bounds,
    /// Nor where it is farther away than this.
    reach: f64,
}

/// A point of an operand's surface, and how much it counts.
pub(super) struct Foot<'a> {
    pub(super) palette: &'a Palette,
    pub(super) point: DVec3,
    pub(super) share: f64,
}

impl Coat {
    /// What a node gives to the leaf that is made of its operands, which have been compiled.
    pub(super) fn of(solid: &Solid) -> Coat {
        let found = measured(solid);
        let operands = found.as_ref().map_or_else(|| solid.node().operands(), |found| found.operands(solid));
        let palette = |operand: &Solid| kept(operand).map(|programs| programs.palette.clone());
        let all = operands.iter().filter_map(palette).fold(Below::Nothing, |all, own| all.with(own.below()));
        match all {
            Below::Nothing => Coat::One(None),
            Below::One(paint) => Coat::One(paint),
            Below::Various => Coat::Operands(operands_of(solid).into()),
        }
    }

    pub(super) fn below(&self) -> Below {
        match self {
            Coat::One(paint) => Below::One(*paint),
            Coat::Operands(_) | Coat::Own(_) => Below::Various,
        }
    }
}

fn operands_of(solid: &Solid) -> Vec<Operand> {
    let node = solid.node();
    let found = measured(solid);
    let operands = found.as_ref().map_or_else(|| node.operands(), |found| found.operands(solid));
    let (reach, around) = match node {
        Node::Blend { operation, blend, .. } => {
            let near = Near::of(*operation, *blend, operands);
            (FARTHEST * near.radius, near.around)
        }
        _ => (f64::INFINITY, vec![Bounds::ALL]),
    };
    // An offset reads the distance itself.
    let own = match node {
        Node::Length { length: Length::Offset(_) | Length::Shell(_), .. } => found.as_ref(),
        _ => None,
    };
    let operand = |(operand, bounds): (&Solid, Bounds)| {
        let programs = kept(operand)?;
        let distance = own.as_ref().map_or_else(|| sign(&programs), |measured| measured.field.clone());
        Some(Operand { palette: programs.palette.clone(), distance, bounds, reach })
    };
    operands.iter().zip(around).filter_map(operand).collect()
}

impl Operand {
    /// The point of the surface that is nearest to `p`, and how far it is: along the gradient,
    /// which leads there at once where the value is a distance.
    fn foot(&self, p: DVec3) -> (DVec3, f64) {
        /// Where it is none, a few steps lead near enough to tell the parts.
        const STEPS: usize = 4;
        let steps = if self.distance.exact() { 1 } else { STEPS };
        let mut point = p;
        for _ in 0..steps {
            let dual = self.distance.dual(Dual::point(point.to_array()));
            let gradient = DVec3::from_array(dual.gradient());
            let step = dual.value() / gradient.length_squared() * gradient;
            if !step.is_finite() {
                break;
            }
            point -= step;
        }
        (point, point.distance(p))
    }
}

/// The feet of a point on operands, with shares that add up to 1.
pub(super) fn feet(operands: &[Operand], p: DVec3) -> Vec<Foot<'_>> {
    /// Nearer than this all are at the surface, and a sum of weights is finite.
    const NEAREST: f64 = 1e-100;
    let mut feet = Vec::new();
    for operand in operands.iter().filter(|operand| operand.bounds.contains(p)) {
        let (point, distance) = operand.foot(p);
        let share = 1.0 / distance.max(NEAREST) - 1.0 / operand.reach;
        if share > 0.0 {
            feet.push(Foot { palette: &operand.palette, point, share });
        }
    }
    let sum: f64 = feet.iter().map(|foot| foot.share).sum();
    for foot in &mut feet {
        foot.share /= sum;
    }
    feet
}
