//! Test support: runs a function of lanes over many arguments, on every SIMD level that kernels
//! run at on the machine.

use fearless_simd::{Level, Simd};

use super::{F32, F64, Lanes, Twice};
use crate::Norm;

/// Arguments that break formulas.
pub(super) const SPICY: [f64; 15] =
    [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-20, -1e-20, 1e20, -1e20, 1e-30, 1e30, 1e-37, 3e38, -3e38];

/// A function of three numbers, with up to four results.
pub(super) trait Function {
    /// The results; one that has fewer leaves the rest as it likes.
    fn run<T: Lanes>(&self, arguments: [T; 3]) -> [T; 4];
}

/// Sweeps `f32` lanes on all levels: the worst of `error(arguments, results)`.
pub(super) fn sweep32(function: &impl Function, at: &[[f64; 3]], error: impl Fn([f64; 3], [f64; 4]) -> f64) -> Worst {
    let at: Vec<[f32; 3]> = at.iter().map(|p| p.map(|c| c as f32)).collect();
    let mut worst = Worst::new();
    for results in run_f32(function, &at) {
        let mut here = Worst::new();
        for (p, r) in at.iter().zip(results) {
            let (p, r) = (p.map(f64::from), r.map(f64::from));
            let finite = r.iter().all(|v| v.is_finite());
            here.add(if finite { error(p, r) } else { f64::NAN }, p);
        }
        worst.add(here.error, here.at);
    }
    worst
}

/// The same for `f64` lanes.
pub(super) fn sweep64(function: &impl Function, at: &[[f64; 3]], error: impl Fn([f64; 3], [f64; 4]) -> f64) -> Worst {
    let mut worst = Worst::new();
    for results in run_f64(function, at) {
        let mut here = Worst::new();
        for (p, r) in at.iter().zip(results) {
            let finite = r.iter().all(|v| v.is_finite());
            here.add(if finite { error(*p, r) } else { f64::NAN }, *p);
        }
        worst.add(here.error, here.at);
    }
    worst
}

/// `n` single arguments between lo and hi, made by `map`.
pub(super) fn line(n: usize, lo: f64, hi: f64, map: impl Fn(f64) -> f64) -> Vec<[f64; 3]> {
    let step = (hi - lo) / n as f64;
    (0..=n).map(|i| [map(lo + step * i as f64), 0.0, 0.0]).collect()
}

/// Calls with the token of each SIMD level that kernels run at on this machine, but those that are
/// left out of the build, and collects what comes.
macro_rules! on_levels {
    ($simd:ident => $call:expr) => {{
        #[cfg(not(target_arch = "x86_64"))]
        let all = vec![fearless_simd::dispatch!(Level::new(), $simd => $call)];
        #[cfg(target_arch = "x86_64")]
        let mut all = Vec::new();
        #[cfg(all(target_arch = "x86_64", not(disable_dispatch_avx512)))]
        all.extend(Level::new().as_avx512().map(|$simd| Simd::vectorize($simd, #[inline(always)] || $call)));
        #[cfg(all(target_arch = "x86_64", not(disable_dispatch_avx2)))]
        all.extend(Level::new().as_avx2().map(|$simd| Simd::vectorize($simd, #[inline(always)] || $call)));
        all
    }};
}

/// Runs `function` on lanes of `f32`, two vectors at a time.
fn run_f32(function: &impl Function, at: &[[f32; 3]]) -> Vec<Vec<[f32; 4]>> {
    on_levels!(simd => run::<_, Twice<F32<_>>>(simd, function, at))
}

/// Runs `function` on lanes of `f64`.
fn run_f64(function: &impl Function, at: &[[f64; 3]]) -> Vec<Vec<[f64; 4]>> {
    on_levels!(simd => run::<_, F64<_>>(simd, function, at))
}

#[inline(always)]
fn run<S: Simd, T: Lanes<Token = S>>(
    simd: S,
    function: &impl Function,
    at: &[[T::Element; 3]],
) -> Vec<[T::Element; 4]> {
    let mut out = Vec::with_capacity(at.len() + T::WIDTH);
    for chunk in at.chunks(T::WIDTH) {
        let arguments = [0, 1, 2].map(|axis| {
            let mut lane: Vec<T::Element> = chunk.iter().map(|p| p[axis]).collect();
            lane.resize(T::WIDTH, chunk[0][axis]);
            T::load(simd, &lane)
        });
        let results = function.run(arguments).map(|result| {
            let mut lane = vec![chunk[0][0]; T::WIDTH];
            result.store(&mut lane);
            lane
        });
        out.extend((0..T::WIDTH).map(|i| [0, 1, 2, 3].map(|k| results[k][i])));
    }
    out.truncate(at.len());
    out
}

/// A small generator of uniform numbers (tests want the same ones every time).
pub(super) struct Random(pub(super) u64);

impl Random {
    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [lo, hi).
    pub(super) fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Of either sign and any size from 10^lo to 10^hi; now and then exactly 0.
    pub(super) fn decades(&mut self, lo: f64, hi: f64) -> f64 {
        let size = 10f64.powf(self.within(lo, hi));
        match (self.unit() * 40.0) as u32 {
            0 => 0.0,
            n if n % 2 == 0 => size,
            _ => -size,
        }
    }

    /// A p-norm with an exponent from 0.8 to 40, or one of the special ones.
    pub(super) fn norm(&mut self) -> Norm {
        match (self.unit() * 12.0) as u32 {
            0 => Norm::Sum,
            1 => Norm::Euclid,
            2 => Norm::Max,
            _ => Norm::new(0.8 * 50f64.powf(self.unit())),
        }
    }
}

/// The largest of some errors, with the argument where it is; NaN counts as infinite.
#[derive(Debug)]
pub(super) struct Worst {
    pub(super) error: f64,
    pub(super) at: [f64; 3],
}

impl Worst {
    pub(super) fn new() -> Worst {
        Worst { error: 0.0, at: [0.0; 3] }
    }

    pub(super) fn add(&mut self, error: f64, at: [f64; 3]) {
        let error = if error.is_nan() { f64::INFINITY } else { error.abs() };
        if error > self.error {
            *self = Worst { error, at };
        }
    }
}
