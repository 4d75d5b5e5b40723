//! The verbs of profiles: those of solids, in the plane.

use std::collections::HashSet;

use glam::{DAffine2, DAffine3, DVec2, DVec3};
use rvachev::{
    Blend, CellSize, Circle, MeshSettings, Paint, Profile, RFunction, Rectangle, Solid, SolidError, catalogue,
    catalogue::{Call, Part},
    deg, rad, turns,
};

use crate::support::{Random, near};

const SHARP: RFunction = RFunction::MIN_MAX;

/// Distance to a circle, positive inside.
fn disc(centre: [f64; 2], radius: f64) -> impl Fn(DVec2) -> f64 {
    move |p| radius - p.distance(centre.into())
}

/// Distance to a rectangle about the origin, positive inside.
fn rectangle(size: [f64; 2]) -> impl Fn(DVec2) -> f64 {
    move |p| {
        let q = p.abs() - 0.5 * DVec2::from(size);
        -(q.max(DVec2::ZERO).length() + q.max_element().min(0.0))
    }
}

/// The value of a profile, and of the column over it at any height, against a formula.
fn is(name: &str, profile: &Profile, want: impl Fn(DVec2) -> f64) {
    let mut random = Random::new(910);
    let column = profile.column();
    for _ in 0..300 {
        let p = DVec2::new(random.range(-4.0, 4.0), random.range(-4.0, 4.0));
        let value = profile.value(p).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!((value - want(p)).abs() < 1e-9, "{name} at {p}: {value}, not {}", want(p));
        near(column.value(p.extend(random.range(-9.0, 9.0))).unwrap(), value, 1e-12);
        assert_eq!(profile.contains(p).unwrap(), value > 0.0, "{name} at {p}");
    }
}

fn round() -> Profile {
    Profile::circle(1.0)
}

fn square() -> Profile {
    Profile::rectangle([2.0, 3.0])
}

#[test]
fn joins_have_the_values_of_their_rule() {
    let (a, b) = (disc([0.0; 2], 1.0), rectangle([2.0, 3.0]));
    is("union", &round().union(square(), SHARP), |p| a(p).max(b(p)));
    is("intersection", &round().intersection(square(), SHARP), |p| a(p).min(b(p)));
    is("difference", &square().difference(Circle { radius: 1.0 }, SHARP), |p| b(p).min(-a(p)));
    let apart = |p: DVec2| a(p).max(b(p)).min(-a(p).min(b(p)));
    is("symmetric difference", &round().symmetric_difference(square(), SHARP), apart);
    is("complement", &round().complement(), |p| -a(p));
    let c = disc([2.0, 0.5], 0.7);
    let three = [round(), square(), Profile::circle(0.7).translate([2.0, 0.5])];
    is("union of many", &Profile::union_all(&three, SHARP), |p| a(p).max(b(p)).max(c(p)));
    is("intersection of many", &Profile::intersection_all(three.clone(), SHARP), |p| a(p).min(b(p)).min(c(p)));
    is("difference of many", &square().difference_all([&three[0], &three[2]], SHARP), |p| b(p).min(-a(p)).min(-c(p)));
}

#[test]
fn operators_are_those_of_solids() {
    let leaf = Rectangle { size: DVec2::new(2.0, 3.0), radius: 0.0 };
    let rule = RFunction::default();
    assert_eq!(round() | leaf, round().union(square(), rule));
    assert_eq!(&round() & &square(), round().intersection(square(), rule));
    assert_eq!(round() - square(), round().difference(square(), rule));
    assert_eq!(&round() ^ leaf, round().symmetric_difference(square(), rule));
    assert_eq!(!&round(), round().complement());
    let mut joined = round();
    joined |= square();
    joined &= Circle { radius: 9.0 };
    joined -= round().translate([3.0, 0.0]);
    joined ^= &square();
    let want = (((round() | square()) & Profile::circle(9.0)) - round().translate([3.0, 0.0])) ^ square();
    assert_eq!(joined, want);
}

