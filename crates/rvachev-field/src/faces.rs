//! The faces of leaves: smooth leaves that they are joined from.

use std::any::Any;
use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{AnyField, Circle, Cuboid, Cylinder, HalfSpace, Opening, Prism, RegularPolygon};
use crate::Angle;

/// Leaves of more faces than this are left as they are.
const MOST: u32 = 64;

/// What a leaf is joined from.
pub struct Faces {
    /// Whether it is the union of what its faces bound, and not the intersection.
    pub is_union: bool,
    pub leaves: Vec<Arc<dyn AnyField>>,
}

/// The faces that meet in concave edges of a leaf, or of its complement.
///
/// Outside of concave edges the distance to the leaf is the least of those to its faces; it has creases
/// where two of these are equal. Outside of convex edges it has none.
pub fn concave_faces(leaf: &dyn AnyField, complement: bool) -> Option<Faces> {
    let any: &dyn Any = leaf;
    let mut leaves: Vec<Arc<dyn AnyField>> = Vec::new();
    let mut add = |normal: DVec3, offset: f64| leaves.push(Arc::new(HalfSpace { normal, offset }));
    let mut is_union = false;
    if let Some(opening) = any.downcast_ref::<Opening>() {
        is_union = opening.angle > Angle::HALF_TURN;
        if is_union == complement {
            return None;
        }
        add(-DVec3::Y, 0.0);
        add(DVec2::from_angle(opening.angle.radians()).perp().extend(0.0), 0.0);
        return Some(Faces { is_union, leaves });
    }
    if !complement {
        return None;
    }
    if let Some(Cuboid { size }) = any.downcast_ref() {
        for axis in DVec3::AXES {
            [axis, -axis].into_iter().for_each(|normal| add(normal, 0.5 * axis.dot(*size)));
        }
    } else if let Some(Cylinder { radius, height }) = any.downcast_ref() {
        [DVec3::Z, -DVec3::Z].into_iter().for_each(|normal| add(normal, 0.5 * height));
        leaves.push(Arc::new(Circle { radius: *radius }));
    } else if let Some(prism) = any.downcast_ref::<Prism>() {
        [DVec3::Z, -DVec3::Z].into_iter().for_each(|normal| add(normal, 0.5 * prism.height()));
        sides(prism.sides(), 0.5, prism.inscribed_radius(), &mut add)?;
    } else if let Some(polygon) = any.downcast_ref::<RegularPolygon>() {
        sides(polygon.sides(), 0.0, polygon.inscribed_radius(), &mut add)?;
    } else {
        return None;
    }
    Some(Faces { is_union, leaves })
}

/// The sides of a regular polygon; the normal of the first is so many sectors from the x axis.
fn sides(count: u32, first: f64, inscribed: f64, add: &mut impl FnMut(DVec3, f64)) -> Option<()> {
    for n in (0..count).take_while(|_| count <= MOST) {
        let angle = TAU * (f64::from(n) + first) / f64::from(count);
        add(DVec2::from_angle(angle).extend(0.0), inscribed);
    }
    (count <= MOST).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rvachev_num::rad;

    fn check(leaf: &dyn AnyField, complement: bool) {
        let faces = concave_faces(leaf, complement).expect("faces");
        let mut count = 0;
        for n in 0..4000u32 {
            // Two turns of three radii and so on: points all about.
            let along = |step: f64| (f64::from(n) * step).fract() * 3.0 - 1.5;
            let p = [along(0.754_877_666), along(0.569_840_291), along(0.380_277_569)];
            let values = faces.leaves.iter().map(|face| face.value(p));
            let joined = if faces.is_union { values.fold(f64::MIN, f64::max) } else { values.fold(f64::MAX, f64::min) };
            let value = leaf.value(p);
            assert_eq!(value > 1e-12, joined > 1e-12, "{leaf:?} at {p:?}: {value}, by faces {joined}");
            // On the side that the edges are concave on, they tell the distance.
            if (value > 0.0) == complement {
                assert!((value - joined).abs() < 1e-12, "{leaf:?} at {p:?}: {value}, by faces {joined}");
                count += 1;
            }
        }
        assert!(count > 100);
    }

    #[test]
    fn the_least_distance_to_a_face_is_that_to_the_leaf() {
        check(&Cuboid { size: DVec3::new(1.0, 1.5, 2.0) }, true);
        check(&Cylinder { radius: 0.7, height: 1.6 }, true);
        check(&Prism::new(5, 1.0, 1.2), true);
        check(&RegularPolygon::new(6, 1.0), true);
        check(&Opening { angle: rad(5.0) }, false);
        check(&Opening { angle: rad(2.0) }, true);
    }
}
