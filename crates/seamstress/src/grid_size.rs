//! Sizes of grids.

use crate::error::Error;
use seamstress_quantize as quantize;
use serde::{Deserialize, Serialize};

/// How fine a grid is to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum GridSize {
    /// About so many quads in all.
    Quads(f64),
    /// Mean edge length of the quads, mesh units.
    EdgeLength(f64),
    /// Grid units per mesh unit.
    Scale(f64),
}

impl Default for GridSize {
    fn default() -> Self {
        Self::Quads(5000.0)
    }
}

/// The most quads of a mesh: each takes about a kilobyte while it is made.
const MOST_QUADS: f64 = 1e8;

impl GridSize {
    pub(crate) fn validate(self) -> Result<(), Error> {
        let (name, value) = self.name();
        match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(Error::options(format!("{name}: {value} is no number larger than 0"))),
        }
    }

    /// About how many cells there are on a surface with the area of a square of this side.
    pub(crate) fn cells(self, side: f64) -> f64 {
        match self {
            Self::Quads(x) => x,
            Self::EdgeLength(x) => (side / x).powi(2),
            Self::Scale(x) => (side * x).powi(2),
        }
    }

    fn name(self) -> (&'static str, f64) {
        match self {
            Self::Quads(x) => ("quads", x),
            Self::EdgeLength(x) => ("edge_length", x),
            Self::Scale(x) => ("scale", x),
        }
    }

    /// Refuses a grid of more quads than fit into any memory, on a surface with the area of a square of this side.
    pub(crate) fn check_count(self, side: f64) -> Result<(), Error> {
        let ((name, value), count) = (self.name(), self.cells(side));
        match count <= MOST_QUADS {
            true => Ok(()),
            false => Err(Error::options(format!(
                "{name}: {value} asks for about {count:.1e} quads, more than fit into memory; \
                 at most {MOST_QUADS:.0e} are made"
            ))),
        }
    }

    /// The same cells on a share of the surface.
    pub(crate) fn of_share(self, share: f64) -> Self {
        match self {
            Self::Quads(x) => Self::Quads(x * share),
            other => other,
        }
    }

    pub(crate) fn to_quantize(self) -> quantize::GridSize {
        match self {
            Self::Quads(x) => quantize::GridSize::Quads(x),
            Self::EdgeLength(x) => quantize::GridSize::EdgeLength(x),
            Self::Scale(x) => quantize::GridSize::Scale(x),
        }
    }
}
