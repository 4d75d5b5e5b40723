//! Extraction alone: samples given as an array.

use glam::DVec3;
use rvachev::{
    Run,
    volume::{Volume, VolumeSettings},
};

use crate::measure::measured;

const SIDE: usize = 257;

/// A value at a point.
type Shape<'a> = &'a dyn Fn(f32, f32, f32) -> f32;

/// Prints voxels and triangles a second on a sphere and a gyroid of 257³ samples.
pub fn rows() {
    let at = |i: usize| 2.0 * i as f32 / (SIDE - 1) as f32 - 1.0;
    let sphere = |x: f32, y: f32, z: f32| 0.8 - (x * x + y * y + z * z).sqrt();
    let wave = |x: f32| 25.0 * x;
    let gyroid = |x: f32, y: f32, z: f32| {
        let [x, y, z] = [x, y, z].map(wave);
        x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()
    };
    let shapes: [(&str, Shape); 2] = [("sphere", &sphere), ("gyroid", &gyroid)];
    for (name, f) in shapes {
        let samples: Vec<f32> =
            (0..SIDE.pow(3)).map(|n| f(at(n % SIDE), at(n / SIDE % SIDE), at(n / (SIDE * SIDE)))).collect();
        let volume = Volume::new(&samples, [SIDE; 3], DVec3::splat(-1.0), DVec3::splat(2.0 / (SIDE - 1) as f64))
            .expect("a volume");
        for threads in [1, 2] {
            for normals in [false, true] {
                let settings = VolumeSettings { normals, ..VolumeSettings::default() };
                let run = Run { threads, ..Run::default() };
                let (seconds, mesh) = measured(threads, || volume.mesh_with(&settings, &run).expect("a mesh"));
                let triangles = mesh.triangles().len();
                let voxels = samples.len() as f64 / seconds * 1e-6;
                let rate = triangles as f64 / seconds * 1e-6;
                let with = if normals { "with normals" } else { "" };
                println!(
                    "{name} {SIDE}³ {threads} {:8.4} s {triangles:9} {rate:7.1} Mtri/s {voxels:7.0} Mvoxel/s {with}",
                    seconds
                );
            }
        }
    }
}
