//! Building: what may stand for a solid and for a vector, names, writing out, equality,
//! simplification.

use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use glam::{DAffine3, DMat3, DQuat, DVec3, IVec3, UVec3, Vec3};
use rvachev::{
    Bounds, Camera, Cuboid, Cylinder, HalfSpace, ParamError, RFunction, Solid, Sphere, Superellipsoid, deg,
    field::{Field, Real},
    rad,
};

use crate::support::{Random, frame_of, near_point, random_leaf, random_solid, samples, value};

fn hash(solid: &Solid) -> u64 {
    let mut hasher = DefaultHasher::new();
    solid.hash(&mut hasher);
    hasher.finish()
}

/// A ball that two different types can be.
macro_rules! ball {
    ($name:ident) => {
        #[derive(Debug)]
        struct $name(f64);

        impl Field for $name {
            fn name(&self) -> &'static str {
                "ball"
            }
            fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
                -(x.square() + y.square() + z.square()).sqrt() + self.0
            }
            fn bounds(&self) -> Bounds {
                Bounds::from_center(DVec3::ZERO, DVec3::splat(self.0))
            }
            fn check(&self) -> Result<(), ParamError> {
                Ok(())
            }
        }
    };
}

ball!(Ball);

#[test]
fn leaves_stand_for_solids() {
    let (ball, hole) = (Sphere { radius: 1.0 }, Cylinder { radius: 0.3, height: 3.0 });
    let (a, b) = (Solid::from(ball), Solid::from(hole));
    assert_eq!(&a - hole, &a - &b);
    assert_eq!(a.clone() | hole, a.clone() | b.clone());
    assert_eq!(&a & hole, a.clone() & &b);
    assert_eq!(Solid::from(ball) ^ Superellipsoid::new([1.0, 1.0, 1.0], 1.0, 1.0), {
        &a ^ Solid::superellipsoid(DVec3::ONE, 1.0, 1.0)
    });
    let rule = RFunction::MIN_MAX;
    assert_eq!(a.union(hole, rule), a.union(&b, rule));
    assert_eq!(a.intersection(hole, rule), a.intersection(b.clone(), rule));
    assert_eq!(a.difference(hole, rule), a.difference_all([hole], rule));
    assert_eq!(a.symmetric_difference(hole, rule), a.symmetric_difference(&b, rule));
    let balls = [0.5, 1.0].map(|radius| Sphere { radius });
    let solids = balls.map(Solid::from);
    assert_eq!(Solid::union_all(balls, rule), Solid::union_all(&solids, rule));
    assert_eq!(Solid::intersection_all(balls, rule), Solid::intersection_all(solids.iter(), rule));
    assert_eq!(a.difference_all(balls, rule), a.difference_all(solids.to_vec(), rule));

    let mut part = a.clone();
    part |= Cuboid { size: DVec3::ONE };
    part -= hole;
    part &= HalfSpace { normal: DVec3::Z, offset: 0.2 };
    part ^= &b;
    let same = ((&a | Solid::cuboid(DVec3::ONE)) - &b) & Solid::half_space(DVec3::Z, 0.2);
    assert_eq!(part, same ^ b);
}