#[test]
fn blends_shape_corners() -> Result<(), SolidError> {
    let (up, across) = (Profile::rectangle([1.0, 9.0]), Profile::rectangle([9.0, 1.0]));
    let tee = up.union_with(&across, Blend::Fillet { radius: 1.0 });
    // Between the bars the border is the circle about (1.5, 1.5).
    for degrees in [200.0, 225.0, 250.0] {
        let (sin, cos) = deg(degrees).sin_cos();
        near(tee.value([1.5 + cos, 1.5 + sin])?, 0.0, 2e-3);
        near(tee.value([1.5 + 0.8 * cos, 1.5 + 0.8 * sin])?, -0.2, 2e-3);
    }
    // The corners of the rectangle that both have in common.
    let plate = up.intersection_with(&across, Blend::Chamfer { leg: 0.2 });
    for [x, y] in [[0.5, 0.3], [0.4, 0.4], [0.3, 0.5]] {
        near(plate.value([x, y])?, 0.0, 1e-9);
    }
    let slotted = Profile::rectangle([9.0, 2.0]).difference_with(&up, Blend::Chamfer { leg: 0.25 });
    for [x, y] in [[0.5, 0.75], [0.625, 0.875], [0.75, 1.0]] {
        near(slotted.value([x, y])?, 0.0, 1e-9);
    }
    // Equal values change by a quarter of the radius.
    let (a, b) = (disc([0.0; 2], 1.0), disc([1.5, 0.0], 1.0));
    let other = round().translate([1.5, 0.0]);
    let at = |k: f64, x: f64, y: f64| 0.25 * (k - (x - y).abs()).max(0.0).powi(2) / k;
    is("smooth union", &round().smooth_union(&other, 0.6), |p| a(p).max(b(p)) + at(0.6, a(p), b(p)));
    is("smooth intersection", &round().smooth_intersection(&other, 0.6), |p| a(p).min(b(p)) - at(0.6, a(p), b(p)));
    is("smooth difference", &round().smooth_difference(&other, 0.6), |p| a(p).min(-b(p)) - at(0.6, a(p), -b(p)));
    assert_eq!(round().smooth_union(&other, 0.6), round().union_with(&other, Blend::Smooth { radius: 0.6 }));
    Ok(())
}

#[test]
fn maps_move_values_along() {
    let a = rectangle([2.0, 3.0]);
    is("translate", &square().translate([0.5, -1.0]), |p| a(p - DVec2::new(0.5, -1.0)));
    let quarter = square().rotate(turns(0.25));
    is("rotate", &quarter, rectangle([3.0, 2.0]));
    near(quarter.bounds().unwrap().max.distance(DVec2::new(1.5, 1.0)), 0.0, 1e-12);
    is("scale", &square().scale(-1.5), rectangle([3.0, 4.5]));
    is("scale along axes", &round().scale_axes([2.0, 2.0]), disc([0.0; 2], 2.0));
    is("affine", &round().affine(DAffine2::from_translation(DVec2::X)), disc([1.0, 0.0], 1.0));
    let off = round().translate([2.0, 0.5]);
    is("reflect", &off.reflect([3.0, 0.0], 0.5), disc([-1.0, 0.5], 1.0));
    is("reflect x", &off.reflect_x(), disc([-2.0, 0.5], 1.0));
    is("reflect y", &off.reflect_y(), disc([2.0, -0.5], 1.0));
    let pair = |first: [f64; 2], second: [f64; 2]| {
        let (first, second) = (disc(first, 1.0), disc(second, 1.0));
        move |p: DVec2| first(p).max(second(p))
    };
    is("mirrored", &off.mirrored([1.0, 0.0], 0.5), pair([2.0, 0.5], [-1.0, 0.5]));
    is("mirrored x", &off.mirrored_x(), pair([2.0, 0.5], [-2.0, 0.5]));
    is("mirrored y", &off.mirrored_y(), pair([2.0, 0.5], [2.0, -0.5]));
    is("elongate", &round().elongate([2.0, 0.0]), |p| 1.0 - DVec2::new(p.x - p.x.clamp(-1.0, 1.0), p.y).length());
}

