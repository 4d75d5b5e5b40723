//! Lengths of lengths: the same one twice, many one in another, and both kinds of edges by turns.

use std::f64::consts::PI;
use std::thread;

use glam::{DVec2, DVec3};
use rvachev::{Blend, Gielis, Profile, RFunction, Solid, Supershape, deg, rad};

use super::{CORNER, Outcome, TOLERANCE, fillet, l_profile, report, rounded_box};
use crate::support::near;

/// Opening what is opened by the same ball changes nothing, nor does closing.
#[test]
fn the_same_rounding_twice_is_one() -> Outcome {
    let rounded = Solid::cuboid([10.0; 3]).rounded(2.0);
    for solid in [rounded.rounded(2.0), rounded.rounded(1.0)] {
        near(report(&solid, 64)?.volume, rounded_box(DVec3::splat(10.0), 2.0)[0], 1.5);
    }
    let filled = l_profile().filleted(2.0);
    for profile in [filled.filleted(2.0), filled.filleted(1.0)] {
        near(report(&profile.extrude(1.0), 96)?.volume, 64.0 + 4.0 * CORNER, 0.1);
    }
    // A ball with little room to spare.
    let pill = Solid::cylinder(2.0, 10.0).rounded(1.9);
    let (core, r) = ([0.1, 6.2], 1.9f64);
    let rim = PI * PI * core[0] * r * r + 4.0 / 3.0 * PI * r.powi(3);
    near(report(&pill, 64)?.volume, PI * 4.0 * core[1] + 2.0 * PI * core[0] * core[0] * r + rim, 0.6);
    Ok(())
}

/// Fillets of radii that differ nest: each is measured from the one before. The stack does not grow
/// with them, and the last pin has its own fillet.
#[test]
fn chains_of_different_fillets_have_no_limit() {
    let made = || -> Result<(), String> {
        let radius = |n: usize| 0.1 + 1e-4 * n as f64;
        let place = |n: usize| DVec3::new(n as f64 - 2.5, 0.0, 0.2);
        let plate = Solid::cuboid([7.0, 1.5, 0.4]);
        let all = (0..6)
            .fold(plate, |all, n| all.union_with(Solid::cylinder(0.2, 1.0).translate(place(n)), fillet(radius(n))));
        for n in [0, 1, 3, 5] {
            let r = radius(n);
            let ball = place(n) + DVec3::new(0.2 + r, 0.0, r);
            let towards = DVec3::new(-1.0, 0.0, -1.0).normalize();
            for (by, want) in [(1.02, true), (0.98, false)] {
                let got = all.contains(ball + by * r * towards).map_err(|error| error.to_string())?;
                assert_eq!(got, want, "pin {n}");
            }
        }
        let found = report(&all, 64).map_err(|error| error.to_string())?;
        assert_eq!(found.shells, 1, "{found}");
        Ok(())
    };
    let small = thread::Builder::new().stack_size(512 << 10).spawn(made).unwrap();
    small.join().unwrap().unwrap();
}

/// Fillets of unions and differences by turns: a stepped post with holes in each step.
#[test]
fn fillets_by_turns_keep_their_laws() -> Outcome {
    let mut all = Solid::cuboid([20.0, 20.0, 2.0]);
    for n in 0..2 {
        let (radius, top) = (6.0 - 2.0 * f64::from(n), 3.0 + 4.0 * f64::from(n));
        let post = Solid::cylinder(radius, 6.0).translate([0.0, 0.0, top - 3.0]);
        let hole = Solid::cylinder(0.8, 30.0).translate([8.0 - 2.5 * f64::from(n), 0.0, 0.0]);
        all = all.union_with(post, fillet(0.5 + 0.1 * f64::from(n)));
        all = all.difference_with(hole, fillet(0.3));
    }
    let found = report(&all, 64)?;
    assert_eq!(found.shells, 1, "{found}");
    // Rims of holes are round: the corner of the first is cut off, and the wall below is there.
    assert!(!all.contains([8.81, 0.0, 0.99])? && all.contains([8.81, 0.0, 0.0])?);
    Ok(())
}

/// A union of convex operands with fillets is its closing, an intersection its opening.
#[test]
fn filleted_intersections_of_convex_solids_are_the_opening() -> Outcome {
    let column = Solid::cuboid([4.0, 9.0, 9.0]);
    let slab = Solid::cuboid([9.0, 9.0, 2.0]);
    let (r, both) = (0.3, DVec3::new(1.0, 0.0, 1.0).normalize());
    for solid in [
        column.intersection_with(&slab, fillet(r)),
        Solid::intersection_all_with([&column, &slab], fillet(r)),
        column.complement().union_with(slab.complement(), fillet(r)).complement(),
    ] {
        let ball = DVec3::new(2.0 - r, 0.0, 1.0 - r);
        for (by, want) in [(r + 3.0 * TOLERANCE * r, false), (r - 3.0 * TOLERANCE * r, true)] {
            assert_eq!(solid.contains(ball + by * both)?, want, "{solid}");
        }
        assert!(solid.value(ball + r * both)?.abs() < 3.0 * TOLERANCE * r);
    }
    let [column, slab] = [[4.0, 9.0], [9.0, 2.0]].map(Profile::rectangle);
    let profile = Profile::intersection_all_with([&column, &slab], fillet(r));
    near(report(&profile.extrude(1.0), 96)?.volume, 8.0 - 4.0 * r * r * CORNER, 2e-3);
    Ok(())
}

