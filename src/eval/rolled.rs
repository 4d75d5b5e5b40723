//! Where a ball rolls there is no fillet.
//!
//! ```text
//!          .--------.
//!         /          \        The middle c of a ball at rest is the foot of each point x that the
//!        |     c      |       ball may not get to, and no other point is farther from where balls
//!        |    /       |       may be than from c: what is in the ball about c is not filled, all of
//!         \  /       /        it, however many faces it lies at.
//!     -----\/-------'----
//!           x
//! ```

use glam::{DMat3, DVec3};

use super::composite::unscaled;
use super::few::Few;
use super::fill::Fill;
use super::program::Program;
use rvachev_field::kernel::{distinct, repeat};
use rvachev_field::{Chunk, EmptyBalls, Zone};

/// How far a map of lengths may be off one.
const SIMILAR: f64 = 1e-9;

/// What is left of radii after rounding, in roundings.
const ROUNDINGS: f64 = 4.0;

impl EmptyBalls for Fill {
    fn empty_balls(&self, chunk: Chunk<'_, f32, 4>) {
        let Chunk { points, placement, out: [radius, x, y, z] } = chunk;
        let count = distinct(points);
        let all = Few::of(0..count, points);
        // Lengths of the frame in those of the points.
        let length = placement.map().matrix3.determinant().abs().cbrt().recip();
        let point = |i: usize| [0, 1, 2].map(|axis| f64::from(points[axis][i]));
        let reach = |i: usize| placement.apply(point(i)).into_iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let rounding = ROUNDINGS * self.ball.field.roundoff((0..count).map(reach).fold(0.0, f64::max));
        let whole = self.radius + self.margin - rounding;
        for (i, (apart, slope)) in all.slopes(&self.ball, &unscaled(placement)).into_iter().enumerate() {
            let (more, away) = if apart > 0.0 {
                (0.0, length * apart * slope.normalize_or_zero())
            } else {
                // Within where the middle may be the point is one, and as deep as it is, all that is
                // filled is farther off.
                ((-apart - 2.0 * self.margin).max(apart), DVec3::ZERO)
            };
            radius[i] = (length * (whole + more)) as f32;
            for ((to, at), by) in [&mut *x, &mut *y, &mut *z].into_iter().zip(point(i)).zip(away.to_array()) {
                to[i] = (at - by) as f32;
            }
        }
        [radius, x, y, z].into_iter().for_each(|list| repeat(list, count));
    }
}

impl Program {
    /// Whether it is nothing but a fillet.
    pub(super) fn is_rolled_leaf(&self) -> bool {
        self.only_plain_leaf().is_some_and(|(leaf, _)| leaf.field.empty_balls().is_some())
    }

    /// Whether it is a leaf that tells balls in which no value is above 0, in place but for a map
    /// of lengths; and how steep its value is at most.
    pub(crate) fn rolled(&self) -> Option<f64> {
        let (leaf, is_complement) = self.only_plain_leaf()?;
        leaf.field.empty_balls()?;
        let square = leaf.to_local.matrix3.transpose() * leaf.to_local.matrix3;
        let scale = square.x_axis.x;
        let is_similar = (square - DMat3::from_diagonal(DVec3::splat(scale))).abs_diff_eq(DMat3::ZERO, SIMILAR * scale);
        let steepest = leaf.field.steepest(&Zone::of_bounds(&leaf.bounds)) * leaf.placement.scale * scale.sqrt();
        (is_similar && !is_complement).then_some(steepest)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::eval::{Evaluator, Tape};
    use crate::{Blend, Bounds, Solid, deg};

    /// Pseudo-random numbers from −1 to 1.
    fn random(n: u32) -> f64 {
        f64::from(n.wrapping_mul(2_654_435_769).rotate_left(11).wrapping_mul(2_246_822_519)) / 2f64.powi(31) - 1.0
    }

    fn vector(n: u32) -> DVec3 {
        DVec3::new(random(3 * n), random(3 * n + 1), random(3 * n + 2))
    }

    #[test]
    fn nothing_is_in_empty_balls() {
        let fillet = Blend::Fillet { radius: 0.25 };
        let plate = Solid::cuboid([2.0, 2.0, 0.4]);
        let post = Solid::superellipsoid([0.5, 0.5, 1.0], 0.3, 0.7);
        let ring = Solid::torus(0.6, 0.2).translate([0.0, 0.0, 0.35]);
        let corner = plate.clone() | Solid::cuboid([0.4, 2.0, 1.6]).translate([-0.8, 0.0, 0.6]);
        let joints = [
            plate.union_with(&post, fillet),
            plate.union_with(&ring, fillet),
            // They are not convex, so that their fillet fades away.
            corner.union_with(&post, fillet),
            Solid::union_all_with([plate.clone(), post.clone(), ring.translate([0.3, 0.0, 0.2])], fillet),
            corner.filleted(0.25),
            plate.union_with(&post, fillet).rotate_x(deg(30.0)).scale(1.7).translate([3.0, 1.0, 0.0]),
        ];
        for solid in joints {
            let program = solid.surface_program().expect("the solid is valid");
            let bounds = solid.bounds().expect("the solid is valid").inflate(0.3);
            let fillets = program.fillets(&bounds).expect("it has a fillet");
            for alone in fillets.added {
                assert!(alone.rolled().is_some());
                let tape = Tape::new(&alone, &bounds);
                let points: Vec<DVec3> = (0..400).map(|n| 0.5 * bounds.size() * vector(n)).collect();
                let axis = |axis: usize| -> Vec<f32> { points.iter().map(|p| p[axis] as f32).collect() };
                let (x, y, z) = (axis(0), axis(1), axis(2));
                let mut balls = [(); 4].map(|()| vec![0.0f32; points.len()]);
                let [radius, a, b, c] = &mut balls;
                Evaluator::new().empty_balls(&tape, [&x, &y, &z], [radius, a, b, c]);
                let mut held = 0;
                for (i, p) in points.iter().enumerate() {
                    let [radius, x, y, z] = balls.each_ref().map(|list| f64::from(list[i]));
                    let middle = DVec3::new(x, y, z);
                    held += u32::from(p.distance(middle) < radius);
                    for n in 0..60 {
                        let way = vector(1000 * i as u32 + n).normalize_or_zero();
                        let q = tape.origin() + middle + radius * random(n).abs().sqrt() * way;
                        assert!(alone.value(q) <= 0.0, "{q} in {radius} about {middle}");
                    }
                }
                assert!(held > 200, "{held}");
            }
        }
    }

    #[test]
    fn balls_are_told_of_maps_of_lengths_alone() {
        let plate = Solid::cuboid([2.0, 2.0, 0.4]);
        let joint = plate.union_with(Solid::sphere(0.5), Blend::Fillet { radius: 0.2 });
        let added = |solid: &Solid| {
            let bounds = Bounds::from_center(DVec3::ZERO, DVec3::splat(4.0));
            solid.surface_program().expect("the solid is valid").fillets(&bounds).map_or(0, |found| found.added.len())
        };
        assert_eq!(added(&joint.scale(2.0)), 1);
        assert_eq!(added(&joint.scale_axes([1.0, 1.0, 2.0])), 0);
        assert_eq!(added(&joint.twist(deg(30.0))), 0);
        // A chamfer's face ends where its ball is, and is no fillet.
        assert_eq!(added(&plate.union_with(Solid::sphere(0.5), Blend::Chamfer { leg: 0.2 })), 0);
    }
}
