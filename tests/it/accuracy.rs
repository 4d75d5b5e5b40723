//! How far lanes of f32 are from the f64 reference, over random points and parameters.
//!
//! Each test prints its worst figure as a part of the bound; `cargo test -- --nocapture
//! accuracy` shows them.

use glam::DVec3;
use rvachev::{
    Bounds, Cuboid, Cylinder, GeneralisedSuperquadric, Gielis, Solid, Sphere, Superellipsoid, Superhyperboloid,
    Supershape, Supertoroid, Turns,
    program::{Evaluator, Tape},
    rad,
};

use crate::support::{Random, rounded};

const BOUND: f64 = 4e-6;

/// Points from the centre to ten sizes away, many of them near the surface, on the axis
/// planes, and at exact zeros.
fn points(random: &mut Random, solid: &Solid, half: DVec3, count: usize) -> Vec<DVec3> {
    let size = half.max_element();
    let mut points = vec![DVec3::ZERO];
    while points.len() < count {
        let mut p = match random.below(4) {
            // In the solid's own box, which may be flat.
            0 => half * random.vector(-1.2, 1.2),
            1 => size * random.log_range(1e-4, 10.0) * random.direction(),
            _ => size * random.range(0.0, 10.0) * random.direction(),
        };
        for axis in 0..3 {
            if random.chance(0.08) {
                p[axis] = 0.0;
            }
        }
        if random.chance(0.3) {
            // A few steps along the gradient lead to the surface, or close to it.
            for _ in 0..3 {
                let (v, g) = (solid.value(p).unwrap(), solid.gradient(p).unwrap());
                let step = v / g.length_squared().max(1e-3) * g;
                p -= step.clamp_length_max(size);
            }
        }
        points.push(p.clamp(DVec3::splat(-10.0 * size), DVec3::splat(10.0 * size)));
    }
    points
}

/// The largest error relative to `size + |f|`, with its solid and point.
struct Worst {
    error: f64,
    at: String,
    points: usize,
}

impl Worst {
    fn new() -> Worst {
        Worst { error: 0.0, at: String::new(), points: 0 }
    }

    fn learn(&mut self, solid: &Solid, points: &[DVec3], region: &Bounds, size: f64, condition: f64) {
        let program = solid.field_program().unwrap();
        let tape = Tape::new(&program, region);
        let (seen, [x, y, z]) = rounded(points, tape.origin());
        let mut values = vec![0.0f32; seen.len()];
        Evaluator::new().values(&tape, &x, &y, &z, &mut values).unwrap();
        for (p, got) in seen.into_iter().zip(values) {
            let want = program.value(p);
            assert!(want.is_finite() && got.is_finite(), "{solid:?} at {p}: {got}, want {want}");
            let error = (f64::from(got) - want).abs() / (condition * (size + want.abs()));
            if error > self.error {
                self.error = error;
                self.at = format!("{solid:?} at {p}: {got:e}, want {want:e}");
            }
            self.points += 1;
        }
    }

    #[track_caller]
    fn finish(&self, name: &str) {
        println!("{name}: {:.2e} over {} points, {:.2} of the bound", self.error, self.points, self.error / BOUND);
        assert!(self.error <= BOUND, "{name}: {:.3e}, {}", self.error, self.at);
    }
}

fn cube(half: f64) -> Bounds {
    Bounds::from_center(DVec3::ZERO, DVec3::splat(half))
}

#[test]
fn superellipsoids() {
    let mut random = Random::new(13);
    let mut worst = Worst::new();
    for _ in 0..350 {
        let size = random.log_range(1e-3, 1e3);
        let axes = DVec3::from_array([0; 3].map(|_| size * random.log_range(0.05, 1.0)));
        let mut exponent =
            || if random.chance(0.2) { random.pick(&[0.05, 1.0, 2.0, 2.5]) } else { random.range(0.05, 2.5) };
        let leaf = Superellipsoid::new(axes, exponent(), exponent());
        let solid = Solid::from(leaf);
        let size = axes.max_element();
        let points = points(&mut random, &solid, axes, 2500);
        worst.learn(&solid, &points, &cube(10.0 * size), size, 1.0);
    }
    worst.finish("superellipsoids");
}

