//! Meshing beside fidget-mesh on the models M1 to M6, and how it scales.
//!
//! `cargo bench --bench mesh` prints, on one thread and on two: seconds (of the processor on one
//! thread, of the clock on two; the least of several runs), triangles, millions of triangles a
//! second, the peak of memory during a run in a process of its own, and how many times faster than
//! fidget's VM on the same model, box and number of cells, in the same run. Ours has welded indices
//! and normals, once `Smooth` (marching cubes), once `Sharp`, and then both in turn; fidget's is
//! manifold dual contouring without normals.
//!
//! Before that come extraction alone, from arrays of 257³ samples; scale: a sphere at 1024³ and
//! 2048³, a ball of gyroid at 512³, unions of 100 and of 10 000 superellipsoids at 256³; how soon
//! cancelled runs and reports return; both modes on smooth solids; smooth chains of many
//! operands beside their hard unions; meshes within a tolerance; and how much faster two threads
//! are than one, by the clock.
//!
//! Threads are those of a pool that is there before the clock starts, and awake; fidget's as ours.
//!
//! Words after `--` choose: `models`, `arrays`, `scale`, `cancel`, `smooth`, `chains`,
//! `tolerance`; names of models, cells along the side (64, 128, 256), `one` or `two` threads;
//! `fidget` for fidget on all models, also where it takes minutes, `alone` for ours without fidget.

#[path = "mesh/cancel.rs"]
mod cancel;
#[path = "mesh/chains.rs"]
mod chains;
#[path = "evaluate/lean.rs"]
mod lean;
#[path = "mesh/measure.rs"]
mod measure;
#[path = "mesh/memory.rs"]
mod memory;
#[path = "../tests/it/models.rs"]
mod models;
#[path = "mesh/peer.rs"]
mod peer;
#[path = "mesh/scale.rs"]
mod scale;
#[path = "mesh/smooth.rs"]
mod smooth;
#[path = "mesh/tolerance.rs"]
mod tolerance;
#[path = "mesh/volume.rs"]
mod volume;

use rvachev::{CellSize, Features, Mesh, MeshSettings, Run};

use measure::{Cost, in_turn, measured};
use memory::{MEMORY, memory_apart, print_memory};
use models::Model;

/// What the words on the command line choose.
struct Chosen {
    words: Vec<String>,
}

impl Chosen {
    /// Whether a word of a group is among the words, or none of the group is.
    fn takes(&self, word: &str, group: &[&str]) -> bool {
        self.has(word) || !group.iter().any(|other| self.has(other))
    }

    fn has(&self, word: &str) -> bool {
        self.words.iter().any(|other| other == word)
    }
}

/// What meshes a model: smooth, and sharp.
fn ours(model: &Model, cells: u32, threads: usize) -> [impl FnMut() -> Mesh + Send; 2] {
    let cell = CellSize::Length(2.0 * model.half / f64::from(cells));
    [Features::Smooth, Features::Sharp].map(|features| {
        let settings = MeshSettings { cell, bounds: Some(model.cube()), features, ..MeshSettings::default() };
        let run = Run { threads, ..Run::default() };
        move || model.solid.mesh_with(&settings, &run).expect("a model")
    })
}

fn row(name: &str, cells: u32, threads: usize, who: &str, cost: Cost, triangles: usize, ratio: Option<f64>) {
    let Cost { seconds, megabytes } = cost;
    let rate = triangles as f64 / seconds * 1e-6;
    let ratio = ratio.map_or(String::new(), |ratio| format!("{ratio:8.1} x"));
    println!(
        "{name:4} {cells:4}³ {threads:2} {who:8} {seconds:9.4} s {triangles:9} {rate:8.2} Mtri/s {megabytes:7.1} MB{ratio}"
    );
}

/// Whether fidget takes more than some ten seconds.
fn is_slow(name: &str, cells: u32) -> bool {
    match name {
        "M3" => cells > 128,
        "M4" => cells > 128,
        "M5" => true,
        _ => false,
    }
}

/// Prints the memory of a job, given as [`memory_apart`] has it.
fn print_memory_of([who, name, cells, threads]: [&str; 4]) {
    let (cells, threads) = (cells.parse().expect("a number"), threads.parse().expect("a number"));
    if who == scale::SCALE {
        return print_memory(threads, scale::job(name, cells, threads));
    }
    let model = models::all().into_iter().find(|model| model.name == name).expect("a model");
    let [smooth, sharp] = ours(&model, cells, threads);
    match who {
        SMOOTH => print_memory(threads, smooth),
        SHARP => print_memory(threads, sharp),
        _ => print_memory(threads, peer::fidget(&model, cells.ilog2(), threads)),
    }
}

