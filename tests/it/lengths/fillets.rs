//! Laws of filleted unions, in the plane and in space: what a rolling ball adds, and no more.

use std::f64::consts::PI;
use std::fmt::Display;

use glam::{DVec2, DVec3};
use rvachev::program::Region;
use rvachev::{Blend, Bounds, Plane, PlaneBounds, Profile, Solid, rad};

use super::subject::bounded;
use super::{Outcome, TOLERANCE, at, fillet, layer, measures, report, sag};
use crate::primitives::random_primitive;
use crate::support::Random;

/// A convex shape of the plane.
fn convex_profile(random: &mut Random) -> Profile {
    let [a, b] = [0; 2].map(|_| random.range(0.3, 0.9));
    let plain = match random.below(4) {
        0 => Profile::circle(a),
        1 => Profile::rectangle([2.0 * a, 2.0 * b]),
        2 => Profile::regular_polygon(3 + random.below(6) as u32, a),
        _ => Profile::superellipse([a, b], random.range(0.3, 1.5)),
    };
    plain.rotate(rad(random.range(-3.0, 3.0))).translate([random.range(-0.6, 0.6), random.range(-0.6, 0.6)])
}

fn points_in_plane(random: &mut Random, within: &PlaneBounds, count: usize) -> Vec<DVec2> {
    let size = within.max - within.min;
    (0..count).map(|_| within.min + DVec2::new(random.unit(), random.unit()) * size).collect()
}

/// Fails unless a filleted union holds its operands and is held by the closing of their union.
fn is_between(a: &Profile, b: &Profile, radius: f64, random: &mut Random) -> Outcome {
    let (plain, filleted) = (a | b, a.union_with(b, fillet(radius)));
    let closed = plain.filleted(radius);
    let points = points_in_plane(random, &plain.bounds()?, 400);
    let (plain, filleted, closing) =
        (plain.contains_all(&points)?, filleted.contains_all(&points)?, closed.values(&points)?);
    are_between(&points, [&plain, &filleted], &closing, radius, &format!("{a:?}, {b:?}"));
    Ok(())
}

/// Fails unless what is filleted holds what is plain, and is held by the closing.
fn are_between<P: Display>(points: &[P], [plain, filleted]: [&[bool]; 2], closing: &[f64], radius: f64, told: &str) {
    for (i, p) in points.iter().enumerate() {
        assert!(filleted[i] || !plain[i], "{told}, {radius}: {p} is lost");
        // Values beside the level are distances.
        let held = closing[i] > -3.0 * TOLERANCE * radius;
        assert!(held || !filleted[i], "{told}, {radius}: {p} is added beyond the closing");
    }
}

#[test]
fn filleted_unions_of_profiles_are_between_the_union_and_its_closing() -> Outcome {
    let mut random = Random::new(1210);
    for _ in 0..2 {
        let [depth, other] = [0; 2].map(|_| random.below(2));
        let a = crate::zoo::random_profile(&mut random, depth);
        let b = crate::zoo::random_profile(&mut random, other).translate([random.range(-0.8, 0.8), 0.3]);
        let radius = random.log_range(0.03, 0.4);
        is_between(&a, &b, radius, &mut random)?;
    }
    Ok(())
}

#[test]
fn filleted_unions_of_convex_profiles_are_the_closing() -> Outcome {
    let mut random = Random::new(1211);
    for _ in 0..16 {
        let (a, b) = (convex_profile(&mut random), convex_profile(&mut random));
        let radius = random.log_range(0.03, 0.4);
        let (filleted, closed) = (a.union_with(&b, fillet(radius)), (&a | &b).filleted(radius));
        let points = points_in_plane(&mut random, &closed.bounds()?, 400);
        let (got, want) = (filleted.values(&points)?, closed.values(&points)?);
        let clear = 3.0 * TOLERANCE * radius;
        for ((p, got), want) in points.iter().zip(got).zip(want) {
            let same = (got > 0.0) == (want > 0.0);
            assert!(same || got.abs().min(want.abs()) < clear, "{a:?}, {b:?}, {radius} at {p}: {got}, not {want}");
        }
    }
    Ok(())
}

