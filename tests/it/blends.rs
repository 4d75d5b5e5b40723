//! Blends: joins that read values.

use glam::DVec3;
use rvachev::{
    Blend, Bounds, Caps, CellSize, Extrusion, Features, Helix, MeshSettings, Profile, RFunction, Solid, SolidError,
    deg,
    law::SmoothStep,
    program::{Program, Region},
    rad,
    volume::Lattice,
};

use crate::support::{Random, lanes32, lanes64, near, off_surface};

/// The half-space of the points below a plane through the origin that is tilted about the y
/// axis: inside is where x sin(angle) is more than z cos(angle).
fn below(angle: f64) -> Solid {
    Solid::half_space(DVec3::new(-angle.sin(), 0.0, angle.cos()), 0.0)
}

/// Values as two half-spaces have them: x and y as asked for, at the point (x, y, 0).
fn pair() -> (Solid, Solid) {
    (Solid::half_space(-DVec3::X, 0.0), Solid::half_space(-DVec3::Y, 0.0))
}

#[test]
fn a_smooth_union_is_the_parabola_between() -> Result<(), SolidError> {
    let (a, b) = pair();
    let union = a.smooth_union(&b, 0.4);
    let difference = a.smooth_difference(&b, 0.4);
    let mut random = Random::new(71);
    for _ in 0..200 {
        let (x, y) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        let p = DVec3::new(x, y, random.range(-1.0, 1.0));
        let overlap = (0.4 - (x - y).abs()).max(0.0);
        near(union.value(p)?, x.max(y) + overlap * overlap / 1.6, 1e-15);
        let overlap = (0.4 - (x + y).abs()).max(0.0);
        near(difference.value(p)?, x.min(-y) - overlap * overlap / 1.6, 1e-15);
    }
    Ok(())
}

#[test]
fn displacement_and_ricci_agree_with_the_reference() -> Result<(), SolidError> {
    let (a, b) = pair();
    let blend = Blend::Displacement { height: 0.3, falloff: [0.5, 1.0] };
    let value = a.union_with(&b, blend).value(DVec3::new(0.1, -0.2, 0.0))?;
    near(value, 0.401384575527757, 1e-14);
    // Two spheres about the origin of radius 2 and 3: gauges 1.2 and 0.9 at distances 2.4 and
    // 2.7 — so the second one is moved.
    let (one, two) = (Solid::sphere(2.0), Solid::sphere(3.0).translate(DVec3::X * (2.4 - 2.7)));
    let p = DVec3::X * 2.4;
    let ricci = Blend::Ricci { p: 4.0 };
    // The value is the smaller radius times 1 − G.
    near(1.0 - one.union_with(&two, ricci).value(p)? / 2.0, 0.840223889848, 1e-12);
    near(1.0 - one.intersection_with(&two, ricci).value(p)? / 2.0, 1.285371688486, 1e-12);
    let difference = (1.2f64.powi(4) + 0.9f64.powi(-4)).powf(0.25);
    near(1.0 - one.difference_with(&two, ricci).value(p)? / 2.0, difference, 1e-12);
    // Blends of blends are gauges; boxes are not.
    let three = Solid::superellipsoid(DVec3::ONE, 0.5, 0.5).twist(rad(0.3));
    assert!(one.union_with(&two, ricci).union_with(&three, ricci).contains(p)?);
    let error = one.union_with(Solid::cuboid(DVec3::ONE), ricci).value(p);
    let Err(SolidError::NoGauge { path, operand: 1 }) = error else { panic!("{error:?}") };
    assert_eq!(path, "Ricci union");
    Ok(())
}

/// The point of the surface on the way from `outside` to `inside`.
fn crossing(solid: &Solid, outside: DVec3, inside: DVec3) -> Result<DVec3, SolidError> {
    assert!(solid.contains(inside)? && !solid.contains(outside)?, "{outside} {inside}");
    let (mut a, mut b) = (outside, inside);
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if solid.contains(middle)? { b = middle } else { a = middle }
    }
    Ok(0.5 * (a + b))
}

