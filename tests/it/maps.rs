//! Laws, mirrors, repetition and elongation against maps and copies written out.

use std::f64::consts::TAU;

use glam::{DAffine3, DQuat, DVec3};
use rvachev::{
    Bounds, CellSize, Interval, MeshSettings, ParamError, RFunction, Solid, SolidError, Superellipsoid,
    field::{Dual, Field, Norm, Real},
    law::{Law, LawTable, LinearLaw, SineWave, SmoothStep},
    program::{Evaluator, Gradients, Program, Region, Tape},
    rad,
};

use crate::narrow::check_narrowing;
use crate::support::{Random, frame_of, lanes32, lanes64, near, near_point, random_solid, rounded, value};

const WAVE: SineWave = SineWave { mean: 1.1, amplitude: 0.4, wavelength: 2.5, phase: rad(0.7) };
const STEP: SmoothStep = SmoothStep { from: (-0.6, 0.5), to: (0.9, 1.5) };

fn table() -> LawTable {
    LawTable::new([(-1.0, 0.6), (-0.2, 1.4), (0.5, 1.0), (1.1, 0.3)])
}

fn block() -> Solid {
    Solid::superellipsoid(DVec3::new(0.5, 0.7, 1.0), 0.4, 0.6) | Solid::sphere(0.8)
}

fn union(copies: impl IntoIterator<Item = Solid>) -> Solid {
    Solid::union_all(copies, RFunction::MIN_MAX)
}

#[test]
fn the_floor_on_all_numbers() {
    assert_eq!([Real::floor(-0.5f64), Real::floor(2.0f64)], [-1.0, 2.0]);
    let range = Interval::new(-0.5, 1.0);
    assert_eq!(range.floor(), Interval::new(-1.0, 1.0));
    // Level between the jumps, of any slope across one.
    let level = Dual::variable(Interval::new(1.25, 1.75), 0).floor();
    assert_eq!((level.value(), level.gradient()[0].magnitude() < 1e-300), (Interval::point(1.0), true));
    assert_eq!(Dual::variable(range, 0).floor().gradient()[0], Interval::ALL);
    assert_eq!(Dual::variable(-3.25, 1).floor(), Dual::constant(-4.0));
}

#[test]
fn laws_are_what_their_formulas_say() {
    near(LinearLaw { at_zero: 0.5, slope: -2.0 }.at(0.75), -1.0, 1e-15);
    near(WAVE.at(0.3), 1.1 + 0.4 * (TAU * 0.3 / 2.5 + 0.7).sin(), 1e-15);
    for i in 0..=100 {
        let z = -1.0 + 0.02 * f64::from(i);
        let t = ((z + 0.6) / 1.5).clamp(0.0, 1.0);
        near(STEP.at(z), 0.5 + t * t * (3.0 - 2.0 * t), 1e-14);
    }
    for (z, v) in [(-3.0, 0.6), (-1.0, 0.6), (-0.6, 1.0), (0.15, 1.2), (0.8, 0.65), (1.1, 0.3), (7.0, 0.3)] {
        near(table().at(z), v, 1e-14);
    }
}

fn by_laws(x: &impl Law, y: &impl Law, angle: &impl Law) {
    let mut random = Random::new(400);
    let solid = block();
    let (tapered, twisted) = (solid.taper_by(x.clone(), y.clone()), solid.twist_by(rad(1.0), angle.clone()));
    for _ in 0..200 {
        let p = DVec3::new(random.range(-0.8, 0.8), random.range(-0.8, 0.8), random.range(-1.2, 1.2));
        let want = value(&solid, p);
        near(value(&tapered, DVec3::new(p.x * x.at(p.z), p.y * y.at(p.z), p.z)), want, 1e-13);
        let turn = DQuat::from_rotation_z(angle.at(p.z));
        near(value(&twisted, turn * p), want, 1e-13);
    }
    for solid in [tapered, twisted] {
        check_narrowing(&mut random, &solid, 30);
        forms_agree(&mut random, &solid, 3e-5);
        // The box holds the solid.
        let bounds = solid.bounds().unwrap();
        for _ in 0..500 {
            let p = bounds.center() + 1.5 * bounds.size() * random.vector(-0.5, 0.5);
            assert!(bounds.contains(p) || value(&solid, p) <= 0.0, "{solid:?} at {p}");
        }
    }
}

