//! Questions to a solid, against closed forms.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::DVec3;
use rvachev::{
    Bounds, Profile, RFunction, Solid, Superellipsoid, deg,
    program::{Evaluator, Gradients, Tape},
    rad,
};

use crate::support::{Random, corpus, frame_of, near, near_point, random_solid, value};

/// The distances at which a ray enters and leaves a sphere about the origin.
fn sphere_hits(origin: DVec3, direction: DVec3, radius: f64) -> Option<(f64, f64)> {
    let along = -origin.dot(direction);
    let squared = radius * radius - (origin.length_squared() - along * along);
    (squared >= 0.0).then(|| (along - squared.sqrt(), along + squared.sqrt()))
}

/// The same for a box about the origin.
fn box_hits(origin: DVec3, direction: DVec3, half: DVec3) -> Option<(f64, f64)> {
    let (a, b) = ((-half - origin) / direction, (half - origin) / direction);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter <= leave).then_some((enter, leave))
}

#[test]
fn rays_meet_a_sphere_where_the_formula_says() {
    let ball = Solid::sphere(1.5);
    let mut random = Random::new(1);
    let mut hits = 0;
    for _ in 0..600 {
        let origin = random.vector(-4.0, 4.0);
        let direction = (random.vector(-2.0, 2.0) - origin).normalize();
        let want = sphere_hits(origin, direction, 1.5).and_then(|(enter, leave)| {
            if enter > 0.0 {
                Some(enter)
            } else if leave > 0.0 {
                Some(leave)
            } else {
                None
            }
        });
        // The direction need not be of unit length.
        let hit = ball.raycast(origin, direction * random.log_range(1e-3, 1e3)).unwrap();
        assert_eq!(hit.is_some(), want.is_some(), "{origin} {direction}");
        if let (Some(hit), Some(want)) = (hit, want) {
            hits += 1;
            near(hit.distance, want, 1e-11);
            near_point(hit.point, origin + want * direction, 1e-11);
            near_point(hit.normal, hit.point / 1.5, 1e-10);
        }
    }
    assert!(hits > 150, "{hits}");
}

#[test]
fn rays_meet_a_box_where_the_formula_says() {
    let half = DVec3::new(1.0, 0.5, 2.0);
    let block = Solid::cuboid(2.0 * half);
    let mut random = Random::new(2);
    for _ in 0..600 {
        let origin = random.vector(-4.0, 4.0);
        let direction = (random.vector(-2.0, 2.0) - origin).normalize();
        let want = box_hits(origin, direction, half).and_then(|(enter, leave)| match () {
            () if enter > 0.0 => Some(enter),
            () if leave > 0.0 => Some(leave),
            () => None,
        });
        let hit = block.raycast(origin, direction).unwrap();
        assert_eq!(hit.is_some(), want.is_some(), "{origin} {direction}");
        if let (Some(hit), Some(want)) = (hit, want) {
            near(hit.distance, want, 1e-10);
            // Along one axis, out of the box.
            near(hit.normal.abs().max_element(), 1.0, 1e-9);
            assert!(hit.normal.dot(hit.point) > 0.0);
        }
    }
}

#[test]
fn rays_along_axes_and_planes() {
    let block = Solid::cuboid(DVec3::splat(2.0));
    let hit = block.raycast(DVec3::new(-5.0, 0.25, 0.5), DVec3::X).unwrap().expect("aimed at a face");
    near(hit.distance, 4.0, 1e-11);
    near_point(hit.normal, -DVec3::X, 1e-12);
    // From inside, the way out.
    let hit = block.raycast(DVec3::ZERO, DVec3::Z).unwrap().expect("a way out");
    near(hit.distance, 1.0, 1e-11);
    near_point(hit.normal, DVec3::Z, 1e-12);
    // Past it, away from it, and nowhere.
    assert_eq!(block.raycast(DVec3::new(-5.0, 1.5, 0.0), DVec3::X), Ok(None));
    assert_eq!(block.raycast(DVec3::new(-5.0, 0.0, 0.0), -DVec3::X), Ok(None));
}

