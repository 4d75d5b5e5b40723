//! Rounded and chamfered edges of end faces, by closed forms and by brute force.
//!
//! With A(s) the area of what is further than s within the profile, an extrusion of the height h
//! has the volume `A(0)(h − 2r) + 2∫A(s(t)) dt` over t from 0 to r, where s(t) is how far the edge
//! is cut back at t.

use std::error::Error;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rvachev::{Bounds, Caps, CellSize, Extrusion, Helix, MeshSettings, Profile, Solid, deg, program::Tape, rad};

use crate::narrow::check_narrowing;
use crate::support::{Random, lanes32, near, near_point};
use crate::zoo::random_profile;

type Outcome = Result<(), Box<dyn Error>>;

const HEIGHT: f64 = 6.0;
const SIZE: f64 = 1.0;

fn with(profile: &Profile, caps: Caps) -> Solid {
    profile.extrude_with(&Extrusion { caps, ..Extrusion::new(HEIGHT) })
}

fn both() -> [Caps; 2] {
    [Caps::Rounded(SIZE), Caps::Chamfered(SIZE)]
}

/// How far an edge is cut back so far from the end face.
fn cut_back(caps: Caps, t: f64) -> f64 {
    match caps {
        Caps::Rounded(r) => r - (r * r - (r - t) * (r - t)).max(0.0).sqrt(),
        Caps::Chamfered(leg) => leg - t,
        _ => 0.0,
    }
}

fn volume(area: impl Fn(f64) -> f64, caps: Caps) -> f64 {
    const STEPS: u32 = 20_000;
    let step = SIZE / f64::from(STEPS);
    let rims: f64 = (0..STEPS).map(|i| area(cut_back(caps, (f64::from(i) + 0.5) * step)) * step).sum();
    area(0.0) * (HEIGHT - 2.0 * SIZE) + 2.0 * rims
}

/// The area of what is further than s within an outline: `corners` is π for a smooth convex one, 1
/// for every right angle, −π/4 for an inner one.
fn steiner(area: f64, perimeter: f64, corners: f64) -> impl Fn(f64) -> f64 {
    move |s| area - perimeter * s + corners * s * s
}

/// Area and perimeter of an outline.
fn measures(outline: &[DVec2]) -> (f64, f64) {
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    sides.fold((0.0, 0.0), |(area, length), (a, b)| (area + 0.5 * a.perp_dot(*b), length + a.distance(*b)))
}

fn superellipse(semi_axes: DVec2, exponent: f64) -> Vec<DVec2> {
    let at = |i: u32| {
        let (sin, cos) = (2.0 * PI * f64::from(i) / 40_000.0).sin_cos();
        let bent = |x: f64| x.signum() * x.abs().powf(2.0 / exponent);
        semi_axes * DVec2::new(bent(cos), bent(sin))
    };
    (0..40_000).map(at).collect()
}

