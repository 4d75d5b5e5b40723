//! Solids as Rust code that makes them again: [`Solid::to_rust`](crate::Solid::to_rust) and
//! [`RustFile`].
//!
//! What is written is the graph ([`form`](crate::form)), node by node, by the methods that a user
//! would call. `graph` says which nodes become variables, `lengths` which numbers do, `calls` and
//! `values` how each entry of the [catalogue](crate::catalogue()) is spelt, `layout` where lines
//! are broken.

mod calls;
mod file;
mod function;
mod graph;
mod layout;
mod lengths;
mod names;
mod syntax;
mod values;

pub use file::{RustFile, RustSettings};