#[test]
fn fillets_of_planes_have_their_radius_at_any_angle() -> Result<(), SolidError> {
    let radius = 0.3;
    for degrees in [35.0, 60.0, 90.0, 120.0, 160.0] {
        // Material below the plane z = 0 and behind one that rises at the origin; between them
        // an empty wedge of this angle about the bisector.
        let angle = f64::to_radians(degrees);
        let floor = Solid::half_space(DVec3::Z, 0.0);
        let wall = Solid::half_space(DVec3::new(angle.sin(), 0.0, -angle.cos()), 0.0);
        let part = floor.union_with(&wall, Blend::Fillet { radius });
        // The empty wedge is where x cos t, z sin t has 0 < t < angle.
        let bisector = DVec3::new((0.5 * angle).cos(), 0.0, (0.5 * angle).sin());
        let centre = bisector * (radius / (0.5 * angle).sin());
        near(part.value(centre)?, -radius, 1e-3 * radius);
        let half = 0.5 * (std::f64::consts::PI - angle);
        for i in -9..=9 {
            let turn = 0.5 * angle + half * f64::from(i) / 9.2;
            let out = -DVec3::new(turn.cos(), 0.0, turn.sin());
            let found = crossing(&part, centre, centre + 1.2 * radius / (0.5 * angle).sin() * out)?;
            near(found.distance(centre), radius, 1e-3 * radius);
            let gradient = part.gradient(found)?;
            assert!((gradient - out).length() < 5e-3, "{degrees} {i} {gradient} {out}");
        }
        // Beyond the tangent lines nothing is changed.
        let far = DVec3::new(3.0 * radius / (0.5 * angle).tan(), 0.4, 0.05);
        assert_eq!(part.value(far)?, floor.union(&wall, RFunction::MIN_MAX).value(far)?);
    }
    Ok(())
}

#[test]
fn fillets_between_curved_operands_have_their_radius() -> Result<(), SolidError> {
    // A ball that stands 0.3 deep in a floor: the fillet's centre runs on a circle.
    let radius = 0.25;
    let ball = Solid::sphere(1.0).translate(DVec3::Z * 0.7);
    let floor = Solid::half_space(DVec3::Z, 0.0);
    let part = floor.union_with(&ball, Blend::Fillet { radius });
    let reach = ((1.0 + radius) * (1.0 + radius) - (radius - 0.7) * (radius - 0.7)).sqrt();
    let centre = DVec3::new(reach, 0.0, radius);
    for i in 1..20 {
        // From the floor's tangent point to the ball's.
        let (from, to) = (-DVec3::Z, (DVec3::Z * 0.7 - centre).normalize());
        let out = from.lerp(to, f64::from(i) / 20.0).normalize();
        let found = crossing(&part, centre, centre + 1.4 * radius * out)?;
        assert!((found.distance(centre) / radius - 1.0).abs() < 0.01, "{i} {}", found.distance(centre));
    }
    // Two pipes that cross: the largest empty ball that touches both, anywhere along the
    // edge, has the radius.
    let pipe = Solid::cylinder(1.0, 20.0);
    let cross = pipe.union_with(pipe.rotate_x(deg(90.0)), Blend::Fillet { radius });
    let plain = pipe.union(pipe.rotate_x(deg(90.0)), RFunction::MIN_MAX);
    let mut random = Random::new(72);
    let mut added = 0;
    for _ in 0..20_000 {
        let p = random.point_in(&Bounds::new(DVec3::new(0.0, 0.6, 0.6), DVec3::new(1.0, 1.6, 1.6)));
        if !cross.contains(p)? || plain.contains(p)? {
            continue;
        }
        added += 1;
        // No ball of 0.95 of the radius that keeps clear of both pipes reaches a point that
        // the fillet has filled: its centre q has both distances at least 0.95 r. The centre
        // line of such balls is known: both pipes' axes are at a distance of 1 + r.
        let clear = |x: f64| ((1.0 + radius) * (1.0 + radius) - x * x).sqrt();
        let nearest = (-100..=100).map(|i| {
            let x = p.x + 0.005 * f64::from(i);
            DVec3::new(x, clear(x), clear(x)).distance(p)
        });
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.95 * radius, "{p} {nearest}");
    }
    assert!(added > 50, "{added}");
    Ok(())
}

#[test]
fn chamfers_have_their_leg_at_any_angle() -> Result<(), SolidError> {
    let leg = 0.4;
    for degrees in [60.0, 90.0, 120.0, 150.0] {
        let angle = f64::to_radians(degrees);
        let floor = Solid::half_space(DVec3::Z, 0.0);
        let wall = Solid::half_space(DVec3::new(angle.sin(), 0.0, -angle.cos()), 0.0);
        let part = floor.union_with(&wall, Blend::Chamfer { leg });
        // The face meets both planes at the leg from the edge.
        let (on_floor, on_wall) = (DVec3::X * leg, DVec3::new(angle.cos(), 0.0, angle.sin()) * leg);
        near(on_floor.distance(on_wall), 2.0 * leg * (0.5 * angle).sin(), 1e-12);
        for i in 0..=10 {
            let on = on_floor.lerp(on_wall, f64::from(i) / 10.0);
            near(part.value(on)?, 0.0, 1e-9);
        }
    }
    // An inner edge: a box less a slot, its rim broken.
    let block = Solid::cuboid(DVec3::new(4.0, 4.0, 2.0));
    let part = block.difference_with(Solid::cylinder(1.0, 3.0), Blend::Chamfer { leg: 0.2 });
    for share in [0.0, 0.25, 0.5, 1.0] {
        let face = DVec3::new(1.0 + 0.2 * share, 0.0, 0.8 + 0.2 * share);
        assert!(part.value(face)?.abs() < 1e-9, "{}", part.value(face)?);
    }
    Ok(())
}

