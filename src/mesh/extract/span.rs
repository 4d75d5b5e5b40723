//! Boxes of cells.

use glam::Vec3A;

/// A box of cells: from the first to the last, exclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) low: [u32; 3],
    pub(super) high: [u32; 3],
}

impl Span {
    pub(super) fn single(cell: [u32; 3]) -> Span {
        let [x, y, z] = cell;
        Span { low: cell, high: [x + 1, y + 1, z + 1] }
    }

    /// Whether it is one cell.
    pub(super) fn is_single(&self) -> bool {
        self.is_small(1)
    }

    /// The smallest that holds both.
    pub(super) fn union(&self, other: &Span) -> Span {
        let low = std::array::from_fn(|axis| self.low[axis].min(other.low[axis]));
        Span { low, high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])) }
    }

    /// What both hold, if there is any.
    pub(super) fn intersection(&self, other: &Span) -> Span {
        let low = std::array::from_fn(|axis| self.low[axis].max(other.low[axis]));
        Span { low, high: std::array::from_fn(|axis| self.high[axis].min(other.high[axis])) }
    }

    /// Whether it has at most so many cells along each axis.
    pub(super) fn is_small(&self, most: u32) -> bool {
        (0..3).all(|axis| self.high[axis] - self.low[axis] <= most)
    }

    /// Whether it is one cell thick along an axis.
    pub(super) fn is_slab(&self, axis: usize) -> bool {
        self.low[axis] + 1 == self.high[axis]
    }

    /// Whether a face of one of its cells, by twice the axis and 1 more for the upper one, is in a
    /// side of it.
    #[inline(always)]
    pub(super) fn is_side(&self, cell: [u32; 3], face: u8) -> bool {
        let axis = usize::from(face / 2);
        let is_upper = face % 2 == 1;
        if is_upper { cell[axis] + 1 == self.high[axis] } else { cell[axis] == self.low[axis] }
    }

    /// How many cells it has along each axis.
    pub(super) fn size(&self) -> Vec3A {
        offset(self.high, self.low)
    }

    /// Where a line from within leaves it: the next cell, and for how long the line is in that.
    /// None if it leaves it by one of the faces that are ruled out, by a bit for each: that of
    /// twice the axis, and 1 more for the upper one. The line's start is in cells from the first
    /// node of the box.
    #[inline]
    pub(super) fn exit(&self, from: Vec3A, along: Vec3A, ruled_out: u8) -> Option<([u32; 3], f32)> {
        let (axis, start) = way_out(Vec3A::ZERO, self.size(), from, along);
        let is_upper = along[axis] > 0.0;
        if ruled_out >> (2 * axis + usize::from(is_upper)) & 1 == 1 {
            return None;
        }
        let at = from + start * along;
        let mut cell: [u32; 3] = std::array::from_fn(|n| {
            self.low[n].saturating_add(at[n].max(0.0) as u32).clamp(self.low[n], self.high[n] - 1)
        });
        cell[axis] = if is_upper { self.high[axis] } else { self.low[axis].checked_sub(1)? };
        let low = offset(cell, self.low);
        let (_, end) = way_out(low, low + 1.0, from, along);
        Some((cell, end - start))
    }

    /// Whether [`exit`](Span::exit) finds no way out of a single cell, either way along a line.
    #[inline]
    pub(super) fn is_shut(from: Vec3A, along: Vec3A, ruled_out: u8) -> bool {
        let share = along.recip();
        let (low, high) = (-from * share, (1.0 - from) * share);
        // A line across an axis never leaves along it: both are infinite, or NaN at a side.
        let (axis, other) = (low.max(high).min_position(), low.min(high).max_position());
        let face = |axis: usize, is_upper: bool| ruled_out >> (2 * axis + usize::from(is_upper)) & 1 == 1;
        face(axis, along[axis] > 0.0) && face(other, along[other] < 0.0)
    }

    pub(super) fn cells(self) -> impl Iterator<Item = [u32; 3]> {
        let Span { low, high } = self;
        let rows = (low[2]..high[2]).flat_map(move |k| (low[1]..high[1]).map(move |j| [j, k]));
        rows.flat_map(move |[j, k]| (low[0]..high[0]).map(move |i| [i, j, k]))
    }
}

/// The way from one cell to another, in cells.
pub(super) fn offset(to: [u32; 3], from: [u32; 3]) -> Vec3A {
    Vec3A::from_array(std::array::from_fn(|axis| (i64::from(to[axis]) - i64::from(from[axis])) as f32))
}

/// The axis along which a line from within leaves a box, and after how long.
#[inline]
fn way_out(low: Vec3A, high: Vec3A, from: Vec3A, along: Vec3A) -> (usize, f32) {
    let side = Vec3A::select(along.cmpgt(Vec3A::ZERO), high, low);
    // A line across an axis never leaves along it, whatever the sign of that 0.
    let parts = ((side - from) / along).abs();
    (parts.min_position(), parts.min_element())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_along_an_axis_leaves_along_that() {
        let span = Span::single([3, 4, 5]);
        let from = Vec3A::new(0.25, 0.5, 0.75);
        for faces in 0..64 {
            for along in [Vec3A::X, Vec3A::NEG_Z, Vec3A::new(-0.6, -0.0, 0.8), Vec3A::new(1.0, 2.0, -3.0)] {
                let is_shut = [along, -along].iter().all(|&along| span.exit(from, along, faces).is_none());
                assert_eq!(Span::is_shut(from, along, faces), is_shut, "{along}, {faces}");
            }
        }
        for zero in [0.0, -0.0] {
            let up = Vec3A::new(1.0, zero, zero);
            assert_eq!(span.exit(from, up, 0), Some(([4, 4, 5], 1.0)));
            assert_eq!(span.exit(from, -up, 0), Some(([2, 4, 5], 1.0)));
            // The upper face along x is ruled out, the lower is not.
            assert_eq!(span.exit(from, up, 0b10), None);
            assert_eq!(span.exit(from, -up, 0b10), Some(([2, 4, 5], 1.0)));
        }
        let (cell, length) = span.exit(from, Vec3A::new(0.0, 0.6, 0.8), 0).unwrap();
        assert_eq!(cell, [3, 4, 6]);
        // Up by 0.25 it is at y = 0.6875, and leaves the next cell there after 0.3125 of y.
        assert!((length - 0.3125 / 0.6).abs() < 1e-6, "{length}");
    }
}
