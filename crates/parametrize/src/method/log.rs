//! The cost of stages.

use super::StageStats;
use crate::progress::{SolveError, Stage, Watch};
use web_time::Instant;

/// Seconds and iterations of the stages run so far.
#[derive(Debug, Default)]
pub(super) struct StageLog {
    stages: Vec<StageStats>,
    /// When the last of them began.
    since: Option<Instant>,
}

impl StageLog {
    /// Ends the stage before and begins another.
    ///
    /// # Errors
    /// When the caller asks to stop.
    pub(super) fn enter(
        &mut self,
        stage: Stage,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), SolveError> {
        self.end();
        self.since = Some(Instant::now());
        self.stages.push(StageStats { stage, seconds: 0.0, iterations: 0 });
        Ok(watch.enter(stage)?)
    }

    /// Adds iterations to the present stage.
    pub(super) fn count(&mut self, iterations: usize) {
        if let Some(last) = self.stages.last_mut() {
            last.iterations += iterations;
        }
    }

    /// Ends the last stage.
    pub(super) fn finish(mut self) -> Vec<StageStats> {
        self.end();
        self.stages
    }

    fn end(&mut self) {
        if let (Some(last), Some(since)) = (self.stages.last_mut(), self.since) {
            last.seconds = since.elapsed().as_secs_f64();
        }
    }
}
