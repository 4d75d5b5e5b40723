//! Depth-buffer CSG: the acceptance checks of the mathematics on analytic layers, and meshes
//! against interval CSG of the same triangles.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DMat3, DVec3, Vec3};
use rvachev::{
    Camera, Mesh, RFunction, Run, Solid, Superellipsoid, deg, rad,
    range_image::Coordinates,
    raster::{
        Buffers, ClosedMesh, Csg, CsgMethod, Facing, Fragments, LayerSource, MeshLayers, RasterError, RasterView, Tile,
    },
    surface::{ParametricSurface, PatchSettings},
};

/// The picture of the acceptance checks: 160 × 160 pixel middles over [−2, 2]², along +z.
const SIDE: u32 = 160;

fn along_z() -> RasterView {
    let eye = DVec3::new(0.0, 0.0, -10.0);
    // Up is −y, so that y grows downwards like the rows.
    let camera = Camera::orthographic(eye, DVec3::ZERO, DVec3::NEG_Y, 4.0);
    RasterView::new(&camera, SIDE, SIDE).unwrap()
}

/// The pixel's middle.
fn middle(i: u32) -> f64 {
    -2.0 + (f64::from(i) + 0.5) * 4.0 / f64::from(SIDE)
}

/// A solid given by where a ray along +z at (x, y) enters and leaves it.
struct Analytic {
    /// For each pixel, row by row.
    spans: Vec<Vec<(f64, f64)>>,
}

impl Analytic {
    fn new(spans: impl Fn(f64, f64) -> Vec<(f64, f64)>) -> Analytic {
        let spans = &spans;
        Analytic { spans: (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| spans(middle(x), middle(y)))).collect() }
    }

    fn at(&self, x: u32, y: u32) -> &[(f64, f64)] {
        &self.spans[(y * SIDE + x) as usize]
    }
}

impl LayerSource for Analytic {
    fn size(&self) -> [u32; 2] {
        [SIDE, SIDE]
    }

    fn layers(&self, tile: &Tile, sink: &mut dyn FnMut(&[Fragments])) {
        for y in tile.y..tile.y + tile.height {
            for x in tile.x..tile.x + tile.width {
                for (face, &(enter, leave)) in self.at(x, y).iter().enumerate() {
                    let (i, face) = (tile.index(x, y), face as u32);
                    // In no order that could be relied on.
                    sink(&[
                        Fragments::pixel(i, leave, Facing::Back, face),
                        Fragments::pixel(i, enter, Facing::Front, face),
                    ]);
                }
            }
        }
    }
}

fn ball(radius: f64, centre: [f64; 3]) -> Analytic {
    let [cx, cy, cz] = centre;
    let spans = move |x: f64, y: f64| {
        let square = radius * radius - (x - cx).powi(2) - (y - cy).powi(2);
        if square > 0.0 { vec![(cz - square.sqrt(), cz + square.sqrt())] } else { vec![] }
    };
    Analytic::new(spans)
}

/// Where a function of z changes sign, found on samples and by halving; inside where positive.
fn spans_of(value: impl Fn(f64) -> f64, samples: u32) -> Vec<(f64, f64)> {
    let at = |k: u32| -2.0 + 4.0 * f64::from(k) / f64::from(samples);
    let mut ends = Vec::new();
    let mut before = value(at(0)) > 0.0;
    assert!(!before);
    for k in 1..=samples {
        let now = value(at(k)) > 0.0;
        if now != before {
            let (mut low, mut high) = (at(k - 1), at(k));
            for _ in 0..60 {
                let mid = 0.5 * (low + high);
                if (value(mid) > 0.0) == before { low = mid } else { high = mid }
            }
            ends.push(high);
        }
        before = now;
    }
    ends.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

/// The same by 1200 samples alone, as the acceptance check has it: from the first that is inside
/// to the first that no longer is.
fn sampled_spans(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let at = |k: u32| -2.0 + (f64::from(k) + 0.5) * 4.0 / 1200.0;
    let inside = |k: u32| (1..1200).contains(&k) && value(at(k)) > 0.0;
    let ends: Vec<f64> = (1..=1200).filter(|&k| inside(k) != inside(k - 1)).map(at).collect();
    ends.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

/// The torus of check 4.
fn tilted_torus_value(p: DVec3) -> f64 {
    let q = DMat3::from_rotation_x(1.3) * p;
    0.4 - ((q.x.hypot(q.y) - 1.1).powi(2) + q.z * q.z).sqrt()
}

fn tilted_torus() -> Analytic {
    Analytic::new(|x, y| spans_of(|z| tilted_torus_value(DVec3::new(x, y, z)), 1200))
}

/// The first place of a ray that the tree holds, by trying all ends of all spans.
fn exact(operands: &[&Analytic], tree: &Csg, x: u32, y: u32) -> Option<f64> {
    let holds = |z: f64| {
        let inside: Vec<bool> = operands.iter().map(|o| o.at(x, y).iter().any(|&(a, b)| a <= z && z < b)).collect();
        tree.holds(&inside)
    };
    let ends = operands.iter().flat_map(|o| o.at(x, y)).flat_map(|&(a, b)| [a, b]);
    ends.filter(|&z| holds(z)).min_by(f64::total_cmp)
}

/// Pixels that are covered, and pixels whose depth is not that of exact interval CSG.
fn compare(operands: &[&Analytic], tree: &Csg, buffers: &Buffers) -> (usize, usize) {
    let (mut covered, mut wrong) = (0, 0);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let found = buffers.depth(x, y);
            covered += usize::from(found.is_some());
            let right = match (found, exact(operands, tree, x, y)) {
                (Some(a), Some(b)) => (a - b).abs() <= 1e-12,
                (a, b) => a.is_some() == b.is_some(),
            };
            wrong += usize::from(!right);
        }
    }
    (covered, wrong)
}