#[test]
fn rays_find_the_first_of_many_crossings() {
    // A stack of thin plates, and a hole through some of them.
    let plates = (0..20).map(|i| Solid::cuboid(DVec3::new(2.0, 2.0, 1e-3)).translate(DVec3::Z * 0.1 * f64::from(i)));
    let stack = Solid::union_all(plates, RFunction::P(2.0)) - Solid::cylinder(0.3, 2.1).translate(DVec3::Z * 1.9);
    let from = DVec3::new(0.7, 0.1, 9.0);
    let hit = stack.raycast(from, -DVec3::Z).unwrap().expect("a plate");
    near(hit.point.z, 1.9005, 1e-10);
    // Down the hole, whose bottom is at 0.85.
    let hit = stack.raycast(DVec3::new(0.1, 0.1, 9.0), -DVec3::Z).unwrap().expect("a plate below the hole");
    near(hit.point.z, 0.8005, 1e-10);
    near_point(hit.normal, DVec3::Z, 1e-9);
}

#[test]
fn hits_are_on_the_surface_and_nothing_is_before_them() {
    let mut random = Random::new(3);
    for _ in 0..60 {
        let depth = random.below(3);
        let mut solid = random_solid(&mut random, depth);
        // Along a deformed half-space that never ends there is no end of pieces to look at.
        if !solid.bounds().unwrap().is_finite() {
            solid &= Solid::sphere(4.0);
        }
        let program = solid.surface_program().unwrap();
        for _ in 0..6 {
            let (origin, direction) = (random.vector(-3.0, 3.0), random.direction());
            let inside = solid.contains(origin).unwrap();
            let hit = solid.raycast(origin, direction).unwrap();
            let end = hit.map_or(6.0, |hit| hit.distance);
            for i in 1..100 {
                let t = end * f64::from(i) / 100.0 * 0.999_999;
                let v = program.value(origin + t * direction);
                // What only touches the surface is allowed for.
                assert!(
                    (v > 0.0) == inside || v.abs() < 1e-9,
                    "{solid:?}: {v:e} at {t} from {origin} along {direction}, hit {hit:?}"
                );
            }
            if let Some(hit) = hit {
                near_point(hit.point, origin + hit.distance * direction, 1e-9);
                near(hit.normal.length(), 1.0, 1e-9);
                let (before, after) = [-1e-7, 1e-7].map(|d| program.value(hit.point + d * direction) > 0.0).into();
                assert!(before == inside || after != inside, "{solid:?}: no crossing at {hit:?}");
            }
        }
    }
}

#[test]
fn rays_that_were_once_answered_wrongly() {
    for n in corpus(include_str!("../corpus/rays.txt")) {
        let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
        let hit = Solid::half_space(vector(0), n[3]).raycast(vector(4), vector(7)).unwrap();
        near(hit.expect("the ray meets the plane").distance, n[10], 1e-10);
    }
}

#[test]
fn nearest_points_that_were_once_inexact() {
    for n in corpus(include_str!("../corpus/nearest.txt")) {
        let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
        let (centre, p) = (vector(1), vector(4));
        let q = Solid::sphere(n[0]).translate(centre).closest_surface_point(p).unwrap();
        near_point(q.expect("it has a surface"), centre + n[0] * (p - centre).normalize(), 1e-8);
    }
}

#[test]
fn rays_meet_half_spaces_from_either_side() {
    let mut random = Random::new(11);
    for _ in 0..300 {
        let (normal, offset) = (random.direction(), random.range(-2.0, 2.0));
        let (origin, direction) = (random.vector(-4.0, 4.0), random.direction());
        let want = (offset - normal.dot(origin)) / normal.dot(direction);
        let ground = Solid::half_space(normal, offset);
        for solid in [ground.clone(), !&ground] {
            let hit = solid.raycast(origin, direction).unwrap();
            // A ray nearly along the plane meets it too far away to say where.
            if want.abs() < 1e3 {
                assert_eq!(hit.is_some(), want > 0.0, "{solid:?} from {origin} along {direction}");
            }
            if let (Some(hit), true) = (hit, want.abs() < 1e3) {
                near(hit.distance, want, 1e-9 * (1.0 + want));
            }
        }
    }
}

#[test]
fn the_nearest_point_of_a_sphere() {
    let centre = DVec3::new(0.3, -0.2, 0.5);
    let ball = Solid::sphere(1.25).translate(centre);
    let mut random = Random::new(4);
    for _ in 0..40 {
        let p = random.vector(-3.0, 3.0);
        let q = ball.closest_surface_point(p).unwrap().expect("it has a surface");
        near_point(q, centre + 1.25 * (p - centre).normalize(), 1e-8);
    }
    // Of the centre, any point of it.
    let q = ball.closest_surface_point(centre).unwrap().expect("it has a surface");
    near(q.distance(centre), 1.25, 1e-8);
}

