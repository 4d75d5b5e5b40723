//! The numbers that an engineer gives for a leaf, and the leaf that is made from them.
//!
//! What has two ends is told by them, what is round by its diameter; coordinates are along the
//! leaf's own axes.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};

use super::leaf::{Leaf, Shape};
use super::outline::Outline;
use crate::field::Field;
use crate::{Cone, Cuboid, Cylinder, Prism, Rectangle, Sphere, Superellipsoid, Superpolygon, Supershape, Torus};

/// What a number of a leaf is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Measure {
    /// Where it is, or ends, along its first, second or third axis.
    Place(usize),
    Diameter,
    Radius,
    Size,
    /// How far it is turned from the part's axes.
    Turn,
}

impl Measure {
    pub(super) fn name(self) -> &'static str {
        match self {
            Measure::Place(0) => "x",
            Measure::Place(1) => "y",
            Measure::Place(_) => "z",
            Measure::Diameter => "diameter",
            Measure::Radius => "radius",
            Measure::Size => "size",
            Measure::Turn => "turn",
        }
    }
}

/// Without what differences of decimals leave in the last digits.
pub(super) fn tidy(v: f64) -> f64 {
    format!("{v:.13e}").parse().unwrap_or(v)
}

/// From z to x, and from z to y: quarter turns about y and about x.
pub(super) const TO_X: DMat3 = DMat3::from_cols(DVec3::NEG_Z, DVec3::Y, DVec3::X);
pub(super) const TO_Y: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);

/// From end to end of a supershape: its scale is that of the curves, whose radii are not 1.
pub(super) fn extent(s: &Supershape) -> DVec3 {
    s.bounds().size()
}

/// The same of one that is extruded.
pub(super) fn across(base: &Superpolygon) -> DVec2 {
    base.bounds().size().truncate()
}

/// The ends along z of what is extruded or turned, first of all its numbers: x, y, low, high.
fn posed(at: DVec3, height: f64) -> Vec<(Measure, f64)> {
    let [x, y, z] = at.to_array();
    vec![
        (Measure::Place(0), x),
        (Measure::Place(1), y),
        (Measure::Place(2), z - 0.5 * height),
        (Measure::Place(2), z + 0.5 * height),
    ]
}

impl Leaf {
    /// How far it reaches from its centre along its own axes, at the most; unbounded leaves have
    /// none.
    pub(super) fn reach(&self) -> DVec3 {
        let round = |radius: f64, height: f64| DVec3::new(radius, radius, 0.5 * height);
        match &self.shape {
            Shape::HalfSpace => DVec3::ZERO,
            Shape::Box(s) => 0.5 * s.size,
            Shape::Sphere(s) => DVec3::splat(s.radius),
            Shape::Torus(s) => round(s.radius + s.tube, 2.0 * s.tube),
            Shape::Cylinder(s) => round(s.radius, s.height),
            Shape::Cone(s) => round(s.bottom_radius.max(s.top_radius), s.height),
            Shape::Prism(s) => round(s.radius(), s.height()),
            Shape::RoundedRectangle { base, height } => 0.5 * base.size.extend(*height),
            Shape::Profile { outline, height } => outline.reach().extend(0.5 * height),
            Shape::Supershape { base, height } => {
                let bounds = base.bounds();
                bounds.min.abs().max(bounds.max.abs()).truncate().extend(0.5 * height)
            }
            Shape::Superellipsoid(s) => s.semi_axes(),
            Shape::Supersolid(s) => {
                let bounds = s.bounds();
                bounds.min.abs().max(bounds.max.abs())
            }
        }
    }

    /// How high it is along its z axis, of what is extruded or turned; 0 of other shapes.
    pub(super) fn height(&self) -> f64 {
        match &self.shape {
            Shape::Cylinder(s) => s.height,
            Shape::Cone(s) => s.height,
            Shape::Prism(s) => s.height(),
            Shape::RoundedRectangle { height, .. }
            | Shape::Profile { height, .. }
            | Shape::Supershape { height, .. } => *height,
            _ => 0.0,
        }
    }

    /// By how much more than the surface each of its numbers may be off: a diameter twice as much,
    /// the radius of a flat arc many times as much as the arc's middle.
    pub(super) fn leverages(&self) -> Vec<f64> {
        let of = |(measure, _): (Measure, f64)| match measure {
            Measure::Diameter | Measure::Size => 2.0,
            _ => 1.0,
        };
        let mut all: Vec<f64> = self.measures().into_iter().map(of).collect();
        if let Shape::Profile { outline, .. } = &self.shape {
            let radii = all.len() - outline.arc_count();
            all.truncate(radii);
            all.extend(outline.leverages());
        }
        all
    }

