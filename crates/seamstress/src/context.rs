//! How work is run: progress, cancellation, limits of time and memory, threads.

use crate::error::{Error, ErrorKind, Stage};
use crate::forecast::Expected;
use crate::memory::Memory;
use seamstress_parallel::with_threads;
use seamstress_parametrize::progress::Progress as Step;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use web_time::Instant;

/// Where the work stands.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// What is being done.
    pub stage: Stage,
    /// Component of the surface it is done to, from 0.
    pub component: usize,
    /// Number of components.
    pub n_components: usize,
    /// Estimated share of the stage that is done, 0 to 1.
    pub fraction: f64,
    /// Memory that the whole work is expected to take at most, bytes: an estimate from numbers of triangles and cells.
    pub expected_memory: u64,
    /// Time that the whole work is expected to take on one thread with default options: a rough estimate, as measured on
    /// one machine.
    pub expected_time: Duration,
}

/// A switch that stops work from another thread. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A switch that is not set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Stops the work of every context that has this token, within an iteration.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the switch is set.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

type Observer = dyn Fn(Progress) -> ControlFlow<()> + Send + Sync;

/// How work is run; attached to a surface once, with [`Surface::with_context`](crate::Surface::with_context).
///
/// No result depends on it, unless it stops the work.
#[derive(Clone, Default)]
pub struct Context {
    observer: Option<Arc<Observer>>,
    cancel: CancelToken,
    deadline: Option<(Instant, Duration)>,
    memory_limit: Option<u64>,
    threads: Option<usize>,
}

impl Context {
    /// No observer, no limit, all cores.
    pub fn new() -> Self {
        Self::default()
    }

    /// Calls `observer` in every iteration of every long loop, from the thread that does the work; it may break to
    /// stop.
    pub fn observer(
        mut self,
        observer: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static,
    ) -> Self {
        self.observer = Some(Arc::new(observer));
        self
    }

    /// Stops when the token is cancelled.
    pub fn cancel_token(mut self, token: &CancelToken) -> Self {
        self.cancel = token.clone();
        self
    }

    /// Stops this long after now.
    pub fn time_limit(mut self, limit: Duration) -> Self {
        self.deadline = Instant::now().checked_add(limit).map(|deadline| (deadline, limit));
        self
    }

    /// Refuses work that is expected to take more than so many bytes of memory, before it starts
    /// ([`ErrorKind::MemoryLimit`]).
    pub fn memory_limit(mut self, bytes: u64) -> Self {
        self.memory_limit = Some(bytes);
        self
    }

    /// Uses this many threads; 0 stands for all cores.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = (threads > 0).then_some(threads);
        self
    }

    /// Does work that is expected to take so much, on the threads of this context and under its watch.
    pub(crate) fn run<T: Send>(
        &self,
        expected: Expected,
        work: impl FnOnce(&mut Watcher) -> Result<T, Error> + Send,
    ) -> Result<T, Error> {
        if let Some(limit) = self.memory_limit.map(Memory).filter(|&limit| expected.memory > limit)
        {
            return Err(Error::too_large(expected.memory, limit));
        }
        let mut watcher = Watcher { context: self.clone(), expected, stage: None, stop: None };
        self.on_threads(move || {
            let made = work(&mut watcher);
            made.map_err(|error| watcher.explain(error))
        })
    }

    fn on_threads<T: Send>(
        &self,
        work: impl FnOnce() -> Result<T, Error> + Send,
    ) -> Result<T, Error> {
        let Some(threads) = self.threads else { return work() };
        with_threads(threads, work)
            .map_err(|cause| Error::new(ErrorKind::Options, cause.to_string()))?
    }
}

impl fmt::Debug for Context {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Context")
            .field("observer", &self.observer.is_some())
            .field("cancel", &self.cancel)
            .field("deadline", &self.deadline)
            .field("memory_limit", &self.memory_limit)
            .field("threads", &self.threads)
            .finish()
    }
}

/// Watches over one piece of work: passes progress on, and knows where and why it was stopped.
pub(crate) struct Watcher {
    context: Context,
    expected: Expected,
    stage: Option<Stage>,
    stop: Option<Stop>,
}

#[derive(Debug, Clone, Copy)]
enum Stop {
    Cancelled,
    TimeLimit(Duration),
}

impl Watcher {
    /// The observer of the crates below.
    pub(crate) fn observe(&mut self, step: Step) -> ControlFlow<()> {
        self.see(Progress {
            stage: step.stage.into(),
            component: step.component,
            n_components: step.n_components,
            fraction: step.fraction,
            expected_memory: self.expected.memory.0,
            expected_time: self.expected.time,
        })
    }

    /// Enters a stage that has no progress of its own.
    pub(crate) fn enter(&mut self, stage: Stage) -> Result<(), Error> {
        let progress = Progress {
            stage,
            component: 0,
            n_components: 1,
            fraction: 0.0,
            expected_memory: self.expected.memory.0,
            expected_time: self.expected.time,
        };
        match self.see(progress) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Error::cancelled()),
        }
    }

    fn see(&mut self, progress: Progress) -> ControlFlow<()> {
        self.stage = Some(progress.stage);
        let context = &self.context;
        let passed = context.deadline.filter(|(deadline, _)| Instant::now() >= *deadline);
        self.stop = match passed {
            _ if context.cancel.is_cancelled() => Some(Stop::Cancelled),
            Some((_, limit)) => Some(Stop::TimeLimit(limit)),
            None => {
                let go_on = context.observer.as_ref().map(|observer| observer(progress));
                go_on.filter(ControlFlow::is_break).map(|_| Stop::Cancelled)
            }
        };
        if self.stop.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// An error with its stage; one that comes of stopping says why.
    fn explain(&self, error: Error) -> Error {
        let error = error.at_stage(self.stage);
        match self.stop.filter(|_| error.kind() == ErrorKind::Cancelled) {
            Some(Stop::TimeLimit(limit)) => error.timed_out(limit),
            _ => error,
        }
    }
}