#[test]
fn the_nearest_point_of_a_box() {
    let half = DVec3::new(1.0, 0.5, 2.0);
    let block = Solid::cuboid(2.0 * half);
    let mut random = Random::new(5);
    for _ in 0..40 {
        let p = random.vector(-3.0, 3.0);
        let q = block.closest_surface_point(p).unwrap().expect("it has a surface");
        // The value of a box is the distance.
        near(q.distance(p), value(&block, p).abs(), 1e-12);
        near(value(&block, q), 0.0, 1e-12);
    }
}

#[test]
fn the_nearest_point_of_parts_that_meet() {
    let block = Solid::cuboid([10.0; 3]);
    let both = block.translate([-5.0, 0.0, 0.0]) | block.translate([5.0, 0.0, 0.0]);
    for (p, distance) in [
        // On the face that is inside, beside it, outside, and beyond an edge.
        ([0.0, 0.0, 1.0], 4.0),
        ([0.1, 0.0, 1.0], 4.0),
        ([0.0, 0.0, 6.5], 1.5),
        ([13.0, 0.0, 9.0], 5.0),
    ] {
        let q = both.closest_surface_point(p).unwrap().expect("it has a surface");
        near(q.distance(DVec3::from(p)), distance, 1e-8);
    }
    // A fin that no cell of a mesh shows: the distance outside is that to the nearer part.
    let parts = [Solid::cuboid([10.0, 10.0, 1e-6]), Solid::cuboid([6.0; 3])];
    let parts = parts.map(|part| part.rotate_x(rad(0.3)).rotate_y(rad(0.2)));
    let fin = &parts[0] | &parts[1];
    let mut random = Random::new(7);
    for p in (0..40).map(|_| random.vector(-8.0, 8.0)) {
        let way = -value(&parts[0], p).max(value(&parts[1], p));
        if way > 0.0 {
            let q = fin.closest_surface_point(p).unwrap().expect("it has a surface");
            near(q.distance(p), way, 1e-9);
        }
    }
}

