//! The leaves that a part is made of: a shape in a pose.
//!
//! Shapes are the crate's own leaves, about the origin of the pose and along its z axis, so what a
//! candidate is tested by is what its solid is made of.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::measures::{TO_X, TO_Y};
use super::outline::Outline;
use crate::field::{Dual, Field, Real};
use crate::{
    Cone, Cuboid, Cylinder, Prism, Profile, Rectangle, Solid, Sphere, Superellipsoid, Superpolygon, Supershape, Torus,
    deg,
};

/// A shape about the origin, along z.
#[derive(Clone, Debug)]
pub(in crate::fit) enum Shape {
    /// What is below z = 0.
    HalfSpace,
    Box(Cuboid),
    Cylinder(Cylinder),
    Cone(Cone),
    Sphere(Sphere),
    Torus(Torus),
    /// Regular.
    Prism(Prism),
    /// Extruded by half its height up and down, as are the next two.
    RoundedRectangle {
        base: Rectangle,
        height: f64,
    },
    Profile {
        outline: Outline,
        height: f64,
    },
    Supershape {
        base: Superpolygon,
        height: f64,
    },
    Superellipsoid(Superellipsoid),
    /// A three-dimensional supershape.
    Supersolid(Supershape),
}

/// A shape where it is.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Leaf {
    pub(in crate::fit) shape: Shape,
    /// From the shape's axes to those of the part.
    pub(in crate::fit) rotation: DMat3,
    pub(in crate::fit) centre: DVec3,
}

/// A rotation whose z axis is the given unit vector.
pub(in crate::fit) fn along(axis: DVec3) -> DMat3 {
    // The axes themselves, where they are meant, so that no rotation is left over.
    if axis.x.abs() + axis.y.abs() < 1e-12 && axis.z > 0.0 {
        return DMat3::IDENTITY;
    }
    let least = axis.abs().min_position();
    let x = DVec3::AXES[least].cross(axis).normalize();
    DMat3::from_cols(x, axis.cross(x), axis)
}

/// A solid turned, then moved, by as few verbs as that takes.
pub(super) fn posed(solid: Solid, rotation: DMat3, centre: DVec3) -> Solid {
    let turned = match rotation {
        rotation if rotation == DMat3::IDENTITY => solid,
        rotation if rotation == TO_X => solid.rotate_y(deg(90.0)),
        rotation if rotation == TO_Y => solid.rotate_x(deg(-90.0)),
        rotation if rotation.z_axis == DVec3::Z && rotation.x_axis == DVec3::Y => solid.rotate_z(deg(90.0)),
        rotation if rotation.z_axis == DVec3::Z && rotation.x_axis == DVec3::NEG_Y => solid.rotate_z(deg(-90.0)),
        rotation => solid.rotate(DQuat::from_mat3(&rotation).normalize()),
    };
    if centre == DVec3::ZERO { turned } else { turned.translate(centre) }
}

impl Shape {
    /// The same, larger by a factor.
    fn scaled(&self, by: f64) -> Shape {
        match self {
            Shape::HalfSpace => Shape::HalfSpace,
            Shape::Box(s) => Shape::Box(Cuboid { size: by * s.size }),
            Shape::Cylinder(s) => Shape::Cylinder(Cylinder { radius: by * s.radius, height: by * s.height }),
            Shape::Cone(s) => Shape::Cone(Cone {
                bottom_radius: by * s.bottom_radius,
                top_radius: by * s.top_radius,
                height: by * s.height,
            }),
            Shape::Sphere(s) => Shape::Sphere(Sphere { radius: by * s.radius }),
            Shape::Torus(s) => Shape::Torus(Torus { radius: by * s.radius, tube: by * s.tube }),
            Shape::Prism(s) => Shape::Prism(Prism::new(s.sides(), by * s.radius(), by * s.height())),
            Shape::RoundedRectangle { base, height } => Shape::RoundedRectangle {
                base: Rectangle { size: by * base.size, radius: by * base.radius },
                height: by * height,
            },
            Shape::Profile { outline, height } => Shape::Profile { outline: outline.scaled(by), height: by * height },
            Shape::Supershape { base, height } => {
                Shape::Supershape { base: Superpolygon::new(base.curve(), by * base.radius()), height: by * height }
            }
            Shape::Superellipsoid(s) => {
                let [e1, e2] = s.exponents();
                Shape::Superellipsoid(Superellipsoid::new(by * s.semi_axes(), e1, e2))
            }
            Shape::Supersolid(s) => Shape::Supersolid(s.scaled(by * s.scale())),
        }
    }

