//! What is refused, and what the error says: path, parameter, value, allowed range.

use std::panic::catch_unwind;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use rvachev::{
    Bounds, CellSize, Gielis, MeshSettings, ParamError, RFunction, Radius, Solid, SolidError, Supershape, Turns, deg,
    error::MeshingError, rad,
};

/// Checks that the solid is refused everywhere, with a text that has all of `parts`, and
/// returns the parameter's error.
#[track_caller]
fn refused(solid: &Solid, parts: &[&str]) -> ParamError {
    let error = solid.value(DVec3::ZERO).expect_err("the solid is not valid");
    let text = error.to_string();
    for part in parts {
        assert!(text.contains(part), "no {part:?} in {text:?}");
    }
    // Each way to use the solid refuses it with the same error.
    // Texts are compared, for an error that holds NaN is not equal to itself.
    let same = |other: Result<(), SolidError>| assert_eq!(other.expect_err("the solid is not valid").to_string(), text);
    same(solid.bounds().map(drop));
    same(solid.contains(DVec3::ZERO).map(drop));
    same(solid.gradient(DVec3::ZERO).map(drop));
    same(solid.raycast(DVec3::X, DVec3::X).map(drop));
    same(solid.field_program().map(drop));
    #[cfg(feature = "formula")]
    same(solid.to_fidget().map(drop));
    let settings = MeshSettings { cell: CellSize::LongestSide(8), ..MeshSettings::default() };
    match solid.mesh(&settings) {
        Err(MeshingError::Solid(error)) => assert_eq!(error.to_string(), text),
        other => panic!("meshing says {other:?}"),
    }
    // And it is found below other nodes too.
    let part = Solid::cuboid(DVec3::ONE).difference(solid.twist(rad(0.1)), RFunction::default());
    let below = part.value(DVec3::ZERO).expect_err("an operand is not valid").to_string();
    assert!(below.starts_with("difference[1] / twist / "), "{below}");
    match error {
        SolidError::Parameter { source, .. } => source,
        other => panic!("not an error of a parameter: {other}"),
    }
}

const NOT_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn numbers_that_are_not_finite() {
    for bad in NOT_NUMBERS {
        let text = format!("{bad}");
        refused(&Solid::sphere(bad), &["sphere: radius is ", &text, "allowed"]);
        refused(&Solid::cuboid(DVec3::new(1.0, bad, 1.0)), &["box: size.y is ", &text]);
        refused(&Solid::cylinder(bad, 1.0), &["cylinder: radius is ", &text]);
        refused(&Solid::cylinder(1.0, bad), &["cylinder: height is ", &text]);
        refused(&Solid::half_space(DVec3::X * bad, 0.0), &["half-space: normal is ", "other than zero"]);
        refused(&Solid::half_space(DVec3::X, bad), &["half-space: offset is ", &text]);
        refused(&Solid::superellipsoid(DVec3::new(1.0, 1.0, bad), 1.0, 1.0), &["semi_axes.z is ", &text]);
        refused(&Solid::superellipsoid(DVec3::ONE, bad, 1.0), &["superellipsoid: e1 is ", &text, "0.01 to 10"]);
        refused(&Solid::superellipsoid(DVec3::ONE, 1.0, bad), &["superellipsoid: e2 is ", &text, "0.01 to 10"]);
    }
}

#[test]
fn numbers_of_maps_that_are_not_finite() {
    let ball = Solid::sphere(1.0);
    for bad in NOT_NUMBERS {
        refused(&ball.translate(DVec3::new(0.0, 0.0, bad)), &["translate: translation.z is "]);
        refused(&ball.rotate_x(rad(bad)), &["rotate_x: "]);
        refused(&ball.rotate_y(rad(bad)), &["rotate_y: "]);
        refused(&ball.rotate_z(rad(bad)), &["rotate_z: "]);
        refused(&ball.scale(bad), &["scale: "]);
        refused(&ball.scale_axes(DVec3::new(1.0, bad, 1.0)), &["scale_axes: "]);
        refused(&ball.affine(DAffine3::from_scale(DVec3::splat(bad))), &["affine: "]);
        refused(&ball.rotate(DQuat::from_xyzw(bad, 0.0, 0.0, 1.0)), &["rotate: "]);
        refused(&ball.taper(bad, 0.0, 2.0), &["taper: kx is ", "-0.999 to 0.999"]);
        refused(&ball.taper(0.0, bad, 2.0), &["taper: ky is ", "-0.999 to 0.999"]);
        refused(&ball.taper(0.0, 0.0, bad), &["taper: height is "]);
        refused(&ball.twist(rad(bad)), &["twist: rate is "]);
        refused(&ball.bend(bad, deg(0.0)), &["bend: curvature is "]);
        refused(&ball.bend(0.1, rad(bad)), &["bend: angle is "]);
    }
}

