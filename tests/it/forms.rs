//! One formula, all its forms: every leaf, map and join gives the same value as f64, lanes of
//! f32 and f64, fidget tree, and the gradients and ranges that belong to it.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use rvachev::{
    Bounds, Cuboid, Cylinder, Extrusion, GeneralisedSuperquadric, Gielis, HalfSpace, Helix, ParamError, Polygon,
    Profile, RFunction, Solid, Sphere, Superellipsoid, Superhyperboloid, Supershape, Supertoroid, Turns, deg,
    field::{Field, Real},
    law::{SineWave, SmoothStep},
    program::{Evaluator, Gradients, Tape},
    rad,
};

use crate::lattices::lattices;
use crate::primitives::primitives;
use crate::support::{RULES, Random, columns, lanes32, lanes64, random_box, rounded, samples};

/// A solid to put to the test.
struct Case {
    name: String,
    solid: Solid,
    /// The size that errors are relative to.
    size: f64,
    /// How much it magnifies errors: 1 for leaves that do not.
    condition: f64,
    /// Whether it is deformed: far away a deformation turns rounding into anything.
    deformed: bool,
}

fn case(name: impl Into<String>, solid: impl Into<Solid>, size: f64) -> Case {
    Case { name: name.into(), solid: solid.into(), size, condition: 1.0, deformed: false }
}

/// A torus as a formula for fidget.
#[cfg(feature = "formula")]
fn ring() -> Solid {
    let (x, y, z) = fidget::context::Tree::axes();
    let across = (x.square() + y.square()).sqrt() - 0.6;
    let tree = (across.square() + z.square()).sqrt() - 0.25;
    Solid::formula(&tree, Bounds::from_center(DVec3::ZERO, DVec3::new(0.85, 0.85, 0.25)))
}

#[cfg(not(feature = "formula"))]
fn ring() -> Solid {
    Solid::torus(0.6, 0.25)
}

fn leaves() -> Vec<Case> {
    let mut cases = vec![
        case("sphere", Sphere { radius: 0.7 }, 0.7),
        case("box", Cuboid { size: DVec3::new(1.0, 0.5, 2.0) }, 1.2),
        case("cylinder", Cylinder { radius: 0.4, height: 2.0 }, 1.1),
        case("half-space", HalfSpace { normal: DVec3::new(0.3, -0.5, 0.8), offset: 0.25 }, 1.0),
        case("formula", ring(), 0.9),
        case("half-space along an axis", HalfSpace { normal: DVec3::Y, offset: -0.25 }, 1.0),
    ];
    cases.extend(primitives().into_iter().map(|(name, solid, size)| case(name, solid, size)));
    // Far away single precision knows nothing of a pattern.
    cases.extend(lattices().into_iter().map(|(name, solid, size)| Case { deformed: true, ..case(name, solid, size) }));
    let axes = DVec3::new(1.0, 0.8, 0.6);
    for [e1, e2] in [
        [1.0, 1.0],
        [0.3, 0.7],
        [2.0, 2.0],
        [1.0, 0.2],
        [0.2, 1.0],
        [2.0, 0.5],
        [0.05, 0.05],
        [0.01, 0.02],
        [1.5, 1.9],
        [2.5, 0.8],
        [0.8, 2.5],
        [4.0, 3.0],
    ] {
        cases.push(case(format!("superellipsoid {e1} {e2}"), Superellipsoid::new(axes, e1, e2), 1.0));
    }
    cases.extend(superquadrics(axes));
    let circle = Gielis::circle();
    let bounded = Gielis::new(4.0, 10.0, 10.0, 10.0);
    for (name, equator, meridian) in [
        ("ball", circle, circle),
        ("hexagon", Gielis::new(6.0, 2.0, 7.0, 7.0), bounded),
        ("five-fold", Gielis::new(5.0, 3.0, 2.0, 8.0), Gielis::new(3.0, 4.0, 4.0, 4.0)),
        ("polygon", Gielis::polygon(6, 30.0), Gielis::new(4.0, 30.0, 30.0, 30.0)),
        ("uneven", Gielis { a: 1.5, b: 0.7, ..Gielis::new(4.0, 2.0, 3.0, 5.0) }, circle),
        ("twelve-fold", Gielis::new(12.0, 4.0, 6.0, 3.0), circle),
        ("first turn", Gielis::new(2.3, 3.0, 7.0, 4.0), Gielis::new(4.7, 4.0, 4.0, 4.0)),
        ("envelope", Gielis::rational(7, 3, 3.0, 7.0, 4.0), circle),
        ("core", Gielis::rational(5, 2, 3.0, 5.0, 5.0).with_turns(Turns::Inner), bounded),
    ] {
        let shape = Supershape::new(equator, meridian).scaled(DVec3::new(0.9, 1.0, 0.7));
        let condition = [equator, meridian].iter().map(|c| c.n2.max(c.n3) / c.n1).fold(1.0, f64::max);
        let size = Solid::from(shape.clone()).bounds().unwrap().longest_side();
        cases.push(Case { condition, ..case(format!("supershape {name}"), shape.clone(), size) });
        if equator.a == 1.0 {
            let shape = shape.rational();
            cases.push(Case { condition, ..case(format!("rational supershape {name}"), shape, size) });
        }
    }
    cases.extend(profiles());
    cases
}