#[test]
fn points_move_by_laws() {
    by_laws(&WAVE, &0.7, &LinearLaw { at_zero: 0.3, slope: 1.7 });
    by_laws(&STEP, &table(), &WAVE);
    by_laws(&1.0, &LinearLaw { at_zero: 1.0, slope: 0.4 }, &table());
}

#[test]
fn a_law_that_is_wrong_says_where() {
    let text = |solid: Solid| solid.value(DVec3::ZERO).unwrap_err().to_string();
    let rod = Solid::cylinder(1.0, 4.0);
    let shrinking = text(rod.taper_by(1.0, LinearLaw { at_zero: 1.0, slope: 0.5 }));
    assert!(shrinking.starts_with("taper_by: y_law at z = -2"), "{shrinking}");
    assert!(shrinking.contains("allowed: 0.001 to 1000 over the solid, z from -2"), "{shrinking}");
    // A dip between the ends is found.
    let dip = LawTable::new([(-2.0, 1.0), (0.7, 1.0), (0.71, -1.0), (0.72, 1.0)]);
    assert!(text(rod.taper_by(dip, 1.0)).starts_with("taper_by: x_law at z = 0.7"));
    assert_eq!(text(rod.twist_by(rad(1.0), f64::NAN)), "twist_by: law is NaN, allowed: -1000000000 to 1000000000");
    assert!(text(rod.twist_by(rad(1.0), LinearLaw { at_zero: 0.0, slope: 1e8 })).contains("angle (degrees) at z = -2"));
    assert!(text(rod.taper_by(SineWave { wavelength: 0.0, ..WAVE }, 1.0)).contains("law.wavelength is 0"));
    assert!(text(rod.taper_by(LawTable::new([(0.0, 1.0), (0.0, 2.0)]), 1.0)).contains("law.points[1] (z above"));
    assert!(text(rod.twist_by(rad(1.0), LawTable::new([]))).contains("law.points (how many) is 0"));
    assert!(text(rod.twist_by(rad(1.0), SmoothStep { to: STEP.from, ..STEP })).contains("z above"));
    // Where it is out of range beside the solid nothing is wrong, and nothing is NaN.
    let fine = rod.taper_by(LinearLaw { at_zero: 1.0, slope: 0.4 }, 1.0);
    for z in [-1e12, -3.0, -2.5, 0.0, 1e12] {
        assert!(value(&fine, DVec3::new(0.3, 1e12, z)) <= 0.0);
        assert!(fine.gradient(DVec3::new(0.3, 0.1, z)).unwrap().is_finite());
    }
}

#[test]
fn mirrors() {
    let mut random = Random::new(401);
    for _ in 0..20 {
        let solid = random_solid(&mut random, 1);
        let (normal, offset) = (random.direction(), random.range(-1.0, 1.0));
        let image = solid.reflect(2.5 * normal, offset);
        let both = solid.mirrored(normal, offset);
        for _ in 0..20 {
            let p = random.vector(-2.0, 2.0);
            let q = p - 2.0 * (p.dot(normal) - offset) * normal;
            near(value(&image, p), value(&solid, q), 1e-9);
            near(value(&both, p), value(&solid, p).max(value(&solid, q)), 1e-9);
        }
    }
    let ball = Solid::sphere(0.5).translate(DVec3::new(1.0, 2.0, 3.0));
    for (one, both, at) in [
        (ball.reflect_x(), ball.mirrored_x(), DVec3::new(-1.0, 2.0, 3.0)),
        (ball.reflect_y(), ball.mirrored_y(), DVec3::new(1.0, -2.0, 3.0)),
        (ball.reflect_z(), ball.mirrored_z(), DVec3::new(1.0, 2.0, -3.0)),
    ] {
        assert_eq!([value(&one, at), value(&both, at)], [0.5, 0.5]);
        assert!(value(&one, DVec3::new(1.0, 2.0, 3.0)) < 0.0);
        assert_eq!(value(&both, DVec3::new(1.0, 2.0, 3.0)), 0.5);
    }
    assert!(ball.reflect(DVec3::ZERO, 1.0).value(DVec3::ZERO).is_err());
}

