//! How meshing goes on: exact roots, even progress, quick cancelling, work in proportion.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use glam::{DQuat, DVec3};
use rvachev::{
    Bounds, CancelToken, CellSize, Features, Mesh, MeshSettings, ParamError, Progress, RFunction, Run, Solid,
    Superellipsoid, ThinFeatures,
    error::MeshingError,
    field::{Field, Real},
    volume::Lattice,
};

use crate::models;
use crate::support::Random;

fn settings(cell: CellSize) -> MeshSettings {
    MeshSettings { cell, features: Features::Smooth, ..MeshSettings::default() }
}

/// Checks that every vertex is on an edge of the lattice and within 10⁻⁶ of a cell or one f32 of
/// a change of sign along it, but for those that keep clear of a node; gives their number.
fn clamped(name: &str, solid: &Solid, cell: CellSize, mesh: &Mesh) -> usize {
    let lattice = Lattice::new(&solid.finite_bounds().unwrap(), cell).unwrap();
    let step = lattice.step();
    let program = solid.surface_program().unwrap();
    let mut clamped = 0;
    for &vertex in mesh.positions() {
        let at = (vertex.as_dvec3() - lattice.origin()) / step;
        let off = (at - at.round()).abs().to_array();
        let axis = (0..3).max_by(|&a, &b| off[a].total_cmp(&off[b])).unwrap();
        let across = (0..3).filter(|&other| other != axis).map(|other| off[other]).fold(0.0, f64::max);
        assert!(across * step <= 1e-6 * step, "{name}: {vertex} is on no edge");
        if off[axis] < 1.0 / 1024.0 + 1e-6 {
            clamped += 1;
            continue;
        }
        let c = vertex[axis];
        let by = f64::from((c.abs().next_up() - c.abs()).abs()).max(1e-6 * step);
        let mut along = DVec3::ZERO;
        along[axis] = by;
        let [below, above] = [vertex.as_dvec3() - along, vertex.as_dvec3() + along].map(|p| program.value(p));
        assert!((below > 0.0) != (above > 0.0), "{name}: {below:e} and {above:e} about {vertex}, step {step}");
    }
    clamped
}

#[test]
fn vertices_are_roots_to_a_millionth_of_a_cell() {
    let rotated =
        Solid::cuboid(DVec3::new(1.0, 1.3, 0.7)).rotate(DQuat::from_euler(glam::EulerRot::ZYX, 0.4, 0.9, 0.2));
    let pinched = Solid::superellipsoid(DVec3::new(1.0, 0.9, 0.8), 2.5, 0.4);
    let flat = Solid::superellipsoid(DVec3::ONE, 0.05, 0.05);
    let solids = [("cuboid", rotated), ("pinched", pinched), ("flat", flat)].map(|(name, solid)| (name, solid));
    let models = models::all().into_iter().filter(|model| model.name != "M5").map(|model| (model.name, model.solid));
    for (name, solid) in models.chain(solids) {
        for cells in [17, 70] {
            let cell = CellSize::LongestSide(cells);
            let mesh = solid.mesh(&settings(cell)).unwrap();
            let clamped = clamped(name, &solid, cell, &mesh);
            assert_eq!(mesh.check().clamped_vertices, Some(clamped), "{name}");
            println!("{name} at {cells}: {clamped} of {} vertices clamped", mesh.positions().len());
            assert!(clamped * 100 < mesh.positions().len(), "{name}: {clamped}");
        }
    }
}

#[test]
fn progress_is_even() {
    for model in [models::m1(), models::m4(), models::m6()] {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = seen.clone();
        let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
        model
            .solid
            .mesh_with(&settings(CellSize::LongestSide(100)), &Run { threads: 1, progress, ..Run::default() })
            .unwrap();
        let seen = seen.lock().unwrap();
        let longest = seen.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
        assert!(longest < 0.05, "{}: {longest}", model.name);
        assert_eq!(seen.last(), Some(&1.0));
    }
}

