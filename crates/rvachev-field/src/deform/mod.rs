//! Maps of space that are not affine, by their exact inverses: one file each.
//!
//! The field of a mapped solid at a point is that of the solid at the pre-image of the point.
//! Taper, twist and bend have no smallest stretch over all of space, so values are not
//! rescaled: near the solid they are lengths up to the local stretch, and no Lipschitz
//! constant is promised. Folds (rows, grids and rings of copies) and elongation move without
//! stretching and keep whatever bound the solid has.

mod bend;
mod bend_between;
mod built_in_law;
mod cells;
mod elongate;
mod law;
mod sectors;
mod taper;
mod taper_by;
mod twist;
mod twist_by;

use std::any::Any;
use std::fmt::Debug;

use glam::{DAffine3, DVec3};

use super::{Chunk, ParamError};
use crate::{Bounds, Dual, Euclid, Interval, Jet, Real};
use rvachev_num::symbol::Symbol;

pub use bend::Bend;
pub use bend_between::BendBetween;
pub use built_in_law::BuiltInLaw;
pub use cells::{Cells, Comb};
pub use elongate::Elongate;
pub use law::{Law, LawTable, LinearLaw, SineWave, SmoothStep};
pub use sectors::Sectors;
pub use taper::Taper;
pub use taper_by::TaperBy;
pub use twist::Twist;
pub use twist_by::TwistBy;

/// A deformation of space: the inverse map, generic over the number.
pub trait Warp: Debug + Clone + Send + Sync + 'static {
    const NAME: &'static str;

    /// Whether it folds space onto one of many copies.
    const FOLDS: bool = false;

    /// Whether it carries a profile along a curve.
    const SWEEPS: bool = false;

    /// Whether it is known that pre-images change as their derivatives say, wherever these are
    /// finite: it tears nothing.
    const CONTINUOUS: bool = false;

    /// The pre-image of a point.
    fn inverse<R: Real>(&self, p: [R; 3]) -> [R; 3];

    /// The image of a point: what [`inverse`](Warp::inverse) is tested against.
    #[cfg(test)]
    fn forward(&self, p: DVec3) -> DVec3;

    /// A box that holds the image of a box.
    fn bounds(&self, bounds: &Bounds) -> Bounds;

    /// The most that the scalar product with a direction, of any length, is over the image of a
    /// set, at least, given the same of the set itself. Infinite where it is not known.
    fn support(&self, _own: &dyn Fn(DVec3) -> f64, _direction: DVec3) -> f64 {
        f64::INFINITY
    }

    /// Whether the parameters are in range for a solid within `bounds`.
    fn check(&self, bounds: &Bounds) -> Result<(), ParamError>;

    /// How far lanes of `f32` may be from the true pre-image at points within `reach`.
    fn roundoff(&self, reach: f64) -> f64;

    /// Ranges of the pre-image of a box and of its derivatives. A map whose terms depend on
    /// one another says it better than its formula on intervals.
    fn slopes(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3] {
        self.inverse(p)
    }

    /// The same for points of a box.
    fn roundoff_over(&self, hull: [Interval; 3]) -> f64 {
        self.roundoff(hull.iter().fold(0.0, |reach, side| reach.max(side.magnitude())))
    }

    /// By how much an error of a coordinate may grow over a box, however small it is.
    fn stretch(&self, hull: [Interval; 3]) -> f64 {
        let row = |side: &Dual<Interval>| side.gradient().iter().map(|slope| slope.magnitude()).sum::<f64>();
        self.dual_ranges(Dual::point(hull)).iter().map(row).fold(0.0, f64::max)
    }

    /// Of a fold, a map that is affine piece by piece: the one or two maps that points of a
    /// box are moved by. `None` where they are more, and of a map that is no fold.
    fn branches(&self, _hull: [Interval; 3]) -> Option<Branches> {
        None
    }

    /// Of a map that jumps within a box, where its slopes have no bound: two that do not, one of
    /// which it is at each point there.
    fn sheets(&self, _hull: [Interval; 3]) -> Option<[Self; 2]> {
        None
    }
}

/// Whether `atan2(opposite, adjacent)` jumps by a whole turn, which its slopes say nothing of.
fn meets_cut(opposite: Interval, adjacent: Interval) -> bool {
    opposite.contains(0.0) && adjacent.lo() <= 0.0
}

/// The affine map of a fold over a region, and a second one if the region lies across an
/// edge.
pub type Branches = (DAffine3, Option<DAffine3>);

