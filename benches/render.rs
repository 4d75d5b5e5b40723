//! Pictures beside fidget's voxel renderer on the models M1 to M6.
//!
//! `cargo bench --bench render` prints milliseconds for the normal image at 512² and 1024²:
//! orthographic along z over the model's cube, one ray a pixel, distance, normal and owner. Our
//! first picture prepares the scene, the next one is of the same view; fidget's VM and JIT start each time
//! from a shape that is made already. Then come shaded perspective pictures, plain (one ray a
//! pixel, no shadows, no occlusion) and with all that is on by default. Every figure is the median
//! of several rounds in which the contestants alternate. The ratio is that of the faster of
//! fidget's two to our first picture.
//!
//! fidget is given each model lowered by `Solid::to_fidget` and, for M1 to M5, with as few
//! operations as it takes; the faster counts. M3 and M5 take it minutes, so that it draws them
//! once, at 512² only in the lean form; `all` after `--` draws them at every size.
//!
//! Rows are single pictures, seen as by [`Camera::framing_orthographic`], of what was once slow to
//! draw, and of every entry of the catalogue, beside fidget's VM on the same formula seen the same
//! way, where there is one. Of each there is one of another view of the same scene as well.
//!
//! Drafts are of what the examples show. The last rows are of thousands of balls cut out, with the
//! memory that they take.
//!
//! Words after `--` choose: `normals`, `shaded`, `prospero`, `many`, `rows`, `catalogue`, `drafts`,
//! `memory`, names of models, `512`, `1024`, `two` (threads), `quick` (fewer rounds), `ours` (without fidget), `vm`
//! (without its JIT), and after `=` a part of the names of rows.

#[path = "render/cut_out.rs"]
mod cut_out;
#[path = "render/drafts.rs"]
mod drafts;
#[path = "evaluate/lean.rs"]
mod lean;
#[path = "mesh/memory.rs"]
mod memory;
#[path = "../tests/it/models.rs"]
mod models;
#[path = "render/rows.rs"]
mod rows;
#[path = "../tests/it/workpieces.rs"]
mod workpieces;

use std::hint::black_box;
use std::time::Instant;

use cpu_time::ProcessTime;
use fidget::context::Tree;
use fidget::eval::{Function, MathFunction};
use fidget::render::{RenderHints, ThreadPool};
use fidget::shape::{BoundShape, Shape};
use fidget::vm::VmFunction;
use fidget_raster::{pixel, voxel};
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use rvachev::camera::{Projection, Window};
use rvachev::{Camera, PlaneBounds, Profile, RFunction, RenderSettings, Run, Scene, Solid, deg, layers::GBuffer};

use lean::lean;
use memory::{MEMORY, print_memory};
use models::Model;

/// What is asked for on the command line.
struct Choice(Vec<String>);

impl Choice {
    fn has(&self, word: &str) -> bool {
        self.0.iter().any(|w| w == word)
    }

    /// Whether one of several things is wanted: all are if none is named.
    fn wants(&self, word: &str, among: &[&str]) -> bool {
        self.has(word) || !among.iter().any(|other| self.has(other))
    }

    /// Whether rows of this name are wanted: all are if none is named.
    fn names(&self, name: &str) -> bool {
        let mut parts = self.0.iter().filter_map(|word| word.strip_prefix('=')).peekable();
        parts.peek().is_none() || parts.any(|part| name.contains(part))
    }

    fn sizes(&self) -> Vec<u32> {
        [512, 1024].into_iter().filter(|size| self.wants(&size.to_string(), &["512", "1024"])).collect()
    }

    fn rounds(&self) -> usize {
        if self.has("quick") { 3 } else { 7 }
    }

    fn threads(&self) -> Vec<usize> {
        if self.has("two") { vec![1, 2] } else { vec![1] }
    }
}

const PARTS: [&str; 8] = ["normals", "shaded", "prospero", "many", "rows", "catalogue", "drafts", "memory"];
const NAMES: [&str; 6] = ["M1", "M2", "M3", "M4", "M5", "M6"];

