//! Formulas as leaves.

use glam::DVec3;

use super::built_in::built_in;
use super::slot::Vm;
use super::{Range, ValueError};
use crate::{AnyField, Bounds, Formula};

built_in!(
    ($) dyn AnyField, FORMULAS, formula_leaves;

    /// The solid where a formula of x, y and z is negative.
    formula: Formula as leaf {
        /// The formula, negative inside, as the text of a `.vm` file.
        text: Vm = Vm(leaf.to_vm()), None, Range::ANY, example Vm("x var-x\ny var-y\nz var-z\nxx square x\nyy square y\nzz square z\nxy add xx yy\nsum add xy zz\nr sqrt sum\none const 1\nout sub r one".to_string());
        /// A box that holds the shape; infinite along the axes where it does not end.
        bounds: Bounds = leaf.bounds(), Length, Range::FINITE, example Bounds::new(-DVec3::ONE, DVec3::ONE);
    } => match Formula::from_vm(&text.0, bounds) {
        Ok(formula) => formula,
        Err(source) => return Err(ValueError::Formula { entry: "formula", parameter: "text", source }),
    };
);
