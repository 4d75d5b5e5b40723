//! Bulk evaluation beside fidget, one thread, on the models M1 to M6.
//!
//! `cargo bench --bench evaluate` prints millions of points a second: our field program (true
//! values), our surface program (min and max), fidget's VM and JIT on the same model and the
//! same random points, and our ratio to the faster of fidget's two. Every figure is the median
//! of several rounds; rounds of the contestants alternate, so that drift of the machine meets
//! all of them alike.
//!
//! fidget is given each model in two forms: lowered by `Solid::to_fidget`, with its guards, and,
//! for M1 to M5, written out with as few operations as its instruction set allows. The faster
//! counts.

#[path = "../tests/it/models.rs"]
mod models;

use std::hint::black_box;
use std::time::Instant;

use fidget::context::Tree;
use fidget::eval::{BulkEvaluator, Function, MathFunction};
use fidget::shape::{EzShape, Shape};
use fidget::types::Grad;
use fidget::vm::VmFunction;
use glam::DVec3;
use rvachev::{Bounds, Evaluator, Gradients, Program, Tape};

use models::Model;

/// Points are handed to fidget in slices of this length, which suits its VM.
const SLICE: usize = 512;

/// Rounds of which the median is taken.
const ROUNDS: usize = 9;

struct Points {
    single: [Vec<f32>; 3],
}

impl Points {
    fn random(count: usize, half: f64) -> Points {
        let mut state = 0x9e37_79b9_7f4a_7c15u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 40) as f64 / f64::from(1 << 24) * 2.0 - 1.0) * half
        };
        Points { single: std::array::from_fn(|_| (0..count).map(|_| next() as f32).collect()) }
    }

    fn len(&self) -> usize {
        self.single[0].len()
    }
}

/// One contestant: evaluates all points once.
type Contestant<'a> = (&'static str, Box<dyn FnMut() + 'a>);

fn program<'a>(name: &'static str, program: &Program, cube: &Bounds, points: &'a Points) -> Contestant<'a> {
    let tape = Tape::new(program, cube);
    let mut evaluator = Evaluator::new();
    let mut out = vec![0.0; points.len()];
    let [x, y, z] = &points.single;
    (name, Box::new(move || evaluator.values(&tape, x, y, z, black_box(&mut out))))
}

fn fidget_values<'a, F: MathFunction + Function + 'a>(
    name: &'static str,
    tree: &Tree,
    points: &'a Points,
) -> Contestant<'a>
where
    <F::FloatSliceEval as BulkEvaluator>::Tape: 'a,
    F::FloatSliceEval: 'a,
{
    let shape = Shape::<F>::from(tree.clone());
    let tape = shape.ez_float_slice_tape();
    let mut eval = Shape::<F>::new_float_slice_eval();
    let [x, y, z] = &points.single;
    let run = move || {
        for ((x, y), z) in x.chunks(SLICE).zip(y.chunks(SLICE)).zip(z.chunks(SLICE)) {
            black_box(eval.eval(&tape, x, y, z).expect("the model has no variables"));
        }
    };
    (name, Box::new(run))
}

fn fidget_gradients<'a, F: MathFunction + Function + 'a>(
    name: &'static str,
    tree: &Tree,
    points: &'a Points,
) -> Contestant<'a>
where
    <F::GradSliceEval as BulkEvaluator>::Tape: 'a,
    F::GradSliceEval: 'a,
{
    let shape = Shape::<F>::from(tree.clone());
    let tape = shape.ez_grad_slice_tape();
    let mut eval = Shape::<F>::new_grad_slice_eval();
    let seed = |axis: usize| -> Vec<Grad> {
        let unit = |i: usize| f32::from(u8::from(i == axis));
        points.single[axis].iter().map(|&v| Grad::new(v, unit(0), unit(1), unit(2))).collect()
    };
    let (x, y, z) = (seed(0), seed(1), seed(2));
    let run = move || {
        for ((x, y), z) in x.chunks(SLICE).zip(y.chunks(SLICE)).zip(z.chunks(SLICE)) {
            black_box(eval.eval(&tape, x, y, z).expect("the model has no variables"));
        }
    };
    (name, Box::new(run))
}