#[test]
fn whatever_glam_converts_is_a_vector() {
    let want = Solid::cuboid(DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(Solid::cuboid([1.0, 2.0, 3.0]), want);
    assert_eq!(Solid::cuboid((1.0, 2.0, 3.0)), want);
    assert_eq!(Solid::cuboid(Vec3::new(1.0, 2.0, 3.0)), want);
    assert_eq!(Solid::cuboid(IVec3::new(1, 2, 3)), want);
    assert_eq!(Solid::cuboid(UVec3::new(1, 2, 3)), want);
    let p = [0.1, 0.2, 0.3];
    let v = DVec3::from_array(p);
    assert_eq!(want.value(p), want.value(v));
    assert_eq!(want.gradient(p), want.gradient(v));
    assert_eq!(want.contains((0.1, 0.2, 0.3)), Ok(true));
    assert_eq!(want.owner(p), want.owner(v));
    assert_eq!(want.closest_surface_point(p), want.closest_surface_point(v));
    let ray = |hit: Option<rvachev::Hit>| hit.map(|hit| hit.distance);
    assert_eq!(
        ray(want.raycast([5.0, 0.0, 0.0], [-1.0, 0.0, 0.0]).unwrap()),
        ray(want.raycast(DVec3::X * 5.0, -DVec3::X).unwrap())
    );
    let program = want.field_program().unwrap();
    assert_eq!(program.value(p), program.value(v));
    assert_eq!(program.gradient(p).0, program.value(v));
    assert_eq!(program.owner(p), program.owner(v));
    assert!(Bounds::new([0.0; 3], [1.0; 3]).contains(p));
    assert_eq!(Bounds::from_points([[0.0; 3], p]), Bounds::new(DVec3::ZERO, v));
    assert_eq!(Bounds::from_corners(p, [0.0; 3]), Bounds::from_points([DVec3::ZERO, v]));
    assert_eq!(Bounds::from_center([0.0; 3], [1.0; 3]).distance_squared([2.0, 0.0, 0.0]), 1.0);
    let camera = Camera::perspective([3.0, 0.0, 0.0], DVec3::ZERO, (0.0, 0.0, 1.0), deg(40.0));
    assert_eq!(camera, Camera::perspective(DVec3::X * 3.0, [0.0; 3], DVec3::Z, deg(40.0)));
    assert_eq!(
        want.translate(p).rotate_about([0.0, 0.0, 2.0], rad(0.5)),
        want.translate(v).rotate_about(DVec3::Z, rad(0.5))
    );
    assert_eq!(Superellipsoid::new([1.0, 2.0, 3.0], 1.0, 1.0).gauge([1.0, 0.0, 0.0]), 1.0);
}

#[test]
fn rotations_agree() {
    let solid = Solid::cuboid([1.0, 2.0, 3.0]).translate([0.4, 0.5, 0.6]);
    for degrees in [30.0, -75.0, 90.0, 180.0, 400.0] {
        let angle = f64::to_radians(degrees);
        for (axis, a, b) in [
            (DVec3::X, solid.rotate_x(rad(angle)), solid.rotate_x(deg(degrees))),
            (DVec3::Y, solid.rotate_y(rad(angle)), solid.rotate_y(deg(degrees))),
            (DVec3::Z, solid.rotate_z(rad(angle)), solid.rotate_z(deg(degrees))),
        ] {
            let c = solid.rotate_about(axis * 7.0, rad(angle));
            let d = solid.rotate_about(axis * 1e-200, deg(degrees));
            let e = solid.rotate(DQuat::from_axis_angle(axis, angle));
            let want = a.bounds().unwrap();
            for other in [b, c, d, e] {
                let got = other.bounds().unwrap();
                near_point(got.min, want.min, 1e-12);
                near_point(got.max, want.max, 1e-12);
                assert!(
                    (value(&other, DVec3::new(0.3, -0.9, 0.8)) - value(&a, DVec3::new(0.3, -0.9, 0.8))).abs() < 1e-13
                );
            }
        }
    }
    // A whole turn is none.
    assert_eq!(solid.rotate_z(deg(360.0)).simplified(), solid.simplified());
    for (wrong, text) in [
        (solid.rotate_about(DVec3::ZERO, rad(1.0)), "rotate_about: axis or angle (an entry of the matrix) is NaN"),
        (solid.rotate_about(DVec3::X, rad(f64::NAN)), "rotate_about: axis or angle"),
        (solid.rotate_about(DVec3::NAN, deg(1.0)), "rotate_about: axis or angle"),
        (solid.rotate_x(deg(f64::INFINITY)), "rotate_x: angle"),
    ] {
        let error = wrong.bounds().unwrap_err().to_string();
        assert!(error.starts_with(text), "{error}");
    }
}

#[test]
fn names_are_in_paths() {
    let socket = |axes: DVec3| Solid::superellipsoid(axes, 0.2, 1.0).twist(rad(0.1)).named("socket");
    let head = Solid::cylinder(5.0, 4.0).named("head");
    let error = (&head - socket(DVec3::NEG_ONE)).bounds().unwrap_err().to_string();
    assert!(error.starts_with("difference[1] / socket: twist / superellipsoid: semi_axes.x is -1"), "{error}");

    let part = (&head - socket(DVec3::new(1.0, 1.0, 3.0))).named("bolt");
    assert_eq!(part.owner([0.0, 0.0, 0.0]).unwrap().path, "bolt: difference[1] / socket: twist / superellipsoid");
    assert_eq!(part.owner([5.0, 0.0, 0.0]).unwrap().path, "bolt: difference[0] / head: cylinder");
    assert_eq!(head.named("a").named("b").owner(DVec3::ZERO).unwrap().path, "b: a: head: cylinder");

    // An empty join and an unbounded node speak of names as well.
    let nothing: [Solid; 0] = [];
    let empty = Solid::union_all(nothing, RFunction::MIN_MAX).named("rest");
    assert!((&head | empty).bounds().unwrap_err().to_string().starts_with("union[1] / rest: union: has 0 operands"));
    let ground = Solid::half_space([0.0, 1.0, 1.0], 0.0).named("ground").rotate_x(rad(0.1)).named("all");
    let error = (head | ground).finite_bounds().unwrap_err().to_string();
    assert!(error.starts_with("union[1] / all: rotate_x / ground: half-space: unbounded"), "{error}");

    // A name cannot break a line.
    assert_eq!(Solid::sphere(1.0).named("a\nb\t").owner(DVec3::ZERO).unwrap().path, "a b : sphere");
}

#[test]
fn names_change_nothing_else() {
    let mut random = Random::new(1);
    for depth in [0, 1, 2, 3] {
        let solid = random_solid(&mut random, depth);
        let named = (solid.named("a") | solid.named("b").translate(DVec3::X)).named("c");
        let plain = &solid | solid.translate(DVec3::X);
        assert_eq!(named.bounds(), plain.bounds());
        let frame = frame_of(&plain);
        assert_eq!(named.range(&frame), plain.range(&frame));
        for p in samples(&mut random, &frame, 40) {
            assert_eq!(named.value(p), plain.value(p));
            assert_eq!(named.contains(p), plain.contains(p));
            assert_eq!(named.gradient(p), plain.gradient(p));
        }
        #[cfg(feature = "formula")]
        assert_eq!(named.to_fidget().is_ok(), plain.to_fidget().is_ok());
    }
}

#[test]
fn solids_are_written_as_trees() {
    let ball = Solid::sphere(1.0);
    let arm = Solid::cuboid([4.0, 1.0, 1.0]).translate([2.0, 0.0, 0.25]).named("arm");
    let whole = Solid::union_all(
        [
            ball.scale(2.0),
            ball.scale_axes([1.0, 2.0, 1e-3]),
            arm.clone(),
            arm.rotate_z(deg(120.0)),
            arm.rotate_about([1.0, 1.0, 0.0], rad(0.5)),
            ball.affine(DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)), DVec3::X)),
            !ball.twist(rad(0.5)).taper(0.1, 0.2, 4.0).bend(0.25, deg(0.0)),
            Superellipsoid::new([1.0, 2.0, 3.0], 0.5, 1.5).into(),
            Solid::new(Ball(2.0)),
        ],
        RFunction::MIN_MAX,
    )
    .named("toy");
    let want = "\
toy: union by Alpha(1.0)
  scale 2
    sphere { radius: 1.0 }
  scale_axes (1, 2, 0.001)
    sphere { radius: 1.0 }
  part 1, arm: translate (2, 0, 0.25)
    box { size: DVec3(4.0, 1.0, 1.0) }
  rotate_z 120° about (0, 0, 1)
    part 1 again
  rotate_about 28.6478898° about (0.707106781, 0.707106781, 0)
    part 1 again
  affine x to (1, 0, 0), y to (0, 2, 0), z to (0, 0, 1), origin to (1, 0, 0)
    sphere { radius: 1.0 }
  complement
    bend { curvature: 0.25, angle: 0.0 rad }
      taper { kx: 0.1, ky: 0.2, height: 4.0 }
        twist { rate: 0.5 rad }
          sphere { radius: 1.0 }
  superellipsoid { semi_axes: DVec3(1.0, 2.0, 3.0), e1: 0.5, e2: 1.5 }
  ball(2.0)";
    assert_eq!(whole.to_string(), want);
    assert_eq!(format!("{whole:#}"), want);
    let lines: Vec<&str> = want.lines().collect();
    assert_eq!(format!("{whole:.3}"), format!("{}\n... and 17 more lines", lines[..3].join("\n")));
    assert_eq!(format!("{whole:.20}"), want);
    assert_eq!(format!("{whole:.0}"), "... and 20 more lines");

    // A name that is shared apart from what it names.
    let both = ball.twist(rad(1.0));
    let (left, right) = (both.named("left"), both.named("right"));
    let pair = &left | &right | &left;
    let want = "\
union by P(2.0)
  union by P(2.0)
    part 1, left: part 2, twist { rate: 1.0 rad }
      sphere { radius: 1.0 }
    right: part 2 again
  part 1 again";
    assert_eq!(pair.to_string(), want);
}

