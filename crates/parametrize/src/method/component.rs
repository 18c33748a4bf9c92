//! What is tried for a component until it is mapped.

use super::certify::ComponentMap;
use super::domain::Domain;
use super::{MapOptions, MethodError, Purpose, Start, parametrize};
use crate::progress::{Watch, unless_cancelled};
use crate::rounding::RoundingOptions;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Geometry};

/// The part of the features that may be lost for the sake of directions, or of fewer cones.
const FEW: f64 = 0.01;

/// Maps one component along its features and its guide, which may cost only a few features. For quads, where more are lost, once
/// more with cones at no price, since coarse patches may need more of them; the map that follows more features is taken.
///
/// # Errors
/// [`MethodError`] of the last trial.
pub(super) fn map_component(
    piece: &Component,
    geometry: Geometry<'_>,
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, MethodError> {
    let mesh = &piece.mesh;
    let geometry = geometry.of_piece(piece);
    let geometry = geometry.whole();
    let metric = geometry.metric(mesh);
    let features = features.restrict(piece);
    let mut domain = Domain::new(mesh, geometry, &metric, features, options);
    let few = match options.strict_features {
        true => 0,
        false => (FEW * domain.features().edges().len() as f64) as usize,
    };
    let too_many = domain.released.len() + few + 1;
    let mut along = None;
    if domain.guide.is_some() {
        let domain = domain.clone().releasing_fewer_than(too_many);
        along = unless_cancelled(parametrize(domain, start, options, watch))?.ok();
    }
    domain.guide = None;
    let map = match along {
        Some(map) => map,
        None => map_domain(domain.clone(), start, options, watch)?,
    };
    let is_texture = options.purpose == Purpose::Texture;
    if is_texture || map.released.len() < too_many {
        return Ok(map);
    }
    let rounding = RoundingOptions { cone_bias: 0.0, ..options.rounding };
    let options = MapOptions { rounding, ..*options };
    let domain = domain.releasing_fewer_than(map.released.len());
    let other = map_domain(domain, start, &options, watch);
    Ok(unless_cancelled(other)?.unwrap_or(map))
}

/// Maps a domain along its features; where that fails, with nothing aligned, and then in a metric without thin triangles.
///
/// # Errors
/// [`MethodError`] of the last trial.
fn map_domain(
    mut domain: Domain<'_>,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, MethodError> {
    loop {
        match unless_cancelled(parametrize(domain.clone(), start, options, watch))? {
            Ok(map) => return Ok(map),
            Err(error) => domain = domain.simpler().ok_or(error)?,
        }
    }
}
