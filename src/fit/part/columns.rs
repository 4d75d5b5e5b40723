//! Samples in columns along the axes of a frame, and which of them a shape explains.
//!
//! ```text
//!     plane    |p·n − o| ≤ tol                   n·N ≥ cos α
//!     sphere   ||p − c| − r| ≤ tol               ±(p − c)·n ≥ cos α·|p − c|
//!     cone     |d − r − k·s| ≤ tol·√(1 + k²)     d from the axis, s along it;  k = 0: a cylinder
//!     torus    |e − r| ≤ tol                     e from the circle of radius R about the axis
//! ```
//!
//! A shape and a sample have the same cost, and there are some ten million such pairs in a part:
//! the loops below are in single precision, without branches, over sixteen samples at a time.

use fearless_simd::Simd;
use glam::{DMat3, DVec3};
use rvachev_num::Real;
use rvachev_num::lanes::{F32, Lanes};

use super::samples::Samples;

/// Samples that are judged together.
const TOGETHER: usize = 16;

/// Samples in a frame, padded with such as weigh nothing.
pub(super) struct Columns {
    /// From the frame's axes to those of the samples.
    pub(super) frame: DMat3,
    /// Position and normal.
    columns: [Vec<f32>; 6],
    weights: Vec<f32>,
    /// Which samples they are.
    pub(super) which: Vec<u32>,
}

/// A shape in a frame, about its z axis where it has one. Signs are those of the normals: −1 in
/// holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Plane { normal: DVec3, offset: f64 },
    Sphere { centre: DVec3, radius: f64, sign: f64 },
    Cone { centre: [f64; 2], radius: f64, slope: f64, sign: f64 },
    Torus { centre: DVec3, major: f64, minor: f64, sign: f64 },
}

impl Shape {
    /// The shape that samples of chords are about, given the angle between two of them, and the
    /// sagitta.
    pub(super) fn chordal(&self, step: f64) -> (Shape, f64) {
        let sagitta = |radius: f64| radius * step * step / 8.0;
        match *self {
            Shape::Plane { .. } => (*self, 0.0),
            Shape::Sphere { centre, radius, sign } => {
                (Shape::Sphere { centre, radius: radius - 0.5 * sagitta(radius), sign }, sagitta(radius))
            }
            Shape::Cone { centre, radius, slope, sign } => {
                let s = if slope == 0.0 { sagitta(radius) } else { 0.0 };
                (Shape::Cone { centre, radius: radius - 0.5 * s, slope, sign }, s)
            }
            Shape::Torus { centre, major, minor, sign } => {
                (Shape::Torus { centre, major, minor: minor - 0.5 * sagitta(minor), sign }, sagitta(minor))
            }
        }
    }

    /// The ratio of a radius to another one's, of shapes that differ by chords; 1 where they differ
    /// otherwise.
    pub(super) fn smaller(&self, than: &Shape) -> f64 {
        let ratio = match (*self, *than) {
            (Shape::Sphere { radius: a, .. }, Shape::Sphere { radius: b, .. })
            | (Shape::Cone { radius: a, slope: 0.0, .. }, Shape::Cone { radius: b, slope: 0.0, .. })
            | (Shape::Torus { minor: a, .. }, Shape::Torus { minor: b, .. }) => a / b,
            _ => 1.0,
        };
        if (0.95..=1.0).contains(&ratio) { ratio } else { 1.0 }
    }

    /// How far a point is from the shape, at right angles to it.
    pub(super) fn off(&self, p: DVec3) -> f64 {
        // Whatever the normal is.
        -self.margin(p, DVec3::ZERO, Tolerance { distance: 0.0, cosine: -1.0 }) / self.steep()
    }

