//! Bulk evaluation beside fidget, one thread, on the models M1 to M6.
//!
//! `cargo bench --bench evaluate` prints millions of points a second: our field program (true
//! values), our surface program (min and max), fidget's VM and JIT on the same model and the
//! same random points, and our ratio to the faster of fidget's two. Every figure is the median
//! of the runs of several rounds; rounds of the contestants alternate, so that drift of the machine
//! meets all of them alike.
//!
//! fidget is given each model in two forms: lowered by `Solid::to_fidget`, with its guards, and,
//! for M1 to M5, written out with as few operations as its instruction set allows. The faster
//! counts.
//!
//! Then come a row for every leaf, profile, join, blend and map, a polygon of 5000 edges, and
//! formulas as leaves. Words after `--` choose: `models`, `gradients`, `catalogue`, `polygons`,
//! `formulas`, or parts of the names of the catalogue's rows.

#[path = "evaluate/catalogue.rs"]
mod catalogue;
#[path = "evaluate/lean.rs"]
mod lean;
#[path = "../tests/it/models.rs"]
mod models;
#[path = "evaluate/polygons.rs"]
mod polygons;

use std::hint::black_box;
use std::time::Instant;

use fidget::context::Tree;
use fidget::eval::{BulkEvaluator, Function, MathFunction};
use fidget::shape::{EzShape, Shape};
use fidget::types::Grad;
use fidget::vm::VmFunction;
use glam::DVec3;
use rvachev::{
    Bounds, Formula, Solid,
    program::{Evaluator, Gradients, Program, Tape},
};

use lean::lean;

/// Points are handed to fidget in slices of this length, which suits its VM.
const SLICE: usize = 512;

/// Rounds of which the median is taken.
const ROUNDS: usize = 9;

/// Seconds of a contestant's turn, at least; as many runs as fit are timed.
const TURN: f64 = 2e-3;

struct Points {
    single: [Vec<f32>; 3],
}

impl Points {
    /// Points of the box with these half-extents about the origin.
    fn random(count: usize, half: DVec3) -> Points {
        let mut state = 0x9e37_79b9_7f4a_7c15u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24) * 2.0 - 1.0
        };
        let mut axis = |half: f64| (0..count).map(|_| (next() * half) as f32).collect();
        Points { single: [axis(half.x), axis(half.y), axis(half.z)] }
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
    (name, Box::new(move || evaluator.values(&tape, x, y, z, black_box(&mut out)).unwrap()))
}

