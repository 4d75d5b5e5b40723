//! Formulas over slices: the loops that run a formula on lanes.
//!
//! The SIMD level is chosen once a call; a call runs over a chunk of points, so the choice
//! costs nothing. Each formula is a kernel of its own, with its own loop: fusing several
//! into one spills registers and is slower.

use fearless_simd::Simd;

use rvachev_num::Real;
use rvachev_num::lanes::{F32, F64, Lanes, Twice};

/// Calls a function with the token of the machine's SIMD level, or does without: point by point on
/// machines that have none, and in the unit tests, which compile the crate a second time; the
/// integration tests run the machine's level.
macro_rules! on_level {
    ($simd:ident => $call:expr, else $scalar:expr) => {
        if cfg!(test) { $scalar } else { rvachev_num::on_level!($simd => $call, else $scalar) }
    };
}

pub(crate) use on_level;

/// Slices are multiples of this many elements.
pub const CHUNK: usize = 256;

/// How many points of a chunk there are up to those that are the same as the last: chunks are
/// filled up with copies of it, which whoever goes point by point need not look at.
#[inline]
pub fn distinct<E: Element>([x, y, z]: [&[E]; 3]) -> usize {
    let is_same = |i: &usize| x[*i] == x[*i - 1] && y[*i] == y[*i - 1] && z[*i] == z[*i - 1];
    x.len() - (1..x.len()).rev().take_while(is_same).count()
}

/// Gives those from one on what the one before them has.
#[inline]
pub fn repeat<T: Copy>(all: &mut [T], from: usize) {
    let (known, rest) = all.split_at_mut(from);
    if let Some(last) = known.last() {
        rest.fill(*last);
    }
}

/// A formula from `I` numbers to `O`.
pub trait Formula<const I: usize, const O: usize>: Sized {
    /// The formula.
    fn run<R: Real>(&self, x: [R; I]) -> [R; O];

    /// Calls `visit` with this formula, special cases of its parameters told apart.
    #[inline(always)]
    fn specialised<V: Visit<I, O>>(&self, visit: V) {
        visit.visit(self);
    }

    /// The formula of one point, where there are no lanes: what has it compiled elsewhere calls
    /// that.
    fn point(&self, x: [f64; I]) -> [f64; O] {
        self.run(x)
    }
}

/// A formula behind a pointer, for the loop over points that is compiled once.
trait ByPoint<const I: usize, const O: usize> {
    fn point(&self, x: [f64; I]) -> [f64; O];
}

impl<const I: usize, const O: usize, F: Formula<I, O>> ByPoint<I, O> for F {
    #[inline]
    fn point(&self, x: [f64; I]) -> [f64; O] {
        Formula::point(self, x)
    }
}

/// What is done with a formula once its cases are told apart.
pub trait Visit<const I: usize, const O: usize> {
    /// Runs it, one vector at a time.
    fn visit<F: Formula<I, O>>(self, formula: &F);

    /// The same, on several vectors at a time.
    fn visit_wide<F: Formula<I, O>>(self, formula: &F);
}

/// A formula that joins `N` numbers to `N` others.
pub trait Fold<const N: usize> {
    /// `next` joined to `all`.
    fn fold<R: Real>(&self, all: [R; N], next: [R; N]) -> [R; N];
}

/// A join behind a pointer.
trait FoldByPoint<const N: usize> {
    fn join(&self, all: [f64; N], next: [f64; N]) -> [f64; N];
}

impl<const N: usize, F: Fold<N>> FoldByPoint<N> for F {
    fn join(&self, all: [f64; N], next: [f64; N]) -> [f64; N] {
        self.fold(all, next)
    }
}

/// An element of a slice, and the lanes that suit it.
pub trait Element: Copy + Default + Send + Sync + PartialOrd + 'static {
    /// Several vectors: they keep the pipeline full where a formula is one long chain.
    type Wide<S: Simd>: Lanes<Element = Self, Token = S>;
    /// One vector: quick to compile, and it leaves registers free.
    type Lean<S: Simd>: Lanes<Element = Self, Token = S>;

    /// The nearest element to a number.
    fn from_f64(v: f64) -> Self;

    /// The number that an element is.
    fn to_f64(self) -> f64;

    /// `−self`.
    fn negated(self) -> Self;

    /// `self + other`.
    fn plus(self, other: Self) -> Self;

    /// How many elements the widest vectors of a kernel hold: slices are multiples of it.
    fn widest() -> usize;

    /// Whether all numbers of a slice are within ±`limit`; NaN is not.
    fn within(numbers: &[Self], limit: Self) -> bool;
}

impl Element for f32 {
    type Wide<S: Simd> = Twice<Twice<F32<S>>>;
    type Lean<S: Simd> = F32<S>;

    #[inline(always)]
    fn from_f64(v: f64) -> f32 {
        v as f32
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.into()
    }

    #[inline(always)]
    fn negated(self) -> f32 {
        -self
    }

    #[inline(always)]
    fn plus(self, other: f32) -> f32 {
        self + other
    }

    fn widest() -> usize {
        widest::<f32>()
    }

    fn within(numbers: &[f32], limit: f32) -> bool {
        let mut all = true;
        check_within(numbers, limit, &mut all);
        all
    }
}

impl Element for f64 {
    type Wide<S: Simd> = F64<S>;
    type Lean<S: Simd> = F64<S>;