    /// Its numbers, in an order that [`made_of`](Leaf::made_of) knows.
    pub(super) fn measures(&self) -> Vec<(Measure, f64)> {
        let at = self.rotation.transpose() * self.centre;
        let places = |at: DVec3| (0..3).map(|axis| (Measure::Place(axis), at[axis])).collect::<Vec<_>>();
        let sizes = |semi_axes: DVec3| semi_axes.to_array().map(|a| (Measure::Size, 2.0 * a)).to_vec();
        let ends = |at: DVec3, size: DVec3| {
            let both = |axis: usize| [-0.5, 0.5].map(|side| (Measure::Place(axis), at[axis] + side * size[axis]));
            (0..3).flat_map(both).collect::<Vec<_>>()
        };
        match &self.shape {
            Shape::HalfSpace => vec![(Measure::Place(2), at.z)],
            Shape::Box(s) => ends(at, s.size),
            Shape::Sphere(s) => [places(at), vec![(Measure::Diameter, 2.0 * s.radius)]].concat(),
            Shape::Torus(s) => [places(at), vec![(Measure::Radius, s.radius), (Measure::Radius, s.tube)]].concat(),
            Shape::Cylinder(s) => [posed(at, s.height), vec![(Measure::Diameter, 2.0 * s.radius)]].concat(),
            Shape::Cone(s) => {
                let diameters = [s.bottom_radius, s.top_radius].map(|radius| (Measure::Diameter, 2.0 * radius));
                [posed(at, s.height), diameters.to_vec()].concat()
            }
            Shape::Prism(s) => [posed(at, s.height()), vec![(Measure::Radius, s.radius())]].concat(),
            Shape::RoundedRectangle { base, height } => {
                [ends(at, base.size.extend(*height)), vec![(Measure::Radius, base.radius)]].concat()
            }
            Shape::Profile { outline, height } => {
                // The outline stands where it is: nothing is moved but along z.
                let corner = |c: &DVec2| [(Measure::Place(0), at.x + c.x), (Measure::Place(1), at.y + c.y)];
                let corners = outline.corners.iter().flat_map(corner);
                let arcs = outline.radii.iter().filter(|radius| **radius != 0.0);
                let radii = arcs.map(|radius| (Measure::Radius, radius.abs()));
                posed(at, *height).into_iter().skip(2).chain(corners).chain(radii).collect()
            }
            Shape::Supershape { base, height } => [posed(at, *height), vec![(Measure::Size, across(base).x)]].concat(),
            Shape::Superellipsoid(s) => [places(at), sizes(s.semi_axes())].concat(),
            Shape::Supersolid(s) => [places(at), sizes(0.5 * extent(s))].concat(),
        }
    }

