//! How a minimisation ended, and what came of it.

use super::Objective;
use crate::layout::conic::{ConicError, Outcome, Solver};
use crate::progress::Cancelled;
use seamstress_linalg::NotPositiveDefinite;

/// How a minimiser ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "kind")]
#[non_exhaustive]
pub enum Ending {
    /// The objective settled to the tolerance, as far as can be estimated from how it fell.
    Converged,
    /// The iterations ran out, or no step lowered the objective further.
    Stopped,
    /// The minimiser over all layouts has flips or wrong angles; this is a layout without, near the edge of
    /// what is allowed.
    Guarded {
        /// Flipped triangles of the layout that was given up.
        flips: usize,
    },
    /// Nothing better than the start was found; it is returned.
    NoGain,
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Converged => f.write_str("converged"),
            Self::Stopped => f.write_str("stopped before it settled"),
            Self::Guarded { flips: 0 } => f.write_str("held at the edge of the flip-free region"),
            Self::Guarded { flips } => write!(
                f,
                "held at the edge of the flip-free region: the minimiser would flip {flips} triangles"
            ),
            Self::NoGain => f.write_str("no gain: the start is returned"),
        }
    }
}

/// A layout that minimises an objective. It has no flips and the right angles if its start had.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Optimized {
    /// The unknowns, at the global scale of the objective's measure.
    pub y: Vec<f64>,
    /// The objective's figure: of its measure, or the mean squared distance to the frames.
    pub value: f64,
    /// The same figure before.
    pub before: f64,
    /// Iterations of the outer loop, those of abandoned attempts included.
    pub iterations: usize,
    /// How it ended.
    pub ending: Ending,
    /// How the conic programs were solved, if there were any.
    pub conic: Option<ConicStats>,
    /// The largest dilatation, where it was bounded; the figure is then the mean symmetric Dirichlet energy.
    pub dilatation: Option<f64>,
}

/// How the conic programs of a layout were solved.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConicStats {
    /// Programs solved.
    pub programs: usize,
    /// The estimated fall of the measure still to come with further rounds, as a part of it.
    pub remaining: Option<f64>,
    /// The solver of the last program.
    pub solver: Solver,
    /// How the own solver failed, if Clarabel had to take over.
    pub fallback_from: Option<Outcome>,
    /// For eq. (8) and (11): whether the bound reached, below 1, proves by itself that there is no flip.
    pub injective_by_bound: Option<bool>,
}

/// Why there is no optimised layout.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OptimizeError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A linear system could not be set up or factored.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
    /// The conic programs could not be set up.
    #[error(transparent)]
    Conic(ConicError),
    /// A bound on the dilatation is below 1 or not finite.
    #[error("the dilatation is 1 at least and cannot be bounded by {bound}")]
    BadBound {
        /// The bound.
        bound: f64,
    },
    /// A bound on the dilatation came with an objective that does not lower it.
    #[error("the dilatation can be bounded only where it is the objective, not with {objective}")]
    BoundOfOther {
        /// The objective.
        objective: Objective,
    },
    /// No layout that keeps the bound was found.
    #[error(
        "no layout with a dilatation of at most {bound} was found; the smallest one found has {smallest}"
    )]
    Infeasible {
        /// The bound.
        bound: f64,
        /// The smallest dilatation found.
        smallest: f64,
    },
}

impl From<ConicError> for OptimizeError {
    fn from(error: ConicError) -> Self {
        match error {
            ConicError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Conic(error),
        }
    }
}
