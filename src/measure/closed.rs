//! Solids whose volume, moments and area have closed forms.
//!
//! ```text
//!   superellipsoid    V = 2abc e₁e₂ B(e₁/2, e₁+1) B(e₂/2, e₂/2+1)
//!                  ∫x² = 2a³bc e₁e₂ B(e₁/2, 2e₁+1) B(3e₂/2, e₂/2+1)
//!                  ∫z² = 2abc³ e₁e₂ B(3e₁/2, e₁+1) B(e₂/2, e₂/2+1)
//!   supertoroid       V = 8abcr e₁e₂ B(e₁/2, e₁/2+1) B(e₂/2, e₂/2+1),     r the ring
//!                  ∫x² = 16a³bcr e₁e₂ B(3e₂/2, e₂/2+1) (r² B(e₁/2, e₁/2+1) + B(e₁/2, 3e₁/2+1))
//!                  ∫z² = 8abc³r e₁e₂ B(3e₁/2, e₁/2+1) B(e₂/2, e₂/2+1)
//!   generalised       V = 8abc Γ(1+1/l) Γ(1+1/m) Γ(1+1/n) / Γ(1+1/l+1/m+1/n)
//!                  ∫x² = 8a³bc/(lmn) Γ(3/l) Γ(1/m) Γ(1/n) / Γ(1+3/l+1/m+1/n)
//! ```
//!
//! The axes are principal ones of all leaves but the wedge. Maps change moments as they do points;
//! areas only if they stretch evenly. Triangles of imported meshes are mapped one by one.
//!
//! Source: A. Jaklič, A. Leonardis, F. Solina, *Segmentation and Recovery of Superquadrics* (2000),
//! chapter 2.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::facets::Facets;
use super::gamma::{beta, ln_gamma};
use super::moments::Moments;
use crate::form::{Form, LeafForm};
use crate::{
    Cancelled, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, GeneralisedSuperquadric, Prism, Pyramid, RoundedCuboid, Run,
    Solid, Sphere, Superellipsoid, Supertoroid, Torus, Wedge,
};
use rvachev_field::MeshLeaf;

/// A map stretches evenly if it does so to this part.
const EVEN: f64 = 1e-12;

/// What is known of a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closed {
    pub(super) moments: Moments,
    /// How far the volume may be off, as a part of it.
    pub(super) rounding: f64,
    /// Nothing where no closed form is known of it; and how far it may be off.
    pub(super) area: Option<[f64; 2]>,
}

/// What has a closed form is off by rounding: by this part of it at most.
const ROUNDING: f64 = 1e-12;

/// The closed form of a solid that is a leaf after affine maps, if there is one.
pub(super) fn closed(solid: &Solid, run: &Run) -> Result<Option<Closed>, Cancelled> {
    let (mut map, mut at) = (DAffine3::IDENTITY, solid);
    let leaf = loop {
        at = match at.form() {
            Form::Leaf(leaf) | Form::Custom(leaf) => break leaf,
            Form::Affine { operand, map: own, .. } => {
                map *= own;
                operand
            }
            Form::Paint { operand, .. } | Form::Name { operand, .. } => operand,
            _ => return Ok(None),
        };
    };
    if let Some(mesh) = leaf.get::<MeshLeaf>() {
        return Ok(Facets::of(mesh, &map, run)?.and_then(|facets| {
            let moments = facets.moments();
            let rounding = ROUNDING + facets.volume_error() / moments.volume;
            (moments.volume > 0.0).then_some(Closed { moments, rounding, area: Some(facets.area()) })
        }));
    }
    let Some(Exact { moments, area }) = of_leaf(&leaf) else { return Ok(None) };
    let area = area.zip(even_stretch(&map)).map(|(area, stretch)| area * stretch * stretch);
    let area = area.map(|area| [area, ROUNDING * area]);
    Ok(Some(Closed { moments: moments.mapped(&map), rounding: ROUNDING, area }))
}

/// The same of a leaf, to rounding.
struct Exact {
    moments: Moments,
    area: Option<f64>,
}

/// What a map stretches by, if that is the same along all directions.
fn even_stretch(map: &DAffine3) -> Option<f64> {
    let squares = map.matrix3.transpose() * map.matrix3;
    let stretch = squares.x_axis.x;
    let off = squares - glam::DMat3::from_diagonal(DVec3::splat(stretch));
    off.to_cols_array().iter().all(|x| x.abs() <= EVEN * stretch).then(|| stretch.sqrt())
}

