//! Solids of triangles on the machine's SIMD level: lanes against points, open and closed.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use rvachev_field::kernel::CHUNK;
use rvachev_field::{AnyField, Chunk, MeshLeaf, Placement, Way, Zone};
use rvachev_num::{Bounds, Dual, Run};

/// A torus of n × 2n pairs of triangles, radii 1 and 0.4, without the first few.
fn torus(n: u32, without: usize) -> MeshLeaf {
    let (positions, triangles) = torus_triangles(n);
    MeshLeaf::new(&positions, &triangles[without..], None, None, &Run::default()).unwrap()
}

fn torus_triangles(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |i: u32, j: u32| {
        let (turn, ring) = (TAU * f64::from(i) / f64::from(n), TAU * f64::from(j) / f64::from(2 * n));
        let out = 1.0 + 0.4 * turn.cos();
        DVec3::new(out * ring.cos(), out * ring.sin(), 0.4 * turn.sin()).as_vec3()
    };
    let positions: Vec<Vec3> = (0..2 * n * n).map(|v| at(v % n, v / n)).collect();
    let number = |i: u32, j: u32| i % n + n * (j % (2 * n));
    let pairs = (0..2 * n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles: Vec<[u32; 3]> = pairs
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            [[a, d, b], [d, c, b]]
        })
        .collect();
    (positions, triangles)
}

/// A generator of numbers in [0, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, size: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * size
    }
}

#[test]
fn winding_numbers_are_whole_where_closed() {
    let leaf = torus(24, 0);
    assert!(!leaf.is_open() && leaf.len() == 2 * 24 * 48);
    let mut random = Random(1);
    for _ in 0..2000 {
        let p = random.point(1.6);
        let inside = (p.truncate().length() - 1.0).hypot(p.z) < 0.4;
        let number = leaf.winding_number(p);
        // Facets are within the circles.
        let near = ((p.truncate().length() - 1.0).hypot(p.z) - 0.4).abs() < 0.01;
        // Moments of facets as coarse as these tell it to some hundredths; the sides are told at a
        // half.
        assert!(near || (number - f64::from(u8::from(inside))).abs() < 0.03, "{number} at {p}");
    }
    assert!(leaf.bytes() as f64 / leaf.len() as f64 <= 150.0, "{}", leaf.bytes() as f64 / leaf.len() as f64);
}

#[test]
fn lanes_are_values() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 0.2);
    let map = DAffine3::from_scale_rotation_translation(DVec3::splat(0.5), turn, DVec3::splat(0.1));
    for leaf in [torus(16, 0), torus(16, 90)] {
        for placement in [Placement::IDENTITY, Placement::new(&map, 2.0, -0.25)] {
            let mut random = Random(2);
            let points: Vec<DVec3> = (0..2 * CHUNK).map(|_| random.point(2.0).as_vec3().as_dvec3()).collect();
            let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect::<Vec<f32>>());
            let wide = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f64>>());
            let count = points.len();
            let (mut single, mut double) = (vec![0.0_f32; count], vec![0.0_f64; count]);
            let mut slopes = [const { Vec::new() }; 4].map(|_: Vec<f32>| vec![0.0_f32; count]);
            let points32 = columns.each_ref().map(|column| &column[..]);
            let placement = &placement;
            leaf.lanes32(Chunk { points: points32, placement, out: [&mut single] });
            leaf.gradients(Chunk { points: points32, placement, out: slopes.each_mut().map(|column| &mut column[..]) });
            let points64 = wide.each_ref().map(|column| &column[..]);
            leaf.lanes64(Chunk { points: points64, placement, out: [&mut double] });
            for (i, p) in points.iter().enumerate() {
                let local = placement.apply(p.to_array());
                let dual = leaf.dual(Dual::point(local));
                let value = placement.finish(leaf.value(local));
                let roundoff = placement.scale * leaf.roundoff(4.0) + 4e-7;
                assert!((placement.finish(dual.v) - value).abs() < 1e-13);
                assert!((double[i] - value).abs() < 1e-12, "{} for {value} at {p}", double[i]);
                assert!((f64::from(single[i]) - value).abs() < roundoff, "{} for {value} at {p}", single[i]);
                assert!((f64::from(slopes[0][i]) - value).abs() < roundoff, "{} for {value} at {p}", slopes[0][i]);
                let slope = DVec3::from_array([1, 2, 3].map(|part| f64::from(slopes[part][i])));
                assert!(slope.length() < 1.01, "{slope} at {p}");
            }
        }
    }
}

