//! The leaf: values, gradients, ranges.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::tests::{Random, built, cuboid, sphere};
use super::{Patch, SurfaceDistance};
use crate::kernel::CHUNK;
use crate::{AnyField, Bounds, Chunk, Cuboid, Dual, Layer, Placement, Sphere, VALUE_LIMIT, Way, Zone};

/// A unit sphere of patches as a leaf.
fn ball(n: usize) -> SurfaceDistance {
    let sign: Arc<dyn AnyField> = Arc::new(Sphere { radius: 1.0 });
    SurfaceDistance::new(built(&sphere(n, true)), sign, 2e-4, None, Bounds::new(DVec3::NEG_ONE, DVec3::ONE))
}

fn slab(half: DVec3) -> SurfaceDistance {
    let sign: Arc<dyn AnyField> = Arc::new(Cuboid { size: 2.0 * half });
    SurfaceDistance::new(built(&cuboid(half)), sign, 0.0, None, Bounds::new(-half, half))
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

/// Values of a chunk on lanes.
fn values(field: &dyn AnyField, columns: &[Vec<f32>; 3], placement: &Placement) -> Vec<f32> {
    let mut out = vec![0.0; columns[0].len()];
    let points = columns.each_ref().map(|column| &**column);
    field.lanes32(Chunk { points, placement, out: [&mut out] });
    out
}

/// Chunks are filled up with copies of their last point: these are not searched for, and told.
#[test]
fn copies_of_the_last_point_have_its_value() {
    let mut random = Random(7);
    for field in [ball(5), slab(DVec3::new(0.5, 0.25, 0.75))] {
        for count in [1, 2, 7, 8, 9, 40, 63] {
            let own = columns(&mut random, 3.0, count);
            let filled = own.each_ref().map(|column| {
                let copies = vec![column[count - 1]; CHUNK - count];
                [&column[..], &copies].concat()
            });
            let lanes = values(&field, &filled, &Placement::IDENTITY);
            let mut slopes = [(); 4].map(|()| vec![0.0f32; CHUNK]);
            let points = filled.each_ref().map(|column| &**column);
            let out = slopes.each_mut().map(|column| &mut **column);
            field.gradients(Chunk { points, placement: &Placement::IDENTITY, out });
            for i in 0..CHUNK {
                let at = i.min(count - 1);
                let value = AnyField::value(&field, [0, 1, 2].map(|axis| f64::from(own[axis][at])));
                assert!((f64::from(lanes[i]) - value).abs() <= 2.0 * field.roundoff(3.0), "{i} of {count}");
                let same = slopes.iter().all(|column| column[i] == column[at]);
                assert!(same && (slopes[0][i] - lanes[i]).abs() <= 1e-4, "{i} of {count}");
            }
        }
    }
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
        DQuat::from_rotation_x(0.7),
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
        for round in 0..400 {
            // Some are larger than the surface, and some of these are far away.
            let size = if round % 4 == 0 { 2f64.powf(10.0 * random.next()) } else { 0.3 * random.next() };
            let centre = random.point(if size > 1.0 { 3.0 * size } else { 1.5 });
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
fn zones_that_are_larger_than_the_surface_are_told_by_its_box() {
    let half = DVec3::new(0.5, 0.25, 0.75);
    let field = slab(half);
    let about = |centre: DVec3| Zone::of_bounds(&Bounds::from_center(centre, DVec3::splat(8.0)));
    assert!(field.range(&about(DVec3::new(9.0, 0.0, 0.0))).hi() < -0.49);
    // Both sides are in it.
    let around = field.range(&about(DVec3::X));
    assert!(around.contains(half.min_element()) && around.contains(-10.0));
    assert!(field.narrowed(&about(DVec3::splat(20.0))).is_some_and(|leaf| leaf.value([20.0; 3]) < 0.0));
}

#[test]
fn ranges_over_turned_zones_hold_samples_and_see_their_sides() {
    let mut random = Random(11);
    for field in [ball(4), slab(DVec3::new(0.5, 0.25, 0.75))] {
        for round in 0..300 {
            let size = 0.5 * random.next();
            let mut axes = DMat3::from_cols(random.point(size), random.point(size), random.point(size));
            if round % 2 == 0 {
                axes.z_axis = DVec3::ZERO;
            }
            let zone = Zone::of_frame(random.point(1.5), axes).inflated(0.01 * random.next());
            let range = field.range(&zone);
            for _ in 0..20 {
                let p = zone.centre + axes * random.point(1.0);
                assert!(range.contains(AnyField::value(&field, p.to_array())), "{p} not in {range:?}");
            }
        }
    }
    // A plate across an edge: no plane of the surface is between them, nor one along the axes.
    let half = 0.5 * DVec3::ONE;
    let normal = DVec3::new(1.0, 0.0, 1.0).normalize();
    for (away, is_apart) in [(0.02, true), (-0.02, false)] {
        let axes = DMat3::from_cols(normal.cross(DVec3::Y), DVec3::Y, DVec3::ZERO);
        let zone = Zone::of_frame(DVec3::new(0.5, 0.0, 0.5) + away * normal, axes);
        assert_eq!(slab(half).range(&zone).hi() < 0.0, is_apart, "{away}");
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

#[test]
fn between_patches_and_the_sign_the_gradient_points_inwards() {
    let sign: Arc<dyn AnyField> = Arc::new(Sphere { radius: 1.001 });
    let bounds = Bounds::new(DVec3::splat(-1.001), DVec3::splat(1.001));
    let field = SurfaceDistance::new(built(&sphere(24, true)), sign, 2e-3, None, bounds);
    let mut random = Random(29);
    for by in [-3e-3, -1e-3, 2e-4, 5e-4, 9e-4, 1.1e-3, 3e-3] {
        let outwards = random.point(1.0).normalize();
        let p = (1.0 + by) * outwards;
        let slope = DVec3::from_array(AnyField::dual(&field, Dual::point(p.to_array())).d);
        assert!(slope.dot(-outwards) > 0.99, "{slope} at {p}");
        let columns = p.to_array().map(|c| vec![c as f32; CHUNK]);
        let mut out = [(); 4].map(|()| vec![0.0f32; CHUNK]);
        let [value, dx, dy, dz] = &mut out;
        let points = columns.each_ref().map(|column| &**column);
        field.gradients(Chunk { points, placement: &Placement::IDENTITY, out: [value, dx, dy, dz] });
        let slope = DVec3::new(out[1][0].into(), out[2][0].into(), out[3][0].into());
        assert!(slope.dot(-outwards) > 0.99, "{slope} at {p} on lanes");
    }
}

#[test]
fn along_ways_that_are_told_values_rise() {
    let (mut random, mut told) = (Random(29), [0; 2]);
    for (which, field) in [ball(16), slab(DVec3::new(0.7, 0.5, 0.05))].iter().enumerate() {
        for number in 0..4000 {
            let centre = random.point(1.6);
            let half = random.point(f64::powi(0.5, 1 + number % 6)).abs();
            let zone = Zone::of_bounds(&Bounds::from_center(centre, 2.0 * half));
            let slope = DVec3::from_array(field.dual(Dual::point(centre.to_array())).d);
            let way = Way { middle: slope + random.point(0.5), sway: [0.0, 0.3][number as usize % 2] };
            if field.rises(&zone, &[way]) == 0 {
                continue;
            }
            told[which] += 1;
            for _ in 0..20 {
                let p = centre + half * random.point(1.0);
                let aside = random.point(1.0).clamp_length_max(1.0);
                let Dual { v, d } = field.dual(Dual::point(p.to_array()));
                // At the surface the side is only known to within the error.
                if v.abs() <= field.error() {
                    continue;
                }
                let slope = DVec3::from_array(d);
                let along = slope.dot(way.middle + way.sway * aside);
                assert!(along > -1e-3, "{which}: {way:?} at {p}, {along} where it is {v}");
            }
        }
    }
    assert!(told.iter().all(|told| *told > 1000), "{told:?}");
}

/// Beyond the region of its patches a sign may change where none is near.
#[test]
fn beyond_their_region_patches_do_not_tell_the_sign() {
    // The upper half of a ball's surface.
    let whole = ball(16);
    let (upper, size) = (Bounds::new(DVec3::new(-2.0, -2.0, 0.0), DVec3::splat(2.0)), DVec3::splat(1.8));
    let half: Vec<Patch> = sphere(16, true).into_iter().filter(|patch| patch.bounds().max.z > 0.0).collect();
    let field = SurfaceDistance::new(
        built(&half),
        whole.whole_sign.clone(),
        2e-4,
        None,
        Bounds::from_center(DVec3::ZERO, DVec3::splat(2.0)),
    );
    let field = field.within(upper);
    let mut random = Random(41);
    let mut certain = 0;
    for number in 0..4000 {
        let (centre, half) = (random.point(1.0) * size, random.point(f64::powi(0.5, 1 + number % 4)).abs());
        let zone = Zone::of_bounds(&Bounds::from_center(centre, 2.0 * half));
        let (range, narrowed) = (field.range(&zone), field.narrowed(&zone));
        certain += usize::from(range.lo() > 0.0 || range.hi() < 0.0);
        let slope = DVec3::from_array(field.dual(Dual::point(centre.to_array())).d);
        let is_told = field.rises(&zone, &[Way { middle: slope, sway: 0.0 }]) == 1;
        let own = centre + half * random.point(1.0);
        let layers = field.layers(&zone, field.value(own.to_array()));
        let is_in = |layer: &Layer| (layer.low - 1e-6..layer.high + 1e-6).contains(&layer.normal.dot(own));
        assert!(layers.is_none_or(|layers| layers.iter().any(is_in)), "{own} in no layer of {zone:?}");
        for _ in 0..20 {
            let p = (centre + half * random.point(1.0)).to_array();
            let value = field.value(p);
            // On one line along the way, as far as it is in the zone.
            let q = DVec3::from_array(p) + 0.3 * half.min_element() * random.next().abs() * slope;
            if is_told && ((q - centre).abs() - half).max_element() < 0.0 {
                assert!(field.value(q.to_array()) >= value - 1e-3, "{value} at {p:?} falls along {slope}");
            }
            assert!(range.inflate(1e-9).contains(value), "{value} at {p:?} not in {range:?}");
            if let Some(narrowed) = &narrowed {
                assert!((narrowed.value(p) - value).abs() < 1e-9, "{value} at {p:?}, narrowed {}", narrowed.value(p));
            }
        }
    }
    assert!(certain > 1000, "{certain}");
}

/// What is above a level is not left along ways that are told, whatever the value is elsewhere.
#[test]
fn along_ways_that_are_told_a_level_is_entered() {
    let (mut random, mut told, mut more) = (Random(31), 0, 0);
    for field in [ball(16), slab(DVec3::new(0.7, 0.5, 0.3))] {
        for number in 0..6000 {
            let centre = random.point(1.4);
            let half = random.point(f64::powi(0.5, 2 + number % 5)).abs()
                * if number % 2 == 0 { DVec3::ONE } else { DVec3::new(1.0, 1.0, 0.0) };
            let zone = Zone::of_bounds(&Bounds::from_center(centre, 2.0 * half));
            let value = |p: DVec3| field.value(p.to_array());
            // Between the values at two points of the zone.
            let level = 0.5 * (value(centre + half * random.point(1.0)) + value(centre + half * random.point(1.0)));
            let slope = DVec3::from_array(field.dual(Dual::point(centre.to_array())).d);
            let way = Way { middle: slope + random.point(0.7), sway: 0.0 };
            if field.enters(&zone, &[way], level) == 0 {
                continue;
            }
            told += 1;
            more += usize::from(field.rises(&zone, &[way]) == 0);
            let mut p = centre + half * random.point(1.0);
            let mut last = f64::NEG_INFINITY;
            let step = 0.1 * half.max_element() * way.middle.normalize();
            for _ in 0..10 {
                if ((p - centre).abs() - half).max_element() > 1e-12 {
                    break;
                }
                let off = 2.0 * field.error() + 1e-6;
                assert!(
                    last < level + off || value(p) > level - off,
                    "{way:?} at {p}, {last} to {}, {level}",
                    value(p)
                );
                last = last.max(value(p));
                p += step;
            }
        }
    }
    assert!(told > 1500 && more > 100, "{told} {more}");
}

/// Beside a corner of a room feet leap from the floor to the wall, and above a level there is only
/// the wall.
#[test]
fn feet_that_are_farther_than_a_level_do_not_count() {
    let field = slab(DVec3::new(0.7, 0.5, 0.3));
    // Within the slab the level .1 is a box; near its lower edge, a little above its floor.
    let zone = Zone::of_bounds(&Bounds::from_center(DVec3::new(0.0, 0.4, -0.1999), DVec3::new(0.02, 0.02, 0.0)));
    let inwards = Way { middle: DVec3::NEG_Y, sway: 0.0 };
    assert_eq!(field.enters(&zone, &[inwards], 0.1), 1);
    // Below the floor it is neither entered nor left.
    assert_eq!(field.rises(&zone, &[Way { middle: DVec3::Y, sway: 0.0 }]), 0);
}

/// Feet on an edge are between two faces, but away from either one's normal.
#[test]
fn beside_edges_ways_are_told_by_where_feet_are() {
    let field = slab(DVec3::new(0.7, 0.5, 0.3));
    let zone = Zone::of_bounds(&Bounds::from_center(DVec3::new(1.0, 0.9, 0.0), DVec3::splat(0.02)));
    // At 70° from the way to the edge: along it one face's distance falls.
    let way = |degrees: f64| {
        let to_edge = DVec3::new(-0.6, -0.8, 0.0);
        Way { middle: DQuat::from_rotation_z(degrees.to_radians()) * to_edge, sway: 0.0 }
    };
    assert_eq!(field.rises(&zone, &[way(0.0), way(70.0), way(-70.0), way(100.0)]), 0b111);
}

/// A rectangle beside a face is as far from it all over, whatever its size.
#[test]
fn ranges_over_rectangles_along_a_face_are_its_distance() {
    let field = slab(DVec3::new(0.7, 0.5, 0.3));
    for (height, value) in [(0.35, -0.05), (0.31, -0.01), (0.28, 0.02)] {
        let axes = DMat3::from_cols(0.1 * DVec3::X, 0.1 * DVec3::Y, DVec3::ZERO);
        let range = field.range(&Zone::of_frame(DVec3::new(0.5, 0.0, height), axes));
        assert!(range.contains(value) && range.width() < 1e-5, "{height}: {range:?}");
    }
}
