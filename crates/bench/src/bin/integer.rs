//! Integer maps of many meshes at several counts of quads.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

use clap::Parser;
use seamstress_bench::maps::{seamless, write_map};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::{self, Mesh};
use seamstress_bench::process::exit_code;
use seamstress_quantize::IntegerStats;
use seamstress_quantize::{
    GridSize, IntegerOptions, IntegerRounding, IntegerSolution, to_integer_map,
};
use serde_json::Value;
use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Makes integer maps of every mesh of a folder
///
/// Prints, for each mesh and count: the quads achieved, the energy and tau before and after, the seconds of
/// each part, how often the grid had to be finer, and, with a verifier, what that says.
#[derive(Debug, Parser)]
struct Args {
    /// The folder of meshes; its subfolders are left out
    folder: PathBuf,

    /// Quads asked for
    #[arg(long, value_delimiter = ',', default_values_t = [500.0, 2500.0, 10000.0])]
    quads: Vec<f64>,

    /// Take only the files whose name contains this
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,

    /// Leave out meshes of more triangles
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    most_triangles: usize,

    /// Round greedily instead
    #[arg(long)]
    greedy: bool,

    /// Keep the seamless maps in this folder, and take those that are there
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,

    /// A script that verifies an integer map: called with --integer --strict, the mesh and the map
    #[arg(long, value_name = "SCRIPT.py")]
    verify: Option<PathBuf>,

    /// Write the table to this file as well
    #[arg(long, value_name = "TABLE.md")]
    out: Option<PathBuf>,
}

const TITLES: [&str; 13] = [
    "mesh",
    "triangles",
    "cones",
    "asked",
    "quads",
    "off %",
    "SD",
    "tau",
    "integers",
    "finer",
    "reduce/round/move/polish s",
    "map s",
    "verifier",
];

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether every run gave an integer map that the verifier accepts.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let mut table = Table::new(TITLES);
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    for path in meshes::list(&args.folder, args.only.as_deref())? {
        let name = meshes::name(&path);
        let mesh = match meshes::load(&path) {
            Ok(mesh) if mesh.connectivity.n_faces() <= args.most_triangles => mesh,
            Ok(_) => continue,
            Err(error) => {
                eprintln!("refused: {error}");
                continue;
            }
        };
        for &asked in &args.quads {
            tally.runs += 1;
            match measure(&name, &mesh, asked, args) {
                Ok(row) => {
                    tally.add(&row);
                    let cells = row.cells(&name, &mesh);
                    eprintln!("| {} |", cells.join(" | "));
                    table.push(cells);
                }
                Err(error) => {
                    eprintln!("{name} at {asked}: {error}");
                    failures.push(format!("* {name} at {asked}: {error}"));
                }
            }
        }
    }
    let mut text = format!("{table}\n{tally}");
    if !failures.is_empty() {
        text += &format!("\nFailed:\n\n{}\n", failures.join("\n"));
    }
    print!("{text}");
    if let Some(path) = &args.out {
        fs::write(path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    }
    Ok(failures.is_empty() && tally.refuted == 0)
}

/// What came out of one run.
struct Row {
    asked: f64,
    cones: usize,
    /// Seconds for the seamless map.
    seconds: f64,
    solution: IntegerSolution,
    verdict: Option<Verdict>,
}