/// Of points that are close to each other sides are told by the triangles between them.
#[test]
fn sides_of_blocks_are_those_of_single_points() {
    let mut random = Random(7);
    let (positions, triangles) = torus_triangles(24);
    // Twice there, and a small one within.
    let twice = [&triangles[..], &triangles[..]].concat();
    let count = positions.len() as u32;
    let inner = positions.iter().map(|p| (0.6 * (*p - 1.4 * Vec3::X) + 1.4 * Vec3::X) * Vec3::new(1.0, 1.0, 0.5));
    let both: Vec<Vec3> = positions.iter().copied().chain(inner).collect();
    let all = [&triangles[..], &triangles.iter().map(|t| t.map(|v| v + count)).collect::<Vec<_>>()].concat();
    let leaf = |positions: &[Vec3], triangles: &[[u32; 3]]| {
        MeshLeaf::new(positions, triangles, None, None, &Run::default()).unwrap()
    };
    for leaf in [leaf(&positions, &triangles), leaf(&positions, &twice), leaf(&both, &all), plate().0] {
        assert!(!leaf.is_open());
        let (mut sides, mut wrong) = ([0; 2], 0);
        for n in 0..60 {
            // About the surface, finer and coarser than the triangles.
            let foot = leaf.nearest(random.point(1.3)).unwrap().point;
            let step = [0.003, 0.02, 0.1][n % 3] * (0.5 + random.next());
            let start = foot - 4.0 * step + random.point(2.0 * step);
            let at = |k: usize| start + step * DVec3::new((k % 8) as f64, (k / 8 % 8) as f64, (k / 64) as f64);
            let points: Vec<Vec3> = (0..512).map(|k| at(k).as_vec3()).collect();
            let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f32>>());
            let mut out = vec![0.0_f32; points.len()];
            let points32 = columns.each_ref().map(|column| &column[..]);
            // Before distances are known, and by them.
            let band = [0.0, f64::INFINITY][n / 3 % 2];
            leaf.lanes32_within(Chunk { points: points32, placement: &Placement::IDENTITY, out: [&mut out] }, band);
            for (p, found) in points.iter().zip(out) {
                let value = leaf.value(p.as_dvec3().to_array());
                sides[usize::from(value > 0.0)] += 1;
                wrong += usize::from(value.abs() > leaf.roundoff(1.6) && (value > 0.0) != (found > 0.0));
            }
        }
        assert!(wrong == 0 && sides[0] > 5000 && sides[1] > 5000, "{wrong} wrong, {sides:?}");
    }
}

/// What was too much to gather for one block of a chunk is not known to the next one.
#[test]
fn sides_of_many_blocks_are_those_of_single_points() {
    let leaf = torus(160, 0);
    let mut random = Random(11);
    let block: Vec<Vec3> = (0..256).map(|_| (random.point(1.4) * DVec3::new(1.0, 1.0, 0.3)).as_vec3()).collect();
    let points = [&block[..], &block].concat();
    let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f32>>());
    let wide = columns.each_ref().map(|column| column.iter().map(|x| f64::from(*x)).collect::<Vec<f64>>());
    let (mut single, mut double) = (vec![0.0_f32; points.len()], vec![0.0_f64; points.len()]);
    let placement = &Placement::IDENTITY;
    leaf.lanes32_within(
        Chunk { points: columns.each_ref().map(|column| &column[..]), placement, out: [&mut single] },
        0.1,
    );
    leaf.lanes64(Chunk { points: wide.each_ref().map(|column| &column[..]), placement, out: [&mut double] });
    for (i, p) in points.iter().enumerate() {
        let value = leaf.value(p.as_dvec3().to_array());
        let is_told = value.abs() > leaf.roundoff(1.6);
        let same = |found: f64| (found > 0.0) == (value > 0.0);
        assert!(!is_told || same(f64::from(single[i])) && same(double[i]), "{i}: {value} at {p}");
    }
}

/// How far a point is from a triangle, by its plane and its sides.
fn triangle_distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let side = |a: DVec3, b: DVec3| {
        let way = b - a;
        let at = ((p - a).dot(way) / way.length_squared().max(1e-300)).clamp(0.0, 1.0);
        p.distance(a + at * way)
    };
    let least = side(a, b).min(side(b, c)).min(side(c, a));
    let normal = (b - a).cross(c - a);
    let is_within = |a: DVec3, b: DVec3| normal.cross(b - a).dot(p - a) >= 0.0;
    let is_above = normal != DVec3::ZERO && is_within(a, b) && is_within(b, c) && is_within(c, a);
    if is_above { (p - a).dot(normal.normalize()).abs() } else { least }
}