#[test]
fn elongation_is_exact_where_the_leaf_is() {
    let half = DVec3::new(0.5, 0.0, 1.5);
    let solid = Solid::sphere(0.75).elongate(2.0 * half);
    near_point(solid.bounds().unwrap().max, half + 0.75, 1e-12);
    near_point(solid.bounds().unwrap().min, -half - 0.75, 1e-12);
    let mut random = Random::new(402);
    for _ in 0..500 {
        let p = random.vector(-4.0, 4.0);
        near(value(&solid, p), 0.75 - (p - p.clamp(-half, half)).length(), 1e-13);
    }
    // In the planes across which nothing is inserted slopes are those of the leaf.
    let long = Solid::sphere(1.0).translate([0.0, 0.6, 0.0]).elongate([1.0, 0.0, 0.0]);
    near_point(long.gradient([1.3, 0.0, 0.0]).unwrap(), DVec3::new(-0.8, 0.6, 0.0), 1e-12);
    let halves = block().translate(DVec3::Y * 3.0).elongate(DVec3::splat(2.0));
    check_narrowing(&mut random, &halves, 40);
    assert!(value(&halves, DVec3::new(0.9, 4.0, 0.9)) > 0.0 && value(&halves, DVec3::Y * 3.0) < 0.0);
    let wrong = Solid::sphere(1.0).elongate(DVec3::new(0.0, -1.0, 0.0)).bounds().unwrap_err();
    assert_eq!(wrong.to_string(), "elongate: lengths.y is -1, allowed: 0 to 1000000000");
}

/// Single and double precision lanes, gradients, and with the feature `formula` fidget's tree,
/// against the point values.
fn forms_agree(random: &mut Random, solid: &Solid, tolerance: f64) {
    let program = solid.surface_program().unwrap();
    let frame = frame_of(solid);
    let size = frame.longest_side();
    for _ in 0..3 {
        let center = random.point_in(&frame);
        let region = Bounds::from_center(center, DVec3::splat(random.range(0.02, 0.4) * size));
        let points: Vec<DVec3> = (0..300).map(|_| random.point_in(&region)).collect();
        for (p, got) in points.iter().zip(lanes64(&program, &region, &points)) {
            near(got, program.value(*p), 1e-11 * (1.0 + size));
        }
        let (seen, got) = lanes32(&program, &region, &points);
        let roundoff = Tape::new(&program, &region).roundoff();
        assert!(roundoff < 0.05 * size, "{solid:?}: {roundoff}");
        for (p, got) in seen.iter().zip(got) {
            let want = program.value(*p);
            near(got, want, tolerance * (size + want.abs()));
            assert!(got.abs() <= roundoff || (got > 0.0) == (want > 0.0), "{solid:?} at {p}: {got}, {want}");
        }
        let tape = Tape::new(&program, &region);
        let (seen, [x, y, z]) = rounded(&points, tape.origin());
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; points.len()]);
        let [value, dx, dy, dz] = &mut out;
        Evaluator::new().gradients(&tape, &x, &y, &z, Gradients { value, dx, dy, dz }).unwrap();
        let mut off = 0;
        for (i, p) in seen.iter().enumerate() {
            let got = DVec3::new(f64::from(out[1][i]), f64::from(out[2][i]), f64::from(out[3][i]));
            let want = program.gradient(*p).1;
            off += usize::from((got - want).length() > 1e-2 * (1.0 + want.length()));
        }
        // Kinks are within a rounding error of a few.
        assert!(off <= 3, "{solid:?}: {off} gradients differ");
    }
    #[cfg(feature = "formula")]
    fidget_agrees(random, solid, &frame);
}

/// Fidget's tree against the point values.
#[cfg(feature = "formula")]
fn fidget_agrees(random: &mut Random, solid: &Solid, frame: &Bounds) {
    use fidget::shape::EzShape;
    let shape = fidget::vm::VmShape::from(solid.to_fidget().unwrap());
    let mut eval = fidget::vm::VmShape::new_point_eval();
    let tape = shape.ez_point_tape();
    for _ in 0..50 {
        let p = random.point_in(frame).as_vec3();
        let (got, _) = eval.eval(&tape, p.x, p.y, p.z).unwrap();
        near(-f64::from(got), value(solid, p.as_dvec3()), 1e-3 * frame.longest_side());
    }
}

