//! Names and paints.

use super::part::Either;
use super::verb::verbs;
use crate::{Paint, Range};

verbs! {
    /// The same solid, named.
    Attribute named {
        /// What errors and pictures call it; control characters become spaces.
        name: String = None, Range::ANY, example "knob".to_string();
    } => |operand: Either| operand.map(|solid| solid.named(&name), |profile| profile.named(&name));

    /// The same solid, painted.
    Attribute paint {
        /// Its colour.
        color: [u8; 3] = None, Range::new(0.0, 255.0), example [192, 128, 64];
        /// How blurred reflections are: 0 polished, 1 matt.
        roughness: f64 = None, Range::new(0.0, 1.0), example 0.25;
    } => |operand: Either| {
        let paint = Paint { color, roughness };
        operand.map(|solid| solid.paint(paint), |profile| profile.paint(paint))
    };
}
