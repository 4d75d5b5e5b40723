//! What a ring is the outline of.
//!
//! ```text
//!     .------.       .----.         .--.          _/\_
//!     |      |      (      )       /    \         \  /
//!     '------'       '----'        \    /         /_  _\
//!     outline        rounded        '--'             \/
//!                    rectangle      regular       supershape
//! ```

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use rvachev_num::order;

use super::arcs::arched;
use super::outline::Outline;
use super::sections::area;
use super::straighten::{corners, crosses, distance, fitted, uncut};
use crate::fit::linear::solved;

/// Corners of a polygon at most, and where another shape fits too.
const MOST: usize = 32;
const FEW: usize = 10;

/// How far a ring may be off on the average, in parts of its size: rounded rectangles and polygons,
/// supershapes.
const OFF: f64 = 0.02;
const OFF_SUPERSHAPE: f64 = 0.035;

/// Sides of regular polygons; 4 are a rectangle.
const SIDES: std::ops::RangeInclusive<usize> = 3..=8;

/// Repetitions of supershapes, the least share of the variance that they explain, and how nearly as
/// good the largest one must be.
const REPEATS: std::ops::RangeInclusive<u32> = 2..=24;
const EXPLAINED: f64 = 0.8;
const NEARLY: f64 = 0.02;

/// A ring that is as round as this is a circle.
const CIRCLE: f64 = 0.006;

/// Points of a ring that supershapes are fitted to.
const POINTS: usize = 96;

/// How finely rings are judged, in diagonals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grain {
    pub(super) tolerance: f64,
    /// Sides shorter than this cut corners off; 0 where corners are exact.
    pub(super) short: f64,
}

/// An outline in a plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Base {
    Outline(Outline),
    /// A rectangle whose first side is turned by an angle.
    Rounded {
        centre: DVec2,
        angle: f64,
        size: DVec2,
        radius: f64,
    },
    /// A corner is in the direction of the angle.
    Regular {
        centre: DVec2,
        angle: f64,
        sides: u32,
        radius: f64,
    },
    /// Gielis' curve of m, n₁ and n₂ = n₃.
    Supershape {
        centre: DVec2,
        angle: f64,
        m: u32,
        n: [f64; 2],
        radius: f64,
    },
}

/// What a ring may be the outline of.
pub(super) fn bases(ring: &[DVec2], grain: Grain) -> Vec<Base> {
    let mut ring = ring.to_vec();
    if area(&ring) < 0.0 {
        ring.reverse();
    }
    let size = area(&ring).sqrt();
    if size < 4.0 * grain.tolerance {
        return Vec::new();
    }
    let polygon = polygon(&ring, grain);
    let even = evenly(&ring);
    let centre = centroid(&ring);
    let mut found = Vec::new();
    if circular(&even, centre) < CIRCLE {
        return found;
    }
    let simple: Vec<(f64, Base)> =
        [regular(&polygon, size), rounded(&ring, &even, size)].into_iter().flatten().collect();
    // What is as near as the outline leaves nothing to arcs.
    let is_exact = simple.iter().any(|(off, _)| *off < grain.tolerance);
    found.extend(simple.into_iter().map(|(_, base)| base));
    let is_regular = found.iter().any(|base| matches!(base, Base::Regular { .. }));
    if found.is_empty() && polygon.len() > 4 {
        found.extend(supershape(&even, centre, size));
    }
    let most = if found.is_empty() { MOST } else { FEW };
    if !is_exact && polygon.len() > 4 {
        let outline = arched(&ring, &polygon, grain.tolerance, grain.short == 0.0);
        let is_simple = |outline: &Outline| outline.corners.len() <= MOST && !crosses(&outline.corners);
        found.extend(outline.filter(is_simple).map(Base::Outline));
    }
    if (3..=most).contains(&polygon.len()) && !is_regular && !crosses(&polygon) {
        found.push(Base::Outline(Outline::polygon(polygon)));
    }
    found
}

/// The polygon of few corners that a ring is.
pub(super) fn polygon(ring: &[DVec2], grain: Grain) -> Vec<DVec2> {
    let polygon = corners(ring, grain.tolerance.min(0.1 * area(ring).abs().sqrt()));
    if grain.short == 0.0 {
        return polygon;
    }
    let better = fitted(ring, &uncut(&polygon, grain.short), grain.tolerance);
    // Where a wall is hardly thicker than it is uncertain, its sides may change places.
    if crosses(&better) { polygon } else { better }
}

