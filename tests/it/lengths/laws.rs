//! Laws of lengths, over random solids of the whole catalogue: leaves, maps, joins, blends, lengths
//! of lengths, and the examples of all entries.
//!
//! A few solids are tried in every run, each with one of the laws. The ignored tests try all laws
//! on as many as are asked for, `LENGTHS_SEEDS=0..2000`, and print what they find.

use std::cell::OnceCell;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use rvachev::{
    Bounds, Solid, catalogue,
    catalogue::Part,
    program::{Program, Tape},
};

use super::reference::Surface;
use super::{Outcome, TOLERANCE};
use crate::length_ranges::{missed, place};
use crate::narrow::contradiction;
use crate::support::{Random, frame_of, lanes32, random_box, random_solid, samples};

/// Cells along the longest side of the mesh that distances are measured to.
const CELLS: u32 = 40;

/// Points that a law is tried at, of a solid.
const POINTS: usize = 40;

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

/// The solid within its frame; `None` if it holds nothing there.
fn cut(solid: Solid) -> Option<Solid> {
    let bounds = solid.bounds().ok()?;
    let frame = frame_of(&solid);
    let solid = if bounds.is_finite() { solid } else { solid & Solid::cuboid(frame.size()).translate(frame.center()) };
    solid.bounds().is_ok_and(|bounds| !bounds.is_empty()).then_some(solid)
}

/// A solid, and the length that laws are tried with.
struct Subject {
    solid: Solid,
    length: f64,
    frame: Bounds,
    surface: OnceCell<Option<Surface>>,
}

impl Subject {
    fn new(solid: Solid, random: &mut Random) -> Subject {
        let frame = frame_of(&solid);
        let length = frame.size().min_element().max(1e-3) * random.log_range(0.005, 0.15);
        Subject { solid, length, frame, surface: OnceCell::new() }
    }

    /// The most that a surface may be off, beyond which nothing is listed: three tolerances.
    fn doubt(&self) -> f64 {
        3.0 * TOLERANCE * self.length + 1e-7 * self.frame.longest_side()
    }

    /// The mesh that distances are measured to; `None` if there is none.
    fn surface(&self) -> Result<Option<&Surface>, Box<dyn Error>> {
        if self.surface.get().is_none() {
            let surface = Surface::new(&self.solid, CELLS)?;
            return Ok(self.surface.get_or_init(|| surface).as_ref());
        }
        Ok(self.surface.get().and_then(Option::as_ref))
    }

    /// The signed distance by brute force: at least, and at most.
    fn distance(&self, surface: &Surface, p: DVec3) -> Result<[f64; 2], Box<dyn Error>> {
        let [least, most] = surface.distance(p);
        Ok(if self.solid.contains(p)? { [least, most] } else { [-most, -least] })
    }

    /// Points up to two lengths from the surface.
    fn points_beside(&self, surface: &Surface, random: &mut Random) -> Vec<DVec3> {
        let beside = |_| {
            let from = surface.point(random.below(surface.len()), [random.unit(), random.unit()]);
            from + self.length * random.range(0.0, 2.0) * random.direction()
        };
        (0..POINTS).map(beside).collect()
    }

    /// Points in and around the solid's box.
    fn points_around(&self, random: &mut Random) -> Vec<DVec3> {
        let around = self.frame.inflate(2.0 * self.length);
        (0..POINTS).map(|_| random.point_in(&around)).collect()
    }

