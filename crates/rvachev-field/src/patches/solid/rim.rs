//! Where triangles leave openings, and the surface that goes on across these.
//!
//! ```text
//!        . - ~ - .             w = ½: the membrane
//!      o           o           the rim: edges with a triangle on one side
//!      |           |
//!      |   w > ½   |           triangles
//!      '-----------'
//! ```
//!
//! Off the triangles w changes no faster than its rim allows: by Biot and Savart's law
//!
//! ```text
//!     |∇w(x)| ≤ G(x) = 1/4π Σ ∫ |dl| / |x − l|²       over the rim
//! ```
//!
//! Let δ be the distance to the rim. Within δ/4 of x, G is at most 16/9 of what it is there, so the
//! membrane is no nearer than
//!
//! ```text
//!     m(x) = min(δ/4, |w(x) − ½| / 4 G(x)),
//! ```
//!
//! which is 0 on the membrane and changes by at most 1 a length unit: |∇m| ≤ 1/4 + (m/δ)·2 ≤ 3/4.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use rvachev_num::{Cancelled, Meter, Run};

use super::super::face::double;
use super::super::hierarchy::PARENT;
use super::super::{AT_ONCE, Patch, Patches, gathered};
use super::gaps::Gaps;
use super::winding::Winding;
use crate::Bounds;

/// An edge that has more triangles on one side than on the other, as those that are more go along
/// it.
pub(super) struct OpenEdge {
    pub(super) ends: [DVec3; 2],
    /// The numbers of its ends.
    pub(super) vertices: [u32; 2],
    /// How many more.
    pub(super) missing: u32,
}

/// The open edges of triangles. Vertices at one position are one vertex.
pub(super) fn open_edges(positions: &[Vec3], triangles: &[[u32; 3]], run: &Run) -> Result<Vec<OpenEdge>, Cancelled> {
    let [to_weld, to_open] = run.stages([1.0, 1.0]);
    let welded = welded(positions, triangles, &to_weld)?;
    to_weld.report(1.0);
    open_edges_of(positions, &welded, &to_open)
}

/// The triangles by the first vertex at each position.
pub(super) fn welded(positions: &[Vec3], triangles: &[[u32; 3]], run: &Run) -> Result<Vec<[u32; 3]>, Cancelled> {
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    let key = |p: &Vec3| (*p + 0.0).to_array().map(f32::to_bits);
    let names = (0_u32..).zip(positions).map(|(v, p)| *known.entry(key(p)).or_insert(v));
    let first = gathered(names, run)?;
    gathered(triangles.iter().map(|corners| corners.map(|v| first[v as usize])), run)
}

/// The open edges of triangles whose vertices are one at each position.
pub(super) fn open_edges_of(positions: &[Vec3], triangles: &[[u32; 3]], run: &Run) -> Result<Vec<OpenEdge>, Cancelled> {
    let edges_of = |corners: &[u32; 3]| {
        let [a, b, c] = *corners;
        [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to)
    };
    // Those of each vertex with the lesser number are together.
    let mut starts = vec![0_usize; positions.len() + 1];
    let meter = Meter::new(run, 2 * triangles.len() + positions.len());
    for triangles in triangles.chunks(AT_ONCE) {
        meter.check()?;
        triangles.iter().flat_map(edges_of).for_each(|(from, to)| starts[from.min(to) as usize + 1] += 1);
        meter.add(triangles.len() as u64);
    }
    for v in 0..positions.len() {
        starts[v + 1] += starts[v];
    }
    let mut edges = vec![(0_u32, false); starts[positions.len()]];
    let mut next = starts.clone();
    for triangles in triangles.chunks(AT_ONCE) {
        meter.check()?;
        meter.add(triangles.len() as u64);
        for (from, to) in triangles.iter().flat_map(edges_of) {
            let at = &mut next[from.min(to) as usize];
            edges[*at] = (from.max(to), from < to);
            *at += 1;
        }
    }
    let mut open = Vec::new();
    for (least, ends) in (0_u32..).zip(starts.windows(2)) {
        if (least as usize).is_multiple_of(AT_ONCE) {
            meter.check()?;
            meter.add(AT_ONCE.min(positions.len() - least as usize) as u64);
        }
        let own = &mut edges[ends[0]..ends[1]];
        own.sort_unstable();
        for same in own.chunk_by(|a, b| a.0 == b.0) {
            let more = same.iter().map(|(_, forth)| if *forth { 1_i64 } else { -1 }).sum::<i64>();
            let mut vertices = [least, same[0].0];
            if more < 0 {
                vertices.reverse();
            }
            let ends = vertices.map(|v| positions[v as usize].as_dvec3());
            if more != 0 {
                open.push(OpenEdge { ends, vertices, missing: more.unsigned_abs() as u32 });
            }
        }
    }
    Ok(open)
}

