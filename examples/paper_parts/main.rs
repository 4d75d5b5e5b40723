//! The figures of the paper on rational supershapes, made anew: sections with the radii found,
//! rational radii, truncation, and whole parts from segmented meshes, holes included.
//!
//! ```text
//! cargo run --release --example paper_parts -- folder
//! ```
//!
//! writes `paper_sections.png`, `paper_rational.png`, `paper_truncated.png` and `paper_parts.png`,
//! and prints the errors: the share of common volume (IoU), the deviation of the points, and the
//! global error of fit before and after the joint refinement.
//!
//! Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*.

mod canvas;
mod curves;
mod parts;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;
    curves::sections(&folder)?;
    curves::rational(&folder)?;
    parts::truncated(&folder)?;
    parts::parts(&folder)
}
