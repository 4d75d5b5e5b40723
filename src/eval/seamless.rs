//! Operands that meet without a gap.
//!
//! ```text
//!     +-----+-----+   Two boxes side by side: all about the face that they share ranges contain 0,
//!     |  a  |  b  |   so that a gap may be there, or a wall where they are cut away. But a + b,
//!     +-----+-----+   their slopes made equally long, is 0: where a is outside b is not.
//! ```
//!
//! Of each two faces it is seen by values and ranges of slopes which pairs of signs they cannot
//! have together. The region is seamless where all signs that are left make the whole inside, or
//! all outside. Slopes tell nothing of values that jump, or come of a search.

use super::program::{Kind, Program};
use super::scene::Instance;
use crate::{Bounds, Dual, Interval};
use rvachev_field::Zone;

/// Of more faces signs are not looked at.
const MANY: usize = 8;

/// Values of less than this, in proportion to slopes and lengths about the region, are rounding.
const ROUNDING: f64 = 1e-12;

/// One of the numbers of which the least has the sign of a leaf's value, in a region: in the
/// middle, its slopes throughout, and a bound of them.
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

    /// Ranges over a point or a region of numbers of which the least has the sign of a leaf's
    /// value, given the world's point and those of the frames.
    pub(super) fn leaf_faces(
        &self,
        leaf: u32,
        (world, frames): ([Dual<Interval>; 3], &[[Dual<Interval>; 3]]),
    ) -> Vec<Dual<Interval>> {
        let Instance { field, placement, frame, .. } = self.instance(leaf);
        let p = self.in_frame(frames, *frame, world);
        if placement.shift != 0.0 { vec![self.leaf(leaf, p)] } else { field.faces(placement.apply(p)) }
    }

    /// The faces of all leaves that may have either sign in a region; none if these are many.
    fn faces(&self, region: &Bounds) -> Option<Vec<Face>> {
        let (centre, size, scale) = (region.center(), region.size(), scale(region));
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
            let of =
                |(p, frames): &([Dual<Interval>; 3], Vec<[Dual<Interval>; 3]>)| self.leaf_faces(leaf, (*p, frames));
            for (middle, all) in std::iter::zip(of(&middle), of(&all)) {
                let slopes = all.d.map(Interval::magnitude);
                let steepest = slopes.into_iter().fold(0.0, f64::max);
                // What jumps changes by more than its slopes tell: they are taken for without
                // bound.
                let change = slopes[0] * size.x + slopes[1] * size.y + slopes[2] * size.z;
                let is_told =
                    self.instance(leaf).field.is_steady() && all.v.width() <= change + ROUNDING * scale * steepest;
                let steepest = if is_told { steepest } else { f64::INFINITY };
                let is_within = all.v.lo() > 0.0;
                if !is_within {
                    faces.push(Face { leaf, value: middle.v.mid(), slopes: all.d, steepest });
                }
            }
            if faces.len() > MANY {
                return None;
            }
        }
        Some(faces)
    }
}

/// Lengths about a region, which rounding is in proportion to.
fn scale(region: &Bounds) -> f64 {
    region.min.abs().max(region.max.abs()).max_element()
}

/// The faces, by their places in a list, and the signs that they cannot have together within a
/// region, 1 for within, by more than rounding.
fn contrary_pairs(faces: &[Face], region: &Bounds) -> Vec<([usize; 2], [u32; 2])> {
    let (half, scale) = (0.5 * region.size(), scale(region));
    let mut pairs = Vec::new();
    for (j, b) in faces.iter().enumerate() {
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
    use glam::DVec3;

    use crate::distance::compiled;
    use crate::field::{Field, Real};
    use crate::{Bounds, ParamError, Solid, rad};

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

    /// A ball with a plateau of 0 around it.
    #[derive(Clone, Copy, Debug)]
    struct Plateau;

    /// Inside on one side of a plane, by values that jump there; elsewhere flat, or steep.
    #[derive(Clone, Copy, Debug)]
    struct Jump(f64);

    macro_rules! field {
        ($name:ident, $text:literal, |$own:ident, $p:ident| $value:expr) => {
            impl Field for $name {
                fn name(&self) -> &'static str {
                    $text
                }

                fn eval<R: Real>(&self, $p: [R; 3]) -> R {
                    let $own = self;
                    $value
                }

                fn bounds(&self) -> Bounds {
                    Bounds::from_center(DVec3::ZERO, DVec3::splat(4.0))
                }

                fn check(&self) -> Result<(), ParamError> {
                    Ok(())
                }
            }
        };
    }

    field!(Plateau, "plateau", |_own, p| {
        let [x, y, z] = p;
        (x.lift(1.0) - (x * x + y * y + z * z)).max(x.lift(0.0))
    });
    field!(Jump, "jump", |own, p| {
        let [x, _, _] = p;
        let rise = x * own.0;
        x.select(rise + 1.0, rise - 1.0)
    });

    #[test]
    fn what_is_flat_or_jumps_is_not_taken_for_inside() {
        let wall = Solid::cuboid([0.01, 3.0, 3.0]).translate([1.5, 0.0, 0.0]);
        let is_seamless = |solid: &Solid, at: [f64; 3]| {
            compiled(solid).unwrap().surface.is_seamless(&Bounds::from_center(at, DVec3::splat(0.1)))
        };
        let plateau = Solid::new(Plateau);
        for solid in [&wall | &plateau, &wall - &plateau, &plateau | &wall] {
            assert!(!is_seamless(&solid, [1.5, 0.1, 0.2]), "{solid}");
        }
        // Distances from a surface that is measured are found by a search.
        let half = Solid::cuboid([1.0, 2.0, 1.0]);
        let measured = (half.translate([-0.5, 0.0, 0.0]) | half.translate([0.5, 0.0, 0.0])).offset(-0.25);
        let tower = &measured | Solid::cuboid([1.5, 1.5, 1.0]).translate([0.0, 0.0, 0.75]);
        let at = [0.22, 0.31, 0.253];
        assert!(!is_seamless(&tower, at) && is_seamless(&(&measured | !&measured), at));
        for slope in [0.0, 1.0, -8.0] {
            let jump = Solid::new(Jump(slope));
            for solid in [jump.clone(), &jump | &wall, !&jump, &jump - &wall] {
                assert!(!is_seamless(&solid, [0.003, 0.1, 0.2]), "{solid}");
            }
            // Whatever it is, nothing is between it and its complement.
            assert!(is_seamless(&(&jump | !&jump), [0.003, 0.1, 0.2]));
        }
    }
}