#[test]
fn the_nearest_point_of_a_superellipsoid() {
    let leaf = Superellipsoid::new(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    let solid = Solid::from(leaf);
    let mut surface = Vec::new();
    for i in 0..=300u32 {
        for j in 0..=600u32 {
            let (h, w) = (PI * (f64::from(i) / 300.0 - 0.5), PI * (f64::from(j) / 300.0 - 1.0));
            let d = leaf.semi_axes() * DVec3::new(h.cos() * w.cos(), h.cos() * w.sin(), h.sin());
            surface.push(d / leaf.gauge(d));
        }
    }
    let mut random = Random::new(6);
    for _ in 0..25 {
        let p = random.vector(-2.0, 2.0);
        let q = solid.closest_surface_point(p).unwrap().expect("it has a surface");
        near(leaf.gauge(q), 1.0, 1e-9);
        let sampled = surface.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
        let found = q.distance(p);
        assert!(found <= sampled + 1e-9, "{p}: {found}, but {sampled} was found by sampling");
        assert!(found >= sampled - 0.02, "{p}: {found}, but {sampled} was found by sampling");
    }
}

#[test]
fn the_nearest_point_of_joins() {
    let part = Solid::cuboid(DVec3::new(4.0, 4.0, 1.0)) - Solid::cylinder(1.0, 2.0);
    // In the hole, the wall is nearest.
    let q = part.closest_surface_point(DVec3::new(0.4, 0.0, 0.1)).unwrap().expect("it has a surface");
    near_point(q, DVec3::new(1.0, 0.0, 0.1), 1e-7);
    let q = part.closest_surface_point(DVec3::new(1.5, 0.0, 3.0)).unwrap().expect("it has a surface");
    near_point(q, DVec3::new(1.5, 0.0, 0.5), 1e-7);
    // Nothing has no surface; what does not end has no box to look in.
    let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate(DVec3::X * 5.0);
    assert_eq!(nothing.closest_surface_point(DVec3::ZERO), Ok(None));
    assert!(Solid::half_space(DVec3::Z, 0.0).closest_surface_point(DVec3::ZERO).is_err());
}

#[test]
fn owners_are_the_leaves_that_decide() {
    let part = Solid::cuboid(DVec3::splat(2.0)) - Solid::cylinder(0.5, 3.0);
    let hole = part.owner(DVec3::new(0.5, 0.0, 0.0)).unwrap();
    assert_eq!(hole.path, "difference[1] / cylinder");
    let side = part.owner(DVec3::new(1.0, 0.2, 0.0)).unwrap();
    assert_eq!(side.path, "difference[0] / box");
    assert_ne!(hole.index, side.index);
    let hit = part.raycast(DVec3::X * 5.0, -DVec3::X).unwrap().expect("a face");
    assert_eq!(hit.owner, side.index);

    let nested =
        Solid::sphere(0.5).twist(rad(1.0)) | (Solid::cuboid(DVec3::ONE) & Solid::sphere(0.6)).translate(DVec3::X * 3.0);
    assert_eq!(nested.owner(DVec3::X * 0.5).unwrap().path, "union[0] / twist / sphere");
    let far = nested.owner(DVec3::new(3.45, 0.0, 0.0)).unwrap();
    assert_eq!(far.path, "union[1] / translate / intersection[0] / box");
    // The owner's value is that of the whole, after min and max.
    let mut random = Random::new(7);
    let (a, b) = (Solid::sphere(1.0), Solid::cuboid(DVec3::new(3.0, 0.5, 0.5)));
    let both = &a | &b;
    for _ in 0..200 {
        let p = random.vector(-2.0, 2.0);
        let want = if value(&a, p) >= value(&b, p) { "union[0] / sphere" } else { "union[1] / box" };
        assert_eq!(both.owner(p).unwrap().path, want, "at {p}");
    }
}

#[test]
fn bounds_of_moved_leaves_are_tight() {
    let cases = [
        (Solid::sphere(1.0).translate(DVec3::X * 2.0), DVec3::X * 2.0, DVec3::ONE),
        (Solid::cuboid(DVec3::new(2.0, 1.0, 1.0)).rotate_z(rad(FRAC_PI_4)), DVec3::ZERO, {
            let side = 1.5 / 2f64.sqrt();
            DVec3::new(side, side, 0.5)
        }),
        (Solid::cylinder(1.0, 4.0).rotate_x(deg(90.0)), DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0)),
        (Solid::cylinder(1.0, 2.0).rotate_x(rad(0.3)), DVec3::ZERO, {
            let (sin, cos) = 0.3f64.sin_cos();
            DVec3::new(1.0, cos + sin, cos + sin)
        }),
        (Solid::sphere(1.0).scale_axes(DVec3::new(1.0, 2.0, 3.0)).rotate_z(rad(FRAC_PI_4)), DVec3::ZERO, {
            let side = 2.5f64.sqrt();
            DVec3::new(side, side, 3.0)
        }),
    ];
    for (solid, centre, half) in cases {
        let bounds = solid.bounds().unwrap();
        near_point(bounds.min, centre - half, 1e-11);
        near_point(bounds.max, centre + half, 1e-11);
    }
}

#[test]
fn bounds_of_joins_combine_their_operands() {
    let (a, b) = (Solid::sphere(1.0), Solid::cuboid(DVec3::splat(2.0)).translate(DVec3::X * 1.5));
    let is = |solid: &Solid, min: DVec3, max: DVec3| {
        let bounds = solid.bounds().unwrap();
        near_point(bounds.min, min, 1e-12);
        near_point(bounds.max, max, 1e-12);
    };
    is(&(&a | &b), DVec3::splat(-1.0), DVec3::new(2.5, 1.0, 1.0));
    is(&(&a & &b), DVec3::new(0.5, -1.0, -1.0), DVec3::ONE);
    is(&(&a - &b), DVec3::splat(-1.0), DVec3::ONE);
    is(&(&a ^ &b), DVec3::splat(-1.0), DVec3::new(2.5, 1.0, 1.0));
    is(&!!&a, DVec3::splat(-1.0), DVec3::ONE);
    is(&!(!&a & !&b), DVec3::splat(-1.0), DVec3::new(2.5, 1.0, 1.0));
    // A half-space across an axis cuts the box.
    let cut = &a & Solid::half_space(DVec3::Z, 0.25);
    is(&cut, DVec3::splat(-1.0), DVec3::new(1.0, 1.0, 0.25));
    let nothing = &a & &a.translate(DVec3::X * 5.0);
    assert_eq!(nothing.bounds(), Ok(Bounds::EMPTY));
}