fn of_leaf(leaf: &LeafForm<'_>) -> Option<Exact> {
    let closed = |moments, area| Some(Exact { moments, area: Some(area) });
    if let Some(Sphere { radius }) = leaf.get() {
        return closed(ball(*radius), 4.0 * PI * radius.powi(2));
    }
    if let Some(Cuboid { size }) = leaf.get() {
        return closed(Moments::cuboid(DVec3::ZERO, *size), faces(*size));
    }
    if let Some(RoundedCuboid { size, radius }) = leaf.get() {
        let core = *size - 2.0 * radius;
        let area = faces(core) + 2.0 * PI * radius * core.element_sum() + 4.0 * PI * radius.powi(2);
        return closed(rounded(core, *radius), area);
    }
    if let Some(Cylinder { radius, height }) = leaf.get() {
        return closed(cylinder(*radius, *height), 2.0 * PI * radius * (radius + height));
    }
    if let Some(Cone { bottom_radius: r, top_radius: s, height }) = leaf.get() {
        let side = PI * (r + s) * height.hypot(s - r);
        return closed(cone(*r, *s, *height), side + PI * (r * r + s * s));
    }
    if let Some(Capsule { radius, height }) = leaf.get() {
        let between = height - 2.0 * radius;
        let mut all = cylinder(*radius, between);
        all.add(&halves(*radius, between));
        return closed(all, 2.0 * PI * radius * height);
    }
    if let Some(Torus { radius: ring, tube }) = leaf.get() {
        let volume = 2.0 * PI * PI * ring * tube * tube;
        let across = volume * (0.5 * ring * ring + 0.375 * tube * tube);
        let along = volume * 0.25 * tube * tube;
        return closed(Moments::symmetric(volume, DVec3::new(across, across, along)), 4.0 * PI * PI * ring * tube);
    }
    if let Some(Ellipsoid { semi_axes: a }) = leaf.get() {
        let volume = 4.0 / 3.0 * PI * a.element_product();
        return Some(Exact { moments: Moments::symmetric(volume, 0.2 * volume * *a * *a), area: None });
    }
    if let Some(prism) = leaf.get::<Prism>() {
        let (base, height) = (Base::new(prism.sides(), prism.radius()), prism.height());
        let (volume, across) = (base.area * height, base.square * height);
        let moments = Moments::symmetric(volume, DVec3::new(across, across, volume * height * height / 12.0));
        return closed(moments, 2.0 * base.area + base.around * height);
    }
    if let Some(pyramid) = leaf.get::<Pyramid>() {
        let (base, height) = (Base::new(pyramid.sides(), pyramid.radius()), pyramid.height());
        let (volume, across) = (base.area * height / 3.0, 0.2 * base.square * height);
        let mut moments = Moments::symmetric(volume, DVec3::new(across, across, base.area * height.powi(3) / 30.0));
        moments.first.z = -base.area * height * height / 12.0;
        return closed(moments, base.area + 0.5 * base.around * height.hypot(base.inscribed));
    }
    if let Some(Wedge { size }) = leaf.get() {
        let volume = 0.5 * size.element_product();
        let squares = volume * *size * *size / DVec3::new(18.0, 12.0, 18.0);
        let mut moments = Moments::symmetric(volume, squares);
        moments.second.x_axis.z = -volume * size.x * size.z / 36.0;
        moments.second.z_axis.x = moments.second.x_axis.z;
        let area = size.y * (size.x + size.z + size.x.hypot(size.z)) + size.x * size.z;
        return closed(moments.moved(DVec3::new(-size.x, 0.0, -size.z) / 6.0), area);
    }
    let superquadric = |moments| Some(Exact { moments, area: None });
    if let Some(leaf) = leaf.get::<Superellipsoid>() {
        return superquadric(superellipsoid(leaf));
    }
    if let Some(leaf) = leaf.get::<Supertoroid>() {
        return superquadric(supertoroid(leaf));
    }
    leaf.get::<GeneralisedSuperquadric>().and_then(|leaf| superquadric(generalised(leaf)))
}

fn faces(size: DVec3) -> f64 {
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}

fn ball(radius: f64) -> Moments {
    let volume = 4.0 / 3.0 * PI * radius.powi(3);
    Moments::symmetric(volume, DVec3::splat(0.2 * volume * radius * radius))
}

fn cylinder(radius: f64, height: f64) -> Moments {
    let volume = PI * radius * radius * height;
    let across = 0.25 * volume * radius * radius;
    Moments::symmetric(volume, DVec3::new(across, across, volume * height * height / 12.0))
}

/// The halves of a ball, moved apart along z by a distance.
fn halves(radius: f64, apart: f64) -> Moments {
    let mut all = ball(radius);
    all.second.z_axis.z += apart * (0.25 * apart * all.volume + 0.5 * PI * radius.powi(4));
    all
}

