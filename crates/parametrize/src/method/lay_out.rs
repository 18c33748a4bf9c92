//! The stage that closes the seams.

use super::clean_up::{Cleaned, clean_up};
use super::domain::Domain;
use super::relaxed::{RelaxedLayout, relax};
use super::round::round;
use super::start::repaired;
use super::{MapOptions, MethodError, Start};
use crate::cut::FramedCut;
use crate::features::widened;
use crate::layout::exact::Defects;
use crate::layout::ladder::{self, LayoutEffort};
use crate::progress::{Watch, unless_cancelled};
use crate::rounding::Rounding;

/// Times that matchings are cleaned up again, with cones held near the defects that a layout has left.
const HOLDINGS: usize = 3;
/// Rings of faces around defects in which cones are held the first time; then twice as many each time.
const RINGS: usize = 3;

/// The better one of the relaxed layouts of cleaned and of rounded matchings. Little is tried for the latter where the first
/// is as good as estimated, and otherwise so much.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out<'m>(
    domain: Domain<'m>,
    rounding: Rounding,
    cleaned: Option<Cleaned>,
    effort: LayoutEffort,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding, RelaxedLayout), MethodError> {
    let Some(cleaned) = cleaned else {
        return lay_out_rounded(domain, rounding, effort, start, options, watch);
    };
    let without = match lay_out_cleaned(&domain, &rounding, cleaned, start, options, watch)? {
        // Along directions the estimate says too little, and rounded matchings have far too many cones: a few features come
        // before these.
        Ok((_, without)) if domain.guide.is_some() => return Ok((domain, rounding, without)),
        Err(defects) if domain.guide.is_some() => {
            let rounded = rounding.clone();
            let fewer = with_fewer_features(&domain, rounded, defects, start, options, watch);
            let Ok((domain, rounding)) = unless_cancelled(fewer)? else {
                let with = lay_out_as_given(&domain, &rounding.start, options, watch)?;
                let with = with.map_err(MethodError::Defective)?;
                return Ok((domain, rounding, with));
            };
            let none = domain.nowhere();
            let cleaned = clean_up(&domain, &rounding.start, &none, start, options, watch)?;
            return lay_out(domain, rounding, cleaned, effort, start, options, watch);
        }
        Ok((cleaned, without)) if cleaned.is_met_by(&without) => {
            if options.fast {
                return Ok((domain, rounding, without));
            }
            let with = lay_out_as_given(&domain, &rounding.start, options, watch)?.ok();
            let better = with.filter(|with| !cleaned.is_worth(&without, with));
            return Ok((domain, rounding, better.unwrap_or(without)));
        }
        other => other.ok(),
    };
    let all = domain.features();
    let with = lay_out_rounded(domain.clone(), rounding.clone(), effort, start, options, watch);
    match (without, unless_cancelled(with)?) {
        // Neither is worth a feature.
        (Some((cleaned, without)), Ok((fewer, _, with)))
            if fewer.features() != all || cleaned.is_worth(&without, &with) =>
        {
            Ok((domain, rounding, without))
        }
        (Some((_, without)), Err(_)) => Ok((domain, rounding, without)),
        (_, with) => with,
    }
}

