//! Long work: threads, progress, the time limit, Ctrl-C.

use crate::args::RunArgs;
use crate::outcome::Failure;
use crate::output::Batch;
use crate::progress::Bars;
use crate::report::Cost;
use crate::stop::{Abandoned, Stop, supervise};
use crate::system;
use crate::text;
use seamstress_parametrize::Progress;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A run of a command that may take long.
pub(crate) struct Job {
    file: PathBuf,
    bars: Bars,
    stop: Stop,
}

/// What the working thread has of a [`Job`].
pub(crate) struct Worker {
    pub(crate) stop: Stop,
    bars: Bars,
}

impl Job {
    /// Starts the clock; `file` is the input that messages name.
    pub(crate) fn new(run: &RunArgs, file: &Path) -> Result<Self, Failure> {
        let stop = Stop::new(run.time_limit);
        set_threads(run.threads)?;
        Ok(Self { file: file.to_owned(), bars: Bars::new(!run.quiet), stop })
    }

    /// Does the work in a thread of its own, which is left behind if it does not stop when it should.
    pub(crate) fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce(Worker) -> Result<T, Failure> + Send + 'static,
    ) -> Result<T, Failure> {
        let worker = Worker { stop: self.stop.clone(), bars: self.bars.clone() };
        let made = supervise(&self.stop, move || work(worker));
        self.bars.clear();
        made.unwrap_or_else(|abandoned| Err(self.failure(abandoned)))
    }

    fn failure(&self, abandoned: Abandoned) -> Failure {
        let file = self.file.clone();
        match abandoned {
            Abandoned::Stopped(reason) => Failure::Stopped { file, reason },
            Abandoned::Panicked => {
                Failure::Internal { file, text: "the computation broke off".into() }
            }
        }
    }

    /// Puts the outputs in place, unless the run was stopped, and prints its report or its summary.
    pub(crate) fn finish(
        &self,
        run: &RunArgs,
        outputs: Batch,
        report: impl FnOnce() -> String,
        summary: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        if let Some(reason) = self.stop.reason() {
            return Err(Failure::Stopped { file: self.file.clone(), reason });
        }
        outputs.commit()?;
        match (run.json, run.quiet) {
            (true, _) => text::print(&report()),
            (false, true) => Ok(()),
            (false, false) => text::print(&summary()),
        }
    }

    /// What the run has cost so far.
    pub(crate) fn cost(&self) -> Cost {
        Cost {
            wall_seconds: self.stop.elapsed().as_secs_f64(),
            cpu_seconds: system::cpu_seconds(),
            peak_memory_bytes: system::peak_memory(),
            threads: rayon::current_num_threads(),
        }
    }
}

impl Worker {
    /// Shows progress, and breaks when the work should stop.
    pub(crate) fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        self.bars.show(progress);
        match self.stop.reason() {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    }
}

fn set_threads(threads: Option<u32>) -> Result<(), Failure> {
    let Some(threads) = threads else {
        return Ok(());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads as usize)
        .build_global()
        .map_err(|error| Failure::Usage(format!("cannot start {threads} threads: {error}")))
}
