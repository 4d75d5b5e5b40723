//! A hypothesis becomes a region: adjusted to what it explains, its axis settled, and judged.

use glam::{DMat3, DVec3};

use super::adjust::{adjusted, moments};
use super::columns::{Columns, Shape, Tolerance};
use super::corners::Corner;
use super::coverage::Coverage;
use super::directions::{Directions, about};
use super::limits::Limits;
use super::regions::{Form, Region};
use super::samples::{Kind, Samples};
use crate::fit::linear::{eigen, median, quantile};

/// Steps of an adjustment.
const STEPS: usize = 3;

/// The fewest samples of a curved region, and the fewest corners that one is adjusted to.
const FEWEST: usize = 10;
const CORNERS: usize = 6;

/// The least arc in degrees, and the least share of it that samples are on; of few samples so much
/// of what as many leave full that are strewn over it.
const ARC: f64 = 50.0;
const FILL: f64 = 0.62;
const STREWN: f64 = 0.8;

/// The largest share of a cylinder within 10° of normals, of whole ones and of short arcs: more is
/// a flat.
const FLATTEST: [f64; 2] = [0.34, 0.45];
const SHORT: f64 = 120.0;

/// The least eigenvalue of the mean of n·nᵀ on a sphere: on a cylinder it is 0.
const ROUND: f64 = 0.06;

/// The largest root mean square of angles, in degrees, where a mesh has no corners that are of a
/// curved surface.
const BARE: f64 = 5.0;

/// The least arc of a torus' tube, in degrees.
const TUBE: f64 = 35.0;

/// Normals that tell an axis vary by this at least; an axis turns by so much at most (a sine).
const VARYING: f64 = 0.05;
const TURN: f64 = 0.06;

/// Passes of the adjustment to corners: each keeps those within so many median deviations, and the
/// least of them.
const PASSES: usize = 4;
const WIDTH: f64 = 6.0;
const GRAIN: f64 = 1e-5;

/// What is of regions that were found.
pub(super) struct Taken {
    pub(super) samples: Vec<bool>,
    pub(super) corners: Vec<bool>,
}

impl Taken {
    pub(super) fn none(samples: &Samples) -> Taken {
        Taken { samples: vec![false; samples.len()], corners: vec![false; samples.corners.len()] }
    }

    /// Adds what is of a region.
    pub(super) fn add(&mut self, settled: &Settled, samples: &Samples, limits: &Limits) {
        for &i in &settled.points {
            self.samples[i as usize] = true;
        }
        for (taken, corner) in self.corners.iter_mut().zip(&samples.corners) {
            *taken = *taken || settled.holds(corner, limits);
        }
    }
}

/// A region in the frame that its shape is in.
pub(super) struct Settled {
    frame: DMat3,
    /// What the surface was made from; samples of facets are within it.
    shape: Shape,
    pub(super) points: Vec<u32>,
    pub(super) share: f64,
    along: [f64; 2],
    arc: f64,
    chordal: f64,
}

