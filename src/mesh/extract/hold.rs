//! Feature points that are off the surface are brought back to it.
//!
//! ```text
//!        x            The planes of two flanks meet at x, but a crest that is narrower than a cell, which no
//!       / \           edge of the lattice crosses, cuts them off. The field at x tells: along its gradient the
//!     _/_h_\_         surface is at h.
//!     /     \
//! ```
//!
//! Each point is asked for value and gradient: the value over the gradient's length is how far off it is. One that is
//! farther than [`FAR`] goes along the gradient, within its cells, until it is not, at first from where it is, then from
//! the middle of its loop. If that leads nowhere, as where the field turns within a cell, the sign tells where the
//! surface is between the two; and if there is none in between, the point goes next to the vertex of the loop that is
//! nearest. All of these are inside the cells of the fan, which is what [`sharp`](super::sharp) asks for.

use glam::{Vec3, Vec3A};
use rayon::prelude::*;

use super::samples::{Samples, split_cell};
use super::sharp::{AT_ONCE, Fan};
use super::{Sampler, span::Span};
use crate::mesh::feature::{INSET, Segment, Slope};
use crate::{Cancelled, Run};

/// How far from the surface a feature point may be, in cells.
const FAR: f32 = 1.0 / 16.0;

/// How often a point goes along the gradient.
const STEPS: usize = 4;

/// How often a way is halved to find the surface on it.
const HALVINGS: usize = 6;

/// Brings the points of fans that are off the surface back to it.
pub(super) fn hold<S: Sampler>(
    samples: &Samples<'_>,
    sampler: &S,
    (fans, segments): (&mut [Fan], &[Vec<Segment>]),
    run: &Run,
) -> Result<(), Cancelled> {
    let chunks = fans.par_chunks_mut(AT_ONCE);
    chunks
        .map_init(
            || Holder::new(samples, sampler),
            |holder, fans| {
                run.check()?;
                holder.hold(fans, segments);
                Ok(())
            },
        )
        .collect()
}

/// One thread's means to ask how far points are off the surface.
pub(super) struct Holder<'a, S: Sampler> {
    samples: &'a Samples<'a>,
    sampler: &'a S,
    scratch: S::Scratch,
    step: f32,
    points: Vec<Vec3A>,
    found: Vec<Slope>,
    /// Whether the field tells slopes.
    tells: bool,
}

