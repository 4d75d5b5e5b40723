//! The search for a supershape: axes, symmetry numbers, starts, and extensions of the best ones.
//!
//! ```text
//!     axes         three principal ones and three of the superellipsoid, ranked by their harmonics
//!     starts       two symmetry numbers an axis, phases and exponents by the radii      128 points
//!     best five    two of a symmetry number at most                                     384
//!     extensions   other meridians, untied exponents, twice the number, other phases    128, 384
//! ```

use std::f64::consts::{FRAC_PI_2, LN_2, TAU};

use glam::{DMat3, DVec3};
use rvachev_num::order;

use super::centers::{Belt, Centered, centered};
use super::cost::Cost;
use super::gielis::{Curve, Supershaped, Ties};
use super::harmonics::{Around, Repeat, ring_center};
use super::kernel::Model;
use super::linear::Principal;
use super::local::Local;
use super::samples::Samples;
use super::sections::{Sweep, sweep};
use super::settings::{FitSettings, Start, Symmetry};
use super::solve::{Problem, Robust};
use super::superquadric::Superquadric;
use crate::{Cancelled, Run};

/// A model, judged by its median residual and the number of its parameters.
#[derive(Clone, Copy)]
pub(super) struct Judged {
    pub(super) model: Supershaped,
    pub(super) score: f64,
    pub(super) noise: f64,
}

/// The search over the points of a surface, which are in random order.
pub(super) struct ShapeSearch<'a> {
    points: &'a [DVec3],
    rough: f64,
    few: Samples<f32>,
    more: Samples<f32>,
    cost: Cost,
    start: Start,
    symmetry: Symmetry,
    run: &'a Run,
    pub(super) evaluations: usize,
    pub(super) tried: usize,
}

/// What the search found.
pub(super) struct Shapes {
    /// The best ones, to be polished.
    pub(super) best: Vec<Supershaped>,
    /// Nothing tells the symmetry numbers: they are a guess.
    pub(super) unclear: bool,
}

/// A fit is as good as the noise where its deviation is below this times that of local planes.
const GOOD: f64 = 1.3;

/// If harmonics about the best axis explain a smaller share of the squares, they tell nothing.
const CLEAR: f64 = 0.5;

/// What has no points in so large an angle about its axis is seen in part, in radians.
const GAP: f64 = 0.7;

/// Points that are asked for axes.
const SEEN: usize = 700;

/// Axes closer together than this are one: the cosine of 10°.
const SAME: f64 = 0.985;