/// The region that a hypothesis stands for, if it is one.
pub(super) fn settle(
    shape: &Shape,
    tolerance: Tolerance,
    columns: &Columns,
    samples: &Samples,
    taken: &Taken,
    limits: &Limits,
    directions: &Directions,
) -> Option<Settled> {
    let mut buffer = Vec::new();
    let mut shape = *shape;
    // What facets need beside noise.
    let sagitta = (tolerance.distance - limits.coarse(&shape).distance).max(0.0);
    let wider = |t: Tolerance| Tolerance { distance: t.distance + sagitta, ..t };
    let weighted = |frame: &DMat3, points: &[u32]| -> Vec<(DVec3, f64)> {
        let to = frame.transpose();
        points.iter().map(|i| (to * samples.points[*i as usize], samples.weights[*i as usize])).collect()
    };
    let mut points = columns.explained(&shape, tolerance, &mut buffer);
    for _ in 0..2 {
        shape = adjusted(&shape, &weighted(&columns.frame, &points), STEPS)?;
        points = columns.explained(&shape, wider(limits.coarse(&shape)), &mut buffer);
    }
    if let Shape::Cone { centre, radius, slope, sign } = shape
        && slope != 0.0
        && slope.abs() < limits.least_slope()
    {
        let heights = points.iter().map(|i| columns.frame.z_axis.dot(samples.points[*i as usize])).sum::<f64>();
        let middle = heights / points.len().max(1) as f64;
        shape = Shape::Cone { centre, radius: radius + slope * middle, slope: 0.0, sign };
        shape = adjusted(&shape, &weighted(&columns.frame, &points), STEPS)?;
    }
    let mut frame = columns.frame;
    let mut turned: Option<Columns> = None;
    match &mut shape {
        Shape::Plane { normal, offset } => {
            let middle: DVec3 = points.iter().map(|i| samples.points[*i as usize] * samples.weights[*i as usize]).sum();
            let sum: f64 = points.iter().map(|i| samples.weights[*i as usize]).sum();
            let (values, _) = eigen(moments(points.iter().map(|i| {
                let i = *i as usize;
                (samples.points[i] - middle / sum.max(f64::MIN_POSITIVE), samples.weights[i])
            })));
            *normal = directions.settled(*normal, open(values));
            let off = points.iter().map(|i| normal.dot(samples.points[*i as usize]) * samples.weights[*i as usize]);
            *offset = off.sum::<f64>() / sum.max(f64::MIN_POSITIVE);
        }
        Shape::Cone { centre, radius, slope, .. } => {
            let (axis, open) = polished(samples, &points, frame.z_axis, *slope != 0.0);
            let axis = directions.settled(axis, open);
            if axis.cross(frame.z_axis).length() > 1e-7 {
                let heights = points.iter().map(|i| frame.z_axis.dot(samples.points[*i as usize])).sum::<f64>();
                let middle = heights / points.len().max(1) as f64;
                let on = frame * DVec3::new(centre[0], centre[1], middle);
                let at = *radius + *slope * middle;
                frame = about(axis);
                let local = frame.transpose() * on;
                *centre = [local.x, local.y];
                *radius = at - *slope * local.z;
                let rest = (0..samples.len() as u32).filter(|i| !taken.samples[*i as usize]).collect();
                turned = Some(Columns::new(samples, frame, rest));
            }
        }
        Shape::Sphere { .. } | Shape::Torus { .. } => {}
    }
    let columns = turned.as_ref().unwrap_or(columns);
    if let Shape::Cone { .. } = shape {
        points = columns.explained(&shape, wider(limits.coarse(&shape)), &mut buffer);
        shape = adjusted(&shape, &weighted(&frame, &points), STEPS)?;
    }
    points = columns.explained(&shape, wider(limits.fine(&shape)), &mut buffer);
    let share: f64 = points.iter().map(|i| samples.weights[*i as usize]).sum();
    if share < limits.share {
        return None;
    }
    let mut settled = Settled { frame, shape, points, share, along: [0.0; 2], arc: 0.0, chordal: 1.0 };
    settled.judge(samples, taken, limits).then_some(settled)
}

/// How far a direction may be off, as a sine, along which points of a plane, or normals of a
/// cylinder, vary least: three deviations of them, over how they vary across.
fn open(values: [f64; 3]) -> f64 {
    3.0 * (values[0].max(0.0) / values[1].max(f64::MIN_POSITIVE)).sqrt()
}

/// The axis that normals of a cylinder are across, or of a cone as far from as each other, and how
/// far it may be off, as a sine.
fn polished(samples: &Samples, points: &[u32], axis: DVec3, is_cone: bool) -> (DVec3, f64) {
    let weight = |i: &u32| samples.weights[*i as usize];
    let sum: f64 = points.iter().map(weight).sum();
    let mean: DVec3 = points.iter().map(|i| samples.normals[*i as usize] * weight(i)).sum::<DVec3>() / sum;
    let about = if is_cone { mean } else { DVec3::ZERO };
    let (values, axes) = eigen(moments(points.iter().map(|i| (samples.normals[*i as usize] - about, weight(i)))));
    let found = axes.x_axis * axes.x_axis.dot(axis).signum();
    let is_told = values[1] > VARYING * sum && found.cross(axis).length() < TURN;
    if is_told { (found, open(values)) } else { (axis, f64::INFINITY) }
}

