//! Meshes within a tolerance, of parts that are flat or round.

use rvachev::{CellSize, MeshSettings, Run, Solid, deg};

use crate::measure::{InTurn, in_turn};

/// Prints the rows: how long each takes, beside a mesh in 128 cells along the longest side.
pub fn rows(threads: usize) {
    let fin = Solid::cuboid([20.0, 20.0, 4.0]) | Solid::cuboid([0.4, 20.0, 10.0]).translate([0.0, 0.0, 5.0]);
    let solids = [
        ("cylinder", Solid::cylinder(3.0, 12.0), [0.02, 0.002]),
        ("box", Solid::cuboid([20.0, 20.0, 4.0]), [0.1, 0.01]),
        ("box, turned", Solid::cuboid([20.0, 20.0, 4.0]).rotate_x(deg(30.0)).rotate_z(deg(17.0)), [0.1, 0.01]),
        ("thin fin", fin, [0.1, 0.01]),
    ];
    let run = &Run { threads, ..Run::default() };
    for (name, solid, tolerances) in &solids {
        for tolerance in *tolerances {
            let job = |cell| {
                let settings = MeshSettings { cell, ..MeshSettings::default() };
                move || solid.mesh_with(&settings, run).expect("a mesh")
            };
            let cells = [CellSize::LongestSide(128), CellSize::Tolerance(tolerance)];
            let InTurn { seconds, ratio, results } = in_turn(threads, cells.map(job));
            println!(
                "{name:14} {threads} within {tolerance:5}: {:.3} s, {ratio:.2} times that of 128 cells, {} triangles",
                seconds[1],
                results[1].triangles().len()
            );
        }
    }
}