/// Plane shapes as columns, and the solids made of them.
fn profiles() -> Vec<Case> {
    let frame = [[-1.0, -0.8], [1.0, -0.9], [0.9, 0.7], [0.1, 0.2], [-0.8, 0.8]];
    let hole = [[-0.5, -0.5], [-0.4, 0.1], [0.3, -0.3]];
    let gear = (0..48).map(|i| (if i / 2 % 2 == 0 { 1.0 } else { 0.8 }) * DVec2::from_angle(f64::from(i) * 0.1309));
    let mut cases = Vec::new();
    for (name, profile, condition) in [
        ("circle", Profile::circle(0.8), 1.0),
        ("superellipse", Profile::superellipse(DVec2::new(1.0, 0.6), 0.3), 1.0),
        ("ellipse", Profile::superellipse(DVec2::new(1.0, 0.6), 1.0), 1.0),
        ("pinched superellipse", Profile::superellipse(DVec2::new(1.0, 0.6), 2.4), 1.0),
        ("superpolygon", Profile::superpolygon(Gielis::new(5.0, 3.0, 4.0, 8.0), 0.9), 2.7),
        ("rectangle", Profile::rectangle(DVec2::new(1.6, 0.9)), 1.0),
        ("rounded rectangle", Profile::rounded_rectangle(DVec2::new(1.6, 0.9), 0.2), 1.0),
        ("regular polygon", Profile::regular_polygon(7, 0.9), 1.0),
        ("polygon", Polygon::new([frame.to_vec(), hole.to_vec()]).into(), 1.0),
        ("polygon of many edges", Profile::polygon(gear), 1.0),
    ] {
        cases.push(Case { condition, ..case(name, profile.column(), 1.0) });
        if name.starts_with("regular") || name.starts_with("polygon") {
            cases.push(Case { condition, ..case(format!("{name}, extruded"), profile.extrude(1.0), 1.0) });
            let ring = profile.scale(0.4).translate(DVec2::new(0.6, 0.0)).revolve();
            cases.push(Case { deformed: true, condition: 2.0, ..case(format!("{name}, revolved"), ring, 1.0) });
        }
    }
    let twisted = Extrusion { twist: rad(0.8), scale: 0.7, ..Extrusion::new(1.0) };
    let bar = Profile::rectangle(DVec2::new(1.0, 0.5)).extrude_with(&twisted);
    let part = Profile::circle(0.3).translate(DVec2::new(0.6, 0.0)).revolve_by(rad(4.0));
    // On the axis itself the angle about it is anything: no sample is to lie there.
    let spring = Profile::circle(0.2).sweep_helix(&Helix::new(0.7, 0.9, 1.4)).translate(DVec3::new(0.03, 0.02, 0.0));
    for (name, solid) in [("twisted bar", bar), ("part of a ring", part), ("spring", spring)] {
        cases.push(Case { deformed: true, condition: 6.0, ..case(name, solid, 1.0) });
    }
    cases
}