#[test]
fn sizes_that_are_not_positive() {
    for bad in [0.0, -0.0, -1.0] {
        let error = refused(&Solid::sphere(bad), &["sphere: radius is ", "allowed"]);
        assert_eq!((error.parameter.as_str(), error.value), ("radius", bad));
        refused(&Solid::cuboid(DVec3::new(1.0, 1.0, bad)), &["box: size.z is "]);
        refused(&Solid::cylinder(bad, 1.0), &["cylinder: radius is "]);
        refused(&Solid::cylinder(1.0, bad), &["cylinder: height is "]);
        refused(&Solid::superellipsoid(DVec3::new(bad, 1.0, 1.0), 1.0, 1.0), &["superellipsoid: semi_axes.x is "]);
        let shape = Supershape::new(Gielis::circle(), Gielis::circle()).scaled(DVec3::new(1.0, bad, 1.0));
        refused(&shape.into(), &["supershape: scale.y is "]);
        refused(&Solid::sphere(1.0).taper(0.1, 0.1, bad), &["taper: height is "]);
    }
    refused(&Solid::half_space(DVec3::ZERO, 0.0), &["half-space: normal is 0", "other than zero"]);
}

#[test]
fn exponents_out_of_range() {
    for bad in [0.0, -1.0, 0.009, 10.1] {
        let text = format!("e1 is {bad}, allowed: 0.01 to 10");
        refused(&Solid::superellipsoid(DVec3::ONE, bad, 1.0), &["superellipsoid: ", &text]);
        let text = format!("e2 is {bad}, allowed: 0.01 to 10");
        refused(&Solid::superellipsoid(DVec3::ONE, 1.0, bad), &["superellipsoid: ", &text]);
    }
}

#[test]
fn curves_out_of_range() {
    let circle = Gielis::circle();
    let good = Gielis::new(5.0, 3.0, 3.0, 3.0);
    let shape = |equator: Gielis| Solid::from(Supershape::new(equator, circle));
    let envelope = good.with_turns(Turns::Outer);
    refused(&shape(Gielis { m: 2.0_f64.sqrt(), ..envelope }), &["supershape: equator.m is 1.41421", "16 turns"]);
    refused(&shape(Gielis { m: 31.0 / 17.0, ..envelope }), &["supershape: equator.m is 1.82", "16 turns"]);
    refused(&shape(Gielis { m: 7.0 / 9.0, n3: 4.0, ..envelope }), &["supershape: equator.m is 0.77", "16 turns"]);
    refused(&shape(Gielis::rational(1, 0, 3.0, 3.0, 3.0)), &["supershape: equator.m is inf"]);
    refused(&shape(Gielis::rational(0, 0, 3.0, 3.0, 3.0)), &["supershape: equator.m is NaN"]);
    refused(&Supershape::new(circle, envelope).into(), &["supershape: meridian.turns is 1, allowed: 1"]);
    refused(&shape(Gielis { m: -1.0, ..good }), &["equator.m is -1"]);
    refused(&shape(Gielis { m: 65.0, ..good }), &["equator.m is 65"]);
    refused(&shape(Gielis { n1: 0.0, ..good }), &["equator.n1 is 0"]);
    refused(&shape(Gielis { n2: -2.0, ..good }), &["equator.n2 is -2"]);
    refused(&shape(Gielis { n3: 1e9, ..good }), &["equator.n3 is 1000000000"]);
    refused(&shape(Gielis { a: 0.0, ..good }), &["equator.a is 0"]);
    refused(&shape(Gielis { b: f64::NAN, ..good }), &["equator.b is NaN"]);
    refused(&shape(Gielis::new(4.0, 0.1, 60.0, 60.0)), &["equator.", "100"]);
    for bad in NOT_NUMBERS {
        for curve in [
            Gielis { m: bad, ..good },
            Gielis { n1: bad, ..good },
            Gielis { n2: bad, ..good },
            Gielis { a: bad, ..good },
        ] {
            refused(&shape(curve), &["supershape: equator."]);
        }
    }
    refused(&Supershape::new(circle, Gielis { n1: -1.0, ..good }).into(), &["supershape: meridian.n1 is -1"]);
    let uneven = Supershape::with(Gielis { a: 1.5, ..good }, circle, DVec3::ONE, Radius::Rational);
    refused(&uneven.into(), &["equator.a is 1.5", "1 for the rational radius"]);
}

