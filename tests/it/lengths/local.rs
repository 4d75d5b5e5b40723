//! Blends of which each is far from the others are measured by what is near their own joints.

use std::f64::consts::PI;
use std::thread;

use glam::DVec3;
use rvachev::{Blend, RFunction, Solid, deg};

use super::{Outcome, fillet};
use crate::support::Random;

fn pin(radius: f64, place: [f64; 3]) -> Solid {
    Solid::cylinder(radius, 3.0).translate(place)
}

/// One after the other or alone, a blend is the same near its joint: of what is farther away nothing
/// counts, and it is as exact as if that were not there.
#[test]
fn blends_that_are_apart_do_not_count_for_each_other() -> Outcome {
    let plate = Solid::cuboid([14.0, 6.0, 1.0]);
    let [left, right] = [[-4.5, 0.3, 0.0], [4.5, -0.2, 0.0]];
    let chamfer = Blend::Chamfer { leg: 0.1 };
    let rest = |solid: &Solid| solid.union(Solid::sphere(0.7).translate([0.0, 0.0, 0.6]), RFunction::MIN_MAX);
    let cases: Vec<(&str, Solid, Solid)> = vec![
        (
            "pins",
            rest(&plate.union_with(pin(0.5, left), fillet(0.3))).union_with(pin(0.4, right), fillet(0.31)),
            plate.union_with(pin(0.4, right), fillet(0.31)),
        ),
        (
            // Their fillets end a radius from them, and are 4.4 radii of the other pin's fillet apart.
            "pins beside each other",
            plate.union_with(pin(0.5, [1.98, -0.2, 0.0]), fillet(0.3)).union_with(pin(0.4, right), fillet(0.301)),
            plate.union_with(pin(0.4, right), fillet(0.301)),
        ),
        (
            "holes",
            rest(&plate.difference_with(pin(0.5, left), fillet(0.3))).difference_with(pin(0.4, right), fillet(0.25)),
            plate.difference_with(pin(0.4, right), fillet(0.25)),
        ),
        (
            "moved",
            rest(&plate.difference_with(pin(0.5, left), fillet(0.3)))
                .named("plate")
                .translate([0.0, 0.2, 0.0])
                .union_with(pin(0.4, right), fillet(0.25)),
            plate.translate([0.0, 0.2, 0.0]).union_with(pin(0.4, right), fillet(0.25)),
        ),
        (
            "chamfers",
            plate.union_with(pin(0.5, left), fillet(0.3)).union_with(pin(0.4, right), chamfer),
            plate.union_with(pin(0.4, right), chamfer),
        ),
    ];
    let mut random = Random::new(11);
    for (name, all, alone) in cases {
        let mut near = 0;
        for _ in 0..3000 {
            let p = DVec3::from_array(right) + DVec3::new(1.0, 1.0, 1.2) * random.vector(-1.0, 1.0);
            let [value, want] = [all.value(p)?, alone.value(p)?];
            assert!((value - want).abs() < 1e-12, "{name}: {value}, alone {want}, at {p}");
            near += usize::from(value.abs() < 0.2);
        }
        assert!(near > 200, "{name}: {near}");
        assert_eq!(all.accuracy()?.error, all.accuracy()?.error.max(alone.accuracy()?.error), "{name}");
    }
    Ok(())
}

/// What is near enough counts: a pin beside a filleted one has its fillet up to that one's.
#[test]
fn blends_that_are_near_each_other_are_between_the_union_and_its_closing() -> Outcome {
    let plate = Solid::cuboid([8.0, 5.0, 1.0]);
    let mut random = Random::new(5);
    for apart in [1.2, 1.6, 2.4, 3.2] {
        let [a, b] = [pin(0.5, [0.0; 3]), pin(0.4, [apart, 0.2, 0.0])];
        let both = plate.union_with(&a, fillet(0.3)).union_with(&b, fillet(0.35));
        let plain = plate.union(&a, RFunction::MIN_MAX).union(&b, RFunction::MIN_MAX);
        let closing = plain.filleted(0.35);
        for _ in 0..4000 {
            let p = DVec3::new(0.5 * apart, 0.0, 0.5) + DVec3::new(2.0, 1.5, 1.0) * random.vector(-1.0, 1.0);
            let is_inside = both.contains(p)?;
            assert!(is_inside || !plain.contains(p)?, "{apart}: {p} is lost");
            assert!(!is_inside || closing.value(p)? > -2e-3, "{apart}: {p} is added beyond the closing");
        }
    }
    Ok(())
}

/// Each of a hundred radii is its own blend, nested in the next: neither the stack nor the work of
/// each grows with them.
#[test]
fn a_hundred_radii_are_measured_one_by_one() {
    let made = || -> Result<(), String> {
        let place = |n: u32| [1.5 * f64::from(n % 10) - 6.75, 1.5 * f64::from(n / 10) - 6.75, 0.0];
        let radius = |n: u32| 0.1 + 1e-4 * f64::from(n);
        let pins = (0..100).map(|n| (pin(0.3, place(n)), radius(n)));
        let all = pins.fold(Solid::cuboid([15.0, 15.0, 1.0]), |all, (pin, r)| all.union_with(&pin, fillet(r)));
        for n in [0, 37, 99] {
            let r = radius(n);
            let ball = DVec3::from_array(place(n)) + DVec3::new(0.3 + r, 0.0, 0.5 + r);
            let towards = DVec3::new(-1.0, 0.0, -1.0).normalize();
            for (by, want) in [(1.02, true), (0.98, false)] {
                let got = all.contains(ball + by * r * towards).map_err(|error| error.to_string())?;
                assert_eq!(got, want, "pin {n}");
            }
        }
        Ok(())
    };
    let small = thread::Builder::new().stack_size(512 << 10).spawn(made).unwrap();
    small.join().unwrap().unwrap();
}

/// A chamfer beside a filleted post: above its fillet the post is as it was.
#[test]
fn chamfers_of_filleted_operands_have_no_fins() -> Outcome {
    let plate = Solid::cuboid([43.0, 35.5, 4.0]);
    let (post, radius) = (Solid::cylinder(2.5, 18.5).translate([0.0, -13.0, 7.25]), 3.0);
    let lying = Solid::cylinder(6.5, 14.5).rotate_x(deg(90.0)).translate([-4.0, -7.0, 5.9]);
    let both = plate.union_with(post, fillet(radius)).union_with(lying, Blend::Chamfer { leg: 1.5 });
    for turn in -30..=30 {
        let angle = 1.5 * PI + 0.01 * f64::from(turn);
        for (out, up) in [0.03, 0.06, 0.1, 0.2].into_iter().flat_map(|out| (0..240).map(move |up| (out, f64::from(up))))
        {
            let r = 2.5 + out;
            let p = DVec3::new(r * angle.cos(), r * angle.sin() - 13.0, 2.1 + radius + 0.05 * up);
            assert!(!both.contains(p)?, "a fin at {p}");
        }
    }
    Ok(())
}
