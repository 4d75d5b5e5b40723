//! Memory of a job.

use std::process::Command;
use std::{env, fs};

/// The word that asks a process for the memory of a single job, which the words after it name.
pub const MEMORY: &str = "memory";

/// The most memory in use during a job beyond what was before, in MB, as a new process tells: what
/// others have given back is not there to be used again.
pub fn memory_apart(words: [&str; 4]) -> f64 {
    let told = env::current_exe().and_then(|this| Command::new(this).arg(MEMORY).args(words).output());
    let text = told.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.trim().parse().unwrap_or(f64::NAN)
}

/// Runs a job once and prints the memory that it takes, for [`memory_apart`].
pub fn print_memory<T: Send>(threads: usize, mut job: impl FnMut() -> T + Send) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let before = memory("VmRSS:");
    // Starts the peak afresh.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let _result = pool.install(&mut job);
    println!("{}", memory("VmHWM:") - before);
}

/// A line of the process's status, in MB.
fn memory(name: &str) -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    let kilobytes = line.and_then(|rest| rest.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes / 1024.0)
}
