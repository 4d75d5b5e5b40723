//! A program taken apart by the sign of one leaf.
//!
//! What is inside of a solid is told by the signs of its leaves. Where that of one leaf L is known,
//! the program is another without it:
//!
//! ```text
//!     L outside        P₋          of a plate L ∧ S that is nothing, and S alone
//!     L inside         P₊
//! ```
//!
//! That is of use where L is long and does not change along rays, as the outline of a plate that is
//! seen from above: one value of it per ray tells which of the two the ray is in from end to end.

use super::pass::{Asked, Pass};
use super::program::{Edge, Node, Program, Region};
use crate::Bounds;
use rvachev_field::{Pieces, Zone};

/// Leaves whose signs are known, by their nodes, and whether these are inside.
pub(super) type Given = Vec<(usize, bool)>;

/// A program in parts.
pub(crate) struct Partial {
    /// The axes of the world that the leaf depends on.
    pub(crate) axes: [bool; 3],
    /// The leaf alone.
    pub(crate) leaf: Program,
    /// The program where the leaf is outside, and where it is inside.
    pub(crate) sides: [Region; 2],
}

impl Program {
    /// The program parted, within `bounds`, by a leaf that costs more than `dear` ordinary ones and
    /// goes on without end along an axis of the world, if it has one.
    pub(crate) fn partial(&self, bounds: &Bounds, dear: usize) -> Option<Partial> {
        for (at, node) in self.nodes.iter().enumerate() {
            let Some(leaf) = node.valued_by().filter(|_| node.len == 0) else { continue };
            let instance = self.instance(leaf);
            let axes = self.axes_of(leaf);
            let ends = |axis: usize| instance.bounds.min[axis].is_finite() || instance.bounds.max[axis].is_finite();
            if instance.field.cost() <= dear || (0..3).all(|axis| axes[axis] || ends(axis)) {
                continue;
            }
            let axes = [0, 1, 2].map(|axis| axes[axis] || ends(axis));
            let [Some(outside), Some(inside)] = [false, true].map(|sign| self.given(vec![(at, sign)], bounds)) else {
                continue;
            };
            return Some(Partial { axes, leaf: self.of_leaf(leaf), sides: [outside, inside] });
        }
        None
    }

    /// One of its leaves.
    pub(super) fn of_leaf(&self, leaf: u32) -> Program {
        let nodes = vec![Node::leaf(leaf)];
        Program::assemble(self.scene.clone(), nodes, Vec::new(), Edge::new(0), self.simpler.to_vec())
    }

    /// What `bounds` hold of the solid where the leaves of nodes are inside or outside; `None` if
    /// their signs do not tell.
    pub(super) fn given(&self, given: Given, bounds: &Bounds) -> Option<Region> {
        let world = &Pieces::one(Zone::of_bounds(bounds));
        let zones = self.zones(world);
        let mut pass = Pass::new(self, &zones, world);
        pass.by_boxes = true;
        pass.given = given;
        pass.run(Asked { sign: true, ..Asked::default() });
        let is_told = pass.given.iter().all(|(at, _)| !pass.is_value(*at));
        is_told.then(|| self.region(self.found(pass)))
    }
}

#[cfg(all(test, feature = "formula"))]
mod tests {
    use fidget::context::Tree;
    use glam::{DVec2, DVec3};

    use crate::eval::Region;
    use crate::{Bounds, PlaneBounds, Profile, Solid, rad};

    #[test]
    fn each_side_has_the_sign_of_the_whole() {
        let (x, y, _) = Tree::axes();
        let wave = |k: i16| (x.clone() * f32::from(k) + y.clone()).square() * 0.1 + x.clone().abs() - 0.5;
        let long = (1..20).map(wave).reduce(|all, next| all.min(next)).expect("there are some");
        let profile = Profile::formula(&long, PlaneBounds { min: DVec2::NEG_ONE, max: DVec2::ONE });
        let plate = profile.extrude(0.4);
        let ball = Solid::sphere(0.6).translate([0.3, 0.2, 0.1]);
        let turned = plate.rotate_z(rad(0.3)).translate([0.1, 0.0, 0.0]);
        let bounds = Bounds::from_center(DVec3::ZERO, DVec3::splat(2.0));
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let mut parted = 0;
        for solid in [plate.clone(), &plate - &ball, &plate | &ball, &ball - &plate, &turned & &ball] {
            let program = solid.surface_program().expect("the solid is valid");
            let Some(partial) = program.partial(&bounds, 4) else { continue };
            assert_eq!(partial.axes, [true, true, false]);
            parted += 1;
            for n in 0..1000 {
                let p = 2.0 * DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) - 1.0;
                let side = &partial.sides[usize::from(partial.leaf.value(p) > 0.0)];
                let inside = match side {
                    Region::Inside => true,
                    Region::Outside => false,
                    Region::Surface(side) => side.value(p) > 0.0,
                };
                assert_eq!(inside, program.value(p) > 0.0, "{p}");
            }
        }
        assert_eq!(parted, 5);
        // Below a blend its sign does not tell.
        let blended = plate.smooth_union(&ball, 0.1).surface_program().expect("the solid is valid");
        assert!(blended.partial(&bounds, 4).is_none());
        // Nor is a short leaf worth it.
        assert!(ball.surface_program().expect("the solid is valid").partial(&bounds, 4).is_none());
    }
}
