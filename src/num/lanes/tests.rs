//! The stated error bounds, by sweeps over every SIMD level of the machine.

use super::sweep::{Function, Random, Worst, levels, run_f32, run_f64};
use super::{Lanes, LogSpace};
use crate::num::{Norm, Real};

/// Arguments that break formulas.
const SPICY: [f64; 15] = [
    0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-20, -1e-20, 1e20, -1e20, 1e-30, 1e30, 1e-37, 3e38, -3e38,
];

/// Declares a function of lanes.
macro_rules! function {
    ($name:ident, |$x:ident, $y:ident, $z:ident| $body:expr) => {
        struct $name;
        impl Function for $name {
            #[inline(always)]
            fn run<T: Lanes>(&self, [$x, $y, $z]: [T; 3]) -> [T; 4] {
                $body
            }
        }
    };
}

function!(Log2, |x, _y, _z| [x.log2(); 4]);
function!(Exp2, |x, _y, _z| [x.exp2(); 4]);
function!(SinCos, |x, _y, _z| {
    let (sin, cos) = x.sin_cos();
    [sin, cos, sin, cos]
});
function!(Atan2, |x, y, _z| [x.atan2(y); 4]);
function!(Basics, |x, y, z| [x.sqrt(), x.select(y, z), x.min(y), x.max(y)]);

struct Pow(f64);
impl Function for Pow {
    #[inline(always)]
    fn run<T: Lanes>(&self, [x, _, _]: [T; 3]) -> [T; 4] {
        [x.pow(self.0); 4]
    }
}

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

/// Sweeps `f32` lanes on all levels: the worst of `error(arguments, results)`.
fn sweep32(
    function: &impl Function,
    at: &[[f64; 3]],
    error: impl Fn([f64; 3], [f64; 4]) -> f64,
) -> Worst {
    let at: Vec<[f32; 3]> = at.iter().map(|p| p.map(|c| c as f32)).collect();
    let mut worst = Worst::new();
    for level in levels() {
        let mut here = Worst::new();
        for (p, r) in at.iter().zip(run_f32(level, function, &at)) {
            let (p, r) = (p.map(f64::from), r.map(f64::from));
            let finite = r.iter().all(|v| v.is_finite());
            here.add(if finite { error(p, r) } else { f64::NAN }, p);
        }
        println!("  f32 {level:?}: {here:?}");
        worst.add(here.error, here.at);
    }
    worst
}

/// The same for `f64` lanes.
fn sweep64(
    function: &impl Function,
    at: &[[f64; 3]],
    error: impl Fn([f64; 3], [f64; 4]) -> f64,
) -> Worst {
    let mut worst = Worst::new();
    for level in levels() {
        let mut here = Worst::new();
        for (p, r) in at.iter().zip(run_f64(level, function, at)) {
            let finite = r.iter().all(|v| v.is_finite());
            here.add(if finite { error(*p, r) } else { f64::NAN }, *p);
        }
        println!("  f64 {level:?}: {here:?}");
        worst.add(here.error, here.at);
    }
    worst
}

/// `n` single arguments between lo and hi, made by `map`.
fn line(n: usize, lo: f64, hi: f64, map: impl Fn(f64) -> f64) -> Vec<[f64; 3]> {
    let step = (hi - lo) / n as f64;
    (0..=n).map(|i| [map(lo + step * i as f64), 0.0, 0.0]).collect()
}

#[test]
fn log2_is_within_its_bounds() {
    let near = line(1_000_000, 0.5, 2.0, |x| x);
    let wide = line(1_000_000, -125.9, 127.9, f64::exp2);
    let error = |[x, _, _]: [f64; 3], r: [f64; 4]| r[0] - x.log2();
    assert!(sweep32(&Log2, &near, error).error < 1.0e-7);
    assert!(sweep32(&Log2, &wide, |p, r| error(p, r) / (1.0 + p[0].log2().abs())).error < 1.0e-7);
    assert!(sweep64(&Log2, &near, error).error < 3.0e-16);
    let wide = line(500_000, -1021.9, 1023.9, f64::exp2);
    assert!(sweep64(&Log2, &wide, |p, r| error(p, r) / (1.0 + p[0].log2().abs())).error < 2.5e-16);
    let powers = line(252, -126.0, 126.0, f64::exp2);
    assert_eq!(sweep32(&Log2, &powers, error).error, 0.0);
    assert_eq!(sweep64(&Log2, &powers, error).error, 0.0);
    let zeros = [[0.0; 3], [-0.0; 3], [1e-40; 3]];
    assert!(sweep32(&Log2, &zeros, |_, r| r[0] + 16384.0).error == 0.0);
    assert!(sweep64(&Log2, &[[0.0; 3], [-0.0; 3], [1e-310; 3]], |_, r| r[0] + 1e5).error == 0.0);
}

