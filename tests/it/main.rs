//! Integration tests: one binary, a module per subject.

mod accuracy;
mod deformation;
mod errors;
mod forms;
mod laws;
mod mesh;
mod models;
mod narrow;
mod profile;
mod queries;
mod rfunction;
mod scale;
mod superellipsoid;
mod supershape;
mod support;