fn csg(operands: &[&Analytic], tree: &Csg, method: CsgMethod) -> Buffers {
    let operands: Vec<&dyn LayerSource> = operands.iter().map(|o| *o as &dyn LayerSource).collect();
    along_z().csg(&operands, tree, method).unwrap()
}

const METHODS: [CsgMethod; 3] = [CsgMethod::Stencil, CsgMethod::Sequenced, CsgMethod::Intervals];

fn operands<const N: usize>() -> [Csg; N] {
    std::array::from_fn(|i| Csg::operand(i as u32))
}

#[test]
fn two_spheres_by_every_method() {
    let (a, b) = (ball(1.2, [0.0; 3]), ball(0.9, [0.5, 0.2, -0.4]));
    let [p, q] = operands();
    for (tree, count) in [(p.clone() | q.clone(), 7732), (p.clone() & q.clone(), 3555), (p - q, 7205)] {
        for method in METHODS {
            let buffers = csg(&[&a, &b], &tree, method);
            assert_eq!(compare(&[&a, &b], &tree, &buffers), (count, 0), "{tree} {method:?}");
        }
    }
}

#[test]
fn the_printed_difference_is_wrong() {
    let (a, b) = (ball(1.2, [0.0; 3]), ball(0.9, [0.5, 0.2, -0.4]));
    let mut outer = Buffers::new(&along_z());
    outer.draw(&a, 0, Facing::Front).unwrap();
    outer.classify(&b).unwrap();
    outer.keep(|count| count == 0);
    let mut inner = Buffers::new(&along_z());
    inner.draw(&b, 1, Facing::Back).unwrap();
    inner.classify(&a).unwrap();
    let [p, q] = operands();
    let tree = p - q;

    let mut printed = (outer.clone(), inner.clone());
    printed.1.keep(|count| count == 0);
    printed.0.merge(&printed.1).unwrap();
    assert_eq!(compare(&[&a, &b], &tree, &printed.0).1, 2909);

    inner.keep(|count| count != 0);
    outer.merge(&inner).unwrap();
    assert_eq!(compare(&[&a, &b], &tree, &outer), (7205, 0));
    // What is seen of B is its inner side.
    let sides = (0..SIDE * SIDE).filter_map(|i| outer.id(i % SIDE, i / SIDE)).map(|id| (id.operand, id.facing));
    let mut sides: Vec<_> = sides.collect();
    sides.sort_unstable();
    sides.dedup();
    assert_eq!(sides, [(0, Facing::Front), (1, Facing::Back)]);
}

#[test]
fn six_spheres_are_taken_away() {
    let body = ball(1.5, [0.0; 3]);
    // A row of overlapping balls into the depth, and others beside it.
    let centres = [
        [0.0, 0.0, -1.4],
        [0.3, 0.1, -0.9],
        [0.1, 0.3, -0.4],
        [-0.6, 0.4, -1.0],
        [0.7, -0.6, -0.8],
        [-0.3, -0.7, -0.9],
    ];
    let balls: Vec<Analytic> = centres.iter().map(|&c| ball(0.6, c)).collect();
    let all: Vec<&Analytic> = std::iter::once(&body).chain(&balls).collect();
    let tree = (1..7).fold(Csg::operand(0), |tree, i| tree - Csg::operand(i));
    for method in [CsgMethod::Sequenced, CsgMethod::Intervals] {
        let buffers = csg(&all, &tree, method);
        assert_eq!(compare(&all, &tree, &buffers).1, 0, "{method:?}");
        if method == CsgMethod::Sequenced {
            let most = (0..SIDE * SIDE).map(|i| buffers.stencil(i % SIDE, i / SIDE)).max().unwrap();
            assert!((3..=7).contains(&most), "{most}");
        }
    }
}