#[test]
fn repetition_is_the_union_of_the_copies() {
    let small = Profile::circle(0.4).translate([1.5, 0.2]);
    let of = |centres: Vec<DVec2>| {
        move |p: DVec2| centres.iter().map(|c| 0.4 - p.distance(*c)).fold(f64::NEG_INFINITY, f64::max)
    };
    let first = DVec2::new(1.5, 0.2);
    let grid = (0..12).map(|i| first + DVec2::new(f64::from(i % 3) * 1.1, f64::from(i / 3) * 0.9)).collect();
    is("repeat", &small.repeat([3, 4], [1.1, 0.9]), of(grid));
    let step = DVec2::new(-0.8, 0.6);
    is("repeat in a row", &small.repeat_linear(5, step), of((0..5).map(|i| first + f64::from(i) * step).collect()));
    let down = DVec2::new(0.0, -0.9);
    is("repeat down", &small.repeat_linear(4, down), of((0..4).map(|i| first + f64::from(i) * down).collect()));
    for count in [1, 2, 5, 12] {
        let about = |i: u32| DVec2::from_angle(turns(f64::from(i) / f64::from(count)).radians()).rotate(first);
        let ring = small.repeat_polar(count);
        is("repeat in a ring", &ring, of((0..count).map(about).collect()));
    }
    // Folded, not copied, though the column is unbounded along z.
    assert_eq!(small.repeat_polar(12).column().surface_program().unwrap().leaf_count(), 3);
    assert_eq!(small.repeat([9, 9], [1.1, 0.9]).column().surface_program().unwrap().leaf_count(), 4);
}

#[test]
fn lengths_are_those_of_the_plane() {
    let a = rectangle([2.0, 3.0]);
    is("level", &square().level(0.3), |p| a(p) + 0.3);
    is("offset", &square().offset(0.3), |p| a(p) + 0.3);
    is("shell", &round().shell(0.25), |p| (1.0 - p.length()).min(p.length() - 0.75));
    let band = square().shell(0.25);
    near(band.value([0.9, 0.0]).unwrap(), 0.1, 1e-12);
    assert!(!band.contains([0.7, 0.0]).unwrap());
}

#[test]
fn many_points_and_gradients() -> Result<(), SolidError> {
    let profile = square() - round();
    let points: Vec<DVec2> = (0..50).map(|i| DVec2::from_angle(f64::from(i)) * 0.05 * f64::from(i)).collect();
    let (values, within, slopes) =
        (profile.values(&points)?, profile.contains_all(&points)?, profile.gradients(&points)?);
    for (i, &p) in points.iter().enumerate() {
        near(values[i], profile.value(p)?, 1e-12);
        assert_eq!((within[i], slopes[i]), (profile.contains(p)?, profile.gradient(p)?));
    }
    assert_eq!(round().gradient([0.0, 2.0])?, -DVec2::Y);
    assert_eq!(square().value((3.0, 0.0))?, -2.0);
    Ok(())
}

#[test]
fn names_paint_and_text() -> Result<(), SolidError> {
    let slot = Profile::rectangle([0.5, 9.0]).named("slot").paint([200, 30, 30]);
    let plate = Profile::rectangle([6.0, 4.0]).paint(Paint { color: [1, 2, 3], roughness: 0.25 }) - &slot;
    assert_eq!(plate.owner([0.25, 0.0])?.path, "difference[1] / paint / slot: rectangle");
    assert_eq!(plate.paint_at([0.25, 0.0])?.map(|paint| paint.color), Some([200, 30, 30]));
    assert_eq!(plate.paint_at([3.0, 0.0])?.map(|paint| paint.roughness), Some(0.25));
    assert_eq!(plate.extrude(2.0).paint_at([3.0, 0.0, 0.3])?.map(|paint| paint.color), Some([1, 2, 3]));
    let wrong = (round() - Profile::circle(f64::NAN).named("bore")).value([0.0, 0.0]).unwrap_err();
    assert!(wrong.to_string().starts_with("difference[1] / bore: circle: radius is NaN"), "{wrong}");
    let moved = round().named("disc").rotate(deg(90.0)).scale(2.0);
    assert_eq!(moved.to_string(), "scale 2\n  rotate 90° about (0, 0, 1)\n    disc: circle { radius: 1.0 }");
    assert!(format!("{moved:?}").starts_with("Profile(scale(rotate(named \"disc\""), "{moved:?}");
    Ok(())
}

