//! Polygons against going through all their edges.

use super::*;
use crate::Placement;
use crate::kernel::CHUNK;

/// Numbers that depend on the seed alone, from 0 to 1 (an additive and a multiplicative step).
struct Numbers(u64);

impl Numbers {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, half: f64) -> DVec2 {
        half * (2.0 * DVec2::new(self.unit(), self.unit()) - 1.0)
    }
}

/// A contour round `centre` with spikes, `n` points.
fn star(numbers: &mut Numbers, centre: DVec2, n: usize, least: f64, most: f64) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = (0..n)
        .map(|i| {
            let angle = std::f64::consts::TAU * (i as f64 + 0.9 * numbers.unit()) / n as f64;
            centre + (least + (most - least) * numbers.unit()) * DVec2::from_angle(angle)
        })
        .collect();
    if numbers.unit() < 0.5 {
        points.reverse();
    }
    points
}

/// A ring with an island in its hole.
fn islands(numbers: &mut Numbers, n: usize) -> Vec<Vec<DVec2>> {
    // So that few points make a contour that stays clear of the next, there is one of them.
    let rings = [(2.4, 3.0), (1.6, 2.0), (0.5, 1.2)];
    let rings = if n < 12 { &rings[..1] } else { &rings };
    rings.iter().map(|(least, most)| star(numbers, DVec2::new(0.3, -0.2), n, *least, *most)).collect()
}