#[test]
fn large_solids_are_cut_short() {
    let many = Solid::union_all((0..1000).map(|i| Solid::sphere(1.0 + f64::from(i))), RFunction::MIN_MAX);
    let text = many.to_string();
    assert_eq!(text.lines().count(), 61);
    assert!(text.ends_with("\n... and 941 more lines"), "{text}");
    assert_eq!(format!("{many:#}").lines().count(), 1001);

    // Shared parts are written once, though there are 2^60 paths.
    let mut doubled = Solid::sphere(1.0);
    for _ in 0..60 {
        doubled = &doubled | &doubled.translate(DVec3::X);
    }
    assert!(format!("{doubled:#}").lines().count() <= 4 * 60 + 1);
}

#[test]
fn deep_chains_need_no_stack() {
    let chain = |last: f64| {
        let mut solid = Solid::sphere(1.0);
        for i in 0..20_000 {
            solid = match i % 5 {
                0 => solid.translate([last, 0.0, 0.0]),
                1 => !solid,
                2 => solid.named("link"),
                3 => solid.twist(rad(1e-6)),
                _ => solid.union(Sphere { radius: last }, RFunction::MIN_MAX),
            };
        }
        solid
    };
    let (a, b) = (chain(0.5), chain(0.5));
    assert!(a == b && a != chain(0.25));
    assert_eq!(hash(&a), hash(&b));
    assert!(format!("{a:#}").lines().count() > 10_000);
    assert!(a.simplified().node_count() <= a.node_count());
    let mut moved = Solid::sphere(1.0);
    let mut joined = Solid::sphere(1.0);
    for i in 0..20_000 {
        moved = moved.translate([1e-3, 0.0, 0.0]);
        joined = joined.union(Sphere { radius: f64::from(i) }, RFunction::MIN_MAX);
    }
    assert_eq!(moved.simplified().node_count(), 2);
    // The ball of radius 1 is there twice.
    assert_eq!(joined.simplified().node_count(), 20_001);
}

