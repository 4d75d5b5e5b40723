//! How a leaf may move and grow while it is fitted.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

use super::leaf::{Leaf, Shape};
use crate::{Cone, Cuboid, Cylinder, Prism, Rectangle, Sphere, Superellipsoid, Superpolygon, Torus};

/// Most numbers of any leaf.
pub(super) const MOST: usize = 11;

/// The least size of anything.
const LEAST: f64 = 1e-5;

/// Exponents of superellipsoids.
const EXPONENTS: [f64; 2] = [0.02, 2.0];

/// Whether a leaf may turn as well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axes {
    /// As they were settled. What is of no region is turned all the same.
    Kept,
    Free,
}

impl Leaf {
    /// How many numbers [`moved`](Leaf::moved) takes.
    pub(super) fn freedom(&self, axes: Axes) -> usize {
        let kept = match &self.shape {
            Shape::HalfSpace => 1,
            Shape::Sphere(_) | Shape::Profile { .. } => 4,
            Shape::Cylinder(_) | Shape::Torus(_) => 5,
            Shape::Box(_) | Shape::Cone(_) | Shape::Prism(_) | Shape::Supershape { .. } => 6,
            Shape::RoundedRectangle { .. } => 7,
            Shape::Supersolid(_) => 9,
            Shape::Superellipsoid(_) => 11,
        };
        kept + if axes == Axes::Free { self.turns() } else { 0 }
    }

    /// About how many of its axes it may be turned besides.
    pub(super) fn turns(&self) -> usize {
        match &self.shape {
            Shape::Sphere(_) | Shape::Superellipsoid(_) | Shape::Supersolid(_) => 0,
            Shape::Box(_) | Shape::RoundedRectangle { .. } | Shape::Profile { .. } => 3,
            // About its own it is the same, or turned already.
            Shape::HalfSpace
            | Shape::Cylinder(_)
            | Shape::Cone(_)
            | Shape::Torus(_)
            | Shape::Prism(_)
            | Shape::Supershape { .. } => 2,
        }
    }

    /// Whether it is of no region: all of it is found by fitting.
    pub(super) fn is_free(&self) -> bool {
        matches!(self.shape, Shape::Superellipsoid(_) | Shape::Supersolid(_) | Shape::Supershape { .. })
    }

    /// The leaf with ends, sides, radii and place changed, in its own axes; none if a size would
    /// vanish. Last come its turns, where it is free.
    ///
    /// Ends move each on its own, as one of them may be in the air, where no sample tells of it.
    pub(super) fn moved(&self, x: &[f64], axes: Axes) -> Option<Leaf> {
        let moved = self.resized(x)?;
        let turns = if axes == Axes::Free { &x[self.freedom(Axes::Kept)..][..self.turns()] } else { &[] };
        let mut turn = DVec3::ZERO;
        for (axis, by) in turns.iter().enumerate() {
            turn[axis] = *by;
        }
        Some(moved.turned_about(turn))
    }

