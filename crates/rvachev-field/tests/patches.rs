//! Distances to patches on the machine's SIMD level: values, gradients, narrowed leaves.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3};
use rvachev_field::kernel::CHUNK;
use rvachev_field::{AnyField, Chunk, Cuboid, Patch, Patches, Placement, Sphere, SurfaceDistance, Zone};
use rvachev_num::{Bounds, Dual, Run};

/// A generator of numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point of the cube from −size to size.
    fn point(&mut self, size: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * size
    }
}

/// Patches at random, some of them curved, flat, slim, a line or a point.
fn scattered(random: &mut Random, count: usize, curved: bool) -> Vec<Patch> {
    (0..count)
        .map(|i| {
            let a = random.point(1.0);
            let [b, c] = [a + random.point(0.2), a + random.point(0.2)];
            let least = (b - a).length().min((c - a).length()).min((c - b).length());
            let mut displacement = || random.point(0.1 * least);
            match i % 8 {
                0 => Patch::flat([a, b, a + 0.5 * (b - a)]),
                1 => Patch::flat([a, a, a]),
                2 => Patch::flat([a, b, a + 0.3 * (b - a) + 1e-5 * c]),
                3 => Patch::flat([a, b, c]),
                _ if curved => {
                    Patch { corners: [a, b, c], displacements: [displacement(), displacement(), displacement()] }
                }
                _ => Patch::flat([a, b, c]),
            }
        })
        .collect()
}

/// A torus of `n × 2n` pairs of patches, radii 1 and 0.4.
fn torus(n: usize, curved: bool) -> Vec<Patch> {
    let at = |i: f64, j: f64| {
        let (ring, turn) = (std::f64::consts::TAU * j / (2 * n) as f64, std::f64::consts::TAU * i / n as f64);
        let out = 1.0 + 0.4 * turn.cos();
        DVec3::new(out * ring.cos(), out * ring.sin(), 0.4 * turn.sin())
    };
    let patch = |nodes: [[f64; 2]; 3]| {
        let corners = nodes.map(|[i, j]| at(i, j));
        let displacements = [0, 1, 2].map(|k| {
            let ([a, b], [c, d]) = (nodes[k], nodes[(k + 1) % 3]);
            let middle = 0.5 * (corners[k] + corners[(k + 1) % 3]);
            if curved { at(0.5 * (a + c), 0.5 * (b + d)) - middle } else { DVec3::ZERO }
        });
        Patch { corners, displacements }
    };
    let pairs = (0..n).flat_map(|i| (0..2 * n).map(move |j| (i as f64, j as f64)));
    pairs
        .flat_map(|(i, j)| {
            let (k, l) = (i + 1.0, j + 1.0);
            [patch([[i, j], [i, l], [k, j]]), patch([[k, l], [k, j], [i, l]])]
        })
        .collect()
}

fn leaf(patches: &[Patch], flat: Option<usize>) -> SurfaceDistance {
    let sign: Arc<dyn AnyField> = Arc::new(Sphere { radius: 0.9 });
    let patches = Arc::new(Patches::new(patches, &Run::default()).unwrap());
    SurfaceDistance::new(patches, sign, 1e-3, flat, Bounds::new(DVec3::splat(-2.0), DVec3::splat(2.0)))
}

/// What lanes say of points.
struct Lanes {
    single: Vec<f32>,
    double: Vec<f64>,
    slopes: [Vec<f32>; 4],
}

fn lanes(field: &dyn AnyField, points: &[DVec3], placement: &Placement) -> Lanes {
    let count = points.len();
    let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
    let wide = columns.each_ref().map(|column| column.iter().map(|v| f64::from(*v)).collect::<Vec<f64>>());
    let mut found = Lanes { single: vec![0.0; count], double: vec![0.0; count], slopes: [const { Vec::new() }; 4] };
    found.slopes = found.slopes.map(|_| vec![0.0; count]);
    let points = columns.each_ref().map(|column| &**column);
    field.lanes32(Chunk { points, placement, out: [&mut found.single] });
    field.gradients(Chunk { points, placement, out: found.slopes.each_mut().map(|column| &mut **column) });
    let points = wide.each_ref().map(|column| &**column);
    field.lanes64(Chunk { points, placement, out: [&mut found.double] });
    found
}

/// Points as a machine's single precision holds them.
fn rounded(points: &[DVec3]) -> Vec<DVec3> {
    points.iter().map(|p| p.as_vec3().as_dvec3()).collect()
}