impl<'a> ShapeSearch<'a> {
    pub(super) fn new(points: &'a [DVec3], local: &Local, settings: &FitSettings, run: &'a Run) -> ShapeSearch<'a> {
        let FitSettings { cost, start, symmetry, .. } = *settings;
        let first = |count: usize| Samples::new(points[..count.min(points.len())].iter().copied());
        ShapeSearch {
            points,
            rough: local.rough,
            few: first(128),
            more: first(384),
            cost,
            start,
            symmetry,
            run,
            evaluations: 0,
            tried: 0,
        }
    }

    fn fit(&mut self, start: Supershaped, more: bool, rounds: usize) -> Result<Judged, Cancelled> {
        self.run.check()?;
        let samples = if more { &self.more } else { &self.few };
        let cost = if !more && self.cost == Cost::Normal { Cost::Radial } else { self.cost };
        let width = if more { 2.5 } else { 3.0 };
        let problem = Problem { samples, cost };
        let how = |rounds| Robust { rounds, steps: 4, width, area: 0.0, gain: 1e-2 };
        let mut start = start;
        let mut left = rounds;
        if let (Start::Rational { tolerance }, false) = (self.start, more) {
            // The published order: rational radii while they stand for the exact ones.
            start.rational = true;
            while left > 1 && start.stays_rational(tolerance) {
                let fitted = problem.robust(start, how(1));
                self.evaluations += fitted.evaluations;
                start = fitted.model;
                left -= 1;
            }
            start.rational = false;
        }
        let fitted = problem.robust(start, how(left));
        self.evaluations += fitted.evaluations;
        self.tried += 1;
        self.run.report(1.0 - 1.0 / (1.0 + 0.02 * self.tried as f64));
        let noise = fitted.deviation(samples.len());
        let count = samples.len() as f64;
        let price = 0.5 * start.parameters() as f64 * count.ln() / count;
        Ok(Judged { model: fitted.model, score: noise.max(1e-7).ln() + price, noise })
    }

    fn all(&mut self, starts: Vec<Supershaped>, more: bool, rounds: usize) -> Result<Vec<Judged>, Cancelled> {
        let mut judged = starts.into_iter().map(|s| self.fit(s, more, rounds)).collect::<Result<Vec<_>, _>>()?;
        order::rising(&mut judged, |a| a.score);
        Ok(judged)
    }

    /// The principal axes, and those of the superellipsoid. What is seen in part has its middle
    /// elsewhere: a circle tells where.
    fn all_axes(&self, quadric: &Superquadric) -> Vec<Around> {
        let points = &self.points[..self.points.len().min(SEEN)];
        let principal = Principal::of(self.points.iter().copied());
        let mut axes: Vec<Around> = Vec::new();
        for (frame, center) in [(principal.axes, principal.mean), (quadric.rotation, quadric.center)] {
            for k in 0..3 {
                let axis = frame.col(k);
                axes.push(Around::axis(points, axis, center));
                if let Some(ring) = ring_center(points, axis, center) {
                    axes.push(Around::axis(points, axis, ring));
                }
            }
        }
        axes
    }

    /// The three best axes, no two alike.
    fn axes(&self, quadric: &Superquadric) -> Vec<Around> {
        let mut axes = self.all_axes(quadric);
        order::falling(&mut axes, |a| a.explained());
        let mut kept: Vec<Around> = Vec::new();
        for axis in axes {
            if kept.len() < 3 && kept.iter().all(|k| k.frame.z_axis.dot(axis.frame.z_axis).abs() < SAME) {
                kept.push(axis);
            }
        }
        kept
    }

    pub(super) fn search(&mut self, quadric: &Superquadric) -> Result<Shapes, Cancelled> {
        match self.symmetry {
            Symmetry::Harmonics => self.by_harmonics(quadric),
            Symmetry::Sections => self.by_sections(quadric),
        }
    }

    /// The published order: the symmetry numbers first, by sections, and one fit with them.
    fn by_sections(&mut self, quadric: &Superquadric) -> Result<Shapes, Cancelled> {
        let swept = self.all_axes(quadric).into_iter().map(|axis| {
            let found = sweep(self.points, axis.square_frame(), axis.center);
            (axis, found)
        });
        // Sections from aside may agree as well, on what explains less.
        let worth = |(axis, found): &(Around, Sweep)| found.agreed * axis.explained();
        let Some((axis, found)) = swept.max_by(|a, b| worth(a).total_cmp(&worth(b))) else {
            return Ok(Shapes { best: Vec::new(), unclear: true });
        };
        let m = found.equator.filter(|m| *m > 1);
        let [equator, meridian] = [m.unwrap_or(4), m.and(found.meridian).unwrap_or(4).max(2)];
        let mut starts: Vec<Supershaped> = Vec::new();
        if equator == 2 {
            starts.extend((0..3).flat_map(|k| two_lobes(quadric, k)));
        }
        for (repeats, stretched) in [(&axis.repeats, false), (&axis.stretched, true)] {
            let found = repeats.iter().filter(|repeat| repeat.count == equator);
            starts.extend(found.flat_map(|repeat| starts_about(&axis, repeat, stretched)));
        }
        let starts = starts.into_iter().map(|start| start.with_meridian(meridian)).collect();
        let first = self.all(starts, false, 3)?;
        let next = first.into_iter().take(3).map(|j| j.model).collect();
        let mut best: Vec<Supershaped> = self.all(next, true, 2)?.into_iter().map(|j| j.model).collect();
        if let Some(top) = best.first().copied() {
            best.extend([Ties::Stretched, Ties::Free].map(|ties| top.tied(ties)));
        }
        Ok(Shapes { best, unclear: m.is_none() })
    }

    /// Whether there is a side of a model without points.
    fn is_seen_in_part(&self, model: &Supershaped) -> bool {
        let points = &self.points[..self.points.len().min(SEEN)];
        Belt::about(points, &model.rotation, model.center).gap()[0] > GAP
    }

    /// About other middles, one for each number of repetitions: what is seen in part does not tell
    /// them apart by itself.
    fn elsewhere(&mut self, axes: &[Around]) -> Result<Vec<Judged>, Cancelled> {
        let points = &self.points[..self.points.len().min(SEEN)];
        let mut starts = Vec::new();
        for axis in axes.iter().take(2) {
            let found = centered(points, axis.frame.z_axis, axis.center, self.run)?;
            for Centered { around, repeat, .. } in found.iter().take(5) {
                starts.extend(starts_about(around, repeat, false));
            }
        }
        let first = self.all(starts, false, 3)?;
        self.all(different(first), true, 3)
    }

    fn by_harmonics(&mut self, quadric: &Superquadric) -> Result<Shapes, Cancelled> {
        let axes = self.axes(quadric);
        let unclear = axes.first().map_or(0.0, Around::explained) < CLEAR;
        let mut starts = Vec::new();
        for (rank, axis) in axes.iter().enumerate() {
            let most = if rank < 2 { 2 } else { 1 };
            for repeat in axis.repeats.iter().take(most) {
                starts.extend(starts_about(axis, repeat, false));
            }
            for repeat in axis.stretched.iter().take(most) {
                starts.extend(starts_about(axis, repeat, true));
            }
        }
        let first = self.all(starts, false, 2)?;
        let mut best = self.all(different(first), true, 2)?;
        if best.first().is_some_and(|top| self.is_seen_in_part(&top.model)) {
            best.extend(self.elsewhere(&axes)?);
            order::rising(&mut best, |a| a.score);
        }
        let mut two = Vec::new();
        for k in 0..3 {
            two.extend(two_lobes(quadric, k));
        }
        let two = self.all(two, false, 3)?;
        let two: Vec<Supershaped> = two.into_iter().take(2).map(|j| j.model).collect();
        let others = two.iter().take(1).flat_map(|model| [2, 3, 5, 6].map(|m| model.with_meridian(m))).collect();
        let others = self.all(others, false, 3)?;
        let two = two.into_iter().chain(others.into_iter().take(2).map(|j| j.model)).collect();
        let two = self.all(two, true, 2)?;
        if let Some(top) = best.first().copied() {
            let is_good = top.noise < GOOD * self.rough;
            let others = best.iter().take(2).flat_map(|j| meridians(&j.model)).collect();
            let extended = self.all(others, false, 3)?;
            let next: Vec<Supershaped> = extended.into_iter().take(3).map(|j| j.model).collect();
            best.extend(self.all(next, true, 2)?);
            order::rising(&mut best, |a| a.score);
            let top = best[0].model;
            let mut other = lobes(&top, is_good);
            let opposite = top.opposite();
            other.push(opposite);
            other.extend(lobes(&opposite, true));
            let other = self.all(other, false, 3)?;
            let turned = self.all(phases(&top), false, 3)?;
            let next: Vec<Supershaped> =
                other.into_iter().take(4).chain(turned.into_iter().take(2)).map(|j| j.model).collect();
            best.extend(self.all(next, true, 2)?);
            order::rising(&mut best, |a| a.score);
            // Many lobes hide on few points on which side of 2 their exponents are.
            let opposite = best[0].model.opposite();
            let tied = if opposite.meridian.m == 4 { Ties::Stretched } else { Ties::Profiled };
            best.extend(self.all(vec![opposite.tied(tied), opposite.tied(Ties::Free)], true, 3)?);
        }
        order::rising(&mut best, |a| a.score);
        let mut found: Vec<Supershaped> = Vec::new();
        for judged in best.iter().take(3) {
            found.push(judged.model);
        }
        if let Some(top) = best.first() {
            if top.model.ties != Ties::Free {
                found.push(top.model.tied(Ties::Free));
            }
            if top.model.ties != Ties::Round {
                found.push(top.model.tied(Ties::Round));
            }
        }
        if let Some(two) = two.first() {
            found.extend([two.model, two.model.tied(Ties::Round)]);
        }
        Ok(Shapes { best: found, unclear })
    }
}