#[test]
fn a_torus_needs_all_its_layers() {
    let (torus, sphere) = (tilted_torus(), ball(0.95, [0.0, 0.6, -1.0]));
    let [p, q] = operands();
    let tree = p - q;
    let all = [&torus, &sphere];
    assert_eq!(compare(&all, &tree, &csg(&all, &tree, CsgMethod::Intervals)), (4258, 0));
    // By samples, which miss two thin spans, the numbers are those of the acceptance check.
    let centre = DVec3::new(0.0, 0.6, -1.0);
    let torus = Analytic::new(|x, y| sampled_spans(|z| tilted_torus_value(DVec3::new(x, y, z))));
    let sphere = Analytic::new(|x, y| sampled_spans(|z| 0.95 - DVec3::new(x, y, z).distance(centre)));
    let sampled = [&torus, &sphere];
    assert_eq!(compare(&sampled, &tree, &csg(&sampled, &tree, CsgMethod::Intervals)), (4256, 0));
    assert_eq!(compare(&sampled, &tree, &csg(&sampled, &tree, CsgMethod::Stencil)).1, 416);
    let (_, wrong) = compare(&all, &tree, &csg(&all, &tree, CsgMethod::Stencil));
    assert_eq!(wrong, 412);
    let (_, wrong) = compare(&all, &tree, &csg(&all, &tree, CsgMethod::Sequenced));
    assert!(wrong > 300, "{wrong}");
}

#[test]
fn any_tree() {
    let solids = [
        ball(1.0, [0.0; 3]),
        ball(0.8, [0.6, 0.0, -0.3]),
        tilted_torus(),
        ball(0.7, [-0.5, 0.5, -0.8]),
        ball(0.5, [0.2, -0.6, -0.9]),
    ];
    let all: Vec<&Analytic> = solids.iter().collect();
    let [a, b, c, d, e] = operands();
    let trees = [
        (a.clone() ^ b.clone()) - d.clone(),
        ((a.clone() | c.clone()) - (b.clone() & d.clone())) | e.clone(),
        c.clone() & !(a.clone() ^ (b.clone() - e.clone())),
        (a.clone() ^ b.clone() ^ c.clone() ^ !d.clone()) & (e.clone() | !(a.clone() & b.clone())) & c.clone(),
    ];
    for tree in trees {
        let buffers = csg(&all, &tree, CsgMethod::Intervals);
        let (covered, wrong) = compare(&all, &tree, &buffers);
        assert!(covered > 500, "{tree}");
        assert_eq!(wrong, 0, "{tree}");
    }
    // Convex operands only.
    let balls = [&solids[0], &solids[1], &solids[3], &solids[4]];
    let [a, b, c, d] = operands();
    for tree in [
        (a.clone() ^ b.clone()) - c.clone(),
        (a.clone() | b.clone()) & (c.clone() | d.clone()),
        (a.clone() - (b.clone() - c.clone())) | (d.clone() - a.clone()),
        (a ^ b ^ c) & !(d.clone() - Csg::operand(0)),
    ] {
        let buffers = csg(&balls, &tree, CsgMethod::Sequenced);
        assert_eq!(compare(&balls, &tree, &buffers).1, 0, "{tree}");
    }
}

#[test]
fn flush_faces_leave_no_skin() {
    let (a, b) = (ball(1.0, [0.0; 3]), ball(1.0, [0.0; 3]));
    let [p, q] = operands();
    for method in METHODS {
        let nothing = csg(&[&a, &b], &(p.clone() - q.clone()), method);
        assert_eq!(compare(&[&a, &b], &(p.clone() - q.clone()), &nothing), (0, 0), "{method:?}");
        let both = csg(&[&a, &b], &(p.clone() & q.clone()), method);
        assert_eq!(compare(&[&a, &b], &(p.clone() & q.clone()), &both).1, 0, "{method:?}");
    }
}

// Meshes.