#[test]
fn a_chamfer_takes_its_leg_off_both_faces() -> Result<(), SolidError> {
    // The edge of a box at a right angle, by each of the ways to chamfer it.
    let leg = 0.3;
    let chamfer = Blend::Chamfer { leg };
    let (column, slab) = (Solid::cuboid([4.0, 9.0, 9.0]), Solid::cuboid([9.0, 9.0, 2.0]));
    let caps = Extrusion { caps: Caps::Chamfered(leg), ..Extrusion::new(2.0) };
    for bar in [
        column.intersection_with(&slab, chamfer),
        column.difference_with(!&slab, chamfer),
        !(!&column).union_with(!&slab, chamfer),
        Profile::rectangle([4.0, 9.0]).extrude_with(&caps),
        Profile::rectangle([4.0, 9.0])
            .intersection_with(Profile::rectangle([9.0, 2.0]), chamfer)
            .extrude(9.0)
            .rotate_x(deg(90.0)),
    ] {
        // Where the face begins and ends, and its middle.
        for (x, z) in [(2.0 - leg, 1.0), (2.0, 1.0 - leg), (2.0 - 0.5 * leg, 1.0 - 0.5 * leg)] {
            near(bar.value([x, 0.0, z])?, 0.0, 1e-9);
        }
        // Nothing is taken off beyond.
        assert!(bar.value([2.0 - 1.01 * leg, 0.0, 0.9999])? > 0.0 && bar.value([1.9999, 0.0, 1.0 - 1.01 * leg])? > 0.0);
        assert!(bar.value([2.0 - 0.99 * leg, 0.0, 0.9999])? < 0.0 && bar.value([1.9999, 0.0, 1.0 - 0.99 * leg])? < 0.0);
    }
    Ok(())
}

/// The rim of a face on the surface of `on`, in the plane across the edge through `q`.
fn rim(part: &Solid, on: &Solid, q: DVec3, edge: DVec3, away: DVec3, leg: f64) -> Result<DVec3, SolidError> {
    let on_surface = |s: f64| -> Result<DVec3, SolidError> {
        let mut p = q + s * away;
        for _ in 0..20 {
            let across = on.gradient(p)?.reject_from(edge);
            p -= on.value(p)? * across / across.length_squared();
        }
        Ok(p)
    };
    let (mut covered, mut free) = (0.0, 4.0 * leg);
    for _ in 0..50 {
        let middle = 0.5 * (covered + free);
        if part.value(on_surface(middle)?)?.abs() > 1e-9 { covered = middle } else { free = middle }
    }
    on_surface(free)
}

#[test]
fn chamfers_of_round_solids_have_their_legs() -> Result<(), SolidError> {
    let ball = Solid::sphere(1.0);
    let shifted = ball.translate(DVec3::X);
    let floor = Solid::half_space(DVec3::Z, 0.3);
    let pipe = Solid::cylinder(1.0, 9.0).rotate_y(deg(90.0));
    let thin = Solid::cylinder(0.6, 9.0);
    let side = DVec3::new(0.6 * 0.6, 0.6 * 0.8, (1.0 - 0.48f64 * 0.48).sqrt());
    let pairs = [
        (&ball, &shifted, DVec3::new(0.5, 0.75f64.sqrt(), 0.0), 1.0),
        (&ball, &floor, DVec3::new(0.91f64.sqrt(), 0.0, 0.3), 1.0),
        (&pipe, &thin, DVec3::new(0.0, 0.6, 0.8), 0.6),
        (&pipe, &thin, DVec3::new(0.6, 0.0, 1.0), f64::INFINITY),
        (&pipe, &thin, side, 0.6),
    ];
    // The last is the radius that the angle between the operands changes with: none at a right
    // angle.
    for (a, b, q, radius) in pairs {
        for (leg, union) in [(0.05, true), (0.15, true), (0.05, false), (0.15, false)] {
            let blend = Blend::Chamfer { leg };
            let part = if union { a.union_with(b, blend) } else { a.difference_with(b, blend) };
            let [n, o] = [if union { 1.0 } else { -1.0 } * a.gradient(q)?.normalize(), b.gradient(q)?.normalize()];
            let edge = n.cross(o).normalize();
            // Along either surface, away from the other operand or from its complement.
            let rims = [
                rim(&part, a, q, edge, -o.reject_from(n).normalize(), leg)?,
                rim(&part, b, q, edge, -n.reject_from(o).normalize(), leg)?,
            ];
            for rim in rims {
                near(rim.distance(q) / leg, 1.0, 0.26 * leg / radius + 1e-4);
            }
        }
    }
    Ok(())
}