/// The best five, no more than two of one symmetry number, with fewer ties.
fn different(judged: Vec<Judged>) -> Vec<Supershaped> {
    let mut chosen: Vec<Supershaped> = Vec::new();
    for Judged { model, .. } in judged {
        let alike = chosen.iter().filter(|c| c.equator.m == model.equator.m).count();
        if chosen.len() < 5 && alike < 2 {
            chosen.push(model.tied(if model.ties == Ties::Split { Ties::Free } else { Ties::Stretched }));
        }
    }
    chosen
}

impl Supershaped {
    /// With the meridian of another symmetry number; its poles stay where they are.
    fn with_meridian(&self, m: u32) -> Supershaped {
        if m == self.meridian.m {
            return *self;
        }
        let meridian = Curve { m, n: [2.85, 3.5, 3.5] };
        let mut other = Supershaped { meridian, ..self.tied(Ties::Profiled) };
        other.semi_axes.z /= meridian.radius_at(FRAC_PI_2) / self.meridian.radius_at(FRAC_PI_2);
        other
    }
}

/// Phases, exponents and meridians by the radii of a repetition. A stretched section is longest
/// along x or along y.
fn starts_about(axis: &Around, repeat: &Repeat, stretched: bool) -> Vec<Supershaped> {
    let ratio = (repeat.radii[1] / repeat.radii[0]).ln().max(1e-3);
    let mut starts = Vec::new();
    if repeat.is_double && !stretched {
        starts.extend(leaning(axis, repeat, ratio));
    }
    // Corners where the radius is 1, or hollows.
    let phases = [(4.0, repeat.least, repeat.radii[0]), (1.2, repeat.greatest, repeat.radii[1])];
    for (n, turn, radius) in phases {
        let n1 = ((0.5 * n - 1.0f64).abs() * LN_2 / ratio).clamp(0.2, 200.0);
        for (meridian, grown) in [(2.2, 1.1), (7.0, 1.0)] {
            let model = |turn: f64, long: f64, ties| Supershaped {
                equator: Curve { m: repeat.count, n: [n1, n, n] },
                meridian: Curve { m: 4, n: [meridian; 3] },
                semi_axes: DVec3::new(grown * radius * long, grown * radius / long, axis.height)
                    .clamp(DVec3::splat(1e-3), DVec3::splat(30.0)),
                rotation: axis.frame * DMat3::from_rotation_z(turn),
                center: axis.center,
                ties,
                rational: false,
            };
            if stretched {
                let long = axis.long.sqrt();
                starts.push(model(axis.first, long, Ties::Stretched));
                starts.push(model(axis.first + FRAC_PI_2, 1.0 / long, Ties::Stretched));
            } else {
                starts.push(model(turn, 1.0, Ties::Round));
            }
        }
    }
    starts
}

