//! The stage that gives every seam an integer.

use super::domain::Domain;
use super::{MapOptions, MethodError, Start};
use crate::cut::Unfolding;
use crate::layout::exact::Defects;
use crate::progress::Watch;
use crate::rounding::{Repair, Rounding, RoundingStats, repair};

/// Integer matchings for an unfolded domain. Aligned edges are dropped around sectors whose angle no triangles can
/// make.
///
/// # Errors
/// [`MethodError`].
pub(super) fn round<'m>(
    domain: Domain<'m>,
    unfolding: Unfolding,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding), MethodError> {
    let (mut domain, mut unfolding) = (domain, unfolding);
    loop {
        let defects = match start.rounding(&domain, unfolding, options, watch)? {
            Ok(rounding) => return Ok((domain, rounding)),
            Err(defects) => defects,
        };
        domain = domain.without_features_at(&defects).ok_or(MethodError::Defective(defects))?;
        unfolding = domain.unfold();
    }
}

/// With indices that the triangles can make. At aligned edges, where dropping an edge is the better way out, the
/// sectors that cannot be repaired are defects.
///
/// # Errors
/// Those sectors.
pub(super) fn repaired(domain: &Domain<'_>, rounding: Rounding) -> Result<Rounding, Defects> {
    let Rounding { mut start, stats } = rounding;
    let Repair { matched, shifts, hopeless } =
        repair(&domain.sectors, &domain.metric, start.matched);
    if domain.any_aligned() && !hopeless.is_empty() {
        let wrong_angles = hopeless.into_iter().map(|s| domain.sectors.vertex(s)).collect();
        return Err(Defects { flips: Vec::new(), wrong_angles });
    }
    start.matched = matched;
    let shifted_seams = stats.shifted_seams + shifts;
    Ok(Rounding { start, stats: RoundingStats { shifted_seams, ..stats } })
}
