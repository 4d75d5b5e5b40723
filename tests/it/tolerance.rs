//! How exactly lengths are measured: asked for, reached, told, prepared.

use std::collections::hash_map::DefaultHasher;
use std::error::Error;
use std::hash::{BuildHasher, BuildHasherDefault};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec3;
use rvachev::{
    Accuracy, Blend, CancelToken, CellSize, MeshSettings, MinimalSurface, Profile, Progress, RFunction, Run,
    SheetLattice, Solid, SolidError, deg,
    error::{MeshingError, PrepareError},
    form::{Form, Length},
    rad,
};

use crate::support::Random;

type Outcome = Result<(), Box<dyn Error>>;

/// The half of an ellipsoid that is above a plane: it is convex, has an edge, and no exact value.
const SEMI_AXES: DVec3 = DVec3::new(3.0, 2.0, 1.5);

fn dome() -> Solid {
    Solid::ellipsoid(SEMI_AXES) & Solid::half_space(-DVec3::Z, 0.0)
}

/// A point of the dome's surface and a normal there, which on the edge is any between those of the
/// faces.
fn place(random: &mut Random) -> (DVec3, DVec3) {
    let mut unit = random.direction();
    unit.z = unit.z.abs();
    let on_ellipsoid = |unit: DVec3| (SEMI_AXES * unit, (unit / SEMI_AXES).normalize());
    match random.below(3) {
        0 => on_ellipsoid(unit),
        1 => (SEMI_AXES * DVec3::new(unit.x, unit.y, 0.0) * random.range(0.0, 1.0), -DVec3::Z),
        _ => {
            let (p, n) = on_ellipsoid(DVec3::new(unit.x, unit.y, 0.0).normalize());
            (p, n.lerp(-DVec3::Z, random.range(0.0, 1.0)).normalize())
        }
    }
}

/// How far an offset of the dome is off: the points that are so far from a convex solid along a
/// normal are known.
fn worst(solid: &Solid, distance: f64) -> Result<f64, SolidError> {
    let mut random = Random::new(7);
    let mut worst: f64 = 0.0;
    for _ in 0..4000 {
        let (p, n) = place(&mut random);
        worst = worst.max(solid.value(p + distance * n)?.abs());
    }
    Ok(worst)
}

/// A bar that is twisted: all lengths of it are measured.
fn bar() -> Solid {
    Solid::cuboid([2.0, 2.0, 6.0]).twist(rad(0.4))
}

/// Many bars, whose surface takes a second or more to measure to `tolerance`.
fn comb(tolerance: f64) -> Solid {
    let bars = (0..12).map(|n| bar().translate([f64::from(n) * 1.7, 0.0, 0.0]));
    Solid::union_all(bars, RFunction::MIN_MAX).offset(0.2).with_tolerance(tolerance)
}

const FINE: f64 = 1e-5;
const COARSE: f64 = 2e-3;

/// A run whose progress is kept.
fn recorded() -> (Arc<Mutex<Vec<f64>>>, Run) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = seen.clone();
    let progress = Progress::new(move |fraction| sink.lock().unwrap().push(fraction));
    (seen, Run { progress: Some(progress), ..Run::default() })
}

/// Cancels a run after some time from another thread, and says how long the job went on after that,
/// if it did.
fn lag<T>(run: &Run, after: Duration, job: impl FnOnce(&Run) -> T) -> (T, Option<Duration>) {
    let token = run.cancel.clone();
    let canceller = thread::spawn(move || {
        thread::sleep(after);
        let now = Instant::now();
        token.cancel();
        now
    });
    let result = job(run);
    let end = Instant::now();
    let cancelled = canceller.join().unwrap();
    (result, end.checked_duration_since(cancelled))
}

#[test]
fn a_finer_tolerance_is_reached() -> Outcome {
    let distance = 0.5;
    let mut found = Vec::new();
    for part in [1e-2, 1e-3, 1e-4, 1e-5] {
        let tolerance = part * distance;
        let start = Instant::now();
        let solid = dome().offset(distance).with_tolerance(tolerance);
        let Accuracy { tolerance: told, error, .. } = solid.accuracy()?;
        let time = start.elapsed();
        let off = worst(&solid, distance)?;
        println!("asked {tolerance:.1e}, told {told:.1e} and {error:.1e}, found {off:.1e} in {time:?}");
        assert!(told <= tolerance && off <= 1.2 * tolerance, "{tolerance}: {off}");
        found.push(off);
    }
    assert!(found.is_sorted_by(|a, b| a >= b) && found[3] < 0.1 * found[0]);
    Ok(())
}

