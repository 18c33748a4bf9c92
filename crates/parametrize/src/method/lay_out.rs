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

/// The better one of the relaxed layouts of cleaned and of rounded matchings. Little is tried for the latter where the first
/// is as good as estimated, and otherwise so much.
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
    let without = match lay_out_as_given(&domain, &cleaned.start, options, watch)? {
        // Along directions the estimate says too little, and rounded matchings have far too many cones.
        Some(without) if domain.guide.is_some() => return Ok((domain, rounding, without)),
        Some(without) if cleaned.is_met_by(&without) => {
            if options.fast {
                return Ok((domain, rounding, without));
            }
            let with = lay_out_as_given(&domain, &rounding.start, options, watch)?;
            let better = with.filter(|with| !cleaned.is_worth(&without, with));
            return Ok((domain, rounding, better.unwrap_or(without)));
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

/// The relaxed layout of matchings with the features there are, if there is one.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out_as_given(
    domain: &Domain<'_>,
    start: &FramedCut,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<RelaxedLayout>, MethodError> {
    // The last rung costs most, and what it finds is seldom as good as expected; along a guide far more cones are the other
    // way out.
    let effort = match domain.guide {
        None => LayoutEffort::Brief,
        Some(_) => LayoutEffort::Thorough,
    };
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let layout = ladder::lay_out(sectors, metric, start, effort, watch);
    match unless_cancelled(layout)? {
        Ok(Ok(layout)) => Ok(Some(relax(layout, domain.guide.as_ref(), options, watch)?)),
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

#[cfg(test)]
mod tests {
    use super::super::clean_up::clean_up;
    use super::*;
    use seamstress_mesh::features::EdgeSet;
    use seamstress_mesh::{Geometry, Metric, TriMesh};
    use seamstress_testkit as kit;
    use std::ops::ControlFlow;

    #[test]
    fn directions_stay_where_cleaned_matchings_have_no_layout() {
        let soup = kit::bumpy(&kit::torus(24, 12, 2.0, 0.8), 0.2, 1);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let options = MapOptions { alignment: 1.0, ..Default::default() };
        let (geometry, none) = (Geometry::from(&soup.positions), EdgeSet::new(&mesh, []));
        let domain = Domain::new(&mesh, geometry, &metric, none, &options);
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let watch = &mut watch;
        let start = &Start::Mesh;
        let (domain, rounding) =
            round(domain.clone(), domain.unfold(), start, &options, watch).unwrap();
        let mut cleaned =
            clean_up(&domain, &rounding.start, start, &options, watch).unwrap().unwrap();
        // Two turns more: no triangles have such angles.
        cleaned.start.matched.matching[0] += 8;
        assert!(lay_out_as_given(&domain, &cleaned.start, &options, watch).unwrap().is_none());
        let (effort, cleaned) = (LayoutEffort::Thorough, Some(&cleaned));
        let (domain, _, layout) =
            lay_out(domain, rounding, cleaned, effort, start, &options, watch).unwrap();
        assert!(domain.guide.is_some());
        assert!(layout.excess() < 1.0, "{}", layout.excess());
    }
}
