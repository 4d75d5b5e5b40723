//! Laws that hold for every solid, tried on random ones.
//!
//! The cases are drawn from a fixed seed: a run that passes passes again.

use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rvachev::{RFunction, Solid, rad};

use crate::support::{RULES, Random, extra_seed, frame_of, random_solid, value};

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 12,
        rng_seed: RngSeed::Fixed(20 + extra_seed()),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// A random solid; shrinking makes it shallower.
fn solids() -> impl Strategy<Value = Solid> {
    (0..4usize, any::<u64>()).prop_map(|(depth, seed)| random_solid(&mut Random::new(seed), depth))
}

/// Points around a solid, some of them exactly on round coordinates.
fn around(solid: &Solid, seed: u64, count: usize) -> Vec<DVec3> {
    let mut random = Random::new(seed);
    let frame = frame_of(solid);
    let frame = frame.inflate(0.3 * frame.longest_side());
    let mut points: Vec<DVec3> = (0..count).map(|_| random.point_in(&frame)).collect();
    points.extend((0..count / 8).map(|_| (random.point_in(&frame) * 8.0).round() / 8.0));
    points
}

fn rules() -> impl Strategy<Value = RFunction> {
    prop::sample::select(RULES.to_vec())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn de_morgan(a in solids(), b in solids(), rule in rules(), seed: u64) {
        let union = a.union(&b, rule);
        let other = !(!&a).intersection(&!&b, rule);
        let difference = a.difference(&b, rule);
        let without = a.intersection(&!&b, rule);
        let twice = !!&a;
        for p in around(&union, seed, 100) {
            // To the bit: complements cost nothing and round nothing.
            prop_assert_eq!(value(&union, p), value(&other, p));
            prop_assert_eq!(value(&difference, p), value(&without, p));
            prop_assert_eq!(value(&twice, p), value(&a, p));
        }
    }

    #[test]
    fn the_sign_is_that_of_min_and_max(a in solids(), b in solids(), rule in rules(), seed: u64) {
        let union = a.union(&b, rule);
        let common = a.intersection(&b, rule);
        let difference = a.difference(&b, rule);
        let either = a.symmetric_difference(&b, rule);
        for p in around(&union, seed, 100) {
            let (x, y) = (value(&a, p), value(&b, p));
            // The rules saturate far below zero too, but a product of tiny values vanishes.
            if x.abs().min(y.abs()) < 1e-9 {
                continue;
            }
            let (x, y) = (x > 0.0, y > 0.0);
            for (solid, want) in [(&union, x || y), (&common, x && y), (&difference, x && !y), (&either, x != y)] {
                prop_assert_eq!(value(solid, p) > 0.0, want, "field of {:?} at {}", rule, p);
                prop_assert_eq!(solid.contains(p).unwrap(), want, "surface of {:?} at {}", rule, p);
            }
        }
    }

    #[test]
    fn a_rigidly_moved_solid_is_the_pulled_back_point(solid in solids(), seed: u64) {
        let mut random = Random::new(seed);
        let pose = DAffine3::from_rotation_translation(random.rotation(), random.vector(-2.0, 2.0));
        let moved = solid.affine(pose);
        let back = pose.inverse();
        for p in around(&moved, seed, 60) {
            let (got, want) = (value(&moved, p), value(&solid, back.transform_point3(p)));
            let slack = 1e-9 * (1.0 + want.abs()) + 1e-12 * slope(&solid, back.transform_point3(p));
            prop_assert!((got - want).abs() <= slack, "{} and {} at {}", got, want, p);
        }
    }

    #[test]
    fn any_affine_map_keeps_the_sign(solid in solids(), seed: u64) {
        let mut random = Random::new(seed);
        let map = random.affine();
        let moved = solid.affine(map);
        for p in around(&solid, seed, 60) {
            let inside = value(&solid, p);
            if inside.abs() > 1e-9 * (1.0 + slope(&solid, p)) {
                prop_assert_eq!(moved.contains(map.transform_point3(p)).unwrap(), inside > 0.0, "at {}", p);
            }
        }
    }

    #[test]
    fn nothing_is_inside_outside_the_bounds(solid in solids(), seed: u64) {
        let bounds = solid.bounds().unwrap();
        for p in around(&solid, seed, 300) {
            if !bounds.contains(p) {
                prop_assert!(!solid.contains(p).unwrap(), "{} is inside, outside of {:?}", p, bounds);
                prop_assert!(value(&solid, p) <= 0.0, "{} is inside, outside of {:?}", p, bounds);
            }
        }
    }

    #[test]
    fn surface_and_field_program_agree_in_sign(solid in solids(), seed: u64) {
        let (field, surface) = (solid.field_program().unwrap(), solid.surface_program().unwrap());
        for p in around(&solid, seed, 200) {
            let (f, s) = (field.value(p), surface.value(p));
            // Rules of order m flatten corners: tiny values there may vanish.
            if s.abs() > 1e-4 {
                prop_assert_eq!(f > 0.0, s > 0.0, "{} and {} at {}", f, s, p);
            }
        }
    }

    #[test]
    fn commuting_operands_change_nothing(a in solids(), b in solids(), rule in rules(), seed: u64) {
        let (ab, ba) = (a.union(&b, rule), b.union(&a, rule));
        for p in around(&ab, seed, 60) {
            let (x, y) = (value(&ab, p), value(&ba, p));
            prop_assert!((x - y).abs() <= 1e-13 * (1.0 + x.abs()), "{} and {} at {}", x, y, p);
        }
    }

    #[test]
    fn a_deformed_solid_stays_in_its_bounds(solid in solids(), seed: u64) {
        let mut random = Random::new(seed);
        let all = [
            solid.taper(random.range(-0.9, 0.9), random.range(-0.9, 0.9), random.range(0.4, 2.0)),
            solid.twist(rad(random.range(-4.0, 4.0))),
            solid.bend(random.range(-0.6, 0.6), rad(random.range(-3.0, 3.0))),
        ];
        for deformed in all.iter().filter(|s| s.bounds().is_ok()) {
            let bounds = deformed.bounds().unwrap();
            for p in around(deformed, seed, 150) {
                if !bounds.contains(p) {
                    prop_assert!(!deformed.contains(p).unwrap(), "{} is inside, outside of {:?}", p, bounds);
                }
            }
        }
    }
}

/// The slope at a point, 0 where it is not finite.
fn slope(solid: &Solid, p: DVec3) -> f64 {
    let length = solid.gradient(p).unwrap().length();
    if length.is_finite() { length } else { 0.0 }
}
