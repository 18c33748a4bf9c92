//! A second try for a rounding that has no layout: with consistent matchings.

use super::MethodError;
use super::domain::Domain;
use crate::consistency::{ConsistencyOptions, consistent_cut};
use crate::cut::{FramedCut, frames_of_angles};
use crate::features::QUARTERS_PER_CORNER;
use crate::progress::Watch;
use crate::rounding::{Rounding, RoundingStats};

/// The matchings nearest to those of a rounding that are consistent with the angles of the surface (Levi 2021,
/// suppl. sec. 9), with nothing aligned.
///
/// # Errors
/// [`MethodError`].
pub(super) fn consistent_rounding(
    domain: &Domain<'_>,
    rounding: &Rounding,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, MethodError> {
    let (mesh, metric) = (domain.mesh(), &domain.metric);
    let options =
        ConsistencyOptions { quarters_per_corner: QUARTERS_PER_CORNER, ..Default::default() };
    let matched = &rounding.start.matched;
    let (matched, consistent) =
        consistent_cut(mesh, metric, matched, &metric.angle, &options, watch)?;
    let frames = frames_of_angles(mesh, metric, &consistent.angles, &matched.unfolding.tree);
    let shifted_seams = rounding.stats.shifted_seams + consistent.stats.changed_matchings;
    let stats = RoundingStats { shifted_seams, ..rounding.stats.clone() };
    Ok(Rounding { start: FramedCut { matched, frames }, stats })
}
