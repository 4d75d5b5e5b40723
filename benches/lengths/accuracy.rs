//! How far lengths are from brute force, and what a point costs.

use std::hint::black_box;

use glam::DVec3;
use rvachev::{
    Bounds, Solid,
    program::{Evaluator, Region, Tape},
};

use super::race::{median, timed};
use super::reference::Surface;
use super::solids;

/// The share of a length that its surface may be off.
const TOLERANCE: f64 = 1e-3;

/// Points that are compared, and points that are timed.
const COMPARED: usize = 400;
const TIMED: usize = 16_384;

/// A solid, the depth that is asked for, and the nanoseconds that a point may take in bulk.
type Case = (&'static str, fn() -> Solid, f64, f64);

const CASES: [Case; 4] = [
    ("block", solids::block, 1.0, 60.0),
    ("bracket", solids::bracket, 1.0, 60.0),
    ("twisted", solids::twisted, 1.0, 150.0),
    ("vase", solids::vase, 1.6, 150.0),
];

/// A random source of fixed numbers.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> DVec3 {
        2.0 * DVec3::new(self.unit(), self.unit(), self.unit()) - 1.0
    }

    fn point_of(&mut self, surface: &Surface) -> DVec3 {
        let triangle = (self.unit() * surface.len() as f64) as usize;
        surface.point(triangle, [self.unit(), self.unit()])
    }
}

/// A point inside, and what is nearest to it on the surface.
struct Known {
    p: DVec3,
    foot: DVec3,
}

/// Points about as deep inside as is asked for, and how many nearest points contradict brute force.
fn known(operand: &Solid, surface: &Surface, depth: f64, count: usize) -> (Vec<Known>, usize) {
    let mut random = Random(7);
    let (mut all, mut wrong) = (Vec::new(), 0);
    for _ in 0..20 * count {
        if all.len() == count {
            break;
        }
        let p = random.point_of(surface) + 1.5 * depth * random.vector();
        let [least, most] = surface.distance(p);
        if !operand.contains(p).unwrap_or(false) || most < 0.5 * depth || least > 1.5 * depth {
            continue;
        }
        let Ok(Some(foot)) = operand.closest_surface_point(p) else { continue };
        if (least - 1e-9..=most + 1e-9).contains(&foot.distance(p)) {
            all.push(Known { p, foot });
        } else {
            wrong += 1;
        }
    }
    (all, wrong)
}

/// Prints how far values and normals are off.
fn print_errors(operand: &Solid, moved: &Solid, surface: &Surface, depth: f64, count: usize) {
    let (all, wrong) = known(operand, surface, depth, count);
    let mut errors = Vec::new();
    let (mut squares, mut normals) = (0.0, 0);
    for Known { p, foot } in &all {
        let (Ok(value), Ok(gradient)) = (moved.value(*p), moved.gradient(*p)) else { continue };
        let distance = p.distance(*foot);
        errors.push(((value + depth - distance).abs(), *p));
        let angle = gradient.angle_between(*p - *foot);
        // Where two feet are as near, there is no normal.
        if angle < 0.1 {
            squares += angle * angle;
            normals += 1;
        }
    }
    errors.sort_by(|a, b| b.0.total_cmp(&a.0));
    let within = |by: f64| {
        let count = errors.iter().filter(|(error, _)| *error <= by * TOLERANCE * depth).count();
        100.0 * count as f64 / errors.len() as f64
    };
    let largest = errors.first().map_or(f64::NAN, |(error, _)| *error);
    println!(
        "  {} points: {:.2} % within the tolerance, {:.2} % within three; largest {largest:.1e}; normals {:.1e} rad \
         rms of {normals}; {wrong} without a reference{}",
        errors.len(),
        within(1.0),
        within(3.0),
        (squares / f64::from(normals.max(1))).sqrt(),
        if surface.is_whole() { "" } else { "; the mesh of reference may have lost parts" },
    );
    for (error, p) in errors.iter().filter(|(error, _)| *error > 3.0 * TOLERANCE * depth).take(5) {
        println!("    {error:.2e} at ({:.4}, {:.4}, {:.4})", p.x, p.y, p.z);
    }
}