#[test]
fn joins_of_nothing() {
    let nothing: &[Solid] = &[];
    for rule in [RFunction::MIN_MAX, RFunction::P(2.0)] {
        for solid in [Solid::union_all(nothing, rule), Solid::intersection_all(nothing, rule)] {
            let error = solid.value(DVec3::ZERO).unwrap_err();
            assert!(matches!(error, SolidError::EmptyJoin { .. }), "{error}");
            let text = (Solid::sphere(1.0) - solid.rotate_x(rad(1.0))).value(DVec3::ZERO).unwrap_err().to_string();
            assert!(text.starts_with("difference[1] / rotate_x / "), "{text}");
            assert!(text.contains("0 operands") && text.contains("1 or more"), "{text}");
        }
    }
    // Without the others it is the first.
    let ball = Solid::sphere(1.0);
    assert_eq!(ball.difference_all(nothing, RFunction::P(2.0)).value(DVec3::ZERO), Ok(1.0));
    assert_eq!(Solid::union_all([ball], RFunction::P(2.0)).value(DVec3::ZERO), Ok(1.0));
}

#[test]
fn rules_out_of_range() {
    let (a, b) = (Solid::sphere(1.0), Solid::sphere(2.0));
    for alpha in [-1.0, -1.5, 1.0001, f64::NAN, f64::INFINITY] {
        refused(&a.union(&b, RFunction::Alpha(alpha)), &["union: alpha is ", "above -1, up to 1"]);
        refused(&a.difference(&b, RFunction::Alpha(alpha)), &["difference: alpha is "]);
    }
    for p in [1.0, 1.0009, 0.0, -2.0, 1001.0, f64::NAN, f64::INFINITY] {
        refused(&a.union(&b, RFunction::P(p)), &["union: p is ", "1.001 to 1000"]);
        refused(&a.intersection(&b, RFunction::Associative(p)), &["intersection: p is ", "1.001 to 1000"]);
        refused(&a.symmetric_difference(&b, RFunction::P(p)), &["symmetric difference: p is "]);
    }
    refused(&a.union(&b, RFunction::Zero { m: 9 }), &["union: m is 9, allowed: 0 to 8"]);
}

#[test]
fn a_taper_that_inverts() {
    let ball = Solid::sphere(1.0);
    for bad in [1.0, -1.0, 1.5, -3.0] {
        let text = format!("is {bad}, allowed: -0.999 to 0.999");
        refused(&ball.taper(bad, 0.0, 2.0), &["taper: kx ", &text]);
        refused(&ball.taper(0.0, bad, 2.0), &["taper: ky ", &text]);
    }
    assert!(ball.taper(0.999, -0.999, 2.0).value(DVec3::ZERO).is_ok());
}

#[test]
fn a_bend_that_folds() {
    // Towards the centre of curvature the box reaches 1: its radius must be beyond.
    let block = Solid::cuboid(DVec3::new(2.0, 1.0, 3.0));
    assert!(block.bend(0.99, deg(0.0)).value(DVec3::ZERO).is_ok());
    let error = refused(&block.bend(1.01, deg(0.0)), &["bend: curvature is 1.01, allowed: ", "1.0"]);
    assert_eq!(error.value, 1.01);
    // Half a turn at most: π/1.5 is 2.094.
    let rod = Solid::cylinder(0.01, 3.0);
    assert!(rod.bend(2.09, deg(0.0)).value(DVec3::ZERO).is_ok());
    refused(&rod.bend(2.1, deg(0.0)), &["bend: curvature is 2.1", "2.094"]);
    // The solid's own box counts, wherever it has been moved.
    refused(&block.translate(DVec3::X * 9.0).bend(0.11, deg(0.0)), &["bend: curvature is 0.11"]);
    assert!(block.translate(DVec3::X * 9.0).bend(-0.11, deg(0.0)).value(DVec3::ZERO).is_ok());
    // An unbounded solid folds at any curvature.
    refused(&Solid::half_space(DVec3::Z, 0.0).bend(1e-3, deg(0.0)), &["bend: curvature is 0.001"]);
}

#[test]
fn maps_without_an_inverse() {
    let ball = Solid::sphere(1.0);
    refused(&ball.scale(0.0), &["scale: ", "invertible"]);
    refused(&ball.scale_axes(DVec3::new(1.0, 0.0, 1.0)), &["scale_axes: ", "invertible"]);
    let flat = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::X + DVec3::Y);
    refused(&ball.affine(DAffine3::from_mat3(flat)), &["affine: ", "invertible"]);
    refused(&ball.affine(DAffine3::from_mat3(DMat3::ZERO)), &["affine: ", "invertible"]);
    refused(&ball.rotate(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0).normalize()), &["rotate: "]);
    // A mirror has one.
    assert!(ball.scale(-1.0).value(DVec3::ZERO).is_ok());
}

