//! Rays through the whole catalogue, and through what has cusps, blades and steep lobes.

use glam::DVec3;
use rvachev::catalogue::{Entry, Group, Part};
use rvachev::program::{Evaluator, Tape};
use rvachev::{
    Bounds, GeneralisedSuperquadric, Gielis, Profile, Solid, Superpolygon, Supershape, Supertoroid, catalogue, deg,
};

use super::{Tally, ray};
use crate::support::Random;

/// The example of every entry of the catalogue, and shapes with cusps, blades and steep lobes; with
/// each whether its surface is measured, which takes a thousand times as long.
fn exemplary() -> Vec<(Solid, bool)> {
    let g = Gielis::new;
    let clover = g(4.0, 2.0, 2.0, 2.0);
    let a = DVec3::new(1.0, 0.8, 0.6);
    let shapes = [
        Supershape::new(g(6.0, 1.0, 1.7, 1.7), g(6.0, 1.0, 1.7, 1.7)),
        Supershape::new(g(5.0, 0.3, 0.3, 0.3), clover),
        Supershape::new(g(24.0, 0.3, 1.7, 1.7), clover),
        Supershape::new(g(3.0, 0.8, 0.6, 1.4), g(4.0, 2.0, 0.7, 0.7)).scaled([0.7, 1.0, 0.6]),
        Supershape::new(Gielis::rational(5, 2, 3.0, 0.7, 0.7), clover),
    ];
    let mut solids: Vec<Solid> = shapes.into_iter().map(Solid::from).collect();
    solids.push(solids[1].rotate_x(deg(40.0)).translate([0.3, 0.1, -0.2]) - Solid::sphere(0.3));
    solids.push(solids[0].twist(deg(40.0)));
    let exponents = [[2.5, 2.5], [3.0, 0.3], [0.3, 3.0]];
    solids.extend(exponents.map(|[e1, e2]| Solid::superellipsoid(a, e1, e2).rotate_z(deg(20.0))));
    solids.push(GeneralisedSuperquadric::new(a, [0.6, 0.9, 4.0]).into());
    solids.push(Supertoroid::new(0.4 * a, 1.6, 0.7, 2.4).into());
    let star = Superpolygon::new(g(5.0, 0.5, 0.5, 0.5), 1.0);
    solids.push(Profile::from(star).extrude(0.5).rotate_x(deg(30.0)));
    #[cfg(feature = "formula")]
    solids.push(super::steps() & Solid::cuboid([2.0, 1.6, 1.8]));
    let bounded = |part| {
        let solid = match part {
            Part::Solid(solid) => solid,
            Part::Profile(profile) => profile.extrude(0.5),
            _ => return None,
        };
        let is_finite = solid.bounds().is_ok_and(|bounds| bounds.is_finite());
        Some(if is_finite { solid } else { solid & Solid::cuboid([4.0; 3]) })
    };
    let is_measured = |entry: &Entry| matches!(entry.group(), Group::Length | Group::BlendedJoin);
    let examples = catalogue().iter().filter_map(|entry| Some((bounded(entry.example())?, is_measured(entry))));
    solids.into_iter().map(|solid| (solid, false)).chain(examples).collect()
}

fn through_examples(each: usize) {
    let mut tally = Tally::default();
    for (number, (solid, is_measured)) in exemplary().into_iter().enumerate() {
        let mut random = Random::new(91 + number as u64);
        let frame = solid.bounds().unwrap();
        let count = if is_measured { each.min(200) / 4 } else { each };
        let rays: Vec<(DVec3, DVec3)> = (0..count).map(|_| ray(&mut random, &frame)).collect();
        tally.compare(number, &solid, &frame, &rays);
    }
    let Tally { rays, hits, grazing, level, thin, unknown, .. } = tally;
    println!("{rays} rays, {hits} hits, {grazing} grazing, {level} level, {thin} thin, {unknown} not isolated");
    assert!(tally.wrong.is_empty(), "{} wrong:\n{}", tally.wrong.len(), tally.wrong.join("\n"));
}

#[test]
fn rays_through_the_catalogue_are_right() {
    through_examples(8);
}

/// 200 000 of them take minutes.
#[test]
#[ignore = "minutes"]
fn many_rays_through_the_catalogue_are_right() {
    through_examples(3000);
}

/// What a supershape's values may be off in single precision depends on where: near the planes of
/// its cusps only it is much.
#[test]
fn roundoff_of_what_has_cusps_is_that_of_the_region() {
    let star = Supershape::new(Gielis::new(5.0, 0.3, 0.3, 0.3), Gielis::new(4.0, 2.0, 2.0, 2.0));
    roundoff_is_that_of_the_region(&star.into());
    roundoff_is_that_of_the_region(&Solid::superellipsoid([1.0, 0.8, 0.6], 3.0, 0.3));
    roundoff_is_that_of_the_region(&Solid::superellipsoid([0.8, 1.0, 0.7], 2.5, 2.5));
}

fn roundoff_is_that_of_the_region(solid: &Solid) {
    let program = solid.surface_program().unwrap();
    let mut random = Random::new(3);
    let (mut small, mut evaluator) = (0, Evaluator::new());
    for _ in 0..200 {
        let half = random.log_range(1e-3, 0.05);
        let region =
            Bounds::from_center(random.point_in(&Bounds::from_center(DVec3::ZERO, DVec3::ONE)), DVec3::splat(half));
        let tape = Tape::new(&program, &region);
        small += usize::from(tape.roundoff() < 5e-5);
        let points: Vec<DVec3> = (0..64).map(|_| random.point_in(&region) - tape.origin()).collect();
        let axis = |i: usize| -> Vec<f32> { points.iter().map(|p| p[i] as f32).collect() };
        let [x, y, z] = [0, 1, 2].map(axis);
        let mut values = vec![0.0f32; 64];
        evaluator.values(&tape, &x, &y, &z, &mut values).unwrap();
        for (n, value) in values.iter().enumerate() {
            let p = DVec3::new(x[n].into(), y[n].into(), z[n].into()) + tape.origin();
            let off = (f64::from(*value) - program.value(p)).abs();
            assert!(off <= tape.roundoff(), "{off} of {} in {region:?}", tape.roundoff());
        }
    }
    assert!(small > 60, "{small}");
}

/// Such a ray ends in the face of another operand, where the value is 0 but for rounding, and what
/// the program is narrowed to has none there.
#[test]
fn rays_that_leave_soon_after_they_enter_are_seen() {
    let solid = Profile::from(Superpolygon::new(Gielis::new(5.0, 2.0, 2.0, 2.0), 3.0)).extrude(0.5);
    let origin = DVec3::new(2.569237578501319, 6.276151776639061, -3.8403711175175235);
    let direction = DVec3::new(-0.1633647708311492, -0.6723769384083318, 0.721956511396583);
    let mut random = Random::new(17);
    for _ in 0..400 {
        let from = origin + 1e-3 * random.direction();
        let hit = solid.raycast(from, direction).unwrap().unwrap_or_else(|| panic!("no hit from {from}"));
        assert!((hit.distance - 5.6106).abs() < 0.02 && hit.point.truncate().length() > 2.99, "{hit:?} from {from}");
    }
}
