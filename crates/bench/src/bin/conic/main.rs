//! The own interior point against Clarabel: optimum, CPU time and memory.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "the table and its progress are what this program is for"
)]

mod input;
mod measure;

use clap::{Parser, ValueEnum};
use measure::{Measurement, measure};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes::name;
use seamstress_bench::process::exit_code;
use seamstress_parametrize::layout::conic::Solver;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Compares the own solver of conic programs with Clarabel
///
/// For every map, one program of each kind with the map's own frames and scales, over all layouts with the
/// seams and matchings of the map; both solvers one after the other, each in a process and on a thread of
/// its own, to the same tolerance. CPU seconds are those of setup (ordering, analysis) and solution. Memory is
/// the peak of the process above what it holds before the solver's own setup. The exit code is 0 if all
/// optima agree to 1e-4.
#[derive(Debug, Parser)]
struct Args {
    /// Maps of one component each, as `seamstress map` writes them
    #[arg(required = true)]
    maps: Vec<PathBuf>,

    /// The programs to solve [default: all]
    #[arg(long, value_enum, value_delimiter = ',')]
    programs: Vec<Choice>,

    /// Gap, as a part of the objective
    #[arg(long, value_name = "X", default_value_t = 1e-6)]
    tolerance: f64,

    /// Gap for Clarabel, where it is to be another
    #[arg(long, value_name = "X")]
    clarabel_tolerance: Option<f64>,

    /// Solve with one solver only, and print numbers: what the processes started by this program do
    #[arg(long, value_enum, hide = true)]
    alone: Option<SolverChoice>,
}

/// A program of the seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Choice {
    /// Eq. (8)
    ArapMax,
    /// Eq. (9)
    Tau,
    /// Eq. (11)
    AsapMax,
    /// Eq. (12)
    Dilatation,
}

/// A solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SolverChoice {
    Own,
    Clarabel,
}

impl From<SolverChoice> for Solver {
    fn from(choice: SolverChoice) -> Self {
        match choice {
            SolverChoice::Own => Self::Own,
            SolverChoice::Clarabel => Self::Clarabel,
        }
    }
}

/// Largest relative difference of optima that counts as agreement.
const AGREEMENT: f64 = 1e-4;

fn main() -> ExitCode {
    exit_code(run(&Args::parse()))
}

/// Whether all optima agree.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let programs: &[Choice] =
        if args.programs.is_empty() { Choice::value_variants() } else { &args.programs };
    if let Some(solver) = args.alone {
        let (Some(map), Some(&program)) = (args.maps.first(), programs.first()) else {
            return Err("nothing to solve".into());
        };
        println!("{}", measure(map, program, solver.into(), args.tolerance)?.to_line());
        return Ok(true);
    }
    let mut table = Table::new([
        "map",
        "program",
        "triangles",
        "own",
        "Clarabel",
        "difference",
        "own it.",
        "Cl. it.",
        "own CPU s",
        "Cl. CPU s",
        "ratio",
        "own MB",
        "Cl. MB",
        "ratio",
    ]);
    let mut agree = true;
    for map in &args.maps {
        for &program in programs {
            let own = alone(map, program, SolverChoice::Own, args.tolerance)?;
            let tolerance = args.clarabel_tolerance.unwrap_or(args.tolerance);
            let other = alone(map, program, SolverChoice::Clarabel, tolerance)?;
            let difference = own.objective / other.objective - 1.0;
            agree &= difference.abs() <= AGREEMENT && own.solver == "own";
            let cells = row(map, program, &own, &other, difference);
            eprintln!("| {} |", cells.join(" | "));
            table.push(cells);
        }
    }
    print!("{table}");
    Ok(agree)
}

/// Measures in a process of its own.
fn alone(
    map: &Path,
    program: Choice,
    solver: SolverChoice,
    tolerance: f64,
) -> Result<Measurement, Box<dyn Error>> {
    let value = |name: Option<clap::builder::PossibleValue>| {
        name.map_or(String::new(), |value| value.get_name().to_owned())
    };
    let output = Command::new(std::env::current_exe()?)
        .arg(map)
        .args(["--programs", &value(program.to_possible_value())])
        .args(["--alone", &value(solver.to_possible_value())])
        .args(["--tolerance", &tolerance.to_string()])
        .env("RAYON_NUM_THREADS", "1")
        // Freed blocks go back to the system (glibc), so that resident memory is what is in use.
        .env("MALLOC_MMAP_THRESHOLD_", "65536")
        .env("MALLOC_TRIM_THRESHOLD_", "65536")
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    Measurement::from_line(text.trim()).ok_or_else(|| {
        let reason = String::from_utf8_lossy(&output.stderr);
        format!("{}, {program:?}, {solver:?}: {}", map.display(), reason.trim()).into()
    })
}

fn row(
    map: &Path,
    program: Choice,
    own: &Measurement,
    other: &Measurement,
    difference: f64,
) -> Vec<String> {
    let megabytes = |m: &Measurement| format!("{:.0}", m.bytes / 1e6);
    let mark = |m: &Measurement| if m.outcome == "Solved" { "" } else { " (!)" };
    vec![
        name(map),
        program.to_possible_value().map_or(String::new(), |v| v.get_name().to_owned()),
        own.triangles.to_string(),
        format!("{:.7}{}", own.objective, mark(own)),
        format!("{:.7}{}", other.objective, mark(other)),
        format!("{difference:.1e}"),
        own.iterations.to_string(),
        other.iterations.to_string(),
        format!("{:.2}", own.seconds),
        format!("{:.2}", other.seconds),
        format!("{:.1}", other.seconds / own.seconds),
        megabytes(own),
        megabytes(other),
        format!("{:.1}", other.bytes / own.bytes),
    ]
}