/// In blocks of all sizes, about the surface and far from it, and of points at random.
#[test]
fn distances_of_blocks_are_the_least_of_all_triangles() {
    let mut random = Random(11);
    let turn = DAffine3::from_rotation_translation(DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.7, 0.2), DVec3::X);
    let turned = |(positions, triangles): (Vec<Vec3>, Vec<[u32; 3]>)| {
        (positions.iter().map(|p| turn.transform_point3(p.as_dvec3()).as_vec3()).collect::<Vec<Vec3>>(), triangles)
    };
    // Triangles of all shapes, some of them of no area.
    let soup = |random: &mut Random| {
        let corners = |random: &mut Random| {
            let (a, size) = (random.point(1.0), [0.02, 0.3][usize::from(random.next() < 0.2)]);
            let [b, c] = [a + random.point(size), a + random.point(size)];
            let c = if random.next() < 0.1 { 0.5 * (a + b) } else { c };
            [a, b, c].map(DVec3::as_vec3)
        };
        let positions: Vec<Vec3> = (0..900).flat_map(|_| corners(random)).collect();
        (positions, (0..900).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect::<Vec<[u32; 3]>>())
    };
    for (positions, triangles) in [torus_triangles(24), turned(torus_triangles(20)), soup(&mut random)] {
        let leaf = MeshLeaf::new(&positions, &triangles, None, None, &Run::default()).unwrap();
        let corners: Vec<[DVec3; 3]> =
            triangles.iter().map(|triangle| triangle.map(|v| positions[v as usize].as_dvec3())).collect();
        for n in 0..48 {
            let foot = leaf.nearest(random.point(2.0)).unwrap().point;
            let step = [0.004, 0.03, 0.2, 2.0][n % 4] * (0.5 + random.next());
            let start = foot - 4.0 * step + random.point(2.0 * step);
            let at = |k: usize| start + step * DVec3::new((k % 8) as f64, (k / 8 % 8) as f64, (k / 64) as f64);
            let strewn = n % 12 == 11;
            let points: Vec<Vec3> =
                (0..CHUNK).map(|k| if strewn { random.point(2.0) } else { at(k) }.as_vec3()).collect();
            let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f32>>());
            let mut out = vec![0.0_f32; CHUNK];
            let placement = &Placement::IDENTITY;
            leaf.lanes32(Chunk { points: columns.each_ref().map(|column| &column[..]), placement, out: [&mut out] });
            for k in (n % 5..CHUNK).step_by(5) {
                let p = points[k].as_dvec3();
                let least = corners.iter().map(|t| triangle_distance(p, *t)).fold(f64::INFINITY, f64::min);
                // Where the surface goes on across an opening, that is nearer.
                let found = f64::from(out[k].abs());
                let is_right = (found - least).abs() <= leaf.roundoff(20.0) || leaf.is_open() && found < least;
                assert!(is_right, "{found} for {least} at {p}");
                assert!(leaf.is_open() || (leaf.nearest(p).unwrap().distance - least).abs() < 1e-6);
            }
            if !leaf.is_open() {
                // What a point has does not depend on those beside it.
                let alone = columns.each_ref().map(|column| vec![column[n]; CHUNK]);
                let mut single = vec![0.0_f32; CHUNK];
                let points = alone.each_ref().map(|column| &column[..]);
                leaf.lanes32(Chunk { points, placement, out: [&mut single] });
                assert_eq!(single[0], out[n]);
            }
        }
    }
}

/// A plate of two triangles a side, turned.
fn plate() -> (MeshLeaf, DQuat) {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.8);
    let at = |c: usize| DVec3::new([-4.0, 4.0][c & 1], [-3.0, 3.0][c >> 1 & 1], [-0.5, 0.5][c >> 2]);
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let positions: Vec<Vec3> = (0..8).map(|c| (turn * at(c)).as_vec3()).collect();
    let triangles: Vec<[u32; 3]> = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    (MeshLeaf::new(&positions, &triangles, None, None, &Run::default()).unwrap(), turn)
}

#[test]
fn flat_zones_close_to_a_face_have_a_sign() {
    let (leaf, turn) = plate();
    let zone = |height: f64, half: DVec3| {
        Zone::of_frame(turn * DVec3::new(0.1, 0.2, height), DMat3::from_quat(turn) * DMat3::from_diagonal(half))
    };
    for by in [0.1, 1e-2, 1e-3, 1e-4] {
        let half = DVec3::new(3.0, 2.0, 0.4 * by);
        let (above, below) = (leaf.range(&zone(0.5 + by, half)), leaf.range(&zone(0.5 - by, half)));
        assert!(above.hi() < -0.5 * by && above.lo() < -by, "{above:?} at {by}");
        assert!(below.lo() > 0.5 * by && below.hi() > 0.5 - 1e-6, "{below:?} at {by}");
        assert!(leaf.narrowed(&zone(0.5 + by, half)).is_some());
        let across = leaf.range(&zone(0.5, half));
        assert!(across.lo() < 0.0 && across.hi() > 0.0, "{across:?}");
    }
    // Beyond the rim of a face its plane goes on, and the plate does not.
    let beside = leaf.range(&zone(0.5, DVec3::new(5.0, 4.0, 0.0)));
    assert!(beside.lo() < 0.0 && beside.hi() > 0.0, "{beside:?}");
}