#[test]
fn exp2_is_within_its_bounds() {
    let relative = |[x, _, _]: [f64; 3], r: [f64; 4]| r[0] / x.exp2() - 1.0;
    let all = line(2_000_000, -126.0, 127.999, |x| x);
    assert!(sweep32(&Exp2, &all, relative).error < 1.2e-7);
    let all = line(1_000_000, -1022.0, 1023.999, |x| x);
    assert!(sweep64(&Exp2, &all, relative).error < 3.0e-16);
    let integers = line(253, -126.0, 127.0, |x| x);
    assert_eq!(sweep32(&Exp2, &integers, relative).error, 0.0);
    assert_eq!(sweep64(&Exp2, &integers, relative).error, 0.0);
    for x in [-126.1, -1e3, -1e9, -3e38] {
        assert_eq!(sweep32(&Exp2, &[[x; 3]], |_, r| r[0]).error, 0.0);
        assert_eq!(sweep64(&Exp2, &[[x * 9.0; 3]], |_, r| r[0]).error, 0.0);
    }
    for x in [128.0, 1e3, 1e9, 3e38] {
        assert_eq!(sweep32(&Exp2, &[[x; 3]], |_, r| r[0] - f64::from(f32::MAX)).error, 0.0);
        assert_eq!(sweep64(&Exp2, &[[x * 8.0; 3]], |_, r| r[0] - f64::MAX).error, 0.0);
    }
}

#[test]
fn pow_is_within_its_bounds() {
    for p in [0.01, 0.3, 1.0, 2.5, 20.0] {
        let range = 120.0 / f64::max(p, 1.0);
        let at = line(300_000, -range, range, f64::exp2);
        let error = |[x, _, _]: [f64; 3], r: [f64; 4]| r[0] / x.powf(p) - 1.0;
        let parts = |x: f64| p * (1.0 + x.log2().abs());
        assert!(sweep32(&Pow(p), &at, |q, r| error(q, r) / (1.5 + parts(q[0]))).error < 1e-7);
        assert!(sweep64(&Pow(p), &at, |q, r| error(q, r) / (1.5 + parts(q[0]))).error < 3e-16);
        assert_eq!(sweep32(&Pow(p), &[[0.0; 3], [-0.0; 3]], |_, r| r[0]).error, 0.0);
        assert_eq!(sweep64(&Pow(p), &[[0.0; 3], [-0.0; 3]], |_, r| r[0]).error, 0.0);
    }
    let spicy = SPICY.map(|x| [x; 3]);
    for p in [1e-3, 0.5, 3.0, 2000.0] {
        assert!(sweep32(&Pow(p), &spicy, |_, _| 0.0).error == 0.0);
        assert!(sweep64(&Pow(p), &spicy, |_, _| 0.0).error == 0.0);
    }
}

#[test]
fn sine_and_cosine_are_within_their_bounds() {
    let error =
        |[x, _, _]: [f64; 3], r: [f64; 4]| (r[0] - x.sin()).abs().max((r[1] - x.cos()).abs());
    assert!(sweep32(&SinCos, &line(2_000_000, -12e3, 12e3, |x| x), error).error < 1.2e-7);
    assert!(sweep32(&SinCos, &line(1_000_000, -4.0, 4.0, |x| x), error).error < 1.2e-7);
    assert!(sweep64(&SinCos, &line(1_000_000, -1e6, 1e6, |x| x), error).error < 2.5e-16);
    assert!(sweep64(&SinCos, &line(1_000_000, -4.0, 4.0, |x| x), error).error < 2.5e-16);
    let huge: Vec<_> = line(10_000, 3.0, 38.5, |x| 10f64.powf(x));
    let outside = |_: [f64; 3], r: [f64; 4]| (r[0].abs().max(r[1].abs()) - 1.0).max(0.0);
    assert_eq!(sweep32(&SinCos, &huge, outside).error, 0.0);
    assert_eq!(sweep64(&SinCos, &huge, outside).error, 0.0);
}

#[test]
fn angles_are_within_their_bounds() {
    let mut random = Random(1);
    let mut at: Vec<[f64; 3]> = (0..1_000_000)
        .map(|_| [random.decades(-6.0, 6.0), random.decades(-6.0, 6.0), 0.0])
        .collect();
    at.extend(SPICY.iter().flat_map(|&y| SPICY.map(|x| [y, x, 0.0])));
    let error = |[y, x, _]: [f64; 3], r: [f64; 4]| {
        let angle = Real::atan2(y, x);
        // An angle below the smallest normal number is flushed.
        if angle.abs() < 1e-37 { r[0] } else { r[0] / angle - 1.0 }
    };
    assert!(sweep32(&Atan2, &at, error).error < 3.0e-7);
    assert!(sweep64(&Atan2, &at, error).error < 5.0e-16);
    for (y, x, angle) in [(0.0, 0.0, 0.0), (-0.0, -0.0, 0.0), (-0.0, -1.0, std::f64::consts::PI)] {
        assert!(sweep32(&Atan2, &[[y, x, 0.0]], |_, r| r[0] - angle).error < 1e-7);
        assert!(sweep64(&Atan2, &[[y, x, 0.0]], |_, r| r[0] - angle).error == 0.0);
    }
}

