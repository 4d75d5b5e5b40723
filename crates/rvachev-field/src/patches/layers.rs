//! Layers that hold the flat patches in a zone.
//!
//! ```text
//!     ---------------------        Patches that look about the same way are between two planes across it:
//!      _____.----'''----.__        of a flat face these are one, elsewhere their distance goes with the
//!     ---------------------        square of the zone's size.
//! ```

use glam::DVec3;

use super::Patches;
use super::face::double;
use super::hierarchy::{Node, PARENT};
use crate::{Layer, Zone};

/// More patches than these are not looked at, and no more layers made.
const PATCHES: usize = 2048;
const LAYERS: usize = 4;

/// Patches of a layer are turned from each other by less: the cosine.
const ALIKE: f64 = 0.9;

impl Patches {
    /// Layers that hold all parts of patches that may be within `least` of a zone; nothing if some
    /// are curved, or there are many.
    pub(super) fn layers(&self, zone: &Zone, least: f64) -> Option<Vec<Layer>> {
        if !self.is_flat() {
            return None;
        }
        let (seen, near) = (self.seen(zone), least / self.frame.unit);
        let mut found: Vec<(f64, DVec3, [DVec3; 3])> = Vec::new();
        let mut open: Vec<&Node> = Vec::with_capacity(64);
        open.extend(self.nodes.first());
        while let Some(node) = open.pop() {
            if seen.box_gap(double(node.low), double(node.high)) > near {
                continue;
            }
            if node.count >= PARENT {
                open.extend([0, 1].map(|n| &self.nodes[node.first as usize + n]));
                continue;
            }
            for at in (node.first..node.first + node.count).map(|at| at as usize) {
                let Some((face, sides)) = self.at(at).filter(|_| self.patch_apart(&seen, at) <= near) else { continue };
                let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
                let across = e.cross(f);
                found.push((across.length(), across.normalize_or_zero(), [a, a + e, a + f]));
            }
            if found.len() > PATCHES {
                return None;
            }
        }
        let mut layers = Vec::new();
        while let Some((_, first, _)) = found.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)) {
            // Of one without area any way is right.
            let is_alike = |normal: &DVec3| normal.dot(first) >= ALIKE || *normal == DVec3::ZERO;
            let (own, rest): (Vec<_>, Vec<_>) = found.into_iter().partition(|(_, normal, _)| is_alike(normal));
            let normal = own.iter().map(|(area, normal, _)| *area * *normal).sum::<DVec3>().try_normalize()?;
            let heights = own.iter().flat_map(|(.., corners)| corners).map(|p| normal.dot(*p));
            let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
            let [low, high] = [low, high].map(|height| normal.dot(self.frame.outward(height * normal)));
            layers.push(Layer { normal, low: low - least, high: high + least });
            if layers.len() > LAYERS {
                return None;
            }
            found = rest;
        }
        Some(layers)
    }
}