/// Solids with every blend, of every kind of operand.
fn blended() -> Vec<(&'static str, Solid)> {
    let ball = Solid::sphere(0.8).translate(DVec3::new(0.5, 0.1, 0.3));
    let plate = Solid::cuboid(DVec3::new(2.0, 1.6, 0.5));
    let rod = Solid::cylinder(0.3, 2.4).rotate_y(rad(0.5));
    let star = Solid::superellipsoid(DVec3::new(0.9, 0.7, 0.6), 0.4, 1.4).twist(rad(0.6));
    let both = &plate | &rod;
    vec![
        ("smooth union", ball.smooth_union(&plate, 0.3)),
        ("smooth difference", both.smooth_difference(&ball, 0.2)),
        ("smooth of a twisted one", star.smooth_union(&ball, 0.25)),
        ("fillet", plate.union_with(&rod, Blend::Fillet { radius: 0.2 })),
        ("fillet of a union", both.union_with(&ball, Blend::Fillet { radius: 0.1 })),
        ("fillet of a hole", plate.difference_with(&rod, Blend::Fillet { radius: 0.1 })),
        ("fillet moved", plate.intersection_with(&ball, Blend::Fillet { radius: 0.1 }).scale(1.3).rotate_x(rad(0.4))),
        ("fillet of a fillet", {
            let inner = plate.union_with(&rod, Blend::Fillet { radius: 0.15 });
            inner.union_with(&ball, Blend::Fillet { radius: 0.1 })
        }),
        ("chamfer", plate.union_with(&rod, Blend::Chamfer { leg: 0.15 })),
        ("displacement", plate.union_with(&ball, Blend::Displacement { height: 0.1, falloff: [0.2, 0.3] })),
        (
            "displaced difference",
            plate.difference_with(&rod, Blend::Displacement { height: -0.05, falloff: [0.2, 0.2] }),
        ),
        ("Ricci", star.union_with(&ball, Blend::Ricci { p: 3.0 })),
        ("level", both.level(0.1)),
        ("level below a union", &both.level(-0.05) | &ball),
        ("smooth in a difference", &plate - &ball.smooth_union(&rod, 0.2)),
        ("complement of a blend", &plate & &!ball.smooth_union(&rod, 0.2)),
    ]
}

/// A program's value at a point, by narrowing to boxes about it.
fn narrowed(program: &Program, p: DVec3) -> Option<f64> {
    let mut program = program.clone();
    for half in [0.5, 0.1, 0.02] {
        match program.narrow(&Bounds::new(p - half, p + half)) {
            Region::Inside => return Some(1.0),
            Region::Outside => return Some(-1.0),
            Region::Surface(inner) => program = inner,
        }
    }
    Some(program.value(p))
}

#[test]
fn blends_have_one_value_in_all_forms() -> Result<(), SolidError> {
    for (name, solid) in blended() {
        let bounds = solid.bounds()?;
        assert!(bounds.is_finite() && !bounds.is_empty(), "{name} {bounds:?}");
        let around = bounds.inflate(0.3);
        let mut random = Random::new(73);
        let points: Vec<DVec3> = (0..150).map(|_| random.point_in(&around)).collect();
        let (surface, field) = (solid.surface_program()?, solid.field_program()?);
        let (points, single) = lanes32(&field, &around, &points);
        let double = lanes64(&field, &around, &points);
        for (i, &p) in points.iter().enumerate() {
            let value = field.value(p);
            near(single[i], value, 1e-4);
            near(double[i], value, 1e-9);
            assert!(bounds.contains(p) || value <= 0.0, "{name}: inside at {p}, beyond {bounds:?}");
            if value.abs() > 1e-9 {
                assert_eq!(surface.value(p) > 0.0, value > 0.0, "{name} {p}");
                if let Some(value_near) = narrowed(&surface, p) {
                    assert_eq!(value_near > 0.0, value > 0.0, "{name} narrowed at {p}: {value_near} {value}");
                }
                if let Some(value_near) = narrowed(&field, p) {
                    assert_eq!(value_near > 0.0, value > 0.0, "{name} field narrowed at {p}");
                }
            }
        }
        // Ranges hold.
        for _ in 0..60 {
            let (a, b) = (random.point_in(&around), random.log_range(1e-3, 0.5));
            let region = Bounds::new(a - b * random.vector(0.0, 1.0), a + b * random.vector(0.0, 1.0));
            let (range, of_surface) = (solid.range(&region)?, surface.range(&region));
            for _ in 0..12 {
                let p = random.point_in(&region);
                let value = field.value(p);
                assert!(range.lo() <= value && value <= range.hi(), "{name} {range:?} {value} at {p} of {region:?}");
                let value = surface.value(p);
                assert!(of_surface.lo() <= value && value <= of_surface.hi(), "{name} {of_surface:?} {value}");
            }
        }
    }
    Ok(())
}

