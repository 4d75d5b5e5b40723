//! The contours of a slice.

use std::ops::Deref;

use glam::DVec2;

use super::Polyline;

/// The contours of a solid on a plane: closed, nested, the inside to the left of each, so that
/// outlines run anticlockwise and holes clockwise; and how many places were left undecided.
///
/// It is a list of [`Polyline`]s wherever one is wanted.
///
/// ```
/// use rvachev::{Plane, Solid};
///
/// let part = Solid::cuboid([4.0, 3.0, 2.0]) - Solid::cylinder(1.0, 3.0);
/// let contours = part.slice(&Plane::xy(0.0))?.contours(1e-4)?;
/// assert_eq!((contours.len(), contours.unresolved()), (2, 0));
/// assert!((contours.area() - (12.0 - std::f64::consts::PI)).abs() < 2e-3);
/// let outlines = contours.outlines();
/// assert_eq!(outlines.len(), 1);
/// assert!((outlines[0].outer.area() - 12.0).abs() < 1e-9 && outlines[0].holes.len() == 1);
/// # Ok::<(), rvachev::error::RenderError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Contours {
    lines: Vec<Polyline>,
    unresolved: usize,
}

/// The border of one connected area, and of the holes in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline<'a> {
    /// Around it, anticlockwise.
    pub outer: &'a Polyline,
    /// Around its holes, clockwise.
    pub holes: Vec<&'a Polyline>,
}

impl Contours {
    pub(crate) fn new(lines: Vec<Polyline>, unresolved: usize) -> Contours {
        Contours { lines, unresolved }
    }

    /// The contours.
    #[must_use]
    pub fn lines(&self) -> &[Polyline] {
        &self.lines
    }

    /// In so many places it was left undecided what is there: a sheet or a hole that is thinner
    /// than the tolerance, no nearer to a contour than that, the thin end of a gap or a tip, a
    /// point where two contours touch; at a tolerance that is very fine for its solid, a contour
    /// that was not followed any further; or what only samples show, where ranges of a field tell
    /// nothing.
    #[must_use]
    pub fn unresolved(&self) -> usize {
        self.unresolved
    }

    /// The area that they enclose, holes taken off.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.lines.iter().fold(0.0, |sum, line| sum + line.area())
    }

    /// Every outline with the holes that are in it; an island within a hole is an outline of its
    /// own.
    #[must_use]
    pub fn outlines(&self) -> Vec<Outline<'_>> {
        let areas: Vec<f64> = self.lines.iter().map(Polyline::area).collect();
        let lines = || self.lines.iter().zip(&areas);
        let outer: Vec<_> =
            lines().filter(|(_, area)| **area > 0.0).map(|(line, area)| (extent(line), *area)).collect();
        let outlines = lines().filter(|(_, area)| **area > 0.0);
        let mut outlines: Vec<_> = outlines.map(|(outer, _)| Outline { outer, holes: Vec::new() }).collect();
        for (hole, area) in lines().filter(|(_, area)| area.is_nan() || **area <= 0.0) {
            let Some(&p) = hole.points().first() else { continue };
            let is_around = |number: &usize| {
                let ([min, max], around) = outer[*number];
                around > -area && p.cmpge(min).all() && p.cmple(max).all() && outlines[*number].outer.winds_about(p)
            };
            // The innermost of those around it.
            let around = (0..outer.len()).filter(is_around).min_by(|a, b| outer[*a].1.total_cmp(&outer[*b].1));
            if let Some(number) = around {
                outlines[number].holes.push(hole);
            }
        }
        outlines
    }
}

/// The corners of a polyline's box.
fn extent(line: &Polyline) -> [DVec2; 2] {
    let fold = |start: DVec2, of: fn(DVec2, DVec2) -> DVec2| line.points().iter().copied().fold(start, of);
    [fold(DVec2::INFINITY, DVec2::min), fold(DVec2::NEG_INFINITY, DVec2::max)]
}

impl Deref for Contours {
    type Target = [Polyline];

    fn deref(&self) -> &[Polyline] {
        &self.lines
    }
}

impl IntoIterator for Contours {
    type Item = Polyline;
    type IntoIter = std::vec::IntoIter<Polyline>;

    fn into_iter(self) -> Self::IntoIter {
        self.lines.into_iter()
    }
}

impl<'a> IntoIterator for &'a Contours {
    type Item = &'a Polyline;
    type IntoIter = std::slice::Iter<'a, Polyline>;

    fn into_iter(self) -> Self::IntoIter {
        self.lines.iter()
    }
}
