//! Supershapes, against figures computed with 50 digits.

use std::f64::consts::PI;

use glam::DVec3;
use rvachev::{Gielis, Radius, Solid, Supershape, Turns, deg, rad};

use crate::support::{Random, near, near_point, value};

const X: DVec3 = DVec3::new(0.5, -0.3, 0.8);

fn first() -> Supershape {
    Supershape::new(Gielis::new(6.0, 2.0, 7.0, 7.0), Gielis::new(4.0, 10.0, 10.0, 10.0))
}

fn second() -> Supershape {
    Supershape::new(Gielis::new(5.0, 3.0, 2.0, 8.0), Gielis::new(3.0, 4.0, 4.0, 4.0))
}

/// The point of the surface at the angles `theta` and `phi`.
fn surface_point(shape: &Supershape, scale: DVec3, radius: Radius, theta: f64, phi: f64) -> DVec3 {
    let (r1, r2) = (shape.equator().radius(rad(theta), radius), shape.meridian().radius(rad(phi), radius));
    scale * DVec3::new(r1 * theta.cos() * phi.cos(), r1 * theta.sin() * phi.cos(), phi.sin()) * r2
}

#[test]
fn a_known_point_of_a_hexagonal_shape() {
    let shape = first();
    let theta = X.y.atan2(X.x);
    near(theta, -0.540419500270584, 1e-15);
    let r1 = shape.equator().radius(rad(theta), Radius::Standard);
    near(r1, 2.365284372813926, 1e-12);
    near((X.z * r1).atan2(X.truncate().length()), 1.271876789684869, 1e-12);
    near(shape.gauge(X), 0.800000617660, 1e-12);
    near(shape.f1(X), 0.359999011743, 1e-12);
    near(shape.f2(X), 0.199999382340, 1e-12);
    near(shape.radial_distance(X), X.length() * (1.0 - 1.0 / 0.800000617660), 1e-11);
    // The value is the second field, scaled to length units.
    let solid = Solid::from(shape);
    let scale = value(&solid, DVec3::ZERO);
    near(value(&solid, X), scale * 0.199999382340, 1e-12);
}

#[test]
fn a_known_point_of_a_five_fold_shape() {
    near(second().gauge(X), 0.794078226827, 1e-12);
    let curve = second().equator();
    let (r, slope) = curve.radius_slope(rad(0.3), Radius::Standard);
    near(r, 1.0490573465444, 1e-12);
    near(slope, 0.3406631537204, 1e-12);
    near(curve.radius(rad(0.3), Radius::Standard), r, 0.0);
    let uneven = Gielis { a: 1.5, b: 0.7, ..curve };
    near(uneven.radius(rad(0.3), Radius::Standard), 1.3681983753907, 1e-12);
}

#[test]
fn odd_curves_with_uneven_exponents_crease_at_the_seam() {
    let slope = |curve: Gielis, theta: f64| curve.radius_slope(rad(theta), Radius::Standard).1;
    let odd = Gielis::new(5.0, 3.0, 7.0, 4.0);
    near(slope(odd, PI - 1e-4), -0.67273, 1e-4);
    near(slope(odd, -PI + 1e-4), 0.67273, 1e-4);
    let even = Gielis::new(6.0, 3.0, 7.0, 7.0);
    assert!(slope(even, PI - 1e-4).abs() < 6e-4);
    assert!(slope(even, -PI + 1e-4).abs() < 6e-4);
    // The radius itself closes in both.
    for curve in [odd, even] {
        near(curve.radius(deg(180.0), Radius::Standard), curve.radius(deg(-180.0), Radius::Standard), 1e-14);
    }
}

#[test]
fn the_rational_radius_at_a_known_angle() {
    let curve = Gielis::new(5.0, 3.0, 2.0, 8.0);
    near(curve.radius(rad(0.3), Radius::Rational), 1.093588728810, 1e-12);
}

#[test]
fn the_rational_radius_is_as_far_off_as_stated() {
    const ANGLES: u32 = 40_000;
    for (n, want) in [
        (1.0, 0.0),
        (1.5, 0.050),
        (2.0, 0.061),
        (3.0, 0.058),
        (4.0, 0.051),
        (6.0, 0.047),
        (10.0, 0.064),
        (100.0, 0.097),
    ] {
        let curve = Gielis::new(4.0, n, n, n);
        let off = (0..=ANGLES).map(|i| {
            let theta = -PI + 2.0 * PI * f64::from(i) / f64::from(ANGLES);
            (curve.radius(rad(theta), Radius::Rational) / curve.radius(rad(theta), Radius::Standard) - 1.0).abs()
        });
        near(off.fold(0.0, f64::max), want, 1e-3);
    }
}

