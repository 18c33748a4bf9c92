//! The strategies of rounding side by side.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

use clap::{Parser, value_parser};
use seamstress::rounding::RoundingStrategy;
use seamstress::{MapError, MapOptions, MapSolution, Stage, make_map};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Maps every mesh of a folder with each strategy of rounding
///
/// Prints the distortion, the cones and the times of both, and how they compare over all meshes.
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

    /// Give up on a map after this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u32).range(1..))]
    time_limit: Option<u32>,

    /// How much both avoid cones
    #[arg(long, value_name = "X", default_value_t = MapOptions::default().rounding.cone_bias)]
    cone_bias: f64,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Whether every mesh was mapped with each strategy.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut failures = Vec::new();
    for path in meshes::list(&args.folder, args.only.as_deref())? {
        match meshes::load(&path) {
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
    let mut table = Table::new(titles());
    rows.iter().for_each(|row| table.push(row.cells()));
    let mut text = format!("{table}\n{}\n", comparison(&rows));
    if !failures.is_empty() {
        text += &format!("\nFailed:\n\n{}\n", failures.join("\n"));
    }
    print!("{text}");
    if let Some(path) = &args.out {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(failures.is_empty())
}

/// The strategies, with short names.
const STRATEGIES: [(RoundingStrategy, &str); 2] =
    [(RoundingStrategy::ConeBias, "bias"), (RoundingStrategy::LocalEstimation, "local")];

/// A figure of a map: its title, its decimals, its value.
type Figure = (&'static str, usize, fn(&Made) -> f64);

const FIGURES: [Figure; 6] = [
    ("tau", 3, |made| made.solution.distortion.tau),
    ("SD", 4, |made| made.solution.distortion.symmetric_dirichlet),
    ("p99", 3, |made| made.solution.distortion.tau_t.p99),
    ("cones", 0, |made| made.solution.map.cones().len() as f64),
    ("rounding s", 2, Made::rounding_seconds),
    ("map s", 2, |made| made.seconds),
];

fn titles() -> Vec<String> {
    let mut titles = vec!["mesh".to_owned(), "triangles".to_owned()];
    for (title, ..) in FIGURES {
        titles.extend(STRATEGIES.map(|(_, name)| format!("{title}, {name}")));
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
        let limit = args.time_limit.map(|seconds| Duration::from_secs(seconds.into()));
        let start = Instant::now();
        let mut observe = |_| match limit {
            Some(limit) if start.elapsed() > limit => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let solution = make_map(&mesh.connectivity, &mesh.positions, &options, &mut observe)?;
        Ok(Self { solution, seconds: start.elapsed().as_secs_f64() })
    }

    fn rounding_seconds(&self) -> f64 {
        let stages = self.solution.components.iter().flat_map(|c| &c.stages);
        stages.filter(|s| s.stage == Stage::Rounding).map(|s| s.seconds).sum()
    }
}

/// The maps of one mesh, one for each of the [`STRATEGIES`].
struct Row {
    name: String,
    triangles: usize,
    made: [Made; 2],
}

impl Row {
    fn measure(path: &Path, mesh: &Mesh, args: &Args) -> Result<Self, String> {
        let [first, second] = STRATEGIES.map(|(strategy, name)| {
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
fn comparison(rows: &[Row]) -> String {
    let [(_, first), (_, second)] = STRATEGIES;
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
