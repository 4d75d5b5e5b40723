//! Leaves where they stand, as formulas: by the value, and by the value and its derivatives.

use super::outlined::Outlined;
use super::{Case, Field, Kernel, Placement};
use crate::kernel::{Formula, Visit};
use crate::{Dual, Real};

/// A leaf, or a case of it, where it stands: its value, or that and the three derivatives.
struct Placed<'a, C>(&'a C, &'a Placement);

impl<C: Case> Formula<3, 1> for Placed<'_, C> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 1] {
        [self.1.finish(self.0.value(self.1.apply(p)))]
    }
}

impl<C: Case> Formula<3, 4> for Placed<'_, C> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 4] {
        placed(self.1, self.0.value(Dual::point(self.1.apply(p))))
    }
}

/// A leaf where it stands.
pub(crate) struct Value<'a, F>(pub(crate) &'a F, pub(crate) &'a Placement);

impl<F: Field> Formula<3, 1> for Value<'_, F> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 1] {
        Placed(self.0, self.1).run(p)
    }

    #[inline(always)]
    fn specialised<V: Visit<3, 1>>(&self, visit: V) {
        self.0.specialised(Each { placement: self.1, visit });
    }

    fn point(&self, p: [f64; 3]) -> [f64; 1] {
        [self.1.finish(self.0.at(self.1.apply(p)))]
    }
}

/// Passes a leaf, its cases told apart, on as a formula.
struct Each<'a, V> {
    placement: &'a Placement,
    visit: V,
}

impl<F: Field, V: Visit<3, 1>> Kernel<F> for Each<'_, V> {
    #[inline(always)]
    fn run(self, leaf: &F) {
        Kernel::<F>::run_case(self, leaf);
    }

    #[inline(always)]
    fn run_wide(self, leaf: &F) {
        Kernel::<F>::run_case_wide(self, leaf);
    }

    #[inline(always)]
    fn run_case<C: Case>(self, case: &C) {
        self.visit.visit(&Placed(case, self.placement));
    }

    #[inline(always)]
    fn run_case_wide<C: Case>(self, case: &C) {
        self.visit.visit_wide(&Placed(case, self.placement));
    }
}

/// The same with the derivatives.
pub(crate) struct Gradient<'a, F>(pub(crate) &'a F, pub(crate) &'a Placement);

impl<F: Field> Formula<3, 4> for Gradient<'_, F> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 4] {
        Placed(self.0, self.1).run(p)
    }

    #[inline(always)]
    fn specialised<V: Visit<3, 4>>(&self, visit: V) {
        self.0.specialised(EachGradient { placement: self.1, visit });
    }

    fn point(&self, p: [f64; 3]) -> [f64; 4] {
        placed(self.1, self.0.dual_at(Dual::point(self.1.apply(p))))
    }
}

/// Value and derivatives of the leaf's frame, as they count outside of it.
#[inline(always)]
fn placed<R: Real>(placement: &Placement, Dual { v, d }: Dual<R>) -> [R; 4] {
    let k = placement.scale;
    let [x, y, z] = placement.pull([d[0] * k, d[1] * k, d[2] * k]);
    [placement.finish(v), x, y, z]
}

/// The same for gradients.
struct EachGradient<'a, V> {
    placement: &'a Placement,
    visit: V,
}

impl<F: Field, V: Visit<3, 4>> Kernel<F> for EachGradient<'_, V> {
    #[inline(always)]
    fn run(self, leaf: &F) {
        Kernel::<F>::run_case(self, leaf);
    }

    #[inline(always)]
    fn run_wide(self, leaf: &F) {
        Kernel::<F>::run_case_wide(self, leaf);
    }

    #[inline(always)]
    fn run_case<C: Case>(self, case: &C) {
        self.visit.visit(&Placed(case, self.placement));
    }

    #[inline(always)]
    fn run_case_wide<C: Case>(self, case: &C) {
        self.visit.visit_wide(&Placed(case, self.placement));
    }
}
