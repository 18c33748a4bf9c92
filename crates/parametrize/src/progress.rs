//! Progress and cancellation of long work.

use seamstress_linalg::NotPositiveDefinite;
use std::ops::ControlFlow;
use web_time::Instant;

/// The stages of making a map, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Stage {
    /// Cutting and unfolding.
    Cut,
    /// Rounding the matchings.
    Rounding,
    /// Removing and moving cones.
    CleanUp,
    /// The exact seamless layout of low energy.
    Layout,
    /// Lowering the largest distortion.
    Polish,
    /// Minimising the objective asked for.
    Objective,
    /// Certifying.
    Certificate,
    /// Rounding to an integer map.
    Integers,
    /// Extracting quads.
    Extraction,
    /// Untangling and smoothing quads.
    Shaping,
}

impl Stage {
    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Cut => "cut",
            Stage::Rounding => "rounding",
            Stage::Layout => "layout",
            Stage::CleanUp => "clean-up",
            Stage::Polish => "polish",
            Stage::Objective => "objective",
            Stage::Certificate => "certificate",
            Stage::Integers => "integers",
            Stage::Extraction => "extraction",
            Stage::Shaping => "shaping",
        }
    }
}

/// Where the work stands.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Component of the mesh, from 0.
    pub component: usize,
    /// Number of components.
    pub n_components: usize,
    /// Stage of that component.
    pub stage: Stage,
    /// Estimated share of the stage that is done, 0 to 1.
    pub fraction: f64,
}

/// The caller asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("stopped on request")]
pub struct Cancelled;

/// Why work on linear systems was not finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

/// An error that may be the caller's request to stop.
pub(crate) trait MaybeCancelled {
    /// That request, if it is one.
    fn cancelled(&self) -> Option<Cancelled>;
}

impl MaybeCancelled for SolveError {
    fn cancelled(&self) -> Option<Cancelled> {
        match *self {
            Self::Cancelled(cancelled) => Some(cancelled),
            Self::Numeric(_) => None,
        }
    }
}

/// The result as it is unless the caller asked to stop: what else failed may be tried in another way.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn unless_cancelled<T, E: MaybeCancelled>(
    result: Result<T, E>,
) -> Result<Result<T, E>, Cancelled> {
    match result.as_ref().err().and_then(E::cancelled) {
        Some(cancelled) => Err(cancelled),
        None => Ok(result),
    }
}

/// A caller's view of running work: called in every iteration of every long loop.
pub type Observer<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// The observer of those who want to know nothing.
pub fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Reports progress of one component to an observer.
pub struct Watch<'a, 'b> {
    observer: &'a mut Observer<'b>,
    now: Progress,
}

impl<'a, 'b> Watch<'a, 'b> {
    /// A watch over one component.
    pub fn new(observer: &'a mut Observer<'b>, component: usize, n_components: usize) -> Self {
        let now = Progress { component, n_components, stage: Stage::Cut, fraction: 0.0 };
        Self { observer, now }
    }

    /// Enters a stage.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer breaks.
    pub fn enter(&mut self, stage: Stage) -> Result<(), Cancelled> {
        self.now.stage = stage;
        self.tick(0.0)
    }

    /// Reports that work goes on.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer breaks.
    pub fn pulse(&mut self) -> Result<(), Cancelled> {
        self.tick(self.now.fraction)
    }

    /// Runs work that is to stop at a deadline, if there is one; `None` when the deadline cut it short.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer breaks.
    pub fn limited<T>(
        &mut self,
        deadline: Option<Instant>,
        work: impl FnOnce(&mut Watch<'_, '_>) -> Result<T, Cancelled>,
    ) -> Result<Option<T>, Cancelled> {
        let Some(deadline) = deadline else {
            return work(self).map(Some);
        };
        let (mut expired, observer, now) = (false, &mut *self.observer, self.now);
        let mut guarded = |progress| {
            expired = Instant::now() >= deadline;
            if expired { ControlFlow::Break(()) } else { observer(progress) }
        };
        let outcome = work(&mut Watch { observer: &mut guarded, now });
        match outcome {
            Err(Cancelled) if expired => Ok(None),
            outcome => outcome.map(Some),
        }
    }

    /// Reports the share of the stage that is done.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer breaks.
    pub fn tick(&mut self, fraction: f64) -> Result<(), Cancelled> {
        self.now.fraction = fraction.clamp(0.0, 1.0);
        match (self.observer)(self.now) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Cancelled),
        }
    }
}
