//! Lengths: what offsets, shells, rounding, fillets, chamfers and caps take, beside the same solids
//! without.
//!
//! `cargo bench --bench lengths` prints, on one thread and in seconds of the processor, compiling
//! included:
//!
//! * meshes of 128 cells along the longest side, and what is allowed: so many times the plain
//!   solid's, or so many seconds more;
//! * studio pictures of 400 × 300, one ray a pixel, the first and the second of the same scene, in
//!   times of the plain solid's first;
//! * 10, 30, 100 and 1000 pins filleted to a plate, at once and one after the other, and how that
//!   grows;
//! * how far distances are from brute force, and nanoseconds a point;
//! * the memory of 1000 pins, and how soon cancelled work returns.
//!
//! The plain solid is the same leaves joined by min and max. Contestants alternate; every figure is
//! the median of several rounds, and so is every ratio. Solids are built anew for every round.
//!
//! Words after `--` choose: `mesh`, `pictures`, `pins`, `accuracy`, `memory`, `cancel`; parts of
//! the names of rows; `quick` for fewer rounds and points.

#[path = "lengths/accuracy.rs"]
mod accuracy;
#[path = "mesh/memory.rs"]
mod memory;
#[path = "lengths/race.rs"]
mod race;
#[path = "../tests/it/lengths/reference.rs"]
mod reference;
#[path = "lengths/solids.rs"]
mod solids;

use std::thread;
use std::time::{Duration, Instant};

use rvachev::{Camera, CancelToken, CellSize, MeshSettings, RenderSettings, Run, Scene, Solid, ThinFeatures};

use memory::MEMORY;
use race::{Budget, Job, Took, race, timed};
use solids::Row;

const PARTS: [&str; 6] = ["mesh", "pictures", "pins", "accuracy", "memory", "cancel"];

/// What the words on the command line choose.
struct Chosen(Vec<String>);

impl Chosen {
    fn has(&self, word: &str) -> bool {
        self.0.iter().any(|other| other == word)
    }

    /// Whether a part is chosen, or none is.
    fn takes(&self, part: &str) -> bool {
        self.has(part) || !PARTS.iter().any(|part| self.has(part))
    }

    /// Whether a row is chosen by a part of its name, or none is.
    fn names(&self, row: &str) -> bool {
        let is_name = |word: &&String| !PARTS.contains(&word.as_str()) && *word != "quick";
        let mut words = self.0.iter().filter(is_name).peekable();
        words.peek().is_none() || words.any(|word| row.contains(word.as_str()))
    }

    fn budget(&self) -> Budget {
        if self.has("quick") { Budget { rounds: 3, seconds: 5.0 } } else { Budget { rounds: 9, seconds: 20.0 } }
    }
}

fn settings() -> MeshSettings {
    MeshSettings { cell: CellSize::LongestSide(128), thin: ThinFeatures::Ignore, ..MeshSettings::default() }
}

fn one_thread() -> Run {
    Run { threads: 1, ..Run::default() }
}

/// Meshes a solid that is built anew.
fn meshing<'a>(build: impl Fn() -> Solid + 'a) -> Job<'a> {
    Box::new(move || {
        let solid = build();
        let (seconds, mesh) = timed(|| solid.mesh_with(&settings(), &one_thread()));
        mesh.map(|_| vec![seconds]).map_err(|error| error.to_string())
    })
}

/// Two pictures of a scene of a solid that is built anew.
fn picturing<'a>(build: impl Fn() -> Solid + 'a) -> Job<'a> {
    Box::new(move || {
        let solid = build();
        let settings = RenderSettings { width: 400, height: 300, samples: 1, ..RenderSettings::default() };
        let picture = |scene: &Scene| scene.render_with(&Camera::framing(&scene.bounds()), &settings, &one_thread());
        let (first, scene) = timed(|| {
            let scene = solid.scene_with(&one_thread())?;
            picture(&scene).map(|_| scene)
        });
        let scene = scene.map_err(|error| error.to_string())?;
        let (second, other) = timed(|| picture(&scene));
        other.map(|_| vec![first, second]).map_err(|error| error.to_string())
    })
}

fn verdict(is_met: bool) -> &'static str {
    if is_met { "met" } else { "NOT MET" }
}

/// Prints a row of which a contestant failed; gives both if neither did.
fn both<const N: usize>(name: &str, told: Vec<Result<Took, String>>) -> Option<[Took; N]> {
    let all: Result<Vec<Took>, String> = told.into_iter().collect();
    match all {
        Ok(all) => all.try_into().ok(),
        Err(error) => {
            println!("{name:22} failed: {error}");
            None
        }
    }
}

fn print_mesh(chosen: &Chosen, row: &Row) {
    let told = race(chosen.budget(), &mut [meshing(row.plain), meshing(row.made)]);
    let Some([plain, made]) = both(row.name, told) else { return };
    let (plain, seconds, ratio) = (plain.seconds[0], made.seconds[0], made.ratios[0]);
    let allowed = (row.mesh.times * plain).max(plain + row.mesh.plus);
    println!(
        "{:22} plain {plain:7.3} s, {seconds:7.3} s, {ratio:6.1} times; allowed {allowed:6.3} s: {}",
        row.name,
        verdict(seconds <= allowed)
    );
}

