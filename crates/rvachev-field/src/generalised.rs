//! Generalised superquadric: three independent exponents.
//!
//! ```text
//!     |x/a₁|^n₁ + |y/a₂|^n₂ + |z/a₃|^n₃ = 1         G = 1/t  with  Σ (|xᵢ/aᵢ|·t)^nᵢ = 1
//!     f = r_in·(1 − G)
//! ```
//!
//! The sum is not homogeneous, so the gauge G has no closed form. With `λ = log2 G` and
//! `lᵢ = log2 |xᵢ/aᵢ|` it is the root of `φ(λ) = log2 Σ 2^(nᵢ(lᵢ − λ))`, which falls and is
//! convex. Newton's steps climb to the root from the largest l; each is lengthened by the next
//! term of the series (Chebyshev), to twice its length at most, which takes six steps where
//! Newton takes nine.
//!
//! Derivatives are those of the implicit function, with `wᵢ = (uᵢ/G)^nᵢ`, `Σ wᵢ = 1`:
//!
//! ```text
//!     ∂G/∂uᵢ = nᵢ·(uᵢ/G)^(nᵢ − 1) / Σ nⱼwⱼ
//! ```
//!
//! The nested superellipsoid with two exponents is no case of this family unless they are
//! equal, nor the other way about.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::{Field, Kernel, ParamError, check};
use crate::{Bounds, Monotone3, Real};

/// The allowed exponents: within them the steps below suffice.
const EXPONENTS: [f64; 2] = [0.2, 60.0];

/// Steps after which `log2 G` is within 10⁻¹⁴, for every exponent in the range.
const STEPS: u32 = 6;

/// Coordinates below this, in semi-axes, count as 0 where they are divided by.
const TINY: f64 = 1e-30;

/// A generalised superquadric about the origin, valued `f = r_in·(1 − G)` in length units,
/// where `r_in` is the radius of the largest inscribed sphere (to 10⁻⁶).
///
#[doc = picture!("generalised_superquadric" = "docs/gallery/generalised_superquadric.png")]
///
/// ```text
/// surface   |x/a₁|^n₁ + |y/a₂|^n₂ + |z/a₃|^n₃ = 1
/// gauge     G with |x/(a₁G)|^n₁ + |y/(a₂G)|^n₂ + |z/(a₃G)|^n₃ = 1, by Newton's method
/// ```
///
/// Convex and 1-Lipschitz where all exponents are at least 1, and so never more than the
/// distance; below, it is pinched along the axis planes, the slope is unbounded there and no
/// Lipschitz constant exists.
///
/// | parameter | unit | range |
/// |---|---|---|
/// | `semi_axes` | length | 10⁻⁹ to 10⁹ each |
/// | `exponents` | none | 0.2 to 60 each, along x, y and z: 2 round, 1 straight, large square |
///
/// Single-precision lanes keep within `4·10⁻⁶·(size + |f|)` of the true value for exponents
/// of 0.5 to 60.
///
/// ```
/// use rvachev::{GeneralisedSuperquadric, Solid};
/// use glam::DVec3;
///
/// let nose = GeneralisedSuperquadric::new(DVec3::ONE, [5.0, 3.0, 1.5]);
/// let p = DVec3::new(0.7, 0.6, 0.5);
/// assert!((nose.barr(p) - 0.737623390593).abs() < 1e-12);
/// assert!((nose.gauge(p) - 0.898475217235).abs() < 1e-12);
/// assert!(Solid::from(nose).contains(p)?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralisedSuperquadric {
    semi_axes: DVec3,
    exponents: [f64; 3],
    inverse: DVec3,
    inscribed: f64,
}

