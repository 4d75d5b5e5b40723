//! Whether triangles are inside out.
//!
//! Close behind triangles that enclose something the winding number is above one half. Of a mesh
//! that is inside out it is so nowhere, but would be so with the triangles turned over.

use glam::DVec3;

use super::super::face::double;
use super::winding::Winding;

/// So many triangles are looked behind, one in so many.
const LOOKS: usize = 256;

/// How far behind them, in sizes of a triangle, and in units of the frame at least.
const BEHIND: f64 = 1e-3;
const LEAST: f64 = 1e-5;

/// Below this, the winding number tells that the other side would be inside. Those of open edges
/// are near one half.
const TURNED: f64 = -0.6;

impl Winding {
    /// The volume about their middle of triangles that enclose nothing, but would if they were
    /// turned over.
    pub(super) fn volume_if_turned(&self) -> Option<f64> {
        let count = self.patches.len();
        let mut is_turned = false;
        for at in (0..count).step_by(count.div_ceil(LOOKS).max(1)) {
            let [a, e, f] = self.triangle(at);
            let across = e.cross(f);
            let Some(normal) = across.try_normalize() else { continue };
            let by = (BEHIND * across.length().sqrt()).max(LEAST) * normal;
            for p in [a + (e + f) / 3.0 + by, a + (e + f) / 3.0 - by] {
                let number = self.number_at(p.to_array());
                if number > 0.5 {
                    return None;
                }
                is_turned |= number < TURNED;
            }
        }
        let volume = || {
            let six = |at: usize| {
                let [a, e, f] = self.triangle(at);
                a.dot(e.cross(f))
            };
            (0..count).map(six).sum::<f64>() / 6.0 * self.patches.frame.unit.powi(3)
        };
        if is_turned { Some(volume()).filter(|volume| *volume < 0.0) } else { None }
    }

    /// A corner of a triangle and the sides from there.
    fn triangle(&self, at: usize) -> [DVec3; 3] {
        let (face, sides) = (&self.patches.faces[at], &self.patches.sides[at]);
        [face.a, sides.e, sides.f].map(double)
    }
}
