//! Formulas over slices: the loops that run a formula on lanes.
//!
//! The SIMD level is chosen once a call; a call runs over a chunk of points, so the choice
//! costs nothing. Each formula is a kernel of its own, with its own loop: fusing several
//! into one spills registers and is slower.

use fearless_simd::{Level, Simd, dispatch};
use fearless_simd_macros::simd;

use super::Real;
use super::lanes::{F32, F64, Lanes, Twice};

/// Slices are multiples of this many elements.
pub(crate) const CHUNK: usize = 256;

/// A formula from `I` numbers to `O`.
pub(crate) trait Formula<const I: usize, const O: usize> {
    fn run<R: Real>(&self, x: [R; I]) -> [R; O];
}

/// A formula that joins `N` numbers to `N` others.
pub(crate) trait Fold<const N: usize> {
    fn fold<R: Real>(&self, all: [R; N], next: [R; N]) -> [R; N];
}

/// An element of a slice, and the lanes that suit it.
pub(crate) trait Element: Copy + Default + Send + Sync + PartialOrd + 'static {
    /// Lanes for formulas of few numbers: two vectors keep the pipeline full.
    type Wide<S: Simd>: Lanes<Element = Self, Token = S>;
    /// Lanes for formulas of many numbers: one vector leaves registers free.
    type Lean<S: Simd>: Lanes<Element = Self, Token = S>;

    fn from_f64(v: f64) -> Self;

    fn negated(self) -> Self;
}

impl Element for f32 {
    type Wide<S: Simd> = Twice<F32<S>>;
    type Lean<S: Simd> = F32<S>;

    fn from_f64(v: f64) -> f32 {
        v as f32
    }

    fn negated(self) -> f32 {
        -self
    }
}

impl Element for f64 {
    type Wide<S: Simd> = F64<S>;
    type Lean<S: Simd> = F64<S>;

    fn from_f64(v: f64) -> f64 {
        v
    }

    fn negated(self) -> f64 {
        -self
    }
}

/// Runs `formula` over slices of one length, a multiple of [`CHUNK`].
pub(crate) fn run<E: Element, const I: usize, const O: usize>(
    formula: &impl Formula<I, O>,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    let level = Level::new();
    if O > 1 {
        dispatch!(level, simd => lean(simd, formula, inputs, outputs));
    } else {
        dispatch!(level, simd => wide(simd, formula, inputs, outputs));
    }
}

#[simd]
fn wide<S: Simd, E: Element, const I: usize, const O: usize, F: Formula<I, O>>(
    simd: S,
    formula: &F,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    sweep::<E::Wide<S>, I, O, F>(simd, formula, inputs, outputs);
}

#[simd]
fn lean<S: Simd, E: Element, const I: usize, const O: usize, F: Formula<I, O>>(
    simd: S,
    formula: &F,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    sweep::<E::Lean<S>, I, O, F>(simd, formula, inputs, outputs);
}

#[inline(always)]
fn sweep<L: Lanes, const I: usize, const O: usize, F: Formula<I, O>>(
    simd: L::Token,
    formula: &F,
    inputs: [&[L::Element]; I],
    mut outputs: [&mut [L::Element]; O],
) {
    let len = outputs[0].len();
    let mut at = 0;
    while at + L::WIDTH <= len {
        let mut x = [L::splat(simd, 0.0); I];
        let mut i = 0;
        while i < I {
            x[i] = L::load(simd, &inputs[i][at..at + L::WIDTH]);
            i += 1;
        }
        let y = formula.run(x);
        let mut o = 0;
        while o < O {
            y[o].store(&mut outputs[o][at..at + L::WIDTH]);
            o += 1;
        }
        at += L::WIDTH;
    }
}

/// Folds `next` into `all`, slices of one length, a multiple of [`CHUNK`].
pub(crate) fn fold<E: Element, const N: usize>(formula: &impl Fold<N>, all: [&mut [E]; N], next: [&[E]; N]) {
    let level = Level::new();
    dispatch!(level, simd => fold_on(simd, formula, all, next));
}

#[simd]
fn fold_on<S: Simd, E: Element, const N: usize, F: Fold<N>>(
    simd: S,
    formula: &F,
    mut all: [&mut [E]; N],
    next: [&[E]; N],
) {
    let width = E::Lean::<S>::WIDTH;
    let len = all[0].len();
    let mut at = 0;
    while at + width <= len {
        let mut x = [E::Lean::<S>::splat(simd, 0.0); N];
        let mut y = x;
        let mut i = 0;
        while i < N {
            x[i] = E::Lean::<S>::load(simd, &all[i][at..at + width]);
            y[i] = E::Lean::<S>::load(simd, &next[i][at..at + width]);
            i += 1;
        }
        let joined = formula.fold(x, y);
        let mut i = 0;
        while i < N {
            joined[i].store(&mut all[i][at..at + width]);
            i += 1;
        }
        at += width;
    }
}
