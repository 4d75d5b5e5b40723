//! Random solids of every kind: all leaves, profiles, blends, lengths, maps and repetitions.

use glam::{DVec2, DVec3};
use rvachev::{
    Blend, Caps, Extrusion, GeneralisedSuperquadric, Helix, Polygon, Profile, Solid, Superhyperboloid, Supertoroid,
    law::{LinearLaw, SineWave, SmoothStep},
    rad,
};

use crate::support::Random;

/// A superquadric other than the superellipsoid.
fn superquadric(random: &mut Random) -> Solid {
    let axes = random.vector(0.2, 0.7);
    let (e1, e2) = (random.range(0.05, 2.5), random.range(0.05, 2.5));
    let half = random.range(0.3, 0.8);
    match random.below(6) {
        0 => Supertoroid::new(0.5 * axes, random.range(1.0, 3.0), e1.min(2.0), e2).into(),
        1 => Superhyperboloid::one_sheet(axes, e1, e2, 2.0 * half).into(),
        2 => Superhyperboloid::one_sheet_x(axes, e1, e2, 2.0 * half).into(),
        3 => Superhyperboloid::two_sheets(axes, e1, e2, 2.0 * (axes.z + half)).into(),
        4 => Superhyperboloid::two_sheets_x(axes, e1, e2, 2.0 * (axes.x + half)).into(),
        _ => GeneralisedSuperquadric::new(axes, [0; 3].map(|_| random.log_range(0.6, 30.0))).into(),
    }
}

/// A formula of fidget's, with its box.
#[cfg(feature = "formula")]
fn formula(random: &mut Random) -> Solid {
    let (x, y, z) = fidget::context::Tree::axes();
    let a = random.range(0.3, 0.7);
    let (a, r) = (f64::from(a as f32), a as f32);
    let (tree, half) = match random.below(4) {
        0 => ((x.square() + y.square() + z.square()).sqrt() - r, DVec3::splat(a + 1e-6)),
        1 => (x.abs().max(y.abs()).max(z.abs() * 0.5) - r, DVec3::new(a, a, 2.0 * a)),
        2 => {
            ((x.clone() * 7.0).sin() * 0.1 + (x.square() + y.square()).sqrt().max(z.abs()) - r, DVec3::splat(a + 0.11))
        }
        _ => {
            let across = (x.square() + y.square()).sqrt() - r;
            ((across.square() + z.square()).sqrt() - 0.4 * r, DVec3::new(1.41 * a, 1.41 * a, 0.41 * a))
        }
    };
    Solid::formula(&tree, rvachev::Bounds::from_center(DVec3::ZERO, half))
}

#[cfg(not(feature = "formula"))]
fn formula(random: &mut Random) -> Solid {
    Solid::torus(random.range(0.3, 0.6), 0.2)
}

/// A bounded plane shape within 1 of the origin.
pub fn random_profile(random: &mut Random, depth: usize) -> Profile {
    let a = random.range(0.2, 0.7);
    let b = random.range(0.2, 0.7);
    let kind = random.below(8);
    let plain = match kind {
        0 => Profile::circle(a),
        1 => Profile::superellipse(DVec2::new(a, b), random.range(0.1, 2.4)),
        2 => Profile::superpolygon(rvachev::Gielis::polygon(3 + random.below(6) as u32, 20.0), a),
        3 => Profile::rectangle(DVec2::new(2.0 * a, 2.0 * b)),
        4 => Profile::rounded_rectangle(DVec2::new(2.0 * a, 2.0 * b), 0.9 * random.unit() * a.min(b)),
        5 => Profile::regular_polygon(3 + random.below(7) as u32, a),
        _ => {
            let count = 5 + random.below(20);
            let corner = |i: usize, r: f64| r * DVec2::from_angle(std::f64::consts::TAU * i as f64 / count as f64);
            let outer: Vec<DVec2> = (0..count).map(|i| corner(i, random.range(0.5, 0.9))).collect();
            let inner: Vec<DVec2> = (0..count).map(|i| corner(i, 0.2)).collect();
            Polygon::new([outer, inner]).into()
        }
    };
    if depth == 0 {
        return plain;
    }
    let other = random_profile(random, depth - 1).translate(DVec2::new(random.range(-0.3, 0.3), 0.1));
    let rule = random.rule();
    match random.below(4) {
        0 => plain.union(&other, rule),
        1 => plain.difference(&other, rule),
        // What is measured takes a while: there is little of it.
        2 if !matches!(kind, 1 | 2) || random.chance(0.1) => plain.offset(random.range(-0.05, 0.1)),
        _ => plain.intersection(&other, rule).rotate(rad(random.range(-3.0, 3.0))),
    }
}

