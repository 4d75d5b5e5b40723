//! Set operations, and lengths.

use rvachev_field::catalogue::ValueError;

use super::part::{Either, Many, Take, Toleranced};
use super::verb::verbs;
use crate::{Blend, Profile, RFunction, Range, Solid};

/// The first operand, and the others.
fn first<T: Clone>(entry: &'static str, operands: &[T]) -> Result<(T, Vec<T>), ValueError> {
    let (first, others) = operands.split_first().ok_or_else(|| ValueError::Operands {
        entry,
        expected: <Many as Take>::OPERANDS.words(),
        found: "nothing".to_string(),
    })?;
    Ok((first.clone(), others.to_vec()))
}

verbs! {
    /// What is in any operand.
    Join union {
        /// What combines the values.
        function: RFunction = None, Range::ANY, example RFunction::P(2.0);
    } => |operands: Many| match operands {
        Many::Solids(solids) => super::Part::from(Solid::union_all(solids, function)),
        Many::Profiles(profiles) => Profile::union_all(profiles, function).into(),
    };

    /// What is in all operands.
    Join intersection {
        /// What combines the values.
        function: RFunction = None, Range::ANY, example RFunction::Associative(3.0);
    } => |operands: Many| match operands {
        Many::Solids(solids) => super::Part::from(Solid::intersection_all(solids, function)),
        Many::Profiles(profiles) => Profile::intersection_all(profiles, function).into(),
    };

    /// The first operand without the others.
    Join difference {
        /// What combines the values.
        function: RFunction = None, Range::ANY, example RFunction::MIN_MAX;
    } => |operands: Many| match operands {
        Many::Solids(solids) => {
            let (first, others) = first("difference", &solids)?;
            super::Part::from(first.difference_all(others, function))
        }
        Many::Profiles(profiles) => {
            let (first, others) = first("difference", &profiles)?;
            first.difference_all(others, function).into()
        }
    };

    /// What is in exactly one of two operands.
    Join symmetric_difference {
        /// What combines the values.
        function: RFunction = None, Range::ANY, example RFunction::Alpha(0.5);
    } => |operands: [Either; 2]| match operands {
        [Either::Solid(a), Either::Solid(b)] => super::Part::from(a.symmetric_difference(b, function)),
        [Either::Profile(a), Either::Profile(b)] => a.symmetric_difference(&b, function).into(),
        _ => unreachable!("both are of one sort"),
    };

    /// Everything outside.
    Join complement {
    } => |operand: Either| operand.map(|solid| solid.complement(), |profile| profile.complement());

    /// What is in either solid, and what the blend adds between them.
    BlendedJoin union_with {
        /// The transition.
        blend: Blend = None, Range::ANY, example Blend::Fillet { radius: 0.25 };
    } => |operands: Many| match operands {
        Many::Solids(solids) => super::Part::from(Solid::union_all_with(solids, blend)),
        Many::Profiles(profiles) => Profile::union_all_with(profiles, blend).into(),
    };

    /// What is in both solids, less what the blend takes off.
    BlendedJoin intersection_with {
        /// The transition.
        blend: Blend = None, Range::ANY, example Blend::Chamfer { leg: 0.25 };
    } => |operands: Many| match operands {
        Many::Solids(solids) => super::Part::from(Solid::intersection_all_with(solids, blend)),
        Many::Profiles(profiles) => Profile::intersection_all_with(profiles, blend).into(),
    };

    /// What is in the first solid and not in the second, less what the blend takes off.
    BlendedJoin difference_with {
        /// The transition.
        blend: Blend = None, Range::ANY, example Blend::Smooth { radius: 0.5 };
    } => |operands: Many| match operands {
        Many::Solids(solids) => {
            let (first, others) = first("difference_with", &solids)?;
            super::Part::from(first.difference_all_with(others, blend))
        }
        Many::Profiles(profiles) => {
            let (first, others) = first("difference_with", &profiles)?;
            first.difference_all_with(others, blend).into()
        }
    };

    /// The solid whose value is larger by a number.
    Length level {
        /// What is added.
        value: f64 = Length, Range::FINITE, example 0.25;
    } => |operand: Either| operand.map(|solid| solid.level(value), |profile| profile.level(value));

    /// The surface moved outwards.
    Length offset {
        /// How far; inwards if negative.
        distance: f64 = Length, Range::FINITE, example 0.25;
    } => |operand: Either| operand.map(|solid| solid.offset(distance), |profile| profile.offset(distance));

    /// A wall of even thickness inside the surface.
    Length shell {
        /// How thick.
        thickness: f64 = Length, Range::LENGTH, example 0.125;
    } => |operand: Either| operand.map(|solid| solid.shell(thickness), |profile| profile.shell(thickness));

    /// Convex edges rounded: what balls fill that are inside.
    Length rounded {
        /// Of the ball.
        radius: f64 = Length, Range::LENGTH, example 0.125;
    } => |operand: Either| operand.map(|solid| solid.rounded(radius), |profile| profile.rounded(radius));

    /// Concave edges filled: all that balls do not reach from outside.
    Length filleted {
        /// Of the ball.
        radius: f64 = Length, Range::LENGTH, example 0.125;
    } => |operand: Either| operand.map(|solid| solid.filleted(radius), |profile| profile.filleted(radius));

    /// A length or a blend by fillet or chamfer, measured to a tolerance.
    Length with_tolerance {
        /// How far the surface may be off.
        tolerance: f64 = Length, Range::LENGTH, example 0.001;
    } => |operand: Toleranced| operand.0.map(
        |solid| solid.with_tolerance(tolerance),
        |profile| profile.with_tolerance(tolerance),
    );
}
