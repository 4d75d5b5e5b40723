//! The trait of leaves.

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::erased::reach;
use super::outlined::Outlined;
use super::{Along, AnyField, ParamError, Segment};
use crate::{Bounds, Dual, Interval, Jet, Real};
use rvachev_num::{Cancelled, Run};

/// A leaf: a formula that is positive inside a shape, zero on its surface and negative
/// outside.
///
/// The formula is written once over [`Real`]; the engine runs it on points, ranges,
/// gradients, SIMD lanes and expression trees. A user's own leaf prunes and runs like the
/// built-in ones. What a leaf promises:
///
/// * its value is in length units, and finite for coordinates up to
///   [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT);
/// * it is not positive outside [`bounds`](Field::bounds);
/// * if it is [`convex`](Field::convex), the value is a concave function that changes by at
///   most 1 per length unit;
/// * its `Debug` text says everything that its value depends on, numbers to the last digit, as a
///   derived `Debug` does: leaves of one type with the same text are taken to be the same leaf when
///   solids are compared, hashed and [simplified](../struct.Solid.html#method.simplified), and
///   where lengths are measured, once for all solids that are equal. A leaf that holds what has no
///   such text (a function, a table that is cut short) writes something into it that no other leaf
///   of its type has, such as a serial number.
///
/// Mark `eval` and every helper in it `#[inline(always)]`, or lanes run 18 times slower.
///
/// ```
/// use rvachev::field::{Field, Real};
/// use rvachev::{Bounds, ParamError, Solid};
/// use glam::DVec3;
///
/// /// A heart-shaped section, two units thick.
/// #[derive(Debug)]
/// struct Heart;
///
/// impl Field for Heart {
///     fn name(&self) -> &'static str {
///         "heart"
///     }
///     #[inline(always)]
///     fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
///         let lift = y - x.abs().pow(0.5) * 0.8;
///         (-(x.square() + lift.square()).sqrt() + 1.0).min(-z.abs() + 1.0)
///     }
///     fn bounds(&self) -> Bounds {
///         Bounds::new(DVec3::new(-1.0, -1.0, -1.0), DVec3::new(1.0, 1.8, 1.0))
///     }
///     fn check(&self) -> Result<(), ParamError> {
///         Ok(())
///     }
/// }
///
/// let heart = Solid::new(Heart);
/// assert!(heart.contains(DVec3::ZERO)?);
/// # Ok::<(), rvachev::SolidError>(())
/// ```
pub trait Field: Debug + Send + Sync + 'static {
    /// What errors and [`owner`](../struct.Solid.html#method.owner) call this leaf.
    fn name(&self) -> &'static str;

    /// Works out what takes long, and keeps it with the leaf: called once when a solid is compiled,
    /// before all else. What takes more than a tenth of a second asks `run` now and then whether to
    /// go on, and tells it how far it has come. Whoever asks the leaf itself may do so without.
    /// Default: there is nothing to work out.
    ///
    /// # Errors
    /// [`Cancelled`] if `run` was.
    fn prepare(&self, _run: &Run) -> Result<(), Cancelled> {
        Ok(())
    }

    /// The formula at a point of the leaf's own frame.
    fn eval<R: Real>(&self, p: [R; 3]) -> R;

    /// A box that holds the shape; infinite along the axes where the shape is unbounded.
    fn bounds(&self) -> Bounds;

    /// Whether every parameter is in its range.
    ///
    /// # Errors
    /// The first parameter that is not.
    fn check(&self) -> Result<(), ParamError>;

    /// Whether the value is a concave function with slope at most 1. Ranges over small
    /// regions are then nearly exact. Default: `false`.
    fn convex(&self) -> bool {
        false
    }

    /// The most that the value changes by per length unit, anywhere; infinite where nothing is
    /// known. Default: 1 of leaves that are [`convex`](Field::convex) or [`exact`](Field::exact).
    fn steepest(&self) -> f64 {
        if self.convex() || self.exact() { 1.0 } else { f64::INFINITY }
    }

    /// Whether the value is the true signed distance to the surface, everywhere. Offsets and
    /// shells take it as it is; from other leaves they find their way to the surface along
    /// the gradient. Default: `false`.
    fn exact(&self) -> bool {
        false
    }

    /// The points that are at least `depth` inside (the erosion by a ball of that radius), as a
    /// leaf that is [`exact`](Field::exact) as this one is: what is left of a box is a smaller box.
    /// Asked of exact leaves, for depths above 0. Where it is known, roundings are closed forms,
    /// and need no measuring. Default: `None`, where it is no leaf of this kind, or nothing is
    /// left.
    fn eroded(&self, _depth: f64) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// No radius of curvature of the surface is less than this, in length units. Default: 0, of a
    /// surface that has creases, or of which nothing is known.
    fn least_radius(&self) -> f64 {
        0.0
    }

    /// How far along each axis of its own frame the leaf repeats, in length units: the value at p
    /// is that at p + (x, 0, 0), at p + (0, y, 0) and at p + (0, 0, z). Lengths measured of the
    /// leaf are then measured for one cell, wherever they are asked about. Default: `None`, of a
    /// leaf that does not repeat, or of which nothing is known.
    fn period(&self) -> Option<DVec3> {
        None
    }

    /// The radius r of a leaf whose value is `r·(1 − G)` with a gauge G, homogeneous of degree 1
    /// about the leaf's origin: what [`Blend::Ricci`](crate::Blend::Ricci) asks of its
    /// operands. Default: `None`.
    fn gauge_radius(&self) -> Option<f64> {
        None
    }

    /// The range of the formula over a box of the leaf's own frame. The default runs the
    /// formula on intervals; a leaf whose structure gives a tighter one overrides it.
    fn range(&self, region: [Interval; 3]) -> Interval {
        self.over(region)
    }

    /// Ranges of the formula's three derivatives over a box of the leaf's own frame. They make
    /// the value's range over boxes that stand at an angle to that frame, and over segments.
    /// The default runs the formula on dual numbers of intervals. What overrides it overrides
    /// [`dual_range`](Field::dual_range) as well.
    fn slopes(&self, region: [Interval; 3]) -> [Interval; 3] {
        self.dual_over(Dual::point(region)).gradient()
    }

    /// Ranges of the value and of its derivatives over a box of the leaf's own frame, whose
    /// sides have derivatives of their own: those of a deformation before it, or those along a
    /// ray. The default runs the formula on these numbers; a leaf that knows its
    /// [slopes](Field::slopes) better than its formula does puts them together by
    /// [`chained`](crate::chained).
    fn dual_range(&self, p: [Dual<Interval>; 3]) -> Dual<Interval> {
        self.dual_over(p)
    }

    /// Ranges, with their derivatives, of numbers of which the least has the sign of the value,
    /// over such a box: how far inside each of its sides a box is, say. Where operands meet in a
    /// face, they tell it where the value itself is near an edge. The default is the value alone.
    fn faces(&self, p: [Dual<Interval>; 3]) -> Vec<Dual<Interval>> {
        vec![self.dual_range(p)]
    }

    /// Leaves without edges of their own whose intersection has the inside of this one, as a box is
    /// one of three slabs: chamfers go from each of them to whatever it meets, and end where another
    /// one does. There are none by default: where normals turn about an edge, so does the chamfer.
    fn walls(&self) -> Vec<Arc<dyn AnyField>> {
        Vec::new()
    }

    /// Ranges of the value, of its derivatives and of theirs, over a box whose sides are given with
    /// derivatives of their own: how much normals turn in it, which chamfers between leaves ask.
    /// The default runs the formula on these numbers.
    fn jet(&self, p: [Jet; 3]) -> Jet {
        self.jet_over(p)
    }

    /// Normals of the planes through the origin of the leaf's frame at which slopes are without
    /// bound: rays are cut there, and between the cuts slopes tell something. There are none by
    /// default; what is left out costs time, nothing else.
    fn creases(&self) -> Vec<DVec3> {
        Vec::new()
    }

    /// What is known of the value along a segment: no value of it is beyond the range, no slope on
    /// the way beyond the range of slopes. The default asks the box about it; a leaf that knows
    /// more, as which polar angles a segment has, tells rays where they need not look.
    fn along(&self, segment: &Segment) -> Along {
        Along::of(self.dual_range(segment.sides()))
    }

    /// The derivatives of [`dual_range`](Field::dual_range) in the part of a box that lies beside
    /// the planes of [`creases`](Field::creases), on the side of each of them that the point
    /// `beside` is on. The default cuts the box at those planes that stand across an axis.
    fn slopes_beside(&self, p: [Dual<Interval>; 3], beside: DVec3) -> [Interval; 3] {
        let mut p = p;
        for normal in self.creases() {
            for axis in 0..3 {
                if normal[axis].abs() == normal.length() {
                    p[axis].v = half(p[axis].v, beside[axis]);
                }
            }
        }
        self.dual_range(p).d
    }

    /// Support function of the shape's convex hull: the largest `direction · p` over its
    /// points p. Boxes of rotated leaves are as tight as it is. The default is that of
    /// [`bounds`](Field::bounds).
    fn support(&self, direction: DVec3) -> f64 {
        let bounds = self.bounds();
        let mut sum = 0.0;
        for axis in 0..3 {
            let d = direction[axis];
            if d != 0.0 {
                sum += (d * bounds.min[axis]).max(d * bounds.max[axis]);
            }
        }
        sum
    }

    /// The box of the shape after `map`.
    fn bounds_under(&self, map: &DAffine3) -> Bounds {
        bounds_by_support(&|direction| self.support(direction), map)
    }

    /// Calls `kernel` with this leaf, its parameters' special cases told apart: an override
    /// matches on the parameters and calls with a copy whose cases are literal, so that each
    /// gets a loop of its own without branches. The default calls with the leaf as it is.
    #[inline(always)]
    fn specialised<K: Kernel<Self>>(&self, kernel: K)
    where
        Self: Sized,
    {
        kernel.run(self);
    }

    /// How far the single-precision value may be from the true one at points within
    /// `reach` of the leaf's origin and near the surface, in length units. The default,
    /// `4·10⁻⁶ · reach`, holds for formulas of a dozen operations whose slope is about 1.
    fn roundoff(&self, reach: f64) -> f64 {
        4e-6 * reach
    }

    /// The same in a region of the leaf's frame. The default is that within its reach; a leaf
    /// whose slopes are unbounded in a few places only says how little it is elsewhere.
    fn roundoff_over(&self, region: [Interval; 3]) -> f64 {
        self.roundoff(reach(region))
    }
}