/// The distance by going through all edges, its sign by the number of crossings of a ray.
fn direct(contours: &[Vec<DVec2>], p: DVec2) -> f64 {
    let (mut least, mut inside) = (f64::INFINITY, false);
    for points in contours {
        for (i, &a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            least = least.min((p - a - t * (b - a)).length());
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
    }
    if inside { least } else { -least }
}

fn value(polygon: &Polygon, p: DVec2) -> f64 {
    AnyField::value(polygon, [p.x, p.y, 7.0])
}

fn zone(centre: DVec2, half: DVec2) -> Zone {
    Zone::of_bounds(&Bounds::from_center(centre.extend(0.5), half.extend(1.0)))
}

fn lanes(field: &dyn AnyField, points: &[DVec2]) -> Vec<f64> {
    let placement = Placement::IDENTITY;
    let mut values = Vec::new();
    for part in points.chunks(CHUNK) {
        let column = |axis: usize| {
            let mut column = vec![0.0f32; CHUNK];
            for (to, p) in column.iter_mut().zip(part) {
                *to = p[axis] as f32;
            }
            column
        };
        let (x, y, z, mut out) = (column(0), column(1), vec![0.0; CHUNK], vec![0.0; CHUNK]);
        field.lanes32(Chunk { points: [&x, &y, &z], placement: &placement, out: [&mut out] });
        values.extend(out[..part.len()].iter().map(|v| f64::from(*v)));
    }
    values
}

#[test]
fn values_are_distances() {
    let mut numbers = Numbers(1);
    for n in [3, 4, 7, 11, 40, 300] {
        let contours = islands(&mut numbers, n);
        let polygon = Polygon::of_points(&contours);
        assert_eq!(polygon.check(), Ok(()));
        let mut points: Vec<DVec2> = (0..400).map(|_| numbers.point(4.0)).collect();
        // Near corners, where signs are hardest, and far away.
        for (corner, i) in contours.iter().flatten().zip(0..300) {
            let direction = DVec2::from_angle(f64::from(i));
            points.extend([1e-3, 1e-6, 1e2].map(|d| *corner + d * direction));
        }
        let points: Vec<DVec2> = points.iter().map(|p| p.as_vec2().as_dvec2()).collect();
        let on_lanes = lanes(&polygon, &points);
        for (p, lane) in points.into_iter().zip(on_lanes) {
            let want = direct(&contours, p);
            let got = value(&polygon, p);
            assert!((got - want).abs() < 1e-13 * (10.0 + want.abs()), "{n} at {p}: {got}, want {want}");
            assert!((lane - want).abs() < 4e-6 * (3.0 + want.abs()), "{n} at {p}: {lane} on lanes, want {want}");
        }
    }
}

#[test]
fn needles_keep_their_sign_on_lanes() {
    for width in [1e-1, 1e-3, 1e-5] {
        // A needle that points out, and one that points in.
        let out = vec![DVec2::new(-1.0, -width), DVec2::new(2.0, 0.0), DVec2::new(-1.0, width)];
        let inward = vec![
            DVec2::new(-1.0, -1.0),
            DVec2::new(1.0, -1.0),
            DVec2::new(1.0, -width),
            DVec2::new(-0.5, 0.0),
            DVec2::new(1.0, width),
            DVec2::new(1.0, 1.0),
            DVec2::new(-1.0, 1.0),
        ];
        let mut numbers = Numbers(2);
        for (contour, tip) in [(out, DVec2::new(2.0, 0.0)), (inward, DVec2::new(-0.5, 0.0))] {
            let polygon = Polygon::of_points(std::slice::from_ref(&contour));
            let points: Vec<DVec2> = (0..2000)
                .map(|_| (tip + numbers.point(0.3)).as_vec2().as_dvec2())
                .chain([tip - 0.1 * DVec2::Y])
                .collect();
            for (p, lane) in points.iter().zip(lanes(&polygon, &points)) {
                let want = direct(std::slice::from_ref(&contour), *p);
                assert!((value(&polygon, *p) - want).abs() < 1e-14, "{width} at {p}");
                assert!((lane - want).abs() < 2e-6, "{width} at {p}: {lane}, want {want}");
            }
        }
    }
}

#[test]
fn narrowed_leaves_have_the_same_values_in_their_zone() {
    let mut numbers = Numbers(3);
    let (mut few, mut tried) = (0, 0);
    for n in [4, 60, 1700] {
        let polygon = Polygon::of_points(&islands(&mut numbers, n));
        for i in 0..120 {
            let centre = numbers.point(3.3);
            let half = 10f64.powf(-3.0 * numbers.unit()) * DVec2::new(1.0, 0.2 + 0.8 * numbers.unit());
            let region = zone(centre, half);
            let range = AnyField::range(&polygon, &region);
            let narrowed = AnyField::narrowed(&polygon, &region);
            tried += 1;
            few += usize::from(narrowed.is_some());
            let own = narrowed.as_ref().map(|leaf| leaf.range(&region));
            let part = zone(centre + 0.5 * half, 0.5 * half);
            let again = narrowed.as_ref().and_then(|leaf| leaf.narrowed(&part));
            for _ in 0..30 {
                let p = centre + half * numbers.point(1.0);
                let want = value(&polygon, p);
                assert!(range.contains(want), "{n} {i}: {want} at {p} not in {range:?}");
                if let (Some(leaf), Some(own)) = (&narrowed, own) {
                    assert!((leaf.value([p.x, p.y, 0.0]) - want).abs() < 1e-14, "{n} {i} at {p}");
                    assert!(own.contains(want), "{n} {i}: {want} at {p} not in {own:?}");
                }
                if let Some(leaf) = &again {
                    let p = centre + 0.5 * half * (numbers.point(1.0) + 1.0);
                    assert!((leaf.value([p.x, p.y, 0.0]) - value(&polygon, p)).abs() < 1e-14, "{n} {i} twice at {p}");
                }
            }
        }
    }
    assert!(4 * few > tried, "{few} of {tried} zones are narrowed");
}

#[test]
fn ranges_over_a_side_are_tight() {
    let polygon = Polygon::new([[[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]]]);
    let range = AnyField::range(&polygon, &zone(DVec2::new(5.0, 0.3), DVec2::new(0.25, 0.25)));
    assert!((range.lo() - 0.05).abs() < 1e-9 && range.hi() < 0.61, "{range:?}");
}

#[track_caller]
fn error(contours: &[&[[f64; 2]]]) -> String {
    let polygon = Polygon::new(contours.iter().map(|contour| contour.iter().copied()));
    assert_eq!(value(&polygon, DVec2::ZERO), -VALUE_LIMIT);
    assert_eq!(polygon.area(), 0.0);
    polygon.check().expect_err("something is wrong").to_string()
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    assert!(error(&[]).starts_with("number of contours is 0"));
    assert_eq!(error(&[&square, &[[1.0, 1.0], [2.0, 2.0]]]), "number of points of contour 1 is 2, allowed: 3 or more");
    let text = error(&[&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0]]]);
    assert!(text.starts_with("contour 0, point 1, x is NaN"), "{text}");
    let text = error(&[&[[0.0, 0.0], [1.0, 0.0], [1.0, 1e-10], [0.0, 1.0]]]);
    assert!(text.starts_with("length of edge 1 of contour 0, at (1, 0), is 0.0000000001, allowed"), "{text}");
    // A bow tie, contours that cross, and such as leave nothing.
    let text = error(&[&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]]);
    assert!(text.starts_with("where edge 0 of contour 0 crosses edge 2 of contour 0, at (1, 1), the dist"), "{text}");
    let text = error(&[&square, &[[1.0, 1.0], [5.0, 2.0], [1.0, 3.0]]]);
    assert!(text.contains("edge 1 of contour 0 crosses edge 0 of contour 1, at (4, 1.75)"), "{text}");
    let text = error(&[&square, &square]);
    assert!(text.starts_with("area is 0, allowed: more than 0: every edge lies on another one"), "{text}");
    let text = error(&[&square, &[[4.0, 4.0 - 1e-10], [6.0, 3.0], [6.0, 3.5]]]);
    assert!(text.starts_with("length of a part of edge 1 of contour 0, which a corner parts at (4, 3.99"), "{text}");
}

