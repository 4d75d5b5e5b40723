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

use std::cell::RefCell;

use glam::DVec3;

use super::program::{Kind, Node, Program};
use super::scene::Instance;
use crate::{Bounds, Dual, Interval};
use rvachev_field::{Along, Crease, Rule, Segment, Zone};

/// Slopes along the rays in a box with directions in `along`. What is asked of a leaf for the one
/// question is kept for the other.
pub(crate) struct RaySlopes<'a> {
    program: &'a Program,
    bounds: &'a Bounds,
    along: [Interval; 3],
    told: RefCell<Vec<(u32, Dual<Interval>)>>,
}

impl RaySlopes<'_> {
    /// The value of a leaf that is not deformed, and its slopes.
    fn leaf(&self, leaf: u32) -> Dual<Interval> {
        let known = self.told.borrow().iter().find(|(number, _)| *number == leaf).map(|(_, dual)| *dual);
        known.unwrap_or_else(|| {
            let dual = self.program.leaf(leaf, sides(self.bounds, self.along));
            self.told.borrow_mut().push((leaf, dual));
            dual
        })
    }

    /// Those of the value.
    pub(crate) fn value(&self) -> Interval {
        let RaySlopes { program, bounds, along, .. } = *self;
        let value = match program.is_deformed() {
            true => program.evaluate(sides(bounds, along), &mut Vec::new()),
            false => program.evaluate_leaves(|leaf| self.leaf(leaf), &mut Vec::new()),
        };
        value.gradient()[0]
    }

    /// Those that leaves have where they change their signs: 0 if there are none. Where all
    /// are at least 0, a ray goes inside at most once and does not come out; where all are at most
    /// 0, it does not go inside. `None` where the sign is not that of leaves, and where leaves are
    /// deformed: there it costs more than it tells.
    pub(crate) fn crossing(&self) -> Option<Interval> {
        let RaySlopes { program, bounds, along, .. } = *self;
        if program.is_deformed() {
            return None;
        }
        let mut ways = vec![[false; 2]; program.nodes.len()];
        ways[program.root.node()][usize::from(program.root.negated())] = true;
        let mut slopes: Option<Interval> = None;
        for (at, node) in program.nodes.iter().enumerate().rev() {
            let [plain, negated] = ways[at];
            if !(plain || negated) {
                continue;
            }
            match &node.kind {
                Kind::Leaf(leaf) => {
                    let Some(slope) = program.crossing(*leaf, self.leaf(*leaf), (bounds, along), PARTS) else {
                        continue;
                    };
                    for slope in [plain.then_some(slope), negated.then_some(-slope)].into_iter().flatten() {
                        slopes = Some(slopes.map_or(slope, |slopes| slopes.hull(slope)));
                    }
                }
                Kind::Join { rule: Rule::MinMax, .. } => {
                    for edge in program.list(node) {
                        let way = &mut ways[edge.node()];
                        way[usize::from(edge.negated())] |= plain;
                        way[usize::from(!edge.negated())] |= negated;
                    }
                }
                Kind::Join { .. } | Kind::Shift(_) => return None,
            }
        }
        Some(slopes.unwrap_or(Interval::ZERO))
    }
}

impl Program {
    /// The slopes along rays in a box with directions in `along`.
    pub(crate) fn ray_slopes<'a>(&'a self, bounds: &'a Bounds, along: [Interval; 3]) -> RaySlopes<'a> {
        RaySlopes { program: self, bounds, along, told: RefCell::new(Vec::new()) }
    }

    /// What is known of the value along a segment.
    pub(crate) fn along(&self, segment: &Segment) -> Along {
        if let [Node { kind: Kind::Leaf(leaf), .. }] = self.nodes[..]
            && let Instance { frame: 0, placement, field, .. } = self.instance(leaf)
        {
            let along = field.along(&segment.placed(placement)).placed(placement);
            return if self.root.negated() { along.turned() } else { along };
        }
        Along::of(self.evaluate(segment.sides(), &mut Vec::new()))
    }

    /// Whether any of its leaves is deformed.
    pub(crate) fn is_deformed(&self) -> bool {
        !self.frames.is_empty()
    }

