//! What is tried for a component until it is mapped.

use super::certify::ComponentMap;
use super::domain::Domain;
use super::{MapOptions, MethodError, Start, parametrize};
use crate::progress::{Watch, unless_cancelled};
use crate::rounding::RoundingStrategy;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Metric, TriMesh};

/// Exponents of the metrics to solve in: the mesh's own, then snowflakes for meshes whose triangles are
/// too thin for arithmetic.
const EXPONENTS: [f64; 3] = [1.0, 0.5, 0.3];
/// Mixed-integer rounding of more triangles than this takes many minutes.
const LAST_RESORT_FACES: usize = 20_000;

/// Maps one component along its features; where that fails, with nothing aligned, in whichever metric it takes.
///
/// # Errors
/// [`MethodError`]; with nothing aligned that in the metric of the surface.
pub(super) fn map_component(
    piece: &Component,
    positions: &[[f64; 3]],
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, MethodError> {
    let mesh = &piece.mesh;
    let positions: Vec<_> = piece.vertices.iter().map(|v| positions[v.at()]).collect();
    let metric = Metric::from_positions(mesh, &positions);
    let features = features.restrict(piece);
    let mut domain = Domain::new(mesh, &positions, &metric, features, options.largest_index());
    if domain.any_aligned() {
        let mapped = parametrize(domain.clone(), start, options, watch);
        if let Ok(mapped) = unless_cancelled(mapped)? {
            return Ok(mapped);
        }
        domain = domain.without_features();
    }
    let last_resort = last_resort(mesh, start, options);
    let attempts = EXPONENTS.map(|exponent| (exponent, options));
    let attempts = attempts.into_iter().chain(last_resort.iter().map(|options| (1.0, options)));
    let mut failure = None;
    for (exponent, options) in attempts {
        let domain = if exponent < 1.0 { domain.with_exponent(exponent) } else { domain.clone() };
        match unless_cancelled(parametrize(domain, start, options, watch))? {
            Ok(mapped) => return Ok(mapped),
            Err(error) => failure = failure.or(Some(error)),
        }
    }
    Err(failure.unwrap_or(MethodError::Defective(Default::default())))
}

/// The other way of rounding for a component that nothing else has mapped: mixed integers if it is small
/// enough, or, where these were asked for, the default.
fn last_resort(mesh: &TriMesh, start: &Start, options: &MapOptions) -> Option<MapOptions> {
    let mut last = *options;
    last.rounding.strategy = match options.rounding.strategy {
        RoundingStrategy::MixedInteger => RoundingStrategy::default(),
        _ => RoundingStrategy::MixedInteger,
    };
    let is_fit = options.rounding.strategy == RoundingStrategy::MixedInteger
        || mesh.n_faces() <= LAST_RESORT_FACES;
    (matches!(start, Start::Mesh) && is_fit).then_some(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit as testkit;

    #[test]
    fn the_last_resort_is_the_other_way_of_rounding() {
        let soup = testkit::cube();
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let other = |strategy, start: &Start| {
            let mut options = MapOptions::default();
            options.rounding.strategy = strategy;
            last_resort(&mesh, start, &options).map(|last| last.rounding.strategy)
        };
        let (mixed, bias) = (RoundingStrategy::MixedInteger, RoundingStrategy::ConeBias);
        assert_eq!(other(bias, &Start::Mesh), Some(mixed));
        assert_eq!(other(mixed, &Start::Mesh), Some(bias));
        assert_eq!(other(bias, &Start::SmoothField), None);
    }
}