impl Settled {
    /// What it lies along or faces.
    pub(super) fn direction(&self) -> Option<DVec3> {
        match self.shape {
            Shape::Plane { normal, .. } => Some(normal),
            Shape::Sphere { .. } => None,
            Shape::Cone { .. } | Shape::Torus { .. } => Some(self.frame.z_axis),
        }
    }

    /// Whether a corner of a mesh is of it.
    fn holds(&self, corner: &Corner, limits: &Limits) -> bool {
        let to = self.frame.transpose();
        self.shape.margin(to * corner.point, to * corner.normal, limits.fine(&self.shape)) >= 0.0
    }

    /// Whether it is a region; measures it, and adjusts it to the corners there.
    fn judge(&mut self, samples: &Samples, taken: &Taken, limits: &Limits) -> bool {
        let to = self.frame.transpose();
        let local = |i: &u32| (to * samples.points[*i as usize], to * samples.normals[*i as usize]);
        let weight = |i: &u32| samples.weights[*i as usize];
        if let Shape::Plane { normal, .. } = self.shape {
            return self.is_flat(normal, samples, limits);
        }
        if self.points.len() < FEWEST {
            return false;
        }
        let corners = self.held(samples, taken, limits);
        if !self.is_true(samples, corners.len() < CORNERS, limits) {
            return false;
        }
        let before = self.shape;
        let corners = self.adjust_to_corners(corners);
        self.chordal = before.smaller(&self.shape);
        match self.shape {
            Shape::Plane { .. } => false,
            Shape::Sphere { .. } => {
                let normals = self.points.iter().map(|i| (samples.normals[*i as usize], weight(i)));
                self.share >= limits.round_share && eigen(moments(normals)).0[0] >= ROUND * self.share
            }
            Shape::Cone { centre, slope, .. } => {
                let angle = |p: DVec3| (p.y - centre[1]).atan2(p.x - centre[0]);
                let of_samples = self.points.iter().map(|i| (angle(local(i).0), weight(i)));
                let of_corners = corners.iter().map(|c| (angle(to * c.point), f64::MIN_POSITIVE));
                let places = Coverage::of(of_samples.chain(of_corners));
                let normals = Coverage::of(self.points.iter().map(|i| {
                    let n = local(i).1;
                    (n.y.atan2(n.x), weight(i))
                }));
                self.arc = places.arc();
                self.along = self.extent(samples, &corners, self.frame.z_axis);
                let flattest = FLATTEST[usize::from(self.arc < SHORT)];
                // So few points may leave bins empty.
                let least = FILL.min(STREWN * places.expected(self.points.len()));
                let large = slope == 0.0 || self.share >= limits.cone_share;
                large && self.arc >= ARC && places.fill() >= least && normals.largest() <= flattest
            }
            Shape::Torus { centre, major, .. } => {
                let out = |p: DVec3| (p - centre).truncate();
                let round = Coverage::of(self.points.iter().map(|i| {
                    let p = out(local(i).0);
                    (p.y.atan2(p.x), weight(i))
                }));
                let tube = Coverage::of(self.points.iter().map(|i| {
                    let p = local(i).0;
                    ((p.z - centre.z).atan2(out(p).length() - major), weight(i))
                }));
                self.arc = round.arc();
                self.share >= limits.round_share && self.arc >= ARC && tube.arc() >= TUBE && round.fill() >= FILL
            }
        }
    }