#[test]
fn equality_is_by_structure() {
    let ball = Solid::sphere(1.0);
    let other = Solid::sphere(1.5);
    let parts = |ball: &Solid| {
        let rule = RFunction::P(2.0);
        [
            ball.clone(),
            ball.translate(DVec3::X),
            ball.translate(DVec3::Y),
            ball.twist(rad(1.0)),
            ball.twist(rad(1.5)),
            ball.taper(0.1, 0.2, 6.0),
            !ball,
            !!ball,
            ball.named("a"),
            ball.named("b"),
            ball.union(Solid::cuboid(DVec3::ONE), rule),
            Solid::cuboid(DVec3::ONE).union(ball, rule),
            ball.union(Solid::cuboid(DVec3::ONE), RFunction::P(3.0)),
            ball.union(Solid::cuboid(DVec3::ONE), RFunction::Associative(2.0)),
            ball.intersection(Solid::cuboid(DVec3::ONE), rule),
            ball.difference(Solid::cuboid(DVec3::ONE), rule),
            ball.symmetric_difference(Solid::cuboid(DVec3::ONE), rule),
            Solid::union_all([ball], rule),
            Solid::union_all([ball, ball], rule),
            Solid::union_all([ball, ball, ball], rule),
        ]
    };
    let all: Vec<Solid> = parts(&ball).into_iter().chain(parts(&other)).collect();
    let again: Vec<Solid> = parts(&Solid::sphere(1.0)).into_iter().chain(parts(&Solid::sphere(1.5))).collect();
    for (i, a) in all.iter().enumerate() {
        for (j, b) in again.iter().enumerate() {
            assert_eq!(a == b, i == j, "{a}\nand\n{b}");
            assert_eq!(hash(a) == hash(b), i == j, "{a}\nand\n{b}");
        }
    }
    #[allow(clippy::mutable_key_type, reason = "what changes in a solid is the evaluator's cache, which is not hashed")]
    let index: HashMap<&Solid, usize> = all.iter().enumerate().map(|(i, solid)| (solid, i)).collect();
    assert_eq!(again.iter().map(|solid| index[solid]).collect::<Vec<_>>(), (0..all.len()).collect::<Vec<_>>());
}