impl GeneralisedSuperquadric {
    /// The superquadric with these semi-axes and exponents `[n1, n2, n3]`; they are checked
    /// when the solid is compiled.
    #[must_use]
    pub fn new(semi_axes: impl Into<DVec3>, exponents: [f64; 3]) -> GeneralisedSuperquadric {
        let semi_axes = semi_axes.into();
        let mut shape =
            GeneralisedSuperquadric { semi_axes, exponents, inverse: semi_axes.recip(), inscribed: f64::NAN };
        if shape.check().is_ok() {
            shape.inscribed = inscribed_radius(semi_axes, exponents);
        }
        shape
    }

    /// The semi-axes.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// The exponents along x, y and z.
    #[must_use]
    pub fn exponents(&self) -> [f64; 3] {
        self.exponents
    }

    /// The gauge G: below 1 inside, 1 on the surface; `p / G(p)` lies on the surface.
    #[must_use]
    pub fn gauge(&self, p: DVec3) -> f64 {
        self.gauge_of(p.to_array())
    }

    /// The sum `|x/a₁|^n₁ + |y/a₂|^n₂ + |z/a₃|^n₃`, which takes the place of Barr's
    /// inside–outside function: below 1 inside.
    #[must_use]
    pub fn barr(&self, p: DVec3) -> f64 {
        let u = (p * self.inverse).to_array();
        u.into_iter().zip(self.exponents).map(|(u, n)| u.pow(n)).sum()
    }

    /// The radial distance `|p|·(1 − 1/G)`: negative inside, an upper bound of the distance
    /// in absolute value. At the origin, minus the inscribed radius.
    #[must_use]
    pub fn radial_distance(&self, p: DVec3) -> f64 {
        let gauge = self.gauge(p);
        if gauge == 0.0 { -self.inscribed } else { p.length() * (1.0 - 1.0 / gauge) }
    }

    /// Radius of the largest sphere about the origin inside the solid, from below, to 10⁻⁶.
    #[must_use]
    pub fn inscribed_radius(&self) -> f64 {
        self.inscribed
    }

    #[inline(always)]
    fn gauge_of<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        let i = self.inverse;
        (x * i.x).abs().monotone3((y * i.y).abs(), (z * i.z).abs(), &Gauge(self.exponents))
    }
}

/// The gauge of the unit shape, of coordinates ≥ 0.
#[derive(Clone, Copy)]
struct Gauge([f64; 3]);

impl Monotone3 for Gauge {
    const ITERATES: bool = true;

    #[inline(always)]
    fn value<R: Real>(&self, x: R, y: R, z: R) -> R {
        let [n1, n2, n3] = self.0;
        // Relative to the largest coordinate: logarithms are small where they matter, and λ
        // starts at 0.
        let largest = x.max(y).max(z);
        let scale = x.lift(1.0) / largest.max(x.lift(TINY));
        let (a, b, c) = ((x * scale).log2(), (y * scale).log2(), (z * scale).log2());
        let zero = x.lift(0.0);
        let half_ln2 = 0.5 * std::f64::consts::LN_2;
        let mut level = zero;
        let mut step = 0;
        while step < STEPS {
            let w1 = ((a - level) * n1).exp2();
            let w2 = ((b - level) * n2).exp2();
            let w3 = ((c - level) * n3).exp2();
            let sum = w1 + w2 + w3;
            let first = w1.scale_add(n1, w2.scale_add(n2, w3 * n3));
            let second = w1.scale_add(n1 * n1, w2.scale_add(n2 * n2, w3 * (n3 * n3)));
            // The sum stays above 1/3; at the origin there are no weights at all.
            let recip = x.lift(1.0) / first.max(x.lift(0.02));
            let value = sum.log2();
            let newton = sum * recip;
            let bend = value * half_ln2 * (second * recip * newton - 1.0);
            let longer = bend.max(zero).min(x.lift(1.0)) + 1.0;
            level = level + value * newton * longer;
            step += 1;
        }
        // Only at the origin is the level not small.
        largest * level.max(zero).min(x.lift(16.0)).exp2()
    }

