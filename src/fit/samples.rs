//! Points in columns, padded to whole vectors.

use glam::DVec3;

use super::kernel::Number;

/// Whole pairs of vectors of any SIMD level.
const WIDTH: usize = 32;

/// Points in columns. The padding repeats the last point; its weights are to be 0.
pub(super) struct Samples<E> {
    columns: [Vec<E>; 3],
    counts: Vec<E>,
    len: usize,
}

impl<E: Number> Samples<E> {
    pub(super) fn new(points: impl ExactSizeIterator<Item = DVec3>) -> Samples<E> {
        let len = points.len();
        let padded = len.next_multiple_of(WIDTH);
        let mut columns = [(); 3].map(|()| vec![E::default(); padded]);
        let [xs, ys, zs] = &mut columns;
        for (((x, y), z), point) in xs.iter_mut().zip(ys).zip(zs).zip(points) {
            (*x, *y, *z) = (E::of(point.x), E::of(point.y), E::of(point.z));
        }
        for column in &mut columns {
            let last = column[..len].last().copied().unwrap_or_default();
            column[len..].fill(last);
        }
        let mut counts = vec![E::of(1.0); len];
        counts.resize(padded, E::default());
        Samples { columns, counts, len }
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

    /// 1 for each point, 0 for the padding.
    pub(super) fn counts(&self) -> &[E] {
        &self.counts
    }
}
