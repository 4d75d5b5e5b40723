//! R-functions against known figures and the properties that make them set operations.

use glam::DVec3;
use rvachev::{Bounds, RFunction, Solid};

use crate::support::{RULES, Random, lanes32, near, near_point, value};

const X: f64 = 0.3;
const Y: f64 = -0.2;

/// The half-space whose value is the coordinate along `axis`.
fn coordinate(axis: DVec3) -> Solid {
    Solid::half_space(-axis, 0.0)
}

#[test]
fn known_values() {
    for (rule, and, or) in [
        (RFunction::MIN_MAX, Y, X),
        (RFunction::Alpha(0.5), -0.2239265962360449, 0.3572599295693782),
        (RFunction::P(2.0), -0.260555127546399, 0.460555127546399),
        (RFunction::Alpha(0.0), -0.260555127546399, 0.460555127546399),
        (RFunction::P(4.0), -0.2138288992715, 0.4138288992715),
        (RFunction::Zero { m: 2 }, -0.0338721665810, 0.0598721665810),
    ] {
        // As many digits as are known.
        let tolerance = if matches!(rule, RFunction::P(4.0) | RFunction::Zero { .. }) { 1e-13 } else { 1e-14 };
        near(rule.and(X, Y), and, tolerance);
        near(rule.or(X, Y), or, tolerance);
        near(rule.and(Y, X), and, tolerance);
    }
}

#[test]
fn the_associative_rule() {
    let rule = RFunction::Associative(2.0);
    near(rule.and(0.3, 0.4), 0.24, 1e-15);
    near(rule.and(-0.3, -0.4), -0.5, 1e-15);
    near(rule.and(-0.3, 0.4), -0.3, 1e-15);
    near(rule.or(0.3, 0.4), 0.5, 1e-15);
    let mut random = Random::new(2);
    for _ in 0..10_000 {
        let [a, b, c] = random.vector(-1.0, 1.0).to_array();
        near(rule.and(rule.and(a, b), c), rule.and(a, rule.and(b, c)), 1e-14);
        near(rule.or(rule.or(a, b), c), rule.or(a, rule.or(b, c)), 1e-14);
    }
    assert!(rule.associates() && RFunction::MIN_MAX.associates());
    assert!(!RFunction::P(2.0).associates() && !RFunction::Alpha(0.5).associates());
}

#[test]
fn order_matters_for_other_rules() {
    let rule = RFunction::P(2.0);
    near(rule.or(rule.or(1.0, 2.0), 3.0), 14.27, 5e-3);
    near(rule.or(1.0, rule.or(2.0, 3.0)), 18.27, 5e-3);
}

#[test]
fn ranges_of_independent_operands_are_exact() {
    let bounds = Bounds::new(DVec3::new(-0.1, 0.2, 0.0), DVec3::new(0.4, 0.6, 0.0));
    let (x, y) = (coordinate(DVec3::X), coordinate(DVec3::Y));
    let range = x.intersection(&y, RFunction::P(2.0)).range(&bounds).unwrap();
    near(range.lo(), -0.123606797749979, 1e-13);
    near(range.hi(), 0.278889744907202, 1e-13);
    for rule in RULES.into_iter().filter(|rule| !matches!(rule, RFunction::Zero { .. })) {
        let and = x.intersection(&y, rule).range(&bounds).unwrap();
        near(and.lo(), rule.and(-0.1, 0.2), 1e-12);
        near(and.hi(), rule.and(0.4, 0.6), 1e-12);
        let or = x.union(&y, rule).range(&bounds).unwrap();
        near(or.lo(), rule.or(-0.1, 0.2), 1e-12);
        near(or.hi(), rule.or(0.4, 0.6), 1e-12);
    }
}

#[test]
fn the_range_of_the_rule_that_does_not_rise_is_sound() {
    let rule = RFunction::Zero { m: 2 };
    near(rule.and(0.2276, -1.0), -1.8911, 1e-4);
    near(rule.and(5.0, -1.0), -28.574507, 1e-6);
    let bounds = Bounds::new(DVec3::new(0.0, -1.0, 0.0), DVec3::new(5.0, -1.0, 0.0));
    let both = coordinate(DVec3::X).intersection(coordinate(DVec3::Y), rule);
    let range = both.range(&bounds).unwrap();
    assert!(range.lo() <= -28.574507 && range.hi() >= -1.8911, "{range:?}");
    // Its largest value is between the ends.
    let most = (0..=5000).map(|i| rule.and(f64::from(i) * 1e-3, -1.0)).fold(f64::NEG_INFINITY, f64::max);
    near(most, -1.8911, 1e-4);
    assert!(range.contains(most));
}

#[test]
fn single_precision_loses_no_digits_to_cancelling() {
    let both = coordinate(DVec3::X).intersection(coordinate(DVec3::Y), RFunction::Alpha(0.0));
    let program = both.field_program().unwrap();
    let region = Bounds::from_center(DVec3::ZERO, DVec3::ONE);
    let (_, values) = lanes32(&program, &region, &[DVec3::new(1e-6, 1.0, 0.0)]);
    let ulp = f64::from(1e-6f32.next_up() - 1e-6f32);
    near(values[0], 9.999995e-7, 2.0 * ulp);
}