#[test]
fn what_enters_a_zone_does_not_leave_it() {
    let mut random = Random(5);
    let (mut found, mut crossed) = (0, 0);
    for leaf in [torus(16, 0), plate().0] {
        let size = 0.5 * leaf.bounds_under(&DAffine3::IDENTITY).longest_side();
        for _ in 0..600 {
            let (centre, half) = (random.point(size), random.point(0.1 * size).abs());
            let zone = Zone::of_bounds(&Bounds::from_center(centre, half));
            let middle = leaf.inward(&zone).unwrap_or(random.point(1.0).normalize());
            let way = Way { middle, sway: 0.1 };
            if leaf.enters(&zone, &[way], 0.0) == 0 {
                continue;
            }
            found += 1;
            for _ in 0..8 {
                let from = centre + random.point(1.0) * half;
                let along = middle + 0.1 * random.point(0.57);
                let to = from + along * random.next() * size;
                if (to - centre).abs().cmple(half).all() {
                    let [a, b] = [from, to].map(|p| leaf.value(p.to_array()));
                    assert!(a <= 0.0 || b >= 0.0, "{a} at {from}, {b} at {to}");
                    crossed += usize::from(a < 0.0 && b > 0.0);
                }
            }
        }
    }
    assert!(found > 200 && crossed > 5, "{found}, {crossed}");
    // Along a face it is neither entered nor left, if rounding does not tell otherwise, and against
    // it, it is left.
    let (plate, turn) = plate();
    let zone = Zone::of_bounds(&Bounds::from_center(turn * DVec3::new(0.1, 0.2, 0.5), DVec3::splat(0.01)));
    let ways = [-DVec3::Z, DVec3::X, DVec3::Z].map(|way| Way { middle: turn * way, sway: 0.0 });
    assert_eq!(plate.enters(&zone, &ways, 0.0) & 0b101, 1);
}

#[test]
fn ranges_hold_where_open() {
    let leaf = torus(16, 200);
    assert!(leaf.is_open());
    let mut random = Random(3);
    let mut certain = 0;
    for _ in 0..400 {
        let (centre, half) = (random.point(1.6), random.point(0.15).abs());
        let bounds = Bounds::from_center(centre, half);
        let range = leaf.range(&Zone::of_bounds(&bounds));
        certain += usize::from(range.lo() > 0.0 || range.hi() < 0.0);
        for _ in 0..20 {
            let p = bounds.min + DVec3::new(random.next(), random.next(), random.next()) * bounds.size();
            let value = leaf.value(p.to_array());
            assert!(range.contains(value), "{value} is not in {range:?}");
            // The value changes by at most 1 a length unit, as far as boxes of the rim agree.
            let q = p + random.point(1e-3);
            let changed = (leaf.value(q.to_array()) - value).abs();
            assert!(changed < 2.0 * p.distance(q) + 1e-6, "{changed} over {}", p.distance(q));
        }
    }
    assert!(certain > 200, "{certain}");
    // Nothing inside is outside of the box.
    let bounds = leaf.bounds_under(&DAffine3::IDENTITY);
    for _ in 0..4000 {
        let p = random.point(3.0);
        assert!(bounds.contains(p) || leaf.value(p.to_array()) < 0.0);
    }
}

/// At the end of what single precision holds, where a leaf is refused when it is checked.
#[test]
fn sides_of_the_largest_have_no_nan() {
    let (positions, triangles) = torus_triangles(16);
    for size in [1e11_f32, 1e30, 2.4e38] {
        let large: Vec<Vec3> = positions.iter().map(|p| *p * size).collect();
        let leaf = MeshLeaf::new(&large, &triangles, None, None, &Run::default()).unwrap();
        assert_eq!(leaf.check().is_err(), size > 1e12);
        let mut random = Random(5);
        let points: Vec<Vec3> = (0..4 * CHUNK).map(|_| random.point(1.4).as_vec3() * size).collect();
        let columns = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f32>>());
        let mut out = vec![0.0_f32; points.len()];
        let columns = columns.each_ref().map(|column| &column[..]);
        leaf.lanes32(Chunk { points: columns, placement: &Placement::IDENTITY, out: [&mut out] });
        for (p, value) in points.iter().zip(&out) {
            let exact = leaf.value(p.as_dvec3().to_array());
            let is_near = leaf.nearest(p.as_dvec3()).unwrap().distance < 1e-5 * f64::from(size);
            assert!(!value.is_nan() && (is_near || (*value > 0.0) == (exact > 0.0)), "{value} for {exact} at {p}");
        }
    }
}
