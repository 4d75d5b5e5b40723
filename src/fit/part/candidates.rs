//! Candidates from the regions of a surface.
//!
//! ```text
//!       |   |        the side tells what is added (normals away from the axis) or cut;
//!     --+   +--      the ends are those of the region, at planes across the axis near them,
//!       |   |        at planes farther on, at the box, and for cuts a little beyond
//! ```

use glam::DVec3;
use rvachev_num::order;

use super::bits::Bits;
use super::leaf::Leaf;
use super::pool::Pool;
use super::queries::Queries;
use super::regions::{Form, Region};
use super::samples::Samples;
use super::settings::PartKinds;
use crate::{Cancelled, Run};

/// Planes whose normal is by less than this off an axis are across it, as a cosine: 2°.
const ACROSS: f64 = 0.9994;

/// A region that ends nearer to a plane across ends there.
const NEAR: f64 = 0.012;

/// How far cuts reach beyond what they cut.
pub(super) const BEYOND: f64 = 0.02;

/// Sides of less arc, in degrees, are fillets or guesses.
const ARC: f64 = 70.0;

/// Where a side has no sample for longer than this it may be of several leaves.
const GAP: f64 = 0.04;

/// Planes of a smaller share do not cut the whole part.
const PLANE: f64 = 0.004;

/// Tubes as thick as their rings are no tori.
const SPINDLE: f64 = 0.98;

/// Puts what the regions tell among the candidates.
pub(super) fn propose(
    pool: &mut Pool,
    samples: &Samples,
    regions: &[Region],
    part: [DVec3; 2],
    queries: &Queries,
    kinds: PartKinds,
    run: &Run,
) -> Result<(), Cancelled> {
    // The volume is that of the facets; what they are chords of is told by the vertices in the end.
    for region in regions {
        run.check()?;
        let may = [region.sign > 0.0, region.sign < 0.0];
        match region.form {
            Form::Plane { normal, offset } => {
                if kinds.half_spaces && region.share >= PLANE {
                    pool.add(Leaf::half_space(-normal, -offset), queries, [false, true], None);
                }
            }
            Form::Sphere { centre, radius } => {
                if kinds.spheres {
                    pool.add(Leaf::sphere(centre, region.chordal * radius), queries, may, None);
                }
            }
            Form::Torus { axis, centre, major, minor } => {
                if kinds.tori && minor < SPINDLE * major {
                    pool.add(Leaf::torus(axis, centre, major, region.chordal * minor), queries, may, None);
                }
            }
            Form::Cylinder { axis, origin, radius, along, arc } => {
                if kinds.cylinders && arc >= ARC {
                    let side = Side { axis, origin, radius: region.chordal * radius, slope: 0.0 };
                    side.propose(pool, &spans(region, samples, axis, origin, along), may, regions, part, queries);
                }
            }
            Form::Cone { axis, origin, radius, slope, along, arc } => {
                if kinds.cones && arc >= ARC {
                    let side = Side { axis, origin, radius, slope };
                    side.propose(pool, &spans(region, samples, axis, origin, along), may, regions, part, queries);
                }
            }
        }
    }
    Ok(())
}

/// Where a side is: as a whole, and each of its pieces, as of bores from both ends.
fn spans(region: &Region, samples: &Samples, axis: DVec3, origin: DVec3, along: [f64; 2]) -> Vec<[f64; 2]> {
    let mut pieces = region.pieces(samples, axis, origin, GAP);
    if pieces.len() < 2 {
        return vec![along];
    }
    let last = pieces.len() - 1;
    (pieces[0][0], pieces[last][1]) = (along[0], along[1]);
    pieces.push(along);
    pieces
}

/// The side of a cylinder or a cone.
struct Side {
    axis: DVec3,
    origin: DVec3,
    /// At the origin.
    radius: f64,
    slope: f64,
}

impl Side {
    fn leaf(&self, ends: [f64; 2]) -> Option<Leaf> {
        if ends[1] - ends[0] < 1e-6 {
            return None;
        }
        if self.slope == 0.0 {
            return Some(Leaf::cylinder(self.axis, self.origin, self.radius, ends));
        }
        Leaf::cone(self.axis, self.origin, [self.radius, self.slope], ends)
    }

    /// Puts the leaves between all ends in question among the candidates.
    fn propose(
        &self,
        pool: &mut Pool,
        spans: &[[f64; 2]],
        may: [bool; 2],
        regions: &[Region],
        part: [DVec3; 2],
        queries: &Queries,
    ) {
        let heights: Vec<f64> = queries.points.iter().map(|p| (*p - self.origin).dot(self.axis)).collect();
        let count = heights.len();
        let side = Bits::new(count, |i| {
            let height = heights[i];
            let away = (queries.points[i] - self.origin) - height * self.axis;
            let radius = self.radius + self.slope * height;
            radius > 0.0 && away.length_squared() < radius * radius
        });
        for along in spans {
            let [lows, highs] = self.ends(*along, may[0], regions, part);
            let above: Vec<Bits> = lows.iter().map(|low| Bits::new(count, |i| heights[i] > *low)).collect();
            let below: Vec<Bits> = highs.iter().map(|high| Bits::new(count, |i| heights[i] < *high)).collect();
            let family = pool.family();
            for (low, above) in lows.iter().zip(&above) {
                let over = side.and(above);
                for (high, below) in highs.iter().zip(&below) {
                    if let Some(leaf) = self.leaf([*low, *high]) {
                        pool.push(leaf, over.and(below), may, family);
                    }
                }
            }
        }
    }

    /// Where it may begin and end.
    fn ends(&self, along: [f64; 2], added: bool, regions: &[Region], [low, high]: [DVec3; 2]) -> [Vec<f64>; 2] {
        let mut planes: Vec<f64> = regions
            .iter()
            .filter_map(|region| match region.form {
                Form::Plane { normal, offset } if normal.dot(self.axis).abs() > ACROSS => {
                    Some((offset - normal.dot(self.origin)) / normal.dot(self.axis))
                }
                _ => None,
            })
            .collect();
        order::numbers(&mut planes);
        let nearest = |end: f64| {
            let near = planes.iter().copied().min_by(|a, b| (a - end).abs().total_cmp(&(b - end).abs()));
            near.filter(|plane| (plane - end).abs() < NEAR).unwrap_or(end)
        };
        let own = along.map(nearest);
        let (middle, half) = (0.5 * (low + high) - self.origin, 0.5 * (high - low));
        let (at, reach) = (middle.dot(self.axis), half.dot(self.axis.abs()));
        let [from, to] = [at - reach, at + reach];
        let [mut lows, mut highs] = own.map(|end| vec![end]);
        if added {
            lows.extend(planes.iter().rev().filter(|plane| **plane < own[0] - 1e-3).take(2));
            highs.extend(planes.iter().filter(|plane| **plane > own[1] + 1e-3).take(2));
            lows.push(from);
            highs.push(to);
        } else {
            lows.extend([own[0] - BEYOND, from - BEYOND]);
            highs.extend([own[1] + BEYOND, to + BEYOND]);
        }
        for ends in [&mut lows, &mut highs] {
            order::numbers(ends);
            ends.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
        }
        [lows, highs]
    }
}