/// What repetition promises, against the union of all copies.
fn check_repetition(random: &mut Random, folded: &Solid, copies: &Solid, exact: bool) {
    let frame = frame_of(copies);
    let size = frame.longest_side();
    let near_box = folded.bounds().unwrap();
    assert!(near_box.inflate(1e-9 * size).contains_bounds(&copies.bounds().unwrap()) || !near_box.is_finite());
    let (f, c) = (folded.surface_program().unwrap(), copies.surface_program().unwrap());
    for _ in 0..300 {
        let p = frame.center() + random.range(1.0, 3.0) * frame.size() * random.vector(-0.5, 0.5);
        let (got, want) = (f.value(p), c.value(p));
        let rounding = 1e-7 * (1.0 + want.abs());
        assert!(want.abs() < rounding || (got > 0.0) == (want > 0.0), "{folded:?} at {p}: {got}, not {want}");
        // Inside nothing is left out; outside what is left out is no nearer.
        assert!(got <= want + rounding, "{folded:?} at {p}: {got} above {want}");
        if want > 0.0 || exact {
            near(got, want, rounding);
            let (a, b) = (f.gradient(p).1, c.gradient(p).1);
            let kink = (c.value(p + 1e-6 * a.normalize_or_zero()) - want - 1e-6 * a.length()).abs() > 1e-8;
            assert!(kink || (a - b).length() < 1e-4 * (1.0 + b.length()), "{folded:?} at {p}: {a}, not {b}");
        }
    }
}

#[test]
fn grids_are_their_copies() {
    let mut random = Random::new(403);
    for round in 0..36 {
        let exact = round % 3 == 0;
        let solid = if exact {
            Solid::sphere(random.range(0.2, 0.9)).translate(random.vector(-1.0, 1.0))
        } else {
            let solid = random_solid(&mut random, round % 2);
            // What has no end is cut: it would be copied one by one.
            solid & Solid::cuboid(random.vector(0.5, 3.0)).translate(random.vector(-0.5, 0.5))
        };
        let counts = [0; 3].map(|_| random.pick(&[1, 1, 2, 3, 5, 8]));
        let spacing = DVec3::new(random.range(0.3, 3.0), random.range(0.3, 3.0), random.range(0.3, 3.0));
        let folded = solid.repeat(counts, spacing);
        let mut copies = Vec::new();
        for n in 0..counts.iter().product() {
            let at = [n % counts[0], n / counts[0] % counts[1], n / (counts[0] * counts[1])];
            copies.push(solid.translate(DVec3::from_array(at.map(f64::from)) * spacing));
        }
        check_repetition(&mut random, &folded, &union(copies), exact);
        if round % 4 == 0 {
            check_narrowing(&mut random, &folded, 8);
        }
    }
}

#[test]
fn rows_are_their_copies() {
    let mut random = Random::new(404);
    for round in 0..40 {
        let exact = round % 2 == 0;
        let solid = if exact { Solid::sphere(0.5).translate(random.vector(-1.0, 1.0)) } else { block() };
        let step = match round % 5 {
            0 => DVec3::new(0.0, -0.8, 0.0),
            1 => DVec3::new(0.0, 0.0, 1.3),
            _ => random.direction() * random.range(0.3, 2.5),
        };
        let count = random.pick(&[1, 2, 3, 7, 12]);
        let folded = solid.repeat_linear(count, step);
        let copies = union((0..count).map(|i| solid.translate(f64::from(i) * step)));
        check_repetition(&mut random, &folded, &copies, exact);
        if round % 4 == 0 {
            check_narrowing(&mut random, &folded, 8);
        }
    }
}

