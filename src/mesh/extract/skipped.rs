//! Edges with both ends on one side of the surface, and the other side between them.
//!
//! ```text
//!     |##|   |##|       Both ends are so near to the surface that a gap or a wall thinner than a
//!   o-|#o|-p-|-q|-o     cell may pass between them. The value in the middle shows it; or it is
//!     |##|   |##|       not half-way between those of the ends, and falls so that it would be 0
//!          m x          before what is near one of them: at x it is looked at once more.
//! ```
//!
//! The tip of a wedge passes between nodes wherever there is one; so only sides that are all but
//! parallel count, by the normals of both places where the edge is crossed. Where nothing is seen
//! near, it is no tip, whatever its sides.

use glam::Vec3A;

use super::Sampler;
use super::suspect::CellBits;
use crate::mesh::feature::Slope;
use crate::mesh::signs::{BLOCK, NODES, SIDE, Signs};

/// The cosine from which on the normals of both sides are opposite: those of 11 degrees.
const OPPOSITE: f32 = -0.98;

/// So many edges that are passed tell of a gap or a wall in a block.
const FEW: usize = 4;

/// As many are looked at to the end.
const MANY: usize = 4 * FEW;

/// How far from half-way between those of the ends the value in the middle is at least, in cells:
/// that of a flat face is not.
const OFF_LINE: f32 = 0.002;

/// How far beyond where the value would be 0 it is looked at, in cells.
const BEYOND: f32 = 0.03;

/// How often the part of an edge is halved that the surface is in.
const HALVINGS: usize = 5;

/// How far apart the nodes of an edge are in a block's list, by axis.
const STRIDES: [usize; 3] = [1, SIDE, SIDE * SIDE];

/// An edge from its lower node along an axis.
#[derive(Clone, Copy)]
struct Edge {
    low: u16,
    axis: u8,
}

impl Edge {
    #[inline(always)]
    fn nodes(self) -> [usize; 2] {
        let low = usize::from(self.low);
        [low, low + STRIDES[usize::from(self.axis)]]
    }

