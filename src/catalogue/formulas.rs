//! Profiles by a formula.

use glam::DVec3;
use rvachev_field::catalogue::ValueError;

use super::verb::verbs;
use crate::{Bounds, Formula, Profile, Range};

verbs! {
    /// The plane shape where a formula of x and y is negative.
    Profile profile_formula {
        /// The formula, negative inside, as the text of a `.vm` file.
        text: String = None, Range::ANY,
            example "x var-x\ny var-y\na abs x\nb abs y\nsum add a b\none const 1\nout sub sum one".to_string();
        /// A box that holds the shape, infinite along z.
        bounds: Bounds = Length, Range::FINITE, example Bounds::new(
            DVec3::new(-1.0, -1.0, f64::NEG_INFINITY),
            DVec3::new(1.0, 1.0, f64::INFINITY),
        );
    } => |(): ()| match Formula::from_vm(&text, bounds) {
        Ok(formula) => Profile::from(formula),
        Err(source) => return Err(ValueError::Formula { entry: "profile_formula", parameter: "text", source }),
    };
}
