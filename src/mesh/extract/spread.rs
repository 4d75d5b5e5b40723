//! Cells whose normals differ as those of a crease do, and which of them are round all the same.
//!
//! ```text
//!         _.-x-._               _x_          The normals at the vertices of a roof may be those of an arc. But the
//!       .'   |   '.           .' | '.        tangent planes meet twice as high above the middle as the arc is, and
//!     o'     c     'o      _o'   c   'o_     at the height of the roof's ridge: the field in the middle tells
//!                                            them apart.
//! ```
//!
//! Where the surface has the height h(x) = −½ xᵀKx, and x are the ways to the vertices from their
//! middle c, the surface is above c by half the mean height of their tangent planes, and its normal
//! there is the mean of theirs: see [`curvature`](super::curvature). Of a crease, flat on both
//! sides, neither holds:
//!
//! * If the sides are joined by min or max, the normal next to c is that of one of them. It differs
//!   from the mean by √((n − k)/k) standard deviations of the normals, where k of n vertices are on
//!   that side: by .41 at least, for up to seven vertices. From the mean's direction it differs by
//!   less if they are more than a right angle apart, but then the height is off.
//! * If they are joined by an R-function, the normal turns from the one to the other: it is the
//!   mean near the ridge alone, where the surface is as high as the tangent planes are.

use glam::Vec3A;

use super::curvature::Middle;
use super::probe::{OFF, is_beyond};
use super::samples::cell_of;
use crate::mesh::feature::{INSET, Segment, Slope};

/// The farthest that the vertex in the middle of a round cell may be off the surface, in cells.
const ROUND: f32 = 1.5 * OFF;

/// A cell whose normals differ as those of a crease do.
pub(super) struct Spread<'a> {
    /// Its number in the block.
    pub(super) number: u16,
    /// The segments of its loop, and where their vertices are, in cells from the cell's first node.
    pub(super) segments: &'a mut [Segment],
    pub(super) places: &'a [Vec3A],
    /// The vertex in its middle and the unit normal there, in cells from the block's first node, if
    /// it is round.
    pub(super) top: Option<(Vec3A, Vec3A)>,
}

/// Those of a block, to be looked at together.
#[derive(Default)]
pub(super) struct Spreads {
    /// Their numbers, and what they have in the middle.
    cells: Vec<(u16, Middle)>,
    /// Where that is: in cells from the block's first node.
    middles: Vec<Vec3A>,
    /// The segments of all, cell after cell; and the places of their vertices.
    segments: Vec<Segment>,
    places: Vec<Vec3A>,
    /// The field at points.
    found: Vec<Slope>,
}

impl Spreads {
    /// Forgets all cells.
    pub(super) fn clear(&mut self) {
        let Spreads { cells, middles, segments, places, found } = self;
        cells.clear();
        middles.clear();
        segments.clear();
        places.clear();
        found.clear();
    }

    /// Adds a cell by its number in the block. Places are in cells from its first node.
    #[inline(always)]
    pub(super) fn add(&mut self, number: u16, middle: Middle, segments: &[Segment], places: &[Vec3A]) {
        self.middles.push(middle.at);
        self.cells.push((number, middle));
        self.segments.extend_from_slice(segments);
        self.places.extend_from_slice(places);
    }

    /// Tells `each` of the cells which it is. `slopes` tells values and gradients at points, in
    /// cells from the block's first node, for cells of size `step`; without any, none is round.
    pub(super) fn look(
        &mut self,
        step: f32,
        mut slopes: impl FnMut(&[Vec3A], &mut Vec<Slope>) -> bool,
        mut each: impl FnMut(Spread<'_>),
    ) {
        let Spreads { cells, middles, segments, places, found } = self;
        if cells.is_empty() {
            return;
        }
        let mut ask = |points: &[Vec3A]| {
            found.clear();
            if !slopes(points, found) || found.len() != points.len() {
                found.clear();
            }
            found.clone()
        };
        let of_middles = ask(middles);
        let top = |(n, (number, middle)): (usize, &(u16, Middle))| {
            let (at, normal) = middle.top(of_middles.get(n)?, step)?;
            let low = Vec3A::from_array(cell_of([0; 3], *number).map(|at| at as f32));
            Some((at.clamp(low + INSET, low + (1.0 - INSET)), normal))
        };
        let tops: Vec<Option<(Vec3A, Vec3A)>> = cells.iter().enumerate().map(top).collect();
        // Held within its cell it is off the surface: a little, or there are creases.
        let points: Vec<Vec3A> = tops.iter().flatten().map(|(at, _)| *at).collect();
        let mut off = ask(&points).into_iter().map(|slope| is_beyond(&slope, ROUND * step));
        let mut tops = tops.into_iter().map(|top| top.filter(|_| !off.next().unwrap_or(false)));
        let (mut segments, mut places) = (&mut segments[..], &places[..]);
        for (number, middle) in &*cells {
            let own = segments.split_off_mut(..middle.count).unwrap_or_default();
            let (at, rest) = places.split_at(own.len());
            places = rest;
            each(Spread { number: *number, segments: own, places: at, top: tops.next().flatten() });
        }
    }
}
