//! Maximal measures, by conic programs.

use super::{ConicStats, Ending, Found, ObjectiveOptions, OptimizeError};
use crate::layout::conic::{self, Outcome, Phase};
use crate::layout::exact::ExactLayout;
use crate::progress::Watch;

/// Minimises in phases.
pub(super) fn minimize(
    layout: &mut ExactLayout,
    start: Vec<f64>,
    phases: &[Phase],
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, OptimizeError> {
    let problem = layout.problem_mut();
    let found = conic::minimize(problem, start, phases, &options.conic, watch)?;
    let is_settled = found.remaining.is_some_and(|part| part <= options.conic.tolerance);
    let ending = match found.outcome {
        Outcome::Solved if is_settled => Ending::Converged,
        _ => Ending::Stopped,
    };
    let stats = ConicStats {
        programs: found.rounds,
        remaining: found.remaining,
        solver: found.solver_used,
        fallback_from: found.fallback_from,
        injective_by_bound: found.injective_by_bound,
    };
    let conic = Some(stats);
    Ok(Found { y: found.y, iterations: found.iterations, ending, conic })
}
