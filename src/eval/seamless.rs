//! Operands that meet without a gap.
//!
//! ```text
//!     +-------+-------+      Two boxes side by side: their ranges contain 0 all about the face that they share, so
//!     |   a   |   b   |      that a gap, or a wall where they are cut away, may be there for all that these tell.
//!     +-------+-------+      But a + b, their slopes made equally long, is 0 throughout: where a is outside b is not.
//! ```
//!
//! Of each two faces it is seen by values and ranges of slopes which pairs of signs they cannot
//! have together. The region is seamless where all signs that are left make the whole inside, or
//! all outside.

use super::program::{Kind, Program};
use super::scene::Instance;
use crate::{Bounds, Dual, Interval};
use rvachev_field::Zone;

/// Of more faces signs are not looked at.
const MANY: usize = 8;

/// Values of less than this, in proportion to slopes and lengths about the region, are rounding.
const ROUNDING: f64 = 1e-12;

/// One of the numbers of which the least has the sign of a leaf's value, in a region: in the
/// middle, its slopes throughout, and a bound of their length.
struct Face {
    leaf: u32,
    value: f64,
    slopes: [Interval; 3],
    steepest: f64,
}

impl Program {
    /// Whether a region is all inside or all outside, but for what rounding leaves between operands
    /// that meet.
    pub(crate) fn is_seamless(&self, region: &Bounds) -> bool {
        let reads_values = |kind: &Kind| match kind {
            Kind::Leaf(_) => false,
            Kind::Join { rule, .. } => rule.reads_values(),
            Kind::Shift(_) => true,
        };
        if self.nodes.iter().any(|node| reads_values(&node.kind)) {
            return false;
        }
        let Some(faces) = self.faces(region) else { return false };
        let pairs = contrary_pairs(&faces, region);
        // Signs as bits: whether it is within face n.
        let may_be = |signs: u32| !pairs.iter().any(|&([i, j], [a, b])| (signs >> i & 1, signs >> j & 1) == (a, b));
        let mut values = Vec::new();
        let mut is_inside = |signs: u32| {
            let is_beyond = |(n, face): (usize, &Face), leaf: u32| face.leaf == leaf && signs >> n & 1 == 0;
            let sign = |leaf: u32| if faces.iter().enumerate().any(|face| is_beyond(face, leaf)) { -1.0 } else { 1.0 };
            self.evaluate_leaves(sign, &mut values) > 0.0
        };
        let mut sides = (0..1u32 << faces.len()).filter(|&signs| may_be(signs)).map(&mut is_inside);
        let Some(first) = sides.next() else { return false };
        sides.all(|side| side == first)
    }

    /// The faces of all leaves that may have either sign in a region; none if these are many.
    fn faces(&self, region: &Bounds) -> Option<Vec<Face>> {
        let centre = region.center();
        let [middle, all] = [Bounds::new(centre, centre), *region].map(|part| {
            let p = Dual::point(Zone::of_bounds(&part).hull());
            (p, self.frame_points(p))
        });
        let mut faces: Vec<Face> = Vec::new();
        for node in &self.nodes[..] {
            let Kind::Leaf(leaf) = node.kind else { continue };
            if faces.iter().any(|face| face.leaf == leaf) {
                continue;
            }
            let of = |(p, frames): &([Dual<Interval>; 3], Vec<[Dual<Interval>; 3]>)| {
                let p = self.in_frame(frames, self.instance(leaf).frame, *p);
                let Instance { field, placement, .. } = self.instance(leaf);
                if placement.shift != 0.0 { vec![self.leaf(leaf, p)] } else { field.faces(placement.apply(p)) }
            };
            let start = faces.len();
            for (middle, all) in std::iter::zip(of(&middle), of(&all)) {
                let steepest = all.d.map(Interval::magnitude).into_iter().fold(0.0, f64::max);
                let is_far_within = all.v.lo() > 0.0;
                if !is_far_within {
                    faces.push(Face { leaf, value: middle.v.mid(), slopes: all.d, steepest });
                }
            }
            if faces.len() == start {
                // All of the region is within the leaf.
                faces.push(Face { leaf, value: 1.0, slopes: [Interval::ZERO; 3], steepest: 0.0 });
            }
            if faces.len() > MANY {
                return None;
            }
        }
        Some(faces)
    }
}

