//! Trims pieces of offset faces along the lines where they end.
//!
//! ```text
//!      a
//!      |\  \          Beyond the line another face is nearer, and values fall off evenly: its ends on two
//!      | \   \        sides are aimed at by slopes. That it is all but straight between them is seen beside
//!     ab--ac   \      it, of all pieces at once.
//!      |    \    \
//!      b-----------c
//! ```

use glam::{DVec2, DVec3};

use super::chart::Chart;
use super::offset_faces::{DEEPEST, Found, Offset, Piece, SMALL};
use crate::mesh::{Slope, Slopes};
use crate::{Cancelled, Run};

/// Where a face ends is found to this part of the tolerance.
const RIM: f64 = 0.2;

/// A line that a face ends along is seen to be straight so many tolerances beside it, at these
/// parts of it.
const BESIDE: f64 = 0.6;
const PARTS: [f64; 3] = [0.25, 0.5, 0.75];

/// A piece that is at the level in places.
pub(super) struct Partial {
    pub(super) piece: Piece,
    pub(super) size: f64,
    /// In its corners.
    pub(super) slopes: [Slope; 3],
    /// Whether it is in more than half of its places.
    pub(super) mostly: bool,
}

/// A line that a piece ends along.
struct Line {
    /// The corner on one side of it, and those on the other.
    corners: [DVec2; 3],
    /// Where it meets the sides from the one corner to the others.
    ends: [DVec2; 2],
    /// Whether the piece is at the level on the side of the one.
    is_one: bool,
    /// Whether it is seen to be straight.
    is_long: bool,
}

/// The corners of a piece by their numbers, the one first that is alone on its side, and whether it
/// is at the level.
struct Corners {
    numbers: [usize; 3],
    is_one: bool,
}

/// A way from a place at the level to one that is not, of whose slope something is known at first.
struct End<'a> {
    chart: &'a Chart,
    inner: DVec2,
    outer: DVec2,
    slope: Option<Slope>,
    was_aimed: bool,
}

/// A place on a way that is asked, and whether a slope has led there.
struct Step {
    middle: DVec2,
    is_aimed: bool,
}

/// What there is of a piece.
enum Trimmed {
    Along(Line),
    /// What is at the level along a side alone is a neighbour's.
    Nothing,
    /// Its corners do not tell.
    Unknown,
}

impl Line {
    /// Places beside it, at its parts: towards the one corner, and away from it.
    fn beside(&self, chart: &Chart, tolerance: f64) -> [DVec3; 2 * PARTS.len()] {
        let [a, ..] = self.corners;
        let place = |n: usize| {
            let middle = self.ends[0].lerp(self.ends[1], PARTS[n / 2]);
            let length = chart.at(middle).distance(chart.at(a)).max(tolerance);
            let step = (BESIDE * tolerance / length).min(0.5) * (a - middle);
            chart.at(if n.is_multiple_of(2) { middle + step } else { middle - step })
        };
        std::array::from_fn(place)
    }

    /// The pieces on the side that is at the level.
    fn pieces(&self, piece: &Piece) -> impl Iterator<Item = Piece> + use<> {
        let ([a, b, c], [ab, ac]) = (self.corners, self.ends);
        let parts = if self.is_one { vec![[a, ab, ac]] } else { vec![[ab, b, c], [ab, c, ac]] };
        let chart = piece.chart;
        parts.into_iter().map(move |corners| Piece { chart, corners, is_trimmed: true })
    }
}

