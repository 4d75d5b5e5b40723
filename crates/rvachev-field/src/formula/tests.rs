//! Random formulas: every evaluation against every other, and against fidget.

use fidget::context::{BinaryOpcode as B, Tree, UnaryOpcode as U};
use fidget::shape::EzShape;
use fidget::vm::VmShape;
use glam::DVec3;

use super::Formula;
use super::code::Builder;
use crate::kernel::CHUNK;
use crate::{AnyField, Chunk, Placement, VALUE_LIMIT, Zone};
use crate::{Bounds, Dual, Interval};

/// splitmix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A number of single precision.
    fn range(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1u64 << 53) as f64;
        f64::from((low + (high - low) * unit) as f32)
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

const UNARY: [U; 17] = [
    U::Neg,
    U::Abs,
    U::Recip,
    U::Sqrt,
    U::Square,
    U::Floor,
    U::Ceil,
    U::Round,
    U::Sin,
    U::Cos,
    U::Tan,
    U::Asin,
    U::Acos,
    U::Atan,
    U::Exp,
    U::Ln,
    U::Not,
];

/// Without remainders, whose value in single precision is another at every step.
const BINARY: [B; 10] = [B::Add, B::Sub, B::Mul, B::Div, B::Atan, B::Min, B::Max, B::Compare, B::And, B::Or];

/// Those that the fields of solids are made of.
const PLAIN_UNARY: [U; 4] = [U::Neg, U::Abs, U::Sqrt, U::Square];
const PLAIN_BINARY: [B; 6] = [B::Add, B::Sub, B::Mul, B::Min, B::Max, B::Max];

fn random_formula(random: &mut Random, plain: bool) -> Formula {
    let mut builder = Builder::default();
    let mut list: Vec<u32> = (0..3).map(|axis| builder.axis(axis)).collect();
    for _ in 0..4 {
        let c = random.range(-2.0, 2.0);
        list.push(builder.constant(c));
    }
    for _ in 0..4 + random.below(40) {
        // Late ones are likelier, so that chains get long.
        let mut operand = |list: &[u32]| {
            let back = random.below(list.len()).min(random.below(list.len()));
            list[list.len() - 1 - back]
        };
        let (a, b) = (operand(&list), operand(&list));
        let unary = random.below(3) == 0;
        list.push(match (unary, plain) {
            (true, false) => builder.unary(random.pick(&UNARY), a),
            (true, true) => builder.unary(random.pick(&PLAIN_UNARY), a),
            (false, false) => builder.binary(random.pick(&BINARY), a, b),
            (false, true) => builder.binary(random.pick(&PLAIN_BINARY), a, b),
        });
    }
    let root = list[list.len() - 1];
    Formula::of_code(builder.finish(root), Bounds::ALL)
}

fn random_zone(random: &mut Random) -> Zone {
    let size = 10f64.powf(random.range(-3.0, 0.3));
    let centre = DVec3::from_array([0; 3].map(|_| random.range(-2.0, 2.0)));
    let half = DVec3::from_array([0; 3].map(|_| size * random.range(0.0, 1.0)));
    Zone::of_bounds(&Bounds::new(centre - half, centre + half))
}

fn point_in(random: &mut Random, zone: &Zone) -> [f64; 3] {
    zone.hull().map(|side| {
        let any = random.range(0.0, 1.0);
        let t = random.pick(&[0.0, 1.0, 0.5, any]);
        (side.lo() + t * side.width()).clamp(side.lo(), side.hi())
    })
}

fn lanes(formula: &Formula, points: &[[f64; 3]]) -> Vec<f32> {
    let placement = Placement::IDENTITY;
    let len = points.len().next_multiple_of(CHUNK);
    let column = |axis: usize| -> Vec<f32> { (0..len).map(|i| points[i.min(points.len() - 1)][axis] as f32).collect() };
    let (x, y, z) = (column(0), column(1), column(2));
    let mut out = vec![0.0; len];
    formula.lanes32(Chunk { points: [&x, &y, &z], placement: &placement, out: [&mut out] });
    out.truncate(points.len());
    out
}

fn double_lanes(formula: &Formula, points: &[[f64; 3]]) -> Vec<f64> {
    let placement = Placement::IDENTITY;
    let len = points.len().next_multiple_of(CHUNK);
    let column = |axis: usize| -> Vec<f64> { (0..len).map(|i| points[i.min(points.len() - 1)][axis]).collect() };
    let (x, y, z) = (column(0), column(1), column(2));
    let mut out = vec![0.0; len];
    formula.lanes64(Chunk { points: [&x, &y, &z], placement: &placement, out: [&mut out] });
    out.truncate(points.len());
    out
}

