//! Some of the points of a chunk, close together: work goes on only where it has to.

use super::chain::{Column, columns};
use crate::kernel::CHUNK;

pub(super) const NONE: Column = [0.0; CHUNK];

/// Lanes run over multiples of this many points.
const GRANULE: usize = 64;

/// The points that are still searched from, close together; which of the chunk they are, and
/// their state.
pub(super) struct Lanes<const K: usize> {
    pub(super) count: usize,
    pub(super) from: [usize; CHUNK],
    points: [Column; 3],
    pub(super) state: [Column; K],
    /// Whether fewer than a chunk can be run.
    short: bool,
}

impl<const K: usize> Lanes<K> {
    /// The points of a chunk of which `asked` holds, to be gathered.
    pub(super) fn new(asked: &[bool], short: bool) -> Lanes<K> {
        let mut from = [0; CHUNK];
        let mut count = 0;
        for (i, asked) in asked.iter().enumerate() {
            if *asked {
                from[count] = i;
                count += 1;
            }
        }
        Lanes { count, from, points: [NONE; 3], state: [NONE; K], short }
    }

    /// How many to run.
    pub(super) fn len(&self) -> usize {
        if self.short { self.count.next_multiple_of(GRANULE) } else { CHUNK }
    }

    /// Takes what the points at `self.from` have of the chunk; `what` says which columns they
    /// start with.
    pub(super) fn gather(&mut self, points: [&[f32]; 3], what: [&Column; K]) {
        for (to, from) in self.points.iter_mut().zip(points) {
            for lane in 0..self.count {
                to[lane] = from[self.from[lane]];
            }
        }
        for (to, from) in self.state.iter_mut().zip(what) {
            for lane in 0..self.count {
                to[lane] = from[self.from[lane]];
            }
        }
    }

    /// Writes the best points, which start at a column, to the chunk's.
    pub(super) fn scatter(&self, at: usize, best: &mut [Column; 7]) {
        for (to, from) in best.iter_mut().zip(&self.state[at..at + 7]) {
            for lane in 0..self.count {
                to[self.from[lane]] = from[lane];
            }
        }
    }

    /// Keeps those that are not `left < 0`, in their order: NaN is no rest.
    pub(super) fn keep(&mut self, left: &Column) {
        let mut kept = [0; CHUNK];
        let mut count = 0;
        for (lane, left) in left[..self.count].iter().enumerate() {
            kept[count] = lane;
            count += usize::from(*left >= 0.0 || left.is_nan());
        }
        if count < self.count {
            for column in self.points.iter_mut().chain(&mut self.state) {
                for (to, from) in kept[..count].iter().enumerate() {
                    column[to] = column[*from];
                }
            }
            for (to, from) in kept[..count].iter().enumerate() {
                self.from[to] = self.from[*from];
            }
            self.count = count;
        }
    }

    pub(super) fn points(&self) -> [&[f32]; 3] {
        columns(&self.points, self.len())
    }
}
