//! Taper, twist and bend against the forward maps, written out here on their own.

use glam::{DMat3, DVec3};
use rvachev::{Bounds, CellSize, MeshSettings, Solid, Superellipsoid, deg, rad};

use crate::support::{Random, near, near_point, random_box, samples, value};

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

fn taper(p: DVec3, kx: f64, ky: f64, half_height: f64) -> DVec3 {
    let t = (p.z / half_height).clamp(-1.0, 1.0);
    DVec3::new(p.x * (1.0 + kx * t), p.y * (1.0 + ky * t), p.z)
}

fn twist(p: DVec3, rate: f64) -> DVec3 {
    let (sin, cos) = (rate * p.z).sin_cos();
    DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z)
}

fn bend(p: DVec3, k: f64, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    let left = 1.0 - k * (p.x * cos + p.y * sin);
    let half = 0.5 * k * p.z;
    let shift = left * p.z * half.sin() * sinc(half);
    DVec3::new(p.x + cos * shift, p.y + sin * shift, left * p.z * sinc(k * p.z))
}

/// The pre-image of `image` under a deformation of solids, found from its distances to the
/// centres of four deformed balls.
fn pre_image(deform: &dyn Fn(Solid) -> Solid, image: DVec3) -> DVec3 {
    const RADIUS: f64 = 0.125;
    let squared = |centre: DVec3| {
        let ball = deform(Solid::sphere(RADIUS).translate(centre));
        (RADIUS - value(&ball, image)).powi(2)
    };
    let origin = squared(DVec3::ZERO);
    DVec3::from_array([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| origin - squared(0.5 * axis) + 0.25))
}

/// The Jacobian of the inverse map at `image`, by differences of fourth order.
fn inverse_jacobian(deform: &dyn Fn(Solid) -> Solid, image: DVec3) -> DMat3 {
    const H: f64 = 2e-3;
    let column = |axis: DVec3| {
        let at = |steps: f64| pre_image(deform, image + steps * H * axis);
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * H)
    };
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// The largest singular value, by repeated squaring of AᵀA.
fn largest_stretch(a: &DMat3) -> f64 {
    let gram = a.transpose() * *a;
    let mut power = gram;
    for _ in 0..40 {
        let size = power.to_cols_array().iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let scaled = power * (1.0 / size);
        power = scaled * scaled;
    }
    let start = power.x_axis + 0.7 * power.y_axis + 0.3 * power.z_axis;
    let v = start.normalize();
    (a.mul_vec3(v)).length()
}

#[test]
fn a_bend_at_known_points() {
    let p = DVec3::new(0.3, -0.2, 1.5);
    for (k, image) in [
        (0.6, DVec3::new(0.696758009844, 0.270287132591, 1.273755738266)),
        (-0.6, DVec3::new(-0.116561782390, -0.693761036518, 1.337333960492)),
    ] {
        near_point(bend(p, k, 0.87), image, 1e-12);
        let exact = bend(p, k, 0.87);
        near_point(pre_image(&|s| s.bend(k, rad(0.87)), exact), p, 2e-14);
    }
}

#[test]
fn a_bend_by_more_than_a_quarter_turn() {
    let p = DVec3::new(0.3, -0.2, 4.0);
    let image = bend(p, 0.6, 0.87);
    near_point(image, DVec3::new(2.121731058144, 1.959343112000, 1.098360201393), 1e-12);
    near_point(pre_image(&|s| s.bend(0.6, rad(0.87)), image), p, 1e-13);
}

#[test]
fn bends_of_any_curvature_round_trip() {
    let mut random = Random::new(3);
    for k in [0.6, -0.6, 1e-3, 1e-9, -1e-12, 1e-20, 0.0] {
        for _ in 0..40 {
            let p = DVec3::new(random.range(-0.5, 0.5), random.range(-0.7, 0.7), random.range(-2.0, 2.0));
            let angle = random.range(-3.0, 3.0);
            near_point(pre_image(&|s| s.bend(k, rad(angle)), bend(p, k, angle)), p, 3e-14);
        }
    }
}

#[test]
fn a_bend_the_other_way_round_is_the_same() {
    let solid = Solid::superellipsoid(DVec3::new(0.5, 0.7, 2.0), 0.4, 0.6);
    let (one, other) = (solid.bend(0.3, rad(0.5)), solid.bend(-0.3, rad(0.5 + std::f64::consts::PI)));
    let mut random = Random::new(31);
    for _ in 0..500 {
        let p = random.vector(-2.0, 2.0);
        near(value(&one, p), value(&other, p), 1e-13);
    }
}

