//! Questions about many points: the answers of one each, progress, cancelling on the way.

use std::fmt::Debug;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use glam::DVec3;
use rvachev::{
    Bounds, CancelToken, Cancelled, CellSize, MeshSettings, Paint, ParamError, Plane, PlaneBounds, Profile, Progress,
    Run, SliceSettings, Solid,
    error::{PrepareError, RenderError},
    field::{Field, Real},
    rad,
};

use crate::support::Random;

/// A ball that counts what it is asked; its value is no distance.
#[derive(Clone, Debug, Default)]
struct Counting(Arc<AtomicUsize>);

impl Field for Counting {
    fn name(&self) -> &'static str {
        "counting"
    }

    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        self.0.fetch_add(1, Ordering::Relaxed);
        (x.square() + y.square() + z.square()) * -1.0 + 1.0
    }

    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::ONE)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

/// What is asked: the solid, points about it, and a run.
type Question = fn(&Solid, &[DVec3], &Run) -> Result<String, String>;

fn told(result: Result<impl Debug, impl Debug>) -> Result<String, String> {
    result.map(|answer| format!("{answer:?}")).map_err(|error| format!("{error:?}"))
}

fn boxes(points: &[DVec3]) -> Vec<Bounds> {
    points.iter().map(|p| Bounds::from_center(*p, DVec3::splat(0.1))).collect()
}

fn rays(points: &[DVec3]) -> Vec<(DVec3, DVec3)> {
    points.iter().map(|p| (*p, -p.normalize())).collect()
}

const REGION: PlaneBounds = PlaneBounds { min: glam::DVec2::splat(-1.5), max: glam::DVec2::splat(1.5) };

fn picture() -> SliceSettings {
    SliceSettings { width: 200, ..SliceSettings::default() }
}

const QUESTIONS: [(&str, Question); 9] = [
    ("values", |solid, points, run| told(solid.values_with(points, run))),
    ("contains", |solid, points, run| told(solid.contains_all_with(points, run))),
    ("gradients", |solid, points, run| told(solid.gradients_with(points, run))),
    ("ranges", |solid, points, run| told(solid.ranges_with(&boxes(points), run))),
    ("owners", |solid, points, run| told(solid.owners_with(points, run))),
    ("rays", |solid, points, run| told(solid.raycast_all_with(&rays(points), run))),
    ("closest", |solid, points, run| told(solid.closest_surface_points_with(points, run))),
    ("values of a slice", |solid, _, run| {
        let slice = solid.slice_within(&Plane::xy(0.1), REGION).unwrap();
        told(slice.values_with(200, run).map(|image| image.pixels().to_vec()))
    }),
    ("picture of a slice", |solid, _, run| {
        let slice = solid.slice_within(&Plane::xy(0.1), REGION).unwrap();
        told(slice.picture_with(&picture(), run).map(|image| image.pixels().to_vec()))
    }),
];

fn points(count: usize) -> Vec<DVec3> {
    let mut random = Random::new(1510);
    (0..count).map(|_| random.vector(-1.5, 1.5)).collect()
}

#[test]
fn many_answers_are_those_of_one_each() {
    let bar = Solid::superellipsoid([1.0, 0.8, 2.0], 0.4, 0.6).twist(rad(0.3));
    let points = points(40);
    let one = |at: usize| -> Result<String, String> {
        let each = |ask: &dyn Fn(DVec3) -> String| {
            Ok(format!("[{}]", points.iter().map(|p| ask(*p)).collect::<Vec<_>>().join(", ")))
        };
        match at {
            1 => each(&|p| format!("{:?}", bar.contains(p).unwrap())),
            2 => each(&|p| format!("{:?}", bar.gradient(p).unwrap())),
            3 => each(&|p| format!("{:?}", bar.range(&boxes(&[p])[0]).unwrap())),
            4 => each(&|p| format!("{:?}", bar.owner(p).unwrap())),
            5 => each(&|p| format!("{:?}", bar.raycast(p, -p.normalize()).unwrap())),
            6 => each(&|p| format!("{:?}", bar.closest_surface_point(p).unwrap())),
            _ => unreachable!(),
        }
    };
    let two = Run { threads: 2, ..Run::default() };
    for (at, (name, ask)) in QUESTIONS.iter().enumerate() {
        let answers = ask(&bar, &points, &two);
        if (1..7).contains(&at) {
            assert_eq!(answers, one(at), "{name}");
        }
        assert_eq!(answers, ask(&bar, &points, &Run { threads: 1, ..Run::default() }), "{name}");
    }
    for (p, value) in points.iter().zip(bar.values(&points).unwrap()) {
        assert!((value - bar.value(*p).unwrap()).abs() < 1e-12, "{p}");
    }
    let slice = bar.slice_with(&Plane::xy(0.1), Some(REGION), &two).unwrap();
    assert_eq!(slice.values(50).unwrap(), slice.values_with(50, &two).unwrap());
    assert!((slice.values(50).unwrap().pixels()[0] - bar.value([-1.47, 1.47, 0.1]).unwrap()).abs() < 1e-12);
    assert_eq!(slice.picture(&picture()).unwrap(), slice.picture_with(&picture(), &two).unwrap());
    let column = Profile::circle(1.0).column();
    let error = column.closest_surface_points_with(&points, &two).unwrap_err();
    assert_eq!(error, PrepareError::Solid(column.closest_surface_points(&points).unwrap_err()));
    let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate([5.0, 0.0, 0.0]);
    assert_eq!(nothing.closest_surface_points(&points[..2]).unwrap(), [None, None]);
    let (circle, flat): (_, Vec<_>) = (Profile::circle(1.0), points.iter().map(|p| p.truncate()).collect());
    assert_eq!(circle.values_with(&flat, &two).unwrap(), circle.values(&flat).unwrap());
    assert_eq!(circle.contains_all_with(&flat, &two).unwrap(), circle.contains_all(&flat).unwrap());
    assert_eq!(circle.gradients_with(&flat, &two).unwrap(), circle.gradients(&flat).unwrap());
}

