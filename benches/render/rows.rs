//! Solids whose pictures were once slow, and one of every kind that the catalogue has.

use fidget::context::Tree;
use glam::{DVec2, DVec3};
use rvachev::catalogue::{Entry, Group, Part, Value};
use rvachev::{
    Blend, Bounds, Extrusion, Gielis, Profile, RFunction, Solid, Superellipsoid, Supershape, catalogue, deg,
};

/// A solid, and how many pixels the side of its picture has.
pub struct Row {
    pub name: String,
    pub size: u32,
    pub solid: Solid,
    /// Whether fidget draws it within minutes.
    pub has_peer: bool,
}

fn row(name: &str, size: u32, solid: impl Into<Solid>) -> Row {
    Row { name: name.to_string(), size, solid: solid.into(), has_peer: true }
}

fn alone(name: &str, size: u32, solid: Solid) -> Row {
    Row { has_peer: false, ..row(name, size, solid) }
}

/// Supershapes and pinched superellipsoids, deformations, blends, long profiles, chains of smooth
/// joins.
pub fn named() -> Vec<Row> {
    let g = Gielis::new;
    let clover = g(4.0, 2.0, 2.0, 2.0);
    let a = DVec3::new(1.0, 0.8, 0.6);
    let mut rows = vec![
        row("s1", 128, Supershape::new(g(6.0, 1.0, 1.7, 1.7), g(6.0, 1.0, 1.7, 1.7))),
        row("s2", 128, Supershape::new(g(5.0, 0.3, 0.3, 0.3), clover)),
        row("s3", 128, Supershape::new(clover, clover)),
        row("s4", 128, Supershape::new(Gielis::polygon(6, 60.0), Gielis::polygon(4, 60.0))),
        row("s5", 128, Supershape::new(g(24.0, 0.3, 1.7, 1.7), clover)),
        row("s6", 128, Superellipsoid::new(a, 2.5, 2.5)),
        row("e (3, .3)", 128, Superellipsoid::new(a, 3.0, 0.3)),
        row("e (.3, .7)", 128, Superellipsoid::new(a, 0.3, 0.7)),
        row("25 superellipsoids", 512, checkerboard()),
        row("z - mod(x, 2)", 256, saw()),
        alone("polygon of 1000", 128, polygon(1000).extrude(0.5)),
        alone("polygon of 50 000", 128, polygon(50_000).extrude(0.5)),
        alone("spheres, union", 256, spheres(1001, 0.55, None)),
        alone("spheres, smooth chain", 256, spheres(1001, 0.55, Some(0.026))),
    ];
    let (plate, spike) = (Solid::cuboid([2.0, 2.0, 0.4]), Superellipsoid::new([0.5, 0.5, 1.0], 0.3, 0.7));
    let joint = |blend| plate.union_with(spike, blend);
    rows.extend([
        row("joint, plain", 128, plate.union(spike, RFunction::MIN_MAX)),
        row("joint, smooth", 128, joint(Blend::Smooth { radius: 0.15 })),
        row("joint, chamfer", 128, joint(Blend::Chamfer { leg: 0.15 })),
        row("joint, fillet", 128, joint(Blend::Fillet { radius: 0.15 })),
    ]);
    let cross = Profile::rectangle([1.8, 0.6]) | Profile::rectangle([0.6, 1.8]);
    let twisted = Extrusion { twist: deg(60.0), ..Extrusion::new(1.0) };
    rows.push(row("cross, twisted", 128, cross.extrude_with(&twisted)));
    let zero = RFunction::Zero { m: 0 };
    let parts = pawn().map(|part| Solid::formula(&part, Bounds::from_center(DVec3::ZERO, PAWN)));
    rows.push(row("pawn, five formulas", 128, Solid::union_all(parts, zero)));
    // Negative inside, the union is the R-conjunction.
    let joined = pawn().into_iter().reduce(|a, b| a.clone() + b.clone() - (a.square() + b.square()).sqrt());
    let whole = joined.map(|all| Solid::formula(&all, Bounds::from_center(DVec3::ZERO, PAWN)));
    rows.extend(whole.map(|pawn| row("pawn, one formula", 128, pawn)));
    rows.push(row("s1, twisted", 128, rows[0].solid.twist(deg(40.0))));
    rows
}

