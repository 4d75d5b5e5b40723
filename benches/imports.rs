//! Meshes as solids: what they take to be made, and to be asked.
//!
//! `cargo bench --bench imports` prints for bumpy balls of .1, .3 and 1 million triangles, on one
//! thread and in seconds of the processor: how long the leaf takes to be made, its bytes a
//! triangle, nanoseconds a point of values in single precision in blocks of 8³ points near the
//! surface and over all of the box, as meshes ask for them: sides, and distances next to the
//! surface; of all distances near the surface; and of single points in double precision. Then how
//! fast files are read.
//!
//! Words after `--` choose sizes by their names. `save` writes the meshes and the points near them
//! for other programs: `target/imports-NAME.ply` and `.xyz`.

use std::fs;
use std::hint::black_box;

use cpu_time::ThreadTime;
use glam::{DVec3, Vec3};
use rvachev::io::{FileFormat, LoadSettings, write_glb, write_obj, write_ply, write_stl};
use rvachev::{Mesh, Run, SaveSettings};
use rvachev_field::kernel::CHUNK;
use rvachev_field::{AnyField, Chunk, MeshLeaf, Placement};

const SIZES: [(&str, u32); 3] = [("100k", 112), ("330k", 203), ("1M", 354)];

/// Points along a side of a block.
const SIDE: usize = 8;

/// A ball with bumps, of eight times n² triangles.
fn ball(n: u32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| if face >> axis & 1 == 1 { -1.0 } else { 1.0 });
        let first = positions.len() as u32;
        for i in 0..=n {
            for j in 0..=n - i {
                let [a, b, c] = [i, j, n - i - j].map(f64::from);
                let way = DVec3::new(x * a, y * b, z * c).normalize();
                let bumps = (9.0 * way.x).sin() * (8.0 * way.y).sin() * (7.0 * way.z).sin();
                positions.push(((1.0 + 0.1 * bumps) * way).as_vec3());
            }
        }
        // Row i has n + 1 − i vertices.
        let at = |i: u32, j: u32| first + i * (n + 1) - i * (i.max(1) - 1) / 2 + j;
        let is_odd = x * y * z < 0.0;
        for i in 0..n {
            for j in 0..n - i {
                let mut push = |[a, b, c]: [u32; 3]| triangles.push(if is_odd { [a, c, b] } else { [a, b, c] });
                push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if j + 1 < n - i {
                    push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    Mesh::new(positions, triangles).expect("indices are in range")
}

/// Columns of points in blocks of 8³, whose spacing is `cell`, about given places.
fn blocks(places: impl Iterator<Item = Vec3>, cell: f32) -> [Vec<f32>; 3] {
    let mut columns = [const { Vec::new() }; 3];
    for place in places {
        for k in 0..SIDE.pow(3) {
            let step = Vec3::new((k % SIDE) as f32, (k / SIDE % SIDE) as f32, (k / SIDE / SIDE) as f32);
            let p = place + cell * (step - 0.5 * (SIDE - 1) as f32);
            columns.iter_mut().zip(p.to_array()).for_each(|(column, x)| column.push(x));
        }
    }
    columns
}

/// Nanoseconds a point: the median of five rounds.
fn per_point(count: usize, mut work: impl FnMut()) -> f64 {
    let mut rounds: Vec<f64> = (0..5)
        .map(|_| {
            let start = ThreadTime::now();
            work();
            start.elapsed().as_secs_f64() * 1e9 / count as f64
        })
        .collect();
    rounds.sort_by(f64::total_cmp);
    rounds[2]
}

fn values(leaf: &dyn AnyField, columns: &[Vec<f32>; 3], band: f64) -> f64 {
    let count = columns[0].len();
    let mut out = [0.0; CHUNK];
    per_point(count, || {
        for at in (0..count).step_by(CHUNK) {
            let points = columns.each_ref().map(|column| &column[at..at + CHUNK]);
            leaf.lanes32_within(Chunk { points, placement: &Placement::IDENTITY, out: [&mut out] }, band);
            black_box(&out);
        }
    })
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let is_chosen = |name: &str| words.iter().all(|word| word == "save") || words.iter().any(|word| word == name);
    println!(
        "{:>6} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "", "triangles", "made, s", "bytes", "near", "box", "distance", "single"
    );
    for (name, n) in SIZES.into_iter().filter(|(name, _)| is_chosen(name)) {
        let mesh = ball(n);
        let start = ThreadTime::now();
        let run = Run::default();
        let leaf = MeshLeaf::new(mesh.positions(), mesh.triangles(), None, None, &run).expect("nobody has the token");
        let made = start.elapsed().as_secs_f64();
        let bytes = leaf.bytes() as f64 / leaf.len() as f64;
        let cell = 2.0 / n as f32;
        let step = mesh.positions().len() / 128;
        let near = blocks(mesh.positions().iter().step_by(step).copied().take(128), cell);
        let spread = |k: usize| Vec3::new((k * 37 % 64) as f32, (k * 23 % 64) as f32, k as f32) / 32.0 - 1.0;
        let all = blocks((0..64).map(spread), cell);
        let single = per_point(near[0].len() / 8, || {
            for at in (0..near[0].len()).step_by(8) {
                black_box(leaf.value([near[0][at], near[1][at], near[2][at]].map(f64::from)));
            }
        });
        let (near_ns, all_ns) = (values(&leaf, &near, 0.0), values(&leaf, &all, 0.0));
        let distances = values(&leaf, &near, f64::INFINITY);
        println!(
            "{name:>6} {:>10} {made:>8.2} {bytes:>8.0} {near_ns:>8.0} {all_ns:>8.0} {distances:>8.0} {single:>8.0}",
            mesh.triangles().len()
        );
        if words.iter().any(|word| word == "save") {
            mesh.save(format!("target/imports-{name}.ply")).expect("the folder is there");
            let rows: Vec<String> =
                (0..near[0].len()).map(|i| format!("{} {} {}\n", near[0][i], near[1][i], near[2][i])).collect();
            fs::write(format!("target/imports-{name}.xyz"), rows.concat()).expect("the folder is there");
        }
    }
    read();
}

/// Reading, in millions of triangles a second.
fn read() {
    let mesh = ball(112);
    let settings = SaveSettings::default();
    let mut files = [
        (FileFormat::Stl, Vec::new()),
        (FileFormat::Obj, Vec::new()),
        (FileFormat::Ply, Vec::new()),
        (FileFormat::Glb, Vec::new()),
    ];
    write_stl(&mesh, &mut files[0].1).expect("a vector takes everything");
    write_obj(&mesh, &settings, &mut files[1].1).expect("a vector takes everything");
    write_ply(&mesh, &mut files[2].1).expect("a vector takes everything");
    write_glb(&mesh, &settings, &mut files[3].1).expect("a vector takes everything");
    for (format, bytes) in files {
        let start = ThreadTime::now();
        black_box(Mesh::read(format, &bytes[..], &LoadSettings::default()).expect("what was written can be read"));
        let rate = mesh.triangles().len() as f64 / start.elapsed().as_secs_f64() / 1e6;
        println!("{format:?}: {rate:.1} million triangles a second");
    }
}