#[test]
fn a_rounding_is_as_exact_as_its_ball() -> Outcome {
    // The edge of a rounded cylinder is a torus about a circle of radius 3.
    let rod = Solid::cylinder(5.0, 10.0);
    // Without a closed form for what the ball's centre may be.
    let grown = Solid::cylinder(5.0, 10.0).elongate([0.0; 3]);
    for (name, solid) in [("rod", rod), ("elongated", grown)] {
        for tolerance in [2e-2, 2e-4, 2e-5] {
            let solid = solid.rounded(2.0).with_tolerance(tolerance);
            let told = solid.accuracy()?;
            let mut random = Random::new(3);
            let mut worst: f64 = 0.0;
            for _ in 0..2000 {
                let (turn, tilt) = (deg(random.range(0.0, 360.0)).sin_cos(), deg(random.range(5.0, 85.0)).sin_cos());
                let r = 3.0 + 2.0 * tilt.1;
                let p = DVec3::new(r * turn.1, r * turn.0, 3.0 + 2.0 * tilt.0);
                worst = worst.max(solid.value(p)?.abs());
            }
            println!("{name}: asked {tolerance:.1e}, told {told:?}, found {worst:.1e}");
            // Fillets are smaller by what they may be off, and by a hundred-thousandth of the
            // radius.
            assert!(told.tolerance <= tolerance && worst <= 1.5 * tolerance + 2e-5, "{worst}");
        }
    }
    Ok(())
}

#[test]
fn a_coarser_tolerance_is_cheaper() -> Outcome {
    let time = |tolerance: f64| -> Result<Duration, SolidError> {
        let solid = comb(tolerance);
        let start = Instant::now();
        let accuracy = solid.accuracy()?;
        println!("{tolerance}: {accuracy:?} in {:?}", start.elapsed());
        Ok(start.elapsed())
    };
    let (coarse, fine) = (time(COARSE)?, time(FINE)?);
    assert!(2 * coarse < fine, "{coarse:?}, {fine:?}");
    Ok(())
}

#[test]
fn closed_forms_are_exact() -> Outcome {
    let cube = Solid::cuboid([2.0; 3]);
    let exact = Accuracy::default();
    assert_eq!(cube.accuracy()?, exact);
    assert_eq!(cube.offset(0.5).accuracy()?, exact);
    assert_eq!(cube.offset(0.5).with_tolerance(0.1).accuracy()?, exact);
    assert_eq!((cube.shell(0.5) | Solid::sphere(1.0)).accuracy()?, exact);
    assert_eq!(Profile::rectangle([2.0, 1.0]).offset(0.25).accuracy()?, exact);
    // What is measured is told in the units of the whole: the power of two below a thousandth.
    let half = f64::exp2(-11.0);
    assert_eq!(bar().offset(0.5).accuracy()?.tolerance, half);
    assert_eq!((bar().offset(0.5) | cube).scale(3.0).accuracy()?.tolerance, 3.0 * half);
    // An offset of an offset is no finer than what it is an offset of.
    let told = bar().offset(0.5).offset(-0.25).with_tolerance(1e-5).accuracy()?.tolerance;
    assert_eq!(told, 2.0 * half);
    Ok(())
}

#[test]
fn what_has_no_end_tells_its_tolerance() -> Outcome {
    let lattice = SheetLattice { surface: MinimalSurface::Gyroid, cell: 2.0, thickness: 0.3 };
    let told = Solid::from(lattice).offset(0.1).accuracy()?;
    assert_eq!((told.tolerance, told.error), (f64::exp2(-14.0), 0.0));
    let told = Solid::from(lattice).offset(0.1).with_tolerance(1e-3).accuracy()?;
    assert_eq!((told.tolerance, told.error), (1e-3, 0.0));
    let column = (Profile::superellipse([3.0, 2.0], 0.8)).offset(0.5).with_tolerance(1e-5);
    let told = column.accuracy()?;
    assert!(told.tolerance <= 1e-5 && told.tolerance > 0.0, "{told:?}");
    assert_eq!(column.extrude(2.0).accuracy()?, told);
    Ok(())
}

#[test]
fn a_ball_has_the_tolerance_of_its_fillet() -> Outcome {
    let cross = || bar().union_with(bar().rotate_x(deg(90.0)), Blend::Fillet { radius: 0.5 });
    for tolerance in [5e-3, 2e-4] {
        let told = cross().with_tolerance(tolerance).accuracy()?;
        println!("{told:?}");
        assert!(told.tolerance <= tolerance && told.tolerance > 0.2 * tolerance, "{told:?}");
    }
    let told = bar().union_with(Solid::sphere(1.5), Blend::Chamfer { leg: 0.05 }).with_tolerance(1e-3).accuracy()?;
    assert!(told.tolerance <= 1e-3 && told.tolerance > 0.0, "{told:?}");
    Ok(())
}

