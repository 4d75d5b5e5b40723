//! How exactly lengths are measured: asked for, reached, told, prepared.

use std::error::Error;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use glam::DVec3;
use rvachev::{
    Accuracy, Blend, CancelToken, CellSize, MeshSettings, MinimalSurface, Profile, Progress, RFunction, Run, SheetLattice,
    Solid, SolidError, deg,
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

/// A point of the dome's surface and a normal there, which on the edge is any between those of the faces.
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

/// How far an offset of the dome is off: the points that are so far from a convex solid along a normal are known.
fn worst(solid: &Solid, distance: f64) -> Result<f64, SolidError> {
    let mut random = Random::new(7);
    let mut worst: f64 = 0.0;
    for _ in 0..4000 {
        let (p, n) = place(&mut random);
        worst = worst.max(solid.value(p + distance * n)?.abs());
    }
    Ok(worst)
}

#[test]
fn a_finer_tolerance_is_reached() -> Outcome {
    let distance = 0.5;
    let mut before = f64::INFINITY;
    for part in [1e-2, 1e-3, 1e-4, 1e-5] {
        let tolerance = part * distance;
        let start = Instant::now();
        let solid = dome().offset(distance).with_tolerance(tolerance);
        let Accuracy { tolerance: told, error, .. } = solid.accuracy()?;
        let time = start.elapsed();
        let off = worst(&solid, distance)?;
        println!("asked {tolerance:.1e}, told {told:.1e} and {error:.1e}, found {off:.1e} in {time:?}");
        assert!(told <= tolerance && off <= 1.5 * tolerance && off < before, "{tolerance}: {off}");
        before = off;
    }
    Ok(())
}

#[test]
fn print_costs() -> Outcome {
    let bar = || Solid::cuboid([2.0, 2.0, 6.0]).twist(rad(0.4));
    let comb = || Solid::union_all((0..30).map(|n| bar().translate([f64::from(n) * 1.7, 0.0, 0.0])), RFunction::MIN_MAX);
    for (name, solid) in [
        ("bar 1e-2", bar().offset(0.5).with_tolerance(5e-3)),
        ("bar 1e-3", bar().offset(0.5)),
        ("bar 1e-4", bar().offset(0.5).with_tolerance(5e-5)),
        ("bar 1e-5", bar().offset(0.5).with_tolerance(5e-6)),
        ("comb", comb().offset(0.2)),
        ("comb fine", comb().offset(0.2).with_tolerance(2e-5)),
        ("bar filleted", bar().union_with(bar().rotate_x(deg(90.0)), Blend::Fillet { radius: 0.5 })),
        ("bar filleted fine", bar().union_with(bar().rotate_x(deg(90.0)), Blend::Fillet { radius: 0.5 }).with_tolerance(5e-5)),
        ("bar rounded", bar().rounded(0.5)),
        ("bar rounded fine", bar().rounded(0.5).with_tolerance(5e-5)),
    ] {
        let start = Instant::now();
        let accuracy = solid.accuracy()?;
        println!("{name}: {accuracy:?} in {:?}", start.elapsed());
    }
    Ok(())
}
