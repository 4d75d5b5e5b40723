//! Values that parameters take: R-functions, blends, laws, caps.

use glam::DVec2;

use super::verb::verbs;
use crate::{Angle, Blend, BuiltInLaw, Caps, LawTable, LinearLaw, RFunction, Range, SineWave, SmoothStep, Value, rad};

/// Exponents of norms.
const EXPONENT: Range = Range::new(1.001, 1000.0);

verbs! {
    /// Min and max.
    Function min_max {
    } => |(): ()| Value::Function(RFunction::MIN_MAX);

    /// R_α: analytic but at corners; 1 is min and max.
    Function alpha {
        /// Above −1, up to 1.
        alpha: f64 = None, Range::above(-1.0, 1.0), example 0.0;
    } => |(): ()| Value::Function(RFunction::Alpha(alpha));

    /// R_0^m: m times differentiable even at corners.
    Function zero {
        /// The order of smoothness.
        m: u32 = None, Range::new(0.0, 8.0), example 2;
    } => |(): ()| Value::Function(RFunction::Zero { m });

    /// R_p: unit slope at the surface to order p − 1.
    Function p {
        /// The exponent.
        p: f64 = None, EXPONENT, example 2.0;
    } => |(): ()| Value::Function(RFunction::P(p));

    /// N_p: associative, of unit slope at the surface.
    Function associative {
        /// The exponent.
        p: f64 = None, EXPONENT, example 3.0;
    } => |(): ()| Value::Function(RFunction::Associative(p));

    /// The true distance where operands have it and meet at right angles.
    Function distance {
    } => |(): ()| Value::Function(RFunction::Distance);

    /// A smooth transition of compact support.
    Blend smooth {
        /// Values that differ by less than this are blended.
        radius: f64 = Length, Range::LENGTH, example 0.5;
    } => |(): ()| Value::Blend(Blend::Smooth { radius });

    /// A rounding of constant radius.
    Blend fillet {
        /// Radius of the ball that rolls along the edge.
        radius: f64 = Length, Range::LENGTH, example 0.25;
    } => |(): ()| Value::Blend(Blend::Fillet { radius });

    /// A flat face along the edge.
    Blend chamfer {
        /// How far from the edge the face begins, along either operand.
        leg: f64 = Length, Range::LENGTH, example 0.25;
    } => |(): ()| Value::Blend(Blend::Chamfer { leg });

    /// Pasko and Savchenko's displacement, which reaches everywhere.
    Blend displacement {
        /// How far values are moved where both operands are 0.
        height: f64 = Length, Range::FINITE, example 0.25;
        /// The operands' values at which the displacement has fallen to half.
        falloff: DVec2 = Length, Range::LENGTH, example DVec2::new(1.0, 0.5);
    } => |(): ()| Value::Blend(Blend::Displacement { height, falloff: falloff.to_array() });

    /// Ricci's blend of gauges.
    Blend ricci {
        /// The exponent.
        p: f64 = None, EXPONENT, example 4.0;
    } => |(): ()| Value::Blend(Blend::Ricci { p });

    /// The same value at every height.
    Law constant {
        /// The value.
        value: f64 = None, Range::FINITE, example 0.75;
    } => |(): ()| Value::Law(BuiltInLaw::Constant(value));

    /// A straight line.
    Law linear {
        /// Value at z = 0.
        at_zero: f64 = None, Range::FINITE, example 1.0;
        /// Change of the value per length.
        slope: f64 = PerLength, Range::FINITE, example -0.25;
    } => |(): ()| Value::Law(BuiltInLaw::Linear(LinearLaw { at_zero, slope }));

    /// A smooth step from one value to another, level before and after.
    Law smooth_step {
        /// Where it begins: z and value.
        from: DVec2 = None, Range::FINITE, example DVec2::new(-1.0, 1.0);
        /// Where it ends: z, by 10⁻⁹ or more above that of the beginning, and value.
        to: DVec2 = None, Range::FINITE, example DVec2::new(1.0, 0.5);
    } => |(): ()| Value::Law(BuiltInLaw::SmoothStep(SmoothStep { from: from.into(), to: to.into() }));

    /// A sine wave.
    Law wave {
        /// The value about which it swings.
        mean: f64 = None, Range::FINITE, example 1.0;
        /// How far it swings to either side.
        amplitude: f64 = None, Range::FINITE, example 0.25;
        /// Length of a period along z.
        wavelength: f64 = Length, Range::LENGTH, example 2.0;
        /// Phase at z = 0.
        phase: Angle = Angle, Range::FINITE, example rad(0.5);
    } => |(): ()| Value::Law(BuiltInLaw::Wave(SineWave { mean, amplitude, wavelength, phase }));

    /// Straight lines between points, level before the first and after the last.
    Law table {
        /// 1 to 1000 points, each z and value, z rising by 10⁻⁹ or more.
        points: Vec<DVec2> = None, Range::FINITE,
            example vec![DVec2::new(-1.0, 1.0), DVec2::new(0.0, 0.5), DVec2::new(2.0, 0.75)];
    } => |(): ()| Value::Law(BuiltInLaw::Table(LawTable::new(points.into_iter().map(Into::into))));

    /// Sharp edges.
    Caps flat_caps {
    } => |(): ()| Value::Caps(Caps::Flat);

    /// Edges bevelled at 45°.
    Caps chamfered_caps {
        /// How far from the edge the bevel begins, on either face.
        leg: f64 = Length, Range::LENGTH, example 0.25;
    } => |(): ()| Value::Caps(Caps::Chamfered(leg));

    /// Rounded edges.
    Caps rounded_caps {
        /// The radius.
        radius: f64 = Length, Range::LENGTH, example 0.25;
    } => |(): ()| Value::Caps(Caps::Rounded(radius));
}