    /// The solid under each of the verbs.
    fn verbs(&self) -> [(&'static str, Solid); 5] {
        let (solid, length) = (&self.solid, self.length);
        [
            ("offset", solid.offset(length)),
            ("inset", solid.offset(-0.5 * length)),
            ("shell", solid.shell(length)),
            ("rounded", solid.rounded(length)),
            ("filleted", solid.filleted(length)),
        ]
    }

    /// One of the verbs.
    fn a_verb(&self, random: &mut Random) -> (&'static str, Solid) {
        let verbs = self.verbs();
        let [offset, inset, shell, rounded, filleted] = verbs;
        match random.below(5) {
            0 => offset,
            1 => inset,
            2 => shell,
            3 => rounded,
            _ => filleted,
        }
    }
}

/// How often a law was tried, and where it does not hold.
#[derive(Default)]
struct Tally {
    tried: usize,
    /// Points beyond one tolerance, where that is told apart from three.
    beyond: usize,
    failures: Vec<String>,
}

impl Tally {
    fn check(&mut self, holds: bool, text: impl FnOnce() -> String) {
        self.tried += 1;
        if !holds {
            self.failures.push(text());
        }
    }
}

type Law = fn(&Subject, &mut Random, &mut Tally) -> Outcome;

const LAWS: [(&str, Law); 10] = [
    ("distances are those by brute force", distances),
    ("offsets add up", sums),
    ("opening", openings),
    ("closing", closings),
    ("walls of shells", walls),
    ("nothing is inside and outside of the bounds", bounds),
    ("ranges hold every value", ranges),
    ("narrowed programs have the sign of the whole", narrowed),
    ("lanes have the sign of values", lanes),
    ("nearest points", nearest),
];

/// Offsets by both signs contain a point if its distance says so, and have the distance as their
/// value beside the surface.
fn distances(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some(surface) = subject.surface()? else { return Ok(()) };
    for by in [subject.length, -0.5 * subject.length] {
        let moved = subject.solid.offset(by);
        for p in subject.points_beside(surface, random) {
            let [least, most] = subject.distance(surface, p)?;
            let (inside, value) = (moved.contains(p)?, moved.value(p)?);
            let off = (-by - most).max(0.0) * f64::from(u8::from(inside))
                + (least + by).max(0.0) * f64::from(u8::from(!inside));
            tally.beyond += usize::from(off > subject.doubt() / 3.0);
            tally.check(off <= subject.doubt(), || {
                format!("{by} at {p}: {value}, off by {off:e}, distance {least} to {most}")
            });
            let beside = surface.is_whole() && least + by > -0.2 * by.abs() && most + by < 0.2 * by.abs();
            let told = least + by - subject.doubt()..=most + by + subject.doubt();
            tally.check(!beside || told.contains(&value), || {
                format!("{by} at {p}: the value is {value}, the distance {least} to {most}")
            });
        }
    }
    Ok(())
}

/// Two offsets outwards are one by their sum.
fn sums(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let share = random.range(0.1, 0.9);
    let (first, second) = (share * subject.length, (1.0 - share) * subject.length);
    let (two, one) = (subject.solid.offset(first).offset(second), subject.solid.offset(subject.length));
    let points = match subject.surface()? {
        Some(surface) => subject.points_beside(surface, random),
        None => subject.points_around(random),
    };
    for p in points {
        let [two, one] = [two.value(p)?, one.value(p)?];
        let same = (two > 0.0) == (one > 0.0);
        tally.check(same || two.abs().min(one.abs()) <= subject.doubt(), || {
            format!("{first} + {second} at {p}: {two}, but {one} at once")
        });
    }
    Ok(())
}

/// What is opened is within the solid, holds what is a length inside, and stays when it is opened
/// again by a ball that is a little smaller.
fn openings(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (solid, length) = (&subject.solid, subject.length);
    let opened = solid.rounded(length);
    let (inner, again) = (solid.offset(-length), opened.rounded(0.99 * length));
    let mut points = subject.points_around(random);
    if let Some(surface) = subject.surface()? {
        points.extend(subject.points_beside(surface, random));
    }
    for p in points {
        let (inside, value, kept) = (solid.contains(p)?, opened.value(p)?, again.contains(p)?);
        tally.check(inside || value <= 0.0, || format!("{length} at {p}: opening adds it"));
        tally.check(value > 0.0 || inner.value(p)? <= subject.doubt(), || {
            format!("{length} at {p}: opening loses what is inside by a length")
        });
        tally.check(kept || value <= subject.doubt(), || {
            format!("{length} at {p}: opening again loses it, the value is {value}")
        });
        tally.check(!kept || value > 0.0, || format!("{length} at {p}: opening again adds it"));
    }
    Ok(())
}

/// What is closed holds the solid, is within what is a length outside, and stays when it is closed
/// again by a ball that is a little smaller.
fn closings(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (solid, length) = (&subject.solid, subject.length);
    let closed = solid.filleted(length);
    let (outer, again) = (solid.offset(length), closed.filleted(0.99 * length));
    let mut points = subject.points_around(random);
    if let Some(surface) = subject.surface()? {
        points.extend(subject.points_beside(surface, random));
    }
    for p in points {
        let (inside, value, kept) = (solid.contains(p)?, closed.value(p)?, again.contains(p)?);
        tally.check(!inside || value > 0.0, || format!("{length} at {p}: closing loses it"));
        tally.check(value <= 0.0 || outer.value(p)? >= -subject.doubt(), || {
            format!("{length} at {p}: closing adds what is outside by a length")
        });
        tally.check(!kept || value >= -subject.doubt(), || {
            format!("{length} at {p}: closing again adds it, the value is {value}")
        });
        tally.check(kept || value <= 0.0, || format!("{length} at {p}: closing again loses it"));
    }
    Ok(())
}

/// A shell's outer face is the solid's own, its inner face is where the distance is its thickness.
fn walls(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some(surface) = subject.surface()? else { return Ok(()) };
    let thickness = subject.length;
    let shell = subject.solid.shell(thickness);
    for p in subject.points_beside(surface, random) {
        let (inside, of_shell) = (subject.solid.contains(p)?, shell.contains(p)?);
        tally.check(inside || !of_shell, || format!("{thickness} at {p}: the shell leaves the solid"));
        let [least, most] = subject.distance(surface, p)?;
        let clearly_within = inside && most < thickness - subject.doubt();
        let clearly_beyond = least > thickness + subject.doubt();
        tally.check(of_shell || !clearly_within, || format!("{thickness} at {p}: no wall at a depth of {most}"));
        tally.check(!of_shell || !clearly_beyond, || format!("{thickness} at {p}: a wall at a depth of {least}"));
    }
    Ok(())
}

fn bounds(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (name, solid) = subject.a_verb(random);
    let bounds = solid.bounds()?;
    let mut points = subject.points_around(random);
    if let Some(surface) = subject.surface()? {
        points.extend(subject.points_beside(surface, random));
    }
    for p in points {
        tally.check(bounds.contains(p) || !solid.contains(p)?, || {
            format!("{name} by {} at {p}: inside, but outside of {bounds:?}", subject.length)
        });
    }
    Ok(())
}

/// The surface program of the solid under one of the verbs.
fn program(subject: &Subject, random: &mut Random) -> Result<(String, Program), Box<dyn Error>> {
    let (name, solid) = subject.a_verb(random);
    Ok((format!("{name} by {}", subject.length), solid.surface_program()?))
}

fn ranges(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (name, program) = program(subject, random)?;
    for _ in 0..12 {
        let region = place(random, &subject.frame);
        let missed = missed(random, &program, &region);
        tally.check(missed.is_none(), || format!("{name}: {}", missed.unwrap_or_default()));
    }
    Ok(())
}

fn narrowed(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (name, program) = program(subject, random)?;
    let frame = subject.frame.inflate(2.0 * subject.length);
    for _ in 0..12 {
        let region = random_box(random, &frame);
        let points = samples(random, &region, 30);
        let wrong = contradiction(&program, &region, &program.narrow(&region), &points);
        tally.check(wrong.is_none(), || format!("{name}: {}", wrong.unwrap_or_default()));
    }
    Ok(())
}

fn lanes(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (name, program) = program(subject, random)?;
    let frame = subject.frame.inflate(2.0 * subject.length);
    for _ in 0..6 {
        let region = random_box(random, &frame);
        let doubt = Tape::new(&program, &region).roundoff();
        let (seen, lanes) = lanes32(&program, &region, &samples(random, &region, 40));
        for (p, lane) in seen.into_iter().zip(lanes).filter(|(_, lane)| lane.abs() > doubt) {
            let value = program.value(p);
            tally.check((lane > 0.0) == (value > 0.0), || {
                format!("{name} at {p}: {lane} in f32, {value} in f64, roundoff {doubt:e}")
            });
        }
    }
    Ok(())
}

/// From outside of an offset outwards, its surface is nearer than the solid's by the length.
fn nearest(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some(surface) = subject.surface()? else { return Ok(()) };
    let moved = subject.solid.offset(subject.length);
    for p in subject.points_around(random).into_iter().take(10) {
        let [least, most] = subject.distance(surface, p)?;
        if most > -subject.length - subject.doubt() {
            continue;
        }
        let found = moved.closest_surface_point(p)?;
        let way = found.map_or(f64::INFINITY, |q| q.distance(p));
        let told = -most - subject.length - subject.doubt()..=-least - subject.length + subject.doubt();
        tally.check(told.contains(&way), || format!("{} from {p}: {way}, not in {told:?}", subject.length));
    }
    Ok(())
}

/// Tries a law; an error or a panic is a failure of it.
fn attempt(law: Law, subject: &Subject, seed: u64, tally: &mut Tally) {
    let mut random = Random::new(seed);
    let before = tally.failures.len();
    let outcome = catch_unwind(AssertUnwindSafe(|| law(subject, &mut random, tally)));
    match outcome {
        Ok(Ok(())) => {}
        Ok(Err(error)) => tally.check(false, || error.to_string()),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned().unwrap_or_default();
            tally.check(false, || format!("panic: {text}"));
        }
    }
    for text in &mut tally.failures[before..] {
        *text = format!("seed {seed}: {text}, of {:?}", subject.solid);
    }
}

