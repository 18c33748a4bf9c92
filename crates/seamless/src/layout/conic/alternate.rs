//! Algorithm 1 of the seed: global steps by a conic program, local steps by polar decomposition.

use super::ConicOptions;
use super::descent::Descent;
use super::objective::ConicObjective;
use super::program::Matrix2;
use super::solver::solve;
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Alternates from a flip-free layout until the measure settles.
///
/// The layout with its own frames satisfies the program of its own value, so a global step never raises
/// that value, and neither does the local step: frames and scales are the best ones of their triangles.
pub(super) fn alternate(
    problem: &mut LayoutProblem,
    objective: ConicObjective,
    left: Option<&[Matrix2]>,
    descent: &mut Descent,
    options: &ConicOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(), Cancelled> {
    for _ in 0..options.max_rounds {
        let before = descent.value;
        let program = objective.program(problem, left, &descent.z);
        let global = solve(problem, &program, &descent.y, options.solver, &options.program, watch)?;
        descent.record(&global);
        descent.move_to(problem, objective, left, &global.y);
        if !(descent.value < before * (1.0 - options.tolerance)) {
            break;
        }
    }
    Ok(())
}
