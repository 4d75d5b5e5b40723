//! Solids of very many nodes: deep chains, shared parts, long joins.

use glam::DVec3;
use rvachev::{Bounds, CellSize, MeshSettings, RFunction, Solid, Superellipsoid, program::Region, rad};

use crate::support::{RULES, Random, lanes32, value};

const DEEP: usize = 100_000;

/// Runs on a stack that a recursion over the chain would overflow many times.
fn on_a_small_stack(test: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(512 * 1024);
    thread.spawn(test).expect("a thread").join().expect("the test passes");
}

/// Builds a chain, asks everything of it that walks the graph, and drops it.
fn walks(chain: Solid, inside: DVec3, outside: DVec3, leaves: usize) {
    let text = format!("{chain:?}");
    assert!(text.len() < 4000, "{} characters", text.len());
    assert!(chain.contains(inside).unwrap());
    assert!(!chain.contains(outside).unwrap());
    assert!(value(&chain, inside) > 0.0 && value(&chain, outside) < 0.0);
    assert!(chain.gradient(outside).unwrap().is_finite());
    let (field, surface) = (chain.field_program().unwrap(), chain.surface_program().unwrap());
    assert_eq!((field.leaf_count(), surface.leaf_count()), (leaves, leaves));
    let bounds = chain.bounds().unwrap();
    assert!(bounds.contains(inside));
    let near = Bounds::from_center(inside, DVec3::splat(1e-3));
    assert!(matches!(surface.narrow(&near), Region::Inside));
    assert!(chain.range(&near).unwrap().hi() > 0.0);
    assert!(!chain.owner(inside).unwrap().path.is_empty());
    let copy = chain.clone();
    drop(chain);
    drop(copy);
}

/// A ball of the row that fills x from 0 to `DEEP`.
fn ball(i: usize) -> Solid {
    Solid::sphere(0.4).translate(DVec3::X * i as f64)
}

const INSIDE: DVec3 = DVec3::new(777.0, 0.1, 0.0);
const OUTSIDE: DVec3 = DVec3::new(777.5, 0.0, 0.0);

#[test]
fn a_left_chain_of_unions() {
    on_a_small_stack(|| {
        let chain = (1..DEEP).fold(ball(0), |chain, i| chain.union(ball(i), RFunction::MIN_MAX));
        walks(chain, INSIDE, OUTSIDE, DEEP);
    });
}

#[test]
fn a_left_chain_of_smooth_unions() {
    on_a_small_stack(|| {
        let chain = (1..DEEP).fold(ball(0), |chain, i| chain | ball(i));
        walks(chain, INSIDE, OUTSIDE, DEEP);
    });
}

#[test]
fn a_right_chain_of_unions() {
    on_a_small_stack(|| {
        let chain = (1..DEEP).fold(ball(0), |chain, i| ball(i).union(&chain, RFunction::MIN_MAX));
        walks(chain, INSIDE, OUTSIDE, DEEP);
    });
}

#[test]
fn a_chain_of_unions_and_intersections_by_turns() {
    for rule in [RFunction::MIN_MAX, RFunction::P(2.0)] {
        on_a_small_stack(move || {
            // The intersections cut nothing off: the balls that matter are united.
            let around = Solid::half_space(DVec3::Z, 1.0);
            let chain = (1..DEEP / 2).fold(ball(0), |chain, i| chain.intersection(&around, rule).union(ball(i), rule));
            walks(chain, INSIDE, OUTSIDE, DEEP / 2 + 1);
        });
    }
}

#[test]
fn a_chain_of_translations() {
    on_a_small_stack(|| {
        let step = DVec3::X / 1024.0;
        let chain = (0..DEEP).fold(Solid::sphere(1.0), |chain, _| chain.translate(step));
        let centre = step * DEEP as f64;
        walks(chain, centre, centre + 2.0 * DVec3::X, 1);
    });
}

/// A bar that is deformed in so many steps is as one that is deformed at once.
fn deformed_in_steps(count: u32) {
    let bar = Solid::cuboid([1.0, 0.8, 2.0]);
    let part = 1.0 / f64::from(count);
    let twists = (0..count).fold(bar.clone(), |bar, _| bar.twist(rad(0.3 * part)));
    let longer = (0..count).fold(bar.clone(), |bar, _| bar.elongate([part, 0.0, 0.0]));
    for (steps, at_once) in [(twists, bar.twist(rad(0.3))), (longer, bar.elongate([1.0, 0.0, 0.0]))] {
        for p in [[0.1, 0.2, 0.9], [0.7, 0.3, -0.8], [-0.4, -0.39, 0.99]] {
            let off = steps.value(p).unwrap() - at_once.value(p).unwrap();
            assert!(off.abs() < 1e-9, "{off:e} at {p:?} in {count} steps");
        }
        let settings = MeshSettings { cell: CellSize::LongestSide(16), ..MeshSettings::default() };
        let [mesh, other] = [&steps, &at_once].map(|solid| solid.mesh(&settings).unwrap());
        assert!(mesh.check().is_sound() && (mesh.volume() / other.volume() - 1.0).abs() < 0.01, "{}", mesh.volume());
    }
}

#[test]
fn a_chain_of_deformations_is_meshed() {
    deformed_in_steps(500);
}

#[test]
#[ignore = "takes some ten seconds"]
fn a_chain_of_ten_thousand_deformations_is_meshed() {
    deformed_in_steps(10_000);
}