/// Open edges in boxes within boxes.
pub(super) struct Rim {
    /// Triangles of two corners.
    edges: Patches,
    missing: Vec<u32>,
    /// How long the edges of each box are together.
    lengths: Vec<f64>,
    /// All of them, in length units, divided by 4π.
    whole: f64,
}

impl Rim {
    /// Nothing if there are no open edges.
    pub(super) fn new(open: &[OpenEdge], run: &Run) -> Result<Option<Rim>, Cancelled> {
        if open.is_empty() {
            return Ok(None);
        }
        let flat: Vec<Patch> =
            open.iter().map(|edge| Patch::flat([edge.ends[0], edge.ends[1], edge.ends[1]])).collect();
        let edges = Patches::new(&flat, run)?;
        let missing = edges.numbers.iter().map(|number| open[*number as usize].missing).collect();
        let mut rim = Rim { lengths: vec![0.0; edges.nodes.len()], edges, missing, whole: 0.0 };
        for at in (0..rim.lengths.len()).rev() {
            let node = rim.edges.nodes[at];
            rim.lengths[at] = if node.count >= PARENT {
                rim.lengths[node.first as usize] + rim.lengths[node.first as usize + 1]
            } else {
                (node.first..node.first + node.count).map(|at| rim.length(at as usize)).sum()
            };
        }
        rim.whole = rim.lengths[0] * rim.edges.frame.unit / (4.0 * PI);
        Ok(Some(rim))
    }

    /// The length of an edge, as often as triangles are missing, in the frame of the edges.
    fn length(&self, at: usize) -> f64 {
        f64::from(self.missing[at]) * double(self.edges.sides[at].e).length()
    }

    /// How far the nearest edge is.
    fn distance(&self, p: DVec3) -> f64 {
        self.edges.distance(p).unwrap_or(f64::INFINITY)
    }

    /// G, from above.
    fn steepest(&self, p: DVec3) -> f64 {
        let local = self.edges.frame.into_local(p);
        let mut sum = 0.0;
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            let node = &self.edges.nodes[at as usize];
            let (low, high) = (double(node.low), double(node.high));
            let square = local.distance_squared(local.clamp(low, high));
            // Seen as if all were at the nearest corner.
            if square > (high - low).length_squared() * 4.0 {
                sum += self.lengths[at as usize] / square;
            } else if node.count >= PARENT {
                open.extend([node.first, node.first + 1]);
            } else {
                for at in node.first..node.first + node.count {
                    let (a, e) = (double(self.edges.faces[at as usize].a), double(self.edges.sides[at as usize].e));
                    sum += f64::from(self.missing[at as usize]) * along(a - local, e);
                }
            }
        }
        sum / (4.0 * PI * self.edges.frame.unit)
    }
}

/// ∫ |dl| / |l|² along `e` from `a`.
fn along(a: DVec3, e: DVec3) -> f64 {
    let length = e.length();
    if length == 0.0 {
        return 0.0;
    }
    let way = e / length;
    let from = a.dot(way);
    let height = (a - from * way).length().max(1e-12);
    (((from + length) / height).atan() - (from / height).atan()) / height
}