fn print(name: &str, tally: &Tally) {
    let Tally { tried, beyond, failures } = tally;
    println!("{name}: {} of {tried} fail, {beyond} beyond one tolerance", failures.len());
    for text in failures.iter().take(5) {
        println!("    {text}");
    }
}

/// Prints what was found, and fails if a law does not hold.
fn judge(tallies: &[Tally]) {
    for ((name, _), tally) in LAWS.iter().zip(tallies) {
        print(name, tally);
    }
    for ((name, _), tally) in LAWS.iter().zip(tallies) {
        assert!(tally.failures.is_empty(), "{name}: {} of {}", tally.failures.len(), tally.tried);
        // 99.9 % are within one tolerance.
        assert!(tally.beyond <= 1 + tally.tried / 1000, "{name}: {} of {} are beyond", tally.beyond, tally.tried);
    }
}

fn none() -> Vec<Tally> {
    LAWS.iter().map(|_| Tally::default()).collect()
}

fn subject(seed: u64, depth: usize) -> Subject {
    let mut random = Random::new(seed);
    let solid = bounded(&mut random, depth);
    Subject::new(solid, &mut random)
}

#[test]
fn laws_hold_for_a_few_solids() {
    let mut tallies = none();
    for (seed, (tally, (_, law))) in (7004..).zip(tallies.iter_mut().zip(LAWS)) {
        attempt(law, &subject(seed, 1), seed, tally);
    }
    assert!(tallies.iter().filter(|tally| tally.tried > 0).count() > 7);
    judge(&tallies);
}