    /// The crate's value, positive inside, and whether it is a distance near the surface.
    #[inline]
    fn value<R: Real>(&self, p: [R; 3]) -> R {
        let extruded = |side: R, height: f64| {
            let end = -p[2].abs() + 0.5 * height;
            side.min(end)
        };
        match self {
            Shape::HalfSpace => -p[2],
            Shape::Box(s) => s.eval(p),
            Shape::Cylinder(s) => s.eval(p),
            Shape::Cone(s) => s.eval(p),
            Shape::Sphere(s) => s.eval(p),
            Shape::Torus(s) => s.eval(p),
            Shape::Prism(s) => s.eval(p),
            Shape::RoundedRectangle { base, height } => extruded(base.eval(p), *height),
            Shape::Superellipsoid(s) => s.eval(p),
            Shape::Supersolid(s) => s.eval(p),
            // [`distance`](Shape::distance) asks corners and gauges.
            Shape::Profile { height, .. } | Shape::Supershape { height, .. } => {
                extruded(p[0].lift(f64::INFINITY), *height)
            }
        }
    }

    /// The signed distance, negative inside; to first order where the value is none.
    fn distance(&self, p: DVec3) -> f64 {
        match self {
            Shape::Superellipsoid(_) => {
                let value = self.value(Dual::point(p.to_array()));
                let slope = DVec3::from_array(value.d).length();
                -value.v / slope.max(1e-6)
            }
            Shape::Supersolid(s) => {
                let step = 1e-4 * s.scale().min_element();
                let along = |axis: DVec3| s.gauge(p + step * axis) - s.gauge(p - step * axis);
                let slope = DVec3::from_array(DVec3::AXES.map(along)).length() / (2.0 * step);
                (s.gauge(p) - 1.0) / slope.max(1e-6)
            }
            Shape::Supershape { base, height } => {
                let (at, step) = (p.truncate(), 1e-4 * base.radius());
                let along = |axis: DVec2| base.gauge(at + step * axis) - base.gauge(at - step * axis);
                let slope = DVec2::new(along(DVec2::X), along(DVec2::Y)).length() / (2.0 * step);
                ((base.gauge(at) - 1.0) / slope.max(1e-6)).max(p.z.abs() - 0.5 * height)
            }
            Shape::Profile { outline, height } => outline.distance(p.truncate()).max(p.z.abs() - 0.5 * height),
            _ => -self.value(p.to_array()),
        }
    }

    /// The signed distance of the side of what is extruded or turned, as if it had no ends; none of
    /// other shapes.
    fn side(&self, p: DVec3) -> Option<f64> {
        let flat = p.truncate();
        match self {
            Shape::Cylinder(s) => Some(flat.length() - s.radius),
            Shape::Cone(s) => {
                let slope = (s.top_radius - s.bottom_radius) / s.height;
                let radius = 0.5 * (s.bottom_radius + s.top_radius) + slope * p.z;
                Some((flat.length() - radius) / slope.hypot(1.0))
            }
            Shape::Prism(s) => {
                let half = std::f64::consts::PI / f64::from(s.sides());
                let across = |k: u32| flat.dot(DVec2::from_angle(half * f64::from(2 * k + 1)));
                Some((0..s.sides()).map(across).fold(f64::NEG_INFINITY, f64::max) - s.radius() * half.cos())
            }
            Shape::RoundedRectangle { base, .. } => Some(-base.eval([p.x, p.y, 0.0])),
            Shape::Profile { outline, .. } => Some(outline.distance(flat)),
            Shape::Supershape { base, height } => {
                let endless = Shape::Supershape { base: base.clone(), height: height + 4.0 * p.z.abs() };
                Some(endless.distance(flat.extend(0.0)))
            }
            _ => None,
        }
    }

    /// The signed distances of the faces, each as if it went on without an end.
    fn faces(&self, p: DVec3, height: f64) -> Vec<f64> {
        if let Shape::Box(s) = self {
            let half = 0.5 * s.size;
            return [p - half, -p - half].iter().flat_map(|d| d.to_array()).collect();
        }
        match self.side(p) {
            Some(side) => vec![side, p.z - 0.5 * height, -p.z - 0.5 * height],
            None => vec![self.distance(p)],
        }
    }

