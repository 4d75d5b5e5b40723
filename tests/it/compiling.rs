//! Compiling: how far it is, cancelling, what is worked out once.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use glam::DVec2;
use rvachev::{
    Bounds, CancelToken, Cancelled, Gielis, Interval, ParamError, Profile, Progress, RFunction, Run, Solid, Supershape,
    error::PrepareError,
    field::{Field, Real},
    rad,
};

/// A run that notes reports, and is cancelled once one is above `end`.
fn noted(end: f64) -> (Arc<Mutex<Vec<f64>>>, Run) {
    let noted = Arc::new(Mutex::new(Vec::new()));
    let (sink, cancel) = (noted.clone(), CancelToken::new());
    let token = cancel.clone();
    let progress = Progress::new(move |fraction| {
        sink.lock().unwrap().push(fraction);
        if fraction > end {
            token.cancel();
        }
    });
    (noted, Run { cancel, progress: Some(progress), ..Run::default() })
}

const CANCELLED: PrepareError = PrepareError::Cancelled(Cancelled);

fn pile(count: u32) -> Solid {
    let at = |i: u32| [f64::from(i % 20), f64::from(i / 20 % 20), f64::from(i / 400)];
    Solid::union_all((0..count).map(|i| Solid::sphere(0.4).translate(at(i))), RFunction::MIN_MAX)
}

/// A star whose rays are long and thin.
fn star(count: usize) -> Profile {
    let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { 900.0 + (i % 101) as f64 };
    Profile::polygon((0..count).map(|i| radius(i) * DVec2::from_angle(std::f64::consts::TAU * i as f64 / count as f64)))
}

#[test]
fn compiling_tells_how_far_it_is_and_is_cancelled_on_the_way() {
    for (name, make) in [("pile", (|| pile(4000)) as fn() -> Solid), ("star", || star(40_000).extrude(1.0))] {
        let (whole, run) = noted(f64::INFINITY);
        make().prepare(&run).unwrap();
        let whole = whole.lock().unwrap();
        assert!(whole.len() > 20 && whole.last() == Some(&1.0), "{name}: {} reports", whole.len());
        let solid = make();
        let at = whole[whole.len() / 3];
        let (part, run) = noted(at);
        assert_eq!(solid.prepare(&run), Err(CANCELLED), "{name}");
        let last = part.lock().unwrap().last().copied().unwrap();
        assert!(last < at + 0.1, "{name}: cancelled after {at}, and went on to {last}");
        // It may be asked again.
        assert!(solid.prepare(&Run::default()).is_ok() && solid.contains([0.1, 0.1, 0.1]).is_ok());
    }
}

/// A ball that is worked out for long.
#[derive(Debug, Default)]
struct Slow(Arc<AtomicUsize>);

impl Field for Slow {
    fn name(&self) -> &'static str {
        "slow ball"
    }

    fn prepare(&self, run: &Run) -> Result<(), Cancelled> {
        run.check()?;
        self.0.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        -(x.square() + y.square() + z.square()).sqrt() + 1.0
    }

    fn bounds(&self) -> Bounds {
        assert!(self.0.load(Ordering::Relaxed) > 0, "asked before it was prepared");
        Bounds::new([-1.0; 3], [1.0; 3])
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
}

#[test]
fn leaves_are_prepared_before_they_are_asked() {
    let slow = Slow::default();
    let count = slow.0.clone();
    let ball = Solid::new(slow);
    let solid = ball.translate([3.0, 0.0, 0.0]) | &ball;
    let run = Run::default();
    run.cancel.cancel();
    assert_eq!(solid.prepare(&run), Err(CANCELLED));
    assert_eq!(count.load(Ordering::Relaxed), 0);
    assert!(solid.contains([3.5, 0.0, 0.0]).unwrap());
    assert_eq!(count.load(Ordering::Relaxed), 1);
}

#[test]
fn a_part_that_moves_itself_at_every_level_is_compiled_copy_by_copy() {
    let mut copies = Solid::sphere(0.4);
    for level in 0..14 {
        copies = copies.translate([f64::from(1 << level), 0.0, 0.0]) | copies;
    }
    let bounds = copies.bounds().unwrap();
    assert!((bounds.max.x - 16_383.4).abs() < 1e-9 && (bounds.min.x + 0.4).abs() < 1e-9, "{bounds:?}");
    assert_eq!(copies.surface_program().unwrap().leaf_count(), 1 << 14);
}

#[test]
fn shapes_that_share_their_curves_are_equal_whether_used_or_not() {
    let shape = |n| Supershape::new(Gielis::polygon(n, 60.0), Gielis::polygon(4, 60.0));
    let used = shape(6);
    assert!(Solid::from(used.clone()).contains([0.1, 0.1, 0.1]).unwrap());
    assert_eq!(used, shape(6));
    assert_ne!(used, shape(5));
    assert_eq!(Solid::from(used), Solid::from(shape(6)));
}

/// A ball that counts how often it is asked for a range.
#[derive(Debug, Default)]
struct Asked(Arc<AtomicUsize>);

impl Field for Asked {
    fn name(&self) -> &'static str {
        "asked ball"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        -(x.square() + y.square() + z.square()).sqrt() + 1.0
    }

    fn bounds(&self) -> Bounds {
        Bounds::new([-1.0; 3], [1.0; 3])
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        self.0.fetch_add(1, Ordering::Relaxed);
        self.eval(region)
    }
}

/// A level has the box that is found by asking, and each question to many copies takes long.
#[test]
fn the_box_of_many_copies_takes_few_questions_and_tells_how_far_it_is() {
    let make = |asked: Asked| {
        let part = Solid::new(asked).intersection(Solid::cuboid([1.5; 3]), RFunction::Alpha(-0.9));
        let copies = part.rotate_x(rad(0.4)).repeat([4; 3], [3.6; 3]).level(0.2);
        copies.rotate_y(rad(-0.5)).repeat([4; 3], [3.7, 1.6, 1.7]).level(0.2).rotate_x(rad(0.4))
    };
    let asked = Asked::default();
    let count = asked.0.clone();
    let (reports, run) = noted(f64::INFINITY);
    make(asked).prepare(&run).unwrap();
    let (count, reports) = (count.load(Ordering::Relaxed), reports.lock().unwrap());
    let late = reports.iter().filter(|at| **at > 0.7).count();
    println!("{count} questions, {} reports, {late} of them late", reports.len());
    assert!(count < 400_000, "{count} questions");
    assert!(late > 5 && reports.is_sorted(), "{reports:?}");
    let asked = Asked::default();
    let early = asked.0.clone();
    let (_, run) = noted(0.75);
    assert_eq!(make(asked).prepare(&run), Err(CANCELLED));
    let early = early.load(Ordering::Relaxed);
    assert!(4 * early < 3 * count, "cancelled after {early} questions of {count}");
}
