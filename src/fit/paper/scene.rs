//! What is fitted: the points in a frame of their size, their labels and neighbours.

use glam::DVec3;

use super::lengthen::lengthened;
use super::neighbours::Neighbours;
use super::oriented_box::{OrientedBox, Side};
use super::segment::{Found, Judge};
use super::segments::Segments;
use super::truncated::{Truncated, box_axes};
use crate::Run;
use crate::fit::cloud::Scaled;
use crate::fit::cost::Cost;
use crate::fit::error::FitError;
use crate::fit::gielis;
use crate::fit::kernel::terms;
use crate::fit::settings::FitSettings;

/// A point is of a shape that is within this many deviations of it.
const WITHIN: f64 = 5.0;

/// What is called nothing: this share of a segment's size.
pub(super) const NOTHING: f64 = 0.004;

/// The share of a box's length that is beside a side of it.
const BESIDE: f64 = 0.08;

/// A side is open if this share of the points beside it has neighbours in another segment.
const OPEN: f64 = 0.12;

/// Bodies overlap by this share of their half-widths.
const OVERLAP: f64 = 0.1;

/// Points of a whole, in units of its size about its centre.
pub(super) struct Scene {
    pub(super) points: Vec<DVec3>,
    pub(super) normals: Option<Vec<DVec3>>,
    pub(super) labels: Vec<u32>,
    pub(super) near: Neighbours,
    pub(super) center: DVec3,
    pub(super) size: f64,
}

impl Scene {
    pub(super) fn of(segments: &Segments, settings: &FitSettings, run: &Run) -> Result<Scene, FitError> {
        let cloud = segments.cloud();
        let Scaled { center, size, .. } = Scaled::of(cloud, settings, "union of supershapes", gielis::PARAMETERS)?;
        let points: Vec<DVec3> = cloud.positions().iter().map(|p| (*p - center) / size).collect();
        let normals = cloud.normals().map(|all| all.iter().map(|n| n.as_dvec3()).collect());
        let near = Neighbours::new(&points, run)?;
        Ok(Scene { points, normals, labels: segments.labels().to_vec(), near, center, size })
    }

    pub(super) fn points_of(&self, of: &[usize]) -> Vec<DVec3> {
        of.iter().map(|i| self.points[*i]).collect()
    }

    pub(super) fn normals_of(&self, of: &[usize]) -> Option<Vec<DVec3>> {
        self.normals.as_ref().map(|normals| of.iter().map(|i| normals[*i]).collect())
    }

    /// Whether a point has a neighbour of another label.
    fn is_border(&self, i: usize) -> bool {
        self.near.of(i).iter().any(|j| self.labels[*j as usize] != self.labels[i])
    }

    /// The body of a segment: its shape, longer where it touches other segments, and truncated by
    /// the box of its points.
    pub(super) fn body(&self, of: &[usize], found: &Found) -> Truncated {
        let is_open = |bounds: &OrientedBox, side: Side, on: &[usize]| {
            let beside: Vec<usize> = beside(bounds, side, on, &self.points);
            let borders = beside.iter().filter(|i| self.is_border(**i)).count();
            borders as f64 > OPEN * beside.len() as f64
        };
        self.truncated(of, found, is_open, |side, bounds| {
            (OVERLAP * bounds.half[side.axis]).max(3.0 * self.near.spacing)
        })
    }

    /// A shape truncated by the box of the points that are on it; both longer at open sides.
    pub(super) fn truncated(
        &self,
        of: &[usize],
        found: &Found,
        is_open: impl Fn(&OrientedBox, Side, &[usize]) -> bool,
        by: impl Fn(Side, &OrientedBox) -> f64,
    ) -> Truncated {
        let size = OrientedBox::smallest(&self.points_of(of), &[]).half.max_element();
        let width = (WITHIN * found.noise).max(NOTHING * size);
        let off = |i: &usize| terms(&found.shape, self.points[*i].to_array(), Cost::Normal).0.abs();
        let mut on: Vec<usize> = of.iter().copied().filter(|i| off(i) < width).collect();
        if on.len() < 8 {
            on = of.to_vec();
        }
        let tight = OrientedBox::smallest(&self.points_of(&on), &box_axes(&found.shape));
        let judge = Judge::new(&self.points_of(of), width);
        let bounds = tight.grown(0.25 * self.near.spacing);
        let mut member = Truncated { shape: found.shape, bounds, held: [false; 3] };
        for side in Side::ALL {
            if is_open(&tight, side, &on) {
                let by = by(side, &tight);
                if let Some((shape, axis)) = lengthened(member.shape, side.direction(&tight), by, &judge) {
                    member.shape = shape;
                    member.held[axis] = true;
                }
                member.bounds = member.bounds.extended(side, by);
            }
        }
        member
    }
}

/// The points beside a side of a box.
pub(super) fn beside(bounds: &OrientedBox, side: Side, of: &[usize], points: &[DVec3]) -> Vec<usize> {
    let reach = BESIDE * 2.0 * bounds.half[side.axis];
    of.iter().copied().filter(|i| side.away(bounds, points[*i]) < reach).collect()
}