fn main() {
    let choice = Choice(std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect());
    if let [MEMORY, cut_out::CUT_OUT, rule, count, threads] =
        choice.0.iter().map(String::as_str).collect::<Vec<_>>()[..]
    {
        let [count, threads] = [count, threads].map(|number| number.parse().expect("a number"));
        return print_memory(threads, cut_out::job(rule, count));
    }
    if choice.wants("normals", &PARTS) {
        normals(&choice);
    }
    if choice.wants("shaded", &PARTS) {
        shaded(&choice);
    }
    if choice.wants("prospero", &PARTS) {
        prospero(&choice);
    }
    if choice.wants("many", &PARTS) {
        many(&choice);
    }
    if choice.wants("rows", &PARTS) {
        print_rows(&choice, rows::named());
    }
    if choice.wants("catalogue", &PARTS) {
        print_rows(&choice, rows::catalogued());
    }
    if choice.wants("drafts", &PARTS) {
        drafts::rows(|name| choice.names(name), choice.rounds());
    }
    if choice.wants("memory", &PARTS) {
        cut_out::rows();
    }
}

/// One contestant.
type Contestant<'a> = (&'static str, Box<dyn FnMut() + 'a>);

/// The median milliseconds of each: of processor time with one thread (other processes do not count
/// then), else of the clock.
fn race(rounds: usize, threads: usize, contestants: &mut [Contestant<'_>]) -> Vec<f64> {
    let mut times = vec![Vec::new(); contestants.len()];
    for _ in 0..rounds {
        for ((_, run), times) in contestants.iter_mut().zip(&mut times) {
            let (clock, processor) = (Instant::now(), ProcessTime::now());
            run();
            let spent = if threads > 1 { clock.elapsed() } else { processor.elapsed() };
            times.push(spent.as_secs_f64() * 1e3);
        }
    }
    times.into_iter().map(|mut times| median(&mut times)).collect()
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

fn least(contestants: &[Contestant<'_>], times: &[f64], name: &str) -> f64 {
    contestants.iter().zip(times).filter(|((n, _), _)| *n == name).map(|(_, t)| *t).fold(f64::INFINITY, f64::min)
}

/// What fidget sees of a model: along z, x to the right, y up.
fn along_z(half: f64) -> Camera {
    Camera::orthographic(DVec3::Z * 10.0 * half, DVec3::ZERO, DVec3::Y, 2.0 * half)
}

fn scene(solid: &Solid, run: &Run) -> Scene {
    solid.scene_with(run).expect("the model is valid")
}

fn picture(scene: &Scene, camera: &Camera, size: u32, run: &Run) -> GBuffer {
    let rays = camera.rays(size, size);
    scene.surfaces_with(&rays, Window::whole(size, size), run).expect("nobody cancels")
}

fn pool(threads: usize) -> Option<ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
    (threads > 1).then_some(ThreadPool::Custom(pool))
}

fn voxels<'a, F: MathFunction + Function + RenderHints + 'a>(
    name: &'static str,
    tree: &Tree,
    view: DAffine3,
    size: u32,
    threads: Option<&'a ThreadPool>,
) -> Contestant<'a> {
    let shape = BoundShape::try_from(Shape::<F>::from(tree.clone())).expect("the model has no variables");
    let mut config = voxel::RenderConfig::from_size(size.into());
    for (column, axis) in view.matrix3.to_cols_array_2d().into_iter().chain([view.translation.to_array()]).enumerate() {
        for (row, number) in axis.into_iter().enumerate() {
            config.world_to_model[(row, column)] = number as f32;
        }
    }
    let eval = voxel::EvalConfig { threads, ..voxel::EvalConfig::default() };
    let run = move || {
        black_box(voxel::render(shape.clone(), &config, &eval).expect("nobody cancels"));
    };
    (name, Box::new(run))
}

fn normals(choice: &Choice) {
    println!("normal image, orthographic, milliseconds; hits are the share of pixels\n");
    println!("model size threads    first     next   hits  fidget VM  fidget JIT   ratio");
    for model in models::all() {
        if !choice.wants(model.name, &NAMES) {
            continue;
        }
        for size in choice.sizes() {
            for threads in choice.threads() {
                compare(choice, &model, size, threads);
            }
        }
    }
    println!();
}

fn compare(choice: &Choice, model: &Model, size: u32, threads: usize) {
    let camera = along_z(model.half);
    let run = Run { threads, ..Run::default() };
    let kept = scene(&model.solid, &run);
    let seen = picture(&kept, &camera, size, &run);
    let hits = seen.surfaces().iter().filter(|s| s.is_hit()).count();
    let pool = pool(threads);
    let smooth = matches!(model.name, "M3" | "M5");
    let slow = smooth && !(choice.has("all") || (size == 512 && threads == 1));
    let mut ours: Vec<Contestant<'_>> = vec![
        ("first", Box::new(|| drop(black_box(picture(&scene(&model.solid, &run), &camera, size, &run))))),
        ("next", Box::new(|| drop(black_box(picture(&kept, &camera, size, &run))))),
    ];
    if !choice.has("ours") && !slow {
        let lowered = model.solid.to_fidget().expect("the model is valid");
        let trees = if smooth { vec![lean(model)] } else { vec![Some(lowered), lean(model)] };
        for tree in trees.into_iter().flatten() {
            ours.push(voxels::<VmFunction>(
                "VM",
                &tree,
                DAffine3::from_scale(DVec3::splat(model.half)),
                size,
                pool.as_ref(),
            ));
            // The JIT is slower than the VM on every one of these, and compiles M4 for minutes.
            #[cfg(feature = "jit")]
            if !(choice.has("vm") || matches!(model.name, "M3" | "M4" | "M5")) || choice.has("all") {
                ours.push(voxels::<fidget::jit::JitFunction>(
                    "JIT",
                    &tree,
                    DAffine3::from_scale(DVec3::splat(model.half)),
                    size,
                    pool.as_ref(),
                ));
            }
        }
    }
    let rounds = if smooth && ours.len() > 2 { 1 } else { choice.rounds() };
    let times = race(rounds, threads, &mut ours);
    let (vm, jit) = (least(&ours, &times, "VM"), least(&ours, &times, "JIT"));
    println!(
        "{:5} {size:4} {threads:7} {:8.1} {:8.1} {:6.3} {vm:10.1} {jit:11.1} {:7.1}",
        model.name,
        times[0],
        times[1],
        hits as f64 / f64::from(size * size),
        vm.min(jit) / times[0],
    );
}

