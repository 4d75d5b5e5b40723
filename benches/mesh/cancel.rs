//! How soon a cancelled run returns, and how evenly progress is told.

use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec3;
use rvachev::{
    AtBounds, Bounds, CellSize, MeshSettings, MinimalSurface, Progress, RFunction, Run, SheetLattice, Solid,
    ThinFeatures, rad,
};

/// The moments of a run when it is cancelled, and those that progress is compared at, as parts of
/// its time.
const MOMENTS: u32 = 40;

/// Prints the rows.
pub fn rows(threads: usize) {
    let gyroid = SheetLattice { surface: MinimalSurface::Gyroid, cell: 0.25, thickness: 0.03 };
    let ball = Solid::new(gyroid).intersection(Solid::sphere(1.0), RFunction::MIN_MAX);
    let settings = |cells| MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    let turned = Solid::cuboid(DVec3::ONE).rotate_x(rad(0.3));
    let fin = Solid::cuboid([0.02, 0.8, 1.6]).rotate_z(rad(0.4));
    let refine = MeshSettings { thin: ThinFeatures::Refine { halvings: 2 }, ..settings(256) };
    // Its faces are in those of the bounds: all vertices are looked at.
    let bounds = Some(Bounds::from_center(DVec3::ZERO, DVec3::splat(0.5)));
    let refuse = MeshSettings { bounds, at_bounds: AtBounds::Refuse, ..settings(1024) };
    let solids = [
        ("sphere", Solid::sphere(1.0), 2048, settings(2048)),
        ("cube less ball", &turned - Solid::sphere(0.6), 2048, settings(2048)),
        ("gyroid ball", ball.clone(), 512, settings(512)),
        ("fin, refined", turned | fin, 256, refine),
        ("cube, refused", Solid::cuboid(DVec3::ONE), 1024, refuse),
    ];
    for (name, solid, cells, settings) in solids {
        row(name, cells, threads, |run| solid.mesh_with(&settings, run).is_ok());
    }
    for (name, solid, cells) in [("sphere, check", Solid::sphere(1.0), 1024), ("gyroid, check", ball.clone(), 256)] {
        let mesh = solid.mesh(&settings(cells)).expect("a mesh");
        println!("{} triangles", mesh.triangles().len());
        row(name, cells, threads, |run| mesh.check_with(run).is_ok());
    }
    row("gyroid, thin", 256, threads, |run| ball.thin_features(&settings(256), run).is_ok());
}

/// Prints the row of a job, which tells whether it was done.
fn row(name: &str, cells: u32, threads: usize, job: impl Fn(&Run) -> bool) {
    let (whole, off) = run_whole(threads, &job);
    let late = |moment: u32| cancelled(threads, whole * moment / MOMENTS, &job);
    let mut late: Vec<f64> = (1..MOMENTS).filter_map(late).collect();
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

/// How long a run takes, and how far its progress is from the part of that time that has passed, at
/// most.
fn run_whole(threads: usize, job: impl Fn(&Run) -> bool) -> (Duration, f64) {
    let reports = Arc::new(Mutex::new(Vec::new()));
    let (sink, start) = (reports.clone(), Instant::now());
    let report = move |fraction| sink.lock().expect("no panic").push((start.elapsed(), fraction));
    let run = Run { threads, progress: Some(Progress::new(report)), ..Run::default() };
    assert!(job(&run), "nobody cancels");
    let whole = start.elapsed();
    let reports = reports.lock().expect("no panic");
    let off = |moment: u32| {
        let told = reports.iter().take_while(|(at, _)| *at <= whole * moment / MOMENTS).last();
        (told.map_or(0.0, |&(_, fraction)| fraction) - f64::from(moment) / f64::from(MOMENTS)).abs()
    };
    (whole, (1..MOMENTS).map(off).fold(0.0, f64::max))
}

/// How many seconds after its token is cancelled a run returns; `None` if it is done before.
fn cancelled(threads: usize, after: Duration, job: impl Fn(&Run) -> bool) -> Option<f64> {
    let run = Run { threads, ..Run::default() };
    let token = run.cancel.clone();
    let canceller = thread::spawn(move || {
        thread::sleep(after);
        token.cancel();
        Instant::now()
    });
    let is_done = job(&run);
    let end = Instant::now();
    let start = canceller.join().expect("no panic");
    (!is_done).then(|| end.saturating_duration_since(start).as_secs_f64())
}