/// Twice as many lobes as there are repetitions, that lean to either side: n2 and n3 differ.
fn leaning(axis: &Around, repeat: &Repeat, ratio: f64) -> Vec<Supershaped> {
    let n1 = (LN_2 / ratio).clamp(0.2, 200.0);
    let model = |lean: f64, meridian: f64, grown: f64| Supershaped {
        equator: Curve { m: 2 * repeat.count, n: [n1, 4.0 * lean, 4.0 / lean] },
        meridian: Curve { m: 4, n: [meridian; 3] },
        semi_axes: DVec3::new(grown * repeat.radii[0], grown * repeat.radii[0], axis.height)
            .clamp(DVec3::splat(1e-3), DVec3::splat(30.0)),
        rotation: axis.frame * DMat3::from_rotation_z(repeat.least),
        center: axis.center,
        ties: Ties::Split,
        rational: false,
    };
    let leans = [1.25, 0.8];
    leans.into_iter().flat_map(|lean| [model(lean, 2.2, 1.1), model(lean, 7.0, 1.0)]).collect()
}

/// Two lobes along one axis of a superellipsoid, about another: made by the sizes, or by the
/// exponents.
fn two_lobes(quadric: &Superquadric, turns: usize) -> Vec<Supershaped> {
    let quadric = quadric.permuted(turns);
    let a = quadric.semi_axes;
    let model = |turn: f64, n: [f64; 3], semi_axes: DVec3, ties| Supershaped {
        equator: Curve { m: 2, n },
        meridian: Curve { m: 4, n: [2.0 / quadric.e[0].clamp(0.1, 1.9); 3] },
        semi_axes,
        rotation: quadric.rotation * DMat3::from_rotation_z(turn),
        center: quadric.center,
        ties,
        rational: false,
    };
    let (short, turn) = if a.x <= a.y { (a.x, 0.0) } else { (a.y, FRAC_PI_2) };
    let ratio = (a.x.max(a.y) / short).ln().clamp(0.02, 2.0);
    let n = 5.0;
    vec![
        model(0.0, [2.0, 3.0, 3.0], a, Ties::Stretched),
        model(FRAC_PI_2, [2.0, 3.0, 3.0], DVec3::new(a.y, a.x, a.z), Ties::Stretched),
        model(turn, [(0.5 * n - 1.0) * LN_2 / ratio, n, n], DVec3::new(short, short, a.z), Ties::Round),
    ]
}