    /// Whether its samples are about as near to it, and their normals to its, as those of such a
    /// shape are: a prism is within the tolerances of a cylinder.
    fn is_true(&self, samples: &Samples, is_bare: bool, limits: &Limits) -> bool {
        let to = self.frame.transpose();
        let [mut angles, mut distances] = [0.0; 2];
        for &i in &self.points {
            let (p, n) = (to * samples.points[i as usize], to * samples.normals[i as usize]);
            let weight = samples.weights[i as usize] / self.share;
            angles += weight * self.shape.normal(p).angle_between(n).powi(2);
            distances += weight * self.shape.off(p).powi(2);
        }
        let [mut angle, distance] = limits.spread;
        if is_bare && limits.kind == Kind::Cad {
            angle = angle.min(BARE);
        }
        angles.sqrt() <= angle.to_radians() && distances.sqrt() <= distance
    }

    /// Whether most normals are those of a plane.
    fn is_flat(&self, normal: DVec3, samples: &Samples, limits: &Limits) -> bool {
        let cosine = limits.flat_half();
        let near: f64 = self
            .points
            .iter()
            .filter(|i| samples.normals[**i as usize].dot(normal) >= cosine)
            .map(|i| samples.weights[*i as usize])
            .sum();
        limits.kind == Kind::Scan || near >= 0.6 * self.share
    }

    /// How far it reaches along an axis.
    fn extent(&self, samples: &Samples, corners: &[Corner], axis: DVec3) -> [f64; 2] {
        let of_samples = self.points.iter().map(|i| samples.points[*i as usize].dot(axis));
        let mut along: Vec<f64> = of_samples.chain(corners.iter().map(|c| c.point.dot(axis))).collect();
        let tail = if samples.kind == Kind::Cad { 0.0 } else { 0.01 };
        [quantile(&mut along, tail), quantile(&mut along, 1.0 - tail)]
    }

    /// The corners of a mesh that are of it.
    fn held(&self, samples: &Samples, taken: &Taken, limits: &Limits) -> Vec<Corner> {
        let to = self.frame.transpose();
        let tolerance = limits.coarse(&self.shape);
        let holds = |c: &Corner| self.shape.margin(to * c.point, to * c.normal, tolerance) >= 0.0;
        let free = samples.corners.iter().zip(&taken.corners).filter(|(_, taken)| !**taken);
        free.map(|(c, _)| *c).filter(holds).collect()
    }

    /// Takes the corners' word for sizes; gives those that agree.
    fn adjust_to_corners(&mut self, mut held: Vec<Corner>) -> Vec<Corner> {
        let to = self.frame.transpose();
        let mut width = f64::INFINITY;
        for _ in 0..PASSES {
            if held.len() < CORNERS {
                break;
            }
            let points: Vec<(DVec3, f64)> = held.iter().map(|c| (to * c.point, 1.0)).collect();
            let Some(shape) = adjusted(&self.shape, &points, STEPS) else { break };
            self.shape = shape;
            // Corners of the shape are exact, or nearly so: others stand out.
            let mut off: Vec<f64> = points.iter().map(|p| shape.off(p.0)).collect();
            width = f64::min(WIDTH * median(&mut off), 0.5 * width).max(GRAIN);
            held.retain(|c| shape.off(to * c.point) <= width);
        }
        held
    }

    /// The region.
    pub(super) fn region(self) -> Region {
        let at = |local: DVec3| self.frame * local;
        let axis = self.frame.z_axis;
        let (form, sign) = match self.shape {
            Shape::Plane { normal, offset } => (Form::Plane { normal, offset }, 1.0),
            Shape::Sphere { centre, radius, sign } => (Form::Sphere { centre: at(centre), radius }, sign),
            Shape::Cone { centre: [x, y], radius, slope, sign } => {
                let middle = 0.5 * (self.along[0] + self.along[1]);
                let origin = at(DVec3::new(x, y, middle));
                let (along, arc) = (self.along.map(|s| s - middle), self.arc);
                let form = if slope == 0.0 {
                    Form::Cylinder { axis, origin, radius, along, arc }
                } else {
                    Form::Cone { axis, origin, radius: radius + slope * middle, slope, along, arc }
                };
                (form, sign)
            }
            Shape::Torus { centre, major, minor, sign } => {
                (Form::Torus { axis, centre: at(centre), major, minor }, sign)
            }
        };
        Region { form, points: self.points, share: self.share, sign, chordal: self.chordal }
    }
}