fn print_pictures(chosen: &Chosen, row: &Row) {
    let told = race(chosen.budget(), &mut [picturing(row.plain), picturing(row.made)]);
    let Some([plain, made]) = both(row.name, told) else { return };
    let [first, second] = [made.ratios[0], made.ratios[1]];
    println!(
        "{:22} plain {:6.3} {:6.3} s, first {:7.3} s, second {:7.3} s: {first:6.1} and {second:6.1} times; \
         allowed {:.1} and {:.1}: {}, {}",
        row.name,
        plain.seconds[0],
        plain.seconds[1],
        made.seconds[0],
        made.seconds[1],
        row.picture,
        0.5 * row.picture,
        verdict(first <= row.picture),
        verdict(second <= 0.5 * row.picture)
    );
}

/// A plate with pins, joined at once or one after the other.
type Pins = fn(usize, Option<rvachev::Blend>) -> Solid;

fn print_pins(chosen: &Chosen) {
    let ways: [(&str, Pins); 2] = [("at once", solids::at_once), ("chain", solids::chain)];
    type Making = fn(Box<dyn Fn() -> Solid>) -> Job<'static>;
    let works: [(&str, Making); 2] = [("mesh", |build| meshing(build)), ("picture", |build| picturing(build))];
    for (work, job) in works {
        for (way, pins) in ways.into_iter().filter(|(way, _)| chosen.names(&format!("pins {way}"))) {
            let mut before: Option<(usize, f64)> = None;
            for count in [10, 30, 100, 1000] {
                let name = format!("{count} pins, {way}, {work}");
                let plain = job(Box::new(move || solids::at_once(count, None)));
                let made = job(Box::new(move || pins(count, Some(solids::fillet(0.05)))));
                let Some([plain, made]) = both(&name, race(chosen.budget(), &mut [plain, made])) else { break };
                let (plain, seconds, ratio) = (plain.seconds[0], made.seconds[0], made.ratios[0]);
                print!("{name:26} plain {plain:7.3} s, {seconds:7.3} s, {ratio:6.1} times");
                if let Some((fewer, took)) = before {
                    let (grows, allowed) = (seconds / took, 1.3 * count as f64 / fewer as f64);
                    print!("; grows {grows:5.2} times, allowed {allowed:5.2}: {}", verdict(grows <= allowed));
                }
                println!();
                before = Some((count, seconds));
            }
        }
    }
}

/// The word for the memory of so many pins.
const PINS: &str = "pins";

fn print_memory() {
    const MOST: f64 = 400.0;
    for count in ["100", "1000"] {
        let megabytes = memory::memory_apart([PINS, count, "", ""]);
        println!("{count} pins at once, mesh: {megabytes:.0} MB; allowed {MOST:.0}: {}", verdict(megabytes < MOST));
    }
}

/// Cancels meshes after several delays, and prints the longest that they go on.
fn print_cancel() {
    const MOST: Duration = Duration::from_millis(50);
    type Case = (&'static str, fn() -> Solid);
    let cases: [Case; 3] = [
        ("twisted, shell", || solids::twisted().shell(1.0)),
        ("vase, closing", || solids::vase().filleted(2.0)),
        ("1000 pins", || solids::at_once(1000, Some(solids::fillet(0.05)))),
    ];
    for (name, build) in cases {
        let goes_on = [5, 20, 60, 150].map(|delay| {
            let (solid, cancel) = (build(), CancelToken::default());
            let run = Run { cancel: cancel.clone(), ..one_thread() };
            let worker = thread::spawn(move || solid.mesh_with(&settings(), &run).map(|_| Instant::now()));
            thread::sleep(Duration::from_millis(delay));
            let start = Instant::now();
            cancel.cancel();
            // One that was done before counts as stopped at once.
            let is_done = worker.join().is_ok_and(|done| done.is_ok_and(|end| end < start));
            if is_done { Duration::ZERO } else { start.elapsed() }
        });
        let longest = goes_on.into_iter().max().unwrap_or_default();
        println!("{name}: goes on for {longest:.0?} when cancelled; allowed {MOST:?}: {}", verdict(longest <= MOST));
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    if let [MEMORY, PINS, count, ..] = words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        let solid = solids::at_once(count.parse().expect("a number"), Some(solids::fillet(0.05)));
        return memory::print_memory(1, || solid.mesh_with(&settings(), &one_thread()));
    }
    let chosen = Chosen(words);
    let rows: Vec<Row> = solids::rows().into_iter().filter(|row| chosen.names(row.name)).collect();
    if chosen.takes("mesh") {
        println!("mesh, 128 cells along the longest side, compiling included; seconds of one thread");
        rows.iter().for_each(|row| print_mesh(&chosen, row));
    }
    if chosen.takes("pictures") {
        println!("\nstudio picture, 400 x 300, compiling included; times of the plain solid's first");
        rows.iter().for_each(|row| print_pictures(&chosen, row));
    }
    if chosen.takes("pins") {
        println!("\npins filleted to a plate");
        print_pins(&chosen);
    }
    if chosen.takes("accuracy") {
        accuracy::print_rows(|name| chosen.names(name), chosen.has("quick"));
    }
    if chosen.takes("memory") {
        println!("\nmemory");
        print_memory();
    }
    if chosen.takes("cancel") {
        println!("\ncancelled work");
        print_cancel();
    }
}
