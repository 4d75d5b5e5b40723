//! The refinement of rows of numbers, compiled for the machine's SIMD level.
//!
//! A polygon is a flat row of numbers, the coordinates of a point side by side: the mask is the
//! same for all of them, so a point of any dimension is a stride.
//!
//! ```text
//!     |p0 p1 p2 p3|           |      a level goes through its row from the end: point i and the
//!     |p0 p1 p2 p3|   ... q6 q7|      side after it become points 2i and 2i + 1, where nothing is
//!     |q0 q1 q2 q3 q4 q5 q6 q7|      that is still to be read
//! ```
//!
//! So there is one row, of its final length from the beginning: fresh memory costs more than
//! the arithmetic.

use rvachev_field::kernel::{Task, dispatched};

/// Points of a row after a level.
pub(super) fn refined_len(count: usize, closed: bool) -> usize {
    if closed { 2 * count } else { (2 * count).saturating_sub(3) }
}

/// One level: the first `count` points of `points` become the first
/// [`refined_len`] of them. Point i gives points 2i (by the mask) and 2i + 1 (the middle of the
/// side after it).
///
/// Closed: every point has neighbours. Open: the first and the last have but one, and the
/// points that would need the others are not made; the row begins with the middle of the first
/// side.
pub(super) fn refine<const N: usize>(points: &mut [[f64; N]], count: usize, closed: bool, mask: [f64; 2]) {
    if count < 3 {
        return;
    }
    dispatched(Level { points, count, closed, mask });
}

/// Points that are read before any of theirs is written.
const BLOCK: usize = 128;

struct Level<'a, const N: usize> {
    points: &'a mut [[f64; N]],
    count: usize,
    closed: bool,
    mask: [f64; 2],
}

impl<const N: usize> Task for Level<'_, N> {
    #[inline(always)]
    fn run(self) {
        let Level { points, count, closed, mask: [neighbour, own] } = self;
        let (first, second, last) = (points[0], points[1], points[count - 1]);
        let (least, most) = if closed { (0, count) } else { (1, count - 1) };
        let mut read = [[0.0; N]; BLOCK + 2];
        let mut end = most;
        while end > least {
            let start = least.max(end.saturating_sub(BLOCK));
            let len = end - start;
            read[0] = if start == 0 { last } else { points[start - 1] };
            read[1..=len].copy_from_slice(&points[start..end]);
            read[len + 1] = if end == count { first } else { points[end] };
            let to = if closed { 2 * start } else { 2 * start - 1 };
            let (from, to) = (&read[..len + 2], &mut points[to..to + 2 * len]);
            // Without iterators: what is not inlined here would not be compiled for the level.
            let mut i = 0;
            while i < len {
                let (a, p, b) = (from[i], from[i + 1], from[i + 2]);
                let mut k = 0;
                while k < N {
                    to[2 * i][k] = (a[k] + b[k]) * neighbour + p[k] * own;
                    to[2 * i + 1][k] = 0.5 * (p[k] + b[k]);
                    k += 1;
                }
                i += 1;
            }
            end = start;
        }
        if !closed {
            let mut k = 0;
            while k < N {
                points[0][k] = 0.5 * (first[k] + second[k]);
                k += 1;
            }
        }
    }
}

/// A combination of each point with its neighbours: `weights` of `[before, own, after]`; of an
/// open row without its ends.
pub(super) fn stencil<const N: usize>(from: &[[f64; N]], closed: bool, weights: [f64; 3]) -> Vec<[f64; N]> {
    let [before, own, after] = weights;
    let at = |a: [f64; N], p: [f64; N], b: [f64; N]| -> [f64; N] {
        if before == after {
            // Symmetric, so that mirror images stay mirror images to the last digit.
            std::array::from_fn(|k| (a[k] + b[k]) * before + p[k] * own)
        } else {
            std::array::from_fn(|k| a[k] * before + p[k] * own + b[k] * after)
        }
    };
    let count = from.len();
    if closed {
        (0..count).map(|i| at(from[(i + count - 1) % count], from[i], from[(i + 1) % count])).collect()
    } else {
        from.windows(3).map(|w| at(w[0], w[1], w[2])).collect()
    }
}
