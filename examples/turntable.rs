//! A painted part turned once about: an animated GIF, with a progress bar; and a look into it.
//!
//! ```text
//! cargo run --release --example turntable -- out          out/turntable.gif and out/section.png
//! cargo run --release --example turntable -- out frames   and out/turntable_00.png and so on
//! cargo run --release --example turntable -- out draft    the same as drafts, from a mesh
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use rvachev::{
    Background, Camera, Image, Paint, Plane, Progress, Quality, RenderSettings, Run, Scene, Solid, View, deg, turns,
};

const FRAMES: u32 = 12;
const WIDTH: u32 = 200;
const HEIGHT: u32 = 150;

/// A valve: a body with two flanges, a bonnet blended onto it, bores cut by brass.
pub(crate) fn valve() -> Solid {
    let iron = Paint { color: [52, 84, 120], roughness: 0.45 };
    let brass = Paint { color: [214, 164, 72], roughness: 0.25 };
    let red = Paint { color: [186, 44, 36], roughness: 0.35 };
    let barrel = Solid::cylinder(7.0, 36.0).rotate_y(deg(90.0));
    let flange = |x: f64| {
        let holes = Solid::cylinder(1.3, 8.0).translate([9.0, 0.0, 0.0]).repeat_polar(6);
        (Solid::cylinder(12.0, 4.0) - holes).rotate_y(deg(90.0)).translate([x, 0.0, 0.0])
    };
    let body = Solid::sphere(10.5).smooth_union(barrel, 3.0).paint(iron);
    let flanges = (flange(-18.0) | flange(18.0)).paint(iron);
    let bonnet = Solid::cone(7.5, 4.0, 12.0).translate([0.0, 0.0, 11.0]).paint(brass);
    let stem = Solid::cylinder(1.6, 12.0).translate([0.0, 0.0, 20.0]).paint(brass);
    let spokes = Solid::capsule(0.8, 8.0).rotate_y(deg(90.0)).translate([4.0, 0.0, 0.0]).repeat_polar(5);
    let wheel = (Solid::torus(8.5, 1.3) | spokes | Solid::cylinder(2.2, 3.0)).translate([0.0, 0.0, 25.0]).paint(red);
    let bore = Solid::cylinder(4.6, 60.0).rotate_y(deg(90.0)).paint(brass);
    ((body.smooth_union(bonnet, 3.0) | flanges) - bore) | stem | wheel
}

/// Steps of the bar.
const STEPS: u64 = 1000;

fn frame(
    scene: &Scene,
    camera: &Camera,
    settings: &RenderSettings,
    (number, bar): (u32, &ProgressBar),
) -> Result<Image, Box<dyn Error>> {
    let part = |frame: u32| f64::from(frame) / f64::from(FRAMES);
    let (from, to) = (part(number), part(number + 1));
    // Each frame reports its own progress; the bar shows that of all.
    let bar = bar.clone();
    let report = move |f: f64| bar.set_position((STEPS as f64 * (from + (to - from) * f)) as u64);
    let run = Run { progress: Some(Progress::new(report)), ..Run::default() };
    let turned = camera.orbit(turns(from), deg(0.0));
    Ok(scene.render_with(&turned, settings, &run)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "target/examples".into()));
    let words: Vec<String> = arguments.collect();
    let [all, draft] = ["frames", "draft"].map(|word| words.iter().any(|other| other == word));
    std::fs::create_dir_all(&folder)?;

    let scene = valve().scene()?;
    let aspect = f64::from(WIDTH) / f64::from(HEIGHT);
    let camera =
        Camera::framing_view(&scene.bounds(), View::Front).orbit(deg(0.0), deg(24.0)).fitted(&scene.bounds(), aspect);
    let settings = RenderSettings {
        width: WIDTH,
        height: HEIGHT,
        samples: 2,
        // One ray to the light a pixel, none to the sky.
        softness: deg(0.0),
        occlusion: false,
        background: Background::Plain([244, 244, 245]),
        // The scene keeps the mesh of drafts from frame to frame.
        quality: if draft { Quality::Draft } else { Quality::Fine },
        ..RenderSettings::default()
    };
    // Drawn on a terminal only.
    let bar = ProgressBar::new(STEPS).with_style(ProgressStyle::with_template("[{bar:30}] {percent:3} %, {eta} left")?);
    let frames: Result<Vec<Image>, _> =
        (0..FRAMES).map(|number| frame(&scene, &camera, &settings, (number, &bar))).collect();
    let frames = frames?;
    bar.finish_and_clear();
    if all {
        for (number, frame) in frames.iter().enumerate() {
            frame.save(folder.join(format!("turntable_{number:02}.png")))?;
        }
    }
    let path = folder.join("turntable.gif");
    Image::save_animation(&frames, Duration::from_millis(70), &path)?;
    let cut = RenderSettings {
        width: 480,
        height: 360,
        cut: Some(Plane::xz(0.0)),
        quality: settings.quality,
        ..RenderSettings::default()
    };
    scene.render(&scene.framing(View::ThreeQuarter, aspect), &cut)?.save(folder.join("section.png"))?;
    println!("wrote {}: {FRAMES} frames in {:.1} s", path.display(), start.elapsed().as_secs_f64());
    Ok(())
}