/// Models that are joined by R_p, and the same joined by min and max.
const RFUNCTION_TWINS: [(&str, &str); 2] = [("M3", "M2"), ("M5", "M4")];

/// Whose rows there are.
const SMOOTH: &str = "smooth";
const SHARP: &str = "sharp";
const FIDGET: &str = "fidget";

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [MEMORY, who, name, cells, threads] = words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        return print_memory_of([who, name, cells, threads]);
    }
    let chosen = Chosen { words };
    const NAMES: [&str; 6] = ["M1", "M2", "M3", "M4", "M5", "M6"];
    const CELLS: [&str; 3] = ["64", "128", "256"];
    const THREADS: [&str; 2] = ["one", "two"];
    const PARTS: [&str; 7] = ["models", "arrays", "scale", "cancel", "smooth", "chains", "tolerance"];
    if chosen.takes("arrays", &PARTS) {
        volume::rows();
    }
    for threads in (1..=2).filter(|&threads| chosen.takes(THREADS[threads - 1], &THREADS)) {
        if chosen.takes("scale", &PARTS) {
            scale::rows(threads);
        }
        if chosen.takes("cancel", &PARTS) {
            cancel::rows(threads);
        }
        if chosen.takes("smooth", &PARTS) {
            smooth::rows(threads);
        }
        if chosen.takes("chains", &PARTS) {
            chains::rows(threads);
        }
        if chosen.takes("tolerance", &PARTS) {
            tolerance::rows(threads);
        }
    }
    if chosen.takes("scale", &PARTS) && THREADS.iter().all(|threads| chosen.takes(threads, &THREADS)) {
        scale::gains();
    }
    if !chosen.takes("models", &PARTS) {
        return;
    }
    let mut known: Vec<(&str, u32, usize, f64)> = Vec::new();
    for model in models::all().into_iter().filter(|model| chosen.takes(model.name, &NAMES)) {
        for cells in CELLS.into_iter().filter(|cells| chosen.takes(cells, &CELLS)) {
            let cells: u32 = cells.parse().expect("a number");
            for threads in (1..=2).filter(|&threads| chosen.takes(THREADS[threads - 1], &THREADS)) {
                let mut jobs = ours(&model, cells, threads);
                let [cells_word, threads_word] = [cells as usize, threads].map(|n| n.to_string());
                let memory = |who| memory_apart([who, model.name, &cells_word, &threads_word]);
                let costs = jobs.each_mut().map(|job| {
                    let (seconds, mesh) = measured(threads, job);
                    (seconds, mesh.triangles().len())
                });
                let sharp_over_smooth = in_turn(threads, jobs).ratio;
                // Last, so that no memory of its is used again.
                let skipped = chosen.has("alone") || is_slow(model.name, cells) && !chosen.has("fidget");
                let other = (!skipped).then(|| {
                    let (seconds, (_, mesh)) = measured(threads, peer::fidget(&model, cells.ilog2(), threads));
                    (seconds, mesh.triangles.len())
                });
                for (who, (seconds, triangles)) in [SMOOTH, SHARP].into_iter().zip(costs) {
                    let ratio = other.map(|(other, _)| other / seconds);
                    let cost = Cost { seconds, megabytes: memory(who) };
                    row(model.name, cells, threads, who, cost, triangles, ratio);
                }
                println!("{:24}sharp over smooth, in turn: {sharp_over_smooth:.2}", "");
                known.push((model.name, cells, threads, costs[0].0));
                // The same solids joined by R_p and by min and max.
                let twin = RFUNCTION_TWINS.iter().find(|(name, _)| *name == model.name).map(|(_, twin)| *twin);
                let of_twin = |&&(name, c, t, _): &&(_, _, _, f64)| (Some(name), c, t) == (twin, cells, threads);
                if let Some(&(name, .., seconds)) = known.iter().find(of_twin) {
                    println!("{:24}smooth over that of {name}: {:.2}", "", costs[0].0 / seconds);
                }
                if let Some((seconds, triangles)) = other {
                    let cost = Cost { seconds, megabytes: memory(FIDGET) };
                    row(model.name, cells, threads, FIDGET, cost, triangles, None);
                }
            }
        }
    }
}