    /// The planes through a box at which slopes of a leaf have no bound; of leaves that are not
    /// deformed, and of none where there are many.
    pub(crate) fn creases(&self, bounds: &Bounds) -> Vec<Crease> {
        let mut found = Vec::new();
        if self.nodes.len() > FEW {
            return found;
        }
        for leaf in self.nodes.iter().filter_map(Node::valued_by) {
            let Instance { frame, to_local, field, .. } = self.instance(leaf);
            if *frame != 0 {
                continue;
            }
            let back = to_local.matrix3.transpose();
            let region = Zone::of_bounds(bounds).mapped(to_local).hull();
            found.extend(field.creases(region).into_iter().map(|crease| Crease {
                normal: back * crease.normal,
                offset: crease.offset - crease.normal.dot(to_local.translation),
                ..crease
            }));
        }
        found.retain(|crease| crosses(crease, bounds));
        found
    }

    /// A range of the slopes along rays in a box with directions in `along`, of those parts of the
    /// rays that are on the same side of all creases as the point `beside`. The program has no
    /// deformations.
    pub(crate) fn slopes_beside(&self, bounds: &Bounds, along: [Interval; 3], beside: DVec3) -> Interval {
        let (p, is_single) = (sides(bounds, along), self.nodes.len() == 1);
        let leaf = |leaf: u32| {
            let instance = self.instance(leaf);
            let Instance { to_local, placement, field, .. } = instance;
            let p = placement.apply(p);
            let slopes = field.slopes_beside(p, to_local.transform_point3(beside));
            // A value tells which of several leaves counts.
            let zone = || Zone::of_bounds(bounds).mapped(to_local);
            let value = if is_single { Interval::ALL } else { field.range(&zone()) };
            placement.finish(Dual::new(value, slopes))
        };
        self.evaluate_leaves(leaf, &mut Vec::new()).gradient()[0]
    }

    /// The slopes of a leaf where it is 0, by what is known of it in the box; those in the parts of
    /// the box that it crosses, one behind the other, if they are not of one sign (and the leaf
    /// costs little).
    fn crossing(
        &self,
        leaf: u32,
        known: Dual<Interval>,
        (bounds, along): (&Bounds, [Interval; 3]),
        parts: u32,
    ) -> Option<Interval> {
        if !known.value().contains(0.0) {
            return None;
        }
        let slope = known.gradient()[0];
        let is_dear = self.instance(leaf).field.cost() > 1;
        if parts == 0 || is_dear || slope.lo() >= 0.0 || slope.hi() <= 0.0 {
            return Some(slope);
        }
        let axis = (0..3).max_by(|&a, &b| along[a].magnitude().total_cmp(&along[b].magnitude())).unwrap_or(0);
        let (mut near, mut far) = (*bounds, *bounds);
        near.max[axis] = bounds.center()[axis];
        far.min[axis] = near.max[axis];
        let slopes = [near, far].map(|part| {
            let known = self.leaf(leaf, sides(&part, along));
            self.crossing(leaf, known, (&part, along), parts - 1)
        });
        slopes.into_iter().flatten().reduce(Interval::hull)
    }
}

/// A box whose sides change along a ray with a direction in `along`.
fn sides(bounds: &Bounds, along: [Interval; 3]) -> [Dual<Interval>; 3] {
    [0, 1, 2].map(|axis| {
        let side = Interval::new(bounds.min[axis], bounds.max[axis]);
        Dual::new(side, [along[axis], Interval::point(0.0), Interval::point(0.0)])
    })
}

/// How far along a ray a plane is.
pub(crate) fn distance(crease: &Crease, origin: DVec3, direction: DVec3) -> f64 {
    (crease.offset - crease.normal.dot(origin)) / crease.normal.dot(direction)
}

/// Whether a plane passes a box.
fn crosses(crease: &Crease, bounds: &Bounds) -> bool {
    let from = crease.normal.dot(bounds.center()) - crease.offset;
    from.abs() <= crease.normal.abs().dot(bounds.half_extents())
}

/// How many times a box is halved.
const PARTS: u32 = 1;

