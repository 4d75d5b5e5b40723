//! The extractor on surfaces that are known in closed form, and on noise.

use super::*;
use crate::Progress;
use crate::mesh::feature::Crease;
use crate::mesh::loops::CellLoop;
use crate::mesh::signs::BLOCK;
use crate::mesh::{CellSize, MeshReport};
use glam::DVec3;
use rvachev_num::Bounds;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// A formula, its roots found by bisection.
struct Analytic<'a, F> {
    f: F,
    lattice: &'a Lattice,
}

impl<F: Fn(DVec3) -> f64> Analytic<'_, F> {
    fn node(&self, block: [u32; 3], node: [usize; 3]) -> DVec3 {
        let [i, j, k] = std::array::from_fn(|axis| block[axis] + node[axis] as u32);
        self.lattice.node(i, j, k)
    }

    fn normal(&self, p: DVec3) -> DVec3 {
        let h = 1e-3 * self.lattice.step();
        let along = |d: DVec3| (self.f)(p - d * h) - (self.f)(p + d * h);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)).normalize_or_zero()
    }
}

impl<F: Fn(DVec3) -> f64 + Sync> Sampler for Analytic<'_, F> {
    type Scratch = ();

    fn scratch(&self) {}

    fn nodes(&self, (): &mut (), _: usize, block: [u32; 3], out: &mut [f32; NODES]) {
        for (n, value) in out.iter_mut().enumerate() {
            let node = [n % 9, n / 9 % 9, n / 81];
            *value = (self.f)(self.node(block, node)) as f32;
        }
    }

    fn roots(&self, (): &mut (), edges: &[EdgeRef], out: &mut [Root]) {
        for (edge, root) in edges.iter().zip(out) {
            let base = self.node(edge.node, [0; 3]);
            let mut along = DVec3::ZERO;
            along[usize::from(edge.axis)] = self.lattice.step();
            assert_eq!((self.f)(base) as f32 > 0.0, edge.leaves);
            assert_eq!((self.f)(base + along) as f32 > 0.0, !edge.leaves);
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if ((self.f)(base + along * middle) > 0.0) == edge.leaves {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            root.t = low;
            root.normal = self.normal(base + along * low).as_vec3().to_array();
        }
    }
}

/// All blocks of a lattice that have nodes of both signs, in order.
fn surface_blocks<S: Sampler>(sampler: &S, lattice: &Lattice) -> Vec<[u32; 3]> {
    let [x, y, z] = lattice.cells().map(|n| n.div_ceil(BLOCK as u32));
    let mut scratch = sampler.scratch();
    let mut values = [0.0; NODES];
    let mut blocks = Vec::new();
    for n in 0..x * y * z {
        let block = [n % x, n / x % y, n / (x * y)].map(|i| i * BLOCK as u32);
        sampler.nodes(&mut scratch, n as usize, block, &mut values);
        let inside = values.iter().filter(|&&v| v > 0.0).count();
        if inside != 0 && inside != NODES {
            blocks.push(block);
        }
    }
    blocks
}

fn mesh_of(bounds: &Bounds, cell: CellSize, f: impl Fn(DVec3) -> f64 + Sync) -> (Mesh, MeshReport) {
    let lattice = &Lattice::new(bounds, cell).unwrap();
    let sampler = Analytic { f, lattice };
    let blocks = surface_blocks(&sampler, lattice);
    let mesh = extract(&sampler, lattice, &blocks, Features::Smooth, &Run::default()).unwrap();
    let report = mesh.check();
    assert!(report.is_closed() && report.is_manifold(), "{report:?}");
    assert_eq!(report.duplicate_vertices + report.unused_vertices, 0);
    (mesh, report)
}

fn cube(half: f64) -> Bounds {
    Bounds::from_center(DVec3::ZERO, DVec3::splat(half))
}

fn sphere(p: DVec3) -> f64 {
    1.0 - p.length()
}

