//! Lengths that are closed forms: nothing is measured, and values are distances.

use glam::DVec3;
use rvachev::{
    Accuracy, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Prism, Profile, RFunction, RoundedCuboid, Solid, SolidError,
    Sphere, Superellipsoid, Torus, deg,
};

use crate::support::Random;

/// Leaves that stay of their kind where they are moved in by .3, and whether they are convex.
fn leaves() -> Vec<(&'static str, Solid, bool)> {
    vec![
        ("sphere", Sphere { radius: 1.3 }.into(), true),
        ("box", Cuboid { size: DVec3::new(4.0, 3.0, 2.0) }.into(), true),
        ("rounded box", RoundedCuboid { size: DVec3::new(4.0, 3.0, 2.0), radius: 0.2 }.into(), true),
        ("cylinder", Cylinder { radius: 1.5, height: 2.5 }.into(), true),
        ("cone", Cone { bottom_radius: 2.0, top_radius: 1.2, height: 2.2 }.into(), true),
        ("capsule", Capsule { radius: 1.0, height: 4.0 }.into(), true),
        ("torus", Torus { radius: 2.0, tube: 0.9 }.into(), false),
        ("prism", Prism::new(5, 2.0, 2.0).into(), true),
        ("rectangle", Profile::rectangle([3.0, 2.0]).extrude(2.0), true),
        ("circle", Profile::circle(1.5).extrude(2.0), true),
        ("hexagon", Profile::regular_polygon(6, 1.5).extrude(2.0), true),
        (
            "moved",
            Solid::cuboid([4.0, 3.0, 2.0]).named("part").scale(0.8).rotate_x(deg(40.0)).translate([1.0; 3]),
            true,
        ),
    ]
}

const RADIUS: f64 = 0.3;

/// All that are moved in, and out again, are told from the points that the ball's centre may be at.
#[test]
fn roundings_of_leaves_are_distances() -> Result<(), SolidError> {
    let mut random = Random::new(91);
    for (name, leaf, convex) in leaves() {
        let rounded = leaf.rounded(RADIUS);
        assert_eq!(rounded.accuracy()?, Accuracy::default(), "{name}");
        assert!(leaf.bounds()?.inflate(1e-9).contains_bounds(&rounded.bounds()?), "{name}");
        // By hand, it is the same.
        let by_hand = leaf.offset(-RADIUS).offset(RADIUS);
        for _ in 0..400 {
            let p = random.vector(-3.0, 3.0);
            let value = rounded.value(p)?;
            assert!((by_hand.value(p)? - value).abs() < 1e-12, "{name} at {p}");
            assert!(value <= leaf.value(p)? + 1e-12, "{name} at {p}: nothing is added");
            if value >= RADIUS || !convex && value > 0.0 {
                continue;
            }
            // The nearest centre of a ball, and nothing nearer.
            let slope = rounded.gradient(p)?;
            assert!((slope.length() - 1.0).abs() < 1e-6, "{name} at {p}: {slope}");
            let centre = p + (RADIUS - value) * slope;
            assert!((leaf.value(centre)? - RADIUS).abs() < 1e-9, "{name} at {p}: {centre}");
        }
    }
    Ok(())
}

/// Moved out or in by anything, they are what their distance says; so are their complements.
#[test]
fn lengths_of_roundings_are_levels_of_their_distance() -> Result<(), SolidError> {
    let mut random = Random::new(92);
    let ball = Solid::sphere(3.5);
    for (name, leaf, convex) in leaves() {
        let rounded = leaf.rounded(RADIUS);
        let inwards: &[f64] = if convex { &[-0.1, -RADIUS, -0.5] } else { &[] };
        for by in inwards.iter().chain(&[0.1, 0.7]) {
            let (offset, within) = (rounded.offset(*by), (&ball - &rounded).offset(-by));
            let (shell, there) = (rounded.shell(by.abs()), !(!&rounded).offset(-by));
            assert_eq!(offset.accuracy()?, Accuracy::default(), "{name} {by}");
            for _ in 0..200 {
                let p = random.vector(-3.0, 3.0);
                let value = rounded.value(p)?;
                if (value + by).abs() < 1e-9 || value.abs() < 1e-9 {
                    continue;
                }
                assert_eq!(offset.contains(p)?, value + by > 0.0, "{name} {by} at {p}");
                assert_eq!(there.contains(p)?, value + by > 0.0, "{name} {by} at {p}: of the complement");
                if *by < 0.0 {
                    assert_eq!(shell.contains(p)?, value > 0.0 && value + by < 0.0, "{name} {by} at {p}: shell");
                } else {
                    let expected = value + by < 0.0 && ball.value(p)? > *by;
                    assert_eq!(within.contains(p)?, expected, "{name} {by} at {p}: cavity");
                }
            }
        }
    }
    Ok(())
}

/// What is convex has no concave edges, whatever it is of.
#[test]
fn nothing_is_filled_of_what_is_convex() -> Result<(), SolidError> {
    let mut random = Random::new(93);
    let mut solids: Vec<Solid> = leaves().into_iter().filter(|(.., convex)| *convex).map(|(_, leaf, _)| leaf).collect();
    solids.push(Ellipsoid { semi_axes: DVec3::new(1.0, 2.0, 1.5) }.into());
    solids.push(Superellipsoid::new(DVec3::new(1.0, 2.0, 1.5), 0.3, 1.4).into());
    solids.push(
        Solid::cylinder(1.0, 3.0).scale_axes([1.0, 2.0, 0.5]).intersection(Solid::sphere(1.2), RFunction::MIN_MAX),
    );
    for solid in solids {
        let filled = solid.filleted(0.7);
        assert_eq!(filled.accuracy()?, Accuracy::default());
        for _ in 0..100 {
            let p = random.vector(-2.0, 2.0);
            assert_eq!(filled.value(p)?, solid.value(p)?, "{solid} at {p}");
        }
    }
    Ok(())
}

/// Extrusions of profiles by their distance are told from outside as from inside.
#[test]
fn offsets_of_extrusions_are_distances() -> Result<(), SolidError> {
    let corner = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.5], [1.5, 1.5], [1.5, 3.0], [0.0, 3.0]];
    let bracket = Profile::polygon(corner).extrude(2.0);
    let grown = bracket.offset(0.5);
    assert_eq!(grown.accuracy()?, Accuracy::default());
    // Off a face, an edge, a corner, and in the notch.
    assert!((grown.value([1.0, 1.0, 1.2])? - 0.3).abs() < 1e-12);
    assert!((grown.value([-0.3, -0.4, 0.0])?).abs() < 1e-12);
    assert!((grown.value([-0.3, -0.4, 1.5])? - (0.5 - 0.5f64.sqrt())).abs() < 1e-12);
    assert!((grown.value([2.0, 2.2, 0.0])?).abs() < 1e-12);
    Ok(())
}
