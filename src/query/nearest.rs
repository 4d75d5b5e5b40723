//! The nearest point of the surface: on the patches of the surface first, then on the field itself.
//!
//! From the foot on the patches: slide along the tangent plane towards the query, step back to the
//! surface, repeat.

use glam::DVec3;

use crate::eval::Program;
use rvachev_field::Patches;

/// From farther away than this, in sizes of the solid, distances to all of its parts are alike to
/// the last digits.
const FARTHEST: f64 = 1e6;

/// The point of the surface of `program` that is nearest to `p`; none if there are no patches.
pub(crate) fn nearest(program: &Program, patches: &Patches, p: DVec3) -> Option<DVec3> {
    let (size, centre) = (patches.bounds().size().length(), patches.bounds().center());
    // A point that is far away is replaced by one on the straight way to it.
    let away = (p - centre) / (p - centre).abs().max_element().max(f64::MIN_POSITIVE);
    let nearer = centre + away.normalize_or_zero() * FARTHEST * size;
    let p = if (p - centre).abs().max_element() > FARTHEST * size { nearer } else { p };
    let foot = patches.nearest(p)?.point;
    let is_near = |found: &DVec3| found.distance(foot) < 0.1 * size;
    let refined = refine(program, foot, p, size).filter(is_near).or_else(|| {
        let start = crossing(program, foot, size)?;
        Some(refine(program, start, p, size).filter(is_near).unwrap_or(start))
    });
    Some(refined.unwrap_or(foot))
}

/// Where the sign changes near `x`: halved between it and a point of the other sign, among those
/// all around it at growing distances. Beyond the end of an edge Newton steps go to and fro over a
/// ridge of the field.
fn crossing(program: &Program, x: DVec3, size: f64) -> Option<DVec3> {
    const WAYS: u32 = 128;
    let inside = |x: DVec3| program.value(x) > 0.0;
    let here = inside(x);
    // Points of a spiral over the sphere, as many to every area.
    let way = |n: u32| {
        let z = 1.0 - (2.0 * f64::from(n) + 1.0) / f64::from(WAYS);
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(n)).sin_cos();
        DVec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    };
    let mut reach = 1e-7 * size;
    while reach < 0.1 * size {
        if let Some(way) = (0..WAYS).map(way).find(|way| inside(x + reach * *way) != here) {
            let (mut low, mut high) = (0.0, reach);
            while high - low > 1e-13 * size {
                let middle = 0.5 * (low + high);
                if inside(x + middle * way) == here { low = middle } else { high = middle }
            }
            return Some(x + high * way);
        }
        reach *= 2.0;
    }
    None
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

/// A point of the surface near `x`, by Newton steps along the gradient, or along a ridge that they
/// went over: at a rim that ends in a cusp slopes have no bound, and what is left of both sides' is
/// the slope along the rim's plane.
fn onto_surface(program: &Program, mut x: DVec3, size: f64) -> Option<DVec3> {
    let mut last = DVec3::ZERO;
    for _ in 0..24 {
        let (value, gradient) = program.gradient(x);
        // Beyond a rim steps over it are short as well.
        let is_known = last.dot(gradient) > 0.0;
        let way = if last.dot(gradient) < 0.0 { shortest(last, gradient) } else { gradient };
        last = gradient;
        let squared = way.length_squared();
        if squared < 1e-24 {
            return None;
        }
        let step = (value / squared) * way;
        // A step longer than the solid says that the slope is of no use here.
        x -= step.clamp_length_max(0.25 * size);
        if is_known && step.length() < 1e-14 * size {
            return Some(x);
        }
    }
    (program.value(x).abs() < 1e-10 * size).then_some(x)
}

/// The shortest vector between two.
fn shortest(a: DVec3, b: DVec3) -> DVec3 {
    let way = b - a;
    a + (-a.dot(way) / way.length_squared()).clamp(0.0, 1.0) * way
}
