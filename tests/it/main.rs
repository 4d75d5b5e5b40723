//! Integration tests: one binary, a module per subject.

mod accuracy;
mod blends;
mod building;
mod deformation;
mod errors;
mod forms;
mod formula;
mod lattices;
mod laws;
mod lengths;
mod maps;
mod mesh;
mod models;
mod narrow;
mod parameters;
mod primitives;
mod profile;
mod queries;
mod rfunction;
mod scale;
mod superellipsoid;
mod superquadric;
mod supershape;
mod supershape_ranges;
mod support;
mod zoo;