/// Points at equal distances along a ring.
fn evenly(ring: &[DVec2]) -> Vec<DVec2> {
    let next = |i: usize| ring[(i + 1) % ring.len()];
    let length: f64 = (0..ring.len()).map(|i| ring[i].distance(next(i))).sum();
    let step = length / POINTS as f64;
    let (mut points, mut passed) = (Vec::with_capacity(POINTS), 0.0);
    for i in 0..ring.len() {
        let (a, b) = (ring[i], next(i));
        let side = a.distance(b);
        while points.len() < POINTS && (points.len() as f64 + 0.5) * step <= passed + side {
            let t = ((points.len() as f64 + 0.5) * step - passed) / side.max(f64::MIN_POSITIVE);
            points.push(a.lerp(b, t));
        }
        passed += side;
    }
    points
}

fn centroid(ring: &[DVec2]) -> DVec2 {
    let from = ring[0];
    let (mut sum, mut twice) = (DVec2::ZERO, 0.0);
    for i in 0..ring.len() {
        let (a, b) = (ring[i] - from, ring[(i + 1) % ring.len()] - from);
        sum += (a + b) * a.perp_dot(b) / 3.0;
        twice += a.perp_dot(b);
    }
    from + sum / twice
}

/// How far from round points are about a centre, as a share of the radius.
fn circular(points: &[DVec2], centre: DVec2) -> f64 {
    let radius = points.iter().map(|p| p.distance(centre)).sum::<f64>() / points.len().max(1) as f64;
    let off = points.iter().map(|p| (p.distance(centre) - radius).abs()).sum::<f64>() / points.len().max(1) as f64;
    off / radius
}

/// The regular polygon of a polygon's corners, and how far it is off at most.
fn regular(polygon: &[DVec2], size: f64) -> Option<(f64, Base)> {
    let sides = polygon.len();
    if !SIDES.contains(&sides) || sides == 4 {
        return None;
    }
    let centre = polygon.iter().sum::<DVec2>() / sides as f64;
    let radius = polygon.iter().map(|p| p.distance(centre)).sum::<f64>() / sides as f64;
    // The mean of the turns that bring the corners to the first one's place.
    let sector = TAU / sides as f64;
    let first = (polygon[0] - centre).to_angle();
    let turn = |k: usize| {
        let angle = (polygon[k] - centre).to_angle() - first - sector * k as f64;
        angle - TAU * (angle / TAU).round()
    };
    let angle = first + (0..sides).map(turn).sum::<f64>() / sides as f64;
    let off = |k: usize| (centre + radius * DVec2::from_angle(angle + sector * k as f64)).distance(polygon[k]);
    let most = (0..sides).map(off).fold(0.0, f64::max);
    (most < OFF * size).then_some((most, Base::Regular { centre, angle, sides: sides as u32, radius }))
}

/// The rectangle with rounded corners whose sides are along most of a ring, and how far it is off
/// at most.
fn rounded(ring: &[DVec2], even: &[DVec2], size: f64) -> Option<(f64, Base)> {
    // Sides at right angles to each other agree in four times their angles, and those of an arc
    // cancel.
    let side = |k: usize| ring[(k + 1) % ring.len()] - ring[k];
    let fourfold = |d: DVec2| d.length() * DVec2::from_angle(4.0 * d.to_angle());
    let angle = 0.25 * (0..ring.len()).map(|k| fourfold(side(k))).sum::<DVec2>().to_angle();
    let (turn, back) = (DVec2::from_angle(angle), DVec2::from_angle(-angle));
    let local = |p: &DVec2| back.rotate(*p);
    let low = ring.iter().map(local).fold(DVec2::INFINITY, DVec2::min);
    let high = ring.iter().map(local).fold(DVec2::NEG_INFINITY, DVec2::max);
    let sides = high - low;
    let missing = (sides.x * sides.y - area(ring)).max(0.0);
    let radius = (missing / (4.0 - PI)).sqrt().min(0.5 * sides.min_element());
    let radius = if radius < OFF * size { 0.0 } else { radius };
    let middle = 0.5 * (low + high);
    let off = |p: &DVec2| {
        let q = (local(p) - middle).abs() - 0.5 * sides + radius;
        q.max(DVec2::ZERO).length() + q.max_element().min(0.0) - radius
    };
    let mean = even.iter().map(|p| off(p).abs()).sum::<f64>() / even.len().max(1) as f64;
    let most = even.iter().map(|p| off(p).abs()).fold(0.0, f64::max);
    let fits = mean < 0.5 * OFF * size && most < 3.0 * OFF * size;
    fits.then(|| (most, Base::Rounded { centre: turn.rotate(middle), angle, size: sides, radius }))
}

/// The radius of Gielis' curve at an angle.
fn gielis(m: u32, n: [f64; 2], angle: f64) -> f64 {
    let (sin, cos) = (0.25 * f64::from(m) * angle).sin_cos();
    (cos.abs().powf(n[1]) + sin.abs().powf(n[1])).powf(-1.0 / n[0])
}

