//! A solid that laws of lengths are tried on, under each of the verbs, and what is found.

use std::cell::{OnceCell, RefCell};
use std::error::Error;
use std::time::Duration;

use cpu_time::ProcessTime;
use glam::DVec3;
use rvachev::{Bounds, CancelToken, Progress, Run, Solid, error::PrepareError};

use super::TOLERANCE;
use super::reference::Surface;
use crate::support::{Random, frame_of, random_solid};

/// Cells along the longest side of the mesh that distances are measured to.
const CELLS: u32 = 32;

/// Points that a law is tried at, of a solid.
const POINTS: usize = 60;

/// Lengths of lengths are measured to this many tolerances: what is asked of them is the same.
const COARSE: f64 = 4.0;

/// A solid that takes longer to be measured is left out, and told: so much time of all processors,
/// which does not depend on what else they do.
const PATIENCE: Duration = Duration::from_secs(100);

/// A random solid that ends: cut to its frame if it does not.
pub fn bounded(random: &mut Random, depth: usize) -> Solid {
    loop {
        let depth = random.below(depth + 1);
        let solid = random_solid(random, depth);
        if let Some(solid) = cut(solid) {
            return solid;
        }
    }
}

/// The solid within its frame if it does not end; `None` if it holds nothing there.
pub fn cut(solid: Solid) -> Option<Solid> {
    let bounds = solid.bounds().ok()?;
    let frame = frame_of(&solid);
    let solid = if bounds.is_finite() { solid } else { solid & Solid::cuboid(frame.size()).translate(frame.center()) };
    solid.bounds().is_ok_and(|bounds| !bounds.is_empty()).then_some(solid)
}

/// The verbs of lengths.
#[derive(Clone, Copy, Debug)]
pub enum Verb {
    Offset,
    Inset,
    Shell,
    Rounded,
    Filleted,
}

impl Verb {
    const ALL: [Verb; 5] = [Verb::Offset, Verb::Inset, Verb::Shell, Verb::Rounded, Verb::Filleted];
}

/// A solid, and the length that laws are tried with.
pub struct Subject {
    pub solid: Solid,
    pub length: f64,
    pub frame: Bounds,
    surface: OnceCell<Option<Surface>>,
    verbs: [OnceCell<Option<Solid>>; Verb::ALL.len()],
    slow: RefCell<Vec<&'static str>>,
}

impl Subject {
    pub fn new(solid: Solid, random: &mut Random) -> Subject {
        let frame = solid.bounds().ok().filter(Bounds::is_finite).unwrap_or_else(|| frame_of(&solid));
        // Of a power of two, so that half of it shares the surface that it is measured from.
        let length = frame.size().min_element().max(1e-3) * random.log_range(0.008, 0.12);
        let length = 1.9 * length.log2().floor().exp2();
        let (surface, verbs, slow) = Default::default();
        Subject { solid, length, frame, surface, verbs, slow }
    }

    /// The most that a surface may be off, beyond which nothing is listed: three tolerances.
    pub fn doubt(&self) -> f64 {
        3.0 * TOLERANCE * self.length + 1e-7 * self.frame.longest_side()
    }

    /// The same of lengths of lengths.
    pub fn coarse_doubt(&self) -> f64 {
        COARSE * self.doubt()
    }

    /// The mesh that distances are measured to; `None` if there is none.
    pub fn surface(&self) -> Result<Option<&Surface>, Box<dyn Error>> {
        if self.surface.get().is_none() {
            let surface = Surface::new(&self.solid, CELLS)?;
            return Ok(self.surface.get_or_init(|| surface).as_ref());
        }
        Ok(self.surface.get().and_then(Option::as_ref))
    }

    /// The signed distance by brute force: at least, and at most.
    pub fn distance(&self, surface: &Surface, p: DVec3) -> Result<[f64; 2], Box<dyn Error>> {
        let [least, most] = surface.distance(p);
        Ok(if self.solid.contains(p)? { [least, most] } else { [-most, -least] })
    }

    /// Points up to two lengths from the surface.
    pub fn points_beside(&self, surface: &Surface, random: &mut Random) -> Vec<DVec3> {
        let beside = |_| {
            let from = surface.point(random.below(surface.len()), [random.unit(), random.unit()]);
            from + self.length * random.range(0.0, 2.0) * random.direction()
        };
        (0..POINTS).map(beside).collect()
    }

    /// Points in and around the solid's box.
    pub fn points_around(&self, random: &mut Random) -> Vec<DVec3> {
        let around = self.frame.inflate(2.0 * self.length);
        (0..POINTS).map(|_| random.point_in(&around)).collect()
    }

    /// Both, if there is a surface.
    pub fn points(&self, random: &mut Random) -> Result<Vec<DVec3>, Box<dyn Error>> {
        let mut points = self.points_around(random);
        if let Some(surface) = self.surface()? {
            points.extend(self.points_beside(surface, random));
        }
        Ok(points)
    }

    /// The solid under a verb; `None` if it is not measured in time.
    pub fn under(&self, verb: Verb) -> Result<Option<&Solid>, Box<dyn Error>> {
        let known = &self.verbs[verb as usize];
        if known.get().is_none() {
            let (solid, length) = (&self.solid, self.length);
            let moved = match verb {
                Verb::Offset => solid.offset(length),
                Verb::Inset => solid.offset(-INSET * length),
                Verb::Shell => solid.shell(length),
                Verb::Rounded => self.coarse(solid.rounded(length)),
                Verb::Filleted => self.coarse(solid.filleted(length)),
            };
            let moved = self.measured(moved, "a verb")?;
            return Ok(known.get_or_init(|| moved).as_ref());
        }
        Ok(known.get().and_then(Option::as_ref))
    }

    /// The solid under one of the verbs.
    pub fn under_any(&self, random: &mut Random) -> Result<Option<(String, &Solid)>, Box<dyn Error>> {
        let verb = random.pick(&Verb::ALL);
        Ok(self.under(verb)?.map(|solid| (format!("{verb:?} by {}", self.length), solid)))
    }

    /// A length of lengths, measured to a coarse tolerance.
    pub fn coarse(&self, solid: Solid) -> Solid {
        solid.with_tolerance(COARSE * TOLERANCE * self.length)
    }

    /// A solid once its lengths are measured; `None` if that takes too long.
    pub fn measured(&self, solid: Solid, what: &'static str) -> Result<Option<Solid>, Box<dyn Error>> {
        let cancel = CancelToken::new();
        let (token, start) = (cancel.clone(), ProcessTime::now());
        let progress = Progress::new(move |_| {
            if start.elapsed() > PATIENCE {
                token.cancel();
            }
        });
        match solid.prepare(&Run { cancel, progress: Some(progress), ..Run::default() }) {
            Ok(_) => Ok(Some(solid)),
            Err(PrepareError::Cancelled(_)) => {
                self.slow.borrow_mut().push(what);
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// What was left out.
    pub fn slow(&self) -> Vec<&'static str> {
        self.slow.borrow().clone()
    }
}

/// Insets are by this part of the length.
pub const INSET: f64 = 0.55;

/// How often a law was tried, and where it does not hold.
#[derive(Default)]
pub struct Tally {
    pub tried: usize,
    /// Points beyond one tolerance, where that is told apart from three.
    pub beyond: usize,
    pub failures: Vec<String>,
    /// How long it took.
    pub time: Duration,
}

impl Tally {
    pub fn check(&mut self, holds: bool, text: impl FnOnce() -> String) {
        self.tried += 1;
        if !holds {
            self.failures.push(text());
        }
    }
}
