//! The same programs by Clarabel, a general conic solver.

use super::program::{Matrix2, Program, ProgramKind};
use super::rows::{Row, Rows, part_rows};
use super::solver::{ConicSolution, Outcome, Solver, SolverOptions};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SecondOrderConeT, SolverStatus, SupportedConeT,
};

/// Solves a program to the tolerance in gap and feasibility; needs no start.
///
/// Columns: the layout's unknowns, mu (for [`ProgramKind::Deviation`] `m`, the root of `mu / 2`), then, for
/// [`ProgramKind::Stretch`], an epigraph variable per triangle; the parts z and w of the Jacobians are
/// substituted.
///
/// # Errors
/// [`Cancelled`].
pub fn solve(
    problem: &LayoutProblem,
    program: &Program,
    options: &SolverOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicSolution, Cancelled> {
    watch.pulse()?;
    let n = problem.space().n_unknowns();
    let (rows, cones) = match program.kind {
        ProgramKind::Stretch => stretch(problem, program),
        ProgramKind::Deviation => deviation(problem, program),
    };
    let mut cost = vec![0.0; rows.columns()];
    cost[n] = 1.0;
    let (x, end) = run(&rows.into_csc(), &cost, &cones, options);
    watch.pulse()?;
    let y = x[..n].to_vec();
    Ok(ConicSolution {
        objective: program.value(problem, &problem.space().expand(&y)),
        gap: end.gap,
        iterations: end.iterations,
        outcome: end.outcome,
        solver_used: Solver::Clarabel,
        fallback_from: None,
        y,
    })
}

fn scale_and_left(program: &Program, t: usize) -> (f64, Option<&Matrix2>) {
    let scale = program.scales.as_ref().map_or(1.0, |scales| scales[t]);
    (scale, program.left.as_ref().map(|left| &left[t]))
}

/// `(s; z)`, `(mu - s; w)`, `(Re(z conj R) - 1; w)` per triangle.
fn stretch(problem: &LayoutProblem, program: &Program) -> (Rows, Vec<SupportedConeT<f64>>) {
    let (n, triangles) = (problem.space().n_unknowns(), problem.triangles());
    let mut rows = Rows::new(n + 1 + triangles.len());
    for (t, triangle) in triangles.iter().enumerate() {
        let (scale, left) = scale_and_left(program, t);
        let [z0, z1, w0, w1] = part_rows(problem.space(), triangle, scale, left);
        let (bound, epigraph) = (Row::of(n, 1.0), Row::of(n + 1 + t, 1.0));
        let frame = program.frames[t];
        let along = z0.times(frame.re).plus(&z1.times(frame.im));
        let axis = bound.plus(&epigraph.times(-1.0));
        for (row, constant) in [
            (&epigraph, 0.0),
            (&z0, 0.0),
            (&z1, 0.0),
            (&axis, 0.0),
            (&w0, 0.0),
            (&w1, 0.0),
            (&along, -1.0),
            (&w0, 0.0),
            (&w1, 0.0),
        ] {
            rows.push(row, constant);
        }
    }
    (rows, vec![SecondOrderConeT(3); 3 * triangles.len()])
}

/// `(m; z - R, w)` per triangle.
fn deviation(problem: &LayoutProblem, program: &Program) -> (Rows, Vec<SupportedConeT<f64>>) {
    let (n, triangles) = (problem.space().n_unknowns(), problem.triangles());
    let mut rows = Rows::new(n + 1);
    for (t, triangle) in triangles.iter().enumerate() {
        let (scale, left) = scale_and_left(program, t);
        let [z0, z1, w0, w1] = part_rows(problem.space(), triangle, scale, left);
        let frame = program.frames[t];
        rows.push(&Row::of(n, 1.0), 0.0);
        rows.push(&z0, -frame.re);
        rows.push(&z1, -frame.im);
        rows.push(&w0, 0.0);
        rows.push(&w1, 0.0);
    }
    (rows, vec![SecondOrderConeT(5); triangles.len()])
}

/// How Clarabel ended.
pub(super) struct End {
    pub(super) gap: f64,
    pub(super) iterations: usize,
    pub(super) outcome: Outcome,
}

/// Minimises `cost . x` with `A x + b` in the cones, one thread.
pub(super) fn run(
    (matrix, constants): &(CscMatrix<f64>, Vec<f64>),
    cost: &[f64],
    cones: &[SupportedConeT<f64>],
    options: &SolverOptions,
) -> (Vec<f64>, End) {
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: options.max_iterations as u32,
        tol_gap_abs: options.tolerance,
        tol_gap_rel: options.tolerance,
        tol_feas: options.tolerance,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let n = cost.len();
    let failed = End { gap: f64::NAN, iterations: 0, outcome: Outcome::ReferenceFailed };
    let quadratic = CscMatrix::<f64>::zeros((n, n));
    let Ok(mut solver) = DefaultSolver::new(&quadratic, cost, matrix, constants, cones, settings)
    else {
        return (vec![0.0; n], failed);
    };
    solver.solve();
    let outcome = match solver.solution.status {
        SolverStatus::Solved => Outcome::Solved,
        SolverStatus::MaxIterations => Outcome::IterationLimit,
        SolverStatus::InsufficientProgress => Outcome::Stalled,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            Outcome::Infeasible
        }
        _ => Outcome::ReferenceFailed,
    };
    let (primal, dual) = (solver.solution.obj_val, solver.solution.obj_val_dual);
    let gap = (primal - dual).abs() / primal.abs().max(1e-12);
    let iterations = solver.solution.iterations as usize;
    (solver.solution.x, End { gap, iterations, outcome })
}