fn single_points(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [0; 3].map(|_| random.range(-2.0, 2.0))).collect()
}

/// Equal, both NaN, or apart by a few units of single precision.
fn alike(a: f32, b: f32) -> bool {
    a == b || (a - b).abs() <= 4e-7 * a.abs().max(b.abs())
}

#[test]
fn lanes_are_those_of_fidget() {
    let mut random = Random(1);
    let (mut same, mut all) = (0, 0);
    for round in 0..300 {
        let formula = random_formula(&mut random, round % 2 == 0);
        let points = single_points(&mut random, 64);
        let shape = VmShape::from(formula.tree());
        let tape = shape.ez_float_slice_tape();
        let mut eval = VmShape::new_float_slice_eval();
        let column = |axis: usize| -> Vec<f32> { points.iter().map(|p| p[axis] as f32).collect() };
        let theirs = eval.eval(&tape, &column(0), &column(1), &column(2)).unwrap().to_vec();
        for (ours, theirs) in lanes(&formula, &points).into_iter().zip(theirs) {
            let limit = VALUE_LIMIT as f32;
            let theirs = if theirs.is_nan() { -limit } else { (-theirs).clamp(-limit, limit) };
            assert!(!ours.is_nan());
            all += 1;
            same += usize::from(alike(ours, theirs));
        }
    }
    // fidget folds constants and reorders; a step then falls on the other side here and there.
    assert!(same * 1000 >= all * 995, "{same} of {all}");
}

#[test]
fn single_precision_is_within_its_bound() {
    let mut random = Random(2);
    let mut bounded = 0;
    for round in 0..600 {
        let formula = random_formula(&mut random, round % 4 != 0);
        let points = single_points(&mut random, 64);
        let bound = formula.roundoff(2.0);
        bounded += usize::from(bound.is_finite());
        for (p, single) in points.iter().zip(lanes(&formula, &points)) {
            let truth = formula.value(*p);
            let off = (f64::from(single) - truth).abs();
            assert!(off <= bound, "{off:e} over {bound:e} at {p:?}, true {truth:e}: {:?}", formula.0.code.ops());
        }
    }
    assert!(bounded > 250, "{bounded}");
}

#[test]
fn doubles_are_those_of_points() {
    let mut random = Random(3);
    for round in 0..200 {
        let formula = random_formula(&mut random, round % 2 == 0);
        let points = single_points(&mut random, 32);
        for (p, lane) in points.iter().zip(double_lanes(&formula, &points)) {
            let value = formula.value(*p);
            assert!(value == lane, "{value:e} and {lane:e} at {p:?}");
        }
    }
}

#[test]
fn ranges_hold_their_samples() {
    let mut random = Random(4);
    let mut decided = 0;
    for round in 0..1500 {
        let formula = random_formula(&mut random, round % 2 == 0);
        for _ in 0..4 {
            let zone = random_zone(&mut random);
            let range = formula.range(&zone);
            let dual = formula.dual_range(Dual::point(zone.hull()));
            decided += usize::from(range.lo() > 0.0 || range.hi() < 0.0);
            for _ in 0..12 {
                let p = point_in(&mut random, &zone);
                let value = formula.value(p);
                assert!(range.contains(value), "{value:e} not in {range:?}: {:?}", formula.0.code.ops());
                assert!(dual.value().contains(value));
                let slopes = formula.dual(Dual::point(p)).gradient();
                for (slope, range) in slopes.into_iter().zip(dual.gradient()) {
                    let slack = 1e-9 * (1.0 + slope.abs());
                    assert!(
                        range.inflate(slack).contains(slope),
                        "{slope:e} not in {range:?} at {p:?} of {zone:?}: {:?}",
                        formula.0.code.ops()
                    );
                }
            }
        }
    }
    assert!(decided > 1000, "{decided}");
}