/// Other meridians, and untied exponents.
fn meridians(of: &Supershaped) -> Vec<Supershaped> {
    let mut all = vec![of.tied(Ties::Free)];
    all.extend([2, 3, 5, 6].map(|m| of.with_meridian(m)));
    all
}

/// Lobes that lean to either side, and twice as many of them unless the fit is good as it is.
fn lobes(of: &Supershaped, is_good: bool) -> Vec<Supershaped> {
    let of = of.tied(if of.ties.meridian() { Ties::Split } else { Ties::Free });
    let mut all = Vec::new();
    let mut unequal = vec![of.equator];
    if !is_good {
        unequal.push(Curve { m: 2 * of.equator.m, ..of.equator });
    }
    for curve in unequal {
        for ratio in [1.5, 1.0 / 1.5] {
            let [n1, n2, n3] = curve.n;
            let equator = Curve { n: [n1, n2 * f64::sqrt(ratio), n3 / f64::sqrt(ratio)], ..curve };
            let leaning = Supershaped { equator, ..of };
            all.push(leaning);
            if curve.m != of.equator.m {
                let rotation = of.rotation * DMat3::from_rotation_z(0.5 * TAU / f64::from(curve.m));
                all.push(Supershaped { rotation, ..leaning });
            }
        }
    }
    all
}

/// The best one turned by whole lobes: a stretch ties it to one of them.
fn phases(top: &Supershaped) -> Vec<Supershaped> {
    let round = top.tied(Ties::Round);
    let m = top.equator.m;
    // Half a turn is the same.
    let lobes = if m.is_multiple_of(2) { m / 2 } else { m };
    (1..lobes)
        .map(|j| Supershaped {
            rotation: top.rotation * DMat3::from_rotation_z(TAU * f64::from(j) / f64::from(m)),
            ties: Ties::Stretched,
            ..round
        })
        .collect()
}
