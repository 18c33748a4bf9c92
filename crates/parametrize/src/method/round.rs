//! The stage that gives every seam an integer.

use super::domain::Domain;
use super::{MapOptions, MethodError, Start};
use crate::cut::Unfolding;
use crate::progress::Watch;
use crate::rounding::Rounding;

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