#[test]
fn narrowed_formulas_have_the_same_values() {
    let mut random = Random(5);
    let mut narrowed = 0;
    for round in 0..2000 {
        let formula = random_formula(&mut random, round % 3 != 0);
        let zone = random_zone(&mut random);
        let Some(part) = formula.narrowed_to(&zone) else { continue };
        narrowed += 1;
        assert!(part.len() < formula.len());
        for _ in 0..16 {
            let p = point_in(&mut random, &zone);
            let (value, want) = (part.value(p), formula.value(p));
            assert!(value == want, "{value:e}, {want:e} at {p:?}: {:?}", formula.0.code.ops());
        }
        // Its bound is for the zone alone.
        let points: Vec<[f64; 3]> =
            (0..16).map(|_| point_in(&mut random, &zone).map(|c| f64::from(c as f32))).collect();
        let bound = part.roundoff(zone.reach());
        for (p, single) in points.iter().zip(lanes(&part, &points)) {
            let off = (f64::from(single) - part.value(*p)).abs();
            assert!(off <= bound, "{off:e} over {bound:e} at {p:?}: {:?}", part.0.code.ops());
        }
    }
    assert!(narrowed > 300, "{narrowed}");
}

/// The parts that a zone is halved into along its axes, again and again.
fn parts_of(zone: &Zone, count: usize) -> Vec<Zone> {
    let mut parts = vec![zone.hull()];
    while parts.len() < count {
        let axis = parts.len().ilog2() as usize % 3;
        let halves = parts.iter().flat_map(|part| {
            let mid = part[axis].mid();
            [(part[axis].lo(), mid), (mid, part[axis].hi())].map(|(lo, hi)| {
                let mut half = *part;
                half[axis] = Interval::new(lo, hi);
                half
            })
        });
        parts = halves.collect();
    }
    parts.into_iter().map(Zone::of_sides).collect()
}

#[test]
fn many_boxes_at_once_are_as_one_by_one() {
    let mut random = Random(11);
    let other = random_formula(&mut random, true);
    let (mut narrowed, mut alike) = (0, 0);
    for round in 0..600 {
        let formula = random_formula(&mut random, round % 3 != 0);
        let zones = parts_of(&random_zone(&mut random), 16);
        let asked = || zones.iter().map(|zone| (formula.range(zone), formula.narrowed_to(zone))).collect::<Vec<_>>();
        formula.survey(&zones);
        let together = asked();
        other.survey(&zones);
        for ((zone, (range, part)), (alone, other)) in zones.iter().zip(together).zip(asked()) {
            let slack = 1e-11 * (1.0 + alone.magnitude());
            assert!(alone.inflate(slack).contains(range.lo()) && alone.inflate(slack).contains(range.hi()));
            for _ in 0..4 {
                let p = point_in(&mut random, zone);
                assert!(range.contains(formula.value(p)), "{:?}", formula.0.code.ops());
            }
            let Some(part) = part else { continue };
            narrowed += 1;
            alike += usize::from(other.is_some_and(|other| other.len() == part.len()));
            let points: Vec<[f64; 3]> = (0..4).map(|_| point_in(&mut random, zone)).collect();
            let wide = double_lanes(&part, &points);
            for (p, wide) in points.iter().zip(wide) {
                assert_eq!(
                    (part.value(*p), wide),
                    (formula.value(*p), formula.value(*p)),
                    "{:?}",
                    formula.0.code.ops()
                );
            }
        }
    }
    // A minimum that only rounding decides may be left open.
    assert!(narrowed > 1000 && alike * 100 > narrowed * 99, "{alike} of {narrowed}");
}

#[test]
fn bounds_of_rounding_errors_hold_for_what_is_narrowed_further() {
    let mut random = Random(12);
    let mut shared = 0;
    for round in 0..4000 {
        let formula = random_formula(&mut random, round % 3 != 0);
        let zone = random_zone(&mut random);
        let Some(elder) = formula.narrowed_to(&zone) else { continue };
        for zone in parts_of(&zone, 8) {
            let Some(part) = elder.narrowed_to(&zone) else { continue };
            let points: Vec<[f64; 3]> =
                (0..8).map(|_| point_in(&mut random, &zone).map(|c| f64::from(c as f32))).collect();
            let bound = part.roundoff(zone.reach());
            shared += usize::from(elder.0.roundoff.get() == Some(&bound));
            for (p, single) in points.iter().zip(lanes(&part, &points)) {
                let off = (f64::from(single) - part.value(*p)).abs();
                assert!(off <= bound, "{off:e} over {bound:e} at {p:?}: {:?}", part.0.code.ops());
            }
        }
    }
    assert!(shared > 50, "{shared}");
}