    /// The same kind of leaf, along the same axes, of other numbers; none if they are those of no
    /// solid.
    pub(super) fn made_of(&self, numbers: &[f64]) -> Option<Leaf> {
        let middle = |low: f64, high: f64| tidy(0.5 * (low + high));
        let between = |low: f64, high: f64| tidy(high - low);
        let upright = || {
            let [x, y, low, high] = numbers.first_chunk::<4>()?;
            let at = DVec3::new(*x, *y, middle(*low, *high));
            (high > low).then_some((at, between(*low, *high), numbers.get(4..)?))
        };
        let boxed = || {
            let [a, b, c, d, e, f] = numbers.first_chunk::<6>()?;
            let size = DVec3::new(between(*a, *b), between(*c, *d), between(*e, *f));
            let at = DVec3::new(middle(*a, *b), middle(*c, *d), middle(*e, *f));
            (size.min_element() > 0.0).then_some((at, size))
        };
        let (shape, at) = match &self.shape {
            Shape::HalfSpace => (Shape::HalfSpace, DVec3::Z * *numbers.first()?),
            Shape::Box(_) => {
                let (at, size) = boxed()?;
                (Shape::Box(Cuboid { size }), at)
            }
            Shape::Sphere(_) => {
                let [x, y, z, diameter] = numbers.first_chunk::<4>()?;
                (Shape::Sphere(Sphere { radius: 0.5 * diameter }), DVec3::new(*x, *y, *z))
            }
            Shape::Torus(_) => {
                let [x, y, z, radius, tube] = *numbers.first_chunk::<5>()?;
                (Shape::Torus(Torus { radius, tube }), DVec3::new(x, y, z))
            }
            Shape::Cylinder(_) => {
                let (at, height, rest) = upright()?;
                (Shape::Cylinder(Cylinder { radius: 0.5 * rest.first()?, height }), at)
            }
            Shape::Cone(_) => {
                let (at, height, rest) = upright()?;
                let [bottom, top] = rest.first_chunk::<2>()?;
                (Shape::Cone(Cone { bottom_radius: 0.5 * bottom, top_radius: 0.5 * top, height }), at)
            }
            Shape::Prism(s) => {
                let (at, height, rest) = upright()?;
                (Shape::Prism(Prism::new(s.sides(), *rest.first()?, height)), at)
            }
            Shape::RoundedRectangle { .. } => {
                let (at, size) = boxed()?;
                // Of a slot the radius is half of a side, which may be rounded otherwise.
                let radius = numbers.get(6)?.clamp(0.0, 0.5 * size.truncate().min_element());
                let base = Rectangle { size: size.truncate(), radius };
                (Shape::RoundedRectangle { base, height: size.z }, at)
            }
            Shape::Profile { outline, .. } => {
                let [low, high] = numbers.first_chunk::<2>()?;
                let (places, radii) = numbers.get(2..)?.split_at_checked(2 * outline.corners.len())?;
                let corners = places.chunks_exact(2).map(|c| DVec2::new(c[0], c[1])).collect();
                let mut left = radii.iter();
                let radius = |old: &f64| if *old == 0.0 { Some(0.0) } else { left.next().map(|r| r * old.signum()) };
                let radii = outline.radii.iter().map(radius).collect::<Option<Vec<f64>>>()?;
                let height = between(*low, *high);
                let shape = Shape::Profile { outline: Outline { corners, radii }, height };
                (height > 0.0).then_some((shape, DVec3::Z * middle(*low, *high)))?
            }
            Shape::Supershape { base, .. } => {
                let (at, height, rest) = upright()?;
                let radius = base.radius() * rest.first()? / across(base).x;
                (Shape::Supershape { base: Superpolygon::new(base.curve(), radius), height }, at)
            }
            Shape::Superellipsoid(s) => {
                let [x, y, z, a, b, c] = *numbers.first_chunk::<6>()?;
                let [e1, e2] = s.exponents();
                (Shape::Superellipsoid(Superellipsoid::new(0.5 * DVec3::new(a, b, c), e1, e2)), DVec3::new(x, y, z))
            }
            Shape::Supersolid(s) => {
                let [x, y, z, a, b, c] = *numbers.first_chunk::<6>()?;
                (Shape::Supersolid(s.scaled(s.scale() * DVec3::new(a, b, c) / extent(s))), DVec3::new(x, y, z))
            }
        };
        Some(Leaf { shape, rotation: self.rotation, centre: self.rotation * at })
    }

    /// The same leaf, turned and moved.
    pub(super) fn turned_by(&self, by: &DAffine3) -> Leaf {
        Leaf {
            shape: self.shape.clone(),
            rotation: by.matrix3 * self.rotation,
            centre: by.transform_point3(self.centre),
        }
    }

    /// The same leaf, described along the part's axes where it lies along them to within a part of
    /// a radian: a box needs no turning then, what is turned about an axis none but from z to it.
    pub(super) fn aligned(&self, within: f64) -> Leaf {
        let rounded = DMat3::from_cols_array(&self.rotation.to_cols_array().map(f64::round));
        let is_aligned = (self.rotation - rounded).to_cols_array().iter().all(|off| off.abs() < within)
            && (rounded.determinant() - 1.0).abs() < 0.5;
        let axis = self.rotation.z_axis;
        let along = DVec3::from_array(axis.to_array().map(f64::round));
        let is_along = (axis - along).abs().max_element() < within && along.length_squared() == 1.0;
        let (mut leaf, is_round) = (self.clone(), self.is_round());
        match &mut leaf.shape {
            Shape::Box(s) if is_aligned => {
                s.size = (rounded * s.size).abs();
                leaf.rotation = DMat3::IDENTITY;
            }
            Shape::HalfSpace | Shape::Sphere(_) => {}
            shape if is_round && is_along => {
                leaf.rotation = [TO_X, TO_Y, DMat3::IDENTITY][along.abs().max_position()];
                if let Shape::Cone(s) = shape
                    && along.element_sum() < 0.0
                {
                    std::mem::swap(&mut s.bottom_radius, &mut s.top_radius);
                }
            }
            _ if is_aligned => leaf.rotation = rounded,
            _ => {}
        }
        leaf
    }
}

