//! Two builds of `seamstress` on the same meshes.

mod metric;
mod summary;

use crate::jobs;
use crate::markdown::Table;
use crate::meshes::{Selection, name};
use crate::output::{Section, progress};
use crate::program::{Outcome, Program};
use crate::verify::judge;
use clap::value_parser;
use metric::{JUDGED_METRICS, MAP_METRICS, Metric, QUAD_METRICS};
use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use summary::summary;

/// Comparison: two builds or settings of `seamstress` on the same meshes
///
/// Maps every mesh with both, and makes its quads for each `--quads` that is given. Each cell shows `old -> new`, or one
/// value where both agree. A summary counts the meshes that are lost (the old one succeeds, the new one does not),
/// gained, and worse by more than a percentage. It counts as a failure if a mesh is lost.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The `seamstress` executable to compare with
    old: PathBuf,

    /// The `seamstress` executable to judge
    new: PathBuf,

    #[command(flatten)]
    selection: Selection,

    /// Compare the quad meshes for this count as well; may be repeated
    #[arg(long, value_name = "N")]
    quads: Vec<f64>,

    /// Judge quad meshes by this Python script too
    ///
    /// It is called as `python3 SCRIPT --json --asked N SOURCE QUADS` and prints a JSON object with `cover`, the area of
    /// the quads as a share of the source's, and `crease_p95` and `rim_p95`, the distances of the source's creases and
    /// boundaries from edges of quads.
    #[arg(long, value_name = "SCRIPT", requires = "quads")]
    judge: Option<PathBuf>,

    /// Count a mesh as worse if a metric is worse by more than this
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0)]
    worse: f64,

    /// Meshes at the same time
    #[arg(long, default_value_t = 1, value_parser = value_parser!(u16).range(1..=256))]
    jobs: u16,

    /// Threads of each run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u16).range(1..))]
    threads: u16,

    /// Give up on a run after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// Keep the results in the folders `old` and `new` of this one
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,

    /// An argument for the old one alone; may be repeated
    #[arg(long, value_name = "ARG", allow_hyphen_values = true)]
    old_args: Vec<OsString>,

    /// An argument for the new one alone; may be repeated
    #[arg(long, value_name = "ARG", allow_hyphen_values = true)]
    new_args: Vec<OsString>,

    /// More arguments for both
    #[arg(last = true, value_name = "ARGS")]
    arguments: Vec<OsString>,
}

/// A command that both builds run on a mesh.
struct Task {
    title: String,
    command: &'static str,
    /// The number of quads asked for, and what judges them.
    judged: Option<(f64, PathBuf)>,
    arguments: Vec<OsString>,
    metrics: &'static [Metric],
}

impl Task {
    fn list(args: &Args) -> Vec<Self> {
        let map = Self {
            title: "Maps".into(),
            command: "map",
            judged: None,
            arguments: args.arguments.clone(),
            metrics: MAP_METRICS,
        };
        let quads = |&count: &f64| Self {
            title: format!("{count} quads"),
            command: "quad",
            judged: args.judge.clone().map(|script| (count, script)),
            arguments: [vec!["--quads".into(), count.to_string().into()], args.arguments.clone()]
                .concat(),
            metrics: if args.judge.is_some() { JUDGED_METRICS } else { QUAD_METRICS },
        };
        [map].into_iter().chain(args.quads.iter().map(quads)).collect()
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

/// Compares; passes if nothing was lost.
pub(crate) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let paths = args.selection.paths()?;
    let temporary = tempfile::tempdir()?;
    let folder = args.keep.as_deref().unwrap_or(temporary.path());
    let builds = [("old", &args.old, &args.old_args), ("new", &args.new, &args.new_args)];
    let [old, new] =
        builds.map(|(side, path, own)| Build::new(path, folder.join(side), own.clone(), args));
    let (old, new) = (old?, new?);
    let mut text = format!("* old: {}\n* new: {}\n", old.label, new.label);
    let mut passed = true;
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
        passed &= pairs.iter().all(|pair| !pair.is_lost());
        text += &format!("\n### {}\n\n{table}\n{summary}", task.title);
    }
    Ok(Section { text, passed })
}

/// One of the two builds.
struct Build {
    program: Program,
    /// Where its results go.
    folder: PathBuf,
    /// Its own arguments.
    arguments: Vec<OsString>,
    /// What `--version` prints and its own arguments.
    label: String,
}

impl Build {
    fn new(
        path: &Path,
        folder: PathBuf,
        arguments: Vec<OsString>,
        args: &Args,
    ) -> Result<Self, Box<dyn Error>> {
        let output = std::process::Command::new(path).arg("--version").output();
        let output = output.map_err(|e| format!("cannot run {}: {e}", path.display()))?;
        let version = String::from_utf8_lossy(&output.stdout);
        let own = arguments.join(OsStr::new(" "));
        let label = format!("{} {}", version.trim(), own.to_string_lossy()).trim().to_owned();
        fs::create_dir_all(&folder)?;
        let threads = Some(args.threads);
        let program = Program { path: path.to_owned(), time_limit: args.time_limit, threads };
        Ok(Self { program, folder, arguments, label })
    }

    fn run(&self, mesh: &Path, task: &Task) -> (Outcome, PathBuf) {
        // The whole file name stays, since files may differ in their extensions only.
        let file = format!("{}.{}.obj", name(mesh), task.title.to_lowercase().replace(' ', "_"));
        let output = self.folder.join(file);
        let arguments = [task.arguments.as_slice(), &self.arguments].concat();
        let outcome = self.program.run(task.command, mesh, &output, &arguments);
        let outcome = match (outcome, &task.judged) {
            (Outcome::Done(report), Some((asked, script))) => {
                match judge(script, *asked, mesh, &output) {
                    Ok(verdict) => Outcome::Done(report.with("judged", verdict)),
                    Err(e) => Outcome::Failed(format!("not judged: {e}").into()),
                }
            }
            (outcome, _) => outcome,
        };
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