fn superquadrics(axes: DVec3) -> Vec<Case> {
    let mut cases = Vec::new();
    for [ring, e1, e2] in
        [[1.0, 1.0, 1.0], [1.5, 0.3, 0.7], [2.0, 2.0, 0.5], [4.0, 0.2, 2.0], [1.2, 0.05, 0.05], [1.5, 1.5, 2.5]]
    {
        let leaf = Supertoroid::new(axes, ring, e1, e2);
        cases.push(case(format!("supertoroid {ring} {e1} {e2}"), leaf, ring + 1.0));
    }
    for [e1, e2] in [[1.0, 1.0], [0.05, 1.6], [2.5, 0.8], [0.8, 2.5]] {
        for (name, leaf) in [
            ("one sheet", Superhyperboloid::one_sheet(axes, e1, e2, 1.8)),
            ("one sheet along x", Superhyperboloid::one_sheet_x(axes, e1, e2, 1.8)),
            ("two sheets", Superhyperboloid::two_sheets(axes, e1, e2, 2.2)),
            ("two sheets along x", Superhyperboloid::two_sheets_x(axes, e1, e2, 3.2)),
        ] {
            let size = Solid::from(leaf).bounds().unwrap().half_extents().max_element();
            cases.push(case(format!("{name} {e1} {e2}"), leaf, size));
        }
    }
    for exponents in
        [[2.0, 2.0, 2.0], [5.0, 3.0, 1.5], [1.0, 1.0, 1.0], [60.0, 1.0, 2.0], [1.2, 20.0, 40.0], [0.8, 3.0, 1.0]]
    {
        let leaf = GeneralisedSuperquadric::new(axes, exponents);
        cases.push(case(format!("generalised superquadric {exponents:?}"), leaf, 1.0));
    }
    cases
}

fn maps() -> Vec<Case> {
    let base = || Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    let shear = DAffine3::from_mat3_translation(
        DMat3::from_cols(DVec3::new(1.2, 0.1, 0.0), DVec3::new(0.4, 0.9, -0.2), DVec3::new(0.0, 0.3, 1.1)),
        DVec3::new(0.1, 0.2, -0.3),
    );
    let mut cases = vec![
        case("translate", base().translate(DVec3::new(0.4, -0.2, 0.1)), 1.5),
        case("rotate", base().rotate(DQuat::from_scaled_axis(DVec3::new(0.4, -0.7, 1.1))), 1.2),
        case("rotate about axes", base().rotate_x(rad(0.4)).rotate_y(rad(-1.0)).rotate_z(rad(2.0)), 1.2),
        case("scale", base().scale(0.01), 0.01),
        case("mirror", base().scale(-2.0), 2.0),
        case("scale_axes", base().scale_axes(DVec3::new(2.0, 0.5, 1.0)), 2.0),
        case("affine", base().affine(shear), 2.0),
    ];
    for (name, solid) in [
        ("taper", base().taper(0.5, -0.4, 1.2)),
        ("twist", base().twist(rad(1.3))),
        (
            "taper by laws",
            base().taper_by(SineWave { mean: 1.0, amplitude: 0.3, wavelength: 2.0, phase: rad(0.4) }, 0.8),
        ),
        ("twist by a law", base().twist_by(rad(1.0), SmoothStep { from: (-0.5, 0.0), to: (0.5, 1.2) })),
        ("elongate", base().elongate(DVec3::new(0.4, 0.0, 1.0))),
        ("bend", base().bend(0.5, rad(0.7))),
        ("bend the other way", base().bend(-0.6, deg(0.0))),
        ("a hair of a bend", base().bend(1e-9, rad(0.3))),
        ("all three", base().taper(0.25, 0.25, 1.2).twist(rad(0.8)).bend(0.5, deg(0.0))),
        ("deformed and moved", base().twist(rad(0.8)).rotate_x(rad(0.5)).taper(0.3, 0.1, 2.0).translate(DVec3::X)),
    ] {
        // The chain's largest stretch near the solid is below this.
        cases.push(Case { condition: 6.0, deformed: true, ..case(name, solid, 1.5) });
    }
    cases
}