/// The seeds that are asked for: `LENGTHS_SEEDS=0..2000`.
fn seeds() -> std::ops::Range<u64> {
    let text = std::env::var("LENGTHS_SEEDS").unwrap_or_default();
    let parsed = text.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    parsed.unwrap_or(0..2000)
}

#[test]
#[ignore = "takes hours on one core: LENGTHS_SEEDS=0..2000 chooses"]
fn laws_hold_for_thousands_of_solids() {
    let mut tallies = none();
    for seed in seeds() {
        let subject = subject(seed, 2);
        let before: usize = tallies.iter().map(|tally| tally.failures.len()).sum();
        for ((_, law), tally) in LAWS.iter().zip(&mut tallies) {
            attempt(*law, &subject, seed, tally);
        }
        let failures = tallies.iter().map(|tally| tally.failures.len()).sum::<usize>() - before;
        if failures > 0 {
            println!("seed {seed}: {failures} failures, {:?}", subject.solid);
        }
        if seed % 100 == 99 {
            println!("-- up to seed {seed}");
            for ((name, _), tally) in LAWS.iter().zip(&tallies) {
                print(name, tally);
            }
        }
    }
    judge(&tallies);
}

/// The examples of all entries of the catalogue that are solids or profiles.
fn examples() -> Vec<(&'static str, Solid)> {
    let solid = |part| match part {
        Part::Solid(solid) => cut(solid),
        Part::Profile(profile) => cut(profile.extrude(1.0)),
        _ => None,
    };
    catalogue().iter().filter_map(|entry| Some((entry.name(), solid(entry.example())?))).collect()
}

#[test]
fn bounds_of_offset_examples_hold_them() {
    let mut tally = Tally::default();
    // A part of the catalogue; the ignored test takes all of it.
    for (i, (name, solid)) in examples().into_iter().enumerate().filter(|(i, _)| i % 7 == 3) {
        println!("{name}");
        let subject = Subject::new(solid, &mut Random::new(i as u64));
        attempt(bounds, &subject, 7100 + i as u64, &mut tally);
    }
    print("bounds", &tally);
    assert!(tally.tried > 300 && tally.failures.is_empty());
}

#[test]
#[ignore = "takes minutes"]
fn laws_hold_for_every_example_of_the_catalogue() {
    let mut tallies = none();
    for (i, (name, solid)) in examples().into_iter().enumerate() {
        let subject = Subject::new(solid, &mut Random::new(i as u64));
        let before: usize = tallies.iter().map(|tally| tally.failures.len()).sum();
        for ((_, law), tally) in LAWS.iter().zip(&mut tallies) {
            attempt(*law, &subject, 7200 + i as u64, tally);
        }
        let failures = tallies.iter().map(|tally| tally.failures.len()).sum::<usize>() - before;
        println!("{name}: {failures} failures");
    }
    judge(&tallies);
}