    fn contains(&self, p: DVec3) -> bool {
        match self {
            Shape::Profile { outline, height } => 2.0 * p.z.abs() < *height && outline.contains(p.truncate()),
            Shape::Supershape { base, height } => 2.0 * p.z.abs() < *height && base.gauge(p.truncate()) < 1.0,
            Shape::Supersolid(s) => s.gauge(p) < 1.0,
            _ => self.value(p.to_array()) > 0.0,
        }
    }

    fn solid(&self) -> Solid {
        match self {
            Shape::HalfSpace => Solid::half_space(DVec3::Z, 0.0),
            Shape::Box(s) => (*s).into(),
            Shape::Cylinder(s) => (*s).into(),
            Shape::Cone(s) => (*s).into(),
            Shape::Sphere(s) => (*s).into(),
            Shape::Torus(s) => (*s).into(),
            Shape::Prism(s) => (*s).into(),
            Shape::RoundedRectangle { base, height } => Profile::from(*base).extrude(*height),
            Shape::Profile { outline, height } => outline.profile().extrude(*height),
            Shape::Supershape { base, height } => Profile::from(base.clone()).extrude(*height),
            Shape::Superellipsoid(s) => (*s).into(),
            Shape::Supersolid(s) => s.clone().into(),
        }
    }
}

impl Leaf {
    /// A half-space: all points p with `normal·p ≤ offset`, for a unit normal.
    pub(in crate::fit) fn half_space(normal: DVec3, offset: f64) -> Leaf {
        Leaf { shape: Shape::HalfSpace, rotation: along(normal), centre: offset * normal }
    }

    /// A box between two corners, along the axes of a frame.
    pub(in crate::fit) fn cuboid(frame: DMat3, [low, high]: [DVec3; 2]) -> Leaf {
        Leaf { shape: Shape::Box(Cuboid { size: high - low }), rotation: frame, centre: frame * (0.5 * (low + high)) }
    }

    /// A cylinder from one height over `origin` to another.
    pub(in crate::fit) fn cylinder(axis: DVec3, origin: DVec3, radius: f64, [low, high]: [f64; 2]) -> Leaf {
        Leaf {
            shape: Shape::Cylinder(Cylinder { radius, height: high - low }),
            rotation: along(axis),
            centre: origin + 0.5 * (low + high) * axis,
        }
    }

    /// A cone of radius `radius + slope·t` at each height t over `origin`; it ends at the tip.
    pub(in crate::fit) fn cone(
        axis: DVec3,
        origin: DVec3,
        [radius, slope]: [f64; 2],
        [low, high]: [f64; 2],
    ) -> Option<Leaf> {
        let tip = -radius / slope;
        let [low, high] = if slope > 0.0 { [low.max(tip), high] } else { [low, high.min(tip)] };
        let at = |t: f64| (radius + slope * t).max(0.0);
        let shape = Shape::Cone(Cone { bottom_radius: at(low), top_radius: at(high), height: high - low });
        let leaf = Leaf { shape, rotation: along(axis), centre: origin + 0.5 * (low + high) * axis };
        (high - low > 1e-9).then_some(leaf)
    }

    pub(in crate::fit) fn sphere(centre: DVec3, radius: f64) -> Leaf {
        Leaf { shape: Shape::Sphere(Sphere { radius }), rotation: DMat3::IDENTITY, centre }
    }

    pub(in crate::fit) fn torus(axis: DVec3, centre: DVec3, radius: f64, tube: f64) -> Leaf {
        Leaf { shape: Shape::Torus(Torus { radius, tube }), rotation: along(axis), centre }
    }

    /// A point in the shape's own axes.
    #[inline]
    fn local(&self, p: DVec3) -> DVec3 {
        let d = p - self.centre;
        DVec3::new(self.rotation.x_axis.dot(d), self.rotation.y_axis.dot(d), self.rotation.z_axis.dot(d))
    }

    pub(in crate::fit) fn contains(&self, p: DVec3) -> bool {
        self.shape.contains(self.local(p))
    }

    /// The signed distance, negative inside; to first order for superellipsoids and supershapes.
    pub(in crate::fit) fn distance(&self, p: DVec3) -> f64 {
        self.shape.distance(self.local(p))
    }

    /// The signed distances of its faces, each as if it went on without an end: of a cylinder those
    /// of its side and of its ends.
    pub(in crate::fit) fn faces(&self, p: DVec3) -> Vec<f64> {
        self.shape.faces(self.local(p), self.height())
    }