#[test]
fn filleted_unions_of_convex_solids_are_the_closing() -> Outcome {
    let mut random = Random::new(1212);
    for _ in 0..6 {
        let [a, b] = [0; 2].map(|_| {
            loop {
                // A torus is not convex, a slab does not end.
                let solid = random_primitive(&mut random).0.translate(random.vector(-0.4, 0.4));
                let is_torus = format!("{solid:?}").contains("torus");
                if !is_torus && solid.bounds().is_ok_and(|bounds| bounds.is_finite()) {
                    break solid;
                }
            }
        });
        let radius = random.log_range(0.05, 0.3);
        let (filleted, closed) = (a.union_with(&b, fillet(radius)), (&a | &b).filleted(radius));
        let bounds = closed.bounds()?;
        let points: Vec<DVec3> = (0..400).map(|_| random.point_in(&bounds)).collect();
        let (got, want) = (filleted.values(&points)?, closed.values(&points)?);
        let clear = 3.0 * TOLERANCE * radius;
        for ((p, got), want) in points.iter().zip(got).zip(want) {
            let same = (got > 0.0) == (want > 0.0);
            assert!(same || got.abs().min(want.abs()) < clear, "{a:?}, {b:?}, {radius} at {p}: {got}, not {want}");
        }
        // No more shells and no more voids than without: of two convex solids, one or two.
        let most = report(&(&a | &b), 48)?.shells;
        let found = report(&filleted, 48)?;
        assert!(found.shells <= most, "{a:?}, {b:?}, {radius}: {found}");
    }
    Ok(())
}

#[test]
fn filleted_unions_of_solids_hold_their_operands() -> Outcome {
    let mut random = Random::new(1213);
    let [a, b] = [0; 2].map(|_| bounded(&mut random, 1));
    let size = a.bounds()?.size().min_element().max(0.1);
    let radius = size * random.log_range(0.02, 0.2);
    let plain = &a | &b;
    let (filleted, closed) = (a.union_with(&b, fillet(radius)), plain.filleted(radius));
    let bounds = plain.bounds()?;
    let points: Vec<DVec3> = (0..300).map(|_| random.point_in(&bounds)).collect();
    let (plain, filleted, closing) =
        (plain.contains_all(&points)?, filleted.contains_all(&points)?, closed.values(&points)?);
    are_between(&points, [&plain, &filleted], &closing, radius, &format!("{a:?}, {b:?}"));
    Ok(())
}

/// Differences and intersections are unions of complements.
#[test]
fn fillets_of_differences_are_those_of_complements() -> Outcome {
    let mut random = Random::new(1214);
    let block = Solid::cuboid([4.0, 3.0, 2.0]);
    let ball = at(Solid::sphere(1.2), [1.0, 0.5, 0.9]);
    let blend = fillet(0.4);
    let pairs = [
        (block.difference_with(&ball, blend), !(!&block).union_with(&ball, blend)),
        (block.intersection_with(&ball, blend), !(!&block).union_with(!&ball, blend)),
    ];
    for (got, want) in pairs {
        for _ in 0..200 {
            let p = random.vector(-2.2, 2.2);
            assert_eq!(got.contains(p)?, want.contains(p)?, "{p}");
            assert!(block.contains(p)? || !got.contains(p)?, "{p} is added");
        }
    }
    Ok(())
}