fn measure(name: &str, mesh: &Mesh, asked: f64, args: &Args) -> Result<Row, Box<dyn Error>> {
    let (map, seconds) = seamless(name, mesh, asked, args.maps.as_deref())?;
    let rounding = if args.greedy { IntegerRounding::Greedy } else { IntegerRounding::Constrained };
    let options = IntegerOptions { size: GridSize::Quads(asked), rounding, ..Default::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let solution = to_integer_map(&mesh.connectivity, &mesh.positions, &map, &options, &mut go_on)?;
    let verdict = match &args.verify {
        Some(script) => Some(verify(script, mesh, &solution)?),
        None => None,
    };
    Ok(Row { asked, cones: map.cones().len(), seconds, solution, verdict })
}

impl Row {
    fn off(&self) -> f64 {
        self.solution.quads() / self.asked - 1.0
    }

    fn cells(&self, name: &str, mesh: &Mesh) -> Vec<String> {
        let solution = &self.solution;
        let sum =
            |part: fn(&IntegerStats) -> f64| solution.components.iter().map(part).sum::<f64>();
        let (before, after) = (&solution.before, &solution.distortion);
        let parts = [
            sum(|c| c.seconds_reduction),
            sum(|c| c.seconds_rounding),
            sum(|c| c.seconds_moving),
            sum(|c| c.seconds_polish),
        ];
        vec![
            name.to_owned(),
            mesh.connectivity.n_faces().to_string(),
            self.cones.to_string(),
            format!("{:.0}", self.asked),
            format!("{:.1}", solution.quads()),
            format!("{:+.1}", 100.0 * self.off()),
            format!("{:.3} to {:.3}", before.symmetric_dirichlet, after.symmetric_dirichlet),
            format!("{:.2} to {:.2}", before.tau, after.tau),
            format!("{:.0}", sum(|c| c.integers as f64)),
            solution.refinements().to_string(),
            parts.map(|x| format!("{x:.2}")).join("/"),
            format!("{:.1}", self.seconds),
            self.verdict.as_ref().map_or("-".into(), Verdict::cell),
        ]
    }
}

/// Counts over all runs.
#[derive(Default)]
struct Tally {
    runs: usize,
    done: usize,
    refined: usize,
    far: usize,
    refuted: usize,
    verified: usize,
}

impl Tally {
    fn add(&mut self, row: &Row) {
        self.done += 1;
        self.refined += usize::from(row.solution.refinements() > 0);
        self.far += usize::from(row.asked >= 2500.0 && row.off().abs() > 0.05);
        self.verified += usize::from(row.verdict.is_some());
        self.refuted += usize::from(row.verdict.as_ref().is_some_and(|v| !v.is_good));
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(
            f,
            "{} of {} runs gave an integer map, {} of them on a finer grid. {} of those at 2500 and more \
             are off by over 5 %. The verifier refused {} of {}.",
            self.done, self.runs, self.refined, self.far, self.refuted, self.verified
        )
    }
}

/// What the script says of an integer map.
struct Verdict {
    is_good: bool,
    flips: Option<u64>,
}

impl Verdict {
    fn cell(&self) -> String {
        let word = if self.is_good { "ok" } else { "FAIL" };
        let flips = self.flips.map_or("-".into(), |n| n.to_string());
        format!("{word}, {flips} flips")
    }
}

fn verify(
    script: &Path,
    mesh: &Mesh,
    solution: &IntegerSolution,
) -> Result<Verdict, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let [source, map] = ["source.obj", "map.obj"].map(|name| folder.path().join(name));
    write_mesh(&source, mesh)?;
    write_map(&map, mesh, solution.map.corner_uvs())?;
    let mut command = Command::new("python3");
    command.arg(script).args(["--integer", "--strict"]).arg(source).arg(map);
    let output = command.output()?;
    let json: Value = serde_json::from_slice(&output.stdout)?;
    let is_good = output.status.success() && json["ok"] == Value::Bool(true);
    Ok(Verdict { is_good, flips: json["flipped_or_degenerate"].as_u64() })
}

/// Writes triangles without UVs.
fn write_mesh(path: &Path, mesh: &Mesh) -> Result<(), Box<dyn Error>> {
    let mut file = BufWriter::new(File::create(path)?);
    for [x, y, z] in &mesh.positions {
        writeln!(file, "v {x} {y} {z}")?;
    }
    for face in mesh.faces() {
        let [a, b, c] = face.map(|v| v + 1);
        writeln!(file, "f {a} {b} {c}")?;
    }
    Ok(file.flush()?)
}
