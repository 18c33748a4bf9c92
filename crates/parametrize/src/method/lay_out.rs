//! The stage that closes the seams.

use super::domain::Domain;
use super::round::round;
use super::start::repaired;
use super::{MapOptions, MethodError, Start};
use crate::layout::ladder::{self, LayoutEffort, SeamlessLayout};
use crate::progress::Watch;
use crate::rounding::Rounding;

/// The layout of rounded matchings. Where there is none, aligned edges near the defects are dropped; the matchings of
/// the others stay.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out<'m>(
    domain: Domain<'m>,
    rounding: Rounding,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding, SeamlessLayout), MethodError> {
    let (mut domain, mut rounding) = (domain, rounding);
    loop {
        let (sectors, metric) = (&domain.sectors, &domain.metric);
        let effort = LayoutEffort::Thorough;
        let defects = match ladder::lay_out(sectors, metric, &rounding.start, effort, watch)? {
            Ok(layout) => return Ok((domain, rounding, layout)),
            Err(defects) => defects,
        };
        let Some(fewer) = domain.without_features_at(&defects) else {
            return Err(MethodError::Defective(defects));
        };
        let kept =
            rounding.start.with_fewer_aligned(&domain.sectors, &fewer.sectors, &fewer.metric);
        let kept = Rounding { start: kept, stats: rounding.stats };
        (domain, rounding) = match repaired(&fewer, kept) {
            Ok(kept) => (fewer, kept),
            Err(_) => {
                let unfolding = fewer.unfold();
                round(fewer, unfolding, start, options, watch)?
            }
        };
    }
}
