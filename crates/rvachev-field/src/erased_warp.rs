//! Deformations behind one pointer, each with its own kernels, as leaves are in `erased`.

use glam::DVec3;

use crate::deform::{Branches, Warp};
use crate::kernel::{Formula, run};
use crate::{AnyWarp, Bounds, Chunk, Dual, Interval, Jet, ParamError, Placement, Real};
use rvachev_num::symbol::Symbol;

struct PreImage<'a, W>(&'a W, &'a Placement);

impl<W: Warp> Formula<3, 3> for PreImage<'_, W> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 3] {
        self.0.inverse(self.1.apply(p))
    }

    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        AnyWarp::point(self.0, self.1.apply(p))
    }
}

struct Jacobian<'a, W>(&'a W, &'a Placement);

impl<W: Warp> Formula<3, 12> for Jacobian<'_, W> {
    #[inline(always)]
    fn run<R: Real>(&self, p: [R; 3]) -> [R; 12] {
        flat(self.0.inverse(self.1.apply(Dual::point(p))))
    }

    fn point(&self, p: [f64; 3]) -> [f64; 12] {
        flat(AnyWarp::duals(self.0, self.1.apply(Dual::point(p))))
    }
}

/// Coordinates, then the rows of their derivatives.
#[inline(always)]
fn flat<R: Real>([x, y, z]: [Dual<R>; 3]) -> [R; 12] {
    [x.v, y.v, z.v, x.d[0], x.d[1], x.d[2], y.d[0], y.d[1], y.d[2], z.d[0], z.d[1], z.d[2]]
}

impl<W: Warp> AnyWarp for W {
    fn name(&self) -> &'static str {
        W::NAME
    }

    #[inline(never)]
    fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.inverse(p)
    }

    #[inline(never)]
    fn duals(&self, p: [Dual<f64>; 3]) -> [Dual<f64>; 3] {
        self.inverse(p)
    }

    #[inline(never)]
    fn dual_ranges(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        self.slopes(p)
    }

    #[inline(never)]
    fn jets(&self, p: [Jet; 3]) -> [Jet; 3] {
        self.inverse(p)
    }

    fn symbols<'a>(&self, p: [Symbol<'a>; 3]) -> [Symbol<'a>; 3] {
        self.inverse(p)
    }

    fn lanes32(&self, chunk: Chunk<'_, f32, 3>) {
        run(&PreImage(self, chunk.placement), chunk.points, chunk.out);
    }

    fn lanes64(&self, chunk: Chunk<'_, f64, 3>) {
        run(&PreImage(self, chunk.placement), chunk.points, chunk.out);
    }

    fn jacobians(&self, chunk: Chunk<'_, f32, 12>) {
        run(&Jacobian(self, chunk.placement), chunk.points, chunk.out);
    }

    fn bounds(&self, bounds: &Bounds) -> Bounds {
        Warp::bounds(self, bounds)
    }

    fn folds(&self) -> bool {
        W::FOLDS
    }

    fn sweeps(&self) -> bool {
        W::SWEEPS
    }

    fn is_continuous(&self) -> bool {
        W::CONTINUOUS
    }

    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
        Warp::support(self, own, direction)
    }

    fn check(&self, bounds: &Bounds) -> Result<(), ParamError> {
        Warp::check(self, bounds)
    }

    fn roundoff_over(&self, hull: [Interval; 3]) -> f64 {
        Warp::roundoff_over(self, hull)
    }

    fn stretch(&self, hull: [Interval; 3]) -> f64 {
        Warp::stretch(self, hull)
    }

    fn branches(&self, hull: [Interval; 3]) -> Option<Branches> {
        Warp::branches(self, hull)
    }

    fn sheets(&self, hull: [Interval; 3]) -> Option<[Box<dyn AnyWarp>; 2]> {
        Warp::sheets(self, hull).map(|sheets| sheets.map(|sheet| Box::new(sheet) as Box<dyn AnyWarp>))
    }
}
