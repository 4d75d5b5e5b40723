//! Distances of whole chunks of points.

use super::SurfaceDistance;
use crate::kernel::Element;
use crate::{Chunk, Placement};

impl SurfaceDistance {
    /// The signs of a chunk, as values of the field that has them.
    pub(super) fn signs32(&self, points: [&[f32]; 3], placement: &Placement) -> Vec<f32> {
        let mut signs = vec![0.0; points[0].len()];
        let unscaled = unscaled(placement);
        self.sign.lanes32(Chunk { points, placement: &unscaled, out: [&mut signs] });
        signs
    }

    pub(super) fn signs64(&self, points: [&[f64]; 3], placement: &Placement) -> Vec<f64> {
        let mut signs = vec![0.0; points[0].len()];
        let unscaled = unscaled(placement);
        self.sign.lanes64(Chunk { points, placement: &unscaled, out: [&mut signs] });
        signs
    }

    /// Values, point by point.
    pub(super) fn values_by_point<E: Element>(&self, chunk: Chunk<'_, E, 1>, signs: &[E]) {
        let Chunk { points: [x, y, z], placement, out: [out] } = chunk;
        for (i, to) in out.iter_mut().enumerate() {
            let p = placement.apply([x[i], y[i], z[i]].map(E::to_f64));
            *to = E::from_f64(placement.finish(self.signed(p, signs[i].to_f64())));
        }
    }

    /// Values and gradients, point by point.
    pub(super) fn gradients_by_point(&self, chunk: Chunk<'_, f32, 4>, signs: &[f32]) {
        let Chunk { points: [x, y, z], placement, out } = chunk;
        for i in 0..signs.len() {
            let p = placement.apply([x[i], y[i], z[i]].map(f64::from));
            let (value, slope) = self.signed_with_slope(p, f64::from(signs[i]));
            let slope = placement.pull(slope.map(|part| part * placement.scale));
            out[0][i] = placement.finish(value) as f32;
            for axis in 0..3 {
                out[axis + 1][i] = slope[axis] as f32;
            }
        }
    }
}

/// The same place, the value as it is.
fn unscaled(placement: &Placement) -> Placement {
    let mut unscaled = *placement;
    (unscaled.scale, unscaled.shift) = (1.0, 0.0);
    unscaled
}
