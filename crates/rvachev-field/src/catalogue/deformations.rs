//! The deformations.
//!
//! Those by a law are declared for the laws that are built in; each law of a user's own makes a
//! type of its own, which is compiled, and erased, in the user's crate.

use std::sync::Arc;

use glam::DVec3;

use super::built_in::built_in;
use super::{BuiltIn, Range};
use rvachev_num::rad;

use crate::{
    Angle, AnyWarp, Bend, BendBetween, BuiltInLaw, Elongate, Erase, LinearLaw, SineWave, SmoothStep, Taper, TaperBy,
    Twist, TwistBy,
};

/// Tapers by more would shrink the section to a point or turn it inside out.
const TAPER: Range = Range::new(-0.999, 0.999);

built_in!(
    ($) dyn AnyWarp, DEFORMATIONS, deformations;

    /// Tapered along z: sections are scaled in proportion to the height.
    taper: Taper as warp {
        /// Change of the scale along x, from the middle to the upper end.
        kx: f64 = warp.kx, None, TAPER, example 0.5;
        /// Change of the scale along y.
        ky: f64 = warp.ky, None, TAPER, example -0.4;
        /// Height from the lower end to the upper, beyond which nothing changes.
        height: f64 = warp.height, Length, Range::LENGTH, example 4.0;
    } => Taper { kx, ky, height };

    /// Twisted about the z axis in proportion to the height.
    twist: Twist as warp {
        /// Angle per length.
        rate: Angle = warp.rate, AnglePerLength, Range::FINITE, example rad(0.6);
    } => Twist { rate };

    /// Bent, the z axis becoming a circle.
    bend: Bend as warp {
        /// Curvature of the bent axis; the solid's box limits it further.
        curvature: f64 = warp.curvature, PerLength, Range::FINITE, example 0.3;
        /// Direction towards the centre of curvature, from the x axis.
        angle: Angle = warp.angle, Angle, Range::FINITE, example rad(0.5);
    } => Bend { curvature, angle };

    /// Bent to an arc between two heights; what is below stays, what is above is moved rigidly.
    bend_between: BendBetween as warp {
        /// Where the arc begins.
        from: f64 = warp.from, Length, Range::FINITE, example -1.0;
        /// Where it ends, above `from`.
        to: f64 = warp.to, Length, Range::FINITE, example 1.0;
        /// By how much the upper end is turned; the solid's box limits it further.
        turn: Angle = warp.turn, Angle, Range::new(-360.0, 360.0), example rad(0.6);
        /// Direction towards the centre of curvature, from the x axis.
        angle: Angle = warp.angle, Angle, Range::FINITE, example rad(0.5);
    } => BendBetween { from, to, turn, angle };

    /// Elongated by straight pieces at the coordinate planes.
    elongate: Elongate as warp {
        /// Lengths of the pieces along x, y and z.
        lengths: DVec3 = warp.lengths, Length, Range::new(0.0, 1e9), example DVec3::new(1.0, 0.0, 4.0);
    } => Elongate { lengths };
);

/// A taper by laws that are built in.
type LawTaper = TaperBy<BuiltInLaw, BuiltInLaw>;

/// A twist by a law that is built in.
type LawTwist = TwistBy<BuiltInLaw>;

crate::parameters!(
    "Tapered along z by two laws of z."
    taper_by: LawTaper as warp {
        /// Scale along x at each height: 0.001 to 1000 over the solid.
        x_law: BuiltInLaw = warp.x.clone(), None, Range::ANY,
            example BuiltInLaw::SmoothStep(SmoothStep { from: (-1.0, 1.0), to: (1.0, 0.5) });
        /// Scale along y at each height.
        y_law: BuiltInLaw = warp.y.clone(), None, Range::ANY,
            example BuiltInLaw::Wave(SineWave { mean: 1.0, amplitude: 0.25, wavelength: 2.0, phase: rad(0.5) });
    } => TaperBy { x: x_law, y: y_law }
);

crate::parameters!(
    "Twisted about the z axis by a law of z."
    twist_by: LawTwist as warp {
        /// What the law is multiplied by.
        angle: Angle = warp.angle, Angle, Range::FINITE, example rad(0.5);
        /// The angle at each height, by what it is multiplied by.
        law: BuiltInLaw = warp.law.clone(), None, Range::ANY,
            example BuiltInLaw::Linear(LinearLaw { at_zero: 0.5, slope: 1.0 });
    } => TwistBy { angle, law }
);

/// Those by laws: taper_by, twist_by.
pub static LAW_DEFORMATIONS: &[BuiltIn<dyn AnyWarp>] = &[BuiltIn::of::<LawTaper>(), BuiltIn::of::<LawTwist>()];

/// A taper by laws that are built in, its kernels compiled here.
#[inline(never)]
pub fn taper_by(x: BuiltInLaw, y: BuiltInLaw) -> Arc<dyn AnyWarp> {
    TaperBy { x, y }.erase()
}

/// A twist by a law that is built in, its kernels compiled here.
#[inline(never)]
pub fn twist_by(angle: Angle, law: BuiltInLaw) -> Arc<dyn AnyWarp> {
    TwistBy { angle, law }.erase()
}
