//! This process: its time and memory, where the operating system reports them (on Linux), and how it ends.

use crate::output::progress;
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How a program ends: 0 if all went well, 1 if something measured did not, 2 after an error, which is reported on
/// standard error.
pub fn exit_code(outcome: Result<bool, Box<dyn Error>>) -> ExitCode {
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            progress(&format!("error: {error}"));
            ExitCode::from(2)
        }
    }
}

/// The program of that name next to this one.
///
/// # Errors
/// If it is not there.
pub fn sibling(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::current_exe()?.with_file_name(file);
    if path.is_file() {
        return Ok(path);
    }
    let hint = "build it with `cargo build --release -p seamstress-cli`";
    Err(format!("there is no {}; {hint}", path.display()).into())
}

/// Measures time from its start.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    wall: Instant,
    cpu: Option<f64>,
}

/// What something took, in seconds.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Elapsed time.
    pub wall: f64,
    /// Time of the processor, all threads together; not a number where the system does not report it.
    pub cpu: f64,
}

impl Clock {
    /// Starts to measure.
    pub fn start() -> Self {
        let cpu = cpu_seconds();
        Self { wall: Instant::now(), cpu }
    }

    /// The time since the start.
    pub fn cost(&self) -> Cost {
        let cpu = self.cpu.zip(cpu_seconds()).map_or(f64::NAN, |(before, after)| after - before);
        Cost { wall: self.wall.elapsed().as_secs_f64(), cpu }
    }

    /// Seconds of the processor since the start, or elapsed ones where the system does not report them.
    pub fn seconds(&self) -> f64 {
        let cost = self.cost();
        if cost.cpu.is_nan() { cost.wall } else { cost.cpu }
    }

    /// An observer of a computation that ends it when the time is up.
    pub fn limit<E>(&self, limit: Option<Duration>) -> impl FnMut(E) -> ControlFlow<()> + use<E> {
        let start = self.wall;
        move |_| match limit {
            Some(limit) if start.elapsed() > limit => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
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
