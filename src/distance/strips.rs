//! Curves of the plane as strips of patches across it.

use glam::{DVec2, DVec3};

use super::outline::Curve;
use rvachev_field::Patch;

/// Strips are off arcs by this part of the size at most: less than single precision tells.
const OFF: f64 = 2e-8;

/// Half of a strip's width, in parts of the size.
const WIDTH: f64 = 1.0 / 32.0;

/// Patches along curves in the plane z = 0, of a solid of some size.
pub(super) fn strips(curves: &[Curve], size: f64) -> Vec<Patch> {
    let mut patches = Vec::new();
    for curve in curves {
        // A parabola through the ends and the middle of an arc of the angle 2φ is off it by less
        // than r φ⁴/24.
        let parts = match *curve {
            Curve::Line(_) => 1.0,
            Curve::Arc { radius, turn, .. } => {
                (0.5 * turn.abs() / (24.0 * OFF * size / radius).powf(0.25)).ceil().max(1.0)
            }
        };
        for part in 0..parts as u32 {
            let [from, middle, to] = [0.0, 0.5, 1.0].map(|at| curve.at((f64::from(part) + at) / parts));
            let bow = match curve {
                Curve::Line(_) => DVec2::ZERO,
                Curve::Arc { .. } => middle - 0.5 * (from + to),
            };
            strip([from, to], bow, WIDTH * size, &mut patches);
        }
    }
    patches
}

/// Two patches, the inside on the left of the way.
fn strip(ends: [DVec2; 2], bow: DVec2, half: f64, patches: &mut Vec<Patch>) {
    let [[a, b], [c, d]] = [-half, half].map(|z| ends.map(|p| p.extend(z)));
    let bow = bow.extend(0.0);
    patches.push(Patch { corners: [a, b, d], displacements: [bow, DVec3::ZERO, bow] });
    patches.push(Patch { corners: [a, d, c], displacements: [bow, bow, DVec3::ZERO] });
}
