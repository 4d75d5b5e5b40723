//! Offsets at hollow edges: those of unions, of holes, and of what fillets leave.

use std::f64::consts::TAU;

use glam::DVec3;
use rvachev::catalogue::Part;
use rvachev::{Blend, Bounds, Solid, catalogue, deg};

use super::Outcome;

/// A solid of the catalogue, a post that stands in it, a rib across it, and a twelfth of its size.
struct Case {
    solid: Solid,
    post: Solid,
    rib: Solid,
    small: f64,
}

fn case(name: &str) -> Case {
    let entry = catalogue().iter().find(|entry| entry.name() == name).expect("there is one of this name");
    let Part::Solid(solid) = entry.example() else { panic!("{name} is no solid") };
    let Bounds { min, max } = solid.bounds().expect("it is bounded");
    let (size, centre, side) = (max - min, 0.5 * (min + max), (max - min).min_element());
    let at = |x: f64, y: f64, z: f64| centre + DVec3::new(x, y, z) * size;
    Case {
        solid,
        post: Solid::cylinder(0.22 * side, 1.6 * size.z).translate(at(0.13, 0.07, 0.2)),
        rib: Solid::cuboid([0.9 * size.x, 0.2 * side, 0.7 * size.z]).rotate_z(deg(17.0)).translate(at(0.0, 0.0, 0.35)),
        small: 0.06 * side,
    }
}

/// Beside a hollow edge the greater of both values alone is seen, on both sides: what leads to the
/// edge goes by what has been seen of the other.
#[test]
fn surfaces_are_near_at_hollow_edges() -> Outcome {
    let fillet = |case: &Case| case.solid.difference_with(&case.post, Blend::Fillet { radius: case.small });
    type Make<'a> = &'a dyn Fn(&Case) -> Solid;
    let cases: [(&str, Make<'_>); 6] = [
        ("rounded_cuboid", &|case| (&case.solid - &case.rib).rounded(case.small)),
        ("difference", &|case| (&case.solid | &case.post).shell(case.small)),
        ("wedge", &|case| (&case.solid | &case.post).shell(case.small)),
        ("scale_axes", &|case| (&case.solid - &case.rib).rounded(case.small)),
        ("capsule", &fillet),
        ("extrude_with", &fillet),
    ];
    for (name, make) in cases {
        let told = make(&case(name)).accuracy()?;
        assert!(told.error < 6.0 * told.tolerance, "{name}: {told:?}");
    }
    Ok(())
}

/// A post in a wedge meets its slope in an ellipse, which the inner face of a shell is at a distance
/// from.
#[test]
fn shells_keep_away_from_hollow_edges() -> Outcome {
    let Case { solid, post, small, .. } = case("wedge");
    let inner = (solid | post).offset(-small);
    let told = inner.accuracy()?;
    // The slope is z = −¾ x; the post's axis is at (1.04, 0.14), its radius 0.44.
    let edge = |turn: f64| {
        let x = 1.04 + 0.44 * turn.cos();
        DVec3::new(x, 0.14 + 0.44 * turn.sin(), -0.75 * x)
    };
    for n in 0..40 {
        // About the end that is farthest down.
        let p = edge(TAU * (0.5 + 0.001 * f64::from(n - 20))) - DVec3::new(0.07, 0.0, 0.12);
        let nearest = (0..4000).map(|k| p.distance(edge(TAU * f64::from(k) / 4000.0))).fold(f64::INFINITY, f64::min);
        let value = inner.value(p)?;
        assert!((value - (nearest - small)).abs() < 6.0 * told.tolerance, "at {p}: {value}, {nearest}");
    }
    Ok(())
}