/// Nanoseconds a point in blocks of 8³ about the moved surface, each with its narrowed program.
fn in_blocks(moved: &Solid, surface: &Surface, depth: f64, side: f64) -> f64 {
    let Ok(program) = moved.surface_program() else { return f64::NAN };
    let mut random = Random(11);
    let mut tapes = Vec::new();
    for _ in 0..10 * TIMED / 512 {
        let half = DVec3::splat(0.5 * side);
        let region = Bounds::from_center(random.point_of(surface) + depth * random.vector(), half);
        if let Region::Surface(narrowed) = program.narrow(&region) {
            tapes.push(Tape::new(&narrowed, &region));
        }
        if tapes.len() == TIMED / 512 {
            break;
        }
    }
    let step = side / 8.0;
    let axis = |shift: usize| -> Vec<f32> {
        (0..512usize).map(|i| ((((i >> shift) & 7) as f64 - 3.5) * step) as f32).collect()
    };
    let [x, y, z] = [0, 3, 6].map(axis);
    let mut evaluator = Evaluator::new();
    let mut out = vec![0.0; 512];
    let each = (0..5).map(|_| {
        let (seconds, ()) = timed(|| {
            for tape in &tapes {
                evaluator.values(tape, &x, &y, &z, black_box(&mut out)).expect("slices of one length");
            }
        });
        seconds * 1e9 / (512 * tapes.len()) as f64
    });
    median(each.collect())
}

/// Nanoseconds a point in random order near the moved surface: through one tape, and one by one.
fn scattered(moved: &Solid, surface: &Surface, depth: f64) -> [f64; 2] {
    let (Ok(program), Ok(bounds)) = (moved.surface_program(), moved.bounds()) else { return [f64::NAN; 2] };
    let mut random = Random(13);
    let points: Vec<DVec3> = (0..TIMED).map(|_| random.point_of(surface) + depth * random.vector()).collect();
    let tape = Tape::new(&program, &bounds);
    let [x, y, z] =
        [0, 1, 2].map(|axis| points.iter().map(|p| (p[axis] - tape.origin()[axis]) as f32).collect::<Vec<f32>>());
    let mut evaluator = Evaluator::new();
    let mut out = vec![0.0; points.len()];
    let in_bulk = (0..3)
        .map(|_| timed(|| evaluator.values(&tape, &x, &y, &z, black_box(&mut out)).expect("slices of one length")).0);
    let in_bulk = median(in_bulk.collect());
    let few = &points[..TIMED / 8];
    let single = (0..3).map(|_| timed(|| few.iter().map(|p| program.value(*p)).sum::<f64>()).0);
    let single = median(single.collect());
    [in_bulk * 1e9 / points.len() as f64, single * 1e9 / few.len() as f64]
}

/// Prints accuracy and costs, of the cases whose name is chosen.
pub fn print_rows(is_chosen: impl Fn(&str) -> bool, is_quick: bool) {
    let (cells, count) = if is_quick { (96, COMPARED / 4) } else { (192, COMPARED) };
    println!("\naccuracy at a tolerance of {TOLERANCE} of the length; nanoseconds a point, near the moved surface");
    for (name, operand, depth, allowed) in CASES.into_iter().filter(|(name, ..)| is_chosen(name)) {
        let plain = operand();
        let Ok(Some(surface)) = Surface::new(&plain, cells) else {
            println!("{name}: no surface");
            continue;
        };
        let surface = surface.known_whole();
        let moved = operand().offset(-depth);
        let inside = surface.point(0, [0.3, 0.3]);
        let (build, _) = timed(|| moved.value(inside));
        let side = plain.bounds().map_or(f64::NAN, |bounds| bounds.longest_side()) / 16.0;
        let blocks = in_blocks(&moved, &surface, depth, side);
        let [bulk, single] = scattered(&moved, &surface, depth);
        println!(
            "{name}: built in {build:.3} s; in blocks {blocks:.0} ns (allowed {allowed:.0}), scattered in bulk \
             {bulk:.0}, one by one {single:.0} (allowed 2000)"
        );
        let [first, second] = [0.2, 0.7].map(|u| {
            let p = surface.point(surface.len() / 2, [u, 0.2]) + DVec3::splat(2.0 * depth);
            1e3 * timed(|| moved.closest_surface_point(p)).0
        });
        println!("  nearest point: {first:.3} ms, then {second:.3} ms (allowed 1)");
        print_errors(&plain, &moved, &surface, depth, count);
    }
}
