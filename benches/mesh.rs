//! temporary
#[path = "../tests/it/models.rs"]
mod models;

fn cpu() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    text.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-9
}
use rvachev::{CellSize, MeshSettings, Run};
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let pick = |name: &str| args.iter().all(|a| !a.starts_with('M')) || args.iter().any(|a| a == name);
    let sizes: Vec<u32> = args.iter().filter_map(|a| a.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![64, 128, 256] } else { sizes };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for model in models::all() {
        if !pick(model.name) { continue; }
        for &n in &sizes {
            let settings = MeshSettings { cell: CellSize::Length(2.0 * model.half / f64::from(n)), bounds: Some(model.cube()), ..MeshSettings::default() };
            let run = Run { threads: 1, ..Run::default() };
            let mut best = f64::INFINITY;
            let mut tri = 0;
            let reps = if args.iter().any(|a| a == "once") { 1 } else { 7 };
            for _ in 0..reps {
                let (spent, mesh) = pool.install(|| {
                    let t = cpu();
                    let mesh = model.solid.mesh_with(&settings, &run).unwrap();
                    (cpu() - t, mesh)
                });
                best = best.min(spent);
                tri = mesh.triangles().len();
            }
            println!("{} {n}: {:.4} s, {tri} triangles", model.name, best);
        }
    }
}