fn l_profile() -> Profile {
    Profile::polygon([[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [4.0, 4.0], [4.0, 10.0], [0.0, 10.0]])
}

/// The area of what is further than this within a profile.
type Area = Box<dyn Fn(f64) -> f64>;

/// Profiles, and what is further within.
fn profiles() -> Vec<(&'static str, Profile, Area)> {
    let l_area = || Box::new(steiner(64.0, 40.0, 5.0 - PI / 4.0));
    let (oval, round) = (DVec2::new(8.0, 6.0), DVec2::new(8.0, 5.0));
    let ((area, length), (round_area, round_length)) =
        (measures(&superellipse(oval, 2.5)), measures(&superellipse(round, 2.0)));
    let arms =
        Profile::rectangle([10.0, 4.0]).translate([5.0, 2.0]) | Profile::rectangle([4.0, 10.0]).translate([2.0, 5.0]);
    let holed = Profile::circle(10.0) - Profile::circle(3.0).translate([4.0, 0.0]);
    let apothem = 5.0 * 0.75f64.sqrt();
    vec![
        ("disk", Profile::circle(5.0), Box::new(|s| PI * (5.0 - s) * (5.0 - s))),
        ("square", Profile::rectangle([8.0, 8.0]), Box::new(|s| (8.0 - 2.0 * s) * (8.0 - 2.0 * s))),
        ("hexagon", Profile::regular_polygon(6, 5.0), Box::new(move |s| 12f64.sqrt() * (apothem - s) * (apothem - s))),
        ("L", l_profile(), l_area()),
        ("L of two", arms, l_area()),
        ("holed", holed, Box::new(|s| PI * (10.0 - s) * (10.0 - s) - PI * (3.0 + s) * (3.0 + s))),
        ("superellipse", Profile::superellipse(oval, 2.0 / 2.5), Box::new(steiner(area, length, PI))),
        ("stretched", Profile::circle(1.0).scale_axes(round), Box::new(steiner(round_area, round_length, PI))),
    ]
}

#[test]
fn rims_have_the_volume_of_their_formula() -> Outcome {
    for (name, profile, area) in profiles() {
        for caps in both() {
            let settings = MeshSettings { cell: CellSize::LongestSide(160), ..MeshSettings::default() };
            let report = with(&profile, caps).mesh(&settings)?.check();
            let (want, sharp) = (volume(&area, caps), area(0.0) * HEIGHT);
            println!(
                "{name}, {caps:?}: {:.4}, want {want:.4}; {:+.4} % of what is taken off",
                report.volume,
                100.0 * (report.volume - want) / (sharp - want)
            );
            assert!(report.is_sound(), "{name}, {caps:?}: {report}");
            near(report.volume, want, 5e-4 * want);
        }
    }
    Ok(())
}

/// A gear of twelve teeth and 96 edges, each tooth of eight corners: radii, and angles in pitches.
fn gear() -> Profile {
    const TOOTH: [[f64; 2]; 4] = [[16.0, -0.36], [16.2, -0.27], [17.5, -0.22], [20.0, -0.12]];
    let half = TOOTH.into_iter().chain(TOOTH.into_iter().rev().map(|[radius, angle]| [radius, -angle]));
    let corners = (0..12).flat_map(|tooth| half.clone().map(move |[r, angle]| [r, f64::from(tooth) + angle]));
    Profile::polygon(corners.map(|[r, pitches]| r * DVec2::from_angle(PI * pitches / 6.0)))
}

/// The volume of the gear by shapely 2.1: `buffer(-s, quad_segs=256)`, summed over 400 steps of t.
#[test]
fn rims_of_a_gear_and_of_a_plate_with_a_hole_have_their_volume_and_no_dust() -> Outcome {
    let plate = Profile::rounded_rectangle([40.0, 20.0], 4.0) - Profile::circle(6.0);
    let of_plate = |s: f64| {
        let (corner, hole) = (4.0 - s, 6.0 + s);
        (40.0 - 2.0 * s) * (20.0 - 2.0 * s) - (4.0 - PI) * corner * corner - PI * hole * hole
    };
    for (name, profile, caps, want, genus) in [
        ("gear", gear(), Caps::Rounded(SIZE), 5809.6173, 0),
        ("gear", gear(), Caps::Chamfered(SIZE), 5712.7246, 0),
        ("plate", plate.clone(), Caps::Rounded(SIZE), volume(of_plate, Caps::Rounded(SIZE)), 1),
        ("plate", plate.clone(), Caps::Chamfered(SIZE), volume(of_plate, Caps::Chamfered(SIZE)), 1),
    ] {
        let settings = MeshSettings { cell: CellSize::LongestSide(128), ..MeshSettings::default() };
        let mesh = with(&profile, caps).mesh(&settings)?;
        let report = mesh.check();
        println!("{name}, {caps:?}: {:.4}, want {want:.4}; {report}", report.volume);
        assert!(report.is_sound(), "{name}, {caps:?}: {report}");
        assert_eq!((report.shells, report.genus), (1, Some(genus)), "{name}, {caps:?}");
        near(report.volume, want, 5e-4 * want);
    }
    // The largest circle in the gear is between the teeth; that in the plate touches the hole.
    for (profile, most) in [(gear(), 15.957), (plate, 7.15)] {
        for caps in [Caps::Rounded, Caps::Chamfered] {
            let high = |size: f64| profile.extrude_with(&Extrusion { caps: caps(size), ..Extrusion::new(40.0) });
            assert!(high(0.95 * most).bounds().is_ok() && refusal(&high(1.05 * most)).contains("largest circle"));
        }
    }
    Ok(())
}

/// The distance to an outline that is given by close points.
fn nearest(outline: &[DVec2], p: DVec2) -> f64 {
    outline.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min).sqrt()
}

/// Fails unless points about the rim are inside by the formula, with distances by brute force in
/// the section at z, which is `scale` times the profile.
fn follows_the_formula(
    solid: &Solid,
    outline: &[DVec2],
    caps: Caps,
    slack: f64,
    section: impl Fn(f64) -> (f64, DVec2),
) -> Outcome {
    let mut random = Random::new(77);
    let mut near_rim = 0;
    for _ in 0..4000 {
        let end = if random.chance(0.5) { 1.0 } else { -1.0 };
        let t = random.range(0.0, 1.5 * SIZE);
        let z = end * (0.5 * HEIGHT - t);
        let (scale, turn) = section(z);
        let q = outline[random.below(outline.len())] * random.range(0.6, 1.0);
        let d = nearest(outline, q) * section(end * 0.5 * HEIGHT).0;
        let inside = match caps {
            Caps::Rounded(r) => r - (r - d.min(r)).hypot(r - t.min(r)),
            Caps::Chamfered(leg) => d + t - leg,
            _ => d.min(t),
        };
        if inside.abs() < slack {
            continue;
        }
        near_rim += usize::from(inside.abs() < 0.3 * SIZE);
        let p = (scale * turn.rotate(q)).extend(z);
        assert_eq!(solid.contains(p)?, inside > 0.0, "{caps:?} at {p}: d {d}, t {t}");
    }
    assert!(near_rim > 200, "{near_rim}");
    Ok(())
}