#[test]
fn the_unbounded_node_is_named() {
    let ground = Solid::half_space(DVec3::new(0.0, 1.0, 1.0), 0.0);
    let settings = MeshSettings { cell: CellSize::LongestSide(8), ..MeshSettings::default() };
    let path = |solid: &Solid| match solid.mesh(&settings) {
        Err(MeshingError::Solid(SolidError::Unbounded { path })) => path,
        other => panic!("meshed without bounds: {other:?}"),
    };
    assert_eq!(path(&ground), "half-space");
    assert_eq!(path(&(Solid::sphere(1.0) | ground.rotate_x(rad(0.3)))), "union[1] / rotate_x / half-space");
    assert_eq!(path(&!Solid::sphere(1.0)), "complement");
    assert_eq!(path(&(&ground - Solid::sphere(1.0))), "difference");
    assert_eq!(path(&ground.twist(rad(1.0))), "twist / half-space");
    let text = (Solid::sphere(1.0) | ground.clone()).mesh(&settings).unwrap_err().to_string();
    assert!(text.contains("union[1] / half-space") && text.contains("bounds"), "{text}");

    // With bounds it meshes; cut by something bounded it needs none.
    let bounds = Some(Bounds::from_center(DVec3::ZERO, DVec3::ONE));
    let mesh = ground.mesh(&MeshSettings { bounds, ..settings.clone() }).unwrap();
    assert!(mesh.check().is_closed());
    assert!((ground & Solid::sphere(1.0)).mesh(&settings).unwrap().check().is_closed());
}

#[test]
fn mesh_settings_out_of_range() {
    let ball = Solid::sphere(1.0);
    let at = |bounds: Bounds| MeshSettings { bounds: Some(bounds), ..MeshSettings::default() };
    for bounds in [
        Bounds::EMPTY,
        Bounds::ALL,
        Bounds::new(DVec3::ONE, DVec3::ZERO),
        Bounds::new(DVec3::ZERO, DVec3::ZERO),
        Bounds::new(DVec3::NAN, DVec3::ONE),
        Bounds::new(DVec3::ZERO, DVec3::new(1.0, f64::INFINITY, 1.0)),
    ] {
        let text = ball.mesh(&at(bounds)).unwrap_err().to_string();
        assert!(text.contains("bounds are") && text.contains("allowed"), "{text}");
    }
    let cells = |cell: CellSize| ball.mesh(&MeshSettings { cell, ..MeshSettings::default() }).unwrap_err().to_string();
    assert!(cells(CellSize::LongestSide(0)).contains("is 0; it must be at least 1"));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(cells(CellSize::Length(bad)).contains(&format!("cell size is {bad}")));
    }
}

#[test]
fn building_never_panics() {
    let extremes = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, -1.0, 1e-310, 1e-30, 1.0, 1e30, f64::MAX];
    for a in extremes {
        for b in extremes {
            let built = catch_unwind(|| {
                let leaves = [
                    Solid::sphere(a),
                    Solid::cuboid(DVec3::new(a, b, 1.0)),
                    Solid::cylinder(a, b),
                    Solid::half_space(DVec3::new(a, b, 0.0), a),
                    Solid::superellipsoid(DVec3::new(a, b, a), b, a),
                    Supershape::new(Gielis::new(a, b, a, b), Gielis { a, b, ..Gielis::circle() }).into(),
                ];
                let maps = |s: &Solid| {
                    [
                        s.translate(DVec3::new(a, b, 0.0)),
                        s.rotate(DQuat::from_xyzw(a, b, a, b)),
                        s.rotate_x(rad(a)).rotate_y(rad(b)).rotate_z(rad(a)),
                        s.scale(a),
                        s.scale_axes(DVec3::new(a, b, 1.0)),
                        s.affine(DAffine3::from_cols(DVec3::splat(a), DVec3::splat(b), DVec3::ONE, DVec3::ZERO)),
                        s.taper(a, b, a),
                        s.twist(rad(a)),
                        s.bend(a, rad(b)),
                    ]
                };
                let mut all: Vec<Solid> = leaves.to_vec();
                all.extend(maps(&Solid::sphere(1.0)));
                all.extend(maps(&Solid::half_space(DVec3::Z, 0.0)));
                for rule in [RFunction::Alpha(a), RFunction::P(b), RFunction::Associative(a), RFunction::Zero { m: 99 }]
                {
                    all.push(leaves[0].union(&leaves[1], rule) ^ !leaves[2].clone());
                    all.push(Solid::sphere(1.0).difference(Solid::cuboid(DVec3::ONE), rule));
                }
                for solid in &all {
                    let _ = format!("{solid:?}");
                    // Either a value or an error, and never a value that is not a number.
                    if let Ok(value) = solid.value(DVec3::new(0.1, 0.2, 0.3)) {
                        assert!(value.is_finite(), "{solid:?} is {value}");
                    }
                    let _ = solid.bounds();
                }
            });
            assert!(built.is_ok(), "parameters {a} and {b}");
        }
    }
}