#[test]
fn rings_are_their_copies() {
    let mut random = Random::new(405);
    for (round, count) in [1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 24, 35, 37, 60].repeat(2).into_iter().enumerate() {
        let exact = round % 2 == 0;
        let solid = if exact { Solid::sphere(0.3) } else { block().scale(random.range(0.2, 0.7)) };
        // Some stand clear of one another, some overlap, some meet the axis.
        let away = random.rotation() * DVec3::X * random.range(0.1, 4.0);
        let solid = solid.translate(away);
        let folded = solid.repeat_polar(count);
        let turned = |i: u32| solid.rotate_z(rad(TAU * f64::from(i) / f64::from(count)));
        check_repetition(&mut random, &folded, &union((0..count).map(turned)), exact);
        if round % 5 == 0 {
            check_narrowing(&mut random, &folded, 10);
        }
    }
}

#[test]
fn repetition_in_all_forms() {
    let mut random = Random::new(406);
    let ball = Solid::sphere(0.4).translate(DVec3::new(0.31, -0.17, 0.23));
    let grid = ball.repeat([6, 5, 3], DVec3::new(1.03, 1.1, 0.77));
    let ring = ball.translate(DVec3::X * 3.0).repeat_polar(14);
    let uneven = ball.translate(DVec3::X * 3.0).repeat_polar(13);
    for solid in
        [&grid, &ring, &uneven, &grid.rotate(random.rotation()).twist(rad(0.2)), &ring.repeat([1, 1, 9], DVec3::Z)]
    {
        forms_agree(&mut random, solid, 3e-5);
        check_narrowing(&mut random, solid, 40);
    }
    // Far copies of a long row are the solid as much as near ones.
    let long = ball.repeat([1_000_000, 1, 1], DVec3::X);
    near(value(&long, DVec3::new(999_999.31, -0.17, 0.23)), 0.4, 1e-9);
    let end = Bounds::from_center(DVec3::new(777_777.0, 0.0, 0.0), DVec3::ONE);
    let points: Vec<DVec3> = (0..200).map(|_| random.point_in(&end)).collect();
    let program = long.surface_program().unwrap();
    let (seen, got) = lanes32(&program, &end, &points);
    let roundoff = Tape::new(&program, &end).roundoff();
    for (p, got) in seen.iter().zip(got) {
        assert!((got - program.value(*p)).abs() <= roundoff, "{roundoff}");
    }
}

#[test]
fn values_do_not_jump_at_the_edges_of_cells() {
    let mut random = Random::new(407);
    let ball = Solid::sphere(0.35).translate(DVec3::new(0.3, 0.2, -0.4));
    let wide = Solid::sphere(1.3).translate(DVec3::new(0.3, 0.2, -0.4));
    let rod = Solid::cylinder(0.2, 1.4).rotate(random.rotation()).translate(DVec3::new(2.0, 0.3, 0.0));
    for solid in [
        ball.repeat([7, 4, 2], DVec3::new(1.0, 0.9, 1.4)),
        wide.repeat([9, 1, 3], DVec3::new(1.0, 1.0, 0.8)),
        rod.repeat_linear(8, DVec3::new(0.3, 0.5, -0.2)),
        rod.repeat_polar(18),
        rod.repeat_polar(17),
        ball.translate(DVec3::X * 2.0).repeat_polar(5),
    ] {
        let program = solid.field_program().unwrap();
        let frame = solid.bounds().unwrap();
        for _ in 0..10 {
            let from = random.point_in(&frame.inflate(0.5 * frame.longest_side()));
            let to = random.point_in(&frame.inflate(0.5 * frame.longest_side()));
            const STEPS: u32 = 300;
            let step = (to - from) / f64::from(STEPS);
            let mut before = program.value(from);
            for i in 1..=STEPS {
                let next = program.value(from + f64::from(i) * step);
                assert!((next - before).abs() <= step.length() * (1.0 + 1e-6) + 1e-9, "{solid:?} by {}", next - before);
                before = next;
            }
        }
    }
}

#[test]
fn the_cost_does_not_depend_on_the_count() {
    let ball = Solid::sphere(0.4);
    let leaves = |solid: Solid| solid.surface_program().unwrap().leaf_count();
    assert_eq!(leaves(ball.repeat([10, 1, 1], DVec3::X)), 2);
    assert_eq!(leaves(ball.repeat([100_000, 1, 1], DVec3::X)), 2);
    assert_eq!(leaves(ball.repeat([1000, 1000, 1000], DVec3::ONE)), 8);
    assert_eq!(leaves(ball.repeat([1000, 1, 1], DVec3::splat(0.5))), 3);
    for (count, cost) in [(2, 2), (12, 2), (15, 3), (500, 2), (997, 3)] {
        assert_eq!(leaves(ball.translate(DVec3::X * 500.0).repeat_polar(count)), cost, "{count}");
    }
    assert_eq!(leaves(ball.repeat_polar(12)), 12);
}