/// Compares lanes with values and gradients point by point.
fn check(field: &SurfaceDistance, points: &[DVec3], placement: &Placement, reach: f64) {
    let points = rounded(points);
    let found = lanes(field, &points, placement);
    let roundoff = placement.scale.abs() * field.roundoff(reach) + 1e-7 * reach;
    for (i, p) in points.iter().enumerate() {
        let local = placement.apply(p.to_array());
        let dual = AnyField::dual(field, Dual::point(local));
        assert!((dual.v - AnyField::value(field, local)).abs() <= 1e-14 * reach);
        let value = placement.finish(dual.v);
        assert!((found.double[i] - value).abs() <= 2e-13 * reach, "{} against {value} at {p}", found.double[i]);
        assert!((f64::from(found.single[i]) - value).abs() <= roundoff, "{} against {value} at {p}", found.single[i]);
        assert!((f64::from(found.slopes[0][i]) - value).abs() <= roundoff, "{} at {p}", found.slopes[0][i]);
        let slope = DVec3::from_array([1, 2, 3].map(|part| f64::from(found.slopes[part][i])));
        let truth = DVec3::from_array(placement.pull(dual.d.map(|part| part * placement.scale)));
        assert!((slope.length() - truth.length()).abs() < 1e-3, "{slope} against {truth}");
        // Along the gradient the distance changes by as much, whichever of two feet it is from.
        let step = 1e-3 * slope.normalize_or_zero();
        let ahead = placement.finish(AnyField::value(field, placement.apply((*p + step).to_array())));
        let risen = (ahead - value) * value.signum() / 1e-3 * slope.length();
        let same = slope.distance(truth) < 2e-2;
        assert!(same || risen.abs() > 0.97 * slope.length_squared(), "{slope} against {truth}, {risen}, at {p}");
    }
}

fn placement() -> Placement {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 0.2);
    Placement::new(&DAffine3::from_scale_rotation_translation(DVec3::splat(0.5), turn, DVec3::splat(0.1)), 2.0, -0.25)
}

#[test]
fn lanes_are_values_of_scattered_patches() {
    for curved in [false, true] {
        let mut random = Random(11);
        let field = leaf(&scattered(&mut random, 500, curved), None);
        for placement in [Placement::IDENTITY, placement()] {
            let points: Vec<DVec3> = (0..5 * CHUNK).map(|_| random.point(2.0)).collect();
            check(&field, &points, &placement, 4.0);
        }
    }
}

#[test]
fn lanes_are_values_on_a_grid_and_near_the_surface() {
    for (curved, n) in [(false, 24), (true, 8), (true, 40)] {
        let patches = torus(n, curved);
        let field = leaf(&patches, None);
        let mut random = Random(12);
        let corner = DVec3::new(0.9, 0.4, -0.1);
        let grid = (0..512).map(|i| corner + DVec3::new((i % 8) as f64, (i / 8 % 8) as f64, (i / 64) as f64) / 64.0);
        let near = (0..1024).map(|i| {
            let patch = &patches[(random.next() * patches.len() as f64) as usize];
            let (s, t) = (random.next() * 0.5, random.next() * 0.5);
            patch.point([1.0 - s - t, s, t]) + random.point(10f64.powi(-(i % 8)))
        });
        let points: Vec<DVec3> = grid.chain(near).collect();
        check(&field, &points, &Placement::IDENTITY, 4.0);
    }
}

#[test]
fn the_nearest_of_all_patches_is_found() {
    for curved in [false, true] {
        let mut random = Random(13);
        let patches = scattered(&mut random, 120, curved);
        let field = leaf(&patches, None);
        let each: Vec<SurfaceDistance> = patches.iter().map(|patch| leaf(std::slice::from_ref(patch), None)).collect();
        let points = rounded(&(0..CHUNK).map(|_| random.point(1.5)).collect::<Vec<_>>());
        let found = lanes(&field, &points, &Placement::IDENTITY);
        for (i, p) in points.iter().enumerate() {
            let least = each.iter().map(|leaf| leaf.nearest(*p).unwrap().distance).fold(f64::INFINITY, f64::min);
            assert!((found.double[i].abs() - least).abs() < 1e-6, "{} against {least}", found.double[i]);
            assert!((f64::from(found.single[i].abs()) - least).abs() < 3e-6, "{} against {least}", found.single[i]);
        }
    }
}

#[test]
fn points_far_away_and_at_one_place_are_found() {
    for curved in [false, true] {
        let field = leaf(&torus(10, curved), None);
        let mut random = Random(14);
        for size in [1e2, 1e4, 1e6, 1e9, 1e12] {
            let points: Vec<DVec3> = (0..CHUNK).map(|_| random.point(size)).collect();
            let found = lanes(&field, &points, &Placement::IDENTITY);
            for (i, p) in rounded(&points).iter().enumerate() {
                let value = AnyField::value(&field, p.to_array());
                assert!((found.double[i] - value).abs() <= 1e-12 * size, "{} against {value}", found.double[i]);
                assert!((f64::from(found.single[i]) - value).abs() <= 1e-6 * size);
                assert!((found.slopes[1][i].hypot(found.slopes[2][i]).hypot(found.slopes[3][i]) - 1.0).abs() < 1e-3);
            }
        }
        check(&field, &vec![DVec3::new(0.3, 0.2, 0.1); CHUNK], &Placement::IDENTITY, 4.0);
        check(&field, &vec![DVec3::new(1.4, 0.0, 0.0); CHUNK], &Placement::IDENTITY, 4.0);
    }
}