#[test]
fn nothing_is_added_where_operands_end_flush() -> Outcome {
    let block = |size: [f64; 3], place: [f64; 3]| at(Solid::cuboid(size), place);
    let pairs = [
        // Side by side, one within the other, one higher than the other by nothing but rounding.
        (block([10.0; 3], [-5.0, 0.0, 0.0]), block([10.0; 3], [5.0, 0.0, 0.0])),
        (block([10.0; 3], [0.0; 3]), block([4.0, 4.0, 10.0], [1.0, 0.0, 0.0])),
        (block([10.0; 3], [-4.0, 0.0, 0.0]), block([10.0, 10.0, 10.0 + 1e-13], [4.0, 0.0, 0.0])),
        (Solid::cylinder(5.0, 8.0), Solid::cylinder(3.0, 8.0)),
        (Solid::cylinder(5.0, 8.0), at(Solid::cylinder(5.0, 8.0), [0.0, 0.0, 6.0])),
        (Solid::cylinder(5.0, 8.0).rotate_x(rad(0.3)), Solid::cylinder(4.0, 8.0).rotate_x(rad(0.3))),
    ];
    let mut random = Random::new(1215);
    for (a, b) in pairs {
        let (plain, filleted) = (&a | &b, a.union_with(&b, fillet(2.0)));
        let many = Solid::union_all_with([&a, &b], fillet(2.0));
        let bounds = plain.bounds()?;
        for _ in 0..60 {
            // Just below and above the surface.
            let Some(q) = plain.closest_surface_point(random.point_in(&bounds.inflate(1.0)))? else { continue };
            let out = -plain.gradient(q)?.normalize();
            for by in [1e-6, 1e-2, 0.5] {
                let p = q + by * out;
                if !plain.contains(p)? {
                    assert!(!filleted.contains(p)? && !many.contains(p)?, "{a:?}, {b:?}: {p}, {by} above");
                }
            }
        }
    }
    Ok(())
}

/// An L whose inner edge is 12 from where the other block stands.
#[test]
fn concave_edges_of_an_operand_stay_away_from_the_joint() -> Outcome {
    let l =
        at(Solid::cuboid([30.0, 10.0, 4.0]), [15.0, 0.0, 2.0]) | at(Solid::cuboid([4.0, 10.0, 20.0]), [2.0, 0.0, 10.0]);
    let post = at(Solid::cylinder(3.0, 12.0), [19.0, 0.0, 8.0]);
    let part = l.union_with(&post, fillet(2.0));
    // In the corner of the L, next to its inner edge.
    for p in [[4.001, 0.0, 4.001], [4.1, 3.0, 4.3], [4.5, -4.0, 4.5]] {
        assert!(!part.contains(p)?, "{p:?}");
    }
    // At the foot of the post there is the fillet.
    let (ball, towards) = (DVec3::new(14.0, 0.0, 6.0), DVec3::new(1.0, 0.0, -1.0).normalize());
    assert!(part.contains(ball + 2.01 * towards)? && !part.contains(ball + 1.99 * towards)?);
    Ok(())
}

/// An L and a bar over its inner edge, with a gap narrower than the ball.
fn l_and_bar() -> [Profile; 3] {
    let block = |low: [f64; 2], high: [f64; 2]| {
        let (low, high) = (DVec2::from(low), DVec2::from(high));
        Profile::rectangle(high - low).translate(0.5 * (low + high))
    };
    [
        block([0.0, 0.0], [10.0, 4.0]) | block([0.0, 0.0], [4.0, 10.0]),
        block([3.0, 5.0], [8.0, 7.0]),
        block([4.0, 4.0], [8.0, 5.0]),
    ]
}

