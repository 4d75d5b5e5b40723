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
use rvachev_num::jobs;

use super::chart::Chart;
use super::offset_faces::{DEEPEST, Found, Offset, Piece, SMALL};
use crate::mesh::Slope;
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
        let trimmed = jobs::try_in_order(pieces.len(), |n| {
            run.check()?;
            Ok(self.trimmed(chart(&pieces[n]), &pieces[n]))
        })?;
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

    /// Where a piece is trimmed by its corners.
    fn trimmed(&self, chart: &Chart, Partial { piece, slopes, .. }: &Partial) -> Trimmed {
        let apart = |from: DVec2, to: DVec2| chart.at(from).distance(chart.at(to));
        let on = slopes.map(|slope| self.is_on(slope.value));
        let count = on.iter().filter(|own| **own).count();
        if count == 0 || count == 3 {
            return Trimmed::Unknown;
        }
        let is_one = count == 1;
        // The corner that is alone on its side of the line.
        let alone = (0..3).find(|k| on[*k] == is_one).unwrap_or(0);
        let corners @ [a, b, c] = [0, 1, 2].map(|k| piece.corners[(alone + k) % 3]);
        let [of_a, of_b, of_c] = [0, 1, 2].map(|k| slopes[(alone + k) % 3]);
        let end = |inner: DVec2, outer: DVec2, slope: Slope| self.end(chart, [inner, outer], slope);
        let ends @ [ab, ac] =
            if is_one { [end(a, b, of_b), end(a, c, of_c)] } else { [end(b, a, of_a), end(c, a, of_a)] };
        let width = if is_one { apart(a, ab).min(apart(a, ac)) } else { apart(b, ab).max(apart(c, ac)) };
        if width < self.tolerance {
            return Trimmed::Nothing;
        }
        Trimmed::Along(Line { corners, ends, is_one, is_long: apart(ab, ac) > SMALL * self.tolerance })
    }

    /// The last place at the level on the way from one that is to one that is not, whose slope is
    /// known.
    fn end(&self, chart: &Chart, [mut inner, mut outer]: [DVec2; 2], slope: Slope) -> DVec2 {
        let (mut slope, mut was_aimed) = (Some(slope), false);
        for _ in 0..DEEPEST {
            let way = chart.at(inner) - chart.at(outer);
            let width = way.length();
            if width <= RIM * self.tolerance {
                break;
            }
            // A little within it.
            let aimed = slope.take().map(|Slope { value, gradient }| {
                let falls = -value.signum() * gradient.dot(way);
                (value.abs() - self.slightest()) / falls + 0.5 * RIM * self.tolerance / width
            });
            let aimed = aimed.filter(|part| *part > 0.0 && *part < 1.0);
            // Once a place is at the level the next one is asked that is not to be.
            let part = aimed.unwrap_or(if was_aimed { 1.0 - RIM * self.tolerance / width } else { 0.5 });
            let middle = outer.lerp(inner, part);
            let (value, gradient) = self.level.program.gradient(chart.at(middle));
            let is_on = self.is_on(value);
            if is_on {
                inner = middle;
            } else {
                (outer, slope) = (middle, aimed.is_none().then_some(Slope { value, gradient }));
            }
            was_aimed = is_on && aimed.is_some();
        }
        inner
    }
}