    /// The unit normal of the shape at the place nearest to a point.
    pub(super) fn normal(&self, p: DVec3) -> DVec3 {
        let radial = |d: DVec3| DVec3::new(d.x, d.y, 0.0).normalize_or(DVec3::X);
        match *self {
            Shape::Plane { normal, .. } => normal,
            Shape::Sphere { centre, sign, .. } => sign * (p - centre).normalize_or(DVec3::Z),
            Shape::Cone { centre: [x, y], slope, sign, .. } => {
                sign * (radial(p - DVec3::new(x, y, 0.0)) - slope * DVec3::Z) / self.steep()
            }
            Shape::Torus { centre, major, sign, .. } => {
                let d = p - centre;
                sign * (d - major * radial(d)).normalize_or(DVec3::Z)
            }
        }
    }

    /// How many times longer distances across the axis are than those from the shape.
    fn steep(&self) -> f64 {
        if let Shape::Cone { slope, .. } = self { slope.hypot(1.0) } else { 1.0 }
    }

    /// Not below 0 where a point with a normal is of the shape.
    pub(super) fn margin(&self, p: DVec3, n: DVec3, tolerance: Tolerance) -> f64 {
        let (p, n) = (p.to_array(), n.to_array());
        match *self {
            Shape::Plane { normal, offset } => Plane { normal, offset }.margin(p, n, tolerance),
            Shape::Sphere { centre, radius, sign } => Sphere { centre, radius, sign }.margin(p, n, tolerance),
            Shape::Cone { centre, radius, slope, sign } => {
                Cone { centre, radius, slope, sign, steep: self.steep() }.margin(p, n, tolerance)
            }
            Shape::Torus { centre, major, minor, sign } => Torus { centre, major, minor, sign }.margin(p, n, tolerance),
        }
    }
}

/// How near a sample must be to a shape, and how much its normal may differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    pub(super) distance: f64,
    pub(super) cosine: f64,
}

impl Columns {
    /// The given samples in a frame.
    pub(super) fn new(samples: &Samples, frame: DMat3, which: Vec<u32>) -> Columns {
        let padded = which.len().next_multiple_of(TOGETHER);
        let mut columns = [(); 6].map(|()| vec![0.0; padded]);
        let mut weights = vec![0.0; padded];
        let inverse = frame.transpose();
        for (k, &i) in which.iter().enumerate() {
            let (p, n) = (inverse * samples.points[i as usize], inverse * samples.normals[i as usize]);
            for axis in 0..3 {
                columns[axis][k] = p[axis] as f32;
                columns[3 + axis][k] = n[axis] as f32;
            }
            weights[k] = samples.weights[i as usize] as f32;
        }
        Columns { frame, columns, weights, which }
    }

    /// What is explained by others counts no more.
    pub(super) fn take(&mut self, taken: &[bool]) {
        for (weight, i) in self.weights.iter_mut().zip(&self.which) {
            if taken[*i as usize] {
                *weight = 0.0;
            }
        }
    }

    /// The weight of what a shape explains; the weights of the samples, 0 of those that it does
    /// not, go to a buffer.
    pub(super) fn explain(&self, shape: &Shape, tolerance: Tolerance, out: &mut Vec<f32>) -> f64 {
        out.resize(self.weights.len(), 0.0);
        match *shape {
            Shape::Plane { normal, offset } => self.judged(&Plane { normal, offset }, tolerance, out),
            Shape::Sphere { centre, radius, sign } => self.judged(&Sphere { centre, radius, sign }, tolerance, out),
            Shape::Cone { centre, radius, slope, sign } => {
                self.judged(&Cone { centre, radius, slope, sign, steep: shape.steep() }, tolerance, out)
            }
            Shape::Torus { centre, major, minor, sign } => {
                self.judged(&Torus { centre, major, minor, sign }, tolerance, out)
            }
        }
    }

    /// The samples that a shape explains.
    pub(super) fn explained(&self, shape: &Shape, tolerance: Tolerance, out: &mut Vec<f32>) -> Vec<u32> {
        self.explain(shape, tolerance, out);
        self.which.iter().zip(&*out).filter(|(_, w)| **w > 0.0).map(|(i, _)| *i).collect()
    }

    fn judged<J: Judge>(&self, judge: &J, tolerance: Tolerance, out: &mut [f32]) -> f64 {
        rvachev_num::on_level!(simd => self.judged_on::<_, J>(simd, judge, tolerance, out))
    }

