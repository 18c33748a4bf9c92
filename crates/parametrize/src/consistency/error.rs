//! Why there are no consistent matchings.

use crate::progress::Cancelled;
use seamstress_linalg::NotPositiveDefinite;

/// Why there are no consistent matchings.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConsistencyError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Not one angle per corner, or not one index per vertex.
    #[error("{found} {what} for {expected}")]
    Count {
        /// What was counted.
        what: &'static str,
        /// Number needed.
        expected: usize,
        /// Number given.
        found: usize,
    },
    /// A number given is not finite.
    #[error("the {what} {element} is not finite")]
    NonFinite {
        /// What was given.
        what: &'static str,
        /// What it belongs to: a corner, vertex or half-edge, by number.
        element: u32,
    },
    /// A seam is given by a half-edge that has no twin, or twice.
    #[error("half-edge {halfedge} is no seam: it is on the boundary, or its edge is listed before")]
    NoSeam {
        /// The half-edge.
        halfedge: u32,
    },
    /// The indices of a closed component do not sum to 4 chi, and matchings cannot change the sum.
    #[error("component {component}: the indices sum to {sum} quarters, not to {expected}")]
    IndexSum {
        /// The component, in order of first faces.
        component: usize,
        /// Their sum.
        sum: f64,
        /// Four times the Euler characteristic.
        expected: i64,
    },
    /// No positive angles were found for any indices tried; these vertices were still off.
    #[error("no positive angles were found; {} vertices are off, the first is {}", vertices.len(), vertices.first().copied().unwrap_or_default())]
    Infeasible {
        /// Vertices whose angles are off in the last trial.
        vertices: Vec<u32>,
    },
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}
