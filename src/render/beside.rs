//! Rays through planes at which slopes have no bound, many at a time, in double precision.
//!
//! ```text
//!     |  .-'|'-.      A ray is cut where it crosses the planes (`slopes`). Where g rises from cut
//!     |-'---+---'-    to cut, its value at the farther one tells whether it crosses 0 between
//!     +     |         them, and a bracket finds where; where it falls, it does not go inside.
//! ```
//!
//! Where the value jumps, a ray is cut a little before and behind, and in between its ends tell.
//! Near such planes single precision tells little. What neither rises nor falls is divided by
//! intervals (`eval::first_hit`).

use super::gbuffer::Surface;
use super::job::{Job, Ray, Span};
use super::march::Marcher;
use super::slopes::{Sides, Slopes};
use crate::eval::{Bracket, distance};

/// A ray on its way from plane to plane.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    ray: u32,
    /// It has not crossed the surface before `from`; the next plane, or the end, is at `to`.
    from: f64,
    to: f64,
    far: f64,
    /// g there, where it was asked for.
    g: f64,
}

/// A crossing that is closed in on.
#[derive(Clone, Copy)]
pub(super) struct Crossing {
    ray: u32,
    bracket: Bracket,
    /// Where g is asked for next.
    at: f64,
}

/// Crossings are found to this part of the solid's size.
const PRECISION: f64 = 1e-8;

impl Marcher {
    /// The crossings of rays through `sides`.
    pub(super) fn walk(&mut self, job: &Job<'_>, sides: &Sides, surfaces: &mut [Surface]) {
        let (mut walks, mut crossed) = (std::mem::take(&mut self.walks), std::mem::take(&mut self.crossed));
        walks.extend(job.spans.iter().map(|&Span { ray, near, far }| Walk { ray, from: near, to: near, far, g: 0.0 }));
        while !walks.is_empty() {
            walks.retain_mut(|walk| self.goes_on(job, sides, walk));
            self.values(job, walks.iter().map(|walk| (walk.ray, walk.to)));
            let mut kept = 0;
            for at in 0..walks.len() {
                let walk = Walk { g: job.turn(walks[at].ray) * self.double[3][at], ..walks[at] };
                if walk.g > 0.0 {
                    crossed.push(walk);
                } else {
                    walks[kept] = walk;
                    kept += 1;
                }
            }
            walks.truncate(kept);
        }
        self.values(job, crossed.iter().map(|walk| (walk.ray, walk.from)));
        let mut crossings = std::mem::take(&mut self.crossings);
        for (at, Walk { ray, from, to, g, .. }) in crossed.drain(..).enumerate() {
            let before = job.turn(ray) * self.double[3][at];
            if before > 0.0 {
                // It has crossed at the border, but for rounding.
                self.hit(job, ray, from, surfaces);
            } else {
                crossings.push(Crossing { ray, bracket: Bracket::new([from, to], [before, g]), at: from });
            }
        }
        for _ in 0..Bracket::MOST {
            crossings.retain_mut(|crossing| match crossing.bracket.next(PRECISION * job.size) {
                Some(at) => {
                    crossing.at = at;
                    true
                }
                None => {
                    self.hit(job, crossing.ray, crossing.bracket.middle(), surfaces);
                    false
                }
            });
            if crossings.is_empty() {
                break;
            }
            self.values(job, crossings.iter().map(|crossing| (crossing.ray, crossing.at)));
            for (crossing, value) in crossings.iter_mut().zip(&self.double[3]) {
                crossing.bracket.narrow(crossing.at, job.turn(crossing.ray) * value);
            }
        }
        for Crossing { ray, bracket, .. } in crossings.drain(..) {
            self.hit(job, ray, bracket.middle(), surfaces);
        }
        (self.walks, self.crossed, self.crossings) = (walks, crossed, crossings);
    }

    /// Whether a ray goes on to where g has to be asked for.
    fn goes_on(&mut self, job: &Job<'_>, sides: &Sides, walk: &mut Walk) -> bool {
        let Ray { origin, direction, inside, .. } = job.rays[walk.ray as usize];
        while walk.to < walk.far {
            walk.from = walk.to;
            let gap = 0.25 * PRECISION * job.size;
            walk.to = walk.far;
            let mut is_jump = false;
            for crease in &sides.creases {
                let at = distance(crease, origin, direction);
                let cuts = if crease.jumps { [at - gap, at + gap] } else { [at; 2] };
                let ahead = if cuts[0] > walk.from { cuts[0] } else { cuts[1] };
                if ahead > walk.from && ahead < walk.to {
                    (walk.to, is_jump) = (ahead, cuts[0] <= walk.from);
                }
            }
            let slopes = sides.slopes(origin + 0.5 * (walk.from + walk.to) * direction);
            let Slopes { rises, falls, .. } = if inside { slopes.turned() } else { slopes };
            if is_jump || rises && !falls {
                return true;
            }
            if !falls {
                self.open.push(Span { ray: walk.ray, near: walk.from, far: walk.far });
                return false;
            }
        }
        false
    }

    /// The values along rays at these distances, in double precision.
    fn values(&mut self, job: &Job<'_>, points: impl ExactSizeIterator<Item = (u32, f64)>) {
        let count = points.len();
        let [x, y, z, v] = &mut self.double;
        for list in [&mut *x, &mut *y, &mut *z] {
            list.clear();
        }
        for (ray, at) in points {
            let Ray { origin, direction, .. } = job.rays[ray as usize];
            let p = origin + at * direction - job.center;
            x.push(p.x);
            y.push(p.y);
            z.push(p.z);
        }
        v.resize(count, 0.0);
        if count > 0 {
            self.evaluator.shortest_values_f64(job.tape, [x, y, z], v);
        }
    }

    /// The surface that a ray meets.
    fn hit(&mut self, job: &Job<'_>, ray: u32, t: f64, surfaces: &mut [Surface]) {
        let Ray { origin, direction, base, .. } = job.rays[ray as usize];
        let point = origin + t * direction;
        let normal = -job.cell.program.gradient(point).1.normalize_or_zero();
        let owner = job.owner.unwrap_or_else(|| job.cell.program.deciding_leaf(point));
        surfaces[ray as usize] = Surface { distance: base + t, normal: normal.as_vec3(), owner };
        self.hits.push(ray);
    }
}
