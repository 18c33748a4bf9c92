//! Maps every mesh of a folder with the `seamstress` command and tells the results in one table.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

mod outcome;
mod report;
mod verify;

use clap::{Parser, value_parser};
use outcome::{Outcome, Runner};
use report::Report;
use seamstress_bench::markdown::{Table, escape};
use seamstress_bench::meshes::{self, name};
use seamstress_bench::process::exit_code;
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;
use verify::Verdict;

/// Maps every mesh of a folder and prints a table of the results
///
/// Runs the `seamstress` command that lies next to this program on every OBJ, OFF, PLY and STL file of
/// the folder, small files first. The exit code is 0 if every mesh was mapped or refused as no mesh,
/// and every verification passed; 1 if not; 2 if the table could not be made.
#[derive(Debug, Parser)]
struct Args {
    /// The folder of meshes; its subfolders are left out
    folder: PathBuf,

    /// Write the table to this file as well
    #[arg(long, value_name = "TABLE.md")]
    out: Option<PathBuf>,

    /// Keep the maps and their reports in this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,

    /// Meshes that are mapped at the same time; give each few threads with `-- --threads N`
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u16).range(1..=256))]
    jobs: u16,

    /// Take only the files whose name contains this
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,

    /// Check every map with `python3 SCRIPT --strict SOURCE MAP`, which prints a JSON object
    #[arg(long, value_name = "SCRIPT")]
    verify: Option<PathBuf>,

    /// Give up on a mesh after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// More arguments for `seamstress map`
    #[arg(last = true, value_name = "ARGS")]
    map_args: Vec<OsString>,
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether all went well.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let start = Instant::now();
    let meshes = meshes::list(&args.folder, args.only.as_deref())?;
    let temporary = tempfile::tempdir()?;
    let maps = args.maps.as_deref().unwrap_or(temporary.path());
    fs::create_dir_all(maps).map_err(|e| format!("cannot make {}: {e}", maps.display()))?;
    let runner = Runner {
        seamstress: sibling("seamstress")?,
        maps: maps.to_owned(),
        verifier: args.verify.clone(),
        time_limit: args.time_limit,
        map_args: args.map_args.clone(),
    };
    let outcomes = map_all(&runner, &meshes, args.jobs.into());
    let text = tell(&meshes, &outcomes, args.verify.is_some(), start.elapsed().as_secs_f64());
    print!("{text}");
    if let Some(path) = &args.out {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(!outcomes.iter().any(Outcome::is_failure))
}

/// The program of that name next to this one.
fn sibling(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    let path = std::env::current_exe()?.with_file_name(file);
    if path.is_file() {
        return Ok(path);
    }
    Err(format!(
        "there is no {}; build it with `cargo build --release -p seamstress-cli`",
        path.display()
    )
    .into())
}

/// Runs the meshes, `jobs` at a time; one outcome for each, in their order.
fn map_all(runner: &Runner, meshes: &[PathBuf], jobs: usize) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(meshes.len()));
    let work = || {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            let Some(mesh) = meshes.get(k) else { return };
            let outcome = runner.run(mesh);
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            let line = progress_line(mesh, &outcome);
            eprintln!("[{}/{}] {line}", done.len() + 1, meshes.len());
            done.push((k, outcome));
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs.min(meshes.len()) {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|&(k, _)| k);
    done.into_iter().map(|(_, outcome)| outcome).collect()
}

fn progress_line(mesh: &Path, outcome: &Outcome) -> String {
    match outcome {
        Outcome::Mapped(report, verdict) => {
            let mut cells = row(mesh, report);
            cells.extend(verdict.as_ref().map(Verdict::cell));
            format!("| {} |", cells.join(" | "))
        }
        Outcome::Refused(reason) => format!("{}: refused: {reason}", name(mesh)),
        Outcome::Failed(reason) => format!("{}: FAILED: {reason}", name(mesh)),
    }
}

/// The row of a mapped mesh.
fn row(mesh: &Path, report: &Report) -> Vec<String> {
    let mut cells = vec![name(mesh)];
    cells.extend(report.cells());
    cells
}

/// The table, what is not in it, and a summary.
fn tell(meshes: &[PathBuf], outcomes: &[Outcome], with_verdicts: bool, seconds: f64) -> String {
    let mut titles = vec!["mesh"];
    titles.extend(report::TITLES);
    if with_verdicts {
        titles.push("verified");
    }
    let mut table = Table::new(titles);
    let (mut refused, mut failed, mut unverified) = (Vec::new(), Vec::new(), Vec::new());
    let (mut mapped, mut cpu_seconds) = (0, 0.0);
    for (mesh, outcome) in meshes.iter().zip(outcomes) {
        let item = |reason: &str| format!("* {}: {}", escape(&name(mesh)), escape(reason));
        match outcome {
            Outcome::Refused(reason) => refused.push(item(reason)),
            Outcome::Failed(reason) => failed.push(item(reason)),
            Outcome::Mapped(report, verdict) => {
                let mut cells = row(mesh, report);
                cells.extend(verdict.as_ref().map(Verdict::cell));
                table.push(cells);
                unverified.extend(verdict.iter().filter_map(Verdict::fault).map(item));
                mapped += 1;
                cpu_seconds += report.cpu_seconds().unwrap_or(0.0);
            }
        }
    }
    let mut text = table.to_string();
    let mut list = |title: &str, items: &[String]| {
        if !items.is_empty() {
            text += &format!("\n{title}:\n\n{}\n", items.join("\n"));
        }
    };
    list("Refused as no mesh", &refused);
    list("Failed", &failed);
    list("Verification failed", &unverified);
    let mut summary = format!(
        "Meshes: {}; {mapped} mapped, {} refused, {} failed",
        meshes.len(),
        refused.len(),
        failed.len()
    );
    if with_verdicts {
        summary += &format!("; {} verified, {} not", mapped - unverified.len(), unverified.len());
    }
    format!("{text}\n{summary}; {cpu_seconds:.0} CPU s of maps, {seconds:.0} s in all\n")
}
