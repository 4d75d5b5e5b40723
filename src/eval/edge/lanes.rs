//! Edge blends over chunks of points, on lanes.

use super::chamfer::Chamfer;
use super::fillet::Fillet;
use super::sides::{Side, join};
use super::{EdgeBlend, Sample, Shape, TURN_OF_LANES, larger};
use crate::eval::composite::{Locals, Slopes, with_evaluator};
use crate::eval::{Evaluator, Tape};

impl EdgeBlend {
    /// Values and gradients of a chunk; without `steep` gradients are the join's.
    pub(super) fn chunk(&self, local: &Locals, tapes: [&Tape; 2], steep: bool) -> Slopes {
        with_evaluator(|evaluator| {
            let mut sample =
                |at: &Locals| -> Pair { Pair([0, 1].map(|i| at.gradients(evaluator, tapes[i]).times(self.signs[i]))) };
            let here = sample(local);
            let mut out = Slopes::default();
            for i in 0..local.count {
                let [x, y] = here.at(i);
                out.set(i, larger(x, y));
            }
            match &self.shape {
                Shape::Fillet(fillet, sides) => {
                    self.filleted_lanes((*fillet, sides), local, &here, evaluator, &mut out)
                }
                Shape::Chamfer(chamfer) => self.chamfered_lanes(*chamfer, local, &here, &mut sample, &mut out, steep),
            }
            out.times(self.sign)
        })
    }

    fn filleted_lanes(
        &self,
        (fillet, sides): (Fillet, &[Side; 2]),
        local: &Locals,
        here: &Pair,
        evaluator: &mut Evaluator,
        out: &mut Slopes,
    ) {
        let near: Vec<bool> = (0..local.count).map(|i| fillet.near(here.at(i).map(|(value, _)| value))).collect();
        if !near.contains(&true) {
            return;
        }
        let parts = [0, 1].map(|i| sides[i].lanes(&here.0[i], local, evaluator));
        let mut pairs = Vec::with_capacity(parts[0].len() * parts[1].len());
        for (first, x) in sides[0].parts.iter().zip(&parts[0]) {
            for (second, y) in sides[1].parts.iter().zip(&parts[1]) {
                pairs.push(fillet.lanes_between([first, second], [x, y], (local, &near), evaluator));
            }
        }
        for i in (0..local.count).filter(|&i| near[i]) {
            let blend = join(sides, |a, b| match &pairs[a * parts[1].len() + b] {
                Some(blend) => blend.at(i),
                None => larger(parts[0][a].at(i), parts[1][b].at(i)),
            });
            out.set(i, larger(blend, out.at(i)));
        }
    }

    fn chamfered_lanes(
        &self,
        chamfer: Chamfer,
        local: &Locals,
        here: &Pair,
        sample: &mut impl FnMut(&Locals) -> Pair,
        out: &mut Slopes,
        steep: bool,
    ) {
        let mut faces = Vec::new();
        for i in 0..local.count {
            let sides = here.at(i);
            let height = chamfer.height(sides);
            if self.near(sides.map(|(value, _)| value)) && height > out.at(i).0 {
                out.value[i] = height as f32;
                faces.push(i);
            }
        }
        if faces.is_empty() || !steep {
            return;
        }
        let by = TURN_OF_LANES * chamfer.leg;
        let beside = [0, 1].map(|side| {
            let mut at = Locals { ..*local };
            for &i in &faces {
                at.set(i, local.get(i) + by * chamfer.normals(here.at(i))[side]);
            }
            sample(&at)
        });
        for i in faces {
            let sides = here.at(i);
            let turn = |k: usize, side: usize| (beside[side].at(i)[k].1 - sides[k].1) / by;
            let slope = chamfer.slope(sides, [0, 1].map(|k| [turn(k, 0), turn(k, 1)]));
            out.set(i, (f64::from(out.value[i]), slope));
        }
    }
}

/// Both operands over a chunk.
struct Pair([Slopes; 2]);

impl Pair {
    fn at(&self, i: usize) -> [Sample; 2] {
        self.0.each_ref().map(|side| side.at(i))
    }
}