impl<'a, S: Sampler> Holder<'a, S> {
    pub(super) fn new(samples: &'a Samples<'a>, sampler: &'a S) -> Holder<'a, S> {
        let step = samples.lattice.step() as f32;
        Holder {
            samples,
            sampler,
            scratch: sampler.scratch(),
            step,
            points: Vec::new(),
            found: Vec::new(),
            tells: true,
        }
    }

    /// Brings back those of some fans that are off.
    fn hold(&mut self, fans: &mut [Fan], segments: &[Vec<Segment>]) {
        let mut start = 0;
        while start < fans.len() {
            let block = self.block_of(&fans[start]);
            let same = fans[start..].iter().take_while(|fan| self.block_of(fan) == block).count();
            self.points.clear();
            if let Some(block) = block {
                let first = self.samples.node(self.samples.blocks()[block]);
                let step = self.step;
                self.points.extend(fans[start..start + same].iter().map(|fan| Vec3A::from(fan.at - first) / step));
            }
            if !self.ask(block) {
                // The field does not tell.
                return;
            }
            let far: Vec<usize> =
                (0..same).filter(|&n| !self.found.get(n).is_some_and(|slope| is_near(slope, self.step))).collect();
            for n in far {
                let fan = &mut fans[start + n];
                fan.at = self.brought_back(fan, fan.of(segments));
            }
            start += same;
        }
    }

    /// Asks for the slopes at the points, which are in a block, or in none that has a surface; whether there are any.
    fn ask(&mut self, block: Option<usize>) -> bool {
        self.found.clear();
        let Some(block) = block else { return true };
        let first = self.samples.blocks()[block];
        self.tells = self.sampler.slopes(&mut self.scratch, block, first, &self.points, &mut self.found);
        self.tells
    }

    /// The block that the point of a fan is in, if it has a surface.
    fn block_of(&self, fan: &Fan) -> Option<usize> {
        if fan.span.is_small(1) {
            return Some(fan.block as usize);
        }
        let at = self.in_cells(fan.at, self.samples.node(fan.span.low));
        self.block_at(fan.block, &fan.span, at)
    }

    /// The block of a point in a box of cells, in cells from the box's first node.
    fn block_at(&self, near: u32, span: &Span, at: Vec3A) -> Option<usize> {
        let cell = std::array::from_fn(|axis| (span.low[axis] + at[axis].max(0.0) as u32).min(span.high[axis] - 1));
        self.samples.find_near(near as usize, split_cell(cell).0)
    }

    /// A place in cells from a node.
    fn in_cells(&self, at: Vec3, node: Vec3) -> Vec3A {
        Vec3A::from(at - node) / self.step
    }

    /// The slope at a point of a box of cells, in cells from the box's first node.
    fn slope(&mut self, near: u32, span: &Span, at: Vec3A) -> Option<Slope> {
        let block = self.block_at(near, span, at)?;
        let first = self.samples.blocks()[block];
        let shift = self.in_cells(self.samples.node(span.low), self.samples.node(first));
        self.points.clear();
        self.points.push(at + shift);
        self.ask(Some(block));
        self.found.first().copied()
    }

    /// Whether a point in the box of a fan is near the surface, or the field does not tell.
    pub(super) fn is_near(&mut self, fan: &Fan, at: Vec3) -> bool {
        let at = self.in_cells(at, self.samples.node(fan.span.low));
        let slope = self.slope(fan.block, &fan.span, at);
        slope.map_or(!self.tells, |slope| is_near(&slope, self.step))
    }

    /// A place for the point of a fan that is off, given its loop.
    #[cold]
    fn brought_back(&mut self, fan: &Fan, ring: &[Segment]) -> Vec3 {
        let (span, node) = (fan.span, self.samples.node(fan.span.low));
        let (low, high) = (Vec3A::splat(INSET), span.size() - INSET);
        let own = self.in_cells(fan.at, node);
        let around: Vec<Vec3A> = ring
            .iter()
            .map(|segment| self.in_cells(self.samples.position(segment.from), node).clamp(low, high))
            .collect();
        let middle = around.iter().sum::<Vec3A>() / around.len() as f32;
        // Where the field has a cusp the value over the gradient says little: the sign does.
        let slope = self.slope(fan.block, &span, own);
        if let Some(slope) = slope {
            let normals = [Vec3A::from(fan.normal), slope.gradient.normalize_or_zero()];
            let ways = normals.into_iter().flat_map(|normal| [FAR, -FAR].map(|by| by * normal));
            for at in ways.map(|way| (own + way).clamp(low, high)) {
                let beside = self.slope(fan.block, &span, at);
                if beside.is_some_and(|beside| (beside.value > 0.0) != (slope.value > 0.0)) {
                    return fan.at;
                }
            }
        }
        let mut place = self.along_gradient((fan.block, &span), own, [low, high]);
        place = place.or_else(|| self.along_gradient((fan.block, &span), middle, [low, high]));
        place = place.or_else(|| self.between((fan.block, &span), own, middle));
        let nearest = |a: &&Vec3A, b: &&Vec3A| a.distance_squared(own).total_cmp(&b.distance_squared(own));
        let place = place.or_else(|| around.iter().min_by(nearest).copied()).unwrap_or(own);
        self.samples.inside(place, span.low, span.high)
    }

    /// Where the gradient leads to from a point, if that is near the surface.
    fn along_gradient(&mut self, (near, span): (u32, &Span), from: Vec3A, [low, high]: [Vec3A; 2]) -> Option<Vec3A> {
        let (mut at, step) = (from, self.step);
        for _ in 0..STEPS {
            let (normal, depth) = self.slope(near, span, at)?.surface(step)?;
            if depth.abs() <= FAR {
                return Some(at);
            }
            at = (at + depth * normal).clamp(low, high);
        }
        let slope = self.slope(near, span, at)?;
        is_near(&slope, step).then_some(at)
    }

    /// Where the sign changes between two points, if it does.
    fn between(&mut self, (near, span): (u32, &Span), from: Vec3A, to: Vec3A) -> Option<Vec3A> {
        let mut is_inside = |at: Vec3A| self.slope(near, span, at).map(|slope| slope.value > 0.0);
        let (mut from, mut to) = (from, to);
        let side = is_inside(from)?;
        if is_inside(to)? == side {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            if is_inside(middle)? == side { from = middle } else { to = middle }
        }
        Some(0.5 * (from + to))
    }
}

fn is_near(slope: &Slope, step: f32) -> bool {
    slope.surface(step).is_some_and(|(_, depth)| depth.abs() <= FAR)
}
