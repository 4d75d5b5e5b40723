//! Regions of synthetic surfaces, and of real parts.

use std::path::Path;

use super::regions::{Form, Regions, detect};
use super::samples::Samples;
use crate::{Mesh, Run};

/// A real part, or a printed line.
fn part(name: &str) -> Option<Mesh> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/parts").join(name).with_extension("ply");
    if !path.exists() {
        println!("{} is missing: skipped", path.display());
        return None;
    }
    Some(Mesh::load(path).unwrap())
}

fn told(samples: &Samples, regions: &Regions) {
    let size = samples.size;
    for region in &regions.regions {
        let share = region.share;
        let count = region.points.len();
        match region.form {
            Form::Plane { normal, offset } => println!("  {share:.4} {count:4} plane {normal:.4} {:.4}", offset * size),
            Form::Cylinder { axis, origin, radius, along, arc } => println!(
                "  {share:.4} {count:4} cylinder {:+} d {:.5} axis {axis:.4} at {:.4} along {:.4} {:.4} arc {arc}",
                region.sign,
                2.0 * radius * size,
                origin * size,
                along[0] * size,
                along[1] * size
            ),
            Form::Cone { axis, origin, radius, slope, along, arc } => println!(
                "  {share:.4} {count:4} cone {:+} r {:.5} slope {slope:.4} axis {axis:.4} at {:.4} along {:.4} {:.4} arc {arc}",
                region.sign,
                radius * size,
                origin * size,
                along[0] * size,
                along[1] * size
            ),
            Form::Sphere { centre, radius } => {
                println!(
                    "  {share:.4} {count:4} sphere {:+} r {:.5} at {:.4}",
                    region.sign,
                    radius * size,
                    centre * size
                );
            }
            Form::Torus { axis, centre, major, minor } => println!(
                "  {share:.4} {count:4} torus {:+} R {:.5} r {:.5} axis {axis:.4} at {:.4}",
                region.sign,
                major * size,
                minor * size,
                centre * size
            ),
        }
    }
}

#[test]
fn tell_all_parts() {
    for name in [
        "unit_cube",
        "7_8ths_cube",
        "shaft",
        "round",
        "bushing_roller",
        "xtion_bracket",
        "camshaft",
        "angle_block",
        "satellite_mount",
        "lasercut_interface",
        "holder",
        "plate_holes",
        "machinist",
        "octagonal_pocket",
    ] {
        let Some(mesh) = part(name) else { return };
        let start = cpu_time::ThreadTime::now();
        let samples = Samples::of_mesh(&mesh, 1);
        let sampled = start.elapsed();
        let regions = detect(&samples, 1, &Run::default()).unwrap();
        let all: f64 = regions.regions.iter().map(|r| r.share).sum();
        println!(
            "{name}: {} samples {} corners {:?} noise {:.5}; {} regions, explained {all:.4}, {} frames; {:.1} + {:.1} ms",
            samples.len(),
            samples.corners.len(),
            samples.kind,
            samples.noise,
            regions.regions.len(),
            regions.frames.len(),
            1e3 * sampled.as_secs_f64(),
            1e3 * (start.elapsed() - sampled).as_secs_f64()
        );
        told(&samples, &regions);
    }
}