/// How much a rule magnifies the errors of its operands, and its own order of growth.
fn condition_of(rule: RFunction) -> f64 {
    match rule {
        RFunction::Alpha(a) => (2.0 + (2.0 - 2.0 * a).sqrt()) / (1.0 + a),
        RFunction::Zero { m } => 3.41 * f64::from(m + 1),
        RFunction::P(p) => 2.0 + 2f64.powf(1.0 / p),
        RFunction::Associative(p) => 2f64.powf(1.0 / p),
        RFunction::Distance => 1.5,
        _ => unreachable!("not one of the rules"),
    }
}

fn joins() -> Vec<Case> {
    let a = Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    let b = Solid::cylinder(0.4, 3.0).rotate_x(rad(0.5)).translate(DVec3::new(0.2, 0.1, 0.0));
    let mut cases = Vec::new();
    for rule in RULES {
        let condition = condition_of(rule);
        let mut add = |name: &str, solid: Solid, condition: f64| {
            cases.push(Case { condition, ..case(format!("{name} by {rule:?}"), solid, 2.0) });
        };
        add("union", a.union(&b, rule), condition);
        add("intersection", a.intersection(&b, rule), condition);
        add("difference", a.difference(&b, rule), condition);
        add("symmetric difference", a.symmetric_difference(&b, rule), condition * condition);
        add("complement", !a.union(&b, rule), condition);
        let row = (0..5).map(|i| Solid::sphere(0.3).translate(DVec3::X * (0.25 * f64::from(i) - 0.5)));
        add("union of five", Solid::union_all(row, rule), condition.powi(3));
    }
    cases
}

fn all() -> Vec<Case> {
    let mut cases = leaves();
    cases.extend(maps());
    cases.extend(joins());
    cases
}

/// Points near the solid, far from it, on axes and axis planes, and at the ends of the scale.
fn points(case: &Case, random: &mut Random, count: usize, farthest: f64) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = Vec::new();
    for i in 0..count {
        let reach = if i % 3 == 0 { farthest } else { 1.5 } * case.size;
        let mut p = random.vector(-reach, reach);
        for axis in 0..3 {
            if random.chance(0.1) {
                p[axis] = 0.0;
            }
        }
        points.push(p);
    }
    for spicy in [0.0, 1e-20, -1e-20, 1e-9, 0.25, 0.5, -1.0] {
        points.extend([DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::new(1.0, -1.0, 0.0)].map(|d| spicy * d));
    }
    points
}

fn huge() -> Vec<DVec3> {
    let mut points = Vec::new();
    for size in [1e6, 1e12, 1e20, 3e38] {
        points.extend([DVec3::X, -DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::new(1.0, -1e-30, 0.5)].map(|d| size * d));
    }
    points
}

/// Collects what went wrong, so that a failure lists all of it.
#[derive(Default)]
struct Worst {
    failures: Vec<String>,
    /// The largest ratio of all, and its case.
    ratio: f64,
    name: String,
}

impl Worst {
    /// Notes the largest ratio of error to tolerance of a case if it is above 1.
    fn note(&mut self, name: &str, errors: impl Iterator<Item = (f64, String)>) -> f64 {
        let worst = errors.fold((0.0, String::new()), |worst, next| {
            // NaN counts as the worst.
            if next.0 <= worst.0 { worst } else { next }
        });
        if worst.0 > self.ratio {
            (self.ratio, self.name) = (worst.0, name.to_string());
        }
        if worst.0.is_nan() || worst.0 > 1.0 {
            self.failures.push(format!("{name}: {:.3} times the tolerance, {}", worst.0, worst.1));
        }
        worst.0
    }

