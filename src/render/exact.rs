//! The end of a march: crossings that single precision has found, made exact in double precision,
//! many at a time.

use super::gbuffer::Surface;
use super::job::{Job, Ray, Span};
use super::march::{Found, Marcher};
use crate::eval::Op;

/// Steps in double precision, after which rays are divided by intervals.
const STEPS: usize = 4;

impl Marcher {
    /// Lanes that have come so close to a crossing that rounding hides the sign: where a little
    /// beyond where the tangent meets 0 the sign has changed, and a crossing that is nearer makes
    /// no difference, that is it.
    pub(super) fn settle(&mut self, job: &Job<'_>) {
        let mut doubtful = std::mem::take(&mut self.doubtful);
        self.exact_values(job, &doubtful);
        let mut kept = 0;
        for at in 0..doubtful.len() {
            let mut found = doubtful[at];
            let g = f64::from(found.lane.turn) * self.double[3][at];
            found.ahead = (-1.05 * g).max(0.0) / f64::from(found.slope) + 0.01 * job.settled;
            let ahead = found.ahead as f32;
            if ahead < job.close.min(found.lane.right - found.lane.at) {
                doubtful[kept] = found;
                kept += 1;
            } else {
                self.open.push(job.rest(&found.lane));
            }
        }
        doubtful.truncate(kept);
        self.exact_values(job, &doubtful);
        for (found, value) in doubtful.drain(..).zip(&self.double[3]) {
            if f64::from(found.lane.turn) * value > 0.0 {
                self.found.push(found);
            } else {
                self.open.push(job.rest(&found.lane));
            }
        }
        self.doubtful = doubtful;
    }

    /// The surfaces of the crossings, after steps in double precision where the rounding of
    /// single precision would show.
    pub(super) fn finish(&mut self, job: &Job<'_>, surfaces: &mut [Surface]) {
        let mut found = std::mem::take(&mut self.found);
        found.retain(|found| {
            let is_coarse = job.doubt > job.fine * found.slope;
            if !is_coarse {
                self.surface(job, found, surfaces);
            }
            is_coarse
        });
        for round in 0..STEPS {
            self.exact_values(job, &found);
            let mut kept = 0;
            for at in 0..found.len() {
                let Found { lane, slope, .. } = found[at];
                let step = -f64::from(lane.turn) * self.double[3][at] / f64::from(slope);
                found[at].ahead += step;
                if step.abs() <= job.settled {
                    self.surface(job, &found[at], surfaces);
                } else if step.abs() > job.far_off || round + 1 == STEPS {
                    self.open.push(job.span(&lane));
                } else {
                    found[kept] = found[at];
                    kept += 1;
                }
            }
            found.truncate(kept);
        }
        self.found = found;
        self.owners(job, surfaces);
    }

    /// The leaves that decide where rays have hit something.
    fn owners(&mut self, job: &Job<'_>, surfaces: &mut [Surface]) {
        if self.unowned.is_empty() {
            return;
        }
        let Some((op, rivals)) = job.tape.rivals() else {
            for (ray, p) in self.unowned.drain(..) {
                surfaces[ray as usize].owner = job.cell.program.deciding_leaf(job.center + p);
            }
            return;
        };
        let [x, y, z, v] = &mut self.double;
        for (axis, list) in [&mut *x, &mut *y, &mut *z].into_iter().enumerate() {
            list.clear();
            list.extend(self.unowned.iter().map(|(_, p)| p[axis]));
        }
        v.resize(self.unowned.len(), 0.0);
        self.best.clear();
        self.best.resize(self.unowned.len(), f64::NEG_INFINITY);
        // The largest of all values decides a union, of all negatives an intersection.
        let sign = if op == Op::Or { 1.0 } else { -1.0 };
        for (number, rival) in rivals {
            self.evaluator.shortest_values_f64(&rival, [x, y, z], v);
            for (((ray, _), best), value) in self.unowned.iter().zip(&mut self.best).zip(&*v) {
                if sign * value > *best {
                    *best = sign * value;
                    surfaces[*ray as usize].owner = number;
                }
            }
        }
        self.unowned.clear();
    }

    /// Values of the program in double precision where the crossings are; their signs are certain.
    fn exact_values(&mut self, job: &Job<'_>, found: &[Found]) {
        if found.is_empty() {
            return;
        }
        let [x, y, z, v] = &mut self.double;
        for list in [&mut *x, &mut *y, &mut *z] {
            list.clear();
        }
        for found in found {
            let p = job.point(&found.lane, found.ahead) - job.center;
            x.push(p.x);
            y.push(p.y);
            z.push(p.z);
        }
        v.resize(found.len(), 0.0);
        self.evaluator.shortest_values_f64(job.tape, [x, y, z], v);
    }

    fn surface(&mut self, job: &Job<'_>, found: &Found, surfaces: &mut [Surface]) {
        let Span { ray, near, far } = job.span(&found.lane);
        let Ray { origin, direction, base, .. } = job.rays[ray as usize];
        let t = (near + f64::from(found.lane.at) + found.ahead).clamp(near, far);
        let normal = -found.gradient * found.gradient.length_recip();
        if !normal.is_finite() {
            self.open.push(job.span(&found.lane));
            return;
        }
        if job.owner.is_none() {
            self.unowned.push((ray, origin + t * direction - job.center));
        }
        surfaces[ray as usize] = Surface { distance: base + t, normal, owner: job.owner.unwrap_or_default() };
        self.hits.push(ray);
    }
}