impl Offset<'_> {
    /// Trims pieces to what is at the level; those that end along lines that are not straight are
    /// divided.
    pub(super) fn trim(
        &self,
        (charts, pieces): (&[Chart], &[Partial]),
        (next, found): (&mut Vec<Piece>, &mut Found),
        run: &Run,
    ) -> Result<(), Cancelled> {
        let chart = |own: &Partial| &charts[own.piece.chart as usize];
        let trimmed = self.trimmed(charts, pieces, run)?;
        let mut points = Vec::new();
        for (own, trimmed) in pieces.iter().zip(&trimmed) {
            if let Trimmed::Along(line) = trimmed
                && line.is_long
            {
                points.extend(line.beside(chart(own), self.tolerance));
            }
        }
        let told = self.level.at(&points, run)?;
        let mut told = told.chunks(2);
        for (own, trimmed) in pieces.iter().zip(&trimmed) {
            let is_trimmed = match trimmed {
                Trimmed::Nothing => true,
                Trimmed::Unknown => false,
                Trimmed::Along(line) => {
                    let count = if line.is_long { PARTS.len() } else { 0 };
                    let beside: Vec<&[Slope]> = told.by_ref().take(count).collect();
                    let on = [line.is_one, !line.is_one];
                    let is_straight = beside.iter().all(|own| own.iter().map(|slope| self.is_on(slope.value)).eq(on));
                    if is_straight {
                        next.extend(line.pieces(&own.piece));
                    }
                    is_straight
                }
            };
            if is_trimmed {
                continue;
            }
            if own.size > SMALL * self.tolerance {
                next.extend(own.piece.quarters());
            } else if own.mostly {
                found.patches.push((self.patch(chart(own), &own.piece), own.size));
            }
        }
        Ok(())
    }

    /// Where pieces are trimmed by their corners.
    fn trimmed(&self, charts: &[Chart], pieces: &[Partial], run: &Run) -> Result<Vec<Trimmed>, Cancelled> {
        let chart = |own: &Partial| &charts[own.piece.chart as usize];
        let mut ends = Vec::new();
        for own in pieces {
            let Some(Corners { numbers: [a, b, c], is_one }) = self.corners(own) else { continue };
            let ways = if is_one { [[a, b], [a, c]] } else { [[b, a], [c, a]] };
            ends.extend(ways.map(|[inner, outer]| End {
                chart: chart(own),
                inner: own.piece.corners[inner],
                outer: own.piece.corners[outer],
                slope: Some(own.slopes[outer]),
                was_aimed: false,
            }));
        }
        self.find(&mut ends, run)?;
        let mut ends = ends.into_iter().map(|end| end.inner);
        let along = |own: &Partial| {
            let Some(Corners { numbers, is_one }) = self.corners(own) else { return Trimmed::Unknown };
            let (Some(ab), Some(ac)) = (ends.next(), ends.next()) else { return Trimmed::Unknown };
            let corners @ [a, b, c] = numbers.map(|k| own.piece.corners[k]);
            let apart = |from: DVec2, to: DVec2| chart(own).at(from).distance(chart(own).at(to));
            let width = if is_one { apart(a, ab).min(apart(a, ac)) } else { apart(b, ab).max(apart(c, ac)) };
            if width < self.tolerance {
                return Trimmed::Nothing;
            }
            let is_long = apart(ab, ac) > SMALL * self.tolerance;
            Trimmed::Along(Line { corners, ends: [ab, ac], is_one, is_long })
        };
        Ok(pieces.iter().map(along).collect())
    }

    /// The corners of a piece, the one first that is alone on its side of the level, if there is
    /// one.
    fn corners(&self, Partial { slopes, .. }: &Partial) -> Option<Corners> {
        let on = slopes.map(|slope| self.is_on(slope.value));
        let count = on.iter().filter(|own| **own).count();
        let is_one = count == 1;
        let alone = (0..3).find(|k| on[*k] == is_one).filter(|_| count == 1 || count == 2)?;
        Some(Corners { numbers: [0, 1, 2].map(|k| (alone + k) % 3), is_one })
    }

    /// Finds the last places at the level on ways, all of them step by step.
    fn find(&self, ends: &mut [End<'_>], run: &Run) -> Result<(), Cancelled> {
        let level = Slopes { precision: RIM * self.tolerance, ..*self.level };
        let mut open: Vec<usize> = (0..ends.len()).collect();
        for _ in 0..DEEPEST {
            let mut asked = Vec::with_capacity(open.len());
            open.retain(|n| match self.next(&mut ends[*n]) {
                Some(step) => {
                    asked.push(step);
                    true
                }
                None => false,
            });
            if open.is_empty() {
                break;
            }
            let places: Vec<DVec3> = open.iter().zip(&asked).map(|(n, step)| ends[*n].chart.at(step.middle)).collect();
            let slopes = level.at(&places, run)?;
            for ((n, Step { middle, is_aimed }), slope) in open.iter().zip(asked).zip(slopes) {
                let (end, is_on) = (&mut ends[*n], self.is_on(slope.value));
                if is_on {
                    end.inner = middle;
                } else {
                    (end.outer, end.slope) = (middle, (!is_aimed).then_some(slope));
                }
                end.was_aimed = is_on && is_aimed;
            }
        }
        Ok(())
    }

    /// The place to ask next, if it is not known well enough.
    fn next(&self, end: &mut End<'_>) -> Option<Step> {
        let way = end.chart.at(end.inner) - end.chart.at(end.outer);
        let width = way.length();
        if width <= RIM * self.tolerance {
            return None;
        }
        // A little within it.
        let aimed = end.slope.take().map(|Slope { value, gradient }| {
            let falls = -value.signum() * gradient.dot(way);
            (value.abs() - self.slightest()) / falls + 0.5 * RIM * self.tolerance / width
        });
        let aimed = aimed.filter(|part| *part > 0.0 && *part < 1.0);
        // Once a place is at the level the next one is asked that is not to be.
        let part = aimed.unwrap_or(if end.was_aimed { 1.0 - RIM * self.tolerance / width } else { 0.5 });
        Some(Step { middle: end.outer.lerp(end.inner, part), is_aimed: aimed.is_some() })
    }
}
