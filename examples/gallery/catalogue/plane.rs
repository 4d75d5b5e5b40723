//! Profiles, and the solids that are made of them.

use std::f64::consts::TAU;

use glam::DVec2;
use rvachev::{Caps, Extrusion, Gielis, Helix, Polygon, Profile, Solid, deg, turns};

use super::Entry;

/// A plate of this profile, upright.
fn plate(profile: impl Into<Profile>) -> Solid {
    profile.into().extrude(0.5).rotate_x(deg(90.0))
}

fn arrow() -> Profile {
    Profile::polygon([
        [-1.0, -0.3],
        [0.1, -0.3],
        [0.1, -0.75],
        [1.1, 0.0],
        [0.1, 0.75],
        [0.1, 0.3],
        [-1.0, 0.3],
        [-0.7, 0.0],
    ])
}

/// A square with a round hole and an island in it: three contours.
fn polygon_with_holes() -> Polygon {
    let ring = |corners: u32, radius: f64| -> Vec<DVec2> {
        (0..corners).map(|i| radius * DVec2::from_angle(TAU * (f64::from(i) + 0.5) / f64::from(corners))).collect()
    };
    Polygon::new([ring(4, 1.3), ring(60, 0.75), ring(5, 0.45)])
}

/// A washer with three notches.
fn joined() -> Profile {
    let notch = Profile::rounded_rectangle([0.5, 0.5], 0.15).translate([1.0, 0.0]);
    let notches = (0..3).map(|i| notch.rotate(turns(0.25 + f64::from(i) / 3.0)));
    (Profile::circle(1.0) - Profile::circle(0.4)) - Profile::union_all(notches, Default::default())
}

pub const PROFILES: &[Entry] = &[
    ("profile_circle", || plate(Profile::circle(1.0))),
    ("profile_superellipse", || plate(Profile::superellipse([1.2, 0.8], 0.5))),
    ("profile_superpolygon", || plate(Profile::superpolygon(Gielis::new(5.0, 3.0, 6.0, 6.0), 1.0).rotate(deg(90.0)))),
    ("profile_rectangle", || plate(Profile::rectangle([2.0, 1.4]))),
    ("profile_rounded_rectangle", || plate(Profile::rounded_rectangle([2.0, 1.4], 0.35))),
    ("profile_regular_polygon", || plate(Profile::regular_polygon(7, 1.0))),
    ("profile_polygon", || plate(arrow())),
    ("profile_polygon_with_holes", || plate(polygon_with_holes())),
    ("profile_joined", || plate(joined())),
    ("profile_offset", || plate(arrow().offset(0.2))),
    ("profile_rounded", || plate(arrow().rounded(0.12))),
    ("profile_filleted", || plate(arrow().filleted(0.35))),
];

/// A cross with rounded arms.
fn cross() -> Profile {
    let arm = Profile::rounded_rectangle([1.8, 0.8], 0.15);
    arm.rotate(deg(90.0)) | arm
}

fn extruded(extrusion: Extrusion) -> Solid {
    cross().extrude_with(&extrusion)
}

/// The section of a bowl with a foot, drawn across the axis so that it has no border there:
/// what is left of the axis is cut off.
fn bowl() -> Profile {
    Profile::polygon([
        [-0.45, -0.7],
        [0.45, -0.7],
        [0.5, -0.6],
        [0.3, -0.4],
        [0.8, -0.1],
        [1.0, 0.6],
        [0.9, 0.6],
        [0.7, 0.0],
        [-0.7, 0.0],
    ])
}

fn wound(helix: Helix) -> Solid {
    Profile::rounded_rectangle([0.4, 0.36], 0.1).sweep_helix(&helix)
}

pub const SWEEPS: &[Entry] = &[
    ("extrude", || extruded(Extrusion::new(1.6))),
    ("extrude_twisted", || extruded(Extrusion { twist: deg(90.0), ..Extrusion::new(1.8) })),
    ("extrude_scaled", || extruded(Extrusion { scale: 0.4, ..Extrusion::new(1.6) })),
    ("extrude_chamfered", || extruded(Extrusion { caps: Caps::Chamfered(0.15), ..Extrusion::new(1.6) })),
    ("extrude_rounded", || extruded(Extrusion { caps: Caps::Rounded(0.2), ..Extrusion::new(1.6) })),
    ("revolve", || bowl().revolve()),
    ("revolve_by", || bowl().revolve_by(deg(252.0))),
    ("sweep_helix", || wound(Helix::new(0.8, 0.75, 2.0))),
    ("sweep_helix_left_handed", || wound(Helix { left_handed: true, ..Helix::new(0.8, 0.75, 2.0) })),
];
