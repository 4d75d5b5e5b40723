//! Drafts of what the examples show: processor time of a frame once the mesh is there.

use std::hint::black_box;
use std::time::Instant;

use cpu_time::ProcessTime;
use rvachev::{Quality, RenderSettings, Run, View, turns};

use crate::median;
use crate::workpieces::{measured, plain};

/// The processor's milliseconds that a frame may take.
const ALLOWED: f64 = 80.0;

/// Prints a row for each: shaded, in perspective, 960 × 540, on two threads, of a mesh of 64 cells.
pub fn rows(is_asked: impl Fn(&str) -> bool, rounds: usize) {
    println!("drafts of 64 cells, shaded, 960 x 540, two threads; milliseconds\n");
    println!("{:20} first, clock  frame, processor  frame, clock", "solid");
    let run = Run { threads: 2, ..Run::default() };
    let settings = RenderSettings { width: 960, height: 540, quality: Quality::Draft, ..RenderSettings::default() };
    let mut most = 0.0f64;
    for (name, solid) in plain().into_iter().chain(measured()).filter(|(name, _)| is_asked(name)) {
        let scene = solid.scene_with(&run).expect("the solid is valid");
        let camera = scene.framing(View::ThreeQuarter, 16.0 / 9.0);
        let start = Instant::now();
        drop(scene.render_with(&camera, &settings, &run).expect("a picture"));
        let first = 1e3 * start.elapsed().as_secs_f64();
        let (mut processor, mut clock) = (Vec::new(), Vec::new());
        for round in 0..rounds {
            let turned = camera.orbit(turns(round as f64 / rounds as f64), turns(0.0));
            let (start, begun) = (Instant::now(), ProcessTime::now());
            drop(black_box(scene.render_with(&turned, &settings, &run).expect("a picture")));
            processor.push(1e3 * begun.elapsed().as_secs_f64());
            clock.push(1e3 * start.elapsed().as_secs_f64());
        }
        let (processor, clock) = (median(&mut processor), median(&mut clock));
        most = most.max(processor);
        println!("{name:20} {:12.0} {processor:17.1} {clock:13.1}", first);
    }
    println!("most {most:.1} of {ALLOWED} allowed\n");
}
