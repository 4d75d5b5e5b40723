//! Exact primitives against closed forms: every one of them is convex but the torus, and the
//! signed distance of a convex solid is the least of `h(n) − n·p` over all directions n, h
//! being its support function.

use std::f64::consts::TAU;

use glam::DVec3;
use rvachev::{Capsule, Cone, Ellipsoid, Prism, Pyramid, RoundedCuboid, Slab, Solid, Torus, Wedge, deg};

use crate::support::{Random, near, value};

/// The solids of the conformance tests, with their sizes.
pub fn primitives() -> Vec<(&'static str, Solid, f64)> {
    vec![
        ("rounded box", Solid::rounded_cuboid(DVec3::new(1.0, 0.5, 2.0), 0.2), 1.2),
        ("rounded box to the full", Solid::rounded_cuboid(DVec3::new(1.0, 0.5, 2.0), 0.25), 1.2),
        ("cone", Solid::cone(0.7, 0.0, 1.5), 1.0),
        ("truncated cone", Solid::cone(0.3, 0.8, 1.2), 1.0),
        ("capsule", Solid::capsule(0.3, 1.8), 1.0),
        ("torus", Solid::torus(0.7, 0.3), 1.0),
        ("torus without a hole", Solid::torus(0.5, 0.5), 1.0),
        ("ellipsoid", Solid::ellipsoid(DVec3::new(1.0, 0.8, 0.3)), 1.0),
        ("triangular prism", Solid::prism(3, 0.9, 1.0), 1.0),
        ("hexagonal prism", Solid::prism(6, 0.8, 0.6), 0.9),
        ("prism of 17 sides", Solid::prism(17, 0.5, 2.0), 1.1),
        ("pyramid", Solid::pyramid(4, 0.9, 1.2), 1.0),
        ("flat pyramid", Solid::pyramid(5, 1.0, 0.4), 1.0),
        ("wedge", Solid::wedge(DVec3::new(1.5, 0.6, 0.9)), 1.0),
        ("slab", Solid::slab(DVec3::new(0.3, -0.5, 0.8), 0.5), 1.0),
        ("slab along an axis", Solid::slab(DVec3::Y, 0.5), 1.0),
    ]
}

/// A primitive of any kind, of a size between 0.2 and 1.6, about the origin.
pub fn random_primitive(random: &mut Random) -> (Solid, f64) {
    let a = random.range(0.2, 0.8);
    let b = random.range(0.2, 0.8);
    let sides = 3 + random.below(8) as u32;
    let box_size = random.vector(0.4, 1.6);
    let solid = match random.below(10) {
        0 => Solid::rounded_cuboid(box_size, random.range(0.0, 0.5) * box_size.min_element()),
        1 => Solid::cone(a, random.pick(&[0.0, b, a]), 2.0 * random.range(0.2, 0.8)),
        2 => Solid::cone(0.0, a, 2.0 * b),
        3 => Solid::capsule(0.5 * a, a + random.pick(&[0.0, b])),
        4 => Solid::torus(a, a * random.pick(&[0.1, 0.5, 1.0])),
        5 => Solid::ellipsoid(box_size * 0.5),
        6 => Solid::prism(sides, a, 2.0 * b),
        7 => Solid::pyramid(sides, a, 2.0 * b),
        8 => Solid::wedge(box_size),
        _ => Solid::slab(random.direction(), a),
    };
    (solid, 0.8)
}

/// A support function by hand.
type Support = Box<dyn Fn(DVec3) -> f64>;

fn hull(points: Vec<DVec3>) -> Support {
    Box::new(move |n| points.iter().map(|p| n.dot(*p)).fold(f64::NEG_INFINITY, f64::max))
}

fn ring(sides: u32, radius: f64, z: f64) -> Vec<DVec3> {
    let corner = |i: u32| TAU * f64::from(i) / f64::from(sides);
    (0..sides).map(|i| DVec3::new(radius * corner(i).cos(), radius * corner(i).sin(), z)).collect()
}