#[test]
fn superellipsoids_of_any_proportions() {
    let mut random = Random::new(14);
    let mut worst = Worst::new();
    for _ in 0..60 {
        let axes = DVec3::from_array([0; 3].map(|_| random.log_range(1e-3, 1e3)));
        let leaf = Superellipsoid::new(axes, random.range(0.05, 2.5), random.range(0.05, 2.5));
        let solid = Solid::from(leaf);
        let points = points(&mut random, &solid, axes, 2000);
        worst.learn(&solid, &points, &cube(10.0 * axes.max_element()), axes.max_element(), 1.0);
    }
    worst.finish("superellipsoids of any proportions");
}

/// A superquadric with semi-axes of any proportions, its solid and half-extents.
fn superquadric(random: &mut Random, kind: usize) -> (Solid, DVec3) {
    let size = random.log_range(1e-3, 1e3);
    let axes = DVec3::from_array([0; 3].map(|_| size * random.log_range(0.05, 1.0)));
    let [e1, e2] = [0; 2].map(|_| {
        let most = if kind == 0 { 2.0 } else { 2.5 };
        if random.chance(0.2) { random.pick(&[0.05, 1.0, most]) } else { random.range(0.05, most) }
    });
    let longer = random.log_range(1.01, 5.0);
    let solid: Solid = match kind {
        0 => Supertoroid::new(axes, random.log_range(1.0, 10.0), e1, e2).into(),
        1 => Superhyperboloid::one_sheet(axes, e1, e2, 2.0 * axes.z * random.log_range(0.1, 5.0)).into(),
        2 => Superhyperboloid::two_sheets(axes, e1, e2, 2.0 * axes.z * longer).into(),
        3 => Superhyperboloid::two_sheets_x(axes, e1, e2, 2.0 * axes.x * longer).into(),
        _ => {
            let n = [0; 3].map(|_| {
                if random.chance(0.2) { random.pick(&[0.5, 1.0, 2.0, 60.0]) } else { random.log_range(0.5, 60.0) }
            });
            GeneralisedSuperquadric::new(axes, n).into()
        }
    };
    let half = solid.bounds().unwrap().half_extents();
    (solid, half)
}

#[test]
fn superquadrics() {
    let names = ["supertoroids", "one sheet", "two sheets", "two sheets along x", "generalised superquadrics"];
    let mut random = Random::new(19);
    for (kind, name) in names.into_iter().enumerate() {
        let mut worst = Worst::new();
        for _ in 0..60 {
            let (solid, half) = superquadric(&mut random, kind);
            let points = points(&mut random, &solid, half, 1000);
            worst.learn(&solid, &points, &cube(10.0 * half.max_element()), half.max_element(), 1.0);
        }
        worst.finish(name);
    }
}

#[test]
fn primitives() {
    let mut random = Random::new(15);
    let mut worst = Worst::new();
    for i in 0..60 {
        let mut size = || random.log_range(1e-3, 1e3);
        let [a, b, c] = [size(), size(), size()];
        let (solid, half): (Solid, DVec3) = match i % 4 {
            0 => (Sphere { radius: a }.into(), DVec3::splat(a)),
            1 => (Cuboid { size: DVec3::new(a, b, c) }.into(), 0.5 * DVec3::new(a, b, c)),
            2 => (Cylinder { radius: a, height: b }.into(), DVec3::new(a, a, 0.5 * b)),
            _ => (Solid::half_space(random.direction(), a), DVec3::splat(a)),
        };
        let points = points(&mut random, &solid, half, 2500);
        worst.learn(&solid, &points, &cube(10.0 * half.max_element()), half.max_element(), 1.0);
    }
    worst.finish("primitives");
}

#[test]
fn exact_primitives() {
    let mut random = Random::new(19);
    let mut worst = Worst::new();
    for _ in 0..150 {
        let scale = random.log_range(1e-3, 1e3);
        let (solid, size) = crate::primitives::random_primitive(&mut random);
        let bounds = solid.bounds().unwrap();
        let half = if bounds.is_finite() { scale * bounds.max.max(-bounds.min) } else { DVec3::splat(scale * size) };
        let solid = solid.scale(scale);
        let size = half.max_element();
        let points = points(&mut random, &solid, half, 1000);
        worst.learn(&solid, &points, &cube(10.0 * size), size, 1.0);
    }
    worst.finish("exact primitives");
}