#[test]
fn repetition_says_what_is_wrong() {
    let text = |solid: Solid| solid.value(DVec3::ZERO).unwrap_err().to_string();
    let ball = Solid::sphere(1.0);
    assert_eq!(text(ball.repeat([1, 0, 1], DVec3::ONE)), "repeat: counts.y is 0, allowed: 1 to 1000000");
    assert_eq!(text(ball.repeat([1, 1, 4], DVec3::ZERO)), "repeat: spacing.z is 0, allowed: 0.000000001 to 1000000000");
    assert!(text(ball.repeat([4, 1, 1], DVec3::NAN)).contains("spacing.x is NaN"));
    assert!(text(ball.repeat_linear(4, DVec3::ZERO)).contains("spacing.x is 0"));
    assert!(text(ball.repeat_linear(4, DVec3::NAN)).contains("spacing.x is NaN"));
    assert!(text(ball.repeat_linear(0, DVec3::ONE)).contains("counts.x is 0"));
    assert_eq!(text(ball.repeat_polar(0)), "repeat_polar: count is 0, allowed: 1 to 1000");
    assert_eq!(text(ball.repeat_polar(1001)), "repeat_polar: count is 1001, allowed: 1 to 1000");
    let floor = Solid::half_space(DVec3::Z, 0.0);
    assert!(text(floor.repeat([5000, 1, 1], DVec3::X)).contains("copies to be made one by one is 5000"));
    assert!(text(ball.repeat([5000, 1, 1], DVec3::X * 0.01)).contains("one by one"));
    // Few copies of what has no end are made.
    let steps = floor.translate(DVec3::Z).repeat([1, 1, 3], DVec3::Z);
    assert!(value(&steps, DVec3::Z * 2.9) > 0.0 && value(&steps, DVec3::Z * 3.1) < 0.0);
    // An operand that is wrong is named.
    let wrong = Solid::sphere(-1.0);
    for solid in [wrong.repeat([9, 1, 1], DVec3::X), wrong.repeat_polar(8), wrong.repeat_linear(9, DVec3::ONE)] {
        assert!(text(solid).ends_with("sphere: radius is -1, allowed: 0.000000001 to 1000000000"));
    }
    let nothing = ball.intersection(ball.translate(DVec3::X * 9.0), RFunction::MIN_MAX);
    assert!(value(&nothing.repeat([3, 3, 3], DVec3::ONE), DVec3::ZERO) < 0.0);
    assert!(matches!(ball.repeat_polar(0).bounds(), Err(SolidError::Parameter { .. })));
}

/// How many cells of a cube, divided so often, are kept as perhaps crossed by the surface.
fn kept(program: &Program, bounds: &Bounds, depth: usize) -> usize {
    let Region::Surface(program) = program.narrow(bounds) else { return 0 };
    if depth == 0 {
        return 1;
    }
    let centre = bounds.center();
    let part = |corner: DVec3| kept(&program, &Bounds::new(corner.min(centre), corner.max(centre)), depth - 1);
    bounds.corners().into_iter().map(part).sum()
}

#[test]
fn folds_prune_as_copies_do() {
    let ball = Solid::sphere(0.4).translate(DVec3::new(0.1, 0.2, 0.0));
    let pill = Solid::superellipsoid(DVec3::new(0.6, 0.3, 0.2), 0.5, 1.0).rotate_z(rad(0.5)).translate(DVec3::X * 3.0);
    let grid = |i: u32| ball.translate(DVec3::new(f64::from(i % 4), f64::from(i / 4), 0.0));
    for (folded, copies) in [
        (ball.repeat([4, 4, 1], DVec3::ONE), union((0..16).map(grid))),
        (pill.repeat_polar(12), union((0..12).map(|i| pill.rotate_z(rad(TAU * f64::from(i) / 12.0))))),
        (pill.repeat_polar(11), union((0..11).map(|i| pill.rotate_z(rad(TAU * f64::from(i) / 11.0))))),
        (
            pill.repeat([5, 1, 1], DVec3::X * 0.7),
            union((0..5).map(|i| pill.translate(DVec3::X * (0.7 * f64::from(i))))),
        ),
    ] {
        let bounds = copies.bounds().unwrap();
        let cube = Bounds::from_center(bounds.center() + 0.0123, DVec3::splat(0.53 * bounds.longest_side()));
        let count = |solid: &Solid| kept(&solid.surface_program().unwrap(), &cube, 6);
        let (folds, all) = (count(&folded), count(&copies));
        println!("{folds} kept, {all} of copies");
        assert!(folds as f64 <= 1.02 * all as f64 && folds as f64 >= 0.98 * all as f64, "{folds} {all} {folded:?}");
    }
}

