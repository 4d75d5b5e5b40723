//! The field at single points: what feature points are verified by.
//!
//! ```text
//!         .p          The planes of two sides meet in p, but between them there is a third side that no edge of
//!        /:\          the cell crosses: the field tells that p is off the surface. Newton's steps take it there.
//!       /_o_\
//!      /     \
//! ```

use glam::Vec3A;

use super::Sampler;
use super::samples::{Samples, split_cell};
use super::span::{Span, offset};
use crate::mesh::feature::{INSET, Slope};

/// The farthest that a feature point may be off the surface by what the field's value and slope
/// tell, in cells.
pub(super) const OFF: f32 = 0.1;

/// Where a point is farther off, it is seen whether there is a better one.
pub(super) const DOUBTFUL: f32 = 0.02;

/// How often a point is moved towards the surface.
const STEPS: usize = 6;

/// How often the way to the inside of a loop is halved.
const HALVINGS: usize = 10;

/// Asks for the field at single points.
pub(super) struct Probe<'a, S: Sampler> {
    samples: &'a Samples<'a>,
    sampler: &'a S,
    scratch: S::Scratch,
    found: Vec<Slope>,
    pub(super) step: f32,
}

/// Whether a point with this slope is farther off the surface than a distance. What is not a number
/// tells nothing.
#[inline]
pub(super) fn is_beyond(slope: &Slope, distance: f32) -> bool {
    slope.value.abs() > distance * slope.gradient.length()
}

impl<'a, S: Sampler> Probe<'a, S> {
    pub(super) fn new(samples: &'a Samples<'a>, sampler: &'a S) -> Probe<'a, S> {
        let step = samples.lattice.step() as f32;
        Probe { samples, sampler, scratch: sampler.scratch(), found: Vec::new(), step }
    }

    /// The field at points of a block, in cells from its first node; none if it is not known.
    pub(super) fn of_block(&mut self, block: usize, points: &[Vec3A]) -> &[Slope] {
        self.found.clear();
        let first = self.samples.blocks()[block];
        let is_known = self.sampler.slopes(&mut self.scratch, block, first, points, &mut self.found);
        if is_known && self.found.len() == points.len() { &self.found } else { &[] }
    }

    /// The field at a point of a box of cells, in or close to block `near`, in cells from the first
    /// node of the box. None if it is not known.
    pub(super) fn at(&mut self, near: usize, span: &Span, at: Vec3A) -> Option<Slope> {
        let cell = std::array::from_fn(|axis| (span.low[axis] + at[axis].max(0.0) as u32).min(span.high[axis] - 1));
        let (first, _) = split_cell(cell);
        let block = self.samples.find_near(near, first)?;
        self.of_block(block, &[at + offset(span.low, first)]).first().copied()
    }

    /// Whether a point of a box is known to be off the surface.
    pub(super) fn is_off(&mut self, near: usize, span: &Span, at: Vec3A) -> bool {
        self.at(near, span, at).is_some_and(|slope| is_beyond(&slope, OFF * self.step))
    }

    /// A point of a box that is on the surface, close to one that is off: on the way to `inner`, if
    /// the surface crosses it; else by Newton's steps; or at worst next to `root`, which is on the
    /// surface.
    pub(super) fn onto(&mut self, near: usize, span: &Span, from: Vec3A, [inner, root]: [Vec3A; 2]) -> Vec3A {
        let held = |p: Vec3A| p.clamp(Vec3A::splat(INSET), span.size() - INSET);
        let value = |probe: &mut Self, at: Vec3A| probe.at(near, span, at).map_or(f32::NAN, |slope| slope.value);
        let (mut off, mut end) = (held(from), held(inner));
        let start = value(self, off);
        if start * value(self, end) <= 0.0 {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (off + end);
                if start * value(self, middle) > 0.0 {
                    off = middle;
                } else {
                    end = middle;
                }
            }
            return end;
        }
        for start in [from, inner] {
            let mut at = held(start);
            for _ in 0..STEPS {
                let Some(slope) = self.at(near, span, at) else { break };
                if !is_beyond(&slope, OFF * self.step) {
                    return at;
                }
                let square = slope.gradient.length_squared() * self.step;
                let way = slope.gradient * (slope.value / square);
                if !way.is_finite() {
                    break;
                }
                at = held(at - way.clamp_length_max(1.0));
            }
        }
        held(root)
    }
}