/// A `Warp`, erased to the evaluations that the engine runs.
pub trait AnyWarp: Any + Debug + Send + Sync {
    /// What errors call it.
    fn name(&self) -> &'static str;
    /// The pre-image of a point.
    fn point(&self, p: [f64; 3]) -> [f64; 3];
    /// The pre-image with derivatives.
    fn duals(&self, p: [Dual<f64>; 3]) -> [Dual<f64>; 3];
    /// Ranges of the pre-image and of its derivatives.
    fn dual_ranges(&self, p: [Dual<Interval>; 3]) -> [Dual<Interval>; 3];
    /// The same, and of their derivatives.
    fn jets(&self, p: [Jet; 3]) -> [Jet; 3];
    /// The pre-image as expression trees.
    fn symbols<'a>(&self, p: [Symbol<'a>; 3]) -> [Symbol<'a>; 3];
    /// Pre-images of a chunk, on lanes of `f32`.
    fn lanes32(&self, chunk: Chunk<'_, f32, 3>);
    /// The same on lanes of `f64`.
    fn lanes64(&self, chunk: Chunk<'_, f64, 3>);
    /// Pre-images, and their derivatives row by row.
    fn jacobians(&self, chunk: Chunk<'_, f32, 12>);
    /// A box that holds the images of what a box holds.
    fn bounds(&self, bounds: &Bounds) -> Bounds;
    /// Whether it folds space onto one of many copies.
    fn folds(&self) -> bool;
    /// Whether it carries a profile along a curve.
    fn sweeps(&self) -> bool;
    /// Whether it is known that pre-images change as their derivatives say, wherever these are
    /// finite.
    fn is_continuous(&self) -> bool;
    /// How far the image of a set reaches along a direction, given the same of the set.
    fn support(&self, own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64;
    /// Whether the parameters allow to deform what a box holds.
    fn check(&self, bounds: &Bounds) -> Result<(), ParamError>;
    /// How far single precision may move a pre-image, over a hull.
    fn roundoff_over(&self, hull: [Interval; 3]) -> f64;
    /// The most that distances grow by, from images to pre-images, over a hull.
    fn stretch(&self, hull: [Interval; 3]) -> f64;
    /// Where the deformation jumps over a hull, if it does.
    fn branches(&self, hull: [Interval; 3]) -> Option<Branches>;
    /// The deformations on both sides of a jump within a hull.
    fn sheets(&self, hull: [Interval; 3]) -> Option<[Box<dyn AnyWarp>; 2]>;
}

/// A box that holds the parts of `b` that have turned about z by angles in `angle`.
fn turned_box(b: &Bounds, angle: Interval) -> Bounds {
    let (sin, cos) = angle.sin_cos();
    let (x, y) = (Interval::new(b.min.x, b.max.x), Interval::new(b.min.y, b.max.y));
    // The circle of the farthest corner holds every turn of the section.
    let reach = x.norm_as(y, Euclid).hi();
    let disc = Interval::new(-reach, reach);
    let (x, y) = ((x * cos - y * sin).narrowed_by(disc), (x * sin + y * cos).narrowed_by(disc));
    Bounds::new(DVec3::new(x.lo(), y.lo(), b.min.z), DVec3::new(x.hi(), y.hi(), b.max.z))
}

/// How far a set reaches along a direction, turned about z by any angles, part by part.
///
/// ```text
///     |(x, y)| cos(π/n) ≤ (x, y)·u       u the nearest of n unit vectors all round
/// ```
fn turned_support(own: &dyn Fn(DVec3) -> f64, direction: DVec3) -> f64 {
    const COUNT: u32 = 64;
    let step = std::f64::consts::TAU / f64::from(COUNT);
    let across = direction.truncate().length() / (0.5 * step).cos();
    if across == 0.0 {
        return own(direction);
    }
    let along = |n: u32| own((across * glam::DVec2::from_angle(step * f64::from(n))).extend(direction.z));
    (0..COUNT).map(along).fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rvachev_num::rad;

    fn round_trip(warp: &impl Warp, p: DVec3) -> f64 {
        let back = warp.inverse(warp.forward(p).to_array());
        (DVec3::from_array(back) - p).length()
    }

    #[test]
    fn bends_agree_with_the_reference_and_invert() {
        let p = DVec3::new(0.3, -0.2, 1.5);
        for (curvature, image) in [
            (0.6, DVec3::new(0.696758009844, 0.270287132591, 1.273755738266)),
            (-0.6, DVec3::new(-0.116561782390, -0.693761036518, 1.337333960492)),
        ] {
            let bend = Bend { curvature, angle: rad(0.87) };
            assert!((bend.forward(p) - image).length() < 1e-11);
            assert!(round_trip(&bend, p) < 1e-14);
        }
        let far = Bend { curvature: 0.6, angle: rad(0.87) };
        let image = far.forward(DVec3::new(0.3, -0.2, 4.0));
        assert!((image - DVec3::new(2.121731058144, 1.959343112000, 1.098360201393)).length() < 1e-11);
        assert!(round_trip(&far, DVec3::new(0.3, -0.2, 4.0)) < 1e-13);
    }

    #[test]
    fn bends_of_any_curvature_invert() {
        for curvature in [0.6, -0.6, 1e-3, 1e-9, -1e-12, 0.0] {
            let bend = Bend { curvature, angle: rad(0.3) };
            for i in 0..1000 {
                let t = |k: f64| ((f64::from(i) * k).fract() - 0.5) * 2.0;
                let p = DVec3::new(0.5 * t(0.618), 0.7 * t(0.414), 2.0 * t(0.732));
                assert!(round_trip(&bend, p) < 1e-14, "{curvature} {p}");
            }
        }
    }

    #[test]
    fn bends_between_heights_invert_on_the_arc_and_beyond() {
        for turn in [1.5, -1.5, 3.0, 5.0, 1e-3, -1e-9, 1e-12, 0.0] {
            let bend = BendBetween { from: -1.0, to: 3.0, turn: rad(turn), angle: rad(0.3) };
            let ends = if turn > 3.0 { 0.2 } else { 3.0 };
            for i in 0..1000 {
                let t = |k: f64| (f64::from(i) * k).fract() - 0.5;
                let p = DVec3::new(0.7 * t(0.618), 0.5 * t(0.414), 1.0 + (4.0 + 2.0 * ends) * t(0.732));
                assert!(round_trip(&bend, p) < 3e-14, "{turn} {p}");
                if p.z <= bend.from {
                    assert!((bend.forward(p) - p).length() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn ranges_of_bends_between_heights_hold_every_pre_image_and_slope() {
        let bend = BendBetween { from: -1.0, to: 3.0, turn: rad(2.4), angle: rad(0.3) };
        let mut narrower = 0;
        for i in 0..4000 {
            let t = |k: f64| (f64::from(i) * k).fract() - 0.5;
            let centre = bend.forward(DVec3::new(t(0.618), t(0.414), 1.0 + 8.0 * t(0.732)));
            let half = 0.2 * (t(0.2718) + 0.5).powi(2);
            let hull = [0, 1, 2].map(|axis| Interval::around(centre[axis], half));
            let image = AnyWarp::dual_ranges(&bend, Dual::point(hull));
            let plain = bend.inverse(Dual::point(hull));
            narrower += usize::from(image[2].value().width() < 0.8 * plain[2].value().width());
            for j in 0..10 {
                let u = |k: f64| 2.0 * (f64::from(j + 1) * k).fract() - 1.0;
                let p = centre + half * DVec3::new(u(0.618), u(0.414), u(0.732));
                let q = bend.duals(Dual::point(p.to_array()));
                for (image, q) in image.iter().zip(q) {
                    assert!(image.value().contains(q.value()), "{p}");
                    let slopes = image.gradient().into_iter().zip(q.gradient());
                    assert!(slopes.clone().all(|(all, one)| all.lo() - 1e-12 <= one && one <= all.hi() + 1e-12), "{p}");
                }
            }
        }
        assert!(narrower > 400, "{narrower}");
    }

    #[test]
    fn a_chain_agrees_with_the_reference() {
        let p = DVec3::new(0.4, 0.5, 1.2);
        let taper = Taper { kx: 0.5, ky: -0.4, height: 4.0 };
        let (twist, bend) = (Twist { rate: rad(0.6) }, Bend { curvature: 0.3, angle: rad(0.5) });
        let image = bend.forward(twist.forward(taper.forward(p)));
        assert!((image - DVec3::new(0.304009419006, 0.717961296813, 1.024693146673)).length() < 1e-11);
        assert!(round_trip(&taper, p) < 1e-15 && round_trip(&twist, p) < 1e-15);
    }

    #[test]
    fn folds_are_the_affine_maps_that_they_say() {
        let comb = Comb { offset: 0.7, pitch: 1.4, last: 3.0, centre: 0.05 };
        let cells =
            Cells { axes: [comb, Comb::ONE, comb], counts: [8, 1, 8], spacing: DVec3::splat(0.7), crowded: None };
        let folds: [&dyn AnyWarp; 3] = [
            &cells,
            &Sectors { count: 8, blocks: 4, class: 1, middle: 0.3 },
            &Sectors { count: 11, blocks: 3, class: 2, middle: -2.0 },
        ];
        let mut told = [0; 3];
        for (number, fold) in folds.into_iter().enumerate() {
            for i in 0..3000 {
                let t = |k: f64| (f64::from(i) * k).fract();
                let centre = 12.0 * DVec3::new(t(0.618), t(0.414), t(0.732)) - 4.0;
                let half = 0.3 * t(0.2718).powi(2) * DVec3::new(1.0, t(0.1414), t(0.577));
                let hull = [0, 1, 2].map(|axis| Interval::around(centre[axis], half[axis]));
                let branches = fold.branches(hull);
                let image = fold.dual_ranges(Dual::point(hull));
                for j in 0..20 {
                    let u = |k: f64| 2.0 * (f64::from(j + 1) * k).fract() - 1.0;
                    let p = centre + half * DVec3::new(u(0.618), u(0.414), u(0.732));
                    let q = DVec3::from_array(fold.point(p.to_array()));
                    for axis in 0..3 {
                        let side = image[axis].value();
                        assert!(side.contains(q[axis]), "{fold:?} at {p}: {q}, {side:?}");
                    }
                    let Some((first, second)) = branches else { continue };
                    told[number] += usize::from(second.is_some());
                    let by = |map: DAffine3| (map.transform_point3(p) - q).length() < 1e-13;
                    assert!(by(first) || second.is_some_and(by), "{fold:?} at {p}: {q}");
                }
            }
        }
        assert!(told.into_iter().all(|count| count > 100), "{told:?}");
    }

    #[test]
    fn boxes_hold_images() {
        let bounds = Bounds::new(DVec3::new(-0.5, -0.7, -2.0), DVec3::new(0.6, 0.4, 1.5));
        let comb = Comb { offset: 0.7, pitch: 1.4, last: 3.0, centre: 0.05 };
        let cells =
            Cells { axes: [comb, Comb::ONE, comb], counts: [8, 1, 8], spacing: DVec3::splat(0.7), crowded: None };
        let wave = SineWave { mean: 1.0, amplitude: 0.6, wavelength: 2.0, phase: rad(0.3) };
        let warps: [(&str, &dyn AnyWarp); 12] = [
            ("elongate", &Elongate { lengths: DVec3::new(0.3, 0.0, 1.0) }),
            ("repeat", &cells),
            ("repeat_polar", &Sectors { count: 8, blocks: 4, class: 1, middle: 0.3 }),
            ("repeat_polar, uneven", &Sectors { count: 11, blocks: 3, class: 2, middle: -2.0 }),
            ("taper_by", &TaperBy { x: wave, y: 0.5 }),
            ("twist_by", &TwistBy { angle: rad(1.0), law: wave }),
            ("taper", &Taper { kx: 0.5, ky: -0.4, height: 4.0 }),
            ("twist", &Twist { rate: rad(1.3) }),
            ("bend", &Bend { curvature: -0.6, angle: rad(0.4) }),
            ("bend_between", &BendBetween { from: -0.5, to: 0.8, turn: rad(0.7), angle: rad(0.4) }),
            ("bend_between, a U", &BendBetween { from: -1.0, to: 1.4, turn: rad(-2.6), angle: rad(2.0) }),
            ("bend_between, a hook", &BendBetween { from: -2.0, to: 1.5, turn: rad(4.0), angle: rad(0.0) }),
        ];
        for (name, warp) in warps {
            let image = warp.bounds(&bounds);
            for i in 0..4000 {
                let t = |k: f64| (f64::from(i) * k).fract();
                // Outside of the image box no point may have its pre-image in the box.
                let p = image.center() + image.size() * (DVec3::new(t(0.618), t(0.414), t(0.732)) - 0.5) * 1.5;
                let back = DVec3::from_array(warp.point(p.to_array()));
                assert!(image.contains(p) || !bounds.contains(back), "{name} {p}");
            }
        }
    }
}