    #[inline(always)]
    fn judged_on<S: Simd, J: Judge>(&self, simd: S, judge: &J, tolerance: Tolerance, out: &mut [f32]) -> f64 {
        let width = <F32<S> as Lanes>::WIDTH;
        let zero = <F32<S> as Lanes>::splat(simd, 0.0);
        let mut sum = zero;
        for start in (0..self.weights.len()).step_by(width) {
            let at = start..start + width;
            let load = |from: &[f32]| <F32<S> as Lanes>::load(simd, &from[at.clone()]);
            let c = &self.columns;
            let margin = judge.margin(
                [load(&c[0]), load(&c[1]), load(&c[2])],
                [load(&c[3]), load(&c[4]), load(&c[5])],
                tolerance,
            );
            let weight = margin.select(load(&self.weights), zero);
            weight.store(&mut out[at]);
            sum = sum + weight;
        }
        let mut buffer = [0.0f32; 64];
        sum.store(&mut buffer[..width]);
        buffer[..width].iter().map(|w| f64::from(*w)).sum()
    }
}

/// What tells whether a sample is of a shape.
trait Judge {
    /// Not below 0 if the sample is.
    fn margin<R: Real>(&self, p: [R; 3], n: [R; 3], tolerance: Tolerance) -> R;
}

struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Judge for Plane {
    #[inline(always)]
    fn margin<R: Real>(&self, p: [R; 3], n: [R; 3], tolerance: Tolerance) -> R {
        let DVec3 { x, y, z } = self.normal;
        let along = p[0].scale_add(x, p[1].scale_add(y, p[2] * z));
        let cosine = n[0].scale_add(x, n[1].scale_add(y, n[2] * z));
        let off = (along - self.offset).abs();
        (-off + tolerance.distance).min(cosine - tolerance.cosine)
    }
}

struct Sphere {
    centre: DVec3,
    radius: f64,
    sign: f64,
}

impl Judge for Sphere {
    #[inline(always)]
    fn margin<R: Real>(&self, p: [R; 3], n: [R; 3], tolerance: Tolerance) -> R {
        let [x, y, z] = [p[0] - self.centre.x, p[1] - self.centre.y, p[2] - self.centre.z];
        let away = (x.square() + y.square() + z.square()).sqrt();
        let off = (away - self.radius).abs();
        let dot = (x * n[0] + y * n[1] + z * n[2]) * self.sign;
        (-off + tolerance.distance).min(dot - away * tolerance.cosine)
    }
}

struct Cone {
    centre: [f64; 2],
    radius: f64,
    slope: f64,
    sign: f64,
    steep: f64,
}

impl Judge for Cone {
    #[inline(always)]
    fn margin<R: Real>(&self, p: [R; 3], n: [R; 3], tolerance: Tolerance) -> R {
        let [x, y] = [p[0] - self.centre[0], p[1] - self.centre[1]];
        let away = (x.square() + y.square()).sqrt();
        let off = (away - p[2] * self.slope - self.radius).abs();
        let dot = (x * n[0] + y * n[1] - away * n[2] * self.slope) * self.sign;
        (-off + tolerance.distance * self.steep).min(dot - away * (tolerance.cosine * self.steep))
    }
}

struct Torus {
    centre: DVec3,
    major: f64,
    minor: f64,
    sign: f64,
}

impl Judge for Torus {
    #[inline(always)]
    fn margin<R: Real>(&self, p: [R; 3], n: [R; 3], tolerance: Tolerance) -> R {
        let [x, y, z] = [p[0] - self.centre.x, p[1] - self.centre.y, p[2] - self.centre.z];
        let away = (x.square() + y.square() + 1e-20).sqrt();
        let out = away - self.major;
        let tube = (out.square() + z.square()).sqrt();
        let off = (tube - self.minor).abs();
        let dot = ((x * n[0] + y * n[1]) * out / away + z * n[2]) * self.sign;
        (-off + tolerance.distance).min(dot - tube * tolerance.cosine)
    }
}
