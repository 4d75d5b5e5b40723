//! Where a curve is sampled: by equal angles, by equal lengths, by the height of the chords.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::curve::{By, Curve};

/// A sample of one of the two curves of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) point: DVec2,
    pub(super) normal: DVec2,
    /// The normals before and after it, which differ at a corner.
    pub(super) sides: [DVec2; 2],
    /// How far along the curve, from 0 to 1.
    pub(super) texture: f64,
}

impl Sample {
    /// Whether it is no corner.
    pub(super) fn is_smooth(&self) -> bool {
        self.sides == [self.normal; 2]
    }
}

/// A part of a curve of unit size, and the scale it is seen at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) curve: Curve,
    pub(super) by: By,
    pub(super) range: [f64; 2],
    pub(super) scale: DVec2,
}

impl Arc {
    /// The sample at a parameter.
    pub(super) fn sample(&self, t: f64, texture: f64) -> Sample {
        let local = self.curve.at(t, self.by);
        Sample { point: local.point, normal: local.normal, sides: self.curve.normals_about(t, self.by), texture }
    }

    /// The point at a parameter, to scale.
    pub(super) fn point(&self, t: f64) -> DVec2 {
        self.curve.at(t, self.by).point * self.scale
    }

    /// `count` intervals of equal parameter: both ends are among the samples.
    pub(super) fn uniform(&self, count: u32) -> Vec<Sample> {
        (0..=count).map(|i| self.sample(share(self.range, i, count), f64::from(i) / f64::from(count))).collect()
    }

    /// `count` intervals whose chords are as equal as can be.
    pub(super) fn equal(&self, count: u32) -> Vec<Sample> {
        let steps = equal_steps(self.range, count, &|t| self.point(t).extend(0.0));
        let share = |i: usize| i as f64 / f64::from(count);
        steps.into_iter().enumerate().map(|(i, t)| self.sample(self.snapped(t), share(i))).collect()
    }

    /// Many points, close together.
    pub(super) fn chain(&self, count: u32) -> Chain {
        Chain::new(self.range, count, &|t| self.point(t).extend(0.0))
    }

    /// As few samples as keep every chord within `tolerance` of the curve, `least` intervals at
    /// least, with the slack spread evenly.
    pub(super) fn chords(&self, chain: &Chain, tolerance: f64, least: usize) -> Vec<f64> {
        chain.chords(tolerance, least).into_iter().map(|t| self.snapped(t)).collect()
    }

    /// The parameter, or the quarter turn that it is next to.
    fn snapped(&self, t: f64) -> f64 {
        if !matches!(self.curve, Curve::Superellipse { .. } | Curve::Gielis { .. }) {
            return t;
        }
        let quarter = (t / FRAC_PI_2).round() * FRAC_PI_2;
        if (t - quarter).abs() < 1e-7 { quarter } else { t }
    }

    /// How far along the range a parameter is, from 0 to 1.
    pub(super) fn texture(&self, t: f64) -> f64 {
        let [first, last] = self.range;
        (t - first) / (last - first)
    }
}

/// The parameter that is i/count of the way: exactly in the middle and at quarters of it.
fn share([first, last]: [f64; 2], i: u32, count: u32) -> f64 {
    let share = f64::from(i) / f64::from(count);
    if share == 1.0 { last } else { first + (last - first) * share }
}

/// Parameters of `count` intervals whose chords are as equal as can be: the curve by equal
/// lengths, then moved a little, for a chord that cuts a corner is shorter than its arc.
pub(super) fn equal_steps(range: [f64; 2], count: u32, point: &impl Fn(f64) -> DVec3) -> Vec<f64> {
    let chain = Chain::new(range, count, point);
    let n = count as usize;
    let mut at: Vec<f64> = (0..=n).map(|i| chain.length() * i as f64 / n as f64).collect();
    let mut best = (f64::INFINITY, at.clone());
    for _ in 0..EVENING {
        let points: Vec<DVec3> = at.iter().map(|&s| point(chain.parameter(s))).collect();
        let chords: Vec<f64> = points.windows(2).map(|w| w[0].distance(w[1])).collect();
        let (least, most) = chords.iter().fold((f64::INFINITY, 0f64), |(a, b), &c| (a.min(c), b.max(c)));
        let ratio = most / least;
        if ratio < best.0 {
            best = (ratio, at.clone());
        }
        let mut walked = vec![0.0];
        walked.extend(chords.iter().scan(0.0, |sum, c| {
            *sum += c;
            Some(*sum)
        }));
        at = (0..=n).map(|i| interpolate(&walked, &at, walked[n] * i as f64 / n as f64)).collect();
    }
    best.1.into_iter().map(|s| chain.parameter(s)).collect()
}