#[test]
fn a_gap_narrower_than_the_ball_is_no_sealed_void() -> Outcome {
    let [l, bar, gap] = l_and_bar();
    let blend = fillet(2.0);
    let joined = l.union_with(&bar, blend);
    let contours = joined.extrude(1.0).slice(&Plane::xy(0.0))?.contours(1e-3)?;
    assert_eq!(contours.len(), 1, "a void in the plane");
    is_between(&l, &bar, 2.0, &mut Random::new(1216))?;
    // In space: as columns cut to a slab, and with the bar shorter than the L.
    let column = l.column().union_with(bar.column(), blend) & Solid::slab([0.0, 0.0, 1.0], 3.0);
    let found = report(&column, 60)?;
    assert_eq!((found.shells, found.genus), (1, Some(0)), "{found}");
    let shorter = l.extrude(20.0).union_with(bar.extrude(8.0), blend);
    let found = report(&shorter, 60)?;
    assert_eq!(found.shells, 1, "{found}");
    // Wherever a point of the gap is left out, it is open to the outside along the gap.
    let mut random = Random::new(1217);
    let within = gap.bounds()?;
    for p in points_in_plane(&mut random, &within, 200) {
        if !joined.contains(p)? {
            let steps = (0..60).map(|i| p + DVec2::X * f64::from(i) * (12.0 - p.x) / 60.0);
            let blocked = joined.contains_all(&steps.collect::<Vec<_>>())?.into_iter().any(|inside| inside);
            assert!(!blocked, "{p} is sealed in");
        }
    }
    Ok(())
}

#[test]
fn many_operands_are_filleted_at_once() -> Outcome {
    // Three bars that meet at right angles: no order of theirs is another solid.
    let bar = Solid::cuboid([12.0, 3.0, 3.0]);
    let bars = [bar.clone(), bar.rotate_z(rad(PI / 2.0)), bar.rotate_y(rad(PI / 2.0))];
    let all = Solid::union_all_with(&bars, fillet(1.0));
    let back = Solid::union_all_with(bars.iter().rev(), fillet(1.0));
    let closed = Solid::union_all(&bars, rvachev::RFunction::MIN_MAX).filleted(1.0);
    let mut random = Random::new(1218);
    for _ in 0..400 {
        let p = random.vector(-3.5, 3.5);
        let [one, other, want] = [&all, &back, &closed].map(|solid| crate::support::value(solid, p));
        let clear = 3.0 * TOLERANCE;
        assert!((one > 0.0) == (other > 0.0) || one.abs().min(other.abs()) < clear, "{p}: {one} and {other}");
        assert!((one > 0.0) == (want > 0.0) || one.abs().min(want.abs()) < clear, "{p}: {one}, not {want}");
    }
    assert_eq!(report(&all, 60)?.shells, 1);
    Ok(())
}

/// A plate with rows of pins through it, 7/10 apart, and their radii and places.
fn pins(rows: [u32; 2]) -> (Solid, Vec<(DVec3, f64)>) {
    let pitch = 0.7;
    let size = DVec2::new(f64::from(rows[0]), f64::from(rows[1])) * pitch;
    let plate = Solid::cuboid([size.x, size.y, 0.4]);
    let places = (0..rows[0]).flat_map(|i| (0..rows[1]).map(move |j| (i, j))).map(|(i, j)| {
        let middle = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) * pitch - 0.5 * size;
        (middle.extend(0.0), 0.1 + 0.05 * f64::from((7 * i + 3 * j) % 10) / 9.0)
    });
    (plate, places.collect())
}

fn pin((place, radius): (DVec3, f64)) -> Solid {
    Solid::cylinder(radius, 1.0).translate(place)
}

/// Fails unless each pin has its fillet, by the ball on all four sides of it, above and below.
fn have_fillets(solid: &Solid, pins: &[(DVec3, f64)], radius: f64) -> Outcome {
    for &(place, of_pin) in pins {
        for (side, up) in [(DVec3::X, 1.0), (DVec3::Y, -1.0), (-DVec3::X, 1.0), (-DVec3::Y, 1.0)] {
            let ball = place + (of_pin + radius) * side + up * (0.2 + radius) * DVec3::Z;
            let towards = (-side - up * DVec3::Z).normalize();
            let [inside, outside] =
                [1.0 + 5.0 * TOLERANCE, 1.0 - 5.0 * TOLERANCE].map(|by| ball + by * radius * towards);
            assert!(solid.contains(inside)? && !solid.contains(outside)?, "the pin at {place}");
        }
    }
    Ok(())
}

