//! Below the verbs: compiled programs, narrowed to regions and run in bulk.
//!
//! A [`Solid`](crate::Solid) compiles to a [`Program`] of its values and to one for work on its
//! surface. [`Program::narrow`] leaves out what does not matter in a box. A [`Tape`] is a program
//! made ready for points of a region; an [`Evaluator`] runs it.

pub use crate::eval::{Evaluator, Gradients, Palette, Program, Region, Tape, UnequalSlices};
