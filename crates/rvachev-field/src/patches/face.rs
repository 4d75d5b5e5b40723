//! Patches as they are stored: in single precision, in a frame about their middle.
//!
//! With the coordinates s = b₁ and t = b₂ a patch is a polynomial,
//!
//! ```text
//!     P = a + s (e + C) + t (f + D) − s² C − t² D + s t E
//!     e, f the sides from corner 0,   C = 4 u₀,   D = 4 u₂,   E = 4 (u₁ − u₀ − u₂)
//! ```

use glam::DVec3;

use super::Patch;
use crate::Bounds;

/// How much boxes are grown, in units of the frame, so that no rounding leaves a part of a patch
/// outside: some twenty times what single precision does to a coordinate.
pub(super) const SLACK: f64 = 16.0 * f32::EPSILON as f64;

/// The frame of the stored numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) centre: DVec3,
    /// How long its unit is: a power of two, so that it costs no rounding.
    pub(super) unit: f64,
}

impl Frame {
    pub(super) fn new(bounds: &Bounds) -> Frame {
        let half = 0.5 * bounds.longest_side();
        let exponent = if half.is_normal() { half.log2().ceil() } else { 0.0 };
        let centre = if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
        Frame { centre, unit: exponent.clamp(-900.0, 900.0).exp2() }
    }

    pub(super) fn into_local(self, p: DVec3) -> DVec3 {
        (p - self.centre) / self.unit
    }

    pub(super) fn outward(self, p: DVec3) -> DVec3 {
        p * self.unit + self.centre
    }

    /// The box of a patch as it is stored, low and high corner.
    pub(super) fn boxed(self, patch: &Patch) -> [[f32; 3]; 2] {
        let bounds = patch.bounds();
        [self.into_local(bounds.min) - SLACK, self.into_local(bounds.max) + SLACK].map(single)
    }
}

fn single(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// Three numbers as formulas take them. The array's own map would be a call.
#[inline(always)]
pub(super) fn wide([x, y, z]: [f32; 3]) -> [f64; 3] {
    [f64::from(x), f64::from(y), f64::from(z)]
}

#[inline(always)]
pub(super) fn double(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(wide(v))
}

/// The flat triangle of a patch, in its own plane.
///
/// ```text
///          v ↑    corner 2 = (apex₀, apex₁)
///            |     /  \
///            |   /      \
///            | /          \
///    corner 0 ----------- corner 1 = (length, 0)   → u
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Face {
    /// Corner 0.
    pub(super) a: [f32; 3],
    /// Along side 0, across it in the plane, and across the plane: unit vectors.
    pub(super) u: [f32; 3],
    pub(super) v: [f32; 3],
    pub(super) n: [f32; 3],
    pub(super) length: f32,
    pub(super) apex: [f32; 2],
    /// No point of the patch is farther than this from the point of the triangle at the same
    /// coordinates; 0 if it is flat.
    pub(super) sag: f32,
}

impl Face {
    /// Whether it is all that there is of its patch.
    #[inline(always)]
    pub(super) fn is_flat(&self) -> bool {
        self.sag == 0.0
    }

    pub(super) fn new(patch: &Patch, frame: &Frame) -> Face {
        let [a, b, c] = patch.corners.map(|corner| frame.into_local(corner));
        let (e, f) = (b - a, c - a);
        let u = e.try_normalize().or_else(|| f.try_normalize()).unwrap_or(DVec3::X);
        let across = f - f.dot(u) * u;
        // What is less is rounding, and may point anywhere.
        let v = if across.length() > 1e-12 * f.length() { across } else { u.any_orthonormal_vector() };
        let v = (v - v.dot(u) * u).normalize_or(u.any_orthonormal_vector());
        // 4 Σ bᵢbⱼ |uₖ| is at most 4/3 of the largest.
        let most = patch.displacements.iter().fold(0.0, |most, by| by.length().max(most)) / frame.unit;
        let sag = if patch.is_flat() { 0.0 } else { 4.0 / 3.0 * most + SLACK };
        Face {
            a: single(a),
            u: single(u),
            v: single(v),
            n: single(u.cross(v)),
            length: e.dot(u) as f32,
            apex: [f.dot(u) as f32, f.dot(v) as f32],
            sag: sag as f32,
        }
    }
}

impl Face {
    /// From corner 0 to a point.
    #[inline(always)]
    pub(super) fn seen_from(&self, p: [f64; 3]) -> [f64; 3] {
        [p[0] - f64::from(self.a[0]), p[1] - f64::from(self.a[1]), p[2] - f64::from(self.a[2])]
    }
}

/// The sides of a face from corner 0 to corners 1 and 2. The face's own vectors are rounded; these
/// are those of the patch, to the last bit where that has few.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    pub(super) e: [f32; 3],
    pub(super) f: [f32; 3],
}

impl Sides {
    pub(super) fn new(patch: &Patch, frame: &Frame) -> Sides {
        let [a, b, c] = patch.corners.map(|corner| frame.into_local(corner));
        Sides { e: single(b - a), f: single(c - a) }
    }

    /// As they go into formulas.
    #[inline(always)]
    pub(super) fn wide(&self) -> [[f64; 3]; 2] {
        [wide(self.e), wide(self.f)]
    }

    /// Point and derivatives by both coordinates.
    pub(super) fn jet(&self, face: &Face, s: f64, t: f64) -> [DVec3; 3] {
        let [a, e, f] = [face.a, self.e, self.f].map(double);
        [a + s * e + t * f, e, f]
    }
}

/// The quadratic terms of a patch: what bends a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadratic {
    /// The coefficients C, D and E.
    pub(super) c: [f32; 3],
    pub(super) d: [f32; 3],
    pub(super) e: [f32; 3],
}

impl Quadratic {
    pub(super) fn new(patch: &Patch, frame: &Frame) -> Quadratic {
        let [u, v, w] = patch.displacements.map(|by| 4.0 * by / frame.unit);
        Quadratic { c: single(u), d: single(w), e: single(v - u - w) }
    }

    /// Point and derivatives by both coordinates.
    pub(super) fn jet(&self, [flat, e, f]: [DVec3; 3], s: f64, t: f64) -> [DVec3; 3] {
        let [c, d, mixed] = [self.c, self.d, self.e].map(double);
        [
            flat + s * (1.0 - s) * c + t * (1.0 - t) * d + s * t * mixed,
            e + (1.0 - 2.0 * s) * c + t * mixed,
            f + (1.0 - 2.0 * t) * d + s * mixed,
        ]
    }
}

/// A number that tells surfaces apart (FNV-1a over the stored numbers).
pub(super) fn hash(frame: &Frame, faces: &[Face], sides: &[Sides], quadratics: &[Quadratic]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bits: u64| hash = (hash ^ bits).wrapping_mul(0x0100_0000_01b3);
    frame.centre.to_array().into_iter().chain([frame.unit]).for_each(|v| add(v.to_bits()));
    let sides = sides.iter().flat_map(|sides| [sides.e, sides.f]);
    let quadratics = quadratics.iter().flat_map(|quadratic| [quadratic.c, quadratic.d, quadratic.e]);
    faces.iter().map(|face| face.a).chain(sides).chain(quadratics).flatten().for_each(|v| add(u64::from(v.to_bits())));
    hash
}
