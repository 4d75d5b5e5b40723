//! The search for regions: rounds of hypotheses, of which the best is taken again and again.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DMat3, DVec3};

use super::axes::axes;
use super::columns::{Columns, Shape, Tolerance};
use super::directions::{Directions, about};
use super::guesses::{revolved, sphere};
use super::limits::Limits;
use super::regions::{Region, Regions};
use super::samples::{Kind, Samples};
use super::seeds::{Seed, Seeds};
use super::settle::{Settled, Taken, settle};
use crate::fit::linear::Principal;
use crate::fit::random::Random;
use crate::{Cancelled, Run};

/// Rounds at most; each makes hypotheses from what is left.
const ROUNDS: usize = 5;

/// Fewer regions are not worth another round of the same kind.
const FEW: usize = 3;

/// Less than this share of the area is not searched again.
const REST: f64 = 0.002;

/// Hypotheses of a round: spheres, planes, and such about an axis; pairs tried for each of them.
const SPHERES: usize = 300;
const PLANES: usize = 200;
const REVOLVED: usize = 400;
const PAIRS: usize = 8;

/// Facets that are square to an axis, by this cosine, are of nothing that is round about it.
const ACROSS: f64 = 0.9997;

/// Hypotheses that are judged between two looks at whether the run is cancelled.
const AT_ONCE: usize = 256;

/// Hypotheses of a round that are adjusted in vain before it ends.
const FAILURES: usize = 120;

/// Shapes with more freedom explain more than they should: the shares are judged by these factors.
const SPHERE: f64 = 0.97;
const CONE: f64 = 0.95;
const TORUS: f64 = 0.9;

/// A hypothesis.
#[derive(Clone, Copy)]
struct Guess {
    /// The columns that it is in.
    frame: usize,
    shape: Shape,
    tolerance: Tolerance,
    share: f64,
}

impl Guess {
    fn merit(&self) -> f64 {
        self.share
            * match self.shape {
                Shape::Plane { .. } | Shape::Cone { slope: 0.0, .. } => 1.0,
                Shape::Sphere { .. } => SPHERE,
                Shape::Cone { .. } => CONE,
                Shape::Torus { .. } => TORUS,
            }
    }
}

/// Guesses are taken by merit.
struct Ranked {
    merit: f64,
    guess: Guess,
}

impl PartialEq for Ranked {
    fn eq(&self, other: &Ranked) -> bool {
        self.merit == other.merit
    }
}

impl Eq for Ranked {}

impl PartialOrd for Ranked {
    fn partial_cmp(&self, other: &Ranked) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ranked {
    fn cmp(&self, other: &Ranked) -> Ordering {
        self.merit.total_cmp(&other.merit)
    }
}

pub(super) struct Detector<'a> {
    samples: &'a Samples,
    limits: Limits,
    random: Random,
    directions: Directions,
    taken: Taken,
    found: Vec<Settled>,
    buffer: Vec<f32>,
}

