//! Laws of lengths, over random solids of the whole catalogue: leaves, maps, joins, blends, lengths
//! of lengths, and the examples of all entries.
//!
//! A few solids are tried in every run, each with one of the laws. The ignored tests try all laws:
//! on the examples of all entries of the catalogue, and on as many random solids as are asked for,
//! `LENGTHS_SEEDS=0..2000`. They print what they find.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use rvachev::{
    Solid, catalogue,
    catalogue::Part,
    program::{Program, Tape},
};

use super::Outcome;
use super::subject::{INSET, Subject, Tally, Verb, bounded, cut};
use crate::length_ranges::{missed, place};
use crate::narrow::contradiction;
use crate::support::{Random, lanes32, random_box, samples};

/// The nearest point may be farther away than another one by this part of the size, which surfaces
/// are measured to for it.
const NEAREST: f64 = 2e-4;

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
    for (verb, by) in [(Verb::Offset, subject.length), (Verb::Inset, -INSET * subject.length)] {
        let Some(moved) = subject.under(verb)? else { continue };
        let points = subject.points_beside(surface, random);
        let (contained, values) = (moved.contains_all(&points)?, moved.values(&points)?);
        for ((p, inside), value) in points.into_iter().zip(contained).zip(values) {
            let [least, most] = subject.distance(surface, p)?;
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

/// Two offsets outwards are one by their sum. A level between them keeps them from being compiled
/// as one.
fn sums(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let share = random.range(0.3, 0.7);
    let (first, second) = (share * subject.length, (1.0 - share) * subject.length);
    let Some(one) = subject.under(Verb::Offset)? else { return Ok(()) };
    let two = subject.coarse(subject.coarse(subject.solid.offset(first)).level(0.0).offset(second));
    let Some(two) = subject.measured(two, "an offset of an offset")? else { return Ok(()) };
    let points = subject.points(random)?;
    for ((p, two), one) in points.iter().zip(two.values(&points)?).zip(one.values(&points)?) {
        let same = (two > 0.0) == (one > 0.0);
        tally.check(same || two.abs().min(one.abs()) <= subject.coarse_doubt(), || {
            format!("{first} + {second} at {p}: {two}, but {one} at once")
        });
    }
    Ok(())
}

/// What is opened is within the solid, holds what is a length inside, and stays when it is opened
/// again by a smaller ball.
fn openings(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (solid, length, doubt) = (&subject.solid, subject.length, subject.coarse_doubt());
    let Some(opened) = subject.under(Verb::Rounded)? else { return Ok(()) };
    let Some(inset) = subject.under(Verb::Inset)? else { return Ok(()) };
    let again = subject.measured(subject.coarse(opened.rounded(0.8 * length)), "opening again")?;
    let points = subject.points(random)?;
    let (inside, values, inner) = (solid.contains_all(&points)?, opened.values(&points)?, inset.values(&points)?);
    let kept =
        again.map_or_else(|| Ok(values.iter().map(|v| *v > 0.0).collect()), |again| again.contains_all(&points))?;
    for (i, p) in points.iter().enumerate() {
        let value = values[i];
        tally.check(inside[i] || value <= 0.0, || format!("{length} at {p}: opening adds it"));
        tally.check(value > 0.0 || inner[i] <= (1.0 - INSET) * length + doubt, || {
            format!("{length} at {p}: opening loses what is inside by a length")
        });
        tally.check(kept[i] || value <= doubt, || {
            format!("{length} at {p}: opening again loses it, the value is {value}")
        });
        tally.check(!kept[i] || value > 0.0, || format!("{length} at {p}: opening again adds it"));
    }
    Ok(())
}

/// What is closed holds the solid, is within what is a length outside, and stays when it is closed
/// again by a smaller ball.
fn closings(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let (solid, length, doubt) = (&subject.solid, subject.length, subject.coarse_doubt());
    let Some(closed) = subject.under(Verb::Filleted)? else { return Ok(()) };
    let Some(outer) = subject.under(Verb::Offset)? else { return Ok(()) };
    let again = subject.measured(subject.coarse(closed.filleted(0.8 * length)), "closing again")?;
    let points = subject.points(random)?;
    let (inside, values, outer) = (solid.contains_all(&points)?, closed.values(&points)?, outer.values(&points)?);
    let kept =
        again.map_or_else(|| Ok(values.iter().map(|v| *v > 0.0).collect()), |again| again.contains_all(&points))?;
    for (i, p) in points.iter().enumerate() {
        let value = values[i];
        tally.check(!inside[i] || value > 0.0, || format!("{length} at {p}: closing loses it"));
        tally.check(value <= 0.0 || outer[i] >= -doubt, || {
            format!("{length} at {p}: closing adds what is outside by a length")
        });
        tally.check(!kept[i] || value >= -doubt, || {
            format!("{length} at {p}: closing again adds it, the value is {value}")
        });
        tally.check(kept[i] || value <= 0.0, || format!("{length} at {p}: closing again loses it"));
    }
    Ok(())
}

/// A shell's outer face is the solid's own, its inner face is where the distance is its thickness.
fn walls(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some(surface) = subject.surface()? else { return Ok(()) };
    let Some(shell) = subject.under(Verb::Shell)? else { return Ok(()) };
    let thickness = subject.length;
    let points = subject.points_beside(surface, random);
    let (inside, of_shell) = (subject.solid.contains_all(&points)?, shell.contains_all(&points)?);
    for ((p, inside), of_shell) in points.into_iter().zip(inside).zip(of_shell) {
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
    let Some((name, solid)) = subject.under_any(random)? else { return Ok(()) };
    let bounds = solid.bounds()?;
    let points = subject.points(random)?;
    for (p, inside) in points.iter().zip(solid.contains_all(&points)?) {
        tally.check(bounds.contains(*p) || !inside, || format!("{name} at {p}: inside, but outside of {bounds:?}"));
    }
    Ok(())
}

/// The surface program of the solid under one of the verbs.
fn program(subject: &Subject, random: &mut Random) -> Result<Option<(String, Program)>, Box<dyn std::error::Error>> {
    let Some((name, solid)) = subject.under_any(random)? else { return Ok(None) };
    Ok(Some((name, solid.surface_program()?)))
}

fn ranges(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some((name, program)) = program(subject, random)? else { return Ok(()) };
    for _ in 0..12 {
        let region = place(random, &subject.frame);
        let missed = missed(random, &program, &region);
        tally.check(missed.is_none(), || format!("{name}: {}", missed.unwrap_or_default()));
    }
    Ok(())
}

fn narrowed(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some((name, program)) = program(subject, random)? else { return Ok(()) };
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
    let Some((name, program)) = program(subject, random)? else { return Ok(()) };
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

/// A point is as far from the nearest point of the surface as from the mesh, from outside and from
/// inside. From outside of an offset outwards its surface is nearer than the solid's by the length;
/// so is that of an inset from inside. A point of the surface is its own nearest point.
fn nearest(subject: &Subject, random: &mut Random, tally: &mut Tally) -> Outcome {
    let Some(surface) = subject.surface()? else { return Ok(()) };
    let (solid, length) = (&subject.solid, subject.length);
    let mut points = subject.points_around(random);
    points.truncate(10);
    points.extend(subject.points_beside(surface, random).into_iter().take(10));
    // What is so much farther away may be found to be nearest.
    let slack = NEAREST * subject.frame.longest_side();
    let grown = subject.under(Verb::Offset)?;
    let shrunk = subject.under(Verb::Inset)?;
    for p in points {
        let [least, most] = subject.distance(surface, p)?;
        let sides =
            [(Some(solid), 0.0, slack), (grown, -length, subject.doubt()), (shrunk, INSET * length, subject.doubt())];
        for (solid, level, doubt) in sides {
            // Of what is moved outwards this is known outside alone, and so on.
            let is_beyond = if level < 0.0 { most < level - doubt } else { level == 0.0 || least > level + doubt };
            let Some(solid) = solid.filter(|_| is_beyond) else { continue };
            let found = solid.closest_surface_point(p)?;
            let way = found.map_or(f64::INFINITY, |q| q.distance(p));
            let ends = [least - level, most - level];
            let [nearer, farther] = if ends[0] < 0.0 && ends[1] > 0.0 {
                [0.0, ends[1].max(-ends[0])]
            } else {
                [ends[0].abs().min(ends[1].abs()), ends[0].abs().max(ends[1].abs())]
            };
            let told = nearer - doubt..=farther + doubt;
            tally.check(told.contains(&way), || {
                let there = found.map(|q| (q, solid.value(q), surface.distance(q)));
                format!("the level {level} from {p}: {way}, not in {told:?}; {there:?}")
            });
            let Some(q) = found else { continue };
            let again = solid.closest_surface_point(q)?.map_or(f64::INFINITY, |again| again.distance(q));
            tally.check(again <= doubt, || format!("the level {level} at {q}, of the surface: {again} away"));
        }
    }
    Ok(())
}

/// Tries a law; an error or a panic is a failure of it.
fn attempt(law: Law, subject: &Subject, seed: u64, tally: &mut Tally) {
    let (mut random, start) = (Random::new(seed), Instant::now());
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
    tally.time += start.elapsed();
}

fn print(name: &str, tally: &Tally) {
    let Tally { tried, beyond, failures, time } = tally;
    println!("{name}: {} of {tried} fail, {beyond} beyond one tolerance; {time:.1?}", failures.len());
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

/// Of how many solids little or nothing is known, though no law fails.
#[derive(Default)]
struct Known {
    solids: usize,
    /// Those with a length that is not measured in time.
    slow: usize,
    /// Those whose mesh may have lost something: nothing is too near to the surface then.
    lost: usize,
}

/// The shares of solids that may be slow, and that may have lost something.
const SLOW: f64 = 0.05;
const LOST: f64 = 0.5;

impl Known {
    fn add(&mut self, subject: &Subject) {
        self.solids += 1;
        self.slow += usize::from(!subject.slow().is_empty());
        self.lost += usize::from(matches!(subject.surface(), Ok(Some(surface)) if !surface.is_whole()));
    }

    fn judge(&self) {
        let Known { solids, slow, lost } = *self;
        println!("of {solids} solids {slow} are not measured in time, the meshes of {lost} may have lost something");
        let most = |share: f64| 1 + (share * solids as f64) as usize;
        assert!(slow <= most(SLOW), "{slow} of {solids} are not measured in time");
        assert!(lost <= most(LOST), "the meshes of {lost} of {solids} may have lost something");
    }
}

/// Tries all laws on a solid, or those whose names hold the text of `LENGTHS_LAW`; prints what
/// fails and what takes long.
fn try_all(name: &str, subject: &Subject, seed: u64, tallies: &mut [Tally]) {
    let asked = std::env::var("LENGTHS_LAW").unwrap_or_default();
    let start = Instant::now();
    let mut told = String::new();
    // What takes long under one verb does so under all of them.
    let is_slow = matches!(subject.under(Verb::Offset), Ok(None));
    for ((law_name, law), tally) in LAWS.iter().zip(tallies).filter(|((name, _), _)| !is_slow && name.contains(&asked))
    {
        let (failures, time) = (tally.failures.len(), tally.time);
        attempt(*law, subject, seed, tally);
        if tally.failures.len() > failures {
            let count = tally.failures.len() - failures;
            told += &format!("\n    {law_name}: {count} failures: {}", tally.failures[failures]);
        }
        let time = tally.time - time;
        if time.as_secs() >= 3 {
            told += &format!("\n    {law_name}: {time:.1?}");
        }
    }
    let slow = subject.slow();
    if !slow.is_empty() {
        told += &format!("\n    not measured in time: {slow:?} of {:?}", subject.solid);
    }
    if !told.is_empty() || start.elapsed().as_secs() >= 5 {
        println!("{name}: {:.1?}{told}", start.elapsed());
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
    let (mut tallies, mut known) = (none(), Known::default());
    for (seed, (tally, (_, law))) in (8000..).zip(tallies.iter_mut().zip(LAWS)) {
        let subject = subject(seed, 1);
        attempt(law, &subject, seed, tally);
        known.add(&subject);
    }
    assert!(tallies.iter().filter(|tally| tally.tried > 0).count() > 7);
    judge(&tallies);
    known.judge();
}

/// The numbers that are asked for: `LENGTHS_SEEDS=0..2000`.
pub(super) fn seeds(otherwise: std::ops::Range<u64>) -> std::ops::Range<u64> {
    let text = std::env::var("LENGTHS_SEEDS").unwrap_or_default();
    let parsed = text.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    parsed.unwrap_or(otherwise)
}

#[test]
#[ignore = "takes hours on one core: LENGTHS_SEEDS=0..2000 chooses"]
fn laws_hold_for_thousands_of_solids() {
    let (mut tallies, mut known) = (none(), Known::default());
    for seed in seeds(0..2000) {
        let subject = subject(seed, 2);
        try_all(&format!("seed {seed}"), &subject, seed, &mut tallies);
        known.add(&subject);
        if seed % 100 == 99 {
            println!("-- up to seed {seed}");
        }
    }
    judge(&tallies);
    known.judge();
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
#[ignore = "takes minutes: LENGTHS_SEEDS=0..20 chooses entries"]
fn laws_hold_for_every_example_of_the_catalogue() {
    let (mut tallies, mut known) = (none(), Known::default());
    let asked = seeds(0..u64::MAX);
    for (seed, (name, solid)) in (0..).zip(examples()).filter(|(seed, _)| asked.contains(seed)) {
        let subject = Subject::new(solid, &mut Random::new(seed));
        try_all(name, &subject, 7200 + seed, &mut tallies);
        known.add(&subject);
    }
    judge(&tallies);
    known.judge();
}
