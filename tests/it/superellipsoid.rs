//! Superellipsoids against figures computed with 50 digits, and the bounds that hold for them.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};
use rvachev::{Bounds, Solid, Superellipsoid};

use crate::support::{Random, lanes32, lanes64, near, near_point, value};

/// The point at latitude `h` and longitude `w`.
fn surface_point(a: DVec3, [e1, e2]: [f64; 2], h: f64, w: f64) -> DVec3 {
    let spow = |x: f64, e: f64| x.abs().powf(e).copysign(x);
    let across = spow(h.cos(), e1);
    a * DVec3::new(across * spow(w.cos(), e2), across * spow(w.sin(), e2), spow(h.sin(), e1))
}

/// Points of the surface, one along every ray of a grid on a cube.
fn surface(leaf: &Superellipsoid, across: u32) -> Vec<DVec3> {
    let mut points = Vec::new();
    for face in 0..6u32 {
        for i in 0..=across {
            for j in 0..=across {
                let at = |n: u32| 2.0 * f64::from(n) / f64::from(across) - 1.0;
                let side = if face % 2 == 0 { 1.0 } else { -1.0 };
                let mut p = [side, at(i), at(j)];
                p.rotate_right(face as usize / 2);
                let p = DVec3::from_array(p) * leaf.semi_axes();
                points.push(p / leaf.gauge(p));
            }
        }
    }
    points
}

fn nearest(points: &[DVec3], p: DVec3) -> f64 {
    points.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt()
}

#[test]
fn a_known_point() {
    let leaf = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 0.5, 1.5);
    let p = DVec3::new(0.3, -0.4, 1.1);
    let gauge = 0.47327047558333357;
    near(leaf.gauge(p), gauge, 1e-15);
    near(leaf.barr(p), 0.0501692547171, 1e-12);
    near(leaf.solina(p), 0.2239849430589, 1e-12);
    near(leaf.f1(p), 1.0 - 0.2239849430589, 1e-12);
    near(leaf.f2(p), 1.0 - gauge, 1e-15);
    near(leaf.radial_distance(p), p.length() * (1.0 - 1.0 / gauge), 1e-14);

    let solid = Solid::from(leaf);
    let scale = leaf.inscribed_radius();
    near(value(&solid, p), scale * (1.0 - gauge), 1e-15);
    let slope = DVec3::new(0.637765359785, -0.278569679697, 0.155011814335);
    near_point(solid.gradient(p).unwrap(), -scale * slope, 1e-12);
    // The gauge is homogeneous of degree 1.
    near(p.dot(slope), gauge, 1e-11);
}

#[test]
fn steep_powers_neither_overflow_nor_vanish() {
    let solid = Solid::superellipsoid(DVec3::ONE, 0.01, 0.01);
    let points = [DVec3::new(30.0, 20.0, 40.0), DVec3::new(0.01, 0.02, 0.015)];
    let gauges = [40.0, 0.02];
    let program = solid.field_program().unwrap();
    let region = Bounds::from_center(DVec3::ZERO, DVec3::splat(40.0));
    let double = lanes64(&program, &region, &points);
    let (_, single) = lanes32(&program, &region, &points);
    for i in 0..2 {
        let want = 1.0 - gauges[i];
        near(value(&solid, points[i]), want, 1e-12 * gauges[i]);
        near(double[i], want, 1e-12 * gauges[i]);
        near(single[i], want, 1e-6 * gauges[i].max(1.0));
    }
}

#[test]
fn inscribed_and_circumscribed_radius_and_box() {
    let leaf = Superellipsoid::new(DVec3::new(1.3, 0.7, 2.1), 0.3, 1.7);
    near(leaf.inscribed_radius(), 0.6624614203134, 1e-12);
    near(leaf.circumscribed_radius(), 2.2731597980295, 1e-12);
    let points = surface(&leaf, 200);
    let (least, most) = points.iter().fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(p.length()), b.max(p.length())));
    assert!((0.0..2e-3).contains(&(least - leaf.inscribed_radius())), "{least}");
    assert!((0.0..2e-3).contains(&(leaf.circumscribed_radius() - most)), "{most}");

    let turn = DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 1.1));
    let bounds = Solid::from(leaf).rotate(turn).bounds().unwrap();
    let want = DVec3::new(1.170211876092, 1.957102763458, 2.188611407769);
    near_point(bounds.max, want, 1e-11);
    near_point(bounds.min, -want, 1e-11);
}