/// A box with a layer of a thickness all round it.
fn rounded(core: DVec3, radius: f64) -> Moments {
    let mut all = Moments::cuboid(DVec3::ZERO, core);
    // The quarters of a cylinder, along each edge, and the eighths of a ball.
    let disc = PI * radius * radius;
    let [inner, outer] = [0.5 * core, 0.5 * core + radius];
    let mut volume = 0.0;
    let mut squares = DVec3::ZERO;
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let (h, length) = (inner[axis], core[axis]);
        volume += 2.0 * core[next] * core[last] * radius + disc * length;
        // Layers on the faces across the axis; those on the others; edges along it; edges across.
        let layers = 2.0 * core[next] * core[last] * (outer[axis].powi(3) - h.powi(3)) / 3.0;
        let beside = 2.0 * radius * length * (core[next] + core[last]) + disc * length;
        let across = disc * h * h + 8.0 / 3.0 * h * radius.powi(3) + 0.25 * PI * radius.powi(4);
        squares[axis] = layers + beside * length * length / 12.0 + (core[next] + core[last]) * across;
        squares[axis] += 4.0 / 3.0 * PI * radius.powi(3) * h * h + PI * h * radius.powi(4);
        squares[axis] += 4.0 / 15.0 * PI * radius.powi(5);
    }
    all.add(&Moments::symmetric(volume + 4.0 / 3.0 * PI * radius.powi(3), squares));
    all
}

/// A cone, its radius r at the lower and s at the upper end.
fn cone(r: f64, s: f64, height: f64) -> Moments {
    let d = s - r;
    // The squared radius is a quadratic of t, from 0 below to 1 above.
    let (a, b, c) = (r * r, 2.0 * r * d, d * d);
    let [none, one, two] = [0.0, 1.0, 2.0].map(|power| a / (power + 1.0) + b / (power + 2.0) + c / (power + 3.0));
    let fourth = r.powi(4) + r.powi(3) * s + r * r * s * s + r * s.powi(3) + s.powi(4);
    let across = PI * height * fourth / 20.0;
    let along = PI * height.powi(3) * (two - one + 0.25 * none);
    let mut moments = Moments::symmetric(PI * height * none, DVec3::new(across, across, along));
    moments.first.z = PI * height * height * (one - 0.5 * none);
    moments
}

/// A regular polygon.
struct Base {
    area: f64,
    /// ∫ x² dA, which is ∫ y² dA.
    square: f64,
    around: f64,
    inscribed: f64,
}

impl Base {
    fn new(sides: u32, radius: f64) -> Base {
        let (count, step) = (f64::from(sides), 2.0 * PI / f64::from(sides));
        let area = 0.5 * count * radius * radius * step.sin();
        Base {
            area,
            square: area * radius * radius * (2.0 + step.cos()) / 12.0,
            around: 2.0 * count * radius * (0.5 * step).sin(),
            inscribed: radius * (0.5 * step).cos(),
        }
    }
}

fn superellipsoid(leaf: &Superellipsoid) -> Moments {
    let (a, [e, f]) = (leaf.semi_axes(), leaf.exponents());
    let common = 2.0 * a.element_product() * e * f;
    let round = beta(0.5 * f, 0.5 * f + 1.0);
    let across = beta(0.5 * e, 2.0 * e + 1.0) * beta(1.5 * f, 0.5 * f + 1.0);
    let along = beta(1.5 * e, e + 1.0) * round;
    let squares = common * a * a * DVec3::new(across, across, along);
    Moments::symmetric(common * beta(0.5 * e, e + 1.0) * round, squares)
}

fn supertoroid(leaf: &Supertoroid) -> Moments {
    let (a, ring, [e, f]) = (leaf.semi_axes(), leaf.ring(), leaf.exponents());
    let common = 8.0 * a.element_product() * ring * e * f;
    let (tube, round) = (beta(0.5 * e, 0.5 * e + 1.0), beta(0.5 * f, 0.5 * f + 1.0));
    let across = 2.0 * beta(1.5 * f, 0.5 * f + 1.0) * (ring * ring * tube + beta(0.5 * e, 1.5 * e + 1.0));
    let along = beta(1.5 * e, 0.5 * e + 1.0) * round;
    Moments::symmetric(common * tube * round, common * a * a * DVec3::new(across, across, along))
}

fn generalised(leaf: &GeneralisedSuperquadric) -> Moments {
    let (a, n) = (leaf.semi_axes(), DVec3::from_array(leaf.exponents()));
    let common = 8.0 * a.element_product() / n.element_product();
    // ∫ of the squares of the coordinates with these powers.
    let integral = |powers: DVec3| {
        let parts = (powers + 1.0) / n;
        let logs = parts.to_array().map(ln_gamma).iter().sum::<f64>() - ln_gamma(1.0 + parts.element_sum());
        common * logs.exp()
    };
    let squares = DVec3::from_array(DVec3::AXES.map(|axis| integral(2.0 * axis)));
    Moments::symmetric(integral(DVec3::ZERO), a * a * squares)
}