/// The area, and how many edges there are, of contours that touch.
#[track_caller]
fn touching(contours: &[&[[f64; 2]]]) -> (f64, usize) {
    let polygon = Polygon::new(contours.iter().map(|contour| contour.iter().copied()));
    assert_eq!(polygon.check(), Ok(()));
    (polygon.area(), polygon.edge_count())
}

#[test]
fn contours_may_touch() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    // At a corner; a corner on an edge; a hole that touches the outline; two loops in one contour.
    assert_eq!(touching(&[&square, &[[4.0, 4.0], [6.0, 4.0], [6.0, 6.0]]]), (18.0, 7));
    assert_eq!(touching(&[&square, &[[4.0, 2.0], [6.0, 1.0], [6.0, 3.0]]]), (18.0, 8));
    assert_eq!(touching(&[&square, &[[0.0, 0.0], [2.0, 1.0], [1.0, 2.0]]]), (14.5, 7));
    let loops = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 4.0], [2.0, 2.0], [0.0, 2.0]];
    assert_eq!(touching(&[&loops]), (8.0, 8));
    // Side by side, along a whole side, and along a part of one.
    assert_eq!(touching(&[&square, &[[4.0, 0.0], [6.0, 0.0], [6.0, 4.0], [4.0, 4.0]]]), (24.0, 6));
    assert_eq!(touching(&[&square, &[[4.0, 1.0], [6.0, 2.0], [4.0, 3.0]]]), (18.0, 7));
    // A spike without width, and a bridge to a hole.
    assert_eq!(touching(&[&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 2.0]]]), (1.0, 3));
    let mut bridged = square.to_vec();
    bridged.extend([[0.0, 0.0], [1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0]]);
    assert_eq!(touching(&[&bridged]), (12.0, 8));
    let bridged = Polygon::new([bridged]);
    // What is left of the bridge is nothing.
    assert_eq!(value(&bridged, DVec2::new(0.5, 0.5)), 0.5);
    assert_eq!(value(&bridged, DVec2::new(2.0, 2.5)), -0.5);
}

/// Whether two edges cross between their ends; of whole numbers, without rounding.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