#[test]
fn a_chain_of_complements_and_differences() {
    on_a_small_stack(|| {
        let chain = (0..DEEP).fold(Solid::sphere(1.0), |chain, _| !chain);
        walks(chain, DVec3::ZERO, DVec3::X * 2.0, 1);
        let slab = Solid::cuboid(DVec3::new(3.0 * DEEP as f64, 1.0, 1.0));
        let chain = (1..DEEP / 4).fold(slab, |chain, i| chain - ball(i));
        walks(chain, OUTSIDE, INSIDE, DEEP / 4);
    });
}

#[test]
fn a_deep_chain_that_is_wrong_says_so_briefly() {
    on_a_small_stack(|| {
        let chain = (1..DEEP).fold(Solid::sphere(-1.0), |chain, i| chain | ball(i));
        let text = chain.value(DVec3::ZERO).unwrap_err().to_string();
        assert!(text.contains("radius is -1") && text.contains("more)"), "{text}");
        assert!(text.len() < 400, "{text}");
    });
}

#[test]
fn shared_parts_compile_once() {
    for rule in RULES {
        let mut x = Solid::sphere(1.0);
        for _ in 0..60 {
            x = x.union(&x, rule);
        }
        assert_eq!(x.surface_program().unwrap().leaf_count(), 1, "{rule:?}");
        assert_eq!(x.field_program().unwrap().leaf_count(), 1, "{rule:?}");
        // Sixty rules of order m in a row flatten a small value to 0.
        assert!(value(&x, DVec3::X * 0.5) >= 0.0 && value(&x, DVec3::X * 1.5) <= 0.0, "{rule:?}");
        assert!(x.contains(DVec3::X * 0.5).unwrap() && !x.contains(DVec3::X * 1.5).unwrap(), "{rule:?}");
        assert!(format!("{x:?}").len() < 4000);
    }
    // In several places under one map, and under two.
    let part = Solid::sphere(1.0) - Solid::cuboid(DVec3::ONE);
    let twice = (&part | &part).translate(DVec3::X);
    assert_eq!(twice.surface_program().unwrap().leaf_count(), 2);
    let apart = &part | &part.translate(DVec3::X * 3.0);
    assert_eq!(apart.surface_program().unwrap().leaf_count(), 4);
    // One leaf value in several places, mixed with others.
    let (a, b) = (Solid::sphere(1.0), Solid::cuboid(DVec3::ONE));
    let mut x = a.clone();
    for i in 0..60 {
        x = if i % 2 == 0 { &x | &(&x & &b) } else { &x - &(&x - &a) };
    }
    assert_eq!(x.surface_program().unwrap().leaf_count(), 2);
    assert!(x.contains(DVec3::ZERO).unwrap());
}

#[test]
fn ten_thousand_operands_stay_finite() {
    const COUNT: usize = 10_000;
    let rules = RULES.into_iter().chain([RFunction::Zero { m: 8 }, RFunction::Zero { m: 0 }, RFunction::P(1.001)]);
    let far = [DVec3::ZERO, DVec3::X * 0.5, DVec3::Y * 0.999, DVec3::X * 1.5, DVec3::ONE * 30.0, DVec3::ONE * 1e6];
    for rule in rules {
        let balls = || (0..COUNT).map(|i| Solid::sphere(1.0 + 1e-9 * i as f64));
        let united = Solid::union_all(balls(), rule);
        let common = Solid::intersection_all(balls(), rule);
        let chained = balls().reduce(|all, next| all.union(&next, rule)).expect("there are balls");
        let cut = Solid::sphere(2.0).difference_all(balls(), rule);
        for solid in [united, common, chained, cut] {
            for p in far {
                let v = value(&solid, p);
                assert!(v.is_finite(), "{rule:?} at {p}: {v}");
                let slope = solid.gradient(p).unwrap();
                assert!(slope.is_finite(), "{rule:?} at {p}: {slope}");
            }
            let program = solid.field_program().unwrap();
            let region = Bounds::from_center(DVec3::ZERO, DVec3::splat(1e6));
            let (_, values) = lanes32(&program, &region, &far);
            assert!(values.iter().all(|v| v.is_finite()), "{rule:?}: {values:?}");
        }
    }
}

#[test]
fn long_unions_mesh_and_narrow_to_what_is_near() {
    let mut random = Random::new(9);
    let count = 20_000;
    let row = (0..count).map(|_| {
        let leaf = Superellipsoid::new(DVec3::splat(0.3), random.range(0.2, 1.8), random.range(0.2, 1.8));
        Solid::from(leaf).rotate(random.rotation()).translate(random.vector(0.0, 50.0))
    });
    let solid = Solid::union_all(row, RFunction::MIN_MAX);
    let program = solid.surface_program().unwrap();
    assert_eq!(program.leaf_count(), count);
    let near = Bounds::from_center(DVec3::splat(25.0), DVec3::splat(0.5));
    if let Region::Surface(narrowed) = program.narrow(&near) {
        assert!(narrowed.leaf_count() < 60, "{}", narrowed.leaf_count());
    }
    let bounds = Some(Bounds::from_center(DVec3::splat(25.0), DVec3::splat(2.0)));
    let mesh =
        solid.mesh(&MeshSettings { cell: CellSize::LongestSide(32), bounds, ..MeshSettings::default() }).unwrap();
    assert!(mesh.check().is_closed() && mesh.check().is_manifold());
}