/// Evaluations of a union of two balls, one of them painted, between two reports: the most, and
/// all.
fn evaluations_between_reports(thin: ThinFeatures) -> (u64, u64) {
    let count = Arc::new(AtomicU64::new(0));
    let ball = Solid::new(Counting(count.clone()));
    let solid = ball.clone().paint([200, 0, 0]) | ball.translate(DVec3::new(0.7, 0.0, 0.0));
    let last = Arc::new(AtomicU64::new(0));
    let longest = Arc::new(AtomicU64::new(0));
    let (counted, before, most) = (count.clone(), last.clone(), longest.clone());
    let progress = Progress::new(move |_| {
        let now = counted.load(Ordering::Relaxed);
        most.fetch_max(now - before.swap(now, Ordering::Relaxed), Ordering::Relaxed);
    });
    let settings = MeshSettings { cell: CellSize::LongestSide(100), thin, ..MeshSettings::default() };
    solid.mesh_with(&settings, &Run { threads: 1, progress: Some(progress), ..Run::default() }).unwrap();
    let all = count.load(Ordering::Relaxed);
    (longest.load(Ordering::Relaxed).max(all - last.load(Ordering::Relaxed)), all)
}

#[test]
fn counting_thin_cells_and_painting_tell_how_far_they_are() {
    for thin in [ThinFeatures::Ignore, ThinFeatures::Count, ThinFeatures::Refine { halvings: 1 }] {
        let (longest, all) = evaluations_between_reports(thin);
        println!("{thin:?}: {longest} of {all}");
        assert!(longest * 20 < all, "{thin:?}: {longest} of {all}");
    }
}

/// A ball that counts how often it is evaluated, points and vectors of them alike.
#[derive(Clone, Debug)]
struct Counting(Arc<AtomicU64>);

impl Field for Counting {
    fn name(&self) -> &'static str {
        "counting"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        self.0.fetch_add(1, Ordering::Relaxed);
        -((x * x + y * y + z * z).sqrt() + -1.0)
    }

    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::ONE)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

#[test]
fn cancelling_is_noticed_within_a_few_blocks() {
    let count = Arc::new(AtomicU64::new(0));
    let ball = Solid::new(Counting(count.clone()));
    let cell = settings(CellSize::LongestSide(200));
    ball.mesh_with(&cell, &Run { threads: 1, ..Run::default() }).unwrap();
    let all = count.load(Ordering::Relaxed);
    for at in [0.02, 0.2, 0.35, 0.6, 0.85, 0.95] {
        let cancel = CancelToken::new();
        let after = Arc::new(AtomicU64::new(0));
        let (token, start, counted) = (cancel.clone(), after.clone(), count.clone());
        let progress = Progress::new(move |fraction| {
            if fraction >= at && !token.is_cancelled() {
                token.cancel();
                start.store(counted.load(Ordering::Relaxed), Ordering::Relaxed);
            }
        });
        let run = Run { threads: 1, cancel, progress: Some(progress) };
        assert_eq!(ball.mesh_with(&cell, &run).unwrap_err(), MeshingError::Cancelled(rvachev::Cancelled));
        let more = count.load(Ordering::Relaxed) - after.load(Ordering::Relaxed);
        // A batch of 256 blocks has 10 000 evaluations of vectors, a hundredth of a second or so.
        assert!(more < 20_000 && more < all / 10, "{more} of {all} evaluations after cancelling at {at}");
    }
}

/// How many leaves stay in the surface blocks of a crowd of parts.
#[test]
fn many_parts_cost_what_is_near() {
    let crowd = |count: usize| {
        let mut random = Random::new(5);
        let size = 0.5 * (1.0 / count as f64).cbrt();
        let part = |_| {
            let axes = random.vector(0.5, 1.5) * size;
            let leaf = Superellipsoid::new(axes, random.range(0.2, 1.8), random.range(0.2, 1.8));
            Solid::from(leaf).rotate(random.rotation()).translate(random.vector(0.0, 1.0))
        };
        let parts: Vec<Solid> = (0..count).map(part).collect();
        Solid::union_all(parts, RFunction::MIN_MAX)
    };
    // The same cells to a part: the mesh of more parts has more cells, and each takes as long.
    for (count, cells) in [(100, 40), (3000, 120)] {
        let mesh = crowd(count).mesh(&settings(CellSize::LongestSide(cells))).unwrap();
        let report = mesh.check();
        assert!(report.is_closed() && report.is_manifold(), "{count}: {report:?}");
    }
}
