//! Work that pages have asked for.

use crate::job::STACK;
use seamstress::{CancelToken, Context, Done, Progress, Task, refusal};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Jobs that may run at once.
const MOST_RUNNING: usize = 4;
/// Results that are kept.
const MOST_KEPT: usize = 6;
/// A running job that nobody has asked for this long is stopped: its page is closed.
pub(super) const FORGOTTEN: Duration = Duration::from_secs(20);
/// How long a page that asks how far a job is waits for the answer, unless the job ends. It asks again at once: timers of
/// pages that nobody sees may stand still for a minute.
const ANSWER_AFTER: Duration = Duration::from_millis(200);

/// A piece of work.
#[derive(Debug)]
pub(super) struct Job {
    cancel: CancelToken,
    progress: Mutex<Option<Progress>>,
    /// The result, or the refusal as JSON.
    outcome: Mutex<Option<Result<Done, String>>>,
    ended: Condvar,
    seen: Mutex<Instant>,
}

/// All of them, by number.
#[derive(Debug, Default)]
pub(super) struct Jobs {
    jobs: Mutex<(u64, BTreeMap<u64, Arc<Job>>)>,
}

/// A lock whose holder has panicked is as good as any: what it guards is whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Job {
    fn is_running(&self) -> bool {
        lock(&self.outcome).is_none()
    }

    /// How far it is, a little later.
    pub(super) fn state(&self) -> Value {
        *lock(&self.seen) = Instant::now();
        let outcome = self
            .ended
            .wait_timeout_while(lock(&self.outcome), ANSWER_AFTER, |outcome| outcome.is_none());
        let (outcome, _) = outcome.unwrap_or_else(PoisonError::into_inner);
        let progress = lock(&self.progress).map(|progress| {
            json!({
                "stage": progress.stage.name(),
                "component": progress.component,
                "n_components": progress.n_components,
                "fraction": progress.fraction,
                "expected_memory": progress.expected_memory,
                "expected_seconds": progress.expected_time.as_secs_f64(),
            })
        });
        let (state, error) = match &*outcome {
            None => ("running", None),
            Some(Ok(_)) => ("done", None),
            Some(Err(refusal)) => ("failed", serde_json::from_str(refusal).ok()),
        };
        json!({ "state": state, "progress": progress, "error": error.unwrap_or(Value::Null) })
    }

    /// Something of the result, if there is one.
    pub(super) fn with_result<T>(&self, of: impl FnOnce(&Done) -> T) -> Option<T> {
        lock(&self.outcome).as_ref()?.as_ref().ok().map(of)
    }

    fn work(&self, task: &Task, content: &[u8], name: &str, context: Context) {
        let broken = |_| {
            let message = "internal error: the computation broke off";
            Err(json!({ "message": message, "hint": "please report this with the mesh" })
                .to_string())
        };
        let done = catch_unwind(AssertUnwindSafe(|| {
            task.run(content, name, context).map_err(|error| refusal(&error))
        }));
        *lock(&self.outcome) = Some(done.unwrap_or_else(broken));
        self.ended.notify_all();
    }
}

impl Jobs {
    /// Starts a job; none if there are too many.
    pub(super) fn start(&self, task: Task, content: Vec<u8>, name: String) -> Option<u64> {
        let mut jobs = lock(&self.jobs);
        let (next, known) = &mut *jobs;
        let is_running = |job: &&Arc<Job>| job.is_running();
        if known.values().filter(is_running).count() >= MOST_RUNNING {
            return None;
        }
        while known.len() >= MOST_KEPT {
            let oldest =
                known.iter().find(|(_, job)| !job.is_running()).map(|(&number, _)| number)?;
            known.remove(&oldest);
        }
        let job = Arc::new(Job {
            cancel: CancelToken::new(),
            progress: Mutex::new(None),
            outcome: Mutex::new(None),
            ended: Condvar::new(),
            seen: Mutex::new(Instant::now()),
        });
        let (watched, worker) = (Arc::clone(&job), Arc::clone(&job));
        let context = Context::new().cancel_token(&job.cancel).observer(move |progress| {
            *lock(&watched.progress) = Some(progress);
            ControlFlow::Continue(())
        });
        let work = move || worker.work(&task, &content, &name, context);
        thread::Builder::new().stack_size(STACK).spawn(work).ok()?;
        *next += 1;
        known.insert(*next, job);
        Some(*next)
    }

    pub(super) fn get(&self, number: u64) -> Option<Arc<Job>> {
        lock(&self.jobs).1.get(&number).cloned()
    }

    /// Stops a job, and forgets it.
    pub(super) fn stop(&self, number: u64) {
        if let Some(job) = lock(&self.jobs).1.remove(&number) {
            job.cancel.cancel();
        }
    }

    /// Stops those that nobody has asked for so long; says whether any are left.
    pub(super) fn stop_forgotten(&self, long: Duration) -> bool {
        let mut jobs = lock(&self.jobs);
        jobs.1.retain(|_, job| {
            let is_forgotten = job.is_running() && lock(&job.seen).elapsed() > long;
            if is_forgotten {
                job.cancel.cancel();
            }
            !is_forgotten
        });
        jobs.1.values().any(|job| job.is_running())
    }
}

impl Drop for Jobs {
    fn drop(&mut self) {
        lock(&self.jobs).1.values().for_each(|job| job.cancel.cancel());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit::icosphere;

    #[test]
    fn a_job_that_nobody_asks_for_is_stopped() {
        let ball = icosphere(6);
        let vertices = ball.positions.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let faces = ball.faces.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        let file: String = vertices.chain(faces).collect();
        let jobs = Jobs::default();
        let task = Task::parse(r#"{"make": {"map": {}}}"#).unwrap();
        let number = jobs.start(task, file.into_bytes(), "ball.obj".into()).unwrap();
        let job = jobs.get(number).unwrap();
        assert!(jobs.stop_forgotten(FORGOTTEN), "it is at work");
        assert!(!jobs.stop_forgotten(Duration::ZERO));
        assert!(jobs.get(number).is_none());
        let deadline = Instant::now() + Duration::from_secs(60);
        let state = loop {
            let state = job.state();
            if state["state"] != "running" {
                break state;
            }
            assert!(Instant::now() < deadline, "it goes on");
        };
        assert_eq!(state["error"]["code"], "cancelled", "{state}");
    }
}
