//! Stopping long work: the time limit and Ctrl-C.

use crate::outcome::StopReason;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How long work may take to notice that it should stop, before it is abandoned.
const GRACE: Duration = Duration::from_secs(1);
/// How often the waiting thread looks up.
const LOOK_UP: Duration = Duration::from_millis(20);
/// Stack of the working thread, as large as main threads have.
const STACK: usize = 8 << 20;

/// Whether to go on, shared by all threads.
#[derive(Debug, Clone)]
pub(crate) struct Stop {
    start: Instant,
    limit: Option<Duration>,
    limit_lifted: Arc<AtomicBool>,
    interrupts: Arc<AtomicUsize>,
}

impl Stop {
    /// Starts the clock, and listens to Ctrl-C.
    pub(crate) fn new(limit: Option<Duration>) -> Self {
        let interrupts = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&interrupts);
        // Without a handler Ctrl-C ends the process, which leaves nothing behind either.
        let _ = ctrlc::set_handler(move || {
            count.fetch_add(1, Ordering::Relaxed);
        });
        Self { start: Instant::now(), limit, limit_lifted: Arc::default(), interrupts }
    }

    /// Time since the start.
    pub(crate) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Ends the time limit: what it limits is done.
    pub(crate) fn lift_limit(&self) {
        self.limit_lifted.store(true, Ordering::Relaxed);
    }

    /// Why to stop, if so.
    pub(crate) fn reason(&self) -> Option<StopReason> {
        if self.interrupts() > 0 {
            return Some(StopReason::Interrupt);
        }
        let limit = self.limit.filter(|&limit| self.elapsed() > limit)?;
        let lifted = self.limit_lifted.load(Ordering::Relaxed);
        (!lifted).then_some(StopReason::TimeLimit(limit))
    }

    fn interrupts(&self) -> usize {
        self.interrupts.load(Ordering::Relaxed)
    }
}

/// Why [`supervise`] has no result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Abandoned {
    /// The work did not stop in time, or was interrupted twice.
    Stopped(StopReason),
    /// The work panicked.
    Panicked,
}

/// Runs work in a thread of its own and waits for it; when it should stop and does not, leaves it
/// to the end of the process.
pub(crate) fn supervise<T: Send + 'static>(
    stop: &Stop,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Abandoned> {
    let (sender, receiver) = channel();
    let thread = std::thread::Builder::new().stack_size(STACK);
    let spawned = thread.spawn(move || {
        // The receiver is gone if the work was abandoned.
        let _ = sender.send(work());
    });
    if spawned.is_err() {
        return Err(Abandoned::Panicked);
    }
    let mut noticed: Option<Instant> = None;
    loop {
        match receiver.recv_timeout(LOOK_UP) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Disconnected) => return Err(Abandoned::Panicked),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let Some(reason) = stop.reason() else {
            continue;
        };
        let since = noticed.get_or_insert_with(Instant::now);
        if since.elapsed() > GRACE || stop.interrupts() > 1 {
            return Err(Abandoned::Stopped(reason));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_does_not_listen_is_abandoned() {
        let stop = Stop::new(Some(Duration::from_millis(1)));
        let start = Instant::now();
        let result = supervise(&stop, || std::thread::sleep(Duration::from_secs(60)));
        let limit = StopReason::TimeLimit(Duration::from_millis(1));
        assert_eq!(result, Err(Abandoned::Stopped(limit)));
        assert!(start.elapsed() < Duration::from_secs(20));
    }

    #[test]
    fn a_lifted_limit_stops_nothing() {
        let stop = Stop::new(Some(Duration::ZERO));
        assert!(stop.reason().is_some());
        stop.lift_limit();
        assert_eq!(stop.reason(), None);
        assert_eq!(supervise(&stop, || 7), Ok(7));
    }
}
