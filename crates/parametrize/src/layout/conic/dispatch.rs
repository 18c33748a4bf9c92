//! Two solvers for one program.

use super::interior_point;
use super::program::{Program, Renewal};
use super::reference;
use super::solver::{ConicSolution, Outcome, Solver, SolverOptions};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Solves a program from a layout; Clarabel, if it is part of the build, takes over where the own solver fails.
///
/// The own solver starts at `y`, which must satisfy the program's constraints (for some bound); a flip-free
/// layout with its own frames does. Clarabel needs no start.
///
/// # Errors
/// [`Cancelled`]. A failure of both solvers is reported by [`ConicSolution::outcome`].
pub fn solve(
    problem: &mut LayoutProblem,
    program: &Program,
    y: &[f64],
    solver: Solver,
    options: &SolverOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicSolution, Cancelled> {
    if solver == Solver::Clarabel {
        return reference::solve(problem, program, options, watch);
    }
    let own = interior_point::solve(problem, program, y, Renewal::Never, options, watch)?;
    if own.outcome == Outcome::Solved || !Solver::Clarabel.is_available() {
        return Ok(own);
    }
    let other = reference::solve(problem, program, options, watch)?;
    let neither = own.outcome == Outcome::NoInteriorStart && other.outcome == Outcome::Infeasible;
    if neither || other.outcome == Outcome::Solved || other.objective < own.objective {
        return Ok(ConicSolution { fallback_from: Some(own.outcome), ..other });
    }
    Ok(own)
}