fn shaded(choice: &Choice) {
    println!("shaded perspective picture, milliseconds\n\nmodel size threads  plain  plain, next  everything");
    for model in models::all() {
        if !choice.wants(model.name, &NAMES) {
            continue;
        }
        for size in choice.sizes() {
            for threads in choice.threads() {
                let run = Run { threads, ..Run::default() };
                let camera = Camera::framing(&model.solid.bounds().expect("the model is valid"));
                let full = RenderSettings { width: size, height: size, ..RenderSettings::default() };
                let plain = RenderSettings { samples: 1, shadows: false, occlusion: false, ..full.clone() };
                let kept = scene(&model.solid, &run);
                let mut all: Vec<Contestant<'_>> = vec![
                    ("plain", Box::new(|| drop(black_box(model.solid.render_with(&camera, &plain, &run))))),
                    ("next", Box::new(|| drop(black_box(kept.render_with(&camera, &plain, &run))))),
                    ("full", Box::new(|| drop(black_box(model.solid.render_with(&camera, &full, &run))))),
                ];
                let times = race(choice.rounds().min(5), threads, &mut all);
                println!("{:5} {size:4} {threads:7} {:6.1} {:12.1} {:11.1}", model.name, times[0], times[1], times[2]);
            }
        }
    }
    println!();
}