#[test]
fn many_questions_tell_how_far_they_are_and_stop_when_they_are_told() {
    let count = Arc::new(AtomicUsize::new(0));
    let ball = Solid::new(Counting(count.clone()));
    let points = points(2000);
    // What is measured for closest points is told by other tests.
    ball.closest_surface_point([0.5, 0.0, 0.0]).unwrap();
    for (name, ask) in QUESTIONS {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = seen.clone();
        let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
        ask(&ball, &points, &Run { threads: 2, progress, ..Run::default() }).unwrap();
        {
            let seen = seen.lock().unwrap();
            let widest = seen.windows(2).map(|pair| pair[1] - pair[0]).fold(seen[0], f64::max);
            assert!(seen.is_sorted() && seen.last() == Some(&1.0) && seen.len() >= 9, "{name}: {seen:?}");
            // Closest points are not known to need no surface before they are asked.
            assert!(widest < if name == "closest" { 0.61 } else { 0.21 }, "{name}: {seen:?}");
        }
        let (cancel, after) = (CancelToken::new(), Arc::new(AtomicUsize::new(0)));
        let (token, start, counted) = (cancel.clone(), after.clone(), count.clone());
        let progress = Progress::new(move |fraction| {
            if fraction >= 0.65 && !token.is_cancelled() {
                token.cancel();
                start.store(counted.load(Ordering::Relaxed), Ordering::Relaxed);
            }
        });
        let error = ask(&ball, &points, &Run { threads: 1, cancel, progress: Some(progress) }).unwrap_err();
        assert!(error.contains("Cancelled"), "{name}: {error}");
        let more = count.load(Ordering::Relaxed) - after.load(Ordering::Relaxed);
        assert!(more < 2000, "{name}: {more} evaluations after cancelling");
    }
}

#[test]
fn painting_and_slicing_take_a_run() {
    let part = Solid::cuboid([2.0; 3]) - Solid::cylinder(0.5, 4.0).paint([200, 0, 0]);
    let mesh = part.mesh(&MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() }).unwrap();
    let white = Paint::from([250, 250, 250]);
    let bare = rvachev::Mesh::new(mesh.positions().to_vec(), mesh.triangles().to_vec()).unwrap();
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = seen.clone();
    let progress = Some(Progress::new(move |fraction| sink.lock().unwrap().push(fraction)));
    let painted = bare.clone().painted_with(&part, white, &Run { threads: 2, progress, ..Run::default() }).unwrap();
    assert_eq!(painted, bare.clone().painted(&part, white).unwrap());
    let seen = seen.lock().unwrap();
    assert!(seen.is_sorted() && seen.last() == Some(&1.0) && seen.len() > 20, "{seen:?}");
    let run = Run::default();
    run.cancel.cancel();
    let fresh = || Solid::sphere(1.0).twist(rad(0.1)).shell(0.1);
    assert_eq!(bare.painted_with(&fresh(), white, &run), Err(PrepareError::Cancelled(Cancelled)));
    let cancelled = fresh().slice_with(&Plane::xy(0.0), None, &run);
    assert!(matches!(cancelled, Err(RenderError::Cancelled(_))));
}