/// Programs of more nodes are not asked for planes.
const FEW: usize = 8;

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::Crease;
    use crate::eval::Region;
    use crate::{Bounds, Gielis, Interval, Profile, Solid, Superpolygon, Supershape, rad};

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
            let slopes = program.ray_slopes(&bounds, along).crossing().expect("its sign is that of leaves");
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

    /// A formula that jumps.
    #[cfg(feature = "formula")]
    fn steps() -> Solid {
        formula("x var-x\nz var-z\nh const 0.5\nt sub x z\nm mod t h\nf floor x\na add m f\nout sub z a")
    }

    /// One with more jumps than it tells of.
    #[cfg(feature = "formula")]
    fn many_steps() -> Solid {
        formula("x var-x\nz var-z\nk const 2000\nt mul x k\nf floor t\nc const 0.001\na mul f c\nout sub z a")
    }

    #[cfg(feature = "formula")]
    fn formula(text: &str) -> Solid {
        let half = DVec3::splat(1.2);
        Solid::from(crate::Formula::from_vm(text, Bounds::new(-half, half)).expect("the text is a formula"))
    }

    /// On one side of all creases of a box, slopes are within what is told of that side.
    #[test]
    fn slopes_beside_creases_are_within_bounds() {
        let g = Gielis::new;
        let blades = Solid::from(Supershape::new(g(5.0, 0.3, 0.3, 0.3), g(4.0, 2.0, 2.0, 2.0)));
        let poles = Solid::from(Supershape::new(g(6.0, 1.0, 1.7, 1.7), g(4.0, 1.0, 1.5, 0.6)));
        let solids = [
            blades.rotate_x(rad(0.4)),
            poles.rotate_z(rad(1.1)).translate([0.1, 0.0, 0.2]),
            Solid::superellipsoid([1.0, 0.8, 0.6], 2.5, 2.5),
            Solid::superellipsoid([1.0, 0.8, 0.6], 3.0, 0.3).rotate_y(rad(0.3)),
            Solid::superellipsoid([1.0, 0.8, 0.6], 0.3, 3.0) | Solid::sphere(0.3).translate([0.5, 0.5, 0.5]),
            Profile::from(Superpolygon::new(g(5.0, 0.4, 0.5, 0.5), 1.0)).extrude(1.0),
            // Close to the axis, where cusps are close to each other.
            Profile::from(Superpolygon::new(g(5.0, 0.4, 0.5, 0.5), 5.0)).column(),
            #[cfg(feature = "formula")]
            steps().rotate_z(rad(0.2)),
            #[cfg(feature = "formula")]
            (steps() | many_steps()),
        ];
        let random = |n: u32| {
            f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(32)
        };
        let vector = |n: u32| DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2)) * 2.0 - 1.0;
        for (number, solid) in solids.iter().enumerate() {
            let program = solid.surface_program().expect("the solid is valid");
            let (mut parted, mut told, mut seen) = (0, 0, 0);
            for n in 0..600 {
                let bounds = Bounds::from_center(vector(3 * n), (vector(3 * n + 1).abs() + 0.05) * 0.1);
                let creases = program.creases(&bounds);
                if creases.is_empty() {
                    continue;
                }
                parted += 1;
                let direction = vector(3 * n + 2).normalize();
                let along = direction.to_array().map(|d| Interval::new(d - 0.01, d + 0.01));
                let inside = |m: u32| bounds.min + bounds.size() * (vector(m) + 1.0) / 2.0;
                let beside = inside(40 * n + 5);
                let slopes = program.slopes_beside(&bounds, along, beside);
                told += u32::from(slopes.lo() >= 0.0 || slopes.hi() <= 0.0);
                for p in (0..40).map(|m| inside(m + 40 * n + 7)) {
                    let above = |crease: &Crease, p: DVec3| crease.normal.dot(p) > crease.offset;
                    if creases.iter().all(|crease| above(crease, p) == above(crease, beside)) {
                        let slope = program.gradient(p).1.dot(direction);
                        let slack = 1e-9 * (1.0 + slope.abs());
                        seen += 1;
                        assert!(
                            slope > slopes.lo() - slack && slope < slopes.hi() + slack,
                            "{number}: {slope} at {p} beside {beside}, {slopes:?}, {bounds:?}"
                        );
                    }
                }
            }
            assert!(parted > 30 && told > 0 && seen > 300, "{number}: {parted} {told} {seen}");
        }
    }
}
