//! The strategies of rounding side by side.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

use clap::{Parser, value_parser};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use seamstress_bench::process::{cpu_seconds, exit_code};
use seamstress_parametrize::mixed_integer::MixedIntegerOptions;
use seamstress_parametrize::rounding::RoundingStrategy;
use seamstress_parametrize::{MapError, MapOptions, MapSolution, make_map};
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Maps every mesh of a folder with two strategies of rounding
///
/// Prints the distortion, the cones and the times of both, and how they compare over all meshes. Times are
/// of the processor, all threads together, where the system tells.
#[derive(Debug, Parser)]
struct Args {
    /// The folder of meshes; its subfolders are left out
    folder: PathBuf,

    /// Write the table to this file as well
    #[arg(long, value_name = "TABLE.md")]
    out: Option<PathBuf>,

    /// Take only the files whose name contains this
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,

    /// Take only meshes of at most this many triangles
    #[arg(long, default_value_t = usize::MAX)]
    largest: usize,

    /// Take only meshes of at least this many triangles
    #[arg(long, default_value_t = 0)]
    smallest: usize,

    /// What to compare the default strategy with
    #[arg(long, value_enum, default_value_t = Against::LocalEstimation)]
    against: Against,

    /// Most integer variables at a time in mixed-integer rounding
    #[arg(long, default_value_t = MixedIntegerOptions::default().batch)]
    batch: usize,

    /// Most programs for each batch
    #[arg(long, default_value_t = MixedIntegerOptions::default().nodes)]
    nodes: usize,

    /// Give up on a map after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// How much both avoid cones
    #[arg(long, value_name = "X", default_value_t = MapOptions::default().rounding.cone_bias)]
    cone_bias: f64,
}

/// Names of the strategies other than the default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Against {
    /// Effect on a small patch
    LocalEstimation,
    /// Integer variables in programs of least tau
    MixedInteger,
}

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether every mesh was mapped with each strategy.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut failures = Vec::new();
    for path in meshes::list(&args.folder, args.only.as_deref())? {
        match meshes::load(&path) {
            Ok(mesh) if !args.takes(&mesh) => {}
            Ok(mesh) => match Row::measure(&path, &mesh, args) {
                Ok(row) => {
                    eprintln!("| {} |", row.cells().join(" | "));
                    rows.push(row);
                }
                Err(error) => failures.push(format!("* {}: {error}", meshes::name(&path))),
            },
            Err(error) => eprintln!("refused: {error}"),
        }
    }
    let names = args.strategies().map(|(_, name)| name);
    let mut table = Table::new(titles(names));
    rows.iter().for_each(|row| table.push(row.cells()));
    let mut text = format!("{table}\n{}\n", comparison(&rows, names));
    if !failures.is_empty() {
        text += &format!("\nFailed:\n\n{}\n", failures.join("\n"));
    }
    print!("{text}");
    if let Some(path) = &args.out {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(failures.is_empty())
}