    #[inline(always)]
    fn from_f64(v: f64) -> f64 {
        v
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline(always)]
    fn negated(self) -> f64 {
        -self
    }

    #[inline(always)]
    fn plus(self, other: f64) -> f64 {
        self + other
    }

    fn widest() -> usize {
        widest::<f64>()
    }

    fn within(numbers: &[f64], limit: f64) -> bool {
        let mut all = true;
        check_within(numbers, limit, &mut all);
        all
    }
}

fn widest<E: Element>() -> usize {
    on_level!(simd => widest_on::<_, E>(simd), else 1)
}

#[inline(always)]
fn widest_on<S: Simd, E: Element>(_simd: S) -> usize {
    E::Wide::<S>::WIDTH
}

/// Runs `formula` over slices of one length, a multiple of the widest vectors ([`CHUNK`] is one).
#[inline]
pub fn run<E: Element, const I: usize, const O: usize>(
    formula: &impl Formula<I, O>,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    on_level!(simd => run_on(simd, formula, inputs, outputs), else run_by_point(formula, inputs, outputs))
}

#[inline(always)]
fn run_on<S: Simd, E: Element, const I: usize, const O: usize, F: Formula<I, O>>(
    simd: S,
    formula: &F,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    formula.specialised(Sweep { simd, inputs, outputs });
}

/// The loop over a formula's slices, its width still open.
struct Sweep<'a, S, E, const I: usize, const O: usize> {
    simd: S,
    inputs: [&'a [E]; I],
    outputs: [&'a mut [E]; O],
}

impl<S: Simd, E: Element, const I: usize, const O: usize> Visit<I, O> for Sweep<'_, S, E, I, O> {
    #[inline(always)]
    fn visit<F: Formula<I, O>>(self, formula: &F) {
        sweep::<E::Lean<S>, I, O, F>(self.simd, formula, self.inputs, self.outputs);
    }

    #[inline(always)]
    fn visit_wide<F: Formula<I, O>>(self, formula: &F) {
        sweep::<E::Wide<S>, I, O, F>(self.simd, formula, self.inputs, self.outputs);
    }
}

#[inline(always)]
fn sweep<L: Lanes, const I: usize, const O: usize, F: Formula<I, O>>(
    simd: L::Token,
    formula: &F,
    inputs: [&[L::Element]; I],
    outputs: [&mut [L::Element]; O],
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

/// The same point by point, in double precision.
#[cold]
#[inline(never)]
fn run_by_point<E: Element, const I: usize, const O: usize>(
    formula: &dyn ByPoint<I, O>,
    inputs: [&[E]; I],
    outputs: [&mut [E]; O],
) {
    for at in 0..inputs[0].len() {
        let mut x = [0.0; I];
        for i in 0..I {
            x[i] = inputs[i][at].to_f64();
        }
        let y = formula.point(x);
        for o in 0..O {
            outputs[o][at] = E::from_f64(y[o]);
        }
    }
}

/// Work on slices by loops that the compiler turns into vectors; `run` must be inlined.
pub trait Task {
    /// Does the work.
    fn run(self);
}

/// Runs a task compiled for the machine's SIMD level.
#[inline]
pub fn dispatched(task: impl Task) {
    on_level!(simd => dispatched_on(simd, task), else plain(task))
}

/// What runs on machines of before 2013: `cold` has it compiled in the least time.
#[cold]
#[inline(never)]
fn plain(task: impl Task) {
    task.run();
}

#[inline(always)]
fn dispatched_on<S: Simd, T: Task>(_simd: S, task: T) {
    task.run();
}

/// Folds `next` into `all`, slices of one length, a multiple of the widest vectors.
#[inline]
pub fn fold<E: Element, const N: usize>(formula: &impl Fold<N>, all: [&mut [E]; N], next: [&[E]; N]) {
    on_level!(simd => fold_on(simd, formula, all, next), else fold_by_point(formula, all, next))
}

#[inline(always)]
fn fold_on<S: Simd, E: Element, const N: usize, F: Fold<N>>(simd: S, formula: &F, all: [&mut [E]; N], next: [&[E]; N]) {
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

#[cold]
#[inline(never)]
fn fold_by_point<E: Element, const N: usize>(formula: &dyn FoldByPoint<N>, all: [&mut [E]; N], next: [&[E]; N]) {
    for at in 0..next[0].len() {
        let (mut x, mut y) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            x[i] = all[i][at].to_f64();
            y[i] = next[i][at].to_f64();
        }
        let joined = formula.join(x, y);
        for i in 0..N {
            all[i][at] = E::from_f64(joined[i]);
        }
    }
}

#[inline]
fn check_within<E: Element>(numbers: &[E], limit: E, all: &mut bool) {
    on_level!(simd => within_on(simd, numbers, limit, all), else *all = are_within(numbers, limit))
}

#[inline(always)]
fn within_on<S: Simd, E: Element>(_simd: S, numbers: &[E], limit: E, all: &mut bool) {
    *all = are_within(numbers, limit);
}

#[inline(always)]
fn are_within<E: Element>(numbers: &[E], limit: E) -> bool {
    let low = limit.negated();
    let mut inside = true;
    for &number in numbers {
        inside &= (number >= low) & (number <= limit);
    }
    inside
}
