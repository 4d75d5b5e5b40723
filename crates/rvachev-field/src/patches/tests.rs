//! Distances against closed forms and brute force.

use std::sync::Arc;

use glam::{DQuat, DVec3, EulerRot};
use rvachev_num::{CancelToken, Run};

use super::hierarchy::PARENT;
use super::{Foot, Patch, Patches};

/// A generator of numbers in [0, 1).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point of the cube from −size to size.
    pub(super) fn point(&mut self, size: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * size
    }
}

/// An octahedron's faces cut into `n²` triangles each, blown up to the unit sphere.
pub(super) fn sphere(n: usize, curved: bool) -> Vec<Patch> {
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
            let displacements = [0, 1, 2].map(|i| {
                let (p, q) = (corners[i], corners[(i + 1) % 3]);
                let m = 0.5 * (p + q);
                if curved { 0.25 * (p * p.dot(p - m) + q * q.dot(q - m)) } else { DVec3::ZERO }
            });
            patches.push(Patch { corners, displacements });
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
pub(super) fn cuboid(half: DVec3) -> Vec<Patch> {
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

pub(super) fn built(patches: &[Patch]) -> Arc<Patches> {
    Arc::new(Patches::new(patches, &Run::default()).unwrap())
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
                3 => Patch { corners: [a, a, b], displacements: [DVec3::ZERO, bend, bend] },
                _ => Patch { corners: [a, b, c], displacements: [u(), u(), u()] },
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

/// The patches of a box, counted as the hierarchy sorts them.
fn of_box(patches: &Patches, at: usize) -> Vec<usize> {
    let node = &patches.nodes[at];
    if node.count < PARENT {
        return (node.first as usize..(node.first + node.count) as usize).collect();
    }
    [0, 1].into_iter().flat_map(|child| of_box(patches, node.first as usize + child)).collect()
}

#[test]
fn no_patch_is_nearer_than_its_disc() {
    let (mut random, mut told) = (Random(8), 0);
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.9, 0.5);
    let turned = |patches: Vec<Patch>| {
        let turned = |v: DVec3| turn * v;
        let patch =
            |patch: Patch| Patch { corners: patch.corners.map(turned), displacements: patch.displacements.map(turned) };
        patches.into_iter().map(patch).collect::<Vec<Patch>>()
    };
    for patches in [
        sphere(12, true),
        sphere(12, false),
        turned(cuboid(DVec3::new(1.0, 2.0, 0.1))),
        random_patches(&mut random, 200),
    ] {
        let found = built(&patches);
        for (at, disc) in found.discs.iter().enumerate().filter(|(_, disc)| !disc.is_none()) {
            let all = of_box(&found, at);
            for _ in 0..30 {
                // Close to a patch of it, and anywhere.
                let n = all[(random.next() * all.len() as f64) as usize];
                let far = 10.0_f64.powf(-4.0 * random.next());
                let p = found.frame.into_local(found.point(n, [0.3, 0.3])) + random.point(far);
                let least = all.iter().map(|n| found.closest(*n, p.to_array()).square).fold(f64::INFINITY, f64::min);
                let gap = disc.gap(p.to_array());
                assert!(gap <= least, "{gap} for {least}");
                told += usize::from(gap > 0.5 * least);
            }
        }
    }
    assert!(told > 200, "{told} are told");
}

#[test]
fn searches_of_a_box_begin_with_all_that_may_be_nearest() {
    let mut random = Random(9);
    let found = built(&sphere(16, false));
    let mut few = 0;
    for _ in 0..300 {
        let (middle, half) = (random.point(1.2), DVec3::splat(0.1 * random.next()));
        let [low, high] = [middle - half, middle + half].map(|p| p.to_array());
        let far = found.near(middle.to_array()).square.sqrt();
        let entries = found.entries(low, high, far);
        let held: Vec<usize> = entries.all().iter().flat_map(|at| of_box(&found, *at as usize)).collect();
        few += usize::from(held.len() < found.len() / 2);
        for _ in 0..20 {
            let p = middle + random.point(1.0) * half;
            assert!(held.contains(&(found.search_one(p.to_array()).which as usize)));
        }
    }
    assert!(few > 100, "{few} boxes begin with a half");
}

#[test]
fn what_is_within_a_distance_is_what_is_nearer() {
    let mut random = Random(11);
    let mut within = 0;
    for found in [true, false].map(|curved| built(&sphere(8, curved))).iter().chain([&built(&cuboid(DVec3::ONE))]) {
        for _ in 0..400 {
            let p = random.point(1.5);
            let distance = found.nearest(p).unwrap().distance;
            for part in [0.0, 0.5, 0.999_99, 1.000_01, 2.0] {
                assert_eq!(found.is_within(p, part * distance), part > 1.0, "{part} of {distance} at {p}");
            }
            within += usize::from(found.is_within(p, 0.1));
        }
    }
    assert!(within > 100, "{within} are near");
    assert!(!built(&[]).is_within(DVec3::ZERO, f64::MAX));
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
fn a_cancelled_run_builds_nothing() {
    let cancel = CancelToken::default();
    cancel.cancel();
    assert!(Patches::new(&sphere(20, true), &Run { cancel, ..Run::default() }).is_err());
}
