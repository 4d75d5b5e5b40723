//! What a fit of a union found.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::truncated::Truncated;
use super::whole::Whole;
use crate::fit::deviations::Deviation;
use crate::fit::gielis::Curve;
use crate::geom::PointCloud;
use crate::{Cancelled, Gielis, RFunction, Radius, Run, Solid, Supershape};

/// The rule that members are joined by.
const RULE: RFunction = RFunction::P(2.0);

/// A union of truncated supershapes with holes, found in a segmented surface.
#[derive(Clone, Debug)]
pub struct UnionFit {
    pub(super) parts: Vec<UnionPart>,
    pub(super) error: ErrorOfFit,
    pub(super) deviation: Deviation,
    pub(super) parameters: usize,
    pub(super) evaluations: usize,
    pub(super) refinement: usize,
    /// In the frame of the points: of their size about their centre.
    pub(super) whole: Whole,
    pub(super) center: DVec3,
    pub(super) size: f64,
}

/// The global error of fit, equation 15 of the paper: the sum over the points of the square of the
/// R_p union of the members' fields, each times the root of its volume √(a₁a₂a₃). Cubes of length
/// units.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ErrorOfFit {
    /// Of the bodies alone, as each was fitted to its segment.
    pub bodies: f64,
    /// With the holes subtracted.
    pub holes: f64,
    /// After the joint refinement.
    pub refined: f64,
}

/// One part of a union: a body, and holes in it.
#[derive(Clone, Debug)]
pub struct UnionPart {
    /// The label of its segment.
    pub label: u32,
    /// What is added.
    pub body: TruncatedSupershape,
    /// What is taken away from this body.
    pub holes: Vec<TruncatedSupershape>,
    /// The standard deviation from the body of the segment's points that fit, before refinement, in
    /// length units.
    pub noise: f64,
    /// No axis was found that the radii repeat about: m = M = 4.
    pub symmetry_unclear: bool,
}

/// A supershape and the box that it is truncated by, both placed.
#[derive(Clone, Debug)]
pub struct TruncatedSupershape {
    /// The supershape in its own coordinates.
    pub leaf: Supershape,
    /// From its coordinates to the world's: world point = rotation · local point + translation.
    pub rotation: DQuat,
    /// Its centre, in length units.
    pub translation: DVec3,
    /// The lengths of the box's sides.
    pub box_size: DVec3,
    /// From the box's coordinates to the world's.
    pub box_rotation: DQuat,
    /// The centre of the box.
    pub box_center: DVec3,
}

impl TruncatedSupershape {
    pub(super) fn of(member: &Truncated, center: DVec3, size: f64) -> TruncatedSupershape {
        let curve = |Curve { m, n: [n1, n2, n3] }| Gielis::new(f64::from(m), n1, n2, n3);
        let (shape, bounds) = (&member.shape, &member.bounds);
        let turn = |axes: &DMat3| DQuat::from_mat3(axes).normalize();
        let axes = shape.semi_axes * size;
        TruncatedSupershape {
            leaf: Supershape::with(curve(shape.equator), curve(shape.meridian), axes, Radius::Standard),
            rotation: turn(&shape.rotation),
            translation: center + shape.center * size,
            box_size: 2.0 * bounds.half * size,
            box_rotation: turn(&bounds.rotation),
            box_center: center + bounds.center * size,
        }
    }

    /// The supershape without its box.
    #[must_use]
    pub fn whole(&self) -> Solid {
        let place = DAffine3::from_rotation_translation(self.rotation, self.translation);
        Solid::from(self.leaf.clone()).affine(place).named("supershape")
    }

    /// What is in the supershape and in the box, joined by R_p with p = 2.
    #[must_use]
    pub fn solid(&self) -> Solid {
        let place = DAffine3::from_rotation_translation(self.box_rotation, self.box_center);
        self.whole().intersection(Solid::cuboid(self.box_size).affine(place).named("box"), RULE)
    }
}

impl UnionPart {
    /// The body without its holes. The body is called `body 7`, the holes `hole 7.1`, `hole 7.2`
    /// and so on where 7 is the part's label.
    #[must_use]
    pub fn solid(&self) -> Solid {
        let label = self.label;
        let body = self.body.solid().named(format!("body {label}"));
        let hole = |(k, hole): (usize, &TruncatedSupershape)| hole.solid().named(format!("hole {label}.{}", k + 1));
        self.holes.iter().enumerate().map(hole).fold(body, |all, hole| all.difference(hole, RULE))
    }
}

impl UnionFit {
    /// The union of the parts by R_p with p = 2.
    #[must_use]
    pub fn solid(&self) -> Solid {
        let mut parts = self.parts.iter().map(UnionPart::solid);
        match parts.next() {
            Some(first) => parts.fold(first, |all, part| all.union(part, RULE)),
            None => Solid::union_all(Vec::<Solid>::new(), RULE),
        }
    }

    /// The parts, by their labels from the least on.
    #[must_use]
    pub fn parts(&self) -> &[UnionPart] {
        &self.parts
    }

    /// How many holes there are in all parts.
    #[must_use]
    pub fn holes(&self) -> usize {
        self.parts.iter().map(|part| part.holes.len()).sum()
    }

    /// The global error of fit on its way.
    #[must_use]
    pub fn error(&self) -> ErrorOfFit {
        self.error
    }

    /// The global error of fit of other points, such as those of another scan.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if the run is.
    pub fn error_of(&self, cloud: &PointCloud, run: &Run) -> Result<f64, Cancelled> {
        let points: Vec<DVec3> = cloud.positions().iter().map(|p| (*p - self.center) / self.size).collect();
        let run = run.stage(0.0, 1.0);
        let error = run.install(|| self.whole.error(&points, &run))?;
        run.report(1.0);
        Ok(error * self.size.powi(3))
    }

    /// How far the points are from the surface, to first order.
    #[must_use]
    pub fn deviation(&self) -> Deviation {
        self.deviation
    }

    /// How many parameters the solid has: tied ones are counted once; six of each pose, nine of
    /// each box.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// How often the residual of a point was evaluated in the fits of single supershapes.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Steps of the joint refinement that were taken.
    #[must_use]
    pub fn refinement_steps(&self) -> usize {
        self.refinement
    }
}