#[test]
fn bounds_of_unbounded_solids_are_infinite() {
    let bounds = Solid::half_space(DVec3::Z, 0.5).bounds().unwrap();
    assert_eq!((bounds.min.z, bounds.max.x), (f64::NEG_INFINITY, f64::INFINITY));
    near(bounds.max.z, 0.5, 1e-13);
    assert_eq!(Solid::half_space(DVec3::ONE, 0.0).bounds(), Ok(Bounds::ALL));
    assert_eq!((!Solid::sphere(1.0)).bounds(), Ok(Bounds::ALL));
    assert!(!(Solid::sphere(1.0) | !Solid::cuboid(DVec3::ONE)).bounds().unwrap().is_finite());
    assert!((Solid::sphere(1.0) - Solid::half_space(DVec3::Z, 0.0)).bounds().unwrap().is_finite());
    assert!(Solid::half_space(DVec3::Z, 0.0).finite_bounds().is_err());
    // A ray into what does not end.
    let ground = Solid::half_space(DVec3::Z, 0.0);
    let hit = ground.raycast(DVec3::new(7.0, -3.0, 4.0), DVec3::new(0.0, 0.6, -0.8)).unwrap().expect("the ground");
    near(hit.distance, 5.0, 1e-10);
    near_point(hit.normal, DVec3::Z, 1e-12);
}

#[test]
fn slices_are_the_single_points() {
    let mut random = Random::new(8);
    for depth in [0, 1, 2] {
        let solid = random_solid(&mut random, depth);
        let points: Vec<DVec3> = (0..300).map(|_| random.vector(-2.0, 2.0)).collect();
        let values = solid.values(&points).unwrap();
        let inside = solid.contains_all(&points).unwrap();
        let gradients = solid.gradients(&points).unwrap();
        for (i, &p) in points.iter().enumerate() {
            let single = value(&solid, p);
            near(values[i], single, 1e-10 * (1.0 + single.abs()));
            assert_eq!(inside[i], solid.contains(p).unwrap());
            assert_eq!(gradients[i], solid.gradient(p).unwrap());
        }
    }
    assert_eq!(Solid::sphere(1.0).values(&[]), Ok(Vec::new()));
}

#[test]
fn points_that_are_not_numbers_are_outside() {
    let solid = Solid::sphere(1.0) | Solid::superellipsoid(DVec3::ONE, 0.5, 0.5);
    for p in [DVec3::NAN, DVec3::new(0.0, f64::NAN, 0.0), DVec3::INFINITY, DVec3::NEG_INFINITY] {
        assert_eq!(solid.contains(p), Ok(false), "{p}");
        assert!(!value(&solid, p).is_nan(), "{p}");
    }
}

#[test]
fn slices_of_unequal_length_are_refused() {
    let program = Solid::sphere(2.0).field_program().unwrap();
    let tape = Tape::new(&program, &Bounds::new(DVec3::splat(-1.0), DVec3::ONE));
    let (x, short, mut out) = ([0.5; 3], [0.5; 2], [7.0; 3]);
    let error = Evaluator::new().values(&tape, &x, &x, &short, &mut out).unwrap_err();
    assert_eq!(error.to_string(), "z holds 2 numbers, but x 3: one for each point is allowed");
    assert_eq!(out, [7.0; 3]);
    let [mut value, mut dx, mut dy, mut dz] = [[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]];
    let gradients = Gradients { value: &mut value, dx: &mut dx, dy: &mut dy[..1], dz: &mut dz };
    assert_eq!(Evaluator::new().gradients(&tape, &x, &x, &x, gradients).unwrap_err().name, "dy");
    assert!(Evaluator::new().values_f64(&tape, &[0.0], &[0.0], &[], &mut [0.0]).is_err());
}

