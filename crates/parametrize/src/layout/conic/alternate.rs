//! Algorithm 1 of the seed: global steps by a conic program, local steps by polar decomposition.

use super::Run;
use super::objective::ConicObjective;
use super::solver::solve;
use crate::progress::{Cancelled, Watch};

impl Run<'_> {
    /// Alternates until the measure settles.
    ///
    /// The layout with its own frames satisfies the program of its own value, so a global step never raises
    /// that value, and neither does the local step: frames and scales are the best ones of their triangles.
    pub(super) fn alternate(
        &mut self,
        objective: ConicObjective,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        let options = self.options;
        for _ in 0..options.max_rounds {
            let before = self.descent.value;
            let program = objective.program(self.problem, self.left, &self.descent.z);
            let start = &self.descent.y;
            let global =
                solve(self.problem, &program, start, options.solver, &options.program, watch)?;
            self.descent.record(&global);
            self.descent.move_to(self.problem, objective, self.left, &global.y);
            if self.descent.value >= before * (1.0 - options.tolerance) {
                break;
            }
        }
        Ok(())
    }
}
