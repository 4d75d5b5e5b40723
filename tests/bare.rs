//! What features touch, for a build without them:
//! `cargo test --no-default-features --test bare`. With features these are modules of `it`, which
//! takes far longer to compile.

#![allow(dead_code, unused_imports, reason = "helpers are for all modules of `it`")]

mod it {
    mod building;
    mod errors;
    mod export;
    mod form;
    mod forms;
    pub mod lattices;
    mod maps;
    pub mod models;
    pub mod narrow;
    mod parameters;
    pub mod primitives;
    pub mod support;
    pub mod zoo;
}

use it::{lattices, models, narrow, primitives, support, zoo};
