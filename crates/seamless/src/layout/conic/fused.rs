//! Local steps inside the interior point: one run in place of many programs.

use super::ConicOptions;
use super::descent::Descent;
use super::interior_point::{Renewal, solve};
use super::objective::ConicObjective;
use super::program::Matrix2;
use super::solver::SolverOptions;
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Gap at which a fused run ends, as a part of the bound. Its program moves under it; below this gap
/// it creeps.
const GAP: f64 = 1e-3;
const MAX_ITERATIONS: usize = 60;

/// One interior-point run from the layout, frames (and scales, where the objective has any) renewed in
/// every iteration. A heuristic without proof of convergence: the result is taken only if it is better.
pub(super) fn fused(
    problem: &mut LayoutProblem,
    objective: ConicObjective,
    left: Option<&[Matrix2]>,
    descent: &mut Descent,
    options: &ConicOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(), Cancelled> {
    let program = objective.program(problem, left, &descent.z);
    let renewal = match program.scales {
        None => Renewal::Frames,
        Some(_) => Renewal::FramesAndScales,
    };
    let limits = SolverOptions {
        tolerance: GAP,
        max_iterations: options.program.max_iterations.min(MAX_ITERATIONS),
    };
    let solution = solve(problem, &program, &descent.y, renewal, &limits, watch)?;
    descent.record(&solution);
    descent.move_to(problem, objective, left, &solution.y);
    Ok(())
}