#[test]
fn numbers_are_compared_exactly() {
    assert_eq!(Solid::sphere(0.1 + 0.2), Solid::sphere(0.300_000_000_000_000_04));
    assert_ne!(Solid::sphere(0.1 + 0.2), Solid::sphere(0.3));
    let ball = Solid::sphere(1.0);
    assert_eq!(ball.translate([f64::NAN, 0.0, 0.0]), ball.translate([f64::NAN, 0.0, 0.0]));
    assert_ne!(ball.translate([0.0, 0.0, 0.0]), ball.translate([-0.0, 0.0, 0.0]));
    assert_ne!(ball.twist(deg(0.0)), ball.twist(rad(-0.0)));
    assert_eq!(Solid::sphere(f64::NAN), Solid::sphere(f64::NAN));
    // However a map is spelt, it is the map.
    assert_eq!(ball.translate(DVec3::X), ball.affine(DAffine3::from_translation(DVec3::X)));
    assert_eq!(ball.scale(2.0), ball.scale_axes([2.0, 2.0, 2.0]));
}

#[test]
fn leaves_are_told_apart_by_type_and_text() {
    mod other {
        use super::*;
        ball!(Ball);
        pub fn ball(radius: f64) -> Solid {
            Solid::new(Ball(radius))
        }
    }
    assert_eq!(Solid::new(Ball(1.0)), Solid::new(Ball(1.0)));
    assert_ne!(Solid::new(Ball(1.0)), Solid::new(Ball(2.0)));
    // The same name and the same text, and another type.
    assert_eq!(format!("{:?}", other::ball(1.0)), format!("{:?}", Solid::new(Ball(1.0))));
    assert_ne!(other::ball(1.0), Solid::new(Ball(1.0)));
}