#[test]
fn random_contours_on_a_grid_are_even_odd() {
    let mut numbers = Numbers(5);
    let (mut good, mut bad) = (0, 0);
    for _ in 0..40_000 {
        let grid = 3.0 + 4.0 * numbers.unit();
        let count = 3 + (7.0 * numbers.unit()) as usize;
        let mut contours = vec![Vec::new(); 1 + (2.0 * numbers.unit()) as usize];
        for contour in &mut contours {
            *contour = (0..count).map(|_| DVec2::new(grid * numbers.unit(), grid * numbers.unit()).floor()).collect();
        }
        let polygon = Polygon::new(contours.iter().map(|contour| contour.iter().copied()));
        let contours = polygon.contours();
        if contours.iter().any(|contour| contour.len() < 3) {
            continue;
        }
        let edges: Vec<[DVec2; 2]> = (contours.iter())
            .flat_map(|points| (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]))
            .collect();
        let crosses = edges.iter().any(|one| edges.iter().any(|other| cross(*one, *other)));
        match polygon.check() {
            Err(error) if error.parameter == "area" => {}
            Err(_) => {
                assert!(crosses, "{contours:?}");
                bad += 1;
            }
            Ok(()) => {
                good += 1;
                for _ in 0..10 {
                    let p = grid * DVec2::new(numbers.unit(), numbers.unit()) - 0.1;
                    let (want, got) = (direct(contours, p), value(&polygon, p));
                    assert_eq!(want > 0.0, got > 0.0, "{contours:?} at {p}");
                    // Of the contours some edges are no border.
                    assert!(got.abs() >= want.abs() - 1e-12, "{contours:?} at {p}: {got}, {want}");
                }
                // What is on the left of an edge is inside; edges cross only where they are no
                // border.
                let edges = &polygon.border().edges;
                let ends = |edge: &Edge| [edge.start, edge.end];
                assert!(!edges.iter().any(|one| edges.iter().any(|other| cross(ends(one), ends(other)))));
                for edge in edges {
                    let on_it = edge.start.lerp(edge.end, 0.4317);
                    let [inner, outer] = [1e-4, -1e-4].map(|by| direct(contours, on_it + by * edge.along.perp()));
                    assert!(inner > 0.0 && outer < 0.0, "{contours:?}: {edge:?}");
                }
            }
        }
    }
    assert!(good > 2000 && bad > 2000, "{good} good, {bad} bad");
}

#[test]
fn long_edges_side_by_side_are_swept() {
    // Boxes of the edges all overlap.
    let count = 20_000;
    let spike = |i: usize| {
        let radius = if i.is_multiple_of(2) { 1.0 } else { 1000.0 };
        radius * DVec2::from_angle(std::f64::consts::TAU * i as f64 / count as f64)
    };
    let polygon = Polygon::new([(0..count).map(spike)]);
    assert_eq!((polygon.check(), polygon.edge_count()), (Ok(()), count));
    let crossed = Polygon::new([(0..count).map(|i| if i == 777 { spike(i + 4) } else { spike(i) })]);
    assert!(crossed.check().is_err());
}

#[test]
fn sweeping_is_cancelled_and_tells_how_far_it_is() {
    use std::sync::{Arc, Mutex};
    let mut numbers = Numbers(6);
    let contour = star(&mut numbers, DVec2::ZERO, 30_000, 1.0, 9.0);
    let polygon = Polygon::of_points(&[contour]);
    let run = Run::default();
    run.cancel.cancel();
    assert_eq!(AnyField::prepare(&polygon, &run), Err(Cancelled));
    let seen = Arc::new(Mutex::new(Vec::new()));
    let sink = seen.clone();
    let token = rvachev_num::CancelToken::new();
    let (cancel, stop) = (token.clone(), token);
    let progress = rvachev_num::Progress::new(move |fraction| {
        sink.lock().unwrap().push(fraction);
        if fraction > 0.5 {
            stop.cancel();
        }
    });
    assert_eq!(
        AnyField::prepare(&polygon, &Run { cancel, progress: Some(progress), ..Run::default() }),
        Err(Cancelled)
    );
    let seen = seen.lock().unwrap();
    assert!(seen.len() > 10 && seen.last().is_some_and(|last| (0.5..0.6).contains(last)), "{seen:?}");
    assert_eq!((polygon.check(), polygon.edge_count()), (Ok(()), 30_000));
}

#[test]
fn corners_in_a_line_and_repeated_ends_are_no_error() {
    let polygon = Polygon::new([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]]]);
    assert_eq!(polygon.check(), Ok(()));
    assert_eq!((polygon.edge_count(), polygon.area()), (5, 4.0));
    assert_eq!(value(&polygon, DVec2::new(1.0, 0.5)), 0.5);
    assert_eq!(value(&polygon, DVec2::new(1.0, -0.5)), -0.5);
}