    #[inline(always)]
    fn parts<R: Real>(&self, x: R, y: R, z: R) -> (R, [R; 3]) {
        let [n1, n2, n3] = self.0;
        let value = x.monotone3(y, z, self);
        let floor = value.max(x.lift(TINY));
        let (w1, s1) = weight_and_slope(x, floor, n1);
        let (w2, s2) = weight_and_slope(y, floor, n2);
        let (w3, s3) = weight_and_slope(z, floor, n3);
        // An average of the exponents, which a range of it does not know.
        let mean = w1.scale_add(n1, w2.scale_add(n2, w3 * n3));
        let mean = mean.max(x.lift(n1.min(n2).min(n3))).min(x.lift(n1.max(n2).max(n3)));
        let recip = x.lift(1.0) / mean;
        (value, [s1 * recip, s2 * recip, s3 * recip])
    }
}

/// `(u/G)^n` and `n·(u/G)^(n − 1)`, the latter 0 where u is.
#[inline(always)]
fn weight_and_slope<R: Real>(u: R, gauge: R, n: f64) -> (R, R) {
    let one = u.lift(1.0);
    let ratio = (u / gauge).min(one);
    let (weight, slope) = if n == 1.0 {
        (ratio, one)
    } else if n > 1.0 {
        let slope = ratio.pow(n - 1.0);
        (slope * ratio, slope * n)
    } else {
        (ratio.pow(n), u.lift(n) / ratio.max(u.lift(TINY)).pow(1.0 - n))
    };
    (weight, (u - TINY).select(slope, u.lift(0.0)))
}

/// Radius of the largest sphere about the origin inside the solid, from below.
///
/// The radius is the least |p| on the surface; the gauge of a convex solid has slope 1/radius
/// at most. With the shares `vᵢ = |xᵢ/aᵢ|^nᵢ`, which add up to 1, |p|² is `Σ aᵢ²·vᵢ^(2/nᵢ)`: a
/// sum of one term per share over a triangle. A term that is convex lies above its tangents,
/// one that is concave above its chords, which makes a linear bound whose least value is at
/// a corner. The triangle with the least bound is split until a value close to it is reached.
fn inscribed_radius(semi_axes: DVec3, exponents: [f64; 3]) -> f64 {
    /// Of the squared radius.
    const CLOSE: f64 = 1.0 - 1e-6;
    const MOST: usize = 10_000;
    let unit = semi_axes.min_element();
    let terms = [0, 1, 2].map(|i| Term { factor: (semi_axes[i] / unit).powi(2), power: 2.0 / exponents[i] });
    let value = |v: DVec3| terms[0].at(v.x) + terms[1].at(v.y) + terms[2].at(v.z);
    let mut triangles = vec![[DVec3::X, DVec3::Y, DVec3::Z]];
    // Bounds are not negative, and such floats are ordered as their bits are.
    let mut queue = BinaryHeap::from([Reverse((0u64, 0usize))]);
    // At an end of an axis |p| is the semi-axis itself.
    let (mut reached, mut least) = (1.0f64, 0.0);
    while let Some(Reverse((bound, index))) = queue.pop() {
        least = f64::from_bits(bound);
        if least >= CLOSE * reached || triangles.len() > MOST {
            break;
        }
        let Some(&[a, b, c]) = triangles.get(index) else { break };
        let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            reached = reached.min(value((corners[0] + corners[1] + corners[2]) / 3.0));
            queue.push(Reverse((bound_over(&terms, corners).max(least).to_bits(), triangles.len())));
            triangles.push(corners);
        }
    }
    unit * least.min(reached).sqrt() * (1.0 - 1e-14)
}

/// `factor · v^power`, a share of the squared distance.
#[derive(Clone, Copy)]
struct Term {
    factor: f64,
    power: f64,
}

impl Term {
    fn at(self, v: f64) -> f64 {
        self.factor * v.max(0.0).powf(self.power)
    }
}

