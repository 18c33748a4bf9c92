//! Local steps inside the interior point: one run in place of many programs.

use super::Run;
use super::energy_term::EnergyTerm;
use super::interior_point::{Tradeoff, Weigh, solve, solve_with_energy};
use super::measure::MaximalMeasure;
use super::program::Renewal;
use super::solver::SolverOptions;
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Gap at which a fused run ends, as a part of the bound. Its program moves under it; below this gap
/// it creeps.
const GAP: f64 = 1e-3;
const MAX_ITERATIONS: usize = 60;
/// Trades of the energy for tau, most of which end before.
const MAX_TRADES: usize = 16;

impl Run<'_> {
    /// One interior-point run from the layout, frames (and scales, where the objective has any) renewed in
    /// every iteration. A heuristic without proof of convergence: the result is taken only if it is better.
    pub(super) fn fused(
        &mut self,
        measure: MaximalMeasure,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        let program = measure.program(self.problem, &self.descent.z);
        let renewal = match program.scales {
            None => Renewal::Frames,
            Some(_) => Renewal::FramesAndScales,
        };
        let limits = SolverOptions {
            tolerance: GAP,
            max_iterations: self.options.program.max_iterations.min(MAX_ITERATIONS),
        };
        let solution = solve(self.problem, &program, &self.descent.y, renewal, &limits, watch)?;
        self.descent.record(&solution);
        self.descent.move_to(self.problem, &solution.y);
        Ok(())
    }
}

/// One run for tau from a layout of minimum energy at its best scale, with the rise of the energy, weighed anew in every
/// iteration, in the objective. What it passes through is seen by who weighs; returns the iterations.
///
/// # Errors
/// [`Cancelled`].
pub(in crate::layout) fn trade<'a>(
    problem: &'a mut LayoutProblem,
    minimum: Vec<f64>,
    weigh: &'a mut Weigh<'a>,
    watch: &mut Watch<'_, '_>,
) -> Result<usize, Cancelled> {
    let z = problem.space().expand(&minimum);
    let program = MaximalMeasure::Tau.program(problem, &z);
    let term = EnergyTerm::new(problem, minimum.clone());
    let limits = SolverOptions { tolerance: GAP, max_iterations: MAX_TRADES };
    let tradeoff = Tradeoff { term, weigh };
    Ok(solve_with_energy(problem, &program, &minimum, tradeoff, &limits, watch)?.iterations)
}