#[test]
fn gradients_of_blends_are_differences() -> Result<(), SolidError> {
    for (name, solid) in blended() {
        let bounds = solid.bounds()?;
        let field = solid.field_program()?;
        let mut random = Random::new(74);
        let (mut off, mut count) = (0, 0);
        for _ in 0..120 {
            let p = random.point_in(&bounds);
            let (_, gradient) = field.gradient(p);
            let h = 1e-6;
            let slope = |d: DVec3| (field.value(p + h * d) - field.value(p - h * d)) / (2.0 * h);
            let difference = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            count += 1;
            off += usize::from((gradient - difference).length() > 0.02 * (1.0 + gradient.length()));
        }
        // At creases the two may differ.
        assert!(off * 50 <= count, "{name}: {off} of {count}");
    }
    Ok(())
}

#[test]
fn beside_a_blend_the_solid_prunes() -> Result<(), SolidError> {
    // A long bar of a hundred balls, two of them blended: far from those, one leaf is left.
    let ball = |i: i32| Solid::sphere(0.6).translate(DVec3::X * f64::from(i));
    for blend in [Blend::Smooth { radius: 0.2 }, Blend::Fillet { radius: 0.1 }, Blend::Chamfer { leg: 0.1 }] {
        let pair = ball(0).union_with(ball(1), blend);
        let bar = Solid::union_all((2..100).map(ball).chain([pair]), RFunction::MIN_MAX);
        let program = bar.surface_program()?;
        let small = |p: DVec3| Bounds::new(p - 0.05, p + 0.05);
        let leaves = |p: DVec3| match program.narrow(&small(p)) {
            Region::Surface(narrowed) => narrowed.leaf_count(),
            _ => 0,
        };
        assert_eq!(leaves(DVec3::new(50.0, 0.6, 0.0)), 1, "{blend:?}");
        assert_eq!(leaves(DVec3::new(0.0, 0.6, 0.0)), 1, "{blend:?}");
        assert!(leaves(DVec3::new(0.5, 0.34, 0.0)) >= 1, "{blend:?}");
    }
    Ok(())
}

#[test]
fn offsets_move_the_surface_by_a_length() -> Result<(), SolidError> {
    let brick = Solid::cuboid(DVec3::new(2.0, 1.0, 1.0));
    let hole = Solid::cylinder(0.2, 3.0);
    let part = (&brick - &hole).offset(0.05);
    // The outside grows, the hole shrinks.
    near(part.value(DVec3::new(1.05, 0.0, 0.0))?, 0.0, 1e-6);
    near(part.value(DVec3::new(0.15, 0.0, 0.0))?, 0.0, 5e-5);
    // Lengths through similarities, twice, and through complements.
    let turned = (!brick.scale(2.0).rotate_z(rad(0.3)).offset(-0.1)).offset(0.3);
    near((!turned).value(DVec3::Z * (1.0 - 0.4))?, 0.0, 1e-6);
    let scaled = brick.offset(0.1).scale(2.0).offset(0.1);
    near(scaled.value(DVec3::new(2.3, 0.0, 0.0))?, 0.0, 1e-12);
    let stretched = Solid::sphere(1.0).offset(0.1).scale_axes(DVec3::new(1.0, 1.0, 2.0));
    near(stretched.value(DVec3::Z * 2.2)?, 0.0, 1e-9);
    // A shell, and what is in exactly one of two.
    let shell = brick.shell(0.1);
    let bounds = shell.bounds()?;
    near(bounds.max.x, 1.0, 1e-9);
    near(shell.value(DVec3::new(0.95, 0.0, 0.0))?, 0.05, 1e-12);
    near(shell.value(DVec3::new(0.85, 0.0, 0.0))?, -0.05, 1e-12);
    let either = (&brick ^ &hole).offset(-0.05);
    near(either.value(DVec3::new(0.25, 0.0, 0.0))?, 0.0, 5e-5);
    near(either.value(DVec3::new(0.0, 0.15, 1.0))?, 0.0, 5e-5);
    // Rules other than min and max do not change lengths.
    let rule = RFunction::Zero { m: 2 };
    let far = brick.union(brick.translate(DVec3::X * 3.0), rule).offset(0.2);
    near(far.value(DVec3::Z * 1.0)?, -0.3, 1e-12);
    let error = brick.shell(-0.1).value(DVec3::ZERO);
    let Err(SolidError::Parameter { path, source }) = error else { panic!("{error:?}") };
    assert_eq!((path.as_str(), source.parameter.as_str()), ("shell", "thickness"));
    Ok(())
}

