//! Boxes of solids: nothing is outside of them, and they are little larger than what they hold.

use glam::DVec3;
use rvachev::{Blend, Bounds, RFunction, Solid, SolidError};

use crate::support::{Random, random_leaf};

/// Spheres within ±1, and their box.
fn spheres(random: &mut Random, count: usize, radius: f64) -> (Vec<Solid>, Bounds) {
    let mut all = Bounds::EMPTY;
    let mut ball = || {
        let radius = radius * random.range(0.6, 1.4);
        let at = random.vector(-1.0, 1.0);
        all = all.union(&Bounds::from_center(at, DVec3::splat(radius)));
        Solid::sphere(radius).translate(at)
    };
    ((0..count).map(|_| ball()).collect(), all)
}

fn smooth(a: Solid, b: &Solid, radius: f64) -> Solid {
    a.smooth_union(b, radius)
}

/// Joins as one joins the ends of a cup: the first half with the second.
fn tree(solids: &[Solid], radius: f64) -> Solid {
    match solids {
        [one] => one.clone(),
        _ => {
            let (a, b) = solids.split_at(solids.len() / 2);
            tree(a, radius).smooth_union(tree(b, radius), radius)
        }
    }
}

/// How far `bounds` go beyond `inner`, on the side where it is most.
fn beyond(bounds: &Bounds, inner: &Bounds) -> f64 {
    (inner.min - bounds.min).max(bounds.max - inner.max).max_element()
}

/// Fails if the solid is anywhere inside outside of its box: near it, and near `around`.
#[track_caller]
fn nothing_outside(solid: &Solid, around: &Bounds, random: &mut Random) {
    let bounds = solid.bounds().expect("the solid is valid");
    let program = solid.field_program().expect("the solid is valid");
    let size = around.size().max_element();
    for _ in 0..2000 {
        let by = random.range(0.0, 0.3) * size;
        let p = random.point_in(&around.inflate(by));
        assert!(bounds.contains(p) || program.value(p) <= 0.0, "{p} is outside of {bounds:?}\n{solid}");
    }
}

#[test]
fn a_chain_of_smooth_unions_goes_no_farther_than_its_radius() -> Result<(), SolidError> {
    let mut random = Random::new(5);
    let (solids, all) = spheres(&mut random, 1001, 0.03);
    let radius = 0.026;
    let chain = solids.iter().skip(1).fold(solids[0].clone(), |a, b| smooth(a, b, radius));
    // Two that have risen rise by a quarter more: as often as a tree is deep.
    for (solid, most) in [(chain, radius), (tree(&solids, radius), 0.25 * radius * 10.0)] {
        let bounds = solid.bounds()?;
        assert!(beyond(&bounds, &all) <= most, "{bounds:?}, {all:?}");
        assert!(beyond(&all, &bounds) <= 0.0);
    }
    Ok(())
}

#[test]
fn equal_operands_rise_as_far_as_the_law_says() -> Result<(), SolidError> {
    // The n-th rises by S(r, 0): the box of n equal balls is that of the ball which they make.
    let ball = Solid::sphere(1.0);
    let (mut chain, mut rise) = (ball.clone(), 0.0f64);
    for _ in 0..40 {
        chain = chain.smooth_union(&ball, 0.4);
        rise += 0.25 * (0.4 - rise).max(0.0).powi(2) / 0.4;
        let found = chain.bounds()?.max.x - 1.0;
        assert!((found - rise).abs() < 1e-12, "{found}, right {rise}");
        assert!(chain.value([1.0 + rise - 1e-9, 0.0, 0.0])? > 0.0);
    }
    Ok(())
}

#[test]
fn a_bridge_rises_by_a_quarter_of_its_radius() -> Result<(), SolidError> {
    let a = Solid::sphere(1.0);
    // A bridge between two does not rise above them.
    let pair = a.smooth_union(a.translate([2.2, 0.0, 0.0]), 0.5);
    let bounds = pair.bounds()?;
    assert!(beyond(&bounds, &Bounds::new([-1.0; 3], [3.2, 1.0, 1.0])) < 0.126, "{bounds:?}");
    Ok(())
}

