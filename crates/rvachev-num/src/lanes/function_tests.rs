//! The stated error bounds of the functions, by sweeps.

use super::Lanes;
use super::sweep::{Function, Random, SPICY, line, sweep32, sweep64};
use crate::Real;

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

#[test]
fn log2_is_within_its_bounds() {
    let near = line(1_000_000, 0.5, 2.0, |x| x);
    let wide = line(1_000_000, -125.9, 127.9, f64::exp2);
    let error = |[x, _, _]: [f64; 3], r: [f64; 4]| r[0] - x.log2();
    assert!(sweep32(&Log2, &near, error).error < 1.4e-7);
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
    let error = |[x, _, _]: [f64; 3], r: [f64; 4]| (r[0] - x.sin()).abs().max((r[1] - x.cos()).abs());
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
    let mut at: Vec<[f64; 3]> =
        (0..1_000_000).map(|_| [random.decades(-6.0, 6.0), random.decades(-6.0, 6.0), 0.0]).collect();
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