#[test]
fn bounds_that_no_part_tells_are_found() -> Result<(), SolidError> {
    let mut sides = Vec::new();
    for axis in DVec3::AXES {
        sides.push(Solid::half_space(axis, 1.0));
        sides.push(Solid::half_space(-axis, 2.0));
    }
    let brick = Solid::intersection_all(sides, RFunction::MIN_MAX);
    let bounds = brick.bounds()?;
    assert!(bounds.min.cmple(DVec3::splat(-2.0)).all() && bounds.max.cmpge(DVec3::ONE).all());
    assert!(bounds.size().max_element() < 3.2, "{bounds:?}");
    assert!(!below(0.3).bounds()?.is_finite());
    Ok(())
}

#[test]
fn boxes_hold_levels_of_flat_joins() -> Result<(), SolidError> {
    // Rules of order m are flat near 0: a small value below it is far outside.
    let rule = RFunction::Zero { m: 2 };
    let (ball, block) = (Solid::sphere(1.0), Solid::cuboid(DVec3::splat(1.5)));
    let mut random = Random::new(78);
    for solid in [
        ball.intersection(&block, rule).level(0.1),
        ball.difference(&block, rule).level(0.1),
        ball.intersection(&block, rule).smooth_union(Solid::sphere(0.2), 0.4),
        ball.difference(&block, rule).smooth_union(ball.translate(DVec3::X).difference(&block, rule), 0.4),
    ] {
        let bounds = solid.bounds()?;
        for _ in 0..2000 {
            let p = random.vector(-2.5, 2.5);
            let inside = solid.value(p)? > 0.0;
            assert!(!inside || bounds.contains(p), "{solid:?} is {} at {p}, not in {bounds:?}", solid.value(p)?);
        }
    }
    Ok(())
}

#[test]
fn ricci_takes_the_gauges_that_it_names() {
    let ricci = Blend::Ricci { p: 3.0 };
    let ball = Solid::sphere(1.0);
    let circle = rvachev::Gielis::circle();
    for gauge in [
        Solid::superellipsoid(DVec3::ONE, 0.5, 2.4),
        rvachev::GeneralisedSuperquadric::new(DVec3::ONE, [2.0, 5.0, 0.8]).into(),
        rvachev::Supershape::new(rvachev::Gielis::polygon(5, 20.0), circle).into(),
        ball.union_with(ball.translate(DVec3::X), ricci),
    ] {
        assert!(ball.union_with(gauge, ricci).contains(DVec3::ZERO).is_ok());
    }
}

#[test]
fn boxes_of_blends_above_maps_and_of_turned_columns_end() -> Result<(), SolidError> {
    let law = SmoothStep { from: (0.0, 1.0), to: (36.0, 0.66) };
    let lens = Solid::superellipsoid([27.0, 11.0, 90.0], 1.0, 1.0).taper_by(1.0, law);
    let head = Profile::circle(10.0).column().rotate_x(deg(90.0)).intersection(&lens, RFunction::MIN_MAX);
    assert!(head.smooth_union(Solid::sphere(3.0), 2.5).bounds()?.size().max_element() < 200.0);
    let disc = Profile::circle(1.0).extrude(0.5).rotate_x(deg(90.0));
    let size = disc.bounds()?.size();
    assert!(size.x < 2.2 && size.y < 0.7 && size.z < 2.2, "{size}");
    Ok(())
}

/// Infinite growths once met the zeros of a rotation's matrix.
#[test]
fn a_level_of_what_has_no_end_is_found_anywhere() -> Result<(), SolidError> {
    let lattices = crate::lattices::lattices().into_iter().map(|(_, lattice, _)| lattice.level(0.04));
    for solid in lattices.map(|lattice| lattice.translate(DVec3::X).repeat_polar(24)) {
        let program = solid.surface_program()?;
        let mut random = Random::new(79);
        for _ in 0..100 {
            let p = random.vector(-3.0, 3.0);
            let value = program.value(p);
            match program.narrow(&Bounds::new(p - 1e-3, p + 1e-3)) {
                Region::Inside => assert!(value > 0.0),
                Region::Outside => assert!(value <= 0.0, "{value} at {p}"),
                Region::Surface(narrowed) => assert_eq!(narrowed.value(p) > 0.0, value > 0.0),
            }
        }
    }
    Ok(())
}