#[test]
fn points_that_repeat_the_one_before_are_left_out() {
    let drawn = [[0.0, 0.0], [0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, 2.0], [2.0, 2.0], [0.0, 0.0], [0.0, 0.0]];
    let polygon = Polygon::new([drawn]);
    assert_eq!(polygon.check(), Ok(()));
    assert_eq!((polygon.edge_count(), polygon.area()), (3, 2.0));
}

/// A comb of teeth of a hundred times their width, turned.
fn comb(teeth: usize, turn: f64) -> Vec<DVec2> {
    let count = teeth as f64;
    let tooth = |k: usize| {
        let (x, y) = (k as f64, 100.0 + (k as f64).sin());
        [[x, 0.0], [x + 0.3, y], [x + 0.7, y], [x + 0.9, 0.0]]
    };
    let teeth = (0..teeth).flat_map(tooth).chain([[count, -10.0], [0.0, -10.0]]);
    teeth.map(|p| DVec2::from_angle(turn).rotate(DVec2::from_array(p))).collect()
}

/// Rays about a point, and blades that all begin at one.
fn rays(count: usize) -> Vec<DVec2> {
    let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { 100.0 };
    (0..2 * count).map(|i| radius(i) * DVec2::from_angle(3.1 * i as f64 / count as f64)).collect()
}

fn blades(count: usize) -> Vec<Vec<DVec2>> {
    let side = |k: f64| 100.0 * DVec2::from_angle(1.5 * k / count as f64);
    (0..count).map(|i| vec![DVec2::ZERO, side(i as f64), side(i as f64 + 0.5)]).collect()
}

fn bristly(count: usize) -> [Vec<Vec<DVec2>>; 5] {
    [vec![comb(count, 0.0)], vec![comb(count, 1.6)], vec![comb(count, 0.7)], vec![rays(count)], blades(count)]
}

#[test]
fn values_of_combs_and_fans_are_distances() {
    let mut numbers = Numbers(8);
    for (number, contours) in bristly(120).into_iter().enumerate() {
        let polygon = Polygon::of_points(&contours);
        assert_eq!(polygon.check(), Ok(()));
        let corners = contours.iter().flatten().flat_map(|p| [*p, *p + DVec2::X, *p - 3.0 * DVec2::Y]);
        for p in (0..400).map(|_| numbers.point(130.0)).chain(corners).collect::<Vec<_>>() {
            let (want, got) = (direct(&contours, p), value(&polygon, p));
            assert!((got - want).abs() < 1e-12, "{number} at {p}: {got}, want {want}");
        }
    }
}

/// Few edges are in boxes that are as near as the nearest edge, however many there are.
#[test]
fn values_of_combs_and_fans_look_at_few_edges() {
    let looked_at = |contours: &[Vec<DVec2>]| {
        let polygon = Polygon::of_points(contours);
        assert_eq!(polygon.check(), Ok(()));
        let corners: Vec<DVec2> = contours.iter().flatten().copied().collect();
        let mut numbers = Numbers(9);
        // About the polygon, and beside what its middle is.
        let at = |numbers: &mut Numbers| corners[(numbers.unit() * corners.len() as f64) as usize];
        let mut count = 0;
        for _ in 0..400 {
            let p = at(&mut numbers).lerp(at(&mut numbers), 1.2 * numbers.unit() - 0.1);
            let distance = value(&polygon, p).abs() * (1.0 - 1e-9);
            polygon.border().tree.within(p, distance, |_| {
                count += 1;
                true
            });
        }
        f64::from(count) / 400.0
    };
    for (number, contours) in bristly(20_000).into_iter().enumerate() {
        let count = looked_at(&contours);
        assert!(count < 100.0, "{number}: {count} edges of {}", contours.iter().flatten().count());
    }
}