#[test]
fn gradients_are_those_of_points_and_differences() {
    let mut random = Random(6);
    let (mut close, mut all) = (0, 0);
    for _ in 0..300 {
        let formula = random_formula(&mut random, true);
        let points = single_points(&mut random, 16);
        let placement = Placement::IDENTITY;
        let column = |axis: usize| -> Vec<f32> { (0..CHUNK).map(|i| points[i % 16][axis] as f32).collect() };
        let (x, y, z) = (column(0), column(1), column(2));
        let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![f32::NAN; CHUNK]);
        formula.gradients(Chunk {
            points: [&x, &y, &z],
            placement: &placement,
            out: out.each_mut().map(Vec::as_mut_slice),
        });
        assert!(out.iter().flatten().all(|v| v.is_finite()));
        for (i, p) in points.iter().enumerate() {
            let dual = formula.dual(Dual::point(*p));
            let h = 1e-6;
            for axis in 0..3 {
                let moved = |by: f64| {
                    let mut q = *p;
                    q[axis] += by;
                    formula.value(q)
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                let slope = dual.gradient()[axis];
                let near = |a: f64, b: f64, part: f64| (a - b).abs() <= part * (1.0 + a.abs().max(b.abs()));
                all += 1;
                close += usize::from(near(slope, difference, 1e-3) && near(slope, f64::from(out[1 + axis][i]), 1e-3));
            }
        }
    }
    // Kinks, poles and points near where the value is undefined are left.
    assert!(close * 100 >= all * 96, "{close} of {all}");
}

#[test]
fn native_code_has_the_same_values() {
    let mut random = Random(7);
    for _ in 0..40 {
        let formula = random_formula(&mut random, true);
        let points = single_points(&mut random, 64);
        let before = lanes(&formula, &points);
        for _ in 0..40 {
            lanes(&formula, &points);
        }
        let bound = formula.roundoff(2.0);
        for (a, b) in before.iter().zip(lanes(&formula, &points)) {
            let off = (f64::from(*a) - f64::from(b)).abs();
            assert!(alike(*a, b) || off <= 2.0 * bound, "{a} and {b}: {:?}", formula.0.code.ops());
        }
    }
}

#[test]
fn remainders_and_noise() {
    let (x, y, _) = Tree::axes();
    for tree in [x.modulo(0.7), (x.clone() * 3.0).modulo(y.clone()), x.rand(), x.mix(y)] {
        let formula = Formula::new(&tree, Bounds::ALL);
        let mut random = Random(8);
        for _ in 0..200 {
            let zone = random_zone(&mut random);
            let range = formula.range(&zone);
            for _ in 0..8 {
                let value = formula.value(point_in(&mut random, &zone));
                assert!(range.contains(value), "{value:e} not in {range:?}");
            }
        }
    }
}

#[test]
fn no_input_leaks_nan() {
    let mut random = Random(9);
    let spicy = [0.0, -0.0, 1e-20, -1e-20, 1e12, -1e12, 1.0, -1.0, 0.5];
    for _ in 0..300 {
        let formula = random_formula(&mut random, false);
        let points: Vec<[f64; 3]> = (0..32).map(|_| [0; 3].map(|_| random.pick(&spicy))).collect();
        for (p, single) in points.iter().zip(lanes(&formula, &points)) {
            assert!(single.is_finite() && formula.value(*p).is_finite());
            assert!(formula.dual(Dual::point(*p)).gradient().iter().all(|d| d.is_finite()));
        }
    }
}

#[test]
fn prospero_is_short_over_a_tile() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/prospero.vm");
    let Ok(text) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is not there");
        return;
    };
    let whole = Formula::from_vm(&text, Bounds::ALL).unwrap();
    let mut random = Random(10);
    let mut sums = [0; 4];
    for _ in 0..40 {
        let centre = DVec3::new(random.range(-0.9, 0.9), random.range(-0.9, 0.9), 0.0);
        let mut part = whole.clone();
        for (sum, half) in sums.iter_mut().zip([0.25, 0.0625, 0.015_625, 0.003_906_25]) {
            let zone = Zone::of_bounds(&Bounds::from_center(centre, DVec3::new(half, half, 0.0)));
            part = part.narrowed_to(&zone).unwrap_or(part);
            *sum += part.len();
            let p = point_in(&mut random, &zone);
            assert_eq!(part.value(p), whole.value(p));
        }
    }
    println!("operations left of {} over tiles of 1/4, 1/16 …: {:?}", whole.len(), sums.map(|sum| sum / 40));
    assert!(sums[3] / 40 < 100);
}
