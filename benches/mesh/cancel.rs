//! How soon a cancelled run returns, and how evenly progress is told.

use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec3;
use rvachev::{CellSize, MeshSettings, MinimalSurface, Progress, RFunction, Run, SheetLattice, Solid};

/// The moments of a run when it is cancelled, and those that progress is compared at, as parts of its time.
const MOMENTS: u32 = 40;

/// Prints the rows.
pub fn rows(threads: usize) {
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.25, thickness: 0.03 };
    let solids = [
        ("sphere", Solid::sphere(1.0), 2048),
        ("cube less ball", Solid::cuboid(DVec3::ONE).rotate_x(0.3) - Solid::sphere(0.6), 2048),
        ("gyroid ball", Solid::new(gyroid).intersection(Solid::sphere(1.0), RFunction::MIN_MAX), 512),
    ];
    for (name, solid, cells) in solids {
        let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
        let (whole, off) = run_whole(&solid, &settings, threads);
        let mut late: Vec<f64> =
            (1..MOMENTS).filter_map(|moment| cancelled(&solid, &settings, threads, whole * moment / MOMENTS)).collect();
        late.sort_by(f64::total_cmp);
        println!(
            "{name:14} {cells:4}³ {threads} {:.3} s; progress is off by {:.0} % at most; \
             cancelled at {} moments it returns after {:.1} ms, {:.1} ms at most",
            whole.as_secs_f64(),
            100.0 * off,
            late.len(),
            1e3 * late[late.len() / 2],
            1e3 * late[late.len() - 1]
        );
    }
}

/// How long a run takes, and how far its progress is from the part of that time that has passed, at most.
fn run_whole(solid: &Solid, settings: &MeshSettings, threads: usize) -> (Duration, f64) {
    let reports = Arc::new(Mutex::new(Vec::new()));
    let (sink, start) = (reports.clone(), Instant::now());
    let report = move |fraction| sink.lock().expect("no panic").push((start.elapsed(), fraction));
    let run = Run { threads, progress: Some(Progress::new(report)), ..Run::default() };
    let _mesh = solid.mesh_with(settings, &run).expect("a mesh");
    let whole = start.elapsed();
    let reports = reports.lock().expect("no panic");
    let off = |moment: u32| {
        let told = reports.iter().take_while(|(at, _)| *at <= whole * moment / MOMENTS).last();
        (told.map_or(0.0, |&(_, fraction)| fraction) - f64::from(moment) / f64::from(MOMENTS)).abs()
    };
    (whole, (1..MOMENTS).map(off).fold(0.0, f64::max))
}

/// How many seconds after its token is cancelled a run returns; `None` if it is done before.
fn cancelled(solid: &Solid, settings: &MeshSettings, threads: usize, after: Duration) -> Option<f64> {
    let run = Run { threads, ..Run::default() };
    let token = run.cancel.clone();
    let canceller = thread::spawn(move || {
        thread::sleep(after);
        token.cancel();
        Instant::now()
    });
    let result = solid.mesh_with(settings, &run);
    let end = Instant::now();
    let start = canceller.join().expect("no panic");
    result.is_err().then(|| end.saturating_duration_since(start).as_secs_f64())
}
