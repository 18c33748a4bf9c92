//! The same programs by Clarabel, a general conic solver.

use super::general::{Cone, run};
use super::program::{Program, ProgramKind};
use super::rows::{Row, Rows, part_rows};
use super::solver::{ConicSolution, Solver, SolverOptions};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

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
    let (x, end) = run(rows.into_columns(), &cost, &cones, options);
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

/// `(s; z)`, `(mu - s; w)`, `(Re(z conj R) - 1; w)` per triangle.
fn stretch(problem: &LayoutProblem, program: &Program) -> (Rows, Vec<Cone>) {
    let (n, triangles) = (problem.space().n_unknowns(), problem.triangles());
    let mut rows = Rows::new(n + 1 + triangles.len());
    for (t, triangle) in triangles.iter().enumerate() {
        let [z0, z1, w0, w1] = part_rows(problem.space(), triangle, program.scale(t));
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
    (rows, vec![Cone::SecondOrder(3); 3 * triangles.len()])
}

/// `(m; z - R, w)` per triangle.
fn deviation(problem: &LayoutProblem, program: &Program) -> (Rows, Vec<Cone>) {
    let (n, triangles) = (problem.space().n_unknowns(), problem.triangles());
    let mut rows = Rows::new(n + 1);
    for (t, triangle) in triangles.iter().enumerate() {
        let [z0, z1, w0, w1] = part_rows(problem.space(), triangle, program.scale(t));
        let frame = program.frames[t];
        rows.push(&Row::of(n, 1.0), 0.0);
        rows.push(&z0, -frame.re);
        rows.push(&z1, -frame.im);
        rows.push(&w0, 0.0);
        rows.push(&w1, 0.0);
    }
    (rows, vec![Cone::SecondOrder(5); triangles.len()])
}