#[test]
fn repetition_meshes_and_is_hit_by_rays() {
    let ball = Solid::sphere(0.3).translate(DVec3::X * 0.2);
    let solid = ball.repeat([3, 2, 1], DVec3::ONE);
    let settings = MeshSettings { cell: CellSize::LongestSide(40), ..MeshSettings::default() };
    let report = solid.mesh(&settings).unwrap().check();
    assert!(report.is_closed() && report.is_manifold());
    let volume = 6.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.3f64.powi(3);
    near(report.volume, volume, 0.03 * volume);
    let copies = union((0..6).map(|i| ball.translate(DVec3::new(f64::from(i % 3), f64::from(i / 3), 0.0))));
    let mut random = Random::new(408);
    for _ in 0..60 {
        let from = 4.0 * random.direction();
        let to = random.vector(-0.3, 2.3);
        let hits = [&solid, &copies].map(|s| s.raycast(from, to - from).unwrap());
        match hits {
            [Some(a), Some(b)] => near_point(a.point, b.point, 1e-7),
            [None, None] => {}
            other => panic!("{other:?}"),
        }
    }
}

/// The formula of the built-in superellipsoid, as a user would write it.
#[derive(Debug)]
struct Own(Superellipsoid);

impl Field for Own {
    fn name(&self) -> &'static str {
        "own"
    }
    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (a, [e1, e2]) = (self.0.semi_axes(), self.0.exponents());
        let section = (x * (1.0 / a.x)).norm(y * (1.0 / a.y), Norm::of_exponent(e2));
        let gauge = section.norm(z * (1.0 / a.z), Norm::of_exponent(e1));
        (-gauge + 1.0) * self.0.inscribed_radius()
    }
    fn bounds(&self) -> Bounds {
        Field::bounds(&self.0)
    }
    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
    fn convex(&self) -> bool {
        true
    }
}

/// The same of the sphere.
#[derive(Debug)]
struct OwnSphere(f64);

impl Field for OwnSphere {
    fn name(&self) -> &'static str {
        "own sphere"
    }
    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        -x.norm(y, Norm::Euclid).norm(z, Norm::Euclid) + self.0
    }
    fn bounds(&self) -> Bounds {
        Bounds::from_center(DVec3::ZERO, DVec3::splat(self.0))
    }
    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }
    fn convex(&self) -> bool {
        true
    }
}

#[test]
fn users_own_leaves_prune_as_built_in_ones() {
    let leaf = Superellipsoid::new(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    let turn = |solid: Solid| {
        let map = DAffine3::from_quat(DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 1.1)));
        solid.affine(map)
    };
    for (own, built_in) in [
        (Solid::new(Own(leaf)), Solid::from(leaf)),
        (Solid::new(OwnSphere(0.7)), Solid::sphere(0.7)),
        (turn(Solid::new(Own(leaf))), turn(leaf.into())),
        (Solid::new(Own(leaf)).twist(rad(0.8)), Solid::from(leaf).twist(rad(0.8))),
    ] {
        let cube = Bounds::from_center(DVec3::splat(0.0123), DVec3::splat(1.3));
        let count = |solid: &Solid| kept(&solid.surface_program().unwrap(), &cube, 6);
        let (own, built_in) = (count(&own), count(&built_in));
        println!("{own} kept, built in {built_in}");
        assert!(own as f64 <= 1.005 * built_in as f64, "{own} {built_in}");
    }
}