#[test]
fn a_chain_of_all_three() {
    let p = DVec3::new(0.4, 0.5, 1.2);
    let image = bend(twist(taper(p, 0.5, -0.4, 2.0), 0.6), 0.3, 0.5);
    near_point(image, DVec3::new(0.304009419006, 0.717961296813, 1.024693146673), 1e-12);
    let deform = |s: Solid| s.taper(0.5, -0.4, 4.0).twist(rad(0.6)).bend(0.3, rad(0.5));
    near_point(pre_image(&deform, image), p, 2e-14);

    let leaf = Superellipsoid::new(DVec3::new(0.5, 0.7, 2.0), 0.4, 0.6);
    near(leaf.gauge(p), 0.955089524543, 1e-12);
    let deformed = deform(leaf.into());
    near(value(&deformed, image), leaf.inscribed_radius() * (1.0 - 0.955089524543), 1e-12);
}

#[test]
fn the_taper_is_held_beyond_its_ends() {
    let mut random = Random::new(32);
    for _ in 0..60 {
        let p = DVec3::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0), random.range(-4.0, 4.0));
        near_point(pre_image(&|s| s.taper(0.9, -0.99, 3.0), taper(p, 0.9, -0.99, 1.5)), p, 1e-13);
        near_point(pre_image(&|s| s.twist(rad(-2.5)), twist(p, -2.5)), p, 1e-13);
    }
}

#[test]
fn values_move_with_the_points() {
    let mut random = Random::new(33);
    let solid = Solid::superellipsoid(DVec3::new(0.5, 0.7, 1.0), 0.4, 0.6) | Solid::sphere(0.8);
    for _ in 0..120 {
        let p = DVec3::new(random.range(-0.7, 0.7), random.range(-0.7, 0.7), random.range(-1.2, 1.2));
        let want = value(&solid, p);
        near(value(&solid.taper(0.4, -0.6, 2.0), taper(p, 0.4, -0.6, 1.0)), want, 1e-13);
        near(value(&solid.twist(rad(1.7)), twist(p, 1.7)), want, 1e-13);
        near(value(&solid.bend(0.7, rad(2.0)), bend(p, 0.7, 2.0)), want, 1e-13);
    }
}

/// The volume of the mesh, which is within 0.1 % at this resolution.
fn volume(solid: &Solid) -> f64 {
    let settings = MeshSettings { cell: CellSize::LongestSide(200), ..MeshSettings::default() };
    solid.mesh(&settings).expect("the solid is bounded").volume()
}

#[test]
fn twist_and_centred_bend_keep_the_volume() {
    const VOLUME: f64 = 4.602563845486;
    const TAPERED: f64 = 4.335761223258;
    let solid = Solid::superellipsoid(DVec3::new(0.5, 0.7, 2.0), 0.4, 0.6);
    near(volume(&solid), VOLUME, 1e-3 * VOLUME);
    near(volume(&solid.taper(0.5, -0.4, 4.0)), TAPERED, 1e-3 * TAPERED);
    near(volume(&solid.twist(rad(0.6))), VOLUME, 1e-3 * VOLUME);
    near(volume(&solid.bend(0.3, rad(0.5))), VOLUME, 1e-3 * VOLUME);
}

#[test]
fn stretches_are_those_of_the_table() {
    let mut random = Random::new(6);
    for _ in 0..6 {
        let p = DVec3::new(random.range(-0.5, 0.5), random.range(-0.7, 0.7), random.range(-1.4, 1.4));

        let (kx, ky, height) = (0.5, -0.4, 2.0);
        let j = inverse_jacobian(&|s| s.taper(kx, ky, 2.0 * height), taper(p, kx, ky, height));
        let (sx, sy) = (1.0 + kx * p.z / height, 1.0 + ky * p.z / height);
        near(j.determinant() * sx * sy, 1.0, 1e-8);
        let bound = (1.0 / sx).max(1.0 / sy).max(1.0) + (kx / height * p.x / sx).hypot(ky / height * p.y / sy);
        assert!(largest_stretch(&j) <= bound + 1e-8);

        let rate = 1.3;
        let j = inverse_jacobian(&|s| s.twist(rad(rate)), twist(p, rate));
        near(j.determinant(), 1.0, 1e-8);
        let s = rate * p.truncate().length();
        near(largest_stretch(&j), 0.5 * (s + (s * s + 4.0).sqrt()), 1e-8);

        let (k, angle) = (0.6, 0.87f64);
        let j = inverse_jacobian(&|s| s.bend(k, rad(angle)), bend(p, k, angle));
        let h = 1.0 - k * (p.x * angle.cos() + p.y * angle.sin());
        near(j.determinant() * h, 1.0, 1e-8);
        near(largest_stretch(&j), (1.0 / h).max(1.0), 1e-8);
        // The other two are 1: so is the sum of squares but for the third.
        let squares: f64 = j.to_cols_array().iter().map(|v| v * v).sum();
        near(squares, 2.0 + 1.0 / (h * h), 1e-7);
    }
}

