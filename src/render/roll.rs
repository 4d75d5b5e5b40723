//! Rays from ball to ball in which nothing is.
//!
//! ```text
//!        .-""-.    .-"-.           A ball is told for a point of a ray and leads it on to where the
//!     --/------\--/-----\|         ray leaves it, or, from the far end, back to where the ray enters
//!      | c      \|   c   |         it. Most rays that pass a fillet by have met both ends after one
//!       \      /  \     /|         ball or two. Where balls lead no further the crossing is near.
//!        '-..-'    '-.-' |
//! ```

use glam::Vec3;

use super::cells::{Cell, Cells};
use super::job::{Job, Lane, Ray, Span};
use super::march::{Marcher, points};
use super::slopes::Known;

/// So many balls lead a ray on, before what is left of it is searched in steps.
const BALLS: usize = 24;

impl Marcher {
    /// The rays that balls do not lead to the ends of their spans.
    pub(super) fn unrolled(
        &mut self,
        cells: &Cells,
        cell: &Cell,
        known: &Known,
        rays: &[Ray],
        spans: &[Span],
    ) -> Vec<u32> {
        let job = Job::new(cells, cell, known, rays, spans);
        self.load(&job);
        self.roll(&job);
        let lanes = std::mem::take(&mut self.search);
        lanes.iter().map(|lane| job.span(lane).ray).collect()
    }

    /// Leaves out of the lanes to be searched what is in balls without anything in them.
    pub(super) fn roll(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.search);
        for round in 0..BALLS {
            if lanes.is_empty() {
                break;
            }
            for lane in &mut lanes {
                lane.at = if round % 2 == 0 && !lane.probe { lane.right } else { lane.left };
            }
            self.balls(job, &lanes);
            let mut kept = 0;
            for i in 0..lanes.len() {
                let [_, _, _, radius, x, y, z] = self.single.each_ref().map(|list| list[i]);
                let lane = &mut lanes[i];
                let is_last = lane.at == lane.right;
                match within(lane, Vec3::new(x, y, z), radius) {
                    Some([enter, _]) if is_last => lane.right = enter,
                    // It is in a fillet, or where one fades away.
                    None if is_last => lane.probe = true,
                    Some([_, leave]) if leave - lane.left > job.close => lane.left = leave,
                    _ => {
                        self.search.push(Lane { probe: false, ..*lane });
                        continue;
                    }
                }
                if lane.left < lane.right {
                    lanes[kept] = *lane;
                    kept += 1;
                }
            }
            lanes.truncate(kept);
        }
        let at_left = |lane: &Lane| Lane { at: lane.left, probe: false, ..*lane };
        self.search.extend(lanes.iter().map(at_left));
    }

    /// The balls of lanes at `at`: radii and middles.
    fn balls(&mut self, job: &Job<'_>, lanes: &[Lane]) {
        let [x, y, z, balls @ ..] = points(&mut self.single, lanes);
        self.evaluator.empty_balls(job.tape, [x, y, z], balls);
    }
}

/// Where a lane enters and leaves a ball that its point is in.
fn within(lane: &Lane, middle: Vec3, radius: f32) -> Option<[f32; 2]> {
    let (start, direction) = (Vec3::from_array(lane.start), Vec3::from_array(lane.direction));
    let to = middle - (start + lane.at * direction);
    let along = to.dot(direction);
    let half = (radius * radius - (to - along * direction).length_squared()).max(0.0).sqrt();
    (to.length() < radius).then_some([lane.at + along - half, lane.at + along + half])
}