/// A closed mesh of a surface over an n × m grid: `wraps` tells whether a side closes on
/// itself, and else its ends are poles.
fn patch(n: u32, m: u32, wraps: bool, at: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let mut positions: Vec<Vec3> = Vec::new();
    let rows = if wraps { m } else { m - 1 };
    for j in 0..rows {
        let v = if wraps { f64::from(j) / f64::from(m) } else { f64::from(j + 1) / f64::from(m) };
        positions.extend((0..n).map(|i| at(f64::from(i) / f64::from(n), v).as_vec3()));
    }
    let mut triangles = Vec::new();
    let index = |i: u32, j: u32| (j % rows) * n + i % n;
    for j in 0..if wraps { rows } else { rows - 1 } {
        for i in 0..n {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    if !wraps {
        let (south, north) = (positions.len() as u32, positions.len() as u32 + 1);
        positions.extend([at(0.0, 0.0).as_vec3(), at(0.0, 1.0).as_vec3()]);
        for i in 0..n {
            triangles.push([south, index(i + 1, 0), index(i, 0)]);
            triangles.push([north, index(i, rows - 1), index(i + 1, rows - 1)]);
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

fn ball_mesh(n: u32, radii: DVec3, centre: DVec3) -> Mesh {
    patch(n, n / 2, false, |u, v| {
        let (s, c) = (TAU * u).sin_cos();
        let (z, r) = (PI * (v - 0.5)).sin_cos();
        centre + radii * DVec3::new(r * c, r * s, z)
    })
}

fn torus_mesh(n: u32, turn: DMat3) -> Mesh {
    patch(n, n / 2, true, |u, v| {
        let (s, c) = (TAU * u).sin_cos();
        let (z, r) = (TAU * v).sin_cos();
        turn * DVec3::new((1.1 + 0.4 * r) * c, (1.1 + 0.4 * r) * s, 0.4 * z)
    })
}

/// Where a ray crosses a mesh: the distance along it, and whether it enters; by Möller and
/// Trumbore's test, which knows nothing of pixels.
fn crossings(mesh: &Mesh, origin: DVec3, direction: DVec3) -> Vec<(f64, bool)> {
    let mut found = Vec::new();
    for &t in mesh.triangles() {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
        let (u, v) = (b - a, c - a);
        let p = direction.cross(v);
        let det = u.dot(p);
        if det == 0.0 {
            continue;
        }
        let s = origin - a;
        let beta = s.dot(p) / det;
        let q = s.cross(u);
        let gamma = direction.dot(q) / det;
        let t = v.dot(q) / det;
        if beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0 && t > 0.0 {
            found.push((t, det > 0.0));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Depths of a tree over meshes by the rays through the pixels' middles.
fn by_rays(view: &RasterView, meshes: &[&Mesh], tree: &Csg) -> Vec<f64> {
    let mut depths = Vec::new();
    let (right, down) = (view.width(), view.height());
    for y in 0..down {
        for x in 0..right {
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let (origin, direction) = view.camera().ray(px, py, right, down);
            let mut events = Vec::new();
            for (number, mesh) in meshes.iter().enumerate() {
                events.extend(crossings(mesh, origin, direction).into_iter().map(|(t, enters)| (t, number, enters)));
            }
            events.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut winding = vec![0; meshes.len()];
            let mut depth = f64::INFINITY;
            for (t, number, enters) in events {
                winding[number] += if enters { 1 } else { -1 };
                let inside: Vec<bool> = winding.iter().map(|w| *w > 0).collect();
                if tree.holds(&inside) {
                    depth = view.project(origin + t * direction)[2];
                    break;
                }
            }
            depths.push(depth);
        }
    }
    depths
}

/// Pixels whose depths differ by more than `tolerance`.
fn different(a: &[f64], b: &[f64], tolerance: f64) -> usize {
    let same = |(a, b): (&f64, &f64)| a == b || (a - b).abs() <= tolerance;
    a.iter().zip(b).filter(|pair| !same(*pair)).count()
}

fn cameras() -> [Camera; 2] {
    let eye = DVec3::new(2.1, -3.3, 2.2);
    [
        Camera::perspective(eye, DVec3::new(0.03, 0.01, 0.02), DVec3::Z, deg(42.0)),
        Camera::orthographic(eye, DVec3::new(0.03, 0.01, 0.02), DVec3::Z, 3.4),
    ]
}

#[test]
fn convex_meshes_by_every_method() {
    let a = ball_mesh(40, DVec3::new(1.2, 1.0, 0.9), DVec3::ZERO);
    let b = ball_mesh(32, DVec3::splat(0.8), DVec3::new(0.5, -0.6, 0.4));
    let [p, q] = operands();
    for camera in cameras() {
        let view = RasterView::new(&camera, 80, 60).unwrap();
        let [a_layers, b_layers] = [&a, &b].map(|mesh| view.layers(ClosedMesh::new(mesh).unwrap()));
        for tree in [p.clone() | q.clone(), p.clone() & q.clone(), p.clone() - q.clone(), q.clone() - p.clone()] {
            let all: [&dyn LayerSource; 2] = [&a_layers, &b_layers];
            let depths = METHODS.map(|method| view.csg(&all, &tree, method).unwrap().depths());
            // The same triangles in the same places: the same to the bit.
            assert_eq!(different(&depths[0], &depths[2], 0.0), 0, "{tree}");
            assert_eq!(different(&depths[1], &depths[2], 0.0), 0, "{tree}");
            // Vertices move by up to 2⁻¹⁷ pixel, which is 4e-7: by more in depth where a face is
            // steep.
            let rays = by_rays(&view, &[&a, &b], &tree);
            let covered = rays.iter().filter(|d| d.is_finite()).count();
            assert!(covered > 150, "{tree}: {covered}");
            assert_eq!(different(&depths[2], &rays, 1e-4), 0, "{tree}");
            let steep = different(&depths[2], &rays, 1e-5);
            assert!(steep < covered / 50, "{tree}: {steep} of {covered}");
        }
    }
}

#[test]
fn any_tree_over_meshes() {
    let a = ball_mesh(32, DVec3::new(1.0, 0.9, 0.8), DVec3::new(0.2, 0.0, -0.2));
    let b = torus_mesh(32, DMat3::from_rotation_x(1.3));
    let c = torus_mesh(24, DMat3::from_rotation_y(0.9));
    let [p, q, r] = operands();
    let tree = (q ^ r) - p;
    for camera in cameras() {
        let view = RasterView::new(&camera, 64, 48).unwrap();
        let layers = [&a, &b, &c].map(|mesh| view.layers(ClosedMesh::new(mesh).unwrap()));
        let all = [&layers[0] as &dyn LayerSource, &layers[1], &layers[2]];
        let depths = view.csg(&all, &tree, CsgMethod::Intervals).unwrap().depths();
        let rays = by_rays(&view, &[&a, &b, &c], &tree);
        assert_eq!(different(&depths, &rays, 1e-4), 0);
    }
}

#[test]
fn an_eye_inside_sees_walls_from_behind() {
    let room = ball_mesh(48, DVec3::splat(2.0), DVec3::ZERO);
    let pillar = ball_mesh(32, DVec3::new(0.3, 0.3, 0.9), DVec3::new(1.0, 0.1, 0.0));
    let camera = Camera::perspective(DVec3::new(0.05, 0.02, 0.03), DVec3::X, DVec3::Z, deg(80.0));
    let view = RasterView::new(&camera, 64, 48).unwrap();
    let [room_layers, pillar_layers] = [&room, &pillar].map(|mesh| view.layers(ClosedMesh::new(mesh).unwrap()));
    let all: [&dyn LayerSource; 2] = [&room_layers, &pillar_layers];
    let [p, q] = operands();
    let carved = view.csg(&all, &(p.clone() - q.clone()), CsgMethod::Intervals).unwrap();
    let seen = carved.id(32, 24).unwrap();
    assert_eq!((seen.operand, seen.facing), (1, Facing::Front));
    let wall = carved.id(1, 1).unwrap();
    assert_eq!((wall.operand, wall.facing), (0, Facing::Back));
    assert!((carved.point(1, 1).unwrap().length() - 2.0).abs() < 0.02);
    for method in [CsgMethod::Stencil, CsgMethod::Sequenced] {
        assert_eq!(view.csg(&all, &(p.clone() - q.clone()), method).unwrap_err(), RasterError::Cut { operand: 0 });
    }
}

#[test]
fn same_bytes_for_any_number_of_threads() {
    let a = ball_mesh(200, DVec3::new(1.2, 1.0, 0.9), DVec3::ZERO);
    let b = torus_mesh(200, DMat3::from_rotation_x(1.3));
    let [p, q] = operands();
    let view = RasterView::new(&cameras()[0], 150, 130).unwrap();
    let with = |threads: usize| {
        let run = Run { threads, ..Run::default() };
        run.install(|| {
            let [a, b] = [&a, &b].map(|mesh| view.layers(ClosedMesh::new(mesh).unwrap()));
            let buffers = view.csg_with(&[&a, &b], &(p.clone() ^ q.clone()), CsgMethod::Intervals, &run).unwrap();
            let ids: Vec<_> = (0..150 * 130).map(|i| buffers.id(i % 150, i / 150)).collect();
            let bits: Vec<u64> = buffers.depths().iter().map(|d| d.to_bits()).collect();
            (ids, bits)
        })
    };
    let one = with(1);
    assert!(one == with(2) && one == with(5));
}

#[test]
fn a_depth_buffer_is_a_range_image() {
    let mesh = ball_mesh(40, DVec3::new(1.2, 1.0, 0.9), DVec3::ZERO);
    for camera in cameras() {
        let view = RasterView::new(&camera, 60, 40).unwrap();
        let layers = view.layers(ClosedMesh::new(&mesh).unwrap());
        let buffers = view.csg(&[&layers], &Csg::operand(0), CsgMethod::Stencil).unwrap();
        let cloud = buffers.range_image().unwrap().points(Coordinates::World).unwrap();
        let pixels = (0..40).flat_map(|y| (0..60).map(move |x| (x, y)));
        let points: Vec<DVec3> = pixels.filter_map(|(x, y)| buffers.point(x, y)).collect();
        assert_eq!(cloud.positions().len(), points.len());
        assert!(points.len() > 300);
        for (a, b) in cloud.positions().iter().zip(&points) {
            assert!((*a - *b).length() < 1e-12, "{a} {b}");
        }
    }
}

// The same solid by meshes and by fields.

/// How far the middles of triangles and edges are from the surface of the solid that the mesh
/// stands for, at most, to first order.
fn chord_error(mesh: &Mesh, solid: &Solid) -> f64 {
    let middles = mesh.triangles().iter().flat_map(|t| {
        let [a, b, c] = t.map(|i| mesh.positions()[i as usize].as_dvec3());
        [(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0]
    });
    let off = |p: DVec3| {
        let slope = solid.gradient(p).unwrap().length();
        if slope > 0.0 { solid.value(p).unwrap().abs() / slope } else { 0.0 }
    };
    middles.map(off).fold(0.0, f64::max)
}

/// Depths and normals by rasterising against rays that are cast at the field. Returns the pixels
/// that both see and those left out at silhouettes; asserts all others.
fn like_for_like(view: &RasterView, meshes: &[&Mesh], tree: &Csg, solid: &Solid, tolerance: f64) -> (usize, usize) {
    let layers: Vec<MeshLayers> = meshes.iter().map(|mesh| view.layers(ClosedMesh::new(mesh).unwrap())).collect();
    let operands: Vec<&dyn LayerSource> = layers.iter().map(|l| l as &dyn LayerSource).collect();
    let buffers = view.csg(&operands, tree, CsgMethod::Intervals).unwrap();
    let (mut compared, mut silhouettes) = (0, 0);
    for y in 0..view.height() {
        for x in 0..view.width() {
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let (origin, direction) = view.camera().ray(px, py, view.width(), view.height());
            let (hit, id) = (solid.raycast(origin, direction).unwrap(), buffers.id(x, y));
            let (Some(hit), Some(id)) = (hit, id) else {
                silhouettes += usize::from(hit.is_some() != id.is_some());
                continue;
            };
            let facing = hit.normal.dot(direction).abs();
            if facing < 0.2 || hit.owner != id.operand {
                silhouettes += 1;
                continue;
            }
            let point = buffers.point(x, y).unwrap();
            // A step along the ray is a shorter one off the surface.
            let off = (point - hit.point).length() * facing;
            if off > tolerance {
                // An edge of the result may pass between the two.
                let next = |dx: i32, dy: i32| buffers.id(x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                let around = [next(1, 0), next(-1, 0), next(0, 1), next(0, -1)];
                let same = |other: &Option<rvachev::raster::SurfaceId>| {
                    other.is_some_and(|o| (o.operand, o.facing) == (id.operand, id.facing))
                };
                assert!(!around.iter().all(same), "({x}, {y}): {off:e}, {tolerance:e} allowed");
                silhouettes += 1;
                continue;
            }
            let normal = operands[id.operand as usize].normal(id.face, point);
            let outward = if id.facing == Facing::Front { normal } else { -normal };
            assert!(outward.dot(hit.normal) > 0.95, "({x}, {y}): {outward} {}", hit.normal);
            compared += 1;
        }
    }
    (compared, silhouettes)
}

fn patch_settings() -> PatchSettings {
    PatchSettings { rows: 48, columns: 96, ..PatchSettings::default() }
}

#[test]
fn superellipsoids_like_for_like_with_rays() {
    let shapes = [
        Superellipsoid::new([1.2, 1.0, 0.8], 0.6, 0.7),
        Superellipsoid::new([0.8, 0.7, 0.9], 1.0, 1.3),
        Superellipsoid::new([0.4, 0.4, 1.3], 0.5, 1.0),
    ];
    let places = [[0.0, 0.0, 0.0], [0.7, -0.6, 0.5], [-0.5, -0.1, 0.1]].map(|p| DAffine3::from_translation(p.into()));
    let meshes: Vec<Mesh> = shapes
        .iter()
        .zip(places)
        .map(|(shape, place)| {
            ParametricSurface::of(shape).unwrap().mesh(&patch_settings()).unwrap().affine(place).unwrap()
        })
        .collect();
    let solids: Vec<Solid> =
        shapes.iter().zip(places).map(|(shape, place)| Solid::from(*shape).affine(place)).collect();
    let error = meshes.iter().zip(&solids).map(|(mesh, solid)| chord_error(mesh, solid)).fold(0.0, f64::max);
    assert!(error < 0.005, "{error}");
    let [a, b, c] = operands();
    let min = RFunction::MIN_MAX;
    let (p, q, r) = (&solids[0], &solids[1], &solids[2]);
    for (tree, solid) in [
        (a.clone() - b.clone(), p.difference(q, min)),
        (a.clone() & b.clone(), p.intersection(q, min)),
        ((a | b) - c, p.union(q, min).difference(r, min)),
    ] {
        for camera in cameras() {
            let view = RasterView::new(&camera, 60, 45).unwrap();
            let all: Vec<&Mesh> = meshes.iter().take(tree.operands()).collect();
            let (compared, silhouettes) = like_for_like(&view, &all, &tree, &solid, error);
            println!("{tree}: {compared} pixels within {error:.1e}, {silhouettes} at silhouettes");
            assert!(compared > 200 && silhouettes < compared / 4, "{tree}: {compared} {silhouettes}");
        }
    }
}

#[test]
fn deformed_operands_like_for_like_with_rays() {
    let bar = Superellipsoid::new([0.5, 0.4, 1.2], 0.6, 0.6);
    let mesh = ParametricSurface::of(&bar).unwrap().mesh(&patch_settings()).unwrap();
    let bar = Solid::from(bar);
    let ball_solid = Solid::sphere(0.5).translate([0.4, -0.5, 0.3]);
    let ball = ball_mesh(64, DVec3::splat(0.5), DVec3::new(0.4, -0.5, 0.3));
    let [a, b] = operands();
    let tree = a - b;
    for (mesh, solid) in [
        (mesh.taper(0.4, -0.3, 2.4).unwrap(), bar.taper(0.4, -0.3, 2.4)),
        (mesh.twist(rad(0.8)).unwrap(), bar.twist(rad(0.8))),
        (mesh.bend(0.5, rad(0.7)).unwrap(), bar.bend(0.5, rad(0.7))),
        (mesh.bend(-0.4, rad(0.2)).unwrap(), bar.bend(-0.4, rad(0.2))),
        (
            mesh.taper(0.3, 0.3, 2.4).unwrap().twist(rad(0.6)).unwrap().bend(0.3, rad(0.5)).unwrap(),
            bar.taper(0.3, 0.3, 2.4).twist(rad(0.6)).bend(0.3, rad(0.5)),
        ),
    ] {
        ClosedMesh::new(&mesh).unwrap();
        let error = chord_error(&mesh, &solid).max(chord_error(&ball, &ball_solid));
        assert!(error < 0.01, "{error}");
        let view = RasterView::new(&cameras()[0], 50, 40).unwrap();
        let all = solid.difference(&ball_solid, RFunction::MIN_MAX);
        let (compared, silhouettes) = like_for_like(&view, &[&mesh, &ball], &tree, &all, error);
        assert!(compared > 150 && silhouettes < compared / 3, "{compared} {silhouettes}");
    }
    let parameter = |result: Result<Mesh, RasterError>| result.unwrap_err().to_string();
    assert!(parameter(mesh.taper(1.5, 0.0, 2.0)).starts_with("kx is 1.5, allowed: -0.999 to 0.999"));
    assert!(parameter(mesh.twist(rad(f64::NAN))).starts_with("rate is NaN"));
    assert!(parameter(mesh.bend(5.0, deg(0.0))).starts_with("curvature is 5"));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert!(parameter(mesh.affine(flat)).starts_with("determinant of the map is 0"));
    // A mirror image still faces outward.
    let mirrored = mesh.affine(DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))).unwrap();
    assert!((mirrored.volume() - mesh.volume()).abs() < 1e-6);
    ClosedMesh::new(&mirrored).unwrap();
}

#[test]
fn moved_meshes_keep_what_they_carry() {
    let octahedron = ParametricSurface::of(&Superellipsoid::new([1.0, 1.0, 1.0], 2.0, 2.0)).unwrap();
    let mesh = octahedron.mesh(&PatchSettings { rows: 8, columns: 16, ..PatchSettings::default() }).unwrap();
    let count = mesh.triangles().len();
    let colors = (0..count).map(|t| [0, 1, 2].map(|k| [t as u8, k, 7, 255])).collect();
    let mesh = mesh.with_corner_colors(colors).unwrap().with_owners((0..count as u32).collect()).unwrap();
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.2), DVec3::new(0.0, 0.3, 2.0));
    let mirror = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
    for (map, order) in [(shear, [0, 1, 2]), (mirror * shear, [0, 2, 1])] {
        let moved = mesh.affine(DAffine3::from_mat3(map)).unwrap();
        assert_eq!(moved.owners(), mesh.owners());
        for t in 0..count {
            assert_eq!(moved.triangles()[t], order.map(|k| mesh.triangles()[t][k]));
            assert_eq!(moved.corner_colors().unwrap()[t], order.map(|k| mesh.corner_colors().unwrap()[t][k]));
            assert_eq!(moved.corner_texture().unwrap()[t], order.map(|k| mesh.corner_texture().unwrap()[t][k]));
            // Faces stay flat, and each corner has its own face's normal.
            let [a, b, c] = moved.triangles()[t].map(|i| moved.positions()[i as usize]);
            let face = (b - a).cross(c - a).normalize();
            assert!(moved.corner_normals().unwrap()[t].iter().all(|n| n.distance(face) < 1e-4));
        }
    }
    let twisted = mesh.twist(rad(0.3)).unwrap();
    assert!(twisted.corner_normals().is_some() && twisted.corner_texture() == mesh.corner_texture());
}

#[test]
fn trees_are_lowered_rightly() {
    // All trees of a few operations against the table of truth, by the products and by the
    // circuit: four balls that meet in every way, seen along the eye.
    let balls: Vec<Analytic> =
        [[0.0, 0.0, 0.0], [0.5, 0.0, -0.2], [0.0, 0.5, 0.2], [0.4, 0.4, 0.5]].map(|c| ball(0.8, c)).into();
    let all: Vec<&Analytic> = balls.iter().collect();
    let mut state = 7u32;
    let mut random = |n: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) % n
    };
    for _ in 0..12 {
        let mut stack: Vec<Csg> = (0..4).map(Csg::operand).collect();
        for _ in 0..3 {
            stack.push(Csg::operand(random(4)));
        }
        while stack.len() > 1 {
            let a = stack.swap_remove(random(stack.len() as u32) as usize);
            let b = stack.swap_remove(random(stack.len() as u32) as usize);
            stack.push(match random(5) {
                0 => a | b,
                1 => a & b,
                2 => a - b,
                3 => a ^ b,
                _ => !(a | b),
            });
        }
        let tree = stack.pop().unwrap() & (Csg::operand(0) | Csg::operand(3));
        for method in [CsgMethod::Intervals, CsgMethod::Sequenced] {
            assert_eq!(compare(&all, &tree, &csg(&all, &tree, method)).1, 0, "{tree} {method:?}");
        }
    }
}

#[test]
fn long_trees_do_not_exhaust_the_stack() {
    // Few pixels, each of which follows the whole tree.
    let a = ball(0.1, [0.0; 3]);
    let mut tree = Csg::operand(0);
    for i in 0..100_000u32 {
        tree = match i % 3 {
            0 => tree | Csg::operand(0),
            1 => tree & Csg::operand(0),
            _ => !!tree,
        };
    }
    let buffers = csg(&[&a], &tree.clone(), CsgMethod::Intervals);
    assert!(buffers.depth(SIDE / 2, SIDE / 2).is_some());
    assert!(tree.to_string().len() > 100_000);
}

#[test]
fn errors() {
    let a = ball_mesh(12, DVec3::ONE, DVec3::ZERO);
    let view = RasterView::new(&cameras()[0], 30, 20).unwrap();
    let closed = ClosedMesh::new(&a).unwrap();
    let layers = view.layers(closed);
    let [p, q] = operands();
    let error = |operands: &[&dyn LayerSource], tree: &Csg, method| view.csg(operands, tree, method).unwrap_err();
    let text = |e: RasterError| e.to_string();
    let intervals = CsgMethod::Intervals;
    assert_eq!(
        text(error(&[&layers], &(p.clone() - q.clone()), intervals)),
        "the tree names operand 1, but there are 1 operands, counted from 0"
    );
    assert_eq!(error(&[&layers], &!p.clone(), intervals), RasterError::Unbounded);
    assert_eq!(error(&[&layers], &!p.clone(), CsgMethod::Sequenced), RasterError::Unbounded);
    assert_eq!(
        text(error(&[&layers, &layers], &(p.clone() ^ q.clone()), CsgMethod::Stencil)),
        "the stencil passes join operands by union, or two by intersection or difference; not (0 ^ 1)"
    );
    let other = RasterView::new(&cameras()[0], 31, 20).unwrap().layers(closed);
    assert_eq!(text(error(&[&other], &p, intervals)), "layers of a picture of 31 × 20 cannot go into one of 30 × 20");
    assert_eq!(error(&[&view.surface(&a)], &p, intervals), RasterError::Surface { operand: 0 });
    // An exclusive or of many is a union of far too many products.
    let many: Vec<&dyn LayerSource> = vec![&layers; 20];
    let tree = (1..20).fold(p.clone(), |tree, i| tree ^ Csg::operand(i));
    assert!(matches!(error(&many, &tree, CsgMethod::Sequenced), RasterError::Products { .. }));
    view.csg(&many, &tree, intervals).unwrap();
    let run = Run::default();
    run.cancel.cancel();
    assert!(matches!(view.csg_with(&[&layers], &p, intervals, &run), Err(RasterError::Cancelled(_))));

    let open = Mesh::new(a.positions().to_vec(), a.triangles()[1..].to_vec()).unwrap();
    let message = text(ClosedMesh::new(&open).unwrap_err());
    assert!(message.starts_with("the mesh is open: 3 edges are not used once in each direction"), "{message}");
    let turned = a.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = Mesh::new(a.positions().to_vec(), turned).unwrap();
    assert!(matches!(ClosedMesh::new(&turned), Err(RasterError::InsideOut { volume }) if volume < 0.0));
    // Corners that are not welded are welded by their positions; a mesh of nothing is closed.
    let soup: Vec<Vec3> = a.triangles().iter().flat_map(|t| t.map(|i| a.positions()[i as usize])).collect();
    let corners = (0..soup.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    ClosedMesh::new(&Mesh::new(soup, corners).unwrap()).unwrap();
    let nothing = Mesh::default();
    let nothing = view.layers(ClosedMesh::new(&nothing).unwrap());
    let buffers = view.csg(&[&layers, &nothing], &(p - q), CsgMethod::Stencil).unwrap();
    assert!(buffers.depth(15, 10).is_some());
}

#[test]
fn closed_meshes_are_told_under_a_run() {
    let mesh = Solid::sphere(1.0).mesh(&rvachev::MeshSettings::default()).unwrap();
    let told = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
    let list = told.clone();
    let progress = rvachev::Progress::new(move |fraction| list.lock().unwrap().push(fraction));
    let run = rvachev::Run { progress: Some(progress), ..rvachev::Run::default() };
    ClosedMesh::new_with(&mesh, &run).unwrap();
    let told = told.lock().unwrap();
    assert!(told.len() > 2 && told.is_sorted() && told.last() == Some(&1.0), "{told:?}");
    run.cancel.cancel();
    assert!(matches!(ClosedMesh::new_with(&mesh, &run), Err(RasterError::Cancelled(_))));
}