/// Work to do with a leaf (see [`Field::specialised`]).
pub trait Kernel<F> {
    /// Does the work, one vector at a time.
    fn run(self, leaf: &F);

    /// Does the work several vectors at a time: faster where the formula is one long chain of
    /// operations, and four times slower to compile.
    fn run_wide(self, leaf: &F);

    /// Does the work with a case of the leaf whose kind is a type.
    #[doc(hidden)]
    fn run_case<C: Case>(self, case: &C);

    /// The same, several vectors at a time.
    #[doc(hidden)]
    fn run_case_wide<C: Case>(self, case: &C);
}

/// A leaf's formula, or one case of it. Where cases are types, a kernel is compiled with the code
/// of one of them.
#[doc(hidden)]
pub trait Case {
    /// The formula.
    fn value<R: Real>(&self, p: [R; 3]) -> R;
}

impl<F: Field> Case for F {
    #[inline(always)]
    fn value<R: Real>(&self, p: [R; 3]) -> R {
        self.eval(p)
    }
}

/// The box of a shape after `map`, by its support function.
pub(super) fn bounds_by_support(support: &dyn Fn(DVec3) -> f64, map: &DAffine3) -> Bounds {
    let rows = map.matrix3.transpose();
    let mut bounds = Bounds::new(map.translation, map.translation);
    for axis in 0..3 {
        let row = rows.col(axis);
        bounds.max[axis] += support(row);
        bounds.min[axis] -= support(-row);
    }
    bounds
}