    /// The direction in which the distance grows fastest, about a point near the surface.
    pub(in crate::fit) fn gradient(&self, p: DVec3) -> DVec3 {
        const STEP: f64 = 1e-5;
        let local = self.local(p);
        let along = |axis: DVec3| self.shape.distance(local + STEP * axis) - self.shape.distance(local - STEP * axis);
        self.rotation * DVec3::from_array(DVec3::AXES.map(along)).normalize_or_zero()
    }

    /// How many numbers an engineer must give.
    pub(in crate::fit) fn parameters(&self) -> usize {
        match &self.shape {
            Shape::HalfSpace => 3,
            Shape::Sphere(_) => 4,
            Shape::Cylinder(_) | Shape::Torus(_) => 7,
            Shape::Cone(_) => 8,
            Shape::Box(_) | Shape::Prism(_) => 9,
            Shape::RoundedRectangle { .. } => 10,
            Shape::Superellipsoid(_) => 11,
            Shape::Supershape { .. } => 12,
            Shape::Supersolid(_) => 17,
            Shape::Profile { outline, .. } => 7 + 2 * outline.corners.len() + outline.arc_count(),
        }
    }

    /// The lengths and numbers of its shape.
    pub(in crate::fit) fn sizes(&self) -> Vec<f64> {
        match &self.shape {
            Shape::HalfSpace => Vec::new(),
            Shape::Box(s) => s.size.to_array().to_vec(),
            Shape::Cylinder(s) => vec![s.radius, s.height],
            Shape::Cone(s) => vec![s.bottom_radius, s.top_radius, s.height],
            Shape::Sphere(s) => vec![s.radius],
            Shape::Torus(s) => vec![s.radius, s.tube],
            Shape::Prism(s) => vec![f64::from(s.sides()), s.radius(), s.height()],
            Shape::RoundedRectangle { base, height } => vec![base.size.x, base.size.y, base.radius, *height],
            Shape::Profile { outline, height } => {
                let corners = outline.corners.iter().flat_map(|corner| corner.to_array());
                corners.chain(outline.radii.iter().copied()).chain([*height]).collect()
            }
            Shape::Supershape { base, height } => {
                let curve = base.curve();
                vec![curve.m, curve.n1, curve.n2, curve.n3, base.radius(), *height]
            }
            Shape::Superellipsoid(s) => s.semi_axes().to_array().into_iter().chain(s.exponents()).collect(),
            Shape::Supersolid(s) => {
                let curves = [s.equator(), s.meridian()].map(|curve| [curve.m, curve.n1, curve.n2, curve.n3]);
                s.scale().to_array().into_iter().chain(curves.concat()).collect()
            }
        }
    }

    /// Whether it is the same turned about its z axis by any angle.
    pub(in crate::fit) fn is_round(&self) -> bool {
        matches!(
            self.shape,
            Shape::Cylinder(_) | Shape::Cone(_) | Shape::Sphere(_) | Shape::Torus(_) | Shape::HalfSpace
        )
    }

    /// What it is called.
    pub(in crate::fit) fn kind(&self) -> &'static str {
        match &self.shape {
            Shape::HalfSpace => "half-space",
            Shape::Box(_) => "box",
            Shape::Cylinder(_) => "cylinder",
            Shape::Cone(_) => "cone",
            Shape::Sphere(_) => "sphere",
            Shape::Torus(_) => "torus",
            Shape::Prism(_) => "prism",
            Shape::RoundedRectangle { .. } => "rounded rectangle",
            Shape::Profile { .. } => "profile",
            Shape::Supershape { .. } => "supershape",
            Shape::Superellipsoid(_) => "superellipsoid",
            Shape::Supersolid(_) => "solid supershape",
        }
    }

    /// The same in length units of the part, whose box has the centre and the diagonal.
    pub(in crate::fit) fn outward(&self, centre: DVec3, size: f64) -> Leaf {
        Leaf { shape: self.shape.scaled(size), rotation: self.rotation, centre: centre + size * self.centre }
    }

    /// The same in diagonals about the centre.
    pub(super) fn inward(&self, centre: DVec3, size: f64) -> Leaf {
        let shape = self.shape.scaled(1.0 / size);
        Leaf { shape, rotation: self.rotation, centre: (self.centre - centre) / size }
    }

    /// The solid, with the numbers that the leaf has.
    pub(in crate::fit) fn solid(&self) -> Solid {
        posed(self.shape.solid(), self.rotation, self.centre)
    }
}
