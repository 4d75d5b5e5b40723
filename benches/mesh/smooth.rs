//! What the search for features costs where there are none.

use glam::DVec3;
use rvachev::{CellSize, Features, MeshSettings, Run, Solid};

use crate::measure::{InTurn, in_turn};

/// Prints the rows.
pub fn rows(threads: usize) {
    let solids = [
        ("sphere", Solid::sphere(1.0)),
        ("torus", Solid::torus(1.0, 0.4)),
        ("superellipsoid", Solid::superellipsoid(DVec3::ONE, 1.0, 0.8)),
    ];
    let run = &Run { threads, ..Run::default() };
    for (name, solid) in &solids {
        for cells in [64, 128, 256, 512] {
            let job = |features| {
                let cell = CellSize::LongestSide(cells);
                let settings = MeshSettings { cell, features, ..MeshSettings::default() };
                move || solid.mesh_with(&settings, run).expect("a mesh")
            };
            let InTurn { seconds, ratio, results } = in_turn(threads, [Features::Smooth, Features::Sharp].map(job));
            println!(
                "{name:14} {cells:3}³ {threads} smooth {:.5} s, sharp {:.5} s, {ratio:.2} times; {} mesh",
                seconds[0],
                seconds[1],
                if results[0] == results[1] { "the same" } else { "another" }
            );
        }
    }
}