/// The gap between an L and a bar, narrower than the ball, is filled, and both ends of it are round.
#[test]
fn the_gap_of_an_l_and_a_bar_is_filled() -> Outcome {
    let block = |low: [f64; 2], high: [f64; 2]| {
        let (low, high) = (DVec2::from(low), DVec2::from(high));
        Profile::rectangle(high - low).translate(0.5 * (low + high))
    };
    let l = block([0.0, 0.0], [10.0, 4.0]) | block([0.0, 0.0], [4.0, 10.0]);
    let joined = l.union_with(block([3.0, 5.0], [8.0, 7.0]), fillet(2.0));
    let closed = (l | block([3.0, 5.0], [8.0, 7.0])).filleted(2.0);
    let areas = [&joined, &closed].map(|profile| report(&profile.extrude(1.0), 160).map(|found| found.volume));
    let [joined, closed] = areas;
    let (joined, closed) = (joined?, closed?);
    println!("L and bar: {joined} joined, {closed} closed");
    near(closed, 77.7165, 0.05);
    near(joined, closed, 0.05);
    Ok(())
}

/// Where surfaces all but touch, what small cells leave is meshed in smaller ones, as often as it
/// takes.
#[test]
fn where_a_tube_grazes_a_cylinder_little_is_left() -> Outcome {
    let tube = Solid::torus(6.210, 3.709) - Solid::cuboid([9.288, 21.037, 11.937]).translate([-4.0, -7.0, 2.0]);
    let post = Solid::cylinder(6.783, 14.390).translate([-5.0, 3.0, 4.0]);
    let body = (tube | post) - Solid::cuboid([11.087, 12.160, 6.968]).translate([-8.0, 7.0, 5.0]);
    let accuracy = body.filleted(0.624).accuracy()?;
    assert!(accuracy.error < 8.0 * accuracy.tolerance, "{accuracy:?}");
    Ok(())
}

/// What is measured of a chamfer, and so all that is measured from it, goes by its leg, and not by
/// the ball that keeps it off flush faces.
#[test]
fn lengths_of_chamfers_are_as_exact_as_their_legs() -> Outcome {
    let leg = 1.0;
    let stand = Solid::cuboid([20.0, 20.0, 2.0]).union_with(Solid::cylinder(3.0, 12.0), Blend::Chamfer { leg });
    assert!(stand.accuracy()?.tolerance <= 4e-3 * leg, "{:?}", stand.accuracy());
    let rounded = stand.rounded(0.5).accuracy()?;
    assert!(rounded.tolerance < 0.015 * leg, "{rounded:?}");
    Ok(())
}

/// Found by random search: boxes about spots that stay as they are became no smaller, without end,
/// and the stack was used up.
#[test]
fn spots_that_are_not_mended_come_to_an_end() -> Outcome {
    const P: RFunction = RFunction::P(2.0);
    let lobes = |m: f64, [n1, n2]: [f64; 2], scale: [f64; 3]| {
        Solid::from(Supershape::new(Gielis::new(m, n1, n2, n2), Gielis::new(4.0, 8.0, 8.0, 8.0)).scaled(scale))
    };
    let seven =
        lobes(7.0, [8.559157690498978, 10.83350627264008], [6.72809224948287, 6.012572253122926, 8.240531159564853]);
    let four =
        lobes(4.0, [9.995884290430695, 8.242321624886245], [5.8667592611163855, 8.819556159898639, 5.126258322969079]);
    let cushion = Solid::superellipsoid(
        [5.913463925942779, 7.284854713827372, 4.477395340800285],
        0.9337158058770001,
        0.36772188935428857,
    );
    let body = Solid::capsule(2.303228473290801, 11.695477318391204)
        .union(seven.translate([-3.0, 6.0, 0.0]), P)
        .union(cushion.translate([-8.0, 7.0, 3.0]), P);
    let hole = Solid::capsule(2.9835726493038237, 13.632113933190704).rotate_x(deg(358.0));
    let body = body.difference(hole.translate([-3.0, 8.0, -6.0]), P);
    let body = body.union(four.rotate_x(deg(90.0)).translate([1.0, -6.0, -5.0]), P);
    let filled = body.twist(rad(0.0241959220636636)).filleted(1.4611738728825003);
    assert!(filled.accuracy()?.error < 0.2, "{:?}", filled.accuracy());
    Ok(())
}