    fn finish(self) {
        println!("worst: {:.3} of the tolerance, {}", self.ratio, self.name);
        assert!(self.failures.is_empty(), "{}", self.failures.join("\n"));
    }
}

fn compare(
    case: &Case,
    points: &[DVec3],
    got: &[f64],
    want: impl Fn(DVec3) -> f64,
    relative: f64,
    worst: &mut Worst,
) -> f64 {
    let errors = points.iter().zip(got).map(|(&p, &got)| {
        let want = want(p);
        let tolerance = relative * case.condition * (case.size + want.abs());
        ((got - want).abs() / tolerance, format!("at {p}: {got:e}, want {want:e}"))
    });
    worst.note(&case.name, errors)
}

#[test]
fn lanes_of_f32_agree() {
    let mut random = Random::new(1);
    let mut worst = Worst::default();
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let mut points = points(&case, &mut random, 600, 10.0);
        if !case.deformed {
            points.extend(huge());
        }
        let region = Bounds::from_center(DVec3::ZERO, DVec3::splat(10.0 * case.size));
        let (seen, values) = lanes32(&program, &region, &points);
        compare(&case, &seen, &values, |p| program.value(p), 4e-6, &mut worst);
    }
    worst.finish();
}

#[test]
fn lanes_of_f64_agree() {
    let mut random = Random::new(2);
    let mut worst = Worst::default();
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let mut points = points(&case, &mut random, 600, 10.0);
        if !case.deformed {
            points.extend(huge());
        }
        let region = Bounds::from_center(DVec3::ZERO, DVec3::splat(10.0 * case.size));
        let values = lanes64(&program, &region, &points);
        compare(&case, &points, &values, |p| program.value(p), 1e-11, &mut worst);
        // Slices of points are these lanes.
        let slices = case.solid.values(&points).unwrap();
        compare(&case, &points, &slices, |p| program.value(p), 1e-11, &mut worst);
        let inside = case.solid.contains_all(&points).unwrap();
        for (p, inside) in points.iter().zip(inside) {
            assert_eq!(inside, case.solid.contains(*p).unwrap(), "{} at {p}", case.name);
        }
    }
    worst.finish();
}

#[cfg(feature = "formula")]
#[test]
fn fidget_agrees() {
    use fidget::shape::EzShape;
    use fidget::vm::VmShape;

    let mut random = Random::new(3);
    let mut worst = Worst::default();
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let points = points(&case, &mut random, 300, 4.0);
        let (seen, [x, y, z]) = rounded(&points, DVec3::ZERO);
        let shape = VmShape::from(case.solid.to_fidget().unwrap());
        let mut evaluator = VmShape::new_float_slice_eval();
        let values = evaluator.eval(&shape.ez_float_slice_tape(), &x, &y, &z).expect("there are no variables");
        let values: Vec<f64> = values.iter().map(|v| -f64::from(*v)).collect();
        compare(&case, &seen, &values, |p| program.value(p), FIDGET, &mut worst);
    }
    worst.finish();
}

#[cfg(feature = "formula")]
/// Fidget has no power: it takes exponentials of logarithms, in single precision, and still
/// comes as close as the lanes.
const FIDGET: f64 = 4e-6;

#[test]
fn gradients_are_those_of_differences_where_smooth() {
    let mut random = Random::new(4);
    let mut worst = Worst::default();
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let (mut smooth, mut tried) = (0, 0);
        let mut errors = Vec::new();
        for _ in 0..200 {
            let p = random.vector(-1.5, 1.5) * case.size;
            let difference = |h: f64| {
                DVec3::from_array(
                    [DVec3::X, DVec3::Y, DVec3::Z]
                        .map(|axis| (program.value(p + h * axis) - program.value(p - h * axis)) / (2.0 * h)),
                )
            };
            let h = 1e-5 * case.size;
            let (coarse, fine) = (difference(2.0 * h), difference(h));
            tried += 1;
            // Where two steps disagree there is a crease between them.
            let scale = 1.0 + fine.length();
            if (coarse - fine).length() > 1e-7 * scale {
                continue;
            }
            smooth += 1;
            let (value, got) = program.gradient(p);
            let plain = program.value(p);
            assert!(
                (value - plain).abs() <= 1e-13 * case.condition * (case.size + plain.abs()),
                "{} at {p}",
                case.name
            );
            errors.push(((got - fine).length() / (1e-6 * scale), format!("at {p}: {got}, want {fine}")));
        }
        assert!(2 * smooth > tried, "{}: {smooth} of {tried} points are smooth", case.name);
        worst.note(&case.name, errors.into_iter());
    }
    worst.finish();
}

