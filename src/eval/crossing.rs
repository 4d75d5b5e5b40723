//! Which way rays cross the surface, told by the leaves.
//!
//! The sign of unions and intersections changes only where that of a leaf does, and the same way.
//! So what matters are the slopes of the leaves where they are 0: of a plate that is seen from
//! above, those of its upper face in the upper half of a box, and none at all in the lower half.
//!
//! ```text
//!     |          .-'        Of a box that a leaf crosses with slopes of both signs, the parts
//!     |  +    .-'           that it does not cross are left out: where all slopes that are left
//!     +----.-'------+       rise, the leaf rises through 0 once, and so does the whole.
//!     | .-'   -     |
//! ```

use glam::DVec3;

use super::program::{Kind, Node, Program};
use crate::{Bounds, Dual, Interval};
use rvachev_field::Number;
use rvachev_field::Rule;

impl Program {
    /// A range of the slopes that leaves have where they change their signs, along rays in a box
    /// with directions in `along`: 0 if there are none. Where all
    /// are at least 0, a ray goes inside at most once and does not come out; where all are at most
    /// 0, it does not go inside. `None` where the sign is not that of leaves, and where leaves are
    /// deformed: there it costs more than it tells.
    pub(crate) fn crossing_slopes(&self, bounds: &Bounds, along: [Interval; 3]) -> Option<Interval> {
        if !self.frames.is_empty() {
            return None;
        }
        let mut ways = vec![[false; 2]; self.nodes.len()];
        ways[self.root.node()][usize::from(self.root.negated())] = true;
        let mut slopes: Option<Interval> = None;
        for (at, node) in self.nodes.iter().enumerate().rev() {
            let [plain, negated] = ways[at];
            if !(plain || negated) {
                continue;
            }
            match &node.kind {
                Kind::Leaf(leaf) => {
                    let Some(slope) = self.crossing(*leaf, bounds, along, PARTS) else { continue };
                    for slope in [plain.then_some(slope), negated.then_some(-slope)].into_iter().flatten() {
                        slopes = Some(slopes.map_or(slope, |slopes| slopes.hull(slope)));
                    }
                }
                Kind::Join { rule: Rule::MinMax, .. } => {
                    for edge in self.list(node) {
                        let way = &mut ways[edge.node()];
                        way[usize::from(edge.negated())] |= plain;
                        way[usize::from(!edge.negated())] |= negated;
                    }
                }
                Kind::Join { .. } | Kind::Shift(_) => return None,
            }
        }
        Some(slopes.unwrap_or(Interval::point(0.0)))
    }

    /// The distances along a ray at which it crosses planes where slopes of a leaf have no bound;
    /// of leaves that are not deformed, and of none where there are many.
    pub(super) fn creases(&self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let mut found = Vec::new();
        if self.nodes.len() > FEW {
            return found;
        }
        for leaf in self.nodes.iter().filter_map(Node::valued_by) {
            let instance = self.instance(leaf);
            if instance.frame != 0 {
                continue;
            }
            let normals = instance.field.creases();
            if normals.is_empty() {
                continue;
            }
            let from = instance.to_local.transform_point3(origin);
            let along = instance.to_local.transform_vector3(direction);
            let distances = normals.into_iter().map(|normal| -normal.dot(from) / normal.dot(along));
            found.extend(distances.filter(|t| t.is_finite()));
        }
        found
    }

    /// The slopes of a leaf where it is 0; those in the parts of the box that it crosses, one
    /// behind the other, if they are not of one sign (and the leaf costs little).
    fn crossing(&self, leaf: u32, bounds: &Bounds, along: [Interval; 3], parts: u32) -> Option<Interval> {
        let instance = self.instance(leaf);
        let sides = [0, 1, 2].map(|axis| {
            let side = Interval::new(bounds.min[axis], bounds.max[axis]);
            Dual::new(side, [along[axis], Interval::point(0.0), Interval::point(0.0)])
        });
        let p = instance.placement.apply(sides);
        let value = instance.placement.finish(Dual::<Interval>::leaf(&*instance.field, p));
        if !value.value().contains(0.0) {
            return None;
        }
        let slope = value.gradient()[0];
        let is_dear = instance.field.cost() > 1;
        if parts == 0 || is_dear || slope.lo() >= 0.0 || slope.hi() <= 0.0 {
            return Some(slope);
        }
        let axis = (0..3).max_by(|&a, &b| along[a].magnitude().total_cmp(&along[b].magnitude())).unwrap_or(0);
        let (mut near, mut far) = (*bounds, *bounds);
        near.max[axis] = bounds.center()[axis];
        far.min[axis] = near.max[axis];
        let slopes = [near, far].map(|part| self.crossing(leaf, &part, along, parts - 1));
        slopes.into_iter().flatten().reduce(Interval::hull)
    }
}

/// How many times a box is halved.
const PARTS: u32 = 1;

/// Programs of more nodes are not asked for planes.
const FEW: usize = 8;

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::eval::Region;
    use crate::{Bounds, Interval, Solid, rad};

    #[test]
    fn rays_cross_the_way_the_leaves_do() {
        let plate = Solid::cuboid([2.0, 2.0, 0.2]) - Solid::sphere(0.4).translate([0.3, 0.2, 0.0]);
        let solid = plate | Solid::cylinder(0.2, 1.0).rotate_x(rad(70.0)).translate([-0.5, 0.0, 0.1]);
        let program = solid.surface_program().expect("the solid is valid");
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0;
        let (mut rising, mut falling) = (0, 0);
        for n in 0..3000 {
            let bounds = Bounds::from_center(vector(3 * n), (vector(3 * n + 1).abs() + 0.05) * 0.15);
            let Region::Surface(program) = program.narrow(&bounds) else { continue };
            let direction = vector(3 * n + 2).normalize();
            let along = direction.to_array().map(|d| Interval::new(d - 0.05, d + 0.05));
            let slopes = program.crossing_slopes(&bounds, along).expect("its sign is that of leaves");
            // Give or take 0 rounded outwards.
            let (rises, falls) = (slopes.lo() > -1e-14, slopes.hi() < 1e-14);
            rising += u32::from(rises);
            falling += u32::from(falls);
            for m in 0..20 {
                let direction = (direction + 0.04 * vector(m + 20 * n)).normalize();
                let start = bounds.min + bounds.size() * (vector(m + 20 * n + 7) + 1.0) / 2.0;
                let points =
                    (0..40).map(|k| start + f64::from(k) * 0.02 * direction).take_while(|&p| bounds.contains(p));
                let inside: Vec<bool> = points.map(|p| program.value(p) > 0.0).collect();
                for pair in inside.windows(2) {
                    assert!(!(rises && pair[0] && !pair[1]), "{bounds:?} {start} {direction}");
                    assert!(!(falls && !pair[0] && pair[1]), "{bounds:?} {start} {direction}");
                }
            }
        }
        assert!(rising > 100 && falling > 100, "{rising} {falling}");
    }
}