/// Median millions of points a second of each contestant.
fn race(points: usize, contestants: &mut [Contestant<'_>]) -> Vec<f64> {
    let mut times = vec![Vec::new(); contestants.len()];
    for round in 0..=ROUNDS {
        for ((_, run), times) in contestants.iter_mut().zip(&mut times) {
            // Short runs are repeated to a millisecond or so.
            let start = Instant::now();
            let mut repeats = 0u32;
            while repeats == 0 || (start.elapsed().as_secs_f64() < 2e-3 && repeats < 1000) {
                run();
                repeats += 1;
            }
            let time = start.elapsed().as_secs_f64() / f64::from(repeats);
            if round > 0 {
                times.push(time);
            }
        }
    }
    times
        .into_iter()
        .map(|mut times| {
            times.sort_by(f64::total_cmp);
            points as f64 / times[times.len() / 2] * 1e-6
        })
        .collect()
}

/// The model for fidget, negative inside, with as few operations as it takes.
fn lean(model: &Model) -> Option<Tree> {
    let set = models::set(model.name)?;
    let min = |v: DVec3| v.min_element() as f32;
    let solids: Vec<Tree> =
        set.solids.iter().map(|s| superellipsoid(s.semi_axes, s.exponents, &s.inverse(), min(s.semi_axes))).collect();
    let (united, subtracted) = solids.split_at(set.united);
    let smooth = matches!(model.name, "M3" | "M5");
    // Negative inside: a union is the minimum, and R_p with p = 2 is x + y − √(x² + y²).
    let or = |x: Tree, y: Tree| match smooth {
        true => x.clone() + y.clone() - (x.square() + y.square()).sqrt(),
        false => x.min(y),
    };
    let and = |x: Tree, y: Tree| match smooth {
        true => x.clone() + y.clone() + (x.square() + y.square()).sqrt(),
        false => x.max(y),
    };
    let balanced = |trees: &[Tree]| {
        let mut level = trees.to_vec();
        while level.len() > 1 {
            level = level.chunks(2).map(|pair| pair.iter().cloned().reduce(or).expect("one or two")).collect();
        }
        level.pop()
    };
    let union = balanced(united)?;
    Some(subtracted.iter().fold(union, |all, hole| and(all, -hole.clone())))
}

fn superellipsoid(a: DVec3, [e1, e2]: [f64; 2], to_local: &glam::DAffine3, size: f32) -> Tree {
    let (x, y, z) = Tree::axes();
    let rows = to_local.matrix3.transpose();
    let axis = |i: usize| {
        let (row, offset) = (rows.col(i), to_local.translation[i]);
        if row[i] == 1.0 && offset == 0.0 {
            return [x.clone(), y.clone(), z.clone()][i].clone();
        }
        x.clone() * row.x as f32 + y.clone() * row.y as f32 + z.clone() * row.z as f32 + offset as f32
    };
    // |t/a|^p, guarded against the logarithm of 0.
    let power = |t: Tree, p: f64| ((t.max(1e-30f32)).ln() * p as f32).exp();
    let term = |i: usize, p: f64| power((axis(i) * (1.0 / a[i]) as f32).abs(), p);
    let rho = term(0, 2.0 / e2) + term(1, 2.0 / e2);
    let gauge = power(power(rho, e2 / e1) + term(2, 2.0 / e1), 0.5 * e1);
    (gauge - 1.0) * size
}

fn main() {
    println!("Mpoint/s, one thread, medians of {ROUNDS} rounds; the ratios are to the faster of fidget's two\n");
    println!("model    field  surface  fidget VM  fidget JIT   field ratio  surface ratio");
    for model in models::all() {
        let large = matches!(model.name, "M4" | "M5");
        let points = Points::random(if large { 2048 } else { 16384 }, model.half);
        let field = model.solid.field_program().expect("the model is valid");
        let surface = model.solid.surface_program().expect("the model is valid");
        let lowered = model.solid.to_fidget().expect("the model is valid");
        let mut contestants = vec![
            program("field", &field, &model.cube(), &points),
            program("surface", &surface, &model.cube(), &points),
        ];
        for tree in [Some(lowered), lean(&model)].into_iter().flatten() {
            contestants.push(fidget_values::<VmFunction>("VM", &tree, &points));
            #[cfg(feature = "jit")]
            contestants.push(fidget_values::<fidget::jit::JitFunction>("JIT", &tree, &points));
        }
        let speeds = race(points.len(), &mut contestants);
        let (vm, jit) = (best(&contestants, &speeds, "VM"), best(&contestants, &speeds, "JIT"));
        let peer = vm.max(jit);
        println!(
            "{:5} {:8.1} {:8.1} {:10.2} {:11.2} {:13.1} {:14.1}",
            model.name,
            speeds[0],
            speeds[1],
            vm,
            jit,
            speeds[0] / peer,
            speeds[1] / peer
        );
    }
    gradients();
}

fn best(contestants: &[Contestant<'_>], speeds: &[f64], name: &str) -> f64 {
    contestants.iter().zip(speeds).filter(|((n, _), _)| *n == name).map(|(_, s)| *s).fold(0.0, f64::max)
}

fn gradients() {
    let model = models::m1();
    let points = Points::random(16384, model.half);
    let tape = Tape::new(&model.solid.field_program().expect("the model is valid"), &model.cube());
    let mut evaluator = Evaluator::new();
    let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; points.len()]);
    let [x, y, z] = &points.single;
    let ours = move || {
        let [value, dx, dy, dz] = &mut out;
        evaluator.gradients(&tape, x, y, z, Gradients { value, dx, dy, dz });
        black_box(&out);
    };
    let mut contestants: Vec<Contestant<'_>> = vec![("gradients", Box::new(ours))];
    for tree in [model.solid.to_fidget().ok(), lean(&model)].into_iter().flatten() {
        contestants.push(fidget_gradients::<VmFunction>("VM", &tree, &points));
        #[cfg(feature = "jit")]
        contestants.push(fidget_gradients::<fidget::jit::JitFunction>("JIT", &tree, &points));
    }
    let speeds = race(points.len(), &mut contestants);
    let (vm, jit) = (best(&contestants, &speeds, "VM"), best(&contestants, &speeds, "JIT"));
    println!(
        "\nvalue and gradient on M1: ours {:.1}, fidget VM {vm:.2}, JIT {jit:.2}; ratio {:.1}",
        speeds[0],
        speeds[0] / vm.max(jit)
    );
}
