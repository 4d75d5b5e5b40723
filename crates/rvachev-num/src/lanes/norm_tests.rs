//! The stated error bounds of the norms and their derivatives, by sweeps.

use super::Lanes;
use super::sweep::{Function, Random, SPICY, line, sweep32, sweep64};
use crate::{Norm, Real};

struct Nested(Norm, Norm);
impl Function for Nested {
    #[inline(always)]
    fn run<T: Lanes>(&self, [x, y, z]: [T; 3]) -> [T; 4] {
        [x.nested(y, z, self.0, self.1); 4]
    }
}

struct NestedParts(Norm, Norm);
impl Function for NestedParts {
    #[inline(always)]
    fn run<T: Lanes>(&self, [x, y, z]: [T; 3]) -> [T; 4] {
        let (value, [dx, dy, dz]) = x.nested_parts(y, z, self.0, self.1);
        [value, dx, dy, dz]
    }
}

struct PairParts(Norm);
impl Function for PairParts {
    #[inline(always)]
    fn run<T: Lanes>(&self, [x, y, _]: [T; 3]) -> [T; 4] {
        let (value, dx, dy) = x.norm_parts(y, self.0);
        [value, dx, dy, x.norm(y, self.0)]
    }
}

/// Points over six decades up to 10⁷, and awkward ones.
fn points(random: &mut Random, n: usize) -> Vec<[f64; 3]> {
    let mut at: Vec<[f64; 3]> = (0..n).map(|_| [0; 3].map(|_| random.decades(-3.0, 3.0))).collect();
    at.extend((0..n / 4).map(|_| [0; 3].map(|_| random.decades(1.0, 7.0))));
    at.extend((0..n / 2).map(|_| [0; 3].map(|_| random.within(-1.5, 1.5))));
    let awkward = [0.0, -0.0, 1e-20, -1e-20, 1e20, 1.0];
    for x in awkward {
        for y in awkward {
            at.extend(awkward.map(|z| [x, y, z]));
        }
    }
    // As lanes of f32 see them.
    at.iter().map(|p| p.map(|c| f64::from(c as f32))).collect()
}

#[test]
fn nested_norms_are_those_of_f64() {
    let mut random = Random(2);
    for _ in 0..600 {
        let (inner, outer) = (random.norm(), random.norm());
        let at = points(&mut random, 1000);
        let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
            let g = x.nested(y, z, inner, outer);
            if g == 0.0 { r[0] } else { (r[0] - g) / g }
        };
        let worst = sweep32(&Nested(inner, outer), &at, error);
        assert!(worst.error < 5.0e-7, "{inner:?} {outer:?} {worst:?}");
        let worst = sweep64(&Nested(inner, outer), &at, error);
        assert!(worst.error < 1.5e-15, "{inner:?} {outer:?} {worst:?}");
    }
}

/// The error of a slope. Where p < 1 slopes near an axis are large: they are 2 to the power
/// of something whose rounding counts.
fn slope_error(slope: f64, result: f64) -> f64 {
    let large = slope.abs().max(1.0);
    ((result - slope) / (large * (1.0 + large.log2()))).abs()
}