/// What turns a leaf whose axes were settled back to where it was.
pub(super) fn tilt(leaf: &Leaf, settled: &Leaf) -> DAffine3 {
    let turn = if settled.rotation == leaf.rotation {
        DMat3::IDENTITY
    } else if leaf.is_round() {
        let [from, to] = [settled, leaf].map(|leaf| leaf.rotation.z_axis);
        DMat3::from_quat(DQuat::from_rotation_arc(from.dot(to).signum() * from, to))
    } else {
        // A box may have other names for its axes.
        let names = (leaf.rotation.transpose() * settled.rotation).to_cols_array().map(f64::round);
        leaf.rotation * DMat3::from_cols_array(&names) * settled.rotation.transpose()
    };
    DAffine3 { matrix3: turn, translation: leaf.centre - turn * settled.centre }
}

#[cfg(test)]
mod tests {
    use super::super::leaf_tests::leaves;
    use super::*;
    use crate::Gielis;

    fn assert_same(a: &Leaf, b: &Leaf) {
        for i in 0..400_u32 {
            let p = DVec3::from_array([1, 7, 49].map(|k| f64::from(i * k % 343) / 343.0 - 0.5));
            let off = (a.distance(p) - b.distance(p)).abs();
            assert!(off < 1e-9, "{} at {p}: {off}, {:?}", a.kind(), b.rotation);
        }
    }

    /// Its sizes are from end to end, which vertices tell; the scale of its curves is none of them.
    #[test]
    fn sizes_of_supershapes_are_those_of_the_solid() {
        let star = Supershape::new(Gielis::new(5.0, 2.0, 4.0, 4.0), Gielis::circle()).scaled([0.2, 0.3, 0.25]);
        let leaf = Leaf { shape: Shape::Supersolid(star), rotation: DMat3::IDENTITY, centre: DVec3::ZERO };
        let numbers: Vec<f64> = leaf.measures().into_iter().map(|(_, v)| v).collect();
        let size = leaf.solid().bounds().unwrap().size();
        assert!((DVec3::from_slice(&numbers[3..]) - size).abs().max_element() < 1e-9, "{numbers:?}, {size}");
        let wide = leaf.made_of(&[0.0, 0.0, 0.0, 2.0 * numbers[3], numbers[4], numbers[5]]).unwrap();
        assert!((wide.solid().bounds().unwrap().size().x - 2.0 * size.x).abs() < 1e-9);
        let base = Superpolygon::new(Gielis::new(5.0, 2.0, 4.0, 4.0), 0.2);
        let leaf = Leaf { shape: Shape::Supershape { base, height: 0.3 }, ..leaf };
        let mut numbers: Vec<f64> = leaf.measures().into_iter().map(|(_, v)| v).collect();
        let size = leaf.solid().bounds().unwrap().size();
        assert!((numbers[4] - size.x).abs() < 1e-9, "{numbers:?}, {size}");
        numbers[4] *= 2.0;
        assert!((leaf.made_of(&numbers).unwrap().solid().bounds().unwrap().size().x - 2.0 * size.x).abs() < 1e-9);
    }

    #[test]
    fn every_kind_is_made_of_its_numbers() {
        for leaf in leaves() {
            let numbers: Vec<f64> = leaf.measures().into_iter().map(|(_, v)| v).collect();
            assert_same(&leaf, &leaf.made_of(&numbers).expect("it is one"));
        }
    }

    #[test]
    fn every_kind_is_the_same_along_the_axes() {
        for axis in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
            for mut leaf in leaves() {
                leaf.rotation = super::super::leaf::along(axis);
                let aligned = leaf.aligned(1e-6);
                assert_same(&leaf, &aligned);
                // A little off, and turned back.
                let off = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1e-3);
                let tilted = Leaf { rotation: off * leaf.rotation, ..leaf.clone() };
                let aligned = tilted.aligned(0.01);
                assert_same(&tilted, &aligned.turned_by(&tilt(&tilted, &aligned)));
                // What is found free may have another centre, as a half-space that is turned about what is
                // seen of it.
                let moved = Leaf { centre: tilted.centre + DVec3::new(0.01, -0.02, 0.005), ..tilted.clone() };
                assert_same(&moved, &aligned.turned_by(&tilt(&moved, &aligned)));
                let solid = aligned.solid();
                let p = leaf.centre + DVec3::new(0.03, -0.05, 0.02);
                assert_eq!(solid.contains(p).unwrap(), leaf.contains(p), "{} along {axis}", leaf.kind());
            }
        }
    }
}