/// The relaxed layout of cleaned matchings, or its defects. Where it has some, the matchings are cleaned up again, while
/// cones near the defects stay as they were rounded.
///
/// # Errors
/// [`MethodError`].
fn lay_out_cleaned(
    domain: &Domain<'_>,
    rounding: &Rounding,
    mut cleaned: Cleaned,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Result<(Cleaned, RelaxedLayout), Defects>, MethodError> {
    let (mesh, mut held) = (domain.mesh(), domain.nowhere());
    let mut rings = (0..HOLDINGS).map(|k| RINGS << k);
    loop {
        let defects = match lay_out_as_given(domain, &cleaned.start, options, watch)? {
            Ok(layout) => return Ok(Ok((cleaned, layout))),
            Err(defects) => defects,
        };
        let Some(rings) = rings.next() else { return Ok(Err(defects)) };
        let near = widened(mesh, defects.vertices(mesh), rings);
        held.iter_mut().zip(near.iter()).for_each(|(held, &near)| *held |= near);
        match clean_up(domain, &rounding.start, &held, start, options, watch)? {
            Some(less) => cleaned = less,
            None => return Ok(Err(defects)),
        }
    }
}

/// The relaxed layout of matchings with the features there are, or its defects.
///
/// # Errors
/// [`MethodError`].
pub(super) fn lay_out_as_given(
    domain: &Domain<'_>,
    start: &FramedCut,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Result<RelaxedLayout, Defects>, MethodError> {
    // The last rung costs most, and what it finds is seldom as good as expected; along a guide more cones depend on it.
    let effort = match domain.guide {
        None => LayoutEffort::Brief,
        Some(_) => LayoutEffort::Thorough,
    };
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let layout = ladder::lay_out(sectors, metric, start, effort, watch);
    match unless_cancelled(layout)? {
        Ok(Ok(layout)) => Ok(Ok(relax(layout, domain.guide.as_ref(), options, watch)?)),
        Ok(Err(defects)) => Ok(Err(defects)),
        Err(_) => Ok(Err(Defects::default())),
    }
}

/// The relaxed layout of rounded matchings. Where there is none, aligned edges near the defects are dropped.
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
        (domain, rounding) =
            with_fewer_features(&domain, rounding, defects, start, options, watch)?;
    }
}

/// A domain with the features dropped near defects, and its matchings: those of before as long as there are such features, since
/// with none near the defects these lie in the matchings alone.
///
/// # Errors
/// [`MethodError::Defective`] if there is nothing left to drop, or along a guide nothing near the defects.
fn with_fewer_features<'m>(
    domain: &Domain<'m>,
    rounding: Rounding,
    defects: Defects,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Domain<'m>, Rounding), MethodError> {
    let Some(fewer) = domain.without_features_at(&defects) else {
        return Err(MethodError::Defective(defects));
    };
    let is_near = fewer.features() != domain.features();
    if !is_near && domain.guide.is_some() {
        return Err(MethodError::Defective(defects));
    }
    if is_near {
        let (before, after) = (&domain.sectors, &fewer.sectors);
        let start = rounding.start.with_fewer_aligned(before, after, &fewer.metric);
        if let Ok(kept) = repaired(&fewer, Rounding { start, stats: rounding.stats }) {
            return Ok((fewer, kept));
        }
    }
    let unfolding = fewer.unfold();
    round(fewer, unfolding, start, options, watch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::features::EdgeSet;
    use seamstress_mesh::{Geometry, Metric, TriMesh};
    use seamstress_testkit as kit;
    use std::ops::ControlFlow;

    #[test]
    fn cleaned_matchings_without_a_layout_are_cleaned_up_again() {
        let soup = kit::bumpy(&kit::torus(24, 12, 2.0, 0.8), 0.2, 1);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        for alignment in [0.0, 1.0] {
            let options = MapOptions { alignment, ..Default::default() };
            let (geometry, none) = (Geometry::from(&soup.positions), EdgeSet::new(&mesh, []));
            let domain = Domain::new(&mesh, geometry, &metric, none, &options);
            let mut go_on = |_| ControlFlow::Continue(());
            let watch = &mut Watch::new(&mut go_on, 0, 1);
            let start = &Start::Mesh;
            let (domain, rounding) =
                round(domain.clone(), domain.unfold(), start, &options, watch).unwrap();
            let nowhere = domain.nowhere();
            let mut cleaned = clean_up(&domain, &rounding.start, &nowhere, start, &options, watch)
                .unwrap()
                .unwrap();
            // Two turns more: no triangles have such angles.
            cleaned.start.matched.matching[0] += 8;
            let wrong = lay_out_as_given(&domain, &cleaned.start, &options, watch).unwrap();
            assert!(!wrong.err().unwrap().none());
            let (_, layout) = lay_out_cleaned(&domain, &rounding, cleaned, start, &options, watch)
                .unwrap()
                .unwrap();
            assert!(layout.excess() < 1.0, "{}", layout.excess());
        }
    }
}