#[test]
fn rays_in_joints_end_where_the_solid_does() {
    let block = |size: [f64; 3], at: [f64; 3]| Solid::cuboid(size).translate(at);
    let brick = block([20.0, 20.0, 10.0], [0.0, 0.0, -5.0]);
    let post = brick.clone() | Solid::cylinder(5.0, 10.0).translate([0.0, 0.0, 5.0]);
    let stock = brick | block([20.0, 20.0, 10.0], [0.0, 0.0, 5.0]) | block([10.0, 20.0, 20.0], [15.0, 0.0, 0.0]);
    let apart = block([2.0, 2.0, 1.0], [-2.0, 0.0, -0.5]) | block([2.0, 2.0, 1.0], [2.0, 0.0, 0.5]);
    let quarter = |x: f64, y: f64| block([2.0, 2.0, 2.0], [x, y, 0.0]);
    let three = quarter(1.0, 1.0) | quarter(-1.0, 1.0) | quarter(-1.0, -1.0);
    let spheres = Solid::sphere(1.0).translate([0.0, 1.0, 0.0]) | Solid::sphere(1.0).translate([0.0, -1.0, 0.0]);
    let rim = 24.75_f64.sqrt();
    for (name, solid, from, way, want) in [
        ("out of a post", &post, [1.0, 0.5, 0.0], [1.0, 0.0, 0.0], Some(rim - 1.0)),
        ("into a post", &post, [-30.0, 0.5, 0.0], [1.0, 0.0, 0.0], Some(30.0 - rim)),
        ("from a joint through stock", &stock, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], Some(20.0)),
        ("from stock through a joint", &stock, [15.0, 1.0, 0.0], [-1.0, 0.0, 0.0], Some(25.0)),
        ("past plates on either side", &apart, [-10.0, 0.3, 0.0], [1.0, 0.0, 0.0], None),
        ("out of a corner", &three, [0.0, 0.0, 0.0], [1.0, -1.0, 0.0], None),
        ("between spheres", &spheres, [-9.0, 0.0, 0.0], [1.0, 0.0, 0.0], None),
    ] {
        let hit = solid.raycast(from, way).unwrap().map(|hit| hit.distance);
        let near = hit.zip(want).is_some_and(|(hit, want)| (hit - want).abs() < 1e-7);
        assert!(near || hit.is_none() && want.is_none(), "{name}: {hit:?} for {want:?}");
    }
}

#[test]
fn a_joint_is_inside_and_no_surface() {
    let brick = Solid::cuboid([20.0, 20.0, 10.0]);
    for turn in [0.0, 0.7] {
        let turned = |p: [f64; 3]| DVec3::from_array(p).rotate_z(turn);
        let tower = (brick.clone() | brick.translate([0.0, 0.0, 10.0])).rotate_z(rad(turn));
        assert!(tower.contains(turned([0.0, 0.0, 5.0])).unwrap(), "{turn}");
        assert!(tower.contains(turned([9.0, -3.0, 5.0])).unwrap(), "{turn}");
        // At the ends of the joint, on a side and on an edge, and on the sides.
        for p in [[10.0, 0.0, 5.0], [10.0, 10.0, 5.0], [-10.0, 3.0, 2.0], [0.0, 0.0, -5.0]] {
            assert!(!tower.contains(turned(p)).unwrap(), "{turn} {p:?}");
        }
        let near = tower.closest_surface_point(turned([1.0, 2.0, 7.0])).unwrap().unwrap();
        assert!((near.distance(turned([1.0, 2.0, 7.0])) - 8.0).abs() < 1e-6, "{turn}: {near}");
        let hit = tower.raycast(turned([1.0, 2.0, -3.0]), DVec3::Z).unwrap().unwrap();
        assert!((hit.distance - 18.0).abs() < 1e-9, "{turn}: {hit:?}");
        // Rays within the joint: from beyond, from its middle, and out of it; one in the upper face
        // touches it only.
        let scene = tower.scene().unwrap();
        for (from, way, far) in [
            ([-30.0, 0.5, 5.0], [1.0, 0.0, 0.0], 20.0),
            ([30.0, -30.0, 5.0], [-0.6, 0.8, 0.0], 200.0 / 6.0),
            ([1.0, 0.5, 5.0], [1.0, 0.0, 0.0], 9.0),
            ([1.0, 0.5, 5.0], [0.0, 0.0, 1.0], 10.0),
        ] {
            let (from, way) = (turned(from), turned(way));
            let hit = tower.raycast(from, way).unwrap().unwrap_or_else(|| panic!("{turn}: {from} along {way} misses"));
            assert!((hit.distance - far).abs() < 1e-6, "{turn}: {hit:?} for {far}");
            if !tower.contains(from).unwrap() {
                let seen =
                    scene.first_hit(from, way).unwrap_or_else(|| panic!("{turn}: {from} along {way} is not seen"));
                assert!((seen.distance - far).abs() < 1e-4, "{turn}: {seen:?} for {far}");
            }
        }
        assert_eq!(tower.raycast(turned([-30.0, 0.5, 15.0]), turned([1.0, 0.0, 0.0])).unwrap(), None);
    }
    // Three of four blocks about an edge: the edge is on the surface, with all four it is inside.
    let block = |x: f64, y: f64| Solid::cuboid([2.0, 2.0, 2.0]).translate([x, y, 0.0]);
    let three = block(1.0, 1.0) | block(-1.0, 1.0) | block(-1.0, -1.0);
    assert!(!three.contains([0.0, 0.0, 0.0]).unwrap());
    assert!((three | block(1.0, -1.0)).contains([0.0, 0.0, 0.0]).unwrap());
    // A wedge of 3 degrees is open between two that meet at its edge.
    let half = |turn: f64| Solid::half_space(DVec3::Y.rotate_z(turn), 0.0) & Solid::sphere(3.0);
    let wedge = half(0.0) | half(std::f64::consts::PI - 0.05);
    assert!(!wedge.contains([0.0, 0.0, 1.0]).unwrap());
    // Plugged with what was cut out.
    let plug = Solid::cylinder(3.0, 10.0);
    let plugged = (Solid::cuboid([10.0; 3]) - plug.clone()) | plug;
    assert!(plugged.contains([3.0, 0.0, 1.0]).unwrap() && !plugged.contains([3.0, 0.0, 5.0]).unwrap());
    let profile = Profile::rectangle([4.0, 4.0]) | Profile::rectangle([4.0, 4.0]).translate([4.0, 0.0]);
    assert!(profile.extrude(2.0).contains([2.0, 0.5, 0.3]).unwrap());
}