/// The supershape about a centre.
fn supershape(points: &[DVec2], centre: DVec2, size: f64) -> Option<Base> {
    let polar: Vec<(f64, f64)> = points.iter().map(|p| ((*p - centre).to_angle(), (*p - centre).length())).collect();
    // Of rings that go round once, and evenly by angle.
    let mut sorted = polar.clone();
    order::rising(&mut sorted, |a| a.0);
    let count = sorted.len();
    let width = |i: usize| {
        let d = sorted[(i + 1) % count].0 - sorted[(i + count - 1) % count].0;
        0.5 * (if d < 0.0 { d + TAU } else { d })
    };
    let logs: Vec<(f64, f64, f64)> = (0..count).map(|i| (sorted[i].0, sorted[i].1.ln(), width(i))).collect();
    let mean = logs.iter().map(|(_, l, w)| l * w).sum::<f64>() / TAU;
    let variance: f64 = logs.iter().map(|(_, l, w)| (l - mean).powi(2) * w).sum();
    let explained = |m: u32| {
        let harmonic = |h: u32| {
            let (mut c, mut s) = (0.0, 0.0);
            for (angle, log, width) in &logs {
                let (sin, cos) = (f64::from(h) * angle).sin_cos();
                (c, s) = (c + (log - mean) * cos * width, s + (log - mean) * sin * width);
            }
            (c * c + s * s) / PI
        };
        (1..=4).map(|k| k * m).filter(|h| *h as usize <= POINTS / 3).map(harmonic).sum::<f64>() / variance
    };
    let all: Vec<(u32, f64)> = REPEATS.map(|m| (m, explained(m))).collect();
    let best = all.iter().map(|a| a.1).fold(0.0, f64::max);
    if best < EXPLAINED {
        return None;
    }
    let m = all.iter().rev().find(|a| a.1 >= best - NEARLY)?.0;
    let mut starts = polar.clone();
    order::rising(&mut starts, |a| a.1);
    let (least, greatest) = (starts[0], starts[starts.len() - 1]);
    let spread = (greatest.1 / least.1).ln().max(1e-3);
    let mut found: Option<(f64, Base)> = None;
    for (n2, at) in [(4.0, least), (8.0, least), (1.2, greatest)] {
        let n1 = (f64::abs(0.5 * n2 - 1.0) * std::f64::consts::LN_2 / spread).clamp(0.3, 200.0);
        let Some((off, base)) = descended(&polar, centre, m, [n1, n2, at.1, at.0]) else { continue };
        if found.as_ref().is_none_or(|f| off < f.0) {
            found = Some((off, base));
        }
    }
    found.filter(|f| f.0 < OFF_SUPERSHAPE * size).map(|f| f.1)
}

/// The curve after steps of Levenberg and Marquardt's from n₁, n₂, radius and angle; the mean
/// distance.
fn descended(polar: &[(f64, f64)], centre: DVec2, m: u32, start: [f64; 4]) -> Option<(f64, Base)> {
    let value = |x: &[f64; 4], angle: f64| x[2].exp() * gielis(m, [x[0].exp(), x[1].exp()], angle - x[3]);
    let square = |x: &[f64; 4]| polar.iter().map(|(a, r)| (r - value(x, *a)).powi(2)).sum::<f64>();
    let mut x = [start[0].ln(), start[1].ln(), start[2].ln(), start[3]];
    let mut cost = square(&x);
    let mut damping = 1e-3;
    for _ in 0..30 {
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for (angle, radius) in polar {
            let at = value(&x, *angle);
            let mut row = [0.0; 4];
            for (k, slope) in row.iter_mut().enumerate() {
                let mut moved = x;
                moved[k] += 1e-5;
                *slope = (value(&moved, *angle) - at) / 1e-5;
            }
            for i in 0..4 {
                right[i] += (radius - at) * row[i];
                for j in 0..=i {
                    matrix[i][j] += row[i] * row[j];
                }
            }
        }
        for i in 0..4 {
            matrix[i][i] *= 1.0 + damping;
            matrix[i][i] += 1e-12;
        }
        let step = solved(&matrix, &right, &[true; 4])?;
        let mut next = x;
        for k in 0..4 {
            next[k] += step[k].clamp(-0.7, 0.7);
        }
        (next[0], next[1]) = (next[0].clamp(-1.6, 5.5), next[1].clamp(-1.6, 5.5));
        let after = square(&next);
        if after < cost {
            let gain = 1.0 - after / cost;
            (x, cost, damping) = (next, after, 0.2 * damping);
            if gain < 1e-4 {
                break;
            }
        } else {
            damping = 4.0 * damping + 1e-6;
        }
    }
    let off = polar.iter().map(|(a, r)| (r - value(&x, *a)).abs()).sum::<f64>() / polar.len() as f64;
    let base = Base::Supershape { centre, angle: x[3], m, n: [x[0].exp(), x[1].exp()], radius: x[2].exp() };
    off.is_finite().then_some((off, base))
}

