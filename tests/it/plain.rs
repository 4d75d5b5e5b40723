//! The integration tests of what features add to: asked again without the default ones.

// They share helpers with the others.
#![allow(dead_code)]

mod building;
mod errors;
mod export;
mod form;
mod forms;
mod lattices;
mod parameters;
mod primitives;
mod support;
mod zoo;