#[test]
fn gradients_in_bulk_agree() {
    let mut random = Random::new(5);
    let mut worst = Worst::default();
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let points: Vec<DVec3> = (0..300).map(|_| random.vector(-1.5, 1.5) * case.size).collect();
        let tape = Tape::new(&program, &Bounds::from_center(DVec3::ZERO, DVec3::splat(1.5 * case.size)));
        let (seen, [x, y, z]) = rounded(&points, tape.origin());
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; points.len()]);
        let [value, dx, dy, dz] = &mut out;
        Evaluator::new().gradients(&tape, &x, &y, &z, Gradients { value, dx, dy, dz }).unwrap();
        let mut errors = Vec::new();
        for (i, &p) in seen.iter().enumerate() {
            let (value, want) = program.gradient(p);
            let tolerance = 4e-6 * case.condition * (case.size + value.abs());
            errors.push(((f64::from(out[0][i]) - value).abs() / tolerance, format!("value at {p}")));
            let got = DVec3::new(out[1][i].into(), out[2][i].into(), out[3][i].into());
            // Near a crease the two may be on different sides of it.
            let nearby = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                let h = 1e-6 * case.size * axis;
                (program.gradient(p + h).1 - want).length().max((program.gradient(p - h).1 - want).length())
            });
            let curved = nearby.into_iter().fold(0.0, f64::max);
            let tolerance = 3e-4 * case.condition * (1.0 + want.length()) + 4.0 * curved;
            errors.push(((got - want).length() / tolerance, format!("at {p}: {got}, want {want}")));
        }
        worst.note(&case.name, errors.into_iter());
        // Slices in double precision are the single points.
        let slices = case.solid.gradients(&points[..20]).unwrap();
        for (p, g) in points.iter().zip(slices) {
            assert_eq!(g, case.solid.gradient(*p).unwrap(), "{} at {p}", case.name);
        }
    }
    worst.finish();
}

#[test]
fn ranges_hold_every_sample() {
    let mut random = Random::new(6);
    for case in all() {
        let frame = Bounds::from_center(DVec3::ZERO, DVec3::splat(1.5 * case.size));
        for _ in 0..40 {
            let bounds = random_box(&mut random, &frame);
            let range = case.solid.range(&bounds).unwrap();
            for p in samples(&mut random, &bounds, 64) {
                let v = case.solid.value(p).unwrap();
                assert!(range.contains(v), "{}: {v} at {p} is not in {range:?} of {bounds:?}", case.name);
            }
        }
        let everywhere = case.solid.range(&Bounds::ALL).unwrap();
        assert!(everywhere.contains(case.solid.value(DVec3::splat(1e5)).unwrap()), "{}", case.name);
    }
}