#[test]
fn a_sharp_hexagon_is_nearly_regular() {
    let curve = Gielis::polygon(6, 1000.0);
    let off = (0..=40_000u32).map(|i| {
        let theta = -PI + 2.0 * PI * f64::from(i) / 40_000.0;
        // The middles of the sides are at radius 1, one of them at the angle 0.
        let from_middle = theta.rem_euclid(PI / 3.0).min((-theta).rem_euclid(PI / 3.0));
        (curve.radius(rad(theta), Radius::Standard) * from_middle.cos() - 1.0).abs()
    });
    near(off.fold(0.0, f64::max), 0.00258, 1e-4);
}

#[test]
fn fields_vanish_on_the_surface_and_change_sign_there() {
    let mut random = Random::new(7);
    let unit = Gielis::circle();
    let shapes = [
        first(),
        second(),
        Supershape::new(Gielis::new(3.0, 4.5, 10.0, 10.0), Gielis::new(4.0, 1.0, 1.0, 1.0)),
        Supershape::new(Gielis::polygon(5, 60.0), unit),
        Supershape::new(Gielis { a: 1.5, b: 0.7, ..Gielis::new(4.0, 2.0, 3.0, 5.0) }, unit),
    ];
    let scale = DVec3::new(1.5, 0.5, 2.0);
    for shape in shapes {
        for scale in [DVec3::ONE, scale] {
            let shape = shape.scaled(scale);
            // How much rounding of the angle moves the radius.
            let curves = [shape.equator(), shape.meridian()];
            let condition = curves.iter().map(|c| c.n2.max(c.n3) / c.n1).fold(1.0, f64::max);
            for _ in 0..3000 {
                let (theta, phi) = (random.range(-PI, PI), random.range(-0.5 * PI, 0.5 * PI));
                let p = surface_point(&shape, scale, Radius::Standard, theta, phi);
                let f2 = shape.f2(p);
                assert!(f2.abs() < 1e-14 * condition, "{shape:?} at {p}: {f2:e}");
                near(shape.f1(p), 0.0, 3e-14 * condition);
                assert!(shape.f2(0.9 * p) > 0.0 && shape.f2(1.1 * p) < 0.0, "{shape:?} at {p}");
                near(shape.f2(0.9 * p), 0.1, 1e-12);
            }
        }
    }
}

#[test]
fn the_rational_shape_is_a_gauge_too() {
    let mut random = Random::new(71);
    let shape = second().rational();
    for _ in 0..1000 {
        let (theta, phi) = (random.range(-PI, PI), random.range(-0.5 * PI, 0.5 * PI));
        let p = surface_point(&shape, DVec3::ONE, Radius::Rational, theta, phi);
        near(shape.gauge(p), 1.0, 1e-13);
        near(shape.gauge(2.0 * p), 2.0, 2e-13);
    }
}

#[test]
fn the_gauge_is_homogeneous_and_its_gradient_says_so() {
    let mut random = Random::new(72);
    for shape in [first(), second(), second().rational(), first().scaled(DVec3::new(0.5, 2.0, 1.0))] {
        let solid = Solid::from(shape.clone());
        let scale = value(&solid, DVec3::ZERO);
        for _ in 0..300 {
            let p = random.vector(-1.5, 1.5);
            let slope = -solid.gradient(p).unwrap() / scale;
            near(p.dot(slope), shape.gauge(p), 1e-11 * (1.0 + shape.gauge(p)));
        }
    }
}

#[test]
fn the_pole_and_the_centre_have_values() {
    let shape = first();
    let top = shape.meridian().radius(deg(90.0), Radius::Standard);
    near(shape.gauge(DVec3::Z), 1.0 / top, 1e-15);
    near(shape.gauge(-DVec3::Z), 1.0 / top, 1e-15);
    assert_eq!(shape.gauge(DVec3::ZERO), 0.0);
    let solid = Solid::from(shape);
    for p in [DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::NEG_X, DVec3::Y] {
        assert!(solid.gradient(p).unwrap().is_finite(), "{p}");
    }
}

#[test]
fn the_box_holds_the_surface_and_touches_it() {
    for shape in [first(), second(), second().rational()] {
        let radius = if shape == second().rational() { Radius::Rational } else { Radius::Standard };
        let bounds = Solid::from(shape.clone()).bounds().unwrap();
        let (mut most, mut least) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..=720u32 {
            for j in 0..=360u32 {
                let (theta, phi) = (PI * (f64::from(i) / 360.0 - 1.0), PI * (f64::from(j) / 360.0 - 0.5));
                let p = surface_point(&shape, DVec3::ONE, radius, theta, phi);
                assert!(bounds.contains(p), "{shape:?} at {p}");
                (most, least) = (most.max(p), least.min(p));
            }
        }
        near_point(most, bounds.max, 2e-3 * bounds.longest_side());
        near_point(least, bounds.min, 2e-3 * bounds.longest_side());
    }
}

