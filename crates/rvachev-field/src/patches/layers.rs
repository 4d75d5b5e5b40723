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

use glam::{DMat3, DVec3};
use rvachev_num::Interval;

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
        if !zone.is_finite() || !self.is_whole(zone) || level.abs() <= self.slack(zone, 0.0) {
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
        for layer in &mut layers {
            (layer.low, layer.high) = (layer.low - rounding, layer.high + rounding);
            if let Some((_, at)) = plane {
                if level < 0.0 {
                    layer.high = layer.high.min(level - at + rounding);
                } else {
                    layer.low = layer.low.max(level + at - rounding);
                }
            } else {
                self.thin(layer, zone, level);
            }
        }
        Some(layers)
    }

    /// Makes a layer thinner on the side of the surface.
    ///
    /// ```text
    ///     -----x-----  level          What is nearer to a plane beyond the surface than the level is to the
    ///     ___________  surface        surface meets the surface on the way there.
    ///     ----------- plane
    /// ```
    fn thin(&self, layer: &mut Layer, zone: &Zone, level: f64) {
        let Layer { normal, low, high, .. } = *layer;
        // Downwards to the surface if the level is inside.
        let sign = level.signum();
        let axes = [0, 1, 2].map(|k| zone.axes.col(k) - normal.dot(zone.axes.col(k)) * normal);
        let middle = normal.dot(zone.centre);
        let reach = (0..3).map(|k| normal.dot(zone.axes.col(k)).abs()).sum::<f64>() + zone.slack.length();
        for part in THINNER {
            let thickness = part * (high - low);
            let at = if sign > 0.0 { high - thickness } else { low + thickness };
            let plane = at - sign * (level.abs() - self.error - self.patches.rounding());
            // All of the zone is on this side of it.
            if sign * (middle - plane) <= reach {
                return;
            }
            let mut beyond =
                Zone::of_frame(zone.centre + (plane - middle) * normal, DMat3::from_cols(axes[0], axes[1], axes[2]));
            if zone.slack != DVec3::ZERO {
                beyond = beyond.inflated(zone.slack.max_element());
            }
            if (self.whole_sign.range(&beyond) * Interval::point(sign)).hi() < 0.0 {
                if sign > 0.0 {
                    layer.low = at
                } else {
                    layer.high = at
                }
                return;
            }
        }
    }
}

/// Layers become so thin, as parts of what they are, if they do.
const THINNER: [f64; 4] = [1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0 / 2.0];

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