#[test]
fn finite_points_have_finite_values_and_gradients() {
    let mut random = Random::new(7);
    for case in all() {
        let program = case.solid.field_program().unwrap();
        let mut points = points(&case, &mut random, 200, 1e4);
        points.extend(huge());
        let single = points.clone();
        for size in [1e300, f64::MAX, f64::MIN_POSITIVE, 5e-324] {
            points.extend([DVec3::X, -DVec3::Y, DVec3::Z, DVec3::ONE].map(|d| size * d));
        }
        for &p in &points {
            let v = program.value(p);
            assert!(v.is_finite(), "{} at {p}: {v}", case.name);
            let (_, g) = program.gradient(p);
            assert!(g.is_finite(), "{} at {p}: {g}", case.name);
        }
        assert!(lanes64(&program, &Bounds::ALL, &points).iter().all(|v| v.is_finite()), "{}", case.name);
        let (seen, values) = lanes32(&program, &Bounds::ALL, &single);
        for (p, v) in seen.iter().zip(values) {
            assert!(v.is_finite(), "{} at {p}: {v} on lanes", case.name);
        }
        let tape = Tape::new(&program, &Bounds::ALL);
        let (seen, [x, y, z]) = rounded(&single, tape.origin());
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; seen.len()]);
        let [value, dx, dy, dz] = &mut out;
        Evaluator::new().gradients(&tape, &x, &y, &z, Gradients { value, dx, dy, dz }).unwrap();
        for (i, p) in seen.iter().enumerate() {
            let all = out.each_ref().map(|column| column[i]);
            assert!(all.iter().all(|v| v.is_finite()), "{} at {p}: {all:?} on lanes", case.name);
        }
    }
}

#[test]
fn lanes_take_slices_of_any_length() {
    let solid = Solid::sphere(1.0) - Solid::cuboid(DVec3::ONE);
    let tape = Tape::new(&solid.field_program().unwrap(), &Bounds::from_center(DVec3::ZERO, DVec3::ONE));
    let mut random = Random::new(8);
    let points: Vec<DVec3> = (0..1000).map(|_| random.vector(-1.0, 1.0)).collect();
    let [x, y, z] = columns(&points);
    let mut evaluator = Evaluator::new();
    for count in [0, 1, 2, 7, 8, 15, 16, 17, 63, 64, 65, 255, 256, 257, 1000] {
        let mut values = vec![9.0; 1000];
        evaluator.values_f64(&tape, &x[..count], &y[..count], &z[..count], &mut values[..count]).unwrap();
        for (i, v) in values.iter().enumerate() {
            let want = if i < count { solid.value(points[i]).unwrap() } else { 9.0 };
            assert!((v - want).abs() < 1e-12, "{i} of {count}: {v}, want {want}");
        }
    }
}

/// A leaf of a user, by every default of the trait.
#[derive(Debug)]
struct Wave {
    height: f64,
}

impl Field for Wave {
    fn name(&self) -> &'static str {
        "wave"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let (sin, _) = (x * 3.0).sin_cos();
        let top = sin * 0.25 + self.height - z;
        top.min(z).min(x + 1.0).min(-x + 1.0).min(y + 1.0).min(-y + 1.0)
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, self.height + 0.25))
    }

    fn check(&self) -> Result<(), ParamError> {
        if self.height > 0.0 { Ok(()) } else { Err(ParamError::new("height", self.height, "above 0")) }
    }
}

#[test]
fn a_leaf_of_a_user_has_all_forms() {
    let mut random = Random::new(9);
    let solid = Solid::new(Wave { height: 0.5 }).rotate_x(rad(0.3)).twist(rad(0.4)) - Solid::sphere(0.3);
    let case = Case { deformed: true, condition: 8.0, ..case("wave", solid, 1.5) };
    let program = case.solid.field_program().unwrap();
    let points = points(&case, &mut random, 400, 2.0);
    let region = Bounds::from_center(DVec3::ZERO, DVec3::splat(3.0));
    let mut worst = Worst::default();
    let (seen, single) = lanes32(&program, &region, &points);
    compare(&case, &seen, &single, |p| program.value(p), 4e-6, &mut worst);
    compare(&case, &points, &lanes64(&program, &region, &points), |p| program.value(p), 1e-11, &mut worst);
    worst.finish();
    for _ in 0..40 {
        let bounds = random_box(&mut random, &region);
        let range = case.solid.range(&bounds).unwrap();
        for p in samples(&mut random, &bounds, 64) {
            assert!(range.contains(case.solid.value(p).unwrap()), "at {p}");
        }
    }
    let text = Solid::new(Wave { height: -1.0 }).value(DVec3::ZERO).unwrap_err().to_string();
    assert_eq!(text, "wave: height is -1, allowed: above 0");
}
