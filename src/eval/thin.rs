//! What is known of a program's leaves before any region is looked at: how steep and how thin they
//! are.

use glam::{DAffine3, DVec3};

use super::program::{Edge, Kind, Node, Program};
use super::scene::Instance;
use crate::Bounds;
use rvachev_field::Rule;

impl Program {
    /// By how much the values of its leaves change per length unit at most where they are not
    /// deformed, if that is known of all, and joins leave it at that.
    fn slope_of_leaves(&self) -> Option<f64> {
        let of_node = |node: &Node| match &node.kind {
            Kind::Leaf(leaf) => self.instance(*leaf).field.slope_bound(),
            Kind::Join { rule, .. } => matches!(rule, Rule::MinMax | Rule::Smooth(_)).then_some(0.0),
            Kind::Shift(_) => Some(0.0),
        };
        self.nodes.iter().try_fold(0.0, |most: f64, node| Some(most.max(of_node(node)?)))
    }

    /// Whether it is known by how much the values of its leaves change where they are not deformed,
    /// and joins leave it at that.
    pub(crate) fn has_gentle_leaves(&self) -> bool {
        self.slope_of_leaves().is_some()
    }

    /// By how much the value changes per length unit at most, if that is known of all leaves and none
    /// is deformed.
    pub(crate) fn steepest_leaf(&self) -> Option<f64> {
        self.slope_of_leaves().filter(|_| self.is_unbent())
    }

    /// Whether the value changes by at most 1 per length unit.
    pub(crate) fn is_gentle(&self) -> bool {
        self.steepest_leaf().is_some_and(|slope| slope <= 1.0)
    }

    fn is_unbent(&self) -> bool {
        self.nodes.iter().filter_map(Node::valued_by).all(|leaf| self.instance(leaf).frame == 0)
    }

    /// Whether it is one convex body that is not repeated or mirrored: between two points on one
    /// side of it there is nothing of the other, but for what of it is thinner than between them.
    pub(crate) fn is_one_convex(&self) -> bool {
        let mut leaves = self.nodes.iter().filter_map(Node::valued_by).map(|leaf| self.instance(leaf));
        let first = leaves.next();
        let is_single = |leaf: &Instance| {
            let mut frame = self.scene.frame(leaf.frame);
            while let Some(own) = frame.filter(|own| !own.warp.folds()) {
                frame = self.scene.frame(own.parent);
            }
            frame.is_none() && leaf.field.convex()
        };
        leaves.next().is_none() && first.is_none_or(is_single)
    }

    /// By how much the value of gentle leaves changes per length unit in a box at most: by more
    /// than 1 where they are deformed. Of others it is not told.
    pub(crate) fn slope_within(&self, region: &Bounds) -> f64 {
        match self.steepest_leaf() {
            Some(slope) => slope,
            None if self.has_gentle_leaves() => self.steepest(region),
            None => f64::INFINITY,
        }
    }

    /// Which leaves of the solid, by their numbers, are convex and thinner than this, in length
    /// units: holes and rods of that size may pass between samples without a change of sign.
    pub(crate) fn thin_leaves(&self, thickness: f64) -> Vec<bool> {
        self.scene.leaves.iter().map(|leaf| leaf.field.convex() && thickness_of(leaf) < thickness).collect()
    }

    /// Whether a leaf is flat between creases, however blunt these are: one that is not bent.
    pub(crate) fn is_faceted(&self) -> bool {
        let is_bent = |mut frame: u32| {
            while let Some(own) = self.scene.frame(frame) {
                if !own.warp.folds() {
                    return true;
                }
                frame = own.parent;
            }
            false
        };
        self.scene.leaves.iter().any(|leaf| leaf.field.is_faceted() && !is_bent(leaf.frame))
    }

    /// The corners of such leaves, as vertices have them, each once; not of those that are deformed
    /// or offset.
    pub(crate) fn corners(&self) -> Vec<DVec3> {
        let mut all: Vec<[f32; 3]> = Vec::new();
        for leaf in self.scene.leaves.iter().filter(|leaf| leaf.frame == 0 && leaf.placement.shift == 0.0) {
            let Some(facets) = leaf.field.facets() else { continue };
            let map = leaf.to_local.inverse();
            all.extend(facets.positions.iter().map(|p| (map.transform_point3(*p).as_vec3() + 0.0).to_array()));
        }
        all.sort_unstable_by_key(|p| p.map(f32::to_bits));
        all.dedup();
        all.into_iter().map(|p| DVec3::from_array(p.map(f64::from))).collect()
    }