#[test]
fn rims_of_gauges_and_of_twisted_and_scaled_ones_follow_the_formula() -> Outcome {
    let outline: Vec<DVec2> = superellipse(DVec2::new(8.0, 6.0), 2.5).into_iter().step_by(20).collect();
    let profile = Profile::superellipse([8.0, 6.0], 2.0 / 2.5);
    let still = |_: f64| (1.0, DVec2::X);
    for caps in both() {
        follows_the_formula(&with(&profile, caps), &outline, caps, 3e-3, still)?;
        let twisted = Extrusion { caps, twist: deg(40.0), ..Extrusion::new(HEIGHT) };
        let turn = |z: f64| (1.0, DVec2::from_angle((40f64 * (z / HEIGHT + 0.5)).to_radians()));
        follows_the_formula(&profile.extrude_with(&twisted), &outline, caps, 3e-3, turn)?;
        let scaled = Extrusion { caps, scale: 0.5, ..Extrusion::new(HEIGHT) };
        let size = |z: f64| (0.75 - 0.5 * z / HEIGHT, DVec2::X);
        follows_the_formula(&profile.extrude_with(&scaled), &outline, caps, 3e-3, size)?;
    }
    Ok(())
}

fn refusal(solid: &Solid) -> String {
    solid.bounds().map_or_else(|error| error.to_string(), |bounds| format!("{bounds:?}"))
}

#[test]
fn caps_larger_than_half_the_height_are_refused() {
    let error = refusal(&with(&Profile::circle(9.0), Caps::Rounded(3.1)));
    assert_eq!(error, "extrude: caps (radius) is 3.1, allowed: up to 3, half the height");
    let error = refusal(&with(&Profile::circle(9.0), Caps::Chamfered(4.0)));
    assert_eq!(error, "extrude: caps (leg) is 4, allowed: up to 3, half the height");
    assert!(with(&Profile::circle(9.0), Caps::Rounded(3.0)).bounds().is_ok());
}

#[test]
fn caps_that_leave_nothing_of_the_section_are_refused() {
    let limit = |solid: &Solid| {
        let text = refusal(solid);
        let (_, rest) = text.split_once("allowed: below ").unwrap_or_else(|| panic!("{text}"));
        let (number, rest) = rest.split_once(", ").unwrap_or_else(|| panic!("{text}"));
        assert_eq!(rest, "the radius of the largest circle within the section", "{text}");
        number.parse::<f64>().unwrap_or_else(|_| panic!("{text}"))
    };
    let error = refusal(&with(&Profile::rectangle([2.0, 3.0]), Caps::Chamfered(1.5)));
    let text = "extrude: caps (leg) is 1.5, allowed: below 1, the radius of the largest circle within the section";
    assert_eq!(error, text);
    // Each profile with the radius of the largest circle in it.
    let slot = Profile::rectangle([9.0, 1.0]) & Profile::circle(4.0);
    let gauge = Profile::superellipse([2.0, 1.5], 2.0 / 2.5);
    let pair = Profile::circle(1.0).translate([-3.0, 0.0]) | Profile::circle(1.6).translate([3.0, 0.0]);
    let arms = 8.0 - 4.0 * 2f64.sqrt();
    for (profile, most) in [(Profile::circle(1.0), 1.0), (slot, 0.5), (gauge, 1.5), (pair, 1.6), (l_profile(), arms)] {
        for caps in [Caps::Rounded, Caps::Chamfered] {
            near(limit(&with(&profile, caps(1.01 * most))), most, 2e-3 * most);
            assert!(with(&profile, caps(0.99 * most)).bounds().is_ok(), "{profile} with {most}");
        }
    }
    let scaled = Extrusion { scale: 0.5, caps: Caps::Rounded(0.6), ..Extrusion::new(HEIGHT) };
    near(limit(&Profile::circle(1.0).extrude_with(&scaled)), 0.5, 1e-3);
    let coil = |ends| Profile::circle(0.5).sweep_helix(&Helix { ends, ..Helix::new(5.0, 2.0, 0.05) });
    assert!(refusal(&coil(Caps::Rounded(0.5))).starts_with("sweep_helix: ends (radius) is 0.5, allowed: below 0.5"));
    assert!(refusal(&coil(Caps::Rounded(0.9))).contains("half the length of the helix"));
    assert!(coil(Caps::Rounded(0.4)).bounds().is_ok());
}