#[test]
fn nested_derivatives_are_those_of_f64() {
    let mut random = Random(3);
    for _ in 0..300 {
        let (inner, outer) = (random.norm(), random.norm());
        let (p, q) = (inner.p().min(40.0), outer.p().min(40.0));
        let at = points(&mut random, 500);
        let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
            let (g, d) = x.nested_parts(y, z, inner, outer);
            let value = if g == 0.0 { r[0] } else { (r[0] - g) / g };
            let slopes = (0..3).map(|k| slope_error(d[k], r[k + 1])).fold(0.0, f64::max);
            // Derivatives of Max jump where the reference and the lanes round differently.
            // Far below the largest coordinate a logarithm is large, and so is its rounding.
            let size = [x, y, z].map(f64::abs);
            let largest = size.into_iter().fold(0.0, f64::max);
            let smallest = size.into_iter().filter(|c| *c > 0.0).fold(largest, f64::min);
            let spread = 1.0 + (largest.max(1e-300) / smallest.max(1e-300)).log2() / 16.0;
            let jump = [inner, outer].contains(&Norm::Max) && slopes > 0.4;
            let steep = d.iter().any(|d| d.abs() > 2f64.powi(50));
            if jump || steep { 0.0 } else { value.abs().max(slopes / (1.0 + p.max(q)) / spread) }
        };
        let worst = sweep32(&NestedParts(inner, outer), &at, error);
        assert!(worst.error < 5.0e-7, "{inner:?} {outer:?} {worst:?}");
        let worst = sweep64(&NestedParts(inner, outer), &at, error);
        assert!(worst.error < 1.5e-15, "{inner:?} {outer:?} {worst:?}");
    }
}

#[test]
fn extreme_exponents_and_coordinates_stay_finite() {
    let exponents = [0.01, 0.1, 0.5, 0.99, 1.0, 1.001, 2.0, 3.0, 200.0, 2000.0, f64::INFINITY];
    let mut at = Vec::new();
    for x in SPICY {
        for y in SPICY {
            at.extend(SPICY.map(|z| [x, y, z]));
        }
    }
    for p in exponents {
        for q in exponents {
            let norms = NestedParts(Norm::new(p), Norm::new(q));
            let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
                let mut wrong = 0.0;
                for (c, d) in [(x, r[1]), (y, r[2]), (z, r[3])] {
                    // 0 on the plane of a coordinate (Sum has a kink there), of its sign off it.
                    let kink = p == 1.0 || q == 1.0;
                    if (c == 0.0 && d != 0.0 && !kink) || c * d < 0.0 {
                        wrong = 1.0;
                    }
                }
                if x == 0.0 && y == 0.0 && z == 0.0 && r != [0.0; 4] { 2.0 } else { wrong }
            };
            assert_eq!(sweep32(&norms, &at, error).error, 0.0, "{p} {q}");
            assert_eq!(sweep64(&norms, &at, error).error, 0.0, "{p} {q}");
        }
    }
}

#[test]
fn pair_derivatives_are_those_of_f64() {
    let mut random = Random(4);
    for norm in [Norm::Sum, Norm::Euclid, Norm::Max, Norm::new(0.8), Norm::new(1.5), Norm::new(9.0)] {
        let at = points(&mut random, 20_000);
        let p = norm.p().min(40.0);
        let error = |[x, y, _]: [f64; 3], r: [f64; 4]| {
            let (g, dx, dy) = x.norm_parts(y, norm);
            let value = ((r[0] - g).abs().max((r[3] - g).abs())) / g.max(1e-30);
            let slopes = slope_error(dx, r[1]).max(slope_error(dy, r[2]));
            value.max(slopes / (1.0 + p))
        };
        assert!(sweep32(&PairParts(norm), &at, error).error < 5.0e-7, "{norm:?}");
        assert!(sweep64(&PairParts(norm), &at, error).error < 1.5e-15, "{norm:?}");
    }
}

#[test]
fn powers_are_exact() {
    struct Power;
    impl Function for Power {
        #[inline(always)]
        fn run<T: Lanes>(&self, [x, _, _]: [T; 3]) -> [T; 4] {
            let power = x.abs().power_below();
            [power, power.power_recip(), power, power]
        }
    }
    let at = line(1000, -125.5, 126.5, f64::exp2);
    let error = |[x, _, _]: [f64; 3], r: [f64; 4]| (r[0] - x.log2().floor().exp2()).abs() + (r[0] * r[1] - 1.0).abs();
    assert_eq!(sweep32(&Power, &at, error).error, 0.0);
    assert_eq!(sweep64(&Power, &at, error).error, 0.0);
}
