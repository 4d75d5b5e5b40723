//! Drafts of what the examples show, and of thin things: the time until there is a first frame, beside
//! a fine picture of the same size, and processor time of a frame once the mesh is there.

use std::hint::black_box;
use std::time::Instant;

use cpu_time::ProcessTime;
use rvachev::{Quality, RFunction, RenderSettings, Run, Solid, View, turns};

use crate::workpieces::{Workpiece, measured, plain};
use crate::{median, rows};

/// The processor's milliseconds that a frame may take.
const ALLOWED: f64 = 80.0;

/// The first frame may take so many times a fine picture.
const FIRST: f64 = 1.0;

/// What has walls, gaps or blades thinner than a cell.
fn thin() -> Vec<Workpiece> {
    let combs = [("comb of 20", 20), ("comb of 60", 60), ("comb of 200", 200)].map(|(name, teeth)| (name, comb(teeth)));
    let named = rows::named().into_iter();
    let supershapes = named.filter_map(|row| (row.name == "s2").then_some(("supershape s2", row.solid)));
    combs.into_iter().chain(supershapes).collect()
}

/// A comb of so many teeth, six tenths of their distance thick.
fn comb(teeth: u32) -> Solid {
    let pitch = 3.0 / f64::from(teeth);
    let tooth =
        |n: u32| Solid::cuboid([0.6 * pitch, 2.0, 1.0]).translate([(f64::from(n) + 0.5) * pitch - 1.5, 0.0, 0.0]);
    let back = Solid::cuboid([3.0, 0.3, 1.1]).translate([0.0, 1.0, 0.0]);
    Solid::union_all((0..teeth).map(tooth), RFunction::MIN_MAX) | back
}

/// Prints a row for each: shaded, in perspective, 960 × 540, on two threads, of a mesh of 64 cells.
pub fn rows(is_asked: impl Fn(&str) -> bool, rounds: usize) {
    println!("drafts of 64 cells, shaded, 960 x 540, two threads; milliseconds\n");
    println!("{:20} first, clock  fine, clock  triangles  frame, processor  frame, clock", "solid");
    let run = Run { threads: 2, ..Run::default() };
    let settings = RenderSettings { width: 960, height: 540, quality: Quality::Draft, ..RenderSettings::default() };
    let fine = RenderSettings { quality: Quality::Fine, ..settings.clone() };
    let (mut most, mut slowest) = (0.0f64, 0.0f64);
    for (name, solid) in plain().into_iter().chain(measured()).chain(thin()).filter(|(name, _)| is_asked(name)) {
        let scene = solid.scene_with(&run).expect("the solid is valid");
        let camera = scene.framing(View::ThreeQuarter, 16.0 / 9.0);
        let start = Instant::now();
        drop(scene.render_with(&camera, &settings, &run).expect("a picture"));
        let first = 1e3 * start.elapsed().as_secs_f64();
        let triangles = scene.draft_mesh(settings.draft_cells, &run).expect("it is kept").triangles().len();
        let start = Instant::now();
        drop(scene.render_with(&camera, &fine, &run).expect("a picture"));
        let beside = 1e3 * start.elapsed().as_secs_f64();
        let (mut processor, mut clock) = (Vec::new(), Vec::new());
        for round in 0..rounds {
            let turned = camera.orbit(turns(round as f64 / rounds as f64), turns(0.0));
            let (start, begun) = (Instant::now(), ProcessTime::now());
            drop(black_box(scene.render_with(&turned, &settings, &run).expect("a picture")));
            processor.push(1e3 * begun.elapsed().as_secs_f64());
            clock.push(1e3 * start.elapsed().as_secs_f64());
        }
        let (processor, clock) = (median(&mut processor), median(&mut clock));
        (most, slowest) = (most.max(processor), slowest.max(first / beside));
        println!("{name:20} {first:12.0} {beside:12.0} {triangles:10} {processor:17.1} {clock:13.1}");
    }
    println!("most {most:.1} of {ALLOWED} allowed; first frames at most {slowest:.2} of fine ones, allowed {FIRST}\n");
}
