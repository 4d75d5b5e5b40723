//! Whatever parameters a fit may come to, the solid of them is valid.

use glam::{DMat3, DVec2, DVec3};

use super::deformable::Deformable;
use super::gielis::{Curve, Supershaped, Ties};
use super::kernel::Model;
use super::random::Random;
use super::result::Shape;
use super::superquadric::Superquadric;
use super::{deformed, supershape};
use crate::Superellipsoid;

/// A random walk of steps within the limits, most of them along whole limits: it comes to all
/// corners.
fn walked<M: Model<N>, const N: usize>(start: M, random: &mut Random) -> M {
    let drift: [usize; N] = std::array::from_fn(|_| random.below(2));
    (0..60).fold(start, |model, _| {
        let limits = model.limits();
        let step = std::array::from_fn(|i| {
            let side = if random.below(5) == 0 { 1 - drift[i] } else { drift[i] };
            limits[i][side] * if random.below(3) == 0 { random.unit() } else { 1.0 }
        });
        model.moved(&step)
    })
}

#[test]
fn all_that_a_descent_may_come_to_is_a_solid() {
    let base = Superquadric {
        e: [0.4, 1.3],
        semi_axes: DVec3::new(1.2, 0.8, 2.0),
        rotation: DMat3::IDENTITY,
        center: DVec3::ZERO,
    };
    let mut random = Random::new(11);
    for round in 0..300 {
        let size = [1e-4, 1e-3, 1.0, 1e5, 1e6][round % 5];
        let shape = match round % 4 {
            0 => {
                let Superquadric { e: [e1, e2], semi_axes, .. } = walked(base, &mut random);
                Shape::Superellipsoid(Superellipsoid::new(semi_axes * size, e1, e2))
            }
            1 => {
                let start = Deformable { base, taper: [0.0; 2], twist: 0.0, bend: DVec2::ZERO };
                Shape::Deformed(deformed::leaf(&walked(start, &mut random), size))
            }
            _ => {
                let curve = |m| Curve { m, n: [3.0, 4.0, 2.5] };
                let start = Supershaped {
                    equator: curve(2 + random.below(31) as u32),
                    meridian: curve(2 + random.below(5) as u32),
                    semi_axes: base.semi_axes,
                    rotation: base.rotation,
                    center: base.center,
                    ties: Ties::Free,
                    rational: false,
                };
                Shape::Supershape(supershape::leaf(&walked(start, &mut random), size))
            }
        };
        let bounds = shape.solid().bounds();
        assert!(bounds.is_ok(), "{round}: {bounds:?} of {shape:?}");
    }
}
