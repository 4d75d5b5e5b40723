//! The nearest point of the surface, by branch and bound.
//!
//! Boxes are opened nearest first. A box without surface is dropped, one that is farther than
//! the best point found is too. From each small box a point is refined: slide along the
//! tangent plane towards the query, step back to the surface, repeat.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::eval::{Program, Region};
use crate::Bounds;

struct Candidate {
    distance: f64,
    bounds: Bounds,
    program: Program,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Candidate) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    /// The heap gives its greatest: the nearest.
    fn cmp(&self, other: &Candidate) -> Ordering {
        other.distance.total_cmp(&self.distance)
    }
}

/// Boxes smaller than this times the size are not opened: a point is refined from each.
const SMALLEST: f64 = 2e-3;

/// No more boxes than this are opened; the best point found by then is the answer.
const PATIENCE: usize = 100_000;

/// The point of the surface of `program` within `bounds` that is nearest to `p`.
pub(super) fn nearest(program: &Program, bounds: &Bounds, p: DVec3) -> Option<DVec3> {
    let size = bounds.size().length();
    let bounds = bounds.inflate(1e-6 * size);
    let mut heap = BinaryHeap::new();
    heap.push(Candidate { distance: 0.0, bounds, program: program.clone() });
    let mut best: Option<(f64, DVec3)> = None;
    for _ in 0..PATIENCE {
        let Some(candidate) = heap.pop() else { break };
        if best.is_some_and(|(least, _)| candidate.distance >= least) {
            break;
        }
        let Region::Surface(narrowed) = candidate.program.narrow(&candidate.bounds) else { continue };
        let small = candidate.bounds.longest_side() < SMALLEST * size;
        if small || best.is_none() {
            let start = candidate.bounds.center();
            if let Some(found) = refine(program, start, p, size) {
                let distance = found.distance(p);
                if best.is_none_or(|(least, _)| distance < least) {
                    best = Some((distance, found));
                }
            }
        }
        if small {
            continue;
        }
        for octant in candidate.bounds.octants() {
            let distance = octant.distance_squared(p).sqrt();
            if best.is_none_or(|(least, _)| distance < least) {
                heap.push(Candidate { distance, bounds: octant, program: narrowed.clone() });
            }
        }
    }
    best.map(|(_, point)| point)
}

/// A locally nearest point, from `start`.
fn refine(program: &Program, start: DVec3, p: DVec3, size: f64) -> Option<DVec3> {
    // What is left of the way to `p` in the tangent plane.
    let slide_at = |x: DVec3| {
        let normal = program.gradient(x).1.normalize_or_zero();
        let towards = p - x;
        towards - towards.dot(normal) * normal
    };
    let mut x = onto_surface(program, start, size)?;
    let mut slide = slide_at(x);
    let mut step = 1.0;
    for _ in 0..60 {
        if slide.length() < 1e-12 * size {
            break;
        }
        // On a curved surface a slide may overshoot: halve it until it gains.
        let mut moved = None;
        while step > 1e-6 {
            moved = onto_surface(program, x + (step * slide).clamp_length_max(size), size)
                .map(|next| (next, slide_at(next)))
                .filter(|(next, rest)| {
                    // Close to the foot the distance is flat to its last digit, and a shorter
                    // slide tells.
                    let (old, new) = (x.distance(p), next.distance(p));
                    new < old || (new <= old * (1.0 + 1e-12) && rest.length() < 0.5 * slide.length())
                });
            if moved.is_some() {
                break;
            }
            step *= 0.5;
        }
        let Some((next, rest)) = moved else { break };
        // The step that would have left no slide, were the curvature the same all the way: it
        // is short far outside of a convex surface and long near its centre of curvature.
        let shrunk = slide.dot(slide - rest);
        step = if shrunk > 0.0 { (step * slide.length_squared() / shrunk).clamp(1e-3, 1e3) } else { 1.0 };
        (x, slide) = (next, rest);
    }
    Some(x)
}

/// A point of the surface near `x`, by Newton steps along the gradient.
fn onto_surface(program: &Program, mut x: DVec3, size: f64) -> Option<DVec3> {
    for _ in 0..24 {
        let (value, gradient) = program.gradient(x);
        let squared = gradient.length_squared();
        if squared < 1e-24 {
            return None;
        }
        let step = (value / squared) * gradient;
        // A step longer than the solid says that the slope is of no use here.
        x -= step.clamp_length_max(0.25 * size);
        if step.length() < 1e-14 * size {
            return Some(x);
        }
    }
    (program.value(x).abs() < 1e-10 * size).then_some(x)
}