    /// The cells of the block that it is an edge of.
    fn cells(self) -> impl Iterator<Item = [usize; 3]> {
        let (low, axis) = (usize::from(self.low), usize::from(self.axis));
        let node = [low % SIDE, low / SIDE % SIDE, low / (SIDE * SIDE)];
        let [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
        [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().filter_map(move |[by, other]| {
            let mut cell = node;
            cell[j] = cell[j].checked_sub(by)?;
            cell[k] = cell[k].checked_sub(other)?;
            Some(cell)
        })
    }

    /// A point of it, in cells from the block's first node.
    #[inline(always)]
    fn point(self, part: f32) -> Vec3A {
        let low = usize::from(self.low);
        let mut point = Vec3A::from([low % SIDE, low / SIDE % SIDE, low / (SIDE * SIDE)].map(|at| at as f32));
        point[usize::from(self.axis)] += part;
        point
    }
}

/// What looking for such edges needs, from block to block.
#[derive(Default)]
pub(super) struct Skips {
    edges: Vec<Edge>,
    points: Vec<Vec3A>,
    values: Vec<f32>,
    slopes: Vec<Slope>,
}

/// What is asked of a block: the number of it, how much the value changes by from node to node at
/// most, and how long an edge is.
#[derive(Clone, Copy)]
pub(super) struct Asked {
    pub(super) number: usize,
    pub(super) most: f32,
    pub(super) step: f32,
}

/// What edges of a block that are passed tell.
#[derive(Default)]
pub(super) struct Passed {
    /// Whether sides of some are opposite, as those of a gap or a wall are.
    pub(super) is_thin: bool,
    /// The cells about all of them.
    pub(super) cells: Option<CellBits>,
}

impl Skips {
    /// The edges of a block on which the surface is passed there and back.
    pub(super) fn passed<S: Sampler>(
        &mut self,
        (sampler, scratch): (&S, &mut S::Scratch),
        asked: Asked,
        (signs, values): (&Signs, &[f32; NODES]),
    ) -> Passed {
        self.list(signs, values, asked.most);
        if self.edges.len() < FEW {
            return Passed::default();
        }
        let side = |edge: Edge| if values[usize::from(edge.low)] > 0.0 { 1.0 } else { -1.0 };
        let is_beyond = |(edge, slope): (Edge, &Slope)| side(edge) * slope.value < 0.0;
        let ends = |edge: Edge| edge.nodes().map(|node| values[node].abs() / asked.most);
        // In the middle, and where that tells to look.
        self.values.clear();
        self.points.clear();
        self.points.extend(self.edges.iter().map(|edge| edge.point(0.5)));
        if !sampler.values_at_hand(scratch, asked.number, &self.points, &mut self.values) {
            return Passed::default();
        }
        let bent = self.edges.iter().zip(&self.values).filter(|(edge, value)| {
            let [first, last] = ends(**edge);
            let middle = side(**edge) * **value / asked.most;
            (middle - 0.5 * (first + last)).abs() > OFF_LINE && middle + first.min(last) < 0.5
        });
        let places: Vec<(Edge, f32)> = bent.map(|(edge, _)| (*edge, 0.5)).collect();
        if places.len() < FEW || !self.ask((sampler, scratch), asked.number, &places) {
            return Passed::default();
        }
        let (mut found, mut rest) = (Vec::new(), Vec::new());
        for (&(edge, part), slope) in places.iter().zip(&self.slopes) {
            if is_beyond((edge, slope)) {
                found.push((edge, part));
                continue;
            }
            let scale = side(edge) / asked.most;
            let rise = scale * asked.step * slope.gradient[usize::from(edge.axis)];
            rest.extend(beyond(scale * slope.value, rise, ends(edge)).map(|part| (edge, part)));
        }
        if self.ask((sampler, scratch), asked.number, &rest) {
            let is_found = |((edge, _), slope): &(&(Edge, f32), &Slope)| is_beyond((*edge, slope));
            found.extend(rest.iter().zip(&self.slopes).filter(is_found).map(|(place, _)| *place));
        }
        if found.len() < FEW {
            return Passed::default();
        }
        let cells = Some(CellBits::of(found.iter().flat_map(|(edge, _)| edge.cells())));
        found.truncate(MANY);
        let is_thin = self.opposite((sampler, scratch), asked.number, &found, is_beyond) >= FEW;
        Passed { is_thin, cells }
    }

    /// On how many of edges, given a place on each that is beyond the surface, both sides are
    /// opposite.
    fn opposite<S: Sampler>(
        &mut self,
        (sampler, scratch): (&S, &mut S::Scratch),
        number: usize,
        found: &[(Edge, f32)],
        is_beyond: impl Fn((Edge, &Slope)) -> bool,
    ) -> usize {
        // From either end a place that is not beyond, and one that is.
        let mut ranges: Vec<[f32; 2]> = found.iter().flat_map(|(_, part)| [[0.0, *part], [1.0, *part]]).collect();
        let mut places = Vec::new();
        for _ in 0..=HALVINGS {
            places.clear();
            let middles = ranges
                .chunks(2)
                .zip(found)
                .flat_map(|(ends, (edge, _))| ends.iter().map(|[from, to]| (*edge, 0.5 * (from + to))));
            places.extend(middles);
            if !self.ask((sampler, scratch), number, &places) {
                return 0;
            }
            for ((range, (edge, part)), slope) in ranges.iter_mut().zip(&places).zip(&self.slopes) {
                range[usize::from(is_beyond((*edge, slope)))] = *part;
            }
        }
        let normals = self.slopes.chunks(2).map(|ends| [0, 1].map(|end: usize| ends[end].gradient.normalize_or_zero()));
        normals.filter(|[from, to]| from.dot(*to) < OPPOSITE).count()
    }

    /// Asks for the slopes at places.
    fn ask<S: Sampler>(
        &mut self,
        (sampler, scratch): (&S, &mut S::Scratch),
        number: usize,
        places: &[(Edge, f32)],
    ) -> bool {
        self.slopes.clear();
        self.points.clear();
        self.points.extend(places.iter().map(|(edge, part)| edge.point(*part)));
        sampler.slopes_at_hand(scratch, number, &self.points, &mut self.slopes) && self.slopes.len() == places.len()
    }

    /// Lists the edges that the block owns, whose ends are on one side and so near to the surface
    /// that it may be between them.
    fn list(&mut self, signs: &Signs, values: &[f32; NODES], most: f32) {
        self.edges.clear();
        let (rows, _) = values.as_chunks::<SIDE>();
        let mut near = [0u16; SIDE * SIDE];
        for (near, row) in near.iter_mut().zip(rows) {
            *near = row.iter().enumerate().fold(0, |bits, (n, value)| bits | u16::from(value.abs() < most) << n);
        }
        const OWNED: u16 = (1 << BLOCK) - 1;
        for k in 0..BLOCK {
            for j in 0..BLOCK {
                let row = |j: usize, k: usize| (near[SIDE * k + j], signs.row(j, k));
                let (near, sign) = row(j, k);
                let others = [(near >> 1, sign >> 1), row(j + 1, k), row(j, k + 1)];
                for (axis, (other, other_sign)) in (0u8..).zip(others) {
                    let mut bits = near & other & !(sign ^ other_sign) & OWNED;
                    let first = SIDE * (j + SIDE * k);
                    let ends = [first, first + STRIDES[usize::from(axis)]].map(|node| &values[node..node + BLOCK]);
                    while bits != 0 {
                        let i = bits.trailing_zeros() as usize % BLOCK;
                        bits &= bits - 1;
                        if ends[0][i].abs() + ends[1][i].abs() < most {
                            self.edges.push(Edge { low: (first + i) as u16, axis });
                        }
                    }
                }
            }
        }
    }
}

/// A place on an edge that is beyond the surface, if there may be one: given the value and the rise
/// in its middle, and how far from its ends there is none at least, as parts of the edge.
fn beyond(middle: f32, rise: f32, [first, last]: [f32; 2]) -> Option<f32> {
    let way = middle / rise.abs();
    let from = 0.5 + way;
    let to = 1.0 - if rise < 0.0 { last } else { first };
    let part = from + BEYOND.min(0.5 * (to - from));
    (from < to).then_some(if rise < 0.0 { part } else { 1.0 - part })
}