fn convex(random: &mut Random) -> Vec<(String, Solid, Support)> {
    let mut all: Vec<(String, Solid, Support)> = Vec::new();
    for round in 0..3 {
        let [a, b, c] = [0; 3].map(|_| random.range(0.2, 1.0));
        let size = 2.0 * DVec3::new(a, b, c);
        let radius = 0.5 * f64::from(round) * size.min_element() * 0.5;
        let core = 0.5 * size - radius;
        let rounded = RoundedCuboid { size, radius };
        all.push((format!("{rounded:?}"), rounded.into(), Box::new(move |n| core.dot(n.abs()) + radius)));
        for (bottom_radius, top_radius) in [(a, b), (b, 0.0), (0.0, c), (a, a)] {
            let cone = Cone { bottom_radius, top_radius, height: 2.0 * c };
            let support = move |n: DVec3| {
                let across = n.truncate().length();
                (bottom_radius * across - c * n.z).max(top_radius * across + c * n.z)
            };
            all.push((format!("{cone:?}"), cone.into(), Box::new(support)));
        }
        let capsule = Capsule { radius: a, height: 2.0 * (a + b) };
        all.push((format!("{capsule:?}"), capsule.into(), Box::new(move |n| a + b * n.z.abs())));
        for sides in [3, 4, 5, 6, 7, 8, 9, 16, 33] {
            let both: Vec<DVec3> = [ring(sides, a, -b), ring(sides, a, b)].concat();
            all.push((format!("prism of {sides} sides"), Prism::new(sides, a, 2.0 * b).into(), hull(both)));
            let mut tent = ring(sides, a, -c);
            tent.push(DVec3::Z * c);
            all.push((format!("pyramid of {sides} sides"), Pyramid::new(sides, a, 2.0 * c).into(), hull(tent)));
        }
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
            .into_iter()
            .flat_map(|(x, z)| [-1.0, 1.0].map(|y| DVec3::new(x, y, z) * DVec3::new(a, b, c)));
        all.push((format!("wedge {size}"), Wedge { size }.into(), hull(corners.collect())));
    }
    all
}

/// The signed distance from a smooth solid by search over directions: a grid, then ever
/// smaller steps.
fn distance(support: &Support, grid: &[DVec3], p: DVec3) -> f64 {
    let at = |n: DVec3| support(n) - n.dot(p);
    let mut tried: Vec<(f64, DVec3)> = grid.iter().map(|n| (at(*n), *n)).collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Inside, where the nearest faces are equally near, several valleys are to be searched.
    let mut least = f64::INFINITY;
    for &(value, n) in &tried[..3] {
        let (mut best, mut n, mut step) = (value, n, 0.2);
        while step > 1e-5 {
            let (u, v) = n.any_orthonormal_pair();
            let tried = [u, -u, v, -v, u + v, u - v, v - u, -u - v].map(|d| (n + step * d).normalize());
            match tried.into_iter().map(|n| (at(n), n)).min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((value, next)) if value < best => (best, n) = (value, next),
                _ => step *= 0.6,
            }
        }
        least = least.min(best);
    }
    least
}

/// Directions that are spread evenly.
fn directions(count: usize) -> Vec<DVec3> {
    let turn = TAU / 1.618_033_988_749_895;
    let direction = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * (turn * i as f64).cos(), r * (turn * i as f64).sin(), z)
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|d| [d, -d]);
    (0..count).map(direction).chain(axes).collect()
}

#[test]
fn convex_primitives_are_the_distance() {
    let mut random = Random::new(701);
    let grid = directions(300);
    for (name, solid, support) in convex(&mut random) {
        let mut witnessed = 0;
        for i in 0..24 {
            let p = random.vector(-1.0, 1.0) * if i % 2 == 0 { 0.6 } else { 3.0 };
            let got = value(&solid, p);
            // No direction is below the distance.
            for &n in &grid {
                assert!(got <= support(n) - n.dot(p) + 1e-12, "{name} at {p}: {got}, bound along {n}");
            }
            let slope = solid.gradient(p).unwrap();
            if (slope.length() - 1.0).abs() > 1e-9 {
                continue;
            }
            // The direction of the nearest point attains it.
            let n = -slope.normalize();
            near(got, support(n) - n.dot(p), 1e-9);
            witnessed += 1;
            // And that point is of the solid.
            let nearest = p + got * n;
            near(value(&solid, nearest), 0.0, 1e-9);
            assert!(grid.iter().all(|n| n.dot(nearest) <= support(*n) + 1e-9), "{name} at {p}: {nearest}");
        }
        assert!(witnessed >= 20, "{name}: {witnessed}");
    }
}

#[test]
fn boxes_of_turned_primitives_are_tight() {
    let mut random = Random::new(702);
    for (name, solid, support) in convex(&mut random) {
        let turn = random.rotation();
        let bounds = solid.rotate(turn).bounds().unwrap();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let [up, down] = [axis, -axis].map(|d| support(turn.inverse() * d));
            let got = [bounds.max.dot(axis), -bounds.min.dot(axis)];
            for (got, want) in got.into_iter().zip([up, down]) {
                assert!(got >= want - 1e-12 && got <= want + 1e-9, "{name}: {got}, want {want}");
            }
        }
        let bounds = solid.bounds().unwrap();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            near(bounds.max.dot(axis), support(axis), 1e-12);
            near(-bounds.min.dot(axis), support(-axis), 1e-12);
        }
    }
}

