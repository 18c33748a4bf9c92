//! What the operating system says about this process, on Linux only, and how it ends.

use std::error::Error;
use std::fs;
use std::process::ExitCode;

/// How a program ends: 0 if all went well, 1 if something measured did not, 2 after an error, which is told on
/// standard error.
#[expect(clippy::print_stderr, reason = "these programs tell their errors there")]
pub fn exit_code(outcome: Result<bool, Box<dyn Error>>) -> ExitCode {
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// CPU seconds of all threads so far, in user and system mode, in steps of a hundredth.
pub fn cpu_seconds() -> Option<f64> {
    /// The unit of the file, fixed by the kernel's interface.
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name in parentheses may hold anything; the fields after it start with the third.
    let (_, fields) = stat.rsplit_once(')')?;
    let ticks = |n: usize| fields.split_whitespace().nth(n - 3)?.parse::<f64>().ok();
    Some((ticks(14)? + ticks(15)?) / TICKS_PER_SECOND)
}

/// The largest memory in bytes since the start, or since [`forget_peak_memory`].
pub fn peak_memory() -> Option<f64> {
    status("VmHWM:")
}

/// The memory in bytes that is resident now.
pub fn memory() -> Option<f64> {
    status("VmRSS:")
}

fn status(field: &str) -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix(field))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0)
}

/// Starts the measure of [`peak_memory`] anew; where that cannot be done, it goes on as before.
pub fn forget_peak_memory() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}