#[test]
fn profiles_are_values() {
    let notched = |depth: f64| square() - round().translate([depth, 0.0]);
    assert_eq!(notched(0.5), notched(0.5));
    assert_ne!(notched(0.5), notched(0.6));
    #[allow(
        clippy::mutable_key_type,
        reason = "what changes in a profile is the evaluator's cache, which is not hashed"
    )]
    let known: HashSet<Profile> = [notched(0.5), notched(0.5), notched(0.7)].into_iter().collect();
    assert!(known.len() == 2 && known.contains(&notched(0.7)));
    let twice = round().translate([1.0, 0.0]).translate([0.0, 2.0]);
    assert_eq!((twice.node_count(), twice.simplified().node_count()), (3, 2));
    assert_eq!(twice.simplified(), round().translate([1.0, 2.0]));
    assert_eq!(Profile::from(&twice), twice);
}

#[test]
fn solids_of_profiles_have_what_was_done_in_the_plane() -> Result<(), Box<dyn std::error::Error>> {
    let hole = Profile::circle(0.5).translate([2.0, 0.0]);
    let flange = (Profile::circle(3.0) - hole.repeat_polar(6)).extrude(1.0);
    let same = Solid::cylinder(3.0, 1.0) - Solid::cylinder(0.5, 2.0).translate([2.0, 0.0, 0.0]).repeat_polar(6);
    let mut random = Random::new(911);
    for _ in 0..500 {
        let p = DVec3::new(random.range(-3.5, 3.5), random.range(-3.5, 3.5), random.range(-0.7, 0.7));
        assert_eq!(flange.contains(p)?, same.contains(p)?, "{p}");
    }
    let bar = Profile::rectangle([1.0, 5.0]).union_with(Profile::rectangle([5.0, 1.0]), Blend::Fillet { radius: 0.5 });
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let mesh = bar.extrude(1.0).mesh(&settings)?;
    let report = mesh.check();
    assert!(report.is_closed() && report.is_manifold());
    // Four corners of a square less a quarter of a disc.
    let area = 9.0 + 4.0 * 0.25 * (1.0 - 0.25 * std::f64::consts::PI);
    near(mesh.volume(), area, 0.01 * area);
    Ok(())
}

#[test]
fn what_is_done_with_profiles_is_a_call_that_does_it_again() {
    let disc = Profile::circle(1.0);
    let done = [
        disc.repeat([3, 2], [4.0, 5.0]),
        disc.repeat_linear(4, [3.0, 1.0]),
        disc.repeat_polar(5),
        disc.elongate([1.0, 0.5]),
        disc.level(0.25),
        disc.reflect([0.6, 0.8], 0.5),
        disc.mirrored([0.6, 0.8], 0.5),
        disc.rotate(rad(0.7)),
        disc.scale(-0.3).simplified(),
        disc.affine_in_space(DAffine3::from_scale(DVec3::new(2.0, 3.0, 1.0))),
        disc.named("disc"),
        disc.paint([1, 2, 3]),
    ];
    for profile in done {
        let part = Part::Profile(profile);
        let call = Call::of(&part).expect("all of it is built in");
        assert_eq!(call.make().unwrap_or_else(|error| panic!("{part:?}: {error}")), part);
    }
    // What leaves no column takes none.
    let taper = catalogue().iter().find(|entry| entry.name() == "taper").expect("it is there");
    assert!(taper.make(&[Part::Profile(disc)], &taper.example_values()).is_err());
}