/// The surface across openings.
pub(super) struct Membrane {
    pub(super) winding: Arc<Winding>,
    pub(super) rim: Rim,
}

/// Pieces of a box's surface that are looked at before it is given up.
const PATIENCE: usize = 20_000;

impl Membrane {
    /// How far above one half the winding number is, and how far the membrane is at least, or
    /// `most` if that is less.
    pub(super) fn side(&self, p: DVec3, most: f64) -> (f64, f64) {
        let side = self.winding.number(p) - 0.5;
        let distance = self.rim.distance(p);
        let way = most.min(0.25 * distance);
        // Nowhere is the rim steeper than if all of it were at its nearest point: mostly that tells
        // enough.
        let is_enough = side.abs() >= 4.0 * way * self.rim.whole / (distance * distance);
        if is_enough { (side, way) } else { (side, way.min(side.abs() / (4.0 * self.rim.steepest(p)))) }
    }

    /// The derivatives of the signed way to the membrane.
    pub(super) fn slope(&self, p: DVec3) -> DVec3 {
        let step = (1e-3 * self.rim.distance(p)).max(1e-9 * self.rim.edges.frame.unit);
        let at = |axis: usize, by: f64| {
            let mut moved = p;
            moved[axis] += by;
            let (side, way) = self.side(moved, f64::INFINITY);
            way.copysign(side)
        };
        let slope = [0, 1, 2].map(|axis| (at(axis, step) - at(axis, -step)) / (2.0 * step));
        DVec3::from_array(slope).clamp_length_max(1.0)
    }

    /// A box that holds what is inside. Beyond the triangles the winding number has its largest
    /// value on any box around them, as harmonic functions have.
    pub(super) fn bounds(&self, triangles: Bounds, gaps: &Gaps, run: &Run) -> Result<Bounds, Cancelled> {
        /// How much larger each box is than the one before, of the size.
        const STEPS: [f64; 9] = [0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.56];
        let size = triangles.longest_side();
        for step in STEPS {
            let larger = triangles.inflate(step * size);
            if self.is_outside(&larger, gaps, run)? {
                return Ok(larger);
            }
        }
        // However many triangles lie on one another, from here they are small.
        Ok(triangles.inflate(8.0 * size + (self.winding.patches.area() / (2.0 * PI)).sqrt()))
    }

    /// Whether all of a box's surface is found to be outside.
    fn is_outside(&self, bounds: &Bounds, gaps: &Gaps, run: &Run) -> Result<bool, Cancelled> {
        let mut open = Vec::new();
        for axis in 0..3 {
            for side in [bounds.min[axis], bounds.max[axis]] {
                let (mut centre, mut half) = (bounds.center(), bounds.half_extents());
                (centre[axis], half[axis]) = (side, 0.0);
                open.push((centre, half));
            }
        }
        for looked in 0..PATIENCE {
            if looked % 256 == 0 {
                run.check()?;
            }
            let Some((centre, half)) = open.pop() else { return Ok(true) };
            if gaps.most(centre, half) < 0.5 {
                continue;
            }
            let (side, way) = self.side(centre, half.length());
            if side >= 0.0 {
                return Ok(false);
            }
            if way >= half.length() {
                continue;
            }
            let axis = if half.x >= half.y && half.x >= half.z { 0 } else { 1 + usize::from(half.z > half.y) };
            let (mut half, mut by) = (half, DVec3::ZERO);
            half[axis] *= 0.5;
            by[axis] = half[axis];
            open.extend([(centre - by, half), (centre + by, half)]);
        }
        Ok(false)
    }
}

impl Patches {
    /// The area of flat triangles.
    fn area(&self) -> f64 {
        let area = |sides: &super::super::face::Sides| 0.5 * double(sides.e).cross(double(sides.f)).length();
        self.sides.iter().map(area).sum::<f64>() * self.frame.unit * self.frame.unit
    }
}