#[test]
fn the_sign_is_that_of_min_and_max() {
    let mut random = Random::new(4);
    let rules = RULES.into_iter().chain([RFunction::Zero { m: 8 }, RFunction::P(1.001), RFunction::Associative(1.001)]);
    let rules: Vec<RFunction> = rules.chain([RFunction::Alpha(-0.999), RFunction::P(1000.0)]).collect();
    for _ in 0..400_000 {
        let size = random.log_range(1e-6, 1e6);
        let other = if random.chance(0.5) { size } else { random.log_range(1e-6, 1e6) };
        let (x, y) = (random.range(-1.0, 1.0) * size, random.range(-1.0, 1.0) * other);
        for &rule in &rules {
            let (and, or) = (rule.and(x, y), rule.or(x, y));
            assert!((and > 0.0) == (x > 0.0 && y > 0.0), "{rule:?} and({x}, {y}) = {and}");
            assert!((or > 0.0) == (x > 0.0 || y > 0.0), "{rule:?} or({x}, {y}) = {or}");
            assert!(and.is_finite() && or.is_finite(), "{rule:?} of {x}, {y}");
        }
    }
}

#[test]
fn zeros_are_kept() {
    for rule in RULES {
        near(rule.and(0.0, 1.0), 0.0, 1e-15);
        near(rule.or(0.0, -1.0), 0.0, 1e-15);
        assert_eq!(rule.and(0.0, 0.0), 0.0, "{rule:?}");
        assert_eq!(rule.or(0.0, 0.0), 0.0, "{rule:?}");
        assert!(rule.and(0.0, -1.0) < 0.0 && rule.or(0.0, 1.0) > 0.0, "{rule:?}");
    }
}

#[test]
fn laws_of_de_morgan_hold_to_the_bit() {
    let mut random = Random::new(41);
    for _ in 0..20_000 {
        let (x, y) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
        for rule in RULES {
            assert_eq!(rule.or(x, y), -rule.and(-x, -y), "{rule:?} of {x}, {y}");
        }
    }
}

#[test]
fn all_but_one_rise_with_both_arguments() {
    let mut random = Random::new(42);
    for rule in RULES.into_iter().filter(|rule| !matches!(rule, RFunction::Zero { .. })) {
        for _ in 0..20_000 {
            let (x, y, more) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0), random.log_range(1e-6, 1.0));
            // Rounding may take a unit in the last place from a flat stretch.
            let slack = 1e-13;
            assert!(rule.and(x + more, y) >= rule.and(x, y) - slack, "{rule:?} at {x}, {y}, {more}");
            assert!(rule.or(x, y + more) >= rule.or(x, y) - slack, "{rule:?} at {x}, {y}, {more}");
        }
    }
}

#[test]
fn on_the_surface_of_one_operand_the_gradient_is_its_own() {
    for rule in RULES {
        let both = coordinate(DVec3::X).intersection(coordinate(DVec3::Y), rule);
        let either = coordinate(DVec3::X).union(coordinate(DVec3::Y), rule);
        // The rule of order m scales it by the other operand to the power m.
        let m = if let RFunction::Zero { m } = rule { m } else { 0 };
        let scale = 0.7f64.powi(m as i32);
        near_point(both.gradient(DVec3::new(0.0, 0.7, 0.0)).unwrap(), scale * DVec3::X, 1e-12);
        near_point(both.gradient(DVec3::new(0.7, 0.0, 0.0)).unwrap(), scale * DVec3::Y, 1e-12);
        near_point(either.gradient(DVec3::new(0.0, -0.7, 0.0)).unwrap(), scale * DVec3::X, 1e-12);
        near_point(either.gradient(DVec3::new(-0.7, 0.0, 0.0)).unwrap(), scale * DVec3::Y, 1e-12);
        assert!(both.gradient(DVec3::ZERO).unwrap().is_finite(), "{rule:?}");
    }
}

#[test]
fn solids_are_joined_by_these_functions() {
    let (a, b) = (Solid::sphere(1.0), Solid::cuboid(DVec3::ONE).translate(DVec3::X * 0.8));
    let mut random = Random::new(43);
    for _ in 0..300 {
        let p = random.vector(-1.5, 1.5);
        let (x, y) = (value(&a, p), value(&b, p));
        for rule in RULES {
            near(value(&a.union(&b, rule), p), rule.or(x, y), 1e-14);
            near(value(&a.intersection(&b, rule), p), rule.and(x, y), 1e-14);
            near(value(&a.difference(&b, rule), p), rule.and(x, -y), 1e-14);
            let either = rule.or(rule.and(x, -y), rule.and(-x, y));
            near(value(&a.symmetric_difference(&b, rule), p), either, 1e-14);
        }
        assert_eq!(value(&!&a, p), -x);
        let p2 = RFunction::P(2.0);
        near(value(&(&a | &b), p), p2.or(x, y), 1e-14);
        near(value(&(&a & &b), p), p2.and(x, y), 1e-14);
        near(value(&(&a - &b), p), p2.and(x, -y), 1e-14);
        near(value(&(&a ^ &b), p), p2.or(p2.and(x, -y), p2.and(-x, y)), 1e-14);
    }
}