#[test]
fn boxes_hold_the_surface_and_touch_it() {
    let mut random = Random::new(5);
    for [e1, e2] in [[0.1, 0.1], [0.3, 1.7], [1.0, 1.0], [1.5, 0.6], [2.0, 2.0], [2.4, 0.5], [0.5, 2.5]] {
        let leaf = Superellipsoid::new(random.vector(0.3, 2.0), e1, e2);
        let turn = random.rotation();
        let bounds = Solid::from(leaf).rotate(turn).bounds().unwrap();
        let sampled = Bounds::from_points(surface(&leaf, 150).into_iter().map(|p| turn * p));
        assert!(bounds.contains_bounds(&sampled), "{leaf:?}");
        let gap = (sampled.min - bounds.min).max(bounds.max - sampled.max).max_element();
        assert!(gap < 0.03 * bounds.longest_side(), "{leaf:?}: {gap}");
    }
}

#[test]
fn the_value_and_the_radial_distance_enclose_the_distance() {
    const ACROSS: u32 = 90;
    let mut random = Random::new(8);
    for [e1, e2] in [[0.1, 0.1], [0.3, 0.7], [1.0, 1.0], [1.6, 0.5], [2.0, 2.0]] {
        let leaf = Superellipsoid::new(random.vector(0.5, 1.5), e1, e2);
        let (solid, points) = (Solid::from(leaf), surface(&leaf, ACROSS));
        // No point of the surface is farther from a sample than this.
        let spacing = 6.0 * leaf.circumscribed_radius() / f64::from(ACROSS);
        for _ in 0..250 {
            let p = random.vector(-2.5, 2.5);
            let distance = nearest(&points, p);
            assert!(value(&solid, p).abs() <= distance * (1.0 + 1e-12), "{leaf:?} at {p}");
            assert!(distance <= leaf.radial_distance(p).abs() + spacing, "{leaf:?} at {p}");
        }
    }
}

#[test]
fn the_slope_is_at_most_one_where_the_solid_is_convex() {
    let mut random = Random::new(81);
    for [e1, e2] in [[0.05, 0.4], [0.3, 0.7], [1.0, 1.0], [1.6, 0.5], [1.8, 2.0], [2.0, 2.0]] {
        let leaf = Superellipsoid::new(random.vector(0.5, 1.5), e1, e2);
        let solid = Solid::from(leaf);
        let points: Vec<DVec3> = (0..4000).map(|_| random.vector(-2.0, 2.0)).collect();
        let slopes: Vec<f64> = solid.gradients(&points).unwrap().iter().map(|g| g.length()).collect();
        let most = slopes.iter().copied().fold(0.0, f64::max);
        assert!(most <= 1.0 + 1e-12, "{leaf:?}: {most}");
        // The factor is the best one: somewhere the slope comes close to 1.
        assert!(most > 0.9, "{leaf:?}: {most}");
        for pair in points.windows(2) {
            let change = (value(&solid, pair[0]) - value(&solid, pair[1])).abs();
            assert!(change <= pair[0].distance(pair[1]) * (1.0 + 1e-12), "{leaf:?}");
        }
    }
}

#[test]
fn parametric_points_are_on_the_surface() {
    let a = DVec3::new(1.0, 2.0, 3.0);
    for [e1, e2] in [[0.01, 0.01], [3.0, 2.5], [0.3, 0.7], [1.0, 1.0], [2.0, 2.0]] {
        let leaf = Superellipsoid::new(a, e1, e2);
        for i in 0..1000 {
            // Angles that spread over the octant without a pattern.
            let (u, v) = ((f64::from(i) * 0.618_033_988_7) % 1.0, (f64::from(i) * 0.754_877_666_2) % 1.0);
            let p = surface_point(a, [e1, e2], (u - 0.5) * PI, (v - 0.5) * 2.0 * PI);
            near(leaf.gauge(p), 1.0, 1e-14);
        }
    }
}