/// Text of 8000 operations in the plane, seen from above as a plate, beside fidget's picture of
/// the plane.
fn prospero(choice: &Choice) {
    let path = std::env::var("PROSPERO").unwrap_or_else(|_| "prospero.vm".to_string());
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("prospero: no file {path}; PROSPERO in the environment says where it is\n");
        return;
    };
    let (context, root) = fidget::Context::from_text(text.as_bytes()).expect("the file is a formula");
    let tree = context.export(root).expect("the root is of the context");
    let plate = Profile::formula(&tree, PlaneBounds { min: DVec2::NEG_ONE, max: DVec2::ONE }).extrude(0.1);
    let camera = along_z(1.0);
    println!("prospero, milliseconds\n\nsize threads    first     next  hits  fidget VM  fidget JIT   ratio");
    for size in choice.sizes() {
        for threads in choice.threads() {
            let run = Run { threads, ..Run::default() };
            let kept = scene(&plate, &run);
            let seen = picture(&kept, &camera, size, &run);
            let hits = seen.surfaces().iter().filter(|s| s.is_hit()).count();
            let pool = pool(threads);
            let mut all: Vec<Contestant<'_>> = vec![
                ("first", Box::new(|| drop(black_box(picture(&scene(&plate, &run), &camera, size, &run))))),
                ("next", Box::new(|| drop(black_box(picture(&kept, &camera, size, &run))))),
            ];
            if !choice.has("ours") {
                all.push(pixels::<VmFunction>("VM", &tree, size, pool.as_ref()));
            }
            #[cfg(feature = "jit")]
            if !(choice.has("vm") || choice.has("ours")) {
                all.push(pixels::<fidget::jit::JitFunction>("JIT", &tree, size, pool.as_ref()));
            }
            let times = race(choice.rounds(), threads, &mut all);
            let (vm, jit) = (least(&all, &times, "VM"), least(&all, &times, "JIT"));
            println!(
                "{size:4} {threads:7} {:8.1} {:8.1} {:5.3} {vm:10.1} {jit:11.1} {:7.2}",
                times[0],
                times[1],
                hits as f64 / f64::from(size * size),
                vm.min(jit) / times[0]
            );
        }
    }
    println!();
}

fn pixels<'a, F: MathFunction + Function + RenderHints + 'a>(
    name: &'static str,
    tree: &Tree,
    size: u32,
    threads: Option<&'a ThreadPool>,
) -> Contestant<'a> {
    let shape = BoundShape::try_from(Shape::<F>::from(tree.clone())).expect("the model has no variables");
    let config = pixel::RenderConfig::from_size(size.into());
    let eval = pixel::EvalConfig { threads, ..pixel::EvalConfig::default() };
    let run = move || {
        black_box(pixel::render(shape.clone(), &config, &eval).expect("nobody cancels"));
    };
    (name, Box::new(run))
}

/// Random superellipsoids that cover about the same share of the picture, however many.
fn random_cloud(count: usize) -> Solid {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    // As many layers in depth for any count: the cross-sections add up to the same area.
    let size = 0.9 / (count as f64).sqrt();
    let solids: Vec<Solid> = (0..count)
        .map(|_| {
            let axes = DVec3::new(0.6 + 0.6 * next(), 0.6 + 0.6 * next(), 0.6 + 0.6 * next()) * size;
            let (e1, e2) = (0.2 + 1.3 * next(), 0.2 + 1.3 * next());
            let turn = DQuat::from_euler(glam::EulerRot::XYZ, 6.3 * next(), 6.3 * next(), 6.3 * next());
            let place = DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 1.9;
            Solid::superellipsoid(axes, e1, e2).affine(DAffine3::from_rotation_translation(turn, place))
        })
        .collect();
    Solid::union_all(solids, RFunction::MIN_MAX)
}

