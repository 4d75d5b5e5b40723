//! Layers that hold the flat patches in a zone, or the points at a distance from a surface.
//!
//! ```text
//!     ---------------------        Patches that look about the same way are between two planes across it:
//!      _____.----'''----.__        of a flat face these are one, elsewhere their distance goes with the
//!     ---------------------        square of the zone's size.
//!
//!         +---+
//!     ----|---|-------- d          What is above a flat patch is no farther from the surface than from the
//!         +---+                    patch's plane: on that side the layer ends at the plane that is d away.
//!     =================
//! ```

use glam::DVec3;

use super::face::double;
use super::hierarchy::{Node, PARENT};
use super::{Patches, SurfaceDistance};
use crate::level::{Across, layers_across};
use crate::{Layer, Zone};

/// More patches than these are not looked at, and no more layers made.
const PATCHES: usize = 2048;
const LAYERS: usize = 4;

/// Patches of a layer are turned from each other by less: the cosine.
const ALIKE: f64 = 0.9;

impl SurfaceDistance {
    /// A layer that holds all points of a zone at this distance from the surface, negative outside;
    /// nothing so near to it that the sign may turn before the distance is 0.
    pub(super) fn level_layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        if !zone.is_finite() || level.abs() <= self.slack(zone, 0.0) {
            return None;
        }
        let (mut axes, flat) = (DVec3::ONE, self.across(zone));
        if let Some(axis) = self.flat {
            axes[axis] = 0.0;
        }
        // Below the plane as far as that is the distance of the other side.
        let is_beside = |(normal, at): &(DVec3, f64)| normal.dot(flat.centre) - at - flat.radius() > -level.abs();
        let plane = self.patches.plane_below(&flat).filter(is_beside);
        // It rises away from the surface inside.
        let along = plane.map(|(normal, _)| if level < 0.0 { -normal } else { normal });
        let mut layers = layers_across(self, zone, level, Across { axes, along })?;
        let rounding = self.patches.rounding();
        for Layer { low, high, .. } in &mut layers {
            (*low, *high) = (*low - rounding, *high + rounding);
            if let Some((_, at)) = plane {
                if level < 0.0 {
                    *high = high.min(level - at + rounding);
                } else {
                    *low = low.max(level + at - rounding);
                }
            }
        }
        Some(layers)
    }
}

impl Patches {
    /// The plane of the flat patch that is nearest to the middle of a zone, if all of the zone is
    /// right above it: its unit normal to the zone's side, and its height along that.
    fn plane_below(&self, zone: &Zone) -> Option<(DVec3, f64)> {
        let centre = self.frame.into_local(zone.centre);
        let at = self.search_one(centre.to_array()).which as usize;
        let (face, sides) = self.at(at).filter(|(face, _)| face.is_flat())?;
        let [a, e, f] = [double(face.a), double(sides.e), double(sides.f)];
        let across = e.cross(f);
        let (normal, double_area) = (across.try_normalize()?, across.length_squared());
        let slack = zone.slack.length() / self.frame.unit;
        let is_above = |n: usize| {
            let along = |k: usize| if n >> k & 1 == 0 { -zone.axes.col(k) } else { zone.axes.col(k) };
            let way = centre + (along(0) + along(1) + along(2)) / self.frame.unit - a;
            let s = way.cross(f).dot(across) / double_area;
            let t = e.cross(way).dot(across) / double_area;
            // How far each side of the triangle is, in parts of the height over it.
            let area = double_area.sqrt();
            let room = [s * area / f.length(), t * area / e.length(), (1.0 - s - t) * area / (f - e).length()];
            room.into_iter().all(|room| room >= slack)
        };
        if !(0..8).all(is_above) {
            return None;
        }
        let height = normal.dot(centre - a);
        let normal = if height < 0.0 { -normal } else { normal };
        Some((normal, normal.dot(self.frame.outward(a))))
    }

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
            layers.push(Layer { normal, low: low - least, high: high + least, least_cosine: -1.0 });
            if layers.len() > LAYERS {
                return None;
            }
            found = rest;
        }
        Some(layers)
    }
}
