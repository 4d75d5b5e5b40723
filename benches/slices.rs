//! Contours of slices beside meshes of the same solid, one thread, compiling included.
//!
//! `cargo bench --bench slices` prints, for solids of each kind, the milliseconds that the contours
//! of one plane take, what they are, and their ratio to a mesh in cells of a 128th of the longest
//! side; then a stack of planes beside the same planes one by one. Times are CPU times of the
//! thread, medians of rounds in which the contestants take turns. Words after `--` choose rows by
//! parts of their names.

use std::f64::consts::TAU;

use cpu_time::ThreadTime;
use rvachev::{
    Blend, CellSize, ContourSettings, Gielis, MeshSettings, MinimalSurface, Plane, Profile, Run, SheetLattice, Solid,
    Supershape, rad,
};

/// Rounds of which the median is taken.
const ROUNDS: usize = 5;

/// A solid, the height of the plane, and the tolerance.
type Row = (&'static str, fn() -> Solid, f64, f64);

fn gear() -> Solid {
    let tooth = |i: u32| {
        let angle = TAU * f64::from(i) / 2000.0;
        let radius = 1.0 + 0.15 * (40.0 * angle).sin();
        [radius * angle.cos(), radius * angle.sin()]
    };
    Profile::polygon((0..2000).map(tooth).collect::<Vec<_>>()).extrude(0.5)
}

fn plate() -> Solid {
    let holes = Solid::cylinder(1.5, 20.0).repeat([58, 38, 1], [10.0, 10.0, 1.0]);
    Solid::cuboid([600.0, 400.0, 2.0]) - holes.translate([-285.0, -185.0, 0.0])
}

fn gyroid() -> Solid {
    Solid::from(SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: 0.1 }) & Solid::sphere(5.0)
}

fn supershape() -> Solid {
    let waves = Gielis::new(6.0, 1.0, 1.7, 1.7);
    Supershape::new(waves, waves).into()
}

fn block() -> Solid {
    Solid::cuboid([20.0, 14.0, 8.0]) | Solid::cylinder(5.0, 14.0)
}

fn post(blend: Blend) -> Solid {
    Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::cylinder(0.5, 2.0), blend)
}

fn curved(blend: Blend) -> Solid {
    Solid::cuboid([2.0, 2.0, 0.4]).union_with(Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7), blend)
}

/// A plate with many holes, all of it by true distance.
fn pins() -> Solid {
    let holes = Solid::cylinder(0.3, 4.0).repeat([10, 8, 1], [1.5, 1.5, 1.0]);
    (Solid::cuboid([20.0, 14.0, 2.0]) - holes).offset(0.1)
}

const ROWS: [Row; 17] = [
    ("perforated plate", plate, 0.0, 0.01),
    ("polygon of 2000 edges", gear, 0.1, 1e-4),
    ("superellipsoid", || Solid::superellipsoid([30.0, 20.0, 10.0], 0.3, 0.4), 0.1, 1e-3),
    ("twisted superellipsoid", || Solid::superellipsoid([30.0, 20.0, 40.0], 0.3, 0.4).twist(rad(0.02)), 0.1, 1e-3),
    ("supershape", supershape, 0.1, 1e-3),
    ("gyroid in a ball", gyroid, 0.1, 1e-3),
    ("flush joint", block, 4.0, 1e-3),
    ("smooth joint", || post(Blend::Smooth { radius: 0.15 }), 0.25, 1e-4),
    ("fillet", || post(Blend::Fillet { radius: 0.15 }), 0.25, 1e-4),
    ("chamfer", || post(Blend::Chamfer { leg: 0.15 }), 0.25, 1e-4),
    ("shell", || block().shell(1.0), 0.5, 1e-3),
    ("shell of a curved one", || Solid::superellipsoid([30.0, 20.0, 10.0], 0.3, 0.4).shell(1.0), 0.1, 1e-3),
    ("rounded", || block().rounded(1.0), 0.5, 1e-3),
    ("filleted", || block().filleted(1.0), 0.5, 1e-3),
    ("pins moved out", pins, 0.5, 1e-3),
    ("joint of a curved one", || curved(Blend::Fillet { radius: 0.15 }), 0.25, 1e-4),
    ("chamfer of a curved one", || curved(Blend::Chamfer { leg: 0.15 }), 0.25, 1e-4),
];

/// CPU milliseconds of a job.
fn timed<T>(job: impl FnOnce() -> T) -> (f64, T) {
    let start = ThreadTime::now();
    let result = job();
    (start.elapsed().as_secs_f64() * 1e3, result)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    let run = Run { threads: 1, ..Run::default() };
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global()?;
    println!("{:24} {:>9} {:>6} {:>7} {:>10} {:>7}", "", "slice ms", "lines", "points", "undecided", "/ mesh");
    for (name, make, height, tolerance) in ROWS.into_iter().filter(|(name, ..)| is_asked(name)) {
        let (mut slices, mut meshes) = (Vec::new(), Vec::new());
        let mut last = None;
        for _ in 0..ROUNDS {
            let (time, contours) = timed(|| make().slice(&Plane::xy(height))?.contours(tolerance));
            slices.push(time);
            last = Some(contours?);
            let settings = MeshSettings { cell: CellSize::LongestSide(128), ..MeshSettings::default() };
            let (time, mesh) = timed(|| make().mesh_with(&settings, &run));
            meshes.push(time);
            mesh?;
        }
        let Some(contours) = last else { continue };
        let points: usize = contours.iter().map(|line| line.points().len()).sum();
        let (slice, mesh) = (median(slices), median(meshes));
        let lines = contours.len();
        println!("{name:24} {slice:9.2} {lines:6} {points:7} {:10} {:7.2}", contours.unresolved(), slice / mesh);
    }
    if is_asked("stack") {
        let heights: Vec<f64> = (0..200).map(|layer| -3.98 + 0.04 * f64::from(layer)).collect();
        let part = block() - Solid::sphere(4.0).translate([6.0, 3.0, 2.0]);
        let settings = ContourSettings::default();
        let (mut together, mut apart) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let (time, layers) = timed(|| part.slices(&heights, &settings, &run));
            together.push(time);
            layers?;
            let each = |height: &f64| part.slice(&Plane::xy(*height))?.contours_with(&settings, &run);
            let (time, layers) = timed(|| heights.iter().map(each).collect::<Result<Vec<_>, _>>());
            apart.push(time);
            layers?;
        }
        let (together, apart) = (median(together), median(apart));
        println!("stack of 200: {together:.1} ms, one by one {apart:.1} ms, {:.2} of it", together / apart);
    }
    Ok(())
}