fn fidget_values<'a, F: MathFunction + Function + 'a>(
    name: &'static str,
    tree: &Tree,
    slice: usize,
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
        for ((x, y), z) in x.chunks(slice).zip(y.chunks(slice)).zip(z.chunks(slice)) {
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
///
/// Runs are timed one by one: those that another process interrupts are then few, and the
/// median does not see them.
fn race(points: usize, contestants: &mut [Contestant<'_>]) -> Vec<f64> {
    let mut times = vec![Vec::new(); contestants.len()];
    for round in 0..=ROUNDS {
        for ((_, run), times) in contestants.iter_mut().zip(&mut times) {
            let mut spent = 0.0;
            while spent < TURN {
                let start = Instant::now();
                run();
                let time = start.elapsed().as_secs_f64();
                spent += time;
                if round > 0 {
                    times.push(time);
                }
            }
        }
    }
    times.into_iter().map(|mut times| points as f64 / median(&mut times) * 1e-6).collect()
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The parts of the bench.
const PARTS: [&str; 5] = ["models", "gradients", "catalogue", "polygons", "formulas"];

fn main() {
    // Cargo passes `--bench`.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let (parts, rows): (Vec<String>, Vec<String>) = words.into_iter().partition(|word| PARTS.contains(&&**word));
    let all = parts.is_empty() && rows.is_empty();
    let wanted = |part: &str| all || parts.iter().any(|word| word == part);
    if wanted("models") {
        compare_models();
    }
    if wanted("gradients") {
        gradients();
    }
    if wanted("catalogue") {
        catalogue::print(&[]);
    } else if !rows.is_empty() {
        catalogue::print(&rows);
    }
    if wanted("polygons") {
        polygons::print();
    }
    if wanted("formulas") {
        formulas();
    }
}

fn compare_models() {
    println!("Mpoint/s, one thread, medians of {ROUNDS} rounds; the ratios are to the faster of fidget's two\n");
    println!("model    field  surface  fidget VM  fidget JIT   field ratio  surface ratio");
    for model in models::all() {
        let large = matches!(model.name, "M4" | "M5");
        let points = Points::random(if large { 2048 } else { 16384 }, DVec3::splat(model.half));
        let field = model.solid.field_program().expect("the model is valid");
        let surface = model.solid.surface_program().expect("the model is valid");
        let lowered = model.solid.to_fidget().expect("the model is valid");
        let mut contestants = vec![
            program("field", &field, &model.cube(), &points),
            program("surface", &surface, &model.cube(), &points),
        ];
        for tree in [Some(lowered), lean(&model)].into_iter().flatten() {
            contestants.push(fidget_values::<VmFunction>("VM", &tree, SLICE, &points));
            #[cfg(feature = "jit")]
            contestants.push(fidget_values::<fidget::jit::JitFunction>("JIT", &tree, SLICE, &points));
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
}

fn best(contestants: &[Contestant<'_>], speeds: &[f64], name: &str) -> f64 {
    contestants.iter().zip(speeds).filter(|((n, _), _)| *n == name).map(|(_, s)| *s).fold(0.0, f64::max)
}

fn gradients() {
    let model = models::m1();
    let points = Points::random(16384, DVec3::splat(model.half));
    let tape = Tape::new(&model.solid.field_program().expect("the model is valid"), &model.cube());
    let mut evaluator = Evaluator::new();
    let mut out: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; points.len()]);
    let [x, y, z] = &points.single;
    let ours = move || {
        let [value, dx, dy, dz] = &mut out;
        evaluator.gradients(&tape, x, y, z, Gradients { value, dx, dy, dz }).unwrap();
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

/// A text that calls for library functions at every point: the gyroid.
const GYROID: &str = "x var-x\ny var-y\nz var-z\nsx sin x\nsy sin y\nsz sin z\ncx cos x\ncy cos y\ncz cos z\n\
                      a mul sx cy\nb mul sy cz\nc mul sz cx\nab add a b\nout add ab c\n";

/// One of exponentials and a logarithm: three spheres melted together.
const BLOBS: &str = "x var-x\ny var-y\nz var-z\nh const 0.5\nm const -4\nyy square y\nzz square z\nw add yy zz\n\
                     xa sub x h\nxb add x h\na square xa\nb square xb\nzc sub z h\nc square zc\nxx square x\nxy add xx yy\n\
                     ra add a w\nrb add b w\nrc add xy c\nma mul ra m\nmb mul rb m\nmc mul rc m\n\
                     ea exp ma\neb exp mb\nec exp mc\ns add ea eb\nt add s ec\nl ln t\nout div l m\n";

/// Slices that fidget is given formulas in: as long as our chunks, and longer.
const SLICES: [usize; 3] = [256, 512, 4096];

/// Formulas as leaves beside fidget alone, whole (not narrowed).
fn formulas() {
    println!("\nformula         ours  interpreted   VM 256  best VM  JIT 256  best JIT   ratio at 256  ratio to best");
    let read = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
        let text = std::fs::read_to_string(&path).ok();
        if text.is_none() {
            println!("skipped: {} is not there", path.display());
        }
        text
    };
    for (name, text, half) in [
        ("colonnade.vm", read("colonnade.vm"), 1.0),
        ("prospero.vm", read("prospero.vm"), 1.0),
        ("gyroid", Some(GYROID.to_string()), 4.0),
        ("blobs", Some(BLOBS.to_string()), 1.5),
    ] {
        let Some(text) = text else { continue };
        let points = Points::random(if name == "prospero.vm" { 4096 } else { 16384 }, DVec3::splat(half));
        let formula = Formula::from_vm(&text, Bounds::ALL).expect("a sound file");
        let tree = formula.tree();
        let ours = Solid::from(formula).field_program().expect("the formula is valid");
        let cube = Bounds::new(DVec3::splat(-half), DVec3::splat(half));
        let mut contestants = vec![program("ours", &ours, &cube, &points)];
        let slow = Solid::from(interpreted(&text)).field_program().expect("the formula is valid");
        contestants.push(program("interpreted", &slow, &cube, &points));
        for (i, slice) in SLICES.into_iter().enumerate() {
            contestants.push(fidget_values::<VmFunction>(["VM 256", "VM", "VM"][i], &tree, slice, &points));
            #[cfg(feature = "jit")]
            contestants.push(fidget_values::<fidget::jit::JitFunction>(
                ["JIT 256", "JIT", "JIT"][i],
                &tree,
                slice,
                &points,
            ));
        }
        let speeds = race(points.len(), &mut contestants);
        let best = |name: &str| best(&contestants, &speeds, name);
        let (vm, jit) = (best("VM 256"), best("JIT 256"));
        let (best_vm, best_jit) = (best("VM").max(vm), best("JIT").max(jit));
        println!(
            "{name:12} {:7.2} {:12.2} {vm:8.2} {best_vm:8.2} {jit:8.2} {best_jit:9.2} {:14.2} {:14.2}",
            speeds[0],
            speeds[1],
            speeds[0] / vm.max(jit),
            speeds[0] / best_vm.max(best_jit)
        );
    }
    for name in ["colonnade.vm", "prospero.vm"] {
        if let Some(text) = read(name) {
            walks(name, &text);
        }
    }
}

/// The formula with a sine that never decides: it is not compiled to native code.
fn interpreted(text: &str) -> Formula {
    let root = text.lines().rev().find_map(|line| line.split_whitespace().next()).expect("a sound file");
    let tail = format!("\n.x var-x\n.sin sin .x\n.far const 1e6\n.low sub .sin .far\n.out max {root} .low\n");
    Formula::from_vm(&(text.to_string() + &tail), Bounds::ALL).expect("a sound file")
}

/// What a range over a small box costs: a walk over all operations in interval arithmetic.
fn walks(name: &str, text: &str) {
    let formula = Formula::from_vm(text, Bounds::ALL).expect("a sound file");
    let operations = formula.len();
    let program = Solid::from(formula).field_program().expect("the formula is valid");
    let corners = Points::random(256, DVec3::ONE);
    let start = Instant::now();
    for i in 0..256 {
        let corner = DVec3::from_array([0, 1, 2].map(|axis| f64::from(corners.single[axis][i])));
        black_box(program.range(&Bounds::new(corner, corner + DVec3::splat(0.05))));
    }
    let time = start.elapsed().as_secs_f64() / 256.0;
    println!(
        "range of {name} over a small box: {:.1} us, {:.2} ns an operation",
        1e6 * time,
        1e9 * time / operations as f64
    );
}
