//! Random solids over the whole catalogue and what they answer, each question against another; of
//! what is wrong a minimal program is told.
//!
//! The ignored runs are long: `BATTERY_SEEDS=0..1000` chooses a part of one, and each tells how far
//! it is. What they found is in `tests/corpus/solids.txt`, what is not mended yet in
//! `tests/corpus/open.txt`.

mod clock;
#[cfg(feature = "import")]
mod files;
mod kinds;
pub mod make;
mod numbers;
mod shapes;
mod shrink;
mod text;

use std::fs;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use rvachev::{Solid, SolidError, error::PrepareError};

use clock::{Clock, PATIENCE};
pub use clock::{is_late, short};
use kinds::Kinds;

/// What is wrong with a solid.
#[derive(Clone, Debug)]
pub struct Fault {
    /// What it was that failed: faults of the same name are taken for the same.
    pub check: &'static str,
    pub text: String,
}

/// A fault unless it `holds`.
pub fn fault(check: &'static str, holds: bool, text: impl FnOnce() -> String) -> Result<(), Fault> {
    if holds { Ok(()) } else { Err(Fault { check, text: text() }) }
}

pub type Check = fn(&Solid) -> Result<(), Fault>;

/// What `job` finds wrong, or that it panics.
fn caught(job: impl FnOnce() -> Result<(), Fault>) -> Result<(), Fault> {
    catch_unwind(AssertUnwindSafe(job)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Err(Fault { check: "panic", text: text.unwrap_or_default() })
    })
}

/// What came of the solids of a run.
#[derive(Default)]
struct Tally {
    solids: u32,
    /// Refused with one of the errors that are documented.
    refused: u32,
    /// Not compiled, or not asked all, in the time that one has.
    slow: u32,
    /// What those were made of that were asked.
    kinds: Kinds,
    wrong: Vec<String>,
}

/// The parts of many solids that may be refused, and be slow.
#[derive(Clone, Copy)]
pub struct Most {
    pub refused: f64,
    pub slow: f64,
}

const NUMBERS: Most = Most { refused: 0.15, slow: 0.01 };
const SHAPES: Most = Most { refused: 0.15, slow: 0.08 };

/// So many are many.
const MANY: u32 = 100;

/// Makes a solid of each seed and checks it. Fails at the end, with a minimal program for each of
/// the first faults, or where too many are refused or slow; at once where one does not end.
pub fn run(seeds: Range<u64>, make: fn(u64) -> Option<Solid>, check: Check, most: Most) {
    let (mut tally, start) = (Tally::default(), Instant::now());
    let watch = watch();
    for seed in seeds.clone() {
        let mut solid = None;
        let result = caught(|| {
            drop(watch.send(format!("{seed}, which is being made")));
            solid = make(seed);
            let Some(solid) = &solid else { return Ok(()) };
            drop(watch.send(format!("{seed}: {}", text::written(&solid.into()))));
            let clock = Clock::start();
            match solid.prepare(&short()) {
                Err(PrepareError::Cancelled(_)) => {
                    tally.slow += 1;
                    let late = clock.elapsed();
                    fault("cancelling", late < 3 * PATIENCE, || {
                        format!("cancelled after {PATIENCE:?}, ended at {late:?}")
                    })?;
                }
                Err(PrepareError::Solid(error)) => {
                    tally.refused += 1;
                    refusal(solid, &error)?;
                }
                Err(error) => fault("refusal", false, || error.to_string())?,
                Ok(_) => {
                    drop(clock);
                    let clock = Clock::start();
                    tally.kinds.add(&solid.into());
                    check(solid)?;
                    tally.slow += u32::from(clock.is_late());
                }
            }
            Ok(())
        });
        tally.solids += u32::from(solid.is_some());
        if let Err(fault) = result {
            let least = solid.map(|solid| least(&solid, check, &fault));
            let line = format!("{seed}: {}: {}\n    {}", fault.check, fault.text, least.unwrap_or_default());
            println!("{line}");
            tally.wrong.push(line);
        }
        if (seed + 1 - seeds.start).is_multiple_of(1000) {
            println!("{}..{} done, {} wrong, {:?}", seeds.start, seed + 1, tally.wrong.len(), start.elapsed());
        }
    }
    let Tally { solids, refused, slow, kinds, wrong } = tally;
    println!(
        "{solids} solids of seeds {seeds:?}, {refused} refused, {slow} slow, {} wrong, {:?}",
        wrong.len(),
        start.elapsed()
    );
    println!("{kinds}");
    assert!(wrong.is_empty(), "{} of {solids}:\n{}", wrong.len(), wrong.join("\n"));
    let is_few = |some: u32, part: f64| solids < MANY || f64::from(some) <= part * f64::from(solids);
    assert!(is_few(refused, most.refused) && is_few(slow, most.slow), "{refused} refused and {slow} slow of {solids}");
    let lacking = kinds.lacking();
    assert!(lacking.is_empty(), "too few of {solids} have {lacking:?}");
}