#[test]
fn a_sphere_converges_with_the_square_of_the_cell() {
    let exact = 4.0 / 3.0 * PI;
    let error = |cells| {
        let (mesh, report) = mesh_of(&cube(1.25), CellSize::LongestSide(cells), sphere);
        assert_eq!((report.shells, report.euler_characteristic), (1, 2));
        for (p, n) in mesh.positions().iter().zip(mesh.normals().unwrap()) {
            // Clamped vertices excepted, which are off by a 1000th of a cell.
            let step = 2.5 / f64::from(cells);
            assert!((p.as_dvec3().length() - 1.0).abs() < 1e-3 * step);
            assert!(p.normalize().distance(*n) < 1e-3);
        }
        exact - report.volume
    };
    let (coarse, fine) = (error(64), error(128));
    assert!(fine > 0.0 && fine < 2.5e-4 * exact, "{}", fine / exact);
    assert!((coarse / fine - 4.0).abs() < 0.3, "{}", coarse / fine);
}

#[test]
fn a_torus_has_a_handle() {
    let torus = |p: DVec3| 0.3 - (p.truncate().length() - 1.0).hypot(p.z);
    let (_, report) = mesh_of(&cube(1.4), CellSize::Length(0.05), torus);
    assert_eq!((report.shells, report.genus), (1, Some(1)));
    let exact = 2.0 * PI * PI * 0.09;
    assert!((report.volume / exact - 1.0).abs() < 0.01);
}

#[test]
fn faces_on_round_coordinates() {
    let cuboid = |p: DVec3| (DVec3::new(1.0, 0.5, 0.25) - p.abs()).min_element();
    let (mesh, report) = mesh_of(&cube(1.0), CellSize::LongestSide(64), cuboid);
    assert_eq!((report.shells, report.euler_characteristic), (1, 2));
    assert!((report.volume - 1.0).abs() < 0.01);
    // Away from the edges every vertex is on a face, to the last bit.
    let near = |x: f32, face: f32| (x.abs() - face).abs() < 1e-6;
    for p in mesh.positions() {
        assert!(near(p.x, 1.0) || near(p.y, 0.5) || near(p.z, 0.25), "{p}");
    }
}

#[test]
fn blocks_that_reach_beyond_the_lattice_and_slabs_thinner_than_a_block() {
    let bounds = Bounds::from_center(DVec3::ZERO, DVec3::new(2.0, 0.1, 0.1));
    let rod = |p: DVec3| (DVec3::new(2.0, 0.1, 0.1) - p.abs()).min_element();
    let (_, report) = mesh_of(&bounds, CellSize::Length(0.06), rod);
    assert_eq!((report.shells, report.euler_characteristic), (1, 2));
}

#[test]
fn a_small_sphere_far_from_the_origin() {
    // The spacing of f32 is a 16th of a cell there.
    let center = DVec3::new(1000.0, -700.0, 300.0);
    let bounds = Bounds::from_center(center, DVec3::splat(0.02));
    let ball = |p: DVec3| 0.02 - p.distance(center);
    let (_, report) = mesh_of(&bounds, CellSize::Length(1e-3), ball);
    assert_eq!((report.shells, report.euler_characteristic), (1, 2));
}

/// Signs and roots from a hash of the node: every case of the table, in every neighbourhood.
struct Noise<'a> {
    lattice: &'a Lattice,
    seed: u64,
    /// The part of the nodes that is inside, in 256ths.
    density: u64,
    /// Whether there are normals and slopes, of any direction and size.
    slopes: bool,
}

impl Noise<'_> {
    fn hash(&self, node: [u32; 3], salt: u64) -> u64 {
        let mut h = self.seed ^ salt << 40;
        for n in node {
            h = (h ^ u64::from(n)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            h ^= h >> 29;
        }
        h.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 17
    }
}