/// Two that have a face in common, one on either side of it; the middle of it, directions in it, and
/// how far it is from there to the surface and to where rays along them and across it end.
#[test]
fn joints_of_leaves_with_slanted_sides_are_inside() {
    let up = |solid: Solid| solid.translate([0.0, 0.0, 5.0]);
    let pair = |solid: Solid| up(solid.clone()) | up(solid).rotate_x(deg(180.0));
    let wedge = Solid::wedge([8.0, 6.0, 4.0]);
    let along = DVec3::new(8.0, 0.0, -4.0).normalize();
    let cos = (10.0_f64.powi(2) / (10.0_f64.powi(2) + 9.0)).sqrt();
    let across_hexagon = 2.5 * 3.0_f64.sqrt();
    let flat = |a: f64| [DVec3::X, DVec3::new(a.cos(), a.sin(), 0.0)];
    let cases = [
        ("cones", pair(Solid::cone(5.0, 2.0, 10.0)), flat(1.1), DVec3::Z, 5.0 * cos, [5.0, 5.0, 10.0]),
        (
            "pointed cones",
            pair(Solid::cone(5.0, 0.0, 10.0)),
            flat(2.0),
            DVec3::Z,
            2.0 * 5.0_f64.sqrt(),
            [5.0, 5.0, 10.0],
        ),
        (
            "prisms",
            pair(Solid::prism(6, 5.0, 10.0)),
            flat(std::f64::consts::FRAC_PI_6),
            DVec3::Z,
            across_hexagon,
            [5.0, across_hexagon, 10.0],
        ),
        (
            "pyramids",
            pair(Solid::pyramid(4, 5.0, 10.0)),
            flat(FRAC_PI_4),
            DVec3::Z,
            10.0 * 12.5_f64.sqrt() / 112.5_f64.sqrt(),
            [5.0, 12.5_f64.sqrt(), 10.0],
        ),
        (
            "wedges",
            wedge.clone() | wedge.rotate_y(deg(180.0)),
            [DVec3::Y, along],
            DVec3::new(1.0, 0.0, 0.0),
            2.0,
            [3.0, 20.0_f64.sqrt(), 4.0],
        ),
    ];
    for (name, solid, within, through, least, ends) in cases {
        for turn in [0.0, 0.7] {
            let turned = |p: DVec3| p.rotate_z(turn);
            let solid = solid.rotate_z(rad(turn));
            for by in [0.0, 0.5, 0.9] {
                for (way, end) in within.iter().zip(ends) {
                    assert!(solid.contains(turned(by * end * *way)).unwrap(), "{name} {turn}: {by} along {way}");
                    assert!(!solid.contains(turned(1.001 * end * *way)).unwrap(), "{name} {turn}: {way}");
                }
            }
            let near = solid.closest_surface_point(DVec3::ZERO).unwrap().unwrap();
            assert!((near.length() - least).abs() < 1e-6, "{name} {turn}: {near}, {least} away");
            for (way, end) in within.into_iter().chain([through]).zip(ends) {
                let hit = solid.raycast(DVec3::ZERO, turned(way)).unwrap().unwrap();
                assert!((hit.distance - end).abs() < 1e-6, "{name} {turn}: {hit:?} along {way}, {end}");
                let from = solid.raycast(turned(-30.0 * way), turned(way)).unwrap().unwrap();
                assert!(from.distance < 30.0 && from.distance > 30.0 - 11.0, "{name} {turn}: {from:?} to {way}");
            }
        }
        // In the joint a slice is whole.
        let area = solid.slice(&rvachev::Plane::new(DVec3::ZERO, within[0].cross(within[1]))).unwrap();
        let contours = area.contours(1e-4).unwrap();
        let want = match name {
            "cones" | "pointed cones" => 25.0 * PI,
            "prisms" => 1.5 * 3.0_f64.sqrt() * 25.0,
            "pyramids" => 50.0,
            _ => 6.0 * 80.0_f64.sqrt(),
        };
        assert!((contours.area() - want).abs() < 0.02, "{name}: {} of {want}", contours.area());
    }
}