#[test]
fn sharing_makes_no_difference() {
    let mut shared = Solid::sphere(1.0);
    for i in 0..100 {
        shared = &shared | &shared.translate([f64::from(i), 0.0, 0.0]);
    }
    // Nothing of it is stored in the other; 2^100 paths.
    let mut apart = Solid::sphere(1.0);
    for i in 0..100 {
        apart = &apart | &apart.translate([f64::from(i), 0.0, 0.0]);
    }
    assert!(shared == apart && hash(&shared) == hash(&apart));
    assert_ne!(shared, apart.named("other"));
    let copies = Solid::sphere(1.0) | Solid::sphere(1.0);
    let ball = Solid::sphere(1.0);
    assert_eq!(copies, &ball | &ball);
    assert_eq!((copies.node_count(), (&ball | &ball).node_count()), (3, 2));
}

#[test]
fn simplified_does_what_it_says() {
    let (a, b, c) = (Solid::sphere(1.0), Solid::cuboid([2.0, 1.0, 1.0]), Solid::cylinder(0.4, 3.0));
    let (rule, sharp) = (RFunction::P(2.0), RFunction::MIN_MAX);
    let turn = DAffine3::from_rotation_z(0.3);
    let stretch = DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0));
    let nothing: [Solid; 0] = [];
    let cases = [
        (!!&a, a.clone()),
        (!!!&a, !&a),
        (a.translate(DVec3::ZERO), a.clone()),
        (a.translate(DVec3::X).translate(-DVec3::X), a.clone()),
        (a.translate(DVec3::X).translate(DVec3::Y).translate(DVec3::Z), a.translate(DVec3::ONE)),
        (b.scale(2.0).translate(DVec3::X).scale(0.5), b.translate([0.5, 0.0, 0.0])),
        (b.affine(stretch).affine(turn), b.affine(turn * stretch)),
        (b.affine(turn).affine(stretch), b.affine(stretch * turn)),
        (b.affine(stretch).affine(stretch), b.affine(stretch * stretch)),
        (Solid::union_all([&a], rule), a.clone()),
        (Solid::intersection_all([&a], rule), a.clone()),
        (a.difference_all(&nothing, rule), a.clone()),
        (a.union(&b, sharp).union(&c, sharp), Solid::union_all([&a, &b, &c], sharp)),
        (a.union(b.union(&c, sharp), sharp), Solid::union_all([&a, &b, &c], sharp)),
        (a.intersection(b.intersection(&c, sharp), sharp), Solid::intersection_all([&a, &b, &c], sharp)),
        (a.difference(&b, sharp).difference(&c, sharp), a.difference_all([&b, &c], sharp)),
        (a.difference(b.union(&c, sharp), sharp), a.difference_all([&b, &c], sharp)),
        (a.union(&a, sharp), a.clone()),
        (a.union(&b, sharp).union(Solid::sphere(1.0), sharp), a.union(&b, sharp)),
        (a.difference_all([&b, &b], sharp), a.difference(&b, sharp)),
        ((!!&a).union(Solid::union_all([b.translate(DVec3::ZERO)], rule), sharp), a.union(&b, sharp)),
    ];
    for (solid, want) in cases {
        assert_eq!(solid.simplified(), want, "{solid}");
    }
    // And what changes values, or an error, stays.
    let tall = DAffine3::from_scale(DVec3::new(1.0, 1.0, 2.0));
    let flat = DAffine3::from_scale(DVec3::new(2.0, 2.0, 1.0));
    for kept in [
        b.affine(flat).affine(tall),
        a.union(&b, rule).union(&c, rule),
        a.union(&a, rule),
        a.union(&b, rule).union(&c, sharp),
        a.symmetric_difference(&b, sharp).symmetric_difference(&c, sharp),
        a.difference(b.intersection(&c, sharp), sharp),
        a.symmetric_difference(&a, sharp),
        a.translate(DVec3::X).named("a").translate(DVec3::X),
        !(!&a).named("a"),
        a.union(b.union(&c, sharp).named("a"), sharp),
        Solid::union_all([&a], RFunction::P(0.5)),
        Solid::union_all(&nothing, sharp).union(&a, sharp),
        a.scale(0.0).scale(2.0),
        a.translate([f64::NAN, 0.0, 0.0]).translate(DVec3::X),
        a.scale(1e-8).scale(1e8),
    ] {
        assert_eq!(kept.simplified(), kept);
    }
    // Equal parts are stored once.
    let twice = Solid::sphere(1.0).twist(rad(1.0)) | Solid::sphere(1.0).twist(rad(1.0)).translate(DVec3::X);
    assert_eq!((twice.node_count(), twice.simplified().node_count()), (6, 4));
    assert_eq!(twice.simplified(), twice);
}