#[test]
fn basics_are_those_of_f64() {
    let at: Vec<[f64; 3]> = SPICY.iter().flat_map(|&x| SPICY.map(|y| [x, y, 7.0])).collect();
    let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
        let root = Real::sqrt(x);
        ((r[0] - root) / root.max(1e-300))
            .abs()
            .max((r[1] - Real::select(x, y, z)).abs())
            .max((r[2] - f64::min(x, y)).abs())
            .max((r[3] - f64::max(x, y)).abs())
    };
    assert!(sweep32(&Basics, &at, error).error < 1e-7);
    assert!(sweep64(&Basics, &at, error).error < 2e-16);
}

/// Points over six decades up to 10⁷, and awkward ones.
fn points(random: &mut Random, n: usize) -> Vec<[f64; 3]> {
    let mut at: Vec<[f64; 3]> = (0..n)
        .map(|_| [0; 3].map(|_| random.decades(-3.0, 3.0)))
        .collect();
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
    let (mut w32, mut w64) = (Worst::new(), Worst::new());
    for _ in 0..600 {
        let (inner, outer) = (random.norm(), random.norm());
        let at = points(&mut random, 1000);
        let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
            let g = x.nested(y, z, inner, outer);
            if g == 0.0 { r[0] } else { (r[0] - g) / g }
        };
        let worst = sweep32(&Nested(inner, outer), &at, error);
        w32.add(worst.error, worst.at);
        assert!(worst.error < 1.0e-6, "{inner:?} {outer:?} {worst:?}");
        let worst = sweep64(&Nested(inner, outer), &at, error);
        w64.add(worst.error, worst.at);
        assert!(worst.error < 3.0e-15, "{inner:?} {outer:?} {worst:?}");
    }
    println!("NESTED {w32:?} {w64:?}");
}

#[test]
fn nested_derivatives_are_those_of_f64() {
    let mut random = Random(3);
    let (mut w32, mut w64) = (Worst::new(), Worst::new());
    for _ in 0..300 {
        let (inner, outer) = (random.norm(), random.norm());
        let (p, q) = (inner.p().min(40.0), outer.p().min(40.0));
        let at = points(&mut random, 500);
        let error = |[x, y, z]: [f64; 3], r: [f64; 4]| {
            let (g, d) = x.nested_parts(y, z, inner, outer);
            let value = if g == 0.0 { r[0] } else { (r[0] - g) / g };
            // Where p < 1 slopes near an axis are large, and their relative error counts.
            let slopes = (0..3)
                .map(|k| ((r[k + 1] - d[k]) / d[k].abs().max(1.0)).abs())
                .fold(0.0, f64::max);
            // Derivatives of Max jump where the reference and the lanes round differently.
            let jump = [inner, outer].contains(&Norm::Max) && slopes > 0.4;
            let steep = d.iter().any(|d| d.abs() > 2f64.powi(50));
            if jump || steep { 0.0 } else { value.abs().max(slopes / (1.0 + p.max(q))) }
        };
        let worst = sweep32(&NestedParts(inner, outer), &at, error);
        w32.add(worst.error, worst.at);
        assert!(worst.error < 1.0e-6, "{inner:?} {outer:?} {worst:?}");
        let worst = sweep64(&NestedParts(inner, outer), &at, error);
        w64.add(worst.error, worst.at);
        assert!(worst.error < 3.0e-15, "{inner:?} {outer:?} {worst:?}");
    }
    println!("PARTS {w32:?} {w64:?}");
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
            let slope = |d: f64, r: f64| ((r - d) / d.abs().max(1.0)).abs() / (1.0 + p);
            value.max(slope(dx, r[1])).max(slope(dy, r[2]))
        };
        assert!(sweep32(&PairParts(norm), &at, error).error < 1.0e-6, "{norm:?}");
        assert!(sweep64(&PairParts(norm), &at, error).error < 3.0e-15, "{norm:?}");
    }
}

/// The smallest power of two is what a chunk's coordinates are taken relative to.
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
    let error = |[x, _, _]: [f64; 3], r: [f64; 4]| {
        (r[0] - x.log2().floor().exp2()).abs() + (r[0] * r[1] - 1.0).abs()
    };
    assert_eq!(sweep32(&Power, &at, error).error, 0.0);
    assert_eq!(sweep64(&Power, &at, error).error, 0.0);
}
