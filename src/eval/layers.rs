//! Layers that hold the surface of a single leaf.

use super::context::is_similarity;
use super::program::{Kind, Program};
use rvachev_field::{Layer, Zone};

impl Program {
    /// Layers that hold all points of a zone at which the value is `level`, of a leaf that is not
    /// deformed; nothing of others, nor where it is not known.
    pub(crate) fn layers(&self, zone: &Zone, level: f64) -> Option<Vec<Layer>> {
        let [root] = &self.nodes[..] else { return None };
        let Kind::Leaf(leaf) = root.kind else { return None };
        let instance = self.instance(leaf);
        if instance.frame != 0 {
            return None;
        }
        let level = if self.root.negated() { -level } else { level };
        let own = (level - instance.placement.shift) / instance.placement.scale;
        let map = &instance.to_local;
        let found = instance.field.layers(&zone.mapped(map), own)?;
        let is_similarity = is_similarity(&map.matrix3);
        let outward = |Layer { normal, low, high, least_cosine }: Layer| {
            let across = map.matrix3.transpose() * normal;
            let (length, moved) = (across.length(), normal.dot(map.translation));
            let [low, high] = [low, high].map(|at| (at - moved) / length);
            let least_cosine = if is_similarity { least_cosine } else { -1.0 };
            let placed = Layer { normal: across / length, low, high, least_cosine };
            if self.root.negated() { placed.turned() } else { placed }
        };
        Some(found.into_iter().map(outward).collect())
    }
}