#[test]
fn what_is_wrong_with_the_profile_is_told_by_its_path() {
    let slot = Profile::rectangle([-2.0, 9.0]).named("slot");
    let error = refusal(&with(&(Profile::circle(5.0) - slot), Caps::Rounded(1.0)));
    assert!(error.starts_with("extrude / difference[1] / slot: rectangle: size.x is -2"), "{error}");
}

#[test]
fn a_section_without_end_has_caps() -> Outcome {
    let plate = (!Profile::circle(3.0)).extrude_with(&Extrusion { caps: Caps::Rounded(1.0), ..Extrusion::new(4.0) });
    assert!(plate.contains([9.0, 0.0, 1.99])? && !plate.contains([3.1, 0.0, 1.9])?);
    Ok(())
}

#[test]
fn a_simplified_solid_has_its_rims() -> Outcome {
    let profile = (Profile::circle(4.0).named("a") | Profile::circle(3.0).translate([3.0, 0.0])).translate([0.0, 0.0]);
    let solid = with(&profile, Caps::Rounded(1.0));
    let simple = solid.simplified();
    for p in [[-3.9, 0.0, 2.9], [-3.6, 0.0, 2.6], [5.9, 0.0, 2.9], [0.0, 0.0, 2.9]].map(DVec3::from_array) {
        assert_eq!(solid.contains(p)?, simple.contains(p)?);
    }
    Ok(())
}

/// Extrusions with rims of random profiles.
fn rimmed(random: &mut Random) -> Solid {
    let depth = random.below(2);
    let profile = random_profile(random, depth);
    let size = random.range(0.01, 0.2);
    profile.extrude_with(&Extrusion {
        height: random.range(0.4, 1.5),
        twist: rad(random.pick(&[0.0, 0.0, 1.0, -0.7])),
        scale: random.pick(&[1.0, 1.0, 0.6, 1.5]),
        caps: random.pick(&[Caps::Rounded(size), Caps::Chamfered(size)]),
    })
}

#[test]
fn rims_narrow_soundly() -> Outcome {
    let mut random = Random::new(4111);
    let mut count = 0;
    while count < 8 {
        let solid = rimmed(&mut random);
        // What does not fit is refused.
        if solid.bounds().is_err() {
            continue;
        }
        count += 1;
        check_narrowing(&mut random, &solid, 12);
        let blended = solid.smooth_union(Solid::sphere(0.3).translate([0.6, 0.0, 0.3]), 0.2);
        check_narrowing(&mut random, &blended, 6);
    }
    Ok(())
}

#[test]
fn lanes_of_rims_have_the_sign_of_their_values() -> Outcome {
    let mut random = Random::new(4112);
    for (name, profile, _) in profiles() {
        for caps in both() {
            let program = with(&profile, caps).surface_program()?;
            let region = Bounds::from_center(DVec3::ZERO, DVec3::new(22.0, 22.0, 7.0));
            let points: Vec<DVec3> = (0..4096).map(|_| random.point_in(&region)).collect();
            let (seen, values) = lanes32(&program, &region, &points);
            let roundoff = Tape::new(&program, &region).roundoff();
            for (p, value) in seen.into_iter().zip(values) {
                let want = program.value(p);
                assert!((value - want).abs() <= roundoff, "{name}, {caps:?} at {p}: {value}, want {want}");
            }
        }
    }
    Ok(())
}

#[test]
fn gradients_of_rims_are_those_of_their_values() -> Outcome {
    const STEP: f64 = 1e-5;
    let mut random = Random::new(4113);
    for (name, profile, _) in profiles() {
        for caps in both() {
            let solid = with(&profile, caps);
            let mut smooth = 0;
            for _ in 0..400 {
                let p = random.vector(-1.0, 1.0) * DVec3::new(11.0, 11.0, 4.0);
                let value = |axis: DVec3| solid.value(p + axis);
                let [forward, back] = [1.0, -1.0].map(|sign| DVec3::AXES.map(|axis| value(sign * STEP * axis)));
                let mut change = DVec3::ZERO;
                let mut bend = 0.0f64;
                let here = solid.value(p)?;
                for (axis, (up, down)) in forward.into_iter().zip(back).enumerate() {
                    let (up, down) = (up?, down?);
                    change[axis] = (up - down) / (2.0 * STEP);
                    bend = bend.max((up - 2.0 * here + down).abs() / STEP);
                }
                if bend < 1e-3 {
                    smooth += 1;
                    near_point(solid.gradient(p)?, change, 5e-3);
                }
            }
            assert!(smooth > 300, "{name}, {caps:?}: {smooth}");
        }
    }
    Ok(())
}