#[test]
fn joins_between_smooth_ones_do_not_add_up() -> Result<(), SolidError> {
    // Unions by R-functions, cuts and intersections between smooth unions, which read true values.
    let mut random = Random::new(6);
    for rule in [RFunction::MIN_MAX, RFunction::P(2.0), RFunction::Alpha(0.0), RFunction::Associative(2.0)] {
        let (solids, all) = spheres(&mut random, 60, 0.25);
        let radius = 0.1;
        let mut chain = solids[0].clone();
        for (i, ball) in solids.iter().enumerate().skip(1) {
            chain = match i % 4 {
                0 => chain.union(ball, rule),
                1 => chain.smooth_difference(ball.scale(0.1), radius),
                2 => chain.intersection(Solid::cuboid([2.6; 3]), rule),
                _ => chain.smooth_union(ball, radius),
            };
        }
        // A union of values makes them flatter, so that more of them is within reach.
        let most = if rule == RFunction::MIN_MAX { radius } else { 6.0 * radius };
        let bounds = chain.bounds()?;
        assert!(beyond(&bounds, &all) < most, "{rule:?}: {bounds:?}, {all:?}");
        nothing_outside(&chain, &all, &mut random);
    }
    Ok(())
}

/// Leaves of all kinds, joined by blends and R-functions of all kinds, nested.
fn blended(random: &mut Random, depth: usize) -> Solid {
    if depth == 0 {
        return random_leaf(random).translate(random.vector(-0.8, 0.8));
    }
    let below = random.below(depth);
    let (a, b) = (blended(random, depth - 1), blended(random, below));
    let radius = random.log_range(0.02, 1.0);
    match random.below(12) {
        0 => a.smooth_intersection(&b, radius),
        1 => a.smooth_difference(&b, radius),
        2 => a.union(&b, random.rule()),
        3 => a.difference(&b, random.rule()),
        4 => a.intersection(&b, random.rule()),
        5 => a.union_with(&b, Blend::Displacement { height: random.range(-0.2, 0.3), falloff: [radius, 0.3] }),
        6 => a.level(random.range(-0.1, 0.1)).smooth_union(&b, radius),
        7 => a.affine(random.affine()).smooth_union(&b, radius),
        8 => (!(!a).smooth_intersection(!b, radius)).smooth_union(Solid::sphere(0.3), radius),
        _ => a.smooth_union(&b, radius),
    }
}

fn random_blends(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let mut random = Random::new(seed);
        let depth = 1 + random.below(4);
        let solid = blended(&mut random, depth);
        let around = Bounds::from_center(DVec3::ZERO, DVec3::splat(2.5));
        nothing_outside(&solid, &around, &mut random);
    }
}

#[test]
fn nothing_of_random_blends_is_outside() {
    random_blends(0..400);
}

#[test]
#[ignore = "takes minutes"]
fn nothing_of_many_random_blends_is_outside() {
    random_blends(400..20_000);
}

#[test]
fn smooth_joins_of_fillets_and_chamfers() -> Result<(), SolidError> {
    let plate = Solid::cuboid([6.0, 4.0, 0.5]);
    let post = Solid::cylinder(0.5, 3.0);
    let ball = Solid::sphere(0.6).translate([2.5, 0.0, 0.3]);
    for blend in [Blend::Fillet { radius: 0.3 }, Blend::Chamfer { leg: 0.3 }] {
        let part = plate.union_with(&post, blend).smooth_union(&ball, 0.2);
        let all = (&plate | &post | &ball).bounds()?;
        // A fillet's values are not known away from it: no more than the radius.
        let bounds = part.bounds()?;
        assert!(beyond(&bounds, &all) < 0.21, "{blend:?}: {bounds:?}");
        nothing_outside(&part, &all, &mut Random::new(7));
    }
    Ok(())
}
