//! Choosing an integer matching for every seam.

mod clean_up;
mod holonomy;
mod lattice;
mod options;
mod patch;
mod progressive;
mod reach;
mod relaxation;
mod repair;
mod surrogate;
mod system;
mod weights;

pub use clean_up::{CleanUpOptions, CleanUpStats, ConeCount, clean_up};
pub use holonomy::Holonomy;
pub use options::{RoundingOptions, RoundingStrategy};
pub use repair::{Repair, repair};
pub use surrogate::Surrogate;

use crate::cut::{FramedCut, Unfolding};
use crate::features::Sectors;
use crate::field::Guide;
use crate::mixed_integer::{MixedIntegerStats, round_mixed_integer};
use crate::progress::{SolveError, Watch};
use progressive::round_progressively;
use seamstress_mesh::Metric;

/// Integer matchings and how they were found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Rounding {
    /// The matchings, and the rotations of the faces in the last layout.
    pub start: FramedCut,
    /// What it took.
    pub stats: RoundingStats,
}

/// What the rounding did.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct RoundingStats {
    /// Rounds run.
    pub rounds: usize,
    /// Layouts computed.
    pub layouts: usize,
    /// Seams shifted afterwards to make indices possible or matchings consistent.
    pub shifted_seams: usize,
    /// The batches of [`RoundingStrategy::MixedInteger`].
    pub mixed_integer: Option<MixedIntegerStats>,
}

impl Rounding {
    /// Matchings that took no rounding.
    pub(crate) fn given(start: FramedCut) -> Self {
        Self { start, stats: RoundingStats::default() }
    }
}

/// Rounds the rotations of all turning edges of an unfolding.
///
/// Mixed integers are for nothing aligned: with aligned edges [`RoundingStrategy::MixedInteger`] is
/// [`RoundingStrategy::ConeBias`].
///
/// # Errors
/// [`SolveError`].
pub fn round(
    sectors: &Sectors<'_>,
    metric: &Metric,
    unfolding: Unfolding,
    guide: Option<&Guide>,
    options: &RoundingOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, SolveError> {
    let is_mixed_integer = options.strategy == RoundingStrategy::MixedInteger;
    if is_mixed_integer && !sectors.any_aligned() {
        let (mesh, settings) = (sectors.mesh(), &options.mixed_integer);
        let (start, stats) = round_mixed_integer(mesh, metric, unfolding, settings, watch)?;
        let (rounds, layouts) = (stats.batches.len(), stats.nodes());
        let mixed_integer = Some(stats);
        let stats = RoundingStats { rounds, layouts, shifted_seams: 0, mixed_integer };
        return Ok(Rounding { start, stats });
    }
    round_progressively(sectors, metric, unfolding, guide, options, watch)
}
