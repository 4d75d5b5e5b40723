//! The refinement of rows of numbers, compiled for the machine's SIMD level.
//!
//! A polygon is a flat row of numbers, the coordinates of a point side by side: the mask is the
//! same for all of them, so a point of any dimension is a stride.

use crate::num::kernel::{Task, dispatched};

/// One level: from `from`, whose points have `N` coordinates, to `to` of twice the length. Point i
/// of `from` gives points 2i (by the mask) and 2i + 1 (the middle of the side after it).
///
/// Closed: every point has neighbours. Open: the first and the last have but one, and the
/// points that would need the others are not made; `to` begins with the middle of the first side.
pub(super) fn refine<const N: usize>(from: &[[f64; N]], closed: bool, mask: [f64; 2], to: &mut Vec<[f64; N]>) {
    let count = from.len();
    let new = if closed { 2 * count } else { (2 * count).saturating_sub(3) };
    to.resize(new, [0.0; N]);
    if new == 0 {
        return;
    }
    let middle = |a: [f64; N], b: [f64; N]| -> [f64; N] { std::array::from_fn(|k| 0.5 * (a[k] + b[k])) };
    if closed {
        let [neighbour, own] = mask;
        let (first, last) = (from[0], from[count - 1]);
        let at = |a: [f64; N], p: [f64; N], b: [f64; N]| -> [f64; N] {
            std::array::from_fn(|k| (a[k] + b[k]) * neighbour + p[k] * own)
        };
        to[0] = at(last, first, from[1 % count]);
        to[2 * count - 1] = middle(last, first);
        if count > 1 {
            to[2 * count - 2] = at(from[count - 2], last, first);
            to[1] = middle(first, from[1]);
        }
    } else {
        to[0] = middle(from[0], from[1]);
    }
    if count < 3 {
        return;
    }
    // Points 1 to count − 2, each with the side after it.
    let to = if closed { &mut to[2..2 * count - 2] } else { &mut to[1..] };
    dispatched(Interior { from, to, mask });
}

struct Interior<'a, const N: usize> {
    from: &'a [[f64; N]],
    to: &'a mut [[f64; N]],
    mask: [f64; 2],
}

impl<const N: usize> Task for Interior<'_, N> {
    #[inline(always)]
    fn run(self) {
        let [neighbour, own] = self.mask;
        for (window, pair) in self.from.windows(3).zip(self.to.chunks_exact_mut(2)) {
            let (a, p, b) = (window[0], window[1], window[2]);
            for k in 0..N {
                pair[0][k] = (a[k] + b[k]) * neighbour + p[k] * own;
                pair[1][k] = 0.5 * (p[k] + b[k]);
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
