//! Two builds of `seamstress` on the same meshes.

mod metric;
mod summary;

use crate::jobs;
use crate::markdown::Table;
use crate::meshes::{self, name};
use crate::output::{progress, publish};
use crate::program::{Outcome, Program};
use clap::value_parser;
use metric::{MAP_METRICS, Metric, QUAD_METRICS};
use std::error::Error;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use summary::summary;

/// Compare two builds of `seamstress` on the same meshes
///
/// Maps every mesh with both builds, and makes its quads too if `--quads` is given. Each cell shows
/// `old -> new`, or one value where both agree. A summary counts the meshes that are lost (the old build
/// succeeds, the new one does not), gained, and worse by more than a percentage. The exit code is 0 if no mesh is
/// lost, 1 if one is, 2 if there is no table.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The `seamstress` to compare with
    old: PathBuf,

    /// The `seamstress` to judge
    new: PathBuf,

    /// Mesh files, or folders of them without their subfolders
    #[arg(required = true)]
    meshes: Vec<PathBuf>,

    /// Compare the quad meshes for this count as well
    #[arg(long, value_name = "N")]
    quads: Option<f64>,

    /// Count a mesh as worse if a metric is worse by more than this
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0)]
    worse: f64,

    /// Take only the files whose name contains one of these
    #[arg(long, value_name = "TEXT", value_delimiter = ',')]
    only: Vec<String>,

    /// Meshes at the same time
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u16).range(1..=256))]
    jobs: u16,

    /// Threads of each run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u16).range(1..))]
    threads: u16,

    /// Give up on a run after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// Write the table to this file as well
    #[arg(long, value_name = "TABLE.md")]
    out: Option<PathBuf>,

    /// Keep the results in the folders `old` and `new` of this one
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,

    /// More arguments for both commands
    #[arg(last = true, value_name = "ARGS")]
    arguments: Vec<OsString>,
}

/// A command that both builds run on a mesh.
struct Task {
    title: String,
    command: &'static str,
    arguments: Vec<OsString>,
    metrics: &'static [Metric],
}

impl Task {
    fn list(args: &Args) -> Vec<Self> {
        let map = Self {
            title: "Maps".into(),
            command: "map",
            arguments: args.arguments.clone(),
            metrics: MAP_METRICS,
        };
        let quads = args.quads.map(|count| Self {
            title: format!("{count} quads"),
            command: "quad",
            arguments: [vec!["--quads".into(), count.to_string().into()], args.arguments.clone()]
                .concat(),
            metrics: QUAD_METRICS,
        });
        [Some(map), quads].into_iter().flatten().collect()
    }
}

/// How both builds fared with one mesh.
struct Pair {
    name: String,
    old: Outcome,
    new: Outcome,
    /// Whether both wrote the same bytes.
    is_same: bool,
}

/// Runs the comparison; whether nothing was lost.
///
/// # Errors
/// If a program or the meshes are missing, or a file cannot be written.
pub fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let mut paths = Vec::new();
    for path in &args.meshes {
        if path.is_dir() {
            paths.extend(meshes::list(path, None)?);
        } else {
            paths.push(path.clone());
        }
    }
    paths.retain(|path| args.only.is_empty() || args.only.iter().any(|t| name(path).contains(t)));
    let temporary = tempfile::tempdir()?;
    let folder = args.keep.as_deref().unwrap_or(temporary.path());
    let builds = [("old", &args.old), ("new", &args.new)];
    let [old, new] = builds.map(|(side, path)| Build::new(path, folder.join(side), args));
    let (old, new) = (old?, new?);
    let mut text = format!("old: {}\nnew: {}\n", old.version, new.version);
    let mut nothing_lost = true;
    for task in Task::list(args) {
        let done = AtomicUsize::new(0);
        let pairs = jobs::map(&paths, args.jobs.into(), |mesh| {
            let pair = Pair::new(mesh, &task, &old, &new);
            let k = done.fetch_add(1, Ordering::Relaxed) + 1;
            let cells = pair.cells(&task).join(" | ");
            progress(&format!("[{k}/{}] {} | {cells} |", paths.len(), task.command));
            pair
        });
        let mut titles = vec!["mesh", "result"];
        titles.extend(task.metrics.iter().map(|metric| metric.title));
        let mut table = Table::new(titles);
        pairs.iter().for_each(|pair| table.push(pair.cells(&task)));
        let summary = summary(&pairs, task.metrics, args.worse);
        nothing_lost &= pairs.iter().all(|pair| !pair.is_lost());
        text += &format!("\n## {}\n\n{table}\n{summary}", task.title);
    }
    publish(&text, args.out.as_deref())?;
    Ok(nothing_lost)
}

/// One of the two builds.
struct Build {
    program: Program,
    /// Where its results go.
    folder: PathBuf,
    /// The path and what `--version` prints.
    version: String,
}

impl Build {
    fn new(path: &Path, folder: PathBuf, args: &Args) -> Result<Self, Box<dyn Error>> {
        let output = std::process::Command::new(path).arg("--version").output();
        let output = output.map_err(|e| format!("cannot run {}: {e}", path.display()))?;
        let version = String::from_utf8_lossy(&output.stdout);
        let version = format!("{} ({})", path.display(), version.trim());
        fs::create_dir_all(&folder)?;
        let threads = Some(args.threads);
        let program = Program { path: path.to_owned(), time_limit: args.time_limit, threads };
        Ok(Self { program, folder, version })
    }

    fn run(&self, mesh: &Path, task: &Task) -> (Outcome, PathBuf) {
        // The whole file name stays, since files may differ in their extensions only.
        let output = self.folder.join(format!("{}.{}.obj", name(mesh), task.command));
        let outcome = self.program.run(task.command, mesh, &output, &task.arguments);
        (outcome, output)
    }
}

impl Pair {
    fn new(mesh: &Path, task: &Task, old: &Build, new: &Build) -> Self {
        let [(old, old_file), (new, new_file)] = [old, new].map(|build| build.run(mesh, task));
        let both = fs::read(&old_file).ok().zip(fs::read(&new_file).ok());
        let is_done = old.report().is_some() && new.report().is_some();
        let is_same = is_done && both.is_some_and(|(a, b)| a == b);
        Self { name: name(mesh), old, new, is_same }
    }

    fn is_lost(&self) -> bool {
        self.old.report().is_some() && self.new.report().is_none()
    }

    fn is_gained(&self) -> bool {
        self.old.report().is_none() && self.new.report().is_some()
    }

    /// The values of a metric with both builds.
    fn values(&self, metric: &Metric) -> [Option<f64>; 2] {
        [&self.old, &self.new].map(|outcome| outcome.report().and_then(metric.value))
    }

    fn cells(&self, task: &Task) -> Vec<String> {
        let [old, new] = [&self.old, &self.new].map(|outcome| match outcome {
            Outcome::Done(_) => "ok",
            Outcome::Refused(_) => "refused",
            Outcome::Failed(_) => "FAILED",
        });
        let mut cells = vec![self.name.clone(), change(old.into(), new.into())];
        cells.extend(task.metrics.iter().map(|metric| {
            let [old, new] = self.values(metric).map(|value| metric.show(value));
            change(old, new)
        }));
        cells
    }
}

fn change(old: String, new: String) -> String {
    if old == new { old } else { format!("{old} -> {new}") }
}