/// A bound from below on the sum of the terms over a triangle of shares.
fn bound_over(terms: &[Term; 3], corners: [DVec3; 3]) -> f64 {
    let mut sums = [0.0f64; 3];
    for (i, term) in terms.iter().enumerate() {
        let v = corners.map(|corner| corner[i]);
        let (lo, hi) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let (at, slope) = if term.power >= 1.0 {
            let middle = 0.5 * (lo + hi);
            (middle, term.factor * term.power * middle.powf(term.power - 1.0))
        } else {
            (lo, if hi > lo { (term.at(hi) - term.at(lo)) / (hi - lo) } else { 0.0 })
        };
        for (sum, v) in sums.iter_mut().zip(v) {
            *sum += term.at(at) + slope * (v - at);
        }
    }
    sums[0].min(sums[1]).min(sums[2])
}

impl Field for GeneralisedSuperquadric {
    fn name(&self) -> &'static str {
        "generalised superquadric"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, p: [R; 3]) -> R {
        self.gauge_of(p).scale_add(-self.inscribed, p[0].lift(self.inscribed))
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(-self.semi_axes, self.semi_axes)
    }

    fn creases(&self) -> Vec<DVec3> {
        DVec3::AXES.into_iter().zip(self.exponents).filter_map(|(axis, n)| (n < 1.0).then_some(axis)).collect()
    }

    fn check(&self) -> Result<(), ParamError> {
        check::lengths("semi_axes", self.semi_axes)?;
        for (name, n) in ["n1", "n2", "n3"].into_iter().zip(self.exponents) {
            check::within(&format!("exponents.{name}"), n, EXPONENTS[0], EXPONENTS[1])?;
        }
        Ok(())
    }

    fn gauge_radius(&self) -> Option<f64> {
        Some(self.inscribed)
    }

    fn convex(&self) -> bool {
        self.exponents.iter().all(|&n| n >= 1.0)
    }

    fn support(&self, direction: DVec3) -> f64 {
        // With the shares v of the surface the largest `Σ bᵢ·vᵢ^(1/nᵢ)`, `Σ vᵢ = 1`. Any price
        // μ of a share gives a bound, `μ + Σ max (bᵢ·vᵢ^(1/nᵢ) − μ·vᵢ)`; that at which the
        // shares demanded add up to 1 is the support itself where the solid is convex.
        let b = (direction * self.semi_axes).abs().to_array();
        let total: f64 = b.iter().sum();
        if total == 0.0 {
            return 0.0;
        }
        let demand = |i: usize, price: f64| -> f64 {
            let n = self.exponents[i];
            if n > 1.0 {
                let ratio = b[i] / (n * price);
                if ratio >= 1.0 { 1.0 } else { ratio.powf(n / (n - 1.0)) }
            } else {
                f64::from(b[i] > price)
            }
        };
        let bound = |price: f64| -> f64 {
            let gain = |i: usize| {
                let share = demand(i, price);
                b[i] * share.powf(1.0 / self.exponents[i]) - price * share
            };
            price + gain(0) + gain(1) + gain(2)
        };
        let (mut low, mut high) = (1e-3 * total / EXPONENTS[1], total);
        for _ in 0..60 {
            let price = 0.5 * (low + high);
            if demand(0, price) + demand(1, price) + demand(2, price) > 1.0 {
                low = price;
            } else {
                high = price;
            }
        }
        bound(low).min(bound(high)) * (1.0 + 1e-12)
    }

    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K) {
        kernel.run(self);
    }

    fn roundoff(&self, reach: f64) -> f64 {
        let size = self.semi_axes.length().min(reach);
        let least = self.exponents.iter().copied().fold(1.0, f64::min);
        if least >= 1.0 {
            return 4e-6 * size;
        }
        // Across a cusp a displacement d of a coordinate moves G by some (d/a)^n / n.
        let displaced = 1e-6 * reach / self.semi_axes.min_element();
        size * (4e-6 + 4.0 / least * displaced.powf(least))
    }
}
