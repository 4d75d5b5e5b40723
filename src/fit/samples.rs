//! Points in columns, padded to whole vectors.

use glam::DVec3;

use super::kernel::Number;

/// Whole pairs of vectors of any SIMD level.
const WIDTH: usize = 32;

/// Points in columns. The padding repeats the last point; its weights are to be 0.
pub(super) struct Samples<E> {
    columns: [Vec<E>; 3],
    len: usize,
}

impl<E: Number> Samples<E> {
    pub(super) fn new(points: impl ExactSizeIterator<Item = DVec3>) -> Samples<E> {
        let len = points.len();
        let padded = len.next_multiple_of(WIDTH);
        let mut columns = [(); 3].map(|()| Vec::with_capacity(padded));
        for point in points {
            for (column, x) in columns.iter_mut().zip(point.to_array()) {
                column.push(E::of(x));
            }
        }
        for column in &mut columns {
            let last = column.last().copied().unwrap_or_default();
            column.resize(padded, last);
        }
        Samples { columns, len }
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn padded(&self) -> usize {
        self.columns[0].len()
    }

    pub(super) fn columns(&self) -> [&[E]; 3] {
        self.columns.each_ref().map(Vec::as_slice)
    }
}