impl<'a> Detector<'a> {
    pub(super) fn new(samples: &'a Samples, seed: u64) -> Detector<'a> {
        Detector {
            samples,
            limits: Limits::of(samples),
            random: Random::new(seed),
            directions: Directions::new(samples.kind),
            taken: Taken::none(samples),
            found: Vec::new(),
            buffer: Vec::new(),
        }
    }

    /// Looks for regions until nothing more is found.
    pub(super) fn search(&mut self, run: &Run) -> Result<(), Cancelled> {
        let lenient = self.limits.lenient();
        let mut is_strict = self.samples.kind != Kind::Cad;
        for round in 0..ROUNDS {
            run.check()?;
            run.report(round as f64 / ROUNDS as f64);
            let before = self.found.len();
            self.round(run)?;
            if self.left() < REST || !is_strict && self.found.len() == before {
                break;
            }
            if is_strict && self.found.len() < before + FEW {
                // What is of no shape is taken for what it is most like.
                self.limits = lenient;
                is_strict = false;
            }
        }
        Ok(())
    }

    /// The share of the area that is not explained.
    fn left(&self) -> f64 {
        self.samples.weights.iter().zip(&self.taken.samples).filter(|(_, taken)| !**taken).map(|(w, _)| w).sum()
    }

    fn round(&mut self, run: &Run) -> Result<(), Cancelled> {
        let by_samples = Seeds::of_samples(self.samples, &self.taken.samples);
        let by_corners = Seeds::of_corners(self.samples, &self.taken.corners);
        // Corners tell more than samples where there are some.
        let mut seeds = vec![];
        if by_corners.all.len() >= 8 {
            seeds.push(&by_corners);
        }
        if self.samples.kind != Kind::Voxels || seeds.is_empty() {
            seeds.push(&by_samples);
        }
        let mut voters = seeds.clone();
        if self.samples.kind == Kind::Voxels {
            voters.push(&by_samples);
        }
        let mut frames = vec![DMat3::IDENTITY];
        let add = |frames: &mut Vec<DMat3>, axis: DVec3| {
            let frame = about(self.directions.settled(axis, f64::INFINITY));
            if frames[1..].iter().all(|f| f.z_axis.cross(frame.z_axis).length() > 1e-3) {
                frames.push(frame);
            }
        };
        axes(&voters, &mut self.random).into_iter().for_each(|axis| add(&mut frames, axis));
        let voted = frames.len();
        if self.samples.kind == Kind::Scan && self.found.is_empty() {
            principal(self.samples).into_iter().for_each(|axis| add(&mut frames, axis));
        }
        let mut columns: Vec<Columns> = frames.into_iter().map(|frame| self.columns(frame)).collect();
        let mut heap = BinaryHeap::new();
        let mut guesses = self.guesses(&seeds, &columns[..voted]);
        self.guesses_about(&seeds, (&columns, voted), &mut guesses);
        for (i, mut guess) in guesses.into_iter().enumerate() {
            if i % AT_ONCE == 0 {
                run.check()?;
            }
            guess.share = columns[guess.frame].explain(&guess.shape, guess.tolerance, &mut self.buffer);
            if guess.share >= self.limits.share {
                heap.push(Ranked { merit: guess.merit(), guess });
            }
        }
        let mut failed: Vec<Guess> = Vec::new();
        while let Some(Ranked { guess, .. }) = heap.pop() {
            let share = columns[guess.frame].explain(&guess.shape, guess.tolerance, &mut self.buffer);
            if share < self.limits.share
                || failed.iter().any(|f| f.frame == guess.frame && alike(&f.shape, &guess.shape))
            {
                continue;
            }
            if share < 0.999 * guess.share {
                let guess = Guess { share, ..guess };
                heap.push(Ranked { merit: guess.merit(), guess });
                continue;
            }
            run.check()?;
            let from = &columns[guess.frame];
            match settle(&guess.shape, guess.tolerance, from, self.samples, &self.taken, &self.limits, &self.directions)
            {
                Some(settled) => {
                    self.taken.add(&settled, self.samples, &self.limits);
                    for columns in &mut columns {
                        columns.take(&self.taken.samples);
                    }
                    if let Some(direction) = settled.direction() {
                        self.directions.add(direction, settled.share);
                    }
                    self.found.push(settled);
                }
                None => {
                    failed.push(guess);
                    if failed.len() == FAILURES {
                        break;
                    }
                }
            }
        }
        Ok(())
    }

    fn columns(&self, frame: DMat3) -> Columns {
        let axis = frame.z_axis;
        let is_general = frame == DMat3::IDENTITY;
        let counts = |i: &u32| {
            let i = *i as usize;
            !self.taken.samples[i]
                && (is_general || self.samples.normals[i].dot(axis).abs() < ACROSS || self.samples.kind != Kind::Cad)
        };
        Columns::new(self.samples, frame, (0..self.samples.len() as u32).filter(counts).collect())
    }

    /// Hypotheses of all kinds.
    fn guesses(&mut self, seeds: &[&Seeds], columns: &[Columns]) -> Vec<Guess> {
        let mut guesses = Vec::new();
        let all = &columns[0].which;
        for _ in 0..PLANES.min(all.len()) {
            let i = all[self.random.below(all.len())] as usize;
            let (point, normal) = (self.samples.points[i], self.samples.normals[i]);
            let shape = Shape::Plane { normal, offset: normal.dot(point) };
            guesses.push(Guess { frame: 0, shape, tolerance: self.limits.coarse(&shape), share: 0.0 });
        }
        for seeds in seeds {
            let slack = self.limits.slack(seeds.exact);
            self.of_pairs(seeds, SPHERES, 0, |pair| sphere(pair, slack), &mut guesses);
            self.guesses_about(&[seeds], (columns, 1), &mut guesses);
        }
        guesses
    }

    /// Hypotheses of what is round about the axes of frames, from a number on.
    fn guesses_about(&mut self, seeds: &[&Seeds], (columns, from): (&[Columns], usize), guesses: &mut Vec<Guess>) {
        for seeds in seeds {
            let slack = self.limits.slack(seeds.exact);
            for (frame, columns) in columns.iter().enumerate().skip(from) {
                let to = |pair| revolved(&columns.frame, pair, slack);
                self.of_pairs(seeds, REVOLVED, frame, to, guesses);
            }
        }
    }

    fn of_pairs(
        &mut self,
        seeds: &Seeds,
        count: usize,
        frame: usize,
        shape_of: impl Fn([Seed; 2]) -> Option<Shape>,
        guesses: &mut Vec<Guess>,
    ) {
        let first = guesses.len();
        for _ in 0..PAIRS * count {
            if guesses.len() == first + count {
                break;
            }
            let Some(pair) = seeds.pair(&mut self.random) else { continue };
            let Some(shape) = shape_of(pair) else { continue };
            // Facets are chords: samples on them are within the circle that vertices are on.
            let step = pair[0].step.max(pair[1].step);
            let (shape, sagitta) = shape.chordal(step);
            let mut tolerance = self.limits.coarse(&shape);
            tolerance.distance += 0.5 * sagitta;
            guesses.push(Guess { frame, shape, tolerance, share: 0.0 });
        }
    }

    /// What was found.
    pub(super) fn finished(self) -> Regions {
        let regions: Vec<Region> = self.found.into_iter().map(Settled::region).collect();
        let mut frames = self.directions.frames();
        if frames.is_empty() {
            frames.push(Principal::of(self.samples.points.iter().copied()).axes);
        }
        Regions { regions, frames, eps: self.limits.eps }
    }
}

/// The principal axes of the samples. Few pairs of normals are across the axis of a torus; where it
/// is alone, it is one of these.
fn principal(samples: &Samples) -> [DVec3; 3] {
    let axes = Principal::of(samples.points.iter().copied()).axes;
    [axes.x_axis, axes.y_axis, axes.z_axis]
}

/// Whether two shapes of a frame are nearly one.
fn alike(a: &Shape, b: &Shape) -> bool {
    let near = |a: DVec3, b: DVec3, r: f64| a.distance(b) < 0.1 * r;
    let same = |a: f64, b: f64| (a - b).abs() < 0.1 * a.abs().max(b.abs());
    match (*a, *b) {
        (Shape::Plane { normal: n, offset: o }, Shape::Plane { normal: m, offset: p }) => {
            near(n, m, 0.5) && (o - p).abs() < 0.001
        }
        (Shape::Sphere { centre: c, radius: r, sign: s }, Shape::Sphere { centre: d, radius: q, sign: t }) => {
            s == t && near(c, d, r) && same(r, q)
        }
        (
            Shape::Cone { centre: c, radius: r, slope: k, sign: s },
            Shape::Cone { centre: d, radius: q, slope: l, sign: t },
        ) => s == t && (c[0] - d[0]).hypot(c[1] - d[1]) < 0.1 * r.abs() && same(r, q) && (k - l).abs() < 0.1,
        (
            Shape::Torus { centre: c, major: r, minor: m, sign: s },
            Shape::Torus { centre: d, major: q, minor: n, sign: t },
        ) => s == t && near(c, d, m) && same(r, q) && same(m, n),
        _ => false,
    }
}