    fn resized(&self, x: &[f64]) -> Option<Leaf> {
        let by = |d: DVec3, shape: Shape| Leaf { shape, centre: self.centre + self.rotation * d, ..*self };
        let whole = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
        let ends = |i: usize| (0.5 * (x[i] + x[i + 1]), x[i + 1] - x[i]);
        let is_left = |sizes: &[f64]| sizes.iter().all(|size| *size > LEAST).then_some(());
        Some(match &self.shape {
            Shape::HalfSpace => by(DVec3::new(0.0, 0.0, x[0]), Shape::HalfSpace),
            Shape::Box(s) => {
                let size = s.size + whole(3) - whole(0);
                is_left(&size.to_array())?;
                by(0.5 * (whole(0) + whole(3)), Shape::Box(Cuboid { size }))
            }
            Shape::Cylinder(s) => {
                let (z, longer) = ends(3);
                let (radius, height) = (s.radius + x[2], s.height + longer);
                is_left(&[radius, height])?;
                by(DVec3::new(x[0], x[1], z), Shape::Cylinder(Cylinder { radius, height }))
            }
            Shape::Cone(s) => {
                let (z, longer) = ends(4);
                let [bottom, top] = [s.bottom_radius + x[2] - x[3], s.top_radius + x[2] + x[3]];
                let slope = (top - bottom) / s.height;
                let [bottom_radius, top_radius] = [bottom + slope * x[4], top + slope * x[5]].map(|r| r.max(0.0));
                let height = s.height + longer;
                is_left(&[height, bottom_radius.max(top_radius)])?;
                by(DVec3::new(x[0], x[1], z), Shape::Cone(Cone { bottom_radius, top_radius, height }))
            }
            Shape::Sphere(s) => {
                is_left(&[s.radius + x[3]])?;
                by(whole(0), Shape::Sphere(Sphere { radius: s.radius + x[3] }))
            }
            Shape::Torus(s) => {
                let (radius, tube) = (s.radius + x[3], s.tube + x[4]);
                // And the hole.
                is_left(&[radius, tube, radius - tube])?;
                by(whole(0), Shape::Torus(Torus { radius, tube }))
            }
            Shape::Prism(s) => {
                let (z, longer) = ends(4);
                let (radius, height) = (s.radius() + x[2], s.height() + longer);
                is_left(&[radius, height])?;
                by(DVec3::new(x[0], x[1], z), Shape::Prism(Prism::new(s.sides(), radius, height))).turned(x[3])
            }
            Shape::RoundedRectangle { base, height } => {
                let (z, longer) = ends(5);
                let size = base.size + DVec2::new(x[2] - x[0], x[3] - x[1]);
                let height = height + longer;
                is_left(&[size.x, size.y, height])?;
                let radius = (base.radius + x[4]).clamp(0.0, 0.5 * size.min_element());
                let middle = DVec3::new(0.5 * (x[0] + x[2]), 0.5 * (x[1] + x[3]), z);
                by(middle, Shape::RoundedRectangle { base: Rectangle { size, radius }, height })
            }
            Shape::Profile { outline, height } => {
                let (z, longer) = ends(2);
                let height = height + longer;
                is_left(&[height])?;
                by(DVec3::new(x[0], x[1], z), Shape::Profile { outline: outline.clone(), height })
            }
            Shape::Supershape { base, height } => {
                let (z, longer) = ends(4);
                let (radius, height) = (base.radius() * x[2].exp(), height + longer);
                is_left(&[radius, height])?;
                let base = Superpolygon::new(base.curve(), radius);
                by(DVec3::new(x[0], x[1], z), Shape::Supershape { base, height }).turned(x[3])
            }
            Shape::Superellipsoid(s) => {
                let semi_axes = s.semi_axes() + whole(3);
                is_left(&semi_axes.to_array())?;
                let [e1, e2] = s.exponents();
                let [e1, e2] = [e1 + x[9], e2 + x[10]].map(|e| e.clamp(EXPONENTS[0], EXPONENTS[1]));
                let shape = Shape::Superellipsoid(Superellipsoid::new(semi_axes, e1, e2));
                by(whole(0), shape).turned_about(whole(6))
            }
            Shape::Supersolid(s) => {
                let scale = s.scale() + whole(3);
                is_left(&scale.to_array())?;
                by(whole(0), Shape::Supersolid(s.scaled(scale))).turned_about(whole(6))
            }
        })
    }

    /// Turned about an axis of its own, as long as the angle.
    fn turned_about(self, turn: DVec3) -> Leaf {
        let Some(axis) = turn.try_normalize() else { return self };
        let angle = turn.length() % TAU;
        Leaf { rotation: self.rotation * DMat3::from_axis_angle(axis, angle), ..self }
    }

    /// Turned about its own z axis.
    fn turned(self, angle: f64) -> Leaf {
        if angle == 0.0 { self } else { Leaf { rotation: self.rotation * DMat3::from_rotation_z(angle), ..self } }
    }
}
