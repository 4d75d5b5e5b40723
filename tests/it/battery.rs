//! Random solids over the whole catalogue and what they answer, each question against another; of
//! what is wrong a minimal program is told.
//!
//! The ignored runs are long: `BATTERY_SEEDS=0..1000` chooses a part of one, and each tells how far
//! it is. What they found is in `tests/corpus/solids.txt`, what is not mended yet in
//! `tests/corpus/open.txt`.

#[cfg(feature = "import")]
mod files;
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

use rvachev::{CancelToken, Progress, Run, Solid, error::PrepareError};

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

/// Makes a solid of each seed and checks it. Fails at the end, with a minimal program for each of
/// the first faults.
pub fn run(seeds: Range<u64>, make: fn(u64) -> Option<Solid>, check: Check) {
    let (mut wrong, mut solids, mut slow, start) = (Vec::new(), 0, 0, Instant::now());
    let watch = watch();
    for seed in seeds.clone() {
        let mut solid = None;
        let result = caught(|| {
            drop(watch.send(format!("{seed}, which is being made")));
            solid = make(seed);
            let Some(solid) = &solid else { return Ok(()) };
            drop(watch.send(format!("{seed}: {}", text::written(&solid.into()))));
            if matches!(solid.prepare(&short()), Err(PrepareError::Cancelled(_))) {
                slow += 1;
                return Ok(());
            }
            check(solid)
        });
        solids += u32::from(solid.is_some());
        if let Err(fault) = result {
            let least = solid.map(|solid| least(&solid, check, &fault));
            let line = format!("{seed}: {}: {}\n    {}", fault.check, fault.text, least.unwrap_or_default());
            println!("{line}");
            wrong.push(line);
        }
        if (seed + 1 - seeds.start).is_multiple_of(1000) {
            println!("{}..{} done, {} wrong, {:?}", seeds.start, seed + 1, wrong.len(), start.elapsed());
        }
    }
    println!(
        "{solids} solids of seeds {seeds:?}, {slow} too slow to compile, {} wrong, {:?}",
        wrong.len(),
        start.elapsed()
    );
    assert!(wrong.is_empty(), "{} of {solids}:\n{}", wrong.len(), wrong.join("\n"));
}

/// A run that ends after some seconds: what takes long is for other tests.
pub fn short() -> Run {
    let cancel = CancelToken::new();
    let (token, start) = (cancel.clone(), Instant::now());
    let progress = Progress::new(move |_| {
        if start.elapsed().as_secs() > 4 {
            token.cancel();
        }
    });
    Run { cancel, progress: Some(progress), ..Run::default() }
}

/// Takes what is begun, and tells what takes long.
fn watch() -> Sender<String> {
    let (watch, begun) = channel::<String>();
    std::thread::spawn(move || {
        let mut now = String::new();
        loop {
            match begun.recv_timeout(Duration::from_secs(8)) {
                Ok(next) => now = next,
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {
                    println!("takes long: {now}");
                    let Ok(next) = begun.recv() else { return };
                    now = next;
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
    run(0..200, make::solid, numbers::check);
}

#[test]
fn shapes_of_random_solids_agree() {
    run(0..12, make::solid, shapes::check);
}

#[cfg(feature = "import")]
#[test]
fn files_of_random_solids_come_back() {
    run(0..20, make::solid, files::check);
}

#[test]
#[ignore = "a million solids take hours: BATTERY_SEEDS=0..1000 chooses"]
fn numbers_of_a_million_solids_agree() {
    run(seeds("BATTERY_SEEDS", 0..1_000_000), make::solid, numbers::check);
}

#[test]
#[ignore = "takes hours: BATTERY_SEEDS=0..1000 chooses"]
fn shapes_of_twenty_thousand_solids_agree() {
    run(seeds("BATTERY_SEEDS", 0..20_000), make::solid, shapes::check);
}

#[cfg(feature = "import")]
#[test]
#[ignore = "takes many minutes: BATTERY_SEEDS=0..1000 chooses"]
fn files_of_two_thousand_solids_come_back() {
    run(seeds("BATTERY_SEEDS", 0..2000), make::solid, files::check);
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