/// The example of every entry of the catalogue: of R-functions and blends a union of two, and of
/// all that makes a solid or a profile. Laws, curves and caps are what others take.
pub fn catalogued() -> Vec<Row> {
    // Ricci's blend takes these alone.
    let [plate, post] = [[1.0, 1.0, 0.3], [0.5, 0.5, 1.0]].map(|axes| Solid::superellipsoid(axes, 0.3, 0.7));
    let bounded = |solid: Solid| {
        let is_finite = solid.bounds().is_ok_and(|bounds| bounds.is_finite());
        if is_finite { solid } else { solid & Solid::cuboid([4.0; 3]) }
    };
    let solid = |entry: &Entry| match (entry.example(), entry.group()) {
        (Part::Solid(solid), _) => Some(bounded(solid)),
        (Part::Profile(profile), _) => Some(profile.extrude(0.5)),
        (Part::Value(Value::Function(function)), _) => Some(plate.union(&post, function)),
        (Part::Value(Value::Blend(blend)), _) => Some(plate.union_with(&post, blend)),
        (_, Group::Curve | Group::Law | Group::Caps) => None,
        (part, _) => panic!("{} has no row: {part:?}", entry.name()),
    };
    catalogue().iter().filter_map(|entry| Some(row(entry.name(), 128, solid(entry)?))).collect()
}

/// Superellipsoids of all exponents side by side.
fn checkerboard() -> Solid {
    let e = [0.3, 0.7, 1.0, 2.0, 3.0];
    let at = |i: usize, j: usize| {
        let place = DVec3::new(i as f64 - 2.0, j as f64 - 2.0, 0.0) * 1.1;
        Solid::superellipsoid([0.5; 3], e[i], e[j]).translate(place)
    };
    Solid::union_all((0..5).flat_map(|i| (0..5).map(move |j| at(i, j))), RFunction::MIN_MAX)
}

const PAWN: DVec3 = DVec3::new(0.7, 0.7, 1.2);

/// A pawn of five parts: each as a formula, negative inside.
fn pawn() -> [Tree; 5] {
    let (x, y, z) = Tree::axes();
    let across = (x.square() + y.square()).sqrt();
    let ball = |at: f32, r: f32| (x.square() + y.square() + (z.clone() - at).square()).sqrt() - r;
    let disc = |at: f32, r: f32, h: f32| (across.clone() - r).max((z.clone() - at).abs() - h);
    let neck = across.clone() - (z.clone() * -0.15 + 0.35);
    [disc(-0.9, 0.6, 0.1), ball(-0.7, 0.5), neck.max(z.abs() - 0.8), disc(0.45, 0.32, 0.05), ball(0.75, 0.3)]
}

/// A formula that jumps.
fn saw() -> Solid {
    let (x, _, z) = Tree::axes();
    let half = DVec3::new(5.0, 3.0, 3.0);
    Solid::formula(&(z - x.modulo(2.0)), Bounds::from_center(DVec3::ZERO, half)) & Solid::cuboid(1.9 * half)
}

/// A gear with a rough edge.
fn polygon(edges: usize) -> Profile {
    let corner = |i: usize| {
        let t = std::f64::consts::TAU * i as f64 / edges as f64;
        (1.0 + 0.15 * (40.0 * t).sin() + 0.02 * (1000.0 * t).sin()) * DVec2::from_angle(t)
    };
    Profile::polygon((0..edges).map(corner))
}

/// Random spheres that fill so much of a cube of 2, united or smoothly chained.
fn spheres(count: usize, fill: f64, smooth: Option<f64>) -> Solid {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let solids: Vec<Solid> = (0..count)
        .map(|_| {
            let radius = fill / (count as f64).cbrt() * (0.6 + 0.8 * next());
            Solid::sphere(radius).translate(DVec3::new(next(), next(), next()) * 2.0 - 1.0)
        })
        .collect();
    match smooth {
        None => Solid::union_all(solids, RFunction::MIN_MAX),
        Some(radius) => {
            let join = |all: Solid, next: &Solid| all.union_with(next, Blend::Smooth { radius });
            solids[1..].iter().fold(solids[0].clone(), join)
        }
    }
}