#[test]
fn four_fold_curves_with_equal_exponents_are_superellipses() {
    let curve = Gielis::new(4.0, 5.0, 5.0, 5.0);
    for i in 0..100 {
        let theta = f64::from(i) * 0.0628;
        let want = (theta.cos().abs().powi(5) + theta.sin().abs().powi(5)).powf(-0.2);
        near(curve.radius(rad(theta), Radius::Standard), want, 1e-14);
    }
    near(Gielis::circle().radius(rad(1.234), Radius::Standard), 1.0, 1e-15);
}

#[test]
fn curves_close_after_the_stated_turns() {
    for (p, q, symmetric, uneven) in
        [(5, 1, 1, 2), (5, 2, 2, 4), (7, 3, 3, 6), (8, 3, 3, 3), (9, 2, 2, 4), (6, 5, 5, 5)]
    {
        for (n3, want) in [(7.0, symmetric), (4.0, uneven)] {
            let curve = Gielis::rational(p, q, 3.0, 7.0, n3);
            assert_eq!(curve.closing_turns(), Some(want), "{p}/{q}, n3 = {n3}");
            let turn = |k: u32, theta: f64| {
                let first = curve.with_turns(Turns::Principal);
                first.radius(rad(theta + 2.0 * PI * f64::from(k)), Radius::Standard)
            };
            for theta in [-3.0, -1.234, 0.4, 2.0] {
                // It closes then, and not before.
                near(turn(want, theta), turn(0, theta), 1e-12);
                assert!((1..want).all(|k| {
                    [0.4, 0.9].iter().any(|more| (turn(k, theta + more) - turn(0, theta + more)).abs() > 1e-3)
                }));
                // The envelopes are the extremes of the turns.
                let (least, most) = (0..want)
                    .map(|k| turn(k, theta))
                    .fold((f64::INFINITY, 0.0f64), |(least, most), r| (least.min(r), most.max(r)));
                near(curve.radius(rad(theta), Radius::Standard), most, 1e-12);
                near(curve.with_turns(Turns::Inner).radius(rad(theta), Radius::Standard), least, 1e-12);
            }
        }
    }
    assert_eq!(Gielis::new(PI, 3.0, 7.0, 7.0).closing_turns(), None);
    assert_eq!(Gielis::rational(10, 4, 3.0, 7.0, 7.0).closing_turns(), Some(2));
    assert_eq!(Gielis::circle().closing_turns(), Some(1));
}

#[test]
fn turns_have_known_radii() {
    for (p, q, want) in [(5, 2, &[1.0764467, 1.4095026][..]), (7, 3, &[1.0661874, 1.7734612, 1.1047707])] {
        let curve = Gielis::rational(p, q, 3.0, 7.0, 7.0);
        let first = curve.with_turns(Turns::Principal);
        for (k, want) in (0u32..).zip(want) {
            near(first.radius(rad(0.4 + 2.0 * PI * f64::from(k)), Radius::Standard), *want, 5e-8);
        }
        let most = want.iter().copied().fold(0.0, f64::max);
        near(curve.radius(rad(0.4), Radius::Standard), most, 5e-8);
        let least = want.iter().copied().fold(f64::INFINITY, f64::min);
        near(curve.with_turns(Turns::Inner).radius(rad(0.4), Radius::Standard), least, 5e-8);
    }
}

#[test]
fn envelopes_of_solids_hold_what_their_turns_hold() {
    // Without undercut of the meridian the product of the envelope is the union of the products.
    let mut random = Random::new(73);
    let meridian = Gielis::new(4.0, 10.0, 10.0, 10.0);
    for (p, q, n3) in [(5, 2, 5.0), (7, 3, 4.0)] {
        let outer = Gielis::rational(p, q, 3.0, 5.0, n3);
        let first = outer.with_turns(Turns::Principal);
        let shapes = [outer, outer.with_turns(Turns::Inner)].map(|curve| Supershape::new(curve, meridian));
        for _ in 0..500 {
            let point = random.vector(-1.6, 1.6);
            let theta = point.y.atan2(point.x);
            let turns = (0..outer.closing_turns().unwrap()).map(|k| {
                let r1 = first.radius(rad(theta + 2.0 * PI * f64::from(k)), Radius::Standard);
                let (u, z) = (point.truncate().length() / r1, point.z);
                1.0 - u.hypot(z) / meridian.radius(rad(z.atan2(u)), Radius::Standard)
            });
            let turns: Vec<f64> = turns.collect();
            near(shapes[0].f2(point), turns.iter().copied().fold(f64::NEG_INFINITY, f64::max), 1e-12);
            near(shapes[1].f2(point), turns.iter().copied().fold(f64::INFINITY, f64::min), 1e-12);
        }
    }
}