/// How far a polygon's corners are from a ring at most, which is to be the same one.
pub(super) fn apart(a: &[DVec2], b: &[DVec2]) -> f64 {
    let side = |k: usize| (b[k], b[(k + 1) % b.len()]);
    let off = |p: &DVec2| (0..b.len()).map(|k| distance(*p, side(k).0, side(k).1)).fold(f64::INFINITY, f64::min);
    a.iter().map(off).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Grain = Grain { tolerance: 0.0018, short: 0.0 };

    fn ring(radius: impl Fn(f64) -> f64, count: usize) -> Vec<DVec2> {
        let angle = |i: usize| TAU * i as f64 / count as f64;
        (0..count).map(|i| DVec2::new(0.1, -0.05) + radius(angle(i)) * DVec2::from_angle(angle(i))).collect()
    }

    #[test]
    fn circles_are_left_to_cylinders() {
        assert!(bases(&ring(|_| 0.2, 40), FINE).is_empty());
    }

    #[test]
    fn a_hexagon_is_regular() {
        let hexagon: Vec<DVec2> =
            (0..6).map(|k| DVec2::new(0.1, -0.05) + 0.2 * DVec2::from_angle(0.3 + TAU * k as f64 / 6.0)).collect();
        let found = bases(&hexagon, FINE);
        let [Base::Regular { centre, angle, sides: 6, radius }] = found[..] else { panic!("{found:?}") };
        assert!(centre.distance(DVec2::new(0.1, -0.05)) < 1e-12 && (radius - 0.2).abs() < 1e-12);
        assert!(((angle - 0.3) * 6.0).sin().abs() < 1e-9);
    }

    #[test]
    fn a_slot_is_a_rounded_rectangle() {
        let turn = DVec2::from_angle(0.4);
        let mut slot = Vec::new();
        for (x, from) in [(0.1, -0.5 * PI), (-0.1, 0.5 * PI)] {
            slot.extend((0..=16).map(|i| {
                let arc = DVec2::from_angle(from + PI * f64::from(i) / 16.0);
                turn.rotate(DVec2::new(x, 0.0) + 0.05 * arc)
            }));
        }
        let found = bases(&slot, FINE);
        let Some(Base::Rounded { centre, angle, size, radius }) = found.first() else { panic!("{found:?}") };
        assert!(centre.length() < 1e-3 && (angle - 0.4).abs() < 1e-3, "{found:?}");
        assert!((*size - DVec2::new(0.3, 0.1)).length() < 2e-3 && (radius - 0.05).abs() < 1e-3, "{found:?}");
    }

    /// Three corners round and one square: a rounded rectangle nearly, an outline with arcs
    /// exactly.
    #[test]
    fn arcs_are_there_beside_what_fits_nearly() {
        let round = |x: f64, y: f64, from: f64| {
            (0..=8).map(move |k| {
                let angle = from + PI * f64::from(k) / 16.0;
                DVec2::new(x, y) + 0.05 * DVec2::from_angle(angle)
            })
        };
        let ring: Vec<DVec2> = round(0.2, 0.1, 0.0)
            .chain(round(-0.2, 0.1, 0.5 * PI))
            .chain(round(-0.2, -0.1, PI))
            .chain([DVec2::new(0.25, -0.15)])
            .collect();
        let found = bases(&ring, FINE);
        assert!(matches!(found[0], Base::Rounded { .. }), "{found:?}");
        let has_arcs = |base: &Base| matches!(base, Base::Outline(outline) if outline.arc_count() == 3);
        assert!(found.iter().any(has_arcs), "{found:?}");
    }

    #[test]
    fn a_star_is_a_supershape() {
        let star = ring(|angle| 0.2 * gielis(5, [3.0, 7.0], angle - 0.2), 200);
        let found = bases(&star, FINE);
        let Some(Base::Supershape { angle, m, n, radius, .. }) =
            found.iter().find(|base| matches!(base, Base::Supershape { .. }))
        else {
            panic!("{found:?}")
        };
        assert_eq!(*m, 5);
        for i in 0..100 {
            let at = 0.07 * f64::from(i);
            let truth = 0.2 * gielis(5, [3.0, 7.0], at - 0.2);
            assert!((radius * gielis(5, *n, at - angle) / truth - 1.0).abs() < 0.01, "{found:?}");
        }
    }
}