    /// The least side of a leaf's box: no leaf is thinner; infinite where none is bounded.
    pub(crate) fn thinnest_leaf(&self) -> f64 {
        let side = |leaf: u32| {
            let size = self.instance(leaf).bounds.size();
            size.to_array().into_iter().filter(|side| *side > 0.0).fold(f64::INFINITY, f64::min)
        };
        self.nodes.iter().filter_map(Node::valued_by).map(side).fold(f64::INFINITY, f64::min)
    }

    /// Whether a region may hold one of these leaves of the solid.
    pub(crate) fn has_leaf_of(&self, leaves: &[bool], region: &Bounds) -> bool {
        self.those_of(leaves, region).next().is_some()
    }

    /// Those of these leaves that a region may hold, each as a program by itself.
    pub(crate) fn slender_in(&self, leaves: &[bool], region: &Bounds) -> Vec<SlenderLeaf> {
        let alone = |leaf| {
            let nodes = vec![Node::leaf(leaf)];
            let program = Program::assemble(self.scene.clone(), nodes, Vec::new(), Edge::new(0), self.simpler.to_vec());
            let own = self.instance(leaf);
            // Frames bend what is straight in its own coordinates.
            let (within, to_world) = if own.frame == 0 {
                let whole = own.field.bounds_under(&DAffine3::IDENTITY);
                let shift = own.placement.shift.max(0.0) / own.placement.scale;
                (whole.inflate(shift).intersection(&region.transformed(&own.to_local)), own.to_local.inverse())
            } else {
                (*region, DAffine3::IDENTITY)
            };
            SlenderLeaf { program, within, to_world, thickness: thickness_of(own) }
        };
        self.those_of(leaves, region).map(alone).collect()
    }

    fn those_of<'a>(&'a self, leaves: &'a [bool], region: &'a Bounds) -> impl Iterator<Item = u32> + 'a {
        self.nodes.iter().filter_map(Node::valued_by).filter(|leaf| {
            let leaf = self.instance(*leaf);
            let is_one = leaves.get(leaf.number as usize) == Some(&true);
            // Boxes in frames are not those of the world.
            is_one && (leaf.frame != 0 || !leaf.bounds.intersection(region).is_empty())
        })
    }
}

/// A leaf by itself: the box that it is in, as far as that is near a region, with the map from
/// there to the world; and how thick it is.
pub(crate) struct SlenderLeaf {
    pub(crate) program: Program,
    pub(crate) within: Bounds,
    pub(crate) to_world: DAffine3,
    pub(crate) thickness: f64,
}

/// The least side of a leaf's box, as it is placed.
fn thickness_of(leaf: &Instance) -> f64 {
    let size = leaf.field.bounds_under(&DAffine3::IDENTITY).size().min_element();
    leaf.placement.scale * size + 2.0 * leaf.placement.shift
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::distance::compiled;
    use crate::{Blend, Bounds, Solid, rad};

    #[test]
    fn values_change_by_no_more_than_slopes_tell() {
        let bar = Solid::cuboid([1.0, 0.8, 2.0]).translate([2.0, 0.3, 0.0]);
        let (mut steepest, mut worst, mut most) = (0.0f64, 0.0f64, 0.0f64);
        let angle = &bar | Solid::cuboid([3.0, 0.5, 0.5]);
        for solid in [
            bar.clone(),
            bar.twist(rad(0.6)),
            bar.twist(rad(1.0)) | Solid::sphere(1.0),
            bar.bend(0.2, rad(0.4)),
            angle.union_with(Solid::sphere(1.0), Blend::Fillet { radius: 0.4 }),
        ] {
            let program = &compiled(&solid).unwrap().surface;
            for n in 0..200 {
                let at = |k: f64| (f64::from(n) * k).fract();
                let middle = 4.0 * DVec3::new(at(0.618), at(0.387), at(0.7243)) - 2.0;
                let region = Bounds::from_center(middle, DVec3::splat(0.1));
                let [p, q] = [region.min, region.max - 0.2 * DVec3::new(at(0.17), at(0.29), at(0.53))];
                let rise = (program.value(p) - program.value(q)).abs() / p.distance(q);
                steepest = steepest.max(rise);
                let told = program.slope_within(&region);
                worst = worst.max(rise / told);
                most = most.max(told);
            }
        }
        assert!(worst <= 1.0, "{worst}");
        // Deformed ones change by more than 1, and what is told of them is not just anything.
        assert!(steepest > 1.3, "{steepest}");
        assert!(most < 8.0, "{most} told where {steepest} was found");
    }
}
