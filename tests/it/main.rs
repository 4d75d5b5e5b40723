//! Integration tests: one binary, a module per subject.

mod accuracy;
mod battery;
mod blends;
mod bounds;
mod building;
mod caps;
mod check;
mod clearance;
#[cfg(feature = "formula")]
mod code;
mod compiling;
mod components;
mod deformation;
mod drafts;
mod errors;
mod explicit_inputs;
mod explicit_points;
mod export;
mod form;
mod forms;
#[cfg(feature = "formula")]
mod formula;
mod from_mesh;
mod golden;
mod house;
#[cfg(feature = "import")]
mod import;
mod inputs;
mod lattices;
mod laws;
mod length_ranges;
mod lengths;
mod many;
mod maps;
mod measure;
#[cfg(feature = "import")]
mod measure_part;
mod mesh;
mod models;
mod narrow;
mod pace;
mod paint;
mod parameters;
mod patches;
mod pictures;
mod placing;
mod primitives;
mod profile;
mod profile_verbs;
mod progress;
mod queries;
mod random_fields;
mod range_images;
mod raster;
mod rays;
mod recovery;
mod rfunction;
#[cfg(feature = "formula")]
mod rows;
mod runs;
mod sampling;
mod scale;
mod sections;
#[cfg(feature = "serde")]
mod serde;
mod shadows;
mod sharp;
mod sharp_vertices;
mod slices;
mod spicy;
mod subdivision;
mod superellipsoid;
mod superquadric;
mod supershape;
mod supershape_ranges;
mod support;
mod thickness;
mod thin;
mod tight;
mod tolerance;
mod volume;
mod within;
mod workpieces;
mod zbuffer;
mod zoo;