/// Squares side by side, one half as high as the other, a hole in each that touches a side, all of
/// it turned, far away or not, and with corners that are off by a part of the size.
fn drawn(numbers: &mut Numbers, turn: f64, at: DVec2, off: f64) -> Vec<Vec<DVec2>> {
    let drawing: [&[[f64; 2]]; 4] = [
        &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [4.0, 4.0], [0.0, 4.0], [0.0, 3.0], [0.0, 0.0]],
        &[[4.0, 1.0], [6.0, 1.0], [6.0, 3.0], [4.0, 3.0]],
        &[[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]],
        &[[5.0, 3.0], [5.5, 2.0], [4.5, 2.0]],
    ];
    let mut point = |p: &[f64; 2]| {
        let p = DVec2::from_angle(turn).rotate(DVec2::from_array(*p)) + at;
        p + 6.0 * off * numbers.point(1.0)
    };
    drawing.iter().map(|contour| contour.iter().map(&mut point).collect()).collect()
}

#[test]
fn what_rounding_parts_is_joined() {
    let mut numbers = Numbers(10);
    for (turn, at, off) in [
        (0.0, DVec2::ZERO, 0.0),
        (0.0, DVec2::ZERO, 1e-16),
        (0.3, DVec2::ZERO, 0.0),
        (0.3, DVec2::ZERO, 1e-15),
        (0.7, DVec2::ZERO, 1e-14),
        (1.1, DVec2::new(300.0, -20.0), 1e-13),
        (1.1, DVec2::new(3e6, -2e5), 0.0),
        (2.2, DVec2::ZERO, 4e-13),
    ] {
        for round in 0..40 {
            let contours = drawn(&mut numbers, turn + 0.1 * f64::from(round), at, off);
            let turn = turn + 0.1 * f64::from(round);
            let polygon = Polygon::of_points(&contours);
            let found = (polygon.check(), polygon.edge_count());
            // Without the side in common, and that of the hole; with the parts of sides beside
            // them.
            assert_eq!(found, (Ok(()), 17), "{turn} {at} {off}");
            let slack = 1e-11 + 1e-14 * at.length();
            assert!((polygon.area() - 18.5).abs() < 10.0 * slack, "{turn} {at} {off}: {}", polygon.area());
            for (p, want) in [([4.0, 2.0], 0.5), ([0.5, 1.5], -0.5), ([2.5, 2.0], 1.5), ([5.0, 2.5], -0.2236)] {
                let got = value(&polygon, DVec2::from_angle(turn).rotate(DVec2::from_array(p)) + at);
                assert!((got - want).abs() < slack.max(1e-4), "{turn} {at} {off}: {got} at {p:?}, want {want}");
            }
        }
    }
    // What is farther apart is apart.
    let gap = |by: f64| {
        Polygon::new([[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], {
            [[1.0 + by, 0.2], [2.0, 0.2], [2.0, 0.8], [1.0 + by, 0.8]]
        }])
    };
    let counts = [1e-14, -1e-14, 1e-12, -1e-12, 1e-10].map(|by| gap(by).edge_count());
    assert_eq!(counts, [8, 8, 8, 8, 8]);
    assert!(value(&gap(1e-12), DVec2::new(1.0, 0.5)) > 0.2 && value(&gap(1e-10), DVec2::new(1.0, 0.5)) < 1e-9);
    assert!(gap(-1e-10).check().is_err());
}

#[test]
fn what_is_nothing_but_for_rounding_is_nothing() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let twice = Polygon::new([square, square.map(|[x, y]| [x + 1e-14, y - 1e-14])]);
    assert!(twice.check().unwrap_err().to_string().starts_with("area is 0"));
    // A contour that is a point, and one that is a line.
    let point = [[1.0, 1.0], [1.0 + 1e-15, 1.0], [1.0, 1.0 + 1e-15], [1.0, 1.0]];
    let line = [[1.0, 1.0], [2.0, 1.0 + 1e-14], [3.0, 1.0], [2.0, 1.0 - 1e-14]];
    let polygon = Polygon::new([square, point, line]);
    assert_eq!((polygon.check(), polygon.edge_count(), polygon.area()), (Ok(()), 4, 16.0));
    assert_eq!(value(&polygon, DVec2::new(2.0, 1.0)), 1.0);
}
