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

use super::job::{Job, Lane, Span};
use super::march::{Marcher, points};

/// So many balls lead a ray on, before what is left of it is searched in steps.
const BALLS: usize = 24;

/// One ray of so many is led first, and the balls that it meets lead those beside it.
const LEADERS: usize = 4;

/// A ball in which nothing is.
#[derive(Clone, Copy)]
pub(super) struct Ball {
    /// The span of the lane that met it.
    span: u32,
    middle: Vec3,
    radius: f32,
}

impl Marcher {
    /// The rays that balls do not lead to the ends of their spans.
    pub(super) fn unrolled(&mut self, job: &Job<'_>) -> Vec<u32> {
        self.load(job);
        self.roll(job);
        let lanes = std::mem::take(&mut self.search);
        lanes.iter().map(|lane| job.span(lane).ray).collect()
    }

    /// Leaves out of the lanes to be searched what is in balls without anything in them.
    pub(super) fn roll(&mut self, job: &Job<'_>) {
        let lanes = std::mem::take(&mut self.search);
        self.known.clear();
        let leaders: Vec<Lane> = lanes.iter().step_by(LEADERS).copied().collect();
        let mut spans: Vec<u32> = leaders.iter().map(|lane| lane.span).collect();
        self.lead(job, leaders);
        self.known.sort_by_key(|ball| ball.span);
        spans.extend(spans.last().copied());
        let mut others = Vec::with_capacity(lanes.len());
        for (i, mut lane) in lanes.into_iter().enumerate().filter(|(i, _)| i % LEADERS != 0) {
            let beside = [spans[i / LEADERS], spans[i / LEADERS + 1]];
            let [from, to] = [0, 1].map(|end| self.known.partition_point(|ball| ball.span < beside[end] + end as u32));
            lead_by(&mut lane, &self.known[from..to]);
            if !is_done(job, &lane) {
                others.push(lane);
            }
        }
        self.lead(job, others);
    }

    /// Leads lanes from ball to ball.
    fn lead(&mut self, job: &Job<'_>, mut lanes: Vec<Lane>) {
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
                let ball = Ball { span: lane.span, middle: Vec3::new(x, y, z), radius };
                match ball.within(lane).filter(|[enter, leave]| (*enter..*leave).contains(&lane.at)) {
                    Some([enter, _]) if is_last => lane.right = enter,
                    // It is in a fillet, or where one fades away.
                    None if is_last => lane.probe = true,
                    Some([_, leave]) if leave - lane.left > job.close => lane.left = leave,
                    _ => {
                        self.search.push(Lane { probe: false, ..*lane });
                        continue;
                    }
                }
                self.known.push(ball);
                if !is_done(job, lane) {
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

/// Leads a lane on, from both ends, by balls that others have met.
fn lead_by(lane: &mut Lane, balls: &[Ball]) {
    for ball in balls.iter().chain(balls) {
        let Some([enter, leave]) = ball.within(lane) else { continue };
        if enter <= lane.left {
            lane.left = lane.left.max(leave);
        } else if leave >= lane.right {
            lane.right = lane.right.min(enter);
        }
    }
    lane.at = lane.left;
}

/// Whether nothing of a lane is left, or, where a ball is behind, less than crossings are told
/// apart by. At the end of a cell a crossing counts, however near: the next one begins there.
fn is_done(job: &Job<'_>, lane: &Lane) -> bool {
    let Span { near, far, .. } = job.span(lane);
    let (left, is_between) = (lane.right - lane.left, lane.right < (far - near) as f32);
    left <= 0.0 || is_between && left <= job.close
}

impl Ball {
    /// Where a lane enters and leaves it.
    fn within(&self, lane: &Lane) -> Option<[f32; 2]> {
        let [start, direction] = [lane.start, lane.direction].map(|v| Vec3::from_array(v).as_dvec3());
        let to = self.middle.as_dvec3() - start;
        let along = to.dot(direction);
        let square = f64::from(self.radius).powi(2) - (to - along * direction).length_squared();
        let half = square.max(0.0).sqrt();
        (square > 0.0).then_some([(along - half) as f32, (along + half) as f32])
    }
}
