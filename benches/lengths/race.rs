//! The clock: jobs in turn, medians, ratios to the first.

use cpu_time::ProcessTime;

/// How often jobs are run, and how many seconds may be spent on a row.
#[derive(Clone, Copy)]
pub struct Budget {
    pub rounds: usize,
    pub seconds: f64,
}

/// One contestant: it times its own work, once or several times.
pub type Job<'a> = Box<dyn FnMut() -> Result<Vec<f64>, String> + 'a>;

/// What a contestant took: the median of each of its times, and of their ratios to the first time
/// of the first contestant in the same round.
pub struct Took {
    pub seconds: Vec<f64>,
    pub ratios: Vec<f64>,
}

/// Seconds of the processor that a job takes, and its result. Nothing else runs in the process.
pub fn timed<T>(job: impl FnOnce() -> T) -> (f64, T) {
    let start = ProcessTime::now();
    let result = job();
    (start.elapsed().as_secs_f64(), result)
}

pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Runs the jobs in turn. One that fails is not run again.
pub fn race(budget: Budget, jobs: &mut [Job<'_>]) -> Vec<Result<Took, String>> {
    let mut rounds: Vec<Result<Vec<Vec<f64>>, String>> = jobs.iter().map(|_| Ok(Vec::new())).collect();
    let mut spent = 0.0;
    for _ in 0..budget.rounds {
        for (job, told) in jobs.iter_mut().zip(&mut rounds) {
            let Ok(all) = told else { continue };
            let (seconds, times) = timed(job);
            spent += seconds;
            match times {
                Ok(times) => all.push(times),
                Err(error) => *told = Err(error),
            }
        }
        if spent > budget.seconds {
            break;
        }
    }
    let first: Vec<f64> = match rounds.first() {
        Some(Ok(all)) => all.iter().map(|times| times[0]).collect(),
        _ => Vec::new(),
    };
    rounds.into_iter().map(|told| told.map(|all| took(&all, &first))).collect()
}

fn took(rounds: &[Vec<f64>], first: &[f64]) -> Took {
    let count = rounds.first().map_or(0, Vec::len);
    let seconds = (0..count).map(|i| median(rounds.iter().map(|times| times[i]).collect()));
    let ratios = (0..count).map(|i| median(rounds.iter().zip(first).map(|(times, first)| times[i] / first).collect()));
    Took { seconds: seconds.collect(), ratios: ratios.collect() }
}
