//! Thousands of balls cut from a cube: how long a small picture takes, and how much memory.

use std::time::Instant;

use glam::DVec3;
use rvachev::{Camera, RFunction, RenderSettings, Run, Scene, Solid};

use crate::memory::memory_apart;

/// What the memory of a row is asked for by, beside its rule and its number of balls.
pub const CUT_OUT: &str = "cut out";

const RULES: [(&str, RFunction); 2] = [("min/max", RFunction::MIN_MAX), ("P(2)", RFunction::P(2.0))];

/// What draws a row: gives the scene and the seconds of the clock.
pub fn job(rule: &str, count: usize) -> impl FnMut() -> (Scene, f64) + Send {
    let rule = RULES.iter().find(|(name, _)| *name == rule).map_or(RFunction::MIN_MAX, |(_, rule)| *rule);
    move || {
        let start = Instant::now();
        let run = Run { threads: 1, ..Run::default() };
        let ball = |i: usize| {
            let place = (DVec3::new(0.731, 1.317, 2.113) * i as f64).to_array().map(f64::sin);
            Solid::sphere(0.15).translate(place)
        };
        let solid = Solid::cuboid([2.0; 3]).difference(Solid::union_all((0..count).map(ball), rule), rule);
        let scene = solid.scene_with(&run).expect("the solid is valid");
        let settings = RenderSettings { width: 160, height: 120, ..RenderSettings::default() };
        scene.render_with(&Camera::framing(&scene.bounds()), &settings, &run).expect("a picture");
        (scene, start.elapsed().as_secs_f64())
    }
}

/// Prints the rows.
pub fn rows() {
    println!("balls of .15 cut from a cube of 2, studio picture 160 x 120, one thread\n");
    println!("rule     count  seconds  MB at most   of the scene's cells  times those of half");
    for (rule, _) in RULES {
        let mut last = f64::NAN;
        for count in [1250, 2500, 5000, 10_000] {
            let (scene, seconds) = job(rule, count)();
            let cells = scene.memory() as f64 / f64::from(1 << 20);
            drop(scene);
            let most = memory_apart([CUT_OUT, rule, &count.to_string(), "1"]);
            println!("{rule:8} {count:5} {seconds:8.2} {most:11.1} {cells:22.1} {:20.2}", most / last);
            last = most;
        }
    }
    println!();
}