/// Along a thread's edges the ball has nowhere to touch; what is told of one place is not true of
/// another.
#[test]
fn regions_of_a_filleted_thread_hold_its_values() {
    let thread = Profile::circle(0.08).sweep_helix(&Helix::new(0.3, 0.25, 2.5));
    let solid = thread.union_with(Solid::cylinder(0.25, 1.4), Blend::Fillet { radius: 0.05 });
    let program = solid.surface_program().unwrap();
    // A region that was taken to be outside.
    let lattice = Lattice::new(&solid.finite_bounds().unwrap(), CellSize::LongestSide(64)).unwrap();
    let region = Bounds::new(lattice.node(32, 24, 48), lattice.node(40, 32, 56));
    let range = program.range(&region);
    for n in 0..729 {
        let p = lattice.node(32 + n % 9, 24 + n / 9 % 9, 48 + n / 81);
        let value = program.value(p);
        assert!(range.lo() <= value && value <= range.hi(), "{value} at {p}: {range:?}");
    }
    assert!(range.hi() > 0.0);
}

/// Solids filleted to others that have edges of their own, which run into the fillet: convex and
/// concave, of joins and of leaves; with the radius.
fn filleted_edges() -> Vec<(Solid, f64)> {
    let fillet = Blend::Fillet { radius: 0.1 };
    let floor = Solid::cuboid(DVec3::new(2.0, 2.0, 0.2));
    let block = |x: f64, y: f64| Solid::cuboid(DVec3::new(x, y, 1.0)).translate(0.4 * DVec3::Z);
    let post = block(0.4, 0.4) & block(0.4, 0.4).rotate_z(rad(0.6));
    let star = block(0.8, 0.3) | block(0.8, 0.3).rotate_z(rad(1.2));
    let cube = Solid::cuboid(DVec3::ONE);
    let bite = Solid::sphere(0.5).translate(DVec3::new(0.5, 0.3, 0.5));
    let opened = Profile::circle(0.2).revolve_by(rad(5.0)).translate(0.1 * DVec3::X);
    vec![
        (post.union_with(&floor, fillet), 0.1),
        (floor.union_with(star, fillet), 0.1),
        (cube.difference_with(&bite, fillet), 0.1),
        (cube.intersection_with(bite, fillet), 0.1),
        (
            Solid::cylinder(0.5, 1.0).difference_with(Solid::sphere(0.3).translate(DVec3::new(0.5, 0.0, 0.4)), fillet),
            0.1,
        ),
        (floor.union_with(opened, Blend::Fillet { radius: 0.05 }), 0.05),
    ]
}

/// The distance from a ball's centre to what it may be at changes by no more than the way.
#[test]
fn fillets_of_edges_do_not_jump() {
    for (nth, (solid, radius)) in filleted_edges().into_iter().enumerate() {
        let program = solid.surface_program().unwrap();
        let bounds = solid.finite_bounds().unwrap();
        let mut random = Random::new(83);
        let mut count = 0;
        while count < 4000 {
            let p = random.point_in(&bounds);
            let value = program.value(p);
            if value.abs() > 0.3 * radius {
                continue;
            }
            count += 1;
            let q = p + 0.02 * radius * random.direction();
            let slope = (program.value(q) - value).abs() / p.distance(q);
            // Where it fades away from a joint, it is half as steep again.
            assert!(slope < 1.52, "solid {nth}: {slope} at {p}");
        }
    }
}

/// What is told of a region by its middle is true of all of it; and of regions without a surface
/// few are open.
#[test]
fn regions_of_fillets_of_edges_hold_their_values() {
    for (nth, (solid, radius)) in filleted_edges().into_iter().enumerate() {
        let program = solid.surface_program().unwrap();
        let bounds = solid.finite_bounds().unwrap();
        let mut random = Random::new(89);
        let (mut open, mut crossed) = (0, 0);
        for _ in 0..2000 {
            let (p, half) = (random.point_in(&bounds), radius * random.log_range(0.01, 4.0));
            let region = Bounds::from_center(p, DVec3::splat(half));
            let (range, narrowed) = (program.range(&region), program.narrow(&region));
            let values = [(); 24].map(|()| program.value(random.point_in(&region)));
            for value in values {
                // Well inside, the operands' join takes over from the blend.
                let by_join = value.abs() >= radius;
                assert!(range.contains(value) || by_join, "solid {nth}: {value} near {p}, {half}: {range:?}");
                match &narrowed {
                    Region::Inside => assert!(value > 0.0, "solid {nth}: {value} near {p}, {half}"),
                    Region::Outside => assert!(value < 0.0, "solid {nth}: {value} near {p}, {half}"),
                    Region::Surface(_) => {}
                }
            }
            open += usize::from(matches!(narrowed, Region::Surface(_)));
            crossed += usize::from(values.iter().any(|value| *value > 0.0) && values.iter().any(|value| *value < 0.0));
        }
        assert!(10 * open < 14 * crossed, "solid {nth}: {open} regions are open, {crossed} crossed");
    }
}