/// The faces, by their places in a list, and the signs that they cannot have together within a
/// region, 1 for within, by more than rounding.
fn contrary_pairs(faces: &[Face], region: &Bounds) -> Vec<([usize; 2], [u32; 2])> {
    let (centre, half) = (region.center(), 0.5 * region.size());
    let scale = centre.abs().max_element() + half.max_element();
    let mut pairs = Vec::new();
    for (j, b) in faces.iter().enumerate() {
        if b.steepest == 0.0 {
            pairs.push(([j, j], [0, 0]));
        }
        for (i, a) in faces[..j].iter().enumerate() {
            let factor = a.steepest / b.steepest;
            let rounding = ROUNDING * scale * a.steepest;
            if !(factor.is_finite() && factor > 0.0 && rounding.is_finite()) {
                continue;
            }
            for (turn, sign) in [(factor, 1), (-factor, 0)] {
                let sum = a.value + turn * b.value;
                let of_axis = |axis: usize| (a.slopes[axis] + b.slopes[axis] * turn).magnitude() * half[axis];
                let spread: f64 = (0..3).map(of_axis).sum();
                // Where a + b is not below 0 one of them is within; where a − b is not, a is within
                // or b is not.
                if sum - spread >= -rounding {
                    pairs.push(([i, j], [0, 1 - sign]));
                }
                if sum + spread <= rounding {
                    pairs.push(([i, j], [1, sign]));
                }
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use crate::distance::compiled;
    use crate::{Bounds, Solid, rad};

    #[test]
    fn what_meets_is_told_from_what_is_apart() {
        let block = Solid::cuboid([2.0, 2.0, 1.0]);
        let tower = |gap: f64| &block | block.translate([0.0, 0.0, 1.0 + gap]);
        let beam = Solid::cuboid([1.0, 2.0, 1.0]);
        let three = |gap: f64| &block | beam.translate([-0.5 - gap, 0.0, 1.0]) | beam.translate([0.5, 0.0, 1.0]);
        let slab = Solid::cylinder(1.0, 1.0);
        let peg = Solid::cylinder(0.5, 1.0);
        let plug = |other: &Solid| (&block - &peg) | other;
        let wall = |gap: f64| &slab - Solid::half_space([0.0, 0.0, 1.0], 0.5 - gap);
        for turn in [0.0, 0.7] {
            let region = |at: [f64; 3]| {
                let at = Solid::sphere(0.01).translate(at).rotate_x(rad(turn)).rotate_z(rad(0.3 * turn));
                Bounds::from_center(at.bounds().unwrap().center(), [0.05, 0.06, 0.04])
            };
            let is_seamless = |solid: &Solid, at: [f64; 3]| {
                let turned = solid.rotate_x(rad(turn)).rotate_z(rad(0.3 * turn));
                compiled(&turned).unwrap().surface.is_seamless(&region(at))
            };
            let at = [0.013, 0.02, 0.503];
            for gap in [0.0, 1e-14] {
                assert!(is_seamless(&tower(gap), at) && is_seamless(&three(gap), [0.003, 0.02, 0.503]), "{turn}");
            }
            for gap in [1e-9, 1e-3] {
                assert!(!is_seamless(&tower(gap), at) && !is_seamless(&three(gap), [0.003, 0.02, 0.503]), "{turn}");
                assert!(!is_seamless(&wall(gap), at), "{turn}");
            }
            assert!(is_seamless(&wall(0.0), at) && is_seamless(&plug(&peg), [0.5, 0.01, 0.02]));
            assert!(!is_seamless(&plug(&Solid::cylinder(0.5 - 1e-9, 1.0)), [0.5, 0.01, 0.02]));
            assert!(!is_seamless(&block, at) && !is_seamless(&tower(0.0), [1.0, 0.02, 0.503]));
        }
    }
}
