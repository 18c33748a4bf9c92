//! Running work: threads, progress, the time limit, Ctrl-C.

use crate::args::RunArgs;
use crate::failure::Failure;
use crate::progress::Bars;
use crate::system;
use seamstress::{CancelToken, Context};
use serde::Serialize;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How long work may take to notice that it should stop, before it is abandoned.
const GRACE: Duration = Duration::from_secs(1);
/// How often the waiting thread looks up.
const LOOK_UP: Duration = Duration::from_millis(20);
/// Stack of the working thread, as large as main threads have.
pub(crate) const STACK: usize = 8 << 20;

/// A run of a command.
pub(crate) struct Job {
    start: Instant,
    run: RunArgs,
    cancel: CancelToken,
    interrupts: Arc<AtomicUsize>,
    expected_memory: Arc<AtomicU64>,
    bars: Bars,
}

/// What a run has cost.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Cost {
    pub(crate) wall_seconds: f64,
    /// All threads together; where the system tells.
    pub(crate) cpu_seconds: Option<f64>,
    /// Where the system tells.
    pub(crate) peak_memory_bytes: Option<u64>,
    /// The estimate before the work began; none for what takes little.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) expected_memory_bytes: Option<u64>,
    pub(crate) threads: usize,
}

impl Job {
    /// Starts the clock, and listens to Ctrl-C.
    pub(crate) fn new(run: RunArgs) -> Self {
        let (cancel, interrupts) = (CancelToken::new(), Arc::new(AtomicUsize::new(0)));
        let (token, count) = (cancel.clone(), Arc::clone(&interrupts));
        // Without a handler Ctrl-C ends the process, which leaves nothing behind either.
        let _ = ctrlc::set_handler(move || {
            token.cancel();
            count.fetch_add(1, Ordering::Relaxed);
        });
        let (expected_memory, bars) = (Arc::default(), Bars::new(!run.quiet));
        Self { start: Instant::now(), run, cancel, interrupts, expected_memory, bars }
    }

    /// The context of the work.
    pub(crate) fn context(&self) -> Context {
        let (bars, expected) = (self.bars.clone(), Arc::clone(&self.expected_memory));
        let mut context = Context::new()
            .cancel_token(&self.cancel)
            .threads(self.run.threads.unwrap_or_default() as usize)
            .observer(move |progress| {
                expected.store(progress.expected_memory, Ordering::Relaxed);
                bars.show(progress);
                ControlFlow::Continue(())
            });
        if let Some(limit) = self.run.time_limit {
            context = context.time_limit(limit);
        }
        if let Some(limit) = self.run.memory_limit {
            context = context.memory_limit(limit);
        }
        context
    }

    /// Does work in a thread of its own, which is left behind if it does not stop when it should.
    pub(crate) fn supervise<T: Send + 'static>(
        &self,
        input: &str,
        work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
    ) -> Result<T, Failure> {
        let done = self.wait_for(input, work);
        self.bars.clear();
        done
    }

    fn wait_for<T: Send + 'static>(
        &self,
        input: &str,
        work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
    ) -> Result<T, Failure> {
        let input = || input.to_owned();
        let (sender, receiver) = channel();
        let spawned = thread::Builder::new().stack_size(STACK).spawn(move || {
            // The receiver is gone if the work was abandoned.
            let _ = sender.send(work());
        });
        if spawned.is_err() {
            return Err(Failure::Panicked { input: input() });
        }
        let mut noticed: Option<Instant> = None;
        loop {
            match receiver.recv_timeout(LOOK_UP) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Failure::Panicked { input: input() });
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            let limit = self.run.time_limit.filter(|&limit| self.start.elapsed() > limit);
            if limit.is_none() && !self.cancel.is_cancelled() {
                continue;
            }
            let since = noticed.get_or_insert_with(Instant::now);
            if since.elapsed() > GRACE || self.interrupts.load(Ordering::Relaxed) > 1 {
                return Err(match limit {
                    Some(limit) => Failure::TimeLimit { input: input(), limit },
                    None => Failure::Interrupted { input: input() },
                });
            }
        }
    }

    /// Fails if Ctrl-C was pressed, or the time is over.
    pub(crate) fn check_stopped(&self, input: &str) -> Result<(), Failure> {
        if self.cancel.is_cancelled() {
            return Err(Failure::Interrupted { input: input.to_owned() });
        }
        match self.run.time_limit.filter(|&limit| self.start.elapsed() > limit) {
            Some(limit) => Err(Failure::TimeLimit { input: input.to_owned(), limit }),
            None => Ok(()),
        }
    }

    /// What the run has cost so far.
    pub(crate) fn cost(&self) -> Cost {
        let all = || thread::available_parallelism().map_or(1, usize::from);
        Cost {
            wall_seconds: self.start.elapsed().as_secs_f64(),
            cpu_seconds: system::cpu_seconds(),
            peak_memory_bytes: system::peak_memory(),
            expected_memory_bytes: Some(self.expected_memory.load(Ordering::Relaxed))
                .filter(|&bytes| bytes > 0),
            threads: self.run.threads.map_or_else(all, |threads| threads as usize),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_does_not_listen_is_abandoned() {
        let run = RunArgs { time_limit: Some(Duration::from_millis(1)), ..RunArgs::default() };
        let job = Job::new(run);
        let start = Instant::now();
        let result = job.supervise("a", || {
            thread::sleep(Duration::from_secs(60));
            Ok(())
        });
        assert!(matches!(result, Err(Failure::TimeLimit { .. })), "{result:?}");
        assert!(start.elapsed() < Duration::from_secs(20));
    }

    #[test]
    fn work_that_ends_too_late_counts_for_nothing() {
        let limit = Duration::from_millis(1);
        let job = Job::new(RunArgs { time_limit: Some(limit), ..RunArgs::default() });
        thread::sleep(Duration::from_millis(5));
        assert!(matches!(job.check_stopped("a"), Err(Failure::TimeLimit { .. })));
        assert!(Job::new(RunArgs::default()).check_stopped("a").is_ok());
    }

    #[test]
    fn work_that_ends_is_returned() {
        assert!(matches!(Job::new(RunArgs::default()).supervise("a", || Ok(7)), Ok(7)));
    }

    #[test]
    fn work_that_breaks_off_is_reported() {
        let broken = || -> Result<(), Failure> { panic!("for the test") };
        let result = Job::new(RunArgs::default()).supervise("a", broken);
        assert!(matches!(result, Err(Failure::Panicked { .. })), "{result:?}");
    }
}