/// Each asks those below it.
#[test]
fn rays_meet_chains_of_fillets() -> Result<(), SolidError> {
    let chain = (1..30).fold(Solid::sphere(0.6), |all, i| {
        all.union_with(Solid::sphere(0.6).translate(DVec3::X * f64::from(i)), Blend::Fillet { radius: 0.1 })
    });
    let hit = chain.raycast(DVec3::new(20.0, 0.0, 9.0), -DVec3::Z)?.unwrap();
    near(hit.distance, 8.4, 1e-9);
    Ok(())
}

/// A smooth union of what are no distances has another surface than that of their distances, which
/// a fillet rolls along. The same one counts near the fillet and away from it.
#[test]
fn fillets_of_smooth_unions_are_of_one_surface() -> Result<(), SolidError> {
    const CELL: f64 = 0.05;
    let wedge = Solid::cuboid((0.5, 0.7, 0.9)).taper(0.36, 0.8, 1.0).translate((0.1, 0.3, -0.1));
    let smooth = wedge.smooth_union(Solid::cylinder(0.33, 0.7), 0.1);
    let knob = Solid::ellipsoid((0.13, 0.18, 0.37)).offset(0.035).translate((0.35, -0.25, 0.0));
    let solid = smooth.union_with(&knob, Blend::Fillet { radius: 0.05 });
    let program = solid.surface_program()?;
    let settings = MeshSettings { cell: CellSize::Length(CELL), features: Features::Smooth, ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let off = off_surface(&program, &mesh, CELL);
    let clamped = mesh.clamped_vertices().unwrap();
    assert!(off <= clamped, "{off} of {} vertices, {clamped} clamped", mesh.positions().len());
    Ok(())
}

/// What is far below a chamfer's face is no higher than the boxes of the joint tell.
#[test]
fn chamfers_that_end_with_a_flush_side_have_sound_ranges() {
    let plate = Solid::cuboid([2.0, 2.0, 1.0]).translate([0.0, 0.0, -0.5]);
    let wall = Solid::cuboid([0.4, 2.0, 1.0]).translate([0.0, 0.0, 0.5]);
    let joint = plate.union_with(wall, Blend::Chamfer { leg: 0.5 });
    let mut random = Random::new(4021);
    for solid in [joint.clone(), joint.level(0.1)] {
        let program = solid.field_program().unwrap();
        for _ in 0..400 {
            let p = DVec3::new(random.range(0.15, 0.8), random.range(0.7, 1.6), random.range(-0.1, 0.7));
            let cell = Bounds::from_center(p, DVec3::splat(random.log_range(1e-4, 0.1)));
            let (value, range) = (program.value(p), program.range(&cell));
            assert!(range.contains(value), "{value} at {p} is not in {range:?}");
            let told = match program.narrow(&cell) {
                Region::Inside => value > 0.0,
                Region::Outside => value <= 0.0,
                Region::Surface(part) => (part.value(p) > 0.0) == (value > 0.0),
            };
            assert!(told, "{value} at {p}");
        }
    }
}

/// The face of a chamfer is flat: its normals are those of a plane, and none is 0.
#[test]
fn faces_of_chamfers_have_normals() {
    let plate = Solid::cuboid([4.0, 4.0, 1.0]).translate([0.0, 0.0, -0.5]);
    let wall = Solid::cuboid([0.4, 4.0, 1.0]).translate([0.0, 0.0, 0.5]);
    let normal = DVec3::new(1.0, 0.0, 1.0).normalize();
    for leg in [0.05, 0.15, 0.3] {
        let joint = plate.union_with(&wall, Blend::Chamfer { leg });
        for n in 1..20 {
            let along = f64::from(n) / 20.0;
            let p = DVec3::new(0.2 + leg * (1.0 - along), 0.37 * along - 0.2, leg * along);
            let gradient = joint.gradient(p).unwrap();
            assert!(gradient.normalize_or_zero().dot(-normal) > 0.999, "{leg}: {gradient} at {p}");
        }
    }
}