#[test]
fn a_torus_is_the_distance() {
    let mut random = Random::new(703);
    for _ in 0..30 {
        let radius = random.range(0.3, 1.0);
        let tube = radius * random.range(0.1, 1.0);
        let ring = Solid::from(Torus { radius, tube });
        let p = random.vector(-2.0, 2.0);
        let nearest = (0..4000).map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 4000.0).sin_cos();
            p.distance(radius * DVec3::new(cos, sin, 0.0))
        });
        near(value(&ring, p), tube - nearest.fold(f64::INFINITY, f64::min), 1e-5);
    }
    let bounds = Solid::torus(2.0, 0.5).rotate_x(deg(90.0)).bounds().unwrap();
    assert!((bounds.max - DVec3::new(2.5, 0.5, 2.5)).abs().max_element() < 1e-9);
}

#[test]
fn an_ellipsoid_is_a_bound_of_the_distance_and_better_than_its_gauge() {
    let mut random = Random::new(704);
    let grid = directions(300);
    for _ in 0..40 {
        let a = random.vector(0.1, 1.0);
        let (solid, gauge) = (Solid::from(Ellipsoid { semi_axes: a }), Solid::superellipsoid(a, 1.0, 1.0));
        let support: Support = Box::new(move |n| (a * n).length());
        for _ in 0..10 {
            let p = random.vector(-1.5, 1.5);
            let (got, want) = (value(&solid, p), distance(&support, &grid, p));
            assert!(got.abs() <= want.abs() + 1e-6 && got * want >= -1e-9, "{a} at {p}: {got}, distance {want}");
            assert!(got.abs() >= value(&gauge, p).abs() - 1e-12);
            assert!(solid.gradient(p).unwrap().length() <= 1.0 + 1e-9);
        }
    }
}

#[test]
fn slabs_and_flats() {
    let mut random = Random::new(705);
    for _ in 0..20 {
        let n = random.direction();
        let slab = Solid::from(Slab { normal: 3.0 * n, thickness: 0.6 });
        let p = random.vector(-2.0, 2.0);
        near(value(&slab, p), 0.3 - n.dot(p).abs(), 1e-14);
    }
    let bounds = Solid::slab(DVec3::NEG_Z, 2.0).bounds().unwrap();
    near(bounds.min.z, -1.0, 1e-12);
    near(bounds.max.z, 1.0, 1e-12);
    assert!(bounds.max.x.is_infinite());
    let nut = Prism::across_flats(6, 10.0, 5.0);
    near(nut.inscribed_radius(), 5.0, 1e-14);
    near(nut.radius(), 10.0 / 3f64.sqrt(), 1e-14);
    near(value(&nut.into(), DVec3::Y * 7.0), -2.0, 1e-12);
}

#[test]
fn wrong_parameters_are_named() {
    let cases: [(Solid, &str); 10] = [
        (Solid::rounded_cuboid(DVec3::ONE, 0.6), "rounded box: radius is 0.6, allowed: 0 to 0.5"),
        (Solid::cone(0.0, 0.0, 1.0), "cone: bottom_radius is 0, allowed: 0.000000001 to 1000000000"),
        (Solid::cone(-1.0, 0.0, 1.0), "cone: bottom_radius is -1, allowed: 0 to 1000000000"),
        (Solid::capsule(1.0, 1.5), "capsule: height is 1.5, allowed: 2 to 1000000000"),
        (Solid::torus(1.0, 2.0), "torus: tube is 2, allowed: 0.000000001 to 1"),
        (Solid::prism(2, 1.0, 1.0), "prism: sides is 2, allowed: 3 to 1000"),
        (Solid::prism(u32::MAX, 1.0, 1.0), "prism: sides is 4294967295, allowed: 3 to 1000"),
        (Solid::pyramid(0, 1.0, 1.0), "pyramid: sides is 0, allowed: 3 to 1000"),
        (Solid::slab(DVec3::ZERO, 1.0), "slab: normal is 0, allowed: a finite vector other than zero"),
        (Solid::wedge(DVec3::NAN), "wedge: size.x is NaN, allowed: 0.000000001 to 1000000000"),
    ];
    for (solid, text) in cases {
        assert_eq!(solid.bounds().unwrap_err().to_string(), text);
    }
}