/// A refusal is one of the solid, tells where and what is wrong, and is the same whoever asks.
fn refusal(solid: &Solid, error: &SolidError) -> Result<(), Fault> {
    let text = error.to_string();
    let is_told = match error {
        SolidError::Parameter { path, .. } | SolidError::NoGauge { path, .. } | SolidError::TooDeep { path, .. } => {
            !path.is_empty() && text.contains("allowed")
        }
        SolidError::Surface { reason } => !reason.contains("internal"),
        SolidError::Unbounded { path } => !path.is_empty(),
        SolidError::EmptyJoin { .. } | SolidError::TooLarge { .. } => true,
        _ => false,
    };
    fault("refusal", is_told, || format!("{error:?}: {text}"))?;
    // By their texts: numbers that are NaN are not equal.
    let all = [solid.value([0.1; 3]).err(), solid.bounds().err(), solid.contains_all(&[]).err()];
    let is_same = |other: &Option<SolidError>| other.as_ref().is_some_and(|other| other.to_string() == text);
    fault("refusal", all.iter().all(is_same), || format!("{error:?}, else {all:?}"))
}

/// What takes longer than this hangs: the run fails.
const HANGS: Duration = Duration::from_secs(300);

/// Takes what is begun, tells what takes long, and ends the process where something hangs.
fn watch() -> Sender<String> {
    const LONG: Duration = Duration::from_secs(20);
    let (watch, begun) = channel::<String>();
    std::thread::spawn(move || {
        let (mut now, mut patience) = (String::new(), LONG);
        let (mut start, mut begin) = (ProcessTime::now(), Instant::now());
        loop {
            match begun.recv_timeout(patience) {
                Ok(next) => {
                    (now, patience) = (next, LONG);
                    (start, begin) = (ProcessTime::now(), Instant::now());
                }
                Err(RecvTimeoutError::Disconnected) => return,
                // What waits for other processes does not hang; what waits for itself does.
                Err(RecvTimeoutError::Timeout) if start.elapsed() < patience && begin.elapsed() < 20 * HANGS => {}
                Err(RecvTimeoutError::Timeout) if patience == LONG => {
                    println!("takes long: {now}");
                    patience = HANGS;
                }
                Err(RecvTimeoutError::Timeout) => {
                    println!("does not end: {now}");
                    std::process::exit(101);
                }
            }
        }
    });
    watch
}

/// The minimal program that has such a fault, and what it is then.
pub fn least(solid: &Solid, check: impl Fn(&Solid) -> Result<(), Fault>, found: &Fault) -> String {
    let again = |solid: &Solid| caught(|| check(solid)).err().filter(|fault| fault.check == found.check);
    let least = shrink::shrunk(solid, Duration::from_secs(20), |solid| again(solid).is_some());
    let text = again(&least).map_or_else(String::new, |fault| fault.text);
    format!("{}\n    {text}", text::written(&least.into()))
}

/// The seeds that a variable of the environment names, as 0..2000.
pub fn seeds(variable: &str, otherwise: Range<u64>) -> Range<u64> {
    let Ok(text) = std::env::var(variable) else { return otherwise };
    let (from, to) = text.split_once("..").expect("a range, as 0..2000");
    from.parse().expect("a number")..to.parse().expect("a number")
}

#[test]
fn numbers_of_random_solids_agree() {
    run(0..200, make::solid, numbers::check, NUMBERS);
}

#[test]
fn shapes_of_random_solids_agree() {
    run(0..8, make::solid, shapes::check, SHAPES);
}

#[cfg(feature = "import")]
#[test]
fn files_of_random_solids_come_back() {
    run(0..20, make::solid, files::check, SHAPES);
}

#[test]
#[ignore = "a million solids take hours: BATTERY_SEEDS=0..1000 chooses"]
fn numbers_of_a_million_solids_agree() {
    run(seeds("BATTERY_SEEDS", 0..1_000_000), make::cheap, numbers::check, NUMBERS);
}

#[test]
#[ignore = "takes hours: BATTERY_SEEDS=0..1000 chooses"]
fn shapes_of_twenty_thousand_solids_agree() {
    run(seeds("BATTERY_SEEDS", 0..20_000), make::solid, shapes::check, SHAPES);
}

#[cfg(feature = "import")]
#[test]
#[ignore = "takes many minutes: BATTERY_SEEDS=0..1000 chooses"]
fn files_of_two_thousand_solids_come_back() {
    run(seeds("BATTERY_SEEDS", 0..2000), make::solid, files::check, SHAPES);
}

/// What is wrong with the solids of a file of the corpus, a line each: the name of a check, a
/// colon, a program.
fn wrong_of(file: impl AsRef<Path>) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(file);
    let corpus = fs::read_to_string(path).expect("a file of the corpus");
    let watch = watch();
    let lines = corpus.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let results = lines.map(|line| {
        let (name, program) = line.split_once(": ").expect("a check and a program");
        let check: Check = match name {
            "numbers" => numbers::check,
            "shapes" => shapes::check,
            #[cfg(feature = "import")]
            "files" => files::check,
            #[cfg(not(feature = "import"))]
            "files" => |_| Ok(()),
            "any" => super::spicy::check,
            name => panic!("no check {name}"),
        };
        let solid = text::read(program).into_solid().expect("a solid");
        drop(watch.send(line.to_owned()));
        caught(|| check(&solid)).map_err(|fault| format!("{line}\n    {}: {}", fault.check, fault.text))
    });
    results.filter_map(Result::err).collect()
}

#[test]
fn solids_that_once_were_wrong() {
    let wrong = wrong_of("solids.txt");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
#[ignore = "what is not mended yet, some of which never ends; BATTERY_FILE names another file"]
fn solids_that_are_wrong() {
    let wrong = wrong_of(std::env::var("BATTERY_FILE").unwrap_or_else(|_| "open.txt".to_owned()));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