#[test]
fn on_anything_else_it_is_an_error() {
    let allowed = "1e-9 to 1e9, of a length or a blend; put it right behind offset, shell, rounded, filleted or a \
                   blend by fillet or chamfer";
    let cube = Solid::cuboid([2.0; 3]);
    let smooth = cube.smooth_union(Solid::sphere(1.2), 0.1);
    for solid in [
        cube.clone(),
        cube.level(0.1),
        &cube | Solid::sphere(1.2),
        smooth,
        cube.offset(0.1).named("lid"),
        cube.offset(0.1).translate([1.0, 0.0, 0.0]),
        cube.offset(0.1).with_tolerance(1e-3),
    ] {
        let error = solid.with_tolerance(1e-3).bounds().unwrap_err().to_string();
        assert_eq!(error, format!("with_tolerance: tolerance is 0.001, allowed: {allowed}"), "{solid:?}");
    }
    for tolerance in [0.0, -1.0, 1e-10, 1e10, f64::NAN, f64::INFINITY] {
        let part = Solid::sphere(1.0) - cube.offset(0.1).with_tolerance(tolerance).named("lid");
        let error = part.bounds().unwrap_err().to_string();
        let wanted = format!("difference[1] / lid: with_tolerance: tolerance is {tolerance}, allowed: 1e-9 to 1e9");
        assert_eq!(error, wanted);
    }
    // What is wrong below is told by the way to it.
    let error = Solid::sphere(-1.0).twist(rad(1.0)).shell(0.1).with_tolerance(1e-3).bounds().unwrap_err().to_string();
    assert!(error.starts_with("with_tolerance / shell / twist / sphere: radius is -1"), "{error}");
    let error = bar().offset(f64::NAN).with_tolerance(1e-3).bounds().unwrap_err().to_string();
    assert!(error.starts_with("with_tolerance / offset: distance is NaN"), "{error}");
}

#[test]
fn solids_of_other_tolerance_are_other_solids() {
    let cube = Solid::cuboid([2.0; 3]);
    let make = |tolerance: f64| cube.offset(0.5).with_tolerance(tolerance);
    assert_eq!(make(1e-3), make(1e-3));
    assert_ne!(make(1e-3), make(1e-4));
    assert_ne!(make(1e-3), cube.offset(0.5));
    let hash = |solid: &Solid| BuildHasherDefault::<DefaultHasher>::default().hash_one(solid);
    assert_eq!(hash(&make(1e-3)), hash(&make(1e-3)));
    assert_ne!(hash(&make(1e-3)), hash(&make(1e-4)));
    assert_eq!(make(1e-3).to_string(), "with_tolerance 0.001\n  offset by 0.5\n    box { size: DVec3(2.0, 2.0, 2.0) }");
    let solid = make(1e-3);
    let Form::Tolerance { operand, tolerance } = solid.form() else { panic!("{solid:?}") };
    assert!(
        tolerance == 1e-3 && matches!(operand.form(), Form::Length { length: Length::Offset(by), .. } if by == 0.5)
    );
    assert_eq!(solid.node_count(), 3);
}

#[test]
fn simplifying_keeps_the_tolerance() -> Outcome {
    let base = bar();
    let twice = base.translate([1.0, 0.0, 0.0]).translate([0.0, 1.0, 0.0]);
    for make in [
        |solid: &Solid| solid.offset(0.5),
        |solid: &Solid| solid.rounded(0.3),
        |solid: &Solid| solid.union_with(Solid::sphere(1.5), Blend::Fillet { radius: 0.2 }),
    ] {
        let simplified = make(&twice).with_tolerance(3e-4).simplified();
        assert_eq!(simplified, make(&base.translate([1.0, 1.0, 0.0])).with_tolerance(3e-4));
        assert_eq!(simplified.accuracy()?.tolerance, 3e-4);
    }
    Ok(())
}

#[test]
fn chains_of_tolerances_are_dropped_without_recursion() {
    let mut solid = Solid::sphere(1.0).offset(0.1);
    for _ in 0..100_000 {
        solid = solid.with_tolerance(1e-3).offset(0.1);
    }
    drop(solid);
}