#[test]
fn the_range_over_a_box_along_the_axes_is_exact() {
    let mut random = Random::new(33);
    for _ in 0..300 {
        let leaf = Superellipsoid::new(random.vector(0.3, 2.0), random.range(0.05, 2.5), random.range(0.05, 2.5));
        let bounds = Bounds::from_corners(random.vector(-2.0, 2.0), random.vector(-2.0, 2.0));
        let range = Solid::from(leaf).range(&bounds).unwrap();
        let near_side = bounds.distance_to_axes();
        let far_side = bounds.min.abs().max(bounds.max.abs());
        let scale = leaf.inscribed_radius();
        near(range.hi(), scale * (1.0 - leaf.gauge(near_side)), 1e-12 * (1.0 + scale * leaf.gauge(near_side)));
        near(range.lo(), scale * (1.0 - leaf.gauge(far_side)), 1e-12 * (1.0 + scale * leaf.gauge(far_side)));
    }
}

trait Nearest {
    /// The least |x|, |y| and |z| of the box's points.
    fn distance_to_axes(&self) -> DVec3;
}

impl Nearest for Bounds {
    fn distance_to_axes(&self) -> DVec3 {
        self.min.max(-self.max).max(DVec3::ZERO)
    }
}

#[test]
fn the_gradient_is_known_at_planes_axes_and_centre() {
    for [e1, e2] in [[0.1, 0.1], [0.3, 0.7], [1.0, 1.0], [1.5, 1.2]] {
        let solid = Solid::superellipsoid(DVec3::ONE, e1, e2);
        // Smooth across the axis planes: the component across one is 0 there.
        let on_plane = solid.gradient(DVec3::new(0.0, 0.5, 0.7)).unwrap();
        assert_eq!(on_plane.x, 0.0, "{e1} {e2}");
        let on_axis = solid.gradient(DVec3::new(0.0, 0.0, 0.7)).unwrap();
        assert_eq!((on_axis.x, on_axis.y), (0.0, 0.0), "{e1} {e2}");
        assert!(on_axis.z < 0.0);
        let centre = solid.gradient(DVec3::ZERO).unwrap();
        assert!(centre.is_finite(), "{centre}");
        near(value(&solid, DVec3::ZERO), 1.0 / slope_bound(e1, e2), 1e-12);
    }
}

/// The largest slope of the gauge of a superellipsoid with semi-axes 1.
fn slope_bound(e1: f64, e2: f64) -> f64 {
    let pair = |a: f64, b: f64, e: f64| {
        if e <= 1.0 {
            a.max(b)
        } else {
            let s = 2.0 / (e - 1.0);
            (a.powf(s) + b.powf(s)).powf(1.0 / s)
        }
    };
    pair(pair(1.0, 1.0, e2), 1.0, e1)
}

#[test]
fn special_exponents_are_the_well_known_solids() {
    let p = DVec3::new(0.3, -0.5, 0.9);
    let sphere = Superellipsoid::new(DVec3::ONE, 1.0, 1.0);
    near(sphere.gauge(p), p.length(), 1e-15);
    let octahedron = Superellipsoid::new(DVec3::ONE, 2.0, 2.0);
    near(octahedron.gauge(p), p.abs().element_sum(), 1e-15);
    near(octahedron.inscribed_radius(), 1.0 / 3f64.sqrt(), 1e-15);
    // Close to a box of the same half sides.
    let brick = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 0.01, 0.01);
    near(brick.gauge(DVec3::new(0.9, 0.2, 0.3)), 0.9, 1e-12);
    near(brick.inscribed_radius(), 1.0, 0.0);
    // Round about z.
    let round = Superellipsoid::new(DVec3::ONE, 0.4, 1.0);
    let turned = DQuat::from_rotation_z(FRAC_PI_2 / 3.0) * p;
    near(round.gauge(p), round.gauge(turned), 1e-15);
}
