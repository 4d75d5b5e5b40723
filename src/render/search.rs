//! The middle of a march: rays of which both ends are known, or the near one, step by step to where
//! they cross or to where they are known not to.

use super::job::{Job, Local};
use super::march::{Found, Marcher, SLOPE_ERROR, TANGENTS};

/// Steps, after which rays are divided by intervals.
const SEARCH: usize = 40;

/// A search goes by this part of what a step may go on beyond where it is safe.
const LEAP: f32 = 0.9;

impl Marcher {
    /// Lanes along which g bends downwards and that are still below 0: where the tangents from
    /// both ends meet, g is below them.
    pub(super) fn search_bent(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.search);
        for round in 0..TANGENTS {
            if lanes.is_empty() {
                break;
            }
            self.sift(job, &mut lanes, |lists, lane, Local { g, s, .. }| {
                if g > job.doubt {
                    (lane.right, lane.g_right, lane.s_right) = (lane.at, g, s);
                    lane.aim(lane.at - g / s);
                    lists.unique.push(*lane);
                    return false;
                }
                if g >= -job.doubt {
                    lists.open.push(job.span(lane));
                    return false;
                }
                if s > 0.0 {
                    if round == 0 {
                        // It still rises at the far end.
                        return false;
                    }
                    (lane.left, lane.g_left, lane.s_left) = (lane.at, g, s);
                } else {
                    (lane.right, lane.g_right, lane.s_right) = (lane.at, g, s);
                }
                let steep = |s: f32| s + SLOPE_ERROR * s.abs() + 1e-6;
                let (up, down) = (steep(lane.s_left), steep(-lane.s_right));
                let width = lane.right - lane.left;
                if up <= 0.0 || down <= 0.0 {
                    return false;
                }
                let ahead = ((lane.g_right - lane.g_left + down * width) / (up + down)).clamp(0.0, width);
                if lane.g_left + up * ahead < -job.doubt {
                    return false;
                }
                if !(ahead > 1e-6 * width && ahead < width * (1.0 - 1e-6)) {
                    lists.open.push(job.span(lane));
                    return false;
                }
                lane.at = lane.left + ahead;
                true
            });
        }
        self.open.extend(lanes.iter().map(|lane| job.span(lane)));
        lanes.clear();
        self.search = lanes;
    }

    /// Lanes along which only bounds of the slope are known: steps that cannot pass a crossing.
    pub(super) fn search_steep(&mut self, job: &Job<'_>) {
        let mut lanes = std::mem::take(&mut self.search);
        for _ in 0..SEARCH {
            if lanes.is_empty() {
                break;
            }
            self.sift(job, &mut lanes, |lists, lane, Local { g, s, gradient }| {
                let (lo, hi) = job.slopes(lane);
                if lane.probe {
                    lane.probe = false;
                    if g > job.doubt && lane.at - lane.left <= job.close {
                        (lane.right, lane.g_right, lane.s_right) = (lane.at, g, s);
                        lane.aim(lane.at - g / s);
                        lists.unique.push(*lane);
                        return false;
                    }
                    // What the value takes to rise from 0 to here may cover all of the leap.
                    let covered = lane.at - (-g - job.doubt) / -lo <= lane.left;
                    if !(g < -job.doubt && covered) {
                        lane.at = lane.left;
                        return true;
                    }
                }
                let safe = lane.at + (-g - job.doubt) / hi;
                if !(g < -job.doubt && hi.is_finite() && safe > lane.at) {
                    if g.abs() <= job.doubt && s > 0.0 {
                        lane.left = lane.at;
                        lists.doubtful.push(Found { lane: *lane, slope: s, gradient, ahead: 0.0 });
                    } else {
                        lists.open.push(job.rest(lane));
                    }
                    return false;
                }
                let mut end = lane.right;
                if lane.g_right < 0.0 {
                    end -= (-lane.g_right - job.doubt).max(0.0) / -lo;
                }
                if safe >= end {
                    if lane.g_right > 0.0 {
                        lists.open.push(job.rest(lane));
                    }
                    return false;
                }
                // A little beyond where the tangent meets 0, if no crossing that is nearer makes
                // a difference.
                let beyond = lane.at + (-1.05 * g + 4.0 * job.doubt) / s;
                lane.left = safe;
                let near = s > 0.0 && beyond > safe && beyond < lane.right && beyond - safe <= job.close;
                // A step that the bounds from both of its ends just cover if the value goes on as
                // it does here.
                let (way, back) = (safe - lane.at, (-g - job.doubt) / -lo);
                let leap = lane.at + way + LEAP * ((way + back) / (1.0 + s / -lo) - way);
                let far = lo < 0.0 && leap > safe && leap < end;
                lane.probe = near || far;
                lane.at = match (near, far) {
                    (true, _) => beyond,
                    (false, true) => leap,
                    (false, false) => safe,
                };
                true
            });
        }
        self.open.extend(lanes.iter().map(|lane| job.rest(lane)));
        lanes.clear();
        self.search = lanes;
    }
}
