//! Running work beside Python: threads of its own, progress, limits, Ctrl-C.

use crate::errors;
use pyo3::prelude::*;
use seamstress::{CancelToken, Context, Error};
use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How often the waiting thread looks at signals and progress.
const LOOK_UP: Duration = Duration::from_millis(20);
/// How often the function that is told of progress is called without news, since it may ask to stop.
const REMINDER: Duration = Duration::from_millis(200);
/// How long work may take to notice that it should stop, before it is left to end on its own.
const GRACE: Duration = Duration::from_millis(500);
/// Stack of each thread, as large as main threads have.
const STACK: usize = 8 << 20;
/// The longest time limit: a year.
const LONGEST: f64 = 365.0 * 24.0 * 60.0 * 60.0;

/// How a call is run: threads, seconds, bytes, and a function of stage and share that is told of progress.
#[derive(FromPyObject)]
pub(crate) struct Run(Option<usize>, Option<f64>, Option<u64>, Option<Py<PyAny>>);

impl Run {
    /// Does work on a thread pool that ends with it: one that stays would hang in forks of this process.
    ///
    /// The work never touches Python. The calling thread waits, without the interpreter's lock, and looks up for signals
    /// and progress.
    pub(crate) fn call<T: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce(Context) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let Self(threads, seconds, bytes, progress) = self;
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or_else(cores))
            .stack_size(STACK)
            // The receiver learns of it by a sender that is gone.
            .panic_handler(|_| ())
            .build()
            .map_err(|cause| errors::internal(py, &cause.to_string()))?;
        let limit = seconds.filter(|s| *s < LONGEST).map(|s| Duration::from_secs_f64(s.max(0.0)));
        let waiting = Waiting {
            cancel: CancelToken::new(),
            latest: Arc::default(),
            told: ("start", 0.0),
            told_at: Instant::now(),
            deadline: limit.map(|limit| Instant::now() + limit),
            progress,
            noticed: None,
            cause: None,
        };
        let context = waiting.context(limit);
        let context = bytes.into_iter().fold(context, Context::memory_limit);
        let (sender, receiver) = channel();
        pool.spawn(move || {
            // The receiver is gone if the work was left behind.
            let _ = sender.send(work(context));
        });
        waiting.wait(py, receiver)
    }
}

/// A stage, and the share of it that is done.
type News = (&'static str, f64);

/// A thread of Python that waits for work.
struct Waiting {
    cancel: CancelToken,
    latest: Arc<Mutex<Option<News>>>,
    /// What the function was told last, and when.
    told: News,
    told_at: Instant,
    deadline: Option<Instant>,
    progress: Option<Py<PyAny>>,
    /// When it was noticed that the work should stop.
    noticed: Option<Instant>,
    /// What Python raised meanwhile.
    cause: Option<PyErr>,
}

impl Waiting {
    fn context(&self, limit: Option<Duration>) -> Context {
        let latest = Arc::clone(&self.latest);
        let context = Context::new().cancel_token(&self.cancel).observer(move |progress| {
            *latest.lock().unwrap_or_else(PoisonError::into_inner) =
                Some((progress.stage.name(), progress.fraction));
            ControlFlow::Continue(())
        });
        match limit {
            Some(limit) => context.time_limit(limit),
            None => context,
        }
    }

    fn wait<T: Send>(
        mut self,
        py: Python<'_>,
        mut receiver: Receiver<Result<T, Error>>,
    ) -> PyResult<T> {
        loop {
            let waiting = &mut receiver;
            let received = py.detach(move || waiting.recv_timeout(LOOK_UP));
            self.look_up(py);
            match received {
                Err(RecvTimeoutError::Timeout) if !self.is_overdue() => {}
                Err(RecvTimeoutError::Timeout) => return Err(self.left_behind(py)),
                Ok(Ok(done)) => return self.cause.map_or(Ok(done), Err),
                Ok(Err(error)) => {
                    return Err(self.cause.unwrap_or_else(|| errors::exception(py, &error)));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let error = errors::internal(py, "internal error: the computation broke off");
                    return Err(self.cause.unwrap_or(error));
                }
            }
        }
    }

    /// Whether the work should have stopped some time ago.
    fn is_overdue(&self) -> bool {
        self.noticed.is_some_and(|noticed| noticed.elapsed() > GRACE)
    }

    /// Why work was left behind.
    fn left_behind(self, py: Python<'_>) -> PyErr {
        let (code, message) = match self.is_late() {
            true => ("time-limit", "stopped: the time limit has passed"),
            false => ("cancelled", "stopped on request"),
        };
        self.cause.unwrap_or_else(|| errors::stopped(py, code, message))
    }

    fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Lets Python handle signals, reports progress, and stops the work if either says so.
    fn look_up(&mut self, py: Python<'_>) {
        if self.noticed.is_some() {
            return;
        }
        let goes_on = py.check_signals().and_then(|()| self.report(py));
        let goes_on = goes_on.unwrap_or_else(|cause| {
            self.cause = Some(cause);
            false
        });
        if !goes_on {
            self.cancel.cancel();
        }
        // When time is over the work stops by its own clock.
        if !goes_on || self.is_late() {
            self.noticed = Some(Instant::now());
        }
    }

    /// Calls the function that is told of progress; `False` asks to stop.
    fn report(&mut self, py: Python<'_>) -> PyResult<bool> {
        let Some(progress) = &self.progress else { return Ok(true) };
        let news = self.latest.lock().unwrap_or_else(PoisonError::into_inner).take();
        if news.is_none() && self.told_at.elapsed() < REMINDER {
            return Ok(true);
        }
        (self.told, self.told_at) = (news.unwrap_or(self.told), Instant::now());
        let answer = progress.call1(py, self.told)?;
        // Nothing returned is no wish.
        Ok(answer.is_none(py) || answer.is_truthy(py)?)
    }
}