impl Args {
    /// The strategies, with short names.
    fn strategies(&self) -> [(RoundingStrategy, &'static str); 2] {
        let other = match self.against {
            Against::LocalEstimation => (RoundingStrategy::LocalEstimation, "local"),
            Against::MixedInteger => (RoundingStrategy::MixedInteger, "mixed"),
        };
        [(RoundingStrategy::ConeBias, "bias"), other]
    }

    fn takes(&self, mesh: &Mesh) -> bool {
        (self.smallest..=self.largest).contains(&mesh.connectivity.n_faces())
    }
}

/// A figure of a map: its title, its decimals, its value.
type Figure = (&'static str, usize, fn(&Made) -> f64);

const FIGURES: [Figure; 5] = [
    ("tau", 3, |made| made.solution.distortion.tau),
    ("SD", 4, |made| made.solution.distortion.symmetric_dirichlet),
    ("p99", 3, |made| made.solution.distortion.tau_t.p99),
    ("cones", 0, |made| made.solution.map.cones().len() as f64),
    ("CPU s", 2, |made| made.seconds),
];

fn titles(names: [&str; 2]) -> Vec<String> {
    let mut titles = vec!["mesh".to_owned(), "triangles".to_owned()];
    for (title, ..) in FIGURES {
        titles.extend(names.map(|name| format!("{title}, {name}")));
    }
    titles
}

/// A map and its time.
struct Made {
    solution: MapSolution,
    seconds: f64,
}

impl Made {
    fn new(mesh: &Mesh, strategy: RoundingStrategy, args: &Args) -> Result<Self, MapError> {
        let mut options = MapOptions::default();
        options.rounding.strategy = strategy;
        options.rounding.cone_bias = args.cone_bias;
        options.rounding.mixed_integer.batch = args.batch;
        options.rounding.mixed_integer.nodes = args.nodes;
        let limit = args.time_limit.map(|seconds| Duration::from_secs(seconds.into()));
        let (start, before) = (Instant::now(), cpu_seconds());
        let mut observe = |_| match limit {
            Some(limit) if start.elapsed() > limit => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let solution = make_map(&mesh.connectivity, &mesh.positions, &options, &mut observe)?;
        let cpu = before.zip(cpu_seconds()).map(|(before, after)| after - before);
        Ok(Self { solution, seconds: cpu.unwrap_or_else(|| start.elapsed().as_secs_f64()) })
    }
}

/// The maps of one mesh, one for each strategy.
struct Row {
    name: String,
    triangles: usize,
    made: [Made; 2],
}

impl Row {
    fn measure(path: &Path, mesh: &Mesh, args: &Args) -> Result<Self, String> {
        let [first, second] = args.strategies().map(|(strategy, name)| {
            Made::new(mesh, strategy, args).map_err(|error| format!("{name}: {error}"))
        });
        Ok(Self {
            name: meshes::name(path),
            triangles: mesh.connectivity.n_faces(),
            made: [first?, second?],
        })
    }

    fn cells(&self) -> Vec<String> {
        let mut cells = vec![self.name.clone(), self.triangles.to_string()];
        for (_, decimals, value) in FIGURES {
            cells.extend(self.made.each_ref().map(|made| format!("{:.decimals$}", value(made))));
        }
        cells
    }
}

/// How the second strategy compares with the first over all meshes.
fn comparison(rows: &[Row], [first, second]: [&str; 2]) -> String {
    let mut text = format!("{second} against {first} over {} meshes:\n\n", rows.len());
    let line = |title: &str, value: &dyn Fn(&Made) -> f64| {
        let pairs: Vec<[f64; 2]> = rows.iter().map(|r| r.made.each_ref().map(value)).collect();
        let lower = pairs.iter().filter(|[a, b]| b < a).count();
        let higher = pairs.iter().filter(|[a, b]| b > a).count();
        let mean = mean_ratio(&pairs);
        format!("* {title}: lower on {lower}, higher on {higher}; mean ratio {mean:.3}\n")
    };
    for (title, _, value) in FIGURES {
        text += &match title {
            // An isometry has 4.
            "SD" => line("SD - 4", &|made| value(made) - 4.0),
            _ => line(title, &value),
        };
    }
    text
}

/// Geometric mean of second over first, where both are positive.
fn mean_ratio(pairs: &[[f64; 2]]) -> f64 {
    let positive = pairs.iter().filter(|pair| pair.iter().all(|&x| x > 0.0));
    let logs: Vec<f64> = positive.map(|[a, b]| (b / a).ln()).collect();
    (logs.iter().sum::<f64>() / logs.len() as f64).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_ratio_is_geometric_and_leaves_out_zeros() {
        let mean = mean_ratio(&[[1.0, 4.0], [2.0, 2.0], [0.0, 1.0]]);
        assert!((mean - 2.0).abs() < 1e-12);
    }
}
