//! Values of a program at many points.

use glam::DVec3;
use rvachev_num::{Meter, jobs};

use super::point::limited;
use super::program::Program;
use super::tape::{Evaluator, Tape};
use crate::{Bounds, Cancelled, Run};

/// Points on lanes at once: as many as a pass of the tape takes.
const MOST: usize = 256;

/// Of a long program they are fewer: so many values of leaves take some milliseconds.
const VALUES: usize = 1 << 20;

impl Program {
    /// The values at `count` points, each told by its number, on lanes of `f64`.
    pub(crate) fn sampled(
        &self,
        count: usize,
        point: impl Fn(usize) -> DVec3 + Sync,
        run: &Run,
    ) -> Result<Vec<f64>, Cancelled> {
        let tape = Tape::new(self, &Bounds::new(DVec3::ZERO, DVec3::ZERO));
        let at_once = (VALUES / self.leaf_count().max(1)).clamp(8, MOST);
        let meter = Meter::new(run, count.div_ceil(at_once));
        let mut values = vec![0.0; count];
        let chunks = values.chunks_mut(at_once).enumerate().collect();
        jobs::try_taking_with(chunks, Evaluator::new, |evaluator, (chunk, values): (usize, &mut [f64])| {
            meter.step()?;
            let mut axes = [[0.0; MOST]; 3];
            for i in 0..values.len() {
                let p = limited(point(chunk * at_once + i));
                for (axis, coordinate) in axes.iter_mut().zip(p) {
                    axis[i] = coordinate;
                }
            }
            evaluator.shortest_values_f64(&tape, axes.each_ref().map(|axis| &axis[..values.len()]), values);
            Ok(())
        })?;
        Ok(values)
    }
}