/// The volume of a fillet of radius `r` around a pin of radius `a`: its area times the way of its
/// centroid.
fn ring(a: f64, r: f64) -> f64 {
    let from_corner = (10.0 - 3.0 * PI) / (3.0 * (4.0 - PI));
    2.0 * PI * (a + from_corner * r) * super::CORNER * r * r
}

/// Fails unless pins on a plate, filleted all at once or one after the other, are what they are by
/// formulas.
fn pins_are_filleted(rows: [u32; 2], at_once: bool) -> Outcome {
    const RADIUS: f64 = 0.05;
    const CELL: f64 = 0.02;
    let (plate, places) = pins(rows);
    let size = plate.bounds()?.size();
    let all = places.iter().copied().map(pin);
    let solid = if at_once {
        Solid::union_all_with(std::iter::once(plate).chain(all), fillet(RADIUS))
    } else {
        all.fold(plate, |joined, pin| joined.union_with(pin, fillet(RADIUS)))
    };
    let bare: f64 = places.iter().map(|(_, a)| PI * a * a * 0.6).sum();
    let filled: f64 = places.iter().map(|&(_, a)| 2.0 * ring(a, RADIUS)).sum();
    let of_all = places.len() as f64;
    let tolerance = layer(1.4 * size.x * size.y, RADIUS) + of_all * (sag(0.5, 0.125, CELL) + sag(0.14, RADIUS, CELL));
    assert!(tolerance < 0.5 * filled, "a mesh that tells whether fillets are there");
    have_fillets(&solid, &places, RADIUS)?;
    let cells = (size.x / CELL).round() as u32;
    measures(&report(&solid, cells)?, size.element_product() + bare + filled, tolerance, 1);
    Ok(())
}

#[test]
fn thirty_pins_have_their_fillets() -> Outcome {
    pins_are_filleted([6, 5], true)?;
    pins_are_filleted([3, 2], false)
}

/// Each is a length of lengths: their errors add up, and no more than that.
#[test]
fn fillets_of_many_radii_keep_their_accuracy() -> Outcome {
    let (plate, places) = pins([2, 2]);
    let radius = |number: usize| 0.04 + 0.002 * number as f64;
    let mut solid = plate;
    for (number, place) in places.iter().enumerate() {
        solid = solid.union_with(pin(*place), fillet(radius(number)));
    }
    let told = solid.accuracy()?;
    assert!(told.tolerance < places.len() as f64 * 4.0 * TOLERANCE * radius(0), "{told:?}");
    for (number, place) in places.iter().enumerate() {
        have_fillets(&solid, &[*place], radius(number))?;
    }
    Ok(())
}

#[test]
#[ignore = "takes minutes on one core"]
fn a_thousand_pins_have_their_fillets() -> Outcome {
    let (plate, places) = pins([40, 25]);
    let all = std::iter::once(plate).chain(places.iter().copied().map(pin));
    let solid = Solid::union_all_with(all, fillet(0.05));
    have_fillets(&solid, &places, 0.05)?;
    let found = report(&solid, 512)?;
    assert_eq!((found.shells, found.genus), (1, Some(0)), "{found}");
    Ok(())
}

#[test]
fn chamfers_stay_below_flush_faces_and_within_their_legs() -> Outcome {
    let leg = 2.0;
    let blend = Blend::Chamfer { leg };
    let mut random = Random::new(1219);
    for [a, b] in [super::flush_blocks(), super::flush_round()] {
        let (solid, plain) = (a.union_with(&b, blend), &a | &b);
        let bounds = solid.bounds()?;
        assert!(bounds.max.z <= plain.bounds()?.max.z + 1e-9, "{bounds:?}");
        let around = bounds.inflate(1.0);
        for _ in 0..400 {
            let p = random.point_in(&around);
            assert!(solid.contains(p)? || !plain.contains(p)?, "{p} is lost");
        }
    }
    // Of the two blocks, the face goes from (8, 10) to (10, 12).
    let [a, b] = super::flush_blocks();
    let solid = a.union_with(b, blend);
    for p in [[9.0, 11.0, 0.0], [8.3, 10.3, 2.4], [9.7, 11.7, -2.4]] {
        let (p, out) = (DVec3::from(p), DVec3::new(-0.05, 0.05, 0.0));
        assert!(solid.contains(p - out)? && !solid.contains(p + out)?, "{p}");
    }
    Ok(())
}