/// The part of a range that has the sign of `side`, without 0 itself.
pub(super) fn half(range: Interval, side: f64) -> Interval {
    let least = f64::MIN_POSITIVE;
    if side > 0.0 {
        Interval::new(range.lo().max(least), range.hi().max(least))
    } else {
        Interval::new(range.lo().min(-least), range.hi().min(-least))
    }
}

/// Range of a formula that falls as any of `|x|`, `|y|`, `|z|` rises: two evaluations, exact
/// but for rounding.
#[inline(always)]
pub(super) fn falling_range(leaf: &impl Field, region: [Interval; 3]) -> Interval {
    let [x, y, z] = region.map(Real::abs);
    let near = leaf.eval([x.lo(), y.lo(), z.lo()]);
    let far = leaf.eval([x.hi(), y.hi(), z.hi()]);
    // Slope at most about 1: rounding is relative to the coordinates.
    let size = |x: f64, y: f64, z: f64, v: f64| 1e-14 * (x + y + z + v.abs());
    let lo = far - size(x.hi(), y.hi(), z.hi(), far);
    let hi = near + size(x.lo(), y.lo(), z.lo(), near);
    if lo <= hi { Interval::new(lo, hi) } else { Interval::ALL }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cuboid, Cylinder, Prism, Pyramid, Wedge};

    #[test]
    fn walls_have_the_inside_of_their_leaf_and_no_walls_themselves() {
        let leaves: [Arc<dyn AnyField>; 6] = [
            Arc::new(Cuboid { size: DVec3::new(3.0, 2.0, 1.0) }),
            Arc::new(Cylinder { radius: 1.0, height: 1.5 }),
            Arc::new(Prism::new(5, 1.2, 1.4)),
            Arc::new(Pyramid::new(3, 1.3, 2.0)),
            Arc::new(Pyramid::new(6, 1.3, 2.0)),
            Arc::new(Wedge { size: DVec3::new(2.5, 1.5, 2.0) }),
        ];
        let place = |n: u32, prime: u32| 4.0 * (f64::from(n.wrapping_mul(prime) % 1000) / 1000.0 - 0.5);
        for leaf in leaves {
            let walls = leaf.walls();
            assert!(walls.len() > 1 && walls.iter().all(|wall| wall.walls().is_empty()), "{leaf:?}");
            let mut inside = 0;
            for n in 0..2000 {
                let p = [place(n, 7919), place(n, 104_729), place(n, 1_299_709)];
                let least = walls.iter().map(|wall| wall.value(p)).fold(f64::INFINITY, f64::min);
                assert!((least >= 0.0) == (leaf.value(p) >= 0.0) || least.abs() < 1e-9, "{leaf:?}: {least} at {p:?}");
                inside += u32::from(least > 0.0);
            }
            assert!(inside > 40, "{leaf:?}: {inside}");
        }
    }
}
