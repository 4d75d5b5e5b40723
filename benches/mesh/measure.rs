//! Time and threads of a job.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

/// What a job took.
#[derive(Clone, Copy)]
pub struct Cost {
    /// Of the processor on one thread, of the clock on more.
    pub seconds: f64,
    /// The most memory in use during a run beyond what was before, in MB, in a process that does
    /// nothing else; NaN where the system does not tell.
    pub megabytes: f64,
}

/// Runs a job on a pool of some threads several times, more often if it is short, and gives the
/// least seconds of all runs, as [`Cost`] has them, and its result. The clock stops when the result
/// is there: giving back its memory is not counted.
pub fn measured<T: Send>(threads: usize, mut job: impl FnMut() -> T + Send) -> (f64, T) {
    /// Seconds to spend at least, and runs at least and at most.
    const TURN: f64 = 2.0;
    const RUNS: [usize; 2] = [3, 15];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let (mut seconds, mut spent, mut runs) = (f64::INFINITY, 0.0, 0);
        loop {
            let (took, result) = timed(threads, &mut job);
            seconds = seconds.min(took);
            spent += took;
            runs += 1;
            if spent > TURN && runs >= RUNS[0] || runs == RUNS[1] {
                return (seconds, result);
            }
        }
    })
}

/// What two jobs took that were run in turn.
pub struct InTurn<T> {
    /// The least seconds of each.
    pub seconds: [f64; 2],
    /// How many times as long the second took: the median of all turns.
    pub ratio: f64,
    /// What they gave last.
    pub results: [T; 2],
}

/// Runs two jobs in turn, 15 times each, less often if they are long: how fast the machine is at
/// the time, and what memory the system takes back between runs, is the same for both.
pub fn in_turn<T: Send>(threads: usize, mut jobs: [impl FnMut() -> T + Send; 2]) -> InTurn<T> {
    /// Seconds to spend at most, but for the fewest turns.
    const LONG: f64 = 10.0;
    const TURNS: [usize; 2] = [5, 15];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let (start, mut turns) = (Instant::now(), Vec::new());
        while turns.len() + 1 < TURNS[1] && (turns.len() + 1 < TURNS[0] || start.elapsed().as_secs_f64() < LONG) {
            // Results are given up before the next run.
            turns.push(jobs.each_mut().map(|job| timed(threads, job).0));
        }
        let [(first, one), (second, other)] = jobs.each_mut().map(|job| timed(threads, job));
        turns.push([first, second]);
        let least = |n: usize| turns.iter().map(|turn| turn[n]).fold(f64::INFINITY, f64::min);
        let mut ratios: Vec<f64> = turns.iter().map(|[first, second]| second / first).collect();
        ratios.sort_by(f64::total_cmp);
        InTurn { seconds: [least(0), least(1)], ratio: ratios[ratios.len() / 2], results: [one, other] }
    })
}

/// Keeps all threads of the pool busy for a moment. Two that were asleep may be woken on the same
/// core, where the system leaves them for some 10 ms though another core is free: how often depends
/// on what was run before.
fn spread_threads() {
    const MOMENT: Duration = Duration::from_millis(10);
    rayon::broadcast(|_| {
        let start = Instant::now();
        while start.elapsed() < MOMENT {
            std::hint::spin_loop();
        }
    });
}

/// Runs a job; gives its seconds, of the processor on one thread, of the clock on more, and its
/// result.
fn timed<T>(threads: usize, job: &mut impl FnMut() -> T) -> (f64, T) {
    if threads > 1 {
        spread_threads();
    }
    let (clock, processor) = (Instant::now(), ProcessTime::now());
    let result = job();
    let (clock, processor) = (clock.elapsed().as_secs_f64(), processor.elapsed().as_secs_f64());
    (if threads == 1 { processor } else { clock }, result)
}