#[test]
fn a_cylinder_is_asked_across_its_axis() {
    let patches: Vec<Patch> = torus(12, true).iter().map(|patch| squashed(patch, 1)).collect();
    let field = leaf(&patches, Some(1));
    let mut random = Random(15);
    let points: Vec<DVec3> = (0..2 * CHUNK).map(|_| random.point(2.0)).collect();
    check(&field, &points, &Placement::IDENTITY, 4.0);
}

/// A patch moved to where a coordinate is 0.
fn squashed(patch: &Patch, axis: usize) -> Patch {
    let flat = |mut v: DVec3| {
        v[axis] = 0.0;
        v
    };
    Patch { corners: patch.corners.map(flat), displacements: patch.displacements.map(flat) }
}

#[test]
fn narrowed_leaves_have_the_same_values() {
    let half = DVec3::new(0.6, 0.5, 0.4);
    let corners = |axis: usize, side: f64| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| {
            let mut p = DVec3::ZERO;
            (p[axis], p[u], p[v]) = (side, a, b);
            p * half
        })
    };
    let sides = (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]).map(|(axis, side)| corners(axis, side));
    let patches: Vec<Patch> = sides.flat_map(|[a, b, c, d]| [Patch::flat([a, b, c]), Patch::flat([a, c, d])]).collect();
    let patches = Arc::new(Patches::new(&patches, &Run::default()).unwrap());
    let sign: Arc<dyn AnyField> = Arc::new(Cuboid { size: 2.0 * half });
    let field = SurfaceDistance::new(patches, sign, 0.0, None, Bounds::new(-half, half));
    let mut random = Random(16);
    let mut simpler = 0;
    for _ in 0..200 {
        let (centre, size) = (random.point(1.0), 0.3 * random.next());
        let zone = Zone::of_bounds(&Bounds::from_center(centre, DVec3::splat(size)));
        let range = field.range(&zone);
        let Some(narrowed) = AnyField::narrowed(&field, &zone) else { continue };
        simpler += 1;
        let points: Vec<DVec3> = (0..CHUNK).map(|_| centre + random.point(0.5 * size)).collect();
        let (all, own) =
            (lanes(&field, &points, &Placement::IDENTITY), lanes(&*narrowed, &points, &Placement::IDENTITY));
        assert_eq!(all.single, own.single);
        assert_eq!(all.double, own.double);
        assert_eq!(all.slopes, own.slopes);
        for p in &points {
            let value = narrowed.value(p.to_array());
            assert_eq!(value, AnyField::value(&field, p.to_array()));
            assert!(range.contains(value) && narrowed.range(&zone).contains(value));
        }
    }
    assert!(simpler > 100, "{simpler} of 200 zones are narrowed");
}

#[test]
fn values_are_right_within_a_band_and_on_the_right_side_beyond() {
    let mut random = Random(7);
    for curved in [false, true] {
        let field = leaf(&torus(12, curved), None);
        for (level, band) in [(0.0, 0.1), (0.15, 0.05), (-0.2, 0.1), (0.3, 0.0), (-5.0, 0.1)] {
            let placement = Placement::new(&DAffine3::IDENTITY, 1.0, -level);
            let points = rounded(&(0..CHUNK).map(|_| random.point(1.6)).collect::<Vec<DVec3>>());
            let exact = lanes(&field, &points, &placement).single;
            let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
            let mut found = vec![0.0; CHUNK];
            let points = columns.each_ref().map(|column| &**column);
            field.lanes32_within(Chunk { points, placement: &placement, out: [&mut found] }, band);
            let rounding = 1e-5;
            let mut nearer = 0;
            for (found, exact) in found.into_iter().zip(exact).map(|(a, b)| (f64::from(a), f64::from(b))) {
                if exact.abs() <= band {
                    assert!((found - exact).abs() <= rounding, "{found} for {exact} within {band}");
                } else {
                    let is_between = found.abs() >= band - rounding && found.abs() <= exact.abs() + rounding;
                    assert!(is_between && (found * exact > 0.0 || exact.abs() < rounding), "{found} for {exact}");
                    nearer += usize::from(found.abs() < 0.9 * exact.abs());
                }
            }
            assert!(nearer > CHUNK / 10, "{nearer} searches end early");
        }
    }
}
