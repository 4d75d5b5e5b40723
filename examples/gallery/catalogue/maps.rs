//! Levels, offsets and shells, and maps.

use glam::{DAffine3, DMat3, DVec3};
use rvachev::{
    Solid, deg,
    law::{LawTable, SineWave, SmoothStep},
    rad, turns,
};

use super::Entry;

/// Without the quarter that is nearest to the viewer.
fn cut_open(solid: Solid) -> Solid {
    solid - Solid::cuboid([4.0; 3]).translate([2.0, -2.0, 0.0])
}

/// A block with a hole through it.
fn block() -> Solid {
    Solid::cuboid([2.0, 1.4, 1.0]) - Solid::cylinder(0.4, 2.0)
}

/// A step: convex edges, and a concave one.
fn step() -> Solid {
    Solid::cuboid([2.0, 1.4, 0.6]) | Solid::cuboid([0.8, 1.4, 0.8]).translate([-0.6, 0.0, 0.6])
}

/// A box with rounded edges and a neck.
fn flask() -> Solid {
    Solid::rounded_cuboid([2.0, 1.4, 1.2], 0.3) | Solid::cylinder(0.4, 1.2).translate([0.0, 0.0, 0.4])
}

pub const LENGTHS: &[Entry] = &[
    ("level", || block().level(0.2)),
    ("offset", || block().offset(0.2)),
    ("offset_inwards", || block().offset(-0.12)),
    ("shell", || cut_open(flask().shell(0.12))),
    ("rounded", || step().rounded(0.2)),
    ("filleted", || step().filleted(0.35)),
];

/// A flat bar along z.
fn bar() -> Solid {
    Solid::rounded_cuboid([0.9, 0.6, 2.4], 0.1)
}

/// A block with a hole, leaning to the right.
fn sheared() -> Solid {
    let matrix = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 1.0));
    block().affine(DAffine3::from_mat3(matrix))
}

fn tapered_by() -> Solid {
    let profile = LawTable::new([(-1.0, 1.0), (-0.2, 1.0), (0.2, 0.5), (0.7, 0.5), (1.0, 0.8)]);
    Solid::cylinder(0.8, 2.0).taper_by(profile.clone(), profile)
}

fn tapered_by_wave() -> Solid {
    let wave = SineWave { mean: 1.0, amplitude: 0.2, wavelength: 0.8, phase: deg(0.0) };
    Solid::cylinder(0.7, 2.4).taper_by(wave, wave)
}

/// Straight at both ends, a half turn in between.
fn twisted_by() -> Solid {
    bar().twist_by(deg(180.0), SmoothStep { from: (-0.8, 0.0), to: (0.8, 1.0) })
}

/// A hook on the right of the plane x = 0.
fn hook() -> Solid {
    let arm = Solid::cuboid([0.9, 0.5, 0.4]).translate([0.45, 0.0, 0.0]);
    let ring = Solid::torus(0.4, 0.18).rotate_x(deg(90.0)).translate([1.1, 0.0, 0.35]);
    arm | ring
}

/// Balls and rods, as a molecule: each copy touches the next.
fn knob() -> Solid {
    Solid::sphere(0.3) | Solid::cylinder(0.1, 1.0) | Solid::cylinder(0.1, 1.0).rotate_x(deg(90.0))
}

/// A step of a winding stair.
fn blade() -> Solid {
    Solid::superellipsoid([0.5, 0.12, 0.35], 0.5, 1.0).rotate_x(rad(0.6)).translate([0.75, 0.0, 0.0])
}

pub const MAPS: &[Entry] = &[
    ("affine", sheared),
    ("taper", || Solid::rounded_cuboid([1.6, 1.6, 2.0], 0.1).taper(0.5, -0.5, 2.0)),
    ("twist", || bar().twist(turns(0.4) / 2.4)),
    ("bend", || bar().bend(0.8, deg(0.0))),
    ("bend_between", || Solid::rounded_cuboid([0.5, 0.7, 3.0], 0.1).bend_between(-0.6, 0.6, deg(110.0), deg(0.0))),
    ("taper_by", tapered_by),
    ("taper_by_wave", tapered_by_wave),
    ("twist_by", twisted_by),
    ("mirrored", || hook().mirrored_x()),
    ("repeat", || knob().repeat([3, 3, 2], [0.8, 0.8, 0.8])),
    ("repeat_linear", || Solid::cuboid([1.4, 0.4, 0.25]).repeat_linear(6, [0.0, 0.3, 0.22])),
    ("repeat_polar", || blade().repeat_polar(9) | Solid::cylinder(0.35, 0.7)),
    ("elongate", || Solid::torus(0.5, 0.22).elongate([1.2, 0.0, 0.5])),
];