/// Rounds of evening chords out.
const EVENING: u32 = 10;

/// The y that belongs to x, of a rising polyline.
fn interpolate(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let i = xs.partition_point(|&v| v < x).clamp(1, xs.len() - 1);
    let width = xs[i] - xs[i - 1];
    let share = if width > 0.0 { ((x - xs[i - 1]) / width).clamp(0.0, 1.0) } else { 0.0 };
    ys[i - 1] + (ys[i] - ys[i - 1]) * share
}

/// Many points of a curve, close together, with the lengths walked.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    parameters: Vec<f64>,
    points: Vec<DVec3>,
    walked: Vec<f64>,
}

impl Chain {
    /// Points so close together that `count` intervals have 16 of them each, and 2048 in all.
    pub(super) fn new(range: [f64; 2], count: u32, point: &impl Fn(f64) -> DVec3) -> Chain {
        const COARSE: u32 = 256;
        let mut rough = 0.0;
        let mut todo: Vec<[f64; 2]> = Vec::new();
        for i in (0..COARSE).rev() {
            let [a, b] = [i, i + 1].map(|i| share(range, i, COARSE));
            rough += point(a).distance(point(b));
            todo.push([a, b]);
        }
        let finest = rough / f64::from(count.max(128)) / 16.0;
        let mut chain = Chain { parameters: vec![], points: vec![], walked: vec![] };
        chain.push(range[0], point(range[0]));
        while let Some([a, b]) = todo.pop() {
            let middle = 0.5 * (a + b);
            if point(a).distance(point(b)) > finest && a < middle && middle < b {
                todo.push([middle, b]);
                todo.push([a, middle]);
            } else {
                chain.push(b, point(b));
            }
        }
        chain
    }

    fn push(&mut self, t: f64, point: DVec3) {
        let walked = self.points.last().map_or(0.0, |last| self.length() + last.distance(point));
        self.parameters.push(t);
        self.points.push(point);
        self.walked.push(walked);
    }

    /// The whole length.
    pub(super) fn length(&self) -> f64 {
        self.walked.last().copied().unwrap_or(0.0)
    }

    /// The parameter at a length walked.
    pub(super) fn parameter(&self, length: f64) -> f64 {
        interpolate(&self.walked, &self.parameters, length)
    }

    /// As few parameters as keep every chord within `tolerance`, `least` intervals at least, with
    /// the slack spread evenly.
    pub(super) fn chords(&self, tolerance: f64, least: usize) -> Vec<f64> {
        let few = self.greedy(tolerance);
        let count = few.len() - 1;
        if count < least {
            return (0..=least).map(|i| self.parameter(self.length() * i as f64 / least as f64)).collect();
        }
        // The smallest tolerance that needs no more samples.
        let (mut tight, mut loose, mut best) = (0.0, tolerance, few);
        for _ in 0..8 {
            let middle = 0.5 * (tight + loose);
            let tried = self.greedy(middle);
            if tried.len() - 1 > count {
                tight = middle;
            } else {
                (loose, best) = (middle, tried);
            }
        }
        best.into_iter().map(|i| self.parameters[i]).collect()
    }

    /// The parameter that is a share of the way, by length, between two others.
    pub(super) fn between(&self, [a, b]: [f64; 2], share: f64) -> f64 {
        let [from, to] = [a, b].map(|t| interpolate(&self.parameters, &self.walked, t));
        self.parameter(from + (to - from) * share)
    }

    /// The points that a walk needs which takes the longest chord at every step.
    fn greedy(&self, tolerance: f64) -> Vec<usize> {
        let last = self.points.len() - 1;
        let mut taken = vec![0];
        let mut from = 0;
        while from < last {
            // Doubling, then halving; a chord to the next point always fits.
            let (mut good, mut step) = (from + 1, 2);
            while from + step <= last && self.fits(from, from + step, tolerance) {
                good = from + step;
                step *= 2;
            }
            let mut bad = (from + step).min(last + 1);
            while bad - good > 1 {
                let middle = usize::midpoint(good, bad);
                if self.fits(from, middle, tolerance) { good = middle } else { bad = middle }
            }
            taken.push(good);
            from = good;
        }
        taken
    }

    /// Whether the points between two, or a hundred of them, are within `tolerance` of the chord.
    fn fits(&self, from: usize, to: usize, tolerance: f64) -> bool {
        let (a, b) = (self.points[from], self.points[to]);
        let along = (b - a).normalize_or_zero();
        let chord = a.distance(b);
        let step = ((to - from) / 100).max(1);
        self.points[from..=to].iter().step_by(step).all(|&p| {
            let d = p - a;
            let s = d.dot(along).clamp(0.0, chord);
            (d - along * s).length() <= tolerance
        })
    }
}