fn caps(random: &mut Random) -> Caps {
    match random.below(4) {
        0 => Caps::Rounded(random.range(0.02, 0.1)),
        1 => Caps::Chamfered(random.range(0.02, 0.1)),
        _ => Caps::Flat,
    }
}

/// A profile made solid.
fn swept(random: &mut Random) -> Solid {
    let depth = random.below(2);
    let profile = random_profile(random, depth);
    match random.below(6) {
        0 => profile.extrude(random.range(0.3, 1.5)),
        // Rounded and chamfered edges of what has its true distance.
        1 => {
            let (a, b) = (random.range(0.4, 1.2), random.range(0.4, 1.2));
            let upright = random.pick(&[0, 1]);
            let plain = if upright == 0 { Profile::circle(a) } else { Profile::rectangle(DVec2::new(a, b)) };
            plain.extrude_with(&Extrusion { caps: caps(random), ..Extrusion::new(random.range(0.4, 1.5)) })
        }
        2 => profile.extrude_with(&Extrusion {
            height: random.range(0.4, 1.5),
            twist: rad(random.pick(&[0.0, 1.0, -0.7])),
            scale: random.pick(&[1.0, 0.6, 1.5]),
            caps: Caps::Flat,
        }),
        3 => profile.translate(DVec2::X * random.range(0.0, 0.8)).revolve(),
        4 => profile.translate(DVec2::X * random.range(0.0, 0.8)).revolve_by(rad(random.range(0.3, 6.2))),
        _ => {
            let helix = Helix::new(random.range(0.5, 0.8), random.range(0.4, 0.9), random.range(0.4, 2.5));
            let helix = Helix { left_handed: random.chance(0.5), ..helix };
            profile.scale(0.4).sweep_helix(&helix)
        }
    }
}

/// A leaf of a kind that came with the catalogue.
pub fn catalogue_leaf(random: &mut Random) -> Solid {
    match random.below(4) {
        0 | 1 => superquadric(random),
        2 => formula(random),
        _ => swept(random),
    }
}

/// Two solids blended.
pub fn blended(random: &mut Random, a: &Solid, b: &Solid) -> Solid {
    let size = random.range(0.03, 0.3);
    let exact = [0; 2].map(|_| crate::primitives::random_primitive(random).0.translate(random.vector(-0.3, 0.3)));
    // What is measured takes a while: there is little of it.
    let blend = match random.below(7) {
        2 | 3 if random.chance(0.1) => return exact[0].union_with(&exact[1], Blend::Fillet { radius: 0.5 * size }),
        4 if random.chance(0.1) => return exact[0].difference_with(&exact[1], Blend::Chamfer { leg: 0.5 * size }),
        0..5 => Blend::Smooth { radius: size },
        5 => Blend::Displacement { height: random.range(-0.2, 0.2), falloff: [size, 0.3] },
        _ => Blend::Ricci { p: random.range(1.5, 8.0) },
    };
    let join = |a: &Solid, b: &Solid, blend| match blend_side(b) {
        0 => a.union_with(b, blend),
        1 => a.intersection_with(b, blend),
        _ => a.difference_with(b, blend),
    };
    let blended = join(a, b, blend);
    // A Ricci blend takes gauges alone.
    if blended.bounds().is_ok() { blended } else { join(a, b, Blend::Smooth { radius: size }) }
}

/// A side by the operand, so that trials of one pair agree.
fn blend_side(b: &Solid) -> usize {
    b.node_count() % 3
}

/// A level, or an offset or shell of a leaf that has its true distance.
pub fn lengthened(random: &mut Random, solid: &Solid) -> Solid {
    let (exact, _) = crate::primitives::random_primitive(random);
    match random.below(3) {
        0 => solid.level(random.range(-0.15, 0.15)),
        1 => exact.offset(random.range(-0.1, 0.15)),
        _ => exact.shell(random.range(0.03, 0.15)),
    }
}

/// A map that came with the catalogue.
pub fn catalogue_map(random: &mut Random, solid: &Solid) -> Solid {
    let wave = SineWave { mean: 1.0, amplitude: 0.3, wavelength: random.range(1.0, 3.0), phase: rad(0.4) };
    match random.below(7) {
        0 => solid.taper_by(wave, 0.8),
        1 => solid.twist_by(rad(1.0), SmoothStep { from: (-0.5, 0.0), to: (0.5, 1.2) }),
        2 => solid.twist_by(rad(1.0), LinearLaw { at_zero: 0.3, slope: random.range(-1.0, 1.0) }),
        3 => solid.elongate(random.vector(0.0, 0.6)),
        4 => solid.mirrored(random.direction(), random.range(-0.3, 0.3)),
        5 => solid.repeat([2, 1 + random.below(3) as u32, 1], random.vector(0.4, 1.5)),
        _ => solid.translate(DVec3::X * 0.9).repeat_polar(2 + random.below(5) as u32),
    }
}