/// Values of convex leaves change by no more than 1 per length unit: where one is farther off 0 than
/// the leg, there is no face.
#[test]
fn chamfers_are_left_out_beyond_their_legs() -> Outcome {
    let (plate, pin) = (Solid::cuboid([2.0, 2.0, 0.4]), Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7));
    let solid = plate.union_with(pin, Blend::Chamfer { leg: 0.15 });
    assert!(solid.contains([0.53, 0.0, 0.23])? && !solid.contains([0.53, 0.0, 0.33])?);
    assert!(solid.contains([0.63, 0.0, 0.205])? && !solid.contains([0.66, 0.0, 0.205])?);
    let beside = Bounds::new(DVec3::new(0.75, -0.1, 0.1), DVec3::new(0.95, 0.1, 0.3));
    let Region::Surface(narrowed) = solid.surface_program()?.narrow(&beside) else {
        return Err("the face of the plate is there".into());
    };
    assert_eq!(narrowed.leaf_count(), 1);
    Ok(())
}

/// The faces of two sides of an operand meet in a mitre beyond its edge. By one distance for both
/// the face turned about the edge, and stood on it as a fin that could not be measured.
#[test]
fn chamfers_meet_in_mitres_at_edges_of_their_operands() -> Outcome {
    let chamfer = Blend::Chamfer { leg: 0.12 };
    let rib = Solid::cuboid([1.8, 0.4, 1.4]).rotate_z(rad(0.3)).translate([0.0, 0.0, 0.7]);
    let post = Solid::cylinder(0.3, 3.0).translate([0.2, 0.1, 0.3]);
    let solids = [
        Solid::sphere(1.0).union_with(&rib, chamfer),
        Solid::pyramid(4, 1.5, 2.0).difference_with(&post, chamfer),
        Solid::wedge([2.0, 1.5, 1.6]).difference_with(&post, chamfer),
        Solid::prism(5, 1.0, 1.5).union_with(rib.rotate_x(rad(0.4)), chamfer),
    ];
    for (number, solid) in solids.into_iter().enumerate() {
        let told = solid.offset(0.06).accuracy()?;
        assert!(told.error < 6.0 * told.tolerance, "{number}: {told:?}");
    }
    Ok(())
}

/// Sides of a plate that are far from a post have no faces. Beside a chamfered post another one is
/// put: each face of a face would take as long again.
#[test]
fn chamfers_of_chamfered_operands_are_quick() -> Outcome {
    let chamfer = |leg: f64| Blend::Chamfer { leg };
    let post = Solid::cuboid([8.0, 6.0, 8.0]).translate([0.0, 0.0, 4.0]);
    let first = Solid::cuboid([60.0, 60.0, 3.0]).union_with(post, chamfer(1.5));
    let both = first.union_with(Solid::cylinder(2.0, 10.0).translate([7.0, 6.0, 4.0]), chamfer(1.0));
    let [few, more] = [first.surface_program()?.leaf_count(), both.surface_program()?.leaf_count()];
    assert!(few < 8 && more < 20, "{few}, {more}");
    assert!(both.contains([9.3, 6.0, 1.95])? && !both.contains([9.5, 6.0, 2.2])?);
    Ok(())
}

/// The face beside a low boss is as high as its leg, or as the boss, though the boss's upper face
/// and the plate's are parallel, and nothing is filled between such.
#[test]
fn chamfers_beside_low_bosses_have_their_leg() -> Outcome {
    let plate = Solid::cuboid([20.0, 20.0, 2.0]);
    for boss in [
        Solid::cuboid([8.0, 8.0, 3.5]),
        Solid::cylinder(4.0, 3.5),
        Solid::prism(6, 8.0 / 3f64.sqrt(), 3.5).rotate_z(rad(PI / 6.0)),
    ] {
        let solid = plate.union_with(boss.translate([0.0, 0.0, 0.75]), Blend::Chamfer { leg: 1.0 });
        assert!(solid.contains([4.05, 0.0, 1.9])? && !solid.contains([4.15, 0.0, 1.95])?, "{solid}");
    }
    Ok(())
}

