//! The end of a march: crossings that single precision has found, made exact in double precision,
//! many at a time.

use super::gbuffer::Surface;
use super::job::{Job, Ray, Span};
use super::march::{Found, Marcher};

/// Steps in double precision, after which rays are divided by intervals.
const STEPS: usize = 4;

/// So many points and more have owners found together, leaf by leaf.
const TOGETHER: usize = 4;

/// Values of the leaves that may own what rays have hit.
#[derive(Default)]
pub(super) struct Owners {
    /// Their places among those of the scene, and where their values begin.
    leaves: Vec<(u32, usize)>,
    values: Vec<f64>,
    /// Those of all nodes, at one point.
    nodes: Vec<f64>,
}

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
        if self.unowned.len() < TOGETHER {
            for (ray, p) in self.unowned.drain(..) {
                surfaces[ray as usize].owner = job.cell.program.deciding_leaf(job.center + p);
            }
            return;
        }
        let [x, y, z, v] = &mut self.double;
        for (axis, list) in [&mut *x, &mut *y, &mut *z].into_iter().enumerate() {
            list.clear();
            list.extend(self.unowned.iter().map(|(_, p)| p[axis]));
        }
        let count = self.unowned.len();
        v.resize(count, 0.0);
        let Owners { leaves, values, nodes } = &mut self.owners;
        leaves.clear();
        values.clear();
        job.tape.each_leaf(|leaf, alone| {
            self.evaluator.shortest_values_f64(alone, [x, y, z], v);
            leaves.push((leaf, values.len()));
            values.extend_from_slice(v);
        });
        leaves.sort_unstable();
        for (i, (ray, _)) in self.unowned.drain(..).enumerate() {
            let value = |leaf| {
                let found = leaves.binary_search_by_key(&leaf, |(leaf, _)| *leaf);
                found.map_or(f64::NAN, |n| values[leaves[n].1 + i])
            };
            surfaces[ray as usize].owner = job.cell.program.leaf_by_values(value, nodes);
        }
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
