//! Distances against closed forms and brute force.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use rvachev_num::{CancelToken, Run};

use super::{Foot, Patch, Patches, SurfaceDistance};
use crate::kernel::CHUNK;
use crate::{AnyField, Bounds, Chunk, Cuboid, Dual, Placement, Sphere, VALUE_LIMIT, Zone};

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

/// An octahedron's faces cut into `n²` triangles each, blown up to the unit sphere.
fn sphere(n: usize, curved: bool) -> Vec<Patch> {
    let mut patches = Vec::new();
    for octant in 0..8u32 {
        let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let signs = DVec3::new(sign(0), sign(1), sign(2));
        let at = |i: usize, j: usize| {
            let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
            (DVec3::new(x, y, 1.0 - x - y) * signs).normalize()
        };
        let mut add = |mut corners: [DVec3; 3]| {
            if signs.element_product() < 0.0 {
                corners.swap(1, 2);
            }
            let bulges = [0, 1, 2].map(|i| {
                let (p, q) = (corners[i], corners[(i + 1) % 3]);
                let m = 0.5 * (p + q);
                if curved { 0.25 * (p * p.dot(p - m) + q * q.dot(q - m)) } else { DVec3::ZERO }
            });
            patches.push(Patch { corners, bulges });
        };
        for i in 0..n {
            for j in 0..n - i {
                add([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 2 <= n {
                    add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    patches
}

/// The twelve triangles of a box about the origin.
fn cuboid(half: DVec3) -> Vec<Patch> {
    let mut patches = Vec::new();
    for axis in 0..3 {
        for side in [1.0, -1.0] {
            let mut normal = DVec3::ZERO;
            normal[axis] = side;
            let mut u = DVec3::ZERO;
            u[(axis + 1) % 3] = 1.0;
            let v = normal.cross(u);
            let [a, b, c, d] = [-u - v, u - v, u + v, v - u].map(|corner| (normal + corner) * half);
            patches.extend([Patch::flat([a, b, c]), Patch::flat([a, c, d])]);
        }
    }
    patches
}

fn built(patches: &[Patch]) -> Arc<Patches> {
    Arc::new(Patches::new(patches, &Run::default()).unwrap())
}

/// A unit sphere of patches as a leaf.
fn ball(n: usize) -> SurfaceDistance {
    let sign: Arc<dyn AnyField> = Arc::new(Sphere { radius: 1.0 });
    SurfaceDistance::new(built(&sphere(n, true)), sign, 2e-4, None, Bounds::new(DVec3::NEG_ONE, DVec3::ONE))
}

fn slab(half: DVec3) -> SurfaceDistance {
    let sign: Arc<dyn AnyField> = Arc::new(Cuboid { size: 2.0 * half });
    SurfaceDistance::new(built(&cuboid(half)), sign, 0.0, None, Bounds::new(-half, half))
}

/// The largest error of the distance to a unit sphere, within half a radius of it.
fn sphere_error(n: usize) -> f64 {
    let patches = built(&sphere(n, true));
    let mut random = Random(1);
    let mut most: f64 = 0.0;
    for _ in 0..4000 {
        let p = random.point(1.5);
        if (p.length() - 1.0).abs() < 0.5 {
            most = most.max((patches.nearest(p).unwrap().distance - (p.length() - 1.0).abs()).abs());
        }
    }
    most
}

#[test]
fn the_error_of_a_sphere_falls_with_the_fourth_power() {
    let errors = [4, 8, 16].map(sphere_error);
    assert!(errors[0] < 5e-3, "{errors:?}");
    assert!(errors[0] / errors[1] > 12.0 && errors[1] / errors[2] > 10.0, "{errors:?}");
}

#[test]
fn a_box_of_twelve_triangles_is_exact() {
    let half = DVec3::new(1.0, 2.0, 0.75);
    let patches = built(&cuboid(half));
    let mut random = Random(2);
    for _ in 0..2000 {
        let p = random.point(4.0);
        let q = p.abs() - half;
        let truth = q.max(DVec3::ZERO).length() + q.max_element().min(0.0);
        let foot = patches.nearest(p).unwrap();
        assert!((foot.distance - truth.abs()).abs() < 1e-14 * 16.0, "{p} {foot:?} {truth}");
        assert!((foot.point.distance(p) - foot.distance).abs() < 1e-13);
        let outward = foot.normal * foot.point;
        assert!((outward.element_sum() - (foot.normal.abs() * half).element_sum()).abs() < 1e-13);
    }
}

/// Patches at random, some of them without area.
fn random_patches(random: &mut Random, count: usize) -> Vec<Patch> {
    (0..count)
        .map(|i| {
            let a = random.point(1.0);
            let [b, c] = [a + random.point(0.3), a + random.point(0.3)];
            let least = (b - a).length().min((c - a).length()).min((c - b).length());
            let bend = random.point(0.01);
            let mut u = || random.point(0.12 * least);
            match i % 8 {
                0 => Patch::flat([a, b, c]),
                1 => Patch::flat([a, a, a]),
                2 => Patch::flat([a, b, a + 0.5 * (b - a)]),
                3 => Patch { corners: [a, a, b], bulges: [DVec3::ZERO, bend, bend] },
                _ => Patch { corners: [a, b, c], bulges: [u(), u(), u()] },
            }
        })
        .collect()
}

/// The nearest point by looking at many of every patch.
fn by_force(patches: &[Patch], p: DVec3, n: usize) -> f64 {
    let mut least = f64::INFINITY;
    for patch in patches {
        for i in 0..=n {
            for j in 0..=n - i {
                let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
                least = least.min(patch.point([1.0 - s - t, s, t]).distance(p));
            }
        }
    }
    least
}

#[test]
fn no_sample_of_any_patch_is_nearer() {
    let mut random = Random(3);
    let patches = random_patches(&mut random, 80);
    let found = built(&patches);
    for _ in 0..200 {
        let p = random.point(1.5);
        let foot = found.nearest(p).unwrap();
        let forced = by_force(&patches, p, 40);
        assert!(foot.distance < forced + 1e-6, "{} against {forced}", foot.distance);
        // Samples are at most 0.015 apart.
        assert!(foot.distance > forced - 0.012, "{} against {forced}", foot.distance);
        let b = foot.point.distance(p);
        assert!((b - foot.distance).abs() < 1e-9 && foot.normal.is_normalized(), "{foot:?}");
    }
}

#[test]
fn it_is_the_least_over_patches_taken_one_by_one() {
    let mut random = Random(4);
    let patches = random_patches(&mut random, 300);
    let found = built(&patches);
    let at = |i: usize, p: DVec3| found.closest(i, found.frame.into_local(p).to_array()).square;
    for _ in 0..300 {
        let p = random.point(2.0);
        let least = (0..found.len()).map(|i| at(i, p)).fold(f64::INFINITY, f64::min).sqrt() * found.frame.unit;
        assert_eq!(found.nearest(p).unwrap().distance, least);
    }
}

#[test]
fn the_normal_is_that_of_the_patch() {
    let patches = built(&sphere(6, true));
    let mut random = Random(5);
    for _ in 0..500 {
        let p = random.point(1.5);
        let Foot { normal, point, distance, .. } = patches.nearest(p).unwrap();
        assert!(normal.dot(point) > 0.99, "{normal} at {point}");
        if distance > 0.01 && p.length() > 0.5 {
            assert!(normal.dot(p - point).abs() > 0.99 * distance, "{p} {point} {normal}");
        }
    }
}

#[test]
fn an_empty_surface_is_far_away() {
    let patches = built(&[]);
    assert!(patches.is_empty() && patches.nearest(DVec3::ONE).is_none() && patches.bounds().is_empty());
    let sign: Arc<dyn AnyField> = Arc::new(Sphere { radius: 1.0 });
    let empty = SurfaceDistance::new(patches, sign, 0.0, None, Bounds::EMPTY);
    assert_eq!(AnyField::value(&empty, [0.0; 3]), VALUE_LIMIT);
    assert_eq!(AnyField::value(&empty, [2.0; 3]), -VALUE_LIMIT);
    assert_eq!(AnyField::dual(&empty, Dual::point([2.0; 3])).v, -VALUE_LIMIT);
    let columns = [vec![2.0f32; CHUNK], vec![0.0; CHUNK], vec![0.0; CHUNK]];
    assert!(values(&empty, &columns, &Placement::IDENTITY).iter().all(|v| *v == -VALUE_LIMIT as f32));
}

#[test]
fn what_is_not_finite_is_left_out() {
    let mut patches = cuboid(DVec3::ONE);
    patches.insert(0, Patch::flat([DVec3::NAN, DVec3::ONE, DVec3::ZERO]));
    let found = built(&patches);
    assert_eq!(found.len(), 12);
    let foot = found.nearest(DVec3::new(3.0, 0.1, 0.2)).unwrap();
    assert!(foot.distance == 2.0 && foot.patch > 0);
}

#[test]
fn points_far_away_have_finite_values() {
    for field in [ball(4), slab(DVec3::ONE)] {
        for far in [1e6, 1e12, 1e15] {
            let value = AnyField::value(&field, [far, 0.5, 0.25]);
            assert!((value + far - 1.0).abs() < 1e-3 + 1e-9 * far, "{value} at {far}");
            let columns = [vec![far as f32; CHUNK], vec![0.5; CHUNK], vec![0.25; CHUNK]];
            let lanes = f64::from(values(&field, &columns, &Placement::IDENTITY)[0]);
            assert!((lanes - value).abs() <= 1e-6 * far, "{lanes} at {far}");
        }
    }
}

#[test]
fn a_cancelled_run_builds_nothing() {
    let cancel = CancelToken::default();
    cancel.cancel();
    assert!(Patches::new(&sphere(20, true), &Run { cancel, ..Run::default() }).is_err());
}

/// Values of a chunk on lanes.
fn values(field: &dyn AnyField, columns: &[Vec<f32>; 3], placement: &Placement) -> Vec<f32> {
    let mut out = vec![0.0; columns[0].len()];
    let points = columns.each_ref().map(|column| &**column);
    field.lanes32(Chunk { points, placement, out: [&mut out] });
    out
}

/// Random points as columns.
fn columns(random: &mut Random, size: f64, count: usize) -> [Vec<f32>; 3] {
    let points: Vec<DVec3> = (0..count).map(|_| random.point(size)).collect();
    [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect())
}

#[test]
fn lanes_are_the_values_of_single_points() {
    let mut random = Random(6);
    let map = DAffine3::from_scale_rotation_translation(
        DVec3::splat(0.5),
        glam::DQuat::from_rotation_x(0.7),
        DVec3::new(0.1, -0.2, 0.3),
    );
    let placement = Placement::new(&map, 2.0, -0.25);
    for field in [ball(5), slab(DVec3::new(0.5, 0.25, 0.75))] {
        let columns = columns(&mut random, 3.0, 2 * CHUNK);
        let roundoff = 2.0 * field.roundoff(3.0);
        let lanes = values(&field, &columns, &placement);
        let doubles = columns.each_ref().map(|column| column.iter().map(|v| f64::from(*v)).collect::<Vec<f64>>());
        let mut wide = vec![0.0; lanes.len()];
        let points = doubles.each_ref().map(|column| &**column);
        field.lanes64(Chunk { points, placement: &placement, out: [&mut wide] });
        let mut slopes = [const { Vec::new() }; 4].map(|_: Vec<f32>| vec![0.0; lanes.len()]);
        let points = columns.each_ref().map(|column| &**column);
        field.gradients(Chunk { points, placement: &placement, out: slopes.each_mut().map(|column| &mut **column) });
        for i in 0..lanes.len() {
            let local = placement.apply([doubles[0][i], doubles[1][i], doubles[2][i]]);
            let dual = AnyField::dual(&field, Dual::point(local));
            let value = placement.finish(dual.v);
            assert!((wide[i] - value).abs() <= 1e-13 * 3.0, "{} against {value}", wide[i]);
            assert!((f64::from(lanes[i]) - value).abs() <= roundoff, "{} against {value}", lanes[i]);
            assert!((f64::from(slopes[0][i]) - value).abs() <= roundoff);
            let slope = DVec3::from_array(placement.pull(dual.d.map(|part| part * placement.scale)));
            let found = DVec3::from_array([1, 2, 3].map(|axis| f64::from(slopes[axis][i])));
            assert!((found.length() - 1.0).abs() < 1e-3, "{found}");
            // Two feet may be equally near; else the gradients agree.
            let near = slope.dot(found) > 0.99;
            assert!(near || value > 0.2, "{found} against {slope} where the value is {value}");
        }
    }
}

#[test]
fn ranges_hold_samples() {
    let mut random = Random(7);
    for field in [ball(4), slab(DVec3::new(0.5, 0.25, 0.75))] {
        for _ in 0..300 {
            let (centre, size) = (random.point(1.5), 0.3 * random.next());
            let bounds = Bounds::from_center(centre, DVec3::splat(size));
            let range = field.range(&Zone::of_bounds(&bounds));
            for _ in 0..20 {
                let value = AnyField::value(&field, (centre + random.point(size)).to_array());
                assert!(range.contains(value), "{value} not in {range:?}");
            }
        }
    }
}

#[test]
fn a_cylinder_has_no_slope_along_its_axis() {
    let patches = built(&cuboid(DVec3::new(1.0, 2.0, 0.5)));
    let sign: Arc<dyn AnyField> = Arc::new(Cuboid { size: DVec3::new(2.0, 4.0, 1e6) });
    let all = Bounds::new(DVec3::new(-1.0, -2.0, f64::NEG_INFINITY), DVec3::new(1.0, 2.0, f64::INFINITY));
    let prism = SurfaceDistance::new(patches, sign, 0.0, Some(2), all);
    let dual = AnyField::dual(&prism, Dual::point([3.0, 0.3, 70.0]));
    assert!(dual.v == -2.0 && dual.d[0] == -1.0 && dual.d[1].abs() < 1e-14 && dual.d[2] == 0.0, "{dual:?}");
    let foot = prism.nearest(DVec3::new(3.0, 0.3, 70.0)).unwrap();
    assert!(foot.point.distance(DVec3::new(1.0, 0.3, 70.0)) < 1e-14);
    let slab = Bounds::new(DVec3::new(3.0, 0.0, -100.0), DVec3::new(3.5, 0.5, 100.0));
    assert!(prism.range(&Zone::of_bounds(&slab)).hi() < -1.0);
}