/// The parts of an operand have faces that meet in a mitre: where the nearest part changes, the
/// surface has no step.
#[test]
fn chamfers_of_joined_operands_have_no_steps() -> Outcome {
    const STEPS: u32 = 100;
    let chamfer = Blend::Chamfer { leg: 0.7 };
    let egg = Solid::ellipsoid([4.6, 4.5, 4.3]).rotate_x(rad(0.5 * PI)).translate([-4.0, 6.0, -2.0]);
    let (post, bar) = (Solid::cylinder(4.1, 9.0), Solid::cylinder(3.6, 13.6).rotate_x(rad(0.5 * PI)));
    let (both, bar) = (&post | &egg, bar.translate([-5.0, -3.0, 1.0]));
    let solids = [
        both.union_with(&bar, chamfer),
        bar.union_with(&both, chamfer),
        Solid::cuboid([30.0, 30.0, 4.0]).difference_with(&both, chamfer),
        (&post - egg.translate([2.0, 0.0, 0.0])).intersection_with(bar.translate([3.0, 2.0, -3.0]), chamfer),
    ];
    let mut random = Random::new(7);
    for (number, solid) in solids.iter().enumerate() {
        let mut found = 0;
        for _ in 0..400 {
            let from = DVec3::new(-3.0, 3.0, 1.0) + random.vector(-3.0, 3.0);
            let way = random.vector(-1.0, 1.0) / f64::from(STEPS);
            let values: Result<Vec<f64>, _> = (0..STEPS).map(|n| solid.value(from + f64::from(n) * way)).collect();
            let values = values?;
            for pair in values.windows(2).filter(|pair| pair[0].signum() != pair[1].signum()) {
                let (rise, step) = ((pair[1] - pair[0]).abs(), way.length());
                assert!(rise < 3.0 * step + 1e-2, "{number}: {} after {} in {step} from {from}", pair[1], pair[0]);
                found += 1;
            }
        }
        assert!(found > 20, "{number}: {found}");
    }
    Ok(())
}

/// Found by random search: a smooth union of what is filled was told to have no end where it is
/// twisted.
#[test]
fn what_is_joined_to_fillets_and_twisted_has_bounds() -> Outcome {
    let (post, bar) = (Solid::cylinder(4.0, 6.0), Solid::cuboid([3.0, 3.0, 12.0]));
    let block = Solid::cuboid([8.0, 12.0, 5.0]).translate([1.0, -6.0, 2.0]);
    let mut random = Random::new(3);
    for blend in [Blend::Fillet { radius: 0.4 }, Blend::Chamfer { leg: 0.4 }] {
        let blended =
            [post.union_with(&bar, blend), post.difference_with(&bar, blend), post.intersection_with(&bar, blend)];
        for (number, body) in blended.into_iter().enumerate() {
            let moved = body.scale(1.5).rotate_x(rad(0.4)).translate([2.0, 0.0, 0.0]);
            let twisted = moved.smooth_union(&block, 1.9).twist(rad(0.03));
            let bounds = twisted.bounds()?;
            assert!(bounds.is_finite(), "{blend:?} {number}: {bounds:?}");
            let mut inside = 0;
            for _ in 0..4000 {
                let p = bounds.center() + bounds.size() * random.vector(-1.0, 1.0);
                let is_inside = twisted.contains(p)?;
                assert!(!is_inside || bounds.contains(p), "{blend:?} {number}: {p}");
                inside += usize::from(is_inside);
            }
            assert!(inside > 50, "{blend:?} {number}: {inside}");
        }
    }
    Ok(())
}