#[test]
fn lattices() {
    let mut random = Random::new(20);
    let mut worst = Worst::new();
    for _ in 0..40 {
        let cell = random.log_range(1e-3, 1e3);
        let solid = crate::lattices::random_lattice(&mut random).scale(cell);
        let points = points(&mut random, &solid, DVec3::splat(cell), 1000);
        worst.learn(&solid, &points, &cube(10.0 * cell), cell, 1.0);
    }
    worst.finish("lattices");
}

#[test]
fn supershapes() {
    let mut random = Random::new(16);
    for rational in [false, true] {
        let mut worst = Worst::new();
        for i in 0..60 {
            let mut curve = || {
                let n1 = random.log_range(0.5, 40.0);
                // Below 1 the radius has infinite slope at the corners: no digits are left there.
                let mut n = || (n1 * random.log_range(0.2, 5.0)).max(1.0);
                let (n2, n3) = (n(), n());
                Gielis::new(random.below(13) as f64, n1, n2, n3)
            };
            let (mut equator, meridian) = (curve(), curve());
            if i % 3 == 2 {
                equator =
                    Gielis { m: equator.m / 3.0, ..equator }.with_turns(random.pick(&[Turns::Outer, Turns::Inner]));
            }
            let scale = random.log_range(1e-3, 1e3);
            let scale = DVec3::from_array([0; 3].map(|_| scale * random.range(0.3, 1.0)));
            let shape = Supershape::new(equator, meridian).scaled(scale);
            let solid = Solid::from(if rational { shape.rational() } else { shape });
            let half = solid.bounds().unwrap().half_extents();
            let size = half.max_element();
            let condition = [equator, meridian].iter().map(|c| c.n2.max(c.n3) / c.n1).fold(1.0, f64::max);
            let points = points(&mut random, &solid, half, 1500);
            worst.learn(&solid, &points, &cube(10.0 * size), size, condition);
        }
        worst.finish(if rational { "rational supershapes" } else { "supershapes" });
    }
}

#[test]
fn a_small_solid_far_away_is_as_accurate_as_at_the_origin() {
    let mut random = Random::new(17);
    let (mut here, mut there) = (Worst::new(), Worst::new());
    const SIZE: f64 = 1e-3;
    for _ in 0..60 {
        let leaf =
            Superellipsoid::new(SIZE * random.vector(0.3, 1.0), random.range(0.05, 2.5), random.range(0.05, 2.5));
        let turned = Solid::from(leaf).rotate(random.rotation());
        // A part of several leaves and maps, so that maps are chained.
        let part = (turned - Solid::cylinder(0.2 * SIZE, 4.0 * SIZE).rotate_x(rad(0.7))).scale(0.5).rotate_z(rad(1.0));
        let far = 1e3 * random.direction();
        for (solid, at, worst) in [(part.clone(), DVec3::ZERO, &mut here), (part.translate(far), far, &mut there)] {
            let region = Bounds::from_center(at, DVec3::splat(2.0 * SIZE));
            let points: Vec<DVec3> = (0..1000).map(|_| random.point_in(&region)).collect();
            worst.learn(&solid, &points, &region, SIZE, 1.0);
        }
    }
    here.finish("small solids at the origin");
    there.finish("small solids at distance 1000");
    // The reference itself rounds coordinates to 1e-13 out there.
    assert!(there.error <= here.error * 1.5 + 1e-9, "{:e} and {:e}", there.error, here.error);
}

#[test]
fn lanes_of_f64_are_as_accurate_far_away() {
    let mut random = Random::new(18);
    let part = (Solid::superellipsoid(DVec3::splat(1e-3), 0.3, 0.7) - Solid::sphere(8e-4)).rotate_x(rad(0.4));
    let far = 1e3 * random.direction();
    let program = part.translate(far).field_program().unwrap();
    let tape = Tape::new(&program, &Bounds::from_center(far, DVec3::splat(2e-3)));
    for _ in 0..1000 {
        let p = random.vector(-2e-3, 2e-3);
        let mut value = [0.0];
        Evaluator::new().values_f64(&tape, &[p.x], &[p.y], &[p.z], &mut value).unwrap();
        // The origin of the region is that of the part but for its rounding.
        let want = part.value(p + (tape.origin() - far)).unwrap();
        assert!((value[0] - want).abs() < 1e-9 * 1e-3, "{} at {p}, want {want}", value[0]);
    }
}