fn many(choice: &Choice) {
    println!("many superellipsoids, 1024², one thread, milliseconds\n\ncount  compile    first     next   hits");
    let run = Run { threads: 1, ..Run::default() };
    let camera = along_z(1.05);
    for count in [100, 1000, 10_000] {
        let cloud = random_cloud(count);
        let start = Instant::now();
        cloud.bounds().expect("the model is valid");
        let compile = start.elapsed().as_secs_f64() * 1e3;
        let kept = scene(&cloud, &run);
        let seen = picture(&kept, &camera, 1024, &run);
        let hits = seen.surfaces().iter().filter(|s| s.is_hit()).count();
        let mut all: Vec<Contestant<'_>> = vec![
            ("first", Box::new(|| drop(black_box(picture(&scene(&cloud, &run), &camera, 1024, &run))))),
            ("next", Box::new(|| drop(black_box(picture(&kept, &camera, 1024, &run))))),
        ];
        let times = race(choice.rounds().min(5), 1, &mut all);
        println!(
            "{count:5} {compile:8.1} {:8.1} {:8.1} {:6.3}",
            times[0],
            times[1],
            hits as f64 / f64::from(1u32 << 20)
        );
    }
    println!();
}

/// From fidget's cube, seen along −z with y up, to what an orthographic camera sees.
fn view(camera: &Camera) -> DAffine3 {
    let Projection::Orthographic { height } = camera.projection else { unreachable!("the camera is orthographic") };
    let back = (camera.eye - camera.target).normalize();
    let right = camera.up.cross(back).normalize();
    let axes = DMat3::from_cols(right, back.cross(right), back);
    DAffine3::from_mat3_translation(0.5 * height * axes, camera.target)
}

/// Another view each time, as of a turntable.
fn turned(camera: &Camera, turns: &mut u32) -> Camera {
    *turns += 1;
    camera.orbit(deg(15.0 * f64::from(*turns)), deg(0.0))
}

fn print_rows(choice: &Choice, rows: Vec<rows::Row>) {
    println!("normal images of single solids, one thread, milliseconds; ratio of fidget's VM to our first\n");
    println!("{:28} size    first   turned     next   hits  fidget VM   ratio", "solid");
    let run = Run { threads: 1, ..Run::default() };
    for rows::Row { name, size, solid, has_peer } in rows {
        if !choice.names(&name) {
            continue;
        }
        let camera = Camera::framing_orthographic(&solid.bounds().expect("the solid is valid"));
        let [kept, turning] = [scene(&solid, &run), scene(&solid, &run)];
        drop(picture(&turning, &camera, size, &run));
        let mut turns = 0;
        let start = Instant::now();
        let seen = picture(&kept, &camera, size, &run);
        let is_slow = start.elapsed().as_secs_f64() > 0.5;
        let hits = seen.surfaces().iter().filter(|s| s.is_hit()).count();
        let mut all: Vec<Contestant<'_>> = vec![
            ("first", Box::new(|| drop(black_box(picture(&scene(&solid, &run), &camera, size, &run))))),
            ("turned", Box::new(|| drop(black_box(picture(&turning, &turned(&camera, &mut turns), size, &run))))),
            ("next", Box::new(|| drop(black_box(picture(&kept, &camera, size, &run))))),
        ];
        if has_peer
            && !choice.has("ours")
            && let Ok(tree) = solid.to_fidget()
        {
            all.push(voxels::<VmFunction>("VM", &tree, view(&camera), size, None));
        }
        let times = race(if is_slow { 1 } else { choice.rounds() }, 1, &mut all);
        let share = hits as f64 / f64::from(size * size);
        print!("{name:28} {size:4} {:8.1} {:8.1} {:8.2} {share:6.3}", times[0], times[1], times[2]);
        match times.get(3) {
            Some(vm) => println!(" {vm:10.1} {:7.2}", vm / times[0]),
            None => println!("          –"),
        }
    }
    println!();
}