#[test]
fn gradients_are_pulled_back() {
    let mut random = Random::new(61);
    let solid = Solid::superellipsoid(DVec3::new(0.5, 0.7, 2.0), 0.4, 0.6);
    let deform = |s: Solid| s.taper(0.5, -0.4, 4.0).twist(rad(0.6)).bend(0.3, rad(0.5));
    let deformed = deform(solid.clone());
    for _ in 0..12 {
        let p = DVec3::new(random.range(-0.5, 0.5), random.range(-0.7, 0.7), random.range(-1.9, 1.9));
        let image = bend(twist(taper(p, 0.5, -0.4, 2.0), 0.6), 0.3, 0.5);
        let want = inverse_jacobian(&deform, image).transpose() * solid.gradient(p).unwrap();
        let got = deformed.gradient(image).unwrap();
        let cosine = got.dot(want) / (got.length() * want.length());
        assert!(1.0 - cosine < 1e-12, "at {p}: {got}, want {want}");
        near_point(got, want, 1e-7 * (1.0 + want.length()));
    }
}

#[test]
fn a_pipe_bent_between_heights_keeps_its_volume_and_its_straight_ends() {
    let pipe =
        Solid::cylinder(3.0, 60.0).translate([0.0, 0.0, 20.0]) - Solid::cylinder(2.0, 70.0).translate([0.0, 0.0, 20.0]);
    let settings = MeshSettings { cell: CellSize::Length(0.5), ..MeshSettings::default() };
    for turn in [40.0, 90.0, -135.0, 179.0] {
        let bent = pipe.bend_between(5.0, 35.0, deg(turn), deg(30.0));
        let mesh = bent.mesh(&settings).unwrap();
        assert!(mesh.check().is_closed(), "{turn}");
        near(mesh.volume(), std::f64::consts::PI * 5.0 * 60.0, 0.01 * 900.0);
        // The lower end stays; the upper one is turned, about the arc's centre, as it was.
        let middle = DVec3::new(2.5, 0.0, -9.0);
        near(value(&bent, middle), value(&pipe, middle), 1e-12);
        let (radius, gamma, u) =
            (30.0 / f64::to_radians(turn), f64::to_radians(turn), DVec3::new(0.75f64.sqrt(), 0.5, 0.0));
        let moved = |p: DVec3| {
            let (r, beyond) = (p.dot(u), p.z - 35.0);
            let across = radius - (radius - r) * gamma.cos() + beyond * gamma.sin();
            p.with_z(5.0 + (radius - r) * gamma.sin() + beyond * gamma.cos()) + (across - r) * u
        };
        for p in [DVec3::new(2.4, 0.3, 48.0), DVec3::new(0.0, 0.2, 36.0), DVec3::new(-3.4, 1.0, 50.5)] {
            near(value(&bent, moved(p)), value(&pipe, p), 1e-10);
        }
    }
}

#[test]
fn a_bend_between_heights_that_does_not_fit_says_what_would() {
    let rod = Solid::cylinder(2.0, 60.0);
    let error = |from, to, turn: f64| rod.bend_between(from, to, deg(turn), deg(0.0)).bounds().unwrap_err().to_string();
    let text = error(-1.0, 1.0, 90.0);
    assert!(text.contains("bend_between: turn is 90, allowed: below 57.2958 degrees"), "{text}");
    let text = error(-10.0, 10.0, -240.0);
    assert!(text.contains("turn is -239.99") && text.contains("ends must not meet"), "{text}");
    let limit: f64 = text.split("below ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((180.0..240.0).contains(&limit), "{text}");
    assert!(rod.bend_between(-10.0, 10.0, deg(limit - 0.01), deg(0.0)).bounds().is_ok());
    let text = error(3.0, 3.0, 10.0);
    assert!(text.contains("to is 3") && text.contains("above from"), "{text}");
}

/// Behind the centre of a bend its angle jumps by a turn, which no slope tells.
#[test]
fn ranges_hold_what_jumps_behind_the_centre_of_a_bend() {
    let rod = Solid::superellipsoid([0.4, 0.3, 1.5], 0.7, 0.8).rotate_x(deg(20.0));
    let mut random = Random::new(1413);
    for bent in [rod.bend(0.5, deg(0.0)), rod.bend_between(-1.0, 1.0, deg(60.0), deg(0.0))] {
        let program = bent.surface_program().unwrap();
        let beyond = Bounds::from_center(DVec3::new(5.0, 0.0, 0.0), DVec3::splat(4.0));
        for _ in 0..200 {
            let cell = random_box(&mut random, &beyond);
            let range = program.range(&cell);
            for p in samples(&mut random, &cell, 30) {
                let value = program.value(p);
                assert!(range.contains(value), "{value} at {p} is not in {range:?} of {cell:?}");
            }
        }
    }
}