impl Sampler for Noise<'_> {
    type Scratch = ();

    fn scratch(&self) {}

    fn nodes(&self, (): &mut (), _: usize, block: [u32; 3], out: &mut [f32; NODES]) {
        for (n, value) in out.iter_mut().enumerate() {
            let within = [n % 9, n / 9 % 9, n / 81];
            let node = std::array::from_fn(|axis| block[axis] + within[axis] as u32);
            let last = self.lattice.cells();
            let rim = (0..3).any(|axis| node[axis] == 0 || node[axis] >= last[axis]);
            let inside = !rim && self.hash(node, 0) % 256 < self.density;
            // Exact zeros count as outside.
            *value = if inside { 1.0 } else { 0.0 };
        }
    }

    fn roots(&self, (): &mut (), edges: &[EdgeRef], out: &mut [Root]) {
        for (edge, root) in edges.iter().zip(out) {
            let h = self.hash(edge.node, 1 + u64::from(edge.axis));
            root.t = (h % 5) as f64 / 4.0;
            let coordinate = |salt: u64| (self.hash(edge.node, salt + u64::from(edge.axis)) % 255) as f32 - 127.0;
            let normal = Vec3::new(coordinate(5), coordinate(9), coordinate(13)).normalize_or_zero();
            root.normal = if self.slopes { normal.to_array() } else { [f32::NAN; 3] };
        }
    }

    fn slopes(&self, (): &mut (), _: usize, _: [u32; 3], points: &[Vec3A], out: &mut Vec<Slope>) -> bool {
        out.extend(points.iter().map(|p| {
            let bits = p.to_array().map(f32::to_bits);
            let number = |salt: u64| (self.hash(bits, salt) % 255) as f32 / 127.0 - 1.0;
            Slope { value: number(1), gradient: Vec3A::new(number(2), number(3), number(4)) }
        }));
        self.slopes
    }
}

const DENSITIES: [u64; 5] = [20, 80, 128, 170, 235];

/// Meshes of noise on 17³ nodes, with normals and slopes that are noise as well: what feature
/// points, regions and joined faces come to is as bad as it can be.
fn noise_with_features(seeds: std::ops::Range<u64>) {
    let mut fans = 0;
    for seed in seeds {
        // Far from the origin the positions have few bits.
        let at = [0.0, 1e4, 3e5][seed as usize % 3];
        let bounds = Bounds::new(DVec3::splat(at), DVec3::splat(at + 14.0));
        let lattice = Lattice::new(&bounds, CellSize::Length(1.0)).unwrap();
        let density = DENSITIES[seed as usize / 3 % 5];
        let noise = Noise { lattice: &lattice, seed, density, slopes: seed % 7 != 0 };
        let blocks = surface_blocks(&noise, &lattice);
        let [smooth, sharp] = [Features::Smooth, Features::Sharp].map(|features| {
            let mesh = extract(&noise, &lattice, &blocks, features, &Run::default()).unwrap();
            let report = mesh.check();
            assert!(report.is_sound(), "seed {seed}, {features:?}: {report:?}");
            assert!(report.volume > 0.0, "seed {seed}, {features:?}");
            mesh
        });
        fans += sharp.positions().len() - smooth.positions().len();
    }
    assert!(fans > 0);
}

#[test]
fn noise_is_sound_with_features() {
    noise_with_features(0..60);
}

#[test]
#[ignore = "takes minutes"]
fn much_noise_is_sound_with_features() {
    noise_with_features(60..1000);
}

/// What the signs at nodes imply: a loop of n edges in a cell is a polygon of n sides, each of
/// which it shares with another.
fn euler_characteristic(noise: &Noise<'_>, blocks: &[[u32; 3]]) -> i64 {
    let (mut crossed, mut sides, mut loops) = (0, 0, 0);
    let mut values = [0.0; NODES];
    for &block in blocks {
        noise.nodes(&mut (), 0, block, &mut values);
        let signs = Signs::new(&values);
        let rows = (0..BLOCK).flat_map(|k| (0..BLOCK).map(move |j| (j, k)));
        crossed += rows.flat_map(|(j, k)| signs.crossed(j, k)).map(|bits| i64::from(bits.count_ones())).sum::<i64>();
        for_each_cell(&signs, |_, case| {
            for outline in CellLoop::all(case, 0) {
                loops += 1;
                sides += outline.len() as i64;
            }
        });
    }
    crossed - sides / 2 + loops
}

