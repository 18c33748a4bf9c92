//! Algorithm 1 of Levi 2021, suppl.: global steps by a conic program, local steps by polar decomposition.

use super::Run;
use super::dispatch::solve;
use super::measure::MaximalMeasure;
use super::settling::Settling;
use crate::progress::{Cancelled, Watch};

impl Run<'_> {
    /// Alternates until the measure has settled to the tolerance.
    ///
    /// The layout with its own frames satisfies the program of its own value, so a global step never raises
    /// that value, and neither does the local step: frames and scales are the best ones of their triangles.
    pub(super) fn alternate(
        &mut self,
        measure: MaximalMeasure,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        let options = self.options;
        let mut settling = Settling::new(self.descent.value());
        for _ in 0..options.max_rounds {
            let program = measure.program(self.problem, &self.descent.z);
            let start = &self.descent.y;
            let global =
                solve(self.problem, &program, start, options.solver, &options.program, watch)?;
            self.descent.record(&global);
            self.descent.move_to(self.problem, &global.y);
            settling.push(self.descent.value());
            if settling.remaining() <= options.tolerance {
                break;
            }
        }
        self.descent.remaining = Some(settling.remaining());
        Ok(())
    }
}
