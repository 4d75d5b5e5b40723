//! Leaves are where their solids are.

use glam::{DVec2, DVec3};

use super::leaf::{Leaf, Shape, along};
use super::outline::Outline;
use crate::{Gielis, Prism, Rectangle, Superellipsoid, Superpolygon, Supershape};

/// One of each kind.
pub(super) fn leaves() -> Vec<Leaf> {
    let axis = DVec3::new(1.0, 2.0, -0.5).normalize();
    let origin = DVec3::new(0.1, -0.05, 0.2);
    let corners = [[-0.2, -0.1], [0.2, -0.1], [0.1, 0.2]].map(DVec2::from_array).to_vec();
    let posed = |shape| Leaf { shape, rotation: along(axis), centre: origin };
    vec![
        Leaf::half_space(axis, 0.1),
        Leaf::cuboid(along(axis), [DVec3::new(-0.1, -0.2, -0.3), DVec3::new(0.3, 0.1, 0.2)]),
        Leaf::cylinder(axis, origin, 0.2, [-0.3, 0.1]),
        Leaf::cone(axis, origin, [0.2, -0.5], [-0.2, 0.9]).unwrap(),
        Leaf::sphere(origin, 0.3),
        Leaf::torus(axis, origin, 0.3, 0.1),
        posed(Shape::Prism(Prism::new(5, 0.3, 0.2))),
        posed(Shape::RoundedRectangle { base: Rectangle { size: DVec2::new(0.4, 0.3), radius: 0.1 }, height: 0.2 }),
        posed(Shape::Profile { outline: Outline::polygon(corners.clone()), height: 0.3 }),
        posed(Shape::Profile { outline: Outline { corners, radii: vec![0.3, 0.0, -0.4] }, height: 0.3 }),
        posed(Shape::Supershape { base: Superpolygon::new(Gielis::new(5.0, 4.0, 6.0, 6.0), 0.2), height: 0.4 }),
        posed(Shape::Superellipsoid(Superellipsoid::new([0.3, 0.2, 0.25], 0.5, 1.2))),
        posed(Shape::Supersolid(
            Supershape::new(Gielis::new(5.0, 4.0, 6.0, 6.0), Gielis::new(4.0, 3.0, 3.0, 3.0)).scaled([0.2, 0.3, 0.25]),
        )),
    ]
}

#[test]
fn a_leaf_is_where_its_solid_is() {
    let leaves = leaves();
    let centre = DVec3::new(7.0, -2.0, 1.0);
    for leaf in &leaves {
        let solid = leaf.outward(centre, 40.0).solid();
        for i in 0..400_u32 {
            let p = DVec3::from_array([1, 7, 49].map(|k| f64::from(i * k % 343) / 343.0 - 0.5));
            let there = solid.contains(centre + 40.0 * p).unwrap();
            assert_eq!(leaf.contains(p), there, "{} at {p}", leaf.kind());
            assert_eq!(leaf.distance(p) < 0.0, there, "{} at {p}", leaf.kind());
        }
    }
}

#[test]
fn what_is_within_all_faces_is_inside() {
    for leaf in leaves() {
        for i in 0..400_u32 {
            let p = DVec3::from_array([1, 7, 49].map(|k| f64::from(i * k % 343) / 343.0 - 0.5));
            let most = leaf.faces(p).into_iter().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(most < 0.0, leaf.distance(p) < 0.0, "{} at {p}: {most}", leaf.kind());
        }
    }
}

#[test]
fn gradients_point_out() {
    for leaf in leaves() {
        let mut p = leaf.centre + DVec3::new(0.3, 0.2, 0.4);
        for _ in 0..8 {
            p -= leaf.distance(p) * leaf.gradient(p);
        }
        assert!(leaf.distance(p).abs() < 1e-3, "{}: {}", leaf.kind(), leaf.distance(p));
        assert!(leaf.distance(p + 0.01 * leaf.gradient(p)) > 0.0, "{}", leaf.kind());
    }
}
