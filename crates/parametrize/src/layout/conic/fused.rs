//! Local steps inside the interior point: one run in place of many programs.

use super::Run;
use super::interior_point::solve;
use super::measure::MaximalMeasure;
use super::program::Renewal;
use super::solver::SolverOptions;
use crate::progress::{Cancelled, Watch};

/// Gap at which a fused run ends, as a part of the bound. Its program moves under it; below this gap
/// it creeps.
const GAP: f64 = 1e-3;
const MAX_ITERATIONS: usize = 60;

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
