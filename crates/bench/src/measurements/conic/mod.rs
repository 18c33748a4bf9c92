//! Our interior point against Clarabel: optimum, CPU time and memory.

mod input;
mod measure;

use crate::map_files::write_map;
use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::{Section, progress};
use clap::ValueEnum;
use measure::{Measurement, solve_alone};
use seamstress_mesh::components::components;
use seamstress_parametrize::layout::conic::Solver;
use seamstress_parametrize::{MapOptions, make_map};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;

/// Conic programs: our interior point against Clarabel
///
/// For a map of every mesh of one component, one program of each kind with the map's own frames and scales, over all
/// layouts with the seams and matchings of the map; both solvers one after the other, each in a process and on a
/// thread of its own, to the same tolerance. CPU seconds are those of setup (ordering, analysis) and solution.
/// Memory is the peak of the process above the level before the solver's own setup. It counts as a failure if
/// optima differ by more than 1e-4.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// The programs to solve [default: all]
    #[arg(long, value_enum, value_delimiter = ',')]
    programs: Vec<Choice>,

    /// Duality gap, relative to the objective
    #[arg(long, value_name = "X", default_value_t = 1e-6)]
    tolerance: f64,

    /// Gap for Clarabel, if different
    #[arg(long, value_name = "X")]
    clarabel_tolerance: Option<f64>,

    /// Solve one program on a map, an OBJ file, with one solver, and print numbers: for the processes that this
    /// program starts
    #[arg(long, value_enum, hide = true)]
    alone: Option<SolverChoice>,
}

/// A program of Levi 2021.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Choice {
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
pub(super) enum SolverChoice {
    /// Ours
    Own,
    /// The reference
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

/// Solves every program; passes if all optima agree.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let programs: &[Choice] =
        if args.programs.is_empty() { Choice::value_variants() } else { &args.programs };
    if let Some(solver) = args.alone {
        let (Some(map), Some(&program)) = (args.selection.meshes.first(), programs.first()) else {
            return Err("nothing to solve".into());
        };
        let measurement = solve_alone(map, program, solver.into(), args.tolerance)?;
        return Ok(Section::new(format!("{}\n", measurement.to_line()), &[]));
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
    let folder = tempfile::tempdir()?;
    let map = folder.path().join("map.obj");
    let failures = args.selection.survey(|subject| {
        let Mesh { connectivity, positions } = &subject.mesh;
        if components(connectivity)?.len() != 1 {
            progress(&format!("left out: {}: several components", subject.name));
            return Ok(());
        }
        let mut go_on = |_| ControlFlow::Continue(());
        let made = make_map(connectivity, positions, &MapOptions::default(), &mut go_on)?;
        write_map(&map, &subject.mesh, made.map.corner_uvs())?;
        let mut worst = 0.0_f64;
        for &program in programs {
            let own = alone(&map, program, SolverChoice::Own, args.tolerance)?;
            let tolerance = args.clarabel_tolerance.unwrap_or(args.tolerance);
            let other = alone(&map, program, SolverChoice::Clarabel, tolerance)?;
            let difference = own.objective / other.objective - 1.0;
            let is_own = own.solver == "own";
            worst = worst.max(if is_own { difference.abs() } else { f64::INFINITY });
            table.report(row(&subject.name, program, &own, &other, difference));
        }
        let agree = worst <= AGREEMENT;
        if agree { Ok(()) } else { Err(format!("the optima differ by {worst:.1e}").into()) }
    })?;
    Ok(Section::new(table, &failures))
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
        .arg("conic")
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
    // The page has the line of numbers at its end.
    let line = text.trim().lines().last().unwrap_or_default();
    Measurement::from_line(line).ok_or_else(|| {
        let reason = String::from_utf8_lossy(&output.stderr);
        format!("{program:?}, {solver:?}: {}", reason.trim()).into()
    })
}

fn row(
    name: &str,
    program: Choice,
    own: &Measurement,
    other: &Measurement,
    difference: f64,
) -> Vec<String> {
    let megabytes = |m: &Measurement| format!("{:.0}", m.bytes / 1e6);
    let mark = |m: &Measurement| if m.outcome == "Solved" { "" } else { " (!)" };
    vec![
        name.to_owned(),
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