#[test]
fn preparing_is_told_and_kept() -> Outcome {
    let solid = comb(COARSE) | bar().translate([0.0, 9.0, 0.0]).filleted(0.25);
    let (seen, run) = recorded();
    let accuracy = solid.prepare(&run)?;
    let told = seen.lock().unwrap().clone();
    println!("{} reports, {:?}", told.len(), told);
    assert!(told.windows(2).all(|pair| pair[0] < pair[1]), "{told:?}");
    assert!(told.len() > 10 && told[0] < 0.2 && told.last() == Some(&1.0), "{told:?}");
    assert_eq!(solid.accuracy()?, accuracy);
    seen.lock().unwrap().clear();
    let start = Instant::now();
    assert_eq!(solid.clone().prepare(&run)?, accuracy);
    assert!(start.elapsed() < Duration::from_millis(20), "{:?}", start.elapsed());
    assert_eq!(*seen.lock().unwrap(), [1.0]);
    // Whoever is prepared already is prepared for what is made of it.
    let start = Instant::now();
    solid.translate([1.0, 0.0, 0.0]).accuracy()?;
    assert!(start.elapsed() < Duration::from_millis(20), "{:?}", start.elapsed());
    Ok(())
}

#[test]
fn preparing_is_cancelled_at_once_and_may_be_done_again() -> Outcome {
    // Equal solids share their surfaces: none of another test is this one.
    let solid = comb(1.1 * FINE);
    let mut lags = Vec::new();
    for after in (1..9).map(|n| Duration::from_millis(70 * n)) {
        let (result, lag) = lag(&Run::default(), after, |run| solid.prepare(run));
        match result {
            Ok(_) => break,
            Err(error) => assert_eq!(error, PrepareError::Cancelled(rvachev::Cancelled)),
        }
        lags.extend(lag);
    }
    println!("{lags:?}");
    assert!(lags.len() >= 3, "{lags:?}");
    lags.sort();
    // Other tests run at the same time.
    assert!(lags[lags.len() / 2] < Duration::from_millis(50), "{lags:?}");
    assert!(solid.prepare(&Run::default())?.tolerance >= FINE);
    assert!(solid.contains([0.0, 0.0, 3.1])? && !solid.contains([0.0, 0.0, 3.3])?);
    let wrong = Solid::sphere(-1.0).offset(1.0);
    assert!(matches!(wrong.prepare(&Run::default()), Err(PrepareError::Solid(SolidError::Parameter { .. }))));
    assert!(Solid::sphere(1.0).offset(1.0).prepare(&Run { cancel: cancelled(), ..Run::default() }).is_err());
    Ok(())
}

fn cancelled() -> CancelToken {
    let token = CancelToken::new();
    token.cancel();
    token
}

#[test]
fn a_mesh_and_a_scene_are_cancelled_while_their_solid_is_measured() {
    // Equal solids share their surfaces: none of another test is this one.
    let solid = comb(1.2 * FINE);
    let settings = MeshSettings { cell: CellSize::LongestSide(64), ..MeshSettings::default() };
    let (seen, run) = recorded();
    let after = Duration::from_millis(300);
    let (result, lag_of_mesh) = lag(&run, after, |run| solid.mesh_with(&settings, run));
    assert_eq!(result, Err(MeshingError::Cancelled(rvachev::Cancelled)));
    let told = seen.lock().unwrap().clone();
    println!("{told:?}");
    assert!(!told.is_empty() && told.iter().all(|fraction| *fraction < 0.1), "{told:?}");
    let (seen, run) = recorded();
    let (result, lag_of_scene) = lag(&run, after, |run| solid.scene_with(run).map(|_| ()));
    assert!(result.unwrap_err().to_string().contains("cancelled"));
    let told = seen.lock().unwrap().clone();
    assert!(!told.is_empty() && told.windows(2).all(|pair| pair[0] < pair[1]), "{told:?}");
    println!("{lag_of_mesh:?}, {lag_of_scene:?}");
    assert!(lag_of_mesh.into_iter().chain(lag_of_scene).min() < Some(Duration::from_millis(100)));
}

#[test]
fn a_scene_goes_on_after_its_solid_is_measured() -> Outcome {
    let (seen, run) = recorded();
    bar().offset(0.3).scene_with(&run)?;
    let told = seen.lock().unwrap().clone();
    assert!(told.windows(2).all(|pair| pair[0] < pair[1]) && told.last() == Some(&1.0), "{told:?}");
    Ok(())
}

#[test]
fn the_finest_tolerance_is_told() -> Outcome {
    let solid = dome().offset(0.5).with_tolerance(1e-9);
    let start = Instant::now();
    let told = solid.accuracy()?;
    let off = worst(&solid, 0.5)?;
    println!("{told:?}, found {off:.1e} in {:?}", start.elapsed());
    // Patches are kept in single precision.
    let finest = 2e-7 * 2.0 * SEMI_AXES.x;
    assert!(told.tolerance <= 1.01 * finest && off <= 2.0 * finest, "{told:?}, {off}");
    Ok(())
}
