//! One program by one solver in this process.

use super::Choice;
use super::input::Input;
use crate::process::{cpu_seconds, forget_peak_memory, memory, peak_memory};
use seamstress_parametrize::layout::conic::{MaximalMeasure, Solver, SolverOptions, solve};
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::progress::Watch;
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

/// What came of it.
#[derive(Debug)]
pub(super) struct Measurement {
    pub(super) triangles: usize,
    pub(super) objective: f64,
    pub(super) iterations: usize,
    pub(super) seconds: f64,
    pub(super) bytes: f64,
    pub(super) outcome: String,
    pub(super) solver: String,
}

impl Measurement {
    /// As one line for another process.
    pub(super) fn to_line(&self) -> String {
        let Self { triangles, objective, iterations, seconds, bytes, outcome, solver } = self;
        format!("{triangles} {objective:e} {iterations} {seconds} {bytes} {outcome} {solver}")
    }

    /// From such a line.
    pub(super) fn from_line(line: &str) -> Option<Self> {
        let mut words = line.split(' ');
        let mut next = || words.next();
        Some(Self {
            triangles: next()?.parse().ok()?,
            objective: next()?.parse().ok()?,
            iterations: next()?.parse().ok()?,
            seconds: next()?.parse().ok()?,
            bytes: next()?.parse().ok()?,
            outcome: next()?.to_owned(),
            solver: next()?.to_owned(),
        })
    }
}

/// Solves the program of a map's own frames and scales.
pub(super) fn solve_alone(
    path: &Path,
    program: Choice,
    solver: Solver,
    tolerance: f64,
) -> Result<Measurement, Box<dyn Error>> {
    let input = Input::load(path)?;
    let measure = match program {
        Choice::ArapMax => MaximalMeasure::Arap,
        Choice::Tau => MaximalMeasure::Tau,
        Choice::AsapMax => MaximalMeasure::Asap,
        Choice::Dilatation => MaximalMeasure::Dilatation,
    };
    let options = SolverOptions { tolerance, ..SolverOptions::default() };
    let mut observe = |_| ControlFlow::Continue(());
    let mut watch = Watch::new(&mut observe, 0, 1);

    let program = measure.program(input.layout.problem(), &input.z);
    let Input { layout, y, z } = input;
    // The own solver sets up ordering, analysis and factor: they count as its own.
    let (space, triangles) =
        (layout.problem().space().clone(), layout.problem().triangles().to_vec());
    drop((layout, z));
    forget_peak_memory();
    let mut before = (memory(), cpu_seconds());
    let mut problem = LayoutProblem::new(space, triangles, None)?;
    if solver == Solver::Clarabel {
        forget_peak_memory();
        before = (memory(), cpu_seconds());
    }
    let solution = solve(&mut problem, &program, &y, solver, &options, &mut watch)?;
    let after = (peak_memory(), cpu_seconds());
    let difference = |a: Option<f64>, b: Option<f64>| Some(a? - b?);
    Ok(Measurement {
        triangles: problem.triangles().len(),
        objective: solution.objective,
        iterations: solution.iterations,
        seconds: difference(after.1, before.1).unwrap_or(f64::NAN),
        bytes: difference(after.0, before.0).unwrap_or(f64::NAN),
        outcome: format!("{:?}", solution.outcome),
        solver: match solution.solver_used {
            Solver::Own => "own".to_owned(),
            Solver::Clarabel => "clarabel".to_owned(),
        },
    })
}