/// Solids of every kind, and lengths of them.
pub fn whole_catalogue() -> Vec<(String, Solid)> {
    let mut all = Vec::new();
    for entry in rvachev::catalogue() {
        let solid = crate::form::shown(entry.example());
        let cut = Solid::cuboid([4.0, 4.0, 4.0]);
        let Ok(bounds) = solid.bounds() else { continue };
        let solid = if bounds.is_finite() { solid } else { solid & cut };
        let size = solid.bounds().unwrap().longest_side();
        if !(1e-2..1e3).contains(&size) {
            continue;
        }
        all.push((format!("{} moved out", entry.name()), solid.offset(0.05 * size)));
        all.push((format!("shell of {}", entry.name()), solid.shell(0.02 * size)));
        all.push((entry.name().to_owned(), solid));
    }
    all
}

#[test]
fn gradients_are_slopes_of_values_and_many_values_are_those_of_one() {
    let mut random = Random::new(11);
    let (mut smooth, mut wrong) = (0, Vec::new());
    for (name, solid) in whole_catalogue() {
        let frame = frame_of(&solid);
        let size = frame.longest_side();
        let around = Bounds::from_center(frame.center(), 0.8 * frame.size() + 0.2 * size);
        // Corners of boxes are where creases meet.
        let points: Vec<DVec3> = (0..60).map(|_| random.point_in(&around)).collect();
        let (values, gradients) = (solid.values(&points).unwrap(), solid.gradients(&points).unwrap());
        let simple = solid.simplified();
        for ((p, many), gradient) in points.iter().zip(values).zip(gradients) {
            let value = solid.value(*p).unwrap();
            let slack = 1e-9 * (size + value.abs()) * (1.0 + gradient.length().min(1e3));
            if (many - value).abs() > slack {
                wrong.push(format!("{name} at {p}: {value}, among others {many}"));
            }
            let simpler = simple.value(*p).unwrap();
            if (simpler - value).abs() > slack {
                wrong.push(format!("{name} at {p}: {value}, simplified {simpler}"));
            }
            let slopes = |h: f64| {
                DVec3::from_array([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                    let [above, below] = [h, -h].map(|h| solid.value(*p + h * axis).unwrap());
                    (above - below) / (2.0 * h)
                }))
            };
            let (near, far) = (slopes(2e-5 * size), slopes(5e-5 * size));
            // Where these differ there is a kink.
            if near.distance(far) < 1e-3 * (1.0 + near.length()) {
                smooth += 1;
                if gradient.distance(near) > 1e-2 * (1.0 + near.length()) {
                    wrong.push(format!("{name} at {p}: slopes {near}, told {gradient}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong of {smooth}:\n{}", wrong.len(), wrong[..wrong.len().min(40)].join("\n"));
    assert!(smooth > 10_000, "{smooth}");
}

#[test]
fn points_beyond_all_numbers_are_outside() {
    let solids = [Solid::sphere(1.0), Solid::cuboid([1.0; 3]) | Solid::cuboid([1.0; 3]).translate([1.0, 0.0, 0.0])];
    for solid in solids {
        for far in [1e10, 1e13, 1e25, 1e30, 1e300, f64::INFINITY] {
            for p in [[far, 0.0, 0.0], [0.0, -far, 0.3], [far, far, -far]] {
                assert_eq!(solid.contains(p), Ok(false), "{p:?}");
            }
        }
    }
}