#[test]
fn noise_is_closed_and_manifold() {
    let bounds = Bounds::new(DVec3::ZERO, DVec3::splat(14.0));
    let lattice = Lattice::new(&bounds, CellSize::Length(1.0)).unwrap();
    for seed in 0..60 {
        let noise = Noise { lattice: &lattice, seed, density: DENSITIES[seed as usize % 5], slopes: false };
        let blocks = surface_blocks(&noise, &lattice);
        let mesh = extract(&noise, &lattice, &blocks, Features::Smooth, &Run::default()).unwrap();
        let report = mesh.check();
        assert!(report.is_closed() && report.is_manifold(), "{report:?}");
        assert_eq!(report.duplicate_vertices + report.unused_vertices, 0);
        assert!(report.volume > 0.0);
        assert_eq!(report.euler_characteristic, euler_characteristic(&noise, &blocks), "seed {seed}");
        assert!(mesh.normals().unwrap().iter().all(|&n| n == Vec3::ZERO));
    }
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let lattice = Lattice::new(&cube(1.0), CellSize::LongestSide(60)).unwrap();
    let sampler = Analytic { f: sphere, lattice: &lattice };
    let blocks = surface_blocks(&sampler, &lattice);
    let with = |threads| {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let sink = seen.clone();
        let run =
            Run { threads, progress: Some(Progress::new(move |f| sink.lock().unwrap().push(f))), ..Run::default() };
        let mesh = extract(&sampler, &lattice, &blocks, Features::Smooth, &run).unwrap();
        let seen = seen.lock().unwrap();
        assert!(seen.windows(2).all(|w| w[0] < w[1]));
        assert!(seen.len() > 50 && seen.last() == Some(&1.0));
        mesh
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn cancelling_stops_the_work() {
    let lattice = Lattice::new(&cube(1.25), CellSize::LongestSide(64)).unwrap();
    let run = Run { threads: 2, ..Run::default() };
    let count = AtomicUsize::new(0);
    let f = |p: DVec3| {
        if count.fetch_add(1, Ordering::Relaxed) == 3 * NODES {
            run.cancel.cancel();
        }
        sphere(p)
    };
    let quiet = Analytic { f: sphere, lattice: &lattice };
    let blocks = surface_blocks(&quiet, &lattice);
    let sampler = Analytic { f, lattice: &lattice };
    let result = extract(&sampler, &lattice, &blocks, Features::Smooth, &run);
    assert_eq!(result.unwrap_err(), ExtractError::Cancelled(Cancelled));
    assert!(count.load(Ordering::Relaxed) < 40 * NODES);
}

/// What is said of blocks that are settled as a whole, looked at cell by cell; and how many are, in
/// percent.
#[test]
fn no_cell_of_an_even_block_has_a_crease() {
    let torus = |p: DVec3| 0.4 - (p.truncate().length() - 1.0).hypot(p.z);
    let turned = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.4, 0.3, 0.2);
    let cube = |p: DVec3| 1.0 - (turned * p).abs().max_element();
    // Its ridge is blunt: normals differ by 0.39.
    let roof = |p: DVec3| sphere(p).min(-(turned * p).z - 0.2 * (turned * p).x.abs());
    let eight = |p: DVec3| sphere(p - 0.5 * DVec3::X).max(sphere(p + 0.5 * DVec3::X));
    look_at_even_blocks(sphere, 200, 100..=100);
    look_at_even_blocks(torus, 200, 98..=100);
    look_at_even_blocks(torus, 60, 0..=5);
    look_at_even_blocks(cube, 100, 35..=60);
    look_at_even_blocks(roof, 200, 55..=80);
    look_at_even_blocks(eight, 200, 85..=97);
    // A ridge along blocks, also where the two sides are those of two blocks.
    for n in 0..16 {
        let ridge = |p: DVec3| sphere(p).min(-p.z - 0.25 * (p.x - 0.016 * f64::from(n)).abs());
        look_at_even_blocks(ridge, 100, 0..=90);
    }
}

fn look_at_even_blocks(f: impl Fn(DVec3) -> f64 + Sync, cells: u32, percent: std::ops::RangeInclusive<usize>) {
    let lattice = &Lattice::new(&cube(1.6), CellSize::LongestSide(cells)).unwrap();
    let sampler = Analytic { f, lattice };
    let blocks = surface_blocks(&sampler, lattice);
    let (run, neighbours) = (Run::default(), Neighbours::new(&blocks).unwrap());
    let mut parts = sample_all(&sampler, lattice, (&blocks, neighbours), Features::Sharp, &run).unwrap();
    let vertices = parts.take_vertices();
    let samples =
        samples::Samples::new(&parts, lattice, (Bounds::ALL, Crease::USUAL), [&vertices[0], &vertices[1]], &|_| false);
    let even = trend::even_blocks(&samples, &run).unwrap();
    let mut nearby = nearby::Nearby::new();
    for n in (0..blocks.len()).filter(|&n| even[n]) {
        nearby.load(&samples, n).unwrap();
        for_each_cell(&samples.parts.part(n).signs, |cell, case| {
            let (around, edges) = (nearby.all_around(cell), CaseTable::get().triangles(case).as_flattened());
            let normal = |edge: &u8| Vec3A::from(samples.normal(around[usize::from(*edge)]));
            for (a, b) in edges.iter().flat_map(|a| edges.iter().map(move |b| (a, b))) {
                assert!(normal(a).distance(normal(b)) < 0.3, "{:?}, {cell:?}", blocks[n]);
            }
        });
    }
    let found = 100 * even.iter().filter(|&&is_even| is_even).count() / even.len();
    println!("{found} % of {} blocks", even.len());
    assert!(percent.contains(&found), "{found}");
}

#[test]
fn bad_lists_of_blocks_are_reported() {
    let lattice = Lattice::new(&cube(1.25), CellSize::LongestSide(40)).unwrap();
    let sampler = Analytic { f: sphere, lattice: &lattice };
    let blocks = surface_blocks(&sampler, &lattice);
    let what = |blocks: &[[u32; 3]]| {
        let error = extract(&sampler, &lattice, blocks, Features::Smooth, &Run::default()).unwrap_err();
        match error {
            ExtractError::Blocks { what, .. } => what,
            ExtractError::Mismatches(mismatches) => mismatches[0].what,
            error => panic!("{error}"),
        }
    };
    // Whichever block is left out, it is missed.
    for n in 0..blocks.len() {
        let mut fewer = blocks.clone();
        fewer.remove(n);
        assert!(what(&fewer).contains("not listed"));
    }
    let twice = [&blocks[..], &blocks[..1]].concat();
    assert!(what(&twice).contains("twice"));
    assert!(what(&[[8, 4, 0]]).contains("multiple"));
    // A block that the surface does not meet does no harm.
    let mut more = blocks.clone();
    more.push([800, 800, 800]);
    let run = Run::default();
    assert_eq!(
        extract(&sampler, &lattice, &more, Features::Smooth, &run),
        extract(&sampler, &lattice, &blocks, Features::Smooth, &run)
    );
    let none = extract(&sampler, &lattice, &[], Features::Smooth, &run).unwrap();
    assert!(none.triangles().is_empty());
}

#[test]
fn neighbours_that_disagree_are_reported() {
    /// A sphere whose sign is wrong in one block.
    struct Flipped<'a, F>(Analytic<'a, F>, [u32; 3]);
    impl<F: Fn(DVec3) -> f64 + Sync> Sampler for Flipped<'_, F> {
        type Scratch = ();
        fn scratch(&self) {}
        fn nodes(&self, (): &mut (), _: usize, block: [u32; 3], out: &mut [f32; NODES]) {
            self.0.nodes(&mut (), 0, block, out);
            if block == self.1 {
                out[NODES - 1] = -out[NODES - 1];
            }
        }
        fn roots(&self, (): &mut (), _: &[EdgeRef], out: &mut [Root]) {
            out.fill(Root::default());
        }
    }
    let lattice = Lattice::new(&cube(1.25), CellSize::LongestSide(40)).unwrap();
    let sampler = Analytic { f: sphere, lattice: &lattice };
    let blocks = surface_blocks(&sampler, &lattice);
    let flipped = Flipped(sampler, blocks[0]);
    let error = extract(&flipped, &lattice, &blocks, Features::Smooth, &Run::default()).unwrap_err();
    let ExtractError::Mismatches(mismatches) = error else { panic!("{error}") };
    assert!(mismatches.iter().all(|mismatch| mismatch.block == blocks[0] || mismatch.beyond == Some(blocks[0])));
}

#[test]
#[ignore = "a timing, for release builds"]
fn extraction_time() {
    let lattice = Lattice::new(&cube(1.25), CellSize::LongestSide(512)).unwrap();
    let noise = Analytic { f: |p: DVec3| 1.0 - p.length_squared(), lattice: &lattice };
    let blocks = surface_blocks(&noise, &lattice);
    for threads in [1, 2] {
        let run = Run { threads, ..Run::default() };
        let start = std::time::Instant::now();
        let mesh = extract(&noise, &lattice, &blocks, Features::Smooth, &run).unwrap();
        let (blocks, triangles) = (blocks.len(), mesh.triangles().len());
        println!("{threads} threads: {blocks} blocks, {triangles} triangles, {:?}", start.elapsed());
    }
}
