//! The whole solid: a union of parts, each a truncated supershape without its holes; and the
//! global error of fit.
//!
//! ```text
//!     F = ∨ⱼ (fⱼ ∧ ¬h₁ ∧ ¬h₂ …)         E = Σ F(Pᵢ)²          each f and h times its √(a₁a₂a₃)
//! ```
//!
//! Source: Y. D. Fougerolle et al., *Rational supershapes for surface reconstruction*, equation 15.

use glam::DVec3;

use super::truncated::{Row, Truncated, both, either};
use crate::{Cancelled, Run};
use rvachev_num::jobs;

/// Points that one task sums; sums are in the same order for any number of threads.
const CHUNK: usize = 256;

#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) label: u32,
    pub(super) body: Truncated,
    pub(super) holes: Vec<Truncated>,
}

impl Part {
    fn value(&self, p: DVec3) -> f64 {
        self.holes.iter().fold(self.body.value(p), |all, hole| both(all, -hole.value(p)).0)
    }
}

#[derive(Clone, Debug)]
pub(super) struct Whole {
    pub(super) parts: Vec<Part>,
}

impl Whole {
    /// Bodies and holes, part by part.
    pub(super) fn members(&self) -> impl Iterator<Item = &Truncated> {
        self.parts.iter().flat_map(|part| std::iter::once(&part.body).chain(&part.holes))
    }

    pub(super) fn members_mut(&mut self) -> impl Iterator<Item = &mut Truncated> {
        self.parts.iter_mut().flat_map(|part| std::iter::once(&mut part.body).chain(&mut part.holes))
    }

    pub(super) fn value(&self, p: DVec3) -> f64 {
        let mut parts = self.parts.iter().map(|part| part.value(p));
        let first = parts.next().unwrap_or(0.0);
        parts.fold(first, |all, part| either(all, part).0)
    }

    /// F, and its derivatives by the parameters of each member.
    pub(super) fn slopes(&self, p: DVec3, rows: &mut [Row]) -> f64 {
        // The slope of a chain's result by what was joined before, and by each operand.
        let mut at = 0;
        let mut all: Option<f64> = None;
        for part in &self.parts {
            let first = at;
            let mut value = part.body.slopes(p, &mut rows[at]);
            at += 1;
            for hole in &part.holes {
                let (next, [by_value, by_hole]) = both(value, -hole.slopes(p, &mut rows[at]));
                scale(&mut rows[first..at], by_value);
                scale(&mut rows[at..=at], -by_hole);
                value = next;
                at += 1;
            }
            all = Some(match all {
                None => value,
                Some(before) => {
                    let (next, [by_before, by_value]) = either(before, value);
                    scale(&mut rows[..first], by_before);
                    scale(&mut rows[first..at], by_value);
                    next
                }
            });
        }
        all.unwrap_or(0.0)
    }

    /// E: the sum of the squares of F.
    pub(super) fn error(&self, points: &[DVec3], run: &Run) -> Result<f64, Cancelled> {
        sum_of(points, run, |p| self.value(p).powi(2))
    }

    /// The sum of the squares of the points' distances, to first order.
    pub(super) fn squares(&self, points: &[DVec3], run: &Run) -> Result<f64, Cancelled> {
        sum_of(points, run, |p| self.depth(p).powi(2))
    }

    /// How deep a point is inside, to first order, in length units; negative outside.
    pub(super) fn depth(&self, p: DVec3) -> f64 {
        let part = |part: &Part| part.holes.iter().fold(part.body.depth(p), |all, hole| all.min(-hole.depth(p)));
        self.parts.iter().map(part).fold(f64::NEG_INFINITY, f64::max)
    }

    pub(super) fn count(&self) -> usize {
        self.members().count()
    }
}

/// In the same order for any number of threads.
fn sum_of(points: &[DVec3], run: &Run, of: impl Fn(DVec3) -> f64 + Sync) -> Result<f64, Cancelled> {
    let sum = |chunk: &[DVec3]| {
        run.check()?;
        Ok(chunk.iter().map(|p| of(*p)).sum::<f64>())
    };
    let sums = jobs::try_chunks(points, CHUNK, |_, chunk| sum(chunk))?;
    Ok(sums.into_iter().sum())
}

fn scale(rows: &mut [Row], by: f64) {
    for row in rows {
        for slope in row {
            *slope *= by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::gielis::{Curve, Supershaped, Ties};
    use crate::fit::paper::oriented_box::OrientedBox;
    use crate::fit::paper::truncated::PARAMETERS;
    use crate::fit::random::Random;
    use glam::DMat3;

    fn member(random: &mut Random) -> Truncated {
        let mut unit = || random.below(1 << 24) as f64 / f64::from(1 << 24);
        let mut vector = |low: f64, high: f64| DVec3::new(unit(), unit(), unit()) * (high - low) + low;
        let turn = |v: DVec3| DMat3::from_axis_angle(v.normalize_or(DVec3::X), v.length());
        let curve = |m, n: DVec3| Curve { m, n: n.to_array() };
        let shape = Supershaped {
            equator: curve(5, vector(1.5, 5.0)),
            meridian: curve(4, vector(1.5, 5.0)),
            semi_axes: vector(0.6, 1.4),
            rotation: turn(vector(-1.0, 1.0)),
            center: vector(-0.4, 0.4),
            ties: Ties::Free,
            rational: false,
        };
        let bounds =
            OrientedBox { rotation: turn(vector(-1.0, 1.0)), center: vector(-0.3, 0.3), half: vector(0.5, 1.2) };
        Truncated { shape, bounds, held: [false; 3] }
    }

    /// By central differences over every parameter of two parts, one of them with two holes.
    #[test]
    fn derivatives_of_the_whole_are_those_of_its_value() {
        let mut random = Random::new(7);
        let [a, b, c, d] = std::array::from_fn(|_| member(&mut random));
        let parts = vec![Part { label: 0, body: a, holes: vec![b, c] }, Part { label: 1, body: d, holes: Vec::new() }];
        let whole = Whole { parts };
        let mut rows = vec![[0.0; PARAMETERS]; 4];
        let (mut asked, mut largest) = (0, 0.0f64);
        for _ in 0..40 {
            let mut unit = || 3.0 * (random.below(1 << 24) as f64 / f64::from(1 << 24)) - 1.5;
            let p = DVec3::new(unit(), unit(), unit());
            let value = whole.slopes(p, &mut rows);
            assert!((value - whole.value(p)).abs() < 1e-12);
            for (k, row) in rows.iter().enumerate() {
                for i in 0..PARAMETERS {
                    let at = |by: f64| {
                        let mut other = whole.clone();
                        let mut step = [0.0; PARAMETERS];
                        step[i] = by;
                        let member = other.members_mut().nth(k).unwrap();
                        *member = member.moved(&step);
                        other.value(p)
                    };
                    let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                    // A point on an edge of a box has no slope.
                    let off = (slope - row[i]).abs();
                    assert!(off < 1e-5 * (1.0 + slope.abs()), "member {k}, parameter {i} at {p}: {slope}, {}", row[i]);
                    largest = largest.max(slope.abs());
                    asked += 1;
                }
            }
        }
        assert!(asked == 40 * 4 * PARAMETERS && largest > 1.0);
    }
}