/// A solid of every kind of node, with much in it to simplify.
fn cluttered(random: &mut Random, leaves: &[Solid], depth: usize) -> Solid {
    if depth == 0 {
        return leaves[random.below(leaves.len())].clone();
    }
    let first = cluttered(random, leaves, depth - 1);
    let below = random.below(depth);
    let second = if random.chance(0.3) { first.clone() } else { cluttered(random, leaves, below) };
    let rule = if random.chance(0.6) { RFunction::MIN_MAX } else { random.rule() };
    match random.below(16) {
        0 => first.union(&second, rule),
        1 => first.intersection(&second, rule),
        2 => first.difference(&second, rule),
        3 => first.symmetric_difference(&second, rule),
        4 => Solid::union_all([&first, &second, &first], rule),
        5 => first.difference_all([&second, &second], rule),
        6 => Solid::intersection_all([&first], rule),
        7 => !first,
        8 => !!first,
        9 => first.named("part"),
        10 => first.translate(random.vector(-0.5, 0.5)).rotate(random.rotation()),
        11 => first.affine(random.affine()).translate(DVec3::ZERO),
        12 => first.scale_axes(random.vector(0.7, 1.4)).scale(random.range(0.5, 1.5)),
        13 => first.rotate_z(deg(90.0)).rotate_z(deg(-90.0)),
        14 => first.twist(rad(random.range(-1.0, 1.0))),
        _ => first.taper(random.range(-0.4, 0.4), random.range(-0.4, 0.4), random.range(1.0, 2.0)),
    }
}

#[test]
fn simplified_solids_have_the_same_values() {
    let mut random = Random::new(7);
    let (mut before, mut after) = (0, 0);
    // Some of them equal and not the same.
    let mut leaves: Vec<Solid> = (0..10).map(|_| random_leaf(&mut random)).collect();
    leaves.extend([0.5, 0.5, 0.75].map(Solid::sphere));
    for round in 0..100 {
        let solid = if round % 10 == 0 { random_solid(&mut random, 3) } else { cluttered(&mut random, &leaves, 6) };
        let simple = solid.simplified();
        assert!(simple.node_count() <= solid.node_count(), "{solid:#}\nbecame\n{simple:#}");
        assert_eq!(simple.simplified(), simple, "{solid:#}");
        assert_eq!(simple.simplified().node_count(), simple.node_count());
        (before, after) = (before + solid.node_count(), after + simple.node_count());
        let frame = frame_of(&solid);
        for p in samples(&mut random, &frame, 40) {
            let (want, got) = (value(&solid, p), value(&simple, p));
            // The point is rounded otherwise on its way through other maps.
            let slope = solid.gradient(p).unwrap().length();
            let slack = 1e-12 * (1.0 + want.abs() + if slope.is_finite() { slope } else { 0.0 });
            assert!(
                (got - want).abs() <= slack,
                "{got} and {want} at {p}, slope {slope}:\n{solid:#}\nbecame\n{simple:#}"
            );
        }
    }
    println!("{before} nodes became {after}");
    assert!(after < before);
}
