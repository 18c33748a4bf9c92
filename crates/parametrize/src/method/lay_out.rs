//! The stage that closes the seams.

use super::clean_up::Cleaned;
use super::domain::Domain;
use super::relaxed::{RelaxedLayout, relax};
use super::round::round;
use super::start::repaired;
use super::{MapOptions, MethodError, Start};
use crate::cut::FramedCut;
use crate::layout::ladder::{self, LayoutEffort};
use crate::progress::{Watch, unless_cancelled};
use crate::rounding::Rounding;

/// The relaxed layout of cleaned matchings, if it is as good as their estimate; else the better one of it and that of the
/// rounded matchings, for which so much is tried.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out<'m>(
    domain: Domain<'m>,
    rounding: Rounding,
    cleaned: Option<&Cleaned>,
    effort: LayoutEffort,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding, RelaxedLayout), MethodError> {
    let Some(cleaned) = cleaned else {
        return lay_out_rounded(domain, rounding, effort, start, options, watch);
    };
    let without = match lay_out_cleaned(&domain, &cleaned.start, options, watch)? {
        // The estimate knows nothing of what directions cost.
        Some(layout) if domain.guide.is_some() || cleaned.is_met_by(&layout) => {
            return Ok((domain, rounding, layout));
        }
        other => other,
    };
    let all = domain.features();
    let with = lay_out_rounded(domain.clone(), rounding.clone(), effort, start, options, watch);
    match (without, unless_cancelled(with)?) {
        // Neither is worth a feature.
        (Some(without), Ok((fewer, _, with)))
            if fewer.features() != all || cleaned.is_worth(&without, &with) =>
        {
            Ok((domain, rounding, without))
        }
        (Some(without), Err(_)) => Ok((domain, rounding, without)),
        (_, with) => with,
    }
}

/// The relaxed layout of cleaned matchings, if there is one.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out_cleaned(
    domain: &Domain<'_>,
    cleaned: &FramedCut,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<RelaxedLayout>, MethodError> {
    // The last rung costs most, and what it finds is seldom as good as expected; along a guide more cones depend on it.
    let effort = match domain.guide {
        None => LayoutEffort::Brief,
        Some(_) => LayoutEffort::Thorough,
    };
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let layout = ladder::lay_out(sectors, metric, cleaned, effort, watch);
    match unless_cancelled(layout)? {
        Ok(Ok(layout)) => Ok(Some(relax(layout, domain.guide.as_ref(), options, watch)?)),
        // As they were rounded along a guide, cones are far too many.
        Ok(Err(defects)) if domain.guide.is_some() => Err(MethodError::Defective(defects)),
        Ok(Err(_)) | Err(_) => Ok(None),
    }
}

/// The relaxed layout of rounded matchings. Where there is none, aligned edges near the defects are dropped; the matchings of
/// the others stay as long as features are near the defects.
///
/// # Errors
/// [`MethodError`].
fn lay_out_rounded<'m>(
    domain: Domain<'m>,
    rounding: Rounding,
    effort: LayoutEffort,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding, RelaxedLayout), MethodError> {
    let (mut domain, mut rounding) = (domain, rounding);
    loop {
        let (sectors, metric) = (&domain.sectors, &domain.metric);
        let defects = match ladder::lay_out(sectors, metric, &rounding.start, effort, watch)? {
            Ok(layout) => {
                let layout = relax(layout, domain.guide.as_ref(), options, watch)?;
                return Ok((domain, rounding, layout));
            }
            Err(defects) => defects,
        };
        let Some(fewer) = domain.without_features_at(&defects) else {
            return Err(MethodError::Defective(defects));
        };
        // With no feature near the defects they lie in the matchings alone.
        let kept = (fewer.features() != domain.features()).then(|| {
            let (before, after) = (&domain.sectors, &fewer.sectors);
            let start = rounding.start.with_fewer_aligned(before, after, &fewer.metric);
            repaired(&fewer, Rounding { start, stats: rounding.stats })
        });
        (domain, rounding) = match kept {
            Some(Ok(kept)) => (fewer, kept),
            Some(Err(_)) | None => {
                let unfolding = fewer.unfold();
                round(fewer, unfolding, start, options, watch)?
            }
        };
    }
}
