//! What is told of the way to an integer map, and why there is none.

use super::gauss::Overflow;
use super::rounding::HOPELESS;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_parametrize::map::Violations;
use seamstress_parametrize::progress::Cancelled;

/// Why a component has no integer map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IntegerFailure {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The relations of the seams do not fit into 64-bit integers.
    #[error(transparent)]
    Overflow(#[from] Overflow),
    /// A linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
    /// The given map flips when its seams are closed exactly.
    #[error("the map has triangles too thin to close its seams exactly")]
    Unreadable,
    /// Straight connections of cones, or ways between isolines, would vanish, or triangles turn over.
    #[error(
        "{violated} straight lines between cones or isolines would vanish or turn around, or triangles turn over"
    )]
    Conflict {
        /// How many.
        violated: usize,
    },
    /// Triangles would collapse on the way to the integers.
    #[error("the way to the integers is blocked at {reached:.2} of it, where triangles collapse")]
    Blocked {
        /// Share of the way that could be gone.
        reached: f64,
    },
    /// The result fails its certificate.
    #[error(transparent)]
    Uncertified(#[from] Violations),
}

impl IntegerFailure {
    /// Whether a finer grid may help.
    pub(super) fn asks_for_finer_grid(&self) -> bool {
        matches!(self, Self::Conflict { .. } | Self::Blocked { .. } | Self::Uncertified(_))
    }

    /// Whether grids nearby will hardly do either.
    pub(super) fn is_hopeless(&self) -> bool {
        matches!(self, Self::Conflict { violated } if *violated > HOPELESS)
    }
}

/// How the integer map of one component was made.
#[derive(Debug, Clone, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerStats {
    /// Faces.
    pub faces: usize,
    /// Real integer unknowns.
    pub integers: usize,
    /// Straight connections of cones, ways to isolines and sides of faces that were constrained.
    pub constraints: usize,
    /// Walls that the way ran into and that were rounded around, on the last grid.
    pub walls: usize,
    /// Times the rounding started over with other priorities.
    pub restarts: usize,
    /// Moves that carried the layout to the integers.
    pub moves: usize,
    /// Newton iterations after that.
    pub polish: usize,
    /// Other grids tried whose number of quads is within 3 % of that of the first; from 7 on, two edges of quads may
    /// join the same two points.
    pub nudges: usize,
    /// Times the grid was made finer, each by 1.1 in the number of quads.
    pub refinements: usize,
    /// Why the first grid would not do, if so.
    pub refined_because: Option<String>,
    /// Area in the plane, grid units.
    pub quads: f64,
    /// Seconds for reading the map and reducing the energy to the integers.
    pub seconds_reduction: f64,
    /// Seconds for rounding, over all grids tried.
    pub seconds_rounding: f64,
    /// Seconds for the way to the integers, over all grids tried.
    pub seconds_moving: f64,
    /// Seconds for the polish.
    pub seconds_polish: f64,
}
